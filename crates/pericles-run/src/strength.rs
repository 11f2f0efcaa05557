//! Softening and strength of the materials of a run, for reports, `check` and `run.json`.

use std::collections::BTreeMap;

use pericles::material::{BondConstants, BondMaterial, HomogeneousBonds, TensileStrength};
use pericles_deck::{MaterialModel, Model, Solid};
use serde::Serialize;

use crate::build::{Assembly, MaterialConstants, MaterialSoftening};
use crate::units::{quantity, significant};

/// Softening and strength of a material; SI units.
///
/// Strengths are the largest stresses of a homogeneous body without free surfaces.
#[derive(Debug, Clone, Serialize)]
pub struct SofteningFacts {
    /// Name of the material.
    pub name: String,
    /// Softening law.
    pub law: &'static str,
    /// Stretch s_e at which softening starts.
    pub onset_stretch: f64,
    /// Critical stretch s₀ of the bonds without softening.
    pub critical_stretch: f64,
    /// Stretch at which bonds break.
    pub end_stretch: f64,
    /// A = (s₀/s_e)².
    pub ratio: f64,
    /// Tensile strength, the given one or that which follows from the onset: the mean over tension normal to planes of the
    /// lattice, or by integrals, as `fracture_calibration`.
    pub tensile_strength: f64,
    /// Strength in uniaxial tension by direction: degrees from the x-axis in one and two dimensions, the lattice direction
    /// in three.
    pub strength: BTreeMap<&'static str, f64>,
    /// Strength under equal tensions along two axes; `None` for a bar.
    pub equibiaxial_strength: Option<f64>,
    /// Strength in pure shear along two axes; `None` for a bar.
    pub shear_strength: Option<f64>,
    /// Strength under equal tensions along three axes; `None` in one and two dimensions.
    pub hydrostatic_strength: Option<f64>,
    /// Stress at which the stress–strain curve departs from the straight line.
    pub linear_limit: f64,
    /// Irwin length E G/f_t², m.
    pub irwin_length: f64,
    /// Horizon over the Irwin length.
    pub horizon_over_irwin_length: f64,
    /// Largest horizon at which softening gives this strength with this modulus and fracture energy, m.
    pub largest_horizon: f64,
    /// Largest horizon over the Irwin length.
    pub largest_horizon_over_irwin_length: f64,
}

/// A material whose bonds soften.
struct Softened<'a> {
    name: &'a str,
    material: &'a BondMaterial,
    constants: &'a BondConstants,
    softening: &'a MaterialSoftening,
    /// Its tensile strength, if it is given.
    given: Option<TensileStrength>,
    solid: &'a Solid,
}

/// Returns the materials that soften, the body's material first.
fn materials<'a>(model: &'a Model, assembly: &'a Assembly) -> impl Iterator<Item = Softened<'a>> {
    let solid = model.body.solid();
    let found = solid.into_iter().flat_map(move |solid| {
        let own = &solid.material;
        let own = (own.name(), &own.model, own.tensile_strength);
        let others = model.materials.iter();
        let others = others.map(|other| (&*other.name, &other.model, other.tensile_strength));
        let constants = assembly.constants.iter().chain(&assembly.other_materials);
        let materials = std::iter::once(own).chain(others).zip(constants);
        let all = materials.zip(&assembly.softening);
        all.map(move |(pair, softening)| (solid, pair, softening))
    });
    found.filter_map(|(solid, ((name, model, given), constants), softening)| {
        let MaterialModel::Bonds(material) = model else {
            return None;
        };
        Some(Softened {
            name,
            material,
            constants: MaterialConstants::bonds(constants)?,
            softening: softening.as_ref()?,
            given,
            solid,
        })
    })
}

/// Strength and fracture energy of a material whose bonds are elastic until the stress reaches the strength; SI units.
#[derive(Debug, Clone, Serialize)]
pub struct StrengthFacts {
    /// Name of the material.
    pub name: String,
    /// Where bonds begin to soften or break, in words.
    pub surface: String,
    /// Tensile strength.
    pub tensile_strength: f64,
    /// Softening law of bonds that open below their critical stretch.
    pub law: &'static str,
    /// Critical stretch s₀, beyond which bonds break as soon as they open.
    pub critical_stretch: f64,
    /// Strength in uniaxial tension of a material whose bonds break at s₀ alone, E s₀.
    pub brittle_strength: f64,
    /// Irwin length E G/f_t², m.
    pub irwin_length: f64,
    /// Horizon over the Irwin length.
    pub horizon_over_irwin_length: f64,
}

