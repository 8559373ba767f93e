//! The command line: what it prints for other programs, and what it says of mistakes.

use std::f64::consts::PI;

use capsulemap::capsule::{Output, Parameter, Parameters, State, settle};
use capsulemap::orbit::Protocol;
use serde_json::Value;

use super::program::{FIG5, Ran, WorkDir};

const COMMANDS: [&str; 12] = [
    "simulate",
    "sweep",
    "join",
    "status",
    "verify",
    "continue",
    "figure",
    "tradeoff",
    "sensitivity",
    "report",
    "inspect",
    "completions",
];

fn simulate(more: &[&str]) -> Ran {
    let mut arguments = vec!["simulate", "--json"];
    arguments.extend(more);
    WorkDir::new().run(&arguments)
}

fn fig5(more: &[&str]) -> Value {
    let case = ["--omega", "77.91 rad/s", "--p-d", "4 N", "--k2", "2.42 kN/m", "--delta", "3.5 mm"];
    simulate(&[&case, more].concat()).json()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

fn list<'v>(object: &'v Value, key: &str) -> &'v Vec<Value> {
    object[key].as_array().unwrap_or_else(|| panic!("no list under {key}"))
}

#[test]
fn fig5_prints_the_published_numbers() {
    let ran = fig5(&["--cycles", "3"]);
    let orbit = &ran["orbit"];
    assert_eq!(orbit["outcome"], "periodic");
    assert_eq!(orbit["period"], 1);
    assert_eq!(format!("{:.6}", number(&orbit["progression_speed"]) * 1e3), "10.298005");
    assert_eq!(number(&orbit["impacts_per_cycle"]), 1.0);
    assert_eq!(format!("{:.5}", number(&orbit["work_net"]) * 1e3), "25.39085");
}

#[test]
fn the_summary_says_what_the_numbers_do_not() {
    let said = |more: &[&str]| {
        let arguments = [&["simulate", "--cycles", "0"], more].concat();
        WorkDir::new().run(&arguments).out
    };
    let frictionless = ["--omega", "268 rad/s", "--p-d", "12 N", "--set", "mu_d=0"];
    let text = said(&[&frictionless[..], &["--set", "mu_s=0.1", "--set", "c=0.1"]].concat());
    assert!(
        text.contains(
            "one of a family of periodic orbits along (omega r, y1, y2) = (0, 0.7071, 0.7071)"
        ),
        "{text}"
    );
    let text = said(&["--p-d", "0.5 N"]);
    assert!(text.contains("the capsule sticks at the section"), "{text}");
    let coasting =
        ["--resistance", "medium", "--set", "c1=0.01", "--p-d", "0", "--start", "y2=0.5"];
    let text = said(&[&coasting[..], &["--max-cycles", "200"]].concat());
    assert!(text.contains("undecided: the motion approaches an orbit too slowly"), "{text}");
}

#[test]
fn every_key_of_the_contract_is_there() {
    let ran = fig5(&["--cycles", "2"]);
    for symbol in ["m1", "m2", "k1", "c", "k2", "delta", "p_d", "omega", "mu_s", "mu_d", "v_s", "g"]
    {
        assert!(ran["parameters"][symbol].is_number(), "{symbol}");
    }
    assert_eq!(number(&ran["parameters"]["k2"]), 2420.0);
    assert_eq!(number(&ran["parameters"]["delta"]), 0.0035);
    let section = list(&ran, "section");
    assert_eq!(section.len(), 3);
    for key in [
        "n",
        "t",
        "r",
        "y1",
        "x2",
        "y2",
        "work_net",
        "work_positive",
        "work_absolute",
        "work_actuator",
        "friction_loss",
        "damper_loss",
        "impacts",
    ] {
        assert!(section.iter().all(|sample| sample[key].is_number()), "{key}");
    }
    for output in Output::ALL.iter().filter(|it| !it.is_optional()) {
        assert!(ran["orbit"][output.name()].is_number(), "{}", output.name());
    }
    for key in ["outcome", "period", "energy_residual", "momentum_residual", "grazing_margin"] {
        assert!(!ran["orbit"][key].is_null(), "{key}");
    }
}

