//! `geodesics`: compare accuracy and cost of methods for geodesic distances.

mod shape;

use std::collections::HashMap;
use std::path::Path;
use std::time::Instant;

use pericles_manifold::geodesic::{
    GeodesicErrors, GeodesicMethod, GeodesicPairs, geodesic_distance, geodesic_pairs,
};
use pericles_manifold::surface::{Surface, SurfaceChecks, SurfaceReport};
use pericles_run::units::{count, duration, significant};
use serde::Serialize;

use crate::args::{GeodesicsArgs, Pair};
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;

/// The JSON output.
#[derive(Serialize)]
struct Results {
    surface: String,
    vertices: usize,
    edges: usize,
    triangles: usize,
    parts: usize,
    boundary_edges: usize,
    /// Genus of the first component; `None` if it is open.
    genus: Option<i64>,
    area: f64,
    volume: f64,
    edge_lengths: [f64; 3],
    angles_degrees: [f64; 2],
    horizon: f64,
    cautions: Vec<String>,
    methods: Vec<MethodResult>,
    /// Distances between given vertices.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    between: Vec<Distance>,
}

/// The distance between two vertices by a method.
#[derive(Serialize)]
struct Distance {
    /// Vertex numbers as in the file.
    vertices: [usize; 2],
    method: String,
    /// Distance, m; `None` if no path connects them.
    distance: Option<f64>,
}

#[derive(Serialize)]
struct MethodResult {
    method: String,
    directed_bonds: usize,
    seconds: f64,
    mean_error: f64,
    rms_error: f64,
    max_error: f64,
    lost: f64,
}

/// Compares methods on a surface.
///
/// # Errors
/// The surface cannot be read or fails its checks, a vertex has no neighbour within the horizon, or output cannot be
/// written.
pub(crate) fn geodesics(args: &GeodesicsArgs) -> Result<Exit, CliError> {
    let surface = shape::surface(&args.surface)?;
    let checks = SurfaceChecks {
        open: args.open,
        several_components: args.several,
        flip: args.flip,
    };
    let checked = surface.checked(checks);
    let (surface, report) = checked.map_err(|source| CliError::Surface {
        name: args.surface.clone(),
        source,
    })?;
    args.threads.start()?;
    let surface = surface.renumbered();
    let between = between(&surface, args)?;
    let (truth, seconds) = timed(&surface, args.horizon.metres, GeodesicMethod::Exact)?;
    let methods = args
        .methods
        .iter()
        .map(|&method| result(&surface, args.horizon.metres, method, &truth, seconds))
        .collect::<Result<Vec<MethodResult>, CliError>>()?;
    let mean_neighbours = truth.len() as f64 / surface.len() as f64;
    let cautions = surface.cautions(args.horizon.metres, mean_neighbours);
    let results = Results {
        surface: args.surface.clone(),
        vertices: surface.len(),
        edges: report.edges,
        triangles: surface.triangles().len(),
        parts: report.components.len(),
        boundary_edges: report.boundary_edges,
        genus: report.components[0].genus(),
        area: report.area,
        volume: report.volume,
        edge_lengths: report.edge_lengths,
        angles_degrees: report.angles.map(f64::to_degrees),
        horizon: args.horizon.metres,
        cautions: cautions.iter().map(ToString::to_string).collect(),
        methods,
        between,
    };
    if let Some(path) = &args.json {
        console::write_json(path, &results)?;
    }
    if args.json.as_deref() != Some(Path::new("-")) {
        print(&results, &report, mean_neighbours)?;
    }
    Ok(Exit::Done)
}

/// Returns the requested distances by all methods.
fn between(surface: &Surface, args: &GeodesicsArgs) -> Result<Vec<Distance>, CliError> {
    let numbers: HashMap<usize, usize> = (0..surface.len())
        .map(|vertex| (surface.user_number(vertex), vertex))
        .collect();
    let mut found = Vec::new();
    for &Pair(pair) in &args.between {
        let mut vertices = [0; 2];
        for (vertex, number) in vertices.iter_mut().zip(pair) {
            *vertex = *numbers.get(&number).ok_or(CliError::NoVertex {
                number,
                vertices: surface.len(),
            })?;
        }
        for &method in &args.methods {
            found.push(Distance {
                vertices: pair,
                method: method.to_string(),
                distance: geodesic_distance(surface, vertices, method)?,
            });
        }
    }
    Ok(found)
}

