//! Ctrl-C and the signal of a scheduler: prints how to resume, and ends the program.

use std::sync::Mutex;
use std::thread;

use super::failure::Failure;
use super::terminal::notify_at_last;

/// Gives the message.
type Message = Box<dyn Fn() -> String + Send>;

/// The message now; none as long as the system's own handling of the signal suffices.
static MESSAGE: Mutex<Option<Message>> = Mutex::new(None);

/// What is done before the message is printed.
static BEFORE: Mutex<Option<Action>> = Mutex::new(None);

/// Does something, from the thread that has heard the signal.
type Action = Box<dyn Fn() + Send>;

/// When a signal asks the program to stop and a message is known for that, `action` is done first; it must take no long time.
pub fn before_end(action: impl Fn() + Send + 'static) {
    *BEFORE.lock().unwrap_or_else(|it| it.into_inner()) = Some(Box::new(action));
}

/// From now on, when a signal asks the program to stop, prints `message` and ends as a program does that was
/// stopped by the signal, so that shells and schedulers see the cause.
///
/// Finished blocks are complete on disk; unfinished ones are computed again.
pub fn say_when_stopped(message: impl Fn() -> String + Send + 'static) -> Result<(), Failure> {
    let before = MESSAGE.lock().unwrap_or_else(|it| it.into_inner()).replace(Box::new(message));
    if before.is_none() { listen() } else { Ok(()) }
}

#[cfg(unix)]
fn listen() -> Result<(), Failure> {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    let heard = [SIGINT, SIGTERM].into_iter().filter(|signal| !is_ignored(*signal));
    let mut signals = Signals::new(heard)
        .map_err(|error| Failure::machine(format!("signals cannot be handled: {error}")))?;
    thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            BEFORE.lock().unwrap_or_else(|it| it.into_inner()).iter().for_each(|action| action());
            let message = MESSAGE.lock().unwrap_or_else(|it| it.into_inner());
            // The line of the terminal may hold a bar, or ^C.
            notify_at_last(|| {
                format!("\ncapsulemap: {}", message.as_ref().map_or(String::new(), |it| it()))
            });
            if emulate_default_handler(signal).is_err() {
                std::process::exit(128 + signal);
            }
        }
    });
    Ok(())
}

/// Whether the signal is set to be ignored, as for jobs in the background.
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
