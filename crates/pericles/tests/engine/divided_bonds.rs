//! Results of bond-based and state-based bodies divided among several processes, with and without periodic
//! faces, are bitwise identical to those of a single process.

use std::sync::Arc;

use crate::common::{listed, material, points};

use pericles::division::{Cuts, part_by_bisection, part_of};
use pericles::domain::{Comm, Threads};
use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, BondMaterial, BondStretch, Fracture, GivenConstants, GreenBond, InterfaceRule,
    LinearBond, LinearSolid, LinearSolidConstants, MaterialPairs, PairLaw, SolidSurface,
    StateInfluence, StressState, SurfaceCorrection,
};
use pericles::operator::{
    BondBody, BondForm, CompositeBody, DamageMeasure, Force, GridForce, LinearSolidBody, VectorLaw,
};
use pericles::space::{Grid, PointCloud, Region, Shape};
use pericles::time::{
    AdaptiveRungeKutta, Implicit, ImplicitRule, Integrator, RungeKutta, State, Tableau,
    VelocityVerlet,
};
use pericles::{Control, PointScalar, Simulation, System};

/// Largest distance of neighbours: bonds of three cells, and half a cell of their partial volumes.
pub(super) const REACH: f64 = 3.5;
const SIZE: [f64; 2] = [21.0, 13.0];
pub(super) const STATE: StressState = StressState::PlaneStress;

pub(super) fn plate(periodic: bool) -> PointCloud {
    let hole = Region::Ball {
        centre: [13.0, 7.0, 0.0],
        radius: 1.6,
    };
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: SIZE.to_vec(),
        },
        spacing: 1.0,
        section: 1.0,
        holes: if periodic { vec![] } else { vec![hole] },
    };
    let cloud = grid.points().unwrap();
    if periodic {
        cloud.with_periodic_faces().unwrap()
    } else {
        cloud
    }
}

/// Owner of each point: oblique stripes, so that no part is a range of numbers or a box.
fn owner(cloud: &PointCloud, size: usize, k: usize) -> usize {
    let [x, y, _] = cloud.point(k);
    (((x + 0.4 * y) / 27.0 * size as f64) as usize).min(size - 1)
}

/// The part of the plate owned by a process, with ghosts up to three and a half cells away.
pub(super) fn part(cloud: &PointCloud, comm: Arc<dyn Comm>) -> PointCloud {
    let owners: Vec<u32> = (0..cloud.len())
        .map(|k| owner(cloud, comm.size(), k) as u32)
        .collect();
    part_of(cloud, &owners, REACH, comm).unwrap()
}

/// The part that recursive coordinate bisection gives to a process.
fn bisected(cloud: &PointCloud, cuts: Cuts, comm: Arc<dyn Comm>) -> PointCloud {
    part_by_bisection(cloud, REACH, cuts, comm).unwrap()
}

pub(super) fn glass(law: PairLaw) -> BondMaterial {
    BondMaterial {
        law,
        ..material(
            1.0,
            1.0,
            3.0,
            VolumeCorrection::Extended,
            Fracture::CriticalStretch(0.02),
        )
    }
}

pub(super) fn notch() -> Crack {
    Crack::Segment {
        from: [0.0, 6.0],
        to: [6.0, 6.0],
    }
}

fn held(cloud: &PointCloud) -> Vec<u32> {
    points(cloud, |x, y, _| x > 16.0 && y > 9.0)
}

pub(super) type Make = fn(&Arc<PointCloud>) -> Box<dyn Force>;

pub(super) fn list<L: VectorLaw>(law: PairLaw, cloud: &Arc<PointCloud>) -> Box<dyn Force> {
    let force = listed::<L, 2>(cloud, &glass(law), STATE, Some(notch()), &held(cloud));
    Box::new(force)
}

pub(super) fn grid<L: VectorLaw>(law: PairLaw, cloud: &Arc<PointCloud>) -> Box<dyn Force> {
    let glass = glass(law);
    let constants = glass.constants(cloud, STATE).unwrap();
    let cracks = [(notch(), EndRule::Closed)];
    let held = held(cloud);
    let damage = DamageMeasure::default();
    let force =
        GridForce::<L, 2>::new(cloud.clone(), &glass, &constants, &cracks, &held, damage).unwrap();
    Box::new(force)
}

