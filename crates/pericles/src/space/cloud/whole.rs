//! The points of the whole body on every process.

use std::borrow::Cow;

use super::PointCloud;
use crate::domain::{Domain, Replicated};
use crate::space::Lattice;

impl PointCloud {
    /// Returns the points of the whole body as points of a single process, from the parts of all processes. Its memory does
    /// not decrease with their number. All processes must call it together.
    pub fn whole(&self) -> Cow<'_, Self> {
        if !self.domain.is_divided() {
            return Cow::Borrowed(self);
        }
        let all = Replicated::new(&self.domain);
        let whole = |numbers: &[u32]| -> Vec<u32> {
            let numbers: Vec<f64> = numbers.iter().map(|&k| f64::from(k)).collect();
            all.of(&numbers).iter().map(|&k| k as u32).collect()
        };
        // Arrays are empty on all processes or on none.
        let lattice = self.lattice.as_ref().map(|lattice| Lattice {
            node: whole(&lattice.node),
            ..lattice.clone()
        });
        Cow::Owned(Self {
            positions: all.of(&self.positions).into_owned(),
            volumes: all.of(&self.volumes).into_owned(),
            lattice,
            user_numbers: whole(&self.user_numbers),
            blocks: whole(&self.blocks),
            pieces: whole(&self.pieces),
            domain: Domain::alone(all.points()),
            ..*self
        })
    }
}
