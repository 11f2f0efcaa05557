//! Surfaces and their materials.

use pericles_manifold::surface::SurfaceChecks;
use pericles_manifold::{PowerMaterial, SurfaceBond};
use serde::{Deserialize, Serialize};

use super::described;

#[derive(Serialize, Deserialize)]
#[serde(remote = "PowerMaterial", deny_unknown_fields)]
struct PowerMaterialForm {
    density: f64,
    kappa: f64,
    alpha: f64,
    p: f64,
    horizon: f64,
    #[serde(with = "crate::form")]
    bond: SurfaceBond,
    self_cell: bool,
    // Infinite for bonds that never break.
    #[serde(with = "crate::form")]
    critical_stretch: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "SurfaceChecks", deny_unknown_fields)]
struct SurfaceChecksForm {
    open: bool,
    #[serde(rename = "several")]
    several_components: bool,
    flip: bool,
}

described!(PowerMaterial: PowerMaterialForm, SurfaceChecks: SurfaceChecksForm);
