//! Keys of bond-based materials.

use pericles::material::{Approximation, CubicLaw, Modulus, PairLaw, SurfaceCorrection};
use pericles_deck_derive::{DeckTable, DeckWords};

use super::scope::{BAR, MaterialScope};

/// Elastic constants of a bond-based material.
#[derive(DeckTable)]
#[deck(scope = MaterialScope<'s>)]
pub(super) struct BondKeys {
    #[deck(flatten, scope = scope.state())]
    pub(super) modulus: Modulus,
    /// Poisson's ratio ν. state-based, correspondence: free. Bond-based: if given, it must be the value that bond-based models
    /// have: 1/3 in plane stress, 1/4 in plane strain and 3D. Not for bars.
    #[deck(quantity = Number, accept = ratio, forbid_if(scope.is_bar(), BAR))]
    poisson_ratio: Option<f64>,
    /// Stiffening of bonds near free surfaces, where bonds are missing. `volume`: one factor per point from the missing volume
    /// within its horizon; `energy`: direction-dependent factors from the energy in uniaxial tension along three axes that
    /// follow the surface; `ghosts`: families completed by ghost points in the free cells of the lattice, whose displacements
    /// are extrapolated from those of the body, for bodies on a lattice whose bonds do not break. state-based: `none`,
    /// `energy`, which corrects the deviatoric stiffness, or `ghosts`; `volume` is rejected because the weighted volume already
    /// accounts for missing bonds.
    #[deck(
        default,
        otherwise = "the shape tensor of a correspondence material already accounts for missing bonds near free surfaces"
    )]
    pub(super) surface_correction: SurfaceCorrection,
}

fn ratio(ratio: &f64, scope: MaterialScope<'_>) -> pericles::Result<()> {
    match scope.state() {
        Some(state) => state.check_poisson_ratio(*ratio),
        None => Ok(()),
    }
}

/// Approximation of a cubic law.
#[derive(DeckTable)]
pub(super) struct CubicKeys {
    /// green-strain and cubic-softening on bars: approximation of the force law in the relative displacement. `exact` and
    /// `taylor-3`: the law itself, a cubic polynomial; `taylor-1`, `taylor-2`: Taylor polynomials of lower order;
    /// `trapezoidal`: mean of the tangents in the reference and the current configuration.
    #[deck(default = Given::Exact)]
    approximation: Given,
}

#[derive(Debug, Clone, Copy, PartialEq, DeckWords)]
#[deck(what = "approximation")]
enum Given {
    Exact,
    #[deck(word = "taylor-1")]
    First,
    #[deck(word = "taylor-2")]
    Second,
    #[deck(word = "taylor-3")]
    Third,
    Trapezoidal,
}

impl CubicKeys {
    /// Returns the approximation of a law.
    pub(super) fn law(self, law: CubicLaw) -> PairLaw {
        match self.approximation {
            // The law is a cubic polynomial.
            Given::Exact | Given::Third => match law {
                CubicLaw::GreenStrain => PairLaw::GreenStrain,
                CubicLaw::CubicSoftening => PairLaw::CubicSoftening,
            },
            Given::First => PairLaw::Linear,
            Given::Second => PairLaw::Approximated(law, Approximation::SecondOrder),
            Given::Trapezoidal => PairLaw::Approximated(law, Approximation::Trapezoidal),
        }
    }
}
