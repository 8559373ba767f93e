//! The summary of branches: where they end, and where they change.

use std::fmt::Write;
use std::path::Path;

use crate::branch::{Codim2, Codim2Kind, Curve, End, SpecialKind, is_followed};
use crate::campaign::Beside;
use crate::campaign::count::counted;
use crate::description::Parameter;
use crate::motion::branch::{Branch, Found, Special};
use crate::quantity::printable::printable;
use crate::study::{Continuation, FirstOrbit, Study};

/// What came of the branches of `study`, and which file keeps it, and its ramps, too.
pub fn summary(study: &Study, found: &Beside, output: &Path, seconds: f64) -> String {
    let Beside { continued, ramped, boundaries } = found;
    let all: Vec<&Branch> = continued.iter().flatten().flat_map(|it| &it.branches).collect();
    let (branches, points) = (all.len(), all.iter().map(|it| it.points.len()).sum::<usize>());
    let plural = if branches == 1 { "branch" } else { "branches" };
    let shown = printable(output);
    let of_branches = format!("{branches} {plural}, {points} points");
    let told = [
        (!study.branches.is_empty()).then_some(of_branches),
        (!study.ramps.is_empty()).then(|| counted(ramped.len(), "ramp")),
        boundaries.as_ref().map(|it| counted(it.curves(), "boundary curve")),
    ];
    let told: Vec<String> = told.into_iter().flatten().collect();
    let mut text = format!("{shown}: {} in {seconds:.1} s\n", told.join(", "));
    for (continuation, outcome) in study.branches.iter().zip(continued) {
        match outcome {
            Ok(found) => write_found(&mut text, continuation, found),
            // Writing to a String cannot fail.
            Err(why) => drop(writeln!(text, "\n{}: not continued: {why}", continuation.name)),
        }
    }
    text
}

fn write_found(text: &mut String, continuation: &Continuation, found: &Found) {
    let Continuation { name, along, .. } = continuation;
    for (number, branch) in found.branches.iter().enumerate() {
        let number = match found.branches.len() {
            1 => String::new(),
            _ => format!(", branch {}", number + 1),
        };
        let _ = writeln!(
            text,
            "\n{name}{number}: period {}{}",
            branch.period,
            origin(continuation, found, branch)
        );
        write_branch(text, *along, branch);
    }
    for &(number, special) in &found.not_left {
        let at = quantity(*along, found.branches[number].special[special].point.parameter);
        let number = number + 1;
        let _ =
            writeln!(text, "  no orbit of twice the period was found off branch {number} at {at}");
    }
    for curve in &found.curves {
        write_curve(text, continuation, curve);
    }
    if continuation.second.is_some() {
        write_without_curve(text, found);
    }
}

/// A curve with its points of codimension 2.
pub(super) fn write_curve(text: &mut String, continuation: &Continuation, curve: &Curve) {
    let Curve { kind, period, points, ends, .. } = curve;
    let (name, points) = (kind_name(*kind), counted(points.len(), "point"));
    let ends = shown_ends(ends.map(Some));
    let _ = writeln!(text, "  curve of {name}, period {period}: {points}{ends}");
    curve.codim2.iter().for_each(|point| write_codim2(text, continuation, point));
}

/// A point of codimension 2 with the values of its two parameters.
fn write_codim2(text: &mut String, continuation: &Continuation, point: &Codim2) {
    let Some((second, _)) = continuation.second else { return };
    let name = Codim2Kind::NAMES.iter().find(|(_, it)| *it == point.kind).map_or("", |it| it.0);
    let place = if point.kind == Codim2Kind::Unresolved { "beside" } else { "at" };
    let values = [continuation.along, second].into_iter().zip(point.parameters);
    let values = values.map(|(it, value)| format!("{} = {}", it.symbol(), quantity(it, value)));
    let values: Vec<String> = values.collect();
    let _ = writeln!(text, "    {name} {place} {}", values.join(", "));
}

/// Where a branch left another, or that its period is not the one that was asked for.
fn origin(continuation: &Continuation, found: &Found, branch: &Branch) -> String {
    match (branch.parent, continuation.first) {
        (Some((parent, special)), _) => {
            let at = found.branches[parent].special[special].point.parameter;
            format!(", left branch {} at {}", parent + 1, quantity(continuation.along, at))
        }
        (None, FirstOrbit::Newton { period }) if period != branch.period => {
            format!(", though {period} was asked for")
        }
        _ => String::new(),
    }
}

/// How many special points of which kind no curve goes through.
fn write_without_curve(text: &mut String, found: &Found) {
    let counts = SpecialKind::NAMES.iter().filter_map(|(name, kind)| {
        let specials = found.branches.iter().flat_map(|branch| &branch.special);
        let count = specials.filter(|it| it.kind == *kind && it.curve.is_none()).count();
        let never = if is_followed(*kind) { "" } else { " (never continued)" };
        (count > 0).then(|| format!("{count} {name}{never}"))
    });
    let counts: Vec<String> = counts.collect();
    if !counts.is_empty() {
        let _ = writeln!(text, "  no curve through {}", counts.join(", "));
    }
}

