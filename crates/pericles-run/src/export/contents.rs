//! The header of a page: what its blocks are. Numbers of blocks are those of
//! [`PageWriter::block`](pericles_io::viewer::PageWriter::block); arrays of points are in the user's order, vectors
//! component-major.

use pericles::observe::{Field, FieldKind};
use pericles_mesh::results::FieldSpec;
use serde::Serialize;

/// The header.
#[derive(Debug, Default, Serialize)]
pub(super) struct Header {
    pub(super) version: &'static str,
    pub(super) title: String,
    /// The deck's file.
    pub(super) deck: String,
    pub(super) dimension: usize,
    pub(super) points: usize,
    /// Point spacing, m.
    pub(super) spacing: f64,
    /// Initial magnification of displacements.
    pub(super) scale: f64,
    /// What was left out.
    pub(super) notes: Vec<String>,
    pub(super) axis: TimeAxisData,
    /// The output times, s.
    pub(super) times: Vec<f64>,
    pub(super) steps: Vec<StepData>,
    pub(super) maps: Vec<MapData>,
    /// Subtracted from positions before they are rounded to single precision, m.
    pub(super) origin: [f64; 3],
    /// f32: three coordinates of each point, component-major.
    pub(super) positions: u32,
    /// f32: half the size of each point's cell.
    pub(super) radii: u32,
    pub(super) cells: Option<CellData>,
    /// u32: the corners of the triangles of a surface.
    pub(super) triangles: Option<u32>,
    pub(super) lines: LineData,
    pub(super) sets: Vec<SetData>,
    pub(super) fields: Vec<FieldData>,
    pub(super) impactors: Vec<ImpactorData>,
    pub(super) tables: Vec<TableData>,
}

/// The time axis.
#[derive(Debug, Default, Serialize)]
pub(super) struct TimeAxisData {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    /// The time of one unit, s.
    pub(super) scale: f64,
}

/// A step of a run of several steps.
#[derive(Debug, Default, Serialize)]
pub(super) struct StepData {
    pub(super) name: String,
    /// s.
    pub(super) start: f64,
}

/// Equidistant colours.
#[derive(Debug, Default, Serialize)]
pub(super) struct MapData {
    pub(super) name: &'static str,
    pub(super) colours: Vec<[u8; 3]>,
}

/// Cells with their neighbours; see [`pericles_io::observers::CellArrays`].
#[derive(Debug, Default, Serialize)]
pub(super) struct CellData {
    /// f32: three coordinates of each node, component-major.
    pub(super) nodes: u32,
    /// u32: VTK's types.
    pub(super) types: u32,
    /// u32.
    pub(super) corners: u32,
    /// u32.
    pub(super) points: u32,
    /// u32.
    pub(super) across: u32,
    /// u32: 0 or 1.
    pub(super) cut: u32,
}

/// Lines that move with the body.
#[derive(Debug, Default, Serialize)]
pub(super) struct LineData {
    /// f32: three coordinates of each place, one place after the other.
    pub(super) places: u32,
    /// u32: two points for each place.
    pub(super) points: u32,
    /// u32: the number of places of each line.
    pub(super) lengths: u32,
}

/// A set of points.
#[derive(Debug, Default, Serialize)]
pub(super) struct SetData {
    pub(super) name: String,
    /// u32.
    pub(super) points: u32,
}

/// A field over time.
#[derive(Debug, Default, Serialize)]
pub(super) struct FieldData {
    pub(super) name: String,
    pub(super) unit: &'static str,
    /// Names of the components; empty for scalars.
    pub(super) components: Vec<String>,
    /// Whether the magnitude is meaningful.
    pub(super) is_vector: bool,
    /// The field at each output time.
    pub(super) frames: Vec<FrameData>,
    /// The range of each component over time, then that of the magnitude of vectors.
    pub(super) ranges: Vec<[f64; 2]>,
}

/// A field at an output time.
#[derive(Debug, Clone, Default, Serialize)]
pub(super) struct FrameData {
    /// u16: codes of the components, one after the other; 65535 for missing values.
    pub(super) block: u32,
    /// The least value of each component.
    pub(super) low: Vec<f64>,
    /// The difference of neighbouring codes of each component.
    pub(super) step: Vec<f64>,
    /// The range of each component, then that of the magnitude of vectors.
    pub(super) ranges: Vec<[f64; 2]>,
}

