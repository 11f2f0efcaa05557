//! Arrays of a solid on a lattice read by the loops.

use crate::lanes::{LANES, Lanes};
use crate::neighbourhood::Chunk;
use crate::neighbourhood::Stencil;

/// A bond of the stencil of a solid.
#[derive(Debug, Clone, Copy)]
pub(super) struct SolidOffset<const D: usize> {
    /// Distance in places of a padded array from a node to its neighbour.
    pub shift: isize,
    /// ξ, m.
    pub xi: [f64; D],
    /// 1/|ξ|², m⁻².
    pub inverse_square: f64,
    /// ω = w b V, m³.
    pub weight: f64,
    /// ω |ξ|², m⁵.
    pub weighted_square: f64,
}

/// Padded rows (see [`GridLayout`](crate::neighbourhood::GridLayout)) read by the loops.
#[derive(Clone, Copy)]
pub(super) struct Arrays<'a, const D: usize> {
    pub offsets: &'a [SolidOffset<D>],
    /// Displacement, or another vector.
    pub u: [&'a [f64]; D],
    /// p = A θ/m, or its change; not read by the pass over points.
    pub pressure: &'a [f64],
    /// s = B/m.
    pub stiffness: &'a [f64],
    /// Number of unused places before the first row.
    pub margin: usize,
}

/// Eight bonds of one offset.
pub(super) struct Bonds<T, const D: usize> {
    pub xi: [T; D],
    pub eta: [T; D],
    pub inverse_square: T,
}

/// Returns the offsets of a stencil with the influence function w as a function of ξ, m.
pub(super) fn solid_offsets<const D: usize>(
    stencil: &Stencil,
    influence: &dyn Fn([f64; 3]) -> f64,
) -> Vec<SolidOffset<D>> {
    let offset = |k: usize| {
        let (xi, length) = (stencil.vectors()[k], stencil.lengths()[k]);
        let weight = influence(xi) * stencil.volumes()[k];
        SolidOffset {
            shift: stencil.shifts()[k],
            xi: std::array::from_fn(|c| xi[c]),
            inverse_square: 1.0 / (length * length),
            weight,
            weighted_square: weight * (length * length),
        }
    };
    (0..stencil.len()).map(offset).collect()
}

impl<'a, const D: usize> Arrays<'a, D> {
    /// Returns arrays of equal length, so that the compiler needs one bounds check for all of them.
    #[inline(always)]
    pub fn alike(&self) -> Self {
        let length = self.u[0].len();
        let mut u = self.u;
        for c in 0..D {
            u[c] = &self.u[c][..length];
        }
        Self {
            u,
            pressure: &self.pressure[..length],
            stiffness: &self.stiffness[..length],
            ..*self
        }
    }

    /// Returns the place of the first node of a chunk in the arrays.
    #[inline(always)]
    pub fn place(&self, chunk: &Chunk) -> usize {
        self.margin + chunk.place as usize * LANES
    }

    #[inline(always)]
    pub fn here<T: Lanes>(&self, place: usize) -> [T; D] {
        let mut here = [T::splat(0.0); D];
        for c in 0..D {
            here[c] = T::load(self.u[c], place);
        }
        here
    }

    /// Returns the difference of the vectors at both ends of the bonds of an offset.
    #[inline(always)]
    pub fn eta<T: Lanes>(&self, place: usize, shift: isize, here: &[T; D]) -> [T; D] {
        let there = place.wrapping_add_signed(shift);
        let mut eta = *here;
        for c in 0..D {
            eta[c] = T::load(self.u[c], there) - here[c];
        }
        eta
    }

    /// Returns the bonds of an offset.
    #[inline(always)]
    pub fn bonds<T: Lanes>(
        &self,
        place: usize,
        offset: &SolidOffset<D>,
        here: &[T; D],
    ) -> Bonds<T, D> {
        let mut xi = *here;
        for c in 0..D {
            xi[c] = T::splat(offset.xi[c]);
        }
        Bonds {
            xi,
            eta: self.eta(place, offset.shift, here),
            inverse_square: T::splat(offset.inverse_square),
        }
    }

    /// Returns η of a bond.
    pub fn difference(&self, place: usize, shift: isize) -> [f64; D] {
        let there = place.wrapping_add_signed(shift);
        std::array::from_fn(|c| self.u[c][there] - self.u[c][place])
    }
}
