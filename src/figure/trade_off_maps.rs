//! The motion with the most gain of each cell of a plane, as the fastest, and what it costs, side by side, with the front of the trade-off
//! on both.

use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn};
use super::colour::Colours;
use super::data::Value;
use super::error::FigureError;
use super::geometry::Point;
use super::header::{Entry, Header, Mark};
use super::kind::{Kind, Needs};
use super::page::{NO_ROOM, PageRequest, PanelRequest, letter};
use super::panel::{Panel, Pointing};
use super::plane::Plane;
use super::raster::Fill;
use super::style::{INK, PAPER, TWO_COLUMNS};
use super::symbol::Symbol;
use super::text::Text;
use super::trade_off::KIND as TRADE_OFF;
use super::trade_off_fronts::marked;
use super::trade_off_motions::{Best, DIRECTIONS, Motions};
use super::trade_off_outputs::outputs;
use super::view::View;
use crate::campaign::KeptFront;
use crate::study::Coordinate;
use crate::tradeoff::{Candidate, GainAndCost};

/// Height of the frames [pt].
const HEIGHT: f64 = 158.0;
/// Radius of a motion of the front, and of the rim that lifts it off the colours [pt].
const DOT: [f64; 2] = [0.8, 1.4];

/// The kind of figure; it reads what a trade-off reads.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads: TRADE_OFF.reads, draw };

/// The motions of the fronts over two axes, in the units of the figure.
struct Path {
    points: Vec<(f64, f64)>,
    /// The optima, those that matter least first.
    optima: Vec<(Symbol, (f64, f64))>,
}

impl Path {
    fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        let places: Vec<Point> = panel.places(&self.points);
        for (colour, radius) in [(PAPER, DOT[1]), (INK, DOT[0])] {
            let discs: Vec<_> = places.iter().map(|at| (*at, colour)).collect();
            canvas.discs(&discs, radius);
        }
        panel.record(canvas, "motions of the fronts", self.points.iter().copied());
        for (symbol, (x, y)) in &self.optima {
            if panel.holds(*x, *y) {
                symbol.draw(canvas, panel.place(*x, *y));
                panel.record(canvas, symbol.words, [(*x, *y)]);
            }
        }
    }
}

/// A map: a quantity of the motion with the most gain of each cell.
struct BestMap {
    colours: Option<Colours>,
    /// The value of each cell in the unit shown; NaN where no motion takes part.
    values: Vec<f64>,
}

impl BestMap {
    /// The map of the quantity of this name, from the values of the cells (SI).
    fn of(view: &View<'_>, name: &str, values: impl Iterator<Item = Option<f64>>) -> BestMap {
        let quantity = view.quantity(name);
        let values: Vec<f64> =
            values.map(|value| value.map_or(f64::NAN, |it| it * quantity.factor)).collect();
        BestMap { colours: Colours::for_values(&values, quantity), values }
    }

    /// How a cell is filled.
    fn fill(&self, cell: usize) -> Fill {
        let value = self.values[cell];
        let colours = self.colours.as_ref().filter(|it| value.is_finite() && it.has(value));
        Fill::of(colours.map(|it| it.of(value)))
    }

    /// Room beside a frame of this height for the bar [pt].
    fn room(&self, height: f64) -> f64 {
        self.colours.as_ref().map_or(0.0, |it| it.room(height))
    }

    /// Draws the cells.
    fn draw(&self, canvas: &mut Canvas, panel: &Panel, plane: &Plane<'_>) {
        plane.draw(canvas, panel, |cell| self.fill(cell));
        let told = self.colours.as_ref().map_or(String::new(), Colours::told);
        plane.record(canvas, panel, &told, |cell| Value::Number(self.values[cell]));
    }
}

