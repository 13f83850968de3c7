//! Rules of signs, whose data is prepared once for an index.

use crate::errors::value_error;
use p2m_core::{AnyIndex, Soup};
use p2m_field::sign::{self, SignedDistance};
use pyo3::prelude::*;
use std::sync::Arc;

/// An index with signs.
pub(crate) type Signed = SignedDistance<Arc<dyn AnyIndex>, Arc<Soup<f64>>>;

/// The rule that decides which points are inside. `None` means that the surface determines the rule.
pub(crate) type SignRule = Option<sign::SignRule>;

/// Returns the rule with this name.
pub(crate) fn sign_rule(name: &str) -> PyResult<SignRule> {
    match name {
        "auto" => Ok(None),
        "winding" => Ok(Some(sign::SignRule::Winding)),
        "parity" => Ok(Some(sign::SignRule::Parity)),
        _ => Err(value_error(format!("sign: {name:?} is none of 'auto', 'winding', 'parity'"))),
    }
}
