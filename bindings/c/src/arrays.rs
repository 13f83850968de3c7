//! Arrays and other pointers from the caller.

use crate::status::{Call, Failure, invalid};
use nalgebra::Point3;
use p2m_core::Position;
use std::borrow::Cow;
use std::ffi::{CStr, c_char, c_void};

/// The type of the numbers of an array.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// `float`, for coordinates.
    F32 = 0,
    /// `double`, for coordinates.
    F64 = 1,
    /// `uint32_t`, for indices.
    U32 = 2,
    /// `uint64_t`, for indices.
    U64 = 3,
}

/// An array that the library reads during a call: `count` rows of one to three numbers, depending on the function.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Array {
    /// The first number of the first row. It may be null if `count` is 0.
    pub data: *const c_void,
    /// The number of rows.
    pub count: usize,
    /// The number of bytes from one row to the next, a multiple of the size of a number; 0 if there are no gaps between
    /// rows.
    pub stride: usize,
    /// The type of the numbers, a value of `p2m_scalar`.
    pub scalar: u32,
}

/// An array that the library fills with answers during a call, with a row for each query.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// The first row, or null if these answers are not needed.
    pub data: *mut c_void,
    /// The number of bytes from one row to the next; 0 if there are no gaps between rows.
    pub stride: usize,
}

pub(crate) trait Number: Copy {
    const SCALAR: Scalar;
}

macro_rules! numbers {
    ($($type:ty: $scalar:ident)*) => {
        $(impl Number for $type { const SCALAR: Scalar = Scalar::$scalar; })*
    };
}
numbers! { f32: F32 f64: F64 u32: U32 u64: U64 }

/// Returns the number of bytes from one row to the next, and checks that all rows fit into the address space.
fn stride_of<R>(name: &str, data: *const c_void, count: usize, stride: usize, alignment: usize) -> Call<usize> {
    let stride = if stride == 0 { size_of::<R>() } else { stride };
    check_pointer(data, name)?;
    if !data.addr().is_multiple_of(alignment) || !stride.is_multiple_of(alignment) || stride < size_of::<R>() {
        let size = size_of::<R>();
        return Err(invalid(format!("{name}: the address or the stride does not fit rows of {size} bytes")));
    }
    let bytes = count.checked_mul(stride).filter(|bytes| isize::try_from(*bytes).is_ok());
    match bytes.and_then(|bytes| data.addr().checked_add(bytes)) {
        Some(_) => Ok(stride),
        None => Err(invalid(format!("{name}: {count} rows do not fit into memory"))),
    }
}

/// Evaluates an expression with the rows of an array of coordinates, in either type. The conditions of `rows` have to
/// hold.
macro_rules! with_coordinates {
    ($array:expr, $name:expr, $rows:ident => $body:expr) => {{
        let array: &$crate::arrays::Array = $array;
        if array.count == 0 || array.has::<f64>() {
            let rows = array.rows::<f64, 3>($name)?;
            let $rows: &[[f64; 3]] = &rows;
            $body
        } else if array.has::<f32>() {
            let rows = array.rows::<f32, 3>($name)?;
            let $rows: &[[f32; 3]] = &rows;
            $body
        } else {
            return Err($crate::status::invalid(format!(
                "{}: coordinates are of type P2M_SCALAR_F32 or P2M_SCALAR_F64",
                $name
            )));
        }
    }};
}
pub(crate) use with_coordinates;

impl Array {
    /// Returns whether the numbers have type `T`.
    pub(crate) fn has<T: Number>(&self) -> bool {
        self.scalar == T::SCALAR as u32
    }

