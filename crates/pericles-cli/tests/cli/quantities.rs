//! Derived quantities: `[[output.quantity]]`, their table, charts and stop conditions.

use std::fs;
use std::path::Path;

use pericles_io::{CsvData, read_csv};

use crate::common::{assert_same_results, fail, pericles, report, succeed, text, with_plate};

/// Two probes at the notch mouth, quantities of all kinds of columns, and a table of crack tips with the same rows.
const MORE: &str = r#"
[[probe]]
name = "upper lip"
at = ["0.5 mm", "7.5 mm"]
[[probe]]
name = "lower"
at = ["0.5 mm", "4.5 mm"]
[[output.quantity]]
name = "CMOD"
expression = "'upper lip'.u_y - lower.u_y"
[[output.quantity]]
name = "stiffness"
expression = "(reaction.top.y - bottom_y)/2/CMOD"
[[output.quantity]]
name = "released"
expression = "dissipated_energy/(abs(crack_1_advance) + 1e-6)"
unit = "J/m"
[[output.quantity]]
name = "odd"
expression = "CMOD + kinetic_energy"
unit = "mixed"
"#;

fn write_deck(place: &Path) {
    let deck = fs::read_to_string(place.join("plate.toml")).unwrap();
    let deck = deck.replace("cracks = { every = 10 }", "cracks = { every = 7 }");
    let deck = deck + MORE;
    fs::write(place.join("plate.toml"), deck).unwrap();
}

fn table(folder: &Path, name: &str) -> CsvData {
    read_csv(folder.join(name)).unwrap()
}

#[test]
fn quantities_are_the_values_of_their_expressions() {
    let place = with_plate();
    write_deck(place.path());
    succeed(place.path(), "run plate.toml --quiet --out a");
    let folder = place.path().join("a");
    let header = fs::read_to_string(folder.join("quantities.csv")).unwrap();
    let header = header.lines().next().unwrap();
    assert_eq!(
        header,
        "step,time [s],CMOD [m],stiffness [Pa],released [J/m],odd [mixed]"
    );
    let [quantities, probes, reactions, history, cracks] =
        ["quantities", "probes", "reactions", "history", "cracks"]
            .map(|name| table(&folder, &format!("{name}.csv")));
    let column = |table: &CsvData, name: &str| table.column(name).unwrap().to_vec();
    assert_eq!(column(&quantities, "time"), column(&history, "time"));
    let (upper, lower) = (
        column(&probes, "upper lip_u_y"),
        column(&probes, "lower_u_y"),
    );
    let (top, bottom) = (column(&reactions, "top_y"), column(&reactions, "bottom_y"));
    let (dissipated, kinetic) = (
        column(&history, "dissipated_energy"),
        column(&history, "kinetic_energy"),
    );
    let advance = column(&cracks, "advance");
    assert!(advance.last().unwrap() > &0.0, "the crack does not grow");
    for row in 0..quantities.rows() {
        let value = |name: &str| column(&quantities, name)[row];
        let opening = upper[row] - lower[row];
        assert_eq!(value("CMOD"), opening);
        let stiffness = (top[row] - bottom[row]) / 2.0 / opening;
        // Empty cells are NaN.
        assert!(value("stiffness") == stiffness || stiffness.is_nan());
        assert_eq!(
            value("released"),
            dissipated[row] / (advance[row].abs() + 1e-6)
        );
        assert_eq!(value("odd"), opening + kinetic[row]);
    }
    let said = succeed(
        place.path(),
        "plot a --x CMOD --y reaction.top.y,stiffness --format svg",
    );
    assert_eq!(
        text(&said.stdout),
        "a/plots/top_y-stiffness-over-CMOD.svg\n"
    );
    assert!(said.stderr.is_empty(), "{}", text(&said.stderr));
}

#[test]
fn a_resumed_run_writes_the_same_quantities_and_stops_at_the_same_step() {
    let place = with_plate();
    write_deck(place.path());
    let line = "run plate.toml --quiet --set output.cracks.every=5 \
                --set time.stop_when=[{condition='CMOD>2e-4&&crack_1_advance>1e-3||time>39e-6'}] --set checkpoint.every=40";
    succeed(place.path(), &format!("{line} --out whole"));
    succeed(place.path(), &format!("{line} --threads 1 --out begun"));
    let [whole, begun] = ["whole", "begun"].map(|name| place.path().join(name));
    let before = report(&whole);
    let last = before["progress"]["last_step"].as_u64().unwrap();
    assert!((41..390).contains(&last), "{last}");
    let reason = before["stop_reason"].as_str().unwrap();
    assert!(
        reason.starts_with(
            "the condition `CMOD>2e-4&&crack_1_advance>1e-3||time>39e-6` holds: CMOD = 200 µm"
        ),
        "{reason}"
    );
    let opening = table(&whole, "quantities.csv")
        .column("CMOD")
        .unwrap()
        .to_vec();
    let [earlier, end] = opening[opening.len() - 2..] else {
        unreachable!()
    };
    assert!(earlier < 2e-4 && end > 2e-4, "{earlier} {end}");
    // As if the run had been killed after the first checkpoint.
    for entry in fs::read_dir(begun.join("checkpoints")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        if name[5..].parse::<u64>().unwrap() + 1 > last {
            fs::remove_file(path).unwrap();
        }
    }
    let json = fs::read_to_string(begun.join("run.json")).unwrap();
    let json = json.replace("\"finished\"", "\"running\"");
    fs::write(begun.join("run.json"), json).unwrap();
    succeed(place.path(), "resume begun");
    assert_eq!(report(&begun)["stop_reason"], reason);
    assert_same_results(&whole, &begun);
}

