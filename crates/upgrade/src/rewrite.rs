//! [`rewrite`]: the new text of a source, by a plan.
//!
//! *In:* a text and the plan of its program. *Out:* the new text. *Holds:* everything that is not replaced is the same, byte for
//! byte.

use super::names::{BUILT_IN, WORDS, lookup};
use super::plan::{Plan, Target, Text};
use super::tokens::{Token, closing, tokens};
use glisten_front::Stage;
use glisten_front::source::version_line;
use glisten_sources::engines::code::without_comments;
use std::cmp::Reverse;
use std::ops::Range;

/// The samplers, the ones with a default precision of fewer bits first (GLSL ES 3.00 §4.5.4).
static SAMPLERS: &[&str] = &[
    "sampler2D",
    "samplerCube",
    "sampler3D",
    "sampler2DShadow",
    "samplerCubeShadow",
    "sampler2DArray",
    "sampler2DArrayShadow",
    "isampler2D",
    "isampler3D",
    "isamplerCube",
    "isampler2DArray",
    "usampler2D",
    "usampler3D",
    "usamplerCube",
    "usampler2DArray",
];

/// A replacement.
pub(super) type Edit = (Range<usize>, String);

/// The new text of a source.
pub fn rewrite(text: &Text<'_>, plan: &Plan) -> String {
    if plan.has_names_only {
        return with_names(text, plan);
    }
    let mut edits: Vec<Edit> = Vec::new();
    let code = without_comments(text.text);
    // Comments are not code; a macro may be used anywhere.
    let all = tokens(text.text);
    let lines = directive_lines(&code);
    edits.extend(extension_lines(text.text, &code));
    let is_dropped: Vec<Range<usize>> = edits.iter().map(|(range, _)| range.clone()).collect();
    let version = version_line(text.text);
    let is_left = |token: &Token<'_>| {
        let at = token.range.start;
        let dropped = is_dropped.partition_point(|range| range.start <= at);
        let is_inside = |range: &Range<usize>| range.contains(&at);
        let before = dropped.checked_sub(1).and_then(|index| is_dropped.get(index));
        before.is_some_and(is_inside) || version.as_ref().is_some_and(is_inside)
    };
    if !plan.target.has_empty_declarations() {
        edits.extend(empty_declarations(&all, &lines));
    }
    let own = own_functions(&all);
    for (index, _) in all.iter().enumerate().filter(|(_, token)| token.is_word() && !is_left(token)) {
        words(text.stage, plan, &all, index, &own, &mut edits);
    }
    if text.is_shader {
        version_edit(text, plan.target, version, &code, &mut edits);
        let mut declarations: Vec<String> = plan.declarations(text.stage).map(str::to_owned).collect();
        if plan.target == Target::Es300 {
            declarations.splice(0..0, precisions(text, &all));
        }
        if !declarations.is_empty() {
            let (place, gap) = above_comment(text.text, &code, first_code(&code, &lines));
            let lines: String = declarations.iter().map(|line| format!("{line}\n")).collect();
            edits.push((place..place, lines + gap));
        }
    }
    if plan.target.joins_lines() && !text.joins_lines() {
        edits.extend(open_comments(text.text, &code));
    }
    applied(text.text, edits)
}

/// The semicolons that declare nothing, outside of functions: behind a function, or another semicolon. A directive is no code.
fn empty_declarations(all: &[Token<'_>], lines: &[(Range<usize>, Option<&str>)]) -> Vec<Edit> {
    let is_code = |token: &&Token<'_>| {
        let at = lines.partition_point(|(line, _)| line.end <= token.range.start);
        lines.get(at).is_none_or(|(_, directive)| directive.is_none())
    };
    let mut edits = Vec::new();
    let (mut open, mut last, mut may_be_empty): (Vec<bool>, &str, bool) = (Vec::new(), ";", true);
    for token in all.iter().filter(is_code) {
        if token.text == ";" && open.is_empty() && may_be_empty {
            edits.push((token.range.clone(), String::new()));
        }
        may_be_empty = token.text == ";";
        match token.text {
            "{" | "(" | "[" => open.push(last == ")"),
            "}" | ")" | "]" => may_be_empty = open.pop() == Some(true) && token.text == "}",
            _ => {}
        }
        last = token.text;
    }
    edits
}

