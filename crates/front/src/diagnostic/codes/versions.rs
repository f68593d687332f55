//! The versions of the language in which each rule is in force.
//!
//! *In:* a code. *Out:* its first and last version in both languages. *Holds:* a code without a row is in force in all
//! versions that glisten reads; what an extension brings earlier is not counted.

use super::Code;
use crate::language::{EDITIONS, Edition};

/// The first and the last version of one language; `None` where the rule is in none.
type Range = Option<(u16, u16)>;

const DESKTOP: (u16, u16) = (110, 460);
const ES: (u16, u16) = (100, 320);
const BLOCKS: (Range, Range) = (Some((140, 460)), Some((300, 320)));
const GEOMETRY: (Range, Range) = (Some((150, 460)), None);
/// Of a geometry stage, which ES has, too.
const GEOMETRY_STAGE: (Range, Range) = (Some((150, 460)), Some((320, 320)));
const SWITCH: (Range, Range) = (Some((130, 460)), Some((300, 320)));
const ONE_NAME_SPACE: (Range, Range) = (Some((120, 460)), Some(ES));
const BEFORE_420: (Range, Range) = (Some((110, 410)), Some(ES));

/// Codes that are not in force everywhere.
static RANGES: &[(&str, (Range, Range))] = &[
    ("E0120", (Some((110, 110)), None)),
    ("W0101", (Some((110, 410)), Some((100, 100)))),
    ("W0117", (Some((110, 120)), None)),
    ("E0210", SWITCH),
    ("E0213", BLOCKS),
    ("E0214", BEFORE_420),
    ("E0307", ONE_NAME_SPACE),
    ("E0309", BLOCKS),
    ("E0311", ONE_NAME_SPACE),
    ("E0312", ONE_NAME_SPACE),
    ("E0313", GEOMETRY_STAGE),
    ("E0412", (Some((110, 420)), Some((100, 300)))),
    ("E0418", (Some((130, 330)), Some((300, 310)))),
    ("E0420", (Some((420, 460)), None)),
    ("E0421", (Some((130, 460)), Some(ES))),
    ("E0423", SWITCH),
    ("W0501", BEFORE_420),
    ("W0602", (None, Some((100, 100)))),
    ("E0504", SWITCH),
    ("E0505", SWITCH),
    ("E0506", SWITCH),
    ("E0507", SWITCH),
    ("E0511", ONE_NAME_SPACE),
    ("E0602", (Some((130, 410)), Some((300, 300)))),
    ("E0604", BLOCKS),
    ("E0605", BLOCKS),
    ("E0606", BLOCKS),
    ("E0608", SWITCH),
    ("E0611", BLOCKS),
    ("E0612", GEOMETRY_STAGE),
    ("E0613", GEOMETRY_STAGE),
    ("E0614", GEOMETRY),
    ("E0615", (Some(DESKTOP), Some((100, 100)))),
    ("E0616", ONE_NAME_SPACE),
    ("E0618", (None, Some(ES))),
    ("E0619", (None, Some((300, 320)))),
    ("E0704", (Some((130, 420)), Some((300, 320)))),
    ("E0705", (Some((120, 420)), Some((100, 300)))),
    ("E0706", GEOMETRY),
    ("E0708", (Some((120, 460)), None)),
    ("E0709", BLOCKS),
    ("E0712", (Some((130, 460)), None)),
    ("E0718", BLOCKS),
    ("E0719", GEOMETRY_STAGE),
    ("E0720", GEOMETRY_STAGE),
    ("E0725", GEOMETRY_STAGE),
    ("E0726", GEOMETRY_STAGE),
    ("E0727", GEOMETRY),
    ("E0728", GEOMETRY),
    ("E0732", (None, Some(ES))),
    ("E0731", (Some((410, 460)), Some((310, 320)))),
    ("E0733", (Some((430, 460)), Some((310, 320)))),
    ("E0734", (Some((440, 460)), Some((310, 320)))),
    ("W0703", GEOMETRY_STAGE),
    ("E0801", GEOMETRY_STAGE),
    ("L0004", SWITCH),
    ("L0076", (None, Some((100, 100)))),
];

