//! The status of a call and the message of a failure.

use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The status of a call. After any other status than `P2M_STATUS_OK`, the outputs of the call are unspecified, and
/// `p2m_last_error` returns the reason.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The call succeeded.
    Ok = 0,
    /// An argument is null, misaligned, out of range or not finite.
    InvalidArgument = 1,
    /// The scene cannot be indexed.
    InvalidScene = 2,
    /// The index does not answer this kind of query.
    Unsupported = 3,
    /// A file could not be read or written.
    File = 4,
    /// There is not enough memory for threads, or for the k nearest.
    OutOfMemory = 5,
    /// The call was cancelled.
    Cancelled = 6,
    /// There is a bug in p2m. Please report the message.
    Internal = 7,
}

pub(crate) struct Failure(pub(crate) Status, pub(crate) String);

pub(crate) type Call<T = ()> = Result<T, Failure>;

thread_local! {
    static MESSAGE: RefCell<CString> = RefCell::default();
}

pub(crate) fn invalid(message: impl Display) -> Failure {
    Failure(Status::InvalidArgument, message.to_string())
}

/// Runs a call, catches panics, and keeps the message of a failure.
pub(crate) fn run(call: impl FnOnce() -> Call) -> Status {
    let failed = |Failure(status, message): Failure| {
        MESSAGE.with_borrow_mut(|kept| *kept = CString::new(message.replace('\0', " ")).unwrap_or_default());
        status
    };
    match catch_unwind(AssertUnwindSafe(call)) {
        Ok(Ok(())) => Status::Ok,
        Ok(Err(failure)) => failed(failure),
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
            failed(Failure(Status::Internal, text.unwrap_or("a panic without a message").to_owned()))
        }
    }
}

/// Returns the message of the last failure on this thread, or the empty string if there was none. The string is valid
/// until the next failure on this thread.
#[unsafe(no_mangle)]
pub extern "C" fn p2m_last_error() -> *const c_char {
    MESSAGE.with_borrow(|message| message.as_ptr())
}

/// Returns the version of the library as a static string, such as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn p2m_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}
