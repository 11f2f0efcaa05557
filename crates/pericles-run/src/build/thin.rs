//! Thin parts of bodies: sides of few horizons, and layers that bonds bridge.

use pericles::vector::norm;
use std::collections::HashMap;

use pericles::material::{ElasticConstants, StressState, SurfaceCorrection};
use pericles::operator::Force;
use pericles::space::PointCloud;
use pericles_deck::{Caution, KeyPath, ModelWarning, Remark, Solid};

use super::assembler::Assembler;

impl Assembler<'_> {
    /// Warns of a thin state-based body whose stiffness in tension along its longest side differs from the material's,
    /// because most of its points have incomplete families. All processes must call it together.
    pub(super) fn check_thin(
        &self,
        solid: &Solid,
        cloud: &PointCloud,
        (operator, elastic): (&dyn Force, &ElasticConstants),
    ) -> Option<ModelWarning> {
        /// Sides in horizons above which surfaces have little influence.
        const THICK: f64 = 4.0;
        const LARGE: f64 = 0.05;
        let (horizon, d) = (solid.material.horizon(), cloud.dimension());
        let [low, high] = cloud.bounds();
        let side = |c: usize| high[c] - low[c] + cloud.spacing();
        let long = (0..d).max_by(|&a, &b| side(a).total_cmp(&side(b)))?;
        let short = (0..d).map(side).fold(f64::INFINITY, f64::min);
        let is_corrected = solid.material.surface_correction != SurfaceCorrection::None;
        if d == 1 || is_corrected || short >= THICK * horizon {
            return None;
        }
        let ratio = stiffness_along(long, solid.state, cloud, horizon, (operator, elastic))?;
        let caution = Caution::ThinBody {
            sides: short / horizon,
            error: ratio - 1.0,
        };
        ((ratio - 1.0).abs() > LARGE).then(|| Remark::new("material.horizon", caution))
    }

    /// Warns of layers of another material that bonds bridge.
    pub(super) fn check_layers(&self, solid: &Solid, cloud: &PointCloud, of_point: Option<&[u8]>) {
        /// Share of the points of a layer that are bridged.
        const MOST: f64 = 0.5;
        let Some(of_point) = of_point else { return };
        let others = self.model.materials.iter();
        let horizons = others.map(|other| other.model.horizon());
        let horizon = horizons.fold(solid.material.horizon(), f64::max);
        // Bonds extend to half a spacing beyond the horizon with most volume corrections.
        let reach = solid.material.volume_correction();
        let reach = reach.reach(horizon, cloud.spacing()) * (1.0 - 1e-9);
        let share = bridged(cloud, of_point, reach);
        let names = self.model.materials.iter().map(|other| other.name.as_str());
        for (name, share) in std::iter::once(solid.material.name())
            .chain(names)
            .zip(share)
        {
            let assigned = self.model.assigned_materials().into_iter();
            let assigned: Vec<_> = assigned
                .filter(|(_, _, material)| *material == name)
                .collect();
            let mut sets = assigned.iter().flat_map(|(_, sets, _)| *sets);
            if share > MOST && !sets.any(|set| self.model.has_layer(set)) {
                let path = assigned.last().map(|(path, _, _)| path.clone());
                let path = path.unwrap_or_else(|| KeyPath::from("materials").key(name));
                let material = name.to_owned();
                self.warn(path, Caution::BridgedLayer { material, horizon });
            }
        }
    }
}

/// Returns the energy of uniaxial tension along an axis at points far from the ends, relative to that of the material; `None` for
/// bodies without such points. All processes must call it together.
fn stiffness_along(
    axis: usize,
    state: StressState,
    cloud: &PointCloud,
    horizon: f64,
    (operator, elastic): (&dyn Force, &ElasticConstants),
) -> Option<f64> {
    /// Small enough for all strain measures.
    const STRAIN: f64 = 1e-6;
    let (n, d) = (cloud.len(), cloud.dimension());
    let (mut young, mut contraction) = (elastic.young(), elastic.poisson_ratio());
    if state == StressState::PlaneStrain {
        young /= 1.0 - contraction * contraction;
        contraction /= 1.0 - contraction;
    }
    let mut u = vec![0.0; d * n];
    for c in 0..d {
        let strain = if c == axis {
            STRAIN
        } else {
            -contraction * STRAIN
        };
        for (u, x) in u[c * n..(c + 1) * n].iter_mut().zip(cloud.axis(c)) {
            *u = strain * x;
        }
    }
    let mut energy = vec![0.0; n];
    operator.add_energy_density(0.0, &u, &mut energy);
    let [low, high] = cloud.bounds();
    let is_inside = |i: usize| {
        let x = cloud.axis(axis)[i];
        x > low[axis] + 2.0 * horizon && x < high[axis] - 2.0 * horizon
    };
    let volumes = cloud.volumes();
    let total = |of: &(dyn Fn(usize) -> f64 + Sync)| {
        cloud.domain().sum(n, |i| {
            if is_inside(i) {
                volumes[i] * of(i)
            } else {
                0.0
            }
        })
    };
    let volume = total(&|_| 1.0);
    (volume > 0.0).then(|| total(&|i| energy[i]) / (volume * 0.5 * young * STRAIN * STRAIN))
}

/// Returns the share of the points of each material that lie between two points of other materials which are on opposite sides and
/// within the reach of bonds of each other.
fn bridged(cloud: &PointCloud, of_point: &[u8], reach: f64) -> Vec<f64> {
    /// Points of each material that are examined.
    const SAMPLE: usize = 500;
    /// Cosine of the largest angle between opposite directions and a straight line.
    const OPPOSITE: f64 = -0.95;
    let materials = of_point.iter().copied().max().map_or(0, usize::from) + 1;
    let cell = |x: [f64; 3]| x.map(|x| (x / reach).floor() as i64);
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for i in 0..cloud.len() {
        cells
            .entry(cell(cloud.point(i)))
            .or_default()
            .push(i as u32);
    }
    let is_bridged = |i: usize| {
        let (own, x) = (of_point[i], cloud.point(i));
        let [a, b, c] = cell(x);
        let mut others: Vec<[f64; 3]> = Vec::new();
        for da in -1..=1 {
            for db in -1..=1 {
                for dc in -1..=1 {
                    let found = cells.get(&[a + da, b + db, c + dc]);
                    let found = found.into_iter().flatten().map(|&j| j as usize);
                    for j in found.filter(|&j| of_point[j] != own) {
                        let y = cloud.point(j);
                        let xi: [f64; 3] = std::array::from_fn(|k| y[k] - x[k]);
                        if norm(xi) < reach {
                            others.push(xi);
                        }
                    }
                }
            }
        }
        others.iter().enumerate().any(|(k, p)| {
            others[..k].iter().any(|q| {
                let (a, b) = (norm(*p), norm(*q));
                let dot: f64 = (0..3).map(|c| p[c] * q[c]).sum();
                a + b < reach && dot < OPPOSITE * a * b
            })
        })
    };
    (0..materials)
        .map(|number| {
            let points: Vec<usize> = (0..cloud.len())
                .filter(|&i| usize::from(of_point[i]) == number)
                .collect();
            let sample: Vec<usize> = points
                .iter()
                .copied()
                .step_by(points.len().div_ceil(SAMPLE).max(1))
                .collect();
            let found = sample.iter().filter(|&&i| is_bridged(i)).count();
            found as f64 / sample.len().max(1) as f64
        })
        .collect()
}
