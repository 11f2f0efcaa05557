//! Several materials: assignment to points, and bonds between materials.

use pericles::PointScalar;
use pericles::material::{
    BondConstants, BondMaterial, Calibration, Fracture, InterfaceRule, MaterialPairs,
};
use pericles::space::PointCloud;
use pericles_deck::{
    BuildError, Caution, Fault, InterfaceFailure, KeyPath, Material, MaterialModel,
    MaterialProperty, Solid, shortened, spot,
};
use pericles_waves::ForceForm;

use super::assembler::{Assembler, Warnings};
use super::discretisation::{Discretisation, Sets};
use super::property::multiply;
use super::rejection::{at, at_path};
use super::softening::MaterialSoftening;

/// The materials of a body.
pub(super) struct Composition {
    pub(super) classes: Option<MaterialPairs>,
    /// All materials, the body's material first.
    pub(super) materials: Vec<BondMaterial>,
    /// Interfaces with their own constants.
    pub(super) interfaces: Vec<Between>,
    pub(super) density: PointScalar,
    /// Constants of the other materials, in the order of the deck.
    pub(super) others: Vec<BondConstants>,
    /// Softening of all materials, the body's material first; `None` for bonds that do not soften.
    pub(super) softening: Vec<Option<MaterialSoftening>>,
}

/// The numbers of two materials with the given constants of bonds between them.
pub(super) type Between = ([u8; 2], pericles::material::MaterialInterface);

/// The given constants of bonds between two materials, with the number of the table.
pub(super) struct PairRule<'m> {
    pub(super) pair: [u8; 2],
    pub(super) interface: &'m pericles_deck::MaterialInterface,
    pub(super) path: KeyPath,
}

impl<'m> Assembler<'m> {
    /// Builds the materials of a bond-based body: classes of bonds (`None` for a single material), density, and
    /// constants of the other materials.
    pub(super) fn materials(
        &self,
        solid: &Solid,
        (bonds, constants): (&BondMaterial, &BondConstants),
        discretisation: &Discretisation,
    ) -> Result<Composition, BuildError> {
        let Discretisation { cloud, sets, .. } = discretisation;
        let path = KeyPath::from("material");
        let checked = checked_key(&bonds.fracture, &path);
        self.check_stretch(constants.critical_stretch, checked);
        self.check_stiffness(solid, constants, &path);
        let own = &solid.material;
        let given = (own.tensile_strength, own.strength_surface.as_ref());
        let mut softening =
            vec![self.softening_of(solid, (bonds, constants), given, cloud, &path)?];
        let mut all = vec![constants.clone()];
        let mut materials = vec![bonds.clone()];
        for other in &self.model.materials {
            let path = KeyPath::from("materials").key(&other.name);
            let MaterialModel::Bonds(own) = &other.model else {
                return Err(self.other_kind(&path, &other.name));
            };
            materials.push(own.clone());
            let own_constants = self
                .constants_of(solid, own, cloud)
                .map_err(|error| at_path(&path, error.into()))?;
            let checked = checked_key(&own.fracture, &path);
            self.check_stretch(own_constants.critical_stretch, checked);
            self.check_stiffness(solid, &own_constants, &path);
            let pair = (own, &own_constants);
            let given = (other.tensile_strength, other.strength_surface.as_ref());
            softening.push(self.softening_of(solid, pair, given, cloud, &path)?);
            all.push(own_constants);
        }
        let (of_point, density) = self.points_of_materials(&solid.material, (cloud, sets))?;
        let mut interfaces = Vec::new();
        let strengths = self.strengths(solid, cloud)?;
        // A single material with scattered strength is one class.
        let of_point = of_point.or_else(|| Some(vec![0; strengths.as_ref()?.len()]));
        let classes = match of_point {
            None => None,
            Some(of_point) => {
                let classes = MaterialPairs::new(of_point, &all, InterfaceRule::default());
                let classes = classes.map_err(|error| at("materials", error))?;
                let mut classes = self.with_onsets(classes, &softening)?;
                for (between, path) in self.interfaces(&solid.material)? {
                    let (pair, interface) = &between;
                    let material = &materials[usize::from(pair[0])];
                    let set = classes.set_interface(*pair, interface, material, |across| {
                        self.constants_of(solid, across, cloud)
                    });
                    set.map_err(|error| at_path(&path, error.into()))?;
                    let stretch = classes.pair_critical_stretch(*pair);
                    if interface.fracture.is_some() {
                        self.check_onset_between(between.0, &softening, stretch, &path)?;
                        self.check_stretch(stretch, path);
                    }
                    interfaces.push(between);
                }
                if let Some(strengths) = strengths {
                    classes = classes
                        .with_strengths(strengths)
                        .map_err(|error| at("material.scatter", error))?;
                }
                Some(classes)
            }
        };
        all.remove(0);
        Ok(Composition {
            classes,
            materials,
            interfaces,
            density,
            others: all,
            softening,
        })
    }

