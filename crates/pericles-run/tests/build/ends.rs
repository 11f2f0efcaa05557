//! Absorbing boundaries and damping layers.

use pericles_deck::Deck;

use super::{build, rejection};

/// An infinite bar.
const BAR: &str = r#"
[body]
shape = "bar"
length = "100 mm"
spacing = "1 mm"
[material]
model = "linear"
density = "7850 kg/m3"
youngs_modulus = "210 GPa"
horizon_ratio = 3
volume_correction = "none"
[sets]
middle = { box = { min = "50 mm", max = "52 mm" } }
[[initial]]
set = "middle"
velocity = "1 m/s"
[[boundary]]
kind = "absorbing"
side = "-x"
[[boundary]]
kind = "absorbing"
side = "+x"
[time]
end = "100 us"
"#;

#[test]
fn absorbing_boundaries_transmit_waves() {
    let model = build(BAR);
    assert_eq!(model.system.boundaries().count(), 2);
    let mut run = model.simulation();
    run.run(|_| pericles::Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    // The shortest waves of a jump are very slow; the energy that left is in the balance.
    assert!(energies.work < -0.8 * energies.initial, "{energies:?}");
    assert!(
        energies.balance().abs() < 1e-12 * energies.initial,
        "{energies:?}"
    );
}

#[test]
fn absorbing_boundaries_work_with_implicit_steps_above_the_explicit_limit() {
    for scheme in ["implicit-midpoint", "trapezoidal", "discrete-gradient"] {
        let time = format!("[time]\nscheme = \"{scheme}\"\ndt = \"1 us\"");
        let mut run = build(&BAR.replace("[time]", &time)).simulation();
        run.run(|_| pericles::Control::Continue).unwrap();
        let energies = run.snapshot().energies();
        // Long steps slow down the short waves of a jump, many of which are still in the body.
        assert!(energies.work < -0.5 * energies.initial, "{energies:?}");
        assert!(
            energies.balance().abs() < 1e-11 * energies.initial,
            "{energies:?}"
        );
    }
}

#[test]
fn exponential_histories_satisfy_their_tolerance() {
    let displacement = |text: &str| {
        let mut run = build(text).simulation();
        run.run(|_| pericles::Control::Continue).unwrap();
        run.state().u.clone()
    };
    let text = BAR.replace("[time]", "[time]\ndt = \"60 ns\"");
    let exact = displacement(&text);
    let history = "side = \"+x\"\nhistory = \"exponentials\"\ntolerance = 1e-6";
    let fitted = displacement(&text.replace("side = \"+x\"", history));
    let largest = exact.iter().fold(0.0, |a: f64, u| a.max(u.abs()));
    let pairs = exact.iter().zip(&fitted);
    let error = pairs.fold(0.0, |a: f64, (u, v)| a.max((u - v).abs())) / largest;
    assert!(error < 1e-5 && error > 0.0, "{error:e}");
}

#[test]
fn verify_requires_exponential_histories() {
    let verified = |more: &str| {
        let side = format!("side = \"+x\"\nverify = true{more}");
        Deck::parse(&BAR.replace("side = \"+x\"", &side), "bar.toml", &[])
    };
    let message = verified("").unwrap_err().to_string();
    assert!(
        message.contains("without it the history is exact"),
        "{message}"
    );
    assert!(verified("\ntolerance = 1e-6").is_ok());
    assert!(verified("\nhistory = \"exponentials\"").is_ok());
}

#[test]
fn invalid_absorbing_boundaries_are_rejected() {
    let cases: [(&str, &str, (usize, usize), &str); 9] = [
        (
            "[time]",
            "[time]\nscheme = \"trigonometric\"\ndt = \"1 us\"",
            (24, 10),
            "beyond any layer of ghosts",
        ),
        (
            "side = \"+x\"\n[time]",
            "side = \"+x\"\nexterior_extent = \"9 mm\"\n[time]\nscheme = \"implicit-midpoint\"\ndt = \"1 us\"",
            (20, 1),
            "exterior_extent needs scheme = \"velocity-verlet\"",
        ),
        (
            "side = \"+x\"",
            "side = \"-x\"",
            (20, 1),
            "two absorbing boundaries at -x",
        ),
        (
            "[time]",
            "[time]\nscheme = \"rk4\"",
            (24, 10),
            "needs velocity-verlet, implicit-midpoint, trapezoidal or discrete-gradient, not rk4",
        ),
        ("[time]", "[time]\ndt = \"1 us\"", (24, 6), "is unstable"),
        (
            "set = \"middle\"\n",
            "",
            (16, 1),
            "the initial field reaches the absorbing boundary at -x: its value at point 2 is 1.00",
        ),
        (
            "[[initial]]",
            "[sets.left]\nlayer = { side = \"-x\", cells = 2 }\n[[assign]]\nset = \"left\"\nstiffness = 2\n[[initial]]",
            (22, 1),
            "the outer layer at -x is not homogeneous: the bond from point",
        ),
        (
            "[[initial]]",
            "[[load]]\nset = \"all\"\nbody_force = 1\n[[initial]]",
            (20, 1),
            "a load acts on point 0",
        ),
        (
            "volume_correction = \"none\"",
            "critical_stretch = 0.01",
            (17, 1),
            "its 3 outermost points must be in `no_fail`",
        ),
    ];
    for (replace, by, (line, column), says) in cases {
        assert_eq!(BAR.matches(replace).count(), 1, "{replace}");
        let error = rejection(&BAR.replace(replace, by));
        let message = error.to_string();
        assert!(
            message.contains(&format!("deck.toml:{line}:{column}:")),
            "{message}"
        );
        assert!(message.contains(says), "{message}");
    }
}

#[test]
fn initial_fields_may_extend_beyond_a_boundary() {
    // A pulse at the end of the short bar, in the middle of the long one.
    let bell = BAR.replace(
        "set = \"middle\"\nvelocity = \"1 m/s\"",
        "displacement = { expression = \"1e-6*exp(-((x-0.095)/0.01)^2)\" }",
    );
    let bell = bell.replace("[time]", "[time]\ndt = \"60 ns\"");
    let displacement = |text: &str| {
        let mut run = build(text).simulation();
        run.run(|_| pericles::Control::Continue).unwrap();
        run.state().u.clone()
    };
    let long = displacement(&bell.replace("100 mm", "200 mm"));
    let data = "side = \"+x\"\nexterior_extent = \"70 mm\"";
    let short = displacement(&bell.replace("side = \"+x\"", data));
    let pairs = long.iter().zip(&short);
    let error = pairs.fold(0.0, |a: f64, (u, v)| a.max((u - v).abs()));
    assert!(error < 1e-12 * 1e-6 * 10.0, "{error:e}");
    // Without or with too small an exterior extent, the field is rejected.
    let message = rejection(&bell).to_string();
    assert!(message.contains("exterior_extent"), "{message}");
    let message = rejection(&bell.replace("side = \"+x\"", &data.replace("70", "20"))).to_string();
    assert!(message.contains("does not decay within"), "{message}");
}

#[test]
fn a_small_initial_field_at_a_boundary_leads_to_a_warning() {
    // exp(−(x − 0.05)²/w²) at the outer layer, x = 97.5 mm: 1.6e-10 for w = 10 mm, 4.8e-6 for w = 13.6 mm.
    let with_width = |width: &str| {
        let field = format!("displacement = {{ expression = \"exp(-((x-0.05)/{width})^2)\" }}");
        let all = BAR.replace("set = \"middle\"\nvelocity = \"1 m/s\"", &field);
        assert_ne!(all, BAR);
        all
    };
    let says = |text: &str| -> String {
        let model = build(text);
        model.warnings.iter().map(|w| w.line()).collect()
    };
    assert!(!says(&with_width("0.009")).contains("absorbing boundary"));
    let warned = says(&with_width("0.0105"));
    assert!(
        warned.contains("the initial field at the absorbing boundary -x is"),
        "{warned}"
    );
    assert!(
        warned.contains("of its maximum, but zero is assumed beyond it"),
        "{warned}"
    );
    let rejected = rejection(&with_width("0.0136")).to_string();
    assert!(
        rejected.contains("allowed: 1e-6 of the largest value"),
        "{rejected}"
    );
}

#[test]
fn exterior_fields_are_compared_with_the_field_of_the_body() {
    // 1e-20 of the body's field everywhere in the exterior is negligible, though it does not decay.
    let text = BAR.replace(
        "set = \"middle\"\nvelocity = \"1 m/s\"",
        "displacement = { expression = \"exp(-((x-0.05)/0.008)^2) + 8e-21\" }",
    );
    let text = text.replace(
        "side = \"+x\"",
        "side = \"+x\"\nexterior_extent = \"20 mm\"",
    );
    build(&text);
}

#[test]
fn the_memory_of_the_exterior_is_checked_before_allocation() {
    let text = BAR.replace("side = \"+x\"", "side = \"+x\"\nexterior_extent = 1e15");
    let message = rejection(&text).to_string();
    assert!(message.contains("of memory"), "{message}");
}

#[test]
fn an_unreachable_tolerance_falls_back_to_the_exact_history() {
    let keys = "side = \"+x\"\nhistory = \"exponentials\"\ntolerance = 2e-14\nverify = true";
    let short = BAR.replace("100 us", "30 us");
    let model = build(&short.replace("side = \"+x\"", keys));
    let (_, report) = model.ends[1];
    assert_eq!(report.history, "blocked");
    let says: String = model.warnings.iter().map(|w| w.line()).collect();
    assert!(
        says.contains("no sum of exponentials meets the tolerance 2e-14"),
        "{says}"
    );
    assert!(says.contains("the exact blocked history is used"), "{says}");
}

#[test]
fn the_type_of_the_history_is_reported() {
    let ends = |keys: &str| {
        build(&BAR.replace("side = \"+x\"", &format!("side = \"+x\"\n{keys}")))
            .assembly
            .ends
    };
    let (side, report) = ends("")[1];
    assert_eq!((side.name(), report.history), ("+x", "direct"));
    let (_, report) = ends("history = \"exponentials\"\nverify = true")[1];
    assert!(report.exponentials.unwrap() > 3 && report.residual.unwrap() < 1e-9);
    assert!(report.distance.unwrap() < 1e-8, "{report:?}");
    let warned = build(&BAR.replace("side = \"+x\"", "side = \"+x\"\nmethod = \"historical\""));
    let says = warned.warnings.iter().map(|w| w.line()).collect::<String>();
    assert!(says.contains("which grows with time"), "{says}");
}

#[test]
fn damping_layers_absorb() {
    let text = BAR.replace(
        "kind = \"absorbing\"\nside = \"+x\"",
        "kind = \"damping-layer\"\nside = \"+x\"\nthickness = \"40 mm\"",
    );
    let mut run = build(&text).simulation();
    run.run(|_| pericles::Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    assert!(energies.work < -0.8 * energies.initial, "{energies:?}");
    assert!(
        energies.balance().abs() < 1e-12 * energies.initial,
        "{energies:?}"
    );
    let message = rejection(&text.replace("40 mm", "100 mm")).to_string();
    assert!(message.contains("less than the body"), "{message}");
    // Also with other schemes that damp velocities, at ω dt of about 0.3. Runge–Kutta schemes dissipate a fraction (ω
    // dt)⁶/72 of the energy of the shortest waves per step.
    let layers = text.replace(
        "kind = \"absorbing\"\nside = \"-x\"",
        "kind = \"damping-layer\"\nside = \"-x\"\nthickness = \"40 mm\"",
    );
    for (scheme, closes) in [
        ("scheme = \"rk4\"", 1e-2),
        ("scheme = \"dormand-prince\"\ntolerance = 1e-8", 1e-3),
        ("scheme = \"newmark\"", 1e-3),
        ("scheme = \"implicit-midpoint\"", 1e-11),
        ("scheme = \"trapezoidal\"", 1e-11),
        ("scheme = \"discrete-gradient\"", 1e-8),
        ("scheme = \"newmark\"\nsolver = \"newton-krylov\"", 1e-3),
    ] {
        let time = format!("[time]\ndt = \"0.03 us\"\n{scheme}");
        let mut run = build(&layers.replace("[time]", &time)).simulation();
        run.run(|_| pericles::Control::Continue).unwrap();
        let energies = run.snapshot().energies();
        assert!(
            energies.work < -0.8 * energies.initial,
            "{scheme}: {energies:?}"
        );
        let off = energies.balance().abs() / energies.initial;
        assert!(off < closes, "{scheme}: {off:e}");
    }
}

#[test]
fn automatic_steps_account_for_damping_also_in_corners() {
    let layer = |side: &str| {
        format!(
            "[[boundary]]\nkind = \"damping-layer\"\nside = \"{side}\"\nthickness = \"3 mm\"\nreflection = 1e-8\n"
        )
    };
    // A jump excites all waves.
    let plate = |layers: &str, time: &str| {
        format!(
            "[body]\nshape = \"plate\"\nsize = [\"20 mm\", \"20 mm\"]\nspacing = \"1 mm\"\nplane = \"strain\"\n\
             [material]\nmodel = \"linear\"\ndensity = \"2440 kg/m3\"\nyoungs_modulus = \"72 GPa\"\nhorizon_ratio = 3\n\
             [sets.corner]\nbox = {{ min = [\"15 mm\", \"15 mm\"] }}\n[[initial]]\nset = \"corner\"\nvelocity = [\"1 m/s\", 0]\n\
             {layers}[time]\nend = \"200 us\"\n{time}"
        )
    };
    let corner = layer("+x") + &layer("+y");
    let [free, one, two] = ["", &layer("+x"), &corner].map(|layers| build(&plate(layers, "")));
    assert!(one.dt < 0.95 * free.dt && two.dt < 0.95 * one.dt);
    let stable = two.stable_step().unwrap();
    assert!((two.dt / stable - 0.95).abs() < 0.01, "{} {stable}", two.dt);
    let mut run = two.simulation();
    run.run(|_| pericles::Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    assert!(
        energies.kinetic + energies.elastic < 0.5 * energies.initial,
        "{energies:?}"
    );
    // A given step that is stable only without damping is rejected.
    let between = format!("dt = {:e}", 1.02 * stable);
    let message = rejection(&plate(&corner, &between)).to_string();
    assert!(message.contains("Use a smaller dt"), "{message}");
}

#[test]
fn classes_without_stiffness_at_the_horizon_lead_to_a_warning() {
    let with = |third: f64| {
        let table = format!(
            "[material]\ninfluence = {{ function = \"lattice-classes\", table = [[[1], 1.0], [[2], 0.5], [[3], {third}]] }}"
        );
        let model = build(&BAR.replace("[material]", &table));
        let lines: Vec<String> = model.warnings.iter().map(|w| w.line()).collect();
        lines.concat()
    };
    assert_eq!(with(0.25), "");
    let said = with(0.0);
    assert!(said.contains("bonds longer than 2 of 3 spacings"), "{said}");
}
