//! A filter for the primitives of a large scene that a line may intersect: a plain tree of boxes with generous margins.
//! Rational arithmetic then has to decide about few primitives.

use crate::ray_oracle::nearest_to;
use p2m_core::Ray;
use std::ops::Range;

type P = [f64; 3];

/// The margin of all comparisons, relative to the largest coordinate involved. It is thousands of roundings.
const RELATIVE_MARGIN: f64 = 1e-12;

/// A binary tree over the vertices of primitives, which finds those that a line may intersect.
pub struct LineFilter<'a> {
    primitives: &'a [Vec<P>],
    /// The ids in the order of the leaves.
    order: Vec<usize>,
    nodes: Vec<Node>,
}

struct Node {
    centre: P,
    half_extent: P,
    ids: Range<usize>,
    /// The indices of the two children; leaves have none.
    children: Option<[usize; 2]>,
}

/// A line, given by a point near the scene and a direction whose largest component is 1.
struct Line {
    point: P,
    direction: P,
    radius: f64,
}

fn size(x: &P) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.abs()))
}

fn cross(a: &P, b: &P) -> P {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

impl<'a> LineFilter<'a> {
    /// Builds the filter over primitives with coordinates of moderate size.
    #[must_use]
    pub fn new(primitives: &'a [Vec<P>]) -> Self {
        let mut filter = Self { primitives, order: (0..primitives.len()).collect(), nodes: Vec::new() };
        if !primitives.is_empty() {
            filter.build(0..primitives.len());
        }
        filter
    }

    fn build(&mut self, ids: Range<usize>) -> usize {
        let vertices = || self.order[ids.clone()].iter().flat_map(|i| &self.primitives[*i]);
        let min: P = std::array::from_fn(|k| vertices().fold(f64::INFINITY, |m, v| m.min(v[k])));
        let max: P = std::array::from_fn(|k| vertices().fold(f64::NEG_INFINITY, |m, v| m.max(v[k])));
        let centre = std::array::from_fn(|k| 0.5 * min[k] + 0.5 * max[k]);
        let half_extent: P = std::array::from_fn(|k| 0.5 * max[k] - 0.5 * min[k]);
        let node = self.nodes.len();
        self.nodes.push(Node { centre, half_extent, ids: ids.clone(), children: None });
        if ids.len() > 4 {
            let axis = (0..3).max_by(|a, b| half_extent[*a].total_cmp(&half_extent[*b])).expect("three");
            let middle = ids.len() / 2;
            let of = |i: &usize| self.primitives[*i].iter().map(|v| v[axis]).sum::<f64>();
            self.order[ids.clone()].select_nth_unstable_by(middle, |a, b| of(a).total_cmp(&of(b)));
            let middle = ids.start + middle;
            let children = [self.build(ids.start..middle), self.build(middle..ids.end)];
            self.nodes[node].children = Some(children);
        }
        node
    }

    /// Returns all primitives that the whole line of a ray may intersect, and possibly others.
    #[must_use]
    pub fn near(&self, ray: &Ray) -> Vec<usize> {
        let Some(root) = self.nodes.first() else { return Vec::new() };
        let direction: P = ray.direction().into();
        // The point is moved along the line to the scene. With a far origin, the margin would accept everything.
        let line = Line {
            point: nearest_to(ray, root.centre),
            direction: direction.map(|x| x / size(&direction)),
            radius: ray.radius(),
        };
        let (mut found, mut stack) = (Vec::new(), vec![0]);
        while let Some(node) = stack.pop() {
            let node = &self.nodes[node];
            if line.misses_box(&node.centre, &node.half_extent) {
                continue;
            }
            match node.children {
                Some(children) => stack.extend(children),
                None => found
                    .extend(self.order[node.ids.clone()].iter().filter(|i| !line.misses_hull(&self.primitives[**i]))),
            }
        }
        found.sort_unstable();
        found
    }
}

impl Line {
    /// Returns whether the line misses a box: in the projection along one of the three axes, all corners are on one
    /// side.
    fn misses_box(&self, centre: &P, half_extent: &P) -> bool {
        let offset = std::array::from_fn(|k| centre[k] - self.point[k]);
        let margin = self.radius + RELATIVE_MARGIN * (size(centre) + size(half_extent) + size(&self.point));
        let aside = cross(&offset, &self.direction);
        let d = self.direction.map(f64::abs);
        (0..3).any(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            aside[k].abs() > (half_extent[i] + margin) * d[j] + (half_extent[j] + margin) * d[i]
        })
    }

    /// Returns whether the line misses the hull of the vertices: in the projection along or across an edge, all
    /// vertices are on one side.
    fn misses_hull(&self, vertices: &[P]) -> bool {
        let aside: Vec<P> =
            vertices.iter().map(|v| cross(&std::array::from_fn(|k| v[k] - self.point[k]), &self.direction)).collect();
        // The projected distance may be up to three times as large as the vector.
        let largest = vertices.iter().map(size).fold(size(&self.point), f64::max);
        let radius = if vertices.len() < 3 { self.radius } else { 0.0 };
        let margin = 3.0 * (radius + RELATIVE_MARGIN * largest);
        let dot = |a: &P, b: &P| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let separates = |axis: P| {
            let slack = margin * size(&axis) * 3.0;
            aside.iter().all(|a| dot(a, &axis) > slack) || aside.iter().all(|a| dot(a, &axis) < -slack)
        };
        (0..aside.len()).any(|i| {
            let (a, b) = (&aside[i], &aside[(i + 1) % aside.len()]);
            let edge = std::array::from_fn(|k| b[k] - a[k]);
            separates(edge) || separates(cross(&edge, &self.direction)) || separates(*a)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray_oracle::{LineIntersection, crossing};
    use crate::rays::{AIMS, ray};
    use crate::scenes::{kinds_and_layout, soup};
    use p2m_core::{PrimitiveId, PrimitiveSet};

    #[test]
    fn nothing_that_is_met_is_left_out() {
        let (mut kept, mut met, mut all) = (0, 0, 0);
        let cases = crate::cases(48, 24);
        for seed in cases.clone() {
            let (mut rng, (kinds, layout)) = (crate::rng("line filter", seed), kinds_and_layout(seed));
            let soup = soup(&mut rng, kinds, layout, 100);
            let primitives: Vec<Vec<P>> = (0..soup.len())
                .map(|i| soup.get(PrimitiveId::new(i)).vertices().iter().map(|v| v.coords.into()).collect())
                .collect();
            let filter = LineFilter::new(&primitives);
            for aim in AIMS {
                let ray =
                    ray(&mut rng, &soup, &soup.aabb(), aim).with_radius([0.0, 1e-3][seed as usize % 2]).expect("valid");
                let near = filter.near(&ray);
                for (i, vertices) in primitives.iter().enumerate() {
                    let intersects =
                        LineIntersection::new(&ray, vertices).is_some() || crossing(&ray, vertices).is_some();
                    assert!(!intersects || near.binary_search(&i).is_ok(), "seed {seed} {ray:?} {vertices:?}");
                    met += usize::from(intersects);
                }
                kept += near.len();
                all += primitives.len();
            }
        }
        let is_worth_it = cases.is_replay() || kept < 2 * met;
        assert!(cases.have_more_than(1000, met) && is_worth_it, "{met} met, {kept} kept of {all}");
    }
}
