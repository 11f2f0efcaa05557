//! Reflection of plane waves by a layer, in continuous time.

use nalgebra::{DMatrix, DVector};
use rustfft::num_complex::Complex;

use super::sides::OpenOptions;
use super::weights::LatticeWeights;
use crate::absorbing::roots::eigenvalues;

type C = Complex<f64>;
type Matrix = [[C; 2]; 2];

const ZERO: C = C { re: 0.0, im: 0.0 };
const I: C = C { re: 0.0, im: 1.0 };

/// A plane wave of an infinite lattice that meets a layer at the side +x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IncidentWave {
    /// Wavelength, in cells.
    pub wavelength: f64,
    /// Angle between its wave vector and the normal of the side, rad.
    pub angle: f64,
    /// Whether the wave is the transverse one.
    pub is_shear: bool,
}

/// A wave of the lattice before the layer with the frequency and tangential wavenumber of the incident wave.
struct Mode {
    /// Factor per cell along x.
    z: C,
    /// Polarisation.
    shape: [C; 2],
    /// Energy flux outwards per square amplitude, up to a common factor; zero if the wave decays.
    flux: f64,
}

/// The lattice for one frequency and tangential wavenumber, in units of c_P/Δx.
struct Waves {
    reach: isize,
    /// Σ_y W_{x,y} e^{i k_y y} by x.
    columns: Vec<Matrix>,
    /// Σ W.
    total: [[f64; 2]; 2],
    omega: f64,
    ky: f64,
}

impl IncidentWave {
    /// Returns the reflection coefficient of a layer of `cells` cells: the root of the energy flux of all reflected waves
    /// relative to that of the incident wave. The half-plane before the layer is infinite and time is continuous;
    /// `None` if the wave does not move towards the layer.
    pub fn reflection(
        &self,
        weights: &LatticeWeights,
        options: &OpenOptions,
        cells: usize,
    ) -> Option<f64> {
        let k = 2.0 * std::f64::consts::PI / self.wavelength;
        let [kx, ky] = [k * self.angle.cos(), k * self.angle.sin()];
        let scale = weights.longitudinal_speed(0).powi(-2);
        let (square, shape) = polarised(weights, scale, [kx, ky], self.is_shear)?;
        let waves = Waves::new(weights, scale, square.sqrt(), ky);
        let incident = waves.mode(C::from_polar(1.0, kx), shape.map(C::from), weights, scale);
        if incident.flux <= 0.0 {
            return None;
        }
        let reflected = waves.outgoing(weights, scale);
        let amplitudes = waves.amplitudes(&incident, &reflected, options, cells)?;
        let flux: f64 = reflected
            .iter()
            .zip(&amplitudes)
            .map(|(mode, a)| -mode.flux * a.norm_sqr())
            .sum();
        Some((flux / incident.flux).max(0.0).sqrt())
    }
}

/// Λ(k) = Σ W (1 − cos k·ξ), in units of c_P/Δx, and its derivative with respect to k_x.
fn dynamic(weights: &LatticeWeights, scale: f64, [kx, ky]: [f64; 2]) -> [[[f64; 2]; 2]; 2] {
    let mut sums = [[[0.0; 2]; 2]; 2];
    for ([x, y], weight) in weights.shifts() {
        let phase = kx * x as f64 + ky * y as f64;
        for a in 0..2 {
            for b in 0..2 {
                sums[0][a][b] += scale * weight[a][b] * (1.0 - phase.cos());
                sums[1][a][b] += scale * weight[a][b] * x as f64 * phase.sin();
            }
        }
    }
    sums
}

