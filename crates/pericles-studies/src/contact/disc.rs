//! The brittle disc of LAMMPS' peridynamic example (Parks et al. 2008), struck by an indenter or by a steel ball.

use std::sync::Arc;

use pericles::family::VolumeCorrection;
use pericles::material::{BondMaterial, ElasticModulus};
use pericles::operator::{DamageMeasure, Force, PointSubset};
use pericles::space::PointCloud;
use pericles::time::{State, VelocityVerlet};
use pericles::{Body, Configuration, Interaction, PointScalar, Simulation, System};
use pericles_contact::{
    ContactBodies, ContactLaw, ContactPairs, Impactor, ImpactorMotion, Inertia, PairLaw,
    PointContact, Pose, Shape,
};
use pericles_run::RunError;

use crate::common::{finish, watch};
use crate::data::{Case, Found};

/// Radius of indenter and ball, m.
const RADIUS: f64 = 1.5e-3;
/// Their speed, m/s.
const SPEED: f64 = 100.0;
/// Horizon (m), density (kg/m³) and micromodulus (N/m⁶) of the disc.
const HORIZON: f64 = 1.5001e-3;
const DENSITY: f64 = 2200.0;
const MICROMODULUS: f64 = 1.6863e22;

/// Force density 1e17 (R − r)² along the direction from the centre (0, 1.55 mm − 100 m/s t, 0) of LAMMPS' indenter.
struct Indenter {
    cloud: Arc<PointCloud>,
}

impl Indenter {
    /// Force density per overlap squared, N/m⁵.
    const STIFFNESS: f64 = 1e17;

    /// Calls `visit` with the number, direction and overlap of each point in the ball.
    fn each(&self, at: &Configuration<'_>, mut visit: impl FnMut(usize, [f64; 3], f64)) {
        let n = self.cloud.len();
        let centre = [0.0, 1.55e-3 - SPEED * at.t, 0.0];
        for i in 0..n {
            let q: [f64; 3] =
                std::array::from_fn(|c| self.cloud.axis(c)[i] + at.u[c * n + i] - centre[c]);
            let r = q.iter().map(|q| q * q).sum::<f64>().sqrt();
            if r < RADIUS {
                visit(i, q.map(|q| q / r), RADIUS - r);
            }
        }
    }
}

impl Interaction for Indenter {
    fn name(&self) -> &str {
        "indenter"
    }

    fn check(&self, _forces: &dyn Force) -> pericles::Result<()> {
        Ok(())
    }

    fn add_force(&self, at: &Configuration<'_>, _on: &PointSubset<'_>, out: &mut [f64]) {
        let n = self.cloud.len();
        self.each(at, |i, normal, g| {
            for c in 0..3 {
                out[c * n + i] += Self::STIFFNESS * g * g * normal[c];
            }
        });
    }

    fn energy(&self, at: &Configuration<'_>) -> f64 {
        let mut sum = 0.0;
        self.each(at, |i, _, g| {
            sum += self.cloud.volumes()[i] * Self::STIFFNESS * g.powi(3) / 3.0;
        });
        sum
    }

