//! The `.vtp` file of a surface: polygons and lines between points.

use std::io::Write;
use std::path::Path;

use crate::{IoError, write_atomically};

/// Writes polygons and lines between points (m), with a vector that is constant on the surface, at a time (s).
///
/// # Errors
/// The file cannot be written.
pub(crate) fn write_polydata(
    path: &Path,
    time: f64,
    points: &[[f64; 3]],
    (polygons, lines): (&[&[u32]], &[&[u32]]),
    (name, vector): (&str, [f64; 3]),
) -> Result<(), IoError> {
    write_atomically(path, |out| {
        let (n, m, l) = (points.len(), polygons.len(), lines.len());
        writeln!(out, "<?xml version=\"1.0\"?>")?;
        writeln!(
            out,
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<FieldData>"
        )?;
        writeln!(
            out,
            "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{time:?}</DataArray>"
        )?;
        let [x, y, z] = vector;
        writeln!(
            out,
            "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"3\" NumberOfTuples=\"1\" format=\"ascii\">{x:?} {y:?} {z:?}</DataArray>"
        )?;
        writeln!(
            out,
            "</FieldData>\n<Piece NumberOfPoints=\"{n}\" NumberOfVerts=\"0\" NumberOfLines=\"{l}\" NumberOfStrips=\"0\" NumberOfPolys=\"{m}\">"
        )?;
        writeln!(
            out,
            "<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">"
        )?;
        for [x, y, z] in points {
            writeln!(out, "{x:?} {y:?} {z:?}")?;
        }
        writeln!(out, "</DataArray>\n</Points>")?;
        for (section, cells) in [("Lines", lines), ("Polys", polygons)] {
            writeln!(
                out,
                "<{section}>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">"
            )?;
            for cell in cells {
                let corners: Vec<String> = cell.iter().map(u32::to_string).collect();
                writeln!(out, "{}", corners.join(" "))?;
            }
            writeln!(
                out,
                "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">"
            )?;
            let mut end = 0;
            for cell in cells {
                end += cell.len();
                writeln!(out, "{end}")?;
            }
            writeln!(out, "</DataArray>\n</{section}>")?;
        }
        writeln!(out, "</Piece>\n</PolyData>\n</VTKFile>")
    })
}

/// Points, polygons and lines of a file.
pub(crate) type Polydata = (Vec<[f64; 3]>, Vec<Vec<u32>>, Vec<Vec<u32>>);

/// Reads points, polygons and lines of a file written by [`write_polydata`].
///
/// # Errors
/// The file cannot be read, or another program wrote it.
pub(crate) fn read_polydata(path: &Path) -> Result<Polydata, IoError> {
    let text = std::fs::read_to_string(path).map_err(|source| IoError::reading(path, source))?;
    let damaged = || IoError::damaged(path, "it is not a surface written by Pericles");
    let section = |name: &str| {
        let (_, rest) = text.split_once(&format!("<{name}>\n"))?;
        Some(rest.split_once(&format!("</{name}>"))?.0)
    };
    // Numbers of the k-th array of a section.
    let array = |name: &str, k: usize| -> Option<Vec<f64>> {
        let part = section(name)?.split("<DataArray").nth(k + 1)?;
        let (_, numbers) = part.split_once('>')?;
        let (numbers, _) = numbers.split_once('<')?;
        numbers.split_whitespace().map(|x| x.parse().ok()).collect()
    };
    let cells = |name: &str| -> Option<Vec<Vec<u32>>> {
        let (corners, ends) = (array(name, 0)?, array(name, 1)?);
        let mut start = 0;
        let mut cells = Vec::new();
        for end in ends {
            let corners = corners.get(start..end as usize)?;
            cells.push(corners.iter().map(|&k| k as u32).collect());
            start = end as usize;
        }
        Some(cells)
    };
    let read = || {
        let points = array("Points", 0)?;
        let points: Vec<[f64; 3]> = points.chunks_exact(3).map(|x| [x[0], x[1], x[2]]).collect();
        let (polygons, lines) = (cells("Polys")?, cells("Lines")?);
        let mut corners = polygons.iter().chain(&lines).flatten();
        let known = corners.all(|&k| (k as usize) < points.len());
        known.then_some((points, polygons, lines))
    };
    read().ok_or_else(damaged)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_are_read_as_they_were_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.vtp");
        let points = [[0.1, -1e-300, 3.0], [1.0, 0.0, 0.0], [0.0, 1.0 / 3.0, 0.0]];
        let (triangle, line): (&[u32], &[u32]) = (&[0, 1, 2], &[2, 0]);
        let cells: (&[&[u32]], &[&[u32]]) = (&[triangle], &[line]);
        write_polydata(&path, 1e-6, &points, cells, ("Velocity", [0.0; 3])).unwrap();
        let (found, polygons, lines) = read_polydata(&path).unwrap();
        assert_eq!(found, points);
        assert_eq!((&polygons[0][..], &lines[0][..]), (triangle, line));
        std::fs::write(&path, "<Points>\n").unwrap();
        assert!(read_polydata(&path).is_err());
    }
}
