//! Fields that a snapshot offers: one table with name, unit, kind, condition and values of each field.
//!
//! Words of decks, arrays of files, columns and names in Python follow from the table.

use std::borrow::Cow;
use std::cell::OnceCell;

use super::fragments::Fragments;
use super::tensors::{
    components, equivalent_stress, fitted_strain, places, principal_stresses, virial_stress,
};
use crate::operator::BondView;
use crate::secondary::SecondaryField;
use crate::space::PointCloud;
use crate::system::System;
use crate::time::State;

/// How the values of a point belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldKind {
    /// One number.
    Scalar,
    /// A whole number from 0 to 2³¹ − 1.
    Integer,
    /// One component per axis of the body.
    Vector,
    /// As many numbers as the body has dimensions, which do not belong to axes.
    List,
    /// A symmetric tensor, in the order of [`Field::components`].
    Tensor,
}

/// A property of the body that a field needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldNeed {
    /// Forces that list their bonds.
    Bonds,
    /// A state-based material.
    Dilatation,
    /// A material that yields.
    Plasticity,
    /// Thermal expansion or heat conduction.
    Temperature,
    /// Heat conduction.
    Conduction,
}

impl FieldNeed {
    /// All properties.
    pub const ALL: [Self; 5] = [
        Self::Bonds,
        Self::Dilatation,
        Self::Plasticity,
        Self::Conduction,
        Self::Temperature,
    ];

    /// Returns whether a body has the property.
    pub fn is_met(self, system: &System) -> bool {
        let capabilities = system.operator().capabilities();
        let conducts = secondary(system, "temperature").is_some();
        match self {
            Self::Bonds => capabilities.bonds.is_some(),
            Self::Dilatation => capabilities.dilatation.is_some(),
            Self::Plasticity => capabilities.plastic.is_some(),
            Self::Temperature => conducts || capabilities.thermal.is_some(),
            Self::Conduction => conducts,
        }
    }
}

/// Values of a field at one time, vectors and tensors component-major.
type Values = for<'s, 'a> fn(&'s FieldValues<'a>) -> Cow<'s, [f64]>;

struct Row {
    name: &'static str,
    unit: &'static str,
    kind: FieldKind,
    need: Option<FieldNeed>,
    values: Values,
}

