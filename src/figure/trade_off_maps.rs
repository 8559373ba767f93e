//! The fastest motion of each cell of a plane and what it costs, side by side, with the front of the trade-off on both.

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
use super::trade_off::{KIND as TRADE_OFF, price};
use super::trade_off_fronts::marked;
use super::trade_off_motions::{Best, DIRECTIONS, Motions, value_of};
use super::view::View;
use crate::campaign::KeptFront;
use crate::study::Coordinate;
use crate::tradeoff::Candidate;

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

/// Draws the maps that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let plane = Plane::of(view, "maps of a trade-off")?;
    let price = price(view.drawing, view.model());
    let free = view.free_axes();
    let under = |it: &&KeptFront| !it.conditions.is_empty();
    let alone = view.refined.iter().find(|it| !under(it));
    let motions = Motions::of(view, (price, &free), alone.filter(|_| is_whole(view, &free)))?;
    let others: Vec<&KeptFront> = view.refined.iter().filter(under).collect();
    let best = DIRECTIONS.map(|direction| motions.best(direction));
    let axes = [plane.x_name, plane.y_name];
    let [forward, backward] = [0, 1].map(|it| best[it].front.len());
    let best = best.map(|best| best.shown(view));
    let path = path(view, (&free, axes), (&motions, &best))?;
    let fastest = fastest(view, (&free, &plane), &motions);
    let speed = |motion: &Candidate| motion.speed;
    let cost = |motion: &Candidate| motion.price;
    let shown = [(view.model().speed().name(), speed as fn(&Candidate) -> f64), (price, cost)].map(
        |(name, of)| {
            let quantity = view.quantity(name);
            let value =
                |it: &Option<&Candidate>| it.map_or(f64::NAN, |it| of(it) * quantity.factor);
            let values: Vec<f64> = fastest.iter().map(value).collect();
            (Colours::for_values(&values, quantity), values)
        },
    );
    let over: Vec<&str> = searched(view, (&free, axes));
    let room = |height: f64| {
        let rooms = shown.iter().filter_map(|(colours, _)| Some(colours.as_ref()?.room(height)));
        rooms.fold(0.0, f64::max)
    };
    let legend = legend(view, &path, (fastest.iter().any(Option::is_none), &over));
    let panel = |place: usize| PanelRequest {
        x: AxisRequest::new(view.quantity(axes[0]), plane.x.scale),
        y: AxisRequest::new(view.quantity(axes[1]), plane.y.scale),
        header: Header {
            letter: letter(place, shown.len()),
            note: view.held_note(&free),
            legend: if place == 0 { legend.clone() } else { Vec::new() },
        },
    };
    let page = PageRequest {
        drawing: view.drawing,
        width_mm: TWO_COLUMNS,
        heights: vec![HEIGHT],
        rows: vec![(0..shown.len()).map(panel).collect()],
        column_room: &room,
        right_room: NO_ROOM,
        bottom_room: 0.0,
        pointing: Pointing::Outward,
    };
    let (mut canvas, panels) = page.lay_out();
    for (panel, (colours, values)) in panels.iter().flatten().zip(&shown) {
        let colour = |case: usize| {
            let value = values[case];
            let colours = colours.as_ref().filter(|it| value.is_finite() && it.has(value));
            Fill::of(colours.map(|it| it.of(values[case])))
        };
        plane.draw(&mut canvas, panel, colour);
        let told = colours.as_ref().map_or(String::new(), Colours::told);
        plane.record(&mut canvas, panel, &told, |case| Value::Number(values[case]));
        path.draw(&mut canvas, panel);
        panel.finish(&mut canvas);
        if let Some(colours) = colours {
            colours.draw_bar(&mut canvas, panel.frame);
        }
    }
    let about = view.about(&[view.model().speed().name().to_owned(), price.to_owned()], &free);
    let among = if over.is_empty() { String::new() } else { format!(" over {}", over.join(", ")) };
    Ok(canvas.finish(&format!(
        "{about}; in each cell over {} the fastest motion{among}, aperiodic ones by their means; the fronts have {forward} \
         motions forward and {backward} backward, {} periodic motions between the cases take part{}{}",
        axes.join(", "),
        motions.between(),
        motions.searched().map_or(String::new(), |it| format!(
            ", found by local search: {}; better ones may lie elsewhere",
            it.in_words()
        )),
        not_shown(&others)
    )))
}

