//! Force operator of a linear body on a periodic box.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use rayon::prelude::*;
use rustfft::num_complex::Complex;

use super::super::energy::{add_density, elastic_energy, origin};
use super::super::tensor_kernel::pairs;
use super::super::wanted::for_each_wanted;
use super::super::{features_of, reject, require};
use super::box_transform::BoxTransform;
use super::symbol::Symbol;
use crate::form::{ForceForm, LINEAR_ONLY};
use pericles::material::{BondConstants, BondMaterial, PairLaw};
use pericles::operator::pool::Pool;
use pericles::operator::{
    Capabilities, Diagonal, Force, FunctionOf, InstructionSet, LinearOperator, Linearity,
    PointSubset,
};
use pericles::parallel::{components, components_mut};
use pericles::space::PointCloud;
use pericles::{PericlesError, Result};

/// Force density (N/m³) f(x) = Σ_k −M(k) û(k) exp(ik·x) of the linear bond-based law on a periodic box, with the
/// symbol M of the continuum.
///
/// The period along each axis is the number of cells times the spacing. At the highest wavenumber of an even number
/// of cells, where exp(ikx) and exp(−ikx) are equal on the grid, M is the mean of both. All points are computed for
/// any requested subset; a rigid translation gives exactly zero.
pub struct SpectralForce<const D: usize> {
    cloud: Arc<PointCloud>,
    transform: BoxTransform,
    /// 2π divided by the period of each axis, rad/m.
    unit: [f64; D],
    /// M_p and M_s for each wave vector.
    symbol: Vec<[f64; 2]>,
    largest: f64,
    family: f64,
    spectra: Pool<Vec<Vec<Complex<f64>>>>,
    fields: Pool<Vec<f64>>,
}

impl<const D: usize> SpectralForce<D> {
    /// Creates the operator of a material on a box of cells.
    ///
    /// # Errors
    /// Unsupported cases, with the reason: points that are not a full box, a nonlinear pair law, breaking, an
    /// influence function that belongs to a grid.
    pub fn new(
        cloud: Arc<PointCloud>,
        material: &BondMaterial,
        constants: &BondConstants,
    ) -> Result<Self> {
        if material.law != PairLaw::Linear {
            return reject(LINEAR_ONLY);
        }
        require(ForceForm::Spectral, features_of(material, constants, D))?;
        let symbol = Symbol::new(
            D,
            cloud.section(),
            constants.micromodulus,
            &material.influence,
            material.horizon,
        )?;
        // Number of cells in a horizon, for reports.
        let ball = [2.0, PI, 4.0 / 3.0 * PI][D - 1];
        let family = ball * (material.horizon / cloud.spacing()).powi(D as i32);
        let mut force = Self::with_symbol(cloud, |k| symbol.at(k))?;
        force.family = family;
        Ok(force)
    }

    /// Creates an operator with M_p and M_s (N/m⁴) given as functions of |k| (rad/m); bars use M_p.
    ///
    /// # Errors
    /// Points that are not a full box of cells, or of another dimension; values that are not finite.
    pub fn with_symbol(
        cloud: Arc<PointCloud>,
        symbol_of: impl Fn(f64) -> [f64; 2] + Sync,
    ) -> Result<Self> {
        if cloud.dimension() != D {
            return Err(PericlesError::WrongDimension {
                what: "a spectral operator of this type",
                needed: ["1", "2", "3"][D - 1],
                dimension: cloud.dimension(),
            });
        }
        let (shape, sides) = match cloud.lattice() {
            Some(lattice) if lattice.shape.iter().product::<usize>() == cloud.len() => {
                (lattice.shape, lattice.sides())
            }
            _ => {
                return reject(
                    "a Fourier series needs a full box of cells (bar, plate or block without holes)",
                );
            }
        };
        let transform = BoxTransform::new(D, shape);
        let n = cloud.len();
        let modes = transform.len();
        let mut force = Self {
            unit: std::array::from_fn(|axis| TAU / sides[axis]),
            symbol: Vec::new(),
            largest: 0.0,
            family: n as f64,
            spectra: Pool::new(1, move || vec![vec![Complex::default(); modes]; D + 1]),
            fields: Pool::new(1, move || vec![0.0; D * n]),
            transform,
            cloud,
        };
        force.tabulate(symbol_of)?;
        Ok(force)
    }

