//! Serialised form of the methods for geodesic distances.

use pericles_manifold::geodesic::GeodesicMethod;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

use super::Described;

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
