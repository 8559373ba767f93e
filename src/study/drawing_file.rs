//! The figures of a study file: which keys they have, what they mean and what is allowed.

use std::collections::BTreeMap;

use super::appearance::{Setting, SettingText, Settings, dimension_of};
use super::colour::{AttractorColours, Colour, attractor_number};
use super::document::{Entry, Table};
use super::drawing::{COLOURED_BY, Size, Sweep, Texts, check_text};
use super::held_file::{names_along, older_name, read_at};
use super::{Axis, CaseSet, Drawing, DrawingKind, Refine};
use crate::description::{Output, Parameter};
use crate::quantity::{Allowed, Dimension, parse_quantity};

/// The unit of widths [m].
const MILLIMETRE: f64 = 1e-3;

/// Longest name of a figure [bytes]; with an extension it still is a file name everywhere.
const LONGEST_NAME: usize = 200;

/// The figures of a study with the cases of `case_set` that keeps `outputs`; branches and ramps vary what is `varied_beside`.
pub(super) fn read_drawings(
    top: &Table<'_, '_>,
    case_set: &CaseSet,
    varied_beside: &[Parameter],
    outputs: &[Output],
    refine: Option<&Refine>,
) -> Vec<Drawing> {
    let of_all = top.table("colours").map(|it| read_colours(&it)).unwrap_or_default();
    let entries = top.entry("figures").map(|entry| entry.list()).unwrap_or_default();
    let mut drawings: Vec<Drawing> = Vec::new();
    for table in entries.iter().filter_map(Entry::table) {
        let mut drawing = read_drawing(&table, case_set.axes(), varied_beside, outputs);
        if drawing.kind.keys().attractors {
            of_all.iter().for_each(|(number, colour)| {
                drawing.colours.entry(*number).or_insert(*colour);
            });
        }
        if let (CaseSet::Draws(_), Some(kind)) = (case_set, table.entry("kind")) {
            refuse_without_grid(&kind, drawing.kind);
        }
        if let (DrawingKind::Sensitivity, Some(kind)) = (drawing.kind, table.entry("kind")) {
            refuse_without_design(&kind, case_set);
        }
        if let (Some(Refine::Outputs(_)), Some(kind)) = (refine, table.entry("kind"))
            && !matches!(drawing.kind, DrawingKind::Map | DrawingKind::Curves)
        {
            kind.fault(
                "most cases of a refined map are inferred, which only maps and curves allow for",
            );
        }
        // Not even in capitals: some disks take such names for one.
        let is_used = drawings.iter().any(|it| it.name.eq_ignore_ascii_case(&drawing.name));
        if let (true, Some(name)) = (is_used, table.entry("name")) {
            name.fault(format!(
                "the name \"{}\" is used twice; names must differ in more than capitals",
                drawing.name
            ));
        }
        table.finish();
        drawings.push(drawing);
    }
    drawings
}

/// Refuses a figure that runs along axes, of which a study with `[draws]` has none.
fn refuse_without_grid(entry: &Entry<'_, '_>, kind: DrawingKind) {
    if matches!(kind, DrawingKind::Bifurcation | DrawingKind::Map | DrawingKind::TradeOffMaps) {
        entry.fault(format!(
            "a figure of the kind {} needs a grid, and `[draws]` makes none; a trade-off shows draws",
            kind.name()
        ));
    }
}

/// Refuses a figure of Sobol indices of cases from which they cannot be estimated.
fn refuse_without_design(entry: &Entry<'_, '_>, case_set: &CaseSet) {
    let is_design = matches!(case_set, CaseSet::Draws(draws) if draws.saltelli().is_some());
    if !is_design {
        entry.fault("a figure of the kind sensitivity needs `[draws]` with `kind = \"saltelli\"`");
    }
}

