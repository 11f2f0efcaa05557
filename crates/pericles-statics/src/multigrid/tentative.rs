//! Tentative prolongation: rigid-body motions of aggregates.

use super::aggregate::{ALONE, aggregates};
use super::nodes::Nodes;
use crate::sparse::SparseMatrix;

/// Relative size of an orthogonalised vector below which it is linearly dependent.
const DEPENDENT: f64 = 1e-7;

/// Tentative prolongation and the nodes of the coarse level, one for each aggregate.
pub struct Tentative {
    pub matrix: SparseMatrix,
    pub coarse: Nodes,
}

/// Orthonormal basis of the vectors on an aggregate, and the coefficients of the vectors.
struct Basis {
    /// Basis vectors, one after the other.
    vectors: Vec<Vec<f64>>,
    /// Coefficients of the given vectors along each basis vector, row by row.
    coefficients: Vec<Vec<f64>>,
}

impl Basis {
    /// Computes the basis by the Gram–Schmidt method, applied twice for accuracy. Linearly dependent vectors
    /// are skipped.
    fn new(unknowns: &[usize], nodes: &Nodes) -> Self {
        let given = nodes.count;
        let mut basis = Self {
            vectors: Vec::new(),
            coefficients: Vec::new(),
        };
        for k in 0..given {
            let mut vector: Vec<f64> = unknowns
                .iter()
                .map(|&row| nodes.vectors[row * given + k])
                .collect();
            let size = norm(&vector);
            for _ in 0..2 {
                for (q, row) in basis.vectors.iter().zip(&mut basis.coefficients) {
                    let along: f64 = q.iter().zip(&vector).map(|(q, v)| q * v).sum();
                    row[k] += along;
                    vector.iter_mut().zip(q).for_each(|(v, q)| *v -= along * q);
                }
            }
            let left = norm(&vector);
            if left > DEPENDENT * size && basis.vectors.len() < unknowns.len() {
                vector.iter_mut().for_each(|v| *v /= left);
                basis.vectors.push(vector);
                let mut row = vec![0.0; given];
                row[k] = left;
                basis.coefficients.push(row);
            }
        }
        basis
    }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|v| v * v).sum::<f64>().sqrt()
}

impl Tentative {
    pub fn new(matrix: &SparseMatrix, nodes: &Nodes) -> Self {
        let (of_node, count) = aggregates(matrix, nodes);
        let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (node, &aggregate) in of_node.iter().enumerate() {
            if aggregate != ALONE {
                members[aggregate as usize].extend(nodes.unknowns(node));
            }
        }
        let bases: Vec<Basis> = members
            .iter()
            .map(|unknowns| Basis::new(unknowns, nodes))
            .collect();
        let mut coarse = Nodes {
            start: vec![0],
            count: nodes.count,
            vectors: Vec::new(),
        };
        // Aggregate of each unknown, and its index within the aggregate.
        let mut place = vec![None; matrix.rows()];
        for (aggregate, (basis, unknowns)) in bases.iter().zip(&members).enumerate() {
            let first = coarse.start[aggregate];
            coarse.start.push(first + basis.vectors.len());
            coarse.vectors.extend(basis.coefficients.iter().flatten());
            for (k, &unknown) in unknowns.iter().enumerate() {
                place[unknown] = Some((aggregate, k));
            }
        }
        let columns = *coarse.start.last().unwrap_or(&0);
        let start = &coarse.start;
        let matrix = SparseMatrix::from_rows(matrix.rows(), columns, &|row, add| {
            if let Some((aggregate, k)) = place[row] {
                for (q, vector) in bases[aggregate].vectors.iter().enumerate() {
                    add(start[aggregate] + q, vector[k]);
                }
            }
        });
        Self { matrix, coarse }
    }
}
