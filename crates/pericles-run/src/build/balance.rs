//! Checks constraints and loads of static bodies for equilibrium.

use pericles::System;
use pericles::space::PointCloud;
use pericles_deck::Caution;

use super::assembler::Assembler;

/// Components of a rigid-body motion along and about three axes, or of a force and a moment.
type Rigid = [f64; 6];

/// Net forces and moments below this fraction of the loads are rounding errors.
const BALANCED: f64 = 1e-6;

/// A connected part of a body.
struct Part {
    /// One of its points.
    first: usize,
    points: usize,
    /// The mean position of its points, m.
    centre: [f64; 3],
    /// The largest distance of a point from the centre, m.
    size: f64,
    is_held: bool,
    /// Rigid-body motions prevented by constraints, orthonormal.
    held: Vec<Rigid>,
    /// The net force (N) and moment divided by `size` (N) of the loads.
    net: Rigid,
    /// The sum of the magnitudes of the loads, N.
    loads: f64,
    /// The largest net force and moment without a constraint.
    worst: Rigid,
    /// Whether they exceed the rounding error.
    is_unbalanced: bool,
}

fn dot(a: &Rigid, b: &Rigid) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

impl Part {
    /// Returns the displacements of a position along axis c by the six rigid-body motions; rotations are scaled by
    /// `size`.
    fn motions(&self, place: [f64; 3], c: usize, rotates: bool) -> Rigid {
        let [x, y, z] =
            std::array::from_fn(|k| (place[k] - self.centre[k]) / self.size.max(f64::MIN_POSITIVE));
        let mut row = [0.0; 6];
        row[c] = 1.0;
        if rotates {
            row[3] = [0.0, -z, y][c];
            row[4] = [z, 0.0, -x][c];
            row[5] = [-y, x, 0.0][c];
        }
        row
    }

    /// Returns the part of a motion or force that is orthogonal to the prevented motions.
    fn free(&self, mut row: Rigid) -> Rigid {
        for held in &self.held {
            let along = dot(held, &row);
            for (row, held) in row.iter_mut().zip(held) {
                *row -= along * held;
            }
        }
        row
    }

    /// Adds a motion that a constraint prevents.
    fn hold(&mut self, row: Rigid) {
        /// Below this fraction it is already prevented.
        const NEW: f64 = 1e-6;
        self.is_held = true;
        if self.held.len() == 6 {
            return;
        }
        let rest = self.free(self.free(row));
        let length = norm(&rest);
        if length > NEW * norm(&row) {
            self.held.push(rest.map(|x| x / length));
        }
    }

    /// Updates the largest imbalance with the loads of one time.
    fn check(&mut self) {
        let rest = self.free(self.net);
        if norm(&rest) > BALANCED * self.loads {
            self.is_unbalanced = true;
            if norm(&rest) > norm(&self.worst) {
                self.worst = rest;
            }
        }
        (self.net, self.loads) = ([0.0; 6], 0.0);
    }

    /// Returns the warning about this part of a body of `of` points.
    fn caution(&self, of: usize, cloud: &PointCloud) -> Caution {
        let (points, place) = (self.points, position(cloud, self.first));
        let [force, moment] = [&self.worst[..3], &self.worst[3..]].map(norm);
        let is_some = |x: f64| x > BALANCED * norm(&self.worst);
        Caution::Unbalanced {
            points,
            of,
            place,
            force: is_some(force).then_some(force),
            moment: is_some(moment).then_some(moment * self.size),
            units: cloud.body_units(),
        }
    }
}

