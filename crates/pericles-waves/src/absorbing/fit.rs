//! Kernels as sums of exponentials, fitted to the symbol.
//!
//! Across a branch cut of the symbol of the exterior one decaying solution becomes a growing one, so that the matrix
//! of kernels changes by rank one; exponentials are therefore fitted along directions. Interpolation along random
//! directions (Loewner matrices) needs 20 to 35 exponentials per branch. Common poles of all K² kernels (AAA) need as
//! many, but their residues have full rank, which costs five times as much.

use std::f64::consts::PI;

use nalgebra::{Complex, DMatrix};
use rayon::prelude::*;

use super::loewner::{Exponential, Growing, Loewner};
use super::roots::{expanded, factor_at};
use super::{AbsorbingError, LatticeStencil, LatticeStep};

type C = Complex<f64>;

/// Kernels `F_n^m[j]` ≈ Re Σ_p a_{n,p} b_{m,p} λ_p^{j−1} for j ≥ 1, with exact `F_n^m[0]`.
#[derive(Debug, Clone)]
pub struct ExponentialKernels {
    pub(super) reach: usize,
    pub(super) terms: Vec<Exponential>,
    /// `F_n^m[0]`, m running faster.
    pub(super) present: Vec<f64>,
    /// Largest error of a kernel's generating function at the samples: the error of a ghost displacement due to
    /// unit displacements of all outer points.
    pub residual: f64,
}

/// Numbers of directions per sample point to try: kernels with many branch points need more.
const DIRECTIONS: [usize; 4] = [1, 2, 4, 8];
/// Thresholds of the retained singular values, relative to the tolerance: a fit that fails at one order often
/// succeeds at the next.
const SHARES: [f64; 2] = [1e-3, 1e-5];
/// Largest remainder of the cross approximation, relative to the smallest retained singular value.
const LEFT: f64 = 0.1;
/// Round-off level of the cross approximation, relative to the largest cross; below it the rank would equal the
/// number of rows.
const NOISE: f64 = 4.0 * f64::EPSILON;
/// Limit on rows and columns; larger problems take minutes.
const MOST_TANGENTS: usize = 6000;
/// Largest number of steps. Samples are as close as a fifth of its reciprocal; differences between them lose more
/// than half of their digits.
const MOST_STEPS: usize = 1_000_000_000;
/// Largest rank relative to the number of rows that the samples support.
const SUPPORTED: f64 = 0.36;
/// Sample points along a half circle without branch points.
const ALONG: f64 = 60.0;
/// Distance between samples relative to the distance from the nearest branch point.
const GRADING: f64 = 0.2;

