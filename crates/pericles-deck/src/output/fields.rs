//! `[output] fields`: schedule, names and formats of field files.

use pericles::observe::{Field, Schedule};
use serde::{Deserialize, Serialize};

use super::{FieldComponent, is_never, schedule};
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::set::SetNames;

/// File formats of fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FieldFormat {
    /// One VTU file per output, and a PVD file that lists them.
    Vtu,
    /// One Exodus II file.
    Exodus,
    /// One VTKHDF file.
    Vtkhdf,
}

impl FieldFormat {
    /// Returns the default formats.
    pub(super) fn usual() -> Vec<Self> {
        vec![Self::Vtu]
    }
}

/// Blocks of Exodus files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FieldBlocks {
    /// Element groups of a mesh, or blocks of listed points.
    #[default]
    Groups,
    /// Materials of the points.
    Materials,
}

/// Whether the field files of a body on a grid or of a mesh hold cells, with cell data, or points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(from = "CellForm", into = "CellForm")]
pub enum CellChoice {
    /// Cells for bodies on a grid of at most [`CellChoice::MOST_POINTS`] points.
    #[default]
    Auto,
    /// Cells.
    Always,
    /// Points.
    Never,
}

impl CellChoice {
    /// Cells of more points are written only if asked for: their nodes double the size of a file of few fields.
    pub const MOST_POINTS: usize = 1_000_000;

    const AUTO: &str = "auto";
}

/// The serialised form of a [`CellChoice`]: as in decks.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum CellForm {
    Given(bool),
    Word(String),
}

impl From<CellForm> for CellChoice {
    fn from(form: CellForm) -> Self {
        match form {
            CellForm::Given(true) => Self::Always,
            CellForm::Given(false) => Self::Never,
            CellForm::Word(_) => Self::Auto,
        }
    }
}

impl From<CellChoice> for CellForm {
    fn from(choice: CellChoice) -> Self {
        match choice {
            CellChoice::Auto => Self::Word(CellChoice::AUTO.into()),
            CellChoice::Always => Self::Given(true),
            CellChoice::Never => Self::Given(false),
        }
    }
}

/// `[output] cells`.
pub(super) fn cells(table: &Table<'_>) -> Option<CellChoice> {
    let Some(item) = table.optional("cells") else {
        table.record("cells", CellChoice::AUTO);
        return Some(CellChoice::Auto);
    };
    if item.is_keyword(CellChoice::AUTO) {
        return Some(CellChoice::Auto);
    }
    Some(match item.boolean()? {
        true => CellChoice::Always,
        false => CellChoice::Never,
    })
}

/// Numbers of points that do not change, as arrays of field files.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum PointNumber {
    /// The material of the point: 1 for the material of the body, 2 for the first of `[materials]` …
    Material,
    /// The piece of the point: 1 for `[body]`, 2 for the first of `[[body.piece]]` …
    Piece,
    /// 1 for the points of a set, 0 for others.
    Set(String),
}

impl PointNumber {
    const MATERIAL: &str = "Material_Id";
    const PIECE: &str = "Piece_Id";
    const SET: &str = "Set_";

    /// The number that a name stands for.
    fn named(name: &str) -> Option<Self> {
        match name.strip_prefix(Self::SET) {
            Some(set) => Some(Self::Set(set.into())),
            None if name == Self::PIECE => Some(Self::Piece),
            None => (name == Self::MATERIAL).then_some(Self::Material),
        }
    }

    /// Name of the array.
    pub fn name(&self) -> String {
        match self {
            Self::Material => Self::MATERIAL.into(),
            Self::Piece => Self::PIECE.into(),
            Self::Set(set) => format!("{}{set}", Self::SET),
        }
    }
}

impl TryFrom<String> for PointNumber {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        Self::named(&name).ok_or_else(|| format!("unknown array {name}"))
    }
}

impl From<PointNumber> for String {
    fn from(number: PointNumber) -> Self {
        number.name()
    }
}

/// The arrays of field files.
#[derive(Default)]
pub(super) struct Names {
    pub(super) fields: Vec<Field>,
    pub(super) numbers: Vec<PointNumber>,
}

/// `[output.fields] names`.
fn names(item: &Item<'_>, dimension: Option<usize>, sets: &SetNames) -> Option<Names> {
    let one = |item: &Item<'_>| -> Option<Name> {
        if let Some(number) = item.word().and_then(PointNumber::named) {
            if let PointNumber::Set(set) = &number {
                sets.check(item, set)?;
            }
            item.text();
            return Some(Name::Number(number));
        }
        let names = field_names(dimension);
        let is_part = |word: &str| {
            let mut parts = names
                .iter()
                .filter(|(_, (_, component))| component.is_some());
            parts.any(|(name, _)| name == word)
        };
        if item.word().is_some_and(is_part) {
            item.out_of_range("whole fields: components are part of them");
            return None;
        }
        let whole = names
            .iter()
            .filter(|(_, (_, component))| component.is_none());
        let fields = whole.map(|(word, (field, _))| (word.as_str(), Some(*field)));
        let numbers = [PointNumber::MATERIAL, PointNumber::PIECE, "Set_<name>"];
        let numbers = numbers.map(|name| (name, None));
        let words: Vec<(&str, Option<Field>)> = fields.chain(numbers).collect();
        match item.choice("field", &words)? {
            Some(field) => Some(Name::Field(field)),
            None => {
                item.out_of_range("\"Set_\" followed by the name of a set, such as \"Set_top\"");
                None
            }
        }
    };
    let mut names = Names::default();
    for name in super::each_once(item, one)? {
        match name {
            Name::Field(field) => names.fields.push(field),
            Name::Number(number) => names.numbers.push(number),
        }
    }
    Some(names)
}

