//! Description of a body in result files, apart from its fields.

use std::path::Path;

use pericles::observe::Field;
use pericles::space::PointCloud;
use pericles_mesh::results::{ExodusLayout, FieldSpec, PointList, VtkHdfLayout, WriteError};

use crate::IoError;
use crate::numbering::Numbering;

/// The points of a body in the user's order, with blocks and sets.
#[derive(Debug, Clone)]
pub struct ResultBody {
    /// Title.
    pub title: String,
    /// Number of coordinates per point.
    pub dimension: usize,
    /// Positions, component-major, m.
    pub positions: Vec<f64>,
    /// Volumes, m³.
    pub volumes: Vec<f64>,
    /// Blocks; every point belongs to exactly one.
    pub blocks: Vec<PointList>,
    /// Point sets.
    pub sets: Vec<PointList>,
    pub(crate) numbering: Numbering,
}

impl ResultBody {
    /// Describes a cloud with named sets; `block` returns the block number of a point, `name` the name of a
    /// block by its number.
    pub fn new<'a>(
        title: impl Into<String>,
        cloud: &PointCloud,
        sets: impl IntoIterator<Item = (&'a str, &'a [u32])>,
        block: impl Fn(usize) -> u32,
        name: impl Fn(u32) -> String,
    ) -> Self {
        let numbering = Numbering::of(cloud);
        let in_files = |points: &mut dyn Iterator<Item = u32>| {
            let mut numbers: Vec<u32> = points.map(|i| numbering.number(i)).collect();
            numbers.sort_unstable();
            numbers
        };
        let all = 0..cloud.len() as u32;
        let mut kinds: Vec<u32> = (0..cloud.len()).map(&block).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let blocks = kinds.into_iter().map(|kind| {
            let mut members = all.clone().filter(|&i| block(i as usize) == kind);
            PointList {
                name: name(kind),
                points: in_files(&mut members),
            }
        });
        let blocks = blocks.collect();
        let sets = sets.into_iter().map(|(name, points)| PointList {
            name: name.to_owned(),
            points: in_files(&mut points.iter().copied()),
        });
        let sets = sets.collect();
        Self {
            title: title.into(),
            dimension: cloud.dimension(),
            positions: numbering.apply(cloud.positions()).into_owned(),
            volumes: numbering.apply(cloud.volumes()).into_owned(),
            blocks,
            sets,
            numbering,
        }
    }
}

impl ResultBody {
    /// Returns the layout of an Exodus file with these fields, in single precision if `is_single`.
    pub fn exodus(&self, fields: Vec<FieldSpec>, is_single: bool) -> ExodusLayout<'_> {
        ExodusLayout {
            title: self.title.clone(),
            dimension: self.dimension,
            positions: &self.positions,
            volumes: &self.volumes,
            blocks: self.blocks.clone(),
            sets: self.sets.clone(),
            globals: Vec::new(),
            fields,
            is_single,
        }
    }

    /// Returns the layout of a VTKHDF file with these fields and number of outputs, in single precision if `is_single`.
    pub fn vtkhdf(
        &self,
        fields: Vec<FieldSpec>,
        outputs: usize,
        is_single: bool,
    ) -> VtkHdfLayout<'_> {
        VtkHdfLayout {
            dimension: self.dimension,
            positions: &self.positions,
            constants: self.constants(&fields),
            fields,
            outputs,
            is_single,
        }
    }
}

impl ResultBody {
    /// Returns the volumes as a constant field of a file, unless one of its fields is the volume.
    pub fn constants(&self, fields: &[FieldSpec]) -> Vec<(FieldSpec, &[f64])> {
        let volume = FieldSpec::new(Field::Volume.name(), 1);
        match fields.iter().any(|field| field.name == volume.name) {
            true => Vec::new(),
            false => vec![(volume, &self.volumes)],
        }
    }
}

/// Converts an error of writing a result file.
pub fn write_error(path: &Path, error: WriteError) -> IoError {
    match error {
        WriteError::Io(source) => IoError::writing(path, source),
        WriteError::NotContinued(reason) => IoError::damaged(path, reason),
        other => IoError::Unsuitable {
            path: path.to_path_buf(),
            reason: other.to_string(),
        },
    }
}
