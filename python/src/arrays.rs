//! Arrays between NumPy and the engine.
//!
//! The engine stores component c of point i at entry c · n + i, in an order of its own; Python sees arrays of shape
//! (points, components) in the user's order of points.

use std::sync::Arc;

use numpy::ndarray::{ArrayView2, ShapeBuilder};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pericles::space::PointCloud;
use pyo3::prelude::*;

/// Values that arrays share: the owner of the views on them.
#[pyclass(frozen, module = "pericles._pericles")]
pub struct Block(#[expect(dead_code, reason = "keeps the values alive")] pub Arc<Vec<f64>>);

/// Name, unit and values of a column of a table.
pub type TableColumn<'py> = (String, String, Bound<'py, PyArray1<f64>>);

/// Returns a read-only array of shape (points, components) that shares component-major values, without copying.
pub fn view<'py>(
    py: Python<'py>,
    values: &Arc<Vec<f64>>,
    components: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let points = values.len() / components.max(1);
    let owner = Bound::new(py, Block(Arc::clone(values)))?.into_any();
    let shape = (points, components).strides((1, points.max(1)));
    let array = ArrayView2::from_shape(shape, &values[..points * components])
        .map_err(|error| crate::errors::plain(&error.to_string()))?;
    // SAFETY: the owner keeps the values alive; nothing writes them: the array is read-only from the start.
    let array = unsafe { PyArray2::borrow_from_array(&array, owner) };
    array.readwrite().make_nonwriteable();
    Ok(array)
}

/// Returns an array of shape (points, components) that owns component-major values.
pub fn owned<'py>(
    py: Python<'py>,
    values: Vec<f64>,
    components: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let points = values.len() / components.max(1);
    let flat = PyArray1::from_vec(py, values);
    flat.reshape([components, points])?.transpose()
}

/// Returns the values of an array of shape (rows, components), component-major.
pub fn component_major(array: &PyReadonlyArray2<'_, f64>) -> Vec<f64> {
    let array = array.as_array();
    array
        .columns()
        .into_iter()
        .flat_map(|column| column.to_vec())
        .collect()
}

/// Returns the values of all points of an array in the user's order, component-major in the order of the cloud.
pub fn in_cloud_order(cloud: &PointCloud, array: &PyReadonlyArray2<'_, f64>) -> Vec<f64> {
    let array = array.as_array();
    let numbers = (0..cloud.len()).map(|i| cloud.user_number(i));
    let columns = array.columns().into_iter();
    columns
        .flat_map(|column| numbers.clone().map(move |number| column[number]))
        .collect()
}

/// The points of a set in both orders.
#[derive(Debug, Clone)]
pub struct Selection {
    /// Points in the order of the cloud, ascending.
    pub points: Vec<u32>,
    /// For each of them, its place among the points in the user's order.
    pub rank: Vec<usize>,
}

impl Selection {
    /// Selects points by their user numbers.
    pub fn of_numbers(cloud: &PointCloud, numbers: &[u32]) -> Self {
        let mut wanted = vec![false; cloud.len()];
        for &number in numbers {
            wanted[number as usize] = true;
        }
        let points = (0..cloud.len()).filter(|&i| wanted[cloud.user_number(i)]);
        Self::of_points(cloud, points.map(|i| i as u32).collect())
    }

    /// Makes a selection of points of the cloud in ascending order.
    pub fn of_points(cloud: &PointCloud, points: Vec<u32>) -> Self {
        let number = |k: &usize| cloud.user_number(points[*k] as usize);
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by_key(number);
        let mut rank = vec![0; points.len()];
        for (place, &k) in order.iter().enumerate() {
            rank[k] = place;
        }
        Self { points, rank }
    }

    /// Returns the user numbers in ascending order.
    pub fn numbers(&self, cloud: &PointCloud) -> Vec<u32> {
        let numbers = self
            .points
            .iter()
            .map(|&i| cloud.user_number(i as usize) as u32);
        let mut numbers: Vec<u32> = numbers.collect();
        numbers.sort_unstable();
        numbers
    }

    /// Reorders component-major values from the user's order to the order of the points.
    pub fn ordered(&self, given: &[f64]) -> Vec<f64> {
        let n = self.points.len();
        let columns = given.chunks(n.max(1));
        columns
            .flat_map(|column| self.rank.iter().map(move |&rank| column[rank]))
            .collect()
    }

    /// Returns the positions in the user's order, component-major.
    pub fn positions(&self, cloud: &PointCloud) -> Vec<f64> {
        let (n, dimension) = (self.points.len(), cloud.dimension());
        let mut positions = vec![0.0; n * dimension];
        for (&i, &rank) in self.points.iter().zip(&self.rank) {
            for c in 0..dimension {
                positions[c * n + rank] = cloud.axis(c)[i as usize];
            }
        }
        positions
    }
}
