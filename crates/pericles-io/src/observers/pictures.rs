//! Pictures of a field over time.
//!
//! A picture is drawn during the run with the range of its state and, unless the range is fixed, again at the end
//! with the common range, from files with the drawn states that are then removed.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pericles::observe::{Field, ObserveError, Observer, Snapshot};
use pericles::space::PointCloud;
use pericles::{Archive, Checkpointed, PericlesError, Result, Values};

use super::picture_of::{DrawnState, PictureOf, whole_damage, whole_shown};
use super::rigid::{RigidMesh, rigid_meshes};
use crate::checkpoint::Container;
use crate::error::IoError;
use crate::picture::{Extent, write_animation};

/// Pictures `<stem>-000000.png`, `<stem>-000001.png` …, or SVG or PDF files, in a folder and, if requested, an animation
/// `<stem>.apng` of the existing pictures at the end of the run.
pub struct Pictures {
    folder: PathBuf,
    stem: String,
    /// Ending of the file names, which is the format.
    ending: &'static str,
    what: PictureOf,
    animated: bool,
    drawn: u64,
    /// The points of the body, for pictures with a common range.
    cloud: Option<Arc<PointCloud>>,
    /// Range of the values of all pictures so far.
    extent: Option<Extent>,
}

/// A drawn state in a file.
struct DrawnFile {
    t: f64,
    size: f64,
    displacement: Vec<f64>,
    values: Vec<f64>,
    damage: Option<Vec<f64>>,
    impactors: Vec<RigidMesh>,
}

impl DrawnFile {
    /// Returns the state of a snapshot; `None` if another process writes it.
    fn of(what: &PictureOf, snapshot: &Snapshot<'_>) -> Option<Self> {
        let (field, displacement) = (
            whole_shown(snapshot, what.field),
            whole_shown(snapshot, Field::Displacement),
        );
        let damage = whole_damage(snapshot);
        let field = field?;
        let values = what.numbers(&field, snapshot.whole_cloud().len());
        Some(Self {
            t: snapshot.state().t,
            size: what.extent(&field, &values).size(),
            displacement: displacement?.into_owned(),
            values: values.into_owned(),
            damage: damage.map(std::borrow::Cow::into_owned),
            impactors: rigid_meshes(snapshot),
        })
    }

    fn write(self, path: &Path) -> std::result::Result<(), IoError> {
        let mut archive = Archive::default();
        archive.put("t", Values::F64(vec![self.t]));
        archive.put("size", Values::F64(vec![self.size]));
        archive.put("displacement", Values::F64(self.displacement));
        archive.put("values", Values::F64(self.values));
        if let Some(damage) = self.damage {
            archive.put("damage", Values::F64(damage));
        }
        let impactors = self.impactors.iter().flat_map(RigidMesh::to_numbers);
        archive.put("impactors", Values::F64(impactors.collect()));
        Container::from_archive(serde_json::Value::Null, archive).write(path)
    }

    fn read(path: &Path) -> std::result::Result<Self, IoError> {
        let damaged = |reason: String| IoError::damaged(path, reason);
        let container = Container::read(path, u64::MAX)?;
        let (_, archive) = container.into_archive().map_err(damaged)?;
        let array = |name: &str| -> std::result::Result<Vec<f64>, IoError> {
            let values = archive
                .f64s(name)
                .map_err(|error| damaged(error.to_string()))?;
            Ok(values.to_vec())
        };
        let number = |name: &str| -> std::result::Result<f64, IoError> {
            let values = array(name)?;
            values
                .first()
                .copied()
                .ok_or_else(|| damaged(format!("{name} is empty")))
        };
        Ok(Self {
            t: number("t")?,
            size: number("size")?,
            displacement: array("displacement")?,
            values: array("values")?,
            damage: archive.f64s("damage").ok().map(<[f64]>::to_vec),
            impactors: RigidMesh::from_numbers(&array("impactors")?)
                .ok_or_else(|| damaged("impactors are incomplete".into()))?,
        })
    }

    fn extent(&self) -> Extent {
        Extent::of(&self.values, self.size)
    }

    fn state(&self) -> DrawnState<'_> {
        DrawnState {
            t: self.t,
            displacement: &self.displacement,
            values: &self.values,
            damage: self.damage.as_deref(),
            extent: None,
            impactors: &self.impactors,
        }
    }
}

impl Pictures {
    /// Creates pictures in an existing folder; `stem` distinguishes them from those of other observers.
    pub fn new(folder: impl Into<PathBuf>, stem: impl Into<String>, what: PictureOf) -> Self {
        Self {
            folder: folder.into(),
            stem: stem.into(),
            ending: "png",
            what,
            animated: false,
            drawn: 0,
            cloud: None,
            extent: None,
        }
    }

