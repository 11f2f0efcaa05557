//! Stress concentration at a hole whose edge follows rings of points, against Kirsch's solution of the infinite plate.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

use pericles::boundary::{AxisMotion, MotionKind, PrescribedMotion, TimeFunction};
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, GivenConstants, LinearSolid, StateInfluence, Strains, StressState,
};
use pericles::operator::{BondForm, GhostLayer, LinearSolidBody};
use pericles::space::{Point, PointCloud};
use pericles::{PointScalar, System};
use pericles_run::RunError;

use super::bodies::points;
use super::solver::state_of;
use crate::data::{Case, Found};

/// The plate: a hole of radius 1 m, E = 1 Pa, a stress of 1 Pa along y far away.
struct Kirsch {
    poisson_ratio: f64,
}

impl Kirsch {
    /// Displacements along and around, m, at radius r and angle θ from the direction of the stress.
    fn displacement(&self, r: f64, theta: f64) -> [f64; 2] {
        let nu = self.poisson_ratio;
        let kappa = (3.0 - nu) / (1.0 + nu);
        // 1/(8 G) with G = E/2(1 + ν).
        let factor = (1.0 + nu) / 4.0;
        let (sin, cos) = (2.0 * theta).sin_cos();
        let square = 1.0 / (r * r);
        let radial = r * (kappa - 1.0 + 2.0 * cos) + 2.0 / r * (1.0 + (kappa + 1.0 - square) * cos);
        let hoop = -(2.0 * r + 2.0 / r * (kappa - 1.0 + square)) * sin;
        [factor * radial, factor * hoop]
    }

    /// Hoop strain beside the hole, at right angles to the stress.
    fn strain_beside(&self, r: f64) -> f64 {
        let square = 1.0 / (r * r);
        let hoop = 0.5 * (1.0 + square) + 0.5 * (1.0 + 3.0 * square * square);
        let radial = 0.5 * (1.0 - square) - 0.5 * (1.0 - 4.0 * square + 3.0 * square * square);
        hoop - self.poisson_ratio * radial
    }

    /// The displacement at a place, m.
    fn at(&self, [x, y, _]: Point) -> [f64; 2] {
        let angle = y.atan2(x);
        let [radial, hoop] = self.displacement(x.hypot(y), angle - FRAC_PI_2);
        let (sin, cos) = angle.sin_cos();
        [radial * cos - hoop * sin, radial * sin + hoop * cos]
    }
}

/// A ring of points, the first of which are on both sides of the x axis.
struct Ring {
    radius: f64,
    /// Number of its first point.
    first: usize,
    count: usize,
}

/// Rings of cells between two radii, whose widths are `spacing`, from the inner one outwards.
fn rings(inner: f64, number: usize, spacing: f64) -> (Vec<Ring>, Vec<Point>, Vec<f64>) {
    let (mut all, mut places, mut volumes) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..number {
        let radius = inner + (k as f64 + 0.5) * spacing;
        let count = 4 * (TAU * radius / spacing / 4.0).round().max(1.0) as usize;
        all.push(Ring {
            radius,
            first: places.len(),
            count,
        });
        for point in 0..count {
            let angle = TAU * (point as f64 + 0.5) / count as f64;
            places.push([radius * angle.cos(), radius * angle.sin(), 0.0]);
            volumes.push(TAU * radius * spacing / count as f64);
        }
    }
    (all, places, volumes)
}

/// Rings over which the strain ratio is extrapolated to the edge.
const EXTRAPOLATED: usize = 6;

