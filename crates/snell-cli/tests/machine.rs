//! What others want of a machine is respected.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{command, run, stderr};
use std::fs;
use std::path::Path;
use std::process::Command;

const VARIABLES: [&str; 3] = snell::threads::VARIABLES;

/// How many threads there were, and the notes, with these variables and no others.
fn threads(mut command: Command, variables: &[(&str, &str)]) -> (u64, Vec<String>) {
    for name in VARIABLES {
        command.env_remove(name);
    }
    let output = command.envs(variables.iter().copied()).output().unwrap();
    let said = stderr(&output);
    assert!(output.status.success(), "{said}");
    let events: Vec<serde_json::Value> = said.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let of = |kind: &str| events.iter().filter(move |event| event["event"] == kind).collect::<Vec<_>>();
    let notes = of("note").into_iter().map(|event| event["message"].as_str().unwrap().to_owned());
    (of("done")[0]["threads"].as_u64().unwrap(), notes.collect())
}

const RENDER: &[&str] = &["render", "lecture/default", "--size", "16x16", "--progress", "json", "-o", "a.png"];

#[test]
fn threads_are_those_that_were_given() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let [snell, omp, slurm] = VARIABLES;
    let of = |more: &[&str], variables: &[(&str, &str)]| threads(command(at, &[RENDER, more].concat()), variables);
    let cores = std::thread::available_parallelism().unwrap().get() as u64;
    assert_eq!(of(&[], &[]), (cores, vec![]));
    assert_eq!(of(&[], &[(slurm, "3"), (omp, "5,2"), (snell, "7")]), (7, vec![]));
    assert_eq!(of(&[], &[(slurm, "3"), (omp, "5,2")]), (5, vec![]));
    assert_eq!(of(&[], &[(slurm, "3")]), (3, vec![]));
    assert_eq!(of(&["--threads", "4"], &[(slurm, "odd"), (snell, "7")]), (4, vec![]));
    let (count, notes) = of(&[], &[(snell, "abc"), (omp, "99999999999"), (slurm, "3")]);
    let expected =
        "and a number of threads from 1 to 1024 was expected; there are 3 instead, as SLURM_CPUS_PER_TASK says";
    let lines =
        [format!("SNELL_THREADS is `abc`, {expected}"), format!("OMP_NUM_THREADS is `99999999999`, {expected}")];
    assert_eq!((count, notes), (3, lines.to_vec()));
    let (count, notes) = of(&[], &[(omp, "0")]);
    assert!(
        count == cores && notes[0].ends_with(&format!("there are {cores} instead, one for each core that may be used"))
    );
    let quiet =
        command(at, &["render", "-q", "lecture/default", "--size", "8x8", "-o", "a.png"]).env(snell, "0").output();
    assert_eq!(stderr(&quiet.unwrap()), "");
    let loud = command(at, &["render", "lecture/default", "--size", "8x8", "-o", "a.png"]).env(snell, "0").output();
    assert!(stderr(&loud.unwrap()).starts_with("note: SNELL_THREADS is `0`, "));
}

/// As `taskset` (of util-linux) leaves it.
#[test]
#[cfg(target_os = "linux")]
fn threads_follow_affinity() {
    let folder = tempfile::tempdir().unwrap();
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let allowed = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:")).unwrap().trim();
    let first = allowed.split([',', '-']).next().unwrap();
    let mut one = Command::new("taskset");
    one.args(["-c", first, env!("CARGO_BIN_EXE_snell")]).args(RENDER).current_dir(folder.path());
    assert_eq!(threads(one, &[]), (1, vec![]));
}

/// The niceness of each thread of a process.
#[cfg(target_os = "linux")]
fn niceness(pid: u32) -> Vec<i32> {
    let of = |task: &Path| {
        let stat = fs::read_to_string(task.join("stat")).ok()?;
        // Behind the name, which may be anything in parentheses.
        stat.rsplit_once(") ")?.1.split(' ').nth(16)?.parse().ok()
    };
    let tasks = fs::read_dir(format!("/proc/{pid}/task")).unwrap();
    tasks.filter_map(|task| of(&task.unwrap().path())).collect()
}

#[test]
#[cfg(target_os = "linux")]
fn a_nice_render_gives_way_with_all_its_threads() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let here = niceness(std::process::id())[0];
    for (option, nice) in [(Some("--nice"), 10), (Some("--nice=19"), 19), (Some("--nice=0"), 0), (None, here)] {
        let endless = ["render", "-q", "lecture/default", "--spp", "60000", "--threads", "3", "-o", "a.png"];
        let mut command = command(at, &[&endless[..], option.as_slice()].concat());
        let mut child = command.spawn().unwrap();
        // Workers come last: before them there are this thread and the one that waits for ^C.
        let mut all = Vec::new();
        for _ in 0..500 {
            std::thread::sleep(std::time::Duration::from_millis(20));
            all = niceness(child.id());
            if all.len() >= 5 {
                break;
            }
        }
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(all.len() >= 5 && all.iter().all(|&of| of == nice.max(here)), "{option:?}: {all:?}");
    }
}

#[test]
fn nice_takes_its_number_behind_an_equals_sign() {
    let folder = tempfile::tempdir().unwrap();
    // What follows is a scene.
    run(folder.path(), &["render", "-q", "--nice", "lecture/default", "--size", "8x8", "-o", "a.png"]);
    let output = common::snell(folder.path(), &["render", "lecture/default", "--nice=20"]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("20 is not in 0..=19"), "{}", stderr(&output));
}