#[test]
fn sweeps_and_convergence_studies_have_quantities() {
    let place = with_plate();
    write_deck(place.path());
    let line = "run plate.toml --quiet --set time.end=2e-6 --sweep material.density=2000,3000";
    succeed(place.path(), line);
    let summary = fs::read_to_string(place.path().join("plate-sweep/summary.csv")).unwrap();
    let header = summary.lines().next().unwrap();
    assert!(
        header.ends_with("CMOD [m],stiffness [Pa],released [J/m],odd [mixed]"),
        "{header}"
    );
    let last = table(
        &place.path().join("plate-sweep/density=2000"),
        "quantities.csv",
    );
    let opening = last.column("CMOD").unwrap().last().unwrap();
    assert!(summary.contains(&format!(",{opening:?},")), "{summary}");
    let line =
        "converge plate.toml --set time.end=1e-6 --m 2 --dx 2e-3,1e-3 --scalar max:CMOD --out c";
    let said = text(&succeed(place.path(), line).stdout);
    assert!(said.contains("CMOD"), "{said}");
}

#[test]
fn errors_of_quantities_are_explained() {
    let place = with_plate();
    write_deck(place.path());
    let deck = fs::read_to_string(place.path().join("plate.toml")).unwrap();
    for (replace, by, says) in [
        (
            "'upper lip'.u_y - lower.u_y",
            "'upper lip_u_y' - lowr_u_y",
            &["unknown column `lowr_u_y`", "did you mean `lower_u_y`"][..],
        ),
        (
            "'upper lip'.u_y - lower.u_y",
            "'upper lip'.u_y - top_y",
            &[
                "its unit cannot be derived: it adds values in m and N/m",
                "unit = \"N/m\"",
            ],
        ),
        (
            "'upper lip'.u_y - lower.u_y\"",
            "lower.u_y\"\nunit = \"mm\"",
            &["`mm` is out of range", "the SI unit of the expression, m"],
        ),
        (
            "name = \"CMOD\"",
            "name = \"kinetic_energy\"",
            &[
                "the name `kinetic_energy` cannot be used",
                "a column of another table has it",
            ],
        ),
        (
            "name = \"CMOD\"",
            "name = \"sin\"",
            &["it has another meaning in expressions"],
        ),
        (
            "name = \"stiffness\"",
            "name = \"CMOD\"",
            &["another quantity has this name"],
        ),
        (
            "'upper lip'.u_y - lower.u_y",
            "upper lip_u_y - lower.u_y",
            &[
                "an operator is missing before `lip_u_y`",
                "in single quotes",
            ],
        ),
        (
            "[time]",
            "[[time.stop_when]]\ncondition = \"CMOD > top_y\"\n[time]",
            &["the condition `CMOD > top_y` cannot be used: it compares m with N/m"],
        ),
        (
            "[time]",
            "[[time.stop_when]]\ncondition = \"CMID > 1e-4\"\n[time]",
            &["unknown column `CMID`", "did you mean `CMOD`"],
        ),
        (
            "[time]",
            "[[time.stop_when]]\ncondition = \"CMOD\"\n[time]",
            &["`CMOD` is not a comparison", "such as condition = "],
        ),
        (
            "[time]",
            "[[time.stop_when]]\nset = \"top\"\ncondition = \"CMOD > 1\"\n[time]",
            &[
                "`set` is not allowed",
                "`condition` refers to columns of the tables",
            ],
        ),
    ] {
        assert!(deck.contains(replace), "{replace}");
        fs::write(
            place.path().join("wrong.toml"),
            deck.replacen(replace, by, 1),
        )
        .unwrap();
        let (status, message) = fail(place.path(), "check wrong.toml");
        assert_eq!(status, 3, "{message}");
        let plain = message.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(plain.contains("wrong.toml:"), "{message}");
        for part in says {
            assert!(plain.contains(part), "{part}: {message}");
        }
    }
}

/// The plate has no thickness: its forces are per metre, which are those of a plate 1 m thick.
#[test]
fn forces_of_a_plate_without_thickness_compare_with_both_units() {
    let place = with_plate();
    write_deck(place.path());
    let status = |force: &str| {
        let stop = format!("time.stop_when=[{{condition=\"top_y > '{force}'\"}}]");
        let mut command = pericles(place.path());
        let output = command
            .args(["check", "plate.toml", "--set", &stop])
            .output();
        output.unwrap().status.code()
    };
    assert_eq!(status("3 kN/m"), Some(0));
    assert_eq!(status("3 kN"), Some(0));
    assert_eq!(status("3 m"), Some(3));
}
