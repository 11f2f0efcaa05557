//! Surface correction: thin bodies conduct the heat of Fourier's law along every direction, and prescribed layers as deep as
//! the horizon are exact for linear fields.

use std::sync::Arc;

use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::space::{ListedPoints, PointCloud, rectangular_cells};
use pericles_heat::DiffusionBody;

use crate::support::*;

const SPACING: f64 = 1e-3;
/// The factors are found by a limited number of iterations, which converge slowest in rods of 3 × 3 cells (7e-5 at a horizon
/// ratio of 3). Chosen after the first result.
const ITERATION: f64 = 5e-4;

fn cells(counts: &[usize]) -> Arc<PointCloud> {
    let sides: Vec<f64> = counts.iter().map(|n| *n as f64 * SPACING).collect();
    let spacing = vec![SPACING; counts.len()];
    Arc::new(rectangular_cells([0.0; 3], &sides, &spacing, SPACING, &[]).unwrap())
}

fn corrected(cloud: Arc<PointCloud>, ratio: f64) -> DiffusionBody {
    DiffusionBody {
        surface_correction: true,
        ..body(cloud, ratio * SPACING, 45.0)
    }
}

/// Returns the largest deviation from Fourier's law of the heat through the cross-section in the middle, and the largest
/// residual flow there relative to the flow through a bond of the section, for a unit gradient along `axis`.
fn errors(body: &DiffusionBody, axis: [f64; 3], on_list: bool) -> (f64, f64) {
    let cloud = &body.cloud;
    let diffusion = if on_list {
        body.build_list()
    } else {
        body.build()
    }
    .unwrap();
    let along = |i: usize| (0..3).map(|c| axis[c] * cloud.point(i)[c]).sum::<f64>();
    let values: Vec<f64> = (0..cloud.len()).map(along).collect();
    let (n, d) = (cloud.len(), cloud.dimension());
    let mut flux = vec![0.0; d * n];
    diffusion.flux_into(&values, &mut flux);
    let flow = flow(&diffusion, &values);
    let [least, most] = values
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], &x| {
            [a.min(x), b.max(x)]
        });
    let middle = 0.5 * (least + most);
    let section: Vec<usize> = (0..n)
        .filter(|&i| (values[i] - middle).abs() < 0.51 * SPACING)
        .collect();
    let volume: f64 = section.iter().map(|&i| cloud.volumes()[i]).sum();
    let heat: f64 = section
        .iter()
        .map(|&i| {
            let component = |c: usize| axis[c] * flux[c * n + i] * cloud.volumes()[i];
            (0..d).map(component).sum::<f64>()
        })
        .sum();
    let scale = 45.0 * cloud.volumes()[0] / SPACING;
    let residual = section
        .iter()
        .map(|&i| flow[i].abs() / scale)
        .fold(0.0, f64::max);
    ((heat / (-45.0 * volume) - 1.0).abs(), residual)
}

/// Returns the points of layers as deep as the horizon at both ends of a body.
fn ends(body: &DiffusionBody, axis: [f64; 3]) -> Vec<u32> {
    let cloud = &body.cloud;
    let along = |i: usize| (0..3).map(|c| axis[c] * cloud.point(i)[c]).sum::<f64>();
    let places = (0..cloud.len()).map(along);
    let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
        [a.min(x), b.max(x)]
    });
    let depth = body.horizon - 0.4 * SPACING;
    let is_in_layer = |i: &u32| {
        let x = along(*i as usize);
        x < low + depth || x > high - depth
    };
    (0..cloud.len() as u32).filter(is_in_layer).collect()
}

