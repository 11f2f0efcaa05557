//! Materials and geodesic distances of 2-manifolds.

use pericles_deck_derive::{DeckTable, DeckWords};
use pericles_manifold::geodesic::{Ball, GeodesicMethod};
use pericles_manifold::{PowerMaterial, SurfaceBond};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::body::{SurfaceShape, VertexAreas};
use crate::declaration::{Check, DeckValue, Fallback};
use crate::form::Described;
use crate::key_path::KeyPath;
use crate::reader::{Item, Table};
use crate::set::SetNames;

/// A 2-manifold with its material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfaceBody {
    /// The surface.
    pub shape: SurfaceShape,
    /// The areas of its vertices.
    pub areas: VertexAreas,
    /// Its material.
    pub material: SurfaceMaterial,
    /// Distances along the surface.
    #[serde(default)]
    pub geodesics: Geodesics,
}

impl SurfaceBody {
    /// Checks the areas of the vertices and the material.
    pub(crate) fn check(&self, check: &mut Check) {
        if let VertexAreas::Same(area) = self.areas {
            check.positive("body.areas".into(), area);
        }
        let sets = SetNames::any();
        let scope = SurfaceScope {
            spacing: None,
            sets: &sets,
        };
        self.material.check("material".into(), scope, check);
    }
}

/// 2-manifolds: distances along the surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(default)]
pub struct Geodesics {
    /// Algorithm for geodesic distances: `exact`, `edge` (paths along edges), `edge-diagonals`, or `steiner(1)` to
    /// `steiner(32)` (paths over that many extra points per edge).
    #[serde(default, with = "crate::form")]
    #[deck(default)]
    pub method: GeodesicMethod,
    /// Which points are bonded. `geodesic`: those within the horizon along the surface; `euclid`: those within the horizon
    /// on the straight line. Force laws use geodesic distances in both cases.
    #[serde(default, with = "crate::form")]
    #[deck(default)]
    pub ball: Ball,
}

/// 2-manifolds have one material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = SurfaceScope<'s>)]
pub struct SurfaceMaterial {
    /// `power`, the law of 2-manifolds: κ |η|^(p−2) η / d^(2+αp) with the distance d along the surface.
    #[serde(default)]
    #[deck(default)]
    pub model: SurfaceModel,
    /// 2-manifolds: not used.
    #[serde(default)]
    pub name: Option<String>,
    /// 2-manifolds: mass per area.
    ///
    /// In kg/m².
    #[deck(quantity = SurfaceDensity, range = POSITIVE)]
    pub density: f64,
    /// 2-manifolds: factor κ of the force law, in SI units, which depend on p and α.
    #[deck(range = POSITIVE, default = 1.0)]
    pub kappa: f64,
    /// 2-manifolds: exponent α of the force law.
    #[deck(range = between(0.0, 1.0))]
    pub alpha: f64,
    /// 2-manifolds: exponent p of the force law.
    #[deck(range = at_least(2.0).described("a number of at least 2"))]
    pub p: f64,
    /// 2-manifolds: measured along the surface.
    ///
    /// In m.
    #[deck(
        quantity = Length,
        range = POSITIVE.described(LENGTHS),
        allow_if(is_above(scope, horizon), LENGTHS)
    )]
    pub horizon: f64,
    /// 2-manifolds: part of the relative displacement η that enters the force law. `displacement`: all of η; `chord`: the
    /// change of the chord length, invariant under rigid motions.
    #[serde(default, with = "crate::form")]
    #[deck(default)]
    pub bond: SurfaceBond,
    /// 2-manifolds, p = 2 with bond = "displacement": adds the integral over the point's own area, without which results
    /// depend on the mesh. Default: true for alpha ≥ 0.5.
    #[deck(
        default = supports(p, bond) && alpha.is_some_and(|alpha| *alpha >= 0.5),
        allow_if(
            self_interaction == Some(&false) || supports(p, bond),
            "false, or true with p = 2 and bond = \"displacement\""
        )
    )]
    pub self_interaction: bool,
    /// 2-manifolds: bonds break when |η|/d exceeds it.
    #[serde(default)]
    #[deck(range = POSITIVE)]
    pub critical_stretch: Option<f64>,
    /// Sets whose bonds never break.
    #[serde(default)]
    #[deck(flatten, keys("no_fail"), with = no_fail)]
    pub no_fail: Vec<String>,
}

/// Force law of 2-manifolds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "kebab-case")]
#[deck(what = "model")]
pub enum SurfaceModel {
    /// κ |η|^(p−2) η / d^(2+αp) with the distance d along the surface.
    #[default]
    Power,
}

impl SurfaceMaterial {
    /// Returns the material of the engine.
    pub fn power(&self) -> PowerMaterial {
        PowerMaterial {
            density: self.density,
            kappa: self.kappa,
            alpha: self.alpha,
            p: self.p,
            horizon: self.horizon,
            bond: self.bond,
            self_interaction: self.self_interaction,
            critical_stretch: self.critical_stretch.unwrap_or(f64::INFINITY),
        }
    }
}

/// Scope of the material of a 2-manifold.
#[derive(Clone, Copy)]
pub(crate) struct SurfaceScope<'s> {
    /// Mean edge length, m; none if it is unknown before a file is read.
    pub(crate) spacing: Option<f64>,
    pub(crate) sets: &'s SetNames,
}

const LENGTHS: &str = "a length above the mean edge length (usual: 3 times the mean edge length)";

fn is_above(scope: SurfaceScope<'_>, horizon: Option<&f64>) -> bool {
    let known = scope.spacing.zip(horizon);
    known.is_none_or(|(spacing, horizon)| *horizon > spacing)
}

/// Returns whether the material may have a self-interaction; unknown exponents and bonds may.
fn supports(p: Option<&f64>, bond: Option<&SurfaceBond>) -> bool {
    let known = p.zip(bond);
    known.is_none_or(|(p, bond)| PowerMaterial::supports_self_interaction(*p, *bond))
}

fn no_fail(table: &Table<'_>, scope: SurfaceScope<'_>) -> Option<Vec<String>> {
    let item = table.optional("no_fail");
    item.map_or(Some(Vec::new()), |item| scope.sets.references(&item))
}

impl<S> DeckValue<S> for GeodesicMethod {
    fn read(item: &Item<'_>, _: S) -> Option<Self> {
        let method = item.text()?.parse();
        method.map_err(|_| item.out_of_range(Self::NAMES)).ok()
    }

    fn check(&self, _: KeyPath, _: S, _: &mut Check) {}
}

impl<S> Fallback<S> for GeodesicMethod {
    fn missing(self, table: &Table<'_>, key: &'static str, _: S) -> Option<Self> {
        table.record(key, self.to_string());
        Some(self)
    }
}

impl Described for GeodesicMethod {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let word = String::deserialize(deserializer)?;
        let unknown =
            |_| D::Error::custom(format!("unknown word `{word}`; allowed: {}", Self::NAMES));
        word.parse().map_err(unknown)
    }
}
