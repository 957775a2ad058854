//! How every file of Airlight is written: never half under its final name.

use std::ffi::OsString;
use std::fs::{File, Metadata, OpenOptions};
use std::io::{Error, ErrorKind, Result, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// What stands between the final name and the rest of a temporary one.
const MARK: &str = ".tmp-";

/// Puts `bytes` under `path` in one step. They are written to a new file in the same folder, synced, and that file
/// takes the place of `path`: whoever looks finds the old content or the new, whole, also while several processes
/// write the same path (the last one to finish stays), after a kill, and after a loss of power.
///
/// The temporary file is called `NAME.tmp-PROCESS-COUNT`. A kill can leave it behind; no later run is hindered by it,
/// and anyone may delete it (see [`is_temporary`]). Permissions of a file that is replaced are kept, a symbolic link
/// still points where it did. A device or a pipe, which has no content to be halved, is written to as it stands.
///
/// # Errors
/// What the system says; the temporary file is then removed and `path` is as it was.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<()> {
    let Destination { path, old } = Destination::of(path)?;
    if old.as_ref().is_some_and(|old| !old.is_file() && !old.is_dir()) {
        return OpenOptions::new().write(true).open(path)?.write_all(bytes);
    }
    let (mut file, temporary) = create(&path)?;
    let result = (|| {
        if let Some(old) = old {
            file.set_permissions(old.permissions())?;
        }
        file.write_all(bytes)?;
        // Without this a loss of power could leave the new name with an empty file: the rename may
        // reach the disk before the content. The folder is not synced: what is then lost is the
        // rename, and the old file, whole, is still there, which is what is promised.
        file.sync_all()?;
        drop(file);
        std::fs::rename(&temporary, &path)
    })();
    if result.is_err() {
        // The first error is the one to report; a leftover is only untidy.
        let _ = std::fs::remove_file(&temporary);
    }
    result
}

/// Whether [`replace`] could write `path` now: a temporary file is made in its folder and removed. For a program that
/// computes for long before it writes.
///
/// # Errors
/// What the system says.
pub fn check_writable(path: &Path) -> Result<()> {
    let Destination { path, old } = Destination::of(path)?;
    match old {
        Some(old) if old.is_dir() => Err(ErrorKind::IsADirectory.into()),
        Some(old) if !old.is_file() => OpenOptions::new().write(true).open(path).map(drop),
        _ => {
            let (_, temporary) = create(&path)?;
            std::fs::remove_file(temporary)
        }
    }
}

/// Whether `name` is that of a temporary file of [`replace`], left behind by a program that was killed or in use by
/// one that is writing.
#[must_use]
pub fn is_temporary(name: &str) -> bool {
    let numbers = |rest: &str| {
        let mut parts = rest.split('-');
        let number = |part: Option<&str>| part.is_some_and(|text| text.parse::<u32>().is_ok());
        number(parts.next()) && number(parts.next()) && parts.next().is_none()
    };
    name.rsplit_once(MARK).is_some_and(|(stem, rest)| !stem.is_empty() && numbers(rest))
}

/// Where to write, symbolic links followed, and what is there already.
struct Destination {
    path: PathBuf,
    old: Option<Metadata>,
}

impl Destination {
    fn of(path: &Path) -> Result<Self> {
        match std::fs::metadata(path) {
            Ok(old) => Ok(Self { path: std::fs::canonicalize(path)?, old: Some(old) }),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(Self { path: path.into(), old: None }),
            Err(error) => Err(error),
        }
    }
}

/// A new file beside `path`, of a name that no other process and no other call has.
fn create(path: &Path) -> Result<(File, PathBuf)> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let name = path.file_name().ok_or_else(|| Error::other("the path names no file"))?;
    loop {
        let mut temporary = OsString::from(name);
        temporary.push(format!("{MARK}{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
        let temporary = path.with_file_name(temporary);
        match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            Ok(file) => return Ok((file, temporary)),
            // Left behind by a process that was killed and had the same number.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_temporary_files_are_known_again() {
        for name in ["sun.table.tmp-12-0", "a.tmp-1.tmp-4294967295-3"] {
            assert!(is_temporary(name), "{name}");
        }
        for name in ["sun.table", ".tmp-1-2", "a.tmp-1", "a.tmp-x-1", "a.tmp-1-2-3", "a.tmp-1-2.csv"] {
            assert!(!is_temporary(name), "{name}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_permissions_devices_and_leftovers_are_respected() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = std::env::temp_dir().join(format!("airlight-replace-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("temporary folder");
        let (file, link) = (folder.join("a"), folder.join("link"));
        replace(&file, b"old").expect("written");
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o600)).expect("set");
        symlink(&file, &link).expect("linked");
        // The next names that this process would choose are taken.
        for count in 0..40 {
            std::fs::write(folder.join(format!("a.tmp-{}-{count}", std::process::id())), "left").expect("written");
        }
        check_writable(&link).expect("writable");
        replace(&link, b"new").expect("written");
        assert_eq!(std::fs::read(&file).expect("there"), b"new");
        assert!(std::fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(std::fs::metadata(&file).expect("there").permissions().mode() & 0o777, 0o600);
        replace(Path::new("/dev/null"), b"gone").expect("a device takes it");
        assert!(!std::fs::metadata("/dev/null").expect("there").is_file());
        assert!(check_writable(&folder).is_err() && replace(&folder, b"x").is_err(), "a folder was replaced");
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
