//! Exports in the forms of instruments and programs: each is read to the numbers of a plain file, or refused with what helps.

use std::fs;
use std::path::PathBuf;

use capsulemap::experiment::{Column, FileForm, Presence, Recording, decoded};
use capsulemap::quantity::Dimension;

const KNOWN: [Column; 3] = [
    Column { name: "t", dimension: Dimension::Time, presence: Presence::Required },
    Column { name: "x2", dimension: Dimension::Length, presence: Presence::Optional },
    Column { name: "r", dimension: Dimension::Length, presence: Presence::Optional },
];
/// Sensors of 2.5 mm and of 2 mm for a volt.
const VOLTS: &str = "x2=CH1:2.5 mm, r=CH2:2 mm";

fn folder() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests", "exports"].iter().collect()
}

/// Reads an export with the options `--columns` and `--interval`; the error has all faults.
fn read(file: &str, columns: &str, interval: Option<f64>) -> Result<Recording, String> {
    let mut form = FileForm { interval, ..FileForm::default() };
    if !columns.is_empty() {
        form.name_columns(columns)?;
    }
    assert_eq!(form.faults(&KNOWN), Vec::<String>::new());
    let bytes = fs::read(folder().join(file)).expect("an export");
    let text = decoded(bytes).expect("a text");
    Recording::read_as(file, &text, &KNOWN, 16, Some(&form)).map_err(|it| it.to_string())
}

/// What an export needs to be read, and whether r is in it.
struct Export {
    file: &'static str,
    columns: &'static str,
    interval: Option<f64>,
    has_r: bool,
}

const fn export(file: &'static str, columns: &'static str) -> Export {
    Export { file, columns, interval: None, has_r: true }
}

const fn without_r(file: &'static str, columns: &'static str) -> Export {
    Export { has_r: false, ..export(file, columns) }
}

const fn at_interval(file: &'static str, columns: &'static str) -> Export {
    Export { interval: Some(1e-3), ..export(file, columns) }
}

const READ: [Export; 24] = [
    export("labview-lvm.lvm", "x2=Untitled, r=Untitled 1"),
    export("labview-lvm-decimal-comma.lvm", "x2=Untitled, r=Untitled 1"),
    at_interval("labview-lvm-no-x-column.lvm", "x2=Untitled, r=Untitled 1"),
    without_r("tektronix-tds-no-header.csv", "t=#4:s, x2=#5:2.5 mm"),
    export("tektronix-mso.csv", VOLTS),
    export("keysight-infiniivision.csv", "x2=1:2.5 mm, r=2:2 mm"),
    at_interval("agilent-34972a-scan.csv", "x2=101 (VDC):2.5 mm, r=102 (VDC):2 mm"),
    export("dspace-controldesk.csv", ""),
    export("matlab-writetable.csv", "t=t:s, x2=x2:mm, r=r:mm"),
    export("matlab-writetable-units-in-names.csv", ""),
    export("pasco-capstone.csv", "x2=Position (mm) Run #1, r=Relative"),
    without_r("pasco-capstone-two-runs.csv", "t=Time (s) Run #2, x2=Position (mm) Run #2"),
    export("excel-english.csv", ""),
    export("excel-german-latin1.csv", ""),
    export("excel-unicode-text.txt", ""),
    export("picoscope.csv", "x2=Channel A:2.5 mm, r=Channel B:2 mm"),
    export("hbm-catman-ascii.txt", "x2=Weg Kapsel, r=Weg relativ"),
    export("rigol-ds1000z.csv", VOLTS),
    without_r("lecroy-waverunner.csv", "t=Time:s, x2=Ampl:2.5 mm"),
    without_r("vernier-logger-pro.csv", "t=Latest: Time (s), x2=Latest: Position (m)"),
    without_r("polytec-vibsoft.txt", "x2=Displacement"),
    export("numpy-savetxt.csv", ""),
    export("keyence-lk-navigator.csv", "x2=OUT1, r=OUT2"),
    export("arduino-serial-monitor.txt", "t=#1:us, x2=#2:mm, r=#3:mm"),
];

