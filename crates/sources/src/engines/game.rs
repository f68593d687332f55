//! [`GameProgram`]: a program of Minecraft, as its file of JSON describes it.
//!
//! *In:* the text of the file. *Out:* its shaders, and the macros that the game defines for them. *Holds:* a file that describes no
//! program is none; what it says of uniforms and samplers does not matter here.

use glisten_front::Stage;
use serde::Deserialize;
use serde_json::Value;
use std::path::Path;

/// A program.
#[derive(Clone, Debug, Deserialize)]
pub struct GameProgram {
    vertex: Option<String>,
    fragment: Option<String>,
    #[serde(default)]
    defines: Defines,
}

/// Macros: with values, and with the value 1.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
struct Defines {
    values: serde_json::Map<String, Value>,
    flags: Vec<String>,
}

impl GameProgram {
    /// Reads a file.
    pub fn read(text: &str) -> Option<Self> {
        let program: Self = serde_json::from_str(text).ok()?;
        (program.vertex.is_some() || program.fragment.is_some()).then_some(program)
    }

    /// Whether a file is its shader for a stage. The program names it as `minecraft:core/entity`, or `entity` next to it.
    pub fn has(&self, stage: Stage, path: &Path) -> bool {
        let named = match stage {
            Stage::Vertex => &self.vertex,
            Stage::Fragment => &self.fragment,
            Stage::Geometry => &None,
        };
        let named = named.as_deref().map(|name| name.split_once(':').map_or(name, |(_, inner)| inner));
        named.is_some_and(|name| path.with_extension("").ends_with(name))
    }

    /// Whether it defines macros.
    pub fn has_defines(&self) -> bool {
        !self.defines.values.is_empty() || !self.defines.flags.is_empty()
    }

    /// Its macros.
    pub fn defines(&self) -> impl Iterator<Item = (String, String)> {
        let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        let values = self.defines.values.iter().map(move |(name, value)| (name.clone(), text(value)));
        values.chain(self.defines.flags.iter().map(|name| (name.clone(), "1".to_owned())))
    }
}

#[cfg(test)]
mod tests {
    use super::GameProgram;
    use glisten_front::Stage;
    use std::path::Path;

    #[test]
    fn a_program_names_its_shaders_and_macros() {
        let text = r#"{ "vertex": "minecraft:core/sheep", "fragment": "wool", "samplers": [],
            "defines": { "values": { "CUT": "0.1", "LAYERS": 3 }, "flags": ["SHORN"] } }"#;
        let program = GameProgram::read(text).expect("it is one");
        assert!(program.has(Stage::Vertex, Path::new("a/shaders/core/sheep.vsh")));
        assert!(!program.has(Stage::Vertex, Path::new("a/shaders/post/sheep.vsh")));
        assert!(program.has(Stage::Fragment, Path::new("core/wool.fsh")));
        let defines: Vec<(String, String)> = program.defines().collect();
        let own = |name: &str, value: &str| (name.to_owned(), value.to_owned());
        assert_eq!(defines, [own("CUT", "0.1"), own("LAYERS", "3"), own("SHORN", "1")]);
        for other in ["{ \"targets\": [] }", "[1]", "{", "{ \"vertex\": 1 }"] {
            assert!(GameProgram::read(other).is_none(), "{other}");
        }
    }
}
