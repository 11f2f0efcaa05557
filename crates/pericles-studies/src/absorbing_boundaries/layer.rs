//! Reflection of damping layers by angle and wavelength.
//!
//! A plane wave of a plate repeats along y up to a phase, u(x, y) = u(x) exp(i k_y y), so a chain of nodes along x
//! represents the plate: bonds to the rows above and below contain the phase. With u_y = i w the equations for
//! (u_x, w) are real. A longitudinal packet that travels in one direction only, composed of the chain's own waves,
//! reaches the layer and the fixed edge behind it. The energy that remains when it has returned, divided by that of
//! the packet, is the square of the reflection coefficient, including converted waves.

use std::f64::consts::{PI, TAU};

use pericles::boundary::DampingProfile;
use pericles_run::RunError;

use crate::data::{Case, Found};

/// Bonds extend over three spacings; lengths are in spacings, times in units of spacing over longitudinal wave
/// speed.
const REACH: isize = 3;
const DT: f64 = 0.5;
/// Depth of the layer.
const THICKNESS: f64 = 60.0;
/// Design reflection of the amplitude at normal incidence.
const ASKED: f64 = 1e-3;

/// Symmetric 2 × 2 matrix: xx, xy, yy.
type Tensor = [f64; 3];

struct Bond {
    offset: [f64; 2],
    tensor: Tensor,
}

/// Bonds of a node of the plate, k ξ⊗ξ/|ξ|³, scaled to unit longitudinal speed.
fn bonds() -> Vec<Bond> {
    let mut bonds = Vec::new();
    for p in -REACH..=REACH {
        for q in -REACH..=REACH {
            let square = p * p + q * q;
            if square > 0 && square <= REACH * REACH {
                let [x, y] = [p as f64, q as f64];
                let scale = (square as f64).powf(-1.5);
                let tensor = [x * x, x * y, y * y].map(|t| scale * t);
                let offset = [x, y];
                bonds.push(Bond { offset, tensor });
            }
        }
    }
    // ω² = ½ Σ k_xx p² θ² of long waves along x.
    let stiffness = |bond: &Bond| 0.5 * bond.tensor[0] * bond.offset[0].powi(2);
    let square: f64 = bonds.iter().map(stiffness).sum();
    for bond in &mut bonds {
        bond.tensor = bond.tensor.map(|t| t / square);
    }
    bonds
}

/// Frequency and polarisation of the fast wave with these wavenumbers.
fn longitudinal(bonds: &[Bond], [kx, ky]: [f64; 2]) -> (f64, [f64; 2]) {
    let mut d = [0.0; 3];
    for Bond { offset, tensor } in bonds {
        let share = 1.0 - (kx * offset[0] + ky * offset[1]).cos();
        for (d, t) in d.iter_mut().zip(tensor) {
            *d += share * t;
        }
    }
    let (mean, half) = (0.5 * (d[0] + d[2]), 0.5 * (d[0] - d[2]));
    let angle = 0.5 * d[1].atan2(half);
    let omega = (mean + half.hypot(d[1])).sqrt();
    (omega, [angle.cos(), angle.sin()])
}

/// Nodes along x of a plate with waves exp(i k_y y); fixed beyond both ends.
struct Chain {
    /// For p = −3 … 3: Σ_q k cos(k_y q) for xx and yy, Σ_q k sin(k_y q) for xy.
    coupling: Vec<Tensor>,
    /// Σ k over all bonds; xy vanishes.
    own: Tensor,
    damping: Vec<f64>,
    /// (u_x, w) of each node.
    u: Vec<[f64; 2]>,
    /// dt v at the middle of the last step.
    increment: Vec<[f64; 2]>,
}

