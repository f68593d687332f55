//! What reaches no output of a stage, whatever its inputs are.
//!
//! *In:* a stage as it was written, and the outputs that somebody reads. *Out:* the stage without the rest.
//! *Holds:* globals keep their handles, so that an interface still describes the stage; functions are numbered anew. Nothing
//! is evaluated: names, types and the order of what stays are those of the source, but for the names of overloads that have the same
//! parameters now, results that nobody wants, and parts of values that nobody reads, which are 0.

use super::uses::Uses;
use super::{compact, merge, overwritten_in, sweep};
use glisten_front::hir::{FunctionId, GlobalId, LocalId, Shader, Storage, Types, is_pure};

/// Leaves out what reaches no output. `live` says for each global whether somebody reads it when the stage has ended.
pub(crate) fn without_unreached(types: &Types, shader: &Shader, live: &[bool]) -> Shader {
    let mut shader = shader.clone();
    // Nobody asks where the functions came from.
    let mut origins = Vec::new();
    for _ in 0..super::ROUNDS {
        let uses = Uses::of(types, &shader);
        let swept = sweep::sweep(types, &mut shader, live, uses);
        let mut changed = swept.changed | overwritten_in(types, &mut shader, &swept.uses);
        let mut uses = if changed { Uses::of(types, &shader) } else { swept.uses };
        if forget_initializers(&mut shader, &uses) {
            changed = true;
            uses = Uses::of(types, &shader);
        }
        let parameters = parameters(&shader, uses.functions.iter().copied());
        if !changed && uses.functions.len() == shader.functions.len() && !has_idle_parameter(&shader, &uses) {
            break;
        }
        shader = compact::compact((types, &shader), (&uses, live), &|_| true, &mut origins).0;
        // Functions that nothing reached had no part in the counts; arguments had.
        if !changed && parameters == self::parameters(&shader, shader.functions().map(|(id, _)| id)) {
            break;
        }
    }
    // Overloads whose parameters are gone would differ in their results alone (GLSL 1.50 §6.1).
    merge::name(types, &mut shader);
    shader.mark_static_use();
    shader
}

/// How many parameters functions have.
fn parameters(shader: &Shader, functions: impl Iterator<Item = FunctionId>) -> usize {
    functions.map(|id| shader.function(id).param_count).sum()
}

/// Whether a function that is reached has a parameter that it does not name.
fn has_idle_parameter(shader: &Shader, uses: &Uses) -> bool {
    let is_idle = |id: FunctionId, index| uses.local(id, LocalId::new(index)).named == 0;
    uses.functions.iter().any(|id| (0..shader.function(*id).param_count).any(|index| is_idle(*id, index)))
}

/// Takes the initializers from globals that nobody names, where evaluating them does nothing else.
fn forget_initializers(shader: &mut Shader, uses: &Uses) -> bool {
    let mut changed = false;
    for index in 0..shader.globals.len() {
        let Some(global) = shader.globals.get(index) else { continue };
        let Some(initializer) = global.initializer.filter(|_| global.storage == Storage::Private) else { continue };
        if uses.global(GlobalId::new(index)).named > 0 || !is_pure(shader, initializer) {
            continue;
        }
        if let Some(global) = shader.globals.get_mut(index) {
            global.initializer = None;
            changed = true;
        }
    }
    changed
}
