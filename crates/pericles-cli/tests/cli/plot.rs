//! The commands `plot`, `schema` and `converge`.

use std::fs;

use crate::common::{fail, succeed, text, with_plate};

#[test]
fn plot_reproduces_the_pictures_of_the_run_bitwise() {
    let place = with_plate();
    // Field files and pictures are written at the same times.
    let line = "run plate.toml --quiet --set output.fields.every=150 --set output.picture.0.every=150 --out a";
    succeed(place.path(), line);
    succeed(place.path(), "plot a --field Damage,Velocity_y --time all");
    for field in ["Damage", "Velocity_y"] {
        for number in 0..4 {
            let name = format!("{field}-{number:06}.png");
            let [own, again] = ["pictures", "plots"]
                .map(|folder| fs::read(place.path().join("a").join(folder).join(&name)).unwrap());
            assert!(own == again, "{name}");
        }
    }
    // The states of pictures are kept until the range of the series is known.
    let names = fs::read_dir(place.path().join("a/pictures")).unwrap();
    let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert!(names.into_iter().all(|name| name.ends_with(".png")));
}

/// A strip of a mesh with a pre-crack that opens under the displacement of its halves.
const STRIP: &str = r#"
[body]
shape = "mesh"
file = "strip.inp"
unit = "mm"
dimension = 2
thickness = "1 mm"
plane = "stress"
[material]
youngs_modulus = "72 GPa"
density = 2440
horizon = "3.1 mm"
fracture_energy = "10 J/m2"
[[crack]]
segment = [["0 mm", "4 mm"], ["6 mm", "4 mm"]]
[sets]
top = { where = "y > 0.006" }
bottom = { where = "y < 0.002" }
[[constraint]]
set = "top"
velocity = ["free", "5 m/s"]
[[constraint]]
set = "bottom"
velocity = ["free", "-5 m/s"]
[time]
end = "6 us"
[output]
fields = { count = 2 }
[[output.picture]]
field = "Damage"
scale = 20
edges = true
count = 2
"#;

#[test]
fn pictures_of_a_mesh_are_the_same_during_the_run_and_after_it() {
    let place = tempfile::tempdir().unwrap();
    let (columns, rows) = (12, 8);
    let mut mesh = "*NODE\n".to_owned();
    let node = |i: usize, j: usize| j * (columns + 1) + i + 1;
    for (i, j) in (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j))) {
        mesh += &format!("{}, {i}, {j}\n", node(i, j));
    }
    mesh += "*ELEMENT, TYPE=CPS4, ELSET=strip\n";
    for (k, (i, j)) in (0..rows)
        .flat_map(|j| (0..columns).map(move |i| (i, j)))
        .enumerate()
    {
        let corners = [
            node(i, j),
            node(i + 1, j),
            node(i + 1, j + 1),
            node(i, j + 1),
        ];
        let [a, b, c, d] = corners;
        mesh += &format!("{}, {a}, {b}, {c}, {d}\n", k + 1);
    }
    fs::write(place.path().join("strip.inp"), mesh).unwrap();
    fs::write(place.path().join("strip.toml"), STRIP).unwrap();
    succeed(place.path(), "run strip.toml --quiet --out a");
    succeed(place.path(), "plot a --time all --out b");
    for number in 0..3 {
        let name = format!("Damage-{number:06}.png");
        let [own, again] = ["a/pictures", "b"]
            .map(|folder| fs::read(place.path().join(folder).join(&name)).unwrap());
        assert!(own == again, "{name}");
    }
    // Edges and another scale change the picture.
    succeed(
        place.path(),
        "plot a --time last --scale 10 --edges --out c",
    );
    let [own, other] = ["b", "c"]
        .map(|folder| fs::read(place.path().join(folder).join("Damage-000002.png")).unwrap());
    assert!(own != other);
}

