//! The semi-discrete equation of motion, which integrators advance.

mod activation;
mod booking;
mod interactions;
mod loading;
mod secondary;
mod stored;
mod succession;
mod supports;

use std::sync::Arc;

use self::activation::Activation;
pub use self::activation::ActivationRange;
use crate::accounts::Ledger;
use crate::archive::Counter;
use crate::boundary::{
    Boundary, Exchange, Load, PrescribedMotion, ProportionalLoading, Stage, Stiffness,
};
use crate::domain::Domain;
use crate::error::{PericlesError, Result, positive};
use crate::interaction::Interaction;
use crate::operator::{Force, Forces, PointSubset};
use crate::parallel::{for_each_chunk, for_each_entry};
use crate::scalar::PointScalar;
use crate::secondary::SecondaryField;
use crate::space::{PointCloud, check_length};
use crate::step_end::StepEnd;

/// The equation of motion ρ u_tt = f(u) + b(t) with constraints and boundaries.
///
/// Integrators call [`System::acceleration`] at stages and [`System::end_step`] at the end of steps; they contain
/// no physics. Multirate schemes call [`System::end_step_on`] at the end of sub-steps.
pub struct System {
    cloud: Arc<PointCloud>,
    forces: Forces,
    density: PointScalar,
    loads: Vec<Load>,
    loading: Option<ProportionalLoading>,
    motions: Vec<PrescribedMotion>,
    boundaries: Vec<Box<dyn Boundary>>,
    interactions: Vec<Box<dyn Interaction>>,
    fields: Vec<Box<dyn SecondaryField>>,
    activation: Option<Activation>,
    ledger: Ledger,
    evaluated: Counter,
    pub(crate) coarse_breaks: Counter,
}

/// The parts of a system whose state a processor changes that computes whole steps.
pub struct SystemParts<'a> {
    /// The sum of the internal forces.
    pub force: &'a mut dyn Force,
    /// The constraints.
    pub motions: &'a mut [PrescribedMotion],
    /// The boundaries.
    pub boundaries: &'a mut [Box<dyn Boundary>],
}

impl System {
    /// A free body without loads.
    ///
    /// # Errors
    /// A force made for another body; densities that are not positive, or not one per point.
    pub fn new(
        cloud: Arc<PointCloud>,
        operator: Box<dyn Force>,
        density: PointScalar,
    ) -> Result<Self> {
        Forces::check_body(&*operator, cloud.len(), cloud.dimension())?;
        match &density {
            PointScalar::Uniform(value) => {
                positive("the density", *value)?;
            }
            PointScalar::PerPoint(values) => {
                check_length("the densities of the points", values.len(), cloud.len())?;
                for &value in values {
                    positive("the density", value)?;
                }
            }
        }
        Ok(Self {
            cloud,
            forces: Forces::new(operator),
            density,
            loads: Vec::new(),
            loading: None,
            motions: Vec::new(),
            boundaries: Vec::new(),
            interactions: Vec::new(),
            fields: Vec::new(),
            activation: None,
            ledger: Ledger::default(),
            evaluated: Counter::default(),
            coarse_breaks: Counter::default(),
        })
    }

    /// Adds a boundary.
    pub fn add_boundary(&mut self, boundary: Box<dyn Boundary>) {
        self.boundaries.push(boundary);
    }

    /// Adds a constraint. Components that an earlier constraint prescribes with the same values belong to the earlier
    /// one: their reactions and work are part of its reactions and work.
    ///
    /// # Errors
    /// Points or axes that the body does not have; values that are not one per point; a component that an earlier
    /// constraint prescribes with other values.
    pub fn add_motion(&mut self, mut motion: PrescribedMotion) -> Result<()> {
        motion.check(self.dimension(), self.points())?;
        for (earlier, other) in self.motions.iter().enumerate() {
            motion
                .share(other)
                .map_err(|(point, c)| PericlesError::PrescribedTwice {
                    point: self.cloud.user_number(point as usize),
                    axis: ['x', 'y', 'z'][c],
                    earlier,
                })?;
        }
        self.motions.push(motion);
        Ok(())
    }

    /// Sets the initial displacement, to which prescribed velocities add.
    pub(crate) fn start_from(&mut self, u: &[f64]) {
        let n = self.points();
        for motion in &mut self.motions {
            motion.start_from(u, n);
        }
    }

