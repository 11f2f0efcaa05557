//! State-based materials in decks: stiffness and contraction, fields, fracture with energy balance, schemes, resume,
//! periodic bodies, unsupported features.

use std::collections::BTreeMap;

use pericles::observe::Field;
use pericles::{Control, Simulation};
use pericles_deck::Deck;
use pericles_run::{Facts, MaterialConstants};

use super::common::Build;
use super::composition::run_every_way;
use super::{build, parse, rejection};

/// A plate with a given displacement; STATE, NU and OTHER are placeholders.
const STRAINED: &str = r#"
body = { shape = "plate", size = [16, 14], origin = [0, 0], spacing = 1, plane = "STATE" }
material = { model = "state-based", strains = "small", density = 1, youngs_modulus = 10, poisson_ratio = NU, horizon_ratio = 3, influence = { function = "isotropic" }OTHER }
initial = [{ displacement = [{ expression = "1e-3*x" }, { expression = "4e-4*x - 2e-3*y" }] }]
time = { end = 1, dt = 0.01 }
output = { fields = { names = ["Stress", "Dilatation"] } }
"#;

fn strained(state: &str, nu: f64, other: &str) -> String {
    let text = STRAINED.replace("STATE", state).replace("OTHER", other);
    text.replace("NU", &nu.to_string())
}

/// Returns the point of a body nearest to a position.
fn nearest(run: &Simulation, place: [f64; 2]) -> usize {
    let cloud = run.system().cloud();
    let distance = |i: usize| {
        let point = cloud.point(i);
        (point[0] - place[0]).hypot(point[1] - place[1])
    };
    let all = 0..cloud.len();
    all.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        .unwrap()
}

/// Hooke's law inside a plate with the isotropic influence function, which has no lattice error. The virial stress
/// uses the deformed bonds, so the strains are small.
#[test]
fn interior_stress_follows_hookes_law() {
    let [xx, yy, xy]: [f64; 3] = [1e-9, -2e-9, 4e-10];
    for nu in [0.2f64, 0.45] {
        let (young, shear) = (10.0, 10.0 / (2.0 * (1.0 + nu)));
        let plane_stress = young / (1.0 - nu * nu);
        let plane_strain = young / ((1.0 + nu) * (1.0 - 2.0 * nu));
        let cases = [
            ("stress", plane_stress, plane_stress * nu),
            ("strain", plane_strain * (1.0 - nu), plane_strain * nu),
        ];
        for (state, along, across) in cases {
            let text = strained(state, nu, "").replace("1e-3*x", "1e-9*x");
            let text = text.replace("4e-4*x - 2e-3*y", "4e-10*x - 2e-9*y");
            let run = build(&text).simulation();
            let (snapshot, n) = (run.snapshot(), run.system().points());
            let middle = nearest(&run, [8.0, 7.0]);
            let stress = snapshot.field(Field::Stress);
            let expected = [
                along * xx + across * yy,
                across * xx + along * yy,
                shear * xy,
            ];
            for (c, expected) in expected.into_iter().enumerate() {
                let found = stress[c * n + middle];
                let error = (found - expected).abs() / (young * 2e-9);
                assert!(error < 1e-7, "{state} {nu}, {c}: {found} {expected}");
            }
        }
    }
}

/// In the interior, where neighbourhoods are complete.
#[test]
fn dilatation_of_a_uniform_strain_is_its_trace() {
    let run = build(&strained("strain", 0.3, "")).simulation();
    let snapshot = run.snapshot();
    for place in [[8.0, 7.0], [5.5, 5.5], [10.5, 8.5]] {
        let theta = snapshot.field(Field::Dilatation)[nearest(&run, place)];
        assert!((theta + 1e-3).abs() < 1e-14, "{theta}");
    }
}

