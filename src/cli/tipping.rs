//! `capsulemap tipping`: where motions go when the parameter of a file of basins steps.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};

use super::arguments::{machine, read_quantity};
use super::failure::Failure;
use super::readable::counted;
use super::terminal::print;
use crate::attractor::Share;
use crate::campaign::{BasinsAlong, Stepping};
use crate::run::{Steps, Tipping, TippingRow};
use crate::store;
use crate::store::catalogue::{ATTRACTOR, PERIOD};

const EXAMPLES: &str = "\
Examples:
  capsulemap tipping results/erosion/erosion.h5
  capsulemap tipping FILE.h5 --from \"160 rad/s\" --to \"165 rad/s\" --draws 1000
  capsulemap tipping FILE.h5 --ball 0.05 --json | jq '.steps[0]'

The file is that of a grid of one parameter whose other axes are starts. A motion has settled, and the parameter steps at a \
random moment of its period to the next value, or from one value to another: to which attractors does the motion go? Beside it \
stands where the starts of its basin go.";

/// Find the attractors that orbits left behind by a step of the parameter lead to.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct TippingOptions {
    /// The file of results: basins along a parameter.
    file: PathBuf,
    /// The value before the step, the nearest of the file; each value and the next by default.
    #[arg(long, value_name = "VALUE", requires = "to", allow_hyphen_values = true)]
    from: Option<String>,
    /// The value after the step, the nearest of the file.
    #[arg(long, value_name = "VALUE", requires = "from", allow_hyphen_values = true)]
    to: Option<String>,
    /// Draws of each orbit.
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    draws: u32,
    /// Another one gives other draws.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Radius of the ball in which the state is displaced at the step, in the unit in which section points are compared (SI; of the
    /// capsule m/s, by omega r, y1 and y2).
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    ball: f64,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Worker threads; one per core by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

impl TippingOptions {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = machine(self.threads, None)?;
        let archive = store::open(&self.file).map_err(Failure::request)?;
        let basins = BasinsAlong::of(&archive, &self.file)?;
        let mut faults = Vec::new();
        if !(self.ball.is_finite() && self.ball >= 0.0) {
            let found = self.ball;
            faults
                .push(format!("--ball: {found} is not allowed; expected a number, zero or above"));
        }
        let dimension = basins.along().dimension;
        let [from, to] = [("--from", &self.from), ("--to", &self.to)]
            .map(|(option, text)| read_quantity(option, text.as_deref()?, dimension, &mut faults));
        let steps = basins.steps(from.zip(to).map(|(from, to)| [from, to]));
        if steps.iter().any(|[from, to]| from == to) {
            faults.push(
                "--from and --to are nearest to the same value of the file; expected two"
                    .to_owned(),
            );
        }
        if !faults.is_empty() {
            return Err(Failure::requests(&faults));
        }
        let (draws, seed) = (self.draws as usize, self.seed);
        let found = basins.tipping(&steps, &Steps { draws, seed, ball: self.ball }, machine)?;
        match self.json {
            true => print(&format!("{:#}\n", self.described(basins.along(), &found))),
            false => print(&self.told(basins.along(), &found)),
        }
    }

    fn described(&self, Stepping { name, dimension }: Stepping<'_>, found: &[Tipping]) -> Value {
        let steps = found.iter().map(|step| {
            json!({
                "from": step.values[0],
                "to": step.values[1],
                "attractors": step.rows.iter().map(row).collect::<Vec<_>>(),
            })
        });
        json!({
            "along": name,
            "unit": dimension.unit(),
            "draws": self.draws,
            "seed": self.seed,
            "ball": self.ball,
            "steps": steps.collect::<Vec<_>>(),
        })
    }

    /// A table for each step at which a motion or a start of its basin goes elsewhere.
    fn told(&self, Stepping { name, dimension }: Stepping<'_>, found: &[Tipping]) -> String {
        let unit = dimension.unit();
        let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
        let mut text = format!(
            "where motions go when {name} steps: the probability, and Wilson's interval at 95 percent\n\
             orbit: of a settled motion, at {} of its period; basin: of the starts of the grid that lead to it\n",
            counted(self.draws as usize, "random moment")
        );
        if self.ball > 0.0 {
            let _ = writeln!(text, "the state is displaced in a ball of the radius {}", self.ball);
        }
        let tipping: Vec<&Tipping> = found.iter().filter(|it| it.rows.iter().any(leaves)).collect();
        for step in &tipping {
            let [from, to] = step.values;
            let _ = write!(
                text,
                "\n{name} from {from}{unit} to {to}{unit}\n  attractor  {:<16} to  {:<29}basin\n",
                "motion", "orbit"
            );
            step.rows.iter().for_each(|it| write_row(&mut text, it));
        }
        let others = found.len() - tipping.len();
        if others > 0 {
            let _ = writeln!(
                text,
                "\nat {} every orbit and every start of its basin goes on to the same attractor",
                counted(others, "other step")
            );
        }
        text
    }
}

/// Whether an orbit or a start of its basin goes elsewhere, or where it goes is not known.
fn leaves(row: &TippingRow) -> bool {
    let others = |shares: &[Share]| {
        let elsewhere =
            |(number, it): (usize, &Share)| number != row.attractor as usize && it.starts > 0;
        shares.iter().enumerate().any(elsewhere)
    };
    row.unknown + row.basin_unknown > 0
        || others(&row.orbit)
        || others(&row.basin)
        || row.orbit.is_empty()
}

fn write_row(text: &mut String, row: &TippingRow) {
    let motion = match row.orbit.is_empty() {
        true => row.outcome.name().to_owned(),
        false => format!("period {}", row.period),
    };
    let mut begin = format!("{:>9}  {motion:<16}", row.attractor);
    let count = row.basin.len();
    for number in 0..count {
        let [orbit, basin] =
            [&row.orbit, &row.basin].map(|it| it.get(number).filter(|it| it.starts > 0));
        if orbit.is_none() && basin.is_none() {
            continue;
        }
        let [orbit, basin] = [orbit, basin].map(|it| it.map_or("-".to_owned(), probability));
        let _ = writeln!(text, "  {begin} {number:>2}  {orbit:<29}{basin}");
        begin = " ".repeat(27);
    }
    if row.unknown + row.basin_unknown > 0 {
        let [orbit, basin] = [(row.unknown, "moment"), (row.basin_unknown, "start")]
            .map(|(count, what)| counted(count, what));
        let _ = writeln!(text, "  {begin}  ?  {orbit:<29}{basin} of no known attractor");
    }
    if row.orbit.is_empty() {
        let _ =
            writeln!(text, "  {:>9}  the orbit does not repeat, and its draws are not told", "");
    }
}

fn probability(share: &Share) -> String {
    let [low, high] = share.interval.unwrap_or([f64::NAN; 2]);
    format!("{:.4} ({low:.4} to {high:.4})", share.value)
}

fn row(row: &TippingRow) -> Value {
    json!({
        ATTRACTOR.name: row.attractor,
        "kind": row.outcome.name(),
        PERIOD.name: (row.period > 0).then_some(row.period),
        "orbit": led(&row.orbit),
        "unknown": row.unknown,
        "basin": led(&row.basin),
        "basin_unknown": row.basin_unknown,
    })
}

/// The attractors to which something leads.
fn led(shares: &[Share]) -> Value {
    let led = shares.iter().enumerate().filter(|(_, it)| it.starts > 0);
    let told = led.map(|(number, it)| {
        json!({ "to": number, "count": it.starts, "probability": it.value, "interval": it.interval })
    });
    Value::Array(told.collect())
}
