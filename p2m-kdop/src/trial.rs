//! Trial queries that measure the work of a k-DOP tree for a scene and some directions.

use crate::{Directions, DirectionsError, KdopOptions, KdopTree};
use nalgebra::{Point3, Vector3};
use p2m_core::{Aabb, Primitive, Real, Segment, Shape, StatsCollector, Triangle};

/// The numbers of faces that are tried.
pub(crate) const FACES: [usize; 4] = [6, 14, 18, 26];
/// The time of a query apart from the nodes and packets that it visits, in nanoseconds. These costs were observed on
/// one processor, and only their ratios have an effect.
const NS_PER_QUERY: f64 = 100.0;
/// The time to visit a node with 6, 14, 18 and 26 faces, in nanoseconds.
const NS_PER_NODE: [f64; 4] = [30.0, 50.0, 50.0, 74.0];
/// The time to filter a packet, in nanoseconds. The octree has a figure of its own, on which its cells depend.
const NS_PER_PACKET: f64 = 45.0;
/// The number of trial queries.
const TRIAL_QUERIES: usize = 256;

/// Returns the axes of a frame and as many of its diagonals as K has room for. These are the default directions if the
/// frame is that of the axes.
pub(crate) fn frame_and_diagonals<const K: usize>(frame: &[Vector3<f64>; 3]) -> Result<Directions<K>, DirectionsError> {
    let [x, y, z] = *frame;
    let cube_diagonals = [x + y + z, y + z - x, z - x - y, x - y + z];
    let face_diagonals = [x + y, x + z, y + z, x - y, x - z, y - z];
    let diagonals = if K == 18 {
        [&face_diagonals[..], &cube_diagonals].concat()
    } else {
        [&cube_diagonals[..], &face_diagonals].concat()
    };
    let all = [&frame[..], &diagonals].concat();
    Directions::new(&all[..(K / 2).min(all.len())])
}

/// Converts a primitive to a shape in f64. A primitive without vertices becomes the diagonal of its box.
pub(crate) fn to_shape<T: Real>(primitive: &impl Primitive<T>) -> Shape<f64> {
    let to_f64 = |p: &Point3<T>| p.map(|x| x.to_f64());
    match primitive.vertices() {
        [a] => p2m_core::Point::new(to_f64(a)).into(),
        [a, b] => Segment::new(to_f64(a), to_f64(b)).into(),
        [a, b, c] => Triangle::new(to_f64(a), to_f64(b), to_f64(c)).into(),
        _ => {
            let bounds = primitive.aabb();
            Segment::new(to_f64(&bounds.min), to_f64(&bounds.max)).into()
        }
    }
}

/// Returns trial queries: points spread evenly in the box of the scene, and as many near its primitives.
pub(crate) fn trial_queries(shapes: &[Shape<f64>]) -> Vec<Point3<f64>> {
    let bounds = shapes.iter().map(Primitive::aabb).fold(Aabb::empty(), |a, b| a.union(&b));
    if shapes.is_empty() {
        return Vec::new();
    }
    let in_unit_cube = |i: usize| {
        // The fractions of multiples of the powers of the root of x^4 = x + 1 fill a cube evenly.
        let fraction = |step: f64| (0.5 + step * i as f64).fract();
        [0.819_172_513_396_164_4, 0.671_043_606_703_789_3, 0.549_700_477_901_970_3].map(fraction)
    };
    let inside = |i: usize| {
        Point3::from([0, 1, 2].map(|k: usize| {
            let t = in_unit_cube(i)[k];
            bounds.min[k] * (1.0 - t) + bounds.max[k] * t
        }))
    };
    let near = |i: usize| {
        let around = shapes[i * shapes.len() / TRIAL_QUERIES].aabb();
        let towards = inside(i);
        Point3::from([0, 1, 2].map(|k: usize| around.min[k] * 0.98 + towards[k] * 0.02))
    };
    (0..TRIAL_QUERIES).map(|i| if i % 2 == 0 { inside(i) } else { near(i) }).collect()
}

/// Returns the expected time of a query, in nanoseconds, for trees of 6, 14, 18 and 26 faces along a frame.
pub(crate) fn query_times(shapes: &[Shape<f64>], queries: &[Point3<f64>], frame: &[Vector3<f64>; 3]) -> [f64; 4] {
    [
        query_time::<6>(shapes, queries, frame, NS_PER_NODE[0]),
        query_time::<14>(shapes, queries, frame, NS_PER_NODE[1]),
        query_time::<18>(shapes, queries, frame, NS_PER_NODE[2]),
        query_time::<26>(shapes, queries, frame, NS_PER_NODE[3]),
    ]
}

/// Builds one tree and returns the expected time of a query, in nanoseconds, if a node takes `ns_per_node`.
fn query_time<const K: usize>(
    shapes: &[Shape<f64>],
    queries: &[Point3<f64>],
    frame: &[Vector3<f64>; 3],
    ns_per_node: f64,
) -> f64 {
    let options = KdopOptions::new(frame_and_diagonals::<K>(frame).expect("as many directions"));
    let tree = KdopTree::<f64, _, K>::build_with(shapes, &options).expect("a scene that has been checked");
    let finite = queries.iter().filter(|q| q.iter().all(|x| x.is_finite()));
    let [nodes, packets, _] = StatsCollector::count_queries(finite, |query, counting| tree.visit(query, counting));
    NS_PER_QUERY + (ns_per_node * nodes as f64 + NS_PER_PACKET * packets as f64) / queries.len().max(1) as f64
}
