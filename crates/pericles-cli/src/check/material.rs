//! Lines of `check` about materials.

use pericles::kernel::ActsOn;
use pericles::material::{
    BondConstants, BondFailure, BondMaterial, Calibration, Fracture, LinearSolidConstants,
    StateInfluence,
};
use pericles_deck::{
    Correspondence, InterfaceFailure, MaterialInterface, MaterialModel, NamedMaterial, Solid,
    StateBased, SurfaceBody, VertexAreas,
};
use pericles_manifold::SurfaceBond;
use pericles_manifold::geodesic::Ball;
use pericles_manifold::surface::AreaRule;
use pericles_run::units::{percent, quantity, significant};
use pericles_run::{Facts, MaterialConstants};
use pericles_solids::correspondence::{CorrespondenceConstants, ElasticLaw, Stabilisation};
use serde_json::json;

use super::line::Line;

pub(super) fn material(
    solid: &Solid,
    constants: &MaterialConstants,
    facts: &Facts,
    others: (&[NamedMaterial], &[MaterialConstants]),
) -> Vec<Line> {
    let mut lines = match (&solid.material.model, constants) {
        (MaterialModel::Bonds(material), MaterialConstants::Bonds(constants)) => {
            bond_based(material, constants, facts)
        }
        (MaterialModel::StateBased(material), MaterialConstants::StateBased(constants)) => {
            state_based(material, constants, facts)
        }
        (MaterialModel::Correspondence(material), MaterialConstants::Correspondence(constants)) => {
            correspondence(material, constants, facts)
        }
        _ => Vec::new(),
    };
    lines.push(Line::new("bond failure", breaking(constants)));
    if !facts.crack_planes.is_empty() {
        lines.push(Line::new("crack planes", crack_planes(facts)));
    }
    for material in &facts.softening {
        let found = material.lines(facts.dimension).into_iter();
        lines.extend(found.map(|(name, text)| Line::new(name, text)));
    }
    for material in &facts.strength_failure {
        let found = material.lines().into_iter();
        lines.extend(found.map(|(name, text)| Line::new(name, text)));
    }
    for (other, own) in others.0.iter().zip(others.1) {
        lines.push(other_material(other, own));
    }
    let speeds = constants.waves(solid.material.density(), solid.state);
    let mut waves = format!("pressure {} m/s", speed(speeds.pressure));
    if let Some(transverse) = speeds.transverse {
        waves += &format!(
            ", shear {} m/s, Rayleigh {} m/s",
            speed(transverse.shear),
            speed(transverse.rayleigh)
        );
    }
    lines.push(Line::new("waves", waves).with(
        "wave_speeds",
        json!({
            "pressure": speeds.pressure,
            "shear": speeds.transverse.map(|transverse| transverse.shear),
            "rayleigh": speeds.transverse.map(|transverse| transverse.rayleigh),
        }),
    ));
    lines
}

fn bond_based(material: &BondMaterial, constants: &BondConstants, facts: &Facts) -> Vec<Line> {
    vec![
        Line::new("Young's modulus", quantity(constants.young, "Pa")),
        Line::new(
            "bond constant c",
            format!(
                "{:.6e} (SI, of the force density c α {})",
                constants.micromodulus,
                match material.influence.acts_on {
                    ActsOn::Stretch => "s",
                    ActsOn::Displacement => "η",
                }
            ),
        ),
        Line::new(
            "stiffness error",
            stiffness_error(material, constants, facts.dimension),
        ),
    ]
}

/// Elastic constants, and the anisotropy of the grid's interior.
fn state_based(
    material: &StateBased,
    constants: &LinearSolidConstants,
    facts: &Facts,
) -> Vec<Line> {
    let mut lines = vec![elastic_constants(constants, facts)];
    if let (Some(axes), Some(diagonals)) = (facts.shear_error, facts.diagonal_shear_error) {
        /// Smaller errors get no advice.
        const NOTICED: f64 = 0.01;
        let mut text = format!(
            "shear along the axes {}, along the diagonals {}, bulk exact (interior of the grid)",
            deviation(axes),
            deviation(diagonals)
        );
        let isotropic = material.solid.influence == StateInfluence::Isotropic;
        if axes.abs() > NOTICED && !isotropic {
            text += "; eliminated by influence = { function = \"isotropic\" }";
        }
        lines.push(Line::new("stiffness error", text));
    }
    lines
}

