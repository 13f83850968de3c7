//! Tests with the scenes and the oracle of p2m-testkit. They use the crate as others do, so its searches are not compiled
//! again for them.

mod agreement;
mod locators_and_filters;
mod octree;
mod p2m;
mod pruning;
