//! The summary of ramps: what their motions began with, and where these jump.

use std::fmt::Write;

use super::branch_summary::quantity;
use crate::orbit::Outcome;
use crate::run::{Jump, Ramped};
use crate::study::{Ramp, Study};

/// What came of each ramp of `study`.
pub fn summary(study: &Study, ramped: &[Ramped]) -> String {
    let mut text = String::new();
    for (ramp, ramped) in study.ramps.iter().zip(ramped) {
        write_ramp(&mut text, ramp, ramped);
    }
    text
}

fn write_ramp(text: &mut String, ramp: &Ramp, ramped: &Ramped) {
    let [from, to] = ramp.ends.map(|end| quantity(ramp.along, end));
    let cycles = ramped.points.len().saturating_sub(1);
    let rate = quantity(ramp.along, ramp.rate);
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "\n{}: {} from {from} to {to}, {rate} per second, {cycles} cycles, {}",
        ramp.name,
        ramp.along.symbol(),
        beginning(ramped)
    );
    for jump in &ramped.jumps {
        write_jump(text, ramp, ramped, jump);
    }
    if let Some(failure) = &ramped.failure {
        let _ = writeln!(text, "  not followed further: {failure}");
    } else if ramped.jumps.is_empty() {
        let _ = writeln!(text, "  no jump");
    }
}

/// What the ramp began with.
fn beginning(ramped: &Ramped) -> String {
    match ramped.settled {
        None => "from the start".to_owned(),
        Some((Outcome::Periodic, period)) => format!("from a motion of period {period}"),
        Some((outcome, _)) => format!("from a motion that is {}", outcome.name()),
    }
}

fn write_jump(text: &mut String, ramp: &Ramp, ramped: &Ramped, jump: &Jump) {
    let Some(point) = ramped.points.get(jump.point) else { return };
    let share = 100.0 * jump.size;
    let _ = writeln!(
        text,
        "  jump at {}, {:.6} s, cycle {}: the mean of the section moves by {share:.0} % of its extent",
        quantity(ramp.along, point.value),
        point.time,
        jump.point,
    );
}
