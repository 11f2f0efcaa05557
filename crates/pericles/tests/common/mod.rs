//! Bodies shared by several tests.
#![allow(dead_code)] // each test uses its part

use std::sync::Arc;

use pericles::family::{BondList, Crack, EndRule, VolumeCorrection};
use pericles::kernel::Influence;
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, Modulus, PairLaw, StressState,
};
use pericles::operator::{BondForce, DamageMeasure, Force, VectorLaw};
use pericles::space::{Grid, PointCloud, PointSet, Shape};
use pericles::{PointScalar, System};

/// A box of cells, given by its lower corner.
pub fn boxed(origin: [f64; 3], size: &[f64], spacing: f64, section: f64) -> Arc<PointCloud> {
    let grid = Grid {
        shape: Shape::Box {
            origin,
            size: size.to_vec(),
        },
        spacing,
        section,
        holes: vec![],
    };
    Arc::new(grid.points().unwrap())
}

/// A material with the modulus of the continuum and a constant influence function.
pub fn material(
    density: f64,
    young: f64,
    horizon: f64,
    volume_correction: VolumeCorrection,
    fracture: Fracture,
) -> BondMaterial {
    BondMaterial {
        law: PairLaw::BondStretch,
        density,
        modulus: Modulus {
            value: ElasticModulus::Young(young),
            calibration: Calibration::Continuum,
        },
        horizon,
        influence: Influence::default(),
        volume_correction,
        fracture,
    }
}

/// The bonds of a material as a neighbour list.
pub fn listed<L: VectorLaw, const D: usize>(
    cloud: &Arc<PointCloud>,
    material: &BondMaterial,
    state: StressState,
    crack: Option<Crack>,
    no_fail: &[u32],
) -> BondForce<L, D> {
    let constants = material.constants(cloud, state).unwrap();
    let mut bonds = BondList::new(cloud, material.horizon, material.volume_correction).unwrap();
    if let Some(crack) = crack {
        bonds.cut(&crack, EndRule::Closed).unwrap();
    }
    BondForce::new(
        cloud.clone(),
        bonds,
        material,
        &constants,
        no_fail,
        DamageMeasure::default(),
    )
    .unwrap()
}

/// A free body of uniform density.
pub fn system(cloud: &Arc<PointCloud>, operator: impl Force + 'static, density: f64) -> System {
    let density = PointScalar::Uniform(density);
    System::new(cloud.clone(), Box::new(operator), density).unwrap()
}

/// The points whose positions satisfy `inside(x, y, z)`.
pub fn points(cloud: &PointCloud, inside: impl Fn(f64, f64, f64) -> bool) -> PointSet {
    (0..cloud.len() as u32)
        .filter(|&i| {
            let [x, y, z] = cloud.point(i as usize);
            inside(x, y, z)
        })
        .collect()
}
