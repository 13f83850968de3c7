//! Commands that draw a scene, and what pages show.

pub(crate) mod boxes;
pub(crate) mod camera;
pub(crate) mod drawing;
pub(crate) mod open;
pub(crate) mod pair;
pub(crate) mod picture;
pub(crate) mod source;
pub(crate) mod tree_levels;
pub(crate) mod up_axis;
pub(crate) mod view;

pub(crate) use open::OpenArgs;
pub(crate) use pair::{PairPage, PairPageArgs, PairResult};
pub(crate) use source::{PageArgs, about, file_name};
