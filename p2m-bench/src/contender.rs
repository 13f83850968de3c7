//! What the harness measures: something that is built over a scene and answers one query at a time.

use crate::queries::QuerySlice;
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_core::Soup;
use p2m_tradeoff::queries::Scalar as _;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The answer to a query.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Answer {
    /// The distance; NaN if there was no answer.
    pub(crate) distance: f64,
    /// The primitive's id in the scene for our indexes; for a rival the number in its own shape, kept for the
    /// checksum.
    pub(crate) id: u32,
}

impl Answer {
    /// No answer.
    pub(crate) const NONE: Self = Self { distance: f64::NAN, id: u32::MAX };

    /// Whether there was no answer: of `None`, not a distance that is NaN.
    pub(crate) fn is_none(&self) -> bool {
        self.distance.is_nan() && self.id == u32::MAX
    }

    /// Whether both are the same bits.
    pub(crate) fn same_distance(&self, other: &Self) -> bool {
        self.distance.to_bits() == other.distance.to_bits()
    }
}

/// An index over a scene. Implement this for one that is new; [`Batch`] follows.
pub(crate) trait Contender: Sync {
    /// The scalar of its queries.
    type Scalar: Scalar;
    /// Answers one query, with default options and no hint.
    fn query(&self, query: &Point3<Self::Scalar>) -> Answer;
    /// Answers several, in their order: one by one, unless the contender is one of batches.
    #[inline(always)]
    fn queries(&self, queries: &[Point3<Self::Scalar>], answers: &mut [Answer]) {
        for (query, answer) in queries.iter().zip(answers) {
            *answer = self.query(query);
        }
    }
}

/// A contender with its scalar erased: the loop over queries is compiled for each one, so that a query costs no
/// dynamic call beyond its own.
pub(crate) trait Batch: Sync {
    /// Answers queries in their order. Panics are errors.
    fn answer(&self, queries: QuerySlice<'_>, answers: &mut [Answer]) -> Result<(), Absent>;
}

impl<C: Contender> Batch for C {
    fn answer(&self, queries: QuerySlice<'_>, answers: &mut [Answer]) -> Result<(), Absent> {
        catch(|| {
            self.queries(C::Scalar::of(queries), answers);
            Ok(())
        })
    }
}

/// The two scalars, as places where to find the scene besides queries.
pub(crate) trait Scalar: p2m_tradeoff::queries::Scalar {
    /// The scene in this scalar and its heap bytes, unless the scene overflows.
    fn soup(scene: &Scene) -> Result<(&Soup<Self>, usize), Absent>;
}

impl Scalar for f64 {
    fn soup(scene: &Scene) -> Result<(&Soup<f64>, usize), Absent> {
        Ok((&scene.double, scene.double_bytes))
    }
}

impl Scalar for f32 {
    fn soup(scene: &Scene) -> Result<(&Soup<f32>, usize), Absent> {
        let soup = scene.single.as_ref().ok_or_else(|| Absent("the scene overflows f32".to_owned()))?;
        Ok((soup, scene.single_bytes))
    }
}

/// Which scalar a contender has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ScalarKind {
    /// binary32
    #[value(name = "f32")]
    Single,
    /// binary64
    #[value(name = "f64")]
    Double,
}

impl ScalarKind {
    /// Its Rust name.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Single => "f32",
            Self::Double => "f64",
        }
    }
}

/// Why a contender is not measured: a footnote below the table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Absent(pub(crate) String);

/// A contender that is ready for queries.
pub(crate) type Ready<'a> = Box<dyn Batch + 'a>;

/// A contender before it is built. What is copied or converted for it was made already and is not timed, but it counts
/// as its memory.
pub(crate) struct Prepared<'a, V = Ready<'a>> {
    /// Builds it, which is timed.
    pub(crate) build: Box<dyn FnOnce() -> Result<V, Absent> + 'a>,
    /// Heap bytes of the scene that it keeps borrowing.
    pub(crate) borrowed: usize,
}

/// An entry of the list of contenders.
pub(crate) struct Backend {
    /// Its name in tables and on the command line.
    pub(crate) name: &'static str,
    /// Its scalar.
    pub(crate) scalar: ScalarKind,
    /// Whether it keeps the contract of `ClosestPoint`: its answers are compared bitwise.
    pub(crate) ours: bool,
    /// Whether it looks at every primitive: it gets few queries, and is the oracle of `verify`.
    pub(crate) exhaustive: bool,
    /// Makes it ready to be built over a scene.
    pub(crate) prepare: for<'a> fn(&'a Scene) -> Result<Prepared<'a>, Absent>,
}

/// Runs foreign code, its panics being errors.
pub(crate) fn catch<V>(run: impl FnOnce() -> Result<V, Absent>) -> Result<V, Absent> {
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|_| Err(Absent("it panicked".to_owned())))
}
