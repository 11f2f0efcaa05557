//! `[output]` and `[checkpoint]`: output files and their schedules.

mod derived;
mod fields;
mod picture;
mod profile;
mod schedule;

pub use derived::DerivedQuantity;
pub use fields::{FieldBlocks, FieldFormat, FieldNames, FieldOutput, PointNumber};
pub use picture::{Picture, PictureColours, PictureFormat, PictureLook};
pub use profile::Profile;

use pericles::observe::{Field, FieldNeed, Schedule};
use pericles_deck_derive::{DeckKeys, DeckTable, DeckWords};
use serde::{Deserialize, Serialize};

use self::fields::{field_names, quantity};
use crate::component::Variables;
use crate::declaration::{Check, Fallback};
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::set::SetNames;

/// Output files and their schedules: `interval` (simulated time), `every` (steps) or `count` (number over the run), or
/// "never".
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = OutputScope<'s>)]
pub struct Output {
    /// Field files for ParaView and other viewers.
    #[deck(or_empty)]
    pub fields: FieldOutput,
    /// Whether VTU files contain the cells of the body with cell data (lines, quadrilaterals or hexahedra; Displacement is
    /// also written at the nodes, as the mean of the adjacent cells) or its points with point data. `auto` (default):
    /// cells for bodies on a grid of up to 1e6 points, otherwise points; `true`: cells for larger bodies as well, and the
    /// elements of a mesh; `false`: points.
    #[serde(default)]
    #[deck(none = "auto", default)]
    pub cells: Option<bool>,
    /// Rows of history.csv: energies, probes and reactions.
    #[deck(or_empty, scope = scope.variables())]
    pub history: HistoryOutput,
    /// Rows of the table of crack tips. Default: the schedule of the history.
    #[deck(or_empty, scope = usual_rows(history))]
    pub cracks: CrackOutput,
    /// Rows of the table of fragments, the sets of points connected by intact bonds. Default: "never", because each row
    /// needs a pass over all bonds.
    #[deck(default = FragmentOutput::NONE)]
    pub fragments: FragmentOutput,
    /// Precision of numbers in field files: 64 bits (`double`) or 32 bits (`single`).
    #[deck(default)]
    pub precision: Precision,
    /// Adds an upper bound of kinetic plus elastic energy under the loads, and the margin to it, to history.csv. The value
    /// is the time scale τ of the bound; the time of interest is best. Not with moving supports. Default: no bound.
    ///
    /// In s.
    #[serde(default)]
    #[deck(
        quantity = Time,
        range = POSITIVE,
        forbid_if(scope.driven, "the bound does not include the work of moving supports")
    )]
    pub energy_bound: Option<f64>,
    /// Pictures.
    #[serde(default, rename = "picture")]
    #[deck(key = "picture", scope = scope.variables())]
    pub pictures: Vec<Picture>,
    /// Fields along straight lines at the end of the run.
    #[serde(default, rename = "profile", skip_serializing_if = "Vec::is_empty")]
    #[deck(key = "profile", scope = scope.variables())]
    pub profiles: Vec<Profile>,
    /// Quantities derived from columns of the tables.
    #[serde(default, rename = "quantity", skip_serializing_if = "Vec::is_empty")]
    #[deck(key = "quantity")]
    pub quantities: Vec<DerivedQuantity>,
}

impl Default for Output {
    /// The output of a deck without `[output]`.
    fn default() -> Self {
        Self {
            fields: FieldOutput {
                schedule: Schedule::Count(20),
                ..FieldOutput::none(Field::USUAL.to_vec())
            },
            cells: None,
            history: HistoryOutput {
                schedule: usual_rows(None),
                extremes: Vec::new(),
            },
            cracks: CrackOutput::usual(usual_rows(None)),
            fragments: FragmentOutput::NONE,
            precision: Precision::default(),
            energy_bound: None,
            pictures: Vec::new(),
            profiles: Vec::new(),
            quantities: Vec::new(),
        }
    }
}

/// Scope of `[output]`.
#[derive(Clone, Copy)]
pub(crate) struct OutputScope<'s> {
    /// Dimension of the body; none if another error makes it unknown.
    pub(crate) dimension: Option<usize>,
    /// Whether supports move.
    pub(crate) driven: bool,
    /// Whether the body is a 2-manifold, whose field files contain the kinetic energy density by default.
    pub(crate) surface: bool,
    /// Whether the body is a mesh, which has cells.
    pub(crate) mesh: bool,
    pub(crate) sets: &'s SetNames,
}

