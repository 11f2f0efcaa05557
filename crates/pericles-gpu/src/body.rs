//! The points and bonds of a body in the arrays of a device.
//!
//! The arrays have one entry for each place of the padded rows of the lattice, so that a neighbour is a constant number of places
//! away; see [`GridLayout`].

use pericles::neighbourhood::{GridLayout, Lattice, Neighbourhood};
use pericles::operator::{CriticalStretches, StencilData, StencilLaw, StencilMaterial};
use pericles::{PointScalar, System};

use crate::flags::{GUIDED, HELD, MATERIAL, OWN};
use crate::precision::Units;

/// Nodes of a chunk.
const LANES: usize = 8;
/// Bonds in a word of the intact bits.
const WORD: usize = 32;

/// A bond of the stencil, in the units of the device.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bond {
    /// Distance to the neighbour, in places.
    pub shift: isize,
    /// ξ.
    pub xi: [f64; 3],
    /// |ξ|².
    pub square: f64,
    /// 1/|ξ|².
    pub inverse_square: f64,
    /// c α κ V/(|ξ| ρ), with the density of the first point; of a solid its weight ω relative to the largest one.
    pub stiffness: f64,
}

/// The critical stretches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Critical {
    /// The same of all bonds.
    Uniform(f64),
    /// By the materials of both ends.
    Pairs {
        /// The smallest of all bonds.
        smallest: f64,
        /// Number of materials.
        materials: usize,
        /// Whether strengths scatter.
        scatters: bool,
    },
}

/// Geometry and constants of a body on a device.
#[derive(Debug)]
pub(crate) struct Body {
    pub dimension: usize,
    /// Padded rows: places along each axis.
    pub shape: [usize; 3],
    pub places: usize,
    /// Unused places between the components and at both ends.
    pub margin: usize,
    pub law: StencilLaw,
    pub bonds: Vec<Bond>,
    pub critical: Critical,
    pub has_densities: bool,
    /// Constants of the material.
    constants: Constants,
    /// Directed bonds of the body.
    pub directed_bonds: u64,
    /// Place of each point.
    pub place_of: Vec<u32>,
    /// Images beyond periodic faces: place and place of the point.
    pub images: Vec<[u32; 2]>,
    pub units: Units,
    /// Density of each point relative to that of the first one, inverted; by places.
    densities: Vec<f64>,
    /// ξ and weight of each offset, for loops over offsets.
    offsets: Vec<f64>,
    /// Critical stretches of pairs of materials.
    table: Vec<f64>,
    /// Factors of the critical stretches, by places.
    strengths: Vec<f64>,
    /// Flags of places without constraints.
    flags: Vec<u32>,
}

/// Constants of a material in the units of the device.
#[derive(Debug)]
struct Constants {
    /// c α κ V/(|ξ| ρ) of the offsets; of a solid ω relative to the largest.
    offsets: Vec<f64>,
    /// Row of factors of each chunk of places.
    factor_rows: Vec<u32>,
    factors: Vec<f64>,
    /// D/m, A/m, B/m and A/D of a solid, by places.
    solid: [Vec<f64>; 4],
}

/// Critical stretches by materials and places.
#[derive(Default)]
struct Limits<'a> {
    materials: &'a [u8],
    table: Vec<f64>,
    strengths: Vec<f64>,
}

