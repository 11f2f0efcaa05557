//! Whether a model makes physical sense: what is odd about its conditions.

use pericles::System;
use pericles::family::BondList;
use pericles::space::PointCloud;

use crate::caution::Caution;
use crate::conditions::LoadAmplitude;
use crate::deck::Deck;
use crate::finding::Warning;
use crate::reader::Path;
use crate::scheme::Scheme;

impl Deck {
    /// Warns of loads on points that cannot follow them, and of static pieces that nothing holds.
    pub(super) fn judge_conditions(&self, system: &System, warnings: &mut Vec<Warning>) {
        self.judge_held_loads(system, warnings);
        if matches!(self.time.scheme, Scheme::Relaxation(_)) && self.surface.is_none() {
            self.judge_support(system, warnings);
        }
    }

    fn judge_held_loads(&self, system: &System, warnings: &mut Vec<Warning>) {
        for (k, (given, load)) in self.loads.iter().zip(system.loads()).enumerate() {
            let (LoadAmplitude::BodyForce(field)
            | LoadAmplitude::Traction {
                traction: field, ..
            }) = &given.amplitude;
            let acts = |c: usize| c < system.dimension() && field[c].number() != Some(0.0);
            // The axes along which each point is held, one bit each.
            let mut held = vec![0u8; system.points()];
            for motion in system.motions() {
                let axes = motion.axes().fold(0, |bits, c| bits | 1 << c);
                for &i in &motion.points {
                    held[i as usize] |= axes;
                }
            }
            let resisted = |&i: &u32| (0..3).all(|c| !acts(c) || held[i as usize] >> c & 1 == 1);
            if load.points.iter().all(resisted) {
                let points = load.points.len();
                let caution = Caution::LoadOnHeld { points };
                warnings.push(self.finding(&Path::from("load").index(k), caution));
            }
        }
    }

    fn judge_support(&self, system: &System, warnings: &mut Vec<Warning>) {
        let (cloud, material) = (system.cloud(), &self.material.bonds);
        // What is wrong with the families has been refused when the operator was made.
        let Ok(mut bonds) = BondList::new(cloud, material.horizon, material.volume_correction)
        else {
            return;
        };
        for crack in &self.cracks {
            if bonds.cut(cloud, &crack.surface, crack.ends).is_err() {
                return;
            }
        }
        let piece = pieces(cloud, &bonds);
        let mut supported = vec![false; cloud.len()];
        for motion in system.motions() {
            for &i in &motion.points {
                supported[piece[i as usize]] = true;
            }
        }
        let loose: Vec<usize> = (0..cloud.len()).filter(|&i| !supported[piece[i]]).collect();
        if let Some(&first) = loose.first() {
            let caution = Caution::NoSupport {
                points: loose.len(),
                of: cloud.len(),
                place: cloud.point(first),
            };
            warnings.push(self.finding(&"time.scheme".into(), caution));
        }
    }
}

/// The piece of each point, named by its first point: what bonds join.
fn pieces(cloud: &PointCloud, bonds: &BondList) -> Vec<usize> {
    let mut piece = vec![usize::MAX; cloud.len()];
    let mut waiting = Vec::new();
    for first in 0..cloud.len() {
        if piece[first] != usize::MAX {
            continue;
        }
        piece[first] = first;
        waiting.push(first);
        while let Some(i) = waiting.pop() {
            for (entry, j) in bonds.family(i) {
                if piece[j] == usize::MAX && bonds.is_present(entry) {
                    piece[j] = first;
                    waiting.push(j);
                }
            }
        }
    }
    piece
}
