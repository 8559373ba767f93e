//! What a study asks to have drawn from its results.

use std::collections::BTreeMap;

use super::appearance::Settings;
use super::colour::AttractorColours;
use super::grid::Direction;
use crate::description::{Description, Output, Signal, SignalKind};

/// What there is for each case besides the outputs.
const VERDICTS: [&str; 3] = ["outcome", "period", "cycles"];

/// What figures of a kind show beside outputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shows {
    /// What there is for each case.
    Verdicts,
    /// What there is for each point of the sections.
    Points,
    /// The coordinates of the stroboscopic section.
    Section,
    /// Signals over time, and those that the model shows together.
    Histories,
    /// Signals, each by itself.
    Signals,
    /// Signals that the axes of a phase portrait can be.
    Coordinates,
}

impl Shows {
    /// The names, as the model describes them.
    fn names(self, model: &'static Description) -> Vec<&'static str> {
        let signals = model.motion.signals.iter();
        match self {
            Shows::Verdicts => VERDICTS.to_vec(),
            Shows::Points => model.points().map(|it| it.name).collect(),
            Shows::Section => model.section.iter().map(|it| it.name).collect(),
            Shows::Histories => {
                let groups = model.motion.groups.iter().map(|it| it.quantity.name);
                signals.map(Signal::name).chain(groups).collect()
            }
            Shows::Signals => signals.map(Signal::name).collect(),
            Shows::Coordinates => {
                signals.filter(|it| it.kind != SignalKind::Force).map(Signal::name).collect()
            }
        }
    }
}

/// What the keys of a figure may name beside the axes of its study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Keys {
    /// Whether `of` may name outputs.
    outputs: bool,
    /// What `of` may name beside them.
    others: &'static [Shows],
    /// How many names `of` takes.
    pub most: usize,
    /// Whether `x` and `y` may name parameters in which orbits are continued.
    pub continued: bool,
    /// Whether it shows motions that are found between the cases.
    pub between: bool,
    /// Whether `at` may hold axes at several values, with a panel for each.
    pub panels: bool,
    /// Whether its points can be coloured by what `colour_by` names.
    pub coloured: bool,
    /// Whether it shows attractors by their colours.
    pub attractors: bool,
    /// What it marks and `hide` can leave out.
    pub marks: &'static [&'static str],
}

/// Keys that name axes only.
const AXES: Keys = Keys {
    outputs: false,
    others: &[],
    most: 0,
    continued: false,
    between: false,
    panels: false,
    coloured: false,
    attractors: false,
    marks: &[],
};
/// What tells the colours of points beside outputs.
pub const COLOURED_BY: [&str; 4] = ["attractor", "direction", "period", "outcome"];
/// Axes along which panels lie at most, and panels of a figure at most.
const PANELS: [usize; 2] = [2, 16];
/// How many names `of` takes where there is no limit.
const ANY: usize = usize::MAX;

