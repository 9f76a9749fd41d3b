//! Which machine this is, which processes live on it, and how this one behaves there.

#![allow(unsafe_code, reason = "the system is asked through libc only")]

use serde::{Deserialize, Serialize};

/// A process, by what tells it from those of other machines.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Process {
    /// The name of the machine, for people.
    pub host: String,
    /// What no other machine, boot or container has; empty where the system does not say.
    pub boot: String,
    pub pid: u32,
}

impl Process {
    /// This one.
    pub fn this() -> Self {
        let boot = std::fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap_or_default();
        // Containers of one machine have numbers of their own for their processes.
        let space = std::fs::read_link("/proc/self/ns/pid").map(|link| link.display().to_string()).unwrap_or_default();
        let boot = if boot.is_empty() || space.is_empty() { String::new() } else { format!("{} {space}", boot.trim()) };
        Self { host: host(), boot, pid: std::process::id() }
    }

    /// Is it of the machine of the other one, and gone? What cannot be known is no.
    pub fn is_dead(&self, here: &Self) -> bool {
        !self.boot.is_empty() && (&self.host, &self.boot) == (&here.host, &here.boot) && !is_running(self.pid)
    }
}

/// The name of this machine.
fn host() -> String {
    #[cfg(unix)]
    {
        let mut name = [0u8; 256];
        // SAFETY: the length is that of the memory, whose last byte stays zero.
        let fine = unsafe { libc::gethostname(name.as_mut_ptr().cast(), name.len() - 1) } == 0;
        let end = name.iter().position(|byte| *byte == 0).unwrap_or(0);
        if fine && end > 0 {
            return String::from_utf8_lossy(&name[..end]).into_owned();
        }
    }
    let named = ["HOSTNAME", "COMPUTERNAME"].iter().find_map(|name| std::env::var(name).ok());
    named.unwrap_or_else(|| "a machine without a name".to_owned())
}

/// Is there such a process? Where nobody can tell, there is.
fn is_running(pid: u32) -> bool {
    #[cfg(unix)]
    {
        let Some(pid) = i32::try_from(pid).ok().filter(|pid| *pid > 0) else { return true };
        // SAFETY: signal 0 is sent to nobody; the system only looks whether it could be.
        let fine = unsafe { libc::kill(pid, 0) } == 0;
        fine || std::io::Error::last_os_error().raw_os_error() != Some(libc::ESRCH)
    }
    #[cfg(not(unix))]
    {
        let _ = pid;
        true
    }
}

/// Gives way to other programs, at least this much. It is the threads started from now on that do.
///
/// # Errors
/// With the reason why it cannot be done.
pub fn be_nice(niceness: u8) -> Result<(), String> {
    #[cfg(unix)]
    {
        // SAFETY: numbers go in, and numbers come out. What fails gives -1, which counts for less than any niceness asked for.
        let now = unsafe { libc::getpriority(libc::PRIO_PROCESS, 0) };
        // A process that is nicer already stays so: less is not for everybody to ask.
        if now >= niceness.into() {
            return Ok(());
        }
        // SAFETY: as above.
        let fine = unsafe { libc::setpriority(libc::PRIO_PROCESS, 0, niceness.into()) } == 0;
        if fine { Ok(()) } else { Err(std::io::Error::last_os_error().to_string()) }
    }
    #[cfg(not(unix))]
    {
        let _ = niceness;
        Err("this system knows no niceness".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_process_of_this_machine_is_known_to_be_dead() {
        let this = Process::this();
        assert!(!this.host.is_empty() && !this.is_dead(&this));
        let mut gone = std::process::Command::new("true").spawn().unwrap();
        let pid = gone.id();
        gone.wait().unwrap();
        let dead = Process { pid, ..this.clone() };
        assert_eq!(dead.is_dead(&this), !this.boot.is_empty());
        assert!(!Process { host: "elsewhere".to_owned(), ..dead.clone() }.is_dead(&this));
        assert!(!Process { boot: "another".to_owned(), ..dead.clone() }.is_dead(&this));
        for pid in [0, u32::MAX] {
            assert!(!Process { pid, ..dead.clone() }.is_dead(&this));
        }
    }
}
