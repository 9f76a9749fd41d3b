//! Work on threads. The only place that starts any.

/// Runs the same worker on so many threads, 0 for as many as the machine has cores, and waits for all of them. WASM has no
/// threads: there, and with one thread, the caller does the work.
pub(crate) fn run(threads: usize, worker: impl Fn() + Sync) {
    if threads == 1 {
        worker();
        return;
    }
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => {
            pool.broadcast(|_| worker());
        }
        Err(_) => worker(),
    }
}

/// Does something on so many threads, 0 for as many as the machine has cores; it is told whether there is more than one,
/// which `rayon` then shares out.
pub(crate) fn share<R: Send>(threads: usize, work: impl FnOnce(bool) -> R + Send) -> R {
    if threads == 1 {
        return work(false);
    }
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) if pool.current_num_threads() > 1 => pool.install(|| work(true)),
        _ => work(false),
    }
}
