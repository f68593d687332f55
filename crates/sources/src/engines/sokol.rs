//! Files of sokol-shdc: `@vs name`, `@fs name`, `@block name`, each up to `@end`, and `@program name vs fs`.
//!
//! *In:* a text. *Out:* its programs; without a `@program` line, the first of each stage. *Holds:* a block that a stage includes
//! is part of it at the place where the block is written, which is before the stage.

use super::part::{Member, Part};
use glisten_front::Stage;
use std::ops::Range;

/// The largest number of sections and of programs that are read.
const MAX_SECTIONS: usize = 128;
/// The largest number of tags in a section.
const MAX_TAGS: usize = 1024;

/// A section of the file.
struct Section<'a> {
    /// The tag that opens it: `vs`, `fs`, `block`.
    tag: &'a str,
    name: &'a str,
    /// Its lines, without those of the tags.
    inside: Range<usize>,
    /// The blocks that it includes.
    includes: Vec<&'a str>,
    /// The lines of tags in it.
    tags: Vec<Range<usize>>,
}

/// The tag of a line and its arguments.
fn tag(line: &str) -> Option<(&str, Vec<&str>)> {
    let line = line.trim_start();
    let line = line.strip_prefix("#pragma sokol").map_or(line, str::trim_start);
    let mut words = line.strip_prefix('@')?.split_whitespace();
    Some((words.next()?, words.collect()))
}

/// The sections and the `@program` lines of a text.
fn read(text: &str) -> (Vec<Section<'_>>, Vec<[&str; 3]>) {
    let (mut sections, mut programs) = (Vec::new(), Vec::new());
    let mut open: Option<Section<'_>> = None;
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let range = at..at + line.len();
        at = range.end;
        let Some((tag, arguments)) = tag(line) else { continue };
        match (tag, arguments.as_slice(), &mut open) {
            ("vs" | "fs" | "block" | "cs", [name, ..], None) => {
                let (includes, tags) = (Vec::new(), Vec::new());
                open = Some(Section { tag, name, inside: range.end..text.len(), includes, tags });
            }
            ("end", _, section @ Some(_)) => {
                let section =
                    section.take().map(|section| Section { inside: section.inside.start..range.start, ..section });
                sections.extend(section);
            }
            (_, _, Some(section)) if section.tags.len() >= MAX_TAGS => {}
            ("include_block", [name, ..], Some(section)) => {
                section.includes.push(name);
                section.tags.push(range);
            }
            ("program", [name, vertex, fragment, ..], None) => programs.push([*name, *vertex, *fragment]),
            (_, _, Some(section)) => section.tags.push(range),
            _ => {}
        }
    }
    (sections, programs)
}

/// The programs of a file of sokol-shdc.
pub(super) fn members(text: &str) -> Vec<Member> {
    let (mut sections, mut programs) = read(text);
    sections.truncate(MAX_SECTIONS);
    programs.truncate(MAX_SECTIONS);
    let named = |tag: &str, name: &str| sections.iter().find(|other| other.tag == tag && other.name == name);
    let program = |vertex: Option<&Section<'_>>, fragment: Option<&Section<'_>>| {
        let stages = [(Stage::Vertex, vertex), (Stage::Fragment, fragment)];
        let parts = stages.into_iter().filter_map(|(stage, section)| Some(part(text, &sections, stage, section?)));
        parts.collect::<Vec<_>>()
    };
    let first = |tag: &str| sections.iter().find(|section| section.tag == tag);
    let members: Vec<Member> = if programs.is_empty() {
        vec![Member { name: None, parts: program(first("vs"), first("fs")) }]
    } else {
        let alone = programs.len() == 1;
        let member = |[name, vertex, fragment]: &[&str; 3]| Member {
            name: (!alone).then(|| (*name).to_owned()),
            parts: program(named("vs", vertex), named("fs", fragment)),
        };
        programs.iter().map(member).collect()
    };
    members.into_iter().filter(|member| !member.parts.is_empty()).collect()
}

/// A section with the blocks that it includes.
fn part(text: &str, sections: &[Section<'_>], stage: Stage, section: &Section<'_>) -> Part {
    let mut wanted: Vec<&Section<'_>> = vec![section];
    let mut next = 0;
    while let Some(includes) = wanted.get(next).map(|section| &section.includes) {
        for name in includes {
            let block = sections.iter().find(|other| other.tag == "block" && other.name == *name);
            let is_new = |block: &&Section<'_>| wanted.iter().all(|known| known.inside != block.inside);
            if let Some(block) = block.filter(is_new) {
                wanted.push(block);
            }
        }
        next += 1;
    }
    wanted.sort_by_key(|section| section.inside.start);
    let (mut others, mut at) = (Vec::new(), 0);
    for section in wanted {
        others.push(at..section.inside.start);
        others.extend(section.tags.iter().cloned());
        at = section.inside.end;
    }
    others.push(at..text.len());
    Part { stage, others, defines: Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::members;

    #[test]
    fn programs_are_taken_apart() {
        let text = "@ctype mat4 m\n@block b\nB\n@end\n@vs v\n@include_block b\nV\n@end\n@fs f\nF\n@end\n@fs g\n@glsl_options x\n\
                    @include_block b\nG\n@end\n@program one v f\n#pragma sokol @program two v g\n";
        let shown: Vec<(Option<String>, Vec<String>)> = members(text)
            .into_iter()
            .map(|member| {
                let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
                (member.name.clone(), member.parts.iter().map(|part| words(&part.text(text))).collect())
            })
            .collect();
        let strings = |texts: [&str; 2]| texts.map(str::to_owned).to_vec();
        assert_eq!(shown, [(Some("one".into()), strings(["B V", "F"])), (Some("two".into()), strings(["B V", "B G"]))]);
        assert!(members("@vs without an end").is_empty() && members("x").is_empty());
        assert_eq!(members("@vs a\n@end\n")[0].parts.len(), 1);
    }
}
