//! Forces split by zones, for every form of the forces.

use std::sync::Arc;

use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::kernel::Influence;
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, Modulus, PairLaw, StressState,
};
use pericles::operator::{BondBody, BondForm, Force, PointSubset};
use pericles::space::{Grid, PointCloud, Region, Shape};
use pericles::time::{
    Fine, Follow, Integrator, Interpolant, MultiTimeStep, MultiTimeStepOptions, Predictor, Respa,
    State, Tableau,
};
use pericles::{Control, PointScalar, Simulation, System};
use pericles::{Path, StepEnd};

const SPACING: f64 = 0.01;
const CRITICAL: f64 = 1e-3;

/// A body with a hole and a pre-crack in one, two or three dimensions.
struct Body {
    cloud: Arc<PointCloud>,
    material: BondMaterial,
    state: StressState,
    cracks: Vec<(Crack, EndRule)>,
    no_fail: Vec<u32>,
}

fn bodies() -> Vec<Body> {
    let states = [
        StressState::Uniaxial,
        StressState::PlaneStrain,
        StressState::Spatial,
    ];
    (1..=3)
        .map(|dimension| {
            let cells = [45.0, 19.0, 9.0][dimension - 1];
            let grid = Grid {
                shape: Shape::Box {
                    origin: [0.0; 3],
                    size: vec![cells * SPACING; dimension],
                },
                spacing: SPACING,
                section: 1.0,
                holes: vec![Region::Ball {
                    centre: [0.052, 0.031, 0.02],
                    radius: 0.016,
                }],
            };
            let crack = match dimension {
                1 => Crack::Section { x: 0.2 },
                2 => Crack::Segment {
                    from: [0.0, 0.1],
                    to: [0.1, 0.12],
                },
                _ => Crack::Disc {
                    centre: [0.04, 0.05, 0.05],
                    normal: [0.2, 0.1, 1.0],
                    radius: 0.025,
                },
            };
            let cloud = Arc::new(grid.points().unwrap());
            Body {
                no_fail: (0..cloud.len() as u32 / 10).collect(),
                cloud,
                material: BondMaterial {
                    law: PairLaw::BondStretch,
                    density: 8000.0,
                    modulus: Modulus {
                        value: ElasticModulus::Young(2e11),
                        calibration: Calibration::Continuum,
                    },
                    horizon: 3.0 * SPACING,
                    influence: Influence::default(),
                    volume_correction: VolumeCorrection::Extended,
                    fracture: Fracture::CriticalStretch(CRITICAL),
                },
                state: states[dimension - 1],
                cracks: vec![(crack, EndRule::Closed)],
            }
        })
        .collect()
}

impl Body {
    fn operator(&self, form: BondForm) -> Box<dyn Force> {
        let constants = self.material.constants(&self.cloud, self.state).unwrap();
        let body = BondBody {
            cracks: &self.cracks,
            no_fail: &self.no_fail,
            ..BondBody::new(&self.cloud, &self.material, &constants)
        };
        body.operator(form).unwrap().operator
    }

    fn displacement(&self, size: f64) -> Vec<f64> {
        (0..self.cloud.positions().len())
            .map(|k| size * SPACING * ((k * k) as f64).sin())
            .collect()
    }
}

const FORMS: [BondForm; 2] = [BondForm::List, BondForm::Grid];

#[test]
fn neighbours_are_the_points_that_exert_a_force() {
    for body in bodies() {
        let n = body.cloud.len();
        let families = FORMS.map(|form| {
            let operator = body.operator(form);
            let local = operator.as_local().unwrap();

            (0..n)
                .map(|i| {
                    let mut family = Vec::new();
                    local.neighbours(i, &mut |j| family.push(j));
                    family.sort_unstable();
                    family
                })
                .collect::<Vec<_>>()
        });
        assert_eq!(families[0], families[1]);
        let bonds: usize = families[0].iter().map(Vec::len).sum();
        assert_eq!(bonds as u64, body.operator(BondForm::List).directed_bonds());
        for (i, family) in families[0].iter().enumerate() {
            assert!(family.iter().all(|&j| families[0][j].contains(&i)));
        }
    }
}

#[test]
fn forces_of_partners_add_up_and_are_opposite() {
    for body in bodies() {
        let n = body.cloud.len();
        let u = body.displacement(1e-4);
        let inside: Vec<bool> = (0..n).map(|i| (i * i) % 7 < 3).collect();
        let outside: Vec<bool> = inside.iter().map(|inside| !inside).collect();
        let set =
            |marks: &[bool]| -> Vec<u32> { (0..n as u32).filter(|&i| marks[i as usize]).collect() };
        for form in FORMS {
            let operator = body.operator(form);
            let split = operator.as_split().unwrap();
            let mut whole = vec![0.0; u.len()];
            operator.add_force(0.0, &u, PointSubset::All, &mut whole);
            let mut parts = vec![0.0; u.len()];
            split.add_force_from(0.0, &u, PointSubset::All, &inside, &mut parts);
            split.add_force_from(0.0, &u, PointSubset::All, &outside, &mut parts);
            let scale = whole.iter().fold(0.0, |max: f64, f| max.max(f.abs()));
            for k in 0..u.len() {
                assert!((parts[k] - whole[k]).abs() < 1e-12 * scale);
            }
            // The forces between the two zones are opposite; other entries are unchanged.
            let mut exchange = vec![0.0; u.len()];
            split.add_force_from(
                0.0,
                &u,
                PointSubset::Set(&set(&inside)),
                &outside,
                &mut exchange,
            );
            for k in 0..u.len() {
                assert!(inside[k % n] || exchange[k] == 0.0);
            }
            split.add_force_from(
                0.0,
                &u,
                PointSubset::Set(&set(&outside)),
                &inside,
                &mut exchange,
            );
            for component in exchange.chunks(n) {
                let sum: f64 = component.iter().sum();
                assert!(sum.abs() < 1e-12 * scale * n as f64);
            }
        }
    }
}

