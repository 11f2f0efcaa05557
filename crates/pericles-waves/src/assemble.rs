//! The choice among bonds one by one, convolution and plane waves.

use pericles::family::Cut;
use pericles::material::PairLaw;
use pericles::operator::{AssembledBonds, BondBody, BondForm, CompositeBody, Force};
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
        match self {
            Self::Fastest => BondForm::Fastest.name(),
            Self::Grid => BondForm::Grid.name(),
            Self::FloatGrid => BondForm::FloatGrid.name(),
            Self::List => BondForm::List.name(),
            Self::Convolution => "convolution",
            Self::Spectral => "spectral",
        }
    }

    /// The form in which bonds are computed one by one; none for forms that transform.
    fn of_bonds(self) -> Option<BondForm> {
        match self {
            Self::Fastest => Some(BondForm::Fastest),
            Self::Grid => Some(BondForm::Grid),
            Self::FloatGrid => Some(BondForm::FloatGrid),
            Self::List => Some(BondForm::List),
            Self::Convolution | Self::Spectral => None,
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

/// A force operator, and what each pre-crack removed from it.
pub struct AssembledForce {
    /// The operator.
    pub operator: Box<dyn Force>,
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
    if let Some(bonds) = form.of_bonds() {
        return composite.operator(bonds).map(AssembledForce::from);
    }
    if !composite.is_plain() {
        return Err(composite.only_listed(form.name()));
    }
    let operator = match (body.material.law, body.cloud.dimension()) {
        (PairLaw::GreenStrain, 1) if form == ForceForm::Spectral => cubic(body)?,
        (PairLaw::Linear | PairLaw::BondStretch, 1) => transform::<1>(body, form)?,
        (PairLaw::Linear | PairLaw::BondStretch, 2) => transform::<2>(body, form)?,
        (PairLaw::Linear | PairLaw::BondStretch, 3) => transform::<3>(body, form)?,
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

/// A form without bonds: plane waves, else a convolution.
fn transform<const D: usize>(body: &BondBody<'_>, form: ForceForm) -> Result<Box<dyn Force>> {
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
        ForceForm::Spectral if !periodic => {
            return refuse(
                name,
                "Fourier series need a body whose opposite faces are one: set body.periodic = true, or use \"convolution\"",
            );
        }
        ForceForm::Spectral => Box::new(SpectralForce::<D>::new(
            cloud,
            body.material,
            body.constants,
        )?),
        _ if GaussForce::fits(&cloud) => {
            Box::new(GaussForce::new(cloud, body.material, body.constants)?)
        }
        _ => Box::new(ConvolutionForce::<D>::new(
            cloud,
            body.material,
            body.constants,
            &[],
            [periodic; D],
        )?),
    })
}

fn cubic(body: &BondBody<'_>) -> Result<Box<dyn Force>> {
    if !body.stiffness.is_empty() || !body.cracks.is_empty() {
        return refuse(
            ForceForm::Spectral.name(),
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
