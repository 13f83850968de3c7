//! Families of small scenes that break indexes and kernels, at every scale.

use crate::families::{self, SCALES, SCALES_OF_F32, SINES};
use crate::scenes::{self, KINDS, LAYOUTS, Layout};
use nalgebra::Point3;
use p2m_core::{Element, Soup};
use rand::{Rng, RngExt};

type V = [f64; 3];

/// A family of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extreme {
    /// Primitives from the families of isolated ones, each at its own scale.
    Isolated,
    /// Triangles of one small sine that cross each other.
    Slivers,
    /// Triangles with one tiny edge.
    Needles,
    /// A few primitives, repeated many times with their vertices in any order.
    Coincident,
    /// Primitives on one line, exactly or up to rounding.
    Collinear,
    /// Vertices on a circle, queried from its axis.
    Cocircular,
    /// Vertices on a sphere, queried from its centre.
    Cospherical,
    /// Primitives whose sizes differ by a factor of 10^6.
    Sizes6,
    /// Primitives whose sizes differ by a factor of 10^12.
    Sizes12,
    /// Primitives on a small integer lattice.
    Lattice,
    /// Scenes at 10^6 times their size from the origin.
    Far6,
    /// Scenes at 10^15 times their size from the origin, where neighbouring numbers are an eighth of the size apart.
    Far15,
    /// Scenes whose coordinates are subnormal numbers of f64 or of f32.
    Subnormal,
    /// Random scenes as in the other tests.
    Ordinary,
}

impl Extreme {
    /// All families, in the order of the tables.
    pub const ALL: [Self; 14] = [
        Self::Isolated,
        Self::Slivers,
        Self::Needles,
        Self::Coincident,
        Self::Collinear,
        Self::Cocircular,
        Self::Cospherical,
        Self::Sizes6,
        Self::Sizes12,
        Self::Lattice,
        Self::Far6,
        Self::Far15,
        Self::Subnormal,
        Self::Ordinary,
    ];

