//! Work on threads, and how many there are. The only place that knows of any: without the feature `rayon`, the caller does all of
//! the work.

/// No more threads than this are started.
pub const MOST: usize = 1024;

/// The variables that say how many threads there are where nobody asks for a number, the first one first.
pub const VARIABLES: [&str; 3] = ["SNELL_THREADS", "OMP_NUM_THREADS", "SLURM_CPUS_PER_TASK"];

/// How many threads there are where nobody asks for a number, and who says so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ByDefault {
    /// How many: 1 to [`MOST`].
    pub count: usize,
    /// The variable that says so; `None` if it is as many as this process may run on.
    pub variable: Option<&'static str>,
    /// Variables that were asked before it, and what they have instead of a number from 1 to [`MOST`].
    pub ignored: Vec<(&'static str, String)>,
}

impl ByDefault {
    /// The first of [`VARIABLES`] with a number from 1 to [`MOST`] decides, even against `available`: whoever starts more threads
    /// than that may have a reason. Of a list like `4,2`, which is for nested work in OpenMP, the first number counts; an empty
    /// variable is none.
    pub fn of(variable: impl Fn(&str) -> Option<String>, available: usize) -> Self {
        let mut ignored = Vec::new();
        for name in VARIABLES {
            let Some(text) = variable(name).filter(|text| !text.trim().is_empty()) else { continue };
            let first = text.split(',').next().unwrap_or_default().trim();
            match first.parse().ok().filter(|count| (1..=MOST).contains(count)) {
                Some(count) => return Self { count, variable: Some(name), ignored },
                None => ignored.push((name, text)),
            }
        }
        Self { count: available.clamp(1, MOST), variable: None, ignored }
    }

    /// That of this process, which may run on what its affinity and the quotas of its groups leave it.
    pub fn here() -> Self {
        let variable = |name: &str| Some(std::env::var_os(name)?.to_string_lossy().into_owned());
        Self::of(variable, std::thread::available_parallelism().map_or(1, std::num::NonZero::get))
    }
}

/// How many threads work where so many are asked for; 0 is for those [by default](ByDefault::here).
pub fn count(asked: usize) -> usize {
    match asked {
        _ if cfg!(not(feature = "rayon")) => 1,
        0 => ByDefault::here().count,
        asked => asked,
    }
}

#[cfg(not(feature = "rayon"))]
pub(crate) use alone::run;
#[cfg(not(feature = "rayon"))]
pub use alone::{beside, join, map, share};
#[cfg(feature = "rayon")]
pub(crate) use together::run;
#[cfg(feature = "rayon")]
pub use together::{beside, join, map, share};

#[cfg(feature = "rayon")]
mod together {
    use rayon::prelude::*;
    use rayon::{ThreadPool, ThreadPoolBuilder};

    /// Several threads, 0 for [those by default](super::count). WASM has none to start: there, and with one thread, the caller
    /// does the work.
    fn pool(threads: usize) -> Option<ThreadPool> {
        let threads = super::count(threads);
        let pool = (threads != 1).then(|| ThreadPoolBuilder::new().num_threads(threads).build())?.ok()?;
        (pool.current_num_threads() > 1).then_some(pool)
    }

    /// Runs the same worker on so many threads, 0 for those by default, and waits for all of them.
    pub(crate) fn run(threads: usize, worker: impl Fn() + Sync) {
        match pool(threads) {
            Some(pool) => drop(pool.broadcast(|_| worker())),
            None => worker(),
        }
    }

    /// Does something on so many threads, 0 for those by default; it is told whether there is more than one, which [`map`]
    /// and [`join`] then share out.
    pub fn share<R: Send>(threads: usize, work: impl FnOnce(bool) -> R + Send) -> R {
        match pool(threads) {
            Some(pool) => pool.install(|| work(true)),
            None => work(false),
        }
    }

    /// What `of` makes of each item, in their order.
    pub fn map<T, R: Send, I>(parallel: bool, items: I, of: impl Fn(T) -> R + Sync + Send) -> Vec<R>
    where
        I: IntoIterator<Item = T> + IntoParallelIterator<Item = T>,
    {
        if parallel { items.into_par_iter().map(of).collect() } else { items.into_iter().map(of).collect() }
    }

    /// Does both, at the same time if a thread is free.
    pub fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
        rayon::join(a, b)
    }

    /// What `here` returns, which is done by the caller itself; one of so many threads, 0 for those by default, does `elsewhere`
    /// at the same time.
    pub fn beside<R, M: Send>(threads: usize, elsewhere: impl FnOnce() -> M + Send, here: impl FnOnce() -> R) -> R {
        if let Some(pool) = pool(threads) {
            return pool.in_place_scope(|scope| {
                scope.spawn(|_| drop(elsewhere()));
                here()
            });
        }
        drop(elsewhere());
        here()
    }
}

#[cfg(not(feature = "rayon"))]
mod alone {
    pub(crate) fn run(_: usize, worker: impl Fn()) {
        worker();
    }

    /// Does something, which is told that there is one thread.
    pub fn share<R>(_: usize, work: impl FnOnce(bool) -> R) -> R {
        work(false)
    }

    /// What `of` makes of each item, in their order.
    pub fn map<T, R>(_: bool, items: impl IntoIterator<Item = T>, of: impl Fn(T) -> R) -> Vec<R> {
        items.into_iter().map(of).collect()
    }

    /// Does both, one after the other.
    pub fn join<A, B>(a: impl FnOnce() -> A, b: impl FnOnce() -> B) -> (A, B) {
        (a(), b())
    }

    /// What `here` returns, after `elsewhere` is done.
    pub fn beside<R, M>(_: usize, elsewhere: impl FnOnce() -> M, here: impl FnOnce() -> R) -> R {
        drop(elsewhere());
        here()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_variable_with_a_number_decides() {
        let of = |variables: &[(&str, &str)], available: usize| {
            let variable = |name: &str| variables.iter().find(|(n, _)| *n == name).map(|(_, text)| (*text).to_owned());
            let ByDefault { count, variable, ignored } = ByDefault::of(variable, available);
            (count, variable, ignored.into_iter().map(|(name, _)| name).collect::<Vec<_>>())
        };
        let [snell, omp, slurm] = VARIABLES;
        assert_eq!(of(&[], 6), (6, None, vec![]));
        assert_eq!(of(&[], 5000), (MOST, None, vec![]));
        assert_eq!(of(&[], 0), (1, None, vec![]));
        assert_eq!(of(&[(slurm, "3"), (omp, "4,2"), (snell, "5")], 2), (5, Some(snell), vec![]));
        assert_eq!(of(&[(slurm, "3"), (omp, " 4 , 2")], 2), (4, Some(omp), vec![]));
        assert_eq!(of(&[(slurm, "3"), (omp, ""), (snell, " ")], 2), (3, Some(slurm), vec![]));
        assert_eq!(of(&[(snell, "1024")], 2), (1024, Some(snell), vec![]));
        for odd in ["abc", "0", "-1", "99999999999", "1025", "2.5", "4 2", ",4", "99999999999999999999999"] {
            assert_eq!(of(&[(snell, odd)], 2), (2, None, vec![snell]), "{odd}");
            assert_eq!(of(&[(slurm, "3"), (omp, odd)], 2), (3, Some(slurm), vec![omp]), "{odd}");
            assert_eq!(of(&[(snell, "3"), (omp, odd)], 2), (3, Some(snell), vec![]), "{odd}");
        }
    }
}
