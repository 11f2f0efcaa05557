//! Vectors of the whole body on every process.
//!
//! The preconditioner of static states and the network of implicit heat conduction are replicated: a divided
//! multigrid would need aggregates and coarse factors that do not depend on the division. Forces, products and sums
//! remain divided.

use std::borrow::Cow;

use super::{Domain, exchange_all};

impl Domain {
    /// Sends a message to all processes and returns the messages of all of them in the order of ranks. All processes must call it
    /// together.
    pub fn collect_everywhere(&self, message: Vec<f64>) -> Vec<Vec<f64>> {
        exchange_all(&*self.comm, vec![message; self.comm.size()])
    }
}

/// Makes vectors of the whole body, which every process has, from vectors of own points: for parts of a method that
/// all processes compute identically, such as the coarse levels of a preconditioner. Their memory does not decrease with the number
/// of processes.
#[derive(Debug, Clone)]
pub struct Replicated {
    domain: Domain,
    /// Numbers of the points of each process; empty if the body is not divided.
    numbers: Vec<Vec<u32>>,
    points: usize,
}

impl Replicated {
    /// Creates it for a domain. All processes must call it together.
    pub fn new(domain: &Domain) -> Self {
        let numbers = match domain.is_divided() {
            false => Vec::new(),
            true => {
                let own = (0..domain.owned_points()).map(|k| domain.number(k) as f64);
                let all = domain.collect_everywhere(own.collect()).into_iter();
                let numbers = |of: Vec<f64>| of.into_iter().map(|number| number as u32).collect();
                all.map(numbers).collect()
            }
        };
        let points = match domain.is_divided() {
            false => domain.owned_points(),
            true => numbers.iter().map(Vec::len).sum(),
        };
        Self {
            domain: domain.clone(),
            numbers,
            points,
        }
    }

    /// Number of points of the whole body.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Returns whether the body is divided among several processes.
    pub fn is_divided(&self) -> bool {
        !self.numbers.is_empty()
    }

    /// Returns a component-major vector on the points of the whole body, in the order of their numbers, from its values at own
    /// points. All processes must call it together.
    pub fn of<'a>(&self, owned: &'a [f64]) -> Cow<'a, [f64]> {
        if !self.is_divided() {
            return Cow::Borrowed(owned);
        }
        let messages = self.domain.collect_everywhere(owned.to_vec());
        let length: usize = messages.iter().map(Vec::len).sum();
        let mut whole = vec![0.0; length];
        for (numbers, values) in self.numbers.iter().zip(&messages) {
            for (c, values) in values.chunks(numbers.len().max(1)).enumerate() {
                for (&number, &value) in numbers.iter().zip(values) {
                    whole[c * self.points + number as usize] = value;
                }
            }
        }
        Cow::Owned(whole)
    }

    /// Fills the values of own points in `owned` with the values of a vector of the whole body, which `fill` computes. A process
    /// without points calls `fill` too: the number of components does not follow from the length of `owned`.
    pub fn fill_own(&self, components: usize, owned: &mut [f64], fill: impl FnOnce(&mut [f64])) {
        if !self.is_divided() {
            return fill(owned);
        }
        let own = self.domain.owned_points();
        let mut whole = vec![0.0; components * self.points];
        fill(&mut whole);
        for (c, owned) in owned.chunks_mut(own.max(1)).enumerate() {
            for (k, value) in owned.iter_mut().enumerate() {
                *value = whole[c * self.points + self.domain.number(k)];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Threads;

    #[test]
    fn every_process_has_the_vectors_of_the_whole_body() {
        // Point k belongs to process k modulo 3; the last of four processes has no points.
        Threads::run(4, |comm| {
            let rank = comm.rank() as u32;
            let numbers: Vec<u32> = (0..11).filter(|k| k % 3 == rank).collect();
            let own = numbers.len();
            let all = Replicated::new(&Domain::new(numbers.clone(), own, vec![], comm));
            let axis = |c: u32| numbers.iter().map(move |&k| f64::from(k + 100 * c));
            let values: Vec<f64> = axis(0).chain(axis(1)).collect();
            let expected: Vec<f64> = (0..11).chain(100..111).map(f64::from).collect();
            assert_eq!((all.points(), &*all.of(&values)), (11, &expected[..]));
            let mut filled = vec![0.0; 2 * own];
            all.fill_own(2, &mut filled, |whole| whole.copy_from_slice(&expected));
            assert_eq!(filled, values);
        });
    }
}
