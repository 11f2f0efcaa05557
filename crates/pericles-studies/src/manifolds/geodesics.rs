//! Distances on icospheres of the unit sphere compared with great-circle arcs: convergence of the methods.

use pericles::PericlesError;
use pericles_manifold::geodesic::{GeodesicErrors, GeodesicMethod, GeodesicPairs, geodesic_pairs};
use pericles_manifold::surface::{AreaRule, Surface, SurfaceChecks};
use pericles_run::RunError;

use crate::data::{Case, Found};

/// Horizon of the paper.
const DELTA: f64 = 0.5;

/// Methods of the study.
const METHODS: [(&str, GeodesicMethod); 6] = [
    ("edge", GeodesicMethod::Edge),
    ("edge-diagonals", GeodesicMethod::EdgeDiagonals),
    ("steiner(2)", GeodesicMethod::Steiner(2)),
    ("steiner(3)", GeodesicMethod::Steiner(3)),
    ("steiner(5)", GeodesicMethod::Steiner(5)),
    ("exact", GeodesicMethod::Exact),
];

/// Mesh of the paper, and its bonds for each definition of distance.
pub(super) fn mesh(_: &Case<'_>) -> Result<Found, RunError> {
    let sphere = Surface::icosphere(3, 1.0).map_err(PericlesError::from)?;
    let checked = sphere.checked(SurfaceChecks::default());
    let (sphere, report) = checked.map_err(PericlesError::from)?;
    let areas = sphere.vertex_areas(AreaRule::Barycentric);
    let extreme = |pick: fn(f64, f64) -> f64| areas.iter().copied().reduce(pick);
    let bonds = |method| geodesic_pairs(&sphere, DELTA, method).map(|pairs| pairs.len() as f64);
    let chords = (0..sphere.len())
        .flat_map(|i| (0..sphere.len()).map(move |j| (i, j)))
        .filter(|&(i, j)| i != j && sphere.chord(i, j) < DELTA)
        .count();
    Ok(Found::from([
        ("vertices", sphere.len() as f64),
        ("edges", report.edges as f64),
        ("triangles", sphere.triangles().len() as f64),
        ("area", report.area),
        ("volume", report.volume),
        ("shortest edge", report.edge_lengths[0]),
        ("longest edge", report.edge_lengths[2]),
        ("bonds along edges", bonds(GeodesicMethod::Edge)?),
        ("bonds, exact", bonds(GeodesicMethod::Exact)?),
        ("bonds, chords", chords as f64),
    ])
    .value("smallest area", extreme(f64::min))
    .value("largest area", extreme(f64::max)))
}

/// Pairs closer than the horizon on the exact unit sphere.
fn arcs(sphere: &Surface) -> GeodesicPairs {
    let mut pairs = GeodesicPairs {
        start: vec![0],
        neighbour: Vec::new(),
        distance: Vec::new(),
    };
    for i in 0..sphere.len() {
        for j in 0..sphere.len() {
            // No chord exceeds 2 except by round-off.
            let arc = 2.0 * (0.5 * sphere.chord(i, j)).min(1.0).asin();
            if i != j && arc < DELTA {
                pairs.neighbour.push(j as u32);
                pairs.distance.push(arc);
            }
        }
        pairs.start.push(pairs.neighbour.len());
    }
    pairs
}

/// Icosphere, and the arcs between its vertices.
fn sphere(level: u32) -> Result<(Surface, GeodesicPairs), RunError> {
    let sphere = Surface::icosphere(level, 1.0)
        .map_err(PericlesError::from)?
        .renumbered();
    let arcs = arcs(&sphere);
    Ok((sphere, arcs))
}

/// Number of vertices, median edge, and the errors of a method on an icosphere: mean, root mean square, largest,
/// pairs lost.
fn errors(case: &Case<'_>, level: u32) -> Result<([f64; 2], [f64; 4]), RunError> {
    let method = case.one_of("method", &METHODS)?;
    let known = case.once(format!("{method} {level}"), || {
        let spheres = case.once(format!("sphere {level}"), || sphere(level))?;
        let (sphere, arcs) = &*spheres;
        let errors = GeodesicErrors::of_method(sphere, DELTA, method, arcs)?;
        let mesh = [sphere.len() as f64, sphere.median_edge()];
        let errors = [errors.mean, errors.rms, errors.max, errors.lost];
        Ok((mesh, errors.map(|error| 100.0 * error)))
    })?;
    Ok(*known)
}

/// Errors of one method on one icosphere, in percent.
pub(super) fn distances(case: &Case<'_>) -> Result<Found, RunError> {
    let ([vertices, _], [mean, rms, largest, lost]) = errors(case, case.count("level")? as u32)?;
    Ok([
        ("vertices", vertices),
        ("mean", mean),
        ("rms", rms),
        ("largest", largest),
        ("lost", lost),
    ]
    .into())
}

/// Error of a method over the icospheres of several levels, as a curve.
pub(super) fn of_levels(case: &Case<'_>) -> Result<Found, RunError> {
    let (mut edge, mut rms) = (Vec::new(), Vec::new());
    for level in case.numbers("levels")? {
        let (mesh, found) = errors(case, level as u32)?;
        edge.push(mesh[1]);
        rms.push(found[1]);
    }
    Ok(Found::default().curve("errors", &edge, &rms))
}
