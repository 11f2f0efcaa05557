//! The neighbour-list force equals the sum over all pairs from the definition, for every storage of bond
//! stiffnesses.

use crate::common;
use std::sync::Arc;

use pericles::family::{BondList, VolumeCorrection};
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{
    BondMaterial, BondStretch, CubicSofteningBond, Fracture, GreenBond, LinearBond, PairForce,
    StressState,
};
use pericles::neighbourhood::BondSet;
use pericles::operator::{
    BondForce, Breakable, Breaking, DamageMeasure, Force, InstructionSet, PointSubset, VectorLaw,
};
use pericles::space::PointCloud;
use pericles::{Path, StepEnd};

/// Numbers in (−1, 1).
fn noise(len: usize) -> Vec<f64> {
    (0..len)
        .map(|k| ((k as f64 * 12.9898).sin() * 43758.5453).fract())
        .collect()
}

const DX: f64 = 0.01;

/// A box on a lattice, or with all points moved and all volumes changed.
fn body(dimension: usize, moved: bool) -> Arc<PointCloud> {
    let size = if dimension == 3 {
        [0.11, 0.09, 0.07]
    } else {
        [0.4, 0.13, 0.0]
    };
    let section = if dimension == 3 { 1.0 } else { 0.02 };
    let cloud = common::boxed([0.0; 3], &size[..dimension], DX, section);
    if !moved {
        return cloud;
    }
    let positions = cloud.positions().iter().zip(noise(dimension * cloud.len()));
    let volumes = cloud.volumes().iter().zip(noise(cloud.len()));
    let cloud = PointCloud::new(
        dimension,
        positions.map(|(x, r)| x + 0.3 * DX * r).collect(),
        volumes.map(|(v, r)| v * (1.0 + 0.2 * r)).collect(),
        section,
    );
    Arc::new(cloud.unwrap())
}

fn material(correction: VolumeCorrection, influence: Influence) -> BondMaterial {
    BondMaterial {
        influence,
        ..common::material(
            1000.0,
            2e9,
            0.03,
            correction,
            Fracture::CriticalStretch(0.05),
        )
    }
}

fn force(operator: &dyn Force, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    operator.add_force(0.0, u, PointSubset::All, &mut out);
    out
}

/// The sum over all pairs, from the definition.
fn by_definition<L: PairForce, const D: usize>(
    cloud: &PointCloud,
    material: &BondMaterial,
    micromodulus: f64,
    u: &[f64],
) -> Vec<f64> {
    let n = cloud.len();
    let correction = material.volume_correction;
    let mut out = vec![0.0; D * n];
    for i in 0..n {
        for j in (0..n).filter(|&j| j != i) {
            let (a, b) = (cloud.point(i), cloud.point(j));
            let full: [f64; 3] = std::array::from_fn(|c| b[c] - a[c]);
            let r = full.iter().map(|x| x * x).sum::<f64>().sqrt();
            if r > correction.reach(material.horizon, cloud.spacing()) {
                continue;
            }
            let cell = 0.5 * (cloud.cell_size(i) + cloud.cell_size(j));
            let weight = micromodulus
                * material.influence.alpha(r, material.horizon)
                * correction.factor(r, material.horizon, cell)
                * cloud.volumes()[j];
            let xi: [f64; D] = std::array::from_fn(|c| full[c]);
            let eta: [f64; D] = std::array::from_fn(|c| u[c * n + j] - u[c * n + i]);
            let force = L::force(xi, eta);
            for c in 0..D {
                out[c * n + i] += weight * force[c];
            }
        }
    }
    out
}

fn assert_close(value: &[f64], expected: &[f64], what: &str) {
    let largest = expected.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    for (a, b) in value.iter().zip(expected) {
        assert!((a - b).abs() < 1e-12 * largest, "{what}: {a} {b}");
    }
}

/// Stiffnesses by formula (constant, conical), by code (Gaussian on a lattice) and one per bond (Gaussian on moved
/// points); strains of 1e-6, and some beyond the range of the fast form.
fn check<L: VectorLaw, const D: usize>(state: StressState) {
    let influences = [
        (InfluenceFunction::Constant, ActsOn::Stretch),
        (InfluenceFunction::Constant, ActsOn::Displacement),
        (InfluenceFunction::Conical, ActsOn::Stretch),
        (InfluenceFunction::Inverse, ActsOn::Displacement),
        (
            InfluenceFunction::Gaussian {
                length: 0.02,
                cutoff: None,
            },
            ActsOn::Stretch,
        ),
    ];
    for moved in [false, true] {
        let cloud = body(D, moved);
        for (function, acts_on) in influences.clone() {
            for correction in [
                VolumeCorrection::None,
                VolumeCorrection::Linear,
                VolumeCorrection::Extended,
            ] {
                let what = format!("{D}D, moved {moved}, {function:?} {acts_on:?}, {correction:?}");
                let influence = Influence {
                    function: function.clone(),
                    acts_on,
                };
                let material = material(correction, influence);
                let constants = material.constants(&cloud, state).unwrap();
                let mut list = common::listed::<L, D>(&cloud, &material, state, None, &[]);
                for size in [1e-8, 2e-4] {
                    let u: Vec<f64> = noise(D * cloud.len()).iter().map(|r| size * r).collect();
                    let expected =
                        by_definition::<L, D>(&cloud, &material, constants.micromodulus, &u);
                    for set in InstructionSet::available() {
                        list = list.with_instruction_set(set);
                        assert_close(&force(&list, &u), &expected, &what);
                    }
                }
            }
        }
    }
}

