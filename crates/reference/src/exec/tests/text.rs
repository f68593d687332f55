//! Programs in GLSL with known answers.

use crate::domain::{Domain, Envelope, F64, Integer, Number};
use crate::exec::inst::{Float1, Float2, Inst};
use crate::exec::{Code, LANES, Machine, Mask};
use glisten_front::compiler::{Compiler, Options, Source};
use glisten_front::hir::{ScalarValue, Stage};
use glisten_front::link::Program;
use glisten_front::source::SourceMap;
use glisten_scene::Texture;
use glisten_scene::picture::Interval;
use std::sync::Arc;

/// Compiles a fragment stage whose output is `vec4 o`.
pub(super) fn compiled(body: &str) -> Program {
    compiled_with_sources(body).0
}

fn compiled_with_sources(body: &str) -> (Program, SourceMap) {
    let source = Source {
        name: "test.frag".into(),
        text: format!("#version 150\nout vec4 o;\n{body}\n").into(),
        stage: Stage::Fragment,
    };
    let compilation = Compiler::new(Options::default()).compile(&[source]);
    let messages: Vec<String> = compilation.diagnostics.iter().map(|d| d.message.clone()).collect();
    (compilation.program.unwrap_or_else(|| panic!("{messages:?} in {body}")), compilation.sources)
}

/// A machine for the program after a run, with inputs by name and lane (the components of a vector differ by one).
pub(super) fn ran<D: Domain>(
    program: &Program,
    textures: &[Option<Arc<Texture>>],
    input: impl Fn(&str, usize) -> f64,
) -> Machine<D> {
    let code = Code::compile(program, Stage::Fragment).unwrap_or_else(|errors| panic!("{errors:?}"));
    let uniforms: Vec<Vec<ScalarValue>> = (program.interface.roots.iter())
        .map(|root| root.default.as_ref().map(|value| value.scalars.clone()).unwrap_or_default())
        .collect();
    let mut machine = Machine::<D>::new(&code, &uniforms, textures);
    let shader = program.stage(Stage::Fragment).expect("it has the stage");
    for (id, global) in shader.globals() {
        for flat in 0..program.types.flat_len(global.ty) {
            if let Some(lanes) = machine.float_input(id, flat) {
                let value = |lane| D::Float::from_f64(input(&global.name, lane) + f64::from(flat));
                (0..LANES).for_each(|lane| lanes.set(lane, value(lane)));
            }
            if let Some(lanes) = machine.int_input(id, flat) {
                (0..LANES).for_each(|lane| lanes.set(lane, D::Int::from_bits(input(&global.name, lane) as i32 as u32)));
            }
        }
    }
    machine.limit_loops(1 << 20);
    machine.run(Mask::ALL, Mask::NONE);
    machine
}

/// The output in each lane.
pub(super) fn output<D: Domain>(program: &Program, machine: &Machine<D>) -> Vec<[D::Float; 4]> {
    let shader = program.stage(Stage::Fragment).expect("it has the stage");
    let (o, _) = shader.globals().find(|(_, global)| global.name == "o").expect("it has the output");
    let component =
        |lane: usize, flat: u32| machine.float_output(o, flat).map_or(D::Float::default(), |lanes| lanes.get(lane));
    (0..LANES).map(|lane| std::array::from_fn(|flat| component(lane, flat as u32))).collect()
}

pub(super) fn run_in<D: Domain>(body: &str, input: impl Fn(&str, usize) -> f64) -> Vec<[f64; 4]> {
    let program = compiled(body);
    let machine = ran::<D>(&program, &[], input);
    output(&program, &machine).into_iter().map(|lane| lane.map(Number::value)).collect()
}

/// The output where all lanes have the same inputs.
fn one(body: &str) -> [f64; 4] {
    run_in::<F64>(body, |_, _| 0.0)[0]
}

