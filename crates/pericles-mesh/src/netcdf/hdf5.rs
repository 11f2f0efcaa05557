//! netCDF-4 files: HDF5 files whose datasets are dimensions and variables.
//!
//! A dimension is a dataset with the attribute `CLASS = "DIMENSION_SCALE"`; its shape is the length.
//! Character arrays are datasets of strings of one byte. A variable has records if its first dimension is
//! unlimited.

use std::cell::Cell;

use hdf5_pure::{Dataset, Datatype, DatatypeByteOrder, Error, File, MaxExtent};

use super::{NetCdf, READINGS, Type, Values, Variable};
use crate::fault::Fault;
use crate::scan::Scalar;

fn damaged(error: Error) -> Fault {
    Fault::of_file(format!("the netCDF-4 file cannot be read: {error}"))
}

/// Returns the value type and whether it is little-endian; `None` for types other than numbers and characters.
fn type_of(datatype: &Datatype) -> Option<(Type, bool)> {
    let (scalar, order) = match datatype {
        Datatype::String { size: 1, .. } => return Some((Type::Character, false)),
        Datatype::FixedPoint {
            size,
            byte_order,
            layout,
        } => {
            let scalar = match (size, layout.signed) {
                (1, true) => Scalar::I8,
                (1, false) => Scalar::U8,
                (2, true) => Scalar::I16,
                (2, false) => Scalar::U16,
                (4, true) => Scalar::I32,
                (4, false) => Scalar::U32,
                (8, true) => Scalar::I64,
                (8, false) => Scalar::U64,
                _ => return None,
            };
            (scalar, byte_order)
        }
        Datatype::FloatingPoint {
            size, byte_order, ..
        } => match size {
            4 => (Scalar::F32, byte_order),
            8 => (Scalar::F64, byte_order),
            _ => return None,
        },
        _ => return None,
    };
    match order {
        DatatypeByteOrder::LittleEndian => Some((Type::Number(scalar), true)),
        DatatypeByteOrder::BigEndian => Some((Type::Number(scalar), false)),
        DatatypeByteOrder::Vax => None,
    }
}

/// Reads the dimensions and variables of a file, whose values may take up to `memory` bytes, or the size of
/// the file if that is larger.
pub(super) fn open<'a>(content: &[u8], memory: u64) -> Result<NetCdf<'a>, Fault> {
    let file = File::from_bytes(content.to_vec()).map_err(damaged)?;
    let mut records = 0;
    let (mut dimensions, mut variables) = (Vec::new(), Vec::new());
    for (name, dataset) in file.root().iter_datasets().map_err(damaged)? {
        let shape = dataset.shape().map_err(damaged)?;
        let is_unlimited = matches!(
            dataset.maxshape().map_err(damaged)?.as_deref(),
            Some([MaxExtent::Unlimited, ..])
        );
        let attributes = texts_of(&dataset)?;
        let is_dimension =
            |(key, text): &(String, String)| key == "CLASS" && text == "DIMENSION_SCALE";
        if attributes.iter().any(is_dimension) {
            let length = shape.first().copied().unwrap_or(0);
            if is_unlimited {
                records = length;
            }
            dimensions.push((name.clone(), length));
        }
        let Some((scalar, little)) = type_of(&dataset.datatype().map_err(damaged)?) else {
            continue;
        };
        let fixed = shape.iter().skip(usize::from(is_unlimited));
        variables.push(Variable {
            name,
            last_length: shape.last().copied().unwrap_or(1),
            attributes,
            scalar,
            little,
            begin: 0,
            has_records: is_unlimited,
            len: fixed.fold(1, |len: u64, &n| len.saturating_mul(n)),
        });
    }
    let size = content.len();
    Ok(NetCdf {
        values: Values::Hdf5(file),
        bytes: size,
        records,
        dimensions,
        variables,
        room: Cell::new(memory.max(READINGS.saturating_mul(size as u64))),
    })
}

/// Returns the text attributes.
fn texts_of(dataset: &Dataset) -> Result<Vec<(String, String)>, Fault> {
    let attributes = dataset.attrs().map_err(damaged)?.into_iter();
    let texts = attributes.filter_map(|(key, value)| {
        let text = value.as_str()?.trim_end_matches('\0');
        Some((key, text.to_owned()))
    });
    Ok(texts.collect())
}

/// Returns the bytes of a variable, or of one record. `room` is the maximum size of a chunk in bytes.
pub(super) fn data(
    file: &File,
    variable: &Variable,
    record: u64,
    room: u64,
) -> Result<Vec<u8>, Fault> {
    let dataset = file.dataset(&variable.name).map_err(damaged)?;
    let chunk = dataset.chunk_shape().map_err(damaged)?.unwrap_or_default();
    let chunk = chunk
        .iter()
        .fold(variable.scalar.bytes(), |bytes, &n| bytes.saturating_mul(n));
    if chunk > room {
        return Err(Fault::too_large(chunk));
    }
    let data = match variable.has_records {
        true => dataset.read_raw_rows(record, 1),
        false => dataset.read_raw(),
    };
    let data = data.map_err(damaged)?;
    match data.len() as u64 == variable.bytes() {
        true => Ok(data),
        false => Err(Fault::of_file(format!(
            "the variable {} has {} bytes; expected {}",
            variable.name,
            data.len(),
            variable.bytes()
        ))),
    }
}
