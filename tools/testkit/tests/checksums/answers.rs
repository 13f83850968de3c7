//! The questions, and the checksums of their answers.

use crate::Table;
use crate::scenes::{self, Case};
use nalgebra::{Isometry3, Point3};
use p2m::batch::{BatchOptions, closest_points_into};
use p2m::core::Isa;
use p2m::field::sign::SignedDistance;
use p2m::pair::{ClosestPair, PairOptions, PairQuery};
use p2m::storage::{SavedFile, Writer};
use p2m::{
    AabbTree, BruteForce, BuildIndex, CertifiedQuery, Closest, ClosestPoint, Feature, Hit, KdopTree, NearQuery,
    OctreeIndex, P2mIndex, P2mOptions, Primitive, PrimitiveSet, QueryOptions, RayQuery, Real, Soup,
};
use p2m_testkit::families::{self, Span};
use p2m_testkit::rays::{AIMS, ray};
use p2m_testkit::scenes::{narrow, to_f32};

/// An FNV-1a hash of numbers.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, x: u64) {
        for byte in x.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn numbers<'a, T: Real>(&mut self, numbers: impl IntoIterator<Item = &'a T>) {
        numbers.into_iter().for_each(|x| self.add(x.to_f64().to_bits()));
    }

    fn feature(&mut self, feature: Feature) {
        self.add(match feature {
            Feature::Vertex(i) => u64::from(i),
            Feature::Edge(i) => 10 + u64::from(i),
            Feature::Face => 20,
        });
    }

    /// Adds an answer without its certified bound, which depends on the candidates that a search evaluates.
    fn closest<T: Real>(&mut self, answer: Option<&Closest<T>>) {
        let Some(Closest { point, distance, primitive, feature, barycentric, .. }) = answer else {
            return self.add(u64::MAX);
        };
        self.numbers(point.iter().chain([distance]).chain(barycentric));
        self.add(primitive.index() as u64);
        self.feature(*feature);
    }

    fn pair<T: Real>(&mut self, answer: Option<&ClosestPair<T>>) {
        let Some(pair) = answer else {
            return self.add(u64::MAX);
        };
        pair.points.iter().for_each(|point| self.numbers(point.iter()));
        self.numbers(pair.barycentric.as_flattened().iter().chain([&pair.distance]));
        pair.primitives.iter().for_each(|id| self.add(id.index() as u64));
        pair.features.iter().for_each(|feature| self.feature(*feature));
        self.add(u64::from(pair.is_intersecting));
    }

    fn hits(&mut self, hits: &[Hit]) {
        self.add(hits.len() as u64);
        for hit in hits {
            self.add(hit.primitive.index() as u64);
            self.numbers([hit.parameter].iter().chain(&hit.barycentric()));
            self.add(hit.side as u64);
        }
    }
}

/// Returns the hash of the numbers that a function adds.
fn hash(add: impl FnOnce(&mut Hash)) -> u64 {
    let mut hash = Hash::new();
    add(&mut hash);
    hash.0
}

/// Adds the answers about single primitives and about pairs of them, from all families of hard cases.
pub(crate) fn of_single_primitives(table: &mut Table) {
    single_primitives::<f64>(table, "f64", &Span::F64);
    single_primitives::<f32>(table, "f32", &Span::F32);
}

fn single_primitives<T: Real>(table: &mut Table, scalar: &str, span: &Span) {
    const CASES: u64 = 1500;
    let rounded = |v: &[f64; 3]| v.map(T::round_from_f64);
    let nearest = hash(|hash| {
        for case in 0..CASES {
            let case = families::case_in(&mut p2m_testkit::rng("checksums", case), span);
            let vertices: Vec<[T; 3]> = case.vertices.iter().map(rounded).collect();
            let found = families::shape(&vertices).project(&Point3::from(rounded(&case.query)));
            hash.numbers(found.point.iter().chain(&found.barycentric).chain([&found.key.distance()]));
            hash.feature(found.feature);
        }
    });
    table.add(&format!("families {scalar} nearest"), "the kernel", nearest);
    let pairs = hash(|hash| {
        for case in 0..CASES {
            let (_, hulls) = families::pair_in(&mut p2m_testkit::rng("checksums", case), span);
            let [a, b] = hulls.map(|hull| families::shape(&hull.iter().map(rounded).collect::<Vec<_>>()));
            let scene = BruteForce::new([a]).expect("finite");
            hash.pair(scene.closest_to(&b, &PairOptions::default()).as_ref());
        }
    });
    table.add(&format!("families {scalar} pairs"), "the kernel", pairs);
}

