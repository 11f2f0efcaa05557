//! Features of bodies that some force kernels do not support. Each kernel has one list of limits, from which
//! error messages and the composition table of the book are generated.

use crate::error::{PericlesError, Result};
use crate::material::PairLaw;
use crate::space::PointCloud;

/// A property of a body that some force kernels do not support.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// The bond-stretch law.
    BondStretch,
    /// The Green-strain law on a bar.
    GreenStrainBar,
    /// The Green-strain law on a plate or block.
    GreenStrain,
    /// The other cubic laws, which are defined for bars: the cubic softening law and approximations of cubic
    /// laws.
    OtherCubic,
    /// State-based materials, whose bonds depend on the dilatations of both ends.
    StateBased,
    /// Correspondence materials, whose bonds depend on the deformation gradients of both ends.
    Correspondence,
    /// Bonds that break.
    Breaking,
    /// Bonds that break by their energy, the accumulated work of their force states.
    BondEnergy,
    /// Bonds that break by stress or strain at their ends.
    StressFailure,
    /// Pre-cracks.
    PreCracks,
    /// Several pieces that no bond joins.
    Pieces,
    /// Several materials.
    SeveralMaterials,
    /// Materials of different horizons.
    SeveralHorizons,
    /// Inclusions: points with a different stiffness.
    Inclusions,
    /// A surface correction.
    SurfaceCorrection,
    /// Cells of several sizes.
    SeveralSpacings,
    /// Periodic faces.
    PeriodicFaces,
    /// Free faces: the body is not periodic.
    FreeFaces,
    /// Points that do not lie on a regular grid.
    NoLattice,
    /// Two Gauss nodes in each cell of a bar.
    GaussNodes,
    /// Output of stress or strain, which are sums over individual bonds.
    Tensors,
    /// Thermal expansion.
    ThermalExpansion,
    /// Bonds that soften before they break.
    Softening,
    /// Points that become active during the run.
    Activation,
}

impl Feature {
    /// All features, in the order of the table.
    pub const ALL: [Self; 24] = [
        Self::BondStretch,
        Self::GreenStrainBar,
        Self::GreenStrain,
        Self::OtherCubic,
        Self::StateBased,
        Self::Correspondence,
        Self::Breaking,
        Self::BondEnergy,
        Self::StressFailure,
        Self::PreCracks,
        Self::Pieces,
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
        Self::Softening,
        Self::Activation,
    ];

    /// Returns the name of the feature in messages and tables.
    pub fn words(self) -> &'static str {
        match self {
            Self::BondStretch => "bond-stretch law",
            Self::GreenStrainBar => "Green-strain law, bars",
            Self::GreenStrain => "Green-strain law, plates and blocks",
            Self::OtherCubic => "other cubic laws (bars)",
            Self::StateBased => "state-based materials",
            Self::Correspondence => "correspondence materials",
            Self::Breaking => "breaking bonds",
            Self::BondEnergy => "bonds that break by their energy",
            Self::StressFailure => "bonds that break by stress or strain",
            Self::PreCracks => "pre-cracks",
            Self::Pieces => "several pieces",
            Self::SeveralMaterials => "several materials",
            Self::SeveralHorizons => "materials of different horizons",
            Self::Inclusions => "inclusions",
            Self::SurfaceCorrection => "surface correction",
            Self::SeveralSpacings => "cells of several sizes",
            Self::PeriodicFaces => "periodic faces",
            Self::FreeFaces => "free faces",
            Self::NoLattice => "points not on a grid",
            Self::GaussNodes => "Gauss nodes (bars)",
            Self::Tensors => "output of stress and strain",
            Self::ThermalExpansion => "thermal expansion",
            Self::Softening => "bond softening",
            Self::Activation => "activation of points",
        }
    }

    /// Returns the feature of a pair law in a dimension; `None` for the linear law, which every kernel
    /// supports.
    pub fn of_law(law: PairLaw, dimension: usize) -> Option<Self> {
        match law {
            PairLaw::Linear => None,
            PairLaw::BondStretch => Some(Self::BondStretch),
            PairLaw::GreenStrain if dimension == 1 => Some(Self::GreenStrainBar),
            PairLaw::GreenStrain => Some(Self::GreenStrain),
            PairLaw::CubicSoftening | PairLaw::Approximated(..) => Some(Self::OtherCubic),
        }
    }
}

