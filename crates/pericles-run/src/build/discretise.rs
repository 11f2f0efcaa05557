//! Points and sets of a model.

use std::sync::Arc;

use super::assembler::Assembler;
use super::refusal::at_path;
use super::resources::Resources;
use pericles::material::{Fracture, PairLaw, SurfaceCorrection};
use pericles::space::{GradedCloud, PointCloud, PointSet};
use pericles_deck::{ALL, Body, BuildError, Fault, KeyPath, Model, ModelWarning, Remark, Solid};
use pericles_manifold::surface::Surface;
use pericles_waves::ForceForm;

/// Sets of points by name, the points of each in rising order.
pub type Sets = Vec<(String, PointSet)>;

/// The points of a model with their sets: plain arrays that a program may look at, change or replace before it goes on to
/// [`assemble`](crate::assemble).
#[derive(Debug, Clone)]
pub struct Discretisation {
    /// The points with their volumes.
    pub cloud: Arc<PointCloud>,
    /// The grids that the points belong to.
    pub grids: Grids,
    /// The surface, if the body is one; its vertices are the points.
    pub surface: Option<Arc<Surface>>,
    /// The sets of points by name, "all" first.
    pub sets: Sets,
    /// What is odd about the points.
    pub warnings: Vec<ModelWarning>,
}

/// The grids of a body, of which parts may have smaller cells.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grids {
    /// Division of each grid's cells: 1 for the whole body's, then those of the refined parts.
    pub ratios: Vec<u32>,
    /// The grid of each point, by its number in `ratios`.
    pub of_point: Vec<u8>,
}

impl Grids {
    /// One grid for so many points.
    pub fn one(points: usize) -> Self {
        Self {
            ratios: vec![1],
            of_point: vec![0; points],
        }
    }
}

impl Discretisation {
    /// The points of a set.
    pub fn set(&self, name: &str) -> Option<&PointSet> {
        let found = self.sets.iter().find(|(known, _)| known == name);
        found.map(|(_, points)| points)
    }

    /// The points of a set, to change them; they must stay in rising order.
    pub fn set_mut(&mut self, name: &str) -> Option<&mut PointSet> {
        let found = self.sets.iter_mut().find(|(known, _)| known == name);
        found.map(|(_, points)| points)
    }

    /// Refuses points, grids and sets that do not belong together. What [`discretise`] makes does; what a program has changed may not.
    pub(super) fn check(&self) -> Result<(), BuildError> {
        let points = self.cloud.len();
        let refuse =
            |keys: KeyPath, reason: String| Err(at_path(keys, Fault::BadDiscretisation { reason }));
        let grids = &self.grids;
        let known = |&grid: &u8| usize::from(grid) < grids.ratios.len();
        if grids.of_point.len() != points || !grids.of_point.iter().all(known) {
            let reason = format!("the grids are not those of {points} points");
            return refuse("body.refine".into(), reason);
        }
        if let Some(surface) = self.surface.as_ref().filter(|s| s.len() != points) {
            let reason = format!(
                "a surface of {} vertices has {points} points",
                surface.len()
            );
            return refuse("body".into(), reason);
        }
        for (name, set) in &self.sets {
            let rising = set.windows(2).all(|pair| pair[0] < pair[1]);
            if !rising || set.last().is_some_and(|&last| last as usize >= points) {
                let reason = format!(
                    "the set `{name}` does not hold points 0 to {} in rising order",
                    points - 1
                );
                return refuse(KeyPath::from("sets").key(name), reason);
            }
        }
        Ok(())
    }
}

/// Makes the points of a model and selects its sets.
///
/// # Errors
/// Points that the engine refuses or that do not fit into the memory, files that cannot be read, sets without points.
pub fn discretise(model: &Model, resources: &Resources<'_>) -> Result<Discretisation, BuildError> {
    let assembler = Assembler { model };
    let mut warnings = Vec::new();
    let (points, surface) = match &model.body {
        Body::Surface(body) => {
            let (surface, cloud) = assembler.surface_points(body, resources)?;
            (GradedCloud::of_one_grid(cloud), Some(Arc::new(surface)))
        }
        Body::Solid(solid) => {
            assembler.check_periodic(solid)?;
            (assembler.points(solid, resources, &mut warnings)?, None)
        }
    };
    Ok(Discretisation {
        sets: assembler.select(&points.cloud)?,
        cloud: Arc::new(points.cloud),
        grids: Grids {
            ratios: points.ratios,
            of_point: points.grid_of_point,
        },
        surface,
        warnings,
    })
}

/// The points of the body alone, with the surface if it is one: what is needed to draw results again.
///
/// # Errors
/// As [`discretise`], except for sets.
pub fn body_points(
    model: &Model,
    resources: &Resources<'_>,
) -> Result<(PointCloud, Option<Surface>), BuildError> {
    let assembler = Assembler { model };
    match &model.body {
        Body::Surface(body) => {
            let (surface, cloud) = assembler.surface_points(body, resources)?;
            Ok((cloud, Some(surface)))
        }
        Body::Solid(solid) => Ok((
            assembler.points(solid, resources, &mut Vec::new())?.cloud,
            None,
        )),
    }
}

impl Assembler<'_> {
    /// Refuses everything at once that a periodic body cannot have.
    pub(super) fn check_periodic(&self, solid: &Solid) -> Result<(), BuildError> {
        let material = &solid.material;
        let spectral = material.form == ForceForm::Spectral;
        let law = material.bonds.law;
        let right_law = law == PairLaw::Linear || (law == PairLaw::GreenStrain && spectral);
        let breaks = material.bonds.fracture != Fracture::Unbreakable;
        let listed = matches!(
            material.form,
            ForceForm::List | ForceForm::Grid | ForceForm::FloatGrid
        );
        let corrected = material.surface_correction != SurfaceCorrection::None;
        let conflicts: Vec<String> = [
            (!right_law, format!("model = \"{}\"", material.model_name())),
            (
                breaks,
                "bonds that break (`fracture_energy`, `critical_stretch`)".into(),
            ),
            (listed, format!("bonds = \"{}\"", material.form.name())),
            (
                !self.model.cracks.is_empty(),
                "pre-cracks ([[crack]])".into(),
            ),
            (
                !material.inclusions.is_empty(),
                "[[material.inclusion]]".into(),
            ),
            (!material.parts.is_empty(), "[[material.part]]".into()),
            (corrected, "a surface correction".into()),
        ]
        .into_iter()
        .filter_map(|(found, what)| found.then_some(what))
        .collect();
        if !solid.shape.is_periodic() || conflicts.is_empty() {
            return Ok(());
        }
        Err(at_path("body.periodic", Fault::NotPeriodic { conflicts }))
    }

    fn select(&self, cloud: &PointCloud) -> Result<Sets, BuildError> {
        let mut sets = vec![(ALL.to_owned(), (0..cloud.len() as u32).collect())];
        let mut problems = Vec::new();
        for set in &self.model.sets {
            let points = set.members.of(cloud);
            if points.is_empty() {
                let fault = Fault::EmptySet {
                    set: set.name.clone(),
                };
                problems.push(Remark::new(KeyPath::from("sets").key(&set.name), fault));
            }
            sets.push((set.name.clone(), points));
        }
        if problems.is_empty() {
            Ok(sets)
        } else {
            Err(BuildError::of(problems))
        }
    }
}
