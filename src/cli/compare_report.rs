//! A comparison in words and as JSON.

use serde_json::json;

use super::identify_report::shown;
use super::varied::Varied;
use crate::capsule::{self, CapsuleParameters as _, Parameter};
use crate::experiment::comparison::Drive;
use crate::experiment::estimate::significant;
use crate::experiment::explanation::EXPLAINED_CYCLES;
use crate::experiment::{Comparison, Difference, Doubt, Explanation, Frequencies, Progression};
use crate::orbit::Outcome;
use crate::store::catalogue::{CYCLES, OUTCOME, PERIOD};

/// The comparison in lines.
pub fn told_of(it: &Comparison) -> String {
    let mut text = format!("record:       {}, {:.2} cycles of the drive\n", it.sampling, it.cycles);
    text += &match &it.drive {
        Some(drive) => told_of_drive(it, drive),
        None => format!(
            "drive:        not recorded; phase {:.3} rad at the first sample makes the differences least\n",
            it.phase
        ),
    };
    let period = match it.outcome {
        (Outcome::Periodic, period) => format!("periodic, period {period} simulated"),
        (other, _) => {
            format!("{} simulated: histories need not agree, only speeds and counts", other.name())
        }
    };
    let recorded = match it.recorded_period {
        Some(period) => format!("period {period}"),
        None => "no period up to 8".to_owned(),
    };
    text += &format!("motion:       {recorded} recorded; {period}\n");
    text += &told_of_speeds(it);
    text += &match it.recorded_impacts {
        Some(recorded) => format!(
            "impacts:      {recorded:.2} per cycle recorded (r reaches delta), {} simulated\n",
            it.impacts
        ),
        None => format!("impacts:      {} per cycle simulated; {}\n", it.impacts, uncounted(it)),
    };
    if it.differences.iter().any(|it| it.signal.name() == "a1") {
        text += &told_of_spikes(it);
    }
    it.differences.iter().for_each(|difference| text += &told_of_difference(difference));
    text
}

/// The warnings among the lines of a comparison.
fn warnings_in(lines: &str) -> impl Iterator<Item = &str> {
    lines.lines().filter_map(|line| line.trim_start().strip_prefix("warning: "))
}

/// The recorded drive beside that of the study, with what may be wrong.
fn told_of_drive(it: &Comparison, drive: &Drive) -> String {
    let parameters = &it.motion.parameters;
    let (omega_of_study, p_d) = (parameters.frequency(), parameters[Parameter::Pd]);
    let harmonic = &drive.harmonic;
    let [omega, phase, amplitude] = [harmonic.omega, harmonic.phase, harmonic.amplitude]
        .map(|it| shown(it.value, it.standard_error));
    let mut text = format!(
        "drive:        {omega} rad/s as recorded, {omega_of_study} rad/s in the study; phase {phase} rad at the first sample\n"
    );
    if drive.is_force {
        text += &format!(
            "              amplitude {amplitude} N as recorded (standard error {}), p_d = {p_d} N in the study\n",
            shown(harmonic.amplitude.standard_error, harmonic.amplitude.standard_error)
        );
    }
    let span = it.times[it.times.len() - 1];
    if harmonic.beside(omega_of_study, span) != Frequencies::Same {
        text +=
            &warning("the frequencies differ, so that recording and study are not the same case");
    }
    if drive.differs_from(p_d) {
        let change = 100.0 * (harmonic.amplitude.value / p_d - 1.0);
        text += &warning(&format!(
            "the amplitudes differ by {change:+.1} %, so that recording and study are not the same case; set p_d = \"{amplitude} N\" \
             or check the scale of the drive"
        ));
    }
    if drive.may_be_inverted {
        text += &warning("the drive may have the other sign: with it the signals agree far better");
    }
    text
}

/// A warning in a line of its own, below what it is about.
fn warning(fault: &str) -> String {
    format!("              warning: {fault}\n")
}

/// The recorded and the simulated speed, with their standard errors.
fn told_of_speeds(it: &Comparison) -> String {
    let simulated = &it.simulated_speed;
    let repeats = it.outcome.0 == Outcome::Periodic;
    let simulated = match simulated.standard_error {
        _ if repeats => format!("{:.4} mm/s simulated", simulated.value * 1e3),
        Some(error) => format!(
            "{} mm/s simulated (standard error {}), the mean of {} cycles of a motion that does not repeat",
            shown(simulated.value * 1e3, error * 1e3),
            shown(error * 1e3, error * 1e3),
            it.measured_cycles
        ),
        None => format!(
            "{} mm/s simulated, without a standard error",
            significant(simulated.value * 1e3, 4)
        ),
    };
    let recorded = it.recorded_speed.as_ref().map_or("none recorded".to_owned(), told_of_recorded);
    format!("speed:        {recorded}, {simulated}\n")
}

fn told_of_recorded(speed: &Progression) -> String {
    let value = speed.value * 1e3;
    match (speed.standard_error.map(|it| it * 1e3), speed.batches) {
        (Some(error), None) => {
            format!(
                "{} mm/s recorded (standard error {})",
                shown(value, error),
                shown(error, error)
            )
        }
        (Some(error), Some(batches)) => format!(
            "{} mm/s recorded (standard error {}, of {batches} batches of cycles)",
            shown(value, error),
            shown(error, error)
        ),
        (None, _) => {
            format!("{} mm/s recorded (no standard error: too few cycles)", significant(value, 3))
        }
    }
}

