//! Interception lists: the lists themselves ([`block`]), the test that decides which primitives a list holds
//! ([`corner_test`]) and the search of a list ([`search`]).
//!
//! A list consists of packets with the lanes that can hold the answer in its cell, eight packets to a block. Both
//! partitions, cubes and Voronoi cells, use the same lists.

pub(crate) mod block;
pub(crate) mod corner_test;
pub(crate) mod interleaved_lists;
pub(crate) mod search;
