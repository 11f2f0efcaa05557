//! Forces and energies against values of an independent program, to 1e-10.

use std::sync::Arc;

use pericles::boundary::{MotionKind, TimeFunction};
use pericles::operator::PointSubset;
use pericles::space::PointCloud;
use pericles::{Configuration, Interaction, InteractionStep, Path, PointScalar, StepEnd};
use pericles_contact::{
    ClosedMesh, ContactBodies, ContactLaw, ContactPairs, ContactStiffness, Friction, Impactor,
    ImpactorMotion, PairLaw, PointContact, Pose, Shape,
};

use crate::bonded::Bonded;

fn close(found: f64, expected: f64, scale: f64) {
    assert!(
        (found - expected).abs() <= 2e-11 * scale.abs().max(expected.abs()),
        "{found:.12e} instead of {expected:.12e}"
    );
}

/// 5³ points: x = i + ½ + 0.1 sin(1.7 n + 0.3 c), V = 1 + 0.1 sin n, and displacements and velocities like these.
struct Cloud {
    cloud: Arc<PointCloud>,
    u: Vec<f64>,
    v: Vec<f64>,
    bonds: Bonded,
}

fn cloud() -> Cloud {
    let n = 125;
    let (mut x, mut u, mut v) = (vec![0.0; 375], vec![0.0; 375], vec![0.0; 375]);
    for p in 0..n {
        let cell = [p / 25, p / 5 % 5, p % 5];
        let number = p as f64;
        for c in 0..3 {
            x[c * n + p] = cell[c] as f64 + 0.5 + 0.1 * (1.7 * number + 0.3 * c as f64).sin();
        }
        for c in 0..3 {
            u[c * n + p] = -0.25 * (x[c * n + p] - 2.5) * [1.0, 0.4, 0.2][c]
                + 0.05 * (0.9 * number + 1.1 * c as f64).cos();
            v[c * n + p] = 0.3 * (0.7 * number + 0.5 * c as f64).sin();
        }
    }
    let volumes = (0..n).map(|p| 1.0 + 0.1 * (p as f64).sin()).collect();
    let cloud = Arc::new(PointCloud::new(3, x, volumes, 1.0).unwrap());
    let bonds = Bonded::new(&cloud, |a, b| {
        let length = (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>().sqrt();
        length <= 2.3 && (a[0] - 2.5) * (b[0] - 2.5) > 0.0
    });
    Cloud { cloud, u, v, bonds }
}

fn contact(cloud: &Cloud, law: ContactLaw) -> PointContact {
    let bodies = ContactBodies::uniform(125, 10.0, 2.3, 2.0);
    let contact = PointContact::new(cloud.cloud.clone(), law, bodies).unwrap();
    contact.check(&cloud.bonds).unwrap();
    // The program takes 1.35 times the spacing for the law of EMU, and else the sizes of the cells.
    match law.law {
        PairLaw::Emu => contact.with_sizes(&PointScalar::Uniform(1.0)).unwrap(),
        _ => contact,
    }
}

/// Energy, force densities, pairs in contact, and power of dampers and friction.
fn evaluated(cloud: &Cloud, law: ContactLaw) -> (f64, Vec<f64>, u64, f64) {
    let mut contact = contact(cloud, law);
    let at = Configuration {
        t: 0.0,
        u: &cloud.u,
        forces: &cloud.bonds,
    };
    let energy = contact.energy(&at);
    let mut force = vec![0.0; 375];
    let step = StepEnd {
        t: 0.0,
        dt: 2.0,
        u: &cloud.u,
        path: Path::MeanVelocity(&cloud.v),
    };
    let end = InteractionStep {
        step: &step,
        forces: &cloud.bonds,
        density: &PointScalar::Uniform(2.0),
    };
    contact.end_step(&end, &mut force);
    // Work of the drag over a step of length 2 in which it grew from zero: half of its power times 2.
    (energy, force, contact.report().pairs, -contact.dissipated())
}

#[test]
fn point_contact_repeats_an_independent_program() {
    let cloud = cloud();
    let unbonded = ContactLaw::default();
    let emu = ContactLaw {
        pairs: ContactPairs::All,
        law: PairLaw::Emu,
        distance: 1.35,
        closing: 0.9,
        ..unbonded
    };
    let cases = [
        (
            unbonded,
            38,
            2.21787955740,
            [1.30297756909, -0.197171594428, 0.0643792971634],
            [-1.07290988076, 0.174075087488, -0.0165913870249],
        ),
        (
            ContactLaw {
                law: PairLaw::Power(1.5),
                ..unbonded
            },
            38,
            0.860717127339,
            [0.745610685090, -0.112828686455, 0.0368401521271],
            [-0.540789091298, 0.0514045965001, -0.00830662181289],
        ),
        (
            emu,
            499,
            28.3014575839,
            [3.98545687132, -1.15508903156, -0.769588962127],
            [-3.91175439475, -1.16677900258, 0.0322063173594],
        ),
    ];
    for (law, pairs, energy, f52, f62) in cases {
        let (found, force, count, drag) = evaluated(&cloud, law);
        assert_eq!(count, pairs);
        assert_eq!(drag, 0.0);
        close(found, energy, 0.0);
        for c in 0..3 {
            close(force[c * 125 + 52], f52[c], 1.0);
            close(force[c * 125 + 62], f62[c], 1.0);
        }
        for c in 0..3 {
            let own = &force[c * 125..(c + 1) * 125];
            let sum: f64 = own
                .iter()
                .zip(cloud.cloud.volumes())
                .map(|(f, v)| f * v)
                .sum();
            assert!(sum.abs() < 1e-13, "momentum {sum:e}");
        }
    }
}

#[test]
fn dampers_and_friction_repeat_an_independent_program() {
    let cloud = cloud();
    let law = ContactLaw {
        damping: 0.3,
        friction: Some(Friction {
            coefficient: 0.4,
            speed: 0.05,
        }),
        ..ContactLaw::default()
    };
    let (_, force, pairs, power) = evaluated(&cloud, law);
    assert_eq!(pairs, 38);
    close(power, -6.75490949591, 0.0);
    let f52 = [1.67843020307, 0.259246296238, 0.492655266239];
    let f62 = [-1.13569899310, 0.0420024251738, -0.424405727795];
    for c in 0..3 {
        close(force[c * 125 + 52], f52[c], 1.0);
        close(force[c * 125 + 62], f62[c], 1.0);
    }
}

#[test]
fn tangents_are_derivatives_of_forces() {
    let cloud = cloud();
    for law in [PairLaw::Linear, PairLaw::Power(2.0)] {
        let contact = contact(
            &cloud,
            ContactLaw {
                law,
                ..ContactLaw::default()
            },
        );
        check_tangent(&contact, &cloud, &cloud.u, 1e-6, 1e-6);
    }
}

/// Compares the tangent with a difference quotient of the force, and the force with one of the energy.
fn check_tangent(one: &dyn Interaction, cloud: &Cloud, u: &[f64], h: f64, tolerance: f64) {
    let direction: Vec<f64> = (0..375).map(|k| (0.37 * k as f64).sin()).collect();
    let moved = |by: f64| -> Vec<f64> {
        let entries = u.iter().zip(&direction);
        entries.map(|(u, d)| u + by * d).collect()
    };
    let force = |by: f64| {
        let mut force = vec![0.0; 375];
        let u = moved(by);
        let at = Configuration {
            t: 0.0,
            u: &u,
            forces: &cloud.bonds,
        };
        one.add_force(&at, &PointSubset::All, &mut force);
        (force, one.energy(&at))
    };
    let at = Configuration {
        t: 0.0,
        u,
        forces: &cloud.bonds,
    };
    let mut tangent = vec![0.0; 375];
    one.add_tangent(&at, &direction, &mut tangent);
    let ((after, energy_after), (before, energy_before)) = (force(h), force(-h));
    let largest = tangent.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    assert!(largest > 0.0);
    for k in 0..375 {
        let quotient = (after[k] - before[k]) / (2.0 * h);
        assert!(
            (quotient - tangent[k]).abs() < tolerance * largest,
            "entry {k}: {quotient:e} and {:e}",
            tangent[k]
        );
    }
    let power: f64 = (0..375)
        .map(|k| cloud.cloud.volumes()[k % 125] * force(0.0).0[k] * direction[k])
        .sum();
    let slope = (energy_after - energy_before) / (2.0 * h);
    assert!(
        (slope + power).abs() < tolerance * power.abs(),
        "{slope} {power}"
    );
}

/// Points y = (i − 2) + 0.1 sin(1.7 n + 0.3 c) with half sizes 0.5 + 0.05 sin n, moved there from far away, so that
/// nothing overlaps at the start.
fn loose() -> (Cloud, ContactBodies) {
    let n = 125;
    // Along the outer normal of the half-space.
    let far = [0.0, -64.0, 64.0];
    let (mut x, mut u) = (vec![0.0; 375], vec![0.0; 375]);
    let (mut volumes, mut young) = (Vec::new(), Vec::new());
    for p in 0..n {
        let cell = [p / 25, p / 5 % 5, p % 5];
        let number = p as f64;
        for c in 0..3 {
            let y = cell[c] as f64 - 2.0 + 0.1 * (1.7 * number + 0.3 * c as f64).sin();
            x[c * n + p] = y + far[c];
            u[c * n + p] = -far[c];
        }
        let size: f64 = 1.0 + 0.1 * number.sin();
        volumes.push(size.powi(3));
        // k_w = 2 k_i = 2 E V/δ² with δ = 1.
        young.push((2.0 + number.cos()) / (2.0 * size.powi(3)));
    }
    let cloud = Arc::new(PointCloud::new(3, x, volumes, 1.0).unwrap());
    let bodies = ContactBodies {
        piece: vec![0; n],
        young: PointScalar::PerPoint(young),
        horizon: PointScalar::Uniform(1.0),
        density: PointScalar::Uniform(1.0),
    };
    let bonds = Bonded::new(&cloud, |_, _| false);
    let cloud = Cloud {
        cloud,
        v: vec![0.0; 375],
        u,
        bonds,
    };
    (cloud, bodies)
}

fn icosahedron() -> ClosedMesh {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    for turn in 0..3 {
        for a in [1.0, -1.0] {
            for b in [golden, -golden] {
                let plain = [a, b, 0.0];
                vertices.push(std::array::from_fn(|c| plain[(c + turn) % 3]));
            }
        }
    }
    let scale = 1.7 / (1.0 + golden * golden).sqrt();
    vertices.iter_mut().flatten().for_each(|x| *x *= scale);
    let apart = |a: usize, b: usize| -> f64 {
        let d = |c: usize| vertices[a][c] - vertices[b][c];
        (0..3).map(|c| d(c) * d(c)).sum::<f64>().sqrt()
    };
    let side = 2.0 * scale;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let near = |p, q| (apart(p, q) - side).abs() < 1e-9;
                if near(a, b) && near(b, c) && near(a, c) {
                    // Outwards: the normal has the direction of the centroid.
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
    assert_eq!(triangles.len(), 20);
    ClosedMesh::new(vertices, triangles).unwrap()
}

fn impactor(shape: Shape, centre: [f64; 3], cloud: &Cloud, bodies: &ContactBodies) -> Impactor {
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
    let cloud = cloud.cloud.clone();
    Impactor::new("body", shape, pose, still, cloud, law, bodies.clone()).unwrap()
}

#[test]
fn rigid_bodies_repeat_an_independent_program() {
    let (cloud, bodies) = loose();
    let ball_place = [0.3, -0.2, 2.6];
    let cases = [
        (
            Shape::Ball { radius: 1.7 },
            ball_place,
            21,
            10.9799787952,
            [0.0837227269056, 4.17833552084, -15.5828461704],
            [0.0; 3],
        ),
        (
            Shape::HalfSpace,
            [0.3, -0.2, -1.4],
            50,
            74.0735283367,
            [-2.76355801604, -57.9397703482, 62.0807356490],
            [-95.3596157069, -11.1793918919, -14.6786796212],
        ),
        (
            Shape::Box {
                half: [1.2, 0.8, 0.5],
            },
            ball_place,
            7,
            0.989923495104,
            [-0.129280228397, 1.30202292533, -2.61310016033],
            [-0.627177296678, -0.0889872598475, -1.13950869675],
        ),
        (
            Shape::Cylinder {
                radius: 0.9,
                half_height: 1.1,
            },
            ball_place,
            9,
            2.58741869599,
            [1.88063716502, 2.80799502562, -5.06236099679],
            [-0.223026410088, 1.27870091823, 1.18347971162],
        ),
        (
            Shape::Mesh(icosahedron()),
            ball_place,
            14,
            5.53738328694,
            [-0.473249264999, 1.29762199410, -8.72758741120],
            [2.55230432168, -1.38134163486, 0.264832464012],
        ),
    ];
    for (shape, centre, points, energy, force, torque) in cases {
        let what = format!("{shape:?}").chars().take(20).collect::<String>();
        let mut body = impactor(shape, centre, &cloud, &bodies);
        let at = Configuration {
            t: 0.0,
            u: &cloud.u,
            forces: &cloud.bonds,
        };
        println!("{what}");
        close(body.energy(&at), energy, 0.0);
        check_tangent(&body, &cloud, &cloud.u, 1e-6, 1e-5);
        let step = StepEnd::start(0.0, &cloud.u, &cloud.v);
        let end = InteractionStep {
            step: &step,
            forces: &cloud.bonds,
            density: &PointScalar::Uniform(1.0),
        };
        let mut out = vec![0.0; 375];
        body.end_step(&end, &mut out);
        let reading = body.reading();
        assert_eq!(reading.points, points, "{what}");
        for c in 0..3 {
            // Coordinates of 64 lose six bits.
            close(-reading.force[c], force[c], 20.0);
            close(reading.torque[c], torque[c], 20.0);
        }
    }
}
