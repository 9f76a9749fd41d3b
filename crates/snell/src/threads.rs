//! Work on threads. The only place that knows of any: without the feature `rayon`, the caller does all of it.

#[cfg(not(feature = "rayon"))]
pub(crate) use alone::*;
#[cfg(feature = "rayon")]
pub(crate) use together::*;

#[cfg(feature = "rayon")]
mod together {
    use rayon::prelude::*;
    use rayon::{ThreadPool, ThreadPoolBuilder};

    /// Several threads, 0 for as many as the machine has cores. WASM has none to start: there, and with one thread, the caller
    /// does the work.
    fn pool(threads: usize) -> Option<ThreadPool> {
        let pool = (threads != 1).then(|| ThreadPoolBuilder::new().num_threads(threads).build())?.ok()?;
        (pool.current_num_threads() > 1).then_some(pool)
    }

    /// Runs the same worker on so many threads, 0 for as many as the machine has cores, and waits for all of them.
    pub(crate) fn run(threads: usize, worker: impl Fn() + Sync) {
        match pool(threads) {
            Some(pool) => drop(pool.broadcast(|_| worker())),
            None => worker(),
        }
    }

    /// Does something on so many threads, 0 for as many as the machine has cores; it is told whether there is more than one,
    /// which [`map`] and [`join`] then share out.
    pub(crate) fn share<R: Send>(threads: usize, work: impl FnOnce(bool) -> R + Send) -> R {
        match pool(threads) {
            Some(pool) => pool.install(|| work(true)),
            None => work(false),
        }
    }

    /// What `of` makes of each item, in their order.
    pub(crate) fn map<T, R: Send, I>(parallel: bool, items: I, of: impl Fn(T) -> R + Sync + Send) -> Vec<R>
    where
        I: IntoIterator<Item = T> + IntoParallelIterator<Item = T>,
    {
        if parallel { items.into_par_iter().map(of).collect() } else { items.into_iter().map(of).collect() }
    }

    /// Does both, at the same time if a thread is free.
    pub(crate) fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
        rayon::join(a, b)
    }
}

#[cfg(not(feature = "rayon"))]
mod alone {
    pub(crate) fn run(_: usize, worker: impl Fn()) {
        worker();
    }

    pub(crate) fn share<R>(_: usize, work: impl FnOnce(bool) -> R) -> R {
        work(false)
    }

    pub(crate) fn map<T, R>(_: bool, items: impl IntoIterator<Item = T>, of: impl Fn(T) -> R) -> Vec<R> {
        items.into_iter().map(of).collect()
    }

    pub(crate) fn join<A, B>(a: impl FnOnce() -> A, b: impl FnOnce() -> B) -> (A, B) {
        (a(), b())
    }
}
