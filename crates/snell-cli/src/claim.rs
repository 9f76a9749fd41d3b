//! Who draws which of many pictures, where several machines share a folder and nothing else: no locks, no clocks in step.
//!
//! ```text
//!  f_007.png.claim-1   made with O_EXCL: one of all wins. It says who, and is written again every few seconds
//!  f_007.png.claim-2   made by who found claim-1 stale: again one of all. The highest number owns the picture
//! ```
//!
//! A claim is stale if its process is dead, or if it has not been written for a minute by the clock of the disk, or while we looked on.
//! Who is slow and not dead draws a picture again that another one draws too: the same bits, renamed into place as a whole.

use crate::machine::Process;
use serde::{Deserialize, Serialize};
use snell_formats::Report;
use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime};

/// A claim that has not been written for so long is stale.
const STALE: Duration = Duration::from_mins(1);

/// For tests: another time for that, in seconds.
const STALE_VARIABLE: &str = "SNELL_CLAIM_SECONDS";

/// The claims of this process that are to be written again, and removed if it has to stop at once.
static HELD: Mutex<Vec<Held>> = Mutex::new(Vec::new());

#[derive(Clone)]
struct Held {
    file: PathBuf,
    line: String,
}

/// Removes the claims of a program that stops at once.
pub fn discard_held() {
    if let Ok(mut held) = HELD.lock() {
        for claim in held.drain(..) {
            // There is nobody left to tell.
            let _ = fs::remove_file(claim.file);
        }
    }
}

/// What a claim says.
#[derive(Serialize, Deserialize)]
struct Owner {
    #[serde(flatten)]
    process: Process,
    /// Tells the claims of one process apart, and those of processes of one number.
    token: String,
}

/// What came of the wish to draw a picture.
#[derive(Debug)]
pub enum Taken {
    Mine(Claim),
    /// Somebody else's.
    Other {
        host: String,
        /// Has the claim been written since this process saw it first?
        is_alive: bool,
    },
}

/// The right to draw a picture, until it is dropped.
#[derive(Debug)]
pub struct Claim {
    output: PathBuf,
    number: u32,
}

impl Drop for Claim {
    fn drop(&mut self) {
        let file = file(&self.output, self.number);
        if let Ok(mut held) = HELD.lock() {
            held.retain(|claim| claim.file != file);
        }
        // Who was taken for dead leaves all to its heir.
        if highest(&self.output) == self.number {
            // From above: what is left for a moment is stale, and whoever takes it finds the picture. So is what cannot be removed.
            (1..=self.number).rev().for_each(|number| drop(fs::remove_file(self::file(&self.output, number))));
        }
    }
}

