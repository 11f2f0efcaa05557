//! Aggregates of neighbouring nodes.

use crate::sparse::SparseMatrix;

use super::nodes::Nodes;

/// Couplings below this fraction of the geometric mean of the diagonal blocks are weak.
const WEAK: f64 = 0.02;

/// Marks a node without an aggregate.
pub const ALONE: u32 = u32::MAX;

/// Strong neighbours of every node.
struct Graph {
    start: Vec<usize>,
    neighbour: Vec<u32>,
    strength: Vec<f64>,
}

impl Graph {
    fn new(matrix: &SparseMatrix, nodes: &Nodes) -> Self {
        let count = nodes.len();
        let of_unknown = nodes.of_unknowns();
        let mut own = vec![0.0; count];
        for (a, own) in own.iter_mut().enumerate() {
            for row in nodes.unknowns(a) {
                let inside = matrix
                    .row(row)
                    .filter(|(k, _)| of_unknown[*k] as usize == a);
                *own += inside.map(|(_, value)| value * value).sum::<f64>();
            }
        }
        let mut graph = Self {
            start: vec![0],
            neighbour: Vec::new(),
            strength: Vec::new(),
        };
        let mut block: Vec<(u32, f64)> = Vec::new();
        for a in 0..count {
            block.clear();
            for row in nodes.unknowns(a) {
                for (k, value) in matrix.row(row) {
                    let b = of_unknown[k];
                    if b as usize != a {
                        block.push((b, value * value));
                    }
                }
            }
            block.sort_by_key(|(b, _)| *b);
            for of_one in block.chunk_by(|x, y| x.0 == y.0) {
                let b = of_one[0].0;
                let square: f64 = of_one.iter().map(|(_, square)| square).sum();
                let strength = square / (own[a] * own[b as usize]).sqrt();
                if strength > WEAK * WEAK {
                    graph.neighbour.push(b);
                    graph.strength.push(strength);
                }
            }
            graph.start.push(graph.neighbour.len());
        }
        graph
    }

    fn neighbours(&self, a: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.start[a]..self.start[a + 1];
        let neighbours = self.neighbour[range.clone()].iter();
        neighbours
            .zip(&self.strength[range])
            .map(|(&b, &strength)| (b as usize, strength))
    }
}

/// Returns the aggregate of every node and the number of aggregates. Nodes without strong neighbours are [`ALONE`].
///
/// First, in the order of their numbers, each node whose neighbours all have no aggregate forms an aggregate
/// with them. Then remaining nodes join the neighbouring aggregate with the strongest coupling. The rest
/// forms further aggregates.
pub fn aggregates(matrix: &SparseMatrix, nodes: &Nodes) -> (Vec<u32>, usize) {
    let graph = Graph::new(matrix, nodes);
    let count = nodes.len();
    let mut of_node = vec![ALONE; count];
    let mut found = 0;
    let free = |of_node: &[u32], a: usize| of_node[a] == ALONE;
    for a in 0..count {
        let mut neighbours = graph.neighbours(a).peekable();
        if neighbours.peek().is_some()
            && free(&of_node, a)
            && neighbours.all(|(b, _)| free(&of_node, b))
        {
            of_node[a] = found;
            for (b, _) in graph.neighbours(a) {
                of_node[b] = found;
            }
            found += 1;
        }
    }
    let first = of_node.clone();
    for a in (0..count).filter(|&a| first[a] == ALONE) {
        let joined = graph
            .neighbours(a)
            .filter(|(b, _)| first[*b] != ALONE)
            .reduce(|best, next| if next.1 > best.1 { next } else { best });
        if let Some((b, _)) = joined {
            of_node[a] = first[b];
        }
    }
    for a in 0..count {
        if !free(&of_node, a) || graph.neighbours(a).next().is_none() {
            continue;
        }
        of_node[a] = found;
        for (b, _) in graph.neighbours(a) {
            if free(&of_node, b) {
                of_node[b] = found;
            }
        }
        found += 1;
    }
    (of_node, found as usize)
}
