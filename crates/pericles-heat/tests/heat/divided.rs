//! Fields on bodies divided among several processes (threads that exchange messages): values, fluxes, balances and checkpoints are
//! bitwise identical to those of a single process.

use std::sync::Arc;

use pericles::division::part_of;
use pericles::domain::{Alone, Comm, Threads};
use pericles::family::VolumeCorrection;
use pericles::kernel::Influence;
use pericles::material::StressState;
use pericles::prelude::*;
use pericles::{
    Archive, BodyStep, Checkpointed, PericlesError, PointScalar, Result, SecondaryField,
    Temperature,
};
use pericles_heat::{
    Condition, DiffusingField, DiffusionBody, Exchange, FieldOptions, HeatError, Interface, Kind,
    Problem, Scheme, Value,
};

/// Largest distance of neighbours: a horizon of three cells, and half a cell of their partial volumes.
const REACH: f64 = 3.6;

fn plate() -> PointCloud {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: vec![27.0, 13.0],
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![Region::Ball {
            centre: [13.0, 7.0, 0.0],
            radius: 1.6,
        }],
    };
    grid.points().unwrap()
}

fn periodic() -> PointCloud {
    let plate = Grid::plate([27.0, 13.0], 1.0, 1.0).points().unwrap();
    plate.with_periodic_faces().unwrap()
}

fn block() -> PointCloud {
    Grid::block([11.0, 7.0, 5.0], 1.0).points().unwrap()
}

/// Points at irregular positions with different volumes.
fn scattered() -> PointCloud {
    let lattice = plate();
    let moved = |(k, x): (usize, &f64)| x + 0.15 * (2.3 * k as f64).sin();
    let positions = lattice.positions().iter().enumerate().map(moved).collect();
    let volume = |k: usize| 1.0 + 0.1 * (1.1 * k as f64).cos();
    let volumes = (0..lattice.len()).map(volume).collect();
    PointCloud::new(2, positions, volumes, 1.0).unwrap()
}

/// The part of a process: oblique stripes, so that no part is a range of numbers or a box. The last one of four processes has no
/// points.
fn part(whole: &Arc<PointCloud>, comm: Arc<dyn Comm>) -> Arc<PointCloud> {
    let parts = comm.size().min(3);
    let [_, end] = whole.bounds();
    let owner = |k: usize| {
        let [x, y, _] = whole.point(k);
        let place = (x + 0.4 * y) / (end[0] + 0.4 * end[1]);
        ((place * parts as f64) as u32).min(parts as u32 - 1)
    };
    let owners: Vec<u32> = (0..whole.len()).map(owner).collect();
    Arc::new(part_of(whole, &owners, REACH, comm).unwrap())
}

#[derive(Clone, Copy)]
struct Case {
    name: &'static str,
    body: fn() -> PointCloud,
    on_list: bool,
    /// Whether points at the right have a smaller horizon.
    horizons: bool,
    interface: Interface,
    surface_correction: bool,
    broken_share: f64,
}

const PLAIN: Case = Case {
    name: "plate",
    body: plate,
    on_list: false,
    horizons: false,
    interface: Interface::Harmonic,
    surface_correction: false,
    broken_share: 0.0,
};

const CASES: [Case; 6] = [
    PLAIN,
    Case {
        name: "plate with corrected surfaces",
        interface: Interface::Arithmetic,
        surface_correction: true,
        broken_share: 0.3,
        ..PLAIN
    },
    Case {
        name: "plate as a list",
        on_list: true,
        surface_correction: true,
        ..PLAIN
    },
    Case {
        name: "periodic plate",
        body: periodic,
        ..PLAIN
    },
    Case {
        name: "block",
        body: block,
        surface_correction: true,
        ..PLAIN
    },
    Case {
        name: "scattered points with two horizons",
        body: scattered,
        horizons: true,
        broken_share: 0.3,
        ..PLAIN
    },
];

