//! The rules that decide which points are inside of a scene.

use crate::io::progress::{Progress, Unit};
use crate::io::streams::Streams;
use clap::ValueEnum;
use p2m_backends::AnyIndex;
use p2m_core::Soup;
use p2m_field::sign::{SignError, SignedDistance};

/// A rule that decides which points are inside.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SignRule {
    /// As a closed surface if it is one, otherwise by winding numbers
    Auto,
    /// By the normals of a closed surface; a surface that is not closed is an error
    Closed,
    /// By winding numbers
    Winding,
}

/// An index with signs, which borrows its scene.
pub(crate) type SignedIndex<'a> = SignedDistance<&'a dyn AnyIndex, &'a Soup<f64>>;

/// The largest error of winding numbers.
const WINDING_NUMBER_ERROR: f64 = 0.01;

impl SignRule {
    /// Prepares signs for the index, and returns them with the name of the rule that decides them.
    pub(crate) fn prepare<'a>(
        self,
        streams: &Streams,
        index: &'a dyn AnyIndex,
        soup: &'a Soup<f64>,
    ) -> Result<(SignedIndex<'a>, &'static str), SignError> {
        let _progress = Progress::start(streams, "looking for inside and outside", None, Unit::None);
        if self != Self::Winding {
            match SignedDistance::new(index, soup) {
                Ok(signed) => return Ok((signed, "closed")),
                Err(SignError::Open { .. } | SignError::NotOriented { .. }) if self == Self::Auto => {}
                Err(error) => return Err(error),
            }
        }
        let signed = SignedDistance::with_winding_numbers(index, soup, WINDING_NUMBER_ERROR)?;
        Ok((signed, "winding"))
    }
}
