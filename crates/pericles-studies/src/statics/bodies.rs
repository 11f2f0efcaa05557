//! Bodies of the solver studies.

use std::sync::Arc;

use pericles::boundary::{AxisMotion, Load, MotionKind, PrescribedMotion, TimeFunction};
use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, GivenConstants, LinearSolid, StateInfluence, Strains, StressState,
};
use pericles::operator::{BondForm, LinearSolidBody};
use pericles::space::{Grid, Point, PointCloud, PointSet, Region, Shape};
use pericles::{PointScalar, System};
use pericles_run::RunError;

use crate::data::Case;

/// Body of a case: `body` is "plate" or "bar", `cells` the number of cells along a side, `nu` Poisson's ratio,
/// `cracked` whether a crack extends to the middle.
pub(super) fn body(case: &Case<'_>) -> Result<System, RunError> {
    let (cells, nu) = (case.count("cells")?, case.number("nu")?);
    let build = case.one_of("body", &[("plate", plate as Build), ("bar", bar)])?;
    build(cells, nu, case.flag("cracked"))
}

type Build = fn(usize, f64, bool) -> Result<System, RunError>;

/// Plate 1 × 1 in plane stress with a hole of radius 0.1: its first and last rows of points are pulled along y by a
/// total force of 1, and three components are fixed against rigid-body motion.
fn plate(cells: usize, nu: f64, cracked: bool) -> Result<System, RunError> {
    let cloud = plate_with_hole(cells)?;
    let dx = cloud.spacing();
    let crack = Crack::Segment {
        from: [-0.5, 0.2],
        to: [0.0, 0.2],
    };
    let cracks = cracked.then_some(crack);
    let mut system = solid(
        &cloud,
        nu,
        (StressState::PlaneStress, Strains::Small),
        cracks,
    )?;
    let top = points(&cloud, |x| x[1] > 0.5 - dx);
    let bottom = points(&cloud, |x| x[1] < dx - 0.5);
    let pins = [bottom[0], bottom[bottom.len() - 1]];
    for (row, sign) in [(top, 1.0), (bottom, -1.0)] {
        let volume: f64 = row.iter().map(|&i| cloud.volumes()[i as usize]).sum();
        let density = [0.0, sign / volume, 0.0];
        system.add_load(Load::new(row, density, TimeFunction::Constant))?;
    }
    let both = [Some(0.0), Some(0.0), None];
    let along_y = [None, Some(0.0), None];
    for (pin, axes) in pins.into_iter().zip([both, along_y]) {
        let pin = PrescribedMotion::displacement(vec![pin], axes, TimeFunction::Constant);
        system.add_motion(pin)?;
    }
    Ok(system)
}

/// Plate 1 × 1 about the origin with a hole of radius 0.1.
fn plate_with_hole(cells: usize) -> Result<Arc<PointCloud>, RunError> {
    let grid = Grid {
        shape: Shape::Box {
            origin: [-0.5, -0.5, 0.0],
            size: vec![1.0, 1.0],
        },
        spacing: 1.0 / cells as f64,
        section: 1.0,
        holes: vec![Region::Ball {
            centre: [0.0; 3],
            radius: 0.1,
        }],
    };
    Ok(Arc::new(grid.points()?))
}

/// Plate with a hole for finite strains, ν = 1/3, stretched by 5 %: rows within 3.01 spacings of both ends have the
/// prescribed displacement (0, 0.05 y). The second constraint is the upper one.
pub(super) fn stretched(cells: usize) -> Result<System, RunError> {
    let cloud = plate_with_hole(cells)?;
    let laws = (StressState::PlaneStress, Strains::Finite);
    let mut system = solid(&cloud, 1.0 / 3.0, laws, None)?;
    for side in [-1.0, 1.0] {
        let grip = points(&cloud, |x| side * x[1] > 0.5 - 3.01 * cloud.spacing());
        let places = grip.iter().map(|&i| 0.05 * cloud.point(i as usize)[1]);
        let along = [
            Some(AxisMotion::Uniform(0.0)),
            Some(AxisMotion::PerPoint(places.collect())),
            None,
        ];
        system.add_motion(PrescribedMotion::along(
            "grip".into(),
            grip,
            MotionKind::Displacement,
            along,
            TimeFunction::Constant,
            &vec![0.0; 2 * cloud.len()],
            cloud.len(),
        )?)?;
    }
    Ok(system)
}

/// Bar 2 × 1 × 1 with twice as many cells along its length, clamped at one end and sheared at the other; its crack
/// extends through half of it.
fn bar(cells: usize, nu: f64, cracked: bool) -> Result<System, RunError> {
    let dx = 1.0 / cells as f64;
    let cloud = Arc::new(Grid::block([2.0, 1.0, 1.0], dx).points()?);
    let crack = Crack::Polygon {
        corners: vec![
            [1.0, -1.0, 0.5],
            [1.0, 2.0, 0.5],
            [1.0, 2.0, 2.0],
            [1.0, -1.0, 2.0],
        ],
    };
    let cracks = cracked.then_some(crack);
    let mut system = solid(&cloud, nu, (StressState::Spatial, Strains::Small), cracks)?;
    let clamped = points(&cloud, |x| x[0] < 3.0 * dx);
    system.add_motion(PrescribedMotion::fixed(clamped, 3))?;
    let end = points(&cloud, |x| x[0] > 2.0 - dx);
    system.add_load(Load::new(end, [0.0, 0.0, 1.0], TimeFunction::Constant))?;
    Ok(system)
}

/// Linear peridynamic solid with E = ρ = 1, a horizon of three spacings, conical influence function and partial
/// volumes.
fn solid(
    cloud: &Arc<PointCloud>,
    nu: f64,
    (state, strains): (StressState, Strains),
    crack: Option<Crack>,
) -> Result<System, RunError> {
    let solid = LinearSolid {
        density: 1.0,
        elastic: GivenConstants {
            young: Some(1.0),
            poisson_ratio: Some(nu),
            ..GivenConstants::default()
        },
        horizon: 3.0 * cloud.spacing(),
        influence: StateInfluence::Function(InfluenceFunction::Conical),
        volume_correction: VolumeCorrection::Linear,
        failure: BondFailure::Unbreakable,
    };
    let constants = solid.constants(cloud, state)?;
    let cracks: Vec<(Crack, EndRule)> = crack
        .into_iter()
        .map(|crack| (crack, EndRule::Closed))
        .collect();
    let body = LinearSolidBody {
        strains,
        cracks: &cracks,
        ..LinearSolidBody::new(cloud, &constants, VolumeCorrection::Linear)
    };
    let force = body.operator(BondForm::Fastest)?.operator;
    Ok(System::new(
        cloud.clone(),
        force,
        PointScalar::Uniform(1.0),
    )?)
}

/// Points that satisfy a condition on their coordinates.
pub(super) fn points(cloud: &PointCloud, inside: impl Fn(Point) -> bool) -> PointSet {
    let all = 0..cloud.len() as u32;
    all.filter(|&i| inside(cloud.point(i as usize))).collect()
}
