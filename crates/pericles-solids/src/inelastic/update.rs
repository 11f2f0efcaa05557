//! Constitutive updates: viscous relaxation over a step and return to the yield surface.

use super::law::{MOST_TERMS, ViscousTerm, Yield};

/// Factors of the update of back-stretches for a stretch that changes linearly over a time dt:
///
/// ψ_k' = q_k ψ_k + (1 − q_k) h + β_k (h' − h), q = exp(−dt/τ), β = 1 − (τ/dt)(1 − q), with the driving
/// stretches h and h' at the start and end of the step. This is the exact solution.
#[derive(Clone, Copy)]
pub(super) struct Relaxation {
    /// Number of terms.
    pub terms: usize,
    /// λ_k
    pub share: [f64; MOST_TERMS],
    /// 1 − q_k
    pub gain: [f64; MOST_TERMS],
    /// β_k
    pub slope: [f64; MOST_TERMS],
}

impl Relaxation {
    /// Creates the factors of viscous terms over a time dt; without change for dt = 0.
    pub fn new(terms: &[ViscousTerm], dt: f64) -> Self {
        let zero = [0.0; MOST_TERMS];
        let mut of = Self {
            terms: terms.len(),
            share: zero,
            gain: zero,
            slope: zero,
        };
        for (k, term) in terms.iter().enumerate() {
            let ratio = dt / term.time;
            of.share[k] = term.share;
            of.gain[k] = -(-ratio).exp_m1();
            of.slope[k] = slope(ratio);
        }
        of
    }

    /// Returns Σ λ_k β_k, the fraction of a change of stretch within the step that has relaxed at its end.
    pub fn relaxed(&self) -> f64 {
        (0..self.terms).map(|k| self.share[k] * self.slope[k]).sum()
    }
}

/// Returns β = 1 − (1 − e^−a)/a.
fn slope(a: f64) -> f64 {
    if a < 1e-3 {
        // The series avoids cancellation; the next term is below 1e-16 of the first.
        return a * (0.5 - a * (1.0 / 6.0 - a * (1.0 / 24.0 - a * (1.0 / 120.0 - a / 720.0))));
    }
    1.0 + (-a).exp_m1() / a
}

/// Returns c of [`Yield`]: ε_p² = c Σ ω e_p²/m of the plastic extensions e_p of a uniform plastic strain.
pub(super) const fn mean_square(dimension: usize) -> f64 {
    match dimension {
        3 => 5.0,
        _ => 8.0 / 3.0,
    }
}

/// Trial deviatoric force state, which may lie outside the yield surface.
#[derive(Clone, Copy)]
pub(super) struct Trial {
    /// √(2 ψ₀), the norm at first yield.
    pub strength: f64,
    /// Accumulated equivalent plastic strain.
    pub strain: f64,
    /// Norm |t| of the trial state.
    pub norm: f64,
    /// Equivalent strain of its deviatoric extensions; the equivalent strain of the plastic flow is 1 − γ times this value.
    pub equivalent: f64,
}

impl Trial {
    /// Returns the norm at the yield surface before the step.
    fn limit(&self, law: &Yield) -> f64 {
        self.strength * (1.0 + law.hardening * self.strain / law.stress)
    }

    /// Returns √(2 ψ₀) H E/σ_y with the equivalent strain E: the growth of the yield surface if the whole
    /// deviatoric extension becomes plastic.
    fn growth(&self, law: &Yield) -> f64 {
        self.strength * law.hardening * self.equivalent / law.stress
    }

    /// Returns γ, the factor that returns the deviatoric force state to the yield surface of the hardened
    /// material; 1 inside the surface.
    ///
    /// γ |t| = limit + (1 − γ) growth is linear in γ, so no iteration is needed.
    pub fn factor(&self, law: &Yield) -> f64 {
        let limit = self.limit(law);
        if self.norm <= limit {
            return 1.0;
        }
        let growth = self.growth(law);
        (limit + growth) / (self.norm + growth)
    }

    /// Returns the change of γ for changes of the norm and of the equivalent strain.
    pub fn factor_change(&self, law: &Yield, norm: f64, equivalent: f64) -> f64 {
        if self.norm <= self.limit(law) {
            return 0.0;
        }
        let growth = self.strength * law.hardening * equivalent / law.stress;
        let factor = self.factor(law);
        (growth - factor * (norm + growth)) / (self.norm + self.growth(law))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slope_agrees_with_its_integral() {
        for a in [1e-12, 1e-6, 0.999_999e-3, 1.000_001e-3, 0.1, 3.0, 100.0_f64] {
            // ∫₀¹ (1 − e^−as) ds = β
            let steps = 2000;
            let value = |s: f64| -(-a * s).exp_m1();
            let simpson: f64 = (0..steps)
                .map(|k| {
                    let [from, to] = [k, k + 1].map(|k| f64::from(k) / f64::from(steps));
                    (value(from) + 4.0 * value(0.5 * (from + to)) + value(to)) * (to - from) / 6.0
                })
                .sum();
            assert!((slope(a) / simpson - 1.0).abs() < 1e-9, "{a}");
        }
        assert_eq!(slope(0.0), 0.0);
    }

    #[test]
    fn return_mapping_ends_on_the_hardened_yield_surface() {
        let law = Yield {
            stress: 2.0,
            hardening: 5.0,
        };
        let trial = Trial {
            strength: 3.0,
            strain: 0.1,
            norm: 7.0,
            equivalent: 0.4,
        };
        let factor = trial.factor(&law);
        let strain = trial.strain + (1.0 - factor) * trial.equivalent;
        let surface = trial.strength * (law.stress + law.hardening * strain) / law.stress;
        assert!((factor * trial.norm / surface - 1.0).abs() < 1e-15);
        let h = 1e-6;
        let moved = |h: f64| Trial {
            norm: trial.norm + 2.0 * h,
            equivalent: trial.equivalent - 3.0 * h,
            ..trial
        };
        let difference = (moved(h).factor(&law) - moved(-h).factor(&law)) / (2.0 * h);
        assert!((trial.factor_change(&law, 2.0, -3.0) - difference).abs() < 1e-8);
        let inside = Trial { norm: 3.0, ..trial };
        assert_eq!(inside.factor(&law), 1.0);
        assert_eq!(inside.factor_change(&law, 1.0, 1.0), 0.0);
    }
}
