//! Unconstrained rigid-body motions.

use pericles::System;
use pericles::domain::{Domain, Replicated};

use crate::eigen::symmetric_eigen;
use crate::surrogate::{RigidModes, Surrogate};
use crate::unknowns::Unknowns;

/// A connected part of the body with unconstrained rigid-body motions.
#[derive(Debug, Clone, PartialEq)]
pub struct FreePiece {
    /// Numbers of its points in the whole body, ascending.
    pub points: Vec<u32>,
    /// Names of the unconstrained motions.
    pub motions: Vec<&'static str>,
    /// Orthonormal basis of these motions: component-major vectors on the points of the part.
    pub basis: Vec<Vec<f64>>,
}

impl FreePiece {
    /// Returns whether a load (N/m³) on the points of the whole body has a resultant along the motions, and thus sets the part
    /// in motion.
    pub(crate) fn moved_by(&self, load: &[f64], volumes: &[f64]) -> bool {
        /// Part of the norm of the load: a smaller resultant is due to rounding.
        const BALANCED: f64 = 1e-9;
        let (n, own) = (volumes.len(), self.points.len());
        let force = |k: usize| {
            let i = self.points[k % own] as usize;
            volumes[i] * load[k / own * n + i]
        };
        let entries = self.basis.first().map_or(0, Vec::len);
        let norm = (0..entries).map(|k| force(k).powi(2)).sum::<f64>().sqrt();
        self.basis.iter().any(|motion| {
            let along: f64 = motion.iter().enumerate().map(|(k, x)| x * force(k)).sum();
            along.abs() > BALANCED * norm
        })
    }
}

/// Returns the connected parts of two or more points that have rigid-body motions compatible with the
/// constrained entries. `unknowns` are those of the whole body. All processes must call it together.
pub fn free_pieces(system: &System, surrogate: &Surrogate, unknowns: &Unknowns) -> Vec<FreePiece> {
    let d = system.dimension();
    let positions = surrogate.positions();
    let n = positions.len() / d;
    let rotates = surrogate.rotations(d);
    let mut free = Vec::new();
    for points in pieces(system, surrogate) {
        if points.len() < 2 {
            continue;
        }
        let own: Vec<f64> = (0..d)
            .flat_map(|c| points.iter().map(move |&i| positions[c * n + i as usize]))
            .collect();
        let modes = RigidModes::new(d, rotates, &own);
        let held = |k: usize, c: usize| unknowns.number(points[k] as usize, c).is_none();
        let found = unheld(&modes, points.len(), d, &held);
        if found.is_empty() {
            continue;
        }
        free.push(FreePiece {
            motions: names(&modes, &found),
            basis: orthonormal(&modes, &found, points.len(), d, &held),
            points,
        });
    }
    free
}

/// Returns the motions of free parts as vectors on own points.
pub(crate) fn spread(
    pieces: &[FreePiece],
    system: &System,
    replicated: &Replicated,
) -> Vec<Vec<f64>> {
    let (n, d) = (replicated.points(), system.dimension());
    let mut all = Vec::new();
    for piece in pieces {
        let own = piece.points.len();
        for motion in &piece.basis {
            let mut vector = vec![0.0; d * system.points()];
            replicated.fill_own(d, &mut vector, |whole| {
                for c in 0..d {
                    for (k, &i) in piece.points.iter().enumerate() {
                        whole[c * n + i as usize] = motion[c * own + k];
                    }
                }
            });
            all.push(vector);
        }
    }
    all
}

/// Disjoint sets of points, each of which is known by its first point.
struct Sets(Vec<u32>);

impl Sets {
    /// Creates a set for each point.
    fn new(points: usize) -> Self {
        Self((0..points as u32).collect())
    }

    /// Returns the first point of the set of a point.
    fn first(&mut self, mut i: u32) -> u32 {
        let root = &mut self.0;
        while root[i as usize] != i {
            root[i as usize] = root[root[i as usize] as usize];
            i = root[i as usize];
        }
        i
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a as u32), self.first(b as u32));
        let (low, high) = (a.min(b), a.max(b));
        self.0[high as usize] = low;
    }
}

/// Returns the connected parts of the body.
fn pieces(system: &System, surrogate: &Surrogate) -> Vec<Vec<u32>> {
    let domain = system.domain();
    let whole = surrogate.positions().len() / system.dimension();
    let sets = match system.operator().as_bonds() {
        Some(view) => {
            let mut own = Sets::new(domain.owned_points() + domain.ghost_points());
            for i in 0..system.points() {
                view.for_each_undeformed(i, &mut |bond| own.join(i, bond.neighbour));
            }
            match domain.is_divided() {
                false => own,
                true => of_all_processes(domain, own, whole),
            }
        }
        None => {
            let mut sets = Sets::new(whole);
            surrogate.for_each_pair(&mut |a, b| sets.join(a, b));
            sets
        }
    };
    members(sets)
}