#[test]
fn sections_events_and_sums_agree_with_each_other() {
    for more in [
        &["--cycles", "12"][..],
        &["--cycles", "12", "--friction-switching", "as-printed"],
        &["--cycles", "12", "--omega", "20.73", "--k2", "18960", "--delta", "1.5e-3"],
        &["--cycles", "12", "--start", "r=-2mm,y1=0.3,x2=1 m,y2=-0.2", "--phase", "90 deg"],
    ] {
        let ran = simulate(more).json();
        let period = 2.0 * PI / number(&ran["parameters"]["omega"]);
        let section = list(&ran, "section");
        for (n, sample) in section.iter().enumerate() {
            assert_eq!(sample["n"], n);
            assert_eq!(number(&sample["t"]), n as f64 * period, "{more:?}");
        }
        let events = list(&ran, "events");
        let times: Vec<f64> = events.iter().map(|event| number(&event["t"])).collect();
        assert!(times.is_sorted(), "{more:?}");
        let delta = number(&ran["parameters"]["delta"]);
        for event in events {
            let [r, y1, y2] = ["r", "y1", "y2"].map(|name| number(&event[name]));
            // Relative to displacements of millimetres and velocities below a metre per second.
            let (place, rest) = match event["kind"].as_str() {
                Some("contact-closed" | "contact-opened") => (r - delta, 0.0),
                // The equation as printed holds the capsule even at speed.
                _ if more.contains(&"as-printed") => (0.0, 0.0),
                _ => (0.0, y2),
            };
            assert!(place.abs() < 1e-12 && rest.abs() < 1e-9 && y1.is_finite(), "{event}");
        }
        let kinds = [
            "contact-closed",
            "contact-opened",
            "slip-forward",
            "slip-backward",
            "stick",
            "reversal",
        ];
        for event in events {
            assert!(kinds.iter().any(|kind| event["kind"] == *kind), "{event}");
        }
        for sample in section {
            let (end, impacts) = (number(&sample["t"]), number(&sample["impacts"]));
            let closed = events.iter().filter(|event| event["kind"] == "contact-closed");
            let before = closed.filter(|event| number(&event["t"]) <= end).count();
            assert_eq!(impacts, before as f64, "{more:?}");
        }
        for key in ["work_positive", "work_absolute", "friction_loss", "damper_loss", "impacts"] {
            let sums: Vec<f64> = section.iter().map(|sample| number(&sample[key])).collect();
            assert!(sums[0] == 0.0 && sums.is_sorted(), "{key}: {sums:?}");
        }
    }
}

#[test]
fn the_start_is_the_first_section_point() {
    let ran = fig5(&["--start", "r=-2 mm, y1=0.1, x2=-7e-3, y2=10 mm/s", "--cycles", "0"]);
    let section = list(&ran, "section");
    assert_eq!(section.len(), 1);
    let found = ["r", "y1", "x2", "y2"].map(|key| number(&section[0][key]));
    assert_eq!(found, [-0.002, 0.1, -7e-3, 0.01]);
    assert!(list(&ran, "events").is_empty());
}

#[test]
fn plain_numbers_are_in_si_and_every_parameter_can_be_set() {
    for &parameter in Parameter::ALL {
        let text = format!("{}=0.625", parameter.symbol());
        let ran = simulate(&["--set", &text, "--cycles", "0", "--max-cycles", "3"]).json();
        assert_eq!(number(&ran["parameters"][parameter.symbol()]), 0.625, "{text}");
    }
    let heavy = simulate(&["--set", "m1=1e12", "--cycles", "1", "--max-cycles", "2"]).json();
    assert_eq!(number(&heavy["parameters"]["m1"]), 1e12);
    let hertz = simulate(&["--omega", "10 Hz", "--cycles", "0"]).json();
    assert_eq!(number(&hertz["parameters"]["omega"]), 10.0 * 2.0 * PI);
}

