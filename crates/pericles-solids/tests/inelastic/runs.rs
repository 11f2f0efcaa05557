//! Runs of inelastic bodies: energy balance, momentum, other schemes, resume, threads.

use std::sync::Arc;

use crate::bodies::{jittered, solid};
use crate::setup::{difference, plastic, viscous};
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{BondLimits, Strains, StressState};
use pericles::operator::{BondForm, LinearSolidBody};
use pericles::round_trip::check_resume;
use pericles::space::PointCloud;
use pericles::time::{
    Fine, Implicit, ImplicitRule, Integrator, Interpolant, MultiTimeStep, MultiTimeStepOptions,
    Predictor, RungeKutta, State, Tableau, VelocityVerlet,
};
use pericles::{Control, PointScalar, Simulation, System};
use pericles_solids::inelastic::{InelasticSolidBody, Inelasticity};

/// A plate whose parts move towards each other.
fn plate(
    law: &Inelasticity,
    function: InfluenceFunction,
    strains: Strains,
    limits: BondLimits,
    scheme: Make,
    speed: f64,
    dt: f64,
) -> Simulation {
    let cloud = jittered(&[14, 10]);
    plate_on(cloud, law, function, strains, limits, scheme, speed, dt)
}

#[allow(clippy::too_many_arguments)]
pub fn plate_on(
    cloud: Arc<PointCloud>,
    law: &Inelasticity,
    function: InfluenceFunction,
    strains: Strains,
    limits: BondLimits,
    scheme: Make,
    speed: f64,
    dt: f64,
) -> Simulation {
    let mut constants = solid(0.4, 2.5, function)
        .constants(&cloud, StressState::PlaneStrain)
        .unwrap();
    constants.limits = limits;
    let laws = [law.clone()];
    let body = InelasticSolidBody {
        elastic: LinearSolidBody {
            strains,
            ..LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None)
        },
        laws: &laws,
    };
    let operator = body.operator(BondForm::Fastest).unwrap().operator;
    let system = System::new(cloud.clone(), operator, PointScalar::Uniform(1.0)).unwrap();
    let n = cloud.len();
    let mut start = State::at_rest(2 * n);
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        start.v[i] = speed * (0.5 * y).sin();
        start.v[n + i] = speed * (0.4 * x).cos();
    }
    let scheme = scheme(&system);
    Simulation::new(system, scheme, start, dt, (4.0 / dt).round() as u64).unwrap()
}

pub type Make = fn(&System) -> Box<dyn Integrator>;

pub fn verlet(_: &System) -> Box<dyn Integrator> {
    Box::new(VelocityVerlet)
}

pub fn laws() -> [Inelasticity; 3] {
    [
        viscous(&[[0.4, 0.3], [0.2, 2.0]]),
        plastic(0.1, 0.0),
        plastic(0.1, 2.0),
    ]
}

pub const BREAKING: BondLimits = BondLimits {
    stretch: 0.03,
    ..BondLimits::NONE
};

const BOTH: [BondLimits; 2] = [BondLimits::NONE, BREAKING];

/// A step dissipates the mean driving force times the change of inelastic stretches: the balance closes to rounding
/// for forces linear in displacements and inelastic stretches.
#[test]
fn energy_balance_with_small_strains_closes_to_round_off() {
    for function in [InfluenceFunction::Constant, InfluenceFunction::Conical] {
        for (law, limits) in laws()
            .iter()
            .flat_map(|law| BOTH.map(|limits| (law, limits)))
        {
            let make = function.clone();
            let mut run = plate(law, make, Strains::Small, limits, verlet, 0.15, 0.05);
            run.run(|_| Control::Continue).unwrap();
            let energies = run.snapshot().energies();
            assert!(energies.dissipated > 0.05 * energies.initial, "{law:?}");
            let broken = run.system().operator().broken_bonds();
            assert_eq!(broken > 50, limits.can_break(), "{broken}");
            let error = energies.balance().abs() / energies.dissipated;
            assert!(error < 1e-11, "{law:?}, {function:?}: {error:e}");
        }
    }
}