/// The set of features of a body.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Features(u32);

impl Features {
    /// Returns these features with one added if `present`, otherwise removed.
    pub fn with(self, feature: Feature, present: bool) -> Self {
        let bit = 1 << feature as u32;
        Self(if present { self.0 | bit } else { self.0 & !bit })
    }

    /// Returns whether the set contains a feature.
    pub fn has(self, feature: Feature) -> bool {
        self.0 & (1 << feature as u32) != 0
    }

    /// Returns the features of a pair law and of points.
    pub fn of_points(law: PairLaw, cloud: &PointCloud) -> Self {
        let law = Feature::of_law(law, cloud.dimension());
        law.map_or_else(Self::default, Self::from)
            .with(Feature::PeriodicFaces, cloud.is_periodic())
            .with(Feature::FreeFaces, !cloud.is_periodic())
            .with(Feature::NoLattice, cloud.lattice().is_none())
            .with(Feature::Pieces, cloud.has_pieces())
    }
}

impl From<Feature> for Features {
    fn from(feature: Feature) -> Self {
        Self::default().with(feature, true)
    }
}

/// A feature that a force kernel does not support.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limit {
    /// The feature.
    pub feature: Feature,
    /// Reason, and what to use instead.
    pub reason: &'static str,
}

/// Limits shared by several kernels.
impl Limit {
    /// Limit of kernels that compute pair forces only.
    pub const STATE_BASED: Self = Self::new(
        Feature::StateBased,
        "state-based materials need a neighbour list or a stencil in double precision; use bonds = \"list\" or \"grid\", or omit `bonds`",
    );

    /// Limit of all kernels except lists.
    pub const CORRESPONDENCE: Self = Self::new(
        Feature::Correspondence,
        "correspondence materials need a neighbour list; use bonds = \"list\" or omit `bonds`",
    );

    /// Limit of kernels that store no value per bond.
    pub const BOND_ENERGY: Self = Self::new(
        Feature::BondEnergy,
        "the work of each bond is stored with a neighbour list only; use bonds = \"list\", omit `bonds`, or use failure = \"stretch\"",
    );

    /// Limit of all kernels except lists.
    pub const STRESS_FAILURE: Self = Self::new(
        Feature::StressFailure,
        "stress and strain of points are computed with a neighbour list only; use bonds = \"list\", omit `bonds`, or use failure = \"stretch\"",
    );

    /// Limit of all kernels except lists and stencils in double precision.
    pub const THERMAL_EXPANSION: Self = Self::new(
        Feature::ThermalExpansion,
        "thermal expansion needs a neighbour list or a stencil in double precision; use bonds = \"list\" or \"grid\", or omit `bonds`",
    );

    /// Limit of all kernels except lists.
    pub const SOFTENING: Self = Self::new(
        Feature::Softening,
        "the largest stretch of each bond is stored with a neighbour list only; use bonds = \"list\" or omit `bonds`",
    );

    /// Limit of all kernels except lists.
    pub const ACTIVATION: Self = Self::new(
        Feature::Activation,
        "the displacements at which bonds come into being are stored with a neighbour list only; use bonds = \"list\" or omit `bonds`",
    );

    /// Limit of kernels that need a single lattice.
    pub const SEVERAL_SPACINGS: Self = Self::new(
        Feature::SeveralSpacings,
        "cells of several sizes do not form a single lattice; use bonds = \"list\" or omit `bonds`",
    );
}

impl Limit {
    /// Creates a limit.
    pub const fn new(feature: Feature, reason: &'static str) -> Self {
        Self { feature, reason }
    }

    /// Returns the reason of the first limit that these features exceed; `None` if the kernel supports the
    /// body.
    pub fn rejection(limits: &[Self], features: Features) -> Option<&'static str> {
        let exceeded = limits.iter().find(|limit| features.has(limit.feature));
        exceeded.map(|limit| limit.reason)
    }

    /// Checks that a kernel with these limits supports these features.
    ///
    /// # Errors
    /// [`PericlesError::FormNotUsable`] with the name of the kernel and the reason.
    pub fn check(limits: &[Self], form: &'static str, features: Features) -> Result<()> {
        match Self::rejection(limits, features) {
            None => Ok(()),
            Some(reason) => Err(PericlesError::FormNotUsable { form, reason }),
        }
    }
}
