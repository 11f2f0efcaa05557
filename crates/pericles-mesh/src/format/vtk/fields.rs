//! Reading of fields from VTK XML files, to compare runs and to re-render fields.

use super::file::File;
use crate::fault::Fault;

/// The points of a file with their fields.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldData {
    /// Time in seconds, if the file contains it.
    pub time: Option<f64>,
    /// x, y, z of every point in turn.
    pub points: Vec<f64>,
    /// Whether the points are the centroids of cells, whose fields are cell data.
    pub is_on_cells: bool,
    /// The fields on the points, in the file's order.
    pub fields: Vec<FieldColumn>,
}

/// One field on all points.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldColumn {
    /// Name.
    pub name: String,
    /// 1 for a scalar, 3 for a vector, 6 for a symmetric tensor.
    pub components: usize,
    /// The components of every point in turn.
    pub values: Vec<f64>,
}

impl FieldData {
    /// Returns the field with this name.
    pub fn field(&self, name: &str) -> Option<&FieldColumn> {
        self.fields.iter().find(|field| field.name == name)
    }
}

/// The points and the fields on them in the content of a `.vtu` or `.vtp` file, whose arrays may take `memory` bytes.
///
/// A file whose fields are cell data holds one cell for each point: the points are then the centroids of the corners of the cells.
///
/// # Errors
/// Returns an error for content that is not VTK XML, exceeds the memory, or has arrays that are damaged or do
/// not match the number of points.
pub fn parse_fields(content: &[u8], memory: u64) -> Result<FieldData, Fault> {
    let file = File::new(content, memory)?;
    let nodes = file.array("Points", None)?.real();
    let has = |section: &str| file.columns(section).next().is_some();
    // A file without fields has an empty section.
    let is_on_cells = has("CellData") || file.has("CellData") && !has("PointData");
    let (section, points) = match is_on_cells {
        true => ("CellData", centroids(&file, &nodes)?),
        false => ("PointData", nodes),
    };
    let count = points.len() / 3;
    let mut fields = Vec::new();
    for (name, components) in file.columns(section) {
        let values = file.array(section, Some(&name))?.real();
        if components == 0 || Some(values.len()) != count.checked_mul(components) {
            return Err(Fault::of_file(format!(
                "{name} has {} values; {count} points with {components} components need {}",
                values.len(),
                count.saturating_mul(components)
            )));
        }
        fields.push(FieldColumn {
            name: name.into_owned(),
            components,
            values,
        });
    }
    let time = file.array("FieldData", Some("TimeValue")).ok();
    Ok(FieldData {
        time: time.and_then(|time| time.real().first().copied()),
        points,
        is_on_cells,
        fields,
    })
}

/// The mean of the corners of each cell.
fn centroids(file: &File<'_>, nodes: &[f64]) -> Result<Vec<f64>, Fault> {
    let corners = file.array("Cells", Some("connectivity"))?;
    let corners = corners.whole("corners of cells")?;
    let ends = file.array("Cells", Some("offsets"))?;
    let ends = ends.whole("offsets of cells")?;
    let node = |corner: &i64| -> Option<&[f64]> {
        let start = usize::try_from(*corner).ok()?.checked_mul(3)?;
        nodes.get(start..start.checked_add(3)?)
    };
    let mut centroids = Vec::with_capacity(3 * ends.len());
    let mut start = 0;
    for end in ends {
        let end = usize::try_from(end).unwrap_or(0);
        let own = corners.get(start..end).filter(|own| !own.is_empty());
        let own = own.ok_or_else(|| Fault::of_file("the offsets of the cells do not ascend"))?;
        let mut sum = [0.0; 3];
        for corner in own {
            let place = node(corner).ok_or_else(|| {
                let nodes = nodes.len() / 3;
                Fault::of_file(format!("a cell has the corner {corner}, of {nodes} nodes"))
            })?;
            for (sum, x) in sum.iter_mut().zip(place) {
                *sum += x;
            }
        }
        centroids.extend(sum.map(|sum| sum / own.len() as f64));
        start = end;
    }
    Ok(centroids)
}
