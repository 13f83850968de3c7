//! The compiler, the target and the settings with which this crate was compiled.

/// The version of the compiler, as `rustc -V` prints it.
pub const RUSTC: &str = env!("P2M_TESTKIT_RUSTC");
/// The target triple of the compilation.
pub const TARGET: &str = env!("P2M_TESTKIT_TARGET");
/// The optimisation level of this crate, which is 3 in the profile `test` of the workspace.
pub const OPT_LEVEL: &str = env!("P2M_TESTKIT_OPT_LEVEL");
/// The flags of `RUSTFLAGS` and of cargo's configuration.
pub const FLAGS: &str = env!("P2M_TESTKIT_RUSTFLAGS");