fn read_drawing(
    table: &Table<'_, '_>,
    axes: &[Axis],
    varied_beside: &[Parameter],
    outputs: &[Output],
) -> Drawing {
    let kind = read_kind(table);
    let names = abscissae(kind, axes, varied_beside);
    let of = read_of(table, kind, outputs);
    let (at, panels) = table.table("at").map(|at| read_at(&at, axes, kind)).unwrap_or_default();
    Drawing {
        name: table.entry("name").and_then(|entry| read_name(&entry)).unwrap_or_default(),
        kind: kind.unwrap_or(DrawingKind::Map),
        title: table.entry("title").and_then(|entry| entry.text()).map(str::to_owned),
        x: read_axis(table, "x", &names),
        y: read_axis(table, "y", &names),
        budget: table.entry("budget").and_then(|it| read_budget(&it, kind, &of, table)),
        of,
        at,
        panels,
        cycles: table.entry("cycles").and_then(|entry| read_cycles(&entry)),
        sweep: table.entry("sweep").and_then(|it| read_sweep(&it, kind)),
        colour_by: table.entry("colour_by").and_then(|it| read_colour_by(&it, kind, axes, outputs)),
        colours: read_own_colours(table, kind),
        curves: table.entry("curves").is_some_and(|entry| read_curves(&entry, kind)),
        branches: table.entry("branches").and_then(|entry| entry.truth()).unwrap_or(true),
        width_mm: read_size(table, "width", Size::Width),
        height_mm: read_size(table, "height", Size::Height),
        dpi: read_size(table, "dpi", Size::Resolution),
        marker_mm: read_size(table, "marker_size", Size::Marker),
        hide: table.entry("hide").map(|it| read_hide(&it, kind)).unwrap_or_default(),
        texts: table.table("texts").map(|it| read_texts(&it)).unwrap_or_default(),
        legend: table.entry("legend").and_then(|entry| entry.truth()).unwrap_or(true),
        data: table.entry("data").and_then(|entry| entry.truth()).unwrap_or(false),
        svg_text: table.entry("svg_text").and_then(|entry| entry.truth()).unwrap_or(false),
        settings: read_settings(table),
    }
}

/// The kind of a figure, if it is known; a figure lacks neither it nor a name.
fn read_kind(table: &Table<'_, '_>) -> Option<DrawingKind> {
    let kind = table.entry("kind").and_then(|entry| entry.one_of("kind", DrawingKind::NAMES));
    for key in ["name", "kind"] {
        if table.entry(key).is_none() {
            table.missing(key, "a figure to have a name and a kind");
        }
    }
    kind
}

/// What a figure runs along, one of these names.
fn read_axis(table: &Table<'_, '_>, key: &str, names: &[(&str, &str)]) -> Option<String> {
    table.entry(key)?.one_of("axis of this study", names).map(str::to_owned)
}

/// A size, if it is allowed.
fn read_size(table: &Table<'_, '_>, key: &str, size: Size) -> Option<f64> {
    let entry = table.entry(key)?;
    let value = match size {
        Size::Resolution => entry.quantity(Dimension::Number)?,
        Size::Width | Size::Height | Size::Marker => {
            entry.quantity_in(Dimension::Length, MILLIMETRE)?
        }
    };
    size.check(value).map_err(|fault| entry.fault(fault)).ok()?;
    Some(value)
}

/// What is set of quantities: a table for each setting, with quantities by their names.
fn read_settings(table: &Table<'_, '_>) -> Settings {
    let mut settings = Settings::new();
    for (key, setting) in Setting::NAMES {
        for (name, entry) in table.table(key).iter().flat_map(Table::entries) {
            let put = dimension_of(&name, table.model()).and_then(|dimension| {
                let Some(parts) = entry.parts() else { return Ok(()) };
                let text = SettingText { parts: &parts, dimension, read: parse_quantity };
                settings.entry(name).or_default().put(setting, text)
            });
            put.err().into_iter().for_each(|message| entry.fault(message));
        }
    }
    settings
}

