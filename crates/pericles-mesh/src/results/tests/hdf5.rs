//! Minimal HDF5 reader for the tests, written from the format specification: superblock 0, symbol tables,
//! contiguous datasets.

use std::collections::BTreeMap;

pub(super) struct Hdf5 {
    bytes: Vec<u8>,
    /// Datasets by path: size of a number, shape, offset of the data.
    pub(super) datasets: BTreeMap<String, (usize, Vec<usize>, usize)>,
    /// Last eight bytes of attribute values, by path and name.
    pub(super) attributes: BTreeMap<String, Vec<u8>>,
}

impl Hdf5 {
    pub(super) fn new(bytes: Vec<u8>) -> Self {
        assert_eq!(&bytes[..8], b"\x89HDF\r\n\x1a\n");
        let mut file = Self {
            bytes,
            datasets: BTreeMap::new(),
            attributes: BTreeMap::new(),
        };
        assert_eq!(file.number(40, 8), file.bytes.len(), "the end of the file");
        file.object(file.number(64, 8), String::new());
        file
    }

    fn number(&self, place: usize, bytes: usize) -> usize {
        let own = &self.bytes[place..place + bytes];
        own.iter()
            .rev()
            .fold(0, |number, &byte| number << 8 | usize::from(byte))
    }

    fn text(&self, place: usize) -> String {
        let end = self.bytes[place..].iter().position(|&b| b == 0).unwrap();
        String::from_utf8(self.bytes[place..place + end].to_vec()).unwrap()
    }

    fn object(&mut self, header: usize, path: String) {
        assert_eq!(self.bytes[header], 1);
        assert_eq!(header % 8, 0);
        let end = header + 16 + self.number(header + 8, 4);
        let mut at = header + 16;
        let (mut lengths, mut size) = (Vec::new(), 0);
        let mut count = 0;
        while at < end {
            let (kind, length) = (self.number(at, 2), self.number(at + 2, 2));
            let data = at + 8;
            match kind {
                1 => {
                    let rank = usize::from(self.bytes[data + 1]);
                    lengths = (0..rank)
                        .map(|k| self.number(data + 8 + 8 * k, 8))
                        .collect();
                }
                3 => size = self.number(data + 4, 4),
                8 => {
                    assert_eq!(self.bytes[data..data + 2], [3, 1]);
                    let (place, bytes) = (self.number(data + 2, 8), self.number(data + 10, 8));
                    let held = size * lengths.iter().product::<usize>();
                    assert!(held <= bytes && place + bytes <= self.bytes.len(), "{path}");
                    self.datasets
                        .insert(path.clone(), (size, lengths.clone(), place));
                }
                0xc => {
                    let name = self.text(data + 8);
                    let value = self.bytes[data + length - 8..data + length].to_vec();
                    self.attributes.insert(format!("{path}@{name}"), value);
                }
                0x11 => self.group(self.number(data, 8), self.number(data + 8, 8), &path),
                _ => {}
            }
            at = data + length;
            count += 1;
        }
        assert_eq!(count, self.number(header + 2, 2));
    }

    fn group(&mut self, tree: usize, heap: usize, path: &str) {
        assert_eq!(&self.bytes[tree..tree + 4], b"TREE");
        assert_eq!(&self.bytes[heap..heap + 4], b"HEAP");
        let names = self.number(heap + 24, 8);
        let table = self.number(tree + 32, 8);
        assert_eq!(&self.bytes[table..table + 4], b"SNOD");
        let mut last = String::new();
        for k in 0..self.number(table + 6, 2) {
            let entry = table + 8 + 40 * k;
            let name = self.text(names + self.number(entry, 8));
            assert!(last < name, "names are in order");
            self.object(self.number(entry + 8, 8), format!("{path}/{name}"));
            last = name;
        }
    }

    /// Returns the values of a dataset of four- or eight-byte floating-point numbers.
    pub(super) fn real(&self, path: &str) -> Vec<f64> {
        let (size, lengths, place) = &self.datasets[path];
        let bytes = &self.bytes[*place..*place + size * lengths.iter().product::<usize>()];
        match size {
            4 => bytes
                .as_chunks::<4>()
                .0
                .iter()
                .map(|b| f64::from(f32::from_le_bytes(*b)))
                .collect(),
            _ => bytes
                .as_chunks::<8>()
                .0
                .iter()
                .map(|b| f64::from_le_bytes(*b))
                .collect(),
        }
    }

    /// Returns the values of a dataset of integers.
    pub(super) fn whole(&self, path: &str) -> Vec<i64> {
        let (size, lengths, place) = &self.datasets[path];
        let count = lengths.iter().product::<usize>();
        (0..count)
            .map(|k| self.number(place + size * k, *size) as i64)
            .collect()
    }

    pub(super) fn attribute(&self, path: &str) -> i64 {
        let bytes = &self.attributes[path];
        i64::from_le_bytes(bytes[..8].try_into().unwrap())
    }
}
