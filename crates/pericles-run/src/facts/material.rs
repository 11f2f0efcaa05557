//! Facts of materials and interfaces.

use pericles::kernel::ActsOn;
use pericles::material::{
    BondConstants, BondFailure, BondMaterial, Calibration, Fracture, LinearSolidConstants,
    StateInfluence,
};
use pericles_deck::{
    Correspondence, InterfaceFailure, MaterialInterface, MaterialModel, Model, NamedMaterial,
    Solid, StateBased,
};
use pericles_solids::correspondence::{CorrespondenceConstants, ElasticLaw, Stabilisation};
use serde_json::{Value, json};

use super::list::{Facts, Section};
use crate::build::{Assembly, MaterialConstants};
use crate::strength::{SofteningFacts, StrengthFacts};
use crate::units::{percent, quantity, significant};

impl Facts {
    pub(super) fn solid(&mut self, solid: &Solid, model: &Model, assembly: &Assembly) {
        let section = Section::Material;
        let dimension = assembly.cloud.dimension();
        let constants = assembly.constants.as_ref();
        self.constants(constants, dimension);
        let Some(constants) = constants else {
            return;
        };
        match (&solid.material.model, constants) {
            (MaterialModel::Bonds(material), MaterialConstants::Bonds(constants)) => {
                self.lines(section, bond_based(material, constants, dimension));
            }
            (MaterialModel::StateBased(material), MaterialConstants::StateBased(constants)) => {
                self.lines(section, state_based(material, constants, dimension));
            }
            (
                MaterialModel::Correspondence(material),
                MaterialConstants::Correspondence(constants),
            ) => self.correspondence(material, constants, dimension),
            _ => {}
        }
        self.line(section, "bond failure", breaking(constants));
        self.crack_planes(constants);
        let softening = SofteningFacts::of(model, assembly);
        for material in &softening {
            self.lines(section, material.lines(dimension));
        }
        let strength = StrengthFacts::of(model, assembly);
        for material in &strength {
            self.lines(section, material.lines());
        }
        self.unprinted(section)
            .entries("softening", &softening, true)
            .entries("strength_failure", &strength, true);
        let others = model.materials.iter().zip(&assembly.other_materials);
        let others = others.map(|(other, own)| other_material(other, own));
        self.list(section, "materials", false, others);
        let speeds = constants.waves(solid.material.density(), solid.state);
        let mut waves = format!("pressure {} m/s", speed(speeds.pressure));
        if let Some(transverse) = speeds.transverse {
            waves += &format!(
                ", shear {} m/s, Rayleigh {} m/s",
                speed(transverse.shear),
                speed(transverse.rayleigh)
            );
        }
        let speeds = json!({
            "pressure": speeds.pressure,
            "shear": speeds.transverse.map(|transverse| transverse.shear),
            "rayleigh": speeds.transverse.map(|transverse| transverse.rayleigh),
        });
        self.line(section, "waves", waves)
            .checked("wave_speeds", "m/s", speeds);
        let interfaces = model.interfaces.iter().map(interface);
        self.list(section, "interfaces", false, interfaces);
    }

