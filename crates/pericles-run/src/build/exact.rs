//! The exact solution of a model and the points of comparison.

use pericles::space::{PointCloud, PointSet};
use pericles::units::quantity;
use pericles_deck::{BuildError, Caution, Fault, KnownSolution, Pulse, Solid};
use pericles_waves::exact::{BarMode, ExactSolution, LineSolution, StretchedBar, TravellingPulse};

use super::assembler::Assembler;
use super::constants::MaterialConstants;
use super::part::gathered;
use super::rejection::at_path;

/// The exact solution for comparison.
pub struct ExactReference {
    /// The solution.
    pub solution: Box<dyn ExactSolution>,
    /// The points of comparison: of the whole body on the first process, own points on the others.
    pub points: PointSet,
}

impl Assembler<'_> {
    pub(super) fn exact_reference(
        &self,
        cloud: &PointCloud,
        constants: Option<&MaterialConstants>,
    ) -> Result<Option<ExactReference>, BuildError> {
        let Some(exact) = self.model.exact else {
            return Ok(None);
        };
        let (Some(solid), Some(constants)) = (self.model.body.solid(), constants) else {
            let reason = "exact solutions are available for bars only";
            return Err(at_path("exact", Fault::NoExactSolution { reason }));
        };
        let young = constants.young();
        let density = solid.material.density();
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
                self.check_terms(&line, cloud)?;
                self.check_period(solid, &line, cloud, exact.window);
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
        let points: PointSet = (0..x.len() as u32)
            .filter(|&i| counts(x[i as usize]))
            .collect();
        let domain = cloud.domain();
        let is_empty = domain.all(points.is_empty());
        if let (Some(window), true) = (exact.window, is_empty) {
            let distances = x.iter().map(|x| -(x - centre).abs());
            let nearest = -domain.max(distances.fold(f64::NEG_INFINITY, f64::max));
            let fault = Fault::other(
                "no points",
                format!(
                    "the window of {} around x = {} contains no point: the nearest one is {} away",
                    quantity(window, "m"),
                    quantity(centre, "m"),
                    quantity(nearest, "m")
                ),
                "use a larger window, or move the centre of the exact solution into the body",
            );
            return Err(at_path("exact.window", fault));
        }
        let points = gathered(cloud, points);
        Ok(Some(ExactReference { solution, points }))
    }

    /// Rejects a pulse so far from the points, or so narrow, that its series would take excessive time or memory.
    fn check_terms(&self, line: &LineSolution, cloud: &PointCloud) -> Result<(), BuildError> {
        /// Maximum number of terms per point.
        const MOST: f64 = 1e5;
        let distances = cloud.axis(0).iter().map(|x| (x - line.centre).abs());
        let reach = cloud.domain().max(distances.fold(0.0, f64::max));
        let terms = line.terms(self.model.time.end, reach);
        if terms <= MOST {
            return Ok(());
        }
        let fault = Fault::other(
            "too many terms",
            format!(
                "the exact solution needs a sum of {terms:.1e} terms per point at the end of the run; at most {MOST:.0e} are allowed"
            ),
            "move exact.centre into the body, use a larger width, or shorten the run; the number of terms is 2 (distance from the centre + 6 c end)/width",
        );
        Err(at_path("exact.solution", fault))
    }

    /// Warns if waves from the neighbouring period arrive during the run.
    fn check_period(
        &self,
        solid: &Solid,
        line: &LineSolution,
        cloud: &PointCloud,
        window: Option<f64>,
    ) {
        /// Fraction of the amplitude that leads to a warning.
        const NOTABLE: f64 = 1e-6;
        if !solid.shape.is_periodic() {
            return;
        }
        let period = cloud.domain().whole_points() as f64 * cloud.spacing();
        let window = window.unwrap_or(0.5 * period);
        let estimate = line.image_error(period, window, self.model.time.end);
        if estimate > NOTABLE {
            let caution = Caution::ShortPeriod {
                period,
                estimate,
                window,
            };
            self.warn("body.periodic", caution);
        }
    }
}