/// What a figure of this kind can run along: the axes, and the parameters of branches and ramps where it shows them.
fn abscissae<'a>(
    kind: Option<DrawingKind>,
    axes: &'a [Axis],
    varied_beside: &[Parameter],
) -> Vec<(&'a str, &'a str)> {
    let shows_branches = kind.is_some_and(|kind| kind.keys().continued);
    let varied = varied_beside.iter().filter(|_| shows_branches).copied();
    let mut names = names_along(axes);
    for name in varied.map(Parameter::symbol) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let mut names: Vec<_> = names.into_iter().map(|name| (name, name)).collect();
    names.extend(axes.iter().find_map(older_name));
    names
}

/// A name that can stand before the extension of a file.
fn read_name(entry: &Entry<'_, '_>) -> Option<String> {
    let name = entry.text()?;
    let is_stem = !name.trim().is_empty()
        && !name.starts_with('.')
        && !name.contains(['/', '\\'])
        && !name.contains(char::is_control)
        && name.len() <= LONGEST_NAME;
    if !is_stem {
        entry.fault(format!(
            "\"{}\" cannot name a file; expected 1 to {LONGEST_NAME} bytes, not beginning with a \
             dot, without slashes and control characters",
            name.escape_debug()
        ));
    }
    Some(name.to_owned())
}

/// The names of what is drawn, those that the kind of figure can show.
fn read_of(table: &Table<'_, '_>, kind: Option<DrawingKind>, outputs: &[Output]) -> Vec<String> {
    let Some(of) = table.entry("of") else {
        if let (Some(kind), Some(entry)) = (kind, table.entry("kind"))
            && !kind.suits(0, table.model())
        {
            entry.fault(kind.needs_outputs(table.model()));
        }
        return Vec::new();
    };
    let list = of.list();
    let Some(kind) = kind else { return Vec::new() };
    let most = kind.keys().most;
    if most == 0 {
        of.fault(format!("does not go with a figure of the kind {}", kind.name()));
        return Vec::new();
    }
    if !kind.suits(list.len(), table.model()) {
        of.fault(kind.needs_outputs(table.model()));
    }
    if list.len() > most {
        let most = if most == 1 { "one output".to_owned() } else { format!("{most} outputs") };
        of.fault(format!("expected {most} for this kind of figure, found {}", list.len()));
    }
    let is_plane = matches!(kind, DrawingKind::PhasePortrait | DrawingKind::Section);
    if is_plane && list.len() == 1 {
        of.fault("expected the coordinates of both axes, found one");
    }
    let names: Vec<(&str, &str)> =
        kind.can_show(table.model(), outputs).into_iter().map(|name| (name, name)).collect();
    let known = list.iter().filter_map(|it| it.one_of("output for this kind of figure", &names));
    known.map(str::to_owned).collect()
}

/// The colours of attractors, each behind the number of one.
fn read_colours(table: &Table<'_, '_>) -> AttractorColours {
    let mut colours = AttractorColours::new();
    for (key, entry) in table.entries() {
        let number = attractor_number(&key).map_err(|fault| entry.fault(fault));
        let Some(text) = entry.text() else { continue };
        let colour = Colour::parse(text).map_err(|fault| entry.fault(fault));
        if let (Ok(number), Ok(colour)) = (number, colour) {
            colours.insert(number, colour);
        }
    }
    colours
}

/// The colours of attractors of one figure, of a kind that shows them.
fn read_own_colours(table: &Table<'_, '_>, kind: Option<DrawingKind>) -> AttractorColours {
    let Some(entry) = table.entry("colours") else { return AttractorColours::new() };
    if let Some(kind) = kind.filter(|kind| !kind.keys().attractors) {
        entry.fault(format!("does not go with a figure of the kind {}", kind.name()));
    }
    entry.table().map(|it| read_colours(&it)).unwrap_or_default()
}

