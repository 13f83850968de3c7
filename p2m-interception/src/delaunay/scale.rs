//! From points to sites: points are scaled, sorted and made distinct, and the six bounding sites are placed around
//! them.

#![allow(clippy::float_cmp, reason = "points are the same site if they are equal")]

use crate::delaunay::tetrahedron::BOUNDING;
use p2m_core::engine::adaptive::RANGE;
use p2m_core::engine::curve::{bounds, sort_along_curve};
use p2m_core::engine::vector::power_of_two;
use p2m_core::engine::vector::{V3, exponent, larger, largest, scale_by_power};

/// The sites of some points.
#[derive(Clone, Debug)]
pub(crate) struct ScaledSites {
    /// The bounding sites, then the distinct points along the curve, divided by the unit.
    pub(crate) positions: Vec<V3>,
    /// The unit of the sites, a power of two.
    pub(crate) unit: f64,
    /// For each point the number of its site.
    pub(crate) site_of: Vec<u32>,
}

impl ScaledSites {
    /// Makes the sites of finite points, of which there are fewer than
    /// [`Delaunay::MAX_POINTS`](super::Delaunay::MAX_POINTS).
    #[allow(clippy::cast_possible_truncation, reason = "fewer than numbers")]
    pub(crate) fn new(points: &[V3], reach: f64) -> Self {
        let largest = largest(points);
        let unit = if largest == 0.0 { 0 } else { exponent(largest) };
        let scaled: Vec<V3> = points.iter().map(|p| p.map(|x| scale(x, unit))).collect();
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        sort_along_curve(&scaled, &mut order);
        let mut positions = Vec::with_capacity(BOUNDING + points.len());
        positions.extend(bounding_sites(&scaled, reach));
        let mut site_of = vec![0; points.len()];
        for i in order {
            let p = scaled[i as usize];
            if positions.len() == BOUNDING || positions[positions.len() - 1] != p {
                positions.push(p);
            }
            site_of[i as usize] = positions.len() as u32 - 1;
        }
        positions.shrink_to_fit();
        Self { positions, unit: scale_by_power(1.0, unit), site_of }
    }
}

/// Returns x 2^-unit, or 0 if that is too small for the predicates, and never -0.
fn scale(x: f64, unit: i32) -> f64 {
    // The product is exact: it is at most 2, and it is rounded only where it is subnormal, which becomes 0.
    let scaled = if (-1000..=1000).contains(&unit) { x * power_of_two(-unit) } else { scale_by_power(x, -unit) };
    if scaled.abs() < *RANGE.start() { 0.0 } else { scaled }
}

/// Returns the bounding sites of points of size below 2: c - D and c + D on each axis. Here c and D are multiples of a
/// power of two, so that the six sites are exact and equally far from c, and tests with them often need few bits.
///
/// All points are strictly inside the octahedron: |p - c|_1 <= 3h + 2 steps < D, with two steps for the rounding of c
/// and of h, which is half the longest side. Also |p - c|_2 < D, so the first point is inside the spheres of all
/// tetrahedra of the six.
///
/// The condition D (D - 2M) > 3h^2 + 6Mh for queries within M of the centre (see [`super::Delaunay::new`]) survives
/// the rounding. With c off by half a step on each axis and D larger by three steps, the left side grows by at least
/// 5D - 6M steps and the right side by 6h + 3M. The latter is less, as the condition implies D > M + sqrt(M^2 + 6Mh +
/// 3h^2).
fn bounding_sites(points: &[V3], reach: f64) -> [V3; BOUNDING] {
    let [low, high] = if points.is_empty() { [[0.0; 3]; 2] } else { bounds(points.iter().copied()) };
    let half_extent: V3 = std::array::from_fn(|k| 0.5 * high[k] - 0.5 * low[k]);
    let half_extent = match half_extent.into_iter().fold(0.0, larger) {
        0.0 => 1.0,
        half_extent => half_extent,
    };
    let distance = reach * half_extent;
    // Coordinates are below 2^e, so the bounding sites are below 2^(e + 1). They are multiples of 2^(e - 50).
    let e = exponent(larger(distance, 1.0)) + 1;
    let step = power_of_two((exponent(distance) - 9).max(e - 50));
    let distance = ((distance / step).ceil() + 3.0) * step;
    let centre: V3 = std::array::from_fn(|k| ((0.5 * high[k] + 0.5 * low[k]) / step).round_ties_even() * step);
    std::array::from_fn(|i| {
        let mut site = centre;
        site[i / 2] += if i % 2 == 0 { -distance } else { distance };
        site
    })
}
