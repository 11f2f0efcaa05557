//! The description of a body in checkpoints, for runs that start from them.

use pericles::space::PointCloud;
use pericles::{Archive, System};
use serde::{Deserialize, Serialize};

/// What a run that starts from a checkpoint compares with its own body.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct BodyRecord {
    /// Digest of positions and volumes of the points.
    points: u64,
    /// Number of bonds cut by pre-cracks.
    precut_bonds: u64,
    /// Names of the arrays with the state of the body.
    arrays: Vec<String>,
}

impl BodyRecord {
    /// Describes the body of a system. All processes must call it together.
    pub(crate) fn of(system: &System, precut_bonds: u64) -> Self {
        let mut archive = Archive::default();
        system.save_body(&mut archive);
        Self {
            points: digest(system.cloud()),
            precut_bonds,
            arrays: archive.into_arrays().into_keys().collect(),
        }
    }

    /// Returns why the state of this body cannot be that of another one; `None` if it can.
    pub(crate) fn misfit(&self, other: &Self) -> Option<String> {
        if self.points != other.points {
            return Some("its points are others: `body` must be the same in both decks".into());
        }
        if self.precut_bonds != other.precut_bonds {
            return Some(format!(
                "its pre-cracks cut {} bonds, those of this deck {}: both decks must have the same [[crack]]s",
                self.precut_bonds, other.precut_bonds
            ));
        }
        let lost = |name: &&String| !other.arrays.contains(name);
        let lost: Vec<String> = (self.arrays.iter().filter(lost))
            .map(|name| format!("\"{name}\""))
            .collect();
        (!lost.is_empty()).then(|| {
            format!(
                "the body of this deck does not have its state {}: the material model, its softening or plastic flow and the computed temperature must be the same in both decks",
                lost.join(", ")
            )
        })
    }
}

/// Returns a digest of positions and volumes, equal for all divisions of a body. All processes must call it together.
fn digest(cloud: &PointCloud) -> u64 {
    let volumes = cloud.volumes();
    let of_point = |i: usize| {
        let [x, y, z] = cloud.point(i);
        let number = cloud.domain().number(i) as u64;
        let words = [
            number,
            x.to_bits(),
            y.to_bits(),
            z.to_bits(),
            volumes[i].to_bits(),
        ];
        // FNV-1a. Sums of 32 bits do not overflow.
        let hash = words.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, word| {
            word.to_le_bytes().iter().fold(hash, |hash, &byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
            })
        });
        hash >> 32
    };
    cloud.domain().count((0..cloud.len()).map(of_point).sum())
}