    /// Returns the factors of the critical stretch of all points, if strengths are scattered or functions of position.
    pub(super) fn strengths(
        &self,
        solid: &Solid,
        cloud: &PointCloud,
    ) -> Result<Option<Vec<f64>>, BuildError> {
        let scatter = solid.material.scatter;
        let factors = scatter.map(|scatter| scatter.strength().factors(cloud));
        let factors = factors.transpose();
        let factors = factors.map_err(|error| at("material.scatter", error))?;
        Ok(self.varying_strengths(factors))
    }

    /// Returns the interfaces between bond-based materials: for every pair its own table, completed by the table for
    /// all pairs.
    fn interfaces(&self, material: &Material) -> Result<Vec<(Between, KeyPath)>, BuildError> {
        let mut all: Vec<(Between, KeyPath)> = Vec::new();
        for PairRule {
            pair,
            interface,
            path,
        } in self.pair_rules(material)
        {
            let fracture = match interface.failure {
                None => None,
                Some(InterfaceFailure::Bonds(fracture)) => Some(fracture),
                Some(InterfaceFailure::StateBased(_)) => {
                    return Err(self.other_kind(&path, "state-based"));
                }
            };
            let known = all.iter().position(|((known, _), _)| *known == pair);
            let at = known.unwrap_or_else(|| {
                all.push(((pair, Default::default()), path.clone()));
                all.len() - 1
            });
            let ((_, found), at) = &mut all[at];
            if let Some(stiffness) = interface.stiffness {
                found.stiffness = stiffness;
            }
            if fracture.is_some() {
                (found.fracture, *at) = (fracture, path);
            }
        }
        Ok(all)
    }

