//! `capsulemap figure`: figures from a file of results.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::result_file::ready;
use super::{Failure, named, plain_or_quantity, tell};
use crate::figure::{FigureError, Format, draw, variables};
use crate::store::catalogue::STUDY_TEXT;
use crate::store::{self, Archive, Dataset};
use crate::study::document::unknown;
use crate::study::{Coordinate, Drawing, DrawingKind, Study};

const EXAMPLES: &str = "\
Examples:
  capsulemap figure results/overview/overview.h5
  capsulemap figure FILE.h5 --kind map --of progression_speed --x omega --y p_d --formats pdf
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
    /// Outputs to draw.
    #[arg(long, value_delimiter = ',', requires = "kind")]
    of: Vec<String>,
    /// Axis along the abscissa.
    #[arg(long, requires = "kind")]
    x: Option<String>,
    /// Axis along the ordinate of a map.
    #[arg(long, requires = "kind")]
    y: Option<String>,
    /// Where another axis is held; the nearest value is taken.
    #[arg(long, value_name = "AXIS=VALUE", requires = "kind")]
    at: Vec<String>,
    /// Heading above the axes.
    #[arg(long, requires = "kind")]
    title: Option<String>,
    /// Cycles that a history shows, as 0,5.
    #[arg(long, value_name = "FROM,TO", value_delimiter = ',', requires = "kind")]
    cycles: Vec<f64>,
    /// Width in mm.
    #[arg(long, requires = "kind")]
    width: Option<f64>,
    /// Leave the followed orbits out of a bifurcation diagram.
    #[arg(long, requires = "kind")]
    no_branches: bool,
    /// Stem of the files; the kind of figure and what it shows by default.
    #[arg(long, requires = "kind")]
    name: Option<String>,
    /// Folder to write to; that of the file of results by default.
    #[arg(long)]
    folder: Option<PathBuf>,
    /// File formats.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "png,svg,pdf")]
    formats: Vec<FormatChoice>,
}

/// Formats on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum FormatChoice {
    /// Pixels.
    Png,
    /// Vectors for the web.
    Svg,
    /// Vectors for a paper.
    Pdf,
}

impl Figure {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let archive = store::open(&self.file).map_err(Failure::request)?;
        let here = self.file.parent().unwrap_or(Path::new("."));
        let folder = self.folder.as_deref().unwrap_or(here);
        let frame = archive.frame();
        match self.kind {
            Some(kind) => draw_each(&archive, &[self.drawing(kind, frame)?], folder, &self.formats),
            None => draw_from(&archive, &studied(frame, &self.file)?, folder, &self.formats),
        }
    }

    fn drawing(&self, kind: DrawingKind, dataset: &Dataset) -> Result<Drawing, Failure> {
        Ok(Drawing {
            name: self.name.clone().unwrap_or_else(|| self.free_name(kind, dataset)),
            kind,
            title: self.title.clone(),
            x: self.x.clone(),
            y: self.y.clone(),
            of: self.of.clone(),
            at: self.held(dataset)?,
            cycles: self.cycles()?,
            branches: !self.no_branches,
            width_mm: self.width,
        })
    }

    /// The kind and what is drawn, told apart from the figures of the study.
    fn free_name(&self, kind: DrawingKind, dataset: &Dataset) -> String {
        let parts = std::iter::once(kind.name()).chain(self.of.iter().map(String::as_str));
        let name = parts.collect::<Vec<_>>().join("-");
        let studied = studied(dataset, &self.file).unwrap_or_default();
        if studied.iter().any(|drawing| drawing.name == name) {
            format!("{name}-own")
        } else {
            name
        }
    }

    fn cycles(&self) -> Result<Option<[f64; 2]>, Failure> {
        match self.cycles[..] {
            [] => Ok(None),
            [from, to] if from < to => Ok(Some([from, to])),
            _ => Err(Failure::request("--cycles: expected two numbers, the lesser first, as 0,5")),
        }
    }

    fn held(&self, dataset: &Dataset) -> Result<BTreeMap<String, f64>, Failure> {
        let axes: Vec<Coordinate> =
            Coordinate::all().filter(|axis| dataset.coordinate(axis.name()).is_some()).collect();
        let mut held = BTreeMap::new();
        let mut faults = Vec::new();
        for text in &self.at {
            let Some((name, value)) = text.split_once('=') else {
                faults.push(format!("--at {text}: expected AXIS=VALUE"));
                continue;
            };
            let name = name.trim();
            let Some(axis) = axes.iter().find(|axis| axis.name() == name) else {
                let names = axes.iter().map(|axis| axis.name());
                faults.push(format!("--at: {}", unknown("axis of these results", name, names)));
                continue;
            };
            match plain_or_quantity(value, axis.dimension()) {
                Err(message) => faults.push(format!("--at {name}: {message}")),
                Ok(value) => {
                    if held.insert(name.to_owned(), value).is_some() {
                        faults.push(format!("--at {name}: is given twice"));
                    }
                }
            }
        }
        if faults.is_empty() { Ok(held) } else { Err(Failure::requests(&faults)) }
    }
}

