//! Progress bars of long runs. They appear on the standard error after a second, if it is a terminal.

use crate::io::streams::Streams;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// A piece of work. Its progress bar disappears when it is dropped.
pub(crate) struct Progress {
    done: Arc<AtomicU64>,
    /// The state of the work in words, after the label.
    note: Arc<Mutex<String>>,
    /// The thread that draws, and the channel that stops it; `None` without a terminal.
    drawing: Option<(Sender<()>, JoinHandle<()>)>,
}

/// The unit of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unit {
    Bytes,
    /// Items with this name.
    Items(&'static str),
    /// Hundredths of the work.
    Percent,
    /// Work of an unknown amount.
    None,
}

/// The time before a bar appears.
const DELAY: Duration = Duration::from_secs(1);
/// The time between two states of a bar.
const REFRESH_INTERVAL: Duration = Duration::from_millis(100);

impl Progress {
    /// Starts a bar with the label `what`, such as `reading scene.ply`. `total` is the amount of work, if it is known.
    pub(crate) fn start(streams: &Streams, what: &str, total: Option<u64>, unit: Unit) -> Self {
        let done = Arc::new(AtomicU64::new(0));
        let note = Arc::new(Mutex::new(String::new()));
        // On a terminal that cannot move its cursor the bar hides itself.
        if !streams.shows_progress() {
            return Self { done, note, drawing: None };
        }
        let (stop, stopped) = mpsc::channel();
        let (position, shown, what) = (Arc::clone(&done), Arc::clone(&note), what.to_owned());
        let draw = move || {
            if stopped.recv_timeout(DELAY) != Err(RecvTimeoutError::Timeout) {
                return;
            }
            let bar = ProgressBar::with_draw_target(total, ProgressDrawTarget::stderr());
            if let Ok(style) = ProgressStyle::with_template(&template(total, unit)) {
                bar.set_style(style.tick_chars("-\\|/ ").with_key("left", write_time_left));
            }
            while stopped.recv_timeout(REFRESH_INTERVAL) == Err(RecvTimeoutError::Timeout) {
                bar.set_message(what.clone() + &shown.lock().unwrap_or_else(PoisonError::into_inner));
                bar.set_position(position.load(Ordering::Relaxed));
                bar.tick();
            }
            bar.finish_and_clear();
        };
        // Without a thread to draw there is no bar; the work goes on.
        let drawing = std::thread::Builder::new().spawn(draw).ok().map(|thread| (stop, thread));
        Self { done, note, drawing }
    }

    /// Sets the amount of work that is done. It never decreases.
    pub(crate) fn advance_to(&self, count: u64) {
        self.done.fetch_max(count, Ordering::Relaxed);
    }

    /// Sets a text after the label.
    pub(crate) fn set_note(&self, note: String) {
        *self.note.lock().unwrap_or_else(PoisonError::into_inner) = note;
    }

    /// Adds to the amount of work that is done.
    pub(crate) fn add(&self, count: u64) {
        self.done.fetch_add(count, Ordering::Relaxed);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.drawing.take() {
            drop(stop);
            // The work goes on if its bar fails.
            let _ = thread.join();
        }
    }
}

/// Writes the estimate of the time that is left. Before any work is done there is none.
fn write_time_left(state: &ProgressState, text: &mut dyn std::fmt::Write) {
    if state.pos() > 0 {
        // A bar without the estimate is complete as well.
        let _ = write!(text, ", {:#} left", HumanDuration(state.eta()));
    }
}

fn template(total: Option<u64>, unit: Unit) -> String {
    let count = match (unit, total) {
        (Unit::Bytes, Some(_)) => "{wide_bar} {bytes}/{total_bytes}{left}",
        (Unit::Bytes, None) => "{bytes}",
        (Unit::Items(name), _) => &format!("{{wide_bar}} {{human_pos}}/{{human_len}} {name}{{left}}"),
        // The parts of such work take very different times, so no time that is left is known.
        (Unit::Percent, _) => "{wide_bar} {pos} %, {elapsed}",
        (Unit::None, _) => "{elapsed}",
    };
    let spinner = if total.is_none() { "{spinner} " } else { "" };
    format!("{spinner}{{msg}} {count}")
}
