//! Notes on a scene: sentences that follow from its statistics.

use super::figure::{Count, Exact, Figure, Share};
use super::{Statistics, THIN_ASPECT};
use std::fmt;

/// A property of a scene that affects queries. It displays as a sentence without a stop.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Note {
    /// The scene has no primitives.
    Empty,
    /// A coordinate or an edge is beyond 1e-120..1e120. Distances may be as well, and trees do not prune at such
    /// distances.
    ExtremeScale,
    /// A coordinate is beyond the range of f32.
    BeyondF32,
    /// The scene is at least [`MIN_FAR_DIAGONALS`] diagonals away from the origin.
    FarFromOrigin {
        /// The distance of its centre from the origin.
        distance: f64,
        /// The distance from the origin in diagonals of the scene. Scenes of a single point have no such note, because
        /// it would be infinite.
        times: f64,
        /// The spacing of f32 numbers at the largest coordinate, or `None` if it is beyond the range of f32.
        f32_step: Option<f64>,
        /// The spacing of f64 numbers at the largest coordinate.
        f64_step: f64,
    },
    /// At least 1 % of the triangles are slivers.
    Slivers {
        /// The number of such triangles among all triangles.
        share: Share,
    },
    /// At least half of the triangles are thin.
    Thin {
        /// The number of such triangles among all triangles.
        share: Share,
        /// The median aspect.
        median: f64,
    },
    /// The scene has triangles without area.
    ZeroArea {
        /// The number of such triangles.
        count: u64,
    },
    /// The scene has segments without length.
    ZeroLength {
        /// The number of such segments.
        count: u64,
    },
    /// The scene has primitives that duplicate others.
    Duplicates {
        /// The number of such primitives.
        count: u64,
    },
    /// The scene has edges of more than two triangles.
    NonManifold {
        /// The number of such edges.
        count: u64,
    },
    /// The scene has edges of two triangles that face opposite sides.
    Inconsistent {
        /// The number of such edges.
        count: u64,
    },
    /// The surface is closed, and its triangles face inwards.
    InsideOut,
    /// The longest edge is at least [`MIN_SPREAD_ORDERS`] orders of magnitude longer than the shortest.
    Spread {
        /// The orders of magnitude.
        orders: f64,
    },
    /// The scene has no extent along one axis.
    Flat {
        /// The axis: 0 is x, 1 is y and 2 is z.
        axis: usize,
        /// The coordinate of the scene along this axis.
        at: f64,
    },
    /// Used positions are repeated at least once on average, so primitives do not share them.
    Unshared {
        /// The number of used positions.
        used: u64,
        /// The number of distinct coordinates among them.
        distinct: u64,
    },
    /// The scene has positions that no primitive uses.
    Unused {
        /// The number of such positions.
        count: u64,
    },
}

/// The distance from the origin, in diagonals of the scene, from which there is a note. At this distance, coordinates
/// lose two decimal digits.
pub const MIN_FAR_DIAGONALS: f64 = 100.0;
/// The ratio of the longest to the shortest edge, in orders of magnitude, from which there is a note.
pub const MIN_SPREAD_ORDERS: f64 = 6.0;

/// Returns the notes that follow from the statistics of a scene.
pub(super) fn notes(s: &Statistics) -> Vec<Note> {
    let mut notes = Vec::new();
    let mut note_if = |warranted: bool, note: Note| {
        if warranted {
            notes.push(note);
        }
    };
    let Some(bounds) = &s.bounds else {
        note_if(true, Note::Empty);
        note_if(s.positions.total > 0, Note::Unused { count: s.positions.total });
        return notes;
    };
    let (location, sizes, shapes) = (&s.location, &s.sizes, &s.shapes);
    let longest = sizes.edge.map_or(0.0, |e| e.max);
    let extreme = |x: f64| x > 1e120 || (x > 0.0 && x < 1e-120);
    note_if(extreme(location.largest_coordinate) || extreme(sizes.diagonal) || extreme(longest), Note::ExtremeScale);
    note_if(location.f32_step().is_none(), Note::BeyondF32);
    let distance = location.distance_from_origin;
    let times = distance / sizes.diagonal;
    let (f32_step, f64_step) = (location.f32_step(), location.f64_step());
    note_if(
        times >= MIN_FAR_DIAGONALS && times.is_finite(),
        Note::FarFromOrigin { distance, times, f32_step, f64_step },
    );
    let triangles = s.primitives.triangles;
    let slivers = Share { part: shapes.slivers, whole: triangles };
    note_if(shapes.slivers > 0 && slivers.part * 100 >= triangles, Note::Slivers { share: slivers });
    let thin = Share { part: shapes.thin, whole: triangles };
    if let Some(median) = shapes.median_aspect {
        note_if(thin.part * 2 >= triangles, Note::Thin { share: thin, median });
    }
    note_if(shapes.zero_area > 0, Note::ZeroArea { count: shapes.zero_area });
    note_if(shapes.zero_length > 0, Note::ZeroLength { count: shapes.zero_length });
    note_if(s.duplicates.total() > 0, Note::Duplicates { count: s.duplicates.total() });
    note_if(s.edges.non_manifold > 0, Note::NonManifold { count: s.edges.non_manifold });
    note_if(s.edges.inconsistent > 0, Note::Inconsistent { count: s.edges.inconsistent });
    note_if(s.is_inside_out, Note::InsideOut);
    if let Some(orders) = sizes.edge.map(|e| e.orders_of_magnitude()) {
        note_if(orders >= MIN_SPREAD_ORDERS, Note::Spread { orders });
    }
    for axis in 0..3 {
        let is_flat = bounds.min[axis] >= bounds.max[axis];
        note_if(is_flat && sizes.diagonal > 0.0, Note::Flat { axis, at: bounds.min[axis] });
    }
    let (used, distinct) = (s.positions.used, s.positions.distinct);
    note_if(used >= 2 * distinct, Note::Unshared { used, distinct });
    note_if(s.positions.total > used, Note::Unused { count: s.positions.total - used });
    notes
}

