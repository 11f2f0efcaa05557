//! Surface effect of thin bodies.

use std::fs;

use super::reactions;
use crate::common::{report, succeed};

#[test]
fn the_predicted_surface_effect_of_thin_solids_is_the_measured_one() {
    for (size, plane, influence) in [
        ("[30, 4, 4]", "", "{ function = \"constant\" }"),
        ("[30, 4, 4]", "", "{ function = \"conical\" }"),
        (
            "[40, 3]",
            "plane = \"strain\"",
            "{ function = \"constant\" }",
        ),
    ] {
        let shape = if plane.is_empty() { "block" } else { "plate, " }.trim_end_matches(", ");
        let pull = |c: &str| match plane.is_empty() {
            true => format!("[{c}, \"free\", \"free\"]"),
            false => format!("[{c}, \"free\"]"),
        };
        let length = size.trim_matches(['[', ']']).split(',').next().unwrap();
        let deck = format!(
            r#"
body = {{ shape = "{shape}", size = {size}, spacing = 1{}{plane} }}
material = {{ model = "state-based", density = 1, youngs_modulus = 1, poisson_ratio = 0.25, horizon_ratio = 3, strains = "small", influence = {influence} }}
sets.left = {{ layer = {{ side = "-x", cells = 1 }} }}
sets.right = {{ layer = {{ side = "+x", cells = 1 }} }}
probe = [{{ name = "a", at = {} }}, {{ name = "b", at = {} }}]
constraint = [{{ set = "left", displacement = {} }}, {{ set = "right", displacement = {} }}]
time = {{ scheme = "static", tolerance = 1e-8, rigid_modes = "fix" }}
output = {{ fields = "never" }}
"#,
            if plane.is_empty() { "" } else { ", " },
            if plane.is_empty() {
                "[10.5, 1.5, 1.5]"
            } else {
                "[10.5, 1.5]"
            },
            if plane.is_empty() {
                "[19.5, 1.5, 1.5]"
            } else {
                "[29.5, 1.5]"
            },
            pull("0"),
            pull("1e-4"),
        );
        let place = tempfile::tempdir().unwrap();
        fs::write(place.path().join("deck.toml"), &deck).unwrap();
        succeed(place.path(), "run deck.toml --quiet --out out --force");
        let report = report(&place.path().join("out"));
        let list = report["model"]["warnings"].as_array().unwrap();
        let line = list.iter().filter_map(|line| line.as_str());
        let line: Vec<&str> = line
            .filter(|line| line.contains("surface effect"))
            .collect();
        assert_eq!(line.len(), 1, "{list:?}");
        let before = line[0].split(" % too").next().unwrap();
        let predicted: f64 = before.rsplit(' ').next().unwrap().parse().unwrap();
        let sign = if line[0].contains("too stiff") {
            1.0
        } else {
            -1.0
        };
        // Stress over strain between two probes far from the ends.
        let table = fs::read_to_string(place.path().join("out/probes.csv")).unwrap();
        let (names, last) = (table.lines().next().unwrap(), table.lines().last().unwrap());
        let column = |name: &str| -> f64 {
            let k = names
                .split(',')
                .position(|one| one.starts_with(name))
                .unwrap();
            last.split(',').nth(k).unwrap().parse().unwrap()
        };
        let gauge = if plane.is_empty() { 9.0 } else { 19.0 };
        let strain = (column("b_u_x") - column("a_u_x")) / gauge;
        let (area, young) = match plane.is_empty() {
            true => (16.0, 1.0),
            false => (3.0, 1.0 / (1.0 - 0.0625)),
        };
        let force = reactions(place.path());
        let x_of_right = force[force.len() / 2];
        let measured = x_of_right.abs() / (area * young * strain) - 1.0;
        // The prediction is the energy of a uniform strain, an upper bound of the stiffness; it was at most 4 % above it.
        let excess = sign * 0.01 * predicted - measured;
        assert!(
            excess > -0.005 && excess < 0.05,
            "{size} {length}: predicted {predicted} %, measured {measured}"
        );
    }
}
