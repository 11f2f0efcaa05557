//! Green-strain law on a ring by a pseudo-spectral method.

use std::f64::consts::TAU;
use std::sync::Arc;

use rayon::prelude::*;
use rustfft::num_complex::Complex;

use super::super::fourier::LineTransform;
use super::super::wanted::for_each_wanted;
use super::super::{features_of, reject, require};
use super::symbol::Symbol;
use crate::form::ForceForm;
use pericles::Result;
use pericles::kernel::ActsOn;
use pericles::material::{BondConstants, BondMaterial, PairLaw};
use pericles::operator::pool::Pool;
use pericles::operator::{Capabilities, Force, InstructionSet, PointSubset};
use pericles::space::PointCloud;
use pericles::sum::sum;

/// Force density (N/m³) f = ∫ a (2ξ²η + 3ξη² + η³) dξ, a = cα/(2|ξ|³), of
/// [`GreenBond`](pericles::material::GreenBond) on a periodic bar.
///
/// With the convolutions L, B, D of symbols −M(k), 3ic ∫ α/r² sin kr dr and −c ∫ α/r³ (1 − cos kr) dr (times the
/// area, over 0 … δ) the force is Lu + [B u² − 2u Bu] + [D u³ − 3u D u² + 3u² D u]: transforms and products, O(n
/// log n) for any horizon. Products are formed on twice as many points and truncated, so that the result has no
/// aliases; the operator is then the gradient of an energy, −Σ V u (½ f₁ + ⅓ f₂ + ¼ f₃). The highest wavenumber of
/// an even number of points does not enter the nonlinear terms.
///
/// The integrals exist for influence functions that act on the displacement. Energy densities belong to the sum
/// above; only their total equals the energy of the bonds.
pub struct SpectralCubicForce {
    cloud: Arc<PointCloud>,
    coarse: LineTransform,
    fine: LineTransform,
    /// M on the coarse modes.
    linear: Vec<f64>,
    /// Imaginary symbol of B and symbol of D on the fine modes.
    odd: Vec<f64>,
    even: Vec<f64>,
    family: f64,
    work: Pool<Work>,
}

struct Work {
    scratch: Vec<Complex<f64>>,
    line: Vec<f64>,
    coarse: Vec<Complex<f64>>,
    spectrum: Vec<Complex<f64>>,
    sum: Vec<Complex<f64>>,
    /// u, d, B u, D u, D u², B d, D d, D 2ud on the fine points.
    fields: [Vec<f64>; 8],
    product: Vec<f64>,
    force: Vec<f64>,
}

const U: usize = 0;
const DIRECTION: usize = 1;
const ODD_U: usize = 2;
const EVEN_U: usize = 3;
const EVEN_SQUARE: usize = 4;
const ODD_DIRECTION: usize = 5;
const EVEN_DIRECTION: usize = 6;
const EVEN_CROSS: usize = 7;

impl SpectralCubicForce {
    /// Creates the operator of a material on a ring.
    ///
    /// # Errors
    /// Unsupported cases, with the reason: other bodies, another law, functions that act on the stretch, breaking.
    pub fn new(
        cloud: Arc<PointCloud>,
        material: &BondMaterial,
        constants: &BondConstants,
    ) -> Result<Self> {
        if material.law != PairLaw::GreenStrain || cloud.dimension() != 1 || !cloud.is_periodic() {
            return reject(
                "nonlinear forces by Fourier series are available for model = \"green-strain\" on a periodic bar only",
            );
        }
        if material.influence.acts_on != ActsOn::Displacement {
            return reject(
                "an influence function that acts on the stretch is not available with Fourier series of nonlinear \
                forces; use acts_on = \"displacement\"",
            );
        }
        require(ForceForm::Spectral, features_of(material, constants, 1))?;
        let symbol = Symbol::new(
            1,
            cloud.section(),
            constants.micromodulus,
            &material.influence,
            material.horizon,
        )?;
        let n = cloud.len();
        let (coarse, fine) = (LineTransform::new(n), LineTransform::new(2 * n));
        let unit = TAU / (n as f64 * cloud.spacing());
        let on = |modes: usize, value: &(dyn Fn(f64) -> f64 + Sync)| -> Vec<f64> {
            let all = (0..modes).into_par_iter();
            all.map(|m| value(unit * m as f64)).collect()
        };
        let linear = on(coarse.modes(), &|k| symbol.at(k)[0]);
        let odd = on(fine.modes(), &|k| {
            symbol.radial(k, |r, alpha| 3.0 * alpha / (r * r) * (k * r).sin())
        });
        let even = on(fine.modes(), &|k| {
            symbol.radial(k, |r, alpha| {
                -2.0 * alpha / r.powi(3) * (0.5 * k * r).sin().powi(2)
            })
        });
        if [&linear, &odd, &even]
            .into_iter()
            .flatten()
            .any(|x| !x.is_finite())
        {
            return reject("the symbol must be finite; check the influence function");
        }
        let scratch = coarse.scratch().len().max(fine.scratch().len());
        let (coarse_modes, fine_modes) = (coarse.modes(), fine.modes());
        Ok(Self {
            family: 2.0 * material.horizon / cloud.spacing(),
            work: Pool::new(1, move || Work {
                scratch: vec![Complex::default(); scratch],
                line: vec![0.0; n],
                coarse: vec![Complex::default(); coarse_modes],
                spectrum: vec![Complex::default(); fine_modes],
                sum: vec![Complex::default(); fine_modes],
                fields: std::array::from_fn(|_| vec![0.0; 2 * n]),
                product: vec![0.0; 2 * n],
                force: vec![0.0; n],
            }),
            cloud,
            coarse,
            fine,
            linear,
            odd,
            even,
        })
    }

