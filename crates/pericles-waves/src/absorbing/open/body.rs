//! The body of an open boundary: its lattice and its own points in the layers.

use pericles::System;
use pericles::space::PointCloud;

use super::error::OpenError;
use super::exchange::ZoneExchange;
use super::plate::{Line, Zone};
use super::weights::LatticeWeights;

/// Own points in the zone.
pub(super) struct OwnNodes {
    pub(super) points: Vec<u32>,
    /// Masses, kg.
    pub(super) masses: Vec<f64>,
    /// Whether the boundary replaces the acceleration of the point.
    pub(super) is_replaced: Vec<bool>,
}

impl OwnNodes {
    pub(super) fn new(
        system: &System,
        exchange: &ZoneExchange,
        zone: &Zone,
        margin: usize,
    ) -> Self {
        let cloud = system.cloud();
        let columns = zone.lines[0].nodes;
        let replaced = |i: usize| {
            let node = cloud
                .lattice()
                .map_or(0, |lattice| lattice.node[i] as usize);
            let node = [node % columns, node / columns];
            (0..2).any(|axis| zone.lines[axis].is_near(node[axis], margin))
        };
        let points: Vec<u32> = exchange.own.iter().map(|own| own.0).collect();
        let mass = |&i: &u32| system.density().at(i as usize) * cloud.volumes()[i as usize];
        Self {
            masses: points.iter().map(mass).collect(),
            is_replaced: points.iter().map(|&i| replaced(i as usize)).collect(),
            points,
        }
    }

    /// Returns the values of a field on the body by component and own point of the zone.
    pub(super) fn values(&self, field: &[f64]) -> Vec<f64> {
        let n = field.len() / 2;
        let component = |c: usize| self.points.iter().map(move |&i| field[c * n + i as usize]);
        component(0).chain(component(1)).collect()
    }
}

/// Number of nodes along x and y.
pub(super) fn shape_of(cloud: &PointCloud) -> Result<[usize; 2], OpenError> {
    let reject = |found: String| Err(OpenError::NotALattice { found });
    if cloud.dimension() != 2 {
        return reject(format!("the body has dimension {}", cloud.dimension()));
    }
    let Some(lattice) = cloud.lattice() else {
        return reject("the points of the body are not on one lattice".into());
    };
    if !lattice.is_cubic(2) {
        let [x, y, _] = lattice.spacing.map(|dx| pericles::units::quantity(dx, "m"));
        return reject(format!("the spacing is {x} along x and {y} along y"));
    }
    Ok([lattice.shape[0], lattice.shape[1]])
}

/// Position of points relative to a node at the interface of a layer, in cells.
pub(super) fn probe(cloud: &PointCloud, lines: &[Line; 2]) -> impl Fn(usize) -> [isize; 2] {
    let mut centre = lines.map(|line| line.nodes / 2);
    let open = (0..2).flat_map(|axis| (0..2).map(move |end| (axis, end)));
    let mut open = open.filter(|&(axis, end)| lines[axis].cells(end).is_some());
    if let Some((axis, end)) = open.next() {
        centre[axis] = lines[axis].index(end, 0);
    }
    let columns = lines[0].nodes;
    let nodes = cloud
        .lattice()
        .map_or(Vec::new(), |lattice| lattice.node.clone());
    move |point| {
        let node = [
            nodes[point] as usize % columns,
            nodes[point] as usize / columns,
        ];
        [0, 1].map(|axis| node[axis] as isize - centre[axis] as isize)
    }
}

/// Speed of long longitudinal waves, cells/s.
pub(super) fn speed_of(weights: &LatticeWeights, spacing: f64) -> Result<f64, OpenError> {
    let speeds = [0, 1].map(|axis| weights.longitudinal_speed(axis));
    let [x, y] = speeds;
    let is_isotropic = x > 0.0 && (x - y).abs() <= 1e-3 * x;
    if !is_isotropic {
        let speeds = speeds.map(|speed| speed * spacing);
        return Err(OpenError::Anisotropic { speeds });
    }
    Ok(x)
}
