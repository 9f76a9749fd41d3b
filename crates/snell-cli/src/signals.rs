//! What the system tells a program: ^C, `kill`, a terminal that is closed, and that it has to end.

#![allow(unsafe_code, reason = "what happens at a signal is asked and said through libc only")]

use std::ffi::c_int;

/// What ends a program, and can be caught.
#[cfg(unix)]
const ENDING: [c_int; 3] = [libc::SIGINT, libc::SIGTERM, libc::SIGHUP];

/// Calls `handler` at each ^C, SIGTERM and SIGHUP, on a thread of its own. Those that are ignored from the start stay ignored:
/// `nohup` asks for that. Returns whether it could be done; if not, signals end the program as they always do.
pub fn on_interrupt(handler: impl FnMut() + Send + 'static) -> bool {
    #[cfg(unix)]
    {
        let ignored = ENDING.map(is_ignored);
        let fine = ctrlc::set_handler(handler).is_ok();
        for (signal, ignored) in ENDING.into_iter().zip(ignored) {
            if ignored {
                handle(signal, libc::SIG_IGN);
            } else if !fine {
                // Without its thread the handler would swallow them.
                handle(signal, libc::SIG_DFL);
            }
        }
        fine
    }
    #[cfg(not(unix))]
    {
        ctrlc::set_handler(handler).is_ok()
    }
}

#[cfg(unix)]
fn is_ignored(signal: c_int) -> bool {
    // SAFETY: `sigaction` is plain data, for which zeros are a value; with no new action it is only written to.
    unsafe {
        let mut action: libc::sigaction = std::mem::zeroed();
        libc::sigaction(signal, std::ptr::null(), &raw mut action) == 0 && action.sa_sigaction == libc::SIG_IGN
    }
}

#[cfg(unix)]
fn handle(signal: c_int, how: libc::sighandler_t) {
    // SAFETY: `how` is one of the two constants of the system, or a function that calls only what signal handlers may call.
    unsafe {
        libc::signal(signal, how);
    }
}

/// Ends with an error where the standard library would abort: without memory, which it says in the line before.
pub fn end_with_an_error_instead_of_abort() {
    #[cfg(unix)]
    handle(libc::SIGABRT, end as *const () as libc::sighandler_t);
}

#[cfg(unix)]
extern "C" fn end(_: c_int) {
    const MESSAGE: &[u8] =
        b"error: there is not enough memory for this, or Snell has a fault: the line above says which\n";
    // SAFETY: `write` and `_exit` are among the functions that a signal handler may call (POSIX 2.4.3).
    unsafe {
        libc::write(libc::STDERR_FILENO, MESSAGE.as_ptr().cast(), MESSAGE.len());
        libc::_exit(c_int::from(crate::say::FAILED));
    }
}
