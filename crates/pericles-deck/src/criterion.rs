//! `failure = "principal-stress"` and `failure = "expression"`: bonds that break by stress or strain at their ends.

use pericles::Result;
use pericles::material::{BondCriterion, BondState, Criterion, PrincipalStress};
use serde::{Deserialize, Serialize};

use crate::expression::BondExpression;

/// A failure criterion of stress and strain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FailureCriterion {
    /// The largest principal stress that a bond bears, Pa.
    PrincipalStress(f64),
    /// The failure index as a function of stress and strain.
    Expression(BondExpression),
}

impl FailureCriterion {
    /// Returns the criterion of the engine.
    ///
    /// # Errors
    /// A strength that is not positive.
    pub fn criterion(&self) -> Result<Criterion> {
        Ok(match self {
            Self::PrincipalStress(strength) => Criterion::new(PrincipalStress::new(*strength)?),
            Self::Expression(expression) => Criterion::new(expression.clone()),
        })
    }
}

impl BondCriterion for BondExpression {
    fn failure_index(&self, bond: &BondState) -> f64 {
        self.value(bond)
    }

    fn varies(&self) -> bool {
        BondExpression::varies(self)
    }

    fn words(&self) -> String {
        format!("where {} exceeds 1", self.text())
    }
}
