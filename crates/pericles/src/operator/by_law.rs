//! Dispatch from a pair law and a dimension known at run time to code compiled for them.

use super::fast_law::VectorLaw;
use crate::error::{PericlesError, Result};
use crate::material::{
    Approximated, Approximation, BondStretch, CubicLaw, CubicSofteningBond, GreenBond, LinearBond,
    PairLaw, SecondOrder, Trapezoidal,
};

/// A constructor that is generic over the pair law `L` and the dimension `D`.
pub trait ByLaw: Sized {
    /// Type of the result.
    type Output;

    /// Constructs the result for a pair law and a dimension.
    ///
    /// # Errors
    /// Errors of the constructor.
    fn of_law<L: VectorLaw, const D: usize>(self) -> Result<Self::Output>;
}

/// Calls a generic constructor for a pair law in 1, 2 or 3 dimensions. This is the only mapping from names of
/// laws to implementations.
///
/// # Errors
/// [`PericlesError::WrongDimension`] for a law that is not defined in this dimension; errors of the
/// constructor.
pub fn by_law<M: ByLaw>(law: PairLaw, dimension: usize, maker: M) -> Result<M::Output> {
    match (law, dimension) {
        (PairLaw::Linear, 1) => maker.of_law::<LinearBond, 1>(),
        (PairLaw::Linear, 2) => maker.of_law::<LinearBond, 2>(),
        (PairLaw::Linear, 3) => maker.of_law::<LinearBond, 3>(),
        (PairLaw::BondStretch, 1) => maker.of_law::<BondStretch, 1>(),
        (PairLaw::BondStretch, 2) => maker.of_law::<BondStretch, 2>(),
        (PairLaw::BondStretch, 3) => maker.of_law::<BondStretch, 3>(),
        (PairLaw::GreenStrain, 1) => maker.of_law::<GreenBond, 1>(),
        (PairLaw::GreenStrain, 2) => maker.of_law::<GreenBond, 2>(),
        (PairLaw::GreenStrain, 3) => maker.of_law::<GreenBond, 3>(),
        (PairLaw::CubicSoftening, 1) => maker.of_law::<CubicSofteningBond, 1>(),
        (PairLaw::Approximated(law, approximation), 1) => match (law, approximation) {
            (CubicLaw::GreenStrain, Approximation::SecondOrder) => {
                maker.of_law::<Approximated<GreenBond, SecondOrder>, 1>()
            }
            (CubicLaw::GreenStrain, Approximation::Trapezoidal) => {
                maker.of_law::<Approximated<GreenBond, Trapezoidal>, 1>()
            }
            (CubicLaw::CubicSoftening, Approximation::SecondOrder) => {
                maker.of_law::<Approximated<CubicSofteningBond, SecondOrder>, 1>()
            }
            (CubicLaw::CubicSoftening, Approximation::Trapezoidal) => {
                maker.of_law::<Approximated<CubicSofteningBond, Trapezoidal>, 1>()
            }
        },
        (PairLaw::Approximated(..), dimension) => Err(PericlesError::WrongDimension {
            what: "an approximation of a cubic pair law",
            needed: "1",
            dimension,
        }),
        (PairLaw::CubicSoftening, dimension) => Err(PericlesError::WrongDimension {
            what: "the cubic softening law",
            needed: "1",
            dimension,
        }),
        (_, dimension) => Err(PericlesError::WrongDimension {
            what: "a bond-based material",
            needed: "1, 2 or 3",
            dimension,
        }),
    }
}
