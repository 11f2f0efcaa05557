//! The stretched field of one layer: continued shifts and their memory.
//!
//! The field is stored for many *lanes*, the tangential places and components that do not interact. Lanes are divided into
//! blocks of fixed length, which threads compute independently, so that results do not depend on their number.

use rayon::prelude::*;

/// Lanes of a block.
pub(super) const LANES: usize = 32;

/// A layer at an open end; depths n count nodes from the interface (n = 0) to the end (n = N), shifts j outwards.
pub(super) struct Layer {
    /// N.
    cells: usize,
    /// K.
    reach: usize,
    /// Half of σ of each cell, 1/s.
    half: Vec<f64>,
    /// α, 1/s.
    alpha: f64,
    /// Lanes of one component, a multiple of [`LANES`].
    width: usize,
    /// U by block and slot, m.
    shifts: Vec<f64>,
    /// h = ψ + dt/2 dψ/dt by block, cell and shift j + 1/2, m.
    pub(super) memory: Vec<f64>,
}

/// Sets the unstretched displacements of a node: depth, component, first lane and the values of a block.
pub(super) type Fill<'a> = dyn Fn(isize, usize, usize, &mut [f64]) + Sync + 'a;

impl Layer {
    /// Makes a layer at rest with the rates σ (1/s) of its cells for `components` components of `lanes` lanes.
    pub(super) fn new(
        reach: usize,
        sigma: &[f64],
        alpha: f64,
        (components, lanes): (usize, usize),
    ) -> Self {
        let cells = sigma.len();
        let width = lanes.div_ceil(LANES) * LANES;
        let mut layer = Self {
            cells,
            reach,
            half: sigma.iter().map(|sigma| 0.5 * sigma).collect(),
            alpha,
            width,
            shifts: Vec::new(),
            memory: vec![0.0; components * width * cells * 2 * reach],
        };
        layer.shifts = vec![0.0; components * width * layer.slots()];
        layer
    }

    /// N.
    pub(super) fn cells(&self) -> usize {
        self.cells
    }

    /// Slots of nodes that are not stretched: depths from −(2K − 1) to N.
    fn plain(&self) -> usize {
        2 * self.reach + self.cells
    }

    fn slots(&self) -> usize {
        self.plain() + self.extended()
    }

    /// Number of slots with stretched shifts; those of one shift and successive depths follow each other.
    pub(super) fn extended(&self) -> usize {
        2 * self.reach * (self.cells + 1)
    }

    /// Slot of U_n^j.
    fn slot(&self, n: isize, j: isize) -> usize {
        // Nodes before the interface see what the interface sees.
        let (n, j) = if n < 0 && j > 0 {
            let before = j.min(-n);
            (n + before, j - before)
        } else {
            (n, j)
        };
        let reach = self.reach as isize;
        if j == 0 || n <= 0 && j < 0 {
            return (n + j + 2 * reach - 1) as usize;
        }
        let row = if j > 0 { j - 1 } else { reach - j - 1 };
        self.plain() + row as usize * (self.cells + 1) + n as usize
    }

    /// Number of U_n^j among the stretched shifts; `None` if it is the displacement of node n + j.
    pub(super) fn number(&self, n: isize, j: isize) -> Option<usize> {
        self.slot(n, j).checked_sub(self.plain())
    }

    /// Block of a lane of a component, and the lane's place in it.
    pub(super) fn block(&self, component: usize, lane: usize) -> (usize, usize) {
        ((component * self.width + lane) / LANES, lane % LANES)
    }

    /// The lanes of a block of U_n^j.
    pub(super) fn lanes(&self, block: usize, n: isize, j: isize) -> &[f64] {
        let first = (block * self.slots() + self.slot(n, j)) * LANES;
        &self.shifts[first..first + LANES]
    }

    /// Stretched shift with a number, of a lane of a component, m.
    pub(super) fn stretched(&self, number: usize, component: usize, lane: usize) -> f64 {
        let (block, place) = self.block(component, lane);
        self.shifts[(block * self.slots() + self.plain() + number) * LANES + place]
    }

