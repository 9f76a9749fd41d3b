//! Showing what goes on and how far it is: a bar for people, lines of JSON for programs.

use crate::args::ProgressKind;
use crate::excerpt::plain;
use crate::say::tell;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;
use snell::render::Progress;
use std::io::IsTerminal;
use std::sync::Mutex;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// The bar comes after this time.
const BAR_DELAY: Duration = Duration::from_millis(400);

/// JSON lines come at most this often.
const JSON_INTERVAL: Duration = Duration::from_millis(100);

pub enum Reporter {
    Silent,
    Bar(ProgressBar),
    Json { started: Instant, last: Mutex<Option<Instant>> },
}

impl Reporter {
    pub fn new(kind: ProgressKind, quiet: bool, what: &str) -> Self {
        match kind {
            ProgressKind::Json => Self::Json { started: Instant::now(), last: Mutex::new(None) },
            ProgressKind::Auto if quiet => Self::Silent,
            ProgressKind::Auto => {
                // Hidden by itself where stderr is no terminal.
                let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(10));
                let colors = if crate::say::colored(&std::io::stderr()) { ".yellow/dim" } else { "" };
                let template = format!("{{prefix}} {{bar:40{colors}}} {{percent:>3}} %  {{msg}}");
                if let Ok(style) = ProgressStyle::with_template(&template) {
                    bar.set_style(style.progress_chars("━╸─"));
                }
                bar.set_prefix(plain(what));
                Self::Bar(bar)
            }
        }
    }

    pub fn update(&self, progress: Progress) {
        match self {
            Self::Silent => {}
            // What is over at once needs no bar, and the first guesses at the time left are wild.
            Self::Bar(bar) if bar.elapsed() < BAR_DELAY => {}
            Self::Bar(bar) => {
                bar.set_length(progress.total_pixels);
                bar.set_position(progress.pixels);
                let elapsed = bar.elapsed();
                let rate = short(progress.rays as f64 / elapsed.as_secs_f64().max(1e-9));
                bar.set_message(format!("{rate} rays/s  {} left", HumanDuration(left(elapsed, &progress))));
            }
            Self::Json { started, last } => {
                let Ok(mut last) = last.lock() else { return };
                if last.is_none_or(|at| at.elapsed() >= JSON_INTERVAL) {
                    *last = Some(Instant::now());
                    let Progress { pixels, total_pixels, rays } = progress;
                    let elapsed = started.elapsed();
                    let event = json!({
                        "event": "progress", "pixels": pixels, "total_pixels": total_pixels, "rays": rays,
                        "seconds": elapsed.as_secs_f64(), "left": left(elapsed, &progress).as_secs_f64(),
                    });
                    tell(&event.to_string());
                }
            }
        }
    }

    /// Says which of many things is being done.
    pub fn now(&self, what: String) {
        if let Self::Bar(bar) = self {
            bar.set_prefix(what);
        }
    }

    /// Says something while there may be a bar.
    pub fn aside(&self, say: impl FnOnce()) {
        match self {
            Self::Bar(bar) => bar.suspend(say),
            _ => say(),
        }
    }

    pub fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

/// How long the rest takes, if its pixels are like those that are finished; the renderer spreads these over the picture.
fn left(elapsed: Duration, progress: &Progress) -> Duration {
    let Progress { pixels, total_pixels, .. } = *progress;
    let rest = total_pixels.saturating_sub(pixels) as f64 / pixels.max(1) as f64;
    Duration::try_from_secs_f64(elapsed.as_secs_f64() * rest).unwrap_or(Duration::MAX)
}

/// Says what goes on besides tracing (reading, preparing, writing) while it lasts, if it lasts longer than a moment.
pub struct Phase {
    /// Dropped at the end, which ends the thread.
    over: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Phase {
    pub fn start(kind: ProgressKind, quiet: bool, what: &'static str, name: &str) -> Self {
        match kind {
            ProgressKind::Json => tell(&json!({ "event": what, "name": name }).to_string()),
            ProgressKind::Auto if quiet || !std::io::stderr().is_terminal() => {}
            ProgressKind::Auto => {
                let (over, is_over) = channel::<()>();
                let text = format!("{what} {}", plain(name));
                let draw = move || {
                    let wait = |time| is_over.recv_timeout(time) == Err(RecvTimeoutError::Timeout);
                    if wait(BAR_DELAY) {
                        let spinner = ProgressBar::new_spinner().with_message(text);
                        while wait(Duration::from_millis(100)) {
                            spinner.tick();
                        }
                        spinner.finish_and_clear();
                    }
                };
                // Where no thread is to be had, nothing is drawn.
                let thread = std::thread::Builder::new().spawn(draw).ok();
                return Self { over: Some(over), thread };
            }
        }
        Self { over: None, thread: None }
    }
}

impl Drop for Phase {
    fn drop(&mut self) {
        self.over = None;
        if let Some(thread) = self.thread.take() {
            // It only draws; there is nothing to do about a failure.
            let _ = thread.join();
        }
    }
}

/// A number in three digits and a letter: 1.23M.
pub fn short(value: f64) -> String {
    for (unit, letter) in [(1e9, "G"), (1e6, "M"), (1e3, "k")] {
        if value >= unit {
            let scaled = value / unit;
            let digits = if scaled >= 100.0 { 0 } else { 1 + usize::from(scaled < 10.0) };
            return format!("{scaled:.digits$}{letter}");
        }
    }
    format!("{value:.0}")
}

#[cfg(test)]
mod tests {
    #[test]
    fn three_digits_and_a_letter() {
        let shown = [0.0, 999.0, 1234.0, 55_700.0, 123_456_789.0, 2e12].map(super::short);
        assert_eq!(shown, ["0", "999", "1.23k", "55.7k", "123M", "2000G"]);
    }
}
