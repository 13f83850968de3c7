//! The interface between the harness and a backend: an index that is built over a scene and answers queries.

use crate::queries::QuerySlice;
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_cli::harness::queries::Scalar as _;
use p2m_core::Soup;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// The answer to a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Answer {
    /// The distance; NaN if there was no answer.
    pub(crate) distance: f64,
    /// The id of the primitive in the scene, for our indexes. An external library numbers its own shapes, and its
    /// number only enters the checksum.
    pub(crate) id: u32,
}

impl Answer {
    /// The answer of a query that has none.
    pub(crate) const NONE: Self = Self { distance: f64::NAN, id: u32::MAX };

    /// Returns whether the distances of both answers have the same bits.
    pub(crate) fn same_distance(&self, other: &Self) -> bool {
        self.distance.to_bits() == other.distance.to_bits()
    }
}

/// An index over a scene that the harness can query. A new backend implements this trait, from which [`ErasedIndex`]
/// follows.
pub(crate) trait BenchIndex: Sync {
    /// The scalar of the queries.
    type Scalar: Scalar;
    /// Answers one query with default options and without a hint.
    fn query(&self, query: &Point3<Self::Scalar>) -> Answer;
    /// Answers several queries in order, one by one unless the backend has batches.
    #[inline(always)]
    fn queries(&self, queries: &[Point3<Self::Scalar>], answers: &mut [Answer]) {
        for (query, answer) in queries.iter().zip(answers) {
            *answer = self.query(query);
        }
    }
}

/// A [`BenchIndex`] with its scalar erased. The loop over queries is compiled for each backend, so a query costs no
/// dynamic call beyond those of the backend.
pub(crate) trait ErasedIndex: Sync {
    /// Answers queries in order, and turns a panic into an error.
    fn answer(&self, queries: QuerySlice<'_>, answers: &mut [Answer]) -> Result<(), Unavailable>;
}

impl<C: BenchIndex> ErasedIndex for C {
    fn answer(&self, queries: QuerySlice<'_>, answers: &mut [Answer]) -> Result<(), Unavailable> {
        catch(|| {
            self.queries(C::Scalar::of(queries), answers);
            Ok(())
        })
    }
}

/// A scalar, with access to the scene in it.
pub(crate) trait Scalar: p2m_cli::harness::queries::Scalar {
    /// Returns the scene in this scalar and its heap bytes, or an error if the scene overflows the scalar.
    fn soup(scene: &Scene) -> Result<(&Arc<Soup<Self>>, usize), Unavailable>;
}

impl Scalar for f64 {
    fn soup(scene: &Scene) -> Result<(&Arc<Soup<f64>>, usize), Unavailable> {
        Ok((&scene.double, scene.double_bytes))
    }
}

impl Scalar for f32 {
    fn soup(scene: &Scene) -> Result<(&Arc<Soup<f32>>, usize), Unavailable> {
        let soup = scene.single.as_ref().ok_or_else(|| Unavailable("the scene overflows f32".to_owned()))?;
        Ok((soup, scene.single_bytes))
    }
}

/// The scalar of a backend.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ScalarKind {
    /// The IEEE 754 type binary32.
    #[value(name = "f32")]
    Single,
    /// The IEEE 754 type binary64.
    #[value(name = "f64")]
    Double,
}

impl ScalarKind {
    /// Returns the name of the type in Rust.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Single => "f32",
            Self::Double => "f64",
        }
    }
}

/// The reason why a backend is not measured. It becomes a footnote of the table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Unavailable(pub(crate) String);

impl Unavailable {
    pub(crate) fn because(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}

impl std::fmt::Display for Unavailable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Unavailable {}

/// An index of any backend that is ready for queries.
pub(crate) type BoxedIndex = Box<dyn ErasedIndex>;

/// A backend that is ready to be built. The scene has been copied and converted already. This is not timed, but the
/// copies count as memory of the index.
pub(crate) struct Prepared {
    /// Builds the index; this call is timed.
    pub(crate) build: Box<dyn FnOnce() -> Result<BoxedIndex, Unavailable>>,
    /// Heap bytes of the scene that the index keeps borrowing.
    pub(crate) borrowed: usize,
}

/// A backend of the list of all backends.
pub(crate) struct Backend {
    /// The name in tables and on the command line.
    pub(crate) name: &'static str,
    /// The scalar of queries and answers.
    pub(crate) scalar: ScalarKind,
    /// Whether the backend keeps the contract of `ClosestPoint`. Its answers are then compared bit for bit.
    pub(crate) is_ours: bool,
    /// Whether the backend visits every primitive. It then gets few queries, and is the oracle of `verify`.
    pub(crate) is_exhaustive: bool,
    /// Prepares a scene for the build.
    pub(crate) prepare: Prepare,
}

/// A function that copies and converts a scene as the build needs it.
type Prepare = Box<dyn Fn(&Scene) -> Result<Prepared, Unavailable> + Send + Sync>;

impl Backend {
    /// Makes one of our backends, in f64, that does not visit every primitive.
    pub(crate) fn new(
        name: &'static str,
        prepare: impl Fn(&Scene) -> Result<Prepared, Unavailable> + Send + Sync + 'static,
    ) -> Self {
        let scalar = ScalarKind::Double;
        Self { name, scalar, is_ours: true, is_exhaustive: false, prepare: Box::new(prepare) }
    }

    /// Builds the index, and turns a panic into an error.
    pub(crate) fn build(&self, scene: &Scene) -> Result<BoxedIndex, Unavailable> {
        catch(|| ((self.prepare)(scene)?.build)())
    }
}

/// Runs external code and turns its panics into errors.
pub(crate) fn catch<V>(run: impl FnOnce() -> Result<V, Unavailable>) -> Result<V, Unavailable> {
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|_| Err(Unavailable("it panicked".to_owned())))
}
