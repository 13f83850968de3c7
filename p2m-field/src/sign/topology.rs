//! How the triangles of a closed surface are joined along their edges.

use super::pseudonormal::Rays;
use super::{SignError, check_kinds};
use nalgebra::Point3;
use p2m_core::{Crossing, PrimitiveId, Ray, RayCollector, Soup};
use p2m_mixed::engine::places::{Forest, Places, UNUSED, by_place};
use std::ops::ControlFlow;

/// No triangle: more than two have the edge, or the triangle has corners at one place.
pub(super) const NONE: u32 = u32::MAX;

/// The neighbours of triangles.
pub(super) struct Topology {
    /// The place of each position.
    pub(super) places: Places,
    /// The triangle beyond each edge.
    pub(super) neighbours: Vec<[u32; 3]>,
    /// The part of the surface that each triangle is in, which hangs together along edges.
    pub(super) parts: Vec<u32>,
    /// Whether the triangles around a place are one fan.
    pub(super) is_fan: Vec<bool>,
}

/// A half-edge: where it ends, whether it runs to the place of the higher number, and whose it is (3 triangle + edge).
type Half = (u32, bool, u32);

impl Topology {
    /// # Errors
    /// For what is no closed surface with one side out.
    #[allow(clippy::cast_possible_truncation, reason = "ids are below 2^30")]
    pub(super) fn new(soup: &Soup<f64>) -> Result<Self, SignError> {
        check_kinds(soup)?;
        let places = Places::new(soup);
        let triangles = soup.triangles();
        let halves = triangles.iter().enumerate().flat_map(|(t, corners)| {
            let [a, b, c] = places.of(*corners);
            let has_edges = a != b && b != c && c != a;
            let edges = [(a, b), (b, c), (c, a)].into_iter().enumerate().filter(move |_| has_edges);
            edges.map(move |(i, (a, b))| (a.min(b), (a.max(b), a < b, (3 * t + i) as u32)))
        });
        let mut neighbours = vec![[NONE; 3]; triangles.len()];
        let (mut parts, mut fans) = (Forest::new(triangles.len()), Forest::new(3 * triangles.len()));
        let mut error: Option<(u32, bool)> = None;
        by_place(places.len, halves, |halves: &[Half]| {
            for halves in halves.chunk_by(|x, y| x.0 == y.0) {
                let along = halves.iter().filter(|half| half.1).count();
                if 2 * along != halves.len() {
                    let whose = halves.iter().map(|half| half.2).min().unwrap_or(0);
                    let is_open = halves.len() % 2 == 1;
                    error = Some(error.map_or((whose, is_open), |error| error.min((whose, is_open))));
                } else if let [(_, _, one), (_, _, other)] = *halves {
                    let next = |half: u32| half - half % 3 + (half + 1) % 3;
                    neighbours[one as usize / 3][one as usize % 3] = other / 3;
                    neighbours[other as usize / 3][other as usize % 3] = one / 3;
                    parts.unite(one / 3, other / 3);
                    fans.unite(one, next(other));
                    fans.unite(next(one), other);
                }
            }
        });
        if let Some((whose, is_open)) = error {
            let (triangle, edge) = (whose as usize / 3, whose as usize % 3);
            return Err(if is_open {
                SignError::Open { triangle, edge }
            } else {
                SignError::NotOriented { triangle, edge }
            });
        }
        let (mut is_fan, mut fan_of) = (vec![true; places.len], vec![UNUSED; places.len]);
        for (corner, position) in triangles.iter().flatten().enumerate() {
            let (place, fan) = (places.of[*position as usize] as usize, fans.root(corner as u32));
            if fan_of[place] == UNUSED {
                fan_of[place] = fan;
            }
            is_fan[place] &= fan_of[place] == fan;
        }
        let parts = (0..triangles.len() as u32).map(|t| parts.root(t)).collect();
        Ok(Self { places, neighbours, parts, is_fan })
    }

    /// The lowest triangle an edge of which meets another one, beside those at its ends; and that one.
    pub(super) fn meets_itself(&self, soup: &Soup<f64>, rays: &Rays<'_>) -> Option<[usize; 2]> {
        let at = |position: u32| -> Point3<f64> { soup.positions()[position as usize] };
        for (t, corners) in soup.triangles().iter().enumerate() {
            for (i, neighbour) in self.neighbours[t].iter().enumerate() {
                // Each edge once, by its triangle of the lower number.
                if (*neighbour as usize) < t {
                    continue;
                }
                let ends = [corners[i], corners[(i + 1) % 3]];
                // No ray: the ends are one place, or so far apart that there is no number for it.
                let Ok(ray) = Ray::new(&at(ends[0]), &(at(ends[1]) - at(ends[0]))) else { continue };
                let ray = ray.with_range(0.0, 1.0).expect("one is above zero");
                let mut apart = Apart { places: &self.places, soup, ends: self.places.of(ends), lowest: None };
                rays.visit_ray(&ray, &mut apart);
                if let Some(other) = apart.lowest {
                    return Some([t, other.index()]);
                }
            }
        }
        None
    }
}

/// The lowest triangle that an edge meets, of those without a corner at one of its ends: the others all meet it there, which only
/// exact arithmetic could tell.
struct Apart<'a> {
    places: &'a Places,
    soup: &'a Soup<f64>,
    ends: [u32; 2],
    lowest: Option<PrimitiveId>,
}

impl<'r> RayCollector<'r> for Apart<'_> {
    fn wants(&self, triangle: PrimitiveId) -> bool {
        let corners = self.places.of(self.soup.triangles()[triangle.index()]);
        self.lowest.is_none_or(|lowest| triangle < lowest) && corners.iter().all(|place| !self.ends.contains(place))
    }

    fn offer(&mut self, triangle: PrimitiveId, _: &Crossing<'r>) -> ControlFlow<()> {
        self.lowest = Some(triangle);
        ControlFlow::Continue(())
    }
}