    /// Returns the rows of an array of numbers of this type, borrowed where they are contiguous.
    ///
    /// # Safety
    /// The array has to point to as much memory as it claims, which nobody changes while the rows live.
    pub(crate) unsafe fn rows<'a, T: Number, const N: usize>(&self, name: &str) -> Call<Cow<'a, [[T; N]]>> {
        if self.count == 0 {
            return Ok(Cow::Borrowed(&[]));
        }
        let stride = stride_of::<[T; N]>(name, self.data, self.count, self.stride, align_of::<T>())?;
        if stride == size_of::<[T; N]>() {
            // SAFETY: the address is aligned, and the caller vouches for the memory.
            return Ok(Cow::Borrowed(unsafe { std::slice::from_raw_parts(self.data.cast(), self.count) }));
        }
        // SAFETY: each row is aligned and within the memory that the caller vouches for.
        let row = |i: usize| unsafe { self.data.byte_add(i * stride).cast::<[T; N]>().read() };
        Ok((0..self.count).map(row).collect())
    }

    /// Returns rows of coordinates of either type as points. They are borrowed if they are contiguous and f64.
    ///
    /// # Safety
    /// The conditions of [`rows`](Self::rows) have to hold.
    pub(crate) unsafe fn points<'a>(&self, name: &str) -> Call<Cow<'a, [Point3<f64>]>> {
        // SAFETY: the caller vouches for the memory.
        unsafe {
            if self.has::<f64>()
                && let Cow::Borrowed(rows) = self.rows::<f64, 3>(name)?
            {
                return Ok(Cow::Borrowed(bytemuck::cast_slice(rows)));
            }
            with_coordinates!(self, name, rows => Ok(rows.iter().map(Position::<f64>::point).collect()))
        }
    }

    /// Returns rows of indices.
    ///
    /// # Safety
    /// The conditions of [`rows`](Self::rows) have to hold.
    pub(crate) unsafe fn indices<const N: usize>(&self, name: &str) -> Call<Vec<[u32; N]>> {
        if self.count == 0 {
            return Ok(Vec::new());
        }
        if self.has::<u32>() {
            // SAFETY: the caller vouches for the memory.
            return Ok(unsafe { self.rows::<u32, N>(name) }?.to_vec());
        }
        if self.has::<u64>() {
            // SAFETY: the caller vouches for the memory.
            let rows = unsafe { self.rows::<u64, N>(name) }?;
            if rows.iter().flatten().any(|i| u32::try_from(*i).is_err()) {
                return Err(invalid(format!("{name}: an index has more than 32 bits")));
            }
            return Ok(rows.iter().map(|row| row.map(|i| u32::try_from(i).unwrap_or(u32::MAX))).collect());
        }
        Err(invalid(format!("{name}: indices are of type P2M_SCALAR_U32 or P2M_SCALAR_U64")))
    }
}

/// The rows of a column, written in place where they are contiguous.
pub(crate) struct Out<'a, R> {
    column: Column,
    stride: usize,
    in_place: Option<&'a mut [R]>,
    copied: Vec<R>,
}

impl<R: Copy> Out<'_, R> {
    /// Returns the values to be written.
    pub(crate) fn values(&mut self) -> &mut [R] {
        match &mut self.in_place {
            Some(rows) => rows,
            None => &mut self.copied,
        }
    }

    /// Writes the values that are not in place yet.
    pub(crate) fn finish(self) {
        for (i, value) in self.copied.into_iter().enumerate() {
            // SAFETY: each row is aligned and within the memory that the caller vouches for.
            unsafe { self.column.data.byte_add(i * self.stride).cast::<R>().write(value) };
        }
    }
}

impl Column {
    /// Returns the destination for `count` rows, or `None` if the column is not wanted. Rows initially have the value
    /// `unset`.
    ///
    /// # Safety
    /// The column has to point to as much memory as it claims, which nobody else uses while the destination lives.
    pub(crate) unsafe fn out<'a, R: Copy>(self, name: &str, count: usize, unset: R) -> Call<Option<Out<'a, R>>> {
        if self.data.is_null() {
            return Ok(None);
        }
        let stride = stride_of::<R>(name, self.data, count, self.stride, align_of::<R>())?;
        let mut out = Out { column: self, stride, in_place: None, copied: Vec::new() };
        if stride == size_of::<R>() {
            // SAFETY: the address is aligned, and the caller vouches for the memory. Numbers of C may be uninitialised,
            // so they are written before they become a slice.
            out.in_place = Some(unsafe {
                let data = self.data.cast::<R>();
                (0..count).for_each(|i| data.add(i).write(unset));
                std::slice::from_raw_parts_mut(data, count)
            });
        } else {
            out.copied = vec![unset; count];
        }
        Ok(Some(out))
    }
}