fn timed(
    surface: &Surface,
    horizon: f64,
    method: GeodesicMethod,
) -> Result<(GeodesicPairs, f64), CliError> {
    let began = Instant::now();
    let pairs = geodesic_pairs(surface, horizon, method)?;
    Ok((pairs, began.elapsed().as_secs_f64()))
}

fn result(
    surface: &Surface,
    horizon: f64,
    method: GeodesicMethod,
    truth: &GeodesicPairs,
    exact_seconds: f64,
) -> Result<MethodResult, CliError> {
    let (directed_bonds, seconds, errors) = if method == GeodesicMethod::Exact {
        let none = GeodesicErrors {
            mean: 0.0,
            rms: 0.0,
            max: 0.0,
            lost: 0.0,
            extra: 0.0,
        };
        (truth.len(), exact_seconds, none)
    } else {
        let (pairs, seconds) = timed(surface, horizon, method)?;
        let errors = GeodesicErrors::of_method(surface, horizon, method, truth)?;
        (pairs.len(), seconds, errors)
    };
    Ok(MethodResult {
        method: method.to_string(),
        directed_bonds,
        seconds,
        mean_error: errors.mean,
        rms_error: errors.rms,
        max_error: errors.max,
        lost: errors.lost,
    })
}

fn print(results: &Results, report: &SurfaceReport, mean_neighbours: f64) -> Result<(), CliError> {
    let digits = |x: f64| significant(x, 4);
    let [shortest, median, longest] = results.edge_lengths.map(digits);
    let [smallest, largest] = results.angles_degrees.map(|angle| significant(angle, 3));
    let topology = match (results.parts, results.genus) {
        (1, Some(genus)) => format!("closed, genus {genus}"),
        (1, None) => format!("open, {} boundary edges", results.boundary_edges),
        (parts, _) => format!(
            "{parts} disconnected components, {} boundary edges",
            results.boundary_edges
        ),
    };
    console::print(format_args!(
        "{}: {} vertices, {} edges, {} triangles; {topology}\n\
         area {} m², volume {} m³; edges {shortest}, {median}, {longest} m (shortest, median, longest); angles {smallest}° to {largest}°\n\
         horizon {} m ({} median edge lengths); {} neighbours on average\n",
        results.surface,
        count(results.vertices as u64),
        count(results.edges as u64),
        count(results.triangles as u64),
        digits(results.area),
        digits(results.volume),
        significant(results.horizon, 4),
        significant(results.horizon / report.edge_lengths[1], 3),
        significant(mean_neighbours, 3),
    ))?;
    if report.flipped > 0 {
        console::print(format_args!("{} triangles were reoriented", report.flipped))?;
    }
    for caution in &results.cautions {
        console::print(format_args!("warning: {caution}"))?;
    }
    console::print(format_args!(
        "{:<15} {:>14} {:>9} {:>9} {:>9} {:>9} {:>9}",
        "method", "bonds (dir.)", "mean", "rms", "max", "lost", "time"
    ))?;
    for method in &results.methods {
        let percent = |ratio: f64| format!("{:.3} %", 100.0 * ratio);
        console::print(format_args!(
            "{:<15} {:>14} {:>9} {:>9} {:>9} {:>9} {:>9}",
            method.method,
            count(method.directed_bonds as u64),
            percent(method.mean_error),
            percent(method.rms_error),
            percent(method.max_error),
            percent(method.lost),
            duration(method.seconds)
        ))?;
    }
    for Distance {
        vertices: [a, b],
        method,
        distance,
    } in &results.between
    {
        let distance = match distance {
            Some(distance) => format!("{} m", significant(*distance, 6)),
            None => "not connected".into(),
        };
        console::print(format_args!("vertices {a} and {b}, {method}: {distance}"))?;
    }
    Ok(())
}
