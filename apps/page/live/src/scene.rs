//! The scene of a page, its indexes and its answers.

use crate::far::FarScene;
use p2m::backends::{BACKENDS, BackendEntry, IndexVisitor, SearchStructure};
use p2m::core::{Best, IndexStats, StatsCollector};
use p2m::nalgebra::Point3;
use p2m::{Aabb, AnyIndex, BuildError, Closest, Element, PrimitiveSet, QueryOptions, Soup};
use std::sync::Arc;

/// The number of primitives above which no cells of vertices are built, because their build would take many seconds.
pub const MAX_VERTEX_CELL_PRIMITIVES: usize = 50_000;

/// Returns the backend with a number: the script of the page counts those of the registry but for exhaustive searches.
#[must_use]
pub fn backend(number: usize) -> Option<&'static BackendEntry> {
    BACKENDS.iter().filter(|backend| backend.structure != SearchStructure::Exhaustive).nth(number)
}

/// The part of the interface of an index that a page needs. Each method of an object is compiled for each index, so
/// objects of all traits of an index would double the size of the module.
trait PageIndex {
    fn answer(&self, query: &Point3<f64>) -> Option<Answer>;
    fn bytes(&self) -> usize;
}

/// Puts an index behind the pointer of the page.
struct ToPageIndex;

impl IndexVisitor for ToPageIndex {
    type Output = Box<dyn PageIndex>;
    fn visit<I: AnyIndex<f64> + 'static>(self, index: I) -> Box<dyn PageIndex> {
        Box::new(index)
    }
}

impl<I: IndexStats<f64>> PageIndex for I {
    fn answer(&self, query: &Point3<f64>) -> Option<Answer> {
        answer(self, query)
    }
    fn bytes(&self) -> usize {
        self.parts().iter().map(|part| part.1).sum()
    }
}

/// Answers a query and counts its work. One search does both, because a second one would be compiled for each index.
pub(crate) fn answer(index: &impl IndexStats<f64>, query: &Point3<f64>) -> Option<Answer> {
    if !query.iter().all(|x| x.is_finite()) {
        return None;
    }
    let mut stats = StatsCollector::new(Best::new(&QueryOptions::default()));
    index.inspect(query, &mut stats);
    let work = [stats.nodes, stats.packets, stats.primitives];
    Some(Answer { closest: stats.best.finish()?, work })
}

/// An answer with the work that it took.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Answer {
    /// The closest point.
    pub closest: Closest<f64>,
    /// The numbers of nodes, packets and primitives that the query visited.
    pub work: [usize; 3],
}

impl Answer {
    /// The number of values of an answer as an array.
    pub const LEN: usize = 10;

    /// Returns the closest point, the distance, the lower bound, the primitive, the [code](p2m::Feature::code) of the
    /// feature, and the work.
    #[must_use]
    pub fn values(&self) -> [f64; Self::LEN] {
        let Closest { point, distance, lower_bound, primitive, feature, .. } = self.closest;
        let [nodes, packets, primitives] = self.work.map(|count| count as f64);
        let id = primitive.index() as f64;
        [point.x, point.y, point.z, distance, lower_bound, id, f64::from(feature.code()), nodes, packets, primitives]
    }
}

/// A scene with its indexes.
#[derive(Default)]
pub struct Live {
    soup: Arc<Soup<f64>>,
    /// The box of the scene, if there is one.
    bounds: Option<Aabb<f64>>,
    indexes: Vec<(&'static BackendEntry, Box<dyn PageIndex>)>,
    far: Option<FarScene>,
}

impl Live {
    /// Creates a scene without indexes. `sizes` has the number of vertices of each primitive, and `indices` the
    /// vertices of all primitives one after the other, so that primitives have the ids that they have elsewhere.
    /// `None` stands for arrays that do not fit each other.
    #[must_use]
    pub fn new(coordinates: &[f64], sizes: &[u8], indices: &[u32]) -> Option<Self> {
        let positions = coordinates.chunks_exact(3).map(|p| Point3::new(p[0], p[1], p[2])).collect();
        let mut rest = indices;
        let mut elements = Vec::with_capacity(sizes.len());
        for &size in sizes {
            let (vertices, others) = rest.split_at_checked(usize::from(size))?;
            rest = others;
            elements.push(match *vertices {
                [a] => Element::Point(a),
                [a, b] => Element::Segment([a, b]),
                [a, b, c] => Element::Triangle([a, b, c]),
                _ => return None,
            });
        }
        let soup = Soup::new(positions, elements).ok()?;
        Some(Self { bounds: Some(soup.aabb()), soup: Arc::new(soup), ..Self::default() })
    }

    /// Returns the number of primitives.
    #[must_use]
    pub fn primitive_count(&self) -> usize {
        self.soup.len()
    }

    /// Builds the index of a backend. Its size in bytes is returned, or `None` if there is none: cells of vertices of a
    /// large scene are not built.
    ///
    /// # Errors
    /// An error of the build.
    pub fn build(&mut self, backend: &'static BackendEntry) -> Result<Option<usize>, BuildError> {
        if backend.structure == SearchStructure::VertexCells && self.soup.len() > MAX_VERTEX_CELL_PRIMITIVES {
            return Ok(None);
        }
        let index = backend.build_default(Arc::clone(&self.soup), ToPageIndex)?;
        let bytes = index.bytes();
        self.indexes.push((backend, index));
        Ok(Some(bytes))
    }