#[test]
fn thin_strips_and_rods_conduct_the_heat_of_fourier_along_their_axis() {
    let conical = Influence {
        function: InfluenceFunction::Conical,
        acts_on: ActsOn::Stretch,
    };
    for ratio in [2.0, 3.0, 4.0] {
        for influence in [Influence::default(), conical.clone()] {
            for thickness in [1, 2, 3, 5, 10] {
                let long = 8 * ratio as usize + 8;
                let mut bodies = vec![
                    (vec![long, thickness], [1.0, 0.0, 0.0]),
                    (vec![thickness, long], [0.0, 1.0, 0.0]),
                ];
                if thickness <= 5 && ratio < 4.0 {
                    bodies.push((vec![long, thickness, thickness], [1.0, 0.0, 0.0]));
                    bodies.push((vec![2, thickness, long], [0.0, 0.0, 1.0]));
                }
                for (counts, axis) in bodies {
                    let mut body = DiffusionBody {
                        influence: influence.clone(),
                        ..corrected(cells(&counts), ratio)
                    };
                    body.prescribed = ends(&body, axis);
                    for on_list in [false, true] {
                        let (error, residual) = errors(&body, axis, on_list);
                        assert!(
                            error < ITERATION && residual < 1e-9,
                            "{counts:?}, horizon ratio {ratio}, list {on_list}: {error:e}, {residual:e}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn thick_plates_and_blocks_conduct_the_heat_of_fourier_along_every_axis() {
    for (counts, axis) in [
        (vec![40, 20], [1.0, 0.0, 0.0]),
        (vec![40, 20], [0.0, 1.0, 0.0]),
        (vec![24, 14, 14], [1.0, 0.0, 0.0]),
    ] {
        let mut free_side = corrected(cells(&counts), 3.0);
        free_side.prescribed = ends(&free_side, axis);
        let (error, residual) = errors(&free_side, axis, false);
        assert!(
            error < ITERATION && residual < 1e-9,
            "{counts:?}: {error:e}, {residual:e}"
        );
    }
}

#[test]
fn a_strip_that_is_not_parallel_to_the_axes_conducts_the_heat_of_fourier() {
    let (sine, cosine) = 0.53_f64.sin_cos();
    for rows in [1u32, 3] {
        let points: Vec<[f64; 3]> = (0..rows)
            .flat_map(|row| (0..40).map(move |k| [f64::from(k), f64::from(row), 0.0]))
            .map(|[x, y, _]| [x * cosine - y * sine, x * sine + y * cosine, 0.0])
            .map(|point| point.map(|x| x * SPACING))
            .collect();
        let listed = ListedPoints {
            volumes: vec![SPACING.powi(3); points.len()],
            blocks: vec![1; points.len()],
            positions: points,
        };
        let cloud = Arc::new(listed.cloud(2, SPACING).unwrap());
        let on_axes = corrected(cells(&[40, rows as usize]), 3.0);
        let mut tilted = corrected(cloud, 3.0);
        tilted.prescribed = ends(&tilted, [cosine, sine, 0.0]);
        // The pair conductivity of listed points is calibrated with the continuum, which the correction of the strip replaces.
        let (error, residual) = errors(&tilted, [cosine, sine, 0.0], true);
        assert!(
            error < ITERATION && residual < 1e-9,
            "{rows} rows: {error:e}, {residual:e}"
        );
        let (error, _) = errors(&on_axes, [1.0, 0.0, 0.0], true);
        assert!(error < ITERATION, "{error:e}");
    }
}

#[test]
fn layers_of_prescribed_values_as_deep_as_the_horizon_are_exact_for_linear_fields() {
    for (counts, gradient) in [
        (vec![40], [700.0, 0.0, 0.0]),
        (vec![24, 3], [700.0, 0.0, 0.0]),
        (vec![24, 20], [700.0, 0.0, 0.0]),
        (vec![18, 4, 2], [700.0, 0.0, 0.0]),
        (vec![18, 18], [700.0, -300.0, 0.0]),
        (vec![12, 12, 12], [700.0, -300.0, 150.0]),
    ] {
        let cloud = cells(&counts);
        let mut body = corrected(cloud.clone(), 3.0);
        let is_prescribed = |i: &u32| {
            (0..counts.len()).any(|c| {
                let x = cloud.point(*i as usize)[c] / SPACING;
                gradient[c] != 0.0 && (x < 3.0 || x > counts[c] as f64 - 3.0)
            })
        };
        body.prescribed = (0..cloud.len() as u32).filter(is_prescribed).collect();
        let free: Vec<usize> = (0..cloud.len())
            .filter(|&i| !is_prescribed(&(i as u32)))
            .collect();
        assert!(!free.is_empty());
        let values: Vec<f64> = (0..cloud.len())
            .map(|i| (0..3).map(|c| gradient[c] * cloud.point(i)[c]).sum())
            .collect();
        let diffusion = body.build().unwrap();
        let flow = flow(&diffusion, &values);
        let scale = diffusion.diagonal()[free[0]] * 0.7;
        for i in free {
            assert!(
                flow[i].abs() < 1e-9 * scale,
                "{counts:?}: {:e} of {scale:e}",
                flow[i]
            );
        }
    }
}
