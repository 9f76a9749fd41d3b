//! What became of many pictures.

use crate::args::{ProgressKind, RenderArgs};
use crate::say::{FAILED, Failure, Outcome, SCENE, tell};
use serde_json::json;
use snell_formats::Report;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// What became of a picture.
#[derive(Debug)]
pub enum State {
    Drawn,
    There,
    /// On this machine.
    Elsewhere(String),
    /// With this exit code.
    Failed(u8),
}

impl State {
    pub fn word(&self) -> &'static str {
        match self {
            Self::Drawn => "drawn",
            Self::There => "there",
            Self::Elsewhere(_) => "elsewhere",
            Self::Failed(_) => "failed",
        }
    }
}

/// Counts.
#[derive(Debug)]
pub struct Tally {
    total: usize,
    drawn: usize,
    there: usize,
    /// Drawn by others meanwhile.
    others: usize,
    /// Machines by the pictures that they have not finished.
    elsewhere: BTreeMap<usize, String>,
    failed: Vec<(PathBuf, u8)>,
    pub rays: u64,
}

/// So many names are told.
const NAMED: usize = 5;

impl Tally {
    pub fn new(total: usize) -> Self {
        Self { total, drawn: 0, there: 0, others: 0, elsewhere: BTreeMap::new(), failed: Vec::new(), rays: 0 }
    }

    /// Notes what became of a picture now, instead of what it was before.
    pub fn note(&mut self, number: usize, output: &Path, state: State) {
        let was_elsewhere = self.elsewhere.remove(&number).is_some();
        match state {
            State::Drawn => self.drawn += 1,
            State::There if was_elsewhere => self.others += 1,
            State::There => self.there += 1,
            State::Elsewhere(host) => drop(self.elsewhere.insert(number, host)),
            State::Failed(code) => self.failed.push((output.to_owned(), code)),
        }
    }

    pub fn drawn(&self) -> u64 {
        self.drawn as u64
    }

    /// How many are drawn here, if no other machine comes.
    pub fn to_draw(&self) -> u64 {
        (self.total - self.there - self.others - self.failed.len()) as u64
    }

    /// How many are drawn, were there, or failed.
    pub fn settled(&self) -> usize {
        self.drawn + self.there + self.others + self.failed.len()
    }

    pub fn failures(&self) -> usize {
        self.failed.len()
    }

    /// Who has what is not finished.
    pub fn hosts(&self) -> String {
        let hosts: BTreeSet<&str> = self.elsewhere.values().map(String::as_str).collect();
        some(hosts.into_iter().map(str::to_owned))
    }

    pub fn summary(&self, args: &RenderArgs) {
        let Self { total, drawn, there, others, elsewhere, failed, .. } = self;
        let missing = total - self.settled() - elsewhere.len();
        if args.progress == ProgressKind::Json {
            let failed: Vec<&PathBuf> = failed.iter().map(|(output, _)| output).collect();
            let hosts: BTreeSet<&String> = elsewhere.values().collect();
            let event = json!({
                "event": "summary", "pictures": total, "drawn": drawn, "there": there, "drawn_elsewhere": others,
                "being_drawn_elsewhere": elsewhere.len(), "hosts": hosts, "failed": failed, "missing": missing,
            });
            tell(&event.to_string());
            return;
        }
        if args.quiet {
            return;
        }
        let count = |count: usize, what: &str| (count > 0).then(|| format!("{count} {what}"));
        let being = match elsewhere.len() {
            1 => format!("is being drawn elsewhere ({})", self.hosts()),
            _ => format!("are being drawn elsewhere ({})", self.hosts()),
        };
        let parts = [
            Some(format!("{drawn} drawn")),
            count(*there, if *there == 1 { "was there" } else { "were there" }),
            count(*others, "drawn elsewhere meanwhile"),
            count(elsewhere.len(), &being),
            count(failed.len(), "failed"),
            count(missing, "missing: stopped before they were drawn"),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        let s = if *total == 1 { "" } else { "s" };
        tell(&format!("{total} picture{s}: {}", parts.join(", ")));
    }

    /// Fails if a picture has: in a way that no repetition mends, if all have.
    pub fn outcome(&self) -> Outcome {
        if self.failed.is_empty() {
            return Ok(());
        }
        let names = some(self.failed.iter().map(|(output, _)| output.display().to_string()));
        let is_final = self.failed.iter().all(|(_, code)| *code != FAILED);
        let code = if is_final { SCENE } else { FAILED };
        let report = Report::error(format!("{} of {} pictures failed: {names}", self.failed.len(), self.total));
        let help = if is_final {
            "the same command would fail again: change the scene or the values"
        } else {
            "the same command goes on"
        };
        Err(Failure::new(code, report.help(help)))
    }
}

/// A few of many names.
fn some(names: impl ExactSizeIterator<Item = String>) -> String {
    let more = names.len().saturating_sub(NAMED);
    let shown: Vec<String> = names.take(NAMED).collect();
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    shown.join(", ") + &more
}
