//! Runs as a library: started, cancelled, resumed on another thread, finished.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

use pericles_deck::{Deck, Model};
use pericles_io::OutputFolder;
use pericles_run::{
    Assembled, Caching, Cancel, Deadline, Ending, Event, FieldFile, Means, Results, Run, RunError,
    Source, SourceRecord, Status,
};

const PLATE: &str = r#"
title = "Torn plate"
[body]
shape = "plate"
size = ["24 mm", "12 mm"]
spacing = "1 mm"
plane = "stress"
[material]
youngs_modulus = "72 GPa"
density = 2440
horizon_ratio = 3
critical_stretch = 0.002
[sets.top]
layer = { side = "+y", cells = 1 }
[[crack]]
segment = [["0 mm", "6 mm"], ["8 mm", "6 mm"]]
[[constraint]]
set = "top"
velocity = ["free", "4 m/s"]
[time]
end = "4 us"
dt = "0.1 us"
[output]
history = { every = 1 }
"#;

fn means() -> Means {
    Means {
        caching: Caching::Off,
        ..Means::default()
    }
}

fn plate(overrides: &[String]) -> Deck {
    Deck::parse(PLATE, "plate.toml", overrides).unwrap()
}

fn begun(folder: &Path) -> Run {
    begun_of(&Source::of_deck(plate(&[]), "plate.toml".into()), folder)
}

fn begun_of(source: &Source, folder: &Path) -> Run {
    let assembled = Assembled::of(source, &means(), &mut |_| {}).unwrap();
    let folder = OutputFolder::create(folder, false).unwrap();
    Run::begin(source, assembled, folder).unwrap()
}

fn history(folder: &Path) -> String {
    fs::read_to_string(folder.join("history.csv")).unwrap()
}

#[test]
fn a_cancelled_run_resumed_on_another_thread_gives_identical_results() {
    let place = tempfile::tempdir().unwrap();
    let (whole, parts) = (place.path().join("whole"), place.path().join("parts"));
    let mut run = begun(&whole);
    let mut steps = Vec::new();
    let ending = run.drive(None, &Cancel::new(), &mut |event| {
        if let Event::Step { step, .. } = event {
            steps.push(step);
        }
    });
    assert_eq!(ending.unwrap(), Ending::Finished);
    assert_eq!(run.report().status, Status::Finished);
    let last = run.simulation().steps();
    assert_eq!(steps, (1..last).collect::<Vec<_>>());
    assert!(run.report().audit.is_some());
    drop(run);

    let mut run = begun(&parts);
    let cancel = Cancel::new();
    let token = cancel.clone();
    let ending = run.drive(None, &cancel, &mut |event| {
        if let Event::Step { step: 3, .. } = event {
            token.cancel();
        }
    });
    assert_eq!(ending.unwrap(), Ending::Cancelled);
    assert_eq!(run.simulation().state().step, 3);
    assert_eq!(run.report().status, Status::Stopped);
    drop(run);
    let folder = parts.clone();
    let resumed = thread::spawn(move || {
        let mut run =
            Run::resume(&folder, &means(), &mut |_| {})?.expect("the run has not finished");
        run.drive(None, &Cancel::new(), &mut |_| {})
    });
    assert_eq!(resumed.join().unwrap().unwrap(), Ending::Finished);
    assert_eq!(history(&whole), history(&parts));
    assert!(
        Run::resume(&parts, &means(), &mut |_| {})
            .unwrap()
            .is_none()
    );
    let results = Results::open(&parts).unwrap();
    assert_eq!(results.text("/status"), "finished");
    assert_eq!(results.count("/progress/first_step"), 3);
}

