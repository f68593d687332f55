//! The keys of a draw that say how its sources are completed: `engine`, `assume_version`, `include_style`, `includes`, `preludes`.
//!
//! *In:* the table of a draw. *Out:* [`SourceSettings`], for the compiler. *Holds:* paths are relative to the scene. The
//! [`Library`](crate::Library) knows the names of engines; settings of the compiler itself take precedence.

use super::Loader;
use crate::files::relative_to;
use glisten_front::compiler::SourceSettings;
use glisten_front::diagnostic::codes::scenes::SCENE_UNKNOWN_NAME;
use glisten_front::diagnostic::{Diagnostic, did_you_mean};
use glisten_front::source::Prelude;
use toml::de::DeTable;

/// The settings of a draw; `None` if one is wrong (reported), so that the sources cannot be read as they are meant.
pub(super) fn load_sources(loader: &mut Loader<'_>, table: &DeTable<'_>) -> Option<SourceSettings> {
    let before = loader.reader.diagnostics.len();
    let (engines, styles) = (loader.library.engines(), loader.library.include_styles());
    let includes = loader.reader.texts_at(table, "includes");
    let settings = SourceSettings {
        engine: name(loader, table, "engine", &engines),
        version: version(loader, table),
        include_style: name(loader, table, "include_style", &styles),
        includes: includes.into_iter().map(|(path, _)| relative_to(loader.path, path)).collect(),
        preludes: preludes(loader, table),
    };
    (loader.reader.diagnostics.len() == before).then_some(settings)
}

/// One of the names that the library knows.
fn name(loader: &mut Loader<'_>, table: &DeTable<'_>, key: &str, known: &[&'static str]) -> Option<String> {
    let node = table.get(key)?;
    let text = loader.reader.text(node, key)?;
    if known.contains(&text) {
        return Some(text.to_owned());
    }
    let all = || format!("`{key}` may be \"{}\"", known.join("\", \""));
    let help = did_you_mean(text, known.iter().copied()).map_or_else(all, |near| format!("did you mean `{near}`?"));
    let message = format!("`{text}` is not a name for `{key}`");
    let diagnostic = Diagnostic::new(&SCENE_UNKNOWN_NAME, loader.reader.span_of(node), message).here("no such name");
    loader.reader.report(diagnostic.help(help));
    None
}

/// The version of sources without a `#version` line: `"330"`, `"300 es"`, or a number.
fn version(loader: &mut Loader<'_>, table: &DeTable<'_>) -> Option<String> {
    let (text, span) = loader.reader.version_at(table, "assume_version")?;
    let version = loader.library.checked_version(&text);
    version.map_err(|message| loader.reader.wrong_value(span, message, "no version of GLSL")).ok()
}

fn preludes(loader: &mut Loader<'_>, table: &DeTable<'_>) -> Vec<Prelude> {
    let mut preludes = Vec::new();
    for (name, span) in loader.reader.texts_at(table, "preludes") {
        if let Some((path, bytes)) = loader.bytes(name, span) {
            preludes.push(Prelude { name: path, text: String::from_utf8_lossy(&bytes).into() });
        }
    }
    preludes
}
