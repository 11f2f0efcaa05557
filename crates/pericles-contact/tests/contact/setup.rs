//! Bodies of the tests.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use pericles::boundary::{Load, MotionKind};
use pericles::prelude::*;
use pericles::{PointScalar, Simulation};
use pericles_contact::{
    ContactBodies, ContactLaw, Impactor, ImpactorMotion, PointContact, Pose, Shape,
};

use crate::bonded::Bonded;

/// A law with the frequency of the default stiffness.
pub const ELASTIC: ContactLaw = ContactLaw {
    pairs: pericles_contact::ContactPairs::Unbonded,
    law: pericles_contact::PairLaw::Linear,
    stiffness: pericles_contact::ContactStiffness::Relative(2.25),
    distance: 1.0,
    closing: 1.0,
    damping: 0.0,
    friction: None,
};

/// A half-space that fills x > `x`.
pub fn wall_at_right(x: f64) -> Pose {
    Pose::at([x, 0.0, 0.0]).turned(1, -FRAC_PI_2)
}

/// A half-space that fills y < `y`.
pub fn floor_at(y: f64) -> Pose {
    Pose::at([0.0, y, 0.0]).turned(0, -FRAC_PI_2)
}

/// A motion with a constant velocity.
pub fn steady(velocity: [f64; 3]) -> ImpactorMotion {
    ImpactorMotion::Prescribed {
        kind: MotionKind::Velocity,
        amplitude: velocity,
        function: TimeFunction::Constant,
    }
}

/// Bars with E = ρ = A = 1, N = 3, no partial volumes, small displacements; c of the lattice, so that E is exact. The
/// first one starts at x = 0; each next one `gap` behind the one before. Points per bar and cells of 1/n.
pub struct Bars {
    pub cloud: Arc<PointCloud>,
    pub system: System,
    pub bodies: ContactBodies,
    pub counts: Vec<usize>,
}

pub fn bars(cells: usize, counts: &[usize], gap: f64) -> Bars {
    let dx = 1.0 / cells as f64;
    let (mut x, mut piece, mut cuts) = (Vec::new(), Vec::new(), Vec::new());
    let mut start = 0.0;
    for (number, &count) in counts.iter().enumerate() {
        x.extend((0..count).map(|k| start + (k as f64 + 0.5) * dx));
        piece.extend((0..count).map(|_| number as u32));
        start += count as f64 * dx + gap;
        cuts.push(start - 0.5 * gap);
    }
    let n = x.len();
    let cloud = Arc::new(PointCloud::new(1, x, vec![dx; n], 1.0).unwrap());
    // E of the lattice is 6 c dx², of the continuum ½ c δ² = 4.5 c dx².
    let mut material =
        BondMaterial::new(ElasticModulus::Young(0.75), 1.0, 3.0 * dx).with_law(PairLaw::Linear);
    material.volume_correction = VolumeCorrection::None;
    let mut body = Body::new(cloud.clone(), material);
    for cut in &cuts[..cuts.len() - 1] {
        body = body.crack(Crack::Section { x: *cut });
    }
    Bars {
        system: body.build().unwrap(),
        bodies: ContactBodies {
            piece,
            ..ContactBodies::uniform(n, 1.0, 3.0 * dx, 1.0)
        },
        cloud,
        counts: counts.to_vec(),
    }
}

impl Bars {
    /// Adds contact between the points.
    pub fn touching(mut self, law: ContactLaw) -> Self {
        let contact = PointContact::new(self.cloud.clone(), law, self.bodies.clone()).unwrap();
        self.system.add_interaction(Box::new(contact)).unwrap();
        self
    }

    /// Adds a rigid half-space beyond `x`, at rest or in motion.
    pub fn wall(mut self, x: f64, motion: ImpactorMotion, law: ContactLaw) -> Self {
        let wall = Impactor::new(
            "wall",
            Shape::HalfSpace,
            wall_at_right(x),
            motion,
            self.cloud.clone(),
            law,
            self.bodies.clone(),
        );
        self.system
            .add_interaction(Box::new(wall.unwrap()))
            .unwrap();
        self
    }

    /// A run with a velocity for each bar.
    pub fn run(self, velocities: &[f64], dt: f64, steps: u64) -> Simulation {
        let mut state = State::of(&self.system);
        let mut v = Vec::new();
        for (&count, velocity) in self.counts.iter().zip(velocities) {
            v.extend((0..count).map(|_| *velocity));
        }
        state.v = v;
        Simulation::new(self.system, Box::new(VelocityVerlet), state, dt, steps).unwrap()
    }
}

