//! A small plate that fractures, observed by all observers.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex};

use pericles::boundary::{MotionKind, PrescribedMotion, TimeFunction};
use pericles::family::{BondList, Crack, EndRule, VolumeCorrection};
use pericles::material::BondStretch;
use pericles::observe::{CrackTracker, Field, Probe, Schedule, TrackedCrack};
use pericles::operator::{BondForce, Breaking, DamageMeasure};
use pericles::round_trip::check_resume;
use pericles::space::{Face, Grid, Region, Shape};
use pericles::time::{State, VelocityVerlet};
use pericles::{Archive, Checkpointed, Control, Outcome, PointScalar, Simulation, System, Values};
use pericles_manifold::EnergyInequality;
use pericles_waves::exact::LineSolution;

use super::*;
use crate::{CsvData, IoError, read_csv};

const STEPS: u64 = 60;

/// A notched plate whose upper edge moves at constant velocity while the lower edge is fixed.
fn simulation(folder: &Path) -> Simulation {
    let shape = Shape::Box {
        origin: [0.0; 3],
        size: vec![12.0, 8.0],
    };
    let grid = Grid {
        shape,
        spacing: 1.0,
        section: 1.0,
        holes: vec![],
    };
    let cloud = Arc::new(grid.points().unwrap());
    let mut bonds = BondList::new(&cloud, 2.0, VolumeCorrection::Extended).unwrap();
    let crack = Crack::Segment {
        from: [0.0, 4.0],
        to: [4.0, 4.0],
    };
    let points = bonds.cut(&crack, EndRule::Closed).unwrap().points;
    let breaking = Breaking {
        critical_stretch: 0.02,
        no_fail: &[],
    };
    let force = BondForce::<BondStretch, 2>::with_stiffness(
        cloud.clone(),
        bonds,
        &|_| 1.0,
        breaking,
        DamageMeasure::default(),
    )
    .unwrap();
    let mut system =
        System::new(cloud.clone(), Box::new(force), PointScalar::Uniform(1.0)).unwrap();
    let state = State::at_rest(2 * cloud.len());
    for (name, speed) in [("-y", 0.0), ("+y", 0.02)] {
        let layer = cloud.select(&Region::Layer {
            face: Face::named(name).unwrap(),
            depth: 1.0,
        });
        let motion = PrescribedMotion::new(
            name.into(),
            layer,
            MotionKind::Velocity,
            [None, Some(speed), None],
            TimeFunction::Constant,
            &state.u,
            cloud.len(),
        )
        .unwrap();
        system.add_motion(motion).unwrap();
    }
    let reactions = SignalTable::new(
        folder.join("reactions.csv"),
        "observer/reactions",
        ReactionSignals::new(&system),
    );
    let mut simulation =
        Simulation::new(system, Box::new(VelocityVerlet), state, 0.2, STEPS).unwrap();
    let tracker = CrackTracker::new(&cloud, vec![TrackedCrack { crack, points }], 0.35).unwrap();
    let probe = Probe {
        name: "corner".into(),
        points: vec![0],
    };
    fs::create_dir_all(folder.join("fields")).unwrap();
    fs::create_dir_all(folder.join("pictures")).unwrap();
    let pictures = Pictures::new(
        folder.join("pictures"),
        "Damage",
        PictureOf::new(Field::Damage),
    )
    .animated();
    let cracks = Cracks::new(folder.join("cracks.csv"), tracker, 2);
    // Not the exact solution of this body: the test only needs that the maximum error is saved and restored.
    let line = LineSolution {
        young: 1.0,
        density: 1.0,
        length: 2.0,
        width: 3.0,
        amplitude: 0.1,
        centre: 6.0,
    };
    let errors = ErrorColumns::new(Box::new(line), (0..cloud.len() as u32).collect());
    let bound = EnergyBoundColumns {
        inequality: EnergyInequality::new(0.1),
        units: cloud.body_units(),
    };
    let rows = HistoryRows::new(&cloud).with(errors).with(bound);
    let history = History::new(folder.join("history.csv"), rows);
    let probes = SignalTable::new(
        folder.join("probes.csv"),
        "observer/probes",
        ProbeSignals {
            probes: vec![probe],
            dimension: 2,
        },
    );
    simulation.observe(Schedule::Every(4), Box::new(history));
    simulation.observe(Schedule::Every(4), Box::new(reactions));
    simulation.observe(Schedule::Every(6), Box::new(cracks));
    simulation.observe(Schedule::Every(5), Box::new(probes));
    simulation.observe(
        Schedule::Every(20),
        Box::new(FieldSeries::new(folder, false)),
    );
    simulation.observe(Schedule::Every(30), Box::new(pictures));
    simulation
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(place) = open.pop() {
        for entry in fs::read_dir(place).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap();
                found.insert(name.display().to_string(), fs::read(&path).unwrap());
            }
        }
    }
    found
}

