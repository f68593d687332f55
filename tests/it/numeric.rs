//! Random numeric programs: what lavapipe draws of them lies in the envelope. Their numbers round at every step, unlike
//! those of [`random`](crate::random), which are exact.
//!
//! Each program is a fragment shader of nested built-in functions, operators, loops and branches over two varyings, drawn
//! as 8x8 pixels. `NUMERIC_PROGRAMS=first..end` runs other seeds; `--nocapture` prints what was checked.

#![expect(clippy::print_stdout, reason = "what was checked is printed here")]

use crate::drawing::{from_texts, gpu, reference};
use glisten_fuzz::fragments::numeric as text;
use glisten_fuzz::fragments::numeric::{SCENE, VERTEX};
use glisten_gpu::Via;
use glisten_reference::Precision;
use std::ops::Range;

fn seeds() -> Range<u64> {
    let Ok(asked) = std::env::var("NUMERIC_PROGRAMS") else { return 0..240 };
    let (first, end) = asked.split_once("..").expect("NUMERIC_PROGRAMS=first..end");
    first.parse().expect("a number")..end.parse().expect("a number")
}

#[test]
fn what_lavapipe_makes_of_numeric_programs_lies_in_their_envelopes() {
    let gpu = gpu();
    let (mut checked, mut limited, mut decided, mut programs) = (0_u64, 0_u64, 0_u64, 0_u64);
    let mut outside = Vec::new();
    for seed in seeds() {
        let fragment = text::fragment(seed);
        let scene = from_texts([("n.toml", SCENE), ("n.vert", VERTEX), ("n.frag", fragment.as_str())]);
        let envelope = reference(&scene, Precision::Envelope);
        let intervals = &envelope.intervals.as_ref().expect("it has envelopes")[0];
        programs += 1;
        for via in [Via::Spirv, Via::Wgsl] {
            let picture =
                gpu.render(&scene, via).unwrap_or_else(|error| panic!("seed {seed}: {error}\n{fragment}")).picture;
            for (pixel, intervals) in intervals.iter().enumerate() {
                if envelope.undecided[pixel] {
                    continue;
                }
                decided += 1;
                for (channel, interval) in intervals.iter().enumerate() {
                    let drawn = picture.attachments[0][pixel][channel];
                    checked += 1;
                    limited += u64::from(interval.width().is_finite() && !interval.may_be_nan);
                    if !interval.contains(drawn) && outside.len() < 4 {
                        outside.push(format!(
                            "seed {seed}, {}, pixel {pixel}: {drawn:e} not in {interval:?}\n{fragment}",
                            via.name()
                        ));
                    }
                }
            }
        }
    }
    println!(
        "{programs} numeric programs by SPIR-V and WGSL: {checked} numbers of {decided} decided pixels checked, {limited} of them with \
         a finite envelope"
    );
    assert!(outside.is_empty(), "{}", outside.join("\n"));
    assert!(checked >= 100 * programs && limited * 10 > checked * 9, "{limited} of {checked} numbers are limited");
}
