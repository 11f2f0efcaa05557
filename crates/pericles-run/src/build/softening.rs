//! Softening of the bonds of each material: a given onset, or the onset that gives a tensile strength.

use pericles::PericlesError;
use pericles::material::{
    BondConstants, BondMaterial, Fracture, FractureCalibration, HomogeneousBonds, MaterialPairs,
    Softening, Strength, TensileStrength,
};
use pericles::space::PointCloud;
use pericles::units::significant;
use pericles_deck::{BuildError, FailureSurface, Fault, KeyPath, Solid};

use super::assembler::Assembler;
use super::rejection::{at, at_path};

/// The softening of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialSoftening {
    /// Law and onset.
    pub softening: Softening,
    /// Strength that keeps bonds elastic until the stress reaches it; the onset of the law is then the smallest one.
    pub strength: Option<Strength>,
    /// Bonds that give the tensile strength in reports: those of the given strength, otherwise those of the fracture
    /// energy.
    pub calibration: FractureCalibration,
}

impl Assembler<'_> {
    /// Returns the softening of a material, `None` if its bonds do not soften or never break. `given` is its tensile
    /// strength and the surface of failure by strength, `path` its table.
    pub(super) fn softening_of(
        &self,
        solid: &Solid,
        (material, constants): (&BondMaterial, &BondConstants),
        (given, surface): (Option<TensileStrength>, Option<&FailureSurface>),
        cloud: &PointCloud,
        path: &KeyPath,
    ) -> Result<Option<MaterialSoftening>, BuildError> {
        let key = path.key("tensile_strength");
        let reject = |value: &str, allowed: &str| {
            let (value, allowed) = (value.into(), allowed.into());
            Err(at_path(&key, Fault::OutOfRange { value, allowed }))
        };
        let Some(own) = solid.material.softening else {
            return match given {
                None => Ok(None),
                Some(_) => reject("a tensile strength", "allowed: with softening bonds"),
            };
        };
        let law = own.law;
        if let (Some(surface), Some(given)) = (surface, given) {
            let surface = surface.surface(given.strength);
            let surface = surface.map_err(|error| at(&key, error))?;
            // Part of f_t/E below which no bond softens, and of s₀, because softening needs an onset below it.
            const LEAST: f64 = 0.2;
            const OF_CRITICAL: f64 = 0.5;
            let least = LEAST * given.strength / constants.young;
            let least_onset = least.min(OF_CRITICAL * constants.critical_stretch);
            return Ok(Some(MaterialSoftening {
                softening: Softening {
                    law,
                    onset: least_onset,
                },
                strength: Some(Strength {
                    surface,
                    least_onset,
                }),
                calibration: given.calibration,
            }));
        }
        match (own.onset_stretch, given) {
            (Some(onset), None) => Ok(Some(MaterialSoftening {
                softening: Softening { law, onset },
                strength: None,
                calibration: calibration_of(material),
            })),
            (None, Some(mut given)) => {
                if solid.shape.has_gauss_nodes() {
                    given.calibration = FractureCalibration::Continuum;
                }
                let bonds = HomogeneousBonds::new(material, constants, cloud, solid.state);
                let softening = bonds.softening(law, given);
                let softening = softening.map_err(|error| match &error {
                    PericlesError::Strength(_) | PericlesError::NotPositive { .. } => {
                        at(&key, error)
                    }
                    _ => at(path, error),
                })?;
                Ok(Some(MaterialSoftening {
                    softening,
                    strength: None,
                    calibration: given.calibration,
                }))
            }
            (None, None) if material.fracture == Fracture::Unbreakable => Ok(None),
            (None, None) => reject(
                "none",
                "allowed: a strength, or an `onset_stretch` of the softening",
            ),
            (Some(_), Some(_)) => reject(
                "a tensile strength",
                "allowed: without the `onset_stretch` of the softening, which determines the strength",
            ),
        }
    }

    /// Returns the softening of the body, whose onset is that of its first material that softens; `None` if the deck has
    /// none.
    pub(super) fn softening_of_body(
        &self,
        solid: &Solid,
        materials: &[Option<MaterialSoftening>],
    ) -> Result<Option<Softening>, BuildError> {
        let first = materials.iter().flatten().next();
        match (first, &solid.material.softening) {
            (None, Some(own)) => {
                let value = own.law.name().into();
                let allowed = "allowed: with a `fracture_energy` or `critical_stretch`; without them bonds never break".into();
                let fault = Fault::OutOfRange { value, allowed };
                Err(at_path("material.softening", fault))
            }
            _ => Ok(first.map(|own| own.softening)),
        }
    }

    /// Returns an error if bonds between two materials, whose failure is given, would break before they soften.
    pub(super) fn check_onset_between(
        &self,
        pair: [u8; 2],
        softening: &[Option<MaterialSoftening>],
        critical_stretch: f64,
        path: &KeyPath,
    ) -> Result<(), BuildError> {
        let onsets = pair.map(|number| softening.get(usize::from(number)));
        let onsets = onsets.into_iter().flatten().flatten();
        let onsets = onsets.map(|own| own.softening.onset);
        let onset = onsets.fold(f64::INFINITY, f64::min);
        if onset < critical_stretch || onset.is_infinite() {
            return Ok(());
        }
        let value = format!("a critical stretch of {}", significant(critical_stretch, 4));
        let allowed = format!(
            "allowed: above {}, the smaller onset of softening of both materials, so that bonds soften before they break; use a larger fracture energy of the interface, or a smaller `tensile_strength` or `onset_stretch`",
            significant(onset, 4)
        );
        Err(at_path(path, Fault::OutOfRange { value, allowed }))
    }

    /// Sets the onsets of the materials of a body, its own first.
    pub(super) fn with_onsets(
        &self,
        classes: MaterialPairs,
        softening: &[Option<MaterialSoftening>],
    ) -> Result<MaterialPairs, BuildError> {
        if softening.iter().all(Option::is_none) {
            return Ok(classes);
        }
        let onset = |own: &Option<MaterialSoftening>| {
            (own.as_ref()).map_or(f64::INFINITY, |own| own.softening.onset)
        };
        let onsets: Vec<f64> = softening.iter().map(onset).collect();
        (classes.with_onsets(&onsets)).map_err(|error| at("material.softening", error))
    }
}

/// Returns the strengths of all materials; none if bonds fail by their stretch. A material whose bonds never break has the
/// strength of the others, which has no effect.
pub(super) fn strengths_of(softening: &[Option<MaterialSoftening>]) -> Vec<Strength> {
    let own = |one: &Option<MaterialSoftening>| one.as_ref()?.strength.clone();
    let Some(first) = softening.iter().find_map(own) else {
        return Vec::new();
    };
    let strengths = softening
        .iter()
        .map(|one| own(one).unwrap_or_else(|| first.clone()));
    strengths.collect()
}

/// Returns the calibration of the fracture energy.
fn calibration_of(material: &BondMaterial) -> FractureCalibration {
    match material.fracture {
        Fracture::Energy { calibration, .. } => calibration,
        Fracture::CriticalStretch(_) | Fracture::Unbreakable => FractureCalibration::default(),
    }
}
