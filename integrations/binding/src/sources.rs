//! [`sources_of`]: a text to the sources of a program, one for each of its stages.
//!
//! *Holds:* the stage is that which the host says, or that which the name tells, as for the program `glisten`. A text whose name tells none has
//! the stages that macros or marks choose in it (docs/engines.md); all of them have its name and the whole text.

use crate::error::Error;
use glisten::{Source, Stage};
use glisten_sources::engines::combined;
use std::collections::BTreeSet;

/// The stage that the name of a file tells.
pub fn stage_of_name(name: &str) -> Option<Stage> {
    glisten::stage_of_name(name).map(|(stage, _)| stage)
}

/// The stage of a word.
///
/// # Errors
/// There is no such stage.
pub fn stage_of_word(word: &str) -> Result<Stage, Error> {
    let found = Stage::ALL.into_iter().find(|stage| stage.name() == word);
    found.ok_or_else(|| Error::argument(format!("`{word}` is no stage: vertex, geometry or fragment")))
}

/// The source of a text with one stage.
///
/// # Errors
/// Neither the host nor the name tells the stage.
fn source_of(name: &str, text: &str, stage: Option<Stage>) -> Result<Source, Error> {
    let stage = stage.or_else(|| stage_of_name(name)).ok_or_else(|| no_stage(name))?;
    Ok(Source { name: name.to_owned(), text: text.into(), stage })
}

/// The sources of a text.
///
/// # Errors
/// Neither the host, nor the name, nor the text tells the stage; the text has several programs.
pub fn sources_of(name: &str, text: &str, stage: Option<Stage>) -> Result<Vec<Source>, Error> {
    if stage.is_some() || stage_of_name(name).is_some() {
        return source_of(name, text, stage).map(|source| vec![source]);
    }
    let members = combined::members(text);
    match members.as_slice() {
        [] => Err(no_stage(name)),
        [member] => member.parts.iter().map(|part| source_of(name, text, Some(part.stage))).collect(),
        several => {
            let names: Vec<&str> = several.iter().filter_map(|member| member.name.as_deref()).collect();
            Err(Error::argument(format!("`{name}` has several programs: {}", names.join(", "))))
        }
    }
}

/// Whether some of the sources are stages of one text.
pub(crate) fn share_a_text(sources: &[Source]) -> bool {
    let names: BTreeSet<&str> = sources.iter().map(|source| source.name.as_str()).collect();
    names.len() < sources.len()
}

fn no_stage(name: &str) -> Error {
    let help = "end it with .vert or .frag, or name the stage";
    Error::argument(format!("the name `{name}` tells no stage, and neither does the text: {help}"))
}

#[cfg(test)]
mod tests {
    use super::{source_of, sources_of};
    use crate::program::{Format, compile};
    use crate::settings::Settings;
    use glisten::Stage::{Fragment, Vertex};

    const BOTH: &str = "precision mediump float;\nvarying vec2 st;\n#ifdef VERTEX_SHADER\nattribute vec2 p;\nvoid main() { st = p; gl_Position = vec4(p, 0.0, 1.0); }\n#endif\n\
        #ifdef FRAGMENT_SHADER\nvoid main() { gl_FragColor = vec4(st, 0.0, 1.0); }\n#endif\n";

    #[test]
    fn the_host_the_name_and_the_text_tell_stages_in_this_order() {
        let stages = |name, text, stage| {
            let sources = sources_of(name, text, stage).expect("it tells a stage");
            sources.iter().map(|source| source.stage).collect::<Vec<_>>()
        };
        assert_eq!(stages("a.glsl", BOTH, None), [Vertex, Fragment]);
        assert_eq!(stages("a.glsl", BOTH, Some(Fragment)), [Fragment]);
        assert_eq!(stages("a.vert", BOTH, None), [Vertex]);
        assert_eq!(stages("waterFrag.glsl", "", None), [Fragment]);
    }

    #[test]
    fn each_stage_of_a_text_is_compiled_with_its_macro() {
        let mut settings = Settings::default();
        settings.set("assume-version", "100").expect("it is a version");
        let sources = sources_of("a.glsl", BOTH, None).expect("it has two stages");
        let compiled = compile(&settings, &sources, true).expect("there are sources");
        assert!(compiled.is_sound(), "{}", compiled.diagnostics(Format::Human));
        assert_eq!(compiled.stages(), [Vertex, Fragment]);
        // Wrong lines of a part that both stages have are told once.
        let wrong = BOTH.replace("varying", "float f() { return nothing; }\nvarying");
        let sources = sources_of("a.glsl", &wrong, None).expect("it has two stages");
        let compiled = compile(&settings, &sources, true).expect("there are sources");
        let found = compiled.findings();
        assert_eq!(found.iter().filter(|one| one.message.contains("`nothing`")).count(), 1, "{found:#?}");
    }

    #[test]
    fn what_tells_no_stage_is_refused() {
        let text = "void main() {}";
        let single = source_of("a.glsl", BOTH, None).expect_err("one of two stages");
        for error in [single, sources_of("a.glsl", text, None).expect_err("no stage")] {
            assert!(error.message.contains("`a.glsl`"), "{error:?}");
        }
        let two = "@vs a\nvoid main() {}\n@end\n@fs b\nvoid main() {}\n@end\n@program one a b\n@program two a b\n";
        let error = sources_of("a.glsl", two, None).expect_err("two programs");
        assert!(error.message.ends_with("several programs: one, two"), "{error:?}");
    }
}
