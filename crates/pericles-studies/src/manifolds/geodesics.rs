//! Distances on icospheres of the unit sphere, against arcs of great circles: which methods converge.

use pericles_io::{Axis, Curve, LineChart};
use pericles_manifold::geodesic::{GeodesicErrors, GeodesicMethod, GeodesicPairs, geodesic_pairs};
use pericles_manifold::surface::{AreaRule, Surface, SurfaceChecks};
use pericles_run::RunError;

use super::presets::PAPER;
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(crate) const STUDY: Study = Study {
    id: "manifolds/geodesics",
    paper: PAPER,
    title: "Distances on a sphere: along edges, across triangles, exact",
    run,
};

/// The paper's horizon.
const DELTA: f64 = 0.5;

/// Errors in percent of one method on one icosphere, as separate codes found them (compiled exact geodesics, numba); none where they were not run. Their
/// last digits are the tolerance.
struct Expected {
    method: GeodesicMethod,
    /// Mean, root mean square, largest, pairs lost; with the digits behind the point.
    levels: [[Option<(f64, i32)>; 4]; 3],
}

/// With so many digits behind the point.
const fn percent(value: f64, digits: i32) -> Option<(f64, i32)> {
    Some((value, digits))
}

const NONE: [Option<(f64, i32)>; 4] = [None; 4];

/// The means of `edge` are not judged: those at hand leave out the pairs that the method places beyond the horizon.
const EXPECTED: [Expected; 6] = [
    Expected {
        method: GeodesicMethod::Edge,
        levels: [
            [None, None, percent(23.0, 1), None],
            [None, None, percent(23.4, 1), None],
            [None, None, percent(23.6, 1), None],
        ],
    },
    Expected {
        method: GeodesicMethod::EdgeDiagonals,
        levels: [
            [percent(0.8, 1), percent(1.6, 1), percent(4.5, 1), None],
            [percent(1.6, 1), percent(2.1, 1), percent(4.9, 1), None],
            [
                percent(1.9, 1),
                percent(2.3, 1),
                percent(5.0, 1),
                percent(3.8, 1),
            ],
        ],
    },
    Expected {
        method: GeodesicMethod::Steiner(2),
        levels: [
            [percent(0.6, 1), percent(0.9, 1), percent(2.7, 1), None],
            [percent(1.2, 1), percent(1.4, 1), percent(2.8, 1), None],
            [
                percent(1.4, 1),
                percent(1.5, 1),
                percent(3.0, 1),
                percent(2.6, 1),
            ],
        ],
    },
    Expected {
        method: GeodesicMethod::Steiner(3),
        levels: [
            [percent(0.2, 1), percent(0.4, 1), percent(1.1, 1), None],
            [percent(0.5, 1), percent(0.6, 1), percent(1.4, 1), None],
            NONE,
        ],
    },
    Expected {
        method: GeodesicMethod::Steiner(5),
        levels: [
            [percent(-0.1, 1), percent(0.15, 2), percent(0.35, 2), None],
            NONE,
            NONE,
        ],
    },
    Expected {
        method: GeodesicMethod::Exact,
        levels: [
            [
                percent(-0.16, 2),
                percent(0.17, 2),
                percent(0.25, 2),
                percent(0.0, 2),
            ],
            [
                percent(-0.05, 2),
                percent(0.05, 2),
                percent(0.07, 2),
                percent(0.0, 2),
            ],
            [
                percent(-0.01, 2),
                percent(0.01, 2),
                percent(0.02, 2),
                percent(0.0, 2),
            ],
        ],
    },
];

fn run(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = mesh()?;
    let levels = if context.full { 3..=5 } else { 3..=4 };
    let mut curves: Vec<Vec<[f64; 2]>> = vec![Vec::new(); EXPECTED.len()];
    for level in levels {
        let sphere = Surface::icosphere(level, 1.0)
            .map_err(pericles::PericlesError::from)?
            .renumbered();
        let arcs = arcs(&sphere);
        for (expected, curve) in EXPECTED.iter().zip(&mut curves) {
            let expected_here = &expected.levels[level as usize - 3];
            // What nobody has computed before is not worth the time.
            if expected_here.iter().all(Option::is_none) {
                continue;
            }
            let errors = GeodesicErrors::of_method(&sphere, DELTA, expected.method, &arcs)?;
            curve.push([sphere.median_edge(), 100.0 * errors.rms]);
            let computed = [errors.mean, errors.rms, errors.max, errors.lost];
            for (k, what) in ["mean", "rms", "largest", "lost"].into_iter().enumerate() {
                let case = format!("{} vertices, {}: {what} (%)", sphere.len(), expected.method);
                let row = Row::new(case, "", Some(100.0 * computed[k]));
                rows.push(match expected_here[k] {
                    Some((value, digits)) => row.within(value, 0.6 * 10f64.powi(-digits)),
                    None => row,
                });
            }
        }
    }
    draw(context, &curves)?;
    Ok(rows)
}

