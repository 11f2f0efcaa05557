//! Measures the spectrum of a time-domain run that starts from noise.

use crate::DispersionError;
use std::f64::consts::TAU;
use std::sync::Arc;

use pericles_waves::fourier::{Complex64, complex_plans};
use rayon::prelude::*;

use super::super::contour::Contour;
use super::super::lattice::BondLattice;
use super::super::modes::verlet_frequency;
use super::super::vector::Vector;
use super::super::zone::stability;
use super::{CubeTransform, PeriodicForce};
use pericles::noise::noise;
use pericles::space::{Grid, Shape};
use pericles::time::{State, VelocityVerlet};
use pericles::{Control, Simulation, SimulationError};
use pericles::{PericlesError, Result};
use pericles::{PointScalar, System};

/// Parameters of a spectrum measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectrumRun {
    /// Points along every axis of the periodic box; even, so that the zone border is among its waves.
    pub nodes: usize,
    /// Number of time steps, each one sample.
    pub steps: usize,
    /// Time step, s.
    pub dt: f64,
    /// Random seed.
    pub seed: u64,
}

/// Spectrum of one branch at one wave vector.
#[derive(Debug, Clone, PartialEq)]
pub struct BranchSpectrum {
    /// Power per spectral line; lines are multiples of [`MeasuredSpectrum::line`], from zero.
    pub power: Vec<f64>,
    /// Peak frequency, by a parabola through the logarithms of the highest line and its neighbours, 1/s.
    pub peak: f64,
    /// Time-discrete frequency from the analysis, 1/s.
    pub expected: f64,
}

/// All branches at one wave vector of the box.
#[derive(Debug, Clone, PartialEq)]
pub struct WaveSpectrum {
    /// Arc length along the contour, rad/m.
    pub abscissa: f64,
    /// Wave vector, rad/m.
    pub k: Vector,
    /// Branches, in the order of the contour's branches.
    pub branches: Vec<BranchSpectrum>,
}

/// Measured spectrum.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSpectrum {
    /// Spacing of spectral lines, 2π/(steps dt), 1/s.
    pub line: f64,
    /// Wave vectors of the box on the contour, without k = 0, corners once.
    pub waves: Vec<WaveSpectrum>,
}

/// The main lobe of the Hann window spans two lines on each side: a peak closer to zero than four lines overlaps
/// with its mirror image.
const OVERLAP_LINES: f64 = 4.0;

impl MeasuredSpectrum {
    /// Returns the largest |peak − expected|, in lines, of all branches whose frequency exceeds four lines, and the
    /// number of these branches.
    pub fn worst_deviation(&self) -> (f64, usize) {
        let resolved = self
            .waves
            .iter()
            .flat_map(|wave| &wave.branches)
            .filter(|branch| branch.expected > OVERLAP_LINES * self.line);
        resolved.fold((0.0, 0), |(worst, count), branch| {
            let deviation = (branch.peak - branch.expected).abs() / self.line;
            // A NaN peak must count as a deviation.
            let worst = if deviation <= worst { worst } else { deviation };
            (worst, count + 1)
        })
    }
}

