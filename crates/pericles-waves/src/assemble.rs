//! The choice among bonds one by one, convolution and plane waves.

use pericles::Result;
use pericles::family::Cut;
use pericles::material::PairLaw;
use pericles::operator::{AssembledBonds, BondBody, CompositeBody, Feature, Features, Force};

use crate::form::ForceForm;
use crate::linear::{
    ConvolutionForce, CostComparison, GaussForce, SpectralCubicForce, SpectralForce,
};

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

/// What a body has that not every form represents.
pub fn features(composite: &CompositeBody<'_>) -> Features {
    let features = composite.features();
    if !GaussForce::fits(composite.body.cloud) {
        return features;
    }
    features
        .with(Feature::GaussNodes, true)
        .with(Feature::NoLattice, false)
}

/// The force operator of a body.
///
/// # Errors
/// A form that does not represent the body ([`ForceForm::check`]); those of [`CompositeBody::operator`] and of the constructors of linear operators.
pub fn assemble(composite: &CompositeBody<'_>, form: ForceForm) -> Result<AssembledForce> {
    let body = &composite.body;
    let features = features(composite);
    let form = match form {
        ForceForm::Fastest if convolution_is_fastest(body, features) => ForceForm::Convolution,
        chosen => chosen,
    };
    form.check(features)?;
    if let Some(bonds) = form.of_bonds() {
        return composite.operator(bonds).map(AssembledForce::from);
    }
    let operator = match body.cloud.dimension() {
        1 if body.material.law == PairLaw::GreenStrain => {
            let cloud = body.cloud.clone();
            let force = SpectralCubicForce::new(cloud, body.material, body.constants)?;
            Box::new(force)
        }
        1 => transform::<1>(body, form)?,
        2 => transform::<2>(body, form)?,
        _ => transform::<3>(body, form)?,
    };
    Ok(AssembledForce {
        operator,
        cuts: Vec::new(),
        form,
    })
}

/// Whether a convolution represents a body and costs less than bonds one by one, or is the one form of both that represents it.
fn convolution_is_fastest(body: &BondBody<'_>, features: Features) -> bool {
    /// What a bond of the list costs over one of the grid, about.
    const GRID_GAIN: f64 = 5.0;
    if ForceForm::Convolution.refusal(features).is_some() {
        return false;
    }
    // The estimate of costs is that of free faces.
    if features.has(Feature::PeriodicFaces) || features.has(Feature::GaussNodes) {
        return true;
    }
    let (material, cloud) = (body.material, body.cloud);
    let costs = CostComparison::new(cloud, material.horizon, material.volume_correction);
    costs.is_ok_and(|costs| GRID_GAIN * costs.convolution < costs.bond_list)
}

/// A form without bonds: plane waves, else a convolution.
fn transform<const D: usize>(body: &BondBody<'_>, form: ForceForm) -> Result<Box<dyn Force>> {
    let (cloud, material, constants) = (body.cloud.clone(), body.material, body.constants);
    Ok(match form {
        ForceForm::Spectral => Box::new(SpectralForce::<D>::new(cloud, material, constants)?),
        _ if GaussForce::fits(&cloud) => Box::new(GaussForce::new(cloud, material, constants)?),
        _ => {
            let periodic = [cloud.is_periodic(); D];
            let force = ConvolutionForce::<D>::new(cloud, material, constants, &[], periodic)?;
            Box::new(force)
        }
    })
}
