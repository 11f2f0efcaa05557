//! `[output]` and `[checkpoint]`: output files and their schedules.

mod derived;
mod fields;
mod picture;
mod profile;
mod schedule;

pub use derived::DerivedQuantity;
pub use fields::{CellChoice, FieldBlocks, FieldFormat, PointNumber};
pub use picture::{Picture, PictureColours, PictureFormat, PictureLook};
pub use profile::Profile;

use pericles::observe::{Field, Schedule};
use pericles_deck_derive::{DeckKeys, DeckTable};
use serde::{Deserialize, Serialize};

use self::fields::{FieldScope, Fields, cells, field_names, quantity};
use crate::component::Variables;
use crate::declaration::{Check, DeckTable, DeckValue, declared};
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::set::SetNames;

/// Output of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Schedule of field files.
    #[serde(with = "crate::form")]
    pub fields: Schedule,
    /// Names of the fields.
    #[serde(with = "crate::form")]
    pub names: Vec<Field>,
    /// Integers of the points written with the fields.
    #[serde(default)]
    pub numbers: Vec<PointNumber>,
    /// File formats of the fields.
    #[serde(default = "FieldFormat::usual")]
    pub formats: Vec<FieldFormat>,
    /// Whether VTU files contain cells or points.
    #[serde(default)]
    pub cells: CellChoice,
    /// Whether fields are also written on the elements of a mesh, in separate files.
    #[serde(default)]
    pub mesh_cells: bool,
    /// Blocks of Exodus files.
    #[serde(default)]
    pub blocks: FieldBlocks,
    /// Schedule of history.csv: energies, probes and reactions.
    #[serde(with = "crate::form")]
    pub history: Schedule,
    /// Fields or components whose minimum and maximum are columns of history.csv.
    #[serde(default, with = "crate::form")]
    pub extremes: Vec<(Field, Option<usize>)>,
    /// The table of crack tips, if given; see [`Output::cracks`].
    #[serde(default)]
    pub cracks: Option<CrackOutput>,
    /// The table of fragments.
    pub fragments: FragmentOutput,
    /// Precision of numbers in field files.
    pub precision: Precision,
    /// Rate ν of the energy bound in history.csv, 1/s; none for no bound.
    #[serde(default)]
    pub energy_bound: Option<f64>,
    /// Pictures.
    #[serde(default, rename = "picture")]
    pub pictures: Vec<Picture>,
    /// Fields along straight lines at the end of the run.
    #[serde(default, rename = "profile", skip_serializing_if = "Vec::is_empty")]
    pub profiles: Vec<Profile>,
    /// Quantities derived from columns of the tables.
    #[serde(default, rename = "quantity", skip_serializing_if = "Vec::is_empty")]
    pub quantities: Vec<DerivedQuantity>,
}

impl Default for Output {
    /// The output of a deck without `[output]`.
    fn default() -> Self {
        Self {
            fields: Schedule::Count(20),
            names: Field::USUAL.to_vec(),
            formats: FieldFormat::usual(),
            numbers: Vec::new(),
            cells: CellChoice::Auto,
            mesh_cells: false,
            blocks: FieldBlocks::Groups,
            history: Schedule::Count(200),
            extremes: Vec::new(),
            cracks: None,
            fragments: FragmentOutput::NONE,
            precision: Precision::Double,
            energy_bound: None,
            pictures: Vec::new(),
            profiles: Vec::new(),
            quantities: Vec::new(),
        }
    }
}

/// Rows of the table of crack tips. Default: the schedule of the history.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = Schedule, word_for(NEVER, Self::NONE))]
pub struct CrackOutput {
    /// Schedule of the rows.
    #[serde(with = "crate::form")]
    #[deck(flatten)]
    pub schedule: Schedule,
    /// Damage above which a point is part of a crack.
    #[deck(
        range = between(0.0, 1.0).described("a damage between 0 and 1, both excluded"),
        default = Self::THRESHOLD
    )]
    pub threshold: f64,
}

/// Rows of the table of fragments, the sets of points connected by intact bonds. Default: "never", because each row needs a
/// pass over all bonds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(word_for(NEVER, Self::NONE))]
pub struct FragmentOutput {
    /// Schedule of the rows.
    #[serde(with = "crate::form")]
    #[deck(flatten, scope = Schedule::Count(50))]
    pub schedule: Schedule,
    /// Smallest mass of a fragment, as a fraction of the mass of the body.
    #[deck(
        range = from_below(0.0, 1.0)
            .described("a fraction of the body's mass, at least 0 and below 1"),
        default = Self::NONE.smallest
    )]
    pub smallest: f64,
}

