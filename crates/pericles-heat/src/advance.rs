//! Time integration of a diffusing field.
//!
//! An implicit step ends with T = T₀ + dt/(C V) × the rates at the solution of the linear system. The content then
//! changes by exactly the recorded flows, and the residual of the solver changes the values by its own size only.

use pericles::Result;

use crate::error::HeatError;
use crate::problem::{Problem, Sampled};
use crate::solver::{Equations, Solver};

/// Time integration scheme of a diffusing field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scheme {
    /// Forward Euler method in sub-steps below its limit of stability.
    #[default]
    Explicit,
    /// Trapezoidal rule, order two.
    Trapezoidal,
    /// Backward Euler method, order one; damps all modes.
    BackwardEuler,
    /// Steady state of the conditions at each time.
    Steady,
}

impl Scheme {
    /// All schemes.
    pub const ALL: [Self; 4] = [
        Self::Explicit,
        Self::Trapezoidal,
        Self::BackwardEuler,
        Self::Steady,
    ];

    /// Name in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Explicit => "explicit",
            Self::Trapezoidal => "trapezoidal",
            Self::BackwardEuler => "backward-euler",
            Self::Steady => "steady",
        }
    }
}

/// Content that has flowed in by each condition, J for heat.
pub type Flows = Vec<f64>;

/// Part of the limit of stability that explicit sub-steps use at most.
const SAFETY: f64 = 0.95;

/// A time interval of a field.
#[derive(Clone, Copy)]
pub(crate) struct Span<'a> {
    /// Start and end, s.
    pub times: [f64; 2],
    /// Inflow into each point in addition to the inflow by conditions, constant within the interval, W for heat; empty if zero.
    pub power: &'a [f64],
}

/// Advances values over a time interval and adds the inflow of each condition to `flows`. All processes must call it together; an
/// error is one of all of them.
pub(crate) fn advance(
    problem: &Problem,
    scheme: Scheme,
    solver: &mut Solver,
    span: Span<'_>,
    values: &mut [f64],
    flows: &mut [f64],
) -> Result<()> {
    solver.effort.last = 0;
    let [t0, t1] = span.times;
    match scheme {
        Scheme::Explicit => {
            let limit = problem.explicit_limit(values);
            let parts = ((t1 - t0) / (SAFETY * limit)).ceil().max(1.0);
            let time = |k: f64| {
                if k == parts {
                    t1
                } else {
                    t0 + (t1 - t0) * (k / parts)
                }
            };
            let mut sampled = problem.sample(t0)?;
            let mut rates = vec![0.0; values.len()];
            for k in 0..parts as u64 {
                let next = problem.sample(time((k + 1) as f64))?;
                let dt = (t1 - t0) / parts;
                let before = rate(
                    (problem, span.power),
                    (&sampled, values),
                    (flows, dt),
                    &mut rates,
                );
                finish(problem, (&next, before, dt), &rates, values, flows);
                solver.effort.last += 1;
                sampled = next;
            }
            solver.effort.total += solver.effort.last;
            Ok(())
        }
        Scheme::Trapezoidal => implicit(problem, 0.5, solver, span, values, flows),
        Scheme::BackwardEuler => implicit(problem, 1.0, solver, span, values, flows),
        Scheme::Steady => steady(problem, solver, span, values, flows),
    }
}

/// Sets `rates` to the flow by bonds, conditions and the given power into each point at given values, books the inflow
/// of conditions over a duration, and returns a copy of the values.
fn rate(
    (problem, power): (&Problem, &[f64]),
    (sampled, values): (&Sampled, &[f64]),
    (flows, duration): (&mut [f64], f64),
    rates: &mut [f64],
) -> Vec<f64> {
    rates.fill(0.0);
    problem.diffusion.add_flow(values, rates);
    problem.add_inflow(sampled, values, rates, (flows, duration));
    for (rate, power) in rates.iter_mut().zip(power) {
        *rate += power;
    }
    values.to_vec()
}

/// Sets the values at the end of a step from those before it and the mean rates, and books prescribed values.
///
/// Conservative: the content changes by exactly what has been booked.
fn finish(
    problem: &Problem,
    (sampled, before, dt): (&Sampled, Vec<f64>, f64),
    rates: &[f64],
    values: &mut [f64],
    flows: &mut [f64],
) {
    for (i, value) in values.iter_mut().enumerate() {
        *value = before[i] + dt * rates[i] / problem.capacity()[i];
    }
    problem.prescribe(sampled, values);
    problem.book_prescribed(&|i| values[i] - before[i], &|i| dt * rates[i], flows);
}

/// Newton iterations of an implicit step.
const ITERATIONS: usize = 30;

