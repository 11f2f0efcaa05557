//! Difference between two histories.

use super::History;

/// Returns the largest `Σ_m Σ_j |F_n^m[j] − F′_n^m[j]|` over ghosts n: the error of a ghost displacement if no
/// outer point moves by more than 1.
///
/// Both histories are given a unit displacement of each of the K outer points in turn, and are reset.
pub fn history_distance(mut histories: [&mut dyn History; 2], reach: usize, steps: usize) -> f64 {
    let mut sums = vec![0.0; reach];
    let mut ghosts = [vec![0.0; reach], vec![0.0; reach]];
    for m in 0..reach {
        let mut own = vec![0.0; reach];
        own[m] = 1.0;
        for (history, ghosts) in histories.iter_mut().zip(&mut ghosts) {
            history.reset();
            history.ghosts_into(ghosts);
        }
        for _ in 0..steps {
            for (history, ghosts) in histories.iter_mut().zip(&mut ghosts) {
                history.push(&own, ghosts);
                history.ghosts_into(ghosts);
            }
            own.fill(0.0);
            for (sum, (a, b)) in sums.iter_mut().zip(ghosts[0].iter().zip(&ghosts[1])) {
                *sum += (a - b).abs();
            }
        }
    }
    histories.iter_mut().for_each(|history| history.reset());
    sums.into_iter().fold(0.0, f64::max)
}
