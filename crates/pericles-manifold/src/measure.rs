//! Quantities measured on a moving surface.

use pericles::vector::{norm, normal};
use std::sync::Arc;

use crate::surface::Surface;
use pericles::observe::{Field, Snapshot};
use pericles::space::Point;

/// Measures stretch, inverted triangles and energy concentrations of a surface.
#[derive(Debug, Clone)]
pub struct SurfaceMeasure {
    surface: Arc<Surface>,
    area: f64,
    edges: Vec<[u32; 2]>,
}

/// Measured quantities of one state.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceReading {
    /// Relative change of area S/S₀ − 1, with S the area of the deformed triangles.
    pub stretch: f64,
    /// Number of triangles whose normal has turned by more than a right angle.
    pub inverted_triangles: usize,
    /// Number of edges longer than twice their reference length.
    pub overstretched_edges: usize,
    /// Largest elastic energy density divided by the mean.
    pub localisation: f64,
    /// Fraction of the elastic energy in the 2 % of vertices with the highest densities.
    pub top_share: f64,
    /// Zones of concentrated energy, in descending order of area.
    pub zones: Vec<EnergyZone>,
}

/// Connected vertices whose elastic energy density exceeds eight times the mean over the area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyZone {
    /// Number of vertices.
    pub vertices: usize,
    /// Their area, m².
    pub area: f64,
    /// Their centre in the reference configuration, m.
    pub centre: Point,
}

/// Ratio of energy density to the mean that defines a zone.
const CONCENTRATED: f64 = 8.0;
/// Fraction of the vertices counted as the top.
const TOP: f64 = 0.02;

impl SurfaceMeasure {
    /// Creates the measure of a surface whose vertices are a body's points.
    pub fn new(surface: Arc<Surface>) -> Self {
        Self {
            area: surface.area(),
            edges: surface.edges(),
            surface,
        }
    }

    /// The surface.
    pub fn surface(&self) -> &Arc<Surface> {
        &self.surface
    }

    /// Measures a state.
    pub fn read(&self, snapshot: &Snapshot<'_>) -> SurfaceReading {
        let u = &snapshot.state().u;
        let areas = snapshot.system().cloud().volumes();
        let energy = snapshot.field(Field::StrainEnergyDensity);
        let (localisation, top_share) = concentration(energy, areas);
        SurfaceReading {
            stretch: self.stretch(u),
            inverted_triangles: self.inverted(u),
            overstretched_edges: self.overstretched(u),
            localisation,
            top_share,
            zones: self.zones(energy, areas),
        }
    }

    /// Returns S/S₀ − 1 for a displacement.
    pub fn stretch(&self, u: &[f64]) -> f64 {
        let area: f64 = self
            .surface
            .triangles()
            .iter()
            .map(|&triangle| 0.5 * norm(normal(self.deformed(triangle, u))))
            .sum();
        area / self.area - 1.0
    }

    fn deformed(&self, triangle: [u32; 3], u: &[f64]) -> [Point; 3] {
        triangle.map(|vertex| self.place(vertex, u))
    }

    fn place(&self, vertex: u32, u: &[f64]) -> Point {
        let (i, n) = (vertex as usize, self.surface.len());
        let rest = self.surface.positions()[i];
        std::array::from_fn(|c| rest[c] + u[c * n + i])
    }

    fn inverted(&self, u: &[f64]) -> usize {
        let turned = |triangle: [u32; 3]| {
            let rest = triangle.map(|vertex| self.surface.positions()[vertex as usize]);
            let (now, before) = (normal(self.deformed(triangle, u)), normal(rest));
            (0..3).map(|c| now[c] * before[c]).sum::<f64>() < 0.0
        };
        self.surface
            .triangles()
            .iter()
            .filter(|&&triangle| turned(triangle))
            .count()
    }

    fn overstretched(&self, u: &[f64]) -> usize {
        let length = |[a, b]: [u32; 2]| {
            let (a, b) = (self.place(a, u), self.place(b, u));
            norm(std::array::from_fn(|c| b[c] - a[c]))
        };
        self.edges
            .iter()
            .filter(|&&[a, b]| length([a, b]) > 2.0 * self.surface.chord(a as usize, b as usize))
            .count()
    }

