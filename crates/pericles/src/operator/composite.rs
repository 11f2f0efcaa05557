//! Bodies whose bonds depend on their two ends: several materials, corrected surfaces.

use super::assemble::fastest_form;
use super::by_law::{ByLaw, by_law};
use super::limits::{Feature, Features};
use super::{AssembledBonds, BondBody, BondForce, BondForm, Breaking, GridForce};
use crate::error::Result;
use crate::family::BondList;
use crate::material::{BondConstants, PairClasses, SurfaceCorrection, SurfaceFactors};
use crate::operator::fast_law::FastLaw;
use crate::space::{Sites, check_length};

/// A body of several materials, with inclusions or corrected surfaces.
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
        fastest_form(self.body.cloud, self.features())
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
        let dimension = self.body.cloud.dimension();
        by_law(self.body.material.law, dimension, OfBody(self, form))
    }

    /// The operator for a pair law.
    pub(super) fn operator_of<L: FastLaw, const D: usize>(
        &self,
        form: BondForm,
    ) -> Result<AssembledBonds> {
        OfBody(self, form).of_law::<L, D>()
    }

    /// The stiffness of bonds by their sites. `bonds` are the families without bonds that pre-cracks cut; only the correction of surfaces needs them.
    fn of_ends(&self, sites: &Sites, bonds: Option<&BondList>) -> EndStiffness<'_> {
        EndStiffness {
            constants: self.body.constants,
            inclusions: sites.spread(self.body.stiffness).into_owned(),
            factors: bonds.map_or(SurfaceFactors::None, |bonds| {
                self.correction.factors(bonds, self.body.material)
            }),
            classes: self.classes.map(|classes| classes.on_sites(sites)),
        }
    }

    fn check(&self) -> Result<()> {
        let points = self.body.cloud.len();
        if let Some(classes) = self.classes {
            let given = classes.of_point().len();
            check_length("the materials of the points", given, points)?;
        }
        self.body.check_stiffness()
    }

    /// The grid operator.
    ///
    /// # Errors
    /// See [`GridForce::new`].
    pub fn grid<L: FastLaw, const D: usize>(&self) -> Result<GridForce<L, D>> {
        self.check()?;
        let grid = self.body.grid_of_material::<L, D>()?;
        if self.is_plain() && self.body.stiffness.is_empty() {
            return Ok(grid);
        }
        let families = match self.correction {
            SurfaceCorrection::None => None,
            _ => Some(self.body.families()?.0),
        };
        let of_ends = self.of_ends(grid.sites(), families.as_ref());
        let micromodulus = self.body.constants.micromodulus;
        let grid = grid.with_factors(&|a, b, xi| {
            of_ends.factor(a, b, xi) * (of_ends.micromodulus(a, b) / micromodulus)
        });
        Ok(match self.classes {
            Some(classes) => grid.with_critical_stretches(classes),
            None => grid,
        })
    }

    fn list<L: FastLaw, const D: usize>(&self) -> Result<AssembledBonds> {
        self.check()?;
        if self.is_plain() {
            let (list, cuts) = self.body.list::<L, D>()?;
            return Ok(AssembledBonds {
                operator: Box::new(list),
                cuts,
                form: BondForm::List,
            });
        }
        let BondBody {
            cloud,
            material,
            constants,
            ..
        } = self.body;
        let (bonds, cuts) = self.body.families()?;
        let of_ends = self.of_ends(bonds.sites(), Some(&bonds));
        let stiffness_of_pair = |bonds: &BondList, a: usize, b: usize| {
            let xi = bonds.vector(a, b);
            let alpha = material.influence.alpha_of(xi, material.horizon);
            let micromodulus = of_ends.factor(a, b, xi) * of_ends.micromodulus(a, b);
            micromodulus * alpha * bonds.volume_factor(a, b)
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

/// What the stiffness of a body's bonds depends on at their ends.
struct EndStiffness<'a> {
    constants: &'a BondConstants,
    inclusions: Vec<f64>,
    factors: SurfaceFactors,
    classes: Option<PairClasses>,
}

impl EndStiffness<'_> {
    /// The constant c of a bond between two sites.
    fn micromodulus(&self, a: usize, b: usize) -> f64 {
        match &self.classes {
            Some(classes) => classes.micromodulus(a, b),
            None => self.constants.micromodulus,
        }
    }

    /// What multiplies it, for a bond with the vector ξ, m; the same from both ends.
    fn factor(&self, a: usize, b: usize, xi: [f64; 3]) -> f64 {
        let inclusion = match &self.inclusions[..] {
            [] => 1.0,
            stiffness => 0.5 * (stiffness[a] + stiffness[b]),
        };
        inclusion * self.factors.of_bond(a, b, xi)
    }
}

impl BondBody<'_> {
    /// The faster of grid and list.
    pub fn fastest_form(&self) -> BondForm {
        fastest_form(self.cloud, self.features())
    }

    /// The operator.
    ///
    /// # Errors
    /// A form that does not represent the body ([`BondForm::check`]), a law that is not defined in this dimension, a horizon that reaches no neighbour, an unusable crack.
    pub fn operator(&self, form: BondForm) -> Result<AssembledBonds> {
        CompositeBody::from(self.clone()).operator(form)
    }

    /// The grid operator.
    ///
    /// # Errors
    /// See [`GridForce::new`].
    pub fn grid<L: FastLaw, const D: usize>(&self) -> Result<GridForce<L, D>> {
        CompositeBody::from(self.clone()).grid()
    }
}

/// Makes the operator of a body in a form.
struct OfBody<'a>(&'a CompositeBody<'a>, BondForm);

impl ByLaw for OfBody<'_> {
    type Output = AssembledBonds;

    fn of_law<L: FastLaw, const D: usize>(self) -> Result<AssembledBonds> {
        let Self(body, form) = self;
        let form = match form {
            BondForm::Fastest => body.fastest_form(),
            chosen => chosen,
        };
        form.check(body.features())?;
        if form == BondForm::List {
            return body.list::<L, D>();
        }
        let mut grid = body.grid::<L, D>()?;
        if form == BondForm::FloatGrid {
            grid = grid.in_floats();
        }
        Ok(AssembledBonds {
            cuts: grid.cuts().to_vec(),
            operator: Box::new(grid),
            form,
        })
    }
}