#[test]
fn a_default_label_takes_what_no_label_took() {
    let body = "void main() { o = vec4(0); if (0.0 >= -1.5) { switch (2) { case 0: case -1: default: o -= vec4(1); \
                o[2] = 5.0; break; case 1: o = vec4(9); } } }";
    assert_eq!(one(body), [-1.0, -1.0, 5.0, -1.0]);
}

#[test]
fn a_call_lets_the_lanes_go_on_behind_it() {
    let body = "float f(float a, inout vec2 b, out float c) { return a; } vec2 g; void main() { \
                for (int i = 0; i < 1; i++) { o.x = f(0.0, g, o[0]); for (int j = 0; j < 1; j++) o.y -= 1.0; } }";
    assert_eq!(one(body), [0.0, -1.0, 0.0, 0.0]);
}

#[test]
fn structs_and_arrays_are_values() {
    let body = "struct S { vec2 a; float b[3]; }; S s[2]; void main() { s[1].b[2] = 4.0; S t = s[1]; s[1].b[2] = 5.0; \
                t.a.y = 7.0; o = vec4(t.b[2], s[1].b[2], t.a.y, s[1] == t); }"
        .replace("s[1] == t)", "float(s[1] == t))");
    assert_eq!(one(&body), [4.0, 5.0, 7.0, 0.0]);
}

#[test]
fn matrices_multiply_and_construct_by_columns() {
    let body = "void main() { mat2x3 m = mat2x3(1, 2, 3, 4, 5, 6); vec3 c = m * vec2(1, 10); vec2 r = vec3(1, 10, 100) * m; \
                mat3 s = mat3(mat2(2.0)); mat2 p = transpose(m) * m; \
                o = vec4(c.z, r.y, s[2][2] + s[1][1], p[1][0]); }";
    assert_eq!(one(body), [63.0, 654.0, 3.0, 32.0]);
}

#[test]
fn indices_out_of_range_are_limited() {
    let body = "in float a; void main() { float t[3] = float[3](1.0, 2.0, 3.0); int i = int(a); t[i] = 9.0; \
                o = vec4(t[i], t[0], t[2], vec3(4, 5, 6)[i + 1]); }";
    let lanes = run_in::<F64>(body, |_, lane| [-5.0, 0.0, 2.0, 1e9][lane % 4]);
    assert_eq!(lanes[0], [9.0, 9.0, 3.0, 4.0]);
    assert_eq!(lanes[1], [9.0, 9.0, 3.0, 5.0]);
    assert_eq!(lanes[2], [9.0, 1.0, 9.0, 6.0]);
    assert_eq!(lanes[3], [9.0, 1.0, 9.0, 6.0]);
}

#[test]
fn an_endless_loop_ends_and_is_reported() {
    let program = compiled("void main() { o = vec4(0); while (true) { o.x += 1.0; } }");
    let machine = ran::<F64>(&program, &[], |_, _| 0.0);
    assert!(machine.budget_exceeded());
    let program = compiled("void main() { o = vec4(0); for (int i = 0; i < 70000; i++) o.x += 1.0; }");
    let machine = ran::<F64>(&program, &[], |_, _| 0.0);
    assert!(!machine.budget_exceeded());
    assert_eq!(output(&program, &machine)[5][0], 70000.0);
}

/// The loop that does not end is named, and neither one around it nor one in it.
#[test]
fn the_loop_that_does_not_end_is_named() {
    let inner = "for (int i = 0; i < 2; i++) { do { o.x += 1.0; } while (o.y < 1.0); }";
    let outer =
        "while (o.y < 1.0) { for (int i = 0; i < 30; i++) o.x += 1.0; for (int i = 0; i < 30; i++) o.x += 1.0; }";
    let called = "for (int i = 0; i < 2; i++) o.x += f(o.y);";
    for (body, named) in [(inner, "do "), (outer, "while ("), (called, "while (x")] {
        let text = format!(
            "float f(float x) {{ while (x < 1.0) {{ for (int k = 0; k < 3; k++) x *= 0.5; }} return x; }}\n\
             void main() {{ o = vec4(0); {body} }}"
        );
        let (program, sources) = compiled_with_sources(&text);
        let place = ran::<F64>(&program, &[], |_, _| 0.0).endless_loop().expect("it does not end");
        assert!(sources.snippet(place).starts_with(named), "{body}: {}", sources.snippet(place));
    }
}

