//! The materials of a body: `[material]`, `[materials.NAME]`, or both.

use super::material;
use super::shared::difference_of_tables;
use super::types::{Material, MaterialModel, NamedMaterial};
use crate::body::BodyRead;
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::reader::{Item, Table};
use crate::set::SetNames;
use crate::vocabulary::{HORIZONS, OWN_CONSTANTS};

/// The materials of a deck.
pub(crate) struct Materials {
    /// Their names, that of the body's material first, whether or not they could be read.
    pub(crate) names: Vec<String>,
    /// The body's material: [material] if it has constants of its own, else [materials.default], else the first of [materials].
    pub(crate) own: Option<Material>,
    /// The others.
    pub(crate) others: Option<Vec<NamedMaterial>>,
    /// Where the body's material is, if it is one of [materials].
    pub(crate) place: Option<KeyPath>,
}

/// All materials. Tables of [materials] hold what they take over from [material] (see [`inherit`](crate::inheritance::inherit)).
pub(crate) fn read(root: &Table<'_>, body: &BodyRead, sets: &SetNames) -> Materials {
    let table = root.optional("materials").and_then(|item| item.table());
    let named = table.iter().flat_map(|table| table.named("material"));
    let mut named: Vec<(&str, Item<'_>)> = named.map(|(name, _, item)| (name, item)).collect();
    if named.is_empty() {
        let table = root.required("material").and_then(|item| item.table());
        let own = table.and_then(|table| material(table, body, sets, false));
        return Materials {
            names: own.iter().map(|own| own.name().to_owned()).collect(),
            own,
            others: Some(Vec::new()),
            place: None,
        };
    }
    let given = root.optional("material").and_then(|item| item.table());
    let given = given.filter(|table| {
        let is_material = OWN_CONSTANTS.iter().any(|key| table.has(key));
        if !is_material {
            table.taken_over();
        }
        is_material
    });
    let (own, name, place) = match given {
        Some(table) => {
            let own = material(table, body, sets, true);
            let name = own.as_ref().map_or(Material::DEFAULT, Material::name);
            let name = name.to_owned();
            (own, name, None)
        }
        None => {
            let by_name = named
                .iter()
                .position(|(name, _)| *name == Material::DEFAULT);
            let (name, item) = named.remove(by_name.unwrap_or(0));
            let own = one(&item, body, sets, true).map(|own| Material {
                name: Some(name.into()),
                is_default: by_name.is_some(),
                ..own
            });
            let place = KeyPath::from("materials").key(name);
            (own, name.to_owned(), Some(place))
        }
    };
    let mut names = vec![name];
    // All are read before one that is wrong ends it.
    let others: Vec<Option<NamedMaterial>> = named
        .into_iter()
        .map(|(name, item)| {
            if names.iter().any(|known| known == name) {
                item.report(Fault::BadName {
                    name: name.into(),
                    reason: "[material] has it",
                    allowed: "allowed: a name of its own for each material",
                });
            }
            names.push(name.into());
            let model = other(&item, own.as_ref(), body, sets)?;
            Some(NamedMaterial {
                name: name.into(),
                model,
            })
        })
        .collect();
    Materials {
        others: others.into_iter().collect(),
        names,
        own,
        place,
    }
}

/// A table of [materials].
fn one(item: &Item<'_>, body: &BodyRead, sets: &SetNames, shared: bool) -> Option<Material> {
    let table = item.table()?;
    table.forbid("name", "the name of the table is that of the material");
    material(table, body, sets, shared)
}

/// A table of [materials] beside the body's material, with which it must agree in what all bonds share.
fn other(
    item: &Item<'_>,
    own: Option<&Material>,
    body: &BodyRead,
    sets: &SetNames,
) -> Option<MaterialModel> {
    let read = one(item, body, sets, false)?;
    let own = own?;
    if let Some(key) = difference_of_tables(own, &read) {
        let table = item.table()?;
        let keys = match key {
            "horizon" => HORIZONS,
            _ => &[key],
        };
        let fault = Fault::NotShared {
            key,
            table: table.name(),
        };
        let given = keys.iter().find_map(|key| table.place_of(key));
        match given {
            Some(place) => table.report_at(place, fault),
            None => table.report(fault),
        }
        return None;
    }
    let mut model = read.model;
    // To the last bit.
    match &mut model {
        MaterialModel::Bonds(bonds) => bonds.horizon = own.horizon(),
        MaterialModel::StateBased(state) => state.solid.horizon = own.horizon(),
        MaterialModel::Correspondence(state) => state.solid.horizon = own.horizon(),
    }
    Some(model)
}
