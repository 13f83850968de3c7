//! Rules of signs, which are prepared once for an index.

use crate::errors::value_error;
use p2m_core::{AnyIndex, Soup};
use p2m_field::sign::{self, SignedDistance};
use pyo3::prelude::*;
use std::sync::Arc;

/// An index with signs.
pub(crate) type Signed = SignedDistance<Arc<dyn AnyIndex>, Arc<Soup<f64>>>;

/// The rule that decides which points are inside; without one the surface decides it.
pub(crate) type SignRule = Option<sign::SignRule>;

/// Returns a rule by its name.
pub(crate) fn sign_rule(name: &str) -> PyResult<SignRule> {
    match name {
        "auto" => Ok(None),
        "winding" => Ok(Some(sign::SignRule::Winding)),
        "parity" => Ok(Some(sign::SignRule::Parity)),
        _ => Err(value_error(format!("sign: {name:?} is none of 'auto', 'winding', 'parity'"))),
    }
}
