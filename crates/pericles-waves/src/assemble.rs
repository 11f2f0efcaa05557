//! Selects the form of the force operator: bonds one by one, convolution or plane waves.

use pericles::Result;
use pericles::family::BondCut;
use pericles::material::PairLaw;
use pericles::operator::{AssembledBonds, BondBody, CompositeBody, Feature, Features, Force};

use crate::form::ForceForm;
use crate::linear::{
    ConvolutionForce, CostComparison, GaussForce, SpectralCubicForce, SpectralForce,
};

/// Force operator, and the bonds removed by each pre-crack.
pub struct AssembledForce {
    /// The operator.
    pub operator: Box<dyn Force>,
    /// Removed bonds, one entry per pre-crack.
    pub cuts: Vec<BondCut>,
    /// Selected form, never [`ForceForm::Fastest`].
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

/// Returns the features of a body that some forms do not represent.
pub fn features(composite: &CompositeBody<'_>) -> Features {
    let features = composite.features();
    if !GaussForce::fits(composite.body.cloud) {
        return features;
    }
    features
        .with(Feature::GaussNodes, true)
        .with(Feature::NoLattice, false)
}

/// Creates the force operator of a body.
///
/// # Errors
/// A form that does not represent the body ([`ForceForm::check`]); errors of [`CompositeBody::operator`] and of the
/// constructors of linear operators.
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

/// Returns true if a convolution represents the body and is cheaper than bonds one by one, or is the only form that
/// represents it.
fn convolution_is_fastest(body: &BondBody<'_>, features: Features) -> bool {
    /// Approximate cost of a bond in a list relative to a stencil.
    const GRID_GAIN: f64 = 5.0;
    if ForceForm::Convolution.rejection(features).is_some() {
        return false;
    }
    // The cost estimate holds for free faces only.
    if features.has(Feature::PeriodicFaces) || features.has(Feature::GaussNodes) {
        return true;
    }
    let (material, cloud) = (body.material, body.cloud);
    let costs = CostComparison::new(cloud, material.horizon, material.volume_correction);
    costs.is_ok_and(|costs| GRID_GAIN * costs.convolution < costs.bond_list)
}

/// Creates a form without individual bonds: plane waves or a convolution.
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
