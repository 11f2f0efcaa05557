//! Pair forces of bonds.

use super::approximation::Approximation;
use super::pair_force::PairForce;
use crate::lanes::{Real, dot, vector};

/// Pair force of a material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PairLaw {
    /// [`LinearBond`].
    Linear,
    /// [`BondStretch`].
    BondStretch,
    /// [`GreenBond`](super::GreenBond).
    GreenStrain,
    /// [`CubicSofteningBond`](super::CubicSofteningBond), for bars.
    CubicSoftening,
    /// [`Approximated`](super::Approximated), for bars.
    Approximated(CubicLaw, Approximation),
}

/// Laws that are cubic in the relative displacement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CubicLaw {
    /// [`GreenBond`](super::GreenBond).
    GreenStrain,
    /// [`CubicSofteningBond`](super::CubicSofteningBond).
    CubicSoftening,
}

/// s = (|ξ+η| − |ξ|)/|ξ|, n = (ξ+η)/|ξ+η|: the prototype microelastic brittle material (Silling & Askari 2005).
///
/// With q = η·(2ξ+η) the stretch is q/(|ξ| (|ξ+η| + |ξ|)), without cancellation at small strains.
#[derive(Debug, Clone, Copy, Default)]
pub struct BondStretch;

/// s = ξ·η/|ξ|², n = ξ/|ξ|: the linearisation of [`BondStretch`] about the reference configuration.
#[derive(Debug, Clone, Copy, Default)]
pub struct LinearBond;

/// (|ξ|², q, |ξ+η|, |ξ|)
#[inline(always)]
fn lengths<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> (T, T, T, T) {
    let square = dot(xi, xi);
    let q = growth(xi, eta);
    (square, q, (square + q).sqrt(), square.sqrt())
}

/// q = |ξ+η|² − |ξ|² = η·(2ξ+η)
#[inline(always)]
fn growth<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> T {
    dot(eta, vector(|c| xi[c] + xi[c] + eta[c]))
}

impl PairForce for BondStretch {
    const LINEAR: bool = false;
    const OF_STRETCH: bool = true;

    #[inline(always)]
    fn force<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> [T; D] {
        let (_, q, deformed, reference) = lengths(xi, eta);
        let factor = q / (reference * (deformed + reference) * deformed);
        vector(|c| factor * (xi[c] + eta[c]))
    }

    #[inline(always)]
    fn energy<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> T {
        let (_, q, deformed, reference) = lengths(xi, eta);
        let elongation = q / (deformed + reference);
        T::splat(0.5) * elongation * elongation / reference
    }

    #[inline(always)]
    fn tangent<T: Real, const D: usize>(xi: [T; D], eta: [T; D], d: [T; D]) -> [T; D] {
        let (square, q, deformed, reference) = lengths(xi, eta);
        let y: [T; D] = vector(|c| xi[c] + eta[c]);
        let factor = q / (reference * (deformed + reference) * deformed);
        let along = dot(y, d) / (square + q) * (T::splat(1.0) / reference - factor);
        vector(|c| factor * d[c] + along * y[c])
    }
}

impl PairForce for LinearBond {
    const LINEAR: bool = true;
    const OF_STRETCH: bool = true;

    #[inline(always)]
    fn force<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> [T; D] {
        let square = dot(xi, xi);
        let factor = dot(xi, eta) / (square * square.sqrt());
        vector(|c| factor * xi[c])
    }

    #[inline(always)]
    fn energy<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> T {
        let square = dot(xi, xi);
        let along = dot(xi, eta);
        T::splat(0.5) * along * along / (square * square.sqrt())
    }

    #[inline(always)]
    fn tangent<T: Real, const D: usize>(xi: [T; D], _eta: [T; D], d: [T; D]) -> [T; D] {
        Self::force(xi, d)
    }

    #[inline(always)]
    fn stretch_measure<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> (T, T) {
        (dot(xi, eta), dot(xi, xi))
    }

    fn threshold(stretch: f64) -> f64 {
        stretch
    }

    #[inline(always)]
    fn stretch<T: Real>(t: T) -> T {
        t
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Approximated, CubicSofteningBond, GreenBond, SecondOrder, Trapezoidal};
    use proptest::prelude::*;

