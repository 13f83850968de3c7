//! Checks of rays at scenes from bytes: every tree is compared with rational arithmetic.
//!
//! The first byte selects the scalar, and the next ones a tree. Then come the scene and up to three rays.

use super::backends::tree;
use super::bytes::Bytes;
use super::scene::{SceneDraft, vertices};
use nalgebra::{Point3, Vector3};
use p2m::core::RayError;
use p2m::{BruteForce, PrimitiveSet, Ray, Real, Soup};
use p2m_testkit::ray_check::{Truth, agrees};
use p2m_testkit::scenes::narrow;

/// The largest number of primitives of a scene. It is small because the integers for a ray are long.
const MAX_PRIMITIVES: usize = 16;

struct Input<'a> {
    is_single: bool,
    backend: Bytes<'a>,
    seed: u64,
    draft: SceneDraft,
    rays: Vec<Ray>,
}

impl<'a> Input<'a> {
    fn new(input: &'a [u8]) -> Self {
        let mut bytes = Bytes::new(input);
        let is_single = bytes.byte() % 4 == 1;
        let (backend, seed) = (Bytes::new(bytes.take(2)), u64::from(bytes.byte()));
        let draft = SceneDraft::new(&mut bytes, MAX_PRIMITIVES);
        let rays = (0..=bytes.below(3)).filter_map(|_| draw_ray(&mut bytes, &draft).ok()).collect();
        Self { is_single, backend, seed, draft, rays }
    }
}

/// Returns a ray from a point towards another one, or in a direction of small integers or between other points. An
/// invalid ray has to be the right error.
fn draw_ray(bytes: &mut Bytes<'_>, draft: &SceneDraft) -> Result<Ray, RayError> {
    let (kind, from) = (bytes.below(5), draft.query(bytes));
    let direction = match kind {
        0 | 1 => draft.query(bytes) - from,
        2 => Vector3::from([0; 3].map(|_| f64::from(bytes.signed() % 4))),
        3 => draft.query(bytes) - draft.query(bytes),
        _ => draft.query(bytes).coords,
    };
    let finite = from.iter().chain(&direction).all(|x| x.is_finite());
    let expected = match finite {
        false => Some(RayError::NonFinite),
        true => Some(RayError::ZeroDirection).filter(|_| direction == Vector3::zeros()),
    };
    let ray = Ray::new(&from, &direction);
    assert_eq!(ray.err(), expected, "{from:?} {direction:?}");
    let radius = match bytes.below(4) {
        0 => f64::from(bytes.byte()) * 0.25,
        1 => 2f64.powi(4 * i32::from(bytes.signed())),
        _ => 0.0,
    };
    let ray = ray?.with_radius(radius).expect("finite");
    Ok(if bytes.below(2) == 0 { ray } else { ray.line() })
}

/// Formats the scene and the rays of an input.
#[must_use]
pub fn describe(input: &[u8]) -> String {
    let Input { draft, rays, .. } = Input::new(input);
    format!("{}\nrays {rays:?}", draft.describe())
}

/// Runs the check of an input, and returns the backend and the number of rays.
///
/// # Panics
/// Panics if an answer is wrong.
pub fn check(input: &[u8]) -> Option<(&'static str, usize)> {
    let Input { is_single, backend, seed, draft, rays } = Input::new(input);
    let soup = draft.soup().ok()?;
    match narrow(&soup).filter(|_| is_single) {
        Some(single) => Some(check_in(&single, backend, &rays, seed)),
        None => Some(check_in(&soup, backend, &rays, seed)),
    }
}

fn check_in<T: Real>(soup: &Soup<T>, mut backend: Bytes<'_>, rays: &[Ray], seed: u64) -> (&'static str, usize) {
    let primitives: Vec<_> = (0..soup.len()).map(|id| vertices(soup, id)).collect();
    let brute = BruteForce::new(soup).expect("finite");
    let (name, tree) = tree(&mut backend, soup).expect("finite");
    let mut rng = p2m_testkit::rng("ranges of fuzzed rays", seed);
    for ray in rays {
        let truth = Truth::new(&primitives, 0..primitives.len(), ray);
        let [min, max] = truth.range(&mut rng);
        for ray in [*ray, ray.with_range(min, max).expect("in order")] {
            let hits = truth.checked_hits(&brute, &ray, &|| "brute force".to_owned());
            let crossings = truth.crossings(&ray);
            agrees(&brute, &ray, &hits, crossings, &|| "brute force".to_owned());
            agrees(&*tree, &ray, &hits, crossings, &|| name.to_owned());
        }
    }
    let origin = Point3::<f64>::origin();
    assert!(!soup.is_empty() || !tree.do_intersect(&Ray::new(&origin, &Vector3::x()).expect("a ray")));
    (name, rays.len())
}
