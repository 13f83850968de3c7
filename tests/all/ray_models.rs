//! Compares rays on real meshes with exact rational arithmetic, and checks that no line slips through a closed surface.
//! If there is no folder of models, the tests are skipped with a message.

#![cfg(all(feature = "bvh", feature = "kdop", feature = "scene"))]

use nalgebra::{Point3, Vector3};
use p2m::bvh::{TreeIndex, Volume};
use p2m::core::Side;
use p2m::core::{Crossing, RayCollector};
use p2m::{Aabb, AabbTree, Element, KdopTree, PrimitiveId, PrimitiveSet, Ray, Soup};
use p2m_testkit::line_filter::LineFilter;
use p2m_testkit::ray_check::{Truth, agrees};
use p2m_testkit::rays::{AIMS, ray};
use p2m_testkit::{Cases, cases, model_files, rng};
use rand::{Rng, RngExt};
use std::collections::HashMap;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

fn read(path: &Path) -> (String, Soup<f64>) {
    let name = path.file_name().expect("a file").to_string_lossy().into_owned();
    (name, Arc::unwrap_or_clone(p2m::scene::read_scene(path).expect("readable").soup))
}

/// Runs the cases on all cores, and returns the sums of the numbers that they return.
fn on_all_cores<const N: usize>(cases: &Cases, case: impl Fn(u64) -> [usize; N] + Sync) -> [usize; N] {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let add = |a: [usize; N], b: [usize; N]| std::array::from_fn(|k| a[k] + b[k]);
    std::thread::scope(|scope| {
        let part = |first| {
            let (case, own) = (&case, cases.clone().skip(first).step_by(cores));
            move || own.map(case).fold([0; N], add)
        };
        let threads: Vec<_> = (0..cores).map(|first| scope.spawn(part(first))).collect();
        threads.into_iter().map(|thread| thread.join().expect("no panic")).fold([0; N], add)
    })
}

#[test]
fn every_model_is_met_as_exact_arithmetic_says() {
    let cases = cases(300, 42);
    for path in model_files() {
        let (name, soup) = read(&path);
        let vertices = |i| soup.get(PrimitiveId::new(i)).vertices().iter().map(|v| v.coords.into()).collect();
        let primitives: Vec<Vec<[f64; 3]>> = (0..soup.len()).map(vertices).collect();
        let filter = LineFilter::new(&primitives);
        let boxes = AabbTree::new(&soup).expect("valid");
        let kdops = KdopTree::<f64, _, 14>::new(&soup).expect("valid");
        let bounds = soup.aabb();
        let size = (bounds.max - bounds.min).amax();
        let [asked, met, along, crossed] = on_all_cores(&cases, |i| {
            let mut rng = rng("rays of models", i);
            let radius = if (i / AIMS.len() as u64).is_multiple_of(2) {
                0.0
            } else {
                size * 10f64.powi(-rng.random_range(4..12))
            };
            let ray = ray(&mut rng, &soup, &bounds, AIMS[i as usize % AIMS.len()]).with_radius(radius).expect("valid");
            let near = filter.near(&ray);
            let asked = near.len();
            let truth = Truth::new(&primitives, near, &ray);
            let [min, max] = truth.range(&mut rng);
            let mut sums = [asked, 0, 0, 0];
            for ray in [ray, ray.with_range(min, max).expect("in order")] {
                let context = || format!("{name}, ray {i}");
                let hits = truth.checked_hits(&boxes, &ray, &context);
                let crossings = truth.crossings(&ray);
                agrees(&boxes, &ray, &hits, crossings, &|| format!("{}, boxes", context()));
                agrees(&kdops, &ray, &hits, crossings, &|| format!("{}, k-DOPs", context()));
                let along = hits.iter().filter(|hit| hit.side == Side::Along).count();
                sums = [sums[0], sums[1] + hits.len(), sums[2] + along, sums[3] + crossings];
            }
            sums
        });
        println!(
            "{name}: {} rays, {asked} decided exactly, {met} hits, {along} of them along, {crossed} crossings",
            cases.len()
        );
        assert!(cases.have_more_than(30, met), "{name}: rays are aimed at it");
    }
}

/// The number of times that lines enter a surface, and the number of times that they leave it.
#[derive(Default)]
struct Sides {
    front: usize,
    back: usize,
}

