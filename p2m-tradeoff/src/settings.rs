//! What can be asked for other than the usual: the one list of all settings.
//!
//! A new way to trade accuracy for speed is a variant of [`Ask`], a line of [`SETTINGS`] and an arm of each method here.

use p2m_core::kernel::ERROR_CONSTANT;
use p2m_core::{QueryOptions, Real};

/// What a query asks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ask {
    /// The closest point, with no more than the error of roundings.
    Exact,
    /// The nearest primitive for certain, and its distance rounded once.
    Certified,
    /// A point that is farther by this part of the distance at most.
    Epsilon(f64),
    /// The best that so many visits of nodes and packets find.
    Budget(u32),
}

/// A row of the list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Its name in tables, plots and records.
    pub name: &'static str,
    /// What it does, for who has not seen it.
    pub about: &'static str,
    /// What is asked.
    pub ask: Ask,
}

/// What everything is compared with: what a call without options does.
pub const DEFAULT: Setting = Setting {
    name: "default",
    about: "f64, no options: the closest point, its distance wrong by roundings alone",
    ask: Ask::Exact,
};

/// All of them, the usual one first.
pub const SETTINGS: &[Setting] = &[
    DEFAULT,
    Setting {
        name: "certified",
        about: "`certified_closest_point`: the nearest primitive without doubt, its distance within half a unit in the last place",
        ask: Ask::Certified,
    },
    within("epsilon 0.001", 0.001, "`QueryOptions::with_epsilon(0.001)`: at most 0.1 % farther than the closest point"),
    within("epsilon 0.01", 0.01, "`QueryOptions::with_epsilon(0.01)`: at most 1 % farther"),
    within("epsilon 0.1", 0.1, "`QueryOptions::with_epsilon(0.1)`: at most 10 % farther"),
    within("epsilon 1", 1.0, "`QueryOptions::with_epsilon(1.0)`: at most twice as far"),
    Setting {
        name: "budget 0",
        about: "`QueryOptions::with_max_visits(0)`: the first thing found; of `octree` and `p2m` what the cell itself tells",
        ask: Ask::Budget(0),
    },
    Setting {
        name: "budget 16",
        about: "`QueryOptions::with_max_visits(16)`: the best of sixteen visits of nodes and packets",
        ask: Ask::Budget(16),
    },
];

const fn within(name: &'static str, epsilon: f64, about: &'static str) -> Setting {
    Setting { name, about, ask: Ask::Epsilon(epsilon) }
}

impl Setting {
    /// The options of a query.
    #[must_use]
    pub fn options<T: Real>(&self) -> QueryOptions<T> {
        let usual = QueryOptions::default();
        match self.ask {
            Ask::Exact | Ask::Certified => usual,
            Ask::Budget(visits) => usual.with_max_visits(visits),
            Ask::Epsilon(epsilon) => usual.with_epsilon(T::of_f64(epsilon)),
        }
    }

    /// What its answers promise.
    #[must_use]
    pub fn promise(&self) -> Promise {
        match self.ask {
            Ask::Exact => Promise::Within(0.0),
            Ask::Certified => Promise::LastPlace,
            Ask::Epsilon(epsilon) => Promise::Within(epsilon),
            Ask::Budget(_) => Promise::Nothing,
        }
    }
}

/// How wrong an answer may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Promise {
    /// As wrong as it likes.
    Nothing,
    /// No more than one unit in the last place.
    LastPlace,
    /// No farther than this part of the distance, besides the roundings of the contract.
    Within(f64),
}

impl Promise {
    /// Whether an answer at `error` from a distance keeps it; `unit` is u M.
    #[must_use]
    pub fn is_kept(self, error: f64, distance: f64, unit: f64) -> bool {
        match self {
            Self::Nothing => true,
            Self::LastPlace => error <= distance.next_up() - distance,
            // Once for the primitive that is answered and once for the nearest one (contract N1, N2, N7).
            Self::Within(part) => error <= part * distance + 2.0 * ERROR_CONSTANT * unit,
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
            let options: QueryOptions<f64> = setting.options();
            match setting.promise() {
                Promise::Nothing => assert!(options.max_visits < u32::MAX, "{}", setting.name),
                Promise::LastPlace => assert_eq!(setting.ask, Ask::Certified),
                Promise::Within(part) => assert!((part - options.epsilon).abs() <= 0.0, "{}", setting.name),
            }
        }
        assert!(Promise::Within(0.1).is_kept(0.1, 1.0, 1e-16) && !Promise::Within(0.1).is_kept(0.2, 1.0, 1e-16));
        assert!(Promise::Within(0.0).is_kept(1e-16, 1.0, 1e-16) && !Promise::Within(0.0).is_kept(1e-14, 1.0, 1e-16));
        assert!(Promise::Nothing.is_kept(9.0, 1.0, 0.0));
        assert!(Promise::LastPlace.is_kept(2e-16, 1.0, 1.0) && !Promise::LastPlace.is_kept(3e-16, 1.0, 1.0));
    }
}
