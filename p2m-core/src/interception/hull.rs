//! Convex polytopes by their corners: a Voronoi cell, and parts of it.

use crate::kernel::vector::{V3, norm_squared, sub};

/// A convex polytope with the distances of its corners from a site.
#[derive(Default)]
pub(super) struct Hull {
    pub(super) corners: Vec<V3>,
    /// Of each corner the distance to the site with its error and the slack,
    pub(super) reaches: Vec<f64>,
    /// and what its place may be off.
    pub(super) errors: Vec<f64>,
    /// The faces that meet in each corner, by numbers of their own.
    faces: Vec<[u32; 3]>,
    /// Pairs of corners that are joined by an edge.
    pub(super) edges: Vec<[u32; 2]>,
    /// The largest of the reaches and errors.
    pub(super) reach: f64,
    pub(super) error: f64,
}

impl Hull {
    pub(super) fn clear(&mut self) {
        for list in [&mut self.reaches, &mut self.errors] {
            list.clear();
        }
        self.corners.clear();
        self.faces.clear();
        self.edges.clear();
        (self.reach, self.error) = (0.0, 0.0);
    }

    /// Adds a corner.
    pub(super) fn push(&mut self, corner: V3, error: f64, faces: [u32; 3], site: &V3, slack: f64) {
        let distance = norm_squared(sub(corner, *site)).sqrt() * (1.0 + 8.0 * f64::EPSILON);
        let reach = distance + error + slack;
        self.corners.push(corner);
        self.faces.push(faces);
        self.reaches.push(reach);
        self.errors.push(error);
        (self.reach, self.error) = (self.reach.max(reach), self.error.max(error));
    }

    /// Makes it the part of another one where `height` is at least zero, which is linear: the new face gets the number
    /// `face`.
    pub(super) fn clip(&mut self, whole: &Self, height: impl Fn(&V3) -> f64, face: u32, site: &V3, slack: f64) {
        self.clear();
        let heights: Vec<f64> = whole.corners.iter().map(height).collect();
        let mut numbers = vec![u32::MAX; heights.len()];
        let number = |hull: &Self| u32::try_from(hull.corners.len()).expect("few corners");
        for (i, corner) in whole.corners.iter().enumerate().filter(|(i, _)| heights[*i] >= 0.0) {
            numbers[i] = number(self);
            self.push(*corner, whole.errors[i], whole.faces[i], site, slack);
        }
        let first = number(self);
        for [a, b] in whole.edges.iter().map(|e| e.map(|i| i as usize)) {
            let (a, b) = if heights[a] >= 0.0 { (a, b) } else { (b, a) };
            if heights[a] < 0.0 {
                continue;
            }
            if heights[b] >= 0.0 {
                self.edges.push([numbers[a], numbers[b]]);
                continue;
            }
            let t = heights[a] / (heights[a] - heights[b]);
            let (from, to) = (whole.corners[a], whole.corners[b]);
            let corner = std::array::from_fn(|k| from[k] + t * (to[k] - from[k]));
            // Of the ends and of the sum; a way along the edge does not matter.
            let error = whole.errors[a].max(whole.errors[b]) + whole.reach * 4.0 * f64::EPSILON;
            let mut faces = [face; 3];
            let common = whole.faces[a].iter().filter(|f| whole.faces[b].contains(f));
            faces.iter_mut().zip(common.take(2)).for_each(|(to, f)| *to = *f);
            self.edges.push([numbers[a], number(self)]);
            self.push(corner, error, faces, site, slack);
        }
        // The new face has an edge with each face that it cuts.
        let all: Vec<(u32, u32)> = (first..number(self))
            .flat_map(|i| self.faces[i as usize].into_iter().filter(|f| *f != face).map(move |f| (f, i)))
            .collect();
        for (n, (f, i)) in all.iter().enumerate() {
            let others = all[..n].iter().filter(|(g, _)| g == f);
            self.edges.extend(others.map(|(_, j)| [*i, *j]));
        }
    }
}
