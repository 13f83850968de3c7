//! The directions of the faces of k-DOPs, with their default sets.

use nalgebra::Vector3;

/// The K unit normals of k-DOPs. K counts both signs: normal 2 j + 1 is the opposite of normal 2 j.
///
/// If three of the directions are mutually orthogonal, these come first, because they make the bounds of searches
/// tightest (decision 012). Otherwise the three directions that span the largest volume come first. The others keep
/// their order.
///
/// ```
/// use p2m_kdop::Directions;
/// use nalgebra::Vector3;
///
/// let default = Directions::<14>::default(); // the axes, then the diagonals of a cube
/// assert_eq!(default.normals()[1], -Vector3::x());
/// let own = Directions::<8>::new(&[Vector3::new(1.0, 2.0, 0.0), Vector3::x(), Vector3::y(), Vector3::z()]).unwrap();
/// assert_eq!(own.normals()[0], Vector3::x());
/// assert!(Directions::<8>::new(&[Vector3::x(); 4]).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directions<const K: usize> {
    normals: [Vector3<f64>; K],
    is_orthogonal: bool,
}

/// The error for directions that define no k-DOPs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DirectionsError {
    /// K is odd, or less than 6, so that k-DOPs would be unbounded.
    #[error("k-DOPs have an even number of faces, at least 6, not {k}")]
    Faces {
        /// The number K of the type.
        k: usize,
    },
    /// The number of directions is not K / 2. Opposites must not be given.
    #[error("{found} directions, but there are {expected}, without their opposites")]
    Count {
        /// The expected number, K / 2.
        expected: usize,
        /// The number of directions that were given.
        found: usize,
    },
    /// A direction has a coordinate that is not finite, or its length is 0.
    #[error("direction {index} is not finite or zero")]
    NotADirection {
        /// The index of the direction.
        index: usize,
    },
    /// The sine of the angle between two directions is less than 1e-6, so they are the same or opposite.
    #[error("directions {first} and {second} are parallel")]
    Parallel {
        /// The lower index of the two directions.
        first: usize,
        /// The higher index of the two directions.
        second: usize,
    },
    /// All directions lie in a plane, to within 1e-6, so k-DOPs are unbounded across it.
    #[error("all directions lie in a plane")]
    Flat,
}

/// The largest sine at which two directions count as parallel, and the largest volume at which three directions count
/// as coplanar: 2^-20.
const MAX_FLAT_VOLUME: f64 = 1.0 / (1u32 << 20) as f64;
/// The largest cosine at which directions count as orthogonal: 2^-40, far below the resolution of searches in f32.
const MAX_ORTHOGONAL_COSINE: f64 = 1.0 / (1u64 << 40) as f64;

impl<const K: usize> Directions<K> {
    /// Creates directions from K / 2 vectors of any length and their opposites.
    ///
    /// # Errors
    /// Returns a [`DirectionsError`] if k-DOPs of these directions would be unbounded.
    pub fn new(directions: &[Vector3<f64>]) -> Result<Self, DirectionsError> {
        if K < 6 || !K.is_multiple_of(2) {
            return Err(DirectionsError::Faces { k: K });
        }
        if directions.len() != K / 2 {
            return Err(DirectionsError::Count { expected: K / 2, found: directions.len() });
        }
        let mut units = Vec::with_capacity(K / 2);
        for (index, direction) in directions.iter().enumerate() {
            units.push(unit(direction).ok_or(DirectionsError::NotADirection { index })?);
            for first in 0..index {
                if units[first].cross(&units[index]).norm() <= MAX_FLAT_VOLUME {
                    return Err(DirectionsError::Parallel { first, second: index });
                }
            }
        }
        let (triple, is_orthogonal) = leading_triple(&units).ok_or(DirectionsError::Flat)?;
        let others = (0..units.len()).filter(|i| !triple.contains(i));
        let order: Vec<usize> = triple.into_iter().chain(others).collect();
        let normals = std::array::from_fn(|i| {
            let normal = units[order[i / 2]];
            // Adding 0 turns -0 into 0, so that equal directions have equal bits.
            if i % 2 == 0 { normal } else { -normal }.map(|x| x + 0.0)
        });
        Ok(Self { normals, is_orthogonal })
    }

    /// Creates directions from the normals of a file and keeps their order. It is `None` if they are not valid.
    pub(crate) fn from_normals(normals: &[Vector3<f64>], is_orthogonal: bool) -> Option<Self> {
        let normals: [Vector3<f64>; K] = normals.try_into().ok()?;
        // The tolerance covers the three roundings of a square and the roundings of the square root and the quotient.
        let is_unit = |n: &Vector3<f64>| (n.norm_squared() - 1.0).abs() <= 16.0 * f64::EPSILON;
        let fits = normals.chunks_exact(2).all(|pair| is_unit(&pair[0]) && pair[1] == -pair[0]);
        let [u, v, w] = [normals[0], normals[2], normals[4]];
        let is_first_valid = if is_orthogonal {
            cosine(&u, &v, &w) <= MAX_ORTHOGONAL_COSINE
        } else {
            volume(&u, &v, &w) > MAX_FLAT_VOLUME
        };
        (fits && is_first_valid).then_some(Self { normals, is_orthogonal })
    }

    /// Returns the K unit normals.
    #[must_use]
    pub fn normals(&self) -> &[Vector3<f64>; K] {
        &self.normals
    }

    /// Returns whether the first three directions are mutually orthogonal.
    #[must_use]
    pub fn starts_orthogonal(&self) -> bool {
        self.is_orthogonal
    }
}

