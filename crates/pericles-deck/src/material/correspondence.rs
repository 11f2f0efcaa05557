//! Reads correspondence materials.

use pericles::material::{LinearSolid, StretchDefinition, SurfaceCorrection};
use pericles_solids::correspondence::ElasticLaw;

use super::keys::{SolidFamily, damage, density, form, no_fail};
use super::scatter::Scatter;
use super::softening::{forbid_softening, forbid_tensile_strength};
use super::types::Material;
use crate::body::BodyRead;
use crate::constants::fracture_calibration;
use crate::correspondence::{Correspondence, anisotropy, law, plasticity};
use crate::criterion;
use crate::declaration::DeckValue;
use crate::property::MaterialFunctions;
use crate::reader::Table;
use crate::set::SetNames;
use crate::state_based::SolidRules;

pub(super) fn read(
    table: Table<'_>,
    body: &BodyRead,
    sets: &SetNames,
    shared: bool,
) -> Option<Material> {
    for (key, reason) in FORBIDDEN {
        table.forbid(key, reason);
    }
    let name = table.maybe("name", |item| item.text());
    let density = density(&table);
    let family = SolidFamily::read(&table, body);
    let calibration = fracture_calibration(&table, body, shared);
    let criterion = criterion::read(&table, body.frame.dimension);
    let by_state = !matches!(criterion, Some(None));
    let closing = Some(StretchDefinition::Closing);
    let rules = SolidRules::read(&table, body.state, calibration, [shared, by_state], closing);
    let anisotropy = anisotropy(&table);
    let elastic = match &anisotropy {
        Some(None) => rules.elastic(&table),
        Some(Some(anisotropy)) => table.accept(anisotropy.average()),
        None => None,
    };
    let failure = rules.failure(&table);
    let plasticity = plasticity(&table);
    let law = match anisotropy {
        Some(None) => law(&table, table.has("yield_stress")),
        _ => Some(ElasticLaw::StVenantKirchhoff),
    };
    let stabilisation = table.worded("stabilisation", "stabilisation");
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
        surface_correction: SurfaceCorrection::None,
        damage: damage?,
        form: form?,
        ..Material::from(Correspondence {
            solid,
            law: law?,
            stabilisation: stabilisation?,
            plasticity: plasticity?,
            anisotropy: anisotropy?.map(Box::new),
            criterion: criterion?,
        })
    })
}

/// Keys of other models.
const FORBIDDEN: [(&str, &str); 5] = [
    ("viscosity", "it requires model = \"state-based\""),
    (
        "approximation",
        "it requires model = \"green-strain\" or \"cubic-softening\"",
    ),
    (
        "strains",
        "it requires model = \"state-based\"; correspondence materials always use finite strains",
    ),
    (
        "surface_correction",
        "the shape tensor of a correspondence material already accounts for missing bonds near free surfaces",
    ),
    (
        "stretch_definition",
        "it requires model = \"state-based\"; correspondence materials use the definition `closing`",
    ),
];
