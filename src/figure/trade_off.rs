//! Progression speed against an energy or the power that it takes, and the best of both.

use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn};
use super::category;
use super::cloud::{self, Dot};
use super::data::Value;
use super::error::FigureError;
use super::header::{Entry, Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::optima_table::Table;
use super::outcome;
use super::page::{NO_ROOM, PageRequest, PanelRequest};
use super::paint::Paint;
use super::panel::{Panel, Pointing};
use super::style::{BLUE, FAINT_INK, ONE_COLUMN, UNDECIDED_DOT};
use super::text::Text;
use super::trade_off_fronts::{Front, marked};
use super::trade_off_motions::{Best, Motions};
use super::trade_off_table::{BETWEEN, OPEN, table};
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{self, DRAW};
use crate::study::{Coordinate, Drawing};
use crate::tradeoff::Candidate;

/// Height of the frame [pt].
const HEIGHT: f64 = 158.0;

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// The name of the output that should be small: the work of a cycle, unless another is asked for.
pub fn price<'d>(drawing: &'d Drawing, model: &'static Description) -> &'d str {
    drawing.of.first().map_or(model.work().name(), String::as_str)
}

/// What a trade-off reads: both quantities, the energy per metre, what was drawn, and the outcomes.
fn reads(drawing: &Drawing, model: &'static Description) -> Names {
    let drawn = Coordinate::all(model).map(|it| it.name().to_owned());
    Names::of(outcome::READS)
        .and([model.speed(), model.energy_per_distance()].map(catalogue::Entry::of_output))
        .and(category::reads(model))
        .and_named(drawing.colour_by.clone())
        .and_named(drawn.chain([price(drawing, model).to_owned()]))
}

/// A trade-off that is drawn.
struct TradeOff<'v, 'a> {
    view: &'v View<'a>,
    /// The name of the output that should be small.
    price: &'v str,
    /// Price and speed shown per SI unit.
    factors: [f64; 2],
    free: &'v [&'a str],
    /// The fronts with the motions that they are among: that without conditions first.
    fronts: Vec<Front<'a>>,
    /// The colours of the cases.
    paint: Option<Paint>,
}

/// Draws the trade-off that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let price = price(view.drawing, view.model());
    let free = view.free_axes();
    let fronts = Front::all(view, price, &free)?;
    let paint = paint(view, &free)?;
    let factors = [price, view.model().speed().name()].map(|name| view.quantity(name).factor);
    let shown = TradeOff { view, price, factors, free: &free, fronts, paint };
    let table = table((view, &free), price, &shown.fronts)?;
    let bar = |height: f64| shown.paint.as_ref().map_or(0.0, |it| it.room(height));
    let page = PageRequest { right_room: &bar, ..shown.request(&table) };
    let (mut canvas, panels) = page.lay_out();
    for panel in panels.iter().flatten() {
        shown.draw(&mut canvas, panel);
        if let Some(paint) = &shown.paint {
            paint.explain(&mut canvas, panel.frame);
        }
        panel.finish(&mut canvas);
    }
    table.draw_below(&mut canvas);
    Ok(canvas.finish(&shown.about()))
}