/// Mean velocity of points.
pub fn mean(v: &[f64]) -> f64 {
    v.iter().sum::<f64>() / v.len() as f64
}

/// One point of volume 1 and density `mass` in the plane, loaded by a force (N), above or in a floor.
pub struct Grain {
    pub mass: f64,
    pub force: [f64; 2],
    /// Height of the point above the place where it touches the floor, m.
    pub gap: f64,
    pub velocity: [f64; 2],
    /// Stiffness of the contact with the floor, N/m.
    pub stiffness: f64,
}

impl Grain {
    pub fn run(&self, law: ContactLaw, dt: f64, steps: u64) -> Simulation {
        let cloud = PointCloud::new(2, vec![0.0, 0.5 + self.gap.max(0.0)], vec![1.0], 1.0).unwrap();
        let cloud = Arc::new(cloud);
        let bonds = Bonded::new(&cloud, |_, _| false);
        let density = PointScalar::Uniform(self.mass);
        let mut system = System::new(cloud.clone(), Box::new(bonds), density).unwrap();
        let [x, y] = self.force;
        if self.force != [0.0; 2] {
            let load = Load::new(vec![0], [x, y, 0.0], TimeFunction::Constant);
            system.add_load(load).unwrap();
        }
        let law = ContactLaw {
            stiffness: pericles_contact::ContactStiffness::Absolute(0.5 * self.stiffness),
            ..law
        };
        let floor = Impactor::new(
            "floor",
            Shape::HalfSpace,
            floor_at(0.0),
            steady([0.0; 3]),
            cloud,
            law,
            ContactBodies::uniform(1, 1.0, 1.0, self.mass),
        );
        system.add_interaction(Box::new(floor.unwrap())).unwrap();
        let mut state = State::of(&system);
        state.u[1] = self.gap.min(0.0);
        state.v = self.velocity.to_vec();
        Simulation::new(system, Box::new(VelocityVerlet), state, dt, steps).unwrap()
    }
}

/// Distance of the centres of two discs of `radius` cells.
fn apart(radius: f64) -> f64 {
    2.0 * radius + 1.5
}

/// The points of two discs of `radius` cells in the plane, the second one turned by 0.3 and beside the first one's axis.
pub fn disc_points(radius: f64) -> Arc<PointCloud> {
    let reach = radius.ceil() as i32;
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for (number, angle) in [(0, 0.0f64), (1, 0.3)] {
        for i in -reach..=reach {
            for j in -reach..=reach {
                let (a, b) = (f64::from(i), f64::from(j));
                if a * a + b * b <= radius * radius {
                    let (sin, cos) = angle.sin_cos();
                    x.push(cos * a - sin * b + f64::from(number) * apart(radius));
                    y.push(sin * a + cos * b + f64::from(number) * 0.4 * radius);
                }
            }
        }
    }
    let n = x.len();
    x.extend(y);
    Arc::new(PointCloud::new(2, x, vec![1.0; n], 1.0).unwrap())
}

/// Two discs that fly towards each other with `speed` relative to the speed of sound; bonds break at `critical`.
pub fn discs(
    radius: f64,
    speed: f64,
    critical: f64,
    law: ContactLaw,
    skin: f64,
) -> (System, State) {
    colliding(disc_points(radius), radius, speed, critical, law, skin)
}

/// As [`discs`], from their points or a part of them.
pub fn colliding(
    cloud: Arc<PointCloud>,
    radius: f64,
    speed: f64,
    critical: f64,
    law: ContactLaw,
    skin: f64,
) -> (System, State) {
    let (n, middle) = (cloud.len(), 0.5 * apart(radius));
    let piece: Vec<u32> = (0..n)
        .map(|i| u32::from(cloud.point(i)[0] > middle))
        .collect();
    let v = piece
        .iter()
        .map(|&piece| if piece == 0 { speed } else { 0.0 });
    let v: Vec<f64> = v.collect();
    let mut material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0);
    if critical.is_finite() {
        material = material.with_critical_stretch(critical);
    }
    let mut system = Body::new(cloud.clone(), material)
        .stress_state(StressState::PlaneStress)
        .crack(Crack::Segment {
            from: [middle, -10.0 * radius],
            to: [middle, 10.0 * radius],
        })
        .build()
        .unwrap();
    let bodies = ContactBodies {
        piece,
        ..ContactBodies::uniform(n, 1.0, 3.0, 1.0)
    };
    let contact = PointContact::new(cloud, law, bodies)
        .unwrap()
        .with_skin(skin);
    system.add_interaction(Box::new(contact)).unwrap();
    let mut state = State::of(&system);
    state.v[..n].copy_from_slice(&v);
    (system, state)
}
