//! The fixed-function pipeline in tests: its switches, its state, and the stage that a test lacks.
//!
//! *In:* the commands of a test, and its shaders. *Out:* what a program is compiled for, and the values of its built-in uniforms
//! and attributes.

use super::parse::{Line, TestFile};
use glisten_front::compiler::{Compiler, Options, Source};
use glisten_front::hir::Global;
use glisten_front::link::{FixedState, Program};
use glisten_scene::fixed::{FixedFunction, OtherStage, Pipeline, current_attribute, has_fixed_function, other_stage};
use glisten_scene::values::UniformValues;
use glisten_scene::{AttributeData, AttributeValues, FixedDraw};
use std::sync::Arc;

/// The name of the command that selects sides, as OpenGL and its extension call it.
pub(super) const TWO_SIDE: [&str; 2] = ["GL_VERTEX_PROGRAM_TWO_SIDE", "GL_VERTEX_PROGRAM_TWO_SIDE_ARB"];

/// The switches that a test turns on anywhere: they hold for the whole of it.
pub(super) fn switches(commands: &[Line]) -> FixedState {
    let enabled = || commands.iter().filter_map(|line| line.text.strip_prefix("enable ")).map(str::trim);
    let planes = enabled().filter_map(|name| name.strip_prefix("GL_CLIP_PLANE")?.parse::<u32>().ok());
    FixedState {
        two_side: enabled().any(|name| TWO_SIDE.contains(&name)),
        clip_planes: planes.map(|plane| plane.saturating_add(1)).max().unwrap_or(0),
        unclamped_colors: false,
    }
}

/// The same compiler for these switches.
pub(super) fn compiler(compiler: &Compiler, switches: FixedState) -> Compiler {
    compiler.with_options(Options { fixed: switches, ..compiler.options().clone() })
}

/// The stage that the only shader of a test lacks, if it is of a language that has the fixed-function pipeline and the test
/// draws.
pub(super) fn missing_stage(compiler: &Compiler, file: &TestFile, sources: &[Source]) -> Option<OtherStage> {
    let draws = file.commands.iter().any(|line| line.text.starts_with("draw"));
    let [source] = sources else { return None };
    let program = compiler.compile(std::slice::from_ref(source)).program.filter(|_| draws)?;
    let shader = program.stages.first().filter(|shader| has_fixed_function(shader))?;
    Some(other_stage(Pipeline::default(), &program.types, shader))
}

/// The state of a draw, for a program that names the pipeline.
pub(super) fn state(
    program: &Program,
    state: &FixedFunction,
    switches: FixedState,
    generated: Option<&OtherStage>,
) -> Option<Arc<FixedDraw>> {
    let named = program.stages.iter().any(|shader| shader.globals.iter().any(Global::is_fixed));
    let generated = generated.map(|made| (made.stage, made.pipeline));
    named.then(|| Arc::new(FixedDraw { state: state.clone(), switches, generated }))
}

/// Gives the built-in uniforms of a program their values.
pub(super) fn apply(program: &Program, state: &FixedFunction, values: &mut UniformValues) {
    for (root, into) in program.interface.roots.iter().zip(&mut values.roots) {
        if let Some(derived) = state.root_values(root).filter(|derived| derived.len() == into.len()) {
            *into = derived;
        }
    }
}

/// Gives built-in attributes without data their current values.
pub(super) fn fill_attributes(program: &Program, attributes: &mut [Option<AttributeData>]) {
    for (attribute, data) in program.interface.attributes.iter().zip(attributes) {
        if data.is_none()
            && let Some(current) = current_attribute(&attribute.name)
        {
            let (size, values) = (current.len() as u32, AttributeValues::Float(current));
            *data = Some(AttributeData { size, divisor: u32::MAX, values });
        }
    }
}
