//! Where results go.

use std::io::Write;
use std::path::Path;

/// Puts a result on standard output, or under the name of a file in one step; says so if that replaces one.
pub(super) fn put(bytes: &[u8], to: Option<&Path>) -> Result<(), String> {
    match to {
        Some(path) => {
            announce(path);
            tables::file::replace(path, bytes).map_err(|e| format!("{}: cannot be written: {e}", path.display()))
        }
        None => print(bytes),
    }
}

/// Says that a file which is there will be replaced.
pub(super) fn announce(path: &Path) {
    if path.exists() {
        super::say(&format!("replaces {}", path.display()));
    }
}

/// Puts a result on standard output.
pub(super) fn print(bytes: &[u8]) -> Result<(), String> {
    match std::io::stdout().lock().write_all(bytes) {
        // A reader that has seen enough, such as `head`.
        Err(e) if e.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(|e| format!("standard output: {e}")),
    }
}
