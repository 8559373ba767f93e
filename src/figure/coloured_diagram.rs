//! A bifurcation diagram as points, lines and symbols, for a screen that draws it itself.

use std::collections::{BTreeMap, BTreeSet};

use super::bifurcation;
use super::coloured::{MapColours, key};
use super::diagram::{Diagram, has_points};
use super::diagram_contents::{Cases, Sorted};
use super::error::FigureError;
use super::outcome::Outcomes;
use super::over_map::channels;
use super::scale::{Scale, Spacing};
use super::shown::Shown;
use super::track::{Rows, branches_in_view, tracks};
use super::view::View;
use super::{check_request, variables};
use crate::description::Description;
use crate::store::catalogue::{
    AT_BRANCH_POINTS, AT_SPECIAL_POINTS, ATTRACTOR, BRANCH_NAMES, DIRECTION, INDEX_PERIOD,
    INDEX_REQUEST, PERIOD, Place,
};
use crate::study::Drawing;

/// A diagram in the units of its figure, unless another is told.
#[derive(Debug, Clone, PartialEq)]
pub struct ColouredDiagram {
    /// The name of what lies along the abscissa.
    pub axis: String,
    /// What it is, with its unit, and the value shown per value in SI.
    pub label: String,
    /// Value shown per value in SI.
    pub factor: f64,
    /// The ends of the abscissa.
    pub range: [f64; 2],
    /// Whether equal ratios take equal lengths.
    pub is_logarithmic: bool,
    /// The axes of the cases, that of the abscissa first, without the direction of the sweep.
    pub of_cases: Vec<String>,
    /// The cases.
    pub cases: Vec<DiagramCase>,
    /// What the points of each sort are, with their colour.
    pub sorts: Vec<(String, [u8; 3])>,
    /// What the colours tell, where the request names what tells them.
    pub told: Option<(String, MapColours)>,
    /// What is shown, from above.
    pub panels: Vec<DiagramPanel>,
    /// The branches.
    pub branches: Vec<DiagramBranch>,
    /// The special points of the branches.
    pub specials: Vec<DiagramSpecial>,
    /// Motions along ramps.
    pub ramps: Vec<DiagramRamp>,
    /// The ranges of the abscissa in which attractors coexist.
    pub windows: Vec<[f64; 2]>,
    /// What is not shown, in phrases.
    pub left_out: Vec<String>,
}

/// A case of a diagram.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagramCase {
    /// Its values along its axes [SI].
    pub at: Vec<f64>,
    /// The direction in which it was swept, if there are several.
    pub sweep: Option<String>,
    /// What came of it, where it is known.
    pub outcome: Option<String>,
    /// Its period; none where it does not repeat.
    pub period: Option<u64>,
    /// The number of its attractor, where that is known.
    pub attractor: Option<u64>,
    /// The sort of its points; none where it has none of its own.
    pub sort: Option<usize>,
    /// The colour of its points, where the request names what tells it.
    pub colour: Option<[u8; 3]>,
}

/// A panel of a diagram.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagramPanel {
    /// The name of what it shows.
    pub name: String,
    /// What it is, with its unit.
    pub label: String,
    /// Value shown per value in SI.
    pub factor: f64,
    /// Whether a case has several values.
    pub is_section: bool,
    /// The values of each case; empty where it has no point of its own.
    pub values: Vec<Vec<f32>>,
    /// Lines of unstable orbits, then of stable ones.
    pub lines: [Vec<Vec<[f64; 2]>>; 2],
    /// The events of attractors, with where they are.
    pub events: Vec<(&'static str, [f64; 2])>,
}

/// A branch of orbits.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagramBranch {
    /// Its name in the study.
    pub name: String,
    /// Its period.
    pub period: u64,
    /// Its orbits, and how many of them are stable.
    pub orbits: [usize; 2],
    /// The value of the abscissa at its ends.
    pub ends: [f64; 2],
}

/// A special point of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagramSpecial {
    /// What happens there.
    pub words: &'static str,
    /// The number of its branch among all of the file.
    pub branch: usize,
    /// The period of the orbit.
    pub period: u64,
    /// The multipliers of the orbit.
    pub multipliers: Vec<[f64; 2]>,
    /// The value of the abscissa.
    pub x: f64,
    /// Its values, by panel.
    pub values: Vec<Vec<f64>>,
}

/// A motion along a ramp.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagramRamp {
    /// Its name in the study.
    pub name: String,
    /// The colour of its points.
    pub colour: [u8; 3],
    /// Its points, by panel.
    pub panels: Vec<Vec<[f64; 2]>>,
    /// The values of the abscissa at which it jumps.
    pub jumps: Vec<f64>,
}

