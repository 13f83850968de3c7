//! Changes of the number of crossings between the points of a block.
//!
//! The number falls by one where a segment crosses a triangle from its back to its front, and grows by one in the other
//! direction. Exact predicates decide which triangles the segments between neighbouring points cross. A segment that
//! touches an edge or a vertex, or ends on a triangle, leads nowhere.

use super::solid_angles::box_of;
use p2m_core::engine::vector::V3;
use p2m_core::predicates::orientation_3d;
use std::cmp::Ordering::{Equal, Greater, Less};

/// A triangle that may be crossed, and its box.
pub(super) struct Wall {
    corners: [V3; 3],
    bounds: [V3; 2],
}

impl Wall {
    /// Returns the triangles whose boxes intersect a box.
    pub(super) fn in_box(triangles: impl Iterator<Item = [V3; 3]>, bounds: &[V3; 2]) -> Vec<Self> {
        triangles.map(|corners| Self { corners, bounds: box_of(corners) }).filter(|wall| wall.meets(bounds)).collect()
    }

    fn meets(&self, [low, high]: &[V3; 2]) -> bool {
        (0..3).all(|k| self.bounds[0][k] <= high[k] && low[k] <= self.bounds[1][k])
    }

    /// Returns the change of the number of crossings from p to q, or `None` if the segment touches the
    /// triangle without crossing it.
    fn change(&self, p: V3, q: V3) -> Option<i64> {
        let [a, b, c] = self.corners;
        let turns = [(a, b), (b, c), (c, a)].map(|(a, b)| orientation_3d(p, q, a, b));
        // The line of the segment passes the triangle by.
        if turns.contains(&Less) && turns.contains(&Greater) {
            return Some(0);
        }
        match [orientation_3d(a, b, c, p), orientation_3d(a, b, c, q)] {
            [Less, Less] | [Greater, Greater] => Some(0),
            _ if turns.contains(&Equal) => None,
            [Less, Greater] => Some(-1),
            [Greater, Less] => Some(1),
            [Equal, _] | [_, Equal] => None,
        }
    }
}

/// The points of a block, with x running fastest.
pub(super) struct Lattice {
    pub(super) points: Vec<V3>,
    pub(super) counts: [usize; 3],
}

impl Lattice {
    /// Returns the change of the number of crossings from the start to each point that a flood over neighbouring points
    /// reaches, or `None` for the others. `change` returns the change between two neighbours, or `None` if the flood
    /// cannot pass from one to the other.
    pub(super) fn flood(&self, start: usize, mut change: impl FnMut(usize, usize) -> Option<i64>) -> Vec<Option<i64>> {
        let [x, y, z] = self.counts;
        let steps = [(1, x), (x, y), (x * y, z)];
        let mut numbers = vec![None; self.points.len()];
        numbers[start] = Some(0);
        let mut front = vec![start];
        while let Some(from) = front.pop() {
            let number: Option<i64> = numbers[from];
            for (step, count) in steps {
                let position = from / step % count;
                let neighbours = [(position > 0).then(|| from - step), (position + 1 < count).then(|| from + step)];
                for to in neighbours.into_iter().flatten() {
                    if numbers[to].is_none()
                        && let (Some(number), Some(change)) = (number, change(from, to))
                    {
                        numbers[to] = Some(number + change);
                        front.push(to);
                    }
                }
            }
        }
        numbers
    }
}

/// Returns the change of the number of crossings from p to q by all walls, or `None` if the segment touches one.
pub(super) fn change(walls: &[Wall], p: V3, q: V3) -> Option<i64> {
    let bounds = [[0, 1, 2].map(|k: usize| p[k].min(q[k])), [0, 1, 2].map(|k: usize| p[k].max(q[k]))];
    walls.iter().filter(|wall| wall.meets(&bounds)).map(|wall| wall.change(p, q)).sum()
}
