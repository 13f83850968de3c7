//! Ids of primitives in files, where they are plain numbers.

use crate::PrimitiveId;

/// Returns numbers of a file as ids without copying them. The caller has checked that all of them are below the number
/// of primitives; every other constructor of [`PrimitiveId`] checks its number.
#[inline(always)]
#[must_use]
#[allow(unsafe_code, reason = "a slice of transparent wrappers")]
pub fn as_ids(numbers: &[u32]) -> &[PrimitiveId] {
    // SAFETY: `PrimitiveId` is a transparent wrapper of a u32, so the layouts are equal. Every u32 is a valid value of
    // the type; no unsafe code relies on the range of ids.
    unsafe { std::slice::from_raw_parts(numbers.as_ptr().cast(), numbers.len()) }
}
