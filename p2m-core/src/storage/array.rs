//! Arrays that are either owned or part of a file in memory.

use bytemuck::AnyBitPattern;
use std::fmt;
use std::ops::Deref;
use std::panic::{RefUnwindSafe, UnwindSafe};
use std::sync::Arc;

/// The bytes of a file, at a fixed address.
pub(super) type FileBytes = Arc<dyn AsRef<[u8]> + Send + Sync + UnwindSafe + RefUnwindSafe>;

/// An array that is owned or part of a file in memory. Reading it is as fast as reading a slice in both cases.
pub struct Array<T> {
    /// The address of the elements, which does not change while `owner` lives.
    pointer: *const T,
    len: usize,
    owner: Owner<T>,
}

enum Owner<T> {
    Vec(Vec<T>),
    File(FileBytes),
}

// SAFETY: the array owns its elements like a `Vec`, or shares them like an `Arc` of bytes that nobody writes.
#[allow(unsafe_code, reason = "a pointer into what it owns")]
unsafe impl<T: Send + Sync> Send for Array<T> {}
// SAFETY: a reference to the array gives only references to its elements, which nobody writes.
#[allow(unsafe_code, reason = "a pointer into what it owns")]
unsafe impl<T: Send + Sync> Sync for Array<T> {}

impl<T> Array<T> {
    /// Changes the elements. If they are part of a file, they are copied first.
    pub fn edit<R>(&mut self, change: impl FnOnce(&mut Vec<T>) -> R) -> R
    where
        T: Clone,
    {
        // The array is empty during the change, and remains so if the change panics.
        let array = std::mem::take(self);
        let mut elements = match array.owner {
            Owner::Vec(elements) => elements,
            Owner::File(_) => array.to_vec(),
        };
        let result = change(&mut elements);
        *self = elements.into();
        result
    }

    /// Returns the heap memory in bytes, without the file's.
    pub fn memory(&self) -> usize {
        match &self.owner {
            Owner::Vec(elements) => elements.capacity() * size_of::<T>(),
            Owner::File(_) => 0,
        }
    }
}

impl<T: AnyBitPattern> Array<T> {
    /// Returns the elements in a byte range of a file. It is `None` if the range exceeds the file, is not aligned, or
    /// ends within an element.
    pub(super) fn from_file(file: &FileBytes, range: std::ops::Range<usize>) -> Option<Self> {
        let elements: &[T] = bytemuck::try_cast_slice((**file).as_ref().get(range)?).ok()?;
        let (pointer, len) = (elements.as_ptr(), elements.len());
        Some(Self { pointer, len, owner: Owner::File(Arc::clone(file)) })
    }
}

impl<T> From<Vec<T>> for Array<T> {
    fn from(elements: Vec<T>) -> Self {
        Self { pointer: elements.as_ptr(), len: elements.len(), owner: Owner::Vec(elements) }
    }
}

impl<T> Default for Array<T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<T: Clone> Clone for Array<T> {
    fn clone(&self) -> Self {
        match &self.owner {
            Owner::Vec(elements) => elements.clone().into(),
            Owner::File(file) => Self { pointer: self.pointer, len: self.len, owner: Owner::File(Arc::clone(file)) },
        }
    }
}

impl<T> Deref for Array<T> {
    type Target = [T];

    #[inline(always)]
    #[allow(unsafe_code, reason = "a pointer into what it owns")]
    fn deref(&self) -> &[T] {
        // SAFETY: `pointer` and `len` describe a slice of `owner`. The owner is either a `Vec` that nobody changes
        // (`edit` takes it out of the array first), or the bytes of a file, which were checked to be elements and whose
        // address does not change while `owner` lives. Moving the array moves neither.
        unsafe { std::slice::from_raw_parts(self.pointer, self.len) }
    }
}

impl<T: fmt::Debug> fmt::Debug for Array<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_is_a_slice_wherever_it_is() {
        let mut array: Array<u32> = vec![1, 2, 3].into();
        assert_eq!(*array, [1, 2, 3]);
        array.edit(|all| all.extend([4; 1000]));
        assert_eq!((array.len(), array[1002]), (1003, 4));
        let moved = Box::new(array);
        assert_eq!(moved.iter().sum::<u32>(), 4006);

        let words: Vec<u64> = (0..8).collect();
        let bytes: Vec<u8> = words.iter().flat_map(|x| x.to_le_bytes()).collect();
        let file: FileBytes = Arc::new(Aligned(words));
        let all = Array::<u64>::from_file(&file, 0..64).expect("aligned");
        let some = Array::<u16>::from_file(&file, 8..24).expect("aligned");
        assert!(Array::<u64>::from_file(&file, 4..12).is_none(), "not aligned");
        assert!(Array::<u64>::from_file(&file, 8..20).is_none(), "one and a half");
        assert!(Array::<u64>::from_file(&file, 8..72).is_none(), "beyond the end");
        drop(file);
        assert_eq!(*all, [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(bytemuck::cast_slice::<u16, u8>(&some), &bytes[8..24]);
        let mut copy = all.clone();
        drop(all);
        copy.edit(|all| all[0] = 9);
        assert_eq!((copy[0], copy[7], some[0], copy.memory()), (9, 7, 1, 64));
    }

    struct Aligned(Vec<u64>);

    impl AsRef<[u8]> for Aligned {
        fn as_ref(&self) -> &[u8] {
            bytemuck::cast_slice(&self.0)
        }
    }
}
