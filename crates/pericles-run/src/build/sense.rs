//! Warnings about pre-cracks, conditions and stiffness of a model.

use std::sync::Arc;

use pericles::System;
use pericles::family::{BondList, Crack};
use pericles::kernel::InfluenceFunction;
use pericles::material::{BondConstants, BondMaterial};
use pericles::space::{Point, PointCloud};
use pericles_deck::{Caution, KeyPath, ModelWarning, Remark, Solid};

use super::assembler::Assembler;
use super::constants::MaterialConstants;
use super::rejection::HORIZON;

impl Assembler<'_> {
    /// Warns of loads on constrained points, and of disconnected bodies.
    pub(super) fn check_conditions(&self, system: &System, cloud: &Arc<PointCloud>) {
        self.check_held_loads(system);
        let Some(solid) = self.model.body.solid() else {
            return;
        };
        if solid.shape.is_refined() {
            return;
        }
        // Constraints of static bodies are checked with their loads.
        if !self.model.time.scheme.is_static() {
            self.check_pieces(solid, cloud);
        }
    }

    /// Warns of wave speeds above those of any solid.
    pub(super) fn check_speed(
        &self,
        solid: &Solid,
        constants: &MaterialConstants,
    ) -> Option<ModelWarning> {
        /// Largest wave speed, m/s; diamond has 18 000.
        const FASTEST: f64 = 3e4;
        let modulus = constants.longitudinal_modulus(solid.state);
        let density = solid.material.density();
        let speed = (modulus / density).sqrt();
        let caution = Caution::FastWaves { speed };
        (speed > FASTEST).then(|| Remark::new("material.density", caution))
    }

    /// Warns of large stiffness errors of the body. Listed points are not checked, because they have no regular
    /// interior.
    pub(super) fn check_stiffness(&self, solid: &Solid, constants: &BondConstants, path: &KeyPath) {
        /// Common horizons and influence functions are within 6 %.
        const BULK: f64 = 0.1;
        /// With a horizon of two spacings the shear stiffness is one third too small.
        const SHEAR: f64 = 0.5;
        if solid.shape.is_listed() {
            return;
        }
        let error = constants.stiffness_error;
        if error.abs() > BULK {
            let caution = Caution::StiffnessError { error };
            self.warn(path.key("modulus"), caution);
        }
        // Relative to the actual bulk stiffness of the body.
        let error = (1.0 + constants.shear_error) / (1.0 + error) - 1.0;
        if error < -SHEAR {
            let caution = Caution::ShearStiffness { error };
            self.warn(HORIZON, caution);
        }
    }

    /// Warns of classes of breakable bonds without stiffness: they count as damage but carry no force.
    pub(super) fn check_classes(
        &self,
        material: &BondMaterial,
        constants: &BondConstants,
    ) -> Option<ModelWarning> {
        /// Relative to the largest coefficient; the bound of tuned coefficients is satisfied to rounding.
        const NOTHING: f64 = 1e-9;
        let InfluenceFunction::Classes(table) = &material.influence.function else {
            return None;
        };
        let values = table.entries().iter().map(|(_, value)| value.abs());
        let largest = values.clone().fold(0.0, f64::max);
        let empty = values.filter(|value| *value <= NOTHING * largest).count();
        let of = table.entries().len();
        let caution = Caution::EmptyClasses { empty, of };
        (empty > 0 && constants.critical_stretch.is_finite())
            .then(|| Remark::new("material.influence", caution))
    }

    /// Returns the warning about a pre-crack that cuts no bond.
    pub(super) fn useless_crack(crack: &Crack, cloud: &PointCloud) -> Caution {
        let dimension = cloud.dimension();
        let half = 0.5 * cloud.spacing();
        let ends = |c: usize| {
            let [low, high] = cloud.extent(c);
            (low - half, high + half)
        };
        let (low, high): (Vec<f64>, Vec<f64>) = (0..dimension).map(ends).unzip();
        let (least, most) = extent(crack);
        let apart = (0..dimension).any(|c| most[c] < low[c] || least[c] > high[c]);
        if apart {
            Caution::CrackOutside { low, high }
        } else {
            Caution::CrackCutsNothing
        }
    }

    fn check_held_loads(&self, system: &System) {
        // The constrained axes of each point, one bit per axis.
        let mut held = vec![0u8; system.points()];
        for motion in system.motions() {
            let axes = motion.axes().fold(0, |bits, c| bits | 1 << c);
            for &i in &motion.points {
                held[i as usize] |= axes;
            }
        }
        for (k, (given, load)) in self.model.loads.iter().zip(system.loads()).enumerate() {
            // A pressure may act along all axes.
            let components = given.amplitude.components();
            let component = |c: usize| &components[c.min(components.len() - 1)];
            let acts = |c: usize| c < system.dimension() && component(c).number() != Some(0.0);
            if !(0..3).any(acts) {
                continue;
            }
            let resisted = |&i: &u32| (0..3).all(|c| !acts(c) || held[i as usize] >> c & 1 == 1);
            let whole = |points: usize| system.domain().count(points as u64) as usize;
            let held = whole(load.points.iter().filter(|i| resisted(i)).count());
            let points = whole(load.points.len());
            // Sets may share corner points.
            if 2 * held > points {
                let caution = Caution::LoadOnHeld { held, points };
                self.warn(KeyPath::from("load").index(k), caution);
            }
        }
    }

    /// Warns of bodies that are disconnected at the start. Only bodies with pre-cracks, holes or listed points are
    /// checked, up to a maximum size.
    fn check_pieces(&self, solid: &Solid, cloud: &Arc<PointCloud>) {
        /// Maximum number of points: the neighbour search takes as long as several steps of the run.
        const MOST: usize = 50_000;
        let holes = &solid.shape.holes();
        let whole = self.model.cracks.is_empty() && holes.is_empty() && !solid.shape.is_listed();
        let joined = self.model.contact.is_some();
        let points = cloud.domain().whole_points();
        if whole || joined || points > MOST || cloud.is_periodic() {
            return;
        }
        let cloud = &match cloud.domain().is_divided() {
            true => Arc::new(cloud.whole().into_owned()),
            false => Arc::clone(cloud),
        };
        let Some(piece) = self.pieces(solid, cloud) else {
            return;
        };
        let mut sizes = vec![0usize; cloud.len()];
        piece.iter().for_each(|&first| sizes[first] += 1);
        let pieces = sizes.iter().filter(|size| **size > 0).count();
        let smallest = (0..cloud.len())
            .filter(|&first| sizes[first] > 0)
            .min_by_key(|&first| sizes[first]);
        if let (Some(first), true) = (smallest, pieces > solid.shape.pieces().len().max(1)) {
            let caution = Caution::Pieces {
                pieces,
                points: sizes[first],
                place: place(cloud, first),
            };
            self.warn("body", caution);
        }
    }

    /// Returns the connected component of each point at the start, identified by its first point.
    pub(super) fn pieces(&self, solid: &Solid, cloud: &Arc<PointCloud>) -> Option<Vec<usize>> {
        let material = &solid.material;
        // Errors of neighbour lists and cracks were reported when the operator was built.
        let horizon = self.largest_horizon(solid);
        let mut bonds = BondList::new(cloud, horizon, material.volume_correction()).ok()?;
        for (surface, ends) in self.cracks {
            bonds.cut(surface, *ends).ok()?;
        }
        Some(pieces(&bonds))
    }
}

