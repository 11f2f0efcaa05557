//! Archives of NumPy arrays: `numpy.load("run.npz")["Damage"]`.
//!
//! An archive is a ZIP file of uncompressed `.npy` files. Arrays are written in blocks, so that none has to
//! fit into memory. Names are UTF-8, which bit 11 of the flags of each file states.

use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::IoError;

/// Largest size and offset in a ZIP file without the ZIP64 extensions.
const MOST: u64 = u32::MAX as u64 - 1;

/// 1980-01-01, the first date of ZIP files: the bytes of an archive depend on its arrays alone.
const DATE: u16 = 0x21;

/// Writes an archive array by array.
pub struct NpzWriter {
    path: PathBuf,
    file: BufWriter<File>,
    entries: Vec<Entry>,
    open: Option<Open>,
}

/// An array in the archive.
struct Entry {
    name: String,
    place: u64,
    size: u64,
    checksum: u32,
}

/// The array being written.
struct Open {
    name: String,
    place: u64,
    size: u64,
    left: u64,
    checksum: crc32fast::Hasher,
}

impl NpzWriter {
    /// Creates an archive; the file must not exist.
    ///
    /// # Errors
    /// Returns an error if the file cannot be created.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, IoError> {
        let path = path.as_ref();
        let file = File::create_new(path).map_err(|error| IoError::writing(path, error))?;
        Ok(Self {
            path: path.to_path_buf(),
            file: BufWriter::new(file),
            entries: Vec::new(),
            open: None,
        })
    }

    /// Begins an array of doubles with a name and a shape; the last index varies fastest.
    ///
    /// # Errors
    /// Returns an error if the previous array is incomplete, the archive exceeds 4 GiB, or the file cannot be
    /// written.
    pub fn begin(&mut self, name: &str, shape: &[usize]) -> Result<(), IoError> {
        self.check_complete()?;
        let header = header(shape);
        let numbers: u64 = shape.iter().map(|n| *n as u64).product();
        let size = 8 * numbers + header.len() as u64;
        let place = self.place()?;
        if place + size > MOST {
            return Err(self.unsuitable(
                "the archive would exceed the limit of 4 GiB; export to exodus or vtkhdf, or write fewer fields",
            ));
        }
        self.write_local(name, size, 0)?;
        let mut checksum = crc32fast::Hasher::new();
        checksum.update(&header);
        self.put(&header)?;
        self.open = Some(Open {
            name: name.to_owned(),
            place,
            size,
            left: numbers,
            checksum,
        });
        Ok(())
    }

    /// Appends values to the array.
    ///
    /// # Errors
    /// Returns an error for more values than the shape allows, or if the file cannot be written.
    pub fn write(&mut self, numbers: &[f64]) -> Result<(), IoError> {
        let Some(mut open) = self.open.take() else {
            return Err(self.unsuitable("values are written before an array is begun"));
        };
        let Some(left) = open.left.checked_sub(numbers.len() as u64) else {
            return Err(self.unsuitable("more values than the shape of the array allows"));
        };
        open.left = left;
        const BLOCK: usize = 8192;
        for block in numbers.chunks(BLOCK) {
            let bytes: Vec<u8> = block.iter().flat_map(|x| x.to_le_bytes()).collect();
            open.checksum.update(&bytes);
            self.put(&bytes)?;
        }
        if open.left > 0 {
            self.open = Some(open);
            return Ok(());
        }
        let end = self.place()?;
        let checksum = open.checksum.finalize();
        self.seek(open.place)?;
        self.write_local(&open.name, open.size, checksum)?;
        self.seek(end)?;
        self.entries.push(Entry {
            name: open.name,
            place: open.place,
            size: open.size,
            checksum,
        });
        Ok(())
    }

    /// Finishes the archive.
    ///
    /// # Errors
    /// Returns an error if an array is incomplete or the file cannot be written.
    pub fn finish(mut self) -> Result<(), IoError> {
        self.check_complete()?;
        let begin = self.place()?;
        for entry in std::mem::take(&mut self.entries) {
            let mut record = b"PK\x01\x02\x14\0\x14\0\0\x08\0\0\0\0".to_vec();
            record.extend(DATE.to_le_bytes());
            record.extend(entry.checksum.to_le_bytes());
            record.extend((entry.size as u32).to_le_bytes());
            record.extend((entry.size as u32).to_le_bytes());
            let name = file_name(&entry.name);
            record.extend((name.len() as u16).to_le_bytes());
            // No extra field or comment, first disk, no attributes.
            record.extend([0; 12]);
            record.extend((entry.place as u32).to_le_bytes());
            record.extend(name.as_bytes());
            self.entries.push(entry);
            self.put(&record)?;
        }
        let end = self.place()?;
        let count = self.entries.len() as u16;
        let mut record = b"PK\x05\x06\0\0\0\0".to_vec();
        record.extend(count.to_le_bytes());
        record.extend(count.to_le_bytes());
        record.extend(((end - begin) as u32).to_le_bytes());
        record.extend((begin as u32).to_le_bytes());
        record.extend([0; 2]);
        self.put(&record)?;
        let flushed = self.file.flush();
        flushed.map_err(|error| IoError::writing(&self.path, error))
    }

    fn check_complete(&self) -> Result<(), IoError> {
        match &self.open {
            Some(open) => {
                let reason = format!(
                    "the array {:?} is incomplete: {} values are missing",
                    open.name, open.left
                );
                Err(self.unsuitable(&reason))
            }
            None => Ok(()),
        }
    }

    /// Writes the local header of a file in the archive.
    fn write_local(&mut self, name: &str, size: u64, checksum: u32) -> Result<(), IoError> {
        let name = file_name(name);
        let mut record = b"PK\x03\x04\x14\0\0\x08\0\0\0\0".to_vec();
        record.extend(DATE.to_le_bytes());
        record.extend(checksum.to_le_bytes());
        record.extend((size as u32).to_le_bytes());
        record.extend((size as u32).to_le_bytes());
        record.extend((name.len() as u16).to_le_bytes());
        record.extend([0; 2]);
        record.extend(name.as_bytes());
        self.put(&record)
    }

    fn put(&mut self, bytes: &[u8]) -> Result<(), IoError> {
        let written = self.file.write_all(bytes);
        written.map_err(|error| IoError::writing(&self.path, error))
    }

    fn place(&mut self) -> Result<u64, IoError> {
        let place = self.file.stream_position();
        place.map_err(|error: io::Error| IoError::writing(&self.path, error))
    }

    fn seek(&mut self, place: u64) -> Result<(), IoError> {
        let moved = self.file.seek(SeekFrom::Start(place));
        moved
            .map(|_| ())
            .map_err(|error| IoError::writing(&self.path, error))
    }

    fn unsuitable(&self, reason: &str) -> IoError {
        IoError::Unsuitable {
            path: self.path.clone(),
            reason: reason.to_owned(),
        }
    }
}

