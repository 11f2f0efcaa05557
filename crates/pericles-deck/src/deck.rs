//! The deck as a whole.

use std::path::{Path as FilePath, PathBuf};

use serde_json::Value as Json;

use crate::body::{self, Body, SurfaceRead, SurfaceShape};
use crate::boundary::{self, BoundaryCondition};
use crate::conditions::{self, Initial, Load, Prescribe, Probe};
use crate::crack::{self, PreCrack};
use crate::document::{self, Node};
use crate::error::DeckError;
use crate::exact::{self, Exact};
use crate::material::{self, Material};
use crate::output::{self, Checkpoint, Output};
use crate::overrides;
use crate::reader::{Ledger, Record, Survey, Table};
use crate::region::Frame;
use crate::set::{self, NamedSet, SetNames};
use crate::source::Sources;
use crate::surface::{self, SurfaceDeck};
use crate::time::{self, Time};

/// Everything a deck says, in SI units.
#[derive(Debug, Clone)]
pub struct Deck {
    /// A title for people.
    pub title: Option<String>,
    /// `[body]`
    pub body: Body,
    /// `[material]`
    pub material: Material,
    /// A surface with its material, if the body is one; `body` and `material` are then those of a unit cube that is not used.
    pub surface: Option<SurfaceDeck>,
    /// `[sets]`, without the set "all" of all points.
    pub sets: Vec<NamedSet>,
    /// `[[crack]]`
    pub cracks: Vec<PreCrack>,
    /// `[[initial]]`
    pub initial: Vec<Initial>,
    /// `[[prescribe]]`
    pub prescribe: Vec<Prescribe>,
    /// `[[load]]`
    pub loads: Vec<Load>,
    /// `[[boundary]]`
    pub boundaries: Vec<BoundaryCondition>,
    /// `[[probe]]`
    pub probes: Vec<Probe>,
    /// `[exact]`
    pub exact: Option<Exact>,
    /// `[time]`
    pub time: Time,
    /// `[output]`
    pub output: Output,
    /// `[checkpoint]`
    pub checkpoint: Checkpoint,
    pub(crate) record: Record,
}

impl Deck {
    /// Adds what the reader asks of a deck to a survey.
    pub(crate) fn survey(
        text: &str,
        overrides: &[String],
        survey: Survey,
    ) -> Result<Survey, DeckError> {
        let (root, sources) = document(text, "specimen", overrides)?;
        let (_, survey) = Self::read_with(Ledger::surveyed(sources, survey), &root)?;
        Ok(survey)
    }

    /// Reads all tables of a document.
    pub(crate) fn read_with(ledger: Ledger, root: &Node) -> Result<(Self, Survey), DeckError> {
        let deck = ledger.root(root).and_then(Self::from_tables);
        let closed = ledger.close();
        match deck {
            Some(deck) if closed.problems.is_empty() => {
                let record = closed.record;
                Ok((Self { record, ..deck }, closed.survey))
            }
            _ => Err(DeckError::refused(closed.problems)),
        }
    }

    /// The deck as it was read: every key with its value in SI units, and what was left out with its default.
    pub fn to_json(&self) -> &Json {
        &self.record.json
    }

    /// Whether the deck, or an override, gives the value of a key such as `material.modulus`, instead of leaving it to its default.
    pub fn gives(&self, key: &str) -> bool {
        self.record.is_given(&key.into())
    }

    /// The text it was read from, without overrides.
    pub fn source(&self) -> &str {
        self.record.sources.text(0)
    }

    /// The files that the deck names, as it names them.
    pub fn files(&self) -> Vec<&FilePath> {
        let listed = self.body.listed.iter().map(|listed| &listed.path);
        let surface = self
            .surface
            .iter()
            .filter_map(|surface| match &surface.shape {
                SurfaceShape::File { path, .. } => Some(path),
                _ => None,
            });
        let initial = self
            .initial
            .iter()
            .filter_map(|initial| initial.file.as_ref());
        let all = listed.chain(surface).chain(initial);
        all.map(PathBuf::as_path).collect()
    }

