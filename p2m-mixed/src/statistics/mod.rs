//! Statistics of a scene, and notes on properties that affect queries.
//!
//! [`Statistics`] are numbers, and [`Statistics::notes`] are sentences that follow from them. Decisions are exact: a
//! triangle has zero area if and only if its corners are on a line, and positions are equal if and only if their
//! coordinates are. Lengths and areas are accurate to 2^-20 at every scale. Those beyond the range of f64 are rounded
//! to the nearest positive number.

pub mod figure;
mod notes;
mod objects;
mod shape;

pub use notes::{MIN_FAR_DIAGONALS, MIN_SPREAD_ORDERS, Note};
pub use objects::{ObjectCounts, objects};

use nalgebra::Point3;
use p2m_core::engine::weld::{UNUSED, VertexWelder, group_by_vertex};
use p2m_core::kernel::SLIVER_SINE;
use p2m_core::{Aabb, Element, PrimitiveSet, Soup};
use shape::{TriangleMeasures, length};

/// The aspect above which triangles are [thin](Shapes::thin). An equilateral triangle has the aspect 1.15, half a
/// square has 2, and a [sliver](Shapes::slivers) more than 1024.
pub const THIN_ASPECT: f64 = 10.0;

/// The statistics of a scene.
///
/// ```
/// use p2m_mixed::statistics::Statistics;
///
/// let scene = p2m_mixed::read_obj("v 0 0 0\nv 3 0 0\nv 0 4 0\nv 6 0 0\nf 1 2 3\nf 1 2 4\n".as_bytes(), "two.obj")?;
/// let statistics = Statistics::of(&scene.soup);
/// assert_eq!((statistics.primitives.triangles, statistics.shapes.zero_area), (2, 1));
/// assert_eq!(statistics.sizes.edge.map(|e| (e.min, e.max)), Some((3.0, 6.0)));
/// let note = "1 triangle has no area: it counts as the segment or point that it covers";
/// assert_eq!(statistics.notes()[0].to_string(), note);
/// # Ok::<(), p2m_mixed::ReadError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Statistics {
    /// The number of primitives of each kind.
    pub primitives: Counts,
    /// The number of positions.
    pub positions: Positions,
    /// The bounding box of the primitives, or `None` for an empty scene.
    pub bounds: Option<Aabb<f64>>,
    /// The number of duplicates: primitives with the same corners as another one, by coordinates and in any order. One
    /// of several equal primitives does not count.
    pub duplicates: Counts,
    /// The edges of the triangles, and how triangles share them.
    pub edges: Edges,
    /// The number of parts, segments and points included, that share no corner (by coordinates) with each other.
    pub components: u64,
    /// The shapes of triangles and segments.
    pub shapes: Shapes,
    /// The smallest and largest sizes.
    pub sizes: Sizes,
    /// The location of the scene, and how f32 represents it.
    pub location: Location,
    /// Whether the surface is closed and its triangles face inwards, so that it encloses a negative volume.
    pub is_inside_out: bool,
}

/// The number of primitives of each kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// The number of triangles.
    pub triangles: u64,
    /// The number of segments.
    pub segments: u64,
    /// The number of points.
    pub points: u64,
}

impl Counts {
    /// Returns the number of primitives of all kinds.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.triangles + self.segments + self.points
    }

    /// Counts the primitives of a soup.
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

/// The number of positions of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Positions {
    /// The number of all positions.
    pub total: u64,
    /// The number of positions that belong to a primitive.
    pub used: u64,
    /// The number of distinct coordinates among the used positions.
    pub distinct: u64,
}

/// The edges of triangles, identified by the coordinates of their ends. Triangles with two equal corners have none.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Edges {
    /// The number of all edges.
    pub total: u64,
    /// The number of edges of one triangle, which are the rim of an open surface.
    pub boundary: u64,
    /// The number of edges of more than two triangles.
    pub non_manifold: u64,
    /// The number of edges of two triangles that run through the edge in the same direction, so that they
    /// face opposite sides.
    pub inconsistent: u64,
}

impl Edges {
    /// Returns whether the triangles enclose volumes: every edge belongs to two triangles that face the same side.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.total > 0 && self.boundary + self.non_manifold + self.inconsistent == 0
    }
}

/// The shapes of triangles and segments. The aspect of a triangle is its longest edge divided by its height
/// over that edge.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Shapes {
    /// The number of triangles whose corners are exactly on a line, or equal.
    pub zero_area: u64,
    /// The number of segments whose ends are equal.
    pub zero_length: u64,
    /// The number of triangles with an area and an aspect above 1024, the inverse of [`SLIVER_SINE`]. Queries measure
    /// them in double-double arithmetic.
    pub slivers: u64,
    /// The number of triangles with an area and an aspect above [`THIN_ASPECT`], slivers included.
    pub thin: u64,
    /// The (upper) median aspect of the triangles with an area, or `None` if there are none.
    pub median_aspect: Option<f64>,
}

