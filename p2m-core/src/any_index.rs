//! The object-safe trait of an index.

use crate::pair::PairQuery;
use crate::storage::Writer;
use crate::{
    BoxQuery, BruteForce, BuildError, CertifiedQuery, ClosestPoint, IndexStats, PrimitiveSet, RayQuery, Real, Soup,
};
use std::sync::Arc;

/// A summary of the cells of an index.
#[derive(Clone, Debug, PartialEq)]
pub struct CellSummary {
    /// A short text for users.
    pub text: String,
    /// Named counts for reports.
    pub counts: Vec<(&'static str, u64)>,
    /// The resolution of the cells, if the index has an option for it.
    pub resolution: Option<f64>,
}

/// The result of [`AnyIndex::refitted`]: an index over the moved scene, which the two share.
pub type Refitted<T> = Result<Arc<dyn AnyIndex<T>>, BuildError>;

/// The object-safe trait of an index: it is used as `dyn AnyIndex<T>`.
///
/// Every index answers closest-point, near and certified queries, and reports its costs. Rays, boxes and pairs are
/// optional. Indexes can be sent to other threads and shared among them.
///
/// ```
/// use nalgebra::Point3;
/// use p2m_core::{BruteForce, ClosestPoint, AnyIndex, NearQuery, Point, RayQuery, Soup};
/// use std::sync::Arc;
///
/// let soup: Arc<Soup<f64>> = Arc::default();
/// let index: Box<dyn AnyIndex> = Box::new(BruteForce::new(soup)?);
/// let index = std::thread::spawn(move || {
///     assert!(index.closest_point(&[0.0; 3]).is_none());
///     index
/// });
/// let index = index.join().expect("no panic");
/// assert!(index.k_nearest(&[0.0; 3], 3, 1.0).is_empty());
/// assert!(index.as_ray_query().is_some());
/// # Ok::<(), p2m_core::BuildError>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an index that can be used as `dyn AnyIndex<{T}>`",
    note = "the scene of an index has to be `Send` and `Sync`, so share it by `Arc` and not by `Rc`"
)]
pub trait AnyIndex<T: Real = f64>: ClosestPoint<T> + CertifiedQuery<T> + IndexStats<T> + Send + Sync {
    /// Adds the index to a file, without its scene. An index without a saved form adds nothing.
    fn save<'s>(&'s self, writer: &mut Writer<'s>);

    /// Returns the number of primitives. All ids are below it.
    fn primitive_count(&self) -> usize;

    /// Returns the heap memory that the index owns besides its scene, in bytes.
    fn memory_bytes(&self) -> usize;

    /// Returns the index as a [`RayQuery`], or `None` if it casts no rays.
    fn as_ray_query(&self) -> Option<&(dyn RayQuery<T> + Sync)> {
        None
    }

    /// Returns the index as a [`BoxQuery`], or `None` if it answers no box queries.
    fn as_box_query(&self) -> Option<&(dyn BoxQuery<T> + Sync)> {
        None
    }

    /// Returns the index as a [`PairQuery`], or `None` if it finds no pairs.
    fn as_pair_query(&self) -> Option<&(dyn PairQuery<T> + Sync)> {
        None
    }

    /// Returns a copy of the index that is refitted to a scene in which the same primitives have moved. It returns
    /// `None` if this kind of index cannot be refitted and has to be built anew. The errors are
    /// [`BuildError::OtherLength`] for a scene with another number of primitives, and [`BuildError::NonFinite`].
    fn refitted(&self, soup: Arc<Soup<T>>) -> Option<Refitted<T>> {
        let _ = soup;
        None
    }

    /// Returns the total surface area of the boxes of a tree, which measures its quality.
    fn surface_area(&self) -> Option<f64> {
        None
    }

    /// Returns the summary of the cells, if the index has cells.
    fn cells(&self) -> Option<CellSummary> {
        None
    }
}

impl<T: Real, S: PrimitiveSet<T> + Send + Sync> AnyIndex<T> for BruteForce<S> {
    fn save<'s>(&'s self, _: &mut Writer<'s>) {}

    fn primitive_count(&self) -> usize {
        self.set().len()
    }

    fn memory_bytes(&self) -> usize {
        0
    }

    fn as_ray_query(&self) -> Option<&(dyn RayQuery<T> + Sync)> {
        Some(self)
    }

    fn as_box_query(&self) -> Option<&(dyn BoxQuery<T> + Sync)> {
        Some(self)
    }

    fn as_pair_query(&self) -> Option<&(dyn PairQuery<T> + Sync)> {
        Some(self)
    }

    fn refitted(&self, soup: Arc<Soup<T>>) -> Option<Refitted<T>> {
        let (len, expected) = (soup.len(), self.set().len());
        if len != expected {
            return Some(Err(BuildError::OtherLength { len, expected }));
        }
        Some(BruteForce::new(soup).map(|index| Arc::new(index) as Arc<dyn AnyIndex<T>>))
    }
}

/// Implements the trait for a pointer type by delegation to its target.
macro_rules! index_behind {
    ($target:ident, $pointer:ty) => {
        impl<T: Real, $target: AnyIndex<T> + ?Sized> AnyIndex<T> for $pointer {
            fn save<'s>(&'s self, writer: &mut Writer<'s>) {
                (**self).save(writer);
            }
            fn primitive_count(&self) -> usize {
                (**self).primitive_count()
            }
            fn memory_bytes(&self) -> usize {
                (**self).memory_bytes()
            }
            fn as_ray_query(&self) -> Option<&(dyn RayQuery<T> + Sync)> {
                (**self).as_ray_query()
            }
            fn as_box_query(&self) -> Option<&(dyn BoxQuery<T> + Sync)> {
                (**self).as_box_query()
            }
            fn as_pair_query(&self) -> Option<&(dyn PairQuery<T> + Sync)> {
                (**self).as_pair_query()
            }
            fn refitted(&self, soup: Arc<Soup<T>>) -> Option<Refitted<T>> {
                (**self).refitted(soup)
            }
            fn surface_area(&self) -> Option<f64> {
                (**self).surface_area()
            }
            fn cells(&self) -> Option<CellSummary> {
                (**self).cells()
            }
        }
    };
}

index_behind!(I, &I);
index_behind!(I, Box<I>);
index_behind!(I, Arc<I>);
