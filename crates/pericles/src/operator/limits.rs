//! Features of bodies that not every form of forces represents: one list of limits for each form, from which refusals and the table of the book are made.

use crate::error::{PericlesError, Result};
use crate::material::PairLaw;
use crate::space::PointCloud;

/// A property of a body that some forms of forces do not represent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// The bond-stretch law.
    BondStretch,
    /// The Green-strain law on a bar.
    GreenStrainBar,
    /// The Green-strain law on a plate or block.
    GreenStrain,
    /// The other cubic laws, which are defined for bars: equation 57 as printed, and treatments of a cubic law.
    OtherCubic,
    /// State-based materials, whose bonds depend on the dilatations of both ends.
    StateBased,
    /// Correspondence materials, whose bonds depend on the deformation gradients of both ends.
    Correspondence,
    /// Bonds that break.
    Breaking,
    /// Bonds that break by their energy, the work of their force states since the start.
    BondEnergy,
    /// Pre-cracks.
    PreCracks,
    /// Several materials.
    SeveralMaterials,
    /// Materials of different horizons.
    SeveralHorizons,
    /// Inclusions: points with a stiffness of their own.
    Inclusions,
    /// A surface correction.
    SurfaceCorrection,
    /// Cells of several sizes.
    SeveralSpacings,
    /// Periodic faces.
    PeriodicFaces,
    /// Free faces: the body is not periodic.
    FreeFaces,
    /// Points that lie on no regular grid.
    NoLattice,
    /// Two Gauss nodes in every cell of a bar.
    GaussNodes,
    /// Output of stress or strain, which are sums over single bonds.
    Tensors,
    /// Thermal expansion.
    ThermalExpansion,
}

impl Feature {
    /// All features, in the order of the table.
    pub const ALL: [Self; 20] = [
        Self::BondStretch,
        Self::GreenStrainBar,
        Self::GreenStrain,
        Self::OtherCubic,
        Self::StateBased,
        Self::Correspondence,
        Self::Breaking,
        Self::BondEnergy,
        Self::PreCracks,
        Self::SeveralMaterials,
        Self::SeveralHorizons,
        Self::Inclusions,
        Self::SurfaceCorrection,
        Self::SeveralSpacings,
        Self::PeriodicFaces,
        Self::FreeFaces,
        Self::NoLattice,
        Self::GaussNodes,
        Self::Tensors,
        Self::ThermalExpansion,
    ];

    /// The feature in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::BondStretch => "bond-stretch law",
            Self::GreenStrainBar => "Green-strain law, bars",
            Self::GreenStrain => "Green-strain law, plates and blocks",
            Self::OtherCubic => "other cubic laws (bars)",
            Self::StateBased => "state-based materials",
            Self::Correspondence => "correspondence materials",
            Self::Breaking => "breaking",
            Self::BondEnergy => "breaking by bond energy",
            Self::PreCracks => "pre-cracks",
            Self::SeveralMaterials => "several materials",
            Self::SeveralHorizons => "materials of different horizons",
            Self::Inclusions => "inclusions",
            Self::SurfaceCorrection => "surface correction",
            Self::SeveralSpacings => "cells of several sizes",
            Self::PeriodicFaces => "periodic faces",
            Self::FreeFaces => "free faces",
            Self::NoLattice => "points off a grid",
            Self::GaussNodes => "Gauss nodes (bars)",
            Self::Tensors => "stress and strain",
            Self::ThermalExpansion => "thermal expansion",
        }
    }

    /// The feature of a pair law in so many dimensions; none for the linear law, which every form computes.
    pub fn of_law(law: PairLaw, dimension: usize) -> Option<Self> {
        match law {
            PairLaw::Linear => None,
            PairLaw::BondStretch => Some(Self::BondStretch),
            PairLaw::GreenStrain if dimension == 1 => Some(Self::GreenStrainBar),
            PairLaw::GreenStrain => Some(Self::GreenStrain),
            PairLaw::Literal57 | PairLaw::Treated(..) => Some(Self::OtherCubic),
        }
    }
}

/// The features that a body has.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Features(u32);

impl Features {
    /// These features and another one if `present`, or without that one if not.
    pub fn with(self, feature: Feature, present: bool) -> Self {
        let bit = 1 << feature as u32;
        Self(if present { self.0 | bit } else { self.0 & !bit })
    }

    /// Whether a feature is among them.
    pub fn has(self, feature: Feature) -> bool {
        self.0 & (1 << feature as u32) != 0
    }

    /// The features that a pair law and points have by themselves.
    pub fn of_points(law: PairLaw, cloud: &PointCloud) -> Self {
        let law = Feature::of_law(law, cloud.dimension());
        law.map_or_else(Self::default, Self::from)
            .with(Feature::PeriodicFaces, cloud.is_periodic())
            .with(Feature::FreeFaces, !cloud.is_periodic())
            .with(Feature::NoLattice, cloud.lattice().is_none())
    }
}

impl From<Feature> for Features {
    fn from(feature: Feature) -> Self {
        Self::default().with(feature, true)
    }
}

/// A feature that a form of forces does not represent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limit {
    /// The feature.
    pub feature: Feature,
    /// Why it is not represented, and what to use instead.
    pub reason: &'static str,
}

/// Limits of several forms.
impl Limit {
    /// Of forms that compute pair forces only.
    pub const STATE_BASED: Self = Self::new(
        Feature::StateBased,
        "state-based materials are computed on a list of bonds or, in double precision, on a stencil; leave `bonds` out or give \"list\" or \"grid\"",
    );

    /// Of all forms but lists.
    pub const CORRESPONDENCE: Self = Self::new(
        Feature::Correspondence,
        "correspondence materials are computed on a list of bonds; leave `bonds` out or give \"list\"",
    );

    /// Of forms that store no number per bond.
    pub const BOND_ENERGY: Self = Self::new(
        Feature::BondEnergy,
        "the work of every bond is kept as a list; use \"list\", leave `bonds` out, or break bonds by their stretch",
    );

    /// Of all forms but lists.
    pub const THERMAL_EXPANSION: Self = Self::new(
        Feature::ThermalExpansion,
        "thermal expansion is computed on a list of bonds; leave `bonds` out or give \"list\"",
    );

    /// Of forms that need one lattice.
    pub const SEVERAL_SPACINGS: Self = Self::new(
        Feature::SeveralSpacings,
        "there is no one lattice; leave `bonds` out or give \"list\"",
    );
}

impl Limit {
    /// A limit.
    pub const fn new(feature: Feature, reason: &'static str) -> Self {
        Self { feature, reason }
    }

    /// The reason of the first limit of a form that a body with these features exceeds; none if the form represents the body.
    pub fn refusal(limits: &[Self], features: Features) -> Option<&'static str> {
        let exceeded = limits.iter().find(|limit| features.has(limit.feature));
        exceeded.map(|limit| limit.reason)
    }

    /// Refuses a body with features that a form with these limits does not represent.
    ///
    /// # Errors
    /// [`PericlesError::FormNotUsable`], with the name of the form and the reason.
    pub fn check(limits: &[Self], form: &'static str, features: Features) -> Result<()> {
        match Self::refusal(limits, features) {
            None => Ok(()),
            Some(reason) => Err(PericlesError::FormNotUsable { form, reason }),
        }
    }
}
