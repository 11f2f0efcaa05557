//! Thin bodies with surface corrections compared with the modulus of their material.

use std::sync::Arc;

use crate::common::{boxed, material};
use pericles::family::VolumeCorrection;
use pericles::material::{Calibration, Fracture, PairLaw, StressState, SurfaceCorrection};
use pericles::operator::{BondBody, BondForm, CompositeBody, Force, PointSubset};
use pericles::space::PointCloud;

const DX: f64 = 1e-3;
const YOUNG: f64 = 72e9;

/// The force of a body with a surface correction.
fn corrected(
    cloud: &Arc<PointCloud>,
    state: StressState,
    correction: SurfaceCorrection,
) -> Box<dyn Force> {
    let mut material = material(
        2440.0,
        YOUNG,
        3.0 * DX,
        VolumeCorrection::Extended,
        Fracture::Unbreakable,
    );
    material.law = PairLaw::Linear;
    material.modulus.calibration = Calibration::Lattice;
    let constants = material.constants(cloud, state).unwrap();
    let composite = CompositeBody {
        body: BondBody::new(cloud, &material, &constants),
        classes: None,
        correction,
        softening: None,
        strengths: &[],
    };
    composite.operator(BondForm::List).unwrap().operator
}

/// Young's modulus in a tension test along an axis; the three outermost layers of cells at each end have a
/// prescribed displacement.
fn tension(size: &[f64], state: StressState, axis: usize, correction: SurfaceCorrection) -> f64 {
    let cloud = boxed([0.0; 3], size, DX, 1.0);
    let operator = corrected(&cloud, state, correction);
    let (n, dimension, length) = (cloud.len(), cloud.dimension(), size[axis]);
    let along = cloud.axis(axis);
    let lower = |i: usize| along[i] < 3.0 * DX;
    let upper = |i: usize| along[i] > length - 3.0 * DX;
    let free: Vec<bool> = (0..dimension * n)
        .map(|k| k / n != axis || !(lower(k % n) || upper(k % n)))
        .collect();
    let mut u = vec![0.0; dimension * n];
    for i in 0..n {
        u[axis * n + i] = 1e-6 * along[i];
    }
    let force = |u: &[f64]| {
        let mut force = vec![0.0; u.len()];
        operator.add_force(0.0, u, PointSubset::All, &mut force);
        force
    };
    relax(&mut u, &free, &force);
    let cell = cloud.volumes()[0];
    let reaction: f64 = (0..n)
        .filter(|&i| lower(i))
        .map(|i| force(&u)[axis * n..][i] * cell)
        .sum();
    // Strain of the middle third.
    let section_of = |place: f64| {
        let near: Vec<f64> = (0..n)
            .filter(|&i| (along[i] - place).abs() < 0.6 * DX)
            .map(|i| u[axis * n + i])
            .collect();
        near.iter().sum::<f64>() / near.len() as f64
    };
    let (a, b) = (length / 3.0, 2.0 * length / 3.0);
    let strain = (section_of(b) - section_of(a)) / (b - a);
    let area = cell * n as f64 / length;
    reaction / (area * strain)
}