/// The figures that the study in the file asks for.
fn studied(dataset: &Dataset, file: &Path) -> Result<Vec<Drawing>, Failure> {
    let text = dataset.texts.get(STUDY_TEXT).map_or("", String::as_str);
    let study = Study::parse(&format!("the study in {}", file.display()), text);
    let drawings = study.map_err(Failure::request)?.drawings;
    if drawings.is_empty() {
        let message = format!("{}: its study asks for no figures; name a --kind", file.display());
        return Err(Failure::request(message));
    }
    Ok(drawings)
}

/// Draws those figures of a study for which there is all that they show.
pub fn draw_from(
    archive: &Archive,
    drawings: &[Drawing],
    folder: &Path,
    formats: &[FormatChoice],
) -> Result<(), Failure> {
    draw_each(archive, &ready(archive.into(), drawings), folder, formats)
}

/// Draws figures, each from no more of the results than it shows.
fn draw_each(
    archive: &Archive,
    drawings: &[Drawing],
    folder: &Path,
    formats: &[FormatChoice],
) -> Result<(), Failure> {
    let mut failures = Vec::new();
    for drawing in drawings {
        let shown = variables(drawing);
        let dataset = archive.labelled(|name| shown.contains(name)).map_err(Failure::machine)?;
        failures.extend(draw_all(&dataset, std::slice::from_ref(drawing), folder, formats).err());
    }
    Failure::all(failures).map_or(Ok(()), Err)
}

/// Draws each figure and says where it went; one that cannot be drawn does not keep the others.
pub fn draw_all(
    dataset: &Dataset,
    drawings: &[Drawing],
    folder: &Path,
    formats: &[FormatChoice],
) -> Result<(), Failure> {
    let formats: Vec<Format> = formats
        .iter()
        .map(|format| match format {
            FormatChoice::Png => Format::Png,
            FormatChoice::Svg => Format::Svg,
            FormatChoice::Pdf => Format::Pdf,
        })
        .collect();
    let mut failures = Vec::new();
    for drawing in drawings {
        match draw(dataset, drawing, folder, &formats) {
            Ok(paths) if paths.is_empty() => {}
            Ok(paths) => {
                let names: Vec<String> =
                    paths.iter().map(|path| path.display().to_string()).collect();
                tell(&names.join(" "));
            }
            Err(error) => failures.push(failure(error)),
        }
    }
    Failure::all(failures).map_or(Ok(()), Err)
}

fn failure(error: FigureError) -> Failure {
    match error {
        FigureError::Missing { .. } | FigureError::Unfit { .. } | FigureError::Glyph { .. } => {
            Failure::request(error)
        }
        FigureError::Render { .. } | FigureError::Write { .. } => Failure::machine(error),
    }
}

/// The name of a file without its folder and ending.
pub fn file_stem(path: &Path) -> Result<String, Failure> {
    let stem = path.file_stem().and_then(|stem| stem.to_str());
    let missing = || Failure::request(format!("{}: names no file", path.display()));
    stem.map(str::to_owned).ok_or_else(missing)
}
