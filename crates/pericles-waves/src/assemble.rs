//! The choice among bonds one by one, convolution and plane waves.

use pericles::family::Cut;
use pericles::material::PairLaw;
use pericles::operator::{AssembledBonds, BondBody, BondForm, CompositeBody, ForceOperator};
use pericles::{PericlesError, Result};

use crate::linear::{
    ConvolutionForce, CostComparison, GaussForce, SpectralCubicForce, SpectralForce,
};

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
    /// Transforms of a linear body's kernel ([`ConvolutionForce`], or [`GaussForce`] on Gauss nodes).
    Convolution,
    /// Plane waves of a periodic body ([`SpectralForce`], [`SpectralCubicForce`]).
    Spectral,
}

impl ForceForm {
    /// As written in decks.
    pub fn name(self) -> &'static str {
        match self.of_bonds() {
            Ok(bonds) => bonds.name(),
            Err(transformed) => transformed.name(),
        }
    }

    /// The form of bonds one by one, or what is none.
    fn of_bonds(self) -> std::result::Result<BondForm, Transformed> {
        match self {
            Self::Fastest => Ok(BondForm::Fastest),
            Self::Grid => Ok(BondForm::Grid),
            Self::FloatGrid => Ok(BondForm::FloatGrid),
            Self::List => Ok(BondForm::List),
            Self::Convolution => Err(Transformed::Convolution),
            Self::Spectral => Err(Transformed::Spectral),
        }
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

/// Forms in which no bond is computed on its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Transformed {
    Convolution,
    Spectral,
}

impl Transformed {
    fn name(self) -> &'static str {
        match self {
            Self::Convolution => "convolution",
            Self::Spectral => "spectral",
        }
    }
}

/// A force operator, and what each pre-crack removed from it.
pub struct AssembledForce {
    /// The operator.
    pub operator: Box<dyn ForceOperator>,
    /// One for each pre-crack.
    pub cuts: Vec<Cut>,
    /// The form taken, never [`ForceForm::Fastest`].
    pub form: ForceForm,
}

impl From<AssembledBonds> for AssembledForce {
    fn from(bonds: AssembledBonds) -> Self {
        Self {
            operator: bonds.operator,
            cuts: bonds.cuts,
            form: bonds.form.into(),
        }
    }
}

/// The force operator of a body.
///
/// # Errors
/// As [`CompositeBody::operator`]; [`PericlesError::FormNotUsable`] for a form that does not fit.
pub fn assemble(composite: &CompositeBody<'_>, form: ForceForm) -> Result<AssembledForce> {
    let body = &composite.body;
    let form = match form {
        ForceForm::Fastest if composite.is_plain() && convolution_is_fastest(body) => {
            ForceForm::Convolution
        }
        chosen => chosen,
    };
    let transformed = match form.of_bonds() {
        Ok(bonds) => return composite.operator(bonds).map(AssembledForce::from),
        Err(transformed) => transformed,
    };
    if !composite.is_plain() {
        return Err(composite.only_listed(form.name()));
    }
    let operator = match (body.material.law, body.cloud.dimension()) {
        (PairLaw::GreenStrain, 1) if transformed == Transformed::Spectral => cubic(body)?,
        (PairLaw::Linear | PairLaw::BondStretch, 1) => transform::<1>(body, transformed)?,
        (PairLaw::Linear | PairLaw::BondStretch, 2) => transform::<2>(body, transformed)?,
        (PairLaw::Linear | PairLaw::BondStretch, 3) => transform::<3>(body, transformed)?,
        _ => return refuse_law(body, form),
    };
    Ok(AssembledForce {
        operator,
        cuts: Vec::new(),
        form,
    })
}

/// Whether a convolution costs less than bonds one by one. Periodic bodies have no other form that follows all their bonds.
fn convolution_is_fastest(body: &BondBody<'_>) -> bool {
    /// What a bond of the list costs over one of the grid, about.
    const GRID_GAIN: f64 = 5.0;
    let (material, cloud) = (body.material, body.cloud);
    if cloud.is_periodic() {
        return matches!(material.law, PairLaw::Linear | PairLaw::BondStretch);
    }
    let possible = material.law == PairLaw::Linear
        && !body.constants.critical_stretch.is_finite()
        && body.cracks.is_empty()
        && body.stiffness.is_empty();
    if !possible {
        return false;
    }
    if GaussForce::fits(cloud) {
        return true;
    }
    let costs = CostComparison::new(cloud, material.horizon, material.volume_correction);
    costs.is_ok_and(|costs| GRID_GAIN * costs.convolution < costs.bond_list)
}

fn transform<const D: usize>(
    body: &BondBody<'_>,
    form: Transformed,
) -> Result<Box<dyn ForceOperator>> {
    let (name, periodic) = (form.name(), body.cloud.is_periodic());
    if !body.stiffness.is_empty() {
        return refuse(
            name,
            "parts of other stiffness are no convolution; use \"list\", or leave the inclusions out",
        );
    }
    if !body.cracks.is_empty() {
        return refuse(
            name,
            "pre-cracks cut single bonds, which it cannot; use \"list\" or \"grid\"",
        );
    }
    let cloud = body.cloud.clone();
    Ok(match form {
        Transformed::Spectral if !periodic => {
            return refuse(
                name,
                "Fourier series need a body whose opposite faces are one: set body.periodic = true, or use \"convolution\"",
            );
        }
        Transformed::Spectral => Box::new(SpectralForce::<D>::new(
            cloud,
            body.material,
            body.constants,
        )?),
        Transformed::Convolution if GaussForce::fits(&cloud) => {
            Box::new(GaussForce::new(cloud, body.material, body.constants)?)
        }
        Transformed::Convolution => Box::new(ConvolutionForce::<D>::new(
            cloud,
            body.material,
            body.constants,
            &[],
            [periodic; D],
        )?),
    })
}

fn cubic(body: &BondBody<'_>) -> Result<Box<dyn ForceOperator>> {
    if !body.stiffness.is_empty() || !body.cracks.is_empty() {
        return refuse(
            Transformed::Spectral.name(),
            "parts of other stiffness and pre-cracks have no Fourier series; use \"list\"",
        );
    }
    let force = SpectralCubicForce::new(body.cloud.clone(), body.material, body.constants)?;
    Ok(Box::new(force))
}

/// Laws whose bonds are computed one by one only.
fn refuse_law<T>(body: &BondBody<'_>, form: ForceForm) -> Result<T> {
    let reason = if body.cloud.is_periodic() {
        "bonds through periodic faces are followed for the linear law only; use model = \"linear\""
    } else {
        "this law is kept as a list: \"list\" or \"fastest\""
    };
    refuse(form.name(), reason)
}

fn refuse<T>(form: &'static str, reason: &'static str) -> Result<T> {
    Err(PericlesError::FormNotUsable { form, reason })
}