/// A bar of state-based material has the strain σ/E away from its ends: bars have no lattice error.
#[test]
fn a_bar_in_tension_has_youngs_modulus() {
    let text = r#"
body = { shape = "bar", length = 60, spacing = 1 }
material = { model = "state-based", strains = "small", density = 1, youngs_modulus = 10, horizon_ratio = 3 }
sets = { left = { layer = { side = "-x", cells = 3 } }, right = { layer = { side = "+x", cells = 3 } } }
constraint = [{ set = "left", displacement = 0 }]
load = [{ set = "right", traction = 0.01 }]
time = { scheme = "adaptive-dynamic-relaxation", tolerance = 1e-10 }
"#;
    let mut run = build(text).simulation();
    run.run(|_| Control::Continue).unwrap();
    let u = &run.state().u;
    let strain = (u[40] - u[20]) / 20.0;
    // Observed: to the tolerance of adaptive dynamic relaxation.
    assert!((strain / 1e-3 - 1.0).abs() < 1e-6, "{strain}");
}

/// A free plate in tension: axial and transverse strain in its middle half.
///
/// The interior has no lattice error; errors come from the free surfaces of a plate of 20 rows. With the energy
/// correction the error of Young's modulus is at most 2 % (1.6 % at ν = 0.2, 0.9 % at 0.4 on a plate of 40 × 20
/// cells), and the error of the contraction several per cent: the bounds are twice these values.
#[test]
fn a_plate_in_tension_has_the_given_poissons_ratio() {
    for nu in [0.2f64, 0.45] {
        let text = r#"
body = { shape = "plate", size = [40, 20], origin = [-20, -10], spacing = 1, plane = "stress" }
material = { model = "state-based", strains = "small", density = 1, youngs_modulus = 10, poisson_ratio = NU, horizon_ratio = 3, influence = { function = "isotropic" }, surface_correction = "energy" }
sets = { left = { layer = { side = "-x", cells = 3 } }, right = { layer = { side = "+x", cells = 3 } } }
load = [{ set = "right", traction = [0.01, 0] }, { set = "left", traction = [-0.01, 0] }]
time = { scheme = "adaptive-dynamic-relaxation", tolerance = 1e-7 }
"#;
        let mut run = build(&text.replace("NU", &nu.to_string())).simulation();
        run.run(|_| Control::Continue).unwrap();
        let n = run.system().points();
        let u = &run.state().u;
        let at = |place: [f64; 2]| nearest(&run, place);
        let along = (u[at([9.5, 0.5])] - u[at([-9.5, 0.5])]) / 19.0;
        let across = (u[n + at([0.5, 6.5])] - u[n + at([0.5, -6.5])]) / 13.0;
        assert!((along * 10.0 / 0.01 - 1.0).abs() < 0.04, "{nu}: {along}");
        let ratio = -across / along;
        assert!((ratio / nu - 1.0).abs() < 0.12, "{nu}: {ratio}");
    }
}

/// A notched plate in tension that fractures; FAILURE is a placeholder.
const TORN: &str = r#"body = { shape = "plate", size = [30, 20], spacing = 1, plane = "stress" }
material = { model = "state-based", strains = "small", density = 1, youngs_modulus = 1, poisson_ratio = 0.2, horizon_ratio = 3, FAILURE }
crack = [{ segment = [[0, 10], [12, 10]] }]
sets.top = { layer = { side = "+y", cells = 1 } }
sets.bottom = { layer = { side = "-y", cells = 1 } }
constraint = [{ set = "top", velocity = ["free", 0.004] }, { set = "bottom", velocity = ["free", -0.004] }]
initial = [{ velocity = [0, { expression = "8e-3*(y/20-0.5)" }] }]
time = { end = 10, dt = 0.2 }
"#;

