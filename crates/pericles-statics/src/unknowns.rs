//! The free displacement components of a body, numbered point by point.

/// Marks a constrained entry.
const HELD: u32 = u32::MAX;

/// Unknowns of a static problem: the displacement components that are not constrained.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknowns {
    points: usize,
    dimension: usize,
    /// Number of the unknown of each entry of component-major vectors.
    numbers: Vec<u32>,
    /// Entry of each unknown.
    entries: Vec<u32>,
    /// First unknown of each point.
    nodes: Vec<usize>,
}

impl Unknowns {
    /// Creates the unknowns of a body whose entries are free where `free` is not zero.
    pub fn new(dimension: usize, free: &[f64]) -> Self {
        let points = free.len() / dimension;
        let mut unknowns = Self {
            points,
            dimension,
            numbers: vec![HELD; free.len()],
            entries: Vec::with_capacity(free.len()),
            nodes: vec![0],
        };
        for i in 0..points {
            for c in 0..dimension {
                let entry = c * points + i;
                if free[entry] != 0.0 {
                    unknowns.numbers[entry] = unknowns.entries.len() as u32;
                    unknowns.entries.push(entry as u32);
                }
            }
            unknowns.nodes.push(unknowns.entries.len());
        }
        unknowns
    }

    /// Returns the number of unknowns.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns whether there are no unknowns.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Returns the dimension of the body.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Returns the number of the unknown of a component at a point; `None` if it is constrained.
    pub fn number(&self, point: usize, axis: usize) -> Option<usize> {
        let number = self.numbers[axis * self.points + point];
        (number != HELD).then_some(number as usize)
    }

    /// Returns the point and component of an unknown.
    pub fn point_and_axis(&self, number: usize) -> (usize, usize) {
        let entry = self.entries[number] as usize;
        (entry % self.points, entry / self.points)
    }

    /// Returns the first unknown of each point, followed by the number of unknowns.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Sets `out` to the free entries of a component-major vector.
    pub fn gather(&self, vector: &[f64], out: &mut [f64]) {
        for (out, &entry) in out.iter_mut().zip(&self.entries) {
            *out = vector[entry as usize];
        }
    }

    /// Sets the free entries of a component-major vector, and constrained entries to zero.
    pub fn scatter(&self, values: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (value, &entry) in values.iter().zip(&self.entries) {
            out[entry as usize] = *value;
        }
    }
}
