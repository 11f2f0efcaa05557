//! The `.vtu` file of one output.

use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use super::blocks::write_array;
use super::cells::{Cells, VtuCells};
use super::field::{Header, VtkField};
use crate::xml::escaped;
use crate::{IoError, write_atomically};

/// Space for an offset: `offset="` + 20 digits of the largest u64 + `"`.
const OFFSET_WIDTH: usize = 29;

/// Entry `k` of (x, y, z) of point 0, of point 1 …, from component-major data; zero where a component is missing.
fn interleaved(data: &[f64], points: usize, k: usize) -> f64 {
    data.get(k % 3 * points + k / 3).copied().unwrap_or(0.0)
}

/// The points of one output and their fields.
#[derive(Debug, Clone)]
pub struct VtuFile<'a> {
    dimension: usize,
    positions: &'a [f64],
    time: f64,
    fields: Vec<VtkField<'a>>,
    node_fields: Vec<VtkField<'a>>,
    triangles: &'a [[u32; 3]],
    cells: Option<&'a VtuCells>,
}

/// End of every file.
const END: &[u8] = b"</AppendedData>\n</VTKFile>\n";

impl VtuFile<'_> {
    /// Returns whether the file exists and is complete. Files are written atomically: one without its end was
    /// truncated afterwards.
    pub fn is_whole(path: impl AsRef<Path>) -> bool {
        let end = || -> std::io::Result<bool> {
            let mut file = std::fs::File::open(path)?;
            file.seek(SeekFrom::End(-(END.len() as i64)))?;
            let mut found = Vec::new();
            file.read_to_end(&mut found)?;
            Ok(found == END)
        };
        end().unwrap_or(false)
    }
}

impl<'a> VtuFile<'a> {
    /// Creates a file of points at `positions`, component-major.
    pub fn new(dimension: usize, positions: &'a [f64]) -> Self {
        Self {
            dimension,
            positions,
            time: 0.0,
            fields: Vec::new(),
            node_fields: Vec::new(),
            triangles: &[],
            cells: None,
        }
    }

    /// Sets the time of the output in seconds.
    pub fn time(mut self, time: f64) -> Self {
        self.time = time;
        self
    }

    /// Sets triangles between the points as cells, in place of vertex cells.
    pub fn triangles(mut self, triangles: &'a [[u32; 3]]) -> Self {
        self.triangles = triangles;
        self
    }

    /// Sets cells between the points; fields then belong to the cells.
    pub fn on_cells(mut self, cells: &'a VtuCells) -> Self {
        self.cells = Some(cells);
        self
    }

    /// Adds a field; names must be unique.
    pub fn field(mut self, field: VtkField<'a>) -> Self {
        self.fields.push(field);
        self
    }

    /// Adds a field on the corners of the cells; the names of such fields must differ.
    pub fn node_field(mut self, field: VtkField<'a>) -> Self {
        self.node_fields.push(field);
        self
    }

