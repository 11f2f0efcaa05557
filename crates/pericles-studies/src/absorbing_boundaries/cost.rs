//! Errors, memory and wall time of absorbing boundaries by number of steps, compared with a larger body.

use std::sync::Arc;
use std::time::Instant;

use pericles::family::{BondList, VolumeCorrection};
use pericles::material::LinearBond;
use pericles::operator::{BondForce, Breaking, DamageMeasure};
use pericles::time::{State, VelocityVerlet};
use pericles::{PericlesError, PointScalar, Simulation, System};
use pericles_run::RunError;
use pericles_waves::absorbing::history::{
    BlockedHistory, DirectHistory, ExponentialHistory, History, HistoryCost,
};
use pericles_waves::absorbing::{
    AbsorbingEnd, AbsorbingError, ExponentialKernels, GhostKernels, LatticeStencil, LatticeStep,
    OuterLayer, Side, contour_kernels,
};

use super::bar::micromodulus;
use crate::common::{cells, difference, finish, largest};
use crate::data::{Case, Found};

type Micromodulus = fn(f64) -> f64;

/// Homogeneous bar −10 … 10 with a bell-shaped pulse in the middle, E = ρ = 1.
struct Bar {
    reach: usize,
    spacing: f64,
    /// Micromodulus C(ξ).
    micromodulus: Micromodulus,
    dt: f64,
    /// Tolerance of the exponentials.
    tolerance: f64,
    /// Number of nodes over which fields decay beyond the light cone.
    margin: usize,
}

/// Constant micromodulus 3E/δ³, δ = 1.
fn constant(_: f64) -> f64 {
    3.0
}

/// Largest number of steps for direct sums; more would take minutes.
const MOST_DIRECT: usize = 2048;
const MOST_DIRECT_LONG: usize = 8192;
/// Number of steps of the test for growth.
const ENDLESS: usize = 1_000_000;

impl Bar {
    fn of(case: &Case<'_>) -> Result<Self, RunError> {
        let micromoduli: [(&str, Micromodulus); 2] =
            [("gaussian", micromodulus), ("constant", constant)];
        Ok(Self {
            reach: case.count("reach")?,
            spacing: case.number("spacing")?,
            micromodulus: case.one_of("micromodulus", &micromoduli)?,
            dt: case.number("dt")?,
            tolerance: case.number("tolerance")?,
            margin: case.count("margin")?,
        })
    }

    fn stencil(&self) -> Result<LatticeStencil, RunError> {
        let weight = |k| (self.micromodulus)(k as f64 * self.spacing) * self.spacing;
        let weights: Vec<f64> = (1..=self.reach).map(weight).collect();
        Ok(LatticeStencil::new(&weights).map_err(PericlesError::from)?)
    }

    /// Body with this many additional nodes on each side.
    fn body(&self, margin: usize) -> Result<(System, State), RunError> {
        let half = (10.0 / self.spacing).round() as usize + margin;
        let nodes = 2 * half + 1;
        let origin = [-(half as f64 + 0.5) * self.spacing, 0.0, 0.0];
        let size = vec![nodes as f64 * self.spacing];
        let cloud = Arc::new(cells(origin, size, self.spacing)?);
        let horizon = (self.reach as f64 + 0.5) * self.spacing;
        let bonds = BondList::new(&cloud, horizon, VolumeCorrection::None)?;
        let breaking = Breaking {
            critical_stretch: f64::INFINITY,
            no_fail: &[],
        };
        let micromodulus = self.micromodulus;
        let force = BondForce::<LinearBond, 1>::with_stiffness(
            Arc::clone(&cloud),
            bonds,
            &|xi| micromodulus(xi[0].abs()) * xi[0].abs(),
            breaking,
            DamageMeasure::default(),
        )?;
        let density = PointScalar::Uniform(1.0);
        let system = System::new(Arc::clone(&cloud), Box::new(force), density)?;
        let mut state = State::at_rest(cloud.len());
        for (u, x) in state.u.iter_mut().zip(cloud.axis(0)) {
            *u = (-x * x).exp();
        }
        Ok((system, state))
    }

    /// Returns the displacements at the end of a run, and its time in seconds; without histories the ends are free.
    fn run(
        &self,
        steps: usize,
        margin: usize,
        histories: Vec<(Side, Box<dyn History>)>,
    ) -> Result<(Vec<f64>, f64), RunError> {
        let (mut system, state) = self.body(margin)?;
        for (side, history) in histories {
            let end = OuterLayer::of(&system, side, &state, &[])
                .and_then(|layer| AbsorbingEnd::new(layer, history, self.dt))
                .map_err(PericlesError::from)?;
            system.add_boundary(Box::new(end));
        }
        let mut simulation = Simulation::new(
            system,
            Box::new(VelocityVerlet),
            state,
            self.dt,
            steps as u64,
        )?;
        let began = Instant::now();
        finish(&mut simulation)?;
        Ok((simulation.state().u.clone(), began.elapsed().as_secs_f64()))
    }

