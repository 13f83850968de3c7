//! Regular grids of query points.

use nalgebra::Point3;
use p2m_core::Aabb;

/// Reasons why a grid or a field cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// The grid has no points, or more than 2^40.
    #[error("a grid of {0} x {1} x {2} points is none, or has more than 2^40")]
    Count(usize, usize, usize),
    /// The spacing is not positive and finite, or the grid reaches beyond the range of f64.
    #[error("a spacing of {0} is none for a grid in the range of numbers")]
    Spacing(f64),
    /// Coordinates are so large that candidate lists cannot square them.
    #[error("coordinates above 2^250 are out of range for fields by lists")]
    Range,
    /// The values of the field do not fit into memory.
    #[error("there is no memory for {0} values")]
    Memory(usize),
    /// The scene is empty, so no grid can be put around it.
    #[error("the scene is empty: there is nothing around which to put a grid")]
    Empty,
}

/// Points at equal distances along the axes.
///
/// The point with the indices (i, j, k) is origin + spacing * (i, j, k), rounded to f64. In a [part](Self::part) of a
/// grid it is the point of the whole grid, with the same coordinates.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_field::Grid;
///
/// let grid = Grid::new(Point3::new(-1.0, 0.0, 0.0), 0.5, [5, 3, 3])?;
/// assert_eq!((grid.len(), grid.point([4, 0, 2])), (45, Point3::new(1.0, 0.0, 1.0)));
/// # Ok::<(), p2m_field::GridError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The origin of the whole grid.
    origin: Point3<f64>,
    spacing: f64,
    /// The indices in the whole grid of the point with the indices (0, 0, 0).
    first: [usize; 3],
    counts: [usize; 3],
}

impl Grid {
    /// The largest number of points.
    const MAX_POINTS: u64 = 1 << 40;

    /// Makes a grid of `counts` points along the axes.
    ///
    /// # Errors
    /// [`GridError::Count`] for no points or more than 2^40. [`GridError::Spacing`] if the spacing is not positive, or
    /// a coordinate is not finite.
    pub fn new(origin: Point3<f64>, spacing: f64, counts: [usize; 3]) -> Result<Self, GridError> {
        let [x, y, z] = counts;
        let total = x.checked_mul(y).and_then(|n| n.checked_mul(z));
        if !total.is_some_and(|n| (1..=Self::MAX_POINTS).contains(&(n as u64))) {
            return Err(GridError::Count(x, y, z));
        }
        Self { origin, spacing, first: [0; 3], counts }.checked()
    }

    /// Returns the grid of `counts` points of this one from the indices `first` on, which may lie beyond this grid.
    ///
    /// The coordinates of its points are the same bits as in this grid, so the field of a grid can be computed by
    /// parts. A new grid with the origin `self.point(first)` has coordinates that may differ by their rounding.
    ///
    /// # Errors
    /// The errors of [`new`](Self::new), and [`GridError::Count`] for indices above 2^40.
    pub fn part(&self, first: [usize; 3], counts: [usize; 3]) -> Result<Self, GridError> {
        let first: [Option<usize>; 3] = std::array::from_fn(|k| {
            let sum = self.first[k].checked_add(first[k])?;
            (sum as u64 <= Self::MAX_POINTS).then_some(sum)
        });
        let [Some(x), Some(y), Some(z)] = first else {
            return Err(GridError::Count(counts[0], counts[1], counts[2]));
        };
        let whole = Self::new(self.origin, self.spacing, counts)?;
        Self { first: [x, y, z], ..whole }.checked()
    }

    /// Returns the grid if its coordinates are finite and its points are apart.
    fn checked(self) -> Result<Self, GridError> {
        let ends = [self.point([0; 3]), self.point(self.counts.map(|n| n - 1))];
        let is_in_range = self.spacing > 0.0 && ends.iter().flat_map(|p| p.iter()).all(|x| x.is_finite());
        if is_in_range { Ok(self) } else { Err(GridError::Spacing(self.spacing)) }
    }

    /// Makes a grid that covers a box, scaled about its centre.
    ///
    /// The longest side of the scaled box gets `resolution` points, its ends included. The other sides get as many as
    /// cover them, and each axis gets at least two.
    ///
    /// # Errors
    /// [`GridError::Empty`] for an empty box. [`GridError::Spacing`] for a box without extent, or if a coordinate of
    /// the grid is not finite. [`GridError::Count`] for more than 2^40 points.
    pub fn around(bounds: &Aabb<f64>, resolution: usize, scale: f64) -> Result<Self, GridError> {
        if bounds.min.x > bounds.max.x {
            return Err(GridError::Empty);
        }
        let resolution = resolution.max(2);
        // Bounds are halved before they are subtracted, because the difference of two finite numbers may be infinite.
        let half: [f64; 3] = std::array::from_fn(|k| (bounds.max[k] * 0.5 - bounds.min[k] * 0.5) * scale);
        let longest = half.into_iter().fold(0.0, f64::max);
        #[allow(clippy::cast_precision_loss, reason = "a number of points")]
        let spacing = longest / (resolution - 1) as f64 * 2.0;
        if !(spacing > 0.0 && spacing.is_finite()) {
            return Err(GridError::Spacing(spacing));
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most the resolution")]
        let counts = half.map(|half| {
            let steps = (half / spacing * 2.0 - 1e-9).ceil();
            if steps >= 1.0 { (steps as usize).saturating_add(1).min(resolution) } else { 2 }
        });
        #[allow(clippy::cast_precision_loss, reason = "a number of points")]
        let origin = std::array::from_fn::<f64, 3, _>(|k| {
            let centre = bounds.min[k] * 0.5 + bounds.max[k] * 0.5;
            centre - spacing * ((counts[k] - 1) as f64 * 0.5)
        });
        Self::new(origin.into(), spacing, counts)
    }

    /// Returns the point with the indices (0, 0, 0).
    #[must_use]
    pub fn origin(&self) -> Point3<f64> {
        self.point([0; 3])
    }

    /// Returns the distance of neighbouring points, in units of the scene.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Returns the number of points along each axis.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        self.counts
    }