/// Fails if a pointer is null or misaligned. It is not dereferenced.
pub(crate) fn check_pointer<T>(pointer: *const T, name: &str) -> Call {
    let is_usable = !pointer.is_null() && pointer.is_aligned();
    is_usable.then_some(()).ok_or_else(|| fault(name, "the pointer is null or misaligned"))
}

/// Returns the failure for an argument. It is a cold function, so that successful checks take few instructions.
#[cold]
fn fault(name: &str, what: &str) -> Failure {
    invalid(format!("{name}: {what}"))
}

/// Returns a reference to the target of a pointer.
///
/// # Safety
/// A pointer that is not null has to point to a valid value that lives long enough.
pub(crate) unsafe fn reference<'a, T>(pointer: *const T, name: &str) -> Call<&'a T> {
    check_pointer(pointer, name)?;
    // SAFETY: the pointer is aligned and not null, and the caller vouches for the rest.
    Ok(unsafe { &*pointer })
}

/// Writes a result.
///
/// # Safety
/// A pointer that is not null has to point to memory for the value.
pub(crate) unsafe fn write<T>(pointer: *mut T, name: &str, value: T) -> Call {
    check_pointer(pointer, name)?;
    // SAFETY: the pointer is aligned and not null, and the caller vouches for the rest.
    unsafe { pointer.write(value) };
    Ok(())
}

/// Passes ownership of an object to the caller as a pointer. The object is not made if the place for the pointer is
/// invalid.
///
/// # Safety
/// A pointer that is not null has to point to memory for a pointer.
pub(crate) unsafe fn give<T>(place: *mut *mut T, name: &str, make: impl FnOnce() -> Call<T>) -> Call {
    // SAFETY: the caller vouches for the memory.
    unsafe { write(place, name, std::ptr::null_mut()) }?;
    let object = Box::into_raw(Box::new(make()?));
    // SAFETY: the caller vouches for the memory.
    unsafe { write(place, name, object) }
}

/// Frees an object that [`give`] passed to the caller.
///
/// # Safety
/// The pointer has to be null, or come from [`give`] and not have been freed.
pub(crate) unsafe fn take_back<T>(pointer: *mut T) {
    if !pointer.is_null() {
        // SAFETY: the caller vouches for the pointer.
        drop(unsafe { Box::from_raw(pointer) });
    }
}

/// Returns a C string as text.
///
/// # Safety
/// A pointer that is not null has to point to a string that ends with a zero.
pub(crate) unsafe fn text<'a>(pointer: *const c_char, name: &str) -> Call<&'a str> {
    check_pointer(pointer, name)?;
    // SAFETY: the pointer is not null, and the caller vouches for the rest.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| invalid(format!("{name}: the string is not UTF-8")))
}

/// Returns a largest distance, or fails if it is NaN.
pub(crate) fn length(length: f64, name: &str) -> Call<f64> {
    if length.is_nan() { Err(fault(name, "not a number")) } else { Ok(length) }
}

/// Returns finite coordinates.
///
/// # Safety
/// A pointer that is not null has to point to three numbers.
pub(crate) unsafe fn point(pointer: *const f64, name: &str) -> Call<[f64; 3]> {
    // SAFETY: the caller vouches for the memory.
    let point = *unsafe { reference(pointer.cast::<[f64; 3]>(), name) }?;
    if point.iter().all(|x| x.is_finite()) { Ok(point) } else { Err(fault(name, "not finite")) }
}
