//! Columns of answers in NumPy arrays.

use crate::arrays::slice;
use crate::parts::Split;
use numpy::{Element, PyReadwriteArray1};
use p2m_core::batch::ClosestColumns;
use p2m_core::{Closest, Feature};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// The id of a missing primitive.
pub(crate) const NO_PRIMITIVE: i64 = -1;
/// The code of a missing feature.
pub(crate) const NO_FEATURE: u8 = 255;

/// A value of a column, which takes one or more items of a flat array.
pub(crate) trait Value: Sized {
    type Item: Element;

    /// Casts a flat array to a slice of values, or returns `None` if the length does not fit.
    fn of_flat(flat: &mut [Self::Item]) -> Option<&mut [Self]>;
}

macro_rules! single_values {
    ($($Item:ty),*) => {$(
        impl Value for $Item {
            type Item = Self;

            fn of_flat(flat: &mut [Self]) -> Option<&mut [Self]> {
                Some(flat)
            }
        }
    )*};
}
single_values!(f64, i64, i8, u8, bool);

impl<V: Value, const N: usize> Value for [V; N] {
    type Item = V::Item;

    fn of_flat(flat: &mut [V::Item]) -> Option<&mut [Self]> {
        let (values, rest) = V::of_flat(flat)?.as_chunks_mut();
        rest.is_empty().then_some(values)
    }
}

/// Returns a borrowed array as a column of `len` values, if there is an array.
pub(crate) fn column<'a, V: Value>(
    array: &'a mut Option<PyReadwriteArray1<'_, V::Item>>,
    len: usize,
) -> PyResult<Option<&'a mut [V]>> {
    let Some(flat) = slice(array)? else { return Ok(None) };
    match V::of_flat(flat) {
        Some(column) if column.len() == len => Ok(Some(column)),
        _ => Err(PyTypeError::new_err("an array of answers has another length")),
    }
}

/// Defines the arrays and the columns for a type of answers. A missing array is one that the caller did not request.
/// Each column has a name, a type, the value of a missing answer, and a function of an answer.
macro_rules! columns {
    ($Arrays:ident, $Columns:ident, $Answer:ty, { $($name:ident: $Value:ty = $missing:expr, $value:expr;)* }) => {
        /// The NumPy arrays, borrowed for writing.
        pub(crate) struct $Arrays<'py> {
            $($name: Option<numpy::PyReadwriteArray1<'py, <$Value as $crate::columns::Value>::Item>>,)*
        }

        impl<'py> $Arrays<'py> {
            /// Borrows the arrays of a dictionary by their names.
            pub(crate) fn borrow(arrays: &Bound<'py, pyo3::types::PyDict>) -> PyResult<Self> {
                Ok(Self { $($name: $crate::arrays::borrowed(arrays, stringify!($name))?,)* })
            }

            /// Returns the columns, each with room for `len` answers.
            pub(crate) fn columns(&mut self, len: usize) -> PyResult<$Columns<'_>> {
                Ok($Columns { $($name: $crate::columns::column(&mut self.$name, len)?,)* })
            }
        }

        /// The columns of the answers.
        #[derive(Default)]
        pub(crate) struct $Columns<'a> {
            $($name: Option<&'a mut [$Value]>,)*
        }

        impl $Columns<'_> {
            /// Writes an answer, or the values of a missing one.
            pub(crate) fn set(&mut self, i: usize, answer: Option<&$Answer>) {
                $(if let Some(column) = &mut self.$name {
                    column[i] = answer.map_or($missing, $value);
                })*
            }

            /// Writes answers, some of which may be missing, from the first place on.
            pub(crate) fn set_all<'b>(&mut self, answers: impl IntoIterator<Item = Option<&'b $Answer>>) {
                answers.into_iter().enumerate().for_each(|(i, answer)| self.set(i, answer));
            }
        }

        impl $crate::parts::Split for $Columns<'_> {
            fn split(self, len: usize) -> (Self, Self) {
                let (mut first, mut second) = (Self::default(), Self::default());
                $((first.$name, second.$name) = self.$name.split(len);)*
                (first, second)
            }
        }
    };
}
pub(crate) use columns;

