//! Facts of surfaces.

use pericles_deck::{SurfaceBody, VertexAreas};
use pericles_manifold::SurfaceBond;
use pericles_manifold::geodesic::Ball;
use pericles_manifold::surface::AreaRule;
use serde_json::json;

use super::list::{Facts, Section};
use crate::units::significant;

impl Facts {
    pub(super) fn surface(&mut self, surface: &SurfaceBody) {
        let section = Section::Material;
        let material = &surface.material;
        let law = match material.bond {
            SurfaceBond::Displacement => "κ |η|^(p−2) η / d^(2+αp)",
            SurfaceBond::Chord => "κ |ℓ−ℓ₀|^(p−2) (ℓ−ℓ₀) n / d^(2+αp), frame-indifferent",
        };
        let areas = match surface.areas {
            VertexAreas::Rule(AreaRule::Barycentric) => {
                "one third of each adjacent triangle".into()
            }
            VertexAreas::Rule(AreaRule::MixedVoronoi) => "mixed Voronoi".into(),
            VertexAreas::Same(area) => {
                format!("{area} m² per vertex, independent of the triangles")
            }
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
        let force = format!(
            "{law}; p = {}, α = {}, κ = {}",
            material.p, material.alpha, material.kappa
        );
        let values = json!({ "p": material.p, "alpha": material.alpha, "kappa": material.kappa });
        self.line(section, "force", force)
            .checked("surface_law", "", values);
        let distances = match surface.geodesics.ball {
            Ball::Geodesic => method.to_string(),
            Ball::Euclid => format!("{method}, between vertices within a Euclidean ball"),
        };
        self.line(section, "distances", distances);
        self.line(section, "areas", areas)
            .checked("vertex_area", "m2", same_area);
        self.line(section, "self-interaction", own_cell);
        self.line(section, "bond failure", breaking).fact(
            "critical_stretch",
            "",
            material.critical_stretch,
        );
        self.constants(None, 3);
    }
}
