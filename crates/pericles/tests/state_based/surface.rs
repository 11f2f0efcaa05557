//! Bodies with a large fraction of surface, compared with the modulus of their material.

use crate::bodies::solid;
use crate::common::boxed;
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{LinearSolid, SolidSurface, StateInfluence, Strains, StressState};
use pericles::operator::{BondForm, Force, LinearSolidBody, PointSubset};

/// Young's modulus relative to that of the material of a plate in plane stress, twice as long as wide, pulled at
/// its end rows, from the strain of its middle half.
fn measured(cells: usize, material: &LinearSolid, surface: SolidSurface) -> f64 {
    let (length, width) = (cells as f64, 0.5 * cells as f64);
    let cloud = boxed([0.0; 3], &[length, width], 1.0, 1.0);
    let constants = material
        .constants(&cloud, StressState::PlaneStress)
        .unwrap();
    let body = LinearSolidBody {
        strains: Strains::Small,
        surface,
        ..LinearSolidBody::new(&cloud, &constants, material.volume_correction)
    };
    let operator = body.operator(BondForm::Fastest).unwrap().operator;
    let n = cloud.len();
    let along = cloud.axis(0);
    let mut load = vec![0.0; 2 * n];
    for i in 0..n {
        load[i] = match along[i] {
            x if x < 1.0 => -1.0,
            x if x > length - 1.0 => 1.0,
            _ => 0.0,
        };
    }
    let mut u = vec![0.0; 2 * n];
    solve(&*operator, &load, &mut u);
    let section = |place: f64| {
        let near: Vec<f64> = (0..n)
            .filter(|&i| (along[i] - place).abs() < 0.6)
            .map(|i| u[i])
            .collect();
        near.iter().sum::<f64>() / near.len() as f64
    };
    let strain = (section(0.75 * length) - section(0.25 * length)) / (0.5 * length);
    1.0 / strain / constants.elastic.young()
}

/// The same for the interior of the lattice: 4/E = 1/κ + 1/G of the diagonals.
fn interior(material: &LinearSolid) -> f64 {
    let state = StressState::PlaneStress;
    let constants = material.constants_on(&[1.0; 2], 1.0, state).unwrap();
    let solid = constants.elastic;
    let shear = solid.shear() * constants.lattice_shear.unwrap().diagonals;
    let kappa = solid.dilatation_modulus(state);
    4.0 / (1.0 / kappa + 1.0 / shear) / solid.young()
}

/// Solves −K u = load; rigid motions stay zero.
fn solve(operator: &dyn Force, load: &[f64], u: &mut [f64]) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut r = load.to_vec();
    let (mut p, start) = (r.clone(), dot(&r, &r));
    let mut square = start;
    let mut q = vec![0.0; u.len()];
    for _ in 0..5000 {
        if square < 1e-18 * start {
            return;
        }
        q.fill(0.0);
        operator.add_force(0.0, &p, PointSubset::All, &mut q);
        let step = -square / dot(&p, &q);
        for k in 0..u.len() {
            u[k] += step * p[k];
            r[k] += step * q[k];
        }
        let next = dot(&r, &r);
        for k in 0..u.len() {
            p[k] = r[k] + next / square * p[k];
        }
        square = next;
    }
    panic!("the equilibrium was not found");
}

fn plate(nu: f64, spacings: f64, influence: StateInfluence, whole: bool) -> LinearSolid {
    LinearSolid {
        influence,
        volume_correction: match whole {
            true => VolumeCorrection::None,
            false => VolumeCorrection::Linear,
        },
        ..solid(nu, spacings * (1.0 + 1e-6), InfluenceFunction::Constant)
    }
}

/// Without correction, an independent implementation found the value to 0.002. With surface correction the modulus
/// equals the value of the interior of the lattice, exactly for bond-based solids; the bound for others was chosen after
/// seeing the result.
#[test]
fn plates_with_surface_correction_have_the_modulus_of_their_material() {
    let function = |function| StateInfluence::Function(function);
    let constant = || function(InfluenceFunction::Constant);
    let cases = [
        (plate(1.0 / 3.0, 3.0, constant(), false), 40, 1.039),
        (plate(1.0 / 3.0, 3.0, constant(), false), 80, 1.011),
        (plate(0.2, 3.0, constant(), false), 40, 1.035),
        (plate(0.2, 3.0, constant(), false), 80, 1.010),
        (
            plate(0.2, 3.0, function(InfluenceFunction::Conical), false),
            40,
            1.032,
        ),
        (
            plate(0.2, 3.0, function(InfluenceFunction::Conical), false),
            80,
            1.012,
        ),
        (plate(0.2, 3.0, StateInfluence::Isotropic, true), 40, 1.049),
        (plate(0.4, 3.0, StateInfluence::Isotropic, true), 40, 1.057),
        (plate(0.4, 4.0, StateInfluence::Isotropic, true), 40, 1.066),
    ];
    for (material, cells, expected) in cases {
        let name = format!(
            "{cells}, {:?}, {:?}",
            material.influence, material.elastic.poisson_ratio
        );
        let none = measured(cells, &material, SolidSurface::None);
        assert!((none - expected).abs() < 2e-3, "{name}: {none}");
        let energy = measured(cells, &material, SolidSurface::Energy);
        let error = |found: f64| (found / interior(&material) - 1.0).abs();
        let bound = match material.elastic.poisson_ratio {
            Some(nu) if nu == 1.0 / 3.0 => 2e-3,
            _ => 0.02,
        };
        assert!(error(energy) < bound, "{name}: {energy}");
        assert!(error(energy) < 0.5 * error(none), "{name}: {energy}");
    }
}
