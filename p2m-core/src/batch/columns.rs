//! Answers of a batch as columns (structure of arrays).

use super::parts::Split;
use crate::{BatchAnswer, Closest, Feature, PrimitiveId, Real};
use nalgebra::Point3;

/// The requested columns of the answers, each with one value per query.
///
/// A query has no answer if nothing lies within the largest distance, or if the query is not finite. Its distance and
/// its lower bound are infinite, its primitive is [`NO_PRIMITIVE`](Self::NO_PRIMITIVE), its point and its weights are
/// NaN, and its feature is `Vertex(0)`.
///
/// ```
/// use p2m_core::batch::ClosestColumns;
///
/// let (mut distance, mut primitive) = ([0.0; 3], [0; 3]);
/// let columns = ClosestColumns::<f64>::default().with_distance(&mut distance).with_primitive(&mut primitive);
/// assert_eq!(columns.len(), Some(3));
/// ```
#[derive(Debug, Default)]
#[non_exhaustive]
pub struct ClosestColumns<'a, T: Real> {
    /// The distances, as in [`Closest::distance`](crate::Closest::distance).
    pub distance: Option<&'a mut [T]>,
    /// The indices of the primitives, as in [`Closest::primitive`](crate::Closest::primitive).
    pub primitive: Option<&'a mut [u32]>,
    /// The closest points.
    pub point: Option<&'a mut [Point3<T>]>,
    /// The features of the primitives that contain the closest points.
    pub feature: Option<&'a mut [Feature]>,
    /// The weights of the vertices, as in [`Closest::barycentric`](crate::Closest::barycentric).
    pub barycentric: Option<&'a mut [[T; 3]]>,
    /// The certified lower bounds, as in [`Closest::lower_bound`](crate::Closest::lower_bound).
    pub lower_bound: Option<&'a mut [T]>,
}

/// Implements the builder methods that set a column.
macro_rules! setters {
    ($($method:ident, $field:ident: $type:ty, $what:literal;)*) => {
        impl<'a, T: Real> ClosestColumns<'a, T> {
            $(
                #[doc = concat!("Asks for ", $what, ".")]
                #[must_use]
                pub fn $method(self, column: &'a mut [$type]) -> Self {
                    Self { $field: Some(column), ..self }
                }
            )*

            /// Returns the lengths of all columns.
            fn lengths(&self) -> impl Iterator<Item = usize> {
                [$(self.$field.as_ref().map(|column| column.len())),*].into_iter().flatten()
            }

            /// Splits all columns in two; the first part has `len` values.
            pub(super) fn split_at(self, len: usize) -> (Self, Self) {
                let (mut first, mut second) = (Self::default(), Self::default());
                $(
                    if let Some((a, b)) = self.$field.map(|column| column.split_at_mut(len)) {
                        (first.$field, second.$field) = (Some(a), Some(b));
                    }
                )*
                (first, second)
            }
        }
    };
}

setters! {
    with_distance, distance: T, "distances";
    with_primitive, primitive: u32, "indices of primitives";
    with_point, point: Point3<T>, "closest points";
    with_feature, feature: Feature, "features";
    with_barycentric, barycentric: [T; 3], "weights of the vertices";
    with_lower_bound, lower_bound: T, "certified lower bounds";
}

impl<T: Real> ClosestColumns<'_, T> {
    /// The index that marks a query without an answer. No primitive has it.
    pub const NO_PRIMITIVE: u32 = u32::MAX;

    /// Returns the length of the columns, and `None` if there are none.
    ///
    /// # Panics
    /// It panics if the columns differ in length.
    #[must_use]
    pub fn len(&self) -> Option<usize> {
        let len = self.lengths().next()?;
        assert!(self.lengths().all(|other| other == len), "columns of one length");
        Some(len)
    }

    /// Returns the answer to the query at a position, once the columns are filled. It is `None` if the query has no
    /// answer or a column is missing.
    #[must_use]
    pub fn closest(&self, position: usize) -> Option<Closest<T>> {
        let number = self.primitive.as_ref()?[position];
        (number != Self::NO_PRIMITIVE).then_some(())?;
        Some(Closest {
            point: self.point.as_ref()?[position],
            distance: self.distance.as_ref()?[position],
            lower_bound: self.lower_bound.as_ref()?[position],
            primitive: PrimitiveId::new(number as usize),
            feature: self.feature.as_ref()?[position],
            barycentric: self.barycentric.as_ref()?[position],
        })
    }

    /// Returns whether no column is requested.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lengths().next().is_none()
    }
}

/// A destination for the answers to closest-point queries.
pub(super) trait Sink<T: Real>: Split {
    /// Stores the answer to the query at a position.
    fn set(&mut self, position: usize, found: BatchAnswer<'_, T>);
}

impl<T: Real> Sink<T> for ClosestColumns<'_, T> {
    #[inline(always)]
    fn set(&mut self, i: usize, found: BatchAnswer<'_, T>) {
        if let (None, None, None, None) = (&self.point, &self.feature, &self.barycentric, &self.lower_bound) {
            // The other fields of the answer need not be computed.
            let (distance, primitive) = found.distance_and_index().unwrap_or((T::INFINITY, Self::NO_PRIMITIVE));
            put(&mut self.distance, i, distance);
            put(&mut self.primitive, i, primitive);
            return;
        }
        self.set_all(i, found);
    }
}

impl<T: Real> Split for ClosestColumns<'_, T> {
    fn split(self, len: usize) -> (Self, Self) {
        self.split_at(len)
    }
}

impl<T: Real> ClosestColumns<'_, T> {
    fn set_all(&mut self, i: usize, found: BatchAnswer<'_, T>) {
        let nan = T::round_from_f64(f64::NAN);
        let closest = found.closest();
        put(&mut self.distance, i, closest.map_or(T::INFINITY, |c| c.distance));
        put(&mut self.primitive, i, closest.map_or(Self::NO_PRIMITIVE, |c| c.primitive.number()));
        put(&mut self.point, i, closest.map_or(Point3::new(nan, nan, nan), |c| c.point));
        put(&mut self.feature, i, closest.map_or(Feature::Vertex(0), |c| c.feature));
        put(&mut self.barycentric, i, closest.map_or([nan; 3], |c| c.barycentric));
        put(&mut self.lower_bound, i, closest.map_or_else(|| found.lower_bound(), |c| c.lower_bound));
    }
}

/// Writes a value to a column that is asked for.
#[inline(always)]
fn put<V>(column: &mut Option<&mut [V]>, i: usize, value: V) {
    if let Some(column) = column {
        column[i] = value;
    }
}

impl<T: Real> Sink<T> for &mut [Option<crate::Closest<T>>] {
    #[inline(always)]
    fn set(&mut self, i: usize, found: BatchAnswer<'_, T>) {
        self[i] = found.closest();
    }
}
