//! [`Report`]: the account of a port: each program, each file, what could not be done and why.
//!
//! *In:* outcomes. *Out:* JSON by serde, and a page. *Holds:* the order is that of names.

use glisten_page::highlight::{Language, html};
use glisten_page::{Page, inline_code};
use minijinja::{Value, context};
use serde::Serialize;

const PAGE: Page =
    Page { templates: &[("port.html", include_str!("page.html"))], styles: &[include_str!("page.css")], scripts: &[] };

/// The result for a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Its texts are new.
    Ported,
    /// It needs no change.
    Unchanged,
    /// It is written for the host already.
    Already,
    /// It stays as it was, for a reason.
    Refused,
}

/// A program.
#[derive(Clone, Debug, Serialize)]
pub struct ProgramReport {
    /// Its name.
    pub name: String,
    /// Its files in the old tree.
    pub files: Vec<String>,
    /// Its files in the new tree.
    pub new: Vec<String>,
    /// The stage of each file: `vertex`, `geometry` or `fragment`.
    pub stages: Vec<&'static str>,
    /// The result.
    pub result: Outcome,
    /// Why it stays as it was.
    pub because: Option<String>,
    /// `proved`, `inconclusive` or `failed`, if its pictures were compared.
    pub proof: Option<String>,
    /// The figures of the comparison.
    pub evidence: Option<String>,
    /// Sentences for the author of the host.
    pub notes: Vec<String>,
}

/// A file.
#[derive(Clone, Debug, Serialize)]
pub struct FileReport {
    /// Its name in the old tree.
    pub file: String,
    /// Its name in the new tree.
    pub new: String,
    /// The changes, in sentences.
    pub done: Vec<String>,
    /// Sentences for the author of the text.
    pub notes: Vec<String>,
    /// The old and the new text.
    #[serde(skip)]
    pub texts: (String, String),
}

/// The account of a port.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The old tree.
    pub pack: String,
    /// The host.
    pub host: String,
    /// The programs.
    pub programs: Vec<ProgramReport>,
    /// The files that change.
    pub files: Vec<FileReport>,
    /// How many other files are copied.
    pub copied: usize,
}

impl Report {
    /// How many programs have an outcome.
    pub fn count(&self, result: Outcome) -> usize {
        self.programs.iter().filter(|program| program.result == result).count()
    }

    /// How many programs have a proof of this word.
    pub fn proofs(&self, word: &str) -> usize {
        self.programs.iter().filter(|program| program.proof.as_deref() == Some(word)).count()
    }

    /// The sentence for people.
    pub fn summary(&self) -> String {
        let n = self.programs.len();
        let plural = if n == 1 { "" } else { "s" };
        let of = |number: usize, one: &str, many: &str| format!("{number} {}", if number == 1 { one } else { many });
        let mut text = format!(
            "{n} program{plural}: {} ported, {} unchanged, {} for it already, {}; {}, {}",
            self.count(Outcome::Ported),
            self.count(Outcome::Unchanged),
            self.count(Outcome::Already),
            of(self.count(Outcome::Refused), "left as it was", "left as they were"),
            of(self.files.len(), "file changes", "files change"),
            of(self.copied, "is copied", "are copied"),
        );
        if self.programs.iter().any(|program| program.proof.is_some()) {
            let [proved, open, failed] = ["proved", "inconclusive", "failed"].map(|word| self.proofs(word));
            text.push_str(&format!("; {proved} proved, {open} inconclusive, {failed} failed"));
        }
        text
    }
}

/// The page.
///
/// # Errors
/// The message of the template engine, which only a broken template causes.
pub fn page(report: &Report) -> Result<String, String> {
    let safe = |text: &String| Value::from_safe_string(inline_code(text));
    let programs: Vec<Value> = report
        .programs
        .iter()
        .map(|one| {
            let result = match one.result {
                Outcome::Ported => "ported",
                Outcome::Unchanged => "unchanged",
                Outcome::Already => "for it already",
                Outcome::Refused => "left as it was",
            };
            context! {
                name => &one.name, files => one.files.join(", "), result, refused => one.result == Outcome::Refused,
                because => one.because.as_ref().map(safe), proof => &one.proof, evidence => one.evidence.as_ref().map(safe),
                notes => one.notes.iter().map(safe).collect::<Vec<_>>(),
            }
        })
        .collect();
    let files: Vec<Value> = report
        .files
        .iter()
        .map(|one| {
            let (old, new) = (&one.texts.0, &one.texts.1);
            let lines = |text: &str| Value::from_safe_string(html(text, Language::Glsl));
            context! {
                file => &one.file, new => &one.new, done => one.done.iter().map(safe).collect::<Vec<_>>(),
                notes => one.notes.iter().map(safe).collect::<Vec<_>>(), before => lines(old), after => lines(new),
            }
        })
        .collect();
    let values = context! {
        pack => &report.pack, host => &report.host, summary => report.summary(), programs, files,
        version => env!("CARGO_PKG_VERSION"),
    };
    PAGE.render(values).map_err(|error| error.to_string())
}
