//! The part of a body that a process computes.
//!
//! Every process creates the points and conditions of the whole body, so that sets, areas, constants, warnings and errors are the
//! same on all of them without communication. Forces and states exist for its own points only.

use std::borrow::Cow;
use std::sync::Arc;

use pericles::boundary::{AxisMotion, Load, LoadDensity};
use pericles::division::part_of;
use pericles::domain::{Comm, agreed};
use pericles::material::SurfaceCorrection;
use pericles::space::{PointCloud, PointSet};
use pericles::{Need, PericlesError, PointScalar};
use pericles_deck::{Body, BoundaryCondition, BuildError, Fault, Keys, MaterialModel};
use pericles_waves::ForceForm;

use super::assembler::Assembler;
use super::discretisation::{Discretisation, Sets};
use super::refusal::{at, at_path};
use crate::composition::has_need;
use crate::division::owners;

/// The points of a process, and the values of the whole body at them.
pub(super) struct Part {
    /// Own points; all points of the body if it is not divided.
    pub(super) cloud: Arc<PointCloud>,
    /// Their numbers in the whole body; `None` if it is not divided.
    numbers: Option<Vec<u32>>,
}

impl Part {
    /// The whole body.
    pub(super) fn whole(cloud: &Arc<PointCloud>) -> Self {
        Self {
            cloud: Arc::clone(cloud),
            numbers: None,
        }
    }

    /// Returns whether the body is divided among several processes.
    pub(super) fn is_divided(&self) -> bool {
        self.numbers.is_some()
    }

    /// Returns the values at own points, of one value per point of the whole body.
    pub(super) fn own<'a, T: Copy>(&self, of_whole: &'a [T]) -> Cow<'a, [T]> {
        match &self.numbers {
            // Some arrays are empty if all points have the same value.
            Some(numbers) if !of_whole.is_empty() => {
                Cow::Owned(numbers.iter().map(|&k| of_whole[k as usize]).collect())
            }
            _ => Cow::Borrowed(of_whole),
        }
    }

    /// Returns a constant of own points.
    pub(super) fn scalar(&self, of_whole: PointScalar) -> PointScalar {
        match of_whole {
            PointScalar::PerPoint(values) => PointScalar::PerPoint(self.own(&values).into_owned()),
            uniform => uniform,
        }
    }

    /// Returns the own points of a set, and their places in the set; `None` for the places if all are own points.
    fn members(&self, set: &[u32]) -> (PointSet, Option<Vec<usize>>) {
        let Some(numbers) = &self.numbers else {
            return (set.to_vec(), None);
        };
        // Both are ascending.
        let found = set.iter().enumerate().filter_map(|(place, point)| {
            let own = numbers.binary_search(point).ok()?;
            Some((own as u32, place))
        });
        let (points, places) = found.unzip();
        (points, Some(places))
    }

    /// Returns the values at the own points of a set, of one value per point of the set.
    pub(super) fn own_of(&self, set: &[u32], values: Vec<f64>) -> Vec<f64> {
        match self.members(set).1 {
            Some(places) => places.iter().map(|&k| values[k]).collect(),
            None => values,
        }
    }

    /// Returns the own points of a set.
    pub(super) fn set(&self, set: &[u32]) -> PointSet {
        self.members(set).0
    }

    /// Returns the sets of own points; they may be empty.
    pub(super) fn sets<'s>(&self, sets: &'s Sets) -> Cow<'s, Sets> {
        match self.is_divided() {
            false => Cow::Borrowed(sets),
            true => Cow::Owned(
                sets.iter()
                    .map(|(name, set)| (name.clone(), self.set(set)))
                    .collect(),
            ),
        }
    }

    /// Returns a load on own points.
    pub(super) fn load(&self, load: Load) -> Load {
        let (points, Some(places)) = self.members(&load.points) else {
            return load;
        };
        let of = load.points.len();
        let density = match load.density {
            LoadDensity::PerPoint(values) => {
                let components = values.chunks(of.max(1));
                let own = components.flat_map(|one| places.iter().map(|&k| one[k]));
                LoadDensity::PerPoint(own.collect())
            }
            LoadDensity::Field {
                field,
                factor,
                places: all,
            } => LoadDensity::Field {
                field,
                factor,
                places: places.iter().map(|&k| all[k]).collect(),
            },
            // Values of programs exist for undivided bodies only.
            same @ (LoadDensity::Uniform(_) | LoadDensity::Values(_)) => same,
        };
        Load {
            points,
            density,
            ..load
        }
    }

    /// Returns the own points of a set and the motions prescribed on them, of those of the whole set.
    pub(super) fn motions(
        &self,
        set: &[u32],
        along: [Option<AxisMotion>; 3],
    ) -> (PointSet, [Option<AxisMotion>; 3]) {
        let (points, Some(places)) = self.members(set) else {
            return (set.to_vec(), along);
        };
        let own = |motion: AxisMotion| match motion {
            AxisMotion::PerPoint(values) => {
                AxisMotion::PerPoint(places.iter().map(|&k| values[k]).collect())
            }
            AxisMotion::Trajectory {
                trajectory,
                places: all,
            } => AxisMotion::Trajectory {
                trajectory,
                places: places.iter().map(|&k| all[k]).collect(),
            },
            same @ (AxisMotion::Uniform(_) | AxisMotion::Values(_)) => same,
        };
        (points, along.map(|motion| motion.map(own)))
    }

    /// Returns the result of this process, or an error if another process has failed. All processes must call it together.
    pub(super) fn agreed<T>(&self, result: Result<T, BuildError>) -> Result<T, BuildError> {
        let elsewhere = || at("body", PericlesError::OnAnotherProcess);
        agreed(&**self.cloud.domain().comm(), result, elsewhere)
    }

    /// Returns the points of the whole body that are marked on any process, on the first process; own points on the others. All
    /// processes must call it together.
    pub(super) fn gathered_points(&self, points: PointSet) -> PointSet {
        let Some(numbers) = &self.numbers else {
            return points;
        };
        let own = points.iter().map(|&i| f64::from(numbers[i as usize]));
        let Some(all) = self.cloud.domain().collect(own.collect()) else {
            return points;
        };
        let mut all: PointSet = all.concat().into_iter().map(|k| k as u32).collect();
        all.sort_unstable();
        all
    }
}

