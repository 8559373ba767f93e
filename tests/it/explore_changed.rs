//! A file of results that another program changes while `capsulemap explore` serves it: its numbers are not shown.

use std::fs;
use std::fs::OpenOptions;

use capsulemap::store;

use super::explorer::{Explorer, coarse_overview};
use super::program::WorkDir;

/// Requests for all that is read from the file.
const ASKED: [&str; 8] = [
    MAP,
    "/api/trade-off?of=power&x=omega&y=p_d",
    "/api/curves?x=omega&y=p_d",
    "/api/motion?p_d=3&omega=60",
    "/api/figure?kind=map&of=period&x=omega&y=p_d&format=svg",
    "/api/line?p_d=3&omega=45&to_omega=50&count=3",
    "/api/basin?p_d=3&omega=60",
    "/api/file",
];
const MAP: &str = "/api/map?of=progression_speed&x=omega&y=p_d";
const CASES: usize = 10;

/// The speeds of a file as maps show them.
fn speeds(work: &WorkDir, file: &str) -> Vec<u32> {
    let results = store::read(&work.path(file)).expect("results");
    let speeds = results.variable("progression_speed").expect("speeds").values.to_real();
    speeds.iter().map(|it| ((it * 1e3) as f32).to_bits()).collect()
}

/// The speeds that the page shows.
fn shown(explorer: &Explorer) -> Vec<u32> {
    let shown = explorer.packed(MAP).numbers(4 * CASES, CASES);
    shown.into_iter().map(f32::to_bits).collect()
}

fn refused_everywhere(explorer: &Explorer) {
    for address in ASKED {
        let refused = explorer.get(address);
        assert_eq!(refused.status, 409, "{address}: {}", refused.text());
        let told = refused.text();
        assert!(told.contains("map.h5 has changed since it was opened"), "{told}");
        assert!(told.contains("open it anew"), "{told}");
    }
}

#[test]
fn a_file_that_changes_in_place_is_not_shown_until_it_is_opened_anew() {
    let work = WorkDir::new();
    work.put("map.toml", coarse_overview([2, 5]));
    work.put("other.toml", coarse_overview([2, 5]).replace("2.45 mm", "2.4 mm"));
    for name in ["map", "other"] {
        let file = format!("{name}.h5");
        work.run(&["sweep", &format!("{name}.toml"), "--output", &file, "--no-figures"]).done();
        fs::copy(work.path(&file), work.path(&format!("{name}-kept.h5"))).expect("a copy");
    }
    let [first, other] = ["map", "other"].map(|name| speeds(&work, &format!("{name}.h5")));
    assert_ne!(first, other);
    let explorer = Explorer::new(&work, &["map.h5"]);
    assert_eq!(shown(&explorer), first);

    // Cut short: what is missing was read as zero.
    let file = OpenOptions::new().write(true).open(work.path("map.h5")).expect("the file");
    file.set_len(2048).expect("it is cut short");
    drop(file);
    refused_everywhere(&explorer);
    let damaged = explorer.get("/api/anew");
    assert_eq!(damaged.status, 400, "{}", damaged.text());
    assert!(damaged.text().contains("map.h5"), "{}", damaged.text());
    refused_everywhere(&explorer);

    // Another file over it, byte by byte: cells of neither were shown.
    fs::copy(work.path("other-kept.h5"), work.path("map.h5")).expect("copied in place");
    refused_everywhere(&explorer);
    assert_eq!(explorer.get("/api/anew").status, 200);
    assert_eq!(shown(&explorer), other);

    // The first numbers again.
    fs::copy(work.path("map-kept.h5"), work.path("map.h5")).expect("copied in place");
    refused_everywhere(&explorer);
    assert_eq!(explorer.get("/api/anew").status, 200);
    assert_eq!(shown(&explorer), first);

    // One that takes its name leaves the older as it is, as long as it is open.
    fs::rename(work.path("other-kept.h5"), work.path("map.h5")).expect("replaced");
    assert_eq!(shown(&explorer), first);
    assert_eq!(explorer.get(ASKED[3]).status, 200);
    assert_eq!(explorer.get("/api/anew").status, 200);
    assert_eq!(shown(&explorer), other);
}

#[test]
fn an_archive_reads_nothing_from_a_file_that_has_changed() {
    let work = WorkDir::new();
    work.put("map.toml", coarse_overview([2, 2]));
    work.run(&["sweep", "map.toml", "--output", "map.h5", "--no-figures"]).done();
    let archive = store::open(&work.path("map.h5")).expect("results");
    assert!(archive.variable("power").expect("it is read").is_some());
    let mut bytes = fs::read(work.path("map.h5")).expect("bytes");
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    fs::write(work.path("map.h5"), bytes).expect("written in place");
    let said = |refused: store::StoreError| refused.to_string();
    let read = archive.variable("power").map_err(said).expect_err("it has changed");
    let rows = archive.rows("power", &[vec![0, 0]]).map_err(said).expect_err("it has changed");
    for refused in [read, rows] {
        assert!(refused.contains("has changed since it was opened"), "{refused}");
    }
}