impl TradeOff<'_, '_> {
    /// All cases, with what was found between them without conditions.
    fn motions(&self) -> &Motions<'_> {
        &self.fronts[0].motions
    }

    /// Price and speed of a motion in the units of the figure.
    fn place(&self, (price, speed): (f64, f64)) -> (f64, f64) {
        let [of_price, of_speed] = self.factors;
        (price * of_price, speed * of_speed)
    }

    /// The radius of the points of cases [pt].
    fn radius(&self, count: usize) -> f64 {
        let usual = if self.view.drawing.marker_mm.is_some() { 1.0 } else { 1.4 };
        usual * cloud::radius(self.view.drawing, count)
    }

    fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        panel.mark_zero(canvas);
        let motions = self.motions();
        let crowding = motions.cases().len() as f64;
        let dot = |case: &Candidate| {
            let own = |paint: &Paint| paint.colour(case.case).unwrap_or(UNDECIDED_DOT);
            let colour = self.paint.as_ref().map_or(BLUE, own);
            let colour = if motions.is_periodic(case) { colour } else { FAINT_INK };
            Dot { at: self.place((case.price, case.speed)), colour, crowding, case: 0 }
        };
        let (periodic, others): (Vec<&Candidate>, Vec<&Candidate>) =
            motions.cases().iter().partition(|case| motions.is_periodic(case));
        let dots: Vec<_> = others.into_iter().chain(periodic).map(dot).collect();
        cloud::draw(canvas, panel, &dots, self.radius(dots.len()));
        let value = |case: &Candidate| {
            self.paint.as_ref().map_or(Value::None, |paint| paint.value(case.case))
        };
        let told = self.paint.as_ref().map_or(String::new(), |it| format!(", {}", it.told()));
        for (periodic, name) in [(true, "periodic cases"), (false, "other cases")] {
            let ours = motions.cases().iter().filter(|it| motions.is_periodic(it) == periodic);
            let rows = ours.map(|it| (self.place((it.price, it.speed)), value(it)));
            panel.record_values(canvas, &format!("{name}{told}"), rows);
        }
        for front in &self.fronts {
            front.draw(canvas, panel, |it| self.place(it));
        }
    }

    /// What the figure shows and leaves out, in a sentence kept inside its files.
    fn about(&self) -> String {
        let shows = self.view.about(
            &[self.view.model().speed().name().to_owned(), self.price.to_owned()],
            self.free,
        );
        let motions = self.motions();
        let [by_means, undecided] = motions.aperiodic();
        let between: Vec<String> = self.fronts.iter().map(Front::about).collect();
        let not_shown: usize = match self.free.len() == self.view.axes().len() {
            true => 0,
            false => self.view.refined.iter().map(|it| it.motions.len()).sum(),
        };
        let not_shown = match not_shown {
            0 => String::new(),
            count => format!(
                "; {count} motions found between the cases are not shown where an axis is held"
            ),
        };
        format!(
            "{shows}; {} periodic cases, {by_means} others as means over their cycles, {undecided} undecided, {} without values, {}{not_shown}; the fronts \
             are of motions that are not undecided and move faster than {:.1e} m/s",
            motions.cases().len() - by_means - undecided,
            motions.left_out,
            between.join("; "),
            motions.at_rest
        )
    }

    /// What the marks mean, and how many cases are shown otherwise or not at all.
    fn legend<'s>(&'s self) -> Vec<Entry> {
        let mut legend = Vec::new();
        let motions = self.motions();
        let said = |what: String| Text::plain(&what);
        legend.extend(self.fronts.iter().flat_map(Front::legend));
        let refined = |front: &'s Front<'_>, best: &'s Best| {
            let optima = marked(&front.motions, best).into_iter();
            optima.filter_map(|(_, motion)| front.motions.refined(motion)).collect::<Vec<_>>()
        };
        let all = self.fronts.iter().flat_map(|front| front.best.iter().map(move |it| (front, it)));
        let between: Vec<_> = all.flat_map(|(front, best)| refined(front, best)).collect();
        if self.fronts.iter().any(|front| front.motions.between() > 0) {
            legend.push((
                Mark::Nothing,
                said(format!("{BETWEEN} between the cases, by local search")),
            ));
        }
        if between.iter().any(|it| it.is_open()) {
            legend.push((Mark::Nothing, said(format!("{OPEN} not converged"))));
        }
        let [by_means, undecided] = motions.aperiodic();
        for (count, words) in
            [(by_means, "not periodic, by their means"), (undecided, "undecided, so on no front")]
        {
            if count > 0 {
                legend.push((Mark::Disc(FAINT_INK, 1.4), said(format!("{words}: {count}"))));
            }
        }
        if motions.left_out > 0 {
            let text = said(format!("without values, left out: {}", motions.left_out));
            legend.push((Mark::Nothing, text));
        }
        legend
    }

    fn request(&self, table: &Table) -> PageRequest<'_> {
        let (view, motions) = (self.view, self.motions());
        let best = self.fronts.iter().flat_map(|front| &front.best);
        let fronts = best.flat_map(|best| best.front.iter().copied());
        let cases = motions.cases().iter().map(|it| (it.price, it.speed));
        let (prices, speeds): (Vec<f64>, Vec<f64>) =
            cases.chain(fronts).map(|it| self.place(it)).unzip();
        let legend = if prices.len() > 1 { self.legend() } else { Vec::new() };
        let panel = PanelRequest {
            x: AxisRequest::around(view.quantity(self.price), &prices, 0.04),
            y: AxisRequest::around(view.quantity(view.model().speed().name()), &speeds, 0.06),
            header: Header { legend, note: view.held_note(self.free), ..Header::default() },
        };
        PageRequest {
            drawing: view.drawing,
            width_mm: ONE_COLUMN,
            heights: vec![HEIGHT],
            rows: vec![vec![panel]],
            column_room: NO_ROOM,
            right_room: NO_ROOM,
            bottom_room: table.room(),
            pointing: Pointing::Inward,
        }
    }
}

/// The colours of the cases: by what the request names, else by the axis `x` or the first that varies.
fn paint(view: &View<'_>, free: &[&str]) -> Result<Option<Paint>, FigureError> {
    let long = |name: &&&str| **name != DRAW.name && view.coordinate_values(name).len() > 1;
    let wanted = view.drawing.colour_by.as_deref().or(view.drawing.x.as_deref());
    let Some(name) = wanted.or_else(|| free.iter().find(long).copied()) else {
        return Ok(None);
    };
    let cases = free.iter().map(|axis| view.coordinate_values(axis).len()).product();
    Paint::of((view, std::slice::from_ref(view)), name, (free, cases)).map(Some)
}
