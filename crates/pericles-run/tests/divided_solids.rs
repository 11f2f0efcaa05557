//! Stress and strain of solids on bodies divided among processes: the files equal the files of a run on a single process.

mod common;

use common::processes::{PULL, check, notched_block};

/// History with the extremes of a field that all materials of these tests have.
const HISTORY: &str = "history = { every = 1, extremes = [\"Damage\"] }\n";
const FIELDS: &str = "fields = { count = 2 }";
const TENSORS: &str = "fields = { count = 2, names = [\"Displacement\", \"Stress\", \"Strain\", \"Equivalent_Stress\", \"Principal_Stress\", \"Dilatation\"], format = [\"vtu\", \"vtkhdf\"] }\npicture = [{ field = \"Equivalent_Stress\", count = 1 }]\nprofile = [{ name = \"middle\", field = \"Stress_yy\", from = [0, 4, 2.5], to = [12, 4, 2.5] }]";

const SOLID: &str = "model = \"state-based\"\ndensity = 1\nyoungs_modulus = 1\npoisson_ratio = 0.3\nhorizon = 3.01\ninfluence = { function = \"conical\" }\n";
const BREAKS: &str = "critical_stretch = 0.012\n";
const PLASTIC: &str = "yield_stress = 0.003\nhardening = 0.2\n";

/// Returns the largest number of a column of the history.
fn largest(history: &str, column: &str) -> f64 {
    let mut lines = history.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let place = names.iter().position(|name| name.starts_with(column));
    let place = place.unwrap_or_else(|| panic!("{column}: {names:?}"));
    let numbers = lines.filter_map(|line| line.split(',').nth(place)?.parse::<f64>().ok());
    numbers.fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn stress_and_strain_have_the_files_of_one_process() {
    let end = format!("{PULL}end = 3\ndt = 0.2");
    let correspondence = SOLID.replace("state-based", "correspondence");
    for material in [
        format!("{SOLID}{BREAKS}bonds = \"list\""),
        format!("{SOLID}{BREAKS}bonds = \"grid\""),
        format!("{SOLID}surface_correction = \"energy\""),
        format!("{correspondence}{BREAKS}"),
        format!("{correspondence}{PLASTIC}"),
    ] {
        println!("{material}");
        let output = format!("{HISTORY}{TENSORS}");
        check(&notched_block(&material, &end, &output), &[2, 3, 4]);
    }
}

/// In fine regions bonds break in sweeps over a part of the points: a point may lose bonds that points of other processes decide on.
#[test]
fn failure_by_stress_has_the_files_of_one_process() {
    let by_stress = "failure = \"principal-stress\"\nstrength = 0.02\n";
    let output = format!("{HISTORY}{FIELDS}");
    let correspondence = SOLID.replace("state-based", "correspondence");
    let adaptive = "ratio = 2\nadaptive = { every = 2, threshold = 0.5, layers = 1 }\n";
    let fine = "ratio = 2\nfine = \"bottom\"\n";
    for (solid, scheme, region) in [
        (SOLID, "velocity-verlet", ""),
        (SOLID, "multirate-rk3", adaptive),
        (&correspondence, "multirate-rk4", adaptive),
        (SOLID, "multirate-rk3", fine),
    ] {
        println!("{solid}{scheme} {region}");
        let time = format!("{PULL}end = 4\ndt = 0.2\nscheme = \"{scheme}\"\n{region}");
        let deck = notched_block(&format!("{solid}{by_stress}"), &time, &output);
        let history = check(&deck, &[2, 3, 4]);
        assert!(largest(&history, "max_Damage") > 0.0, "{history}");
    }
}

/// Means over the points of a material, values at points and yield stresses at temperatures do not depend on the division.
#[test]
fn properties_as_functions_have_the_files_of_one_process() {
    let end = format!(
        "{PULL}end = 3\ndt = 0.2\n[thermal]\nexpansion = 1e-5\nreference = 293\ntemperature = {{ expression = \"293 + 20*x + 30*t\" }}\n"
    );
    let graded = SOLID
        .replace(
            "density = 1\n",
            "density = { expression = \"1 + 0.05*x + 0.01*z\" }\n",
        )
        .replace(
            "youngs_modulus = 1\n",
            "youngs_modulus = { expression = \"1 + 0.3*exp(-y)\" }\n",
        );
    let correspondence = graded.replace("state-based", "correspondence");
    let breaks = "critical_stretch = { expression = \"0.012 + 1e-3*x\" }\n";
    let plastic = "yield_stress = { expression = \"0.003*(1 + 0.1*y)*(1 - (temperature - 293)/5000)\" }\nhardening = 0.2\n";
    let criterion = "failure = \"expression\"\ncriterion = \"normal_stress/(0.02 + 1e-3*x + 1e-6*temperature)*(1 + 0.1*t)\"\n";
    for material in [
        format!("{graded}{breaks}"),
        format!("{correspondence}{plastic}"),
        format!("{graded}{plastic}{breaks}"),
        format!("{graded}{criterion}"),
    ] {
        println!("{material}");
        let output = format!("{HISTORY}{FIELDS}");
        check(&notched_block(&material, &end, &output), &[2, 3]);
    }
}
