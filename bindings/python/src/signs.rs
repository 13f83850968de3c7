//! Rules of signs, which are prepared once for an index.

use p2m_core::{AnyIndex, Soup};
use p2m_field::sign::{SignError, SignedDistance};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;

/// An index with signs.
pub(crate) type Signed = SignedDistance<Arc<dyn AnyIndex>, Arc<Soup<f64>>>;

/// The largest error of winding numbers.
const WINDING_NUMBER_ERROR: f64 = 0.01;

/// The rule that decides which points are inside.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum SignRule {
    /// As a closed surface if it is one, otherwise by winding numbers.
    Auto,
    /// By the normals of a closed surface and exact rays.
    Closed,
    /// By winding numbers.
    Winding,
}

impl SignRule {
    pub(crate) fn from_name(name: &str) -> PyResult<Self> {
        match name {
            "auto" => Ok(Self::Auto),
            "closed" => Ok(Self::Closed),
            "winding" => Ok(Self::Winding),
            _ => Err(PyValueError::new_err(format!("sign: {name:?} is none of 'auto', 'closed', 'winding'"))),
        }
    }

    /// Prepares signs for an index over a scene.
    pub(crate) fn prepare(self, index: &Arc<dyn AnyIndex>, soup: &Arc<Soup<f64>>) -> Result<Signed, SignError> {
        if self != Self::Winding {
            match SignedDistance::new(Arc::clone(index), Arc::clone(soup)) {
                Err(SignError::Open { .. } | SignError::NotOriented { .. }) if self == Self::Auto => {}
                other => return other,
            }
        }
        SignedDistance::with_winding_numbers(Arc::clone(index), Arc::clone(soup), WINDING_NUMBER_ERROR)
    }
}