/// The names of the variables that [`coloured_diagram`] reads.
pub fn coloured_diagram_variables(
    drawing: &Drawing,
    model: &'static Description,
) -> BTreeSet<String> {
    let [real, imaginary] = AT_SPECIAL_POINTS.multipliers;
    let more = [PERIOD, INDEX_PERIOD, AT_SPECIAL_POINTS.period, real, imaginary];
    let mut names = variables(drawing, model);
    names.extend(more.map(|entry| entry.name.to_owned()));
    names
}

/// The diagram that `drawing` asks for, with the points, the colours and the symbols of its figure.
///
/// Fails as the figure does.
pub fn coloured_diagram<'a>(
    shown: impl Into<Shown<'a>>,
    drawing: &'a Drawing,
) -> Result<ColouredDiagram, FigureError> {
    let view = View::new(shown.into(), drawing)?;
    check_request(&view)?;
    let Sorted { contents, sorts, windows, left_out } = bifurcation::sorted(&view)?;
    let diagram = Diagram::of(&view, contents)?;
    if let Some(fault) = view.fault_of_settings() {
        return Err(fault);
    }
    let outside = diagram.left_out().map(str::to_owned);
    let contents = &diagram.contents;
    let x = contents.cases.axis;
    let quantity = view.quantity(x);
    let Scale { spacing, low, high } = diagram.abscissa.scale;
    let sections = contents.outputs.iter().map(|output| panel(&view, output));
    let mut panels: Vec<DiagramPanel> = sections.collect();
    let mut cases = cases(&view, &contents.cases)?;
    for (index, panel) in panels.iter_mut().enumerate() {
        panel.values = vec![Vec::new(); cases.len()];
        for (sort, dots) in contents.clouds[index].iter().enumerate() {
            for dot in dots {
                cases[dot.case].sort = Some(sort);
                panel.values[dot.case].push(dot.at.1 as f32);
            }
        }
        let lines = &contents.lines[index].lines;
        panel.lines = lines.each_ref().map(|all| all.iter().map(|it| places(it)).collect());
        let events = contents.symbols.get(index).into_iter().flatten();
        panel.events = events.map(|(symbol, (x, y))| (symbol.words(), [*x, *y])).collect();
    }
    if let Some(paint) = &contents.paint {
        let colours = (0..cases.len()).map(|case| paint.colour(case).map(channels));
        cases.iter_mut().zip(colours).for_each(|(case, colour)| case.colour = colour);
    }
    let ramps = contents.ramps.ramps.iter().map(|ramp| DiagramRamp {
        name: ramp.name.clone(),
        colour: channels(ramp.colour),
        panels: ramp.panels.iter().map(|it| places(it)).collect(),
        jumps: ramp.jumps.clone(),
    });
    let without_direction = contents.cases.free.iter().filter(|it| **it != DIRECTION.name);
    Ok(ColouredDiagram {
        axis: x.to_owned(),
        label: quantity.told(),
        factor: quantity.factor,
        range: [low, high],
        is_logarithmic: spacing == Spacing::Log,
        of_cases: without_direction.map(|it| (*it).to_owned()).collect(),
        told: contents.paint.as_ref().map(|paint| (paint.told(), key(paint))),
        branches: branches(&view, x),
        specials: specials(&view, x, &contents.outputs),
        ramps: ramps.collect(),
        cases,
        sorts: sorts.into_iter().map(|(name, colour)| (name, channels(colour))).collect(),
        panels,
        windows,
        left_out: outside.into_iter().chain(left_out).collect(),
    })
}

/// The panel of an output, of which nothing is shown yet.
fn panel(view: &View<'_>, output: &str) -> DiagramPanel {
    let quantity = view.quantity(output);
    DiagramPanel {
        name: output.to_owned(),
        label: quantity.told(),
        factor: quantity.factor,
        is_section: has_points(view, output),
        values: Vec::new(),
        lines: [Vec::new(), Vec::new()],
        events: Vec::new(),
    }
}

fn places(points: &[(f64, f64)]) -> Vec<[f64; 2]> {
    points.iter().map(|&(x, y)| [x, y]).collect()
}

/// The cases over their axes, without what they show.
fn cases(view: &View<'_>, cases: &Cases<'_>) -> Result<Vec<DiagramCase>, FigureError> {
    let free = &cases.free;
    if cases.values.is_empty() {
        return Ok(Vec::new());
    }
    let axes: Vec<&str> = free.iter().copied().filter(|it| *it != DIRECTION.name).collect();
    let values: Vec<Vec<f64>> = axes.iter().map(|axis| view.coordinate_values(axis)).collect();
    let places: Vec<_> = axes.iter().map(|axis| view.places_along(axis, free)).collect();
    let outcomes = Outcomes::over(view, free)?;
    let periods = numbers(view, PERIOD.name, free)?;
    let attractors = numbers(view, ATTRACTOR.name, free)?;
    let sweeps = sweeps(view, free);
    let all = (0..cases.count()).map(|case| DiagramCase {
        at: places.iter().zip(&values).map(|(place, values)| values[place(case)]).collect(),
        sweep: sweeps.get(case).cloned(),
        outcome: outcomes.name(case).map(str::to_owned),
        period: from(&periods, case, 1.0),
        attractor: from(&attractors, case, 0.0),
        sort: None,
        colour: None,
    });
    Ok(all.collect())
}