    fn zones(&self, energy: &[f64], areas: &[f64]) -> Vec<EnergyZone> {
        let total: f64 = energy.iter().zip(areas).map(|(e, a)| e * a).sum();
        let mean = total / areas.iter().sum::<f64>();
        let hot = |i: u32| energy[i as usize] > CONCENTRATED * mean;
        // Root of each vertex's zone: the lowest-numbered vertex.
        let mut root: Vec<u32> = (0..energy.len() as u32).collect();
        for &[a, b] in self.edges.iter().filter(|&&[a, b]| hot(a) && hot(b)) {
            let (a, b) = (find(&mut root, a), find(&mut root, b));
            root[a.max(b) as usize] = a.min(b);
        }
        let mut zones: Vec<(u32, EnergyZone)> = Vec::new();
        for i in (0..energy.len() as u32).filter(|&i| hot(i)) {
            let own = find(&mut root, i);
            let (position, area) = (self.surface.positions()[i as usize], areas[i as usize]);
            let place = zones.iter().position(|&(root, _)| root == own);
            let place = place.unwrap_or_else(|| {
                let empty = EnergyZone {
                    vertices: 0,
                    area: 0.0,
                    centre: [0.0; 3],
                };
                zones.push((own, empty));
                zones.len() - 1
            });
            let zone = &mut zones[place].1;
            zone.vertices += 1;
            zone.area += area;
            for c in 0..3 {
                zone.centre[c] += area * position[c];
            }
        }
        let mut zones: Vec<EnergyZone> = zones
            .into_iter()
            .map(|(_, zone)| EnergyZone {
                centre: zone.centre.map(|x| x / zone.area),
                ..zone
            })
            .collect();
        zones.sort_by(|a, b| b.area.total_cmp(&a.area));
        zones
    }
}

/// Returns largest over mean, and the fraction in the top vertices.
fn concentration(energy: &[f64], areas: &[f64]) -> (f64, f64) {
    let n = energy.len();
    let mean = energy.iter().sum::<f64>() / n as f64;
    if mean <= 0.0 {
        return (0.0, 0.0);
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| energy[b].total_cmp(&energy[a]).then(a.cmp(&b)));
    let top = ((TOP * n as f64).ceil() as usize).max(1);
    let held = |vertices: &[usize]| -> f64 { vertices.iter().map(|&i| energy[i] * areas[i]).sum() };
    (energy[order[0]] / mean, held(&order[..top]) / held(&order))
}

fn find(root: &mut [u32], mut i: u32) -> u32 {
    while root[i as usize] != i {
        root[i as usize] = root[root[i as usize] as usize];
        i = root[i as usize];
    }
    i
}

/// Margin of the energy estimate √E(0) + ∫ ‖b‖ ds/√(2ρ) − √E(t), J^½, with ‖b‖² = Σ A |b|² and ρ the lowest
/// density. It is never negative for an exact solution without supports, since d√E/dt = (b, u_t)/(2√E) ≤
/// ‖b‖/√(2ρ) (Coclite, Coclite, Maddalena, Politi 2022, equation 3.3; with 1/2 in place of 1/√(2ρ), as in their
/// 2.11, a uniform load on a body at rest violates it). The integral is computed by the trapezoidal rule over
/// the observed states.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EnergyBound {
    /// Accumulated ∫ ‖b‖ ds.
    pub impulse: f64,
    /// Time and ‖b‖ of the last state.
    pub last: Option<(f64, f64)>,
}

pericles::saved! {
    impl Entry<Number = f64> for EnergyBound { impulse, last }
}

impl EnergyBound {
    /// Returns the margin at a state. States must be passed in order of time.
    pub fn margin(&mut self, snapshot: &Snapshot<'_>) -> f64 {
        let (system, t) = (snapshot.system(), snapshot.state().t);
        let n = system.points();
        let mut load = vec![0.0; system.dimension() * n];
        system.external_acceleration_into(t, &mut load);
        let volumes = system.cloud().volumes();
        let mut square = 0.0;
        let mut lightest = f64::INFINITY;
        for (k, a) in load.iter().enumerate() {
            let density = system.density().at(k % n);
            square += volumes[k % n] * (density * a).powi(2);
            lightest = lightest.min(density);
        }
        let size = square.sqrt();
        if let Some((before, size_before)) = self.last {
            self.impulse += 0.5 * (t - before) * (size + size_before);
        }
        self.last = Some((t, size));
        let energies = snapshot.energies();
        let now = (energies.kinetic + energies.elastic + energies.dissipated).max(0.0);
        energies.initial.max(0.0).sqrt() + self.impulse / (2.0 * lightest).sqrt() - now.sqrt()
    }
}
