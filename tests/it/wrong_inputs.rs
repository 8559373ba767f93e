//! A table of wrong inputs: each is refused with the file, the line or the option, the key, the value and what is allowed.

use super::program::WorkDir;

/// What stands in the studies below for the parameters of a capsule, and for an axis; with `@@` the frequency is held, too.
const PARAMETERS: &str = "[parameters]\np_d = \"4 N\"\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\n";
const AXIS: &str =
    "[[axes]]\nname = \"omega\"\nfrom = \"20 rad/s\"\nto = \"30 rad/s\"\npoints = 5\n";

/// Studies with what is said of them.
#[rustfmt::skip]
const STUDIES: &[(&str, &[&str])] = &[
    ("@~[[axes]]\nname = \"p_d\"\nvalues = [\"1 N\", \"2 N\"]\n[map]\nboundries = true\n", &["map.refine: missing; expected a table of outputs", "map.boundries: unknown key \"boundries\"; did you mean \"boundaries\"?"]),
    ("@[[axes]]\nname = \"line\"\nfrom = { omega = \"1 rad/s\", delta = \"1 mm\" }\nto = { omega = \"2 rad/s\", delta = \"2 mm\" }\npoints = 5\n[[figures]]\nname = \"a\"\nkind = \"section\"\nat = { line = 300 }\n", &["figures[1].at.line: expected a place along the path, counted from 0, its first, to 4, its last, found 300"]),
    ("[parameters\n", &["line 1: unclosed table, expected `]`"]),
    ("@@m1 = 0.1\n", &["line 6: parameters.m1: 0.1 has no unit; expected a mass in kg, g, mg"]),
    ("@@m1 = \"0.1 N\"\n", &["line 6: parameters.m1: \"0.1 N\" is a force; expected a mass in kg, g, mg"]),
    ("@@m1 = \"-1 kg\"\n", &["line 6: parameters.m1: -1 kg must be a finite number above zero"]),
    ("@@m1 = \"0 kg\"\n", &["line 6: parameters.m1: 0 kg must be a finite number above zero"]),
    ("@@m1 = \"x kg\"\n", &["line 6: parameters.m1: \"x kg\" does not begin with a number; expected a mass in kg"]),
    ("@@mass = \"1 kg\"\n", &["line 6: parameters.mass: unknown key \"mass\"", "(allowed: mu_s"]),
    ("@@mu_s = \"0.4 N\"\n", &["line 6: parameters.mu_s: \"0.4 N\" is a force; expected a plain number"]),
    ("@@c = \"-1 N s/m\"\n", &["line 6: parameters.c: -1 N s/m must be a finite number, zero or above"]),
    ("@@v_s = \"0 m/s\"\n", &["line 6: parameters.v_s: 0 m/s must be a finite number above zero"]),
    ("@@g = \"inf m/s2\"\n", &["line 6: parameters.g: inf m/s2 must be a finite number, zero or above"]),
    ("@@resistance = \"dry\"\n", &["line 6: parameters.resistance: unknown resistance \"dry\" (allowed: coulomb-stribeck, coulomb, medium)"]),
    ("@@friction_switching = \"printed\"\n", &["line 6: parameters.friction_switching: unknown reading \"printed\"; did you mean \"as-printed\"? (allowed: filippov, as-printed)"]),
    ("@@resistance = 3\n", &["line 6: parameters.resistance: expected a text in quotes, found 3"]),
    ("@", &["parameters.omega: missing; expected a value for the frequency of the drive here or an axis"]),
    ("@@~", &["line 5: parameters.omega: is given here and on an axis"]),
    ("@[[axes]]\nname = \"omga\"\nfrom = \"1 rad/s\"\nto = \"2 rad/s\"\npoints = 3\n", &["line 6: axes[1].name: unknown axis \"omga\"; did you mean \"omega\"?", "(allowed: omega, m1, m2"]),
    ("@[[axes]]\nname = \"omega\"\nfrom = \"1 rad/s\"\nto = \"2 rad/s\"\n", &["line 5: axes[1].points: missing; expected from, to and points, or a list of values"]),
    ("@[[axes]]\nname = \"omega\"\nfrom = \"1 rad/s\"\nto = \"1 rad/s\"\npoints = 5\n", &["line 8: axes[1].to: \"1 rad/s\" is the same as `from`; expected another value"]),
    ("@[[axes]]\nname = \"omega\"\nfrom = \"0 rad/s\"\nto = \"1 rad/s\"\npoints = 5\n", &["line 7: axes[1].from: 0 rad/s must be a finite number above zero"]),
    ("@[[axes]]\nname = \"omega\"\nfrom = \"1 N\"\nto = \"2 rad/s\"\npoints = 5\n", &["line 7: axes[1].from: \"1 N\" is a force; expected a frequency in rad/s, Hz"]),
    ("@[[axes]]\nname = \"omega\"\nfrom = \"1 rad/s\"\nto = \"2 rad/s\"\npoints = 2.5\n", &["line 9: axes[1].points: expected a whole number, 1 to 10000000, found 2.5"]),
    ("@[[axes]]\nname = \"omega\"\nfrom = \"1 rad/s\"\nto = \"2 rad/s\"\npoints = 5\nspacing = \"log\"\n", &["line 10: axes[1].spacing: unknown spacing \"log\"; did you mean \"logarithmic\"? (allowed: linear, logarithmic)"]),
    ("@[[axes]]\nname = \"omega\"\nvalues = []\n", &["line 7: axes[1].values: expected at least one value"]),
    ("@[[axes]]\nname = \"omega\"\nvalues = [\"2 rad/s\", \"2 rad/s\"]\n", &["line 7: axes[1].values[2]: 2, in SI units, is given twice"]),
    ("@[[axes]]\nname = \"omega\"\nvalues = [\"2 rad/s\", 3]\n", &["line 7: axes[1].values[2]: 3 has no unit; expected a frequency in rad/s, Hz"]),
    ("@[[axes]]\nname = \"omega\"\nvalues = \"2 rad/s\"\n", &["line 7: axes[1].values: expected a list, found \"2 rad/s\""]),
    ("@~~", &["line 11: axes[2].name: a second axis \"omega\"; each is given once"]),
    ("@[[axes]]\nfrom = \"1 rad/s\"\nto = \"2 rad/s\"\npoints = 5\n", &["line 5: axes[1].name: missing; expected a parameter, start_r"]),
    ("@[[axes]]\nname = \"start_r\"\nfrom = \"1 rad\"\nto = \"2 mm\"\npoints = 5\n", &["line 7: axes[1].from: \"1 rad\" is an angle; expected a length in m, mm"]),
    ("@[[axis]]\nname = \"omega\"\n", &["line 5: axis: unknown key \"axis\"; did you mean \"axes\"? (allowed: title"]),
    ("titel = \"x\"\n@~", &["line 1: titel: unknown key \"titel\"; did you mean \"title\"? (allowed: title"]),
    ("title = 3\n@~", &["line 1: title: expected a text in quotes, found 3"]),
    ("outputs = [\"speed\"]\n@~", &["line 1: outputs[1]: unknown output \"speed\"; did you mean \"progression_speed\"? (allowed: progression_speed"]),
    ("outputs = \"power\"\n@~", &["line 1: outputs: expected a list, found \"power\""]),
    ("outputs = [\"power\", \"power\"]\n@~", &["line 1: outputs[2]: \"power\" is given twice"]),
    ("@~[start]\nr = \"1 m/s\"\n", &["line 11: start.r: \"1 m/s\" is a velocity; expected a length in m, mm"]),
    ("@~[start]\ninherit = \"k2\"\n", &["line 11: start.inherit: unknown axis of this study \"k2\" (allowed: omega)"]),
    ("@~[start]\ninherit = \"omega\"\ndirections = [\"up\"]\n", &["line 12: start.directions[1]: unknown direction \"up\"; did you mean \"upward\"? (allowed: upward, downward, afresh)"]),
    ("@~[start]\ndirections = [\"upward\"]\n", &["line 11: start.directions: needs `inherit`, the axis along which cases inherit their start"]),
    ("@~[start]\nstart_phase = \"90\"\n", &["line 11: start.start_phase: \"90\" has no unit; expected an angle in rad, deg"]),
    ("@~[start]\nx2 = \"1 m\"\n", &["line 11: start.x2: unknown key \"x2\"; did you mean \"y2\"? (allowed: phase, r, y1"]),
    ("@~[protocol]\ntolerance = 0\n", &["line 11: protocol.tolerance: 0 must lie between 1e-15 and 1e-3"]),
    ("@~[protocol]\ntolerance = 1\n", &["line 11: protocol.tolerance: 1 must lie between 1e-15 and 1e-3"]),
    ("@~[protocol]\nmax_cycles = -5\n", &["line 11: protocol.max_cycles: expected a whole number, 1 or above, found -5"]),
    ("@~[protocol]\nmax_cycles = \"many\"\n", &["line 11: protocol.max_cycles: expected a whole number, 1 or above, found \"many\""]),
    ("@~[protocol]\nexponent_cycles = 3\n", &["line 11: protocol.exponent_cycles: 3 are too few for an exponent; 16 or more, or 0"]),
    ("@~[protocol]\npoints = 99999999999\n", &["line 11: protocol.points: expected a whole number, 0 to 1000000, found 99999999999"]),
    ("@~[protocol]\naccelerate = \"yes\"\n", &["line 11: protocol.accelerate: expected true or false, found \"yes\""]),
    ("@~[protocol]\nmeasured_cycles = 0\n", &["line 11: protocol.measured_cycles: expected a whole number, 1 or above, found 0"]),
    ("@~[protocol]\nmax_period = 0\n", &["line 11: protocol.max_period: expected a whole number, 1 to 100000, found 0"]),
    ("@~[protocol]\nrecurrence = 2\n", &["line 11: protocol.recurrence: 2 must lie between 1e-15 and 1e-3"]),
    ("@~[history]\ncycles = 0\n", &["line 11: history.cycles: expected a whole number, 1 to 1000000, found 0"]),
    ("@~[history]\nsamples = 3\n", &["line 11: history.samples: unknown key \"samples\"; did you mean \"samples_per_cycle\"? (allowed: cycles, samples_per_cycle, from)"]),
    ("@~[history]\ncycles = 5\nsamples_per_cycle = 0\n", &["line 12: history.samples_per_cycle: expected a whole number, 1 to 1000000, found 0"]),
    ("@~[[branches]]\nname = \"b\"\n", &["line 10: branches[1].along: missing; expected the parameter to continue the orbit in"]),
    ("@~[[branches]]\nname = \"b\"\nalong = \"speed\"\nat = { omega = \"20 rad/s\" }\n", &["line 12: branches[1].along: unknown parameter \"speed\" (allowed: p_d"]),
    ("@~[[branches]]\nname = \"b\"\nalong = \"omega\"\nat = { omega = \"20 N\" }\n", &["line 13: branches[1].at.omega: \"20 N\" is a force; expected a frequency in rad/s"]),
    ("@~[[branches]]\nname = \"b\"\nalong = \"omega\"\nat = { omega = \"25 rad/s\" }\nfrom = \"26 rad/s\"\nto = \"28 rad/s\"\n", &["line 13: branches[1].at.omega: the first orbit, at omega = 25 rad/s, lies outside 26 to 28 rad/s"]),
    ("@~[[branches]]\nname = \"b\"\nalong = \"omega\"\nat = { omega = \"25 rad/s\" }\nlongest_step = 2\n", &["line 14: branches[1].longest_step: 2 must lie between 1e-9 and 1, a share of the range"]),
    ("@~[basin]\nrefine = true\n", &["line 11: basin.refine: true is for grids (not [draws]) whose cases differ in their starts alone"]),
    ("@~[basin]\nearly_decision = 1\n", &["line 11: basin.early_decision: 1 is for studies whose cases differ in their starts alone", "expected true or false, found 1"]),
    ("@~[map]\nrefine = { speed = \"1 mm/s\" }\n", &["line 11: map.refine.speed: unknown output of this study \"speed\"; did you mean \"progression_speed\"? (allowed"]),
    ("@~[[figures]]\nkind = \"map\"\n", &["line 10: figures[1].name: missing; expected a figure to have a name and a kind"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"chart\"\n", &["line 12: figures[1].kind: unknown kind \"chart\" (allowed: history, phase-portrait, spectrum, bifurcation"]),
    ("@~[[figures]]\nname = \"a/b\"\nkind = \"map\"\n", &["line 11: figures[1].name: \"a/b\" cannot name a file; expected 1 to 200 bytes"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"map\"\n[[figures]]\nname = \"A\"\nkind = \"map\"\n", &["line 14: figures[2].name: the name \"A\" is used twice; names must differ in more than capitals"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"map\"\nx = \"k2\"\n", &["line 13: figures[1].x: unknown axis of this study \"k2\" (allowed: omega)"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"map\"\nat = { omega = \"50 rad/s\" }\n", &["line 13: figures[1].at.omega: expected a value within the axis, from 20 to 30 in SI units, found \"50 rad/s\""]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"map\"\nof = [\"speed\"]\n", &["line 13: figures[1].of[1]: unknown output for this kind of figure \"speed\"; did you mean \"progression_speed\"?"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"history\"\ncycles = [5, 2]\n", &["line 13: figures[1].cycles: expected two numbers of cycles, the lesser first, found 5, 2"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"map\"\nwidth = 90\n", &["line 13: figures[1].width: 90 has no unit; expected a length in m, mm"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"map\"\nwidth = \"2 mm\"\n", &["line 13: figures[1].width: 2 mm is not within 40 to 1000 mm"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"map\"\ncolor_map = { power = \"jet\" }\n", &["line 13: figures[1].color_map: unknown key \"color_map\"; did you mean \"colour_map\"? (allowed: kind, name"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"map\"\ncolour_map = { power = \"jet\" }\n", &["line 13: figures[1].colour_map.power: unknown colour map \"jet\" (allowed: viridis"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"bifurcation\"\nscale = { omega = \"logarithmic\" }\n", &["line 13: figures[1].scale.omega: unknown scale \"logarithmic\" (allowed: linear, log, symlog)"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"bifurcation\"\nlimits = { omega = [\"0 rad/s\", \"9 rad/s\"] }\nscale = { omega = \"log\" }\n", &["line 14: figures[1].scale.omega: a logarithmic scale needs limits above zero"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"bifurcation\"\ndpi = 5\n", &["line 13: figures[1].dpi: 5 is not within 50 to 2400"]),
    ("@~[[figures]]\nname = \"a\"\nkind = \"bifurcation\"\nheight = \"1 km\"\n", &["line 13: figures[1].height: \"1 km\" has the unknown unit \"km\"; expected a length in m, mm"]),
    ("[draws]\nkind = \"sobol\"\ncount = 0\n@", &["line 2: draws.kind: unknown kind \"sobol\" (allowed: uniform, low-discrepancy, saltelli)", "line 3: draws.count: expected a whole number, 1 to 10000000, found 0"]),
    ("[draws]\ncount = 5\n@", &["axes: missing; expected ranges to draw from, as `[[axes]]` with name, from and to"]),
];

/// Commands, their arguments apart, with what is said of them; ok.toml and ok.h5 are a study and its results.
#[rustfmt::skip]
const COMMANDS: &[(&[&str], &[&str])] = &[
    (&["simulate", "--omega", "-3 Hz"], &["omega (frequency of the drive) = -18.84955592153876 rad/s: must be a finite number above zero"]),
    (&["simulate", "--delta", "1,5 mm"], &["--delta: \"1,5 mm\" has a decimal comma; is \"1.5 mm\" meant?"]),
    (&["simulate", "--omega", "5km"], &["--omega: \"5km\" has the unknown unit \"km\"; expected a frequency in rad/s"]),
    (&["simulate", "--set", "mu=1"], &["--set: unknown parameter \"mu\"; did you mean \"mu_s\"? (allowed: mu_s"]),
    (&["simulate", "--set", "mu_s"], &["--set mu_s: expected NAME=VALUE"]),
    (&["simulate", "--set", "mu_s=-1"], &["mu_s (static friction coefficient) = -1: must be a finite number, zero or above"]),
    (&["simulate", "--start", "r=1kg"], &["--start r: \"1kg\" is a mass; expected a length in m"]),
    (&["simulate", "--start", "q=1"], &["--start: unknown coordinate \"q\"; did you mean \"r\"? (allowed: r, y1, x2, y2)"]),
    (&["simulate", "--cycles", "-1"], &["'-1' for '--cycles <CYCLES>'"]),
    (&["simulate", "--tolerance", "0"], &["--tolerance 0: must lie between 1e-15 and 1e-3"]),
    (&["simulate", "--friction-switching", "printed"], &["'printed' for '--friction-switching", "possible values: filippov, as-printed"]),
    (&["simulate", "--resistance", "air"], &["'air' for '--resistance", "possible values: coulomb-stribeck, coulomb, medium"]),
    (&["simulate", "--case", "3"], &["required arguments were not provided", "--study <STUDY>"]),
    (&["simulate", "--study", "none.toml", "--case", "1"], &["none.toml: cannot be read: No such file"]),
    (&["simulate", "--study", "ok.toml", "--case", "99"], &["--case 99: ok.toml has 5 cases"]),
    (&["simulate", "--max-steps", "0"], &["'0' for '--max-steps <MAX_STEPS>': 0 is not in 1.."]),
    (&["simulate", "--phase", "1m"], &["--phase: \"1m\" is a length; expected an angle in rad, deg"]),
    (&["sweep", "none.toml"], &["none.toml: cannot be read: No such file"]),
    (&["sweep", "ok.toml", "--threads", "0"], &["'0' for '--threads <THREADS>': 0 is not in 1..=65535"]),
    (&["sweep", "ok.toml", "--task", "3/2"], &["--task 3/2: expected I/N with I from 1 to 2, as N is 2"]),
    (&["sweep", "ok.toml", "--task", "half"], &["'half' for '--task <I/N|auto>': expected I/N, as 3/8, or auto"]),
    (&["sweep", "ok.toml", "--task", "0/2"], &["--task 0/2: expected I/N with I from 1 to 2, as N is 2"]),
    (&["sweep", "ok.toml", "--formats", "gif"], &["'gif' for '--formats <FORMATS>'", "possible values: png, svg, pdf"]),
    (&["sweep", "ok.toml", "--instructions", "sse9"], &["'sse9' for '--instructions", "possible values: scalar, sse2, avx2, avx512"]),
    (&["sweep", "ok.h5"], &["ok.h5: is a file of results; give the study, a TOML file"]),
    (&["figure", "ok.toml"], &["ok.toml: not a result of capsulemap: it is not an HDF5 file; give a file that capsulemap wrote"]),
    (&["figure", "none.h5"], &["none.h5: opening the file: No such file", "check the path"]),
    (&["figure", "ok.h5", "--kind", "chart"], &["'chart' for '--kind <KIND>'", "possible values: history, phase-portrait"]),
    (&["figure", "ok.h5", "--kind", "map"], &["a map needs two axes that `at` does not hold, and there is only omega"]),
    (&["figure", "ok.h5", "--kind", "bifurcation", "--of", "speed"], &["no variable `speed`; did you mean `progression_speed`? (there is: progression_speed"]),
    (&["figure", "ok.h5", "--kind", "bifurcation", "--x", "k2"], &["`k2` is not an axis of this study (its axes: omega)"]),
    (&["figure", "ok.h5", "--kind", "bifurcation", "--at", "omega"], &["--at omega: expected AXIS=VALUE"]),
    (&["figure", "ok.h5", "--kind", "bifurcation", "--at", "omega=99"], &["`at` holds omega at 99 rad/s, and its axis goes from 20 rad/s to 30 rad/s"]),
    (&["figure", "ok.h5", "--kind", "bifurcation", "--at", "k2=3"], &["--at: unknown axis of these results \"k2\" (allowed: omega)"]),
    (&["figure", "ok.h5", "--kind", "bifurcation", "--width", "3000"], &["--width: 3000 mm is not within 40 to 1000 mm"]),
    (&["figure", "ok.h5", "--kind", "bifurcation", "--width", "-86"], &["--width: -86 mm is not within 40 to 1000 mm"]),
    (&["figure", "ok.h5", "--kind", "bifurcation", "--colour-by", "directon"], &["--colour-by: unknown output, axis or kind \"directon\"; did you mean \"direction\"? (allowed: attractor, direction"]),
    (&["figure", "ok.h5", "--kind", "bifurcation", "--limits", "frequenc=1,2"], &["--limits frequenc=1,2: unknown quantity \"frequenc\" (allowed: spectrum_frequency, ", " others, which capsulemap help study parameters and capsulemap help output list)"]),
    (&["figure", "ok.h5", "--kind", "bifurcation", "--dpi", "3"], &["--dpi: 3 is not within 50 to 2400"]),
    (&["figure", "ok.h5", "--kind", "bifurcation", "--cycles", "3"], &["--cycles 3: expected two numbers, the lesser first, as 0,5"]),
    (&["figure", "ok.h5", "--of", "power"], &["required arguments were not provided", "--kind <KIND>"]),
    (&["figure", "ok.h5", "--kind", "history"], &["the results hold no time histories (no `history_time`)"]),
    (&["inspect", "none.h5"], &["none.h5: opening the file: No such file"]),
    (&["inspect", "ok.toml"], &["ok.toml: not a result of capsulemap: it is not an HDF5 file"]),
    (&["status", "none.toml"], &["none.toml: cannot be read: No such file"]),
    (&["join", "ok.toml"], &["results/ok/ok.blocks: no blocks of this study are there; compute them first"]),
    (&["verify", "ok.h5", "--cases", "0"], &["'0' for '--cases <CASES>': 0 is not in 1.."]),
    (&["continue", "ok.toml"], &["ok.toml: asks for no [[branches]], no [[ramps]] and no boundaries of a [map]; capsulemap help study lists their keys"]),
    (&["tradeoff", "ok.h5", "--of", "speed"], &["--of: unknown output \"speed\"; did you mean \"progression_speed\"? (allowed: progression_speed"]),
    (&["tradeoff", "ok.h5", "--direction", "up"], &["'up' for '--direction <DIRECTION>'", "possible values: forward, backward, either"]),
    (&["tradeoff", "ok.h5", "--where", "speed > 3"], &["\"speed > 3\": unknown output or parameter of a case \"speed\"; did you mean \"progression_speed\"? (allowed: "]),
    (&["tradeoff", "ok.h5", "--where", "progression_speed > 3 N"], &["\"progression_speed > 3 N\": \"3 N\" is a force; expected a velocity in m/s"]),
    (&["tradeoff", "ok.h5", "--budget", "3J"], &["--budget: \"3J\" is an energy; expected a power in W"]),
    (&["tradeoff", "ok.h5", "--speed", "5N"], &["--speed: \"5N\" is a force; expected a velocity in m/s"]),
    (&["tradeoff", "ok.h5", "--refine", "--seed", "x"], &["'x' for '--seed <NUMBER>'"]),
    (&["report", "none.h5"], &["none.h5: opening the file: No such file"]),
    (&["completions", "tcsh"], &["'tcsh' for '<SHELL>'", "possible values: bash"]),
    (&["help", "study", "refin"], &["unknown key or table of a study \"refin\"; did you mean \"refine\"? (allowed: capsulemap help study lists them)"]),
    (&["help", "study", "basin.erly_decision"], &["\"erly_decision\"; did you mean \"early_decision\"?"]),
    (&["help", "output", "powr"], &["unknown output \"powr\"; did you mean \"power\"?"]),
    (&["help", "book", "tradeof"], &["unknown page \"tradeof\"; did you mean \"tradeoff\"? (allowed: capsulemap help book lists them)"]),
    (&["help", "swep"], &["unknown topic \"swep\"; did you mean \"sweep\"? (allowed: a command; study, output, unit or book and a name; answers to errors: capsulemap help book errors)"]),
    (&["frobnicate"], &["unrecognized subcommand 'frobnicate'"]),
    (&["sweep"], &["required arguments were not provided", "<STUDY>"]),
];

/// A study as it is written.
fn whole(study: &str) -> String {
    let held = format!("{PARAMETERS}omega = \"20 rad/s\"\n");
    study.replace("@@", &held).replace('@', PARAMETERS).replace('~', AXIS)
}

#[test]
fn wrong_studies_are_refused_with_file_line_key_value_and_what_is_allowed() {
    let dir = WorkDir::new();
    for (study, parts) in STUDIES {
        dir.put("s.toml", whole(study));
        let ran = dir.run(&["sweep", "s.toml", "--output", "s.h5"]);
        ran.refused(&["s.toml: "]);
        ran.refused(parts);
    }
    assert_eq!(dir.files(), ["s.toml"]);
}

#[test]
fn wrong_commands_are_refused_with_option_value_and_what_is_allowed() {
    let dir = WorkDir::new();
    dir.put("ok.toml", whole("@~"));
    dir.run(&["sweep", "ok.toml", "--output", "ok.h5", "--no-figures"]).done();
    let before = dir.files();
    for (arguments, parts) in COMMANDS {
        dir.run(arguments).refused(parts);
    }
    assert_eq!(dir.files(), before);
    let count = STUDIES.len() + COMMANDS.len();
    assert!(count >= 100, "{count} wrong inputs");
}