/// Two materials, an inclusion and corrected surfaces.
pub(super) fn composite(cloud: &Arc<PointCloud>, form: BondForm) -> Box<dyn Force> {
    let glass = glass(PairLaw::BondStretch);
    let constants = glass.constants(cloud, STATE).unwrap();
    let softer = BondMaterial {
        fracture: Fracture::CriticalStretch(0.015),
        ..material(
            1.0,
            0.5,
            3.0,
            VolumeCorrection::Extended,
            Fracture::Unbreakable,
        )
    };
    let softer = softer.constants(cloud, STATE).unwrap();
    let number = |i: usize| u8::from(cloud.point(i)[0] > 10.0);
    let numbers = (0..cloud.len()).map(number).collect();
    let both = [constants.clone(), softer];
    let classes = MaterialPairs::new(numbers, &both, InterfaceRule::Harmonic).unwrap();
    let share = |i: usize| if cloud.point(i)[1] < 3.0 { 1.5 } else { 1.0 };
    let stiffness: Vec<f64> = (0..cloud.len()).map(share).collect();
    let cracks = [(notch(), EndRule::Closed)];
    let body = BondBody {
        cracks: &cracks,
        stiffness: &stiffness,
        ..BondBody::new(cloud, &glass, &constants)
    };
    let body = CompositeBody {
        classes: Some(&classes),
        correction: SurfaceCorrection::Energy,
        ..CompositeBody::from(body)
    };
    body.operator(form).unwrap().operator
}

/// Two state-based materials in a given form; with corrected surfaces for a neighbour list.
pub(super) fn solid(cloud: &Arc<PointCloud>, form: BondForm) -> Box<dyn Force> {
    let material = |young: f64, poisson_ratio: f64| LinearSolid {
        density: 1.0,
        elastic: GivenConstants {
            young: Some(young),
            poisson_ratio: Some(poisson_ratio),
            ..GivenConstants::default()
        },
        horizon: 3.0,
        influence: StateInfluence::Function(InfluenceFunction::Conical),
        volume_correction: VolumeCorrection::Extended,
        failure: BondFailure::CriticalStretch(0.02),
    };
    let constants = |material: LinearSolid| material.constants(cloud, STATE).unwrap();
    let materials = [constants(material(1.0, 0.2)), constants(material(0.6, 0.4))];
    let number = |i: usize| u8::from(cloud.point(i)[0] > 10.0);
    let classes =
        LinearSolidConstants::several((0..cloud.len()).map(number).collect(), &materials).unwrap();
    let (held, cracks) = (held(cloud), [(notch(), EndRule::Closed)]);
    let body = LinearSolidBody {
        classes: Some(&classes),
        surface: match form {
            BondForm::List => SolidSurface::Energy,
            _ => SolidSurface::None,
        },
        cracks: &cracks,
        no_fail: &held,
        ..LinearSolidBody::new(cloud, &materials[0], VolumeCorrection::Extended)
    };
    body.operator(form).unwrap().operator
}

type MakeScheme = fn(&System) -> Box<dyn Integrator>;

/// Final state of a run: displacements, velocities and damage by point number; energies, momentum, dissipated
/// energy and number of broken bonds.
type End = (Vec<[u64; 5]>, [u64; 5]);

