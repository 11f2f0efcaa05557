//! `[output]` and `[checkpoint]`: what is written, and when.

mod fields;

pub use fields::{FieldBlocks, FieldFormat};

use pericles::observe::{Field, Schedule};
use pericles::space::Point;
use serde::{Deserialize, Serialize};

use self::fields::{Fields, fields};
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::vocabulary::{CHECKPOINTS, SCHEDULES};

/// What a run writes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// When field files are written.
    #[serde(with = "crate::form")]
    pub fields: Schedule,
    /// Which fields.
    #[serde(with = "crate::form")]
    pub names: Vec<Field>,
    /// In which formats fields are written.
    #[serde(default = "FieldFormat::usual")]
    pub formats: Vec<FieldFormat>,
    /// Whether fields are also written on the cells of a mesh.
    #[serde(default)]
    pub cells: bool,
    /// What the blocks of Exodus files are.
    #[serde(default)]
    pub blocks: FieldBlocks,
    /// When a row is added to the tables of energies, probes and reactions.
    #[serde(with = "crate::form")]
    pub history: Schedule,
    /// Fields, or components of them, whose least and greatest value are columns of the history.
    #[serde(default, with = "crate::form")]
    pub extremes: Vec<(Field, Option<usize>)>,
    /// The table of crack tips, if it is given; see [`Output::cracks`].
    #[serde(default)]
    pub cracks: Option<CrackOutput>,
    /// The table of fragments.
    pub fragments: FragmentOutput,
    /// Precision of numbers in field files.
    pub precision: Precision,
    /// Rate ν of the bound of the energy in the history, 1/s; none if it is not wanted.
    #[serde(default)]
    pub energy_bound: Option<f64>,
    /// Pictures.
    #[serde(default, rename = "picture")]
    pub pictures: Vec<Picture>,
}

impl Default for Output {
    /// What a deck without `[output]` writes.
    fn default() -> Self {
        Self {
            fields: Schedule::Count(20),
            names: Field::USUAL.to_vec(),
            formats: FieldFormat::usual(),
            cells: false,
            blocks: FieldBlocks::Groups,
            history: Schedule::Count(200),
            extremes: Vec::new(),
            cracks: None,
            fragments: FragmentOutput::NONE,
            precision: Precision::Double,
            energy_bound: None,
            pictures: Vec::new(),
        }
    }
}

/// The table of crack tips.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrackOutput {
    /// When a row is added.
    #[serde(with = "crate::form")]
    pub schedule: Schedule,
    /// The damage beyond which a point counts as cracked.
    pub threshold: f64,
}

/// The table of fragments.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FragmentOutput {
    /// When a row is added.
    #[serde(with = "crate::form")]
    pub schedule: Schedule,
    /// The share of the body's mass from which on a piece counts as a fragment.
    pub smallest: f64,
}

impl FragmentOutput {
    /// No table.
    pub const NONE: Self = Self {
        schedule: Schedule::Never,
        smallest: 1e-3,
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

/// A picture of a field on the points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Picture {
    /// The field.
    #[serde(with = "crate::form")]
    pub field: Field,
    /// Which component of a vector; its magnitude if none.
    #[serde(default)]
    pub component: Option<usize>,
    /// Factor of the displacement of the points.
    pub scale: f64,
    /// Values at the ends of the colour bar; those of the field if none.
    #[serde(default)]
    pub range: Option<[f64; 2]>,
    /// The direction from which a body in space is seen; if none, from the front right and above.
    #[serde(default)]
    pub view: Option<Point>,
    /// Whether all of them are put into an animation at the end.
    pub animation: bool,
    /// When it is drawn.
    #[serde(with = "crate::form")]
    pub schedule: Schedule,
}

/// When a checkpoint is written.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Checkpoint {
    /// Every so much time on the clock, s.
    Wall(f64),
    /// Every so many steps.
    Every(u64),
    /// Every so much simulated time, s.
    Interval(f64),
}

impl Default for Checkpoint {
    fn default() -> Self {
        Self::Wall(600.0)
    }
}

/// `driven`: whether supports move; `surface`: whether the body is a surface, whose field files hold the kinetic energy density by default;
/// `mesh`: whether it is a mesh, which has cells.
pub(crate) fn read(
    table: Table<'_>,
    dimension: Option<usize>,
    driven: bool,
    surface: bool,
    mesh: bool,
) -> Option<Output> {
    let mut usual = Field::USUAL.to_vec();
    if surface {
        usual.push(Field::KineticEnergyDensity);
    }
    let fields = fields(&table, dimension, usual, mesh);
    let (history, extremes) = history(&table, dimension);
    let cracks = cracks(&table, history);
    let fragments = fragments(&table);
    let precision = table.choice_or_first(
        "precision",
        "precision",
        &[("double", Precision::Double), ("single", Precision::Single)],
    );
    if driven {
        table.forbid(
            "energy_bound",
            "supports that move do work which the bound does not know",
        );
    }
    let energy_bound = table.maybe("energy_bound", |item| {
        item.positive(Quantity::Time).map(f64::recip)
    });
    let pictures: Vec<Option<Picture>> = table
        .tables("picture")
        .into_iter()
        .map(|table| picture(table, dimension))
        .collect();
    table.finish();
    let Fields {
        schedule,
        names,
        formats,
        cells,
        blocks,
    } = fields?;
    Some(Output {
        fields: schedule,
        names,
        formats,
        cells,
        blocks,
        history: history?,
        extremes: extremes?,
        cracks: cracks?,
        fragments: fragments?,
        precision: precision?,
        energy_bound: energy_bound?,
        pictures: pictures.into_iter().collect::<Option<_>>()?,
    })
}

