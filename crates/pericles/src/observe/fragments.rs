//! Fragments: sets of points connected by unbroken bonds.

use crate::operator::Force;
use crate::system::System;

/// The connected pieces of a body: two points belong to the same piece if a chain of unbroken bonds connects them.
/// A single bond is enough, so that pieces connected by one bond count as one. Cost: a pass over all bonds (10 ns
/// each on one core) and 4 bytes per point.
#[derive(Debug, Clone)]
pub struct Fragments {
    /// First point of the piece of each point.
    first: Vec<u32>,
}

/// Numbers and masses of the pieces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FragmentCount {
    /// Number of pieces heavy enough to count as fragments.
    pub fragments: u64,
    /// Mass of the heaviest piece, kg.
    pub largest: f64,
    /// Number of lighter pieces with two or more points.
    pub small: u64,
    /// Mass of these pieces, kg.
    pub small_mass: f64,
    /// Number of points without unbroken bonds.
    pub single: u64,
    /// Mass of these points, kg.
    pub single_mass: f64,
}

impl Fragments {
    /// Finds the pieces of a body whose bonds can break.
    pub fn of(operator: &dyn Force) -> Self {
        let mut first: Vec<u32> = (0..operator.points() as u32).collect();
        if let Some(breaking) = operator.capabilities().breaking {
            breaking.for_each_intact(&mut |i, j| {
                let (i, j) = (root(&mut first, i as u32), root(&mut first, j as u32));
                // The smaller number is the parent, whatever the order of the bonds.
                first[i.max(j) as usize] = i.min(j);
            });
        }
        for i in 0..first.len() as u32 {
            let root = root(&mut first, i);
            first[i as usize] = root;
        }
        Self { first }
    }

    /// Returns, for each point, the first point of its piece.
    pub fn first(&self) -> &[u32] {
        &self.first
    }

    /// Counts the pieces, given the mass of each point (kg). A piece of two or more points with at least the
    /// fraction `smallest` of the total mass is a fragment.
    pub fn count(&self, masses: &[f64], smallest: f64) -> FragmentCount {
        let mut points = vec![0u32; masses.len()];
        let mut mass = vec![0.0; masses.len()];
        for (&first, m) in self.first.iter().zip(masses) {
            points[first as usize] += 1;
            mass[first as usize] += m;
        }
        let least = smallest * masses.iter().sum::<f64>();
        let mut count = FragmentCount::default();
        for (points, mass) in points.into_iter().zip(mass) {
            count.largest = count.largest.max(mass);
            match points {
                0 => {}
                1 => {
                    count.single += 1;
                    count.single_mass += mass;
                }
                _ if mass < least => {
                    count.small += 1;
                    count.small_mass += mass;
                }
                _ => count.fragments += 1,
            }
        }
        count
    }
}

/// Returns the first point of a piece, with path compression.
fn root(first: &mut [u32], mut i: u32) -> u32 {
    while first[i as usize] != i {
        let next = first[first[i as usize] as usize];
        first[i as usize] = next;
        i = next;
    }
    i
}

impl Fragments {
    /// Numbers of the fragments of all points, from 0 in the order of the lowest user number in each.
    pub(super) fn numbers(system: &System) -> Vec<f64> {
        let operator = system.operator();
        if operator.capabilities().breaking.is_none() {
            return vec![0.0; system.points()];
        }
        let cloud = system.cloud();
        let fragments = Self::of(operator);
        let mut in_order: Vec<u32> = (0..cloud.len() as u32).collect();
        in_order.sort_unstable_by_key(|&i| cloud.user_number(i as usize));
        let mut numbers = vec![f64::NAN; cloud.len()];
        let mut count = 0.0;
        for i in in_order {
            let first = fragments.first()[i as usize] as usize;
            if numbers[first].is_nan() {
                numbers[first] = count;
                count += 1.0;
            }
        }
        let first = fragments.first().iter();
        first.map(|&first| numbers[first as usize]).collect()
    }
}