    /// Writes the file atomically.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), IoError> {
        let path = path.as_ref();
        let points = self.check(path)?;
        write_atomically(path, |out| self.write_into(out, points))
    }

    /// Checks names and lengths and returns the number of points.
    fn check(&self, path: &Path) -> Result<usize, IoError> {
        let unsuitable = |reason: String| IoError::Unsuitable {
            path: path.to_path_buf(),
            reason,
        };
        if !(1..=3).contains(&self.dimension) {
            let given = self.dimension;
            return Err(unsuitable(format!(
                "the points have dimension {given}; allowed: 1, 2 and 3"
            )));
        }
        if !self.time.is_finite() {
            return Err(unsuitable(format!("the time {} is not finite", self.time)));
        }
        let points = self.positions.len() / self.dimension;
        if points * self.dimension != self.positions.len() {
            return Err(IoError::Shape {
                path: path.to_path_buf(),
                what: "positions".into(),
                expected: points * self.dimension,
                given: self.positions.len(),
            });
        }
        let corners = self.triangles.iter().flatten();
        let corners = corners.chain(self.cells.iter().flat_map(|cells| &cells.corners));
        if let Some(corner) = corners.copied().find(|&corner| corner as usize >= points) {
            return Err(unsuitable(format!(
                "a cell refers to point {corner}, but there are only {points} points"
            )));
        }
        let places = self.cells.map_or(points, VtuCells::len);
        for (fields, places) in [(&self.fields, places), (&self.node_fields, points)] {
            for (number, field) in fields.iter().enumerate() {
                field.check(path, places)?;
                let name = field.name;
                if name.is_empty() || name.chars().any(char::is_control) {
                    return Err(unsuitable(format!(
                        "field name {name:?}; use a name of one line"
                    )));
                }
                if fields[..number].iter().any(|other| other.name == name) {
                    return Err(unsuitable(format!("two fields are called {name:?}")));
                }
            }
        }
        Ok(points)
    }

    fn write_into(&self, out: &mut (impl Write + Seek), points: usize) -> io::Result<()> {
        let shape = match (self.cells, self.triangles) {
            (Some(cells), _) => Cells::Mixed(cells),
            (None, []) => Cells::Vertices(points),
            (None, triangles) => Cells::Triangles(triangles),
        };
        let cells = shape.len();
        // The fields of the nodes come first if there are cells.
        let sections = match self.cells {
            Some(_) => [
                ("PointData", &self.node_fields, points),
                ("CellData", &self.fields, cells),
            ],
            None => [
                ("PointData", &self.fields, points),
                ("CellData", &self.node_fields, 0),
            ],
        };
        // Positions in the file of the offsets, in the order of the appended arrays.
        let mut places = Vec::new();
        write!(
            out,
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
             compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n<FieldData>\n\
             <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{:?}</DataArray>\n</FieldData>\n\
             <Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n",
            self.time
        )?;
        for (section, fields, _) in &sections {
            // The section of the cells shows that the fields belong to them, even if there are none.
            let is_of_cells = self.cells.is_some() && *section == "CellData";
            if is_of_cells || !fields.is_empty() {
                writeln!(out, "<{section}>")?;
                for field in *fields {
                    places.push(announce(out, &field.header())?);
                }
                writeln!(out, "</{section}>")?;
            }
        }
        let plain = |data_type, name, components| Header {
            data_type,
            name,
            components,
            component_names: &[],
            unit: "",
        };
        writeln!(out, "<Points>")?;
        places.push(announce(out, &plain("Float64", "Points", 3))?);
        write!(out, "</Points>\n<Cells>\n")?;
        for (data_type, name) in [
            ("Int64", "connectivity"),
            ("Int64", "offsets"),
            ("UInt8", "types"),
        ] {
            places.push(announce(out, &plain(data_type, name, 1))?);
        }
        write!(
            out,
            "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_"
        )?;

        // In the reverse order of their announcements, without gaps. meshio replaces the offsets one by one by others, and takes the
        // first announcement with the offset of an array: one whose offset has been replaced must not come first.
        let start = out.stream_position()?;
        let mut offsets = Vec::with_capacity(places.len());
        offsets.push(out.stream_position()? - start);
        write_array(out, cells, |i| [shape.vtk_type(i)])?;
        offsets.push(out.stream_position()? - start);
        write_array(out, cells, |i| (shape.end(i + 1) as i64).to_le_bytes())?;
        offsets.push(out.stream_position()? - start);
        write_array(out, shape.end(cells), |k| shape.corner(k).to_le_bytes())?;
        offsets.push(out.stream_position()? - start);
        write_array(out, 3 * points, |k| {
            interleaved(self.positions, points, k).to_le_bytes()
        })?;
        for (_, fields, places) in sections.into_iter().rev() {
            for field in fields.iter().rev() {
                offsets.push(out.stream_position()? - start);
                field.write(out, places)?;
            }
        }
        writeln!(out)?;
        out.write_all(END)?;

        for (place, offset) in places.into_iter().rev().zip(offsets) {
            out.seek(SeekFrom::Start(place))?;
            write!(out, "offset=\"{offset}\"")?;
        }
        Ok(())
    }
}

