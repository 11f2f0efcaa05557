//! Pulse on a finite part of the line by the methods of the paper.

use std::sync::Arc;

use pericles::family::VolumeCorrection;
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, Modulus, PairLaw, StressState,
};
use pericles::operator::BondBody;
use pericles::space::{PointCloud, gauss_bar};
use pericles::time::{Implicit, ImplicitRule, Integrator, State, VelocityVerlet};
use pericles::{Interrupt, PointScalar, System};
use pericles_run::RunError;
use pericles_waves::ForceForm;
use pericles_waves::exact::{ExactSolution, LineSolution, TravellingPulse};
use pericles_waves::{Trigonometric, TrigonometricOptions};

use crate::common::{cells, difference};
use crate::data::{Case, Found};

/// Medium: ρ = 1, C(ξ) = 4E/(l³√π) exp(−(ξ/l)²).
#[derive(Debug, Clone, Copy)]
pub(super) struct Medium {
    pub(super) young: f64,
    pub(super) length: f64,
}

pub(super) const UNIT: Medium = Medium {
    young: 1.0,
    length: 1.0,
};

impl Medium {
    pub(super) fn material(self) -> BondMaterial {
        BondMaterial {
            law: PairLaw::Linear,
            density: 1.0,
            modulus: Modulus {
                value: ElasticModulus::Young(self.young),
                calibration: Calibration::Continuum,
            },
            // The Gaussian is below 1e-21 of its maximum beyond.
            horizon: 7.0 * self.length,
            influence: Influence {
                function: InfluenceFunction::Gaussian {
                    length: self.length,
                    cutoff: None,
                },
                acts_on: ActsOn::Displacement,
            },
            volume_correction: VolumeCorrection::None,
            fracture: Fracture::Unbreakable,
        }
    }
}

/// Space and time discretisation, with the names of the paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Method {
    /// Midpoint nodes, Störmer–Verlet.
    Msv,
    /// Midpoint nodes, trigonometric, A + h^γ.
    Mt(Option<f64>),
    /// Midpoint nodes, implicit midpoint.
    Mmi,
    /// Gauss nodes, trigonometric, A + h^γ.
    Gt(Option<f64>),
}

/// Methods by name, with the exponents used for the paper's values, and without regularisation.
const METHODS: [(&str, Method); 6] = [
    ("MSV", Method::Msv),
    ("MT", Method::Mt(None)),
    ("MT, A + h^2.4", Method::Mt(Some(2.4))),
    ("MMI", Method::Mmi),
    ("GT", Method::Gt(None)),
    ("GT, A + h^4", Method::Gt(Some(4.0))),
];

impl Method {
    /// Method of the argument `method`.
    pub(super) fn of(case: &Case<'_>) -> Result<Self, RunError> {
        case.one_of("method", &METHODS)
    }
}

/// Exact solution of the unit medium.
pub(super) const LINE: LineSolution = LineSolution {
    young: 1.0,
    density: 1.0,
    length: 1.0,
    width: 1.0,
    amplitude: 1.0,
    centre: 0.0,
};

/// Exact solution of the local string.
const STRING: TravellingPulse = TravellingPulse {
    speed: 1.0,
    width: 1.0,
    amplitude: 1.0,
    centre: 0.0,
};

/// Half length of the finite domain.
const HALF: f64 = 10.0;

/// Nodes of a method at spacing h: −10, −10 + h … 10, or two in each cell of [−10, 10].
pub(super) fn nodes(method: Method, h: f64) -> Result<Arc<PointCloud>, RunError> {
    let count = (2.0 * HALF / h).round();
    let cloud = match method {
        Method::Gt(_) => gauss_bar(-HALF, count * h, h, 1.0)?,
        _ => cells_of(-HALF - 0.5 * h, (count + 1.0) * h, h)?,
    };
    Ok(Arc::new(cloud))
}

/// Cell centres of a bar.
pub(super) fn cells_of(origin: f64, length: f64, h: f64) -> Result<PointCloud, RunError> {
    cells([origin, 0.0, 0.0], vec![length], h)
}

/// Body with free ends.
pub(super) fn system(cloud: &Arc<PointCloud>, material: &BondMaterial) -> Result<System, RunError> {
    system_as(cloud, material, ForceForm::Convolution)
}

/// Body whose bonds are stored in this form.
pub(super) fn system_as(
    cloud: &Arc<PointCloud>,
    material: &BondMaterial,
    form: ForceForm,
) -> Result<System, RunError> {
    let constants = material.constants(cloud, StressState::Uniaxial)?;
    let body = BondBody::new(cloud, material, &constants);
    let operator = pericles_waves::assemble(&body.into(), form)?.operator;
    Ok(System::new(
        Arc::clone(cloud),
        operator,
        PointScalar::Uniform(material.density),
    )?)
}

pub(super) fn integrator(
    method: Method,
    h: f64,
    system: &System,
) -> Result<Box<dyn Integrator>, RunError> {
    Ok(match method {
        Method::Msv => Box::new(VelocityVerlet),
        Method::Mmi => Box::new(Implicit::new(ImplicitRule::Midpoint, system)?),
        Method::Mt(exponent) | Method::Gt(exponent) => {
            let options = TrigonometricOptions {
                regularisation: exponent.map_or(0.0, |exponent| h.powf(exponent)),
                ..Default::default()
            };
            Box::new(Trigonometric::new(options, system)?)
        }
    })
}

