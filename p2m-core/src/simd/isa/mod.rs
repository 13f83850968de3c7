//! Instruction sets: detection, and execution of kernels.
//!
//! The `unsafe` code of this folder calls functions that are compiled for an instruction set, after a check that the
//! processor has it.
#![allow(unsafe_code, reason = "vector instructions are unsafe to call where they may not exist")]

#[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
mod aarch64;
#[cfg(target_arch = "x86_64")]
mod x86_64;

use super::lanes::SimdKernel;
use super::portable::run_portable;

/// Prefetches the cache line at an address. It has no other effect, and the address may be invalid.
#[inline(always)]
pub fn prefetch(at: *const u8) {
    #[cfg(target_arch = "x86_64")]
    x86_64::prefetch(at);
    #[cfg(not(target_arch = "x86_64"))]
    let _ = at;
}

/// Prefetches all cache lines of `bytes` bytes that begin at an address. It has no other effect, and the address may be
/// invalid.
#[inline(always)]
pub fn prefetch_lines<T>(at: *const T, bytes: usize) {
    for line in 0..bytes.div_ceil(64) {
        prefetch(at.cast::<u8>().wrapping_add(64 * line));
    }
}

/// An instruction set of this processor. Answers do not depend on it.
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
    #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
    Neon,
}

impl Isa {
    /// The instructions that every processor of the architecture has.
    pub const PORTABLE: Self = Self(Kind::Portable);

    /// Returns all instruction sets of this processor, the fastest one last.
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
        #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
        all.push(Self(Kind::Neon));
        all
    }

    /// Returns the fastest instruction set of this processor.
    #[must_use]
    pub fn best() -> Self {
        Self::available().last().copied().unwrap_or(Self::PORTABLE)
    }

    /// Returns the name: `portable`, `avx2`, `avx512` or `neon`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.0 {
            Kind::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2 => "avx2",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => "avx512",
            #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
            Kind::Neon => "neon",
        }
    }

    /// Returns whether the kernel is faster in lanes of eight f64 than for one primitive at a time. It is not if a
    /// register has only two f64: the extra instructions for unneeded lanes then outweigh the savings.
    #[doc(hidden)]
    #[must_use]
    pub fn has_fast_doubles(self) -> bool {
        matches!(self.name(), "avx2" | "avx512")
    }

    /// Runs a kernel in lanes of eight f64 if they [are fast](Self::has_fast_doubles), and `otherwise` if they are not.
    /// So the kernel is not compiled for the other instruction sets.
    #[inline(always)]
    pub fn run_in_doubles<K: SimdKernel>(self, kernel: K, otherwise: impl FnOnce() -> K::Output) -> K::Output {
        match self.0 {
            // SAFETY: only `available` creates such a value, after a check of the processor.
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2 => unsafe { x86_64::run_avx2(kernel) },
            // SAFETY: only `available` creates such a value, after a check of the processor.
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => unsafe { x86_64::run_avx512(kernel) },
            _ => {
                let _ = kernel;
                otherwise()
            }
        }
    }

    /// Runs a kernel with this instruction set.
    #[inline(always)]
    pub fn run<K: SimdKernel>(self, kernel: K) -> K::Output {
        match self.0 {
            Kind::Portable => run_portable(kernel),
            // SAFETY: only `available` creates such a value, after a check of the processor.
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2 => unsafe { x86_64::run_avx2(kernel) },
            // SAFETY: only `available` creates such a value, after a check of the processor.
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => unsafe { x86_64::run_avx512(kernel) },
            #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
            Kind::Neon => aarch64::run_neon(kernel),
        }
    }
}

impl Default for Isa {
    /// Returns the fastest instruction set of this processor.
    fn default() -> Self {
        Self::best()
    }
}

impl std::fmt::Display for Isa {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
