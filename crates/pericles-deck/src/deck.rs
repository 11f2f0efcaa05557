//! The deck: text, model and the location of every value.

use std::path::{Path as FilePath, PathBuf};

use serde_json::Value as Json;

use crate::assign::{AssignScope, Assignable, Assignment};
use crate::body::{self, BodyRead, SurfaceRead};
use crate::conditions::{self, Constraint, Initial};
use crate::contact::Contact;
use crate::course::TimeHistory;
use crate::crack::CrackScope;
use crate::damping::Damping;
use crate::declaration::{DeckTable, DeckValue, declared};
use crate::document::{self, Node};
use crate::error::DeckError;
use crate::exact::{self, ExactScope};
use crate::fault::Fault;
use crate::finding::Finding;
use crate::inheritance::inherit;
use crate::interface::{self, MaterialInterface};
use crate::material::{self, Material, MaterialModel, Materials, NamedMaterial};
use crate::model::{Body, Model, Solid};
use crate::output::{Checkpoint, Output, OutputScope};
use crate::overrides;
use crate::processor::Processor;
use crate::reader::{Ledger, Record, Survey, Table};
use crate::region::Frame;
use crate::remark::{BuildError, Remark};
use crate::scope::Scope;
use crate::set::{self, SetNames};
use crate::source::Sources;
use crate::step;
use crate::subject::Subject;
use crate::surface::{Geodesics, SurfaceBody, SurfaceMaterial, SurfaceScope};
use crate::thermal::{Thermal, ThermalScope};
use crate::time::Time;

/// A deck: the model and the location of every value in the text.
#[derive(Debug, Clone)]
pub struct Deck {
    /// The model, as plain data.
    pub model: Model,
    record: Record,
    /// Names of the steps.
    pub(crate) steps: Vec<String>,
}

/// The document of a deck with its overrides.
pub(crate) struct Document {
    pub(crate) root: Node,
    pub(crate) sources: Sources,
    /// Names of the steps.
    pub(crate) steps: Vec<String>,
}

impl Deck {
    /// Reads a deck and adds the keys that the reader requests to a survey.
    pub(crate) fn survey(
        text: &str,
        overrides: &[String],
        survey: Survey,
    ) -> Result<Survey, DeckError> {
        let document = Document::of(text, "specimen", overrides)?;
        let ledger = Ledger::surveyed(document.sources, survey);
        let (_, survey) = Self::read_with(ledger, &document.root, &[])?;
        Ok(survey)
    }

    /// Reads all tables of a document; `sets` are the names of sets that the deck does not define.
    pub(crate) fn read_with(
        ledger: Ledger,
        root: &Node,
        sets: &[String],
    ) -> Result<(Self, Survey), DeckError> {
        let model = ledger.root(root).and_then(|root| model(root, sets));
        let closed = ledger.close();
        match model {
            Some(model) if closed.problems.is_empty() => {
                let deck = Self {
                    model,
                    record: closed.record,
                    steps: Vec::new(),
                };
                Ok((deck, closed.survey))
            }
            _ => Err(DeckError::rejected(closed.problems)),
        }
    }

    /// Returns all keys with their values in SI units, including defaults.
    pub fn to_json(&self) -> &Json {
        &self.record.json
    }

    /// Returns whether the deck or an override sets a key such as `material.modulus`.
    pub fn gives(&self, key: &str) -> bool {
        self.record.is_given(&key.into())
    }

    /// Returns the names of the steps; empty for a deck without `[[step]]`.
    pub fn steps(&self) -> &[String] {
        &self.steps
    }

    /// Returns the text, without overrides.
    pub fn source(&self) -> &str {
        self.record.sources.text(0)
    }

    /// Returns the folder of the deck, to which paths are relative; empty for the current folder.
    pub fn folder(&self) -> &FilePath {
        let folder = FilePath::new(self.record.sources.name()).parent();
        folder.unwrap_or(FilePath::new(""))
    }

    /// Resolves a path in the deck; a relative path starts at the deck's folder.
    pub fn beside(&self, path: &FilePath) -> PathBuf {
        self.folder().join(path)
    }

    /// Returns the overrides.
    pub fn overrides(&self) -> impl Iterator<Item = &str> {
        (1..self.record.sources.count()).map(|k| self.record.sources.text(k))
    }

    /// Adds the location in the text to a finding about the model.
    pub fn located<S: Subject>(&self, remark: Remark<S>) -> Finding<S> {
        let (keys, subject) = remark.into_parts();
        let place = self.record.place_of_any(&keys);
        Finding::new(subject, self.record.sources.locate(place))
    }

    /// Adds locations in the text to the errors of a model.
    pub fn rejection(&self, error: BuildError) -> DeckError {
        let problems = error.into_problems().into_iter();
        DeckError::rejected(problems.map(|problem| self.located(problem)).collect())
    }