/// A space behind each backslash that ends a `//` comment: the comment would go on in the next line where backslashes join lines (GLSL 4.20 §3.1).
fn open_comments<'t>(text: &'t str, code: &'t str) -> impl Iterator<Item = Edit> + 't {
    let mut start = 0;
    text.split_inclusive('\n').filter_map(move |line| {
        let own = start;
        start += line.len();
        let content = line.trim_end_matches(['\n', '\r']);
        let end = own + content.len();
        let is_comment = content.ends_with('\\')
            && content.contains("//")
            && code.get(own..end).is_some_and(|code| code.ends_with(' '));
        is_comment.then(|| (end..end, " ".to_owned()))
    })
}

/// The text with new names, and nothing else that is new.
fn with_names(text: &Text<'_>, plan: &Plan) -> String {
    let all = tokens(text.text);
    let is_member =
        |index: usize| index.checked_sub(1).and_then(|before| all.get(before)).is_some_and(|one| one.text == ".");
    let words = all
        .iter()
        .enumerate()
        .filter(|(index, token)| token.is_word() && (!is_member(*index) || plan.is_keyword(token.text)));
    let edits =
        words.filter_map(|(_, token)| Some((token.range.clone(), plan.word(text.stage, token.text)?.to_owned())));
    applied(text.text, edits.collect())
}

/// The number of samplers with a default precision.
const N_WITH_DEFAULTS: usize = 2;

/// The default precisions that ES lacks, for the types that a stage uses, and, for a text of no ES, those that have fewer bits than it has
/// (GLSL ES 3.00 §4.5.4).
fn precisions(text: &Text<'_>, all: &[Token<'_>]) -> Vec<String> {
    let is_set = |ty: &str| {
        all.windows(3).any(|words| matches!(words, [word, _, of] if word.text == "precision" && of.text == ty))
    };
    let uses = |ty: &str| all.iter().any(|token| token.text == ty);
    let known = if text.is_of_es() { N_WITH_DEFAULTS } else { 0 };
    let samplers = SAMPLERS.iter().copied().skip(known).filter(|ty| uses(ty));
    let is_fragment = text.stage == Stage::Fragment;
    let is_whole = |token: &Token<'_>| {
        let word = token.text.trim_end_matches(['2', '3', '4']);
        ["int", "uint", "ivec", "uvec", "include"].contains(&word)
    };
    let int = (is_fragment && !text.is_of_es() && all.iter().any(is_whole)).then_some("int");
    let types = is_fragment.then_some("float").into_iter().chain(int).chain(samplers);
    types.filter(|ty| !is_set(ty)).map(|ty| format!("precision highp {ty};")).collect()
}

/// The text with its replacements, which do not overlap. New lines end as those of the text.
pub(super) fn applied(text: &str, mut edits: Vec<Edit>) -> String {
    let has_returns = ends_lines_with_returns(text);
    // Insertions come before what is replaced, and a whole declaration before its words.
    edits.sort_by_key(|(range, _)| (range.start, !range.is_empty(), Reverse(range.end)));
    let (mut new, mut at) = (String::new(), 0);
    for (range, with) in edits {
        if range.start < at {
            continue;
        }
        new.push_str(text.get(at..range.start).unwrap_or(""));
        let with = if has_returns { with.replace("\r\n", "\n").replace('\n', "\r\n") } else { with };
        new.push_str(&with);
        at = range.end;
    }
    new.push_str(text.get(at..).unwrap_or(""));
    new
}

/// Whether all lines of a text end with a carriage return and a line feed.
pub(super) fn ends_lines_with_returns(text: &str) -> bool {
    let feeds = text.matches('\n').count();
    feeds > 0 && text.matches("\r\n").count() == feeds
}

/// The functions and macros that a text defines under names that were built in.
fn own_functions<'t>(all: &[Token<'t>]) -> Vec<&'t str> {
    let mut own = Vec::new();
    for (index, token) in all.iter().enumerate().filter(|(_, token)| lookup(token.text).is_some()) {
        let before = index.checked_sub(1).and_then(|before| all.get(before));
        let is_macro = before.is_some_and(|before| before.text == "define");
        let end = all.get(index + 1).filter(|next| next.text == "(").and_then(|_| closing(all, index + 1));
        let has_body = end.and_then(|end| all.get(end + 1)).is_some_and(|next| next.text == "{");
        if is_macro || has_body {
            own.push(token.text);
        }
    }
    own
}