/// Initial state u = exp(−x²), at rest.
pub(super) fn pulse(cloud: &PointCloud) -> State {
    let mut state = State::at_rest(cloud.len());
    for (u, x) in state.u.iter_mut().zip(cloud.axis(0)) {
        *u = (-x.powi(2)).exp();
    }
    state
}

/// Steps a body, also if it becomes unstable, and calls the observer with every state but the first.
pub(super) fn march(
    system: &mut System,
    integrator: &mut dyn Integrator,
    state: &mut State,
    dt: f64,
    steps: usize,
    mut visit: impl FnMut(&System, &State),
) -> Result<(), RunError> {
    integrator.start(system, state);
    for k in 1..=steps {
        integrator.step(system, state, k as f64 * dt, Interrupt::never())?;
        visit(system, state);
    }
    Ok(())
}

/// Solution at the nodes of a method for every step.
struct Reference {
    cloud: Arc<PointCloud>,
    dt: f64,
    fields: Vec<Vec<f64>>,
}

impl Reference {
    fn new(solution: &dyn ExactSolution, cloud: &Arc<PointCloud>, dt: f64, end: f64) -> Self {
        let field = |k: usize| {
            let mut field = vec![0.0; cloud.len()];
            solution.displacement_into(k as f64 * dt, cloud.axis(0), &mut field);
            field
        };
        Self {
            cloud: Arc::clone(cloud),
            dt,
            fields: (1..=(end / dt).round() as usize).map(field).collect(),
        }
    }

    /// Largest difference of two solutions.
    fn distance(&self, other: &Self) -> f64 {
        let pairs = self.fields.iter().zip(&other.fields);
        pairs.map(|(a, b)| difference(a, b)).fold(0.0, f64::max)
    }

    /// Largest error of a method.
    fn error(&self, medium: Medium, method: Method, h: f64) -> Result<f64, RunError> {
        let mut system = system(&self.cloud, &medium.material())?;
        let mut integrator = integrator(method, h, &system)?;
        let mut state = pulse(&self.cloud);
        let mut worst = 0.0;
        let mut exact = self.fields.iter();
        let visit = |_: &System, state: &State| {
            if let Some(exact) = exact.next() {
                worst = difference(&state.u, exact).max(worst);
            }
        };
        let steps = self.fields.len();
        march(
            &mut system,
            &mut *integrator,
            &mut state,
            self.dt,
            steps,
            visit,
        )?;
        Ok(worst)
    }
}

/// Largest error of a method at spacing h over all nodes and steps. The time step is h unless `dt` is given; the
/// reference is the medium unless `string` is set.
fn error_at(case: &Case<'_>, h: f64) -> Result<f64, RunError> {
    let (method, end) = (Method::of(case)?, case.number("end")?);
    let dt = case.optional("dt").unwrap_or(h);
    let medium = Medium {
        young: case.optional("young").unwrap_or(1.0),
        length: case.optional("length").unwrap_or(1.0),
    };
    let (string, gauss) = (case.flag("string"), matches!(method, Method::Gt(_)));
    let key = format!("reference {medium:?} {string} {gauss} {h} {dt} {end}");
    let reference = case.once(key, || {
        let cloud = nodes(method, h)?;
        let line = LineSolution {
            young: medium.young,
            length: medium.length,
            ..LINE
        };
        let solution: &dyn ExactSolution = if string { &STRING } else { &line };
        Ok(Reference::new(solution, &cloud, dt, end))
    })?;
    let key = format!("error {medium:?} {method:?} {string} {h} {dt} {end}");
    case.once(key, || reference.error(medium, method, h))
        .map(|error| *error)
}

/// Tables 1 to 3: largest error.
pub(super) fn error(case: &Case<'_>) -> Result<Found, RunError> {
    let error = error_at(case, case.number("h")?)?;
    Ok([("value", error), ("log10", error.log10())].into())
}

/// Order of the error from 2h to h.
pub(super) fn order(case: &Case<'_>) -> Result<Found, RunError> {
    let h = case.number("h")?;
    Ok((error_at(case, 2.0 * h)? / error_at(case, h)?)
        .log2()
        .into())
}

/// Table 3: difference of the exact solutions of the line and the string, evaluated on a fine grid, and its order
/// from twice the length.
pub(super) fn local_limit(case: &Case<'_>) -> Result<Found, RunError> {
    let [dt, end] = [case.number("dt")?, case.number("end")?];
    let gap = |length: f64| {
        case.once(format!("gap {length}"), || {
            let cloud = nodes(Method::Msv, 0.01)?;
            let exact = LineSolution { length, ..LINE };
            let nonlocal = Reference::new(&exact, &cloud, dt, end);
            Ok(nonlocal.distance(&Reference::new(&STRING, &cloud, dt, end)))
        })
    };
    let length = case.number("length")?;
    let found = Found::from(*gap(length)?);
    match case.flag("order") {
        true => Ok(found.value("order", (*gap(2.0 * length)? / *gap(length)?).log2())),
        false => Ok(found),
    }
}