/// The pulses of the acceleration.
fn told_of_spikes(it: &Comparison) -> String {
    let told = match it.spikes {
        Some(counts) => {
            let told = counts.map(|count| match count > 0.0 {
                true => format!("{count:.2} per cycle"),
                false => "no pulses stand out".to_owned(),
            });
            format!(
                "{} recorded, {} simulated (pulses of the acceleration; those within the time of a contact on the stop of the study are one)",
                told[0], told[1]
            )
        }
        None if it.is_countable => {
            "no pulses stand out: a contact is too long against the cycle, or has too few samples"
                .to_owned()
        }
        None => return String::new(),
    };
    format!("spikes of a1: {told}\n")
}

/// The error of a signal, and what may be wrong with it.
fn told_of_difference(it: &Difference) -> String {
    let name = it.signal.name();
    let Some(errors) = it.errors else {
        return format!(
            "error of {:<5}none: {name} does not vary; no error relative to it\n",
            format!("{name}:")
        );
    };
    let mut text = format!("error of {:<5}{:.2} %", format!("{name}:"), errors.all * 100.0);
    if crate::experiment::agreement::advances(it.signal) {
        text += &format!(", of its shape {:.2} %", errors.shape * 100.0);
    }
    text += "\n";
    match it.doubt {
        Some(Doubt::Sign) => text += &warning(&format!("{name} may have the other sign")),
        Some(Doubt::Unit(ratio)) => {
            text += &warning(&format!(
                "{name} varies {} times as much as simulated; its unit in the header may be wrong",
                significant(ratio, 3)
            ));
        }
        None => {}
    }
    text
}

/// Why the impacts of a record are not counted.
fn uncounted(it: &Comparison) -> &'static str {
    match it.is_countable {
        true => "r is not recorded",
        false => {
            "not counted in the record: fewer than three cycles without a gap, or than 20 samples a cycle"
        }
    }
}

/// What other values of some parameters explain.
pub fn explained(comparison: &Comparison, it: &Explanation, varied: &[Varied]) -> String {
    let mut explaining = comparison.motion.parameters.clone();
    it.changed.iter().for_each(|(parameter, value, _)| explaining[*parameter] = *value);
    let is_idle = explaining.idle_static_friction().is_some();
    let (mut changed, mut bounds) = (Vec::new(), String::new());
    for ((parameter, value, bound), varied) in it.changed.iter().zip(varied) {
        if is_idle && *parameter == Parameter::MuS {
            let onset = explaining.resistance().onset_in_words();
            changed.push(format!("mu_s below {onset}, where it has no effect"));
            continue;
        }
        let change = 100.0 * (value / comparison.motion.parameters[*parameter] - 1.0);
        let (symbol, shown, unit) =
            (parameter.symbol(), varied.shown(*value, 1e-3 * value), varied.unit());
        changed.push(format!("{symbol} = {shown}{unit} ({change:+.1} %)"));
        bounds += &varied.told_of_bound("  ", *bound);
    }
    format!(
        "with {}: error of all signals {:.1} % over the first {EXPLAINED_CYCLES} cycles, {:.1} % without; {} impacts per cycle, {:.4} \
         mm/s\n{bounds}",
        changed.join(", "),
        100.0 * it.misfit[1],
        100.0 * it.misfit[0],
        it.impacts,
        it.speed * 1e3
    )
}

/// The comparison as JSON.
pub fn as_json(
    it: &Comparison,
    explanations: &[Explanation],
    left_out: &[String],
) -> serde_json::Value {
    let lines = told_of(it);
    let warnings: Vec<&str> =
        warnings_in(&lines).chain(left_out.iter().map(String::as_str)).collect();
    let drive = it.drive.as_ref();
    let force = drive.filter(|it| it.is_force).map(|it| it.harmonic.amplitude);
    json!({
        "warnings": warnings,
        "countable": it.is_countable,
        "samples": it.sampling.count,
        "gaps": it.sampling.gaps,
        CYCLES.name: it.cycles,
        "omega_recorded": drive.map(|it| it.harmonic.omega.value),
        "drive_amplitude_recorded": force.map(|it| it.value),
        "drive_amplitude_recorded_error": force.map(|it| it.standard_error),
        "drive_may_have_other_sign": drive.is_some_and(|it| it.may_be_inverted),
        "phase": it.phase,
        "period_recorded": it.recorded_period,
        OUTCOME.name: it.outcome.0.name(),
        PERIOD.name: it.outcome.1,
        "speed_recorded": it.recorded_speed.map(|it| it.value),
        "speed_recorded_error": it.recorded_speed.and_then(|it| it.standard_error),
        "speed_simulated": it.simulated_speed.value,
        "speed_simulated_error": it.simulated_speed.standard_error,
        "spikes_per_cycle": it.spikes,
        capsule::Output::ImpactsPerCycle.name(): it.impacts,
        "impacts_per_cycle_recorded": it.recorded_impacts,
        "errors": it.differences.iter().map(difference).collect::<Vec<_>>(),
        "explanations": explanations.iter().map(explanation).collect::<Vec<_>>(),
    })
}

fn difference(it: &Difference) -> serde_json::Value {
    json!({
        "signal": it.signal.name(),
        "error": it.errors.map(|it| it.all),
        "shape_error": it.errors.map(|it| it.shape),
        "may_have_other_sign": it.doubt == Some(Doubt::Sign),
        "may_have_other_unit": matches!(it.doubt, Some(Doubt::Unit(_))),
    })
}

fn explanation(it: &Explanation) -> serde_json::Value {
    let changed = it.changed.iter().map(|(parameter, value, bound)| {
        json!({ "name": parameter.symbol(), "value": value, "on_bound": bound.map(|it| it.name()) })
    });
    json!({
        "changed": changed.collect::<Vec<_>>(),
        "error": it.misfit[1],
        "error_without": it.misfit[0],
        capsule::Output::ImpactsPerCycle.name(): it.impacts,
        capsule::Output::ProgressionSpeed.name(): it.speed,
    })
}
