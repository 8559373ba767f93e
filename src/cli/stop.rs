//! Ctrl-C and a scheduler's notice: a word on how to go on, and an end at once.

use std::sync::Mutex;

use super::{Failure, tell};

/// What to say.
type Word = Box<dyn Fn() -> String + Send>;

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
    let mut signals = Signals::new([SIGINT, SIGTERM]).map_err(failed)?;
    std::thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            let word = WORD.lock().unwrap_or_else(|it| it.into_inner());
            // The line of the terminal may hold a bar, or ^C.
            tell(&format!("\ncapsulemap: {}", word.as_ref().map_or(String::new(), |it| it())));
            if emulate_default_handler(signal).is_err() {
                std::process::exit(128 + signal);
            }
        }
    });
    Ok(())
}

#[cfg(not(unix))]
fn listen() -> Result<(), Failure> {
    Ok(())
}