    /// Number of modes below the highest one of an even number.
    fn resolved(&self) -> usize {
        self.coarse.len().div_ceil(2)
    }

    /// Replaces `work.line` by its spectrum, in `work.coarse`, divided by the number of points.
    fn analyse(&self, work: &mut Work) {
        self.coarse
            .forward(&mut work.line, &mut work.coarse, &mut work.scratch);
        let factor = 1.0 / self.coarse.len() as f64;
        work.coarse.iter_mut().for_each(|mode| *mode *= factor);
    }

    /// Computes a field on the fine points from `work.coarse` and a factor for every mode.
    fn refine(&self, place: usize, symbol: impl Fn(usize) -> Complex<f64>, work: &mut Work) {
        work.spectrum.fill(Complex::default());
        for m in 0..self.resolved() {
            work.spectrum[m] = work.coarse[m] * symbol(m);
        }
        self.fine.inverse(
            &mut work.spectrum,
            &mut work.fields[place],
            &mut work.scratch,
        );
    }

    /// Computes the spectrum of `work.product`, in `work.spectrum`, divided by the number of points.
    fn analyse_product(&self, work: &mut Work) {
        self.fine
            .forward(&mut work.product, &mut work.spectrum, &mut work.scratch);
        let factor = 1.0 / self.fine.len() as f64;
        work.spectrum.iter_mut().for_each(|mode| *mode *= factor);
    }

    /// Adds weight · symbol · the spectrum of the product `value(i, fields)` to `work.sum` and, if requested, D of
    /// it to a field.
    fn gather(
        &self,
        value: impl Fn(usize, &[Vec<f64>; 8]) -> f64,
        symbol: impl Fn(usize) -> Complex<f64>,
        even_in: Option<usize>,
        work: &mut Work,
    ) {
        for i in 0..self.fine.len() {
            work.product[i] = value(i, &work.fields);
        }
        self.analyse_product(work);
        for (m, (sum, mode)) in work.sum.iter_mut().zip(&work.spectrum).enumerate() {
            *sum += mode * symbol(m);
        }
        if let Some(place) = even_in {
            for (mode, even) in work.spectrum.iter_mut().zip(&self.even) {
                *mode *= *even;
            }
            self.fine.inverse(
                &mut work.spectrum,
                &mut work.fields[place],
                &mut work.scratch,
            );
        }
    }

    /// Computes the fields of u, and `work.sum` with weight · M û.
    fn load(&self, u: &[f64], weight: f64, work: &mut Work) {
        let origin = u[u.len() / 2];
        for (line, u) in work.line.iter_mut().zip(u) {
            *line = u - origin;
        }
        self.analyse(work);
        work.sum.fill(Complex::default());
        for m in 0..self.coarse.modes() {
            work.sum[m] = work.coarse[m] * (-weight * self.linear[m]);
        }
        self.refine(U, |_| Complex::new(1.0, 0.0), work);
        self.refine(ODD_U, |m| Complex::new(0.0, self.odd[m]), work);
        self.refine(EVEN_U, |m| Complex::new(self.even[m], 0.0), work);
    }

    /// Computes the line of `work.sum`, in `work.force`; linear terms include the highest mode, products do not.
    fn collect(&self, top: Complex<f64>, work: &mut Work) {
        let modes = self.coarse.modes();
        work.coarse.copy_from_slice(&work.sum[..modes]);
        if self.resolved() < modes {
            work.coarse[modes - 1] = top;
        }
        self.coarse
            .inverse(&mut work.coarse, &mut work.force, &mut work.scratch);
    }

    /// Computes w₁ f₁ + w₂ f₂ + w₃ f₃, in `work.force`.
    fn terms(&self, u: &[f64], [one, two, three]: [f64; 3], work: &mut Work) {
        self.load(u, one, work);
        let top = work.sum[self.coarse.modes() - 1];
        let square = |i: usize, f: &[Vec<f64>; 8]| f[U][i] * f[U][i];
        let odd = |m: usize| Complex::new(0.0, two * self.odd[m]);
        self.gather(square, odd, Some(EVEN_SQUARE), work);
        let cube = |i: usize, f: &[Vec<f64>; 8]| f[U][i].powi(3);
        self.gather(
            cube,
            |m| Complex::new(three * self.even[m], 0.0),
            None,
            work,
        );
        let mixed = |i: usize, f: &[Vec<f64>; 8]| {
            let u = f[U][i];
            u * (3.0 * three * (u * f[EVEN_U][i] - f[EVEN_SQUARE][i]) - 2.0 * two * f[ODD_U][i])
        };
        self.gather(mixed, |_| Complex::new(1.0, 0.0), None, work);
        self.collect(top, work);
    }

