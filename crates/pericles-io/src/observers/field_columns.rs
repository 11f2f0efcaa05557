//! The columns of field files: fields of a snapshot, and numbers of points that do not change.

use pericles::observe::{Field, FieldKind, ObserveError, Snapshot};
use pericles_mesh::results::FieldSpec;

use crate::numbering::Numbering;
use crate::vtk::VtkField;

/// Whole numbers of the points that are the same at all times, such as the number of their material.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PointMark {
    /// Name in files.
    pub name: String,
    /// The number of each point, in the cloud's order.
    pub numbers: Vec<i32>,
}

/// What field files hold.
#[derive(Debug, Clone)]
pub struct FieldSelection {
    /// Fields of the snapshot.
    pub fields: Vec<Field>,
    /// Numbers of the points.
    pub marks: Vec<PointMark>,
}

impl FieldSelection {
    /// Checks that all fields can be computed for the body.
    pub(super) fn check(&self, snapshot: &Snapshot<'_>) -> Result<(), ObserveError> {
        for field in &self.fields {
            snapshot.check(*field)?;
        }
        Ok(())
    }

    /// The columns of a snapshot in the user's order of points; `None` if another process writes them.
    pub(super) fn columns(
        &self,
        snapshot: &Snapshot<'_>,
        numbering: &Numbering,
    ) -> Option<Vec<Column>> {
        let column = |&field: &Field| {
            let whole = snapshot.whole(field)?;
            Some(Column {
                name: field.name().to_owned(),
                kind: field.kind(),
                components: field.components(snapshot.system().cloud().dimension()),
                unit: field.unit(),
                values: numbering.apply(&whole).into_owned(),
            })
        };
        // All fields are gathered before the first missing one ends the output.
        let of_fields: Vec<Option<Column>> = self.fields.iter().map(column).collect();
        let of_fields: Option<Vec<Column>> = of_fields.into_iter().collect();
        let of_fields = of_fields.filter(|_| snapshot.is_written())?;
        let of_marks = self.marks.iter().map(|mark| {
            let numbers: Vec<f64> = mark.numbers.iter().copied().map(f64::from).collect();
            Column {
                name: mark.name.clone(),
                kind: FieldKind::Integer,
                components: &[],
                unit: "",
                values: numbering.apply(&numbers).into_owned(),
            }
        });
        Some(of_fields.into_iter().chain(of_marks).collect())
    }

    /// The arrays of a file that keeps each component of a tensor as an array of its own, in the order of [`Column::arrays`].
    pub(super) fn specs(&self, dimension: usize) -> Vec<FieldSpec> {
        let of_fields = self.fields.iter().flat_map(|&field| {
            let name = field.name();
            match field.kind() {
                FieldKind::Tensor => {
                    let parts = field.components(dimension).iter();
                    let part = |part: &&str| FieldSpec::new(format!("{name}_{part}"), 1);
                    parts.map(part).collect()
                }
                FieldKind::Vector | FieldKind::List => vec![FieldSpec::new(name, dimension)],
                FieldKind::Scalar | FieldKind::Integer => vec![FieldSpec::new(name, 1)],
            }
        });
        let marks = self.marks.iter();
        let of_marks = marks.map(|mark| FieldSpec::new(mark.name.as_str(), 1));
        of_fields.chain(of_marks).collect()
    }
}

/// A named field in the user's order of points, component-major.
pub(super) struct Column {
    pub(super) name: String,
    kind: FieldKind,
    components: &'static [&'static str],
    unit: &'static str,
    values: Vec<f64>,
}

impl Column {
    /// The column of some of its points, of which there are `all`.
    pub(super) fn of_points(self, points: &[u32], all: usize) -> Self {
        let components = self.values.chunks(all);
        let some = |component: &[f64]| -> Vec<f64> {
            points.iter().map(|&i| component[i as usize]).collect()
        };
        Self {
            values: components.flat_map(some).collect(),
            ..self
        }
    }

    /// The values, component-major.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// The values as arrays of a file that keeps each component of a tensor as an array of its own; `points` is their number.
    pub(super) fn arrays(&self, points: usize) -> Vec<&[f64]> {
        match self.kind {
            FieldKind::Tensor => self.values.chunks(points).collect(),
            _ => vec![&self.values],
        }
    }

    /// The arrays of a VTU file: a tensor as one with six components, and each of its components as a scalar.
    pub(super) fn in_vtu(&self, dimension: usize, points: usize) -> Vec<VtuColumn<'_>> {
        let array = |name: String, array| VtuColumn {
            name,
            unit: self.unit,
            array,
        };
        let whole = match self.kind {
            FieldKind::Scalar => VtuArray::Scalar(&self.values),
            FieldKind::Vector | FieldKind::List => VtuArray::Vector(&self.values),
            FieldKind::Tensor => VtuArray::Tensor(dimension, &self.values),
            FieldKind::Integer => {
                VtuArray::Integers(self.values.iter().map(|x| *x as i32).collect())
            }
        };
        let mut arrays = vec![array(self.name.clone(), whole)];
        if self.kind == FieldKind::Tensor {
            let parts = self.components.iter();
            for (part, values) in parts.zip(self.values.chunks(points)) {
                let name = format!("{}_{part}", self.name);
                arrays.push(array(name, VtuArray::Scalar(values)));
            }
        }
        arrays
    }
}

/// An array of a VTU file.
pub(super) struct VtuColumn<'a> {
    name: String,
    unit: &'static str,
    array: VtuArray<'a>,
}

enum VtuArray<'a> {
    Scalar(&'a [f64]),
    Vector(&'a [f64]),
    Tensor(usize, &'a [f64]),
    Integers(Vec<i32>),
}

impl VtuColumn<'_> {
    pub(super) fn field(&self, single_precision: bool) -> VtkField<'_> {
        let name = &self.name;
        let field = match &self.array {
            VtuArray::Scalar(values) => VtkField::scalar(name, values),
            VtuArray::Vector(values) => VtkField::vector(name, values),
            VtuArray::Tensor(dimension, values) => {
                VtkField::symmetric_tensor(name, *dimension, values)
            }
            VtuArray::Integers(numbers) => VtkField::integers(name, numbers),
        };
        let field = field.unit(self.unit);
        match single_precision {
            true => field.in_single_precision(),
            false => field,
        }
    }
}
