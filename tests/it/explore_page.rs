//! The page of `capsulemap explore` in headless Chromium: what a person does with it, and what it loads and says.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::explore_stored::{basins, hysteresis};
use super::explorer::{Explorer, coarse_overview};
use super::program::WorkDir;
use super::store::say;

/// Whether the packages that drive a browser are there; a printed line where they are not.
pub fn has_browser() -> bool {
    let has = std::env::var("CAPSULEMAP_BROWSER").is_ok();
    if !has {
        say("SKIPPED: no browser (scripts/check.sh installs what drives it)");
    }
    has
}

/// What a person finds on the page of `explorer` in a task.
fn found(explorer: &Explorer, task: &str) -> Value {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser/explore.mjs");
    let address = format!("http://127.0.0.1:{}/open?token={}", explorer.port, explorer.token);
    let mut node = Command::new("node");
    node.arg(script).args([task, &address]);
    if let Ok(folder) = std::env::var("CAPSULEMAP_KEEP") {
        node.arg(folder);
    }
    let done = node.output().expect("node runs");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    serde_json::from_slice(&done.stdout).expect("one JSON object")
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_else(|| panic!("no text: {value}"))
}

#[test]
fn a_person_clicks_compares_and_hands_over() {
    if !has_browser() {
        return;
    }
    let work = WorkDir::new();
    work.put("map.toml", coarse_overview([13, 41]));
    work.run(&["sweep", "map.toml", "--output", "map.h5", "--no-figures"]).done();
    let explorer = Explorer::unopened(&work, &["map.h5"]);
    let found = found(&explorer, "check");

    // Nothing is asked of anybody else, nothing is said on the console, nothing serious is found by axe-core.
    let own = format!("http://127.0.0.1:{}/", explorer.port);
    let requests = found["requests"].as_array().expect("a list");
    assert!(requests.len() > 40, "{}", requests.len());
    for request in requests.iter().map(text) {
        let is_own = request.starts_with(&own) || request.starts_with(&format!("blob:{own}"));
        assert!(is_own, "{request}");
    }
    assert_eq!(found["console"], serde_json::json!([]));
    assert_eq!(found["axe"], serde_json::json!([]));

    for scheme in ["light", "dark"] {
        let view = &found["views"][scheme];
        assert!(view["charts"].as_u64().expect("a count") >= 5, "{view}");
        assert_eq!(view["pinned"], 2, "{view}");
        assert_eq!(view["byKeys"], true, "{view}");
        assert_eq!(view["pdf"], "%PDF", "{view}");
        assert!(text(&view["branches"]).contains("orbits in"), "{view}");
        assert_eq!(view["again"], view["command"], "the address holds the view");
        // The numbers of the table are those of the command that the page hands over.
        let arguments = text(&view["command"]).strip_prefix("capsulemap").expect("a command");
        let orbit = &work.shell(&format!("\"$0\" {arguments} --json")).json()["orbit"];
        let rows = view["numbers"].as_array().expect("rows");
        assert!(rows.len() > 20, "{}", rows.len());
        for row in &rows[1..] {
            let (name, shown) = (text(&row[0]), text(&row[1]));
            match orbit[name].as_f64() {
                Some(value) => assert_eq!(shown.parse(), Ok(value), "{name}"),
                None => assert_eq!(shown, "no value", "{name}"),
            }
        }
        // What is handed over runs.
        let figure = text(&view["figure"]).strip_prefix("capsulemap").expect("a command");
        work.shell(&format!("\"$0\" {figure} --name {scheme} --formats png")).done();
        for study in ["line", "basin"] {
            let file = format!("{scheme}-{study}.toml");
            work.put(&file, text(&view[study]));
            work.run(&["sweep", &file, "--dry-run"]).done();
        }
    }
}

/// Files that have no map of parameters open on their diagram, their basins or their draws; nothing of it is wider than the window, and
/// axe-core finds nothing serious.
#[test]
fn files_open_on_what_they_are() {
    if !has_browser() {
        return;
    }
    let work = WorkDir::new();
    hysteresis(&work);
    basins(&work);
    for file in ["s.h5", "b.h5"] {
        let found = found(&Explorer::unopened(&work, &[file]), "open");
        assert_eq!(found["console"], serde_json::json!([]), "{file}");
        assert_eq!(found["axe"], serde_json::json!([]), "{file}");
        let views = found["views"].as_object().expect("views");
        assert_eq!(views.len(), 6, "{file}");
        for (size, view) in views {
            for name in ["figure", "part"].into_iter().filter(|it| view.get(it).is_some()) {
                let figure = text(&view[name]).strip_prefix("capsulemap").expect("a command");
                let place = format!("{}-{name}", size.replace(' ', "-"));
                work.shell(&format!("\"$0\" {figure} --name {place} --formats svg --overwrite"))
                    .done();
            }
            assert!(text(&view["command"]).starts_with("capsulemap simulate"), "{view}");
            match file {
                "s.h5" => {
                    assert!(text(&view["shows"]).contains("72 cases"), "{view}");
                    assert!(text(&view["special"]).contains("multipliers"), "{view}");
                    assert!(text(&view["part"]).contains("--limits"), "{view}");
                }
                _ => {
                    assert_eq!(view["attractors"], 3, "two attractors and a saddle: {view}");
                    assert!(text(&view["saddle"]).starts_with("saddle 0"), "{view}");
                    assert!(text(&view["figure"]).contains("--kind basin"), "{view}");
                    assert_eq!(view["bare"], 0, "{view}");
                }
            }
        }
    }
}

/// The most that the page may weigh, packed as servers pack pages [bytes].
const MOST: usize = 150_000;

#[test]
fn the_page_is_light() {
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use std::io::Write;

    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/explore/page");
    let mut packed = 0;
    let mut folders = vec![folder];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let content = std::fs::read(&path).expect("a file");
            let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
            gzip.write_all(&content).expect("packed");
            packed += gzip.finish().expect("packed").len();
        }
    }
    println!("{packed} bytes");
    assert!(packed < MOST, "{packed} bytes");
}
