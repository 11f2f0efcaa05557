//! A deck with every key, and the expected model.

use pericles::boundary::MotionKind;
use pericles::family::{EndRule, VolumeCorrection};
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, FractureCalibration, Modulus, PairLaw,
    StressState,
};
use pericles::observe::{Field, Schedule};
use pericles::space::{Face, Grid, Region, Shape};
use pericles_deck::*;
use serde_json::json;

mod common;

use common::{grid, solid};

const COMPLETE: &str = include_str!("complete.toml");
const OPEN: f64 = f64::INFINITY;

fn parse(text: &str) -> Deck {
    Deck::parse(text, "deck.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_entry_is_read() {
    let deck = parse(COMPLETE);
    assert_eq!(
        deck.model.title.as_deref(),
        Some("Everything a plate can have")
    );
    let triangle = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let corner = Region::Intersection(vec![
        Region::Box {
            min: [-OPEN, 0.03, -OPEN],
            max: [-0.04, OPEN, OPEN],
        },
        Region::Complement(Box::new(Region::HalfSpace {
            point: [0.0; 3],
            normal: [1.0, 1.0, 0.0],
        })),
        Region::Union(vec![Region::Polygon { corners: triangle }, Region::All]),
    ]);
    let ball = Region::Ball {
        centre: [0.02, 0.02, 0.0],
        radius: 0.005,
    };
    let grid = Grid {
        shape: Shape::Box {
            origin: [-0.05, 0.0, 0.0],
            size: vec![0.1, 0.04],
        },
        spacing: 0.25e-3,
        section: 1e-3,
        holes: vec![ball, corner],
    };
    let lattice = Lattice {
        grid,
        finer: vec![],
        periodic: false,
        quadrature: Quadrature::Midpoint,
        rectangular: None,
        positions: Positions::Lattice,
    };
    let solid = solid(&deck);
    assert_eq!(solid.shape, SolidShape::Lattice(lattice));
    assert_eq!(solid.state, StressState::PlaneStrain);

    let dx = 0.25e-3;
    let bonds = BondMaterial {
        law: PairLaw::BondStretch,
        density: 2440.0,
        modulus: Modulus {
            value: ElasticModulus::Young(72e9),
            calibration: Calibration::Lattice,
        },
        horizon: 3.0 * dx,
        influence: Influence {
            function: InfluenceFunction::Tabulated {
                table: vec![(0.0, 1.0), (1.5 * dx, 0.75), (3.0 * dx, 0.5)],
            },
            acts_on: ActsOn::Displacement,
        },
        volume_correction: VolumeCorrection::Linear,
        fracture: Fracture::Energy {
            energy: 135.0,
            calibration: FractureCalibration::Lattice,
        },
    };
    assert_eq!(solid.material.name.as_deref(), Some("soda-lime glass"));
    assert_eq!(solid.material.bonds(), Some(&bonds));
    assert_eq!(solid.material.no_fail, ["top", "bottom"]);
    let damage = solid.material.damage.unwrap();
    assert!(damage.count && damage.count_precut);

    let layer = |upper| Region::Layer {
        face: Face { axis: 1, upper },
        depth: dx,
    };
    let left = Region::Box {
        min: [-OPEN; 3],
        max: [-0.049, OPEN, OPEN],
    };
    let sets: Vec<(&str, &Region)> = deck
        .model
        .sets
        .iter()
        .map(|set| (set.name.as_str(), set.members.region().unwrap()))
        .collect();
    assert_eq!(
        sets,
        [
            ("top", &layer(true)),
            ("bottom", &layer(false)),
            ("left edge", &left)
        ]
    );

    let segment = |from, to| CrackSurface::Segment([from, to]);
    assert_eq!(
        deck.model.cracks[0].surface,
        segment([-0.05, 0.02], [0.0, 0.02])
    );
    assert_eq!(deck.model.cracks[0].ends, EndRule::Closed);
    assert_eq!(deck.model.cracks[1].surface, segment([0.01; 2], [0.02; 2]));
    assert_eq!(deck.model.cracks[1].ends, EndRule::Open);
}

#[test]
fn conditions_time_and_output_are_read() {
    let deck = parse(COMPLETE);
    assert_eq!(
        deck.model.initial,
        [
            Initial {
                set: "all".into(),
                displacement: None,
                velocity: Some([0.0, 1.0, 0.0].map(Into::into)),
                file: None,
                random_velocity: None,
            },
            Initial {
                set: "top".into(),
                displacement: Some([1e-6, 0.0, 0.0].map(Into::into)),
                velocity: Some([0.0, 20.0, 0.0].map(Into::into)),
                file: None,
                random_velocity: None,
            }
        ]
    );
    assert_eq!(
        deck.model.constraints,
        [
            Constraint {
                set: "left edge".into(),
                kind: MotionKind::Velocity,
                amplitude: [Some(0.0.into()), None, None],
                function: TimeHistory::Constant,
                until: None,
            },
            Constraint {
                set: "bottom".into(),
                kind: MotionKind::Displacement,
                amplitude: [None, Some((-1e-4).into()), None],
                function: TimeHistory::Pulse {
                    start: 1e-6,
                    duration: 2e-6,
                },
                until: None,
            }
        ]
    );
    assert_eq!(
        deck.model.loads,
        [
            Load {
                set: "top".into(),
                amplitude: LoadAmplitude::BodyForce([0.0, 48e9, 0.0].map(Into::into)),
                function: TimeHistory::Ramp {
                    start: 0.0,
                    duration: 1e-6,
                },
                from: None,
                until: None,
            },
            Load {
                set: "bottom".into(),
                amplitude: LoadAmplitude::Traction {
                    traction: [0.0, -12e6, 0.0].map(Into::into),
                    area: Some(1e-4),
                },
                function: TimeHistory::Constant,
                from: None,
                until: None,
            }
        ]
    );
    assert_eq!(
        deck.model.probes,
        [
            Probe {
                name: "middle".into(),
                place: ProbePlace::At([0.0, 0.02, 0.0]),
            },
            Probe {
                name: "top".into(),
                place: ProbePlace::Set("top".into()),
            }
        ]
    );
    assert_eq!(
        deck.model.time,
        Time {
            end: 46e-6,
            step: TimeStep::Fixed(25e-9),
            scheme: Scheme::VelocityVerlet,
            allow_unstable: true,
            stop_when: vec![],
        }
    );
    let damage = Picture {
        field: Field::Damage,
        component: None,
        scale: 1.0,
        range: Some([0.0, 1.0]),
        view: None,
        animation: false,
        schedule: Schedule::Count(2),
        look: PictureLook::default(),
    };
    let uplift = Picture {
        field: Field::Displacement,
        component: Some(1),
        scale: 10.0,
        range: Some([-1e-3, 1e-3]),
        view: None,
        animation: true,
        schedule: Schedule::Interval(1e-6),
        look: PictureLook::default(),
    };
    assert_eq!(
        deck.model.output,
        Output {
            fields: FieldOutput {
                schedule: Schedule::Interval(0.5e-6),
                names: Field::USUAL.to_vec().into(),
                formats: vec![FieldFormat::Vtu],
                cells: false,
                blocks: FieldBlocks::Groups,
            },
            cells: None,
            profiles: Vec::new(),
            quantities: Vec::new(),
            history: HistoryOutput {
                schedule: Schedule::Every(20),
                extremes: Vec::new(),
            },
            energy_bound: None,
            cracks: CrackOutput {
                schedule: Schedule::Count(92),
                threshold: 0.4,
            },
            fragments: FragmentOutput {
                schedule: Schedule::Every(40),
                smallest: 0.01,
            },
            precision: Precision::Single,
            pictures: vec![damage, uplift],
        }
    );
    assert_eq!(deck.model.checkpoint, Checkpoint::Every(500));
}

/// A minimal deck.
const LEAST: &str = r#"
[body]
shape = "bar"
length = "1 m"
spacing = "1 cm"
[material]
density = 7850
youngs_modulus = "210 GPa"
horizon = "3 cm"
[time]
end = "1 ms"
"#;

#[test]
fn defaults_are_filled_in_and_recorded() {
    let deck = parse(LEAST);
    assert_eq!(solid(&deck).state, StressState::Uniaxial);
    assert_eq!(grid(&deck).section, 1.0);
    assert_eq!(
        solid(&deck).material.bonds().unwrap().fracture,
        Fracture::Unbreakable
    );
    assert_eq!(
        solid(&deck).material.bonds().unwrap().volume_correction,
        VolumeCorrection::Extended
    );
    assert_eq!(deck.model.time.step, TimeStep::Auto { safety: 0.95 });
    assert_eq!(deck.model.output.fields.schedule, Schedule::Count(20));
    assert_eq!(
        deck.model.output.cracks.schedule,
        deck.model.output.history.schedule
    );
    assert_eq!(deck.model.checkpoint, Checkpoint::Wall(600.0));
    assert_eq!(deck.source(), LEAST);
    let expected = json!({
        "body": { "shape": "bar", "length": 1.0, "spacing": 0.01, "origin": [0.0], "area": 1.0, "positions": "lattice", "periodic": false, "quadrature": "midpoint" },
        "material": {
            "model": "bond-stretch", "density": 7850.0, "youngs_modulus": 210e9, "modulus": "continuum",
            "horizon": 0.03, "bonds": "fastest", "volume_correction": "extended", "surface_correction": "none",
            "influence": { "function": "constant", "acts_on": "stretch" },
            "damage": { "measure": "volume", "count_precut": false },
        },
        "time": { "end": 1e-3, "dt": "auto", "safety": 0.95, "scheme": "velocity-verlet", "allow_unstable": false },
        "output": {
            "fields": { "count": 20, "format": "vtu", "blocks": "groups" }, "history": { "count": 200 },
            "cells": "auto", "cracks": { "count": 200, "threshold": 0.35 }, "precision": "double",
        },
        "checkpoint": { "wall": 600.0 },
    });
    assert_eq!(*deck.to_json(), expected);
}

#[test]
fn the_record_is_an_equivalent_deck() {
    for text in [COMPLETE, LEAST] {
        let mut first = parse(text);
        let again = parse(&toml::to_string(first.to_json()).unwrap());
        // The record includes defaults.
        let material = &mut first.model.body.solid_mut().unwrap().material;
        material.damage = Some(material.damage.unwrap_or_default());
        assert_eq!(again.to_json(), first.to_json());
        assert_eq!(again.model.body, first.model.body);
        assert_eq!(again.model.constraints, first.model.constraints);
        assert_eq!(again.model.output, first.model.output);
    }
}

#[test]
fn shapes() {
    let body = |text: &str| {
        let rest = "\n[material]\ndensity=1\nE=1\nm=3\n[time]\nend=1\n";
        let deck = parse(&format!("[body]\nspacing = 0.1\n{text}{rest}"));
        (grid(&deck).clone(), solid(&deck).state)
    };
    let bar = body("shape='bar'\nsize=[2]\narea='1 cm2'\norigin=3");
    assert_eq!(bar.0.section, 1e-4);
    assert_eq!(
        bar.0.shape,
        Shape::Box {
            origin: [3.0, 0.0, 0.0],
            size: vec![2.0]
        }
    );
    let ring = body("shape='disc'\ncenter=[1,2]\nradius=3\ninner_radius=2\nplane='stress'");
    assert_eq!(ring.1, StressState::PlaneStress);
    let centre = [1.0, 2.0, 0.0];
    assert_eq!(
        ring.0.shape,
        Shape::Disc {
            centre,
            radius: 3.0
        }
    );
    assert_eq!(
        ring.0.holes,
        [Region::Ball {
            centre,
            radius: 2.0
        }]
    );
    let tube = body("shape='cylinder'\naxis='x'\nradius=3\ninner_radius=2\nheight=5");
    assert_eq!(tube.1, StressState::Spatial);
    let base = [0.0; 3];
    assert_eq!(
        tube.0.shape,
        Shape::Cylinder {
            base,
            axis: 0,
            radius: 3.0,
            height: 5.0
        }
    );
    assert_eq!(
        tube.0.holes,
        [Region::Cylinder {
            centre: base,
            axis: 0,
            radius: 2.0
        }]
    );
    let ball = body("shape='ball'\nradius=3");
    assert_eq!(
        ball.0.shape,
        Shape::Ball {
            centre: base,
            radius: 3.0
        }
    );
    assert_eq!(body("shape='block'\nsize=[1,2,3]").0.dimension(), 3);
}

#[test]
fn cracks_of_each_dimension() {
    let cracks = |body: &str, crack: &str| {
        let rest = "[material]\ndensity=1\nE=1\nm=3\n[time]\nend=1\n[[crack]]\n";
        let deck = parse(&format!("[body]\nspacing=0.1\n{body}\n{rest}{crack}"));
        deck.model.cracks[0].surface.clone()
    };
    assert_eq!(
        cracks("shape='bar'\nlength=1", "section='50 cm'"),
        CrackSurface::Section(0.5)
    );
    let block = "shape='block'\nsize=[1,1,1]";
    assert_eq!(
        cracks(
            block,
            "disc={centre=[0.5,0.5,0.5],normal=[0,0,1],radius='10 cm'}"
        ),
        CrackSurface::Disc {
            centre: [0.5; 3],
            normal: [0.0, 0.0, 1.0],
            radius: 0.1
        }
    );
    let corners = vec![[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [0.0, 1.0, 0.5]];
    assert_eq!(
        cracks(block, "polygon=[[0,0,0.5],[1,0,0.5],[0,1,0.5]]"),
        CrackSurface::Polygon(corners)
    );
    assert_eq!(
        cracks(block, "file='crack.stl'\nunit='mm'"),
        CrackSurface::File {
            path: "crack.stl".into(),
            unit: 1e-3
        }
    );
}

fn with(overrides: &[&str]) -> Result<Deck, DeckError> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).into()).collect();
    Deck::parse(COMPLETE, "deck.toml", &overrides)
}

