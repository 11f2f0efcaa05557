//! What a force can do beside computing forces, each a trait of its own.

use super::{
    BondForm, BondView, Breakable, DilatationView, Force, Limit, LinearOperator, LocalForce,
    PlasticView, SplitForce,
};
use crate::error::{PericlesError, Result};
use crate::thermal::ThermalExpansion;

/// The capabilities of a force; schemes, boundaries and observers ask for those that they need, and are refused where one is missing.
#[derive(Default, Clone, Copy)]
pub struct Capabilities<'a> {
    /// Whether, and as what, the force is linear in the displacement.
    pub linear: Linearity<'a>,
    /// Its bonds can break, or be missing from the start.
    pub breaking: Option<&'a dyn Breakable>,
    /// It knows the points that the force on a point depends on, so that schemes may evaluate it on a part of the body at a time.
    pub local: Option<&'a dyn LocalForce>,
    /// It is a sum over bonds that can be summed up in parts.
    pub split: Option<&'a dyn SplitForce>,
    /// It is computed in single precision.
    pub single_precision: bool,
    /// Its bonds can be looked at one by one.
    pub bonds: Option<&'a dyn BondView>,
    /// Its points have a dilatation: it is state-based.
    pub dilatation: Option<&'a dyn DilatationView>,
    /// Its points can yield.
    pub plastic: Option<&'a dyn PlasticView>,
    /// It depends on the states that the body has gone through: schemes end a step at every state that they accept, whether bonds can break or not.
    pub path_dependent: bool,
    /// Its material expands with temperature.
    pub thermal: Option<&'a ThermalExpansion>,
}

/// Whether a force is linear in the displacement as long as no bond breaks.
#[derive(Default, Clone, Copy)]
pub enum Linearity<'a> {
    /// It is not.
    #[default]
    Nonlinear,
    /// It is, but computed in floats.
    Rounded,
    /// It is a linear map to double precision.
    Exact(&'a dyn LinearOperator),
}

impl dyn Force + '_ {
    /// Gives its material a thermal expansion from now on.
    ///
    /// # Errors
    /// A force that does not represent thermal expansion; those of [`Expandable::expand`](crate::Expandable::expand).
    pub fn expand(&mut self, expansion: ThermalExpansion) -> Result<()> {
        match self.expandable_mut() {
            Some(material) => material.expand(expansion),
            None => Err(PericlesError::FormNotUsable {
                form: BondForm::Fastest.name(),
                reason: Limit::THERMAL_EXPANSION.reason,
            }),
        }
    }

    /// Whether the force is linear in the displacement as long as no bond breaks, computed in whatever precision.
    pub fn is_linear(&self) -> bool {
        !matches!(self.capabilities().linear, Linearity::Nonlinear)
    }

    /// The force as a linear map to double precision, if it is one.
    pub fn as_linear(&self) -> Option<&dyn LinearOperator> {
        match self.capabilities().linear {
            Linearity::Exact(linear) => Some(linear),
            Linearity::Nonlinear | Linearity::Rounded => None,
        }
    }

    /// [`Capabilities::bonds`].
    pub fn as_bonds(&self) -> Option<&dyn BondView> {
        self.capabilities().bonds
    }

    /// [`Capabilities::local`].
    pub fn as_local(&self) -> Option<&dyn LocalForce> {
        self.capabilities().local
    }

    /// [`Capabilities::split`].
    pub fn as_split(&self) -> Option<&dyn SplitForce> {
        self.capabilities().split
    }

    /// Whether anything in the body can break.
    pub fn can_break(&self) -> bool {
        let breaking = self.capabilities().breaking;
        breaking.is_some_and(|breaking| breaking.can_break())
    }

    /// Whether the end of a step changes more than time: bonds may break, or the body keeps a history.
    pub fn changes_at_step_ends(&self) -> bool {
        self.can_break() || self.capabilities().path_dependent
    }

    /// Bonds broken so far, each counted once.
    pub fn broken_bonds(&self) -> u64 {
        let breaking = self.capabilities().breaking;
        breaking.map_or(0, |breaking| breaking.broken_bonds())
    }

    /// Energy dissipated by breaking so far, J.
    pub fn dissipated(&self) -> f64 {
        let breaking = self.capabilities().breaking;
        breaking.map_or(0.0, |breaking| breaking.dissipated())
    }

    /// Damage of each point, 0 … 1.
    pub fn damage_into(&self, out: &mut [f64]) {
        match self.capabilities().breaking {
            Some(breaking) => breaking.damage_into(out),
            None => out.fill(0.0),
        }
    }
}
