//! [`Section`]: the sections of the specifications, and their numbers in each version.
//!
//! *In:* a citation (`GLSL 1.50 §4.3.4`) and the version of a source. *Out:* the citation with the section's number in that
//! version. *Holds:* the table is `sections.txt`, made from the contents of the specifications; a section that a version does
//! not have keeps its citation.

use std::borrow::Cow;
use std::sync::LazyLock;

/// A version of one of the two languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Edition {
    /// Whether the language is that of OpenGL ES.
    pub es: bool,
    /// 150 for 1.50.
    pub number: u16,
}

/// All versions, in the order of the columns.
pub static EDITIONS: [Edition; 17] = [
    desktop(110),
    desktop(120),
    desktop(130),
    desktop(140),
    desktop(150),
    desktop(330),
    desktop(400),
    desktop(410),
    desktop(420),
    desktop(430),
    desktop(440),
    desktop(450),
    desktop(460),
    es(100),
    es(300),
    es(310),
    es(320),
];

const fn desktop(number: u16) -> Edition {
    Edition { es: false, number }
}

const fn es(number: u16) -> Edition {
    Edition { es: true, number }
}

impl Edition {
    /// `GLSL 1.50`, `GLSL ES 3.00`
    pub fn name(self) -> String {
        let es = if self.es { "ES " } else { "" };
        format!("GLSL {es}{}.{:02}", self.number / 100, self.number % 100)
    }

    /// Whether a `#version` line may name the profile `core` or `compatibility` (GLSL 1.50 §3.3).
    pub fn has_profiles(self) -> bool {
        !self.es && self.number >= 150
    }

    fn column(self) -> Option<usize> {
        EDITIONS.iter().position(|edition| *edition == self)
    }
}

/// A section of the specifications.
#[derive(Debug)]
pub struct Section {
    /// The title in most versions.
    pub title: &'static str,
    /// The number in each version.
    numbers: Vec<Option<&'static str>>,
}

static SECTIONS: LazyLock<Vec<Section>> =
    LazyLock::new(|| include_str!("sections.txt").lines().filter_map(row).collect());

fn row(line: &'static str) -> Option<Section> {
    let (title, numbers) = line.split_once(" | ").filter(|_| !line.starts_with('#'))?;
    let number = |word: &'static str| (word != "-").then_some(word);
    Some(Section { title, numbers: numbers.split([' ', '|']).filter(|word| !word.is_empty()).map(number).collect() })
}

impl Section {
    /// All sections.
    pub fn all() -> &'static [Section] {
        &SECTIONS
    }

    /// The section with a number in a version: `4.3.4`.
    pub fn find(edition: Edition, number: &str) -> Option<&'static Section> {
        SECTIONS.iter().find(|section| section.number(edition) == Some(number))
    }

    /// The number in a version, if the version has the section.
    pub fn number(&self, edition: Edition) -> Option<&'static str> {
        self.numbers.get(edition.column()?).copied().flatten()
    }
}

/// A citation of sections of GLSL, taken apart.
struct Citation<'a> {
    edition: Edition,
    /// `§4.3 to §4.6`
    places: &'a str,
}

impl<'a> Citation<'a> {
    fn parse(text: &'a str) -> Option<Self> {
        let rest = text.strip_prefix("GLSL ")?;
        let (es, rest) = rest.strip_prefix("ES ").map_or((false, rest), |rest| (true, rest));
        let (version, places) = rest.split_once(' ')?;
        let number = version.replace('.', "").parse().ok()?;
        Some(Self { edition: Edition { es, number }, places })
    }

    /// The sections, each with its number as it is cited.
    fn sections(&self) -> Option<Vec<(&'a str, &'static Section)>> {
        let numbers = self.places.split([' ', ',']).filter_map(|word| word.strip_prefix('§'));
        numbers.map(|number| Some((number, Section::find(self.edition, number)?))).collect()
    }
}

