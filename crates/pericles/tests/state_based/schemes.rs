//! Linear peridynamic solids with schemes other than velocity Verlet.

use crate::bodies::{jittered, solid};
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{BondLimits, SolidSurface, Strains, StressState};
use pericles::operator::{BondForm, LinearSolidBody};
use pericles::space::PointCloud;
use pericles::time::{
    AdaptiveRungeKutta, DiscreteGradient, Fine, Implicit, ImplicitRule, Integrator, Interpolant,
    MultiTimeStep, MultiTimeStepOptions, Predictor, RungeKutta, State, Tableau, VelocityVerlet,
    highest_frequency,
};
use pericles::{Control, PointScalar, Simulation, System};

fn body(strains: Strains, surface: SolidSurface, limits: BondLimits) -> System {
    let cloud = jittered(&[14, 10]);
    let mut constants = solid(0.4, 2.5, InfluenceFunction::Conical)
        .constants(&cloud, StressState::PlaneStrain)
        .unwrap();
    constants.limits = limits;
    let body = LinearSolidBody {
        strains,
        surface,
        ..LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None)
    };
    let operator = body.operator(BondForm::Fastest).unwrap().operator;
    System::new(cloud, operator, PointScalar::Uniform(1.0)).unwrap()
}

fn thrown(cloud: &PointCloud, speed: f64) -> State {
    let n = cloud.len();
    let mut state = State::at_rest(2 * n);
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        state.v[i] = speed * (0.5 * y).sin();
        state.v[n + i] = speed * (0.4 * x).cos();
    }
    state
}

fn run(system: System, scheme: Box<dyn Integrator>, speed: f64, dt: f64, end: f64) -> Simulation {
    let state = thrown(system.cloud(), speed);
    let mut run = Simulation::new(system, scheme, state, dt, (end / dt).round() as u64).unwrap();
    run.run(|_| Control::Continue).unwrap();
    run
}

fn two_steps(system: &System) -> Box<dyn Integrator> {
    let left: Vec<u32> = (0..system.points() as u32)
        .filter(|&i| system.cloud().point(i as usize)[0] < 6.0)
        .collect();
    let options = MultiTimeStepOptions {
        ratio: 2,
        fine: Fine::Fixed(vec![left]),
        predictor: Predictor::Structured,
        interpolant: Interpolant::Hermite,
    };
    Box::new(MultiTimeStep::new(&Tableau::rk4(), options, system).unwrap())
}

type Make = fn(&System) -> Box<dyn Integrator>;

/// The bounds follow the orders of the schemes at these steps and were chosen after seeing the results.
#[test]
fn schemes_agree_with_small_steps_and_balance_energy() {
    let schemes: [(Make, f64, f64, f64); 5] = [
        (|_| Box::new(VelocityVerlet), 0.02, 2e-3, 1e-4),
        (
            |system| Box::new(RungeKutta::new(&Tableau::rk4(), system)),
            0.05,
            1e-4,
            1e-5,
        ),
        (two_steps, 0.05, 1e-4, 1e-5),
        (
            |system| Box::new(Implicit::new(ImplicitRule::Midpoint, system).unwrap()),
            0.02,
            2e-3,
            1e-4,
        ),
        (
            |system| Box::new(DiscreteGradient::new(1e-10, system).unwrap()),
            0.02,
            2e-3,
            1e-9,
        ),
    ];
    for surface in [SolidSurface::None, SolidSurface::Energy] {
        let system = || body(Strains::Finite, surface, BondLimits::NONE);
        let reference = Box::new(AdaptiveRungeKutta::new(1e-10, &system()).unwrap());
        let exact = run(system(), reference, 0.05, 0.5, 3.0);
        let size = exact
            .state()
            .u
            .iter()
            .fold(0.0_f64, |most, u| most.max(u.abs()));
        for (make, dt, error, loss) in schemes {
            let system = system();
            let scheme = make(&system);
            let name = scheme.name();
            let run = run(system, scheme, 0.05, dt, 3.0);
            let pairs = run.state().u.iter().zip(&exact.state().u);
            let found = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / size;
            assert!(found < error, "{name}: error {found:e}");
            let energies = run.snapshot().energies();
            let lost = energies.balance().abs() / energies.initial;
            assert!(lost < loss, "{name}: energy {lost:e}");
        }
    }
}

/// Bonds of fine points, of coarse points and between them break; momentum is conserved to the order of the scheme.
#[test]
fn bonds_break_under_a_multirate_scheme() {
    for limits in [
        BondLimits {
            stretch: 0.03,
            ..BondLimits::NONE
        },
        BondLimits {
            energy: 1e-3,
            ..BondLimits::NONE
        },
    ] {
        let make = |scheme: Make, dt: f64| {
            let system = body(Strains::Finite, SolidSurface::None, limits);
            let scheme = scheme(&system);
            run(system, scheme, 0.15, dt, 4.0)
        };
        let whole = make(
            |system| Box::new(RungeKutta::new(&Tableau::rk4(), system)),
            0.02,
        );
        let parts = make(two_steps, 0.04);
        let broken = [&whole, &parts].map(|run| run.system().operator().broken_bonds() as f64);
        assert!(broken[0] > 50.0, "{broken:?}");
        assert!((broken[1] / broken[0] - 1.0).abs() < 0.1, "{broken:?}");
        let energies = parts.snapshot().energies();
        let error = energies.balance().abs() / energies.dissipated;
        assert!(error < 0.02, "{limits:?}: {error:e}");
    }
}

/// Velocity Verlet conserves the energy of a linear solid exactly, with surface correction too: the factors are
/// part of the energy.
#[test]
fn velocity_verlet_conserves_the_energy_of_corrected_linear_solids() {
    let limits = BondLimits {
        stretch: 0.03,
        ..BondLimits::NONE
    };
    let system = body(Strains::Small, SolidSurface::Energy, limits);
    let rest = vec![0.0; 2 * system.points()];
    let dt = highest_frequency(&system, &rest)
        .unwrap()
        .stable_step(2.0, 0.5);
    let run = run(system, Box::new(VelocityVerlet), 0.15, dt, 4.0);
    assert!(run.system().operator().broken_bonds() > 50);
    let energies = run.snapshot().energies();
    let error = energies.balance().abs() / energies.dissipated;
    assert!(error < 1e-11, "{error:e}");
}
