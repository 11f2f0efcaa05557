//! The model: everything that is simulated, as plain data.

use std::path::Path;

use crate::body::{Body, SurfaceShape};
use crate::boundary::BoundaryCondition;
use crate::conditions::{Initial, Load, Prescribe, Probe};
use crate::crack::PreCrack;
use crate::exact::Exact;
use crate::material::Material;
use crate::output::{Checkpoint, Output};
use crate::set::NamedSet;
use crate::surface::SurfaceDeck;
use crate::time::Time;

/// What is simulated and what is written, as plain data in SI units: what a [`Deck`](crate::Deck) says, without its text.
#[derive(Debug, Clone)]
pub struct Model {
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
}

impl Model {
    /// The files that the model names. A relative path starts at the folder of the deck.
    pub fn files(&self) -> Vec<&Path> {
        let listed = self.body.listed.iter().map(|listed| listed.path.as_path());
        let surface = self
            .surface
            .iter()
            .filter_map(|surface| match &surface.shape {
                SurfaceShape::File { path, .. } => Some(path.as_path()),
                SurfaceShape::Formula(_) => None,
            });
        let initial = self.initial.iter();
        let initial = initial.filter_map(|initial| initial.file.as_deref());
        listed.chain(surface).chain(initial).collect()
    }
}
