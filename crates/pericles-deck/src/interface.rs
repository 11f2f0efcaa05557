//! `[[interface]]`: bonds between two materials.

use pericles::material::{
    BondFailure, Calibration, ElasticModulus, Fracture, FractureCalibration, InterfaceRule,
    InterfaceStiffness, Modulus, StressState, StretchDefinition,
};
use pericles_deck_derive::{DeckTable, DeckWords};
use serde::{Deserialize, Serialize};

use crate::body::BodyRead;
use crate::constants::{ConstantRules, Sums, fracture_calibration};
use crate::declaration::{Check, DeckKeys, DeckTable};
use crate::form::described;
use crate::key_path::KeyPath;
use crate::material::{Material, MaterialModel};
use crate::reader::{Item, Table};
use crate::state_based::{failure_of, strength_of};
use crate::vocabulary::STRENGTHS;

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

#[derive(Serialize, Deserialize)]
#[serde(
    remote = "InterfaceStiffness",
    rename_all = "snake_case",
    deny_unknown_fields
)]
enum InterfaceStiffnessForm {
    Rule(#[serde(with = "crate::form")] InterfaceRule),
    Modulus(#[serde(with = "crate::form")] Modulus),
}

described!(InterfaceStiffness: InterfaceStiffnessForm);

/// Bonds between two materials. Any number of tables. Default: harmonic mean of both bond constants, and the lower strength of
/// both materials.
#[derive(DeckTable)]
#[deck(
    scope = InterfaceScope<'s>,
    at_least_one("rule", "youngs_modulus", "bulk_modulus", "shear_modulus", "fracture_energy", "critical_stretch"),
    at_most_one("rule", "youngs_modulus", "bulk_modulus", "shear_modulus"),
    at_most_one("fracture_energy", "critical_stretch")
)]
struct GivenInterface {
    /// Names of the two materials. Default: all pairs without a table of their own.
    #[deck(with = pair)]
    between: Option<[String; 2]>,
    /// Bond-based: bond constant c of the interface from those of both materials, c₁ and c₂. `harmonic`: 2c₁c₂/(c₁+c₂);
    /// `arithmetic`: (c₁+c₂)/2; `weaker`: the smaller one. Not for state-based materials, where each end point of a bond
    /// contributes its own constants.
    #[deck(forbid_if(scope.is_solid(), OWN_CONSTANTS))]
    rule: Option<InterfaceRule>,
    /// Bond-based: Young's modulus of the interface, which determines the bond constant.
    #[deck(quantity = Modulus, range = POSITIVE, forbid_if(scope.is_solid(), OWN_CONSTANTS))]
    youngs_modulus: Option<f64>,
    /// Bond-based: bulk modulus of the interface, which determines the bond constant.
    #[deck(quantity = Modulus, range = POSITIVE, forbid_if(scope.is_solid(), OWN_CONSTANTS))]
    bulk_modulus: Option<f64>,
    /// Bond-based: shear modulus of the interface, which determines the bond constant.
    #[deck(quantity = Modulus, range = POSITIVE, forbid_if(scope.is_solid(), OWN_CONSTANTS))]
    shear_modulus: Option<f64>,
    /// As in `[material]`.
    #[deck(
        default = Calibration::Continuum,
        forbid_if(
            [youngs_modulus, bulk_modulus, shear_modulus].iter().all(|given| *given == Some(&None)),
            "it requires `youngs_modulus`, `bulk_modulus` or `shear_modulus`"
        )
    )]
    modulus: Calibration,
    /// Fracture energy of the interface per crack area. It determines the critical stretch or bond energy of the interface bonds
    /// as for a material: with their bond constant (bond-based), or with the mean of both materials' constants (state-based).
    #[deck(quantity = SurfaceEnergy, range = POSITIVE)]
    fracture_energy: Option<f64>,
    /// Critical stretch of the interface bonds.
    #[deck(
        quantity = Number,
        range = POSITIVE,
        forbid_if(
            scope.failure == "bond-energy" && scope.is_solid(),
            "failure = \"bond-energy\" requires `fracture_energy`, which determines the critical bond energy"
        )
    )]
    critical_stretch: Option<f64>,
    /// As in `[material]`, whose value is the default.
    #[deck(flatten, key = "fracture_calibration", with = calibration)]
    calibration: FractureCalibration,
    /// As in `[material]`, whose value is the default.
    #[deck(
        default = Limit::Stretch,
        forbid_if(!scope.is_solid(), "it requires model = \"state-based\""),
        forbid_if(!scope.breaks, "bonds without `fracture_energy` never break")
    )]
    failure: Limit,
    /// As in `[material]`, whose value is the default.
    #[deck(
        default,
        forbid_if(!scope.is_state_based(), "it requires model = \"state-based\"; correspondence materials use the definition `closing`"),
        forbid_if(!scope.breaks, "bonds without `fracture_energy` never break"),
        forbid_if(
            failure == Some(&Limit::BondEnergy),
            "it requires failure = \"stretch\"; the critical bond energy does not depend on it"
        )
    )]
    stretch_definition: StretchDefinition,
}

/// Limit of bonds between state-based or correspondence materials.
#[derive(Debug, Clone, Copy, PartialEq, DeckWords)]
#[deck(what = "failure criterion")]
enum Limit {
    Stretch,
    BondEnergy,
}

const OWN_CONSTANTS: &str =
    "each end point of a bond contributes the constants of its own material";