impl Assembler<'_> {
    /// Returns the points of the calling process.
    ///
    /// # Errors
    /// A model that cannot be divided, with the reason; more processes than parts.
    pub(super) fn part(
        &self,
        whole: &Discretisation,
        comm: Option<&Arc<dyn Comm>>,
    ) -> Result<Part, BuildError> {
        let Some(comm) = comm.filter(|comm| comm.size() > 1) else {
            return Ok(Part::whole(&whole.cloud));
        };
        if let Some((keys, reason)) = self.undivided(whole) {
            return Err(at_path(keys, Fault::Undivided { reason }));
        }
        let reach = self.reach(&whole.cloud);
        let refuse = |error: PericlesError| at("body", error);
        let owners = owners(&whole.cloud, reach, comm.size()).map_err(refuse)?;
        let mut sizes = vec![0usize; comm.size()];
        owners.iter().for_each(|&owner| sizes[owner as usize] += 1);
        if sizes.contains(&0) {
            let fault = Fault::TooManyProcesses {
                processes: comm.size(),
                points: whole.cloud.len(),
            };
            return Err(at_path("body", fault));
        }
        let part = part_of(&whole.cloud, &owners, reach, Arc::clone(comm)).map_err(refuse)?;
        let numbers = (0..part.len()).map(|k| part.domain().number(k) as u32);
        Ok(Part {
            numbers: Some(numbers.collect()),
            cloud: Arc::new(part),
        })
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
    pub(super) fn undivided(&self, whole: &Discretisation) -> Option<(Keys, &'static str)> {
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
        let others = self.model.materials.iter().map(|other| &other.model);
        let models: Vec<_> = std::iter::once(&solid.material.model)
            .chain(others)
            .collect();
        let is_inelastic = |model: &MaterialModel| matches!(model, MaterialModel::StateBased(state) if !state.inelastic.is_elastic());
        if models.iter().any(|model| is_inelastic(model)) {
            return Some((
                "material".into(),
                "viscous and plastic materials store the history of both ends of a bond in the same process",
            ));
        }
        let breaks_by_stress = |model: &MaterialModel| match model {
            MaterialModel::StateBased(state) => state.criterion.is_some(),
            MaterialModel::Correspondence(solid) => solid.criterion.is_some(),
            MaterialModel::Bonds(_) => false,
        };
        let in_zones = has_need(&self.model.time.scheme, Need::FiniteReach);
        if in_zones && models.iter().any(|model| breaks_by_stress(model)) {
            return Some((
                "material.failure".into(),
                "with a fine region, failure by stress or strain would depend on the division; use a scheme with one time step",
            ));
        }
        if solid.material.surface_correction == SurfaceCorrection::Ghosts {
            return Some((
                "material.surface_correction".into(),
                "the ghost layer outside the body is created for a whole body; use surface_correction = \"energy\"",
            ));
        }
        if !whole.conditions.are_none() {
            return Some((
                "body".into(),
                "conditions given by a program refer to all points",
            ));
        }
        None
    }
}