    /// Computes the directional derivative, in `work.force`.
    fn derivative(&self, u: &[f64], direction: &[f64], work: &mut Work) {
        self.load(u, 0.0, work);
        let origin = direction[direction.len() / 2];
        for (line, d) in work.line.iter_mut().zip(direction) {
            *line = d - origin;
        }
        self.analyse(work);
        for m in 0..self.coarse.modes() {
            work.sum[m] = work.coarse[m] * -self.linear[m];
        }
        let top = work.sum[self.coarse.modes() - 1];
        self.refine(DIRECTION, |_| Complex::new(1.0, 0.0), work);
        self.refine(ODD_DIRECTION, |m| Complex::new(0.0, self.odd[m]), work);
        self.refine(EVEN_DIRECTION, |m| Complex::new(self.even[m], 0.0), work);
        let none = |_: usize| Complex::new(0.0, 0.0);
        let square = |i: usize, f: &[Vec<f64>; 8]| f[U][i] * f[U][i];
        self.gather(square, none, Some(EVEN_SQUARE), work);
        let cross = |i: usize, f: &[Vec<f64>; 8]| 2.0 * f[U][i] * f[DIRECTION][i];
        let odd = |m: usize| Complex::new(0.0, self.odd[m]);
        self.gather(cross, odd, Some(EVEN_CROSS), work);
        let cube = |i: usize, f: &[Vec<f64>; 8]| 3.0 * f[U][i] * f[U][i] * f[DIRECTION][i];
        self.gather(cube, |m| Complex::new(self.even[m], 0.0), None, work);
        let mixed = |i: usize, f: &[Vec<f64>; 8]| {
            let (u, d) = (f[U][i], f[DIRECTION][i]);
            let quadratic = -2.0 * (d * f[ODD_U][i] + u * f[ODD_DIRECTION][i]);
            let cubic = 6.0 * u * d * f[EVEN_U][i] + 3.0 * u * u * f[EVEN_DIRECTION][i]
                - 3.0 * d * f[EVEN_SQUARE][i]
                - 3.0 * u * f[EVEN_CROSS][i];
            quadratic + cubic
        };
        self.gather(mixed, |_| Complex::new(1.0, 0.0), None, work);
        self.collect(top, work);
    }
}

/// Weights of the three terms in the energy.
const ENERGY: [f64; 3] = [1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0];

impl Force for SpectralCubicForce {
    fn points(&self) -> usize {
        self.cloud.len()
    }

    fn dimension(&self) -> usize {
        1
    }

    fn add_force(&self, _t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        let mut work = self.work.take();
        self.terms(u, [1.0; 3], &mut work);
        for_each_wanted(&on, 0..u.len(), |points| {
            for (out, force) in out[points.clone()].iter_mut().zip(&work.force[points]) {
                *out += force;
            }
        });
    }

    fn add_energy_density(&self, _t: f64, u: &[f64], out: &mut [f64]) {
        let origin = u[u.len() / 2];
        let mut work = self.work.take();
        self.terms(u, ENERGY, &mut work);
        for ((out, force), u) in out.iter_mut().zip(&work.force).zip(u) {
            *out -= force * (u - origin);
        }
    }

    fn energy(&self, _t: f64, u: &[f64]) -> f64 {
        let origin = u[u.len() / 2];
        let mut work = self.work.take();
        self.terms(u, ENERGY, &mut work);
        let (force, volumes) = (&work.force, self.cloud.volumes());
        -sum(u.len(), |i| volumes[i] * force[i] * (u[i] - origin))
    }

    /// Largest ω of all plane waves about the reference configuration, for the smallest density.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let least = (0..self.points())
            .map(density)
            .fold(f64::INFINITY, f64::min);
        let largest = self.linear.iter().fold(0.0f64, |m, x| m.max(*x));
        (largest / least * (1.0 + 1e-12)).sqrt()
    }

    fn tangent_into(&self, _t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        let mut work = self.work.take();
        self.derivative(u, direction, &mut work);
        out.copy_from_slice(&work.force);
    }

    /// Approximate number of cells within the horizon of all points; no loop runs over them.
    fn directed_bonds(&self) -> u64 {
        (self.family * self.points() as f64) as u64
    }

    fn bytes(&self) -> usize {
        let numbers = self.linear.len() + self.odd.len() + self.even.len();
        (numbers + 28 * self.points()) * size_of::<f64>()
    }

    fn instruction_set(&self) -> InstructionSet {
        InstructionSet::detect()
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities::default()
    }
}

pericles::saved! {
    impl Checkpointed for SpectralCubicForce {
        cloud, coarse, fine, linear, odd, even, family: fixed,
        work: scratch,
    }
}