fn file_name(name: &str) -> String {
    format!("{name}.npy")
}

/// Returns the header of a `.npy` file, version 1, for little-endian doubles; its length is a multiple of 64
/// bytes.
fn header(shape: &[usize]) -> Vec<u8> {
    let sides: String = shape.iter().map(|n| format!("{n},")).collect();
    let mut text =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({sides}), }}").into_bytes();
    let length = (10 + text.len() + 1).next_multiple_of(64);
    text.resize(length - 11, b' ');
    text.push(b'\n');
    let mut header = b"\x93NUMPY\x01\0".to_vec();
    header.extend((text.len() as u16).to_le_bytes());
    header.extend(text);
    header
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_at_the_offsets_given_by_the_directory() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npz");
        let mut archive = NpzWriter::create(&path).unwrap();
        archive.begin("time", &[3]).unwrap();
        archive.write(&[0.0, 0.5]).unwrap();
        assert!(archive.begin("other", &[1]).is_err());
        archive.write(&[1.0]).unwrap();
        archive.begin("u", &[3, 1, 2]).unwrap();
        archive.write(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap();
        archive.finish().unwrap();
        assert!(NpzWriter::create(&path).is_err());
        let bytes = std::fs::read(&path).unwrap();
        let u32_at = |k: usize| u32::from_le_bytes(bytes[k..k + 4].try_into().unwrap()) as usize;
        let end = bytes.len() - 22;
        assert_eq!(&bytes[end..end + 4], b"PK\x05\x06");
        let mut record = u32_at(end + 16);
        let mut found = Vec::new();
        for _ in 0..2 {
            assert_eq!(&bytes[record..record + 4], b"PK\x01\x02");
            // The flags of both headers state that the name is UTF-8.
            assert_eq!(&bytes[record + 8..record + 10], [0, 8]);
            let local = u32_at(record + 42);
            assert_eq!(&bytes[local + 6..local + 8], [0, 8]);
            let (checksum, size, place) = (
                u32_at(record + 16),
                u32_at(record + 24),
                u32_at(record + 42),
            );
            let name = u32_at(record + 28) & 0xffff;
            let begin = place + 30 + name;
            let content = &bytes[begin..begin + size];
            assert_eq!(crc32fast::hash(content) as usize, checksum);
            assert_eq!(u32_at(place + 14), checksum);
            assert_eq!(&content[..6], b"\x93NUMPY");
            let header = 10 + (content[8] as usize | (content[9] as usize) << 8);
            assert_eq!(header % 64, 0);
            let text = String::from_utf8(content[10..header].to_vec()).unwrap();
            let numbers = content[header..].chunks(8);
            let numbers = numbers.map(|x| f64::from_le_bytes(x.try_into().unwrap()));
            found.push((text.trim().to_owned(), numbers.collect::<Vec<_>>()));
            record += 46 + name;
        }
        assert_eq!(record, end);
        assert!(found[0].0.contains("'shape': (3,)"), "{}", found[0].0);
        assert!(found[1].0.contains("'shape': (3,1,2,)"), "{}", found[1].0);
        assert_eq!(found[1].1, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }
}
