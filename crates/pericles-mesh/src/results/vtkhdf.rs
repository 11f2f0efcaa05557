//! Writer of VTKHDF 2.0: an unstructured grid of points with fields over time, in one HDF5 file.
//!
//! The number of outputs is known before the run, so that the file is laid out once and every value has a
//! fixed offset. The points are stored once, as one cell of type poly-vertex. Readers use the number of
//! steps, which is stored in two headers on one page: the length of `Steps/Values` and the attribute
//! `NSteps`. Both are written together after each output, so that a killed run leaves a valid file. Until the
//! first output the file has another name, because a file without steps cannot be read.

mod reader;

pub use reader::VtkHdfReader;

use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::hdf5::{Kind, MOST_MEMBERS, Object, Skeleton, Type, Value, header_of};
use super::names::hdf5_names;
use super::{FieldSpec, Numbers, WriteError, check_fields, check_values, unsuitable};

/// Maximum number of outputs of a VTKHDF file: several numbers for each are kept in memory.
pub const MOST_OUTPUTS: usize = 1 << 24;

/// Page size: headers that change are written in one piece.
const PAGE: u64 = 4096;

/// Part of a page reserved for the header of the values, bytes; the header of the steps follows.
const HALF: u64 = 512;

/// Content of a VTKHDF file.
#[derive(Debug, Clone)]
pub struct VtkHdfLayout<'a> {
    /// Number of coordinates per point.
    pub dimension: usize,
    /// Positions, component-major, m.
    pub positions: &'a [f64],
    /// Fields on the points. Slashes in their names, which HDF5 does not allow, become underscores.
    pub fields: Vec<FieldSpec>,
    /// Constant fields with their component-major values: volumes, materials.
    pub constants: Vec<(FieldSpec, &'a [f64])>,
    /// Number of outputs of the whole run.
    pub outputs: usize,
    /// Whether numbers are written in single precision.
    pub is_single: bool,
}

impl VtkHdfLayout<'_> {
    fn points(&self) -> usize {
        self.positions.len() / self.dimension.max(1)
    }

    fn check(&self) -> Result<(), WriteError> {
        if !(1..=3).contains(&self.dimension)
            || self.positions.is_empty()
            || !self.positions.len().is_multiple_of(self.dimension)
        {
            return unsuitable(format!(
                "{} coordinates are given for points of {} dimensions",
                self.positions.len(),
                self.dimension
            ));
        }
        if !(1..=MOST_OUTPUTS).contains(&self.outputs) {
            let outputs = self.outputs;
            return unsuitable(format!(
                "the number of outputs is {outputs}; allowed: 1 to {MOST_OUTPUTS}"
            ));
        }
        let constants = self.constants.iter().map(|(field, _)| field);
        let all: Vec<&FieldSpec> = self.fields.iter().chain(constants).collect();
        check_fields(all.iter().copied())?;
        for (field, values) in &self.constants {
            check_values(std::slice::from_ref(field), &[values], self.points())?;
        }
        if all.len() > MOST_MEMBERS {
            return unsuitable(format!(
                "{} fields are given; allowed: at most {MOST_MEMBERS}",
                all.len()
            ));
        }
        for (k, field) in all.iter().enumerate() {
            if all[..k].iter().any(|other| other.name == field.name) {
                return unsuitable(format!("two fields have the name {:?}", field.name));
            }
        }
        Ok(())
    }
}

/// Offsets of values in the file.
struct Plan {
    skeleton: Skeleton,
    file_bytes: u64,
    values: Object,
    steps: Object,
    points: u64,
    connectivity: u64,
    fields: Vec<u64>,
    constants: Vec<u64>,
    /// Small arrays with their values.
    small: Vec<(u64, Vec<i64>)>,
    types: u64,
}

/// Allocates offsets of data after the metadata.
struct Space {
    next: u64,
}

