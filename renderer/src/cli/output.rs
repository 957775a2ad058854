//! Standard output and standard error, which may be full or closed: that is one sentence at the end, not a panic.

use super::Failure;
use std::fmt::Arguments;
use std::io::{Error, ErrorKind, Result, Write};
use std::sync::{Mutex, PoisonError};

/// The first error of standard output.
static FIRST: Mutex<Option<Error>> = Mutex::new(None);

/// A line on standard output.
macro_rules! println {
    ($($text:tt)*) => { $crate::cli::output::result(format_args!($($text)*)) };
}

/// A line on standard error.
macro_rules! eprintln {
    ($($text:tt)*) => { $crate::cli::output::words(format_args!($($text)*)) };
}

pub(super) use {eprintln, println};

pub(super) fn result(line: Arguments<'_>) {
    note(writeln!(std::io::stdout().lock(), "{line}"));
}

/// Bytes as they are, on standard output.
pub(super) fn bytes(bytes: &[u8]) {
    note(std::io::stdout().lock().write_all(bytes));
}

/// That nobody reads it is no reason to fail.
pub(super) fn words(line: Arguments<'_>) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Whether everything that was said on standard output is there. A reader that has seen enough, such as `head`, is
/// no error.
pub(super) fn finish() -> std::result::Result<(), Failure> {
    note(std::io::stdout().lock().flush());
    match FIRST.lock().unwrap_or_else(PoisonError::into_inner).take() {
        Some(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::error(format!("standard output: cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

fn note(result: Result<()>) {
    if let Err(error) = result {
        FIRST.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }
}
