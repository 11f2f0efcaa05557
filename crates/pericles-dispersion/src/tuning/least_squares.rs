//! Unconstrained least squares, and reasons why a problem has no solution.

use nalgebra::{DMatrix, DVector};

/// Reason why there is no solution.
pub(super) enum Rejection {
    /// The equations are inconsistent by this relative amount.
    Inconsistent(f64),
    /// Fewer independent rows than unknowns.
    Undetermined { rank: usize, unknowns: usize },
    /// No point satisfies the bound.
    Infeasible,
}

/// Returns the least-squares solution of a system of full column rank, and the condition number.
pub(super) fn least_squares(
    rows: &DMatrix<f64>,
    values: &DVector<f64>,
) -> std::result::Result<(DVector<f64>, f64), Rejection> {
    let unknowns = rows.ncols();
    if unknowns == 0 {
        return Ok((DVector::zeros(0), 1.0));
    }
    if rows.nrows() < unknowns {
        return Err(Rejection::Undetermined {
            rank: rows.nrows(),
            unknowns,
        });
    }
    let lengths: Vec<f64> = rows.column_iter().map(|column| column.norm()).collect();
    let scale = DVector::from_iterator(
        unknowns,
        lengths.iter().map(|l| if *l > 0.0 { 1.0 / l } else { 1.0 }),
    );
    let scaled = rows * DMatrix::from_diagonal(&scale);
    let factors = scaled.qr();
    let mut right = values.clone();
    factors.q_tr_mul(&mut right);
    let triangle = factors.unpack_r();
    let svd = triangle.svd(true, true);
    let (high, low) = (svd.singular_values.max(), svd.singular_values.min());
    let rank = svd
        .singular_values
        .iter()
        .filter(|s| **s > 1e-13 * high)
        .count();
    if rank < unknowns {
        return Err(Rejection::Undetermined { rank, unknowns });
    }
    // Both factors were computed and no singular value is cut off, so this cannot fail.
    let solved = svd.solve(&right.rows(0, unknowns).into_owned(), 0.0);
    let Ok(mut solution) = solved else {
        return Err(Rejection::Undetermined { rank: 0, unknowns });
    };
    solution.component_mul_assign(&scale);
    Ok((solution, high / low))
}
