//! Material and damage models.

use super::{Code, Source};
use crate::entry::{Entry, is_same};
use crate::error::Fault;
use crate::table;
use crate::units::Quantity;

/// Constitutive laws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Law {
    BondBased,
    StateBased,
    Correspondence,
}

/// A property of a material model that is not part of its force law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Elastic,
    Linear,
    Plastic,
}

/// Material models by name; models of PeriLab are combined with `+`.
const PERILAB: &[(&str, Law, Kind)] = &[
    ("Bond-based Elastic", Law::BondBased, Kind::Elastic),
    ("PD Solid Elastic", Law::StateBased, Kind::Elastic),
    ("PD Solid Plastic", Law::StateBased, Kind::Plastic),
    ("Correspondence Elastic", Law::Correspondence, Kind::Elastic),
    ("Correspondence Plastic", Law::Correspondence, Kind::Plastic),
];
const PERIDIGM: &[(&str, Law, Kind)] = &[
    ("Elastic Bond Based", Law::BondBased, Kind::Elastic),
    ("Elastic", Law::StateBased, Kind::Elastic),
    ("Linear Elastic", Law::StateBased, Kind::Elastic),
    ("Linear LPS", Law::StateBased, Kind::Linear),
    ("Elastic Plastic", Law::StateBased, Kind::Plastic),
    ("Elastic Plastic Hardening", Law::StateBased, Kind::Plastic),
    ("Elastic Correspondence", Law::Correspondence, Kind::Elastic),
    (
        "Elastic Plastic Correspondence",
        Law::Correspondence,
        Kind::Plastic,
    ),
];

/// Plane stress or plane strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Plane {
    Stress,
    Strain,
}

