//! The task that Slurm has started, read from the environment of a job array.

use crate::campaign::Task;

/// The task that Slurm has started, if it is one of an array.
pub fn task(variable: impl Fn(&str) -> Option<String>) -> Option<Result<Task, String>> {
    let id = variable("SLURM_ARRAY_TASK_ID")?;
    Some(task_of(&id, variable))
}

/// The task of an array that has this id.
fn task_of(id: &str, variable: impl Fn(&str) -> Option<String>) -> Result<Task, String> {
    let number: usize =
        id.trim().parse().map_err(|_| format!("SLURM_ARRAY_TASK_ID={id}: is no count"))?;
    let first = count_in(&variable, "SLURM_ARRAY_TASK_MIN", 1)?;
    let step = count_in(&variable, "SLURM_ARRAY_TASK_STEP", 1)?.max(1);
    let of = count_in(&variable, "SLURM_ARRAY_TASK_COUNT", 0)?;
    let place = number.checked_sub(first).filter(|more| more % step == 0);
    match place.map(|more| more / step + 1) {
        Some(number) if number <= of => Ok(Task { number, of }),
        _ => Err(format!(
            "SLURM_ARRAY_TASK_ID={number} does not tell which of {of} tasks this is (a list such as \
             --array=1,5,7 is not evenly spaced); say it with --task I/N"
        )),
    }
}

/// The count in a variable; the usual one where it is not set.
fn count_in(
    variable: impl Fn(&str) -> Option<String>,
    name: &str,
    usual: usize,
) -> Result<usize, String> {
    match variable(name) {
        None => Ok(usual),
        Some(text) => text.trim().parse().map_err(|_| format!("{name}={text}: is no count")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tasks_are_read_from_slurm() {
        let array = |id: &str, min: &str, step: &str, count: &str| {
            let names = ["ID", "MIN", "STEP", "COUNT"].map(|it| format!("SLURM_ARRAY_TASK_{it}"));
            let values = [id, min, step, count].map(str::to_owned);
            let all: Vec<(String, String)> = names.into_iter().zip(values).collect();
            let find = |name: &str| all.iter().find(|(it, _)| it == name).map(|it| it.1.clone());
            task(find)
        };
        assert_eq!(array("3", "1", "1", "8"), Some(Ok(Task { number: 3, of: 8 })));
        assert_eq!(array("0", "0", "1", "8"), Some(Ok(Task { number: 1, of: 8 })));
        assert_eq!(array("9", "1", "4", "3"), Some(Ok(Task { number: 3, of: 3 })));
        assert!(array("7", "1", "1", "3").is_some_and(|it| it.is_err()));
        assert!(array("x", "1", "1", "3").is_some_and(|it| it.is_err()));
        assert_eq!(task(|_| None), None);
    }
}
