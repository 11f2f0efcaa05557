//! Bar of the paper, and absorbing boundaries for it.

use std::f64::consts::PI;
use std::sync::Arc;

use pericles::family::{BondList, VolumeCorrection};
use pericles::material::LinearBond;
use pericles::operator::{BondForce, Breaking, DamageMeasure};
use pericles::space::{Grid, Shape};
use pericles::time::{State, VelocityVerlet};
use pericles::{Control, PointScalar, Simulation, System};
use pericles_waves::absorbing::history::{BlockedHistory, History};
use pericles_waves::absorbing::{
    AbsorbingEnd, GhostKernels, LatticeStep, OuterLayer, Side, contour_kernels,
};

pub(crate) const DX: f64 = 0.1;

/// The Gaussian micromodulus of the paper, E = ρ = 1, δ = 0.25, cut after 7 nodes.
pub(crate) fn gaussian(xi: f64) -> f64 {
    const DELTA: f64 = 0.25;
    4.0 / (DELTA.powi(3) * PI.sqrt()) * (-(xi / DELTA).powi(2)).exp()
}

pub(crate) const REACH: usize = 7;

pub(crate) fn weights() -> Vec<f64> {
    (1..=REACH).map(|k| gaussian(k as f64 * DX) * DX).collect()
}

/// Bar of nodes −half … half, x = 0 in the middle, whose inner part |x| < 4 is softer by β.
pub(crate) fn bar(half: usize, beta: f64) -> System {
    bar_with(half, beta, f64::INFINITY)
}

/// Homogeneous bar whose bonds with both ends beyond |x| = 2 never break.
pub(crate) fn breaking_bar(half: usize) -> System {
    bar_with(half, 1.0, 0.6)
}

fn bar_with(half: usize, beta: f64, critical_stretch: f64) -> System {
    let nodes = 2 * half + 1;
    let cloud = Grid {
        shape: Shape::Box {
            origin: [-(half as f64 + 0.5) * DX, 0.0, 0.0],
            size: vec![nodes as f64 * DX],
        },
        spacing: DX,
        section: 1.0,
        holes: vec![],
    };
    let cloud = Arc::new(cloud.points().unwrap());
    let bonds = BondList::new(&cloud, (REACH as f64 + 0.5) * DX, VolumeCorrection::None).unwrap();
    let x = cloud.axis(0).to_vec();
    let hard = |i: usize| x[i].abs() > 4.0 - 1e-9;
    let lasting = |i: &u32| x[*i as usize].abs() > 2.0;
    let no_fail: Vec<u32> = (0..nodes as u32).filter(lasting).collect();
    let breaking = Breaking {
        critical_stretch,
        no_fail: &no_fail,
    };
    let force = BondForce::<LinearBond, 1>::with_pair_stiffness(
        cloud.clone(),
        bonds,
        &|i, j, xi| {
            let share = if hard(i) && hard(j) { 1.0 } else { beta };
            share * gaussian(xi[0].abs()) * xi[0].abs()
        },
        breaking,
        DamageMeasure::default(),
    )
    .unwrap();
    System::new(cloud, Box::new(force), PointScalar::Uniform(1.0)).unwrap()
}

pub(crate) fn pulse(system: &System, centre: f64) -> State {
    let mut state = State::at_rest(system.points());
    for (u, x) in state.u.iter_mut().zip(system.cloud().axis(0)) {
        *u = (-(x - centre).powi(2)).exp();
    }
    state
}

pub(crate) fn blocked(kernels: GhostKernels) -> Box<dyn History> {
    Box::new(BlockedHistory::new(kernels))
}

pub(crate) fn add_ends(
    system: &mut System,
    state: &State,
    sides: &[Side],
    dt: f64,
    steps: u64,
    history: fn(GhostKernels) -> Box<dyn History>,
) {
    for &side in sides {
        let layer = OuterLayer::of(system, side, state, &[]).unwrap();
        let h = contour_kernels(&layer.stencil, LatticeStep::verlet(dt), steps as usize);
        let end = AbsorbingEnd::new(layer, history(GhostKernels::shift(h)), dt).unwrap();
        system.add_boundary(Box::new(end));
    }
}

pub(crate) const BOTH: [Side; 2] = [Side::Left, Side::Right];

pub(crate) fn run(system: System, state: State, dt: f64, steps: u64) -> Simulation {
    let mut simulation =
        Simulation::new(system, Box::new(VelocityVerlet), state, dt, steps).unwrap();
    simulation.run(|_| Control::Continue).unwrap();
    simulation
}

/// Largest difference of displacement and velocity between the middle of a large body and a truncated one.
pub(crate) fn difference(large: &State, small: &State) -> f64 {
    let margin = (large.u.len() - small.u.len()) / 2;
    let fields = [(&large.u, &small.u), (&large.v, &small.v)];
    fields
        .iter()
        .flat_map(|(a, b)| a[margin..].iter().zip(*b))
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}
