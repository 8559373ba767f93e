//! `capsulemap tradeoff`: what moves fastest for how little, from a file of results.

use std::path::{Path, PathBuf};

use clap::Args;

use super::arguments::named;
use super::failure::Failure;
use super::optima_text::{Answer, Gain, Named, csv, json, table};
use super::progress::Progress;
use super::terminal::print;
use super::trade_off_rows::{Row, Rows};
use crate::campaign::{RefinedMotion, Refinement, study_of};
use crate::capsule::Output;
use crate::store::{self, CaseTable, Unread, candidates, quantity};
use crate::study::document::unknown;
use crate::tradeoff::{
    Candidate, Direction, MOST_FREE, Optima, fastest_first, hypervolume, optima as best_of,
};

const EXAMPLES: &str = "\
Examples:
  capsulemap tradeoff results/overview/overview.h5
  capsulemap tradeoff FILE.h5 --of work_positive --direction forward --json
  capsulemap tradeoff FILE.h5 --where \"peak_contact_force < 30 N and grazing_margin > 0.1 mm\" --top 20
  capsulemap tradeoff FILE.h5 --refine --json
  capsulemap tradeoff FILE.h5 --budget \"20 mW\" --speed \"5 mm/s\" --csv

The front is of all cases of the file, each with the attractor that it has ended on. Motions that are chaotic or
quasi-periodic take part by their means. With --refine, periodic motions are followed from the cases to where speed is
stationary for its price, and from these along the front; each says what holds it.";

/// Find the fastest motions for the least energy.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Tradeoff {
    /// The file of results.
    file: PathBuf,
    /// The output that should be small: an energy per cycle, `power`, `energy_per_metre` or another.
    #[arg(long, value_name = "OUTPUT", default_value = Output::Power.name())]
    of: String,
    /// Motions to compare; `either` compares magnitudes of speeds.
    #[arg(long, value_parser = named(&Direction::NAMES), default_value = "either")]
    direction: Direction,
    /// Conditions on what there is one number of for each case, joined by `and`; signs < <= > >= = !=.
    #[arg(long = "where", value_name = "CONDITIONS")]
    conditions: Option<String>,
    /// Speed up to which a motion counts as at rest; a millionth of the fastest by default.
    #[arg(long, value_name = "QUANTITY")]
    at_rest: Option<String>,
    /// Most of the output that may be spent: the fastest motion within it is told.
    #[arg(long, value_name = "QUANTITY")]
    budget: Option<String>,
    /// Least speed that is wanted: the motion that reaches it for the least is told.
    #[arg(long, value_name = "QUANTITY")]
    speed: Option<String>,
    /// Search for better motions between the cases, over the parameters that vary, within their ranges (at most 6).
    #[arg(long, conflicts_with = "conditions")]
    refine: bool,
    /// Number by which cases are drawn that the search begins with beside the best ones.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, requires = "refine")]
    seed: u64,
    /// Worker threads; one per core by default.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    threads: Option<u64>,
    /// List the fastest motions too, so many at most.
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    top: usize,
    /// Print one JSON object.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// Print a table of comma-separated values.
    #[arg(long)]
    csv: bool,
}

/// What is asked, read.
struct Request {
    of: Output,
    at_rest: Option<f64>,
    budget: Option<f64>,
    speed: Option<f64>,
}

