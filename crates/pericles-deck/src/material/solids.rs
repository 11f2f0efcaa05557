//! Keys of state-based and correspondence materials.

use pericles::material::{
    BondFailure, Fracture, GivenConstants, LinearSolid, Strains, StretchDefinition,
    SurfaceCorrection,
};
use pericles_deck_derive::{DeckKeys, DeckTable};
use pericles_solids::correspondence::{ElasticLaw, Plasticity, Stabilisation};
use pericles_solids::inelastic::{Inelasticity, Yield};

use super::inelastic;
use super::scope::MaterialScope;
use crate::anisotropy::Anisotropy;
use crate::correspondence::Correspondence;
use crate::criterion::FailureCriterion;
use crate::declaration::DeckKeys;
use crate::expression::BondExpression;
use crate::fault::Fault;
use crate::property::{MaterialProperty, number_of};
use crate::reader::{Item, Table};
use crate::state_based::{StateBased, failure_of, read_yield};
use crate::vocabulary::MODULI;

/// Keys of state-based materials.
#[derive(DeckTable)]
#[deck(scope = MaterialScope<'s>)]
pub(super) struct StateKeys {
    /// state-based: bond extension. `finite`: e = |ξ + η| − |ξ|; `small`: e = ξ·η/|ξ|, linear in the displacement.
    #[deck(
        default,
        otherwise = "it requires model = \"state-based\"; correspondence materials always use finite strains"
    )]
    strains: Strains,
    /// Stiffening of bonds near free surfaces, where bonds are missing. `volume`: one factor per point from the missing volume
    /// within its horizon; `energy`: direction-dependent factors from the energy in uniaxial tension along three axes that
    /// follow the surface; `ghosts`: families completed by ghost points in the free cells of the lattice, whose displacements
    /// are extrapolated from those of the body, for bodies on a lattice whose bonds do not break. state-based: `none`,
    /// `energy`, which corrects the deviatoric stiffness, or `ghosts`; `volume` is rejected because the weighted volume already
    /// accounts for missing bonds.
    #[deck(
        flatten,
        key = "surface_correction",
        with = surface_correction,
        otherwise = "the shape tensor of a correspondence material already accounts for missing bonds near free surfaces"
    )]
    pub(super) surface_correction: SurfaceCorrection,
    #[deck(flatten, with = constants, keys("youngs_modulus", "bulk_modulus", "shear_modulus", "poisson_ratio"))]
    elastic: GivenConstants,
    #[deck(flatten, with = failure, keys("failure", "stretch_definition", "strength", "criterion"))]
    failure: Failure,
    /// state-based, not for bars: viscoelastic shear. Each table is one term of the relaxation function G(t)/G = 1 − Σ λ + Σ λ
    /// exp(−t/τ); the elastic constants are the instantaneous ones. At most eight terms with Σ λ < 1. Uses a neighbour list.
    #[deck(flatten, key = "viscosity", with = inelastic::read, keys("viscosity", "yield_stress", "hardening"))]
    inelastic: Inelasticity,
}

/// Keys of correspondence materials.
#[derive(DeckTable)]
#[deck(scope = MaterialScope<'s>)]
pub(super) struct CorrespondenceKeys {
    #[deck(scope = ())]
    anisotropy: Option<Anisotropy>,
    #[deck(
        flatten,
        with = other_constants,
        scope = (scope, anisotropy),
        keys("youngs_modulus", "bulk_modulus", "shear_modulus", "poisson_ratio")
    )]
    elastic: GivenConstants,
    #[deck(flatten, with = failure, keys("failure", "strength", "criterion"))]
    failure: Failure,
    #[deck(flatten, with = read_yield, keys("yield_stress", "hardening"))]
    plasticity: Option<Yield>,
    /// correspondence: hyperelastic law. `st-venant-kirchhoff`: S = λ tr(E) I + 2 G E with E = ½ (FᵀF − I), for small strains
    /// and any rotation; `neo-hooke`: ψ = ½ G (tr FᵀF − 3) − G ln J + ½ λ (ln J)²; `neo-hooke-split`: ψ = ½ G (J^(−2/3) tr FᵀF −
    /// 3) + (K/8) (J² + J⁻² − 2); `hencky`: linear in the logarithmic strain, required with `yield_stress`.
    #[deck(
        default = usual_law(plasticity),
        forbid_if(
            anisotropy.is_some_and(Option::is_some),
            "with `anisotropy` it is St Venant–Kirchhoff's law with the anisotropic stiffness"
        ),
        allow_if(
            law == Some(&ElasticLaw::Hencky) || usual_law(plasticity) != ElasticLaw::Hencky,
            "\"hencky\" with `yield_stress`, because plasticity uses logarithmic strains; remove `law`"
        )
    )]
    law: ElasticLaw,
    /// correspondence: control of zero-energy modes by the force state w Z z of the non-uniform deformation z = ξ + η − F ξ.
    /// `isotropic`: Z = tr(C : K⁻¹)/D; `wan`: tensor Z = C : K⁻¹ (Wan et al. 2019), not objective near free surfaces;
    /// `silling`: bond-based stiffness c/δ (Silling 2017); `none`: no control. With `yield_stress`, Z is multiplied by the ratio
    /// of the secant shear modulus to the elastic one.
    #[deck(default)]
    stabilisation: Stabilisation,
}

