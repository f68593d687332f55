//! [`Sample`]: the means that a process and its children hold, as Linux tells it.
//!
//! *In:* the number of a process. *Out:* its memory, threads, open handles and processes, with those of its descendants.

use std::fs;

/// The sums over a process and its descendants.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sample {
    /// The memory that is resident.
    pub(crate) bytes: u64,
    pub(crate) threads: usize,
    pub(crate) handles: usize,
    pub(crate) processes: usize,
}

impl Sample {
    /// The larger of two, number by number.
    pub(crate) fn or_more(&self, other: &Self) -> Self {
        Self {
            bytes: self.bytes.max(other.bytes),
            threads: self.threads.max(other.threads),
            handles: self.handles.max(other.handles),
            processes: self.processes.max(other.processes),
        }
    }

    /// Now.
    pub(crate) fn of(process: u32) -> Self {
        let parents = parents();
        let mut all = vec![process];
        let mut next = 0;
        while let Some(&one) = all.get(next) {
            all.extend(parents.iter().filter(|(_, parent)| *parent == one).map(|(child, _)| *child));
            next += 1;
        }
        let mut sample = Self { processes: all.len(), ..Self::default() };
        for one in all {
            let status = fs::read_to_string(format!("/proc/{one}/status")).unwrap_or_default();
            sample.bytes += field(&status, "VmRSS:") << 10;
            sample.threads += field(&status, "Threads:") as usize;
            sample.handles += fs::read_dir(format!("/proc/{one}/fd")).map_or(0, Iterator::count);
        }
        sample
    }
}

/// A number of a status file.
fn field(status: &str, name: &str) -> u64 {
    let line = status.lines().find_map(|line| line.strip_prefix(name));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}

/// All processes with their parents.
fn parents() -> Vec<(u32, u32)> {
    let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
    let numbers = entries.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
    let parent = |process: &u32| {
        let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
        u32::try_from(field(&status, "PPid:")).ok()
    };
    numbers.filter_map(|process| Some((process, parent(&process)?))).collect()
}
