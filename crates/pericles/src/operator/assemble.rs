//! The choice of an operator's form for a body.

use std::sync::Arc;

use super::{BondForce, BondForm, Breaking, DamageMeasure, FastLaw, Force, GridForce};
use crate::error::{PericlesError, Result};
use crate::family::{BondList, Crack, Cut, EndRule};
use crate::lanes::LANES;
use crate::material::{
    BondConstants, BondMaterial, BondStretch, CubicLaw, GreenBond, LinearBond, LiteralBond,
    PairLaw, SecondOrder, Trapezoidal, Treated, Treatment,
};
use crate::space::{PointCloud, check_length};

/// A body of one bond-based material: all that its operator is made of.
#[derive(Debug, Clone)]
pub struct BondBody<'a> {
    /// The points.
    pub cloud: &'a Arc<PointCloud>,
    /// The material.
    pub material: &'a BondMaterial,
    /// Its constants on this body.
    pub constants: &'a BondConstants,
    /// Pre-cracks.
    pub cracks: &'a [(Crack, EndRule)],
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
    /// Stiffness of each point over the material's; empty if all are the same. A bond has the mean of its ends.
    pub stiffness: &'a [f64],
    /// How damage weighs bonds.
    pub damage: DamageMeasure,
}

/// An operator, and what each pre-crack removed from it.
pub struct AssembledBonds {
    /// The operator.
    pub operator: Box<dyn Force>,
    /// One for each pre-crack.
    pub cuts: Vec<Cut>,
    /// The form taken, never [`BondForm::Fastest`].
    pub form: BondForm,
}

/// Places of the padded box per point above which the list is better: the box is mostly empty, or very short along x.
const SPARSE: usize = 8;

impl<'a> BondBody<'a> {
    /// A body without pre-cracks, of one stiffness, all of whose bonds may break, with the default measure of damage.
    pub fn new(
        cloud: &'a Arc<PointCloud>,
        material: &'a BondMaterial,
        constants: &'a BondConstants,
    ) -> Self {
        Self {
            cloud,
            material,
            constants,
            cracks: &[],
            no_fail: &[],
            stiffness: &[],
            damage: DamageMeasure::default(),
        }
    }
}

