//! Tests of trees, in one program so that shared code is compiled once.

mod boxes;
mod packets;
