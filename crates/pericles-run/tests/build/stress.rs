//! Stress fields of bodies with a given strain.

use pericles::Control;
use pericles::observe::Field;

use super::build;

const PLATE: &str = "shape = \"plate\", size = [14, 14], spacing = 1, plane =";
const BOX: &str = "shape = \"block\", size = [14, 13, 13], spacing = 1";
const BAR: &str = "shape = \"bar\", length = 14, spacing = 1";

/// A body with initial displacements, E = 10 and ν = `nu`.
fn strained(body: &str, material: &str, displacement: &[String]) -> String {
    let displacement = displacement
        .iter()
        .map(|one| format!("{{ expression = \"{one}\" }}"));
    let displacement: Vec<String> = displacement.collect();
    format!(
        "body = {{ {body} }}\nmaterial = {{ density = 1, youngs_modulus = 10, horizon_ratio = 3, {material} }}\n\
         initial = [{{ displacement = [{}] }}]\ntime = {{ end = 1e-9 }}\n",
        displacement.join(", ")
    )
}

/// Returns a field of the initial state, component-major.
fn field(deck: &str, field: Field) -> Vec<f64> {
    let run = build(deck).simulation();
    run.snapshot().field(field).to_vec()
}

/// The stress of a correspondence material follows from the deformation gradient: under uniform strain it is the stress of
/// Hooke's law at every point, surfaces included.
#[test]
fn correspondence_bodies_of_uniform_strain_have_the_stress_of_hookes_law_everywhere() {
    let (young, nu, e) = (10.0, 0.3, 1e-8);
    let [lame, shear] = [
        young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
        young / (2.0 * (1.0 + nu)),
    ];
    let constrained = lame + 2.0 * shear;
    let plate = |state: &str| format!("{PLATE} \"{state}\"");
    let plane = young / (1.0 - nu * nu);
    for (body, expected) in [
        (BAR.to_owned(), vec![young * e]),
        (plate("stress"), vec![plane * e, nu * plane * e, 0.0]),
        (plate("strain"), vec![constrained * e, lame * e, 0.0]),
        (
            BOX.replace("[14, 13, 13]", "[6, 5, 5]"),
            vec![constrained * e, lame * e, lame * e, 0.0, 0.0, 0.0],
        ),
    ] {
        let d = [1, 3, 6].iter().position(|&m| m == expected.len()).unwrap() + 1;
        for law in [
            "st-venant-kirchhoff",
            "neo-hooke",
            "neo-hooke-split",
            "hencky",
        ] {
            let nu = match d {
                1 => String::new(),
                _ => format!("poisson_ratio = {nu}, "),
            };
            let material = format!("model = \"correspondence\", {nu}law = \"{law}\"");
            let mut u = vec![format!("{e}*x")];
            u.resize(d, "0".into());
            let deck = strained(&body, &material, &u);
            let stress = field(&deck, Field::Stress);
            let n = stress.len() / expected.len();
            for (k, expected) in expected.iter().enumerate() {
                for found in &stress[k * n..(k + 1) * n] {
                    let error = (found - expected).abs() / (young * e);
                    assert!(error < 1e-6, "{body}, {law}, {k}: {found} {expected}");
                }
            }
            let von_mises = field(&deck, Field::VonMisesStress);
            let spread = von_mises.iter().map(|s| (s / von_mises[0] - 1.0).abs());
            assert!(spread.fold(0.0, f64::max) < 1e-6);
        }
    }
}

/// A perfectly plastic plate in tension: no point exceeds the yield stress.
#[test]
fn no_point_of_a_perfectly_plastic_correspondence_body_exceeds_the_yield_stress() {
    let deck = format!(
        "body = {{ {PLATE} \"stress\" }}\n\
         material = {{ density = 1, youngs_modulus = 10, horizon_ratio = 3, model = \"correspondence\", poisson_ratio = 0.3, yield_stress = 0.02 }}\n\
         sets = {{ left = {{ layer = {{ side = \"-x\", cells = 3 }} }}, right = {{ layer = {{ side = \"+x\", cells = 3 }} }} }}\n\
         constraint = [{{ set = \"left\", displacement = [0, 0] }}, {{ set = \"right\", displacement = [{{ expression = \"0.04*t\" }}, 0] }}]\n\
         time = {{ scheme = \"static\", end = 1, load_steps = 4, tolerance = 1e-8 }}\n"
    );
    let mut run = build(&deck).simulation();
    run.run(|_| Control::Continue).unwrap();
    let snapshot = run.snapshot();
    let largest = snapshot.field(Field::VonMisesStress);
    let largest = largest.iter().fold(0.0, |most: f64, s| most.max(*s));
    // The yield function depends on the Kirchhoff stress.
    assert!((0.0198..0.0201).contains(&largest), "{largest}");
}

