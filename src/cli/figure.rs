//! `capsulemap figure`: figures from a file of results.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;

use super::appearance::Appearance;
use super::arguments::{named, plain_or_quantity, read_quantity};
use super::drawing::{FormatChoice, draw_each, draw_from, formats};
use super::failure::Failure;
use super::files;
use super::terminal::notify;
use crate::campaign::study_of;
use crate::experiment::{Column, Presence};
use crate::figure::{Measured, Place};
use crate::quantity::Dimension;
use crate::quantity::printable::printable;
use crate::store::{self, Archive, StoreError, catalogue, paths_of};
use crate::study::appearance::dimension_of;
use crate::study::document::unknown;
use crate::study::{
    AttractorColours, COLOURED_BY, Coordinate, Drawing, DrawingKind, Held, Study, Sweep,
    check_panels, free_name,
};

const EXAMPLES: &str = "\
Examples:
  capsulemap figure results/overview/overview.h5
  capsulemap figure FILE.h5 --kind map --of period --x omega --formats pdf
  capsulemap figure FILE.h5 --kind trade-off --of work,amplitude
  capsulemap figure FILE.h5 --kind bifurcation --at \"p_d=4 N\" --name at-4-newton";

/// Draw the figures that the study asks for, or one of your own.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Figure {
    /// The file of results.
    file: PathBuf,
    /// Kind of figure; without it, the figures of the study are drawn.
    #[arg(long, value_parser = named(DrawingKind::NAMES))]
    kind: Option<DrawingKind>,
    /// Outputs to draw; of a trade-off the cost, then the gain, of the capsule by default the power and the progression speed.
    #[arg(long, value_delimiter = ',', requires = "kind")]
    of: Vec<String>,
    /// Axis along the abscissa, or what varies along a path.
    #[arg(long, requires = "kind")]
    x: Option<String>,
    /// Axis along the ordinate of a map, or what varies along a path.
    #[arg(long, requires = "kind")]
    y: Option<String>,
    /// Where another axis is held, within its range; the nearest value is taken, and named. A path is held by what varies along it, or by its place, as "line=3". Maps, histories, phase portraits and
    /// spectra have a panel for each of several values, as "delta=1 mm,2 mm".
    #[arg(long, value_name = "AXIS=VALUE", requires = "kind")]
    at: Vec<String>,
    /// Which cases of sweeps in both directions are shown; a map shows their difference, too.
    #[arg(long, value_parser = named(Sweep::NAMES), requires = "kind")]
    sweep: Option<Sweep>,
    /// What the colours of points tell in a diagram or a trade-off: an output, an axis, attractor, direction, period or outcome.
    #[arg(long, value_name = "NAME", requires = "kind")]
    colour_by: Option<String>,
    /// Heading above the axes; symbols stand between dollar signs, as in $k_2$.
    #[arg(long, requires = "kind")]
    title: Option<String>,
    /// Cycles that a history shows, as 0,5.
    #[arg(long, value_name = "FROM,TO", value_delimiter = ',', requires = "kind")]
    cycles: Vec<f64>,
    /// The most of the cost that may be spent, at which a trade-off has a line; in SI unless another unit is named, as "20 mW".
    #[arg(long, value_name = "VALUE", requires = "kind", allow_hyphen_values = true)]
    budget: Option<String>,
    /// Measured points over a bifurcation diagram: a CSV file with a column of its axis and one for each measured output, with
    /// their units, as "omega [rad/s],progression_speed [mm/s]"; a column as progression_speed_error has their errors, half the length of a bar each.
    #[arg(long, value_name = "FILE.csv", requires = "kind")]
    points: Option<PathBuf>,
    #[command(flatten)]
    appearance: Appearance,
    /// Draw the curves of special points over a map of their two parameters.
    #[arg(long, requires = "kind")]
    curves: bool,
    /// Leave the branches out of a bifurcation diagram.
    #[arg(long, requires = "kind")]
    no_branches: bool,
    /// Stem of the files; the kind of figure and what it shows by default.
    #[arg(long, requires = "kind")]
    name: Option<String>,
    /// Folder to write to; that of the file of results by default.
    #[arg(long)]
    folder: Option<PathBuf>,
    /// Draw from a file that another program has changed, as xarray does where it adds variables; damage is not detected then.
    #[arg(long)]
    unchecked: bool,
    /// Replace files in the place of figures that this program did not write, or that were changed since.
    #[arg(long)]
    overwrite: bool,
    /// File formats.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "png,svg,pdf")]
    formats: Vec<FormatChoice>,
}