impl ExponentialKernels {
    /// Fits sums of exponentials for a scheme and its step, valid for about `steps` steps, whose generating
    /// functions deviate from the exact ones by at most `tolerance`.
    ///
    /// The functions are sampled on the circle |w| = exp(−2/steps), densely near the branch points exp(±iφ), where
    /// φ is the phase of a step (2 asin(ω dt/2) for velocity Verlet) for every stationary ω of the band. Across a
    /// branch cut one root of the symbol turns into its reciprocal, so the subspace of decaying solutions changes
    /// by one dimension and the matrix F by rank one: tangential interpolation (the Loewner framework) finds as
    /// many exponentials as the band has branches, each with a residue of rank one. The singular values determine
    /// the number of exponentials; their `give` vectors are then recomputed by real least squares. The first fit
    /// within the tolerance is returned.
    ///
    /// Common poles of all K² functions (set-valued AAA) are equally many, but the residues of those off the cuts
    /// have full rank: for K = 7 five to six times the work.
    ///
    /// # Errors
    /// [`AbsorbingError::Fit`] if no fit is within the tolerance; a tolerance out of range; more than 10⁹ steps
    /// ([`AbsorbingError::FitTooLong`]).
    pub fn fit(
        stencil: &LatticeStencil,
        step: LatticeStep,
        steps: usize,
        tolerance: f64,
    ) -> Result<Self, AbsorbingError> {
        if !(tolerance > 1e-14 && tolerance < 1.0) {
            return Err(AbsorbingError::Tolerance { value: tolerance });
        }
        if steps > MOST_STEPS {
            return Err(AbsorbingError::FitTooLong {
                steps: steps as f64,
                most: MOST_STEPS as f64,
            });
        }
        let reach = stencil.reach();
        let samples = Samples::new(stencil, step, steps);
        let (mut best, mut fits) = (f64::INFINITY, 0);
        let searches = Growing::ALL.into_iter().flat_map(|growing| {
            let all = DIRECTIONS.into_iter();
            let few = all.take_while(|count| samples.points.len() * count <= MOST_TANGENTS);
            few.map(move |directions| (growing, directions))
        });
        for (growing, directions) in searches {
            for share in SHARES {
                let least = (LEFT * share * tolerance).max(NOISE);
                let loewner = Loewner::new(&samples.points, &samples.values, directions, least);
                let order = loewner.rank(share * tolerance);
                if order as f64 > SUPPORTED * loewner.size() as f64 {
                    break;
                }
                let mut terms = loewner.exponentials(order, growing);
                let mut residual = samples.largest_error(&terms);
                fits += 1;
                if residual > tolerance {
                    samples.refine(&mut terms);
                    residual = samples.largest_error(&terms);
                }
                best = best.min(residual);
                if residual <= tolerance {
                    return Ok(Self {
                        reach,
                        terms,
                        present: samples.present.iter().map(|x| x.re).collect(),
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

    /// Evaluates `F_n^m[j]` for j = 0 … steps, m running faster, for comparison with exact kernels.
    pub fn series(&self, steps: usize) -> Vec<Vec<f64>> {
        let start = |first: &f64| {
            let mut series = vec![0.0; steps + 1];
            series[0] = *first;
            series
        };
        let mut series: Vec<Vec<f64>> = self.present.iter().map(start).collect();
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

/// Samples of (F(w) − F(0))/w, whose exponentials are λ^j, at points of the upper half circle.
struct Samples {
    /// F(0).
    present: Vec<C>,
    points: Vec<C>,
    values: Vec<DMatrix<C>>,
    /// Points halfway between the samples with their values, used for validation only: a superfluous pole with a
    /// tiny residue can hide between samples.
    between: Vec<(C, DMatrix<C>)>,
}

impl Samples {
    fn new(stencil: &LatticeStencil, step: LatticeStep, steps: usize) -> Self {
        let reach = stencil.reach();
        let points = sample_points(stencil, step, steps);
        let between: Vec<C> = points
            .windows(2)
            .map(|pair| halfway(pair[0], pair[1]))
            .collect();
        let complex = |x: &f64| C::new(*x, 0.0);
        let h: Vec<C> = step.present(stencil).iter().map(complex).collect();
        let present = expanded(&h);
        let value = |w: &C| {
            let full = expanded(&factor_at(stencil, step.symbol(*w)));
            let past = full.iter().zip(&present).map(|(f, now)| (f - now) / *w);
            DMatrix::from_row_iterator(reach, reach, past)
        };
        Self {
            values: points.par_iter().map(value).collect(),
            points,
            between: between.into_par_iter().map(|w| (w, value(&w))).collect(),
            present,
        }
    }

    /// Largest error at the samples and halfway between them, of a ghost displacement due to unit displacements of
    /// all outer points.
    fn largest_error(&self, terms: &[Exponential]) -> f64 {
        let fitted = self.points.par_iter().zip(&self.values);
        let between = self.between.par_iter().map(|(w, value)| (w, value));
        let errors: Vec<f64> = fitted
            .chain(between)
            .map(|(w, value)| {
                let mut left = value.clone();
                for term in terms {
                    let [one, other] = generating(term.decay, *w);
                    for (m, b) in term.take.iter().enumerate() {
                        for (n, a) in term.give.iter().enumerate() {
                            let c = a * b;
                            left[(n, m)] -= c * one + c.conj() * other;
                        }
                    }
                }
                let row = |n: usize| left.row(n).iter().map(|x| x.norm()).sum::<f64>();
                (0..left.nrows()).map(row).fold(0.0, f64::max)
            })
            .collect();
        // Keeps a NaN.
        let worse = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
        errors.into_iter().fold(0.0, worse)
    }

    /// Recomputes the `give` vectors of all terms by least squares on the samples along some directions.
    fn refine(&self, terms: &mut [Exponential]) {
        const DIRECTIONS: usize = 8;
        let reach = self.values[0].nrows();
        let count = reach.min(DIRECTIONS);
        let noise = pericles::noise::noise(count * reach, 2);
        let directions: Vec<&[f64]> = noise.chunks(reach).collect();
        let rows = 2 * count * self.points.len();
        let mut matrix = DMatrix::<f64>::zeros(rows, 2 * terms.len());
        let mut right = DMatrix::<f64>::zeros(rows, reach);
        for (p, term) in terms.iter().enumerate() {
            let along = |r: &&[f64]| -> C { term.take.iter().zip(*r).map(|(b, r)| b * r).sum() };
            let taken: Vec<C> = directions.iter().map(along).collect();
            for (i, w) in self.points.iter().enumerate() {
                let [one, other] = generating(term.decay, *w);
                for (d, b) in taken.iter().enumerate() {
                    let (x, y) = (b * one, b.conj() * other);
                    let row = 2 * (i * count + d);
                    for (column, z) in [(2 * p, x + y), (2 * p + 1, C::i() * (x - y))] {
                        matrix[(row, column)] = z.re;
                        matrix[(row + 1, column)] = z.im;
                    }
                }
            }
        }
        for (i, value) in self.values.iter().enumerate() {
            for (d, direction) in directions.iter().enumerate() {
                let row = 2 * (i * count + d);
                for n in 0..reach {
                    let pairs = value.row(n).into_iter().zip(*direction);
                    let seen: C = pairs.map(|(f, r)| f * *r).sum();
                    right[(row, n)] = seen.re;
                    right[(row + 1, n)] = seen.im;
                }
            }
        }
        let solution = least_squares(matrix, right);
        for (p, term) in terms.iter_mut().enumerate() {
            for (n, a) in term.give.iter_mut().enumerate() {
                *a = C::new(solution[(2 * p, n)], solution[(2 * p + 1, n)]);
            }
        }
    }
}

/// Point of the circle halfway between two of its points.
fn halfway(a: C, b: C) -> C {
    C::from_polar(a.norm(), 0.5 * (a.arg() + b.arg()))
}

/// 1/(1 − λ w), the generating function of λ^j, and its conjugate partner, each with weight one half.
fn generating(decay: C, w: C) -> [C; 2] {
    [decay, decay.conj()].map(|decay| (C::new(1.0, 0.0) - decay * w).inv() * 0.5)
}

/// Least squares with columns scaled to length one. Columns that contribute nothing, such as the imaginary residue
/// of a real exponential, get the coefficient zero.
fn least_squares(mut matrix: DMatrix<f64>, mut right: DMatrix<f64>) -> DMatrix<f64> {
    let columns = matrix.ncols();
    let norms: Vec<f64> = (0..columns)
        .map(|c| matrix.column(c).norm().max(f64::MIN_POSITIVE))
        .collect();
    for (c, norm) in norms.iter().enumerate() {
        matrix.column_mut(c).unscale_mut(*norm);
    }
    let qr = matrix.qr();
    qr.q_tr_mul(&mut right);
    let mut triangle = qr.r();
    for c in 0..columns {
        if triangle[(c, c)].abs() < 1e-14 {
            triangle[(c, c)] = f64::INFINITY;
        }
    }
    let mut solution = right.rows(0, columns).into_owned();
    triangle.solve_upper_triangular_mut(&mut solution);
    for (c, norm) in norms.iter().enumerate() {
        let scale = |x: &mut f64| *x = if x.is_finite() { *x / norm } else { 0.0 };
        solution.row_mut(c).iter_mut().for_each(scale);
    }
    solution
}

/// Points of the upper half circle, graded towards the branch points: features on the circle are no finer than its
/// distance from the unit circle.
fn sample_points(stencil: &LatticeStencil, step: LatticeStep, steps: usize) -> Vec<C> {
    // Longer runs cannot be fitted; their cost estimate equals the estimate of the longest.
    let steps = steps.min(MOST_STEPS);
    let radius = (-2.0 / steps as f64).exp();
    let finest = 1.0 / steps as f64;
    let branches: Vec<f64> = stencil
        .stationary_frequencies()
        .iter()
        .map(|omega| step.phase(*omega))
        .collect();
    let mut points = Vec::new();
    let mut angle = 0.3 * GRADING * finest;
    while angle < PI {
        points.push(C::from_polar(radius, angle));
        let apart = branches.iter().map(|branch| (angle - branch).abs());
        let nearest = apart.fold(angle, f64::min);
        angle += (GRADING * nearest.hypot(finest)).min(PI / ALONG);
    }
    points
}

/// Number of sample points of a fit, which determines its cost.
pub(super) fn sample_count(stencil: &LatticeStencil, step: LatticeStep, steps: usize) -> usize {
    sample_points(stencil, step, steps).len()
}
