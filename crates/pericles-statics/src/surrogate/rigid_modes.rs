//! Rigid-body motions of a set of points.

/// Rigid-body motions of points about their centre, of unit size: translations, then rotations.
#[derive(Debug, Clone)]
pub struct RigidModes<'a> {
    dimension: usize,
    /// Axes of the rotations.
    axes: Vec<usize>,
    positions: &'a [f64],
    middle: [f64; 3],
    size: f64,
}

impl<'a> RigidModes<'a> {
    /// Creates the motions of points at these positions (m, component-major), with rotations about the selected axes.
    pub fn new(dimension: usize, rotations: [bool; 3], positions: &'a [f64]) -> Self {
        let n = positions.len() / dimension;
        let mut middle = [0.0; 3];
        let mut size: f64 = 0.0;
        for (c, axis) in positions.chunks(n).enumerate() {
            let low = axis.iter().copied().fold(f64::INFINITY, f64::min);
            let high = axis.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            middle[c] = 0.5 * (low + high);
            size = size.max(0.5 * (high - low));
        }
        Self {
            dimension,
            axes: (0..3).filter(|&axis| rotations[axis]).collect(),
            positions,
            middle,
            size: if size > 0.0 { size } else { 1.0 },
        }
    }

    /// Returns the number of motions.
    pub fn count(&self) -> usize {
        self.dimension + self.axes.len()
    }

    /// Returns the name of a motion.
    pub fn name(&self, mode: usize) -> &'static str {
        const TRANSLATIONS: [&str; 3] = [
            "translation along x",
            "translation along y",
            "translation along z",
        ];
        const ROTATIONS: [&str; 3] = ["rotation about x", "rotation about y", "rotation about z"];
        match mode.checked_sub(self.dimension) {
            None => TRANSLATIONS[mode],
            Some(rotation) => ROTATIONS[self.axes[rotation]],
        }
    }

    /// Returns component c of a mode at a point.
    pub fn value(&self, mode: usize, point: usize, c: usize) -> f64 {
        let Some(rotation) = mode.checked_sub(self.dimension) else {
            return f64::from(u8::from(mode == c));
        };
        let n = self.positions.len() / self.dimension;
        let arm = |axis: usize| (self.positions[axis * n + point] - self.middle[axis]) / self.size;
        // ω × x with ω along this axis.
        let axis = self.axes[rotation];
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        if c == next {
            -arm(last)
        } else if c == last {
            arm(next)
        } else {
            0.0
        }
    }
}
