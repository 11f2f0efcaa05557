//! User-defined pair laws.

use super::fast_law::VectorLaw;
use super::{AssembledBonds, BondForm, CompositeBody};
use crate::error::{PericlesError, Result};
use crate::lanes::Real;
use crate::material::PairForce;

/// Adapter for a pair law in the loops of lists and grids, without a faster form for small strains.
///
/// For a faster form, implement [`VectorLaw`] for the law.
#[derive(Debug, Clone, Copy, Default)]
pub struct PlainLaw<L>(std::marker::PhantomData<L>);

impl<L: PairForce> PairForce for PlainLaw<L> {
    const LINEAR: bool = L::LINEAR;
    const OF_STRETCH: bool = L::OF_STRETCH;

    #[inline(always)]
    fn force<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> [T; D] {
        L::force(xi, eta)
    }

    #[inline(always)]
    fn energy<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> T {
        L::energy(xi, eta)
    }

    #[inline(always)]
    fn tangent<T: Real, const D: usize>(xi: [T; D], eta: [T; D], d: [T; D]) -> [T; D] {
        L::tangent(xi, eta, d)
    }

    #[inline(always)]
    fn stretch_measure<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> (T, T) {
        L::stretch_measure(xi, eta)
    }

    fn threshold(stretch: f64) -> f64 {
        L::threshold(stretch)
    }

    #[inline(always)]
    fn stretch<T: Real>(t: T) -> T {
        L::stretch(t)
    }
}

impl<L: PairForce> VectorLaw for PlainLaw<L> {}

impl CompositeBody<'_> {
    /// Returns the operator with a user-defined pair law instead of the law of the material, with any kernel
    /// that supports the body.
    ///
    /// # Errors
    /// Errors of [`CompositeBody::operator`].
    pub fn operator_of_law<L: PairForce>(&self, form: BondForm) -> Result<AssembledBonds> {
        match self.body.cloud.dimension() {
            1 => self.operator_of::<PlainLaw<L>, 1>(form),
            2 => self.operator_of::<PlainLaw<L>, 2>(form),
            3 => self.operator_of::<PlainLaw<L>, 3>(form),
            dimension => Err(PericlesError::WrongDimension {
                what: "a bond-based material",
                needed: "1, 2 or 3",
                dimension,
            }),
        }
    }
}
