//! The list of all settings of accuracy.
//!
//! A new way to trade accuracy for speed needs a variant of [`Accuracy`], a line of [`SETTINGS`] and an arm of each
//! method of this module.

use p2m_core::QueryOptions;
use p2m_core::kernel::ERROR_CONSTANT;
use serde::Serialize;

/// The kind of answer that a query requests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Accuracy {
    /// The closest point up to rounding errors.
    Exact,
    /// The certified nearest primitive, with its distance rounded once.
    Certified,
    /// A point whose distance exceeds the least one by this relative error at most.
    Epsilon(f64),
    /// The best point that this number of visits of nodes and packets finds.
    MaxVisits(u32),
}

/// A setting of accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Setting {
    /// The name in tables, plots and records.
    pub(crate) name: &'static str,
    /// A phrase that explains the setting to readers of a page.
    pub(crate) about: &'static str,
    /// The kind of answer.
    #[serde(skip)]
    pub(crate) accuracy: Accuracy,
}

/// The setting of a call without options, which the other settings are compared with.
pub(crate) const DEFAULT: Setting = Setting {
    name: "default",
    about: "f64, no options: the closest point, up to rounding errors",
    accuracy: Accuracy::Exact,
};

/// All settings, the default one first.
pub(crate) const SETTINGS: &[Setting] = &[
    DEFAULT,
    Setting {
        name: "certified",
        about: "`certified_closest_point`: the certified nearest primitive, with its distance within half a unit in the last place",
        accuracy: Accuracy::Certified,
    },
    within("epsilon 0.001", 0.001, "`QueryOptions::with_epsilon(0.001)`: at most 0.1 % farther than the closest point"),
    within("epsilon 0.01", 0.01, "`QueryOptions::with_epsilon(0.01)`: at most 1 % farther"),
    within("epsilon 0.1", 0.1, "`QueryOptions::with_epsilon(0.1)`: at most 10 % farther"),
    within("epsilon 1", 1.0, "`QueryOptions::with_epsilon(1.0)`: at most twice as far"),
    Setting {
        name: "max visits 0",
        about: "`QueryOptions::with_max_visits(0)`: the first primitive that is found; for `octree` and `p2m` the one that the cell itself has",
        accuracy: Accuracy::MaxVisits(0),
    },
    Setting {
        name: "max visits 16",
        about: "`QueryOptions::with_max_visits(16)`: the best of sixteen visits of nodes and packets",
        accuracy: Accuracy::MaxVisits(16),
    },
];

/// A setting with an epsilon.
const fn within(name: &'static str, epsilon: f64, about: &'static str) -> Setting {
    Setting { name, about, accuracy: Accuracy::Epsilon(epsilon) }
}

impl Setting {
    /// Returns the options of a query.
    pub(crate) fn options(&self) -> QueryOptions<f64> {
        let defaults = QueryOptions::default();
        match self.accuracy {
            Accuracy::Exact | Accuracy::Certified => defaults,
            Accuracy::MaxVisits(visits) => defaults.with_max_visits(visits),
            Accuracy::Epsilon(epsilon) => defaults.with_epsilon(epsilon),
        }
    }

    /// Returns the accuracy that answers promise.
    pub(crate) fn promise(&self) -> Promise {
        match self.accuracy {
            Accuracy::Exact => Promise::Within(0.0),
            Accuracy::Certified => Promise::OneUlp,
            Accuracy::Epsilon(epsilon) => Promise::Within(epsilon),
            Accuracy::MaxVisits(_) => Promise::Nothing,
        }
    }
}

/// The error that an answer may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Promise {
    /// The answer promises nothing but its lower bound.
    Nothing,
    /// The error is at most one unit in the last place.
    OneUlp,
    /// The error is at most this part of the distance, besides the rounding errors that the contract allows.
    Within(f64),
}

impl Promise {
    /// Returns the promised bound of the error relative to the distance, besides rounding, if there is one.
    pub(crate) fn relative(self) -> Option<f64> {
        match self {
            Self::Nothing => None,
            Self::OneUlp => Some(0.0),
            Self::Within(relative) => Some(relative),
        }
    }

    /// Returns whether an answer with this error keeps the promise. `unit` is u M.
    pub(crate) fn is_kept(self, error: f64, distance: f64, unit: f64) -> bool {
        match self {
            Self::Nothing => true,
            Self::OneUlp => error <= distance.next_up() - distance,
            // The primitive of the answer and the nearest one may each have this rounding error (contract N1, N2, N7).
            Self::Within(relative) => error <= relative * distance + 2.0 * ERROR_CONSTANT * unit,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_distinct_and_the_usual_one_is_first() {
        assert_eq!(SETTINGS[0], DEFAULT);
        for (i, setting) in SETTINGS.iter().enumerate() {
            assert!(SETTINGS[..i].iter().all(|other| other.name != setting.name), "{}", setting.name);
            assert!(!setting.about.is_empty());
        }
    }

    #[test]
    fn options_and_promises_are_of_the_same_size() {
        for setting in SETTINGS {
            let options = setting.options();
            match setting.promise() {
                Promise::Nothing => assert!(options.max_visits < u32::MAX, "{}", setting.name),
                Promise::OneUlp => assert_eq!(setting.accuracy, Accuracy::Certified),
                Promise::Within(part) => assert!((part - options.epsilon).abs() <= 0.0, "{}", setting.name),
            }
        }
        assert!(Promise::Within(0.1).is_kept(0.1, 1.0, 1e-16) && !Promise::Within(0.1).is_kept(0.2, 1.0, 1e-16));
        assert!(Promise::Within(0.0).is_kept(1e-16, 1.0, 1e-16) && !Promise::Within(0.0).is_kept(1e-14, 1.0, 1e-16));
        assert!(Promise::Nothing.is_kept(9.0, 1.0, 0.0));
        assert!(Promise::OneUlp.is_kept(2e-16, 1.0, 1.0) && !Promise::OneUlp.is_kept(3e-16, 1.0, 1.0));
    }
}
