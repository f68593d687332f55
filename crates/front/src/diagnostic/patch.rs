//! [`Patch`]: fixes that are applied together.
//!
//! *In:* [`FindingFix`]es, in the order of their importance. *Out:* the new text of each file that they change. *Holds:* a fix is
//! applied whole or not at all; no two edits overlap, and edits that several fixes share are made once.

use super::write::{FindingEdit, FindingFix, Region};
use crate::source::{SourceFile, SourceMap};
use std::collections::BTreeMap;
use std::ops::Range;

/// Edits of files that can be made at once.
#[derive(Clone, Debug, Default)]
pub struct Patch {
    files: BTreeMap<String, Vec<FindingEdit>>,
}

impl Patch {
    /// Adds a fix, unless it meets another one; returns whether it is in the patch.
    pub fn add(&mut self, fix: &FindingFix) -> bool {
        let fits = |edit: &FindingEdit| {
            let known = self.files.get(&edit.region.file).into_iter().flatten();
            known.into_iter().all(|other| other == edit || !meet(&other.region, &edit.region))
        };
        if fix.edits.is_empty() || !fix.edits.iter().all(fits) {
            return false;
        }
        for edit in &fix.edits {
            let list = self.files.entry(edit.region.file.clone()).or_default();
            if !list.contains(edit) {
                list.push(edit.clone());
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
        let edits = self.files.get(file).into_iter().flatten();
        let place = |edit: &FindingEdit| Some((range(map.file(id), &edit.region)?, edit.text.clone()));
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

/// Whether two regions of a file share a character, or a place where both would insert.
fn meet(a: &Region, b: &Region) -> bool {
    let (from, to) = (|at: &Region| (at.line, at.column), |at: &Region| (at.end_line, at.end_column));
    from(a) == from(b) || (from(a) < to(b) && from(b) < to(a))
}

/// The bytes of a region in a text.
fn range(file: &SourceFile, region: &Region) -> Option<Range<usize>> {
    let start = offset(file, region.line, region.column)?;
    let end = offset(file, region.end_line, region.end_column)?;
    (start <= end).then_some(start..end)
}

/// The offset of a column, counted in characters from 1; the one past the end of a line is its end.
fn offset(file: &SourceFile, line: u32, column: u32) -> Option<usize> {
    let range = file.line_range(line)?;
    let text = file.text().get(range.clone())?;
    let skipped = (column as usize).checked_sub(1)?;
    let mut starts = text.char_indices().map(|(at, _)| at).chain([text.len()]);
    starts.nth(skipped).map(|at| range.start + at)
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
