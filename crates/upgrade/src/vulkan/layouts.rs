//! [`Layouts`]: the blocks that the loose uniforms of a tree go into, with the offsets of their members.
//!
//! *In:* files with their facts. *Out:* for each program the block of the files that it alone has; for each other file with loose
//! uniforms a block of its own, which is the same for all programs. *Holds:* where all loose uniforms of a program are in its own
//! files, their offsets are those of the link, and of `glisten reflect`.

use super::Compiled;
use super::Key;
use super::facts::{Fact, Facts, Loose};
use super::files::Files;
use super::numbers::{Numbers, Space};
use glisten_front::hir::Stage;
use std::collections::{BTreeMap, BTreeSet};

/// A block.
#[derive(Clone, Debug, Default)]
pub(super) struct Layout {
    /// The offset of each member, by the file and the place of its declaration.
    pub(super) offsets: BTreeMap<(Key, usize), u32>,
    /// The members by their names: the offset, and the type, if it needs no struct.
    pub(super) members: BTreeMap<String, (u32, Option<String>)>,
    /// The offset of the framebuffer's height.
    pub(super) height: Option<u32>,
    /// The node of its binding.
    pub(super) node: usize,
    /// Whether it has a member that no program sees.
    pub(super) has_unseen: bool,
    end: u32,
}

impl Layout {
    fn place(&mut self, (align, size): (u32, u32)) -> u32 {
        let offset = self.end.next_multiple_of(align.max(1));
        self.end = offset.saturating_add(size);
        // What follows an array, a matrix or a struct begins at a multiple of its alignment.
        if size > 16 {
            self.end = self.end.next_multiple_of(align.max(1));
        }
        offset
    }

    /// Adds a member, unless one of its name and size is there.
    fn add(&mut self, key: &Key, place: usize, loose: &Loose, at: Option<u32>) {
        let known = self.members.get(&loose.name).map(|(offset, _)| *offset);
        let is_seen = loose.offset != u32::MAX;
        self.has_unseen |= !is_seen;
        let offset = at.or(known.filter(|_| is_seen)).unwrap_or_else(|| self.place(loose.extent));
        self.end = self.end.max(offset.saturating_add(loose.extent.1));
        self.offsets.insert((key.clone(), place), offset);
        self.members.entry(loose.name.clone()).or_insert_with(|| (offset, loose.plain.clone()));
    }

    fn add_height(&mut self, at: Option<u32>) {
        let offset = at.unwrap_or_else(|| self.place((4, 4)));
        self.end = self.end.max(offset.saturating_add(4));
        self.height = Some(offset);
    }
}

/// The blocks of a tree.
#[derive(Default)]
pub(super) struct Layouts {
    pub(super) of_units: BTreeMap<usize, Layout>,
    pub(super) of_files: BTreeMap<Key, Layout>,
}