#[test]
fn calls_that_no_machine_could_make_end_the_run_only_where_a_lane_reaches_them() {
    let mut functions = String::from("float f0(float x) { return exp(x); }\n");
    for number in 1..64 {
        let before = number - 1;
        functions += &format!("float f{number}(float x) {{ return f{before}(x) + f{before}(x + 1.0); }}\n");
    }
    let program =
        compiled(&format!("in float a; {functions} void main() {{ o = vec4(1); if (a > 5.0) o.x = f63(a); }}"));
    let machine = ran::<F64>(&program, &[], |_, _| 0.0);
    assert!(!machine.budget_exceeded());
    assert_eq!(output(&program, &machine)[3][0], 1.0);
    assert!(ran::<F64>(&program, &[], |_, lane| lane as f64).budget_exceeded());
    assert!(ran::<Envelope>(&program, &[], |_, lane| lane as f64).budget_exceeded());
    let short = compiled(&format!("in float a; {functions} void main() {{ o = vec4(f3(a)); }}"));
    assert!(!ran::<F64>(&short, &[], |_, _| 0.0).budget_exceeded());
}

#[test]
fn derivatives_with_control_are_of_the_own_row_or_of_the_whole_quad() {
    let header = "#extension GL_ARB_derivative_control : require\n";
    let body =
        "in float a; void main() { o = vec4(dFdxFine(a * a), dFdyFine(a * a), dFdxCoarse(a * a), fwidthFine(a)); }";
    let lanes = run_in::<F64>(&format!("\n{header}{body}"), |_, lane| [0.0, 10.0, 100.0, 110.0][lane % 4]);
    assert_eq!(lanes[0], [100.0, -10_000.0, 100.0, 110.0]);
    assert_eq!(lanes[3], [2100.0, -12_000.0, 100.0, 110.0]);
}

#[test]
fn derivatives_are_differences_in_quads_with_y_up() {
    // a = 10 x + 100 row; x and row count within the quad, the upper row first.
    let body = "in float a; void main() { o = vec4(dFdx(a * a), dFdy(a), fwidth(a), dFdx(3.0)); }";
    let lanes = run_in::<F64>(body, |_, lane| [0.0, 10.0, 100.0, 110.0][lane % 4]);
    assert_eq!(lanes[0], [100.0, -100.0, 110.0, 0.0]);
    assert_eq!(lanes[3], [2100.0, -100.0, 110.0, 0.0]);
}

#[test]
fn discarded_lanes_are_told() {
    let program = compiled("in float a; void main() { if (a > 1.0) discard; o = vec4(a); }");
    let machine = ran::<F64>(&program, &[], |_, lane| lane as f64);
    assert_eq!(machine.discarded(), Mask(!3));
}

#[test]
fn long_chains_fit_on_a_small_stack() {
    let sum = "a".to_owned() + &" + a".repeat(9_999);
    let arms: String = (0..1_000).map(|k| format!("else if (b == {k}.0) o.y = {k}.0; ")).collect();
    let body = format!("in float a, b; void main() {{ o = vec4({sum}); if (b < -1.0) o.y = -1.0; {arms} }}");
    let small = std::thread::Builder::new().stack_size(1 << 20);
    let lanes =
        small.spawn(move || run_in::<F64>(&body, |name, lane| if name == "a" { 1.0 } else { 900.0 + lane as f64 }));
    let lanes = lanes.expect("a thread").join().expect("no overflow");
    assert_eq!(lanes[7][..2], [10_000.0, 907.0]);
}

