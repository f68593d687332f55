//! Programs of others: glslang, Tint, spirv-val; and this program again, for work that may crash or never end.
//!
//! *In:* a command. *Out:* whether it ended well, and the last lines that it wrote. *Holds:* each has a time limit.

use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The result of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Ended {
    /// It ended with the exit code 0. The text is what it wrote.
    Well(String),
    /// It ended with another one, or by a signal. The text is what it wrote.
    Badly(String),
    /// It was ended after its time.
    Late,
    /// It is not installed.
    Missing,
}

impl Ended {
    /// Whether it ended well.
    pub(crate) fn is_well(&self) -> bool {
        matches!(self, Self::Well(_))
    }

    /// The text that it wrote.
    pub(crate) fn text(&self) -> &str {
        match self {
            Self::Well(text) | Self::Badly(text) => text,
            Self::Late => "no end in sight",
            Self::Missing => "not installed",
        }
    }
}

/// Runs a program, whose output goes to a file in `folder`, for at most so long.
pub(crate) fn run(command: &mut Command, folder: &Path, limit: Duration) -> Ended {
    let log = folder.join("log.txt");
    let Ok(file) = std::fs::File::create(&log) else { return Ended::Missing };
    let Ok(other) = file.try_clone() else { return Ended::Missing };
    let started = command.stdin(Stdio::null()).stdout(file).stderr(other).spawn();
    let Ok(mut child) = started else { return Ended::Missing };
    let start = Instant::now();
    let mut pause = Duration::from_millis(1);
    loop {
        match child.try_wait() {
            Ok(Some(status)) if status.success() => return Ended::Well(text(&log)),
            // By what signal, if it crashed before it could write.
            Ok(Some(status)) => {
                let said = text(&log);
                return Ended::Badly(if said.trim().is_empty() { status.to_string() } else { said });
            }
            Err(error) => return Ended::Badly(error.to_string()),
            Ok(None) if start.elapsed() > limit => {
                // It may have ended just now; either way it is gone.
                let _ = child.kill();
                let _ = child.wait();
                return Ended::Late;
            }
            Ok(None) => std::thread::sleep(pause),
        }
        pause = (pause * 2).min(Duration::from_millis(20));
    }
}

/// The beginning of a log.
fn text(log: &Path) -> String {
    const MOST: u64 = 1 << 16;
    let mut bytes = Vec::new();
    if let Ok(file) = std::fs::File::open(log) {
        // A log that cannot be read is an empty one.
        let _ = file.take(MOST).read_to_end(&mut bytes);
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
