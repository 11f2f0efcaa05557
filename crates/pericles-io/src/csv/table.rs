//! CSV table written during a run.

use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::io::{BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::column::{Cell, Column, header_row};
use crate::IoError;

/// A CSV table to which rows are appended.
#[derive(Debug)]
pub struct CsvTable {
    path: PathBuf,
    file: BufWriter<File>,
    integers: Vec<bool>,
    length: u64,
    row: String,
}

impl CsvTable {
    /// Creates the table with its header, replacing an existing file.
    pub fn create(path: impl Into<PathBuf>, columns: &[Column]) -> Result<Self, IoError> {
        let path = path.into();
        let header = header_row(&path, columns)?;
        let file = File::create(&path).map_err(|source| IoError::writing(&path, source))?;
        let mut table = Self::new(path, file, columns, 0);
        table.row = header;
        table.write_row()?;
        table.flush()?;
        Ok(table)
    }

    /// Reopens a table to continue after its first `length` bytes (see [`len_bytes`](Self::len_bytes)); later
    /// bytes are removed.
    ///
    /// Returns an error if the header differs, the file is shorter, or no row ends at `length`.
    pub fn reopen(
        path: impl Into<PathBuf>,
        columns: &[Column],
        length: u64,
    ) -> Result<Self, IoError> {
        let path = path.into();
        let header = header_row(&path, columns)?;
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .open(&path)
            .map_err(|source| match source.kind() {
                std::io::ErrorKind::NotFound => IoError::reading(&path, source),
                _ => IoError::writing(&path, source),
            })?;
        let reading = |source| IoError::reading(&path, source);

        let found = file.metadata().map_err(reading)?.len();
        if found < length {
            let reason =
                format!("it has {found} bytes, but the checkpoint expects at least {length}");
            return Err(IoError::damaged(&path, reason));
        }
        let mut start = Vec::new();
        (&mut file)
            .take(header.len() as u64)
            .read_to_end(&mut start)
            .map_err(reading)?;
        if start != header.as_bytes() || length < header.len() as u64 {
            let reason = format!("its header is not {:?}", header.trim_end());
            return Err(IoError::damaged(&path, reason));
        }
        let mut last = [0];
        file.seek(SeekFrom::Start(length - 1)).map_err(reading)?;
        file.read_exact(&mut last).map_err(reading)?;
        if last != *b"\n" {
            let reason = format!("no row ends at byte {length}");
            return Err(IoError::damaged(&path, reason));
        }
        let writing = |source| IoError::writing(&path, source);
        file.set_len(length).map_err(writing)?;
        file.seek(SeekFrom::End(0)).map_err(writing)?;
        Ok(Self::new(path, file, columns, length))
    }

    fn new(path: PathBuf, file: File, columns: &[Column], length: u64) -> Self {
        Self {
            path,
            file: BufWriter::new(file),
            integers: columns.iter().map(|column| column.integer).collect(),
            length,
            row: String::new(),
        }
    }

    /// Appends a row: one cell per column, integers in integer columns.
    pub fn append(&mut self, cells: &[Cell]) -> Result<(), IoError> {
        if cells.len() != self.integers.len() {
            return Err(IoError::Shape {
                path: self.path.clone(),
                what: "a row".into(),
                expected: self.integers.len(),
                given: cells.len(),
            });
        }
        self.row.clear();
        for (number, (cell, &integer)) in cells.iter().zip(&self.integers).enumerate() {
            if number > 0 {
                self.row.push(',');
            }
            // Writing into a String cannot fail.
            let _ = match *cell {
                Cell::Integer(value) if integer => write!(self.row, "{value}"),
                Cell::Real(value) if !integer && value.is_nan() => Ok(()),
                Cell::Real(value) if !integer => write!(self.row, "{value:?}"),
                _ => {
                    let kind = if integer { "whole" } else { "real" };
                    return Err(IoError::Unsuitable {
                        path: self.path.clone(),
                        reason: format!("column {} allows only {kind} numbers", number + 1),
                    });
                }
            };
        }
        self.row.push('\n');
        self.write_row()
    }

    /// Flushes all rows to the operating system, so that other programs see them.
    pub fn flush(&mut self) -> Result<(), IoError> {
        self.file
            .flush()
            .map_err(|source| IoError::writing(&self.path, source))
    }

    /// Flushes and syncs all rows to disk; call it before a checkpoint records the length.
    pub fn sync(&mut self) -> Result<(), IoError> {
        self.flush()?;
        self.file
            .get_ref()
            .sync_data()
            .map_err(|source| IoError::writing(&self.path, source))
    }

    /// Returns the current length of the table in bytes, including rows not yet flushed.
    pub fn len_bytes(&self) -> u64 {
        self.length
    }

    /// Returns the path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn write_row(&mut self) -> Result<(), IoError> {
        self.file
            .write_all(self.row.as_bytes())
            .map_err(|source| IoError::writing(&self.path, source))?;
        self.length += self.row.len() as u64;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::read_csv;
    use super::*;
    use proptest::prelude::*;
    use std::fs;

    fn columns() -> [Column; 3] {
        [
            Column::integer("step"),
            Column::real("time", "s"),
            Column::real("reaction \"left\", x", "N"),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn a_table_is_read_back_bit_for_bit(rows in prop::collection::vec(
            (-(1_i64 << 53)..(1 << 53), any::<f64>(), any::<f64>()), 0..20))
        {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("t.csv");
            let mut table = CsvTable::create(&path, &columns()).unwrap();
            for &(step, time, force) in &rows {
                table.append(&[step.into(), time.into(), force.into()]).unwrap();
            }
            table.flush().unwrap();
            prop_assert_eq!(table.len_bytes(), fs::metadata(&path).unwrap().len());
            let read = read_csv(&path).unwrap();
            prop_assert_eq!(read.rows(), rows.len());
            prop_assert_eq!(read.columns[2].unit(), "N");
            for (row, &(step, time, force)) in rows.iter().enumerate() {
                prop_assert_eq!(read.column("step").unwrap()[row], step as f64);
                for (name, value) in [("time", time), ("reaction \"left\", x", force)] {
                    let found = read.column(name).unwrap()[row];
                    // every NaN is written as an empty cell
                    prop_assert!(found.to_bits() == value.to_bits() || (found.is_nan() && value.is_nan()));
                }
            }
        }
    }

    #[test]
    fn the_text_matches_the_module_documentation() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        let mut table = CsvTable::create(&path, &columns()).unwrap();
        let row = [400.into(), 1e-6.into(), f64::NAN.into()];
        table.append(&row).unwrap();
        table
            .append(&[(-1).into(), 0.1.into(), (-0.0).into()])
            .unwrap();
        table.sync().unwrap();
        assert_eq!(
            fs::read_to_string(&path).unwrap(),
            "step,time [s],\"reaction \"\"left\"\", x [N]\"\n400,1e-6,\n-1,0.1,-0.0\n"
        );
    }

    #[test]
    fn a_resumed_table_equals_an_uninterrupted_one() {
        let folder = tempfile::tempdir().unwrap();
        let append = |table: &mut CsvTable, steps: std::ops::Range<i64>| {
            for step in steps {
                let time = step as f64 * 0.3;
                table
                    .append(&[step.into(), time.into(), time.sin().into()])
                    .unwrap();
            }
        };
        let whole = folder.path().join("whole.csv");
        append(&mut CsvTable::create(&whole, &columns()).unwrap(), 0..100);

        let parts = folder.path().join("parts.csv");
        let mut table = CsvTable::create(&parts, &columns()).unwrap();
        append(&mut table, 0..37);
        let length = table.len_bytes();
        append(&mut table, 37..61);
        drop(table);
        append(
            &mut CsvTable::reopen(&parts, &columns(), length).unwrap(),
            37..100,
        );
        assert_eq!(fs::read(&whole).unwrap(), fs::read(&parts).unwrap());
    }

    #[test]
    fn a_table_with_another_header_or_length_is_not_reopened() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        let mut table = CsvTable::create(&path, &columns()).unwrap();
        let header = table.len_bytes();
        table.append(&[1.into(), 2.5.into(), 3.5.into()]).unwrap();
        let length = table.len_bytes();
        drop(table);
        let rejected = |columns: &[Column], length| {
            let error = CsvTable::reopen(&path, columns, length).unwrap_err();
            assert!(matches!(error, IoError::Damaged { .. }), "{error}");
            assert_eq!(fs::metadata(&path).unwrap().len(), header + 10);
        };
        rejected(&columns(), length + 1);
        rejected(&columns(), length - 1);
        rejected(&columns(), 0);
        rejected(&columns(), header - 1);
        rejected(&columns()[..2], length);
        CsvTable::reopen(&path, &columns(), length).unwrap();
        let gone = CsvTable::reopen(folder.path().join("gone.csv"), &columns(), 1);
        assert!(matches!(gone, Err(IoError::NotFound { .. })));
    }

    #[test]
    fn rows_of_the_wrong_shape_are_rejected() {
        let folder = tempfile::tempdir().unwrap();
        let mut table = CsvTable::create(folder.path().join("t.csv"), &columns()).unwrap();
        let before = table.len_bytes();
        let short = table.append(&[1.into()]);
        assert!(matches!(
            short,
            Err(IoError::Shape {
                expected: 3,
                given: 1,
                ..
            })
        ));
        let kinds = table.append(&[1.0.into(), 1.0.into(), 1.0.into()]);
        assert!(matches!(kinds, Err(IoError::Unsuitable { .. })));
        assert_eq!(table.len_bytes(), before);
    }

    #[test]
    fn a_table_with_a_malformed_row_is_rejected() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        for text in ["", "a,b\n1\n", "a\nx\n", "\"a\n1\n"] {
            fs::write(&path, text).unwrap();
            let read = read_csv(&path);
            assert!(
                matches!(read, Err(IoError::Damaged { .. })),
                "{text:?} {read:?}"
            );
        }
    }
}
