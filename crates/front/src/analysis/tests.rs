//! Tests of the analysis: the normal forms of the typed program, and traversals that must not overflow the stack.

use crate::hir::{ConstructKind, ExprKind, GlobalId, LoopKind, ScalarValue, Shader, Stage, Stmt, StmtKind, TypeId};
use crate::link::Program;
use crate::{Compilation, Compiler, Options, Source};

fn compile(stage: Stage, text: &str) -> Compilation {
    let text = format!("#version 150\n{text}");
    Compiler::new(Options::default()).compile(&[Source { name: "test".into(), text: text.into(), stage }])
}

fn program(stage: Stage, text: &str) -> Program {
    let compilation = compile(stage, text);
    let messages: Vec<_> = compilation.diagnostics.iter().map(|diagnostic| diagnostic.message.clone()).collect();
    compilation.program.unwrap_or_else(|| panic!("{messages:?}"))
}

fn fragment(body: &str) -> Program {
    program(Stage::Fragment, &format!("out vec4 color; uniform vec4 u; uniform mat3 m;\nvoid main() {{ {body} }}"))
}

fn shader(program: &Program) -> &Shader {
    program.stages.first().expect("one stage was compiled")
}

/// The statements of `main`.
fn main_body(shader: &Shader) -> &[Stmt] {
    let main = shader.main.expect("the text has a main");
    shader.function(main).body.as_deref().expect("the text defines main")
}

/// The initializers of the locals of `main`, in order.
fn initializers(shader: &Shader) -> Vec<&ExprKind> {
    let initializer = |stmt: &Stmt| match stmt.kind {
        StmtKind::Local(_, initializer) => initializer,
        _ => None,
    };
    main_body(shader).iter().filter_map(initializer).map(|id| &shader.expr(id).kind).collect()
}

fn global<'s>(shader: &'s Shader, name: &str) -> (GlobalId, &'s crate::hir::Global) {
    shader.globals().find(|(_, global)| global.name == name).unwrap_or_else(|| panic!("no global {name}"))
}

#[test]
fn constructors_take_their_normal_forms() {
    let program = fragment(
        "vec3 a = vec3(1); vec4 b = vec4(a, 1); mat2 c = mat2(2); mat4 d = mat4(m); ivec2 e = ivec2(u);
         float f[2] = float[](1, 2); color = b + c[0].x + d[0] + e.x + f[1];",
    );
    let kinds: Vec<_> = initializers(shader(&program))
        .into_iter()
        .map(|kind| match kind {
            ExprKind::Construct(kind, _) => *kind,
            other => panic!("{other:?} is no constructor"),
        })
        .collect();
    use ConstructKind::{Array, Compose, Diagonal, Resize, Splat};
    assert_eq!(kinds, [Splat, Compose, Diagonal, Resize, Compose, Array]);
}

#[test]
fn implicit_conversions_are_explicit() {
    let program = fragment("float a = 1; vec2 b = ivec2(1, 2); float c = u.x + 1; color = vec4(a, b, c);");
    let shader = shader(&program);
    let kinds = initializers(shader);
    assert!(matches!(kinds.as_slice(), [ExprKind::Convert(_), ExprKind::Convert(_), ExprKind::Binary(_, _, right)]
        if matches!(shader.expr(*right).kind, ExprKind::Convert(_)) && shader.expr(*right).ty == TypeId::FLOAT));
}

#[test]
fn length_is_a_literal_and_constants_have_values() {
    let program = program(
        Stage::Fragment,
        "const float w[] = float[](1.0, 2.0, 4.0); out vec4 color; void main() { int n = w.length(); color = vec4(n); }",
    );
    let shader = shader(&program);
    assert!(matches!(initializers(shader).as_slice(), [ExprKind::Literal(ScalarValue::Int(3))]));
    let value = global(shader, "w").1.value.as_ref().expect("a constant has a value");
    assert_eq!(value.scalars, [1.0, 2.0, 4.0].map(ScalarValue::Float));
}

#[test]
fn a_for_keeps_its_variable_in_a_block() {
    let program = fragment("for (int i = 0; i < 3; ++i) color += u; while (false) color = u;");
    let body = main_body(shader(&program));
    let StmtKind::Block(outer) = &body.first().expect("two loops").kind else { panic!("no block") };
    assert!(matches!(
        outer.as_slice(),
        [Stmt { kind: StmtKind::Local(..), .. }, Stmt { kind: StmtKind::Loop { kind: LoopKind::For, .. }, .. }]
    ));
    assert!(matches!(body.get(1).map(|stmt| &stmt.kind), Some(StmtKind::Loop { kind: LoopKind::While, .. })));
}

#[test]
fn static_use_follows_calls_and_initializers() {
    let program = program(
        Stage::Vertex,
        "uniform vec4 a, b, c, d; vec4 e = a; out vec4 f, g, h;
         void used() { f = e; } void unused() { g = b; }
         void main() { used(); gl_Position = c; h; }",
    );
    let shader = shader(&program);
    let state = |name| {
        let global = global(shader, name).1;
        (global.used, global.written)
    };
    let names = ["a", "b", "c", "d", "e", "f", "g", "h", "gl_Position"];
    let expected = [
        (true, false),
        (false, false),
        (true, false),
        (false, false),
        (true, false),
        (true, true),
        (false, false),
        (true, false),
        (true, true),
    ];
    assert_eq!(names.map(state), expected);
    let reachable: Vec<_> = shader.functions.iter().map(|function| function.reachable).collect();
    assert_eq!(reachable, [true, false, true]);
}

