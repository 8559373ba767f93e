//! What the program says of keys of a study, outputs, units and pages of the book, without a file of the repository beside it.

use super::program::WorkDir;

/// What `capsulemap help` prints of these words.
fn help(words: &[&str]) -> String {
    WorkDir::new().run(&[&["help"], words].concat()).done().out
}

#[test]
fn keys_outputs_units_and_pages_are_told() {
    for (words, told) in [
        (&[][..], &["Usage: capsulemap", "explore", "help"][..]),
        (&["sweep"], &["Usage: capsulemap sweep", "--task"]),
        (&["study"], &["`[basin]`\n  early_decision\n", "`[[axes]]`", "  base_samples"]),
        (
            &["study", "refine"],
            &[
                "refine, of `[basin]`",
                "refine, of `[map]`",
                "`refine`. Coarse cells",
                "default: `false`",
            ],
        ),
        (&["study", "basin.refine"], &["refine, of `[basin]`"]),
        (&["study", "[basin]"], &["`manifolds`", "the boundary as curves"]),
        (&["study", "rate"], &["rate, of Ramps", "0.5 rad/s^2"]),
        (&["output", "power"], &["unit: W", "definition: `work_positive` over the period"]),
        (&["output"], &["progression_speed [m/s]\n", "lyapunov_exponent [1/s]\n"]),
        (&["unit"], &["a frequency in rad/s, Hz, kHz, rpm, rad/sec\n", "a length in m, mm"]),
        (&["book"], &["systems", "study/basin", "Glossary"]),
        (&["book", "systems"], &["[system.parameters]"]),
    ] {
        let text = help(words);
        for told in told {
            assert!(text.contains(told), "{words:?}: {told}\n{text}");
        }
    }
    // A key of one table alone.
    assert!(!help(&["study", "basin.refine"]).contains("[map]"));
    // Links and pictures are for browsers.
    for page in ["basins", "branches", "gallery", "study/figures"] {
        let text = help(&["book", page]);
        assert!(!text.contains("](") && text.lines().count() > 20, "{text}");
    }
}

#[test]
fn every_row_of_a_table_of_keys_is_found_by_its_names() {
    let all = help(&["study"]);
    let keys: Vec<&str> = all.lines().filter_map(|line| line.strip_prefix("  ")).collect();
    assert!(keys.len() > 80, "{}", keys.len());
    for key in keys.iter().flat_map(|line| line.split(", ")).step_by(9) {
        assert!(help(&["study", key]).contains(key), "{key}");
    }
}

#[test]
fn unknown_topics_say_what_there_is() {
    let work = WorkDir::new();
    for (words, told) in [
        (
            &["sweeep"][..],
            "unknown topic \"sweeep\"; did you mean \"sweep\"? (allowed: a command; study, output, unit or book and a name; answers to errors: capsulemap help book errors)",
        ),
        (&["study", "refin"], "unknown key or table of a study \"refin\""),
        (&["output", "speed"], "unknown output \"speed\""),
        (
            &["unit", "furlong"],
            "unknown unit \"furlong\" (allowed: capsulemap help unit lists them)",
        ),
        (&["book", "pages"], "unknown page \"pages\""),
        (&["sweep", "join"], "one topic at a time"),
    ] {
        work.run(&[&["help"], words].concat()).refused(&[told]);
    }
}
