//! Bodies shared by several tests.

use std::sync::Arc;

use pericles::PointScalar;
use pericles::boundary::{Load, PrescribedMotion, TimeFunction};
use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, GivenConstants, LinearSolid, StateInfluence, Strains, StressState,
};
use pericles::operator::{BondForm, LinearSolidBody};
use pericles::prelude::*;

/// A state-based body of Young's modulus 1 with a conical influence function, partial volumes and a horizon
/// of three spacings.
pub struct Solid {
    pub cloud: Arc<PointCloud>,
    pub poisson_ratio: f64,
    pub state: StressState,
    pub strains: Strains,
    pub cracks: Vec<Crack>,
}

impl Solid {
    pub fn system(&self) -> System {
        let solid = LinearSolid {
            density: 1.0,
            elastic: GivenConstants {
                young: Some(1.0),
                poisson_ratio: Some(self.poisson_ratio),
                ..GivenConstants::default()
            },
            horizon: 3.0 * self.cloud.spacing(),
            influence: StateInfluence::Function(InfluenceFunction::Conical),
            volume_correction: VolumeCorrection::Linear,
            failure: BondFailure::Unbreakable,
        };
        let constants = solid.constants(&self.cloud, self.state).unwrap();
        let cracks: Vec<(Crack, EndRule)> = self
            .cracks
            .iter()
            .map(|crack| (crack.clone(), EndRule::Closed))
            .collect();
        let body = LinearSolidBody {
            strains: self.strains,
            cracks: &cracks,
            ..LinearSolidBody::new(&self.cloud, &constants, VolumeCorrection::Linear)
        };
        let force = body.operator(BondForm::Fastest).unwrap().operator;
        System::new(self.cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap()
    }
}

/// A plate 1 × 1 about the origin with a hole of radius 0.1.
pub fn plate_with_hole(cells: usize) -> Arc<PointCloud> {
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
    Arc::new(grid.points().unwrap())
}

/// Points whose coordinates satisfy a condition.
pub fn points(cloud: &PointCloud, inside: impl Fn(Point) -> bool) -> PointSet {
    let all = 0..cloud.len() as u32;
    all.filter(|&i| inside(cloud.point(i as usize))).collect()
}

/// Loads the first and last row of points along y with a total force of 1 and constrains three components
/// against rigid-body motion.
pub fn pull_rows(system: &mut System) {
    let cloud = system.cloud().clone();
    let dx = cloud.spacing();
    let top = points(&cloud, |x| x[1] > 0.5 - dx);
    let bottom = points(&cloud, |x| x[1] < dx - 0.5);
    let pins = [bottom[0], bottom[bottom.len() - 1]];
    let mut load = |points: PointSet, sign: f64| {
        let volume: f64 = points.iter().map(|&i| cloud.volumes()[i as usize]).sum();
        let density = [0.0, sign / volume, 0.0];
        let load = Load::new(points, density, TimeFunction::Constant);
        system.add_load(load).unwrap();
    };
    load(top, 1.0);
    load(bottom, -1.0);
    let both = [Some(0.0), Some(0.0), None];
    let along_y = [None, Some(0.0), None];
    for (pin, axes) in pins.into_iter().zip([both, along_y]) {
        let motion = PrescribedMotion::displacement(vec![pin], axes, TimeFunction::Constant);
        system.add_motion(motion).unwrap();
    }
}

/// A linear plate with a hole in plane stress, in tension along y.
pub fn pulled_plate(cells: usize, poisson_ratio: f64, cracks: Vec<Crack>) -> System {
    let solid = Solid {
        cloud: plate_with_hole(cells),
        poisson_ratio,
        state: StressState::PlaneStress,
        strains: Strains::Small,
        cracks,
    };
    let mut system = solid.system();
    pull_rows(&mut system);
    system
}

/// A linear bar in space, 2 × 1 × 1, of 2n · n · n cells, fixed at one end and sheared at the other.
pub fn sheared_bar(n: usize, poisson_ratio: f64, cracks: Vec<Crack>) -> System {
    let dx = 1.0 / n as f64;
    let cloud = Arc::new(Grid::block([2.0, 1.0, 1.0], dx).points().unwrap());
    let solid = Solid {
        cloud: cloud.clone(),
        poisson_ratio,
        state: StressState::Spatial,
        strains: Strains::Small,
        cracks,
    };
    let mut system = solid.system();
    let clamped = points(&cloud, |x| x[0] < 3.0 * dx);
    let motion = PrescribedMotion::fixed(clamped, 3);
    system.add_motion(motion).unwrap();
    let end = points(&cloud, |x| x[0] > 2.0 - dx);
    let load = Load::new(end, [0.0, 0.0, 1.0], TimeFunction::Constant);
    system.add_load(load).unwrap();
    system
}

/// A linear bond-based plate 1 × 1 in plane strain without a hole, whose first three rows are fixed while the
/// last three are moved.
pub fn constrained_plate(cells: usize) -> System {
    let dx = 1.0 / cells as f64;
    let cloud = Arc::new(Grid::plate([1.0, 1.0], dx, 1.0).points().unwrap());
    let mut material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0 * dx);
    material.law = PairLaw::Linear;
    let bottom = points(&cloud, |x| x[1] < 3.0 * dx);
    let top = points(&cloud, |x| x[1] > 1.0 - 3.0 * dx);
    let moved = [Some(0.0), Some(0.01), None];
    Body::new(cloud, material)
        .stress_state(StressState::PlaneStrain)
        .motion(PrescribedMotion::fixed(bottom, 2))
        .motion(PrescribedMotion::displacement(
            top,
            moved,
            TimeFunction::Constant,
        ))
        .build()
        .unwrap()
}
