//! Kernels as sums of exponentials, fitted to the symbol.

use nalgebra::{Complex, DMatrix};
use rayon::prelude::*;

use super::contour::verlet_symbol;
use super::rational::Rational;
use super::roots::{expanded, factor_at};
use super::{AbsorbingError, LatticeStencil};

type C = Complex<f64>;

/// `F_n^m[j]` ≈ Re Σ_p a_{n,p} b_{m,p} λ_p^{j−1}, j ≥ 1.
#[derive(Debug, Clone)]
pub struct ExponentialKernels {
    pub(super) reach: usize,
    pub(super) terms: Vec<Term>,
    /// Largest error of a kernel's generating function on the samples, over dt-independent units: relative to displacements.
    pub residual: f64,
}

/// An exponential with a residue of rank one.
#[derive(Debug, Clone)]
pub(super) struct Term {
    pub(super) decay: C,
    /// a_n, K numbers.
    pub(super) give: Vec<C>,
    /// b_m, K numbers.
    pub(super) take: Vec<C>,
}

/// Support points of the rational approximations that are tried.
const MOST_PAIRS: usize = 60;
/// Random combinations of the kernels that are approximated together.
const COMBINATIONS: usize = 5;
/// Sample points per decade about a branch point, and along the half circle.
const PER_DECADE: usize = 12;
const EQUISPACED: usize = 300;

impl ExponentialKernels {
    /// A fit for velocity Verlet with the step dt, good for about `steps` steps, whose generating functions miss the exact ones by at most `tolerance`.
    ///
    /// The functions are sampled on the circle |w| = exp(−2/steps), densely about the branch points exp(±iφ), φ = 2 asin(ω dt/2), of the band's edges.
    /// Poles are those of set-valued AAA approximations (Nakatsukasa, Sète & Trefethen 2018; Lietaert et al. 2022) of growing degree to random combinations of the
    /// kernels; residues follow by real least squares, and are split into terms of rank one. The first fit that holds the tolerance is taken.
    ///
    /// # Errors
    /// [`AbsorbingError::Fit`] if none does; a tolerance out of range.
    pub fn fit(
        stencil: &LatticeStencil,
        dt: f64,
        steps: usize,
        tolerance: f64,
    ) -> Result<Self, AbsorbingError> {
        if !(tolerance > 1e-14 && tolerance < 1.0) {
            return Err(AbsorbingError::Tolerance { value: tolerance });
        }
        let points = sample_points(stencil, dt, steps);
        let values: Vec<Vec<C>> = points
            .par_iter()
            .map(|w| expanded(&factor_at(stencil, verlet_symbol(*w, dt))))
            .collect();
        let (mut best, mut fits) = (f64::INFINITY, 0);
        for seed in 0..2 {
            let functions = combined(&values, seed);
            let mut rational = Rational::new(&points, &functions);
            while rational.pairs() < MOST_PAIRS && rational.refine() {
                // Small ones cannot be good enough, and neighbours are alike.
                if rational.pairs() < 6 || rational.error() > 1e3 * tolerance {
                    continue;
                }
                fits += 1;
                let decays = rational.decays();
                let fit = Residues::solve(&points, &values, &decays);
                let terms = fit.terms(stencil.reach(), 0.1 * tolerance);
                let residual = miss(&points, &values, &terms);
                best = best.min(residual);
                if residual <= tolerance {
                    return Ok(Self {
                        reach: stencil.reach(),
                        terms,
                        residual,
                    });
                }
            }
        }
        Err(AbsorbingError::Fit {
            tolerance,
            residual: best,
            fits,
        })
    }

    /// Number of exponentials, each with its conjugate.
    pub fn terms(&self) -> usize {
        self.terms.len()
    }

    /// `F_n^m[j]` for j = 0 … steps, m running faster: for comparison with exact kernels.
    pub fn series(&self, steps: usize) -> Vec<Vec<f64>> {
        let mut series = vec![vec![0.0; steps + 1]; self.reach * self.reach];
        for term in &self.terms {
            for (n, a) in term.give.iter().enumerate() {
                for (m, b) in term.take.iter().enumerate() {
                    let mut value = a * b;
                    for x in &mut series[n * self.reach + m][1..] {
                        *x += value.re;
                        value *= term.decay;
                    }
                }
            }
        }
        series
    }
}

/// Points of the upper half circle.
fn sample_points(stencil: &LatticeStencil, dt: f64, steps: usize) -> Vec<C> {
    let radius = (-2.0 / steps as f64).exp();
    let closest = 0.03 / steps as f64;
    let branches = stencil.stationary_frequencies();
    let branches = branches
        .iter()
        .map(|omega| 2.0 * (0.5 * omega * dt).min(1.0).asin());
    let pi = std::f64::consts::PI;
    let mut angles: Vec<f64> = (0..=EQUISPACED)
        .map(|k| pi * k as f64 / EQUISPACED as f64)
        .collect();
    let decades = (0.7 / closest).log10();
    let count = (decades * PER_DECADE as f64).ceil() as usize;
    for branch in branches.chain([0.0]) {
        for k in 0..=count {
            let apart = closest * (0.7 / closest).powf(k as f64 / count as f64);
            angles.extend([branch - apart, branch + apart]);
        }
        angles.push(branch);
    }
    angles.retain(|angle| (0.0..=pi).contains(angle));
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|a, b| (*a - *b).abs() < 1e-3 * closest);
    let at = |angle: f64| C::from_polar(radius, angle);
    angles.into_iter().map(at).collect()
}

