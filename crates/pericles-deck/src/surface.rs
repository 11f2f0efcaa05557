//! Materials and geodesic distances of 2-manifolds.

use pericles_manifold::PowerMaterial;
use pericles_manifold::geodesic::{Ball, GeodesicMethod};
use serde::{Deserialize, Serialize};

use crate::body::{SurfaceShape, VertexAreas};
use crate::quantity::Quantity;
use crate::reader::Table;
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
    #[serde(with = "crate::form")]
    pub material: PowerMaterial,
    /// Sets whose bonds never break.
    #[serde(default)]
    pub no_fail: Vec<String>,
    /// Algorithm for geodesic distances.
    #[serde(default, with = "crate::form")]
    pub method: GeodesicMethod,
    /// Definition of neighbours.
    #[serde(default, with = "crate::form")]
    pub ball: Ball,
}

/// Reads `[geodesics]`.
pub(crate) fn geodesics(table: Table<'_>) -> Option<(GeodesicMethod, Ball)> {
    let method = match table.optional("method") {
        None => {
            let method = GeodesicMethod::default();
            table.record("method", method.to_string());
            Some(method)
        }
        Some(item) => item.text().and_then(|text| {
            let method = text.parse().ok();
            if method.is_none() {
                item.out_of_range(GeodesicMethod::NAMES);
            }
            method
        }),
    };
    let ball = table.worded("ball", "ball");
    table.finish();
    Some((method?, ball?))
}

/// Reads `[material]` of a 2-manifold.
pub(crate) fn material(
    table: Table<'_>,
    spacing: Option<f64>,
    sets: &SetNames,
) -> Option<(PowerMaterial, Vec<String>)> {
    table.choice_or_first("model", "model", &[("power", ())]);
    table.maybe("name", |item| item.text());
    let positive = |key, quantity| table.required(key).and_then(|item| item.positive(quantity));
    let density = positive("density", Quantity::SurfaceDensity);
    let kappa = table.or("kappa", 1.0, |item| item.positive(Quantity::Number));
    let alpha = table.required("alpha").and_then(|item| {
        item.within(Quantity::Number, "a number above 0 and below 1", |alpha| {
            alpha > 0.0 && alpha < 1.0
        })
    });
    let p = table
        .required("p")
        .and_then(|item| item.within(Quantity::Number, "a number of at least 2", |p| p >= 2.0));
    let horizon = table.required("horizon").and_then(|item| {
        item.within(
            Quantity::Length,
            "a length above the mean edge length (usual: 3 times the mean edge length)",
            |horizon| horizon > 0.0 && spacing.is_none_or(|spacing| horizon > spacing),
        )
    });
    let bond = table.worded("bond", "bond");
    let self_interaction = table.optional("self_interaction").map_or_else(
        || {
            // Without it results for larger α depend on the mesh.
            let supported = PowerMaterial::supports_self_interaction(p?, bond?);
            let default = supported && alpha? >= 0.5;
            table.record("self_interaction", default);
            Some(default)
        },
        |item| {
            let wanted = item.boolean()?;
            let supported = |p, bond| PowerMaterial::supports_self_interaction(p, bond);
            if wanted && !p.zip(bond).is_none_or(|(p, bond)| supported(p, bond)) {
                item.out_of_range("false, or true with p = 2 and bond = \"displacement\"");
                return None;
            }
            Some(wanted)
        },
    );
    let critical_stretch = table
        .maybe("critical_stretch", |item| item.positive(Quantity::Number))
        .map(|given| given.unwrap_or(f64::INFINITY));
    let no_fail = table
        .optional("no_fail")
        .map_or(Some(Vec::new()), |item| sets.references(&item));
    table.finish();
    Some((
        PowerMaterial {
            density: density?,
            kappa: kappa?,
            alpha: alpha?,
            p: p?,
            horizon: horizon?,
            bond: bond?,
            self_interaction: self_interaction?,
            critical_stretch: critical_stretch?,
        },
        no_fail?,
    ))
}