/// Returns ω² and the polarisation of a plane wave.
fn polarised(
    weights: &LatticeWeights,
    scale: f64,
    k: [f64; 2],
    is_shear: bool,
) -> Option<(f64, [f64; 2])> {
    let [[[a, b], [_, d]], _] = dynamic(weights, scale, k);
    let (mean, half) = (0.5 * (a + d), (0.5 * (a - d)).hypot(b));
    let squares = [mean - half, mean + half];
    let vector = |square: f64| {
        // The larger of the two rows of Λ − ω² determines the vector.
        let [first, second] = [[b, square - a], [square - d, b]];
        let size = |v: [f64; 2]| v[0].hypot(v[1]);
        let larger = if size(first) > size(second) {
            first
        } else {
            second
        };
        match size(larger) > 0.0 {
            true => larger.map(|x| x / size(larger)),
            false => [1.0, 0.0],
        }
    };
    let along = |square: f64| {
        let v = vector(square);
        (v[0] * k[0] + v[1] * k[1]).abs()
    };
    // The longitudinal wave moves more along its wave vector than the other one.
    let is_longitudinal = |square: f64, other: f64| along(square) >= along(other);
    let [low, high] = squares;
    let square = match is_longitudinal(high, low) != is_shear {
        true => high,
        false => low,
    };
    (square > 0.0).then(|| (square, vector(square)))
}

impl Waves {
    fn new(weights: &LatticeWeights, scale: f64, omega: f64, ky: f64) -> Self {
        let reach = weights.reach() as isize;
        let mut columns = vec![[[ZERO; 2]; 2]; 2 * weights.reach() + 1];
        let mut total = [[0.0; 2]; 2];
        for ([x, y], weight) in weights.shifts() {
            let phase = C::from_polar(scale, ky * y as f64);
            for a in 0..2 {
                for b in 0..2 {
                    columns[(x + reach) as usize][a][b] += weight[a][b] * phase;
                    total[a][b] += scale * weight[a][b];
                }
            }
        }
        Self {
            reach,
            columns,
            total,
            omega,
            ky,
        }
    }

    /// The coefficients B_p of P(z) = Σ_p B_p z^p = z^K (Σ_x C_x z^x − Σ W + ω²).
    fn polynomial(&self) -> Vec<Matrix> {
        let mut all = self.columns.clone();
        let middle = &mut all[self.reach as usize];
        for a in 0..2 {
            for b in 0..2 {
                let square = if a == b { self.omega * self.omega } else { 0.0 };
                middle[a][b] += square - self.total[a][b];
            }
        }
        all
    }

    fn mode(&self, z: C, shape: [C; 2], weights: &LatticeWeights, scale: f64) -> Mode {
        /// Distance from the unit circle of waves that do not decay.
        const NEAR: f64 = 1e-7;
        let flux = match (z.norm() - 1.0).abs() < NEAR {
            false => 0.0,
            true => {
                let [_, slope] = dynamic(weights, scale, [z.arg(), self.ky]);
                let term = |a: usize, b: usize| (shape[a].conj() * slope[a][b] * shape[b]).re;
                term(0, 0) + term(0, 1) + term(1, 0) + term(1, 1)
            }
        };
        Mode { z, shape, flux }
    }

    /// The waves that leave towards −x or decay in this direction. With z = z₀ + 1/μ the polynomial has a regular leading
    /// coefficient P(z₀), although the bonds of the largest reach do not act along y.
    fn outgoing(&self, weights: &LatticeWeights, scale: f64) -> Vec<Mode> {
        /// Waves that decay faster vanish a few nodes before the layer.
        const FASTEST: f64 = 1e3;
        let polynomial = self.polynomial();
        let degree = polynomial.len() - 1;
        let centre = C::new(0.31, 0.47);
        // P(z₀ + ζ) = Σ_q T_q ζ^q by repeated division.
        let mut shifted = polynomial.clone();
        for q in 0..degree {
            for p in (q..degree).rev() {
                for a in 0..2 {
                    for b in 0..2 {
                        let above = shifted[p + 1][a][b];
                        shifted[p][a][b] += centre * above;
                    }
                }
            }
        }
        let [[a, b], [c, d]] = shifted[0];
        let determinant = a * d - b * c;
        let inverse = [
            [d / determinant, -b / determinant],
            [-c / determinant, a / determinant],
        ];
        let size = 2 * degree;
        let mut companion = DMatrix::from_element(size, size, ZERO);
        for k in 0..size - 2 {
            companion[(k, k + 2)] = C::from(1.0);
        }
        // T_0 μ^n + T_1 μ^(n−1) + … + T_n = 0
        for (q, block) in shifted.iter().enumerate().skip(1) {
            for a in 0..2 {
                for b in 0..2 {
                    let product = inverse[a][0] * block[0][b] + inverse[a][1] * block[1][b];
                    companion[(size - 2 + a, 2 * (degree - q) + b)] = -product;
                }
            }
        }
        let roots = eigenvalues(companion).into_iter();
        let roots = roots
            .filter(|mu| mu.norm() > 0.1 / FASTEST)
            .map(|mu| centre + mu.inv());
        let modes = roots.map(|z| self.mode(z, null_vector(&polynomial, z), weights, scale));
        let leaves = |mode: &Mode| match mode.flux == 0.0 {
            true => mode.z.norm() > 1.0 && mode.z.norm() < FASTEST,
            false => mode.flux < 0.0,
        };
        modes.filter(leaves).collect()
    }

