//! Values of the nodes of a zone on every process.
//!
//! All processes compute the layers, which are a small part of a plate, identically: results do not depend on the division, and the
//! memory of the layers is equal on all processes.

use pericles::domain::Domain;
use pericles::space::PointCloud;

use super::plate::Zone;

/// The own points in a zone, and the exchange of their values.
pub(super) struct ZoneExchange {
    /// Own points in ascending order, and their numbers in the zone.
    pub(super) own: Vec<(u32, u32)>,
    /// Numbers in the zone of the points of each process; empty if the body is not divided.
    numbers: Vec<Vec<u32>>,
    nodes: usize,
    domain: Domain,
}

impl ZoneExchange {
    /// Finds the points of a zone. All processes must call it together.
    pub(super) fn new(zone: &Zone, cloud: &PointCloud) -> Self {
        let domain = cloud.domain();
        let nodes = cloud.lattice().map_or(&[][..], |lattice| &lattice.node);
        let columns = zone.lines[0].nodes;
        let own: Vec<(u32, u32)> = (0u32..)
            .zip(nodes)
            .filter_map(|(point, &node)| {
                let node = [node as usize % columns, node as usize / columns];
                Some((point, zone.number(node)? as u32))
            })
            .collect();
        let numbers = match domain.is_divided() {
            false => Vec::new(),
            true => {
                let message = own.iter().map(|&(_, number)| f64::from(number)).collect();
                let all = domain.collect_everywhere(message).into_iter();
                all.map(|of| of.into_iter().map(|number| number as u32).collect())
                    .collect()
            }
        };
        Self {
            own,
            numbers,
            nodes: zone.len(),
            domain: domain.clone(),
        }
    }

    /// Number of nodes of the zone that are points of the whole body.
    pub(super) fn points(&self) -> usize {
        match self.domain.is_divided() {
            false => self.own.len(),
            true => self.numbers.iter().map(Vec::len).sum(),
        }
    }

    /// Sets a field of two components on the zone from its values at own points, by component and point. Each component has one
    /// entry more than the zone, which is left unchanged. All processes must call it together.
    pub(super) fn spread(&self, own: Vec<f64>, field: &mut [f64]) {
        let width = self.nodes + 1;
        let mut set = |numbers: &mut dyn Iterator<Item = u32>, values: &[f64]| {
            let count = values.len() / 2;
            for (k, number) in numbers.enumerate() {
                field[number as usize] = values[k];
                field[width + number as usize] = values[count + k];
            }
        };
        if !self.domain.is_divided() {
            return set(&mut self.own.iter().map(|own| own.1), &own);
        }
        let messages = self.domain.collect_everywhere(own);
        for (numbers, values) in self.numbers.iter().zip(&messages) {
            set(&mut numbers.iter().copied(), values);
        }
    }
}
