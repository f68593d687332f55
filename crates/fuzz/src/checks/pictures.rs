//! Forms of a program that must draw the same picture.
//!
//! *In:* a program that has been drawn. *Out:* a sentence where another picture is drawn.

use super::drawn::{Drawn, Texts, bits, compiler, first_error, inside, scene_of};
use super::targets::{is_refusal, stages};
use crate::chance::Chance;
use crate::generate::{Change, changed};
use glisten::specialize::specialize_scene;
use glisten::upgrade::{Refused, Target as Version, upgrade as upgraded};
use glisten_emit::{Conventions, Emitted, GlslVersion, Target, emit};
use glisten_format as format;
use glisten_format::has_same_lexemes;
use glisten_front::hir;
use glisten_reference::Precision;
use glisten_verify::verify::Cpu;
use std::sync::Arc;

type Held = Result<(), String>;

/// f32 without any freedom is what a conforming GPU may draw.
pub(super) fn envelope(drawn: &Drawn<'_>) -> Held {
    if drawn.is_inside(&drawn.picture)? {
        return Ok(());
    }
    inside(drawn, &Cpu::new(Precision::F32))
}

/// Formatted texts.
pub(super) fn format(drawn: &Drawn<'_>) -> Held {
    let odd = format::Options { indent: None, width: 40, braces_below: true };
    // Of the two styles, the seed chooses one.
    let styles = [format::Options::default(), odd];
    let left_out = drawn.program.map(|program| program.seed as usize % 2);
    for (_, options) in styles.into_iter().enumerate().filter(|(index, _)| left_out != Some(*index)) {
        let mut texts = Vec::new();
        for source in &drawn.texts.sources {
            let once = format::format(&source.text, &[], &options);
            if once.kept > 0 || !has_same_lexemes(&source.text, &once.text) {
                return Err(format!("{} lines are kept:\n{}", once.kept, once.text));
            }
            if format::format(&once.text, &[], &options).text != once.text {
                return Err(format!("formatted again, it is different:\n{}", once.text));
            }
            texts.push(once.text);
        }
        drawn.same(&texts)?;
    }
    Ok(())
}

/// The typed program as text of its version. Texts of ES have precisions, which are for [`print_300es`] to write.
pub(super) fn print(drawn: &Drawn<'_>) -> Held {
    let Some(draw) = drawn.scene.draws.first() else { return Ok(()) };
    if drawn.is_es() {
        drawn.leave_out("ES has precisions");
        return Ok(());
    }
    drawn.same(&printed(&draw.program))
}

fn printed(program: &glisten_front::Program) -> Vec<String> {
    stages(program).map(|shader| hir::print(&program.types, shader)).collect()
}

pub(super) fn print_330(drawn: &Drawn<'_>) -> Held {
    written(drawn, GlslVersion::Desktop330)
}

pub(super) fn print_450(drawn: &Drawn<'_>) -> Held {
    written(drawn, GlslVersion::Desktop450)
}

pub(super) fn print_300es(drawn: &Drawn<'_>) -> Held {
    written(drawn, GlslVersion::Es300)
}

/// GLSL of another version.
fn written(drawn: &Drawn<'_>, glsl_version: GlslVersion) -> Held {
    let Some(draw) = drawn.scene.draws.first() else { return Ok(()) };
    let conventions = Conventions { glsl_version, ..Conventions::default() };
    let mut texts = Vec::new();
    for shader in stages(&draw.program) {
        match emit(&draw.program, shader.stage, Target::Glsl, &conventions) {
            Ok(Emitted::Text(text)) => texts.push(text),
            Ok(Emitted::Words(_)) => return Err("words instead of text".to_owned()),
            Err(errors) => {
                drawn.leave_out("the version lacks something");
                return is_refusal(&errors);
            }
        }
    }
    drawn.same(&texts)
}

/// The sources in each later version that takes them; of a generated program, in one that its seed chooses, since this takes longest.
pub(super) fn upgrade(drawn: &Drawn<'_>) -> Held {
    let sources = &drawn.texts.sources;
    let all = Version::ALL;
    let chosen = drawn.program.map(|program| Chance::new(program.seed).below(all.len()));
    for (_, (word, target)) in all.into_iter().enumerate().filter(|(index, _)| chosen.is_none_or(|one| one == *index)) {
        match upgraded(compiler(), sources, target) {
            Ok(new) if target != Version::Vulkan => {
                drawn.same(&new.texts).map_err(|message| format!("for {word}: {message}"))?;
            }
            // ES is another language, and from 4.60 on, a constant has no comma.
            Err(Refused::NotValid(compilation)) if !drawn.is_es() && !word.ends_with("es") => {
                let error = first_error(compilation.diagnostics.iter());
                if !error.starts_with("E0408") {
                    return Err(format!("for {word}, what is rewritten is not valid: {error}"));
                }
            }
            Ok(_) => drawn.leave_out("GLSL for Vulkan is not drawn"),
            Err(_) => drawn.leave_out("the version does not take it"),
        }
    }
    Ok(())
}