    /// Rejects tuned coefficients that make the lattice unstable, unless `time.allow_unstable` is set.
    pub(crate) fn reject_unstable_table(&self) -> Result<(), DeckError> {
        let solid = self.model.body.solid();
        match solid.and_then(|solid| solid.material.tuned.as_ref()) {
            Some(table)
                if !table.assessment.stability.is_stable() && !self.model.time.allow_unstable =>
            {
                let smallest = table.assessment.stability.smallest;
                let fault = Fault::other(
                    "unstable",
                    format!(
                        "the tuned coefficients make the lattice unstable: the smallest ω²/k² of its waves is {smallest:.3} E/ρ, but must be positive"
                    ),
                    "use lower_bound = \"auto\" (the default), or another method, decay or horizon; time.allow_unstable = true accepts the deck for `pericles dispersion`",
                );
                let problem = Remark::new("material.influence", fault);
                Err(self.rejection(problem.into()))
            }
            _ => Ok(()),
        }
    }
}

const DECK: &str = "A deck is one TOML file. It defines the body, its material, boundary and initial conditions, time integration and output.";
const MATERIALS: &str = "Materials by name, for bodies of several materials. Each table has the keys of `[material]`. Each material has its own density, elastic constants, strength and failure, and its own horizon if it is bond-based. What all bonds of a body share (model, influence function, corrections, bonds, damage, no_fail) comes from `[material]`. `[[assign]]` assigns materials to sets. Points without an assignment have the material of `[material]` if it has density and modulus, otherwise `[materials.default]`; without either, every point needs an assignment.";

/// Reads the model. All tables are read even after an error, so that all problems are reported.
fn model(root: Table<'_>, further: &[String]) -> Option<Model> {
    root.about(DECK);
    root.describe("title", "Title of the run, shown at the top of reports.");
    root.describe("materials", MATERIALS);
    root.describe(
        "sets",
        "Named sets of points. The set \"all\" always exists.",
    );
    let title = root.maybe("title", |item| item.text());
    let body = body::read(root.required("body").and_then(|item| item.table()));
    let frame = body.frame;
    let further = [&body.pieces[..], further].concat();
    let (sets, names) = set::read(root.table_or_empty("sets"), frame, &further);
    let (made, gaussian, several, thermal) = match &body.surface {
        Some(read) => {
            let surface = surface_of(&root, read, frame, &names);
            let several = surface_assignments(&root, &names);
            root.forbid(
                "thermal",
                "thermal expansion and heat conduction of 2-manifolds are not supported",
            );
            (surface.map(Body::Surface), Some(None), several, Some(None))
        }
        None => {
            root.forbid(
                "geodesics",
                "it requires a 2-manifold (shape = \"icosphere\", \"torus\" …)",
            );
            let materials = material::read(&root, &body, &names);
            let gaussian = materials.own.as_ref().map(exact::gaussian_length);
            let several = several_of(&root, &materials, &body, &names);
            let thermal = thermal_of(&root, &materials, &body, &names);
            root.place_as("material", materials.place);
            let solid = solid_of(&body, materials.own);
            (solid.map(Body::Solid), gaussian, several, thermal)
        }
    };
    let scope = CrackScope {
        frame,
        sets: &names,
    };
    let cracks = declared(&root, "crack", scope);
    let scope = Scope {
        dimension: frame.dimension,
        sets: &names,
        materials: &[],
        usual: &TimeHistory::Constant,
    };
    let initial: Option<Vec<Initial>> = declared(&root, "initial", scope);
    let time = root
        .required("time")
        .and_then(|item| Time::read(&item, &names));
    let usual = conditions::usual_function(time.as_ref(), initial.as_deref());
    let scope = Scope {
        usual: &usual,
        ..scope
    };
    let constraints: Option<Vec<Constraint>> = declared(&root, "constraint", scope);
    let loads = declared(&root, "load", scope);
    let boundaries = declared(&root, "boundary", scope);
    let activations = declared(&root, "activation", scope);
    let probes = declared(&root, "probe", scope);
    let exact = root.maybe("exact", |item| {
        exact::read(item.table()?, frame.dimension, ExactScope { gaussian })
    });
    let contact = root.maybe("contact", |item| Contact::read(&item, ()));
    let impactors = declared(&root, "impactor", scope);
    let damping = root.maybe("damping", |item| Damping::read(&item, ()));
    let output = OutputScope {
        dimension: frame.dimension,
        driven: constraints.iter().flatten().any(Constraint::moves),
        surface: body.surface.is_some(),
        mesh: frame.mesh,
        sets: &names,
    };
    let output = root
        .table_or_empty("output")
        .and_then(|table| Output::read_table(table, output));
    let checkpoint = root
        .table_or_empty("checkpoint")
        .and_then(|table| Checkpoint::read_table(table, ()));
    let run = root.maybe("run", |item| Processor::read(&item, ()));
    root.finish();
    let (materials, assignments, interfaces) = several?;
    Some(Model {
        title: title?,
        body: made?,
        materials,
        assignments,
        interfaces,
        sets: sets?,
        cracks: cracks?,
        initial: initial?,
        constraints: constraints?,
        loads: loads?,
        boundaries: boundaries?,
        activations: activations?,
        probes: probes?,
        exact: exact?,
        contact: contact?,
        impactors: impactors?,
        thermal: thermal?,
        damping: damping?,
        time: time?,
        output: output?,
        checkpoint: checkpoint?,
        run: run?.unwrap_or_default(),
    })
}

