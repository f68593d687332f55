//! The checks of generated programs: what must draw the same picture, and what must be accepted.
//!
//! ```text
//!  Program ──► loaded, drawn in f32 and f64 ──┬──► formatted, printed, rewritten, specialized, optimized ──► the same bits?
//!                                             ├──► changed by rules of the language ─────────────────────► the same bits?
//!                                             ├──► drawn as an envelope ─────────────────────────────────► f32 inside?
//!                                             └──► written for each target ──────────────────────────────► accepted?
//! ```
//!
//! *In:* a program. *Out:* the first [`Fault`], if there is one. *Holds:* a panic is a fault. No GPU is needed.

mod again;
mod drawn;
mod pictures;
mod reflection;
mod targets;
mod tool;
mod vulkan;

pub use drawn::{Bits, Drawn, Texts};

use crate::chance::Chance;
use crate::generate::Program;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// A fault of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The name of the check.
    pub check: &'static str,
    /// Its message.
    pub message: String,
}

/// A check: what must hold for a program that has been drawn.
#[derive(Clone, Copy, Debug)]
pub struct Check {
    /// Its name: `optimize`.
    pub name: &'static str,
    run: fn(&Drawn<'_>) -> Result<(), String>,
}

/// The check that every program begins with.
pub const LOADED: &str = "loaded";

/// All checks of programs that can be drawn.
pub static CHECKS: &[Check] = &[
    Check { name: "envelope", run: pictures::envelope },
    Check { name: "format", run: pictures::format },
    Check { name: "print", run: pictures::print },
    Check { name: "print 330", run: pictures::print_330 },
    Check { name: "print 450", run: pictures::print_450 },
    Check { name: "print 300es", run: pictures::print_300es },
    Check { name: "upgrade", run: pictures::upgrade },
    Check { name: "specialize", run: pictures::specialize },
    Check { name: "optimize", run: pictures::optimize },
    Check { name: "wgsl", run: targets::wgsl },
    Check { name: "spirv", run: targets::spirv },
    Check { name: "options of compile", run: targets::options },
    Check { name: "glsl for vulkan", run: vulkan::check },
    Check { name: "reflection", run: reflection::check },
    Check { name: "others", run: targets::others },
    Check { name: "dead code", run: pictures::dead_code },
    Check { name: "one iteration", run: pictures::one_iteration },
    Check { name: "named value", run: pictures::named },
    Check { name: "outlined statement", run: pictures::outlined },
    Check { name: "parentheses", run: pictures::parentheses },
    Check { name: "uniforms for literals", run: pictures::uniforms },
    Check { name: "bare operands", run: pictures::bare },
    Check { name: "other words", run: pictures::spelled },
    Check { name: "expanded", run: pictures::expanded },
    Check { name: "renamed overloads", run: pictures::renamed },
    Check { name: "by components", run: pictures::components },
    Check { name: "other digits", run: pictures::digits },
];

/// A check that needs a machine's GPU: the message of a difference.
pub type Device<'d> = &'d dyn Fn(&Drawn<'_>) -> Result<(), String>;

/// The name of the check on a device.
pub const DEVICE: &str = "device";

thread_local! {
    /// The place of the last panic.
    static PLACE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// From now on, panics print nothing; a [`Fault`] has their places.
pub fn silence_panics() {
    std::panic::set_hook(Box::new(|info| {
        let place = info.location().map_or(String::new(), |place| format!("{}:{}", place.file(), place.line()));
        PLACE.with(|last| *last.borrow_mut() = place);
    }));
}

/// The work of checks.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// How long each check took.
    pub times: BTreeMap<&'static str, Duration>,
    /// How many programs each check was made for.
    pub checked: BTreeMap<&'static str, u64>,
    /// How many programs a check left out, wholly or in part, by its name and the reason.
    pub left_out: BTreeMap<(&'static str, &'static str), u64>,
    /// How many programs had the picture of their emitted code compared, by the check and the way back.
    pub compared: BTreeMap<(&'static str, &'static str), u64>,
}

impl Tally {
    /// Adds those of other programs.
    pub fn add(&mut self, other: Self) {
        for (name, time) in other.times {
            *self.times.entry(name).or_default() += time;
        }
        for (name, count) in other.checked {
            *self.checked.entry(name).or_default() += count;
        }
        for (what, count) in other.left_out {
            *self.left_out.entry(what).or_default() += count;
        }
        for (what, count) in other.compared {
            *self.compared.entry(what).or_default() += count;
        }
    }
}

/// Which checks are made.
#[derive(Clone, Copy)]
pub struct Chosen<'a> {
    /// The check of this name alone.
    pub only: Option<&'a str>,
    /// Each check for one program in so many, as the seed chooses.
    pub one_in: usize,
    /// The check on a device.
    pub device: Option<Device<'a>>,
}

/// All checks that need no device.
impl Default for Chosen<'_> {
    fn default() -> Self {
        Self { only: None, one_in: 1, device: None }
    }
}