/// Slow motion keeps the nonlinearity of finite strains, the only error of the balance, small; bounds chosen before
/// the first run.
#[test]
fn energy_balance_with_finite_strains_converges_with_second_order() {
    let slow = [
        viscous(&[[0.4, 0.3], [0.2, 2.0]]),
        plastic(0.01, 0.0),
        plastic(0.01, 2.0),
    ];
    for law in slow {
        let errors = [0.08, 0.04, 0.02].map(|dt| {
            let mut run = plate(
                &law,
                InfluenceFunction::Constant,
                Strains::Finite,
                BondLimits::NONE,
                verlet,
                0.005,
                dt,
            );
            run.run(|_| Control::Continue).unwrap();
            let energies = run.snapshot().energies();
            assert!(energies.dissipated > 0.02 * energies.initial, "{law:?}");
            energies.balance().abs() / energies.initial
        });
        println!("{law:?}: {errors:?}");
        assert!(errors[2] < 1e-6, "{law:?}: {errors:?}");
        let order = (errors[0] / errors[2]).log2() / 2.0;
        assert!(order > 1.6, "{law:?}: {errors:?}");
    }
}

#[test]
fn momentum_and_angular_momentum_are_conserved() {
    for law in laws() {
        let mut run = plate(
            &law,
            InfluenceFunction::Constant,
            Strains::Finite,
            BREAKING,
            verlet,
            0.15,
            0.05,
        );
        let momenta = |run: &Simulation| {
            let (system, state) = (run.system(), run.state());
            let (cloud, n) = (system.cloud(), system.points());
            let mut sums = [0.0; 3];
            for i in 0..n {
                let [x, y, _] = cloud.point(i);
                let (mass, v) = (cloud.volumes()[i], [state.v[i], state.v[n + i]]);
                let place = [x + state.u[i], y + state.u[n + i]];
                sums[0] += mass * v[0];
                sums[1] += mass * v[1];
                sums[2] += mass * (place[0] * v[1] - place[1] * v[0]);
            }
            sums
        };
        let start = momenta(&run);
        run.run(|_| Control::Continue).unwrap();
        assert!(run.system().operator().broken_bonds() > 50);
        for (before, after) in start.iter().zip(momenta(&run)) {
            // 140 points with 0.15 m/s up to 14 m from the axis.
            assert!((before - after).abs() < 1e-12 * 140.0, "{law:?}");
        }
    }
}

#[test]
fn runs_resume_and_are_bitwise_identical_for_any_number_of_threads() {
    for law in laws() {
        let make = || {
            plate(
                &law,
                InfluenceFunction::Constant,
                Strains::Finite,
                BREAKING,
                verlet,
                0.15,
                0.05,
            )
        };
        let middle = make().steps() / 2;
        let end = check_resume(make, [middle]).unwrap_or_else(|e| panic!("{law:?}: {e}"));
        for threads in [1, 2, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let stored = pool.unwrap().install(|| {
                let mut run = make();
                run.run(|_| Control::Continue).unwrap();
                let mut archive = pericles::Archive::default();
                pericles::Checkpointed::save(&run, &mut archive);
                archive
            });
            assert_eq!(end.differences(&stored), Vec::<String>::new(), "{threads}");
        }
    }
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

/// Within a step schemes use the viscosity and plasticity of the step. The bounds are for these steps and were
/// chosen after seeing the results.
#[test]
fn schemes_agree_with_small_steps() {
    let schemes: [(Make, f64); 4] = [
        (verlet, 0.02),
        (
            |system| Box::new(RungeKutta::new(&Tableau::rk4(), system)),
            0.05,
        ),
        (two_steps, 0.05),
        (
            |system| Box::new(Implicit::new(ImplicitRule::Midpoint, system).unwrap()),
            0.02,
        ),
    ];
    for law in laws() {
        let run = |scheme, dt| {
            let mut run = plate(
                &law,
                InfluenceFunction::Constant,
                Strains::Finite,
                BondLimits::NONE,
                scheme,
                0.05,
                dt,
            );
            run.run(|_| Control::Continue).unwrap();
            let energies = run.snapshot().energies();
            let lost = energies.balance().abs() / energies.initial;
            (run.state().u.clone(), lost)
        };
        let (exact, _) = run(verlet, 0.0025);
        for (k, (scheme, dt)) in schemes.into_iter().enumerate() {
            let (u, lost) = run(scheme, dt);
            let error = difference(&u, &exact);
            println!("{law:?}, scheme {k}: error {error:e}, energy {lost:e}");
            assert!(error < 5e-3, "{law:?}, scheme {k}: {error:e}");
            assert!(lost < 1e-3, "{law:?}, scheme {k}: {lost:e}");
        }
    }
}