/// Adds the answers about all scenes, see [`table`](crate::table).
pub(crate) fn of_scenes(table: &mut Table, mut exchange: impl FnMut(&str, Vec<u8>) -> Vec<u8>) {
    for case in scenes::all() {
        let is_smallest = case.name == scenes::SMALLEST;
        let mut exchange = |name: &str, bytes| if is_smallest { exchange(name, bytes) } else { bytes };
        of_scene(table, &case, "f64", &case.soup, &case.queries, &mut exchange);
        let soup = narrow(&case.soup).expect("fits f32");
        let queries: Vec<Point3<f32>> = case.queries.iter().copied().map(to_f32).collect();
        of_scene(table, &case, "f32", &soup, &queries, &mut exchange);
    }
}

/// An index of any type. Questions take trait objects, so that they are not compiled for each type.
trait Index<T: Real>: ClosestPoint<T> + NearQuery<T> + CertifiedQuery<T> + Sync {}
impl<T: Real, I: ClosestPoint<T> + NearQuery<T> + CertifiedQuery<T> + Sync> Index<T> for I {}

/// A table, with the scene and the queries of the questions that are added to it.
struct Asked<'a, T: Real> {
    table: &'a mut Table,
    case: &'a Case,
    scalar: &'static str,
    soup: &'a Soup<T>,
    queries: &'a [Point3<T>],
}

fn of_scene<T: Real>(
    table: &mut Table,
    case: &Case,
    scalar: &'static str,
    soup: &Soup<T>,
    queries: &[Point3<T>],
    exchange: &mut dyn FnMut(&str, Vec<u8>) -> Vec<u8>,
) {
    let mut asked = Asked { table, case, scalar, soup, queries };
    let brute = BruteForce::new(soup).expect("valid");
    asked.points(&brute, "brute force");
    asked.rays(&brute, "brute force");
    asked.shapes(&brute, "brute force");
    macro_rules! ask {
        ($($name:literal: $index:ty, $($more:ident)*;)*) => {
            $({
                let index = <$index>::build(soup, &Default::default()).expect("valid");
                let mut writer = Writer::default();
                index.save(&mut writer);
                let mut bytes = Vec::new();
                writer.write(&mut bytes).expect("memory");
                // The coordinates of the smallest scene are whole numbers, so that its files are the same in both
                // scalars.
                let bytes = exchange(concat!($name, ".p2m"), bytes);
                let file = SavedFile::read(&bytes[..]).expect("a saved index");
                let loaded = <$index>::load(soup, file.checked().expect("undamaged")).expect("of this scene");
                for (index, origin, sets) in
                    [(index, "built", Isa::available()), (loaded, "loaded", vec![Isa::best()])]
                {
                    for isa in sets {
                        let by = format!("{} ({origin}, {isa})", $name);
                        let index = index.clone().with_isa(isa);
                        asked.points(&index, &by);
                        $(asked.$more(&index, &by);)*
                    }
                }
            })*
        };
    }
    ask! {
        "aabb": AabbTree<T, &Soup<T>>, rays shapes scenes;
        "kdop-6": KdopTree<T, &Soup<T>, 6>, rays shapes scenes;
        "kdop-14": KdopTree<T, &Soup<T>, 14>, rays shapes scenes;
        "octree": OctreeIndex<T, &Soup<T>>,;
        "p2m": P2mIndex<T, &Soup<T>>,;
    }
    // Saved indexes have neither the locator nor the filters of the paper, so this index is only built.
    let paper = P2mIndex::build_with(soup, &P2mOptions::as_in_paper()).expect("valid");
    for isa in Isa::available() {
        asked.points(&paper.clone().with_isa(isa), &format!("paper ({isa})"));
    }
}

