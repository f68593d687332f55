//! [`reflection`]: the reflection of texts that name their sets, bindings and offsets.
//!
//! *In:* the program of the new texts. *Out:* its reflection. *Holds:* every number is that of the text. Nothing is hidden: the height
//! of the framebuffer, if the text needs it, is a member of one of its blocks.

use glisten_emit::reflection::{Binding, HiddenSlot, Reflection};
use glisten_emit::{Conventions, reflect};
use glisten_front::link::Program;
use std::collections::BTreeMap;

/// The beginning of the name of the member for the height of the framebuffer.
const HEIGHT: &str = "framebufferHeight";

/// The reflection of a program.
pub fn reflection(program: &Program) -> Reflection {
    let mut new = reflect(program, &Conventions::default());
    let mut places = BTreeMap::new();
    for (block, row) in new.blocks.iter_mut().zip(&program.interface.blocks) {
        let binding = row.unit.unwrap_or(row.slot.binding);
        places.insert((block.group, block.binding), (row.slot.group, binding));
        (block.group, block.binding) = (row.slot.group, binding);
    }
    for uniform in &mut new.uniforms {
        if let Some((group, binding)) = places.get(&(uniform.group, uniform.binding)) {
            (uniform.group, uniform.binding) = (*group, *binding);
        }
    }
    for (sampler, row) in new.samplers.iter_mut().zip(&program.interface.samplers) {
        let binding = row.unit.unwrap_or(row.texture.binding);
        sampler.texture = Binding { group: row.texture.group, binding };
        sampler.sampler = sampler.texture;
    }
    new.loose_block = None;
    let heights = new.uniforms.iter().filter(|uniform| uniform.name.starts_with(HEIGHT) && uniform.ty == "float");
    let height = heights.max_by_key(|uniform| uniform.name.len());
    new.conventions.framebuffer_height =
        height.map(|uniform| HiddenSlot { group: uniform.group, binding: uniform.binding, offset: uniform.offset });
    new
}

/// The names of what has another number in the code that glisten emits than in the texts, which may share files with other programs.
/// `code` is the program that is emitted, `texts` that of the new texts.
pub fn renumbered(code: &Program, texts: &Program) -> Vec<String> {
    let loose = code.interface.loose.map(|(slot, _)| slot.binding);
    let block = |name: &str| {
        let found = code.interface.blocks.iter().find(|block| block.name == name);
        found.map(|block| block.slot.binding).or(loose)
    };
    let blocks = texts.interface.blocks.iter().filter(|row| row.unit.is_some() && block(&row.name) != row.unit);
    let sampler = |name: &str| {
        let found = code.interface.samplers.iter().find(|sampler| sampler.name == name);
        found.map(|sampler| sampler.texture.binding)
    };
    let samplers = texts.interface.samplers.iter().filter(|row| row.unit.is_some() && sampler(&row.name) != row.unit);
    blocks.map(|row| row.name.clone()).chain(samplers.map(|row| row.name.clone())).collect()
}
