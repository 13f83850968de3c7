//! The option `--k`: the directions of the faces of a k-DOP tree.

use crate::io::usage::{choices, usage};
use clap::builder::TypedValueParser;
use p2m_backends::KdopDirections;

/// Returns a parser of the values of `--k`.
pub(crate) fn kdop_faces() -> impl TypedValueParser<Value = KdopDirections> {
    choices([
        ("6", "Boxes along the axes", KdopDirections::Six),
        ("14", "Boxes with their corners cut off", KdopDirections::Fourteen),
        ("18", "Boxes with their edges cut off", KdopDirections::Eighteen),
        ("26", "Boxes with their corners and edges cut off", KdopDirections::TwentySix),
        (
            "scene",
            "14 faces, along the axes or rotated with the scene: the summary says which and why",
            KdopDirections::Scene,
        ),
    ])
}

/// Returns the directions that `--k` requests, if it was given.
///
/// # Errors
/// If it was given for a backend without k-DOPs.
pub(crate) fn requested(
    has_kdop_directions: bool,
    k: Option<KdopDirections>,
) -> anyhow::Result<Option<KdopDirections>> {
    if k.is_some() && !has_kdop_directions {
        return Err(usage("--k is for --backend kdop"));
    }
    Ok(k)
}
