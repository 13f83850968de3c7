//! Tests of interception indexes, in one program so that shared code is compiled once.

mod locators_and_filters;
mod octree;
mod p2m;
mod pruning;
