//! `[[interface]]`: bonds between two materials.

use pericles::material::{
    BondFailure, Fracture, InterfaceRule, InterfaceStiffness, StretchDefinition,
};
use serde::{Deserialize, Serialize};

use crate::body::BodyRead;
use crate::constants::{self, ConstantRules, Sums};
use crate::material::{Material, MaterialModel};
use crate::property::reject_functions;
use crate::reader::{Item, Table};
use crate::state_based::SolidRules;
use crate::vocabulary::{INTERFACE_KEYS, INTERFACE_STIFFNESSES, MODULI, STRENGTHS};
use crate::words::Worded;

/// Properties of bonds between two materials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialInterface {
    /// Names of the materials; none for all pairs without an interface of their own.
    #[serde(default)]
    pub between: Option<[String; 2]>,
    /// Source of the bond constant of bond-based materials; none for the harmonic mean of both materials' constants.
    #[serde(default, with = "crate::form")]
    pub stiffness: Option<InterfaceStiffness>,
    /// Failure of the bonds; none for the lower limit of both materials.
    #[serde(default)]
    pub failure: Option<InterfaceFailure>,
}

/// Failure of bonds between two materials, by material model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InterfaceFailure {
    /// Bond-based materials.
    Bonds(#[serde(with = "crate::form")] Fracture),
    /// State-based and correspondence materials.
    StateBased(#[serde(with = "crate::form")] BondFailure),
}

impl MaterialInterface {
    /// Returns whether it applies to a pair of materials.
    pub fn joins(&self, pair: [&str; 2]) -> bool {
        let same = |[a, b]: [&str; 2]| a == pair[0] && b == pair[1];
        match &self.between {
            None => true,
            Some([a, b]) => same([a, b]) || same([b, a]),
        }
    }
}

/// Reads all interfaces of a body with these materials; `material` is the first of them.
pub(crate) fn read(
    tables: Vec<Table<'_>>,
    names: &[String],
    material: Option<&Material>,
    body: &BodyRead,
) -> Option<Vec<MaterialInterface>> {
    let mut given: Vec<Option<[String; 2]>> = Vec::new();
    let read: Vec<Option<MaterialInterface>> = tables
        .into_iter()
        .map(|table| interface(table, (names, &mut given), material?, body))
        .collect();
    read.into_iter().collect()
}

fn interface(
    table: Table<'_>,
    (names, given): (&[String], &mut Vec<Option<[String; 2]>>),
    material: &Material,
    body: &BodyRead,
) -> Option<MaterialInterface> {
    let between = table.maybe("between", |item| pair(&item, names));
    if let Some(between) = &between {
        let same = |known: &Option<[String; 2]>| match (known, between) {
            (None, None) => true,
            (Some([a, b]), Some([c, d])) => (a, b) == (c, d) || (a, b) == (d, c),
            _ => false,
        };
        match (given.iter().any(same), table.optional("between")) {
            (true, Some(item)) => item.out_of_range("each pair of materials once, in either order"),
            (true, None) => table.requires_one_of(&["between"]),
            (false, _) => {}
        }
        given.push(between.clone());
    }
    if !INTERFACE_KEYS.iter().any(|key| table.has(key)) {
        table.requires_one_of(INTERFACE_KEYS);
    }
    let breaks = STRENGTHS.iter().any(|key| table.has(key));
    let calibration = constants::fracture_calibration(&table, body, false);
    let state = body.state;
    let (stiffness, failure) = match &material.model {
        MaterialModel::Bonds(bonds) => {
            for key in ["failure", "stretch_definition"] {
                table.forbid(key, "it requires model = \"state-based\"");
            }
            let rules = ConstantRules {
                state,
                sums: Sums::of(Some(&bonds.influence), Some(material.form), body),
                fracture: calibration,
            };
            let stiffness = stiffness(&table, &rules);
            let fracture = rules.fracture(constants::fracture(&table));
            (stiffness, fracture.map(InterfaceFailure::Bonds))
        }
        model => {
            for key in INTERFACE_STIFFNESSES {
                table.forbid(
                    key,
                    "each end point of a bond contributes the constants of its own material",
                );
            }
            let only = match model {
                MaterialModel::Correspondence(_) => {
                    table.forbid(
                        "stretch_definition",
                        "it requires model = \"state-based\"; correspondence materials use the definition `closing`",
                    );
                    Some(StretchDefinition::Closing)
                }
                _ => None,
            };
            let failure = SolidRules::interface(&table, state, calibration, only).failure(&table);
            (Some(None), failure.map(InterfaceFailure::StateBased))
        }
    };
    let numbers = reject_functions(&table);
    table.finish();
    numbers?;
    Some(MaterialInterface {
        between: between?,
        stiffness: stiffness?,
        failure: Some(failure?).filter(|_| breaks),
    })
}

/// Reads the rule or modulus from which the bond constant follows.
fn stiffness(table: &Table<'_>, rules: &ConstantRules) -> Option<Option<InterfaceStiffness>> {
    let found = table.at_most_one(INTERFACE_STIFFNESSES)?;
    if !MODULI.iter().any(|key| table.has(key)) {
        table.forbid(
            "modulus",
            "it requires `youngs_modulus`, `bulk_modulus` or `shear_modulus`",
        );
    }
    Some(match found {
        None => None,
        Some(("rule", item)) => {
            let rule = item.choice("interface rule", &InterfaceRule::words())?;
            Some(InterfaceStiffness::Rule(rule))
        }
        Some(_) => {
            let modulus = rules.modulus(table, constants::modulus(table, rules.state));
            Some(InterfaceStiffness::Modulus(modulus?))
        }
    })
}

/// Reads two different material names.
fn pair(item: &Item<'_>, names: &[String]) -> Option<[String; 2]> {
    let items = item.exactly(2, "two material names")?;
    let known = |item: &Item<'_>| {
        let name = item.text()?;
        if names.contains(&name) {
            return Some(name);
        }
        item.unknown_word("material", &name, names.iter().map(String::as_str));
        None
    };
    let (first, second) = (known(&items[0]), known(&items[1]));
    let pair = [first?, second?];
    if pair[0] == pair[1] {
        item.out_of_range("two different material names");
        return None;
    }
    Some(pair)
}
