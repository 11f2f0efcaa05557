//! Several materials: the classes of bonds, and the density of every point.

use pericles::PointScalar;
use pericles::material::{BondConstants, BondMaterial, Calibration, Fracture, PairClasses};
use pericles::space::PointCloud;
use pericles_deck::{
    BuildError, Caution, Fault, KeyPath, Material, ModelWarning, PartConstants, PartPlace, Remark,
    Solid,
};
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
        (bonds, constants): (&BondMaterial, &BondConstants),
        cloud: &PointCloud,
        sets: &Sets,
        warnings: &mut Vec<ModelWarning>,
    ) -> Result<Composition, BuildError> {
        let material = &solid.material;
        let path = KeyPath::from("material");
        let judged = judged_key(&bonds.fracture, &path);
        self.judge_stretch(constants.critical_stretch, judged, warnings);
        self.judge_stiffness(solid, constants, &path, warnings);
        let mut all = vec![constants.clone()];
        let mut materials = vec![bonds.clone()];
        for (k, part) in material.parts.iter().enumerate() {
            let path = KeyPath::from("material.part").index(k);
            let PartConstants::Bonds { modulus, fracture } = &part.constants else {
                return Err(self.other_kind(&path, &part.name));
            };
            let own = BondMaterial {
                density: part.density,
                modulus: *modulus,
                fracture: *fracture,
                ..bonds.clone()
            };
            materials.push(own.clone());
            let own = self
                .constants_of(solid, &own, cloud)
                .map_err(|error| at_path(&path, error.into()))?;
            let judged = judged_key(fracture, &path);
            self.judge_stretch(own.critical_stretch, judged, warnings);
            self.judge_stiffness(solid, &own, &path, warnings);
            all.push(own);
        }
        let (of_point, density) = self.points_of_parts(material, cloud, sets)?;
        let classes = match of_point {
            None => None,
            Some(of_point) => {
                let mut classes = PairClasses::new(of_point, &all, material.interface.rule)
                    .map_err(|error| at("material.part", error))?;
                for &(pair, stretch) in &material.interface.critical_stretches {
                    let set = classes.set_critical_stretch(pair, stretch);
                    set.map_err(|error| at("material.part", error))?;
                }
                Some(classes)
            }
        };
        all.remove(0);
        Ok(Composition {
            classes,
            materials,
            density,
            parts: all,
        })
    }

    /// The number of every point's material, none if there is one only, and the density.
    pub(super) fn points_of_parts(
        &self,
        material: &Material,
        cloud: &PointCloud,
        sets: &Sets,
    ) -> Result<(Option<Vec<u8>>, PointScalar), BuildError> {
        if material.parts.is_empty() {
            return Ok((None, PointScalar::Uniform(material.density())));
        }
        let mut of_point = vec![0u8; cloud.len()];
        for (k, part) in material.parts.iter().enumerate() {
            // The library refuses more materials than a byte counts.
            let number = (k + 1) as u8;
            match &part.place {
                PartPlace::Set(set) => {
                    let path = KeyPath::from("material.part").index(k);
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
                0 => material.density(),
                number => material.parts[usize::from(number) - 1].density,
            })
            .collect();
        Ok((Some(of_point), PointScalar::PerPoint(densities)))
    }

    /// The refusal of a part whose constants are not of the kind of the body's material.
    pub(super) fn other_kind(&self, path: &KeyPath, part: &str) -> BuildError {
        let (value, allowed) = (
            part.to_owned(),
            "allowed: constants of the kind of the body's material".into(),
        );
        at_path(path, Fault::OutOfRange { value, allowed })
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
    pub(super) fn judge_stretch(
        self,
        stretch: f64,
        path: KeyPath,
        warnings: &mut Vec<ModelWarning>,
    ) {
        const LARGE: f64 = 0.2;
        if stretch.is_finite() && stretch > LARGE {
            warnings.push(Remark::new(path, Caution::LargeStretch { stretch }));
        }
    }
}

/// The key from which the critical stretch of a material follows.
fn judged_key(fracture: &Fracture, path: &KeyPath) -> KeyPath {
    match fracture {
        Fracture::Unbreakable => path.clone(),
        Fracture::CriticalStretch(_) => path.key("critical_stretch"),
        Fracture::Energy { .. } => path.key("fracture_energy"),
    }
}