/// The others are those of state-based and correspondence materials; `stretch`: the stretch exceeds the critical stretch;
/// `bond-energy`: the bond is elongated and the work of its force along the bond exceeds the critical bond energy (Foster,
/// Silling and Chen 2011); `principal-stress`: the stress along the bond exceeds `strength`, so that cracks open normal to the
/// largest principal stress; `expression`: the failure index `criterion`, a function of stress and strain, exceeds 1.
#[derive(DeckKeys)]
#[deck(tag = "failure", what = "failure criterion", scope = MaterialScope<'s>)]
enum Failure {
    #[default]
    Stretch {
        /// state-based, failure = "stretch": deformation for which the critical stretch yields the fracture energy. `closing`:
        /// two rigid halves pulled apart; `bond`: the bond's own share of the energy; `iso`: isotropic expansion, then cut. All
        /// agree for ν = 1/4 (1/3 in plane stress).
        #[deck(
            default,
            forbid_if(
                scope.model == "correspondence",
                "it requires model = \"state-based\"; correspondence materials use the definition `closing`"
            ),
            otherwise = "it requires failure = \"stretch\"; the limit of other criteria does not depend on it"
        )]
        stretch_definition: StretchDefinition,
    },
    BondEnergy,
    PrincipalStress {
        /// failure = "principal-stress": tensile strength, a number or an expression of position. A bond breaks if the mean
        /// stress of its end points in the direction n of the deformed bond, n·σn, exceeds it. correspondence: Cauchy stress;
        /// state-based: stress of the force states, Σ t ⊗ y over the intact bonds of a point.
        #[deck(with = number_of(MaterialProperty::Strength), range = POSITIVE)]
        strength: f64,
    },
    Expression {
        /// failure = "expression": failure index, dimensionless; a bond breaks where it exceeds 1. Variables are means of both
        /// end points in Pa and without unit: stress_xx, stress_yy, stress_xy …, strain_xx …, principal values in descending
        /// order stress_1, stress_2, stress_3, strain_1 …, equivalent_stress (von Mises); and of the bond: normal_stress (n·σn),
        /// shear_stress, stretch; the position x, y, z (m) of the centre of the undeformed bond, the time t (s) and, with
        /// thermal expansion, `temperature` (K). Criteria of position, time or temperature use a neighbour list. In the plane
        /// the components within it. Example: "stress_1 / 30e6".
        #[deck(with = criterion)]
        criterion: BondExpression,
    },
}

impl Failure {
    /// Returns the failure of bonds of a strength, with the criterion of stress and strain if they break by them.
    fn of(self, strength: Fracture) -> (BondFailure, Option<FailureCriterion>) {
        let criterion = match self {
            Self::Stretch { stretch_definition } => {
                return (failure_of(strength, Some(stretch_definition)), None);
            }
            Self::BondEnergy => return (failure_of(strength, None), None),
            Self::PrincipalStress { strength } => FailureCriterion::PrincipalStress(strength),
            Self::Expression { criterion } => FailureCriterion::Expression(criterion),
        };
        (BondFailure::ByCriterion, Some(criterion))
    }
}

