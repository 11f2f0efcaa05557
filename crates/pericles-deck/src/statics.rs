//! Options of `scheme = "static"`.

use pericles_deck_derive::{DeckTable, DeckWords};
use serde::{Deserialize, Serialize};

use crate::range::{Range, from_to};

/// Options of the static solver.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(default)]
pub struct Statics {
    /// adaptive-dynamic-relaxation, fire, static: residual relative to loads and reactions.
    ///
    /// Relative to the larger norm.
    #[deck(range = RESIDUALS, default = 1e-6)]
    pub tolerance: f64,
    /// static: largest number of Newton iterations per static state.
    #[deck(range = count_to(1000), default = 25)]
    pub newton_steps: u32,
    /// static: rigid-body motions that no support prevents. `refuse`: reject the body and list them; `fix`: remove them;
    /// loads must have zero net force and moment.
    #[serde(default)]
    #[deck(default)]
    pub rigid_modes: RigidModes,
    /// static: which bonds beyond their critical stretch break in a static state before equilibrium is computed again at
    /// the same load. `worst-first`: those within 2 % of the largest ratio of stretch to critical stretch; `all`: all of
    /// them, with fewer static states but more broken bonds; `event`: each load step scales the loads and prescribed
    /// displacements of `end` by the factor at which the next bond reaches its critical stretch, so that
    /// force–displacement curves show snap-back; not for forces that depend on the history of the deformation or on
    /// temperature.
    #[serde(default)]
    #[deck(default)]
    pub breaking: StaticBreaking,
    /// static: a displacement that grows in proportion to time, at the loads that belong to it. All loads and prescribed
    /// displacements are multiples of their values at `end`; their factor is the column `load_factor` of history.csv. The
    /// largest load and the falling branch behind it are followed if the quantity grows along the whole path, as the
    /// opening of a crack mouth does. Not for contact, thermal strain and breaking = "event".
    #[serde(default)]
    #[deck(forbid_if(breaking == Some(&StaticBreaking::Event), FOLLOWS))]
    pub control: Option<LoadControl>,
}

/// Control of the loads of scheme = "static" by a displacement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
pub struct LoadControl {
    /// Name of the displacement of a probe, such as `mouth.u_x`, or of a quantity of `[[output.quantity]]` in metres that
    /// is derived from displacements of probes alone.
    pub quantity: String,
    /// Rate of the quantity: its value at time t is `rate` times t.
    ///
    /// In m/s.
    #[deck(quantity = Velocity, range = NONZERO.described("a speed other than 0"))]
    pub rate: f64,
}

/// Breaking rule for bonds beyond their critical stretch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "kebab-case")]
#[deck(what = "breaking rule")]
pub enum StaticBreaking {
    /// Bonds with the largest ratio of stretch to critical stretch.
    #[default]
    WorstFirst,
    /// All such bonds at once.
    All,
    /// One bond after the other, each at the load at which it reaches its critical stretch.
    Event,
}

/// Treatment of rigid-body modes that no support prevents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "kebab-case")]
#[deck(what = "treatment of rigid-body modes")]
pub enum RigidModes {
    /// The body is rejected.
    #[default]
    Refuse,
    /// They are removed; loads must be in equilibrium.
    Fix,
}

/// Range of relative residuals of static states.
pub(crate) const RESIDUALS: Range = from_to(1e-12, 0.1)
    .described("a number from 1e-12 to 0.1, the residual relative to loads and reactions");

/// Why the load of events is not controlled.
const FOLLOWS: &str = "breaking = \"event\" follows falling branches and snap-backs itself; end the run by a condition on the quantity in [[time.stop_when]]";
