//! Reads bond-based materials.

use pericles::material::{Approximation, BondMaterial, CubicLaw, PairLaw};

use super::keys::{damage, density, form, horizon, no_fail, setting, volume_correction};
use super::scatter::Scatter;
use super::softening::{
    failure, forbid_failure, forbid_softening, forbid_tensile_strength, softening, tensile_strength,
};
use super::types::{Material, MaterialModel};
use crate::body::BodyRead;
use crate::constants::{
    ConstantRules, Sums, fracture, fracture_calibration, modulus, poisson_ratio,
};
use crate::correspondence;
use crate::declaration::DeckValue;
use crate::influence::influence;
use crate::property::MaterialFunctions;
use crate::reader::Table;
use crate::set::SetNames;
use crate::vocabulary::BY_STATE;

pub(super) fn read(
    table: Table<'_>,
    law: Option<PairLaw>,
    body: &BodyRead,
    sets: &SetNames,
    shared: bool,
) -> Option<Material> {
    correspondence::forbid_keys(&table);
    for (_, key) in BY_STATE {
        table.forbid(
            key,
            "it requires model = \"state-based\" or \"correspondence\", whose points have a stress",
        );
    }
    for key in ["yield_stress", "hardening"] {
        table.forbid(
            key,
            "it requires model = \"state-based\" or \"correspondence\"",
        );
    }
    for key in ["strains", "stretch_definition", "viscosity"] {
        table.forbid(key, "it requires model = \"state-based\"");
    }
    let dimension = body.frame.dimension;
    let name = table.maybe("name", |item| item.text());
    let law = approximated(&table, law);
    let density = density(&table);
    let modulus = modulus(&table, body.state);
    let extent = horizon(&table, body.frame);
    let volume_correction = volume_correction(&table);
    let surface_correction = table.worded("surface_correction", "surface correction");
    poisson_ratio(&table, body.state);
    let setting = setting(body, extent.as_ref(), volume_correction);
    let (influence, tuned) = influence(&table, &setting).unwrap_or_default();
    let horizon = extent.and_then(|extent| extent.with(influence.as_ref(), dimension));
    let fracture = fracture(&table);
    let fracture_calibration = fracture_calibration(&table, body, shared);
    let no_fail = no_fail(&table, sets);
    let scatter = table.maybe("scatter", |item| Scatter::read(&item, ()));
    let (surface, softening, tensile_strength) = match law {
        None | Some(PairLaw::Linear | PairLaw::BondStretch) => {
            let surface = failure(&table, dimension);
            let chosen = surface.as_ref().and_then(Option::as_ref);
            let softening = softening(&table, chosen);
            let strength = match surface {
                // Without the criterion it is unknown whether the key belongs to the material.
                None => table.maybe("tensile_strength", |_| None),
                Some(_) => tensile_strength(&table, softening, chosen, fracture_calibration),
            };
            (surface, softening, strength)
        }
        Some(_) => {
            forbid_failure(&table);
            forbid_softening(&table);
            forbid_tensile_strength(&table);
            (Some(None), Some(None), Some(None))
        }
    };
    let damage = damage(&table);
    let form = form(&table);
    let functions = MaterialFunctions::read(&table, body.frame.dimension);
    let rules = ConstantRules {
        state: body.state,
        sums: Sums::of(influence.as_ref(), form, body),
        fracture: fracture_calibration,
    };
    rules.check_volume_correction(&table);
    let modulus = rules.modulus(&table, modulus);
    let fracture = rules.fracture(fracture);
    table.finish();
    Some(Material {
        name: name?,
        is_default: true,
        model: MaterialModel::Bonds(BondMaterial {
            law: law?,
            density: density?,
            modulus: modulus?,
            horizon: horizon?,
            influence: influence?,
            volume_correction: volume_correction?,
            fracture: fracture?,
        }),
        tuned,
        functions: functions?,
        no_fail: no_fail?,
        scatter: scatter?,
        softening: softening?,
        tensile_strength: tensile_strength?,
        strength_surface: surface?,
        surface_correction: surface_correction?,
        damage: damage?,
        form: form?,
    })
}

/// Applies `approximation` to the law.
fn approximated(table: &Table<'_>, law: Option<PairLaw>) -> Option<PairLaw> {
    #[derive(Clone, Copy)]
    enum Kind {
        Exact,
        FirstOrder,
        As(Approximation),
    }
    let cubic = match law? {
        PairLaw::GreenStrain => CubicLaw::GreenStrain,
        PairLaw::CubicSoftening => CubicLaw::CubicSoftening,
        other => {
            table.forbid(
                "approximation",
                "it requires model = \"green-strain\" or \"cubic-softening\"",
            );
            return Some(other);
        }
    };
    let approximation = table.choice_or_first(
        "approximation",
        "approximation",
        &[
            ("exact", Kind::Exact),
            ("taylor-1", Kind::FirstOrder),
            ("taylor-2", Kind::As(Approximation::SecondOrder)),
            // The same as the law itself, a cubic polynomial.
            ("taylor-3", Kind::Exact),
            ("trapezoidal", Kind::As(Approximation::Trapezoidal)),
        ],
    );
    Some(match approximation? {
        Kind::Exact => law?,
        Kind::FirstOrder => PairLaw::Linear,
        Kind::As(approximation) => PairLaw::Approximated(cubic, approximation),
    })
}