/// The body of a process, with its forces and the problem on its own points.
fn assemble(case: &Case, cloud: &Arc<PointCloud>, whole: &PointCloud) -> (System, Problem) {
    let mut steel = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0);
    steel.volume_correction = VolumeCorrection::Extended;
    let body = Body::new(cloud.clone(), steel);
    let body = match (whole.dimension(), whole.is_periodic()) {
        (3, _) => body,
        (_, true) => body.stress_state(StressState::PlaneStress),
        // A crack insulates a part of the body.
        (_, false) => body
            .stress_state(StressState::PlaneStress)
            .crack(Crack::Segment {
                from: [-1.0, 6.0],
                to: [9.0, 6.0],
            }),
    };
    let system = body.build().unwrap();
    let conditions = conditions(cloud, whole);
    (system, problem(case, cloud, conditions))
}

fn problem(case: &Case, cloud: &Arc<PointCloud>, conditions: Vec<Condition>) -> Problem {
    let right = |i: usize| cloud.point(i)[0] > 14.3;
    let of_side = |left: f64, of_right: f64| -> Vec<f64> {
        let value = |i| if right(i) { of_right } else { left };
        (0..cloud.len()).map(value).collect()
    };
    let description = DiffusionBody {
        cloud: cloud.clone(),
        influence: Influence::default(),
        horizon: 3.0,
        horizons: case.horizons.then(|| of_side(3.0, 2.2)),
        correction: VolumeCorrection::Extended,
        conductivity: PointScalar::PerPoint(of_side(1.0, 0.3)),
        interface: case.interface,
        surface_correction: case.surface_correction,
        prescribed: Vec::new(),
        broken_share: case.broken_share,
    };
    let diffusion = match case.on_list {
        true => description.build_list(),
        false => description.build(),
    };
    let capacity = |i: usize| cloud.volumes()[i] * (2.0 + 0.3 * cloud.point(i)[1].sin());
    let capacity = (0..cloud.len()).map(capacity).collect();
    Problem::new(diffusion.unwrap(), capacity, conditions).unwrap()
}

/// Every kind of condition; most processes have no points of some of them.
fn conditions(cloud: &Arc<PointCloud>, whole: &PointCloud) -> Vec<Condition> {
    let [_, end] = whole.bounds();
    let set = |wanted: &dyn Fn([f64; 3]) -> bool| -> Vec<u32> {
        (0..cloud.len() as u32)
            .filter(|&i| wanted(cloud.point(i as usize)))
            .collect()
    };
    let measure = |points: &[u32]| {
        let volume = |&i: &u32| cloud.volumes()[i as usize] / 3.0;
        points.iter().map(volume).collect()
    };
    let of_place = |value: fn([f64; 3], f64) -> f64| -> Value {
        let cloud = cloud.clone();
        Arc::new(move |i, t| value(cloud.point(i), t))
    };
    let right = set(&|x| x[0] > end[0] - 1.2);
    let bottom = set(&|x| x[1] < 1.2 && x[0] > 3.5);
    let top = set(&|x| x[1] > end[1] - 1.2 && x[0] > 3.5);
    let all = set(&|_| true);
    vec![
        Condition {
            name: "left".into(),
            points: set(&|x| x[0] < 3.0),
            kind: Kind::Prescribed(of_place(|x, t| 300.0 + 20.0 * t + x[1])),
        },
        Condition {
            name: "right".into(),
            kind: Kind::Exchange {
                law: Exchange::Linear,
                coefficient: 0.7,
                ambient: of_place(|_, _| 350.0),
                area: measure(&right),
            },
            points: right,
        },
        Condition {
            name: "bottom".into(),
            kind: Kind::Exchange {
                law: Exchange::FourthPower,
                coefficient: 1e-9,
                ambient: of_place(|x, _| 700.0 + 9.0 * x[0]),
                area: measure(&bottom),
            },
            points: bottom,
        },
        Condition {
            name: "top".into(),
            kind: Kind::Inflow {
                density: of_place(|_, t| 3.0 * t),
                measure: measure(&top),
            },
            points: top,
        },
        Condition {
            name: "all".into(),
            kind: Kind::Inflow {
                density: of_place(|x, _| -0.5 - 0.01 * x[0]),
                measure: measure(&all),
            },
            points: all,
        },
    ]
}