    /// Solves for the amplitudes of the reflected waves at node −s.
    fn amplitudes(
        &self,
        incident: &Mode,
        reflected: &[Mode],
        options: &OpenOptions,
        cells: usize,
    ) -> Option<Vec<C>> {
        let (reach, cells) = (self.reach, cells as isize);
        let (start, modes) = (2 * reach, reflected.len());
        let shifts = Shifts::new(reach, cells, options, self.omega);
        let friction = |n: isize| match (1..=cells).contains(&n) {
            true => options.filter_at(n, cells as usize),
            false => 0.0,
        };
        let first = -start - reach + 1;
        let rows = 2 * (cells - first + 1) as usize;
        let unknowns = modes + 2 * (cells + start) as usize;
        let mut matrix = DMatrix::from_element(rows, unknowns, ZERO);
        let mut right = DVector::from_element(rows, ZERO);
        // Adds coefficient × u_p[b] to a row.
        let mut add = |row: usize, p: isize, b: usize, coefficient: C| {
            if p > cells || coefficient == ZERO {
                return;
            }
            if p > -start {
                let column = modes + 2 * (p + start - 1) as usize + b;
                matrix[(row, column)] += coefficient;
                return;
            }
            let power = (p + start) as i32;
            for (k, mode) in reflected.iter().enumerate() {
                matrix[(row, k)] += coefficient * mode.z.powi(power) * mode.shape[b];
            }
            right[row] -= coefficient * incident.z.powi(power) * incident.shape[b];
        };
        const D: [f64; 5] = [1.0 / 16.0, -4.0 / 16.0, 6.0 / 16.0, -4.0 / 16.0, 1.0 / 16.0];
        let across = (0.5 * self.ky).sin().powi(8);
        for n in first..=cells {
            let row = 2 * (n - first) as usize;
            for a in 0..2 {
                for b in 0..2 {
                    let square = if a == b { self.omega * self.omega } else { 0.0 };
                    add(row + a, n, b, C::from(square - self.total[a][b]));
                    for j in -reach..=reach {
                        let weight = self.columns[(j + reach) as usize][a][b];
                        shifts.each(n, j, |p, share| add(row + a, p, b, weight * share));
                    }
                }
                // The acceleration −F v with v = −i ω u.
                let factor = I * self.omega;
                add(row + a, n, a, factor * friction(n) * across);
                for q in -2..=2_isize {
                    for p in -2..=2_isize {
                        let product = D[(q + 2) as usize] * D[(p + 2) as usize];
                        add(row + a, n + q + p, a, factor * friction(n + q) * product);
                    }
                }
            }
        }
        let solution = matrix.svd(true, true).solve(&right, 1e-14).ok()?;
        Some(solution.iter().take(modes).copied().collect())
    }
}