impl BondBody<'_> {
    /// The faster of grid and list.
    pub fn fastest_form(&self) -> BondForm {
        match self.cloud.lattice() {
            Some(lattice) if self.stiffness.is_empty() => {
                let [x, y, z] = lattice.shape;
                let places = x.next_multiple_of(LANES) * y * z;
                if places <= SPARSE * self.cloud.len().max(LANES) {
                    BondForm::Grid
                } else {
                    BondForm::List
                }
            }
            _ => BondForm::List,
        }
    }

    /// The operator.
    ///
    /// # Errors
    /// A horizon that reaches no neighbour, an unusable crack, [`BondForm::Grid`] without a lattice; a form that does not fit.
    pub fn operator(&self, form: BondForm) -> Result<AssembledBonds> {
        match (self.material.law, self.cloud.dimension()) {
            (PairLaw::Linear, 1) => self.operator_of::<LinearBond, 1>(form),
            (PairLaw::Linear, 2) => self.operator_of::<LinearBond, 2>(form),
            (PairLaw::Linear, 3) => self.operator_of::<LinearBond, 3>(form),
            (PairLaw::BondStretch, 1) => self.operator_of::<BondStretch, 1>(form),
            (PairLaw::BondStretch, 2) => self.operator_of::<BondStretch, 2>(form),
            (PairLaw::BondStretch, 3) => self.operator_of::<BondStretch, 3>(form),
            (PairLaw::GreenStrain, 1) => self.listed::<GreenBond, 1>(form),
            (PairLaw::GreenStrain, 2) => self.listed::<GreenBond, 2>(form),
            (PairLaw::GreenStrain, 3) => self.listed::<GreenBond, 3>(form),
            (PairLaw::Literal57, 1) => self.listed::<LiteralBond, 1>(form),
            (PairLaw::Treated(law, treatment), 1) => self.treated(law, treatment, form),
            (PairLaw::Treated(..), dimension) => Err(PericlesError::WrongDimension {
                what: "a treatment of a nonlinear law",
                needed: "1",
                dimension,
            }),
            (PairLaw::Literal57, dimension) => Err(PericlesError::WrongDimension {
                what: "the law of equation 57 as printed",
                needed: "1",
                dimension,
            }),
            (_, dimension) => Err(PericlesError::WrongDimension {
                what: "a bond-based material",
                needed: "1, 2 or 3",
                dimension,
            }),
        }
    }

    fn treated(
        &self,
        law: CubicLaw,
        treatment: Treatment,
        form: BondForm,
    ) -> Result<AssembledBonds> {
        match (law, treatment) {
            (CubicLaw::GreenStrain, Treatment::SecondOrder) => {
                self.listed::<Treated<GreenBond, SecondOrder>, 1>(form)
            }
            (CubicLaw::GreenStrain, Treatment::Trapezoidal) => {
                self.listed::<Treated<GreenBond, Trapezoidal>, 1>(form)
            }
            (CubicLaw::Literal57, Treatment::SecondOrder) => {
                self.listed::<Treated<LiteralBond, SecondOrder>, 1>(form)
            }
            (CubicLaw::Literal57, Treatment::Trapezoidal) => {
                self.listed::<Treated<LiteralBond, Trapezoidal>, 1>(form)
            }
        }
    }

    /// Laws that only the list computes.
    fn listed<L: FastLaw, const D: usize>(&self, form: BondForm) -> Result<AssembledBonds> {
        let refuse = |form: BondForm, reason| {
            Err(PericlesError::FormNotUsable {
                form: form.name(),
                reason,
            })
        };
        if self.cloud.is_periodic() {
            return refuse(
                form,
                "bonds through periodic faces are followed for the linear law only; use model = \"linear\"",
            );
        }
        match form {
            BondForm::Fastest | BondForm::List => {
                let (list, cuts) = self.list::<L, D>()?;
                Ok(AssembledBonds {
                    operator: Box::new(list),
                    cuts,
                    form: BondForm::List,
                })
            }
            BondForm::Grid | BondForm::FloatGrid => {
                refuse(form, "this law is kept as a list: \"list\" or \"fastest\"")
            }
        }
    }

    pub(super) fn operator_of<L: FastLaw, const D: usize>(
        &self,
        form: BondForm,
    ) -> Result<AssembledBonds> {
        let form = match form {
            BondForm::Fastest => self.fastest_form(),
            chosen => chosen,
        };
        let (operator, cuts): (Box<dyn Force>, _) = match form {
            _ if self.cloud.is_periodic() => {
                return Err(PericlesError::FormNotUsable {
                    form: form.name(),
                    reason: "it does not follow bonds through periodic faces; use \"convolution\" or \"spectral\"",
                });
            }
            BondForm::List => {
                let (list, cuts) = self.list::<L, D>()?;
                (Box::new(list), cuts)
            }
            _ if !self.stiffness.is_empty() => return Err(PericlesError::OneStencil),
            _ => {
                let mut grid = self.grid::<L, D>()?;
                if form == BondForm::FloatGrid {
                    grid = grid.in_floats();
                }
                let cuts = grid.cuts().to_vec();
                (Box::new(grid), cuts)
            }
        };
        Ok(AssembledBonds {
            operator,
            cuts,
            form,
        })
    }

    /// The grid operator, of the material itself everywhere.
    ///
    /// # Errors
    /// See [`GridForce::new`].
    pub fn grid<L: FastLaw, const D: usize>(&self) -> Result<GridForce<L, D>> {
        GridForce::new(
            self.cloud.clone(),
            self.material,
            self.constants,
            self.cracks,
            self.no_fail,
            self.damage,
        )
    }

    fn check_stiffness(&self) -> Result<()> {
        match self.stiffness {
            [] => Ok(()),
            given => check_length(
                "the stiffnesses of the points",
                given.len(),
                self.cloud.len(),
            ),
        }
    }

    /// The families without the bonds that pre-cracks cut, and what each crack removed.
    pub(super) fn families(&self) -> Result<(BondList, Vec<Cut>)> {
        self.check_stiffness()?;
        let material = self.material;
        let mut bonds = BondList::new(self.cloud, material.horizon, material.volume_correction)?;
        let cuts = self
            .cracks
            .iter()
            .map(|(crack, rule)| bonds.cut(self.cloud, crack, *rule))
            .collect::<Result<_>>()?;
        Ok((bonds, cuts))
    }

    /// The list operator, and what each pre-crack removed from it.
    ///
    /// # Errors
    /// A horizon that reaches no neighbour, an unusable crack.
    pub fn list<L: FastLaw, const D: usize>(&self) -> Result<(BondForce<L, D>, Vec<Cut>)> {
        let material = self.material;
        let (bonds, cuts) = self.families()?;
        let constants = self.constants;
        let mean = |i: usize, j: usize| match self.stiffness {
            [] => 1.0,
            stiffness => 0.5 * (stiffness[i] + stiffness[j]),
        };
        let list = BondForce::with_pair_stiffness(
            self.cloud.clone(),
            bonds,
            &|i, j, xi| {
                let alpha = material.influence.alpha_of(xi, material.horizon);
                mean(i, j) * (constants.micromodulus * alpha)
            },
            Breaking {
                critical_stretch: constants.critical_stretch,
                no_fail: self.no_fail,
            },
            self.damage,
        )?;
        Ok((list, cuts))
    }
}
