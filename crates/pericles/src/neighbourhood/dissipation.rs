//! Energy dissipated by single points, for fields that heat up by it.

/// Energy dissipated by points since it was last read.
///
/// Forces that break or flow in parallel have one record per block of points, so that the order of the entries and
/// with it the energy of a point do not depend on the number of threads. Entries are read at the end of every step:
/// a record is empty between steps and needs no place in checkpoints.
#[derive(Debug, Clone, Default)]
pub struct PointDissipation {
    /// Points and energies (J) in the order in which they were recorded; `None` if no field reads them.
    entries: Option<Vec<(u32, f64)>>,
}

impl PointDissipation {
    /// Records the energies added from now on.
    pub fn follow(&mut self) {
        self.entries.get_or_insert_default();
    }

    /// Adds an energy that point i has dissipated, J.
    #[inline]
    pub fn add(&mut self, i: usize, energy: f64) {
        if let Some(entries) = &mut self.entries
            && energy != 0.0
        {
            entries.push((i as u32, energy));
        }
    }

    /// Adds the energy of each point to `out`, J, and clears the record.
    pub fn take_into(&mut self, out: &mut [f64]) {
        for (i, energy) in self.entries.iter_mut().flat_map(|all| all.drain(..)) {
            out[i as usize] += energy;
        }
    }

    /// Clears the record, whose step is undone.
    pub fn clear(&mut self) {
        if let Some(entries) = &mut self.entries {
            entries.clear();
        }
    }
}
