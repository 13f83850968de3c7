//! Signals such as Ctrl-C. They remove unfinished files and end the program with 128 plus their number as
//! its exit code, except that the first Ctrl-C during work that can end early only ends that work.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The files that are not finished yet, and the folders that are removed if they are empty without these.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// The state of work that can end early: [`UNSTOPPABLE`], [`STOPPABLE`] or [`STOPPED`].
static STOP: AtomicU8 = AtomicU8::new(UNSTOPPABLE);
/// There is no work that can end early.
const UNSTOPPABLE: u8 = 0;
/// The next Ctrl-C ends the work early.
const STOPPABLE: u8 = 1;
/// The work ends as soon as it can.
const STOPPED: u8 = 2;

/// Work that can end early with a result. While it exists, the first Ctrl-C asks it to end, and does not
/// end the program.
pub(crate) struct StoppableWork(());

impl StoppableWork {
    pub(crate) fn start() -> Self {
        STOP.store(STOPPABLE, Ordering::Relaxed);
        Self(())
    }

    /// Returns whether the work has to end.
    pub(crate) fn is_stopped() -> bool {
        STOP.load(Ordering::Relaxed) == STOPPED
    }
}

impl Drop for StoppableWork {
    fn drop(&mut self) {
        STOP.store(UNSTOPPABLE, Ordering::Relaxed);
    }
}

/// Asks work that can end early to end. Returns whether there is such work that was not asked before.
fn stop_work() -> bool {
    STOP.compare_exchange(STOPPABLE, STOPPED, Ordering::Relaxed, Ordering::Relaxed).is_ok()
}

/// Locks the list of unfinished files. The lock is held while a file is created or renamed, so that a signal finds
/// every unfinished file on the list.
pub(crate) fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps a file or a folder on the list of unfinished files until it is dropped.
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

/// Listens for SIGINT, SIGTERM, SIGHUP and SIGQUIT, which then remove unfinished files and end the process, with 128
/// plus the number of the signal as its exit code. A first SIGINT during work that can end early only ends that work.
///
/// A signal that the process was started to ignore stays ignored. On systems without these signals nothing happens.
///
/// # Errors
/// Fails if the system refuses a handler or a thread.
pub fn listen() -> std::io::Result<()> {
    #[cfg(unix)]
    {
        // Where memory ends, the standard library says so and aborts. That is an error like others, with the exit code 1.
        let always = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(true));
        signal_hook::flag::register_conditional_shutdown(signal_hook::consts::SIGABRT, 1, always)?;
        wait_for_signals()?;
    }
    Ok(())
}

/// Starts a thread that handles signals that are not ignored (see [`is_ignored`]).
#[cfg(unix)]
fn wait_for_signals() -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    use std::io::{IsTerminal, Write};
    let signals: Vec<i32> = [SIGINT, SIGTERM, SIGHUP, SIGQUIT].into_iter().filter(|&s| !is_ignored(s)).collect();
    let mut signals = signal_hook::iterator::Signals::new(signals)?;
    std::thread::Builder::new().spawn(move || {
        if let Some(signal) = signals.forever().find(|&signal| signal != SIGINT || !stop_work()) {
            // The lock is kept until the end, so that no file is created or finished any more.
            let files = unfinished();
            // A folder is listed before the files in it.
            for file in files.iter().rev() {
                // A file that is finished by now, or that cannot be removed, stays.
                let _ = std::fs::remove_file(file).or_else(|_| std::fs::remove_dir(file));
            }
            // The prompt of the shell appears below a progress bar.
            if std::io::stderr().is_terminal() {
                let _ = writeln!(std::io::stderr());
            }
            std::process::exit(128 + signal);
        }
    })?;
    Ok(())
}

/// Returns whether this process was started with the signal ignored, as SIGHUP is under `nohup` and SIGINT in the
/// background of a script. Such a signal has to stay ignored.
///
/// This is known on Linux only. Elsewhere SIGHUP counts as ignored, because `nohup` has to work; a terminal that closes
/// then ends the program without removing its files.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    match mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()) {
        Some(mask) => mask >> (signal - 1) & 1 == 1,
        None => signal == signal_hook::consts::SIGHUP,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_interruption_ends_work_and_the_second_one_the_program() {
        assert!(!stop_work() && !StoppableWork::is_stopped());
        let work = StoppableWork::start();
        assert!(!StoppableWork::is_stopped());
        assert!(stop_work() && StoppableWork::is_stopped());
        assert!(!stop_work());
        drop(work);
        assert!(!stop_work() && !StoppableWork::is_stopped());
    }
}
