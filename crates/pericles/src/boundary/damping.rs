//! Layers in which motion dies away: an approximate absorbing side of bodies in any dimension.

use super::{Boundary, Exchange};
use crate::error::{PericlesError, Result};
use crate::scalar::PointScalar;
use crate::space::{Face, PointCloud, check_length};
use crate::step_end::StepEnd;
use crate::step_kind::StepKind;

/// How the damping of a layer grows inwards from its inner face to the side of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampingProfile {
    /// Depth of the layer, m.
    pub thickness: f64,
    /// The damping at the side of the body, 1/s.
    pub strength: f64,
    /// The power with which it grows.
    pub power: f64,
}

impl DampingProfile {
    /// The profile that lets waves of speed c (m/s), which meet it head on and are long against the spacing and short against the layer, come back from the body's side with the given share
    /// of their amplitude: R = exp(−σ L/((p + 1) c)).
    ///
    /// Slower waves are damped more, and so are waves at an angle φ, which stay longer in the layer: R^{1/cos φ}. But the layer's growth itself reflects waves that are as long as it is deep, and
    /// waves that graze it, the more the smaller R is asked for.
    pub fn of_reflection(thickness: f64, reflection: f64, power: f64, speed: f64) -> Self {
        Self {
            thickness,
            strength: -reflection.ln() * (power + 1.0) * speed / thickness,
            power,
        }
    }

    /// σ at a depth below the inner face, 1/s.
    pub fn at(&self, depth: f64) -> f64 {
        self.strength * (depth / self.thickness).clamp(0.0, 1.0).powf(self.power)
    }

    /// The largest stable ω dt of velocity Verlet with the damping of the step before: (ω dt)² < 4 − 2 σ dt.
    pub fn stability_limit(&self, dt: f64) -> f64 {
        (4.0 - 2.0 * self.strength * dt).max(0.0).sqrt()
    }
}

/// ρ u_tt = f − σ ρ u_t in a layer along a side, σ = σ₀ (depth/L)^p.
///
/// The velocity is that of the middle of the step before, so that the scheme stays explicit, and the work of the damping in each step is known exactly. Unlike an exact end it takes any
/// body, law and dimension, and reflects: measure how much.
pub struct DampingLayer {
    points: Vec<usize>,
    /// σ of each point, 1/s.
    damping: Vec<f64>,
    /// Mass of each point, kg.
    mass: Vec<f64>,
    total: usize,
    dimension: usize,
    /// Accelerations by the damping, by component and point of the layer, and those of the step before.
    pull: Vec<f64>,
    pull_before: Vec<f64>,
    name: String,
}

impl DampingLayer {
    /// A layer along a side of a body's bounding box, for steps dt of a body whose highest frequency is ω (1/s) where it is known.
    ///
    /// # Errors
    /// [`PericlesError::BadDampingLayer`]: a side that the body does not have, a layer thinner than a cell or as thick as the body, a step that is unstable with the damping.
    pub fn new(
        cloud: &PointCloud,
        density: &PointScalar,
        face: Face,
        profile: DampingProfile,
        dt: f64,
        frequency: Option<f64>,
    ) -> Result<Self> {
        if let PointScalar::PerPoint(densities) = density {
            check_length("the densities of the points", densities.len(), cloud.len())?;
        }
        check(cloud, face, &profile, dt, frequency)
            .map_err(|reason| PericlesError::BadDampingLayer { reason })?;
        let depth = depths(cloud, face, profile.thickness);
        let points: Vec<usize> = (0..cloud.len()).filter(|&i| depth[i] > 0.0).collect();
        let entries = cloud.dimension() * points.len();
        Ok(Self {
            damping: points.iter().map(|&i| profile.at(depth[i])).collect(),
            mass: points
                .iter()
                .map(|&i| density.at(i) * cloud.volumes()[i])
                .collect(),
            total: cloud.len(),
            dimension: cloud.dimension(),
            pull: vec![0.0; entries],
            pull_before: vec![0.0; entries],
            name: format!("damping/{}", face_name(face)),
            points,
        })
    }