    /// Computes the continued shifts from the displacements and the memory, and advances the memory by a step of length
    /// `dt` (s) of the trapezoidal rule.
    pub(super) fn advance(&mut self, dt: f64, fill: &Fill<'_>) {
        let (slots, cells) = (self.slots() * LANES, 2 * self.reach * self.cells * LANES);
        let mut shifts = std::mem::take(&mut self.shifts);
        let mut memory = std::mem::take(&mut self.memory);
        let this = &*self;
        shifts
            .par_chunks_mut(slots)
            .zip(memory.par_chunks_mut(cells))
            .enumerate()
            .for_each(|(block, (shifts, memory))| {
                let first = block * LANES;
                let (component, lane) = (first / this.width, first % this.width);
                let (slots, _) = shifts.as_chunks_mut::<LANES>();
                let depths = 1 - 2 * this.reach as isize..;
                for (n, lanes) in depths.zip(&mut slots[..this.plain()]) {
                    fill(n, component, lane, lanes);
                }
                this.extend(dt, slots, memory.as_chunks_mut().0);
            });
        (self.shifts, self.memory) = (shifts, memory);
    }

    /// Place of h_{n+1/2}^{j+1/2}.
    fn cell(&self, n: usize, j: isize) -> usize {
        n * 2 * self.reach + (j + self.reach as isize) as usize
    }

    /// Computes U outwards along the lines n + j = const. The trapezoidal rule ψ = h + dt/2 r of the memory
    /// h = ψ + dt/2 r of the last step gives, with k = σ dt/4 and a = α dt/2,
    ///
    /// ```text
    /// ψ_{n+1/2}^{j+1/2} = (h + k (U_{n+1}^{j+1} − U_n^j))/(1 + a + k) = U_{n+1}^j − U_n^{j+1}
    /// ```
    ///
    /// in which U_n^{j+1} is known last for j ≥ 0 and U_{n+1}^j for j < 0. The memory of the next step is 2 ψ − h.
    fn extend(&self, dt: f64, shifts: &mut [[f64; LANES]], memory: &mut [[f64; LANES]]) {
        let reach = self.reach as isize;
        let factors = |n: usize| {
            let k = 0.5 * dt * self.half[n];
            [k, 1.0 / (1.0 + 0.5 * dt * self.alpha + k)]
        };
        for n in (0..self.cells).rev() {
            let near = n as isize;
            for j in 0..reach {
                let [above, below] = [self.slot(near + 1, j + 1), self.slot(near, j)];
                let [above, below] = [shifts[above], shifts[below]];
                let source = shifts[self.slot(near + 1, j)];
                let memory = &mut memory[self.cell(n, j)];
                let target = &mut shifts[self.slot(near, j + 1)];
                let [k, scale] = factors(n);
                for lane in 0..LANES {
                    let psi = scale * (memory[lane] + k * (above[lane] - below[lane]));
                    target[lane] = source[lane] - psi;
                    memory[lane] = 2.0 * psi - memory[lane];
                }
            }
        }
        for n in 0..self.cells {
            let near = n as isize;
            for j in (-reach..0).rev() {
                let [above, below] = [self.slot(near + 1, j + 1), self.slot(near, j)];
                let [above, below] = [shifts[above], shifts[below]];
                let source = shifts[self.slot(near, j + 1)];
                let memory = &mut memory[self.cell(n, j)];
                let target = &mut shifts[self.slot(near + 1, j)];
                let [k, scale] = factors(n);
                for lane in 0..LANES {
                    let psi = scale * (memory[lane] + k * (above[lane] - below[lane]));
                    target[lane] = source[lane] + psi;
                    memory[lane] = 2.0 * psi - memory[lane];
                }
            }
        }
    }
}

pericles::saved! {
    impl SavedUnder(name) for Layer {
        memory: array("{name}/memory"),
        cells, reach, half, alpha, width: fixed,
        shifts: scratch,
    }
}
