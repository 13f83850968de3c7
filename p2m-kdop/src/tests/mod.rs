//! Tests with the scenes and the oracle of p2m-testkit.

mod lower_bound;
mod ray_entries;
