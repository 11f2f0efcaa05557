//! Reading of whole files within a memory limit.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::IoError;

/// Reads a file whose content will take `expansion` times its size in memory, within a limit of `memory` bytes.
///
/// # Errors
/// Returns an error if the file cannot be read or exceeds the limit: by its length before reading, or without
/// a length (a pipe, a device) while reading.
pub(crate) fn read_whole(path: &Path, expansion: u64, memory: u64) -> Result<Vec<u8>, IoError> {
    let reading = |source| IoError::reading(path, source);
    let file = File::open(path).map_err(reading)?;
    let length = file.metadata().map_err(reading)?.len();
    let most = memory / expansion;
    if length > most {
        return Err(IoError::TooLarge {
            path: path.to_path_buf(),
            needed: length.saturating_mul(expansion),
            memory,
        });
    }
    let mut content = Vec::new();
    file.take(most.saturating_add(1))
        .read_to_end(&mut content)
        .map_err(reading)?;
    if content.len() as u64 > most {
        return Err(IoError::TooLarge {
            path: path.to_path_buf(),
            needed: memory.saturating_add(1),
            memory,
        });
    }
    Ok(content)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_beyond_the_memory_limit_is_rejected_by_its_length() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("points.txt");
        std::fs::write(&path, [b' '; 1000]).unwrap();
        assert_eq!(read_whole(&path, 4, 4000).unwrap().len(), 1000);
        let error = read_whole(&path, 4, 3999).unwrap_err();
        assert!(
            matches!(
                &error,
                IoError::TooLarge {
                    needed: 4000,
                    memory: 3999,
                    ..
                }
            ),
            "{error}"
        );
        let says = error.to_string();
        assert!(says.contains("points.txt needs about 4.00 kB"), "{says}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn an_endless_device_is_rejected() {
        let error = read_whole(Path::new("/dev/zero"), 1, 100_000).unwrap_err();
        assert!(matches!(error, IoError::TooLarge { .. }), "{error}");
    }
}
