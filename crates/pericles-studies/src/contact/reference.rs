//! Forces and energies of contact at given configurations of 5³ points, against values of an independent program.

use std::sync::Arc;

use pericles::boundary::{MotionKind, TimeFunction};
use pericles::family::{Crack, VolumeCorrection};
use pericles::material::{BondMaterial, ElasticModulus};
use pericles::space::PointCloud;
use pericles::time::{State, VelocityVerlet};
use pericles::{
    Body, Configuration, Interaction, InteractionStep, Path, PointScalar, Simulation, StepEnd,
    System,
};
use pericles_contact::{
    ClosedMesh, ContactBodies, ContactLaw, ContactPairs, ContactStiffness, Friction, Impactor,
    ImpactorMotion, Inertia, PairLaw, PointContact, Pose, Shape,
};
use pericles_run::RunError;

use crate::common::{cells, finish};
use crate::data::{Case, Found};

/// Number of points.
const N: usize = 125;
const AXES: [&str; 3] = ["x", "y", "z"];

/// Returns a vector with the given components at each point; the cells are numbered from 0 to 4 along each axis.
fn vectors(component: impl Fn(f64, [f64; 3], usize) -> f64) -> Vec<f64> {
    let cell = |p: usize| [p / 25, p / 5 % 5, p % 5].map(|k| k as f64);
    let all = (0..3).flat_map(|c| (0..N).map(move |p| (p, c)));
    all.map(|(p, c)| component(p as f64, cell(p), c)).collect()
}

fn bonded(cloud: &Arc<PointCloud>, horizon: f64, cut: f64) -> Result<System, RunError> {
    let mut material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, horizon);
    material.volume_correction = VolumeCorrection::None;
    let corner = |y: f64, z: f64| [cut, y, z];
    let plane = vec![
        corner(-9.0, -9.0),
        corner(9.0, -9.0),
        corner(9.0, 9.0),
        corner(-9.0, 9.0),
    ];
    let body = Body::new(cloud.clone(), material).crack(Crack::Polygon { corners: plane });
    Ok(body.build()?)
}

/// Contact between points with x = i + ½ + 0.1 sin(1.7 n + 0.3 c), V = 1 + 0.1 sin n, E = 10, δ = 2.3, ρ = 2, bonds up to
/// 2.3 that do not cross x = 2.5: number of pairs, energy, force densities at points 52 and 62, and power of dampers and
/// friction.
pub(super) fn points(case: &Case<'_>) -> Result<Found, RunError> {
    let plain = ContactLaw::default();
    let laws = [
        ("linear", plain),
        (
            "power 1.5",
            ContactLaw {
                law: PairLaw::Power(1.5),
                ..plain
            },
        ),
        (
            "EMU, all pairs",
            ContactLaw {
                pairs: ContactPairs::All,
                law: PairLaw::Emu,
                distance: 1.35,
                closing: 0.9,
                ..plain
            },
        ),
        (
            "dampers and friction",
            ContactLaw {
                damping: 0.3,
                friction: Some(Friction {
                    coefficient: 0.4,
                    speed: 0.05,
                }),
                ..plain
            },
        ),
    ];
    let law = case.one_of("law", &laws)?;
    let x = vectors(|n, cell, c| cell[c] + 0.5 + 0.1 * (1.7 * n + 0.3 * c as f64).sin());
    let u: Vec<f64> = vectors(|n, _, c| 0.05 * (0.9 * n + 1.1 * c as f64).cos())
        .iter()
        .zip(&x)
        .enumerate()
        .map(|(k, (wave, x))| wave - 0.25 * (x - 2.5) * [1.0, 0.4, 0.2][k / N])
        .collect();
    let v = vectors(|n, _, c| 0.3 * (0.7 * n + 0.5 * c as f64).sin());
    let volumes = (0..N).map(|n| 1.0 + 0.1 * (n as f64).sin()).collect();
    let cloud = Arc::new(PointCloud::new(3, x, volumes, 1.0)?);
    let system = bonded(&cloud, 2.3, 2.5)?;
    let bodies = ContactBodies::uniform(N, 10.0, 2.3, 2.0);
    let contact = PointContact::new(cloud, law, bodies)?;
    // The program takes 1.35 times the spacing for the law of EMU, and else the sizes of the cells.
    let mut contact = match law.law {
        PairLaw::Emu => contact.with_sizes(&PointScalar::Uniform(1.0))?,
        _ => contact,
    };
    let at = Configuration {
        t: 0.0,
        u: &u,
        forces: system.operator(),
    };
    let energy = contact.energy(&at);
    let mut force = vec![0.0; 3 * N];
    // Work of the drag over a step of length 2 in which it grows from zero: half of its power times 2.
    let step = StepEnd {
        t: 0.0,
        dt: 2.0,
        u: &u,
        path: Path::MeanVelocity(&v),
    };
    let end = InteractionStep {
        step: &step,
        forces: system.operator(),
        density: &PointScalar::Uniform(2.0),
    };
    contact.end_step(&end, &mut force);
    let mut found = Found::default()
        .value("pairs", contact.report().pairs as f64)
        .value("energy", energy)
        .value("power", -contact.dissipated());
    for point in [52, 62] {
        for (c, axis) in AXES.iter().enumerate() {
            found = found.value(format!("force {point} {axis}"), force[c * N + point]);
        }
    }
    Ok(found)
}

