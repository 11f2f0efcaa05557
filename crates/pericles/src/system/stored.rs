//! What a checkpoint keeps of a system.

use super::System;
use crate::accounts::Ledger;
use crate::archive::{Archive, Saved, Values};
use crate::error::Result;

impl Saved for System {
    fn save(&self, archive: &mut Archive) {
        self.forces.save(archive);
        for (k, motion) in self.motions.iter().enumerate() {
            archive.put(
                format!("motion/{k}/reaction"),
                Values::F64(motion.reactions().to_vec()),
            );
        }
        self.boundaries
            .iter()
            .for_each(|boundary| boundary.save(archive));
        let Ledger {
            work,
            exchanged,
            impulse: [x, y, z],
        } = self.ledger;
        archive.put("ledger", Values::F64(vec![work, exchanged, x, y, z]));
        archive.put("evaluated", Values::U64(vec![self.evaluated.get()]));
        archive.put("coarse breaks", Values::U64(vec![self.coarse_breaks.get()]));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        self.forces.restore(archive)?;
        for (k, motion) in self.motions.iter_mut().enumerate() {
            archive.f64_into(&format!("motion/{k}/reaction"), motion.reactions_mut())?;
        }
        for boundary in &mut self.boundaries {
            boundary.restore(archive)?;
        }
        let mut ledger = [0.0; 5];
        archive.f64_into("ledger", &mut ledger)?;
        let [work, exchanged, x, y, z] = ledger;
        self.ledger = Ledger {
            work,
            exchanged,
            impulse: [x, y, z],
        };
        let mut evaluated = [0];
        archive.u64_into("evaluated", &mut evaluated)?;
        self.evaluated = evaluated[0].into();
        let mut coarse_breaks = [0];
        archive.u64_into("coarse breaks", &mut coarse_breaks)?;
        self.coarse_breaks = coarse_breaks[0].into();
        Ok(())
    }
}