#[test]
fn a_stopped_run_may_be_driven_again_and_stops_at_a_deadline() {
    let place = tempfile::tempdir().unwrap();
    let (whole, parts) = (place.path().join("whole"), place.path().join("parts"));
    let ending = begun(&whole).drive(None, &Cancel::new(), &mut |_| {});
    assert_eq!(ending.unwrap(), Ending::Finished);
    let mut run = begun(&parts);
    let over = Deadline::from_now(Some(std::time::Duration::ZERO));
    let ending = run.drive(over, &Cancel::new(), &mut |_| {});
    assert_eq!(ending.unwrap(), Ending::Deadline);
    let ending = run.drive(None, &Cancel::new(), &mut |_| {});
    assert_eq!(ending.unwrap(), Ending::Finished);
    assert_eq!(history(&whole), history(&parts));
}

#[test]
fn an_extended_run_equals_one_with_the_later_end() {
    let place = tempfile::tempdir().unwrap();
    let (whole, parts) = (place.path().join("whole"), place.path().join("parts"));
    let source = |overrides: &[&str]| {
        let overrides: Vec<String> = overrides.iter().map(|&one| one.into()).collect();
        Source::of_deck(plate(&overrides), "plate.toml".into())
    };
    // The automatic step of the shorter run, 4 us in 12 steps, is kept.
    for [shorter, dt] in [
        ["time.end=2 us", "time.dt=0.1 us"],
        ["time.end=4 us", "time.dt=auto"],
    ] {
        let mut run = begun_of(&source(&[shorter, dt]), &parts);
        assert_eq!(
            run.drive(None, &Cancel::new(), &mut |_| {}).unwrap(),
            Ending::Finished
        );
        let dt = run.simulation().dt();
        drop(run);
        let extend = |change: &str| Run::extend(&parts, &[change.into()], &means(), &mut |_| {});
        let mut run = extend("time.end=8 us")
            .unwrap()
            .expect("the run is extended");
        assert_eq!(
            run.drive(None, &Cancel::new(), &mut |_| {}).unwrap(),
            Ending::Finished
        );
        let end = run.simulation().state().t;
        assert!((8e-6..8e-6 + dt).contains(&(end * (1.0 + 1e-12))), "{end}");
        drop(run);
        let fixed = [format!("time.end={end:?}"), format!("time.dt={dt:?}")];
        let mut run = begun_of(&source(&[&fixed[0], &fixed[1]]), &whole);
        run.drive(None, &Cancel::new(), &mut |_| {}).unwrap();
        assert_eq!(history(&whole), history(&parts));
        for (change, expected) in [
            ("time.end=1 us", "must be later"),
            ("time.dt=1 us", "`time.dt` cannot be changed"),
        ] {
            let error = extend(change).map(|_| ()).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
        fs::remove_dir_all(&whole).unwrap();
        fs::remove_dir_all(&parts).unwrap();
    }
}

/// The loads of static runs are multiples of their values at the end.
#[test]
fn a_static_run_whose_loads_follow_from_its_end_is_not_extended() {
    let place = tempfile::tempdir().unwrap();
    let statics = [
        "sets.bottom={ layer = { side = \"-y\", cells = 1 } }",
        "material.critical_stretch=unset",
        "time.scheme=static",
        "time.dt=unset",
        "time.load_steps=2",
        "time.end=1",
    ];
    let [pulled, driven] = [
        "constraint=[{ set = \"bottom\", displacement = [0, 0] }, { set = \"top\", displacement = [0, \"1 um\"] }]",
        "constraint=[{ set = \"bottom\", displacement = [0, 0] }, { set = \"top\", displacement = [0, { expression = \"1e-6*t\" }] }]",
    ];
    for (constraint, is_extended) in [(pulled, false), (driven, true)] {
        let folder = place.path().join(is_extended.to_string());
        let overrides: Vec<String> = statics
            .iter()
            .chain([&constraint])
            .map(|&one| one.into())
            .collect();
        let mut run = begun_of(
            &Source::of_deck(plate(&overrides), "plate.toml".into()),
            &folder,
        );
        run.drive(None, &Cancel::new(), &mut |_| {}).unwrap();
        drop(run);
        let extended = Run::extend(&folder, &["time.end=2".into()], &means(), &mut |_| {});
        match (extended, is_extended) {
            (Ok(Some(mut run)), true) => {
                run.drive(None, &Cancel::new(), &mut |_| {}).unwrap();
                assert_eq!(run.simulation().state().step, 4);
            }
            (Err(error), false) => {
                assert!(error.to_string().contains("changes the past"), "{error}")
            }
            (extended, _) => panic!("{constraint}: {:?}", extended.map(|_| ())),
        }
    }
}

#[test]
fn a_folder_without_a_run_cannot_be_resumed() {
    let place = tempfile::tempdir().unwrap();
    let resumed = Run::resume(place.path(), &means(), &mut |_| {});
    assert!(matches!(resumed.err(), Some(RunError::NoRun { .. })));
}

/// Returns the names and contents of the field files, in order.
fn fields(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let states = Results::open(folder).unwrap().fields().unwrap();
    let content = |state: FieldFile| {
        let name = state.path.file_name().unwrap().into();
        (name, fs::read(&state.path).unwrap())
    };
    states.into_iter().map(content).collect()
}

#[test]
fn a_stopped_and_resumed_model_gives_the_same_results_as_its_deck() {
    let place = tempfile::tempdir().unwrap();
    let (of_deck, of_model) = (place.path().join("deck"), place.path().join("model"));
    // Numbers without a short decimal form, and a title that must be stored.
    let overrides = [
        "output.fields={ every = 10 }".to_owned(),
        format!(
            "crack.0.segment=[[0, {}], [8e-3, {}]]",
            0.018 / 3.0,
            0.1 * 0.06
        ),
        format!("material.density={}", 7319.0 / 3.0),
    ];
    let deck = plate(&overrides);
    let json = serde_json::to_string(&deck.model).unwrap();
    let source = Source::of_deck(deck, "plate.toml".into());
    let ending = begun_of(&source, &of_deck).drive(None, &Cancel::new(), &mut |_| {});
    assert_eq!(ending.unwrap(), Ending::Finished);

    let model: Model = serde_json::from_str(&json).unwrap();
    let source = Source::of_model(model.clone(), Path::new(""));
    let mut run = begun_of(&source, &of_model);
    let cancel = Cancel::new();
    let token = cancel.clone();
    let ending = run.drive(None, &cancel, &mut |event| {
        if let Event::Step { step: 17, .. } = event {
            token.cancel();
        }
    });
    assert_eq!(ending.unwrap(), Ending::Cancelled);
    drop(run);
    let folder = of_model.clone();
    let resumed = thread::spawn(move || {
        let mut run =
            Run::resume(&folder, &means(), &mut |_| {})?.expect("the run has not finished");
        run.drive(None, &Cancel::new(), &mut |_| {})
    });
    assert_eq!(resumed.join().unwrap().unwrap(), Ending::Finished);

    let results = Results::open(&of_model).unwrap();
    assert!(
        results.count("/progress/first_step") == 17 && results.count("/audit/broken_bonds") > 0
    );
    assert_eq!(results.text("/title"), "Torn plate");
    assert_eq!(history(&of_deck), history(&of_model));
    let written = fields(&of_model);
    assert_eq!(written.len(), 5);
    assert_eq!(fields(&of_deck), written);
    // The model is restored from the folder, for points and pictures.
    let SourceRecord::Model(data) = results.source().unwrap() else {
        panic!("the folder of a model contains a deck");
    };
    assert_eq!(data.model, model);
}

#[test]
fn a_model_with_a_changed_file_is_not_resumed() {
    let place = tempfile::tempdir().unwrap();
    let table = place.path().join("start.txt");
    let rows: String = (0..24 * 12)
        .map(|k| format!("0 0 {} 0\n", 1e-3 * f64::from(k)))
        .collect();
    fs::write(&table, &rows).unwrap();
    let mut model = plate(&[]).model;
    let initial = r#"{ "set": "all", "file": "start.txt" }"#;
    model.initial.push(serde_json::from_str(initial).unwrap());
    let folder = place.path().join("run");
    let mut run = begun_of(&Source::of_model(model, place.path()), &folder);
    let over = Deadline::from_now(Some(std::time::Duration::ZERO));
    let ending = run.drive(over, &Cancel::new(), &mut |_| {});
    assert_eq!(ending.unwrap(), Ending::Deadline);
    drop(run);
    let resumed = || Run::resume(&folder, &means(), &mut |_| {});
    assert!(resumed().unwrap().is_some());
    fs::write(&table, rows.replace('9', "8")).unwrap();
    match resumed().err() {
        Some(RunError::InputChanged { path, .. }) => assert_eq!(path, table),
        other => panic!("{other:?}"),
    }
}

/// A block of 4 × 3 × 2 cubes, as an Abaqus file in mm, with the sets "left" and "right" of nodes.
fn cubes() -> String {
    let [nx, ny, nz] = [4, 3, 2];
    let node = |i: usize, j: usize, k: usize| (k * (ny + 1) + j) * (nx + 1) + i + 1;
    let mut text = "*NODE\n".to_owned();
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                text += &format!("{}, {i}, {j}, {k}\n", node(i, j, k));
            }
        }
    }
    text += "*ELEMENT, TYPE=C3D8, ELSET=steel\n";
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let number = (k * ny + j) * nx + i + 1;
                let bottom = [
                    node(i, j, k),
                    node(i + 1, j, k),
                    node(i + 1, j + 1, k),
                    node(i, j + 1, k),
                ];
                let level = (nx + 1) * (ny + 1);
                let [a, b, c, d] = bottom;
                let [e, f, g, h] = bottom.map(|n| n + level);
                text += &format!("{number}, {a}, {b}, {c}, {d}, {e}, {f}, {g}, {h}\n");
            }
        }
    }
    for (name, i) in [("left", 0), ("right", nx)] {
        text += &format!("*NSET, NSET={name}\n");
        for k in 0..=nz {
            for j in 0..=ny {
                text += &format!("{},\n", node(i, j, k));
            }
        }
    }
    text
}

