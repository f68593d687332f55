//! Round trips: naga reads the text of every fixture as the module that it came from.

use super::{Notes, Style, write};
use crate::target::{Conventions, Target};
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_front::{Compiler, Options, Source};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The text that naga reads, written again in a style: names and the places of values are then the writer's.
fn read(text: &str, style: Style) -> String {
    let module = naga::front::wgsl::parse_str(text);
    plain(module.unwrap_or_else(|error| panic!("{}", error.emit_to_string(text))), style)
}

/// The text of a module without its names.
fn plain(mut module: naga::Module, style: Style) -> String {
    unname(&mut module);
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).expect("valid");
    flat(&write(&module, &info, style, &Notes::default()).expect("written").0)
}

/// Gives everything in a module a name of its own: which names it has, and which values, is no part of what it does.
fn unname(module: &mut naga::Module) {
    let types: Vec<_> = module.types.iter().map(|(handle, ty)| (handle, ty.clone())).collect();
    for (handle, mut ty) in types {
        if let naga::TypeInner::Struct { members, .. } = &mut ty.inner {
            ty.name = Some(format!("type_{}", handle.index()));
            let rename = |(index, member): (usize, &mut naga::StructMember)| {
                member.name = Some(format!("member_{}_{index}", handle.index()));
            };
            members.iter_mut().enumerate().for_each(rename);
            module.types.replace(handle, ty);
        }
    }
    let named = |kind: &str, index: usize| Some(format!("{kind}_{index}"));
    module.constants.iter_mut().for_each(|(handle, constant)| constant.name = named("constant", handle.index()));
    module.global_variables.iter_mut().for_each(|(handle, global)| global.name = named("global", handle.index()));
    let unname = |function: &mut naga::Function| {
        function.named_expressions.clear();
        let arguments = function.arguments.iter_mut().enumerate();
        arguments.for_each(|(index, argument)| argument.name = named("argument", index));
        function.local_variables.iter_mut().for_each(|(handle, local)| local.name = named("local", handle.index()));
    };
    for (handle, function) in module.functions.iter_mut() {
        function.name = named("function", handle.index());
        unname(function);
    }
    module.entry_points.iter_mut().for_each(|entry| unname(&mut entry.function));
}

/// Without the blocks that naga's front end puts around `for`.
fn flat(text: &str) -> String {
    let mut lines: Vec<&str> = Vec::new();
    // For each open brace, whether it is a bare block.
    let mut open = Vec::new();
    for line in text.lines().map(str::trim) {
        if line == "{" {
            open.push(true);
            continue;
        }
        if line.starts_with('}') && open.pop() == Some(true) {
            continue;
        }
        if line.ends_with('{') {
            open.push(false);
        }
        if !line.is_empty() {
            lines.push(line);
        }
    }
    // Where a line breaks depends on the lengths of names.
    lines.join("\n").replace("\nreturn;\n}\n", "\n}\n").replace("(\n", "(").replace(",\n)", ")").replace(",\n", ", ")
}

/// Two pairs of parentheses around one thing.
fn doubled(text: &str) -> Option<&str> {
    let starts = text.match_indices("((").map(|(at, _)| at);
    let mut found = starts.filter(|&at| {
        let inner = closing(text, at + 1);
        inner.is_some() && closing(text, at) == inner.map(|inner| inner + 1)
    });
    found.next().map(|at| text[at..].lines().next().unwrap_or_default())
}

