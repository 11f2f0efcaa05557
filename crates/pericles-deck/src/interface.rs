//! `[[interface]]`: bonds between two materials.

use pericles::material::{
    BondFailure, Fracture, FractureCalibration, InterfaceRule, InterfaceStiffness, StressState,
};
use serde::{Deserialize, Serialize};

use crate::body::BodyRead;
use crate::constants::{self, ConstantRules, Sums};
use crate::material::{Material, MaterialModel};
use crate::reader::{Item, Table};
use crate::state_based::SolidRules;
use crate::vocabulary::{INTERFACE_KEYS, INTERFACE_STIFFNESSES, MODULI, STRENGTHS};
use crate::words::Worded;

/// What bonds between two materials have in place of what follows from both.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialInterface {
    /// The names of the materials; none for all pairs of which no other interface says the same.
    #[serde(default)]
    pub between: Option<[String; 2]>,
    /// What the constant of bond-based bonds follows from; the harmonic mean of both materials' constants if nothing is given.
    #[serde(default, with = "crate::form")]
    pub stiffness: Option<InterfaceStiffness>,
    /// When the bonds break; at the lower limit of both materials if nothing is given.
    #[serde(default)]
    pub failure: Option<InterfaceFailure>,
}

/// When bonds between two materials break, by the kind of the materials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InterfaceFailure {
    /// Of bond-based materials.
    Bonds(#[serde(with = "crate::form")] Fracture),
    /// Of state-based and correspondence materials.
    StateBased(#[serde(with = "crate::form")] BondFailure),
}

impl MaterialInterface {
    /// Whether it is about bonds between two materials.
    pub fn joins(&self, pair: [&str; 2]) -> bool {
        let same = |[a, b]: [&str; 2]| a == pair[0] && b == pair[1];
        match &self.between {
            None => true,
            Some([a, b]) => same([a, b]) || same([b, a]),
        }
    }
}

/// All interfaces of a body whose materials have these names; `material` is the first of them.
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
            (true, None) => table.lacks_one_of(&["between"]),
            (false, _) => {}
        }
        given.push(between.clone());
    }
    if !INTERFACE_KEYS.iter().any(|key| table.has(key)) {
        table.lacks_one_of(INTERFACE_KEYS);
    }
    let breaks = STRENGTHS.iter().any(|key| table.has(key));
    let calibration = constants::fracture_calibration(&table, body, false);
    let state = body.state;
    let (stiffness, failure) = match &material.model {
        MaterialModel::Bonds(bonds) => {
            for key in ["failure", "stretch_definition"] {
                table.forbid(key, "it belongs to model = \"state-based\"");
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
                    "each end of a bond has the constants of its own material: there is nothing to average",
                );
            }
            let failure = match model {
                MaterialModel::Correspondence(_) => {
                    for key in ["failure", "stretch_definition"] {
                        table.forbid(key, "it belongs to model = \"state-based\"");
                    }
                    SolidRules::closing(state, calibration).failure(&table)
                }
                _ => state_based_failure(&table, state, calibration),
            };
            (Some(None), failure.map(InterfaceFailure::StateBased))
        }
    };
    table.finish();
    Some(MaterialInterface {
        between: between?,
        stiffness: stiffness?,
        failure: Some(failure?).filter(|_| breaks),
    })
}

fn state_based_failure(
    table: &Table<'_>,
    state: Option<StressState>,
    calibration: Option<FractureCalibration>,
) -> Option<BondFailure> {
    SolidRules::read(table, state, calibration, false).failure(table)
}

/// The rule or the modulus from which the constant of bonds follows.
fn stiffness(table: &Table<'_>, rules: &ConstantRules) -> Option<Option<InterfaceStiffness>> {
    let found = table.at_most_one(INTERFACE_STIFFNESSES)?;
    if !MODULI.iter().any(|key| table.has(key)) {
        table.forbid(
            "modulus",
            "it says how the bond constant follows from `youngs_modulus`, `bulk_modulus` or `shear_modulus`",
        );
    }
    Some(match found {
        None => None,
        Some(("rule", item)) => {
            let rule = item.choice("rule of interfaces", &InterfaceRule::words())?;
            Some(InterfaceStiffness::Rule(rule))
        }
        Some(_) => {
            let modulus = rules.modulus(table, constants::modulus(table, rules.state));
            Some(InterfaceStiffness::Modulus(modulus?))
        }
    })
}

/// Two different names of materials.
fn pair(item: &Item<'_>, names: &[String]) -> Option<[String; 2]> {
    let items = item.exactly(2, "two names of materials")?;
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
        item.out_of_range("two different names of materials");
        return None;
    }
    Some(pair)
}
