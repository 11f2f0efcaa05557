//! Damping layers: approximate absorbing boundaries for bodies of any dimension.

use super::{Boundary, Exchange, ImplicitBoundary, Stage};
use crate::archive::Laid;
use crate::domain::Domain;
use crate::error::{PericlesError, Result};
use crate::scalar::PointScalar;
use crate::space::{Face, PointCloud, PointSet, check_length};
use crate::step_end::{Path, StepEnd};
use crate::step_kind::StepKind;
use crate::units::{quantity, significant};

/// Profile of the damping in a layer: it grows from the inner face to the side of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampingProfile {
    /// Thickness of the layer, m.
    pub thickness: f64,
    /// Damping at the side of the body, 1/s.
    pub strength: f64,
    /// Exponent of the profile.
    pub power: f64,
}

impl DampingProfile {
    /// Returns the profile with a given reflection coefficient R (ratio of amplitudes) for waves of speed c (m/s)
    /// at normal incidence: R = exp(−σ L/((p + 1) c)).
    ///
    /// It holds for wavelengths that are long compared with the spacing and short compared with the layer. Slower
    /// waves are damped more, and so are waves at an angle φ to the normal, whose path is longer: R^{1/cos φ}. The
    /// growth of σ itself reflects waves as long as the layer is thick, and waves at grazing incidence, the more
    /// the smaller R is.
    pub fn of_reflection(thickness: f64, reflection: f64, power: f64, speed: f64) -> Self {
        Self {
            thickness,
            strength: -reflection.ln() * (power + 1.0) * speed / thickness,
            power,
        }
    }

    /// Returns σ at a depth below the inner face, 1/s.
    pub fn at(&self, depth: f64) -> f64 {
        self.strength * (depth / self.thickness).clamp(0.0, 1.0).powf(self.power)
    }

    /// Largest stable ω dt of velocity Verlet with the damping velocity of the previous step: (ω dt)² < 4 − 2 σ dt.
    pub fn stability_limit(&self, dt: f64) -> f64 {
        (4.0 - 2.0 * self.strength * dt).max(0.0).sqrt()
    }
}

/// The time steps for which a layer is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampedSteps {
    /// Kind of step of the scheme.
    pub kind: StepKind,
    /// Time step, s. Schemes with stages may use others: Runge–Kutta schemes are stable up to (ω dt/ℓ)² + σ dt/2 =
    /// 1, where ℓ is their limit of ω dt without damping.
    pub dt: f64,
    /// Highest frequency of the body, 1/s, if known.
    pub frequency: Option<f64>,
}

/// Damping layer along a side: ρ u_tt = f − σ ρ u_t with σ = σ₀ (depth/L)^p.
///
/// Unlike an exact absorbing boundary it supports any body, law and dimension, but reflects a small part of the
/// waves. The damped velocity depends on the scheme:
///
/// | steps | damped velocity | work of the damping |
/// |---|---|---|
/// | velocity Verlet ([`StepKind::EndOfStep`]) | at the middle of the previous step, so that the scheme stays explicit | exact |
/// | Runge–Kutta schemes, also multirate, and Newmark by fixed-point iteration ([`StepKind::Stages`]) | at the stage, which keeps the order of the scheme | of the order of the scheme, at most four |
/// | implicit midpoint and trapezoidal rule ([`StepKind::Middle`]) | at the middle of the step, part of the equation of the step | exact |
/// | r-RESPA ([`StepKind::Kicks`]), trigonometric ([`StepKind::Flow`]) | factor e^(−σ dt/2) before and after each step: second order | exact |
pub struct DampingLayer {
    kind: StepKind,
    points: PointSet,
    /// σ of each point of the layer, 1/s.
    damping: Vec<f64>,
    /// Mass of each point of the layer, kg.
    mass: Vec<f64>,
    total: usize,
    dimension: usize,
    dt: f64,
    /// Accelerations due to the damping, by component and point of the layer, and the accelerations of the previous step.
    pull: Vec<f64>,
    pull_before: Vec<f64>,
    /// Displacements of the layer at the start of the step, for schemes whose equation includes the damping.
    place: Vec<f64>,
    name: String,
    domain: Domain,
}

