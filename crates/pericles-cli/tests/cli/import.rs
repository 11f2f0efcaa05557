//! The command `import`: decks from input files of PeriLab and Peridigm.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use pericles_io::read_csv;

use crate::common::{fail, run, succeed, text};

/// Two points at distance 1, in 3D and in the plane, with the volumes 0.5.
fn write_points(folder: &Path) {
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    write(
        "solid.txt",
        "header: x y z block_id volume\n0 0 0 1 0.5\n1 0 0 1 0.5\n",
    );
    write(
        "plane.txt",
        "header: x y block_id volume\n0 0 1 0.5\n1 0 1 0.5\n",
    );
    write(
        "rows.txt",
        "# x y z block volume\n0 0 0 1 0.5\n1 0 0 1 0.5\n",
    );
    write("right.txt", "header: global_id\n2\n");
}

/// An input file of PeriLab: two points, the left one fixed, the right one pulled along x by the force density 6.
fn perilab(file: &str, symmetry: &str, model: &str) -> String {
    let fixed = |axis: &str, set: &str| {
        format!(
            "    {set} {axis}: {{Variable: Displacements, Node Set: {set}, Coordinate: {axis}, Value: 0, Type: Dirichlet}}\n"
        )
    };
    let third = if symmetry == "isotropic" {
        fixed("z", "Left") + &fixed("z", "Right")
    } else {
        String::new()
    };
    format!(
        "PeriLab:
  Discretization:
    Type: Text File
    Input Mesh File: {file}
    Node Sets: {{Left: 1, Right: right.txt}}
  Models:
    Material Models:
      Rubber:
        Material Model: {model}
        Symmetry: {symmetry}
        Young's Modulus: 2.4e+3
        Poisson's Ratio: 0.25
  Blocks:
    block_1: {{Block ID: 1, Density: 1000, Horizon: 1.2, Material Model: Rubber}}
  Boundary Conditions:
{}{}{}{third}    Load: {{Variable: Force Densities, Node Set: Right, Coordinate: x, Value: 6*t, Type: Neumann}}
  Solver:
    Initial Time: 0.0
    Final Time: 1.0
    Number of Steps: 1
    Static:
      m: 5
  Outputs:
    Output1:
      Output Filename: two
      Output Frequency: 1
      Output Variables: {{Displacements: True}}
",
        fixed("x", "Left"),
        fixed("y", "Left"),
        fixed("y", "Right"),
    )
}

/// The same in Peridigm's YAML; the force density is constant.
fn peridigm(model: &str) -> String {
    let fixed = |axis: &str, set: &str| {
        format!(
            "    {set} {axis}: {{Type: Prescribed Displacement, Node Set: {set} Node Set, Coordinate: {axis}, Value: '0.0'}}\n"
        )
    };
    let conditions: String = [
        ("x", "Left"),
        ("y", "Left"),
        ("z", "Left"),
        ("y", "Right"),
        ("z", "Right"),
    ]
    .map(|(axis, set)| fixed(axis, set))
    .concat();
    format!(
        "Peridigm:
  Discretization: {{Type: Text File, Input Mesh File: rows.txt}}
  Materials:
    Rubber: {{{model}, Density: 1000, Bulk Modulus: 1.6e+3}}
  Blocks:
    All: {{Block Names: block_1, Material: Rubber, Horizon: 1.2}}
  Boundary Conditions:
    Left Node Set: '1'
    Right Node Set: '2'
{conditions}    Load: {{Type: Body Force, Node Set: Right Node Set, Coordinate: x, Value: '6.0'}}
  Solver:
    Initial Time: 0.0
    Final Time: 1.0
    QuasiStatic: {{Number of Load Steps: 2, Absolute Tolerance: 1.0e-6}}
  Output: {{Output Filename: two, Output Frequency: 1, Output Variables: {{Displacement: true}}}}
"
    )
}

/// Imports an input file, checks and runs the deck, and returns the displacement of the right point along x.
fn pulled(input: &str) -> f64 {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    write_points(folder);
    fs::write(folder.join("two.yaml"), input).unwrap();
    succeed(folder, "import two.yaml");
    succeed(folder, "check two.toml");
    succeed(folder, "run two.toml --out two --quiet");
    let displacement = &last_fields(folder, "two", ["Displacement_x"])[0];
    assert_eq!((displacement.len(), displacement[0]), (2, 0.0));
    displacement[1]
}

