//! The forms in which forces are computed, and what they do not represent.

use pericles::Result;
use pericles::operator::{BondForm, Feature, Features, Limit};

/// How the internal forces of a body are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ForceForm {
    /// The cheapest by estimated cost.
    #[default]
    Fastest,
    /// [`BondForm::Grid`].
    Grid,
    /// [`BondForm::FloatGrid`].
    FloatGrid,
    /// [`BondForm::List`].
    List,
    /// Transforms of a linear body's kernel ([`ConvolutionForce`](crate::linear::ConvolutionForce), or [`GaussForce`](crate::linear::GaussForce) on Gauss nodes).
    Convolution,
    /// Plane waves of a periodic body ([`SpectralForce`](crate::linear::SpectralForce), [`SpectralCubicForce`](crate::linear::SpectralCubicForce)).
    Spectral,
}

/// Plane waves are independent of each other for the linear law alone.
pub(crate) const LINEAR_ONLY: &str =
    "plane waves are independent for the linear law only; use model = \"linear\"";

const PRE_CRACKS: Limit = Limit::new(
    Feature::PreCracks,
    "pre-cracks cut single bonds, which it cannot; use \"list\" or \"grid\"",
);

const TENSORS: Limit = Limit::new(
    Feature::Tensors,
    "they are sums over single bonds; use bonds = \"list\", \"grid\" or \"fastest\"",
);

const OF_CONVOLUTION: &[Limit] = &[
    Limit::STATE_BASED,
    Limit::CORRESPONDENCE,
    Limit::SEVERAL_SPACINGS,
    Limit::SEVERAL_MATERIALS,
    Limit::SURFACE_CORRECTION,
    Limit::listed_law(Feature::GreenStrainBar),
    Limit::listed_law(Feature::GreenStrain),
    Limit::listed_law(Feature::OtherCubic),
    Limit::INCLUSIONS,
    PRE_CRACKS,
    Limit::new(
        Feature::BondStretch,
        "only the linear law is a convolution; use the bond list for the bond-stretch law",
    ),
    Limit::new(
        Feature::Breaking,
        "breaking is not supported; use the bond list, or leave the critical stretch and fracture energy out",
    ),
    Limit::new(
        Feature::NoLattice,
        "it needs points on a regular grid; use the bond list for this body",
    ),
    TENSORS,
    Limit::BOND_ENERGY,
];

const FULL_BOX: &str =
    "a Fourier series needs a full box of cells (bar, plate or block without holes)";

const OF_SPECTRAL: &[Limit] = &[
    Limit::STATE_BASED,
    Limit::CORRESPONDENCE,
    Limit::SEVERAL_SPACINGS,
    Limit::SEVERAL_MATERIALS,
    Limit::SURFACE_CORRECTION,
    Limit::listed_law(Feature::GreenStrain),
    Limit::listed_law(Feature::OtherCubic),
    Limit::INCLUSIONS,
    PRE_CRACKS,
    Limit::new(
        Feature::FreeFaces,
        "Fourier series need a body whose opposite faces are one: set body.periodic = true, or use \"convolution\"",
    ),
    Limit::new(Feature::BondStretch, LINEAR_ONLY),
    Limit::new(
        Feature::Breaking,
        "bonds that break couple all plane waves; leave the critical stretch and fracture energy out",
    ),
    Limit::new(Feature::NoLattice, FULL_BOX),
    Limit::new(Feature::GaussNodes, FULL_BOX),
    TENSORS,
    Limit::BOND_ENERGY,
];

impl ForceForm {
    /// As written in decks.
    pub fn name(self) -> &'static str {
        match (self, self.of_bonds()) {
            (_, Some(bonds)) => bonds.name(),
            (Self::Spectral, None) => "spectral",
            (_, None) => "convolution",
        }
    }

    /// The form in which bonds are computed one by one; none for forms that transform.
    pub fn of_bonds(self) -> Option<BondForm> {
        match self {
            Self::Fastest => Some(BondForm::Fastest),
            Self::Grid => Some(BondForm::Grid),
            Self::FloatGrid => Some(BondForm::FloatGrid),
            Self::List => Some(BondForm::List),
            Self::Convolution | Self::Spectral => None,
        }
    }

    /// The forms that may be taken where this one is asked for.
    pub fn candidates(self) -> &'static [Self] {
        match self {
            Self::Fastest => &[Self::Grid, Self::List, Self::Convolution],
            Self::Grid => &[Self::Grid],
            Self::FloatGrid => &[Self::FloatGrid],
            Self::List => &[Self::List],
            Self::Convolution => &[Self::Convolution],
            Self::Spectral => &[Self::Spectral],
        }
    }

    /// What the form does not represent ([`BondForm::limits`]).
    pub fn limits(self) -> &'static [Limit] {
        match (self, self.of_bonds()) {
            (_, Some(bonds)) => bonds.limits(),
            (Self::Spectral, None) => OF_SPECTRAL,
            (_, None) => OF_CONVOLUTION,
        }
    }

    /// Why the form does not represent a body with these features; none if it does.
    pub fn refusal(self, features: Features) -> Option<&'static str> {
        Limit::refusal(self.limits(), features)
    }

    /// Refuses a body with features that the form does not represent.
    ///
    /// # Errors
    /// [`FormNotUsable`](pericles::PericlesError::FormNotUsable), with the reason.
    pub fn check(self, features: Features) -> Result<()> {
        Limit::check(self.limits(), self.name(), features)
    }
}

impl From<BondForm> for ForceForm {
    fn from(form: BondForm) -> Self {
        match form {
            BondForm::Fastest => Self::Fastest,
            BondForm::Grid => Self::Grid,
            BondForm::FloatGrid => Self::FloatGrid,
            BondForm::List => Self::List,
        }
    }
}
