//! Ctrl-C and its like: unfinished files are removed, and the exit code is 128 plus the number of the signal.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Files that do not have their final name yet.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// The list of unfinished files. It is held while one is made or renamed, so that a signal finds it either on the list
/// or not there at all.
pub(crate) fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps a file on the list of unfinished files until it is dropped.
pub(crate) struct Listed(PathBuf);

impl Listed {
    /// Adds `file` to the list `unfinished`.
    pub(crate) fn new(unfinished: &mut Vec<PathBuf>, file: &Path) -> Self {
        unfinished.push(file.to_path_buf());
        Self(file.to_path_buf())
    }
}

impl Drop for Listed {
    fn drop(&mut self) {
        unfinished().retain(|file| *file != self.0);
    }
}

/// Listens for SIGINT, SIGTERM, SIGHUP and SIGQUIT, which then remove unfinished files and end the process, with 128 plus
/// the number of the signal as its exit code.
///
/// A signal that the process was started to ignore stays ignored. On systems without these signals nothing happens.
///
/// # Errors
/// Fails if the system refuses a handler or a thread.
pub fn listen() -> std::io::Result<()> {
    #[cfg(unix)]
    wait_for_signals()?;
    Ok(())
}

/// Starts a thread that handles the first signal among those that are not ignored (see [`is_ignored`]).
#[cfg(unix)]
fn wait_for_signals() -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    use std::io::{IsTerminal, Write};
    let signals: Vec<i32> = [SIGINT, SIGTERM, SIGHUP, SIGQUIT].into_iter().filter(|&s| !is_ignored(s)).collect();
    let mut signals = signal_hook::iterator::Signals::new(signals)?;
    std::thread::Builder::new().spawn(move || {
        if let Some(signal) = signals.forever().next() {
            // Kept until the end: nobody starts or finishes a file any more.
            let files = unfinished();
            for file in files.iter() {
                // It may be finished by now; and if it cannot be removed, there is nothing left to try.
                let _ = std::fs::remove_file(file);
            }
            // The prompt of the shell goes below the bar, if there is one. If nobody reads it, nobody minds.
            if std::io::stderr().is_terminal() {
                let _ = writeln!(std::io::stderr());
            }
            std::process::exit(128 + signal);
        }
    })?;
    Ok(())
}

/// Whether this process was started with that signal ignored, in which case it has to stay so: SIGHUP under `nohup`,
/// SIGINT in the background of a script. Known on Linux only. Elsewhere SIGHUP counts as ignored: better a terminal
/// that closes ends the program the hard way than that `nohup` has no effect.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    match mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()) {
        Some(mask) => mask >> (signal - 1) & 1 == 1,
        None => signal == signal_hook::consts::SIGHUP,
    }
}