impl Code {
    /// Whether the rule is one of the language, which has versions.
    pub fn is_of_language(&self) -> bool {
        self.section.starts_with("GLSL ") || RANGES.iter().any(|row| row.0 == self.id)
    }

    /// The first and the last version of OpenGL's language, and of OpenGL ES's, in which the rule is in force.
    pub fn versions(&self) -> impl Iterator<Item = (Edition, Edition)> {
        let known = RANGES.iter().find(|row| row.0 == self.id).map(|row| row.1);
        let (desktop, es) = known.unwrap_or((Some(DESKTOP), Some(ES)));
        let edition = |es, number| Edition { es, number };
        let of = move |es, range: Range| range.map(|(first, last)| (edition(es, first), edition(es, last)));
        of(false, desktop).into_iter().chain(of(true, es))
    }

    /// Whether the rule is in force in a version.
    pub fn is_in_force(&self, edition: Edition) -> bool {
        EDITIONS.contains(&edition)
            && self
                .versions()
                .any(|(first, last)| first.es == edition.es && (first.number..=last.number).contains(&edition.number))
    }
}

#[cfg(test)]
mod tests {
    use super::RANGES;
    use crate::diagnostic::{Example, codes};
    use crate::language::{EDITIONS, Edition, Stage};
    use crate::{Compiler, Options, Source};

    #[test]
    fn rows_name_codes_and_versions() {
        for (id, (desktop, es)) in RANGES {
            assert!(codes::find(id).is_some(), "{id}");
            for (is_es, range) in [(false, desktop), (true, es)] {
                for number in range.iter().flat_map(|(first, last)| [*first, *last]) {
                    assert!(EDITIONS.contains(&Edition { es: is_es, number }), "{id}: {number}");
                }
            }
        }
    }

    /// Whether a version raises a code for its example.
    fn is_raised(code: &codes::Code, stage: Stage, text: &str, edition: Edition) -> bool {
        let es = if edition.es && edition.number > 100 { " es" } else { "" };
        let precision = if edition.es { "precision highp float;\n" } else { "" };
        let body: String = text.lines().filter(|line| !line.starts_with("#version")).collect::<Vec<_>>().join("\n");
        let text = format!("#version {}{es}\n{precision}{body}\n", edition.number);
        let source = Source { name: "a".into(), text: text.into(), stage };
        let done = Compiler::new(Options::default()).compile(&[source]);
        done.diagnostics.iter().any(|finding| finding.code.id == code.id)
    }

    /// A rule that begins with or after 1.30, or ends before 4.60, is broken by its example from its first version on to its
    /// last, and not after it.
    #[test]
    fn examples_break_their_rules_from_the_first_version_to_the_last() {
        let (mut count, mut wrong) = (0, Vec::new());
        for code in RANGES.iter().filter_map(|row| codes::find(row.0)) {
            let (stage, text) = match code.bad {
                Example::Vertex(text) => (Stage::Vertex, text),
                Example::Fragment(text) => (Stage::Fragment, text),
                Example::Geometry(text) => (Stage::Geometry, text),
                _ => continue,
            };
            let readable = |edition: &Edition| edition.number >= if edition.es { 300 } else { 150 };
            for edition in EDITIONS.into_iter().filter(readable) {
                let raised = is_raised(code, stage, text, edition);
                let told = format!("{} in {}", code.id, edition.name());
                if raised != code.is_in_force(edition) && !EXCEPT.contains(&code.id) {
                    wrong.push(told);
                }
                count += 1;
            }
        }
        assert!(wrong.is_empty(), "{wrong:?}");
        assert!(count > 300, "{count}");
    }

    /// Codes whose examples need more of a version than the rule, or name something else that is missing in it.
    const EXCEPT: [&str; 8] = ["E0313", "E0420", "E0606", "E0612", "E0615", "E0618", "W0703", "E0801"];
}