#[test]
fn the_orbit_is_that_of_the_library_bit_for_bit() {
    let ran = simulate(&["--cycles", "0"]).done();
    let orbit = settle(&Parameters::default(), 0.0, State::default(), &Protocol::default());
    for &output in Output::ALL.iter().filter(|it| !it.is_optional()) {
        let printed = ran.printed(output.name());
        assert_eq!(printed.to_bits(), orbit.outputs[output].to_bits(), "{}", output.name());
    }
}

#[test]
fn degenerate_and_failing_cases_print_json_all_the_same() {
    for more in [
        &["--set", "mu_s=0.66", "--set", "mu_d=0.66"][..],
        &["--p-d", "0"],
        &["--k2", "0"],
        &["--delta", "0"],
        &["--delta", "-1 mm"],
        &["--set", "g=0"],
        &["--set", "mu_s=0", "--set", "mu_d=0"],
        &["--set", "k1=0", "--set", "c=0", "--k2", "0"],
        &["--max-cycles", "0"],
        &["--resistance", "medium"],
        &["--start", "r=1e300"],
        &["--set", "c=1e12"],
    ] {
        for reading in ["filippov", "as-printed"] {
            let usual = ["--max-cycles", "50", "--cycles", "2", "--friction-switching", reading];
            let usual = if more[0] == "--max-cycles" { &usual[2..] } else { &usual[..] };
            let ran = simulate(&[more, usual].concat()).json();
            assert!(ran["orbit"]["outcome"].is_string(), "{more:?}");
            assert!(!list(&ran, "section").is_empty(), "{more:?}");
        }
    }
    let failed = simulate(&["--start", "r=1e300"]).json();
    assert_eq!(failed["orbit"]["outcome"], "failed");
    assert!(failed["failure"].is_string() && failed["orbit"]["failure"].is_string());
    assert!(failed["orbit"]["progression_speed"].is_null());
}

#[test]
fn wrong_units_and_names_are_all_reported_at_once() {
    simulate(&["--omega", "4 N", "--k2", "soft", "--delta", "3 furlongs", "--set", "mud=1"])
        .refused(&[
            "--omega: \"4 N\" is a force; expected a frequency in rad/s, Hz",
            "--k2: \"soft\" does not begin with a number; expected a stiffness in N/m",
            "--delta: \"3 furlongs\" has the unknown unit \"furlongs\"; expected a length in m",
            "--set: unknown parameter \"mud\"; did you mean \"mu_d\"?",
        ]);
    simulate(&["--start", "r=1,q=2,y1", "--phase", "1 m", "--set", "m1", "--tolerance", "1"])
        .refused(&[
            "--start: unknown coordinate \"q\"",
            "--start y1: expected NAME=VALUE",
            "--phase: \"1 m\" is a length",
            "--set m1: expected NAME=VALUE",
            "--tolerance 1: must lie between",
        ]);
    simulate(&["--omega", "5", "--set", "omega=6", "--start", "r=1,r=2"])
        .refused(&["--set omega: omega is given twice", "--start: r is given twice"]);
}

#[test]
fn impossible_parameters_are_all_named() {
    let set = ["m1=-1", "m2=0", "k1=-1", "c=-1e-300", "mu_s=-2", "mu_d=-0.1", "v_s=0", "g=-9.81"];
    let mut arguments = vec!["--omega", "0", "--p-d", "-4 N", "--k2", "nan", "--delta", "inf"];
    arguments.extend(set.iter().flat_map(|text| ["--set", *text]));
    // A value that looks like an option is joined to its own.
    let arguments: Vec<String> =
        arguments.chunks(2).map(|pair| format!("{}={}", pair[0], pair[1])).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    simulate(&arguments).refused(&[
        "m1 (internal mass) = -1 kg: must be a finite number above zero",
        "m2 (mass of the capsule) = 0 kg",
        "k1 (stiffness between mass and capsule) = -1 N/m",
        "c (damping between mass and capsule)",
        "mu_s (static friction coefficient) = -2",
        "mu_d (dynamic friction coefficient) = -0.1",
        "v_s (Stribeck velocity) = 0 m/s",
        "g (acceleration of gravity) = -9.81",
        "omega (frequency of the drive) = 0 rad/s",
        "p_d (amplitude of the drive) = -4 N",
        "--k2: NaN is not a finite number",
        "--delta: inf is not a finite number",
    ]);
    for text in ["omega=-3", "omega=-inf", "omega=nan", "omega=1e999"] {
        simulate(&["--set", text]).refused(&["omega"]);
    }
}

