//! Natural frequencies and mode shapes.

use pericles::domain::Replicated;
use pericles::{Interrupt, Need, Requirement, Result, System};

use crate::block::{combination, symmetric_products};
use crate::eigen::symmetric_eigen;
use crate::error::StaticsError;
use crate::multigrid::Multigrid;
use crate::rigid::{free_pieces, spread};
use crate::sparse::add_multiple;
use crate::surrogate::Surrogate;
use crate::tangent::{Derivative, stiffness_into};
use crate::unknowns::Unknowns;

/// Number and accuracy of natural modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeOptions {
    /// Number of modes of the lowest frequencies, without rigid-body motions.
    pub count: usize,
    /// Tolerance of the residual |K x − ω² M x| over ω² |M x|, in the norm of the inverse mass matrix. The
    /// relative error of a frequency is of the order of the squared residual.
    pub tolerance: f64,
    /// Largest number of iterations.
    pub iterations: u32,
}

impl Default for ModeOptions {
    fn default() -> Self {
        Self {
            count: 12,
            tolerance: 1e-6,
            iterations: 200,
        }
    }
}

/// A natural mode.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// ω/2π, Hz.
    pub frequency_hz: f64,
    /// Residual, measured like [`ModeOptions::tolerance`].
    pub residual: f64,
    /// Mode shape x: a component-major vector with xᵀ M x = 1 kg m².
    pub shape: Vec<f64>,
}

/// Modes of equal frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeGroup {
    /// Mean frequency, Hz.
    pub frequency_hz: f64,
    /// Number of modes.
    pub multiplicity: usize,
    /// Largest residual.
    pub residual: f64,
}

/// Lowest natural modes of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct NaturalModes {
    /// Modes by ascending frequency.
    pub modes: Vec<Mode>,
    /// Number of rigid-body motions, of frequency zero.
    pub rigid_modes: usize,
    /// Number of products with the stiffness.
    pub products: u64,
    /// Number of iterations.
    pub iterations: u32,
}

/// Relative difference below which frequencies belong to the same group.
const EQUAL: f64 = 1e-6;

impl NaturalModes {
    /// Requirements on a system.
    pub const REQUIREMENTS: &'static [Requirement] = &[
        Requirement::IN_DOUBLES,
        Requirement {
            need: Need::WholeBody,
            reason: "modes are computed on the whole body, but this one is divided among several processes; run it on one process with threads",
        },
        Requirement {
            need: Need::NoBoundaries,
            reason: "absorbing boundaries and damping layers have no undamped modes; remove the boundary",
        },
    ];

    /// Computes the lowest modes about displacement `u` at time t, with the constraints at that time.
    ///
    /// K x = ω² M x with the tangent stiffness K and the masses M is solved by the locally optimal block
    /// preconditioned conjugate gradient method (Knyazev, SIAM J. Sci. Comput. 23, 517, 2001) with the
    /// multigrid preconditioner of static states. Unconstrained rigid-body motions are projected out; points
    /// without bonds are excluded.
    ///
    /// # Errors
    /// [`StaticsError::NoModes`] for a system that does not meet the [requirements](Self::REQUIREMENTS);
    /// [`StaticsError::ModesNotFound`] after too many iterations;
    /// [`PericlesError::Interrupted`](pericles::PericlesError::Interrupted).
    pub fn find(
        options: ModeOptions,
        system: &System,
        (t, u): (f64, &[f64]),
        interrupt: Interrupt<'_>,
    ) -> Result<Self> {
        let unmet = Self::REQUIREMENTS
            .iter()
            .find(|one| !one.need.is_met_by(system));
        if let Some(Requirement { reason, .. }) = unmet {
            return Err(StaticsError::NoModes { reason }.into());
        }
        let mut problem = Problem::new(system, t, u);
        let free = problem.unknowns.len() - problem.rigid.len().min(problem.unknowns.len());
        /// Additional iterated vectors, so that the last requested modes converge as fast as the others.
        const EXTRA: usize = 4;
        let count = options.count.min(free);
        let size = (count + EXTRA).min(free);
        let mut block = Block::start(&mut problem, size);
        for iteration in 1..=options.iterations {
            interrupt.poll()?;
            let residuals = block.residuals(&problem);
            let norms = block.norms(&problem, &residuals);
            let converged = |k: usize| norms[k] <= options.tolerance;
            if (0..count).all(converged) {
                return Ok(block.into_modes(problem, count, &norms, iteration));
            }
            block.improve(&mut problem, residuals, |k| {
                norms[k] > 0.1 * options.tolerance
            });
        }
        Err(StaticsError::ModesNotFound {
            iterations: options.iterations,
            tolerance: options.tolerance,
        }
        .into())
    }

    /// Returns groups of modes of equal frequency, by ascending frequency.
    pub fn groups(&self) -> Vec<ModeGroup> {
        let mut groups: Vec<ModeGroup> = Vec::new();
        for mode in &self.modes {
            match groups.last_mut() {
                Some(group)
                    if mode.frequency_hz - group.frequency_hz <= EQUAL * mode.frequency_hz =>
                {
                    let known = group.multiplicity as f64;
                    group.frequency_hz =
                        (known * group.frequency_hz + mode.frequency_hz) / (known + 1.0);
                    group.multiplicity += 1;
                    group.residual = group.residual.max(mode.residual);
                }
                _ => groups.push(ModeGroup {
                    frequency_hz: mode.frequency_hz,
                    multiplicity: 1,
                    residual: mode.residual,
                }),
            }
        }
        groups
    }
}

