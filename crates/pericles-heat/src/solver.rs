//! Solution of the implicit equations: conjugate gradients with the multigrid of a sparse network of springs between
//! neighbouring points, here conductors.
//!
//! On a body divided among processes every process has the network and the multigrid of the whole body, with the bits of a single
//! process; each of them selects the conductors of its own points.
//!
//! The network has the energy of unit gradients of the body, so that materials, cracks and surfaces need no rules.

mod network;

use std::hash::{DefaultHasher, Hasher};

use pericles::domain::Replicated;
use pericles::{Interrupt, Result};
use pericles_statics::krylov::{Goal, KrylovWork, LinearProblem, conjugate_gradients};
use pericles_statics::multigrid::{Multigrid, NearKernel};
use pericles_statics::sparse::SparseMatrix;

use crate::problem::Problem;
use network::near_network;

/// Effort of the last step and of all steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Effort {
    /// Products with the operator in the last step.
    pub last: u64,
    /// Largest number of products of a linear solution.
    pub most: u64,
    /// Products in all steps.
    pub total: u64,
}

/// What the preconditioner was made for, on this process.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Key {
    changes: u64,
    rate: f64,
    share: f64,
    slopes: u64,
}

impl Key {
    fn of(equations: &Equations<'_>) -> Self {
        let mut slopes = DefaultHasher::new();
        let present = equations.slope.iter().enumerate();
        for (i, slope) in present.filter(|(_, slope)| **slope != 0.0) {
            slopes.write_usize(i);
            slopes.write_u64(coarse(*slope).to_bits());
        }
        Self {
            changes: equations.problem.diffusion.changes(),
            rate: coarse(equations.rate),
            share: equations.share,
            slopes: slopes.finish(),
        }
    }
}

/// Returns a number to three or four digits. The preconditioner need not be exact, and steps of equal length differ by
/// rounding; made from such numbers, it depends on the equations only.
fn coarse(number: f64) -> f64 {
    /// Bits of the mantissa that are dropped.
    const DROPPED: u32 = 42;
    f64::from_bits(number.to_bits() >> DROPPED << DROPPED)
}

/// Solver of (rate C + slope − G) x = r on points without prescribed values.
pub(crate) struct Solver {
    made_for: Option<Key>,
    multigrid: Option<Multigrid>,
    /// Makes vectors of the whole body; made with the first multigrid.
    replicated: Option<Replicated>,
    krylov: KrylovWork,
    pub effort: Effort,
    /// Number of changes of the bonds, and the norm of the conductances of all points for these bonds, W/K.
    conductance: Option<(u64, f64)>,
    /// 1 at points without prescribed values, 0 at others.
    free: Vec<f64>,
}

/// The equations of one solution.
pub(crate) struct Equations<'a> {
    pub problem: &'a Problem,
    /// Weight of the capacity, 1/s; zero for steady states.
    pub rate: f64,
    /// Weight of the flow.
    pub share: f64,
    /// Slope of exchanges at each point, W/K, times the weight of the flow.
    pub slope: &'a [f64],
}

/// Relative residual of linear solutions.
const TOLERANCE: f64 = 1e-10;

/// Largest number of products of a linear solution.
const MOST: u64 = 2000;

impl Solver {
    pub fn new(problem: &Problem) -> Self {
        let n = problem.len();
        let free = |i| f64::from(u8::from(!problem.is_prescribed(i)));
        Self {
            made_for: None,
            multigrid: None,
            replicated: None,
            krylov: KrylovWork::new(n),
            effort: Effort::default(),
            conductance: None,
            free: (0..n).map(free).collect(),
        }
    }

    /// Returns the norm of Σ_j G_ij, W/K, which is computed once for the present bonds. All processes must call it together.
    pub fn conductance(&mut self, problem: &Problem) -> f64 {
        let changes = problem.diffusion.changes();
        match self.conductance {
            Some((known, conductance)) if known == changes => conductance,
            _ => {
                let conductance = problem.domain().norm(&problem.diffusion.diagonal());
                self.conductance = Some((changes, conductance));
                conductance
            }
        }
    }

