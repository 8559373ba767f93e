//! One of several tasks that share a study, as clusters start them.

use std::fmt;
use std::str::FromStr;

/// Task `number` of `of`, the first of which is 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Task {
    /// Its number.
    pub number: usize,
    /// Tasks that share the study.
    pub of: usize,
}

impl Task {
    /// The only task.
    pub const WHOLE: Task = Task { number: 1, of: 1 };

    /// The task that Slurm has started, if it is one of an array.
    pub fn of_slurm(variable: impl Fn(&str) -> Option<String>) -> Option<Result<Task, String>> {
        let id = variable("SLURM_ARRAY_TASK_ID")?;
        let read = |name: &str, usual: usize| match variable(name) {
            None => Ok(usual),
            Some(text) => text.trim().parse().map_err(|_| format!("{name}={text}: is no count")),
        };
        let task = || {
            let id: usize =
                id.trim().parse().map_err(|_| format!("SLURM_ARRAY_TASK_ID={id}: is no count"))?;
            let first = read("SLURM_ARRAY_TASK_MIN", 1)?;
            let step = read("SLURM_ARRAY_TASK_STEP", 1)?.max(1);
            let of = read("SLURM_ARRAY_TASK_COUNT", 0)?;
            let place = id.checked_sub(first).filter(|more| more % step == 0);
            match place.map(|more| more / step + 1) {
                Some(number) if number <= of => Ok(Task { number, of }),
                _ => Err(format!(
                    "SLURM_ARRAY_TASK_ID={id} does not tell which of {of} tasks this is (a list such as \
                     --array=1,5,7 is not evenly spaced); say it with --task I/N"
                )),
            }
        };
        Some(task())
    }

    /// Its part of the blocks that are given in the order of all.
    pub fn part(self, blocks: Vec<usize>) -> Vec<usize> {
        blocks.into_iter().skip(self.number - 1).step_by(self.of).collect()
    }
}

impl FromStr for Task {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/').map(|(number, of)| (number.parse(), of.parse()));
        match parts {
            Some((Ok(number), Ok(of))) if (1..=of).contains(&number) => Ok(Task { number, of }),
            _ => Err("expected I/N with I from 1 to N, as 3/8".to_owned()),
        }
    }
}

impl fmt::Display for Task {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "task {} of {}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tasks_are_read_from_the_option_and_from_slurm() {
        assert_eq!("3/8".parse(), Ok(Task { number: 3, of: 8 }));
        for wrong in ["0/8", "9/8", "3", "a/8", "3/0", "-1/2", "1/2/3"] {
            assert!(wrong.parse::<Task>().is_err(), "{wrong}");
        }
        let array = |id: &str, min: &str, step: &str, count: &str| {
            let names = ["ID", "MIN", "STEP", "COUNT"].map(|it| format!("SLURM_ARRAY_TASK_{it}"));
            let values = [id, min, step, count].map(str::to_owned);
            let all: Vec<(String, String)> = names.into_iter().zip(values).collect();
            let find = |name: &str| all.iter().find(|(it, _)| it == name).map(|it| it.1.clone());
            Task::of_slurm(find)
        };
        assert_eq!(array("3", "1", "1", "8"), Some(Ok(Task { number: 3, of: 8 })));
        assert_eq!(array("0", "0", "1", "8"), Some(Ok(Task { number: 1, of: 8 })));
        assert_eq!(array("9", "1", "4", "3"), Some(Ok(Task { number: 3, of: 3 })));
        assert!(array("7", "1", "1", "3").is_some_and(|it| it.is_err()));
        assert!(array("x", "1", "1", "3").is_some_and(|it| it.is_err()));
        assert_eq!(Task::of_slurm(|_| None), None);
    }

    #[test]
    fn every_block_is_in_one_part() {
        let mut all: Vec<usize> =
            (1..=3).flat_map(|number| Task { number, of: 3 }.part((0..10).collect())).collect();
        all.sort_unstable();
        assert_eq!(all, (0..10).collect::<Vec<_>>());
        assert_eq!(Task::WHOLE.part(vec![2, 0, 1]), [2, 0, 1]);
    }
}