    /// Sets the ending of the file names, `png`, `svg` or `pdf`, which is the format.
    pub fn with_ending(mut self, ending: &'static str) -> Self {
        self.ending = ending;
        self
    }

    /// Adds an animation of PNG files at the end of the run; all pictures then show the same region.
    pub fn animated(mut self) -> Self {
        self.animated = true;
        self.what.steady = true;
        self
    }

    fn still(&self, number: u64) -> PathBuf {
        self.folder
            .join(format!("{}-{number:06}.{}", self.stem, self.ending))
    }

    /// Draws all pictures again at the end of the run with one range of the colour bar, unless the range is fixed.
    pub fn with_common_range(mut self, cloud: Arc<PointCloud>) -> Self {
        self.cloud = self.what.has_own_range().then_some(cloud);
        self
    }

    /// The file of the state that a picture shows, kept until the run has ended.
    fn state(&self, number: u64) -> PathBuf {
        self.folder
            .join(format!(".{}-{number:06}.state", self.stem))
    }

    /// Draws all pictures again with one range, so that equal colours are equal values, and removes the files of the states.
    fn redraw(&self, cloud: &PointCloud) -> std::result::Result<(), IoError> {
        let Some(whole) = self.extent else {
            return Ok(());
        };
        // States are missing if the run was killed after it had removed them: these pictures have the common range already.
        let states = (0..self.drawn).filter(|&number| self.state(number).exists());
        for number in states {
            let path = self.state(number);
            let file = DrawnFile::read(&path)?;
            // A picture that the user has removed stays removed.
            if self.still(number).exists() && whole != file.extent() {
                let state = DrawnState {
                    extent: Some(whole),
                    ..file.state()
                };
                self.what.draw_state(cloud, &state, self.still(number))?;
            }
            std::fs::remove_file(&path).map_err(|error| IoError::writing(&path, error))?;
        }
        Ok(())
    }

    fn extent_key(&self) -> String {
        format!("observer/pictures/{}/extent", self.stem)
    }

    fn key(&self) -> String {
        format!("observer/pictures/{}", self.stem)
    }
}

impl Observer for Pictures {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        snapshot.check(self.what.field)?;
        self.what.draw(snapshot, self.still(self.drawn))?;
        if self.cloud.is_some()
            && let Some(drawn) = DrawnFile::of(&self.what, snapshot)
        {
            let extent = drawn.extent();
            self.extent = Some(self.extent.map_or(extent, |whole| whole.union(extent)));
            drawn.write(&self.state(self.drawn))?;
        }
        self.drawn += u64::from(snapshot.is_written());
        Ok(())
    }

    fn observe_failed(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        self.observe(snapshot)
    }

    fn finish(&mut self) -> std::result::Result<(), ObserveError> {
        if let Some(cloud) = &self.cloud {
            self.redraw(cloud)?;
        }
        if !self.animated {
            return Ok(());
        }
        // The user may have deleted some pictures of a long run: the others still make an animation.
        let stills: Vec<PathBuf> = (0..self.drawn)
            .map(|number| self.still(number))
            .filter(|still| still.exists())
            .collect();
        if stills.is_empty() {
            return Ok(());
        }
        let path = self.folder.join(format!("{}.apng", self.stem));
        Ok(write_animation(&stills, path)?)
    }
}

impl Checkpointed for Pictures {
    fn save(&self, archive: &mut Archive) {
        let Self {
            drawn,
            folder: _,
            stem: _,
            ending: _,
            what: _,
            animated: _,
            cloud: _,
            extent,
        } = self;
        archive.put(self.key(), Values::U64(vec![*drawn]));
        if let Some(extent) = extent {
            archive.put(self.extent_key(), Values::F64(extent.parts().to_vec()));
        }
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut drawn = [0];
        archive.u64_into(&self.key(), &mut drawn)?;
        let last = drawn[0].checked_sub(1).map(|last| self.still(last));
        if let Some(missing) = last.filter(|last| !last.exists()) {
            let reason = format!(
                "it lists {} pictures, but {} is missing",
                drawn[0],
                missing.display()
            );
            return Err(PericlesError::BadArchive { reason });
        }
        self.drawn = drawn[0];
        // Checkpoints of earlier releases have no extent.
        let parts = archive.f64s(&self.extent_key()).ok();
        let parts = parts.and_then(|parts| <[f64; 3]>::try_from(parts).ok());
        self.extent = parts.map(Extent::from_parts);
        Ok(())
    }
}