    /// The points.
    pub fn cloud(&self) -> &Arc<PointCloud> {
        &self.cloud
    }

    /// The domain: how the body is divided among processes.
    pub fn domain(&self) -> &Domain {
        self.cloud.domain()
    }

    /// Adds a force between the points of the body to those it has.
    ///
    /// # Errors
    /// A force on another number of points or in another dimension.
    pub fn add_force(&mut self, force: Box<dyn Force>) -> Result<()> {
        self.forces.add(force)?;
        self.follow_dissipation();
        Ok(())
    }

    /// The sum of the internal forces as one force.
    pub fn operator(&self) -> &dyn Force {
        self.forces.sum()
    }

    /// The internal forces.
    pub fn forces(&self) -> impl Iterator<Item = &dyn Force> {
        self.forces.iter()
    }

    /// The sum of the internal forces, mutable.
    pub(crate) fn operator_mut(&mut self) -> &mut dyn Force {
        self.forces.sum_mut()
    }

    /// Adds work (J) and impulse (N s) of constraints to the energy balance.
    pub(crate) fn book_reaction(&mut self, work: f64, impulse: [f64; 3]) {
        self.ledger.book(work, impulse);
    }

    /// Mass densities, kg/m³.
    pub fn density(&self) -> &PointScalar {
        &self.density
    }

    /// The constraints.
    pub fn motions(&self) -> &[PrescribedMotion] {
        &self.motions
    }

    /// Work and impulse of external forces so far.
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// Number of force evaluations at own points so far: one evaluation of the whole body counts once per point.
    pub fn evaluated_points(&self) -> u64 {
        self.evaluated.get()
    }

    /// Adds evaluations of the whole body by another processor.
    pub fn count_evaluations(&mut self, evaluations: u64) {
        self.evaluated.add(evaluations * self.points() as u64);
    }

    /// Resets the number of evaluations after a step is undone.
    pub(crate) fn set_evaluated_points(&mut self, points: u64) {
        self.evaluated = points.into();
    }

    /// Returns whether there are boundaries with a state of their own.
    pub fn has_boundaries(&self) -> bool {
        !self.boundaries.is_empty()
    }

