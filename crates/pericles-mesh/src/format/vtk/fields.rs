//! Fields of VTK XML files, read back: to compare runs and to re-render them.

use super::file::File;
use crate::fault::Fault;

/// The points of a file with their fields.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldData {
    /// The time, s, where the file tells.
    pub time: Option<f64>,
    /// x, y, z of every point in turn.
    pub points: Vec<f64>,
    /// The fields on the points, in the file's order.
    pub fields: Vec<FieldColumn>,
}

/// One field on all points.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldColumn {
    /// Its name.
    pub name: String,
    /// 1 for a scalar, 3 for a vector.
    pub components: usize,
    /// The components of every point in turn.
    pub values: Vec<f64>,
}

impl FieldData {
    /// The field of this name.
    pub fn field(&self, name: &str) -> Option<&FieldColumn> {
        self.fields.iter().find(|field| field.name == name)
    }
}

/// The points and point data in the content of a `.vtu` or `.vtp` file, whose arrays may take `memory` bytes.
///
/// # Errors
/// Content that is not VTK XML or takes more memory, arrays that are damaged or not as long as the points are many.
pub fn parse_fields(content: &[u8], memory: u64) -> Result<FieldData, Fault> {
    let file = File::new(content, memory)?;
    let points = file.array("Points", None)?.real();
    let count = points.len() / 3;
    let mut fields = Vec::new();
    for (name, components) in file.columns("PointData") {
        let values = file.array("PointData", Some(name))?.real();
        if components == 0 || Some(values.len()) != count.checked_mul(components) {
            return Err(Fault::of_file(format!(
                "{name} has {} numbers; {count} points of {components} components need {}",
                values.len(),
                count.saturating_mul(components)
            )));
        }
        fields.push(FieldColumn {
            name: name.to_owned(),
            components,
            values,
        });
    }
    let time = file.array("FieldData", Some("TimeValue")).ok();
    Ok(FieldData {
        time: time.and_then(|time| time.real().first().copied()),
        points,
        fields,
    })
}