impl FragmentOutput {
    /// No table.
    pub const NONE: Self = Self {
        schedule: Schedule::Never,
        smallest: 1e-3,
    };
}

/// Rows of history.csv: energies, probes and reactions.
#[derive(DeckTable)]
#[deck(scope = Variables, word_for(NEVER, Self::NONE))]
struct History {
    #[deck(flatten, scope = Schedule::Count(200))]
    schedule: Schedule,
    /// Fields or components, such as "Damage" or "Velocity_y", whose minimum and maximum over all points become columns
    /// `min_…` and `max_…` of history.csv. Vectors and tensors without a component enter by their norm.
    #[deck(with = extremes)]
    extremes: Vec<FieldComponent>,
}

impl History {
    /// No history.
    const NONE: Self = Self {
        schedule: Schedule::Never,
        extremes: Vec::new(),
    };
}

/// Precision of numbers in field files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// 32 bits.
    Single,
    /// 64 bits.
    Double,
}

/// Schedule of checkpoints, from which `pericles resume` continues a stopped run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "snake_case")]
#[deck(exclusive, default)]
pub enum Checkpoint {
    /// Wall-clock time between checkpoints.
    ///
    /// In s.
    Wall(#[deck(quantity = Time, range = POSITIVE)] f64),
    /// Steps between checkpoints.
    Every(u64),
    /// Simulated time between checkpoints.
    ///
    /// In s.
    Interval(#[deck(quantity = Time, range = POSITIVE)] f64),
}

impl Default for Checkpoint {
    fn default() -> Self {
        Self::Wall(600.0)
    }
}

/// Reads `[output]`. `driven`: whether supports move; `surface`: whether the body is a 2-manifold, whose
/// field files contain the kinetic energy density by default; `mesh`: whether the body is a mesh, which has
/// cells.
pub(crate) fn read(
    table: Table<'_>,
    dimension: Option<usize>,
    driven: bool,
    surface: bool,
    mesh: bool,
    sets: &SetNames,
) -> Option<Output> {
    let mut usual = Field::USUAL.to_vec();
    if surface {
        usual.push(Field::KineticEnergyDensity);
    }
    let scope = Variables {
        dimension,
        time: true,
    };
    let fields = inner(
        &table,
        "fields",
        FieldScope {
            dimension,
            usual: &usual,
            mesh,
            sets,
        },
    );
    let cells = cells(&table);
    let history: Option<History> = inner(&table, "history", scope);
    let cracks = cracks(&table, history.as_ref().map(|history| history.schedule));
    let fragments = match table.optional("fragments") {
        Some(item) => FragmentOutput::read(&item, ()),
        None => Some(FragmentOutput::NONE),
    };
    let precision = table.choice_or_first(
        "precision",
        "precision",
        &[("double", Precision::Double), ("single", Precision::Single)],
    );
    if driven {
        table.forbid(
            "energy_bound",
            "the bound does not include the work of moving supports",
        );
    }
    let energy_bound = table.maybe("energy_bound", |item| {
        item.positive(Quantity::Time).map(f64::recip)
    });
    let pictures = declared(&table, "picture", scope);
    let profiles = declared(&table, "profile", scope);
    let quantities = declared(&table, "quantity", scope);
    table.finish();
    let Fields {
        schedule,
        names,
        formats,
        mesh_cells,
        blocks,
    } = fields?;
    let History {
        schedule: history,
        extremes,
    } = history?;
    Some(Output {
        fields: schedule,
        names: names.fields,
        numbers: names.numbers,
        formats,
        cells: cells?,
        mesh_cells,
        blocks,
        history,
        extremes,
        cracks: cracks?,
        fragments: fragments?,
        precision: precision?,
        energy_bound: energy_bound?,
        pictures: pictures?,
        profiles: profiles?,
        quantities: quantities?,
    })
}

/// The word for no output.
const NEVER: &str = "never";

/// A field, and optionally one of its components.
type FieldComponent = (Field, Option<usize>);

/// Reads a table of `[output]`, or an empty one if it is missing.
fn inner<S: Copy, T: DeckTable<S> + DeckValue<S>>(
    table: &Table<'_>,
    key: &'static str,
    scope: S,
) -> Option<T> {
    match table.optional(key) {
        Some(item) => T::read(&item, scope),
        None => T::read_table(table.table_or_empty(key)?, scope),
    }
}

fn extremes(item: &Item<'_>, scope: Variables) -> Option<Vec<FieldComponent>> {
    each_once(item, |item| field(item, scope.dimension))
}

/// Reads a list of distinct fields.
fn each_once<T: PartialEq>(
    item: &Item<'_>,
    one: impl Fn(&Item<'_>) -> Option<T>,
) -> Option<Vec<T>> {
    let items = item.list("a list of field names")?;
    let mut fields = Some(Vec::new());
    for item in &items {
        match (one(item), &mut fields) {
            (Some(field), Some(known)) if known.contains(&field) => {
                item.out_of_range("each field once");
                fields = None;
            }
            (Some(field), Some(known)) => known.push(field),
            _ => fields = None,
        }
    }
    fields
}

impl CrackOutput {
    /// The damage on a straight crack is close to 1/2; this value detects cracks without their surroundings.
    const THRESHOLD: f64 = 0.35;

    /// No table.
    const NONE: Self = Self {
        schedule: Schedule::Never,
        threshold: Self::THRESHOLD,
    };
}

/// Reads the table of crack tips, if it is given; its defaults are recorded in any case.
fn cracks(table: &Table<'_>, history: Option<Schedule>) -> Option<Option<CrackOutput>> {
    let usual = history.unwrap_or(Schedule::Count(200));
    let cracks = inner(table, "cracks", usual)?;
    Some(table.has("cracks").then_some(cracks))
}

impl Output {
    /// Returns the table of crack tips; the default schedule is the schedule of the history.
    pub fn cracks(&self) -> CrackOutput {
        self.cracks.unwrap_or(CrackOutput {
            schedule: self.history,
            threshold: CrackOutput::THRESHOLD,
        })
    }

    /// Returns whether field files may contain cells.
    pub fn writes_cells(&self) -> bool {
        self.fields != Schedule::Never
            && self.cells != CellChoice::Never
            && self.formats.contains(&FieldFormat::Vtu)
    }

    /// Returns whether a field is written.
    pub fn wants(&self, wanted: Field) -> bool {
        self.wants_any(|field| field == wanted)
    }

    /// Returns whether stress or strain is written, which needs single bonds.
    pub fn wants_tensors(&self) -> bool {
        self.wants_any(Field::is_of_bonds)
    }

    fn wants_any(&self, is_wanted: impl Fn(Field) -> bool) -> bool {
        let drawn = self.pictures.iter().map(|picture| picture.field);
        let extremes = self.extremes.iter().map(|(field, _)| *field);
        let profiles = self.profiles.iter().map(|profile| profile.field);
        self.names
            .iter()
            .copied()
            .chain(drawn)
            .chain(extremes)
            .chain(profiles)
            .any(is_wanted)
    }
}

/// Reads a field without its component.
fn whole_field(item: &Item<'_>, scope: Variables) -> Option<Field> {
    field(item, scope.dimension).map(|(field, _)| field)
}

/// Reads the component of the field under the key `field`.
fn field_component(
    table: &Table<'_>,
    (_, scope): (Option<&Field>, Variables),
) -> Option<Option<usize>> {
    let item = table.optional("field")?;
    field(&item, scope.dimension).map(|(_, component)| component)
}

/// Requires the component of a field to exist.
fn check_component(
    component: &usize,
    path: &KeyPath,
    (field, scope): (Option<&Field>, Variables),
    check: &mut Check,
) {
    let components = |field: &Field| field.components(scope.dimension.unwrap_or(3)).len();
    let known = field.map_or(0, components);
    let allowed = format!("allowed: a component below {known}");
    check.within(*component < known, path.key("field"), component, &allowed);
}

/// Returns the quantity of the values of a field.
fn unit_of(field: Option<&Field>) -> Quantity {
    field.map_or(Quantity::Number, |field| quantity(*field))
}

/// Reads a field by its name in files, with or without an axis of the body for a component.
fn field(item: &Item<'_>, dimension: Option<usize>) -> Option<FieldComponent> {
    item.choice("field", &field_names(dimension))
}
