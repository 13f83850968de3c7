//! Units of lengths in files.

use std::fmt;

/// The unit of the coordinates of a file.
///
/// ```
/// use p2m_mixed::Unit;
///
/// assert_eq!(Unit::named("mm"), Some(Unit::Millimetre));
/// assert_eq!((Unit::Inch.to_string().as_str(), Unit::Inch.metres()), ("in", Some(0.0254)));
/// assert_eq!(Unit::Degree.metres(), None);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Unit {
    /// The unit is a micrometre.
    Micrometre,
    /// The unit is a millimetre.
    Millimetre,
    /// The unit is a centimetre.
    Centimetre,
    /// The unit is a metre.
    Metre,
    /// Inches of 25.4 mm.
    Inch,
    /// International feet of 0.3048 m.
    Foot,
    /// Feet of the surveys of the United States, of 1200 / 3937 m.
    SurveyFoot,
    /// Degrees of longitude and latitude. Distances between such coordinates are no lengths.
    Degree,
}

/// The names of each unit in files, the first of which it displays, and its length in metres.
const UNITS: [(Unit, &[&str], f64); 8] = [
    (Unit::Micrometre, &["um", "\u{b5}m", "\u{3bc}m", "micron", "micrometre", "micrometer"], 1e-6),
    (Unit::Millimetre, &["mm", "millimetre", "millimeter"], 1e-3),
    (Unit::Centimetre, &["cm", "centimetre", "centimeter"], 1e-2),
    (Unit::Metre, &["m", "metre", "meter"], 1.0),
    (Unit::Inch, &["in", "inch"], 0.0254),
    (Unit::Foot, &["ft", "foot", "feet"], 0.3048),
    (Unit::SurveyFoot, &["US survey ft", "us survey foot", "foot_us", "us-ft"], 1200.0 / 3937.0),
    (Unit::Degree, &["degrees", "degree", "deg", "\u{b0}"], f64::NAN),
];

impl Unit {
    /// Returns the unit with this name in any case, such as `mm` or `millimeter`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let is_named = |(_, names, _): &&(Self, &[&str], f64)| names.iter().any(|n| n.eq_ignore_ascii_case(name));
        UNITS.iter().find(is_named).map(|(unit, ..)| *unit)
    }

    /// Returns the unit of this length in metres, up to an error of 10^-7 of it, which tells feet from each other.
    #[must_use]
    pub fn of_metres(metres: f64) -> Option<Self> {
        UNITS.iter().find(|(.., length)| (metres - length).abs() <= 1e-7 * length).map(|(unit, ..)| *unit)
    }

    /// Returns the length of the unit in metres, or `None` for degrees.
    #[must_use]
    pub fn metres(self) -> Option<f64> {
        UNITS.iter().find(|(unit, ..)| *unit == self).map(|(.., metres)| *metres).filter(|metres| !metres.is_nan())
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = UNITS.iter().find(|(unit, ..)| unit == self).map_or("", |(_, names, _)| names[0]);
        f.pad(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_lengths_find_the_unit() {
        for (unit, names, metres) in UNITS {
            assert!(names.iter().all(|name| Unit::named(&name.to_ascii_uppercase()) == Some(unit)), "{unit}");
            assert_eq!(unit.metres(), Unit::of_metres(metres).and_then(Unit::metres));
            assert!(unit == Unit::Degree || Unit::of_metres(metres) == Some(unit));
        }
        assert_eq!((Unit::named("furlong"), Unit::of_metres(0.5)), (None, None));
        assert_eq!(Unit::of_metres(0.304_800_609_601), Some(Unit::SurveyFoot));
    }
}