pub(crate) fn checkpoint(table: Table<'_>) -> Option<Checkpoint> {
    let checkpoint = match table.at_most_one(CHECKPOINTS) {
        None => None,
        Some(None) => {
            let Checkpoint::Wall(seconds) = Checkpoint::default() else {
                return None;
            };
            table.record("wall", seconds);
            Some(Checkpoint::Wall(seconds))
        }
        Some(Some(("wall", item))) => item.positive(Quantity::Time).map(Checkpoint::Wall),
        Some(Some(("every", item))) => item.count().map(Checkpoint::Every),
        Some(Some((_, item))) => item.positive(Quantity::Time).map(Checkpoint::Interval),
    };
    table.finish();
    checkpoint
}

/// The word for a schedule that is never due.
const NEVER: &str = "never";

/// A field, and one of its components.
type FieldComponent = (Field, Option<usize>);

/// When rows are added to the history, and the fields whose extremes it holds.
fn history(
    table: &Table<'_>,
    dimension: Option<usize>,
) -> (Option<Schedule>, Option<Vec<FieldComponent>>) {
    if is_never(table, "history") {
        return (Some(Schedule::Never), Some(Vec::new()));
    }
    let Some(table) = table.table_or_empty("history") else {
        return (None, None);
    };
    let schedule = schedule(&table, Schedule::Count(200));
    let extremes = match table.optional("extremes") {
        None => Some(Vec::new()),
        Some(item) => each_once(&item, |item| field(item, dimension)),
    };
    table.finish();
    (schedule, extremes)
}

fn names(item: &Item<'_>, dimension: Option<usize>) -> Option<Vec<Field>> {
    let one = |item: &Item<'_>| match field(item, dimension)? {
        (field, None) => Some(field),
        (_, Some(_)) => {
            item.out_of_range("whole fields: components are part of them");
            None
        }
    };
    each_once(item, one)
}

