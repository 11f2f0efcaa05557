//! A pulse on a piece of the line, by the paper's methods.

use std::sync::Arc;

use pericles::family::VolumeCorrection;
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, Modulus, PairLaw, StressState,
};
use pericles::operator::BondBody;
use pericles::space::{Grid, PointCloud, Shape, gauss_bar};
use pericles::time::{Implicit, ImplicitRule, Integrator, State, VelocityVerlet};
use pericles::{Interrupt, PointScalar, System};
use pericles_run::RunError;
use pericles_waves::ForceForm;
use pericles_waves::exact::ExactSolution;
use pericles_waves::{Trigonometric, TrigonometricOptions};

/// The medium: ρ = 1, C(ξ) = 4E/(l³√π) exp(−(ξ/l)²).
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
            // Beyond, the Gaussian is below 1e-21 of its height.
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

/// Space and time scheme, by the paper's names.
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

/// The exponents that the paper's numbers were made with.
pub(super) const MT: Method = Method::Mt(Some(2.4));
pub(super) const GT: Method = Method::Gt(Some(4.0));

/// Half the length of the piece of the line.
const HALF: f64 = 10.0;

/// The nodes of a method at spacing h: −10, −10 + h … 10, or two in each cell of [−10, 10].
pub(super) fn nodes(method: Method, h: f64) -> Result<Arc<PointCloud>, RunError> {
    let cells = (2.0 * HALF / h).round();
    let cloud = match method {
        Method::Gt(_) => gauss_bar(-HALF, cells * h, h, 1.0)?,
        _ => cells_of(-HALF - 0.5 * h, (cells + 1.0) * h, h)?,
    };
    Ok(Arc::new(cloud))
}

/// The middles of cells of a bar.
pub(super) fn cells_of(origin: f64, length: f64, h: f64) -> Result<PointCloud, RunError> {
    let grid = Grid {
        shape: Shape::Box {
            origin: [origin, 0.0, 0.0],
            size: vec![length],
        },
        spacing: h,
        section: 1.0,
        holes: Vec::new(),
    };
    Ok(grid.points()?)
}

/// A body with free ends.
pub(super) fn system(cloud: &Arc<PointCloud>, material: &BondMaterial) -> Result<System, RunError> {
    system_as(cloud, material, ForceForm::Convolution)
}

/// A body whose bonds are kept in this form.
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

/// u = exp(−(x/width)²), at rest.
pub(super) fn pulse(cloud: &PointCloud, width: f64) -> State {
    let mut state = State::at_rest(cloud.len());
    for (u, x) in state.u.iter_mut().zip(cloud.axis(0)) {
        *u = (-(x / width).powi(2)).exp();
    }
    state
}

/// Steps a body, blow-up or not, and shows every state but the first.
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

/// A solution at the nodes of a method for every step.
pub(super) struct Reference {
    pub(super) cloud: Arc<PointCloud>,
    pub(super) dt: f64,
    fields: Vec<Vec<f64>>,
}

impl Reference {
    pub(super) fn new(
        solution: &dyn ExactSolution,
        cloud: &Arc<PointCloud>,
        dt: f64,
        steps: usize,
    ) -> Self {
        let field = |k: usize| {
            let mut field = vec![0.0; cloud.len()];
            solution.displacement_into(k as f64 * dt, cloud.axis(0), &mut field);
            field
        };
        Self {
            cloud: Arc::clone(cloud),
            dt,
            fields: (1..=steps).map(field).collect(),
        }
    }

    /// The largest difference of two solutions.
    pub(super) fn distance(&self, other: &Self) -> f64 {
        let pairs = self.fields.iter().zip(&other.fields);
        pairs.fold(0.0, |worst, (a, b)| largest(a, b, worst))
    }

    /// The largest error of a method.
    pub(super) fn error(
        &self,
        medium: Medium,
        method: Method,
        h: f64,
        width: f64,
    ) -> Result<f64, RunError> {
        let mut system = system(&self.cloud, &medium.material())?;
        let mut integrator = integrator(method, h, &system)?;
        let mut state = pulse(&self.cloud, width);
        let mut worst = 0.0;
        let mut exact = self.fields.iter();
        let visit = |_: &System, state: &State| {
            if let Some(exact) = exact.next() {
                worst = largest(&state.u, exact, worst);
            }
        };
        march(
            &mut system,
            &mut *integrator,
            &mut state,
            self.dt,
            self.fields.len(),
            visit,
        )?;
        Ok(worst)
    }
}

/// The largest difference, if it exceeds `worst`.
pub(super) fn largest(a: &[f64], b: &[f64], worst: f64) -> f64 {
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(worst, f64::max)
}
