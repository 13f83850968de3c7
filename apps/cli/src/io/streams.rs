//! The standard streams of a run.

use crate::io::limits::Limits;
use std::cell::{Cell, RefCell};
use std::fmt;
use std::io::{self, IsTerminal, Read, Write};

/// The standard input, output and error of a run.
pub struct Streams {
    stdin: RefCell<Box<dyn Read>>,
    stdout: RefCell<Box<dyn Write>>,
    stderr: RefCell<Box<dyn Write>>,
    /// Whether these are the streams of the process, which may be terminals.
    is_process: bool,
    /// Whether summaries and progress are left out.
    is_quiet: Cell<bool>,
    limits: Cell<Limits>,
}

impl Streams {
    /// Takes the streams of this process, which show colours and progress bars where they are terminals.
    #[must_use]
    pub fn standard() -> Self {
        Self { is_process: true, ..Self::new(io::stdin(), io::stdout(), io::stderr()) }
    }

    /// Makes streams of a reader and two writers, which all count as no terminals.
    pub fn new(stdin: impl Read + 'static, stdout: impl Write + 'static, stderr: impl Write + 'static) -> Self {
        Self {
            stdin: RefCell::new(Box::new(stdin)),
            stdout: RefCell::new(Box::new(stdout)),
            stderr: RefCell::new(Box::new(stderr)),
            is_process: false,
            is_quiet: Cell::new(false),
            limits: Cell::default(),
        }
    }

    pub(crate) fn stdin(&self) -> Stream<'_, dyn Read> {
        Stream(&self.stdin)
    }

    pub(crate) fn stdout(&self) -> Stream<'_, dyn Write> {
        Stream(&self.stdout)
    }

    pub(crate) fn stderr(&self) -> Stream<'_, dyn Write> {
        Stream(&self.stderr)
    }

    /// Sets whether summaries and progress are left out.
    pub(crate) fn set_quiet(&self, is_quiet: bool) {
        self.is_quiet.set(is_quiet);
    }

    /// Sets the limits of what is read.
    pub(crate) fn set_limits(&self, limits: Limits) {
        self.limits.set(limits);
    }

    /// Returns the limits of what is read.
    pub(crate) fn limits(&self) -> Limits {
        self.limits.get()
    }

    /// Writes a summary to the standard error. Results are complete by then, so an error of writing it is ignored.
    pub(crate) fn print_summary(&self, text: fmt::Arguments<'_>) {
        if !self.is_quiet.get() {
            // The text is written at once, so that an interruption does not cut it.
            let _ = self.stderr().write_all(fmt::format(text).as_bytes());
        }
    }

    /// Returns whether progress is shown.
    pub(crate) fn shows_progress(&self) -> bool {
        !self.is_quiet.get() && self.is_process && io::stderr().is_terminal()
    }

    pub(crate) fn is_stdout_terminal(&self) -> bool {
        self.is_process && io::stdout().is_terminal()
    }

    /// Gives help a fixed width, unless it is for the process, whose terminal sets the width.
    pub(crate) fn fit(&self, command: clap::Command) -> clap::Command {
        if self.is_process { command } else { command.term_width(HELP_COLUMNS) }
    }

    /// Writes an error of a run, with colours on a terminal. Characters that control the terminal are escaped.
    pub(crate) fn show_error(&self, message: &str) {
        let is_shown = |c: char| c == '\n' || !c.is_control();
        let text: String =
            message.chars().map(|c| if is_shown(c) { c.to_string() } else { c.escape_default().to_string() }).collect();
        // An error of writing the message cannot be reported anywhere.
        let error = clap::Error::raw(clap::error::ErrorKind::Io, text + "\n").with_cmd(&clap::Command::new("p2m"));
        let _ = self.show(&error);
    }

    /// Writes wrong usage to the standard error, and help and the version to the standard output.
    pub(crate) fn show(&self, error: &clap::Error) -> io::Result<()> {
        if self.is_process {
            // Clap colours the text as the terminal and the environment ask for.
            error.print()
        } else if error.use_stderr() {
            write!(self.stderr(), "{error}")
        } else {
            write!(self.stdout(), "{error}").and_then(|()| self.stdout().flush())
        }
    }
}

/// The number of columns of help without a terminal.
const HELP_COLUMNS: usize = 100;

/// A borrowed stream of a run.
pub(crate) struct Stream<'a, S: ?Sized>(&'a RefCell<Box<S>>);

impl Read for Stream<'_, dyn Read> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.0.borrow_mut().read(buffer)
    }
}

impl Write for Stream<'_, dyn Write> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.borrow_mut().flush()
    }
}
