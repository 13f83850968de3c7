//! Samples of a scene: parts of it that are cheap to index, and queries for them.
//!
//! A *neighbourhood sample* keeps primitives together, so that queries near the surface cost as much as in the whole
//! scene. A *subsample* takes primitives from everywhere, so that most of the scene stays about as far from a query
//! as it was.

use super::workload::QueryRegion;
use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use nalgebra::{Point3, Vector3};
use p2m_core::{BuildError, Element, Primitive, PrimitiveId, PrimitiveSet, Soup};
use std::collections::HashMap;

/// The number of neighbourhoods of a neighbourhood sample.
const NEIGHBOURHOODS: usize = 4;
/// A triangle is a sliver if its height is below this part of its longest edge.
const SLIVER_HEIGHT_PER_EDGE: f64 = 1.0 / 256.0;
/// The number of triangles that are examined for slivers.
const SLIVER_TEST_TRIANGLES: usize = 4096;
/// Points are near the surface if they are within this part of the diagonal of the centre of a primitive.
const NEAR_DISTANCE_PER_DIAGONAL: f64 = 0.05;
/// The standard deviation of generated queries near the surface, as a part of the diagonal.
const NEAR_DEVIATION_PER_DIAGONAL: f64 = 0.01;

/// The centre of a primitive's box.
fn box_centre(soup: &Soup<f64>, i: usize) -> Point3<f64> {
    let bounds = soup.get(PrimitiveId::new(i)).aabb();
    Point3::from(bounds.min.coords * 0.5 + bounds.max.coords * 0.5)
}

/// Returns about `count` primitives: the nearest ones to the centres of four primitives, which are evenly spaced in the
/// order of the scene. A single neighbourhood would have triangles of one orientation.
pub(crate) fn neighbourhood_sample(soup: &Soup<f64>, count: usize) -> Result<Soup<f64>, BuildError> {
    if count >= soup.len() {
        return subset(soup, 0..soup.len());
    }
    let centres: [Point3<f64>; NEIGHBOURHOODS] =
        std::array::from_fn(|i| box_centre(soup, soup.len() * (2 * i + 1) / (2 * NEIGHBOURHOODS)));
    let mut members: [Vec<(f64, usize)>; NEIGHBOURHOODS] = Default::default();
    for i in 0..soup.len() {
        let position = box_centre(soup, i);
        let squares = centres.iter().map(|centre| (position - centre).norm_squared()).enumerate();
        // Each primitive belongs to the neighbourhood of its nearest centre alone.
        if let Some((neighbourhood, square)) = squares.reduce(|a, b| if b.1 < a.1 { b } else { a }) {
            members[neighbourhood].push((square, i));
        }
    }
    for neighbourhood in &mut members {
        let size = count / NEIGHBOURHOODS;
        if size < neighbourhood.len() {
            neighbourhood.select_nth_unstable_by(size, |a, b| a.0.total_cmp(&b.0));
            neighbourhood.truncate(size);
        }
    }
    subset(soup, members.into_iter().flatten().map(|(_, i)| i))
}

/// Returns `count` primitives, evenly spaced in the order of the scene; all of them if there are fewer.
pub(crate) fn subsample(soup: &Soup<f64>, count: usize) -> Result<Soup<f64>, BuildError> {
    let count = count.min(soup.len());
    subset(soup, (0..count).map(|i| i * soup.len() / count))
}

/// Returns the primitives with these ids. They share vertices as they do in the scene.
fn subset(soup: &Soup<f64>, ids: impl Iterator<Item = usize>) -> Result<Soup<f64>, BuildError> {
    let mut part = Soup::default();
    let mut new_indices = HashMap::new();
    for i in ids {
        let mut new_index = |position: u32| {
            *new_indices.entry(position).or_insert_with(|| {
                // The subset has no more positions than the scene, so the index fits.
                u32::try_from(part.push_position(soup.positions()[position as usize])).unwrap_or(u32::MAX)
            })
        };
        let element = match soup.element(PrimitiveId::new(i)) {
            Element::Point(p) => Element::Point(new_index(p)),
            Element::Segment(s) => Element::Segment(s.map(&mut new_index)),
            Element::Triangle(t) => Element::Triangle(t.map(&mut new_index)),
        };
        part.push(element)?;
    }
    Ok(part)
}

