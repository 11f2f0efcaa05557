//! Options of `scheme = "static"`.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;

/// Keys of this scheme only.
pub(crate) const KEYS: [&str; 4] = ["newton_steps", "rigid_modes", "breaking", "control"];

/// Options of the static solver.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statics {
    /// Residual norm relative to the larger norm of loads and reactions.
    pub tolerance: f64,
    /// Largest number of Newton iterations per static state.
    pub newton_steps: u32,
    /// Treatment of rigid-body modes that no support prevents.
    #[serde(default)]
    pub rigid_modes: RigidModes,
    /// Breaking rule for bonds beyond their critical stretch.
    #[serde(default)]
    pub breaking: StaticBreaking,
    /// Control of the loads by a quantity of the displacements.
    #[serde(default)]
    pub control: Option<LoadControl>,
}

/// Control of the loads by a quantity of the displacements that grows in proportion to time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadControl {
    /// A displacement of a probe or a derived quantity.
    pub quantity: String,
    /// Its rate, m/s.
    pub rate: f64,
}

/// Breaking rule for bonds beyond their critical stretch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RigidModes {
    /// The body is rejected.
    #[default]
    Refuse,
    /// They are removed; loads must be in equilibrium.
    Fix,
}

impl Default for Statics {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            newton_steps: 25,
            rigid_modes: RigidModes::default(),
            breaking: StaticBreaking::default(),
            control: None,
        }
    }
}

pub(crate) fn read(table: &Table<'_>) -> Option<Statics> {
    let default = Statics::default();
    let tolerance = table.or("tolerance", default.tolerance, |item| {
        item.within(
            Quantity::Number,
            "a number from 1e-12 to 0.1, the residual relative to loads and reactions",
            |tolerance| (1e-12..=0.1).contains(&tolerance),
        )
    });
    let newton_steps = table.or("newton_steps", default.newton_steps, |item| {
        const MOST: u64 = 1000;
        let count = item.count()?;
        if count <= MOST {
            return Some(count as u32);
        }
        item.out_of_range("a whole number from 1 to 1000");
        None
    });
    let rigid_modes = table.choice_or_first(
        "rigid_modes",
        "treatment of rigid-body modes",
        &[("refuse", RigidModes::Refuse), ("fix", RigidModes::Fix)],
    );
    let breaking = table.choice_or_first(
        "breaking",
        "breaking rule",
        &[
            ("worst-first", StaticBreaking::WorstFirst),
            ("all", StaticBreaking::All),
            ("event", StaticBreaking::Event),
        ],
    );
    let control = match breaking {
        Some(StaticBreaking::Event) => {
            table.forbid(
                "control",
                "breaking = \"event\" follows falling branches and snap-backs itself; end the run by a condition on the quantity in [[time.stop_when]]",
            );
            Some(None)
        }
        _ => table.maybe("control", |item| control(item.table()?)),
    };
    Some(Statics {
        tolerance: tolerance?,
        newton_steps: newton_steps?,
        rigid_modes: rigid_modes?,
        breaking: breaking?,
        control: control?,
    })
}

fn control(table: Table<'_>) -> Option<LoadControl> {
    let quantity = table.required("quantity").and_then(|item| item.text());
    let rate = table.required("rate").and_then(|item| {
        item.within(Quantity::Velocity, "a speed other than 0", |rate| {
            rate != 0.0
        })
    });
    table.finish();
    Some(LoadControl {
        quantity: quantity?,
        rate: rate?,
    })
}
