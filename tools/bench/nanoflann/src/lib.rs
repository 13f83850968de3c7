//! The KD-tree of the C++ library nanoflann, as a rival of `p2m-bench`.
//!
//! The build needs a C++ compiler and the header `nanoflann.hpp`, which is in the package `libnanoflann-dev` of Debian.
//! The tree has leaves of at most ten points, as is the default of nanoflann.

use std::ffi::c_void;
use std::ptr::NonNull;

/// A scalar in which nanoflann is compiled.
pub trait Scalar: Copy + sealed::Functions {}

impl Scalar for f64 {}
impl Scalar for f32 {}

mod sealed {
    use std::ffi::c_void;

    /// The functions of the adapter in C++ for a scalar.
    pub trait Functions: Sized {
        /// Builds a tree over points, which it borrows, and returns a null pointer if it fails.
        const BUILD: unsafe extern "C" fn(coordinates: *const Self, count: usize) -> *mut c_void;
        /// Writes the squared distance and the number of the nearest point of each query.
        const NEAREST: unsafe extern "C" fn(
            tree: *const c_void,
            queries: *const Self,
            count: usize,
            squares: *mut Self,
            numbers: *mut u32,
        );
        /// Frees a tree.
        const FREE: unsafe extern "C" fn(tree: *mut c_void);
    }

    unsafe extern "C" {
        fn p2m_nanoflann_build_f64(coordinates: *const f64, count: usize) -> *mut c_void;
        fn p2m_nanoflann_build_f32(coordinates: *const f32, count: usize) -> *mut c_void;
        fn p2m_nanoflann_nearest_f64(
            tree: *const c_void,
            queries: *const f64,
            count: usize,
            squares: *mut f64,
            numbers: *mut u32,
        );
        fn p2m_nanoflann_nearest_f32(
            tree: *const c_void,
            queries: *const f32,
            count: usize,
            squares: *mut f32,
            numbers: *mut u32,
        );
        fn p2m_nanoflann_free_f64(tree: *mut c_void);
        fn p2m_nanoflann_free_f32(tree: *mut c_void);
    }

    impl Functions for f64 {
        const BUILD: unsafe extern "C" fn(*const f64, usize) -> *mut c_void = p2m_nanoflann_build_f64;
        const NEAREST: unsafe extern "C" fn(*const c_void, *const f64, usize, *mut f64, *mut u32) =
            p2m_nanoflann_nearest_f64;
        const FREE: unsafe extern "C" fn(*mut c_void) = p2m_nanoflann_free_f64;
    }

    impl Functions for f32 {
        const BUILD: unsafe extern "C" fn(*const f32, usize) -> *mut c_void = p2m_nanoflann_build_f32;
        const NEAREST: unsafe extern "C" fn(*const c_void, *const f32, usize, *mut f32, *mut u32) =
            p2m_nanoflann_nearest_f32;
        const FREE: unsafe extern "C" fn(*mut c_void) = p2m_nanoflann_free_f32;
    }
}

/// A KD-tree over points.
#[derive(Debug)]
pub struct KdTree<T: Scalar> {
    tree: NonNull<c_void>,
    /// The points, which the tree refers to.
    _points: Vec<[T; 3]>,
}

// SAFETY: the tree in C++ has no state of a thread.
unsafe impl<T: Scalar> Send for KdTree<T> {}
// SAFETY: searches do not change the tree.
unsafe impl<T: Scalar> Sync for KdTree<T> {}

impl<T: Scalar> KdTree<T> {
    /// Builds a tree. The result is `None` if there is no point, if their number exceeds `u32`, or if there is no
    /// memory.
    #[must_use]
    pub fn new(points: Vec<[T; 3]>) -> Option<Self> {
        if points.is_empty() || u32::try_from(points.len()).is_err() {
            return None;
        }
        // SAFETY: the array has three coordinates for each point, and its memory stays where it is while the tree
        // exists, because the vector is not changed.
        let tree = unsafe { T::BUILD(points.as_ptr().cast(), points.len()) };
        Some(Self { tree: NonNull::new(tree)?, _points: points })
    }

    /// Finds the nearest point of each query, and writes its squared distance and its number.
    ///
    /// # Panics
    /// If the arrays have different lengths.
    pub fn nearest(&self, queries: &[[T; 3]], squares: &mut [T], numbers: &mut [u32]) {
        assert!(queries.len() == squares.len() && queries.len() == numbers.len(), "arrays of one length");
        let (squares, numbers) = (squares.as_mut_ptr(), numbers.as_mut_ptr());
        // SAFETY: the tree was built by the functions of this scalar, and the arrays have the length that is passed.
        unsafe { T::NEAREST(self.tree.as_ptr(), queries.as_ptr().cast(), queries.len(), squares, numbers) }
    }
}

impl<T: Scalar> Drop for KdTree<T> {
    fn drop(&mut self) {
        // SAFETY: the tree was built by the functions of this scalar and is freed once.
        unsafe { T::FREE(self.tree.as_ptr()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_points_are_found_in_both_scalars() {
        let points = [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0], [-4.0, 0.5, 1.0]];
        let tree = KdTree::new(points.to_vec()).unwrap();
        let (mut squares, mut numbers) = ([0.0; 2], [0; 2]);
        tree.nearest(&[[1.0, 2.0, 4.0], [-3.0, 0.5, 1.0]], &mut squares, &mut numbers);
        assert_eq!((squares, numbers), ([1.0, 1.0], [1, 2]));
        let tree = KdTree::new(points.map(|p| p.map(|x| x as f32)).to_vec()).unwrap();
        let (mut squares, mut numbers) = ([0.0; 1], [0; 1]);
        tree.nearest(&[[0.0, 0.0, -2.0]], &mut squares, &mut numbers);
        assert_eq!((squares, numbers), ([4.0f32], [0]));
        assert!(KdTree::<f64>::new(Vec::new()).is_none());
    }
}