/// Scope of the bonds between two materials.
#[derive(Clone, Copy)]
struct InterfaceScope<'s> {
    /// Names of the materials.
    names: &'s [String],
    /// The first material.
    material: &'s Material,
    body: &'s BodyRead,
    /// The word of `failure`, which may be invalid; empty if it is missing.
    failure: &'s str,
    /// Whether the strength of the bonds is given.
    breaks: bool,
}

impl InterfaceScope<'_> {
    fn is_solid(&self) -> bool {
        self.material.bonds().is_none()
    }

    fn is_state_based(&self) -> bool {
        self.material.state_based().is_some()
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
        .map(|table| {
            let made = interface(&table, (names, &mut given), material?, body);
            table.finish();
            made
        })
        .collect();
    read.into_iter().collect()
}

fn interface(
    table: &Table<'_>,
    (names, known): (&[String], &mut Vec<Option<[String; 2]>>),
    material: &Material,
    body: &BodyRead,
) -> Option<MaterialInterface> {
    let scope = InterfaceScope {
        names,
        material,
        body,
        failure: table.word_of("failure").unwrap_or_default(),
        breaks: STRENGTHS.iter().any(|key| table.has(key)),
    };
    table.about(<GivenInterface as DeckTable<_>>::ABOUT);
    let given = GivenInterface::read_keys(table, scope)?;
    let same = |known: &Option<[String; 2]>| match (known, &given.between) {
        (None, None) => true,
        (Some([a, b]), Some([c, d])) => (a, b) == (c, d) || (a, b) == (d, c),
        _ => false,
    };
    match (known.iter().any(same), table.optional("between")) {
        (true, Some(item)) => item.out_of_range("each pair of materials once, in either order"),
        (true, None) => table.requires_one_of(&["between"]),
        (false, _) => {}
    }
    known.push(given.between.clone());
    let strength = given.strength();
    let (stiffness, failure) = match &material.model {
        MaterialModel::Bonds(bonds) => {
            let sums = Sums::of(Some(&bonds.influence), Some(material.form), body);
            let stiffness = given.stiffness(table, &ConstantRules { sums }, body)?;
            (stiffness, InterfaceFailure::Bonds(strength))
        }
        _ => {
            let definition = Some(given.stretch_definition);
            let definition = definition.filter(|_| given.failure == Limit::Stretch);
            let failure = failure_of(strength, definition);
            (None, InterfaceFailure::StateBased(failure))
        }
    };
    Some(MaterialInterface {
        between: given.between,
        stiffness,
        failure: Some(failure).filter(|_| scope.breaks),
    })
}

impl GivenInterface {
    /// Returns the strength of the bonds.
    fn strength(&self) -> Fracture {
        let calibration = self.calibration;
        match (self.fracture_energy, self.critical_stretch) {
            (Some(energy), _) => Fracture::Energy {
                energy,
                calibration,
            },
            (None, Some(stretch)) => Fracture::CriticalStretch(stretch),
            (None, None) => Fracture::Unbreakable,
        }
    }

    /// Returns the source of the bond constant; the outer option is none after reporting an error.
    fn stiffness(
        &self,
        table: &Table<'_>,
        rules: &ConstantRules,
        body: &BodyRead,
    ) -> Option<Option<InterfaceStiffness>> {
        let moduli = [
            (
                "youngs_modulus",
                self.youngs_modulus.map(ElasticModulus::Young),
            ),
            ("bulk_modulus", self.bulk_modulus.map(ElasticModulus::Bulk)),
            (
                "shear_modulus",
                self.shear_modulus.map(ElasticModulus::Shear),
            ),
        ];
        let given = moduli
            .into_iter()
            .find_map(|(key, value)| Some((key, value?)));
        let Some((key, value)) = given else {
            return Some(self.rule.map(InterfaceStiffness::Rule));
        };
        table.optional(key)?.accept(value.young(body.state?))?;
        let modulus = Modulus {
            value,
            calibration: self.modulus,
        };
        let modulus = rules.modulus(table, modulus)?;
        Some(Some(InterfaceStiffness::Modulus(modulus)))
    }
}

impl MaterialInterface {
    /// Checks an interface of a model; `names` are those of the materials of the body, of this stress state.
    pub(crate) fn check(
        &self,
        path: &KeyPath,
        names: &[&str],
        state: StressState,
        check: &mut Check,
    ) {
        if let Some(pair) = &self.between {
            let known = pair.iter().all(|name| names.contains(&name.as_str()));
            let allowed = "allowed: the names of two different materials of the body";
            let right = known && pair[0] != pair[1];
            check.within(right, path.key("between"), pair.join(", "), allowed);
        }
        if let Some(InterfaceStiffness::Modulus(modulus)) = &self.stiffness {
            modulus.check_keys(path, Some(state), check);
        }
        let strength = match &self.failure {
            Some(InterfaceFailure::Bonds(strength)) => *strength,
            Some(InterfaceFailure::StateBased(failure)) => strength_of(failure),
            None => Fracture::Unbreakable,
        };
        strength.check_keys(path, None, check);
    }
}

fn calibration(table: &Table<'_>, scope: InterfaceScope<'_>) -> Option<FractureCalibration> {
    fracture_calibration(table, scope.body, false)
}

/// Reads two different material names.
fn pair(item: &Item<'_>, scope: InterfaceScope<'_>) -> Option<[String; 2]> {
    let names = scope.names;
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
