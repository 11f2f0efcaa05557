//! Largest stress of a homogeneous deformation that grows from zero.

use super::fan::{Fan, Tensor};
use super::root::peak;
use crate::material::SofteningCurve;

/// A loading: the strain grows along one tensor, while the stresses along others vanish.
#[derive(Debug, Clone)]
pub(super) struct Loading {
    /// The given part of the strain per unit of load.
    pub driven: Tensor,
    /// Parts of the strain that follow from vanishing stresses σ : M.
    pub free: Vec<Tensor>,
}

/// The bonds of a point under a loading. Stretches and stresses are linear in the coefficients of the tensors:
/// s = Σ_k p_k x_k with p_k = n·M_k n, and the stress along tensor k is Σ w g(s) p_k over the directions.
pub(super) struct Loaded {
    weights: Vec<f64>,
    projections: Vec<f64>,
    /// Number of tensors.
    count: usize,
    /// D : D of the driven tensor D.
    square: f64,
}

/// Coefficients of the tensors, the driven one first.
type Coefficients = Vec<f64>;

impl Loaded {
    pub fn new(fan: &Fan, loading: &Loading) -> Self {
        let mut tensors = vec![loading.driven];
        tensors.extend(&loading.free);
        let (weights, projections) = fan.projected(&tensors);
        Self {
            weights,
            projections,
            count: tensors.len(),
            square: loading.driven.iter().flatten().map(|x| x * x).sum(),
        }
    }

    /// Returns the elastic stress over E at the load at which the first bond reaches the stretch 1.
    pub fn at_onset(&self) -> f64 {
        self.stress(&self.first(), |stretch| stretch)
    }

    /// Returns the largest stress over E along the path, σ : D/(D : D), for a curve whose onset is the stretch 1.
    ///
    /// The load grows in geometric steps; free strains follow by Newton's method from the previous step, so that the
    /// path starts at the elastic branch. The largest sample is refined by golden-section search.
    pub fn strength(&self, curve: &SofteningCurve) -> f64 {
        /// Number of steps.
        const STEPS: i32 = 160;
        /// The path ends where the stress has fallen to this fraction of its largest value.
        const FALLEN: f64 = 0.8;
        let first = self.first();
        let growth = (1.05 * curve.end()).powf(1.0 / f64::from(STEPS));
        let (mut samples, mut best) = (vec![first.clone()], 0);
        let stress_of = |at: &[f64]| self.stress(at, |stretch| curve.force(stretch));
        let mut largest = stress_of(&first);
        for step in 1..=STEPS {
            let load = first[0] * growth.powi(step);
            let Some(next) = self.follow(&samples[samples.len() - 1], load, curve) else {
                break;
            };
            let stress = stress_of(&next);
            samples.push(next);
            if stress > largest {
                (largest, best) = (stress, samples.len() - 1);
            }
            if stress < FALLEN * largest {
                break;
            }
        }
        let start = &samples[best.saturating_sub(1)];
        let end = &samples[(best + 1).min(samples.len() - 1)];
        let mut from = start.clone();
        let refined = peak(
            |load| {
                let found = self.follow(&from, load, curve);
                // Neighbouring places of the search lie closer than the samples.
                let stress = found.as_ref().map_or(0.0, |place| stress_of(place));
                if let Some(found) = found {
                    from = found;
                }
                stress
            },
            [start[0], end[0]],
        );
        refined.max(largest)
    }

