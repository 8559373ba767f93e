//! Ctrl-C and a scheduler's notice: a word on how to go on, and an end at once.

use std::thread;

use super::{Failure, tell};

/// From now on, when the program is told to stop, says `word` and ends as a program does that was stopped
/// by the signal, so that shells and schedulers see what happened.
///
/// Nothing is forced to an end: finished blocks are whole on disk, and unfinished ones are begun again.
pub fn say_when_stopped(word: impl Fn() -> String + Send + 'static) -> Result<(), Failure> {
    #[cfg(unix)]
    {
        use signal_hook::consts::{SIGINT, SIGTERM};
        use signal_hook::iterator::Signals;
        use signal_hook::low_level::emulate_default_handler;

        let failed = |error| Failure::machine(format!("signals cannot be heard: {error}"));
        let mut signals = Signals::new([SIGINT, SIGTERM]).map_err(failed)?;
        thread::spawn(move || {
            if let Some(signal) = signals.forever().next() {
                // The line of the terminal may hold a bar, or ^C.
                tell(&format!("\n{}", word()));
                if emulate_default_handler(signal).is_err() {
                    std::process::exit(128 + signal);
                }
            }
        });
    }
    Ok(())
}