/// Regular icosahedron with vertices at the given distance from its centre.
fn icosahedron(radius: f64) -> Result<ClosedMesh, RunError> {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let scale = radius / (1.0 + golden * golden).sqrt();
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    for turn in 0..3 {
        for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let plain = [a, b * golden, 0.0];
            vertices.push(std::array::from_fn(|c| scale * plain[(c + turn) % 3]));
        }
    }
    let product =
        |a: usize, b: usize| -> f64 { (0..3).map(|c| vertices[a][c] * vertices[b][c]).sum() };
    // Neighbours have the smallest angle that occurs, of cosine 1/√5.
    let near = |a: usize, b: usize| product(a, b) > 0.4 * radius * radius;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(a, c) {
                    let [p, q, r] = [a, b, c].map(|k| vertices[k]);
                    let volume = p[0] * (q[1] * r[2] - q[2] * r[1])
                        + p[1] * (q[2] * r[0] - q[0] * r[2])
                        + p[2] * (q[0] * r[1] - q[1] * r[0]);
                    let [b, c] = if volume > 0.0 { [b, c] } else { [c, b] };
                    triangles.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    Ok(ClosedMesh::new(vertices, triangles)?)
}

/// Rigid bodies of several shapes, turned by R_z(0.4) R_x(0.7) R_y(−0.3), in points y = (i − 2) + 0.1 sin(1.7 n + 0.3 c)
/// with half sizes ½ + 0.05 sin n and stiffnesses 2 + cos n: points in contact, energy, force on the points and torque on
/// the body.
pub(super) fn shapes(case: &Case<'_>) -> Result<Found, RunError> {
    let place = [0.3, -0.2, 2.6];
    let shapes = [
        ("ball", (Shape::Ball { radius: 1.7 }, place)),
        ("half-space", (Shape::HalfSpace, [0.3, -0.2, -1.4])),
        (
            "box",
            (
                Shape::Box {
                    half: [1.2, 0.8, 0.5],
                },
                place,
            ),
        ),
        (
            "cylinder",
            (
                Shape::Cylinder {
                    radius: 0.9,
                    half_height: 1.1,
                },
                place,
            ),
        ),
        ("icosahedron", (Shape::Mesh(icosahedron(1.7)?), place)),
    ];
    let (shape, centre) = case.one_of("shape", &shapes)?;
    // The points come from far away along the normal of the half-space, so that nothing overlaps at the start.
    let far = [0.0, -64.0, 64.0];
    let x = vectors(|n, cell, c| cell[c] - 2.0 + 0.1 * (1.7 * n + 0.3 * c as f64).sin() + far[c]);
    let u = vectors(|_, _, c| -far[c]);
    let size = |n: usize| 1.0 + 0.1 * (n as f64).sin();
    let volumes: Vec<f64> = (0..N).map(|n| size(n).powi(3)).collect();
    // k = 2 E V/δ² with δ = 1.
    let young = |n: usize| (2.0 + (n as f64).cos()) / (2.0 * volumes[n]);
    let bodies = ContactBodies {
        young: PointScalar::PerPoint((0..N).map(young).collect()),
        ..ContactBodies::uniform(N, 1.0, 1.0, 1.0)
    };
    let cloud = Arc::new(PointCloud::new(3, x, volumes.clone(), 1.0)?);
    let system = bonded(&cloud, 1.5, 100.0)?;
    let pose = Pose::at(centre)
        .turned(1, -0.3)
        .turned(0, 0.7)
        .turned(2, 0.4);
    let law = ContactLaw {
        stiffness: ContactStiffness::Relative(1.0),
        ..ContactLaw::default()
    };
    let still = ImpactorMotion::Prescribed {
        kind: MotionKind::Displacement,
        amplitude: [0.0; 3],
        function: TimeFunction::Constant,
    };
    let mut body = Impactor::new("body", shape, pose, still, cloud, law, bodies)?;
    let at = Configuration {
        t: 0.0,
        u: &u,
        forces: system.operator(),
    };
    let energy = body.energy(&at);
    let step = StepEnd::start(0.0, &u, &u);
    let end = InteractionStep {
        step: &step,
        forces: system.operator(),
        density: &PointScalar::Uniform(1.0),
    };
    body.end_step(&end, &mut vec![0.0; 3 * N]);
    let reading = body.reading();
    let mut found = Found::default()
        .value("points", reading.points as f64)
        .value("energy", energy);
    for (c, axis) in AXES.iter().enumerate() {
        found = found
            .value(format!("force {axis}"), -reading.force[c])
            .value(format!("torque {axis}"), reading.torque[c]);
    }
    Ok(found)
}