/// The least and the greatest red of each lane.
fn reds(body: &str, input: impl Fn(&str, usize) -> f64) -> Vec<(f64, f64)> {
    let program = compiled(body);
    let machine = ran::<Envelope>(&program, &[], input);
    assert!(machine.undecided().is_empty());
    output(&program, &machine).iter().map(|lane| (lane[0].low, lane[0].high)).collect()
}

#[test]
fn a_constant_of_an_undefined_operation_is_open() {
    let open = |body: &str| {
        let (low, high) = reds(body, |_, _| 0.0)[0];
        assert_eq!(
            low.is_finite() && low == high,
            !body.contains("/ 0") && !body.contains("<< 40"),
            "{body}: {low} {high}"
        );
    };
    open("const int a = 7 / 0; void main() { o = vec4(a); }");
    open("const int a = 7 / 0; const int b = a + 1; int c = b; void main() { o = vec4(c); }");
    open("void main() { const ivec2 a = ivec2(1, 2) << 40; o = vec4(a.y); }");
    open("const int a = 7 / 2 % 2; const ivec2 b = ivec2(1, 2) << 4; void main() { o = vec4(a + b.x); }");
}

#[test]
fn a_constant_half_is_rounded_either_way() {
    let of =
        |value: &str| reds(&format!("const float a = {value} + 1.0; void main() {{ o = vec4(a); }}"), |_, _| 0.0)[0];
    assert_eq!(of("round(0.5)"), (1.0, 2.0));
    assert_eq!(of("round(0.25)"), (1.0, 1.0));
    assert_eq!(of("roundEven(0.25)"), (1.0, 1.0));
}

#[test]
fn both_ways_of_an_open_branch_are_run() {
    let body =
        "in float a; void main() { float third = a / 3.0; if (third * 3.0 < 1.0) o = vec4(2); else o = vec4(3); }";
    let lanes = reds(body, |_, lane| lane as f64);
    assert_eq!(lanes[..3], [(2.0, 2.0), (2.0, 3.0), (3.0, 3.0)], "only where a / 3 * 3 is about 1");
    let lanes = reds("in float a; void main() { o = vec4(a / 3.0 * 3.0 < 1.0 ? 2.0 : 3.0); }", |_, lane| lane as f64);
    assert_eq!(lanes[..3], [(2.0, 2.0), (2.0, 3.0), (3.0, 3.0)]);
}

#[test]
fn what_a_branch_computes_stays_together_on_its_way() {
    // Joined at the end of the first branch, b - c would range from -1 to 1.
    let body = "in float a; void main() { float b = 0.0, c = 0.0; if (a / 3.0 * 3.0 < 1.0) { b = 1.0; c = 1.0; } \
                if (a / 3.0 * 3.0 < 1.0) o = vec4(b - c); else o = vec4(b - c); }";
    assert_eq!(reds(body, |_, lane| lane as f64)[1], (0.0, 0.0));
}

#[test]
fn a_loop_whose_exit_is_open_runs_on() {
    let body =
        "in float a; void main() { o = vec4(0); for (float x = 0.0; x * 3.0 < a * 3.0; x += 1.0 / 3.0) o.x += 1.0; }";
    let lanes = reds(body, |_, _| 2.0);
    assert_eq!(lanes[0], (6.0, 7.0), "1 / 3 six times may be less than 2");
}

#[test]
fn open_indices_give_the_hull_of_what_they_name() {
    let body = "in float a; void main() { float t[4] = float[4](1.0, 2.0, 4.0, 8.0); int i = int(a / 3.0 * 3.0); \
                o = vec4(t[i], 0, 0, 0); t[i] = 9.0; o.x = o.x + t[1] * 16.0; }";
    let lanes = reds(body, |_, lane| lane as f64);
    // a = 2: i is 1 or 2, by which t[1] may be 9 now.
    assert_eq!(lanes[2], (2.0 + 32.0, 4.0 + 144.0));
}