impl Space {
    fn dataset(
        &mut self,
        name: &str,
        kind: Type,
        lengths: &[u64],
    ) -> Result<(Object, u64), WriteError> {
        let bytes = lengths
            .iter()
            .try_fold(kind.bytes(), |bytes, &length| bytes.checked_mul(length));
        let place = self.next.next_multiple_of(64);
        let end = bytes.and_then(|bytes| place.checked_add(bytes));
        let (Some(bytes), Some(end)) = (bytes, end.filter(|&end| end < 1 << 62)) else {
            return unsuitable(format!("{name} would exceed the maximum file size"));
        };
        self.next = end;
        let object = Object {
            name: name.to_owned(),
            attributes: Vec::new(),
            kind: Kind::Dataset(kind, lengths.to_vec(), place, bytes),
            header: None,
        };
        Ok((object, place))
    }
}

/// Returns the shape of an array with a number of rows.
fn lengths(rows: u64, field: &FieldSpec) -> Vec<u64> {
    match field.columns() {
        1 => vec![rows],
        columns => vec![rows, columns as u64],
    }
}

/// Size of the metadata for usual numbers of fields.
const METADATA: u64 = 1 << 18;

impl Plan {
    fn new(layout: &VtkHdfLayout<'_>) -> Result<Self, WriteError> {
        let plan = Self::with_metadata(layout, METADATA)?;
        // The size of the metadata does not depend on the offsets of the data.
        match plan.skeleton.bytes().len() as u64 {
            0..=METADATA => Ok(plan),
            needed => Self::with_metadata(layout, needed.next_multiple_of(PAGE)),
        }
    }

    /// Lays the file out with space for metadata of a size.
    fn with_metadata(layout: &VtkHdfLayout<'_>, metadata: u64) -> Result<Self, WriteError> {
        let (n, outputs) = (layout.points() as u64, layout.outputs as u64);
        let real = if layout.is_single {
            Type::F32
        } else {
            Type::F64
        };
        let mut space = Space { next: metadata };
        let mut small = Vec::new();
        let mut small_array =
            |space: &mut Space, name: &str, lengths: &[u64], numbers: Vec<i64>| {
                let (object, place) = space.dataset(name, Type::I64, lengths)?;
                small.push((place, numbers));
                Ok::<Object, WriteError>(object)
            };
        let zeros = || vec![0; layout.outputs];
        let (values, _) = space.dataset("Values", Type::F64, &[outputs])?;
        let values = values.at(PAGE);
        let mut steps = vec![
            small_array(
                &mut space,
                "NumberOfParts",
                &[outputs],
                vec![1; layout.outputs],
            )?,
            small_array(&mut space, "PartOffsets", &[outputs], zeros())?,
            small_array(&mut space, "PointOffsets", &[outputs], zeros())?,
            small_array(&mut space, "CellOffsets", &[outputs, 1], zeros())?,
            small_array(&mut space, "ConnectivityIdOffsets", &[outputs, 1], zeros())?,
        ];
        let constants = layout.constants.iter().map(|(field, _)| field);
        let given = layout.fields.iter().chain(constants);
        let names = hdf5_names(given.map(|field| field.name.as_str()));
        let (field_names, constant_names) = names.split_at(layout.fields.len());
        let mut offsets = Vec::new();
        for name in field_names {
            let rows = (0..outputs).map(|k| (k * n) as i64).collect();
            offsets.push(small_array(&mut space, name, &[outputs], rows)?);
        }
        for name in constant_names {
            offsets.push(small_array(&mut space, name, &[outputs], zeros())?);
        }
        let count = |number: u64| vec![number as i64];
        let mut members = vec![
            small_array(&mut space, "NumberOfPoints", &[1], count(n))?,
            small_array(&mut space, "NumberOfCells", &[1], count(1))?,
            small_array(&mut space, "NumberOfConnectivityIds", &[1], count(n))?,
            small_array(&mut space, "Offsets", &[2], vec![0, n as i64])?,
        ];
        let (types, types_place) = space.dataset("Types", Type::U8, &[1])?;
        let (points, points_place) = space.dataset("Points", real, &[n, 3])?;
        let (connectivity, connectivity_place) = space.dataset("Connectivity", Type::I64, &[n])?;
        members.extend([types, points, connectivity]);
        let (mut data, mut fields, mut constants) = (vec![], vec![], vec![]);
        for ((field, _), name) in layout.constants.iter().zip(constant_names) {
            let (object, place) = space.dataset(name, real, &lengths(n, field))?;
            data.push(object);
            constants.push(place);
        }
        for (field, name) in layout.fields.iter().zip(field_names) {
            let (object, place) = space.dataset(name, real, &lengths(outputs * n, field))?;
            data.push(object);
            fields.push(place);
        }
        steps.push(values.clone());
        steps.push(Object::group("PointDataOffsets", offsets));
        let steps = Object::group("Steps", steps)
            .with("NSteps", Value::Number(layout.outputs as i64))
            .at(PAGE + HALF);
        members.push(Object::group("PointData", data));
        members.push(steps.clone());
        let root = Object::group(
            "/",
            vec![
                Object::group("VTKHDF", members)
                    .with("Version", Value::Numbers(vec![2, 0]))
                    .with("Type", Value::Text("UnstructuredGrid")),
            ],
        );
        let skeleton = Skeleton::new(&root, 2 * PAGE as usize, space.next);
        Ok(Self {
            skeleton,
            file_bytes: space.next,
            values,
            steps,
            points: points_place,
            connectivity: connectivity_place,
            fields,
            constants,
            small,
            types: types_place,
        })
    }

