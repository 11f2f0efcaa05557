//! Initial fields beyond an absorbing end.

use super::history::History;
use super::layer::NEGLIGIBLE;
use super::{AbsorbingError, LatticeStencil};
use pericles::Result;
use pericles::{Archive, Values};

/// The free motion w of the infinite lattice from the initial data beyond an end, zero in the body: the exterior's displacements are w + F * (u − w), for their difference from w starts
/// from rest there.
///
/// w is found by velocity Verlet on the sites that have data and the body's K outermost, with an absorbing end at both sides; u and v may be anything there. Ji et al. write the same as the
/// convolution of the data with the lattice's Green functions g and g', whose cost grows with the data's extent times the number of steps squared.
pub struct FreeWave {
    stencil: LatticeStencil,
    dt: f64,
    /// The body's outer points K … 1, then the exterior from ghost 0 outwards.
    u: Vec<f64>,
    /// The displacement of the next step, less the present one.
    increment: Vec<f64>,
    /// K sites before the first, the sites, K behind the last: padded by ghosts.
    padded: Vec<f64>,
    /// Towards the body, and outwards.
    histories: [Box<dyn History>; 2],
    acceleration: Vec<f64>,
}

impl FreeWave {
    /// From displacements and velocities of the exterior's sites, the one next to the body first; beyond the last they are zero. `body` are the largest |u| and |v| of
    /// the body itself. `histories` are two new ones of the end's own kernels.
    ///
    /// # Errors
    /// Fields of different lengths count as [`AbsorbingError::ExteriorData`], as do data that do not end within the sites given: the outermost K are above 1e-6 of the
    /// largest of body and exterior.
    pub fn new(
        stencil: &LatticeStencil,
        dt: f64,
        [u, v]: [&[f64]; 2],
        body: [f64; 2],
        histories: [Box<dyn History>; 2],
    ) -> std::result::Result<Self, AbsorbingError> {
        let reach = stencil.reach();
        for (field, body) in [u, v].into_iter().zip(body) {
            let largest = field.iter().fold(body, |a: f64, x| a.max(x.abs()));
            let tail = &field[field.len().saturating_sub(reach)..];
            let found = tail.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
            if u.len() != v.len() || found > NEGLIGIBLE * largest {
                let sites = field.len();
                return Err(AbsorbingError::ExteriorData {
                    sites,
                    found,
                    largest,
                });
            }
        }
        let sites = reach + u.len().max(reach);
        let padded = |field: &[f64]| {
            let mut all = vec![0.0; sites];
            all[reach..reach + field.len()].copy_from_slice(field);
            all
        };
        let mut wave = Self {
            stencil: stencil.clone(),
            dt,
            u: padded(u),
            increment: padded(v),
            padded: vec![0.0; sites + 2 * reach],
            histories,
            acceleration: vec![0.0; sites],
        };
        wave.accelerate(0.5);
        for (d, a) in wave.increment.iter_mut().zip(&wave.acceleration) {
            *d = dt * *d + 0.5 * dt * dt * a;
        }
        Ok(wave)
    }

    /// Goes on by one step.
    pub(super) fn step(&mut self) {
        for (u, d) in self.u.iter_mut().zip(&self.increment) {
            *u += d;
        }
        self.accelerate(1.0);
        let square = self.dt * self.dt;
        for (d, a) in self.increment.iter_mut().zip(&self.acceleration) {
            *d += square * a;
        }
    }

    /// The present displacements of the body's outer points 1 … K, and of the ghosts.
    pub(super) fn outer(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let (own, beyond) = self.u.split_at(self.stencil.reach());
        own.iter()
            .rev()
            .zip(beyond)
            .map(|(own, ghost)| (*own, *ghost))
    }

    /// The accelerations of the present, which goes into the histories with this weight.
    fn accelerate(&mut self, weight: f64) {
        let (reach, sites) = (self.stencil.reach(), self.u.len());
        self.padded[reach..reach + sites].copy_from_slice(&self.u);
        let [inner, outer] = &mut self.histories;
        let (mut own, mut ghosts) = (vec![0.0; reach], vec![0.0; reach]);
        for (history, at) in [(inner, None), (outer, Some(sites - 1))] {
            // The site at a distance from this end, within; those beyond are at 1 and farther.
            let place = |depth: usize| reach + at.map_or(depth, |last| last - depth);
            let beyond = |n: usize| at.map_or(reach - 1 - n, |last| reach + last + 1 + n);
            history.ghosts_into(&mut ghosts);
            for (depth, own) in own.iter_mut().enumerate() {
                *own = weight * self.padded[place(depth)];
            }
            for (n, ghost) in ghosts.iter().enumerate() {
                self.padded[beyond(n)] = *ghost;
            }
            history.push(&own, &ghosts);
        }
        for (s, a) in self.acceleration.iter_mut().enumerate() {
            let here = reach + s;
            let bonds = self.stencil.weights().iter().enumerate();
            *a = bonds
                .map(|(k, weight)| {
                    let k = k + 1;
                    let both = self.padded[here + k] + self.padded[here - k];
                    weight * (both - 2.0 * self.padded[here])
                })
                .sum();
        }
    }

    pub(super) fn save(&self, name: &str, archive: &mut Archive) {
        archive.put(format!("{name}/free/u"), Values::F64(self.u.clone()));
        let increment = Values::F64(self.increment.clone());
        archive.put(format!("{name}/free/increment"), increment);
        for (history, side) in self.histories.iter().zip(["inner", "outer"]) {
            history.save(&format!("{name}/free/{side}"), archive);
        }
    }

    pub(super) fn restore(&mut self, name: &str, archive: &Archive) -> Result<()> {
        archive.f64_into(&format!("{name}/free/u"), &mut self.u)?;
        archive.f64_into(&format!("{name}/free/increment"), &mut self.increment)?;
        for (history, side) in self.histories.iter_mut().zip(["inner", "outer"]) {
            history.restore(&format!("{name}/free/{side}"), archive)?;
        }
        Ok(())
    }
}
