//! The semi-discrete equation of motion: everything an integrator steps.

use std::sync::Arc;

use rayon::prelude::*;

use crate::archive::{Archive, Saved, Values};
use crate::boundary::{Boundary, Load, PrescribedMotion};
use crate::error::{PericlesError, Result, positive};
use crate::operator::{Accepted, ForceOperator, On};
use crate::parallel::{BLOCK, ordered_sum};
use crate::space::PointCloud;

/// A number per point, stored once where all are equal.
#[derive(Debug, Clone, PartialEq)]
pub enum PointScalar {
    /// The same everywhere.
    Uniform(f64),
    /// One number per point.
    PerPoint(Vec<f64>),
}

impl PointScalar {
    /// The number of point i.
    #[inline]
    pub fn at(&self, i: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::PerPoint(values) => values[i],
        }
    }
}

/// Work and impulse of everything outside the body since the start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ledger {
    /// Work of loads and supports, J.
    pub work: f64,
    /// Sum of the magnitudes of its contributions, J: the scale of what was exchanged.
    pub exchanged: f64,
    /// Impulse of loads and supports, N s.
    pub impulse: [f64; 3],
}

impl Ledger {
    fn book(&mut self, work: f64, impulse: [f64; 3]) {
        self.work += work;
        self.exchanged += work.abs();
        for c in 0..3 {
            self.impulse[c] += impulse[c];
        }
    }
}

/// ρ u_tt = f(u) + b(t) with prescribed motions and boundaries.
///
/// Integrators call [`System::acceleration`] at stages and [`System::accept_and_accelerate`] at the end of steps; they hold no physics of their own.
pub struct System {
    cloud: Arc<PointCloud>,
    operator: Box<dyn ForceOperator>,
    density: PointScalar,
    loads: Vec<Load>,
    motions: Vec<PrescribedMotion>,
    boundaries: Vec<Box<dyn Boundary>>,
    ledger: Ledger,
}

impl System {
    /// A free body.
    ///
    /// # Errors
    /// Densities that are not positive.
    pub fn new(
        cloud: Arc<PointCloud>,
        operator: Box<dyn ForceOperator>,
        density: PointScalar,
    ) -> Result<Self> {
        match &density {
            PointScalar::Uniform(value) => {
                positive("the density", *value)?;
            }
            PointScalar::PerPoint(values) => {
                for &value in values {
                    positive("the density", value)?;
                }
            }
        }
        Ok(Self {
            cloud,
            operator,
            density,
            loads: Vec::new(),
            motions: Vec::new(),
            boundaries: Vec::new(),
            ledger: Ledger::default(),
        })
    }

    /// Adds a load.
    pub fn add_load(&mut self, load: Load) {
        self.loads.push(load);
    }

    /// Adds a boundary.
    pub fn add_boundary(&mut self, boundary: Box<dyn Boundary>) {
        self.boundaries.push(boundary);
    }

