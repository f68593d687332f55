//! The smallest of a program's residuals: none is larger than what `compile -O` makes of the original.
//!
//! *In:* a program and what is known of it. *Out:* a [`Residual`]. *Holds:* programs are compared as SPIR-V, by the instructions
//! in their functions, then by the words of their modules. What is written out is kept where it is no larger; else loops
//! stay loops, then functions stay one, and in the end the program is left as it is, but for what reaches no output.

use glisten_emit::{Conventions, Emitted, Target, emit};
use glisten_front::link::Program;
use glisten_specialize::{Extent, Known, Options, Residual, optimize, specialize_with};

/// Instructions in functions, and words.
type Size = (u64, u64);

/// Of the loops that became longest, so many stay loops before all do.
const MOST_KEPT: usize = 3;

/// Leaves out of a program what is not needed when this is known, and never makes it larger.
pub fn specialize_smallest(program: &Program, known: &Known, options: &Options<'_>) -> Residual {
    let residual = specialize_with(program, known, options);
    // What has no SPIR-V cannot be compared.
    let (Some(limit), Some(first)) = (size(&optimize(program)), size(&optimize(&residual.program))) else {
        return residual;
    };
    if first <= limit {
        return residual;
    }
    if options.extent == Extent::All
        && let Some(residual) = with_fewer_written_out(program, known, options, &residual, limit)
    {
        return residual;
    }
    let further = Extent::ALL.into_iter().filter(|extent| *extent > options.extent);
    let others = further.map(|extent| specialize_with(program, known, &Options { extent, ..*options }));
    let (mut best, mut least) = (residual, first);
    for other in others.filter(|other| other.fault.is_none()) {
        if let Some(size) = size(&optimize(&other.program)).filter(|size| *size < least) {
            (best, least) = (other, size);
        }
        if least <= limit {
            break;
        }
    }
    best
}

/// A residual that is short enough, of which some loops are not written out: those that became longest.
fn with_fewer_written_out(
    program: &Program,
    known: &Known,
    options: &Options<'_>,
    first: &Residual,
    limit: Size,
) -> Option<Residual> {
    let longest = first.written_out.get(..MOST_KEPT.min(first.written_out.len()))?;
    (1..=longest.len()).find_map(|count| {
        let kept = longest.get(..count)?;
        let residual = specialize_with(program, known, &Options { kept, ..*options });
        let fits = residual.fault.is_none() && size(&optimize(&residual.program))? <= limit;
        fits.then_some(Residual { extent: Extent::LoopsKept, ..residual })
    })
}

fn size(program: &Program) -> Option<Size> {
    program.stages.iter().try_fold((0, 0), |(instructions, length), shader| {
        match emit(program, shader.stage, Target::Spirv, &Conventions::default()) {
            Ok(Emitted::Words(words)) => Some((instructions + body_instructions(&words), length + words.len() as u64)),
            Ok(_) | Err(_) => None,
        }
    })
}

/// Instructions between `OpFunction` and `OpFunctionEnd` of both stages.
pub fn spirv_instructions(program: &Program) -> u64 {
    let stages = program.stages.iter();
    stages
        .map(|shader| match emit(program, shader.stage, Target::Spirv, &Conventions::default()) {
            Ok(Emitted::Words(words)) => body_instructions(&words),
            Ok(_) | Err(_) => 0,
        })
        .sum()
}

/// Instructions between `OpFunction` and `OpFunctionEnd` of a module, both included.
pub fn body_instructions(words: &[u32]) -> u64 {
    const HEADER: usize = 5;
    const FUNCTION: u32 = 54;
    const FUNCTION_END: u32 = 56;
    let (mut at, mut inside, mut count) = (HEADER, false, 0);
    while let Some(word) = words.get(at) {
        let (length, opcode) = ((word >> 16).max(1) as usize, word & 0xffff);
        inside |= opcode == FUNCTION;
        count += u64::from(inside);
        inside &= opcode != FUNCTION_END;
        at += length;
    }
    count
}