#[test]
fn other_picture_formats_and_terminal_plots_are_available() {
    let place = with_plate();
    succeed(place.path(), "run plate.toml --quiet --out a");
    let said = succeed(place.path(), "plot a --format svg --out b");
    let names = text(&said.stdout);
    for name in ["b/Damage-000005.svg", "b/history-energy.svg"] {
        assert!(names.contains(name), "{names}");
        let svg = fs::read_to_string(place.path().join(name)).unwrap();
        assert!(
            svg.starts_with("<svg ") && svg.ends_with("</svg>\n"),
            "{name}"
        );
    }
    let line = "plot a --field Damage --width 88mm --font-size 7pt --dpi 200 --no-title --background transparent \
                --colour-map grey --crop 0mm:12mm,0mm:12mm --format pdf --out d";
    let names = text(&succeed(place.path(), line).stdout);
    let pdf = fs::read(place.path().join(names.trim_end())).unwrap();
    assert!(pdf.starts_with(b"%PDF-1.7"));
    for (line, says) in [
        ("plot a --font-size 8pt", "require a width on paper"),
        ("plot a --width 1mm", "the width is 1.0 mm"),
        (
            "plot a --width 88",
            "expected a number of pixels from 200 to 16000",
        ),
        (
            "plot a --field Damage --crop 0mm:1mm",
            "--crop has 1 range(s); the body has 2",
        ),
    ] {
        let (status, message) = fail(place.path(), line);
        assert_eq!(status, 2, "{message}");
        assert!(message.contains(says), "{says}: {message}");
    }
    let line = "plot a --field Displacement --animation --width 400 --range 0:1e-4 --out c";
    let names = text(&succeed(place.path(), line).stdout);
    assert!(names.contains("Displacement.apng"), "{names}");
    let shown = succeed(
        place.path(),
        "plot a --history kinetic_energy,elastic_energy --terminal",
    );
    let shown = text(&shown.stdout);
    assert!(
        shown.starts_with("energy: * kinetic energy  + elastic energy"),
        "{shown}"
    );
    let (status, message) = fail(place.path(), "plot a --field Velocity_z");
    assert_eq!(status, 2);
    assert!(message.contains("did you mean Velocity"), "{message}");
    let (status, message) = fail(place.path(), "plot a --history energie");
    assert_eq!(status, 2);
    assert!(message.contains("kinetic_energy"), "{message}");
}

#[test]
fn pictures_of_a_run_have_the_format_and_size_of_the_deck() {
    let place = with_plate();
    let deck = fs::read_to_string(place.path().join("plate.toml")).unwrap();
    let look = "count = 2\nformat = \"svg\"\nwidth = \"88 mm\"\nfont_size = \"8 pt\"\ndpi = 600\ntitle = false\n";
    let deck = deck.replacen("count = 2\n", look, 1);
    fs::write(place.path().join("plate.toml"), &deck).unwrap();
    let line = "run plate.toml --quiet --set time.end=4e-6 --set output.fields.every=20 --out a";
    succeed(place.path(), line);
    let svg = fs::read_to_string(place.path().join("a/pictures/Damage-000002.svg")).unwrap();
    assert!(
        svg.contains("width=\"88.01mm\"") && !svg.contains(">Torn plate<"),
        "{svg}"
    );
    // The pictures of a finished run have the same style.
    succeed(place.path(), "plot a --field Damage --format svg --out b");
    let again = fs::read_to_string(place.path().join("b/Damage-000002.svg")).unwrap();
    assert!(again == svg);
    for (old, new, says) in [
        ("width = \"88 mm\"\n", "", "it requires `width`"),
        (
            "\"88 mm\"",
            "\"5 mm\"",
            "8.5 mm to 677 mm at 600 pixels per inch",
        ),
        ("\"8 pt\"", "\"80 pt\"", "from \"4 pt\" to \"24 pt\""),
        (
            "title = false",
            "animation = true",
            "an animation consists of PNG files",
        ),
        (
            "title = false",
            "crop = { min = [0, 1], max = [1, 1] }",
            "above the lower corner",
        ),
        ("title = false", "colour_map = \"jet\"", "\"cool-to-warm\""),
    ] {
        fs::write(place.path().join("wrong.toml"), deck.replacen(old, new, 1)).unwrap();
        let (status, message) = fail(place.path(), "check wrong.toml");
        assert_eq!(status, 3, "{message}");
        assert!(
            message.contains("wrong.toml:") && message.contains(says),
            "{says}: {message}"
        );
    }
}

