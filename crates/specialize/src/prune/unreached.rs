//! What reaches no output of a stage, whatever its inputs are.
//!
//! *In:* a stage as it was written, and the outputs that somebody reads. *Out:* the stage without the rest.
//! *Holds:* globals keep their handles, so that an interface still describes the stage; functions are numbered anew. Nothing
//! is evaluated: names, types and the order of what stays are those of the source, but for the names of overloads that have the same
//! parameters now.

use super::{compact, merge, overwritten_in, sweep, uses};
use glisten_front::hir::{ExprId, GlobalId, Shader, Storage, Types, may_act};

/// Leaves out what reaches no output. `live` says for each global whether somebody reads it when the stage has ended.
pub(crate) fn without_unreached(types: &Types, shader: &Shader, live: &[bool]) -> Shader {
    let mut shader = shader.clone();
    // Whether the last round took neither functions nor parameters: without a change, there is nothing to compact then.
    let mut is_compact = false;
    for _ in 0..super::ROUNDS {
        let parameters = |shader: &Shader| shader.functions.iter().map(|function| function.param_count).sum::<usize>();
        let before = (shader.functions.len(), parameters(&shader));
        let mut changed = sweep::sweep(types, &mut shader, live);
        changed |= overwritten_in(&mut shader);
        changed |= forget_initializers(types, &mut shader);
        if !changed && is_compact {
            break;
        }
        // Nobody asks where the functions came from.
        let mut origins = Vec::new();
        shader = compact::compact(types, &shader, &|_| true, &mut origins).0;
        is_compact = before == (shader.functions.len(), parameters(&shader));
        if !changed && is_compact {
            break;
        }
    }
    // Overloads whose parameters are gone would differ in their results alone (GLSL 1.50 §6.1).
    merge::name(&mut shader);
    shader.mark_static_use();
    shader
}

/// Takes the initializers from globals that nobody names, where evaluating them does nothing else.
fn forget_initializers(types: &Types, shader: &mut Shader) -> bool {
    let uses = uses::Uses::of(types, shader);
    let mut changed = false;
    for index in 0..shader.globals.len() {
        let Some(global) = shader.globals.get(index) else { continue };
        let Some(initializer) = global.initializer.filter(|_| global.storage == Storage::Private) else { continue };
        if uses.global(GlobalId::new(index)).named > 0 || !is_plain(shader, initializer) {
            continue;
        }
        if let Some(global) = shader.globals.get_mut(index) {
            global.initializer = None;
            changed = true;
        }
    }
    changed
}

fn is_plain(shader: &Shader, root: ExprId) -> bool {
    let mut plain = true;
    shader.visit_expr(root, &mut |expr| {
        plain &= !may_act(&shader.expr(expr).kind);
    });
    plain
}
