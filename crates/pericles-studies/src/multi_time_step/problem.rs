//! Problems of the studies, and the schemes that solve them.

use std::f64::consts::PI;
use std::rc::Rc;

use pericles::Simulation;
use pericles::time::{Integrator, RungeKutta, Tableau, VelocityVerlet};
use pericles_run::{Assembly, Resources, RunError, build};

use crate::common::finish;
use crate::data::Case;
use crate::decks::deck;

/// Single-rate or multirate scheme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Method {
    /// Single-rate Runge–Kutta of this order.
    Uniform(u32),
    /// Velocity Verlet.
    Verlet,
    /// Runge–Kutta of this order with the fine step smaller by this factor.
    Two(u32, u32),
    /// r-RESPA with the fine step smaller by this factor.
    Respa(u32),
}

impl Method {
    /// Scheme of the argument `name`, such as `RK4 with two steps, M = 8`.
    pub(super) fn of(case: &Case<'_>, name: &'static str) -> Result<Self, RunError> {
        const RATIOS: [u32; 5] = [1, 2, 3, 4, 8];
        let mut all = vec![("velocity Verlet".to_owned(), Self::Verlet)];
        for order in [3, 4] {
            all.push((format!("RK{order}"), Self::Uniform(order)));
            let two = |ratio| {
                (
                    format!("RK{order} with two steps, M = {ratio}"),
                    Self::Two(order, ratio),
                )
            };
            all.extend(RATIOS.map(two));
        }
        all.extend(RATIOS.map(|ratio| (format!("r-RESPA, M = {ratio}"), Self::Respa(ratio))));
        let all: Vec<(&str, Self)> = all
            .iter()
            .map(|(name, method)| (&name[..], *method))
            .collect();
        case.one_of(name, &all)
    }

    /// Force evaluations per point and step of the single-rate scheme.
    pub(super) fn stages(self) -> u32 {
        match self {
            Self::Uniform(order) | Self::Two(order, _) => order,
            Self::Verlet | Self::Respa(_) => 1,
        }
    }

    /// Overrides of a multirate deck.
    fn changes(self) -> Vec<String> {
        match self {
            // The scheme of the deck is replaced by one created from the model.
            Self::Uniform(_) | Self::Verlet => Vec::new(),
            Self::Two(order, ratio) => vec![
                format!("time.scheme=multirate-rk{order}"),
                format!("time.ratio={ratio}"),
            ],
            Self::Respa(ratio) => vec!["time.scheme=respa".into(), format!("time.ratio={ratio}")],
        }
    }
}

pub(super) fn tableau(order: u32) -> Result<Tableau, RunError> {
    Ok(match order {
        // Heun's method; the parameter of the paper is not printed.
        3 => Tableau::rk3(0.75)?,
        _ => Tableau::rk4(),
    })
}

/// Modification of the initial state of a case's deck.
type Start = fn(&mut Assembly);

/// Deck of a case, with modifications that decks do not support: the argument `start`.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a> {
    case: &'a Case<'a>,
    start: Start,
}

impl<'a> Problem<'a> {
    pub(super) fn of(case: &'a Case<'a>) -> Result<Self, RunError> {
        let starts: [(&str, Start); 5] = [
            ("deck", |_| ()),
            ("shaken", |assembly| shake(assembly, 0.0, 1.0)),
            ("moving", |assembly| shake(assembly, 1.0, 1.0)),
            ("moving and shaken", |assembly| shake(assembly, 1.0, 10.0)),
            ("breathing", breathe),
        ];
        Ok(Self {
            case,
            start: case.one_of("start", &starts)?,
        })
    }

    pub(super) fn assembly(
        &self,
        method: Method,
        changes: &[String],
    ) -> Result<Assembly, RunError> {
        let mut all = method.changes();
        all.extend_from_slice(changes);
        let mut assembly = build(&deck(self.case, &all)?, &Resources::default())?;
        (self.start)(&mut assembly);
        let one_step: Option<Box<dyn Integrator>> = match method {
            Method::Uniform(order) => {
                let tableau = tableau(order)?;
                Some(Box::new(RungeKutta::new(&tableau, &assembly.system)))
            }
            Method::Verlet => Some(Box::new(VelocityVerlet)),
            _ => None,
        };
        if let Some(scheme) = one_step {
            assembly.integrator = scheme;
        }
        Ok(assembly)
    }

    /// Runs the problem to its end in a number of steps.
    pub(super) fn run(
        &self,
        method: Method,
        steps: u64,
        changes: &[String],
    ) -> Result<Simulation, RunError> {
        let end = deck(self.case, changes)?.model.time.end;
        let mut all = vec![format!("time.dt={:?}", end / steps as f64)];
        all.extend_from_slice(changes);
        let mut simulation = self.assembly(method, &all)?.simulation()?;
        finish(&mut simulation)?;
        Ok(simulation)
    }

    /// Text that identifies a run of the study.
    pub(super) fn key(
        &self,
        method: Method,
        steps: u64,
        changes: &[String],
    ) -> Result<String, RunError> {
        let [deck, start] = [self.case.text("deck")?, self.case.text("start")?];
        let set = self.case.texts("set")?;
        Ok(format!(
            "{deck} {set:?} {start} {method:?} {steps} {changes:?}"
        ))
    }

    /// Displacement at the end, computed once per study.
    pub(super) fn end(
        &self,
        method: Method,
        steps: u64,
        changes: &[String],
    ) -> Result<Rc<End>, RunError> {
        let key = self.key(method, steps, changes)?;
        self.case.once(key, || {
            let run = self.run(method, steps, changes)?;
            Ok(End {
                points: run.system().points(),
                u: run.state().u.clone(),
            })
        })
    }
}

/// End of a run.
pub(super) struct End {
    points: usize,
    /// Displacement.
    pub(super) u: Vec<f64>,
}

impl End {
    /// Displacement u_x.
    pub(super) fn x(&self) -> &[f64] {
        &self.u[..self.points]
    }
}

/// Excites all modes, independently of the order of points.
fn shake(assembly: &mut Assembly, mean: f64, swing: f64) {
    for (k, v) in assembly.state.v.iter_mut().enumerate() {
        *v = mean + swing * ((k * k) as f64).sin();
    }
}

/// Excites the radial oscillation of the grain of the inclusion.
fn breathe(assembly: &mut Assembly) {
    const CENTRE: [f64; 2] = [0.06, 0.05];
    const RADIUS: f64 = 8e-3;
    let n = assembly.cloud.len();
    let grain = assembly.sets.iter().find(|(name, _)| name == "grain");
    for &i in grain.map_or(&[][..], |(_, points)| points) {
        let i = i as usize;
        let place = assembly.cloud.point(i);
        let [x, y] = [place[0] - CENTRE[0], place[1] - CENTRE[1]];
        let r = x.hypot(y);
        let speed = (PI * r / RADIUS).sin();
        let slope = if r > 0.0 { speed / r } else { 0.0 };
        assembly.state.v[i] = slope * x;
        assembly.state.v[n + i] = slope * y;
    }
}

/// |a − b| over |b| in the Euclidean norm.
pub(super) fn relative(a: &[f64], b: &[f64]) -> f64 {
    let square = |x: &mut dyn Iterator<Item = f64>| -> f64 { x.map(|x| x * x).sum() };
    let difference = square(&mut a.iter().zip(b).map(|(a, b)| a - b));
    (difference / square(&mut b.iter().copied())).sqrt()
}