/// A list of fields, none of them twice.
fn each_once<T: PartialEq>(
    item: &Item<'_>,
    one: impl Fn(&Item<'_>) -> Option<T>,
) -> Option<Vec<T>> {
    let items = item.list("a list of names of fields")?;
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

fn is_never(table: &Table<'_>, key: &'static str) -> bool {
    table
        .optional(key)
        .is_some_and(|item| item.is_keyword(NEVER))
}

fn schedule(table: &Table<'_>, default: Schedule) -> Option<Schedule> {
    match table.at_most_one(SCHEDULES)? {
        None => {
            match default {
                Schedule::Never => {}
                Schedule::Interval(interval) => table.record("interval", interval),
                Schedule::Every(steps) => table.record("every", steps),
                Schedule::Count(count) => table.record("count", count),
            }
            Some(default)
        }
        Some(("interval", item)) => item.positive(Quantity::Time).map(Schedule::Interval),
        Some(("every", item)) => item.count().map(Schedule::Every),
        Some((_, item)) => item.count().map(Schedule::Count),
    }
}

impl CrackOutput {
    /// Damage of a point on a straight crack is close to a half; this finds cracks without their surroundings.
    const THRESHOLD: f64 = 0.35;
}

/// By default as often as the history.
fn cracks(table: &Table<'_>, history: Option<Schedule>) -> Option<Option<CrackOutput>> {
    const THRESHOLD: f64 = CrackOutput::THRESHOLD;
    if is_never(table, "cracks") {
        return Some(Some(CrackOutput {
            schedule: Schedule::Never,
            threshold: THRESHOLD,
        }));
    }
    let given = table.has("cracks");
    let table = table.table_or_empty("cracks")?;
    let schedule = schedule(&table, history.unwrap_or(Schedule::Count(200)));
    let threshold = table.or("threshold", THRESHOLD, |item| {
        item.within(
            Quantity::Number,
            "a damage between 0 and 1, both excluded",
            |threshold| threshold > 0.0 && threshold < 1.0,
        )
    });
    table.finish();
    let cracks = CrackOutput {
        schedule: schedule?,
        threshold: threshold?,
    };
    Some(given.then_some(cracks))
}

/// Only where asked for: they take a pass over all bonds.
fn fragments(table: &Table<'_>) -> Option<FragmentOutput> {
    const SMALLEST: f64 = FragmentOutput::NONE.smallest;
    let wanted = table.optional("fragments").is_some();
    if !wanted || is_never(table, "fragments") {
        return Some(FragmentOutput::NONE);
    }
    let table = table.table_or_empty("fragments")?;
    let schedule = schedule(&table, Schedule::Count(50));
    let smallest = table.or("smallest", SMALLEST, |item| {
        item.within(
            Quantity::Number,
            "a share of the body's mass from 0 on, below 1",
            |share| (0.0..1.0).contains(&share),
        )
    });
    table.finish();
    Some(FragmentOutput {
        schedule: schedule?,
        smallest: smallest?,
    })
}

fn picture(table: Table<'_>, dimension: Option<usize>) -> Option<Picture> {
    let field = table
        .required("field")
        .and_then(|item| field(&item, dimension));
    let scale = table.or("scale", 1.0, |item| {
        item.within(Quantity::Number, "a number of at least 0", |scale| {
            scale >= 0.0
        })
    });
    let quantity = field.map_or(Quantity::Number, |(field, _)| quantity(field));
    let range = table.maybe("range", |item| range(&item, quantity));
    let view = if dimension == Some(3) {
        table.maybe("view", |item| {
            let view = item.vector(Quantity::Number, Some(3))?;
            if view == [0.0; 3] {
                item.out_of_range("a direction that is not zero");
                return None;
            }
            Some(view)
        })
    } else {
        if dimension.is_some() {
            table.forbid(
                "view",
                "only bodies in three dimensions are seen from somewhere",
            );
        }
        Some(None)
    };
    let animation = table.or("animation", false, |item| item.boolean());
    let schedule = schedule(&table, Schedule::Count(4));
    table.finish();
    let (field, component) = field?;
    Some(Picture {
        field,
        component,
        scale: scale?,
        range: range?,
        view: view?,
        animation: animation?,
        schedule: schedule?,
    })
}

fn quantity(field: Field) -> Quantity {
    match field {
        Field::Displacement => Quantity::Length,
        Field::Velocity => Quantity::Velocity,
        Field::ForceDensity | Field::ExternalForce | Field::Reaction => Quantity::ForceDensity,
        Field::Stress | Field::EquivalentStress => Quantity::Traction,
        Field::Damage
        | Field::Strain
        | Field::Dilatation
        | Field::PlasticStrain
        | Field::YieldFlag => Quantity::Number,
        Field::StrainEnergyDensity | Field::KineticEnergyDensity => Quantity::EnergyDensity,
        Field::Volume => Quantity::Number,
        Field::Temperature => Quantity::Temperature,
    }
}

impl Output {
    /// The table of crack tips: as it is given, else as often as the history.
    pub fn cracks(&self) -> CrackOutput {
        self.cracks.unwrap_or(CrackOutput {
            schedule: self.history,
            threshold: CrackOutput::THRESHOLD,
        })
    }

    /// Whether a field is wanted.
    pub fn wants(&self, wanted: Field) -> bool {
        self.wants_any(|field| field == wanted)
    }

    /// Whether stress or strain is wanted, which only listed bonds give.
    pub fn wants_tensors(&self) -> bool {
        self.wants_any(Field::is_of_bonds)
    }

    fn wants_any(&self, is_wanted: impl Fn(Field) -> bool) -> bool {
        let drawn = self.pictures.iter().map(|picture| picture.field);
        let extremes = self.extremes.iter().map(|(field, _)| *field);
        self.names
            .iter()
            .copied()
            .chain(drawn)
            .chain(extremes)
            .any(is_wanted)
    }
}

/// A field by its name in files; vectors and tensors by magnitude or with the name of an axis the body has.
fn field(item: &Item<'_>, dimension: Option<usize>) -> Option<(Field, Option<usize>)> {
    let whole = Field::ALL.iter().map(|&field| (field, None));
    let dimension = dimension.unwrap_or(3);
    let parts = Field::ALL.iter().flat_map(|&field| {
        let components = 0..field.components(dimension).len();
        components.map(move |c| (field, Some(c)))
    });
    let named: Vec<(String, (Field, Option<usize>))> = whole
        .chain(parts)
        .map(|(field, component)| {
            let name = match component {
                Some(c) => format!("{}_{}", field.name(), field.components(dimension)[c]),
                None => field.name().to_owned(),
            };
            (name, (field, component))
        })
        .collect();
    item.choice("field", &named)
}

fn range(item: &Item<'_>, quantity: Quantity) -> Option<[f64; 2]> {
    let ends = item.exactly(2, "two numbers [lowest, highest]")?;
    let (low, high) = (ends[0].quantity(quantity), ends[1].quantity(quantity));
    let (low, high) = (low?, high?);
    if low < high {
        return Some([low, high]);
    }
    item.out_of_range("two numbers [lowest, highest], the first smaller");
    None
}