/// Takes claims, and keeps them fresh.
pub struct Claims {
    this: Process,
    stale: Duration,
    /// The claims of others: number and time when they were seen first, and when that was.
    seen: HashMap<PathBuf, (u32, SystemTime, Instant)>,
    /// Clocks of folders: their time at a time of ours.
    clocks: HashMap<PathBuf, (SystemTime, Instant)>,
    /// Dropped at the end, which ends the thread.
    over: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Claims {
    pub fn new() -> Self {
        let named = std::env::var(STALE_VARIABLE).ok().and_then(|text| text.parse().ok());
        Self::with_stale(
            named.filter(|seconds| (0.1..=3600.0).contains(seconds)).map_or(STALE, Duration::from_secs_f64),
        )
    }

    fn with_stale(stale: Duration) -> Self {
        let (over, is_over) = channel::<()>();
        let refresh = move || {
            while is_over.recv_timeout(stale / 6) == Err(RecvTimeoutError::Timeout) {
                let held = HELD.lock().map(|held| held.clone()).unwrap_or_default();
                held.iter().for_each(refresh);
            }
        };
        // Without a thread claims become stale, and others may draw the same once more.
        let thread = std::thread::Builder::new().spawn(refresh).ok();
        let (seen, clocks) = (HashMap::new(), HashMap::new());
        Self { this: Process::this(), stale, seen, clocks, over: Some(over), thread }
    }

    /// How long a claim may not be written before it is stale.
    pub fn stale(&self) -> Duration {
        self.stale
    }

    /// Claims a picture, if nobody has it.
    pub fn take(&mut self, output: &Path) -> Result<Taken, Report> {
        for _ in 0..MOST_TRIES {
            let number = highest(output);
            if number > 0 {
                match self.judge(output, number)? {
                    State::Gone => continue,
                    State::Stale => {}
                    State::Other { host, is_alive } => return Ok(Taken::Other { host, is_alive }),
                }
            }
            let (number, file) = (number + 1, file(output, number + 1));
            let line = self.line();
            match write_new(&file, &line) {
                Ok(()) if highest(output) == number => {
                    if let Ok(mut held) = HELD.lock() {
                        held.push(Held { file, line });
                    }
                    return Ok(Taken::Mine(Claim { output: output.to_owned(), number }));
                }
                // Somebody was faster, or has just removed those below.
                Ok(()) => drop(fs::remove_file(&file)),
                Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
                Err(e) => return Err(unclaimable(&file, &e)),
            }
        }
        Err(Report::error(format!("claims of `{}` come and go too fast", output.display())))
    }

    /// Removes what a program left that died between drawing a picture and removing its claim.
    pub fn clear(&mut self, output: &Path) {
        let number = highest(output);
        if number > 0 && matches!(self.judge(output, number), Ok(State::Stale)) {
            (1..=number).rev().for_each(|number| drop(fs::remove_file(file(output, number))));
        }
    }

    fn line(&self) -> String {
        let token = format!("{:016x}", RandomState::new().build_hasher().finish());
        serde_json::to_string(&Owner { process: self.this.clone(), token }).unwrap_or_default() + "\n"
    }

    fn judge(&mut self, output: &Path, number: u32) -> Result<State, Report> {
        let path = file(output, number);
        let Some((written, owner)) = look(&path) else { return Ok(State::Gone) };
        let &mut (seen_number, seen_written, since) =
            self.seen.entry(output.to_owned()).or_insert((number, written, Instant::now()));
        let is_alive = (seen_number, seen_written) != (number, written);
        let is_dead = owner.as_ref().is_some_and(|owner| owner.process.is_dead(&self.this));
        // A time in the future, of a clock that is wrong, tells nothing; then it counts how long we have looked on.
        let age = self.clock(output)?.duration_since(written).unwrap_or_default();
        if is_dead || age > self.stale || (!is_alive && since.elapsed() > self.stale) {
            return Ok(State::Stale);
        }
        let host = owner.map_or_else(|| "an unknown machine".to_owned(), |owner| owner.process.host);
        if is_alive {
            // From now on it is this that must go on.
            self.seen.insert(output.to_owned(), (number, written, Instant::now()));
        }
        Ok(State::Other { host, is_alive })
    }

    /// What time it is for the disk of a picture: that of a file that has just been written.
    fn clock(&mut self, output: &Path) -> Result<SystemTime, Report> {
        let folder = folder(output);
        if let Some((time, at)) = self.clocks.get(&folder).filter(|(_, at)| at.elapsed() < self.stale / 6) {
            return Ok(*time + at.elapsed());
        }
        let token = RandomState::new().build_hasher().finish();
        let file = folder.join(format!(".snell-clock-{}-{token:016x}", std::process::id()));
        let time = write_new(&file, ".").and_then(|()| file.metadata()).and_then(|metadata| metadata.modified());
        let _ = fs::remove_file(&file);
        let time = time.map_err(|e| unclaimable(&file, &e))?;
        self.clocks.insert(folder, (time, Instant::now()));
        Ok(time)
    }
}

impl Drop for Claims {
    fn drop(&mut self) {
        self.over = None;
        if let Some(thread) = self.thread.take() {
            // It only writes claims; there is nothing to do about a failure.
            let _ = thread.join();
        }
    }
}

/// So often a claim may be lost to somebody faster.
const MOST_TRIES: u32 = 1000;

/// More claims of one picture than this are not looked for.
const MOST_CLAIMS: u32 = 10_000;

enum State {
    Gone,
    Stale,
    Other { host: String, is_alive: bool },
}

fn folder(output: &Path) -> PathBuf {
    output.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned()
}

fn file(output: &Path, number: u32) -> PathBuf {
    let mut name = output.as_os_str().to_owned();
    name.push(format!(".claim-{number}"));
    name.into()
}

/// The highest number that is there without a gap below it, 0 if none is.
fn highest(output: &Path) -> u32 {
    (1..=MOST_CLAIMS).take_while(|number| file(output, *number).symlink_metadata().is_ok()).last().unwrap_or(0)
}

/// When a claim was written last, and by whom, if that can be read.
fn look(path: &Path) -> Option<(SystemTime, Option<Owner>)> {
    // A file that is opened is asked for again on network disks, which remember what they were told before.
    let opened = File::open(path);
    let metadata =
        opened.as_ref().ok().and_then(|file| file.metadata().ok()).or_else(|| path.symlink_metadata().ok())?;
    let owner = opened.ok().filter(|_| metadata.is_file()).and_then(|file| {
        let mut text = String::new();
        file.take(4096).read_to_string(&mut text).ok()?;
        serde_json::from_str(&text).ok()
    });
    Some((metadata.modified().ok()?, owner))
}

fn write_new(file: &Path, line: &str) -> std::io::Result<()> {
    let mut new = OpenOptions::new().write(true).create_new(true).open(file)?;
    new.write_all(line.as_bytes())
}

/// Writes a claim again as it is, by which the disk, and no clock of ours, says when.
fn refresh(held: &Held) {
    // One that is gone stays gone.
    let written =
        OpenOptions::new().write(true).open(&held.file).and_then(|mut file| file.write_all(held.line.as_bytes()));
    drop(written);
}

fn unclaimable(file: &Path, e: &std::io::Error) -> Report {
    let report = Report::error(format!("cannot write `{}`: {e}", file.display()));
    report.help("who draws a picture claims it with a file beside it, so that several machines share the work: name a folder with -o that can be written to")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Barrier;
    use std::sync::atomic::{AtomicU32, Ordering};

    fn set_age(file: &Path, age: Duration) {
        File::options().write(true).open(file).unwrap().set_modified(SystemTime::now() - age).unwrap();
    }

    fn count(at: &Path) -> usize {
        fs::read_dir(at).unwrap().count()
    }

    #[test]
    fn of_many_at_once_one_gets_a_claim_free_or_stale() {
        let folder = tempfile::tempdir().unwrap();
        for round in 0..200 {
            let output = folder.path().join(format!("{round}.png"));
            let stale = round % 3;
            for number in 1..=stale {
                fs::write(file(&output, number), "{\"of\": \"another machine\"}").unwrap();
                set_age(&file(&output, number), Duration::from_secs(100));
            }
            let (barrier, winners) = (Barrier::new(4), AtomicU32::new(0));
            std::thread::scope(|scope| {
                for _ in 0..4 {
                    scope.spawn(|| {
                        let mut claims = Claims::with_stale(STALE);
                        barrier.wait();
                        let taken = claims.take(&output).unwrap();
                        winners.fetch_add(u32::from(matches!(taken, Taken::Mine(_))), Ordering::Relaxed);
                        barrier.wait();
                    });
                }
            });
            assert_eq!(winners.into_inner(), 1, "round {round}");
            assert_eq!(count(folder.path()), 0, "nothing is left");
        }
    }

    #[test]
    fn a_claim_is_stale_by_the_clock_of_the_disk_or_after_looking_on_and_alive_while_it_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let (output, stale) = (folder.path().join("a.png"), Duration::from_millis(600));
        let (mut claims, mut others) = (Claims::with_stale(stale), Claims::with_stale(stale));
        let Taken::Mine(claim) = others.take(&output).unwrap() else { panic!("nobody had it") };
        assert!(matches!(claims.take(&output).unwrap(), Taken::Other { is_alive: false, .. }));
        std::thread::sleep(2 * stale);
        assert!(matches!(claims.take(&output).unwrap(), Taken::Other { is_alive: true, .. }), "it is written again");
        drop(claim);
        assert!(matches!(claims.take(&output).unwrap(), Taken::Mine(_)));
        // Garbage, nothing, and a file from the future.
        for content in [&b"\xff\0{"[..], b"", &vec![b'['; 10_000]] {
            let claim = file(&output, 1);
            fs::write(&claim, content).unwrap();
            File::options().write(true).open(&claim).unwrap().set_modified(SystemTime::now() + 1000 * stale).unwrap();
            let mut claims = Claims::with_stale(stale);
            assert!(matches!(claims.take(&output).unwrap(), Taken::Other { is_alive: false, .. }));
            std::thread::sleep(2 * stale);
            assert!(matches!(claims.take(&output).unwrap(), Taken::Mine(Claim { number: 2, .. })));
            assert_eq!(count(folder.path()), 0);
        }
    }

