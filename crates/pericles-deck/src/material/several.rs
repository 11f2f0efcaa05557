//! Materials of a body: `[material]`, `[materials.NAME]`, or both.

use super::scope::MaterialScope;
use super::shared::{difference_of_tables, same_length};
use super::table::material;
use super::types::{Material, MaterialModel, NamedMaterial};
use crate::body::BodyRead;
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::reader::{Item, Table};
use crate::set::SetNames;
use crate::vocabulary::{HORIZONS, OWN_CONSTANTS};

/// The materials of a deck.
pub(crate) struct Materials {
    /// Names, the body's material first, including materials that could not be read.
    pub(crate) names: Vec<String>,
    /// The body's material: `[material]` if it has constants of its own, otherwise `[materials.default]`,
    /// otherwise the first of `[materials]`.
    pub(crate) own: Option<Material>,
    /// Further materials.
    pub(crate) others: Option<Vec<NamedMaterial>>,
    /// Path of the body's material, if it is in `[materials]`.
    pub(crate) place: Option<KeyPath>,
}

/// Reads all materials. Tables of `[materials]` already contain inherited keys (see
/// [`inherit`](crate::inheritance::inherit)).
pub(crate) fn read(root: &Table<'_>, body: &BodyRead, sets: &SetNames) -> Materials {
    let table = root.optional("materials").and_then(|item| item.table());
    let named = table.iter().flat_map(|table| table.named("material"));
    let mut named: Vec<(&str, Item<'_>)> = named.map(|(name, _, item)| (name, item)).collect();
    if named.is_empty() {
        let table = root.required("material").and_then(|item| item.table());
        let own = table.and_then(|table| {
            let scope = MaterialScope::of(&table, body, sets, [false, false]);
            material(table, scope)
        });
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
            let scope = MaterialScope::of(&table, body, sets, [true, false]);
            let own = material(table, scope);
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
    // All are read before an error ends the function.
    let others: Vec<Option<NamedMaterial>> = named
        .into_iter()
        .map(|(name, item)| {
            if names.iter().any(|known| known == name) {
                item.report(Fault::BadName {
                    name: name.into(),
                    reason: "[material] has this name",
                    allowed: "allowed: a unique name per material",
                });
            }
            names.push(name.into());
            let Material {
                model,
                functions,
                tensile_strength,
                strength_surface,
                ..
            } = other(&item, own.as_ref(), body, sets)?;
            Some(NamedMaterial {
                name: name.into(),
                model,
                functions,
                tensile_strength,
                strength_surface,
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

/// Reads a table of `[materials]`.
fn one(item: &Item<'_>, body: &BodyRead, sets: &SetNames, shared: bool) -> Option<Material> {
    let table = item.table()?;
    let scope = MaterialScope::of(&table, body, sets, [shared, true]);
    material(table, scope)
}

/// Reads a further table of `[materials]`, whose shared keys must agree with the body's material.
fn other(
    item: &Item<'_>,
    own: Option<&Material>,
    body: &BodyRead,
    sets: &SetNames,
) -> Option<Material> {
    let mut read = one(item, body, sets, false)?;
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
    let model = &mut read.model;
    if same_length(own.horizon(), model.horizon()) {
        // Makes both horizons bitwise equal.
        match model {
            MaterialModel::Bonds(bonds) => bonds.horizon = own.horizon(),
            MaterialModel::StateBased(state) => state.solid.horizon = own.horizon(),
            MaterialModel::Correspondence(state) => state.solid.horizon = own.horizon(),
        }
    }
    Some(read)
}
