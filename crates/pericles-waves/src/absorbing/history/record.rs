//! Stored displacements of the recorded sites.

use pericles::{Archive, Values};
use pericles::{PericlesError, Result};

/// One series per site; the first `steps` values are known.
pub(super) struct Record {
    pub(super) sites: Vec<Vec<f64>>,
    pub(super) steps: usize,
}

impl Record {
    pub(super) fn new(sites: usize, length: usize) -> Self {
        Self {
            sites: vec![vec![0.0; length]; sites],
            steps: 0,
        }
    }

    pub(super) fn push(&mut self, now: &[f64]) {
        for (site, value) in self.sites.iter_mut().zip(now) {
            site[self.steps] = *value;
        }
        self.steps += 1;
    }

    pub(super) fn bytes(&self) -> usize {
        self.sites.iter().map(|site| size_of_val(&site[..])).sum()
    }

    pub(super) fn save(&self, name: &str, archive: &mut Archive) {
        let Self { sites, steps } = self;
        let known = sites.iter().flat_map(|site| &site[..*steps]);
        archive.put(
            format!("{name}/past"),
            Values::F64(known.copied().collect()),
        );
    }

    /// Returns the stored series, concatenated, and their length: the number of steps of the archived state, plus
    /// one for boundaries that also record the start.
    pub(super) fn stored(&self, name: &str, archive: &Archive) -> Result<(Vec<f64>, usize)> {
        let past = archive.f64s(&format!("{name}/past"))?;
        let (sites, length) = (self.sites.len(), self.sites[0].len());
        let steps = past.len() / sites;
        let mut taken = [0];
        archive.u64_into("state/step", &mut taken)?;
        let is_of_state = steps
            .checked_sub(taken[0] as usize)
            .is_some_and(|first| first <= 1);
        if past.len() != steps * sites || steps > length || !is_of_state {
            return Err(PericlesError::BadArchive {
                reason: format!(
                    "the history \"{name}\" has {} values; after step {} this run needs {sites} for each, of at most \
                    {length} steps",
                    past.len(),
                    taken[0]
                ),
            });
        }
        Ok((past.to_vec(), steps))
    }
}
