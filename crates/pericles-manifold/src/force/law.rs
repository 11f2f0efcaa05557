//! Pair laws of surface bonds: powers of the relative displacement.

use pericles::lanes::{Lanes, dot, vector};

/// The map r ↦ r^(p−2), evaluated from r².
pub trait Exponent: Copy + Send + Sync + 'static {
    /// The exponent p.
    fn p(self) -> f64;
    /// Returns r^(p−2) from r²; zero or one at r = 0.
    fn factor<T: Lanes>(self, square: T) -> T;
}

/// Integer and half-integer exponents p − 2 = 2 · SQUARES + ROOTS/2 with ROOTS from 0 to 3, by square roots and
/// products only.
#[derive(Debug, Clone, Copy, Default)]
pub struct HalfInteger<const ROOTS: usize, const SQUARES: usize>;

/// Any exponent p ≥ 2, by the power function.
#[derive(Debug, Clone, Copy)]
pub struct AnyExponent(pub f64);

impl<const ROOTS: usize, const SQUARES: usize> Exponent for HalfInteger<ROOTS, SQUARES> {
    #[inline(always)]
    fn p(self) -> f64 {
        2.0 + 0.5 * ROOTS as f64 + 2.0 * SQUARES as f64
    }

    #[inline(always)]
    fn factor<T: Lanes>(self, square: T) -> T {
        let mut factor = match ROOTS {
            0 => T::splat(1.0),
            1 => square.sqrt().sqrt(),
            2 => square.sqrt(),
            _ => {
                let root = square.sqrt();
                root * root.sqrt()
            }
        };
        for _ in 0..SQUARES {
            factor = factor * square;
        }
        factor
    }
}

impl Exponent for AnyExponent {
    #[inline(always)]
    fn p(self) -> f64 {
        self.0
    }

    #[inline(always)]
    fn factor<T: Lanes>(self, square: T) -> T {
        let mut numbers = square.to_array();
        let half = 0.5 * self.0 - 1.0;
        for number in &mut numbers {
            *number = if *number > 0.0 {
                number.powf(half)
            } else {
                0.0
            };
        }
        T::load(&numbers, 0)
    }
}

/// Force of a surface bond per unit weight as a function of the relative displacement η and, if needed, the
/// reference chord ξ.
pub trait SurfaceLaw: Copy + Send + Sync + 'static {
    /// True if the law uses ξ.
    const CHORD: bool;
    /// Returns true if the force is linear in η.
    fn is_linear(self) -> bool;
    /// Force on the point at which the bond starts.
    fn force<T: Lanes>(self, xi: [T; 3], eta: [T; 3]) -> [T; 3];
    /// Energy, whose gradient with respect to η is the force.
    fn energy<T: Lanes>(self, xi: [T; 3], eta: [T; 3]) -> T;
    /// Derivative of the force in the direction d.
    fn tangent<T: Lanes>(self, xi: [T; 3], eta: [T; 3], d: [T; 3]) -> [T; 3];
    /// Largest eigenvalue of the tangent of an undeformed bond.
    fn stiffness_at_rest(self) -> f64;
}

/// |η|^(p−2) η: the force follows the difference of displacements (Coclite, Coclite, Maddalena, Politi 2022, equation 2.6). Rigid rotations change the energy.
#[derive(Debug, Clone, Copy)]
pub struct DisplacementBond<E>(pub E);

/// |e|^(p−2) e n with e = |ξ+η| − |ξ| and n along ξ+η: the force follows the elongation of the chord. Invariant under rigid motions.
#[derive(Debug, Clone, Copy)]
pub struct ChordBond<E>(pub E);

/// Keeps quotients finite for bonds of zero length (padding, whose weight is zero).
#[inline(always)]
fn nonzero<T: Lanes>(x: T) -> T {
    x.max(T::splat(f64::MIN_POSITIVE))
}

impl<E: Exponent> SurfaceLaw for DisplacementBond<E> {
    const CHORD: bool = false;

    #[inline(always)]
    fn is_linear(self) -> bool {
        self.0.p() == 2.0
    }

    #[inline(always)]
    fn force<T: Lanes>(self, _xi: [T; 3], eta: [T; 3]) -> [T; 3] {
        let factor = self.0.factor(dot(eta, eta));
        vector(|c| factor * eta[c])
    }

    #[inline(always)]
    fn energy<T: Lanes>(self, _xi: [T; 3], eta: [T; 3]) -> T {
        let square = dot(eta, eta);
        self.0.factor(square) * square * T::splat(1.0 / self.0.p())
    }

    #[inline(always)]
    fn tangent<T: Lanes>(self, _xi: [T; 3], eta: [T; 3], d: [T; 3]) -> [T; 3] {
        let square = dot(eta, eta);
        let factor = self.0.factor(square);
        let along = T::splat(self.0.p() - 2.0) * factor * (dot(eta, d) / nonzero(square));
        vector(|c| factor * d[c] + along * eta[c])
    }

    fn stiffness_at_rest(self) -> f64 {
        if self.is_linear() { 1.0 } else { 0.0 }
    }
}

/// Returns (elongation e, deformed chord y, |y|).
#[inline(always)]
fn elongation<T: Lanes>(xi: [T; 3], eta: [T; 3]) -> (T, [T; 3], T) {
    let y: [T; 3] = vector(|c| xi[c] + eta[c]);
    let rest = dot(xi, xi).sqrt();
    let length = dot(y, y).sqrt();
    // |y|² − |ξ|² without cancellation.
    let growth = dot(eta, vector(|c| xi[c] + xi[c] + eta[c]));
    (growth / nonzero(length + rest), y, nonzero(length))
}

impl<E: Exponent> SurfaceLaw for ChordBond<E> {
    const CHORD: bool = true;

    fn is_linear(self) -> bool {
        false
    }

    #[inline(always)]
    fn force<T: Lanes>(self, xi: [T; 3], eta: [T; 3]) -> [T; 3] {
        let (e, y, length) = elongation(xi, eta);
        let factor = self.0.factor(e * e) * e / length;
        vector(|c| factor * y[c])
    }

    #[inline(always)]
    fn energy<T: Lanes>(self, xi: [T; 3], eta: [T; 3]) -> T {
        let (e, ..) = elongation(xi, eta);
        self.0.factor(e * e) * e * e * T::splat(1.0 / self.0.p())
    }

    #[inline(always)]
    fn tangent<T: Lanes>(self, xi: [T; 3], eta: [T; 3], d: [T; 3]) -> [T; 3] {
        let (e, y, length) = elongation(xi, eta);
        let factor = self.0.factor(e * e);
        let across = factor * e / length;
        let along = (T::splat(self.0.p() - 1.0) * factor - across) * (dot(y, d) / length) / length;
        vector(|c| across * d[c] + along * y[c])
    }

    fn stiffness_at_rest(self) -> f64 {
        if self.0.p() == 2.0 { 1.0 } else { 0.0 }
    }
}
