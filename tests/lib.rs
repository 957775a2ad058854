//! What the whole-project tests share: where things are, and folders that go away.

pub mod mutation;

use std::path::{Path, PathBuf};

/// The root of the project.
#[must_use]
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_path_buf).unwrap_or_default()
}

/// The committed tables.
///
/// # Panics
/// If `data/` does not hold every table: then every test that needs them has failed.
#[must_use]
pub fn data() -> renderer::data::Data {
    renderer::data::Data::load(&root().join("data")).expect("data/ holds every table")
}

/// A program of the project that was built with the test that asks: `cargo test --workspace` builds them all.
///
/// # Panics
/// If it is not there: after `cargo test -p airlight-tests` alone, which does not build it.
#[must_use]
pub fn program(name: &str) -> PathBuf {
    let test = std::env::current_exe().expect("a test has a path");
    let folder = test.ancestors().nth(2).expect("target/PROFILE/deps/TEST");
    let path = folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    assert!(path.is_file(), "{} is not built: cargo build --bins, or cargo test --workspace", path.display());
    path
}

/// A number from the environment, for longer runs.
///
/// # Panics
/// If it is no whole number.
#[must_use]
pub fn from_environment(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |text| text.parse().expect("a whole number"))
}

/// A folder of its own for one test, removed when dropped.
#[derive(Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// An empty folder whose name holds `name`.
    ///
    /// # Panics
    /// If the system's temporary folder cannot be written.
    #[must_use]
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("airlight-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a temporary folder can be made");
        Self(path)
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
