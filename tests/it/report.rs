//! `capsulemap report`: one page that needs nothing else, in the order of a paper's supplement, with numbers that can be computed
//! again, the same bytes each time.

use std::fs;
use std::path::Path;
use std::process::Command;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

use super::explore_page::has_browser;
use super::program::WorkDir;

/// A coarse grid with motions in both directions and two figures, one of which waits for branches.
const STUDY: &str = "title = \"A <small> grid & more\"\n\
     [parameters]\nk2 = \"20 kN/m\"\ndelta = \"3 mm\"\n\
     [[axes]]\nname = \"p_d\"\nfrom = \"3 N\"\nto = \"8 N\"\npoints = 4\n\
     [[axes]]\nname = \"omega\"\nfrom = \"40 rad/s\"\nto = \"90 rad/s\"\npoints = 6\n\
     [[figures]]\nname = \"trade-off\"\nkind = \"trade-off\"\nof = [\"power\"]\n\
     [[figures]]\nname = \"speed\"\nkind = \"map\"\n";
const FILE: &str = "results/study/study.h5";
const PAGE: &str = "results/study/study.html";

fn swept() -> WorkDir {
    let folder = WorkDir::new();
    folder.put("study.toml", STUDY);
    folder.run(&["sweep", "study.toml", "--no-figures"]).done();
    folder
}

fn page(folder: &WorkDir) -> String {
    folder.run(&["report", FILE]).done();
    fs::read_to_string(folder.path(PAGE)).expect("a page")
}

/// The text of HTML without what it replaces.
fn plain(html: &str) -> String {
    html.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&")
}

/// The rows of the tables whose captions begin so, cell by cell.
fn tables(html: &str, caption: &str) -> Vec<Vec<Vec<String>>> {
    let wanted = format!("</b> {caption}");
    let all = html.split("<div class=\"table").skip(1).filter(|it| it.contains(&wanted));
    let rows = all.map(|table| {
        let body = table
            .split("<tbody>")
            .nth(1)
            .expect("a body")
            .split("</tbody>")
            .next()
            .expect("it ends");
        let cells = |row: &str| -> Vec<String> {
            let all = row
                .split(['<', '>'])
                .skip(1)
                .step_by(2)
                .zip(row.split(['<', '>']).skip(2).step_by(2));
            all.filter(|(tag, _)| tag.starts_with("td") || tag.starts_with("th"))
                .map(|it| it.1.to_owned())
                .collect()
        };
        body.lines().filter(|it| it.starts_with("<tr>")).map(cells).collect()
    });
    rows.collect()
}

/// A number as it is set.
fn number(cell: &str) -> f64 {
    cell.replace('\u{2212}', "-")
        .replace(' ', "")
        .parse()
        .unwrap_or_else(|_| panic!("no number: {cell}"))
}

