//! The options of `scheme = "static"`.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;

/// Keys that belong to the scheme alone.
pub(crate) const KEYS: [&str; 3] = ["newton_steps", "rigid_modes", "breaking"];

/// How static states are found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statics {
    /// Norm of the residual over that of loads or reactions, the larger.
    pub tolerance: f64,
    /// The most steps of Newton's method for one state.
    pub newton_steps: u32,
    /// What is done with rigid-body motions that no support prevents.
    #[serde(default)]
    pub rigid_modes: RigidModes,
    /// Which over-stretched bonds break at a static state.
    #[serde(default)]
    pub breaking: StaticBreaking,
}

/// Which over-stretched bonds break at a static state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StaticBreaking {
    /// Those with the largest stretch over the critical one.
    #[default]
    WorstFirst,
    /// All at once.
    All,
    /// One after the other, at the load at which each reaches its limit.
    Event,
}

/// What is done with rigid-body motions that no support prevents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RigidModes {
    /// The body is refused.
    #[default]
    Refuse,
    /// They are taken out; loads must be in balance.
    Fix,
}

impl Default for Statics {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            newton_steps: 25,
            rigid_modes: RigidModes::default(),
            breaking: StaticBreaking::default(),
        }
    }
}

pub(crate) fn read(table: &Table<'_>) -> Option<Statics> {
    let default = Statics::default();
    let tolerance = table.or("tolerance", default.tolerance, |item| {
        item.within(
            Quantity::Number,
            "a number from 1e-12 to 0.1, the residual over loads and reactions",
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
        "treatment of rigid-body motions",
        &[("refuse", RigidModes::Refuse), ("fix", RigidModes::Fix)],
    );
    let breaking = table.choice_or_first(
        "breaking",
        "rule for breaking",
        &[
            ("worst-first", StaticBreaking::WorstFirst),
            ("all", StaticBreaking::All),
            ("event", StaticBreaking::Event),
        ],
    );
    Some(Statics {
        tolerance: tolerance?,
        newton_steps: newton_steps?,
        rigid_modes: rigid_modes?,
        breaking: breaking?,
    })
}