/// The rest for known values: of all uniforms, of some, of none.
pub(super) fn specialize(drawn: &Drawn<'_>) -> Held {
    let Some(draw) = drawn.scene.draws.first() else { return Ok(()) };
    let names: Vec<String> = draw.program.interface.uniforms.iter().map(|one| one.name.clone()).collect();
    let mut chance = Chance::new(names.len() as u64);
    let some = names.iter().filter(|_| chance.once_in(2)).cloned().collect();
    // Of the latter two, the seed chooses one.
    let all = [Vec::new(), some, names];
    let left_out = drawn.program.map(|program| 1 + program.seed as usize % 2);
    for (_, dynamic) in all.into_iter().enumerate().filter(|(index, _)| left_out != Some(*index)) {
        let left = specialize_scene(&drawn.scene, &drawn.loaded.sources, &dynamic);
        let texts =
            || left.draws.iter().flat_map(|draw| &draw.texts).map(|(_, text)| text.as_str()).collect::<String>();
        if let Some(fault) = left.draws.iter().find_map(|draw| draw.fault.clone()) {
            return Err(format!("with {dynamic:?}, it does not read back: {fault}\n{}", texts()));
        }
        let same = drawn.same_scene(&left.scene);
        same.map_err(|message| format!("with {dynamic:?}: {message}\n{}", texts()))?;
    }
    Ok(())
}

/// The rest after `-O`, and its text.
pub(super) fn optimize(drawn: &Drawn<'_>) -> Held {
    let Some(draw) = drawn.scene.draws.first() else { return Ok(()) };
    let left = Arc::new(glisten_specialize::optimize(&draw.program));
    let texts = printed(&left);
    drawn.same_scene(&drawn.with(left)).map_err(|message| format!("{message}\n{}", texts.join("\n")))?;
    if drawn.is_es() { Ok(()) } else { drawn.same(&texts) }
}

pub(super) fn dead_code(drawn: &Drawn<'_>) -> Held {
    as_changed(drawn, Change::DeadCode)
}

pub(super) fn one_iteration(drawn: &Drawn<'_>) -> Held {
    as_changed(drawn, Change::OneIteration)
}

pub(super) fn named(drawn: &Drawn<'_>) -> Held {
    as_changed(drawn, Change::Named)
}

pub(super) fn outlined(drawn: &Drawn<'_>) -> Held {
    as_changed(drawn, Change::Outlined)
}

pub(super) fn parentheses(drawn: &Drawn<'_>) -> Held {
    as_changed(drawn, Change::Parentheses)
}

pub(super) fn uniforms(drawn: &Drawn<'_>) -> Held {
    as_changed(drawn, Change::Uniforms)
}

pub(super) fn bare(drawn: &Drawn<'_>) -> Held {
    as_changed(drawn, Change::Bare)
}

pub(super) fn spelled(drawn: &Drawn<'_>) -> Held {
    as_changed(drawn, Change::Spelled)
}

pub(super) fn expanded(drawn: &Drawn<'_>) -> Held {
    as_changed(drawn, Change::Expanded)
}

pub(super) fn renamed(drawn: &Drawn<'_>) -> Held {
    as_changed(drawn, Change::Renamed)
}

pub(super) fn components(drawn: &Drawn<'_>) -> Held {
    as_changed(drawn, Change::Components)
}

pub(super) fn digits(drawn: &Drawn<'_>) -> Held {
    as_changed(drawn, Change::Digits)
}

/// The program with a change that means nothing.
fn as_changed(drawn: &Drawn<'_>, change: Change) -> Held {
    let Some(program) = drawn.program else { return Ok(()) };
    let other = changed(program, change, program.seed);
    let in_other = |message: String| format!("{message}\n{}", other.text());
    let texts = Texts::from(&other);
    let scene = if texts.scene == drawn.texts.scene {
        let texts: Vec<String> = texts.sources.iter().map(|source| source.text.to_string()).collect();
        if !drawn.is_new(&texts) {
            drawn.leave_out("there is nothing to change");
            return Ok(());
        }
        drawn.with_texts(&texts).map_err(in_other)?
    } else {
        scene_of(&texts).map_err(in_other)?.1
    };
    drawn.same_scene(&scene).map_err(in_other)?;
    // Constants are folded in f32. Of the others, one in three is drawn in f64, too, as its seed chooses.
    if change == Change::Uniforms || !(program.seed.wrapping_add(change as u64)).is_multiple_of(3) {
        return Ok(());
    }
    drawn.exact()?.difference(&bits(&scene, Precision::F64)?).map_err(|message| in_other(format!("in f64, {message}")))
}
