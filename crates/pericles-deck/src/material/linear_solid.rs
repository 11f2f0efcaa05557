//! Reads state-based materials.

use pericles::material::{LinearSolid, SurfaceCorrection};

use super::inelastic;
use super::keys::{SolidFamily, damage, density, form, no_fail};
use super::scatter::Scatter;
use super::softening::{forbid_softening, forbid_tensile_strength};
use super::types::Material;
use crate::body::BodyRead;
use crate::constants::fracture_calibration;
use crate::correspondence;
use crate::criterion;
use crate::declaration::DeckValue;
use crate::property::MaterialFunctions;
use crate::reader::Table;
use crate::set::SetNames;
use crate::state_based::{SolidRules, StateBased};

pub(super) fn read(
    table: Table<'_>,
    body: &BodyRead,
    sets: &SetNames,
    shared: bool,
) -> Option<Material> {
    correspondence::forbid_keys(&table);
    table.forbid(
        "approximation",
        "it requires model = \"green-strain\" or \"cubic-softening\"",
    );
    let name = table.maybe("name", |item| item.text());
    let strains = table.worded("strains", "strains");
    let density = density(&table);
    let family = SolidFamily::read(&table, body);
    let surface_correction = solid_surface(&table);
    let criterion = criterion::read(&table, body.frame.dimension);
    let by_state = !matches!(criterion, Some(None));
    let rules = SolidRules::read(
        &table,
        body.state,
        fracture_calibration(&table, body, shared),
        [shared, by_state],
        None,
    );
    let (elastic, failure) = (rules.elastic(&table), rules.failure(&table));
    let inelastic = inelastic::read(&table, body.state);
    let no_fail = no_fail(&table, sets);
    let scatter = table.maybe("scatter", |item| Scatter::read(&item, ()));
    forbid_softening(&table);
    forbid_tensile_strength(&table);
    table.forbid(
        "strength_surface",
        "it requires failure = \"strength\" of a bond-based material; failure = \"expression\" has the key `criterion`",
    );
    let damage = damage(&table);
    let form = form(&table);
    let functions = MaterialFunctions::read(&table, body.frame.dimension);
    table.finish();
    let solid = LinearSolid {
        density: density?,
        elastic: elastic?,
        horizon: family.horizon?,
        influence: family.influence?,
        volume_correction: family.volume_correction?,
        failure: failure?,
    };
    Some(Material {
        name: name?,
        functions: functions?,
        no_fail: no_fail?,
        scatter: scatter?,
        surface_correction: surface_correction?,
        damage: damage?,
        form: form?,
        ..Material::from(StateBased {
            solid,
            strains: strains?,
            inelastic: inelastic?,
            criterion: criterion?,
        })
    })
}

/// Reads the surface correction of a state-based material.
fn solid_surface(table: &Table<'_>) -> Option<SurfaceCorrection> {
    if let Some(item) = table.optional("surface_correction")
        && item.is_keyword("volume")
    {
        item.out_of_range(
            "\"none\", \"energy\" or \"ghosts\"; the weighted volume of a state-based material already accounts for missing bonds, and the volume method makes bodies 6 to 15 % too stiff",
        );
        return None;
    }
    table.choice_or_first(
        "surface_correction",
        "surface correction",
        &[
            ("none", SurfaceCorrection::None),
            ("energy", SurfaceCorrection::Energy),
            ("ghosts", SurfaceCorrection::Ghosts),
        ],
    )
}
