//! A table that is missing, damaged or another one is named, and nothing is rendered from it.

use airlight_tests::{Folder, root};
use renderer::data::Data;
use tables::Kind;

/// A copy of `data/`.
fn copy(name: &str) -> Folder {
    let folder = Folder::new(name);
    for kind in Kind::ALL {
        let name = kind.file_name();
        std::fs::copy(root().join("data").join(&name), folder.path().join(&name)).expect("copied");
    }
    folder
}

fn refusal(folder: &Folder) -> String {
    Data::load(folder.path()).expect_err("a spoiled folder was taken").to_string()
}

#[test]
fn every_missing_table_is_named() {
    for kind in Kind::ALL {
        let folder = copy(&format!("missing-{kind}"));
        std::fs::remove_file(folder.path().join(kind.file_name())).expect("removed");
        let refusal = refusal(&folder);
        assert!(refusal.contains(&kind.file_name()) && refusal.contains("build"), "{refusal}");
    }
}

#[test]
fn every_damaged_table_is_named_with_its_damage() {
    for kind in Kind::ALL {
        let folder = copy(&format!("damaged-{kind}"));
        let path = folder.path().join(kind.file_name());
        let whole = std::fs::read(&path).expect("read");
        let mut flipped = whole.clone();
        let last = flipped.len() - 1;
        flipped[last] ^= 0x10;
        for (bytes, word) in
            [(&flipped[..], "damaged"), (&whole[..whole.len() / 2], "truncated"), (&b"P3"[..], "not an")]
        {
            std::fs::write(&path, bytes).expect("written");
            let refusal = refusal(&folder);
            assert!(refusal.contains(&kind.file_name()) && refusal.contains(word), "{word}: {refusal}");
        }
    }
}

#[test]
fn a_table_under_the_name_of_another_is_refused() {
    let folder = copy("swapped");
    let (air, rayleigh) = (Kind::StandardAtmosphere.file_name(), Kind::Rayleigh.file_name());
    std::fs::copy(folder.path().join(&air), folder.path().join(&rayleigh)).expect("copied");
    let refusal = refusal(&folder);
    assert!(refusal.contains("kind standard-atmosphere where rayleigh"), "{refusal}");
}
