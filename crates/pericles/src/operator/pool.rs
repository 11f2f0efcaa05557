//! Pools of work arrays, so that an operator is applied through `&self` without allocating memory.

use std::ops::{Deref, DerefMut};
use std::sync::{Mutex, PoisonError};

/// A pool of work arrays of one kind. The lock is held only while an array is taken or returned, so that
/// threads do not wait for each other during computation. The number of arrays is the largest number in use
/// at the same time.
pub struct Pool<T> {
    idle: Mutex<Vec<T>>,
    make: Box<dyn Fn() -> T + Send + Sync>,
}

impl<T> Pool<T> {
    /// Creates a pool with `ready` arrays.
    pub fn new(ready: usize, make: impl Fn() -> T + Send + Sync + 'static) -> Self {
        Self {
            idle: Mutex::new((0..ready).map(|_| make()).collect()),
            make: Box::new(make),
        }
    }

    /// Takes the array used last; dropping it returns it to the pool.
    pub fn take(&self) -> Lent<'_, T> {
        let item = self
            .idle
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .pop();
        Lent {
            item: Some(item.unwrap_or_else(|| (self.make)())),
            pool: self,
        }
    }
}

/// An array taken from a [`Pool`].
pub struct Lent<'a, T> {
    item: Option<T>,
    pool: &'a Pool<T>,
}

impl<T> Deref for Lent<'_, T> {
    type Target = T;
    fn deref(&self) -> &T {
        self.item.as_ref().expect("present until dropped")
    }
}

impl<T> DerefMut for Lent<'_, T> {
    fn deref_mut(&mut self) -> &mut T {
        self.item.as_mut().expect("present until dropped")
    }
}

impl<T> Drop for Lent<'_, T> {
    fn drop(&mut self) {
        if let Some(item) = self.item.take() {
            self.pool
                .idle
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .push(item);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn a_pool_allocates_only_if_all_arrays_are_in_use() {
        let made = Arc::new(AtomicUsize::new(0));
        let count = made.clone();
        let pool = Pool::new(1, move || {
            count.fetch_add(1, Ordering::Relaxed);
            vec![0.0; 4]
        });
        for _ in 0..3 {
            let mut first = pool.take();
            first[0] = 1.0;
            let second = pool.take();
            assert_eq!(second[0], 0.0);
        }
        assert_eq!(made.load(Ordering::Relaxed), 2);
    }
}