/// Returns fields at the last output time of a run.
fn last_fields<const N: usize>(folder: &Path, run: &str, names: [&str; N]) -> [Vec<f64>; N] {
    succeed(folder, &format!("export {run} --to csv --out {run}-csv"));
    let files = fs::read_dir(folder.join(format!("{run}-csv"))).unwrap();
    let mut files: Vec<_> = files.map(|file| file.unwrap().path()).collect();
    files.sort();
    let last = read_csv(files.last().unwrap()).unwrap();
    names.map(|name| last.column(name).unwrap().to_vec())
}

#[track_caller]
fn assert_close(computed: f64, exact: f64) {
    assert!(
        (computed / exact - 1.0).abs() < 1e-6,
        "{computed:e}, exact {exact:e}"
    );
}

#[test]
fn imported_materials_have_the_stiffness_of_the_other_codes() {
    let (force, volume, youngs, horizon) = (6.0, 0.5, 2.4e3, 1.2f64);
    // The force density between two points is c s V with the stretch s and the bond constant c.
    let solid = pulled(&perilab("solid.txt", "isotropic", "Bond-based Elastic"));
    assert_close(
        solid,
        force / (12.0 * youngs / (PI * horizon.powi(4)) * volume),
    );
    let plane = pulled(&perilab(
        "plane.txt",
        "isotropic plane stress",
        "Bond-based Elastic",
    ));
    assert_close(
        plane,
        force / (9.0 * youngs / (PI * horizon.powi(3)) * volume),
    );
    let plane = pulled(&perilab(
        "plane.txt",
        "isotropic plane strain",
        "Bond-based Elastic",
    ));
    assert_close(
        plane,
        force / (48.0 * youngs / (5.0 * PI * horizon.powi(3)) * volume),
    );
    // Linear peridynamic solid: θ = 3 e/ξ, no deviatoric extension, so that the force density is 18 K e/ξ².
    let bulk = 1.6e3;
    let solid = pulled(&perilab("solid.txt", "isotropic", "PD Solid Elastic"));
    assert_close(solid, force / (18.0 * bulk));
    assert_close(
        pulled(&peridigm("Material Model: Elastic, Shear Modulus: 0.96e3")),
        force / (18.0 * bulk),
    );
    assert_close(
        pulled(&peridigm("Material Model: Elastic Bond Based")),
        force / (18.0 * bulk / (PI * horizon.powi(4)) * volume),
    );
    // In the plane 12 K/(π h δ³), with the thickness h = 0.5 that the volumes contain.
    for plane in ["Plane Stress", "Plane Strain"] {
        let model = format!("Material Model: Elastic Bond Based, {plane}: true, Height: 0.5");
        assert_close(
            pulled(&peridigm(&model)),
            force / (12.0 * bulk / (PI * 0.5 * horizon.powi(3)) * volume),
        );
    }
}

/// A notched bar in the plane with two blocks, in PeriLab's format.
const BAR: &str = "PeriLab:
  Discretization:
    Type: Text File
    Input Mesh File: points/bar.txt
    Node Sets:
      Left: 1:12
      Right: x > 0.017
    Bond Filters:
      notch:
        Type: Rectangular_Plane
        Normal X: 1.0
        Normal Y: 0.0
        Normal Z: 0.0
        Lower Left Corner X: 0.010
        Lower Left Corner Y: 0.0
        Lower Left Corner Z: 0.5
        Bottom Unit Vector X: 0.0
        Bottom Unit Vector Y: 1.0
        Bottom Unit Vector Z: 0.0
        Bottom Length: 0.002
        Side Length: 1.0
  Physics:
    Material Models:
      Glass:
        Material Model: PD Solid Elastic
        Symmetry: isotropic plane stress
        Young's Modulus: 72e9
        Poisson's Ratio: 0.2
    Damage Models:
      Stretch: {Damage Model: Critical Stretch, Critical Value: 2e-3}
  Blocks:
    block_1: {Density: 2440, Horizon: 3.01e-3, Material Model: Glass}
    block_2: {Density: 2440, Horizon: 3.01e-3, Material Model: Glass, Damage Model: Stretch}
  Boundary Conditions:
    hold: {Variable: Displacements, Node Set: Left, Coordinate: x, Value: 0, Type: Dirichlet}
    pull: {Variable: Displacements, Node Set: Right, Coordinate: x, Value: 4*t, Type: Dirichlet}
    start x: {Variable: Velocity, Node Set: Left + Left, Coordinate: x, Value: 0.5*y, Type: Initial}
    start y: {Variable: Velocity, Node Set: Left + Left, Coordinate: y, Value: 0.5, Type: Initial}
  Solver:
    Initial Time: 0.0
    Final Time: 2e-5
    Damage Models: true
    Verlet: {Safety Factor: 0.8}
  Outputs:
    Output1:
      Output Filename: bar
      Number of Output Steps: 4
      Output Variables: {Displacements: True, Velocity: True, Damage: True}