    fn add_tangent(&self, _at: &Configuration<'_>, _direction: &[f64], _out: &mut [f64]) {}

    fn contact_frequency(&self, _density: &PointScalar) -> f64 {
        0.0
    }

    fn is_conservative(&self) -> bool {
        true
    }

    fn overlap(&self) -> f64 {
        0.0
    }
}

// Studies are not resumed.
pericles::saved! {
    impl Checkpointed for Indenter {
        cloud: fixed,
    }
}

/// Points (i, j, k) in units of 0.5 mm with i² + k² ≤ 100 and −10 ≤ j ≤ 0, with contact by the given law.
fn disc(law: ContactLaw) -> Result<(System, Arc<PointCloud>, ContactBodies), RunError> {
    const SPACING: f64 = 0.5e-3;
    let mut places: Vec<[f64; 3]> = Vec::new();
    for i in -10..=10 {
        for j in -10..=0 {
            for k in -10..=10 {
                if i * i + k * k <= 100 {
                    places.push([i, j, k].map(|x| SPACING * f64::from(x)));
                }
            }
        }
    }
    let n = places.len();
    let x = (0..3).flat_map(|c| places.iter().map(move |place| place[c]));
    let cloud = PointCloud::new(3, x.collect(), vec![SPACING.powi(3); n], 1.0)?;
    let cloud = Arc::new(cloud);
    // c = 12 E/(π δ⁴)
    let young = MICROMODULUS * std::f64::consts::PI * HORIZON.powi(4) / 12.0;
    let mut material = BondMaterial::new(ElasticModulus::Young(young), DENSITY, HORIZON)
        .with_critical_stretch(5e-4);
    material.volume_correction = VolumeCorrection::Linear;
    let count = DamageMeasure {
        count: true,
        count_precut: false,
    };
    let mut system = Body::new(cloud.clone(), material).damage(count).build()?;
    let bodies = ContactBodies::uniform(n, young, HORIZON, DENSITY);
    let contact = PointContact::new(cloud.clone(), law, bodies.clone())?;
    system.add_interaction(Box::new(contact))?;
    Ok((system, cloud, bodies))
}

fn damage(now: &Simulation) -> f64 {
    let mut damage = vec![0.0; now.system().points()];
    now.system().operator().damage_into(&mut damage);
    damage.iter().sum::<f64>() / damage.len() as f64
}

/// Mean damage, momentum along the impact and kinetic energy of the disc under the indenter after the given number of
/// steps of 0.1 µs.
pub(super) fn indenter(case: &Case<'_>) -> Result<Found, RunError> {
    let law = ContactLaw {
        pairs: ContactPairs::All,
        law: PairLaw::Emu,
        distance: 1.35,
        closing: 0.9,
        ..ContactLaw::default()
    };
    let (mut system, cloud, _) = disc(law)?;
    system.add_interaction(Box::new(Indenter { cloud }))?;
    let state = State::of(&system);
    let steps = case.count("steps")? as u64;
    // The work of the moving indenter is not recorded.
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), state, 1e-7, steps)?
        .allowing_instability();
    finish(&mut run)?;
    Ok([
        ("damage", damage(&run)),
        ("momentum", run.system().momentum(&run.state().v)[1]),
        ("kinetic", run.snapshot().energies().kinetic),
    ]
    .into())
}

/// Velocity with which a steel ball rebounds from the disc that it breaks, and relative errors of momentum and energy.
pub(super) fn ball(case: &Case<'_>) -> Result<Found, RunError> {
    let dt = case.number("dt")?;
    let law = ContactLaw::default();
    let (mut system, cloud, bodies) = disc(law)?;
    let free = ImpactorMotion::Free {
        inertia: Inertia::Density(7850.0),
        velocity: [0.0, -SPEED, 0.0],
        spin: [0.0; 3],
    };
    let (shape, pose) = (Shape::Ball { radius: RADIUS }, Pose::at([0.0, 1.8e-3, 0.0]));
    let ball = Impactor::new("ball", shape, pose, free, cloud, law, bodies)?;
    system.add_interaction(Box::new(ball))?;
    let state = State::of(&system);
    let steps = (1e-4 / dt).round() as u64;
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), state, dt, steps)?;
    let momentum = |now: &Simulation| {
        let bodies = now.system().interactions().map(|one| one.momentum()[1]);
        now.system().momentum(&now.state().v)[1] + bodies.sum::<f64>()
    };
    let (first, mut worst) = (momentum(&run), 0.0f64);
    watch(&mut run, |now| {
        let energies = now.snapshot().energies();
        worst = worst.max(energies.balance().abs() / energies.initial);
    })?;
    let mut all = run.system().interactions();
    let reading = all.find_map(|one| one.downcast_ref::<Impactor>().map(Impactor::reading));
    Ok(Found::default()
        .value("velocity", reading.map(|reading| reading.velocity[1]))
        .value("first", first)
        .value("momentum", momentum(&run) / first - 1.0)
        .value("balance", worst)
        .value("damage", damage(&run)))
}
