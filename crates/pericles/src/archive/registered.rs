//! The macro `saved!`, which generates saving and restoring from a list of fields.

/// Implements [`Checkpointed`](crate::Checkpointed) for a type from the list of all its fields.
///
/// Saving and restoring are generated from the same list. A missing field is a compile error that names the field.
/// After each field, or after several fields separated by commas, the list states how a checkpoint treats it:
///
/// | treatment | the field |
/// |---|---|
/// | `array("name")` | is an [`Entry`](crate::archive::Entry) stored in the array of this name; several fields share one array. The name is a format string with its arguments, which may use other fields |
/// | `points("name")` | is an entry like that of `array`, a component-major vector on the own points of a body that may be divided among processes |
/// | `times("name")` | is like that of `points`, and has times of the run: a run that starts from the state of another one starts with its own |
/// | `by(storage)` | is saved by the expression `storage`, a [`Storage`](crate::archive::Storage), which may use other fields |
/// | `part` | implements [`Checkpointed`](crate::Checkpointed) |
/// | `under("name")` | implements [`SavedUnder`](crate::archive::SavedUnder) and is saved under this name |
/// | `fixed` | does not change after construction |
/// | `scratch` | is written before it is read in every step, or does not influence results |
/// | `rebuilt` | follows from the other fields, on demand or by the function after `then` |
/// | `set(value)` | gets this value when a checkpoint is restored |
///
/// A type without fields has an empty list. `then |object| …` after the list is called after all fields are
/// restored and may return an error.
///
/// ```
/// use pericles::{Archive, Checkpointed, saved};
///
/// /// Reduces the step by a tenth whenever a step fails.
/// struct Careful {
///     most: u32,
///     step: f64,
///     failed: u64,
///     force: Vec<f64>,
///     started: bool,
/// }
///
/// saved! {
///     impl Checkpointed for Careful {
///         step: array("careful/step"),
///         failed: array("careful/failed"),
///         most: fixed,
///         force: scratch,
///         started: set(true),
///     }
/// }
///
/// let made = |step| Careful { most: 10, step, failed: 0, force: vec![0.0; 4], started: false };
/// let mut archive = Archive::default();
/// made(0.9).save(&mut archive);
/// let mut restored = made(1.0);
/// restored.restore(&archive)?;
/// assert_eq!(restored.step, 0.9);
/// assert!(restored.started);
/// # Ok::<(), pericles::PericlesError>(())
/// ```
///
/// A missing field is a compile error:
///
/// ```compile_fail,E0063
/// struct Careful {
///     step: f64,
///     failed: u64,
/// }
///
/// pericles::saved! {
///     impl Checkpointed for Careful {
///         step: array("careful/step"),
///     }
/// }
/// ```
///
/// Types of which a run may have several implement [`SavedUnder`](crate::archive::SavedUnder), with a name that
/// prefixes the names of their arrays. Structures of numbers that are part of one array implement
/// [`Entry`](crate::archive::Entry). Generic types are written as `impl<L: Law> …`, `impl<const D: usize> …` or
/// `impl<L: Law, const D: usize> …`.
///
/// ```
/// use pericles::{Archive, Checkpointed, saved};
///
/// #[derive(Default)]
/// struct Spring {
///     force: Vec<f64>,
///     exchanged: Exchanged,
/// }
///
/// #[derive(Default)]
/// struct Exchanged {
///     work: f64,
///     impulse: [f64; 3],
/// }
///
/// #[derive(Default)]
/// struct Supports {
///     springs: Vec<Spring>,
/// }
///
/// saved! {
///     impl Entry<Number = f64> for Exchanged { work, impulse }
/// }
///
/// saved! {
///     impl SavedUnder(name) for Spring {
///         force: array("{name}/force"),
///         exchanged: array("{name}/exchanged"),
///     }
/// }
///
/// saved! {
///     impl Checkpointed for Supports {
///         springs: under("supports"),
///     }
/// }
///
/// let supports = Supports { springs: vec![Spring::default(), Spring::default()] };
/// let mut archive = Archive::default();
/// supports.save(&mut archive);
/// let names: Vec<&String> = archive.arrays().keys().collect();
/// assert_eq!(names, ["supports/0/exchanged", "supports/0/force", "supports/1/exchanged", "supports/1/force"]);
/// ```
#[macro_export]
macro_rules! saved {
    // Structures that are part of an array.
    (impl Entry<Number = $number:ty> for $type:ty { $($field:ident),+ $(,)? }) => {
        impl $crate::archive::Entry for $type {
            type Number = $number;

            fn count(&self) -> usize {
                let _every_field = |_all: Self| Self { $($field: _all.$field),+ };
                let Self { $($field),+, .. } = self;
                0 $(+ $crate::archive::Entry::count($field))+
            }

            fn append_to(&self, array: &mut ::std::vec::Vec<$number>) {
                let Self { $($field),+, .. } = self;
                $($crate::archive::Entry::append_to($field, array);)+
            }

            fn take_from<'a>(&mut self, array: &'a [$number]) -> &'a [$number] {
                let Self { $($field),+, .. } = self;
                $(let array = $crate::archive::Entry::take_from($field, array);)+
                array
            }
        }
    };

    // Parameters of generic types.
    (impl<$law:ident: $bound:path, const $size:ident: usize> $($rest:tt)*) => {
        $crate::saved! { @impl [$law: $bound, const $size: usize] $($rest)* }
    };
    (impl<$law:ident: $bound:path> $($rest:tt)*) => {
        $crate::saved! { @impl [$law: $bound] $($rest)* }
    };
    (impl<const $size:ident: usize> $($rest:tt)*) => {
        $crate::saved! { @impl [const $size: usize] $($rest)* }
    };
    (impl $($rest:tt)*) => {
        $crate::saved! { @impl [] $($rest)* }
    };

    // Implementations. The closure is never called: it constructs the type from the listed fields, so that the
    // compiler reports missing ones.
    (@impl [$($generics:tt)*] Checkpointed for $type:ty {
        $($($field:ident),+: $how:ident $(($($what:tt)*))?),* $(,)?
    } $(then $then:expr)?) => {
        impl<$($generics)*> $crate::Checkpointed for $type {
            fn save(&self, archive: &mut $crate::Archive) {
                let _every_field = |_all: Self| Self { $($($field: _all.$field),+),* };
                let Self { $($($field,)+)* .. } = self;
                $($crate::saved! { @save archive [$($field),+] $how $(($($what)*))? })*
                let _ = archive;
            }

            fn restore(&mut self, archive: &$crate::Archive) -> $crate::Result<()> {
                let Self { $($($field,)+)* .. } = self;
                $($crate::saved! { @restore archive [$($field),+] $how $(($($what)*))? })*
                $(
                    let then: fn(&mut Self) -> $crate::Result<()> = $then;
                    then(self)?;
                )?
                let _ = archive;
                Ok(())
            }
        }
    };
    (@impl [$($generics:tt)*] SavedUnder($name:ident) for $type:ty {
        $($($field:ident),+: $how:ident $(($($what:tt)*))?),* $(,)?
    } $(then $then:expr)?) => {
        impl<$($generics)*> $crate::archive::SavedUnder for $type {
            fn save_under(&self, $name: &str, archive: &mut $crate::Archive) {
                let _every_field = |_all: Self| Self { $($($field: _all.$field),+),* };
                let Self { $($($field,)+)* .. } = self;
                $($crate::saved! { @save archive [$($field),+] $how $(($($what)*))? })*
            }

            fn restore_under(
                &mut self,
                $name: &str,
                archive: &$crate::Archive,
            ) -> $crate::Result<()> {
                let Self { $($($field,)+)* .. } = self;
                $($crate::saved! { @restore archive [$($field),+] $how $(($($what)*))? })*
                $(
                    let then: fn(&mut Self) -> $crate::Result<()> = $then;
                    then(self)?;
                )?
                Ok(())
            }
        }
    };

    // Fields.
    (@save $archive:ident [$($field:ident),+] array($($name:tt)*)) => {
        $crate::saved! { @put $archive [$($field),+] Shared $($name)* }
    };
    (@save $archive:ident [$($field:ident),+] points($($name:tt)*)) => {
        $crate::saved! { @put $archive [$($field),+] Points $($name)* }
    };
    (@save $archive:ident [$($field:ident),+] times($($name:tt)*)) => {{
        $crate::saved! { @put $archive [$($field),+] Points $($name)* }
        $archive.mark_times(::std::fmt::format(::std::format_args!($($name)*)));
    }};
    (@put $archive:ident [$($field:ident),+] $layout:ident $($name:tt)*) => {{
        let mut numbers = ::std::vec::Vec::with_capacity(0 $(+ $crate::archive::Entry::count($field))+);
        $($crate::archive::Entry::append_to($field, &mut numbers);)+
        let name = ::std::fmt::format(::std::format_args!($($name)*));
        let layout = $crate::archive::Layout::$layout;
        $archive.put_as(name, $crate::archive::Number::values(numbers), layout);
    }};
    (@restore $archive:ident [$($field:ident),+] points($($name:tt)*)) => {
        $crate::saved! { @restore $archive [$($field),+] array($($name)*) }
    };
    (@restore $archive:ident [$($field:ident),+] times($($name:tt)*)) => {
        $crate::saved! { @restore $archive [$($field),+] array($($name)*) }
    };
    (@restore $archive:ident [$($field:ident),+] array($($name:tt)*)) => {{
        let name = ::std::fmt::format(::std::format_args!($($name)*));
        let count = 0 $(+ $crate::archive::Entry::count(&*$field))+;
        let numbers = $archive.exactly(&name, count)?;
        $(let numbers = $crate::archive::Entry::take_from(&mut *$field, numbers);)+
        let _ = numbers;
    }};
    (@save $archive:ident [$field:ident] by($storage:expr)) => {{
        let storage = $storage;
        $crate::archive::Storage::save(&storage, $field, $archive);
    }};
    (@restore $archive:ident [$field:ident] by($storage:expr)) => {{
        let storage = $storage;
        $crate::archive::Storage::restore(&storage, &mut *$field, $archive)?;
    }};
    (@save $archive:ident [$($field:ident),+] part) => {
        $($crate::Checkpointed::save($field, $archive);)+
    };
    (@restore $archive:ident [$($field:ident),+] part) => {
        $($crate::Checkpointed::restore(&mut *$field, $archive)?;)+
    };
    (@save $archive:ident [$field:ident] under($($name:tt)*)) => {{
        let name = ::std::fmt::format(::std::format_args!($($name)*));
        $crate::archive::SavedUnder::save_under($field, &name, $archive);
    }};
    (@restore $archive:ident [$field:ident] under($($name:tt)*)) => {{
        let name = ::std::fmt::format(::std::format_args!($($name)*));
        $crate::archive::SavedUnder::restore_under(&mut *$field, &name, $archive)?;
    }};
    (@restore $archive:ident [$($field:ident),+] set($value:expr)) => {
        $(*$field = $value;)+
    };
    (@save $archive:ident [$($field:ident),+] set($value:expr)) => {
        $(let _ = $field;)+
    };
    (@$way:ident $archive:ident [$($field:ident),+] fixed) => {
        $(let _ = $field;)+
    };
    (@$way:ident $archive:ident [$($field:ident),+] scratch) => {
        $(let _ = $field;)+
    };
    (@$way:ident $archive:ident [$($field:ident),+] rebuilt) => {
        $(let _ = $field;)+
    };
}