    fn stretches<'a>(&'a self, at: &'a [f64]) -> impl Iterator<Item = (f64, &'a [f64], f64)> {
        let projections = self.projections.chunks_exact(self.count);
        projections.zip(&self.weights).map(move |(parts, &weight)| {
            let stretch = parts.iter().zip(at).map(|(p, x)| p * x).sum();
            (weight, parts, stretch)
        })
    }

    /// Returns the elastic state in which the largest stretch is 1.
    fn first(&self) -> Coefficients {
        let mut unit = vec![0.0; self.count];
        unit[0] = 1.0;
        let (residual, tangent) = self.equations(&unit, &|stretch| (stretch, 1.0));
        for (x, step) in unit[1..].iter_mut().zip(solved(tangent, &residual, 0.0)) {
            *x -= step;
        }
        let stretches = self.stretches(&unit).map(|(_, _, stretch)| stretch);
        let largest = stretches.fold(0.0, f64::max);
        unit.iter().map(|x| x / largest).collect()
    }

    /// Stress over E along the driven tensor, σ : D/(D : D), of bonds with the response g(s).
    fn stress(&self, at: &[f64], response: impl Fn(f64) -> f64) -> f64 {
        let terms = self
            .stretches(at)
            .map(|(weight, parts, stretch)| weight * parts[0] * response(stretch));
        terms.sum::<f64>() / self.square
    }

    /// Stresses along the free tensors and their derivatives with respect to the free coefficients, row by row.
    fn equations(&self, at: &[f64], response: &dyn Fn(f64) -> (f64, f64)) -> (Vec<f64>, Vec<f64>) {
        let free = self.count - 1;
        let (mut residual, mut tangent) = (vec![0.0; free], vec![0.0; free * free]);
        for (weight, parts, stretch) in self.stretches(at) {
            let (force, slope) = response(stretch);
            for (a, pa) in parts[1..].iter().enumerate() {
                residual[a] += weight * force * pa;
                for (b, pb) in parts[1..].iter().enumerate() {
                    tangent[a * free + b] += weight * slope * pa * pb;
                }
            }
        }
        (residual, tangent)
    }

    /// Returns the state at a load near a known one: damped Newton steps from the known state, scaled. `None` if there is
    /// no state nearby.
    fn follow(&self, known: &[f64], load: f64, curve: &SofteningCurve) -> Option<Coefficients> {
        const STEPS: usize = 60;
        const TOLERANCE: f64 = 1e-11;
        let response = |stretch| (curve.force(stretch), curve.slope(stretch));
        let mut at: Coefficients = known.iter().map(|x| x * load / known[0]).collect();
        let (mut residual, mut tangent) = self.equations(&at, &response);
        let scale: f64 = self.weights.iter().sum();
        let mut damping = 0.0;
        for _ in 0..STEPS {
            let size = norm(&residual);
            if size <= TOLERANCE * scale {
                return Some(at);
            }
            let step = solved(tangent.clone(), &residual, damping * scale);
            let mut next = at.clone();
            for (x, dx) in next[1..].iter_mut().zip(&step) {
                *x -= dx;
            }
            let (next_residual, next_tangent) = self.equations(&next, &response);
            if norm(&next_residual) < size {
                (at, residual, tangent) = (next, next_residual, next_tangent);
                damping = if damping > 1e-6 { 0.1 * damping } else { 0.0 };
            } else if damping < 1e6 {
                damping = (10.0 * damping).max(1e-6);
            } else {
                return None;
            }
        }
        None
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |norm, x| norm.max(x.abs()))
}

/// Returns the least-squares solution of K x = r with the damping μ (Levenberg and Marquardt): (KᵀK + μ²) x = Kᵀ r. K is
/// small and square; directions in which it is singular are left out.
fn solved(matrix: Vec<f64>, right: &[f64], damping: f64) -> Vec<f64> {
    let n = right.len();
    let mut rows: Vec<Vec<f64>> = (0..n)
        .map(|a| {
            let product = |b: usize| {
                (0..n)
                    .map(|k| matrix[k * n + a] * matrix[k * n + b])
                    .sum::<f64>()
            };
            let mut row: Vec<f64> = (0..n).map(product).collect();
            row[a] += damping * damping;
            row.push((0..n).map(|k| matrix[k * n + a] * right[k]).sum());
            row
        })
        .collect();
    let largest = (0..n).map(|a| rows[a][a]).fold(0.0, f64::max);
    // Gauss–Jordan elimination with diagonal pivots, sufficient for a positive semi-definite matrix.
    for a in 0..n {
        if rows[a][a] <= 1e-28 * largest {
            rows.iter_mut().for_each(|row| row[a] = 0.0);
            rows[a].fill(0.0);
            rows[a][a] = 1.0;
            continue;
        }
        let pivot = rows[a].clone();
        let others = rows.iter_mut().enumerate().filter(|(b, _)| *b != a);
        for (_, row) in others {
            let factor = row[a] / pivot[a];
            row.iter_mut()
                .zip(&pivot)
                .for_each(|(x, p)| *x -= factor * p);
        }
    }
    (0..n).map(|a| rows[a][n] / rows[a][a]).collect()
}
