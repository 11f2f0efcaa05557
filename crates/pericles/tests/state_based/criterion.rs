//! Bonds that break by stress and strain: the tensors of points against closed forms.

use std::sync::Arc;

use crate::bodies::{jittered, solid};
use crate::common::boxed;
use pericles::PericlesError;
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondCriterion, BondFailure, BondState, Criterion, LinearSolid, LinearSolidConstants,
    PrincipalStress, StateInfluence, Strains, StressState,
};
use pericles::operator::{BondForm, Force, LinearSolidBody};
use pericles::space::PointCloud;

/// A failure index by a function.
#[derive(Debug)]
struct Index(fn(&BondState) -> f64);

impl BondCriterion for Index {
    fn failure_index(&self, bond: &BondState) -> f64 {
        (self.0)(bond)
    }

    fn words(&self) -> String {
        "by a function".into()
    }
}

fn constants(
    material: &LinearSolid,
    cloud: &PointCloud,
    state: StressState,
    criterion: Criterion,
) -> LinearSolidConstants {
    let material = LinearSolid {
        failure: BondFailure::ByCriterion,
        ..material.clone()
    };
    LinearSolidConstants {
        criterion: Some(criterion),
        ..material.constants(cloud, state).unwrap()
    }
}

fn small(cloud: &Arc<PointCloud>, constants: &LinearSolidConstants) -> Box<dyn Force> {
    let body = LinearSolidBody {
        strains: Strains::Small,
        ..LinearSolidBody::new(cloud, constants, VolumeCorrection::None)
    };
    body.operator(BondForm::Fastest).unwrap().operator
}

/// u = H x.
fn affine(cloud: &PointCloud, gradient: [[f64; 3]; 3]) -> Vec<f64> {
    let mut u = Vec::new();
    for row in &gradient[..cloud.dimension()] {
        for i in 0..cloud.len() {
            let x = cloud.point(i);
            u.push(row[0] * x[0] + row[1] * x[1] + row[2] * x[2]);
        }
    }
    u
}

fn marks(force: &dyn Force, u: &[f64], fraction: f64) -> Vec<bool> {
    let mut marks = vec![false; force.points()];
    let breaking = force.capabilities().breaking.unwrap();
    breaking.mark_endangered(u, fraction, &mut marks);
    marks
}

/// With the isotropic influence function a lattice has the elastic constants of the continuum, so that stress and
/// strain at points with complete families obey Hooke's law in plane strain.
#[test]
fn stress_and_strain_of_an_isotropic_lattice_follow_hookes_law() {
    let cloud = boxed([0.0; 3], &[17.0, 16.0], 1.0, 1.0);
    let (nu, young) = (0.4, 10.0);
    let material = LinearSolid {
        influence: StateInfluence::Isotropic,
        ..solid(nu, 3.0 * (1.0 + 1e-6), InfluenceFunction::Constant)
    };
    let gradient = [[3e-3, 1.2e-3, 0.0], [-2e-4, -1e-3, 0.0], [0.0; 3]];
    let u = affine(&cloud, gradient);
    let lame = young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let shear = young / (2.0 * (1.0 + nu));
    let [xx, yy, xy] = [3e-3, -1e-3, 5e-4];
    let stress = [
        lame * (xx + yy) + 2.0 * shear * xx,
        lame * (xx + yy) + 2.0 * shear * yy,
        2.0 * shear * xy,
    ];
    let first = |[xx, yy, xy]: [f64; 3]| 0.5 * (xx + yy) + (0.5 * (xx - yy)).hypot(xy);
    // The largest normal stress over the directions of the lattice within the horizon.
    let along = |x: f64, y: f64| {
        (stress[0] * x * x + stress[1] * y * y + 2.0 * stress[2] * x * y) / (x * x + y * y)
    };
    let offsets = (-3..=3).flat_map(|x| (-3..=3).map(move |y| [f64::from(x), f64::from(y)]));
    let normal = offsets
        .filter(|[x, y]| (1.0..9.1).contains(&(x * x + y * y)))
        .map(|[x, y]| along(x, y))
        .fold(0.0, f64::max);
    let cases = [
        (
            Criterion::new(PrincipalStress::new(0.01).unwrap()),
            normal / 0.01,
        ),
        (
            Criterion::new(Index(|bond| bond.principal_stresses()[0])),
            first(stress),
        ),
        (Criterion::new(Index(|bond| bond.stress[1][1])), stress[1]),
        (
            Criterion::new(Index(|bond| bond.principal_strains()[0])),
            first([xx, yy, xy]),
        ),
        (
            Criterion::new(Index(|bond| 0.1 - bond.strain[0][1])),
            0.1 - xy,
        ),
    ];
    let inside: Vec<usize> = (0..cloud.len())
        .filter(|&i| {
            let [x, y, _] = cloud.point(i);
            (6.0..11.0).contains(&x) && (6.0..10.0).contains(&y)
        })
        .collect();
    for (criterion, expected) in cases {
        let force = small(
            &cloud,
            &constants(&material, &cloud, StressState::PlaneStrain, criterion),
        );
        let [below, above] =
            [1.0 - 1e-10, 1.0 + 1e-10].map(|part| marks(&*force, &u, part * expected));
        assert!(inside.iter().all(|&i| below[i] && !above[i]), "{expected}");
    }
}