/// Scales a vector to length 1. It is `None` if the vector is zero or not finite.
fn unit(v: &Vector3<f64>) -> Option<Vector3<f64>> {
    // `amax` need not be NaN if a component is, so all components are tested.
    let largest = v.amax();
    (largest > 0.0 && v.iter().all(|x| x.is_finite())).then(|| {
        let scaled = v / largest;
        scaled / scaled.norm()
    })
}

/// Returns the largest magnitude of a cosine between two of three unit vectors.
fn cosine(u: &Vector3<f64>, v: &Vector3<f64>, w: &Vector3<f64>) -> f64 {
    u.dot(v).abs().max(v.dot(w).abs()).max(w.dot(u).abs())
}

/// Returns the volume of the parallelepiped that three vectors span.
fn volume(u: &Vector3<f64>, v: &Vector3<f64>, w: &Vector3<f64>) -> f64 {
    u.cross(v).dot(w).abs()
}

/// Returns the indices of the three directions that come first, and whether they are orthogonal. It is `None` if all
/// directions lie in a plane.
fn leading_triple(units: &[Vector3<f64>]) -> Option<([usize; 3], bool)> {
    let mut widest = (MAX_FLAT_VOLUME, None);
    for a in 0..units.len() {
        for b in a + 1..units.len() {
            for c in b + 1..units.len() {
                let [u, v, w] = [a, b, c].map(|i| units[i]);
                if cosine(&u, &v, &w) <= MAX_ORTHOGONAL_COSINE {
                    return Some(([a, b, c], true));
                }
                let volume = volume(&u, &v, &w);
                if volume > widest.0 {
                    widest = (volume, Some([a, b, c]));
                }
            }
        }
    }
    widest.1.map(|triple| (triple, false))
}

const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const BODY_DIAGONALS: [[f64; 3]; 4] = [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [1.0, -1.0, 1.0]];
const FACE_DIAGONALS: [[f64; 3]; 6] =
    [[1.0, 1.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, -1.0, 0.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0]];

macro_rules! default_directions {
    ($($(#[$about:meta])* $k:literal: $($set:expr),+;)*) => {
        $(impl Default for Directions<$k> {
            $(#[$about])*
            fn default() -> Self {
                let all: Vec<Vector3<f64>> = [$(&$set[..]),+].concat().into_iter().map(Vector3::from).collect();
                Self::new(&all).expect("distinct directions")
            }
        })*
    };
}

default_directions! {
    /// Returns the axes.
    6: AXES;
    /// Returns the axes and the diagonals of a cube.
    14: AXES, BODY_DIAGONALS;
    /// Returns the axes and the diagonals of the faces of a cube.
    18: AXES, FACE_DIAGONALS;
    /// Returns the axes, the diagonals of a cube and the diagonals of its faces.
    26: AXES, BODY_DIAGONALS, FACE_DIAGONALS;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn default_sets_are_unit_vectors_and_their_opposites() {
        fn check<const K: usize>(directions: &Directions<K>) {
            assert!(directions.starts_orthogonal());
            for pair in directions.normals().chunks(2) {
                assert!((pair[0].norm() - 1.0).abs() < 1e-15 && pair[1] == -pair[0]);
            }
            assert_eq!(directions.normals()[4], Vector3::z());
        }
        check(&Directions::<6>::default());
        check(&Directions::<14>::default());
        check(&Directions::<18>::default());
        check(&Directions::<26>::default());
    }

    #[test]
    fn directions_of_unbounded_kdops_are_errors() {
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        assert_eq!(Directions::<5>::new(&[x, y]), Err(DirectionsError::Faces { k: 5 }));
        assert_eq!(Directions::<4>::new(&[x, y]), Err(DirectionsError::Faces { k: 4 }));
        assert_eq!(Directions::<6>::new(&[x, y]), Err(DirectionsError::Count { expected: 3, found: 2 }));
        let parallel = Err(DirectionsError::Parallel { first: 0, second: 2 });
        assert_eq!(Directions::<6>::new(&[x, y, x * -3.0]), parallel);
        assert_eq!(Directions::<6>::new(&[x, y, x + y * 1e-7]), parallel);
        assert_eq!(Directions::<6>::new(&[x, y, x + y]), Err(DirectionsError::Flat));
        assert_eq!(Directions::<6>::new(&[x, Vector3::zeros(), z]), Err(DirectionsError::NotADirection { index: 1 }));
        for (index, component, bad) in
            (0..27).map(|i| (i / 9, i / 3 % 3, [f64::NAN, f64::INFINITY, -f64::INFINITY][i % 3]))
        {
            let mut given = [x + y, y + z, z];
            given[index][component] = bad;
            let expected = Err(DirectionsError::NotADirection { index });
            assert_eq!(Directions::<6>::new(&given), expected, "{bad} in component {component}");
        }
    }

    #[test]
    fn vectors_may_have_any_length_and_orthogonal_ones_come_first() {
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        let directions = Directions::<10>::new(&[x + y, x * 1e300, y * 5e-324, x - y, z * -2.0]).expect("five");
        assert_eq!([0, 2, 4].map(|i: usize| directions.normals()[i]), [(x + y).normalize(), (x - y).normalize(), -z]);
        assert!(directions.starts_orthogonal() && directions.normals()[6] == x && directions.normals()[8] == y);
        let skew = Directions::<8>::new(&[x, x + y * 1e-3, x + y, x + z]).expect("four");
        assert!(!skew.starts_orthogonal());
        assert!(!Directions::<6>::new(&[x, y + x * 2f64.powi(-39), z]).expect("three").starts_orthogonal());
        assert!(Directions::<6>::new(&[x, y + x * 2f64.powi(-41), z]).expect("three").starts_orthogonal());
        assert_eq!([0, 2, 4].map(|i: usize| skew.normals()[i]), [x, (x + y).normalize(), (x + z).normalize()]);
    }
}