/// The smallest and the largest value of a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// The smallest value.
    pub min: f64,
    /// The largest value.
    pub max: f64,
}

impl Extremes {
    fn add(extremes: &mut Option<Self>, x: f64) {
        let old = extremes.unwrap_or(Self { min: x, max: x });
        *extremes = Some(Self { min: old.min.min(x), max: old.max.max(x) });
    }

    /// Returns the orders of magnitude between the values: log10(max / min).
    #[must_use]
    pub fn orders_of_magnitude(&self) -> f64 {
        self.max.log10() - self.min.log10()
    }
}

/// The sizes of a scene, in units of the scene. Sizes of zero are left out.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Sizes {
    /// The diagonal of the bounding box.
    pub diagonal: f64,
    /// The smallest and largest length of a segment or of an edge of a triangle.
    pub edge: Option<Extremes>,
    /// The smallest and largest area of a triangle.
    pub area: Option<Extremes>,
}

/// The location of a scene. All numbers of an empty scene are 0.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Location {
    /// The distance of the centre of the bounding box from the origin.
    pub distance_from_origin: f64,
    /// The largest magnitude of a coordinate.
    pub largest_coordinate: f64,
    /// The number of coordinates, three for each distinct position, that f32 cannot represent exactly.
    pub beyond_f32: u64,
}

impl Location {
    /// Returns the spacing of f32 numbers at the largest coordinate, or `None` if it is beyond the range of f32.
    #[must_use]
    pub fn f32_step(&self) -> Option<f64> {
        #[allow(clippy::cast_possible_truncation, reason = "rounded on purpose")]
        let x = self.largest_coordinate as f32;
        x.is_finite().then(|| f64::from(x) - f64::from(x.next_down()))
    }

    /// Returns the spacing of f64 numbers at the largest coordinate.
    #[must_use]
    pub fn f64_step(&self) -> f64 {
        self.largest_coordinate - self.largest_coordinate.next_down()
    }
}

impl Statistics {
    /// Computes the statistics of a scene.
    ///
    /// # Complexity
    /// O(n log n) time. Memory is about 40 bytes for each triangle while the function runs.
    #[must_use]
    pub fn of(soup: &Soup<f64>) -> Self {
        let welder = VertexWelder::new(soup);
        let (shapes, sizes) = measure(soup);
        let bounds = (!soup.is_empty()).then(|| soup.aabb());
        let edges = edges(soup, &welder);
        let is_inside_out = edges.is_closed() && bounds.is_some_and(|bounds| has_negative_volume(soup, &bounds));
        Self {
            primitives: Counts::of(soup),
            positions: Positions {
                total: soup.positions().len() as u64,
                used: welder.used_positions as u64,
                distinct: welder.vertex_count as u64,
            },
            bounds,
            duplicates: duplicates(soup, &welder),
            edges,
            components: welder.count_components(soup) as u64,
            shapes,
            sizes,
            location: bounds.map_or_else(Location::default, |b| locate(soup, &welder, &b)),
            is_inside_out,
        }
    }

    /// Returns the notes that follow from the statistics, the most important first.
    #[must_use]
    pub fn notes(&self) -> Vec<Note> {
        notes::notes(self)
    }
}

/// Returns the number of items of a sorted list that equal the item before.
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
    // An edge is stored at its lower vertex, with the higher vertex and whether the triangle runs upwards.
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

/// Returns whether the triangles of a closed surface enclose a negative volume, beyond rounding.
#[allow(clippy::cast_precision_loss, reason = "an estimate of rounding")]
fn has_negative_volume(soup: &Soup<f64>, bounds: &Aabb<f64>) -> bool {
    let half = 0.5 * (bounds.max - bounds.min).amax();
    let centre = bounds.min + 0.5 * (bounds.max - bounds.min);
    // In this frame coordinates are at most 1, up to rounding: the error of each is below 8 u of the largest
    // coordinate. A product of three has an error of at most 64 times that, and so has each of the six products.
    let at = |i: u32| (soup.positions()[i as usize] - centre) / half;
    let volume: f64 = soup.triangles().iter().map(|t| at(t[0]).dot(&at(t[1]).cross(&at(t[2])))).sum();
    let largest = bounds.min.iter().chain(bounds.max.iter()).fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let error = 512.0 * f64::EPSILON * (1.0 + largest / half) * soup.triangles().len() as f64;
    volume < -error
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
        let measure = TriangleMeasures::new(t.map(at));
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
        let median = aspects.len() / 2;
        shapes.median_aspect = Some(aspects.select_nth_unstable_by(median, f64::total_cmp).1.min(f64::MAX));
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
