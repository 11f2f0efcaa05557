//! Points and operator of a surface.

use std::path::Path;
use std::sync::Arc;

use pericles::PericlesError;
use pericles::cache::Cache;
use pericles::operator::Force;
use pericles::space::PointCloud;
use pericles_deck::{
    BuildError, Fault, KeyPath, LoadAmplitude, SurfaceBody, SurfaceShape, VertexAreas,
};
use pericles_manifold::force;
use pericles_manifold::surface::{Surface, SurfaceChecks, SurfaceError};

use super::assembler::Assembler;
use super::discretisation::Sets;
use super::rejection::{at, at_path};
use super::resources::{FileError, Resources};

impl Assembler<'_> {
    pub(super) fn surface_points(
        &self,
        deck: &SurfaceBody,
        resources: &Resources<'_>,
    ) -> Result<(Surface, PointCloud), BuildError> {
        let surface = match &deck.shape {
            SurfaceShape::File(file) => self.surface_of_file(&file.path, file.checks, resources)?,
            SurfaceShape::Formula(shape) => {
                self.check_vertices(shape.vertices(), resources)?;
                let made = shape.surface();
                made.map_err(|error| at("body", error.into()))?
            }
        };
        let horizon = deck.material.horizon;
        self.check_surface(surface.len(), surface.area(), horizon, resources)?;
        let areas = match deck.areas {
            VertexAreas::Rule(rule) => surface.vertex_areas(rule),
            VertexAreas::Same(area) => vec![area; surface.len()],
        };
        let cloud = surface
            .points(areas)
            .map_err(|error| at("body.areas", error))?;
        Ok((surface, cloud))
    }

    /// Reads and checks a surface; its vertices are numbered along a space-filling curve.
    fn surface_of_file(
        &self,
        path: &Path,
        checks: SurfaceChecks,
        resources: &Resources<'_>,
    ) -> Result<Surface, BuildError> {
        let file = resources.beside(path);
        let rejected = |error: FileError| {
            let file = file.display().to_string();
            let fault = error.fault(|reason| {
                Fault::other(
                    "invalid",
                    format!("{file} is not a valid surface: {reason}"),
                    "a surface must be closed, connected and consistently oriented, unless open, several or flip = true; `pericles geodesics FILE` reports details",
                )
            });
            at_path("body.file", fault)
        };
        let (surface, _) = (resources.read_surface)(&file, resources.memory)
            .and_then(|surface| Ok(surface.checked(checks).map_err(|error| error.to_string())?))
            .map_err(rejected)?;
        Ok(surface.renumbered())
    }

    pub(super) fn surface_operator(
        &self,
        deck: &SurfaceBody,
        surface: &Surface,
        cloud: &Arc<PointCloud>,
        sets: &Sets,
        cache: &dyn Cache,
    ) -> Result<Box<dyn Force>, BuildError> {
        let geodesics = deck.geodesics;
        let pairs = geodesics
            .ball
            .pairs(surface, deck.material.horizon, geodesics.method, cache)
            .map_err(|error| match error {
                PericlesError::HorizonTooSmall { .. } => at("material.horizon", error),
                _ => match error.extension() {
                    Some(SurfaceError::Folded { .. }) => at("geodesics.ball", error),
                    _ => at("geodesics", error),
                },
            })?;
        let no_fail = self.union_of(sets, &deck.material.no_fail)?;
        let stiffness = self.stiffness_of(cloud, sets)?;
        force::SurfaceBody {
            surface,
            cloud,
            pairs: &pairs,
            material: &deck.material.power(),
            stiffness: &stiffness,
            no_fail: &no_fail,
        }
        .operator()
        .map_err(|error| at("material", error))
    }

    /// Rejects loads that require a volume.
    pub(super) fn reject_body_forces(&self) -> Result<(), BuildError> {
        for (k, load) in self.model.loads.iter().enumerate() {
            let key = match load.amplitude {
                LoadAmplitude::BodyForce(_) => "body_force",
                LoadAmplitude::Pressure(_) => "pressure",
                LoadAmplitude::Traction { area: Some(_), .. } => "area",
                LoadAmplitude::Traction { area: None, .. } => continue,
            };
            let fault = Fault::Misplaced {
                key: key.into(),
                table: "a [[load]] of a surface".into(),
                allowed: "use a `traction`, which acts on the area of each vertex".into(),
            };
            return Err(at_path(KeyPath::from("load").index(k).key(key), fault));
        }
        Ok(())
    }
}