fn run(cloud: PointCloud, make: Make, scheme: MakeScheme) -> End {
    let cloud = Arc::new(cloud);
    let n = cloud.len();
    let system = System::new(cloud.clone(), make(&cloud), PointScalar::Uniform(1.0)).unwrap();
    let mut state = State::at_rest(2 * n);
    for i in 0..n {
        let number = cloud.domain().number(i) as f64;
        state.v[i] = 0.02 * (number * number).sin();
        state.v[n + i] = 0.06 * (cloud.point(i)[1] - 6.0).signum() + 0.01 * (3.0 * number).cos();
    }
    let scheme = scheme(&system);
    let mut run = Simulation::new(system, scheme, state, 0.2, 40).unwrap();
    run.run(|_| Control::Continue).unwrap();
    let (system, state) = (run.system(), run.state());
    let operator = system.operator();
    let sums = [
        system.kinetic_energy(&state.v),
        operator.energy(state.t, &state.u),
        system.momentum(&state.v)[0],
        operator.dissipated(),
        operator.broken_bonds() as f64,
    ];
    let mut damage = vec![0.0; n];
    operator.damage_into(&mut damage);
    let of = |i: usize| {
        let values = [
            state.u[i],
            state.u[n + i],
            state.v[i],
            state.v[n + i],
            damage[i],
        ];
        values.map(f64::to_bits)
    };
    ((0..n).map(of).collect(), sums.map(f64::to_bits))
}

fn divided(whole: &PointCloud, size: usize, make: Make, scheme: MakeScheme) -> End {
    divided_by(whole, size, (make, scheme), part)
}

fn divided_by(
    whole: &PointCloud,
    size: usize,
    (make, scheme): (Make, MakeScheme),
    part: impl Fn(&PointCloud, Arc<dyn Comm>) -> PointCloud + Sync,
) -> End {
    let parts = Threads::run(size, |comm| {
        let cloud = part(whole, comm);
        let numbers: Vec<usize> = (0..cloud.len()).map(|i| cloud.domain().number(i)).collect();
        (numbers, run(cloud, make, scheme))
    });
    let mut values = vec![[0; 5]; whole.len()];
    for (numbers, (own, sums)) in &parts {
        assert_eq!(sums, &parts[0].1.1, "all processes have the same sums");
        for (&k, own) in numbers.iter().zip(own) {
            values[k] = *own;
        }
    }
    (values, parts[0].1.1)
}

const VERLET: MakeScheme = |_| Box::new(VelocityVerlet);

#[test]
fn results_of_a_divided_body_of_bonds_are_bitwise_identical() {
    let forces: [(&str, Make); 8] = [
        ("list", |cloud| {
            list::<BondStretch>(PairLaw::BondStretch, cloud)
        }),
        ("list, Green strain", |cloud| {
            list::<GreenBond>(PairLaw::GreenStrain, cloud)
        }),
        ("list of several materials", |cloud| {
            composite(cloud, BondForm::List)
        }),
        ("stencil of several materials", |cloud| {
            composite(cloud, BondForm::Grid)
        }),
        ("state-based list", |cloud| solid(cloud, BondForm::List)),
        ("state-based stencil", |cloud| solid(cloud, BondForm::Grid)),
        ("stencil", |cloud| {
            grid::<BondStretch>(PairLaw::BondStretch, cloud)
        }),
        ("linear stencil", |cloud| {
            grid::<LinearBond>(PairLaw::Linear, cloud)
        }),
    ];
    for periodic in [false, true] {
        let whole = plate(periodic);
        for (name, make) in forces {
            let alone = run(whole.clone(), make, VERLET);
            let broken = f64::from_bits(alone.1[4]);
            assert!(broken > 50.0, "{name}: {broken} bonds broken");
            for size in [1, 2, 3, 5] {
                let found = divided(&whole, size, make, VERLET);
                let differ = |k: &usize| found.0[*k] != alone.0[*k];
                let points: Vec<usize> = (0..whole.len()).filter(differ).collect();
                let case = format!("{name}, {size} processes, periodic: {periodic}");
                let both = |&k: &usize| [found.0[k], alone.0[k]].map(|of| of.map(f64::from_bits));
                let values: Vec<_> = points.iter().map(both).collect();
                assert!(points.is_empty(), "{case}: points {points:?}: {values:?}");
                assert_eq!(found.1, alone.1, "{case}");
            }
        }
    }
}

#[test]
fn results_of_bisected_bodies_are_bitwise_identical() {
    let forces: [Make; 2] = [
        |cloud| list::<BondStretch>(PairLaw::BondStretch, cloud),
        |cloud| solid(cloud, BondForm::Grid),
    ];
    for periodic in [false, true] {
        let whole = plate(periodic);
        for make in forces {
            let alone = run(whole.clone(), make, VERLET);
            for (cuts, size) in [(Cuts::Anywhere, 4), (Cuts::Planes, 3), (Cuts::Planes, 8)] {
                let part = |cloud: &_, comm| bisected(cloud, cuts, comm);
                let found = divided_by(&whole, size, (make, VERLET), part);
                assert!(
                    found == alone,
                    "{cuts:?}, {size} processes, periodic: {periodic}"
                );
            }
        }
    }
}

