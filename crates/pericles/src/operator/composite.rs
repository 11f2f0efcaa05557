//! Bodies of several materials, with inclusions, surface correction or softening bonds.

use super::assemble::fastest_form;
use super::by_law::{ByLaw, by_law};
use super::limits::{Feature, Features};
use super::list::{PointStrengths, no_softening};
use super::{
    AssembledBonds, BondBody, BondForce, BondForm, Breaking, Force, GridForce, SofteningForce,
};
use crate::error::{PericlesError, Result};
use crate::family::BondList;
use crate::material::{
    BondConstants, MaterialPairs, Softening, Strength, SurfaceCorrection, SurfaceFactors,
};
use crate::operator::fast_law::VectorLaw;
use crate::space::{Sites, check_length};

/// A bond-based body of several materials, with inclusions, surface correction or softening bonds.
///
/// The force of a bond is c_ab · g · ½(k_i + k_j) · α κ V_j s n with the constant c_ab of the materials of
/// its ends ([`MaterialPairs`]), the factor g of [`SurfaceCorrection`] and the relative stiffness k of
/// [`BondBody::stiffness`]. All bonds have the law, horizon, influence function and partial volumes of the
/// body's material.
#[derive(Debug, Clone)]
pub struct CompositeBody<'a> {
    /// Points, law, horizon, pre-cracks; its constants apply if there are no classes.
    pub body: BondBody<'a>,
    /// Material of each point.
    pub classes: Option<&'a MaterialPairs>,
    /// Surface correction.
    pub correction: SurfaceCorrection,
    /// Softening law, if bonds soften before they break.
    pub softening: Option<Softening>,
    /// Strengths of the materials that keep bonds elastic until the stress reaches them; empty for none. They require a
    /// softening law.
    pub strengths: &'a [Strength],
}

impl<'a> From<BondBody<'a>> for CompositeBody<'a> {
    /// Creates a body of one material without surface correction.
    fn from(body: BondBody<'a>) -> Self {
        Self {
            body,
            classes: None,
            correction: SurfaceCorrection::None,
            softening: None,
            strengths: &[],
        }
    }
}

