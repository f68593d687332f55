//! Texts to texts: `upgrade` and `format`; and `names` and `versions`.

use crate::reply::Reply;
use crate::request::Request;
use glisten_binding::{Error, Format, OPTIONS, Stage, Target, VERSION, stage_of_name, stage_of_word, targets};
use glisten_format::{MAX_INDENT, Options, WIDTHS, formatted};

/// Answers `upgrade`.
pub(crate) fn upgrade(request: &Request) -> Result<Reply, Error> {
    let (settings, asked) = request.settings()?;
    let upgraded = glisten_binding::upgrade(&settings, &request.sources()?, &request.to)?;
    let mut reply = Reply::default();
    if let Some(wanted) = asked.wanted() {
        reply.set("wanted", wanted);
        return Ok(reply);
    }
    reply.set("sound", upgraded.is_sound());
    reply.set("diagnostics", upgraded.diagnostics(Format::Json));
    reply.set("human", upgraded.diagnostics(Format::Human));
    reply.set("texts", upgraded.texts().to_vec());
    reply.set("notes", upgraded.notes().to_vec());
    Ok(reply)
}

/// Answers `format`.
pub(crate) fn format(request: &Request) -> Result<Reply, Error> {
    let (style, mut options) =
        (&request.style, Options { braces_below: request.style.braces_below, ..Options::default() });
    if let Some(indent) = style.indent {
        if indent > MAX_INDENT {
            return Err(Error::argument(format!("{indent} is no indentation: it is 0 (tabs) to {MAX_INDENT}")));
        }
        options.indent = Some(indent).filter(|blanks| *blanks > 0);
    }
    if let Some(width) = style.width {
        let [least, greatest] = WIDTHS;
        if !(least..=greatest).contains(&width) {
            return Err(Error::argument(format!("{width} is no width: it is {least} to {greatest}")));
        }
        options.width = width;
    }
    let mut texts = Vec::new();
    for source in &request.sources {
        let stage = match &source.stage {
            Some(word) => stage_of_word(word)?,
            None => stage_of_name(&source.name).unwrap_or(Stage::Fragment),
        };
        let text = &source.text;
        texts.push(formatted(text, stage, &options).text);
    }
    let mut reply = Reply::default();
    reply.set("texts", texts);
    Ok(reply)
}

/// Answers `names`: for each name of a file, the stage and the rest of the name, or nothing.
pub(crate) fn names(request: &Request) -> Reply {
    let told = request.sources.iter().map(|source| {
        let (stage, stem) = glisten::stage_of_name(&source.name)?;
        Some(serde_json::json!({ "stage": stage.name(), "stem": stem }))
    });
    let mut reply = Reply::default();
    reply.set("names", told.collect::<Vec<_>>());
    reply
}

/// Answers `versions`: of glisten, and the words that options and targets have.
pub(crate) fn versions() -> Reply {
    let mut reply = Reply::default();
    reply.set("version", VERSION);
    reply.set("targets", targets().map(Target::word).collect::<Vec<_>>());
    reply.set("options", OPTIONS.iter().map(|(name, ..)| *name).collect::<Vec<_>>());
    // GLSL for Vulkan is written with the reference alone.
    let upgrades = glisten::upgrade::Target::ALL.into_iter();
    let upgrades =
        upgrades.filter(|(_, target)| cfg!(feature = "reference") || *target != glisten::upgrade::Target::Vulkan);
    reply.set("upgrades", upgrades.map(|(word, _)| word).collect::<Vec<_>>());
    reply.set("reference", cfg!(feature = "reference"));
    reply
}
