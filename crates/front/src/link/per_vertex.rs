//! Redeclarations of `gl_PerVertex` must be the same wherever its members are used (ARB_separate_shader_objects; GLSL
//! 4.10 §7.1 states for `gl_PerVertex` what in 1.50 follows from the rules of blocks).

use crate::builtin::{BuiltinVariable, variables};
use crate::diagnostic::{Diagnostic, codes};
use crate::hir::{Global, Shader, Storage, Type, Types};
use crate::source::Span;

/// A shader's side of a `gl_PerVertex` block that it uses.
struct Side<'a> {
    shader: &'a Shader,
    /// The members, if the block is redeclared; `None` for the predefined block.
    members: Option<(Vec<&'a str>, Span)>,
}

impl Side<'_> {
    fn names(&self) -> Option<&[&str]> {
        self.members.as_ref().map(|(names, _)| names.as_slice())
    }

    fn span(&self) -> Span {
        self.members.as_ref().map_or_else(|| self.shader.anchor(), |(_, span)| *span)
    }
}

/// The output block, if the shader uses a member of it.
fn output(shader: &Shader) -> Option<Side<'_>> {
    let is_member = |global: &Global| {
        global.storage == Storage::Out
            && variables::VARIABLES.iter().any(|row| row.per_vertex && Some(row.variable) == global.builtin)
    };
    let declared = shader.per_vertex_out.as_ref();
    let members = declared.map(|block| (block.members.iter().map(String::as_str).collect(), block.span));
    (declared.is_some() || shader.globals.iter().any(is_member)).then_some(Side { shader, members })
}

/// `gl_in`, if the shader uses it.
fn input<'a>(types: &'a Types, shader: &'a Shader) -> Option<Side<'a>> {
    let global = shader.globals.iter().find(|global| global.builtin == Some(BuiltinVariable::In))?;
    let members = match types.element(global.ty).map(|element| types.get(element)) {
        Some(Type::Struct(id)) if global.span.is_known() => {
            let names = types.structure(id).members.iter().map(|member| member.name.as_str()).collect();
            Some((names, global.span))
        }
        _ => None,
    };
    Some(Side { shader, members })
}

/// Checks the shaders of one stage against each other.
pub(super) fn check_stage(shaders: &[Shader], found: &mut Vec<Diagnostic>) {
    let sides: Vec<Side<'_>> = shaders.iter().filter_map(output).collect();
    for pair in sides.windows(2) {
        let [first, second] = pair else { continue };
        found.extend(mismatch(first, second));
    }
}

/// Checks the outputs of a stage against the `gl_in` of the next.
pub(super) fn check_stages(types: &Types, producer: &Shader, consumer: &Shader) -> Option<Diagnostic> {
    mismatch(&output(producer)?, &input(types, consumer)?)
}

fn mismatch(first: &Side<'_>, second: &Side<'_>) -> Option<Diagnostic> {
    if first.names() == second.names() {
        return None;
    }
    let message = "`gl_PerVertex` is not declared alike in all shaders that use it";
    let finding = Diagnostic::new(&codes::link::PER_VERTEX_MISMATCH, second.span(), message);
    let word = |side: &Side<'_>| match side.names() {
        Some(names) => format!("declared with `{}`", names.join("`, `")),
        None => "used as it is built in".to_owned(),
    };
    Some(finding.here(word(second)).label(first.span(), word(first)))
}