impl CompositeBody<'_> {
    /// Returns whether the body has one material and no surface correction.
    pub fn is_plain(&self) -> bool {
        self.classes.is_none() && self.correction == SurfaceCorrection::None
    }

    /// Returns the faster of grid and list.
    pub fn fastest_form(&self) -> BondForm {
        fastest_form(self.body.cloud, self.features())
    }

    /// Returns the features of the body that not every kernel supports.
    pub fn features(&self) -> Features {
        let correction = self.correction != SurfaceCorrection::None;
        let features = self.body.features();
        let features = features
            .with(Feature::SurfaceCorrection, correction)
            .with(Feature::Softening, self.softening.is_some());
        match self.classes {
            None => features,
            Some(classes) => features.with(Feature::SeveralMaterials, true).with(
                Feature::Breaking,
                classes.smallest_critical_stretch().is_finite(),
            ),
        }
    }

    /// Returns the force operator.
    ///
    /// # Errors
    /// Errors of [`BondBody::operator`].
    pub fn operator(&self, form: BondForm) -> Result<AssembledBonds> {
        if self.correction == SurfaceCorrection::Ghosts {
            return self.with_ghosts(form);
        }
        let dimension = self.body.cloud.dimension();
        by_law(self.body.material.law, dimension, OfBody(self, form))
    }

    /// Returns the force operator for a pair law.
    pub(super) fn operator_of<L: VectorLaw, const D: usize>(
        &self,
        form: BondForm,
    ) -> Result<AssembledBonds> {
        OfBody(self, form).of_law::<L, D>()
    }

    /// Returns the stiffness of bonds as a function of their sites. `bonds`, the families without bonds cut
    /// by pre-cracks, are required for surface correction only.
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
        if self.correction == SurfaceCorrection::Ghosts {
            return Err(PericlesError::NoGhostLayer {
                reason: "a force of the body alone has no ghost points; build it with `CompositeBody::operator`".into(),
            });
        }
        let points = self.body.cloud.len();
        if let Some(classes) = self.classes {
            let given = classes.of_point().len();
            check_length("the materials of the points", given, points)?;
        }
        self.body.check_stiffness()
    }

    /// Returns the stencil operator.
    ///
    /// # Errors
    /// See [`GridForce::new`].
    pub fn grid<L: VectorLaw, const D: usize>(&self) -> Result<GridForce<L, D>> {
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

    fn list<L: VectorLaw, const D: usize>(&self) -> Result<AssembledBonds> {
        self.check()?;
        if self.is_plain() {
            let (list, cuts) = self.body.list::<L, D>()?;
            let of_ends = self.of_ends(list.sites(), None);
            return Ok(AssembledBonds {
                operator: self.softened(list, &of_ends)?,
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
            operator: self.softened(list, &of_ends)?,
            cuts,
            form: BondForm::List,
        })
    }

    /// Adds the softening law of the body, if any, to a list operator.
    fn softened<L: VectorLaw, const D: usize>(
        &self,
        list: BondForce<L, D>,
        of_ends: &EndStiffness<'_>,
    ) -> Result<Box<dyn Force>> {
        match &self.softening {
            None => Ok(Box::new(list)),
            // The loops of softening are compiled for laws that support it only.
            Some(softening) => {
                if !L::OF_STRETCH {
                    return Err(no_softening());
                }
                let force = SofteningForce::new(list, self.classes, softening)?;
                if self.strengths.is_empty() {
                    return Ok(Box::new(force));
                }
                let strengths = PointStrengths {
                    materials: self.strengths,
                    constants: &|a, b, xi| {
                        let constant = of_ends.micromodulus(a, b) * of_ends.inclusion(a, b);
                        [constant, of_ends.factors.of_bond(a, b, xi)]
                    },
                };
                Ok(Box::new(force.with_strengths(&strengths)?))
            }
        }
    }
}

/// Data at the ends of bonds that determine their stiffness.
struct EndStiffness<'a> {
    constants: &'a BondConstants,
    inclusions: Vec<f64>,
    factors: SurfaceFactors,
    classes: Option<MaterialPairs>,
}

impl EndStiffness<'_> {
    /// Returns the constant c of a bond between two sites.
    fn micromodulus(&self, a: usize, b: usize) -> f64 {
        match &self.classes {
            Some(classes) => classes.micromodulus(a, b),
            None => self.constants.micromodulus,
        }
    }

    /// Returns the factor of the constant for a bond with the vector ξ, m; it is the same from both ends.
    fn factor(&self, a: usize, b: usize, xi: [f64; 3]) -> f64 {
        self.inclusion(a, b) * self.factors.of_bond(a, b, xi)
    }

    /// Returns the factor of the constant for a bond by inclusions.
    fn inclusion(&self, a: usize, b: usize) -> f64 {
        match &self.inclusions[..] {
            [] => 1.0,
            stiffness => 0.5 * (stiffness[a] + stiffness[b]),
        }
    }
}

impl BondBody<'_> {
    /// Returns the faster of grid and list.
    pub fn fastest_form(&self) -> BondForm {
        fastest_form(self.cloud, self.features())
    }

    /// Returns the force operator.
    ///
    /// # Errors
    /// A kernel that does not support the body ([`BondForm::check`]), a law that is not defined in this
    /// dimension, a horizon without neighbours, an invalid crack.
    pub fn operator(&self, form: BondForm) -> Result<AssembledBonds> {
        CompositeBody::from(self.clone()).operator(form)
    }

    /// Returns the stencil operator.
    ///
    /// # Errors
    /// See [`GridForce::new`].
    pub fn grid<L: VectorLaw, const D: usize>(&self) -> Result<GridForce<L, D>> {
        CompositeBody::from(self.clone()).grid()
    }
}

/// Constructs the operator of a body with a kernel.
struct OfBody<'a>(&'a CompositeBody<'a>, BondForm);

impl ByLaw for OfBody<'_> {
    type Output = AssembledBonds;

    fn of_law<L: VectorLaw, const D: usize>(self) -> Result<AssembledBonds> {
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