impl<T: Real> Asked<'_, T> {
    fn add(&mut self, question: &str, by: &str, checksum: u64) {
        self.table.add(&format!("{} {} {question}", self.case.name, self.scalar), by, checksum);
    }

    /// Returns the edge of the scene's box.
    fn size(&self) -> T {
        let bounds = self.soup.aabb();
        let sides = bounds.max - bounds.min;
        sides.x.max(sides.y).max(sides.z)
    }

    /// Asks for closest points, one by one and as a batch, for near primitives, certified answers and signs.
    fn points(&mut self, index: &dyn Index<T>, by: &str) {
        let queries = self.queries;
        let nearest = hash(|hash| queries.iter().for_each(|query| hash.closest(index.closest_point(query).as_ref())));
        self.add("nearest", by, nearest);
        let mut answers = vec![None; queries.len()];
        closest_points_into(index, queries, &QueryOptions::default(), &BatchOptions::default(), &mut answers);
        let batch = hash(|hash| answers.iter().for_each(|answer| hash.closest(answer.as_ref())));
        self.add("nearest", &format!("{by}, as a batch"), batch);
        let radius = self.size() * T::round_from_f64(0.0625);
        let near = hash(|hash| {
            for query in queries.iter().step_by(4) {
                index.k_nearest(query, 5, T::INFINITY).iter().for_each(|answer| hash.closest(Some(answer)));
                index.all_within(query, radius).iter().for_each(|answer| hash.closest(Some(answer)));
            }
        });
        self.add("near", by, near);
        let certified = hash(|hash| {
            for query in queries.iter().step_by(4) {
                let answer = index.certified_closest_point(query, &QueryOptions::default()).expect("has vertices");
                hash.closest(answer.as_ref());
            }
        });
        self.add("certified", by, certified);
        if self.case.has_inside {
            let soup: Soup<f64> =
                Soup::new(self.soup.positions().iter().map(|p| p.map(|x| x.to_f64())).collect(), self.soup.elements())
                    .expect("finite");
            let signed = SignedDistance::new::<T>(index, &soup).expect("a closed surface");
            let signs = hash(|hash| {
                for query in queries {
                    hash.add(signed.closest_point(query).map_or(u64::MAX, |answer| answer.sign as u64));
                }
            });
            self.add("signs", by, signs);
        }
    }

    /// Asks for all hits of rays at the scene.
    fn rays(&mut self, index: &dyn RayQuery<T>, by: &str) {
        let (soup, bounds) = (&self.case.soup, self.case.soup.aabb());
        let hits = hash(|hash| {
            for (number, aim) in AIMS.into_iter().cycle().take(2 * AIMS.len()).enumerate() {
                let ray = ray(&mut p2m_testkit::rng("rays of checksums", number as u64), soup, &bounds, aim);
                let mut hits = index.all_intersections(&ray);
                hits.sort_by_key(|hit| hit.primitive.index());
                hash.hits(&hits);
            }
        });
        self.add("rays", by, hits);
    }

    /// Asks for the primitive nearest to a triangle whose vertices are queries.
    fn shapes(&mut self, index: &dyn PairQuery<T>, by: &str) {
        let index = &index;
        let pairs = hash(|hash| {
            for corners in self.queries.chunks_exact(3).take(12) {
                let triangle = p2m::Triangle::new(corners[0], corners[1], corners[2]);
                hash.pair(index.closest_to(&triangle, &PairOptions::default()).as_ref());
            }
        });
        self.add("pairs with triangles", by, pairs);
    }

    /// Asks for the nearest pair of primitives of the scene and of its moved copy.
    fn scenes(&mut self, index: &dyn PairQuery<T>, by: &str) {
        let index = &index;
        let pairs = hash(|hash| {
            for shift in [1.25, 3.5] {
                let shift = self.size().to_f64() * shift;
                let options = PairOptions::default().with_motion(Isometry3::translation(shift, 0.1 * shift, 0.0));
                hash.pair(index.closest_pair(index, &options).as_ref());
            }
        });
        self.add("pair of scenes", by, pairs);
    }
}
