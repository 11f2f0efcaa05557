//! Pre-cracks: their surfaces and the bonds that they cut.

use std::path::Path;

use pericles::family::{BondCut, Crack, EndRule};
use pericles::observe::TrackedCrack;
use pericles::space::PointCloud;
use pericles_deck::{BuildError, Fault, KeyPath};

use super::assembler::Assembler;
use super::discretisation::{Discretisation, Sets};
use super::part::gathered;
use super::rejection::at_path;
use super::resources::Resources;

impl Assembler<'_> {
    /// Returns the surfaces of the pre-cracks; triangulated ones are read from their files. All processes must call it
    /// together.
    pub(super) fn read_cracks(
        &self,
        cloud: &PointCloud,
        sets: &Sets,
        resources: &Resources<'_>,
    ) -> Result<Vec<(Crack, EndRule)>, BuildError> {
        let cracks = self.model.cracks.iter().enumerate();
        let read = cracks.map(|(k, crack)| {
            let path = KeyPath::from("crack").index(k);
            let of_layer = |layer: &str| -> Result<Crack, BuildError> {
                let members = self.members(sets, layer, path.key("layer"))?;
                let places = members.iter().flat_map(|&i| cloud.point(i as usize));
                let places = cloud.domain().collect_everywhere(places.collect()).concat();
                let point = |place: &[f64]| std::array::from_fn(|c| place[c]);
                Ok(Crack::Layer {
                    points: places.chunks_exact(3).map(point).collect(),
                    spacing: cloud.spacing(),
                    dimension: cloud.dimension(),
                })
            };
            let of_file = |file: &Path, unit: f64| {
                let key = path.key("file");
                let file = resources.beside(file);
                let mesh = (resources.read_mesh)(&file, resources.memory);
                let mesh = mesh.map_err(|error| {
                    let fault = error.fault(bad_file);
                    at_path(key.clone(), fault)
                })?;
                mesh.check().map_err(|error| {
                    let reason = format!("{}: {error}", file.display());
                    at_path(key, bad_file(reason))
                })?;
                let corner = |node: u32| mesh.nodes[node as usize].map(|x| x * unit);
                let triangles = mesh.triangles().into_iter();
                Ok(Crack::Triangles {
                    triangles: triangles.map(|corners| corners.map(corner)).collect(),
                })
            };
            let surface = crack.surface.crack(of_file, of_layer)?;
            // The error of the engine does not contain the number of the crack.
            surface
                .cutter(crack.ends, 0.0)
                .map_err(|error| at_path(path, error.into()))?;
            Ok((surface, crack.ends))
        });
        read.collect()
    }

    /// Returns the pre-cracks with the points at which they cut bonds; warns of those that cut none.
    pub(super) fn tracked_cracks(
        &self,
        cuts: &[BondCut],
        discretisation: &Discretisation,
    ) -> Vec<TrackedCrack> {
        let mut tracked = Vec::new();
        for (k, ((surface, _), cut)) in self.cracks.iter().zip(cuts).enumerate() {
            if let Crack::Layer { .. } = surface {
                // A layer has no tip.
                continue;
            }
            if cut.bonds == 0 {
                let caution = Self::useless_crack(surface, &discretisation.cloud);
                self.warn(KeyPath::from("crack").index(k), caution);
            }
            tracked.push(TrackedCrack {
                crack: surface.clone(),
                points: gathered(&discretisation.cloud, cut.points.clone()),
            });
        }
        tracked
    }
}

/// Creates the error for an invalid file of a pre-crack.
fn bad_file(reason: String) -> Fault {
    Fault::other(
        "invalid",
        reason,
        "expected: a file of triangles (STL, OBJ, PLY, OFF, Gmsh, VTU or VTP); a relative path starts at the deck's folder",
    )
}
