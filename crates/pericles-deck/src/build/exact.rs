//! The exact solution of a model and the points it is compared at.

use pericles::analysis::exact::{
    BarMode, ExactSolution, LineSolution, StretchedBar, TravellingPulse,
};
use pericles::space::{PointCloud, PointSet};

use crate::caution::Caution;
use crate::deck::Deck;
use crate::exact::{KnownSolution, Pulse};
use crate::finding::Warning;

/// What a run is compared with.
pub struct ExactReference {
    /// The solution.
    pub solution: Box<dyn ExactSolution>,
    /// The points that count.
    pub points: PointSet,
}

impl Deck {
    pub(super) fn exact_reference(
        &self,
        cloud: &PointCloud,
        young: f64,
        warnings: &mut Vec<Warning>,
    ) -> Option<ExactReference> {
        let exact = self.exact?;
        let density = self.material.bonds.density;
        let speed = (young / density).sqrt();
        let (solution, centre): (Box<dyn ExactSolution>, f64) = match exact.solution {
            KnownSolution::NonlocalPulse {
                pulse:
                    Pulse {
                        width,
                        amplitude,
                        centre,
                    },
                length,
            } => {
                let line = LineSolution {
                    young,
                    density,
                    length,
                    width,
                    amplitude,
                    centre,
                };
                self.judge_period(&line, cloud, exact.window, warnings);
                (Box::new(line), centre)
            }
            KnownSolution::LocalPulse(Pulse {
                width,
                amplitude,
                centre,
            }) => {
                let pulse = TravellingPulse {
                    speed,
                    width,
                    amplitude,
                    centre,
                };
                (Box::new(pulse), centre)
            }
            KnownSolution::StretchedBar { length, strain } => {
                let bar = StretchedBar {
                    length,
                    strain,
                    speed,
                };
                (Box::new(bar), 0.0)
            }
            KnownSolution::BarMode { length, amplitude } => {
                let mode = BarMode {
                    length,
                    amplitude,
                    speed,
                };
                (Box::new(mode), 0.0)
            }
        };
        let counts = |x: f64| {
            exact
                .window
                .is_none_or(|window| (x - centre).abs() <= window * (1.0 + 1e-12))
        };
        let x = cloud.axis(0);
        let points = (0..x.len() as u32)
            .filter(|&i| counts(x[i as usize]))
            .collect();
        Some(ExactReference { solution, points })
    }

    /// Warns of a period so short that the waves of the next one arrive within the run.
    fn judge_period(
        &self,
        line: &LineSolution,
        cloud: &PointCloud,
        window: Option<f64>,
        warnings: &mut Vec<Warning>,
    ) {
        /// Share of the amplitude from which it is told.
        const NOTABLE: f64 = 1e-6;
        if !self.body.periodic {
            return;
        }
        let period = cloud.len() as f64 * cloud.spacing();
        let window = window.unwrap_or(0.5 * period);
        let estimate = line.image_error(period, window, self.time.end);
        if estimate > NOTABLE {
            let caution = Caution::ShortPeriod {
                period,
                estimate,
                window,
            };
            warnings.push(self.finding(&"body.periodic".into(), caution));
        }
    }
}