/// Returns the sets of all points from those of the points of each process and its ghosts.
fn of_all_processes(domain: &Domain, mut own: Sets, whole: usize) -> Sets {
    let points = own.0.len() as u32;
    let pair = |k: u32| [k, own.first(k)];
    let joined = (0..points).map(pair).filter(|[k, first]| k != first);
    let numbers = joined.flatten().map(|k| domain.number(k as usize) as f64);
    let messages = domain.collect_everywhere(numbers.collect());
    let mut sets = Sets::new(whole);
    for pair in messages.iter().flat_map(|message| message.chunks_exact(2)) {
        sets.join(pair[0] as usize, pair[1] as usize);
    }
    sets
}

/// Returns the points of each set, ascending.
fn members(mut sets: Sets) -> Vec<Vec<u32>> {
    let n = sets.0.len();
    let mut members: Vec<Vec<u32>> = vec![Vec::new(); n];
    for i in 0..n as u32 {
        members[sets.first(i) as usize].push(i);
    }
    members.retain(|points| !points.is_empty());
    members
}

/// Returns the coefficients of motions that do not displace constrained entries.
fn unheld(
    modes: &RigidModes<'_>,
    points: usize,
    d: usize,
    held: &dyn Fn(usize, usize) -> bool,
) -> Vec<Vec<f64>> {
    let count = modes.count();
    let (mut gram, mut size) = (vec![0.0; count * count], vec![0.0; count]);
    for k in 0..points {
        for c in 0..d {
            for a in 0..count {
                let value = modes.value(a, k, c);
                size[a] += value * value;
                if held(k, c) {
                    for b in 0..count {
                        gram[a * count + b] += value * modes.value(b, k, c);
                    }
                }
            }
        }
    }
    // Motions without displacements, such as the rotation of a bar about its axis, need no constraint.
    /// Fraction of the squared norm of a translation.
    const NOTHING: f64 = 1e-20;
    for a in 0..count {
        if size[a] < NOTHING * points as f64 {
            gram[a * count + a] += 1.0;
        }
    }
    let (values, vectors) = symmetric_eigen(count, gram);
    let largest = values.last().copied().unwrap_or(0.0);
    /// Squared displacements of constrained entries, relative to the largest.
    const HELD: f64 = 1e-12;
    let free = values.iter().take_while(|&&value| value <= HELD * largest);
    let free = if largest == 0.0 { count } else { free.count() };
    let of_vector = |k: usize| vectors[k * count..(k + 1) * count].to_vec();
    (0..free).map(of_vector).collect()
}

/// Returns names of independent motions that constraints must prevent, as many as there are free ones;
/// rotations first, because a rotation about a point is also a translation of the centre.
fn names(modes: &RigidModes<'_>, found: &[Vec<f64>]) -> Vec<&'static str> {
    let mut rows: Vec<(usize, Vec<f64>)> = (0..modes.count())
        .rev()
        .map(|mode| (mode, found.iter().map(|vector| vector[mode]).collect()))
        .collect();
    let mut named = Vec::new();
    while named.len() < found.len() {
        let square = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>();
        /// Smallest relative size of a linearly independent row.
        const INDEPENDENT: f64 = 0.02;
        let Some(place) = rows.iter().position(|(_, row)| square(row) > INDEPENDENT) else {
            break;
        };
        let (mode, pivot) = rows.remove(place);
        named.push(mode);
        let whole = square(&pivot);
        for (_, row) in &mut rows {
            let along: f64 = row.iter().zip(&pivot).map(|(a, b)| a * b).sum();
            row.iter_mut()
                .zip(&pivot)
                .for_each(|(a, b)| *a -= along / whole * b);
        }
    }
    named.sort_unstable();
    named.into_iter().map(|mode| modes.name(mode)).collect()
}

/// Returns the motions as orthonormal vectors, zero on constrained entries.
fn orthonormal(
    modes: &RigidModes<'_>,
    found: &[Vec<f64>],
    points: usize,
    d: usize,
    held: &dyn Fn(usize, usize) -> bool,
) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for coefficients in found {
        let mut vector = vec![0.0; d * points];
        for (k, a) in coefficients.iter().enumerate() {
            for c in 0..d {
                for i in (0..points).filter(|&i| !held(i, c)) {
                    vector[c * points + i] += a * modes.value(k, i, c);
                }
            }
        }
        for other in &basis {
            let along: f64 = vector.iter().zip(other).map(|(a, b)| a * b).sum();
            vector
                .iter_mut()
                .zip(other)
                .for_each(|(a, b)| *a -= along * b);
        }
        let size = vector.iter().map(|a| a * a).sum::<f64>().sqrt();
        if size > 0.0 {
            vector.iter_mut().for_each(|a| *a /= size);
            basis.push(vector);
        }
    }
    basis
}
