//! Restores the names of the source in emitted text.
//!
//! naga makes names unique in the whole module, so that a second function's `x` becomes `x_1`. It appends an
//! underscore to names that end in a digit, and calls unnamed values `_e12`. WGSL has scopes: a local name need only
//! differ from the other names that its function uses. Superfluous once naga's namer (`naga::proc::Namer`) follows the
//! scopes of the language that it writes.
//!
//! *In:* WGSL as naga writes it (ASCII identifiers, no comments, a function's closing brace in column 0). *Out:* the
//! same program. *Holds:* a name is changed only if nothing else in the same function (for names of the module: in
//! the whole text) has the new name, and the new name is not reserved.

use naga::keywords::wgsl::{BUILTIN_IDENTIFIERS, RESERVED};
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::Range;

/// An identifier in the text.
#[derive(Clone, Copy)]
struct Word<'t> {
    text: &'t str,
    start: usize,
    /// Whether it follows a `.`, and is therefore a member and not a variable.
    is_member: bool,
}

/// The text with names as close to the source's as scopes allow.
pub(in crate::emit) fn restored(text: &str) -> String {
    let words = words(text);
    let module = names_of_module(&words);
    let mut renamed: Vec<(Range<usize>, String)> = Vec::new();
    let mut rest = words.as_slice();
    for function in functions(text) {
        let first = rest.partition_point(|word| word.start < function.start);
        let end = rest.partition_point(|word| word.start < function.end);
        let (outside, inside) = (&rest[..first], &rest[first..end]);
        rest = &rest[end..];
        apply(outside, &FxHashMap::default(), &module, &mut renamed);
        let locals = names_of_function(text, inside, &module);
        apply(inside, &locals, &module, &mut renamed);
    }
    apply(rest, &FxHashMap::default(), &module, &mut renamed);
    let mut result = String::with_capacity(text.len());
    let mut at = 0;
    for (place, name) in renamed {
        result.push_str(&text[at..place.start]);
        result.push_str(&name);
        at = place.end;
    }
    result.push_str(&text[at..]);
    result
}

fn apply<'t>(
    words: &[Word<'t>],
    locals: &FxHashMap<&'t str, String>,
    module: &FxHashMap<&'t str, &'t str>,
    renamed: &mut Vec<(Range<usize>, String)>,
) {
    for word in words {
        let local = locals.get(word.text).filter(|_| !word.is_member).cloned();
        if let Some(name) = local.or_else(|| module.get(word.text).map(|name| (*name).to_owned())) {
            renamed.push((word.start..word.start + word.text.len(), name));
        }
    }
}

/// All identifiers in order; numbers and their suffixes are not among them.
fn words(text: &str) -> Vec<Word<'_>> {
    let bytes = text.as_bytes();
    let is_part = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    let mut words = Vec::new();
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        if !is_part(byte) {
            at += 1;
            continue;
        }
        let len = bytes[at..].iter().take_while(|byte| is_part(**byte)).count();
        if !byte.is_ascii_digit() {
            let is_member = at > 0 && bytes[at - 1] == b'.';
            words.push(Word { text: &text[at..at + len], start: at, is_member });
        }
        at += len;
    }
    words
}

/// The ranges of the functions, from the first word to the closing brace.
fn functions(text: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(start) = text[at..].find("fn ").map(|offset| at + offset) {
        // Attributes may precede it, on lines of their own.
        let begins_line = start == 0 || text.as_bytes()[start - 1] == b'\n';
        let end = text[start..].find("\n}").map_or(text.len(), |offset| start + offset + 2);
        if begins_line {
            found.push(start..end);
            at = end;
        } else {
            at = start + 3;
        }
    }
    found
}

fn is_word_of_wgsl(name: &str) -> bool {
    RESERVED.contains(&name) || BUILTIN_IDENTIFIERS.contains(&name)
}

/// Names without the underscore that naga appends after a digit.
fn names_of_module<'t>(words: &[Word<'t>]) -> FxHashMap<&'t str, &'t str> {
    let is_marked = |word: &Word<'_>| word.text.ends_with('_');
    if !words.iter().any(is_marked) {
        return FxHashMap::default();
    }
    let all: FxHashSet<&str> = words.iter().map(|word| word.text).collect();
    let plain = |name: &&'t str| {
        let base = name.strip_suffix('_').filter(|base| base.ends_with(|c: char| c.is_ascii_digit()))?;
        (!all.contains(base) && !is_word_of_wgsl(base)).then_some((*name, base))
    };
    let mut seen: FxHashSet<&str> = FxHashSet::default();
    words.iter().map(|word| word.text).filter(|name| seen.insert(name)).filter_map(|name| plain(&name)).collect()
}

