//! What a scene is made of, and what a person should know before asking it for closest points.
//!
//! [`Statistics`] are figures; [`Statistics::notes`] are the sentences that these figures warrant. What can be decided
//! exactly is: a triangle counts as one of zero area if and only if its corners are on a line, positions are the same
//! if and only if their coordinates are. Lengths and areas are good to 2^-20 at every scale; those that f64 cannot hold
//! are given as the nearest positive number that it can.

pub mod figure;
mod notes;
mod objects;
mod shape;

pub use notes::{FAR, Note, SPREAD};
pub use objects::{ObjectCounts, objects};

use crate::weld::{UNUSED, VertexWelder, group_by_vertex};
use nalgebra::Point3;
use p2m_core::kernel::SLIVER_SINE;
use p2m_core::{Aabb, Element, PrimitiveSet, Soup};
use shape::{Measure, length};

/// Triangles whose longest edge is more than so many times the height over it are [thin](Shapes::thin). An equilateral
/// one has 1.15, half a square 2, a [sliver](Shapes::slivers) more than 1024.
pub const THIN_ASPECT: f64 = 10.0;

/// Figures of a scene.
///
/// ```
/// use p2m_mixed::statistics::Statistics;
///
/// let scene = p2m_mixed::read_obj("v 0 0 0\nv 3 0 0\nv 0 4 0\nv 6 0 0\nf 1 2 3\nf 1 2 4\n".as_bytes(), "two.obj")?;
/// let statistics = Statistics::of(&scene.soup);
/// assert_eq!((statistics.primitives.triangles, statistics.shapes.zero_area), (2, 1));
/// assert_eq!(statistics.sizes.edge.map(|e| (e.min, e.max)), Some((3.0, 6.0)));
/// assert_eq!(statistics.notes()[0].to_string(), "1 triangle has no area: it counts as the segment or point that it covers");
/// # Ok::<(), p2m_mixed::ReadError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Statistics {
    /// Primitives by kind.
    pub primitives: Counts,
    /// Positions of the file.
    pub positions: Positions,
    /// The box of the primitives; `None` for an empty scene.
    pub bounds: Option<Aabb<f64>>,
    /// Primitives that repeat another one: all but one of those that have the same corners, by coordinates and in any
    /// order.
    pub duplicates: Counts,
    /// How triangles meet.
    pub edges: Edges,
    /// Parts of the scene that share no corner (by coordinates) with each other, segments and points included.
    pub components: u64,
    /// Shapes of triangles and segments.
    pub shapes: Shapes,
    /// The smallest and the largest.
    pub sizes: Sizes,
    /// Where the scene lies, and what f32 would make of it.
    pub location: Location,
}

/// Primitives by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Triangles.
    pub triangles: u64,
    /// Segments.
    pub segments: u64,
    /// Points.
    pub points: u64,
}

impl Counts {
    /// Of all kinds.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.triangles + self.segments + self.points
    }

    /// Those of a soup.
    #[must_use]
    pub fn of(soup: &Soup<f64>) -> Self {
        Self {
            triangles: soup.triangles().len() as u64,
            segments: soup.segments().len() as u64,
            points: soup.points().len() as u64,
        }
    }

    fn of_kind(&mut self, element: Element) -> &mut u64 {
        match element {
            Element::Triangle(_) => &mut self.triangles,
            Element::Segment(_) => &mut self.segments,
            Element::Point(_) => &mut self.points,
        }
    }
}

/// Positions of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Positions {
    /// All of them.
    pub total: u64,
    /// Those that belong to a primitive.
    pub used: u64,
    /// Different coordinates among those that are used.
    pub distinct: u64,
}

/// Edges of triangles, by the coordinates of their ends; triangles with two equal corners have none.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Edges {
    /// All of them.
    pub total: u64,
    /// Those of one triangle: the rim of an open surface.
    pub boundary: u64,
    /// Those of more than two.
    pub non_manifold: u64,
    /// Those of two triangles which both run through them in the same direction: neighbours that face opposite sides.
    pub inconsistent: u64,
}

