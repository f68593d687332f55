//! Texts of the library without includes, for hosts that compile GLSL without an include mechanism.
//!
//! *In:* the text of a module or of a shader. *Out:* the same text, in which each `#include` of a module is the text of that
//! module. *Holds:* a module stands where it is first included, with its include guard: several flat modules make one shader.

use super::{Embedded, Module};
use glisten_front::source::IncludeForm;
use std::collections::BTreeSet;

/// The directive that a flat text does not need.
const INCLUDE_EXTENSION: &str = "#extension GL_ARB_shading_language_include";

/// The name that a directive includes: `"safe.glsl"` and `<glisten/safe.glsl>`.
fn included(line: &str) -> Option<(&str, IncludeForm)> {
    let name = line.strip_prefix("#include")?.trim();
    let quoted = name.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
    let angled = name.strip_prefix('<').and_then(|rest| rest.strip_suffix('>'));
    quoted.map(|name| (name, IncludeForm::Quoted)).or(angled.map(|name| (name, IncludeForm::Angled)))
}

/// A text of the library without includes.
pub fn flat(text: &str) -> String {
    let mut out = String::new();
    append(text, &mut BTreeSet::new(), &mut out);
    out
}

fn append(text: &str, written: &mut BTreeSet<&'static str>, out: &mut String) {
    for line in text.lines().filter(|line| !line.starts_with(INCLUDE_EXTENSION)) {
        match included(line).and_then(|(name, form)| Embedded::module(name, form)) {
            Some(Module { name, text, .. }) => {
                if written.insert(name) {
                    append(text, written, out);
                }
            }
            None => {
                out.push_str(line);
                out.push('\n');
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{modules, shader, shader_files};
    use super::flat;

    #[test]
    fn nothing_is_included_and_nothing_is_there_twice() {
        let shaders = shader_files().filter_map(shader);
        let texts: Vec<&str> = modules().iter().map(|module| module.text).chain(shaders).collect();
        assert!(texts.len() > 80, "{}", texts.len());
        for text in texts {
            let flat = flat(text);
            assert!(!flat.contains("#include"), "{flat}");
            let guards: Vec<&str> = flat.lines().filter(|line| line.starts_with("#ifndef GLISTEN_")).collect();
            assert!(
                guards.iter().all(|guard| guards.iter().filter(|other| *other == guard).count() == 1),
                "{guards:?}"
            );
        }
    }
}