    /// Returns pairs of materials with their tables, those for all pairs first: later ones take precedence.
    pub(super) fn pair_rules(&self, material: &Material) -> Vec<PairRule<'m>> {
        let others = self.model.materials.iter().map(|other| other.name.as_str());
        let names: Vec<&str> = std::iter::once(material.name()).chain(others).collect();
        // The engine rejects more than 256 materials.
        let count = names.len().min(256);
        let interfaces = self.model.interfaces.iter().enumerate();
        let (general, special): (Vec<_>, Vec<_>) =
            interfaces.partition(|(_, interface)| interface.between.is_none());
        let ordered = general.into_iter().chain(special);
        let found = ordered.flat_map(|(k, interface)| {
            let path = KeyPath::from("interface").index(k);
            let pairs = (0..count).flat_map(move |a| (a + 1..count).map(move |b| [a, b]));
            let joined = pairs.filter(|pair| interface.joins(pair.map(|number| names[number])));
            let rules = joined.map(|pair| PairRule {
                pair: pair.map(|number| number as u8),
                interface,
                path: path.clone(),
            });
            rules.collect::<Vec<_>>()
        });
        found.collect()
    }

    /// As [`Assembler::points_of_materials`], whose warnings the forces report.
    pub(super) fn materials_of_points(
        &self,
        material: &Material,
        place: (&PointCloud, &Sets),
    ) -> Result<(Option<Vec<u8>>, PointScalar), BuildError> {
        let reported = Warnings::default();
        let assembler = Assembler {
            warnings: &reported,
            ..*self
        };
        assembler.points_of_materials(material, place)
    }

    /// Returns the material number of every point (`None` if all points of the body have its own material), and the density.
    pub(super) fn points_of_materials(
        &self,
        material: &Material,
        (cloud, sets): (&PointCloud, &Sets),
    ) -> Result<(Option<Vec<u8>>, PointScalar), BuildError> {
        let others = &self.model.materials;
        let known = |name: &str| others.iter().position(|other| other.name == name);
        let number = |name: &str| match name == material.name() {
            true => Some(0),
            // The engine rejects more than 256 materials.
            false => known(name).map(|k| (k + 1).min(255)),
        };
        let mut of_point = vec![None; cloud.len()];
        let mut last_of: Vec<Option<KeyPath>> = vec![None; others.len() + 1];
        for (path, assigned, material) in self.model.assigned_materials() {
            let Some(number) = number(material) else {
                continue;
            };
            for set in assigned {
                for &i in self.members(sets, set, &path)? {
                    of_point[i as usize] = Some(number as u8);
                }
            }
            last_of[number] = Some(path);
        }
        self.reject_without_material(material, &of_point, cloud)?;
        let of_point: Vec<u8> = of_point
            .into_iter()
            .map(Option::unwrap_or_default)
            .collect();
        let has = |number: u8| !cloud.domain().all(!of_point.contains(&number));
        let own = std::iter::once(material.name()).filter(|_| !material.is_default);
        let own = own.map(|name| (0, name));
        let named = others.iter().map(|other| other.name.as_str());
        for (number, name) in own.chain((1..).zip(named)) {
            match &last_of[number] {
                None => {
                    let caution = Caution::UnusedMaterial {
                        material: name.to_owned(),
                    };
                    self.warn(KeyPath::from("materials").key(name), caution);
                }
                Some(path) if !has(number.min(255) as u8) => {
                    let fault = Fault::other(
                        "no points",
                        format!("no point has the material `{}`", shortened(name)),
                        "later assignments replace all of its points: put the larger set first",
                    );
                    return Err(at_path(path, fault));
                }
                Some(_) => {}
            }
        }
        if cloud
            .domain()
            .all(of_point.iter().all(|&number| number == 0))
        {
            let uniform = PointScalar::Uniform(material.density());
            return Ok((None, self.varying_density(uniform)));
        }
        if let Some(solid) = self.model.body.solid() {
            self.check_layers(solid, cloud, Some(&of_point));
        }
        let densities: Vec<f64> = of_point
            .iter()
            .map(|&number| match number {
                0 => material.density(),
                number => others[usize::from(number) - 1].model.density(),
            })
            .collect();
        let density = self.varying_density(PointScalar::PerPoint(densities));
        Ok((Some(of_point), density))
    }

    /// Rejects points without an assignment, unless they have the material of the body.
    fn reject_without_material(
        &self,
        material: &Material,
        of_point: &[Option<u8>],
        cloud: &PointCloud,
    ) -> Result<(), BuildError> {
        let without = |number: &Option<u8>| number.is_none();
        let points = of_point.iter().filter(|number| without(number)).count();
        let points = cloud.domain().count(points as u64) as usize;
        if points == 0 || material.is_default {
            return Ok(());
        }
        let first = of_point.iter().position(without);
        let place = cloud.first_of_all(first).unwrap_or_default();
        let fault = Fault::other(
            "incomplete",
            format!(
                "{points} of {} points have no material, such as the one at {} m",
                cloud.domain().whole_points(),
                spot(&place[..cloud.dimension()])
            ),
            "assign one with [[assign]], or define [materials.default] for all points without an assignment",
        );
        Err(at_path("assign", fault))
    }

    /// Returns the relative stiffness of each point; empty if it is 1 everywhere.
    pub(super) fn stiffness_of(
        &self,
        cloud: &PointCloud,
        sets: &Sets,
    ) -> Result<Vec<f64>, BuildError> {
        let mut stiffness = Vec::new();
        for (k, assignment) in self.model.assignments.iter().enumerate() {
            let path = KeyPath::from("assign").index(k);
            let Some(given) = assignment.stiffness else {
                continue;
            };
            stiffness.resize(cloud.len(), 1.0);
            for set in &assignment.sets {
                for &i in self.members(sets, set, &path)? {
                    stiffness[i as usize] = given;
                }
            }
        }
        if let Some(factors) = self.properties.factors(MaterialProperty::YoungsModulus) {
            stiffness.resize(cloud.len(), 1.0);
            multiply(&mut stiffness, &factors);
        }
        Ok(stiffness)
    }

    /// Creates the error for a material of another kind than the material of the body.
    pub(super) fn other_kind(&self, path: &KeyPath, material: &str) -> BuildError {
        let (value, allowed) = (
            material.to_owned(),
            "allowed: the same kind as the material of the body, bond-based or state-based".into(),
        );
        at_path(path, Fault::OutOfRange { value, allowed })
    }

    /// Returns the constants of the bonds of a material. Force kernels with integrals, spectral or with Gauss nodes,
    /// use constants of the continuum instead of lattice sums; spectral forces have their stiffness.
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
        let ratio = constants.micromodulus / right.micromodulus;
        let error = match solid.shape.has_gauss_nodes() {
            true => ratio * gauss_stiffness(material, &right, cloud) - 1.0,
            false => ratio - 1.0,
        };
        Ok(BondConstants {
            stiffness_error: error,
            shear_error: error,
            ..constants
        })
    }

    /// Warns of large critical stretches: bonds of real materials break well below a stretch of 20 %.
    pub(super) fn check_stretch(self, stretch: f64, path: KeyPath) {
        const LARGE: f64 = 0.2;
        if stretch.is_finite() && stretch > LARGE {
            self.warn(path, Caution::LargeStretch { stretch });
        }
    }
}