/// The place of an `invariant` before an input of a fragment shader, or of the whole `invariant name;` of one.
fn invariance_of_an_input(all: &[Token<'_>], index: usize) -> Option<Range<usize>> {
    let (token, next) = (all.get(index)?, all.get(index + 1)?);
    let is_input = |token: &Token<'_>| matches!(token.text, "in" | "varying");
    let rest = all.get(index + 1..)?;
    let mut qualifiers = rest.iter().take_while(|token| !matches!(token.text, ";" | "=" | "(" | "{"));
    if qualifiers.any(is_input) || is_in_input_block(all, index) {
        return Some(token.range.start..next.range.start);
    }
    let end = rest.get(1).filter(|end| end.text == ";")?;
    // The declaration: `in`, other words, and the name.
    let mut statements = all.get(..index)?.split(|token| token.text == ";");
    let declares =
        statements.any(|words| words.iter().any(is_input) && words.iter().any(|word| word.text == next.text));
    declares.then_some(token.range.start..end.range.end)
}

/// Whether a token is between the braces of an input block.
fn is_in_input_block(all: &[Token<'_>], index: usize) -> bool {
    let mut closed = 0_usize;
    for (at, token) in all.iter().enumerate().take(index).rev() {
        match token.text {
            "}" => closed += 1,
            "{" if closed > 0 => closed -= 1,
            "{" => {
                let before = |back: usize| at.checked_sub(back).and_then(|at| all.get(at));
                return before(2).is_some_and(|word| word.text == "in");
            }
            _ => {}
        }
    }
    false
}

/// The replacements at one word.
fn words(stage: Stage, plan: &Plan, all: &[Token<'_>], index: usize, own: &[&str], edits: &mut Vec<Edit>) {
    let Some(token) = all.get(index) else { return };
    let at = |index: Option<usize>| index.and_then(|index| all.get(index)).map(|token| token.text);
    let (before, after) = (at(index.checked_sub(1)), at(Some(index + 1)));
    let old_lookup = lookup(token.text).filter(|_| !own.contains(&token.text));
    // A variable has the name of an old function, and hides it, in its scope alone.
    let is_call = old_lookup.is_some() && after == Some("(");
    // A member has any name that is no keyword.
    if before == Some(".") && !plan.is_keyword(token.text) {
        return;
    }
    if token.text == "invariant" && stage == Stage::Fragment && !plan.target.has_invariant_inputs() {
        edits.extend(invariance_of_an_input(all, index).map(|range| (range, String::new())));
        return;
    }
    let range = token.range.clone();
    let storage = match (token.text, stage) {
        ("attribute", _) => Some("in"),
        ("varying", Stage::Fragment) => Some("in"),
        ("varying", _) => Some("out"),
        _ => None,
    };
    if let Some(word) = storage {
        edits.push((range, word.to_owned()));
    } else if token.text == "ftransform" && after == Some("(") {
        let end = closing(all, index + 1).and_then(|end| all.get(end)).map_or(range.end, |token| token.range.end);
        edits.extend(plan.word(stage, token.text).map(|new| (range.start..end, new.to_owned())));
    } else if let Some(new) = plan.word(stage, token.text).filter(|_| !is_call) {
        edits.push((redeclaration(all, index).unwrap_or(range), new_text(all, index, new)));
    } else if let Some((_, new)) = WORDS.iter().find(|(old, _)| *old == token.text) {
        edits.push((range, (*new).to_owned()));
    } else if let Some(new) = old_lookup {
        edits.push((
            range,
            if new.is_shadow && after == Some("(") { format!("vec4(vec3({}", new.name) } else { new.name },
        ));
        if let (true, Some("("), Some(end)) = (new.is_shadow, after, closing(all, index + 1)) {
            edits.extend(all.get(end).map(|end| (end.range.end..end.range.end, "), 1.0)".to_owned())));
        }
    }
}

/// The largest number of tokens of a declaration before its name, and after it.
const MAX_DECLARATION: usize = 32;

/// The whole declaration, where a shader declares a built-in variable again: `varying vec4 gl_TexCoord[2];`.
fn redeclaration(all: &[Token<'_>], index: usize) -> Option<Range<usize>> {
    if !all.get(index)?.text.starts_with("gl_") {
        return None;
    }
    let from = index.saturating_sub(MAX_DECLARATION);
    let ends = |token: &Token<'_>| [";", "{", "}", ")", "#"].contains(&token.text);
    let start = all.get(from..index)?.iter().rposition(ends).map_or(from, |at| from + at + 1);
    let first = all.get(start)?;
    let qualified = ["varying", "in", "out", "flat", "centroid", "smooth"].contains(&first.text) && start < index;
    let end = all.iter().skip(index).take(MAX_DECLARATION).find(|token| token.text == ";")?;
    qualified.then_some(first.range.start..end.range.end)
}

/// The text in place of a word, or nothing in place of a declaration.
fn new_text(all: &[Token<'_>], index: usize, new: &str) -> String {
    if redeclaration(all, index).is_some() { String::new() } else { new.to_owned() }
}

/// The text after the `#` of a line that is a directive. A byte order mark may be in front of the first line.
pub(super) fn directive(line: &str) -> Option<&str> {
    line.trim_start_matches('\u{feff}').trim_start().strip_prefix('#')
}

/// The lines of a text without comments, and whether each is a directive; a line that continues one is an empty one.
fn directive_lines(code: &str) -> Vec<(Range<usize>, Option<&str>)> {
    let (mut at, mut goes_on) = (0, false);
    code.split_inclusive('\n')
        .map(|line| {
            let range = at..at + line.len();
            at = range.end;
            let found = if goes_on { Some("") } else { directive(line).map(str::trim) };
            goes_on = found.is_some() && line.trim_end().ends_with('\\');
            (range, found)
        })
        .collect()
}

/// `#extension` lines for what is built in now.
fn extension_lines(text: &str, code: &str) -> Vec<Edit> {
    let is_built_in = |line: &str| {
        let name = line.strip_prefix("extension")?.trim_start().split([':', ' ', '\t']).next()?;
        Some(BUILT_IN.contains(&name))
    };
    directive_lines(code)
        .into_iter()
        .filter(|(_, line)| line.and_then(is_built_in).unwrap_or(false))
        .map(|(range, _)| (range.start..range.start + removable(text, code, &range), String::new()))
        .collect()
}

/// The length of a line of code that is taken away: with its end, unless a comment follows.
fn removable(text: &str, code: &str, range: &Range<usize>) -> usize {
    let [line, alone] = [text, code].map(|text| text.get(range.clone()).unwrap_or("").trim_end());
    if line.len() == alone.len() { range.len() } else { alone.len() }
}

/// Sets the version.
fn version_edit(text: &Text<'_>, target: Target, version: Option<Range<usize>>, code: &str, edits: &mut Vec<Edit>) {
    let line = target.version_line();
    let start = if text.text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let is_below =
        |range: &Range<usize>| text.text.get(start..range.start).is_some_and(|above| !above.trim().is_empty());
    match version {
        // What is above it stays above all else.
        Some(range) if target.begins_with_version() && is_below(&range) => {
            let rest = text.text.get(range.end..).unwrap_or("");
            let end = range.end + rest.find('\n').map_or(rest.len(), |at| at + 1);
            edits.push((start..start, format!("{line}\n")));
            edits.push((range.start..range.start + removable(text.text, code, &(range.start..end)), String::new()));
        }
        Some(range) => {
            let length = code.get(range.clone()).map_or(0, |line| line.trim_end().len());
            edits.push((range.start..range.start + length, line.to_owned()));
        }
        None => edits.push((start..start, format!("{line}\n"))),
    }
}

/// The place for new declarations of a text, and the text between them and what follows.
pub(super) fn place_of_declarations(text: &str) -> (usize, &'static str) {
    let code = without_comments(text);
    above_comment(text, &code, first_code(&code, &directive_lines(&code)))
}

/// The longest comment in lines that explains a declaration. A longer one is about the file.
const LONGEST_COMMENT: usize = 6;

/// The place of new lines above a line of code: above the comment that explains this line, too, with a blank line between.
fn above_comment(text: &str, code: &str, place: usize) -> (usize, &'static str) {
    let start = comment_above(text, code, place);
    if start < place { (start, "\n") } else { (place, "") }
}

/// The start of the comment that explains a line of code: it is directly above, and neither at the top of the file, nor long, nor a
/// license.
pub(super) fn comment_above(text: &str, code: &str, place: usize) -> usize {
    let (mut start, mut n_lines) = (place, 0);
    while let Some(before) = start.checked_sub(1).and_then(|end| text.get(..end)) {
        let line = before.rfind('\n').map_or(0, |at| at + 1)..start;
        let is_blank = |text: &str| text.get(line.clone()).is_none_or(|line| line.trim().is_empty());
        if is_blank(text) || !is_blank(code) {
            break;
        }
        (start, n_lines) = (line.start, n_lines + 1);
    }
    let comment = text.get(start..place).unwrap_or("").to_ascii_lowercase();
    let is_license = ["copyright", "license", "licence"].iter().any(|word| comment.contains(word));
    let is_about_file = start == 0 || n_lines > LONGEST_COMMENT || is_license;
    if is_about_file { place } else { start }
}

/// The start of the first line with code, outside of conditional groups, or of the group that it is in.
fn first_code(code: &str, lines: &[(Range<usize>, Option<&str>)]) -> usize {
    let (mut depth, mut group) = (0_usize, 0);
    for (range, directive) in lines {
        match directive {
            Some(line) if line.starts_with("if") => {
                if depth == 0 {
                    group = range.start;
                }
                depth += 1;
            }
            Some(line) if line.starts_with("endif") => depth = depth.saturating_sub(1),
            Some(line) if line.starts_with("include") || line.starts_with("moj_import") => {
                return if depth > 0 { group } else { range.start };
            }
            Some(_) => {}
            None => {
                let line = code.get(range.clone()).unwrap_or("");
                // A default precision comes before what it is for.
                let rest = after_precisions(line);
                if !rest.is_empty() {
                    let is_whole = rest.len() == line.trim_start().len();
                    let start = if is_whole { range.start } else { range.start + (line.len() - rest.len()) };
                    return if depth > 0 { group } else { start };
                }
            }
        }
    }
    code.len()
}

/// The rest of a line after the default precisions that it begins with.
fn after_precisions(line: &str) -> &str {
    let mut rest = line.trim_start();
    while rest.starts_with("precision") {
        // One that goes on in the next line is the whole of this one.
        rest = rest.split_once(';').map_or("", |(_, rest)| rest.trim_start());
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::rewrite;
    use crate::{Plan, Target, Text};
    use glisten_front::Stage;

    fn upgraded(source: &str, stage: Stage, target: Target) -> String {
        let version = if source.starts_with("#version 100") { 100 } else { 110 };
        let text = Text { text: source, stage, is_shader: true, version };
        rewrite(&text, &Plan::new(&[text], target))
    }

    #[test]
    fn words_change_and_the_rest_stays() {
        let old = "// varying\n#extension GL_EXT_gpu_shader4 : enable // was\nuniform sampler2D t;\nvarying\tvec2 p; /* texture2D */\n\
                   #define LOOK(q) texture2D(t, q)\nvoid main() { gl_FragColor = LOOK(p).texture2D; }\n";
        let new = "#version 150\n// varying\n // was\nout vec4 fragColor;\nuniform sampler2D t;\nin\tvec2 p; /* texture2D */\n\
                   #define LOOK(q) texture(t, q)\nvoid main() { fragColor = LOOK(p).texture2D; }\n";
        assert_eq!(upgraded(old, Stage::Fragment, Target::Core150), new);
    }

    #[test]
    fn declarations_do_not_come_into_a_macro_of_several_lines() {
        let old = "#version 120\n#define LOOK(q) \\\n  texture2D(t, q) \\\n  .rgba\nuniform sampler2D t;\nvoid main() { gl_FragColor = LOOK(vec2(0.0)); }\n";
        let new = "#version 150\n#define LOOK(q) \\\n  texture(t, q) \\\n  .rgba\nout vec4 fragColor;\nuniform sampler2D t;\nvoid main() { fragColor = LOOK(vec2(0.0)); }\n";
        assert_eq!(upgraded(old, Stage::Fragment, Target::Core150), new);
    }

    #[test]
    fn declarations_come_before_code_and_after_directives() {
        let old = "#version 100 // old\n#ifdef GL_ES\nprecision mediump float;\n#endif\n#ifdef A\nvarying vec2 p;\n#endif\n\
                   void main() { gl_FragData[1] = gl_FragColor; }\n";
        let new = "#version 300 es // old\n#ifdef GL_ES\nprecision mediump float;\n#endif\nout mediump vec4 fragData[2];\n#ifdef A\n\
                   in vec2 p;\n#endif\nvoid main() { fragData[1] = fragData[0]; }\n";
        assert_eq!(upgraded(old, Stage::Fragment, Target::Es300), new);
    }

    #[test]
    fn the_version_of_es_moves_above_comments() {
        let old = "// License\n\n#version 150 // old\nin vec4 c;\nout vec4 d;\nvoid main() { d = c; }\n";
        let new = upgraded(old, Stage::Fragment, Target::Es300);
        assert!(new.starts_with("#version 300 es\n// License\n\n // old\n"), "{new}");
        let alone = upgraded(&old.replace(" // old", ""), Stage::Fragment, Target::Es300);
        assert!(alone.starts_with("#version 300 es\n// License\n\n") && !alone.contains("150"), "{alone}");
        assert!(
            upgraded(old, Stage::Fragment, Target::Core330).starts_with("// License\n\n#version 330 core // old\n")
        );
    }

    #[test]
    fn declarations_come_behind_a_precision_on_the_same_line() {
        let old = "#version 100\nprecision mediump float; precision highp int; varying vec4 c; void main() { gl_FragColor = c; }\n";
        let new = "#version 150\nprecision mediump float; precision highp int; out vec4 fragColor;\nin vec4 c; void main() { fragColor = c; }\n";
        assert_eq!(upgraded(old, Stage::Fragment, Target::Core150), new);
    }

    #[test]
    fn variables_named_as_old_lookups() {
        let old = "vec4 f(sampler2D texture2D) { return texture3D(t, v); }\nvoid main() { vec4 shadow2D = texture2D(s, p), q[1] = shadow2D; \
                   }\n";
        let new = upgraded(old, Stage::Vertex, Target::Core330);
        let body = "(sampler2D texture2D) { return texture(t, v); }\nvoid main() { vec4 shadow2D = texture(s, p), q[1] = shadow2D; }\n";
        assert!(new.ends_with(body), "{new}");
        let vulkan = upgraded(old, Stage::Vertex, Target::Vulkan);
        assert!(vulkan.contains("f(sampler2D texture2D_) { return texture(t, v); }"), "{vulkan}");
    }

    #[test]
    fn precisions_that_es_lacks_are_set() {
        let new = upgraded(
            "uniform sampler3D t; void main() { gl_FragColor = texture3D(t, vec3(1.0)); }",
            Stage::Fragment,
            Target::Es300,
        );
        let start =
            "#version 300 es\nprecision highp float;\nprecision highp sampler3D;\nout highp vec4 fragColor;\nuniform";
        assert!(new.starts_with(start), "{new}");
        // By default, ES has fewer bits for these than other languages.
        let old = "uniform sampler2D t; uniform ivec2 p; void main() { gl_FragColor = texelFetch(t, p, 0); }";
        let start = |version: u16| {
            let text = Text { text: old, stage: Stage::Fragment, is_shader: true, version };
            rewrite(&text, &Plan::new(&[text], Target::Es300)).split("uniform").next().map(str::to_owned)
        };
        let all =
            "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\nout highp vec4 fragColor;\n";
        assert_eq!(start(130), Some(format!("#version 300 es\n{all}")));
        let float = "precision highp float;\nout mediump vec4 fragColor;\n";
        assert_eq!(start(100), Some(format!("#version 300 es\n{float}")));
    }

    #[test]
    fn empty_declarations_go() {
        let old = "#version 330\n;struct S { float x; };\n#define E void e() { };\nvoid f() { { } ; ; };;\n\
                   uniform B { vec4 b; };\nout vec4 c;\nvoid main() { vec2 a[1] = vec2[1](vec2(1.0)); f(); };\n";
        let new = "#version 450 core\nstruct S { float x; };\n#define E void e() { };\nvoid f() { { } ; ; }\n\
                   uniform B { vec4 b; };\nout vec4 c;\nvoid main() { vec2 a[1] = vec2[1](vec2(1.0)); f(); }\n";
        assert_eq!(upgraded(old, Stage::Fragment, Target::Core450), new);
        assert!(upgraded(old, Stage::Fragment, Target::Core460).contains("};;\n"));
    }

    #[test]
    fn old_lookups_and_functions_of_the_text() {
        let old = "vec4 texture2D(vec2 p) { return vec4(p, p); }\nvarying vec4 gl_TexCoord[1];\nvoid main() { shadow2D(s, f(c)).r; \
                   texture2D(vec2(1.0)); gl_TexCoord[0]; ftransform( ); }\n";
        let new = upgraded(old, Stage::Vertex, Target::Core330);
        assert!(new.contains("vec4(vec3(texture(s, f(c))), 1.0).r; texture2D(vec2(1.0)); texCoord[0]; (modelViewProjectionMatrix * vertex);"), "{new}");
        assert!(new.starts_with("#version 330 core\n") && !new.contains("gl_TexCoord"), "{new}");
    }
}