fn whole_run(folder: &Path) -> Simulation {
    let mut simulation = simulation(folder);
    let outcome = simulation.run(|_| Control::Continue).unwrap();
    assert_eq!(outcome, Outcome::Finished);
    simulation
}

#[test]
fn tables_in_memory_equal_those_of_files() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = simulation(folder.path());
    let rows: Arc<Mutex<CsvData>> = Arc::default();
    let probe = Probe {
        name: "corner".into(),
        points: vec![0],
    };
    let signals = ProbeSignals {
        probes: vec![probe],
        dimension: 2,
    };
    let target = TableTarget::Memory(Arc::clone(&rows));
    let kept = SignalTable::new(target, "observer/kept", signals);
    run.observe(Schedule::Every(5), Box::new(kept));
    let outcome = run.run(|run| match run.state().step {
        30 => Control::Stop,
        _ => Control::Continue,
    });
    assert_eq!(outcome.unwrap(), Outcome::Stopped);
    let mut archive = Archive::default();
    run.save(&mut archive);
    run.run(|_| Control::Continue).unwrap();
    let of_file = read_csv(folder.path().join("probes.csv")).unwrap();
    assert!(of_file.rows() as u64 == STEPS / 5 + 1);
    assert_eq!(rows.lock().unwrap().values, of_file.values);
    let names = |table: &CsvData| -> Vec<String> {
        let columns = table.columns.iter();
        columns.map(|column| column.name().to_owned()).collect()
    };
    assert_eq!(names(&rows.lock().unwrap()), names(&of_file));
    // A restored run computes its later rows again.
    run.restore(&archive).unwrap();
    run.run(|_| Control::Continue).unwrap();
    assert_eq!(rows.lock().unwrap().values, of_file.values);
}

#[test]
fn tables_agree_with_the_simulation() {
    let folder = tempfile::tempdir().unwrap();
    let run = whole_run(folder.path());
    let read = |name: &str| read_csv(folder.path().join(name)).unwrap();

    let history = read("history.csv");
    assert_eq!(history.rows() as u64, STEPS / 4 + 1);
    let energies = run.snapshot().energies();
    let last = |name: &str| *history.column(name).unwrap().last().unwrap();
    assert_eq!(last("kinetic_energy"), energies.kinetic);
    assert_eq!(last("external_work"), energies.work);
    assert_eq!(last("step"), STEPS as f64);
    let broken = run.system().operator().broken_bonds();
    assert!(
        broken > 10,
        "the test requires that the plate breaks: {broken}"
    );
    assert_eq!(last("broken_bonds"), broken as f64);
    let sum = last("kinetic_energy") + last("elastic_energy") + last("dissipated_energy");
    // The upper layer moves from the start.
    let initial = history.column("kinetic_energy").unwrap()[0];
    assert!(initial > 0.0);
    let balance = sum + last("scheme_correction") - last("external_work") - initial;
    assert!((balance - last("balance")).abs() < 1e-12 * sum);

    // The support at the top pulls upwards.
    let reactions = read("reactions.csv");
    assert!(reactions.column("+y_y").unwrap()[5] > 0.0);
    assert!(
        reactions.column("+y_x").is_none(),
        "unconstrained axes have no column"
    );

    let cracks = read("cracks.csv");
    let advance = cracks.column("advance").unwrap();
    assert_eq!(advance[0], 0.0);
    assert!(advance.last().unwrap() > &0.4);
    let tip = cracks.column("tip_x").unwrap();
    assert!(tip[0].is_nan() && tip.last().unwrap() > &4.0);

    let probes = read("probes.csv");
    assert_eq!(probes.rows() as u64, STEPS / 5 + 1);
    assert_eq!(
        probes.column("corner_u_x").unwrap().last(),
        run.state().u.first()
    );

    let written = files(folder.path());
    for name in [
        "fields/fields_000003.vtu",
        "pictures/Damage-000002.png",
        "pictures/Damage.apng",
        "fields.pvd",
    ] {
        assert!(written.contains_key(name), "{name}");
    }
}