    /// Where a file is that the deck names: a relative path starts at the deck's folder.
    pub fn beside(&self, path: &FilePath) -> PathBuf {
        let folder = FilePath::new(self.record.sources.name()).parent();
        folder.unwrap_or(FilePath::new("")).join(path)
    }

    /// The overrides that were applied.
    pub fn overrides(&self) -> impl Iterator<Item = &str> {
        (1..self.record.sources.count()).map(|k| self.record.sources.text(k))
    }
}

impl Deck {
    /// Reads all tables before it gives up, so that all problems are found.
    fn from_tables(root: Table<'_>) -> Option<Self> {
        let title = root.maybe("title", |item| item.text());
        let body = body::read(root.required("body").and_then(|item| item.table()));
        let frame = body.frame;
        let (sets, names) = set::read(root.table_or_empty("sets"), frame);
        let material = root.required("material").and_then(|item| item.table());
        let (material, surface) = match &body.surface {
            Some(read) => (
                Some(surface::no_bonds()),
                surface_of(&root, read, material, frame, &names).map(Some),
            ),
            None => {
                root.forbid(
                    "geodesics",
                    "only surfaces (shape = \"icosphere\", \"torus\" …) have distances along them",
                );
                let read = material.and_then(|table| material::read(table, &body, &names));
                (read, Some(None))
            }
        };
        let cracks = each(&root, "crack", |table| crack::read(table, frame));
        let initial = each(&root, "initial", |table| {
            conditions::initial(table, frame.dimension, &names)
        });
        let prescribe = each(&root, "prescribe", |table| {
            conditions::prescribe(table, frame.dimension, &names)
        });
        let loads = each(&root, "load", |table| {
            conditions::load(table, frame.dimension, &names)
        });
        let boundaries = each(&root, "boundary", boundary::read);
        let probes = conditions::probes(root.tables("probe"), frame.dimension, &names);
        let exact = root.maybe("exact", |item| {
            exact::read(item.table()?, frame.dimension, material.as_ref())
        });
        let time = root
            .required("time")
            .and_then(|item| time::read(item.table()?, &names));
        let output = root.table_or_empty("output").and_then(|table| {
            let driven = prescribe.iter().flatten().any(Prescribe::moves);
            output::read(table, frame.dimension, driven, body.surface.is_some())
        });
        let checkpoint = root
            .table_or_empty("checkpoint")
            .and_then(output::checkpoint);
        root.finish();
        Some(Self {
            title: title?,
            body: body.body?,
            material: material?,
            surface: surface?,
            sets: sets?,
            cracks: cracks?,
            initial: initial?,
            prescribe: prescribe?,
            loads: loads?,
            boundaries: boundaries?,
            probes: probes?,
            exact: exact?,
            time: time?,
            output: output?,
            checkpoint: checkpoint?,
            record: Record::default(),
        })
    }
}

/// The document of a deck with its overrides.
pub(crate) fn document(
    text: &str,
    file_name: &str,
    overrides: &[String],
) -> Result<(Node, Sources), DeckError> {
    let mut sources = Sources::new(file_name, text);
    let mut root = document::parse(&sources)?;
    for text in overrides {
        overrides::apply(&mut root, text, &mut sources)?;
    }
    Ok((root, sources))
}

/// What is said of a surface outside `[body]`.
fn surface_of(
    root: &Table<'_>,
    read: &SurfaceRead,
    material: Option<Table<'_>>,
    frame: Frame,
    names: &SetNames,
) -> Option<SurfaceDeck> {
    root.forbid("crack", "surfaces have no pre-cracks");
    let geodesics = root
        .table_or_empty("geodesics")
        .and_then(surface::geodesics);
    let (material, no_fail, inclusions) = surface::material(material?, frame.spacing, names)?;
    let (method, ball) = geodesics?;
    Some(SurfaceDeck {
        shape: read.shape.clone()?,
        areas: read.areas?,
        material,
        no_fail,
        inclusions,
        method,
        ball,
    })
}

fn each<'a, T>(
    root: &Table<'a>,
    key: &'static str,
    read: impl Fn(Table<'a>) -> Option<T>,
) -> Option<Vec<T>> {
    let read: Vec<Option<T>> = root.tables(key).into_iter().map(read).collect();
    read.into_iter().collect()
}