/// Writes the element that announces an appended array, and returns where its offset goes.
fn announce(out: &mut (impl Write + Seek), header: &Header<'_>) -> io::Result<u64> {
    let name = escaped(header.name);
    write!(
        out,
        "<DataArray type=\"{}\" Name=\"{name}\" ",
        header.data_type
    )?;
    // Given for a scalar, some readers make n × 1 matrices of it.
    if header.components > 1 {
        write!(out, "NumberOfComponents=\"{}\" ", header.components)?;
    }
    for (number, name) in header.component_names.iter().enumerate() {
        write!(out, "ComponentName{number}=\"{name}\" ")?;
    }
    write!(out, "format=\"appended\" ")?;
    let place = out.stream_position()?;
    write!(out, "{:OFFSET_WIDTH$}", "")?;
    if header.unit.is_empty() {
        writeln!(out, "/>")?;
    } else {
        let unit = escaped(header.unit);
        writeln!(
            out,
            "><InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{unit}</InformationKey></DataArray>"
        )?;
    }
    Ok(place)
}

#[cfg(test)]
mod tests {
    use super::super::decode::Vtu;
    use super::*;
    use proptest::prelude::*;
    use std::fs;

    fn wave(count: usize, phase: f64) -> Vec<f64> {
        (0..count)
            .map(|i| (i as f64 * 0.37 + phase).sin())
            .collect()
    }

    #[test]
    fn every_array_is_read_back_over_several_blocks() {
        // 3 · 8 · 7001 bytes: six blocks, the last one partially filled
        let n = 7001;
        let (x, u, e) = (wave(2 * n, 0.0), wave(2 * n, 1.0), wave(n, 2.0));
        let kind: Vec<i32> = (0..n as i32).map(|i| 7 - i).collect();
        let mask: Vec<u8> = (0..n).map(|i| (i % 251) as u8).collect();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.vtu");
        VtuFile::new(2, &x)
            .time(4.6e-5)
            .field(VtkField::vector("Displacement", &u))
            .field(VtkField::scalar("E < \"W\" & more", &e))
            .field(VtkField::scalar("single", &e).in_single_precision())
            .field(VtkField::integers("kind", &kind))
            .field(VtkField::bytes("mask", &mask))
            .write(&path)
            .unwrap();

        let vtu = Vtu::read(&path);
        assert_eq!(vtu.time, 4.6e-5);
        assert_eq!(vtu.points, n);
        let three = |data: &[f64]| -> Vec<f64> {
            (0..n).flat_map(|i| [data[i], data[n + i], 0.0]).collect()
        };
        assert_eq!(vtu.f64("Points"), three(&x));
        assert_eq!(vtu.f64("Displacement"), three(&u));
        assert_eq!(vtu.f64("E &lt; &quot;W&quot; &amp; more"), e);
        let rounded: Vec<u8> = e.iter().flat_map(|&v| (v as f32).to_le_bytes()).collect();
        assert_eq!(vtu.raw("single", "Float32"), rounded);
        let kinds: Vec<u8> = kind.iter().flat_map(|v| v.to_le_bytes()).collect();
        assert_eq!(vtu.raw("kind", "Int32"), kinds);
        assert_eq!(vtu.raw("mask", "UInt8"), mask);
        assert_eq!(vtu.raw("types", "UInt8"), vec![1; n]);
        let count =
            |from: i64| -> Vec<u8> { (from..from + n as i64).flat_map(i64::to_le_bytes).collect() };
        assert_eq!(vtu.raw("connectivity", "Int64"), count(0));
        assert_eq!(vtu.raw("offsets", "Int64"), count(1));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn arrays_are_read_back_bit_for_bit_for_any_size_and_dimension(
            dimension in 1_usize..=3, n in prop_oneof![0_usize..40, 4090_usize..4102, 1360_usize..1370],
            components in 1_usize..=3, seed in any::<u64>())
        {
            let mut state = seed;
            let mut bits = || {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                f64::from_bits(state ^ (state >> 29))
            };
            let x: Vec<f64> = (0..dimension * n).map(|_| bits()).collect();
            let v: Vec<f64> = (0..components * n).map(|_| bits()).collect();
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("a.vtu");
            VtuFile::new(dimension, &x).field(VtkField::vector("v", &v)).write(&path).unwrap();
            let vtu = Vtu::read(&path);
            for (name, data, count) in [("Points", &x, dimension), ("v", &v, components)] {
                let found = vtu.f64(name);
                prop_assert_eq!(found.len(), 3 * n);
                for i in 0..n {
                    for c in 0..3 {
                        let expected = if c < count { data[c * n + i] } else { 0.0 };
                        prop_assert_eq!(found[3 * i + c].to_bits(), expected.to_bits());
                    }
                }
            }
        }
    }

