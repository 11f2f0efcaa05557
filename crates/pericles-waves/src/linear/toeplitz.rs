//! Products with constant coefficients on a line.

use rayon::prelude::*;

use super::banded::{TILE, banded_tiles};
use super::cost::{self, Pieces, Route};
use super::fourier::{CircularKernel, LineScratch};
use super::reject;
use pericles::operator::pool::Pool;
use pericles::operator::{InstructionSet, LinearOperator};
use pericles::{PericlesError, Result};

/// Condition beyond the ends of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// No points: bonds that would extend beyond an end are missing.
    Free,
    /// Points with u = 0.
    Zero,
    /// Periodic continuation.
    Periodic,
}

/// Product y = T u on N points of a line with coefficients that depend on the distance only.
///
/// * [`Toeplitz::stencil`]: y_i = Σ_r w_r (u_{i+r} + u_{i−r} − 2 u_i), the linear bond force of a bar;
/// * [`Toeplitz::differences`]: y_i = Σ_{r≠0} t_r (u_{i+r} − u_i), the same with different coefficients above and
///   below;
/// * [`Toeplitz::product`]: y_i = Σ_r t_r u_{i+r}, a Toeplitz (or circulant) matrix.
///
/// The route (see [`Route`]) is selected by estimated cost; all agree to round-off. Differences are taken from a
/// nearby value, so that a constant gives exactly zero and a large rigid motion loses no digits. Results do not
/// depend on the number of threads; with transforms the last bits depend on the instruction set of the machine. An
/// application allocates nothing once as many threads as will ever run have done so.
pub struct Toeplitz {
    nodes: usize,
    ends: Ends,
    /// Coefficients t_{−1}, t_{−2}, … and t_1, t_2, …, without those that extend beyond the line or more than half
    /// way around it.
    below: Vec<f64>,
    above: Vec<f64>,
    /// Coefficient of u_i far from the ends, of the first points, and of the last.
    middle: f64,
    first: Vec<f64>,
    last: Vec<f64>,
    /// True if constants give zero, so that values may be taken relative to any one of them.
    differences: bool,
    engine: Engine,
    instruction_set: InstructionSet,
    work: Pool<Work>,
}

enum Engine {
    Banded,
    Fourier(Route, Pieces, CircularKernel),
}

/// Work arrays of one thread.
struct Work {
    window: Vec<f64>,
    line: Option<LineScratch>,
}

/// Results per block of the banded loop: block and halo stay in the L1 cache for small reach.
const BLOCK: usize = 1024;

impl Toeplitz {
    /// Creates y_i = Σ_r w_r (u_{i+r} + u_{i−r} − 2 u_i) with w_r = `weights[r − 1]`. Bonds beyond free ends are
    /// missing; beyond [`Ends::Zero`] u = 0.
    ///
    /// # Errors
    /// No nodes; a weight that is not finite.
    pub fn stencil(nodes: usize, weights: &[f64], ends: Ends) -> Result<Self> {
        Self::differences(nodes, weights, weights, ends)
    }

    /// Creates y_i = Σ_r t_r (u_{i+r} − u_i) + t_{−r} (u_{i−r} − u_i) with t_{−r} = `below[r − 1]`, t_r =
    /// `above[r − 1]`.
    ///
    /// # Errors
    /// No nodes; arrays of different lengths; a coefficient that is not finite.
    pub fn differences(nodes: usize, below: &[f64], above: &[f64], ends: Ends) -> Result<Self> {
        let full = -(below.iter().sum::<f64>() + above.iter().sum::<f64>());
        let mut operator = Self::with_middle(nodes, full, below, above, ends, true)?;
        if ends == Ends::Free {
            // Node i has the coefficients from −i to nodes − 1 − i.
            let sums = |t: &[f64]| {
                let mut sums = vec![0.0];
                for (r, t) in t.iter().enumerate() {
                    sums.push(sums[r] + t);
                }
                sums
            };
            let (down, up) = (sums(&operator.below), sums(&operator.above));
            let reach = operator.reach();
            let diagonal = |i: usize| -(down[i.min(reach)] + up[(nodes - 1 - i).min(reach)]);
            let edge = if 2 * reach < nodes { reach } else { nodes };
            operator.first = (0..edge).map(diagonal).collect();
            if edge < nodes {
                operator.middle = -(down[reach] + up[reach]);
                operator.last = (nodes - edge..nodes).map(diagonal).collect();
            }
        }
        Ok(operator)
    }