    /// The parts of the system whose state another processor changes.
    pub fn parts_mut(&mut self) -> SystemParts<'_> {
        SystemParts {
            force: self.forces.sum_mut(),
            motions: &mut self.motions,
            boundaries: &mut self.boundaries,
        }
    }

    /// The boundaries.
    pub fn boundaries(&self) -> impl Iterator<Item = &dyn Boundary> {
        self.boundaries.iter().map(|boundary| &**boundary)
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.cloud.len()
    }

    /// Dimension of the body.
    pub fn dimension(&self) -> usize {
        self.cloud.dimension()
    }

    /// Computes the acceleration at a stage: internal force and loads over density, plus the acceleration of boundaries, for
    /// which `v` is the velocity of the stage (needed only if [`System::has_boundaries`]); prescribed where motion
    /// is prescribed. Entries of points outside `on` are unchanged.
    pub fn acceleration(
        &mut self,
        t: f64,
        u: &[f64],
        v: &[f64],
        on: PointSubset<'_>,
        out: &mut [f64],
    ) {
        self.free_acceleration(t, u, &on, out);
        self.finish(t, u, v, &on, out);
    }

    /// Computes the acceleration at the end of a step with velocity `v`: breaks bonds, updates boundaries with
    /// memory, and adds work and impulse of the step to the energy balance.
    pub fn end_step(&mut self, step: &StepEnd<'_>, v: &[f64], out: &mut [f64]) {
        // With the bonds that acted within the step, before those that break at its end are removed.
        let heating = self.operator().heating(step);
        let touched = self.end_forces(step, out);
        self.ledger.book(heating, [0.0; 3]);
        self.book_exchange(touched);
        self.book_step(step, out);
        self.accept_boundaries(step);
        self.finish(step.t, step.u, v, &PointSubset::All, out);
        self.account_boundaries(step);
    }

    /// Ends a step for all forces: breaks bonds and evaluates f/ρ. Returns work and impulse of interactions.
    fn end_forces(&mut self, step: &StepEnd<'_>, out: &mut [f64]) -> Exchange {
        let on = &PointSubset::All;
        self.zero(on, out);
        self.count(on);
        self.operator_mut().end_step(step, on.clone(), out);
        self.add_loads(step.t, on, out);
        let touched = self.end_interactions(step, out);
        self.divide_by_density(on, out);
        touched
    }

    /// Ends a sub-step of the points of `on`: breaks their bonds and evaluates f/ρ. Does not update the energy
    /// balance, leaves prescribed motion to [`System::finish`] and does not end the step of interactions.
    pub fn end_step_on(&mut self, step: &StepEnd<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        self.zero(on, out);
        self.count(on);
        self.operator_mut().end_step(step, on.clone(), out);
        self.add_interactions(step.t, step.u, on, out);
        self.add_loads(step.t, on, out);
        self.divide_by_density(on, out);
    }

    /// As [`System::end_step_on`], for the bonds whose other end is marked in `partners`; loads are included if
    /// `with_loads`.
    pub fn end_step_on_from(
        &mut self,
        step: &StepEnd<'_>,
        on: &PointSubset<'_>,
        partners: &[bool],
        with_loads: bool,
        out: &mut [f64],
    ) {
        self.zero(on, out);
        self.count(on);
        if let Some(split) = self.operator_mut().split_mut() {
            split.end_step_from(step, on.clone(), partners, out);
        }
        if with_loads {
            self.add_loads(step.t, on, out);
        }
        self.divide_by_density(on, out);
    }

    fn count(&mut self, on: &PointSubset<'_>) {
        let points = on.count(self.points());
        self.evaluated.add(points as u64);
    }

    /// Computes f/ρ including loads on the points of `on`, whether or not their motion is prescribed.
    pub fn free_acceleration(&mut self, t: f64, u: &[f64], on: &PointSubset<'_>, out: &mut [f64]) {
        self.zero(on, out);
        self.count(on);
        self.add_internal_force(t, u, on, out);
        self.add_loads(t, on, out);
        self.divide_by_density(on, out);
    }

    /// As [`System::free_acceleration`], for the bonds whose other end is marked in `partners`; loads are included
    /// if `with_loads`.
    pub fn free_acceleration_from(
        &mut self,
        t: f64,
        u: &[f64],
        on: &PointSubset<'_>,
        partners: &[bool],
        with_loads: bool,
        out: &mut [f64],
    ) {
        self.zero(on, out);
        self.count(on);
        if let Some(split) = self.operator().as_split() {
            split.add_force_from(t, u, on.clone(), partners, out);
        }
        if with_loads {
            self.add_loads(t, on, out);
        }
        self.divide_by_density(on, out);
    }

    /// Completes f/ρ on the points of `on` with prescribed accelerations and the accelerations of boundaries.
    pub fn finish(&mut self, t: f64, u: &[f64], v: &[f64], on: &PointSubset<'_>, out: &mut [f64]) {
        for motion in &self.motions {
            motion.accelerate(t, on, self.cloud.len(), out);
        }
        self.hold_inactive(out);
        let stage = Stage {
            t,
            u,
            v,
            on: on.clone(),
        };
        self.with_boundaries(t, |boundary, stiffness| {
            boundary.after_stage_with(&stage, stiffness, out);
        });
    }

    /// Updates boundaries with an accepted state and adds their work and impulse to the energy balance.
    fn accept_boundaries(&mut self, step: &StepEnd<'_>) {
        let mut exchanges: Vec<Exchange> = Vec::new();
        self.with_boundaries(step.t, |boundary, stiffness| {
            exchanges.push(boundary.accept_with(step, stiffness));
        });
        for exchange in exchanges {
            self.book_exchange(exchange);
        }
    }

    /// Adds work and impulse of boundaries that depend on the accelerations at the end of a step to the energy balance.
    fn account_boundaries(&mut self, step: &StepEnd<'_>) {
        let mut boundaries = std::mem::take(&mut self.boundaries);
        for boundary in &mut boundaries {
            self.book_exchange(boundary.account(step));
        }
        self.boundaries = boundaries;
    }

    /// Calls `act` for every boundary, with access to the stiffness at time t.
    fn with_boundaries(&mut self, t: f64, mut act: impl FnMut(&mut dyn Boundary, Stiffness<'_>)) {
        if self.boundaries.is_empty() {
            return;
        }
        let mut boundaries = std::mem::take(&mut self.boundaries);
        let product = |u: &[f64], direction: &[f64], out: &mut [f64]| {
            self.internal_tangent_into(t, u, direction, out);
            self.divide_by_density(&PointSubset::All, out);
            for_each_chunk(out, &|_, chunk| chunk.iter_mut().for_each(|x| *x = -*x));
            self.hold_at(t, out);
        };
        let hold = |vector: &mut [f64]| self.hold_at(t, vector);
        let stiffness = Stiffness {
            product: &product,
            hold: &hold,
        };
        for boundary in &mut boundaries {
            act(&mut **boundary, stiffness);
        }
        self.boundaries = boundaries;
    }

    /// Stores the reactions of the initial state.
    pub fn start(&mut self, t: f64, u: &[f64], v: &[f64], out: &mut [f64]) {
        let start = StepEnd::start(t, u, v);
        self.zero(&PointSubset::All, out);
        self.count(&PointSubset::All);
        self.operator().add_force(t, u, PointSubset::All, out);
        self.add_loads(t, &PointSubset::All, out);
        let touched = self.end_interactions(&start, out);
        self.book_exchange(touched);
        self.divide_by_density(&PointSubset::All, out);
        self.book_step(&start, out);
        self.accept_boundaries(&start);
        self.finish(t, u, v, &PointSubset::All, out);
        self.account_boundaries(&start);
    }

    /// Computes internal force and loads at displacement u, N/m³.
    pub fn force_density_into(&self, t: f64, u: &[f64], out: &mut [f64]) {
        self.zero(&PointSubset::All, out);
        self.add_internal_force(t, u, &PointSubset::All, out);
        self.add_loads(t, &PointSubset::All, out);
    }

    /// Computes loads over density at time t, m/s².
    pub fn external_acceleration_into(&self, t: f64, out: &mut [f64]) {
        self.zero(&PointSubset::All, out);
        self.add_loads(t, &PointSubset::All, out);
        self.divide_by_density(&PointSubset::All, out);
    }

    /// Mass of the body, kg. All processes must call it together.
    pub fn mass(&self) -> f64 {
        let domain = self.cloud.domain();
        domain.sum(self.points(), |i| self.mass_of(i))
    }

    /// Mass of every unknown, kg, component-major.
    pub fn masses(&self) -> Vec<f64> {
        let n = self.points();
        let mass = |entry: usize| self.density.at(entry % n) * self.cloud.volumes()[entry % n];
        (0..self.dimension() * n).map(mass).collect()
    }

    /// Computes K d / ρ at displacement u, zero on prescribed entries: the operator of linearised free vibration.
    pub fn vibration_into(&self, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.free_vibration_into(u, direction, out);
        self.hold(out);
    }

    fn free_vibration_into(&self, u: &[f64], direction: &[f64], out: &mut [f64]) {
        match self.operator().as_linear() {
            Some(linear) => linear.apply_into(direction, out),
            None => self.operator().tangent_into(0.0, u, direction, out),
        }
        self.add_contact_tangent(0.0, u, direction, out);
        self.divide_by_density(&PointSubset::All, out);
        for_each_chunk(out, &|_, chunk| chunk.iter_mut().for_each(|x| *x = -*x));
    }

    /// Kinetic energy, J.
    pub fn kinetic_energy(&self, v: &[f64]) -> f64 {
        let n = self.points();
        self.domain().sum(n, |i| {
            let square: f64 = (0..self.dimension()).map(|c| v[c * n + i].powi(2)).sum();
            0.5 * self.density.at(i) * self.cloud.volumes()[i] * square
        })
    }

    /// Linear momentum, kg m/s.
    pub fn momentum(&self, v: &[f64]) -> [f64; 3] {
        let n = self.points();
        std::array::from_fn(|c| {
            if c >= self.dimension() {
                return 0.0;
            }
            self.domain().sum(n, |i| {
                self.density.at(i) * self.cloud.volumes()[i] * v[c * n + i]
            })
        })
    }

    fn zero(&self, on: &PointSubset<'_>, out: &mut [f64]) {
        for_each_entry(on, self.points(), out, &|_, x| *x = 0.0);
    }

    fn divide_by_density(&self, on: &PointSubset<'_>, out: &mut [f64]) {
        let n = self.points();
        match &self.density {
            PointScalar::Uniform(density) => for_each_entry(on, n, out, &|_, x| *x /= density),
            PointScalar::PerPoint(densities) => {
                for_each_entry(on, n, out, &|i, x| *x /= densities[i]);
            }
        }
    }
}