    /// Definition of the bond-stretch force, with cancellation at small strains.
    fn naive(xi: [f64; 3], eta: [f64; 3]) -> [f64; 3] {
        let y: [f64; 3] = std::array::from_fn(|c| xi[c] + eta[c]);
        let (r, l) = (dot(xi, xi).sqrt(), dot(y, y).sqrt());
        std::array::from_fn(|c| (l - r) / r * y[c] / l)
    }

    fn check_gradients<L: PairForce>(xi: [f64; 3], eta: [f64; 3], d: [f64; 3]) {
        let h = 1e-5;
        let moved = |sign: f64| -> [f64; 3] { std::array::from_fn(|c| eta[c] + sign * h * d[c]) };
        let slope = (L::energy(xi, moved(1.0)) - L::energy(xi, moved(-1.0))) / (2.0 * h);
        let work = dot(L::force(xi, eta), d);
        assert!(
            (slope - work).abs() < 1e-8,
            "the force is not the gradient of the energy: {slope} {work}"
        );
        let tangent = L::tangent(xi, eta, d);
        let (up, down) = (L::force(xi, moved(1.0)), L::force(xi, moved(-1.0)));
        for c in 0..3 {
            let slope = (up[c] - down[c]) / (2.0 * h);
            assert!(
                (slope - tangent[c]).abs() < 1e-8,
                "tangent: {slope} {}",
                tangent[c]
            );
        }
    }

    proptest! {
        #[test]
        fn forces_are_energy_gradients_and_tangents_are_force_derivatives(
            xi in prop::array::uniform3(0.5f64..1.0),
            eta in prop::array::uniform3(-0.3f64..0.3),
            d in prop::array::uniform3(-1.0f64..1.0),
        ) {
            check_gradients::<BondStretch>(xi, eta, d);
            check_gradients::<LinearBond>(xi, eta, d);
            check_gradients::<GreenBond>(xi, eta, d);
            check_gradients::<CubicSofteningBond>(xi, eta, d);
            check_gradients::<Approximated<GreenBond, Trapezoidal>>(xi, eta, d);
            check_gradients::<Approximated<CubicSofteningBond, SecondOrder>>(xi, eta, d);
            let (force, expected) = (BondStretch::force(xi, eta), naive(xi, eta));
            for c in 0..3 {
                prop_assert!((force[c] - expected[c]).abs() < 1e-14);
            }
            let (measure, square) = BondStretch::stretch_measure(xi, eta);
            let y: [f64; 3] = std::array::from_fn(|c| xi[c] + eta[c]);
            let stretch = (dot(y, y) / square).sqrt() - 1.0;
            prop_assert!(measure > BondStretch::threshold(stretch - 1e-9) * square);
            prop_assert!(measure < BondStretch::threshold(stretch + 1e-9) * square);
        }
    }

    #[test]
    fn all_laws_of_a_bar_have_the_same_linearisation() {
        // In 1D the bond-stretch law is itself linear unless end points pass each other.
        let (xi, d) = ([-0.4], [0.3]);
        let linear = LinearBond::force(xi, d)[0];
        for tangent in [
            BondStretch::tangent(xi, [0.0], d),
            GreenBond::tangent(xi, [0.0], d),
            CubicSofteningBond::tangent(xi, [0.0], d),
            BondStretch::force(xi, d),
        ] {
            assert!(
                (tangent[0] / linear - 1.0).abs() < 1e-14,
                "{tangent:?} {linear}"
            );
        }
        // The cubic polynomial of equation 58.
        let (x, e) = (0.4, 0.17);
        let cubic = (2.0 * x * x * e + 3.0 * x * e * e + e * e * e) / (2.0 * x * x * x);
        assert!((GreenBond::force([x], [e])[0] / cubic - 1.0).abs() < 1e-14);
    }

    #[test]
    fn forces_at_small_strains_lose_no_digits() {
        let (xi, eta) = ([0.3, 0.4, 0.0], [3e-17, 4e-17, 0.0]);
        let force = BondStretch::force(xi, eta);
        assert!((force[0] / (0.6 * 1e-16) - 1.0).abs() < 1e-12, "{force:?}");
    }
}
