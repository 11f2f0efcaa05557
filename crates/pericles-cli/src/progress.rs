//! How far a run is: a bar on a terminal, a line every tenth otherwise.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use pericles_run::units::{duration, quantity};

use crate::console;

/// Shows on the standard error how far a run is.
pub(crate) struct Progress {
    style: Style,
    first: u64,
    steps: u64,
    began: Instant,
}

enum Style {
    Bar {
        bar: ProgressBar,
        shown: Instant,
    },
    /// The next tenth that is worth a line.
    Lines {
        next: u64,
    },
}

/// Between two changes of the text beside the bar.
const REFRESH: Duration = Duration::from_millis(200);

impl Progress {
    /// A run from step `first` to step `steps`.
    pub(crate) fn new(first: u64, steps: u64) -> Self {
        let now = Instant::now();
        let style = if std::io::stderr().is_terminal() {
            let bar = ProgressBar::new(steps).with_position(first);
            let template = "{bar:30} {percent:>3} %  step {pos} of {len}  {msg}  {eta} left";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style.progress_chars("█▉▊▋▌▍▎▏ "));
            }
            bar.reset_eta();
            Style::Bar { bar, shown: now }
        } else {
            Style::Lines {
                next: tenth(first, steps) + 1,
            }
        };
        Self {
            style,
            first,
            steps,
            began: now,
        }
    }

    /// After a step.
    pub(crate) fn step(&mut self, step: u64, t: f64) {
        match &mut self.style {
            Style::Bar { bar, shown } => {
                bar.set_position(step);
                if shown.elapsed() >= REFRESH {
                    bar.set_message(format!("t = {}", quantity(t, "s")));
                    *shown = Instant::now();
                }
            }
            Style::Lines { next } => {
                let reached = tenth(step, self.steps);
                if reached >= *next && step < self.steps {
                    *next = reached + 1;
                    let done = (step - self.first) as f64;
                    let left = (self.steps - step) as f64;
                    let seconds = self.began.elapsed().as_secs_f64() / done * left;
                    console::note(format_args!(
                        "{:3} %  step {step} of {}, t = {}, {} left",
                        10 * reached,
                        self.steps,
                        quantity(t, "s"),
                        duration(seconds)
                    ));
                }
            }
        }
    }

    /// Prints a line on the standard error, above the bar.
    pub(crate) fn note(&self, line: std::fmt::Arguments<'_>) {
        match &self.style {
            Style::Bar { bar, .. } => bar.suspend(|| console::note(line)),
            _ => console::note(line),
        }
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        if let Style::Bar { bar, .. } = &self.style {
            bar.finish_and_clear();
        }
    }
}

/// Whole tenths of the way.
fn tenth(step: u64, steps: u64) -> u64 {
    (u128::from(step) * 10 / u128::from(steps.max(1))) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tenths() {
        assert_eq!([0, 9, 10, 99, 100].map(|k| tenth(k, 100)), [0, 0, 1, 9, 10]);
        assert_eq!(tenth(3, 0), 30);
        assert_eq!(tenth(u64::MAX, u64::MAX), 10);
    }
}
