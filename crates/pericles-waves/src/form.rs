//! Forms in which forces are computed, and their limits.

use pericles::Result;
use pericles::operator::{BondForm, Feature, Features, Limit};

/// Form in which the internal forces of a body are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ForceForm {
    /// The cheapest form by estimated cost.
    #[default]
    Fastest,
    /// [`BondForm::Grid`].
    Grid,
    /// [`BondForm::FloatGrid`].
    FloatGrid,
    /// [`BondForm::List`].
    List,
    /// Transforms of the kernel of a linear body ([`ConvolutionForce`](crate::linear::ConvolutionForce), or
    /// [`GaussForce`](crate::linear::GaussForce) on Gauss nodes).
    Convolution,
    /// Plane waves of a periodic body ([`SpectralForce`](crate::linear::SpectralForce), [`SpectralCubicForce`](crate::linear::SpectralCubicForce)).
    Spectral,
}

/// Reason: a transform is a linear operator.
pub(crate) const LINEAR_ONLY: &str = "transforms (convolution, spectral) represent linear forces only; use model = \
    \"linear\", or bonds = \"list\", \"grid\" or \"fastest\"";

/// Reason: a transform uses the same bonds at every point.
const UNIFORM: &str = "transforms (convolution, spectral) need the same bonds at every point during the whole run; \
    use bonds = \"list\", \"grid\" or \"fastest\"";

const fn linear(feature: Feature) -> Limit {
    Limit::new(feature, LINEAR_ONLY)
}

const fn uniform(feature: Feature) -> Limit {
    Limit::new(feature, UNIFORM)
}

const TENSORS: Limit = Limit::new(
    Feature::Tensors,
    "they are sums over individual bonds; use bonds = \"list\", \"grid\" or \"fastest\"",
);

/// Limits of all transforms.
const OF_TRANSFORMS: [Limit; 19] = [
    Limit::STATE_BASED,
    Limit::CORRESPONDENCE,
    Limit::SEVERAL_SPACINGS,
    uniform(Feature::SeveralHorizons),
    linear(Feature::BondStretch),
    linear(Feature::GreenStrain),
    linear(Feature::OtherCubic),
    uniform(Feature::SeveralMaterials),
    uniform(Feature::Inclusions),
    uniform(Feature::SurfaceCorrection),
    uniform(Feature::PreCracks),
    uniform(Feature::Pieces),
    uniform(Feature::Breaking),
    Limit::BOND_ENERGY,
    Limit::STRESS_FAILURE,
    TENSORS,
    Limit::THERMAL_EXPANSION,
    Limit::SOFTENING,
    Limit::ACTIVATION,
];

const FULL_BOX: &str =
    "a Fourier series needs a full box of cells (bar, plate or block without holes)";

/// All limits of convolutions. On bars plane waves also compute the Green-strain law.
const OF_CONVOLUTION: &[Limit] = &joined::<{ OF_TRANSFORMS.len() + 2 }>(&[
    linear(Feature::GreenStrainBar),
    Limit::new(
        Feature::NoLattice,
        "it needs points on a regular grid; use the bond list for this body",
    ),
]);

const OF_SPECTRAL: &[Limit] = &joined::<{ OF_TRANSFORMS.len() + 3 }>(&[
    Limit::new(
        Feature::FreeFaces,
        "Fourier series need a periodic body: set body.periodic = true, or use \"convolution\"",
    ),
    Limit::new(Feature::NoLattice, FULL_BOX),
    Limit::new(Feature::GaussNodes, FULL_BOX),
]);

/// Concatenates the limits of all transforms and others.
const fn joined<const N: usize>(others: &[Limit]) -> [Limit; N] {
    let mut all = [OF_TRANSFORMS[0]; N];
    let mut k = 0;
    while k < N {
        all[k] = match k < OF_TRANSFORMS.len() {
            true => OF_TRANSFORMS[k],
            false => others[k - OF_TRANSFORMS.len()],
        };
        k += 1;
    }
    all
}

impl ForceForm {
    /// Name in decks.
    pub fn name(self) -> &'static str {
        match (self, self.of_bonds()) {
            (_, Some(bonds)) => bonds.name(),
            (Self::Spectral, None) => "spectral",
            (_, None) => "convolution",
        }
    }

    /// Returns the form that computes bonds one by one; `None` for transforms.
    pub fn of_bonds(self) -> Option<BondForm> {
        match self {
            Self::Fastest => Some(BondForm::Fastest),
            Self::Grid => Some(BondForm::Grid),
            Self::FloatGrid => Some(BondForm::FloatGrid),
            Self::List => Some(BondForm::List),
            Self::Convolution | Self::Spectral => None,
        }
    }

    /// Returns the forms that may be selected for this one.
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

    /// Limits of the form ([`BondForm::limits`]).
    pub fn limits(self) -> &'static [Limit] {
        match (self, self.of_bonds()) {
            (_, Some(bonds)) => bonds.limits(),
            (Self::Spectral, None) => OF_SPECTRAL,
            (_, None) => OF_CONVOLUTION,
        }
    }

    /// Returns the reason why the form does not represent a body with these features; `None` if it does.
    pub fn rejection(self, features: Features) -> Option<&'static str> {
        Limit::rejection(self.limits(), features)
    }

    /// Returns an error if the form does not represent a body with these features.
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