impl Figure {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let archive = self.archive()?;
        let here = self.file.parent().unwrap_or(Path::new("."));
        let folder = self.folder.as_deref().unwrap_or(here);
        let formats = formats(&self.formats);
        let place = Place { folder, formats: &formats, overwrite: self.overwrite };
        match self.kind {
            Some(kind) => {
                let measured = self.points.as_deref().map(|path| measured(path, &archive));
                let measured = measured.transpose()?;
                let drawing = self.drawing(kind, &archive)?;
                draw_each(&archive, &[drawing], measured.as_ref(), &place)
            }
            None => draw_from(&archive, &studied(&archive, &self.file)?, &place),
        }
    }

    /// The file of results.
    fn archive(&self) -> Result<Archive, Failure> {
        if !self.unchecked {
            return store::open(&self.file).map_err(|error| match error {
                StoreError::Foreign { .. } | StoreError::Damaged { .. } => Failure::request(format!(
                    "{error}; if a program of yours has added to it, `--unchecked` draws from it all the same"
                )),
                error => Failure::request(error),
            });
        }
        let (archive, is_checked) = store::open_changed(&self.file).map_err(Failure::request)?;
        if !is_checked {
            let path = printable(&self.file);
            notify(&format!(
                "{path}: another program has changed it; what is drawn is not checked"
            ));
        }
        Ok(archive)
    }

    fn drawing(&self, kind: DrawingKind, archive: &Archive) -> Result<Drawing, Failure> {
        let (at, panels) = self.held(kind, archive)?;
        self.check_colour_by(archive)?;
        let name = self.name.clone().unwrap_or_else(|| self.free_name(kind, archive));
        let mut faults = Vec::new();
        let drawing = Drawing {
            title: self.title.clone(),
            x: self.x.clone(),
            y: self.y.clone(),
            of: self.of.clone(),
            at,
            panels,
            cycles: self.cycles()?,
            sweep: self.sweep,
            colour_by: self.colour_by.clone(),
            colours: self.colours_of_study(kind, archive),
            budget: self.budget(kind, archive, &mut faults),
            curves: self.curves,
            branches: !self.no_branches,
            ..Drawing::new(name, kind)
        };
        match self.appearance.set(drawing, &|name| dimension(archive, name)) {
            Ok(drawing) if faults.is_empty() => Ok(drawing),
            set => {
                faults.extend(set.err().into_iter().flatten());
                Err(Failure::requests(&faults))
            }
        }
    }

    /// The colours that the figures of the study set for attractors, for a figure that shows these.
    fn colours_of_study(&self, kind: DrawingKind, archive: &Archive) -> AttractorColours {
        if !kind.keys().attractors {
            return AttractorColours::new();
        }
        let drawings = studied(archive, &self.file).map_or(Vec::new(), |it| it.drawings);
        drawings.into_iter().rev().flat_map(|it| it.colours).collect()
    }

    /// The most of the cost that may be spent; a fault is noted.
    fn budget(
        &self,
        kind: DrawingKind,
        archive: &Archive,
        faults: &mut Vec<String>,
    ) -> Option<f64> {
        let text = self.budget.as_deref()?;
        let model = archive.frame().model();
        if kind != DrawingKind::TradeOff {
            faults.push(format!("--budget: goes with a trade-off, not with a {}", kind.name()));
        }
        let dimension = kind.cost(&self.of, model)?.quantity().dimension;
        read_quantity("--budget", text, dimension, faults)
    }

    /// Checks that the file has what tells the colours of points.
    fn check_colour_by(&self, archive: &Archive) -> Result<(), Failure> {
        let Some(name) = self.colour_by.as_deref() else { return Ok(()) };
        if COLOURED_BY.contains(&name) || archive.unit(name).is_some() {
            return Ok(());
        }
        let holdable = holdable(archive);
        if holdable.iter().any(|it| it.name == name) {
            return Ok(());
        }
        let axes = holdable.iter().map(|it| it.name.as_str());
        let model = archive.frame().model();
        let outputs = model.outputs().map(|it| it.name());
        let outputs = outputs.filter(|name| archive.unit(name).is_some());
        let known = COLOURED_BY.into_iter().chain(axes).chain(outputs);
        let fault = unknown("output, axis or kind", name, known);
        Err(Failure::request(format!("--colour-by: {fault}")))
    }

    /// The kind and what is drawn, different from the names of the figures of the study.
    fn free_name(&self, kind: DrawingKind, archive: &Archive) -> String {
        free_name(
            kind,
            &self.of,
            &studied(archive, &self.file).map_or(Vec::new(), |it| it.drawings),
        )
    }

    fn cycles(&self) -> Result<Option<[f64; 2]>, Failure> {
        match self.cycles[..] {
            [] => Ok(None),
            [from, to] if from < to => Ok(Some([from, to])),
            _ => {
                let found: Vec<String> = self.cycles.iter().map(f64::to_string).collect();
                let found = found.join(",");
                let expected = "expected two numbers, the lesser first, as 0,5";
                Err(Failure::request(format!("--cycles {found}: {expected}")))
            }
        }
    }

    /// Where axes are held, and those that are held at several values.
    fn held(&self, kind: DrawingKind, archive: &Archive) -> Result<Held, Failure> {
        let mut faults = Vec::new();
        let axes = holdable(archive);
        let held = self.values_at(&axes, &mut faults);
        // Panels lie along the axes in the order of the study.
        let panels = axes.iter().filter_map(|it| {
            let values = held.get(&it.name).filter(|values| values.len() > 1)?;
            Some((it.name.clone(), values.clone()))
        });
        let panels: Vec<(String, Vec<f64>)> = panels.collect();
        if !kind.keys().panels {
            let kinds = DrawingKind::with_panels();
            faults.extend(panels.iter().map(|it| {
                let (name, count, kind) = (&it.0, it.1.len(), kind.name());
                format!(
                    "--at {name}: has {count} values; a {kind} takes one, several are for {kinds}"
                )
            }));
        }
        if !panels.is_empty() {
            faults.extend(check_panels(&panels).err().map(|fault| format!("--at: {fault}")));
        }
        let at = held.into_iter().filter(|(_, values)| values.len() == 1);
        let at = at.map(|(name, values)| (name, values[0])).collect();
        if faults.is_empty() { Ok((at, panels)) } else { Err(Failure::requests(&faults)) }
    }

    /// The values that axes of the results are given, by their names; faults are noted.
    fn values_at(&self, axes: &[Holdable], faults: &mut Vec<String>) -> BTreeMap<String, Vec<f64>> {
        let mut held: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for text in &self.at {
            let Some((name, value)) = text.split_once('=') else {
                faults.push(format!("--at {text}: expected AXIS=VALUE"));
                continue;
            };
            let name = name.trim();
            let Some(axis) = axes.iter().find(|axis| axis.name == name) else {
                let names = axes.iter().map(|axis| axis.name.as_str());
                faults.push(format!("--at: {}", unknown("axis of these results", name, names)));
                continue;
            };
            for value in value.split(',') {
                match plain_or_quantity(value, axis.dimension) {
                    Err(message) => faults.push(format!("--at {name}: {message}")),
                    Ok(value) => held.entry(name.to_owned()).or_default().push(value),
                }
            }
        }
        held
    }
}

