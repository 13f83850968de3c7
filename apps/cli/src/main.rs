//! The program `p2m`.

#![forbid(unsafe_code)]

use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    if let Err(error) = p2m_cli::listen() {
        // An error of writing the message cannot be reported anywhere.
        let _ = writeln!(std::io::stderr(), "error: cannot listen for Ctrl-C: {error}");
        return ExitCode::FAILURE;
    }
    ExitCode::from(p2m_cli::run(&p2m_cli::Streams::standard(), std::env::args_os()))
}
