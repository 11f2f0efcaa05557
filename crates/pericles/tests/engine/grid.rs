//! The stencil force compared with the neighbour-list force.

use std::sync::Arc;

use pericles::domain::Field;
use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{
    BondMaterial, BondStretch, Calibration, ElasticModulus, Fracture, LinearBond, Modulus, PairLaw,
    StressState,
};
use pericles::neighbourhood::BondSet;
use pericles::operator::{
    BondBody, BondForce, BondForm, DamageMeasure, Force, GridForce, InstructionSet, PointSubset,
    VectorLaw,
};
use pericles::round_trip::check_resume;
use pericles::space::{Grid, PointCloud, Region, Shape};
use pericles::time::{State, VelocityVerlet};
use pericles::{
    Archive, Checkpointed, Control, PericlesError, PointScalar, Simulation, System, Values,
};
use pericles::{Path, StepEnd};

const SPACING: f64 = 0.01;

/// Boxes with and without a hole: with a whole number of chunks, without, and smaller than the horizon.
fn boxes(dimension: usize) -> Vec<(Vec<f64>, bool)> {
    match dimension {
        1 => vec![(vec![40.0], false), (vec![45.0], true), (vec![2.0], false)],
        2 => vec![
            (vec![16.0, 6.0], false),
            (vec![13.0, 7.0], true),
            (vec![2.0, 3.0], false),
        ],
        _ => vec![
            (vec![8.0, 4.0, 3.0], false),
            (vec![11.0, 5.0, 4.0], true),
            (vec![2.0, 1.0, 2.0], false),
        ],
    }
}

fn body(cells: &[f64], holes: bool) -> Arc<PointCloud> {
    let hole = Region::Ball {
        centre: [0.3 + 0.052, -0.1 + 0.031, 0.02],
        radius: 0.016,
    };
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.3, -0.1, 0.0],
            size: cells.iter().map(|count| count * SPACING).collect(),
        },
        spacing: SPACING,
        section: if cells.len() == 3 { 1.0 } else { 0.02 },
        holes: if holes { vec![hole] } else { vec![] },
    };
    Arc::new(grid.points().unwrap())
}

/// A disc, cylinder or ball: rows of all lengths, with empty corners.
fn round(dimension: usize) -> Arc<PointCloud> {
    let shape = match dimension {
        2 => Shape::Disc {
            centre: [0.1, 0.2, 0.0],
            radius: 0.097,
        },
        _ => Shape::Ball {
            centre: [0.1, 0.2, 0.3],
            radius: 0.036,
        },
    };
    let grid = Grid {
        shape,
        spacing: SPACING,
        section: if dimension == 3 { 1.0 } else { 0.02 },
        holes: vec![],
    };
    Arc::new(grid.points().unwrap())
}

fn cracks(dimension: usize) -> Vec<(Crack, EndRule)> {
    match dimension {
        1 => vec![(Crack::Section { x: 0.41 }, EndRule::Closed)],
        2 => vec![
            (
                Crack::Segment {
                    from: [0.3, -0.07],
                    to: [0.35, -0.07],
                },
                EndRule::Closed,
            ),
            (
                Crack::Segment {
                    from: [0.33, -0.1],
                    to: [0.36, -0.05],
                },
                EndRule::Open,
            ),
        ],
        _ => vec![(
            Crack::Disc {
                centre: [0.33, -0.07, 0.02],
                normal: [0.2, 0.1, 1.0],
                radius: 0.025,
            },
            EndRule::Closed,
        )],
    }
}

fn influences() -> Vec<Influence> {
    let on = |function, acts_on| Influence { function, acts_on };
    vec![
        Influence::default(),
        on(InfluenceFunction::Conical, ActsOn::Displacement),
        on(
            InfluenceFunction::Tabulated {
                table: vec![(0.01, 3.0), (0.02, 1.0), (0.03, 0.5)],
            },
            ActsOn::Stretch,
        ),
    ]
}

fn material(
    influence: Influence,
    correction: VolumeCorrection,
    fracture: Fracture,
) -> BondMaterial {
    BondMaterial {
        law: PairLaw::BondStretch,
        density: 1000.0,
        modulus: Modulus {
            value: ElasticModulus::Young(2e9),
            calibration: Calibration::Continuum,
        },
        horizon: 3.0 * SPACING,
        influence,
        volume_correction: correction,
        fracture,
    }
}

