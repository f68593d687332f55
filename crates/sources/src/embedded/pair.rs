//! Which shaders of a file form a program, and what completes them.
//!
//! *In:* the shaders of a file. *Out:* programs. *Holds:* a vertex and a fragment shader belong to each other if they are in the same
//! bracket of the host, have the same name but for the stage, and follow each other there. Others stand alone.

use super::{Host, Program, Shader};
use crate::engines::code::words;

/// The names that three.js declares for the shaders of its materials.
const OF_THREE: &[&str] =
    &["projectionMatrix", "modelViewMatrix", "modelMatrix", "viewMatrix", "normalMatrix", "cameraPosition"];
/// Words of a file that uses three.js.
const THREE: &[&str] = &["from 'three", "from \"three", "require('three", "require(\"three", "THREE.", "@react-three"];
/// Words of WebGL 2 that WebGL 1 does not have at the beginning of a declaration.
const OF_ES_3: &[&str] = &["in ", "out ", "flat ", "layout", "uvec", "texture("];
/// Words that WebGL 2 does not have.
const OF_ES_1: &[&str] = &["attribute", "varying", "gl_FragColor", "texture2D", "textureCube", "gl_FragData"];

/// The programs of the shaders of a file.
pub(super) fn programs(host: Host, text: &str, shaders: Vec<Shader>) -> Vec<Program> {
    let mut groups: Vec<Vec<Shader>> = Vec::new();
    for shader in shaders {
        let last = groups.iter_mut().rev().find(|group| group.iter().any(|other| other.place == shader.place));
        let fits = |group: &&mut Vec<Shader>| {
            group.iter().all(|other| other.is_whole && other.stage != shader.stage) && shader.is_whole
        };
        match last.filter(fits) {
            Some(group) => group.push(shader),
            None => groups.push(vec![shader]),
        }
    }
    let uses_three = host == Host::Script && THREE.iter().any(|word| text.contains(word));
    groups.into_iter().map(|group| program(host, text, group, uses_three)).collect()
}

fn program(host: Host, text: &str, mut shaders: Vec<Shader>, uses_three: bool) -> Program {
    shaders.sort_by_key(|shader| shader.stage);
    let inside = |shader: &Shader| text.get(shader.inside.clone()).unwrap_or("");
    let says_version = shaders.iter().any(|shader| inside(shader).contains("#version"));
    let of_host = host == Host::Script && !says_version;
    let needs_three = || shaders.iter().any(|shader| needs_three(inside(shader)));
    let engine = (of_host && (uses_three || needs_three())).then_some("three");
    let version = (of_host && engine.is_none())
        .then(|| if shaders.iter().any(|shader| is_es_3(inside(shader))) { "300 es" } else { "100" });
    Program { shaders, engine, version }
}

/// Whether a shader takes what three.js declares.
fn needs_three(text: &str) -> bool {
    let uses = |name: &&&str| words(text).any(|(_, word)| word == **name);
    let used: Vec<&&str> = OF_THREE.iter().filter(uses).collect();
    let is_declared = |name: &str| {
        text.lines().any(|line| line.trim_start().starts_with("uniform") && words(line).any(|(_, word)| word == name))
    };
    text.contains("#include <") || used.iter().any(|name| !is_declared(name))
}

/// Whether a shader without a version is one of WebGL 2.
fn is_es_3(text: &str) -> bool {
    if words(text).any(|(_, word)| OF_ES_1.contains(&word)) {
        return false;
    }
    text.lines().any(|line| OF_ES_3.iter().any(|word| line.trim_start().starts_with(word))) || text.contains("texture(")
}
