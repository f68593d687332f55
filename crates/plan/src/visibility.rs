//! [`Visibility`]: the stages that see each binding, as the reflection has them.
//!
//! *In:* a program and its conventions. *Out:* the stages of a binding. *Holds:* a host that reads the reflection makes this
//! layout, so drawing shows that the reflection is right. It also counts fewer resources for each stage: Mesa 22.3's lavapipe
//! writes outside an array, and crashes, when a long stage that sees four uniform buffers branches on the fourth.

use glisten_emit::{Conventions, reflect};
use glisten_front::link::{Program, SlotBinding};
use std::collections::BTreeMap;
use wgpu_types as wgpu;

/// The stages that see the bindings of a program.
pub struct Visibility {
    stages: BTreeMap<(u32, u32), wgpu::ShaderStages>,
}

impl Visibility {
    /// The visibility in emitted code.
    pub fn of(program: &Program, conventions: &Conventions) -> Self {
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
    pub fn of_any_code() -> Self {
        Self { stages: BTreeMap::new() }
    }

    /// The stages that see a binding. Those that the reflection does not list, all stages see.
    pub fn stages(&self, slot: SlotBinding) -> wgpu::ShaderStages {
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

#[cfg(test)]
mod tests {
    use super::Visibility;
    use super::wgpu;
    use glisten_emit::Conventions;
    use glisten_front::hir::Stage;
    use glisten_front::{Compiler, Source};

    #[test]
    fn a_binding_is_seen_by_the_stages_that_use_it() {
        let source = |stage, text: &str| Source { name: "a".into(), text: text.into(), stage };
        let sources = [
            source(
                Stage::Vertex,
                "#version 150\nlayout(std140) uniform Both { vec4 a; }; layout(std140) uniform First { vec4 b; };\n\
                 uniform mat4 m; in vec4 p; void main() { gl_Position = m * p + a + b; }",
            ),
            source(
                Stage::Fragment,
                "#version 150\nlayout(std140) uniform Both { vec4 a; }; uniform sampler2D t;\n\
                 out vec4 c; void main() { c = a + texture(t, vec2(0.5)); }",
            ),
        ];
        let program = Compiler::new(Default::default()).compile(&sources).program.expect("the program is valid");
        let visibility = Visibility::of(&program, &Conventions::default());
        let interface = &program.interface;
        let of = |name: &str| interface.blocks.iter().find(|block| block.name == name).map(|block| block.slot);
        let seen = |slot| visibility.stages(slot);
        assert_eq!(of("Both").map(seen), Some(wgpu::ShaderStages::VERTEX_FRAGMENT));
        assert_eq!(of("First").map(seen), Some(wgpu::ShaderStages::VERTEX));
        assert_eq!(interface.loose.map(|(slot, _)| seen(slot)), Some(wgpu::ShaderStages::VERTEX));
        let texture = &interface.samplers[0];
        assert_eq!([texture.texture, texture.sampler].map(seen), [wgpu::ShaderStages::FRAGMENT; 2]);
        let any = Visibility::of_any_code();
        assert_eq!(of("First").map(|slot| any.stages(slot)), Some(wgpu::ShaderStages::VERTEX_FRAGMENT));
    }
}