#[test]
fn stopped_and_resumed_runs_leave_the_same_bytes() {
    let whole = tempfile::tempdir().unwrap();
    whole_run(whole.path());
    let expected = files(whole.path());

    for stop in [1, 23, 40, STEPS - 1] {
        let folder = tempfile::tempdir().unwrap();
        let mut first = simulation(folder.path());
        let mut archive = Archive::default();
        // The checkpoint is a few steps before the stop: output written in between must be removed.
        first
            .run(|run| {
                if run.state().step == stop {
                    archive = Archive::default();
                    run.save(&mut archive);
                }
                if run.state().step == stop + 7 {
                    Control::Stop
                } else {
                    Control::Continue
                }
            })
            .unwrap();
        drop(first);
        let mut second = simulation(folder.path());
        second.restore(&archive).unwrap();
        second.run(|_| Control::Continue).unwrap();
        let found = files(folder.path());
        assert_eq!(
            found.keys().collect::<Vec<_>>(),
            expected.keys().collect::<Vec<_>>()
        );
        for (name, bytes) in &expected {
            assert!(
                found[name] == *bytes,
                "{name} differs after a stop at {stop}"
            );
        }
    }
}

#[test]
fn observers_resume_from_checkpoints() {
    let folder = tempfile::tempdir().unwrap();
    check_resume(|| simulation(folder.path()), [23]).unwrap();
}

#[test]
fn a_modified_table_is_rejected_on_resume() {
    let folder = tempfile::tempdir().unwrap();
    let run = whole_run(folder.path());
    let mut archive = Archive::default();
    run.save(&mut archive);
    fs::write(folder.path().join("probes.csv"), "step\n").unwrap();
    let error = simulation(folder.path()).restore(&archive).unwrap_err();
    assert!(error.to_string().contains("probes.csv"), "{error}");
}

#[test]
fn missing_pictures_are_rejected_on_resume() {
    let folder = tempfile::tempdir().unwrap();
    let run = whole_run(folder.path());
    let mut archive = Archive::default();
    run.save(&mut archive);
    for drawn in [4, u64::MAX] {
        let mut spoilt = archive.clone();
        spoilt.put("observer/pictures/Damage", Values::U64(vec![drawn]));
        let error = simulation(folder.path()).restore(&spoilt).unwrap_err();
        assert!(
            error.to_string().contains(&format!("{drawn} pictures")),
            "{error}"
        );
    }
    simulation(folder.path()).restore(&archive).unwrap();
}

#[test]
fn file_errors_are_returned_as_io_errors() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = simulation(folder.path());
    fs::remove_dir(folder.path().join("fields")).unwrap();
    let error = run.run(|_| Control::Continue).unwrap_err();
    let pericles::SimulationError::Observe(source) = error else {
        panic!("{error}");
    };
    let source = source.downcast_ref::<IoError>().unwrap();
    assert!(source.is_output_problem(), "{source}");
}