/// Under a uniform dilatation e the mean stress is D κ e at every point, free surfaces included, because the weighted
/// volume of a point is computed from its own bonds.
#[test]
fn mean_stress_of_a_dilatation_is_exact_at_free_surfaces() {
    for (sides, state, nu) in [
        (vec![6, 5, 5], StressState::Spatial, 0.1),
        (vec![8, 7], StressState::PlaneStress, 0.45),
        (vec![12], StressState::Uniaxial, 0.3),
    ] {
        let cloud = jittered(&sides);
        let trace = |bond: &BondState| (0..3).map(|c| bond.stress[c][c]).sum::<f64>();
        let sum = |bond: &BondState| (0..3).map(|c| bond.strain[c][c]).sum::<f64>();
        let [by_stress, by_strain] = [Index(trace), Index(sum)].map(Criterion::new);
        let material = solid(nu, 2.3, InfluenceFunction::Conical);
        let d = sides.len() as f64;
        let size = 1e-3;
        let mut gradient = [[0.0; 3]; 3];
        (0..sides.len()).for_each(|c| gradient[c][c] = size);
        let u = affine(&cloud, gradient);
        let own = constants(&material, &cloud, state, by_stress);
        let modulus = own.dilatational / d + own.deviatoric / (d * d);
        let others = constants(&material, &cloud, state, by_strain);
        for (constants, expected) in [(own, d * modulus * d * size), (others, d * size)] {
            let force = small(&cloud, &constants);
            assert!(
                marks(&*force, &u, (1.0 - 1e-11) * expected)
                    .iter()
                    .all(|mark| *mark)
            );
            assert!(!marks(&*force, &u, (1.0 + 1e-11) * expected).contains(&true));
        }
    }
}

/// The stencil kernel computes no stress, and a function with negative weights cannot be used with bonds that break.
#[test]
fn unsupported_bodies_are_rejected() {
    let cloud = boxed([0.0; 3], &[9.0, 9.0], 1.0, 1.0);
    let material = solid(0.3, 3.0 * (1.0 + 1e-6), InfluenceFunction::Constant);
    let criterion = Criterion::new(PrincipalStress::new(1.0).unwrap());
    let own = constants(&material, &cloud, StressState::PlaneStress, criterion);
    let body = LinearSolidBody::new(&cloud, &own, VolumeCorrection::None);
    assert_eq!(body.fastest_form(), BondForm::List);
    let error = body.operator(BondForm::Grid).err().unwrap();
    assert!(
        matches!(error, PericlesError::FormNotUsable { .. }),
        "{error}"
    );
    assert!(error.to_string().contains("stress and strain"), "{error}");
    let signed = LinearSolid {
        influence: StateInfluence::Isotropic,
        failure: BondFailure::ByCriterion,
        ..solid(0.3, 5.0 * (1.0 + 1e-6), InfluenceFunction::Constant)
    };
    let error = signed
        .constants(&cloud, StressState::PlaneStress)
        .unwrap_err();
    assert!(error.to_string().contains("negative"), "{error}");
}
