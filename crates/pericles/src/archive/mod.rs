//! Checkpoints: the state that a run needs to resume as if it had never stopped.
//!
//! An [`Archive`] contains named arrays of numbers. A type with state from step to step implements [`Checkpointed`],
//! usually by listing all its fields in [`saved!`](crate::saved). The list generates the code for saving and
//! restoring; a missing field is a compile error. [`round_trip`](crate::round_trip) tests whole runs.

mod counter;
mod entry;
mod layout;
mod registered;

pub use counter::Counter;
pub use entry::{Entry, Number};
pub use layout::{Laid, Layout, Storage};

use std::collections::{BTreeMap, BTreeSet};

use crate::error::{PericlesError, Result};

/// An array of an archive. Arrays are equal if all their bits are: NaN stands for missing values.
#[derive(Debug, Clone)]
pub enum Values {
    /// Floating-point numbers.
    F64(Vec<f64>),
    /// Counts.
    U64(Vec<u64>),
    /// Bytes.
    U8(Vec<u8>),
}

impl PartialEq for Values {
    fn eq(&self, other: &Self) -> bool {
        let bits = |x: &f64| x.to_bits();
        match (self, other) {
            (Self::F64(a), Self::F64(b)) => a.iter().map(bits).eq(b.iter().map(bits)),
            (Self::U64(a), Self::U64(b)) => a == b,
            (Self::U8(a), Self::U8(b)) => a == b,
            _ => false,
        }
    }
}

/// Named arrays. `pericles-io` defines their file format.
///
/// Arrays that are not equal on all processes of a divided body have a [`Layout`]. Archives are equal if their arrays
/// are; files contain no layouts.
#[derive(Debug, Clone, Default)]
pub struct Archive {
    pub(crate) arrays: BTreeMap<String, Values>,
    /// Layouts other than [`Layout::Shared`].
    pub(crate) layouts: BTreeMap<String, Layout>,
    /// Arrays with times of the run.
    pub(crate) times: BTreeSet<String>,
}

impl PartialEq for Archive {
    fn eq(&self, other: &Self) -> bool {
        self.arrays == other.arrays
    }
}

/// A type that may have state from step to step: an operator (damage), boundary, integrator or observer.
///
/// Types list their fields in [`saved!`](crate::saved), including types without state. There are no default
/// methods, so that no type is mistaken for one without state.
pub trait Checkpointed {
    /// Adds the state to the archive.
    fn save(&self, archive: &mut Archive);

    /// Restores the state.
    ///
    /// # Errors
    /// [`PericlesError::BadArchive`] if an array is missing or has another length; the object is then unchanged or
    /// must be discarded.
    fn restore(&mut self, archive: &Archive) -> Result<()>;
}

/// A type with state of which a run may have several; each is saved under its own name.
///
/// Elements of vectors and arrays are numbered from 0, as in `motion/0`.
pub trait SavedUnder {
    /// Adds the state to the archive, in arrays whose names begin with `name`.
    fn save_under(&self, name: &str, archive: &mut Archive);

    /// Restores the state.
    ///
    /// # Errors
    /// The errors of [`Checkpointed::restore`].
    fn restore_under(&mut self, name: &str, archive: &Archive) -> Result<()>;
}

impl Archive {
    /// Adds an array that is equal on all processes, replacing an array of the same name.
    pub fn put(&mut self, name: impl Into<String>, values: Values) {
        self.put_as(name, values, Layout::Shared);
    }

    /// Adds an array with a layout, replacing an array of the same name.
    pub fn put_as(&mut self, name: impl Into<String>, values: Values, layout: Layout) {
        let name = name.into();
        match layout {
            Layout::Shared => self.layouts.remove(&name),
            layout => self.layouts.insert(name.clone(), layout),
        };
        self.arrays.insert(name, values);
    }

    /// Adds the arrays of another archive; `prefix` is put before their names.
    pub fn put_all(&mut self, prefix: &str, other: Self) {
        let Self {
            arrays,
            mut layouts,
            times,
        } = other;
        let times = times.into_iter().map(|name| format!("{prefix}{name}"));
        self.times.extend(times);
        for (name, values) in arrays {
            let layout = layouts.remove(&name).unwrap_or_default();
            self.put_as(format!("{prefix}{name}"), values, layout);
        }
    }

    /// Declares that an array has times of the run. A run that starts from the state of another one starts with its own.
    pub fn mark_times(&mut self, name: impl Into<String>) {
        self.times.insert(name.into());
    }

    /// Replaces arrays by those of the same name in another archive, except [times](Self::mark_times).
    ///
    /// # Errors
    /// [`PericlesError::BadArchive`] if an array has another type or length there.
    pub fn replace_by(&mut self, other: &Self) -> Result<()> {
        for (name, values) in &mut self.arrays {
            let Some(new) = other
                .arrays
                .get(name)
                .filter(|_| !self.times.contains(name))
            else {
                continue;
            };
            if !new.is_like(values) {
                return Err(missing(name));
            }
            check_length(name, new.len(), values.len())?;
            values.clone_from(new);
        }
        Ok(())
    }

    /// Returns the layout of an array.
    pub fn layout(&self, name: &str) -> &Layout {
        self.layouts.get(name).unwrap_or(&Layout::Shared)
    }

    /// Returns all arrays by name.
    pub fn arrays(&self) -> &BTreeMap<String, Values> {
        &self.arrays
    }

    /// Returns all arrays by name, consuming the archive.
    pub fn into_arrays(self) -> BTreeMap<String, Values> {
        self.arrays
    }

