//! Points of a mesh.
//!
//! Data from files are not part of the model: the spacing of a mesh is known when the file is read. Keys that count
//! in spacings are therefore rejected for meshes, and names of mesh sets are checked after reading, with their
//! location in the deck.

use std::path::Path;

use pericles::space::{ListedPoints, PointCloud};
use pericles::units::quantity;
use pericles_deck::{BuildError, Caution, Fault, KeyPath, MeshFile, Solid};
use pericles_mesh::{MeshPoints, PointOptions, Problem, RawMesh};

use super::assembler::Assembler;
use super::mesh_body::{MeshBody, Placement};
use super::rejection::{at, at_path};
use super::resources::Resources;

impl Assembler<'_> {
    /// Creates the points of a mesh, one per element.
    pub(super) fn mesh_points(
        &self,
        solid: &Solid,
        file: &MeshFile,
        resources: &Resources<'_>,
    ) -> Result<(PointCloud, MeshBody), BuildError> {
        let path = resources.beside(&file.path);
        let mesh = self.read_mesh("body.file", &path, resources)?;
        let options = PointOptions {
            unit: file.unit,
            thickness: file.section,
            blocks: (!file.blocks.is_empty()).then(|| file.blocks.clone()),
        };
        let points = mesh.points(&options).map_err(|problem| {
            if let Problem::UnknownBlock { name, known } = &problem {
                let known = known.iter().map(String::as_str);
                return at_path("body.blocks", Fault::unknown_word("block", name, known));
            }
            let reason = format!("{}: {problem}", path.display());
            at_path("body.file", Fault::BadMesh { reason })
        })?;
        if points.dimension != file.dimension {
            let (given, found) = (file.dimension, points.dimension);
            let fault = Fault::other(
                "different dimension",
                format!(
                    "the elements of the mesh have dimension {found}, but the body has dimension {given}"
                ),
                format!(
                    "set dimension = {found}; surface elements of a solid mesh only define sets"
                ),
            );
            return Err(at_path(
                ["body.dimension", "body.file"].map(KeyPath::from),
                fault,
            ));
        }
        self.check_element_size(file, &points)?;
        let body = MeshBody {
            mesh,
            points,
            unit: file.unit,
            placement: Placement::default(),
        };
        let listed = ListedPoints {
            positions: body.points.positions.clone(),
            blocks: body.blocks(),
            volumes: body.points.volumes.clone(),
        };
        let cloud = listed
            .cloud(file.dimension, file.section)
            .map_err(|error| at("body.file", error))?;
        self.check_listed(solid, &cloud, resources)?;
        let sizes = body.points.check_sizes(solid.material.horizon());
        for problem in body.points.warnings.iter().chain(&sizes) {
            let problem = problem.to_string();
            self.warn("body.file", Caution::Mesh { problem });
        }
        self.warnings
            .extend(self.check_listed_points(&listed, &cloud));
        Ok((cloud, body))
    }

    /// Reads the mesh file given by a key.
    pub(super) fn read_mesh(
        &self,
        key: impl Into<KeyPath>,
        path: &Path,
        resources: &Resources<'_>,
    ) -> Result<RawMesh, BuildError> {
        let mesh = (resources.read_mesh)(path, resources.memory);
        mesh.map_err(|error| {
            let fault = error.fault(|reason| Fault::BadMesh { reason });
            at_path(key.into(), fault)
        })
    }

    /// Rejects a given spacing that differs much from the element size.
    fn check_element_size(&self, file: &MeshFile, points: &MeshPoints) -> Result<(), BuildError> {
        /// Larger factors indicate a wrong unit.
        const OFF: f64 = 2.0;
        let found = points.mean_size();
        match file.spacing {
            Some(given) if !(1.0 / OFF..=OFF).contains(&(found / given)) => {
                let fault = Fault::other(
                    "different size",
                    format!(
                        "the mean element size is {}, but `spacing` is {}",
                        quantity(found, "m"),
                        quantity(given, "m")
                    ),
                    "remove `spacing` to use the mean element size, or correct `unit`",
                );
                Err(at_path("body.spacing", fault))
            }
            _ => Ok(()),
        }
    }
}
