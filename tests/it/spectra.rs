//! What is said of spectra: a transient in them, and what they can show.

use std::fs;

use super::program::WorkDir;

/// A case whose history begins at its start, before it has settled, or where it has settled.
fn swept(from: &str) -> WorkDir {
    let work = WorkDir::new();
    work.put(
        "s.toml",
        format!(
            "[parameters]\np_d = \"4 N\"\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\nomega = \"30 rad/s\"\n\
             [history]\ncycles = 20\nfrom = \"{from}\"\n"
        ),
    );
    work.run(&["sweep", "s.toml", "--output", "s.h5"]).done();
    work
}

#[test]
fn a_spectrum_with_a_transient_in_it_says_so() {
    for (from, has_one) in [("start", true), ("attractor", false)] {
        let work = swept(from);
        let ran = work.run(&["figure", "s.h5", "--kind", "spectrum", "--formats", "svg"]).done();
        let told = "begins at the start of the case, so that the spectrum has the transient in it";
        assert_eq!(ran.err.contains(told), has_one, "{from}: {}", ran.err);
        assert!(!fs::read_to_string(work.path("spectrum.svg")).expect("a figure").is_empty());
    }
}

#[test]
fn what_is_no_signal_is_refused_with_what_can_be_shown() {
    let work = swept("attractor");
    let draw = |kind: &str, of: &str| work.run(&["figure", "s.h5", "--kind", kind, "--of", of]);
    for name in ["velocities", "power", "omega"] {
        let said = format!(
            "a spectrum cannot show `{name}`; it can show history_x1, history_x2, history_r"
        );
        draw("spectrum", name).refused(&[&said]);
    }
    draw("phase-portrait", "history_r,power")
        .refused(&["a phase-portrait cannot show `power`; it can show history_x1, history_x2"]);
}