/// What a figure can be held at.
struct Holdable {
    name: String,
    dimension: Dimension,
}

/// What figures of a file can be held at: its axes, the places of its paths, and what varies along these; in the order of its dimensions.
fn holdable(archive: &Archive) -> Vec<Holdable> {
    let (frame, paths) = (archive.frame(), paths_of(archive));
    let all: Vec<Coordinate> = Coordinate::all(frame.model()).collect();
    let mut found = Vec::new();
    for (name, _) in &frame.coordinates {
        let along = paths.iter().find(|path| path.name == *name);
        if along.is_some() {
            found.push(Holdable { name: name.clone(), dimension: Dimension::Number });
        }
        let quantities = along.map_or(std::slice::from_ref(name), |path| &path.quantities);
        let own = all.iter().filter(|it| quantities.iter().any(|name| name == it.name()));
        let own = own.map(|it| Holdable { name: it.name().to_owned(), dimension: it.dimension() });
        found.extend(own);
    }
    found
}

/// The measured points in a file, of the axes and the variables of the results.
fn measured(path: &Path, archive: &Archive) -> Result<Measured, Failure> {
    let axes = archive.frame().coordinates.iter().map(|it| it.0.as_str());
    let names = axes.chain(archive.variables().map(|it| it.0));
    let known = names.filter_map(|name| {
        let name = catalogue::named(name, archive.frame().model())?.name;
        let dimension = dimension(archive, name).ok()?;
        Some(Column { name, dimension, presence: Presence::Optional })
    });
    let known: Vec<Column> = known.collect();
    let mut errors = Vec::new();
    for column in &known {
        let name = catalogue::lasting(format!("{}_error", column.name));
        if known.iter().all(|it| it.name != name) {
            errors.push(Column { name, ..*column });
        }
    }
    let recording = files::recording(path, &[&known[..], &errors[..]].concat(), 1)?;
    let mut columns = Vec::new();
    for Column { name, .. } in known {
        // A point without a value is left out of the figure, which says so.
        columns.extend(recording.filled(name).map(|it| (name.to_owned(), it)));
    }
    // A point may have no error.
    for Column { name, .. } in errors {
        let Some(values) = recording.filled(name) else { continue };
        if values.iter().any(|it| *it < 0.0) {
            return Err(Failure::of_file(path, format!("{name}: errors are not below zero")));
        }
        columns.push((name.to_owned(), values));
    }
    if !recording.others.is_empty() {
        notify(&format!(
            "{}: columns that are not read: {}",
            printable(path),
            recording.others.join(", ")
        ));
    }
    Ok(Measured { columns })
}

/// The dimension of a quantity of figures, or of a variable of the file.
fn dimension(archive: &Archive, name: &str) -> Result<Dimension, String> {
    dimension_of(name, archive.frame().model()).or_else(|fault| {
        let unit = archive.unit(name).ok_or(fault)?;
        Ok(Dimension::ALL.into_iter().find(|it| it.unit() == unit).unwrap_or(Dimension::Number))
    })
}

/// The study in the file, which asks for figures.
fn studied(archive: &Archive, file: &Path) -> Result<Study, Failure> {
    let study = study_of(archive, file)?;
    if study.drawings.is_empty() {
        let message = format!("{}: its study asks for no figures; name a --kind", printable(file));
        return Err(Failure::request(message));
    }
    Ok(study)
}