    /// Creates y_i = t_0 u_i + Σ_r t_r u_{i+r} + t_{−r} u_{i−r}, with u = 0 beyond the ends unless they are
    /// periodic.
    ///
    /// # Errors
    /// No nodes; arrays of different lengths; a coefficient that is not finite; free ends, which products do not
    /// support.
    pub fn product(
        nodes: usize,
        centre: f64,
        below: &[f64],
        above: &[f64],
        ends: Ends,
    ) -> Result<Self> {
        if ends == Ends::Free {
            return reject(
                "free ends are not available for products, which have no bonds; use zero or periodic ends, or \
                differences",
            );
        }
        Self::with_middle(nodes, centre, below, above, ends, false)
    }

    fn with_middle(
        nodes: usize,
        middle: f64,
        below: &[f64],
        above: &[f64],
        ends: Ends,
        differences: bool,
    ) -> Result<Self> {
        if nodes == 0 {
            return Err(PericlesError::EmptyBody);
        }
        if below.len() != above.len() {
            return reject(format!(
                "the numbers of coefficients below and above the diagonal must be equal, but are {} and {}",
                below.len(),
                above.len()
            ));
        }
        let all = || below.iter().chain(above);
        if let Some(bad) = all().chain([&middle]).find(|t| !t.is_finite()) {
            return reject(format!(
                "coefficients must be finite numbers, but one is {bad}"
            ));
        }
        let (mut middle, mut below, mut above) = (middle, below.to_vec(), above.to_vec());
        if ends == Ends::Periodic {
            fold(nodes, &mut middle, &mut below, &mut above);
        } else {
            below.truncate(nodes - 1);
            above.truncate(nodes - 1);
        }
        let mut operator = Self {
            nodes,
            ends,
            below,
            above,
            middle,
            first: vec![],
            last: vec![],
            // Beyond zero ends the value is prescribed.
            differences: differences && ends != Ends::Zero,
            engine: Engine::Banded,
            instruction_set: InstructionSet::detect(),
            work: Pool::new(0, || Work {
                window: vec![],
                line: None,
            }),
        };
        let cost = |route| match route {
            Route::Banded => cost::banded_cost(nodes, operator.reach(), operator.is_symmetric()),
            _ => cost::pieces_cost(nodes, operator.pieces(route)),
        };
        let mut route = Route::Banded;
        for other in [Route::OverlapSave, Route::OneTransform] {
            if cost(other) < cost(route) {
                route = other;
            }
        }
        operator = operator.with_route(route);
        Ok(operator)
    }

    /// Selects another route; for tests and benchmarks.
    pub fn with_route(mut self, route: Route) -> Self {
        let threads = rayon::current_num_threads();
        if route == Route::Banded {
            let window = BLOCK + 2 * self.reach();
            self.engine = Engine::Banded;
            self.work = Pool::new(threads, move || Work {
                window: vec![0.0; window],
                line: None,
            });
        } else {
            let pieces = self.pieces(route);
            let kernel = CircularKernel::new(pieces.length, &self.below, &self.above);
            let transform = kernel.transform().clone();
            self.work = Pool::new(threads, move || Work {
                window: vec![0.0; pieces.length],
                line: Some(LineScratch::new(&transform)),
            });
            self.engine = Engine::Fourier(route, pieces, kernel);
        }
        self
    }

    /// Number of points.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Largest distance with a coefficient, without those that no point can use.
    pub fn reach(&self) -> usize {
        self.above.len()
    }

    /// Selected route.
    pub fn route(&self) -> Route {
        match self.engine {
            Engine::Banded => Route::Banded,
            Engine::Fourier(route, ..) => route,
        }
    }

    /// Memory of the coefficients, bytes.
    pub fn bytes(&self) -> usize {
        let kernel = match &self.engine {
            Engine::Banded => 0,
            Engine::Fourier(_, _, kernel) => kernel.bytes(),
        };
        let numbers = 2 * self.reach() + self.first.len() + self.last.len();
        kernel + numbers * size_of::<f64>()
    }

    /// Coefficient of u_i in y_i.
    pub fn diagonal(&self, i: usize) -> f64 {
        let tail = self.nodes - self.last.len();
        if i < self.first.len() {
            self.first[i]
        } else if i >= tail {
            self.last[i - tail]
        } else {
            self.middle
        }
    }

    fn is_symmetric(&self) -> bool {
        self.below == self.above
    }

    fn pieces(&self, route: Route) -> Pieces {
        match route {
            Route::OneTransform => {
                cost::one_transform(self.nodes, self.reach(), self.ends == Ends::Periodic)
            }
            _ => cost::overlap_save(self.nodes, self.reach()),
        }
    }