/// Random real combinations of the kernels, sample by sample.
fn combined(values: &[Vec<C>], seed: u64) -> Vec<Vec<C>> {
    let count = values[0].len();
    let weights = crate::noise::noise(COMBINATIONS * count, seed);
    let norm = 1.0 / (count as f64).sqrt();
    let one = |value: &Vec<C>| {
        (0..COMBINATIONS)
            .map(|c| {
                let weights = &weights[c * count..(c + 1) * count];
                value.iter().zip(weights).map(|(f, w)| f * (norm * w)).sum()
            })
            .collect()
    };
    values.iter().map(one).collect()
}

/// The residues of all kernels at given exponentials.
struct Residues {
    decays: Vec<C>,
    /// One row per exponential, one entry per kernel.
    residues: Vec<Vec<C>>,
}

/// w/(1 − λ w): the generating function of λ^{j−1}.
fn generating(decay: C, w: C) -> C {
    w / (C::new(1.0, 0.0) - decay * w)
}

impl Residues {
    /// Least squares on the real and imaginary parts of all samples.
    fn solve(points: &[C], values: &[Vec<C>], decays: &[C]) -> Self {
        let (samples, kernels) = (points.len(), values[0].len());
        let columns = 2 * decays.len();
        let mut matrix = DMatrix::<f64>::zeros(2 * samples, columns);
        for (p, decay) in decays.iter().enumerate() {
            for (i, w) in points.iter().enumerate() {
                let (one, other) = (generating(*decay, *w), generating(decay.conj(), *w));
                let real = 0.5 * (one + other);
                let imaginary = C::new(0.0, 0.5) * (one - other);
                for (column, x) in [(2 * p, real), (2 * p + 1, imaginary)] {
                    matrix[(2 * i, column)] = x.re;
                    matrix[(2 * i + 1, column)] = x.im;
                }
            }
        }
        let mut right = DMatrix::<f64>::zeros(2 * samples, kernels);
        for (i, value) in values.iter().enumerate() {
            for (k, x) in value.iter().enumerate() {
                right[(2 * i, k)] = x.re;
                right[(2 * i + 1, k)] = x.im;
            }
        }
        let norms: Vec<f64> = (0..columns)
            .map(|c| matrix.column(c).norm().max(f64::MIN_POSITIVE))
            .collect();
        for (c, norm) in norms.iter().enumerate() {
            matrix.column_mut(c).unscale_mut(*norm);
        }
        let (q, r) = matrix.qr().unpack();
        let mut solution = q.transpose() * right;
        // Exponentials that add nothing (a real one has no imaginary residue) are left out by a tiny diagonal.
        let mut triangle = r;
        for c in 0..columns {
            if triangle[(c, c)].abs() < 1e-14 {
                triangle[(c, c)] = f64::INFINITY;
            }
        }
        triangle.solve_upper_triangular_mut(&mut solution);
        let residues = (0..decays.len())
            .map(|p| {
                (0..kernels)
                    .map(|k| {
                        let part = |c: usize| {
                            let x = solution[(c, k)] / norms[c];
                            if x.is_finite() { x } else { 0.0 }
                        };
                        C::new(part(2 * p), part(2 * p + 1))
                    })
                    .collect()
            })
            .collect();
        Self {
            decays: decays.to_vec(),
            residues,
        }
    }

    /// Each residue matrix as a sum of products, without those below `negligible` in all.
    fn terms(&self, reach: usize, negligible: f64) -> Vec<Term> {
        let mut terms = Vec::new();
        let share = negligible / self.decays.len() as f64;
        for (decay, residue) in self.decays.iter().zip(&self.residues) {
            let matrix = DMatrix::from_row_slice(reach, reach, residue);
            let svd = matrix.svd(true, true);
            let (Some(u), Some(vt)) = (svd.u, svd.v_t) else {
                continue;
            };
            // A term's generating function is at most its residue over the distance to the circle.
            let distance = (1.0 - decay.norm()).max(1e-12);
            for (r, size) in svd.singular_values.iter().enumerate() {
                if size / distance.min(1.0) < share {
                    continue;
                }
                terms.push(Term {
                    decay: *decay,
                    give: (0..reach).map(|n| u[(n, r)] * *size).collect(),
                    take: (0..reach).map(|m| vt[(r, m)]).collect(),
                });
            }
        }
        terms
    }
}

/// The largest error on the samples, of the displacement of a ghost by unit displacements of all outer points.
fn miss(points: &[C], values: &[Vec<C>], terms: &[Term]) -> f64 {
    let errors: Vec<f64> = points
        .par_iter()
        .zip(values)
        .map(|(w, value)| {
            let mut left = value.clone();
            for term in terms {
                let half = 0.5;
                let (one, other) = (
                    generating(term.decay, *w) * half,
                    generating(term.decay.conj(), *w) * half,
                );
                let reach = term.take.len();
                for (n, a) in term.give.iter().enumerate() {
                    for (m, b) in term.take.iter().enumerate() {
                        let c = a * b;
                        left[n * reach + m] -= c * one + c.conj() * other;
                    }
                }
            }
            let reach = (left.len() as f64).sqrt() as usize;
            let row = |row: &[C]| row.iter().map(|x| x.norm()).sum::<f64>();
            left.chunks(reach).map(row).fold(0.0, f64::max)
        })
        .collect();
    errors
        .into_iter()
        .fold(0.0, |a, b| if b > a || b.is_nan() { b } else { a })
}
