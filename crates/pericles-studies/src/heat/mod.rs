//! Studies of heat conduction and thermal stress, compared with closed forms.

mod expansion;
mod plane_wave;
mod shock;
mod slab;
mod strip;

use pericles::Simulation;
use pericles_deck::Deck;
use pericles_heat::{DiffusingField, SharedField};
use pericles_run::{Resources, RunError, build};

use crate::common::finish;
use crate::data::{Case, Found};
use crate::study::{Topic, data};

/// Studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[
        data!("heat/slabs"),
        data!("heat/plane-waves"),
        data!("heat/balance"),
        data!("heat/expansion"),
        data!("heat/bimaterial-strip"),
        data!("heat/thermal-shock"),
    ],
    measures: &[
        ("slab", slab::slab),
        ("plane wave", plane_wave::decay),
        ("balance", balance),
        ("free", expansion::free),
        ("constrained", expansion::constrained),
        ("strip", strip::curvature),
        ("shock", shock::one),
        ("shocks", shock::several),
    ],
};

/// Builds the simulation of a deck.
fn simulation(text: &str) -> Result<Simulation, RunError> {
    let deck = Deck::parse(text, "study.toml", &[])?;
    Ok(build(&deck, &Resources::default())?.simulation()?)
}

/// Runs a deck to its end.
fn ran(text: &str) -> Result<Simulation, RunError> {
    let mut run = simulation(text)?;
    finish(&mut run)?;
    Ok(run)
}

/// Returns the temperature field of a simulation.
fn field_of(run: &Simulation) -> Option<SharedField> {
    let mut fields = run.system().fields();
    let field = fields.find_map(|field| field.downcast_ref::<DiffusingField>());
    field.map(DiffusingField::shared)
}

/// Returns the change of the heat content less the heat through all conditions, relative to the content.
fn heat_error(run: &Simulation) -> Option<f64> {
    let (t, field) = (run.state().t, field_of(run)?);
    let inflow: f64 = field.flows(t).iter().sum();
    let content = field.content(t);
    Some((content - field.initial_content() - inflow) / content)
}

/// Error of the heat balance of a plate of two materials with a condition and a time integration scheme.
fn balance(case: &Case<'_>) -> Result<Found, RunError> {
    let (scheme, condition) = (case.text("scheme")?, case.text("condition")?);
    let condition = match condition.is_empty() {
        true => String::new(),
        false => format!("[[thermal.condition]]\nset = \"edge\"\n{condition}"),
    };
    let run = ran(&format!(
        r#"
body = {{ shape = "plate", size = [0.06, 0.04], spacing = 0.002, thickness = 0.001, plane = "stress" }}
material = {{ density = 7850, youngs_modulus = 210e9, horizon_ratio = 3 }}
materials = {{ copper = {{ density = 8960, youngs_modulus = 120e9 }} }}
sets = {{ edge = {{ layer = {{ side = "-x", cells = 1 }} }}, upper = {{ where = "y > 0.02" }} }}
assign = [{{ set = "upper", material = "copper" }}]
time = {{ scheme = "thermal", end = 20, dt = 0.5 }}
[thermal]
conductivity = 45
specific_heat = 460
temperature = {{ expression = "300 + 1000*x" }}
scheme = "{scheme}"
material = [{{ name = "copper", conductivity = 400, specific_heat = 385 }}]
{condition}
"#
    ))?;
    Ok(Found::default().value("error", heat_error(&run)))
}
