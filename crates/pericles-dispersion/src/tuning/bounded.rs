//! Least squares with inequalities, solved as a least-distance problem by non-negative least squares (Lawson &
//! Hanson 1974, chapters 20 and 23).

use nalgebra::{DMatrix, DVector};

use super::least_squares::{Rejection, least_squares};

/// Minimises ‖E y − f‖ subject to G y ≥ h; returns y and the active constraints.
pub(super) fn bounded(
    rows: &DMatrix<f64>,
    values: &DVector<f64>,
    normals: &DMatrix<f64>,
    margin: &DVector<f64>,
) -> std::result::Result<(DVector<f64>, Vec<usize>), Rejection> {
    let p = rows.ncols();
    let undetermined = Rejection::Undetermined {
        rank: 0,
        unknowns: p,
    };
    let factors = rows.clone().qr();
    let mut right = values.clone();
    factors.q_tr_mul(&mut right);
    let target = right.rows(0, p).into_owned();
    let triangle = factors.unpack_r();
    // With z = R y − target the objective is |z|.
    let Some(inverse) = triangle.try_inverse() else {
        return Err(undetermined);
    };
    let mut g = normals * &inverse;
    let mut h = margin - &g * &target;
    let tiny = 1e-12 * g.row_iter().map(|row| row.norm()).fold(0.0, f64::max);
    for c in 0..g.nrows() {
        let norm = g.row(c).norm();
        if norm > tiny {
            g.row_mut(c).scale_mut(1.0 / norm);
            h[c] /= norm;
            continue;
        }
        // An unknown determined by the equations.
        if margin[c] > 1e-12 * margin.amax() {
            return Err(Rejection::Infeasible);
        }
        g.row_mut(c).fill(0.0);
        h[c] = 0.0;
    }
    let unit = h.amax().max(f64::MIN_POSITIVE);
    h /= unit;
    let mut matrix = DMatrix::zeros(p + 1, g.nrows());
    matrix.rows_mut(0, p).copy_from(&g.transpose());
    matrix.row_mut(p).copy_from(&h.transpose());
    let mut last = DVector::zeros(p + 1);
    last[p] = 1.0;
    let u = non_negative(&matrix, &last);
    let residual = &last - &matrix * &u;
    if residual.norm() < 1e-9 {
        return Err(Rejection::Infeasible);
    }
    let z = residual.rows(0, p) * (-unit / residual[p]);
    // Marginally infeasible bounds leave a small residual instead of none.
    let violated = (&h * unit - &g * &z).max();
    if violated > 1e-9 * unit.max(z.amax()) {
        return Err(Rejection::Infeasible);
    }
    let y = inverse * (z + target);
    let active = (0..u.len()).filter(|c| u[*c] > 0.0).collect();
    Ok((y, active))
}

/// Minimises ‖M x − f‖ subject to x ≥ 0 (Lawson & Hanson's NNLS).
fn non_negative(matrix: &DMatrix<f64>, values: &DVector<f64>) -> DVector<f64> {
    let n = matrix.ncols();
    let mut x = DVector::zeros(n);
    let mut passive: Vec<usize> = Vec::new();
    // Finite in exact arithmetic; the limit guards against round-off.
    for _ in 0..30 * n.max(1) {
        let gradient = matrix.transpose() * (values - matrix * &x);
        let entering = (0..n)
            .filter(|c| !passive.contains(c) && gradient[*c] > 1e-12)
            .max_by(|a, b| gradient[*a].total_cmp(&gradient[*b]));
        let Some(entering) = entering else { break };
        passive.push(entering);
        loop {
            let columns = matrix.select_columns(&passive);
            let Ok((s, _)) = least_squares(&columns, values) else {
                // The new column is linearly dependent.
                passive.retain(|c| *c != entering);
                return x;
            };
            let step = (0..passive.len())
                .filter(|k| s[*k] <= 0.0)
                .map(|k| x[passive[k]] / (x[passive[k]] - s[k]))
                .fold(1.0, f64::min);
            for (k, c) in passive.iter().enumerate() {
                x[*c] += step * (s[k] - x[*c]);
            }
            if step >= 1.0 {
                break;
            }
            passive.retain(|c| x[*c] > 1e-14);
            for c in 0..n {
                if !passive.contains(&c) {
                    x[c] = 0.0;
                }
            }
            if passive.is_empty() {
                break;
            }
        }
    }
    x
}
