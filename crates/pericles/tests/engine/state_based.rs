//! A small state-based force and a wall, to be integrated by any scheme.

use std::sync::Arc;

use pericles::domain::{Domain, Field};
use pericles::operator::{
    AtPoints, Capabilities, Force, InstructionSet, LocalForce, PointSubset, TwoPass,
};
use pericles::space::PointCloud;

/// The points of a subset of n points.
fn wanted(on: &PointSubset<'_>, n: usize) -> Vec<usize> {
    match on {
        PointSubset::All => (0..n).collect(),
        PointSubset::Range(range) => range.clone().collect(),
        PointSubset::Set(points) => points.iter().map(|&i| i as usize).collect(),
    }
}

/// W_i = ½ A θ_i² + ½ B Σ_j V_j e_ij² with the elongations e_ij = |ξ + η| − |ξ| of all bonds of point i and θ_i =
/// Σ_j V_j e_ij, in the plane.
///
/// The force on i is Σ_j V_j (A (θ_i + θ_j) + 2 B e_ij) n_ij; the first pass computes θ.
pub struct Dilatational {
    points: usize,
    /// Of own points and ghosts.
    positions: Vec<[f64; 2]>,
    volumes: Vec<f64>,
    /// Neighbours of own points by local number, in the order of their numbers in the whole body.
    families: Vec<Vec<usize>>,
    domain: Domain,
    bulk: f64,
    bond: f64,
}

impl Dilatational {
    /// Makes the force for own points and ghosts with the given numbers in the whole body.
    pub fn new(
        positions: Vec<[f64; 2]>,
        volumes: Vec<f64>,
        numbers: &[usize],
        horizon: f64,
        domain: Domain,
    ) -> Self {
        let points = domain.owned_points();
        let near = |i: usize, j: usize| {
            let [[a, b], [c, d]] = [positions[i], positions[j]];
            i != j && (c - a).powi(2) + (d - b).powi(2) <= horizon * horizon
        };
        let families = (0..points)
            .map(|i| {
                let mut family: Vec<usize> = (0..positions.len()).filter(|&j| near(i, j)).collect();
                family.sort_by_key(|&j| numbers[j]);
                family
            })
            .collect();
        Self {
            points,
            positions,
            volumes,
            families,
            domain,
            bulk: 0.02,
            bond: 0.05,
        }
    }

    /// Makes the force for all points of a body.
    pub fn whole(cloud: &PointCloud, horizon: f64) -> Self {
        let n = cloud.len();
        let positions = (0..n)
            .map(|i| [cloud.point(i)[0], cloud.point(i)[1]])
            .collect();
        let numbers: Vec<usize> = (0..n).collect();
        let domain = cloud.domain().clone();
        Self::new(
            positions,
            cloud.volumes().to_vec(),
            &numbers,
            horizon,
            domain,
        )
    }

    /// Component c at a point of a vector on own points and ghosts.
    fn at(&self, field: Field<'_>, c: usize, i: usize) -> f64 {
        let ghosts = self.positions.len() - self.points;
        match i.checked_sub(self.points) {
            None => field.owned[c * self.points + i],
            Some(ghost) => field.ghosts[c * ghosts + ghost],
        }
    }

    /// Elongation, direction and length of the bond from i to j.
    fn bond(&self, u: Field<'_>, i: usize, j: usize) -> (f64, [f64; 2], f64) {
        let xi: [f64; 2] = std::array::from_fn(|c| self.positions[j][c] - self.positions[i][c]);
        let now: [f64; 2] = std::array::from_fn(|c| xi[c] + self.at(u, c, j) - self.at(u, c, i));
        let [rest, length] = [xi, now].map(|[x, y]| (x * x + y * y).sqrt());
        (length - rest, now.map(|x| x / length), length)
    }
}

impl TwoPass for Dilatational {
    fn values_per_point(&self) -> usize {
        1
    }

    fn values_into(&self, _t: f64, u: Field<'_>, on: &PointSubset<'_>, values: &mut [f64]) {
        for i in wanted(on, self.points) {
            let family = self.families[i].iter();
            values[i] = family
                .map(|&j| self.volumes[j] * self.bond(u, i, j).0)
                .sum();
        }
    }

    fn value_changes_into(&self, _t: f64, u: Field<'_>, direction: Field<'_>, changes: &mut [f64]) {
        for (i, family) in self.families.iter().enumerate() {
            let change = |&j: &usize| {
                let (_, normal, _) = self.bond(u, i, j);
                let along =
                    |c: usize| normal[c] * (self.at(direction, c, j) - self.at(direction, c, i));
                self.volumes[j] * (along(0) + along(1))
            };
            changes[i] = family.iter().map(change).sum();
        }
    }

    fn add_bond_force(&self, _t: f64, at: AtPoints<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        for i in wanted(on, self.points) {
            for &j in &self.families[i] {
                let (elongation, normal, _) = self.bond(at.u, i, j);
                let dilatation = self.at(at.values, 0, i) + self.at(at.values, 0, j);
                let force =
                    self.volumes[j] * (self.bulk * dilatation + 2.0 * self.bond * elongation);
                for c in 0..2 {
                    out[c * self.points + i] += force * normal[c];
                }
            }
        }
    }

