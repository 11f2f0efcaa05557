//! Faces under tractions and pressures.

use pericles::boundary::LoadDensity;
use pericles::space::{PointCloud, Region};
use pericles_deck::{BuildError, Component, Fault, KeyPath, Load, Members};

use super::area::LoadedCells;
use super::assembler::Assembler;
use super::discretisation::Discretisation;
use super::loads::volume_of;
use super::mesh_body::Meshes;
use super::rejection::at_path;

/// The amplitude of a pressure, and the loaded area, m².
pub(super) type PressureLoad = (LoadDensity, f64);

impl Assembler<'_> {
    /// Returns the area of the faces of a mesh in a set, m²: of a face set, or of the face set near the points of a
    /// set.
    pub(super) fn face_area(&self, meshes: &Meshes, set: &str) -> Option<f64> {
        let named = self.model.sets.iter().find(|named| named.name == set);
        let faces = match named.map(|named| &named.members) {
            None => set,
            Some(Members::NearFaces(near)) => &near.faces,
            Some(_) => return None,
        };
        meshes.face_set(faces)?.1.area
    }

    /// Returns a pressure on a face set of a mesh or on a layer, as a force density on the points with these faces.
    pub(super) fn pressure(
        &self,
        path: &KeyPath,
        load: &Load,
        pressure: &Component,
        discretisation: &Discretisation,
        points: &[u32],
    ) -> Result<PressureLoad, BuildError> {
        let cloud = &*discretisation.cloud;
        let of_faces = match discretisation.meshes.face_set(&load.set) {
            Some((_, set)) if set.inner_faces > 0 => {
                let fault = Fault::NoFaces {
                    set: load.set.clone(),
                    inner: set.inner_faces,
                };
                return Err(at_path(path.key("pressure"), fault));
            }
            Some((mesh, set)) => mesh.face_vectors(cloud, set, points),
            None => None,
        };
        let forces = match of_faces {
            Some(found) => found,
            None => self.layer_vectors(path, load, cloud, points)?,
        };
        let (vectors, area) = forces;
        let mut densities = vec![0.0; 3 * points.len()];
        for (k, (&i, vector)) in points.iter().zip(&vectors).enumerate() {
            let value = pressure.value(cloud.point(i as usize), 0.0);
            if !value.is_finite() {
                let field = [0, 1, 2].map(|_| pressure.clone());
                return Err(self.no_value(path, &field, 0, cloud, i));
            }
            let volume = cloud.volumes()[i as usize];
            for (c, along) in vector.iter().enumerate() {
                densities[c * points.len() + k] = -value * along / volume;
            }
        }
        Ok((LoadDensity::PerPoint(densities), area))
    }

    /// Returns the area vectors of the points of a layer along the outward normal, proportional to their volumes.
    fn layer_vectors(
        &self,
        path: &KeyPath,
        load: &Load,
        cloud: &PointCloud,
        points: &[u32],
    ) -> Result<(Vec<[f64; 3]>, f64), BuildError> {
        let named = self.model.sets.iter().find(|named| named.name == load.set);
        let solid = self.model.body.solid();
        let has_cells = cloud.dimension() == 1 || solid.is_some_and(|s| !s.shape.is_listed());
        let region = named.and_then(|named| named.members.region());
        let Some(Region::Layer { face, .. }) = region.filter(|_| has_cells) else {
            let set = load.set.clone();
            return Err(at_path(
                path.key("pressure"),
                Fault::NoFaces { set, inner: 0 },
            ));
        };
        let area = LoadedCells::new(cloud, points).seen_along(face.axis);
        let volume = volume_of(cloud, points);
        let sign = if face.upper { 1.0 } else { -1.0 };
        let vector = |&i: &u32| {
            let mut vector = [0.0; 3];
            vector[face.axis] = sign * area * cloud.volumes()[i as usize] / volume;
            vector
        };
        Ok((points.iter().map(vector).collect(), area))
    }
}