    /// Returns the name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Isolated => "hard primitives",
            Self::Slivers => "slivers",
            Self::Needles => "needles",
            Self::Coincident => "coincident",
            Self::Collinear => "collinear",
            Self::Cocircular => "cocircular",
            Self::Cospherical => "cospherical",
            Self::Sizes6 => "sizes 10^6 apart",
            Self::Sizes12 => "sizes 10^12 apart",
            Self::Lattice => "lattice",
            Self::Far6 => "10^6 from the origin",
            Self::Far15 => "10^15 from the origin",
            Self::Subnormal => "subnormal",
            Self::Ordinary => "ordinary",
        }
    }

    /// Generates a scene of the family, at a random scale unless the family has its own, and queries on it, near it,
    /// equidistant from several primitives, and far from it.
    pub fn generate(self, rng: &mut impl Rng, queries: usize) -> (Soup<f64>, Vec<Point3<f64>>) {
        let len = rng.random_range(1..48);
        let mut centre = [0.0; 3];
        let (positions, elements) = match self {
            Self::Ordinary => {
                let (kinds, layout) = (KINDS[rng.random_range(0..4)], LAYOUTS[rng.random_range(0..6)]);
                scenes::scene(rng, kinds, layout, len)
            }
            Self::Lattice => {
                let kinds = KINDS[rng.random_range(0..4)];
                scenes::scene(rng, kinds, Layout::Lattice, len)
            }
            _ => {
                let shapes = self.shapes(rng, len);
                if self == Self::Far6 || self == Self::Far15 {
                    let far = if self == Self::Far6 { 1e6 } else { 1e15 };
                    centre = direction(rng).map(|x| x * far);
                }
                let mut positions = Vec::new();
                let mut elements = Vec::new();
                for shape in shapes {
                    let first = u32::try_from(positions.len()).expect("small");
                    elements.push(match shape.len() {
                        1 => Element::Point(first),
                        2 => Element::Segment([first, first + 1]),
                        _ => Element::Triangle([first, first + 1, first + 2]),
                    });
                    positions.extend(shape.into_iter().map(|v| std::array::from_fn(|k| v[k] + centre[k])));
                }
                (positions, elements)
            }
        };
        let scale = match self {
            Self::Subnormal => [-1070, -146][rng.random_range(0..2)],
            Self::Isolated | Self::Far15 => 0,
            _ if rng.random_bool(0.5) => 0,
            _ => {
                let scales = if rng.random_bool(0.5) { SCALES } else { SCALES_OF_F32 };
                scales[rng.random_range(0..scales.len())]
            }
        };
        // The factor is applied in two steps, and clamped at the edge of the range.
        let (factor, rest) = (2f64.powi(scale / 2), 2f64.powi(scale - scale / 2));
        let moved = |p: V| Point3::from(p.map(|x| (x * factor * rest).clamp(-f64::MAX, f64::MAX)));
        let unscaled: Vec<Point3<f64>> = positions.iter().map(|p| Point3::from(*p)).collect();
        let asked = (0..queries)
            .map(|i| {
                let equidistant = matches!(self, Self::Cocircular | Self::Cospherical) && i % 4 == 0;
                let query = if equidistant {
                    let along = if self == Self::Cocircular { rng.random_range(-2.0..2.0) } else { 0.0 };
                    [centre[0], centre[1], centre[2] + along]
                } else {
                    scenes::query(rng, &unscaled).coords.into()
                };
                moved(query)
            })
            .collect();
        let positions = positions.into_iter().map(moved).collect();
        (Soup::new(positions, elements).expect("finite, and indices are in range"), asked)
    }

    /// Generates the primitives, before they are moved and scaled.
    fn shapes<R: Rng>(self, rng: &mut R, len: usize) -> Vec<Vec<V>> {
        let sine = SINES[rng.random_range(0..SINES.len())];
        let mut pool: Vec<Vec<V>> = Vec::new();
        let line = [direction(rng), direction(rng)];
        // A scene has all kinds, only segments and triangles, or only triangles.
        let min_vertices = rng.random_range(1..=3);
        let vertices = |rng: &mut R, one: &mut dyn FnMut(&mut R) -> V| -> Vec<V> {
            (0..rng.random_range(min_vertices..=3)).map(|_| one(rng)).collect()
        };
        (0..len)
            .map(|_| match self {
                Self::Isolated => families::case(rng).vertices,
                Self::Slivers => families::triangle(rng, sine).to_vec(),
                Self::Needles => {
                    let [a, b, _] = families::triangle(rng, 1.0);
                    let (tiny, aside) = (2f64.powi(-rng.random_range(1..60)), direction(rng));
                    vec![a, b, std::array::from_fn(|k| a[k] + tiny * aside[k])]
                }
                Self::Coincident => {
                    if pool.len() < 3 {
                        pool.push(vertices(rng, &mut |rng| std::array::from_fn(|_| rng.random_range(-1.0..1.0))));
                    }
                    let mut again = pool[rng.random_range(0..pool.len())].clone();
                    let by = rng.random_range(0..again.len());
                    again.rotate_left(by);
                    if rng.random_bool(0.5) {
                        again.reverse();
                    }
                    again
                }
                Self::Collinear => vertices(rng, &mut |rng| {
                    if sine < 0.1 {
                        let at = f64::from(rng.random_range(-9..=9));
                        [at, 2.0 * at, -3.0 * at]
                    } else {
                        let at = rng.random_range(-1.0..1.0);
                        std::array::from_fn(|k| line[0][k] + at * line[1][k])
                    }
                }),
                Self::Cocircular => vertices(rng, &mut |rng| {
                    let angle: f64 = rng.random_range(0.0..std::f64::consts::TAU);
                    [angle.cos(), angle.sin(), 0.0]
                }),
                Self::Cospherical => vertices(rng, &mut |rng| direction(rng)),
                Self::Sizes6 | Self::Sizes12 => {
                    let octaves = if self == Self::Sizes6 { 20.0 } else { 40.0 };
                    let size = 2f64.powf(rng.random_range(-octaves..0.0));
                    let centre = direction(rng);
                    vertices(rng, &mut |rng| std::array::from_fn(|k| centre[k] + size * rng.random_range(-1.0..1.0)))
                }
                _ => vertices(rng, &mut |rng| std::array::from_fn(|_| rng.random_range(-1.0..1.0))),
            })
            .collect()
    }
}