#[test]
fn the_schema_is_printed_as_json_and_markdown() {
    let place = with_plate();
    let schema = succeed(place.path(), "schema").stdout;
    let schema: serde_json::Value = serde_json::from_slice(&schema).unwrap();
    // Pieces have the keys of the body.
    assert_eq!(schema["properties"]["body"]["$ref"], "#/$defs/body");
    assert_eq!(schema["$defs"]["body"]["additionalProperties"], false);
    let page = text(&succeed(place.path(), "schema --markdown").stdout);
    assert!(page.starts_with("# Deck reference") && page.contains("### [[body.refine]]"));
}

#[test]
fn a_run_shows_terminal_plots_at_its_end() {
    let place = with_plate();
    let said = text(&succeed(place.path(), "run plate.toml --chart --out a").stdout);
    let [before, after] =
        ["Results in a", "energy: * kinetic energy"].map(|words| said.find(words));
    assert!(before.is_some() && before < after, "{said}");
    let said = text(&succeed(place.path(), "run plate.toml --out b").stdout);
    assert!(!said.contains("* kinetic energy"), "{said}");
}

#[test]
fn fields_not_written_are_distinguished_from_unknown_fields() {
    let place = with_plate();
    succeed(place.path(), "run plate.toml --quiet --out a");
    let (status, message) = fail(place.path(), "plot a --field Strain_xx");
    assert_eq!(status, 2);
    assert!(message.contains("output.fields"), "{message}");
}

/// A bar in tension; the displacement of its end is σ L/E up to surface effects.
const BAR: &str = r#"
[body]
shape = "bar"
length = 1
spacing = 0.05
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 2
[sets.left]
layer = { side = "-x", cells = 2 }
[sets.right]
layer = { side = "+x", cells = 1 }
[[constraint]]
set = "left"
displacement = 0
[[load]]
set = "right"
traction = 1e-3
[[probe]]
name = "tip"
set = "right"
[time]
scheme = "adaptive-dynamic-relaxation"
tolerance = 1e-9
"#;

#[test]
fn a_bar_in_tension_converges_with_its_horizon() {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("bar.toml"), BAR).unwrap();
    let line =
        "converge bar.toml --m 2,3 --dx 0.1,0.05,0.025 --scalar tip_u_x --reference 1e-3 --quiet";
    let said = text(&succeed(place.path(), line).stdout);
    assert!(
        said.contains("m = 2\n") && said.contains("m = 3\n"),
        "{said}"
    );
    let table = fs::read_to_string(place.path().join("bar-converge/convergence.csv")).unwrap();
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| {
            line.split(',')
                .map(|cell| cell.parse().unwrap_or(f64::NAN))
                .collect()
        })
        .collect();
    assert_eq!(rows.len(), 6, "{table}");
    for family in rows.chunks(3) {
        let distances: Vec<f64> = family.iter().map(|row| row[4].abs()).collect();
        assert!(
            distances[2] < distances[1] && distances[1] < distances[0],
            "{table}"
        );
        // Errors at the ends are proportional to the horizon: first order.
        let order = family[2][5];
        assert!((0.8..1.3).contains(&order), "{order} {table}");
    }
    assert!(place.path().join("bar-converge/convergence.png").is_file());
    let line =
        "converge bar.toml --m 2,4 --horizon 0.2 --scalar audit.elastic_energy --quiet --out fixed";
    let said = text(&succeed(place.path(), line).stdout);
    assert!(said.contains("δ = 200 mm"), "{said}");
    let (status, message) = fail(
        place.path(),
        "converge bar.toml --m 2 --dx 0.1 --scalar tip_u --quiet",
    );
    assert_eq!(status, 2);
    assert!(message.contains("did you mean tip_u_x"), "{message}");
}