/// The number of a case, from the least on that means something.
fn from(all: &[f64], case: usize, least: f64) -> Option<u64> {
    all.get(case).filter(|it| **it >= least).map(|it| *it as u64)
}

/// A variable of the cases; nothing where the results do not have it.
fn numbers(view: &View<'_>, name: &str, free: &[&str]) -> Result<Vec<f64>, FigureError> {
    match view.dataset.variable(name) {
        Some(_) => Ok(view.take(name, free)?.into_iter().collect()),
        None => Ok(Vec::new()),
    }
}

/// The name of the direction of each case; nothing where there is one direction.
fn sweeps(view: &View<'_>, free: &[&str]) -> Vec<String> {
    if !free.contains(&DIRECTION.name) {
        return Vec::new();
    }
    let codes = view.coordinate_values(DIRECTION.name);
    let flags = view.flags(DIRECTION.name);
    let names = codes.iter().map(|code| {
        let flag = flags.iter().find(|(value, _)| *value as f64 == *code);
        flag.map_or(String::new(), |(_, name)| name.clone())
    });
    let names: Vec<String> = names.collect();
    let place = view.places_along(DIRECTION.name, free);
    let count = free.iter().map(|axis| view.coordinate_values(axis).len()).product();
    (0..count).map(|case| names[place(case)].clone()).collect()
}

/// The branches along `x` that lie where `view` holds the other axes.
fn branches(view: &View<'_>, x: &str) -> Vec<DiagramBranch> {
    let [request, period] =
        [INDEX_REQUEST, INDEX_PERIOD].map(|it| Rows::new(view.dataset, it.name));
    let [of_branch, stable] = [AT_BRANCH_POINTS.branch, AT_BRANCH_POINTS.stable]
        .map(|it| Rows::new(view.dataset, it.name));
    let along = Rows::new(view.dataset, &Place::Branch.name(x));
    let names = view.dataset.texts.get(BRANCH_NAMES).map_or("", String::as_str);
    let names: Vec<&str> = names.lines().collect();
    let (fits, factor) = (branches_in_view(view, &[x]), view.quantity(x).factor);
    let mut told = Vec::new();
    for number in (0..request.count()).filter(|_| view.drawing.branches) {
        let of = request.one(number) as usize;
        let orbits = of_branch.places(number);
        let (Some(first), Some(last)) = (orbits.first(), orbits.last()) else { continue };
        let ends = [first, last].map(|it| along.one(*it) * factor);
        if !fits.get(of).copied().unwrap_or(false) || !ends[0].is_finite() {
            continue;
        }
        let are_stable = orbits.iter().filter(|it| stable.one(**it) == 1.0).count();
        told.push(DiagramBranch {
            name: names.get(of).copied().unwrap_or_default().to_owned(),
            period: period.one(number) as u64,
            orbits: [orbits.len(), are_stable],
            ends,
        });
    }
    told
}

/// The special points of the branches along `x`, with their values as each of the `outputs`.
fn specials(view: &View<'_>, x: &str, outputs: &[String]) -> Vec<DiagramSpecial> {
    let mut found: BTreeMap<usize, DiagramSpecial> = BTreeMap::new();
    if !view.drawing.branches || !view.shows("special-points") {
        return Vec::new();
    }
    let [branch, period] = [AT_SPECIAL_POINTS.branch, AT_SPECIAL_POINTS.period]
        .map(|it| Rows::new(view.dataset, it.name));
    let parts = AT_SPECIAL_POINTS.multipliers.map(|it| Rows::new(view.dataset, it.name));
    let along = view.quantity(x);
    for (panel, output) in outputs.iter().enumerate() {
        let own = view.quantity(output);
        for stop in tracks(view, x, output).iter().flat_map(|track| &track.stops) {
            let (Some(symbol), Some(special)) = (stop.symbol, stop.special) else { continue };
            let at = stop.x * along.factor;
            if !along.is_within(at) {
                continue;
            }
            let [real, imaginary] = parts.each_ref().map(|it| it.at(special));
            let multipliers = real.iter().zip(imaginary).map(|(re, im)| [*re, *im]);
            let told = found.entry(special).or_insert_with(|| DiagramSpecial {
                words: symbol.words,
                branch: branch.one(special) as usize,
                period: period.one(special) as u64,
                multipliers: multipliers.filter(|it| it[0].is_finite()).collect(),
                x: at,
                values: vec![Vec::new(); outputs.len()],
            });
            told.values[panel] = stop.values.iter().map(|value| value * own.factor).collect();
        }
    }
    found.into_values().collect()
}