fn state(dimension: usize) -> StressState {
    [
        StressState::Uniaxial,
        StressState::PlaneStrain,
        StressState::Spatial,
    ][dimension - 1]
}

/// Both forces of a body; the effects of pre-cracks are compared.
fn pair<L: VectorLaw, const D: usize>(
    cloud: &Arc<PointCloud>,
    material: &BondMaterial,
    cracks: &[(Crack, EndRule)],
    no_fail: &[u32],
    damage: DamageMeasure,
) -> (GridForce<L, D>, BondForce<L, D>) {
    let constants = material.constants(cloud, state(D)).unwrap();
    let body = BondBody {
        cracks,
        no_fail,
        damage,
        ..BondBody::new(cloud, material, &constants)
    };
    let (list, cuts) = body.list().unwrap();
    let grid: GridForce<L, D> = body.grid().unwrap();
    assert_eq!(grid.cuts(), &cuts[..]);
    (grid, list)
}

/// Numbers in (−1, 1).
fn noise(len: usize) -> Vec<f64> {
    (0..len)
        .map(|k| ((k as f64 * 12.9898).sin() * 43758.5453).fract())
        .collect()
}

fn scaled_noise(cloud: &PointCloud, factor: f64) -> Vec<f64> {
    noise(cloud.len() * cloud.dimension())
        .iter()
        .map(|r| factor * r)
        .collect()
}

fn force(operator: &dyn Force, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    operator.add_force(0.0, u, PointSubset::All, &mut out);
    out
}

fn assert_close(a: &[f64], b: &[f64], tolerance: f64, what: &str) {
    let scale = b.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    for (k, (x, y)) in a.iter().zip(b).enumerate() {
        assert!(
            (x - y).abs() <= tolerance * scale,
            "{what}, entry {k}: {x} {y} of {scale}"
        );
    }
}

/// Compares force, energy, tangent, frequency bound and damage of both forms.
fn compare<L: VectorLaw, const D: usize>(
    name: &str,
    cloud: &Arc<PointCloud>,
    material: &BondMaterial,
    cracks: &[(Crack, EndRule)],
) {
    let (mut grid, list) = pair::<L, D>(
        cloud,
        material,
        cracks,
        &[],
        DamageMeasure {
            count: false,
            count_precut: true,
        },
    );
    assert_eq!(grid.directed_bonds(), list.directed_bonds(), "{name}");
    // Strains of 1e-6, of a few per cent (both evaluation forms in one body), and of order one.
    for size in [1e-8, 1.5e-4, 2e-3] {
        let u = scaled_noise(cloud, size);
        let what = format!("{name}, size {size}");
        let expected = force(&list, &u);
        for set in InstructionSet::available() {
            grid = grid.with_instruction_set(set);
            assert_close(&force(&grid, &u), &expected, 1e-12, &what);
        }
        let density = |operator: &dyn Force| {
            let mut out = vec![0.0; cloud.len()];
            operator.add_energy_density(0.0, &u, &mut out);
            out
        };
        assert_close(&density(&grid), &density(&list), 1e-12, &what);
        assert!((grid.energy(0.0, &u) / list.energy(0.0, &u) - 1.0).abs() < 1e-12);
        let direction = noise(u.len());
        let tangent = |operator: &dyn Force| {
            let mut out = vec![1.0; u.len()];
            operator.tangent_into(0.0, &u, &direction, &mut out);
            out
        };
        assert_close(&tangent(&grid), &tangent(&list), 1e-12, &what);
    }
    let bound = |operator: &dyn Force| operator.frequency_bound(&|i| 1000.0 + i as f64);
    assert!((bound(&grid) / bound(&list) - 1.0).abs() < 1e-14, "{name}");
    assert_eq!(damage(&grid), damage(&list), "{name}");
}

fn damage(operator: &dyn Force) -> Vec<f64> {
    let mut out = vec![0.5; operator.points()];
    operator.damage_into(&mut out);
    out
}

