//! Tests of tables of answers.

mod answers;
mod rays;
