//! Values that are stored as arrays of an archive or as parts of one.

use super::{Counter, Values};

/// A type of number that archives can contain.
pub trait Number: Copy {
    /// Wraps numbers into an array of an archive.
    fn values(numbers: Vec<Self>) -> Values;

    /// Returns the numbers of an array, if they are of this type.
    fn of(values: &Values) -> Option<&[Self]>;
}

/// A value stored as a fixed count of numbers. The model determines the count; a checkpoint does not change it.
///
/// Structures whose fields are entries list them in [`saved!`](crate::saved).
pub trait Entry {
    /// The type of its numbers.
    type Number: Number;

    /// Returns the count of its numbers.
    fn count(&self) -> usize;

    /// Appends its numbers to an array.
    fn append_to(&self, array: &mut Vec<Self::Number>);

    /// Reads its numbers from the start of an array that has at least [`count`](Self::count) and returns the rest.
    fn take_from<'a>(&mut self, array: &'a [Self::Number]) -> &'a [Self::Number];
}

macro_rules! number {
    ($number:ty, $kind:ident) => {
        impl Number for $number {
            fn values(numbers: Vec<Self>) -> Values {
                Values::$kind(numbers)
            }

            fn of(values: &Values) -> Option<&[Self]> {
                match values {
                    Values::$kind(numbers) => Some(numbers),
                    _ => None,
                }
            }
        }

        impl Entry for $number {
            type Number = Self;

            fn count(&self) -> usize {
                1
            }

            fn append_to(&self, array: &mut Vec<Self>) {
                array.push(*self);
            }

            fn take_from<'a>(&mut self, array: &'a [Self]) -> &'a [Self] {
                *self = array[0];
                &array[1..]
            }
        }

        impl Entry for Vec<$number> {
            type Number = $number;

            fn count(&self) -> usize {
                self.len()
            }

            fn append_to(&self, array: &mut Vec<$number>) {
                array.extend_from_slice(self);
            }

            fn take_from<'a>(&mut self, array: &'a [$number]) -> &'a [$number] {
                let (own, rest) = array.split_at(self.len());
                self.copy_from_slice(own);
                rest
            }
        }
    };
}

number!(f64, F64);
number!(u64, U64);
number!(u8, U8);

impl Entry for Counter {
    type Number = u64;

    fn count(&self) -> usize {
        1
    }

    fn append_to(&self, array: &mut Vec<u64>) {
        array.push(self.get());
    }

    fn take_from<'a>(&mut self, array: &'a [u64]) -> &'a [u64] {
        *self = array[0].into();
        &array[1..]
    }
}

impl<E: Entry, const N: usize> Entry for [E; N] {
    type Number = E::Number;

    fn count(&self) -> usize {
        self.iter().map(Entry::count).sum()
    }

    fn append_to(&self, array: &mut Vec<E::Number>) {
        self.iter().for_each(|entry| entry.append_to(array));
    }

    fn take_from<'a>(&mut self, array: &'a [E::Number]) -> &'a [E::Number] {
        self.iter_mut()
            .fold(array, |rest, entry| entry.take_from(rest))
    }
}

impl<E: Entry, F: Entry<Number = E::Number>> Entry for (E, F) {
    type Number = E::Number;

    fn count(&self) -> usize {
        self.0.count() + self.1.count()
    }

    fn append_to(&self, array: &mut Vec<E::Number>) {
        self.0.append_to(array);
        self.1.append_to(array);
    }

    fn take_from<'a>(&mut self, array: &'a [E::Number]) -> &'a [E::Number] {
        let rest = self.0.take_from(array);
        self.1.take_from(rest)
    }
}

/// A missing value is stored as NaN in every number.
impl<E: Entry<Number = f64> + Default> Entry for Option<E> {
    type Number = f64;

    fn count(&self) -> usize {
        E::default().count()
    }

    fn append_to(&self, array: &mut Vec<f64>) {
        match self {
            Some(entry) => entry.append_to(array),
            None => array.resize(array.len() + self.count(), f64::NAN),
        }
    }

    fn take_from<'a>(&mut self, array: &'a [f64]) -> &'a [f64] {
        let mut entry = E::default();
        let rest = entry.take_from(array);
        let own = &array[..array.len() - rest.len()];
        *self = own.iter().any(|x| !x.is_nan()).then_some(entry);
        rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn through<E: Entry<Number = f64>>(entry: &E, fresh: &mut E, expected: usize) {
        let mut array = vec![7.0];
        entry.append_to(&mut array);
        array.push(8.0);
        assert_eq!(entry.count(), expected);
        assert_eq!(array.len(), expected + 2);
        assert_eq!(fresh.take_from(&array[1..]), [8.0]);
    }

    #[test]
    fn entries_restore_what_they_stored() {
        let mut pair = (0.0, [0.0; 2]);
        through(&(1.0, [2.0, 3.0]), &mut pair, 3);
        assert_eq!(pair, (1.0, [2.0, 3.0]));
        let mut vector = vec![0.0; 2];
        through(&vec![1.0, 2.0], &mut vector, 2);
        assert_eq!(vector, [1.0, 2.0]);
        let mut value = None;
        through(&Some((1.0, f64::NAN)), &mut value, 2);
        assert_eq!(value.map(|(t, _)| t), Some(1.0));
        through(&None, &mut value, 2);
        assert_eq!(value, None);
    }
}