impl Edges {
    /// Whether the triangles enclose volumes: every edge belongs to two of them that face the same side.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.total > 0 && self.boundary + self.non_manifold + self.inconsistent == 0
    }
}

/// Shapes of triangles and segments. The aspect of a triangle is its longest edge over its height over that edge.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Shapes {
    /// Triangles whose corners are exactly on a line, or in one place.
    pub zero_area: u64,
    /// Segments whose ends are in one place.
    pub zero_length: u64,
    /// Triangles with an area whose aspect is above 1024, the inverse of [`SLIVER_SINE`]: they are measured in
    /// double-double.
    pub slivers: u64,
    /// Triangles with an area whose aspect is above [`THIN_ASPECT`], slivers among them.
    pub thin: u64,
    /// The (upper) median aspect of the triangles with an area, if there are any.
    pub median_aspect: Option<f64>,
}

/// The smallest and the largest of something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// The smallest.
    pub min: f64,
    /// The largest.
    pub max: f64,
}

impl Extremes {
    fn add(extremes: &mut Option<Self>, x: f64) {
        let old = extremes.unwrap_or(Self { min: x, max: x });
        *extremes = Some(Self { min: old.min.min(x), max: old.max.max(x) });
    }

    /// By how many orders of magnitude they differ: log10(max / min).
    #[must_use]
    pub fn orders_of_magnitude(&self) -> f64 {
        self.max.log10() - self.min.log10()
    }
}

/// Sizes; what has none (zero length, zero area) is left out.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Sizes {
    /// The diagonal of the box.
    pub diagonal: f64,
    /// Lengths of the edges of triangles, and of segments.
    pub edge: Option<Extremes>,
    /// Areas of triangles.
    pub area: Option<Extremes>,
}

/// Where a scene lies; everything is 0, and fits, for an empty one.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Location {
    /// The centre of the box to the origin.
    pub distance_from_origin: f64,
    /// The largest magnitude of a coordinate.
    pub largest_coordinate: f64,
    /// Coordinates (three a distinct position) that are no numbers of f32.
    pub beyond_f32: u64,
}

impl Location {
    /// How far the numbers of f32 are apart at the largest coordinate; `None` if they do not reach it.
    #[must_use]
    pub fn f32_step(&self) -> Option<f64> {
        #[allow(clippy::cast_possible_truncation, reason = "rounded on purpose")]
        let x = self.largest_coordinate as f32;
        x.is_finite().then(|| f64::from(x) - f64::from(x.next_down()))
    }

    /// How far the numbers of f64 are apart at the largest coordinate.
    #[must_use]
    pub fn f64_step(&self) -> f64 {
        self.largest_coordinate - self.largest_coordinate.next_down()
    }
}

impl Statistics {
    /// The figures of a scene.
    ///
    /// # Complexity
    /// O(n log n) time, about 40 bytes a triangle while it runs.
    #[must_use]
    pub fn of(soup: &Soup<f64>) -> Self {
        let welder = VertexWelder::new(soup);
        let (shapes, sizes) = measure(soup);
        let bounds = (!soup.is_empty()).then(|| soup.aabb());
        Self {
            primitives: Counts::of(soup),
            positions: Positions {
                total: soup.positions().len() as u64,
                used: welder.used_positions as u64,
                distinct: welder.vertex_count as u64,
            },
            bounds,
            duplicates: duplicates(soup, &welder),
            edges: edges(soup, &welder),
            components: welder.count_components(soup) as u64,
            shapes,
            sizes,
            location: bounds.map_or_else(Location::default, |b| locate(soup, &welder, &b)),
        }
    }

    /// What a person should know, most important first; nothing that the figures do not warrant.
    #[must_use]
    pub fn notes(&self) -> Vec<Note> {
        notes::notes(self)
    }
}

/// How many of a sorted list are like the one before.
fn repeated<K: PartialEq>(sorted: &[K]) -> u64 {
    sorted.windows(2).filter(|w| w[0] == w[1]).count() as u64
}

