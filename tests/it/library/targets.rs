//! Compiles every function alone for every target, called from a fragment shader and from a vertex shader.

use crate::emit::Collected;
use crate::support::compiler;
use glisten::library::Embedded;
use glisten_emit::{Conventions, Target, emit};
use glisten_front::Source;
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_verify::measure::{Trial, forms};

const FRAGMENT: &str =
    "#version 150\nflat in vec4 glisten_result;\nout vec4 color;\nvoid main() { color = glisten_result; }\n";

/// The call of an evaluator's fragment shader, moved into a vertex shader.
fn in_a_vertex_shader(text: &str) -> Program {
    let moved = text
        .replace("gl_FragCoord.xy", "vec2(float(gl_VertexID), 0.0)")
        .replace("out vec4 glisten_result;", "flat out vec4 glisten_result;")
        .replace("    ivec2 at = ", "    gl_Position = vec4(0.0);\n    ivec2 at = ");
    let source = |name: &str, text: String, stage| Source { name: name.into(), text: text.into(), stage };
    let sources =
        [source("call.vert", moved, Stage::Vertex), source("call.frag", FRAGMENT.to_owned(), Stage::Fragment)];
    let compilation = compiler().with_includes(Embedded).compile(&sources);
    let told: Vec<&str> = compilation.diagnostics.iter().map(|found| found.message.as_str()).collect();
    compilation.program.unwrap_or_else(|| panic!("{told:?}\n{text}"))
}

#[test]
fn every_function_is_accepted_by_every_target_in_both_stages() {
    let mut collected = Collected::new();
    for form in forms() {
        let trial = Trial::new(form, 1).unwrap_or_else(|error| panic!("{}: {error}", form.signature));
        let vertex = in_a_vertex_shader(trial.evaluator().text());
        for (program, stage) in [(trial.evaluator().program(), Stage::Fragment), (&vertex, Stage::Vertex)] {
            for target in [Target::Wgsl, Target::Spirv] {
                let emitted = emit(program, stage, target, &Conventions::default())
                    .unwrap_or_else(|errors| panic!("{}: {}", form.signature, errors[0].message));
                collected.add(&format!("{} as {}, {}", form.signature, target.name(), stage.name()), emitted);
            }
        }
    }
    collected.validate();
}
