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
