//! Rational approximation of several functions with common poles.

use nalgebra::{Complex, DMatrix};

use super::roots::eigenvalues;

type C = Complex<f64>;

/// Set-valued AAA for functions with f(w̄) = conj f(w), known on points of the upper half plane: barycentric approximations with common support
/// points, in conjugate pairs, and common weights.
pub(super) struct Rational<'a> {
    points: &'a [C],
    values: &'a [Vec<C>],
    /// Samples that are support points.
    support: Vec<usize>,
    /// Weight of each support point; its conjugate has the conjugate weight.
    weights: Vec<C>,
    /// The present approximations on the samples.
    approximation: Vec<Vec<C>>,
}

impl<'a> Rational<'a> {
    pub(super) fn new(points: &'a [C], values: &'a [Vec<C>]) -> Self {
        let count = values.len() as f64;
        let mean: Vec<C> = (0..values[0].len())
            .map(|c| C::new(values.iter().map(|v| v[c].re).sum::<f64>() / count, 0.0))
            .collect();
        Self {
            points,
            values,
            support: Vec::new(),
            weights: Vec::new(),
            approximation: vec![mean; points.len()],
        }
    }

    /// Pairs of support points.
    pub(super) fn pairs(&self) -> usize {
        self.support.len()
    }

    /// The largest error on the samples.
    pub(super) fn error(&self) -> f64 {
        (0..self.points.len())
            .map(|i| self.error_at(i))
            .fold(0.0, f64::max)
    }

    fn error_at(&self, i: usize) -> f64 {
        let pairs = self.values[i].iter().zip(&self.approximation[i]);
        pairs.map(|(f, r)| (f - r).norm()).fold(0.0, f64::max)
    }

    fn is_real(&self, i: usize) -> bool {
        self.points[i].im.abs() < 1e-14
    }

    /// Takes the worst sample as a support point and finds new weights; false if nothing is left to do.
    pub(super) fn refine(&mut self) -> bool {
        let free = (0..self.points.len()).filter(|i| !self.support.contains(i));
        let worst = free.max_by(|&a, &b| self.error_at(a).total_cmp(&self.error_at(b)));
        let Some(worst) = worst.filter(|&worst| self.error_at(worst) > 0.0) else {
            return false;
        };
        self.support.push(worst);
        let free: Vec<usize> = (0..self.points.len())
            .filter(|i| !self.support.contains(i))
            .collect();
        // Unknowns: the real and imaginary part of each weight; real support points have a real weight.
        let unknowns: Vec<(usize, bool)> = self
            .support
            .iter()
            .flat_map(|&j| {
                let second = (!self.is_real(j)).then_some((j, true));
                std::iter::once((j, false)).chain(second)
            })
            .collect();
        let functions = self.values[0].len();
        let rows = 2 * free.len() * functions;
        let mut loewner = DMatrix::<f64>::zeros(rows, unknowns.len());
        for (column, &(j, imaginary)) in unknowns.iter().enumerate() {
            for (k, &i) in free.iter().enumerate() {
                let w = self.points[i];
                let pole = self.points[j];
                for c in 0..functions {
                    let f = self.values[i][c];
                    let g = self.values[j][c];
                    let one = (f - g) / (w - pole);
                    let x = if self.is_real(j) {
                        one
                    } else {
                        let other = (f - g.conj()) / (w - pole.conj());
                        if imaginary {
                            C::new(0.0, 1.0) * (one - other)
                        } else {
                            one + other
                        }
                    };
                    let row = 2 * (k * functions + c);
                    loewner[(row, column)] = x.re;
                    loewner[(row + 1, column)] = x.im;
                }
            }
        }
        let triangle = loewner.qr().r();
        let svd = triangle.svd(false, true);
        let Some(vt) = svd.v_t else { return false };
        let smallest = (0..svd.singular_values.len())
            .min_by(|&a, &b| svd.singular_values[a].total_cmp(&svd.singular_values[b]))
            .unwrap_or(0);
        let mut solution = vt
            .row(smallest)
            .iter()
            .copied()
            .collect::<Vec<f64>>()
            .into_iter();
        let mut next = || solution.next().unwrap_or(0.0);
        self.weights = self
            .support
            .iter()
            .map(|&j| {
                let real = next();
                C::new(real, if self.is_real(j) { 0.0 } else { next() })
            })
            .collect();
        self.evaluate(&free);
        true
    }

    /// Each support point with its weight, values, and the conjugates.
    fn nodes(&self) -> impl Iterator<Item = (C, C, usize, bool)> + '_ {
        self.support
            .iter()
            .zip(&self.weights)
            .flat_map(|(&j, &weight)| {
                let mirror =
                    (!self.is_real(j)).then_some((self.points[j].conj(), weight.conj(), j, true));
                std::iter::once((self.points[j], weight, j, false)).chain(mirror)
            })
    }

    fn evaluate(&mut self, free: &[usize]) {
        let functions = self.values[0].len();
        let mut approximation = std::mem::take(&mut self.approximation);
        for &j in &self.support {
            approximation[j].copy_from_slice(&self.values[j]);
        }
        for &i in free {
            let mut above = vec![C::default(); functions];
            let mut below = C::default();
            for (pole, weight, j, mirrored) in self.nodes() {
                let factor = weight / (self.points[i] - pole);
                below += factor;
                for (sum, f) in above.iter_mut().zip(&self.values[j]) {
                    *sum += factor * if mirrored { f.conj() } else { *f };
                }
            }
            for (r, sum) in approximation[i].iter_mut().zip(above) {
                *r = sum / below;
            }
        }
        self.approximation = approximation;
    }

    /// λ = 1/pole of the decaying exponentials with Im λ ≥ 0.
    ///
    /// Poles are the zeros of Σ β_j/(w − w_j): with S = Σ β_j the eigenvalues other than 0 of diag(w) − 1 (β w)ᵀ/S.
    pub(super) fn decays(&self) -> Vec<C> {
        let nodes: Vec<(C, C)> = self.nodes().map(|(w, weight, ..)| (w, weight)).collect();
        let sum: C = nodes.iter().map(|(_, weight)| weight).sum();
        let matrix = DMatrix::from_fn(nodes.len(), nodes.len(), |row, column| {
            let (w, weight) = nodes[column];
            let diagonal = if row == column { w } else { C::default() };
            diagonal - weight * w / sum
        });
        let zeros = eigenvalues(matrix);
        // The eigenvalue 0 is no pole.
        zeros
            .into_iter()
            .filter(|w| w.norm() > 1e-3)
            .map(|w| w.inv())
            .filter(|decay| decay.norm() < 1.0 && decay.im >= -1e-12)
            .map(|decay| C::new(decay.re, decay.im.max(0.0)))
            .collect()
    }
}
