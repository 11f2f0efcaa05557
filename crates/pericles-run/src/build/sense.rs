//! Whether a model makes physical sense: warnings about its pre-cracks and conditions.

use std::sync::Arc;

use pericles::System;
use pericles::family::{BondList, Crack};
use pericles::kernel::InfluenceFunction;
use pericles::material::{BondConstants, BondMaterial};
use pericles::space::{Point, PointCloud};
use pericles_deck::{Caution, KeyPath, ModelWarning, Remark, Solid};

use super::assembler::Assembler;
use super::constants::MaterialConstants;
use super::refusal::HORIZON;

impl Assembler<'_> {
    /// Warns of loads on points that cannot follow them, and of bodies in pieces.
    pub(super) fn judge_conditions(&self, system: &System, warnings: &mut Vec<ModelWarning>) {
        self.judge_held_loads(system, warnings);
        let Some(solid) = self.model.body.solid() else {
            return;
        };
        if solid.shape.is_refined() {
            return;
        }
        // Supports of static bodies are judged with their loads.
        if !self.model.time.scheme.is_static() {
            self.judge_pieces(solid, system, warnings);
        }
    }

    /// Warns of waves faster than any solid carries them.
    pub(super) fn judge_speed(
        &self,
        solid: &Solid,
        constants: &MaterialConstants,
    ) -> Option<ModelWarning> {
        /// m/s. Diamond has 18 000.
        const FASTEST: f64 = 3e4;
        let modulus = constants.longitudinal_modulus(solid.state);
        let density = solid.material.density();
        let speed = (modulus / density).sqrt();
        let caution = Caution::FastWaves { speed };
        (speed > FASTEST).then(|| Remark::new("material.density", caution))
    }

    /// Warns of constants with which the body does not have the stiffness of its material. Points of a file are not judged: they have no interior to
    /// compare with.
    pub(super) fn judge_stiffness(
        &self,
        solid: &Solid,
        constants: &BondConstants,
        path: &KeyPath,
        warnings: &mut Vec<ModelWarning>,
    ) {
        /// Usual horizons and functions stay within 6 %.
        const BULK: f64 = 0.1;
        /// A horizon of two spacings lacks a third of the shear stiffness.
        const SHEAR: f64 = 0.5;
        if solid.shape.is_listed() {
            return;
        }
        let error = constants.stiffness_error;
        if error.abs() > BULK {
            let caution = Caution::StiffnessError { error };
            warnings.push(Remark::new(path.key("modulus"), caution));
        }
        // Compared with the bulk stiffness that the body has.
        let error = (1.0 + constants.shear_error) / (1.0 + error) - 1.0;
        if error < -SHEAR {
            let caution = Caution::ShearStiffness { error };
            warnings.push(Remark::new(HORIZON, caution));
        }
    }

    /// Warns of classes of bonds that carry nothing where bonds can break: they count as damage without ever having resisted.
    pub(super) fn judge_classes(
        &self,
        material: &BondMaterial,
        constants: &BondConstants,
    ) -> Option<ModelWarning> {
        /// Of the largest coefficient; the bound of tuned coefficients is met to round-off.
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

    /// The warning about a pre-crack that cuts no bond.
    pub(super) fn useless_crack(crack: &Crack, cloud: &PointCloud) -> Caution {
        let dimension = cloud.dimension();
        let half = 0.5 * cloud.spacing();
        let ends = |c: usize| {
            let axis = cloud.axis(c).iter().copied();
            let low = axis.clone().fold(f64::INFINITY, f64::min);
            (low - half, axis.fold(f64::NEG_INFINITY, f64::max) + half)
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

    fn judge_held_loads(&self, system: &System, warnings: &mut Vec<ModelWarning>) {
        // The axes along which each point is held, one bit each.
        let mut held = vec![0u8; system.points()];
        for motion in system.motions() {
            let axes = motion.axes().fold(0, |bits, c| bits | 1 << c);
            for &i in &motion.points {
                held[i as usize] |= axes;
            }
        }
        for (k, (given, load)) in self.model.loads.iter().zip(system.loads()).enumerate() {
            // A pressure acts along all axes.
            let components = given.amplitude.components();
            let component = |c: usize| &components[c.min(components.len() - 1)];
            let acts = |c: usize| c < system.dimension() && component(c).number() != Some(0.0);
            if !(0..3).any(acts) {
                continue;
            }
            let resisted = |&i: &u32| (0..3).all(|c| !acts(c) || held[i as usize] >> c & 1 == 1);
            let (held, points) = (
                load.points.iter().filter(|i| resisted(i)).count(),
                load.points.len(),
            );
            // Sets share corners: a few points are no mistake.
            if 2 * held > points {
                let caution = Caution::LoadOnHeld { held, points };
                warnings.push(Remark::new(KeyPath::from("load").index(k), caution));
            }
        }
    }

    /// Warns of bodies that are in pieces before they break. Only what was cut, has holes or is listed can be, and larger bodies are not looked at.
    fn judge_pieces(&self, solid: &Solid, system: &System, warnings: &mut Vec<ModelWarning>) {
        /// Finding bonds takes as long as some steps of the run.
        const MOST: usize = 50_000;
        let cloud = system.cloud();
        let holes = &solid.shape.holes();
        let whole = self.model.cracks.is_empty() && holes.is_empty() && !solid.shape.is_listed();
        if whole || cloud.len() > MOST || cloud.is_periodic() {
            return;
        }
        let Some(piece) = self.pieces(solid, cloud) else {
            return;
        };
        let mut sizes = vec![0usize; cloud.len()];
        piece.iter().for_each(|&first| sizes[first] += 1);
        let pieces = sizes.iter().filter(|size| **size > 0).count();
        let smallest = (0..cloud.len())
            .filter(|&first| sizes[first] > 0)
            .min_by_key(|&first| sizes[first]);
        if let (Some(first), true) = (smallest, pieces > 1) {
            let caution = Caution::Pieces {
                pieces,
                points: sizes[first],
                place: place(cloud, first),
            };
            warnings.push(Remark::new("body", caution));
        }
    }

    /// The piece of each point, named by its first point: what bonds join at the start.
    pub(super) fn pieces(&self, solid: &Solid, cloud: &Arc<PointCloud>) -> Option<Vec<usize>> {
        let material = &solid.material;
        // What is wrong with families and cracks has been refused when the operator was made.
        let horizon = self.largest_horizon(solid);
        let mut bonds = BondList::new(cloud, horizon, material.volume_correction()).ok()?;
        for (surface, ends) in self.cracks {
            bonds.cut(surface, *ends).ok()?;
        }
        Some(pieces(&bonds))
    }
}

/// A point's place, as long as the body has dimensions, m.
fn place(cloud: &PointCloud, i: usize) -> Vec<f64> {
    cloud.point(i)[..cloud.dimension()].to_vec()
}

/// Opposite corners of the box of a crack.
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
    };
    let fold = |start: f64, pick: fn(f64, f64) -> f64| {
        std::array::from_fn(|c| corners.iter().map(|corner| corner[c]).fold(start, pick))
    };
    (
        fold(f64::INFINITY, f64::min),
        fold(f64::NEG_INFINITY, f64::max),
    )
}

/// The piece of each point, named by its first point.
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
