//! Figures read no more of a file than they show: what is left unread does not change a stroke.

use std::fs;

use capsulemap::figure::{Format, draw, variables};
use capsulemap::store;
use capsulemap::study::Study;

use super::figure::into;
use super::program::WorkDir;

/// Figures of every kind, over cases that differ in all that figures look at.
const STUDY: &str = r#"title = "All figures"
[parameters]
k2 = "86.8 kN/m"
delta = "2.45 mm"
p_d = "3.4 N"
[[axes]]
name = "omega"
from = "38 rad/s"
to = "41 rad/s"
points = 16
[[axes]]
name = "start_y1"
values = ["-0.4 m/s", "0.4 m/s"]
[start]
inherit = "omega"
directions = ["upward", "downward"]
[history]
cycles = 2
samples_per_cycle = 12
[protocol]
points = 6
impact_points = 4
max_cycles = 200
exponent_cycles = 64
[[branches]]
name = "b"
along = "omega"
at = { omega = "39 rad/s" }
from = "38 rad/s"
to = "41 rad/s"
[[figures]]
name = "bifurcation"
kind = "bifurcation"
[[figures]]
name = "impacts"
kind = "bifurcation"
of = ["impact_phase", "largest_multiplier", "cycles"]
branches = false
[[figures]]
name = "map"
kind = "map"
[[figures]]
name = "periods"
kind = "map"
of = ["period"]
[[figures]]
name = "outcomes"
kind = "map"
of = ["outcome"]
[[figures]]
name = "trade"
kind = "trade-off"
[[figures]]
name = "other-trade"
kind = "trade-off"
of = ["work_net"]
[[figures]]
name = "history"
kind = "history"
at = { omega = "39 rad/s", start_y1 = "0.4 m/s" }
[[figures]]
name = "portrait"
kind = "phase-portrait"
at = { omega = "39 rad/s", start_y1 = "0.4 m/s" }
"#;

#[test]
fn what_a_figure_leaves_unread_does_not_change_it() {
    let dir = WorkDir::new();
    dir.put("a.toml", STUDY);
    dir.run(&["sweep", "a.toml", "--no-figures"]).done();
    dir.run(&["continue", "a.toml", "--no-figures"]).done();
    let archive = store::open(&dir.path("results/a/a.h5")).expect("a result");
    let whole = archive.dataset(|_, _| true).expect("all of it");
    let study = Study::parse("a.toml", STUDY).unwrap_or_else(|faults| panic!("{faults}"));
    let mut left = 0;
    for drawing in &study.drawings {
        let shown = variables(drawing, archive.frame().model());
        let part = archive.labelled(|name| shown.contains(name)).expect("a part of it");
        let drawn = [("whole", &whole), ("part", &part)].map(|(folder, dataset)| {
            let folder = dir.path(folder);
            draw(dataset, drawing, &into(&folder, &[Format::Svg]))
                .unwrap_or_else(|error| panic!("{}: {error}", drawing.name));
            fs::read(folder.join(format!("{}.svg", drawing.name))).expect("a figure")
        });
        assert!(drawn[0] == drawn[1], "{} differs", drawing.name);
        left += archive.variables().filter(|(name, _)| !shown.contains(*name)).count();
    }
    assert!(left > 100, "{left} variables were left unread");
}
