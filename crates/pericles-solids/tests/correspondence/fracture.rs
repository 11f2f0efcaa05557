//! Bond failure: calibration, energy balance, points that lose all bonds, resumed runs, threads.

use std::sync::Arc;

use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::material::{
    BondFailure, CrackPlane, FractureCalibration, StressState, StretchDefinition,
};
use pericles::operator::{BondForm, Force, PointSubset};
use pericles::round_trip::check_resume;
use pericles::space::PointCloud;
use pericles::time::{State, VelocityVerlet, highest_frequency};
use pericles::{Control, PointScalar, Simulation, StepEnd, System};
use pericles_solids::correspondence::{
    CorrespondenceBody, CorrespondenceMaterial, ElasticLaw, Stabilisation,
};

use crate::bodies::{lattice, material};

const G0: f64 = 2e-3;

/// Failure by stretch and by energy, calibrated on the lattice.
pub const BY_STRETCH: BondFailure = by_stretch(FractureCalibration::Lattice);
pub const BY_ENERGY: BondFailure = BondFailure::BondEnergy {
    fracture_energy: G0,
    calibration: FractureCalibration::Lattice,
};

const fn by_stretch(calibration: FractureCalibration) -> BondFailure {
    BondFailure::Stretch {
        fracture_energy: G0,
        definition: StretchDefinition::Closing,
        calibration,
    }
}

fn breaking(failure: BondFailure) -> CorrespondenceMaterial {
    let mut material = material(
        0.3,
        3.0 * (1.0 + 1e-6),
        ElasticLaw::NeoHooke,
        Stabilisation::Isotropic,
    );
    material.solid.failure = failure;
    material
}

/// With lattice calibration the mean over planes is the fracture energy; continuum integrals differ by a few per cent.
#[test]
fn critical_stretches_follow_from_the_fracture_energy() {
    for (sides, state) in [
        (&[8.0, 8.0][..], StressState::PlaneStrain),
        (&[8.0, 8.0], StressState::PlaneStress),
        (&[7.0, 7.0, 7.0], StressState::Spatial),
    ] {
        let cloud = lattice(sides);
        let constants = |failure| breaking(failure).constants(&cloud, state).unwrap();
        let own = constants(BY_STRETCH).solid;
        let mean = CrackPlane::mean(&own.crack_planes);
        assert!((mean / G0 - 1.0).abs() < 1e-12, "{mean}");
        let continuum = constants(by_stretch(FractureCalibration::Continuum)).solid;
        let ratio = own.limits.stretch / continuum.limits.stretch;
        assert!((ratio - 1.0).abs() < 0.25, "{ratio}");
    }
}

/// Stretches every bond across a plane by the critical stretch: the dissipated energy is the calibrated
/// energy of the plane.
#[test]
fn dissipated_energy_of_a_closing_deformation_is_the_calibrated_energy() {
    let cloud = lattice(&[9.0, 16.0]);
    let constants = breaking(BY_STRETCH)
        .constants(&cloud, StressState::PlaneStrain)
        .unwrap();
    let plane = constants.solid.crack_planes[0].clone();
    assert_eq!(plane.to_string(), "(10)");
    // No displacement stretches all bonds across by the same amount. Instead, the energy of points in the
    // middle of the width, far from the sides, is summed layer by layer: points beyond the plane have the
    // deformation y → y (1 + s) relative to the point.
    let (n, s) = (cloud.len(), 1e-6 * constants.solid.limits.stretch);
    let body = CorrespondenceBody::new(&cloud, &constants, VolumeCorrection::None);
    let operator = body.operator(BondForm::List).unwrap().operator;
    let mut energy = 0.0;
    for layer in 0..3 {
        // The points beyond the plane at y = 8 are displaced relative to this point.
        let (x, y) = (4.5, 7.5 - f64::from(layer));
        let i = (0..n).find(|&i| cloud.point(i)[..2] == [x, y]).unwrap();
        let mut u = vec![0.0; 2 * n];
        for j in (0..n).filter(|&j| cloud.point(j)[1] > 8.0) {
            u[j] = s * (cloud.point(j)[0] - x);
            u[n + j] = s * (cloud.point(j)[1] - y);
        }
        let mut density = vec![0.0; n];
        operator.add_energy_density(0.0, &u, &mut density);
        energy += 2.0 * density[i];
    }
    let stretch = constants.solid.limits.stretch;
    let per_area = energy * (stretch / s).powi(2);
    assert!(
        (per_area / plane.energy() - 1.0).abs() < 1e-5,
        "{per_area} {}",
        plane.energy()
    );
}

/// The force of a plate with a notch, or of a part of it.
fn notched(cloud: &Arc<PointCloud>, failure: BondFailure) -> Box<dyn Force> {
    let material = breaking(failure);
    let constants = material.constants(cloud, StressState::PlaneStrain).unwrap();
    let notch = Crack::Segment {
        from: [0.0, 8.0],
        to: [5.0, 8.0],
    };
    let no_fail: Vec<u32> = (0..cloud.len() as u32)
        .filter(|&i| cloud.point(i as usize)[0] > 16.0)
        .collect();
    let body = CorrespondenceBody {
        cracks: &[(notch, EndRule::Closed)],
        no_fail: &no_fail,
        ..CorrespondenceBody::new(cloud, &constants, VolumeCorrection::None)
    };
    body.operator(BondForm::List).unwrap().operator
}

/// The plate in tension: initial velocities of the upper and lower half are opposite.
fn torn(part: f64) -> Simulation {
    torn_on(lattice(&[18.0, 16.0]), part, BY_STRETCH)
}

