//! The part of a body that a process computes: it has own points only, and sets of own points. What concerns the whole body, such as
//! its bounds or the number of points of a set, is determined together with the other processes.
//!
//! Bounds, volumes and numbers of points of sets are maxima and exact sums over all processes; the cells of loaded
//! sets, from which areas follow, are sent to all. Values at points, which only some processes may reject, are
//! followed by an agreement.

use std::sync::Arc;

use pericles::PericlesError;
use pericles::division::part_by_bisection;
use pericles::domain::{Comm, agreed};
use pericles::material::SurfaceCorrection;
use pericles::space::{GradedCloud, PointCloud, PointSet, PointSource};
use pericles_deck::{Body, BoundaryCondition, BuildError, Fault, Keys};
use pericles_waves::ForceForm;

use super::assembler::Assembler;
use super::discretisation::Discretisation;
use super::points::BodyPoints;
use super::rejection::{at, at_path};
use super::resources::Resources;
use crate::division::cuts_of;

impl Discretisation {
    /// Returns the result of this process, or an error if another process has failed. All processes must call it together.
    pub(super) fn agreed<T>(&self, result: Result<T, BuildError>) -> Result<T, BuildError> {
        agreed_on_body(&**self.cloud.domain().comm(), result)
    }
}

fn agreed_on_body<T>(comm: &dyn Comm, result: Result<T, BuildError>) -> Result<T, BuildError> {
    agreed(comm, result, || at("body", PericlesError::OnAnotherProcess))
}

/// Returns the points of the whole body that are in the sets of own points of all processes, on the first process; own points on
/// the others. All processes must call it together.
pub(crate) fn gathered(cloud: &PointCloud, points: PointSet) -> PointSet {
    let domain = cloud.domain();
    if !domain.is_divided() {
        return points;
    }
    let own = points.iter().map(|&i| domain.number(i as usize) as f64);
    let Some(all) = domain.collect(own.collect()) else {
        return points;
    };
    let mut all: PointSet = all.concat().into_iter().map(|k| k as u32).collect();
    all.sort_unstable();
    all
}

impl Assembler<'_> {
    /// Creates the points of the body, own points if it is divided among several processes.
    ///
    /// # Errors
    /// A model that cannot be divided, with the reason; more processes than parts.
    pub(super) fn own_points(
        &self,
        resources: &Resources<'_>,
        create: impl FnOnce() -> Result<BodyPoints, BuildError>,
    ) -> Result<BodyPoints, BuildError> {
        let Some(comm) = resources.several() else {
            return create();
        };
        if let Some((keys, reason)) = self.undivided() {
            return Err(at_path(keys, Fault::Undivided { reason }));
        }
        let created = agreed_on_body(&**comm, create())?;
        let part = match created.cloud.cloud.domain().is_divided() {
            true => created,
            false => self.part_of(created, comm)?,
        };
        let domain = part.cloud.cloud.domain();
        if !domain.all(domain.owned_points() > 0) {
            let fault = Fault::TooManyProcesses {
                processes: comm.size(),
                points: domain.whole_points(),
            };
            return Err(at_path("body", fault));
        }
        Ok(part)
    }

    /// Returns the part of a body whose points every process has created.
    fn part_of(&self, whole: BodyPoints, comm: &Arc<dyn Comm>) -> Result<BodyPoints, BuildError> {
        let GradedCloud {
            cloud,
            ratios,
            grid_of_point,
        } = whole.cloud;
        let part = self.divided(&cloud, &cloud, comm);
        let part = part.map_err(|error| at("body", error))?;
        let numbers = part.domain().own_numbers();
        Ok(BodyPoints {
            cloud: GradedCloud {
                ratios,
                grid_of_point: numbers.iter().map(|&k| grid_of_point[k as usize]).collect(),
                cloud: part,
            },
            meshes: whole.meshes,
        })
    }

    /// Creates the own points of a body; `like` is a cloud with its cells.
    pub(super) fn divided(
        &self,
        body: &dyn PointSource,
        like: &PointCloud,
        comm: &Arc<dyn Comm>,
    ) -> Result<PointCloud, PericlesError> {
        part_by_bisection(body, self.reach(like), cuts_of(like), Arc::clone(comm))
    }

    /// Returns the largest length of a bond, m.
    pub(crate) fn reach(&self, cloud: &PointCloud) -> f64 {
        let Some(solid) = self.model.body.solid() else {
            return self.model.body.horizon();
        };
        let horizon = self.largest_horizon(solid);
        let sides = (0..cloud.dimension()).map(|c| cloud.cell_side(c));
        let cell = sides.fold(cloud.spacing(), f64::max);
        let correction = solid.material.volume_correction();
        // Positions are equal to rounding.
        correction.reach(horizon, cell) + 1e-6 * cloud.spacing()
    }

    /// Returns the reason why a model runs on a single process only, with the key that causes it.
    pub(super) fn undivided(&self) -> Option<(Keys, &'static str)> {
        let Body::Solid(solid) = &self.model.body else {
            return Some((
                "body.shape".into(),
                "geodesic distances are computed on the whole surface",
            ));
        };
        let absorbing =
            |boundary: &BoundaryCondition| matches!(boundary, BoundaryCondition::Absorbing { .. });
        let form = solid.material.form;
        if self.model.boundaries.iter().any(absorbing) {
            return Some((
                "boundary".into(),
                "exact absorbing boundaries belong to bars, which one process computes",
            ));
        }
        let transforms = form != ForceForm::Fastest && form.of_bonds().is_none();
        if transforms || solid.shape.has_gauss_nodes() {
            return Some((
                "material.bonds".into(),
                "Fourier transforms need all points; use bonds = \"grid\" or \"list\"",
            ));
        }
        if solid.material.surface_correction == SurfaceCorrection::Ghosts {
            return Some((
                "material.surface_correction".into(),
                "the ghost layer outside the body is created for a whole body; use surface_correction = \"energy\"",
            ));
        }
        None
    }
}