/// A rigid body over time.
#[derive(Debug, Default, Serialize)]
pub(super) struct ImpactorData {
    pub(super) name: String,
    /// u32: corners of triangles; `None` for bodies in the plane.
    pub(super) triangles: Option<u32>,
    /// Whether the corners of a body in the plane form a closed polygon.
    pub(super) closed: bool,
    /// f32: three coordinates of each corner, one corner after the other, for each output time.
    pub(super) frames: Vec<Option<u32>>,
}

/// A table over time.
#[derive(Debug, Default, Serialize)]
pub(super) struct TableData {
    pub(super) name: String,
    /// f64: times, s.
    pub(super) time: u32,
    pub(super) columns: Vec<ColumnData>,
}

/// A column of a table.
#[derive(Debug, Default, Serialize)]
pub(super) struct ColumnData {
    pub(super) name: String,
    pub(super) unit: String,
    /// Whether all values are equal.
    pub(super) constant: bool,
    /// f64.
    pub(super) block: u32,
}

/// A field of a page and its arrays in the files of the run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FieldGroup {
    pub(super) name: String,
    pub(super) unit: &'static str,
    pub(super) components: Vec<String>,
    pub(super) is_vector: bool,
    /// Number of components of its arrays in the files.
    pub(super) width: usize,
    /// Array and component in the files.
    pub(super) arrays: Vec<(usize, usize)>,
}

/// Returns the fields of a body: components of a tensor, which files have as arrays of their own, form one field.
pub(super) fn groups(specs: &[FieldSpec], dimension: usize) -> Vec<FieldGroup> {
    let mut groups: Vec<FieldGroup> = Vec::new();
    for (array, spec) in specs.iter().enumerate() {
        let tensor = Field::ALL.into_iter().find_map(|field| {
            let part = spec.name.strip_prefix(field.name())?.strip_prefix('_')?;
            let known =
                field.kind() == FieldKind::Tensor && field.components(dimension).contains(&part);
            known.then(|| (field, part.to_owned()))
        });
        if let Some((field, part)) = tensor {
            if let Some(group) = groups.iter_mut().find(|group| group.name == field.name()) {
                group.components.push(part);
                group.arrays.push((array, 0));
            } else {
                groups.push(FieldGroup {
                    name: field.name().into(),
                    unit: field.unit(),
                    components: vec![part],
                    is_vector: false,
                    width: 1,
                    arrays: vec![(array, 0)],
                });
            }
            continue;
        }
        let field = Field::ALL
            .into_iter()
            .find(|field| field.name() == spec.name);
        let components: Vec<String> = match (field, spec.components) {
            (_, 1) => Vec::new(),
            (Some(field), _) if !field.components(dimension).is_empty() => {
                let names = field.components(dimension).iter();
                names.map(|&name| name.into()).collect()
            }
            (_, several) => (1..=several).map(|k| k.to_string()).collect(),
        };
        let count = components.len().max(1);
        groups.push(FieldGroup {
            name: spec.name.clone(),
            unit: field.map_or("", Field::unit),
            is_vector: dimension > 1
                && field.is_some_and(|field| field.kind() == FieldKind::Vector),
            components,
            width: spec.components.max(1),
            arrays: (0..count).map(|component| (array, component)).collect(),
        });
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_of_tensors_form_one_field_and_plane_vectors_have_two_components() {
        let specs = [
            FieldSpec::new("Displacement", 3),
            FieldSpec::new("Stress_xx", 1),
            FieldSpec::new("Stress_yy", 1),
            FieldSpec::new("Stress_xy", 1),
            FieldSpec::new("Damage", 1),
            FieldSpec::new("Set_top", 1),
        ];
        let found = groups(&specs, 2);
        let names: Vec<&str> = found.iter().map(|group| group.name.as_str()).collect();
        assert_eq!(names, ["Displacement", "Stress", "Damage", "Set_top"]);
        assert_eq!(found[0].arrays, [(0, 0), (0, 1)]);
        assert!(found[0].is_vector && !found[1].is_vector);
        assert_eq!(found[1].components, ["xx", "yy", "xy"]);
        assert_eq!((found[1].unit, found[3].unit), ("Pa", ""));
    }
}
