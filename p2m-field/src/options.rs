//! Options of fields, and the value that a distance and a sign make.

use crate::sign::Sign;

/// Options of [`distances`](crate::distances) and the other functions that compute fields.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FieldOptions {
    /// The largest distance that is computed, in units of the scene. Beyond it the field has this value, with the
    /// correct sign. The default is infinite.
    pub band: f64,
    /// Whether all threads of the current pool are used, which does not change the field. Without the feature `rayon`
    /// one thread computes the field in any case. The default is `true`.
    pub parallel: bool,
}

impl Default for FieldOptions {
    fn default() -> Self {
        Self { band: f64::INFINITY, parallel: true }
    }
}

impl FieldOptions {
    /// Sets the largest distance that is computed; a negative number or NaN counts as 0.
    #[must_use]
    pub fn with_band(self, band: f64) -> Self {
        Self { band, ..self }
    }
    /// Sets whether all threads of the current pool are used.
    #[must_use]
    pub fn with_parallel(self, parallel: bool) -> Self {
        Self { parallel, ..self }
    }

    /// Returns the band, or 0 if it is negative or NaN.
    pub(crate) fn checked_band(&self) -> f64 {
        self.band.max(0.0)
    }
}

/// Returns the value of a field where the scene has this distance and this sign.
#[allow(clippy::cast_possible_truncation, reason = "values are rounded to f32")]
pub(crate) fn signed_value(distance: f64, band: f64, sign: Sign) -> f32 {
    let distance = distance.min(band) as f32;
    match sign {
        Sign::Outside => distance,
        Sign::Inside => -distance,
        Sign::Boundary => 0.0,
        Sign::Undefined => f32::NAN,
    }
}
