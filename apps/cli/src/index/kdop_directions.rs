//! The option `--k`: the directions of the faces of a k-DOP tree.

use crate::io::usage::usage;
use clap::ValueEnum;
use clap::builder::PossibleValue;
use p2m_backends::KdopDirections;

/// A value of `--k`.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct KdopFaces(pub(crate) KdopDirections);

impl ValueEnum for KdopFaces {
    fn value_variants<'a>() -> &'a [Self] {
        static ALL: [KdopFaces; KdopDirections::ALL.len()] = {
            let mut all = [KdopFaces(KdopDirections::Scene); KdopDirections::ALL.len()];
            let mut i = 0;
            while i < all.len() {
                all[i] = KdopFaces(KdopDirections::ALL[i]);
                i += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, help) = match self.0 {
            KdopDirections::Six => ("6", "Boxes along the axes"),
            KdopDirections::Fourteen => ("14", "Boxes with their corners cut off"),
            KdopDirections::Eighteen => ("18", "Boxes with their edges cut off"),
            KdopDirections::TwentySix => ("26", "Boxes with their corners and edges cut off"),
            KdopDirections::Scene => {
                ("scene", "14 faces, along the axes or rotated with the scene: the summary says which and why")
            }
        };
        Some(PossibleValue::new(name).help(help))
    }
}

/// Returns the directions that `--k` requests, if it was given.
///
/// # Errors
/// If it was given for a backend without k-DOPs.
pub(crate) fn requested(has_kdop_directions: bool, k: Option<KdopFaces>) -> anyhow::Result<Option<KdopDirections>> {
    if k.is_some() && !has_kdop_directions {
        return Err(usage("--k is for --backend kdop"));
    }
    Ok(k.map(|faces| faces.0))
}