#[test]
fn overrides_change_what_is_read() {
    let deck = with(&[
        "time.dt = auto",
        "body.spacing=0.5 mm",
        "crack.1.ends=closed",
        "load.1.traction=[0, '-24 MPa']",
        "constraint.1.function.start=2e-6",
        "material.K=48 GPa",
        "material.horizon=2 mm",
        "output.history.interval=1 us",
        "title=Another one",
        "checkpoint={ wall = '1 min' }",
    ])
    .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(deck.model.time.step, TimeStep::Auto { safety: 0.95 });
    assert_eq!(grid(&deck).spacing, 0.5e-3);
    assert_eq!(deck.model.cracks[1].ends, EndRule::Closed);
    let LoadAmplitude::Traction { traction, .. } = &deck.model.loads[1].amplitude else {
        panic!("a traction is overridden by a traction")
    };
    assert_eq!(*traction, [0.0, -24e6, 0.0].map(Into::into));
    assert_eq!(
        deck.model.constraints[1].function,
        TimeHistory::Pulse {
            start: 2e-6,
            duration: 2e-6
        }
    );
    assert_eq!(
        solid(&deck).material.bonds().unwrap().modulus.value,
        ElasticModulus::Bulk(48e9)
    );
    assert_eq!(solid(&deck).material.bonds().unwrap().horizon, 2e-3);
    assert_eq!(deck.model.output.history.schedule, Schedule::Interval(1e-6));
    assert_eq!(deck.model.title.as_deref(), Some("Another one"));
    assert_eq!(deck.model.checkpoint, Checkpoint::Wall(60.0));
    assert_eq!(deck.source(), COMPLETE);
    assert_eq!(deck.overrides().count(), 10);
    assert_eq!(deck.overrides().next(), Some("time.dt = auto"));
}