/// Declares the fields from rows of name, unit, kind, condition and values.
macro_rules! fields {
    ($($(#[$doc:meta])* $field:ident: $name:literal, $unit:literal, $kind:ident, $need:expr, $values:expr;)*) => {
        /// A field on the points.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Field {
            $($(#[$doc])* $field,)*
        }

        const COUNT: usize = [$(Field::$field),*].len();

        const ROWS: [Row; COUNT] = [$(Row {
            name: $name,
            unit: $unit,
            kind: FieldKind::$kind,
            need: $need,
            values: $values,
        }),*];

        impl Field {
            /// All fields.
            pub const ALL: [Self; COUNT] = [$(Self::$field),*];
        }
    };
}

fields! {
    /// u, m.
    Displacement: "Displacement", "m", Vector, None, |now| now.state.u.as_slice().into();
    /// v, m/s.
    Velocity: "Velocity", "m/s", Vector, None, |now| now.state.v.as_slice().into();
    /// Internal and external force density, N/m³.
    ForceDensity: "Force_Density", "N/m³", Vector, None, force_density;
    /// Damage: 1 − unbroken bonds / initial bonds.
    Damage: "Damage", "", Scalar, None, damage;
    /// Elastic energy density, J/m³.
    StrainEnergyDensity: "Strain_Energy_Density", "J/m³", Scalar, None, energy_density;
    /// Force density of loads, N/m³.
    ExternalForce: "External_Force_Density", "N/m³", Vector, None, external_force;
    /// Reaction force density of constraints, N/m³.
    Reaction: "Reaction_Density", "N/m³", Vector, None, reaction;
    /// Force density of contact, with dampers and friction, N/m³.
    ContactForce: "Contact_Force_Density", "N/m³", Vector, None, contact_force;
    /// Cauchy stress, Pa. Correspondence materials: that of the deformation gradient. Other materials: virial stress of
    /// the bonds of a point, ½ Σ f ⊗ (ξ + η)/J, or ½ Σ f ⊗ ξ for laws of small strains; NaN if the force does not list its
    /// bonds.
    Stress: "Stress", "Pa", Tensor, Some(FieldNeed::Bonds), stress;
    /// Strain of the displacement gradient fitted to the bonds of a point by least squares. NaN if the force does
    /// not list its bonds.
    Strain: "Strain", "", Tensor, Some(FieldNeed::Bonds), |now| now.tensor(fitted_strain).into();
    /// Volume of the point, m³, or its area on a surface, m²; constant in time.
    Volume: "Volume", "m³", Scalar, None, |now| now.system.cloud().volumes().into();
    /// Kinetic energy density ½ ρ v², J/m³.
    KineticEnergyDensity: "Kinetic_Energy_Density", "J/m³", Scalar, None, |now| now.kinetic_energy_density().into();
    /// Dilatation of a state-based material: the relative change of volume, or of area in two dimensions. NaN for
    /// other materials.
    Dilatation: "Dilatation", "", Scalar, Some(FieldNeed::Dilatation), dilatation;
    /// Equivalent stress, Pa: von Mises stress of [`Field::Stress`]; in two dimensions of the in-plane components,
    /// in a bar the absolute value. NaN if the force does not list its bonds.
    EquivalentStress: "Equivalent_Stress", "Pa", Scalar, Some(FieldNeed::Bonds), |now| equivalent_stress(now.dimension(), now.get(Field::Stress)).into();
    /// Equivalent plastic strain; NaN for materials that do not yield.
    PlasticStrain: "Plastic_Strain", "", Scalar, Some(FieldNeed::Plasticity), plastic_strain;
    /// 1 where a point has yielded, else 0; NaN for materials that do not yield.
    YieldFlag: "Yield_Flag", "", Scalar, Some(FieldNeed::Plasticity), yield_flag;
    /// Temperature, K; NaN for bodies without thermal expansion and heat conduction.
    Temperature: "Temperature", "K", Scalar, Some(FieldNeed::Temperature), temperature;
    /// Heat flux, W/m²; NaN for bodies without heat conduction.
    HeatFlux: "Heat_Flux", "W/m²", Vector, Some(FieldNeed::Conduction), heat_flux;
    /// Von Mises stress, Pa: the same numbers as [`Field::EquivalentStress`].
    VonMisesStress: "Von_Mises_Stress", "Pa", Scalar, Some(FieldNeed::Bonds), |now| now.get(Field::EquivalentStress).into();
    /// Principal stresses, Pa: eigenvalues of [`Field::Stress`] in descending order, as many as the body has dimensions. As stress.
    PrincipalStress: "Principal_Stress", "Pa", List, Some(FieldNeed::Bonds), |now| principal_stresses(now.dimension(), now.get(Field::Stress)).into();
    /// Half the size of a point's cell, m: ½ (V / section)^(1/dimension). The same at all times.
    Radius: "Radius", "m", Scalar, None, radius;
    /// Number of the point in the user's numbering, from 0. The same at all times.
    PointId: "Point_Id", "", Integer, None, point_id;
    /// Number of the fragment that the point belongs to, from 0 in the order of the first points. 0 for bodies whose bonds do not break.
    FragmentId: "Fragment_Id", "", Integer, None, |now| Fragments::numbers(now.system).into();
    /// 1 for points that belong to the body, 0 for those that become active later. 1 for bodies whose points are all active.
    Active: "Active", "", Integer, None, |now| now.system.active_marks().into();
}

impl Field {
    /// Fields written by default.
    pub const USUAL: [Self; 5] = [
        Self::Displacement,
        Self::Velocity,
        Self::ForceDensity,
        Self::Damage,
        Self::StrainEnergyDensity,
    ];

    const fn row(self) -> &'static Row {
        const TABLE: &[Row; COUNT] = &ROWS;
        &TABLE[self as usize]
    }

    /// Returns the field with a name in files; capitals do not matter.
    pub fn named(name: &str) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|field| field.name().eq_ignore_ascii_case(name))
    }

    /// Name in files.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// SI unit of the field.
    pub fn unit(self) -> &'static str {
        self.row().unit
    }

    /// Returns how the values of a point belong together.
    pub fn kind(self) -> FieldKind {
        self.row().kind
    }

    /// Returns the property of the body that the field needs; `None` for fields of all bodies.
    pub fn need(self) -> Option<FieldNeed> {
        self.row().need
    }

    /// Names of the components for a body of a dimension; empty for scalars.
    pub fn components(self, dimension: usize) -> &'static [&'static str] {
        match self.kind() {
            FieldKind::Scalar | FieldKind::Integer => &[],
            FieldKind::List => &["1", "2", "3"][..dimension],
            FieldKind::Vector => &["x", "y", "z"][..dimension],
            FieldKind::Tensor => match dimension {
                1 => &["xx"],
                2 => &["xx", "yy", "xy"],
                _ => &["xx", "yy", "zz", "xy", "yz", "xz"],
            },
        }
    }
}

/// Returns the secondary field of a body with a name.
fn secondary<'a>(system: &'a System, name: &str) -> Option<&'a dyn SecondaryField> {
    system.fields().find(|field| field.name() == name)
}

/// The fields of a body at one time, each computed once.
pub(super) struct FieldValues<'a> {
    system: &'a System,
    state: &'a State,
    found: [OnceCell<Vec<f64>>; COUNT],
}

