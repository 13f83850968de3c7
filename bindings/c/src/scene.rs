//! Scenes.

use crate::arrays::{Array, give, reference, take_back, write};
use crate::status::{Call, Failure, Status, invalid, run};
use p2m_core::{BuildError, Element, PrimitiveSet, Soup};
use std::sync::Arc;

/// A scene: triangles, segments and points that share vertices. It is immutable, and any number of threads may use it.
pub struct Scene {
    pub(crate) shared: Arc<p2m_mixed::Scene>,
}

impl Scene {
    /// Makes a scene from primitives, or returns the failure for invalid primitives.
    pub(crate) fn of(soup: Result<Soup<f64>, BuildError>) -> Call<Self> {
        let soup = soup.map_err(|error| Failure(Status::InvalidScene, error.to_string()))?;
        Ok(Self { shared: Arc::new(p2m_mixed::Scene::from(soup)) })
    }
}

/// Returns the array behind a pointer, or an empty one for null.
///
/// # Safety
/// A pointer that is not null has to point to a valid array.
unsafe fn optional(array: *const Array, name: &str) -> Call<Array> {
    if array.is_null() {
        return Ok(Array { data: std::ptr::null(), count: 0, stride: 0, scalar: 0 });
    }
    // SAFETY: the caller vouches for the pointer.
    unsafe { reference(array, name) }.copied()
}

/// Makes a scene from arrays, which are copied. `positions` are the vertices, of type float or double. `triangles` have
/// three indices of vertices each, `segments` two, and `points` one. Each of the last three may be null.
///
/// Primitives are numbered from 0: first all triangles, then all segments, then all points. Free the scene with
/// `p2m_scene_free`. Fails with `P2M_STATUS_INVALID_SCENE` if an index is out of range, if a coordinate of a primitive
/// is not finite, or if there are more than 2^30 primitives.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_scene_new(
    positions: *const Array,
    triangles: *const Array,
    segments: *const Array,
    points: *const Array,
    scene: *mut *mut Scene,
) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        give(scene, "scene", || {
            let positions = optional(positions, "positions")?.points("positions")?.into_owned();
            let triangles = optional(triangles, "triangles")?.indices::<3>("triangles")?;
            let segments = optional(segments, "segments")?.indices::<2>("segments")?;
            let points = optional(points, "points")?.indices::<1>("points")?;
            Scene::of(if segments.is_empty() && points.is_empty() {
                Soup::from_triangles(positions, triangles)
            } else {
                let triangles = triangles.into_iter().map(Element::Triangle);
                let segments = segments.into_iter().map(Element::Segment);
                let points = points.into_iter().map(|[point]| Element::Point(point));
                Soup::new(positions, triangles.chain(segments).chain(points))
            })
        })
    })
}

/// Frees a scene. Indexes over it stay valid. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_scene_free(scene: *mut Scene) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { take_back(scene) };
}

/// Writes the numbers of triangles, segments and points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_scene_counts(scene: *const Scene, counts: *mut [usize; 3]) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let soup = &reference(scene, "scene")?.shared.soup;
        write(counts, "counts", [soup.triangles().len(), soup.segments().len(), soup.points().len()])
    })
}

/// Writes the lowest and the highest coordinates of all primitives. Fails for a scene without primitives.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn p2m_scene_bounds(scene: *const Scene, low: *mut [f64; 3], high: *mut [f64; 3]) -> Status {
    // SAFETY: the caller vouches for the pointers.
    run(|| unsafe {
        let soup = &reference(scene, "scene")?.shared.soup;
        if soup.len() == 0 {
            return Err(invalid("scene: it has no primitives"));
        }
        let bounds = soup.aabb();
        write(low, "low", bounds.min.into())?;
        write(high, "high", bounds.max.into())
    })
}
