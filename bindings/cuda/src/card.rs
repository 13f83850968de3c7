//! A card: its memory, and the kernels that run on it.
//!
//! [`Card`] is the interface that the rest of the crate uses. [`CudaCard`] implements it for a real card, and tests
//! implement it by the same kernels on the host.

use crate::CudaError;
use crate::raw::{Address, Batch, Building};
use cudarc::driver::sys::{CUcontext, CUmemPool_attribute};
use cudarc::driver::{CudaContext, CudaFunction, CudaModule, CudaSlice, CudaStream, DevicePtr, DeviceRepr};
use cudarc::driver::{LaunchConfig, PinnedHostSlice, PushKernelArg, result};
use cudarc::nvrtc::Ptx;
use std::sync::{Arc, Mutex, PoisonError};

/// The parameters of a kernel.
pub(crate) trait Parameters: Copy + 'static {}
impl Parameters for Building {}
impl Parameters for Batch {}

/// A device on which kernels run.
pub(crate) trait Card: Sized + Sync {
    /// A block of its memory.
    type Memory: Sync;

    /// Returns another queue of copies and kernels on the same card, which runs concurrently with this one.
    fn lane(&self) -> Result<Self, CudaError>;

    fn allocate(&self, bytes: usize) -> Result<Self::Memory, CudaError>;
    fn address(&self, memory: &Self::Memory) -> Address;
    /// Copies bytes to the front of a block.
    fn write(&self, memory: &mut Self::Memory, bytes: &[u8]) -> Result<(), CudaError>;
    fn clear(&self, memory: &mut Self::Memory) -> Result<(), CudaError>;
    /// Copies bytes from the front of a block, after all earlier kernels have ended.
    fn read(&self, memory: &Self::Memory, bytes: &mut [u8]) -> Result<(), CudaError>;
    /// Copies bytes from the front of a block into a new block of that size.
    fn copy(&self, memory: &Self::Memory, bytes: usize) -> Result<Self::Memory, CudaError>;
    /// Waits until all kernels have ended.
    fn wait(&self) -> Result<(), CudaError>;
    /// Changes the number of bytes that the driver keeps instead of returning free memory to the system. Memory in use
    /// counts.
    fn keep(&self, bytes: i64) -> Result<(), CudaError>;
    /// Returns the number of free bytes.
    fn free_memory(&self) -> Result<usize, CudaError>;
    /// Starts a kernel with one thread for each number below `threads`.
    fn launch<P: Parameters>(&self, kernel: &str, threads: usize, parameters: &P) -> Result<(), CudaError>;

    /// Allocates a block and copies these bytes into it.
    fn upload(&self, bytes: &[u8]) -> Result<Self::Memory, CudaError> {
        let mut memory = self.allocate(bytes.len().max(1))?;
        self.write(&mut memory, bytes)?;
        Ok(memory)
    }
}

/// The compiled kernels, see `cargo xtask cuda`.
const PTX: &str = include_str!("../kernels/kernels.ptx");
const THREADS_PER_BLOCK: u32 = 128;

/// The size of the pinned buffer of a lane, which is also the smallest copy that goes through it. Copies from and to
/// pageable memory are several times slower.
const STAGING_BYTES: usize = 1 << 22;

/// The free memory that the driver keeps between batches. Three lanes with all columns in f64 take 380 MB.
const KEPT_BYTES: u64 = 1 << 29;

/// The context that was current on this thread. It becomes current again when this value is dropped.
pub(crate) struct CallersContext(Option<CUcontext>);

impl CallersContext {
    /// Saves the current context. The driver has to be present.
    pub(crate) fn new() -> Self {
        // Before the driver is initialized there is no context.
        Self(result::ctx::get_current().ok().flatten())
    }
}

impl Drop for CallersContext {
    fn drop(&mut self) {
        // SAFETY: it was current before, or it is null, which stands for none.
        let _ = unsafe { result::ctx::set_current(self.0.unwrap_or(std::ptr::null_mut())) };
    }
}

/// A queue of a card of NVIDIA.
pub(crate) struct CudaCard {
    stream: Arc<CudaStream>,
    module: Arc<CudaModule>,
    staging: Mutex<Option<PinnedHostSlice<u8>>>,
}

impl CudaCard {
    /// Opens the card with this number. The driver has to be present.
    pub(crate) fn open(ordinal: usize) -> Result<Self, CudaError> {
        let context = CudaContext::new(ordinal)?;
        let module = context.load_module(Ptx::from_src(PTX))?;
        let stream = context.new_stream()?;
        Ok(Self { stream, module, staging: Mutex::default() })
    }

    /// Waits until all work on a stream of the caller has ended.
    ///
    /// # Safety
    /// It has to be a stream of the context of this card.
    pub(crate) unsafe fn wait_for(&self, stream: Address) -> Result<(), CudaError> {
        self.stream.context().bind_to_thread()?;
        // SAFETY: the caller says so. Machines with cards have addresses of 64 bits.
        Ok(unsafe { result::stream::synchronize(usize::try_from(stream).unwrap_or_default() as _) }?)
    }

