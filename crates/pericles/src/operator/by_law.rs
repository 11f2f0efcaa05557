//! From a pair law and a dimension that are known when the program runs to code that is compiled for them.

use super::fast_law::FastLaw;
use crate::error::{PericlesError, Result};
use crate::material::{
    BondStretch, CubicLaw, GreenBond, LinearBond, LiteralBond, PairLaw, SecondOrder, Trapezoidal,
    Treated, Treatment,
};

/// Something that is made for a pair law `L` in `D` dimensions.
pub trait ByLaw: Sized {
    /// What is made.
    type Output;

    /// Makes it.
    ///
    /// # Errors
    /// Those of the maker.
    fn of_law<L: FastLaw, const D: usize>(self) -> Result<Self::Output>;
}

/// Makes something for a pair law in 1, 2 or 3 dimensions: the one place that joins the names of laws with their implementations.
///
/// # Errors
/// [`PericlesError::WrongDimension`] for a law that is not defined in this dimension; those of the maker.
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
        (PairLaw::Literal57, 1) => maker.of_law::<LiteralBond, 1>(),
        (PairLaw::Treated(law, treatment), 1) => match (law, treatment) {
            (CubicLaw::GreenStrain, Treatment::SecondOrder) => {
                maker.of_law::<Treated<GreenBond, SecondOrder>, 1>()
            }
            (CubicLaw::GreenStrain, Treatment::Trapezoidal) => {
                maker.of_law::<Treated<GreenBond, Trapezoidal>, 1>()
            }
            (CubicLaw::Literal57, Treatment::SecondOrder) => {
                maker.of_law::<Treated<LiteralBond, SecondOrder>, 1>()
            }
            (CubicLaw::Literal57, Treatment::Trapezoidal) => {
                maker.of_law::<Treated<LiteralBond, Trapezoidal>, 1>()
            }
        },
        (PairLaw::Treated(..), dimension) => Err(PericlesError::WrongDimension {
            what: "a treatment of a nonlinear law",
            needed: "1",
            dimension,
        }),
        (PairLaw::Literal57, dimension) => Err(PericlesError::WrongDimension {
            what: "the law of equation 57 as printed",
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