    /// Returns the index of a backend, if it was built.
    fn index(&self, backend: &BackendEntry) -> Option<&dyn PageIndex> {
        self.indexes.iter().find(|(built, _)| *built == backend).map(|(_, index)| &**index)
    }

    /// Answers a query with the index of a backend, and counts the work. `None` stands for no answer or no index.
    #[must_use]
    pub fn query(&self, backend: &BackendEntry, query: &Point3<f64>) -> Option<Answer> {
        self.index(backend)?.answer(query)
    }

    /// Answers `count` queries at points that are spread evenly in the box of the scene scaled by 1.2, and returns the
    /// number of answers. The caller measures the time.
    #[must_use]
    pub fn answer_many(&self, backend: &BackendEntry, count: u32) -> usize {
        let (Some(index), Some(bounds)) = (self.index(backend), self.bounds) else { return 0 };
        // Multiples of these numbers modulo one, which are powers of the reciprocal of the root of x^4 = x + 1, leave
        // no large gaps.
        const STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_1];
        let point = |i: u32| {
            Point3::from(std::array::from_fn(|k| {
                let part = 1.2 * ((f64::from(i) * STEPS[k]).fract() - 0.5) + 0.5;
                bounds.min[k] * (1.0 - part) + bounds.max[k] * part
            }))
        };
        (0..count).filter(|&i| index.answer(&point(i)).is_some()).count()
    }

    /// Builds the scene that is far from the origin in f32, and returns its scale. `None` stands
    /// for a scene that f32 cannot represent.
    pub fn build_far(&mut self) -> Option<f64> {
        self.far = FarScene::new(&self.soup);
        Some(self.far.as_ref()?.scale())
    }

    /// Returns the scene that is far from the origin, if it was built.
    #[must_use]
    pub fn far(&self) -> Option<&FarScene> {
        self.far.as_ref()
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use p2m::{BruteForce, BuildIndex, ClosestPoint};

    /// Returns the arrays of a scene of a wavy surface, with a segment and a point above it.
    pub(crate) fn arrays() -> (Vec<f64>, Vec<u8>, Vec<u32>) {
        let side = 12u32;
        let vertices = (0..side * side).flat_map(|i| {
            let (x, y) = (f64::from(i % side), f64::from(i / side));
            [x, y, (0.9 * x).sin() + (0.7 * y).cos()]
        });
        let coordinates = vertices.chain([1.0, 1.0, 4.0, 9.0, 8.0, 5.0]).collect();
        let cells = (0..side * side).filter(|i| i % side + 1 < side && i / side + 1 < side);
        let triangles = cells.flat_map(|i| [i, i + 1, i + side, i + 1, i + side + 1, i + side]);
        let [a, b] = [side * side, side * side + 1];
        let indices: Vec<u32> = [a, b].into_iter().chain(triangles).chain([b]).collect();
        let mut sizes = vec![3; (indices.len() - 3) / 3];
        sizes.insert(0, 2);
        sizes.push(1);
        (coordinates, sizes, indices)
    }

    pub(crate) fn live() -> Live {
        let (coordinates, sizes, indices) = arrays();
        Live::new(&coordinates, &sizes, &indices).unwrap()
    }

    pub(crate) fn queries() -> impl Iterator<Item = Point3<f64>> {
        (0..500).map(|i| {
            let t = f64::from(i) / 500.0;
            Point3::new(14.0 * t - 1.0, 6.0 + 7.0 * (9.0 * t).sin(), 2.0 + 3.0 * (23.0 * t).cos())
        })
    }

    #[test]
    fn all_indexes_give_the_answers_of_brute_force() {
        let mut live = live();
        let backends: Vec<_> = (0..).map_while(backend).collect();
        assert_eq!(backends.len() + 1, BACKENDS.len());
        for &backend in &backends {
            assert!(live.query(backend, &Point3::origin()).is_none());
            assert!(live.build(backend).unwrap().unwrap() > 0);
        }
        let brute = BruteForce::build(Arc::clone(&live.soup), &()).unwrap();
        for query in queries() {
            let expected = brute.closest_point(&query).unwrap();
            for &backend in &backends {
                let answer = live.query(backend, &query).unwrap();
                // Certificates may differ in their last digit.
                let mut closest = answer.closest;
                assert!(closest.lower_bound <= closest.distance);
                closest.lower_bound = expected.lower_bound;
                assert_eq!(closest, expected, "{backend:?} {query}");
                assert!(answer.work[2] > 0, "{backend:?} {query}");
                assert_eq!(answer.values()[..3], *expected.point.coords.as_slice());
                assert_eq!(answer.values()[3], expected.distance);
            }
        }
        assert_eq!(live.answer_many(backends[2], 100), 100);
        assert_eq!(live.primitive_count(), 2 * 11 * 11 + 2);
    }

    #[test]
    fn arrays_that_do_not_fit_make_no_scene() {
        let (coordinates, sizes, indices) = arrays();
        assert!(Live::new(&coordinates, &sizes, &indices[1..]).is_none());
        assert!(Live::new(&coordinates[..30], &sizes, &indices).is_none());
        assert!(Live::new(&coordinates, &[4], &indices).is_none());
        let mut empty = Live::new(&[], &[], &[]).unwrap();
        let tree = BackendEntry::default_backend();
        assert!(live().query(tree, &Point3::new(f64::NAN, 0.0, 0.0)).is_none());
        assert!(empty.build(tree).is_ok() && empty.query(tree, &Point3::origin()).is_none());
        assert!(empty.build_far().is_none() && empty.far().is_none());
    }
}
