//! `[run]`: the processor that computes the steps.

use pericles_deck_derive::{DeckTable, DeckWords};
use serde::{Deserialize, Serialize};

/// The processor that computes the steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(default)]
pub struct Processor {
    /// Processor of the time steps: `cpu`, or `gpu`, a graphics processor, for scheme = "velocity-verlet" and bond-based
    /// materials on lattices; needs a program with this feature. The command line (`--device`) has priority.
    #[serde(default)]
    #[deck(default)]
    pub device: DeviceKind,
    /// gpu: number of the graphics processor in the list of `pericles devices`, from 0. Default: the first one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[deck(range = at_least(0.0).whole(), forbid_if(device != Some(&DeviceKind::Gpu), OF_GPU))]
    pub adapter: Option<u32>,
    /// gpu: `double` precision; `mixed`, forces in single precision with an error of about 1e-7 of the largest force; or
    /// `auto`, double precision if the graphics processor has it.
    #[serde(default)]
    #[deck(default, forbid_if(device != Some(&DeviceKind::Gpu), OF_GPU))]
    pub precision: DevicePrecision,
}

impl Processor {
    /// Returns whether it is that of a deck without `[run]`.
    pub(crate) fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}

/// Kinds of processors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "kebab-case")]
#[deck(what = "device")]
pub enum DeviceKind {
    /// The processor of the machine.
    #[default]
    Cpu,
    /// A graphics processor.
    Gpu,
}

/// Precision of a graphics processor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "kebab-case")]
#[deck(what = "precision of a device")]
pub enum DevicePrecision {
    /// Double precision if the device has it, else mixed precision.
    #[default]
    Auto,
    /// Double precision.
    Double,
    /// Forces in single precision.
    Mixed,
}

/// Why only graphics processors have a key.
const OF_GPU: &str = "it belongs to device = \"gpu\"";