/// Runs a periodic box from random initial displacements and measures the frequency of every branch at every wave
/// vector of the contour.
///
/// Each step is transformed in space and projected on the polarisations of the contour, so that each time series
/// contains one frequency. A Hann window, a transform in time and a parabola through the logarithm of the power
/// determine it to about a hundredth of a line. The contour must have fixed polarisations
/// ([`Contour::irreducible`]). Cost: `steps` force evaluations; memory 16 bytes · steps per branch and wave vector.
///
/// # Errors
/// An odd number of points; a contour that needs tracking or contains no waves of the box; an unstable lattice or
/// time step.
pub fn measure(
    lattice: &BondLattice,
    contour: &Contour,
    run: SpectrumRun,
) -> std::result::Result<MeasuredSpectrum, SimulationError> {
    let waves = box_waves(lattice, contour, run.nodes)?;
    let found = stability(lattice);
    if !found.is_stable() || run.dt > found.dt_max() {
        return Err(PericlesError::UnstableStep {
            dt: run.dt,
            omega: found.omega_max,
            limit: if found.is_stable() {
                found.dt_max()
            } else {
                0.0
            },
            scheme: "velocity-verlet",
        }
        .into());
    }
    let series = swing(lattice, &waves, run)?;
    let line = TAU / (run.steps as f64 * run.dt);
    let spectra: Vec<(Vec<f64>, f64)> = series
        .into_par_iter()
        .map(|series| {
            let power = power(series);
            let peak = peak(&power) * line;
            (power, peak)
        })
        .collect();
    let mut spectra = spectra.into_iter();
    let waves = waves
        .into_iter()
        .map(|wave| WaveSpectrum {
            abscissa: wave.abscissa,
            k: wave.k,
            branches: wave
                .polarisations
                .iter()
                .map(|e| {
                    let omega = lattice.omega_squared(wave.k, *e).max(0.0).sqrt();
                    let (power, peak) = spectra.next().unwrap_or_default();
                    BranchSpectrum {
                        power,
                        peak,
                        expected: verlet_frequency(omega, run.dt).unwrap_or(f64::NAN),
                    }
                })
                .collect(),
        })
        .collect();
    Ok(MeasuredSpectrum { line, waves })
}

/// Wave of the box on the contour.
struct BoxWave {
    abscissa: f64,
    k: Vector,
    /// Index in the transform.
    entry: usize,
    polarisations: Vec<Vector>,
}

fn box_waves(lattice: &BondLattice, contour: &Contour, nodes: usize) -> Result<Vec<BoxWave>> {
    if !nodes.is_multiple_of(2) || nodes < 4 {
        return Err(PericlesError::OutOfRange {
            quantity: "the number of points along an axis of the periodic box",
            value: nodes as f64,
            allowed: "an even number of at least 4",
        });
    }
    let unit = |c: usize| TAU / (nodes as f64 * lattice.spacing()[c]);
    let number = |k: Vector| -> [i64; 3] {
        std::array::from_fn(|c| {
            if c < lattice.dimension() {
                (k[c] / unit(c)).round() as i64
            } else {
                0
            }
        })
    };
    let mut waves = Vec::new();
    let mut start = 0.0;
    for segment in &contour.segments {
        let Some(polarisations) = &segment.polarisation else {
            return Err(DispersionError::TuningChoice {
                choice: "a measured spectrum",
                with: "on a contour whose polarisations are not determined by symmetry",
                allowed: "allowed: the border of the irreducible zone",
            }
            .into());
        };
        let (from, to) = (number(segment.from), number(segment.to));
        let steps = (0..3).map(|c| (to[c] - from[c]).abs()).max().unwrap_or(0);
        for step in 1..=steps {
            let m: [i64; 3] =
                std::array::from_fn(|c| from[c] + (to[c] - from[c]) * step / steps.max(1));
            if m == [0; 3] {
                continue;
            }
            let entry = (0..lattice.dimension()).rev().fold(0, |entry, c| {
                entry * nodes + m[c].rem_euclid(nodes as i64) as usize
            });
            waves.push(BoxWave {
                abscissa: start + segment.length() * step as f64 / steps as f64,
                k: std::array::from_fn(|c| {
                    if c < lattice.dimension() {
                        m[c] as f64 * unit(c)
                    } else {
                        0.0
                    }
                }),
                entry,
                polarisations: polarisations.clone(),
            });
        }
        start += segment.length();
    }
    Ok(waves)
}