impl OutputScope<'_> {
    /// Returns the scope of expressions of position and time.
    fn variables(self) -> Variables {
        Variables {
            dimension: self.dimension,
            time: true,
        }
    }
}

/// Returns the default schedule of rows: the schedule of the history.
fn usual_rows(history: Option<&HistoryOutput>) -> Schedule {
    history.map_or(Schedule::Count(200), |history| history.schedule)
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

impl<S> Fallback<S> for FragmentOutput {
    fn missing(self, _: &Table<'_>, _: &'static str, _: S) -> Option<Self> {
        Some(self)
    }
}

impl FragmentOutput {
    /// No table.
    pub const NONE: Self = Self {
        schedule: Schedule::Never,
        smallest: 1e-3,
    };
}

/// Rows of history.csv: energies, probes and reactions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = Variables, word_for(NEVER, Self::NONE))]
pub struct HistoryOutput {
    /// Schedule of the rows.
    #[serde(with = "crate::form")]
    #[deck(flatten, scope = usual_rows(None))]
    pub schedule: Schedule,
    /// Fields or components, such as "Damage" or "Velocity_y", whose minimum and maximum over all points become columns
    /// `min_…` and `max_…` of history.csv. Vectors and tensors without a component enter by their norm.
    #[serde(default, with = "crate::form")]
    #[deck(with = extremes, check = check_extremes)]
    pub extremes: Vec<(Field, Option<usize>)>,
}

impl HistoryOutput {
    /// No history.
    const NONE: Self = Self {
        schedule: Schedule::Never,
        extremes: Vec::new(),
    };
}

/// Precision of numbers in field files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "snake_case")]
#[deck(what = "precision")]
pub enum Precision {
    /// 64 bits.
    #[default]
    Double,
    /// 32 bits.
    Single,
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

/// The word for no output.
const NEVER: &str = "never";

/// A field, and optionally one of its components.
type FieldComponent = (Field, Option<usize>);

fn extremes(item: &Item<'_>, scope: Variables) -> Option<Vec<FieldComponent>> {
    each_once(item, |item| field(item, scope.dimension))
}

fn check_extremes(
    extremes: &[FieldComponent],
    path: &KeyPath,
    scope: Variables,
    check: &mut Check,
) {
    for (field, component) in extremes {
        if let Some(component) = component {
            let path = path.key("extremes");
            require_component(*component, path, Some(field), scope, check);
        }
    }
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
    /// Returns the default table for the schedule of the history.
    pub fn usual(history: Schedule) -> Self {
        Self {
            schedule: history,
            ..Self::NONE
        }
    }

    /// The damage on a straight crack is close to 1/2; this value detects cracks without their surroundings.
    const THRESHOLD: f64 = 0.35;

    /// No table.
    const NONE: Self = Self {
        schedule: Schedule::Never,
        threshold: Self::THRESHOLD,
    };
}

impl Output {
    /// Returns whether field files may contain cells.
    pub fn writes_cells(&self) -> bool {
        self.fields.schedule != Schedule::Never
            && self.cells != Some(false)
            && self.fields.formats.contains(&FieldFormat::Vtu)
    }

    /// Returns the requested fields that need a property of the body, each once.
    pub fn needing(&self, need: FieldNeed) -> Vec<Field> {
        let drawn = self.pictures.iter().map(|picture| picture.field);
        let extremes = self.history.extremes.iter().map(|(field, _)| *field);
        let profiles = self.profiles.iter().map(|profile| profile.field);
        let names = self.fields.names.fields.iter().copied();
        let all: Vec<Field> = names.chain(drawn).chain(extremes).chain(profiles).collect();
        let mut needing = Field::ALL.to_vec();
        needing.retain(|field| field.need() == Some(need) && all.contains(field));
        needing
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
    require_component(*component, path.key("field"), field, scope, check);
}

fn require_component(
    component: usize,
    path: KeyPath,
    field: Option<&Field>,
    scope: Variables,
    check: &mut Check,
) {
    let components = |field: &Field| field.components(scope.dimension.unwrap_or(3)).len();
    let known = field.map_or(0, components);
    let allowed = format!("allowed: a component below {known}");
    check.within(component < known, path, component, &allowed);
}

/// Returns the quantity of the values of a field.
fn unit_of(field: Option<&Field>) -> Quantity {
    field.map_or(Quantity::Number, |field| quantity(*field))
}

/// Reads a field by its name in files, with or without an axis of the body for a component.
fn field(item: &Item<'_>, dimension: Option<usize>) -> Option<FieldComponent> {
    item.choice("field", &field_names(dimension))
}