    /// Adds the constants of the body's material, and the errors of the stiffness in the interior of the grid. Surfaces have no
    /// constants.
    pub(super) fn constants(&mut self, constants: Option<&MaterialConstants>, dimension: usize) {
        let finite = |value: fn(&MaterialConstants) -> f64| {
            constants.map(value).filter(|value| value.is_finite())
        };
        let bonds = constants.and_then(MaterialConstants::bonds);
        let state_based = constants.and_then(MaterialConstants::state_based);
        let elastic = state_based.filter(|_| dimension > 1);
        let elastic = elastic.map(|constants| constants.elastic);
        let shear = state_based.and_then(|constants| constants.lattice_shear);
        let axes = shear.map(|shear| shear.axes - 1.0);
        // The bulk stiffness of state-based materials is exact for any points.
        let bulk = constants.map(|_| bonds.map_or(0.0, |constants| constants.stiffness_error));
        let calibration = constants.and_then(MaterialConstants::fracture_calibration);
        self.unprinted(Section::Material)
            .fact(
                "youngs_modulus",
                "Pa",
                constants.map(MaterialConstants::young),
            )
            .some(
                "poisson_ratio",
                "",
                elastic.map(|elastic| elastic.poisson_ratio()),
            )
            .some("bulk_modulus", "Pa", elastic.map(|elastic| elastic.bulk()))
            .some(
                "shear_modulus",
                "Pa",
                elastic.map(|elastic| elastic.shear()),
            )
            .fact(
                "micromodulus",
                "",
                bonds.map(|constants| constants.micromodulus),
            )
            .some(
                "critical_bond_energy",
                "J/m6",
                finite(MaterialConstants::critical_bond_energy),
            )
            .fact(
                "fracture_energy",
                "J/m2",
                finite(MaterialConstants::fracture_energy),
            )
            .some(
                "fracture_calibration",
                "",
                calibration.map(|given| given.name()),
            )
            .fact("stiffness_error", "", bulk)
            .fact(
                "shear_error",
                "",
                bonds.map(|constants| constants.shear_error).or(axes),
            )
            .some(
                "diagonal_shear_error",
                "",
                shear.map(|shear| shear.diagonals - 1.0),
            );
        if constants.is_some() {
            let stretch = finite(MaterialConstants::critical_stretch);
            self.unprinted(Section::Material)
                .fact("critical_stretch", "", stretch);
        }
    }

    /// Adds elastic constants, elastic law, zero-energy mode control and plastic constants.
    fn correspondence(
        &mut self,
        material: &Correspondence,
        constants: &CorrespondenceConstants,
        dimension: usize,
    ) {
        let section = Section::Material;
        let anisotropic = material.anisotropy.is_some();
        let law = match constants.point.law {
            ElasticLaw::StVenantKirchhoff if anisotropic => {
                "St Venant–Kirchhoff with an anisotropic stiffness, of which elastic constants and wave speeds are Voigt's average"
            }
            ElasticLaw::StVenantKirchhoff => {
                "St Venant–Kirchhoff: for small strain and any rotation; softens in compression"
            }
            ElasticLaw::NeoHooke => "neo-Hookean",
            ElasticLaw::NeoHookeSplit => "neo-Hookean, volumetric–isochoric split",
            ElasticLaw::Hencky => "Hencky: linear in the logarithmic strain",
        };
        let control = match material.stabilisation {
            Stabilisation::Isotropic => "isotropic: objective",
            Stabilisation::Wan => {
                "Wan: does not conserve angular momentum near surfaces at large rotations"
            }
            Stabilisation::Silling => "Silling: stiffens waves with wavelengths of a few horizons",
            Stabilisation::None => {
                "none: short waves are too slow, and the checkerboard mode has zero energy"
            }
        };
        let lines = [
            elastic_constants(&constants.solid, dimension),
            ("elastic law", law.into()),
            ("stabilisation", control.into()),
        ];
        self.lines(section, lines);
        if let Some(plasticity) = &material.plasticity {
            let (stress, hardening) = (plasticity.yield_stress, plasticity.hardening);
            let text = format!(
                "von Mises, yield stress {}, hardening modulus {}",
                quantity(stress, "Pa"),
                quantity(hardening, "Pa")
            );
            let value = json!({ "yield_stress": stress, "hardening": hardening });
            self.line(section, "plasticity", text)
                .checked("plasticity", "Pa", value);
        }
    }

