//! Tables of numbers as comma-separated text: one header row with units, then one row per output.
//!
//! ```text
//! step,time [s],kinetic [J],tip x [m]
//! 0,0.0,0.0,
//! 400,1e-6,3.2147,0.05
//! ```
//! Real numbers are written with the fewest digits that read back to the same number; NaN is an empty cell. A header cell that
//! holds a comma or a quote is quoted as in RFC 4180. A table can be cut back to a length known from a checkpoint and continued
//! there, so that the file of a stopped and resumed run equals that of an uninterrupted one.
//!
//! ```
//! use pericles_io::{Column, CsvTable, read_csv};
//! let folder = tempfile::tempdir().unwrap();
//! let path = folder.path().join("history.csv");
//! let mut table = CsvTable::create(&path, &[Column::integer("step"), Column::real("time", "s")]).unwrap();
//! table.append(&[400.into(), 1e-6.into()]).unwrap();
//! table.flush().unwrap();
//! let read = read_csv(&path).unwrap();
//! assert_eq!(read.column("time"), Some(&[1e-6][..]));
//! ```

mod column;
mod read;
mod table;

pub use column::{Cell, Column, csv_row};
pub use read::{CsvData, read_csv};
pub use table::CsvTable;
