//! CSV tables: one header row with units, then one row per output.
//!
//! ```text
//! step,time [s],kinetic [J],tip x [m]
//! 0,0.0,0.0,
//! 400,1e-6,3.2147,0.05
//! ```
//! Real numbers are written with the fewest digits that read back to the same value; NaN is an empty cell.
//! Header cells with commas or quotes are quoted (RFC 4180). On resume a table is truncated to the length
//! recorded in the checkpoint and continued, so that it equals the table of an uninterrupted run.
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
