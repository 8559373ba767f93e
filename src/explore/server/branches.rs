//! The branch of periodic orbits, stable or not, through a motion of a line over the map.

use serde_json::{Value, json};

use super::answer::Refusal;
use super::asked::Asked;
use super::computations::BUDGET;
use super::explored::Explored;
use super::line::{Line, spacing};
use crate::branch::{End, NotFollowed, SpecialKind};
use crate::description::Section;
use crate::figure::special_symbol;
use crate::flow::stop;
use crate::model::Setting;
use crate::motion::branch::{Branch, Found, Point, Request, Special};
use crate::of::model_of;
use crate::store::catalogue::{PERIOD, section};
use crate::study::axis::range;
use crate::study::{Coordinate, Spacing, Varying};

/// Longest step, as a share of the line.
const LONGEST_STEP: f64 = 0.01;
/// Points at most.
const MOST_POINTS: usize = 2000;
/// Longest period of an orbit from which a branch is followed [cycles].
const LONGEST_PERIOD: usize = 1000;

/// What takes too long here.
const INSTEAD: &str =
    "`capsulemap continue` has no such limit: give the study of the line [[branches]]";

/// The branch through an orbit at one value of a line.
pub struct LineBranch {
    axis: Varying,
    /// How its values lie between its ends.
    spacing: Spacing,
    request: Request,
}

impl LineBranch {
    /// The branch along a line, of which a request tells what [`Line::of`] reads, through the orbit of so many cycles as `period` says at
    /// the section point with the coordinates after `orbit_`, at the value of the line with the number `place`.
    ///
    /// Fails if the line varies several coordinates, or no parameter, or the orbit is not given whole.
    pub fn of(explored: &Explored, asked: &Asked) -> Result<LineBranch, Refusal> {
        let model = explored.model();
        let given = asked.coordinates_after("orbit_", model)?;
        let names = given.iter().map(|(it, _)| format!("orbit_{}", it.name()));
        let own: Vec<String> = names.chain([PERIOD.name, "place"].map(str::to_owned)).collect();
        let own: Vec<&str> = own.iter().map(String::as_str).collect();
        let line = Line::with(explored, asked, &own)?;
        let Some(axis) = line.single() else {
            return Err(Refusal::unfit(
                "a branch is followed in one parameter, and this line varies several coordinates together",
            ));
        };
        let Coordinate::Parameter(along) = axis.coordinate else {
            let name = axis.coordinate.name();
            return Err(Refusal::unfit(format!(
                "{name}: a branch is followed in a parameter, and this is none"
            )));
        };
        let missing = |it: Coordinate| {
            Refusal::unfit(format!("orbit_{}: a coordinate of the orbit is expected", it.name()))
        };
        let point: Result<Section, Refusal> = Coordinate::of_section(model)
            .map(|it| {
                given
                    .iter()
                    .find(|(other, _)| *other == it)
                    .map(|(_, value)| *value)
                    .ok_or(missing(it))
            })
            .collect();
        let last = axis.values.len() - 1;
        let place = asked.count("place", [0, last], 0)?;
        let case = line.case(place);
        let request = Request {
            section: point?,
            period: asked.count(PERIOD.name, [1, LONGEST_PERIOD], 1)? as u64,
            along,
            range: range(&axis.values),
            doublings: 0,
            second: None,
            curve_range: None,
            longest_step: LONGEST_STEP,
            most_points: MOST_POINTS,
            tolerance: explored.protocol().tolerance,
            setting: Setting {
                parameters: case.parameters.with_part(along),
                phase: case.section_phase,
            },
        };
        let spacing = spacing(asked, axis.coordinate, range(&axis.values))?;
        Ok(LineBranch { axis: axis.clone(), spacing, request })
    }

    /// Sends what was followed, in one object, or why nothing was.
    pub fn compute(self, send: &dyn Fn(String) -> bool) {
        let found = model_of(&self.request.setting.parameters).follow(&self.request);
        if stop::is_asked() {
            send(Refusal::late(BUDGET, INSTEAD).line());
            return;
        }
        match found {
            Ok(found) => send(self.told(&found).to_string()),
            Err(why) => send(json!({ "why": not_followed(&why) }).to_string()),
        };
    }

    fn told(&self, found: &Found) -> Value {
        json!({ "branches": found.branches.iter().map(|it| self.branch(it)).collect::<Vec<_>>() })
    }

    fn branch(&self, branch: &Branch) -> Value {
        json!({
            (PERIOD.name): branch.period,
            "points": branch.points.iter().map(|it| self.point(it)).collect::<Vec<_>>(),
            "special": branch.special.iter().map(|it| self.special(it)).collect::<Vec<_>>(),
            "ends": branch.ends.map(|end| name_of(&End::NAMES, end)),
        })
    }

    /// An orbit: its share of the line, the first coordinate of its section points, whether it is stable, and the main output.
    fn point(&self, point: &Point) -> Value {
        let model = point.measured.model();
        let mut told = json!({
            "share": self.share(point.parameter),
            "stable": point.multipliers.iter().all(|it| it.abs() < 1.0),
        });
        told[section(model)[0].name] =
            json!(point.section.iter().map(|it| it[0]).collect::<Vec<_>>());
        told[model.main_output().name()] = json!(point.measured.main());
        told
    }

    fn special(&self, special: &Special) -> Value {
        let mut told = self.point(&special.point);
        let (words, colour) = special_symbol(name_of(&SpecialKind::NAMES, special.kind));
        (told["words"], told["colour"]) = (json!(words), json!(colour));
        told
    }

    /// The share of the line at which the parameter has a value.
    fn share(&self, value: f64) -> f64 {
        let (from, to) = (self.axis.values[0], self.axis.values[self.axis.values.len() - 1]);
        match self.spacing {
            Spacing::Logarithmic => (value / from).ln() / (to / from).ln(),
            Spacing::Linear => (value - from) / (to - from),
        }
    }
}

/// Why nothing was followed, in words.
fn not_followed(why: &NotFollowed) -> &'static str {
    match why {
        NotFollowed::NoOrbit => "no periodic orbit was found there",
        NotFollowed::Failed(_) => "the motion could not be followed there",
        NotFollowed::Neutral => "the orbit belongs to a family of orbits, or lies in a fold",
        NotFollowed::OutOfRange | NotFollowed::NoParameter => {
            "there is no branch in this parameter"
        }
    }
}

/// The name that one of a list has.
fn name_of<T: PartialEq>(names: &[(&'static str, T)], wanted: T) -> &'static str {
    names.iter().find(|(_, it)| *it == wanted).map_or("", |(name, _)| name)
}
