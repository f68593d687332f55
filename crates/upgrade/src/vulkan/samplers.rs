//! Samplers in structs, which Vulkan does not have: each becomes a uniform of its own, next to that of the struct.
//!
//! *In:* a program, compiled. *Out:* its sources without such members, and sentences about the new names; nothing where edits do not say
//! it. *Holds:* structs that an included file declares, arrays of structs, and members in one declaration with others stay as they are.
//!
//! `uniform Material material;` with a `sampler2D diffuse` is `uniform sampler2D material_diffuse;` after it, and the struct has what is
//! left. A struct of samplers alone goes. A uniform that defines its struct becomes two declarations first.

use super::super::rewrite::{Edit, applied, comment_above};
use super::super::tokens::{Token, tokens};
use super::declarations::is_line_comment;
use super::output::{Note, TreeProgram};
use glisten_front::hir::{Storage, Type};
use glisten_front::link::Program;
use glisten_sources::engines::code::without_comments;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// A uniform that is a struct with samplers.
struct Holder {
    name: String,
    structure: String,
    /// The members that are samplers.
    samplers: BTreeSet<String>,
    has_others: bool,
}

/// The program with a uniform for each sampler, and what to say of it. Whoever calls this sees whether it compiles.
pub(super) fn split(unit: &TreeProgram, program: &Program) -> Option<(TreeProgram, Vec<Note>)> {
    let holders = holders(program)?;
    let mut notes = Vec::new();
    let mut sources = unit.sources.clone();
    for source in &mut sources {
        let (apart, added) = apart(&source.text, &holders);
        let (text, names) = split_text(&apart, &holders)?;
        notes.extend(names.into_iter().map(|(place, old, new)| {
            let is_before = |line: &&usize| **line <= place;
            let lines = apart.get(..place).map_or(0, |before| before.matches('\n').count());
            let line = (lines - added.iter().filter(is_before).count()) as u32 + 1;
            let text = format!("`{old}` is `{new}`, since Vulkan has no samplers in structs; the host names it, too");
            Note { file: source.name.clone(), line, text }
        }));
        source.text = text.into();
    }
    Some((TreeProgram { compiler: unit.compiler.clone(), sources }, notes))
}

/// The uniforms that are structs with samplers; none if there is no such uniform, or one that cannot be split.
fn holders(program: &Program) -> Option<Vec<Holder>> {
    let mut found: BTreeMap<String, Holder> = BTreeMap::new();
    for global in program.stages.iter().flat_map(|shader| &shader.globals) {
        let is_plain = matches!(program.types.get(global.ty), Type::Sampler(_));
        if global.storage != Storage::Uniform || is_plain || !program.types.contains_sampler(global.ty) {
            continue;
        }
        let Type::Struct(id) = program.types.get(global.ty) else {
            // An array of samplers is one binding; an array of structs is not split.
            if super::facts::plain_type(&program.types, global.ty).is_none()
                && !is_array_of_samplers(program, global.ty)
            {
                return None;
            }
            continue;
        };
        let structure = program.types.structure(id);
        let is_sampler = |ty| matches!(program.types.get(ty), Type::Sampler(_));
        let members = structure.members.iter();
        let samplers =
            members.clone().filter(|member| is_sampler(member.ty)).map(|member| member.name.clone()).collect();
        let has_others = members.clone().any(|member| !is_sampler(member.ty));
        let (name, structure) = (global.name.clone(), structure.name.clone());
        found.insert(name.clone(), Holder { name, structure, samplers, has_others });
    }
    (!found.is_empty()).then(|| found.into_values().collect())
}

fn is_array_of_samplers(program: &Program, mut ty: glisten_front::hir::TypeId) -> bool {
    while let Type::Array(element, _) = program.types.get(ty) {
        ty = element;
    }
    matches!(program.types.get(ty), Type::Sampler(_))
}