    /// Evaluates the symbol once for every length of a wave vector.
    fn tabulate(&mut self, symbol_of: impl Fn(f64) -> [f64; 2] + Sync) -> Result<()> {
        let size = |mode: usize| {
            let (k, _) = self.wave(mode);
            k.iter().map(|k| k * k).sum::<f64>().sqrt()
        };
        let sizes: Vec<f64> = (0..self.transform.len())
            .into_par_iter()
            .map(size)
            .collect();
        let mut distinct: Vec<u64> = sizes.iter().map(|size| size.to_bits()).collect();
        distinct.sort_unstable();
        distinct.dedup();
        let values: HashMap<u64, [f64; 2]> = distinct
            .into_par_iter()
            .map(|bits| (bits, symbol_of(f64::from_bits(bits))))
            .collect();
        self.symbol = sizes.iter().map(|size| values[&size.to_bits()]).collect();
        let all = || self.symbol.iter().flatten();
        if all().any(|value| !value.is_finite()) {
            return reject("the symbol must be finite; check the influence function");
        }
        self.largest = all().fold(0.0f64, |largest, value| largest.max(*value));
        Ok(())
    }

    /// Returns the wave vector of an entry of a spectrum, rad/m, and which of its components are at the highest
    /// wavenumber of an even number of cells.
    fn wave(&self, mode: usize) -> ([f64; D], [bool; D]) {
        let nodes = self.transform.nodes();
        let [along_x, _, last] = self.transform.modes();
        let place = [mode / last % along_x, mode / last / along_x, mode % last];
        let mut k = [0.0; D];
        let mut top = [false; D];
        for axis in 0..D {
            let which = if D == 2 && axis == 1 { 2 } else { axis };
            let (m, n) = (place[which], nodes[which]);
            top[axis] = 2 * m == n;
            let signed = if 2 * m > n {
                m as f64 - n as f64
            } else {
                m as f64
            };
            k[axis] = self.unit[axis] * signed;
        }
        (k, top)
    }

    /// Applies g(M) to û at one wave vector.
    fn act(&self, mode: usize, g: &impl Fn(f64) -> f64, u: [Complex<f64>; D]) -> [Complex<f64>; D] {
        let [pressure, shear] = self.symbol[mode];
        if D == 1 {
            let factor = g(pressure);
            return u.map(|u| u * factor);
        }
        let (k, top) = self.wave(mode);
        let square: f64 = k.iter().map(|k| k * k).sum();
        if square == 0.0 {
            let factor = g(0.0);
            return u.map(|u| u * factor);
        }
        // Axes at the highest wavenumber do not couple, because ±k cancel; the others have one longitudinal
        // direction and the rest are transverse.
        let value = |part: f64| shear + (pressure - shear) * part / square;
        let free = |axis: usize| if top[axis] { 0.0 } else { k[axis] };
        let part: f64 = (0..D).map(|axis| free(axis).powi(2)).sum();
        let across = g(shear);
        let along = if part > 0.0 {
            let dot: Complex<f64> = (0..D).map(|axis| u[axis] * free(axis)).sum();
            dot * ((g(value(part)) - across) / part)
        } else {
            Complex::default()
        };
        std::array::from_fn(|axis| {
            if top[axis] {
                u[axis] * g(value(k[axis] * k[axis]))
            } else {
                u[axis] * across + along * free(axis)
            }
        })
    }

    /// Returns the element M_ab at one wave vector.
    fn element(&self, mode: usize, a: usize, b: usize) -> f64 {
        let unit: [Complex<f64>; D] =
            std::array::from_fn(|axis| Complex::new(f64::from(u8::from(axis == b)), 0.0));
        self.act(mode, &|value| value, unit)[a].re
    }

    /// Computes the spectra of u minus a constant, in the first D arrays.
    fn forward(&self, u: &[f64], origin: [f64; D], spectra: &mut [Vec<Complex<f64>>]) {
        let u = components::<D>(u, self.cloud.len());
        for c in 0..D {
            self.transform
                .forward(&|i| u[c][i] - origin[c], &mut spectra[c]);
        }
    }

    /// Calls `set(i, [g(M) u]_c, out_c)` with g(M) applied to the first D spectra.
    fn backward(
        &self,
        g: &(impl Fn(f64) -> f64 + Sync),
        spectra: &mut [Vec<Complex<f64>>],
        out: &mut [f64],
        set: &(impl Fn(usize, usize, f64, &mut f64) + Sync),
    ) {
        let (fields, result) = spectra.split_at_mut(D);
        let out = components_mut::<D>(out, self.cloud.len());
        for (c, out) in out.into_iter().enumerate() {
            result[0]
                .par_iter_mut()
                .enumerate()
                .with_min_len(1024)
                .for_each(|(mode, result)| {
                    let u = std::array::from_fn(|b| fields[b][mode]);
                    *result = self.act(mode, g, u)[c];
                });
            self.transform
                .inverse(&mut result[0], out, &|i, value, out| set(c, i, value, out));
        }
    }