/// The place of the parenthesis that closes the one at `open`.
fn closing(text: &str, open: usize) -> Option<usize> {
    let mut depth = 0;
    for (at, byte) in text.bytes().enumerate().skip(open) {
        match byte {
            b'(' => depth += 1,
            b')' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

fn sources(folder: &Path, found: &mut BTreeMap<PathBuf, Vec<PathBuf>>) {
    for entry in std::fs::read_dir(folder).expect("the fixtures are there") {
        let path = entry.expect("a folder entry").path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "vert" || extension == "frag") {
            found.entry(path.with_extension("")).or_default().push(path);
        }
    }
}

/// All programs of the fixtures that compile, with their names.
fn programs() -> Vec<(String, Program)> {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
    let mut files = BTreeMap::new();
    ["programs", "lower", "valid"].iter().for_each(|folder| sources(&fixtures.join(folder), &mut files));
    let mut programs = Vec::new();
    for (name, mut paths) in files {
        paths.sort_by_key(|path| path.extension() == Some("frag".as_ref()));
        let source = |path: &PathBuf| Source {
            name: path.display().to_string(),
            text: String::from_utf8_lossy(&std::fs::read(path).expect("readable")).into(),
            stage: if path.extension() == Some("vert".as_ref()) { Stage::Vertex } else { Stage::Fragment },
        };
        let compilation = Compiler::new(Options::default()).compile(&paths.iter().map(source).collect::<Vec<_>>());
        programs.extend(compilation.program.map(|program| (name.display().to_string(), program)));
    }
    assert!(programs.len() > 40, "only {} programs", programs.len());
    programs
}

/// The text that naga writes.
fn by_naga(module: &naga::Module) -> String {
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(module).expect("valid");
    naga::back::wgsl::write_string(module, &info, naga::back::wgsl::WriterFlags::empty()).expect("naga writes it")
}

/// A stage of a fixture: its name, its text in a style, and the module that it is made from.
struct Stages {
    name: String,
    text: String,
    module: naga::Module,
}

/// The stages of the fixtures in a style.
fn stages(style: Style) -> Vec<Stages> {
    let mut texts = Vec::new();
    for (name, program) in programs() {
        for stage in [Stage::Vertex, Stage::Fragment] {
            if program.stage(stage).is_none_or(|shader| shader.main.is_none()) {
                continue;
            }
            let lowered = crate::lower::lower(&program, stage, Target::Wgsl, &Conventions::default());
            let Ok(module) = lowered else { continue };
            let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).expect("valid");
            let text = write(&module, &info, style, &Notes::default()).expect("written").0;
            texts.push(Stages { name: format!("{name}, {}", stage.name()), text, module });
        }
    }
    texts
}

/// The text with names that do not depend on who chose them: each function's names by their order.
fn anonymous(text: &str) -> String {
    let mut result = String::new();
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    for line in text.lines() {
        if line.starts_with("fn ") || line.starts_with("struct ") {
            numbers.clear();
        }
        let mut word = String::new();
        for c in line.chars().chain([' ']) {
            if c.is_ascii_alphanumeric() || c == '_' {
                word.push(c);
                continue;
            }
            if !word.is_empty() {
                if word.starts_with(|first: char| first.is_ascii_digit()) {
                    result.push_str(&word);
                } else {
                    let next = numbers.len();
                    result.push_str(&format!("n{}", numbers.entry(word.clone()).or_insert(next)));
                }
                word.clear();
            }
            result.push(c);
        }
        result.push('\n');
    }
    result
}

/// Fixtures of which naga's front end makes another module from any text: it folds constants, and writes `&&` and `||` as
/// branches.
const FOLDED: [&str; 5] =
    ["lower/aggregates", "lower/expressions", "lower/matrices", "lower/statements", "types/everything"];

#[test]
fn naga_reads_the_same_module() {
    let mut wrong = Vec::new();
    for Stages { name, text, module } in stages(Style::Same) {
        let after = anonymous(&read(&text, Style::Same));
        let before = anonymous(&plain(module.clone(), Style::Same));
        // naga's front end folds constants, so that only what it reads of naga's own text may be equal.
        let equal = before == after || anonymous(&read(&by_naga(&module), Style::Same)) == after;
        // naga's writer has another function for `inverse`.
        let inverts = text.contains("fn inverse_");
        if !equal && !inverts && !FOLDED.iter().any(|folded| name.contains(folded)) {
            let differs = before.lines().zip(after.lines()).find(|(before, after)| before != after);
            let (before, after) = differs.unwrap_or(("", "other lines"));
            wrong.push(format!("{name}:\n  {before}\n  {after}"));
        }
    }
    assert!(wrong.is_empty(), "{} differ: {}", wrong.len(), wrong.join("\n"));
}

#[test]
fn declarations_that_moved_leave_a_valid_module() {
    for Stages { name, text, .. } in stages(Style::Full) {
        read(&text, Style::Full);
        assert!(!text.lines().any(|line| line.ends_with(' ')), "{name}: a trailing blank in\n{text}");
        assert_eq!(doubled(&text), None, "{name}: doubled parentheses");
    }
}

/// The WGSL of a fragment shader of GLSL 3.30, from its functions on.
fn translated(text: &str) -> String {
    let text = format!("#version 330\n{text}");
    let source = Source { name: "a.frag".into(), text: text.into(), stage: Stage::Fragment };
    let compilation = Compiler::new(Options::default()).compile(&[source]);
    let program = compilation.program.expect("a program");
    let sources = Some(&compilation.sources);
    let conventions = Conventions::default();
    let emitted = crate::emit_traced(&program, Stage::Fragment, Target::Wgsl, &conventions, sources);
    let crate::Emitted::Text(text) = emitted.expect("emitted").emitted else { panic!("WGSL is text") };
    read(&text, Style::Full);
    let start = ["\n//", "\nfn ", "\n@fragment"].iter().filter_map(|word| Some(text.get(1..)?.find(word)? + 1)).min();
    text.get(start.unwrap_or(0)..).unwrap_or_default().trim().to_owned()
}

/// The statements of `main`.
fn body_of(text: &str) -> String {
    let text = translated(&format!("in vec4 i; uniform float u; uniform sampler2D s; out vec4 c;\n{text}"));
    let start = text.find("@fragment").and_then(|at| Some(at + text.get(at..)?.find("{\n")? + 2)).expect("a head");
    text.get(start..).and_then(|text| text.strip_suffix('}')).expect("a body").replace("    ", "")
}

#[test]
fn locals_keep_their_names() {
    let called =
        "float f(float x) { return x * u; }\nvoid main() { float F = f(i.x); float G = F; c = vec4(F, G, F, F); }";
    assert_eq!(body_of(called), "let F = f(i.x);\nlet G = F;\nreturn vec4(F, G, F, F);\n");
    let looked_up = "void main() { vec4 texel = texture(s, i.xy); c = texel * texel.a; }";
    assert_eq!(body_of(looked_up), "let texel = textureSample(s, s_sampler, i.xy);\nreturn texel * texel.w;\n");
    let twice = "void main() { c = i; if (u > 0.0) { float a = u; c *= a * a; } else { float a = u + 1.0; c += a; } }";
    assert_eq!(body_of(twice).matches("let a = ").count(), 2, "{}", body_of(twice));
}

#[test]
fn variables_that_never_change_are_let() {
    let text = "void main() { float power = 50.0; vec3 zero = vec3(0.0); vec3 n; n = i.xyz * power; c = vec4(n + zero, 1.0); }";
    let expected = "let power = 50.0;\nlet zero = vec3(0.0);\nlet n = i.xyz * power;\nreturn vec4(n + zero, 1.0);\n";
    assert_eq!(body_of(text), expected);
}

/// naga's constants of SPIR-V would have a vector among the components of a vector.
#[test]
fn constants_in_constant_vectors_are_taken_apart() {
    let text = "const vec2 g = vec2(1.0, 2.0);\nvoid main() { float one = 1.0; vec4 v = vec4(g, 0.5, one); c = v * i + vec4(g, i.xy); }";
    let text = body_of(text);
    assert!(text.contains("let v = vec4(g.x, g.y, 0.5, one);") && text.contains("vec4(g, i.xy)"), "{text}");
}

#[test]
fn what_a_store_would_overtake_has_a_name() {
    let swap = "void main() { vec2 p = i.xy; p *= u; float t = p.x; p.x = p.y; p.y = t; c = p.xyxy; }";
    let text = body_of(swap);
    assert!(text.contains("let t = p.x;\np.x = p.y;\np.y = t;\n"), "{text}");
    let angle = "void main() { vec2 p = i.xy; p.x += u; c = vec4(atan(p.y, p.x)); }";
    assert!(body_of(angle).contains("atan2(p.y, p.x)"), "{}", body_of(angle));
    let step = "void main() { int k = int(i.x); k += 2; float a = float(k++) * u; c = vec4(a, float(k), 0.0, 0.0); }";
    let text = body_of(step);
    assert!(text.contains("let k_before = k;\nk++;\nlet a = f32(k_before) * uniforms.u;\n"), "{text}");
}

/// WGSL has `++` for scalars alone.
#[test]
fn a_vector_has_no_steps() {
    let text = body_of("void main() { ivec2 k = ivec2(i.xy); k--; k.x++; c = vec4(k, k); }");
    assert!(!text.contains("k--") && text.contains("k.x++;"), "{text}");
}

#[test]
fn calls_with_effects_keep_their_order() {
    let text = "float n = 0.0; float next() { n += 1.0; return n; }\nvoid main() { float a = n; c = vec4(next() - next(), a, n, next()); }";
    let text = body_of(text);
    let read = text.find("= n;").expect("`n` is read before the calls");
    assert!(read < text.find("next()").expect("a call"), "{text}");
    assert_eq!(text.matches("next()").count(), 3, "{text}");
}

/// Asserts that a text has both parts, the first one first.
fn assert_in_order(text: &str, parts: [&str; 2]) {
    let [first, second] = parts.map(|part| text.find(part).unwrap_or_else(|| panic!("no `{part}` in {text}")));
    assert!(first < second, "{parts:?} in {text}");
}

#[test]
fn a_variable_keeps_its_value_between_iterations() {
    let kept = "void main() { int k = 0; float s = 0.0; while (s < u) { k++; s += float(k); } c = vec4(s); }";
    let text = body_of(kept);
    assert_in_order(&text, ["var k: i32 = 0;", "while s < uniforms.u {"]);
    let inside = "void main() { c = i; for (int j = 0; j < 4; j++) { vec2 k; k.x = i.x; k.y = c.x; c.xy += k; } }";
    let text = body_of(inside);
    assert_in_order(&text, ["for (var j = 0;", "var k: vec2<f32>;"]);
    assert!(text.contains("c = vec4(c.xy + k, c.zw);"), "{text}");
}

#[test]
fn comments_stay_where_they_belong() {
    let text = "void main() {\n    // first\n    float a = u; // behind\n\n    /* a block */\n    c = i * a;\n    \
                if (a > 0.5) { // head\n        // inner\n        c += a;\n        // end\n    } else {\n        \
                // other\n        c -= a;\n    }\n    for (int k = 0; k < 3; k++) { /* loop */ c *= a; }\n    \
                switch (int(a)) {\n    case 1: // one\n        c += 1.0;\n        break;\n    default:\n        \
                // any\n        c += 2.0;\n    }\n    // last\n}\n";
    let text = body_of(text);
    let expected = "// first\nlet a = uniforms.u;  // behind\n\n/* a block */\nvar c: vec4<f32> = i * a;\n\
                    if a > 0.5 {  // head\n// inner\nc += a;\n// end\n} else {\n// other\nc -= a;\n}\n";
    assert!(text.starts_with(expected), "{text}");
    for comment in ["/* loop */", "// one", "// any\nc += 2.0;", "// last\n"] {
        assert!(text.contains(comment), "{comment} in\n{text}");
    }
}

#[test]
fn comments_of_what_was_left_out_are_left_out() {
    let text = "void main() {\n    c = i;\n    return;\n    // never\n    c = vec4(u);\n}\n";
    assert!(!body_of(text).contains("never"), "{}", body_of(text));
}

#[test]
fn long_lines_are_broken() {
    let call = "void main() { c = texture(s, i.xy * i.zw + i.wz * i.yx + i.xx * i.yy + i.zz * i.ww) * (i.x + i.y) * \
                vec4(i.x, i.y, i.z + i.w * i.x, i.y * i.z); }";
    let text = translated(&format!("in vec4 i; uniform sampler2D s; out vec4 c;\n{call}"));
    assert!(text.lines().all(|line| line.len() <= super::print::WIDTH), "{text}");
}

#[test]
fn parentheses_stay_where_they_mean_something() {
    for (glsl, expected) in [
        ("c.x = (a + b) * d", "(a + b) * d"),
        ("c.x = a - (b - d)", "a - (b - d)"),
        ("c.x = (a - b) - d", "a - b - d"),
        ("c.x = -(-a)", "-(-a)"),
        ("c.x = float(!(a < b))", "!(a < b)"),
        ("c.x = float(a < b && d > a)", "a < b && d > a"),
        ("c.x = float(((int(a) + 1) << 2u) & 3)", "((i32(a) + 1) << 2u) & 3"),
        ("c.xy = (i.xy + a).yx", "(i.xy + a).yx"),
    ] {
        let text = body_of(&format!("void main() {{ float a = i.x; float b = i.y; float d = i.z; c = i; {glsl}; }}"));
        assert!(text.contains(expected), "{expected} in\n{text}");
    }
}

/// naga's SPIR-V writer composes a constant of too few constituents of a `let` whose value is the name of a constant.
#[test]
fn a_local_that_is_a_constant_is_a_var() {
    let text =
        "const vec3 K = vec3(1.0, 2.0, 3.0);\nvoid main() { vec3 k = K; c = i + vec4(k, 0.0) + vec4(K, 1.0) + u; }";
    let body = body_of(text);
    assert!(body.contains("var k: vec3<f32> = K;\n"), "{body}");
}
