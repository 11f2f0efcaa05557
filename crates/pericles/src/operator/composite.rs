//! Bodies whose bonds depend on their two ends: several materials, corrected surfaces.

use super::{AssembledBonds, BondBody, BondForce, BondForm, Breaking};
use crate::error::{PericlesError, Result};
use crate::family::BondList;
use crate::material::{
    BondStretch, GreenBond, LinearBond, LiteralBond, PairClasses, PairLaw, SurfaceCorrection,
};
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

    /// The refusal of a form, by its name, that keeps bonds of one material only, without corrections.
    pub fn only_listed(&self, form: &'static str) -> PericlesError {
        let reason = if self.body.cloud.is_periodic() {
            "bonds through periodic faces are followed in bodies of one material only, which have no surfaces to correct either"
        } else {
            "several materials and surface corrections are kept as a list: \"list\" or \"fastest\""
        };
        PericlesError::FormNotUsable { form, reason }
    }

    /// The operator.
    ///
    /// # Errors
    /// Those of [`BondBody::operator`], and any form but a list.
    pub fn operator(&self, form: BondForm) -> Result<AssembledBonds> {
        if self.is_plain() {
            return self.body.operator(form);
        }
        if self.body.cloud.is_periodic() || !matches!(form, BondForm::Fastest | BondForm::List) {
            return Err(self.only_listed(form.name()));
        }
        match (self.body.material.law, self.body.cloud.dimension()) {
            (PairLaw::Linear, 1) => self.list::<LinearBond, 1>(),
            (PairLaw::Linear, 2) => self.list::<LinearBond, 2>(),
            (PairLaw::Linear, _) => self.list::<LinearBond, 3>(),
            (PairLaw::BondStretch, 1) => self.list::<BondStretch, 1>(),
            (PairLaw::BondStretch, 2) => self.list::<BondStretch, 2>(),
            (PairLaw::BondStretch, _) => self.list::<BondStretch, 3>(),
            (PairLaw::GreenStrain, 1) => self.list::<GreenBond, 1>(),
            (PairLaw::GreenStrain, 2) => self.list::<GreenBond, 2>(),
            (PairLaw::GreenStrain, _) => self.list::<GreenBond, 3>(),
            (PairLaw::Literal57, 1) => self.list::<LiteralBond, 1>(),
            // The body alone refuses it, with the reason.
            (PairLaw::Literal57, _) => self.body.operator(form),
            (PairLaw::Treated(..), _) => Err(PericlesError::FormNotUsable {
                form: form.name(),
                reason: "treatments of nonlinear laws are for bodies of one material without surface correction",
            }),
        }
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
        let factors = self.correction.factors(cloud, &bonds, material);
        let inclusion = |i: usize, j: usize| match stiffness {
            [] => 1.0,
            _ => 0.5 * (stiffness[i] + stiffness[j]),
        };
        let stiffness_of_pair = |bonds: &BondList, i: usize, j: usize| {
            let xi = bonds.vector(cloud, i, j);
            let alpha = material.influence.alpha_of(xi, material.horizon);
            let micromodulus = match self.classes {
                Some(classes) => classes.micromodulus(i, j),
                None => constants.micromodulus,
            };
            let relative = inclusion(i, j) * factors.of_bond(i, j, xi);
            relative * micromodulus * alpha * bonds.volume_factor(cloud, i, j)
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
