//! Fields that a snapshot offers.

/// A field on the points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    /// u, m.
    Displacement,
    /// v, m/s.
    Velocity,
    /// Internal and external force density, N/m³.
    ForceDensity,
    /// Damage: 1 − unbroken bonds / initial bonds.
    Damage,
    /// Elastic energy density, J/m³.
    StrainEnergyDensity,
    /// Force density of loads, N/m³.
    ExternalForce,
    /// Reaction force density of constraints, N/m³.
    Reaction,
    /// Force density of contact, with dampers and friction, N/m³.
    ContactForce,
    /// Cauchy stress, Pa. Correspondence materials: that of the deformation gradient. Other materials: virial stress of
    /// the bonds of a point, ½ Σ f ⊗ (ξ + η)/J, or ½ Σ f ⊗ ξ for laws of small strains; NaN if the force does not list its
    /// bonds.
    Stress,
    /// Strain of the displacement gradient fitted to the bonds of a point by least squares. NaN if the force does
    /// not list its bonds.
    Strain,
    /// Volume of the point, m³, or its area on a surface, m²; constant in time.
    Volume,
    /// Kinetic energy density ½ ρ v², J/m³.
    KineticEnergyDensity,
    /// Dilatation of a state-based material: the relative change of volume, or of area in two dimensions. NaN for
    /// other materials.
    Dilatation,
    /// Equivalent stress, Pa: von Mises stress of [`Field::Stress`]; in two dimensions of the in-plane components,
    /// in a bar the absolute value. NaN if the force does not list its bonds.
    EquivalentStress,
    /// Equivalent plastic strain; NaN for materials that do not yield.
    PlasticStrain,
    /// 1 where a point has yielded, else 0; NaN for materials that do not yield.
    YieldFlag,
    /// Temperature, K; NaN for bodies without thermal expansion and heat conduction.
    Temperature,
    /// Heat flux, W/m²; NaN for bodies without heat conduction.
    HeatFlux,
    /// Von Mises stress, Pa: the same numbers as [`Field::EquivalentStress`].
    VonMisesStress,
    /// Principal stresses, Pa: eigenvalues of [`Field::Stress`] in descending order, as many as the body has dimensions. As stress.
    PrincipalStress,
    /// Half the size of a point's cell, m: ½ (V / section)^(1/dimension). The same at all times.
    Radius,
    /// Number of the point in the user's numbering, from 0. The same at all times.
    PointId,
    /// Number of the fragment that the point belongs to, from 0 in the order of the first points. 0 for bodies whose bonds do not break.
    FragmentId,
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

    /// All fields.
    pub const ALL: [Self; 23] = [
        Self::Displacement,
        Self::Velocity,
        Self::ForceDensity,
        Self::Damage,
        Self::StrainEnergyDensity,
        Self::ExternalForce,
        Self::Reaction,
        Self::ContactForce,
        Self::Stress,
        Self::Strain,
        Self::Volume,
        Self::KineticEnergyDensity,
        Self::Dilatation,
        Self::EquivalentStress,
        Self::PlasticStrain,
        Self::YieldFlag,
        Self::Temperature,
        Self::HeatFlux,
        Self::VonMisesStress,
        Self::PrincipalStress,
        Self::Radius,
        Self::PointId,
        Self::FragmentId,
    ];

    /// Name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Displacement => "Displacement",
            Self::Velocity => "Velocity",
            Self::ForceDensity => "Force_Density",
            Self::Damage => "Damage",
            Self::StrainEnergyDensity => "Strain_Energy_Density",
            Self::ExternalForce => "External_Force_Density",
            Self::Reaction => "Reaction_Density",
            Self::ContactForce => "Contact_Force_Density",
            Self::Stress => "Stress",
            Self::Strain => "Strain",
            Self::Volume => "Volume",
            Self::KineticEnergyDensity => "Kinetic_Energy_Density",
            Self::Dilatation => "Dilatation",
            Self::EquivalentStress => "Equivalent_Stress",
            Self::PlasticStrain => "Plastic_Strain",
            Self::YieldFlag => "Yield_Flag",
            Self::Temperature => "Temperature",
            Self::HeatFlux => "Heat_Flux",
            Self::VonMisesStress => "Von_Mises_Stress",
            Self::PrincipalStress => "Principal_Stress",
            Self::Radius => "Radius",
            Self::PointId => "Point_Id",
            Self::FragmentId => "Fragment_Id",
        }
    }

    /// SI unit of the field.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Displacement | Self::Radius => "m",
            Self::Velocity => "m/s",
            Self::ForceDensity | Self::ExternalForce | Self::Reaction | Self::ContactForce => {
                "N/m³"
            }
            Self::Stress
            | Self::EquivalentStress
            | Self::VonMisesStress
            | Self::PrincipalStress => "Pa",
            Self::Damage
            | Self::Strain
            | Self::Dilatation
            | Self::PlasticStrain
            | Self::YieldFlag
            | Self::PointId
            | Self::FragmentId => "",
            Self::StrainEnergyDensity | Self::KineticEnergyDensity => "J/m³",
            Self::Volume => "m³",
            Self::Temperature => "K",
            Self::HeatFlux => "W/m²",
        }
    }

    /// Returns whether the field has one component per dimension of the body, stored component-major.
    pub fn is_vector(self) -> bool {
        matches!(
            self,
            Self::Displacement
                | Self::Velocity
                | Self::ForceDensity
                | Self::ExternalForce
                | Self::Reaction
                | Self::ContactForce
                | Self::HeatFlux
                | Self::PrincipalStress
        )
    }

    /// Returns whether the values are whole numbers from 0 to 2³¹ − 1.
    pub fn is_integer(self) -> bool {
        matches!(self, Self::PointId | Self::FragmentId)
    }

    /// Returns whether the field is a symmetric tensor, stored component-major in the order of
    /// [`Field::components`].
    pub fn is_tensor(self) -> bool {
        matches!(self, Self::Stress | Self::Strain)
    }

    /// Returns whether the field is computed from single bonds.
    pub fn is_of_bonds(self) -> bool {
        let of_stress = [
            Self::EquivalentStress,
            Self::VonMisesStress,
            Self::PrincipalStress,
        ];
        self.is_tensor() || of_stress.contains(&self)
    }

    /// Names of the components for a body of a dimension; empty for scalars.
    pub fn components(self, dimension: usize) -> &'static [&'static str] {
        if self == Self::PrincipalStress {
            &["1", "2", "3"][..dimension]
        } else if self.is_vector() {
            &["x", "y", "z"][..dimension]
        } else if self.is_tensor() {
            match dimension {
                1 => &["xx"],
                2 => &["xx", "yy", "xy"],
                _ => &["xx", "yy", "zz", "xy", "yz", "xz"],
            }
        } else {
            &[]
        }
    }
}
