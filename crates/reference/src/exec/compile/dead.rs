//! Finds the instructions that no output depends on.
//!
//! *In:* instructions with virtual registers, and the outputs. *Out:* a mark for each instruction of `main`. *Holds:* an
//! instruction that leaves or splits lanes is never marked. *Not done here:* nothing is removed; the marks are for counting.

use super::super::code::Port;
use super::super::inst::{Class, Inst, Operand, Use};
use super::emit::Emitter;

/// The operands of an instruction.
#[derive(Default)]
struct Operands {
    reads: Vec<(Class, usize)>,
    writes: Vec<(Class, usize)>,
}

/// Marks the instructions of `main` whose results nothing reads.
pub(super) fn dead(emitter: &mut Emitter, outputs: &[Port]) -> Vec<bool> {
    let insts: Vec<Operands> = (0..emitter.main.insts.len()).filter_map(|place| operands(emitter, place)).collect();
    let mut read = [Class::Float, Class::Int].map(|class| vec![false; emitter.register_count(class)]);
    let mut mark = |class: Class, register: usize| {
        let slot = read.get_mut(class as usize).and_then(|file| file.get_mut(register));
        slot.is_some_and(|slot| !std::mem::replace(slot, true))
    };
    outputs.iter().for_each(|port| {
        mark(port.class, port.register);
    });
    let mut alive = vec![false; insts.len()];
    let mut changed = true;
    while changed {
        changed = false;
        for (inst, alive) in insts.iter().zip(&mut alive).rev() {
            if !*alive && !inst.writes.is_empty() && !inst.writes.iter().any(|place| is_read(&read, *place)) {
                continue;
            }
            *alive = true;
            for (class, register) in &inst.reads {
                let slot = read.get_mut(*class as usize).and_then(|file| file.get_mut(*register));
                changed |= slot.is_some_and(|slot| !std::mem::replace(slot, true));
            }
        }
    }
    alive.into_iter().map(|alive| !alive).collect()
}

fn is_read(read: &[Vec<bool>; 2], (class, register): (Class, usize)) -> bool {
    read.get(class as usize).and_then(|file| file.get(register)).copied().unwrap_or(true)
}

/// The registers that an instruction of `main` reads and writes. An observer's view is no use of a condition.
fn operands(emitter: &mut Emitter, place: usize) -> Option<Operands> {
    let mut found = Operands::default();
    if matches!(emitter.main.insts.get(place), Some(Inst::Watch { .. })) {
        return Some(found);
    }
    let mut note = |class: Class, using: Use, operand: Operand| {
        if operand.is_reg() {
            let place = (class, operand.number());
            if using == Use::Read { found.reads.push(place) } else { found.writes.push(place) }
        }
    };
    let mut inst: Inst = *emitter.main.insts.get(place)?;
    inst.visit(&mut |class, using, operand| note(class, using, *operand));
    for (class, using, list) in inst.lists().into_iter().flatten() {
        emitter.main.list(list).iter().for_each(|operand| note(class, using, *operand));
    }
    if let Inst::Texture { call } = inst
        && let Some(call) = emitter.textures.get_mut(call as usize)
    {
        call.visit(&mut |class, using, operand| note(class, using, *operand));
    }
    Some(found)
}