impl Tradeoff {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let request = self.request()?;
        let archive = store::open(&self.file).map_err(Failure::request)?;
        let shown = self.file.display().to_string();
        let cases = CaseTable::of(&archive).map_err(Failure::request)?;
        let cases = cases.ok_or_else(|| {
            Failure::request(format!(
                "{shown}: there are no cases; `capsulemap sweep` computes them"
            ))
        })?;
        let found = candidates(&cases, request.of, self.conditions.as_deref())
            .map_err(|error| failure(error, &self.file))?;
        let of_cases = best_of(&found.all, self.direction, request.at_rest);
        let rows = Rows::of(&cases, &archive, &shown)
            .map_err(|error| failure(Unread::Store(error), &self.file))?;
        // Only slopes and searches take more than what the file tells of its cases.
        let asks_for_orbits = self.refine || self.json;
        let study = asks_for_orbits.then(|| study_of(&archive, &self.file)).transpose()?;
        let refinement = study.as_ref().map(|study| Refinement {
            study,
            archive: &archive,
            periods: rows.periods(cases.cases()),
            of: request.of,
            direction: self.direction,
            seed: self.seed,
        });
        let asked = refinement.as_ref().filter(|_| self.refine);
        let refined = asked.map(|it| self.refined(it, &found.all, &of_cases)).transpose()?;
        let motions = refined.as_ref().map_or(&[][..], |(_, motions)| motions);
        let all = with_refined((cases.cases(), &found.all), motions, request.of);
        let best = best_of(&all, self.direction, Some(of_cases.at_rest));
        let named = [
            ("fastest", Some(best.fastest)),
            ("knee", Some(best.knee)),
            ("lowest_cost_of_transport", Some(best.lowest_cost_of_transport)),
            ("fastest_within_budget", request.budget.map(|most| best.fastest_within(&all, most))),
            (
                "least_for_speed",
                request.speed.map(|least| best.least_for(&all, (self.direction, least))),
            ),
        ];
        let row = |at: usize| -> Result<Row, Failure> {
            let motion = &all[at];
            match (&refinement, motion.case.checked_sub(cases.cases())) {
                (Some(refinement), Some(place)) => {
                    Ok(rows.refined(&motions[place], request.of, &refinement.protocol()))
                }
                (Some(refinement), None) if self.json => {
                    Ok(Row { slopes: refinement.slopes(motion)?, ..rows.row(motion) })
                }
                _ => Ok(rows.row(motion)),
            }
        };
        let gain = refined.as_ref().map(|(searches, motions)| Gain {
            searches: *searches,
            found: motions.len(),
            seed: self.seed,
            hypervolumes: self.hypervolumes([(&of_cases, &found.all), (&best, &all)]),
        });
        let moving = fastest_first(&all, self.direction, best.at_rest);
        let named = named.into_iter().filter_map(|(name, at)| Some((name, at?)));
        let named = named.map(|(name, at)| Ok(Named { name, row: at.map(row).transpose()? }));
        let answer = Answer {
            file: shown.clone(),
            of: request.of,
            direction: self.direction,
            cases: cases.cases(),
            left_out: found.left_out,
            at_rest: (best.at_rest, all.len() - moving.len()),
            refined: gain,
            named: named.collect::<Result<_, Failure>>()?,
            front: best.front.iter().map(|&at| row(at)).collect::<Result<_, _>>()?,
            top: moving.into_iter().take(self.top).map(row).collect::<Result<_, _>>()?,
        };
        print(&match (self.json, self.csv) {
            (true, _) => format!("{:#}\n", json(&answer)),
            (_, true) => csv(&answer),
            _ => table(&answer),
        })
    }

    /// The areas that fronts dominate, up to the dearest price of them all.
    fn hypervolumes(&self, fronts: [(&Optima, &[Candidate]); 2]) -> [f64; 2] {
        let at_rest = fronts[0].0.at_rest;
        let fronts = fronts.map(|(optima, candidates)| optima.points(candidates, self.direction));
        let dearest = fronts.iter().flatten().fold(0.0, |most: f64, it| most.max(it.0));
        fronts.map(|front| hypervolume(&front, (dearest, at_rest)))
    }

    /// Searches between the cases: how many, and what they led to.
    fn refined(
        &self,
        refinement: &Refinement<'_>,
        candidates: &[Candidate],
        optima: &Optima,
    ) -> Result<(usize, Vec<RefinedMotion>), Failure> {
        let free = refinement.free().len();
        if !(1..=MOST_FREE).contains(&free) {
            return Err(Failure::request(format!(
                "--refine: {}: {free} parameters vary; 1 to {MOST_FREE} can be refined over",
                self.file.display()
            )));
        }
        let searches = refinement.searches(candidates, optima);
        let threads = self.threads.map(|threads| threads as usize);
        let progress = Progress::new(searches.len(), "searches between the cases");
        let found = refinement.run(&searches, threads, || progress.step())?;
        progress.finish();
        let count = refinement.periods.len();
        let all = with_refined((count, candidates), &found, refinement.of);
        let front = best_of(&all, refinement.direction, Some(optima.at_rest)).front;
        let on_front = |&at: &usize| {
            let refined = all[at].case.checked_sub(count).map(|place| &found[place]);
            (all[at].price, refined)
        };
        let gaps = refinement.gaps(&front.iter().map(on_front).collect::<Vec<_>>());
        let progress = Progress::new(gaps.len(), "gaps of the front");
        let followed = refinement.followed(&gaps, threads, || progress.step())?;
        progress.finish();
        let begun = searches.len() + gaps.len();
        Ok((begun, refinement.joined(found, followed)))
    }

    fn request(&self) -> Result<Request, Failure> {
        let mut faults = Vec::new();
        let names = || Output::ALL.iter().map(|output| output.name());
        let of = Output::ALL.iter().copied().find(|output| output.name() == self.of);
        if of.is_none() {
            faults.push(format!("--of: {}", unknown("output", &self.of, names())));
        }
        let of = of.unwrap_or(Output::Power);
        let mut read = |option: &str, text: &Option<String>, unit: &str| {
            let value = quantity(text.as_deref()?, unit);
            value.map_err(|fault| faults.push(format!("--{option}: {fault}"))).ok()
        };
        let speed_unit = Output::ProgressionSpeed.unit();
        let request = Request {
            of,
            at_rest: read("at-rest", &self.at_rest, speed_unit),
            budget: read("budget", &self.budget, of.unit()),
            speed: read("speed", &self.speed, speed_unit),
        };
        if faults.is_empty() { Ok(request) } else { Err(Failure::requests(&faults)) }
    }
}

/// The candidates of so many cases, and refined motions, numbered after them.
fn with_refined(
    (cases, candidates): (usize, &[Candidate]),
    motions: &[RefinedMotion],
    of: Output,
) -> Vec<Candidate> {
    let refined = motions.iter().enumerate().map(|(place, motion)| Candidate {
        case: cases + place,
        speed: motion.outputs[Output::ProgressionSpeed],
        price: motion.outputs[of],
        energy_per_metre: motion.outputs[Output::EnergyPerMetre],
    });
    candidates.iter().copied().chain(refined).collect()
}

fn failure(error: Unread, file: &Path) -> Failure {
    match error {
        Unread::Store(error) => Failure::request(error),
        Unread::Faults(faults) => {
            let within = |fault: &String| format!("{}: {fault}", file.display());
            Failure::requests(&faults.iter().map(within).collect::<Vec<_>>())
        }
    }
}