#[test]
fn breaking_by_partners_decides_their_bonds_only() {
    for body in bodies() {
        let n = body.cloud.len();
        let u = body.displacement(2e-3);
        let v: Vec<f64> = u.iter().rev().map(|u| 1e3 * u).collect();
        let end = StepEnd {
            t: 0.0,
            dt: 1e-8,
            u: &u,
            path: Path::MeanVelocity(&v),
        };
        let inside: Vec<bool> = (0..n).map(|i| (i * i) % 7 < 3).collect();
        let outside: Vec<bool> = inside.iter().map(|inside| !inside).collect();
        let set =
            |marks: &[bool]| -> Vec<u32> { (0..n as u32).filter(|&i| marks[i as usize]).collect() };
        let mut broken = Vec::new();
        for form in FORMS {
            let mut at_once = body.operator(form);
            let mut force = vec![0.0; u.len()];
            at_once.end_step(&end, PointSubset::All, &mut force);
            assert!(at_once.broken_bonds() > 5);
            let mut parts = body.operator(form);
            let mut sum = vec![0.0; u.len()];
            let mut counts = vec![];
            for (rows, partners) in [
                (&outside, &outside),
                (&inside, &outside),
                (&inside, &inside),
                (&outside, &inside),
            ] {
                let rows = set(rows);
                parts.split_mut().unwrap().end_step_from(
                    &end,
                    PointSubset::Set(&rows),
                    partners,
                    &mut sum,
                );
                counts.push(parts.broken_bonds());
            }
            assert!(
                counts[0] < counts[1] && counts[1] <= counts[2],
                "{counts:?}"
            );
            // The last pair was decided from its other end.
            assert_eq!(counts[2], counts[3]);
            assert_eq!(counts[3], at_once.broken_bonds());
            let (a, b) = (parts.dissipated(), at_once.dissipated());
            assert!((a / b - 1.0).abs() < 1e-12);
            let scale = force.iter().fold(0.0, |max: f64, f| max.max(f.abs()));
            for k in 0..u.len() {
                assert!((sum[k] - force[k]).abs() < 1e-12 * scale);
            }
            broken.push(counts);
        }
        assert_eq!(broken[0], broken[1]);
    }
}

#[test]
fn endangered_points_are_those_whose_bonds_break_at_a_lower_limit() {
    for body in bodies() {
        let n = body.cloud.len();
        let u = body.displacement(6e-4);
        let fraction = 0.8;
        let lower = Body {
            material: BondMaterial {
                fracture: Fracture::CriticalStretch(fraction * CRITICAL),
                ..body.material.clone()
            },
            cloud: body.cloud.clone(),
            cracks: body.cracks.clone(),
            no_fail: body.no_fail.clone(),
            ..body
        };
        let mut weak = lower.operator(BondForm::List);
        weak.end_step(
            &StepEnd::sub_step(0.0, 0.0, &u),
            PointSubset::All,
            &mut vec![0.0; u.len()],
        );
        let mut damage = vec![0.0; n];
        weak.damage_into(&mut damage);
        let expected: Vec<bool> = damage.iter().map(|&d| d > 0.0).collect();
        assert!(expected.contains(&true) && expected.contains(&false));
        for form in FORMS {
            let operator = body.operator(form);
            let mut marks = vec![false; n];
            operator
                .capabilities()
                .breaking
                .unwrap()
                .mark_endangered(&u, fraction, &mut marks);
            assert_eq!(marks, expected, "{form:?}");
        }
    }
}

#[test]
fn multirate_on_the_stencil_equals_multirate_on_the_list() {
    for body in bodies() {
        let u = body.displacement(9e-4);
        for scheme in 0..3 {
            let ends = FORMS.map(|form| {
                let density = PointScalar::Uniform(8000.0);
                let operator = body.operator(form);
                let system = System::new(body.cloud.clone(), operator, density).unwrap();
                let fine: Vec<u32> = (0..body.cloud.len())
                    .filter(|&i| (body.cloud.point(i)[0] - 0.05).abs() < 0.03)
                    .map(|i| i as u32)
                    .collect();
                let options = MultiTimeStepOptions {
                    ratio: 3,
                    fine: match scheme {
                        0 => Fine::Adaptive(Follow::default()),
                        _ => Fine::Fixed(vec![fine.clone()]),
                    },
                    predictor: Predictor::Structured,
                    interpolant: Interpolant::Hermite,
                };
                let integrator: Box<dyn Integrator> = match scheme {
                    2 => Box::new(Respa::new(3, options.fine, &system).unwrap()),
                    _ => Box::new(MultiTimeStep::new(&Tableau::rk4(), options, &system).unwrap()),
                };
                let mut state = State::at_rest(u.len());
                state.u.copy_from_slice(&u);
                let mut simulation = Simulation::new(system, integrator, state, 3e-7, 12).unwrap();
                simulation.run(|_| Control::Continue).unwrap();
                (
                    simulation.state().u.clone(),
                    simulation.system().operator().broken_bonds(),
                )
            });
            assert!(ends[0].1 > 0);
            assert_eq!(ends[0].1, ends[1].1);
            let size = u.iter().fold(0.0, |max: f64, u| max.max(u.abs()));
            for (a, b) in ends[0].0.iter().zip(&ends[1].0) {
                assert!((a - b).abs() < 1e-9 * size);
            }
        }
    }
}
