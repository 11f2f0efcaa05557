//! Reading of fields from VTK XML files, to compare runs and to re-render fields.

use std::path::Path;

use pericles_mesh::FieldData;

use super::error::{MeshError, fault_of};
use crate::whole::read_whole;

/// Reads the points and point data of a `.vtu` or `.vtp` file.
///
/// # Errors
/// Returns an error if the file cannot be read or exceeds `memory` bytes, is not VTK XML, or has arrays that
/// are damaged or do not match the number of points.
pub fn read_fields(path: impl AsRef<Path>, memory: u64) -> Result<FieldData, MeshError> {
    let path = path.as_ref();
    parse_fields(path, &read_whole(path, 1, memory)?, memory)
}

/// Parses the content of a `.vtu` or `.vtp` file; `name` is used in messages.
///
/// # Errors
/// As [`read_fields`], except for errors of reading the file.
pub fn parse_fields(
    name: impl AsRef<Path>,
    content: &[u8],
    memory: u64,
) -> Result<FieldData, MeshError> {
    pericles_mesh::parse_fields(content, memory)
        .map_err(|fault| fault_of(fault, name.as_ref(), memory))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{IoError, VtkField, VtuFile};

    #[test]
    fn written_fields_are_read_back() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a.vtu");
        // Component-major, the layout of Pericles.
        let (x, damage, u) = (
            [0.0, 1.0, 2.0, 0.5, 0.25, 0.125],
            [0.0, 0.5, 1.0],
            [1e-9, 2e-9, 3e-9, 4.0, 5.0, 6.0],
        );
        VtuFile::new(2, &x)
            .time(1.5e-6)
            .field(VtkField::scalar("Damage", &damage))
            .field(VtkField::vector("Displacement", &u))
            .write(&path)
            .unwrap();
        let data = read_fields(&path, u64::MAX).unwrap();
        assert_eq!(data.time, Some(1.5e-6));
        assert_eq!(
            data.points,
            [0.0, 0.5, 0.0, 1.0, 0.25, 0.0, 2.0, 0.125, 0.0]
        );
        assert_eq!(data.field("Damage").unwrap().values, damage);
        let displacement = data.field("Displacement").unwrap();
        assert_eq!(displacement.components, 3);
        assert_eq!(
            displacement.values,
            [1e-9, 4.0, 0.0, 2e-9, 5.0, 0.0, 3e-9, 6.0, 0.0]
        );
        assert!(data.field("Velocity").is_none());
    }

    #[test]
    fn compressed_arrays_beyond_the_memory_limit_are_rejected_before_decoding() {
        const POINTS: usize = 200_000;
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("zeros.vtu");
        VtuFile::new(1, &vec![0.0; POINTS]).write(&path).unwrap();
        let size = std::fs::metadata(&path).unwrap().len();
        // Positions of three numbers: the bytes and the numbers decoded from them.
        let needed = 2 * 24 * POINTS as u64;
        assert!(10 * size < needed, "{size}");
        assert!(read_fields(&path, needed + size).is_ok());
        for memory in [size, needed - 1] {
            let error = read_fields(&path, memory).unwrap_err();
            let found = matches!(error, MeshError::Io(IoError::TooLarge { needed: n, .. }) if n == needed + size);
            assert!(found, "{error}");
        }
        let error = read_fields(&path, size - 1).unwrap_err();
        assert!(
            matches!(error, MeshError::Io(IoError::TooLarge { .. })),
            "{error}"
        );
    }

    #[test]
    fn a_truncated_file_is_rejected_at_every_length() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a.vtu");
        let (x, damage) = ([0.0, 1.0, 2.0], [0.0, 0.5, 1.0]);
        let file = VtuFile::new(1, &x).field(VtkField::scalar("Damage", &damage));
        file.write(&path).unwrap();
        let whole = std::fs::read(&path).unwrap();
        for length in 0..whole.len() - 1 {
            assert!(
                parse_fields("a.vtu", &whole[..length], u64::MAX).is_err(),
                "{length} of {}",
                whole.len()
            );
        }
        assert!(parse_fields("a.vtu", &whole, u64::MAX).is_ok());
    }
}
