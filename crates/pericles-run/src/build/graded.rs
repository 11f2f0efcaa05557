//! Bonds of bodies with refined parts or materials of different horizons.

use pericles::material::{BondMaterial, MaterialPairs, StressState};
use pericles::operator::{CompositeBody, Feature, GradedBody, Materials};
use pericles_deck::{BuildError, Fault};
use pericles_waves::{AssembledForce, ForceForm};

use super::assembler::Assembler;
use super::discretisation::Grids;
use super::materials::Between;
use super::rejection::{at, at_material, at_path};

impl Assembler<'_> {
    pub(super) fn graded_bonds(
        &self,
        (form, state): (ForceForm, StressState),
        composite: &CompositeBody<'_>,
        grids: &Grids,
        (materials, interfaces): (&[BondMaterial], &[Between]),
    ) -> Result<AssembledForce, BuildError> {
        let features = (composite.features())
            .with(Feature::SeveralSpacings, grids.ratios.len() > 1)
            .with(Feature::SeveralHorizons, have_several_horizons(materials));
        form.check(features).map_err(at_material)?;
        GradedBody::check(features).map_err(|error| at("material.surface_correction", error))?;
        if composite.classes.is_some_and(MaterialPairs::scatters) {
            let (value, allowed) = (
                "a distribution of strength".into(),
                "critical stretches of bodies with refined parts or materials of different horizons cannot be scattered or functions of position; use numbers".into(),
            );
            let solid = self.model.body.solid();
            let key = match solid.is_some_and(|solid| solid.material.scatter.is_some()) {
                true => "material.scatter",
                false => "material",
            };
            return Err(at_path(key, Fault::OutOfRange { value, allowed }));
        }
        if composite.softening.is_some() {
            let (value, allowed) = (
                "softening".into(),
                "allowed: no softening; bonds between cells of several sizes or materials of different horizons do not soften".into(),
            );
            return Err(at_path(
                "material.softening",
                Fault::OutOfRange { value, allowed },
            ));
        }
        // Spectral force kernels have been rejected.
        let form = form.of_bonds().unwrap_or_default();
        let body = &composite.body;
        let graded = GradedBody {
            cloud: body.cloud,
            ratios: &grids.ratios,
            grid_of_point: &grids.of_point,
            material: body.material,
            materials: composite.classes.map(|classes| Materials {
                all: materials,
                of_point: classes.of_point(),
                interfaces,
            }),
            state,
            cracks: body.cracks,
            no_fail: body.no_fail,
            stiffness: body.stiffness,
            damage: body.damage,
        };
        Ok(graded.operator(form).map_err(at_material)?.into())
    }
}

/// Returns whether materials have different horizons.
pub(super) fn have_several_horizons(materials: &[BondMaterial]) -> bool {
    materials
        .windows(2)
        .any(|two| two[0].horizon != two[1].horizon)
}
