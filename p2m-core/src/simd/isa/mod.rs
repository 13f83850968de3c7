//! Instruction sets: which there are, which the processor has, how to enter them.
//!
//! The only folder of this crate with `unsafe`.
#![allow(unsafe_code, reason = "vector instructions are unsafe to call where they may not exist")]

#[cfg(target_arch = "x86_64")]
mod x86_64;

use super::{Portable, SimdKernel};

/// Asks for the cache line at an address before it is read; does nothing but that.
#[inline(always)]
pub fn prefetch(at: *const u8) {
    #[cfg(target_arch = "x86_64")]
    x86_64::prefetch(at);
    #[cfg(not(target_arch = "x86_64"))]
    let _ = at;
}

/// The same for all lines of some bytes from an address on.
#[inline(always)]
pub fn prefetch_lines<T>(at: *const T, bytes: usize) {
    for line in 0..bytes.div_ceil(64) {
        prefetch(at.cast::<u8>().wrapping_add(64 * line));
    }
}

/// An instruction set that this processor has.
///
/// ```
/// use p2m_core::Isa;
///
/// assert!(Isa::available().contains(&Isa::PORTABLE));
/// assert!(Isa::available().contains(&Isa::best()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Isa(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Kind {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Isa {
    /// None in particular: what every processor of the architecture has.
    pub const PORTABLE: Self = Self(Kind::Portable);

    /// All that this processor has, the fastest one last.
    #[must_use]
    pub fn available() -> Vec<Self> {
        #[allow(unused_mut, reason = "on architectures without more")]
        let mut all = vec![Self::PORTABLE];
        #[cfg(target_arch = "x86_64")]
        {
            if x86_64::has_avx2() {
                all.push(Self(Kind::Avx2));
            }
            if x86_64::has_avx512() {
                all.push(Self(Kind::Avx512));
            }
        }
        all
    }

    /// The fastest one.
    #[must_use]
    pub fn best() -> Self {
        Self::available().last().copied().unwrap_or(Self::PORTABLE)
    }

    /// `portable`, `avx2` or `avx512`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.0 {
            Kind::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2 => "avx2",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => "avx512",
        }
    }

    /// Computes with it.
    #[inline(always)]
    pub fn run<O: SimdKernel>(self, operation: O) -> O::Output {
        match self.0 {
            Kind::Portable => run_portable(operation),
            // SAFETY: there is no way to such a value but `available`, which has asked the processor.
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2 => unsafe { x86_64::run_avx2(operation) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => unsafe { x86_64::run_avx512(operation) },
        }
    }
}

/// In a function of its own as the others are: it is compiled once for each operation, not wherever one is run.
#[inline(never)]
fn run_portable<O: SimdKernel>(operation: O) -> O::Output {
    operation.run::<Portable>()
}

impl Default for Isa {
    /// The fastest one.
    fn default() -> Self {
        Self::best()
    }
}

impl std::fmt::Display for Isa {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
