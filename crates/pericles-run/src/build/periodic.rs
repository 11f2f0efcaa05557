//! What a periodic body cannot have, found before its points are made.

use pericles::material::{Fracture, SurfaceCorrection};
use pericles::operator::Feature;
use pericles_deck::{BuildError, Fault, Solid};
use pericles_waves::ForceForm;

use super::assembler::Assembler;
use super::refusal::at_path;

impl Assembler<'_> {
    /// Refuses everything at once that a periodic body cannot have.
    pub(super) fn check_periodic(&self, solid: &Solid) -> Result<(), BuildError> {
        if !solid.shape.is_periodic() {
            return Ok(());
        }
        let found = self.found_in(solid);
        let form = solid.material.form;
        let conflicts = form.candidates().iter().map(|&candidate| {
            // A form that does not follow bonds through faces is one conflict; the others are those with a form that does.
            let follows = represents(candidate, Feature::PeriodicFaces);
            let other = if follows {
                candidate
            } else {
                ForceForm::Convolution
            };
            let own = (!follows).then(|| format!("bonds = \"{}\"", form.name()));
            let others = found
                .iter()
                .filter(|(feature, _)| !represents(other, *feature));
            let others = others.map(|(_, words)| words.clone());
            own.into_iter().chain(others).collect::<Vec<_>>()
        });
        match conflicts.min_by_key(Vec::len) {
            Some(conflicts) if !conflicts.is_empty() => {
                Err(at_path("body.periodic", Fault::NotPeriodic { conflicts }))
            }
            _ => Ok(()),
        }
    }

    /// The features of a body, with the words of a deck that ask for them.
    fn found_in(&self, solid: &Solid) -> Vec<(Feature, String)> {
        let material = &solid.material;
        let dimension = solid
            .shape
            .lattice()
            .map_or(3, |lattice| lattice.grid.dimension());
        let law = Feature::of_law(material.bonds.law, dimension);
        let breaks = material.bonds.fracture != Fracture::Unbreakable;
        let corrected = material.surface_correction != SurfaceCorrection::None;
        let of_law = law.map(|law| (law, format!("model = \"{}\"", material.model_name())));
        let others = [
            (
                Feature::Breaking,
                breaks,
                "bonds that break (`fracture_energy`, `critical_stretch`)",
            ),
            (
                Feature::PreCracks,
                !self.model.cracks.is_empty(),
                "pre-cracks ([[crack]])",
            ),
            (
                Feature::Inclusions,
                !material.inclusions.is_empty(),
                "[[material.inclusion]]",
            ),
            (
                Feature::SeveralMaterials,
                !material.parts.is_empty(),
                "[[material.part]]",
            ),
            (
                Feature::SurfaceCorrection,
                corrected,
                "a surface correction",
            ),
        ];
        let others = others.into_iter().filter(|(_, present, _)| *present);
        let others = others.map(|(feature, _, words)| (feature, words.to_owned()));
        of_law.into_iter().chain(others).collect()
    }
}

fn represents(form: ForceForm, feature: Feature) -> bool {
    form.refusal(feature.into()).is_none()
}
