//! Passes the compiler's version, the target, the flags and the optimisation level to tests whose figures depend on
//! them.

use std::env;
use std::process::Command;

fn main() {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = Command::new(rustc).arg("-V").output().map_or_else(
        |_| "rustc of unknown version".to_owned(),
        |output| String::from_utf8_lossy(&output.stdout).trim().to_owned(),
    );
    println!("cargo::rustc-env=P2M_TESTKIT_RUSTC={version}");
    println!("cargo::rustc-env=P2M_TESTKIT_TARGET={}", env::var("TARGET").unwrap_or_default());
    println!("cargo::rustc-env=P2M_TESTKIT_OPT_LEVEL={}", env::var("OPT_LEVEL").unwrap_or_default());
    // Cargo separates flags by the unit separator.
    let flags = env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default().replace('\x1f', " ");
    println!("cargo::rustc-env=P2M_TESTKIT_RUSTFLAGS={flags}");
    println!("cargo::rerun-if-env-changed=CARGO_ENCODED_RUSTFLAGS");
    println!("cargo::rerun-if-changed=build.rs");
}