/// One step of C (T₁ − T₀)/dt = (1 − θ) R₀ + θ R₁.
fn implicit(
    problem: &Problem,
    theta: f64,
    solver: &mut Solver,
    Span {
        times: [t0, t1],
        power,
    }: Span<'_>,
    values: &mut [f64],
    flows: &mut [f64],
) -> Result<()> {
    let (n, dt) = (values.len(), t1 - t0);
    let next = problem.sample(t1)?;
    let mut explicit = vec![0.0; n];
    let before = if theta < 1.0 {
        let now = problem.sample(t0)?;
        let before = rate(
            (problem, power),
            (&now, values),
            (flows, (1.0 - theta) * dt),
            &mut explicit,
        );
        explicit.iter_mut().for_each(|rate| *rate *= 1.0 - theta);
        before
    } else {
        values.to_vec()
    };
    problem.prescribe(&next, values);
    let capacity = problem.capacity();
    let residual = |values: &[f64], out: &mut [f64]| {
        let mut unbooked = vec![0.0; problem.conditions().len()];
        rate((problem, power), (&next, values), (&mut unbooked, 0.0), out);
        for i in 0..n {
            out[i] = explicit[i] + theta * out[i] - capacity[i] * (values[i] - before[i]) / dt;
        }
    };
    // Typical content and flows over the step: their rounding limits the residual. In long steps of good conductors the flows
    // are much larger than the change of the content.
    let domain = problem.domain();
    let most = values
        .iter()
        .chain(&before)
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    let most = domain.max(most);
    let conductance = solver.conductance(problem);
    let rounding = 1e-15 * most * (domain.norm(capacity) / dt + theta * conductance);
    newton(
        problem,
        solver,
        (1.0 / dt, theta, t1),
        &residual,
        values,
        rounding,
    )?;
    // With the rates at the solution the balance is exact, whatever the residual is.
    let mut rates = vec![0.0; n];
    rate(
        (problem, power),
        (&next, values),
        (flows, theta * dt),
        &mut rates,
    );
    for (rate, explicit) in rates.iter_mut().zip(&explicit) {
        *rate = explicit + theta * *rate;
    }
    finish(problem, (&next, before, dt), &rates, values, flows);
    Ok(())
}

/// Solves `residual`(values) = 0 on points without prescribed values.
fn newton(
    problem: &Problem,
    solver: &mut Solver,
    (rate, share, t): (f64, f64, f64),
    residual: &dyn Fn(&[f64], &mut [f64]),
    values: &mut [f64],
    rounding: f64,
) -> Result<()> {
    /// Largest residual relative to the first one.
    const REACHED: f64 = 2e-10;
    let n = values.len();
    let domain = problem.domain();
    let norm = |r: &[f64]| {
        domain
            .sum(n, |i| {
                if problem.is_prescribed(i) {
                    0.0
                } else {
                    r[i] * r[i]
                }
            })
            .sqrt()
    };
    let mut r = vec![0.0; n];
    residual(values, &mut r);
    let first = norm(&r);
    let mut size = first;
    let mut products = 0;
    for _ in 0..ITERATIONS {
        if size <= rounding || size <= REACHED * first {
            return Ok(());
        }
        let mut slope = vec![0.0; n];
        problem.add_exchange_slope(values, &mut slope);
        slope.iter_mut().for_each(|slope| *slope *= share);
        let equations = Equations {
            problem,
            rate,
            share,
            slope: &slope,
        };
        let (correction, used, _) = solver.solve(&equations, &mut r, (size, rounding))?;
        products += used;
        for (value, correction) in values.iter_mut().zip(&correction) {
            *value += correction;
        }
        residual(values, &mut r);
        let before = std::mem::replace(&mut size, norm(&r));
        // Linear equations are solved at once; another correction removes rounding only.
        if !problem.is_nonlinear() && size <= 1e-9 * first {
            return Ok(());
        }
        if !size.is_finite() || (size > 0.9 * before && size <= 1e-9 * first) {
            break;
        }
    }
    if size <= rounding.max(1e-9 * first) {
        return Ok(());
    }
    let residual = size / first;
    Err(HeatError::NotConverged {
        t,
        products,
        residual,
    }
    .into())
}

/// The steady state of the conditions at t₁.
fn steady(
    problem: &Problem,
    solver: &mut Solver,
    Span {
        times: [t0, t1],
        power,
    }: Span<'_>,
    values: &mut [f64],
    flows: &mut [f64],
) -> Result<()> {
    let points = problem.undetermined_points();
    if points > 0 {
        let of = problem.domain().whole_points();
        return Err(HeatError::Undetermined { points, of }.into());
    }
    let sampled = problem.sample(t1)?;
    problem.prescribe(&sampled, values);
    let residual = |values: &[f64], out: &mut [f64]| {
        let mut unbooked = vec![0.0; problem.conditions().len()];
        rate(
            (problem, power),
            (&sampled, values),
            (&mut unbooked, 0.0),
            out,
        );
    };
    let domain = problem.domain();
    let most = values
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    let most = domain.max(most);
    let rounding = 1e-15 * most * solver.conductance(problem);
    newton(problem, solver, (0.0, 1.0, t1), &residual, values, rounding)?;
    // Flows of the steady state: the change of content is not followed.
    let mut rates = vec![0.0; values.len()];
    let duration = t1 - t0;
    rate(
        (problem, power),
        (&sampled, values),
        (flows, duration),
        &mut rates,
    );
    problem.book_prescribed(&|_| 0.0, &|i| duration * rates[i], flows);
    Ok(())
}
