//! Workers by kind of job: a newer job ends an older one of its kind.
//!
//! *In:* a kind of job and its line. *Out:* the worker's answer. *Holds:* at most one process works for each kind; one that is
//! still busy when a newer job comes, or when the time is over, is killed, and the next job starts another. A worker that
//! crashes costs its own answer only.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How long the killing of an older job is tried again.
const POLL: Duration = Duration::from_millis(10);

/// The reason why a job has no answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum NoAnswer {
    /// A newer job of the kind came.
    Superseded,
    /// It took longer than the limit.
    TimeOver,
    /// The process ended; with what it wrote to standard error last, if anything.
    Crashed(String),
    /// There is no process.
    NoWorker(String),
}

/// A worker process.
struct Worker {
    child: Child,
    input: ChildStdin,
    answers: Receiver<String>,
}

impl Drop for Worker {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The worker of one kind of jobs.
pub(super) struct Lane {
    command: fn() -> std::io::Result<Command>,
    limit: Duration,
    /// The number of the newest job.
    newest: AtomicU64,
    worker: Mutex<Option<Worker>>,
}

impl Lane {
    /// A lane without a process yet: `command` makes one.
    pub(super) fn new(command: fn() -> std::io::Result<Command>, limit: Duration) -> Self {
        Self { command, limit, newest: AtomicU64::new(0), worker: Mutex::new(None) }
    }

    /// Hands a job to the worker and waits for its answer, a line of JSON.
    pub(super) fn ask(&self, job: &str) -> Result<String, NoAnswer> {
        let number = self.newest.fetch_add(1, Ordering::AcqRel) + 1;
        // The older job sees the new number and lets go of the worker.
        let mut slot = self.worker.lock().unwrap_or_else(PoisonError::into_inner);
        if !self.is_newest(number) {
            return Err(NoAnswer::Superseded);
        }
        self.answer(&mut slot, job, number)
    }

    /// Asks the worker as it is, without ending anything.
    pub(super) fn ask_behind(&self, job: &str) -> Result<String, NoAnswer> {
        let mut slot = self.worker.lock().unwrap_or_else(PoisonError::into_inner);
        let number = self.newest.load(Ordering::Acquire);
        self.answer(&mut slot, job, number)
    }

    /// Kills the process.
    pub(super) fn stop(&self) {
        self.newest.fetch_add(1, Ordering::AcqRel);
        *self.worker.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    fn is_newest(&self, number: u64) -> bool {
        self.newest.load(Ordering::Acquire) == number
    }

    /// The answer to a job. A worker whose answer nobody waited for is ended: the next job would get it.
    fn answer(&self, slot: &mut MutexGuard<'_, Option<Worker>>, job: &str, number: u64) -> Result<String, NoAnswer> {
        let answer = self.answer_of(slot, job, number);
        if answer.is_err() {
            **slot = None;
        }
        answer
    }

    fn answer_of(&self, slot: &mut MutexGuard<'_, Option<Worker>>, job: &str, number: u64) -> Result<String, NoAnswer> {
        let worker = match &mut **slot {
            Some(worker) => worker,
            None => slot.insert(start(self.command)?),
        };
        let sent = writeln!(worker.input, "{job}").and_then(|()| worker.input.flush());
        sent.map_err(|error| NoAnswer::Crashed(error.to_string()))?;
        let end = Instant::now() + self.limit;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            match worker.answers.recv_timeout(POLL.min(left)) {
                Ok(answer) => return Ok(answer),
                Err(RecvTimeoutError::Disconnected) => {
                    let status = worker.child.wait().map(|status| status.to_string());
                    return Err(NoAnswer::Crashed(status.unwrap_or_else(|error| error.to_string())));
                }
                Err(RecvTimeoutError::Timeout) if !self.is_newest(number) => return Err(NoAnswer::Superseded),
                Err(RecvTimeoutError::Timeout) if left.is_zero() => return Err(NoAnswer::TimeOver),
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }
}

fn start(command: fn() -> std::io::Result<Command>) -> Result<Worker, NoAnswer> {
    let failed = |error: std::io::Error| NoAnswer::NoWorker(error.to_string());
    let mut command = command().map_err(failed)?;
    let pipes = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut child = pipes.spawn().map_err(failed)?;
    let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
        return Err(NoAnswer::NoWorker("it has no pipes".into()));
    };
    let (sender, answers) = mpsc::channel();
    let read = move || {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                break;
            }
        }
    };
    let worker = Worker { child, input, answers };
    std::thread::Builder::new().spawn(read).map_err(failed)?;
    Ok(worker)
}

#[cfg(all(test, unix))]
mod tests {
    use super::{Lane, NoAnswer};
    use std::process::Command;
    use std::time::Duration;

    /// A worker that answers with what it is told to do.
    fn shell() -> std::io::Result<Command> {
        let mut command = Command::new("sh");
        command.args(["-c", "while read line; do eval \"$line\"; done"]);
        Ok(command)
    }

    const LONG: Duration = Duration::from_secs(20);

    #[test]
    fn a_worker_answers_and_stays() {
        let lane = Lane::new(shell, LONG);
        assert_eq!(lane.ask("a=1; echo one"), Ok("one".into()));
        assert_eq!(lane.ask("echo $a"), Ok("1".into()));
        assert_eq!(lane.ask_behind("echo $a"), Ok("1".into()));
        lane.stop();
        assert_eq!(lane.ask("echo no$a"), Ok("no".into()));
    }

    #[test]
    fn a_crash_and_a_job_without_end_cost_their_own_answers() {
        let lane = Lane::new(shell, Duration::from_millis(100));
        assert!(matches!(lane.ask("exit 3"), Err(NoAnswer::Crashed(status)) if status.contains('3')));
        assert_eq!(lane.ask("exec sleep 60"), Err(NoAnswer::TimeOver));
        assert_eq!(lane.ask("echo two"), Ok("two".into()));
    }

    #[test]
    fn no_job_gets_the_answer_to_another() {
        let lane = Lane::new(shell, LONG);
        assert_eq!(lane.ask("echo one"), Ok("one".into()));
        std::thread::scope(|scope| {
            let behind = scope.spawn(|| lane.ask_behind("sleep 1; echo behind"));
            // It has the worker once nobody else can, and has asked it a little later.
            while lane.worker.try_lock().is_ok() {
                std::thread::yield_now();
            }
            std::thread::sleep(Duration::from_millis(200));
            assert_eq!(lane.ask("echo newer"), Ok("newer".into()));
            assert_eq!(behind.join().expect("it ends"), Err(NoAnswer::Superseded));
        });
    }

    #[test]
    fn a_newer_job_ends_an_older_one() {
        let lane = Lane::new(shell, LONG);
        std::thread::scope(|scope| {
            let older = scope.spawn(|| lane.ask("exec sleep 60"));
            while lane.newest.load(std::sync::atomic::Ordering::Acquire) == 0 {
                std::thread::yield_now();
            }
            assert_eq!(lane.ask("echo newer"), Ok("newer".into()));
            assert_eq!(older.join().expect("it ends"), Err(NoAnswer::Superseded));
        });
    }
}