/// The plate in tension, or a part of it.
pub fn torn_on(cloud: Arc<PointCloud>, part: f64, failure: BondFailure) -> Simulation {
    let operator = notched(&cloud, failure);
    let system = System::new(cloud.clone(), operator, PointScalar::Uniform(1.0)).unwrap();
    let n = cloud.len();
    let mut start = State::at_rest(2 * n);
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        start.v[i] = 0.002 * (0.3 * y).sin();
        start.v[n + i] = 0.04 * ((y - 8.0) / 8.0) + 0.004 * (0.2 * x).cos();
    }
    let dt = highest_frequency(&system, &start.u)
        .unwrap()
        .stable_step(2.0, 0.5);
    let steps = (12.0 / dt / part) as u64;
    Simulation::new(system, Box::new(VelocityVerlet), start, part * dt, steps).unwrap()
}

/// The bounds were chosen after seeing the result.
#[test]
fn energy_balance_and_momentum_conservation_hold_while_bonds_break() {
    let mut run = torn(1.0);
    let started = run.system().momentum(&run.state().v);
    run.run(|_| Control::Continue).unwrap();
    let broken = run.system().operator().broken_bonds();
    assert!(broken > 60, "{broken}");
    let energies = run.snapshot().energies();
    assert!(
        energies.dissipated > 0.02 * energies.initial,
        "{energies:?}"
    );
    let error = energies.balance() / energies.dissipated;
    assert!(error.abs() < 1e-3, "{error:e}");
    let ended = run.system().momentum(&run.state().v);
    for c in 0..2 {
        assert!((ended[c] - started[c]).abs() < 1e-12);
    }
}

#[test]
fn resumed_run_is_bitwise_identical() {
    check_resume(|| torn(1.0), [5, 30]).unwrap();
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let end = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut run = torn(1.0);
            run.run(|_| Control::Continue).unwrap();
            let energies = run.snapshot().energies();
            let bits: Vec<u64> = run.state().u.iter().map(|u| u.to_bits()).collect();
            (
                bits,
                energies.dissipated.to_bits(),
                energies.elastic.to_bits(),
            )
        })
    };
    assert_eq!(end(1), end(3));
}

/// A point that is pulled off its body loses all bonds when fewer than three remain; the sum of elastic and
/// dissipated energy is conserved.
#[test]
fn points_with_too_few_bonds_lose_all_bonds() {
    let cloud = lattice(&[8.0, 8.0]);
    let material = breaking(BY_STRETCH);
    let constants = material
        .constants(&cloud, StressState::PlaneStrain)
        .unwrap();
    let body = CorrespondenceBody::new(&cloud, &constants, VolumeCorrection::None);
    let mut force = body.operator(BondForm::List).unwrap().operator;
    let dropped = |force: &dyn Force| force.capabilities().breaking.unwrap().dropped_points();
    assert_eq!(dropped(&*force), 0);
    let n = cloud.len();
    let corner = (0..n).find(|&i| cloud.point(i)[..2] == [0.5, 0.5]).unwrap();
    // Along −x, so that bonds along y stretch last.
    let mut u = vec![0.0; 2 * n];
    u[corner] = -0.3;
    let mut forces = vec![0.0; 2 * n];
    let step = StepEnd::sub_step(0.0, 1.0, &u);
    force.end_step(&step, PointSubset::All, &mut forces);
    let mut damage = vec![0.0; n];
    force.damage_into(&mut damage);
    assert!(force.broken_bonds() > 0);
    // The remaining bonds span the plane, or none remain.
    let left = (0..n).all(|i| damage[i] == 0.0 || damage[i] <= 1.0);
    assert!(left && forces.iter().all(|value| value.is_finite()));
    assert_eq!(damage[corner] == 1.0, dropped(&*force) > 0);
}

/// The end of a bar whose horizon is one spacing has a single bond.
#[test]
fn points_whose_bonds_do_not_span_the_space_are_errors() {
    let cloud = lattice(&[6.0]);
    let mut material = material(0.0, 1.0, ElasticLaw::NeoHooke, Stabilisation::Isotropic);
    material.solid.elastic.poisson_ratio = None;
    let constants = material.constants(&cloud, StressState::Uniaxial).unwrap();
    let body = CorrespondenceBody::new(&cloud, &constants, VolumeCorrection::None);
    let error = body.operator(BondForm::List).err().unwrap().to_string();
    assert!(
        error.contains("shape tensor of point 0") && error.contains("number of bonds 1"),
        "{error}"
    );
}

/// An inverted body stops the run with an error that contains step, time, point, position and advice.
#[test]
fn inverted_point_stops_the_run() {
    let cloud = lattice(&[8.0, 8.0]);
    let material = material(
        0.3,
        2.1,
        ElasticLaw::StVenantKirchhoff,
        Stabilisation::Isotropic,
    );
    let constants = material
        .constants(&cloud, StressState::PlaneStrain)
        .unwrap();
    let body = CorrespondenceBody::new(&cloud, &constants, VolumeCorrection::None);
    let operator = body.operator(BondForm::List).unwrap().operator;
    let system = System::new(cloud.clone(), operator, PointScalar::Uniform(1.0)).unwrap();
    let n = cloud.len();
    let mut start = State::at_rest(2 * n);
    for i in 0..n {
        start.v[i] = -8.0 * (cloud.point(i)[0] - 4.0);
    }
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), start, 0.02, 100).unwrap();
    let error = run.run(|_| Control::Continue).unwrap_err().to_string();
    for part in [
        "step ",
        "t = ",
        "determinant",
        "at point ",
        " m, speed",
        "neo-Hookean law",
    ] {
        assert!(error.contains(part), "{part}: {error}");
    }
}