impl<'a> FieldValues<'a> {
    pub(super) fn new(system: &'a System, state: &'a State) -> Self {
        Self {
            system,
            state,
            found: [const { OnceCell::new() }; COUNT],
        }
    }

    /// Returns a field; NaN if the body does not have it.
    pub(super) fn get(&self, field: Field) -> &[f64] {
        let found = &self.found[field as usize];
        if let Some(values) = found.get() {
            return values;
        }
        match (field.row().values)(self) {
            Cow::Borrowed(values) => values,
            Cow::Owned(values) => found.get_or_init(|| values),
        }
    }

    fn dimension(&self) -> usize {
        self.system.cloud().dimension()
    }

    /// Returns the values that `add` writes to numbers per point, each of which is `initial` before.
    fn filled(
        &self,
        per_point: usize,
        initial: f64,
        add: impl FnOnce(&mut [f64]),
    ) -> Cow<'_, [f64]> {
        let mut values = vec![initial; per_point * self.system.points()];
        add(&mut values);
        values.into()
    }

    fn tensor(
        &self,
        of_bonds: impl Fn(&PointCloud, &dyn BondView, &[f64]) -> Vec<f64>,
    ) -> Vec<f64> {
        let cloud = self.system.cloud();
        match self.system.operator().as_bonds() {
            Some(bonds) => of_bonds(cloud, bonds, &self.state.u),
            None => vec![f64::NAN; places(cloud.dimension()).len() * cloud.len()],
        }
    }

    fn kinetic_energy_density(&self) -> Vec<f64> {
        let n = self.system.points();
        let square = |i: usize| -> f64 {
            let components = self.state.v.chunks(n.max(1));
            components.map(|component| component[i].powi(2)).sum()
        };
        let density = self.system.density();
        (0..n).map(|i| 0.5 * density.at(i) * square(i)).collect()
    }
}

fn force_density<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    let (t, u) = (now.state.t, &now.state.u);
    now.filled(now.dimension(), 0.0, |out| {
        now.system.force_density_into(t, u, out)
    })
}

fn damage<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    now.filled(1, 0.0, |out| now.system.operator().damage_into(out))
}

fn energy_density<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    let (t, u) = (now.state.t, &now.state.u);
    now.filled(1, 0.0, |out| {
        now.system.operator().add_energy_density(t, u, out)
    })
}

fn external_force<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    now.filled(now.dimension(), 0.0, |out| {
        now.system.load_density_into(now.state.t, out)
    })
}

fn reaction<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    now.filled(now.dimension(), 0.0, |out| {
        for motion in now.system.motions() {
            motion.add_reaction(now.system.points(), out);
        }
    })
}

fn contact_force<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    let (t, u) = (now.state.t, &now.state.u);
    now.filled(now.dimension(), 0.0, |out| {
        now.system.add_contact_force(t, u, out)
    })
}

/// The stress of the material, or the stress of the forces of bonds.
fn stress<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    let values = match now.system.operator().capabilities().stress {
        Some(view) => components(now.system.cloud(), &view.stresses(&now.state.u)),
        None => now.tensor(virial_stress),
    };
    values.into()
}

fn dilatation<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    let (t, u) = (now.state.t, &now.state.u);
    now.filled(1, f64::NAN, |out| {
        if let Some(view) = now.system.operator().capabilities().dilatation {
            view.dilatation_into(t, u, out);
        }
    })
}

fn plastic_strain<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    now.filled(1, f64::NAN, |out| {
        if let Some(view) = now.system.operator().capabilities().plastic {
            view.plastic_strain_into(out);
        }
    })
}

fn yield_flag<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    let flag = |strain: &f64| match strain.is_nan() {
        true => f64::NAN,
        false => f64::from(*strain > 0.0),
    };
    now.get(Field::PlasticStrain).iter().map(flag).collect()
}

fn temperature<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    let t = now.state.t;
    now.filled(1, f64::NAN, |out| {
        if let Some(field) = secondary(now.system, "temperature") {
            field.values_into(t, out);
        } else if let Some(thermal) = now.system.operator().capabilities().thermal {
            thermal.temperatures_into(t, out);
        }
    })
}

fn heat_flux<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    now.filled(now.dimension(), f64::NAN, |out| {
        if let Some(field) = secondary(now.system, "temperature") {
            field.flux_into(now.state.t, out);
        }
    })
}

fn radius<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    let cloud = now.system.cloud();
    (0..cloud.len()).map(|i| 0.5 * cloud.cell_size(i)).collect()
}

fn point_id<'s>(now: &'s FieldValues<'_>) -> Cow<'s, [f64]> {
    let cloud = now.system.cloud();
    (0..cloud.len())
        .map(|i| cloud.user_number(i) as f64)
        .collect()
}