";

/// The same bar, written as a deck.
const DECK: &str = r#"
[body]
shape = "points"
file = "points/bar.txt"
dimension = 2
spacing = "1 mm"
plane = "stress"
[material]
model = "state-based"
youngs_modulus = "72 GPa"
poisson_ratio = 0.2
density = 2440
horizon = "3.01 mm"
volume_correction = "none"
influence = { function = "constant" }
[materials.weak]
youngs_modulus = "72 GPa"
poisson_ratio = 0.2
density = 2440
horizon = "3.01 mm"
critical_stretch = 2e-3
[[assign]]
set = "weak"
material = "weak"
[sets.weak]
block = 2
[sets.Left]
points = ["0-11"]
[sets.Right]
where = "x > 0.017"
[[crack]]
segment = [["10 mm", 0], ["10 mm", "2 mm"]]
[[constraint]]
set = "Left"
displacement = [0, "free"]
[[constraint]]
set = "Right"
displacement = [{ expression = "4*t" }, "free"]
[[initial]]
set = "Left"
velocity = [{ expression = "0.5*y" }, 0.5]
[time]
end = "20 us"
safety = 0.8
[output]
fields = { format = "exodus", count = 4, names = ["Displacement", "Velocity", "Damage"] }
"#;

fn with_bar() -> tempfile::TempDir {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    fs::create_dir(folder.join("points")).unwrap();
    let mut points = String::from("header: x y block_id volume\n");
    for k in 0..80 {
        let (i, j) = (k / 4, k % 4);
        let block = 1 + usize::from((6..14).contains(&i));
        points += &format!("{}e-3 {}e-3 {block} 1e-6\n", i as f64 + 0.5, j as f64 + 0.5);
    }
    fs::write(folder.join("points/bar.txt"), points).unwrap();
    fs::write(folder.join("bar.yaml"), BAR).unwrap();
    place
}

#[test]
fn an_imported_bar_breaks_like_the_deck_written_by_hand() {
    let place = with_bar();
    let folder = place.path();
    fs::write(folder.join("hand.toml"), DECK).unwrap();
    succeed(folder, "import bar.yaml");
    succeed(folder, "run bar.toml --out imported --quiet");
    succeed(folder, "run hand.toml --out hand --quiet");
    succeed(folder, "diff imported hand");
    let history = read_csv(folder.join("imported/history.csv")).unwrap();
    assert!(*history.column("broken_bonds").unwrap().last().unwrap() > 0.0);
}

#[test]
fn an_input_file_in_millimetres_and_megapascals_describes_the_same_bar() {
    let place = with_bar();
    let folder = place.path();
    succeed(folder, "import bar.yaml");
    succeed(folder, "run bar.toml --out metres --quiet");
    let points = fs::read_to_string(folder.join("points/bar.txt")).unwrap();
    let points = points.replace("1e-6", "1").replace("e-3", "");
    fs::write(folder.join("points/mm.txt"), points).unwrap();
    let mut input = BAR.to_owned();
    for (metres, millimetres) in [
        ("bar.txt", "mm.txt"),
        ("x > 0.017", "x > 17"),
        ("X: 0.010", "X: 10"),
        ("Length: 0.002", "Length: 2"),
        ("72e9", "72e3"),
        ("2440", "2440e-12"),
        ("3.01e-3", "3.01"),
        ("4*t", "4000*t"),
        ("Value: 0.5,", "Value: 500,"),
    ] {
        assert!(input.contains(metres), "{metres}");
        input = input.replace(metres, millimetres);
    }
    fs::write(folder.join("bar.yaml"), input).unwrap();
    succeed(folder, "import bar.yaml --force --units mm,MPa,s");
    succeed(folder, "run bar.toml --out millimetres --quiet");
    let fields = [
        "Displacement_x",
        "Displacement_y",
        "Velocity_x",
        "Velocity_y",
        "Damage",
    ];
    let [metres, millimetres] =
        ["metres", "millimetres"].map(|run| last_fields(folder, run, fields));
    for (name, (a, b)) in fields.iter().zip(metres.iter().zip(&millimetres)) {
        let size = a.iter().fold(0.0f64, |size, x| size.max(x.abs()));
        assert!(
            size > 0.0 && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9 * size),
            "{name}"
        );
    }
    let (status, message) = fail(folder, "import bar.yaml --units mm,s");
    assert!(
        status == 2 && message.contains("such as mm,MPa,s"),
        "{message}"
    );
}

