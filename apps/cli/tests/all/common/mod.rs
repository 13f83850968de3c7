//! Runs `p2m` within the process of the tests, and starts the program itself where a test is about a process.

use p2m_cli::Streams;
use std::cell::RefCell;
use std::fs;
use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::rc::Rc;
use tempfile::TempDir;

pub(crate) const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/knot_and_cables.obj");
pub(crate) const HEADER: &str = "qx,qy,qz,x,y,z,distance,primitive,feature";

/// The exit code and the output of a run.
pub(crate) struct Output {
    pub(crate) code: u8,
    pub(crate) stdout: Vec<u8>,
    pub(crate) stderr: Vec<u8>,
}

/// A writer that keeps the bytes that are written to it or to one of its clones.
#[derive(Clone, Default)]
struct Kept(Rc<RefCell<Vec<u8>>>);

impl Write for Kept {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Runs `p2m` within this process, with nothing on its standard input.
pub(crate) fn p2m(arguments: &[&str]) -> Output {
    p2m_with(arguments, "")
}

/// Runs `p2m` within this process, with `input` on its standard input.
pub(crate) fn p2m_with(arguments: &[&str], input: impl AsRef<[u8]>) -> Output {
    let stdout = Kept::default();
    let (code, stderr) = p2m_into(arguments, input, stdout.clone());
    Output { code, stdout: stdout.0.take(), stderr }
}

/// Runs `p2m` within this process into `stdout`, and returns the exit code and the standard error.
pub(crate) fn p2m_into(arguments: &[&str], input: impl AsRef<[u8]>, stdout: impl Write + 'static) -> (u8, Vec<u8>) {
    let stderr = Kept::default();
    let streams = Streams::new(Cursor::new(input.as_ref().to_vec()), stdout, stderr.clone());
    let code = p2m_cli::run(&streams, ["p2m"].iter().chain(arguments).map(Into::into));
    (code, stderr.0.take())
}

/// Prepares a process of the program itself, for tests of its streams, signals, terminals, pipes and folder.
pub(crate) fn program(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_p2m"));
    command.args(arguments).stdin(Stdio::null());
    command
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Returns the table on the standard output of a run that succeeds.
pub(crate) fn table(arguments: &[&str]) -> String {
    let output = p2m(arguments);
    assert_eq!(output.code, 0, "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

/// Returns the message of a run that fails.
pub(crate) fn failure(arguments: &[&str], code: u8) -> String {
    let output = p2m(arguments);
    let message = text(&output.stderr);
    assert_eq!(output.code, code, "{arguments:?}: {message}");
    assert_eq!(text(&output.stdout), "", "{arguments:?}");
    assert!(message.starts_with("error: "), "{message}");
    assert!(!message.contains("panicked") && !message.contains("backtrace"), "{message}");
    message
}

pub(crate) fn write(folder: &TempDir, name: &str, content: impl AsRef<[u8]>) -> String {
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    path.to_str().unwrap().to_owned()
}

pub(crate) fn path(folder: &TempDir, name: &str) -> String {
    folder.path().join(name).to_str().unwrap().to_owned()
}

pub(crate) fn names(folder: &Path) -> Vec<PathBuf> {
    let mut names: Vec<_> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into()).collect();
    names.sort();
    names
}

/// Returns the only JSON object on the standard output of a run that succeeds.
pub(crate) fn json(arguments: &[&str]) -> serde_json::Value {
    let text = table(arguments);
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{arguments:?}: {e}: {text}"))
}
