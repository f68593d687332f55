//! The CPU reference's executor on every valid fixture and program: it accepts all of them, and a tile of unusual
//! inputs runs in every domain without a panic.

use crate::support::{NextTo, Shader, compiler, shaders_under};
use glisten_front::Source;
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_reference::domain::{Domain, Envelope, F32, F64, Integer, Number};
use glisten_reference::exec::{Code, LANES, Machine, Mask};

fn program(shader: &Shader) -> Option<Program> {
    let source = Source { name: shader.name.clone(), text: shader.text.as_str().into(), stage: shader.stage };
    compiler().with_includes(NextTo).compile(&[source]).program
}

/// Fills every input with numbers that are likely to cause trouble, and runs.
fn run<D: Domain>(code: &Code, program: &Program, stage: Stage) {
    const ODD: [f64; 8] = [0.0, 1.0, -1.5, 1e30, -1e-40, f64::INFINITY, f64::NAN, 3.25];
    let mut machine = Machine::<D>::new(code, &[], &[]);
    machine.limit_loops(1 << 14);
    for (id, global) in program.stage(stage).into_iter().flat_map(|shader| shader.globals()) {
        for flat in 0..program.types.flat_len(global.ty).min(64) {
            if let Some(lanes) = machine.float_input(id, flat) {
                (0..LANES)
                    .for_each(|lane| lanes.set(lane, D::Float::from_f64(ODD[(lane + flat as usize) % ODD.len()])));
            }
            if let Some(lanes) = machine.int_input(id, flat) {
                (0..LANES).for_each(|lane| lanes.set(lane, D::Int::from_bits((lane as u32).wrapping_sub(5))));
            }
        }
    }
    machine.run(Mask::first(60), Mask(0xf << 60));
}

/// Whether the message is about something that only other parts of glisten provide.
fn may_be_refused(message: &str) -> bool {
    message.contains("`main`")
}

#[test]
fn every_valid_fixture_runs() {
    let mut count = 0;
    for shader in shaders_under("fixtures/valid").into_iter().chain(shaders_under("fixtures/programs")) {
        let Some(program) = program(&shader).filter(|_| shader.stage != Stage::Geometry) else { continue };
        match Code::compile(&program, shader.stage) {
            Ok(code) => {
                run::<F64>(&code, &program, shader.stage);
                run::<F32>(&code, &program, shader.stage);
                run::<Envelope>(&code, &program, shader.stage);
                count += 1;
            }
            Err(errors) => {
                let refused = errors.iter().all(|error| may_be_refused(&error.message));
                assert!(refused, "{}: {}", shader.name, errors[0].message);
            }
        }
    }
    assert!(count > 20, "only {count} fixtures ran");
}