impl Chosen<'_> {
    /// The checks of a program with this seed, in their order.
    fn checks(self, seed: Option<u64>) -> impl Iterator<Item = &'static Check> {
        let mut chance = Chance::new(!seed.unwrap_or_default());
        let is_wanted = move |check: &&Check| {
            // A number is drawn for each, so that `only` leaves the others as they are.
            let is_its_turn = chance.once_in(self.one_in);
            self.only.map_or(is_its_turn, |only| only == check.name)
        };
        CHECKS.iter().filter(is_wanted)
    }
}

/// The first fault of a program.
pub fn fault(program: &Program, chosen: Chosen<'_>) -> Option<Fault> {
    tallied_fault(program, chosen, &mut Tally::default())
}

/// The first fault of a program as [`fault`] finds it; adds the work of the checks.
pub fn tallied_fault(program: &Program, chosen: Chosen<'_>, tally: &mut Tally) -> Option<Fault> {
    fault_of(Texts::from(program), Some(program), chosen, tally)
}

/// The first fault of texts, which are not changed by rules of the language.
pub fn fault_of_texts(texts: Texts) -> Option<Fault> {
    fault_of(texts, None, Chosen::default(), &mut Tally::default())
}

fn fault_of(texts: Texts, program: Option<&Program>, chosen: Chosen<'_>, tally: &mut Tally) -> Option<Fault> {
    let mut stage = LOADED;
    let mut start = Instant::now();
    let mut ended = |name: &'static str, [left_out, compared]: [Vec<&'static str>; 2]| {
        *tally.times.entry(name).or_default() += start.elapsed();
        *tally.checked.entry(name).or_default() += 1;
        for why in BTreeSet::from_iter(left_out) {
            *tally.left_out.entry((name, why)).or_default() += 1;
        }
        for way in BTreeSet::from_iter(compared) {
            *tally.compared.entry((name, way)).or_default() += 1;
        }
        start = Instant::now();
    };
    let run = AssertUnwindSafe(|| {
        let drawn = match Drawn::new(texts, program) {
            Ok(drawn) => drawn,
            Err(message) => return Some(Fault { check: LOADED, message }),
        };
        ended(LOADED, Default::default());
        for check in chosen.checks(program.map(|program| program.seed)) {
            stage = check.name;
            let held = (check.run)(&drawn);
            ended(check.name, [drawn.take_left_out(), drawn.take_compared()]);
            if let Err(message) = held {
                return Some(Fault { check: check.name, message });
            }
        }
        stage = DEVICE;
        if let Some(device) = chosen.device.filter(|_| chosen.only.is_none_or(|only| only == DEVICE))
            && let Err(message) = device(&drawn)
        {
            return Some(Fault { check: DEVICE, message });
        }
        None
    });
    match catch_unwind(run) {
        Ok(found) => found,
        Err(panic) => {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            let place = PLACE.with(|last| last.borrow().clone());
            Some(Fault { check: stage, message: format!("a panic: {} ({place})", text.unwrap_or_default()) })
        }
    }
}
