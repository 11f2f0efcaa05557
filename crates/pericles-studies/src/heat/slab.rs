//! Slabs whose temperature follows closed forms of Fourier's law.

use std::f64::consts::PI;

use pericles::observe::Field;
use pericles_run::RunError;

use super::{ran, read};
use crate::data::{Case, Found};

/// Conductivity (W/m/K), density (kg/m³), specific heat (J/kg/K), length (m).
const K: f64 = 45.0;
const DENSITY: f64 = 7850.0;
const SPECIFIC: f64 = 460.0;
const LENGTH: f64 = 0.1;
/// Heat transfer coefficient, W/m²/K.
const FILM: f64 = 2000.0;
/// Number of time steps: their error is far below that of the cells.
const STEPS: f64 = 400.0;

/// Conditions at the ends of a slab.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Ends {
    Fixed,
    Insulated,
    Convection,
}

const DIFFUSIVITY: f64 = K / (DENSITY * SPECIFIC);

impl Ends {
    /// End of the run: a tenth of the diffusion time of the slab, or before the far end feels the convection.
    fn end(self) -> f64 {
        match self {
            Self::Convection => (0.25 * LENGTH).powi(2) / (4.0 * DIFFUSIVITY),
            _ => 0.1 * LENGTH * LENGTH / DIFFUSIVITY,
        }
    }

    /// Temperature of Fourier's law, K.
    fn exact(self, x: f64, t: f64) -> f64 {
        let q = PI / LENGTH;
        let decay = |n: f64| (-(n * q).powi(2) * DIFFUSIVITY * t).exp();
        match self {
            Self::Fixed => {
                let term = |n: f64| (n * q * x).sin() * decay(n);
                300.0 + 100.0 * term(1.0) + 30.0 * term(3.0)
            }
            Self::Insulated => 300.0 + 100.0 * (q * x).cos() * decay(1.0),
            Self::Convection if t == 0.0 => 300.0,
            Self::Convection => {
                let (s, h) = (2.0 * (DIFFUSIVITY * t).sqrt(), FILM / K);
                let later = (h * x + h * h * DIFFUSIVITY * t).exp();
                300.0 + 100.0 * (libm::erfc(x / s) - later * libm::erfc(x / s + 0.5 * h * s))
            }
        }
    }

    fn deck(self, cells: usize, m: usize, corrected: bool) -> String {
        let dx = LENGTH / cells as f64;
        // Layers beyond fixed ends continue the temperature as an odd function.
        let beyond = match self {
            Self::Fixed => m as f64 * dx,
            _ => 0.0,
        };
        let q = PI / LENGTH;
        let rate = |n: f64| (n * q).powi(2) * DIFFUSIVITY;
        let series = |decay: [String; 2]| {
            let [first, third] = decay;
            format!(
                "300 + 100*sin({q:?}*x){first} + 30*sin({:?}*x){third}",
                3.0 * q
            )
        };
        let start = series([String::new(), String::new()]);
        let course = series([1.0, 3.0].map(|n| format!("*exp(-{:?}*t)", rate(n))));
        let (start, conditions) = match self {
            Self::Fixed => {
                let of = |set: &str| {
                    format!(
                        "[[thermal.condition]]\nset = \"{set}\"\ntemperature = {{ expression = \"{course}\" }}\n"
                    )
                };
                (start, of("left") + &of("right"))
            }
            Self::Insulated => (format!("300 + 100*cos({q:?}*x)"), String::new()),
            Self::Convection => (
                "300 + 0*x".into(),
                format!(
                    "[[thermal.condition]]\nset = \"left\"\nconvection = {{ coefficient = {FILM:?}, ambient = 400 }}\n"
                ),
            ),
        };
        let layer = match self {
            Self::Fixed => m,
            _ => 1,
        };
        format!(
            r#"
body = {{ shape = "bar", length = {:?}, origin = [{:?}], spacing = {dx:?}, area = 1e-4 }}
material = {{ density = {DENSITY:?}, youngs_modulus = 210e9, horizon_ratio = {m} }}
sets = {{ left = {{ layer = {{ side = "-x", cells = {layer} }} }}, right = {{ layer = {{ side = "+x", cells = {layer} }} }} }}
time = {{ scheme = "thermal", end = {:?}, dt = {:?} }}
[thermal]
conductivity = {K:?}
specific_heat = {SPECIFIC:?}
temperature = {{ expression = "{start}" }}
scheme = "trapezoidal"
surface_correction = {corrected}
{conditions}
"#,
            LENGTH + 2.0 * beyond,
            -beyond,
            self.end(),
            self.end() / STEPS,
        )
    }

    /// Largest error within the slab, relative to 100 K.
    fn error(self, cells: usize, m: usize, corrected: bool) -> Result<f64, RunError> {
        let run = ran(&read(&self.deck(cells, m, corrected))?)?;
        let t = run.state().t;
        let temperatures = run.snapshot().field(Field::Temperature).to_vec();
        let places = run.system().cloud().axis(0).iter().zip(&temperatures);
        let inside = places.filter(|(x, _)| (0.0..LENGTH).contains(*x));
        Ok(inside.fold(0.0, |most, (x, found)| {
            ((found - self.exact(*x, t)).abs() / 100.0).max(most)
        }))
    }
}

/// Error of a slab with `cells` cells and m points in the horizon, and the order of convergence from the case with
/// `coarse` cells and `coarse_m` points.
pub(super) fn slab(case: &Case<'_>) -> Result<Found, RunError> {
    let ends = case.one_of(
        "ends",
        &[
            ("fixed ends", Ends::Fixed),
            ("insulated ends", Ends::Insulated),
            ("convection", Ends::Convection),
        ],
    )?;
    let corrected = case.one_of("correction", &[("none", false), ("surface", true)])?;
    let cells = [case.count("coarse")?, case.count("cells")?];
    let points = [case.count("coarse_m")?, case.count("m")?];
    let coarse = ends.error(cells[0], points[0], corrected)?;
    let fine = ends.error(cells[1], points[1], corrected)?;
    let refinement = cells[1] as f64 / cells[0] as f64;
    Ok(Found::default()
        .value("error", fine)
        .value("order", (coarse / fine).ln() / refinement.ln()))
}