pub(super) type Keys = Vec<(&'static str, String)>;

/// A material model of a deck.
#[derive(Debug, Clone, Copy)]
pub(super) struct Model {
    law: Law,
    is_linear: bool,
    is_plastic: bool,
}

impl Model {
    pub(super) fn of(code: Code, material: &Entry) -> Result<Self, Fault> {
        let entry = material.need(&["Material Model"])?;
        let text = entry.text()?;
        let known = match code {
            Code::PeriLab => PERILAB,
            Code::Peridigm => PERIDIGM,
        };
        let mut model: Option<Self> = None;
        for word in text.split('+') {
            let found = known.iter().find(|(name, ..)| is_same(name, word));
            let &(_, law, kind) = found.ok_or_else(|| {
                let known: Vec<&str> = known.iter().map(|(name, ..)| *name).collect();
                entry.fault(format!(
                    "the material model `{}` has no counterpart in Pericles; translated are: {}",
                    word.trim(),
                    known.join(", ")
                ))
            })?;
            let before = model.unwrap_or(Self {
                law,
                is_linear: false,
                is_plastic: false,
            });
            model = Some(Self {
                law,
                is_linear: before.is_linear || kind == Kind::Linear,
                is_plastic: before.is_plastic || kind == Kind::Plastic,
            });
        }
        model.ok_or_else(|| entry.fault("the name of the material model is missing"))
    }

    /// Returns the keys that all materials of a body share.
    pub(super) fn shared(self, code: Code, material: &Entry) -> Result<Keys, Fault> {
        let name = match self.law {
            Law::BondBased => "bond-stretch",
            Law::StateBased => "state-based",
            Law::Correspondence => "correspondence",
        };
        let mut keys = vec![
            ("model", table::text(name)),
            // Both codes count a neighbour with its whole volume if its centre is within the horizon.
            ("volume_correction", table::text("none")),
            ("influence", "{ function = \"constant\" }".to_owned()),
        ];
        if self.is_linear {
            keys.push(("strains", table::text("small")));
        }
        if self.law == Law::Correspondence {
            let law = if self.is_plastic {
                "hencky"
            } else {
                "st-venant-kirchhoff"
            };
            keys.push(("law", table::text(law)));
            material.differ(format!(
                "the law of the deck is \"{law}\", which agrees for small strains"
            ));
            keys.push(("stabilisation", table::text(stabilisation(code, material)?)));
        }
        Ok(keys)
    }

    /// Returns elastic constants and yield stress.
    pub(super) fn constants(
        self,
        source: &Source<'_>,
        material: &Entry,
        plane: Option<Plane>,
    ) -> Result<Keys, Fault> {
        let constants: [(&str, &[&str]); 4] = [
            ("youngs_modulus", &["Young's Modulus", "Youngs Modulus"]),
            ("poisson_ratio", &["Poisson's Ratio", "Poissons Ratio"]),
            ("bulk_modulus", &["Bulk Modulus"]),
            ("shear_modulus", &["Shear Modulus"]),
        ];
        let mut given = Vec::new();
        for (key, names) in constants {
            if given.len() < 2
                && let Some(value) = material.number_of(names)?
            {
                given.push((key, value));
            }
        }
        if given.is_empty() {
            return Err(material.fault("there are no elastic constants"));
        }
        if self.law == Law::BondBased {
            given = vec![bond_based(source.code, material, plane, &given)];
        }
        let modulus = |value| source.units.number(value, Quantity::Stress);
        let mut keys: Keys = Vec::new();
        for (key, value) in given {
            let is_modulus = key != "poisson_ratio";
            keys.push((
                key,
                if is_modulus {
                    modulus(value)
                } else {
                    table::number(value)
                },
            ));
        }
        if self.is_plastic {
            keys.push((
                "yield_stress",
                modulus(material.need(&["Yield Stress"])?.positive()?),
            ));
            let hardening = material.number_of(&["Hardening Modulus"])?;
            keys.extend(hardening.map(|value| ("hardening", modulus(value))));
        }
        Ok(keys)
    }

    /// Returns the failure criterion of a damage model.
    pub(super) fn failure(self, source: &Source<'_>, damage: &Entry) -> Result<Keys, Fault> {
        let kind = damage.need(&["Damage Model"])?;
        let name = kind.text()?;
        let value = |keys: &[&str]| damage.need(keys).and_then(Entry::positive);
        Ok(if is_same(name, "Critical Stretch") {
            let stretch = value(&["Critical Stretch", "Critical Value"])?;
            vec![("critical_stretch", table::number(stretch))]
        } else if is_same(name, "Critical Energy") {
            let energy = value(&["Critical Value"])?;
            let energy = source.units.number(energy, Quantity::FractureEnergy);
            let energy = ("fracture_energy", energy);
            if self.law == Law::BondBased {
                kind.differ("bonds of bond-based materials break at the critical stretch of this fracture energy");
                vec![energy]
            } else {
                kind.differ("Pericles computes the critical bond energy from the fracture energy by an integral; the constant of PeriLab differs, in the plane it is 3 G/(π h δ³)");
                vec![energy, ("failure", table::text("bond-energy"))]
            }
        } else {
            damage.refuse("the damage model has no counterpart; bonds of its blocks do not break");
            Vec::new()
        })
    }
}

/// Returns the one elastic constant of a bond-based material.
fn bond_based(
    code: Code,
    material: &Entry,
    plane: Option<Plane>,
    given: &[(&'static str, f64)],
) -> (&'static str, f64) {
    if given.len() == 2 {
        material
            .differ("the Poisson's ratio of bond-based materials is fixed; one modulus is used");
    }
    let Some((youngs, poisson)) = isotropic(given) else {
        return match (given[0], code, plane) {
            (("bulk_modulus", bulk), Code::Peridigm, Some(plane)) => planar(bulk, plane),
            (one, ..) => one,
        };
    };
    let bulk = youngs / (3.0 * (1.0 - 2.0 * poisson));
    match (code, plane) {
        (Code::PeriLab, _) => ("youngs_modulus", youngs),
        (Code::Peridigm, None) => ("bulk_modulus", bulk),
        (Code::Peridigm, Some(plane)) => planar(bulk, plane),
    }
}

/// Young's modulus with the bond constant 12 K/(π h δ³) of Peridigm. The bond constant of Pericles is 9 E/(π h δ³) in plane
/// stress and 48 E/(5 π h δ³) in plane strain.
fn planar(bulk: f64, plane: Plane) -> (&'static str, f64) {
    let factor = match plane {
        Plane::Stress => 12.0 / 9.0,
        Plane::Strain => 12.0 * 5.0 / 48.0,
    };
    ("youngs_modulus", factor * bulk)
}

/// Returns Young's modulus and Poisson's ratio, from two elastic constants.
fn isotropic(given: &[(&str, f64)]) -> Option<(f64, f64)> {
    Some(match *given {
        [("youngs_modulus", e), ("poisson_ratio", nu)] => (e, nu),
        [("youngs_modulus", e), ("bulk_modulus", k)] => (e, (3.0 * k - e) / (6.0 * k)),
        [("youngs_modulus", e), ("shear_modulus", g)] => (e, e / (2.0 * g) - 1.0),
        [("poisson_ratio", nu), ("bulk_modulus", k)] => (3.0 * k * (1.0 - 2.0 * nu), nu),
        [("poisson_ratio", nu), ("shear_modulus", g)] => (2.0 * g * (1.0 + nu), nu),
        [("bulk_modulus", k), ("shear_modulus", g)] => (
            9.0 * k * g / (3.0 * k + g),
            (3.0 * k - 2.0 * g) / (6.0 * k + 2.0 * g),
        ),
        _ => return None,
    })
}

/// Returns the control of zero-energy modes.
fn stabilisation(code: Code, material: &Entry) -> Result<&'static str, Fault> {
    match code {
        Code::PeriLab => match material.find("Zero Energy Control") {
            None => Ok("none"),
            Some(control) => match control.text()?.to_lowercase().as_str() {
                "global" => Ok("wan"),
                "silling" => Ok("silling"),
                _ => {
                    control
                        .refuse("allowed: Global or Silling; the deck has the default of Pericles");
                    Ok("isotropic")
                }
            },
        },
        Code::Peridigm => match material.find("Hourglass Coefficient") {
            None => Ok("none"),
            Some(coefficient) if coefficient.number()? == 0.0 => Ok("none"),
            Some(coefficient) => {
                coefficient.differ("stabilisation = \"silling\" has no coefficient");
                Ok("silling")
            }
        },
    }
}
