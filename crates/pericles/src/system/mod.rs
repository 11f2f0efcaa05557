//! The semi-discrete equation of motion: everything an integrator steps.

mod stored;
mod supports;

use std::sync::Arc;

use crate::accounts::Ledger;
use crate::archive::Counter;
use crate::boundary::{Boundary, Exchange, Load, PrescribedMotion, Stage, Stiffness};
use crate::domain::Domain;
use crate::error::{PericlesError, Result, positive};
use crate::operator::{Force, Forces, On};
use crate::parallel::{for_each_chunk, for_each_entry};
use crate::scalar::PointScalar;
use crate::space::{PointCloud, check_length};
use crate::step_end::{Path, StepEnd};

/// ρ u_tt = f(u) + b(t) with prescribed motions and boundaries.
///
/// Integrators call [`System::acceleration`] at stages and [`System::end_step`] at the end of steps; they hold no physics of their own. Schemes with zones call
/// [`System::end_step_on`] at the end of sub-steps.
pub struct System {
    cloud: Arc<PointCloud>,
    forces: Forces,
    density: PointScalar,
    loads: Vec<Load>,
    motions: Vec<PrescribedMotion>,
    boundaries: Vec<Box<dyn Boundary>>,
    ledger: Ledger,
    evaluated: Counter,
    pub(crate) coarse_breaks: Counter,
}