/// Results are bitwise identical for any number of threads and after a stop. With strains linear in the displacement
/// the energy balance is exact to rounding, also with breaking bonds.
#[test]
fn a_fracturing_plate_conserves_energy() {
    for failure in [
        "critical_stretch = 0.004",
        "critical_stretch = 0.004, bonds = \"list\"",
        "fracture_energy = 3e-5, stretch_definition = \"bond\"",
        "fracture_energy = 3e-5, failure = \"bond-energy\"",
    ] {
        let run = run_every_way(&TORN.replace("FAILURE", failure));
        assert!(run.broken > 20, "{failure}: {}", run.broken);
        assert!(run.off.abs() < 1e-9, "{failure}: {:e}", run.off);
    }
}

/// Before waves reach the faces, a periodic plate moves like the middle of a larger free one.
#[test]
fn a_periodic_plate_moves_like_the_interior_of_a_large_one() {
    let text = r#"
body = { shape = "plate", size = [SIZE, SIZE], origin = [-HALF, -HALF], spacing = 1, plane = "strain", periodic = PERIODIC }
material = { model = "state-based", density = 1, youngs_modulus = 1, poisson_ratio = 0.4, horizon_ratio = 3 }
initial = [{ displacement = [{ expression = "0.01*exp(-(x^2+y^2)/6)" }, { expression = "0.02*exp(-(x^2+y^2)/5)" }] }]
time = { end = 2, dt = 0.2 }
"#;
    let moved = |half: usize, periodic: bool| {
        let text = text.replace("SIZE", &(2 * half).to_string());
        let text = text.replace("HALF", &half.to_string());
        let mut run = build(&text.replace("PERIODIC", &periodic.to_string())).simulation();
        run.run(|_| Control::Continue).unwrap();
        let (n, cloud) = (run.system().points(), run.system().cloud());
        let u = &run.state().u;
        let place = |i: usize| {
            let point = cloud.point(i);
            [point[0], point[1]].map(|x| (2.0 * x).round() as i64)
        };
        let all = (0..n).map(|i| (place(i), [u[i], u[n + i]]));
        all.collect::<BTreeMap<_, _>>()
    };
    let (periodic, large) = (moved(20, true), moved(28, false));
    for (place, u) in &periodic {
        for (a, b) in u.iter().zip(&large[place]) {
            // The initial displacement is 1e-2, at the faces below 1e-30; waves travel three cells.
            assert!((a - b).abs() < 1e-11, "{place:?}: {a} {b}");
        }
    }
}

/// Two materials: points have the constants of their material, interface bonds the limit of the pair.
#[test]
fn materials_and_interfaces_have_their_own_constants() {
    let text = strained("strain", 0.3, ", name = \"steel\", critical_stretch = 0.1");
    let text = text
        + r#"
materials.glue = { density = 2, bulk_modulus = 3, shear_modulus = 1, fracture_energy = 1e-3 }
assign = [{ set = "part", material = "glue" }]
interface = [{ between = ["steel", "glue"], critical_stretch = 1e-5 }]
sets.part = { where = "x > 8" }
"#;
    let text = text.replace("function = \"isotropic\"", "function = \"conical\"");
    let built = build(&text);
    let glue = built.other_materials[0].state_based().unwrap();
    assert!((glue.elastic.bulk() / 3.0 - 1.0).abs() < 1e-14);
    assert_eq!(built.system.density().at(0), 1.0);
    let mut run = built.simulation();
    run.run(|run| match run.state().step {
        0 => Control::Continue,
        _ => Control::Stop,
    })
    .unwrap();
    let damage = run.snapshot().field(Field::Damage).to_vec();
    let broken = |place| damage[nearest(&run, place)];
    assert!(broken([7.5, 7.0]) > 0.1 && broken([8.5, 7.0]) > 0.1);
    assert_eq!(broken([2.5, 7.0]), 0.0);
}

