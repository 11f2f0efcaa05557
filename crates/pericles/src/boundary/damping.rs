//! Layers in which motion dies away: an approximate absorbing side of bodies in any dimension.

use super::{Boundary, Exchange, Stage, WithinStep};
use crate::error::{PericlesError, Result};
use crate::scalar::PointScalar;
use crate::space::{Face, PointCloud, PointSet, check_length};
use crate::step_end::{Path, StepEnd};
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

/// The steps that a layer is made for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampedSteps {
    /// Where within a step the scheme takes the forces.
    pub kind: StepKind,
    /// Length of the steps, s. Schemes of stages may take others; Runge–Kutta schemes are stable up to (ω dt/ℓ)² + σ dt/2 = 1, with their limit ω dt = ℓ without damping.
    pub dt: f64,
    /// The highest frequency of the body, 1/s, where it is known.
    pub frequency: Option<f64>,
}

/// ρ u_tt = f − σ ρ u_t in a layer along a side, σ = σ₀ (depth/L)^p.
///
/// Unlike an exact end it takes any body, law and dimension, and reflects: measure how much. The velocity that it damps is
///
/// | steps | velocity | work of the damping |
/// |---|---|---|
/// | velocity Verlet ([`StepKind::EndOfStep`]) | of the middle of the step before, so that the scheme stays explicit | exact |
/// | Runge–Kutta schemes, also with two time steps, Newmark by fixed-point iteration ([`StepKind::Stages`]) | of the stage: the order of the scheme is kept | of the order of the scheme, at most four |
/// | implicit midpoint and trapezoidal rule ([`StepKind::Middle`]) | of the middle of the step, part of the equation of the step | exact |
/// | r-RESPA ([`StepKind::Kicks`]), trigonometric ([`StepKind::Flow`]) | by e^(−σ dt/2) before and after each step: second order | exact |
pub struct DampingLayer {
    kind: StepKind,
    points: PointSet,
    /// σ of each point, 1/s.
    damping: Vec<f64>,
    /// Mass of each point, kg.
    mass: Vec<f64>,
    total: usize,
    dimension: usize,
    dt: f64,
    /// Accelerations by the damping, by component and point of the layer, and those of the step before.
    pull: Vec<f64>,
    pull_before: Vec<f64>,
    /// Displacements of the layer at the start of the step, where they are part of its equation.
    place: Vec<f64>,
    name: String,
}

impl DampingLayer {
    /// A layer along a side of a body's bounding box.
    ///
    /// # Errors
    /// [`PericlesError::BadDampingLayer`]: a side that the body does not have, a layer thinner than a cell or as thick as the body, a step that is unstable with the damping.
    pub fn new(
        cloud: &PointCloud,
        density: &PointScalar,
        face: Face,
        profile: DampingProfile,
        steps: DampedSteps,
    ) -> Result<Self> {
        if let PointScalar::PerPoint(densities) = density {
            check_length("the densities of the points", densities.len(), cloud.len())?;
        }
        let DampedSteps { kind, dt, .. } = steps;
        check(cloud, face, &profile, steps)
            .map_err(|reason| PericlesError::BadDampingLayer { reason })?;
        let depth = depths(cloud, face, profile.thickness);
        let points: PointSet = (0..cloud.len() as u32)
            .filter(|&i| depth[i as usize] > 0.0)
            .collect();
        let entries = cloud.dimension() * points.len();
        let at = |i: u32| i as usize;
        let remembered = if kind == StepKind::Middle { entries } else { 0 };
        Ok(Self {
            kind,
            damping: points.iter().map(|&i| profile.at(depth[at(i)])).collect(),
            mass: points
                .iter()
                .map(|&i| density.at(at(i)) * cloud.volumes()[at(i)])
                .collect(),
            total: cloud.len(),
            dimension: cloud.dimension(),
            dt,
            pull: vec![0.0; entries],
            pull_before: vec![0.0; entries],
            place: vec![0.0; remembered],
            name: format!("damping/{}", face_name(face)),
            points,
        })
    }

    /// Points in the layer.
    pub fn points(&self) -> usize {
        self.points.len()
    }

    /// Calls `visit(entry of the state's arrays, entry of the layer's arrays, number of the point in the layer)` for every entry of the layer.
    fn each(&self, mut visit: impl FnMut(usize, usize, usize)) {
        for c in 0..self.dimension {
            for (p, &i) in self.points.iter().enumerate() {
                visit(c * self.total + i as usize, c * self.points.len() + p, p);
            }
        }
    }

    fn acts_between_steps(&self) -> bool {
        matches!(self.kind, StepKind::Flow | StepKind::Kicks)
    }

