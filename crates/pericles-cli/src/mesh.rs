//! `mesh`: report the contents of a mesh or surface file.

use std::path::Path;

use pericles_io::read_mesh;
use pericles_mesh::fill::TriangleSurface;
use pericles_mesh::{CellKind, PointOptions, Problem, RawMesh, SetKind, Summary};
use pericles_run::units::{count, quantity, significant};
use serde::Serialize;

use crate::args::MeshArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;

/// The JSON output, in SI units.
#[derive(Serialize)]
struct Results {
    file: String,
    /// Length unit of the file, m.
    unit: f64,
    nodes: usize,
    /// Number of elements by type.
    elements: Vec<Count>,
    /// Number of elements of unsupported or unused types.
    left_out: Vec<Count>,
    /// Elements that become points; 0 for a triangulated surface.
    points: usize,
    /// Points that belong to no element group.
    in_no_group: usize,
    /// Volume, for a surface the enclosed volume, m³.
    volume: f64,
    /// Lower and upper corner of the bounding box, m.
    #[serde(rename = "box")]
    bounds: [[f64; 3]; 2],
    /// Smallest, mean and largest element size, m; `None` for a surface.
    cell_size: Option<[f64; 3]>,
    sets: Vec<Set>,
    problems: Vec<String>,
}

#[derive(Serialize)]
struct Count {
    kind: String,
    count: usize,
    /// Singular or plural of the type, for the text output.
    #[serde(skip)]
    word: String,
}

#[derive(Serialize)]
struct Set {
    name: String,
    kind: &'static str,
    points: usize,
    /// Area, m².
    area: Option<f64>,
}

/// Reports the contents of a mesh.
///
/// # Errors
/// The file cannot be read or is not a mesh, or output cannot be written.
pub(crate) fn mesh(args: &MeshArgs) -> Result<Exit, CliError> {
    let mesh = read_mesh(&args.file, args.memory.bytes())?;
    let unit = args.unit.metres;
    let options = PointOptions {
        unit,
        thickness: args.thickness.metres,
        blocks: (!args.blocks.is_empty()).then(|| args.blocks.clone()),
    };
    let rejected = |problem: String| CliError::Mesh {
        file: args.file.clone(),
        problem,
    };
    let results = match mesh.points(&options) {
        Ok(points) => of_points(&args.file, Summary::new(&mesh, &points, unit), unit),
        // Triangles that do not lie in a plane: a surface to be filled.
        Err(Problem::NotPlane { .. }) if options.blocks.is_none() => {
            let surface = TriangleSurface::of_mesh(&mesh, unit);
            let surface = surface.map_err(|error| rejected(error.to_string()))?;
            of_surface(&args.file, &mesh, &surface, unit)
        }
        Err(problem) => return Err(rejected(problem.to_string())),
    };
    if let Some(path) = &args.json {
        console::write_json(path, &results)?;
    }
    if args.json.as_deref() != Some(Path::new("-")) {
        console::print(format_args!("{}", text(&results)))?;
    }
    Ok(Exit::Done)
}

fn of_points(file: &Path, summary: Summary, unit: f64) -> Results {
    let set = |set: pericles_mesh::SetSummary| Set {
        name: set.name,
        kind: match set.kind {
            SetKind::Elements => "elements",
            SetKind::Faces => "faces",
            SetKind::Nodes => "nodes",
        },
        points: set.points,
        area: set.area,
    };
    Results {
        file: file.display().to_string(),
        unit,
        nodes: summary.nodes,
        elements: kinds(&summary.kinds),
        left_out: types(summary.left_out),
        points: summary.points,
        in_no_group: summary.in_no_group,
        volume: summary.volume,
        bounds: summary.bounds,
        cell_size: Some(summary.sizes),
        sets: summary.sets.into_iter().map(set).collect(),
        problems: summary.problems,
    }
}

fn of_surface(file: &Path, mesh: &RawMesh, surface: &TriangleSurface, unit: f64) -> Results {
    let mut problems = Vec::new();
    let (surface, reversed) = surface.repaired();
    problems.extend(reversed.map(|reversed| reversed.to_string()));
    let volume = surface.signed_volume();
    let open = surface.unmatched_edges();
    if open > 0 {
        problems.push(format!(
            "the surface is not closed: {open} triangle edges have no opposite neighbour; shape = \"solid\" requires open = true"
        ));
    } else if volume < 0.0 {
        problems.push("all triangle normals point inwards".to_owned());
    }
    Results {
        file: file.display().to_string(),
        unit,
        nodes: mesh.nodes.len(),
        elements: kinds(&mesh.cells.counts()),
        left_out: Vec::new(),
        points: 0,
        in_no_group: 0,
        volume: volume.abs(),
        bounds: surface.bounds(),
        cell_size: None,
        sets: Vec::new(),
        problems,
    }
}

fn kinds(all: &[(CellKind, usize)]) -> Vec<Count> {
    let one = |&(kind, count): &(CellKind, usize)| Count {
        kind: kind.to_string(),
        count,
        word: kind.word(count).to_owned(),
    };
    all.iter().map(one).collect()
}

/// Counts of elements by the type names in the file.
fn types(all: Vec<(String, usize)>) -> Vec<Count> {
    let one = |(kind, count): (String, usize)| Count {
        word: kind.clone(),
        kind,
        count,
    };
    all.into_iter().map(one).collect()
}

fn text(results: &Results) -> String {
    let mut lines = vec![format!(
        "{} (unit {})",
        results.file,
        quantity(results.unit, "m")
    )];
    let mut line = |name: &str, text: String| lines.push(format!("  {name:<14} {text}"));
    let number = |count_of: usize| count(count_of as u64);
    let kinds = |all: &[Count]| {
        let words = all
            .iter()
            .map(|c| format!("{} {}", number(c.count), c.word));
        words.collect::<Vec<_>>().join(", ")
    };
    line("nodes", number(results.nodes));
    line("elements", kinds(&results.elements));
    if !results.left_out.is_empty() {
        line("not used", kinds(&results.left_out));
    }
    match results.cell_size {
        Some([least, mean, most]) => {
            let outside = match results.in_no_group {
                0 => String::new(),
                some => format!(", {} in no element group", number(some)),
            };
            line("points", format!("{}{outside}", number(results.points)));
            let [least, mean, most] = [least, mean, most].map(|size| quantity(size, "m"));
            line("cell size", format!("{least} to {most}, mean {mean}"));
        }
        None => line(
            "points",
            "none: a surface, to be filled with shape = \"solid\"".into(),
        ),
    }
    line("volume", format!("{} m³", significant(results.volume, 5)));
    let corner = |x: &[f64; 3]| {
        let words = x.map(|x| quantity(x, "m"));
        format!("({})", words.join(", "))
    };
    let [low, high] = &results.bounds;
    line("box", format!("{} to {}", corner(low), corner(high)));
    for set in &results.sets {
        let area = set.area.map_or(String::new(), |area| {
            format!(", area {} m²", significant(area, 5))
        });
        line(
            "set",
            format!(
                "{} ({}): {} points{area}",
                set.name,
                set.kind,
                number(set.points)
            ),
        );
    }
    for problem in &results.problems {
        line("problem", problem.clone());
    }
    lines.join("\n")
}