#[test]
fn facts_contain_elastic_constants_and_anisotropy_of_the_lattice() {
    let text = strained(
        "strain",
        0.3,
        ", fracture_energy = 1e-4, volume_correction = \"none\"",
    );
    let deck = parse(&text);
    let built = deck.build().unwrap();
    let facts = Facts::of_deck(&deck, &built.assembly);
    let number = |key: &str| facts.number(key).unwrap();
    assert!((number("poisson_ratio") - 0.3).abs() < 1e-14);
    assert!((number("shear_modulus") - 10.0 / 2.6).abs() < 1e-12);
    assert_eq!(facts.text("operator"), "grid");
    for error in ["shear_error", "diagonal_shear_error"] {
        assert!(number(error).abs() < 1e-13);
    }
    // Weighted sums over the lattice with three spacings: constant function, no volume correction.
    let constant = text.replace("isotropic", "constant");
    let built = build(&constant);
    let shear = match built.assembly.constants.as_ref().unwrap() {
        MaterialConstants::StateBased(constants) => constants.lattice_shear.unwrap(),
        _ => panic!("state-based"),
    };
    assert!((shear.axes - 0.9647).abs() < 1e-4 && (shear.diagonals - 1.0353).abs() < 1e-4);
}

#[test]
fn state_based_models_round_trip_through_json() {
    for part in [
        "",
        ", fracture_energy = 1e-4, failure = \"bond-energy\", volume_correction = \"none\"",
        ", fracture_energy = 1e-4, stretch_definition = \"iso\", volume_correction = \"none\", surface_correction = \"energy\"",
    ] {
        let model = parse(&strained("stress", 0.3, part)).model;
        let json = serde_json::to_string(&model).unwrap();
        let read: pericles_deck::Model = serde_json::from_str(&json).unwrap();
        assert_eq!(read, model, "{json}");
    }
}

#[test]
fn unsupported_features_of_state_based_materials_are_rejected_with_a_reason() {
    let text = strained("stress", 0.3, "");
    let reject = |text: &str, reason: &str| {
        let error = rejection(text).to_string();
        assert!(error.contains(reason), "{error}");
    };
    let influence = "{ function = \"isotropic\" }";
    for (form, other, reason) in [
        ("grid-f32", "", "a stencil in double precision"),
        ("convolution", "", "a stencil in double precision"),
        ("spectral", "", "a stencil in double precision"),
        (
            "grid",
            ", surface_correction = \"energy\"",
            "the surface correction of state-based materials needs a neighbour list",
        ),
        (
            "grid",
            ", volume_correction = \"none\", failure = \"bond-energy\", fracture_energy = 1e-3",
            "the work of each bond is stored with a neighbour list only",
        ),
    ] {
        let bonds = format!("{influence}, bonds = \"{form}\"{other}");
        reject(&text.replace(influence, &bonds), reason);
    }
    let refined = text.replace(
        "spacing = 1,",
        "spacing = 1, refine = [{ ratio = 2, layer = { side = \"-x\", cells = 4 } }],",
    );
    reject(&refined, "need cells of one size");
    let bond_based = text.replace("strains = \"small\", ", "");
    let bond_based = bond_based
        .replace("state-based", "linear")
        .replace("isotropic", "conical")
        .replace("poisson_ratio = 0.3, ", "");
    reject(
        &bond_based,
        "only state-based and correspondence materials (model = \"state-based\" or \"correspondence\") have a dilatation",
    );
    // With six spacings the isotropic function of a plate is negative near the horizon.
    let signed = strained(
        "stress",
        0.3,
        ", critical_stretch = 0.1, volume_correction = \"none\"",
    );
    reject(
        &signed.replace("horizon_ratio = 3", "horizon_ratio = 6"),
        "negative near the horizon",
    );
}

/// The default influence function is conical; other defaults are the same as for bond-based materials.
#[test]
fn the_default_influence_function_is_conical() {
    let text = strained("stress", 0.3, "");
    let left_out = text.replace(", influence = { function = \"isotropic\" }", "");
    let given = text.replace("isotropic", "conical");
    let model = |text: &str| Deck::parse(text, "deck.toml", &[]).unwrap().model;
    assert_eq!(model(&left_out), model(&given));
}