#[test]
fn a_report_is_in_order_and_its_numbers_are_those_of_the_file() {
    let folder = swept();
    let html = page(&folder);
    let order = [
        "<h1>",
        "<dl class=\"facts\">",
        "<h2 id=\"abstract\">",
        "<h2 id=\"contents\">",
        "</span>What was computed</h2>",
        "</span>Outcomes</h2>",
        "</span>Figures</h2>",
        "</span>Optima</h2>",
        "</span>To compute it again</h2>",
        "</span>Provenance</h2>",
        "</span>Citation</h2>",
    ];
    let places: Vec<usize> =
        order.iter().map(|it| html.find(it).unwrap_or_else(|| panic!("no {it}"))).collect();
    assert!(places.is_sorted(), "{places:?}");
    // Figures and tables are numbered without a gap, and every reference leads to one.
    for (element, kind) in [("figcaption", "Figure"), ("p class=\"caption\"", "Table")] {
        let begin = format!("<{element}");
        let numbers = html.split(&begin).skip(1).map(|it| {
            let name = it.split("<b>").nth(1).expect("a name").split('.').next().expect("it ends");
            name.trim_start_matches(kind).trim().parse::<usize>().expect("a number")
        });
        let numbers: Vec<usize> = numbers.collect();
        assert_eq!(numbers, (1..=numbers.len()).collect::<Vec<_>>());
        assert!(numbers.len() > 2);
    }
    for reference in html.split("href=\"#").skip(1) {
        let id = reference.split('"').next().expect("it ends");
        assert!(html.contains(&format!("id=\"{id}\"")), "{id}");
    }
    // The abstract counts what the file has.
    let told = plain(html.split("</section>").next().expect("an abstract"));
    assert!(
        told.contains(
            "The file has 24 cases: each combination of 4 values of p_d from 3 to 8\u{a0}N"
        ),
        "{told}"
    );
    let outcomes = &tables(&html, "What the cases turned out to be.")[0];
    let all: f64 = outcomes.iter().map(|row| number(&row[1])).sum();
    let inside = folder.run(&["inspect", FILE]).done().out;
    let line = inside.lines().find_map(|it| it.strip_prefix("outcomes: ")).expect("outcomes");
    let counted: Vec<String> =
        outcomes.iter().map(|row| format!("{} {}", row[1], row[0])).collect();
    assert_eq!((all, counted.join(", ").as_str()), (24.0, line));
    for row in outcomes {
        let name = &row[0];
        assert!(told.contains(name.as_str()), "{name}: {told}");
    }
}

#[test]
fn a_report_in_a_browser_sorts_copies_prints_and_fits_narrow_screens() {
    if !has_browser() {
        return;
    }
    let folder = swept();
    page(&folder);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser/report.mjs");
    let mut node = Command::new("node");
    node.arg(script).arg(folder.path(PAGE));
    if let Ok(kept) = std::env::var("CAPSULEMAP_KEEP") {
        node.arg(kept);
    }
    let done = node.output().expect("node runs");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let found: Value = serde_json::from_slice(&done.stdout).expect("one JSON object");
    assert_eq!((&found["console"], &found["axe"]), (&json!([]), &json!([])));
    let requests = found["requests"].as_array().expect("a list");
    let is_own = |it: &Value| {
        it.as_str().is_some_and(|it| it.starts_with("file:") || it.starts_with("data:"))
    };
    assert!(requests.iter().all(is_own), "{requests:?}");
    for (scheme, width) in [("light", 1280), ("dark", 390)] {
        let view = &found["views"][scheme];
        assert_eq!(
            (&view["width"], &view["pdf"], &view["lost"]),
            (&json!(width), &json!("%PDF"), &json!([])),
            "{scheme}"
        );
        let order = |press: usize| view["orders"][press][0].as_str().expect("an order").to_owned();
        let numbers = |press: usize| -> Vec<f64> {
            let cells = view["orders"][press][1].as_array().expect("cells");
            cells.iter().map(|it| number(it.as_str().expect("a text"))).collect()
        };
        assert_eq!([0, 1, 2, 3].map(order), ["none", "ascending", "descending", "none"]);
        assert!(numbers(1).is_sorted() && numbers(1).len() > 1, "{view}");
        assert!(numbers(2).iter().rev().is_sorted(), "{view}");
        assert_eq!(numbers(0), numbers(3));
        // Tab-separated, with the line of headings.
        let copied = view["copied"].as_str().expect("a text");
        let lines: Vec<Vec<&str>> = copied.lines().map(|it| it.split('\t').collect()).collect();
        assert_eq!(lines[0], ["name", "symbol", "meaning", "value", "unit"], "{copied}");
        assert_eq!(lines.len(), numbers(1).len() + 1);
        assert!(lines[1..].iter().all(|it| it[3].parse::<f64>().is_ok()), "{copied}");
        assert!(view["said"].as_str().is_some_and(|it| it.ends_with(": copied")), "{view}");
    }
}

