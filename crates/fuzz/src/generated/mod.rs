//! `--generate`: many programs at once, checked by all processors.
//!
//! *In:* a number of programs, and the first of their seeds. *Out:* a table: programs a second, how many of each version and with each
//! construct, the faults by kind; each fault made smaller, as a file in `target/fuzz/generated`. *Holds:* the same seeds give the same
//! programs, however many threads there are.

#[cfg(feature = "draw")]
mod device;
mod table;

use glisten_fuzz::checks::{Chosen, Device, Fault, LOADED, fault, silence_panics, tallied_fault};
use glisten_fuzz::generate::{Program, shrunk};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;
pub(crate) use table::Sums;

/// The stack of a thread: what glisten's own threads have, and as much for the generator.
const STACK: usize = 64 << 20;
/// So many faults of a kind are made smaller; others are counted.
const MOST_FILES: usize = 3;

/// The programs that are asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted<'a> {
    /// The number of programs.
    pub(crate) count: u64,
    /// The first of their seeds.
    pub(crate) seed: u64,
    /// The threads.
    pub(crate) jobs: u32,
    /// Whether they are drawn on a GPU, too.
    pub(crate) draws: bool,
    /// The check that is made alone.
    pub(crate) only: Option<&'a str>,
    /// Each check is made for one program in so many.
    pub(crate) one_in: usize,
    /// Whether to stop at the first fault, which is not made smaller.
    pub(crate) first: bool,
    /// After how many seconds to stop.
    pub(crate) seconds: Option<f64>,
    /// The folder of the files.
    pub(crate) folder: &'a Path,
}

/// A fault with its file.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    pub(crate) seed: u64,
    pub(crate) fault: Fault,
    pub(crate) file: Option<PathBuf>,
}

/// Generates programs and checks them.
///
/// # Errors
/// There is no GPU, or a file cannot be written.
pub(crate) fn run(wanted: Wanted<'_>) -> Result<Sums, String> {
    // A panic is a fault, which the table tells.
    silence_panics();
    std::fs::create_dir_all(wanted.folder).map_err(|error| format!("{}: {error}", wanted.folder.display()))?;
    let start = Instant::now();
    let next = AtomicU64::new(0);
    let sums = Mutex::new(Sums::default());
    let work = || -> Result<(), String> {
        #[cfg(feature = "draw")]
        let device = if wanted.draws { Some(device::new()?) } else { None };
        #[cfg(feature = "draw")]
        let device: Option<Device<'_>> = device.as_deref();
        #[cfg(not(feature = "draw"))]
        let device: Option<Device<'_>> = None;
        let chosen = Chosen { only: wanted.only, one_in: wanted.one_in, device };
        let mut own = Sums::default();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let is_over = wanted.seconds.is_some_and(|seconds| start.elapsed().as_secs_f64() > seconds);
            if number >= wanted.count || is_over {
                break;
            }
            let seed = wanted.seed.wrapping_add(number);
            let program = Program::new(seed);
            own.count(&program);
            if let Some(fault) = tallied_fault(&program, chosen, &mut own.tally) {
                let known = kind(&fault);
                let so_far = {
                    let Ok(mut sums) = sums.lock() else { break };
                    let of_kind = sums.kinds.entry(known).or_default();
                    *of_kind += 1;
                    *of_kind
                };
                let file = if so_far <= MOST_FILES && !wanted.first {
                    Some(smaller(&program, &fault, wanted, device)?)
                } else {
                    None
                };
                own.found.push(Found { seed, fault, file });
                if wanted.first {
                    next.store(wanted.count, Ordering::Relaxed);
                }
            }
        }
        sums.lock().map(|mut sums| sums.add(own)).map_err(|_| "a thread ended".to_owned())
    };
    let results: Vec<Result<(), String>> = std::thread::scope(|scope| {
        let start = |index| {
            let thread = std::thread::Builder::new().name(format!("generated {index}")).stack_size(STACK);
            thread.spawn_scoped(scope, work)
        };
        let threads: Vec<_> = (0..wanted.jobs.max(1)).filter_map(|index| start(index).ok()).collect();
        threads.into_iter().map(|thread| thread.join().unwrap_or_else(|_| Err("a thread ended".to_owned()))).collect()
    });
    results.into_iter().collect::<Result<Vec<()>, String>>()?;
    let mut sums = sums.into_inner().map_err(|_| "a thread ended".to_owned())?;
    sums.seconds = start.elapsed().as_secs_f64();
    Ok(sums)
}

/// The kind of a fault: its check, and what it says without the values.
pub(crate) fn kind(fault: &Fault) -> String {
    let line = fault.message.lines().next().unwrap_or_default();
    let mut text = String::new();
    for letter in line.chars().take(90) {
        match letter {
            '0'..='9' => {
                if !text.ends_with('#') {
                    text.push('#');
                }
            }
            other => text.push(other),
        }
    }
    let text = text.split('`').step_by(2).collect::<Vec<_>>().join("`..`");
    let text = text.split(" was ").next().unwrap_or_default();
    format!("{}: {text}", fault.check)
}

/// A smaller program with a fault of this kind, as a file.
fn smaller(
    program: &Program,
    found: &Fault,
    wanted: Wanted<'_>,
    device: Option<Device<'_>>,
) -> Result<PathBuf, String> {
    let only = Some(found.check).filter(|check| *check != LOADED);
    let chosen = Chosen { only, one_in: 1, device };
    let known = kind(found);
    let small = shrunk(program, &mut |smaller| fault(smaller, chosen).is_some_and(|fault| kind(&fault) == known));
    let message = fault(&small, chosen).map_or_else(|| found.message.clone(), |fault| fault.message);
    let comment: String = message.lines().map(|line| format!("// {line}\n")).collect();
    let check = found.check.replace(' ', "_");
    let path = wanted.folder.join(format!("{check}-{}.glsl", program.seed));
    let text = format!("{}\n//# found\n{comment}", small.text());
    std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(path)
}
