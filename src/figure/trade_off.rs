//! A gain, as the progression speed, against what it takes, as an energy or the power, and the best of both.

use super::axis::AxisRequest;
use super::canvas::{Canvas, Dash, Drawn, Stroke};
use super::category;
use super::cloud::{self, Dot};
use super::data::Value;
use super::error::FigureError;
use super::header::{Entry, Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::optima_table::Table;
use super::outcome::{self, told_of_missing};
use super::page::{NO_ROOM, PageRequest, PanelRequest};
use super::paint::Paint;
use super::panel::{Panel, Pointing};
use super::style::{BLUE, FAINT_INK, INK, ONE_COLUMN, REFERENCE_WIDTH, UNDECIDED_DOT};
use super::text::Text;
use super::trade_off_fronts::{Factors, Front};
use super::trade_off_motions::Motions;
use super::trade_off_outputs::{gain_of, names, outputs};
use super::trade_off_table::{BETWEEN, OPEN, table};
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{self, DRAW};
use crate::study::{Coordinate, Drawing};
use crate::tradeoff::{Candidate, GainAndCost, unit_behind};

/// Height of the frame [pt].
const HEIGHT: f64 = 158.0;

/// The line at the most of the cost that may be spent.
const BUDGET: Stroke = Stroke { colour: INK, width: REFERENCE_WIDTH, dash: Dash::Usual };

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What a trade-off reads: both quantities, of the speed the energy per metre, what was drawn, and the outcomes.
fn reads(drawing: &Drawing, model: &'static Description) -> Names {
    let drawn = Coordinate::all(model).map(|it| it.name().to_owned());
    let named = names(drawing, model);
    let has_own_gain = gain_of(drawing, model) == GainAndCost::own_gain(model);
    let told_per_gain =
        (has_own_gain && model.has_trade_off()).then(|| model.energy_per_distance());
    Names::of(outcome::READS)
        .and(told_per_gain.map(catalogue::Entry::of_output))
        .and(category::reads(model))
        .and_named(drawing.colour_by.clone())
        .and_named(drawn.chain(named.into_iter().flatten().map(str::to_owned)))
}

/// A trade-off that is drawn.
struct TradeOff<'v, 'a> {
    view: &'v View<'a>,
    /// The gain and the cost.
    of: GainAndCost,
    factors: Factors,
    free: &'v [&'a str],
    /// The fronts with the motions that they are among: that without conditions first.
    fronts: Vec<Front<'a>>,
    /// The colours of the cases.
    paint: Option<Paint>,
}

