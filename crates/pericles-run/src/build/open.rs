//! Open boundaries of plates.

use pericles::space::{Face, PointCloud, PointSet};
use pericles::time::{Integrator, State};
use pericles::{PericlesError, StepKind, System};
use pericles_deck::{Body, BoundaryCondition, BuildError, Fault, KeyPath, MaterialModel, Solid};
use pericles_waves::absorbing::open::{LatticeWeights, OpenBoundary, OpenOptions, OpenSides};

use super::assembler::Assembler;
use super::discretisation::Sets;
use super::rejection::{at, at_path};
use super::step::Steps;

/// Properties of an open boundary.
#[derive(Debug, Clone)]
pub struct OpenReport {
    /// The open sides.
    pub sides: OpenSides,
    /// The weights of the lattice.
    pub weights: LatticeWeights,
    /// The parameters of the layers.
    pub options: OpenOptions,
    /// Memory of the layers, bytes.
    pub bytes: usize,
    /// Points of the whole body in the layers.
    pub points: u64,
}

impl Assembler<'_> {
    /// Returns the open sides of the body with the key of the first one; `None` if no side is open.
    pub(super) fn open_sides(&self, cloud: &PointCloud) -> Option<(KeyPath, OpenSides)> {
        let mut sides = OpenSides {
            periodic: [cloud.is_periodic(); 2],
            ..OpenSides::default()
        };
        let mut first = None;
        for (k, boundary) in self.model.boundaries.iter().enumerate() {
            let BoundaryCondition::Open {
                sides: faces,
                thickness,
            } = boundary
            else {
                continue;
            };
            first = first.or(Some(k));
            let cells = thickness.length(cloud.spacing()) / cloud.spacing();
            // Rounded to full cells, as positions are.
            let cells = (cells - 1e-6).ceil() as usize;
            faces.iter().for_each(|face| sides.open(*face, cells));
        }
        Some((KeyPath::from("boundary").index(first?), sides))
    }

    /// Returns the points whose bonds never break: those of `no_fail`, and those in open layers and one horizon before them.
    pub(super) fn unbreakable(
        &self,
        solid: &Solid,
        sets: &Sets,
        cloud: &PointCloud,
    ) -> Result<PointSet, BuildError> {
        let mut points = self.union_of(sets, &solid.material.no_fail)?;
        if let Some((_, sides)) = self.open_sides(cloud) {
            let margin = (solid.material.horizon() / cloud.spacing()).ceil() as usize;
            points.extend(sides.points(cloud, margin));
            points.sort_unstable();
            points.dedup();
        }
        Ok(points)
    }

    /// Rejects schemes and parts of a model that open boundaries do not support.
    pub(super) fn check_open(
        &self,
        cloud: &PointCloud,
        integrator: &dyn Integrator,
    ) -> Result<(), BuildError> {
        const NEEDED: &[StepKind] = &[StepKind::EndOfStep];
        let Some((path, _)) = self.open_sides(cloud) else {
            return Ok(());
        };
        let kind = integrator.step_kind();
        if kind != StepKind::EndOfStep || integrator.is_static() {
            let error = PericlesError::BoundaryScheme {
                what: "an open boundary",
                scheme: integrator.name(),
                kind,
                needed: NEEDED,
            };
            return Err(at("time.scheme", error));
        }
        self.check_open_twice()?;
        let model = self.model;
        let solid = match &model.body {
            Body::Solid(solid) => Some(solid),
            Body::Surface(_) => None,
        };
        let bonds =
            solid.is_some_and(|solid| matches!(solid.material.model, MaterialModel::Bonds(_)));
        let is_open = |one: &BoundaryCondition| matches!(one, BoundaryCondition::Open { .. });
        let unsupported = [
            (!bonds, "material", "a bond-based material"),
            (
                !model.boundaries.iter().all(is_open),
                "boundary",
                "no boundary of another kind",
            ),
            (
                model.contact.is_some() || !model.impactors.is_empty(),
                "contact",
                "no contact",
            ),
            (model.thermal.is_some(), "thermal", "no temperature"),
            (model.damping.is_some(), "damping", "no other damping"),
            (model.time.allow_unstable, "time.allow_unstable", "false"),
        ];
        match unsupported.into_iter().find(|(found, ..)| *found) {
            None => Ok(()),
            Some((_, key, allowed)) => Err(at_path(
                path,
                Fault::OutOfRange {
                    value: format!("kind = \"open\" together with `{key}`"),
                    allowed: format!(
                        "allowed: {allowed}; kind = \"damping-layer\" has no such restriction"
                    ),
                },
            )),
        }
    }

    /// Rejects a side that is open twice.
    fn check_open_twice(&self) -> Result<(), BuildError> {
        let mut known: Vec<Face> = Vec::new();
        for (k, boundary) in self.model.boundaries.iter().enumerate() {
            let BoundaryCondition::Open { sides, .. } = boundary else {
                continue;
            };
            if sides.iter().any(|side| known.contains(side)) {
                let fault = Fault::OutOfRange {
                    value: "a side that is already open".into(),
                    allowed: "allowed: each side once; remove one of the open boundaries".into(),
                };
                return Err(at_path(
                    KeyPath::from("boundary").index(k).key("side"),
                    fault,
                ));
            }
            known.extend(sides);
        }
        Ok(())
    }

    /// Opens the sides of the body for the steps of the run.
    pub(super) fn add_open(
        &self,
        system: &mut System,
        start: &State,
        steps: &Steps,
    ) -> Result<Option<OpenReport>, BuildError> {
        let Some((path, sides)) = self.open_sides(system.cloud()) else {
            return Ok(None);
        };
        let reject = |error| at(&path, PericlesError::from(error));
        let made = OpenBoundary::new(system, &sides, OpenOptions::default(), steps.dt, start);
        let boundary = made.map_err(reject)?;
        let report = OpenReport {
            sides,
            weights: boundary.weights().clone(),
            options: *boundary.options(),
            bytes: 8 * boundary.numbers(),
            points: sides.layer_points(system.cloud()) as u64,
        };
        system.add_boundary(Box::new(boundary));
        Ok(Some(report))
    }
}
