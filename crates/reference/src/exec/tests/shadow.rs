//! The shadow domain, and code with separate operations, on random programs.

use super::generate::{self, Generated, Source};
use super::{fill, outputs};
use crate::domain::{Domain, F32, F64, Shadow};
use crate::exec::{Code, LANES, Machine, Mask};
use glisten_front::hir::Stage;
use proptest::prelude::*;

fn ran<D: Domain>(program: &Generated, unfused: bool) -> Machine<D> {
    let compile = if unfused { Code::compile_unfused } else { Code::compile };
    let code = compile(&program.program, Stage::Fragment).expect("generated programs can be run");
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

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_shadow_walks_where_f64_walks(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let program = generate::program(&mut Source::new(&bytes));
        same(&program, &ran::<Shadow>(&program, true), &ran::<F64>(&program, false));
    }

    #[test]
    fn operations_apart_give_the_same_numbers(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let program = generate::program(&mut Source::new(&bytes));
        same(&program, &ran::<F32>(&program, true), &ran::<F32>(&program, false));
    }
}
