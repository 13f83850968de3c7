//! Tests of k-DOP trees, in one program so that shared code is compiled once.

mod tree;
