//! The versions of the language: the fixtures of each in `fixtures/versions`, and for each row of the table of features a
//! text that has it, before and after the versions of the row.

use crate::diagnostics::check;
use crate::emit::Collected;
use crate::support::{compile_text, shaders_under};
use glisten_emit::{Conventions, Target, emit};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::Stage;
use glisten_front::language::{FEATURES, Feature, FeatureRow, NEVER, Profile, Version};
use glisten_front::source::Span;

#[test]
fn fixtures_of_each_version_have_the_expected_findings() {
    let shaders = shaders_under("fixtures/versions");
    let reports: String = shaders.into_iter().filter_map(|shader| check(&[shader]).err()).collect();
    assert!(reports.is_empty(), "\n{reports}");
}

/// Accepted fixtures are also lowered, and external tools accept the output.
#[test]
fn accepted_fixtures_are_lowered() {
    let mut collected = Collected::new();
    let mut count = 0;
    for shader in shaders_under("fixtures/versions").into_iter().filter(|shader| !shader.text.contains("//~ E")) {
        let compilation = compile_text(&shader.name, &shader.text, shader.stage);
        let messages: Vec<&str> =
            compilation.diagnostics.iter().map(|diagnostic| diagnostic.message.as_str()).collect();
        let program = compilation.program.unwrap_or_else(|| panic!("{}: {messages:?}", shader.name));
        for target in [Target::Wgsl, Target::Spirv] {
            let emitted = emit(&program, shader.stage, target, &Conventions::default());
            let told = format!("{} as {}", shader.name, target.name());
            match emitted {
                Ok(emitted) => collected.add(&told, emitted),
                Err(diagnostics) => panic!("{told}: {}", diagnostics[0].message),
            }
        }
        count += 1;
    }
    assert!(count > 20, "only {count} fixtures");
    collected.validate();
}

/// A text without its version line that has the feature, in a stage. None where the effect is no error.
fn probe(feature: Feature) -> Option<(Stage, &'static str)> {
    use Feature as F;
    let vertex = |text| Some((Stage::Vertex, text));
    let fragment = |text| Some((Stage::Fragment, text));
    match feature {
        F::IntegerOperators => vertex("void main() { int a = 7; a = a % 4; gl_Position = vec4(float(a)); }"),
        F::UnsignedLiterals => vertex("void main() { float a = float(7u); gl_Position = vec4(a); }"),
        F::FloatSuffix => vertex("void main() { gl_Position = vec4(1.0f); }"),
        F::InOut => vertex("in vec4 a; void main() { gl_Position = a; }"),
        F::Attributes => vertex("attribute vec4 a; void main() { gl_Position = a; }"),
        F::ArrayObjects => {
            vertex("void main() { float a[2]; a[0] = 1.0; float b[2]; b = a; gl_Position = vec4(b[0]); }")
        }
        F::ArrayArguments => {
            vertex("void f(out float a[2]) { a[0] = 1.0; } void main() { float a[2]; f(a); gl_Position = vec4(a[0]); }")
        }
        F::ArraysOfArrays => vertex("void main() { float a[2][3]; a[1][2] = 1.0; gl_Position = vec4(a[1][2]); }"),
        F::MatrixFromMatrix => vertex("void main() { mat2 a = mat2(mat3(1.0)); gl_Position = vec4(a[0], a[1]); }"),
        F::UniformInitializers => vertex("uniform vec4 a = vec4(1.0); void main() { gl_Position = a; }"),
        F::GlobalInitializers => {
            vertex("vec4 a() { return vec4(1.0); } vec4 b = a(); void main() { gl_Position = b; }")
        }
        F::ArrayTypes => vertex("void main() { float[2] a; a[0] = 1.0; gl_Position = vec4(a[0]); }"),
        F::ImplicitToFloat => vertex("void main() { float a = 1; gl_Position = vec4(a); }"),
        F::ImplicitToUint => vertex("void main() { uint a = 1; gl_Position = vec4(float(a)); }"),
        F::UniformBlocks => vertex("uniform B { vec4 a; }; void main() { gl_Position = a; }"),
        F::InterfaceBlocks => vertex("out B { vec4 a; }; void main() { gl_Position = a = vec4(1.0); }"),
        F::InitializerLists => vertex("void main() { vec2 a = { 1.0, 2.0 }; gl_Position = a.xyxy; }"),
        F::ScalarSwizzles => vertex("void main() { float a = 1.0; gl_Position = a.xxxx; }"),
        F::VectorLength => vertex("void main() { vec2 a = vec2(1.0); gl_Position = vec4(float(a.length())); }"),
        F::DynamicConstants => vertex("uniform float a; void main() { const float b = a; gl_Position = vec4(b); }"),
        F::QualifierOrder => vertex("out flat vec4 a; void main() { gl_Position = a = vec4(1.0); }"),
        F::DepthLayouts => fragment("layout(depth_less) out float gl_FragDepth; void main() { gl_FragDepth = 0.5; }"),
        F::BuiltinsHidden => vertex(
            "float dot(vec2 a, vec2 b) { return a.x * b.y; } void main() { vec2 a = vec2(1.0); gl_Position = vec4(dot(a, a)); }",
        ),
        F::BuiltinOverloads => {
            vertex("float dot(vec2 a) { return a.x; } void main() { gl_Position = vec4(dot(vec2(1.0))); }")
        }
        F::RepeatedPrototypes => vertex(
            "float f(float a); float f(float a); float f(float a) { return a; } void main() { gl_Position = vec4(f(1.0)); }",
        ),
        F::ArraysInValues => vertex(
            "struct S { float a[2]; }; void main() { S a; a.a[0] = 1.0; S b; b = a; gl_Position = vec4(b.a[0]); }",
        ),
        F::UnsizedArrays => vertex("float a[]; void main() { a[1] = 1.0; gl_Position = vec4(a[1]); }"),
        F::BuiltinScope => vertex("float dot; void main() { dot = 1.0; gl_Position = vec4(dot); }"),
        F::NamelessStructs => vertex("struct { vec4 a; } s; void main() { s.a = vec4(1.0); gl_Position = s.a; }"),
        _ => None,
    }
}