#[test]
fn results_of_single_rate_schemes_are_bitwise_identical_on_divided_bodies() {
    let schemes: [(&str, MakeScheme); 3] = [
        ("Runge–Kutta", |system| {
            Box::new(RungeKutta::new(&Tableau::rk4(), system))
        }),
        ("Dormand–Prince", |system| {
            Box::new(AdaptiveRungeKutta::new(1e-7, system).unwrap())
        }),
        ("implicit midpoint", |system| {
            Box::new(Implicit::new(ImplicitRule::Midpoint, system).unwrap())
        }),
    ];
    let whole = plate(false);
    let make: Make = |cloud| {
        let mut linear = glass(PairLaw::Linear);
        linear.fracture = Fracture::Unbreakable;
        Box::new(listed::<LinearBond, 2>(
            cloud,
            &linear,
            STATE,
            Some(notch()),
            &[],
        ))
    };
    for (name, scheme) in schemes {
        let alone = run(whole.clone(), make, scheme);
        for size in [2, 3] {
            let equal = divided(&whole, size, make, scheme) == alone;
            assert!(equal, "{name}, {size} processes");
        }
    }
}

/// The time step follows from the bound and the estimate of the highest frequency.
#[test]
fn the_highest_frequency_does_not_depend_on_the_division() {
    use pericles::time::highest_frequency;
    let whole = plate(false);
    let of = |cloud: PointCloud, make: Make| {
        let cloud = Arc::new(cloud);
        let system = System::new(cloud.clone(), make(&cloud), PointScalar::Uniform(1.0)).unwrap();
        let u = vec![0.0; 2 * cloud.len()];
        let found = highest_frequency(&system, &u).unwrap();
        [found.estimate, found.bound].map(f64::to_bits)
    };
    let forces: [Make; 2] = [
        |cloud| list::<BondStretch>(PairLaw::BondStretch, cloud),
        |cloud| grid::<BondStretch>(PairLaw::BondStretch, cloud),
    ];
    for make in forces {
        let alone = of(whole.clone(), make);
        for found in Threads::run(3, |comm| of(part(&whole, comm), make)) {
            assert_eq!(found, alone);
        }
    }
}

/// Above [`SMALL`](pericles::time::frequency::SMALL) unknowns the bound follows from the plane waves of the stiffest and lightest
/// lattice: some processes may have softer and heavier points only, and fewer unknowns.
#[test]
fn the_highest_frequency_of_a_large_body_does_not_depend_on_the_division() {
    use pericles::time::highest_frequency;
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: vec![110.0, 60.0],
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![],
    };
    let whole = grid.points().unwrap();
    let of = |cloud: PointCloud, make: Make| {
        let cloud = Arc::new(cloud);
        let density = (0..cloud.len()).map(|i| 1.0 + cloud.axis(0)[i]).collect();
        let density = PointScalar::PerPoint(density);
        let system = System::new(cloud.clone(), make(&cloud), density).unwrap();
        let u = vec![0.0; 2 * cloud.len()];
        let found = highest_frequency(&system, &u).unwrap();
        [found.estimate, found.bound].map(f64::to_bits)
    };
    let forces: [Make; 3] = [
        |cloud| list::<BondStretch>(PairLaw::BondStretch, cloud),
        |cloud| self::grid::<BondStretch>(PairLaw::BondStretch, cloud),
        |cloud| composite(cloud, BondForm::Grid),
    ];
    for make in forces {
        let alone = of(whole.clone(), make);
        for size in [2, 3] {
            let of_part = |comm| of(bisected(&whole, Cuts::Planes, comm), make);
            for found in Threads::run(size, of_part) {
                assert_eq!(found, alone, "{size} processes");
            }
        }
    }
}
