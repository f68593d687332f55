//! Combines a product with the sum that alone uses it: one pass over the lanes instead of two, with both roundings
//! preserved.

use super::super::inst::{Class, Float2, Inst, Operand, Target, Use};
use super::emit::Emitter;

/// A product that may be moved to its only use.
#[derive(Clone, Copy)]
struct Product {
    place: usize,
    dst: Operand,
    a: Operand,
    b: Operand,
}

/// How far before the sum a product may be.
const WINDOW: usize = 16;

/// Replaces `t = a * b; ...; d = t + c` by `d = a * b + c` in `main`.
pub(super) fn fuse(emitter: &mut Emitter) {
    let uses = count_reads(emitter);
    let mut pending: Vec<Product> = Vec::new();
    let mut gone = vec![false; emitter.main.insts.len()];
    for place in 0..emitter.main.insts.len() {
        let Some(&inst) = emitter.main.insts.get(place) else { break };
        match inst {
            Inst::Float2 { op: Float2::Mul, dst, a, b } => {
                let movable = !emitter.is_home(Class::Float, a) && !emitter.is_home(Class::Float, b);
                if movable && uses.get(dst.number()) == Some(&1) {
                    pending.push(Product { place, dst, a, b });
                    pending.retain(|product| product.place + WINDOW > place);
                }
            }
            Inst::Float2 { op: Float2::Add, dst, a, b } => {
                let found = pending.iter().position(|product| product.dst == a || product.dst == b);
                if let Some(index) = found {
                    let product = pending.swap_remove(index);
                    let c = if product.dst == a { b } else { a };
                    if let (Some(inst), Some(gone)) = (emitter.main.insts.get_mut(place), gone.get_mut(product.place)) {
                        *inst = Inst::MulAdd { dst, a: product.a, b: product.b, c };
                        *gone = true;
                    }
                }
            }
            // Beyond an instruction where lanes diverge or join, the product might not run as often as the sum.
            _ if inst.is_control() => pending.clear(),
            _ => {}
        }
    }
    remove(emitter, &gone);
}

/// How often each virtual float register is read.
fn count_reads(emitter: &mut Emitter) -> Vec<u32> {
    let mut uses = vec![0u32; emitter.register_count(Class::Float)];
    let mut read = |class: Class, using: Use, operand: &Operand| {
        if class == Class::Float
            && using == Use::Read
            && operand.is_reg()
            && let Some(count) = uses.get_mut(operand.number())
        {
            *count += 1;
        }
    };
    for inst in &mut emitter.main.insts {
        inst.visit(&mut |class, using, operand| read(class, using, operand));
        for (class, using, list) in inst.lists().into_iter().flatten() {
            let range = list.start as usize..(list.start + list.len) as usize;
            let operands = emitter.main.lists.get(range).unwrap_or(&[]);
            operands.iter().for_each(|operand| read(class, using, operand));
        }
    }
    for call in &mut emitter.textures {
        call.visit(&mut |class, using, operand| read(class, using, operand));
    }
    uses
}

/// Removes instructions and adjusts the targets of jumps.
fn remove(emitter: &mut Emitter, gone: &[bool]) {
    let mut moved: Vec<Target> = Vec::with_capacity(gone.len() + 1);
    let mut next = 0;
    for gone in gone {
        moved.push(next);
        next += u32::from(!gone);
    }
    moved.push(next);
    let at = |target: Target| moved.get(target as usize).copied().unwrap_or(next);
    retain(&mut emitter.main.insts, gone);
    retain(&mut emitter.main.spans, gone);
    for inst in &mut emitter.main.insts {
        if let Inst::LoopBack { head, .. } = inst {
            *head = at(*head);
        }
        if let Some(target) = inst.target_mut() {
            *target = at(*target);
        }
    }
}

fn retain<T>(list: &mut Vec<T>, gone: &[bool]) {
    let mut place = 0;
    list.retain(|_| {
        place += 1;
        !gone.get(place - 1).copied().unwrap_or(false)
    });
}