/// The most of the cost that may be spent.
fn read_budget(
    entry: &Entry<'_, '_>,
    kind: Option<DrawingKind>,
    of: &[String],
    table: &Table<'_, '_>,
) -> Option<f64> {
    let kind = kind?;
    if kind != DrawingKind::TradeOff {
        entry
            .fault(format!("goes with a trade-off, not with a figure of the kind {}", kind.name()));
        return None;
    }
    let cost = kind.cost(of, table.model())?;
    entry.allowed_quantity(cost.quantity().dimension, Allowed::Finite)
}

/// Whether curves of special points lie over a map.
fn read_curves(entry: &Entry<'_, '_>, kind: Option<DrawingKind>) -> bool {
    let has_curves = entry.truth().unwrap_or(false);
    if let (true, Some(kind)) = (has_curves, kind.filter(|kind| *kind != DrawingKind::Map)) {
        entry.fault(format!("true goes with a map, not with a figure of the kind {}", kind.name()));
    }
    has_curves
}

/// The marks that are left out.
fn read_hide(entry: &Entry<'_, '_>, kind: Option<DrawingKind>) -> Vec<String> {
    let marks = kind.map_or(&[][..], |kind| kind.keys().marks);
    let names: Vec<(&str, &str)> = marks.iter().map(|name| (*name, *name)).collect();
    let list = entry.list();
    let known = list.iter().filter_map(|it| it.one_of("mark of this kind of figure", &names));
    known.map(str::to_owned).collect()
}

/// The words that stand in a figure, each with its place.
fn read_texts(table: &Table<'_, '_>) -> Texts {
    let mut texts = Texts::new();
    for (words, entry) in table.entries() {
        let Some(place) = entry.table() else { continue };
        let mut at = BTreeMap::new();
        for (name, entry) in place.entries() {
            match dimension_of(&name, table.model()) {
                Ok(dimension) => at.extend(entry.quantity(dimension).map(|value| (name, value))),
                Err(fault) => entry.fault(fault),
            }
        }
        // What is wrong with a value has been told.
        let whole = at.len() == place.entries().len();
        let fault = check_text(&words, &at).err().filter(|_| whole);
        fault.into_iter().for_each(|fault| entry.fault(fault));
        texts.insert(words, at);
    }
    texts
}

/// Which of the sweeps is shown; only maps show a difference.
fn read_sweep(entry: &Entry<'_, '_>, kind: Option<DrawingKind>) -> Option<Sweep> {
    let sweep = entry.one_of("sweep", Sweep::NAMES);
    if sweep == Some(Sweep::Difference) && kind.is_some_and(|kind| kind != DrawingKind::Map) {
        entry.fault("only a map shows a difference");
    }
    sweep
}

/// What tells the colours of points.
fn read_colour_by(
    entry: &Entry<'_, '_>,
    kind: Option<DrawingKind>,
    axes: &[Axis],
    outputs: &[Output],
) -> Option<String> {
    let kind = kind?;
    if !kind.keys().coloured {
        entry.fault(format!("does not go with a figure of the kind {}", kind.name()));
    }
    let names = outputs.iter().map(|it| it.name()).chain(COLOURED_BY);
    let names = names.chain(names_along(axes));
    let names: Vec<_> = names.map(|name| (name, name)).collect();
    entry.one_of("output, axis or kind", &names).map(str::to_owned)
}

fn read_cycles(entry: &Entry<'_, '_>) -> Option<[f64; 2]> {
    let ends: Vec<f64> =
        entry.list().iter().filter_map(|end| end.quantity(Dimension::Number)).collect();
    let range = <[f64; 2]>::try_from(ends).ok().filter(|[from, to]| from < to);
    if range.is_none() {
        let found: Vec<String> = entry.list().iter().map(Entry::shown).collect();
        let found = found.join(", ");
        entry.fault(format!("expected two numbers of cycles, the lesser first, found {found}"));
    }
    range
}