#[test]
fn the_parameter_lists_of_all_formats_of_peridigm_give_the_same_deck() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    write_points(folder);
    let yaml = "Peridigm:
  Discretization:
    Type: Text File
    Input Mesh File: rows.txt
  Materials:
    Glass:
      Material Model: Elastic
      Density: 2440
      Bulk Modulus: 40e9
      Shear Modulus: 30e9
  Blocks:
    All:
      Block Names: block_1
      Material: Glass
      Horizon: 3
  Solver:
    Final Time: 1e-4
    Verlet:
      Fixed dt: 1e-6
";
    let mut xml = String::from("<ParameterList>\n");
    let mut plain = String::from("# Units are SI\n");
    let mut open = 0;
    for line in yaml.lines().skip(1) {
        let depth = (line.len() - line.trim_start().len()) / 2 - 1;
        while open > depth {
            xml += "</ParameterList>\n";
            open -= 1;
        }
        let (key, value) = line.trim().split_once(':').unwrap();
        let quote = if value.trim().parse::<f64>().is_err() && !value.is_empty() {
            "\""
        } else {
            ""
        };
        plain += &format!(
            "{}{key} {quote}{}{quote}\n",
            "  ".repeat(depth),
            value.trim()
        );
        if value.is_empty() {
            xml += &format!("<ParameterList name=\"{key}\">\n");
            open += 1;
        } else {
            xml += &format!(
                "<Parameter name=\"{key}\" type=\"string\" value=\"{}\"/>\n",
                value.trim()
            );
        }
    }
    xml += &"</ParameterList>\n".repeat(open + 1);
    fs::write(folder.join("glass.yaml"), yaml).unwrap();
    fs::write(folder.join("glass.xml"), xml).unwrap();
    fs::write(folder.join("glass.peridigm"), plain).unwrap();
    let keys = |file: &str| {
        let deck = text(&succeed(folder, &format!("import {file} --out -")).stdout);
        let keys = deck
            .lines()
            .filter(|line| !line.starts_with('#'))
            .collect::<Vec<_>>();
        keys.join("\n")
    };
    let deck = keys("glass.yaml");
    assert!(deck.contains("bulk_modulus = 4e10"), "{deck}");
    assert_eq!(deck, keys("glass.xml"));
    assert_eq!(deck, keys("glass.peridigm"));
}

#[test]
fn every_entry_without_translation_is_reported_with_its_line() {
    let place = with_bar();
    let folder = place.path();
    // An unknown entry after each line that begins a group, and on the level of the other entries of the group.
    let mut input = String::new();
    let mut expected = Vec::new();
    for (line, text) in BAR.lines().zip(BAR.lines().skip(1).chain([""])) {
        let is_inline = line.contains('{') && !line.contains("Output Variables");
        input += &line.replacen('{', if is_inline { "{Mystery: 7, " } else { "{" }, 1);
        input += "\n";
        if is_inline {
            expected.push(input.lines().count());
        }
        if line.ends_with(':') && !line.ends_with("Node Sets:") {
            let blanks = text.len() - text.trim_start().len();
            let in_list = [
                "Material Models:",
                "Damage Models:",
                "Blocks:",
                "Conditions:",
                "Filters:",
                "Outputs:",
            ];
            // Entries of lists of named groups are groups.
            if !in_list.iter().any(|list| line.ends_with(list)) {
                input += &format!("{}Mystery: 7\n", " ".repeat(blanks));
                expected.push(input.lines().count());
            }
        }
    }
    assert!(expected.len() > 14, "{input}");
    fs::write(folder.join("bar.yaml"), &input).unwrap();
    let output = succeed(folder, "import bar.yaml");
    let errors = text(&output.stderr);
    let deck = fs::read_to_string(folder.join("bar.toml")).unwrap();
    for line in expected {
        let listed = |text: &str, start: &str| {
            text.lines()
                .any(|l| l.starts_with(start) && l.contains("Mystery = 7"))
        };
        assert!(
            listed(&errors, &format!("bar.yaml:{line}: not translated: ")),
            "{line}\n{errors}"
        );
        assert!(
            listed(&deck, &format!("#   line {line}: ")),
            "{line}\n{deck}"
        );
    }
}

#[test]
fn only_initial_conditions_of_overlapping_sets_are_reported_as_different() {
    let place = with_bar();
    let folder = place.path();
    let reported = |second: &str| {
        let input = BAR.replace("Right: x > 0.017", &format!("Right: {second}"));
        let input = input.replace(
            "  Solver:",
            "    other: {Variable: Velocity, Node Set: Right, Coordinate: x, Value: 1, Type: Initial}\n  Solver:",
        );
        fs::write(folder.join("bar.yaml"), input).unwrap();
        let errors = text(&succeed(folder, "import bar.yaml --force").stderr);
        errors.contains("where sets of initial conditions overlap")
    };
    assert!(!reported("13:20"));
    assert!(reported("12:20"));
    assert!(reported("x > 0.017"));
}