    fn with_ends<H: History + 'static>(
        &self,
        steps: usize,
        make: impl Fn() -> H,
    ) -> Result<Measured, RunError> {
        let began = Instant::now();
        let histories: Vec<(Side, Box<dyn History>)> = [Side::Left, Side::Right]
            .map(|side| (side, Box::new(make()) as Box<dyn History>))
            .into();
        let bytes = histories.iter().map(|(_, history)| history.bytes()).sum();
        let setup = began.elapsed().as_secs_f64();
        let (u, seconds) = self.run(steps, 0, histories)?;
        Ok(Measured {
            u,
            seconds: seconds + setup,
            bytes,
        })
    }
}

/// Run with two absorbing boundaries.
struct Measured {
    u: Vec<f64>,
    seconds: f64,
    bytes: usize,
}

/// Largest errors of the methods that give the displacements of the larger body, their memory, and the wall times with
/// kernels or fits.
pub(super) fn compared(place: &Case<'_>) -> Result<Found, RunError> {
    let (case, steps, full) = (Bar::of(place)?, place.count("steps")?, place.context.full);
    let stencil = case.stencil()?;
    // Reflections from the ends of the larger body have travelled to them and back.
    let cone = 0.5 * stencil.fastest() * case.dt * steps as f64;
    let (large, seconds_large) = case.run(steps, cone as usize + case.margin, Vec::new())?;
    let extra = (large.len() - case.run(0, 0, Vec::new())?.0.len()) / 2;
    let apart = |u: &[f64]| difference(&large[extra..], u);

    let began = Instant::now();
    let step = LatticeStep::verlet(case.dt);
    let kernels = GhostKernels::shift(contour_kernels(&stencil, step, steps));
    let seconds_kernels = began.elapsed().as_secs_f64();
    let blocked = case.with_ends(steps, || BlockedHistory::new(kernels.clone()))?;
    let form = HistoryCost::estimate(&stencil, step, steps).cheapest(false);
    let mut found = Found::from([
        ("nodes", large.len() as f64),
        ("larger-seconds", seconds_large),
        ("blocks", apart(&blocked.u)),
        ("blocks-memory", 1e-6 * blocked.bytes as f64),
        ("blocks-seconds", seconds_kernels + blocked.seconds),
    ])
    .text("form", format!("{form:?}"));
    let most = if full { MOST_DIRECT_LONG } else { MOST_DIRECT };
    if steps <= most {
        let direct = case.with_ends(steps, || DirectHistory::new(kernels.clone()))?;
        found = found
            .value("sums", apart(&direct.u))
            .value("sums-memory", 1e-6 * direct.bytes as f64);
    }

    let began = Instant::now();
    let fit = ExponentialKernels::fit(
        &stencil,
        LatticeStep::verlet(case.dt),
        steps,
        case.tolerance,
    );
    let seconds_fit = began.elapsed().as_secs_f64();
    match fit {
        Ok(fit) => {
            let made = case.with_ends(steps, || ExponentialHistory::new(fit.clone()))?;
            let text = format!(
                "{} terms of rank one, residual {:.1e}, {:.2} MB",
                fit.terms(),
                fit.residual,
                1e-6 * made.bytes as f64
            );
            Ok(found
                .value("exponentials", apart(&made.u))
                .value("exponentials-seconds", seconds_fit + made.seconds)
                .text("fit", text))
        }
        Err(AbsorbingError::Fit { residual, fits, .. }) => Ok(found
            .value("exponentials", None)
            .value("exponentials-seconds", None)
            .text(
                "fit",
                format!(
                    "no fit within the tolerance after {fits} attempts: best residual {residual:.1e}"
                ),
            )),
        Err(error) => Err(PericlesError::from(error).into()),
    }
}

/// Runs a million steps close to the stability limit, in which nothing may grow.
pub(super) fn million_steps(case: &Case<'_>) -> Result<Found, RunError> {
    let bar = Bar::of(case)?;
    let stencil = bar.stencil()?;
    let began = Instant::now();
    let step = LatticeStep::verlet(bar.dt);
    let kernels = GhostKernels::shift(contour_kernels(&stencil, step, ENDLESS));
    let seconds_kernels = began.elapsed().as_secs_f64();
    let made = bar.with_ends(ENDLESS, || BlockedHistory::new(kernels.clone()))?;
    Ok([
        ("kernels", seconds_kernels),
        ("seconds", made.seconds),
        ("megabytes", 1e-6 * made.bytes as f64),
        ("largest", largest(&made.u)),
    ]
    .into())
}