    /// Returns the number of outputs in a file with this layout.
    fn outputs_in(&self, file: &mut File, most: usize) -> Result<usize, WriteError> {
        let other = || WriteError::NotContinued("its layout belongs to another run".into());
        if file.metadata()?.len() != self.file_bytes {
            return Err(other());
        }
        let ours = self.skeleton.bytes();
        let mut found = vec![0; ours.len()];
        file.read_exact(&mut found)?;
        // Only the number of steps may differ.
        let (page, length) = (PAGE as usize, self.page(1).len());
        let held = (1..=most).find(|&k| found[page..page + length] == self.page(k as u64));
        let same = found[..page] == ours[..page] && found[page + length..] == ours[page + length..];
        held.filter(|_| same).ok_or_else(other)
    }

    /// Returns the page with the two headers that contain the number of steps.
    fn page(&self, outputs: u64) -> Vec<u8> {
        let mut values = self.values.clone();
        if let Kind::Dataset(_, lengths, ..) = &mut values.kind {
            *lengths = vec![outputs];
        }
        let mut steps = self.steps.clone();
        steps.attributes = vec![("NSteps", Value::Number(outputs as i64))];
        let mut page = header_of(&values, None);
        page.resize(HALF as usize, 0);
        page.extend(header_of(
            &steps,
            Some(self.skeleton.places_of(PAGE + HALF)),
        ));
        page
    }

    fn values_place(&self) -> u64 {
        match self.values.kind {
            Kind::Dataset(_, _, place, _) => place,
            Kind::Group(_) => 0,
        }
    }
}

/// A file with space for all outputs of a run.
pub struct VtkHdfWriter {
    file: File,
    plan: Plan,
    /// The name until the first output, and the name afterwards.
    hidden: Option<(PathBuf, PathBuf)>,
    fields: Vec<FieldSpec>,
    points: usize,
    numbers: Numbers,
    most: usize,
    outputs: usize,
}

/// Returns the name of a file before its first output.
fn hidden_name(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}

impl VtkHdfWriter {
    /// Creates a file without outputs; it gets its final name with the first output.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written, or the array lengths are inconsistent.
    pub fn create(path: impl AsRef<Path>, layout: &VtkHdfLayout<'_>) -> Result<Self, WriteError> {
        layout.check()?;
        let path = path.as_ref();
        let plan = Plan::new(layout)?;
        let hidden = hidden_name(path);
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(true)
            .open(&hidden)?;
        file.write_all(plan.skeleton.bytes())?;
        // Readers reject a file that is shorter than declared; on most systems, unwritten parts take no disk
        // space.
        file.set_len(plan.file_bytes)?;
        let mut writer = Self::of(file, plan, layout);
        writer.hidden = Some((hidden, path.to_path_buf()));
        writer.write_constants(layout)?;
        Ok(writer)
    }

    fn of(file: File, plan: Plan, layout: &VtkHdfLayout<'_>) -> Self {
        Self {
            file,
            plan,
            hidden: None,
            fields: layout.fields.clone(),
            points: layout.points(),
            numbers: Numbers {
                is_single: layout.is_single,
                is_little: true,
            },
            most: layout.outputs,
            outputs: 0,
        }
    }