/// Defines a Python class for a list of answers before they become columns. The function returns an answer of the list,
/// or `None` if it is missing.
macro_rules! answer_list {
    ($List:ident, $Item:ty, $Arrays:ident, $answer:expr) => {
        /// A list of answers before they become columns.
        #[pyclass(frozen, module = "p2m._p2m")]
        pub(crate) struct $List(pub(crate) Vec<$Item>);

        #[pymethods]
        impl $List {
            fn __len__(&self) -> usize {
                self.0.len()
            }

            /// Writes the columns into the arrays of `out`, which have room for all answers of the list.
            fn fill(&self, py: Python<'_>, out: &Bound<'_, pyo3::types::PyDict>) -> PyResult<()> {
                let mut arrays = $Arrays::borrow(out)?;
                let mut columns = arrays.columns(self.0.len())?;
                py.detach(|| columns.set_all(self.0.iter().map($answer)));
                Ok(())
            }
        }
    };
}
pub(crate) use answer_list;

/// The id of a primitive, and its closest point to a query.
pub(crate) type Near = (i64, Closest<f64>);

columns! { ClosestArrays, ClosestValues, Near, {
    distance: f64 = f64::INFINITY, |(_, closest)| closest.distance;
    primitive: i64 = NO_PRIMITIVE, |(id, _)| *id;
    point: [f64; 3] = [f64::NAN; 3], |(_, closest)| closest.point.coords.into();
    feature: u8 = NO_FEATURE, |(_, closest)| closest.feature.code();
    barycentric: [f64; 3] = [f64::NAN; 3], |(_, closest)| closest.barycentric;
    lower_bound: f64 = f64::INFINITY, |(_, closest)| closest.lower_bound;
}}

answer_list!(NearList, Near, ClosestArrays, Some);

impl ClosestValues<'_> {
    /// Passes the columns to a batch, which fills them.
    ///
    /// The primitives of a batch are u32, but the column is i64. The batch writes them into the first half of the
    /// column, and [`spread`] then widens them from the last one to the first, so primitives need no other memory.
    pub(crate) fn fill(self, batch: impl FnOnce(ClosestColumns<'_, f64>)) {
        let Self { distance, mut primitive, point, feature, barycentric, lower_bound } = self;
        let mut features = feature.as_ref().map(|column| vec![Feature::Face; column.len()]);
        let mut distances = Vec::new();
        let mut columns = ClosestColumns::default();
        // The feature of a missing answer is that of a vertex, so the distances show which answers are missing.
        let known_distance = match (distance, &feature) {
            (Some(column), _) => Some(column),
            (None, Some(feature)) => {
                distances.resize(feature.len(), 0.0);
                Some(&mut distances[..])
            }
            (None, None) => None,
        };
        columns.lower_bound = lower_bound;
        columns.barycentric = barycentric;
        columns.point = point.map(bytemuck::cast_slice_mut);
        columns.feature = features.as_deref_mut();
        columns.primitive = primitive.as_deref_mut().map(|column| {
            let len = column.len();
            &mut bytemuck::cast_slice_mut::<i64, u32>(column)[..len]
        });
        let mut known_distance = known_distance;
        columns.distance = known_distance.as_deref_mut();
        batch(columns);
        if let Some(column) = primitive {
            spread(column);
        }
        if let (Some(column), Some(features), Some(distances)) = (feature, features, known_distance) {
            for ((number, feature), distance) in column.iter_mut().zip(features).zip(distances) {
                *number = if *distance < f64::INFINITY { feature.code() } else { NO_FEATURE };
            }
        }
    }
}

/// Widens the u32 in the first half of a column to i64.
fn spread(column: &mut [i64]) {
    for i in (0..column.len()).rev() {
        // Value `i` lies at or before its destination, so no value that is still needed is overwritten.
        let number = bytemuck::cast_slice::<i64, u32>(column)[i];
        column[i] = if number == ClosestColumns::<f64>::NO_PRIMITIVE { NO_PRIMITIVE } else { i64::from(number) };
    }
}

/// The rows of a column with several answers for each query.
pub(crate) struct Rows<C> {
    pub(crate) columns: C,
    /// The number of answers for each query.
    pub(crate) width: usize,
}

impl<C: Split> Split for Rows<C> {
    fn split(self, len: usize) -> (Self, Self) {
        let width = self.width;
        let (first, second) = self.columns.split(len * width);
        (Self { columns: first, width }, Self { columns: second, width })
    }
}
