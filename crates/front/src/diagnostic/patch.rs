//! [`Patch`]: fixes that are applied together.
//!
//! *In:* [`FindingFix`]es, in the order of their importance. *Out:* the new text of each file that they change. *Holds:* a fix is
//! applied whole or not at all; no two edits overlap, and edits that several fixes share are made once.

use super::write::{FindingEdit, FindingFix, Region};
use crate::source::{SourceFile, SourceMap};
use std::collections::BTreeMap;
use std::ops::Range;

/// A line and a column.
type Place = (u32, u32);

/// The edits of a file in the order of where they begin. Those of one place are of one fix, in its order.
type Edits = Vec<FindingEdit>;

/// Edits of files that can be made at once.
#[derive(Clone, Debug, Default)]
pub struct Patch {
    files: BTreeMap<String, Edits>,
}

impl Patch {
    /// Adds a fix, unless it meets another one; returns whether it is in the patch.
    pub fn add(&mut self, fix: &FindingFix) -> bool {
        let is_free = |edit: &FindingEdit| self.files.get(&edit.region.file).is_none_or(|known| fits(known, edit));
        if fix.edits.is_empty() || !fix.edits.iter().all(is_free) {
            return false;
        }
        for edit in &fix.edits {
            let known = self.files.entry(edit.region.file.clone()).or_default();
            let start = from(&edit.region);
            let end = known.partition_point(|other| from(&other.region) <= start);
            let here = known.iter().take(end).rev().take_while(|other| from(&other.region) == start);
            if !here.into_iter().any(|other| other == edit) {
                known.insert(end, edit.clone());
            }
        }
        true
    }

    /// The names of the files that it changes.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// The new text of a file; `None` if an edit is outside of the text.
    pub fn applied(&self, file: &str, text: &str) -> Option<String> {
        let mut map = SourceMap::default();
        let id = map.add(file, text)?;
        let mut places = Places { file: map.file(id), last: None };
        let edits = self.files.get(file).into_iter().flatten();
        let place = |edit: &FindingEdit| Some((places.range(&edit.region)?, edit.text.clone()));
        let mut edits: Vec<(Range<usize>, String)> = edits.map(place).collect::<Option<_>>()?;
        edits.sort_by_key(|(range, _)| (range.start, range.end));
        let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
        let (mut new, mut from) = (String::with_capacity(text.len()), 0);
        for (range, replacement) in edits {
            new.push_str(text.get(from..range.start)?);
            new.push_str(&replacement.replace('\n', end));
            from = range.end;
        }
        new.push_str(text.get(from..)?);
        Some(new)
    }
}

fn from(region: &Region) -> Place {
    (region.line, region.column)
}

fn to(region: &Region) -> Place {
    (region.end_line, region.end_column)
}

/// Whether an edit is one of those that are known, or shares no character with any, and no place where both would insert. Known edits do
/// not overlap, so only its neighbors can meet it.
fn fits(known: &[FindingEdit], edit: &FindingEdit) -> bool {
    let (start, end) = (from(&edit.region), to(&edit.region));
    let (before, rest) = known.split_at(known.partition_point(|other| from(&other.region) < start));
    let last = before.last().map(|other| from(&other.region));
    let mut neighbors = before.iter().rev().take_while(|other| Some(from(&other.region)) == last);
    let (here, behind) = rest.split_at(rest.partition_point(|other| from(&other.region) == start));
    neighbors.all(|other| to(&other.region) <= start)
        && here.iter().all(|other| other == edit)
        && behind.first().is_none_or(|next| from(&next.region) >= end)
}

/// Offsets of places in a text. Those of one line are not counted from its beginning again, if they come in order.
struct Places<'t> {
    file: &'t SourceFile,
    /// The last place, with its offset.
    last: Option<(Place, usize)>,
}

impl Places<'_> {
    /// The bytes of a region.
    fn range(&mut self, region: &Region) -> Option<Range<usize>> {
        let start = self.offset(from(region))?;
        let end = self.offset(to(region))?;
        (start <= end).then_some(start..end)
    }

    /// The offset of a column, counted in characters from 1; the one past the end of a line is its end.
    fn offset(&mut self, (line, column): Place) -> Option<usize> {
        let range = self.file.line_range(line)?;
        let known = self.last.filter(|((of, before), _)| *of == line && *before <= column);
        let (before, at) = known.map_or((1, range.start), |((_, before), at)| (before, at));
        let text = self.file.text().get(at..range.end)?;
        let skipped = (column as usize).checked_sub(before as usize)?;
        let mut starts = text.char_indices().map(|(at, _)| at).chain([text.len()]);
        let offset = at + starts.nth(skipped)?;
        self.last = Some(((line, column), offset));
        Some(offset)
    }
}

#[cfg(test)]
mod tests {
    use super::Patch;
    use crate::diagnostic::Applicability;
    use crate::diagnostic::write::{FindingEdit, FindingFix, Region};

    fn fix(edits: &[(u32, u32, u32, u32, &str)]) -> FindingFix {
        let edit = |&(line, column, end_line, end_column, text): &(u32, u32, u32, u32, &str)| FindingEdit {
            region: Region { file: "a".into(), line, column, end_line, end_column },
            text: text.into(),
        };
        let edits = edits.iter().map(edit).collect();
        FindingFix { title: String::new(), applicability: Applicability::Safe, edits }
    }

    #[test]
    fn edits_are_made_together_or_not_at_all() {
        let mut patch = Patch::default();
        assert!(patch.add(&fix(&[(1, 1, 1, 2, "X"), (2, 3, 2, 3, "++")])));
        assert!(!patch.add(&fix(&[(3, 1, 3, 1, "lost"), (1, 1, 1, 3, "Y")])), "it meets the first");
        assert!(patch.add(&fix(&[(1, 1, 1, 2, "X"), (3, 1, 4, 1, "")])), "the shared edit is the same");
        assert!(!patch.add(&fix(&[(2, 3, 2, 3, "--")])), "two insertions at one place have no order");
        assert!(!patch.add(&fix(&[])));
        assert_eq!(patch.applied("a", "äbc\r\nde\r\nf\r\ng").as_deref(), Some("Xbc\r\nde++\r\ng"));
        assert_eq!(patch.applied("a", "one line"), None, "the text is another one");
    }
}
