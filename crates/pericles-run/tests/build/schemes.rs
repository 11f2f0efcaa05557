//! Time integration schemes and their steps.

use super::{PLATE, build, plate_with_time, rejection};

#[test]
fn automatic_steps_are_stable_and_end_on_time() {
    let model = build(PLATE);
    let stable = model.stable_step().unwrap();
    assert!((model.dt * model.steps as f64 / 2e-6 - 1.0).abs() < 1e-12);
    assert!(model.dt <= 0.95 * stable * (1.0 + 1e-8));
    // One step fewer would exceed the stable step.
    assert!(2e-6 / (model.steps - 1) as f64 > 0.95 * stable);
    let fixed = build(&PLATE.replace("end = \"2 us\"", "end = \"2 us\"\ndt = \"30 ns\""));
    // 67 steps of 30 ns would end at 2.01 µs.
    assert_eq!((fixed.dt, fixed.steps), (2e-6 / 67.0, 67));
    let whole = build(&PLATE.replace("end = \"2 us\"", "end = \"2 us\"\ndt = \"40 ns\""));
    assert_eq!(whole.steps, 50);
}

#[test]
fn a_body_without_stiffness_requires_a_given_step() {
    let lone = "[body]\nshape='bar'\nlength=2\nspacing=1\n[[crack]]\nsection=1\n\
                [material]\ndensity=1\nE=1\nm=1\n[time]\nend=1\n";
    let error = rejection(lone);
    assert!(error.to_string().contains("give dt"), "{error}");
    let model = build(&format!("{lone}dt=0.1\n"));
    assert_eq!(model.steps, 10);
    assert!(model.frequency.is_none() && model.stable_step().is_none());
}

#[test]
fn every_scheme_is_built_and_runs() {
    for (time, name, order) in [
        ("scheme = \"rk3\"", "rk3", 3),
        ("scheme = \"rk4\"", "rk4", 4),
        (
            "scheme = \"dormand-prince\"\ndt = \"0.1 us\"",
            "dormand-prince",
            5,
        ),
        (
            "scheme = \"multirate-rk3\"\nratio = 4\nfine = \"middle\"",
            "multirate-rk3",
            3,
        ),
        (
            "scheme = \"multirate-rk4\"\nratio = 4\nadaptive = {}",
            "multirate-rk4",
            4,
        ),
        (
            "scheme = \"respa\"\nratio = 4\nfine = [\"middle\", \"left\"]",
            "respa",
            2,
        ),
    ] {
        let model = build(&plate_with_time(time));
        assert_eq!(
            (model.integrator.name(), model.integrator.order()),
            (name, order)
        );
        assert!(model.warnings.is_empty(), "{name}");
        let two = model.integrator.refinement();
        assert_eq!(two.is_some(), time.contains("ratio"));
        // The schemes run.
        let mut simulation = model.simulation();
        simulation.run(|_| pericles::Control::Continue).unwrap();
    }
    let limit = |time: &str| build(&plate_with_time(time)).stable_step().unwrap();
    let verlet = limit("");
    assert!((limit("scheme = \"rk4\"") / verlet / 2f64.sqrt() - 1.0).abs() < 1e-6);
    assert!((limit("scheme = \"rk3\"") / verlet / 0.75f64.sqrt() - 1.0).abs() < 1e-6);
}

#[test]
fn the_highest_frequency_does_not_depend_on_the_scheme() {
    let verlet = build(&plate_with_time(""));
    assert_eq!(verlet.frequency, verlet.body_frequency);
    for scheme in ["multirate-rk4", "respa"] {
        let time = format!("scheme = \"{scheme}\"\nratio = 4\nfine = \"middle\"");
        let two = build(&plate_with_time(&time));
        assert_eq!(two.body_frequency, verlet.body_frequency, "{scheme}");
        let [limiting, body] = [two.frequency, two.body_frequency].map(Option::unwrap);
        assert!(limiting.bound < body.bound * (1.0 + 1e-3), "{scheme}");
    }
}

