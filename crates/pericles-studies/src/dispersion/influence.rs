//! The influence function printed as a sum of cosines, and what it keeps of the table it stands for.

use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::StressState;
use pericles_dispersion::tuning::{
    Method, continuum_speeds, fit_cosines, influence_alebrahim, polygon,
};
use pericles_dispersion::{BondLattice, long_wave_speeds};
use pericles_io::{Axis, Curve, LineChart};
use pericles_run::RunError;

use super::figures::write_curves;
use super::models::{model, tuned};
use super::published::PAPER;
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(crate) const STUDY: Study = Study {
    id: "dispersion/influence",
    paper: PAPER,
    title: "The influence function made against dispersion",
    run,
};

fn run(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    const N: f64 = 3.0;
    let on_stretch = |function| Influence {
        function,
        acts_on: ActsOn::Stretch,
    };
    let model = model(StressState::PlaneStrain, N)?;
    let printed = on_stretch(influence_alebrahim(1.0));
    let table = tuned(&model, Method::LeastSquares, Some(0.5))?;
    let exact = table.influence(2, 1.0)?;
    let mut rows = Vec::new();
    let alpha: Vec<f64> = model
        .classes()
        .iter()
        .map(|c| printed.alpha(c.length, N))
        .collect();
    let expected = [3.738, 3.233, 0.474, 0.449, 0.450, 0.445];
    for (number, class) in model.classes().iter().enumerate() {
        let [a, b, _] = class.offset;
        let note = format!("the table it stands for: {:.5}", table.alpha[number]);
        rows.push(
            Row::new(
                format!("printed function at ({a},{b})"),
                "",
                Some(alpha[number]),
            )
            .within(expected[number], 6e-4)
            .note(note),
        );
    }
    let places = |count: u32| (1..=count).map(move |k| N * f64::from(k) / f64::from(count));
    let smallest = places(3000)
        .map(|r| printed.alpha(r, N))
        .fold(f64::INFINITY, f64::min);
    let lattice = model.lattice(&alpha);
    let bonds = model.classes().iter().zip(&alpha);
    let sum: f64 = bonds
        .map(|(c, a)| c.multiplicity as f64 * c.length * a)
        .sum();
    let norm = 2.0 * std::f64::consts::PI * N.powi(3) / 3.0;
    rows.push(Row::new("smallest value", "", Some(smallest)).within(0.427, 6e-4));
    rows.push(
        Row::new(
            "∫α r² dr over that of α = 1",
            "",
            Some(printed.moment(2.0, N) / 9.0),
        )
        .within(0.9784, 6e-5)
        .note("the rounded digits carry 2.2 % less modulus than they should"),
    );
    rows.push(
        Row::new("Σα|ξ| over 2πN³/3", "", Some(sum / norm))
            .within(0.9813, 6e-5)
            .note("modulus = \"lattice\" divides by it"),
    );
    rows.extend(long_waves(&lattice));
    let error = model.assess(&alpha)?.error.ratio;
    rows.push(Row::new("error over that of α = 1", "", Some(error)).within(0.872, 6e-4));
    write_curves(
        context,
        &model,
        "curve-printed",
        "plate, N = 3, printed influence function",
        &alpha,
    )?;

    let InfluenceFunction::Classes(classes) = &exact.function else {
        return Ok(rows);
    };
    let fit = on_stretch(fit_cosines(classes, N, 1.1, 8)?);
    let line = on_stretch(polygon(classes));
    let apart = places(300)
        .map(|r| (fit.alpha(r, N) - line.alpha(r, N)).powi(2))
        .sum::<f64>()
        / 300.0;
    rows.push(
        Row::new(
            "eight cosines fitted to the table's polygon: root mean square",
            "",
            Some(apart.sqrt()),
        )
        .within(0.0, 0.05),
    );
    let Some(path) = context.figure("influence.png") else {
        return Ok(rows);
    };
    let r: Vec<f64> = places(300).collect();
    let curve =
        |influence: &Influence| -> Vec<f64> { r.iter().map(|r| influence.alpha(*r, N)).collect() };
    let lengths: Vec<f64> = model.classes().iter().map(|c| c.length).collect();
    LineChart::new(Axis::new("|ξ|/Δx", ""), Axis::new("α", ""))
        .title("influence functions for N = 3")
        .curve(Curve::line("printed cosines", &r, &curve(&printed)))
        .curve(Curve::line("polygon through the table", &r, &curve(&line)))
        .curve(Curve::line("cosines fitted here", &r, &curve(&fit)).dashed())
        .curve(Curve::points("table", &lengths, &table.alpha))
        .write(path)?;
    Ok(rows)
}

/// Speeds of long waves along an axis and a diagonal over those of the continuum.
fn long_waves(lattice: &BondLattice) -> Vec<Row> {
    let speeds = continuum_speeds(StressState::PlaneStrain);
    let mut rows = Vec::new();
    for (direction, name, expected) in [
        ([1.0, 0.0, 0.0], "0°", [0.986, 1.004]),
        ([1.0, 1.0, 0.0], "45°", [0.995, 0.977]),
    ] {
        let found = long_wave_speeds(lattice, direction);
        let ratios = [found[0] / speeds.pressure, found[1] / speeds.shear];
        for (b, wave) in ["pressure", "shear"].into_iter().enumerate() {
            let case = format!("long {wave} waves at {name}");
            rows.push(Row::new(case, "", Some(ratios[b])).within(expected[b], 6e-4));
        }
    }
    rows
}
