//! Random valid studies over the whole box, without drive and without friction among them: each ends in time, and in order.

use std::process::Stdio;
use std::time::{Duration, Instant};

use capsulemap::capsule::description::CAPSULE;
use capsulemap::capsule::{CapsuleState as _, Parameter, Parameters, Resistance, State};
use capsulemap::orbit::Protocol;
use capsulemap::study::{Axis, CaseSet, Coordinate, Grid, Spacing, Study, Varying};

use super::draws::{self, ALONG, Random};
use super::program::{Ran, WorkDir};

/// No study of so few cases takes so much time of the processor: margins of a capsule that impacts hundreds of times in a cycle of
/// 1.5 s take three minutes of it.
const LIMIT: Duration = Duration::from_secs(600);
/// Nor does one that waits take so long, on a machine that does other things.
const LONGEST: Duration = Duration::from_secs(3600);
/// What is asked of a study: which starts lead where, also along a parameter with the erosion of each basin, and what tolerances and
/// margins leave of its optima.
const KINDS: [&str; 4] = ["starts", "shares", "tolerances", "margins"];

/// A study of a kind by its number.
fn drawn(number: usize) -> (&'static str, Study) {
    let seed = 37_000 + number as u64;
    let kind = KINDS[number % KINDS.len()];
    let law = Resistance::NAMES[number / KINDS.len() % Resistance::NAMES.len()].1;
    let case = draws::wide(1, seed, law).remove(0);
    let mut random = Random::new(seed);
    let mut base = case.parameters;
    // More often than the box has them.
    if random.uniform(0.0, 1.0) < 0.2 {
        base[Parameter::Pd] = 0.0;
    }
    if random.uniform(0.0, 1.0) < 0.2 {
        (base[Parameter::MuS], base[Parameter::MuD]) = (0.0, 0.0);
    }
    let axis = |coordinate, from: f64, to: f64, points| {
        Axis::of(coordinate, Spacing::Linear.values(from, to, points))
    };
    let [r, y1] = [0, 1].map(|place| Coordinate::starts(&CAPSULE).nth(place).expect("a start"));
    let starts = [(y1, 1.0), (r, 1e-2)]
        .map(|(it, most)| axis(it, -random.uniform(0.0, most), random.uniform(0.0, most), 5));
    let parameter = ALONG[(random.uniform(0.0, 1.0) * ALONG.len() as f64) as usize];
    let (low, value) = (base[parameter] * random.uniform(0.5, 1.0), base[parameter]);
    let along = axis(Coordinate::Parameter(parameter.into()), low, 1.2 * value + 1e-3, 5);
    let along = match random.uniform(0.0, 1.0) < 0.3 {
        true => path(along, &base),
        false => along,
    };
    let axes = match kind {
        "starts" => starts.to_vec(),
        "shares" => [vec![along], starts.to_vec()].concat(),
        _ => vec![along],
    };
    let study = Study {
        base,
        start: State { x2: 0.0, ..case.start.capsule() }.into(),
        start_phase: case.start_phase,
        section_phase: case.section_phase,
        case_set: CaseSet::Grid(Grid { axes, inherit: None }),
        protocol: Protocol {
            max_cycles: 300,
            exponent_cycles: 16,
            measured_cycles: 4,
            ..Protocol::default()
        },
        ..Study::default()
    };
    (kind, study.validated("a study").expect("it is valid"))
}

/// The axis of a parameter as a path along which another parameter falls.
fn path(axis: Axis, base: &Parameters) -> Axis {
    let mut varying = axis.varying.clone();
    let is_other = |it: &&Parameter| axis.coordinates().all(|own| own.name() != it.symbol());
    let other = *ALONG.iter().find(is_other).expect("several parameters");
    let values = Spacing::Linear.values(base[other] + 1e-3, 0.7 * base[other], axis.places());
    varying.push(Varying { coordinate: Coordinate::Parameter(other.into()), values });
    varying.sort_by_key(|it| Coordinate::all(&CAPSULE).position(|other| other == it.coordinate));
    Axis { path: Some("line".to_owned()), varying }
}

/// The time of the processor that a process has taken, where the system tells it as Linux does.
fn processor_time(process: u32) -> Duration {
    let status = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    // After the name in parentheses: of the fields the 12th and the 13th, in hundredths of a second.
    let (_, fields) = status.rsplit_once(')').unwrap_or_default();
    let ticks = fields.split_whitespace().skip(11).take(2).filter_map(|it| it.parse::<u64>().ok());
    Duration::from_millis(10 * ticks.sum::<u64>())
}

/// Runs the program to its end; fails if it takes longer than the limits.
fn run(dir: &WorkDir, arguments: &[&str], about: &str) -> Ran {
    let mut command = dir.command(arguments);
    let quiet = command.stdout(Stdio::null()).stderr(Stdio::null());
    let (mut child, begun) = (quiet.spawn().expect("it starts"), Instant::now());
    let ended = loop {
        if let Some(ended) = child.try_wait().expect("a process") {
            break ended;
        }
        if processor_time(child.id()) > LIMIT || begun.elapsed() > LONGEST {
            child.kill().expect("it is ended");
            panic!(
                "{arguments:?} has not ended in {LIMIT:?} of the processor or {LONGEST:?}: {about}"
            );
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let code = ended.code().unwrap_or_else(|| panic!("{arguments:?}: {ended}: {about}"));
    Ran { code, out: String::new(), err: String::new() }
}

/// In the long form `STUDIES=2000`; with `FIRST=n` from that number on.
#[test]
fn random_studies_end_in_time_and_in_order() {
    let asked = |name: &str| std::env::var(name).ok().and_then(|it| it.parse::<usize>().ok());
    let (first, wanted) = (asked("FIRST").unwrap_or(0), asked("STUDIES").unwrap_or(24));
    let dir = WorkDir::new();
    let mut longest = Duration::ZERO;
    for number in first..wanted {
        let (kind, study) = drawn(number);
        let about = format!("{number}, {kind}:\n{}", study.text);
        dir.put("s.toml", &study.text);
        let begun = Instant::now();
        let sweep = ["sweep", "s.toml", "--output", "s.h5", "--no-figures", "--overwrite"];
        assert_eq!(run(&dir, &sweep, &about).code, 0, "{about}");
        let more: &[&str] = match kind {
            "tolerances" => {
                &["tradeoff", "s.h5", "--tolerances", "k2 = 5 %, c = 10 %", "--draws", "20"]
            }
            "margins" => &["tradeoff", "s.h5", "--margins"],
            _ => &["inspect", "s.h5", "--json"],
        };
        assert_eq!(run(&dir, more, &about).code, 0, "{more:?}: {about}");
        longest = longest.max(begun.elapsed());
    }
    println!("studies {first} to {wanted}, the longest {:.1} s", longest.as_secs_f64());
}