#[derive(PartialEq)]
enum Name {
    Field(Field),
    Number(PointNumber),
}

/// `[output] fields`.
pub(super) struct Fields {
    pub(super) schedule: Schedule,
    pub(super) names: Names,
    pub(super) formats: Vec<FieldFormat>,
    pub(super) mesh_cells: bool,
    pub(super) blocks: FieldBlocks,
}

/// Reads `[output] fields`.
pub(super) fn fields(
    table: &Table<'_>,
    dimension: Option<usize>,
    usual: Vec<Field>,
    mesh: bool,
    sets: &SetNames,
) -> Option<Fields> {
    let usual = Names {
        fields: usual,
        numbers: Vec::new(),
    };
    if is_never(table, "fields") {
        return Some(Fields {
            schedule: Schedule::Never,
            names: usual,
            formats: FieldFormat::usual(),
            mesh_cells: false,
            blocks: FieldBlocks::Groups,
        });
    }
    let table = table.table_or_empty("fields")?;
    let schedule = schedule(&table, Schedule::Count(20));
    let names = match table.optional("names") {
        None => Some(usual),
        Some(item) => names(&item, dimension, sets),
    };
    let formats = formats(&table);
    let mesh_cells = if mesh {
        table.or("cells", false, |item| item.boolean())
    } else {
        table.forbid("cells", "it requires shape = \"mesh\"");
        Some(false)
    };
    let blocks = table.choice_or_first(
        "blocks",
        "kind of blocks",
        &[
            ("groups", FieldBlocks::Groups),
            ("materials", FieldBlocks::Materials),
        ],
    );
    table.finish();
    Some(Fields {
        schedule: schedule?,
        names: names?,
        formats: formats?,
        mesh_cells: mesh_cells?,
        blocks: blocks?,
    })
}

/// Reads a format or a list of formats.
fn formats(table: &Table<'_>) -> Option<Vec<FieldFormat>> {
    const WORDS: [(&str, FieldFormat); 3] = [
        ("vtu", FieldFormat::Vtu),
        ("exodus", FieldFormat::Exodus),
        ("vtkhdf", FieldFormat::Vtkhdf),
    ];
    let Some(item) = table.optional("format") else {
        table.record("format", WORDS[0].0);
        return Some(FieldFormat::usual());
    };
    if !item.is_list() {
        return Some(vec![item.choice("format", &WORDS)?]);
    }
    let items = item.list("a list of formats")?;
    if items.is_empty() {
        item.wrong_length("at least one format; fields = \"never\" disables field files");
        return None;
    }
    let mut formats = Vec::new();
    for item in &items {
        let format = item.choice("format", &WORDS)?;
        if formats.contains(&format) {
            item.out_of_range("each format once");
            return None;
        }
        formats.push(format);
    }
    Some(formats)
}

/// Returns the names of fields and of their components.
pub(super) fn field_names(dimension: Option<usize>) -> Vec<(String, FieldComponent)> {
    let whole = Field::ALL.iter().map(|&field| (field, None));
    let dimension = dimension.unwrap_or(3);
    let parts = Field::ALL.iter().flat_map(|&field| {
        let components = 0..field.components(dimension).len();
        components.map(move |c| (field, Some(c)))
    });
    let named = whole.chain(parts).map(|(field, component)| {
        let name = match component {
            Some(c) => format!("{}_{}", field.name(), field.components(dimension)[c]),
            None => field.name().to_owned(),
        };
        (name, (field, component))
    });
    named.collect()
}

/// Quantity of the values of a field.
pub(super) fn quantity(field: Field) -> Quantity {
    match field {
        Field::Displacement | Field::Radius => Quantity::Length,
        Field::Velocity => Quantity::Velocity,
        Field::ForceDensity | Field::ExternalForce | Field::Reaction | Field::ContactForce => {
            Quantity::ForceDensity
        }
        Field::Stress
        | Field::EquivalentStress
        | Field::VonMisesStress
        | Field::PrincipalStress => Quantity::Traction,
        Field::Damage
        | Field::Strain
        | Field::Dilatation
        | Field::PlasticStrain
        | Field::YieldFlag
        | Field::PointId
        | Field::FragmentId => Quantity::Number,
        Field::StrainEnergyDensity | Field::KineticEnergyDensity => Quantity::EnergyDensity,
        Field::Volume => Quantity::Number,
        Field::Temperature => Quantity::Temperature,
        Field::HeatFlux => Quantity::HeatFlux,
    }
}
