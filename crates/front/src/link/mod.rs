//! Links stages into a program (GLSL 1.50 §4.3.4 to §4.3.9, OpenGL 3.2 §2.11).
//!
//! *In:* analyzed shaders, and bindings by name. *Out:* a [`Program`]: the stages, with every interface matched and
//! every location, offset and binding assigned; or none, if the link has errors.
//!
//! *Holds:* the [`Interface`] is everything that `lower`, `emit`, `cpu` and `gpu` know about a shader's interfaces;
//! none of them assigns locations of its own. A link reports all its errors, each at the declaration in the later
//! stage, with the earlier stage's declaration as a secondary label.
//!
//! | file | contents |
//! | --- | --- |
//! | `canonical` | gives equal structs of different shaders one type |
//! | `merge`, `remap`, `geometry` | merge several shaders of one stage into one |
//! | `compatible` | whether two declarations in different shaders have the same type |
//! | `stages` | the stages of a program; `main`; geometry layouts |
//! | `matching` | outputs of one stage against inputs of the next |
//! | `geometry_inputs` | which outputs of the vertex stage the geometry stage reads |
//! | `per_vertex` | redeclarations of `gl_PerVertex` |
//! | `varyings` | interpolated variables, split and with locations |
//! | `clip_distances` | `gl_ClipDistance` as an input of the fragment stage |
//! | `clip_states` | clip distances that the host disables |
//! | `attributes`, `outputs` | vertex inputs and fragment outputs with locations |
//! | `bindings` | locations that a host binds by names that are not there |
//! | `declared` | variables whose locations the text or the host may set |
//! | `locations` | the allocator of all locations |
//! | `uniforms`, `samplers` | the variables that are constant during a draw, with locations and bindings |
//! | `layout` | std140 |
//! | `fixed` | clamped colors, the color of a side, clip planes: state of the fixed-function pipeline as statements |
//! | `statements` | expressions and statements that a link adds |
//! | `partial` | checks between stages with errors |

mod aliasing;
mod attributes;
mod bindings;
mod block_places;
mod canonical;
mod clip_distances;
mod clip_states;
mod compatible;
mod declared;
mod fixed;
mod flatten;
mod geometry;
mod geometry_inputs;
mod layout;
mod locations;
mod matching;
mod merge;
mod outputs;
mod partial;
mod per_vertex;
mod precisions;
mod program;
mod remap;
mod samplers;
mod stages;
mod statements;
mod tex_coords;
mod uniforms;
pub mod usage;
mod varyings;

pub use bindings::COLOR_NUMBER;
pub use fixed::FixedState;
pub use layout::{MAX_BLOCK_BYTES, std140};
pub use matching::partners;
pub use partial::{Understood, check_understood};
pub use program::{
    Attribute, Block, BlockIndex, GeometryInput, Interface, Output, Program, RootIndex, SamplerSlot, SlotBinding,
    UniformLeaf, UniformRoot, Varying, VaryingEnd,
};
pub use remap::Remap;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::hir::{Shader, Stage, Types};
use canonical::Sizes;

/// The state that all steps of a link share.
struct Linker<'a> {
    types: &'a Types,
    bindings: Bindings<'a>,
    diagnostics: &'a mut Diagnostics,
    failed: bool,
}

impl Linker<'_> {
    fn report(&mut self, diagnostic: Diagnostic) {
        self.failed |= diagnostic.is_error();
        self.diagnostics.push(diagnostic);
    }
}

/// The locations that a host binds by name before linking.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bindings<'a> {
    /// `glBindAttribLocation`: name and location. The last entry for a name counts.
    pub attribute_locations: &'a [(String, u32)],
    /// `glBindFragDataLocation`: name and color number. The last entry for a name counts.
    pub frag_data_locations: &'a [(String, u32)],
    /// The state of the fixed-function pipeline.
    pub fixed: FixedState,
    /// Whether a host builds each stage by itself, as those of Vulkan do: names of uniforms are those of a stage then.
    pub stages_apart: bool,
}

/// Links analyzed shaders; `None` if that fails. A single shader links, too: its interface is then that of one stage.
/// If other shaders of its stage must complete it (no `main`, or a function that is only declared), the link gives
/// warnings and no program.
pub fn link(
    name: String,
    mut types: Types,
    mut shaders: Vec<Shader>,
    bindings: Bindings<'_>,
    diagnostics: &mut Diagnostics,
) -> Option<Program> {
    let lone = shaders.len() < 2;
    canonical::unify(&mut types, &mut shaders, Sizes::Tentative);
    let mut found = Vec::new();
    stages::check_languages(&shaders, &mut found);
    let mut stages = stages::in_order(&mut types, shaders, &mut found);
    canonical::unify(&mut types, &mut stages, Sizes::Final);
    tex_coords::size(&mut types, &mut stages);
    fixed::apply(&mut types, &mut stages, bindings.fixed);
    let mut ctx = Linker { types: &types, bindings, diagnostics, failed: false };
    found.into_iter().for_each(|diagnostic| ctx.report(diagnostic));
    let complete = stages::check(&mut ctx, &stages, lone);
    let interface = interface(&mut ctx, &stages);
    bindings::check(&mut ctx, &stages);
    let failed = ctx.failed;
    (complete && !failed).then_some(Program { name, types, stages, interface })
}

/// Links the stages of a program again after something was left out of them: their interface is made again. `None` if that fails.
pub fn relink(name: String, types: Types, stages: Vec<Shader>, bindings: Bindings<'_>) -> Option<Program> {
    let mut diagnostics = Diagnostics::default();
    let mut ctx = Linker { types: &types, bindings, diagnostics: &mut diagnostics, failed: false };
    let interface = interface(&mut ctx, &stages);
    let failed = ctx.failed;
    (!failed).then_some(Program { name, types, stages, interface })
}

fn interface(ctx: &mut Linker<'_>, stages: &[Shader]) -> Interface {
    let of = |stage: Stage| stages.iter().find(|shader| shader.stage == stage);
    let mut interface = Interface::default();
    for pair in stages.windows(2) {
        if let [producer, consumer] = pair {
            matching::check(ctx, producer, consumer);
        }
    }
    if let Some(vertex) = of(Stage::Vertex) {
        interface.attributes = attributes::assign(ctx, vertex);
    }
    if let (Some(vertex), Some(geometry)) = (of(Stage::Vertex), of(Stage::Geometry)) {
        interface.geometry_inputs = geometry_inputs::connect(ctx.types, vertex, geometry);
    }
    (interface.varyings, interface.clip_distances) = varyings::assign(ctx, stages);
    if let Some(fragment) = of(Stage::Fragment) {
        interface.outputs = outputs::assign(ctx, fragment);
    }
    interface.samplers = samplers::assign(ctx, stages);
    uniforms::assign(ctx, stages, &mut interface);
    interface
}
