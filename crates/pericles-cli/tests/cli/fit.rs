//! `fit`: keys of a deck fitted to a measured curve.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use pericles_io::read_csv;

use crate::common::{fail, run, succeed, text};

/// A bar that a constant traction pulls: the velocity of its end follows from ρ c, the time of arrival from c.
const BAR: &str = r#"
[body]
shape = "bar"
length = "100 mm"
spacing = "2 mm"
[material]
density = "2700 kg/m3"
youngs_modulus = "70 GPa"
horizon_ratio = 3
model = "linear"
[sets]
pulled = { where = "x > 0.097" }
[[load]]
set = "pulled"
traction = ["1 MPa"]
[[probe]]
name = "end"
at = ["99 mm"]
[time]
end = "60 us"
[output]
history = { every = 1 }
"#;

/// Runs the bar with other values, and writes the displacement of its end as a measured curve in other units.
fn with_measured(set: &str) -> tempfile::TempDir {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("bar.toml"), BAR).unwrap();
    succeed(
        place.path(),
        &format!("run bar.toml --quiet --out truth {set}"),
    );
    let probes = read_csv(place.path().join("truth/probes.csv")).unwrap();
    let column = |name: &str| probes.column(name).unwrap();
    let mut measured = String::from("t [us],u [um]\n");
    for (t, u) in column("time").iter().zip(column("end_u_x")).step_by(7) {
        writeln!(measured, "{:e},{:e}", 1e6 * t, 1e6 * u).unwrap();
    }
    fs::write(place.path().join("measured.csv"), measured).unwrap();
    place
}

const FIT: &str = "fit bar.toml measured.csv --x time --y end.u_x --quiet";
const BOTH: &str = "--keys material.youngs_modulus,material.density";

/// Returns the rows of fit.csv: numbers from `start` on.
fn rows(folder: &Path) -> Vec<Vec<f64>> {
    let table = fs::read_to_string(folder.join("fit.csv")).unwrap();
    let row = |line: &str| {
        let cells = line.split(',').skip(2);
        cells.map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()
    };
    table.lines().skip(1).map(row).collect()
}

#[test]
fn the_values_of_a_run_are_recovered_from_its_curve() {
    let place = with_measured("--set material.youngs_modulus=60GPa --set material.density=3000");
    let output = succeed(
        place.path(),
        &format!("{FIT} {BOTH} --tolerance 1e-6 --out fit").replace(" --quiet", ""),
    );
    let said = text(&output.stdout);
    assert!(
        said.contains("material.youngs_modulus  70.0 GPa → 60.0 GPa ±"),
        "{said}"
    );
    let folder = place.path().join("fit");
    let header = fs::read_to_string(folder.join("fit.csv")).unwrap();
    assert!(header.starts_with(
        "key,unit,start,value,standard_error,low_95,high_95,lower_bound,upper_bound\nmaterial.youngs_modulus,Pa,"
    ));
    for (row, [start, truth]) in rows(&folder).iter().zip([[70e9, 60e9], [2700.0, 3000.0]]) {
        assert_eq!(
            (row[0], row[5], row[6]),
            (start, start / 10.0, start * 10.0)
        );
        assert!((row[1] / truth - 1.0).abs() < 1e-5, "{row:?}");
        // The curve has no error but that of the search.
        assert!(row[2] / truth < 1e-5, "{row:?}");
        assert!((row[4] - row[1]) / row[2] > 1.96, "{row:?}");
    }
    let curve = read_csv(folder.join("curve.csv")).unwrap();
    let names: Vec<&str> = curve.columns.iter().map(|column| column.name()).collect();
    assert_eq!(
        names,
        [
            "time",
            "measured end.u_x",
            "start end.u_x",
            "fitted end.u_x"
        ]
    );
    assert!(folder.join("fit.png").is_file());

    // The fitted values are those of another run.
    let set = said
        .lines()
        .find_map(|line| line.strip_prefix("fitted values: "));
    succeed(
        place.path(),
        &format!("run bar.toml --quiet --out again {}", set.unwrap()),
    );
    let probes = read_csv(place.path().join("again/probes.csv")).unwrap();
    let last = *probes.column("end_u_x").unwrap().last().unwrap();
    let measured = *curve.values[1].last().unwrap();
    assert!((last / measured - 1.0).abs() < 0.1, "{last} {measured}");
}

