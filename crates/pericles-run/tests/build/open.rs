//! Open boundaries of plates.

use pericles::Control;

use super::{build, rejection};

/// A plate with a pulse, part of an infinite one.
const PLATE: &str = r#"
[body]
shape = "plate"
size = ["48 mm", "44 mm"]
spacing = "1 mm"
plane = "stress"
[material]
model = "linear"
density = "2440 kg/m3"
youngs_modulus = "72 GPa"
horizon_ratio = 2
critical_stretch = 0.01
[[initial]]
displacement = [{ expression = "1e-5 * exp(-((x-0.024)^2 + (y-0.022)^2)/(2.5e-3)^2)" }, 0]
[[boundary]]
kind = "open"
side = "all"
[time]
end = "30 us"
"#;

#[test]
fn open_plates_lose_the_energy_of_waves() {
    let model = build(PLATE);
    let report = model.open.clone().unwrap();
    assert_eq!(report.points, 48 * 44 - 24 * 20);
    let mut run = model.simulation();
    run.run(|_| Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    let rest = energies.kinetic + energies.elastic;
    assert!(rest < 1e-2 * energies.initial, "{energies:?}");
    let balance = energies.balance().abs();
    assert!(balance < 1e-12 * energies.initial, "{energies:?}");
}

#[test]
fn layers_may_be_given_by_side_and_by_length() {
    let sides = |text: &str| {
        let deck = PLATE.replace("kind = \"open\"\nside = \"all\"", text);
        build(&deck).open.clone().unwrap().sides.cells
    };
    let all = [[Some(12); 2]; 2];
    assert_eq!(sides("kind = \"open\"\nside = \"all\""), all);
    assert_eq!(
        sides("kind = \"open\"\nside = [\"+x\", \"-x\", \"-y\", \"+y\"]\nthickness = \"11.2 mm\""),
        all
    );
    assert_eq!(
        sides(
            "kind = \"open\"\nside = \"-x\"\ncells = 9\n[[boundary]]\nkind = \"open\"\nside = [\"-y\"]"
        ),
        [[Some(9), None], [Some(12), None]]
    );
}

#[test]
fn bonds_in_open_layers_do_not_break() {
    // A displacement that breaks all bonds where it is large, and a crack that would run into the layer.
    let pulled = PLATE.replace("1e-5 * exp", "3e-3 * exp");
    let mut run = build(&pulled).simulation();
    run.run(|_| Control::Continue).unwrap();
    let snapshot = run.snapshot();
    let damage = snapshot.field(pericles::observe::Field::Damage);
    let cloud = run.system().cloud();
    let mut inside = 0;
    for (i, damage) in damage.iter().enumerate() {
        let [x, y, _] = cloud.point(i);
        let depth = [x, 0.048 - x, y, 0.044 - y]
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        if depth < 0.0135 {
            assert!(*damage < 1e-12, "({x}, {y}): {damage}");
        } else {
            inside += usize::from(*damage > 0.3);
        }
    }
    assert!(inside > 10, "{inside}");
}

#[test]
fn periodic_plates_may_be_open_along_one_axis() {
    let periodic = PLATE.replace("plane = \"stress\"", "plane = \"stress\"\nperiodic = true");
    let strip = periodic.replace("side = \"all\"", "side = [\"-x\", \"+x\"]");
    let strip = strip.replace(" + (y-0.022)^2", "");
    let mut run = build(&strip).simulation();
    run.run(|_| Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    let rest = energies.kinetic + energies.elastic;
    assert!(rest < 1e-3 * energies.initial, "{energies:?}");
    assert!(
        energies.balance().abs() < 1e-12 * energies.initial,
        "{energies:?}"
    );
    let message = rejection(&periodic.replace("side = \"all\"", "side = \"+x\"")).to_string();
    assert!(message.contains("open both sides"), "{message}");
}

#[test]
fn unsupported_models_have_one_message_each() {
    let open = "[[boundary]]\nkind = \"open\"\nside = \"all\"\n";
    let cases = [
        (
            "spacing = \"1 mm\"",
            "spacing = [\"1 mm\", \"2 mm\"]",
            "the spacing is 1.00 mm along x and 2.00 mm along y",
        ),
        ("[time]", "[time]\nscheme = \"rk4\"", "velocity-verlet"),
        (
            "[time]",
            "[time]\nscheme = \"implicit-midpoint\"\ndt = \"0.1 us\"",
            "velocity-verlet",
        ),
        (
            "[time]",
            "[time]\nscheme = \"dormand-prince\"\ntolerance = 1e-6",
            "velocity-verlet",
        ),
        ("[time]", "[time]\ndt = \"1 us\"", "dt"),
        (
            open,
            "[[boundary]]\nkind = \"open\"\nside = [\"-x\", \"+x\"]\n",
            "both sides normal to y are free",
        ),
        (
            open,
            "[[boundary]]\nkind = \"open\"\nside = \"all\"\ncells = 6\n",
            "has 6 cells; allowed: from 8",
        ),
        (
            open,
            "[[boundary]]\nkind = \"open\"\nside = \"all\"\ncells = 22\n",
            "of which its layers occupy 44",
        ),
        (
            open,
            "[[boundary]]\nkind = \"open\"\nside = \"all\"\n[[boundary]]\nkind = \"open\"\nside = \"+x\"\n",
            "each side once",
        ),
        (
            open,
            "[[boundary]]\nkind = \"open\"\nside = [\"-x\", \"-y\"]\n[[boundary]]\nkind = \"damping-layer\"\nside = \"+x\"\nthickness = \"10 mm\"\n",
            "no boundary of another kind",
        ),
        ("[time]", "[damping]\nmass = 1\n[time]", "no other damping"),
        ("[time]", "[contact]\n[time]", "no contact"),
        (
            "[time]",
            "[[load]]\nset = \"all\"\nbody_force = [1, 0]\n[time]",
            "a load acts on point",
        ),
        (
            "[time]",
            "[sets.left]\nlayer = { side = \"-x\", cells = 1 }\n[[constraint]]\nset = \"left\"\ndisplacement = [0, 0]\n[time]",
            "a prescribed motion acts on point",
        ),
        (
            "(x-0.024)^2",
            "(x-0.014)^2",
            "the initial displacement at point",
        ),
        (
            "[time]",
            "[[crack]]\nsegment = [[\"30 mm\", \"20 mm\"], [\"40 mm\", \"20 mm\"]]\n[time]",
            "the layer is not uniform",
        ),
        (
            "[time]",
            "[materials.soft]\nmodel = \"linear\"\ndensity = 2440\nyoungs_modulus = \"20 GPa\"\nhorizon_ratio = 2\n[sets.right]\nwhere = \"x > 0.03\"\n[[assign]]\nset = \"right\"\nmaterial = \"soft\"\n[time]",
            "the layer is not uniform",
        ),
        (
            "plane = \"stress\"",
            "plane = \"stress\"\nhole = [{ ball = { centre = [\"40 mm\", \"20 mm\"], radius = \"2 mm\" } }]",
            "no holes",
        ),
        (
            "model = \"linear\"",
            "model = \"state-based\"\npoisson_ratio = 0.3",
            "a bond-based material",
        ),
    ];
    for (old, new, expected) in cases {
        let message = rejection(&PLATE.replace(old, new)).to_string();
        assert!(message.contains(expected), "{new}: {message}");
    }
}
