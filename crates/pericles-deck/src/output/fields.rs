//! `[output] fields`: schedule, names and formats of field files.

use pericles::observe::{Field, Schedule};
use pericles_deck_derive::{DeckTable, DeckWords};
use serde::{Deserialize, Serialize};

use super::{FieldComponent, OutputScope};
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::words::Worded;

/// File formats of fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "snake_case")]
#[deck(what = "format")]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "snake_case")]
#[deck(what = "kind of blocks")]
pub enum FieldBlocks {
    /// Element groups of a mesh, or blocks of listed points.
    #[default]
    Groups,
    /// Materials of the points.
    Materials,
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
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FieldNames {
    /// Fields.
    #[serde(with = "crate::form")]
    pub fields: Vec<Field>,
    /// Integers of the points.
    #[serde(default)]
    pub numbers: Vec<PointNumber>,
}

impl From<Vec<Field>> for FieldNames {
    fn from(fields: Vec<Field>) -> Self {
        let numbers = Vec::new();
        Self { fields, numbers }
    }
}

/// Reads the names of the arrays.
fn names(table: &Table<'_>, scope: OutputScope<'_>) -> Option<FieldNames> {
    let Some(item) = table.optional("names") else {
        return Some(usual(scope).into());
    };
    let OutputScope {
        dimension, sets, ..
    } = scope;
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
    let mut names = FieldNames::default();
    for name in super::each_once(&item, one)? {
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

/// Field files for ParaView and other viewers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = OutputScope<'s>, word_for(super::NEVER, Self::none(usual(scope))))]
pub struct FieldOutput {
    /// Schedule of the files.
    #[serde(with = "crate::form")]
    #[deck(flatten, scope = Schedule::Count(20))]
    pub schedule: Schedule,
    /// Fields to write. Default: Displacement, Velocity, Force_Density, Damage and Strain_Energy_Density (2-manifolds: also
    /// Kinetic_Energy_Density). Stress and Strain exclude the convolution kernel. Dilatation needs a state-based or
    /// correspondence material, Plastic_Strain and Yield_Flag a `yield_stress`, Temperature the table `[thermal]`,
    /// Heat_Flux heat conduction. Equivalent_Stress and Von_Mises_Stress are the von Mises stress, of the in-plane
    /// components in 2D; Principal_Stress contains the eigenvalues of the stress in descending order. Integers: Point_Id
    /// (number of the point), Fragment_Id (number of the fragment), Active (1 for
    /// points that belong to the body, 0 for those that become active later), Material_Id (1: the body's material, 2: the first of
    /// `[materials]`, …), `Set_<name>` (1 in the set, 0 elsewhere). Radius is half the cell size. VTU files contain Stress and
    /// Strain as symmetric tensors and their components as scalars.
    #[deck(flatten, key = "names", with = names)]
    pub names: FieldNames,
    /// File format or list of formats. `vtu`: fields.pvd and one file per output, read by `pericles plot`, `diff` and
    /// `report`; `exodus`: one file fields.exo with blocks and sets; `vtkhdf`: one file fields.vtkhdf, for ParaView 5.12
    /// and later. All can be read during the run.
    #[serde(default = "FieldFormat::usual")]
    #[deck(flatten, key = "format", with = formats)]
    pub formats: Vec<FieldFormat>,
    /// Mesh: also write the fields on the mesh elements, cells.pvd.
    #[serde(default)]
    #[deck(default = false, forbid_if(!scope.mesh, "it requires shape = \"mesh\""))]
    pub cells: bool,
    /// Blocks of Exodus files. `groups`: element groups of a mesh (the first one for elements of several groups), or blocks
    /// of listed points; `materials`: one block per material.
    #[serde(default)]
    #[deck(default)]
    pub blocks: FieldBlocks,
}

/// Returns the fields that are written by default.
fn usual(scope: OutputScope<'_>) -> Vec<Field> {
    let further = scope.surface.then_some(Field::KineticEnergyDensity);
    Field::USUAL.into_iter().chain(further).collect()
}

impl FieldOutput {
    /// No files.
    pub(super) fn none(fields: Vec<Field>) -> Self {
        Self {
            schedule: Schedule::Never,
            names: fields.into(),
            formats: FieldFormat::usual(),
            cells: false,
            blocks: FieldBlocks::Groups,
        }
    }
}

/// Reads a format or a list of formats.
fn formats<S>(table: &Table<'_>, _: S) -> Option<Vec<FieldFormat>> {
    let words = FieldFormat::words();
    let Some(item) = table.optional("format") else {
        table.record("format", words[0].0);
        return Some(FieldFormat::usual());
    };
    if !item.is_list() {
        return Some(vec![item.choice("format", &words)?]);
    }
    let items = item.list("a list of formats")?;
    if items.is_empty() {
        item.wrong_length("at least one format; fields = \"never\" disables field files");
        return None;
    }
    let mut formats = Vec::new();
    for item in &items {
        let format = item.choice("format", &words)?;
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

/// Quantity of the values of a field; those without a unit in decks are numbers.
pub(super) fn quantity(field: Field) -> Quantity {
    match field.unit() {
        "m" => Quantity::Length,
        "m/s" => Quantity::Velocity,
        "N/m³" => Quantity::ForceDensity,
        "Pa" => Quantity::Traction,
        "J/m³" => Quantity::EnergyDensity,
        "K" => Quantity::Temperature,
        "W/m²" => Quantity::HeatFlux,
        _ => Quantity::Number,
    }
}
