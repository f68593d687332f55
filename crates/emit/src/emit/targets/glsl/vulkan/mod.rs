//! A stage by the rules of GLSL for Vulkan (GL_KHR_vulkan_glsl): every resource has a set and a binding, everything
//! between stages a location, and every loose uniform is a member of one block.
//!
//! *In:* a copy of a stage, its program, the conventions. *Out:* the same stage in Vulkan's terms, the words that its
//! layouts get, or what Vulkan lacks. *Holds:* sets, bindings, offsets and locations are those of the reflection; a
//! combined sampler has the set and binding of its texture, and an array those of its first element.
//!
//! | file | contents |
//! | --- | --- |
//! | `coordinates` | `gl_Position`, `gl_FragCoord`, `gl_PointCoord`, `dFdy` as the conventions want them |
//! | `limits` | what Vulkan lacks |
//! | `locations` | locations of varyings |
//! | `opaque` | samplers in structs as variables of their own |
//! | `uniforms` | loose uniforms as members of a block |

mod constants;
mod coordinates;
mod limits;
mod locations;
mod opaque;
mod uniforms;

use crate::target::{Conventions, WindowOrigin};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::{
    BlockLayout, ExprId, ExprKind, Global, GlobalId, Shader, Stage, Storage, TypeId, Types, VarRef, all_names,
    fresh_name,
};
use glisten_front::link::{Program, SlotBinding};
use glisten_front::source::Span;
use std::collections::BTreeMap;

/// The words that the layouts of a stage get besides those of its typed program.
#[derive(Clone, Debug, Default)]
pub(super) struct Layouts {
    /// Whether built-in variables have Vulkan's names.
    is_vulkan: bool,
    words: BTreeMap<GlobalId, Vec<String>>,
}

impl Layouts {
    /// The words of a global.
    pub(super) fn of(&self, global: GlobalId) -> Vec<String> {
        self.words.get(&global).cloned().unwrap_or_default()
    }

    /// The name of a built-in variable. Vulkan's indices count from the first of the draw; hosts draw from 0.
    pub(super) fn builtin_name(&self, builtin: BuiltinVariable) -> &'static str {
        match builtin {
            BuiltinVariable::VertexId if self.is_vulkan => "gl_VertexIndex",
            BuiltinVariable::InstanceId if self.is_vulkan => "gl_InstanceIndex",
            other => other.name(),
        }
    }

    fn add(&mut self, global: GlobalId, word: String) {
        self.words.entry(global).or_default().push(word);
    }

    fn set(&mut self, global: GlobalId, slot: SlotBinding) {
        self.add(global, format!("set = {}", slot.group));
    }
}

/// Rewrites a stage.
pub(super) fn rewrite(
    types: &mut Types,
    shader: &mut Shader,
    program: &Program,
    conventions: &Conventions,
) -> Result<Layouts, Vec<Diagnostic>> {
    let lacks = limits::of(types, shader, conventions);
    if !lacks.is_empty() {
        return Err(lacks);
    }
    let mut layouts = Layouts { is_vulkan: true, ..Layouts::default() };
    locations::assign(types, shader, program, &mut layouts);
    blocks(shader, program, &mut layouts);
    samplers(shader, program, &mut layouts);
    let height = uniforms::gather(types, shader, program, conventions, &mut layouts);
    coordinates::convert(shader, program, conventions, height);
    constants::evaluate(shader);
    Ok(layouts)
}

/// Uniform blocks have the layout, the set and the binding of the reflection.
fn blocks(shader: &mut Shader, program: &Program, layouts: &mut Layouts) {
    for block in &program.interface.blocks {
        let root = program.interface.roots.get(block.root.0 as usize);
        for global in own(root.map_or(&[], |root| root.globals.as_slice()), shader.stage) {
            let info = shader.globals.get_mut(global.index()).and_then(|global| global.block.as_mut());
            if let Some(info) = info {
                (info.layout, info.binding) = (BlockLayout::Std140, Some(block.slot.binding));
                layouts.set(global, block.slot);
            }
        }
    }
}

/// Samplers that are variables have the set and the binding of their texture.
fn samplers(shader: &mut Shader, program: &Program, layouts: &mut Layouts) {
    for slot in program.interface.samplers.iter().rev() {
        for id in own(&slot.globals, shader.stage) {
            let Some(global) = shader.globals.get_mut(id.index()) else { continue };
            // An element of an array or a member of a struct belongs to a variable, too: the first element counts.
            if slot.name == global.name || slot.name == format!("{}[0]", global.name) {
                global.binding = Some(slot.texture.binding);
                layouts.words.remove(&id);
                layouts.set(id, slot.texture);
            }
        }
    }
}

/// Whether a stage reads a row of `gl_FragCoord`, which counts from the bottom and in the target from the top.
fn needs_height(shader: &Shader, conventions: &Conventions) -> bool {
    shader.stage == Stage::Fragment
        && conventions.window_origin == WindowOrigin::UpperLeft
        && !shader.frag_coord.origin_upper_left
        && builtin(shader, BuiltinVariable::FragCoord).is_some_and(|global| shader.global(global).used)
        && shader.reads_row_of_frag_coord()
}

/// The global of a built-in variable.
fn builtin(shader: &Shader, builtin: BuiltinVariable) -> Option<GlobalId> {
    shader.globals().find(|(_, global)| global.builtin == Some(builtin)).map(|(id, _)| id)
}

/// The variables of a stage among those of a program.
fn own(globals: &[(Stage, GlobalId)], stage: Stage) -> impl Iterator<Item = GlobalId> {
    globals.iter().filter(move |(of, _)| *of == stage).map(|(_, global)| *global)
}

/// A variable without qualifiers.
fn plain(name: String, ty: TypeId, storage: Storage) -> Global {
    Global {
        name,
        ty,
        storage,
        builtin: None,
        interpolation: Default::default(),
        interpolation_written: false,
        sampling: Default::default(),
        invariant: false,
        location: None,
        host_location: None,
        component: None,
        index: None,
        binding: None,
        block: None,
        initializer: None,
        value: None,
        implicitly_sized: false,
        used: true,
        written: false,
        span: Span::default(),
    }
}

/// Adds a global.
fn declare(shader: &mut Shader, global: Global) -> GlobalId {
    let id = GlobalId::new(shader.globals.len());
    shader.globals.push(global);
    id
}

/// An expression that is a global.
fn variable(shader: &mut Shader, global: GlobalId) -> ExprId {
    let ty = shader.global(global).ty;
    shader.push(ExprKind::Var(VarRef::Global(global)), ty, Span::default())
}

/// A name that nothing in the program has.
fn unused(program: &Program, wanted: &str) -> String {
    let taken: Vec<_> = program.stages.iter().map(|shader| all_names(&program.types, shader)).collect();
    fresh_name(wanted, |name| taken.iter().any(|names| names.contains(name)))
}