fn table<const D: usize>() {
    let mut bodies: Vec<(String, Arc<PointCloud>)> = boxes(D)
        .into_iter()
        .map(|(size, hole)| (format!("{size:?}, hole {hole}"), body(&size, hole)))
        .collect();
    if D > 1 {
        bodies.push(("round".into(), round(D)));
    }
    let corrections = [
        VolumeCorrection::None,
        VolumeCorrection::Linear,
        VolumeCorrection::Extended,
    ];
    for (body, cloud) in &bodies {
        for (influence, correction) in influences().into_iter().zip(corrections) {
            let material = material(influence.clone(), correction, Fracture::Unbreakable);
            for cracks in [vec![], cracks(D)] {
                let name = format!(
                    "{body}, {influence:?}, {correction:?}, {} cracks",
                    cracks.len()
                );
                compare::<BondStretch, D>(&name, cloud, &material, &cracks);
                compare::<LinearBond, D>(&name, cloud, &material, &cracks);
            }
        }
    }
}

#[test]
fn stencil_equals_list_in_1d() {
    table::<1>();
}

#[test]
fn stencil_equals_list_in_2d() {
    table::<2>();
}

#[test]
fn stencil_equals_list_in_3d() {
    table::<3>();
}

/// A notched body in tension.
fn breaking_run(cloud: &Arc<PointCloud>, operator: Box<dyn Force>, steps: u64) -> Simulation {
    let system = System::new(cloud.clone(), operator, PointScalar::Uniform(1000.0)).unwrap();
    let mut start = State::at_rest(cloud.len() * cloud.dimension());
    let middle = cloud.nearest([0.3 + 0.06, -0.1 + 0.03, 0.02]);
    for i in 0..cloud.len() {
        for c in 0..cloud.dimension() {
            start.v[c * cloud.len() + i] = 2e3 * (cloud.point(i)[c] - cloud.point(middle)[c]);
        }
    }
    Simulation::new(system, Box::new(VelocityVerlet), start, 4e-7, steps).unwrap()
}

fn archive(simulation: &Simulation) -> Archive {
    let mut archive = Archive::default();
    simulation.save(&mut archive);
    archive
}

fn breaks_alike<L: VectorLaw, const D: usize>(cloud: &Arc<PointCloud>, measure: DamageMeasure) {
    let material = material(
        Influence::default(),
        VolumeCorrection::Extended,
        Fracture::CriticalStretch(5e-3),
    );
    let no_fail: Vec<u32> = (0..cloud.len() as u32 / 5).collect();
    let (grid, list) = pair::<L, D>(cloud, &material, &cracks(D), &no_fail, measure);
    let bonds = list.directed_bonds() / 2;
    let mut grid = breaking_run(cloud, Box::new(grid), 60);
    let mut list = breaking_run(cloud, Box::new(list), 60);
    grid.run(|_| Control::Continue).unwrap();
    list.run(|_| Control::Continue).unwrap();
    let operators = [grid.system().operator(), list.system().operator()];
    let broken = operators.map(|operator| operator.broken_bonds());
    assert_eq!(broken[0], broken[1]);
    assert!(
        broken[0] > bonds / 20 && broken[0] < bonds,
        "{broken:?} of {bonds}"
    );
    assert_eq!(damage(operators[0]), damage(operators[1]));
    let dissipated = operators.map(|operator| operator.dissipated());
    assert!(
        (dissipated[0] / dissipated[1] - 1.0).abs() < 1e-9,
        "{dissipated:?}"
    );
    assert_close(&grid.state().u, &list.state().u, 1e-9, "displacement");
}

#[test]
fn the_same_bonds_break_as_in_the_neighbour_list() {
    let weighed = DamageMeasure::default();
    let counted = DamageMeasure {
        count: true,
        count_precut: true,
    };
    breaks_alike::<BondStretch, 1>(&body(&[45.0], true), weighed);
    breaks_alike::<BondStretch, 2>(&body(&[21.0, 13.0], true), counted);
    breaks_alike::<LinearBond, 2>(&body(&[16.0, 13.0], false), weighed);
    breaks_alike::<BondStretch, 2>(&round(2), weighed);
    breaks_alike::<BondStretch, 3>(&body(&[11.0, 7.0, 4.0], true), weighed);
    breaks_alike::<LinearBond, 3>(&body(&[9.0, 6.0, 4.0], false), counted);
}