impl System {
    /// A free body.
    ///
    /// # Errors
    /// A force made for another body; densities that are not positive, or not one a point.
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
            motions: Vec::new(),
            boundaries: Vec::new(),
            ledger: Ledger::default(),
            evaluated: Counter::default(),
            coarse_breaks: Counter::default(),
        })
    }

    /// Adds a load.
    ///
    /// # Errors
    /// Points that the body does not have, numbers that are not one for each loaded point and axis.
    pub fn add_load(&mut self, load: Load) -> Result<()> {
        load.check(self.dimension(), self.points())?;
        self.loads.push(load);
        Ok(())
    }

    /// Adds a boundary.
    pub fn add_boundary(&mut self, boundary: Box<dyn Boundary>) {
        self.boundaries.push(boundary);
    }

    /// Adds a prescribed motion.
    ///
    /// # Errors
    /// Points or axes that the body does not have, numbers that are not one for each point; a point and axis whose motion is prescribed already.
    pub fn add_motion(&mut self, motion: PrescribedMotion) -> Result<()> {
        motion.check(self.dimension(), self.points())?;
        for other in &self.motions {
            for c in 0..3 {
                if motion.along[c].is_none() || other.along[c].is_none() {
                    continue;
                }
                let common = motion
                    .points
                    .iter()
                    .find(|i| other.points.binary_search(i).is_ok());
                if let Some(&point) = common {
                    return Err(PericlesError::PrescribedTwice {
                        point: self.cloud.user_number(point as usize),
                        axis: ['x', 'y', 'z'][c],
                    });
                }
            }
        }
        self.motions.push(motion);
        Ok(())
    }

    /// Takes `u` as the displacement at the start, to which prescribed velocities add.
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

    /// The division of the body among processes.
    pub fn domain(&self) -> &Domain {
        self.cloud.domain()
    }

    /// Adds a force between the points of the body, beside those that it has.
    ///
    /// # Errors
    /// A force on another number of points, or in another dimension.
    pub fn add_force(&mut self, force: Box<dyn Force>) -> Result<()> {
        self.forces.add(force)
    }

    /// The sum of the internal forces.
    pub fn operator(&self) -> &dyn Force {
        self.forces.sum()
    }

    /// The internal forces one by one.
    pub fn forces(&self) -> impl Iterator<Item = &dyn Force> {
        self.forces.iter()
    }

    /// The sum of the internal forces, to be changed.
    pub(crate) fn operator_mut(&mut self) -> &mut dyn Force {
        self.forces.sum_mut()
    }

    /// Books work (J) and impulse (N s) of supports.
    pub(crate) fn book_reaction(&mut self, work: f64, impulse: [f64; 3]) {
        self.ledger.book(work, impulse);
    }

    /// Mass densities, kg/m³.
    pub fn density(&self) -> &PointScalar {
        &self.density
    }

    /// The prescribed motions.
    pub fn motions(&self) -> &[PrescribedMotion] {
        &self.motions
    }

    /// The loads.
    pub fn loads(&self) -> &[Load] {
        &self.loads
    }

    /// Work and impulse so far.
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// Points whose force has been evaluated so far: an evaluation of the whole body counts as many as it has points.
    pub fn evaluated_points(&self) -> u64 {
        self.evaluated.get()
    }

    /// Sets the count of a step that was undone back.
    pub(crate) fn set_evaluated_points(&mut self, points: u64) {
        self.evaluated = points.into();
    }

    /// Whether there are boundaries with a state of their own.
    pub fn has_boundaries(&self) -> bool {
        !self.boundaries.is_empty()
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

    /// Acceleration at a stage: internal force and loads over density; what boundaries give, by the stage's velocity `v` where there are any ([`System::has_boundaries`]); prescribed where motion is prescribed. Entries of other points stay.
    pub fn acceleration(&mut self, t: f64, u: &[f64], v: &[f64], on: On<'_>, out: &mut [f64]) {
        self.free_acceleration(t, u, &on, out);
        self.finish(t, u, v, &on, out);
    }

    /// The same at the end of a step with velocity `v`: decides breaking, books the work and impulse of the step, and lets boundaries with a memory go on.
    pub fn end_step(&mut self, step: &StepEnd<'_>, v: &[f64], out: &mut [f64]) {
        // With the bonds that act within the step, before it is decided which of them break at its end.
        let heating = self.operator().heating(step);
        self.end_step_on(step, &On::All, out);
        self.ledger.book(heating, [0.0; 3]);
        self.book_step(step, out);
        self.accept_boundaries(step);
        self.finish(step.t, step.u, v, &On::All, out);
    }

    /// At the end of a sub-step of the points named by `on`: decides breaking of their bonds and evaluates f/ρ for them. Books nothing, and leaves prescribed
    /// motion to [`System::finish`].
    pub fn end_step_on(&mut self, step: &StepEnd<'_>, on: &On<'_>, out: &mut [f64]) {
        self.zero(on, out);
        self.count(on);
        self.operator_mut().end_step(step, on.clone(), out);
        self.add_loads(step.t, on, out);
        self.divide_by_density(on, out);
    }

    /// [`System::end_step_on`] of the bonds whose other end is marked in `partners`; loads are part of it if `with_loads`.
    pub fn end_step_on_from(
        &mut self,
        step: &StepEnd<'_>,
        on: &On<'_>,
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

    fn count(&mut self, on: &On<'_>) {
        let points = on.count(self.points());
        self.evaluated.add(points as u64);
    }

    /// f/ρ with loads, for the points named by `on`, whether or not their motion is prescribed.
    pub fn free_acceleration(&mut self, t: f64, u: &[f64], on: &On<'_>, out: &mut [f64]) {
        self.zero(on, out);
        self.count(on);
        self.operator().add_force(t, u, on.clone(), out);
        self.add_loads(t, on, out);
        self.divide_by_density(on, out);
    }

    /// [`System::free_acceleration`] by the bonds whose other end is marked in `partners`; loads are part of it if `with_loads`.
    pub fn free_acceleration_from(
        &mut self,
        t: f64,
        u: &[f64],
        on: &On<'_>,
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

    /// Puts prescribed accelerations and those of boundaries in place of f/ρ, for the points named by `on`.
    pub fn finish(&mut self, t: f64, u: &[f64], v: &[f64], on: &On<'_>, out: &mut [f64]) {
        for motion in &self.motions {
            motion.accelerate(t, on, self.cloud.len(), out);
        }
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

    /// Lets boundaries take an accepted state, and books what they did.
    fn accept_boundaries(&mut self, step: &StepEnd<'_>) {
        let mut exchanges: Vec<Exchange> = Vec::new();
        self.with_boundaries(step.t, |boundary, stiffness| {
            exchanges.push(boundary.accept_with(step, stiffness));
        });
        for exchange in exchanges {
            self.book_exchange(exchange);
        }
    }

    /// Calls `act` for every boundary, with what it may ask of the forces at time t.
    fn with_boundaries(&mut self, t: f64, mut act: impl FnMut(&mut dyn Boundary, Stiffness<'_>)) {
        if self.boundaries.is_empty() {
            return;
        }
        let mut boundaries = std::mem::take(&mut self.boundaries);
        let product = |u: &[f64], direction: &[f64], out: &mut [f64]| {
            self.operator().tangent_into(t, u, direction, out);
            self.divide_by_density(&On::All, out);
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

    /// Notes the reactions of the initial state.
    pub fn start(&mut self, t: f64, u: &[f64], v: &[f64], out: &mut [f64]) {
        let start = StepEnd::start(t, u, v);
        self.free_acceleration(t, u, &On::All, out);
        self.book_step(&start, out);
        self.accept_boundaries(&start);
        self.finish(t, u, v, &On::All, out);
    }

    /// Internal force and loads at displacement u, N/m³.
    pub fn force_density_into(&self, t: f64, u: &[f64], out: &mut [f64]) {
        self.zero(&On::All, out);
        self.operator().add_force(t, u, On::All, out);
        self.add_loads(t, &On::All, out);
    }

    /// Loads at time t, N/m³.
    pub fn load_density_into(&self, t: f64, out: &mut [f64]) {
        self.zero(&On::All, out);
        self.add_loads(t, &On::All, out);
    }

    /// Loads over density at time t, m/s².
    pub fn external_acceleration_into(&self, t: f64, out: &mut [f64]) {
        self.zero(&On::All, out);
        self.add_loads(t, &On::All, out);
        self.divide_by_density(&On::All, out);
    }

    /// The mass of every unknown, kg, component-major.
    pub fn masses(&self) -> Vec<f64> {
        let n = self.points();
        let mass = |entry: usize| self.density.at(entry % n) * self.cloud.volumes()[entry % n];
        (0..self.dimension() * n).map(mass).collect()
    }

    /// K d / ρ at displacement u, with prescribed entries held: the operator of the linearised free vibration.
    pub fn vibration_into(&self, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.free_vibration_into(u, direction, out);
        self.hold(out);
    }

    fn free_vibration_into(&self, u: &[f64], direction: &[f64], out: &mut [f64]) {
        match self.operator().as_linear() {
            Some(linear) => linear.apply_into(direction, out),
            None => self.operator().tangent_into(0.0, u, direction, out),
        }
        self.divide_by_density(&On::All, out);
        for_each_chunk(out, &|_, chunk| chunk.iter_mut().for_each(|x| *x = -*x));
    }

    /// Books a load step from one static state to another: loads and supports act as the mean of both ends, without inertia. With a length of zero they do not change on the way.
    /// `work` is for accelerations.
    pub fn book_equilibrium(&mut self, step: &StepEnd<'_>, work: &mut [f64]) {
        self.free_acceleration(step.t, step.u, &On::All, work);
        let n = self.points();
        for motion in &self.motions {
            motion.add_acceleration(step.t, n, work);
        }
        self.book_heating(step);
        self.book_step(step, work);
    }

    /// Books the work of changing temperatures within a step that does not end by [`System::end_step`].
    pub(crate) fn book_heating(&mut self, step: &StepEnd<'_>) {
        let work = self.operator().heating(step);
        self.ledger.book(work, [0.0; 3]);
    }

    /// Notes the reactions of supports to the internal forces alone at displacement u: those of a body that no load acts on yet and that is not heated yet. `work` is for accelerations.
    pub fn note_unloaded(&mut self, t: f64, u: &[f64], work: &mut [f64]) {
        self.zero(&On::All, work);
        self.count(&On::All);
        let is_heated = self.operator().capabilities().thermal.is_some();
        let unheated = if is_heated { f64::NEG_INFINITY } else { t };
        self.operator().add_force(unheated, u, On::All, work);
        self.divide_by_density(&On::All, work);
        let n = self.points();
        let density = |i: usize| self.density.at(i);
        for motion in &mut self.motions {
            motion.add_acceleration(t, n, work);
            motion.account(t, 0.0, n, work, None, (&density, &self.cloud));
        }
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

    fn zero(&self, on: &On<'_>, out: &mut [f64]) {
        for_each_entry(on, self.points(), out, &|_, x| *x = 0.0);
    }

    fn add_loads(&self, t: f64, on: &On<'_>, out: &mut [f64]) {
        for load in &self.loads {
            load.add_force(t, on, self.points(), self.dimension(), out);
        }
    }

    fn divide_by_density(&self, on: &On<'_>, out: &mut [f64]) {
        let n = self.points();
        match &self.density {
            PointScalar::Uniform(density) => for_each_entry(on, n, out, &|_, x| *x /= density),
            PointScalar::PerPoint(densities) => {
                for_each_entry(on, n, out, &|i, x| *x /= densities[i]);
            }
        }
    }

    /// Books the work and impulse of a step; `acceleration` are the free accelerations f/ρ of all points at its end.
    pub fn book_step(&mut self, step: &StepEnd<'_>, acceleration: &[f64]) {
        let n = self.points();
        for load in &self.loads {
            self.ledger.book_load(step, load, &self.cloud);
        }
        let density = |i: usize| self.density.at(i);
        let chord = match step.path {
            Path::Chord { u, .. } => Some([u, step.u]),
            _ => None,
        };
        for motion in &mut self.motions {
            let (work, impulse) = motion.account(
                step.t,
                step.dt,
                n,
                acceleration,
                chord,
                (&density, &self.cloud),
            );
            self.ledger.book(work, impulse);
        }
    }
}
