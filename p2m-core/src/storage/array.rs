//! An array that is either owned or part of a file in memory.

use bytemuck::AnyBitPattern;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

/// The bytes of a file, which stay where they are.
pub type FileBytes = Arc<dyn AsRef<[u8]> + Send + Sync>;

/// A slice that is read as fast as that of a `Vec`, wherever its elements are.
pub struct Array<T> {
    /// Of the elements, which `owner` keeps where they are.
    pointer: *const T,
    len: usize,
    owner: Owner<T>,
}

enum Owner<T> {
    Vec(Vec<T>),
    File(FileBytes),
}

// SAFETY: it owns its elements like a `Vec`, or shares them like an `Arc` of bytes that nobody writes.
#[allow(unsafe_code, reason = "a pointer into what it owns")]
unsafe impl<T: Send + Sync> Send for Array<T> {}
// SAFETY: the same; through a reference there are only references to elements.
#[allow(unsafe_code, reason = "a pointer into what it owns")]
unsafe impl<T: Send + Sync> Sync for Array<T> {}

impl<T> Array<T> {
    /// Changes the elements.
    pub fn edit<R>(&mut self, change: impl FnOnce(&mut Vec<T>) -> R) -> R
    where
        T: Clone,
    {
        // Empty meanwhile, and if the change panics.
        let own = std::mem::take(self);
        let mut all = match own.owner {
            Owner::Vec(all) => all,
            Owner::File(_) => own.to_vec(),
        };
        let result = change(&mut all);
        *self = all.into();
        result
    }

    /// Heap memory, in bytes; that of a file is not counted.
    pub fn memory(&self) -> usize {
        match &self.owner {
            Owner::Vec(all) => all.capacity() * size_of::<T>(),
            Owner::File(_) => 0,
        }
    }
}

impl<T: AnyBitPattern> Array<T> {
    /// The elements in a part of a file; `None` if it is no whole number of them, or not where they may be.
    pub(super) fn of_file(file: &FileBytes, part: std::ops::Range<usize>) -> Option<Self> {
        let elements: &[T] = bytemuck::try_cast_slice((**file).as_ref().get(part)?).ok()?;
        let (pointer, len) = (elements.as_ptr(), elements.len());
        Some(Self { pointer, len, owner: Owner::File(Arc::clone(file)) })
    }
}

impl<T> From<Vec<T>> for Array<T> {
    fn from(all: Vec<T>) -> Self {
        Self { pointer: all.as_ptr(), len: all.len(), owner: Owner::Vec(all) }
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
            Owner::Vec(all) => all.clone().into(),
            Owner::File(file) => Self { pointer: self.pointer, len: self.len, owner: Owner::File(Arc::clone(file)) },
        }
    }
}

impl<T> Deref for Array<T> {
    type Target = [T];

    #[inline(always)]
    #[allow(unsafe_code, reason = "a pointer into what it owns")]
    fn deref(&self) -> &[T] {
        // SAFETY: `pointer` and `len` are those of a slice of `owner`: of a `Vec` that nobody changes (`edit` takes it
        // out of the array), or of the bytes of a file, which were checked to be elements and stay where they
        // are as long as `owner` does. Moving the array moves neither.
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
        let mut own: Array<u32> = vec![1, 2, 3].into();
        assert_eq!(*own, [1, 2, 3]);
        own.edit(|all| all.extend([4; 1000]));
        assert_eq!((own.len(), own[1002]), (1003, 4));
        let moved = Box::new(own);
        assert_eq!(moved.iter().sum::<u32>(), 4006);

        let words: Vec<u64> = (0..8).collect();
        let bytes: Vec<u8> = words.iter().flat_map(|x| x.to_le_bytes()).collect();
        let file: FileBytes = Arc::new(Aligned(words));
        let all = Array::<u64>::of_file(&file, 0..64).expect("aligned");
        let some = Array::<u16>::of_file(&file, 8..24).expect("aligned");
        assert!(Array::<u64>::of_file(&file, 4..12).is_none(), "not aligned");
        assert!(Array::<u64>::of_file(&file, 8..20).is_none(), "one and a half");
        assert!(Array::<u64>::of_file(&file, 8..72).is_none(), "beyond the end");
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
