//! Section 7: nonlinear forces, their approximations, and time integration with them.

use std::rc::Rc;
use std::sync::Arc;

use pericles::System;
use pericles::material::{Approximation, BondMaterial, CubicLaw, PairLaw};
use pericles::operator::Linearisation;
use pericles::space::PointCloud;
use pericles::time::{Implicit, ImplicitRule, Integrator, State, VelocityVerlet};
use pericles_run::RunError;
use pericles_waves::ForceForm;
use pericles_waves::{Trigonometric, TrigonometricOptions};

use super::line::{Method, UNIT, cells_of, march, nodes, pulse, system_as};
use crate::common::difference;
use crate::data::{Case, Found};

const END: f64 = 3.0;
const H: f64 = 0.1;
/// Height of the pulse relative to its width: bonds of length L stretch by some tenths of it.
const HEIGHT: f64 = 0.1;

fn material(law: PairLaw) -> BondMaterial {
    BondMaterial {
        law,
        ..UNIT.material()
    }
}

fn body(law: PairLaw) -> Result<System, RunError> {
    let cloud = nodes(Method::Msv, H)?;
    system_as(&cloud, &material(law), ForceForm::List)
}

fn start(cloud: &PointCloud, height: f64) -> State {
    let mut state = pulse(cloud);
    state.u.iter_mut().for_each(|u| *u *= height);
    state
}

/// Displacement at the end of a motion in `steps` steps of a scheme.
fn moved(
    mut body: System,
    scheme: &mut dyn Integrator,
    height: f64,
    steps: usize,
) -> Result<Vec<f64>, RunError> {
    let mut state = start(&Arc::clone(body.cloud()), height);
    let dt = END / steps as f64;
    march(&mut body, scheme, &mut state, dt, steps, |_, _| {})?;
    Ok(state.u)
}

/// Error of an approximate force for a pulse: the displacement error, its order in the height, and the ratio to the
/// error of `taylor-2` at half the height.
pub(super) fn treatment(case: &Case<'_>) -> Result<Found, RunError> {
    let laws = [
        (
            "green-strain",
            (PairLaw::GreenStrain, CubicLaw::GreenStrain),
        ),
        (
            "literal57",
            (PairLaw::CubicSoftening, CubicLaw::CubicSoftening),
        ),
    ];
    let (exact, cubic) = case.one_of("law", &laws)?;
    let second = PairLaw::Approximated(cubic, Approximation::SecondOrder);
    let treatments = [
        ("taylor-1", PairLaw::Linear),
        ("taylor-2", second),
        (
            "trapezoidal",
            PairLaw::Approximated(cubic, Approximation::Trapezoidal),
        ),
    ];
    let treated = case.one_of("treatment", &treatments)?;
    let run = |law: PairLaw, height: f64| -> Result<Rc<Vec<f64>>, RunError> {
        let key = format!("{law:?} {height}");
        case.once(key, || moved(body(law)?, &mut VelocityVerlet, height, 60))
    };
    let miss = |law, height| -> Result<f64, RunError> {
        Ok(difference(&run(law, height)?, &run(exact, height)?))
    };
    let misses = [miss(treated, HEIGHT)?, miss(treated, 0.5 * HEIGHT)?];
    let cloud = nodes(Method::Msv, H)?;
    Ok(Found::from([
        ("miss", misses[0]),
        ("order", (misses[0] / misses[1]).log2()),
        ("over taylor-2", misses[1] / miss(second, 0.5 * HEIGHT)?),
    ])
    .curve("exact", cloud.axis(0), &run(exact, HEIGHT)?)
    .curve("treated", cloud.axis(0), &run(treated, HEIGHT)?))
}

/// Order of a scheme in the time step with the full nonlinear force, and its error.
pub(super) fn scheme(case: &Case<'_>) -> Result<Found, RunError> {
    type Make = fn(&System) -> Result<Box<dyn Integrator>, RunError>;
    let schemes: [(&str, Make); 4] = [
        ("Störmer–Verlet", |_| Ok(Box::new(VelocityVerlet))),
        ("implicit midpoint, Newton–Krylov", |body| {
            Ok(Box::new(Implicit::new(ImplicitRule::Midpoint, body)?))
        }),
        ("trapezoidal, Newton–Krylov", |body| {
            Ok(Box::new(Implicit::new(ImplicitRule::Trapezoidal, body)?))
        }),
        (
            "trigonometric, split (Gautschi and Deuflhard's type)",
            |body| {
                let options = TrigonometricOptions::default();
                Ok(Box::new(Trigonometric::new(options, body)?))
            },
        ),
    ];
    let make = case.one_of("scheme", &schemes)?;
    let law = PairLaw::GreenStrain;
    let fine = case.once("fine steps".into(), || {
        moved(body(law)?, &mut VelocityVerlet, HEIGHT, 3840)
    })?;
    let miss = |steps| -> Result<f64, RunError> {
        let body = body(law)?;
        let mut scheme = make(&body)?;
        Ok(difference(
            &moved(body, &mut *scheme, HEIGHT, steps)?,
            &fine,
        ))
    };
    let misses = [miss(60)?, miss(120)?];
    Ok([
        ("order", (misses[0] / misses[1]).log2()),
        ("error", misses[0]),
    ]
    .into())
}

/// Dealiased pseudo-spectral force compared with the sum over bonds, relative to the height.
pub(super) fn series(_: &Case<'_>) -> Result<Found, RunError> {
    let cloud = Arc::new(cells_of(-18.0, 36.0, 0.125)?);
    let ring = Arc::new(PointCloud::clone(&cloud).with_periodic_faces()?);
    let material = material(PairLaw::GreenStrain);
    let sums = system_as(&cloud, &material, ForceForm::List)?;
    let waves = system_as(&ring, &material, ForceForm::Spectral)?;
    let run = |body| moved(body, &mut VelocityVerlet, HEIGHT, 60);
    Ok((difference(&run(sums)?, &run(waves)?) / HEIGHT).into())
}

/// Relative difference of the force from its linearisation at the start.
pub(super) fn linearisation(_: &Case<'_>) -> Result<Found, RunError> {
    let body = body(PairLaw::GreenStrain)?;
    let rest = vec![0.0; body.points()];
    let tangent = Linearisation::new(body.operator(), rest);
    let error = |height| tangent.model_error(&start(body.cloud(), height).u);
    let [whole, half] = [error(HEIGHT), error(0.5 * HEIGHT)];
    Ok([("value", (whole / half).log2()), ("error", whole)].into())
}
