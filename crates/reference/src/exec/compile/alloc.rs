//! Allocates registers for virtual registers with a linear scan, so that the working set fits the first-level cache
//! (a register of 64 f64 has 512 bytes).
//!
//! A register is live from its first to its last occurrence in instruction order. A register that is live when a loop
//! begins and occurs inside it is live to the loop's end. Inputs, outputs and splats keep their registers forever.

use super::super::code::{Port, Section};
use super::super::inst::{Class, Inst, Operand};
use super::emit::Emitter;

/// The registers of one class.
struct File {
    /// The first and last occurrence of each virtual register.
    spans: Vec<Option<(u32, u32)>>,
    places: Vec<Option<u32>>,
    count: u32,
}

/// Allocates registers. Returns the number of registers in use, of floats and of ints.
pub(super) fn allocate(emitter: &mut Emitter, ports: &mut [Port]) -> [usize; 2] {
    let mut files = [Class::Float, Class::Int].map(|class| File {
        spans: vec![None; emitter.register_count(class)],
        places: vec![None; emitter.register_count(class)],
        count: 0,
    });
    for port in ports.iter_mut() {
        port.register = files[port.class as usize].pin(port.register);
    }
    for (class, register, _) in &emitter.splats {
        files[*class as usize].pin(register.number());
    }
    measure(emitter, &mut files);
    files.iter_mut().for_each(File::scan);
    rename(emitter, &files);
    files.map(|file| file.count as usize)
}

impl File {
    fn pin(&mut self, register: usize) -> usize {
        let Some(place) = self.places.get_mut(register) else { return 0 };
        *place.get_or_insert_with(|| {
            self.count += 1;
            self.count - 1
        }) as usize
    }

    fn scan(&mut self) {
        let mut order: Vec<(u32, u32, usize)> = (self.spans.iter().enumerate())
            .filter(|(register, _)| self.places.get(*register).is_some_and(Option::is_none))
            .filter_map(|(register, span)| span.map(|(first, last)| (first, last, register)))
            .collect();
        order.sort_unstable();
        let mut busy = std::collections::BinaryHeap::new();
        let mut free = Vec::new();
        for (first, last, register) in order {
            while let Some(&std::cmp::Reverse((end, place))) = busy.peek()
                && end < first
            {
                busy.pop();
                free.push(place);
            }
            let place = free.pop().unwrap_or_else(|| {
                self.count += 1;
                self.count - 1
            });
            busy.push(std::cmp::Reverse((last, place)));
            if let Some(slot) = self.places.get_mut(register) {
                *slot = Some(place);
            }
        }
    }
}

/// The loops as the indices of their heads and back edges, outer ones first.
fn loops(insts: &[Inst]) -> Vec<(u32, u32)> {
    let mut loops: Vec<(u32, u32)> = (insts.iter().enumerate())
        .filter_map(|(place, inst)| match inst {
            Inst::LoopBack { head, .. } => Some((*head, place as u32)),
            _ => None,
        })
        .collect();
    loops.sort_unstable_by_key(|&(head, back)| (head, std::cmp::Reverse(back)));
    loops
}

fn measure(emitter: &mut Emitter, files: &mut [File; 2]) {
    let loops = loops(&emitter.main.insts);
    let mut entered = 0;
    let mut inside: Vec<(u32, u32)> = Vec::new();
    let Section { insts, lists, .. } = &mut emitter.main;
    for (place, inst) in insts.iter_mut().enumerate() {
        let place = place as u32;
        while let Some(&next) = loops.get(entered)
            && next.0 <= place
        {
            inside.push(next);
            entered += 1;
        }
        inside.retain(|&(_, back)| back >= place);
        let mut occur = |class: Class, operand: Operand| {
            if !operand.is_reg() {
                return;
            }
            let Some(span) = files[class as usize].spans.get_mut(operand.number()) else { return };
            let (first, last) = span.unwrap_or((place, place));
            let around = inside.iter().find(|&&(head, _)| head > first).map_or(place, |&(_, back)| back);
            *span = Some((first, last.max(around)));
        };
        inst.visit(&mut |class, _, operand| occur(class, *operand));
        for (class, _, list) in inst.lists().into_iter().flatten() {
            let range = list.start as usize..(list.start + list.len) as usize;
            lists.get(range).unwrap_or(&[]).iter().for_each(|operand| occur(class, *operand));
        }
        if let Inst::Texture { call } = inst
            && let Some(call) = emitter.textures.get_mut(*call as usize)
        {
            call.visit(&mut |class, _, operand| occur(class, *operand));
        }
    }
}

fn rename(emitter: &mut Emitter, files: &[File; 2]) {
    let pools = [emitter.pools[0].len() as u32, emitter.pools[1].len() as u32];
    let in_main = |class: Class, operand: &mut Operand| {
        if operand.is_preamble() {
            *operand = Operand::pool(pools[class as usize] + operand.number() as u32);
        } else if operand.is_reg() {
            let place = files[class as usize].places.get(operand.number()).copied().flatten();
            *operand = Operand::reg(place.unwrap_or(0));
        }
    };
    let in_preamble = |_: Class, operand: &mut Operand| {
        if operand.is_preamble() {
            *operand = Operand::reg(operand.number() as u32);
        }
    };
    rename_section(&mut emitter.main, &in_main);
    rename_section(&mut emitter.preamble, &in_preamble);
    for call in &mut emitter.textures {
        call.visit(&mut |class, _, operand| in_main(class, operand));
    }
    for (class, register, operand) in &mut emitter.splats {
        in_main(*class, register);
        in_main(*class, operand);
    }
}

/// Several instructions may share a list, but the two classes never do.
fn rename_section(section: &mut Section, rename: &dyn Fn(Class, &mut Operand)) {
    let mut done = vec![false; section.lists.len()];
    for inst in &mut section.insts {
        inst.visit(&mut |class, _, operand| rename(class, operand));
        for (class, _, list) in inst.lists().into_iter().flatten() {
            for place in list.start as usize..(list.start + list.len) as usize {
                if let (Some(operand), Some(done)) = (section.lists.get_mut(place), done.get_mut(place))
                    && !std::mem::replace(done, true)
                {
                    rename(class, operand);
                }
            }
        }
    }
}