    /// Copies `len` bytes in pieces that fit into the pinned buffer, and calls `copy` for each of them. `copy` has to
    /// wait until its piece is copied.
    fn in_pieces(
        &self,
        len: usize,
        mut copy: impl FnMut(&mut [u8], std::ops::Range<usize>) -> Result<(), CudaError>,
    ) -> Result<(), CudaError> {
        let mut staging = self.staging.lock().unwrap_or_else(PoisonError::into_inner);
        if staging.is_none() {
            // SAFETY: what is read was written before.
            let buffer = unsafe { self.stream.context().alloc_pinned_with_flags(STAGING_BYTES, 0) };
            *staging = Some(buffer?);
        }
        let buffer = staging.as_mut().expect("it was made").as_mut_slice()?;
        for start in (0..len).step_by(STAGING_BYTES) {
            let range = start..len.min(start + STAGING_BYTES);
            copy(&mut buffer[..range.len()], range)?;
        }
        Ok(())
    }
}

/// Returns whether the driver can be loaded.
pub(crate) fn is_driver_present() -> bool {
    // SAFETY: this loads the library of the driver, as every later call does.
    unsafe { cudarc::driver::sys::is_culib_present() }
}

/// A structure as the argument of a kernel.
#[repr(transparent)]
#[derive(Clone, Copy)]
struct Argument<P>(P);

// SAFETY: parameters are plain numbers in the layout of C, as the kernels declare them.
unsafe impl<P: Parameters> DeviceRepr for Argument<P> {}

impl Card for CudaCard {
    type Memory = CudaSlice<u8>;

    fn lane(&self) -> Result<Self, CudaError> {
        let stream = self.stream.context().new_stream()?;
        Ok(Self { stream, module: Arc::clone(&self.module), staging: Mutex::default() })
    }

    fn allocate(&self, bytes: usize) -> Result<CudaSlice<u8>, CudaError> {
        // SAFETY: kernels write all that is read, or it is cleared before.
        Ok(unsafe { self.stream.alloc(bytes) }?)
    }

    fn address(&self, memory: &CudaSlice<u8>) -> Address {
        memory.device_ptr(&self.stream).0
    }

    fn write(&self, memory: &mut CudaSlice<u8>, bytes: &[u8]) -> Result<(), CudaError> {
        if bytes.len() < STAGING_BYTES {
            self.stream.memcpy_htod(bytes, memory)?;
            return Ok(self.stream.synchronize()?);
        }
        self.in_pieces(bytes.len(), |buffer, range| {
            buffer.copy_from_slice(&bytes[range.clone()]);
            self.stream.memcpy_htod(&*buffer, &mut memory.slice_mut(range))?;
            Ok(self.stream.synchronize()?)
        })
    }

    fn clear(&self, memory: &mut CudaSlice<u8>) -> Result<(), CudaError> {
        Ok(self.stream.memset_zeros(memory)?)
    }

    fn read(&self, memory: &CudaSlice<u8>, bytes: &mut [u8]) -> Result<(), CudaError> {
        if bytes.len() < STAGING_BYTES {
            self.stream.memcpy_dtoh(&memory.slice(..bytes.len()), bytes)?;
            return Ok(self.stream.synchronize()?);
        }
        self.in_pieces(bytes.len(), |buffer, range| {
            self.stream.memcpy_dtoh(&memory.slice(range.clone()), buffer)?;
            self.stream.synchronize()?;
            bytes[range].copy_from_slice(buffer);
            Ok(())
        })
    }

    fn wait(&self) -> Result<(), CudaError> {
        Ok(self.stream.synchronize()?)
    }

    fn copy(&self, memory: &CudaSlice<u8>, bytes: usize) -> Result<CudaSlice<u8>, CudaError> {
        let mut copy = self.allocate(bytes.max(1))?;
        if bytes > 0 {
            self.stream.memcpy_dtod(&memory.slice(..bytes), &mut copy)?;
        }
        Ok(copy)
    }

    fn keep(&self, bytes: i64) -> Result<(), CudaError> {
        let context = self.stream.context();
        if context.has_async_alloc() {
            let attribute = CUmemPool_attribute::CU_MEMPOOL_ATTR_RELEASE_THRESHOLD;
            let mut kept = 0u64;
            // SAFETY: the attribute is a number of 64 bits.
            unsafe {
                let pool = result::device::get_default_mem_pool(context.cu_device())?;
                result::mem_pool::get_attribute(pool, attribute, (&raw mut kept).cast())?;
                // Other libraries of the process may have asked for more in the same pool.
                kept = kept.max(KEPT_BYTES).saturating_add_signed(bytes);
                result::mem_pool::set_attribute(pool, attribute, (&raw mut kept).cast())?;
            }
        }
        Ok(())
    }

    fn free_memory(&self) -> Result<usize, CudaError> {
        Ok(self.stream.context().mem_get_info()?.0)
    }

    fn launch<P: Parameters>(&self, kernel: &str, threads: usize, parameters: &P) -> Result<(), CudaError> {
        if threads == 0 {
            return Ok(());
        }
        let function: CudaFunction = self.module.load_function(kernel)?;
        let threads = u32::try_from(threads).map_err(|_| CudaError::TooMany { count: threads })?;
        let config = LaunchConfig {
            grid_dim: (threads.div_ceil(THREADS_PER_BLOCK), 1, 1),
            block_dim: (THREADS_PER_BLOCK, 1, 1),
            shared_mem_bytes: 0,
        };
        let argument = Argument(*parameters);
        // SAFETY: a kernel takes the number of threads and one structure. Its addresses are those of blocks and of
        // columns of the caller that live until the next wait, which follows an error, too.
        unsafe { self.stream.launch_builder(&function).arg(&threads).arg(&argument).launch(config) }?;
        Ok(())
    }
}
