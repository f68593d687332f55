//! The shadow domain, and code with separate operations, on random programs.

use super::generate::{self, Generated, Source};
use super::{canonical, fill, outputs};
use crate::domain::{Domain, ErrorPart, F32, F64, Shadow, Stepwise};
use crate::exec::{Code, Exactly, Form, LANES, Machine, Mask, Purpose};
use glisten_front::hir::{GlobalId, Stage};
use proptest::prelude::*;
use std::sync::Arc;

fn ran<D: Domain>(program: &Generated, form: Form) -> Machine<D> {
    let code = Code::compile_as(&program.program, Stage::Fragment, form).expect("generated programs can be run");
    let mut machine = Machine::new(&code, &program.uniforms, &[]);
    fill(&mut machine, program);
    machine.run(Mask::ALL, Mask::NONE);
    machine
}

fn same<A: Domain, B: Domain>(program: &Generated, a: &Machine<A>, b: &Machine<B>) {
    for lane in 0..LANES {
        assert_eq!(outputs(a, program, lane), outputs(b, program, lane), "lane {lane} of\n{}", generate::text(program));
    }
}

/// The outputs of the exact side, as [`outputs`] has those that decide.
fn exact_outputs(machine: &Machine<Shadow>, program: &Generated, lane: usize) -> Option<Vec<u64>> {
    if machine.discarded().contains(lane) {
        return None;
    }
    let one = |id: GlobalId, flat: u32| {
        let float = machine.float_output(id, flat).map(|lanes| canonical(lanes.get(lane).wide));
        float.or_else(|| machine.int_output(id, flat).map(|lanes| u64::from(lanes.get(lane).wide))).unwrap_or(0)
    };
    let ports = program.outputs.iter().flat_map(|(id, scalars)| (0..scalars.len() as u32).map(|flat| (*id, flat)));
    Some(ports.map(|(id, flat)| one(id, flat)).collect())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn with_every_expression_exact_the_exact_side_is_f64(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let program = generate::program(&mut Source::new(&bytes));
        let code = Code::compile_as(&program.program, Stage::Fragment, Form::Unfused).expect("generated programs can be run");
        let all = Arc::new(Exactly::new(&code, ErrorPart::All, |_| true));
        let mut shadow = Machine::<Shadow>::with(Purpose::Corrected(all), Default::default(), &code, &program.uniforms, &[]);
        fill(&mut shadow, &program);
        shadow.run(Mask::ALL, Mask::NONE);
        let exact = ran::<F64>(&program, Form::Fast);
        for lane in 0..LANES {
            let exact = outputs(&exact, &program, lane);
            assert_eq!(exact_outputs(&shadow, &program, lane), exact, "lane {lane} of\n{}", generate::text(&program));
        }
    }

    #[test]
    fn the_f32_side_alone_has_the_same_numbers(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let program = generate::program(&mut Source::new(&bytes));
        same(&program, &ran::<Shadow>(&program, Form::Unfused), &ran::<Stepwise>(&program, Form::Unfused));
        same(&program, &ran::<Shadow>(&program, Form::Unfused), &ran::<Stepwise>(&program, Form::Fast));
    }

    #[test]
    fn operations_apart_give_the_same_numbers(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let program = generate::program(&mut Source::new(&bytes));
        same(&program, &ran::<F32>(&program, Form::Unfused), &ran::<F32>(&program, Form::Fast));
        same(&program, &ran::<F32>(&program, Form::Counted), &ran::<F32>(&program, Form::Fast));
    }
}
