//! Serialised form of the engine's types in a model. Keys and words are taken from decks where they exist there.
//!
//! A field with `#[serde(with = "crate::form")]` has a type that is [`Described`], or an option, list, box or
//! pair of such types.

mod kernel;
mod manifold;
mod material;
mod number;
mod space;
mod tuned;

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

/// Describes a type of the engine by a remote serde derive.
macro_rules! described {
    ($($type:ty: $form:ty),* $(,)?) => {$(
        impl crate::form::Described for $type {
            fn write<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                <$form>::serialize(self, serializer)
            }

            fn read<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                <$form>::deserialize(deserializer)
            }
        }
    )*};
}
pub(crate) use described;
