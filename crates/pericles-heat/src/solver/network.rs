//! The network of conductors that approximates a body by a sparse matrix.

use pericles::parallel::for_each_point;

use crate::diffusion::{Bond, Diffusion};

/// Conductors of a point: the number of the other end in the whole body, and the conductance, W/K.
type Row = Vec<(u32, f64)>;

/// Returns the conductors between neighbouring points of the whole body with `points` points, row by row and symmetric. All
/// processes must call it together and obtain the same network.
pub(super) fn near_network(diffusion: &Diffusion, points: usize) -> Vec<Row> {
    let mut rows: Vec<Row> = vec![Vec::new(); points];
    for (i, chosen) in of_whole_body(diffusion, chosen(diffusion), points)
        .into_iter()
        .enumerate()
    {
        for (j, conductance) in chosen {
            rows[i].push((j, conductance));
            rows[j as usize].push((i as u32, conductance));
        }
    }
    for row in &mut rows {
        row.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        row.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
    }
    rows
}

/// Returns the conductors that each own point selects: its short bonds, with a factor such that unit gradients, averaged over the
/// axes, have the energy of all bonds. Each end that selects a bond contributes half of the mean.
fn chosen(diffusion: &Diffusion) -> Vec<Row> {
    let cloud = diffusion.cloud();
    let (n, d) = (cloud.len(), cloud.dimension());
    /// Squared reach in cells. Bonds to next neighbours alone would need a third more products.
    const REACH: f64 = 4.1;
    let nearest = [4, 12, 32][d - 1];
    let square = |bond: &Bond| bond.xi.iter().map(|x| x * x).sum::<f64>();
    let number = |bond: &Bond| cloud.domain().number(bond.neighbour);
    for_each_point(n, &|i| {
        let mut all = Vec::new();
        diffusion.for_each_bond(i, &mut |bond| {
            if bond.neighbour != i {
                all.push(bond);
            }
        });
        let moment: f64 = all.iter().map(|bond| bond.conductance * square(bond)).sum();
        let cells = |bond: &Bond| {
            (0..d)
                .map(|c| (bond.xi[c] / cloud.cell_side(c)).powi(2))
                .sum::<f64>()
        };
        all.sort_by(|a, b| {
            cells(a)
                .total_cmp(&cells(b))
                .then(number(a).cmp(&number(b)))
        });
        let near = match cloud.cell_sides() {
            Some(_) => all.partition_point(|bond| cells(bond) <= REACH),
            None => nearest,
        };
        all.truncate(near.max(2 * d));
        let own: f64 = all.iter().map(|bond| bond.conductance * square(bond)).sum();
        let coefficient = if own > 0.0 { moment / own } else { 0.0 };
        let conductor = |bond: &Bond| {
            let conductance = 0.5 * coefficient * bond.conductance;
            (number(bond) as u32, conductance)
        };
        all.iter().map(conductor).collect()
    })
}

/// Returns the rows of all points of the whole body in the order of their numbers, from those of own points.
fn of_whole_body(diffusion: &Diffusion, own: Vec<Row>, points: usize) -> Vec<Row> {
    let domain = diffusion.cloud().domain();
    if !domain.is_divided() {
        return own;
    }
    let mut message = Vec::new();
    for (k, row) in own.iter().enumerate() {
        message.extend([domain.number(k) as f64, row.len() as f64]);
        let numbers = row.iter().flat_map(|&(j, g)| [f64::from(j), g]);
        message.extend(numbers);
    }
    drop(own);
    let mut rows = vec![Row::new(); points];
    for message in domain.collect_everywhere(message) {
        let mut rest = &message[..];
        while let [number, length, after @ ..] = rest {
            let (row, next) = after.split_at(2 * *length as usize);
            let conductors = row.chunks_exact(2).map(|one| (one[0] as u32, one[1]));
            rows[*number as usize] = conductors.collect();
            rest = next;
        }
    }
    rows
}
