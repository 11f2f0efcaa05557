//! Nodes of a multigrid level.

/// Near-kernel vectors, from which coarse levels are built.
#[derive(Debug, Clone)]
pub struct NearKernel {
    /// First unknown of each node, followed by the number of unknowns. A node is a point with its free
    /// displacement components.
    pub nodes: Vec<usize>,
    /// Number of vectors.
    pub count: usize,
    /// The vectors, unknown by unknown: entry `unknown * count + k`.
    pub vectors: Vec<f64>,
}

/// Nodes of a level, and the vectors that its coarse level must represent.
#[derive(Debug, Clone)]
pub struct Nodes {
    pub start: Vec<usize>,
    pub count: usize,
    pub vectors: Vec<f64>,
}

impl From<NearKernel> for Nodes {
    fn from(kernel: NearKernel) -> Self {
        Self {
            start: kernel.nodes,
            count: kernel.count,
            vectors: kernel.vectors,
        }
    }
}

impl Nodes {
    /// Returns the number of nodes.
    pub fn len(&self) -> usize {
        self.start.len() - 1
    }

    /// Returns the unknowns of a node.
    pub fn unknowns(&self, node: usize) -> std::ops::Range<usize> {
        self.start[node]..self.start[node + 1]
    }

    /// Returns the node of each unknown.
    pub fn of_unknowns(&self) -> Vec<u32> {
        let nodes = 0..self.len();
        nodes
            .flat_map(|a| self.unknowns(a).map(move |_| a as u32))
            .collect()
    }
}