fn write_branch(text: &mut String, along: Parameter, branch: &Branch) {
    let points = branch.points.len();
    let stable =
        branch.points.iter().filter(|it| it.multipliers.iter().all(|m| m.abs() < 1.0)).count();
    let _ = writeln!(
        text,
        "  {points} points, {stable} stable, {} unstable, {}",
        points - stable,
        reach(along, branch)
    );
    if branch.special.is_empty() {
        return;
    }
    let heading = match along.dimension().unit() {
        "1" => along.symbol().to_owned(),
        unit => format!("{} [{unit}]", along.symbol()),
    };
    let (output, factor) = match along.model().has_trade_off() {
        true => ("speed [mm/s]".to_owned(), 1e3),
        false => (along.model().main_output().name().to_owned(), 1.0),
    };
    let _ = writeln!(text, "  {:<16} {heading:>16} {:>7} {output:>14}", "", "period");
    for Special { kind, point, .. } in &branch.special {
        let _ = writeln!(
            text,
            "  {:<16} {:>16} {:>7} {:>14.6}",
            kind_name(*kind),
            ten_digits(point.parameter),
            branch.period,
            point.measured.main() * factor
        );
    }
}

/// Why two ends are there, as far as it is to be said.
fn shown_ends(ends: [Option<End>; 2]) -> String {
    if ends.contains(&Some(End::Closed)) {
        return ", closed".to_owned();
    }
    match ends.map(|end| end.map(end_text)) {
        [Some(first), Some(last)] if first == last => format!(", both ends {first}"),
        [first, last] => {
            let told = [("first", first), ("last", last)].map(|(which, words)| {
                words.map_or(String::new(), |words| format!(", {which} end {words}"))
            });
            told.concat()
        }
    }
}

/// Why there is an end.
fn end_text(end: End) -> &'static str {
    match end {
        End::Bound => "at the edge of the range",
        End::Closed => "where it began",
        End::Merged => "at an orbit of half the period",
        End::MostPoints => "where `most_points` is reached",
        End::Corner => "at a corner of the return map",
        End::Vanishes => "where its touch of the stop vanishes",
        End::Equilibrium => "at an equilibrium",
        End::LongestWait => "where an orbit takes longest",
        End::StrongResonance => "at a strong resonance",
        End::Stopped => "where it cannot be continued further",
    }
}

/// From where to where a branch leads, and why it ends there.
fn reach(along: Parameter, branch: &Branch) -> String {
    let folds = branch.special.iter().filter(|special| special.kind == SpecialKind::Fold);
    let folds = folds.map(|special| special.point.parameter);
    let values = branch.points.iter().map(|point| point.parameter).chain(folds);
    let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| {
        (least.min(value), most.max(value))
    });
    let [first, .., last] = &branch.points[..] else { return "a single orbit".to_owned() };
    let closed = branch.ends.contains(&End::Closed);
    let (from, to) = if closed { (least, most) } else { (first.parameter, last.parameter) };
    // Where a branch left another is shown above.
    let first = branch.parent.is_none().then_some(branch.ends[0]);
    let ends = shown_ends([first, Some(branch.ends[1])]);
    let beyond = least < from.min(to) || most > from.max(to);
    let range = match beyond {
        true => format!(", over the range {} to {}", quantity(along, least), quantity(along, most)),
        false => String::new(),
    };
    format!("from {} to {}{range}{ends}", quantity(along, from), quantity(along, to))
}

fn kind_name(kind: SpecialKind) -> &'static str {
    SpecialKind::NAMES.iter().find(|(_, known)| *known == kind).map_or("", |(name, _)| name)
}

/// A value of a parameter with its unit.
pub(super) fn quantity(parameter: Parameter, value: f64) -> String {
    match parameter.dimension().unit() {
        "1" => ten_digits(value),
        unit => format!("{} {unit}", ten_digits(value)),
    }
}

