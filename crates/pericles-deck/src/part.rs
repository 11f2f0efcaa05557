//! `[[material.part]]` and `[material.interface]`: several materials in one body.

use pericles::material::{BondFailure, Fracture, GivenConstants, InterfaceRule, Modulus};
use serde::{Deserialize, Serialize};

use crate::constants::{self, ConstantRules};
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::set::{self, SetNames};
use crate::state_based::SolidRules;
use crate::vocabulary::PLACES;

/// A material that some points have in place of the body's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// Where it is.
    pub place: PartPlace,
    /// Mass density ρ, kg/m³.
    pub density: f64,
    /// Elastic constants and breaking, of the kind of the body's material.
    pub constants: PartConstants,
}

/// Elastic constants and breaking of a part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PartConstants {
    /// Of a bond-based material.
    Bonds {
        /// Elastic modulus.
        #[serde(with = "crate::form")]
        modulus: Modulus,
        /// Breaking.
        #[serde(with = "crate::form")]
        fracture: Fracture,
    },
    /// Of a state-based material.
    StateBased {
        /// Two of the elastic constants.
        #[serde(with = "crate::form")]
        elastic: GivenConstants,
        /// Breaking.
        #[serde(with = "crate::form")]
        failure: BondFailure,
    },
}

/// How the constants of a part are read.
pub(crate) enum PartRules<'r> {
    Bonds(&'r ConstantRules),
    StateBased(&'r SolidRules),
}

impl PartRules<'_> {
    fn constants(&self, table: &Table<'_>) -> Option<PartConstants> {
        match self {
            Self::Bonds(rules) => {
                let modulus = rules.modulus(table, constants::modulus(table, rules.state));
                constants::poisson_ratio(table, rules.state);
                let fracture = rules.fracture(constants::fracture(table));
                Some(PartConstants::Bonds {
                    modulus: modulus?,
                    fracture: fracture?,
                })
            }
            Self::StateBased(rules) => {
                let (elastic, failure) = (rules.elastic(table), rules.failure(table));
                Some(PartConstants::StateBased {
                    elastic: elastic?,
                    failure: failure?,
                })
            }
        }
    }
}

/// The points of a part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PartPlace {
    /// Those of a set.
    Set(String),
    /// Those of some blocks.
    Blocks(Vec<u32>),
}

/// Bonds between two materials.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialInterface {
    /// How their constant follows from both materials'.
    #[serde(default, with = "crate::form")]
    pub rule: InterfaceRule,
    /// Critical stretches of bonds between two materials, by their numbers: 0 is the body's, then the parts'.
    #[serde(default)]
    pub critical_stretches: Vec<([u8; 2], f64)>,
}

/// All parts, in the order in which later ones replace earlier ones.
pub(crate) fn parts(
    tables: Vec<Table<'_>>,
    rules: &PartRules<'_>,
    sets: &SetNames,
) -> Option<Vec<Part>> {
    let mut names: Vec<String> = Vec::new();
    let parts: Vec<Option<Part>> = tables
        .into_iter()
        .map(|table| part(table, rules, sets, &mut names))
        .collect();
    parts.into_iter().collect()
}

fn part(
    table: Table<'_>,
    rules: &PartRules<'_>,
    sets: &SetNames,
    names: &mut Vec<String>,
) -> Option<Part> {
    let name = table.required("name").and_then(|item| {
        let name = item.text()?;
        if names.contains(&name) {
            item.report(Fault::BadName {
                name,
                reason: "another part has it",
                allowed: "allowed: a name of its own for each part",
            });
            return None;
        }
        names.push(name.clone());
        Some(name)
    });
    let place = table.exactly_one(PLACES).and_then(|(key, item)| match key {
        "set" => sets.reference(&item).map(PartPlace::Set),
        _ => set::blocks(&item).map(PartPlace::Blocks),
    });
    let density = table
        .required("density")
        .and_then(|item| item.positive(Quantity::Density));
    let constants = rules.constants(&table);
    for key in [
        "model",
        "horizon",
        "horizon_ratio",
        "influence",
        "volume_correction",
        "surface_correction",
        "fracture_calibration",
        "strains",
        "failure",
        "stretch_definition",
    ] {
        table.forbid(key, "[material] says it for all bonds of the body");
    }
    table.finish();
    Some(Part {
        name: name?,
        place: place?,
        density: density?,
        constants: constants?,
    })
}

/// `[material.interface]`; `names` are those of the materials, the body's first. Bonds of state-based materials have no constant of their own.
pub(crate) fn interface(
    table: Table<'_>,
    names: &[Option<String>],
    state_based: bool,
) -> Option<MaterialInterface> {
    let rule = if state_based {
        table.forbid(
            "rule",
            "each end of a bond has the constants of its own state-based material: there is nothing to average",
        );
        Some(InterfaceRule::default())
    } else {
        rule(&table)
    };

    let mut given: Vec<[u8; 2]> = Vec::new();
    let pairs: Vec<Option<([u8; 2], f64)>> = table
        .tables("pair")
        .into_iter()
        .map(|table| {
            let between = table
                .required("between")
                .and_then(|item| new_pair(&item, names, &mut given));
            let stretch = table
                .required("critical_stretch")
                .and_then(|item| item.positive(Quantity::Number));
            table.finish();
            Some((between?, stretch?))
        })
        .collect();
    table.finish();
    Some(MaterialInterface {
        rule: rule?,
        critical_stretches: pairs.into_iter().collect::<Option<_>>()?,
    })
}

/// How the constant of a bond between two materials follows from both.
fn rule(table: &Table<'_>) -> Option<InterfaceRule> {
    table.choice_or_first(
        "rule",
        "rule of interfaces",
        &[
            ("harmonic", InterfaceRule::Harmonic),
            ("arithmetic", InterfaceRule::Arithmetic),
            ("weaker", InterfaceRule::Weaker),
        ],
    )
}

/// A pair of materials that no earlier entry names.
fn new_pair(
    item: &Item<'_>,
    names: &[Option<String>],
    given: &mut Vec<[u8; 2]>,
) -> Option<[u8; 2]> {
    let between = pair(item, names)?;
    let [a, b] = between;
    if given.contains(&[a, b]) || given.contains(&[b, a]) {
        item.out_of_range("each pair of materials once, in either order");
        return None;
    }
    given.push(between);
    Some(between)
}

/// Two different names of materials, as their numbers.
fn pair(item: &Item<'_>, names: &[Option<String>]) -> Option<[u8; 2]> {
    let items = item.exactly(2, "two names of materials")?;
    let number = |item: &Item<'_>| {
        let name = item.text()?;
        let found = names.iter().position(|known| known.as_ref() == Some(&name));
        if found.is_none() {
            let known = names.iter().flatten().map(String::as_str);
            item.unknown_word("material", &name, known);
        }
        found.map(|number| number as u8)
    };
    let (first, second) = (number(&items[0]), number(&items[1]));
    let pair = [first?, second?];
    if pair[0] == pair[1] {
        item.out_of_range("two different names of materials");
        return None;
    }
    Some(pair)
}
