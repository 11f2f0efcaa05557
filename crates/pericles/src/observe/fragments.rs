//! Fragments: sets of points connected by unbroken bonds.

use crate::domain::Domain;
use crate::operator::Force;
use crate::system::System;

/// The connected pieces of a body: two points belong to the same piece if a chain of unbroken bonds connects them.
/// A single bond is enough, so that pieces connected by one bond count as one. Cost: a pass over all bonds (10 ns
/// each on one core) and 4 bytes per point; between processes one exchange for every process that a chain of bonds passes.
#[derive(Debug, Clone)]
pub struct Fragments {
    /// First point of the piece of each own point, by its number in the whole body.
    first: Vec<u32>,
    domain: Domain,
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
    /// Finds the pieces of a body whose bonds can break. All processes must call it together.
    pub fn of(operator: &dyn Force, domain: &Domain) -> Self {
        Self {
            first: lowest(operator, domain, &|i| domain.number(i) as u32),
            domain: domain.clone(),
        }
    }

    /// Returns, for each own point, the number in the whole body of the first point of its piece.
    pub fn first(&self) -> &[u32] {
        &self.first
    }

    /// Counts the pieces, given the mass of each own point (kg). A piece of two or more points with at least the
    /// fraction `smallest` of the total mass is a fragment. All processes must call it together.
    pub fn count(&self, masses: &[f64], smallest: f64) -> FragmentCount {
        if !self.domain.is_divided() {
            return FragmentCount::of(&self.first, masses, smallest);
        }
        // Sums over points in the order of their numbers, as of a single process.
        let first: Vec<f64> = self.first.iter().map(|&k| f64::from(k)).collect();
        let whole = [&first[..], masses].map(|values| self.domain.gather(values));
        let messages = match whole {
            [Some(first), Some(masses)] => {
                let first: Vec<u32> = first.iter().map(|&k| k as u32).collect();
                let count = FragmentCount::of(&first, &masses, smallest).numbers();
                Some(vec![count.to_vec(); self.domain.comm().size()])
            }
            _ => None,
        };
        FragmentCount::of_numbers(&self.domain.distribute(messages))
    }
}

impl FragmentCount {
    /// Counts the pieces of a whole body.
    fn of(firsts: &[u32], masses: &[f64], smallest: f64) -> Self {
        let mut points = vec![0u32; masses.len()];
        let mut mass = vec![0.0; masses.len()];
        for (&first, m) in firsts.iter().zip(masses) {
            points[first as usize] += 1;
            mass[first as usize] += m;
        }
        let least = smallest * masses.iter().sum::<f64>();
        let mut count = Self::default();
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

    fn numbers(&self) -> [f64; 6] {
        let Self {
            fragments,
            largest,
            small,
            small_mass,
            single,
            single_mass,
        } = *self;
        [
            fragments as f64,
            largest,
            small as f64,
            small_mass,
            single as f64,
            single_mass,
        ]
    }

    fn of_numbers(numbers: &[f64]) -> Self {
        Self {
            fragments: numbers[0] as u64,
            largest: numbers[1],
            small: numbers[2] as u64,
            small_mass: numbers[3],
            single: numbers[4] as u64,
            single_mass: numbers[5],
        }
    }
}

/// Returns the lowest key of the points of the piece of each own point. Keys belong to own points, each different from
/// the keys of all other points of the body.
fn lowest(operator: &dyn Force, domain: &Domain, key: &dyn Fn(usize) -> u32) -> Vec<u32> {
    let n = operator.points();
    // Pieces of own points and ghosts, as far as bonds of this process connect them.
    let mut first: Vec<u32> = (0..(n + domain.ghost_points()) as u32).collect();
    if let Some(bonds) = operator.bond_set() {
        bonds.for_each_intact(&mut |i, j| {
            let (i, j) = (root(&mut first, i as u32), root(&mut first, j as u32));
            // The smaller number is the parent, whatever the order of the bonds.
            first[i.max(j) as usize] = i.min(j);
        });
    }
    for i in 0..first.len() as u32 {
        let root = root(&mut first, i);
        first[i as usize] = root;
    }
    let mut lowest = vec![u32::MAX; first.len()];
    for i in 0..n {
        let of_piece = &mut lowest[first[i] as usize];
        *of_piece = key(i).min(*of_piece);
    }
    let of_points = |lowest: &[u32]| -> Vec<u32> {
        let own = first[..n].iter();
        own.map(|&root| lowest[root as usize]).collect()
    };
    // The pieces of the processes are joined through the values of ghosts.
    let mut changed = domain.is_divided();
    while changed {
        let own: Vec<f64> = of_points(&lowest).into_iter().map(f64::from).collect();
        let mut change = false;
        for (g, &ghost) in domain.ghosts(&own).iter().enumerate() {
            let of_piece = &mut lowest[first[n + g] as usize];
            if (ghost as u32) < *of_piece {
                *of_piece = ghost as u32;
                change = true;
            }
        }
        changed = !domain.all(!change);
    }
    of_points(&lowest)
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
    /// Numbers of the fragments of all own points, from 0 in the order of the lowest user number in each.
    pub(super) fn numbers(system: &System) -> Vec<f64> {
        let (operator, domain) = (system.operator(), system.domain());
        if operator.capabilities().breaking.is_none() {
            return vec![0.0; system.points()];
        }
        let cloud = system.cloud();
        let user_number = |i: usize| cloud.user_number(i) as u32;
        let lowest = lowest(operator, domain, &user_number);
        // Each piece is reported by the owner of the point with its lowest number.
        let is_first = |&i: &usize| lowest[i] == user_number(i);
        let firsts = (0..lowest.len()).filter(is_first);
        let own: Vec<f64> = firsts.map(|i| f64::from(lowest[i])).collect();
        let mut firsts = domain.collect_everywhere(own).concat();
        firsts.sort_unstable_by(f64::total_cmp);
        let place = |&lowest: &u32| firsts.partition_point(|&first| first < f64::from(lowest));
        lowest.iter().map(|lowest| place(lowest) as f64).collect()
    }
}
