//! Checks every row of the table of operations: each overload is typed, run on the reference and lowered to WGSL and
//! SPIR-V, and external tools accept the output.
//!
//! Tests in the respective crates check that each row folds to what is executed, and that each has a rule of
//! precision that the envelope evaluates.

#[cfg(feature = "reference")]
use crate::architecture::{rust_files, text_of};
use crate::emit::Collected;
use crate::support::fragment_program;
use glisten_emit::{Conventions, Target, emit};
use glisten_front::builtin::BuiltinFunction;
use glisten_front::builtin::functions::{Row, Signature};
use glisten_front::builtin::operations::{Class, TextureArgument};
use glisten_front::hir::{ParamMode, Stage, Type, TypeId, Types};
use glisten_front::language::NEVER;
use std::fmt::Write;

/// Functions that a target does not support in any program. The documentation names them.
const REFUSED: &[(&str, &str)] = &[
    ("textureSize", "sampler2DMSArray"),
    ("texelFetch", "sampler2DMSArray"),
    ("textureGrad", "samplerCube"),
    ("textureGather", "isamplerCube"),
    ("textureGather", "usamplerCube"),
    ("textureQueryLod", "samplerCube"),
];

/// An argument: samplers are uniforms, offsets are constant, and all others depend on a uniform, so that nothing is
/// folded.
fn argument(ty: TypeId, mode: ParamMode, role: Option<TextureArgument>, index: usize, uniforms: &mut String) -> String {
    let types = Types::basic();
    let name = types.name(ty);
    if matches!(types.get(ty), Type::Sampler(_)) {
        let _ = writeln!(uniforms, "uniform {name} s{index};");
        return format!("s{index}");
    }
    match (mode, role) {
        (ParamMode::In, Some(TextureArgument::Offset | TextureArgument::Component)) => format!("{name}(1)"),
        (ParamMode::In, Some(TextureArgument::Offsets)) => {
            format!("{name}(ivec2(0), ivec2(1), ivec2(-1, 2), ivec2(3))")
        }
        (ParamMode::In, _) => format!("{name}(x)"),
        _ => format!("out{index}"),
    }
}

/// A fragment stage that calls one overload.
fn text(row: &Row, signature: &Signature) -> String {
    let types = Types::basic();
    let sampler = signature.params().first().and_then(|param| match types.get(param.0) {
        Type::Sampler(kind) => Some(kind),
        _ => None,
    });
    let roles: Vec<TextureArgument> = match (row.function.class(), sampler) {
        (Class::Texture(form), Some(kind)) => form.arguments(kind).into_iter().collect(),
        _ => Vec::new(),
    };
    let (mut uniforms, mut locals) = (String::from("uniform float x;\n"), String::new());
    let mut arguments = Vec::new();
    for (index, &(ty, mode)) in signature.params().iter().enumerate() {
        let role = index.checked_sub(1).and_then(|place| roles.get(place)).copied();
        let text = argument(ty, mode, role, index, &mut uniforms);
        if mode != ParamMode::In {
            let _ = write!(locals, "{} {text}; ", types.name(ty));
        }
        arguments.push(text);
    }
    let ret = types.name(signature.ret);
    let call = format!("{}({})", row.name, arguments.join(", "));
    let body = match signature.ret {
        TypeId::VOID => {
            let last = arguments.last().map_or("x", String::as_str);
            format!("{call}; o = vec4({last} == {last});")
        }
        _ => format!("{ret} r = {call}; o = vec4(r == r);"),
    };
    let availability = row.availability;
    let number = if availability.since.desktop == NEVER { 150 } else { availability.since.desktop.max(150) };
    let extension = match availability.extensions.name() {
        Some(name) if availability.since.desktop == NEVER => format!("#extension {name} : enable\n"),
        _ => String::new(),
    };
    format!("#version {number}\n{extension}{uniforms}out vec4 o;\nvoid main() {{ {locals}{body} }}\n")
}

/// Each overload of each row, in fragment stages.
fn overloads() -> impl Iterator<Item = (&'static Row, Signature)> {
    let operations = BuiltinFunction::ALL.iter().map(|function| function.operation());
    operations
        // Functions of geometry stages have no targets.
        .filter(|operation| !matches!(operation.class, Class::Emission(_)))
        .flat_map(|operation| operation.prototypes())
        .filter(|row| row.availability.stages.has(Stage::Fragment))
        .flat_map(|row| row.signatures(Stage::Fragment).map(move |signature| (row, signature)))
}

#[test]
fn every_row_is_typed_and_lowered() {
    let mut collected = Collected::new();
    let (mut count, mut failures) = (0, Vec::new());
    for (row, signature) in overloads() {
        let text = text(row, &signature);
        let program = fragment_program(&text);
        let told = signature.describe(row.name, Types::basic());
        for target in [Target::Wgsl, Target::Spirv] {
            match emit(&program, Stage::Fragment, target, &Conventions::default()) {
                Ok(emitted) => collected.add(&told, emitted),
                Err(diagnostics) => {
                    let name = row.function.name();
                    let refused = REFUSED.iter().any(|row| name == row.0 && told.contains(row.1));
                    if !refused {
                        failures.push(format!("{told} as {}: {}", target.name(), diagnostics[0].message));
                    }
                }
            }
        }
        count += 1;
    }
    assert!(count > 450, "only {count} overloads");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    collected.validate();
}

/// A rule of the pipeline is data: the reference reads its number where it applies it.
#[test]
#[cfg(feature = "reference")]
fn every_rule_of_the_pipeline_is_evaluated() {
    use glisten_reference::domain::rules;
    let sources: Vec<String> = rust_files("crates/reference/src").iter().map(|path| text_of(path)).collect();
    for step in rules::PIPELINE.iter().chain(rules::OWN) {
        let reads = ["ulps", "absolute", "limit", "steps", "between"].map(|number| format!("{}.{number}()", step.name));
        let is_read = sources.iter().any(|text| reads.iter().any(|read| text.contains(read)));
        assert!(is_read, "no code reads the rule {}: {}", step.name, step.describe());
    }
}

/// Compiling for the reference expands every call. The executor's own tests check the results.
#[test]
#[cfg(feature = "reference")]
fn every_row_is_executed() {
    for (row, signature) in overloads() {
        let text = text(row, &signature);
        let code = glisten_reference::exec::Code::compile(&fragment_program(&text), Stage::Fragment);
        assert!(code.is_ok(), "{}", signature.describe(row.name, Types::basic()));
    }
}