    /// Points in the layer.
    pub fn points(&self) -> usize {
        self.points.len()
    }
}

fn face_name(face: Face) -> String {
    let sign = if face.upper { '+' } else { '-' };
    format!("{sign}{}", ['x', 'y', 'z'][face.axis])
}

fn check(
    cloud: &PointCloud,
    face: Face,
    profile: &DampingProfile,
    dt: f64,
    frequency: Option<f64>,
) -> std::result::Result<(), String> {
    let (name, dimension) = (face_name(face), cloud.dimension());
    if face.axis >= dimension {
        return Err(format!("a body in {dimension}D has no side {name}"));
    }
    let [low, high] = extent(cloud, face.axis);
    let (thickness, most) = (profile.thickness, high - low);
    let cell = cloud.cell_side(face.axis);
    if !(thickness >= cell && thickness < most) {
        return Err(format!(
            "its thickness at {name} is {thickness:e} m; allowed: from a cell, {cell:e} m, to less than the body, {most:e} m"
        ));
    }
    let (phase, limit) = (frequency.unwrap_or(0.0) * dt, profile.stability_limit(dt));
    if phase > limit {
        return Err(format!(
            "with its damping of up to {:.4e} 1/s the step {dt:e} s is unstable: ω dt is {phase:.4} for the highest frequency of the body, allowed are {limit:.4}; make the layer \
             thicker, its reflection larger, or the step smaller (time.safety)",
            profile.strength
        ));
    }
    Ok(())
}

/// Where a body begins and ends along an axis, m.
fn extent(cloud: &PointCloud, axis: usize) -> [f64; 2] {
    let (axis, half) = (cloud.axis(axis), 0.5 * cloud.cell_side(axis));
    let low = axis.iter().fold(f64::INFINITY, |a, x| a.min(*x));
    let high = axis.iter().fold(f64::NEG_INFINITY, |a, x| a.max(*x));
    [low - half, high + half]
}

/// How deep each point lies below the inner face of a layer, m; not positive outside.
fn depths(cloud: &PointCloud, face: Face, thickness: f64) -> Vec<f64> {
    let axis = cloud.axis(face.axis);
    let [low, high] = extent(cloud, face.axis);
    let outwards = |x: &f64| if face.upper { high - x } else { x - low };
    axis.iter().map(|x| thickness - outwards(x)).collect()
}

impl Boundary for DampingLayer {
    fn accept(&mut self, step: &StepEnd<'_>) -> Exchange {
        std::mem::swap(&mut self.pull, &mut self.pull_before);
        let mut exchange = Exchange::default();
        let count = self.points.len();
        for c in 0..self.dimension {
            for (p, &i) in self.points.iter().enumerate() {
                let velocity = step.mean_velocity(c * self.total + i);
                let k = c * count + p;
                self.pull[k] = -self.damping[p] * velocity;
                let impulse = 0.5 * self.mass[p] * (self.pull[k] + self.pull_before[k]) * step.dt;
                exchange.work += impulse * velocity;
                exchange.impulse[c] += impulse;
            }
        }
        exchange
    }

    fn after_stage(&mut self, _t: f64, _u: &[f64], _v: &[f64], acceleration: &mut [f64]) {
        let count = self.points.len();
        for c in 0..self.dimension {
            for (p, &i) in self.points.iter().enumerate() {
                acceleration[c * self.total + i] += self.pull[c * count + p];
            }
        }
    }

    fn step_kinds(&self) -> &'static [StepKind] {
        &[StepKind::EndOfStep]
    }
}

crate::saved! {
    impl Saved for DampingLayer {
        pull: array("{name}/pull"),
        points, damping, mass, total, dimension, name: fixed,
        pull_before: scratch,
    }
}
