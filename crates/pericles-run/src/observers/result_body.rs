//! The body and the arrays of field files: blocks, sets, numbers of points.

use pericles::space::PointCloud;
use pericles_deck::{ALL, FieldBlocks, Model, Piece, PointNumber};
use pericles_io::ResultBody;
use pericles_io::observers::{FieldSelection, PointMark};

use crate::build::{Meshes, Sets};

/// Returns the body for result files, with the requested blocks.
pub fn result_body(model: &Model, cloud: &PointCloud, sets: &Sets, meshes: &Meshes) -> ResultBody {
    let named = sets.iter().filter(|(name, _)| name != ALL);
    let named = named.map(|(name, points)| (name.as_str(), points.as_slice()));
    let title = model.title.clone().unwrap_or_default();
    match (model.output.fields.blocks, model.body.solid()) {
        (FieldBlocks::Materials, Some(solid)) => {
            let own = solid.material.name();
            let (numbers, names) = material_blocks(model, own, cloud, sets);
            let name = |block: u32| names[block as usize - 1].to_owned();
            ResultBody::new(title, cloud, named, |i| numbers[i], name)
        }
        (_, solid) => {
            let pieces = solid.map_or(&[][..], |solid| solid.shape.pieces());
            group_blocks(title, cloud, named, pieces, meshes)
        }
    }
}

/// Returns the body with a block per group of a mesh or block of listed points; pieces have blocks of their own, named
/// as their sets are.
fn group_blocks<'a>(
    title: String,
    cloud: &PointCloud,
    sets: impl Iterator<Item = (&'a str, &'a [u32])>,
    pieces: &[Piece],
    meshes: &Meshes,
) -> ResultBody {
    let kind = |i: usize| (cloud.piece(i), cloud.block(i));
    let mut kinds: Vec<(u32, u32)> = (0..cloud.len()).map(kind).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let number = |i: usize| kinds.partition_point(|known| *known < kind(i)) as u32;
    let name = |number: u32| {
        let (piece, block) = kinds[number as usize];
        let numbered = || format!("block_{block}");
        let own = match piece {
            0 => "",
            piece => &pieces[piece as usize].name,
        };
        if let Some(group) = meshes.block_name(own, block) {
            return group;
        }
        let Some(piece_name) = pieces.get(piece as usize).map(|piece| &piece.name) else {
            return numbered();
        };
        match kinds.iter().filter(|(other, _)| *other == piece).count() {
            1 => piece_name.clone(),
            _ => format!("{piece_name}/{}", numbered()),
        }
    };
    ResultBody::new(title, cloud, sets, number, name)
}

/// Returns the material number of each point, from 1, and the names of the materials, the body's material first.
fn material_blocks<'m>(
    model: &'m Model,
    own: &'m str,
    cloud: &PointCloud,
    sets: &Sets,
) -> (Vec<u32>, Vec<&'m str>) {
    let others = model.materials.iter().map(|other| other.name.as_str());
    let names: Vec<&str> = std::iter::once(own).chain(others).collect();
    let mut numbers = vec![1; cloud.len()];
    for (_, assigned, material) in model.assigned_materials() {
        let Some(place) = names.iter().position(|name| *name == material) else {
            continue;
        };
        let is_assigned = |name: &String| assigned.contains(name);
        for (_, points) in sets.iter().filter(|(name, _)| is_assigned(name)) {
            for &i in points {
                numbers[i as usize] = place as u32 + 1;
            }
        }
    }
    (numbers, names)
}

/// The numbers of points that a model asks for.
fn point_marks(model: &Model, cloud: &PointCloud, sets: &Sets) -> Vec<PointMark> {
    let numbers = |number: &PointNumber| match number {
        PointNumber::Material => match model.body.solid() {
            Some(solid) => {
                let (numbers, _) = material_blocks(model, solid.material.name(), cloud, sets);
                numbers.into_iter().map(|number| number as i32).collect()
            }
            None => vec![1; cloud.len()],
        },
        PointNumber::Piece => {
            let number = |i| cloud.piece(i) as i32 + 1;
            (0..cloud.len()).map(number).collect()
        }
        PointNumber::Set(name) => {
            let mut numbers = vec![0; cloud.len()];
            for (_, points) in sets.iter().filter(|(known, _)| known == name) {
                for &i in points {
                    numbers[i as usize] = 1;
                }
            }
            numbers
        }
    };
    let wanted = model.output.fields.names.numbers.iter();
    wanted
        .map(|number| PointMark {
            name: number.name(),
            numbers: numbers(number),
        })
        .collect()
}

/// Returns the arrays of the field files that a model requests.
pub(crate) fn field_selection(model: &Model, cloud: &PointCloud, sets: &Sets) -> FieldSelection {
    FieldSelection {
        fields: model.output.fields.names.fields.clone(),
        marks: point_marks(model, cloud, sets),
    }
}