macro_rules! kinds {
    ($($(#[$meaning:meta])* $kind:ident $name:literal $keys:expr;)*) => {
        /// The kinds of figure.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum DrawingKind {
            $($(#[$meaning])* $kind,)*
        }

        impl DrawingKind {
            /// Each kind by its name in studies and on the command line, in the order of declaration.
            pub const NAMES: &[(&str, DrawingKind)] = &[$(($name, DrawingKind::$kind),)*];

            /// What the keys of a figure of this kind may name.
            pub fn keys(self) -> Keys {
                match self { $(DrawingKind::$kind => $keys,)* }
            }
        }
    };
}

kinds! {
    /// Displacements and velocities over time.
    History "history" Keys { others: &[Shows::Histories], most: ANY, panels: true, marks: &["gap"], ..AXES };
    /// Relative velocity over relative displacement, or one coordinate over another, with section points and impacts.
    PhasePortrait "phase-portrait" Keys {
        others: &[Shows::Coordinates],
        most: 2,
        panels: true,
        attractors: true,
        marks: &["stroboscopic", "impacts", "contact"],
        ..AXES
    };
    /// Amplitudes of a history over frequency.
    Spectrum "spectrum" Keys { others: &[Shows::Signals], most: ANY, panels: true, marks: &["drive"], ..AXES };
    /// A section coordinate over an axis, with the progression speed below it.
    Bifurcation "bifurcation"
        Keys { outputs: true, others: &[Shows::Verdicts, Shows::Points], most: ANY, continued: true, coloured: true, attractors: true, marks: &["coexistence", "events", "special-points"], ..AXES };
    /// One output over two axes.
    Map "map" Keys { outputs: true, others: &[Shows::Verdicts], most: 1, panels: true, attractors: true, ..AXES };
    /// Which attractor each start leads to, over two coordinates of the start.
    Basin "basin" Keys { attractors: true, marks: &["section-points", "saddles", "manifolds", "impact-surface"], ..AXES };
    /// For how many cycles each start is followed until its attractor is decided, over two coordinates of the start.
    Settling "settling" Keys { attractors: true, marks: &["section-points"], ..AXES };
    /// Shares of the starts that lead to each attractor, along a parameter, and the room of each basin.
    Shares "shares" Keys { attractors: true, ..AXES };
    /// The stroboscopic section points of one case, and its impacts.
    Section "section" Keys { others: &[Shows::Section], most: 2, attractors: true, ..AXES };
    /// A gain against a cost: the progression speed against an energy per cycle, or one output against another.
    TradeOff "trade-off" Keys { outputs: true, most: 2, between: true, coloured: true, attractors: true, marks: &["fronts", "optima"], ..AXES };
    /// The gain of the motion with the most of it in each cell over two axes, and beside it what it costs, with the fronts on both.
    TradeOffMaps "trade-off-maps" Keys { outputs: true, most: 2, between: true, marks: &["fronts", "optima"], ..AXES };
    /// Special points of branches as curves in two parameters.
    Curves "curves" Keys { continued: true, marks: &["special-points"], ..AXES };
    /// Sobol indices of outputs by the quantities that are drawn, with their intervals.
    Sensitivity "sensitivity" Keys { outputs: true, most: ANY, ..AXES };
}

impl DrawingKind {
    /// The names of the kinds that have a panel for each of several values of an axis.
    pub fn with_panels() -> String {
        let kinds = DrawingKind::NAMES.iter().filter(|(_, kind)| kind.keys().panels);
        let names: Vec<&str> = kinds.map(|(name, _)| *name).collect();
        names.join(", ")
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        DrawingKind::NAMES[self as usize].0
    }

    /// What a trade-off that names these outputs shows as its cost: the first of them, or the work of a cycle of a model that has
    /// a gain and a cost of its own; none of other kinds.
    pub fn cost(self, of: &[String], model: &'static Description) -> Option<Output> {
        if self != DrawingKind::TradeOff {
            return None;
        }
        match of.first() {
            Some(name) => model.output(name),
            None => model.has_trade_off().then(|| model.work()),
        }
    }

    /// Whether a figure of this kind that names so many outputs has what it shows: a gain and a cost, of a trade-off, which both are
    /// named where the model has none of its own.
    pub fn suits(self, named: usize, model: &'static Description) -> bool {
        let is_trade_off = matches!(self, DrawingKind::TradeOff | DrawingKind::TradeOffMaps);
        !is_trade_off || model.has_trade_off() || named > 1
    }

    /// What is said where it does not suit.
    pub fn needs_outputs(self, model: &'static Description) -> String {
        format!(
            "the model {} names no gain and no cost of its own; `of` of a {} has to name both, the cost first",
            model.name,
            self.name()
        )
    }

    /// What a figure of this kind can show of a study of a model that keeps `outputs`.
    pub fn can_show(self, model: &'static Description, outputs: &[Output]) -> Vec<&'static str> {
        let keys = self.keys();
        let outputs = if keys.outputs { outputs } else { &[] };
        let others = keys.others.iter().flat_map(|it| it.names(model));
        outputs.iter().map(|output| output.name()).chain(others).collect()
    }
}

/// Which of the cases of sweeps in both directions a figure shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sweep {
    /// Those whose starts were inherited upward.
    Upward,
    /// Those whose starts were inherited downward.
    Downward,
    /// What the latter have more than the former, for maps.
    Difference,
}

impl Sweep {
    /// Each by its name.
    pub const NAMES: &[(&str, Sweep)] = &[
        ("upward", Sweep::Upward),
        ("downward", Sweep::Downward),
        ("difference", Sweep::Difference),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        Sweep::NAMES[self as usize].0
    }

    /// The direction that is shown, or from which the difference is taken, and the other.
    pub fn directions(self) -> [Direction; 2] {
        match self {
            Sweep::Upward | Sweep::Difference => [Direction::Upward, Direction::Downward],
            Sweep::Downward => [Direction::Downward, Direction::Upward],
        }
    }
}

/// What a figure may be given in numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// Its width [mm].
    Width,
    /// Its height [mm].
    Height,
    /// The diameter of the points of cases [mm].
    Marker,
    /// The dots of its pixels per inch.
    Resolution,
}

impl Size {
    /// The least and the most that is allowed.
    pub const fn range(self) -> (f64, f64) {
        match self {
            Size::Width | Size::Height => (40.0, 1000.0),
            Size::Marker => (0.02, 5.0),
            Size::Resolution => (50.0, 2400.0),
        }
    }

    /// Fails with what is allowed where a size is not.
    pub fn check(self, value: f64) -> Result<(), String> {
        let (low, high) = self.range();
        let unit = if self == Size::Resolution { "" } else { " mm" };
        match (low..=high).contains(&value) {
            true => Ok(()),
            false => Err(format!("{value}{unit} is not within {low} to {high}{unit}")),
        }
    }
}

/// Where axes are held, and those that are held at several values in the order of the study (SI).
pub type Held = (BTreeMap<String, f64>, Vec<(String, Vec<f64>)>);

/// Words with the values of the two quantities along axes where they stand (SI).
pub type Texts = BTreeMap<String, BTreeMap<String, f64>>;

/// Fails where words of a figure are none, or do not stand at values of two quantities.
pub fn check_text(words: &str, at: &BTreeMap<String, f64>) -> Result<(), String> {
    match (words.trim().is_empty(), at.len()) {
        (true, _) => Err("expected words that stand in the figure, found none".to_owned()),
        (false, 2) => Ok(()),
        (false, count) => {
            Err(format!("expected values of the two quantities along its axes, found {count}"))
        }
    }
}

/// One figure to draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Stem of the files to write.
    pub name: String,
    /// Kind of figure.
    pub kind: DrawingKind,
    /// Heading above the axes; none by default, as captions do that in a paper.
    pub title: Option<String>,
    /// Axis along the abscissa; by default the first that is not fixed by `at`.
    pub x: Option<String>,
    /// Axis along the ordinate (maps); by default the second that is not fixed by `at`.
    pub y: Option<String>,
    /// Outputs drawn; the kind of figure has its own default.
    pub of: Vec<String>,
    /// Where the other axes are held, in SI, within their ranges; the nearest grid value is taken, by default the
    /// first.
    pub at: BTreeMap<String, f64>,
    /// Axes that `at` holds at several values, in SI, each with a row or a column of panels; one or two.
    pub panels: Vec<(String, Vec<f64>)>,
    /// Range of cycles shown by a history, counted from its start; all by default.
    pub cycles: Option<[f64; 2]>,
    /// Which cases of sweeps in both directions it shows; by default, diagrams show all and maps those of the first.
    pub sweep: Option<Sweep>,
    /// What the colours of points tell: an output, or `attractor`, `period`, `outcome`, `direction`; the kind of figure has its
    /// own default.
    pub colour_by: Option<String>,
    /// The colours of attractors by their numbers; the others have those that figures choose.
    pub colours: AttractorColours,
    /// The most of the cost that may be spent, where a trade-off has a line (SI).
    pub budget: Option<f64>,
    /// Whether a map shows the curves of special points in its two parameters, too.
    pub curves: bool,
    /// Whether a bifurcation diagram shows the branches, too.
    pub branches: bool,
    /// Width of the figure [mm]; by default one or two columns of a journal, as the kind needs.
    pub width_mm: Option<f64>,
    /// Height of the figure [mm]; by default what its panels need.
    pub height_mm: Option<f64>,
    /// Dots per inch of its pixels in a PNG file; 600 by default.
    pub dpi: Option<f64>,
    /// Diameter of the points of cases [mm]; by default the more there are, the smaller.
    pub marker_mm: Option<f64>,
    /// Marks that it leaves out, with what the legend says of them.
    pub hide: Vec<String>,
    /// Words that stand in it, each where the two quantities of a panel have these values (SI).
    pub texts: Texts,
    /// Whether it says what its marks mean; what it leaves out is said in any case.
    pub legend: bool,
    /// Whether the data behind it are written as CSV beside it.
    pub data: bool,
    /// Whether its SVG keeps text as text, which looks the same only where the font is; by default text is outlines.
    pub svg_text: bool,
    /// What is set of the quantities that it shows, by their names.
    pub settings: Settings,
}

impl Drawing {
    /// A figure of a kind that chooses everything else by itself.
    pub fn new(name: impl Into<String>, kind: DrawingKind) -> Drawing {
        Drawing {
            name: name.into(),
            kind,
            title: None,
            x: None,
            y: None,
            of: Vec::new(),
            at: BTreeMap::new(),
            panels: Vec::new(),
            cycles: None,
            sweep: None,
            colour_by: None,
            colours: AttractorColours::new(),
            budget: None,
            curves: false,
            branches: true,
            width_mm: None,
            height_mm: None,
            dpi: None,
            marker_mm: None,
            hide: Vec::new(),
            texts: Texts::new(),
            legend: true,
            data: false,
            svg_text: false,
            settings: Settings::new(),
        }
    }
}

/// A name for a figure of a kind that shows these outputs, which none of the figures of a study has.
pub fn free_name(kind: DrawingKind, of: &[String], studied: &[Drawing]) -> String {
    let parts = std::iter::once(kind.name()).chain(of.iter().map(String::as_str));
    let name = parts.collect::<Vec<_>>().join("-");
    match studied.iter().any(|drawing| drawing.name == name) {
        true => format!("{name}-own"),
        false => name,
    }
}

/// Fails where panels along these axes are too many, or none.
pub fn check_panels(panels: &[(String, Vec<f64>)]) -> Result<(), String> {
    let [most_axes, most] = PANELS;
    let count: usize = panels.iter().map(|(_, values)| values.len()).product();
    match (panels.len() <= most_axes, (1..=most).contains(&count)) {
        (true, true) => Ok(()),
        (false, _) => Err(format!(
            "{} axes are held at several values; panels lie along {most_axes} at most",
            panels.len()
        )),
        (_, false) => Err(format!("{count} panels; a figure has 1 to {most}")),
    }
}
