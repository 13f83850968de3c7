//! A card for tests: the kernels as a library for the host, compiled by a C++ compiler.

use crate::CudaError;
use crate::card::{Card, Parameters};
use crate::raw::Address;
use libloading::Library;
use std::process::Command;
use std::sync::OnceLock;

/// The kernels on the host.
pub(crate) struct HostCard(&'static Library);

impl HostCard {
    /// Compiles the kernels, once. Returns `None` with a message if there is no C++ compiler.
    pub(crate) fn open() -> Option<Self> {
        static LIBRARY: OnceLock<Option<Library>> = OnceLock::new();
        LIBRARY.get_or_init(compiled).as_ref().map(Self)
    }

    /// Returns a function of the library.
    pub(crate) fn function<F>(&self, name: &str) -> libloading::Symbol<'static, F> {
        // SAFETY: the callers name the types that kernels.cu declares.
        unsafe { self.0.get(name.as_bytes()) }.expect("a function of kernels.cu")
    }
}

fn compiled() -> Option<Library> {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/kernels/kernels.cu");
    let folder = tempfile::tempdir().expect("a folder for the library");
    let library = folder.path().join("kernels.so");
    let compiler = std::env::var("CXX").unwrap_or_else(|_| "c++".to_owned());
    // As on the card, no operations may be fused.
    let options = "-x c++ -std=c++17 -O2 -ffp-contract=off -pthread -shared -fPIC -Wall -Wextra -Werror";
    match Command::new(&compiler).args(options.split(' ')).arg("-o").arg(&library).arg(source).status() {
        // SAFETY: the library has functions alone, which nothing calls when it is loaded.
        Ok(status) if status.success() => Some(unsafe { Library::new(&library) }.expect("the library")),
        Ok(_) => panic!("{compiler} does not compile the kernels"),
        Err(error) => {
            p2m_testkit::skip(&format!("{compiler} cannot be run ({error})"));
            None
        }
    }
}

impl Card for HostCard {
    /// Memory with the alignment of the widest loads.
    type Memory = Vec<u128>;

    fn lane(&self) -> Result<Self, CudaError> {
        Ok(Self(self.0))
    }
    fn allocate(&self, bytes: usize) -> Result<Vec<u128>, CudaError> {
        // Uninitialized memory is conspicuous.
        Ok(vec![u128::MAX; bytes.div_ceil(16)])
    }
    fn address(&self, memory: &Vec<u128>) -> Address {
        memory.as_ptr() as Address
    }
    fn write(&self, memory: &mut Vec<u128>, bytes: &[u8]) -> Result<(), CudaError> {
        bytemuck::cast_slice_mut::<u128, u8>(memory)[..bytes.len()].copy_from_slice(bytes);
        Ok(())
    }
    fn clear(&self, memory: &mut Vec<u128>) -> Result<(), CudaError> {
        memory.fill(0);
        Ok(())
    }
    fn read(&self, memory: &Vec<u128>, bytes: &mut [u8]) -> Result<(), CudaError> {
        bytes.copy_from_slice(&bytemuck::cast_slice::<u128, u8>(memory)[..bytes.len()]);
        Ok(())
    }
    fn wait(&self) -> Result<(), CudaError> {
        Ok(())
    }
    fn copy(&self, memory: &Vec<u128>, bytes: usize) -> Result<Vec<u128>, CudaError> {
        Ok(memory[..bytes.div_ceil(16)].to_vec())
    }
    fn keep(&self, _: i64) -> Result<(), CudaError> {
        Ok(())
    }
    fn free_memory(&self) -> Result<usize, CudaError> {
        Ok(usize::MAX)
    }
    fn launch<P: Parameters>(&self, kernel: &str, threads: usize, parameters: &P) -> Result<(), CudaError> {
        let function = self.function::<extern "C" fn(u32, *const P)>(kernel);
        function(u32::try_from(threads).expect("fewer than 2^32 threads"), parameters);
        Ok(())
    }
}
