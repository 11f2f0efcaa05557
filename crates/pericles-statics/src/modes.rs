//! Natural frequencies and mode shapes.

use pericles::domain::Replicated;
use pericles::lanes::{F64x8, LANES, Real};
use pericles::parallel::{for_each_chunk, for_each_point};
use pericles::{Interrupt, Need, Requirement, Result, System};

use crate::block::{
    Group, combinations, copy_from, copy_to, selected, sums, symmetric_products, zeros,
};
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
        let free = problem.unknowns.len().saturating_sub(problem.rigid.len());
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
            block.improve(&mut problem, &residuals, |k| {
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

/// K and M of the unknowns, and the preconditioner.
struct Problem<'a> {
    system: &'a System,
    t: f64,
    u: &'a [f64],
    unknowns: Unknowns,
    masses: Vec<f64>,
    ones: Vec<f64>,
    multigrid: Multigrid<F64x8>,
    /// Rigid-body motions x with xᵀ M x = 1, and M x.
    rigid: Vec<[Vec<f64>; 2]>,
    /// A vector of unknowns, and two of all entries.
    work: [Vec<f64>; 3],
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
        let gathered = |vector: &[f64]| {
            let mut of_unknowns = vec![0.0; unknowns.len()];
            unknowns.gather(vector, &mut of_unknowns);
            of_unknowns
        };
        let masses = gathered(&system.masses());
        let weighted =
            |x: &[f64]| -> Vec<f64> { x.iter().zip(&masses).map(|(x, m)| x * m).collect() };
        let mut rigid: Vec<[Vec<f64>; 2]> = Vec::new();
        for motion in spread(&pieces, system, &Replicated::new(system.domain())) {
            let mut motion = gathered(&motion);
            for [other, of_other] in &rigid {
                let along = system.domain().dot(of_other, &motion);
                add_multiple(&mut motion, -along, other);
            }
            let size = system.domain().dot(&motion, &weighted(&motion)).sqrt();
            if size > 0.0 {
                motion.iter_mut().for_each(|x| *x /= size);
                let of_motion = weighted(&motion);
                rigid.push([motion, of_motion]);
            }
        }
        Self {
            system,
            t,
            u,
            ones: vec![1.0; unknowns.len()],
            work: [unknowns.len(), free.len(), free.len()].map(|length| vec![0.0; length]),
            masses,
            unknowns,
            multigrid,
            rigid,
            products: 0,
        }
    }

    /// Returns K x of the first `count` vectors of a group.
    fn product(&mut self, x: &[F64x8], count: usize) -> Group {
        let mut product = zeros(x.len());
        let [of_unknowns, whole, out] = &mut self.work;
        for lane in 0..count {
            copy_from(x, lane, of_unknowns);
            self.unknowns.scatter(of_unknowns, whole);
            let times = [self.t; 2];
            stiffness_into(self.system, Derivative::Tangent, times, self.u, whole, out);
            self.unknowns.gather(out, of_unknowns);
            copy_to(&mut product, lane, of_unknowns);
        }
        self.products += count as u64;
        product
    }

    /// Returns approximations of K⁻¹ r without rigid-body motions.
    fn preconditioned(&mut self, residuals: &[F64x8]) -> Group {
        let mut out = zeros(residuals.len());
        self.multigrid.apply_into(residuals, &mut out);
        self.remove_rigid(&mut out);
        out
    }

    fn remove_rigid(&self, group: &mut Group) {
        for [motion, of_motion] in &self.rigid {
            let term = |k: usize| F64x8::splat(of_motion[k]) * group[k];
            let along = sums(group.len(), term);
            for_each_chunk(group, &|first, chunk| {
                for (x, motion) in chunk.iter_mut().zip(&motion[first..]) {
                    *x = *x - F64x8::splat(*motion) * along;
                }
            });
        }
    }

    /// Returns the approximations of K⁻¹ r for `count` vectors, with their products.
    fn improved(&mut self, residuals: &[Group], count: usize) -> Vectors {
        let mut vectors = Vectors::default();
        for (number, group) in residuals.iter().enumerate() {
            let x = self.preconditioned(group);
            let product = self.product(&x, LANES.min(count - number * LANES));
            vectors.x.push(x);
            vectors.product.push(product);
        }
        vectors
    }
}

/// Vectors and their products with the stiffness.
#[derive(Default)]
struct Vectors {
    x: Vec<Group>,
    product: Vec<Group>,
}

impl Vectors {
    fn append(&mut self, other: Self) {
        self.x.extend(other.x);
        self.product.extend(other.product);
    }