impl Document {
    /// Reads a document; of a deck with steps, the first one.
    pub(crate) fn of(text: &str, file_name: &str, overrides: &[String]) -> Result<Self, DeckError> {
        Self::of_step(text, file_name, overrides, 0)
    }

    /// Reads the document of a step.
    pub(crate) fn of_step(
        text: &str,
        file_name: &str,
        overrides: &[String],
        number: usize,
    ) -> Result<Self, DeckError> {
        let mut sources = Sources::new(file_name, text);
        let mut root = document::parse(&sources)?;
        for text in overrides {
            overrides::apply(&mut root, text, &mut sources)?;
        }
        let steps = step::names(&root, &sources)?;
        step::select(&mut root, number, &sources)?;
        inherit(&mut root);
        Ok(Self {
            root,
            sources,
            steps,
        })
    }
}

/// Further materials, assignments and interfaces.
type Several = (Vec<NamedMaterial>, Vec<Assignment>, Vec<MaterialInterface>);

/// Reads further materials, assignments and interfaces.
fn several_of(
    root: &Table<'_>,
    materials: &Materials,
    body: &BodyRead,
    sets: &SetNames,
) -> Option<Several> {
    let names = &materials.names[..];
    let own = materials.own.as_ref();
    let of = match own.map(|own| &own.model) {
        Some(MaterialModel::StateBased(_) | MaterialModel::Correspondence(_)) => {
            Assignable::Material
        }
        _ => Assignable::Both,
    };
    let deck = scope_of(body, names, sets);
    let assignments = match own {
        Some(_) => declared(root, "assign", AssignScope { deck, of }),
        // The allowed assignments are unknown.
        None => root.optional("assign").and(None),
    };
    let interfaces = match materials.others.as_deref() {
        Some([]) => {
            root.forbid(
                "interface",
                "interfaces require several materials ([materials.NAME], [[assign]])",
            );
            Some(Vec::new())
        }
        _ => interface::read(root.tables("interface"), names, own, body),
    };
    Some((materials.others.clone()?, assignments?, interfaces?))
}

/// Returns the scope of tables of a body.
fn scope_of<'s>(body: &BodyRead, materials: &'s [String], sets: &'s SetNames) -> Scope<'s> {
    Scope {
        dimension: body.frame.dimension,
        sets,
        materials,
        usual: &TimeHistory::Constant,
    }
}

/// Reads `[thermal]`, if the deck has it.
fn thermal_of(
    root: &Table<'_>,
    materials: &Materials,
    body: &BodyRead,
    sets: &SetNames,
) -> Option<Option<Thermal>> {
    root.maybe("thermal", |item| {
        let table = item.table()?;
        let scope = scope_of(body, &materials.names, sets);
        let scope = ThermalScope::of(&table, scope);
        Thermal::read_table(table, scope)
    })
}

/// Reads the assignments of a 2-manifold.
fn surface_assignments(root: &Table<'_>, sets: &SetNames) -> Option<Several> {
    for key in ["materials", "interface"] {
        root.forbid(key, "a 2-manifold has one material");
    }
    let scope = AssignScope {
        deck: Scope {
            dimension: None,
            sets,
            materials: &[],
            usual: &TimeHistory::Constant,
        },
        of: Assignable::Stiffness,
    };
    let assignments = declared(root, "assign", scope);
    Some((Vec::new(), assignments?, Vec::new()))
}

/// Assembles a solid body, if it and its material could be read.
fn solid_of(body: &BodyRead, material: Option<Material>) -> Option<Solid> {
    Some(Solid {
        shape: body.shape.clone()?,
        state: body.state?,
        material: material?,
    })
}

/// Reads the tables of a 2-manifold other than `[body]`.
fn surface_of(
    root: &Table<'_>,
    read: &SurfaceRead,
    frame: Frame,
    names: &SetNames,
) -> Option<SurfaceBody> {
    root.forbid("crack", "pre-cracks in 2-manifolds are not supported");
    let geodesics = root.table_or_empty("geodesics");
    let geodesics = geodesics.and_then(|table| Geodesics::read_table(table, ()));
    let scope = SurfaceScope {
        spacing: frame.spacing,
        sets: names,
    };
    let material = root.required("material");
    let material = material.and_then(|item| SurfaceMaterial::read(&item, scope));
    Some(SurfaceBody {
        shape: read.shape.clone()?,
        areas: read.areas?,
        material: material?,
        geodesics: geodesics?,
    })
}
