//! Section 7: nonlinear forces, their treatments, and the schemes on them.

use std::sync::Arc;

use pericles::System;
use pericles::material::{BondMaterial, CubicLaw, PairLaw, Treatment};
use pericles::operator::Linearisation;
use pericles::space::PointCloud;
use pericles::time::{Implicit, ImplicitRule, Integrator, State, VelocityVerlet};
use pericles_io::{Axis, Curve, LineChart};
use pericles_run::RunError;
use pericles_waves::ForceForm;
use pericles_waves::{Trigonometric, TrigonometricOptions};

use super::line::{Method, UNIT, cells_of, largest, march, nodes, pulse, system_as};
use super::paper::PAPER;
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(super) const STUDY: Study = Study {
    id: "nonlocal-wave/nonlinear",
    paper: PAPER,
    title: "Section 7: nonlinear forces, their treatments and the schemes on them",
    run,
};

const END: f64 = 3.0;
const H: f64 = 0.1;
/// Height of the pulse over its width: bonds of an L stretch by some tenths of it.
const HEIGHT: f64 = 0.1;

fn run(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = treatments(context)?;
    rows.extend(schemes()?);
    rows.push(series()?);
    rows.push(linearisation()?);
    Ok(rows)
}

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
    let mut state = pulse(cloud, 1.0);
    state.u.iter_mut().for_each(|u| *u *= height);
    state
}

/// The displacement at the end of a motion in `steps` steps of a scheme.
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

/// What approximations of the force do to a pulse: orders in its height.
fn treatments(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    const STEPS: usize = 60;
    let run = |law, height| moved(body(law)?, &mut VelocityVerlet, height, STEPS);
    let mut rows = Vec::new();
    for (name, exact, cubic) in [
        ("green-strain", PairLaw::GreenStrain, CubicLaw::GreenStrain),
        ("literal57", PairLaw::Literal57, CubicLaw::Literal57),
    ] {
        let mut cubic_misses = Vec::new();
        let mut drawn = vec![("exact", run(exact, HEIGHT)?)];
        for (treatment, law, order) in [
            ("taylor-1", PairLaw::Linear, 2.0),
            (
                "taylor-2",
                PairLaw::Treated(cubic, Treatment::SecondOrder),
                3.0,
            ),
            (
                "trapezoidal",
                PairLaw::Treated(cubic, Treatment::Trapezoidal),
                3.0,
            ),
        ] {
            let miss = |height| -> Result<f64, RunError> {
                Ok(largest(&run(law, height)?, &run(exact, height)?, 0.0))
            };
            let misses = [miss(HEIGHT)?, miss(0.5 * HEIGHT)?];
            let case = format!("{name}, {treatment}: largest miss, height {HEIGHT}");
            rows.push(Row::new(case, "", Some(misses[0])));
            let case = format!("{name}, {treatment}: order of the miss in the height");
            let found = (misses[0] / misses[1]).log2();
            rows.push(Row::new(case, "", Some(found)).within(order, 0.1));
            if order == 3.0 {
                cubic_misses.push(misses[1]);
            }
            drawn.push((treatment, run(law, HEIGHT)?));
        }
        let ratio = cubic_misses[1] / cubic_misses[0];
        let row = Row::new(
            format!("{name}: miss of trapezoidal over that of taylor-2"),
            "",
            Some(ratio),
        );
        rows.push(
            row.within(0.5, 0.02)
                .note("the cubic term is taken 3/2 times, or not at all"),
        );
        if let Some(path) = context.figure(&format!("nonlinear-{name}.png")) {
            let cloud = nodes(Method::Msv, H)?;
            let title = format!("{name}, pulse of height {HEIGHT}, t = {END}");
            let mut chart = LineChart::new(Axis::new("x", ""), Axis::new("u", "")).title(title);
            for (name, u) in &drawn {
                chart = chart.curve(Curve::line(*name, cloud.axis(0), u));
            }
            chart.write(path)?;
        }
    }
    Ok(rows)
}

/// Orders in the step on the true nonlinear force.
fn schemes() -> Result<Vec<Row>, RunError> {
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
    let law = PairLaw::GreenStrain;
    let fine = moved(body(law)?, &mut VelocityVerlet, HEIGHT, 3840)?;
    let mut rows = Vec::new();
    for (name, make) in schemes {
        let miss = |steps| -> Result<f64, RunError> {
            let body = body(law)?;
            let mut scheme = make(&body)?;
            Ok(largest(
                &moved(body, &mut *scheme, HEIGHT, steps)?,
                &fine,
                0.0,
            ))
        };
        let misses = [miss(60)?, miss(120)?];
        let row = Row::new(
            format!("green-strain, {name}: order in the step"),
            "",
            Some((misses[0] / misses[1]).log2()),
        );
        rows.push(row.within(2.0, 0.02));
        let case = format!("green-strain, {name}: error at τ = 0.05");
        rows.push(Row::new(case, "", Some(misses[0])));
    }
    Ok(rows)
}

/// The pseudo-spectral force, dealiased, against the sum over bonds.
fn series() -> Result<Row, RunError> {
    let cloud = Arc::new(cells_of(-18.0, 36.0, 0.125)?);
    let ring = Arc::new(PointCloud::clone(&cloud).with_periodic_faces()?);
    let material = material(PairLaw::GreenStrain);
    let sums = system_as(&cloud, &material, ForceForm::List)?;
    let waves = system_as(&ring, &material, ForceForm::Spectral)?;
    let run = |body| moved(body, &mut VelocityVerlet, HEIGHT, 60);
    let miss = largest(&run(sums)?, &run(waves)?, 0.0) / HEIGHT;
    let row = Row::new(
        "green-strain: Fourier series less sums over bonds, t = 3",
        "",
        Some(miss),
    );
    Ok(row
        .within(0.0, 1e-11)
        .note("over the height; 288 points, twice as many for products, period 36; with 192 points the sums are off by 3e-9, on a period of 24 the ends by 4e-9"))
}

/// How far the force is from its linearisation at the start.
fn linearisation() -> Result<Row, RunError> {
    let body = body(PairLaw::GreenStrain)?;
    let rest = vec![0.0; body.points()];
    let tangent = Linearisation::new(body.operator(), rest);
    let error = tangent.model_error(&start(body.cloud(), HEIGHT).u);
    let case = format!("green-strain: model error of the linearisation, height {HEIGHT}");
    Ok(Row::new(case, "", Some(error)).note("‖f − f₁‖/‖f‖ at the start"))
}
