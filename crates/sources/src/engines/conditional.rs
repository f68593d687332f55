//! Files whose stages are chosen by a macro: `#ifdef VERTEX`, `#if defined(FRAGMENT)`.
//!
//! *In:* a text. *Out:* a part for each stage: the whole text, with the macro that chooses the stage. *Holds:* a macro that the
//! file defines itself chooses nothing.

use super::code::{count_definitions, without_comments, words};
use super::part::Part;
use glisten_front::Stage;

/// Macros of the vertex, the fragment and the geometry stage.
static MACROS: &[[&str; 3]] = &[
    ["VERTEX", "FRAGMENT", "GEOMETRY"],
    ["VERTEX_SHADER", "FRAGMENT_SHADER", "GEOMETRY_SHADER"],
    ["_VERTEX_", "_FRAGMENT_", "_GEOMETRY_"],
    ["__VERTEX__", "__FRAGMENT__", "__GEOMETRY__"],
    ["_VERTEX_SHADER_", "_FRAGMENT_SHADER_", "_GEOMETRY_SHADER_"],
    ["IS_VERTEX", "IS_FRAGMENT", "IS_GEOMETRY"],
    ["IS_VERTEX_SHADER", "IS_FRAGMENT_SHADER", "IS_GEOMETRY_SHADER"],
    ["VERTEX_STAGE", "FRAGMENT_STAGE", "GEOMETRY_STAGE"],
    ["SHADER_STAGE_VERTEX", "SHADER_STAGE_FRAGMENT", "SHADER_STAGE_GEOMETRY"],
    ["STAGE_VERTEX", "STAGE_FRAGMENT", "STAGE_GEOMETRY"],
    ["COMPILE_VERTEX", "COMPILE_FRAGMENT", "COMPILE_GEOMETRY"],
    ["COMPILING_VERTEX", "COMPILING_FRAGMENT", "COMPILING_GEOMETRY"],
    ["VERTEX_PROGRAM", "FRAGMENT_PROGRAM", "GEOMETRY_PROGRAM"],
    ["COMPILE_VS", "COMPILE_FS", "COMPILE_GS"],
    ["COMPILE_VS", "COMPILE_PS", "COMPILE_GS"],
    ["COMPILEVS", "COMPILEPS", "COMPILEGS"],
    ["VERT", "FRAG", "GEOM"],
    ["VSH", "FSH", "GSH"],
    ["VS", "FS", "GS"],
    ["VS", "PS", "GS"],
];
const STAGES: [Stage; 3] = [Stage::Vertex, Stage::Fragment, Stage::Geometry];

/// The words after `directives` in a text without comments.
fn words_after<'a>(code: &'a str, directives: &[&str]) -> Vec<&'a str> {
    let lines = code.lines().filter_map(|line| line.trim_start().strip_prefix('#'));
    let mut found = Vec::new();
    for line in lines {
        let mut line = words(line).map(|(_, word)| word);
        if line.next().is_some_and(|directive| directives.contains(&directive)) {
            found.extend(line);
        }
    }
    found
}

/// The parts of a file whose conditions choose the stage.
pub(super) fn parts(text: &str) -> Option<Vec<Part>> {
    let code = without_comments(text);
    let n_mains = count_definitions(&code, "main");
    if n_mains == 0 {
        return None;
    }
    let tested = words_after(&code, &["if", "ifdef", "ifndef", "elif"]);
    let defined = words_after(&code, &["define"]);
    let is_tested = |name: &str| tested.contains(&name) && !defined.contains(&name);
    let row = MACROS.iter().find(|[vertex, fragment, _]| match (is_tested(vertex), is_tested(fragment)) {
        (true, true) => true,
        // The other stage is after an `#else`.
        (one, other) => (one || other) && n_mains >= 2,
    })?;
    let [_, _, geometry] = row;
    let stages = STAGES.iter().zip(row).filter(|(stage, _)| **stage != Stage::Geometry || is_tested(geometry));
    let part = |(stage, name): (&Stage, &&str)| Part {
        stage: *stage,
        others: Vec::new(),
        defines: vec![((*name).to_owned(), "1".to_owned())],
    };
    Some(stages.map(part).collect())
}

#[cfg(test)]
mod tests {
    use super::parts;

    fn macros(text: &str) -> Vec<String> {
        parts(text).unwrap_or_default().into_iter().flat_map(|part| part.defines).map(|(name, _)| name).collect()
    }

    #[test]
    fn macros_choose_the_stage() {
        let mains = "void main() {}\n#X\nvoid main(void)\n{}\n#endif\n";
        let with = |first: &str, second: &str| format!("{first}\n{}", mains.replace("#X", second));
        assert_eq!(macros(&with("#if defined(VERTEX)", "#elif defined(FRAGMENT)")), ["VERTEX", "FRAGMENT"]);
        assert_eq!(macros(&with("#ifdef VERTEX_SHADER", "#else")), ["VERTEX_SHADER", "FRAGMENT_SHADER"]);
        assert_eq!(macros(&with("# ifdef PS", "#else")), ["VS", "PS"]);
        assert!(macros(&with("#define VERTEX\n#ifdef VERTEX", "#else")).is_empty());
        assert!(macros(&with("#ifdef LIGHT", "#else")).is_empty());
        assert!(macros("#ifdef VERTEX\n#endif\nvoid main() {}").is_empty(), "one shader that tests a macro");
        assert!(macros("// #ifdef VERTEX\nvoid main() {} void main() {}").is_empty());
    }
}
