//! The search for triangles that are near triangles with which they share no vertex.
//!
//! Groups of triangles that are consecutive in the leaves of the tree take the triangles in their common box from the
//! tree. Pairs whose boxes overlap are then tested for a separating axis.

use super::triangle::{ROUNDING, corners};
use super::types::{RayTree, SharedSoup};
use nalgebra::Point3;
use p2m_bvh::PacketTree;
use p2m_core::engine::arithmetic::cross;
use p2m_core::engine::parallel;
use p2m_core::engine::vector::{V3, dot, largest, sub};
use p2m_core::{Aabb, PrimitiveId};
use std::ops::ControlFlow;

/// The number of triangles of a group.
const GROUP_LEN: usize = 16;
/// The largest number of triangles whose boxes overlap the box of a group.
const MAX_OTHERS: usize = 1024;
/// The margin around boxes, in sizes of the scene: four times the rounding of coordinates to f32.
const BOX_MARGIN: f64 = 1.0 / (1 << 22) as f64;

/// Unmarks each triangle that may be within `distance` of a triangle with which it shares no vertex. `welded` has the
/// vertices of the triangles.
pub(super) fn exclude<S: SharedSoup>(
    marks: &mut [bool],
    soup: &S,
    welded: &[[u32; 3]],
    rays: &RayTree<S>,
    distance: f64,
) {
    let mut order = Vec::with_capacity(marks.len());
    let all = Aabb { min: Point3::from([f64::NEG_INFINITY; 3]), max: Point3::from([f64::INFINITY; 3]) };
    let _ = rays.tree().visit_box(&all, |_| true, &mut |id| {
        order.push(id);
        ControlFlow::Continue(())
    });
    let join = Join { soup, welded, tree: rays.tree(), distance, boxes: Boxes::new(soup, distance) };
    let marked: &[bool] = marks;
    let groups: Vec<&[PrimitiveId]> = order.chunks(GROUP_LEN).collect();
    let simple = parallel::map_slice(&groups, true, |group| join.simple(group, marked));
    marks.fill(false);
    simple.into_iter().flatten().for_each(|id| marks[id.index()] = true);
}

/// The boxes of triangles, in a frame of the scene.
struct Boxes {
    origin: V3,
    /// The factor that makes the size of the scene 1.
    scale: f64,
    /// The lower corner of each box, and the upper corner.
    boxes: Vec<[[f32; 3]; 2]>,
}

impl Boxes {
    #[allow(clippy::cast_possible_truncation, reason = "boxes are widened by more than the rounding")]
    fn new<S: SharedSoup>(soup: &S, distance: f64) -> Self {
        let bounds = soup.aabb();
        let (origin, scale): (V3, f64) = (bounds.min.into(), 1.0 / (bounds.max - bounds.min).amax());
        let margin = BOX_MARGIN + distance * scale;
        let boxes = soup.triangles().iter().map(|triangle| {
            let [a, b, c] = corners(soup, *triangle).map(|corner| sub(corner, origin).map(|x| x * scale));
            [
                [0, 1, 2].map(|k: usize| (a[k].min(b[k]).min(c[k]) - margin) as f32),
                [0, 1, 2].map(|k: usize| (a[k].max(b[k]).max(c[k]) + margin) as f32),
            ]
        });
        Self { origin, scale, boxes: boxes.collect() }
    }

    /// Returns the box around some boxes in coordinates of the scene.
    fn around(&self, ids: &[PrimitiveId]) -> ([[f32; 3]; 2], Aabb<f64>) {
        let first = self.boxes[ids[0].index()];
        let all = ids.iter().map(|id| &self.boxes[id.index()]).fold(first, |all, one| {
            [[0, 1, 2].map(|k: usize| all[0][k].min(one[0][k])), [0, 1, 2].map(|k: usize| all[1][k].max(one[1][k]))]
        });
        // The margin of the boxes also covers the rounding here.
        let end =
            |end: [f32; 3]| Point3::from([0, 1, 2].map(|k: usize| f64::from(end[k]) / self.scale + self.origin[k]));
        (all, Aabb { min: end(all[0]), max: end(all[1]) })
    }
}