    /// Fills `window` with u_from − shift, u_{from+1} − shift …, where `from` is relative to the start of the line.
    fn load(&self, u: &[f64], from: isize, shift: f64, window: &mut [f64]) {
        let n = self.nodes as isize;
        if self.ends == Ends::Periodic {
            let mut at = from.rem_euclid(n) as usize;
            let mut rest = window;
            while !rest.is_empty() {
                let (now, later) = rest.split_at_mut(rest.len().min(self.nodes - at));
                subtract_into(&u[at..at + now.len()], shift, now);
                (rest, at) = (later, 0);
            }
        } else {
            let end = from + window.len() as isize;
            let (begin, stop) = (from.clamp(0, n), end.clamp(0, n));
            let (before, after) = ((begin - from) as usize, (stop - from) as usize);
            window[..before].fill(0.0);
            window[after..].fill(0.0);
            subtract_into(
                &u[begin as usize..stop as usize],
                shift,
                &mut window[before..after],
            );
        }
    }

    /// Computes the results of the block that starts at point `first`.
    fn block(&self, u: &[f64], first: usize, out: &mut [f64], work: &mut Work) {
        let reach = self.reach();
        let here = &u[first..first + out.len()];
        let shift = if self.differences {
            here[out.len() / 2]
        } else {
            0.0
        };
        match &self.engine {
            Engine::Banded => {
                let window = &mut work.window[..out.len().next_multiple_of(TILE) + 2 * reach];
                self.load(u, first as isize - reach as isize, shift, window);
                let set = self.instruction_set;
                if self.is_symmetric() {
                    banded_tiles::<true>(set, &self.below, &self.above, window, out);
                } else {
                    banded_tiles::<false>(set, &self.below, &self.above, window, out);
                }
            }
            Engine::Fourier(_, pieces, kernel) => {
                let Some(line) = &mut work.line else { return };
                let lead = pieces.lead;
                // Part needed for the results; the rest of the piece is empty. With no lead, values before the line
                // wrap into it.
                let used = if lead > 0 {
                    out.len() + 2 * reach
                } else {
                    out.len()
                };
                let (window, rest) = work.window.split_at_mut(used);
                self.load(u, first as isize - lead as isize, shift, window);
                rest.fill(0.0);
                kernel.apply(&mut work.window, line);
                out.copy_from_slice(&work.window[lead..lead + out.len()]);
            }
        }
        self.add_diagonal(here, shift, first, out);
    }

    fn add_diagonal(&self, here: &[f64], shift: f64, first: usize, out: &mut [f64]) {
        let tail = self.nodes - self.last.len();
        let (from, to) = (first, first + out.len());
        let (low, high) = (
            self.first.len().clamp(from, to) - from,
            tail.clamp(from, to) - from,
        );
        for k in 0..low {
            out[k] += self.first[from + k] * (here[k] - shift);
        }
        for (y, u) in out[low..high].iter_mut().zip(&here[low..high]) {
            *y += self.middle * (u - shift);
        }
        for k in high..out.len() {
            out[k] += self.last[from + k - tail] * (here[k] - shift);
        }
    }
}

impl LinearOperator for Toeplitz {
    fn half_bandwidth(&self) -> Option<usize> {
        (self.ends != Ends::Periodic).then(|| self.reach())
    }

    /// # Panics
    /// If the slices do not have one entry per node.
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        assert_eq!(
            (u.len(), out.len()),
            (self.nodes, self.nodes),
            "one entry per node"
        );
        let outputs = match &self.engine {
            Engine::Banded => BLOCK,
            Engine::Fourier(_, pieces, _) => pieces.outputs,
        };
        out.par_chunks_mut(outputs).enumerate().for_each_init(
            || self.work.take(),
            |work, (b, out)| self.block(u, b * outputs, out, work),
        );
    }
}

fn subtract_into(u: &[f64], shift: f64, out: &mut [f64]) {
    for (out, u) in out.iter_mut().zip(u) {
        *out = u - shift;
    }
}

/// Coefficients of the nearest images, each the sum over all its images; at most half way around.
fn fold(nodes: usize, middle: &mut f64, below: &mut Vec<f64>, above: &mut Vec<f64>) {
    let half = nodes / 2;
    if above.len() <= half {
        return;
    }
    let (mut down, mut up) = (vec![0.0; half], vec![0.0; half]);
    for r in 1..=above.len() {
        let (near, far) = (r % nodes, nodes - r % nodes);
        if near == 0 {
            *middle += above[r - 1] + below[r - 1];
        } else if near <= half {
            up[near - 1] += above[r - 1];
            down[near - 1] += below[r - 1];
        } else {
            down[far - 1] += above[r - 1];
            up[far - 1] += below[r - 1];
        }
    }
    (*below, *above) = (down, up);
}
