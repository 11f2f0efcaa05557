//! Multirate schemes on divided bodies: states, checkpoints and counts equal those of a single process.

use std::sync::Arc;

use crate::common::points;
use crate::divided_bonds::{Make, composite, grid, list, part, plate, solid};
use crate::divided_checkpoints::{
    Case, MakeScheme, Part, STEPS, check, proceed, solid_of_energy, stripes,
};

use pericles::domain::{Comm, Threads};
use pericles::material::{BondStretch, PairLaw};
use pericles::operator::BondForm;
use pericles::space::PointCloud;
use pericles::time::{
    Fine, Follow, Integrator, MultiTimeStep, MultiTimeStepOptions, RefinementReport, Respa,
    Tableau, highest_frequency,
};
use pericles::{PericlesError, PointScalar, System};

/// The left third of the plate, of which the last of three processes has no point.
fn left(system: &System) -> Fine {
    Fine::Fixed(vec![points(system.cloud(), |x, _, _| x < 7.0)])
}

/// Points near bonds that are about to break: at first near the notch.
fn near_cracks(_: &System) -> Fine {
    Fine::Adaptive(Follow {
        every: 2,
        layers: 1,
        ..Follow::default()
    })
}

fn multirate(tableau: &Tableau, fine: Fine, system: &System) -> Box<dyn Integrator> {
    let options = MultiTimeStepOptions {
        ratio: 3,
        fine,
        predictor: Default::default(),
        interpolant: Default::default(),
    };
    Box::new(MultiTimeStep::new(tableau, options, system).unwrap())
}

const FIXED: MakeScheme = |system| multirate(&Tableau::rk4(), left(system), system);
const FOLLOWING: MakeScheme =
    |system| multirate(&Tableau::rk3(0.6).unwrap(), near_cracks(system), system);
const RESPA: MakeScheme = |system| Box::new(Respa::new(2, left(system), system).unwrap());
const FOLLOWING_RESPA: MakeScheme =
    |system| Box::new(Respa::new(2, near_cracks(system), system).unwrap());

const LIST: Make = |cloud| list::<BondStretch>(PairLaw::BondStretch, cloud);
const GRID: Make = |cloud| grid::<BondStretch>(PairLaw::BondStretch, cloud);
const SOLID_LIST: Make = |cloud| solid(cloud, BondForm::List);
const SOLID_GRID: Make = |cloud| solid(cloud, BondForm::Grid);

fn case(name: &'static str, force: Make, scheme: MakeScheme) -> Case {
    Case {
        scheme,
        ..Case::breaking(name, force)
    }
}

fn bonds() -> Vec<Case> {
    let composite_list: Make = |cloud| composite(cloud, BondForm::List);
    let composite_grid: Make = |cloud| composite(cloud, BondForm::Grid);
    vec![
        case("multirate, list", LIST, FIXED),
        case("multirate, stencil", GRID, FIXED),
        case("multirate, adaptive, list", LIST, FOLLOWING),
        case("multirate, adaptive, stencil", GRID, FOLLOWING),
        case("respa, list", LIST, RESPA),
        case("respa, stencil", GRID, RESPA),
        case("respa, adaptive, list", LIST, FOLLOWING_RESPA),
        case("respa, adaptive, stencil", GRID, FOLLOWING_RESPA),
        Case {
            periodic: true,
            ..case("respa, adaptive, periodic list", LIST, FOLLOWING_RESPA)
        },
        Case {
            periodic: true,
            ..case("multirate, adaptive, periodic stencil", GRID, FOLLOWING)
        },
        case("several materials, list", composite_list, FOLLOWING_RESPA),
        case("several materials, stencil", composite_grid, FOLLOWING),
    ]
}

fn solids() -> Vec<Case> {
    vec![
        case("state-based, multirate, list", SOLID_LIST, FIXED),
        case("state-based, multirate, stencil", SOLID_GRID, FIXED),
        case("state-based, adaptive, list", SOLID_LIST, FOLLOWING),
        case("state-based, adaptive, stencil", SOLID_GRID, FOLLOWING),
        case("bond energies, adaptive", solid_of_energy, FOLLOWING),
    ]
}

#[test]
fn multirate_checkpoints_of_bonds_do_not_depend_on_the_division() {
    check(&bonds());
}

#[test]
fn multirate_checkpoints_of_state_based_solids_do_not_depend_on_the_division() {
    check(&solids());
}

/// Returns the report at the end of a run.
fn report(case: &Case, cloud: PointCloud) -> RefinementReport {
    let mut run = case.simulation(cloud);
    proceed(&mut run, STEPS);
    run.integrator().refinement().unwrap()
}

#[test]
fn counts_of_divided_zones_are_those_of_the_whole_body() {
    for case in bonds().iter().chain(&solids()) {
        let whole = plate(case.periodic);
        let alone = report(case, whole.clone());
        assert_eq!(alone.points, whole.len() as u64);
        assert!(
            alone.mean_fraction > 0.0 && alone.mean_fraction < 1.0,
            "{}",
            case.name
        );
        for (size, part) in [(2, part as Part), (3, part), (4, stripes)] {
            for found in Threads::run(size, |comm| report(case, part(&whole, comm))) {
                assert_eq!(found, alone, "{}, {size} processes", case.name);
            }
        }
    }
}

/// Frequencies, and errors of fine regions, are the same on all processes.
#[test]
fn limits_and_errors_of_divided_zones_are_those_of_the_whole_body() {
    type Found = (Vec<[u64; 2]>, Vec<String>);
    let of = |cloud: PointCloud| -> Found {
        let cloud = Arc::new(cloud);
        let frequency = |make: Make| {
            let system = System::new(cloud.clone(), make(&cloud), PointScalar::Uniform(1.0));
            let system = system.unwrap();
            let u = vec![0.0; 2 * cloud.len()];
            let body = highest_frequency(&system, &u).unwrap();
            let limit = FIXED(&system)
                .limiting_frequency(&system, &u, body)
                .unwrap();
            [limit.estimate, limit.bound].map(f64::to_bits)
        };
        let system = System::new(cloud.clone(), LIST(&cloud), PointScalar::Uniform(1.0)).unwrap();
        let within = |from: f64, to: f64| points(&cloud, |x, _, _| x > from && x < to);
        let rejected = |regions: Vec<Vec<u32>>| -> PericlesError {
            match Respa::new(2, Fine::Fixed(regions), &system) {
                Ok(_) => panic!("invalid regions were accepted"),
                Err(error) => error,
            }
        };
        let errors = [
            rejected(vec![within(0.0, 7.0), vec![]]),
            rejected(vec![within(0.0, 7.0), within(6.0, 12.0)]),
            rejected(vec![within(9.0, 10.0)]),
        ];
        let errors = errors.iter().map(ToString::to_string).collect();
        (vec![frequency(LIST), frequency(SOLID_GRID)], errors)
    };
    let whole = plate(false);
    let alone = of(whole.clone());
    type Divide = fn(&PointCloud, Arc<dyn Comm>) -> PointCloud;
    for (size, part) in [(3, part as Divide), (4, stripes)] {
        for found in Threads::run(size, |comm| of(part(&whole, comm))) {
            assert_eq!(found, alone);
        }
    }
}
