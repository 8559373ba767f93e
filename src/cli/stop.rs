//! Ctrl-C and a scheduler's notice: a word on how to go on, and an end at once.

use std::sync::{Mutex, mpsc};
use std::thread;
use std::time::Duration;

use super::failure::Failure;
use super::terminal::tell;

/// What to say.
type Word = Box<dyn Fn() -> String + Send>;

/// The word is waited for no longer.
const PATIENCE: Duration = Duration::from_secs(2);

/// What is said now; nothing as long as the system's own end of a program will do.
static WORD: Mutex<Option<Word>> = Mutex::new(None);

/// From now on, when the program is told to stop, says `word` and ends as a program does that was stopped
/// by the signal, so that shells and schedulers see what happened.
///
/// Nothing is forced to an end: finished blocks are whole on disk, and unfinished ones are begun again.
pub fn say_when_stopped(word: impl Fn() -> String + Send + 'static) -> Result<(), Failure> {
    let before = WORD.lock().unwrap_or_else(|it| it.into_inner()).replace(Box::new(word));
    if before.is_none() { listen() } else { Ok(()) }
}

#[cfg(unix)]
fn listen() -> Result<(), Failure> {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    let failed = |error| Failure::machine(format!("signals cannot be heard: {error}"));
    let heard = [SIGINT, SIGTERM].into_iter().filter(|signal| !is_ignored(*signal));
    let mut signals = Signals::new(heard).map_err(failed)?;
    thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            let (said, hears) = mpsc::channel();
            thread::spawn(move || {
                let word = WORD.lock().unwrap_or_else(|it| it.into_inner());
                // The line of the terminal may hold a bar, or ^C.
                tell(&format!("\ncapsulemap: {}", word.as_ref().map_or(String::new(), |it| it())));
                // Nobody is there to hear it once the time is over.
                let _ = said.send(());
            });
            // Whoever should read the word may not.
            let _ = hears.recv_timeout(PATIENCE);
            if emulate_default_handler(signal).is_err() {
                std::process::exit(128 + signal);
            }
        }
    });
    Ok(())
}

/// Whether whoever started the program wants it to go on when a signal comes, as for jobs in the background.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

#[cfg(not(unix))]
fn listen() -> Result<(), Failure> {
    Ok(())
}