/// A text whose uniforms are of structs that are defined before them: `uniform struct S { .. } s;` is `struct S { .. };` and
/// `uniform S s;` in the next line. With it, the places after the ends of lines that it has in addition.
fn apart(text: &str, holders: &[Holder]) -> (String, Vec<usize>) {
    let all = tokens(text);
    let word = |index: usize| all.get(index).map_or("", |token: &Token<'_>| token.text);
    let place = |index: usize| all.get(index).map_or(0..0, |token| token.range.clone());
    let (mut edits, mut added): (Vec<Edit>, Vec<usize>) = (Vec::new(), Vec::new());
    // The difference between the lengths of the new text and of the old one, so far.
    let mut longer = 0;
    for at in (0..all.len()).filter(|at| word(*at) == "uniform" && word(at + 1) == "struct") {
        let is_own = |holder: &&Holder| {
            let close = (at..all.len()).find(|index| word(*index) == "}");
            holder.structure == word(at + 2) && close.is_some_and(|close| word(close + 1) == holder.name)
        };
        let Some(holder) = holders.iter().find(is_own) else { continue };
        let Some(close) = (at..all.len()).find(|index| word(*index) == "}") else { continue };
        let word_end = place(at).end;
        let has_gap = text.get(word_end..).is_some_and(|rest| rest.starts_with(char::is_whitespace));
        let head = place(at).start..word_end + usize::from(has_gap);
        let end = place(close).end;
        let new = format!(";\nuniform {}", holder.structure);
        added.push(end + longer + 2 - head.len());
        longer = longer + new.len() - head.len();
        edits.extend([(head, String::new()), (end..end, new)]);
    }
    (applied(text, edits), added)
}

/// The new names of members: the place of the declaration, the old name and the new one.
type Names = Vec<(usize, String, String)>;

/// A text with a uniform for each sampler.
fn split_text(text: &str, holders: &[Holder]) -> Option<(String, Names)> {
    let all = tokens(text);
    let word = |index: usize| all.get(index).map_or("", |token: &Token<'_>| token.text);
    let words: BTreeSet<&str> = all.iter().map(|token| token.text).collect();
    let free = |name: String| {
        let mut name = name;
        while words.contains(name.as_str()) {
            name.push('_');
        }
        name
    };
    let (mut edits, mut names): (Vec<Edit>, Names) = (Vec::new(), Vec::new());
    let structures: BTreeMap<&str, &Holder> =
        holders.iter().map(|holder| (holder.structure.as_str(), holder)).collect();
    let code = without_comments(text);
    let mut types: BTreeMap<(&str, String), (String, Comments<'_>)> = BTreeMap::new();
    for (structure, holder) in &structures {
        let Some(open) = (0..all.len()).find(|at| word(*at) == "struct" && word(at + 1) == *structure) else {
            continue;
        };
        let close = (open..all.len()).find(|at| word(*at) == "}")?;
        let mut start = open + 3;
        while start < close {
            let end = (start..close).find(|at| word(*at) == ";")?;
            let name = word(end - 1);
            if holder.samplers.contains(name) {
                // `sampler2D diffuse;`, with or without a precision.
                let is_single = end - start == 2 || end - start == 3 && word(start).ends_with('p');
                if !is_single {
                    return None;
                }
                let ty: Vec<&str> = (start..end - 1).map(word).collect();
                let range = all.get(start)?.range.start..all.get(end)?.range.end;
                let comments = Comments::of(text, &code, range);
                edits.push((comments.range.clone(), String::new()));
                types.insert((structure, name.to_owned()), (ty.join(" "), comments));
            }
            start = end + 1;
        }
        if !holder.has_others {
            let end = (word(close + 1) == ";").then(|| all.get(close + 1)).flatten()?.range.end;
            edits.push((whole(text, all.get(open)?.range.start..end), String::new()));
        }
    }
    for holder in holders {
        let is_declared = |at: &usize| {
            word(*at) == "uniform"
                && word(at + 1) == holder.structure
                && word(at + 2) == holder.name
                && word(at + 3) == ";"
        };
        let Some(at) = (0..all.len()).find(is_declared) else {
            // Another stage declares it.
            if words.contains(holder.name.as_str()) && words.contains(holder.structure.as_str()) {
                return None;
            } else {
                continue;
            }
        };
        let (start, end) = (all.get(at)?.range.start, all.get(at + 3)?.range.end);
        let mut lines = Vec::new();
        for member in &holder.samplers {
            let new = free(format!("{}_{member}", holder.name));
            let (ty, comments) = types.get(&(holder.structure.as_str(), member.clone()))?;
            lines.extend(comments.above.iter().map(|line| (*line).to_owned()));
            lines.push(format!("uniform {ty} {new};{}", comments.behind));
            for index in (0..all.len()).filter(|index| word(*index) == holder.name && word(index + 1) == ".") {
                let is_member_of_other = index.checked_sub(1).is_some_and(|before| word(before) == ".");
                if word(index + 2) == member && !is_member_of_other {
                    edits.push((all.get(index)?.range.start..all.get(index + 2)?.range.end, new.clone()));
                }
            }
            names.push((start, format!("{}.{member}", holder.name), new));
        }
        let lines = lines.join("\n");
        // The comment behind the struct stays with it.
        let line = text.get(end..).unwrap_or("").lines().next().unwrap_or("");
        let end = if holder.has_others && is_line_comment(line.trim()) { end + line.len() } else { end };
        edits.push(if holder.has_others { (end..end, format!("\n{lines}")) } else { (start..end, lines) });
    }
    Some((applied(text, edits), names))
}

/// A member with the comments that go with it.
struct Comments<'t> {
    /// The member with its whole lines, if nothing else is on them.
    range: Range<usize>,
    above: Vec<&'t str>,
    /// The comment behind it, with white space in front.
    behind: String,
}

impl<'t> Comments<'t> {
    fn of(text: &'t str, code: &str, range: Range<usize>) -> Self {
        let plain = Comments { range: whole(text, range.clone()), above: Vec::new(), behind: String::new() };
        let start = text.get(..range.start).and_then(|before| before.rfind('\n')).map_or(0, |at| at + 1);
        let rest = text.get(range.end..).unwrap_or("");
        let line = rest.find('\n').map_or(rest.len(), |at| at + 1);
        let behind = rest.get(..line).unwrap_or("").trim();
        let is_alone = text.get(start..range.start).is_some_and(|text| text.trim().is_empty());
        if !is_alone || !(behind.is_empty() || is_line_comment(behind)) {
            return plain;
        }
        let above = comment_above(text, code, start);
        let comment = text.get(above..start).unwrap_or("");
        Comments {
            range: above..range.end + line,
            above: comment.lines().map(str::trim).collect(),
            behind: if behind.is_empty() { String::new() } else { format!(" {behind}") },
        }
    }
}

/// A place with its whole lines, if nothing else is on them.
fn whole(text: &str, range: Range<usize>) -> Range<usize> {
    let before = text.get(..range.start).unwrap_or("");
    let start = before.rfind('\n').map_or(0, |at| at + 1);
    let after = text.get(range.end..).unwrap_or("");
    let line = after.find('\n').map_or(after.len(), |at| at + 1);
    let is_alone = before.get(start..).is_some_and(|text| text.trim().is_empty());
    let is_last = after.get(..line).is_some_and(|text| text.trim().is_empty());
    if is_alone && is_last { start..range.end + line } else { range }
}

#[cfg(test)]
mod tests {
    use super::{Holder, apart, split_text};

    #[test]
    fn structs_that_a_uniform_defines_come_before_it() {
        let holder = |name: &str, structure: &str| Holder {
            name: name.to_owned(),
            structure: structure.to_owned(),
            samplers: ["t".to_owned()].into(),
            has_others: true,
        };
        let text = "uniform struct L { vec4 a; sampler2D t; } s;\nuniform struct M { vec4 a; sampler2D t; } m[2];\n\
                    uniform struct N { float f; sampler2D t; } n;\n";
        let (new, added) = apart(text, &[holder("s", "L"), holder("n", "N")]);
        assert_eq!(
            new,
            "struct L { vec4 a; sampler2D t; };\nuniform L s;\nuniform struct M { vec4 a; sampler2D t; } m[2];\n\
             struct N { float f; sampler2D t; };\nuniform N n;\n"
        );
        let after: Vec<&str> = added.iter().filter_map(|place| new.get(*place..)?.get(..9)).collect();
        assert_eq!(after, ["uniform L", "uniform N"]);
    }

    #[test]
    fn samplers_get_names_of_their_own() {
        let holder = |has_others| Holder {
            name: "material".to_owned(),
            structure: "Material".to_owned(),
            samplers: ["diffuse".to_owned()].into(),
            has_others,
        };
        let text = "struct Material {\n    sampler2D diffuse;\n    float shininess;\n};\nuniform Material material;\n\
                    void main() { c = texture(material.diffuse, uv) * material.shininess; }\n";
        let (new, names) = split_text(text, &[holder(true)]).expect("it can be split");
        assert_eq!(
            new,
            "struct Material {\n    float shininess;\n};\nuniform Material material;\nuniform sampler2D material_diffuse;\n\
             void main() { c = texture(material_diffuse, uv) * material.shininess; }\n"
        );
        assert_eq!(names.len(), 1);
        let text = "struct Material { sampler2D diffuse; };\nuniform Material material;\nvec4 a = material.diffuse;\n";
        let (new, _) = split_text(text, &[holder(false)]).expect("it can be split");
        assert_eq!(new, "uniform sampler2D material_diffuse;\nvec4 a = material_diffuse;\n");
        let several = "struct Material { sampler2D other, diffuse; };\nuniform Material material;\n";
        assert!(split_text(several, &[holder(false)]).is_none());
    }
}
