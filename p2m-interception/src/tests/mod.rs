//! Tests with the scenes and the oracle of p2m-testkit.

mod agreement;
mod locators_and_filters;
mod octree;
mod p2m;
mod pruning;
