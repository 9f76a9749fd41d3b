//! How much memory can be had, where the system says so.

use crate::report::Report;
use std::path::Path;

/// Bytes that can be had without swapping, and within the limits of this program and of its group; `None` where nobody says.
pub fn free() -> Option<u64> {
    [available(), within_address_space(), within_group()].into_iter().flatten().min()
}

/// Refuses what needs more than is free. `what` is what needs it.
///
/// # Errors
/// When it is too much.
pub fn check(what: &str, needed: u64) -> Result<(), Report> {
    match free() {
        Some(free) if needed > free => {
            let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
            let message = format!("{what} needs {:.1} GiB of memory, and {:.1} GiB are free", gib(needed), gib(free));
            Err(Report::error(message))
        }
        _ => Ok(()),
    }
}

fn number_of(path: impl AsRef<Path>, key: &str) -> Option<u64> {
    let text = std::fs::read_to_string(path).ok()?;
    let rest = text.lines().find_map(|line| line.strip_prefix(key))?;
    rest.split_whitespace().next()?.parse().ok()
}

/// Linux: what the kernel says.
fn available() -> Option<u64> {
    Some(number_of("/proc/meminfo", "MemAvailable:")? * 1024)
}

/// Linux: `ulimit -v`.
fn within_address_space() -> Option<u64> {
    let limit = number_of("/proc/self/limits", "Max address space")?;
    Some(limit.saturating_sub(number_of("/proc/self/status", "VmSize:")? * 1024))
}

/// Linux: the limit of a container. Pages of files are given back when they are needed.
fn within_group() -> Option<u64> {
    let groups = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    let group = groups.lines().find_map(|line| line.strip_prefix("0::/"))?;
    let folder = Path::new("/sys/fs/cgroup").join(group);
    let limit = number_of(folder.join("memory.max"), "")?;
    let used =
        number_of(folder.join("memory.current"), "")?.saturating_sub(number_of(folder.join("memory.stat"), "file ")?);
    Some(limit.saturating_sub(used))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_there_is_is_refused_in_words() {
        let Some(free) = free() else { return };
        assert!(check("a picture", free / 2).is_ok());
        let report = check("a picture", u64::MAX).unwrap_err();
        assert!(report.message.starts_with("a picture needs 17179869184.0 GiB"), "{report}");
    }
}
