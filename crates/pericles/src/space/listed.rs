//! Points given as lists.

use super::curve::hilbert_order;
use super::{Point, PointCloud};
use crate::error::{PericlesError, Result};

/// Points as listed by a mesh converter or another code: position, block and volume of each point.
///
/// ```
/// use pericles::space::ListedPoints;
///
/// let listed = ListedPoints {
///     positions: vec![[0.5, 0.0, 0.0], [1.5, 0.0, 0.0]],
///     blocks: vec![1, 7],
///     volumes: vec![2.0, 2.0],
/// };
/// let bar = listed.cloud(1, 2.0).unwrap();
/// assert_eq!((bar.spacing(), bar.block(1)), (1.0, 7));
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ListedPoints {
    /// Reference positions, m; components beyond the dimension of the body are ignored.
    pub positions: Vec<Point>,
    /// Block number of each point, which identifies a part of the body.
    pub blocks: Vec<u32>,
    /// Volumes, m³: in two dimensions area times thickness, in one dimension length times cross-section.
    pub volumes: Vec<f64>,
}

impl ListedPoints {
    /// Makes the cloud of these points, in the order of a space-filling curve; [`PointCloud::user_number`] returns
    /// the index of a point in this list.
    ///
    /// # Errors
    /// No points; lists of different lengths; numbers that are not finite; volumes that are not positive; two
    /// points at the same position.
    pub fn cloud(&self, dimension: usize, section: f64) -> Result<PointCloud> {
        let n = self.positions.len();
        if self.blocks.len() != n || self.volumes.len() != n {
            return Err(PericlesError::ListedLengths {
                positions: n,
                blocks: self.blocks.len(),
                volumes: self.volumes.len(),
            });
        }
        if let Some((first, second)) = self.first_twins() {
            return Err(PericlesError::SamePlace { first, second });
        }
        let order = hilbert_order(&self.positions);
        let listed = |k: &u32| *k as usize;
        let mut positions = Vec::with_capacity(dimension * n);
        for c in 0..dimension.min(3) {
            positions.extend(order.iter().map(|k| self.positions[listed(k)][c]));
        }
        let volumes = order.iter().map(|k| self.volumes[listed(k)]).collect();
        let blocks = order.iter().map(|k| self.blocks[listed(k)]).collect();
        PointCloud::new(dimension, positions, volumes, section)
            .map(|cloud| cloud.listed(order, blocks))
    }

    /// Returns the first two points at the same position, counted from 0; `None` if all positions differ.
    pub fn first_twins(&self) -> Option<(usize, usize)> {
        let mut order: Vec<usize> = (0..self.positions.len()).collect();
        // Adding 0.0 makes zeros of both signs equal.
        let key = |k: usize| self.positions[k].map(|x| x + 0.0);
        order.sort_unstable_by(|&a, &b| {
            let pairs = key(a).into_iter().zip(key(b));
            let mut unequal = pairs.map(|(x, y)| x.total_cmp(&y)).filter(|o| o.is_ne());
            unequal.next().unwrap_or(a.cmp(&b))
        });
        let twins = order.windows(2).filter(|pair| key(pair[0]) == key(pair[1]));
        twins.map(|pair| (pair[0], pair[1])).min()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_keep_their_numbers_volumes_and_blocks() {
        let n = 60u32;
        let listed = ListedPoints {
            positions: (0..n)
                .map(|k| [f64::from(k * 37 % n), f64::from(k % 7), 0.0])
                .collect(),
            blocks: (0..n).map(|k| k % 3).collect(),
            volumes: (0..n).map(|k| 1.0 + f64::from(k)).collect(),
        };
        let cloud = listed.cloud(2, 1.0).unwrap();
        for i in 0..cloud.len() {
            let number = cloud.user_number(i);
            assert_eq!(cloud.point(i), listed.positions[number]);
            assert_eq!(cloud.volumes()[i], listed.volumes[number]);
            assert_eq!(cloud.block(i), listed.blocks[number]);
        }
    }

    #[test]
    fn coincident_points_are_rejected() {
        let listed = ListedPoints {
            positions: vec![[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, -0.0, 0.0]],
            blocks: vec![1; 3],
            volumes: vec![1.0; 3],
        };
        let error = listed.cloud(1, 1.0).unwrap_err();
        assert!(matches!(
            error,
            PericlesError::SamePlace {
                first: 0,
                second: 2
            }
        ));
    }
}