#[test]
fn steps_between_the_bounds_lead_to_a_warning_and_steps_above_are_rejected() {
    let frequency = build(PLATE).frequency.unwrap();
    let [stable, unstable] = [
        frequency.stable_step(2.0, 1.0),
        frequency.unstable_step(2.0),
    ];
    assert!(stable < unstable, "{frequency:?}");
    let deck = |dt: f64| {
        let time = format!("end = {:e}\ndt = {dt:e}", 20.0 * dt);
        PLATE.replace("end = \"2 us\"", &time)
    };
    let warnings = |dt: f64| build(&deck(dt)).warnings;
    assert!(warnings(stable * (1.0 - 1e-12)).is_empty());
    let between = warnings((stable * unstable).sqrt());
    assert!(between[0].line().contains("may be unstable"), "{between:?}");
    let error = rejection(&deck(unstable * (1.0 + 1e-6))).to_string();
    assert!(error.contains("is unstable"), "{error}");
}

#[test]
fn incompatible_schemes_are_rejected() {
    for (time, line, words) in [
        ("scheme = \"dormand-prince\"", 55, "give dt"),
        (
            "scheme = \"respa\"\nratio = 4\nfine = [\"middle\", \"thin\"]",
            59,
            "share points",
        ),
        (
            "scheme = \"respa\"\nratio = 4\nfine = \"thin\"",
            59,
            "at least as thick as its longest bond",
        ),
        (
            "scheme = \"multirate-rk4\"\nratio = 4\nfine = \"middle\"\ndt = \"1 us\"",
            60,
            "multirate-rk4 needs dt",
        ),
    ] {
        let error = rejection(&plate_with_time(time));
        let message = error.to_string();
        assert!(message.contains(words), "{message}");
        assert_eq!(error.problems()[0].location().line(), line, "{message}");
    }
    let unbreakable = plate_with_time("scheme = \"respa\"\nratio = 4\nadaptive = {}")
        .replace("fracture_energy = \"135 J/m2\"\n", "");
    let error = rejection(&unbreakable);
    assert!(
        error.to_string().contains("its bonds do not break"),
        "{error}"
    );
}

#[test]
fn a_stiff_inclusion_does_not_reduce_the_coarse_step() {
    let inclusion = |text: &str| {
        text.replace(
            "[sets]",
            "[[assign]]\nset = \"core\"\nstiffness = 16\n[sets]\n\
             core = { box = { min = [\"9 mm\", \"open\"], max = [\"11 mm\", \"open\"] } }",
        )
    };
    let limit = |text: &str| build(text).stable_step().unwrap();
    let mts = "scheme = \"respa\"\nratio = 4\nfine = \"middle\"";
    let plain = limit(&plate_with_time(""));
    let stiff = limit(&inclusion(&plate_with_time("")));
    let two = limit(&inclusion(&plate_with_time(mts)));
    // Bonds within the core are 16 times stiffer, those across its boundary 8.5 times.
    assert!(
        stiff < 0.4 * plain && stiff > 0.25 * plain,
        "{stiff} {plain}"
    );
    assert!(two > 0.98 * plain, "{two} {plain}");
}

#[test]
fn a_given_step_ends_on_time() {
    // 20 steps of 0.1 s up to rounding, and slightly more than two of 0.9 s.
    let with = |end: &str, dt: &str| {
        build(&format!(
            r#"
body = {{ shape = "bar", length = 40, spacing = 1 }}
material = {{ model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3 }}
initial = [{{ velocity = 1 }}]
time = {{ end = {end}, dt = {dt} }}
"#
        ))
    };
    for (end, dt, steps) in [
        ("2", 0.1_f64, 20),
        ("0.3", 0.1, 3),
        ("2.0000000001", 0.1, 20),
    ] {
        let whole = with(end, &dt.to_string());
        assert_eq!((whole.dt.to_bits(), whole.steps), (dt.to_bits(), steps));
        assert!(whole.warnings.is_empty(), "{end}");
    }
    for (end, dt, steps) in [("2.4", "0.9", 3), ("0.5", "0.7", 1), ("2.001", "0.1", 21)] {
        let model = with(end, dt);
        let end: f64 = end.parse().unwrap();
        assert_eq!(model.steps, steps);
        assert_eq!(model.dt, end / steps as f64);
        let [warning] = &model.warnings[..] else {
            panic!("one warning for dt = {dt}")
        };
        let line = warning.line();
        assert!(line.contains("all steps are shortened to"), "{line}");
        assert!(
            line.contains(&format!("so that {steps} steps end exactly")),
            "{line}"
        );
    }
}