impl Constants {
    /// Collects the constants of a material with the density `first` of the first point.
    fn new(
        data: &StencilData<'_>,
        (place_of, images): (&[u32], &[[u32; 2]]),
        first: f64,
        units: Units,
    ) -> Self {
        let (layout, stencil) = (data.bonds.form().layout(), data.bonds.form().stencil());
        let places = layout.places();
        let per_acceleration = units.time * units.time / first;
        let mut constants = Self {
            offsets: Vec::new(),
            factor_rows: Vec::new(),
            factors: Vec::new(),
            solid: [const { Vec::new() }; 4],
        };
        match &data.material {
            StencilMaterial::Bonds { stiffness, factors } => {
                if let Some(of_chunks) = factors {
                    constants.factor_rows = vec![0; places / LANES];
                    for (chunk, &row) in layout.chunks().iter().zip(of_chunks.rows) {
                        constants.factor_rows[chunk.place as usize] = row;
                    }
                    constants.factors = of_chunks.values.to_vec();
                }
                let per_length = |k: usize| stiffness[k] / stencil.lengths()[k];
                let per_density = |k| per_length(k) / first * (units.time * units.time);
                constants.offsets = (0..stencil.len()).map(per_density).collect();
            }
            StencilMaterial::Solid(of) => {
                let largest = of.weights.iter().copied().fold(0.0, f64::max);
                let square = units.length * units.length;
                let lists = [
                    (of.dilatation, largest * square),
                    (of.pressure, largest * per_acceleration),
                    (of.stiffness, largest * per_acceleration),
                    (of.bulk, per_acceleration / square),
                ];
                constants.solid = lists.map(|(of_points, factor)| {
                    let mut of_places = vec![0.0; places];
                    for (&place, value) in place_of.iter().zip(of_points) {
                        of_places[place as usize] = value * factor;
                    }
                    for &[image, source] in images {
                        of_places[image as usize] = of_places[source as usize];
                    }
                    of_places
                });
                let weights = of.weights.iter();
                constants.offsets = weights.map(|weight| weight / largest).collect();
            }
        }
        constants
    }
}

/// Returns the critical stretches of a stencil.
fn critical(stretches: &CriticalStretches) -> (Critical, Limits<'_>) {
    match stretches {
        CriticalStretches::Uniform(stretch) => (Critical::Uniform(*stretch), Limits::default()),
        CriticalStretches::Pairs {
            material,
            table,
            factors,
        } => {
            let least = |numbers: &[f64]| numbers.iter().copied().fold(f64::INFINITY, f64::min);
            // Places without points have no factor.
            let used = factors.iter().copied().filter(|factor| *factor > 0.0);
            let weakest = match factors.is_empty() {
                true => 1.0,
                false => used.fold(f64::INFINITY, f64::min),
            };
            let critical = Critical::Pairs {
                smallest: least(table) * weakest,
                materials: (table.len() as f64).sqrt().round() as usize,
                scatters: !factors.is_empty(),
            };
            let limits = Limits {
                materials: material,
                table: table.clone(),
                strengths: factors.clone(),
            };
            (critical, limits)
        }
    }
}

impl Body {
    /// Collects the data of a system whose force is `data`.
    pub(crate) fn new(system: &System, data: &StencilData<'_>, units: Units) -> Self {
        let lattice = data.bonds.form();
        let (layout, stencil) = (lattice.layout(), lattice.stencil());
        let strides = layout.strides();
        let places = layout.places();
        let density = system.density();
        let first = if system.points() > 0 {
            density.at(0)
        } else {
            1.0
        };
        let place_of = |i: usize| layout.place_of(i) as u32;
        let place_of: Vec<u32> = (0..system.points()).map(place_of).collect();
        let images = images(layout, &place_of);
        let constants = Constants::new(data, (&place_of, &images), first, units);
        let bond = |k: usize| {
            let xi = stencil.vectors()[k].map(|component| component / units.length);
            let square: f64 = xi.iter().map(|component| component * component).sum();
            Bond {
                shift: stencil.shifts()[k],
                xi,
                square,
                inverse_square: 1.0 / square,
                stiffness: constants.offsets[k],
            }
        };
        let (critical, limits) = critical(&data.critical);
        let mut flags = vec![0; places];
        for &place in &place_of {
            flags[place as usize] = OWN;
        }
        for (place, held) in held(lattice).into_iter().enumerate() {
            flags[place] |= if held { HELD } else { 0 };
        }
        for (flags, material) in flags.iter_mut().zip(limits.materials) {
            *flags |= u32::from(*material) << MATERIAL;
        }
        let densities = match density {
            PointScalar::Uniform(_) => Vec::new(),
            PointScalar::PerPoint(densities) => {
                let mut of_place = vec![1.0; places];
                for (&place, density) in place_of.iter().zip(densities) {
                    of_place[place as usize] = first / density;
                }
                of_place
            }
        };
        let bonds: Vec<Bond> = (0..stencil.len()).map(bond).collect();
        let numbers = |bond: &Bond| [bond.xi[0], bond.xi[1], bond.xi[2], bond.stiffness];
        Self {
            offsets: bonds.iter().flat_map(numbers).collect(),
            dimension: system.dimension(),
            shape: [
                strides[1],
                strides[2] / strides[1].max(1),
                places / strides[2].max(1),
            ],
            places,
            margin: stencil.farthest_shift().next_multiple_of(LANES),
            law: data.law,
            bonds,
            critical,
            constants,
            has_densities: !densities.is_empty(),
            directed_bonds: lattice_bonds(data.bonds),
            images,
            place_of,
            units,
            densities,
            table: limits.table,
            strengths: limits.strengths,
            flags,
        }
    }

