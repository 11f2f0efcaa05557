//! Results of a body divided among several processes (threads that exchange messages) are bitwise identical
//! to those of a single process.

use std::sync::Arc;

use crate::state_based::{Dilatational, Wall};
use pericles::domain::{Comm, Domain, Peer, Threads};
use pericles::operator::TwoPassForce;
use pericles::space::PointCloud;
use pericles::time::{
    AdaptiveRungeKutta, Implicit, ImplicitRule, InnerSolver, Integrator, Newmark, NewmarkOptions,
    State, VelocityVerlet,
};
use pericles::{Control, PointScalar, Simulation, System};

const HORIZON: f64 = 2.1;
const SIDES: [usize; 2] = [9, 7];

/// The nodes of the body with their numbers.
fn nodes() -> Vec<[f64; 2]> {
    let node = |k: usize| {
        [
            (k % SIDES[0]) as f64,
            0.4 + (k / SIDES[0]) as f64 + 0.05 * (k as f64).sin(),
        ]
    };
    (0..SIDES[0] * SIDES[1]).map(node).collect()
}

/// Owner of each node: stripes of unequal width that cut rows, so that no part is a range of numbers.
fn owners(size: usize) -> Vec<usize> {
    nodes()
        .iter()
        .map(|[x, y]| ((x + 0.3 * y) as usize * size / (SIDES[0] + 2)).min(size - 1))
        .collect()
}

/// The part of the body owned by a process, and the numbers of its points.
fn part(comm: Arc<dyn Comm>) -> (System, Vec<usize>) {
    let (nodes, owners) = (nodes(), owners(comm.size()));
    let near = |a: usize, b: usize| {
        let [[x, y], [z, w]] = [nodes[a], nodes[b]];
        (z - x).powi(2) + (w - y).powi(2) <= HORIZON * HORIZON
    };
    let of =
        |rank: usize| -> Vec<usize> { (0..nodes.len()).filter(|&k| owners[k] == rank).collect() };
    let own = of(comm.rank());
    let mut numbers = own.clone();
    let mut peers = Vec::new();
    for rank in (0..comm.size()).filter(|&rank| rank != comm.rank()) {
        let theirs = of(rank);
        let seen = |from: &[usize], by: &[usize]| -> Vec<usize> {
            from.iter()
                .copied()
                .filter(|&a| by.iter().any(|&b| near(a, b)))
                .collect()
        };
        let (ghosts, sent) = (seen(&theirs, &own), seen(&own, &theirs));
        if ghosts.is_empty() {
            continue;
        }
        let first = numbers.len() - own.len();
        numbers.extend(&ghosts);
        peers.push(Peer {
            rank,
            sent: sent
                .iter()
                .map(|k| own.binary_search(k).unwrap() as u32)
                .collect(),
            received: first..first + ghosts.len(),
        });
    }
    let positions: Vec<[f64; 2]> = numbers.iter().map(|&k| nodes[k]).collect();
    let axis = |c: usize| own.iter().map(move |&k| nodes_at(k, c));
    let flat: Vec<f64> = axis(0).chain(axis(1)).collect();
    let volume = |k: &usize| 1.0 + 0.1 * (*k as f64).cos();
    let cloud = PointCloud::new(2, flat, own.iter().map(volume).collect(), 1.0).unwrap();
    let all = numbers.iter().map(|&k| k as u32).collect();
    let domain = Domain::new(all, own.len(), peers, comm);
    let cloud = Arc::new(cloud.with_domain(domain, 1.0));
    let volumes = numbers.iter().map(volume).collect();
    let domain = cloud.domain().clone();
    let force = Dilatational::new(positions, volumes, &numbers, HORIZON, domain);
    let force = TwoPassForce::new(cloud.clone(), force);
    let mut system =
        System::new(cloud.clone(), Box::new(force), PointScalar::Uniform(1.3)).unwrap();
    system
        .add_force(Box::new(Wall::below(&cloud, 2.0)))
        .unwrap();
    (system, own)
}

fn nodes_at(k: usize, c: usize) -> f64 {
    nodes()[k][c]
}

type Make = fn(&System) -> Box<dyn Integrator>;

/// Final state of a run: displacements and velocities by point number, energies and momentum, number of
/// evaluations.
type End = (Vec<[u64; 4]>, [u64; 3]);

fn run(comm: Arc<dyn Comm>, make: Make) -> (Vec<usize>, End) {
    let (system, own) = part(comm);
    let n = own.len();
    let mut state = State::at_rest(2 * n);
    for (i, &k) in own.iter().enumerate() {
        state.v[i] = 0.03 * (k as f64).sin();
        state.v[n + i] = -0.3;
    }
    let scheme = make(&system);
    let mut run = Simulation::new(system, scheme, state, 0.05, 60).unwrap();
    run.run(|_| Control::Continue).unwrap();
    let (system, state) = (run.system(), run.state());
    let sums = [
        system.kinetic_energy(&state.v),
        system.operator().energy(state.t, &state.u),
        system.momentum(&state.v)[0],
    ];
    let of = |i: usize| [state.u[i], state.u[n + i], state.v[i], state.v[n + i]].map(f64::to_bits);
    (own, ((0..n).map(of).collect(), sums.map(f64::to_bits)))
}

/// The final state computed by several threads, in the order of point numbers.
fn divided(size: usize, make: Make) -> End {
    let parts = Threads::run(size, |comm| run(comm, make));
    let mut whole = vec![[0; 4]; SIDES[0] * SIDES[1]];
    for (own, (values, sums)) in &parts {
        assert_eq!(sums, &parts[0].1.1, "all processes have the same sums");
        own.iter()
            .zip(values)
            .for_each(|(&k, values)| whole[k] = *values);
    }
    (whole, parts[0].1.1)
}

#[test]
fn results_of_a_divided_body_are_bitwise_identical() {
    let schemes: [(&str, Make); 4] = [
        ("velocity Verlet", |_| Box::new(VelocityVerlet)),
        ("Dormand–Prince", |system| {
            Box::new(AdaptiveRungeKutta::new(1e-8, system).unwrap())
        }),
        ("implicit midpoint", |system| {
            Box::new(Implicit::new(ImplicitRule::Midpoint, system).unwrap())
        }),
        ("Newmark by Newton–Krylov", |system| {
            let options = NewmarkOptions {
                solver: InnerSolver::NewtonKrylov,
                ..NewmarkOptions::default()
            };
            Box::new(Newmark::new(options, system).unwrap())
        }),
    ];
    for (name, make) in schemes {
        let alone = divided(1, make);
        for size in [2, 3, 5] {
            assert!(divided(size, make) == alone, "{name}, {size} processes");
        }
    }
}
