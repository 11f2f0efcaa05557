//! The model: everything that is simulated, as plain data.

use std::path::Path;

use pericles::material::StressState;

use crate::body::{SolidShape, SurfaceShape};
use crate::boundary::BoundaryCondition;
use crate::conditions::{Initial, Load, Prescribe, Probe};
use crate::crack::PreCrack;
use crate::exact::Exact;
use crate::material::Material;
use crate::output::{Checkpoint, Output};
use crate::set::NamedSet;
use crate::surface::SurfaceBody;
use crate::time::Time;

/// What is simulated and what is written, as plain data in SI units: what a [`Deck`](crate::Deck) says, without its text.
#[derive(Debug, Clone)]
pub struct Model {
    /// A title for people.
    pub title: Option<String>,
    /// `[body]` and `[material]`, of a surface `[geodesics]` as well.
    pub body: Body,
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

/// The body, with what it is made of.
#[derive(Debug, Clone, PartialEq)]
pub enum Body {
    /// Points with volumes and bonds along straight lines.
    Solid(Solid),
    /// The vertices of a surface, with bonds along it.
    Surface(SurfaceBody),
}

/// A body of points with volumes.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Where its points are.
    pub shape: SolidShape,
    /// Stress state, which follows from the dimension and, in two dimensions, from `plane`.
    pub state: StressState,
    /// `[material]`
    pub material: Material,
}

impl Body {
    /// The body, if it is one of points with volumes.
    pub fn solid(&self) -> Option<&Solid> {
        match self {
            Self::Solid(solid) => Some(solid),
            Self::Surface(_) => None,
        }
    }

    /// The body, if it is one of points with volumes, to change it.
    pub fn solid_mut(&mut self) -> Option<&mut Solid> {
        match self {
            Self::Solid(solid) => Some(solid),
            Self::Surface(_) => None,
        }
    }

    /// The surface, if it is one.
    pub fn surface(&self) -> Option<&SurfaceBody> {
        match self {
            Self::Solid(_) => None,
            Self::Surface(surface) => Some(surface),
        }
    }

    /// Horizon of the bonds, m.
    pub fn horizon(&self) -> f64 {
        match self {
            Self::Solid(solid) => solid.material.bonds.horizon,
            Self::Surface(surface) => surface.material.horizon,
        }
    }

    /// Sets whose bonds never break.
    pub fn no_fail(&self) -> &[String] {
        match self {
            Self::Solid(solid) => &solid.material.no_fail,
            Self::Surface(surface) => &surface.no_fail,
        }
    }

    /// The file that the points come from.
    fn file(&self) -> Option<&Path> {
        match self {
            Self::Solid(Solid {
                shape: SolidShape::Points(file),
                ..
            }) => Some(&file.path),
            Self::Surface(SurfaceBody {
                shape: SurfaceShape::File { path, .. },
                ..
            }) => Some(path),
            Self::Solid(_) | Self::Surface(_) => None,
        }
    }
}

impl Model {
    /// The files that the model names. A relative path starts at the folder of the deck.
    pub fn files(&self) -> Vec<&Path> {
        let initial = self.initial.iter();
        let initial = initial.filter_map(|initial| initial.file.as_deref());
        self.body.file().into_iter().chain(initial).collect()
    }
}
