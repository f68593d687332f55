//! Random well-typed programs: every lane yields what it yields alone, and in f64 what a plain tree walk yields.

mod builtins;
mod composites;
mod evaluate;
mod exact;
mod folding;
mod generate;
mod precise;
mod shadow;
mod text;
mod textures;

use super::{Code, LANES, Machine, Mask};
use crate::domain::{Domain, Envelope, F32, F64, Integer, Number};
use generate::{Generated, Source};
use glisten_front::hir::{GlobalId, Scalar};
use proptest::prelude::*;

/// The inputs of the lane, as exact f32 and small integers.
fn input(lane: usize, flat: u32) -> (f32, u32) {
    let float = [0.0, 1.0, -1.0, 0.5, 2.25, -3.75, 7.0, -0.125][(lane * 3 + flat as usize * 5) % 8];
    (float, ((lane as i32 * 7 + flat as i32 * 3) % 11 - 4) as u32)
}

fn fill<D: Domain>(machine: &mut Machine<D>, program: &Generated) {
    fill_by(machine, program, |value| value);
}

fn fill_by<D: Domain>(machine: &mut Machine<D>, program: &Generated, f: impl Fn(f32) -> f32) {
    for (id, classes) in &program.inputs {
        for (flat, _) in classes.iter().enumerate() {
            if let Some(lanes) = machine.float_input(*id, flat as u32) {
                let value = |lane| D::Float::from_f64(f64::from(f(input(lane, flat as u32).0)));
                (0..LANES).for_each(|lane| lanes.set(lane, value(lane)));
            }
            if let Some(lanes) = machine.int_input(*id, flat as u32) {
                (0..LANES).for_each(|lane| lanes.set(lane, D::Int::from_bits(input(lane, flat as u32).1)));
            }
        }
    }
}

/// The bits of every output in every lane, `None` where it was discarded.
fn outputs<D: Domain>(machine: &Machine<D>, program: &Generated, lane: usize) -> Option<Vec<u64>> {
    if machine.discarded().contains(lane) {
        return None;
    }
    let one = |id: GlobalId, flat: u32| {
        let float = machine.float_output(id, flat).map(|lanes| canonical(lanes.get(lane).value()));
        float.or_else(|| machine.int_output(id, flat).map(|lanes| u64::from(lanes.get(lane).bits()))).unwrap_or(0)
    };
    let ports = program.outputs.iter().flat_map(|(id, scalars)| (0..scalars.len() as u32).map(|flat| (*id, flat)));
    Some(ports.map(|(id, flat)| one(id, flat)).collect())
}

/// Makes all NaNs equal, and both zeros: `-0` and `0` are equal in GLSL and may differ by evaluation order.
fn canonical(value: f64) -> u64 {
    if value.is_nan() { f64::NAN.to_bits() } else { (value + 0.0).to_bits() }
}

fn machine_of<D: Domain>(program: &Generated) -> Machine<D> {
    let code =
        Code::compile(&program.program, glisten_front::hir::Stage::Fragment).expect("generated programs can be run");
    Machine::new(&code, &program.uniforms, &[])
}

fn lanes_agree<D: Domain>(program: &Generated) {
    let mut together = machine_of::<D>(program);
    fill(&mut together, program);
    together.run(Mask::ALL, Mask::NONE);
    for lane in [0, 1, 17, 63] {
        let mut alone = machine_of::<D>(program);
        fill(&mut alone, program);
        alone.run(Mask(1 << lane), Mask::NONE);
        let (a, b) = (outputs(&together, program, lane), outputs(&alone, program, lane));
        assert_eq!(a, b, "lane {lane} in {} of\n{}", D::NAME, generate::text(program));
    }
}

