//! The meaning of a name (LSP 3.17, `textDocument/hover`): its declaration with type and value, its comment, the places that the link
//! assigns, the other stage's declaration, the expansion of a macro; for a built-in name its prototypes and what it does.

use crate::analysis::Analysis;
use crate::builtins;
use crate::describe;
use crate::state::{Point, State};
use glisten_front::analysis::Denoted;
use glisten_front::hir::TypeId;
use glisten_front::index::{Occurrence, Symbol, SymbolKind};
use glisten_library::Header;
use lsp_types::{Hover, HoverContents, HoverParams, MarkupContent, MarkupKind};
use std::fmt::Write as _;
use std::path::Path;
use std::rc::Rc;

/// A macro's text is shown up to this many bytes.
const MAX_BODY: usize = 600;

/// Answers the request.
pub(super) fn hover(state: &mut State<'_>, params: &HoverParams) -> Option<Hover> {
    let point = state.point(&params.text_document_position_params)?;
    let include = include(&point);
    let (text, range) = match include {
        Some(found) => found,
        None => match state.occurrence(&point) {
            Some((analysis, found)) => {
                let place = analysis.named_place(found.span)?;
                (describe(state, &analysis, &found, &point)?, place.start..place.end)
            }
            None => other(&point)?,
        },
    };
    let contents = HoverContents::Markup(MarkupContent { kind: MarkupKind::Markdown, value: text });
    Some(Hover { contents, range: Some(point.text.range(range, state.encoding)) })
}

/// GLSL in Markdown.
pub(super) fn code(text: &str) -> String {
    format!("```glsl\n{text}\n```\n")
}

fn describe(state: &State<'_>, analysis: &Rc<Analysis>, found: &Occurrence, point: &Point) -> Option<String> {
    let symbol = analysis.symbol(found.symbol);
    match symbol.kind {
        SymbolKind::Builtin => return builtin(analysis, &symbol.name, &point.path),
        SymbolKind::Macro => return Some(of_macro(analysis, &symbol.name, point)),
        SymbolKind::MacroParameter => return Some(format!("`{}`: a parameter of the macro\n", symbol.name)),
        SymbolKind::Declared => {}
    }
    let mut text = String::new();
    let own = own_place(analysis, &symbol.places, &point.path);
    let declaration = own.and_then(|(view, denoted)| describe::declaration(analysis, view, denoted))?;
    text.push_str(&code(&declaration));
    let mut told = vec![declaration];
    for &(view, denoted) in &symbol.places {
        let other = describe::declaration(analysis, view, denoted).filter(|other| !told.contains(other));
        if let (Some(other), Some(view)) = (other, analysis.compiled.inspection.view(view)) {
            let _ = write!(text, "\nin the {} stage\n{}", describe::stage(view).name(), code(&other));
            told.push(other);
        }
    }
    let facts = describe::facts(analysis, symbol);
    if !facts.is_empty() {
        let _ = write!(text, "\n{}\n", facts.join(" · "));
    }
    let is_parameter = own.is_some_and(|(view, denoted)| describe::is_parameter(analysis, view, denoted));
    if let Some(comment) = describe::comment(analysis, symbol).filter(|_| !is_parameter) {
        let _ = write!(text, "\n{comment}\n");
    }
    if let Some(model) = model(analysis, symbol) {
        let _ = write!(text, "\n{model}\n");
    }
    let elsewhere = symbol.declarations.first().and_then(|span| analysis.named_place(*span));
    if let Some(place) = elsewhere.filter(|place| point.path.as_os_str() != place.file.as_str()) {
        let line = analysis.sources().line(symbol.declarations.first().copied()?).unwrap_or(1);
        let name = Path::new(&place.file).file_name().map(|name| name.to_string_lossy().into_owned());
        let shown = if place.file.starts_with('<') { place.file.clone() } else { name.unwrap_or_default() };
        match state.path_of(&place.file).and_then(|path| state.uri(&path)) {
            Some(uri) => {
                let _ = write!(text, "\n[{shown}:{line}]({}#L{line})\n", uri.as_str());
            }
            None => {
                let _ = write!(text, "\n{shown}:{line}\n");
            }
        }
    }
    Some(text)
}

/// The equation of a function of the library, and its source.
fn model(analysis: &Analysis, symbol: &Symbol) -> Option<String> {
    let place = analysis.named_place(*symbol.declarations.first()?)?;
    let name = place.file.strip_prefix(glisten_library::SHOWN)?.strip_suffix(".glsl")?;
    let module = glisten_library::modules().iter().find(|module| module.name == name)?;
    let header = Header::of(module.text);
    let parts = [("equation", header.equation), ("source", header.source), ("rounding", header.stability)];
    let parts: Vec<String> = parts
        .into_iter()
        .filter(|(_, value)| !value.is_empty())
        .map(|(key, value)| format!("*{key}*: {value}"))
        .collect();
    Some(parts.join("  \n")).filter(|text| !text.is_empty())
}