#[test]
fn bars_equal_the_definition() {
    check::<BondStretch, 1>(StressState::Uniaxial);
    check::<LinearBond, 1>(StressState::Uniaxial);
    check::<CubicSofteningBond, 1>(StressState::Uniaxial);
}

#[test]
fn plates_equal_the_definition() {
    check::<BondStretch, 2>(StressState::PlaneStress);
    check::<GreenBond, 2>(StressState::PlaneStrain);
}

#[test]
fn blocks_equal_the_definition() {
    check::<BondStretch, 3>(StressState::Spatial);
}

/// The same bonds break on all instruction sets, and dissipated energies agree.
#[test]
fn the_same_bonds_break_on_every_instruction_set() {
    let cloud = body(3, true);
    let material = material(VolumeCorrection::Extended, Influence::default());
    let n = cloud.len();
    let u: Vec<f64> = noise(3 * n).iter().map(|r| 8e-4 * r).collect();
    let still = vec![0.0; 3 * n];
    let broken = |set| {
        let mut list =
            common::listed::<BondStretch, 3>(&cloud, &material, StressState::Spatial, None, &[])
                .with_instruction_set(set);
        let mut out = vec![0.0; 3 * n];
        let end = StepEnd {
            t: 0.0,
            dt: 1e-6,
            u: &u,
            path: Path::MeanVelocity(&still),
        };
        list.end_step(&end, PointSubset::All, &mut out);
        let mut damage = vec![0.0; n];
        list.damage_into(&mut damage);
        (
            damage,
            list.bonds().broken_bonds(),
            list.bonds().dissipated(),
        )
    };
    let (damage, count, dissipated) = broken(InstructionSet::Baseline);
    assert!(count > 100);
    for set in InstructionSet::available() {
        let other = broken(set);
        assert_eq!((&other.0, other.1), (&damage, count), "{set:?}");
        assert!((other.2 / dissipated - 1.0).abs() < 1e-12);
    }
}

/// Neighbours whose numbers differ by more than two bytes: two interleaved halves of a bar.
#[test]
fn neighbours_with_distant_numbers_are_found() {
    let half = 70_000;
    let x = |k: usize| ((k % half) * 2 + k / half) as f64;
    let positions: Vec<f64> = (0..2 * half).map(x).collect();
    let cloud = PointCloud::new(1, positions, vec![1.0; 2 * half], 1.0).unwrap();
    let cloud = Arc::new(cloud);
    let bonds = BondList::new(&cloud, 3.5, VolumeCorrection::None).unwrap();
    assert_eq!(bonds.directed_bonds(), 2 * (6 * half as u64 - 6));
    let list = BondForce::<LinearBond, 1>::with_stiffness(
        cloud.clone(),
        bonds,
        &|_| 1.0,
        Breaking {
            critical_stretch: f64::INFINITY,
            no_fail: &[],
        },
        DamageMeasure::default(),
    )
    .unwrap();
    // u = 1e-6 x²: a pair of opposite bonds gives 2e-6 |ξ|, in total 12e-6; values of u of 2e4 have a rounding
    // error of 4e-12.
    let u: Vec<f64> = cloud.axis(0).iter().map(|x| 1e-6 * x * x).collect();
    let f = force(&list, &u);
    for i in (0..2 * half).filter(|&i| (3.0..2.0 * half as f64 - 4.0).contains(&cloud.axis(0)[i])) {
        assert!((f[i] - 12e-6).abs() < 1e-10, "{i}: {}", f[i]);
    }
}

/// 46³ points with 122 neighbours: 2.5 bytes and 3 bits per entry, rows of 64 bytes; with u, v, a (72 B) and the
/// cloud (36 B) about 520 B in total.
#[test]
fn memory_per_point_is_as_documented() {
    let cloud = common::boxed([0.0; 3], &[0.46; 3], DX, 1.0);
    let material = BondMaterial {
        horizon: 3.015 * DX,
        ..material(VolumeCorrection::Linear, Influence::default())
    };
    let list = common::listed::<BondStretch, 3>(&cloud, &material, StressState::Spatial, None, &[]);
    assert_eq!(list.directed_bonds(), 11_006_544);
    let bytes = list.bytes() as f64 / cloud.len() as f64;
    assert!(bytes < 420.0, "{bytes}");
}
