//! `-O`: what `compile` and `reflect` leave out of a program because it reaches no output.
//!
//! *In:* flags and a linked program. *Out:* the program to emit for a target, and notes on what is missing from it.

use clap::Args;
use glisten_emit::Target;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::targets::LEFT_OUT;
use glisten_front::link::Program;
use glisten_front::source::SourceMap;
use glisten_specialize as specialize;
use std::borrow::Cow;

/// Whether to leave out what reaches no output.
#[derive(Args, Clone, Copy, Debug, Default)]
#[command(next_help_heading = "Optimization")]
pub(crate) struct OptimizeArgs {
    /// Leave out what reaches no output (default for WGSL and SPIR-V, unless -g is given; -O0 turns it off)
    #[arg(short = 'O', long)]
    optimize: bool,
    /// Emit everything that the sources use, as -O0 does
    #[arg(long, conflicts_with = "optimize")]
    no_optimize: bool,
    /// The digit of -O0.
    #[arg(short = '0', hide = true, requires = "optimize")]
    level_0: bool,
    /// The digit of -O1, which is -O.
    #[arg(short = '1', hide = true, requires = "optimize", conflicts_with = "level_0")]
    level_1: bool,
}

impl OptimizeArgs {
    /// Whether the flags leave it out for a target.
    pub(crate) fn applies(self, target: Target, debug_lines: bool) -> bool {
        let by_default = !debug_lines && target.omits_unused();
        !self.leaves_whole() && (self.optimize || by_default)
    }

    /// Whether a driver is to draw everything that the sources use.
    pub(crate) fn leaves_whole(self) -> bool {
        self.no_optimize || self.level_0
    }

    /// Whether `-O` itself was given.
    pub(crate) fn is_given(self) -> bool {
        self.optimize && !self.level_0
    }
}

/// The program that is emitted.
pub(crate) fn optimized(program: &Program, applies: bool) -> Cow<'_, Program> {
    if applies { Cow::Owned(specialize::optimize(program)) } else { Cow::Borrowed(program) }
}

/// A note on each thing that is left out.
pub(crate) fn notes(program: &Program, sources: &SourceMap) -> Vec<Diagnostic> {
    let optimized = specialize::optimize(program);
    let list = specialize::left_out(program, &optimized, Some(sources));
    let note = |one: &specialize::LeftOut| {
        let message = format!("{} `{}` is left out", one.what.name(), one.name);
        Diagnostic::new(&LEFT_OUT, one.span, message).here(one.because.clone())
    };
    list.iter().map(note).collect()
}
