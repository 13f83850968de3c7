//! Reading bytes, words, lines and blocks of files, for all formats.

pub(crate) mod blocks;
pub(crate) mod bytes;
pub(crate) mod text;
pub(crate) mod tokenizer;
