//! Progress of a run: a bar on a terminal, otherwise a line every 10 %. Steps that take seconds also report their iterations.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use pericles::IterationProgress;
use pericles_run::units::{count, duration, quantity, significant};

use crate::console;

/// Shows the progress of a run on standard error.
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
    /// The next tenth to report.
    Lines {
        next: u64,
        /// When the last line was printed.
        printed: Instant,
    },
}

/// Interval between two lines about iterations.
const BETWEEN_LINES: Duration = Duration::from_secs(1);
/// Interval between updates of the text beside the bar.
const REFRESH: Duration = Duration::from_millis(200);

impl Progress {
    /// Starts the display of a run from step `first` to step `steps`.
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
                printed: now,
            }
        };
        Self {
            style,
            first,
            steps,
            began: now,
        }
    }

    /// Updates the display after a step.
    pub(crate) fn step(&mut self, step: u64, t: f64) {
        match &mut self.style {
            Style::Bar { bar, shown } => {
                bar.set_position(step);
                if shown.elapsed() >= REFRESH {
                    bar.set_message(format!("t = {}", quantity(t, "s")));
                    *shown = Instant::now();
                }
            }
            Style::Lines { next, printed } => {
                let reached = tenth(step, self.steps);
                if reached >= *next && step < self.steps {
                    *next = reached + 1;
                    *printed = Instant::now();
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

    /// Reports an iteration within a step.
    pub(crate) fn iteration(&mut self, progress: IterationProgress) {
        let IterationProgress {
            iteration,
            residual,
            tolerance,
            evaluations,
        } = progress;
        let text = format!(
            "iteration {iteration}: residual {} of {}, {} evaluations",
            significant(residual, 2),
            significant(tolerance, 2),
            count(evaluations)
        );
        match &mut self.style {
            Style::Bar { bar, shown } if shown.elapsed() >= REFRESH => {
                bar.set_message(text);
                *shown = Instant::now();
            }
            Style::Lines { printed, .. } if printed.elapsed() >= BETWEEN_LINES => {
                console::note(format_args!("step in progress, {text}"));
                *printed = Instant::now();
            }
            _ => {}
        }
    }

    /// Prints a line on standard error, above the bar.
    pub(crate) fn note(&self, line: std::fmt::Arguments<'_>) {
        match &self.style {
            Style::Bar { bar, .. } => bar.suspend(|| console::note(line)),
            _ => console::note(line),
        }
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        if let Style::Bar { bar, .. } = &self.style {
            bar.finish_and_clear();
        }
    }
}

/// Returns the completed tenths of a run.
fn tenth(step: u64, steps: u64) -> u64 {
    (u128::from(step) * 10 / u128::from(steps.max(1))) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn completed_tenths_are_rounded_down() {
        assert_eq!([0, 9, 10, 99, 100].map(|k| tenth(k, 100)), [0, 0, 1, 9, 10]);
        assert_eq!(tenth(3, 0), 30);
        assert_eq!(tenth(u64::MAX, u64::MAX), 10);
    }
}