#[test]
fn arrays_take_the_size_of_their_use() {
    let program = program(
        Stage::Vertex,
        "uniform vec4 a[]; float b[]; void main() { float c[]; c[1] = 1.0; b[4] = c[0]; gl_Position = a[2] * b[1]; }",
    );
    let shader = shader(&program);
    assert_eq!(program.types.flat_len(global(shader, "a").1.ty), 12);
    assert_eq!(program.types.flat_len(global(shader, "b").1.ty), 5);
    let main = shader.function(shader.main.expect("main"));
    assert_eq!(main.locals.first().map(|local| program.types.flat_len(local.ty)), Some(2));
    let unsized_left = shader.exprs.iter().any(|expr| program.types.name(expr.ty).ends_with("[]"));
    assert!(!unsized_left, "an expression kept the type without a size");
}

/// Runs on a thread with as little stack as a browser provides.
fn on_small_stack(run: impl FnOnce() + Send + 'static) {
    let thread = std::thread::Builder::new().stack_size(1 << 20).spawn(run).expect("a thread starts");
    thread.join().expect("no overflow and no panic");
}

#[test]
fn long_chains_work_on_a_small_stack() {
    on_small_stack(|| {
        let sum = vec!["u.x"; 10_000].join(" + ");
        assert!(
            compile(Stage::Fragment, &format!("out vec4 c; uniform vec4 u; void main() {{ c = vec4({sum}); }}"))
                .program
                .is_some()
        );
        let arms = "if (u.x > 1.0) c = u;\nelse ".repeat(1_000);
        assert!(
            compile(Stage::Fragment, &format!("out vec4 c; uniform vec4 u; void main() {{ {arms} c = u; }}"))
                .program
                .is_some()
        );
        let commas = vec!["c += u"; 5_000].join(", ");
        assert!(
            compile(Stage::Fragment, &format!("out vec4 c; uniform vec4 u; void main() {{ {commas}; }}"))
                .program
                .is_some()
        );
    });
}

#[test]
fn deep_nesting_works_up_to_the_limit_on_a_small_stack() {
    on_small_stack(|| {
        let depth = 200;
        for (open, close) in [("(", ")"), ("-(", ")"), ("vec4(", ")"), ("abs(", ")"), ("u[int(", ".x)] * u")] {
            let text = format!("{}u{}", open.repeat(depth), close.repeat(depth));
            let compilation =
                compile(Stage::Fragment, &format!("out vec4 c; uniform vec4 u; void main() {{ c = {text}; }}"));
            let first = compilation.diagnostics.iter().next().map(|diagnostic| diagnostic.code.id);
            assert!(matches!(first, None | Some("E0003")), "{open}: {first:?}");
        }
        let blocks = format!("{}c = vec4(1.0);{}", "if (true) {".repeat(depth), "}".repeat(depth));
        let compilation = compile(Stage::Fragment, &format!("out vec4 c; void main() {{ {blocks} }}"));
        let first = compilation.diagnostics.iter().next().map(|diagnostic| diagnostic.code.id);
        assert!(matches!(first, None | Some("E0003")), "blocks: {first:?}");
    });
}

/// Each struct contains the one before it twice: the number of members doubles with each line.
#[test]
fn doubling_structs_end_in_an_error_at_once() {
    let mut text = String::from("struct S0 { float x; };\n");
    for level in 1..60 {
        text.push_str(&format!("struct S{level} {{ S{} a, b; }};\n", level - 1));
    }
    let compilation =
        compile(Stage::Vertex, &format!("{text} uniform S59 s; void main() {{ gl_Position = vec4(0.0); }}"));
    let codes: Vec<_> = compilation.diagnostics.iter().map(|diagnostic| diagnostic.code.id).collect();
    assert_eq!(codes, ["E0422"]);
}

#[test]
fn the_invariant_pragma_is_not_for_fragments() {
    let text = "#pragma STDGL invariant(all)\nout vec4 c; void main() { c = vec4(0.0); }";
    let codes: Vec<_> = compile(Stage::Fragment, text).diagnostics.iter().map(|found| found.code.id).collect();
    assert_eq!(codes, ["E0616"]);
    let program = program(Stage::Vertex, text);
    assert!(global(shader(&program), "c").1.invariant);
}

#[test]
fn overloads_are_limited() {
    let mut text = String::new();
    for index in 0..1_030 {
        text.push_str(&format!("struct T{index} {{ float x; }}; void f(T{index} x) {{}}\n"));
    }
    let compilation = compile(Stage::Vertex, &format!("{text} void main() {{ gl_Position = vec4(0.0); }}"));
    assert!(compilation.diagnostics.iter().all(|found| found.code.id == "E0513"));
    assert_eq!(compilation.diagnostics.len(), 6);
}

/// A version or an extension that has a function in another stage alone is no remedy.
#[test]
fn a_function_of_other_stages_is_told_by_them() {
    for (call, stages) in [("EndPrimitive();", "geometry"), ("float x = dFdxFine(1.0);", "fragment")] {
        let done = compile(Stage::Vertex, &format!("void main() {{ {call} gl_Position = vec4(0.0); }}"));
        let found = done.diagnostics.iter().find(|found| found.code.id == "E0308").expect("it is not there");
        assert!(found.message.ends_with("does not exist in a vertex shader"), "{}", found.message);
        assert_eq!(found.primary.message, format!("only in {stages} shaders"));
        assert_eq!(found.help, None);
    }
}

#[test]
fn a_macro_without_its_arguments_is_known_as_one() {
    let text = "#define SAT(x) clamp(x, 0.0, 1.0)\nout vec4 c; void main() { c = vec4(1.0) * SAT; }";
    let done = compile(Stage::Fragment, text);
    let found = done.diagnostics.iter().next().expect("it is no value");
    assert_eq!(found.code.id, "E0301");
    assert_eq!(found.help.as_deref(), Some("`SAT` is a macro with parameters: write `SAT(..)` with its arguments"));
}