/// Returns whether most primitives are slivers.
///
/// Many slivers are about equally near to a query, so lists are long and cells fall back to a tree. Samples do not show
/// that, because few slivers meet in them.
pub(crate) fn is_mostly_slivers(soup: &Soup<f64>) -> bool {
    let is_sliver = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| soup.positions()[i as usize]);
        let longest_squared = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
        (b - a).cross(&(c - a)).norm() < SLIVER_HEIGHT_PER_EDGE * longest_squared
    };
    let step = soup.triangles().len().div_ceil(SLIVER_TEST_TRIANGLES).max(1);
    let slivers = soup.triangles().iter().step_by(step).filter(|t| is_sliver(t)).count();
    2 * slivers * step > soup.len()
}

/// Returns `count` queries from the region for a sample of the scene; fewer if the region is given by fewer points.
pub(crate) fn sample_queries(
    soup: &Soup<f64>,
    sample: &Soup<f64>,
    region: QueryRegion<'_>,
    count: usize,
) -> Vec<Point3<f64>> {
    let bounds = sample.aabb();
    if let QueryRegion::Like(points) = region {
        // These are the points that are nearest to the centre of the sample.
        let centre = Point3::from(bounds.min.coords * 0.5 + bounds.max.coords * 0.5);
        let stride = points.len().div_ceil(64 * count).max(1);
        let finite = points.iter().step_by(stride).filter(|p| p.iter().all(|x| x.is_finite()));
        let mut by_distance: Vec<(f64, &Point3<f64>)> = finite.map(|p| ((p - centre).norm_squared(), p)).collect();
        by_distance.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        return by_distance.into_iter().take(count).map(|(_, p)| *p).collect();
    }
    let mut random = ChaCha8Rng::seed_from_u64(sample.len() as u64);
    #[allow(clippy::cast_precision_loss, reason = "53 bits")]
    let mut unit = move || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let scene = soup.aabb();
    let sigma = NEAR_DEVIATION_PER_DIAGONAL * (scene.max.coords * 0.5 - scene.min.coords * 0.5).norm() * 2.0;
    (0..count)
        .map(|_| match region {
            QueryRegion::NearSurface => {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below the count")]
                let i = (unit() * sample.len() as f64) as usize;
                // The sum of three uniform numbers is approximately normal. Scaled like this, its variance is 1/3, so
                // the offset has variance 1.
                let mut offset = || (unit() + unit() + unit() - 1.5) * 2.0 * 0.58;
                box_centre(sample, i.min(sample.len() - 1)) + Vector3::new(offset(), offset(), offset()) * sigma
            }
            _ => std::array::from_fn::<f64, 3, _>(|k| {
                let t = unit();
                bounds.min[k] * (1.0 - t) + bounds.max[k] * t
            })
            .into(),
        })
        .collect()
}

/// Returns whether queries from the region are near the surface. Of points, most have to be near the centre
/// of some primitive.
pub(crate) fn is_near_surface(soup: &Soup<f64>, region: QueryRegion<'_>) -> bool {
    match region {
        QueryRegion::NearSurface => true,
        QueryRegion::SceneBox => false,
        QueryRegion::Like(points) => are_points_near(soup, points),
    }
}

fn are_points_near(soup: &Soup<f64>, points: &[Point3<f64>]) -> bool {
    let bounds = soup.aabb();
    let max_distance = NEAR_DISTANCE_PER_DIAGONAL * (bounds.max.coords * 0.5 - bounds.min.coords * 0.5).norm() * 2.0;
    let centres: Vec<Point3<f64>> =
        (0..soup.len()).step_by(soup.len().div_ceil(512).max(1)).map(|i| box_centre(soup, i)).collect();
    let tested = points.iter().step_by(points.len().div_ceil(64).max(1));
    let near = tested.clone().filter(|p| centres.iter().any(|c| (*p - c).norm() <= max_distance)).count();
    2 * near > tested.count()
}