    /// Adds the energies of cracks along lattice planes.
    fn crack_planes(&mut self, constants: &MaterialConstants) {
        let planes: Vec<(String, f64)> = (constants.crack_planes().iter())
            .map(|plane| {
                let deviation = plane.energy() / constants.fracture_energy() - 1.0;
                (plane.to_string(), deviation)
            })
            .collect();
        if planes.is_empty() {
            return;
        }
        let words = planes.iter();
        let words: Vec<String> = words
            .map(|(plane, found)| format!("{plane} {}", deviation(*found)))
            .collect();
        let calibration = match constants.fracture_calibration() {
            Some(calibration) => format!(" (fracture_calibration = \"{}\")", calibration.name()),
            None => String::new(),
        };
        let text = format!(
            "energy per area relative to the fracture energy: {}{calibration}",
            words.join(", ")
        );
        let values = planes.iter();
        let values: Vec<Value> = values
            .map(|(plane, deviation)| json!({ "plane": plane, "deviation": deviation }))
            .collect();
        self.line(Section::Material, "crack planes", text)
            .fact("crack_planes", "", values);
    }
}

fn bond_based(
    material: &BondMaterial,
    constants: &BondConstants,
    dimension: usize,
) -> [(&'static str, String); 3] {
    let acts_on = match material.influence.acts_on {
        ActsOn::Stretch => "s",
        ActsOn::Displacement => "η",
    };
    let constant = format!(
        "{:.6e} (SI, of the force density c α {acts_on})",
        constants.micromodulus
    );
    [
        ("Young's modulus", quantity(constants.young, "Pa")),
        ("bond constant c", constant),
        (
            "stiffness error",
            stiffness_error(material, constants, dimension),
        ),
    ]
}

/// Elastic constants, and the anisotropy of the grid's interior.
fn state_based(
    material: &StateBased,
    constants: &LinearSolidConstants,
    dimension: usize,
) -> Vec<(&'static str, String)> {
    let mut lines = vec![elastic_constants(constants, dimension)];
    if let Some(shear) = constants.lattice_shear {
        /// Smaller errors get no advice.
        const NOTICED: f64 = 0.01;
        let [axes, diagonals] = [shear.axes, shear.diagonals].map(|ratio| ratio - 1.0);
        let mut text = format!(
            "shear along the axes {}, along the diagonals {}, bulk exact (interior of the grid)",
            deviation(axes),
            deviation(diagonals)
        );
        let isotropic = material.solid.influence == StateInfluence::Isotropic;
        if axes.abs() > NOTICED && !isotropic {
            text += "; eliminated by influence = { function = \"isotropic\" }";
        }
        lines.push(("stiffness error", text));
    }
    lines
}

fn elastic_constants(constants: &LinearSolidConstants, dimension: usize) -> (&'static str, String) {
    let elastic = &constants.elastic;
    let mut text = format!("E = {}", quantity(elastic.young(), "Pa"));
    if dimension > 1 {
        text += &format!(
            ", ν = {}, K = {}, G = {}",
            significant(elastic.poisson_ratio(), 4),
            quantity(elastic.bulk(), "Pa"),
            quantity(elastic.shear(), "Pa")
        );
    }
    ("elastic constants", text)
}

/// The line of a material of `[materials]`.
fn other_material(other: &NamedMaterial, own: &MaterialConstants) -> (&'static str, String, Value) {
    let finite = |x: f64| x.is_finite().then_some(x);
    let elastic = own
        .state_based()
        .map(|constants| constants.elastic.poisson_ratio());
    let ratio = elastic.map_or_else(String::new, |ratio| {
        format!(", ν = {}", significant(ratio, 4))
    });
    let text = format!(
        "{}: Young's modulus {}{ratio}, density {} kg/m³, horizon {}; bond failure {}",
        other.name,
        quantity(own.young(), "Pa"),
        significant(other.model.density(), 4),
        quantity(other.model.horizon(), "m"),
        breaking(own)
    );
    let mut entry = json!({
        "name": other.name,
        "youngs_modulus": own.young(),
        "density": other.model.density(),
        "horizon": other.model.horizon(),
        "critical_stretch": finite(own.critical_stretch()),
        "fracture_energy": finite(own.fracture_energy()),
    });
    if let Some(ratio) = elastic {
        entry["poisson_ratio"] = ratio.into();
        entry["critical_bond_energy"] = finite(own.critical_bond_energy()).into();
    }
    ("material", text, entry)
}

/// The line of an interface: how the bonds between two materials break.
fn interface(interface: &MaterialInterface) -> (&'static str, String, Value) {
    let pair = match &interface.between {
        Some([a, b]) => format!("{a} and {b}"),
        None => "all pairs of materials".into(),
    };
    let (stretch, energy) = match interface.failure {
        Some(
            InterfaceFailure::Bonds(Fracture::CriticalStretch(stretch))
            | InterfaceFailure::StateBased(BondFailure::CriticalStretch(stretch)),
        ) => (Some(stretch), None),
        Some(
            InterfaceFailure::Bonds(Fracture::Energy { energy, .. })
            | InterfaceFailure::StateBased(
                BondFailure::Stretch {
                    fracture_energy: energy,
                    ..
                }
                | BondFailure::BondEnergy {
                    fracture_energy: energy,
                    ..
                },
            ),
        ) => (None, Some(energy)),
        Some(
            InterfaceFailure::Bonds(Fracture::Unbreakable)
            | InterfaceFailure::StateBased(BondFailure::Unbreakable | BondFailure::ByCriterion),
        )
        | None => (None, None),
    };
    let fails = match (stretch, energy) {
        (Some(stretch), _) => format!("at stretch {}", significant(stretch, 4)),
        (_, Some(energy)) => format!("by a fracture energy of {}", quantity(energy, "J/m²")),
        _ => "as that of the weaker material".into(),
    };
    let text = format!("{pair}: bond failure {fails}");
    let entry = json!({
        "between": interface.between,
        "critical_stretch": stretch,
        "fracture_energy": energy,
    });
    ("interface", text, entry)
}

/// Formats a speed in whole metres per second, or with three digits if it is small.
fn speed(speed: f64) -> String {
    match speed.abs() >= 100.0 {
        true if speed < 1e7 => format!("{speed:.0}"),
        _ => significant(speed, 3),
    }
}

/// Error of the stiffness in the grid's interior, and how to reduce it.
fn stiffness_error(material: &BondMaterial, constants: &BondConstants, dimension: usize) -> String {
    /// Smaller errors get no advice.
    const NOTICED: f64 = 0.01;
    let mut line = format!("bulk {}", deviation(constants.stiffness_error));
    if dimension > 1 {
        line += &format!(
            ", shear along the axes {}",
            deviation(constants.shear_error)
        );
    }
    line += " (interior of the grid)";
    let calibration = material.modulus.calibration;
    if constants.stiffness_error.abs() > NOTICED && calibration == Calibration::Continuum {
        line += "; modulus = \"lattice\" eliminates the bulk error";
    }
    line
}

/// Formats a relative deviation with its sign; rounding errors become 0.
fn deviation(ratio: f64) -> String {
    // Adding +0 turns −0 into 0.
    let rounded = (ratio * 1e6).round() * 1e-6 + 0.0;
    let sign = if rounded > 0.0 { "+" } else { "" };
    format!("{sign}{}", percent(rounded))
}

/// Failure criterion of the bonds.
fn breaking(constants: &MaterialConstants) -> String {
    let (stretch, energy) = (
        constants.critical_stretch(),
        constants.critical_bond_energy(),
    );
    let limit = if stretch.is_finite() {
        format!("at stretch {}", significant(stretch, 4))
    } else if energy.is_finite() {
        format!("at bond energy {}", quantity(energy, "J/m⁶"))
    } else if let Some(criterion) = constants.criterion() {
        return criterion.words();
    } else {
        return "never".into();
    };
    let fracture = quantity(constants.fracture_energy(), "J/m²");
    format!("{limit}, fracture energy {fracture}")
}
