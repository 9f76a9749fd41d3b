//! How much memory can be had, where the system says so.

use crate::report::Report;
use std::path::{Component, Path};

/// Bytes that can be had without swapping, and within the limits of this program and of its group; `None` where nobody says.
pub fn free() -> Option<u64> {
    [available(), within_address_space(), within_group(), within_instance()].into_iter().flatten().min()
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

/// WASM: what an instance may still grow by. What was given back within it may be had besides, in pieces of any size.
#[cfg(target_family = "wasm")]
fn within_instance() -> Option<u64> {
    const PAGE: u64 = 1 << 16;
    (1_u64 << 32).checked_sub(PAGE * core::arch::wasm32::memory_size(0) as u64)
}

#[cfg(not(target_family = "wasm"))]
fn within_instance() -> Option<u64> {
    None
}

/// Linux: what the limits of this process's group, and of those that it is within, leave.
fn within_group() -> Option<u64> {
    left_in_groups(Path::new("/sys/fs/cgroup"), &std::fs::read_to_string("/proc/self/cgroup").ok()?)
}

/// A version of control groups.
struct Version {
    /// Where it may be mounted below the folder of all groups.
    mounted: &'static [&'static str],
    limit: &'static str,
    used: &'static str,
    /// What `memory.stat` calls the pages of files, of the group and those within it, that are given back when memory is needed;
    /// files in memory alone (tmpfs) are not among them.
    files: [&'static str; 2],
}

const V1: Version = Version {
    mounted: &["memory"],
    limit: "memory.limit_in_bytes",
    used: "memory.usage_in_bytes",
    files: ["total_inactive_file ", "total_active_file "],
};

const V2: Version = Version {
    mounted: &["", "unified"],
    limit: "memory.max",
    used: "memory.current",
    files: ["inactive_file ", "active_file "],
};

/// From here on a limit is none: version 1 has a huge number where version 2 says `max`.
const NO_LIMIT: u64 = 1 << 62;

/// The least that a limit leaves of the groups of a process, whose `/proc/self/cgroup` is `groups`.
fn left_in_groups(root: &Path, groups: &str) -> Option<u64> {
    let mut least: Option<u64> = None;
    for line in groups.lines() {
        // A number, what it is about, and its path, which may have colons.
        let mut fields = line.splitn(3, ':');
        let (Some(number), Some(about), Some(path)) = (fields.next(), fields.next(), fields.next()) else { continue };
        let version = match about {
            "" if number == "0" => &V2,
            _ if about.split(',').any(|what| what == "memory") => &V1,
            _ => continue,
        };
        // Within a container the path may be one of the machine outside, and only the topmost folder is its own.
        let path = Path::new(path.trim_start_matches('/'));
        let path =
            if path.components().all(|part| matches!(part, Component::Normal(_))) { path } else { Path::new("") };
        for folder in version.mounted.iter().map(|mounted| root.join(mounted)) {
            let left = path.ancestors().filter_map(|group| left_in(&folder.join(group), version));
            least = least.into_iter().chain(left).min();
        }
    }
    least
}

/// What the limit of one group leaves; `None` if it has none.
fn left_in(group: &Path, version: &Version) -> Option<u64> {
    let limit = number_of(group.join(version.limit), "").filter(|limit| *limit < NO_LIMIT)?;
    let used = number_of(group.join(version.used), "").unwrap_or(0);
    let files = version.files.iter().filter_map(|key| number_of(group.join("memory.stat"), key)).sum();
    Some(limit.saturating_sub(used.saturating_sub(files)))
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

    /// A folder of groups with these files.
    fn groups(files: &[(&str, &str)]) -> tempfile::TempDir {
        let root = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = root.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        root
    }

    #[test]
    fn the_tightest_group_counts() {
        let v2 = groups(&[
            ("memory.stat", "file 5\n"),
            ("a/memory.max", "1000\n"),
            ("a/memory.current", "900\n"),
            ("a/memory.stat", "anon 1\nfile 500\nshmem 200\ninactive_file 200\nactive_file 100\n"),
            ("a/b/memory.max", "700\n"),
            ("a/b/memory.current", "100\n"),
            ("a/b/c/memory.max", "max\n"),
            ("a/b/c/memory.current", "100\n"),
            ("d:e/memory.max", "10\n"),
        ]);
        let left = |groups: &str| left_in_groups(v2.path(), groups);
        // 900 are used in `a`, of which 300 are given back.
        assert_eq!(left("0::/a/b/c\n"), Some(400));
        assert_eq!(left("0::/a\n"), Some(400));
        assert_eq!(left("0::/d:e\n"), Some(10));
        assert_eq!(left("0::/a/b/gone\n"), Some(400));
        for none in
            ["0::/\n", "0::/gone\n", "0::/../a\n", "0::\n", "1:name=systemd:/a\n", "a", "", "::", "0:/a", "\0\n:::\n"]
        {
            assert_eq!(left(none), None, "{none}");
        }
    }

    #[test]
    fn groups_of_version_1_count_too() {
        let files = [
            ("memory/memory.limit_in_bytes", "9223372036854771712\n"),
            ("memory/memory.usage_in_bytes", "123456\n"),
            ("memory/a/memory.limit_in_bytes", "5000\n"),
            ("memory/a/memory.usage_in_bytes", "2000\n"),
            (
                "memory/a/memory.stat",
                "inactive_file 7\nactive_file 7\ntotal_inactive_file 300\ntotal_active_file 200\n",
            ),
            ("memory/a/b/memory.limit_in_bytes", "9223372036854771712\n"),
            ("memory/odd/memory.limit_in_bytes", "much\n"),
            ("memory/more/memory.limit_in_bytes", "800\n"),
            ("memory/more/memory.usage_in_bytes", "900\n"),
            ("unified/u/memory.max", "3000\n"),
            ("unified/u/memory.current", "garbage\n"),
            ("unified/u/memory.stat", "inactive_file garbage\n"),
        ];
        let v1 = groups(&files);
        let left = |groups: &str| left_in_groups(v1.path(), groups);
        assert_eq!(left("9:name=systemd:/\n4:memory:/a/b\n0::/\n"), Some(3500));
        assert_eq!(left("4:cpu,memory:/a\n"), Some(3500));
        assert_eq!(left("4:memory:/more\n"), Some(0));
        // Both versions at once: the tighter one.
        assert_eq!(left("4:memory:/a/b\n0::/u\n"), Some(3000));
        for none in ["4:memory:/\n", "4:memory:/odd\n", "4:memory2:/a\n", "4:memory\n"] {
            assert_eq!(left(none), None, "{none}");
        }
        // In a container the path is that outside, and the topmost folder is the group.
        let container = groups(&[("memory/memory.limit_in_bytes", "600\n")]);
        assert_eq!(left_in_groups(container.path(), "4:memory:/docker/0123\n"), Some(600));
    }
}