#[test]
fn overrides_create_tables_and_errors_point_at_them() {
    let deck = with(&["sets.right.layer.side=+x", "sets.right.layer.cells=2"]).unwrap();
    assert_eq!(
        deck.model.sets[3].members.region(),
        Some(&Region::Layer {
            face: Face::named("+x").unwrap(),
            depth: 0.5e-3
        })
    );
    for (text, column, words) in [
        ("time.end=-1 s", 10, "`-1 s` is out of range"),
        ("crack.0.ends=clsoed", 14, "did you mean `closed`?"),
        ("time.dtt=1", 6, "did you mean `dt`?"),
        ("crack.7.ends=open", 7, "0 to 1"),
        ("crack.first.ends=open", 7, "0 to 1"),
        ("time.end.x=1", 10, "a string"),
        ("time.dt", 1, "no `=`"),
        ("time..dt=1", 1, "empty part"),
        ("material.E=[1]", 12, "a list"),
        ("load.0.body_force=[0, '1 Gm']", 23, "a force per volume"),
        ("time.ratio=unset", 6, "[time] does not set `ratio`"),
        ("times.ratio=unset", 1, "the deck does not set `times`"),
        ("crack.2=unset", 7, "0 to 1"),
        ("time.end.x=unset", 10, "a string"),
    ] {
        let error = with(&[text]).unwrap_err();
        let problem = &error.problems()[0];
        let key = text.split('=').next().unwrap();
        assert_eq!(problem.location().file(), format!("--set {key}"), "{error}");
        assert_eq!(problem.location().column(), column, "{text}: {error}");
        assert!(error.to_string().contains(words), "{text}: {error}");
    }
}

