//! Table 1: the kernels of the Euler–Bernoulli lattice against their closed forms.

use std::f64::consts::PI;

use pericles::PericlesError;
use pericles_run::RunError;
use pericles_waves::absorbing::{
    GhostKernels, LatticeStencil, green_functions, green_functions_closed, trapezoidal_kernels,
};

use super::paper::PAPER;
use crate::row::Row;
use crate::study::{Context, Study};

pub(super) const TABLE_1: Study = Study {
    id: "absorbing-boundaries/table-1",
    paper: PAPER,
    title: "Kernels of the Euler–Bernoulli lattice against their closed forms",
    run: rows,
};

/// The errors at a time: printed, and computed by a separate code with the paper's Runge–Kutta way to the Green functions.
struct Line {
    /// In units of π.
    time: f64,
    printed: [f64; 4],
    verified: [f64; 4],
    /// A misprint: column and the number that the others leave.
    misprint: Option<(usize, f64)>,
}

/// Steps in units of 3π.
const STEPS: [f64; 4] = [500.0, 400.0, 250.0, 200.0];

const LINES: [Line; 4] = [
    Line {
        time: 3.0,
        printed: [9.26e-6, 1.63e-5, 4.79e-5, 7.88e-4],
        verified: [1.240e-5, 1.955e-5, 5.226e-5, 8.515e-5],
        misprint: Some((3, 7.88e-5)),
    },
    Line {
        time: 18.0,
        printed: [9.31e-7, 1.71e-6, 5.92e-6, 1.11e-5],
        verified: [1.228e-6, 2.024e-6, 6.392e-6, 1.180e-5],
        misprint: None,
    },
    Line {
        time: 300.0,
        printed: [3.80e-8, 8.71e-8, 5.15e-7, 1.24e-6],
        verified: [4.41e-8, 9.36e-8, 5.257e-7, 1.256e-6],
        misprint: None,
    },
    Line {
        time: 3000.0,
        printed: [8.51e-9, 2.16e-8, 1.52e-7, 3.93e-7],
        verified: [9.21e-9, 2.239e-8, 1.542e-7, 3.950e-7],
        misprint: None,
    },
];

/// J_n(2t)/t, n = 1 and 2.
fn bessel(t: f64) -> [f64; 2] {
    if t < 1e-8 {
        // J_1(2t)/t → 1, J_2(2t)/t → t/2.
        return [1.0, 0.5 * t];
    }
    [1, 2].map(|n| libm::jn(n, 2.0 * t) / t)
}

/// f_0^1, f_0^2, f_{−1}^1, f_{−1}^2 at a time, with φ_n = (−i)^n n J_n(2t)/t exp(2it): 2 Re φ_1, −φ_1 * φ̄_1, 2 Re φ_2 + φ_1 * φ̄_1, −2 Re φ_2 * φ̄_1. Convolutions by
/// Gauss' rule on panels shorter than an oscillation.
fn closed_forms(t: f64) -> [f64; 4] {
    const PANEL: f64 = 0.25;
    const NODES: [[f64; 2]; 4] = [
        [0.183_434_642_495_649_8, 0.362_683_783_378_362],
        [0.525_532_409_916_329, 0.313_706_645_877_887_3],
        [0.796_666_477_413_626_7, 0.222_381_034_453_374_5],
        [0.960_289_856_497_536_3, 0.101_228_536_290_376_3],
    ];
    let count = (t / PANEL).ceil();
    let half = 0.5 * t / count;
    let [mut plain, mut mixed] = [0.0, 0.0];
    for panel in 0..count as usize {
        let middle = (2 * panel + 1) as f64 * half;
        for [place, weight] in NODES {
            for tau in [middle - half * place, middle + half * place] {
                let ([one, two], [other, _]) = (bessel(tau), bessel(t - tau));
                let phase = 2.0 * (2.0 * tau - t);
                plain += half * weight * one * other * phase.cos();
                mixed += half * weight * 2.0 * two * other * phase.sin();
            }
        }
    }
    let [one, two] = bessel(t);
    [
        2.0 * one * (2.0 * t).sin(),
        -plain,
        plain - 4.0 * two * (2.0 * t).cos(),
        -2.0 * mixed,
    ]
}

/// The largest error of the four kernels at a step.
fn error(kernels: &GhostKernels, dt: f64, step: usize, exact: &[f64; 4]) -> f64 {
    let pairs = kernels.series().iter().zip(exact);
    let apart = pairs.map(|(series, exact)| (series[step] / dt - exact).abs());
    apart.fold(0.0, f64::max)
}

fn rows(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    /// Half a million steps of the last line.
    const LONG: f64 = 1000.0;
    let stencil = LatticeStencil::new(&[4.0, -1.0]).map_err(PericlesError::from)?;
    let lines: Vec<&Line> = LINES
        .iter()
        .filter(|line| context.full || line.time < LONG)
        .collect();
    let exact: Vec<[f64; 4]> = lines
        .iter()
        .map(|line| closed_forms(line.time * PI))
        .collect();
    let end = lines.last().map_or(0.0, |line| line.time);
    let mut rows = Vec::new();
    for (column, parts) in STEPS.into_iter().enumerate() {
        let dt = 3.0 * PI / parts;
        let number = |time: f64| (time / 3.0 * parts).round() as usize;
        let steps = number(end);
        let closed = green_functions_closed(&stencil, dt, steps);
        let historical = trapezoidal_kernels(&stencil, dt, &closed);
        // The ring grows with time, and so does its cost.
        let shorter = lines.iter().rfind(|line| line.time < 100.0);
        let shorter = shorter.map_or(0, |line| number(line.time));
        let green = green_functions(&stencil, dt, shorter, 4);
        let plain = trapezoidal_kernels(&stencil, dt, &green);
        for (line, exact) in lines.iter().zip(&exact) {
            let step = number(line.time);
            let case = format!("t = {}π, dt = 3π/{parts}: largest error", line.time);
            let mut note = match line.misprint.filter(|(at, _)| *at == column) {
                Some((_, value)) => format!("misprint of {value:.2e}; "),
                None => String::new(),
            };
            if step <= shorter {
                let beside = error(&plain, dt, step, exact);
                note += &format!("with exact Green functions {beside:.3e}; ");
            }
            note += "judged by a separate code's number, from which the print is up to a quarter away at the small steps";
            let found = error(&historical, dt, step, exact);
            rows.push(
                Row::new(case, "", Some(found))
                    .printed(line.printed[column])
                    .within_share(line.verified[column], 0.005)
                    .note(note),
            );
        }
    }
    Ok(rows)
}
