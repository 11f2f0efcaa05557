//! Approximations of cubic pair forces about the reference configuration.

use std::marker::PhantomData;

use super::pair_force::PairForce;
use super::polynomial::{CubicSofteningBond, GreenBond};
use crate::lanes::{Real, dot, vector};

/// Approximation of a force f = f₁ + f₂ + f₃ with terms of first to third order in the relative displacement η.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Approximation {
    /// Second-order Taylor polynomial about the reference configuration, f₁ + f₂.
    SecondOrder,
    /// Trapezoidal rule for f = ∫₀^η f′ dη: ½ [f′(0) + f′(η)] η = f₁ + f₂ + 3/2 f₃.
    Trapezoidal,
}

/// A pair force whose cubic term is `CUBIC` |η|² η/|ξ|³.
pub trait CubicBond: PairForce {
    /// Coefficient of the cubic term.
    const CUBIC: f64;
}

impl CubicBond for GreenBond {
    const CUBIC: f64 = 0.5;
}

impl CubicBond for CubicSofteningBond {
    const CUBIC: f64 = 1.0;
}

/// Type-level counterpart of [`Approximation`].
pub trait CubicFactor: Copy + Default + Send + Sync + 'static {
    /// Factor of f₃.
    const FACTOR: f64;
}

/// [`Approximation::SecondOrder`].
#[derive(Debug, Clone, Copy, Default)]
pub struct SecondOrder;

/// [`Approximation::Trapezoidal`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Trapezoidal;

impl CubicFactor for SecondOrder {
    const FACTOR: f64 = 0.0;
}

impl CubicFactor for Trapezoidal {
    const FACTOR: f64 = 1.5;
}

/// f₁ + f₂ + κ f₃ of a cubic law, with a relative error of O(|η|²). The approximation is conservative: every
/// term is a gradient (Euler's theorem on homogeneous functions).
///
/// Source: Coclite et al., Appl. Numer. Math. 155 (2020), section 7. Two misprints are corrected: the missing
/// Taylor coefficients 1/i! and the factor η − s of the integral form.
#[derive(Debug, Clone, Copy, Default)]
pub struct Approximated<L, T>(PhantomData<(L, T)>);

impl<L: CubicBond, T: CubicFactor> Approximated<L, T> {
    /// (κ − 1) CUBIC/|ξ|³
    #[inline(always)]
    fn excess<N: Real, const D: usize>(xi: [N; D]) -> N {
        let square = dot(xi, xi);
        N::splat((T::FACTOR - 1.0) * L::CUBIC) / (square * square.sqrt())
    }
}

impl<L: CubicBond, T: CubicFactor> PairForce for Approximated<L, T> {
    const LINEAR: bool = false;

    #[inline(always)]
    fn force<N: Real, const D: usize>(xi: [N; D], eta: [N; D]) -> [N; D] {
        let whole = L::force(xi, eta);
        let more = Self::excess(xi) * dot(eta, eta);
        vector(|c| whole[c] + more * eta[c])
    }

    #[inline(always)]
    fn energy<N: Real, const D: usize>(xi: [N; D], eta: [N; D]) -> N {
        let square = dot(eta, eta);
        L::energy(xi, eta) + N::splat(0.25) * Self::excess(xi) * square * square
    }

    #[inline(always)]
    fn tangent<N: Real, const D: usize>(xi: [N; D], eta: [N; D], d: [N; D]) -> [N; D] {
        let whole = L::tangent(xi, eta, d);
        let excess = Self::excess(xi);
        let across = excess * dot(eta, eta);
        let along = N::splat(2.0) * excess * dot(eta, d);
        vector(|c| whole[c] + across * d[c] + along * eta[c])
    }

    #[inline(always)]
    fn stretch_measure<N: Real, const D: usize>(xi: [N; D], eta: [N; D]) -> (N, N) {
        L::stretch_measure(xi, eta)
    }

    fn threshold(stretch: f64) -> f64 {
        L::threshold(stretch)
    }

    #[inline(always)]
    fn stretch<N: Real>(t: N) -> N {
        L::stretch(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sum::max_norm;

    /// ½ [f′(0) + f′(η)] η
    fn rule<L: PairForce>(xi: [f64; 3], eta: [f64; 3]) -> [f64; 3] {
        let (rest, place) = (L::tangent(xi, [0.0; 3], eta), L::tangent(xi, eta, eta));
        std::array::from_fn(|c| 0.5 * (rest[c] + place[c]))
    }

    fn check_definitions_and_orders<L: CubicBond>(xi: [f64; 3], direction: [f64; 3]) {
        let scaled = |size: f64| direction.map(|x| size * x);
        let minus = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { std::array::from_fn(|c| a[c] - b[c]) };
        let eta = scaled(0.3);
        let trapezoidal = Approximated::<L, Trapezoidal>::force(xi, eta);
        assert!(max_norm(&minus(trapezoidal, rule::<L>(xi, eta))) < 1e-14);
        // The remainder of the Taylor polynomial is f₃, homogeneous of third order.
        let rest = |size: f64| {
            let eta = scaled(size);
            max_norm(&minus(
                L::force(xi, eta),
                Approximated::<L, SecondOrder>::force(xi, eta),
            ))
        };
        assert!((rest(0.4) / rest(0.2) - 8.0).abs() < 1e-11);
        let linear = |size: f64| {
            let eta = scaled(size);
            let first = L::tangent(xi, [0.0; 3], eta);
            max_norm(&minus(
                Approximated::<L, SecondOrder>::force(xi, eta),
                first,
            ))
        };
        assert!((linear(0.4) / linear(0.2) - 4.0).abs() < 1e-11);
    }

    #[test]
    fn approximations_of_both_cubic_laws_follow_their_definitions() {
        let (xi, d) = ([0.6, -0.3, 0.5], [0.4, 0.7, -0.2]);
        check_definitions_and_orders::<GreenBond>(xi, d);
        check_definitions_and_orders::<CubicSofteningBond>(xi, d);
    }
}
