//! Which of several tasks this is, as options say it or the scheduler that has started it, and how many processors it was granted.

use std::str::FromStr;

use crate::campaign::Task;

/// The value of an environment variable, if it is set.
pub type Variable<'a> = &'a dyn Fn(&str) -> Option<String>;

/// What `--task` asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AskedTask {
    /// What the scheduler says.
    Auto,
    /// The part of this number, of so many.
    Part {
        /// Its number, counted from the first.
        number: usize,
        /// How many there are.
        of: usize,
    },
}

impl FromStr for AskedTask {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "auto" {
            return Ok(AskedTask::Auto);
        }
        let parts = text.split_once('/').map(|(number, of)| (number.parse(), of.parse()));
        match parts {
            Some((Ok(number), Ok(of))) => Ok(AskedTask::Part { number, of }),
            _ => Err("expected I/N, as 3/8, or auto".to_owned()),
        }
    }
}

/// Where a scheduler counts the elements of an array from.
#[derive(Clone, Copy)]
enum First {
    /// A number.
    At(usize),
    /// What a variable says, 1 by default.
    In(&'static str),
}

/// How a scheduler says how many elements an array has.
#[derive(Clone, Copy)]
enum Size {
    /// Their number, in a variable.
    Count(&'static str),
    /// The last of them, in a variable.
    Last(&'static str),
    /// Not at all: what to write in its place, and whether that is said wherever the index is set, or only where `auto` asks.
    Unknown { task: &'static str, always: bool },
}

/// How a scheduler says which element of an array a process is.
struct Scheduler {
    index: &'static str,
    /// What the index is where there is no array.
    none: &'static str,
    first: First,
    step: Option<&'static str>,
    size: Size,
}

/// Those that are known; a later one may have been started within an earlier one.
const SCHEDULERS: [Scheduler; 9] = [
    Scheduler {
        index: "SLURM_ARRAY_TASK_ID",
        none: "",
        first: First::In("SLURM_ARRAY_TASK_MIN"),
        step: Some("SLURM_ARRAY_TASK_STEP"),
        size: Size::Count("SLURM_ARRAY_TASK_COUNT"),
    },
    Scheduler {
        index: "SGE_TASK_ID",
        none: "undefined",
        first: First::In("SGE_TASK_FIRST"),
        step: Some("SGE_TASK_STEPSIZE"),
        size: Size::Last("SGE_TASK_LAST"),
    },
    Scheduler {
        index: "LSB_JOBINDEX",
        none: "0",
        first: First::At(1),
        step: Some("LSB_JOBINDEX_STEP"),
        size: Size::Last("LSB_JOBINDEX_END"),
    },
    Scheduler {
        index: "AWS_BATCH_JOB_ARRAY_INDEX",
        none: "",
        first: First::At(0),
        step: None,
        size: Size::Count("AWS_BATCH_JOB_ARRAY_SIZE"),
    },
    uncounted("PBS_ARRAY_INDEX", "$PBS_ARRAY_INDEX/N", true),
    uncounted("PBS_ARRAYID", "$PBS_ARRAYID/N", true),
    uncounted("JOB_COMPLETION_INDEX", "$JOB_COMPLETION_INDEX/N --first-task 0", true),
    // These two are set for jobs that have nothing to do with each other, too.
    uncounted("HQ_TASK_ID", "$HQ_TASK_ID/N", false),
    uncounted("PARALLEL_SEQ", "$PARALLEL_SEQ/N", false),
];

/// A scheduler that does not say how many elements there are.
const fn uncounted(index: &'static str, task: &'static str, always: bool) -> Scheduler {
    let size = Size::Unknown { task, always };
    Scheduler { index, none: "", first: First::At(1), step: None, size }
}

/// The task that a scheduler says this is, and the variable that says so; none where no scheduler has started an array. `is_asked`
/// says whether `--task auto` asks.
///
/// Fails where what is said tells no task: an index outside its array, or an array whose size is not said.
pub fn task(
    is_asked: bool,
    variable: Variable<'_>,
) -> Result<Option<(Task, &'static str)>, String> {
    for scheduler in &SCHEDULERS {
        let Some(index) = variable(scheduler.index).filter(|it| it.trim() != scheduler.none) else {
            continue;
        };
        if let Size::Unknown { always, .. } = scheduler.size
            && !always
            && !is_asked
        {
            continue;
        }
        return scheduler.task(&index, variable).map(|task| Some((task, scheduler.index)));
    }
    if is_asked {
        let known: Vec<&str> = SCHEDULERS.iter().map(|it| it.index).collect();
        let known = known.join(", ");
        return Err(format!("no scheduler has started an array here: none of {known} is set"));
    }
    Ok(None)
}

impl Scheduler {
    /// The task that has this index.
    fn task(&self, index: &str, variable: Variable<'_>) -> Result<Task, String> {
        let name = self.index;
        let number = count(name, index)?;
        let first = match self.first {
            First::At(first) => first,
            First::In(name) => variable(name).map_or(Ok(1), |text| count(name, &text))?,
        };
        let step = self.step.and_then(|name| Some((name, variable(name)?)));
        let step = step.map_or(Ok(1), |(name, text)| count(name, &text))?.max(1);
        let of = match self.size {
            Size::Count(name) => variable(name).map_or(Ok(0), |text| count(name, &text))?,
            Size::Last(name) => {
                let last = variable(name).map_or(Ok(0), |text| count(name, &text))?;
                last.checked_sub(first).map_or(0, |more| more / step + 1)
            }
            Size::Unknown { task, .. } => {
                return Err(format!(
                    "{name}={number}: this is an element of an array whose size the scheduler does not say; write --task {task} with \
                     their number in the place of N, or --task 1/1 where each computes the whole study"
                ));
            }
        };
        let place = number.checked_sub(first).filter(|more| more % step == 0);
        match place.map(|more| more / step + 1) {
            Some(number) if number <= of => Ok(Task { number, of }),
            _ => Err(format!(
                "{name}={number} does not tell which of {of} tasks this is (a list such as 1,5,7 is not evenly spaced); say it with \
                 --task I/N"
            )),
        }
    }
}

fn count(name: &str, text: &str) -> Result<usize, String> {
    text.trim().parse().map_err(|_| format!("{name}={text}: is no count"))
}

/// What says how many processors a task was granted, those of schedulers first.
const GRANTS: [&str; 5] =
    ["SLURM_CPUS_PER_TASK", "NSLOTS", "NCPUS", "LSB_DJOB_NUMPROC", "OMP_NUM_THREADS"];

/// How many threads a task was granted, and the variable that says so; none if none says it.
pub fn granted(variable: Variable<'_>) -> Option<(usize, &'static str)> {
    GRANTS.into_iter().find_map(|name| {
        let text = variable(name)?;
        // OpenMP has a number for each level of threads within threads.
        let count = text.split(',').next()?.trim().parse().ok()?;
        (count > 0).then_some((count, name))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(variables: &[(&str, &str)], is_asked: bool) -> Result<Option<(usize, usize)>, String> {
        let find = |name: &str| {
            variables.iter().find(|(it, _)| *it == name).map(|(_, text)| (*text).to_owned())
        };
        let found = task(is_asked, &find)?;
        Ok(found.map(|(Task { number, of }, _)| (number, of)))
    }

    #[test]
    fn tasks_are_read_from_each_scheduler() {
        let slurm = |id, min, step, count| {
            let names = ["ID", "MIN", "STEP", "COUNT"].map(|it| format!("SLURM_ARRAY_TASK_{it}"));
            let all: Vec<(&str, &str)> =
                names.iter().map(String::as_str).zip([id, min, step, count]).collect();
            said(&all, false)
        };
        assert_eq!(slurm("3", "1", "1", "8"), Ok(Some((3, 8))));
        assert_eq!(slurm("0", "0", "1", "8"), Ok(Some((1, 8))));
        assert_eq!(slurm("9", "1", "4", "3"), Ok(Some((3, 3))));
        assert!(slurm("7", "1", "1", "3").is_err() && slurm("x", "1", "1", "3").is_err());
        let grid = |id| {
            let range =
                [("SGE_TASK_FIRST", "2"), ("SGE_TASK_LAST", "11"), ("SGE_TASK_STEPSIZE", "3")];
            said(&[&[("SGE_TASK_ID", id)], range.as_slice()].concat(), false)
        };
        assert_eq!([grid("2"), grid("11")], [Ok(Some((1, 4))), Ok(Some((4, 4)))]);
        assert_eq!(grid("undefined"), Ok(None));
        assert!(grid("3").is_err_and(|it| it.contains("SGE_TASK_ID=3")));
        let lsf = |id| {
            said(
                &[("LSB_JOBINDEX", id), ("LSB_JOBINDEX_STEP", "1"), ("LSB_JOBINDEX_END", "5")],
                true,
            )
        };
        assert_eq!(lsf("5"), Ok(Some((5, 5))));
        assert!(lsf("0").is_err(), "no array, which was asked for");
        let batch = [("AWS_BATCH_JOB_ARRAY_INDEX", "0"), ("AWS_BATCH_JOB_ARRAY_SIZE", "4")];
        assert_eq!(said(&batch, false), Ok(Some((1, 4))));
    }

    #[test]
    fn an_array_of_unknown_size_is_refused_with_what_to_write() {
        for (name, line) in [
            ("PBS_ARRAY_INDEX", "--task $PBS_ARRAY_INDEX/N"),
            ("PBS_ARRAYID", "--task $PBS_ARRAYID/N"),
            ("JOB_COMPLETION_INDEX", "--task $JOB_COMPLETION_INDEX/N --first-task 0"),
        ] {
            for is_asked in [false, true] {
                let refused = said(&[(name, "3")], is_asked).expect_err("no size");
                assert!(refused.contains(line) && refused.contains(&format!("{name}=3")));
            }
        }
        for name in ["HQ_TASK_ID", "PARALLEL_SEQ"] {
            assert_eq!(said(&[(name, "3")], false), Ok(None));
            assert!(said(&[(name, "3")], true).is_err_and(|it| it.contains(name)));
        }
        assert_eq!(said(&[], false), Ok(None));
        assert!(said(&[], true).is_err_and(|it| it.contains("SLURM_ARRAY_TASK_ID")));
    }

    #[test]
    fn the_first_grant_counts() {
        let of = |all: &[(&str, &str)]| {
            granted(&|name| all.iter().find(|it| it.0 == name).map(|it| it.1.to_owned()))
        };
        assert_eq!(of(&[("OMP_NUM_THREADS", "4,2"), ("NSLOTS", "6")]), Some((6, "NSLOTS")));
        assert_eq!(of(&[("OMP_NUM_THREADS", "4,2")]), Some((4, "OMP_NUM_THREADS")));
        assert_eq!(of(&[("NCPUS", "0"), ("NSLOTS", "many")]), None);
    }
}
