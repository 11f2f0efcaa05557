//! Serialised form of the engine's types in a model, which cannot implement the traits of serde here. Keys and words are taken
//! from decks where they exist there; remote derives next to the declarations of the keys define them.
//!
//! A field with `#[serde(with = "crate::form")]` has a type that is [`Described`], or an option, list, box or
//! pair of such types.

use std::fmt;

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A type with a serialised form.
pub(crate) trait Described: Sized {
    /// Serialises the value.
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error>;

    /// Deserialises a value.
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error>;
}

/// Entry point of `#[serde(with)]`.
pub(crate) fn serialize<T: Described, S: Serializer>(
    value: &T,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    value.write(serializer)
}

/// Entry point of `#[serde(with)]`.
pub(crate) fn deserialize<'de, T: Described, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<T, D::Error> {
    T::read(deserializer)
}

/// Adapter that serialises a described value.
struct Writer<'a, T>(&'a T);

impl<T: Described> Serialize for Writer<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.write(serializer)
    }
}

/// Adapter that deserialises a described value.
struct Reader<T>(T);

impl<'de, T: Described> Deserialize<'de> for Reader<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::read(deserializer).map(Self)
    }
}

impl<T: Described> Described for Option<T> {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.as_ref().map(Writer).serialize(serializer)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let read = Option::<Reader<T>>::deserialize(deserializer)?;
        Ok(read.map(|Reader(value)| value))
    }
}

impl<T: Described> Described for Vec<T> {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter().map(Writer))
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let read = Vec::<Reader<T>>::deserialize(deserializer)?;
        Ok(read.into_iter().map(|Reader(value)| value).collect())
    }
}

impl<T: Described> Described for Box<T> {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        T::write(self, serializer)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::read(deserializer).map(Box::new)
    }
}

impl<A: Described, B: Described> Described for (A, B) {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (Writer(&self.0), Writer(&self.1)).serialize(serializer)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (Reader(a), Reader(b)) = Deserialize::deserialize(deserializer)?;
        Ok((a, b))
    }
}

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

/// Describes a type of the engine by a remote serde derive.
macro_rules! described {
    ($($type:ty: $form:ty),* $(,)?) => {$(
        impl crate::form::Described for $type {
            fn write<S: serde::Serializer>(&self, serializer: S) -> ::core::result::Result<S::Ok, S::Error> {
                <$form>::serialize(self, serializer)
            }

            fn read<'de, D: serde::Deserializer<'de>>(deserializer: D) -> ::core::result::Result<Self, D::Error> {
                <$form>::deserialize(deserializer)
            }
        }
    )*};
}
pub(crate) use described;
