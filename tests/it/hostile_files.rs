//! Files of results that were damaged or made to mislead: refused, with nothing else touched.

use std::fs;
use std::path::Path;
use std::time::Duration;

use capsulemap::store;
use hdf5::dataset::Layout;

use super::program::WorkDir;
use super::store::rich;

/// Bytes of the checksum at the end of a file and of its mark.
const CHECKSUM_BYTES: usize = 14;

/// Few cases, so that no array is compressed.
const SMALL: &str = r#"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
p_d = "4 N"
[[axes]]
name = "omega"
from = "18 rad/s"
to = "30 rad/s"
points = 12
"#;

/// Gives a file the checksum of what it now holds.
fn add_checksum(path: &Path) {
    let mut bytes = fs::read(path).expect("a file");
    let sum = crc32fast::hash(&bytes);
    bytes.extend_from_slice(b"capsulemap");
    bytes.extend_from_slice(&sum.to_le_bytes());
    fs::write(path, bytes).expect("it is written");
}

/// A result that `change` has been made to with HDF5, with a checksum that fits.
fn changed(change: impl Fn(&hdf5::File)) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("r.h5");
    store::write(&rich(), &path).expect("it is written");
    // A program that another test is starting holds the lock of every open file until it begins.
    let opened = (0..500).find_map(|_| {
        let file = hdf5::File::open_rw(&path).ok();
        if file.is_none() {
            std::thread::sleep(Duration::from_millis(20));
        }
        file
    });
    let file = opened.expect("HDF5 opens it");
    change(&file);
    file.close().expect("it is closed");
    add_checksum(&path);
    let refused = store::read(&path).expect_err("it is not what this program writes");
    (folder, refused.to_string())
}

#[test]
fn an_end_of_zeros_is_damage() {
    let dir = WorkDir::new();
    dir.put("s.toml", SMALL);
    let sweep = ["sweep", "s.toml", "--no-figures", "--output", "s.h5"];
    dir.run(&sweep).done();
    let whole = fs::read(dir.path("s.h5")).expect("a result");
    for zeros in [1, 4, 13, 14, 15, 64, 700, 4096] {
        let mut cut = whole.clone();
        let length = cut.len();
        cut[length - zeros..].fill(0);
        dir.put("s.h5", &cut);
        for reads in ["inspect", "verify"] {
            dir.run(&[reads, "s.h5"]).refused(&["s.h5"]);
        }
        dir.run(&sweep).refused(&["s.h5"]);
        assert_eq!(fs::read(dir.path("s.h5")).expect("it stays"), cut);
    }
    // Without its checksum the file is as damaged as with a wrong one.
    dir.put("s.h5", &whole[..whole.len() - CHECKSUM_BYTES]);
    dir.run(&sweep).refused(&["the checksum at its end is missing"]);
}

#[test]
fn blocks_beside_a_damaged_file_stay() {
    let dir = WorkDir::new();
    dir.put("s.toml", SMALL);
    let sweep = |output: &str, more: &[&str]| {
        let common = ["sweep", "s.toml", "--no-figures", "--output", output];
        dir.run(&[&common[..], more].concat())
    };
    sweep("whole.h5", &[]).done();
    sweep("s.h5", &["--task", "1/2"]).done();
    let count = || fs::read_dir(dir.path("s.blocks")).expect("a folder").count();
    let blocks = count();
    let mut damaged = fs::read(dir.path("whole.h5")).expect("a result");
    let length = damaged.len();
    damaged[length - 600..].fill(0);
    dir.put("s.h5", damaged);
    sweep("s.h5", &[]).refused(&["s.h5"]);
    assert_eq!(count(), blocks);
}

