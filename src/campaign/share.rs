//! One of several tasks that share the blocks of a study, each on a machine of its own.

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

    /// Its share of the blocks, which are given in the order of all.
    pub fn share(self, blocks: Vec<usize>) -> Vec<usize> {
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
    fn a_task_is_read_as_i_of_n() {
        assert_eq!("3/8".parse(), Ok(Task { number: 3, of: 8 }));
        for wrong in ["0/8", "9/8", "3", "a/8", "3/0", "-1/2", "1/2/3"] {
            assert!(wrong.parse::<Task>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn every_block_is_in_one_share() {
        let mut all: Vec<usize> =
            (1..=3).flat_map(|number| Task { number, of: 3 }.share((0..10).collect())).collect();
        all.sort_unstable();
        assert_eq!(all, (0..10).collect::<Vec<_>>());
        assert_eq!(Task::WHOLE.share(vec![2, 0, 1]), [2, 0, 1]);
    }
}
