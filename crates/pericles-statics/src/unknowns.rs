//! The free displacement components of a body, numbered point by point.

/// Marks an entry that is held.
const HELD: u32 = u32::MAX;

/// The unknowns of a static problem: displacement components that no support prescribes.
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
    /// Of a body whose entries are free where `free` is not zero.
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

    /// How many.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Dimension of the body.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Number of the unknown of a component at a point; none if it is held.
    pub fn number(&self, point: usize, axis: usize) -> Option<usize> {
        let number = self.numbers[axis * self.points + point];
        (number != HELD).then_some(number as usize)
    }

    /// Point and component of an unknown.
    pub fn point_and_axis(&self, number: usize) -> (usize, usize) {
        let entry = self.entries[number] as usize;
        (entry % self.points, entry / self.points)
    }

    /// First unknown of each point, and their number behind.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Sets `out` to the free entries of a component-major vector.
    pub fn gather(&self, vector: &[f64], out: &mut [f64]) {
        for (out, &entry) in out.iter_mut().zip(&self.entries) {
            *out = vector[entry as usize];
        }
    }

    /// Sets the free entries of a component-major vector, and the others to zero.
    pub fn scatter(&self, values: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (value, &entry) in values.iter().zip(&self.entries) {
            out[entry as usize] = *value;
        }
    }
}
