//! Initial fields beyond an absorbing boundary.

use super::history::History;
use super::layer::NEGLIGIBLE;
use super::{AbsorbingError, LatticeStencil};
use pericles::sum::max_norm;

/// Free motion w of the infinite lattice due to the initial data beyond the boundary (zero in the body). The
/// exterior displacements are w + F * (u − w), because their difference from w starts from rest.
///
/// w is integrated by velocity Verlet on the sites that have data and the body's K outermost points, with an
/// absorbing boundary at both sides; u and v are arbitrary there. Ji et al. write w as the convolution of the data
/// with the lattice's Green functions g and g', whose cost is proportional to the number of data sites times the
/// number of steps squared.
pub struct FreeWave {
    stencil: LatticeStencil,
    dt: f64,
    /// The body's outer points K … 1, then the exterior from ghost 0 outwards.
    u: Vec<f64>,
    /// Displacement of the next step minus that of the current one.
    increment: Vec<f64>,
    /// Sites padded by K ghosts on both sides.
    padded: Vec<f64>,
    /// History of the boundary towards the body.
    inner: Box<dyn History>,
    /// History of the outer boundary.
    outer: Box<dyn History>,
    acceleration: Vec<f64>,
}

impl FreeWave {
    /// Creates the free motion from displacements and velocities of the exterior sites, the one next to the body
    /// first; they are zero beyond the last. `body` contains the largest |u| and |v| of the body itself. The last
    /// two arguments are new histories with the kernels of the boundary.
    ///
    /// # Errors
    /// [`AbsorbingError::ExteriorData`] for fields of different lengths and for data that do not decay within the
    /// given sites: the outermost K values exceed 1e-6 of the largest in body and exterior.
    pub fn new(
        stencil: &LatticeStencil,
        dt: f64,
        [u, v]: [&[f64]; 2],
        body: [f64; 2],
        [inner, outer]: [Box<dyn History>; 2],
    ) -> std::result::Result<Self, AbsorbingError> {
        let reach = stencil.reach();
        for (field, body) in [u, v].into_iter().zip(body) {
            let largest = body.max(max_norm(field));
            let tail = &field[field.len().saturating_sub(reach)..];
            let found = max_norm(tail);
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
            inner,
            outer,
            acceleration: vec![0.0; sites],
        };
        wave.accelerate(0.5);
        for (d, a) in wave.increment.iter_mut().zip(&wave.acceleration) {
            *d = dt * *d + 0.5 * dt * dt * a;
        }
        Ok(wave)
    }

    /// Advances by one step.
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

    /// Current displacements of the body's outer points 1 … K and of the ghosts.
    pub(super) fn outer(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let (own, beyond) = self.u.split_at(self.stencil.reach());
        own.iter()
            .rev()
            .zip(beyond)
            .map(|(own, ghost)| (*own, *ghost))
    }

    /// Computes the current accelerations and appends the current state to the histories with this weight.
    fn accelerate(&mut self, weight: f64) {
        let (reach, sites) = (self.stencil.reach(), self.u.len());
        self.padded[reach..reach + sites].copy_from_slice(&self.u);
        let (mut own, mut ghosts) = (vec![0.0; reach], vec![0.0; reach]);
        let ends = [(&mut self.inner, None), (&mut self.outer, Some(sites - 1))];
        for (history, at) in ends {
            // Index of the site at a depth within this end; ghosts beyond the end are indexed by `beyond`.
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
}

pericles::saved! {
    impl SavedUnder(name) for FreeWave {
        u: array("{name}/free/u"),
        increment: array("{name}/free/increment"),
        inner: under("{name}/free/inner"),
        outer: under("{name}/free/outer"),
        stencil, dt: fixed,
        padded, acceleration: scratch,
    }
}