/// Conjugate gradients on the free unknowns.
fn relax(u: &mut [f64], free: &[bool], force: &dyn Fn(&[f64]) -> Vec<f64>) {
    let mask = |mut x: Vec<f64>| {
        for (x, free) in x.iter_mut().zip(free) {
            *x *= f64::from(u8::from(*free));
        }
        x
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut r = mask(force(u));
    let (mut p, start) = (r.clone(), dot(&r, &r));
    let mut square = start;
    for _ in 0..2000 {
        if square < 1e-16 * start {
            return;
        }
        let q = mask(force(&p));
        let step = -square / dot(&p, &q);
        for k in 0..u.len() {
            u[k] += step * p[k];
            r[k] += step * q[k];
        }
        let next = dot(&r, &r);
        for k in 0..u.len() {
            p[k] = r[k] + next / square * p[k];
        }
        square = next;
    }
    panic!("the equilibrium was not found");
}

#[test]
fn thin_bars_and_plates_have_the_modulus_of_their_material() {
    let cells = |counts: &[f64]| counts.iter().map(|n| n * DX).collect::<Vec<_>>();
    let bodies = [
        // Bars 2 and 3 cells thick along every axis, plates 3 cells thick, strips 3 cells wide.
        (StressState::Spatial, cells(&[30.0, 3.0, 3.0]), 0),
        (StressState::Spatial, cells(&[3.0, 30.0, 3.0]), 1),
        (StressState::Spatial, cells(&[3.0, 3.0, 30.0]), 2),
        (StressState::Spatial, cells(&[30.0, 2.0, 2.0]), 0),
        (StressState::Spatial, cells(&[24.0, 12.0, 3.0]), 0),
        (StressState::Spatial, cells(&[3.0, 12.0, 24.0]), 2),
        (StressState::PlaneStress, cells(&[30.0, 3.0]), 0),
        (StressState::PlaneStress, cells(&[3.0, 30.0]), 1),
    ];
    for (state, size, axis) in bodies {
        let error = |correction| tension(&size, state, axis, correction) / YOUNG - 1.0;
        let (none, energy) = (
            error(SurfaceCorrection::None),
            error(SurfaceCorrection::Energy),
        );
        println!("{state:?} {size:?}: {none:+.3} {energy:+.3}");
        assert!(none < -0.2, "{size:?}: {none}");
        // With two points across, the whole bar is close to a surface.
        let allowed = if size.contains(&(2.0 * DX)) {
            0.08
        } else {
            0.04
        };
        assert!(energy.abs() < allowed, "{size:?}: {energy}");
    }
}

/// Young's modulus of a strip along the diagonal of the grid.
fn oblique_tension(correction: SurfaceCorrection) -> f64 {
    let (length, rows) = (30.0 * 2.0f64.sqrt() * DX, 5);
    let half = 0.5f64.sqrt();
    // Coordinates along and across the strip, m.
    let place = |x: f64, y: f64| [half * (x + y), half * (y - x)];
    let (mut xs, mut ys) = (Vec::new(), Vec::new());
    for x in -4..40 {
        for y in x..x + rows {
            let [along, _] = place(f64::from(x) * DX, f64::from(y) * DX);
            if (0.0..=length).contains(&along) {
                xs.push(f64::from(x) * DX);
                ys.push(f64::from(y) * DX);
            }
        }
    }
    let n = xs.len();
    let positions: Vec<f64> = xs.iter().chain(&ys).copied().collect();
    let cloud = PointCloud::new(2, positions, vec![DX * DX; n], 1.0).unwrap();
    let cloud = Arc::new(cloud);
    let operator = corrected(&cloud, StressState::PlaneStress, correction);
    let along: Vec<f64> = (0..n).map(|i| place(xs[i], ys[i])[0]).collect();
    let (lower, upper) = (4.0 * DX, length - 4.0 * DX);
    // Both ends are stretched uniformly and free to contract.
    let strain = 1e-6;
    let mut u = vec![0.0; 2 * n];
    for i in 0..n {
        let [a, b] = place(xs[i], ys[i]);
        let (a, b) = (strain * a, -strain / 3.0 * b);
        (u[i], u[n + i]) = (half * (a - b), half * (a + b));
    }
    let free: Vec<bool> = (0..2 * n)
        .map(|k| (lower..upper).contains(&along[k % n]))
        .collect();
    let force = |u: &[f64]| {
        let mut force = vec![0.0; u.len()];
        operator.add_force(0.0, u, PointSubset::All, &mut force);
        force
    };
    relax(&mut u, &free, &force);
    let total = force(&u);
    let reaction: f64 = (0..n)
        .filter(|&i| along[i] < lower)
        .map(|i| half * (total[i] + total[n + i]) * DX * DX)
        .sum();
    let moved = |from: f64, to: f64| {
        let near: Vec<f64> = (0..n)
            .filter(|&i| (from..to).contains(&along[i]))
            .map(|i| half * (u[i] + u[n + i]) - strain * along[i])
            .collect();
        near.iter().sum::<f64>() / near.len() as f64
    };
    let third = length / 3.0;
    let window = 2.0 * 2.0f64.sqrt() * DX;
    let strain =
        strain + (moved(2.0 * third, 2.0 * third + window) - moved(third, third + window)) / third;
    // Each diagonal row of points is 1/√2 spacings wide.
    reaction / (f64::from(rows) * half * DX * strain)
}

#[test]
fn oblique_strips_have_the_modulus_of_their_material() {
    let error = |correction| oblique_tension(correction) / YOUNG - 1.0;
    let (none, energy) = (
        error(SurfaceCorrection::None),
        error(SurfaceCorrection::Energy),
    );
    println!("oblique: {none:+.3} {energy:+.3}");
    assert!(none < -0.15, "{none}");
    assert!(energy.abs() < 0.05, "{energy}");
}

#[test]
fn corrected_bonds_exert_opposite_forces() {
    let cloud = boxed([0.0; 3], &[9e-3, 4e-3, 3e-3], DX, 1.0);
    let operator = corrected(&cloud, StressState::Spatial, SurfaceCorrection::Energy);
    let n = cloud.len();
    // A displacement that is not smooth.
    let u: Vec<f64> = (0..3 * n).map(|k| 1e-6 * (k as f64 * 1.7).sin()).collect();
    let mut force = vec![0.0; 3 * n];
    operator.add_force(0.0, &u, PointSubset::All, &mut force);
    for c in 0..3 {
        let component = &force[c * n..(c + 1) * n];
        let (sum, size) = (
            component.iter().sum::<f64>(),
            component.iter().map(|f| f.abs()).sum::<f64>(),
        );
        assert!(sum.abs() < 1e-13 * size, "{sum} {size}");
    }
}
