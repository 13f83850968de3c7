//! Rules of signs, which are prepared once for an index.

use p2m_core::{AnyIndex, Soup};
use p2m_field::sign::{self, SignError, SignedDistance};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;

/// An index with signs.
pub(crate) type Signed = SignedDistance<Arc<dyn AnyIndex>, Arc<Soup<f64>>>;

/// The rule that decides which points are inside, or that the surface decides it.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct SignRule(Option<sign::SignRule>);

impl SignRule {
    pub(crate) fn from_name(name: &str) -> PyResult<Self> {
        match name {
            "auto" => Ok(Self(None)),
            "winding" => Ok(Self(Some(sign::SignRule::Winding))),
            "parity" => Ok(Self(Some(sign::SignRule::Parity))),
            _ => Err(PyValueError::new_err(format!("sign: {name:?} is none of 'auto', 'winding', 'parity'"))),
        }
    }

    /// Prepares signs for an index over a scene.
    pub(crate) fn prepare(self, index: &Arc<dyn AnyIndex>, soup: &Arc<Soup<f64>>) -> Result<Signed, SignError> {
        match self.0 {
            None => SignedDistance::new(Arc::clone(index), Arc::clone(soup)),
            Some(rule) => SignedDistance::with_rule(Arc::clone(index), Arc::clone(soup), rule),
        }
    }
}