    /// Returns whether stiffnesses of bonds have factors.
    pub(crate) fn has_factors(&self) -> bool {
        !self.constants.factors.is_empty()
    }

    /// Returns whether the material is a linear peridynamic solid.
    pub(crate) fn is_solid(&self) -> bool {
        !self.constants.solid[0].is_empty()
    }

    /// Returns the distance of the components of a vector, in entries.
    pub(crate) fn pitch(&self) -> usize {
        self.places + self.margin
    }

    /// Returns the number of entries of a vector.
    pub(crate) fn entries(&self) -> usize {
        self.dimension * self.pitch() + self.margin
    }

    /// Returns the number of words of the intact bits of a place.
    pub(crate) fn words(&self) -> usize {
        self.bonds.len().div_ceil(WORD)
    }

    /// Returns whether bonds can break.
    pub(crate) fn breaks(&self) -> bool {
        self.smallest_stretch().is_finite()
    }

    fn smallest_stretch(&self) -> f64 {
        match self.critical {
            Critical::Uniform(stretch) => stretch,
            Critical::Pairs { smallest, .. } => smallest,
        }
    }

    /// Returns the measure over |ξ|² of the weakest bond at its critical stretch.
    pub(crate) fn smallest_threshold(&self) -> f64 {
        let stretch = self.smallest_stretch();
        match self.law {
            StencilLaw::Linear => stretch,
            StencilLaw::BondStretch => stretch * (2.0 + stretch),
        }
    }

    /// Returns the entry of a component of a point, given by its entry in the arrays of the state.
    pub(crate) fn entry(&self, of_state: usize) -> usize {
        let n = self.place_of.len();
        let (c, i) = (of_state / n, of_state % n);
        c * self.pitch() + self.margin + self.place_of[i] as usize
    }

    /// Returns a vector of the state in the arrays of the device, in a unit; images have the values of their points.
    pub(crate) fn padded(&self, of_state: &[f64], unit: f64) -> Vec<f64> {
        let mut padded = vec![0.0; self.entries()];
        for (k, value) in of_state.iter().enumerate() {
            padded[self.entry(k)] = value / unit;
        }
        for &[image, source] in &self.images {
            for c in 0..self.dimension {
                let first = c * self.pitch() + self.margin;
                padded[first + image as usize] = padded[first + source as usize];
            }
        }
        padded
    }

    /// Reads a vector of the state from the arrays of the device.
    pub(crate) fn unpad(&self, padded: &[f64], unit: f64, of_state: &mut [f64]) {
        for (k, value) in of_state.iter_mut().enumerate() {
            *value = padded[self.entry(k)] * unit;
        }
    }

    /// Returns the intact bonds as bits of places.
    pub(crate) fn bits(&self, bonds: &Neighbourhood<Lattice>) -> Vec<u32> {
        let mut bits = vec![0; self.words() * self.places];
        self.for_each_group(bonds, |block, group, place, offset| {
            let byte = bonds.blocks()[block].intact[group];
            for lane in (0..LANES).filter(|lane| byte >> lane & 1 == 1) {
                bits[offset / WORD * self.places + place + lane] |= 1 << (offset % WORD);
            }
        });
        bits
    }

    /// Sets the intact bonds and counts those that broke.
    pub(crate) fn take_bits(&self, bits: &[u32], bonds: &mut Neighbourhood<Lattice>) {
        let mut blocks = bonds.take_blocks();
        self.for_each_group(bonds, |block, group, place, offset| {
            let word = &bits[offset / WORD * self.places + place..][..LANES];
            let mut intact = 0;
            for (lane, word) in word.iter().enumerate() {
                intact |= ((word >> (offset % WORD) & 1) as u8) << lane;
            }
            let state = &mut blocks[block];
            let broken = state.intact[group] & !intact;
            state.tally.broken.add(broken.count_ones().into());
            state.intact[group] &= intact;
        });
        bonds.put_blocks(blocks);
    }