/// A symbol as it is in the view that reads a file; the first if none does.
pub(super) fn own_place(analysis: &Analysis, places: &[(usize, Denoted)], path: &Path) -> Option<(usize, Denoted)> {
    let views: Vec<_> = analysis.views_of(path).iter().map(|view| view.file).collect();
    let is_own = |(view, _): &&(usize, Denoted)| {
        analysis.compiled.inspection.view(*view).is_some_and(|view| views.contains(&view.file))
    };
    places.iter().find(is_own).or(places.first()).copied()
}

/// A built-in name, as the language of the file has it.
fn builtin(analysis: &Analysis, name: &str, path: &Path) -> Option<String> {
    let view = analysis.views_of(path).into_iter().next()?;
    let told = builtins::describe(name, view.shader.version, view.shader.stage)?;
    let mut text = code(&told.declarations.join("\n"));
    if let Some(sentence) = told.sentence {
        let _ = write!(text, "\n{sentence}\n");
    }
    let _ = write!(text, "\nGLSL {}\n", told.section);
    Some(text)
}

/// A macro: its definitions, and what it expands to here.
fn of_macro(analysis: &Analysis, name: &str, point: &Point) -> String {
    let mut text = String::new();
    for view in analysis.views_of(&point.path) {
        let definitions = view.ast.directives.definitions.iter().filter(|definition| &*definition.name == name);
        for definition in definitions {
            let params = definition.params.as_ref().map_or(String::new(), |params| format!("({})", params.join(", ")));
            let mut body = analysis.sources().snippet(definition.body);
            if body.len() > MAX_BODY {
                let end = (0..=MAX_BODY).rev().find(|&at| body.is_char_boundary(at)).unwrap_or(0);
                body = body.get(..end).unwrap_or("");
            }
            let shown = code(format!("#define {name}{params} {body}").trim_end());
            if !text.contains(&shown) {
                text.push_str(&shown);
            }
        }
    }
    if text.is_empty() {
        let _ = writeln!(text, "`{name}`: a macro that nothing defines here");
    }
    text
}

/// The file of an include.
fn include(point: &Point) -> Option<(String, std::ops::Range<usize>)> {
    for analysis in &point.analyses {
        for view in analysis.views_of(&point.path) {
            for include in &view.ast.directives.includes {
                let Some(place) = analysis.named_place(include.span) else { continue };
                let is_here = point.path.as_os_str() == place.file.as_str();
                if is_here && place.start <= point.offset && point.offset <= place.end {
                    let text = match include.file {
                        Some(file) => format!("`{}`\n", analysis.sources().file(file).name()),
                        None => "no such file\n".to_owned(),
                    };
                    return Some((text, place.start..place.end));
                }
            }
        }
    }
    None
}

/// Words that are no names of the program: components, `length`, keywords, and those in text that is left out.
fn other(point: &Point) -> Option<(String, std::ops::Range<usize>)> {
    let range = point.text.word_at(point.offset)?;
    let word = point.text.text.get(range.clone())?;
    for analysis in &point.analyses {
        let types = &analysis.compiled.inspection.types;
        for (_, view) in analysis.compiled.inspection.views() {
            let here = |note: &&glisten_front::analysis::Note| {
                let place = analysis.named_place(note.span);
                place.is_some_and(|place| {
                    point.path.as_os_str() == place.file.as_str()
                        && place.start == range.start
                        && place.end == range.end
                })
            };
            match view.notes.names.iter().find(here).map(|note| note.denoted) {
                Some(Denoted::Components(ty)) => {
                    let count = u8::try_from(word.len()).ok().filter(|count| (1..=4).contains(count));
                    let result = count.and_then(|count| Some(TypeId::vector(types.scalar_of(ty)?, count)));
                    let result = result.map_or(String::new(), |result| types.name(result));
                    return Some((code(&format!("{result} {word}  // of a {}", types.name(ty))), range));
                }
                Some(Denoted::Length(ty)) => {
                    return Some((code(&format!("int length()  // of a {}", types.name(ty))), range));
                }
                _ => {}
            }
        }
    }
    // Where the text is broken, nothing says what a name denotes; one of the language almost always does.
    let of_language = || point.analyses.iter().find_map(|analysis| builtin(analysis, word, &point.path));
    let is_after_dot = point.text.text.get(..range.start)?.trim_end().ends_with('.');
    let told = builtins::keyword(word).or_else(|| of_language().filter(|_| !is_after_dot))?;
    Some((told, range))
}
