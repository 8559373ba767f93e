//! `capsulemap report`: one page that needs nothing else, with numbers that can be computed again, the same bytes each time.

use std::fs;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

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

#[test]
fn a_report_needs_nothing_else_and_its_optima_can_be_computed_again() {
    let folder = swept();
    folder.run(&["tradeoff", FILE, "--refine", "--direction", "backward"]).done();
    let html = page(&folder);
    assert_eq!(page(&folder), html, "other bytes");
    assert!(html.contains("<title>A &lt;small&gt; grid &amp; more</title>"));
    for outside in ["http", "src=\"/", "<script", "<link", "url("] {
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
        .map(|it| it.trim_start_matches("<pre>"))
        .filter(|it| it.starts_with("capsulemap simulate"))
        .collect();
    // Two figures, and of each optimum its history and phase portrait.
    assert_eq!(pictures.len(), 2 + 2 * commands.len(), "{commands:?}");
    assert_eq!(commands.len(), 6);
    let row = |name: &str| -> Vec<String> {
        let rows = html.lines().filter(|it| it.starts_with(&format!("<tr><td>{name}</td>")));
        let cells = rows.flat_map(|it| it.split("</td><td>").skip(1));
        cells.map(|it| it.trim_end_matches("</td></tr>").to_owned()).collect()
    };
    let told = [row("progression speed [m/s]"), row("power [W]")];
    for (place, command) in commands.into_iter().enumerate() {
        let command = plain(command.trim_end_matches("</pre>"));
        let words: Vec<&str> = command.split(' ').skip(1).chain(["--json"]).collect();
        let again = folder.run(&words).done();
        for (key, told) in ["progression_speed", "power"].into_iter().zip(&told) {
            let (found, told) = (again.printed(key), told[place].parse::<f64>().expect("a number"));
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
