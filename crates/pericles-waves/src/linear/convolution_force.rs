//! Force operator of linear lattice bodies by convolution.

use std::ops::Range;
use std::sync::Arc;

use super::box_convolution::BoxConvolution;
use super::energy::{add_density, elastic_energy, origin};
use super::lattice_bonds::{LatticeBonds, OffsetBond};
use super::tensor_kernel::{Axis, axes, pairs};
use super::tensor_spectra::{Product, pair};
use super::toeplitz::{Ends, Toeplitz};
use super::wanted::for_each_wanted;
use super::{features_of, require};
use crate::form::ForceForm;
use pericles::family::{Crack, VolumeCorrection};
use pericles::material::{BondConstants, BondMaterial};
use pericles::operator::pool::Pool;
use pericles::operator::{
    Capabilities, Feature, Force, InstructionSet, LatticeSprings, LinearOperator, Linearity,
    PointSubset,
};
use pericles::parallel::{components, components_mut};
use pericles::space::{Lattice, PointCloud};
use pericles::{PericlesError, Result};

/// Force density (N/m³) of the linear, unbreakable bond-based law on a lattice body: f_a(x_i) = Σ_b [ Σ_j
/// K_ab(ξ_ij) u_b(x_j) − u_b(x_i) Σ_j K_ab(ξ_ij) ], K(ξ) = c α κ V ξ⊗ξ/|ξ|³.
///
/// Equal to `BondForce<LinearBond, D>` to round-off, at a cost of O(N log N) that hardly depends on the horizon.
/// Bodies may have any shape, including holes; axes may be periodic, with the bounding box of the lattice as the
/// period. Whole bars use a [`Toeplitz`] line.
///
/// * All points are computed for any requested subset; only rows without requested points save part of the inverse
///   transforms.
/// * A rigid translation gives exactly zero.
/// * Memory: D(D+1)/2 spectra on an octant of the wavenumbers, D(D+1)/2 numbers per point, and two complex arrays
///   of D fields on the box, padded by the horizon along x (and y in 3D).
pub struct ConvolutionForce<const D: usize> {
    cloud: Arc<PointCloud>,
    engine: Engine<D>,
    /// Σ_j K_ab per point, one array per pair.
    diagonal: Vec<Vec<f64>>,
    /// Σ |k|/|ξ| over a full family, if K is not positive semidefinite.
    signed_bound: Option<f64>,
    springs: Option<LatticeSprings>,
    directed_bonds: u64,
    fields: Pool<Vec<f64>>,
}

enum Engine<const D: usize> {
    /// A whole bar.
    Line(Box<Toeplitz>),
    Box(Box<BoxConvolution<D>>),
}

impl<const D: usize> ConvolutionForce<D> {
    /// Creates the operator of a material on a body whose axes may be periodic.
    ///
    /// # Errors
    /// Cases that a convolution does not represent, with the reason: points that are not on a lattice, a nonlinear
    /// pair law, breaking, pre-cracks.
    pub fn new(
        cloud: Arc<PointCloud>,
        material: &BondMaterial,
        constants: &BondConstants,
        cracks: &[Crack],
        periodic: [bool; D],
    ) -> Result<Self> {
        let features = features_of(material, constants, D);
        let cut = !cracks.is_empty();
        require(
            ForceForm::Convolution,
            features
                .with(Feature::PreCracks, cut)
                .with(Feature::Pieces, cloud.has_pieces()),
        )?;
        let stiffness =
            |xi| constants.micromodulus * material.influence.alpha_of(xi, material.horizon);
        Self::with_stiffness(
            cloud,
            material.horizon,
            material.volume_correction,
            stiffness,
            periodic,
        )
    }

