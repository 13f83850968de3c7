//! The axis that points up in pictures.

use crate::io::usage::choices;
use clap::builder::TypedValueParser;
use p2m_page::UpAxis;

/// Returns a parser of the values of `--up`.
pub(crate) fn up_axes() -> impl TypedValueParser<Value = UpAxis> {
    let y = "As in most scans and models for films and games; in the front view, z points at the viewer";
    choices([("y", y, UpAxis::Y), ("z", "As in CAD and maps", UpAxis::Z)])
}