/// A citation as it is in another version, without the sections of a list that this version lacks. Where it lacks all of them, or the
/// citation is of another document, it stays.
///
/// ```
/// use glisten_front::language::{Edition, cite};
///
/// assert_eq!(cite("GLSL 1.50 §7.5.1", Edition { es: false, number: 120 }), "GLSL 1.20 §7.5");
/// assert_eq!(cite("GLSL 1.50 §8.10", Edition { es: false, number: 120 }), "GLSL 1.50 §8.10");
/// assert_eq!(cite("GLSL 1.50 §5.8, §4.1.10", Edition { es: true, number: 300 }), "GLSL ES 3.00 §5.8");
/// ```
pub fn cite(citation: &'static str, edition: Edition) -> Cow<'static, str> {
    let known = Citation::parse(citation).filter(|cited| cited.edition != edition);
    match known.and_then(|cited| translated_in_part(&cited, edition)) {
        Some(places) => format!("{} {places}", edition.name()).into(),
        None => citation.into(),
    }
}

/// The sections of a list that a version has.
fn translated_in_part(cited: &Citation<'_>, edition: Edition) -> Option<String> {
    let parts = cited.places.split(", ").map(|places| Citation { places, ..*cited });
    let parts: Vec<String> = parts.filter_map(|part| translated(&part, edition)).collect();
    (!parts.is_empty()).then(|| parts.join(", "))
}

fn translated(cited: &Citation<'_>, edition: Edition) -> Option<String> {
    let sections = cited.sections()?;
    let mut text = cited.places.to_owned();
    // From the last on, so that a new number is not replaced again.
    for (number, section) in sections.iter().rev() {
        let place = text.rfind(&format!("§{number}"))?;
        let end = place + "§".len() + number.len();
        text.replace_range(place..end, &format!("§{}", section.number(edition)?));
    }
    Some(text)
}

/// The versions that have all sections of a citation, as runs of equal numbers: `GLSL 1.10 to 1.40 §7.3`.
pub fn runs(citation: &str) -> Vec<(Edition, Edition, String)> {
    let mut found: Vec<(Edition, Edition, String)> = Vec::new();
    let Some(cited) = Citation::parse(citation) else { return found };
    let mut open = false;
    for edition in EDITIONS {
        let Some(places) = translated(&cited, edition) else {
            open = false;
            continue;
        };
        match found.last_mut().filter(|(first, _, same)| open && first.es == edition.es && *same == places) {
            Some(run) => run.1 = edition,
            None => found.push((edition, edition, places)),
        }
        open = true;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::codes;
    use crate::language::FEATURES;

    #[test]
    fn each_row_has_a_column_for_each_version() {
        assert!(Section::all().len() > 90);
        for section in Section::all() {
            assert_eq!(section.numbers.len(), EDITIONS.len(), "{}", section.title);
            assert!(section.numbers.iter().any(Option::is_some), "{}", section.title);
        }
    }

    #[test]
    fn all_that_is_cited_is_in_the_table() {
        for code in codes::all().filter(|code| code.section.starts_with("GLSL ")) {
            let cited = Citation::parse(code.section);
            assert!(cited.is_some_and(|cited| cited.sections().is_some()), "{}: {}", code.id, code.section);
        }
        for row in FEATURES {
            let number = row.section.trim_start_matches('§');
            assert!(row.origin().is_some_and(|first| Section::find(first, number).is_some()), "{}", row.name);
        }
    }

    #[test]
    fn citations_are_of_the_version_of_the_source() {
        let cited = |text, es, number| cite(text, Edition { es, number }).into_owned();
        assert_eq!(cited("GLSL 1.50 §4.3.4, §4.3.8.1", false, 420), "GLSL 4.20 §4.3.4, §4.4.1");
        assert_eq!(cited("GLSL 1.50 §4.3 to §4.6", true, 310), "GLSL ES 3.10 §4.3 to §4.8");
        assert_eq!(cited("GLSL 1.50 §3.3", true, 100), "GLSL ES 1.00 §3.4");
        assert_eq!(cited("OpenGL 3.2 §3.9.2", false, 330), "OpenGL 3.2 §3.9.2");
        assert_eq!(cited("GLSL ES 3.00 §4.5.4", false, 150), "GLSL 1.50 §4.5.3");
    }

    #[test]
    fn runs_join_versions_of_equal_numbers() {
        let told: Vec<String> = runs("GLSL 1.50 §4.1.10")
            .iter()
            .map(|(first, last, places)| format!("{} to {} {places}", first.name(), last.name()))
            .collect();
        assert_eq!(told, ["GLSL 1.20 to GLSL 4.60 §4.1.10"]);
        assert_eq!(runs("GLSL 1.50 §7.5.1").len(), 3);
    }
}