const CUBES: &str = r#"
title = "Cubes"
[body]
shape = "mesh"
file = "cubes.inp"
unit = "mm"
[material]
youngs_modulus = "72 GPa"
density = 2440
horizon = "2.1 mm"
[[constraint]]
set = "left"
displacement = [0, 0, 0]
[[constraint]]
set = "right"
velocity = ["4 m/s", 0, 0]
[time]
end = "2 us"
dt = "0.1 us"
[output]
fields = { every = 2, format = ["vtu", "exodus", "vtkhdf"], cells = true }
"#;

#[test]
fn result_files_of_a_resumed_run_equal_those_of_an_uninterrupted_one() {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("cubes.inp"), cubes()).unwrap();
    let name = place.path().join("cubes.toml").display().to_string();
    let deck = Deck::parse(CUBES, &name, &[]).unwrap();
    let source = Source::of_deck(deck, name);
    let whole = place.path().join("whole");
    let ending = begun_of(&source, &whole).drive(None, &Cancel::new(), &mut |_| {});
    assert_eq!(ending.unwrap(), Ending::Finished);
    let read = |folder: &Path, file: &str| {
        fs::read(folder.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
    };
    let files = [
        "fields.exo",
        "fields.vtkhdf",
        "cells.pvd",
        "cells/cells_000010.vtu",
    ];
    // Before the first output after the start, in the middle, and just after an output.
    for (stop, threads) in [(1, 1), (7, 2), (8, 3)] {
        let parts = place.path().join(format!("parts-{stop}"));
        let mut run = begun_of(&source, &parts);
        let cancel = Cancel::new();
        let token = cancel.clone();
        let ending = run.drive(None, &cancel, &mut |event| {
            if let Event::Step { step, .. } = event
                && step == stop
            {
                token.cancel();
            }
        });
        assert_eq!(ending.unwrap(), Ending::Cancelled);
        drop(run);
        // An incomplete output of a killed run.
        let mut torn = read(&parts, "fields.exo");
        torn.extend([1; 100]);
        fs::write(parts.join("fields.exo"), torn).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let ending = pool.unwrap().install(|| {
            let mut run =
                Run::resume(&parts, &means(), &mut |_| {})?.expect("the run has not finished");
            run.drive(None, &Cancel::new(), &mut |_| {})
        });
        assert_eq!(ending.unwrap(), Ending::Finished);
        for file in files {
            assert!(
                read(&whole, file) == read(&parts, file),
                "{file} after step {stop}"
            );
        }
    }
    // The Exodus file is a mesh of points with the sets; export from VTU gives the same file.
    let memory = u64::MAX;
    let mesh = pericles_io::read_mesh(whole.join("fields.exo"), memory).unwrap();
    assert_eq!(mesh.cells.len(), 24);
    let names: Vec<&str> = mesh.node_sets.iter().map(|set| &*set.name).collect();
    assert_eq!(names, ["steel", "left", "right"]);
    let results = Results::open(&whole).unwrap();
    let exported = whole.join("exported.exo");
    let outputs = pericles_run::export(
        &results,
        pericles_run::ExportFormat::Exodus,
        &Default::default(),
        &exported,
    );
    assert_eq!(outputs.unwrap().outputs, 11);
    assert!(read(&whole, "fields.exo") == read(&whole, "exported.exo"));
    let table = whole.join("tables");
    pericles_run::export(
        &results,
        pericles_run::ExportFormat::Csv,
        &Default::default(),
        &table,
    )
    .unwrap();
    let table = pericles_io::read_csv(table.join("fields_000010.csv")).unwrap();
    let state = results.fields().unwrap().last().unwrap().read().unwrap();
    let ours = table.column("Displacement_x").unwrap();
    let theirs = state.field("Displacement").unwrap();
    assert!((0..24).all(|i| ours[i] == theirs.values[3 * i]));
}

