//! Programs in GLSL with known answers.

use crate::compiler::{Compiler, Options, Source};
use crate::cpu::domain::{F64, Number};
use crate::cpu::exec::{Code, LANES, Machine, Mask};
use crate::hir::{ScalarValue, Stage};

/// Runs a fragment stage whose output is `vec4 o`, with the inputs by name and lane; gives the output in each lane.
pub(super) fn run(body: &str, input: impl Fn(&str, usize) -> f64) -> Vec<[f64; 4]> {
    let source = Source {
        name: "test.frag".into(),
        text: format!("#version 150\nout vec4 o;\n{body}\n").into(),
        stage: Stage::Fragment,
    };
    let compilation = Compiler::new(Options::default()).compile(&[source]);
    let messages: Vec<String> = compilation.diagnostics.iter().map(|d| d.message.clone()).collect();
    let program = compilation.program.unwrap_or_else(|| panic!("{messages:?}"));
    let code = Code::compile(&program, Stage::Fragment).unwrap_or_else(|errors| panic!("{errors:?}"));
    let uniforms: Vec<Vec<ScalarValue>> = (program.interface.roots.iter())
        .map(|root| root.default.as_ref().map(|value| value.scalars.clone()).unwrap_or_default())
        .collect();
    let mut machine = Machine::<F64>::new(&code, &uniforms, &[]);
    let shader = program.stage(Stage::Fragment).expect("it has the stage");
    for (id, global) in shader.globals() {
        for flat in 0..program.types.flat_len(global.ty) {
            if let Some(lanes) = machine.float_input(id, flat) {
                (0..LANES).for_each(|lane| lanes[lane] = input(&global.name, lane) + f64::from(flat));
            }
            if let Some(lanes) = machine.int_input(id, flat) {
                (0..LANES).for_each(|lane| lanes[lane] = input(&global.name, lane) as i32 as u32);
            }
        }
    }
    machine.run(Mask::ALL, Mask::NONE);
    let (o, _) = shader.globals().find(|(_, global)| global.name == "o").expect("it has the output");
    let component =
        |lane: usize, flat: u32| machine.float_output(o, flat).map_or(f64::NAN, |lanes| lanes[lane].value());
    (0..LANES).map(|lane| std::array::from_fn(|flat| component(lane, flat as u32))).collect()
}

/// The output where all lanes have the same inputs.
fn one(body: &str) -> [f64; 4] {
    run(body, |_, _| 0.0)[0]
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
