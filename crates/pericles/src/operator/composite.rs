//! Bodies whose bonds depend on their two ends: several materials, corrected surfaces.

use super::by_law::{ByLaw, by_law};
use super::limits::{Feature, Features};
use super::{AssembledBonds, BondBody, BondForce, BondForm, Breaking};
use crate::error::Result;
use crate::family::BondList;
use crate::material::{PairClasses, SurfaceCorrection};
use crate::operator::fast_law::FastLaw;
use crate::space::check_length;

/// A body of several materials, or with corrected surfaces; always kept as a list.
///
/// The force of a bond is c_ab · g · ½(k_i + k_j) · α κ V_j s n with the constant c_ab of the materials of its ends ([`PairClasses`]), the factor g of
/// [`SurfaceCorrection`] and the relative stiffness k of [`BondBody::stiffness`]. Law, horizon, influence function and partial volumes are those of the body's
/// material for all bonds.
#[derive(Debug, Clone)]
pub struct CompositeBody<'a> {
    /// Points, law, horizon, pre-cracks; the constants are used if there are no classes.
    pub body: BondBody<'a>,
    /// Materials by point.
    pub classes: Option<&'a PairClasses>,
    /// Correction of surfaces.
    pub correction: SurfaceCorrection,
}

impl<'a> From<BondBody<'a>> for CompositeBody<'a> {
    /// A body of one material without a correction.
    fn from(body: BondBody<'a>) -> Self {
        Self {
            body,
            classes: None,
            correction: SurfaceCorrection::None,
        }
    }
}

impl CompositeBody<'_> {
    /// Whether it is no more than its [`BondBody`].
    pub fn is_plain(&self) -> bool {
        self.classes.is_none() && self.correction == SurfaceCorrection::None
    }

    /// The faster of grid and list.
    pub fn fastest_form(&self) -> BondForm {
        if self.is_plain() {
            self.body.fastest_form()
        } else {
            BondForm::List
        }
    }

    /// What the body has that not every form represents.
    pub fn features(&self) -> Features {
        let correction = self.correction != SurfaceCorrection::None;
        let features = self.body.features();
        let features = features.with(Feature::SurfaceCorrection, correction);
        match self.classes {
            None => features,
            Some(classes) => features.with(Feature::SeveralMaterials, true).with(
                Feature::Breaking,
                classes.smallest_critical_stretch().is_finite(),
            ),
        }
    }

    /// The operator.
    ///
    /// # Errors
    /// Those of [`BondBody::operator`].
    pub fn operator(&self, form: BondForm) -> Result<AssembledBonds> {
        if self.is_plain() {
            return self.body.operator(form);
        }
        form.check(self.features())?;
        let dimension = self.body.cloud.dimension();
        by_law(self.body.material.law, dimension, Listed(self))
    }

    pub(super) fn list<L: FastLaw, const D: usize>(&self) -> Result<AssembledBonds> {
        let BondBody {
            cloud,
            material,
            constants,
            stiffness,
            ..
        } = self.body;
        if let Some(classes) = self.classes {
            check_length(
                "the materials of the points",
                classes.of_point().len(),
                cloud.len(),
            )?;
        }
        let (bonds, cuts) = self.body.families()?;
        let sites = bonds.shared_sites();
        let factors = self.correction.factors(&bonds, material);
        let stiffness = sites.spread(stiffness);
        let inclusion = |a: usize, b: usize| match &stiffness[..] {
            [] => 1.0,
            stiffness => 0.5 * (stiffness[a] + stiffness[b]),
        };
        let classes = self.classes.map(|classes| classes.on_sites(&sites));
        let stiffness_of_pair = |bonds: &BondList, a: usize, b: usize| {
            let xi = bonds.vector(a, b);
            let alpha = material.influence.alpha_of(xi, material.horizon);
            let micromodulus = match &classes {
                Some(classes) => classes.micromodulus(a, b),
                None => constants.micromodulus,
            };
            let relative = inclusion(a, b) * factors.of_bond(a, b, xi);
            relative * micromodulus * alpha * bonds.volume_factor(a, b)
        };
        let breaking = Breaking {
            critical_stretch: constants.critical_stretch,
            no_fail: self.body.no_fail,
        };
        let list = BondForce::<L, D>::with_weighted_stiffness(
            cloud.clone(),
            bonds,
            &stiffness_of_pair,
            breaking,
            self.body.damage,
        )?;
        let list = match self.classes {
            Some(classes) => list.with_critical_stretches(classes.clone())?,
            None => list,
        };
        Ok(AssembledBonds {
            operator: Box::new(list),
            cuts,
            form: BondForm::List,
        })
    }
}

/// Makes the list of a body whose bonds depend on their ends.
struct Listed<'a>(&'a CompositeBody<'a>);

impl ByLaw for Listed<'_> {
    type Output = AssembledBonds;

    fn listed<L: FastLaw, const D: usize>(self) -> Result<AssembledBonds> {
        self.0.list::<L, D>()
    }
}