/// Returns the position of a point, with as many components as the body has dimensions, m.
fn place(cloud: &PointCloud, i: usize) -> Vec<f64> {
    cloud.point(i)[..cloud.dimension()].to_vec()
}

/// Returns opposite corners of the bounding box of a crack.
fn extent(crack: &Crack) -> (Point, Point) {
    let plane = |[x, y]: [f64; 2]| [x, y, 0.0];
    let corners: Vec<Point> = match crack {
        Crack::Section { x } => vec![[*x, 0.0, 0.0]],
        Crack::Segment { from, to } => vec![plane(*from), plane(*to)],
        Crack::Polygon { corners } => corners.clone(),
        Crack::Disc {
            centre,
            normal,
            radius,
        } => {
            let square: f64 = normal.iter().map(|n| n * n).sum();
            let reach = |c: usize| radius * (1.0 - normal[c] * normal[c] / square).max(0.0).sqrt();
            let moved = |sign: f64| std::array::from_fn(|c| centre[c] + sign * reach(c));
            vec![moved(-1.0), moved(1.0)]
        }
        Crack::Triangles { triangles } => triangles.concat(),
        Crack::Layer { points, .. } => points.clone(),
    };
    let fold = |start: f64, pick: fn(f64, f64) -> f64| {
        std::array::from_fn(|c| corners.iter().map(|corner| corner[c]).fold(start, pick))
    };
    (
        fold(f64::INFINITY, f64::min),
        fold(f64::NEG_INFINITY, f64::max),
    )
}

/// Returns the connected component of each point, identified by its first point.
fn pieces(bonds: &BondList) -> Vec<usize> {
    let mut piece = vec![usize::MAX; bonds.len()];
    let mut waiting = Vec::new();
    for first in 0..bonds.len() {
        if piece[first] != usize::MAX {
            continue;
        }
        piece[first] = first;
        waiting.push(first);
        while let Some(i) = waiting.pop() {
            let present = bonds
                .family(i)
                .filter(|&(entry, _)| bonds.is_present(entry));
            for j in present.filter_map(|(_, site)| bonds.sites().own_point(site)) {
                if piece[j] == usize::MAX {
                    piece[j] = first;
                    waiting.push(j);
                }
            }
        }
    }
    piece
}