/// Whether a text is without errors in a version, with these lines after its version line.
fn accepts(version: Version, lines: &str, stage: Stage, text: &str) -> Result<(), Vec<String>> {
    let profile = match version.profile {
        Profile::Es if version.number >= 300 => " es",
        Profile::Compatibility => " compatibility",
        Profile::Es | Profile::Core => "",
    };
    let text = format!("#version {}{profile}\n{lines}{text}", version.number);
    let diagnostics = compile_text("probe", &text, stage).diagnostics;
    let errors: Vec<String> =
        diagnostics.iter().filter(|diagnostic| diagnostic.is_error()).map(|error| error.message.clone()).collect();
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

fn versions() -> impl Iterator<Item = Version> {
    let of = |profile| move |number| Version { number, profile, span: Span::default() };
    let desktop = [110, 120, 130, 140, 150, 330, 400, 410, 420, 430, 440, 450, 460].into_iter().map(of(Profile::Core));
    desktop.chain([100, 300].into_iter().map(of(Profile::Es)))
}

/// Rows whose texts need more of a version than the feature: a type, a keyword.
fn is_readable(row: &FeatureRow, version: Version) -> bool {
    let (number, es) = (version.number, version.is_es());
    match row.feature {
        Feature::ImplicitToUint => {
            if es {
                number >= 300
            } else {
                number >= 130
            }
        }
        Feature::InterfaceBlocks | Feature::QualifierOrder => {
            if es {
                number >= 300
            } else {
                number >= 130
            }
        }
        Feature::DepthLayouts => number >= 140,
        Feature::InitializerLists | Feature::ArraysOfArrays => true,
        _ => true,
    }
}

#[test]
fn each_feature_is_there_in_its_versions_and_no_others() {
    let mut failures = Vec::new();
    for row in FEATURES {
        let Some((stage, text)) = probe(row.feature) else { continue };
        for version in versions().filter(|version| is_readable(row, *version)) {
            let accepted = accepts(version, "", stage, text);
            if accepted.is_ok() != version.has(row.feature) {
                failures.push(format!("{} in {}: {accepted:?}", row.name, version.name()));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn each_extension_brings_its_features_to_1_50() {
    let version = Version { number: 150, profile: Profile::Core, span: Span::default() };
    let mut count = 0;
    for row in FEATURES.iter().filter(|row| !version.has(row.feature) && row.since.desktop != NEVER) {
        let (Some((stage, text)), Some(name)) = (probe(row.feature), row.extensions.name()) else { continue };
        let accepted = accepts(version, &format!("#extension {name} : require\n"), stage, text);
        assert_eq!(accepted, Ok(()), "{} by {name}", row.name);
        count += 1;
    }
    assert!(count >= 6, "only {count}");
}

/// One error, with the feature's name, and not one for each use.
#[test]
fn what_is_not_supported_is_one_error() {
    let texts = [
        "#version 430\nlayout(std430) buffer B { float a[]; }; buffer C { float b[]; }; out vec4 c; \
         void main() { c = vec4(a[0] + b[1] + undeclared, a.length(), 0, 1); }",
        "#version 400\nuniform double a; dvec3 f(dvec3 b) { double c = a; return b * c; } out vec4 c; \
         void main() { dmat3 m = dmat3(1.0LF); c = vec4(f(m[0]), 1.0); }",
        "#version 420\nlayout(rgba32f) readonly uniform image2D a; out vec4 c; \
         void main() { c = imageLoad(a, ivec2(0)) + imageSize(a).xyxy; }",
    ];
    for text in texts {
        let diagnostics = compile_text("probe.frag", text, Stage::Fragment).diagnostics;
        let errors: Vec<&Diagnostic> = diagnostics.iter().filter(|diagnostic| diagnostic.is_error()).collect();
        assert!((1..=2).contains(&errors.len()), "{text}: {errors:#?}");
        assert!(errors.iter().all(|error| error.code.id == "E0001"), "{errors:#?}");
    }
}

/// The help names what has the type, and no other type is written in its place.
#[test]
fn a_constructor_of_a_later_type_names_the_version() {
    let finding = |version: &str, constructor: &str| {
        let text = format!("{version}uniform float x;\nvoid main() {{ gl_FragColor = vec4({constructor}(x)[0]); }}\n");
        let found = compile_text("a.frag", &text, Stage::Fragment).diagnostics;
        let errors: Vec<&Diagnostic> = found.iter().filter(|found| found.is_error()).collect();
        assert_eq!(errors.len(), 1, "{text}: {errors:?}");
        let help = errors[0].help.clone().unwrap_or_default();
        (errors[0].code.id, help, errors[0].fixes.len())
    };
    let (code, help, n_fixes) = finding("#version 110\n", "mat4x3");
    assert_eq!((code, help.as_str(), n_fixes), ("E0304", "`#version 120` has it", 0));
    let (code, help, n_fixes) = finding("#version 120\n", "uvec4");
    assert!(code == "E0304" && help.starts_with("`#version 130` has it") && n_fixes == 0, "{help}");
    assert_eq!(finding("", "mat4x3").0, "E0120");
    // A word that is near to a type of another version alone is near to none.
    assert_eq!(finding("#version 110\n", "mat4x2x").1, "");
    assert_eq!(finding("#version 120\n", "mat4x2x").1, "did you mean `mat4x2`?");
}