/// Draws the trade-off that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let of = outputs(view)?;
    let free = view.free_axes();
    let fronts = Front::all(view, of, &free)?;
    let paint = paint(view, &free)?;
    let factors = Factors::of(view, of);
    let shown = TradeOff { view, of, factors, free: &free, fronts, paint };
    let table = table(view, of, &free, &shown.fronts)?;
    let page = PageRequest {
        right_room: &|height| shown.paint.as_ref().map_or(0.0, |it| it.room(height)),
        ..shown.request(&table)
    };
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

    /// The radius of the points of cases [pt].
    fn radius(&self, count: usize) -> f64 {
        let usual = if self.view.drawing.marker_mm.is_some() { 1.0 } else { 1.4 };
        usual * cloud::radius(self.view.drawing, count)
    }

    fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        panel.mark_zero(canvas);
        let motions = self.motions();
        let (periodic, others): (Vec<&Candidate>, Vec<&Candidate>) =
            motions.cases().iter().partition(|case| motions.is_periodic(case));
        let dots: Vec<Dot> = others.iter().chain(&periodic).map(|case| self.dot(case)).collect();
        cloud::draw(canvas, panel, &dots, self.radius(dots.len()));
        let told = self.paint.as_ref().map_or(String::new(), |it| format!(", {}", it.told()));
        for (cases, name) in [(periodic, "periodic cases"), (others, "other cases")] {
            let rows = cases.into_iter().map(|case| (self.factors.place(case), self.value(case)));
            panel.record_values(canvas, &format!("{name}{told}"), rows);
        }
        self.draw_budget(canvas, panel);
        for front in &self.fronts {
            front.draw(canvas, panel, self.factors);
        }
    }

    /// Draws a line at the most of the cost that may be spent.
    fn draw_budget(&self, canvas: &mut Canvas, panel: &Panel) {
        let Some(at) = self.budget() else { return };
        let [low, high] = [panel.y.scale.low, panel.y.scale.high];
        panel.curve(canvas, &[(at, low), (at, high)], BUDGET);
        panel.record(canvas, "budget", [(at, low), (at, high)]);
    }

    /// The most of the cost that may be spent, in the unit of the figure.
    fn budget(&self) -> Option<f64> {
        self.view.drawing.budget.map(|most| most * self.factors.price)
    }

    /// The point of a case, of a faint colour if it is not periodic.
    fn dot(&self, case: &Candidate) -> Dot {
        let motions = self.motions();
        let colour = match &self.paint {
            _ if !motions.is_periodic(case) => match motions.counts(case) {
                true => FAINT_INK,
                false => UNDECIDED_DOT,
            },
            Some(paint) => paint.colour(case.case).unwrap_or(UNDECIDED_DOT),
            None => BLUE,
        };
        let crowding = motions.cases().len() as f64;
        Dot { at: self.factors.place(case), colour, crowding, case: 0 }
    }

    /// What the colour of a case tells.
    fn value(&self, case: &Candidate) -> Value {
        self.paint.as_ref().map_or(Value::None, |paint| paint.value(case.case))
    }

    /// What the figure shows and leaves out, in a sentence kept inside its files.
    fn about(&self) -> String {
        let of = self.of;
        let shows = self.view.about(&of.both().map(|it| it.name().to_owned()), self.free);
        let motions = self.motions();
        let [by_means, undecided] = motions.aperiodic();
        let between: Vec<String> = self.fronts.iter().map(Front::about).collect();
        let counting = match of.has_own_gain() {
            true => format!("move faster than {:.1e} m/s", motions.at_rest),
            false => format!("gain more than {:.1e}{}", motions.at_rest, unit_behind(of.gain)),
        };
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
             are of motions that are not undecided and {counting}",
            motions.cases().len() - by_means - undecided,
            motions.left_out,
            between.join("; ")
        )
    }

    /// What the marks mean, and how many cases are shown otherwise or not at all.
    fn legend(&self) -> Vec<Entry> {
        let motions = self.motions();
        let mut legend: Vec<Entry> = self.fronts.iter().flat_map(Front::legend).collect();
        if let Some(most) = self.view.drawing.budget {
            let cost = self.view.quantity(self.of.cost.name());
            let value = cost.rounded(most).then(Text::plain("\u{a0}")).then(cost.unit());
            let words = Text::plain("budget ").then(value);
            legend.push((Mark::Line(BUDGET), words));
        }
        if self.fronts.iter().any(|front| front.motions.between() > 0) {
            let text = Text::plain(&format!("{BETWEEN} between the cases, by local search"));
            legend.push((Mark::Nothing, text));
        }
        if self.fronts.iter().any(Front::has_open_optima) {
            legend.push((Mark::Nothing, Text::plain(&format!("{OPEN} not converged"))));
        }
        let [by_means, undecided] = motions.aperiodic();
        for (count, words, colour) in [
            (by_means, "not periodic, by their means", FAINT_INK),
            (undecided, "undecided, so on no front", UNDECIDED_DOT),
        ] {
            if count > 0 {
                let text = Text::plain(&format!("{words}: {count}"));
                legend.push((Mark::Disc(colour, 1.4), text));
            }
        }
        let not_yet = told_of_missing(motions.not_yet, motions.count);
        legend.extend(not_yet.map(|words| (Mark::Nothing, Text::plain(&words))));
        if motions.left_out > 0 {
            let text = Text::plain(&format!("without values, left out: {}", motions.left_out));
            legend.push((Mark::Nothing, text));
        }
        legend
    }

    fn request(&self, table: &Table) -> PageRequest<'_> {
        let (view, motions) = (self.view, self.motions());
        let best = self.fronts.iter().flat_map(|front| &front.best);
        let fronts = best.flat_map(|best| self.factors.places(&best.front));
        let cases = motions.cases().iter().map(|case| self.factors.place(case));
        let (mut prices, gains): (Vec<f64>, Vec<f64>) = cases.chain(fronts).unzip();
        prices.extend(self.budget());
        let legend = if prices.len() > 1 { self.legend() } else { Vec::new() };
        let panel = PanelRequest {
            x: AxisRequest::around(view.quantity(self.of.cost.name()), &prices, 0.04),
            y: AxisRequest::around(view.quantity(self.of.gain.name()), &gains, 0.06),
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
    let mut varying = free
        .iter()
        .copied()
        .filter(|name| *name != DRAW.name && view.coordinate_values(name).len() > 1);
    let wanted = view.drawing.colour_by.as_deref().or(view.drawing.x.as_deref());
    let Some(name) = wanted.or_else(|| varying.next()) else { return Ok(None) };
    let cases = free.iter().map(|axis| view.coordinate_values(axis).len()).product();
    Paint::of(view, std::slice::from_ref(view), name, free, &vec![true; cases]).map(Some)
}
