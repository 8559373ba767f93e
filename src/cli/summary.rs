//! What came of the cases of a study, in a few lines.

use std::fmt::Write;
use std::path::Path;

use super::readable::{count, counted};
use crate::orbit::Outcome;
use crate::quantity::printable::printable;
use crate::store::{Blocks, FailedCase, StoreError, Summary, by_outcome};
use crate::study::Study;

/// So many failed cases are named; the file names them all.
const FAILURES_SHOWN: usize = 5;

/// How many cases in the blocks of a study, which is in the file `path`, came out how, and how to look at those
/// that failed; they are in the file `output` now.
pub fn summary(
    path: &Path,
    study: &Study,
    output: &Path,
    blocks: &Blocks<'_>,
) -> Result<String, StoreError> {
    let summaries = blocks.summaries();
    let shown = printable(output);
    let cases = summaries.iter().map(|block| block.cases).sum();
    let summaries = if study.refine.is_some() { vec![of_computed(blocks)?] } else { summaries };
    let cycles = summaries.iter().map(|block| block.cycles).sum::<u64>() as usize;
    let (cases_shown, cycles) = (counted(cases, "case"), counted(cycles, "cycle"));
    let mut text = format!("{shown}: {cases_shown}, {cycles}\n");
    let missing = study.cases() - cases;
    if study.refine.is_some() {
        let computed = summaries[0].computed;
        let share = 100.0 * computed as f64 / cases as f64;
        let _ =
            writeln!(text, "  {} computed ({share:.2} %), the others inferred", count(computed));
    }
    text.push_str(&outcomes(&summaries));
    if by_outcome(&summaries).iter().any(|it| it.0 == Outcome::Undecided) {
        let (settle, tell) = (study.protocol.max_cycles, study.protocol.exponent_cycles);
        let _ = writeln!(
            text,
            "    not settled within max_cycles = {settle}, nor told from chaos by exponent_cycles = {tell} more; \
             capsulemap help study max_cycles"
        );
    }
    if missing > 0 {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {:<14} {}", "missing", count(missing));
    }
    for failed in blocks.failures(FAILURES_SHOWN)? {
        write_failed(&mut text, &failed, path, study);
    }
    let failed = by_outcome(&summaries).into_iter().find(|it| it.0 == Outcome::Failed);
    if let Some((_, failed)) = failed.filter(|(_, failed)| *failed > FAILURES_SHOWN) {
        let more = counted(failed - FAILURES_SHOWN, "case");
        let _ = writeln!(text, "  and {more} more, where the file has the outcome `failed`");
    }
    Ok(text)
}

/// A case that failed, and how to look at it, by the file of the study.
fn write_failed(text: &mut String, failed: &FailedCase, path: &Path, study: &Study) {
    let FailedCase { index, start, reason, time } = failed;
    let path = printable(path);
    let _ = writeln!(text, "  case {index} failed: {reason}, at t = {time:e} s");
    let _ = write!(text, "    replay: capsulemap simulate --study {path} --case {index}");
    if *start != study.case(*index).start.without_drift() {
        let coordinates = study.base.model().start_coordinates();
        let given = coordinates.map(|it| format!("{}={}", it.name(), start[it]));
        let _ = write!(text, " --start {}", given.collect::<Vec<_>>().join(","));
    }
    text.push('\n');
}

/// The cases of a refined study that have been computed, as one block.
fn of_computed(blocks: &Blocks<'_>) -> Result<Summary, StoreError> {
    let verdicts = blocks.verdicts()?;
    let mut all = Summary { computed: verdicts.len(), ..Summary::default() };
    for (_, outcome, cycles) in verdicts {
        let name = Outcome::ALL.iter().find(|it| **it as i64 == outcome).map(|it| it.name());
        *all.outcomes.entry(name.unwrap_or_default().to_owned()).or_default() += 1;
        all.cycles += cycles;
    }
    Ok(all)
}

/// Cases by outcome, a line each.
pub fn outcomes(blocks: &[Summary]) -> String {
    let counts = by_outcome(blocks).into_iter();
    counts.map(|(it, cases)| format!("  {:<14} {}\n", it.name(), count(cases))).collect()
}
