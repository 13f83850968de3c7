//! Tests with the scenes and the oracle of p2m-testkit.

mod boxes;
mod packets;
mod pair_bounds;