impl Assembler<'_> {
    /// Warns of a static body with a part that can move as a rigid body until `end` (s), because the loads on it are
    /// not in equilibrium or it has no constraint.
    pub(super) fn check_supports(&self, system: &System, end: f64) {
        let is_static = self.model.time.scheme.is_static();
        let Some(solid) = self.model.body.solid() else {
            return;
        };
        if !is_static || solid.shape.is_refined() {
            return;
        }
        let cloud = system.cloud();
        let Some(piece) = self.pieces(solid, cloud) else {
            return;
        };
        let (mut parts, part_of) = parts(cloud, &piece);
        hold(system, &mut parts, &part_of);
        load(system, end, &mut parts, &part_of);
        let most = |a: &&Part, b: &&Part| norm(&a.worst).total_cmp(&norm(&b.worst));
        let unbalanced = parts.iter().filter(|part| part.is_unbalanced).max_by(most);
        if let Some(part) = unbalanced {
            let caution = part.caution(cloud.len(), cloud);
            self.warn("time.scheme", caution);
        }
        let taken_out = self.model.time.scheme.removes_rigid_modes();
        let loose = parts
            .iter()
            .filter(|part| !part.is_held && !part.is_unbalanced && !taken_out);
        let loose: Vec<&Part> = loose.collect();
        if let Some(first) = loose.first() {
            let caution = Caution::NoSupport {
                points: loose.iter().map(|part| part.points).sum(),
                of: cloud.len(),
                place: position(cloud, first.first),
            };
            self.warn("time.scheme", caution);
        }
    }
}

/// Returns the position of a point, with as many components as the body has dimensions, m.
fn position(cloud: &PointCloud, i: usize) -> Vec<f64> {
    cloud.point(i)[..cloud.dimension()].to_vec()
}

/// Returns the parts of a body and the part of each point; `piece` identifies the part of a point by one of its points.
fn parts(cloud: &PointCloud, piece: &[usize]) -> (Vec<Part>, Vec<u32>) {
    let mut parts: Vec<Part> = Vec::new();
    let mut number = vec![u32::MAX; cloud.len()];
    for (i, &first) in piece.iter().enumerate() {
        if number[first] == u32::MAX {
            number[first] = parts.len() as u32;
            parts.push(Part {
                first: i,
                points: 0,
                centre: [0.0; 3],
                size: 0.0,
                is_held: false,
                held: Vec::new(),
                net: [0.0; 6],
                loads: 0.0,
                worst: [0.0; 6],
                is_unbalanced: false,
            });
        }
        let part = &mut parts[number[first] as usize];
        part.points += 1;
        for (sum, x) in part.centre.iter_mut().zip(cloud.point(i)) {
            *sum += x;
        }
    }
    for part in &mut parts {
        part.centre = part.centre.map(|sum| sum / part.points as f64);
    }
    let part_of: Vec<u32> = piece.iter().map(|&first| number[first]).collect();
    for (i, &number) in part_of.iter().enumerate() {
        let part = &mut parts[number as usize];
        let place = cloud.point(i);
        let away: [f64; 3] = std::array::from_fn(|c| place[c] - part.centre[c]);
        part.size = part.size.max(norm(&away));
    }
    (parts, part_of)
}

/// Collects the rigid-body motions that constraints prevent.
fn hold(system: &System, parts: &mut [Part], part_of: &[u32]) {
    let cloud = system.cloud();
    let rotates = !cloud.is_periodic();
    for motion in system.motions() {
        for &i in &motion.points {
            let part = &mut parts[part_of[i as usize] as usize];
            for c in motion.axes() {
                let row = part.motions(cloud.point(i as usize), c, rotates);
                part.hold(row);
            }
        }
    }
}

/// Sums the loads of each part at times until `end`.
fn load(system: &System, end: f64, parts: &mut [Part], part_of: &[u32]) {
    /// Number of sampled times, which include the peaks of common ramps and pulses.
    const TIMES: usize = 12;
    let cloud = system.cloud();
    let (n, dimension) = (cloud.len(), cloud.dimension());
    let rotates = !cloud.is_periodic();
    let mut density = vec![0.0; dimension * n];
    for k in 0..=TIMES {
        let t = end * k as f64 / TIMES as f64;
        system.load_density_into(t, &mut density);
        for (i, &number) in part_of.iter().enumerate() {
            let part = &mut parts[number as usize];
            for c in 0..dimension {
                let force = density[c * n + i] * cloud.volumes()[i];
                if force == 0.0 {
                    continue;
                }
                let row = part.motions(cloud.point(i), c, rotates);
                for (net, row) in part.net.iter_mut().zip(row) {
                    *net += force * row;
                }
                part.loads += force.abs();
            }
        }
        parts.iter_mut().for_each(Part::check);
    }
}