    fn write_constants(&mut self, layout: &VtkHdfLayout<'_>) -> Result<(), WriteError> {
        let n = self.points;
        for (place, numbers) in &self.plan.small {
            let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
            self.file.seek(SeekFrom::Start(*place))?;
            self.file.write_all(&bytes)?;
        }
        self.file.seek(SeekFrom::Start(self.plan.types))?;
        // Cell type poly-vertex.
        self.file.write_all(&[2])?;
        let positions = layout.positions;
        let coordinate = |k: usize| match k % 3 < layout.dimension {
            true => positions[(k % 3) * n + k / 3],
            false => 0.0,
        };
        self.numbers
            .write_at(&mut self.file, self.plan.points, 3 * n, coordinate)?;
        self.file.seek(SeekFrom::Start(self.plan.connectivity))?;
        for begin in (0..n as u64).step_by(8192) {
            let end = (begin + 8192).min(n as u64);
            let bytes: Vec<u8> = (begin..end).flat_map(u64::to_le_bytes).collect();
            self.file.write_all(&bytes)?;
        }
        for ((field, values), &place) in layout.constants.iter().zip(&self.plan.constants) {
            write_rows(&mut self.file, self.numbers, place, field, values, n)?;
        }
        Ok(())
    }

    /// Continues a file after a number of outputs.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written, has another layout, or contains fewer outputs.
    pub fn resume(
        path: impl AsRef<Path>,
        layout: &VtkHdfLayout<'_>,
        outputs: usize,
    ) -> Result<Self, WriteError> {
        if outputs == 0 {
            let path = path.as_ref();
            let writer = Self::create(path, layout)?;
            if path.exists() {
                std::fs::remove_file(path)?;
            }
            return Ok(writer);
        }
        layout.check()?;
        let plan = Plan::new(layout)?;
        let mut file = OpenOptions::new().read(true).write(true).open(path)?;
        let held = plan.outputs_in(&mut file, layout.outputs)?;
        if held < outputs {
            return Err(WriteError::NotContinued(format!(
                "it contains {held} outputs; expected at least {outputs}"
            )));
        }
        let mut writer = Self::of(file, plan, layout);
        writer.outputs = outputs;
        writer.publish()?;
        Ok(writer)
    }

    /// Syncs the file to disk.
    ///
    /// # Errors
    /// Returns the error of the operating system.
    pub fn sync(&self) -> std::io::Result<()> {
        self.file.sync_data()
    }

    /// Returns the number of outputs.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Writes an output: the time (s), and a component-major array for each field.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written, the array lengths are inconsistent, or the number of
    /// outputs is exceeded.
    pub fn append(&mut self, time: f64, values: &[&[f64]]) -> Result<(), WriteError> {
        check_values(&self.fields, values, self.points)?;
        if self.outputs == self.most {
            return unsuitable(format!(
                "the file has space for {} outputs, which are all written",
                self.most
            ));
        }
        let output = self.outputs as u64;
        for ((field, values), place) in self.fields.iter().zip(values).zip(&self.plan.fields) {
            let row = field.columns() as u64 * self.numbers.bytes();
            let place = place + output * self.points as u64 * row;
            write_rows(
                &mut self.file,
                self.numbers,
                place,
                field,
                values,
                self.points,
            )?;
        }
        self.file
            .seek(SeekFrom::Start(self.plan.values_place() + 8 * output))?;
        self.file.write_all(&time.to_le_bytes())?;
        self.outputs += 1;
        self.publish()
    }

    /// Updates the number of steps, and renames the file after the first output.
    fn publish(&mut self) -> Result<(), WriteError> {
        self.file.seek(SeekFrom::Start(PAGE))?;
        self.file.write_all(&self.plan.page(self.outputs as u64))?;
        if let Some((hidden, path)) = self.hidden.take() {
            std::fs::rename(hidden, path)?;
        }
        Ok(())
    }
}

/// Writes a field point by point.
fn write_rows(
    file: &mut File,
    numbers: Numbers,
    place: u64,
    field: &FieldSpec,
    values: &[f64],
    points: usize,
) -> Result<(), WriteError> {
    let columns = field.columns();
    let number = |k: usize| match k % columns < field.components {
        true => values[(k % columns) * points + k / columns],
        false => 0.0,
    };
    numbers.write_at(file, place, columns * points, number)?;
    Ok(())
}