#[test]
fn every_command_explains_itself_by_examples() {
    let dir = WorkDir::new();
    assert!(dir.run(&["--help"]).done().out.contains("Exit codes"));
    for command in COMMANDS {
        let ran = dir.run(&[command, "--help"]).done();
        assert!(ran.out.contains("Examples:\n  capsulemap"), "{command}: {}", ran.out);
    }
    dir.run(&["swep"]).refused(&["sweep"]);
    dir.run(&[]).refused(&["Usage"]);
}

/// Words that were broken into lines in the source and again on the screen have short lines between long ones.
#[test]
fn help_is_wrapped_once() {
    let dir = WorkDir::new();
    for command in COMMANDS.iter().map(|it| vec![*it, "--help"]).chain([vec!["--help"]]) {
        for columns in [60, 80, 100] {
            let asked = dir.command(&command).env("COLUMNS", columns.to_string()).output();
            let ran = Ran::from(asked.expect("the program starts")).done();
            let (_, last) = ran.out.split_once("Examples:\n").expect("it has examples");
            let (examples, words) = last.split_once("\n\n").unwrap_or((last, ""));
            let split = |line: &str| {
                !["  capsulemap", "  watch", "    "].iter().any(|it| line.starts_with(it))
            };
            assert!(columns == 60 || !examples.lines().any(split), "{command:?}: {examples}");
            for (line, next) in words.lines().zip(words.lines().skip(1)) {
                let word = next.split(' ').next().unwrap_or("");
                let fits = line.len() + 1 + word.len() <= columns;
                assert!(line.is_empty() || next.is_empty() || !fits, "{columns}: {line} / {next}");
            }
        }
    }
}

#[test]
fn completions_name_every_command() {
    let dir = WorkDir::new();
    for shell in ["bash", "zsh", "fish"] {
        let ran = dir.run(&["completions", shell]).done();
        assert!(COMMANDS.iter().all(|command| ran.out.contains(command)), "{shell}");
        assert!(ran.out.contains("friction-switching"), "{shell}");
    }
    dir.put("complete.bash", dir.run(&["completions", "bash"]).out);
    assert_eq!(dir.shell("bash -n complete.bash").code, 0);
    dir.run(&["completions", "cmd"]).refused(&["cmd", "bash"]);
}

#[test]
fn a_reader_that_goes_away_is_no_fault() {
    let dir = WorkDir::new();
    for command in
        ["simulate --cycles 3000 --json", "simulate --cycles 3000", "completions zsh", "--help"]
    {
        let ran = dir
            .shell(&format!("\"$0\" {command} | head -n 1 > /dev/null; exit ${{PIPESTATUS[0]}}"));
        assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{command}");
    }
    dir.put("fig5.toml", FIG5);
    let ran = dir.shell("\"$0\" sweep fig5.toml 2>&1 >/dev/null | true; exit ${PIPESTATUS[0]}");
    assert_eq!(ran.code, 0, "{}", ran.err);
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_standard_output_is_a_fault_of_the_machine() {
    let ran = WorkDir::new().shell("\"$0\" simulate --json > /dev/full");
    assert_eq!(ran.code, 3, "{}", ran.err);
    assert!(ran.err.contains("cannot write to standard output: No space left"), "{}", ran.err);
    // Nor does a message to a closed pipe make it panic.
    assert_eq!(WorkDir::new().shell("\"$0\" inspect nothing 2> /dev/full").code, 2);
}