/// Asserts that a column has the numbers of the plain file in its rows.
fn assert_same(file: &str, name: &str, found: &Recording, plain: &Recording) {
    let sensed = found.sensed(name).unwrap_or_else(|| panic!("{file}: no {name}"));
    let expected = plain.required(name);
    for (row, value) in sensed.rows.iter().zip(&sensed.values) {
        let apart = (value - expected[*row]).abs();
        assert!(apart <= 1e-12, "{file}: {name} in row {row}: {value} {}", expected[*row]);
    }
    let missing = if file == "matlab-writetable.csv" && name == "r" { 2 } else { 0 };
    assert_eq!(sensed.values.len() + missing, expected.len(), "{file}: {name}");
}

#[test]
fn exports_of_instruments_are_read_to_the_numbers_of_a_plain_file() {
    let plain = read("plain.csv", "", None).expect("plain");
    assert_eq!(plain.rows(), 24);
    for Export { file, columns, interval, has_r } in READ {
        let found = read(file, columns, interval).unwrap_or_else(|why| panic!("{file}: {why}"));
        let names = if has_r { &["t", "x2", "r"][..] } else { &["t", "x2"] };
        names.iter().for_each(|name| assert_same(file, name, &found, &plain));
        assert_eq!(found.sensed("r").is_some(), has_r, "{file}");
    }
}

#[test]
fn what_was_not_in_the_table_is_told() {
    for (file, columns, note) in [
        ("rigol-ds1000z.csv", VOLTS, "0.001 s apart, as line 1 says (Increment)"),
        ("keyence-lk-navigator.csv", "x2=OUT1", "0.001 s apart, as line 3 says (Sampling cycle)"),
        (
            "matlab-writetable.csv",
            "t=t:s,x2=x2:mm,r=r:mm",
            "r: 2 cells are empty or NaN, the first in line 5",
        ),
    ] {
        let found = read(file, columns, None).expect(file);
        assert!(found.notes.iter().any(|it| it.contains(note)), "{file}: {:?}", found.notes);
    }
}

#[test]
fn an_export_that_needs_an_option_is_refused_with_its_line_and_the_option() {
    for (file, columns, parts) in [
        (
            "labview-lvm-no-x-column.lvm",
            "x2=Untitled",
            &["line 24: t: has no value", "--interval", "in 24 rows"][..],
        ),
        (
            "agilent-34972a-scan.csv",
            "t=Time:s, x2=101 (VDC):mm",
            &["line 6", "is a time of day", "--interval"],
        ),
        ("matlab-writetable.csv", "", &["line 1", "\"t\": expected a time", "--columns \"t=t:s\""]),
        (
            "pasco-capstone-two-runs.csv",
            "",
            &["line 1", "the column t stands twice", "--columns \"t=Time (s) Run #1\""],
        ),
        (
            "excel-german-thousands.csv",
            "",
            &["separates thousands", "export the numbers without that"],
        ),
        (
            "lecroy-waverunner.csv",
            "x2=Ampl:2.5 mm",
            &["line 5", "\"Time\": expected a time", "--columns \"t=Time:s\""],
        ),
        (
            "vernier-logger-pro.csv",
            "x2=Latest: Position (m)",
            &["line 1", "no column t", "--columns \"t=NAME:s\"", "Latest: Time (s)"],
        ),
        ("arduino-serial-monitor.txt", "", &["line 1", "no column t", "--columns"]),
        (
            "tektronix-mso.csv",
            "x2=CH3:mm",
            &["line 14", "--columns x2=CH3:mm: there is no such column", "TIME, CH1, CH2"],
        ),
        (
            "tektronix-mso.csv",
            "x2=CH1",
            &["line 14", "\"CH1\": expected a length", "--columns \"x2=CH1:m\""],
        ),
        ("ni-signalexpress-utf16be.txt", "", &["line 1", "no column t", "Time - Displacement"]),
    ] {
        let told = read(file, columns, None).expect_err(file);
        for part in parts {
            assert!(told.contains(part), "{file}: {part}\n{told}");
        }
    }
    let columns =
        "t=Time - Displacement:s, x2=Amplitude - Displacement:mm, r=Amplitude - Relative:mm";
    let found = read("ni-signalexpress-utf16be.txt", columns, None).expect("read");
    let plain = read("plain.csv", "", None).expect("plain");
    ["t", "x2", "r"].iter().for_each(|name| assert_same("ni", name, &found, &plain));
}
