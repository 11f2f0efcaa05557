//! Fields on the points over time in one file.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use pericles::observe::{ObserveError, Observer, Snapshot};
use pericles::{Archive, Checkpointed, Result, Values};
use pericles_mesh::results::{
    ExodusLayout, ExodusReader, ExodusWriter, FieldSpec, VtkHdfLayout, VtkHdfReader, VtkHdfWriter,
    WriteError,
};

use super::background::Background;
use super::field_columns::FieldSelection;
use super::table::misfit;
use crate::error::IoError;
use crate::result_body::{ResultBody, write_error};

/// The format of a file that holds all outputs of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResultFormat {
    /// Exodus II: points as spheres with radius and volume, blocks, node sets.
    Exodus,
    /// VTKHDF with space for a maximum number of outputs.
    VtkHdf {
        /// Upper bound of the number of outputs of the whole run.
        outputs: usize,
    },
}

/// Fields on the points in one file that grows with each output, in the user's order of points. After a
/// killed run the file is valid up to the last complete output; a resumed run continues it to the same bytes.
///
/// Outputs are written in a background thread while the run continues, one at a time.
pub struct ResultFile {
    path: PathBuf,
    format: ResultFormat,
    body: Arc<ResultBody>,
    wanted: FieldSelection,
    is_single: bool,
    writer: Option<Arc<Mutex<Writer>>>,
    /// Number of outputs, including the one in progress.
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

    /// Syncs the file to disk.
    fn sync(&self) -> std::io::Result<()> {
        match self {
            Self::Exodus(writer) => writer.sync(),
            Self::VtkHdf(writer) => writer.sync(),
        }
    }
}

enum Reader {
    Exodus(ExodusReader),
    VtkHdf(Box<VtkHdfReader>),
}

/// The outputs in a file of fields.
pub struct RecordedFields {
    path: PathBuf,
    specs: Vec<FieldSpec>,
    reader: Reader,
}

impl RecordedFields {
    /// Returns the number of outputs.
    pub fn len(&self) -> usize {
        match &self.reader {
            Reader::Exodus(reader) => reader.outputs(),
            Reader::VtkHdf(reader) => reader.outputs(),
        }
    }

    /// Returns whether there are no outputs.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the fields.
    pub fn specs(&self) -> &[FieldSpec] {
        &self.specs
    }

    /// Reads the time of an output, s, and the values of the fields in the user's order of points, component-major.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn read(&mut self, output: usize) -> std::result::Result<(f64, Vec<Vec<f64>>), IoError> {
        let read = match &mut self.reader {
            Reader::Exodus(reader) => reader.read(output),
            Reader::VtkHdf(reader) => reader.read(output),
        };
        read.map_err(|error| write_error(&self.path, error))
    }
}

impl ResultFile {
    /// Creates a file of these fields.
    pub fn new(
        path: impl Into<PathBuf>,
        format: ResultFormat,
        body: Arc<ResultBody>,
        wanted: FieldSelection,
        is_single: bool,
    ) -> Self {
        Self {
            path: path.into(),
            format,
            body,
            wanted,
            is_single,
            writer: None,
            outputs: 0,
            background: Background::default(),
        }
    }

    fn exodus(&self) -> ExodusLayout<'_> {
        let fields = self.wanted.specs(self.body.dimension);
        self.body.exodus(fields, self.is_single)
    }

    fn vtkhdf(&self, outputs: usize) -> VtkHdfLayout<'_> {
        let fields = self.wanted.specs(self.body.dimension);
        self.body.vtkhdf(fields, outputs, self.is_single)
    }

    /// The writer after a number of outputs: of a new file if there are none.
    fn open(&self, outputs: usize) -> std::result::Result<Writer, WriteError> {
        match self.format {
            ResultFormat::Exodus => {
                let layout = self.exodus();
                let writer = match outputs {
                    0 => ExodusWriter::create(&self.path, &layout),
                    outputs => ExodusWriter::resume(&self.path, &layout, outputs),
                };
                writer.map(Writer::Exodus)
            }
            ResultFormat::VtkHdf { outputs: most } => {
                let layout = self.vtkhdf(most);
                let writer = match outputs {
                    0 => VtkHdfWriter::create(&self.path, &layout),
                    outputs => VtkHdfWriter::resume(&self.path, &layout, outputs),
                };
                writer.map(|writer| Writer::VtkHdf(Box::new(writer)))
            }
        }
    }

    /// Opens the file of a finished run for reading.
    ///
    /// # Errors
    /// The file cannot be read, or belongs to another run.
    pub fn recorded(&self) -> std::result::Result<RecordedFields, IoError> {
        let reader = match self.format {
            ResultFormat::Exodus => {
                ExodusReader::open(&self.path, &self.exodus()).map(Reader::Exodus)
            }
            ResultFormat::VtkHdf { outputs } => {
                let reader = VtkHdfReader::open(&self.path, &self.vtkhdf(outputs));
                reader.map(|reader| Reader::VtkHdf(Box::new(reader)))
            }
        };
        Ok(RecordedFields {
            specs: self.wanted.specs(self.body.dimension),
            reader: reader.map_err(|error| write_error(&self.path, error))?,
            path: self.path.clone(),
        })
    }

    fn write(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), IoError> {
        let numbering = &self.body.numbering;
        let Some(columns) = self.wanted.columns(snapshot, numbering) else {
            return Ok(());
        };
        let failed = |error| write_error(&self.path, error);
        let writer = match &self.writer {
            Some(writer) => Arc::clone(writer),
            None => {
                let writer = self.open(0).map_err(failed)?;
                Arc::clone(self.writer.insert(Arc::new(Mutex::new(writer))))
            }
        };
        let points = snapshot.whole_cloud().len();
        let (time, path) = (snapshot.state().t, self.path.clone());
        self.background.start(move || {
            let arrays = columns.iter().flat_map(|column| column.arrays(points));
            let values: Vec<&[f64]> = arrays.collect();
            let mut writer = writer.lock().unwrap_or_else(PoisonError::into_inner);
            let written = writer.append(time, &values);
            written.map_err(|error| write_error(&path, error))
        })?;
        self.outputs += 1;
        Ok(())
    }

    /// Waits for the output in progress and syncs the file to disk.
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
        self.wanted.check(snapshot)?;
        Ok(self.write(snapshot)?)
    }

    fn observe_failed(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        self.observe(snapshot)
    }

    fn settle(&self) -> std::result::Result<(), ObserveError> {
        Ok(self.sync()?)
    }

    fn finish(&mut self) -> std::result::Result<(), ObserveError> {
        self.settle()
    }
}

impl Checkpointed for ResultFile {
    fn save(&self, archive: &mut Archive) {
        let key = self.key();
        let Self {
            outputs,
            // The file is reopened.
            writer: _,
            background: _,
            // Given again by the constructor.
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