#[test]
fn a_report_needs_nothing_else_and_its_optima_can_be_computed_again() {
    let folder = swept();
    folder.run(&["tradeoff", FILE, "--refine", "--direction", "backward"]).done();
    let html = page(&folder);
    assert_eq!(page(&folder), html, "other bytes");
    assert!(html.contains("<title>A &lt;small&gt; grid &amp; more</title>"));
    for outside in ["http", "src=\"/", "<script src", "<link", "url("] {
        assert!(!html.contains(outside), "{outside}");
    }
    assert!(plain(&html).contains(STUDY), "the study is there");
    let pictures: Vec<&str> = html.split("src=\"data:image/png;base64,").skip(1).collect();
    for picture in &pictures {
        let data = picture.split('"').next().expect("data");
        assert!(STANDARD.decode(data).expect("base64").starts_with(b"\x89PNG"));
    }
    let commands: Vec<&str> = html
        .lines()
        .map(|it| it.trim_start_matches("<pre class=\"short\">"))
        .filter(|it| it.starts_with("capsulemap simulate"))
        .collect();
    // Two figures, and of each optimum its history and phase portrait.
    assert_eq!(pictures.len(), 2 + 2 * commands.len(), "{commands:?}");
    assert!((4..=6).contains(&commands.len()), "{commands:?}");
    let best: Vec<Vec<Vec<String>>> = tables(&html, "The best motions, ");
    assert_eq!(best.len(), 2);
    let told = [1, 2]
        .map(|column| -> Vec<&String> { best.iter().flatten().map(|row| &row[column]).collect() });
    for (place, command) in commands.into_iter().enumerate() {
        let command = plain(command.trim_end_matches("</pre>"));
        let words: Vec<&str> = command.split(' ').skip(1).chain(["--json"]).collect();
        let again = folder.run(&words).done();
        for (key, told) in ["progression_speed", "power"].into_iter().zip(&told) {
            let (found, told) = (again.printed(key), number(told[place]));
            assert!((found - told).abs() <= 5e-6 * told.abs(), "{key}: {found} {told}: {command}");
        }
    }
}

#[test]
fn motions_of_other_searches_are_not_shown_and_that_is_said() {
    let folder = swept();
    let alone = page(&folder);
    folder.put("results/study/study.searches", "anything\n");
    let html = page(&folder);
    let said = "Motions between the cases are not shown: results/study/study.searches: holds something else";
    assert!(html.contains(said) && !alone.contains("are not shown"), "{html}");
}

#[test]
fn a_report_says_what_it_cannot_tell_and_replaces_no_page_of_others() {
    let folder = swept();
    let by_loss = ["report", FILE, "--of", "lyapunov_exponent", "--output", "loss.html"];
    folder.run(&by_loss).done();
    folder.put(PAGE, "<html>mine</html>");
    folder.run(&["report", FILE]).refused(&[PAGE, "is no report", "--overwrite"]);
    assert_eq!(fs::read_to_string(folder.path(PAGE)).expect("a page"), "<html>mine</html>");
    folder.run(&["report", FILE, "--overwrite"]).done();
    folder.run(&["report", FILE, "--of", "powr"]).refused(&["--of", "powr", "power"]);
    folder.run(&["report", "study.toml"]).refused(&["study.toml", "not a result of capsulemap"]);
    // A file of branches alone.
    folder.put(
        "branches.toml",
        "[parameters]\nk2 = \"20 kN/m\"\ndelta = \"1 mm\"\np_d = \"2 N\"\n\
         [[axes]]\nname = \"omega\"\nfrom = \"39 rad/s\"\nto = \"41 rad/s\"\npoints = 3\n\
         [[branches]]\nname = \"one\"\nalong = \"omega\"\nat = { omega = \"40 rad/s\" }\n\
         [[figures]]\nname = \"diagram\"\nkind = \"bifurcation\"\n",
    );
    folder.run(&["continue", "branches.toml", "--no-figures"]).done();
    let branches = "results/branches/branches.h5";
    folder.run(&["report", branches]).done();
    let html = fs::read_to_string(folder.path("results/branches/branches.html")).expect("a page");
    assert!(html.contains("holds no cases of a sweep") && html.contains("No optima: "), "{html}");
}
