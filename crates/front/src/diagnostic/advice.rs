//! [`Advice`]: the help of a diagnostic, with the change of the text that it asks for.
//!
//! *In:* what a phase would like to see. *Out:* the sentence for people, and the [`Fix`] for programs. *Holds:* both come from
//! one value, so they never differ; advice that leaves something open has a sentence alone.

use super::{Applicability, Edit, Fix, shortened};
use crate::source::Span;

/// Where the text of an advice goes, seen from the primary span of the diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In place of the span.
    Over,
    /// In front of it.
    Before,
    /// Behind it.
    After,
    /// Around it: `...` in the text is what is there.
    Around,
}

/// The advice of a diagnostic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Advice {
    /// The sentence.
    pub sentence: String,
    /// The change, if it is one of the text.
    change: Option<(Applicability, Place, String)>,
}

impl Advice {
    /// A sentence and the change that it describes.
    pub fn new(
        applicability: Applicability,
        sentence: impl Into<String>,
        place: Place,
        text: impl Into<String>,
    ) -> Self {
        Self { sentence: sentence.into(), change: Some((applicability, place, text.into())) }
    }

    /// ``write `text` ``: the text in place of the span.
    pub fn write(applicability: Applicability, text: impl Into<String>) -> Self {
        let text = text.into();
        Self::new(applicability, format!("write `{text}`"), Place::Over, text)
    }

    /// ``did you mean `name`?``: the name in place of the span, which is a guess.
    pub fn meant(name: impl AsRef<str>) -> Self {
        let name = name.as_ref();
        Self::new(Applicability::Unsafe, format!("did you mean `{name}`?"), Place::Over, name)
    }

    /// The change of the text at a span.
    pub(super) fn fix(&self, span: Span) -> Option<Fix> {
        let (applicability, place, text) = self.change.as_ref()?;
        let title = match self.sentence.strip_prefix("did you mean ").and_then(|rest| rest.strip_suffix('?')) {
            Some(name) => format!("write {name}"),
            None => self.sentence.clone(),
        };
        let (start, end) = (Span { end: span.start, ..span }, Span { start: span.end, ..span });
        let edit = |span: Span, text: &str| Edit { span, text: text.to_owned() };
        let edits = match place {
            Place::Over => vec![edit(span, text)],
            Place::Before => vec![edit(start, text)],
            Place::After => vec![edit(end, text)],
            Place::Around => {
                let (before, after) = text.split_once("...").unwrap_or((text, ""));
                vec![edit(start, before), edit(end, after)]
            }
        };
        let edits = edits.into_iter().filter(|edit| !edit.text.is_empty() || edit.span.start < edit.span.end).collect();
        Some(Fix { title: shortened(title), applicability: *applicability, edits })
    }
}

impl From<String> for Advice {
    fn from(sentence: String) -> Self {
        Self { sentence, change: None }
    }
}

impl From<&str> for Advice {
    fn from(sentence: &str) -> Self {
        sentence.to_owned().into()
    }
}