/// Returns a random direction of length one, up to rounding.
fn direction(rng: &mut impl Rng) -> V {
    families::unit(rng)
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_core::{Primitive, PrimitiveId, PrimitiveSet};

    /// Returns twice the area of each triangle, divided by the square of its longest side.
    fn sines(soup: &Soup<f64>) -> Vec<f64> {
        let of = |[a, b, c]: [Point3<f64>; 3]| {
            let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
            let area = (b - a).cross(&(c - a)).norm();
            if area > 0.0 { area / (longest * longest) } else { 0.0 }
        };
        soup.triangles().iter().map(|t| of(t.map(|i| soup.positions()[i as usize]))).collect()
    }

    #[test]
    fn scenes_are_what_they_are_called() {
        for family in Extreme::ALL {
            let mut seen = [false; 6];
            for case in 0..300 {
                let (soup, queries) = family.generate(&mut crate::rng(family.name(), case), 8);
                assert!(!soup.is_empty() && queries.len() == 8);
                let all: Vec<f64> = soup.positions().iter().flat_map(|p| p.iter().map(|x| x.abs())).collect();
                let largest = all.iter().fold(0.0, |m: f64, x| m.max(*x));
                let smallest = all.iter().filter(|x| **x > 0.0).fold(f64::INFINITY, |m: f64, x| m.min(*x));
                let ordinary = (1e-3..1e3).contains(&largest);
                seen[0] |= (0.0..f64::MIN_POSITIVE).contains(&largest);
                seen[1] |= (f64::MIN_POSITIVE..f64::from(f32::MIN_POSITIVE)).contains(&largest);
                seen[2] |= largest > 1e300;
                seen[3] |= (1e30..1e39).contains(&largest);
                seen[4] |= ordinary;
                let positions = soup.positions();
                let radii = || positions.iter().map(|p| p.coords.norm());
                let sines = sines(&soup);
                let holds = match family {
                    Extreme::Subnormal => largest < f64::from(f32::MIN_POSITIVE),
                    Extreme::Far15 => (1e14..1e16).contains(&largest) && largest - smallest < 2e15,
                    Extreme::Far6 if ordinary => false,
                    Extreme::Cospherical | Extreme::Cocircular if ordinary => {
                        let flat = family == Extreme::Cospherical || positions.iter().all(|p| p.z == 0.0);
                        flat && radii().all(|r| (r - 1.0).abs() < 1e-12)
                    }
                    Extreme::Collinear if ordinary => sines.iter().all(|sine| *sine < 1e-9),
                    // Nine of ten edges are shorter than an eighth of the longest.
                    Extreme::Needles if ordinary => {
                        sines.len() < 12 || sines.iter().filter(|sine| **sine < 0.3).count() * 3 > 2 * sines.len()
                    }
                    // All sines equal a value of the list, or are smaller.
                    Extreme::Slivers if ordinary => {
                        let largest = sines.iter().fold(0.0, |m: f64, s| m.max(*s));
                        SINES.iter().any(|sine| largest <= *sine + 1e-15)
                    }
                    Extreme::Coincident if ordinary => {
                        let mut all: Vec<_> = positions.iter().map(|p| p.coords.map(f64::to_bits).data.0[0]).collect();
                        all.sort_unstable();
                        all.dedup();
                        all.len() <= 9
                    }
                    _ => true,
                };
                assert!(holds, "{} {case}: {smallest:e} to {largest:e}, sines {sines:?}", family.name());
                let sizes: Vec<f64> = (0..soup.len())
                    .map(|i| soup.get(PrimitiveId::new(i)).aabb())
                    .map(|b| (b.max - b.min).norm())
                    .filter(|size| *size > 0.0)
                    .collect();
                let ratio =
                    sizes.iter().fold(0.0, |m: f64, s| m.max(*s)) / sizes.iter().fold(f64::MAX, |m, s| m.min(*s));
                seen[5] |= match family {
                    Extreme::Sizes6 => ratio > 1e5,
                    Extreme::Sizes12 => ratio > 1e10,
                    _ => true,
                };
            }
            let expected = match family {
                Extreme::Subnormal => [true, true, false, false, false, true],
                Extreme::Isolated => seen,
                Extreme::Far15 => [false, false, false, false, false, true],
                Extreme::Far6 => [true, true, true, true, false, true],
                _ => [true; 6],
            };
            assert_eq!(seen, expected, "{}: subnormal in both scalars, their ends, ordinary, sizes", family.name());
        }
    }
}
