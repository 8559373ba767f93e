//! Writes to the terminal: results to standard output, messages to standard error.
//!
//! Messages go through a thread of their own, as nobody may read them: a run goes on where standard error is a pipe that
//! is full or a terminal that is halted. What comes from files may hold control characters, which are shown as text.

use std::borrow::Cow;
use std::io::Write;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, channel, sync_channel};
use std::sync::{Mutex, MutexGuard, OnceLock};
use std::thread;
use std::time::Duration;

use super::failure::Failure;
use crate::quantity::printable::{is_obeyed, numbered};

/// Messages that wait to be written at most; those beyond are dropped, and counted.
const MOST_WAITING: usize = 4096;
/// The longest wait for messages to be written before results are, and at the end.
const PATIENCE: Duration = Duration::from_secs(2);

/// What the thread does: a message to write, or something else in its turn.
type Turn = Box<dyn FnOnce() + Send>;

/// The way to the thread, and the messages dropped since one was last taken.
struct Messages {
    turns: SyncSender<Turn>,
    dropped: Mutex<u64>,
}

/// Prints to standard output; a closed pipe is no fault.
pub fn print(text: &str) -> Result<(), Failure> {
    print_as_it_is(&visible(text))
}

/// Prints a text with its control characters, as a file that is to be the same.
pub fn print_as_it_is(text: &str) -> Result<(), Failure> {
    flush();
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::machine(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a line to standard error, in its turn and without waiting for it; a long run does not stop if it cannot be
/// written.
pub fn notify(line: &str) {
    let line = visible(line).into_owned();
    in_turn(Box::new(move || write_line(&line)));
}

/// Does something that writes to standard error, in its turn and without waiting for it.
pub fn in_turn(turn: Turn) {
    match messages() {
        Some(messages) => messages.send(&mut messages.dropped(), turn),
        None => turn(),
    }
}

/// Waits until all messages are written, but not for long.
pub fn flush() {
    let (turn, is_done) = mark();
    in_turn(turn);
    let _ = is_done.recv_timeout(PATIENCE);
}

/// Prints the last line of a program that is about to end, and waits until it is written, but not for long. Threads
/// that are still at work have no message after it: they wait for the end.
pub fn notify_at_last(line: impl FnOnce() -> String) {
    let Some(messages) = messages() else { return write_line(&visible(&line())) };
    let mut dropped = messages.dropped();
    // Only now, as no message can come between what it says and the line.
    let line = visible(&line()).into_owned();
    messages.send(&mut dropped, Box::new(move || write_line(&line)));
    let (turn, is_done) = mark();
    messages.send(&mut dropped, turn);
    let _ = is_done.recv_timeout(PATIENCE);
    std::mem::forget(dropped);
}

/// Something to do in its turn, and the way to know that it is done.
fn mark() -> (Turn, Receiver<()>) {
    let (done, is_done) = channel();
    let turn: Turn = Box::new(move || {
        // The receiver is gone once the time is over.
        let _ = done.send(());
    });
    (turn, is_done)
}

impl Messages {
    /// The messages dropped since one was last taken.
    fn dropped(&self) -> MutexGuard<'_, u64> {
        self.dropped.lock().unwrap_or_else(|it| it.into_inner())
    }

    /// Sends `turn` to the thread, behind a word on the messages that were `dropped` before it.
    fn send(&self, dropped: &mut u64, turn: Turn) {
        let count = *dropped;
        let turn: Turn = match count {
            0 => turn,
            _ => Box::new(move || {
                write_line(&format!("({count} messages before this one were not read in time)"));
                turn();
            }),
        };
        *dropped = match self.turns.try_send(turn) {
            Ok(()) => 0,
            Err(TrySendError::Full(_) | TrySendError::Disconnected(_)) => count + 1,
        };
    }
}

/// The way to the thread; none if the system has no thread for it.
fn messages() -> Option<&'static Messages> {
    static MESSAGES: OnceLock<Option<Messages>> = OnceLock::new();
    MESSAGES.get_or_init(begin).as_ref()
}

/// Starts the thread.
fn begin() -> Option<Messages> {
    let (turns, taken): (_, Receiver<Turn>) = sync_channel(MOST_WAITING);
    thread::Builder::new().spawn(move || taken.into_iter().for_each(|turn| turn())).ok()?;
    Some(Messages { turns, dropped: Mutex::new(0) })
}

fn write_line(line: &str) {
    // A failure to write to standard error cannot be reported.
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// A text in which a terminal finds nothing to obey: control characters, but for the ends of lines and tabs, and those
/// that change the direction of a text are shown by their numbers, as JSON writes them.
fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_numbered) {
        return Cow::Borrowed(text);
    }
    // The end of a line as Windows writes it.
    let text = text.replace("\r\n", "\n");
    let shown = text.chars().map(|c| if is_numbered(c) { numbered(c) } else { c.to_string() });
    Cow::Owned(shown.collect())
}

/// Whether a character is shown by its number.
fn is_numbered(c: char) -> bool {
    is_obeyed(c) && c != '\n' && c != '\t'
}

#[cfg(test)]
mod tests {
    use super::visible;

    #[test]
    fn what_a_terminal_would_obey_is_shown() {
        assert_eq!(visible("5 \u{b5}m\tat\r\n77 rad/s\n"), "5 \u{b5}m\tat\n77 rad/s\n");
        assert_eq!(
            visible("\u{1b}[2Ja\rb\u{7f}\u{9b}\u{202e}c"),
            "\\u001b[2Ja\\u000db\\u007f\\u009b\\u202ec"
        );
        let json = serde_json::json!({ "a": "\u{1b}\u{7f}\u{9b}\u{202e}" }).to_string();
        let read: serde_json::Value = serde_json::from_str(&visible(&json)).expect("it is JSON");
        assert_eq!(read["a"], "\u{1b}\u{7f}\u{9b}\u{202e}");
    }
}
