//! [`Visibility`]: the stages that see each binding, as the reflection has them.
//!
//! *In:* a program and its conventions. *Out:* the stages of a binding. *Holds:* a host that reads the reflection makes this
//! layout, so drawing shows that the reflection is right. It also counts fewer resources for each stage: Mesa 22.3's lavapipe
//! writes outside an array, and crashes, when a long stage that sees four uniform buffers branches on the fourth.

use glisten_emit::{Conventions, reflect};
use glisten_front::link::{Program, SlotBinding};
use std::collections::BTreeMap;

/// The stages that see the bindings of a program.
pub(super) struct Visibility {
    stages: BTreeMap<(u32, u32), wgpu::ShaderStages>,
}

impl Visibility {
    /// The visibility in emitted code.
    pub(super) fn of(program: &Program, conventions: &Conventions) -> Self {
        let reflection = reflect(program, conventions);
        let mut stages = BTreeMap::new();
        if let Some(loose) = &reflection.loose_block {
            stages.insert((loose.group, loose.binding), flags(&loose.visibility));
        }
        for block in &reflection.blocks {
            for element in 0..block.array_size.unwrap_or(1) {
                stages.insert((block.group, block.binding + element), flags(&block.visibility));
            }
        }
        for row in &reflection.samplers {
            for slot in [&row.texture, &row.sampler] {
                stages.insert((slot.group, slot.binding), flags(&row.visibility));
            }
        }
        Self { stages }
    }

    /// The visibility in code that is not glisten's: both stages may see everything.
    pub(super) fn of_any_code() -> Self {
        Self { stages: BTreeMap::new() }
    }

    /// The stages that see a binding. Those that the reflection does not list, all stages see.
    pub(super) fn stages(&self, slot: SlotBinding) -> wgpu::ShaderStages {
        let all = wgpu::ShaderStages::VERTEX_FRAGMENT;
        self.stages.get(&(slot.group, slot.binding)).copied().unwrap_or(all)
    }
}

fn flags(names: &[String]) -> wgpu::ShaderStages {
    let of = |name: &String| match name.as_str() {
        "vertex" => wgpu::ShaderStages::VERTEX,
        "fragment" => wgpu::ShaderStages::FRAGMENT,
        _ => wgpu::ShaderStages::NONE,
    };
    names.iter().map(of).fold(wgpu::ShaderStages::NONE, |all, one| all | one)
}
