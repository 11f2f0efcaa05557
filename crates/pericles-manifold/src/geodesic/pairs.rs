//! Pairs of vertices with their distances.

use rayon::prelude::*;

/// Pairs of vertices with their distances, in compressed rows: the neighbours of vertex i are entries
/// `start[i]..start[i + 1]`. Each pair is stored twice, with the same distance.
#[derive(Debug, Clone, PartialEq)]
pub struct GeodesicPairs {
    /// First entry of each vertex, and the number of entries at the end.
    pub start: Vec<usize>,
    /// Neighbours, ascending in each row.
    pub neighbour: Vec<u32>,
    /// Distances, m.
    pub distance: Vec<f64>,
}

impl GeodesicPairs {
    /// Searches the row of every vertex in parallel and makes the result symmetric: a pair found from either
    /// end belongs to both rows, with the smaller of the two distances.
    ///
    /// `search(state, i, row)` writes the neighbours of i into `row`, each once, in any order.
    pub(super) fn search<S>(
        vertices: usize,
        state: impl Fn() -> S + Sync + Send,
        search: impl Fn(&mut S, u32, &mut Vec<(u32, f64)>) + Sync + Send,
    ) -> Self {
        let rows: Vec<Vec<(u32, f64)>> = (0..vertices as u32)
            .into_par_iter()
            .map_init(state, |state, source| {
                let mut row = Vec::new();
                search(state, source, &mut row);
                row.sort_unstable_by_key(|&(neighbour, _)| neighbour);
                row
            })
            .collect();
        Self::symmetric(&rows)
    }

    /// Builds symmetric pairs from rows with ascending neighbours.
    pub(super) fn symmetric(rows: &[Vec<(u32, f64)>]) -> Self {
        let turned = transposed(rows);
        let merged: Vec<Vec<(u32, f64)>> = rows
            .par_iter()
            .enumerate()
            .map(|(i, row)| merge(row, turned.entries(i)))
            .collect();
        let mut start = Vec::with_capacity(rows.len() + 1);
        start.push(0);
        for row in &merged {
            start.push(start[start.len() - 1] + row.len());
        }
        let entries = || merged.iter().flatten();
        Self {
            neighbour: entries().map(|&(neighbour, _)| neighbour).collect(),
            distance: entries().map(|&(_, distance)| distance).collect(),
            start,
        }
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.start.len() - 1
    }

    /// Number of entries; each pair counts twice.
    pub fn len(&self) -> usize {
        self.neighbour.len()
    }

    /// Returns true if there are no pairs.
    pub fn is_empty(&self) -> bool {
        self.neighbour.is_empty()
    }

    /// Neighbours of a vertex and their distances, m.
    pub fn row(&self, vertex: usize) -> (&[u32], &[f64]) {
        let row = self.start[vertex]..self.start[vertex + 1];
        (&self.neighbour[row.clone()], &self.distance[row])
    }

    /// Returns the distance of two vertices, m, if it is below the horizon.
    pub fn between(&self, a: usize, b: usize) -> Option<f64> {
        let (neighbours, distances) = self.row(a);
        let place = neighbours.binary_search(&(b as u32)).ok()?;
        Some(distances[place])
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.start[..])
            + size_of_val(&self.neighbour[..])
            + size_of_val(&self.distance[..])
    }
}

struct Transposed {
    start: Vec<usize>,
    entries: Vec<(u32, f64)>,
}

impl Transposed {
    fn entries(&self, row: usize) -> &[(u32, f64)] {
        &self.entries[self.start[row]..self.start[row + 1]]
    }
}

fn transposed(rows: &[Vec<(u32, f64)>]) -> Transposed {
    let mut start = vec![0; rows.len() + 1];
    for &(column, _) in rows.iter().flatten() {
        start[column as usize + 1] += 1;
    }
    for k in 1..start.len() {
        start[k] += start[k - 1];
    }
    let mut next = start.clone();
    let mut entries = vec![(0, 0.0); start[rows.len()]];
    for (number, row) in rows.iter().enumerate() {
        for &(column, distance) in row {
            let place = &mut next[column as usize];
            entries[*place] = (number as u32, distance);
            *place += 1;
        }
    }
    Transposed { start, entries }
}

/// Merges two rows, with the smaller distance for shared neighbours.
fn merge(a: &[(u32, f64)], b: &[(u32, f64)]) -> Vec<(u32, f64)> {
    let (mut a, mut b) = (a.iter().copied().peekable(), b.iter().copied().peekable());
    let mut merged = Vec::new();
    while let Some(first) = [a.peek(), b.peek()]
        .into_iter()
        .flatten()
        .map(|e| e.0)
        .min()
    {
        let both = [a.next_if(|e| e.0 == first), b.next_if(|e| e.0 == first)];
        let distance = both
            .into_iter()
            .flatten()
            .map(|e| e.1)
            .fold(f64::INFINITY, f64::min);
        merged.push((first, distance));
    }
    merged
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pair_found_from_one_end_is_stored_in_both_rows() {
        let rows = vec![vec![(1, 0.5), (2, 0.9)], vec![(0, 0.4)], vec![]];
        let pairs = GeodesicPairs::symmetric(&rows);
        assert_eq!(pairs.start, [0, 2, 3, 4]);
        assert_eq!(pairs.neighbour, [1, 2, 0, 0]);
        assert_eq!(pairs.distance, [0.4, 0.9, 0.4, 0.9]);
        assert_eq!(
            (pairs.between(0, 2), pairs.between(1, 2)),
            (Some(0.9), None)
        );
    }
}
