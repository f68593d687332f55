//! [`Saved`]: diagnostics with what it takes to show them, for a file.
//!
//! *In:* diagnostics and the [`SourceMap`] of their spans. *Out:* a value for serde, and from it the diagnostics again with a
//! map of their own. *Holds:* what is restored is shown as the original is: excerpts, macros, numbers of `#line`, comments
//! that allow a code. Texts without a diagnostic are blank, and macro uses that no diagnostic names are left out.

use super::{Applicability, Code, Diagnostic, Edit, Fix, Label, Severity, codes};
use crate::source::{Expansion, ExpansionId, Language, SourceMap, Span};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The longest text: far more than a source may have.
const MAX_TEXT: usize = 64 << 20;

/// Diagnostics and their texts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    files: Vec<SavedFile>,
    expansions: Vec<SavedExpansion>,
    /// The offset of each `#line` directive and the number that it gives.
    renumbered: Vec<(u32, u32)>,
    /// The offset from which texts are of a language, its number, and whether it is that of OpenGL ES.
    #[serde(default)]
    languages: Vec<(u32, u16, bool)>,
    diagnostics: Vec<SavedDiagnostic>,
}

/// A text: whole if a diagnostic is in it, otherwise its length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct SavedFile {
    name: String,
    length: usize,
    text: Option<String>,
}

/// Start, end, and the number of the macro use.
type SavedSpan = (u32, u32, u32);

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct SavedExpansion {
    name: String,
    call: SavedSpan,
    definition: SavedSpan,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct SavedDiagnostic {
    code: String,
    severity: u8,
    message: String,
    primary: (SavedSpan, String),
    secondary: Vec<(SavedSpan, String)>,
    notes: Vec<String>,
    help: Option<String>,
    #[serde(default)]
    fixes: Vec<SavedFix>,
    presented_line: Option<u32>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct SavedFix {
    title: String,
    safe: bool,
    edits: Vec<(SavedSpan, String)>,
}

impl Saved {
    /// The diagnostics, whose spans are of `sources`.
    pub fn new<'a>(sources: &SourceMap, diagnostics: impl IntoIterator<Item = &'a Diagnostic>) -> Self {
        let mut writer = Writer { sources, numbers: BTreeMap::new(), expansions: Vec::new(), shown: Vec::new() };
        writer.shown.resize(sources.files().count(), false);
        let diagnostics: Vec<SavedDiagnostic> = diagnostics.into_iter().map(|one| writer.diagnostic(one)).collect();
        let file = |((_, file), shown): ((_, &crate::source::SourceFile), &bool)| SavedFile {
            name: file.name().to_owned(),
            length: file.text().len(),
            text: shown.then(|| file.text().to_string()),
        };
        let files = sources.files().zip(&writer.shown).map(file).collect();
        let renumbered = if diagnostics.is_empty() { Vec::new() } else { sources.renumbered().collect() };
        let languages = sources.languages().map(|(base, language)| (base, language.number, language.es)).collect();
        let languages = if diagnostics.is_empty() { Vec::new() } else { languages };
        Self { files, expansions: writer.expansions, renumbered, languages, diagnostics }
    }

    /// The diagnostics again, and the texts of their spans. `None` if this is not what [`Self::new`] made: a code is unknown,
    /// or the texts have no room.
    pub fn restore(&self) -> Option<(SourceMap, Vec<Diagnostic>)> {
        let mut sources = SourceMap::default();
        for file in &self.files {
            (file.length <= MAX_TEXT).then_some(())?;
            let text = file.text.clone().unwrap_or_else(|| " ".repeat(file.length));
            sources.add(file.name.clone(), text)?;
        }
        for &(base, number, es) in &self.languages {
            sources.restore_language(base, Language { number, es });
        }
        for one in &self.expansions {
            let (name, call, definition) = (one.name.as_str().into(), span(one.call), span(one.definition));
            // A use lies in an earlier one: otherwise, a walk outwards might not end.
            let number = sources.add_expansion(Expansion { name, call, definition });
            (call.expansion < number).then_some(())?;
        }
        for &(offset, number) in &self.renumbered {
            sources.renumber(Span::new(offset, offset), number);
        }
        let diagnostics: Option<Vec<Diagnostic>> = self.diagnostics.iter().map(diagnostic).collect();
        Some((sources, diagnostics?))
    }
}

/// Numbers the macro uses that are needed, outer ones first.
struct Writer<'a> {
    sources: &'a SourceMap,
    numbers: BTreeMap<ExpansionId, u32>,
    expansions: Vec<SavedExpansion>,
    /// Which files' texts are needed.
    shown: Vec<bool>,
}