/// The stress concentration factor (3 times the hoop strain over Kirsch's, extrapolated to the edge over six rings), the ratio at the first ring, the displacement of the crown over Kirsch's, and the error of displacements in L2.
///
/// Arguments: `rings` to a unit of length, the outer radius `outer`, `nu`, `function` and `ghosts`. Points within two horizons of the outer edge have Kirsch's displacements.
pub(super) fn hole(case: &Case<'_>) -> Result<Found, RunError> {
    let (spacing, outer) = (1.0 / case.number("rings")?, case.number("outer")?);
    let exact = Kirsch {
        poisson_ratio: case.number("nu")?,
    };
    let number = ((outer - 1.0) / spacing).round() as usize;
    let (rings_of_body, places, volumes) = rings(1.0, number, spacing);
    let flat = |places: &[Point]| -> Vec<f64> {
        (0..2)
            .flat_map(|c| places.iter().map(move |x| x[c]))
            .collect()
    };
    let cloud = Arc::new(PointCloud::new(2, flat(&places), volumes, 1.0)?);
    let function = [
        ("w = 1", InfluenceFunction::Constant),
        ("w = 1 − r/δ", InfluenceFunction::Conical),
    ];
    let horizon = 3.0 * spacing * (1.0 + 1e-6);
    let solid = LinearSolid {
        density: 1.0,
        elastic: GivenConstants {
            young: Some(1.0),
            poisson_ratio: Some(exact.poisson_ratio),
            ..GivenConstants::default()
        },
        horizon,
        influence: StateInfluence::Function(case.one_of("function", &function)?),
        volume_correction: VolumeCorrection::None,
        failure: BondFailure::Unbreakable,
    };
    let constants = solid.constants(&cloud, StressState::PlaneStress)?;
    let body = LinearSolidBody {
        strains: Strains::Small,
        ..LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None)
    };
    let assembled = match case.flag("ghosts") {
        true => {
            let (_, ghosts, volumes) = rings(1.0 - 3.0 * spacing, 3, spacing);
            let layer = GhostLayer::of_points(&cloud, &ghosts, &volumes)?;
            body.with_ghost_layer(layer, BondForm::List)?
        }
        false => body.operator(BondForm::List)?,
    };
    let mut system = System::new(cloud.clone(), assembled.operator, PointScalar::Uniform(1.0))?;
    let edge = points(&cloud, |x| x[0].hypot(x[1]) >= outer - 2.0 * horizon);
    let along = |c: usize| {
        let moved = edge.iter().map(|&i| exact.at(cloud.point(i as usize))[c]);
        Some(AxisMotion::PerPoint(moved.collect()))
    };
    let n = cloud.len();
    system.add_motion(PrescribedMotion::along(
        "edge".into(),
        edge.clone(),
        MotionKind::Displacement,
        [along(0), along(1), None],
        TimeFunction::Constant,
        &vec![0.0; 2 * n],
        n,
    )?)?;
    let (took, u) = state_of(&system)?;
    let ratio = |ring: &Ring| {
        let (above, below) = (ring.first, ring.first + ring.count - 1);
        let apart = cloud.axis(1)[above] - cloud.axis(1)[below];
        (u[n + above] - u[n + below]) / apart / exact.strain_beside(ring.radius)
    };
    let ratios: Vec<f64> = rings_of_body[..EXTRAPOLATED].iter().map(ratio).collect();
    let (mut error, mut size) = (0.0, 0.0);
    for i in 0..n {
        let volume = cloud.volumes()[i];
        let expected = exact.at(cloud.point(i));
        for c in 0..2 {
            error += volume * (u[c * n + i] - expected[c]).powi(2);
            size += volume * expected[c] * expected[c];
        }
    }
    Ok([
        ("factor", 3.0 * at_edge(&ratios)),
        ("first", ratios[0]),
        (
            "crown",
            crown(&cloud, &u, &rings_of_body[0])
                / exact.displacement(rings_of_body[0].radius, 0.0)[0],
        ),
        ("error", (error / size).sqrt()),
        ("points", n as f64),
        ("products", took.products as f64),
    ]
    .into())
}

/// The quadratic polynomial that fits values at k + ½ best, k = 0 … 5, at 0.
fn at_edge(values: &[f64]) -> f64 {
    let middle = 0.5 * values.len() as f64;
    let place = |k: usize| k as f64 + 0.5 - middle;
    let squares: f64 = (0..values.len()).map(|k| place(k).powi(2)).sum();
    let mean = squares / values.len() as f64;
    let basis: [&dyn Fn(f64) -> f64; 3] = [&|_| 1.0, &|t| t, &|t| t * t - mean];
    basis
        .iter()
        .map(|polynomial| {
            let (mut along, mut size) = (0.0, 0.0);
            for (k, value) in values.iter().enumerate() {
                let p = polynomial(place(k));
                along += value * p;
                size += p * p;
            }
            along / size * polynomial(-middle)
        })
        .sum()
}

/// The radial displacement of a ring in the direction of the stress, from its mean and its part of two waves.
fn crown(cloud: &PointCloud, u: &[f64], ring: &Ring) -> f64 {
    let n = cloud.len();
    let sum: f64 = (ring.first..ring.first + ring.count)
        .map(|i| {
            let [x, y, _] = cloud.point(i);
            let angle = y.atan2(x);
            let radial = u[i] * angle.cos() + u[n + i] * angle.sin();
            radial * (1.0 + 2.0 * (2.0 * angle - PI).cos())
        })
        .sum();
    sum / ring.count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kirsch_moves_the_edge_as_it_is_known() {
        let plate = Kirsch { poisson_ratio: 0.3 };
        // u = 3 p a/E at the crown, −p a/E beside, and a hoop strain of 3 p/E there (Kirsch 1898).
        assert!((plate.displacement(1.0, 0.0)[0] - 3.0).abs() < 1e-12);
        assert!((plate.displacement(1.0, FRAC_PI_2)[0] + 1.0).abs() < 1e-12);
        assert!((plate.strain_beside(1.0) - 3.0).abs() < 1e-12);
        // The strain is that of the displacements: ε = (u_r + ∂u_θ/∂θ)/r.
        let (r, step) = (1.4, 1e-5);
        let hoop = |theta: f64| plate.displacement(r, theta)[1];
        let slope = (hoop(FRAC_PI_2 + step) - hoop(FRAC_PI_2 - step)) / (2.0 * step);
        let strain = (plate.displacement(r, FRAC_PI_2)[0] + slope) / r;
        assert!((strain - plate.strain_beside(r)).abs() < 1e-9);
    }

    #[test]
    fn quadratic_polynomials_are_extrapolated_exactly() {
        let value = |k: usize| 2.0 - 0.3 * (k as f64 + 0.5) + 0.07 * (k as f64 + 0.5).powi(2);
        let values: Vec<f64> = (0..EXTRAPOLATED).map(value).collect();
        assert!((at_edge(&values) - 2.0).abs() < 1e-12);
    }
}
