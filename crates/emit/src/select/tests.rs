//! Which functions are made, and what is refused.

use super::{Choice, select};
use glisten_front::hir::{Shader, Types};
use glisten_front::{Compiler, Options, Source, Stage};

/// The stage after the selection, or the message that refuses it, and how many functions it had before.
fn selected(stage: Stage, text: &str) -> (Result<Shader, String>, usize) {
    selected_by(Choice::Samplers, stage, text)
}

fn selected_by(choice: Choice, stage: Stage, text: &str) -> (Result<Shader, String>, usize) {
    let source = Source { name: "shader".into(), text: format!("#version 430\n{text}").into(), stage };
    let compilation = Compiler::new(Options::default()).compile(&[source]);
    let messages: Vec<_> = compilation.diagnostics.iter().map(|found| found.message.clone()).collect();
    let program = compilation.program.unwrap_or_else(|| panic!("{messages:?}"));
    let shader = program.stage(stage).expect("the stage is in the program");
    let functions = shader.functions.len();
    let after = select(&program.types, shader, choice).map(std::borrow::Cow::into_owned);
    if let Ok(after) = &after {
        // What remains is constant if nothing had to be made.
        assert!(after.functions.len() == functions || remaining(&program.types, after) == 0, "{text}");
        assert_operands_precede(after);
    }
    (after.map_err(|diagnostic| diagnostic.message.clone()), functions)
}

/// How many samplers and blocks are chosen by what is no literal, in functions that `main` reaches.
fn remaining(types: &Types, shader: &Shader) -> usize {
    let mut count = 0;
    for id in shader.main.map_or(Vec::new(), |main| shader.callees_first(main)) {
        let body = shader.function(id).body.as_deref().unwrap_or(&[]);
        shader.visit_body(body, &mut |id| count += usize::from(super::may_choose(types, shader, shader.expr(id))));
    }
    count
}

fn assert_operands_precede(shader: &Shader) {
    for (index, expr) in shader.exprs.iter().enumerate() {
        assert!(expr.kind.children().iter().all(|child| child.index() < index), "{expr:?}");
    }
}

fn made(text: &str) -> Vec<String> {
    let (after, before) = selected(Stage::Fragment, text);
    let after = after.expect("nothing is refused");
    after.functions.iter().skip(before).map(|function| function.name.clone()).collect()
}

const HEAD: &str = "uniform sampler2D s[3]; uniform int i; uniform uint u; in vec2 p; out vec4 c;\n";

#[test]
fn equal_lookups_share_a_function_and_others_do_not() {
    let text = "void main() { c = texture(s[i], p) + texture(s[i + 1], p.yx) + textureLod(s[i], p, 0.0); }";
    assert_eq!(made(&format!("{HEAD}{text}")), ["texture_of_s", "textureLod_of_s"]);
    let text = "void main() { c = textureOffset(s[i], p, ivec2(1)) + textureOffset(s[i], p, ivec2(1, 1)) \
                + textureOffset(s[i], p, ivec2(2)); }";
    assert_eq!(made(&format!("{HEAD}{text}")), ["textureOffset_of_s", "textureOffset_of_s_2"]);
    let text = "void main() { c = texture(s[u], p) + texture(s[i], p); }";
    assert_eq!(made(&format!("{HEAD}{text}")), ["texture_of_s", "texture_of_s_2"]);
}

#[test]
fn other_members_of_a_struct_with_samplers_are_chosen_too_in_texts() {
    let text = "struct M { vec4 tint; sampler2D map; }; uniform M m[2]; uniform int i; in vec2 p; out vec4 c;\n\
                void main() { c = texture(m[i].map, p) * m[i].tint.x; }";
    let (after, before) = selected_by(Choice::Structs, Stage::Fragment, text);
    let after = after.expect("nothing is refused");
    let mut names: Vec<&str> = after.functions.iter().skip(before).map(|function| &*function.name).collect();
    names.sort_unstable();
    assert_eq!(names, ["part_of_m", "texture_of_m"]);
}

#[test]
fn constant_indices_make_no_function() {
    let text =
        "const int last = 2; void main() { const int first = 0; c = texture(s[last], p) + texture(s[first], p); }";
    assert!(made(&format!("{HEAD}{text}")).is_empty());
}

#[test]
fn functions_are_copied_once_for_each_array() {
    let text = "vec4 f(sampler2D a) { return texture(a, p); } vec4 g(sampler2D a) { return f(a) * 2.0; }\n\
                void main() { c = g(s[i]) + g(s[i + 1]) + f(s[0]) + f(s[i]); }";
    assert_eq!(made(&format!("{HEAD}{text}")), ["g_2", "f_2", "texture_of_s"]);
}

#[test]
fn a_choice_inside_of_a_choice_is_made_too() {
    let text = "void main() { c = texture(s[int(texture(s[i], p).r)], p); }";
    assert_eq!(made(&format!("{HEAD}{text}")), ["texture_of_s"]);
    let text = "uniform B { int next; vec4 v[2]; } b[2]; void main() { c = b[b[i].next].v[b[i].next]; }";
    assert_eq!(made(&format!("{HEAD}{text}")), ["part_of_b", "part_of_b_2"]);
}

#[test]
fn names_differ_from_those_of_the_shader() {
    let text =
        "vec4 texture_of_s() { return c; } void main() { vec4 p_2 = texture(s[i], p); c = p_2 + texture_of_s(); }";
    assert_eq!(made(&format!("{HEAD}{text}")), ["texture_of_s_2"]);
}

#[test]
fn a_changed_copy_of_what_is_chosen_is_refused() {
    let text = "struct M { vec4 tint; sampler2D map; }; uniform M m[2];\n\
                vec4 f(M a) { a.tint = vec4(1.0); return a.tint * texture(a.map, p); } void main() { c = f(m[i]); }";
    let (after, _) = selected(Stage::Fragment, &format!("{HEAD}{text}"));
    assert!(after.is_err_and(|message| message.contains("`f` changes `a`")));
}

#[test]
fn what_would_take_too_much_is_refused() {
    let mut text = String::from("uniform sampler2D s[1000]; uniform int i; in vec2 p; out vec4 c;\n");
    text += "void main() { c = vec4(0.0);\n";
    for level in 0..160 {
        text += &format!("c += textureOffset(s[i], p, ivec2({}, {})) + c;\n", level % 16 - 8, level / 16 - 8);
    }
    text += "}";
    let (after, _) = selected(Stage::Fragment, &text);
    assert!(after.is_err_and(|message| message.contains("too much")));
}
