//! The integrator of a model.

use pericles::observe::Probe;
use pericles::time::{
    AdaptiveRungeKutta, Damping, DiscreteGradient, Fine, Implicit, ImplicitRule, Integrator,
    LinearSolver, MultiTimeStep, MultiTimeStepOptions, Newmark, Predictor, Relaxation,
    RelaxationOptions, Respa, RungeKutta, Tableau, VelocityVerlet,
};
use pericles::units::quantity;
use pericles::{PericlesError, System};
use pericles_deck::{BuildError, Caution, Fault, FineRegion, FineStep, Interface, KeyPath, Scheme};
use pericles_heat::FixedBody;
use pericles_waves::Trigonometric;

use super::assembler::Assembler;
use super::discretisation::Sets;
use super::rejection::{at, at_path};
use super::step::Steps;

impl Assembler<'_> {
    pub(super) fn integrator(
        &self,
        system: &System,
        sets: &Sets,
        probes: &[Probe],
    ) -> Result<Box<dyn Integrator>, BuildError> {
        Ok(match &self.model.time.scheme {
            Scheme::VelocityVerlet => Box::new(VelocityVerlet),
            Scheme::RungeKutta3 { alpha } => {
                let tableau = Tableau::rk3(*alpha).map_err(|error| at("time.alpha", error))?;
                Box::new(RungeKutta::new(&tableau, system))
            }
            Scheme::RungeKutta4 => Box::new(RungeKutta::new(&Tableau::rk4(), system)),
            Scheme::DormandPrince { tolerance } => Box::new(
                AdaptiveRungeKutta::new(*tolerance, system)
                    .map_err(|error| self.at_scheme(error))?,
            ),
            Scheme::MultiTimeStep3 {
                alpha,
                fine,
                interface,
            } => {
                let tableau = Tableau::rk3(*alpha).map_err(|error| at("time.alpha", error))?;
                self.two_steps(&tableau, fine, *interface, system, sets)?
            }
            Scheme::MultiTimeStep4 { fine, interface } => {
                self.two_steps(&Tableau::rk4(), fine, *interface, system, sets)?
            }
            Scheme::ImplicitMidpoint { solver } => {
                self.implicit(ImplicitRule::Midpoint, *solver, system)?
            }
            Scheme::Trapezoidal { solver } => {
                self.implicit(ImplicitRule::Trapezoidal, *solver, system)?
            }
            Scheme::Trigonometric(options) => Box::new(
                Trigonometric::new(*options, system).map_err(|error| self.at_scheme(error))?,
            ),
            Scheme::Newmark(options) => {
                Box::new(Newmark::new(*options, system).map_err(|error| self.at_scheme(error))?)
            }
            Scheme::DiscreteGradient { tolerance } => Box::new(
                DiscreteGradient::new(*tolerance, system).map_err(|error| self.at_scheme(error))?,
            ),
            Scheme::AdaptiveDynamicRelaxation { damping, limits } => {
                let damping = damping.map_or(Damping::Adaptive, Damping::Viscous);
                self.relaxation(limits.with(damping), system)?
            }
            Scheme::Fire(limits) => self.relaxation(limits.with(Damping::Fire), system)?,
            Scheme::Static(options) => self.statics(options, system, probes)?,
            Scheme::Thermal if system.fields().next().is_none() => {
                let error = PericlesError::SchemeNotUsable {
                    scheme: "thermal",
                    reason: "it computes the temperature of a body that does not move, and this body does not conduct heat; set `conductivity` and `specific_heat` in [thermal]",
                };
                return Err(self.at_scheme(error));
            }
            Scheme::Thermal => Box::new(FixedBody),
            Scheme::Respa { fine } => {
                let region = self.fine_points(fine, system, sets)?;
                Box::new(
                    Respa::new(fine.ratio, region, system)
                        .map_err(|error| self.at_scheme(error))?,
                )
            }
        })
    }

    fn implicit(
        &self,
        rule: ImplicitRule,
        solver: LinearSolver,
        system: &System,
    ) -> Result<Box<dyn Integrator>, BuildError> {
        let scheme = Implicit::with_solver(rule, solver, system);
        Ok(Box::new(scheme.map_err(|error| self.at_scheme(error))?))
    }

    fn relaxation(
        &self,
        options: RelaxationOptions,
        system: &System,
    ) -> Result<Box<dyn Integrator>, BuildError> {
        let scheme = Relaxation::new(options, system);
        Ok(Box::new(scheme.map_err(|error| self.at_scheme(error))?))
    }

    fn two_steps(
        &self,
        tableau: &Tableau,
        fine: &FineStep,
        interface: Interface,
        system: &System,
        sets: &Sets,
    ) -> Result<Box<dyn Integrator>, BuildError> {
        let options = MultiTimeStepOptions {
            ratio: fine.ratio,
            fine: self.fine_points(fine, system, sets)?,
            predictor: interface.predictor,
            interpolant: interface.interpolant,
        };
        let scheme =
            MultiTimeStep::new(tableau, options, system).map_err(|error| self.at_scheme(error))?;
        Ok(Box::new(scheme))
    }

    fn fine_points(
        &self,
        fine: &FineStep,
        system: &System,
        sets: &Sets,
    ) -> Result<Fine, BuildError> {
        match &fine.region {
            FineRegion::Sets(names) => {
                let regions: Result<Vec<_>, _> = names
                    .iter()
                    .map(|name| self.members(sets, name, "time.fine").cloned())
                    .collect();
                Ok(Fine::Fixed(regions?))
            }
            FineRegion::Adaptive(_) if !system.operator().can_break() => {
                let error = PericlesError::SchemeNotUsable {
                    scheme: "a fine region that follows damage",
                    reason: "its bonds do not break; give names of sets in `fine`, or a fracture energy",
                };
                Err(at("time.adaptive", error))
            }
            FineRegion::Adaptive(follow) => Ok(Fine::Adaptive(*follow)),
        }
    }

    pub(super) fn at_scheme(&self, error: PericlesError) -> BuildError {
        let error = match self.named_fine_sets(error) {
            Ok(fault) => return at_path("time.fine", fault),
            Err(error) => error,
        };
        let path: KeyPath = match &error {
            PericlesError::StepRatio { .. } => "time.ratio".into(),
            PericlesError::FineRegionEmpty { .. } => "time.fine".into(),
            _ => "time.scheme".into(),
        };
        at_path(&path, error.into())
    }

    /// Converts errors of fine regions to faults with the names of their sets; returns other errors.
    fn named_fine_sets(&self, error: PericlesError) -> Result<Fault, PericlesError> {
        let fine = match &self.model.time.scheme {
            Scheme::MultiTimeStep3 { fine, .. }
            | Scheme::MultiTimeStep4 { fine, .. }
            | Scheme::Respa { fine } => fine,
            _ => return Err(error),
        };
        let FineRegion::Sets(names) = &fine.region else {
            return Err(error);
        };
        let name = |region: usize| names[region].clone();
        Ok(match error {
            PericlesError::FineRegionThin {
                region,
                extent,
                axis,
                reach,
            } => Fault::other(
                "too thin",
                format!(
                    "the fine set `{}` is {} thick along {axis}; it must be at least as thick as its longest bond, {}, so that no bond between coarse points crosses it",
                    name(region),
                    quantity(extent, "m"),
                    quantity(reach, "m")
                ),
                "make the set thicker along this axis, or extend it to the surface of the body",
            ),
            PericlesError::FineRegionsOverlap {
                first,
                second,
                point,
            } => Fault::other(
                "overlap",
                format!(
                    "the fine sets `{}` and `{}` share points, such as point {point}",
                    name(first),
                    name(second)
                ),
                "define one set that is the union of both",
            ),
            other => return Err(other),
        })
    }

    /// Adds warnings about a multirate scheme.
    pub(super) fn check_two_steps(&self, integrator: &dyn Integrator, steps: &Steps) {
        let Some(report) = integrator.refinement() else {
            return;
        };
        if report.ratio == 1 {
            self.warn("time.ratio", Caution::EqualSteps);
        }
        let interface = match &self.model.time.scheme {
            Scheme::MultiTimeStep3 { interface, .. } | Scheme::MultiTimeStep4 { interface, .. } => {
                interface
            }
            _ => return,
        };
        let Some(frequency) = steps.frequency else {
            return;
        };
        /// Below this value the growth is less than 1e-6 per step.
        const QUIET: f64 = 0.5;
        let omega_dt = frequency.estimate * steps.dt;
        // Equality within rounding is allowed.
        if interface.predictor == Predictor::BackwardDifference && omega_dt > QUIET * (1.0 + 1e-9) {
            let caution = Caution::GrowingPredictor {
                omega_dt,
                quiet: QUIET,
            };
            self.warn("time.predictor", caution);
        }
    }
}
