//! Hands the compiler's version and flags to the program, which prints them above every table.

use std::env;
use std::process::Command;

fn main() {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = Command::new(rustc).arg("-V").output().map_or_else(
        |_| "rustc of unknown version".to_owned(),
        |output| String::from_utf8_lossy(&output.stdout).trim().to_owned(),
    );
    println!("cargo::rustc-env=P2M_HARNESS_RUSTC={version}");
    println!("cargo::rustc-env=P2M_HARNESS_PROFILE={}", env::var("PROFILE").unwrap_or_default());
    println!("cargo::rustc-env=P2M_HARNESS_OPT_LEVEL={}", env::var("OPT_LEVEL").unwrap_or_default());
    // Cargo separates flags by the unit separator.
    let flags = env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default().replace('\x1f', " ");
    println!("cargo::rustc-env=P2M_HARNESS_RUSTFLAGS={flags}");
    println!("cargo::rerun-if-env-changed=CARGO_ENCODED_RUSTFLAGS");
    println!("cargo::rerun-if-changed=build.rs");
}