    /// Creates an operator whose bonds have the stiffness c α given as a function of their reference vector ξ, m;
    /// it must be equal for ξ and −ξ.
    ///
    /// # Errors
    /// Points that are not on a lattice, or of another dimension; a horizon below the spacing; a stiffness that is
    /// not finite.
    pub fn with_stiffness(
        cloud: Arc<PointCloud>,
        horizon: f64,
        correction: VolumeCorrection,
        stiffness_of_bond: impl Fn([f64; 3]) -> f64,
        periodic: [bool; D],
    ) -> Result<Self> {
        if cloud.dimension() != D {
            return Err(PericlesError::WrongDimension {
                what: "a convolution of this type",
                needed: ["1", "2", "3"][D - 1],
                dimension: cloud.dimension(),
            });
        }
        let (bonds, lattice) = LatticeBonds::new(&cloud, horizon, correction, stiffness_of_bond)?;
        let axes = axes(lattice, bonds.largest_offset(), periodic);
        let (bound, signed) = bonds.full_family(axes.map(|axis| axis.raw))?;
        let n = cloud.len();
        let (engine, directed_bonds);
        if D == 1 && n == lattice.shape[0] {
            let weights: Vec<f64> = (1..=axes[0].raw as i64)
                .map(|r| bonds.at([r, 0, 0]))
                .map(|bond| bond.map_or(0.0, |bond| bond.stiffness / bond.length))
                .collect();
            let ends = if periodic[0] {
                Ends::Periodic
            } else {
                Ends::Free
            };
            engine = Engine::Line(Box::new(Toeplitz::stencil(n, &weights, ends)?));
            directed_bonds = count_bonds_of_bar(n as u64, axes[0].raw as u64, periodic[0]);
        } else {
            directed_bonds = count_bonds::<D>(lattice, axes, |offset| bonds.at(offset).is_some());
            let pairs = pairs(D);
            let kernel = |offset, values: &mut [f64]| {
                if let Some(OffsetBond {
                    stiffness,
                    length,
                    xi,
                }) = bonds.at(offset)
                {
                    for (value, &(a, b)) in values.iter_mut().zip(&pairs) {
                        *value = stiffness * xi[a] * xi[b] / length.powi(3);
                    }
                }
            };
            let convolution = BoxConvolution::new(lattice, axes, kernel);
            engine = Engine::Box(Box::new(convolution));
        }
        let mut operator = Self {
            engine,
            diagonal: vec![],
            signed_bound: signed.then_some(bound),
            springs: bonds.springs(D, axes.map(|axis| axis.raw)),
            directed_bonds,
            fields: Pool::new(1, move || vec![0.0; D * n]),
            cloud,
        };
        if let Engine::Box(convolution) = &operator.engine {
            operator.diagonal = (0..pairs(D).len())
                .map(|p| convolution.kernel_sums(p))
                .collect();
        }
        Ok(operator)
    }

    fn add(&self, u: &[f64], on: &PointSubset<'_>, out: &mut [f64]) {
        let n = self.cloud.len();
        match &self.engine {
            Engine::Line(line) => {
                let mut force = self.fields.take();
                line.apply_into(u, &mut force);
                for_each_wanted(on, 0..n, |points| {
                    for (out, force) in out[points.clone()].iter_mut().zip(&force[points]) {
                        *out += force;
                    }
                });
            }
            Engine::Box(convolution) => {
                let origin = origin::<D>(u);
                let u = components::<D>(u, n);
                let relative = |c: usize, points: Range<usize>, line: &mut [f64]| {
                    for (line, u) in line.iter_mut().zip(&u[c][points]) {
                        *line = u - origin[c];
                    }
                };
                let less_own = |a: usize, points: Range<usize>, values: &[f64], out: &mut [f64]| {
                    let u = u.map(|u| &u[points.clone()]);
                    let diagonal: [&[f64]; D] =
                        std::array::from_fn(|b| &self.diagonal[pair(D, a, b)][points.clone()]);
                    for k in 0..out.len() {
                        let mut own = 0.0;
                        for b in 0..D {
                            own += diagonal[b][k] * (u[b][k] - origin[b]);
                        }
                        out[k] += values[k] - own;
                    }
                };
                let out = components_mut::<D>(out, n);
                convolution.apply::<D>(Product::Tensor, on, &relative, out, &less_own);
            }
        }
    }

    /// Adds Σ_ab Σ_j K_ab (u_a u_b(x_j) − u_a u_b(x_i)) to `out`.
    fn add_squares(&self, u: &[f64], origin: [f64; D], out: &mut [f64]) {
        let n = self.cloud.len();
        let u = components::<D>(u, n);
        match &self.engine {
            Engine::Line(line) => {
                let mut square = self.fields.take();
                for (square, u) in square.iter_mut().zip(u[0]) {
                    *square = (u - origin[0]).powi(2);
                }
                line.apply_into(&square, out);
            }
            Engine::Box(convolution) => {
                for (p, (a, b)) in pairs(D).into_iter().enumerate() {
                    let times = if a == b { 1.0 } else { 2.0 };
                    let square = |i: usize| times * (u[a][i] - origin[a]) * (u[b][i] - origin[b]);
                    let squares = |_, points: Range<usize>, line: &mut [f64]| {
                        for (line, i) in line.iter_mut().zip(points) {
                            *line = square(i);
                        }
                    };
                    let less_own = |_, points: Range<usize>, values: &[f64], out: &mut [f64]| {
                        for ((out, value), i) in out.iter_mut().zip(values).zip(points) {
                            *out += value - self.diagonal[p][i] * square(i);
                        }
                    };
                    let all = PointSubset::All;
                    convolution.apply(Product::Pair(p), &all, &squares, [&mut *out], &less_own);
                }
            }
        }
    }
}

