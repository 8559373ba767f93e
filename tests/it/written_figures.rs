//! Random figures of random studies, with whatever their keys may hold.

use std::collections::BTreeMap;

use capsulemap::quantity::Allowed;
use capsulemap::study::appearance::NATURAL;
use capsulemap::study::{
    AttractorColours, Axis, COLOURED_BY, CaseSet, Colour, ColourMap, Colouring, Continuation,
    Coordinate, Drawing, DrawingKind, QuantitySettings, ScaleChoice, Settings, Study, Sweep, Texts,
};

use super::random_numbers::Random;

impl Random {
    /// Where an axis is held: by what varies along it, or of a path by its places.
    fn held_at(&mut self, axis: &Axis) -> (String, f64) {
        if axis.path.is_some() && self.is_so() {
            return (axis.name().to_owned(), self.below(axis.places()) as f64);
        }
        let varying = &axis.varying[self.below(axis.varying.len())];
        (varying.coordinate.name().to_owned(), self.one(&varying.values))
    }

    /// A figure of a study.
    pub fn drawing(&mut self, study: &Study, name: String) -> Drawing {
        let is_grid = matches!(study.case_set, CaseSet::Grid(_));
        let needs_grid = |kind: &DrawingKind| {
            matches!(kind, DrawingKind::Map | DrawingKind::Bifurcation | DrawingKind::TradeOffMaps)
        };
        let kinds = DrawingKind::NAMES.iter().map(|(_, kind)| *kind).collect::<Vec<_>>();
        let is_design = matches!(&study.case_set, CaseSet::Draws(it) if it.saltelli().is_some());
        let kinds: Vec<_> = kinds
            .into_iter()
            .filter(|kind| is_grid || !needs_grid(kind))
            .filter(|kind| is_design || *kind != DrawingKind::Sensitivity)
            .collect();
        let kind = self.one(&kinds);
        let mut names: Vec<&str> = study.axes().iter().map(Axis::name).collect();
        let grid: Vec<Vec<Coordinate>> =
            study.axes().iter().map(|axis| axis.coordinates().collect()).collect();
        names.extend(grid.concat().iter().map(|it| it.name()));
        if matches!(kind, DrawingKind::Bifurcation | DrawingKind::Curves) {
            names
                .extend(study.branches.iter().flat_map(Continuation::varied).map(|it| it.symbol()));
        }
        let mut name_of = || {
            let wanted = !names.is_empty() && self.is_so();
            wanted.then(|| self.one(&names).to_owned())
        };
        let (x, y) = (name_of(), name_of());
        let mut of: Vec<String> = self
            .some(&kind.can_show(study.base.model(), &study.outputs))
            .into_iter()
            .map(str::to_owned)
            .collect();
        of.truncate(kind.keys().most);
        let is_plane = matches!(kind, DrawingKind::PhasePortrait | DrawingKind::Section);
        if is_plane && of.len() == 1 {
            of.clear();
        }
        let has_cost = kind.cost(&of, study.base.model()).is_some();
        let budget = (has_cost && self.is_so()).then(|| self.number(Allowed::Finite));
        let held = self.some(study.axes());
        let at: BTreeMap<String, f64> = held.iter().map(|axis| self.held_at(axis)).collect();
        let from = self.uniform(0.0, 3.0);
        Drawing {
            name,
            kind,
            title: self.is_so().then(|| self.text(&['\n', '\t', '\u{7f}', '\0'])),
            x,
            y,
            of,
            at,
            panels: Vec::new(),
            cycles: self.is_so().then_some([from, from + 0.5]),
            sweep: self.is_so().then(|| self.one(&[Sweep::Upward, Sweep::Downward])),
            colours: self.colours(kind),
            budget,
            colour_by: (kind.keys().coloured && self.is_so())
                .then(|| self.one(&COLOURED_BY).to_owned()),
            curves: kind == DrawingKind::Map && self.is_so(),
            branches: self.is_so(),
            width_mm: self.is_so().then(|| self.uniform(40.0, 200.0)),
            height_mm: self.is_so().then(|| self.uniform(40.0, 200.0)),
            dpi: self.is_so().then(|| self.uniform(50.0, 2400.0)),
            marker_mm: self.is_so().then(|| self.uniform(0.02, 5.0)),
            hide: self.some(kind.keys().marks).into_iter().map(str::to_owned).collect(),
            texts: self.texts(),
            legend: self.is_so(),
            data: self.is_so(),
            svg_text: self.is_so(),
            settings: self.settings(),
        }
    }

    /// Colours of attractors in a figure of a kind that shows these.
    fn colours(&mut self, kind: DrawingKind) -> AttractorColours {
        let count = if kind.keys().attractors { self.below(4) } else { 0 };
        let byte = |it: &mut Random| it.below(256) as u8;
        let colour = |it: &mut Random| Colour([byte(it), byte(it), byte(it)]);
        (0..count).map(|_| (self.below(1000) as u32, colour(self))).collect()
    }

    fn texts(&mut self) -> Texts {
        let names = ["omega", "delta", "progression_speed", "period", "k2"];
        let place = |it: &mut Random| {
            let first = it.below(4);
            let second = first + 1 + it.below(4 - first);
            [first, second].map(|at| (names[at].to_owned(), it.number(Allowed::Finite)))
        };
        (0..self.below(3))
            .map(|_| (format!("k{}", self.text(&['$', '_'])), place(self).into()))
            .collect()
    }

    fn settings(&mut self) -> Settings {
        let names = ["omega", "delta", "progression_speed", "section_r", "period", "start_phase"];
        let names = self.some(&names);
        names.into_iter().map(|name| (name.to_owned(), self.quantity_settings(name))).collect()
    }

    fn quantity_settings(&mut self, name: &str) -> QuantitySettings {
        let low = self.uniform(1e-3, 1.0);
        let width = self.is_so().then(|| self.uniform(1e-6, 1e-3));
        let scales = [ScaleChoice::Linear, ScaleChoice::Log, ScaleChoice::Symlog(width)];
        let unit = if name == "omega" { ["rad/s", "Hz", NATURAL] } else { ["um", "mm", "m"] };
        let has_unit = ["omega", "delta", "section_r"].contains(&name);
        let maps = ColourMap::NAMES.iter().map(|(_, map)| *map).collect::<Vec<_>>();
        // A quantity of which nothing is set is not written.
        QuantitySettings {
            limits: self.is_so().then_some([low, low + 0.25]),
            scale: Some(self.one(&scales)),
            unit: (has_unit && self.is_so()).then(|| self.one(&unit)),
            label: self.is_so().then(|| self.text(&[])),
            decimals: self.is_so().then(|| self.below(13)),
            colour_map: self
                .is_so()
                .then(|| Colouring { map: self.one(&maps), reversed: self.is_so() }),
            centre: self.is_so().then(|| self.number(Allowed::Finite)),
            contours: (0..self.below(3)).map(|_| self.number(Allowed::Finite)).collect(),
        }
    }
}