/// Runs the box and returns the amplitudes of every wave and branch, step by step.
fn swing(
    lattice: &BondLattice,
    waves: &[BoxWave],
    run: SpectrumRun,
) -> std::result::Result<Vec<Vec<Complex64>>, SimulationError> {
    let (n, dimension) = (run.nodes, lattice.dimension());
    // The spacing may differ between the axes; only the points enter the run.
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: vec![n as f64; dimension],
        },
        spacing: 1.0,
        section: 1.0,
        holes: Vec::new(),
    };
    let cloud = Arc::new(grid.points()?);
    let force = PeriodicForce::new(lattice, n, 1.0, 1.0)?;
    let system = System::new(
        Arc::clone(&cloud),
        Box::new(force),
        PointScalar::Uniform(1.0),
    )?;
    let points = cloud.len();
    let mut state = State::at_rest(dimension * points);
    state.u = noise(dimension * points, run.seed);
    for component in state.u.chunks_mut(points) {
        let mean = component.iter().sum::<f64>() / points as f64;
        component.iter_mut().for_each(|u| *u -= mean);
    }
    let branches = waves.iter().map(|wave| wave.polarisations.len()).sum();
    let mut series: Vec<Vec<Complex64>> = vec![Vec::with_capacity(run.steps); branches];
    let mut transform = CubeTransform::new(n, dimension);
    let mut fields = vec![vec![Complex64::new(0.0, 0.0); points]; dimension];
    let mut record = |u: &[f64]| {
        for (field, component) in fields.iter_mut().zip(u.chunks(points)) {
            for (z, u) in field.iter_mut().zip(component) {
                *z = Complex64::new(*u, 0.0);
            }
            transform.forward(field);
        }
        let mut place = 0;
        for wave in waves {
            for e in &wave.polarisations {
                let terms = fields.iter().zip(e);
                series[place].push(terms.map(|(field, e)| field[wave.entry] * e).sum());
                place += 1;
            }
        }
    };
    record(&state.u);
    // One step more than samples: the last one is not observed.
    let mut simulation = Simulation::new(
        system,
        Box::new(VelocityVerlet),
        state,
        run.dt,
        run.steps.max(1) as u64,
    )?;
    simulation.run(|simulation| {
        record(&simulation.state().u);
        Control::Continue
    })?;
    Ok(series)
}

/// Power of a series in lines 0 … half its length; both signs of the frequency combined.
fn power(mut series: Vec<Complex64>) -> Vec<f64> {
    let n = series.len();
    for (t, z) in series.iter_mut().enumerate() {
        *z *= 0.5 - 0.5 * (TAU * t as f64 / n as f64).cos();
    }
    let [forward, _] = complex_plans(n);
    forward.process(&mut series);
    (0..=n / 2)
        .map(|f| {
            let mirror = (n - f) % n;
            let twin = if mirror == f {
                0.0
            } else {
                series[mirror].norm_sqr()
            };
            series[f].norm_sqr() + twin
        })
        .collect()
}

/// Position of the peak, in lines.
fn peak(power: &[f64]) -> f64 {
    let inside = 1..power.len().saturating_sub(1);
    let Some(top) = inside.max_by(|a, b| power[*a].total_cmp(&power[*b])) else {
        return f64::NAN;
    };
    let [a, b, c] = [power[top - 1], power[top], power[top + 1]].map(f64::ln);
    let shift = 0.5 * (a - c) / (a - 2.0 * b + c);
    top as f64 + if shift.abs() <= 1.0 { shift } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn peak_of_a_pure_tone_is_within_two_hundredths_of_a_line() {
        for frequency in [20.0, 37.31, 100.5] {
            let n = 1024;
            let tone = (0..n)
                .map(|t| Complex64::new((TAU * frequency * t as f64 / n as f64).cos(), 0.0))
                .collect();
            let found = peak(&power(tone));
            assert!((found - frequency).abs() < 0.02, "{found} {frequency}");
        }
    }

    #[test]
    fn box_waves_on_the_square_contour_are_found_once() {
        let lattice = BondLattice::new(&[0.5; 3], 0.5, |_, _, _| 1.0).unwrap();
        let contour = Contour::irreducible(&lattice);
        let waves = box_waves(&lattice, &contour, 8).unwrap();
        // Four steps per segment, without the last one back at Γ.
        assert_eq!(waves.len(), 15);
        let corner = &waves[11];
        assert_eq!(corner.entry, 4 + 8 * (4 + 8 * 4));
        assert!((corner.k[2] - PI / 0.5).abs() < 1e-12);
        assert!((corner.abscissa - 3.0 * PI / 0.5).abs() < 1e-12);
        assert!(box_waves(&lattice, &contour, 7).is_err());
    }
}
