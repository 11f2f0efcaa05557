//! Fields on the points over time in one file.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use pericles::observe::{Field, ObserveError, Observer, Snapshot};
use pericles::{Archive, Result, Saved, Values};
use pericles_mesh::results::{
    ExodusLayout, ExodusWriter, FieldSpec, VtkHdfLayout, VtkHdfWriter, WriteError,
};

use super::background::Background;
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
///
/// Outputs are written by a thread of their own while the run goes on, one at a time.
pub struct ResultFile {
    path: PathBuf,
    format: ResultFormat,
    body: Arc<ResultBody>,
    wanted: Vec<Field>,
    is_single: bool,
    writer: Option<Arc<Mutex<Writer>>>,
    /// Outputs so far, the one under way among them.
    outputs: usize,
    background: Background,
}

enum Writer {
    Exodus(ExodusWriter),
    VtkHdf(Box<VtkHdfWriter>),
}

impl Writer {
    fn append(&mut self, time: f64, values: &[&[f64]]) -> std::result::Result<(), WriteError> {
        match self {
            Self::Exodus(writer) => writer.append(time, &[], values),
            Self::VtkHdf(writer) => writer.append(time, values),
        }
    }

    /// Brings what was written to the disk.
    fn sync(&self) -> std::io::Result<()> {
        match self {
            Self::Exodus(writer) => writer.sync(),
            Self::VtkHdf(writer) => writer.sync(),
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
            outputs: 0,
            background: Background::default(),
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

    fn write(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), IoError> {
        let failed = |error| write_error(&self.path, error);
        let writer = match &self.writer {
            Some(writer) => Arc::clone(writer),
            None => {
                let writer = self.open(0).map_err(failed)?;
                Arc::clone(self.writer.insert(Arc::new(Mutex::new(writer))))
            }
        };
        let numbering = &self.body.numbering;
        let arrays: Vec<Vec<f64>> = self
            .wanted
            .iter()
            .flat_map(|&field| columns(field, snapshot))
            .map(|(_, _, array)| numbering.apply(array).into_owned())
            .collect();
        let (time, path) = (snapshot.state().t, self.path.clone());
        self.background.start(move || {
            let values: Vec<&[f64]> = arrays.iter().map(Vec::as_slice).collect();
            let mut writer = writer.lock().unwrap_or_else(PoisonError::into_inner);
            let written = writer.append(time, &values);
            written.map_err(|error| write_error(&path, error))
        })?;
        self.outputs += 1;
        Ok(())
    }

    /// Waits for the output under way and brings all of them to the disk.
    fn sync(&self) -> std::result::Result<(), IoError> {
        self.background.settle()?;
        let Some(writer) = &self.writer else {
            return Ok(());
        };
        let writer = writer.lock().unwrap_or_else(PoisonError::into_inner);
        let synced = writer.sync();
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
        Ok(self.write(snapshot)?)
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
            outputs,
            // Opened again.
            writer: _,
            background: _,
            // Given again.
            path: _,
            format: _,
            body: _,
            wanted: _,
            is_single: _,
        } = self;
        archive.put(key, Values::U64(vec![*outputs as u64]));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut outputs = 0;
        archive.u64_into(self.key(), std::slice::from_mut(&mut outputs))?;
        self.outputs = outputs as usize;
        self.writer = (outputs > 0)
            .then(|| self.open(outputs as usize))
            .transpose()
            .map_err(|error| misfit(write_error(&self.path, error)))?
            .map(|writer| Arc::new(Mutex::new(writer)));
        Ok(())
    }
}