/// Returns the stiffness in the interior of a bar with two Gauss nodes per cell relative to the given one: the sum
/// ½ Σ c α(ξ) κ V ξ over the bonds of a node.
fn gauss_stiffness(material: &BondMaterial, right: &BondConstants, cloud: &PointCloud) -> f64 {
    let (node, volume, horizon) = (cloud.spacing(), cloud.volumes()[0], material.horizon);
    let cell = 2.0 * node;
    let between = cell / 3.0f64.sqrt();
    let reach = material.volume_correction.reach(horizon, node);
    let share = |length: f64| {
        let factor = material.volume_correction.factor(length, horizon, node);
        match length <= reach {
            true => material.influence.alpha(length, horizon) * factor * volume * length,
            false => 0.0,
        }
    };
    let most = (reach / cell).floor() as usize + 1;
    let around = |k: usize| {
        let length = k as f64 * cell;
        2.0 * share(length) + share(length + between) + share(length - between)
    };
    let sum = share(between) + (1..=most).map(around).sum::<f64>();
    0.5 * right.micromodulus * sum / right.young
}

/// Returns the key that determines the critical stretch of a material.
fn checked_key(fracture: &Fracture, path: &KeyPath) -> KeyPath {
    match fracture {
        Fracture::Unbreakable => path.clone(),
        Fracture::CriticalStretch(_) => path.key("critical_stretch"),
        Fracture::Energy { .. } => path.key("fracture_energy"),
    }
}
