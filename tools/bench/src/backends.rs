//! The list of all backends: those of the registry of p2m-backends, variants of them, and external libraries.

use crate::backend::{Backend, ScalarKind};
use crate::bvh_crate::prepare as bvh;

use crate::our_indexes::{Way, registered, settings};
use crate::parry::{double, single};
use crate::point_trees::{kiddo_double, kiddo_single};
use p2m_backends::BACKENDS;
use std::sync::LazyLock;

/// Every backend, in the order of the tables.
pub(crate) static ALL: LazyLock<Vec<Backend>> = LazyLock::new(|| {
    let of_registry = |scalar, way| BACKENDS.iter().map(move |entry| registered(entry, scalar, way));
    let in_batches = of_registry(ScalarKind::Double, Way::Batch).filter(|backend| !backend.is_exhaustive);
    of_registry(ScalarKind::Double, Way::OneByOne)
        .chain(in_batches)
        .chain(settings())
        .chain(of_registry(ScalarKind::Single, Way::OneByOne))
        .chain(external())
        .collect()
});

/// Returns external libraries.
fn external() -> [Backend; 5] {
    [
        Backend { is_ours: false, scalar: ScalarKind::Single, ..Backend::new(YARDSTICK, single::prepare) },
        Backend { is_ours: false, ..Backend::new(YARDSTICK_DOUBLE, double::prepare) },
        Backend { is_ours: false, ..Backend::new("bvh", bvh) },
        Backend { is_ours: false, ..Backend::new("kiddo", kiddo_double) },
        Backend { is_ours: false, scalar: ScalarKind::Single, ..Backend::new("kiddo-f32", kiddo_single) },
    ]
}

/// The backends that `query` measures by default.
pub(crate) const DEFAULT: &str = "brute,aabb,aabb-f32,parry3d,parry3d-f64";

/// The external library to which ratios refer.
pub(crate) const YARDSTICK: &str = "parry3d";

/// The external library in f64, to which further ratios refer.
pub(crate) const YARDSTICK_DOUBLE: &str = "parry3d-f64";

/// Returns the backend with this name.
pub(crate) fn by_name(name: &str) -> &'static Backend {
    ALL.iter().find(|backend| backend.name == name).expect("a name of the list")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_distinct_and_defaults_exist() {
        for (i, backend) in ALL.iter().enumerate() {
            assert!(!backend.name.is_empty() && ALL[..i].iter().all(|other| other.name != backend.name));
        }
        for name in DEFAULT.split(',') {
            assert!(ALL.iter().any(|backend| backend.name == name), "{name}");
        }
    }
}
