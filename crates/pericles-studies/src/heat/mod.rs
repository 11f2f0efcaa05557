//! Studies of heat conduction and thermal stress, compared with closed forms.

mod expansion;
mod plane_wave;
mod shock;
mod slab;
mod strip;

use pericles::Simulation;
use pericles_deck::Deck;
use pericles_run::{HeatBalance, Resources, RunError, build};

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

/// Reads the text of a deck.
fn read(text: &str) -> Result<Deck, RunError> {
    Ok(Deck::parse(text, "study.toml", &[])?)
}

/// Builds the simulation of a deck.
fn simulation(deck: &Deck) -> Result<Simulation, RunError> {
    Ok(build(deck, &Resources::default())?.simulation()?)
}

/// Runs a deck to its end.
fn ran(deck: &Deck) -> Result<Simulation, RunError> {
    let mut run = simulation(deck)?;
    finish(&mut run)?;
    Ok(run)
}

/// Error of the heat balance of a plate of two materials with a condition and a time integration scheme.
fn balance(case: &Case<'_>) -> Result<Found, RunError> {
    let (scheme, condition) = (case.text("scheme")?, case.text("condition")?);
    let condition = match condition.is_empty() {
        true => String::new(),
        false => format!("[[thermal.condition]]\nset = \"edge\"\n{condition}"),
    };
    let run = ran(&read(&format!(
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
    ))?)?;
    let balance = HeatBalance::of(&run);
    Ok(Found::default().value("error", balance.and_then(|one| one.balance_relative)))
}
