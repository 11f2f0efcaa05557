//! Reader of our `.vtu` files for tests, written from the format specification and independent of the writer.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

pub(crate) struct Vtu {
    pub(crate) time: f64,
    pub(crate) points: usize,
    arrays: BTreeMap<String, (String, Vec<u8>)>,
}

impl Vtu {
    pub(crate) fn read(path: &Path) -> Self {
        let bytes = std::fs::read(path).unwrap();
        let mark: &[u8] = b"<AppendedData encoding=\"raw\">";
        let end = find(&bytes, mark);
        let xml = std::str::from_utf8(&bytes[..end]).unwrap();
        assert!(xml.contains("byte_order=\"LittleEndian\" header_type=\"UInt64\""));
        assert!(xml.contains("compressor=\"vtkZLibDataCompressor\""));
        let data = &bytes[end + mark.len()..];
        let data = &data[find(data, b"_") + 1..];
        assert!(bytes.ends_with(b"\n</AppendedData>\n</VTKFile>\n"));

        let mut arrays = BTreeMap::new();
        let mut time = f64::NAN;
        let mut points = 0;
        for element in xml.split('<') {
            if element.starts_with("Piece ") {
                points = attribute(element, "NumberOfPoints").parse().unwrap();
                assert_eq!(attribute(element, "NumberOfCells").parse(), Ok(points));
            } else if element.starts_with("DataArray ") {
                let name = attribute(element, "Name");
                if name == "TimeValue" {
                    time = element.split_once('>').unwrap().1.parse().unwrap();
                    continue;
                }
                let offset: usize = attribute(element, "offset").parse().unwrap();
                let array = inflate(&data[offset..]);
                let data_type = attribute(element, "type");
                arrays.insert(name.to_string(), (data_type.to_string(), array));
            }
        }
        Self {
            time,
            points,
            arrays,
        }
    }

    pub(crate) fn raw(&self, name: &str, data_type: &str) -> &[u8] {
        let (found, data) = &self.arrays[name];
        assert_eq!(found, data_type);
        data
    }

    pub(crate) fn f64(&self, name: &str) -> Vec<f64> {
        let data = self.raw(name, "Float64");
        let elements = data.chunks_exact(8);
        elements
            .map(|element| f64::from_le_bytes(element.try_into().unwrap()))
            .collect()
    }
}

fn inflate(data: &[u8]) -> Vec<u8> {
    let number = |k: usize| u64::from_le_bytes(data[8 * k..8 * k + 8].try_into().unwrap()) as usize;
    let (blocks, size, last) = (number(0), number(1), number(2));
    let mut out = Vec::new();
    let mut at = 8 * (3 + blocks);
    for block in 0..blocks {
        let packed = &data[at..at + number(3 + block)];
        at += packed.len();
        let before = out.len();
        let mut zlib = flate2::read::ZlibDecoder::new(packed);
        zlib.read_to_end(&mut out).unwrap();
        let partial = block + 1 == blocks && last > 0;
        assert_eq!(out.len() - before, if partial { last } else { size });
    }
    out
}

fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    let start = element.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
    let rest = &element[start..];
    &rest[..rest.find('"').unwrap()]
}

fn find(bytes: &[u8], mark: &[u8]) -> usize {
    bytes.windows(mark.len()).position(|w| w == mark).unwrap()
}