/// Laws of small strains: stress is proportional to the load.
#[test]
fn stress_of_linear_bodies_is_proportional_to_the_load() {
    for material in [
        "model = \"linear\", bonds = \"grid\"",
        "model = \"linear\", bonds = \"list\"",
        "model = \"state-based\", strains = \"small\", poisson_ratio = 0.2, bonds = \"grid\"",
        "model = \"state-based\", strains = \"small\", poisson_ratio = 0.2, bonds = \"list\"",
    ] {
        let of_load = |load: f64| {
            let u = [
                format!("{load}*0.01*x*y"),
                format!("{load}*(0.02*x - 0.01*y^2)"),
            ];
            field(
                &strained(&format!("{PLATE} \"stress\""), material, &u),
                Field::Stress,
            )
        };
        let [small, large, reversed] = [1e-3, 1.0, -1.0].map(of_load);
        let size = large.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
        for ((small, large), reversed) in small.iter().zip(&large).zip(&reversed) {
            assert!((1e3 * small - large).abs() < 1e-10 * size, "{material}");
            assert!((reversed + large).abs() < 1e-10 * size, "{material}");
        }
    }
}

/// The Cauchy stress is the derivative of the energy: under uniform expansion by λ it is W′(λ)/(D λ^(D − 1)), with the
/// energy W per reference volume.
#[test]
fn stress_at_finite_strain_is_the_derivative_of_the_energy() {
    let plane = format!("{PLATE} \"strain\"");
    for (body, d) in [(BAR, 1), (&*plane, 2), (BOX, 3)] {
        for material in [
            "model = \"bond-stretch\", bonds = \"grid\"",
            "model = \"bond-stretch\", bonds = \"list\"",
            "model = \"bond-stretch\", critical_stretch = 0.9, softening = { law = \"linear\", onset_stretch = 0.8 }",
            "model = \"state-based\", poisson_ratio = 0.3, bonds = \"grid\"",
            "model = \"state-based\", poisson_ratio = 0.3, bonds = \"list\"",
            "model = \"correspondence\", poisson_ratio = 0.3, law = \"neo-hooke\"",
        ] {
            // The Poisson effect of a bar of a correspondence material changes its section.
            let is_bar = d == 1;
            let is_slow = d == 3 && !material.contains("grid");
            if is_slow
                || is_bar && (material.contains("correspondence") || material.contains("grid"))
            {
                continue;
            }
            let material = match is_bar {
                true => material.replace("poisson_ratio = 0.3, ", ""),
                false => material.to_owned(),
            };
            let deck = |growth: f64| {
                let u = ["x", "y", "z"].map(|axis| format!("({growth})*{axis}"));
                strained(body, &material, &u[..d])
            };
            let energy = |growth: f64| field(&deck(growth), Field::StrainEnergyDensity);
            let (growth, step) = (0.08, 1e-4);
            let [less, more] = [energy(growth - step), energy(growth + step)];
            let n = less.len();
            let stress = field(&deck(growth), Field::Stress);
            // A point that is two horizons away from all surfaces.
            let cloud_of = build(&deck(growth)).simulation();
            let cloud = cloud_of.system().cloud();
            let middle = [7.0, 7.0, 7.0];
            let distance = |i: usize| -> f64 {
                let place = cloud.point(i);
                (0..d).map(|c| (place[c] - middle[c]).powi(2)).sum()
            };
            let i = (0..n)
                .min_by(|&i, &j| distance(i).total_cmp(&distance(j)))
                .unwrap();
            let slope = (more[i] - less[i]) / (2.0 * step);
            let expected = slope / (d as f64 * (1.0 + growth).powi(d as i32 - 1));
            let found = stress[i];
            assert!(
                (found / expected - 1.0).abs() < 1e-5,
                "{body}, {material}: {found} {expected}"
            );
        }
    }
}