fn duplicates(soup: &Soup<f64>, welder: &VertexWelder) -> Counts {
    let mut counts = Counts::default();
    let triangles = soup.triangles().iter().map(|t| {
        let mut corners = welder.weld(*t);
        corners.sort_unstable();
        (corners[0], [corners[1], corners[2]])
    });
    group_by_vertex(welder.vertex_count, triangles, |group| counts.triangles += repeated(group));
    let segments = soup.segments().iter().map(|s| {
        let [a, b] = welder.weld(*s);
        (a.min(b), a.max(b))
    });
    group_by_vertex(welder.vertex_count, segments, |group| counts.segments += repeated(group));
    group_by_vertex(welder.vertex_count, soup.points().iter().map(|p| (welder.weld([*p])[0], ())), |group| {
        counts.points += repeated(group)
    });
    counts
}

fn edges(soup: &Soup<f64>, welder: &VertexWelder) -> Edges {
    let mut edges = Edges::default();
    // The end with the lower number, the other one, and whether the triangle runs from the former to the latter.
    let all = soup.triangles().iter().flat_map(|t| {
        let [a, b, c] = welder.weld(*t);
        let has_edges = a != b && b != c && c != a;
        [(a, b), (b, c), (c, a)].into_iter().filter(move |_| has_edges).map(|(a, b)| (a.min(b), (a.max(b), a < b)))
    });
    group_by_vertex(welder.vertex_count, all, |group| {
        for edge in group.chunk_by(|x, y| x.0 == y.0) {
            edges.total += 1;
            match edge {
                [_] => edges.boundary += 1,
                [one, other] => edges.inconsistent += u64::from(one.1 == other.1),
                _ => edges.non_manifold += 1,
            }
        }
    });
    edges
}

fn measure(soup: &Soup<f64>) -> (Shapes, Sizes) {
    let at = |i: u32| soup.positions()[i as usize];
    let mut shapes = Shapes::default();
    let mut sizes = Sizes::default();
    let mut add_length = |x: f64| {
        if x > 0.0 {
            Extremes::add(&mut sizes.edge, x);
        }
    };
    let mut aspects = Vec::with_capacity(soup.triangles().len());
    for t in soup.triangles() {
        let measure = Measure::of(t.map(at));
        measure.edges.into_iter().for_each(&mut add_length);
        if measure.area > 0.0 {
            Extremes::add(&mut sizes.area, measure.area);
            shapes.slivers += u64::from(measure.sine < SLIVER_SINE);
            shapes.thin += u64::from(measure.sine * THIN_ASPECT < 1.0);
            aspects.push(1.0 / measure.sine);
        } else {
            shapes.zero_area += 1;
        }
    }
    for s in soup.segments() {
        let [a, b] = s.map(|i| at(i).coords.into());
        let length = length(a, b);
        add_length(length);
        shapes.zero_length += u64::from(length == 0.0);
    }
    if !aspects.is_empty() {
        let middle = aspects.len() / 2;
        shapes.median_aspect = Some(aspects.select_nth_unstable_by(middle, f64::total_cmp).1.min(f64::MAX));
    }
    if !soup.is_empty() {
        let bounds = soup.aabb();
        sizes.diagonal = length(bounds.min.coords.into(), bounds.max.coords.into());
    }
    (shapes, sizes)
}

#[allow(clippy::cast_possible_truncation, clippy::float_cmp, reason = "whether f32 rounds is the question")]
fn locate(soup: &Soup<f64>, welder: &VertexWelder, bounds: &Aabb<f64>) -> Location {
    let mut seen = vec![false; welder.vertex_count];
    let mut location = Location::default();
    for (p, &vertex) in soup.positions().iter().zip(&welder.vertex_ids) {
        if vertex == UNUSED || std::mem::replace(&mut seen[vertex as usize], true) {
            continue;
        }
        for &x in p.iter() {
            location.largest_coordinate = location.largest_coordinate.max(x.abs());
            location.beyond_f32 += u64::from(f64::from(x as f32) != x);
        }
    }
    let centre: [f64; 3] = std::array::from_fn(|k| bounds.min[k] / 2.0 + bounds.max[k] / 2.0);
    location.distance_from_origin = length(Point3::origin().coords.into(), centre);
    location
}
