//! Interception lists: packets with the lanes that can be nearest, eight to a block ([`block`]), and the test that decides
//! what is in a list ([`corner_test`]).

pub(crate) mod block;
pub(crate) mod corner_test;

pub(crate) mod search;