impl Layouts {
    /// The blocks. The fragment sources in `turned` need the framebuffer's height.
    pub(super) fn new(
        programs: &[Compiled<'_>],
        files: &Files,
        facts: &Facts,
        turned: &BTreeSet<Key>,
        numbers: &mut Numbers,
    ) -> Self {
        let mut layouts = Self::default();
        for compiled in programs {
            layouts.of_unit(compiled, files, facts, turned, numbers);
        }
        for (key, file) in files.all.iter().filter(|(_, file)| file.owner().is_none()) {
            let loose = loose(facts, key);
            let needs_height = turned.contains(key);
            if loose.is_empty() && !needs_height {
                continue;
            }
            let mut layout = Layout::default();
            loose.iter().for_each(|(place, one)| layout.add_own(key, *place, one));
            if needs_height {
                layout.add_height(None);
            }
            let name = format!("\n{}", key.0);
            let units: BTreeSet<usize> = file.readers.iter().map(|(unit, _)| *unit).collect();
            let nodes: Vec<usize> =
                units.iter().map(|unit| numbers.node(*unit, Space::Buffer, &name, 1, None)).collect();
            nodes.iter().for_each(|node| numbers.join(*node, nodes.first().copied().unwrap_or(*node)));
            layout.node = nodes.first().copied().unwrap_or(0);
            layouts.of_files.insert(key.clone(), layout);
        }
        layouts
    }

    fn of_unit(
        &mut self,
        compiled: &Compiled<'_>,
        files: &Files,
        facts: &Facts,
        turned: &BTreeSet<Key>,
        numbers: &mut Numbers,
    ) {
        let unit = compiled.index;
        let own: Vec<&Key> =
            files.all.iter().filter(|(_, file)| file.owner() == Some(unit)).map(|(key, _)| key).collect();
        let mut all: Vec<(&Key, usize, &Loose)> =
            own.iter().flat_map(|key| loose(facts, key).into_iter().map(|(place, one)| (*key, place, one))).collect();
        all.sort_by_key(|(_, place, one)| (one.offset, *place));
        let needs_height = own.iter().any(|key| turned.contains(*key));
        if all.is_empty() && !needs_height {
            return;
        }
        let interface = &compiled.program.interface;
        let names: BTreeSet<&str> = all.iter().map(|(_, _, one)| one.name.as_str()).collect();
        let is_whole =
            interface.roots.iter().filter(|root| root.block.is_none()).all(|root| names.contains(root.name.as_str()));
        let mut layout = Layout::default();
        for (key, place, one) in all.iter().filter(|(_, _, one)| one.offset != u32::MAX) {
            layout.add(key, *place, one, is_whole.then_some(one.offset));
        }
        if needs_height {
            layout.add_height(interface.framebuffer_height.filter(|_| is_whole));
        }
        for (key, place, one) in all.iter().filter(|(_, _, one)| one.offset == u32::MAX) {
            layout.add(key, *place, one, None);
        }
        let wanted = interface.loose.map(|(slot, _)| slot.binding);
        layout.node = numbers.node(unit, Space::Buffer, "\n", 1, wanted);
        self.of_units.insert(unit, layout);
    }
}

impl Layout {
    /// Adds a member of a file that has a block of its own. Alternatives of one name have places of their own.
    fn add_own(&mut self, key: &Key, place: usize, loose: &Loose) {
        self.has_unseen |= loose.offset == u32::MAX;
        let offset = self.place(loose.extent);
        self.offsets.insert((key.clone(), place), offset);
        self.members.entry(loose.name.clone()).or_insert_with(|| (offset, loose.plain.clone()));
    }
}

/// The loose uniforms of a file.
pub(super) fn loose<'f>(facts: &'f Facts, key: &Key) -> Vec<(usize, &'f Loose)> {
    let all = facts.all.get(key).into_iter().flatten();
    let one = |(place, fact): (&usize, &'f Fact)| match fact {
        Fact::Loose(loose) => Some((*place, loose)),
        _ => None,
    };
    all.filter_map(one).collect()
}

/// The name of the block of a file with its own, or of a stage with its own.
pub(super) fn block_name(key: &Key, stage: Option<Stage>) -> String {
    if let Some(stage) = stage {
        return format!("{}Uniforms", if stage == Stage::Vertex { "Vertex" } else { "Fragment" });
    }
    let stem =
        std::path::Path::new(&key.0).file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let mut name = String::new();
    for word in stem.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|word| !word.is_empty()) {
        let mut letters = word.chars();
        name.extend(letters.next().map(|first| first.to_ascii_uppercase()));
        name.extend(letters);
    }
    if name.starts_with(|first: char| first.is_ascii_digit()) || name.is_empty() {
        name.insert_str(0, "File");
    }
    format!("{name}Uniforms")
}

#[cfg(test)]
mod tests {
    use super::block_name;

    #[test]
    fn blocks_are_called_like_their_files() {
        assert_eq!(block_name(&("a/soft_fog-2.glsl".into(), None), None), "SoftFog2Uniforms");
        assert_eq!(block_name(&("2d".into(), None), None), "File2dUniforms");
    }
}
