//! Graphics processors: `devices` lists them, `--device` chooses one for the steps of a run and for `bench`.

#[cfg(not(feature = "gpu"))]
mod absent;
#[cfg(feature = "gpu")]
mod graphics;

#[cfg(not(feature = "gpu"))]
pub(crate) use absent::{bench, devices, list};
#[cfg(feature = "gpu")]
pub(crate) use graphics::{bench, devices, list};
