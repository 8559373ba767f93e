//! The summary of the boundaries of a map: its curves, and between which neighbours no boundary was found.

use std::fmt::Write;

use super::branch_summary::write_curve;
use crate::campaign::count::count;
use crate::run::{MapBoundaries, PairState};
use crate::study::Boundaries;

/// What came of the boundaries of a map that were `asked` for.
pub fn summary(asked: &Boundaries, boundaries: &MapBoundaries) -> String {
    let tries: usize = boundaries.tries.iter().sum();
    let mut text = format!("\nboundaries of the map, from {} tries:\n", count(tries));
    for (continuation, found) in &boundaries.followed {
        found.curves.iter().for_each(|curve| write_curve(&mut text, continuation, curve));
    }
    let all: usize = boundaries.pairs.iter().sum();
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "  of {} pairs of neighbours whose motions are of two kinds, by period and impacts:",
        count(all)
    );
    for (_, state) in PairState::NAMES {
        let [pairs, tries] = [boundaries.pairs, boundaries.tries].map(|it| it[state as usize]);
        if pairs > 0 {
            let _ = writeln!(text, "    {:>6} {}", count(pairs), told(state, tries, asked));
        }
    }
    text
}

/// What is known of pairs, of which so many were tried, in words.
fn told(state: PairState, tries: usize, asked: &Boundaries) -> String {
    match state {
        PairState::OnCurve => "have a boundary between them that is followed".to_owned(),
        PairState::SeveralMotions => format!(
            "lie beside no boundary of their own: the motion of one goes on to the other, which settles to another motion ({tries} tried)"
        ),
        PairState::NotLocated => {
            "have a boundary that was not located, or no special point that can be followed"
                .to_owned()
        }
        PairState::NotTried => {
            format!("were not tried, as `most_tries` allows {}", count(asked.most_tries))
        }
    }
}
