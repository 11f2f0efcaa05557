//! Points and sets of a model.

use std::collections::BTreeSet;
use std::sync::Arc;

use pericles::space::{GradedCloud, PointCloud, PointSet};
use pericles_deck::{
    ALL, Body, BuildError, Fault, KeyPath, Members, Model, Remark, piece_path, shortened,
};

use super::assembler::{Assembler, Warnings};
use super::discretisation::{Discretisation, Grids, Sets};
use super::mesh_body::Meshes;
use super::program::Conditions;
use super::rejection::at_path;
use super::resources::Resources;

/// Creates the points of a model and selects its sets; of a body divided among several processes, the part of the calling
/// process. All processes must call it together.
///
/// ```
/// use pericles_deck::Deck;
/// use pericles_run::{Resources, assemble, discretise};
///
/// let text = r#"
///     [body]
///     shape = "bar"
///     length = "1 m"
///     spacing = "1 cm"
///     [material]
///     density = "7850 kg/m3"
///     youngs_modulus = "210 GPa"
///     horizon_ratio = 3
///     [sets.left]
///     layer = { side = "-x", cells = 1 }
///     [[initial]]
///     set = "left"
///     velocity = "1 m/s"
///     [time]
///     end = "1 ms"
/// "#;
/// let deck = Deck::parse(text, "bar.toml", &[]).unwrap();
/// let resources = Resources::default();
/// let mut points = discretise(&deck.model, &resources).unwrap();
/// assert_eq!(points.cloud.len(), 100);
/// // The program modifies the set.
/// points.set_mut("left").unwrap().extend([1, 2, 3]);
/// let assembly = assemble(&deck.model, points, &resources).unwrap();
/// assert_eq!(assembly.state.v.iter().sum::<f64>(), 4.0);
/// let simulation = assembly.simulation().unwrap();
/// ```
///
/// # Errors
/// A value is out of range, points are invalid or exceed the memory limit, a file cannot be read, or a set is empty.
pub fn discretise(model: &Model, resources: &Resources<'_>) -> Result<Discretisation, BuildError> {
    model.check()?;
    let warnings = Warnings::default();
    let assembler = Assembler::new(model, &warnings);
    let mut meshes = Meshes::default();
    let (points, surface) = match &model.body {
        Body::Surface(body) => {
            if let (Some(_), Some((keys, reason))) = (resources.several(), assembler.undivided()) {
                return Err(at_path(keys, Fault::Undivided { reason }));
            }
            let (surface, cloud) = assembler.surface_points(body, resources)?;
            (GradedCloud::of_one_grid(cloud), Some(Arc::new(surface)))
        }
        Body::Solid(solid) => {
            let points = assembler.own_points(resources, || assembler.points(solid, resources))?;
            meshes = points.meshes;
            (points.cloud, None)
        }
    };
    let sets = assembler.select(&points.cloud, &meshes)?;
    Ok(Discretisation {
        cracks: assembler.read_cracks(&points.cloud, &sets, resources)?,
        sets,
        cloud: Arc::new(points.cloud),
        grids: Grids {
            ratios: points.ratios,
            of_point: points.grid_of_point,
        },
        surface,
        meshes: Arc::new(meshes),
        conditions: Conditions::default(),
        warnings: warnings.taken(),
    })
}

/// Returns the advice on a set that contains no points.
fn advice_on_empty(members: &Members, cloud: &PointCloud) -> String {
    /// Largest number of listed blocks.
    const LISTED: usize = 8;
    let Members::Blocks(_) = members else {
        return "make the region larger: it must contain at least one cell centre (a layer must be at least half a spacing deep)".into();
    };
    let own = (0..cloud.len()).map(|i| f64::from(cloud.block(i)));
    let known: BTreeSet<u32> = cloud
        .domain()
        .collect_everywhere(own.collect())
        .concat()
        .into_iter()
        .map(|block| block as u32)
        .collect();
    let listed: Vec<String> = known.iter().take(LISTED).map(u32::to_string).collect();
    let more = if known.len() > LISTED { ", ..." } else { "" };
    format!("the blocks of the body are {}{more}", listed.join(", "))
}

impl Assembler<'_> {
    fn select(&self, cloud: &PointCloud, meshes: &Meshes) -> Result<Sets, BuildError> {
        let mut sets = vec![(ALL.to_owned(), (0..cloud.len() as u32).collect())];
        sets.extend(meshes.sets(cloud));
        let mut problems = Vec::new();
        for (k, (name, points)) in self.pieces_as_sets(cloud).into_iter().enumerate() {
            if sets.iter().any(|(known, _)| *known == name) {
                let fault = Fault::BadName {
                    name: name.clone(),
                    reason: "a mesh of the body has a set of this name",
                    allowed: "allowed: another name; pieces and sets of meshes are available as sets under their names",
                };
                problems.push(Remark::new(piece_path(k).key("name"), fault));
            }
            sets.push((name, points));
        }
        for set in &self.model.sets {
            let path = KeyPath::from("sets").key(&set.name);
            if sets.iter().any(|(name, _)| *name == set.name) {
                let fault = Fault::BadName {
                    name: set.name.clone(),
                    reason: "the mesh or a piece has a set of this name",
                    allowed: "allowed: another name; sets of the mesh and pieces are available under their own names",
                };
                problems.push(Remark::new(path, fault));
                continue;
            }
            match self.points_of(&set.members, cloud, meshes, &path) {
                Err(error) => problems.extend(error.into_problems()),
                Ok(points) => {
                    if cloud.domain().count(points.len() as u64) == 0 {
                        let fault = Fault::other(
                            "no points",
                            format!("the set `{}` selects no point", shortened(&set.name)),
                            advice_on_empty(&set.members, cloud),
                        );
                        problems.push(Remark::new(path, fault));
                    }
                    sets.push((set.name.clone(), points));
                }
            }
        }
        if problems.is_empty() {
            Ok(sets)
        } else {
            Err(BuildError::of(problems))
        }
    }

    /// Returns the points of each piece under its name.
    fn pieces_as_sets(&self, cloud: &PointCloud) -> Sets {
        let shape = self.model.body.solid().map(|solid| &solid.shape);
        let pieces = shape.map_or(&[][..], |shape| shape.pieces()).iter();
        let of = |k: u32| (0..cloud.len() as u32).filter(move |&i| cloud.piece(i as usize) == k);
        (0..)
            .zip(pieces)
            .map(|(k, piece)| (piece.name.clone(), of(k).collect()))
            .collect()
    }

    fn points_of(
        &self,
        members: &Members,
        cloud: &PointCloud,
        meshes: &Meshes,
        path: &KeyPath,
    ) -> Result<PointSet, BuildError> {
        let points = cloud.domain().whole_points();
        if let Some(number) = members.largest_number().filter(|&k| k as usize >= points) {
            let value = number.to_string();
            let allowed = format!(
                "allowed: point numbers from 0 to {}",
                points.saturating_sub(1)
            );
            return Err(at_path(
                path.key("points"),
                Fault::OutOfRange { value, allowed },
            ));
        }
        let (faces, depth) = match members {
            Members::NearFaces(near) => (&near.faces, near.depth),
            members => return Ok(members.of(cloud).unwrap_or_default()),
        };
        let near = meshes.near_faces(cloud, faces, depth);
        near.ok_or_else(|| {
            let known: Vec<String> = meshes.face_sets().collect();
            let known = known.iter().map(String::as_str);
            let fault = Fault::unknown_word("face set", faces, known);
            at_path(path.key("near_faces").key("faces"), fault)
        })
    }
}