const PULLED: &str = r#"
[body]
shape = "plate"
size = ["24 mm", "12 mm"]
spacing = "1 mm"
plane = "stress"
[material]
model = "linear"
youngs_modulus = "72 GPa"
density = 2440
horizon_ratio = 3
critical_stretch = 0.002
[sets.left]
layer = { side = "-x", cells = 3 }
[sets.right]
layer = { side = "+x", cells = 3 }
[[crack]]
segment = [["12 mm", "0 mm"], ["12 mm", "4 mm"]]
[[constraint]]
set = "left"
displacement = [0, 0]
[[load]]
set = "right"
traction = ["1 MPa", 0]
[time]
scheme = "static"
breaking = "event"
load_steps = 3
[output]
history = { every = 1 }
"#;

#[test]
fn event_by_event_run_under_loads_writes_load_factors_and_a_load_displacement_curve() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("pulled");
    let deck = Deck::parse(PULLED, "plate.toml", &[]).unwrap();
    let mut run = begun_of(&Source::of_deck(deck, "plate.toml".into()), &folder);
    let ending = run.drive(None, &Cancel::new(), &mut |_| {});
    assert_eq!(ending.unwrap(), Ending::Finished);
    let column = |file: &str, name: &str| {
        let table = pericles_io::read_csv(folder.join(file)).unwrap();
        let found = table.column(name).map(<[f64]>::to_vec);
        found.unwrap_or_else(|| panic!("{file} does not contain {name}"))
    };
    let factors = column("history.csv", "load_factor");
    let work = column("history.csv", "external_work");
    let of_curve = |name: &str| column("force_displacement.csv", name);
    let (u, force) = (of_curve("right_displacement_x"), of_curve("right_force_x"));
    let reaction = of_curve("left_force_x");
    assert_eq!(factors.len(), 4);
    assert_eq!([factors[0], force[0], u[0]], [0.0; 3]);
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
    for k in 1..4 {
        // The load is a multiple of that of the deck, and the support carries it.
        near(force[k] / factors[k], force[1] / factors[1]);
        near(reaction[k], -force[k]);
    }
    // The load grows from zero.
    near(work[1], 0.5 * force[1] * u[1]);
}