impl<'r> RayCollector<'r> for Sides {
    fn only_crossings(&self) -> bool {
        true
    }

    fn offer(&mut self, id: PrimitiveId, crossing: &Crossing<'r>) -> ControlFlow<()> {
        match crossing.hit(id).side {
            Side::Front => self.front += 1,
            Side::Back => self.back += 1,
            Side::Along => panic!("crossed along"),
        }
        ControlFlow::Continue(())
    }
}

/// Returns whether each edge occurs equally often in both directions. Vertices are identified by their positions.
fn is_closed(soup: &Soup<f64>) -> bool {
    let mut edges: HashMap<[[u64; 3]; 2], i32> = HashMap::new();
    // Adding 0.0 makes the two zeros equal.
    let at = |i: u32| -> [u64; 3] { soup.positions()[i as usize].map(|x| (x + 0.0).to_bits()).coords.into() };
    for element in soup.elements() {
        let Element::Triangle(corners) = element else { return false };
        for k in 0..3 {
            let (a, b) = (at(corners[k]), at(corners[(k + 1) % 3]));
            if a < b {
                *edges.entry([a, b]).or_default() += 1;
            } else if b < a {
                *edges.entry([b, a]).or_default() -= 1;
            }
        }
    }
    edges.values().all(|sum| *sum == 0)
}

/// Returns a line through ten times the box. Half of the lines pass exactly through a vertex, or as closely through a
/// point of an edge as floats allow.
fn line<R: Rng>(rng: &mut R, soup: &Soup<f64>, bounds: &Aabb<f64>) -> Ray {
    let size = (bounds.max - bounds.min).amax();
    let middle = bounds.min + (bounds.max - bounds.min) * 0.5;
    let mut point = || middle + Vector3::from_fn(|_, _| rng.random_range(-0.7..0.7)) * size;
    let (from, to) = (point(), point());
    let triangle = soup.get(PrimitiveId::new(rng.random_range(0..soup.len())));
    let [a, b]: [Point3<f64>; 2] = [triangle.vertices()[0], triangle.vertices()[1]];
    let edge = a + (b - a) * rng.random::<f64>();
    let (origin, direction) = match rng.random_range(0..8) {
        0 => (a, to - from),
        1 => (a, Vector3::from_fn(|_, _| f64::from(rng.random_range(-2..=2)))),
        2 => (edge, to - from),
        3 => (from, if rng.random() { edge - from } else { a - from }),
        _ => (from, to - from),
    };
    Ray::new(&origin, &direction).or_else(|_| Ray::new(&a, &(to - from))).expect("finite").line()
}

fn sides<V: Volume>(tree: &TreeIndex<f64, &Soup<f64>, V>, line: &Ray) -> [usize; 2] {
    let mut sides = Sides::default();
    tree.visit_ray(line, &mut sides);
    [sides.front, sides.back]
}

/// A line enters a closed surface as often as it leaves, whatever edges and vertices it is aimed at.
#[test]
fn closed_models_let_nothing_slip_through() {
    let cases = cases(5000, 400);
    let closed = [
        "scan.obj",
        "scan.off",
        "scan.ply",
        "slivers.stl",
        "bunny.obj",
        "camel.off",
        "armadillo.obj",
        "lucy_100k.ply",
        "dragon_100k.obj",
    ];
    for path in model_files().iter().filter(|path| closed.iter().any(|name| path.ends_with(name))) {
        let (name, soup) = read(path);
        assert!(is_closed(&soup), "{name} should be closed");
        let boxes = AabbTree::new(&soup).expect("valid");
        let kdops = KdopTree::<f64, _, 14>::new(&soup).expect("valid");
        let bounds = soup.aabb();
        let [crossed, crossings] = on_all_cores(&cases, |i| {
            let line = line(&mut rng("lines of models", i), &soup, &bounds);
            let [front, back] = if i % 2 == 0 { sides(&boxes, &line) } else { sides(&kdops, &line) };
            assert_eq!(front, back, "{name}, line {i} {line:?}");
            [usize::from(front > 0), front + back]
        });
        println!("{name}: {crossed} of {} lines cross it, {crossings} times", cases.len());
        assert!(cases.have_more_than(1250, crossed), "{name}: lines are aimed at it");
    }
}
