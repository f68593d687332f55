//! Which values of a scene's lights and materials each program of the library reads.
//!
//! *In:* the embedded programs. *Out:* [`values_read`]. *Holds:* the answer comes from the compiled programs, so it
//! cannot differ from them. They are compiled once, at the first question.

use super::{Embedded, programs, shader};
use glisten_front::hir::Stage;
use glisten_front::{Compiler, Options, Source};
use glisten_scene::scene_values_read;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

static READS: LazyLock<BTreeMap<&'static str, BTreeSet<String>>> = LazyLock::new(|| {
    let compiler = Compiler::new(Options::default()).with_includes(Embedded);
    let read = |files: [(&str, Stage); 2]| {
        let source = |(file, stage): (&str, Stage)| {
            Some(Source { name: format!("<glisten>/programs/{file}"), text: shader(file)?.into(), stage })
        };
        let sources: Vec<Source> = files.into_iter().filter_map(source).collect();
        compiler.compile(&sources).program.map(|program| scene_values_read(&program)).unwrap_or_default()
    };
    programs()
        .iter()
        .map(|one| (one.name, read([(one.vertex, Stage::Vertex), (one.fragment, Stage::Fragment)])))
        .collect()
});

/// The values that a program reads, by the names of [`scene_values_read`]; `None` for an unknown program.
pub(super) fn values_read(program: &str) -> Option<&'static BTreeSet<String>> {
    READS.get(program)
}

#[cfg(test)]
mod tests {
    use super::values_read;

    const LIGHTS: &[&str] = &["kind", "position", "direction", "ambient", "diffuse", "attenuation", "exponent"];

    /// Equation (101) is what the textbook's programs compute, each with its own highlight.
    #[test]
    fn the_programs_of_the_textbook_read_what_their_model_needs() {
        let highlights = [("phong", "material.shininess"), ("blinn_phong", "material.shininess")];
        let more = [("schlick", "material.shininess"), ("threshold", "finish.threshold")];
        for suffix in ["", "_vertex"] {
            for (name, parameter) in highlights.into_iter().chain(more).chain([("lambert", "material.diffuse")]) {
                let read = values_read(&format!("{name}{suffix}")).expect("it is a program");
                let mut wanted: Vec<String> = LIGHTS.iter().map(|member| format!("light.{member}")).collect();
                let body = ["material.ambient", "material.diffuse", "material.emission", "global_ambient", parameter];
                wanted.extend(body.map(str::to_owned));
                if name != "lambert" {
                    wanted.extend(["light.specular", "material.specular"].map(str::to_owned));
                }
                wanted.sort();
                wanted.dedup();
                assert_eq!(read.iter().cloned().collect::<Vec<_>>(), wanted, "{name}{suffix}");
            }
        }
    }
}
