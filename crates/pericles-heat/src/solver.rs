//! Solution of the implicit equations: conjugate gradients with the multigrid of a sparse network of springs between
//! neighbouring points, here conductors.

use std::hash::{DefaultHasher, Hasher};

use pericles::parallel::for_each_point;
use pericles::{Interrupt, Result};
use pericles_statics::krylov::{Goal, KrylovWork, LinearProblem, conjugate_gradients};
use pericles_statics::multigrid::{Multigrid, NearKernel};
use pericles_statics::sparse::SparseMatrix;

use crate::diffusion::{Bond, Diffusion};
use crate::problem::Problem;

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

/// What the preconditioner was made for.
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
        for slope in equations.slope.iter().filter(|slope| **slope != 0.0) {
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
    krylov: KrylovWork,
    pub effort: Effort,
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
            krylov: KrylovWork::new(n),
            effort: Effort::default(),
            free: (0..n).map(free).collect(),
        }
    }

    /// Solves the equations for `residual`; `scale` is the norm of the right-hand side that the tolerance refers to.
    /// Returns the correction, the number of products and the final relative residual.
    pub fn solve(
        &mut self,
        equations: &Equations<'_>,
        residual: &mut [f64],
        scale: f64,
    ) -> Result<(Vec<f64>, u64, f64)> {
        let problem = equations.problem;
        let key = Key::of(equations);
        if self.made_for != Some(key) || self.multigrid.is_none() {
            self.multigrid = Some(preconditioner(equations));
            self.made_for = Some(key);
        }
        let mut solution = vec![0.0; problem.len()];
        let Some(multigrid) = &mut self.multigrid else {
            return Ok((solution, 0, 0.0));
        };
        for (r, free) in residual.iter_mut().zip(&self.free) {
            *r *= free;
        }
        let mut linear = Preconditioned {
            equations,
            multigrid,
            free: &self.free,
        };
        let goal = Goal {
            absolute: TOLERANCE * scale,
            relative: 0.0,
            acting: 0.0,
            products: MOST,
            interrupt: Interrupt::never(),
        };
        let domain = problem.diffusion.cloud().domain();
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
        self.multigrid.apply_into(residual, out);
        for (out, free) in out.iter_mut().zip(self.free) {
            *out *= free;
        }
    }
}

/// Returns the multigrid of a network between neighbouring points that conducts unit gradients as the body does.
fn preconditioner(equations: &Equations<'_>) -> Multigrid {
    let Equations {
        problem,
        rate,
        share,
        slope,
    } = equations;
    let n = problem.len();
    let diffusion = &problem.diffusion;
    let rows = near_network(diffusion);
    let own = |i: usize| coarse(*rate) * problem.capacity()[i] + coarse(slope[i]);
    let typical = (0..n).map(|i| own(i) + share * rows[i].iter().map(|(_, g)| g).sum::<f64>());
    let typical = (typical.sum::<f64>() / n as f64).max(f64::MIN_POSITIVE);
    let matrix = SparseMatrix::from_rows(n, n, &|i, add| {
        if problem.is_prescribed(i) {
            add(i, typical);
            return;
        }
        let mut diagonal = own(i);
        for &(j, conductance) in &rows[i] {
            diagonal += share * conductance;
            if !problem.is_prescribed(j as usize) {
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

/// Returns the conductors between neighbouring points, row by row and symmetric: the short bonds of the body, with a
/// factor per point such that unit gradients, averaged over the axes, have the energy of all bonds.
fn near_network(diffusion: &Diffusion) -> Vec<Vec<(u32, f64)>> {
    let cloud = diffusion.cloud();
    let (n, d) = (cloud.len(), cloud.dimension());
    /// Squared reach in cells. Bonds to next neighbours alone would need a third more products.
    const REACH: f64 = 4.1;
    let nearest = [4, 12, 32][d - 1];
    let square = |bond: &Bond| bond.xi.iter().map(|x| x * x).sum::<f64>();
    let chosen = for_each_point(n, &|i| {
        let mut all = Vec::new();
        diffusion.for_each_bond(i, &mut |bond| {
            if bond.neighbour != i {
                all.push(bond);
            }
        });
        let moment: f64 = all.iter().map(|bond| bond.conductance * square(bond)).sum();
        let cells = |bond: &Bond| {
            (0..d)
                .map(|c| (bond.xi[c] / cloud.cell_side(c)).powi(2))
                .sum::<f64>()
        };
        all.sort_by(|a, b| {
            cells(a)
                .total_cmp(&cells(b))
                .then(a.neighbour.cmp(&b.neighbour))
        });
        let near = match cloud.cell_sides() {
            Some(_) => all.partition_point(|bond| cells(bond) <= REACH),
            None => nearest,
        };
        all.truncate(near.max(2 * d));
        // All points together would keep the memory of whole families.
        all.shrink_to_fit();
        let own: f64 = all.iter().map(|bond| bond.conductance * square(bond)).sum();
        let coefficient = if own > 0.0 { moment / own } else { 0.0 };
        (all, coefficient)
    });
    let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new(); n];
    for (i, (bonds, coefficient)) in chosen.iter().enumerate() {
        for bond in bonds {
            // Half of the mean from each end that selects the bond.
            let conductance = 0.5 * coefficient * bond.conductance;
            rows[i].push((bond.neighbour as u32, conductance));
            rows[bond.neighbour].push((i as u32, conductance));
        }
    }
    for row in &mut rows {
        row.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        row.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
    }
    rows
}