    #[test]
    fn the_dead_are_replaced_at_once_and_who_wakes_up_leaves_the_heir_alone() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("a.png");
        let (mut claims, mut others) = (Claims::with_stale(STALE), Claims::with_stale(STALE));
        let mut gone = std::process::Command::new("true").spawn().unwrap();
        others.this.pid = gone.id();
        gone.wait().unwrap();
        let Taken::Mine(dead) = others.take(&output).unwrap() else { panic!("nobody had it") };
        let Taken::Mine(heir) = claims.take(&output).unwrap() else { panic!("its process is dead") };
        assert_eq!([dead.number, heir.number], [1, 2]);
        drop(dead);
        assert_eq!(count(folder.path()), 2, "both claims are the heir's");
        assert!(matches!(others.take(&output).unwrap(), Taken::Other { .. }));
        drop(heir);
        assert_eq!(count(folder.path()), 0);
        // Left by somebody who died after the picture was there.
        fs::write(file(&output, 1), "").unwrap();
        claims.clear(&output);
        assert_eq!(count(folder.path()), 1, "it is too young");
        set_age(&file(&output, 1), 2 * STALE);
        claims.clear(&output);
        assert_eq!(count(folder.path()), 0);
    }

    #[test]
    fn what_cannot_be_claimed_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let mut claims = Claims::with_stale(Duration::from_millis(200));
        let error = claims.take(&folder.path().join("gone/a.png")).unwrap_err();
        assert!(error.message.contains("gone/a.png.claim-1") && error.help.unwrap().contains("-o"));
        // A folder in the place of a claim is one that nobody writes.
        let output = folder.path().join("a.png");
        fs::create_dir(file(&output, 1)).unwrap();
        assert!(matches!(claims.take(&output).unwrap(), Taken::Other { .. }));
        std::thread::sleep(Duration::from_millis(500));
        assert!(matches!(claims.take(&output).unwrap(), Taken::Mine(Claim { number: 2, .. })));
    }
}
