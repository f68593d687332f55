//! [`Child`]: a copy of this process, and how it ends.
//!
//! *In:* nothing. *Out:* on the one side a child to wait for, on the other the process that goes on. *Holds:* the child has the same
//! terminal and process group, so Ctrl-C and Ctrl-Z reach it as ever. A signal for the parent alone is passed on. The child does
//! not outlive its parent. On systems other than Linux there is no copy ([`Side::Alone`]).
#![cfg_attr(target_os = "linux", expect(unsafe_code, reason = "the system's calls for processes and signals are C"))]

/// The side of [`fork`] that a process is on.
pub(crate) enum Side {
    /// The copy.
    Child,
    /// The original, with its copy.
    Parent(Child),
    /// There is no copy.
    Alone,
}

/// A copy of this process.
pub(crate) struct Child {
    #[cfg(target_os = "linux")]
    number: i32,
    /// The actions of this process at signals before it had a child.
    #[cfg(target_os = "linux")]
    before: Box<linux::Actions>,
}

/// How a child ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ended {
    /// By itself, with this exit code.
    Exited(u8),
    /// By this signal.
    Signal(i32),
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn fork() -> Side {
    Side::Alone
}

#[cfg(not(target_os = "linux"))]
impl Child {
    pub(crate) fn wait(self) -> Ended {
        Ended::Exited(1)
    }
}

#[cfg(target_os = "linux")]
pub(crate) use linux::fork;

#[cfg(target_os = "linux")]
mod linux {
    use super::{Child, Ended, Side};
    use std::mem::MaybeUninit;
    use std::ptr;
    use std::sync::atomic::{AtomicI32, Ordering};

    /// The child that signals are passed on to; 0 if there is none.
    static CHILD: AtomicI32 = AtomicI32::new(0);
    /// The signals that ask a process to end.
    const PASSED_ON: [i32; 4] = [libc::SIGINT, libc::SIGTERM, libc::SIGHUP, libc::SIGQUIT];

    /// The actions at these signals; `None` for one that was not changed.
    pub(crate) type Actions = [Option<libc::sigaction>; PASSED_ON.len()];

    /// Copies this process, which must not have any other thread: of several, only this one would go on in the copy.
    pub(crate) fn fork() -> Side {
        let parent = std::process::id();
        // Held back until both processes are ready for them.
        let mask = hold_back();
        // SAFETY: no handler is replaced. Where a parent's parent ignores the ends of its children, they could not be waited for.
        unsafe { libc::signal(libc::SIGCHLD, libc::SIG_DFL) };
        // SAFETY: there is no other thread, so no lock is held that the copy could wait for.
        let side = match unsafe { libc::fork() } {
            0 => {
                die_with(parent);
                Side::Child
            }
            number if number > 0 => {
                CHILD.store(number, Ordering::Relaxed);
                Side::Parent(Child { number, before: Box::new(PASSED_ON.map(pass_on)) })
            }
            _ => Side::Alone,
        };
        // SAFETY: the mask is the system's own answer.
        unsafe { libc::sigprocmask(libc::SIG_SETMASK, &mask, ptr::null_mut()) };
        side
    }

    impl Child {
        /// Waits for the end of the child. Signals that ask this process to end reach the child until then.
        pub(crate) fn wait(self) -> Ended {
            let mut status = 0;
            // SAFETY: `status` is a place for the result.
            while unsafe { libc::waitpid(self.number, &mut status, 0) } < 0
                && std::io::Error::last_os_error().kind() == std::io::ErrorKind::Interrupted
            {}
            CHILD.store(0, Ordering::Relaxed);
            for (signal, action) in PASSED_ON.into_iter().zip(self.before.iter()) {
                restore(signal, action.as_ref());
            }
            if libc::WIFSIGNALED(status) {
                Ended::Signal(libc::WTERMSIG(status))
            } else {
                Ended::Exited(u8::try_from(libc::WEXITSTATUS(status)).unwrap_or(1))
            }
        }
    }

    /// Ends this process, the copy, when its parent ends in whatever way.
    fn die_with(parent: u32) {
        // SAFETY: these calls have no requirements.
        unsafe {
            libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGKILL);
            if u32::try_from(libc::getppid()) != Ok(parent) {
                libc::raise(libc::SIGKILL);
            }
        }
    }

    /// Holds the signals back. Returns the mask before.
    fn hold_back() -> libc::sigset_t {
        let (mut set, mut before) = (MaybeUninit::uninit(), MaybeUninit::uninit());
        // SAFETY: each of the calls that get a set writes all of it, and the signals exist.
        unsafe {
            libc::sigemptyset(set.as_mut_ptr());
            for signal in PASSED_ON {
                libc::sigaddset(set.as_mut_ptr(), signal);
            }
            libc::sigemptyset(before.as_mut_ptr());
            libc::sigprocmask(libc::SIG_BLOCK, set.as_ptr(), before.as_mut_ptr());
            before.assume_init()
        }
    }

    /// Passes a signal on from now on. Returns the action before. The child has that one: what was ignored stays so.
    fn pass_on(signal: i32) -> Option<libc::sigaction> {
        let mut old = MaybeUninit::<libc::sigaction>::zeroed();
        // SAFETY: in an action, zeros are valid everywhere; the call writes the whole of `old` if it succeeds.
        unsafe {
            let mut new: libc::sigaction = MaybeUninit::zeroed().assume_init();
            new.sa_sigaction = hand_over as *const () as usize;
            new.sa_flags = libc::SA_SIGINFO | libc::SA_RESTART;
            (libc::sigaction(signal, &new, old.as_mut_ptr()) == 0).then(|| old.assume_init())
        }
    }

    fn restore(signal: i32, action: Option<&libc::sigaction>) {
        if let Some(action) = action {
            // SAFETY: the action is the system's own answer.
            unsafe { libc::sigaction(signal, action, ptr::null_mut()) };
        }
    }

    /// Hands a signal to the child, unless the terminal sent it: that sends it to both. A process sends it to this one alone.
    extern "C" fn hand_over(signal: i32, information: *mut libc::siginfo_t, _: *mut libc::c_void) {
        // SAFETY: the system calls this with the facts about the signal; `kill` may be called by a handler.
        unsafe {
            let child = CHILD.load(Ordering::Relaxed);
            if child > 0 && (*information).si_code <= 0 {
                libc::kill(child, signal);
            }
        }
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::{Child, Ended};
    use std::process::Command;

    /// How a shell that runs this ends. (A process of tests has threads, so it must not be copied.)
    #[expect(clippy::zombie_processes, reason = "what waits for it is under test")]
    fn ended(script: &str) -> Ended {
        let child = Command::new("sh").args(["-c", script]).spawn().expect("there is a shell");
        Child { number: i32::try_from(child.id()).expect("a small number"), before: Box::new([None; 4]) }.wait()
    }

    #[test]
    fn a_child_ends_by_a_code_or_a_signal() {
        assert_eq!(ended("exit 3"), Ended::Exited(3));
        assert_eq!(ended("kill -SEGV $$"), Ended::Signal(libc::SIGSEGV));
        assert_eq!(ended("kill -KILL $$"), Ended::Signal(libc::SIGKILL));
    }
}
