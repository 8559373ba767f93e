//! Only the command line writes to the terminal.

use super::{LIBRARY, Source, assert_clean, identifiers, sources};

/// What writes to the terminal, which `cli` and `main.rs` alone may.
const PRINTS: [&str; 4] = ["print", "println", "eprint", "eprintln"];

/// What a file writes to the terminal that may not.
fn print_faults(source: &Source) -> Vec<String> {
    // What a macro does is done while the program is compiled.
    let is_macro = source.path.starts_with("crates/commit/");
    let is_library = source.inside().is_some() && source.path != "src/main.rs";
    if is_macro || !is_library || source.floor() == Some("cli") {
        return Vec::new();
    }
    let is_macro = |word: &str, after: &str| PRINTS.contains(&word) && after.starts_with('!');
    let is_stream = |word: &str| ["stdout", "stderr"].contains(&word);
    let found = identifiers(&source.code)
        .filter(|(_, word, after)| is_macro(word, after) || is_stream(word))
        .map(|(_, word, _)| format!("{}: {word} outside cli", source.path));
    found.collect()
}

#[test]
fn only_the_command_line_prints() {
    assert_clean(sources(&LIBRARY).iter().flat_map(print_faults).collect());
}

#[test]
fn what_prints_outside_the_command_line_is_seen() {
    let all =
        ["print!(\"a\")", "println!()", "eprint!(\"a\")", "eprintln!(\"{a}\")", "io::stderr()"];
    for code in all {
        for path in ["src/campaign/a.rs", "src/lib.rs"] {
            assert_eq!(print_faults(&Source::new(path, code)).len(), 1, "{path}: {code}");
        }
        for path in ["src/cli/a.rs", "src/main.rs", "tests/it/a.rs"] {
            assert_clean(print_faults(&Source::new(path, code)));
        }
    }
    for code in ["// println!()", "let a = \"eprintln!\";", "fn print(text: &str) {}", "print(a)"] {
        assert_clean(print_faults(&Source::new("src/campaign/a.rs", code)));
    }
}