/// Angular momentum, in its own frame, of a free body with the moments of inertia 1, 2 and 3 that started with (1, 0.5,
/// −0.8), after ten steps of 0.1.
pub(super) fn top(_case: &Case<'_>) -> Result<Found, RunError> {
    const MOMENTS: [f64; 3] = [1.0, 2.0, 3.0];
    const START: [f64; 3] = [1.0, 0.5, -0.8];
    let cloud = Arc::new(cells([100.0; 3], vec![2.0, 1.0, 1.0], 1.0)?);
    let material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 1.5);
    let mut system = Body::new(cloud.clone(), material).build()?;
    let mut inertia = [[0.0; 3]; 3];
    (0..3).for_each(|c| inertia[c][c] = MOMENTS[c]);
    let free = ImpactorMotion::Free {
        inertia: Inertia::Mass {
            mass: 1.0,
            inertia: Some(inertia),
        },
        velocity: [0.0; 3],
        spin: std::array::from_fn(|c| START[c] / MOMENTS[c]),
    };
    let (shape, pose) = (Shape::Ball { radius: 1.0 }, Pose::at([0.0; 3]));
    let bodies = ContactBodies::uniform(cloud.len(), 1.0, 1.5, 1.0);
    let top = Impactor::new(
        "top",
        shape,
        pose,
        free,
        cloud,
        ContactLaw::default(),
        bodies,
    )?;
    system.add_interaction(Box::new(top))?;
    let state = State::of(&system);
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), state, 0.1, 10)?;
    finish(&mut run)?;
    let mut all = run.system().interactions();
    let reading = all.find_map(|one| one.downcast_ref::<Impactor>().map(Impactor::reading));
    let mut found = Found::default();
    for (c, axis) in AXES.iter().enumerate() {
        let own = reading.map(|now| {
            let turned: f64 = (0..3).map(|k| now.rotation[k][c] * now.spin[k]).sum();
            MOMENTS[c] * turned
        });
        found = found.value(*axis, own);
    }
    Ok(found)
}