    /// Returns the numbers stored under `name`, of any count.
    ///
    /// # Errors
    /// [`PericlesError::BadArchive`] if the array is missing or of another type.
    pub fn numbers<T: Number>(&self, name: &str) -> Result<&[T]> {
        let stored = self.arrays.get(name).and_then(T::of);
        stored.ok_or_else(|| missing(name))
    }

    /// Returns the numbers stored under `name`, which must be `count` in number.
    ///
    /// # Errors
    /// [`PericlesError::BadArchive`] if the array is missing, of another type or of another length.
    pub fn exactly<T: Number>(&self, name: &str, count: usize) -> Result<&[T]> {
        let stored = self.numbers(name)?;
        check_length(name, stored.len(), count)?;
        Ok(stored)
    }

    /// Returns the names of the arrays that differ in any bit between two archives or exist in only one of them.
    pub fn differences(&self, other: &Self) -> Vec<String> {
        let names = self.arrays.keys().chain(other.arrays.keys());
        let names: BTreeSet<&String> = names.collect();
        let differs = |name: &&String| match (self.arrays.get(*name), other.arrays.get(*name)) {
            (Some(ours), Some(theirs)) => !ours.has_the_bits_of(theirs),
            _ => true,
        };
        names.into_iter().filter(differs).cloned().collect()
    }

    /// Copies the numbers stored under `name` to `target`.
    pub fn f64_into(&self, name: &str, target: &mut [f64]) -> Result<()> {
        copy(name, self.numbers(name)?, target)
    }

    /// Copies the bytes stored under `name` to `target`.
    pub fn u8_into(&self, name: &str, target: &mut [u8]) -> Result<()> {
        copy(name, self.numbers(name)?, target)
    }

    /// Copies the counts stored under `name` to `target`.
    pub fn u64_into(&self, name: &str, target: &mut [u64]) -> Result<()> {
        copy(name, self.numbers(name)?, target)
    }

    /// Returns the counts stored under `name`, of any length.
    pub fn u64s(&self, name: &str) -> Result<&[u64]> {
        self.numbers(name)
    }

    /// Returns the numbers stored under `name`, of any length.
    pub fn f64s(&self, name: &str) -> Result<&[f64]> {
        self.numbers(name)
    }
}

impl Values {
    fn has_the_bits_of(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::F64(ours), Self::F64(theirs)) => ours
                .iter()
                .map(|x| x.to_bits())
                .eq(theirs.iter().map(|x| x.to_bits())),
            _ => self == other,
        }
    }
}

/// An optional part; the model, not the checkpoint, determines whether it exists.
impl<S: Checkpointed> Checkpointed for Option<S> {
    fn save(&self, archive: &mut Archive) {
        self.iter().for_each(|part| part.save(archive));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        self.iter_mut().try_for_each(|part| part.restore(archive))
    }
}

impl<S: Checkpointed> Checkpointed for Vec<S> {
    fn save(&self, archive: &mut Archive) {
        self.iter().for_each(|part| part.save(archive));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        self.iter_mut().try_for_each(|part| part.restore(archive))
    }
}

impl<S: Checkpointed + ?Sized> Checkpointed for Box<S> {
    fn save(&self, archive: &mut Archive) {
        (**self).save(archive);
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        (**self).restore(archive)
    }
}

/// An optional part; the model, not the checkpoint, determines whether it exists.
impl<S: SavedUnder> SavedUnder for Option<S> {
    fn save_under(&self, name: &str, archive: &mut Archive) {
        self.iter().for_each(|part| part.save_under(name, archive));
    }

    fn restore_under(&mut self, name: &str, archive: &Archive) -> Result<()> {
        self.iter_mut()
            .try_for_each(|part| part.restore_under(name, archive))
    }
}

impl<S: SavedUnder> SavedUnder for [S] {
    fn save_under(&self, name: &str, archive: &mut Archive) {
        for (k, part) in self.iter().enumerate() {
            part.save_under(&format!("{name}/{k}"), archive);
        }
    }

    fn restore_under(&mut self, name: &str, archive: &Archive) -> Result<()> {
        for (k, part) in self.iter_mut().enumerate() {
            part.restore_under(&format!("{name}/{k}"), archive)?;
        }
        Ok(())
    }
}

impl<S: SavedUnder> SavedUnder for Vec<S> {
    fn save_under(&self, name: &str, archive: &mut Archive) {
        self[..].save_under(name, archive);
    }

    fn restore_under(&mut self, name: &str, archive: &Archive) -> Result<()> {
        self[..].restore_under(name, archive)
    }
}

impl<S: SavedUnder, const N: usize> SavedUnder for [S; N] {
    fn save_under(&self, name: &str, archive: &mut Archive) {
        self[..].save_under(name, archive);
    }

    fn restore_under(&mut self, name: &str, archive: &Archive) -> Result<()> {
        self[..].restore_under(name, archive)
    }
}

impl<S: SavedUnder + ?Sized> SavedUnder for Box<S> {
    fn save_under(&self, name: &str, archive: &mut Archive) {
        (**self).save_under(name, archive);
    }

    fn restore_under(&mut self, name: &str, archive: &Archive) -> Result<()> {
        (**self).restore_under(name, archive)
    }
}

pub(crate) fn missing(name: &str) -> PericlesError {
    PericlesError::BadArchive {
        reason: format!("the array \"{name}\" is missing or of another type"),
    }
}

pub(crate) fn check_length(name: &str, found: usize, needed: usize) -> Result<()> {
    if found == needed {
        return Ok(());
    }
    Err(PericlesError::BadArchive {
        reason: format!("the array \"{name}\" has {found} entries, the model needs {needed}"),
    })
}

fn copy<T: Copy>(name: &str, stored: &[T], target: &mut [T]) -> Result<()> {
    check_length(name, stored.len(), target.len())?;
    target.copy_from_slice(stored);
    Ok(())
}