    /// Returns the number of points.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "there is one at least")]
    pub fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// Returns the point with the indices (i, j, k).
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "at most 2^41")]
    pub fn point(&self, indices: [usize; 3]) -> Point3<f64> {
        std::array::from_fn::<f64, 3, _>(|k| self.origin[k] + self.spacing * (self.first[k] + indices[k]) as f64).into()
    }

    /// Returns the number of the point (i, j, k) in a field, where x runs fastest and z slowest.
    #[must_use]
    pub fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.counts[1] + j) * self.counts[0] + i
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounds(max: [f64; 3]) -> Aabb<f64> {
        Aabb { min: Point3::origin(), max: Point3::from(max) }
    }

    #[test]
    fn grids_cover_their_box_about_its_centre() {
        let grid = Grid::around(&bounds([8.0, 4.0, 0.0]), 9, 1.0).unwrap();
        assert_eq!((grid.counts(), grid.spacing(), grid.len()), ([9, 5, 2], 1.0, 90));
        assert_eq!(grid.origin(), Point3::new(0.0, 0.0, -0.5));
        assert_eq!(grid.point([8, 4, 1]), Point3::new(8.0, 4.0, 0.5));
        assert_eq!(grid.number([8, 4, 1]), 89);
        let grid = Grid::around(&bounds([8.0, 3.5, 2.0]), 5, 2.0).unwrap();
        assert_eq!((grid.counts(), grid.spacing()), ([5, 3, 2], 4.0));
        assert_eq!(grid.origin(), Point3::new(-4.0, 1.75 - 4.0, -1.0));
    }

    #[test]
    fn parts_of_a_grid_have_its_points() {
        let whole = Grid::new(Point3::new(-0.3, 0.1, 7.7), 0.1, [50, 40, 30]).unwrap();
        let part = whole.part([7, 3, 11], [30, 20, 10]).unwrap();
        let inner = part.part([5, 4, 3], [2, 2, 2]).unwrap();
        let mut rounded_otherwise = 0;
        let moved = Grid::new(part.origin(), 0.1, part.counts()).unwrap();
        for n in 0..part.len() {
            let [i, j, k] = [n % 30, n / 30 % 20, n / 600];
            assert_eq!(part.point([i, j, k]), whole.point([7 + i, 3 + j, 11 + k]));
            rounded_otherwise += usize::from(moved.point([i, j, k]) != part.point([i, j, k]));
        }
        assert!(rounded_otherwise > 0);
        assert_eq!(inner.point([1, 1, 1]), whole.point([13, 8, 15]));
        assert_eq!((part.origin(), part.counts()), (whole.point([7, 3, 11]), [30, 20, 10]));
        assert_eq!(whole.part([60, 0, 0], [1, 1, 1]).unwrap().origin(), whole.point([60, 0, 0]));
        assert_eq!(whole.part([0; 3], [0, 1, 1]), Err(GridError::Count(0, 1, 1)));
        assert_eq!(whole.part([usize::MAX; 3], [1, 1, 1]), Err(GridError::Count(1, 1, 1)));
        assert_eq!(part.part([usize::MAX; 3], [1, 1, 1]), Err(GridError::Count(1, 1, 1)));
        let wide = Grid::new(Point3::origin(), 1e300, [2, 2, 2]).unwrap();
        assert!(matches!(wide.part([1 << 39, 0, 0], [1, 1, 1]), Err(GridError::Spacing(_))));
    }

    #[test]
    fn invalid_grids_return_errors() {
        assert_eq!(Grid::around(&Aabb::empty(), 5, 1.0), Err(GridError::Empty));
        assert!(matches!(Grid::around(&bounds([0.0; 3]), 5, 1.0), Err(GridError::Spacing(_))));
        assert!(matches!(Grid::around(&bounds([f64::MAX; 3]), 5, 3.0), Err(GridError::Spacing(_))));
        assert!(matches!(Grid::around(&bounds([1e-323; 3]), 64, 1.0), Err(GridError::Spacing(_))));
        assert!(Grid::around(&bounds([1.0; 3]), usize::MAX, 1.0).is_err());
        let new = |spacing, counts| Grid::new(Point3::origin(), spacing, counts);
        assert_eq!(new(1.0, [0, 1, 1]), Err(GridError::Count(0, 1, 1)));
        assert_eq!(new(1.0, [usize::MAX, 2, 1]), Err(GridError::Count(usize::MAX, 2, 1)));
        assert!(matches!(new(-1.0, [2, 2, 2]), Err(GridError::Spacing(_))));
        assert!(matches!(new(f64::NAN, [1, 1, 1]), Err(GridError::Spacing(_))));
        assert_eq!(Grid::around(&bounds([f64::MAX; 3]), 5, 1.0).unwrap().counts(), [5, 5, 5]);
    }
}