impl Writer<'_> {
    fn diagnostic(&mut self, one: &Diagnostic) -> SavedDiagnostic {
        SavedDiagnostic {
            code: one.code.id.to_owned(),
            severity: one.severity as u8,
            message: one.message.clone(),
            primary: (self.span(one.primary.span), one.primary.message.clone()),
            secondary: one.secondary.iter().map(|label| (self.span(label.span), label.message.clone())).collect(),
            notes: one.notes.clone(),
            help: one.help.clone(),
            fixes: one.fixes.iter().map(|fix| self.fix(fix)).collect(),
            presented_line: one.presented_line,
        }
    }

    fn fix(&mut self, fix: &Fix) -> SavedFix {
        SavedFix {
            title: fix.title.clone(),
            safe: fix.applicability == Applicability::Safe,
            edits: fix.edits.iter().map(|edit| (self.span(edit.span), edit.text.clone())).collect(),
        }
    }

    fn span(&mut self, span: Span) -> SavedSpan {
        self.show(span);
        // From the inside to the outside; written the other way round.
        let mut chain = Vec::new();
        let mut inner = span.expansion.plain();
        while let Some(expansion) = self.sources.expansion(inner).filter(|_| !self.numbers.contains_key(&inner)) {
            chain.push((inner, expansion));
            inner = expansion.call.expansion.plain();
        }
        for (id, expansion) in chain.into_iter().rev() {
            let call = self.written(expansion.call);
            let definition = self.written(Span { expansion: ExpansionId::NONE, ..expansion.definition });
            self.expansions.push(SavedExpansion { name: expansion.name.to_string(), call, definition });
            self.numbers.insert(id, self.expansions.len() as u32);
        }
        self.written(span)
    }

    fn written(&mut self, span: Span) -> SavedSpan {
        self.show(span);
        let number = self.numbers.get(&span.expansion.plain()).copied().unwrap_or(0);
        (span.start, span.end, ExpansionId::new(number).marked_as(span.expansion).bits())
    }

    fn show(&mut self, span: Span) {
        let index = self.sources.file_of(span).and_then(|id| self.sources.files().position(|(other, _)| other == id));
        if let Some(shown) = index.and_then(|index| self.shown.get_mut(index)) {
            *shown = true;
        }
    }
}

fn span((start, end, expansion): SavedSpan) -> Span {
    Span { start, end, expansion: ExpansionId::new(expansion) }
}

fn diagnostic(saved: &SavedDiagnostic) -> Option<Diagnostic> {
    let code: &'static Code = codes::find(&saved.code)?;
    let severity = [Severity::Note, Severity::Warning, Severity::Error].into_iter();
    let label = |(at, message): &(SavedSpan, String)| Label { span: span(*at), message: message.clone() };
    Some(Diagnostic {
        code,
        severity: severity.into_iter().find(|severity| *severity as u8 == saved.severity)?,
        message: saved.message.clone(),
        primary: label(&saved.primary),
        secondary: saved.secondary.iter().map(label).collect(),
        notes: saved.notes.clone(),
        help: saved.help.clone(),
        fixes: saved.fixes.iter().map(fix).collect(),
        presented_line: saved.presented_line,
        // Nobody is shown it.
        lacking: None,
    })
}

fn fix(saved: &SavedFix) -> Fix {
    let edit = |(at, text): &(SavedSpan, String)| Edit { span: span(*at), text: text.clone() };
    Fix {
        title: saved.title.clone(),
        applicability: if saved.safe { Applicability::Safe } else { Applicability::Unsafe },
        edits: saved.edits.iter().map(edit).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::Saved;
    use crate::diagnostic::write;
    use crate::{Compiler, Options, Source, Stage};

    #[test]
    fn what_is_restored_is_shown_alike() {
        let text = "#version 150\n#define INNER(x) (x % 2.0)\n#define OUTER(x) INNER(x)\n#line 40\nout vec4 c;\n\
                    uniform float f;\nvoid main() { c = vec4(OUTER(f)); float unused = f == 0.1 ? 1 : 2.0; }\n";
        let source = Source { name: "a.frag".into(), text: text.into(), stage: Stage::Fragment };
        let done = Compiler::new(Options::default()).without_levels().compile(&[source]);
        assert!(!done.diagnostics.is_empty());
        let saved = Saved::new(&done.sources, done.diagnostics.iter());
        let json = serde_json::to_string(&saved).expect("JSON");
        let read: Saved = serde_json::from_str(&json).expect("the same");
        assert_eq!(read, saved);
        let (sources, diagnostics) = read.restore().expect("restored");
        assert_eq!(
            write::human(&sources, &diagnostics, false),
            write::human(&done.sources, done.diagnostics.iter(), false)
        );
        let findings = |sources, list: Vec<_>| write::json(&write::findings(sources, list), None);
        assert_eq!(
            findings(&sources, diagnostics.iter().collect()),
            findings(&done.sources, done.diagnostics.iter().collect())
        );
    }

    #[test]
    fn what_was_tampered_with_is_refused() {
        for text in [
            r#"{"files":[],"expansions":[{"name":"A","call":[1,2,1],"definition":[1,2,0]}],"renumbered":[],"diagnostics":[]}"#,
            r#"{"files":[{"name":"a","length":99999999999,"text":null}],"expansions":[],"renumbered":[],"diagnostics":[]}"#,
        ] {
            let saved: Saved = serde_json::from_str(text).expect("JSON");
            assert!(saved.restore().is_none());
        }
    }
}