    /// Returns linear combinations of the vectors, one for each row of coefficients.
    fn combined(&self, coefficients: &[Vec<f64>], entries: usize) -> Self {
        let rows: Vec<&[f64]> = coefficients.iter().map(Vec::as_slice).collect();
        Self {
            x: combinations(&self.x, &rows, entries),
            product: combinations(&self.product, &rows, entries),
        }
    }
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
        let entries = problem.unknowns.len();
        let noise = |entry: usize, k: usize| {
            let x = (12.9898 * entry as f64 + 78.233 * k as f64).sin() * 43_758.545_3;
            x - x.floor() - 0.5
        };
        let group = |first: usize| {
            let lane = |entry: usize, k: usize| if k < size { noise(entry, k) } else { 0.0 };
            for_each_point(entries, &|entry| {
                F64x8::from_fn(|k| problem.masses[entry] * lane(entry, first + k))
            })
        };
        let start: Vec<Group> = (0..size).step_by(LANES).map(group).collect();
        let modes = problem.improved(&start, size);
        let mut block = Self {
            values: Vec::new(),
            modes: Vectors::default(),
            directions: Vectors::default(),
        };
        block.rayleigh_ritz(problem, modes, 0, size);
        block
    }

    /// Returns K x − ω² M x of every iterate.
    fn residuals(&self, problem: &Problem<'_>) -> Vec<Group> {
        let pairs = self.modes.x.iter().zip(&self.modes.product);
        let residual = |(number, (x, product)): (usize, (&Group, &Group))| -> Group {
            let value = |lane: usize| self.values.get(number * LANES + lane);
            let values = F64x8::from_fn(|lane| value(lane).copied().unwrap_or(0.0));
            for_each_point(x.len(), &|k| {
                product[k] - F64x8::splat(problem.masses[k]) * values * x[k]
            })
        };
        pairs.enumerate().map(residual).collect()
    }

    /// Returns the norms of the residuals over ω².
    fn norms(&self, problem: &Problem<'_>, residuals: &[Group]) -> Vec<f64> {
        let squares = residuals.iter().flat_map(|group| {
            let term = |k: usize| group[k] * group[k] / F64x8::splat(problem.masses[k]);
            sums(group.len(), term).0
        });
        let norm = |(square, value): (f64, &f64)| square.sqrt() / value.abs();
        squares.zip(&self.values).map(norm).collect()
    }

    /// Computes the optimal iterates in the space of the current ones, their preconditioned residuals and the
    /// last directions.
    fn improve(
        &mut self,
        problem: &mut Problem<'_>,
        residuals: &[Group],
        active: impl Fn(usize) -> bool,
    ) {
        let size = self.values.len();
        let numbers: Vec<usize> = (0..size).filter(|k| active(*k)).collect();
        let residuals = selected(residuals, &numbers, problem.unknowns.len());
        let mut space = std::mem::take(&mut self.modes);
        let old = LANES * space.x.len();
        space.append(problem.improved(&residuals, numbers.len()));
        space.append(std::mem::take(&mut self.directions));
        self.rayleigh_ritz(problem, space, old, size);
    }

    /// Sets the iterates to the `size` lowest Ritz pairs of a space; their components outside of the first
    /// `old` vectors are the directions.
    fn rayleigh_ritz(&mut self, problem: &Problem<'_>, space: Vectors, old: usize, size: usize) {
        let n = LANES * space.x.len();
        let mass = symmetric_products(&space.x, &space.x, &problem.masses);
        let stiffness = symmetric_products(&space.product, &space.x, &problem.ones);
        let found = lowest(n, &mass, &stiffness, size);
        self.values = found.iter().map(|(value, _)| *value).collect();
        let entries = problem.unknowns.len();
        let mut coefficients: Vec<Vec<f64>> = found.into_iter().map(|(_, c)| c).collect();
        self.modes = space.combined(&coefficients, entries);
        if old > 0 {
            coefficients.iter_mut().for_each(|c| c[..old].fill(0.0));
            self.directions = space.combined(&coefficients, entries);
        }
        // Combinations of almost dependent vectors magnify round-off, of which rigid-body motions have the lowest quotient.
        for group in self.modes.x.iter_mut().chain(&mut self.directions.x) {
            problem.remove_rigid(group);
        }
    }

    fn into_modes(
        self,
        problem: Problem<'_>,
        count: usize,
        norms: &[f64],
        iterations: u32,
    ) -> NaturalModes {
        let [mut of_unknowns, whole, _] = problem.work;
        let mode = |k: usize| {
            copy_from(&self.modes.x[k / LANES], k % LANES, &mut of_unknowns);
            let mut shape = vec![0.0; whole.len()];
            problem.unknowns.scatter(&of_unknowns, &mut shape);
            Mode {
                frequency_hz: self.values[k].max(0.0).sqrt() / std::f64::consts::TAU,
                residual: norms[k],
                shape,
            }
        };
        NaturalModes {
            modes: (0..count.min(norms.len())).map(mode).collect(),
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