#[test]
fn blocks_whose_beginning_is_lost_are_not_given_up() {
    let dir = WorkDir::new();
    dir.put("s.toml", SMALL);
    let sweep = ["sweep", "s.toml", "--no-figures", "--output", "s.h5"];
    dir.run(&[&sweep[..], &["--task", "1/2"]].concat()).done();
    let begun = fs::read(dir.path("s.blocks/begun.json")).expect("how it began");
    let blocks = || fs::read_dir(dir.path("s.blocks")).map_or(0, Iterator::count);
    for lost in [None, Some("")] {
        fs::remove_file(dir.path("s.blocks/begun.json")).expect("it is lost");
        if let Some(empty) = lost {
            dir.put("s.blocks/begun.json", empty);
        }
        let before = blocks();
        dir.put("s.toml", SMALL.replace("1.5 mm", "1.6 mm"));
        dir.run(&sweep).refused(&["s.blocks: holds blocks of another run", "+ delta = \"1.6 mm\""]);
        assert_eq!(blocks(), before);
        dir.put("s.blocks/begun.json", &begun);
    }
    // The study that they belong to goes on with them, and what a removal that was killed has left goes too.
    dir.put("s.toml", SMALL);
    fs::remove_file(dir.path("s.blocks/begun.json")).expect("it is lost");
    dir.run(&sweep).done();
    assert_eq!(blocks(), 0);
    fs::create_dir(dir.path("s.blocks")).expect("a folder");
    dir.put("s.blocks/begun.json", &begun);
    dir.run(&sweep).done();
    assert!(!dir.path("s.blocks").exists());
}

#[test]
fn what_lies_in_other_files_is_not_opened() {
    let (_folder, said) = changed(|file| {
        file.link_external("other.h5", "x", "far").expect("a link");
    });
    assert!(said.contains("far is not an array in the file itself"), "{said}");
    let (_folder, said) = changed(|file| file.link_soft("omega", "again").expect("a link"));
    assert!(said.contains("again is not an array in the file itself"), "{said}");
    let (_folder, said) = changed(|file| drop(file.create_group("more").expect("a group")));
    assert!(said.contains("more is not an array in the file itself"), "{said}");
    let (folder, said) = changed(|file| {
        let builder = file.new_dataset_builder().no_chunk().external("pipe", 0, 80);
        builder.empty::<f64>().shape(10).create("outside").expect("an array");
    });
    assert!(said.contains("the numbers of outside are in another place"), "{said}");
    assert!(!folder.path().join("pipe").exists());
    let (_folder, said) = changed(|file| {
        let builder = file.new_dataset_builder().layout(Layout::Virtual);
        builder.empty::<f64>().shape(10).create("nowhere").expect("an array");
    });
    assert!(said.contains("the numbers of nowhere are in another place"), "{said}");
}

#[test]
fn sizes_beyond_the_file_are_not_allocated() {
    let (_folder, said) = changed(|file| {
        let builder = file.new_dataset_builder().chunk(1 << 20);
        builder.empty::<f64>().shape(1_usize << 44).create("vast").expect("an array");
    });
    assert!(said.contains("vast claims 140737488355328 bytes"), "{said}");
}

#[test]
fn a_study_that_is_not_that_of_the_arrays_is_told() {
    let dir = WorkDir::new();
    dir.put("s.toml", SMALL);
    dir.run(&["sweep", "s.toml", "--no-figures", "--output", "s.h5"]).done();
    let honest = store::read(&dir.path("s.h5")).expect("a result");
    let axis = "[[axes]]\nname = \"c\"\nfrom = \"1 N s/m\"\nto = \"2 N s/m\"\npoints = 3\n";
    let more = format!("{SMALL}{axis}");
    let longer = SMALL.replace("points = 12", "points = 13");
    let fewer = SMALL.split("[[axes]]").next().expect("a table").to_owned() + "omega = 20\n";
    let fewer = fewer.replace("omega = 20", "omega = \"20 rad/s\"");
    for text in [more, longer, fewer] {
        let mut forged = honest.clone();
        forged.texts.insert("study".to_owned(), text.clone());
        store::write(&forged, &dir.path("s.h5")).expect("it is written");
        let ran = dir.run(&["verify", "s.h5"]);
        assert!(!ran.err.contains("panicked"), "{text}: {}", ran.err);
        assert_ne!(ran.code, 0, "{text}");
    }
}