fn options(scheme: Scheme, step: Option<f64>) -> FieldOptions {
    FieldOptions {
        scheme,
        step,
        dissipation: match scheme {
            Scheme::Steady => 0.0,
            _ => 0.9,
        },
    }
}

fn field(problem: Problem, options: FieldOptions) -> DiffusingField {
    let cloud = problem.diffusion().cloud();
    let value = |i: usize| 300.0 + 30.0 * (1.7 * cloud.domain().number(i) as f64).sin();
    let values = (0..cloud.len()).map(value).collect();
    DiffusingField::new(problem, options, 0.0, values).unwrap()
}

/// Ends of steps; the field is evaluated between them, as by the stages of a scheme.
const TIMES: [f64; 4] = [0.4, 0.9, 1.7, 2.0];

fn proceed(field: &mut DiffusingField, system: &System, times: &[f64]) -> Result<()> {
    let domain = system.domain();
    let mut values = vec![0.0; system.points()];
    for &t in times {
        field.shared().temperatures_into(t - 0.1, &mut values);
        let heat = |i: usize| 0.01 * (1.0 + (domain.number(i) as f64 * t).cos());
        let dissipated: Vec<f64> = (0..system.points()).map(heat).collect();
        field.end_step(BodyStep {
            t,
            forces: system.operator(),
            dissipated: &dissipated,
        })?;
    }
    Ok(())
}

/// Results of the whole body on the first process.
#[derive(Debug, PartialEq)]
struct Found {
    values: Vec<u64>,
    flux: Vec<u64>,
    /// Content, flows, extremes, limit, counts.
    numbers: Vec<u64>,
    archive: Archive,
}

fn found(field: &DiffusingField, system: &System) -> Option<Found> {
    let (t, domain, shared) = (TIMES[3], system.domain(), field.shared());
    let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let mut values = vec![0.0; system.points()];
    field.values_into(t, &mut values);
    let mut flux = vec![0.0; system.dimension() * system.points()];
    field.flux_into(t, &mut flux);
    let effort = shared.effort();
    let counts = [effort.last, effort.most, effort.total];
    let mut numbers = vec![shared.content(t), shared.explicit_limit(t)];
    numbers.extend(shared.flows(t));
    numbers.extend(shared.range(t));
    numbers.extend(counts.map(|count| count as f64));
    numbers.push(shared.with_problem(|problem| problem.diffusion().directed_bonds() as f64));
    let [values, flux] = [&values, &flux].map(|of_own| domain.gather(of_own));
    let archive = saved(field).gathered(domain).unwrap();
    Some(Found {
        values: bits(&values?),
        flux: bits(&flux?),
        numbers: bits(&numbers),
        archive: archive?,
    })
}

fn saved(field: &DiffusingField) -> Archive {
    let mut archive = Archive::default();
    field.save(&mut archive);
    archive
}

/// Runs to the end; returns the results and the checkpoint after two steps.
fn run(
    (case, options): (&Case, FieldOptions),
    whole: &Arc<PointCloud>,
    comm: Arc<dyn Comm>,
) -> Option<(Found, Archive)> {
    let cloud = match comm.size() {
        1 => whole.clone(),
        _ => part(whole, comm),
    };
    let (system, problem) = assemble(case, &cloud, whole);
    let mut field = field(problem, options);
    field.start(system.operator()).unwrap();
    proceed(&mut field, &system, &TIMES[..2]).unwrap();
    let paused = saved(&field).gathered(system.domain()).unwrap();
    proceed(&mut field, &system, &TIMES[2..]).unwrap();
    Some((found(&field, &system)?, paused?))
}