    /// ∫ v dt (m) and ∫ v² dt (m²/s) of an entry over a step.
    fn integrals(&self, step: &StepEnd<'_>, entry: usize) -> (f64, f64) {
        let mean = step.mean_velocity(entry);
        match step.path {
            Path::Cubic { v, .. } if self.kind == StepKind::Stages => {
                let [first, last] = [v[0][entry], v[1][entry]];
                let middle = 1.5 * mean - 0.25 * (first + last);
                let square = first * first + 4.0 * middle * middle + last * last;
                (mean * step.dt, square * step.dt / 6.0)
            }
            _ => (mean * step.dt, mean * mean * step.dt),
        }
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
    DampedSteps {
        kind,
        dt,
        frequency,
    }: DampedSteps,
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
    if kind == StepKind::EndOfStep && phase > limit {
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
        let mut exchange = Exchange::default();
        if self.acts_between_steps() {
            return exchange;
        }
        if self.kind == StepKind::EndOfStep {
            std::mem::swap(&mut self.pull, &mut self.pull_before);
        }
        let mut pull = std::mem::take(&mut self.pull);
        let mut place = std::mem::take(&mut self.place);
        self.each(|entry, k, p| {
            let c = entry / self.total;
            let (mass, damping) = (self.mass[p], self.damping[p]);
            if self.kind == StepKind::EndOfStep {
                let velocity = step.mean_velocity(entry);
                pull[k] = -damping * velocity;
                let impulse = 0.5 * mass * (pull[k] + self.pull_before[k]) * step.dt;
                exchange.work += impulse * velocity;
                exchange.impulse[c] += impulse;
            } else {
                let (path, square) = self.integrals(step, entry);
                exchange.work -= mass * damping * square;
                exchange.impulse[c] -= mass * damping * path;
            }
            if let Some(place) = place.get_mut(k) {
                *place = step.u[entry];
            }
        });
        (self.pull, self.place) = (pull, place);
        exchange
    }

    fn after_stage(&mut self, stage: &Stage<'_>, acceleration: &mut [f64]) {
        if self.acts_between_steps() {
            return;
        }
        let count = self.points.len();
        for c in 0..self.dimension {
            stage.on.common(&self.points, |p, i| {
                let (entry, k) = (c * self.total + i, c * count + p);
                if self.kind != StepKind::EndOfStep {
                    self.pull[k] = -self.damping[p] * stage.v[entry];
                }
                acceleration[entry] += self.pull[k];
            });
        }
    }

    fn has_memory(&self) -> bool {
        matches!(self.kind, StepKind::EndOfStep | StepKind::Middle)
    }

    fn damp(&self, dt: f64, v: &mut [f64]) -> Exchange {
        let mut exchange = Exchange::default();
        if self.acts_between_steps() {
            self.each(|entry, _, p| {
                let (mass, before) = (self.mass[p], v[entry]);
                v[entry] *= (-self.damping[p] * dt).exp();
                exchange.work += 0.5 * mass * (v[entry] * v[entry] - before * before);
                exchange.impulse[entry / self.total] += mass * (v[entry] - before);
            });
        }
        exchange
    }

    fn step_kinds(&self) -> &'static [StepKind] {
        match self.kind {
            StepKind::Stages => &[StepKind::Stages],
            StepKind::Middle => &[StepKind::Middle],
            StepKind::EndOfStep => &[StepKind::EndOfStep],
            StepKind::Flow => &[StepKind::Flow],
            StepKind::Kicks => &[StepKind::Kicks],
        }
    }

    fn within_step(&self) -> Option<&dyn WithinStep> {
        (self.kind == StepKind::Middle).then_some(self)
    }
}

/// With u₀ at the start and u at the middle of the step the velocity of the middle is 2 (u − u₀)/dt: S = 2 σ/dt.
impl WithinStep for DampingLayer {
    fn add_present(&self, acceleration: &mut [f64]) {
        self.each(|entry, k, _| acceleration[entry] += self.pull[k]);
    }

    fn add_middle(&self, u: &[f64], acceleration: &mut [f64]) {
        let twice = 2.0 / self.dt;
        self.each(|entry, k, p| {
            acceleration[entry] -= twice * self.damping[p] * (u[entry] - self.place[k]);
        });
    }

    fn add_stiffness(&self, u: &[f64], out: &mut [f64]) {
        let twice = 2.0 / self.dt;
        self.each(|entry, _, p| out[entry] += twice * self.damping[p] * u[entry]);
    }
}

crate::saved! {
    impl Saved for DampingLayer {
        pull: array("{name}/pull"),
        place: array("{name}/place"),
        kind, points, damping, mass, total, dimension, dt, name: fixed,
        pull_before: scratch,
    }
}
