//! How far a parameter of a periodic motion may fall and rise before it ends or loses its stability.

use crate::branch::{SegmentEnd, SpecialKind, SpecialValue};
use crate::description::{Parameter, Section};
use crate::model::{Along, Model};

/// Segments in which it is followed each way, so that special points of one segment that undo each other are rare.
const SEGMENTS: u32 = 25;

/// Something that happens to a motion at a value of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// The value (SI).
    pub value: f64,
    /// How far the true value may be (SI).
    pub uncertainty: f64,
    /// What happens.
    pub kind: SpecialKind,
}

/// How far a motion stays a stable one while a parameter falls or rises.
#[derive(Debug, Clone, PartialEq)]
pub struct Margin {
    /// The last value to which it is known to be stable (SI).
    pub until: f64,
    /// What ends it there.
    pub end: MarginEnd,
    /// Where its events change on the way, in order.
    pub passed: Vec<Change>,
}

/// What ends a margin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MarginEnd {
    /// Half or one and a half times the value is reached.
    Range,
    /// The motion ends or loses its stability.
    Bifurcation(Change),
    /// The motion could not be followed further, for reasons that are not known.
    NotFollowed,
}

/// How far a parameter of a motion may change.
#[derive(Debug, Clone, PartialEq)]
pub struct Margins {
    /// The parameter.
    pub parameter: Parameter,
    /// Its value, by which a change is measured (SI).
    pub at: f64,
    /// While it falls.
    pub down: Margin,
    /// While it rises.
    pub up: Margin,
}

impl Change {
    fn at(special: &SpecialValue<Section>) -> Self {
        Change { value: special.value, uncertainty: special.uncertainty, kind: special.kind }
    }

    /// The name of what happens, as in files.
    pub fn name(&self) -> &'static str {
        SpecialKind::NAMES[self.kind as usize].0
    }
}

impl Margins {
    /// What ends the motion, down and up, with the changes in percent.
    pub fn ends(&self) -> [String; 2] {
        [&self.down, &self.up].map(|margin| {
            let until = self.percent(margin.until);
            match margin.end {
                MarginEnd::Range => format!("none to {until}"),
                MarginEnd::NotFollowed => format!("not known beyond {until}"),
                MarginEnd::Bifurcation(change) => format!("{} at {until}", change.name()),
            }
        })
    }

    /// What ends the motion, down and up, and the changes of events that it survives on the way.
    pub fn in_words(&self) -> [String; 2] {
        let [down, up] = self.ends();
        [(&self.down, down), (&self.up, up)].map(|(margin, end)| {
            let Some(first) = margin.passed.first() else { return end };
            let more = match margin.passed.len() - 1 {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            format!("{end} ({} at {}{more} passed)", first.name(), self.percent(first.value))
        })
    }

    /// A value as a change in percent.
    fn percent(&self, value: f64) -> String {
        format!("{:+.3}\u{a0}%", 100.0 * (value / self.at - 1.0))
    }
}

/// How far the orbit through some section points at a value of the parameter stays stable, by a change of at most `by`.
///
/// # Method
///
/// The branch is continued, see [`Model::segment`], in 25 segments.
///
/// # Breaks
///
/// Two special points of one kind that undo each other within a segment may both be passed.
pub fn margin(model: &dyn Model, along: &Along, value: f64, points: &[Section], by: f64) -> Margin {
    let (mut until, mut points) = (value, points.to_vec());
    let mut passed = Vec::new();
    for number in 1..=SEGMENTS {
        let to = value + by * f64::from(number) / f64::from(SEGMENTS);
        let found = model.segment(along, (until, &points), to);
        let Some(found) = found else {
            return Margin { until, end: MarginEnd::NotFollowed, passed };
        };
        let special = before_turning(&found.special, by.signum());
        let has_turned = special.len() < found.special.len();
        let end =
            special.iter().position(|it| !it.is_stable_beyond || it.kind == SpecialKind::Fold);
        // Where a branch turns back at a kink, that is its last change of events.
        let turns = has_turned || found.end == SegmentEnd::Ended;
        let end = end.or_else(|| special.len().checked_sub(1).filter(|_| turns));
        passed.extend(special.iter().take(end.unwrap_or(special.len())).map(Change::at));
        match (end, found.end) {
            (Some(end), _) => {
                let end = Change::at(&special[end]);
                return Margin { until: end.value, end: MarginEnd::Bifurcation(end), passed };
            }
            (None, SegmentEnd::Reached(orbit)) if orbit.is_stable() => {
                (until, points) = (to, orbit.points);
            }
            (None, _) => {
                // It is stable just beyond the last change that it has survived.
                let until = special.last().map_or(until, |last| last.value);
                return Margin { until, end: MarginEnd::NotFollowed, passed };
            }
        }
    }
    Margin { until, end: MarginEnd::Range, passed }
}

/// The special points of a segment before it turns back, if it does, where the parameter goes so.
fn before_turning(special: &[SpecialValue<Section>], ahead: f64) -> &[SpecialValue<Section>] {
    let turn = special.windows(2).position(|it| ahead * (it[1].value - it[0].value) < 0.0);
    &special[..turn.map_or(special.len(), |before| before + 1)]
}
