//! Serialised form of numbers that may be infinite, such as the bounds of an open box.

use std::fmt;

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::Described;

/// Words for infinite numbers, which JSON lacks.
const WORDS: [(&str, f64); 2] = [("inf", f64::INFINITY), ("-inf", f64::NEG_INFINITY)];

impl Described for f64 {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match WORDS.iter().find(|(_, value)| value == self) {
            Some((word, _)) => serializer.serialize_str(word),
            None if self.is_nan() => {
                Err(serde::ser::Error::custom("NaN is not allowed in a model"))
            }
            None => serializer.serialize_f64(*self),
        }
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Number;

        impl Visitor<'_> for Number {
            type Value = f64;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number, \"inf\" or \"-inf\"")
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<f64, E> {
                Ok(value)
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<f64, E> {
                Ok(value as f64)
            }

            fn visit_u64<E: Error>(self, value: u64) -> Result<f64, E> {
                Ok(value as f64)
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<f64, E> {
                let known = WORDS.iter().find(|(known, _)| *known == word);
                known
                    .map(|(_, value)| *value)
                    .ok_or_else(|| E::custom(format!("`{word}` is not a number")))
            }
        }

        deserializer.deserialize_any(Number)
    }
}

impl<const N: usize> Described for [f64; N] {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_vec().write(serializer)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let numbers = Vec::<f64>::read(deserializer)?;
        let found = numbers.len();
        let wrong = |_| D::Error::custom(format!("expected {N} numbers, found {found}"));
        numbers.try_into().map_err(wrong)
    }
}

/// Describes types that serde serialises itself.
macro_rules! plain {
    ($($type:ty),*) => {$(
        impl Described for $type {
            fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                self.serialize(serializer)
            }

            fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                Self::deserialize(deserializer)
            }
        }
    )*};
}

plain!(bool, u8, u32, u64, usize, [i32; 3]);