impl StrengthFacts {
    /// Returns the facts of all materials that fail by strength, the body's material first.
    pub(crate) fn of(model: &Model, assembly: &Assembly) -> Vec<Self> {
        let facts = materials(model, assembly).filter_map(|own| {
            let strength = own.softening.strength.as_ref()?;
            let (tensile, constants) = (own.given?.strength, own.constants);
            let irwin = constants.young * constants.fracture_energy / (tensile * tensile);
            Some(Self {
                name: own.name.to_owned(),
                surface: strength.surface.words(),
                tensile_strength: tensile,
                law: own.softening.softening.law.name(),
                critical_stretch: constants.critical_stretch,
                brittle_strength: constants.young * constants.critical_stretch,
                irwin_length: irwin,
                horizon_over_irwin_length: own.material.horizon / irwin,
            })
        });
        facts.collect()
    }

    /// Returns lines with their labels: strength, lengths.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let strength = format!(
            "{}: bonds open {}; they then soften ({}), or break if their stretch is beyond {}, which alone would give {}",
            self.name,
            self.surface,
            self.law,
            significant(self.critical_stretch, 4),
            quantity(self.brittle_strength, "Pa")
        );
        let lengths = format!(
            "{}; the horizon is {} of it",
            quantity(self.irwin_length, "m"),
            significant(self.horizon_over_irwin_length, 4)
        );
        vec![("strength", strength), ("Irwin length", lengths)]
    }
}

impl SofteningFacts {
    /// Returns the facts of all materials that soften beyond a stretch, the body's material first.
    pub fn of(model: &Model, assembly: &Assembly) -> Vec<Self> {
        let facts = materials(model, assembly).filter_map(|own| match own.softening.strength {
            None => Self::of_material(&own, assembly),
            Some(_) => None,
        });
        facts.collect()
    }

    fn of_material(
        Softened {
            name,
            material,
            constants,
            softening: given,
            solid,
            ..
        }: &Softened<'_>,
        assembly: &Assembly,
    ) -> Option<Self> {
        let bonds = HomogeneousBonds::new(material, constants, &assembly.cloud, solid.state);
        // The assembly has rejected softening without a curve.
        let curve = given.softening.curve(constants.critical_stretch).ok()?;
        let strengths = bonds.strengths(&given.softening, given.calibration).ok()?;
        Some(Self {
            name: (*name).to_owned(),
            law: given.softening.law.name(),
            onset_stretch: given.softening.onset,
            critical_stretch: constants.critical_stretch,
            end_stretch: curve.end(),
            ratio: strengths.ratio,
            tensile_strength: strengths.tensile,
            strength: strengths.by_direction.into_iter().collect(),
            equibiaxial_strength: strengths.equibiaxial,
            shear_strength: strengths.shear,
            hydrostatic_strength: strengths.hydrostatic,
            linear_limit: strengths.linear_limit,
            irwin_length: strengths.irwin_length,
            horizon_over_irwin_length: material.horizon / strengths.irwin_length,
            largest_horizon: strengths.largest_horizon,
            largest_horizon_over_irwin_length: strengths.largest_horizon / strengths.irwin_length,
        })
    }

    /// Returns lines with their labels: the curve, strengths by direction, multiaxial strengths, lengths.
    pub fn lines(&self, dimension: usize) -> Vec<(&'static str, String)> {
        let curve = format!(
            "{}: {}, from stretch {} to {}, critical stretch {}, A = {}",
            self.name,
            self.law,
            significant(self.onset_stretch, 4),
            significant(self.end_stretch, 4),
            significant(self.critical_stretch, 4),
            significant(self.ratio, 4)
        );
        let directions = self.strength.iter().map(|(direction, strength)| {
            let direction = match dimension {
                3 => format!("({direction})"),
                _ => format!("{direction}°"),
            };
            format!("{} along {direction}", quantity(*strength, "Pa"))
        });
        let directions: Vec<String> = directions.collect();
        let tensile = format!(
            "{} in tension ({}); linear up to {}",
            quantity(self.tensile_strength, "Pa"),
            directions.join(", "),
            quantity(self.linear_limit, "Pa")
        );
        let several = [
            ("equibiaxial", self.equibiaxial_strength),
            ("shear", self.shear_strength),
            ("hydrostatic", self.hydrostatic_strength),
        ];
        let several = several
            .into_iter()
            .filter_map(|(name, strength)| Some(format!("{name} {}", quantity(strength?, "Pa"))));
        let several: Vec<String> = several.collect();
        let lengths = format!(
            "{}; the horizon is {} of it, and at most {} with this strength",
            quantity(self.irwin_length, "m"),
            significant(self.horizon_over_irwin_length, 4),
            significant(self.largest_horizon_over_irwin_length, 4)
        );
        let lengths = format!("{lengths} ({})", quantity(self.largest_horizon, "m"));
        let mut lines = vec![("softening", curve), ("strength", tensile)];
        if !several.is_empty() {
            lines.push(("multiaxial", several.join(", ")));
        }
        lines.push(("Irwin length", lengths));
        lines
    }
}