/// Counts directed bonds, by the same convolution with a kernel of ones.
fn count_bonds<const D: usize>(
    lattice: &Lattice,
    axes: [Axis; 3],
    exists: impl Fn([i64; 3]) -> bool,
) -> u64 {
    let ones = BoxConvolution::<D>::new(lattice, axes, |offset, values: &mut [f64]| {
        values[0] = f64::from(u8::from(exists(offset)));
    });
    let counts = ones.kernel_sums(0);
    counts.iter().map(|count| count.round() as u64).sum()
}

/// Counts directed bonds of a bar.
fn count_bonds_of_bar(nodes: u64, reach: u64, periodic: bool) -> u64 {
    let at = |r: u64| {
        if periodic {
            nodes
        } else {
            nodes.saturating_sub(r)
        }
    };
    (1..=reach).map(|r| 2 * at(r)).sum()
}

impl<const D: usize> LinearOperator for ConvolutionForce<D> {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        match &self.engine {
            Engine::Line(line) => line.apply_into(u, out),
            Engine::Box(_) => {
                out.fill(0.0);
                self.add(u, &PointSubset::All, out);
            }
        }
    }

    fn half_bandwidth(&self) -> Option<usize> {
        match &self.engine {
            Engine::Line(line) => line.half_bandwidth(),
            Engine::Box(_) => None,
        }
    }
}

impl<const D: usize> Force for ConvolutionForce<D> {
    fn points(&self) -> usize {
        self.cloud.len()
    }

    fn dimension(&self) -> usize {
        D
    }

    fn add_force(&self, _t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        self.add(u, &on, out);
    }

    /// Energy density w_i = ¼ Σ_ab [ Σ_j K_ab (u_a u_b(x_j) − u_a u_b(x_i)) ] − ½ f(x_i)·u(x_i), relative to a
    /// common origin. Accurate to round-off of the largest K u², so points without strain may have small energies
    /// of either sign.
    fn add_energy_density(&self, _t: f64, u: &[f64], out: &mut [f64]) {
        let n = self.points();
        let origin = origin::<D>(u);
        let mut force = vec![0.0; D * n];
        self.apply_into(u, &mut force);
        let mut squares = vec![0.0; n];
        self.add_squares(u, origin, &mut squares);
        add_density(u, &force, origin, &squares, out);
    }

    /// Energy −½ Σ V f·u.
    fn energy(&self, _t: f64, u: &[f64]) -> f64 {
        let origin = origin::<D>(u);
        let mut force = self.fields.take();
        self.apply_into(u, &mut force);
        elastic_energy(self.cloud.volumes(), u, &force, origin)
    }

    /// Gershgorin bound ω² ≤ max_i (2/ρ_i) Σ_j |k_ij|/|ξ| for D×D blocks; for kernels with negative values over a
    /// full family.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let row = |i: usize| match (&self.engine, self.signed_bound) {
            (_, Some(bound)) => bound,
            (Engine::Line(line), None) => -line.diagonal(i),
            // The trace of Σ_j k ξ⊗ξ/|ξ|³.
            (Engine::Box(_), None) => (0..D).map(|a| self.diagonal[a][i]).sum(),
        };
        let largest =
            (0..self.points()).fold(0.0f64, |largest, i| largest.max(2.0 * row(i) / density(i)));
        // Round-off of the transforms must not make the bound too small.
        (largest * (1.0 + 1e-12)).sqrt()
    }

    fn tangent_into(&self, _t: f64, _u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.apply_into(direction, out);
    }

    /// Number of bonds represented by the convolution; no loop runs over them.
    fn directed_bonds(&self) -> u64 {
        self.directed_bonds
    }

    fn bytes(&self) -> usize {
        let engine = match &self.engine {
            Engine::Line(line) => line.bytes(),
            Engine::Box(convolution) => convolution.bytes(),
        };
        let numbers = self.diagonal.iter().map(Vec::len).sum::<usize>() + D * self.points();
        engine + numbers * size_of::<f64>()
    }

    fn instruction_set(&self) -> InstructionSet {
        InstructionSet::detect()
    }

    fn lattice_springs(&self) -> Option<LatticeSprings> {
        self.springs.clone()
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            linear: Linearity::Exact(self),
            ..Capabilities::default()
        }
    }
}

pericles::saved! {
    impl<const D: usize> Checkpointed for ConvolutionForce<D> {
        cloud, engine, diagonal, signed_bound, springs, directed_bonds: fixed,
        fields: scratch,
    }
}