/// Whether no axis is held, along which motions between the cases may lie anywhere.
fn is_whole(view: &View<'_>, free: &[&str]) -> bool {
    free.len() == view.axes().len()
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

/// Where the motions of the fronts, and the optima, are over two axes.
fn path(
    view: &View<'_>,
    (free, axes): (&[&str], [&str; 2]),
    (motions, best): (&Motions<'_>, &[Best]),
) -> Result<Path, FigureError> {
    let mut along = Vec::new();
    for name in axes {
        let coordinate = Coordinate::all(view.model()).find(|it| it.name() == name);
        let coordinate = coordinate
            .ok_or_else(|| view.unfit(format!("`{name}` is no parameter or start of a motion")))?;
        let of_case: Vec<f64> = view.parameter(name, free)?.into_iter().collect();
        along.push((coordinate, of_case, view.quantity(name).factor));
    }
    let place = |motion: &Candidate| {
        let value = |(coordinate, of_case, factor): &(Coordinate, Vec<f64>, f64)| {
            value_of((motion, motions.refined(motion)), *coordinate, of_case) * factor
        };
        (value(&along[0]), value(&along[1]))
    };
    let fronts = best.iter().flat_map(|best| &best.of_all.front);
    let points = fronts.map(|&at| place(motions.at(at))).collect();
    let optima = best.iter().flat_map(|best| marked(motions, best));
    let optima = optima.map(|(symbol, motion)| (symbol, place(motion))).collect();
    Ok(Path { points, optima })
}

/// The free axes with several values over which the fastest motion of a cell is taken.
fn searched<'a>(view: &View<'a>, (free, axes): (&[&'a str], [&str; 2])) -> Vec<&'a str> {
    let is_other = |name: &&&str| !axes.contains(*name) && view.coordinate_values(name).len() > 1;
    free.iter().filter(is_other).copied().collect()
}

/// The fastest motion among the cases of each cell, by its magnitude; none where no case of a cell takes part.
fn fastest<'m>(
    view: &View<'_>,
    (free, plane): (&[&str], &Plane<'_>),
    motions: &'m Motions<'_>,
) -> Vec<Option<&'m Candidate>> {
    let mut fastest: Vec<Option<&Candidate>> = vec![None; plane.count()];
    let [row, column] = [plane.y_name, plane.x_name].map(|axis| view.places_along(axis, free));
    for motion in motions.cases().iter().filter(|it| motions.counts(it)) {
        let cell = &mut fastest[row(motion.case) * plane.x.count() + column(motion.case)];
        if cell.is_none_or(|known| motion.speed.abs() > known.speed.abs()) {
            *cell = Some(motion);
        }
    }
    fastest
}

/// What the marks mean.
fn legend(view: &View<'_>, path: &Path, (has_gaps, over): (bool, &[&str])) -> Vec<Entry> {
    let said = |what: &str| Text::plain(what);
    let mut legend = Vec::new();
    let names = over.iter().map(|name| view.quantity(name).short_name());
    let names = names.reduce(|names, name| names.then(said(", ")).then(name));
    legend.extend(names.map(|it| (Mark::Nothing, said("fastest motion over ").then(it))));
    if !path.points.is_empty() {
        legend.push((Mark::Disc(INK, DOT[0]), said("Pareto fronts")));
        for (symbol, _) in &path.optima {
            let entry = (Mark::Symbol(*symbol), said(symbol.words));
            if !legend.contains(&entry) {
                legend.push(entry);
            }
        }
    }
    if has_gaps {
        legend.push((Mark::Filled(Fill::NO_VALUE), said("no motion that takes part")));
    }
    legend
}