/// The continued shifts as combinations of the displacements.
struct Shifts {
    reach: isize,
    cells: isize,
    /// Coefficients of U_n^j at the nodes −K … N, by n from 0 to N and j from −K to K.
    rows: Vec<Vec<C>>,
}

impl Shifts {
    fn new(reach: isize, cells: isize, options: &OpenOptions, omega: f64) -> Self {
        let width = (cells + reach + 1) as usize;
        let mut shifts = Self {
            reach,
            cells,
            rows: vec![vec![ZERO; width]; ((cells + 1) * (2 * reach + 1)) as usize],
        };
        let mut set = |n: isize, j: isize, p: isize| {
            let place = shifts.place(n, j);
            shifts.rows[place][(p + reach) as usize] = C::from(1.0);
        };
        for n in 0..=cells {
            set(n, 0, n);
        }
        for j in -reach..0 {
            set(0, j, j);
        }
        // ψ = κ (U_{n+1}^{j+1} + U_n^{j+1} − U_{n+1}^j − U_n^j)
        let kappa: Vec<C> = options
            .profile(cells as usize)
            .iter()
            .map(|sigma| C::from(0.5 * sigma) / C::new(options.decay, -omega))
            .collect();
        for n in (0..cells).rev() {
            for j in 0..reach {
                let terms = [
                    (n + 1, j, 1.0, 0.0),
                    (n + 1, j + 1, 0.0, -1.0),
                    (n, j, 0.0, 1.0),
                ];
                shifts.solve((n, j + 1), terms, kappa[n as usize]);
            }
        }
        for n in 0..cells {
            for j in (-reach..0).rev() {
                let terms = [
                    (n, j + 1, 1.0, 0.0),
                    (n + 1, j + 1, 0.0, 1.0),
                    (n, j, 0.0, -1.0),
                ];
                shifts.solve((n + 1, j), terms, kappa[n as usize]);
            }
        }
        shifts
    }

    fn place(&self, n: isize, j: isize) -> usize {
        (n * (2 * self.reach + 1) + j + self.reach) as usize
    }

    /// Sets (1 + κ) U to the sum of other shifts times (1 + κ) a + κ b.
    fn solve(&mut self, (n, j): (isize, isize), terms: [(isize, isize, f64, f64); 3], kappa: C) {
        let mut sum = vec![ZERO; self.rows[0].len()];
        for (n, j, plain, times_kappa) in terms {
            let factor = plain + times_kappa * kappa / (1.0 + kappa);
            for (sum, term) in sum.iter_mut().zip(&self.rows[self.place(n, j)]) {
                *sum += factor * term;
            }
        }
        let place = self.place(n, j);
        self.rows[place] = sum;
    }

    /// Calls `visit(node, coefficient)` for the displacements of which U_n^j consists.
    fn each(&self, n: isize, j: isize, mut visit: impl FnMut(isize, C)) {
        // Nodes before the interface see what the interface sees.
        let before = if n < 0 && j > 0 { j.min(-n) } else { 0 };
        let (n, j) = (n + before, j - before);
        if n < 0 || j == 0 {
            return visit(n + j, C::from(1.0));
        }
        let nodes = -self.reach..=self.cells;
        for (p, &share) in nodes.zip(&self.rows[self.place(n, j)]) {
            if share != ZERO {
                visit(p, share);
            }
        }
    }
}

/// A vector that the polynomial maps to zero at one of its roots.
fn null_vector(polynomial: &[Matrix], z: C) -> [C; 2] {
    let mut sum = [[ZERO; 2]; 2];
    for block in polynomial.iter().rev() {
        for a in 0..2 {
            for b in 0..2 {
                sum[a][b] = sum[a][b] * z + block[a][b];
            }
        }
    }
    let [[a, b], [c, d]] = sum;
    let size = |v: [C; 2]| v[0].norm_sqr() + v[1].norm_sqr();
    let [first, second] = [[-b, a], [d, -c]];
    let larger = if size(first) > size(second) {
        first
    } else {
        second
    };
    larger.map(|x| x / size(larger).sqrt())
}