#[test]
fn a_fit_is_resumed_with_the_same_result() {
    let place = with_measured("--set material.youngs_modulus=60GPa");
    let fit = format!("{FIT} --keys material.youngs_modulus");
    succeed(place.path(), &format!("{fit} --out whole"));
    let whole = fs::read(place.path().join("whole/fit.csv")).unwrap();
    // Some runs are missing, as after a signal.
    let folder = place.path().join("whole");
    for name in ["run-0002", "run-0004"] {
        fs::remove_dir_all(folder.join(name)).unwrap();
    }
    fs::remove_file(folder.join("fit.csv")).unwrap();
    succeed(place.path(), "resume whole --quiet");
    assert_eq!(fs::read(folder.join("fit.csv")).unwrap(), whole);
    let (status, message) = fail(place.path(), "resume whole --set time.end=1s");
    assert_eq!(status, 3);
    assert!(message.contains("it is a fit"), "{message}");
}

#[test]
fn limits_of_a_fit_are_stated() {
    let place = with_measured("--set material.youngs_modulus=60GPa");
    let warned = |arguments: &str, status: i32, says: &str| {
        let output = run(place.path(), &format!("{FIT} {arguments}"));
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{message}");
        assert!(message.contains(says), "{message}");
    };
    warned(
        "--keys material.youngs_modulus --runs 5",
        5,
        "the values still change after 5 runs",
    );
    warned(
        "--keys material.youngs_modulus=65GPa:90GPa",
        0,
        "material.youngs_modulus is at its bound",
    );
    warned(
        "--keys material.youngs_modulus --set time.end=55us",
        0,
        "measured points are beyond the end of the fitted curve",
    );
    // The energy of fracture does not matter for a body that does not break.
    warned(
        "--keys material.youngs_modulus,material.fracture_energy --set material.fracture_energy=1e9",
        0,
        "the curve does not determine material.fracture_energy",
    );
}

#[test]
fn invalid_fits_are_rejected_before_anything_is_run() {
    let place = with_measured("--set material.youngs_modulus=60GPa");
    for (arguments, status, says) in [
        (
            "--keys material.modulus_of_young",
            3,
            "material.modulus_of_young has no number",
        ),
        (
            "--keys material.youngs_modulus=80GPa:90GPa",
            3,
            "do not contain its value in the deck",
        ),
        (
            "--keys material.youngs_modulus=1:90mm",
            3,
            "`90mm` is not a modulus",
        ),
        (
            "--keys material.youngs_modulus=1",
            2,
            "expected KEY or KEY=LOW:HIGH",
        ),
        (
            "--keys material.density,material.density",
            3,
            "key 2 repeats material.density",
        ),
        ("--keys material.density --runs 3", 3, "3 runs are too few"),
        (
            "--keys material.density --step 0",
            2,
            "expected a number above 0",
        ),
    ] {
        let (found, message) = fail(place.path(), &format!("{FIT} {arguments} --out none"));
        assert_eq!(found, status, "{message}");
        assert!(message.contains(says), "{message}");
        assert!(!place.path().join("none").exists());
    }
    let (status, message) = fail(
        place.path(),
        "fit bar.toml measured.csv --x time --y elastic_energy --keys material.density --quiet",
    );
    assert_eq!(status, 3);
    assert!(
        message.contains("elastic_energy is measured in m, but the run has it in J"),
        "{message}"
    );
    let (status, message) = fail(
        place.path(),
        "fit bar.toml measured.csv --x time --y tip.u_x --keys material.density --quiet",
    );
    assert_eq!(status, 2);
    assert!(
        message.contains("there is no column \"tip.u_x\""),
        "{message}"
    );
}