/// Draws the maps that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let shown = Maps::of(view)?;
    let path = shown.path()?;
    let best = shown.most_gain();
    let gains = best.iter().map(|it| it.map(|motion| motion.gain));
    let prices = best.iter().map(|it| it.map(|motion| motion.price));
    let maps = [
        BestMap::of(view, shown.of.gain.name(), gains),
        BestMap::of(view, shown.of.cost.name(), prices),
    ];
    let legend = shown.legend(&path, best.iter().any(Option::is_none));
    let page = PageRequest {
        column_room: &|height| maps.iter().map(|it| it.room(height)).fold(0.0, f64::max),
        ..shown.page(legend)
    };
    let (mut canvas, panels) = page.lay_out();
    for (panel, map) in panels.iter().flatten().zip(&maps) {
        map.draw(&mut canvas, panel, &shown.plane);
        path.draw(&mut canvas, panel);
        panel.finish(&mut canvas);
        if let Some(colours) = &map.colours {
            colours.draw_bar(&mut canvas, panel.frame);
        }
    }
    Ok(canvas.finish(&shown.about()))
}

/// What both maps show.
struct Maps<'v, 'a> {
    view: &'v View<'a>,
    plane: Plane<'a>,
    /// The gain and the cost.
    of: GainAndCost,
    free: Vec<&'a str>,
    motions: Motions<'a>,
    /// The best in each direction, without what the request hides.
    best: [Best; 2],
    /// How many motions the front has in each direction.
    on_fronts: [usize; 2],
    /// What was found between the cases under conditions, which the maps do not show.
    under_conditions: Vec<&'a KeptFront>,
}

impl<'v, 'a> Maps<'v, 'a> {
    fn of(view: &'v View<'a>) -> Result<Self, FigureError> {
        let plane = Plane::of(view, "maps of a trade-off")?;
        let of = outputs(view)?;
        let free = view.free_axes();
        let (alone, under_conditions): (Vec<&KeptFront>, Vec<&KeptFront>) =
            view.refined.iter().partition(|it| it.conditions.is_empty());
        // Where an axis is held, motions between the cases may lie anywhere along it.
        let is_whole = free.len() == view.axes().len();
        let sought = alone.first().copied().filter(|_| is_whole);
        let motions = Motions::of(view, of, &free, sought)?;
        let best = DIRECTIONS.map(|direction| motions.best(direction));
        let on_fronts = best.each_ref().map(|best| best.front.len());
        let best = best.map(|best| best.shown(view));
        Ok(Maps { view, plane, of, free, motions, best, on_fronts, under_conditions })
    }

    /// Where the motions of the fronts, and the optima, are over the plane.
    fn path(&self) -> Result<Path, FigureError> {
        let x = MotionAxis::of(self.view, self.plane.x_name, &self.free)?;
        let y = MotionAxis::of(self.view, self.plane.y_name, &self.free)?;
        let fronts = self.best.iter().flat_map(|best| &best.of_all.front);
        let fronts = fronts.map(|&at| self.motions.at(at));
        let points = fronts.map(|it| (x.value(&self.motions, it), y.value(&self.motions, it)));
        let optima = self.best.iter().flat_map(|best| marked(&self.motions, best));
        let optima = optima
            .map(|(symbol, it)| (symbol, (x.value(&self.motions, it), y.value(&self.motions, it))));
        Ok(Path { points: points.collect(), optima: optima.collect() })
    }

    /// The motion with the most gain among the cases of each cell, by its magnitude; none where no case of a cell takes part.
    fn most_gain(&self) -> Vec<Option<&Candidate>> {
        let Maps { view, plane, motions, .. } = self;
        let mut best: Vec<Option<&Candidate>> = vec![None; plane.count()];
        let [row, column] =
            [plane.y_name, plane.x_name].map(|axis| view.places_along(axis, &self.free));
        for motion in motions.cases().iter().filter(|it| motions.counts(it)) {
            let cell = &mut best[row(motion.case) * plane.x.count() + column(motion.case)];
            if cell.is_none_or(|known| motion.gain.abs() > known.gain.abs()) {
                *cell = Some(motion);
            }
        }
        best
    }