    fn add_bond_tangent(&self, _t: f64, at: AtPoints<'_>, change: AtPoints<'_>, out: &mut [f64]) {
        for (i, family) in self.families.iter().enumerate() {
            for &j in family {
                let (elongation, normal, length) = self.bond(at.u, i, j);
                let d: [f64; 2] =
                    std::array::from_fn(|c| self.at(change.u, c, j) - self.at(change.u, c, i));
                let along = d[0] * normal[0] + d[1] * normal[1];
                let both = |field: Field<'_>| self.at(field, 0, i) + self.at(field, 0, j);
                let force = self.bulk * both(at.values) + 2.0 * self.bond * elongation;
                let rate = self.bulk * both(change.values) + 2.0 * self.bond * along;
                for c in 0..2 {
                    let turned = (d[c] - along * normal[c]) / length;
                    out[c * self.points + i] +=
                        self.volumes[j] * (rate * normal[c] + force * turned);
                }
            }
        }
    }

    fn add_energy_density(&self, _t: f64, at: AtPoints<'_>, out: &mut [f64]) {
        for (i, family) in self.families.iter().enumerate() {
            let square = |&j: &usize| self.volumes[j] * self.bond(at.u, i, j).0.powi(2);
            let bonds: f64 = family.iter().map(square).sum();
            out[i] += 0.5 * self.bulk * self.at(at.values, 0, i).powi(2) + 0.5 * self.bond * bonds;
        }
    }

    /// By Cauchy's inequality θ² ≤ Σ V Σ V e², and e² ≤ 2 (|u_i|² + |u_j|²).
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let volume = |i: usize| -> f64 { self.families[i].iter().map(|&j| self.volumes[j]).sum() };
        let own: Vec<f64> = (0..self.points)
            .map(|i| self.bulk * volume(i) + self.bond)
            .collect();
        let ghosts = self.domain.ghosts(&own);
        let stiffness = |j: usize| self.at(Field::new(&own, &ghosts), 0, j);
        let square = |i: usize| {
            let others = self.families[i]
                .iter()
                .map(|&j| self.volumes[j] * stiffness(j));
            2.0 * (volume(i) * stiffness(i) + others.sum::<f64>()) / density(i)
        };
        let largest = (0..self.points).map(square).fold(0.0, f64::max);
        self.domain.max(largest).sqrt()
    }

    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        self.families[i].iter().for_each(|&j| visit(j));
    }

    fn directed_bonds(&self) -> u64 {
        self.families.iter().map(|family| family.len() as u64).sum()
    }

    fn bytes(&self) -> usize {
        self.families
            .iter()
            .map(|family| size_of_val(&family[..]))
            .sum()
    }
}

pericles::saved! {
    impl Checkpointed for Dilatational {
        points, positions, volumes, families, domain, bulk, bond: fixed,
    }
}

/// A wall at y = 0 that pushes points below it up with k times their depth: a force in addition to that of the
/// body, N/m³.
pub struct Wall {
    pub heights: Vec<f64>,
    pub volumes: Vec<f64>,
    pub stiffness: f64,
    pub domain: Domain,
}

impl Wall {
    /// Makes a wall below a body in the plane.
    pub fn below(cloud: &Arc<PointCloud>, stiffness: f64) -> Self {
        Self {
            heights: cloud.axis(1).to_vec(),
            volumes: cloud.volumes().to_vec(),
            stiffness,
            domain: cloud.domain().clone(),
        }
    }

    fn depth(&self, u: &[f64], i: usize) -> f64 {
        (-(self.heights[i] + u[self.heights.len() + i])).max(0.0)
    }
}

impl Force for Wall {
    fn points(&self) -> usize {
        self.heights.len()
    }

    fn dimension(&self) -> usize {
        2
    }

    fn add_force(&self, _t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        let n = self.points();
        for i in wanted(&on, n) {
            out[n + i] += self.stiffness * self.depth(u, i);
        }
    }

    fn add_energy_density(&self, _t: f64, u: &[f64], out: &mut [f64]) {
        for (i, energy) in out.iter_mut().enumerate() {
            *energy += 0.5 * self.stiffness * self.depth(u, i).powi(2);
        }
    }

    fn energy(&self, _t: f64, u: &[f64]) -> f64 {
        let energy = |i: usize| 0.5 * self.volumes[i] * self.stiffness * self.depth(u, i).powi(2);
        self.domain.sum(self.points(), energy)
    }

    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let square = |i: usize| self.stiffness / density(i);
        let largest = (0..self.points()).map(square).fold(0.0, f64::max);
        self.domain.max(largest).sqrt()
    }

    fn tangent_into(&self, _t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        let n = self.points();
        out.fill(0.0);
        for i in (0..n).filter(|&i| self.depth(u, i) > 0.0) {
            out[n + i] = -self.stiffness * direction[n + i];
        }
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            local: Some(self),
            ..Capabilities::default()
        }
    }

    fn directed_bonds(&self) -> u64 {
        0
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.heights[..])
    }

    fn instruction_set(&self) -> InstructionSet {
        InstructionSet::Baseline
    }
}

impl LocalForce for Wall {
    fn bonded(&self, _i: usize, _visit: &mut dyn FnMut(usize)) {}
}

pericles::saved! {
    impl Checkpointed for Wall {
        heights, volumes, stiffness, domain: fixed,
    }
}
