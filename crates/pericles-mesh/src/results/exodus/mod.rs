//! Writer of Exodus II files, one output at a time.
//!
//! The file is CDF-2: a header, constant values, then one record per output. A record is appended before the
//! number of records is updated, so that a killed run leaves a valid file. To resume, the file is truncated
//! after a number of records.

mod description;

use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

use self::description::{Description, write_fixed};
use super::cdf::Places;
use super::{FieldSpec, Numbers, WriteError, check_fields, check_values, unsuitable};

/// A named list of points.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PointList {
    /// Name.
    pub name: String,
    /// The points, from 0.
    pub points: Vec<u32>,
}

/// Content of an Exodus file.
#[derive(Debug, Clone)]
pub struct ExodusLayout<'a> {
    /// Title of at most 80 characters.
    pub title: String,
    /// Number of coordinates per point.
    pub dimension: usize,
    /// Positions, component-major, m.
    pub positions: &'a [f64],
    /// Volumes of the points, m³.
    pub volumes: &'a [f64],
    /// Blocks, such as materials; every point belongs to exactly one.
    pub blocks: Vec<PointList>,
    /// Node sets.
    pub sets: Vec<PointList>,
    /// Names of global values.
    pub globals: Vec<String>,
    /// Fields on the points.
    pub fields: Vec<FieldSpec>,
    /// Whether fields are written in single precision.
    pub is_single: bool,
}

impl ExodusLayout<'_> {
    fn points(&self) -> usize {
        self.volumes.len()
    }

    fn check(&self) -> Result<(), WriteError> {
        check_fields(&self.fields)?;
        let points = self.points();
        if points == 0 {
            return unsuitable("there are no points");
        }
        if !(1..=3).contains(&self.dimension) || self.positions.len() != self.dimension * points {
            return unsuitable(format!(
                "{} coordinates are given for {points} points of {} dimensions",
                self.positions.len(),
                self.dimension
            ));
        }
        let mut seen = vec![false; points];
        for &point in self.blocks.iter().flat_map(|block| &block.points) {
            match seen.get_mut(point as usize) {
                Some(seen) if !*seen => *seen = true,
                Some(_) => return unsuitable(format!("point {point} is in two blocks")),
                None => {
                    return unsuitable(format!(
                        "a block refers to point {point}, but there are only {points} points"
                    ));
                }
            }
        }
        if let Some(point) = seen.iter().position(|seen| !seen) {
            return unsuitable(format!("point {point} is in no block"));
        }
        for set in &self.sets {
            if let Some(point) = set.points.iter().find(|&&p| p as usize >= points) {
                return unsuitable(format!(
                    "the set {:?} refers to point {point}, but there are only {points} points",
                    set.name
                ));
            }
        }
        Ok(())
    }
}

/// A file that grows by one record per output.
#[derive(Debug)]
pub struct ExodusWriter {
    file: File,
    places: Places,
    points: usize,
    globals: usize,
    fields: Vec<FieldSpec>,
    numbers: Numbers,
    records: u32,
}

impl ExodusWriter {
    /// Creates a file without outputs.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written, the array lengths are inconsistent, a point does not
    /// belong to exactly one block, or there are more points than the format allows.
    pub fn create(path: impl AsRef<Path>, layout: &ExodusLayout<'_>) -> Result<Self, WriteError> {
        layout.check()?;
        let Description { header, fixed, .. } = Description::new(layout)?;
        let places = header.places()?;
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(true)
            .open(path)?;
        file.write_all(&places.header)?;
        for (variable, values) in &fixed {
            write_fixed(&mut file, places.begins[*variable], values, layout)?;
        }
        file.set_len(places.first_record)?;
        Ok(Self::of(file, places, layout, 0))
    }

    fn of(file: File, places: Places, layout: &ExodusLayout<'_>, records: u32) -> Self {
        Self {
            file,
            places,
            points: layout.points(),
            globals: layout.globals.len(),
            fields: layout.fields.clone(),
            numbers: Numbers {
                is_single: layout.is_single,
                is_little: false,
            },
            records,
        }
    }