#[test]
fn columns_are_drawn_over_another_column() {
    let place = with_plate();
    succeed(
        place.path(),
        "run plate.toml --quiet --set time.end=4e-6 --out a",
    );
    let line = "plot a --x corner_u_y --y corner_v_x,corner_v_y --format svg";
    let said = text(&succeed(place.path(), line).stdout);
    assert_eq!(said, "a/plots/corner_v_x-corner_v_y-over-corner_u_y.svg\n");
    let svg = fs::read_to_string(place.path().join(said.trim_end())).unwrap();
    assert!(svg.contains("corner v y"), "{svg}");
    // Columns of different tables with the same schedule.
    let said = succeed(place.path(), "plot a --x top_y --y kinetic_energy");
    assert!(said.stderr.is_empty(), "{}", text(&said.stderr));
    // The table of crack tips has other times than the history; equal ones are drawn.
    let said = succeed(place.path(), "plot a --x advance --y kinetic_energy");
    let note = text(&said.stderr);
    assert!(
        note.contains("cracks.csv has 5 rows") && note.contains("rows with equal times"),
        "{note}"
    );
    let (status, message) = fail(place.path(), "plot a --y corner_v_w");
    assert_eq!(status, 2);
    assert!(message.contains("corner_v_"), "{message}");
}

