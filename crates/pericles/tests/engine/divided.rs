//! A body divided among several processes, here threads that talk through mailboxes: every bit is that of one process.

use std::collections::VecDeque;
use std::sync::{Arc, Barrier, Condvar, Mutex};

use crate::state_based::{Dilatational, Wall};
use pericles::domain::{Comm, Domain, Peer};
use pericles::operator::TwoPassForce;
use pericles::space::PointCloud;
use pericles::time::{
    AdaptiveRungeKutta, Implicit, ImplicitRule, InnerSolver, Integrator, Newmark, NewmarkOptions,
    State, VelocityVerlet,
};
use pericles::{Control, PointScalar, Simulation, System};

const HORIZON: f64 = 2.1;
const SIDES: [usize; 2] = [9, 7];

/// What the threads share.
struct Office {
    barrier: Barrier,
    /// Of the sums and maxima under way.
    numbers: Mutex<(Vec<i128>, Vec<f64>)>,
    /// Letters from one thread to another.
    letters: Mutex<Vec<Vec<VecDeque<Vec<f64>>>>>,
    delivered: Condvar,
}

struct Threads {
    rank: usize,
    size: usize,
    office: Arc<Office>,
}

impl Threads {
    /// Lets every thread combine its numbers with the shared ones, one after another, and read the result.
    fn combine(
        &self,
        add: impl FnOnce(&mut (Vec<i128>, Vec<f64>)),
        read: impl FnOnce(&(Vec<i128>, Vec<f64>)),
    ) {
        add(&mut self.office.numbers.lock().unwrap());
        self.office.barrier.wait();
        read(&self.office.numbers.lock().unwrap());
        if self.office.barrier.wait().is_leader() {
            *self.office.numbers.lock().unwrap() = Default::default();
        }
        self.office.barrier.wait();
    }
}

impl Comm for Threads {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn exchange(&self, peers: &[usize], sent: &[Vec<f64>], received: &mut [Vec<f64>]) {
        let mut letters = self.office.letters.lock().unwrap();
        for (&peer, letter) in peers.iter().zip(sent) {
            letters[self.rank][peer].push_back(letter.clone());
        }
        self.office.delivered.notify_all();
        for (&peer, place) in peers.iter().zip(received) {
            *place = loop {
                match letters[peer][self.rank].pop_front() {
                    Some(letter) => break letter,
                    None => letters = self.office.delivered.wait(letters).unwrap(),
                }
            };
        }
    }

    fn sum(&self, numbers: &mut [i128]) {
        let own = numbers.to_vec();
        let add = |shared: &mut (Vec<i128>, Vec<f64>)| {
            shared.0.resize(own.len(), 0);
            shared
                .0
                .iter_mut()
                .zip(&own)
                .for_each(|(sum, own)| *sum += own);
        };
        self.combine(add, |shared| numbers.copy_from_slice(&shared.0));
    }

    fn max(&self, numbers: &mut [f64]) {
        let own = numbers.to_vec();
        let add = |shared: &mut (Vec<i128>, Vec<f64>)| {
            shared.1.resize(own.len(), f64::NEG_INFINITY);
            shared
                .1
                .iter_mut()
                .zip(&own)
                .for_each(|(most, own)| *most = most.max(*own));
        };
        self.combine(add, |shared| numbers.copy_from_slice(&shared.1));
    }
}

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

/// The owner of each node: stripes of unequal width that cut rows, and no stripe is a range of numbers.
fn owners(size: usize) -> Vec<usize> {
    nodes()
        .iter()
        .map(|[x, y]| ((x + 0.3 * y) as usize * size / (SIDES[0] + 2)).min(size - 1))
        .collect()
}

/// The part of the body of one process, and the numbers of its points.
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
    let cloud = Arc::new(cloud.with_domain(Domain::new(own.len(), peers, comm)));
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

/// What a run ends with: displacements and velocities by the numbers of points, energies and momentum, and the evaluations of points.
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

/// The same by several threads, put together in the order of numbers.
fn divided(size: usize, make: Make) -> End {
    let office = Arc::new(Office {
        barrier: Barrier::new(size),
        numbers: Mutex::default(),
        letters: Mutex::new(vec![vec![VecDeque::new(); size]; size]),
        delivered: Condvar::new(),
    });
    let parts: Vec<(Vec<usize>, End)> = std::thread::scope(|scope| {
        let ranks: Vec<_> = (0..size)
            .map(|rank| {
                let office = office.clone();
                scope.spawn(move || run(Arc::new(Threads { rank, size, office }), make))
            })
            .collect();
        ranks.into_iter().map(|rank| rank.join().unwrap()).collect()
    });
    let mut whole = vec![[0; 4]; SIDES[0] * SIDES[1]];
    for (own, (values, sums)) in &parts {
        assert_eq!(sums, &parts[0].1.1, "every process knows the same sums");
        own.iter()
            .zip(values)
            .for_each(|(&k, values)| whole[k] = *values);
    }
    (whole, parts[0].1.1)
}

#[test]
fn a_divided_body_moves_by_the_same_bits() {
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
