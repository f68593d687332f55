//! `#include` (ARB_shading_language_include, GL_GOOGLE_include_directive).

use super::{Extensions, FileId, Preprocessor, Session, Span, codes, kind};
use crate::diagnostic::{Diagnostic, codes::general};
use crate::source::{IncludeForm, Included};

/// How many files may be inside each other.
const MAX_DEPTH: usize = 64;

impl Preprocessor<'_> {
    /// `#include "x"`, `#include <x>`
    pub(super) fn include(&mut self, session: &mut Session<'_>, directive: Span) {
        let header = self.frames.last_mut().and_then(|frame| frame.lexer.header_name());
        let Some(header) = header else {
            let token = self.line_token(session);
            return self.malformed(session, token, "`#include` needs a name in quotes or angle brackets");
        };
        self.expect_line_end(session, "#include");
        let whole = session.sources.join(directive, header);
        if !self.extensions.contains(Extensions::INCLUDE) {
            let diagnostic = kind::INCLUDE_WITHOUT_EXTENSION
                .diagnostic(self.strict, whole, "`#include` without the extension that brings it")
                .help("write `#extension GL_ARB_shading_language_include : require` before it");
            session.report(diagnostic);
        }
        let Some(file) = self.find_include(session, header) else { return };
        if self.once.contains(&file) {
            return;
        }
        if self.frames.len() >= MAX_DEPTH {
            let name = session.sources.file(file).name();
            let message = format!("files include each other more than {MAX_DEPTH} levels deep, `{name}` last");
            session
                .report(Diagnostic::new(&codes::INCLUDE_TOO_DEEP, whole, message).help("write `#pragma once` into it"));
            return self.stop();
        }
        self.enter(session, file, whole);
    }

    /// The file of an include; each is asked for and loaded once.
    fn find_include(&mut self, session: &mut Session<'_>, header: Span) -> Option<FileId> {
        let from = self.frames.last()?.file;
        let quoted = session.sources.snippet(header);
        let form = if quoted.starts_with('"') { IncludeForm::Quoted } else { IncludeForm::Angled };
        let path = quoted.get(1..quoted.len().saturating_sub(1)).unwrap_or("").to_owned();
        if let Some(&file) = self.resolved.get(&(from, form, path.clone())) {
            return Some(file);
        }
        let included = self.includes.resolve(&path, form, session.sources.file(from).name());
        let included = match included {
            Ok(included) => included,
            Err(reason) => {
                let message = format!("the include `{path}` was not found");
                session.report(Diagnostic::new(&codes::INCLUDE_NOT_FOUND, header, message).here(reason));
                return None;
            }
        };
        let Some(file) = load(session, included) else {
            session.report(Diagnostic::new(&general::TOO_LARGE, header, "there is no room for the included text"));
            self.stop();
            return None;
        };
        self.resolved.insert((from, form, path), file);
        Some(file)
    }
}

/// The file in the map, where another include or another stage may have put it: what is wrong in it is reported once.
fn load(session: &mut Session<'_>, included: Included) -> Option<FileId> {
    let known = session.sources.files().find(|(_, file)| file.name() == included.name && *file.text() == included.text);
    match known.map(|(id, _)| id) {
        Some(id) => Some(id),
        None => session.sources.add(included.name, included.text),
    }
}
