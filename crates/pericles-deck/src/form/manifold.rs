//! Serialised form of 2-manifolds and their materials.

use pericles_manifold::geodesic::GeodesicMethod;
use pericles_manifold::surface::SurfaceChecks;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Described, described};

#[derive(Serialize, Deserialize)]
#[serde(remote = "SurfaceChecks", deny_unknown_fields)]
struct SurfaceChecksForm {
    open: bool,
    #[serde(rename = "several")]
    several_components: bool,
    flip: bool,
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

described!(SurfaceChecks: SurfaceChecksForm);