#[test]
fn quads_decide_together_where_derivatives_are_taken() {
    let body = "in float a; void main() { float b = a / 3.0 * 3.0 < 1.0 ? 0.0 : 1.0; \
                if (a / 3.0 * 3.0 < 1.0) b = 2.0; else b = 3.0; o = vec4(dFdx(b)); }";
    let lanes = reds(body, |_, lane| lane as f64);
    // Lane 0 has 2, lane 1 has 2 or 3; lanes 2 and 3 have 3, so the difference in their row is 0.
    assert_eq!(lanes[0], (0.0, 1.0));
    assert_eq!(lanes[4], (0.0, 0.0));
}

#[test]
fn a_discard_that_is_open_is_told() {
    let program =
        compiled("in float a; void main() { o = vec4(5); if (a / 3.0 * 3.0 < 1.0) { o = vec4(7); discard; } }");
    let machine = ran::<Envelope>(&program, &[], |_, lane| lane as f64);
    assert_eq!((machine.discarded(), machine.perhaps_discarded()), (Mask(1), Mask(2)));
    let lane = output(&program, &machine)[1][0];
    assert_eq!((lane.low, lane.high), (5.0, 5.0), "only what is kept shows");
}

#[test]
fn many_ways_are_merged_and_lose_nothing() {
    let body = |rounds: u32| {
        format!(
            "in float a; void main() {{ o = vec4(0); for (int i = 0; i < {rounds}; i++) {{ \
             if (a / 3.0 * 3.0 < 1.0) o.x += 1.0; if (a / 3.0 * 3.0 < 1.0) o.y -= 1.0; }} }}"
        )
    };
    for rounds in [2, 9, 300] {
        let program = compiled(&body(rounds));
        let machine = ran::<Envelope>(&program, &[], |_, lane| lane as f64);
        assert_eq!((machine.undecided(), machine.perhaps_discarded()), (Mask::NONE, Mask::NONE));
        let lane = output(&program, &machine);
        let most = f64::from(rounds);
        assert_eq!(lane[1][0].interval(), Interval { low: 0.0, high: most, may_be_nan: false });
        assert_eq!(lane[1][1].interval(), Interval { low: -most, high: 0.0, may_be_nan: false });
        assert_eq!(lane[2][0].interval(), Interval::point(0.0), "the next lane is decided");
    }
}

#[test]
fn ways_out_of_a_loop_wait_and_are_merged() {
    let run = |rounds: u32| {
        let body = format!(
            "in float a; void main() {{ o = vec4(-1); for (int i = 0; i < {rounds}; i++) {{ \
             if (a / 3.0 * 3.0 < 1.0) {{ o = vec4(i); return; }} }} }}"
        );
        let program = compiled(&body);
        let machine = ran::<Envelope>(&program, &[], |_, lane| lane as f64);
        (machine.undecided(), output(&program, &machine)[1][0].interval())
    };
    for rounds in [50, 70, 400] {
        let all = Interval { low: -1.0, high: f64::from(rounds) - 1.0, may_be_nan: false };
        assert_eq!(run(rounds), (Mask::NONE, all), "{rounds}");
    }
}

/// The way that never leaves the loop is given up, and with it its lane: the others keep their intervals.
#[test]
fn a_loop_that_may_never_end_leaves_its_lane_without_a_bound() {
    let body = "in float a; void main() { o = vec4(0); while (a / 3.0 * 3.0 < 1.0 && a > 0.5) o.x += 1.0; \
                if (a / 3.0 * 3.0 < 2.0) o.y = 1.0; }";
    let program = compiled(body);
    let machine = ran::<Envelope>(&program, &[], |_, lane| lane as f64);
    assert!(!machine.budget_exceeded(), "the value's way ends");
    let lanes = output(&program, &machine);
    assert_eq!(lanes[1][0].interval(), Interval::ALL);
    assert_eq!(lanes[2][1].interval(), Interval { low: 0.0, high: 1.0, may_be_nan: false });
    assert_eq!((machine.undecided(), machine.perhaps_discarded()), (Mask::NONE, Mask::NONE), "nothing is discarded");
}