    fn force_into(&self, u: &[f64], out: &mut [f64]) {
        let mut spectra = self.spectra.take();
        self.forward(u, origin::<D>(u), &mut spectra);
        self.backward(&|value| -value, &mut spectra, out, &|_, _, value, out| {
            *out = value;
        });
    }

    /// Adds −Σ_ab M_ab (u_a u_b) to `out`.
    fn add_squares(&self, u: &[f64], origin: [f64; D], out: &mut [f64]) {
        let mut spectra = self.spectra.take();
        let (product, rest) = spectra.split_at_mut(1);
        let u = components::<D>(u, self.cloud.len());
        for (a, b) in pairs(D) {
            let times = if a == b { 1.0 } else { 2.0 };
            let square = |i: usize| times * (u[a][i] - origin[a]) * (u[b][i] - origin[b]);
            self.transform.forward(&square, &mut product[0]);
            rest[0]
                .par_iter_mut()
                .zip(&product[0])
                .enumerate()
                .with_min_len(1024)
                .for_each(|(mode, (result, value))| *result = value * -self.element(mode, a, b));
            self.transform
                .inverse(&mut rest[0], out, &|_, value, out| *out += value);
        }
    }
}

impl<const D: usize> LinearOperator for SpectralForce<D> {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        self.force_into(u, out);
    }

    fn as_diagonal(&self) -> Option<&dyn Diagonal> {
        Some(self)
    }
}

impl<const D: usize> Diagonal for SpectralForce<D> {
    fn add_functions(&self, density: f64, shift: f64, x: &[f64], functions: &mut [FunctionOf<'_>]) {
        let mut spectra = self.spectra.take();
        let origin = origin::<D>(x);
        self.forward(x, origin, &mut spectra);
        for function in functions {
            let g = |value: f64| (function.value)(value / density + shift);
            // The constant is a separate wave.
            let constant = origin.map(|origin| g(0.0) * origin);
            self.backward(&g, &mut spectra, function.out, &|c, _, value, out| {
                *out += value + constant[c];
            });
        }
    }
}

impl<const D: usize> Force for SpectralForce<D> {
    fn points(&self) -> usize {
        self.cloud.len()
    }

    fn dimension(&self) -> usize {
        D
    }

    fn add_force(&self, _t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        let n = self.points();
        let mut force = self.fields.take();
        self.force_into(u, &mut force);
        for c in 0..D {
            for_each_wanted(&on, 0..n, |points| {
                let range = c * n + points.start..c * n + points.end;
                for (out, force) in out[range.clone()].iter_mut().zip(&force[range]) {
                    *out += force;
                }
            });
        }
    }

    /// Energy density w = ¼ Σ_ab L_ab(u_a u_b) − ½ f·u with L = −M, relative to a common origin: half of the energy
    /// of each bond of a point. The products contain waves of twice the wavenumber, so fields should be smooth on
    /// the scale of two spacings.
    fn add_energy_density(&self, _t: f64, u: &[f64], out: &mut [f64]) {
        let n = self.points();
        let origin = origin::<D>(u);
        let mut squares = vec![0.0; n];
        self.add_squares(u, origin, &mut squares);
        let mut force = self.fields.take();
        self.force_into(u, &mut force);
        add_density(u, &force, origin, &squares, out);
    }

    /// Energy −½ Σ V f·u.
    fn energy(&self, _t: f64, u: &[f64]) -> f64 {
        let origin = origin::<D>(u);
        let mut force = self.fields.take();
        self.force_into(u, &mut force);
        elastic_energy(self.cloud.volumes(), u, &force, origin)
    }

    /// Largest ω of all plane waves, for the smallest density.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let least = (0..self.points())
            .map(density)
            .fold(f64::INFINITY, f64::min);
        (self.largest / least * (1.0 + 1e-12)).sqrt()
    }

    fn tangent_into(&self, _t: f64, _u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.force_into(direction, out);
    }

    /// Approximate number of cells within the horizon of all points; no loop runs over them.
    fn directed_bonds(&self) -> u64 {
        // Whole bonds, each counted from both ends.
        2 * (0.5 * self.family * self.points() as f64).round() as u64
    }

    fn bytes(&self) -> usize {
        let complex = (D + 2) * self.transform.len() * size_of::<Complex<f64>>();
        complex + size_of_val(&self.symbol[..]) + D * self.points() * size_of::<f64>()
    }

    fn instruction_set(&self) -> InstructionSet {
        InstructionSet::detect()
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            linear: Linearity::Exact(self),
            ..Capabilities::default()
        }
    }
}

pericles::saved! {
    impl<const D: usize> Checkpointed for SpectralForce<D> {
        cloud, transform, unit, symbol, largest, family: fixed,
        spectra, fields: scratch,
    }
}
