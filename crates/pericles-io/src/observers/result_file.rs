//! Fields on the points over time in one file.

use std::path::PathBuf;
use std::sync::Arc;

use pericles::observe::{Field, ObserveError, Observer, Snapshot};
use pericles::{Archive, Result, Saved, Values};
use pericles_mesh::results::{
    ExodusLayout, ExodusWriter, FieldSpec, VtkHdfLayout, VtkHdfWriter, WriteError,
};

use super::fields::columns;
use super::table::misfit;
use crate::error::IoError;
use crate::result_body::{ResultBody, write_error};

/// The format of a file that holds all outputs of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResultFormat {
    /// Exodus II: points as spheres with radius and volume, blocks, node sets.
    Exodus,
    /// VTKHDF with room for so many outputs.
    VtkHdf {
        /// At least the number of outputs of the whole run.
        outputs: usize,
    },
}

/// Fields on the points in one file that grows output by output, in the user's numbering of the points. A killed run leaves a whole file of the outputs before; a resumed one
/// continues it to the same bytes.
pub struct ResultFile {
    path: PathBuf,
    format: ResultFormat,
    body: Arc<ResultBody>,
    wanted: Vec<Field>,
    is_single: bool,
    writer: Option<Writer>,
}

enum Writer {
    Exodus(ExodusWriter),
    VtkHdf(Box<VtkHdfWriter>),
}

impl Writer {
    fn outputs(&self) -> usize {
        match self {
            Self::Exodus(writer) => writer.outputs(),
            Self::VtkHdf(writer) => writer.outputs(),
        }
    }
}

impl ResultFile {
    /// A file of these fields.
    pub fn new(
        path: impl Into<PathBuf>,
        format: ResultFormat,
        body: Arc<ResultBody>,
        wanted: &[Field],
        is_single: bool,
    ) -> Self {
        Self {
            path: path.into(),
            format,
            body,
            wanted: wanted.to_vec(),
            is_single,
            writer: None,
        }
    }

    /// Each component of a tensor is a field of its own, as in the series of VTU files.
    fn fields(&self) -> Vec<FieldSpec> {
        let dimension = self.body.dimension;
        let specs = self.wanted.iter().flat_map(|field| {
            let name = field.name();
            match (field.is_tensor(), field.is_vector()) {
                (true, _) => {
                    let parts = field.components(dimension).iter();
                    let part = |part: &&str| FieldSpec::new(format!("{name}_{part}"), 1);
                    parts.map(part).collect()
                }
                (false, true) => vec![FieldSpec::new(name, dimension)],
                (false, false) => vec![FieldSpec::new(name, 1)],
            }
        });
        specs.collect()
    }

    /// The writer after a number of outputs: of a new file if there are none.
    fn open(&self, outputs: usize) -> std::result::Result<Writer, WriteError> {
        let body = &*self.body;
        match self.format {
            ResultFormat::Exodus => {
                let layout = ExodusLayout {
                    title: body.title.clone(),
                    dimension: body.dimension,
                    positions: &body.positions,
                    volumes: &body.volumes,
                    blocks: body.blocks.clone(),
                    sets: body.sets.clone(),
                    globals: Vec::new(),
                    fields: self.fields(),
                    is_single: self.is_single,
                };
                let writer = match outputs {
                    0 => ExodusWriter::create(&self.path, &layout),
                    outputs => ExodusWriter::resume(&self.path, &layout, outputs),
                };
                writer.map(Writer::Exodus)
            }
            ResultFormat::VtkHdf { outputs: most } => {
                let layout = VtkHdfLayout {
                    dimension: body.dimension,
                    positions: &body.positions,
                    fields: self.fields(),
                    constants: vec![(FieldSpec::new("Volume", 1), &body.volumes)],
                    outputs: most,
                    is_single: self.is_single,
                };
                let writer = match outputs {
                    0 => VtkHdfWriter::create(&self.path, &layout),
                    outputs => VtkHdfWriter::resume(&self.path, &layout, outputs),
                };
                writer.map(|writer| Writer::VtkHdf(Box::new(writer)))
            }
        }
    }

    fn write(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), WriteError> {
        if self.writer.is_none() {
            self.writer = Some(self.open(0)?);
        }
        let numbering = &self.body.numbering;
        let arrays: Vec<_> = self
            .wanted
            .iter()
            .flat_map(|&field| columns(field, snapshot))
            .map(|(_, _, array)| numbering.apply(array))
            .collect();
        let values: Vec<&[f64]> = arrays.iter().map(|array| &**array).collect();
        let time = snapshot.state().t;
        match &mut self.writer {
            Some(Writer::Exodus(writer)) => writer.append(time, &[], &values),
            Some(Writer::VtkHdf(writer)) => writer.append(time, &values),
            None => Ok(()),
        }
    }

    /// Brings what was written to the disk.
    fn sync(&self) -> std::result::Result<(), IoError> {
        let synced = match &self.writer {
            Some(Writer::Exodus(writer)) => writer.sync(),
            Some(Writer::VtkHdf(writer)) => writer.sync(),
            None => Ok(()),
        };
        synced.map_err(|error| IoError::writing(&self.path, error))
    }

    fn key(&self) -> &'static str {
        match self.format {
            ResultFormat::Exodus => "observer/exodus",
            ResultFormat::VtkHdf { .. } => "observer/vtkhdf",
        }
    }
}

impl Observer for ResultFile {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        for field in &self.wanted {
            snapshot.check(*field)?;
        }
        let written = self.write(snapshot);
        Ok(written.map_err(|error| write_error(&self.path, error))?)
    }

    fn settle(&self) -> std::result::Result<(), ObserveError> {
        Ok(self.sync()?)
    }

    fn finish(&mut self) -> std::result::Result<(), ObserveError> {
        self.settle()
    }
}

impl Saved for ResultFile {
    fn save(&self, archive: &mut Archive) {
        let key = self.key();
        let Self {
            writer,
            // Given again.
            path: _,
            format: _,
            body: _,
            wanted: _,
            is_single: _,
        } = self;
        let outputs = writer.as_ref().map_or(0, Writer::outputs);
        archive.put(key, Values::U64(vec![outputs as u64]));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut outputs = 0;
        archive.u64_into(self.key(), std::slice::from_mut(&mut outputs))?;
        self.writer = (outputs > 0)
            .then(|| self.open(outputs as usize))
            .transpose()
            .map_err(|error| misfit(write_error(&self.path, error)))?;
        Ok(())
    }
}
