//! Random programs in 192 bits and in f64.

use super::generate::{self, Source};
use super::{fill_by, machine_of};
use crate::domain::{Domain, Exact, F64, Number};
use crate::exec::{LANES, Machine, Mask};

fn ran<D: Domain>(program: &generate::Generated) -> Machine<D> {
    let mut machine = machine_of::<D>(program);
    // Thirds, so that nothing is exact in f64.
    fill_by(&mut machine, program, |value| value * 0.337 + 0.011);
    machine.run(Mask::ALL, Mask::NONE);
    machine
}

/// Where f64 decides another way than 192 bits do, or cancels, the results differ: that is rare.
#[test]
fn random_programs_agree_with_f64_to_its_rounding() {
    let mut state = 1u64;
    let mut byte = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 56) as u8
    };
    let (mut agreed, mut differed) = (0u32, 0u32);
    for length in 0..120 {
        let bytes: Vec<u8> = (0..length * 3).map(|_| byte()).collect();
        let program = generate::program(&mut Source::new(&bytes));
        let (exact, double) = (ran::<Exact>(&program), ran::<F64>(&program));
        for (id, scalars) in &program.outputs {
            for flat in 0..scalars.len() as u32 {
                let (Some(exact), Some(double)) = (exact.float_output(*id, flat), double.float_output(*id, flat))
                else {
                    continue;
                };
                for lane in 0..LANES {
                    let (a, b) = (exact.get(lane).value(), double.get(lane));
                    let near = (a - b).abs() <= 1e-12 * a.abs().max(1.0);
                    if a == b || near || (a.is_nan() && b.is_nan()) { agreed += 1 } else { differed += 1 }
                }
            }
        }
    }
    assert!(agreed > 10_000 && differed * 100 < agreed, "{differed} of {} differ", agreed + differed);
}