/// K and M on the free entries, and the preconditioner.
struct Problem<'a> {
    system: &'a System,
    t: f64,
    u: &'a [f64],
    masses: Vec<f64>,
    ones: Vec<f64>,
    unknowns: Unknowns,
    free: Vec<f64>,
    multigrid: Multigrid,
    reduced: [Vec<f64>; 2],
    /// Rigid-body motions x with xᵀ M x = 1, and M x.
    rigid: Vec<[Vec<f64>; 2]>,
    products: u64,
}

impl<'a> Problem<'a> {
    fn new(system: &'a System, t: f64, u: &'a [f64]) -> Self {
        let n = system.points();
        let mut free = vec![1.0; n * system.dimension()];
        system.hold_at(t, &mut free);
        let surrogate = Surrogate::new(system);
        for i in (0..n).filter(|&i| surrogate.is_isolated(i)) {
            (0..system.dimension()).for_each(|c| free[c * n + i] = 0.0);
        }
        let unknowns = Unknowns::new(system.dimension(), &free);
        let multigrid = surrogate.preconditioner(&unknowns);
        let pieces = free_pieces(system, &surrogate, &unknowns);
        let reduced = || vec![0.0; unknowns.len()];
        let mut problem = Self {
            system,
            t,
            u,
            masses: system.masses(),
            ones: vec![1.0; free.len()],
            reduced: [reduced(), reduced()],
            unknowns,
            free,
            multigrid,
            rigid: Vec::new(),
            products: 0,
        };
        for mut motion in spread(&pieces, system, &Replicated::new(system.domain())) {
            problem.remove_rigid(&mut motion);
            let weighted = problem.weighted(&motion);
            let size = system.domain().dot(&motion, &weighted).sqrt();
            if size > 0.0 {
                let scaled = |vector: Vec<f64>| vector.into_iter().map(|x| x / size).collect();
                problem.rigid.push([scaled(motion), scaled(weighted)]);
            }
        }
        problem
    }

    fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        self.system.domain().dot(a, b)
    }

    /// Returns M x.
    fn weighted(&self, x: &[f64]) -> Vec<f64> {
        x.iter().zip(&self.masses).map(|(x, m)| x * m).collect()
    }

    /// Returns K x on free entries.
    fn product(&mut self, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; x.len()];
        stiffness_into(
            self.system,
            Derivative::Tangent,
            [self.t; 2],
            self.u,
            x,
            &mut out,
        );
        out.iter_mut()
            .zip(&self.free)
            .for_each(|(k, free)| *k *= free);
        self.products += 1;
        out
    }

    fn remove_rigid(&self, x: &mut [f64]) {
        for [motion, weighted] in &self.rigid {
            let along = self.dot(weighted, x);
            add_multiple(x, -along, motion);
        }
    }

    /// Returns an approximation of K⁻¹ r without rigid-body motions.
    fn preconditioned(&mut self, residual: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; residual.len()];
        let [right, solution] = &mut self.reduced;
        self.unknowns.gather(residual, right);
        self.multigrid.apply_into(right, solution);
        self.unknowns.scatter(solution, &mut out);
        self.remove_rigid(&mut out);
        out
    }
}

/// Vectors and their products with the stiffness.
#[derive(Default)]
struct Vectors {
    x: Vec<Vec<f64>>,
    product: Vec<Vec<f64>>,
}

/// Iterates: approximate modes and their last search directions.
struct Block {
    values: Vec<f64>,
    modes: Vectors,
    directions: Vectors,
}

impl Block {
    /// Starts from pseudorandom vectors, smoothed by the preconditioner.
    fn start(problem: &mut Problem<'_>, size: usize) -> Self {
        let entries = problem.free.len();
        let mut modes = Vectors::default();
        for k in 0..size {
            let phase = |entry: usize| {
                let x = (12.9898 * entry as f64 + 78.233 * k as f64).sin() * 43_758.545_3;
                x - x.floor() - 0.5
            };
            let noise: Vec<f64> = (0..entries)
                .map(|entry| phase(entry) * problem.masses[entry] * problem.free[entry])
                .collect();
            let x = problem.preconditioned(&noise);
            let product = problem.product(&x);
            modes.x.push(x);
            modes.product.push(product);
        }
        let mut block = Self {
            values: Vec::new(),
            modes: Vectors::default(),
            directions: Vectors::default(),
        };
        block.rayleigh_ritz(problem, modes, 0, size);
        block
    }

    /// Returns K x − ω² M x of every iterate.
    fn residuals(&self, problem: &Problem<'_>) -> Vec<Vec<f64>> {
        let pairs = self.modes.x.iter().zip(&self.modes.product);
        let residual = |((x, product), value): ((&Vec<f64>, &Vec<f64>), &f64)| {
            let entries = x.iter().zip(product).zip(&problem.masses);
            entries
                .map(|((x, kx), mass)| kx - value * mass * x)
                .collect()
        };
        pairs.zip(&self.values).map(residual).collect()
    }

    /// Returns the norms of the residuals over ω².
    fn norms(&self, problem: &Problem<'_>, residuals: &[Vec<f64>]) -> Vec<f64> {
        let norm = |(residual, value): (&Vec<f64>, &f64)| {
            let square = |k: usize| problem.free[k] * residual[k] * residual[k] / problem.masses[k];
            let sum = problem.system.domain().sum(residual.len(), square);
            sum.sqrt() / value.abs()
        };
        residuals.iter().zip(&self.values).map(norm).collect()
    }

    /// Computes the optimal iterates in the space of the current ones, their preconditioned residuals and the
    /// last directions.
    fn improve(
        &mut self,
        problem: &mut Problem<'_>,
        residuals: Vec<Vec<f64>>,
        active: impl Fn(usize) -> bool,
    ) {
        let size = self.modes.x.len();
        let mut space = std::mem::take(&mut self.modes);
        for (_, residual) in residuals.iter().enumerate().filter(|(k, _)| active(*k)) {
            let direction = problem.preconditioned(residual);
            let product = problem.product(&direction);
            space.x.push(direction);
            space.product.push(product);
        }
        let last = std::mem::take(&mut self.directions);
        space.x.extend(last.x);
        space.product.extend(last.product);
        self.rayleigh_ritz(problem, space, size, size);
    }