    /// Adds a prescribed motion.
    ///
    /// # Errors
    /// A point and axis whose motion is prescribed already.
    pub fn add_motion(&mut self, motion: PrescribedMotion) -> Result<()> {
        for other in &self.motions {
            for c in 0..3 {
                if motion.amplitude[c].is_none() || other.amplitude[c].is_none() {
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

    /// The points.
    pub fn cloud(&self) -> &Arc<PointCloud> {
        &self.cloud
    }

    /// The internal forces.
    pub fn operator(&self) -> &dyn ForceOperator {
        &*self.operator
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

    /// Number of points.
    pub fn points(&self) -> usize {
        self.cloud.len()
    }

    /// Dimension of the body.
    pub fn dimension(&self) -> usize {
        self.cloud.dimension()
    }

    /// Sets prescribed displacements of time t, and what boundaries set, before a force evaluation.
    pub fn constrain(&mut self, t: f64, u: &mut [f64], v: &mut [f64]) {
        let n = self.points();
        for motion in &self.motions {
            motion.place(t, n, u);
        }
        for boundary in &mut self.boundaries {
            boundary.before_force(t, u, v);
        }
    }

    /// Sets prescribed velocities of time t.
    pub fn constrain_velocity(&self, t: f64, v: &mut [f64]) {
        for motion in &self.motions {
            motion.drive(t, self.points(), v);
        }
    }

    /// Sets prescribed mean velocities of the step from t to t + dt.
    pub fn constrain_mean_velocity(&self, t: f64, dt: f64, v: &mut [f64]) {
        for motion in &self.motions {
            motion.drive_mean(t, dt, self.points(), v);
        }
    }

    /// Acceleration at a stage: internal force and loads over density; prescribed where motion is prescribed.
    pub fn acceleration(&mut self, t: f64, u: &[f64], v: &[f64], on: On<'_>, out: &mut [f64]) {
        self.zero(&on, out);
        self.operator.add_force(t, u, on.clone(), out);
        self.add_loads(t, &on, out);
        self.divide_by_density(&on, out);
        self.finish(t, u, v, out);
    }

    /// The same at the end of a step: decides breaking and books the work and impulse of the step.
    ///
    /// `accepted.mean_velocity · dt` must be the change of displacement over the step.
    pub fn accept_and_accelerate(&mut self, accepted: Accepted<'_>, v: &[f64], out: &mut [f64]) {
        self.zero(&On::All, out);
        self.operator.accept_and_force(accepted, On::All, out);
        self.add_loads(accepted.t, &On::All, out);
        self.divide_by_density(&On::All, out);
        self.book(accepted, out);
        self.finish(accepted.t, accepted.u, v, out);
    }

    /// Notes the reactions of the initial state; `acceleration` are the free accelerations f/ρ there.
    pub fn start(&mut self, t: f64, u: &[f64], v: &[f64], out: &mut [f64]) {
        self.zero(&On::All, out);
        self.operator.add_force(t, u, On::All, out);
        self.add_loads(t, &On::All, out);
        self.divide_by_density(&On::All, out);
        let rest = Accepted {
            t,
            u,
            mean_velocity: v,
            dt: 0.0,
        };
        self.book(rest, out);
        self.finish(t, u, v, out);
    }

    /// Internal force and loads at displacement u, N/m³.
    pub fn force_density_into(&self, t: f64, u: &[f64], out: &mut [f64]) {
        self.zero(&On::All, out);
        self.operator.add_force(t, u, On::All, out);
        self.add_loads(t, &On::All, out);
    }

    /// K d / ρ at displacement u, with prescribed entries held: the operator of the linearised free vibration.
    pub fn vibration_into(&self, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.operator.tangent_into(0.0, u, direction, out);
        self.divide_by_density(&On::All, out);
        out.par_chunks_mut(BLOCK)
            .for_each(|chunk| chunk.iter_mut().for_each(|x| *x = -*x));
        self.hold(out);
    }

    /// Zeros prescribed entries.
    pub fn hold(&self, vector: &mut [f64]) {
        for motion in &self.motions {
            motion.project(self.points(), vector);
        }
    }

    /// Kinetic energy, J.
    pub fn kinetic_energy(&self, v: &[f64]) -> f64 {
        let n = self.points();
        ordered_sum(n, |i| {
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
            ordered_sum(n, |i| {
                self.density.at(i) * self.cloud.volumes()[i] * v[c * n + i]
            })
        })
    }

    fn zero(&self, on: &On<'_>, out: &mut [f64]) {
        let n = self.points();
        match on {
            On::All => out.par_chunks_mut(BLOCK).for_each(|chunk| chunk.fill(0.0)),
            On::Range(range) => out
                .chunks_mut(n)
                .for_each(|component| component[range.clone()].fill(0.0)),
            On::Set(set) => {
                for component in out.chunks_mut(n) {
                    set.iter().for_each(|&i| component[i as usize] = 0.0);
                }
            }
        }
    }

    fn add_loads(&self, t: f64, on: &On<'_>, out: &mut [f64]) {
        for load in &self.loads {
            load.add_force(t, on, self.points(), self.dimension(), out);
        }
    }

    fn divide_by_density(&self, on: &On<'_>, out: &mut [f64]) {
        let n = self.points();
        match on {
            On::All => {
                for component in out.chunks_mut(n) {
                    component
                        .par_chunks_mut(BLOCK)
                        .enumerate()
                        .for_each(|(block, chunk)| {
                            for (k, x) in chunk.iter_mut().enumerate() {
                                *x /= self.density.at(block * BLOCK + k);
                            }
                        });
                }
            }
            On::Range(range) => {
                for component in out.chunks_mut(n) {
                    for i in range.clone() {
                        component[i] /= self.density.at(i);
                    }
                }
            }
            On::Set(set) => {
                for component in out.chunks_mut(n) {
                    for &i in *set {
                        component[i as usize] /= self.density.at(i as usize);
                    }
                }
            }
        }
    }

    fn book(&mut self, accepted: Accepted<'_>, acceleration: &[f64]) {
        let n = self.points();
        let Accepted {
            t,
            mean_velocity,
            dt,
            ..
        } = accepted;
        let volumes = self.cloud.volumes();
        for load in &self.loads {
            let factor = 0.5 * dt * (load.function.value(t) + load.function.value(t - dt));
            let (mut work, mut impulse) = (0.0, [0.0; 3]);
            for c in 0..self.cloud.dimension() {
                if load.density[c] == 0.0 {
                    continue;
                }
                for &i in &load.points {
                    let force = load.density[c] * volumes[i as usize];
                    work += force * mean_velocity[c * n + i as usize];
                    impulse[c] += force;
                }
            }
            self.ledger
                .book(work * factor, impulse.map(|component| component * factor));
        }
        let density = |i: usize| self.density.at(i);
        for motion in &mut self.motions {
            let (work, impulse) = motion.account(t, dt, n, acceleration, &density, volumes);
            self.ledger.book(work, impulse);
        }
    }

    fn finish(&mut self, t: f64, u: &[f64], v: &[f64], out: &mut [f64]) {
        let n = self.points();
        for motion in &self.motions {
            motion.accelerate(t, n, out);
        }
        for boundary in &mut self.boundaries {
            boundary.after_stage(t, u, v, out);
        }
    }
}

impl Saved for System {
    fn save(&self, archive: &mut Archive) {
        self.operator.save(archive);
        for (k, motion) in self.motions.iter().enumerate() {
            archive.put(
                format!("motion/{k}/reaction"),
                Values::F64(motion.reactions().to_vec()),
            );
        }
        self.boundaries
            .iter()
            .for_each(|boundary| boundary.save(archive));
        let Ledger {
            work,
            exchanged,
            impulse: [x, y, z],
        } = self.ledger;
        archive.put("ledger", Values::F64(vec![work, exchanged, x, y, z]));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        self.operator.restore(archive)?;
        for (k, motion) in self.motions.iter_mut().enumerate() {
            archive.f64_into(&format!("motion/{k}/reaction"), motion.reactions_mut())?;
        }
        for boundary in &mut self.boundaries {
            boundary.restore(archive)?;
        }
        let mut ledger = [0.0; 5];
        archive.f64_into("ledger", &mut ledger)?;
        let [work, exchanged, x, y, z] = ledger;
        self.ledger = Ledger {
            work,
            exchanged,
            impulse: [x, y, z],
        };
        Ok(())
    }
}