/// The paper's mesh, and its bonds by each notion of distance.
fn mesh() -> Result<Vec<Row>, RunError> {
    let sphere = Surface::icosphere(3, 1.0).map_err(pericles::PericlesError::from)?;
    let checked = sphere.checked(SurfaceChecks::default());
    let (sphere, report) = checked.map_err(pericles::PericlesError::from)?;
    let areas = sphere.vertex_areas(AreaRule::Barycentric);
    let extreme = |pick: fn(f64, f64) -> f64| areas.iter().copied().reduce(pick);
    let bonds =
        |method| geodesic_pairs(&sphere, DELTA, method).map(|pairs| Some(pairs.len() as f64));
    let chords = (0..sphere.len())
        .flat_map(|i| (0..sphere.len()).map(move |j| (i, j)))
        .filter(|&(i, j)| i != j && sphere.chord(i, j) < DELTA)
        .count();
    let swapped = "the paper swaps the numbers of vertices and triangles";
    Ok(vec![
        Row::new("vertices", "", Some(sphere.len() as f64))
            .printed(1280.0)
            .within(642.0, 0.0)
            .note(swapped),
        Row::new("edges", "", Some(report.edges as f64))
            .printed(1920.0)
            .within(1920.0, 0.0),
        Row::new("triangles", "", Some(sphere.triangles().len() as f64))
            .printed(642.0)
            .within(1280.0, 0.0)
            .note(swapped),
        Row::new("area", "m²", Some(report.area)).within(12.506492733969928, 1e-12),
        Row::new("volume", "m³", Some(report.volume)).within(4.152740817093058, 1e-12),
        Row::new("smallest area of a vertex", "m²", extreme(f64::min)).within(0.0151380682, 1e-10),
        Row::new("largest area of a vertex", "m²", extreme(f64::max)).within(0.0226815464, 1e-10),
        Row::new("shortest edge", "m", Some(report.edge_lengths[0])).within(0.1382831735, 1e-10),
        Row::new("longest edge", "m", Some(report.edge_lengths[2])).within(0.1646471600, 1e-10),
        Row::new(
            "directed bonds along edges",
            "",
            bonds(GeodesicMethod::Edge)?,
        )
        .within(22740.0, 0.0),
        Row::new("directed bonds, exact", "", bonds(GeodesicMethod::Exact)?)
            .within(23580.0, 0.0)
            .note("as many as by arcs of great circles"),
        Row::new(
            "directed bonds in a Euclidean ball",
            "",
            Some(chords as f64),
        )
        .within(23940.0, 0.0),
    ])
}

/// The pairs nearer than the horizon on the unit sphere itself.
fn arcs(sphere: &Surface) -> GeodesicPairs {
    let mut pairs = GeodesicPairs {
        start: vec![0],
        neighbour: Vec::new(),
        distance: Vec::new(),
    };
    for i in 0..sphere.len() {
        for j in 0..sphere.len() {
            // No chord is longer than 2 but by rounding.
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

fn draw(context: &Context<'_>, curves: &[Vec<[f64; 2]>]) -> Result<(), RunError> {
    let Some(path) = context.figure("errors.png") else {
        return Ok(());
    };
    let mut chart = LineChart::new(Axis::new("median edge", "m"), Axis::new("rms error", "%"))
        .title("distances on the unit sphere within 0.5");
    let lines = EXPECTED.iter().zip(curves);
    for (expected, curve) in lines.filter(|(_, curve)| curve.len() > 1) {
        let x: Vec<f64> = curve.iter().map(|point| point[0]).collect();
        let y: Vec<f64> = curve.iter().map(|point| point[1]).collect();
        chart = chart.curve(Curve::line(expected.method.to_string(), &x, &y));
    }
    chart.write(path)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_study_holds() {
        let rows = run(&Context::without_figures()).unwrap();
        let failed: Vec<&Row> = rows
            .iter()
            .filter(|row| row.pass() == Some(false))
            .collect();
        assert!(failed.is_empty(), "{failed:#?}");
        assert!(rows.iter().filter(|row| row.pass().is_some()).count() >= 40);
    }
}
