//! Bond-based materials.

use pericles::material::{BondMaterial, CubicLaw, PairLaw, Treatment};

use super::keys::{
    damage, density, forbid_former_tables, form, horizon, no_fail, setting, volume_correction,
};
use super::scatter::scatter;
use super::types::{Material, MaterialModel};
use crate::body::BodyRead;
use crate::constants::{
    ConstantRules, Sums, fracture, fracture_calibration, modulus, poisson_ratio,
};
use crate::correspondence;
use crate::influence::{InfluenceRead, influence};
use crate::reader::Table;
use crate::set::SetNames;

pub(super) fn read(
    table: Table<'_>,
    law: Option<PairLaw>,
    body: &BodyRead,
    sets: &SetNames,
    shared: bool,
) -> Option<Material> {
    forbid_former_tables(&table);
    correspondence::forbid_keys(&table);
    for key in ["yield_stress", "hardening"] {
        table.forbid(
            key,
            "it belongs to model = \"state-based\" or \"correspondence\"",
        );
    }
    for key in ["strains", "failure", "stretch_definition", "viscosity"] {
        table.forbid(key, "it belongs to model = \"state-based\"");
    }
    let dimension = body.frame.dimension;
    let name = table.maybe("name", |item| item.text());
    let law = treated(&table, law);
    let density = density(&table);
    let modulus = modulus(&table, body.state);
    let extent = horizon(&table, body.frame);
    let volume_correction = volume_correction(&table);
    let surface_correction = table.worded("surface_correction", "surface correction");
    poisson_ratio(&table, body.state);
    let influence = influence(&table, &setting(body, extent.as_ref(), volume_correction));
    let (influence, tuned) = match influence {
        Some(InfluenceRead { influence, tuned }) => (Some(influence), tuned),
        None => (None, None),
    };
    let horizon = extent.and_then(|extent| extent.with(influence.as_ref(), dimension));
    let fracture = fracture(&table);
    let fracture_calibration = fracture_calibration(&table, body, shared);
    let no_fail = no_fail(&table, sets);
    let scatter = scatter(&table);
    let damage = damage(&table);
    let form = form(&table);
    let rules = ConstantRules {
        state: body.state,
        sums: Sums::of(influence.as_ref(), form, body),
        fracture: fracture_calibration,
    };
    rules.judge_volume_correction(&table);
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
        no_fail: no_fail?,
        scatter: scatter?,
        surface_correction: surface_correction?,
        damage: damage?,
        form: form?,
    })
}

/// The law as it is taken.
fn treated(table: &Table<'_>, law: Option<PairLaw>) -> Option<PairLaw> {
    #[derive(Clone, Copy)]
    enum Kind {
        Exact,
        FirstOrder,
        As(Treatment),
    }
    let cubic = match law? {
        PairLaw::GreenStrain => CubicLaw::GreenStrain,
        PairLaw::Literal57 => CubicLaw::Literal57,
        other => {
            table.forbid(
                "treatment",
                "it belongs to model = \"green-strain\" or \"literal57\"",
            );
            return Some(other);
        }
    };
    let treatment = table.choice_or_first(
        "treatment",
        "treatment",
        &[
            ("exact", Kind::Exact),
            ("taylor-1", Kind::FirstOrder),
            ("taylor-2", Kind::As(Treatment::SecondOrder)),
            // The law itself.
            ("taylor-3", Kind::Exact),
            ("trapezoidal", Kind::As(Treatment::Trapezoidal)),
        ],
    );
    Some(match treatment? {
        Kind::Exact => law?,
        Kind::FirstOrder => PairLaw::Linear,
        Kind::As(treatment) => PairLaw::Treated(cubic, treatment),
    })
}
