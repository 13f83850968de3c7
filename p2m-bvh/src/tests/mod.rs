//! Tests with the scenes and the oracle of p2m-testkit.

mod pair_bounds;