    /// Solves the equations for `residual`; `scale` is the norm of the right-hand side that the tolerance refers to, `rounding` a
    /// residual that consists of rounding errors.
    /// Returns the correction, the number of products and the final relative residual. All processes must call it together.
    pub fn solve(
        &mut self,
        equations: &Equations<'_>,
        residual: &mut [f64],
        (scale, rounding): (f64, f64),
    ) -> Result<(Vec<f64>, u64, f64)> {
        let problem = equations.problem;
        let domain = problem.domain();
        let key = Key::of(equations);
        let replicated = self
            .replicated
            .get_or_insert_with(|| Replicated::new(domain));
        // A multigrid that is outdated on one process is outdated on all of them.
        let is_valid = domain.all(self.made_for == Some(key));
        let multigrid = match self.multigrid.take().filter(|_| is_valid) {
            Some(known) => known,
            None => preconditioner(equations, replicated),
        };
        let multigrid = self.multigrid.insert(multigrid);
        self.made_for = Some(key);
        let mut solution = vec![0.0; problem.len()];
        for (r, free) in residual.iter_mut().zip(&self.free) {
            *r *= free;
        }
        let mut linear = Preconditioned {
            equations,
            multigrid,
            replicated,
            free: &self.free,
        };
        let goal = Goal {
            absolute: rounding.max(TOLERANCE * scale),
            relative: 0.0,
            acting: 0.0,
            products: MOST,
            interrupt: Interrupt::never(),
        };
        let solved = conjugate_gradients(
            &mut linear,
            (domain, &self.free),
            residual,
            &mut solution,
            &goal,
            &mut self.krylov,
        )?;
        self.effort.most = self.effort.most.max(solved.products);
        self.effort.last += solved.products;
        self.effort.total += solved.products;
        let relative = if scale > 0.0 {
            solved.residual / scale
        } else {
            solved.residual
        };
        Ok((solution, solved.products, relative))
    }
}

struct Preconditioned<'a> {
    equations: &'a Equations<'a>,
    multigrid: &'a mut Multigrid,
    replicated: &'a Replicated,
    free: &'a [f64],
}

impl LinearProblem for Preconditioned<'_> {
    fn multiply_into(&mut self, x: &[f64], out: &mut [f64]) {
        let Equations {
            problem,
            rate,
            share,
            slope,
        } = self.equations;
        out.fill(0.0);
        problem.diffusion.add_flow(x, out);
        for (i, out) in out.iter_mut().enumerate() {
            let own = rate * problem.capacity()[i] + slope[i];
            *out = self.free[i] * (own * x[i] - share * *out);
        }
    }

    fn precondition_into(&mut self, residual: &[f64], out: &mut [f64]) {
        let whole = self.replicated.of(residual);
        let apply = |out: &mut [f64]| self.multigrid.apply_into(&whole, out);
        self.replicated.fill_own(1, out, apply);
        for (out, free) in out.iter_mut().zip(self.free) {
            *out *= free;
        }
    }
}

/// Returns the multigrid of a network between neighbouring points that conducts unit gradients as the body does. All processes
/// must call it together and obtain the same one.
fn preconditioner(equations: &Equations<'_>, replicated: &Replicated) -> Multigrid {
    let Equations {
        problem,
        rate,
        share,
        slope,
    } = equations;
    let n = replicated.points();
    let rows = near_network(&problem.diffusion, n);
    let own = |i: usize| coarse(*rate) * problem.capacity()[i] + coarse(slope[i]);
    let own: Vec<f64> = (0..problem.len()).map(own).collect();
    let own = replicated.of(&own);
    let is_prescribed = |i| f64::from(u8::from(problem.is_prescribed(i)));
    let is_prescribed: Vec<f64> = (0..problem.len()).map(is_prescribed).collect();
    let is_prescribed = replicated.of(&is_prescribed);
    let is_prescribed = |i: usize| is_prescribed[i] != 0.0;
    let typical = (0..n).map(|i| own[i] + share * rows[i].iter().map(|(_, g)| g).sum::<f64>());
    let typical = (typical.sum::<f64>() / n as f64).max(f64::MIN_POSITIVE);
    let matrix = SparseMatrix::from_rows(n, n, &|i, add| {
        if is_prescribed(i) {
            add(i, typical);
            return;
        }
        let mut diagonal = own[i];
        for &(j, conductance) in &rows[i] {
            diagonal += share * conductance;
            if !is_prescribed(j as usize) {
                add(j as usize, -share * conductance);
            }
        }
        add(i, if diagonal > 0.0 { diagonal } else { typical });
    });
    let kernel = NearKernel {
        nodes: (0..=n).collect(),
        count: 1,
        vectors: vec![1.0; n],
    };
    Multigrid::new(matrix, kernel)
}