#[test]
fn overrides_remove_keys() {
    let whole = with(&[]).unwrap();
    assert_ne!(whole.model.time.step, TimeStep::default());
    let deck = with(&[
        "time.dt=unset",
        "title = unset",
        "crack.0=unset",
        "output=unset",
        "constraint.1.function=unset",
    ])
    .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(deck.model.time.step, TimeStep::default());
    assert_eq!(deck.model.title, None);
    assert_eq!(deck.model.cracks, whole.model.cracks[1..]);
    assert_eq!(deck.model.output, Output::default());
    assert!(deck.model.constraints[1].function.is_constant());
    // A text in quotes is a value.
    let deck = with(&["title=\"unset\""]).unwrap();
    assert_eq!(deck.model.title.as_deref(), Some("unset"));
    // A removed key has to be given again if it is required.
    let error = with(&["time.end=unset"]).unwrap_err().to_string();
    assert!(error.contains("requires `end`"), "{error}");
    // A table can be removed and written anew.
    let deck = with(&["time.scheme=unset", "time=unset", "time.end=2 us"]).unwrap();
    assert_eq!(deck.model.time.end, 2e-6);
}

#[test]
fn files_are_read_and_missing_files_are_reported() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/complete.toml");
    assert_eq!(Deck::read(path, &[]).unwrap().model.loads.len(), 2);
    let error = Deck::read("no/such/deck.toml", &[]).unwrap_err();
    assert!(matches!(error, DeckError::Unreadable { .. }));
    assert!(error.to_string().contains("no/such/deck.toml"));
}

/// Returns the deck in the crate's documentation.
fn documented() -> String {
    include_str!("../src/lib.rs")
        .lines()
        .map(|line| line.trim_start_matches("//!").trim_start_matches(' '))
        .skip_while(|line| *line != "```toml")
        .skip(1)
        .take_while(|line| *line != "```")
        .map(|line| format!("{line}\n"))
        .collect()
}

#[test]
fn the_documented_deck_is_valid() {
    let deck = parse(&documented());
    assert_eq!(deck.model.cracks.len(), 1);
    assert_eq!(deck.model.loads.len(), 2);
}