/// A plate whose left part is strained beyond the range of the fast form.
fn mixed_strains(cloud: &PointCloud) -> Vec<f64> {
    let n = cloud.len();
    let mut u = scaled_noise(cloud, 1e-6);
    for (k, u) in u.iter_mut().enumerate() {
        if cloud.point(k % n)[0] < 0.37 {
            *u *= 1e3;
        }
    }
    u
}

#[test]
fn evaluations_on_subsets_are_bitwise_identical_to_the_full_evaluation() {
    let cloud = body(&[21.0, 6.0, 4.0], true);
    let n = cloud.len();
    let u = mixed_strains(&cloud);
    let material = material(
        Influence::default(),
        VolumeCorrection::Linear,
        Fracture::Unbreakable,
    );
    for set in InstructionSet::available() {
        let make = || {
            let (grid, _) = pair::<BondStretch, 3>(
                &cloud,
                &material,
                &cracks(3),
                &[],
                DamageMeasure::default(),
            );
            grid.with_instruction_set(set)
        };
        let grid = make();
        let whole = force(&grid, &u);
        let third: Vec<u32> = (0..n as u32).filter(|i| i % 3 == 1).collect();
        let mut parts = vec![0.0; 3 * n];
        grid.add_force(0.0, &u, PointSubset::Set(&third), &mut parts);
        for i in (0..n).filter(|i| i % 3 != 1) {
            // The padded rows of a new operator contain no values of other points.
            let fresh = if i % 97 == 0 { Some(make()) } else { None };
            let operator = fresh.as_ref().unwrap_or(&grid);
            operator.add_force(0.0, &u, PointSubset::Range(i..i + 1), &mut parts);
        }
        assert!(parts == whole, "{set:?}");
        let mut range = vec![0.0; 3 * n];
        make().add_force(0.0, &u, PointSubset::Range(100..n - 37), &mut range);
        for c in 0..3 {
            assert_eq!(
                range[c * n + 100..(c + 1) * n - 37],
                whole[c * n + 100..(c + 1) * n - 37]
            );
            assert!(range[c * n..c * n + 100].iter().all(|&x| x == 0.0));
        }
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let cloud = body(&[45.0, 40.0], true);
    let material = material(
        Influence::default(),
        VolumeCorrection::Extended,
        Fracture::CriticalStretch(5e-3),
    );
    let on = |threads| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap()
            .install(|| {
                let (grid, _) = pair::<BondStretch, 2>(
                    &cloud,
                    &material,
                    &cracks(2),
                    &[],
                    DamageMeasure::default(),
                );
                let mut run = breaking_run(&cloud, Box::new(grid), 30);
                run.run(|_| Control::Continue).unwrap();
                assert!(run.system().operator().broken_bonds() > 100);
                archive(&run)
            })
    };
    let one = on(1);
    for threads in [2, 3, 7] {
        assert!(on(threads) == one, "{threads} threads");
    }
}

#[test]
fn breaking_on_subsets_equals_breaking_at_once() {
    let cloud = body(&[21.0, 6.0, 4.0], true);
    let n = cloud.len();
    let u = mixed_strains(&cloud);
    let v: Vec<f64> = (0..3 * n).map(|k| ((k * k + 1) as f64).cos()).collect();
    let end = StepEnd {
        t: 0.0,
        dt: 1e-8,
        u: &u,
        path: Path::MeanVelocity(&v),
    };
    // Beyond the range of the fast form, so that bonds break under both forms.
    let material = material(
        Influence::default(),
        VolumeCorrection::Linear,
        Fracture::CriticalStretch(0.03),
    );
    let make = || pair::<BondStretch, 3>(&cloud, &material, &[], &[], DamageMeasure::default());
    let (mut at_once, mut list) = make();
    let mut expected = vec![0.0; 3 * n];
    at_once.end_step(&end, PointSubset::All, &mut expected);
    let mut by_list = vec![0.0; 3 * n];
    list.end_step(&end, PointSubset::All, &mut by_list);
    assert_close(&expected, &by_list, 1e-12, "force");
    assert_eq!(at_once.bonds().broken_bonds(), list.bonds().broken_bonds());
    assert!((at_once.bonds().dissipated() / list.bonds().dissipated() - 1.0).abs() < 1e-12);
    assert!(at_once.bonds().broken_bonds() > 100);

    let (mut in_parts, _) = make();
    let odd: Vec<u32> = (0..n as u32).filter(|i| i % 2 == 1).collect();
    let mut unused = vec![0.0; 3 * n];
    in_parts.end_step(&end, PointSubset::Set(&odd), &mut unused);
    in_parts.end_step(&end, PointSubset::Range(0..n), &mut unused);
    assert!(force(&in_parts, &u) == expected);
    assert_eq!(
        in_parts.bonds().broken_bonds(),
        at_once.bonds().broken_bonds()
    );
    assert!((in_parts.bonds().dissipated() / at_once.bonds().dissipated() - 1.0).abs() < 1e-12);

    let (mut history, _) = make();
    let before = history.energy(0.0, &u);
    history.end_step(
        &StepEnd::sub_step(0.0, 0.0, &u),
        PointSubset::All,
        &mut vec![0.0; u.len()],
    );
    let lost = before - history.energy(0.0, &u);
    assert!((history.bonds().dissipated() / lost - 1.0).abs() < 1e-12);
    assert_eq!(
        history.bonds().broken_bonds(),
        at_once.bonds().broken_bonds()
    );
}

