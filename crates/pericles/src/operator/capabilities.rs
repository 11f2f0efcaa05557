//! Optional capabilities of forces, each described by a trait.

use super::{
    BondForm, BondView, Breakable, DilatationView, Force, Limit, LinearOperator, LocalForce,
    PlasticView, SplitForce, StencilForce, StressView,
};
use crate::error::{PericlesError, Result};
use crate::neighbourhood::BondSet;
use crate::thermal::ThermalExpansion;

/// The optional capabilities of a force. Schemes, boundaries and observers that require a missing one return
/// an error.
#[derive(Default, Clone, Copy)]
pub struct Capabilities<'a> {
    /// Linearity in the displacement.
    pub linear: Linearity<'a>,
    /// Breaking bonds and pre-cracks.
    pub breaking: Option<&'a dyn Breakable>,
    /// The points on which the force on a point depends; required by schemes that evaluate the force on
    /// subsets of points.
    pub local: Option<&'a dyn LocalForce>,
    /// Evaluation as a sum over subsets of bonds.
    pub split: Option<&'a dyn SplitForce>,
    /// Whether the force is computed in single precision.
    pub single_precision: bool,
    /// Access to individual bonds.
    pub bonds: Option<&'a dyn BondView>,
    /// Dilatations of points, for state-based materials.
    pub dilatation: Option<&'a dyn DilatationView>,
    /// Stresses of points, for materials whose forces follow from them.
    pub stress: Option<&'a dyn StressView>,
    /// Plastic strains of points.
    pub plastic: Option<&'a dyn PlasticView>,
    /// Whether the force depends on the history of states. Schemes then end a step at each accepted state,
    /// even if no bond can break.
    pub path_dependent: bool,
    /// The force as data, if it consists of the bonds of a stencil at constant temperature.
    pub stencil: Option<&'a dyn StencilForce>,
    /// Thermal expansion of the material.
    pub thermal: Option<&'a ThermalExpansion>,
}

/// Linearity of a force in the displacement while no bond breaks.
#[derive(Default, Clone, Copy)]
pub enum Linearity<'a> {
    /// The force is nonlinear.
    #[default]
    Nonlinear,
    /// The force is linear, but computed in single precision.
    Rounded,
    /// The force is a linear map in double precision.
    Exact(&'a dyn LinearOperator),
}

impl dyn Force + '_ {
    /// Sets the thermal expansion of the material.
    ///
    /// # Errors
    /// A force without support for thermal expansion; errors of
    /// [`Expandable::expand`](crate::Expandable::expand).
    pub fn expand(&mut self, expansion: ThermalExpansion) -> Result<()> {
        match self.expandable_mut() {
            Some(material) => material.expand(expansion),
            None => Err(PericlesError::FormNotUsable {
                form: BondForm::Fastest.name(),
                reason: Limit::THERMAL_EXPANSION.reason,
            }),
        }
    }

    /// Returns whether the force is linear in the displacement while no bond breaks, in any precision.
    pub fn is_linear(&self) -> bool {
        !matches!(self.capabilities().linear, Linearity::Nonlinear)
    }

    /// Returns the force as a linear map in double precision, if it is one.
    pub fn as_linear(&self) -> Option<&dyn LinearOperator> {
        match self.capabilities().linear {
            Linearity::Exact(linear) => Some(linear),
            Linearity::Nonlinear | Linearity::Rounded => None,
        }
    }

    /// Returns [`Capabilities::bonds`].
    pub fn as_bonds(&self) -> Option<&dyn BondView> {
        self.capabilities().bonds
    }

    /// Returns [`Capabilities::local`].
    pub fn as_local(&self) -> Option<&dyn LocalForce> {
        self.capabilities().local
    }

    /// Returns [`Capabilities::split`].
    pub fn as_split(&self) -> Option<&dyn SplitForce> {
        self.capabilities().split
    }

    /// Returns the bonds of [`Capabilities::breaking`].
    pub fn bond_set(&self) -> Option<&dyn BondSet> {
        Some(self.capabilities().breaking?.bonds())
    }

    /// Returns whether any bond can break.
    pub fn can_break(&self) -> bool {
        let breaking = self.capabilities().breaking;
        breaking.is_some_and(|breaking| breaking.can_break())
    }

    /// Returns whether the end of a step changes the force: bonds can break, or the force is path-dependent.
    pub fn changes_at_step_ends(&self) -> bool {
        self.can_break() || self.capabilities().path_dependent
    }

    /// Returns the number of broken bonds, each counted once.
    pub fn broken_bonds(&self) -> u64 {
        self.bond_set().map_or(0, BondSet::broken_bonds)
    }

    /// Returns the energy dissipated by breaking bonds and by plastic flow, J.
    pub fn dissipated(&self) -> f64 {
        self.bond_set().map_or(0.0, BondSet::dissipated)
    }

    /// Sets the damage of each point, 0 … 1.
    pub fn damage_into(&self, out: &mut [f64]) {
        match self.capabilities().breaking {
            Some(breaking) => breaking.damage_into(out),
            None => out.fill(0.0),
        }
    }
}