    /// Continues a file after a number of outputs; later content is removed.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written, has another layout, or contains fewer outputs.
    pub fn resume(
        path: impl AsRef<Path>,
        layout: &ExodusLayout<'_>,
        outputs: usize,
    ) -> Result<Self, WriteError> {
        layout.check()?;
        let places = Description::new(layout)?.header.places()?;
        let mut file = OpenOptions::new().read(true).write(true).open(path)?;
        let found = records_of(&mut file, &places)?;
        let needed = u32::try_from(outputs).unwrap_or(u32::MAX);
        let end = places.first_record + u64::from(needed) * places.record_bytes;
        if found < needed || file.metadata()?.len() < end {
            return Err(WriteError::NotContinued(format!(
                "it contains {found} outputs; expected at least {needed}"
            )));
        }
        let mut writer = Self::of(file, places, layout, needed);
        writer.publish()?;
        writer.file.set_len(end)?;
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
        self.records as usize
    }

    /// Writes an output: the time (s), global values, and a component-major array for each field.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written or the array lengths are inconsistent.
    pub fn append(
        &mut self,
        time: f64,
        globals: &[f64],
        values: &[&[f64]],
    ) -> Result<(), WriteError> {
        check_values(&self.fields, values, self.points)?;
        if globals.len() != self.globals {
            return unsuitable(format!(
                "{} global values are given; expected {}",
                globals.len(),
                self.globals
            ));
        }
        let mut place = self.record(self.outputs());
        let doubles = Numbers {
            is_single: false,
            is_little: false,
        };
        doubles.write_at(&mut self.file, place, 1, |_| time)?;
        place += 8;
        doubles.write_at(&mut self.file, place, globals.len(), |k| globals[k])?;
        place += 8 * globals.len() as u64;
        let points = self.points;
        for (field, values) in self.fields.iter().zip(values) {
            for column in 0..field.columns() {
                let number = |i: usize| match column < field.components {
                    true => values[column * points + i],
                    false => 0.0,
                };
                self.numbers
                    .write_at(&mut self.file, place, points, number)?;
                place += self.numbers.bytes() * points as u64;
            }
        }
        self.records += 1;
        self.publish()
    }

    /// Returns the offset of a record.
    fn record(&self, number: usize) -> u64 {
        self.places.first_record + number as u64 * self.places.record_bytes
    }

    /// Updates the number of records in the header.
    fn publish(&mut self) -> Result<(), WriteError> {
        self.file.seek(SeekFrom::Start(4))?;
        self.file.write_all(&self.records.to_be_bytes())?;
        Ok(())
    }
}

/// Returns the number of outputs in a file with the header of a layout.
fn records_of(file: &mut File, places: &Places) -> Result<u32, WriteError> {
    let mut begin = vec![0; places.header.len()];
    let other = || WriteError::NotContinued("its header belongs to another run".into());
    file.read_exact(&mut begin).map_err(|_| other())?;
    if begin[..4] != places.header[..4] || begin[8..] != places.header[8..] {
        return Err(other());
    }
    Ok(u32::from_be_bytes([begin[4], begin[5], begin[6], begin[7]]))
}

/// Reader of a file that [`ExodusWriter`] has written.
#[derive(Debug)]
pub struct ExodusReader(ExodusWriter);

impl ExodusReader {
    /// Opens a file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or has another layout.
    pub fn open(path: impl AsRef<Path>, layout: &ExodusLayout<'_>) -> Result<Self, WriteError> {
        layout.check()?;
        let places = Description::new(layout)?.header.places()?;
        let mut file = File::open(path)?;
        let records = records_of(&mut file, &places)?;
        Ok(Self(ExodusWriter::of(file, places, layout, records)))
    }

    /// Returns the number of outputs.
    pub fn outputs(&self) -> usize {
        self.0.outputs()
    }

    /// Reads the time of an output, s, and a component-major array for each field.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or does not have such an output.
    pub fn read(&mut self, output: usize) -> Result<(f64, Vec<Vec<f64>>), WriteError> {
        let Self(own) = self;
        let mut place = own.record(output);
        let doubles = Numbers {
            is_single: false,
            is_little: false,
        };
        let time = doubles.read_at(&mut own.file, place, 1)?[0];
        place += 8 * (1 + own.globals as u64);
        let mut all = Vec::new();
        for field in &own.fields {
            let mut values =
                own.numbers
                    .read_at(&mut own.file, place, field.columns() * own.points)?;
            place += own.numbers.bytes() * values.len() as u64;
            values.truncate(field.components * own.points);
            all.push(values);
        }
        Ok((time, all))
    }
}