#[test]
fn stop_and_resume_equals_the_uninterrupted_run() {
    let cloud = body(&[21.0, 13.0], true);
    let material = material(
        Influence::default(),
        VolumeCorrection::Extended,
        Fracture::CriticalStretch(5e-3),
    );
    let run = || {
        let (grid, _) =
            pair::<BondStretch, 2>(&cloud, &material, &cracks(2), &[], DamageMeasure::default());
        breaking_run(&cloud, Box::new(grid), 60)
    };
    let mut first = run();
    first
        .run(|s| {
            if s.state().step == 41 {
                Control::Stop
            } else {
                Control::Continue
            }
        })
        .unwrap();
    assert!(first.system().operator().broken_bonds() > 0);
    check_resume(run, [41]).unwrap();
    assert!(run().restore(&Archive::default()).is_err());

    // A bond to a position without a point, or a bond that a crack removed.
    let mut strange = archive(&first);
    let intact = strange.arrays()["operator/grid/bonds"].clone();
    let Values::U8(mut intact) = intact else {
        panic!("bytes");
    };
    intact.fill(0xFF);
    strange.put("operator/grid/bonds", Values::U8(intact));
    let told = run().restore(&strange).unwrap_err().to_string();
    assert!(told.contains("bonds near point"), "{told}");
}

#[test]
fn memory_per_point_is_as_documented() {
    // 46³ points with 122 neighbours: masks 16 B, padded displacement 27 B; with u, v, a (72 B) and the cloud (36
    // B) about 150 B in total.
    let cloud = body(&[46.0, 46.0, 46.0], false);
    let mut material = material(
        Influence::default(),
        VolumeCorrection::Linear,
        Fracture::Unbreakable,
    );
    material.horizon = 3.015 * SPACING;
    let constants = material.constants(&cloud, StressState::Spatial).unwrap();
    let grid = GridForce::<BondStretch, 3>::new(
        cloud.clone(),
        &material,
        &constants,
        &[],
        &[],
        DamageMeasure::default(),
    )
    .unwrap();
    assert_eq!(grid.directed_bonds(), 11_006_544);
    let per_point = grid.bytes() as f64 / cloud.len() as f64;
    assert!(per_point < 48.0, "{per_point}");
}

#[test]
fn invalid_arguments_are_errors() {
    let cloud = body(&[12.0, 9.0], false);
    let material = material(
        Influence::default(),
        VolumeCorrection::None,
        Fracture::Unbreakable,
    );
    let constants = material
        .constants(&cloud, StressState::PlaneStrain)
        .unwrap();
    let make = |cloud: &Arc<PointCloud>, material: &BondMaterial, cracks: &[(Crack, EndRule)]| {
        GridForce::<BondStretch, 2>::new(
            cloud.clone(),
            material,
            &constants,
            cracks,
            &[],
            DamageMeasure::default(),
        )
        .map(|_| ())
    };
    assert!(make(&cloud, &material, &[]).is_ok());
    let scattered = PointCloud::new(
        2,
        cloud.positions().to_vec(),
        cloud.volumes().to_vec(),
        0.02,
    )
    .unwrap();
    assert!(matches!(
        make(&Arc::new(scattered), &material, &[]),
        Err(PericlesError::FormNotUsable { .. })
    ));
    assert!(matches!(
        make(&body(&[12.0], false), &material, &[]),
        Err(PericlesError::WrongDimension { .. })
    ));
    assert!(matches!(
        make(&cloud, &material, &cracks(3)),
        Err(PericlesError::WrongDimension { .. })
    ));
    let mut short = material.clone();
    short.horizon = 0.9 * SPACING;
    assert!(matches!(
        make(&cloud, &short, &[]),
        Err(PericlesError::HorizonTooSmall { .. })
    ));
}