fn overlap(a: &[[f32; 3]; 2], b: &[[f32; 3]; 2]) -> bool {
    (0..3).all(|k| a[0][k] <= b[1][k] && b[0][k] <= a[1][k])
}

struct Join<'a, S> {
    soup: &'a S,
    welded: &'a [[u32; 3]],
    tree: &'a PacketTree<Aabb<f64>>,
    distance: f64,
    boxes: Boxes,
}

impl<S: SharedSoup> Join<'_, S> {
    /// Returns the marked triangles of a group that are far from all others without a common vertex. Where too many
    /// boxes overlap, none is returned, which is safe.
    fn simple(&self, group: &[PrimitiveId], marks: &[bool]) -> Vec<PrimitiveId> {
        let marked: Vec<PrimitiveId> = group.iter().copied().filter(|id| marks[id.index()]).collect();
        if marked.is_empty() {
            return marked;
        }
        let (around, bounds) = self.boxes.around(&marked);
        let boxes = &self.boxes.boxes;
        let mut others: Vec<(usize, [[f32; 3]; 2])> = Vec::with_capacity(8 * GROUP_LEN);
        let is_near = |id: PrimitiveId| overlap(&boxes[id.index()], &around);
        let ended = self.tree.visit_box(&bounds, is_near, &mut |id| {
            others.push((id.index(), boxes[id.index()]));
            if others.len() > MAX_OTHERS { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        if ended.is_break() {
            return Vec::new();
        }
        let is_far = |id: &PrimitiveId| {
            let t = id.index();
            let (own, vertices) = (&boxes[t], &self.welded[t]);
            let near = others.iter().filter(|(other, bounds)| *other != t && overlap(own, bounds));
            let mut apart =
                near.filter(|(other, _)| !self.welded[*other].iter().any(|vertex| vertices.contains(vertex)));
            let corners_of = |t: usize| corners(self.soup, self.soup.triangles()[t]);
            let corners = corners_of(t);
            apart.all(|(other, _)| are_apart(&corners, &corners_of(*other), self.distance))
        };
        marked.into_iter().filter(is_far).collect()
    }
}

/// Returns whether two triangles are certainly farther than a margin from each other: along the perpendicular of an
/// edge in the plane of a triangle, along a normal, along a cross product of two edges, or along an axis
/// of the coordinates.
fn are_apart(one: &[V3; 3], other: &[V3; 3], margin: f64) -> bool {
    let origin = one[0];
    let [one, other] = [one, other].map(|corners| corners.map(|corner| sub(corner, origin)));
    let margin = margin + ROUNDING * largest(&other).max(largest(&one));
    let is_axis = |axis: V3| {
        let interval = |corners: &[V3; 3]| {
            let [a, b, c] = corners.map(|corner| dot(corner, axis));
            (a.min(b).min(c), a.max(b).max(c))
        };
        let ((low, high), (other_low, other_high)) = (interval(&one), interval(&other));
        // The products have errors of 4 u of the lengths.
        let gap = (other_low - high).max(low - other_high);
        gap > 0.0 && gap * gap > dot(axis, axis) * (margin * margin)
    };
    let edges = |c: &[V3; 3]| [sub(c[1], c[0]), sub(c[2], c[1]), sub(c[0], c[2])];
    let (ours, theirs) = (edges(&one), edges(&other));
    let [normal, other_normal] = [&ours, &theirs].map(|edges| cross(edges[0], edges[1]));
    ours.iter().any(|e| is_axis(cross(normal, *e)))
        || theirs.iter().any(|e| is_axis(cross(other_normal, *e)))
        || is_axis(normal)
        || is_axis(other_normal)
        || ours.iter().any(|e| theirs.iter().any(|f| is_axis(cross(*e, *f))))
        || [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().any(is_axis)
}