    /// Calls `visit(block, byte of the block, first place, offset)` for every byte of the intact bonds.
    fn for_each_group(
        &self,
        bonds: &Neighbourhood<Lattice>,
        mut visit: impl FnMut(usize, usize, usize, usize),
    ) {
        let (layout, m) = (bonds.form().layout(), self.bonds.len());
        for block in 0..layout.blocks() {
            for (k, number) in layout.chunks_of(block).enumerate() {
                let place = layout.chunks()[number].place as usize * LANES;
                for offset in 0..m {
                    visit(block, k * m + offset, place, offset);
                }
            }
        }
    }

    /// Returns the flags of all places, given the constrained entries of the arrays of the device.
    pub(crate) fn flags(&self, guided: &[u32]) -> Vec<u32> {
        let mut flags = self.flags.clone();
        for &entry in guided {
            let entry = entry as usize - self.margin;
            flags[entry % self.pitch()] |= GUIDED << (entry / self.pitch());
        }
        flags
    }

    /// The lists of the shaders: their constants, and their content.
    pub(crate) fn lists(&self, guided: &[u32]) -> Vec<(&'static str, Vec<u32>)> {
        let images = |k: usize| self.images.iter().map(|pair| pair[k]).collect();
        // Added to a place without regard to overflow.
        let shifts = self.bonds.iter().map(|bond| bond.shift as i32 as u32);
        vec![
            ("FLAGS", self.flags(guided)),
            ("FACTOR_ROW", self.constants.factor_rows.clone()),
            ("SHIFTS", shifts.collect()),
            ("IMAGE_PLACE", images(0)),
            ("IMAGE_SOURCE", images(1)),
        ]
    }

    /// The numbers of the shaders: their constants, and their content.
    pub(crate) fn numbers(&self) -> Vec<(&'static str, &[f64])> {
        vec![
            ("OFFSETS", &self.offsets[..]),
            ("STRETCH", &self.table),
            ("STRENGTH", &self.strengths),
            ("DENSITY", &self.densities),
            ("FACTORS", &self.constants.factors),
            ("DILATATION", &self.constants.solid[0]),
            ("PRESSURE", &self.constants.solid[1]),
            ("STIFFNESS", &self.constants.solid[2]),
            ("BULK", &self.constants.solid[3]),
        ]
    }

    /// Constants of the shaders that are numbers of items.
    pub(crate) fn counts(&self) -> Vec<(&'static str, usize)> {
        let materials = match self.critical {
            Critical::Uniform(_) => 1,
            Critical::Pairs { materials, .. } => materials,
        };
        vec![
            ("MATERIALS", materials),
            ("FACTOR_LENGTH", self.bonds.len() * LANES),
            ("IMAGES", self.images.len()),
            ("BONDS", self.bonds.len()),
        ]
    }
}

/// Returns the places whose bonds never break.
fn held(lattice: &Lattice) -> Vec<bool> {
    let layout = lattice.layout();
    let bytes = lattice.held_places().unwrap_or(&[]);
    let mut held = vec![false; layout.places()];
    for (place, held) in held.iter_mut().enumerate() {
        let byte = bytes.get(place / LANES).copied().unwrap_or(0);
        *held = byte >> (place % LANES) & 1 == 1;
    }
    held
}

fn lattice_bonds(bonds: &Neighbourhood<Lattice>) -> u64 {
    use pericles::neighbourhood::Form as _;
    bonds.form().directed_bonds()
}

/// Returns the images of points: their places and those of the points.
fn images(layout: &GridLayout, place_of: &[u32]) -> Vec<[u32; 2]> {
    if layout.is_of_points() {
        return Vec::new();
    }
    let nodes = layout.nodes();
    let stride = layout.strides()[1];
    let mut images = Vec::new();
    for row in 0..nodes.rows() {
        for node in nodes.row(row) {
            let place = row * stride + nodes.column(row, node);
            let source = place_of[layout.point_at(place)];
            if source as usize != place {
                images.push([place as u32, source]);
            }
        }
    }
    images
}