    /// The free axes with several values over which the motion with the most gain of a cell is taken.
    fn searched(&self) -> Vec<&'a str> {
        let axes = [self.plane.x_name, self.plane.y_name];
        let others = self.free.iter().copied().filter(|name| !axes.contains(name));
        others.filter(|name| self.view.coordinate_values(name).len() > 1).collect()
    }

    /// What the marks mean; cells without a motion are told where there are some.
    fn legend(&self, path: &Path, has_gaps: bool) -> Vec<Entry> {
        let mut legend = Vec::new();
        let names = self.searched().into_iter().map(|name| self.view.quantity(name).short_name());
        let names = names.reduce(|names, name| names.then(Text::plain(", ")).then(name));
        let over = match self.of.has_own_gain() {
            true => "fastest motion over ",
            false => "most gain over ",
        };
        legend.extend(names.map(|it| (Mark::Nothing, Text::plain(over).then(it))));
        if !path.points.is_empty() {
            legend.push((Mark::Disc(INK, DOT[0]), Text::plain("Pareto fronts")));
            for (symbol, _) in &path.optima {
                let entry = (Mark::Symbol(*symbol), Text::plain(symbol.words));
                if !legend.contains(&entry) {
                    legend.push(entry);
                }
            }
        }
        if has_gaps {
            let text = Text::plain("no motion that takes part");
            legend.push((Mark::Filled(Fill::NO_VALUE), text));
        }
        legend
    }

    /// The page of both maps, the first under the legend.
    fn page(&self, legend: Vec<Entry>) -> PageRequest<'_> {
        let Maps { view, plane, .. } = self;
        let row =
            [legend, Vec::new()].into_iter().enumerate().map(|(place, legend)| PanelRequest {
                x: AxisRequest::new(view.quantity(plane.x_name), plane.x.scale),
                y: AxisRequest::new(view.quantity(plane.y_name), plane.y.scale),
                header: Header {
                    letter: letter(place, 2),
                    note: view.held_note(&self.free),
                    legend,
                },
            });
        PageRequest {
            drawing: view.drawing,
            width_mm: TWO_COLUMNS,
            heights: vec![HEIGHT],
            rows: vec![row.collect()],
            column_room: NO_ROOM,
            right_room: NO_ROOM,
            bottom_room: 0.0,
            pointing: Pointing::Outward,
        }
    }

    /// What the figure shows and leaves out, in a sentence kept inside its files.
    fn about(&self) -> String {
        let shown = self.of.both().map(|it| it.name().to_owned());
        let about = self.view.about(&shown, &self.free);
        let best = match self.of.has_own_gain() {
            true => "the fastest motion",
            false => "the motion with the most gain",
        };
        let over = self.searched();
        let among =
            if over.is_empty() { String::new() } else { format!(" over {}", over.join(", ")) };
        let [forward, backward] = self.on_fronts;
        format!(
            "{about}; in each cell over {} {best}{among}, aperiodic ones by their means; the fronts have {forward} \
             motions forward and {backward} backward, {} periodic motions between the cases take part{}{}",
            [self.plane.x_name, self.plane.y_name].join(", "),
            self.motions.between(),
            self.motions.searched().map_or(String::new(), |it| format!(
                ", found by local search: {}; better ones may lie elsewhere",
                it.in_words()
            )),
            not_shown(&self.under_conditions)
        )
    }
}

/// How many motions were found under conditions, which the maps do not show; nothing of none.
fn not_shown(others: &[&KeptFront]) -> String {
    let motions: usize = others.iter().map(|it| it.motions.len()).sum();
    let conditions: Vec<String> = others.iter().map(|it| it.condition()).collect();
    match motions {
        0 => String::new(),
        _ => format!("; {motions} that were found where {} are not shown", conditions.join("; ")),
    }
}

/// An axis of the maps as a coordinate of motions.
struct MotionAxis {
    coordinate: Coordinate,
    /// The value of each case (SI).
    of_case: Vec<f64>,
    /// Value shown per value in SI.
    factor: f64,
}

impl MotionAxis {
    /// Fails if the axis is no coordinate of a motion.
    fn of(view: &View<'_>, name: &str, free: &[&str]) -> Result<MotionAxis, FigureError> {
        let coordinate = Coordinate::all(view.model()).find(|it| it.name() == name);
        let coordinate = coordinate
            .ok_or_else(|| view.unfit(format!("`{name}` is no parameter or start of a motion")))?;
        let of_case = view.parameter(name, free)?.into_iter().collect();
        Ok(MotionAxis { coordinate, of_case, factor: view.quantity(name).factor })
    }

    /// Where a motion is along it, in the unit shown.
    fn value(&self, motions: &Motions<'_>, motion: &Candidate) -> f64 {
        motions.coordinate(motion, self.coordinate, &self.of_case) * self.factor
    }
}