/// New names for the locals and parameters of a function.
fn names_of_function<'t>(
    text: &'t str,
    words: &[Word<'t>],
    module: &FxHashMap<&'t str, &'t str>,
) -> FxHashMap<&'t str, String> {
    let mut wanted: Vec<(&'t str, String)> = Vec::new();
    for (index, word) in words.iter().enumerate() {
        let behind = &text[word.start + word.text.len()..];
        let declares = index > 0 && matches!(words[index - 1].text, "let" | "var");
        // A parameter. Any other name before a colon follows `let` or `var`, or is a label of `switch`.
        let is_parameter = behind.starts_with(": ") && !declares && word.text != "default" && !word.is_member;
        if (declares || is_parameter)
            && let Some(base) = base_of(word.text, behind)
        {
            wanted.push((word.text, base));
        }
    }
    if wanted.is_empty() {
        return FxHashMap::default();
    }
    let given: FxHashSet<&str> = wanted.iter().map(|(name, _)| *name).collect();
    let kept = words.iter().filter(|word| !given.contains(word.text));
    let kept: FxHashSet<&str> = kept.map(|word| module.get(word.text).copied().unwrap_or(word.text)).collect();
    let mut taken: FxHashSet<String> = FxHashSet::default();
    let mut last: FxHashMap<String, u32> = FxHashMap::default();
    let mut names = FxHashMap::default();
    for (name, base) in wanted {
        let number = last.entry(base.clone()).or_default();
        let new = loop {
            let candidate = if *number == 0 { base.clone() } else { format!("{base}_{number}") };
            *number += 1;
            if !kept.contains(candidate.as_str()) && !taken.contains(&candidate) && !is_word_of_wgsl(&candidate) {
                break candidate;
            }
        };
        taken.insert(new.clone());
        names.insert(name, new);
    }
    names
}

/// The name that naga derived a name from, or a name that says what the value is; `None` if it is the source's own.
fn base_of(name: &str, behind: &str) -> Option<String> {
    if name.strip_prefix("_e").is_some_and(|digits| digits.bytes().all(|byte| byte.is_ascii_digit())) {
        let value = behind.strip_prefix(" = ").unwrap_or_default();
        let called = value.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').next().unwrap_or_default();
        let is_call = value[called.len()..].starts_with('(');
        return Some(match called {
            "textureDimensions" | "textureNumLayers" | "textureNumLevels" => "size".into(),
            _ if called.starts_with("texture") && is_call => "texel".into(),
            "" | "select" | "bitcast" | "vec2" | "vec3" | "vec4" => "value".into(),
            _ if is_call && !is_word_of_wgsl(called) => {
                format!("{}_result", base_of(called, "").unwrap_or_else(|| called.trim_end_matches('_').into()))
            }
            _ => "value".into(),
        });
    }
    let (base, number) = name.rsplit_once('_')?;
    let is_numbered = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    (is_numbered && !base.is_empty() && !base.ends_with('_')).then(|| base.to_owned())
}

#[cfg(test)]
mod tests {
    use super::restored;

    #[test]
    fn a_second_function_has_its_own_names() {
        let text = "fn f(x: f32) -> f32 {\n    return x;\n}\n\nfn g(x_1: f32) -> f32 {\n    var x_2: f32 = 2f;\n\n    \
                    return (x_1 + x_2);\n}\n";
        let names = "fn f(x: f32) -> f32 {\n    return x;\n}\n\nfn g(x: f32) -> f32 {\n    var x_1: f32 = 2f;\n\n    \
                     return (x + x_1);\n}\n";
        assert_eq!(restored(text), names);
    }

    #[test]
    fn what_the_function_mentions_keeps_its_name() {
        let text = "var<private> x: f32;\n\nfn f() {\n    let x_1 = x;\n    let _e3 = a.x_1;\n    x = _e3;\n}\n";
        assert_eq!(restored(text), text.replace("_e3", "value"));
    }

    #[test]
    fn digits_need_no_underscore_where_the_name_is_free() {
        let text =
            "struct S {\n    b2_: f32,\n    vec3_: f32,\n}\n\nfn f(s: S, v0_: f32) {\n    let v0_1 = s.b2_;\n}\n";
        let names = "struct S {\n    b2: f32,\n    vec3_: f32,\n}\n\nfn f(s: S, v0: f32) {\n    let v0_1 = s.b2;\n}\n";
        assert_eq!(restored(text), names);
    }

    #[test]
    fn what_has_no_name_says_what_it_is() {
        let text = "fn f() {\n    let _e1 = textureSample(t, s, p);\n    let _e2 = textureSample(t, s, p);\n    \
                    let _e3 = shade_1(_e1, _e2);\n}\n";
        let names = "fn f() {\n    let texel = textureSample(t, s, p);\n    let texel_1 = textureSample(t, s, p);\n    \
                     let shade_result = shade_1(texel, texel_1);\n}\n";
        assert_eq!(restored(text), names);
    }

    #[test]
    fn words_of_the_language_are_left_alone() {
        let text = "fn f() {\n    let as_1 = 1f;\n    let fn_1 = 1f;\n}\n";
        assert_eq!(restored(text), text);
    }
}