    /// Sets the iterates to the `size` lowest Ritz pairs of a space; their components outside of the first
    /// `old` vectors are the directions.
    fn rayleigh_ritz(&mut self, problem: &Problem<'_>, space: Vectors, old: usize, size: usize) {
        let n = space.x.len();
        let mass = symmetric_products(&space.x, &space.x, &problem.masses);
        let stiffness = symmetric_products(&space.product, &space.x, &problem.ones);
        let coefficients = lowest(n, &mass, &stiffness, size);
        self.values = coefficients.iter().map(|(value, _)| *value).collect();
        let entries = problem.free.len();
        let combined = |vectors: &[Vec<f64>], from: usize| -> Vec<Vec<f64>> {
            let of_one =
                |(_, c): &(f64, Vec<f64>)| combination(&vectors[from..], &c[from..], entries);
            coefficients.iter().map(of_one).collect()
        };
        self.modes = Vectors {
            x: combined(&space.x, 0),
            product: combined(&space.product, 0),
        };
        if old > 0 {
            self.directions = Vectors {
                x: combined(&space.x, old),
                product: combined(&space.product, old),
            };
        }
    }

    fn into_modes(
        self,
        problem: Problem<'_>,
        count: usize,
        norms: &[f64],
        iterations: u32,
    ) -> NaturalModes {
        let pairs = self.modes.x.into_iter().zip(&self.values).zip(norms);
        let modes = pairs.take(count).map(|((shape, value), residual)| Mode {
            frequency_hz: value.max(0.0).sqrt() / std::f64::consts::TAU,
            residual: *residual,
            shape,
        });
        NaturalModes {
            modes: modes.collect(),
            rigid_modes: problem.rigid.len(),
            products: problem.products,
            iterations,
        }
    }
}

/// Returns the lowest eigenpairs of a small generalised problem; directions whose mass is round-off are excluded.
fn lowest(n: usize, mass: &[f64], stiffness: &[f64], size: usize) -> Vec<(f64, Vec<f64>)> {
    let scale: Vec<f64> = (0..n)
        .map(|k| 1.0 / mass[k * n + k].max(f64::MIN_POSITIVE).sqrt())
        .collect();
    let scaled: Vec<f64> = (0..n * n)
        .map(|e| scale[e / n] * mass[e] * scale[e % n])
        .collect();
    let (values, vectors) = symmetric_eigen(n, scaled);
    /// Fraction of the largest eigenvalue of the scaled mass matrix below which a direction is round-off.
    const ROUNDING: f64 = 1e-13;
    let largest = values.last().copied().unwrap_or(0.0);
    let basis: Vec<Vec<f64>> = (0..n)
        .filter(|&k| values[k] > ROUNDING * largest)
        .map(|k| {
            let factor = 1.0 / values[k].sqrt();
            (0..n)
                .map(|i| factor * scale[i] * vectors[k * n + i])
                .collect()
        })
        .collect();
    let m = basis.len();
    let images: Vec<Vec<f64>> = basis
        .iter()
        .map(|y| {
            let row = |i: usize| (0..n).map(|j| stiffness[i * n + j] * y[j]).sum();
            (0..n).map(row).collect()
        })
        .collect();
    let entry = |e: usize| -> f64 {
        let (a, b) = (e / m, e % m);
        let dot = |y: &[f64], image: &[f64]| y.iter().zip(image).map(|(a, b)| a * b).sum::<f64>();
        0.5 * (dot(&basis[a], &images[b]) + dot(&basis[b], &images[a]))
    };
    let (ritz, inner) = symmetric_eigen(m, (0..m * m).map(entry).collect());
    (0..size.min(m))
        .map(|k| {
            let c = (0..n).map(|i| (0..m).map(|a| inner[k * m + a] * basis[a][i]).sum());
            (ritz[k], c.collect())
        })
        .collect()
}
