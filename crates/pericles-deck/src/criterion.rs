//! `failure = "principal-stress"` and `failure = "expression"`: bonds that break by stress or strain at their ends.

use pericles::Result;
use pericles::material::{BondCriterion, BondState, Criterion, PrincipalStress};
use serde::{Deserialize, Serialize};

use crate::expression::BondExpression;
use crate::fault::Fault;
use crate::property::{MaterialProperty, number_of};
use crate::reader::Table;
use crate::vocabulary::{BY_STATE, STRENGTHS};

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

/// Reads the criterion of a material whose `failure` is one of [`BY_STATE`]; `Some(None)` for other materials.
pub(crate) fn read(
    table: &Table<'_>,
    dimension: Option<usize>,
) -> Option<Option<FailureCriterion>> {
    let failure = table.optional("failure");
    let word = failure.and_then(|item| item.word()).unwrap_or_default();
    for (other, key) in BY_STATE.into_iter().filter(|(other, _)| *other != word) {
        table.forbid(key, &format!("it requires failure = \"{other}\""));
    }
    let Some((_, own)) = BY_STATE.into_iter().find(|(own, _)| *own == word) else {
        return Some(None);
    };
    for &key in STRENGTHS.iter().chain(&["stretch_definition"]) {
        table.forbid(
            key,
            &format!("with failure = \"{word}\" bonds break by `{own}`, which determines the dissipated energy"),
        );
    }
    let item = table.required(own)?;
    let criterion = match own {
        "strength" => {
            FailureCriterion::PrincipalStress(number_of(&item, MaterialProperty::Strength)?)
        }
        _ => {
            let text = item.text()?;
            let parsed = BondExpression::parse(&text, dimension.unwrap_or(3));
            let parsed = parsed.map_err(|malformed| {
                let reason = malformed.reason;
                item.report(Fault::bad_expression(text, reason));
            });
            FailureCriterion::Expression(parsed.ok()?)
        }
    };
    Some(Some(criterion))
}
