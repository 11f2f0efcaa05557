//! Several materials: the classes of bonds, and the density of every point.

use pericles::PointScalar;
use pericles::material::{BondConstants, BondMaterial, Calibration, Fracture, PairClasses};
use pericles::space::PointCloud;
use pericles_deck::{BuildError, Caution, Fault, KeyPath, ModelWarning, PartPlace, Remark, Solid};
use pericles_waves::ForceForm;

use super::assembler::Assembler;
use super::discretisation::Sets;
use super::refusal::{at, at_path};

/// What a body is made of.
pub(super) struct Composition {
    pub(super) classes: Option<PairClasses>,
    /// All materials, the body's own first.
    pub(super) materials: Vec<BondMaterial>,
    pub(super) density: PointScalar,
    /// Constants of the other materials, in the order of the deck.
    pub(super) parts: Vec<BondConstants>,
}

impl Assembler<'_> {
    /// The classes of bonds between materials, none if there is one material only, the density, and the constants of the parts.
    pub(super) fn parts(
        &self,
        solid: &Solid,
        cloud: &PointCloud,
        sets: &Sets,
        constants: &BondConstants,
        warnings: &mut Vec<ModelWarning>,
    ) -> Result<Composition, BuildError> {
        let material = &solid.material;
        self.judge_stretch(
            constants,
            &material.bonds.fracture,
            &"material".into(),
            warnings,
        );
        self.judge_stiffness(solid, constants, &"material".into(), warnings);
        if material.parts.is_empty() {
            return Ok(Composition {
                classes: None,
                materials: vec![material.bonds.clone()],
                density: PointScalar::Uniform(material.bonds.density),
                parts: Vec::new(),
            });
        }
        let mut all = vec![constants.clone()];
        let mut materials = vec![material.bonds.clone()];
        let mut of_point = vec![0u8; cloud.len()];
        for (k, part) in material.parts.iter().enumerate() {
            let path = KeyPath::from("material.part").index(k);
            let own = BondMaterial {
                density: part.density,
                modulus: part.modulus,
                fracture: part.fracture,
                ..material.bonds.clone()
            };
            materials.push(own.clone());
            let own = self
                .constants_of(solid, &own, cloud)
                .map_err(|error| at_path(&path, error.into()))?;
            self.judge_stretch(&own, &part.fracture, &path, warnings);
            self.judge_stiffness(solid, &own, &path, warnings);
            all.push(own);
            // The library refuses more materials than a byte counts.
            let number = (k + 1) as u8;
            match &part.place {
                PartPlace::Set(set) => {
                    for &i in self.members(sets, set, &path)? {
                        of_point[i as usize] = number;
                    }
                }
                PartPlace::Blocks(blocks) => {
                    for i in (0..cloud.len()).filter(|&i| blocks.contains(&cloud.block(i))) {
                        of_point[i] = number;
                    }
                }
            }
        }
        for (k, part) in material.parts.iter().enumerate() {
            if !of_point.contains(&((k + 1) as u8)) {
                let part = part.name.clone();
                let path = KeyPath::from("material.part").index(k);
                return Err(at_path(&path, Fault::EmptyPart { part }));
            }
        }
        let densities: Vec<f64> = of_point
            .iter()
            .map(|&number| match number {
                0 => material.bonds.density,
                number => material.parts[usize::from(number) - 1].density,
            })
            .collect();
        let mut classes = PairClasses::new(of_point, &all, material.interface.rule)
            .map_err(|error| at("material.part", error))?;
        for &(pair, stretch) in &material.interface.critical_stretches {
            let set = classes.set_critical_stretch(pair, stretch);
            set.map_err(|error| at("material.part", error))?;
        }
        all.remove(0);
        Ok(Composition {
            classes: Some(classes),
            materials,
            density: PointScalar::PerPoint(densities),
            parts: all,
        })
    }

    /// The constants of a material's bonds. Forces that take integrals, by a spectrum or at Gauss nodes, have the errors of the integrals, not those of sums over
    /// a lattice.
    pub(super) fn constants_of(
        &self,
        solid: &Solid,
        material: &BondMaterial,
        cloud: &PointCloud,
    ) -> pericles::Result<BondConstants> {
        let constants = material.constants(cloud, solid.state)?;
        let integrals = solid.material.form == ForceForm::Spectral || solid.shape.has_gauss_nodes();
        if !integrals {
            return Ok(constants);
        }
        let mut right = material.clone();
        right.modulus.calibration = Calibration::Continuum;
        let right = right.constants(cloud, solid.state)?;
        let error = constants.micromodulus / right.micromodulus - 1.0;
        Ok(BondConstants {
            stiffness_error: error,
            shear_error: error,
            ..constants
        })
    }

    /// Bonds of real materials break long before they are a fifth longer.
    fn judge_stretch(
        self,
        constants: &BondConstants,
        fracture: &Fracture,
        path: &KeyPath,
        warnings: &mut Vec<ModelWarning>,
    ) {
        const LARGE: f64 = 0.2;
        let stretch = constants.critical_stretch;
        if stretch.is_finite() && stretch > LARGE {
            let path = match fracture {
                Fracture::Unbreakable => path.clone(),
                Fracture::CriticalStretch(_) => path.key("critical_stretch"),
                Fracture::Energy { .. } => path.key("fracture_energy"),
            };
            warnings.push(Remark::new(path, Caution::LargeStretch { stretch }));
        }
    }
}