/// A number with ten digits that matter, zeros at the end left out where no power of ten is needed.
fn ten_digits(value: f64) -> String {
    let scientific = format!("{value:.9e}");
    let exponent: i32 = scientific.split('e').nth(1).and_then(|it| it.parse().ok()).unwrap_or(0);
    if !(-4..10).contains(&exponent) {
        return scientific;
    }
    let decimals = (9 - exponent).max(0) as usize;
    let text = format!("{value:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capsule;
    use crate::capsule::description::CAPSULE;
    use crate::description::Outputs;
    use crate::motion::branch::Point;
    use crate::orbit::matrix::Complex;
    use crate::run::NotContinued;

    const STUDY: &str = "\
[parameters]
omega = \"77.91 rad/s\"
p_d = \"4 N\"
k2 = \"2.42 kN/m\"
delta = \"3.5 mm\"
[[branches]]
name = \"a\"
along = \"p_d\"
from = \"1 N\"
to = \"5 N\"
orbit = \"newton\"
period = 2
second = { name = \"k2\", from = \"1 kN/m\", to = \"5 kN/m\" }
[[branches]]
name = \"b\"
along = \"p_d\"
from = \"1 N\"
to = \"5 N\"
";

    fn point(parameter: f64, multiplier: f64) -> Point {
        let mut outputs = Outputs::unknown(&CAPSULE);
        outputs[capsule::Output::ProgressionSpeed] = 0.0125;
        let multipliers =
            vec![Complex { re: multiplier, im: 0.0 }, Complex::default(), Complex::default()];
        Point {
            parameter,
            section: vec![[0.0; 3].into()],
            multipliers,
            residual: 0.0,
            measured: outputs,
            sequence: 0,
        }
    }

    fn codim2(kind: Codim2Kind, parameters: [f64; 2]) -> Codim2 {
        Codim2 { kind, after: 2, parameters, section: vec![0.0; 3], multipliers: Vec::new() }
    }

    #[test]
    fn branches_are_shown_with_their_ends_and_changes() {
        let study = Study::parse("study.toml", STUDY).expect("a study");
        let special =
            |kind, curve| Special { kind, after: 1, point: point(4.123_456_789_123, 1.0), curve };
        let others = [SpecialKind::Grazing, SpecialKind::EventSequence, SpecialKind::EventSequence];
        let others = others.map(|kind| special(kind, None));
        let points = vec![point(1.0, 0.5), point(4.0, 0.9), point(3.0, 1.2)];
        let branch = Branch {
            period: 1,
            parent: None,
            points,
            special: vec![special(SpecialKind::Fold, Some(0))],
            ends: [End::Bound, End::Corner],
        };
        let around = [2.0, 3.0, 2.0, 1.5, 2.0].map(|at| point(at, 0.5)).to_vec();
        let ring = Branch {
            period: 2,
            parent: None,
            points: around,
            special: others.to_vec(),
            ends: [End::Closed; 2],
        };
        let curve = Curve {
            kind: SpecialKind::Fold,
            through: (0, 0),
            period: 1,
            points: vec![[4.0, 1.0]; 7],
            codim2: vec![
                codim2(Codim2Kind::Cusp, [3.5, 1.25]),
                codim2(Codim2Kind::Unresolved, [4.0, 1.0]),
            ],
            ends: [End::MostPoints; 2],
        };
        let not_left = vec![(0, 0)];
        let found = Found { branches: vec![branch, ring], curves: vec![curve], not_left };
        let continued = [Ok(found), Err(NotContinued::NoOrbit)];
        let found = Beside { continued: continued.to_vec(), ramped: Vec::new(), boundaries: None };
        let text = summary(&study, &found, Path::new("a.h5"), 2.0);
        let expected = "\
a.h5: 2 branches, 8 points in 2.0 s

a, branch 1: period 1, though 2 was asked for
  3 points, 2 stable, 1 unstable, from 1 N to 3 N, over the range 1 N to 4.123456789 N, first end at the edge of the range, last end at a corner of the return map
                            p_d [N]  period   speed [mm/s]
  fold                  4.123456789       1      12.500000

a, branch 2: period 2
  5 points, 5 stable, 0 unstable, from 1.5 N to 3 N, closed
                            p_d [N]  period   speed [mm/s]
  grazing               4.123456789       2      12.500000
  event-sequence        4.123456789       2      12.500000
  event-sequence        4.123456789       2      12.500000
  no orbit of twice the period was found off branch 1 at 4.123456789 N
  curve of fold, period 1: 7 points, both ends where `most_points` is reached
    cusp at p_d = 3.5 N, k2 = 1.25 N/m
    unresolved beside p_d = 4 N, k2 = 1 N/m
  no curve through 1 grazing, 2 event-sequence (never continued)

b: not continued: no periodic orbit was found near the start; give one closer to it
";
        assert_eq!(text, expected);
    }

    #[test]
    fn ten_digits_are_those_that_matter() {
        assert_eq!(ten_digits(163.891_234_567_89), "163.8912346");
        assert_eq!(ten_digits(110.0), "110");
        assert_eq!(ten_digits(0.0015), "0.0015");
        assert_eq!(ten_digits(59_410.0), "59410");
        assert_eq!(ten_digits(9_876_543_210.0), "9876543210");
        assert_eq!(ten_digits(-1.234_567_890_12e-7), "-1.234567890e-7");
        assert_eq!(ten_digits(0.0), "0");
    }
}