fn walk_agrees(program: &Generated) {
    let mut machine = machine_of::<F64>(program);
    fill(&mut machine, program);
    machine.run(Mask::ALL, Mask::NONE);
    for lane in 0..LANES {
        let expected = evaluate::run(program, |_, flat, scalar| match scalar {
            Scalar::Float => evaluate::Cell::Float(f64::from(input(lane, flat).0)),
            _ => evaluate::Cell::Int(input(lane, flat).1),
        });
        let expected = expected.map(|cells| {
            let bits = |cell: &evaluate::Cell| match cell {
                evaluate::Cell::Float(value) => canonical(*value),
                evaluate::Cell::Int(bits) => u64::from(*bits),
            };
            cells.iter().map(bits).collect::<Vec<_>>()
        });
        assert_eq!(outputs(&machine, program, lane), expected, "lane {lane} of\n{}", generate::text(program));
    }
}

/// The reference and a strict GPU are within the envelope, in every decided lane: for numbers whose sums are exact,
/// and for some others. `PROPTEST_CASES=20000 cargo test -p glisten-reference envelope` tries more programs.
fn envelope_holds(program: &Generated) {
    envelope_holds_for(program, |value| value);
    envelope_holds_for(program, |value| value * 0.337 + 0.011);
}

fn envelope_holds_for(program: &Generated, f: impl Fn(f32) -> f32) {
    let mut envelope = machine_of::<Envelope>(program);
    let (mut wide, mut single) = (machine_of::<F64>(program), machine_of::<F32>(program));
    fill_by(&mut envelope, program, &f);
    envelope.run(Mask::ALL, Mask::NONE);
    fill_by(&mut wide, program, &f);
    wide.run(Mask::ALL, Mask::NONE);
    fill_by(&mut single, program, &f);
    single.run(Mask::ALL, Mask::NONE);
    let decided = Mask(!envelope.undecided().0);
    assert_eq!(envelope.discarded(), wide.discarded(), "what is discarded follows the value");
    for lane in decided.lanes().filter(|lane| !envelope.perhaps_discarded().contains(*lane)) {
        let same = wide.discarded().contains(lane) == single.discarded().contains(lane);
        assert!(same, "lane {lane} is discarded by one alone\n{}", generate::text(program));
    }
    for (id, scalars) in &program.outputs {
        for flat in 0..scalars.len() as u32 {
            if let (Some(e), Some(w), Some(s)) =
                (envelope.float_output(*id, flat), wide.float_output(*id, flat), single.float_output(*id, flat))
            {
                for lane in decided.lanes() {
                    let interval = e.get(lane).interval();
                    let holds = |value: f64| interval.contains(value);
                    let told = || {
                        format!(
                            "lane {lane}: {interval:?} of {} and {}\n{}",
                            w.get(lane),
                            s.get(lane),
                            generate::text(program)
                        )
                    };
                    if !wide.discarded().contains(lane) {
                        assert_eq!(
                            canonical(e.get(lane).value()),
                            canonical(w.get(lane)),
                            "the value is the reference's: {}",
                            told()
                        );
                        assert!(holds(w.get(lane)), "f64 in {}", told());
                    }
                    assert!(single.discarded().contains(lane) || holds(f64::from(s.get(lane))), "f32 in {}", told());
                }
            }
            if let (Some(e), Some(w), Some(s)) =
                (envelope.int_output(*id, flat), wide.int_output(*id, flat), single.int_output(*id, flat))
            {
                for lane in decided.lanes() {
                    let (low, high) = e.get(lane).interval();
                    let told = || {
                        format!(
                            "lane {lane}: {low}..={high} of {} and {}\n{}",
                            w.get(lane) as i32,
                            s.get(lane) as i32,
                            generate::text(program)
                        )
                    };
                    for (bits, discarded) in [(w.get(lane), wide.discarded()), (s.get(lane), single.discarded())] {
                        assert!(discarded.contains(lane) || (low..=high).contains(&(bits as i32)), "{}", told());
                    }
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_programs_agree_with_a_tree_walk(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        walk_agrees(&generate::program(&mut Source::new(&bytes)));
    }

    #[test]
    fn random_programs_give_each_lane_what_it_gets_alone(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let program = generate::program(&mut Source::new(&bytes));
        lanes_agree::<F64>(&program);
        lanes_agree::<F32>(&program);
        lanes_agree::<Envelope>(&program);
    }

    #[test]
    fn f64_and_f32_lie_within_the_envelope(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        envelope_holds(&generate::program(&mut Source::new(&bytes)));
    }
}