impl DampingLayer {
    /// Makes a layer along a side of the bounding box of a body.
    ///
    /// # Errors
    /// [`PericlesError::BadDampingLayer`]: a side that the body does not have, a layer thinner than a cell or as
    /// thick as the body, a step that is unstable with the damping.
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
            name: format!("damping/{face}"),
            domain: cloud.domain().clone(),
            points,
        })
    }

    /// Number of points in the layer.
    pub fn points(&self) -> usize {
        self.points.len()
    }

    /// Returns the points of the layer, each with its damping σ, 1/s.
    pub fn damped(&self) -> impl Iterator<Item = (usize, f64)> {
        let points = self.points.iter().map(|&i| i as usize);
        points.zip(self.damping.iter().copied())
    }

    /// Accelerations due to the damping at the last accepted state, m/s²: component c of the k-th point of the layer is
    /// entry c · (points of the layer) + k.
    pub fn pull_mut(&mut self) -> &mut [f64] {
        &mut self.pull
    }

    /// Returns [`DampingLayer::pull_mut`] for reading.
    pub fn pull(&self) -> &[f64] {
        &self.pull
    }

    /// Calls `visit(entry of the state's arrays, entry of the layer's arrays, index of the point in the layer)` for
    /// every entry of the layer.
    fn each(&self, mut visit: impl FnMut(usize, usize, usize)) {
        for c in 0..self.dimension {
            for (p, &i) in self.points.iter().enumerate() {
                visit(c * self.total + i as usize, c * self.points.len() + p, p);
            }
        }
    }

    /// Returns the totals of one impulse and work per entry of the layer.
    fn total(&self, impulses: &[f64], works: &[f64]) -> Exchange {
        Exchange::total(&self.domain, self.points.len(), impulses, works)
    }

    fn acts_between_steps(&self) -> bool {
        matches!(self.kind, StepKind::Flow | StepKind::Kicks)
    }

    /// Returns ∫ v dt (m) and ∫ v² dt (m²/s) of an entry over a step.
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
    let (name, dimension) = (face, cloud.dimension());
    if face.axis >= dimension {
        return Err(format!("a {dimension}D body has no side {name}"));
    }
    let [low, high] = extent(cloud, face.axis);
    let (thickness, most) = (profile.thickness, high - low);
    let cell = cloud.cell_side(face.axis);
    if !(thickness >= cell && thickness < most) {
        return Err(format!(
            "the thickness at {name} is {}; allowed: from one cell, {}, to less than the body, {}",
            quantity(thickness, "m"),
            quantity(cell, "m"),
            quantity(most, "m")
        ));
    }
    let (phase, limit) = (frequency.unwrap_or(0.0) * dt, profile.stability_limit(dt));
    if kind == StepKind::EndOfStep && phase > limit {
        return Err(format!(
            "with a damping of up to {} 1/s the time step {} is unstable: ω dt is {} for the highest frequency of the body; allowed: {}. Use a thicker layer, a larger reflection \
             or a smaller step (time.safety)",
            significant(profile.strength, 4),
            quantity(dt, "s"),
            significant(phase, 4),
            significant(limit, 4)
        ));
    }
    Ok(())
}

/// Lower and upper end of a body along an axis, m. All processes must call it together.
fn extent(cloud: &PointCloud, axis: usize) -> [f64; 2] {
    let domain = cloud.domain();
    let (axis, half) = (cloud.axis(axis), 0.5 * cloud.cell_side(axis));
    let low = axis.iter().fold(f64::INFINITY, |a, x| a.min(*x));
    let high = axis.iter().fold(f64::NEG_INFINITY, |a, x| a.max(*x));
    [-domain.max(-low) - half, domain.max(high) + half]
}

/// Returns the depth of each point below the inner face of a layer, m; not positive outside the layer.
fn depths(cloud: &PointCloud, face: Face, thickness: f64) -> Vec<f64> {
    let axis = cloud.axis(face.axis);
    let [low, high] = extent(cloud, face.axis);
    let outwards = |x: &f64| if face.upper { high - x } else { x - low };
    axis.iter().map(|x| thickness - outwards(x)).collect()
}

impl Boundary for DampingLayer {
    fn accept(&mut self, step: &StepEnd<'_>) -> Exchange {
        if self.acts_between_steps() {
            return Exchange::default();
        }
        if self.kind == StepKind::EndOfStep {
            std::mem::swap(&mut self.pull, &mut self.pull_before);
        }
        let mut pull = std::mem::take(&mut self.pull);
        let mut place = std::mem::take(&mut self.place);
        let [mut impulses, mut works] = [const { Vec::new() }; 2];
        self.each(|entry, k, p| {
            let (mass, damping) = (self.mass[p], self.damping[p]);
            if self.kind == StepKind::EndOfStep {
                let velocity = step.mean_velocity(entry);
                pull[k] = -damping * velocity;
                let impulse = 0.5 * mass * (pull[k] + self.pull_before[k]) * step.dt;
                works.push(impulse * velocity);
                impulses.push(impulse);
            } else {
                let (path, square) = self.integrals(step, entry);
                works.push(-mass * damping * square);
                impulses.push(-mass * damping * path);
            }
            if let Some(place) = place.get_mut(k) {
                *place = step.u[entry];
            }
        });
        (self.pull, self.place) = (pull, place);
        self.total(&impulses, &works)
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
        if !self.acts_between_steps() {
            return Exchange::default();
        }
        let [mut impulses, mut works] = [const { Vec::new() }; 2];
        self.each(|entry, _, p| {
            let (mass, before) = (self.mass[p], v[entry]);
            v[entry] *= (-self.damping[p] * dt).exp();
            works.push(0.5 * mass * (v[entry] * v[entry] - before * before));
            impulses.push(mass * (v[entry] - before));
        });
        self.total(&impulses, &works)
    }

    fn as_layer(&self) -> Option<&DampingLayer> {
        (self.kind == StepKind::EndOfStep).then_some(self)
    }

    fn as_layer_mut(&mut self) -> Option<&mut DampingLayer> {
        (self.kind == StepKind::EndOfStep).then_some(self)
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

    fn within_step(&self) -> Option<&dyn ImplicitBoundary> {
        (self.kind == StepKind::Middle).then_some(self)
    }
}

/// With u₀ at the start of the step and u at its middle the velocity at the middle is 2 (u − u₀)/dt, hence S = 2
/// σ/dt.
impl ImplicitBoundary for DampingLayer {
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
    impl Checkpointed for DampingLayer {
        pull: by(Laid::on(format!("{name}/pull"), points)),
        place: by(Laid::on(format!("{name}/place"), points)),
        kind, points, damping, mass, total, dimension, dt, name, domain: fixed,
        pull_before: scratch,
    }
}