#[test]
fn sweeps_have_charts_contents_and_reports() {
    let place = with_plate();
    let line = "run plate.toml --quiet --set time.end=1e-6 --sweep material.horizon_ratio=2,3 --sweep material.density=2000,3000";
    succeed(place.path(), line);
    let said = text(&succeed(place.path(), "info plate-sweep").stdout);
    for words in [
        "parameter sweep of plate.toml",
        "material.horizon_ratio = 2, 3",
        "4 of 4 finished",
        "corner_u_x [m]",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let line = "plot plate-sweep --y max:kinetic_energy --format svg";
    let said = text(&succeed(place.path(), line).stdout);
    assert_eq!(said, "plate-sweep/plots/max_kinetic_energy.svg\n");
    let svg = fs::read_to_string(place.path().join(said.trim_end())).unwrap();
    for words in ["material.horizon_ratio", "density = 2000", "density = 3000"] {
        assert!(svg.contains(words), "{words}");
    }
    let line = "plot plate-sweep --x density --y audit.external_work --format svg --out b";
    let svg = text(&succeed(place.path(), line).stdout);
    let svg = fs::read_to_string(place.path().join(svg.trim_end())).unwrap();
    for words in [
        "material.density [",
        "kg/m3]",
        ">external work [",
        "J/m]",
        "horizon_ratio = 3",
    ] {
        assert!(svg.contains(words), "{words}: {svg}");
    }
    succeed(place.path(), "report plate-sweep");
    let page = fs::read_to_string(place.path().join("plate-sweep/report.html")).unwrap();
    for words in [
        "<h1>Parameter sweep of plate.toml</h1>",
        "<th>status</th>",
        "<h2 id=\"Charts\">",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let (status, message) = fail(
        place.path(),
        "plot plate-sweep --x spacing --y audit.balance",
    );
    assert_eq!(status, 2, "{message}");
    assert!(message.contains("material.density"), "{message}");
}

#[test]
fn charts_of_static_runs_are_over_the_load() {
    let place = with_plate();
    let bar = "[body]\nshape = 'bar'\nlength = 1\nspacing = 0.05\n[material]\ndensity = 1\nyoungs_modulus = 1\nhorizon_ratio = 3\nfracture_energy = 1\n\
               [sets.left]\nlayer = { side = '-x', cells = 3 }\n[sets.right]\nlayer = { side = '+x', cells = 3 }\n\
               [[constraint]]\nset = 'left'\ndisplacement = [0]\n[[constraint]]\nset = 'right'\ndisplacement = [1e-3]\n\
               [time]\nscheme = 'static'\nload_steps = 4\nend = 3\n[output]\nhistory = { every = 1 }\n";
    fs::write(place.path().join("bar.toml"), bar).unwrap();
    for (changes, name, last) in [
        ("--out a", "load factor", "load factor 1"),
        (
            "--set time.breaking=event --out b",
            "load step",
            "load step 4",
        ),
    ] {
        succeed(place.path(), &format!("run bar.toml --quiet {changes}"));
        let folder = changes.rsplit(' ').next().unwrap();
        let line = format!("plot {folder} --y right_x --format svg --out plots");
        let svg = text(&succeed(place.path(), &line).stdout);
        let svg = fs::read_to_string(place.path().join(svg.trim_end())).unwrap();
        assert!(
            svg.contains(&format!(">{name}<")) && !svg.contains("time ["),
            "{svg}"
        );
        let shown = text(&succeed(place.path(), &format!("plot {folder} --terminal")).stdout);
        assert!(shown.contains(last), "{shown}");
        let said = text(&succeed(place.path(), &format!("info {folder}")).stdout);
        assert!(said.contains(&format!("step 4 of 4, {last}")), "{said}");
    }
}

#[test]
fn the_time_step_converges_with_the_order_of_the_scheme() {
    let place = tempfile::tempdir().unwrap();
    let bar = "[body]\nshape = 'bar'\nlength = 1\nspacing = 0.05\n[material]\ndensity = 1\nyoungs_modulus = 1\nhorizon_ratio = 2\n[[initial]]\nvelocity = [{ expression = 'sin(pi*x)' }]\n[[probe]]\nname = 'end'\nat = [1]\n[time]\nend = 1\ndt = 0.02\n";
    fs::write(place.path().join("bar.toml"), bar).unwrap();
    let line = "converge bar.toml --dt 0.02,0.01,0.005 --scalar end_u_x --quiet";
    let said = text(&succeed(place.path(), line).stdout);
    assert!(said.contains("dx = 50.0 mm"), "{said}");
    let table = fs::read_to_string(place.path().join("bar-converge/convergence.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().map(|row| row.split(',').collect()).collect();
    assert_eq!(
        rows[0],
        [
            "m",
            "spacing [m]",
            "horizon [m]",
            "dt [s]",
            "end_u_x",
            "order"
        ]
    );
    let order: f64 = rows[3][5].parse().unwrap();
    assert!((order - 2.0).abs() < 0.05, "velocity Verlet: {order}");
    assert_eq!(
        fail(
            place.path(),
            "converge bar.toml --dt 0.02 --m 3 --scalar end_u_x"
        )
        .0,
        2
    );
}

#[test]
fn manual_pages_are_written_for_every_command() {
    let place = tempfile::tempdir().unwrap();
    let page = text(&succeed(place.path(), "man run").stdout);
    assert!(
        page.contains("pericles\\-run") && page.contains("sweep"),
        "{page}"
    );
    succeed(place.path(), "man --out pages");
    let pages = fs::read_dir(place.path().join("pages")).unwrap().count();
    assert!(place.path().join("pages/pericles.1").is_file());
    assert!(place.path().join("pages/pericles-run.1").is_file() && pages > 15);
    let (status, message) = fail(place.path(), "man rnu");
    assert_eq!(status, 2);
    assert!(message.contains("run"), "{message}");
}

/// Profiles are redrawn in the requested format, beside the charts of tables.
#[test]
fn profiles_are_plotted_again() {
    let place = tempfile::tempdir().unwrap();
    let deck = "body = { shape = \"bar\", length = 20, spacing = 1 }\n\
        material = { density = 1, youngs_modulus = 1, horizon_ratio = 3 }\n\
        initial = [{ displacement = [{ expression = \"0.01*sin(x)\" }] }]\n\
        time = { end = 2 }\n\
        output = { profile = [{ name = \"axis\", field = \"Displacement\", from = [0], to = [20] }] }\n";
    std::fs::write(place.path().join("deck.toml"), deck).unwrap();
    succeed(place.path(), "run deck.toml --out run");
    let output = succeed(place.path(), "plot run --width 88mm --format pdf");
    let printed = text(&output.stdout);
    assert!(printed.contains("profile_axis.pdf"), "{printed}");
    let drawn = std::fs::read(place.path().join("run/plots/profile_axis.pdf")).unwrap();
    assert!(drawn.starts_with(b"%PDF"));
}