/// Reads `failure`, which bonds have that can break or whose rules other materials inherit.
fn failure(table: &Table<'_>, scope: MaterialScope<'_>) -> Option<Failure> {
    if scope.breaks || scope.is_shared || scope.limit().is_some() {
        return Failure::read_keys(table, scope);
    }
    table.know(&["failure"]);
    for key in ["failure", "stretch_definition"] {
        table.forbid(key, "bonds without `fracture_energy` never break");
    }
    for (key, word) in [
        ("strength", "principal-stress"),
        ("criterion", "expression"),
    ] {
        table.forbid(key, &format!("it requires failure = \"{word}\""));
    }
    Some(Failure::Stretch {
        stretch_definition: StretchDefinition::default(),
    })
}

/// Reads the surface correction of a state-based material.
fn surface_correction(table: &Table<'_>, _: MaterialScope<'_>) -> Option<SurfaceCorrection> {
    const KEY: &str = "surface_correction";
    let words = [
        ("none", SurfaceCorrection::None),
        ("energy", SurfaceCorrection::Energy),
        ("ghosts", SurfaceCorrection::Ghosts),
    ];
    if table.word_of(KEY) == Some("volume") {
        table.optional(KEY)?.out_of_range(
            "\"none\", \"energy\" or \"ghosts\"; the weighted volume of a state-based material already accounts for missing bonds, and the volume method makes bodies 6 to 15 % too stiff",
        );
        return None;
    }
    table.choice_or_first(KEY, "surface correction", &words)
}

fn criterion(item: &Item<'_>, scope: MaterialScope<'_>) -> Option<BondExpression> {
    let text = item.text()?;
    let parsed = BondExpression::parse(&text, scope.body.frame.dimension.unwrap_or(3));
    let parsed = parsed.map_err(|malformed| {
        item.report(Fault::bad_expression(text, malformed.reason));
    });
    parsed.ok()
}

/// Reads the elastic constants: two of four, or Young's modulus of a bar.
fn constants(table: &Table<'_>, scope: MaterialScope<'_>) -> Option<GivenConstants> {
    table.together(MODULI);
    let young = table.optional("youngs_modulus");
    if young.is_some_and(|item| item.is_table()) {
        for key in ["bulk_modulus", "shear_modulus"] {
            table.forbid(
                key,
                "with a function as `youngs_modulus`, Poisson's ratio is constant; use `poisson_ratio`",
            );
        }
    }
    GivenConstants::read_keys(table, scope.state())
}

/// Reads the elastic constants of a material, or Voigt's average of anisotropic ones.
fn other_constants(
    table: &Table<'_>,
    (scope, anisotropy): (MaterialScope<'_>, Option<&Option<Anisotropy>>),
) -> Option<GivenConstants> {
    if !table.has("anisotropy") {
        return constants(table, scope);
    }
    for &key in MODULI.iter().chain(&["poisson_ratio"]) {
        table.forbid(key, "`anisotropy` contains all elastic constants");
    }
    table.forbid("yield_stress", "materials with `anisotropy` are elastic");
    table.accept(anisotropy?.as_ref()?.average())
}

/// Plastic materials have the logarithmic law.
fn usual_law(plasticity: Option<&Option<Yield>>) -> ElasticLaw {
    match plasticity {
        Some(Some(_)) => ElasticLaw::Hencky,
        _ => ElasticLaw::StVenantKirchhoff,
    }
}

impl StateKeys {
    /// Returns the material with these keys; `solid` has the other ones.
    pub(super) fn made(self, solid: LinearSolid, strength: Fracture) -> StateBased {
        let (failure, criterion) = self.failure.of(strength);
        StateBased {
            solid: LinearSolid {
                elastic: self.elastic,
                failure,
                ..solid
            },
            strains: self.strains,
            inelastic: self.inelastic,
            criterion,
        }
    }
}

impl CorrespondenceKeys {
    /// Returns the material with these keys; `solid` has the other ones.
    pub(super) fn made(self, solid: LinearSolid, strength: Fracture) -> Correspondence {
        let (failure, criterion) = self.failure.of(strength);
        let plasticity = self.plasticity;
        Correspondence {
            solid: LinearSolid {
                elastic: self.elastic,
                failure,
                ..solid
            },
            law: self.law,
            stabilisation: self.stabilisation,
            plasticity: plasticity.map(|Yield { stress, hardening }| Plasticity {
                yield_stress: stress,
                hardening,
            }),
            anisotropy: self.anisotropy.map(Box::new),
            criterion,
        }
    }
}