/// Returns a count followed by `one` or `many`.
fn counted(count: u64, one: &str, many: &str) -> String {
    format!("{} {}", Count(count), if count == 1 { one } else { many })
}

impl Note {
    /// Returns the name of the note for programs, which stays the same in later versions.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Empty => "empty",
            Self::ExtremeScale => "extreme_scale",
            Self::BeyondF32 => "beyond_f32",
            Self::FarFromOrigin { .. } => "far_from_origin",
            Self::Slivers { .. } => "slivers",
            Self::Thin { .. } => "thin",
            Self::ZeroArea { .. } => "zero_area",
            Self::ZeroLength { .. } => "zero_length",
            Self::Duplicates { .. } => "duplicates",
            Self::NonManifold { .. } => "non_manifold",
            Self::Inconsistent { .. } => "inconsistent",
            Self::InsideOut => "inside_out",
            Self::Spread { .. } => "spread",
            Self::Flat { .. } => "flat",
            Self::Unshared { .. } => "unshared",
            Self::Unused { .. } => "unused",
        }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Empty => f.write_str("the scene is empty: no query has an answer"),
            Self::ExtremeScale => f.write_str(
                "the scene has sizes beyond 1e-120..1e120: answers are right there, but trees are no faster than brute \
                force",
            ),
            Self::BeyondF32 => f.write_str("the coordinates are beyond the range of f32: keep this scene in f64"),
            Self::FarFromOrigin { distance, times, f32_step, f64_step } => {
                write!(
                    f,
                    "the scene lies {} units from the origin, {} times its size: ",
                    Figure(distance),
                    Figure(round(times))
                )?;
                if let Some(step) = f32_step {
                    write!(f, "f32 has steps of {} units there, ", Figure(round(step)))?;
                }
                write!(f, "f64 of {}; move it to the origin, or keep it in f64", Figure(round(f64_step)))
            }
            Self::Slivers { share } => write!(
                f,
                "{share} of the triangles are slivers (height below 1/1024 of the longest edge): their distances \
                take double-double arithmetic, which is slower"
            ),
            Self::Thin { share, median } => write!(
                f,
                "{share} of the triangles are thin (longest edge above {THIN_ASPECT} heights, median {}): boxes around \
                them are mostly empty, which slows trees down",
                Figure(median)
            ),
            Self::ZeroArea { count: 1 } => {
                f.write_str("1 triangle has no area: it counts as the segment or point that it covers")
            }
            Self::ZeroArea { count } => write!(
                f,
                "{} triangles have no area: they count as the segments or points that they cover",
                Count(count)
            ),
            Self::ZeroLength { count } => {
                let they = counted(
                    count,
                    "segment has no length: it counts as a point",
                    "segments have no length: they count as points",
                );
                f.write_str(&they)
            }
            Self::Duplicates { count } => {
                let they = counted(count, "primitive repeats another one", "primitives repeat others");
                write!(f, "{they}: among equals the lowest number is the answer")
            }
            Self::NonManifold { count } => {
                let they = counted(count, "edge belongs", "edges belong");
                write!(
                    f,
                    "{they} to more than two triangles: closest points are not affected, inside and outside may be"
                )
            }
            Self::Inconsistent { count } => {
                let they = counted(count, "edge lies", "edges lie");
                write!(
                    f,
                    "{they} between triangles that face opposite sides: closest points are not affected, normals are"
                )
            }
            Self::InsideOut => f.write_str(
                "the surface is closed, but its triangles face inwards: inside and outside are right, normals are \
                turned",
            ),
            Self::Spread { orders } => write!(
                f,
                "edge lengths span {orders:.0} orders of magnitude: very small and very large primitives are mixed"
            ),
            Self::Flat { axis, at } => {
                let name = ["x", "y", "z"].get(axis).copied().unwrap_or("?");
                write!(f, "the scene is flat: {name} is {} everywhere", Exact(at))
            }
            Self::Unshared { used, distinct } => write!(
                f,
                "primitives do not share positions: {} of them are at {}",
                Count(used),
                counted(distinct, "place", "different places")
            ),
            Self::Unused { count } => {
                let they = counted(
                    count,
                    "position belongs to no primitive and counts",
                    "positions belong to no primitive and count",
                );
                write!(f, "{they} for nothing")
            }
        }
    }
}

/// Rounds to two significant digits.
fn round(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}