    /// Replaces the offsets as meshio 5.3 does, which reads raw appended data by converting it to base64; returns the array that
    /// each announcement refers to afterwards, by its number in the order of announcements.
    fn arrays_after_meshio(bytes: &[u8]) -> Vec<Option<usize>> {
        let mark: &[u8] = b"<AppendedData encoding=\"raw\">\n_";
        let begin = bytes.windows(mark.len()).position(|w| w == mark).unwrap();
        let xml = std::str::from_utf8(&bytes[..begin]).unwrap();
        let data = &bytes[begin + mark.len()..bytes.len() - END.len() - 1];
        let offset = |tag: &str| {
            let (_, rest) = tag.split_once("offset=\"")?;
            rest.split_once('"')?.0.parse::<usize>().ok()
        };
        let original: Vec<usize> = xml.split("<DataArray").filter_map(offset).collect();
        let mut offsets = original.clone();
        let number = |at: usize| u64::from_le_bytes(data[at..at + 8].try_into().unwrap()) as usize;
        let (mut at, mut converted) = (0, 0);
        let mut by_offset = std::collections::BTreeMap::new();
        while at < data.len() {
            let tag = offsets.iter().position(|&offset| offset == at).unwrap();
            offsets[tag] = converted;
            by_offset.insert(
                converted,
                original.iter().position(|&offset| offset == at).unwrap(),
            );
            let blocks = number(at);
            let full = blocks * number(at + 8);
            let size = match number(at + 16) {
                0 => full,
                last => full - number(at + 8) + last,
            };
            converted += (8 + size).div_ceil(3) * 4;
            at += 8 * (3 + blocks) + (0..blocks).map(|k| number(at + 24 + 8 * k)).sum::<usize>();
        }
        offsets
            .iter()
            .map(|offset| by_offset.get(offset).copied())
            .collect()
    }

    #[test]
    fn meshio_finds_every_array_of_files_of_any_size() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.vtu");
        for n in (0..400).chain([5000, 12_345]) {
            let (x, u, e) = (wave(3 * n, 0.0), vec![0.25; 3 * n], vec![1.0; n]);
            let file = VtuFile::new(3, &x)
                .field(VtkField::vector("Displacement", &u))
                .field(VtkField::vector("Velocity", &x))
                .field(VtkField::scalar("Damage", &e));
            file.write(&path).unwrap();
            let found = arrays_after_meshio(&fs::read(&path).unwrap());
            assert_eq!(found, (0..7).map(Some).collect::<Vec<_>>(), "{n}");
        }
    }

    #[test]
    fn equal_data_give_equal_bytes_in_any_folder() {
        let folder = tempfile::tempdir().unwrap();
        let x = wave(300, 0.0);
        let write = |name: &str| {
            let path = folder.path().join(name);
            let energy = wave(100, 1.0);
            let file = VtuFile::new(3, &x).field(VtkField::scalar("W", &energy));
            file.write(&path).unwrap();
            fs::read(path).unwrap()
        };
        assert_eq!(write("first.vtu"), write("another_name.vtu"));
    }

    #[test]
    fn inconsistent_fields_are_rejected_and_nothing_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.vtu");
        let (x, long) = (wave(6, 0.0), wave(4, 0.0));
        let good = wave(3, 0.0);
        let file = || VtuFile::new(2, &x);
        for rejected in [
            file().field(VtkField::scalar("a", &long)),
            file().field(VtkField::vector("a", &long)),
            file().field(VtkField::bytes("a", &[1, 2])),
            file().field(VtkField::scalar("", &good)),
            file()
                .field(VtkField::scalar("a", &good))
                .field(VtkField::scalar("a", &good)),
            file().time(f64::NAN),
            VtuFile::new(4, &x),
            VtuFile::new(2, &x[..5]),
        ] {
            let error = rejected.write(&path).unwrap_err();
            let data = matches!(error, IoError::Shape { .. } | IoError::Unsuitable { .. });
            assert!(data && !error.is_output_problem(), "{error}");
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