#[test]
fn wrong_input_files_are_rejected_with_file_and_line() {
    let place = with_bar();
    let folder = place.path();
    let changed = |old: &str, new: &str| {
        assert!(BAR.contains(old), "{old}");
        BAR.replacen(old, new, 1)
    };
    let line = |word: &str| 1 + BAR.lines().position(|line| line.contains(word)).unwrap();
    let cases = [
        (
            changed("Type: Text File", "Type: [Text File"),
            0,
            "not valid YAML",
        ),
        (
            changed("  Blocks:", "  Blacks:"),
            1,
            "the entry `Blocks` is missing",
        ),
        (
            changed("Model: PD Solid Elastic", "Model: Magic"),
            line("PD Solid"),
            "`Magic` has no counterpart in Pericles; translated are: Bond-based Elastic",
        ),
        (
            changed("72e9", "72 GPa"),
            line("72e9"),
            "`72 GPa` is not a number",
        ),
        (
            changed("Critical Value: 2e-3", "Critical Value: -2e-3"),
            line("Critical Value"),
            "allowed: a positive number",
        ),
        (
            changed("Node Set: Right,", "Node Set: Wrong,"),
            line("pull:"),
            "`Wrong` is not a node set; defined are: Left, Right",
        ),
        (
            changed("Left: 1:12", "Left: nodes.txt"),
            line("Left: 1:12"),
            "the file cannot be read",
        ),
        (
            changed("Left: 1:12", "Left: 0:12"),
            line("Left: 1:12"),
            "points are counted from 1",
        ),
        (
            changed("Material Model: Glass}", "Material Model: Clay}"),
            line("block_1:"),
            "`Clay` is not defined; PeriLab/Physics/Material Models has: Glass",
        ),
        (
            changed("Coordinate: x, Value: 0,", "Coordinate: u, Value: 0,"),
            line("hold:"),
            "allowed: x, y or z",
        ),
        (
            changed("Final Time: 2e-5", "Final Time: 0"),
            line("Final Time"),
            "after the initial time",
        ),
        (
            changed("    Verlet:", "    Euler:"),
            line("Solver:"),
            "no known solver",
        ),
        (
            "<ParameterList>\n<Parameter name=\"x\"/>".into(),
            1,
            "not valid XML",
        ),
        (
            "<ParameterList>\n<List name=\"x\"/>\n</ParameterList>".into(),
            2,
            "unknown element <List>",
        ),
        (
            "body:\n  shape: bar\n".into(),
            1,
            "no input file of PeriLab",
        ),
        (String::new(), 1, "the file is empty"),
    ];
    for (input, line, expected) in cases {
        fs::write(folder.join("bar.yaml"), &input).unwrap();
        let (status, message) = fail(folder, "import bar.yaml");
        assert_eq!(status, 3, "{message}");
        let place = if line == 0 {
            "error: bar.yaml:".to_owned()
        } else {
            format!("error: bar.yaml:{line}: ")
        };
        assert!(
            message.starts_with(&place) && message.contains(expected),
            "{expected}\n{message}"
        );
        assert!(!folder.join("bar.toml").exists());
    }
    assert_eq!(fail(folder, "import missing.yaml").0, 3);
}

#[test]
fn decks_are_replaced_on_request_only_and_find_their_points_from_another_folder() {
    let place = with_bar();
    let folder = place.path();
    succeed(folder, "import bar.yaml");
    let (status, message) = fail(folder, "import bar.yaml");
    assert!(status == 6 && message.contains("--force"), "{message}");
    succeed(folder, "import bar.yaml --force");
    fs::create_dir(folder.join("decks")).unwrap();
    succeed(folder, "import bar.yaml -o decks/other.toml");
    succeed(folder, "check decks/other.toml");
    succeed(&folder.join("points"), "import ../bar.yaml -o -");
}

#[test]
fn decks_with_errors_are_written_and_their_errors_are_listed() {
    let place = with_bar();
    let folder = place.path();
    // In the plane PeriLab's symmetry must name plane stress or plane strain.
    fs::write(
        folder.join("bar.yaml"),
        BAR.replace("isotropic plane stress", "isotropic"),
    )
    .unwrap();
    let output = run(folder, "import bar.yaml");
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{message}");
    assert!(
        message.contains("bar.toml:") && message.contains("plane"),
        "{message}"
    );
    assert!(folder.join("bar.toml").exists());
}
