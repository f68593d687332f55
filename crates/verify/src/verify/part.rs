//! The part of a picture that is judged, so that a verdict on long loops takes seconds and not minutes.
//!
//! *In:* a scene, and the work that a verdict may take. *Out:* a [`Sample`]. *Holds:* it depends on the scene and on that number alone,
//! not on the machine's speed: the same call judges the same pixels everywhere.

use super::{Failure, Options};
use crate::scene::Scene;
use glisten_front::hir::{Stage, StmtKind};
use glisten_reference::domain::faults::Faults;
use glisten_reference::{RenderOptions, Sample};
use glisten_scene::picture::Picture;
use std::borrow::Cow;

/// The work of an envelope up to which all of a picture is judged, if nobody says another number, in the units of
/// [`glisten_reference::envelope_work`], which take some 0.2 microseconds each.
pub const MOST_WORK: u64 = 40_000_000;
/// The numbers of blocks on which the work is measured: so many first, and then more if that was little work. One block
/// says little: the work of a picture's parts differs by more than what the verdict may take.
const TRIALS: [usize; 3] = [8, 32, 64];
/// Little work, as a share of what a verdict may take.
const LITTLE: u64 = 32;
/// The smallest number of blocks that stands for a picture: 256 pixels.
const FEWEST: usize = 4;

/// The part of a scene's picture that a verdict with these options is about.
pub(super) fn part(scene: &Scene, options: &Options<'_>) -> Result<Sample, Failure> {
    let size = [scene.framebuffer.width, scene.framebuffer.height];
    let blocks = Sample::blocks(size);
    let Some(most) = options.most_work.filter(|_| has_loops(scene) && blocks > FEWEST) else {
        return Ok(Sample::ALL);
    };
    let (mut all, mut drawn_blocks) = (0.0, 0);
    for count in TRIALS {
        let count = (blocks / 64).clamp(TRIALS[0], count);
        // A small picture has the same trial again.
        if count == drawn_blocks {
            break;
        }
        drawn_blocks = count;
        let trial = Sample::of(count, size);
        let drawn = RenderOptions { sample: trial, ..options.reference_options(Faults::NONE) };
        let work = options.reference.work(scene, &drawn)?;
        all = work as f64 / trial.drawn_share(size).max(f64::MIN_POSITIVE);
        if work > most / LITTLE {
            break;
        }
    }
    if all <= most as f64 {
        return Ok(Sample::ALL);
    }
    let wanted = blocks as f64 * most as f64 / all;
    Ok(Sample::of((wanted as usize).max(FEWEST), size))
}

/// Whether a fragment stage has a loop. Straight code ends soon.
fn has_loops(scene: &Scene) -> bool {
    let stages = scene.draws.iter().filter_map(|draw| draw.program.stage(Stage::Fragment));
    stages.into_iter().any(|shader| {
        let mut found = false;
        for body in shader.functions.iter().filter_map(|function| function.body.as_deref()) {
            shader.visit_statements(body, &mut |statement| found |= matches!(statement.kind, StmtKind::Loop { .. }));
        }
        found
    })
}

/// Leaves nothing covered outside of a sample in the picture of the reference.
pub(super) fn keep_only(picture: &mut Picture, sample: Sample) {
    let width = picture.width.max(1);
    let is_outside = |index: usize| !sample.has(index as u32 % width, index as u32 / width);
    for marks in [&mut picture.covered, &mut picture.undecided] {
        let outside = marks.iter_mut().enumerate().filter(|(index, _)| is_outside(*index));
        outside.for_each(|(_, mark)| *mark = false);
    }
}

/// A picture of which nothing is covered outside of a sample. There it has the colors of the reference.
pub(super) fn only<'p>(picture: &'p Picture, sample: Sample, reference: &Picture) -> Cow<'p, Picture> {
    if sample.is_all() {
        return Cow::Borrowed(picture);
    }
    let mut part = picture.clone();
    keep_only(&mut part, sample);
    let width = picture.width.max(1);
    for (new, old) in part.attachments.iter_mut().zip(&reference.attachments) {
        for (index, (new, old)) in new.iter_mut().zip(old).enumerate() {
            if !sample.has(index as u32 % width, index as u32 / width) {
                *new = *old;
            }
        }
    }
    Cow::Owned(part)
}

#[cfg(test)]
mod tests {
    use crate::scene::{MemoryFiles, Scene, load};
    use crate::verify::{Cpu, Drawn, Failure, Options, Runner, verify};
    use glisten_front::{Compiler, Options as CompilerOptions};
    use glisten_reference::Precision;

    fn scene() -> Scene {
        let files = MemoryFiles::new([
            (
                "a.toml",
                "[framebuffer]\nwidth = 64\nheight = 64\nformat = \"rgba32float\"\n[[draw]]\nvertex = \"a.vert\"\nfragment = \
                 \"a.frag\"\nprimitive = \"triangles\"\nvertex_count = 3\n",
            ),
            (
                "a.vert",
                "#version 150\nvoid main() { gl_Position = vec4(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 * 4 - 1, 0, 1); }",
            ),
            (
                "a.frag",
                "#version 150\nout vec4 c;\nvoid main() {\n    vec2 p = gl_FragCoord.xy / 64.0;\n    float s = 0.0;\n    for (int i = 0; \
                 i < 20; ++i)\n        s += 0.02 * p.x * p.y;\n    c = vec4(s, p, 1.0);\n}",
            ),
        ]);
        load("a.toml", &files, &Compiler::new(CompilerOptions::default())).scene.expect("the scene is valid")
    }

    /// Draws as the reference does, and changes one pixel.
    struct Faulty(usize);

    impl Runner for Faulty {
        fn name(&self) -> &'static str {
            "faulty"
        }

        fn draw(&self, scene: &Scene) -> Result<Drawn, Failure> {
            let mut drawn = Cpu::new(Precision::F32).draw(scene)?;
            drawn.picture.attachments[0][self.0][0] += 0.1;
            Ok(drawn)
        }
    }

    #[test]
    fn blocks_stand_for_a_picture_that_takes_long() {
        let scene = scene();
        let of = |most_work| Options { most_work, ..Options::default() };
        let judged =
            |most_work, runner: &dyn Runner| verify(&scene, &[runner], &of(most_work)).expect("it can be drawn");
        let cpu = Cpu::new(Precision::F32);
        let whole = judged(None, &cpu);
        assert_eq!((whole.share, whole.runs[0].verdict.covered), (1.0, 64 * 64));
        assert_eq!(judged(Options::default().most_work, &cpu).share, 1.0);
        let part = judged(Some(1500), &cpu);
        assert!(part.holds() && part.share < 0.5, "{}", part.share);
        let covered = part.runs[0].verdict.covered;
        assert_eq!(covered as f64, part.share * 4096.0);
        assert_eq!((covered % 64, part.share), (0, judged(Some(1500), &cpu).share));
        assert_eq!(judged(Some(1), &cpu).runs[0].verdict.covered, 4 * 64);
        // A fault shows if its block is judged.
        let blocks: Vec<bool> = (0..64)
            .map(|block| 8 * 64 * (block / 8) + 8 * (block % 8) + 65)
            .map(|pixel| judged(Some(1500), &Faulty(pixel)).fails())
            .collect();
        let found = blocks.iter().filter(|found| **found).count();
        assert_eq!(found as u64 * 64, covered);
        assert!(judged(None, &Faulty(65)).fails());
    }
}