/// Resumes from a checkpoint of the whole body.
fn resume(
    (case, options): (&Case, FieldOptions),
    whole: &Arc<PointCloud>,
    paused: &Archive,
    comm: Arc<dyn Comm>,
) -> Option<Archive> {
    let first = comm.rank() == 0;
    let cloud = part(whole, comm);
    let (system, problem) = assemble(case, &cloud, whole);
    let mut field = field(problem, options);
    field.start(system.operator()).unwrap();
    let own = Archive::scattered(&saved(&field), first.then_some(paused), system.domain());
    field.restore(&own.unwrap()).unwrap();
    proceed(&mut field, &system, &TIMES[2..]).unwrap();
    saved(&field).gathered(system.domain()).unwrap()
}

/// Schemes with the length of their steps.
const SCHEMES: [(Scheme, Option<f64>); 5] = [
    (Scheme::Explicit, None),
    (Scheme::Explicit, Some(0.25)),
    (Scheme::Trapezoidal, None),
    (Scheme::BackwardEuler, Some(0.7)),
    (Scheme::Steady, None),
];

#[test]
fn fields_and_checkpoints_do_not_depend_on_the_division() {
    for case in &CASES {
        let whole = Arc::new((case.body)());
        for (scheme, step) in SCHEMES {
            let of = (case, options(scheme, step));
            let name = format!("{}, {scheme:?} {step:?}", case.name);
            let (expected, paused) = run(of, &whole, Arc::new(Alone)).unwrap();
            for size in 2..=4 {
                let mut parts = Threads::run(size, |comm| run(of, &whole, comm));
                let (found, at_pause) = parts.remove(0).unwrap();
                assert!(parts.iter().all(Option::is_none));
                assert_eq!(at_pause.differences(&paused), [""; 0], "{name}, {size}");
                assert_eq!(
                    found.archive.differences(&expected.archive),
                    [""; 0],
                    "{name}, {size}"
                );
                assert!(found.values == expected.values, "{name}, {size}");
                assert!(found.flux == expected.flux, "{name}, {size}");
                assert_eq!(found.numbers, expected.numbers, "{name}, {size}");
                let mut ends = Threads::run(size, |comm| resume(of, &whole, &paused, comm));
                let end = ends.remove(0).unwrap();
                assert_eq!(
                    end.differences(&expected.archive),
                    [""; 0],
                    "{name}, resumed on {size}"
                );
            }
        }
    }
}

/// Runs the plate on three processes with changed conditions; returns their errors.
fn errors(scheme: Scheme, change: impl Fn(&mut Condition) + Sync) -> Vec<PericlesError> {
    let whole = Arc::new(plate());
    Threads::run(3, |comm| {
        let cloud = part(&whole, comm);
        let (system, _) = assemble(&PLAIN, &cloud, &whole);
        let mut conditions = conditions(&cloud, &whole);
        conditions.iter_mut().for_each(&change);
        let problem = problem(&PLAIN, &cloud, conditions);
        let mut field = field(problem, options(scheme, None));
        let started = field.start(system.operator());
        let ended = started.and_then(|()| proceed(&mut field, &system, &TIMES));
        ended.unwrap_err()
    })
}

#[test]
fn an_error_at_a_point_of_one_process_ends_all_of_them() {
    let errors = errors(Scheme::Explicit, |condition| {
        if condition.name == "right"
            && let Kind::Exchange { ambient, .. } = &mut condition.kind
        {
            *ambient = Arc::new(|_, t| if t > 1.0 { f64::NAN } else { 300.0 });
        }
    });
    let is_on_another = |error: &&PericlesError| matches!(error, PericlesError::OnAnotherProcess);
    assert_eq!(errors.iter().filter(is_on_another).count(), 2, "{errors:?}");
    let own = errors.iter().find(|error| !is_on_another(error)).unwrap();
    assert!(own.to_string().contains("ambient temperature"), "{own}");
}

#[test]
fn a_steady_state_that_is_not_unique_is_an_error_of_all_processes() {
    let errors = errors(Scheme::Steady, |condition| {
        condition.kind = Kind::Inflow {
            density: Arc::new(|_, _| 0.0),
            measure: vec![1.0; condition.points.len()],
        };
    });
    let of = plate().len();
    let expected = HeatError::Undetermined { points: of, of }.to_string();
    for error in &errors {
        assert_eq!(error.to_string(), expected);
    }
}