fn elastic_constants(constants: &LinearSolidConstants, facts: &Facts) -> Line {
    let mut text = format!("E = {}", quantity(constants.elastic.young(), "Pa"));
    if let (Some(ratio), Some(bulk), Some(shear)) =
        (facts.poisson_ratio, facts.bulk_modulus, facts.shear_modulus)
    {
        text += &format!(
            ", ν = {}, K = {}, G = {}",
            significant(ratio, 4),
            quantity(bulk, "Pa"),
            quantity(shear, "Pa")
        );
    }
    Line::new("elastic constants", text)
}

/// Elastic constants, elastic law, zero-energy mode control and plastic constants.
fn correspondence(
    material: &Correspondence,
    constants: &CorrespondenceConstants,
    facts: &Facts,
) -> Vec<Line> {
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
    let mut lines = vec![
        elastic_constants(&constants.solid, facts),
        Line::new("elastic law", law),
        Line::new("stabilisation", control),
    ];
    if let Some(plasticity) = &material.plasticity {
        let yields = format!(
            "von Mises, yield stress {}, hardening modulus {}",
            quantity(plasticity.yield_stress, "Pa"),
            quantity(plasticity.hardening, "Pa")
        );
        lines.push(Line::new("plasticity", yields).with(
            "plasticity",
            json!({ "yield_stress": plasticity.yield_stress, "hardening": plasticity.hardening }),
        ));
    }
    lines
}

/// The line of a material of `[materials]`.
fn other_material(other: &NamedMaterial, own: &MaterialConstants) -> Line {
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
    Line::new("material", text).with_entry("materials", entry)
}

/// The line of an interface: how the bonds between two materials break.
pub(super) fn interface(interface: &MaterialInterface) -> Line {
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
    Line::new("interface", text).with_entry(
        "interfaces",
        json!({
            "between": interface.between,
            "critical_stretch": stretch,
            "fracture_energy": energy,
        }),
    )
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

/// Energies of cracks along lattice planes.
fn crack_planes(facts: &Facts) -> String {
    let planes: Vec<String> = facts
        .crack_planes
        .iter()
        .map(|plane| format!("{} {}", plane.plane, deviation(plane.deviation)))
        .collect();
    let calibration = match facts.fracture_calibration {
        Some(calibration) => format!(" (fracture_calibration = \"{calibration}\")"),
        None => String::new(),
    };
    format!(
        "energy per area relative to the fracture energy: {}{calibration}",
        planes.join(", ")
    )
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

pub(super) fn surface_material(surface: &SurfaceBody) -> Vec<Line> {
    let material = &surface.material;
    let law = match material.bond {
        SurfaceBond::Displacement => "κ |η|^(p−2) η / d^(2+αp)",
        SurfaceBond::Chord => "κ |ℓ−ℓ₀|^(p−2) (ℓ−ℓ₀) n / d^(2+αp), frame-indifferent",
    };
    let areas = match surface.areas {
        VertexAreas::Rule(AreaRule::Barycentric) => "one third of each adjacent triangle".into(),
        VertexAreas::Rule(AreaRule::MixedVoronoi) => "mixed Voronoi".into(),
        VertexAreas::Same(area) => format!("{area} m² per vertex, independent of the triangles"),
    };
    let same_area = match surface.areas {
        VertexAreas::Same(area) => Some(area),
        VertexAreas::Rule(_) => None,
    };
    let own_cell = if material.self_interaction {
        "included"
    } else if material.alpha >= 0.5 {
        "omitted: for α ≥ 1/2 results depend on the mesh"
    } else {
        "omitted"
    };
    let breaking = match material.critical_stretch {
        Some(stretch) => format!("at |η|/d = {}", significant(stretch, 4)),
        None => "never".into(),
    };
    let method = surface.geodesics.method;
    vec![
        Line::new(
            "force",
            format!(
                "{law}; p = {}, α = {}, κ = {}",
                material.p, material.alpha, material.kappa
            ),
        )
        .with(
            "surface_law",
            json!({ "p": material.p, "alpha": material.alpha, "kappa": material.kappa }),
        ),
        Line::new(
            "distances",
            match surface.geodesics.ball {
                Ball::Geodesic => method.to_string(),
                Ball::Euclid => format!("{method}, between vertices within a Euclidean ball"),
            },
        ),
        Line::new("areas", areas).with("vertex_area", same_area),
        Line::new("self-interaction", own_cell),
        Line::new("bond failure", breaking),
    ]
}