/// A switch inside a loop, with lanes that leave by `break`, `continue` and `return`.
#[test]
fn ways_take_every_turn() {
    let body = "in float a; void main() { o = vec4(0); for (int i = 0; i < 6; i++) { \
                switch (int(a / 3.0 * 3.0)) { case 0: o.x += 1.0; break; case 1: o.y += 1.0; continue; default: o.z = 1.0; return; } \
                o.w += 1.0; } }";
    let program = compiled(body);
    let machine = ran::<Envelope>(&program, &[], |_, lane| lane as f64);
    let lanes = output(&program, &machine);
    // a = 1: each turn is 0 or 1, or the end, since each case is decided by itself; a = 2: each is 1, or the end.
    let hull = |low: f64, high: f64| Interval { low, high, may_be_nan: false };
    assert_eq!(
        lanes[1].iter().map(|n| n.interval()).collect::<Vec<_>>(),
        [hull(0.0, 6.0), hull(0.0, 6.0), hull(0.0, 1.0), hull(0.0, 6.0)]
    );
    assert_eq!(
        lanes[2].iter().map(|n| n.interval()).collect::<Vec<_>>(),
        [hull(0.0, 0.0), hull(0.0, 6.0), hull(0.0, 1.0), hull(0.0, 0.0)]
    );
}

#[test]
fn each_instruction_knows_the_text_that_it_was_made_for() {
    let body = "in float a; uniform float u; float f(float x) { return cos(x) / 3.0; } \
                void main() { float s = 2.0 - f(a) * a + sin(u); if (s > a) o = vec4(s); }";
    let (program, sources) = compiled_with_sources(body);
    let code = Code::compile(&program, Stage::Fragment).expect("it can be run");
    for section in [&code.inner.main, &code.inner.preamble] {
        assert_eq!(section.insts.len(), section.spans.len());
    }
    let texts = |wanted: fn(&Inst) -> bool| -> Vec<&str> {
        let sections = [&code.inner.preamble, &code.inner.main];
        let all = sections.into_iter().flat_map(|section| section.insts.iter().zip(&section.spans));
        all.filter(|(inst, _)| wanted(inst)).map(|(_, span)| sources.snippet(*span)).collect()
    };
    assert_eq!(texts(|inst| matches!(inst, Inst::Float1 { op: Float1::Sin, .. })), ["sin(u)"]);
    assert_eq!(texts(|inst| matches!(inst, Inst::Float1 { op: Float1::Cos, .. })), ["cos(x)"]);
    assert_eq!(texts(|inst| matches!(inst, Inst::Float2 { op: Float2::Div, .. })), ["cos(x) / 3.0"]);
    assert_eq!(texts(|inst| matches!(inst, Inst::Float2 { op: Float2::Sub, .. })), ["2.0 - f(a) * a"]);
    assert_eq!(texts(|inst| matches!(inst, Inst::Compare { .. } | Inst::Arm { .. })), ["s > a", "s > a"]);
}

#[test]
fn a_number_compared_with_itself_leaves_nothing_open() {
    let body = "in float a; void main() { float b = a / 3.0; float n = float(b < b) + 2.0 * float(b <= b) \
                + 4.0 * float(b == b) + 8.0 * float(b != b); o = vec4(n, 0, 0, 0); }";
    assert_eq!(reds(body, |_, lane| lane as f64)[5], (6.0, 6.0));
    // If it may be NaN, it may be unequal.
    let undefined =
        "in float a; void main() { float b = sqrt(a / 3.0 * 3.0 - 1.0); o = vec4(float(b == b), 0, 0, 0); }";
    let lanes = reds(undefined, |_, lane| lane as f64);
    assert_eq!((lanes[1], lanes[9]), ((0.0, 1.0), (1.0, 1.0)));
}
