//! The rules that decide which points are inside of a scene.

use crate::io::{Progress, Streams, Unit};
use anyhow::anyhow;
use clap::ValueEnum;
use p2m_backends::AnyIndex;
use p2m_core::Soup;
use p2m_field::sign::{self, SignError, SignedDistance};

/// A rule that decides which points are inside.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SignRule {
    /// By winding numbers, or by parity if the surface is closed but its triangles have different orientations
    Auto,
    /// Inside where the winding number exceeds a half in magnitude
    Winding,
    /// Inside where a ray crosses the surface an odd number of times; an open surface is an error
    Parity,
}

/// An index with signs, which borrows its scene.
pub(crate) type SignedIndex<'a> = SignedDistance<&'a dyn AnyIndex, &'a Soup<f64>>;

impl SignRule {
    /// Prepares signs for the index.
    pub(crate) fn prepare<'a>(
        self,
        streams: &Streams,
        index: &'a dyn AnyIndex,
        soup: &'a Soup<f64>,
    ) -> Result<SignedIndex<'a>, SignError> {
        let _progress = Progress::start(streams, "looking for inside and outside", None, Unit::None);
        match self {
            Self::Auto => SignedDistance::new(index, soup),
            Self::Winding => SignedDistance::with_rule(index, soup, sign::SignRule::Winding),
            Self::Parity => SignedDistance::with_rule(index, soup, sign::SignRule::Parity),
        }
    }

    /// Prepares the signs that `--signed` asks for. An error says what to do instead.
    pub(crate) fn prepare_signed<'a>(
        self,
        streams: &Streams,
        index: &'a dyn AnyIndex,
        soup: &'a Soup<f64>,
    ) -> anyhow::Result<SignedIndex<'a>> {
        self.prepare(streams, index, soup).map_err(|error| match error {
            SignError::OtherKinds { .. } => anyhow!("{error}: leave --signed out for distances without signs"),
            SignError::Open { .. } => anyhow!("{error}: choose --signed=winding, or leave --signed out"),
            _ => error.into(),
        })
    }
}

/// The rule of signs and its note, for reports.
#[derive(Clone, Copy)]
pub(crate) struct SignReport {
    /// The name of the rule.
    pub(crate) rule: &'static str,
    /// A sentence that says why the rule was chosen, unless the surface is closed and consistently oriented.
    pub(crate) note: Option<&'static str>,
}

impl SignReport {
    pub(crate) fn new(signed: &SignedIndex<'_>) -> Self {
        Self { rule: signed.rule().name(), note: signed.note() }
    }

    /// Returns the lines of a summary.
    pub(crate) fn text(&self) -> String {
        let note = self.note.map(|note| format!("note     {note}\n")).unwrap_or_default();
        format!("signs    by {}\n{note}", self.rule)
    }
}