#[test]
fn the_fastest_form_is_the_stencil_on_lattices() {
    let form = |cloud: &Arc<PointCloud>, form| {
        let dimension = cloud.dimension();
        let mut material = material(
            Influence::default(),
            VolumeCorrection::None,
            Fracture::Unbreakable,
        );
        material.law = PairLaw::Linear;
        let constants = material.constants(cloud, state(dimension)).unwrap();
        let body = BondBody {
            cracks: &cracks(dimension),
            ..BondBody::new(cloud, &material, &constants)
        };
        body.operator(form).unwrap()
    };
    for dimension in 1..=3 {
        let cloud = body(&vec![12.0; dimension], true);
        let fastest = form(&cloud, BondForm::Fastest);
        let list = form(&cloud, BondForm::List);
        assert_eq!((fastest.form, list.form), (BondForm::Grid, BondForm::List));
        assert_eq!(fastest.cuts, list.cuts);
        let u = scaled_noise(&cloud, 1e-6);
        let expected = force(&*list.operator, &u);
        assert_close(&force(&*fastest.operator, &u), &expected, 1e-12, "form");
    }
    // The bounding box of a thin ring is mostly empty.
    let ring = Grid {
        shape: Shape::Disc {
            centre: [0.0; 3],
            radius: 1.0,
        },
        spacing: SPACING,
        section: 1.0,
        holes: vec![Region::Ball {
            centre: [0.0; 3],
            radius: 0.96,
        }],
    };
    let ring = Arc::new(ring.points().unwrap());
    assert_eq!(form(&ring, BondForm::Fastest).form, BondForm::List);
    let scattered = PointCloud::new(1, vec![0.0, 0.01, 0.025], vec![1e-4; 3], 0.01).unwrap();
    let scattered = Arc::new(scattered);
    assert_eq!(form(&scattered, BondForm::Fastest).form, BondForm::List);
}

/// The single bonds that a stencil lists are those whose forces it sums.
#[test]
fn single_bonds_add_up_to_the_force() {
    for holes in [false, true] {
        let cloud = body(&[13.0, 7.0], holes);
        let material = material(
            Influence::default(),
            VolumeCorrection::Extended,
            Fracture::Unbreakable,
        );
        let constants = material
            .constants(&cloud, StressState::PlaneStress)
            .unwrap();
        let crack = Crack::Segment {
            from: [0.3, -0.065],
            to: [0.36, -0.065],
        };
        let operator = GridForce::<BondStretch, 2>::new(
            cloud.clone(),
            &material,
            &constants,
            &[(crack, EndRule::Closed)],
            &[],
            DamageMeasure::default(),
        )
        .unwrap();
        let n = cloud.len();
        let u: Vec<f64> = (0..2 * n).map(|k| 1e-5 * (k as f64 * 0.73).sin()).collect();
        let mut force = vec![0.0; 2 * n];
        operator.add_force(0.0, &u, PointSubset::All, &mut force);
        let scale = force.iter().fold(0.0f64, |a, f| a.max(f.abs()));
        let (bonds, mut count) = (operator.capabilities().bonds.unwrap(), 0);
        let values = bonds.values_at(Field::new(&u, &[]));
        for i in 0..n {
            let mut sum = [0.0; 3];
            bonds.for_each_bond(&values, i, &mut |bond| {
                count += 1;
                for c in 0..2 {
                    let xi = cloud.point(bond.neighbour)[c] - cloud.point(i)[c];
                    assert!((bond.xi[c] - xi).abs() < 1e-12);
                    sum[c] += bond.force[c];
                }
            });
            for c in 0..2 {
                assert!((sum[c] - force[c * n + i]).abs() < 1e-9 * scale, "{i}");
            }
        }
        assert_eq!(count, operator.directed_bonds());
    }
}