impl Chain {
    /// Creates a packet of waves around (k_x, k_y) that travels towards the layer at the right end.
    fn new(bonds: &[Bond], [kx, ky]: [f64; 2]) -> Self {
        // Width of the packet; its relative spectral width is about 8 %.
        let width = 1.5 * TAU / kx;
        let centre = 4.0 * width;
        let nodes = (2.0 * centre + THICKNESS) as usize;
        let mut coupling = vec![[0.0; 3]; 2 * REACH as usize + 1];
        let mut own = [0.0; 3];
        for Bond { offset, tensor } in bonds {
            let (sine, cosine) = (ky * offset[1]).sin_cos();
            let at = &mut coupling[(offset[0] + REACH as f64) as usize];
            for (k, factor) in [cosine, sine, cosine].into_iter().enumerate() {
                at[k] += factor * tensor[k];
                own[k] += tensor[k];
            }
        }
        let profile = DampingProfile::of_reflection(THICKNESS, ASKED, 2.0, 1.0);
        let depth = |i: usize| i as f64 + 0.5 - (nodes as f64 - THICKNESS);
        let mut chain = Self {
            coupling,
            own,
            damping: (0..nodes).map(|i| profile.at(depth(i))).collect(),
            u: vec![[0.0; 2]; nodes],
            increment: vec![[0.0; 2]; nodes],
        };
        // Waves that fit into twice the chain, Gaussian about k_x.
        let spacing = PI / nodes as f64;
        let spread = 1.0 / width;
        let first = ((kx - 5.0 * spread) / spacing).max(1.0) as usize;
        for n in first..=((kx + 5.0 * spread) / spacing) as usize {
            let k = n as f64 * spacing;
            let amplitude = (-0.5 * ((k - kx) / spread).powi(2)).exp();
            let (omega, direction) = longitudinal(bonds, [k, ky]);
            // Numerical frequency of the scheme.
            let turn = 2.0 * (0.5 * omega * DT).asin();
            for i in 0..nodes {
                let phase = k * (i as f64 - centre);
                let parts = [f64::cos, f64::sin];
                for c in 0..2 {
                    let scale = amplitude * direction[c];
                    let now = scale * parts[c](phase);
                    chain.u[i][c] += now;
                    chain.increment[i][c] += now - scale * parts[c](phase + turn);
                }
            }
        }
        chain
    }

    fn acceleration(&self, i: usize) -> [f64; 2] {
        let mut a = [-self.own[0] * self.u[i][0], -self.own[2] * self.u[i][1]];
        for (k, [xx, xy, yy]) in self.coupling.iter().enumerate() {
            let place = (i + k).checked_sub(REACH as usize);
            let Some([x, w]) = place.and_then(|j| self.u.get(j)) else {
                continue;
            };
            a[0] += xx * x - xy * w;
            a[1] += xy * x + yy * w;
        }
        a
    }

    /// Performs a step of velocity Verlet with the damping of the previous step.
    fn step(&mut self) {
        let accelerations: Vec<[f64; 2]> =
            (0..self.u.len()).map(|i| self.acceleration(i)).collect();
        for (i, a) in accelerations.iter().enumerate() {
            for c in 0..2 {
                let increment = &mut self.increment[i][c];
                *increment += DT * DT * a[c] - self.damping[i] * DT * *increment;
                self.u[i][c] += *increment;
            }
        }
    }

    /// Energy that the scheme conserves without damping: ½ |d/dt|² − ½ u·A u', with u' the previous displacement.
    fn energy(&self) -> f64 {
        let node = |i: usize| -> f64 {
            let a = self.acceleration(i);
            (0..2)
                .map(|c| {
                    let d = self.increment[i][c];
                    0.5 * (d / DT).powi(2) - 0.5 * a[c] * (self.u[i][c] - d)
                })
                .sum()
        };
        (0..self.u.len()).map(node).sum()
    }
}

/// Fraction of the amplitude reflected for a wave of this length at this angle.
fn reflection(bonds: &[Bond], length: f64, degrees: f64) -> f64 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let wave = [cosine, sine].map(|part| part * TAU / length);
    let mut chain = Chain::new(bonds, wave);
    let before = chain.energy();
    // To the edge and back to the start, at the speed of long waves.
    let way = 2.0 * (chain.u.len() as f64 - 6.0 * TAU / wave[0]);
    let steps = (way / (cosine * DT)) as usize;
    for _ in 0..steps {
        chain.step();
    }
    (chain.energy() / before).max(0.0).sqrt()
}

/// Reflection of a layer of the case's depth in wavelengths, computed once per study.
fn of_depth(case: &Case<'_>, degrees: f64) -> Result<f64, RunError> {
    let length = THICKNESS / case.number("depth")?;
    let share = || Ok(reflection(&bonds(), length, degrees));
    case.once(format!("{length} {degrees}"), share)
        .map(|share| *share)
}

/// Reflected fraction at an angle, degrees from the normal.
pub(super) fn reflected(case: &Case<'_>) -> Result<Found, RunError> {
    Ok(of_depth(case, case.number("angle")?)?.into())
}

/// Reflected fractions at several angles.
pub(super) fn of_angles(case: &Case<'_>) -> Result<Found, RunError> {
    let angles = case.numbers("angles")?;
    let shares = angles.iter().map(|&degrees| of_depth(case, degrees));
    let shares = shares.collect::<Result<Vec<f64>, _>>()?;
    Ok(Found::default().curve("reflection", &angles, &shares))
}
