//! Messages between all processes.

use super::Comm;

/// Sends `messages[k]` to process k and returns the messages of all processes in the order of ranks. All processes must call it
/// together.
///
/// # Panics
/// If there is not one message per process.
pub fn exchange_all(comm: &dyn Comm, mut messages: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let (rank, size) = (comm.rank(), comm.size());
    assert_eq!(messages.len(), size, "one message per process");
    let others: Vec<usize> = (0..size).filter(|&k| k != rank).collect();
    let own = messages.remove(rank);
    let mut received = vec![Vec::new(); others.len()];
    comm.exchange(&others, &messages, &mut received);
    received.insert(rank, own);
    received
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Threads;

    #[test]
    fn every_process_receives_the_messages_of_all() {
        for size in 1..=4 {
            let found = Threads::run(size, |comm| {
                let own = comm.rank() as f64;
                let message = |k| vec![own; (comm.rank() + k) % 3];
                exchange_all(&*comm, (0..size).map(message).collect())
            });
            for (k, received) in found.iter().enumerate() {
                let expected = (0..size).map(|rank| vec![rank as f64; (rank + k) % 3]);
                assert_eq!(received, &expected.collect::<Vec<_>>());
            }
        }
    }
}
