//! Constants whose initializers glslang does not evaluate, though GLSL calls them constant (4.50 §4.3.3): they become their values.
//!
//! *In:* a stage. *Out:* the stage. *Holds:* a constant keeps its initializer where glslang evaluates it, and where its value has no literal.

use glisten_front::hir::{ExprId, ExprKind, ScalarValue, Shader, Storage, VarRef};

/// The functions that glslang 12 evaluates, whatever the types of their arguments: not `mix`, which it does not of booleans.
const EVALUATED: &[&str] = &[
    "abs",
    "acos",
    "all",
    "any",
    "asin",
    "atan",
    "ceil",
    "clamp",
    "cos",
    "cross",
    "degrees",
    "distance",
    "dot",
    "equal",
    "exp",
    "exp2",
    "faceforward",
    "floor",
    "fract",
    "greaterThan",
    "greaterThanEqual",
    "inversesqrt",
    "isinf",
    "isnan",
    "length",
    "lessThan",
    "lessThanEqual",
    "log",
    "log2",
    "max",
    "min",
    "mod",
    "normalize",
    "not",
    "notEqual",
    "outerProduct",
    "pow",
    "radians",
    "reflect",
    "refract",
    "round",
    "roundEven",
    "sign",
    "sin",
    "smoothstep",
    "sqrt",
    "step",
    "tan",
    "trunc",
];

/// Replaces the initializers of such constants. Where the value has no literal, since it is not finite, the constant becomes a variable.
pub(super) fn evaluate(shader: &mut Shader) {
    for index in 0..shader.globals.len() {
        let Some(global) = shader.globals.get(index) else { continue };
        let is_constant = global.storage == Storage::Const;
        let Some(initializer) = global.initializer.filter(|_| is_constant) else { continue };
        let has_literals = global.value.as_ref().is_some_and(|value| {
            value.scalars.iter().all(|scalar| !matches!(scalar, ScalarValue::Float(number) if !number.is_finite()))
        });
        if !is_beyond(shader, initializer) {
            continue;
        }
        if let Some(global) = shader.globals.get_mut(index) {
            if has_literals {
                global.initializer = None;
            } else {
                global.storage = Storage::Private;
            }
        }
    }
}

/// Whether an initializer calls a function that glslang does not evaluate, or reads what is no constant any more.
fn is_beyond(shader: &Shader, initializer: ExprId) -> bool {
    let mut beyond = false;
    shader.visit_expr(initializer, &mut |id| match &shader.expr(id).kind {
        ExprKind::BuiltinCall(function, _) => beyond |= !EVALUATED.contains(&function.name()),
        ExprKind::Var(VarRef::Global(global)) => beyond |= shader.global(*global).storage == Storage::Private,
        _ => {}
    });
    beyond
}

#[cfg(test)]
mod tests {
    use crate::{Conventions, Emitted, GlslVersion, Target, emit};
    use glisten_front::{Compiler, Options, Source, Stage};

    #[test]
    fn constants_that_glslang_does_not_evaluate_are_values() {
        let text = "#version 330\nout vec4 color;\nconst float a = sqrt(4.0);\nconst float b = acosh(1.0) + 2.0;\n\
            const mat2 c = inverse(mat2(0.0));\nconst float d = c[0].x;\n\
            void main() { color = vec4(a, b, d, c[1].y); }\n";
        let source = Source { name: "a.frag".to_owned(), text: text.into(), stage: Stage::Fragment };
        let program = Compiler::new(Options::default()).compile(&[source]).program.expect("it compiles");
        let conventions = Conventions { glsl_version: GlslVersion::Vulkan, ..Conventions::default() };
        let emitted = emit(&program, Stage::Fragment, Target::Glsl, &conventions).expect("it is written");
        let Emitted::Text(text) = emitted else { panic!("no text") };
        for line in [
            "const float a = sqrt(4.0);",
            "const float b = 2.0;",
            "\nmat2 c = inverse(mat2(0.0));",
            "\nfloat d = c[0].x;",
        ] {
            assert!(text.contains(line), "{line}\n{text}");
        }
    }
}
