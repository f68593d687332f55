//! [`post_effect`]: the passes of a pack of Minecraft, as the game of today reads them.
//!
//! *In:* the text of a file in `post_effect`, and the blocks of each shader before and after. *Out:* the new text, and what has to be
//! looked at. *Holds:* only what changes is written again; the rest stays, byte for byte.

use super::done::blocks;
use serde_json::{Map, Value, json};
use std::ops::Range;

/// A file of passes with its new text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PostEffect {
    /// The new text.
    pub text: String,
    /// Sentences for the author of the pack.
    pub notes: Vec<String>,
}

/// The passes of a file. `shader` gives the new text of a fragment or vertex shader by its name: `minecraft:post/blur` and whether it is
/// the fragment shader. `of_game` tells the names of the game's own blocks. `None` if the file describes no passes, or is as the game wants it.
pub fn post_effect(
    text: &str,
    shader: &dyn Fn(&str, bool) -> Option<String>,
    of_game: &dyn Fn(&str) -> bool,
) -> Option<PostEffect> {
    let effect: Value = serde_json::from_str(text).ok()?;
    let passes = effect.get("passes")?.as_array()?;
    let list = Json(text).member(Json(text).value(0)?, "passes")?;
    let mut notes = Vec::new();
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    for (pass, place) in passes.iter().zip(Json(text).elements(list)) {
        let value = |key: &str| pass.get(key).and_then(Value::as_str).map(str::to_owned);
        // 1.21.2 to 1.21.4: one name for both shaders.
        let program = value("program").map(|name| name.replace(":program/", ":post/"));
        if let (Some(name), Some(range)) = (&program, Json(text).whole_member(place.clone(), "program")) {
            edits
                .push((range, format!("\"vertex_shader\": {0}, \"fragment_shader\": {0}", Value::from(name.as_str()))));
        }
        let old = match pass.get("uniforms") {
            None => &[][..],
            Some(Value::Array(old)) => old,
            Some(_) => continue,
        };
        let named = |key: &str| value(key).or(program.clone());
        let texts: Vec<String> = [("vertex_shader", false), ("fragment_shader", true)]
            .into_iter()
            .filter_map(|(key, is_fragment)| shader(&named(key)?, is_fragment))
            .collect();
        let ByBlocks { new, lost, unset } = by_blocks(old, &texts, of_game);
        let told = |name: String| format!("no block of the pass has the uniform `{name}`; its value is left out");
        notes.extend(lost.into_iter().map(told));
        let names: Vec<String> = unset.iter().map(|name| format!("`{name}`")).collect();
        if !names.is_empty() {
            notes.push(format!(
                "a pass has no value for {}, which {} 0",
                names.join(", "),
                if names.len() == 1 { "is" } else { "are" }
            ));
        }
        if let Some(range) = Json(text).member(place.clone(), "uniforms") {
            edits.push((range.clone(), written(text, range.start, &new)));
        } else if !new.is_empty() {
            edits.extend(added(text, place, &new));
        }
    }
    edits.sort_by_key(|(range, _)| range.start);
    let mut new = text.to_owned();
    for (range, with) in edits.iter().rev() {
        new.replace_range(range.clone(), with);
    }
    (!edits.is_empty()).then_some(PostEffect { text: new, notes })
}

/// The blocks as text, one member a line, indented like the line that they are on.
fn written(text: &str, at: usize, blocks: &Map<String, Value>) -> String {
    let line = text.get(..at).and_then(|before| before.rsplit('\n').next()).unwrap_or("");
    let indent: String = line.chars().take_while(|letter| letter.is_whitespace()).collect();
    let mut parts = Vec::new();
    for (name, members) in blocks {
        let rows: Vec<String> =
            members.as_array().into_iter().flatten().map(|one| format!("{indent}        {one}")).collect();
        parts.push(format!("{indent}    {}: [\n{}\n{indent}    ]", Value::from(name.as_str()), rows.join(",\n")));
    }
    if parts.is_empty() { "{}".to_owned() } else { format!("{{\n{}\n{indent}}}", parts.join(",\n")) }
}

/// The places of values in a text that is known to be JSON.
struct Json<'t>(&'t str);

impl Json<'_> {
    /// The first place that is no white space.
    fn start(&self, at: usize) -> usize {
        let rest = self.0.get(at..).unwrap_or("");
        at + (rest.len() - rest.trim_start().len())
    }

    /// The value that begins at a place, after white space.
    fn value(&self, at: usize) -> Option<Range<usize>> {
        let start = self.start(at);
        let (mut depth, mut in_string, mut escaped) = (0_usize, false, false);
        for (offset, letter) in self.0.get(start..)?.char_indices() {
            let end = start + offset;
            if in_string {
                in_string = escaped || letter != '"';
                escaped = letter == '\\' && !escaped;
                if !in_string && depth == 0 {
                    return Some(start..end + 1);
                }
                continue;
            }
            match letter {
                '"' => in_string = true,
                '{' | '[' => depth += 1,
                '}' | ']' if depth == 0 => return Some(start..end),
                '}' | ']' => {
                    depth -= 1;
                    if depth == 0 {
                        return Some(start..end + 1);
                    }
                }
                ',' if depth == 0 => return Some(start..end),
                _ => {}
            }
        }
        Some(start..self.0.len())
    }

    /// The elements of an array, or the keys and values of an object, in turn.
    fn elements(&self, list: Range<usize>) -> Vec<Range<usize>> {
        let mut found = Vec::new();
        let mut at = list.start + 1;
        while let Some(value) = self.value(at).filter(|value| value.end < list.end && !value.is_empty()) {
            at = self.start(value.end) + 1;
            found.push(value);
        }
        found
    }

    /// The value of a key.
    fn member(&self, object: Range<usize>, key: &str) -> Option<Range<usize>> {
        self.whole_member(object, key).and_then(|whole| {
            let key = self.value(whole.start)?;
            self.value(self.start(key.end) + 1)
        })
    }

    /// A key with its value.
    fn whole_member(&self, object: Range<usize>, key: &str) -> Option<Range<usize>> {
        let quoted = format!("\"{key}\"");
        let all = self.elements(object);
        let pairs = all.chunks(2).filter_map(|pair| Some((pair.first()?.clone(), pair.get(1)?.clone())));
        let mut found = pairs.filter(|(name, _)| self.0.get(name.clone()) == Some(quoted.as_str()));
        found.next().map(|(name, value)| name.start..value.end)
    }
}

/// The member `uniforms` for a pass that has none, after its last member.
fn added(text: &str, pass: Range<usize>, blocks: &Map<String, Value>) -> Option<(Range<usize>, String)> {
    let last = Json(text).elements(pass).pop()?;
    let key = text.get(..last.start)?.rfind('\n').map_or(0, |at| at + 1);
    let line = text.get(key..)?;
    let indent = line.get(..line.len() - line.trim_start().len()).unwrap_or("");
    Some((last.end..last.end, format!(",\n{indent}\"uniforms\": {}", written(text, last.start, blocks))))
}

/// The values of a pass by blocks.
struct ByBlocks {
    /// For each block its members, in their order.
    new: Map<String, Value>,
    /// The names that no block has.
    lost: Vec<String>,
    /// The members that have no value.
    unset: Vec<String>,
}

/// The values of a pass by the blocks of its shaders that are not the game's.
fn by_blocks(old: &[Value], texts: &[String], of_game: &dyn Fn(&str) -> bool) -> ByBlocks {
    let name_of = |one: &Value| one.get("name").and_then(Value::as_str).map(str::to_owned);
    let mut found = ByBlocks { new: Map::new(), lost: old.iter().filter_map(name_of).collect(), unset: Vec::new() };
    for (block, members) in texts.iter().flat_map(|text| blocks(text)) {
        if of_game(&block) || found.new.contains_key(&block) {
            continue;
        }
        let value = |(ty, name): &(String, String)| {
            let given = old.iter().find(|one| name_of(one).as_deref() == Some(name.as_str()));
            let values = given.and_then(|one| one.get("value").or(one.get("values")).cloned());
            found.lost.retain(|other| other != name);
            found.unset.extend(values.is_none().then(|| name.clone()));
            json!({ "name": name, "type": game_type(ty), "value": value_of(ty, values) })
        };
        let members: Vec<Value> = members.iter().map(value).collect();
        found.new.insert(block, Value::Array(members));
    }
    found
}

/// A type as the game names it.
fn game_type(ty: &str) -> &str {
    match ty {
        "mat4" => "matrix4x4",
        other => other,
    }
}

/// A value: a number for a scalar, a list otherwise; zeros where there is none.
fn value_of(ty: &str, values: Option<Value>) -> Value {
    let count = match ty {
        "mat4" => 16,
        _ => ty.chars().last().and_then(|last| last.to_digit(10)).unwrap_or(1) as usize,
    };
    let list = match values {
        Some(Value::Array(list)) => list,
        Some(one) => vec![one],
        None => Vec::new(),
    };
    let zero = || if ty.starts_with("int") || ty.starts_with("ivec") { json!(0) } else { json!(0.0) };
    let mut list: Vec<Value> = list.into_iter().take(count).collect();
    while list.len() < count {
        list.push(zero());
    }
    if count == 1 { list.pop().unwrap_or_else(zero) } else { Value::Array(list) }
}

#[cfg(test)]
mod tests {
    use super::post_effect;
    use serde_json::{Value, json};

    #[test]
    fn values_go_into_the_blocks_of_their_shaders() {
        let old = json!({ "targets": { "swap": {} }, "passes": [{
            "vertex_shader": "minecraft:post/blur", "fragment_shader": "minecraft:post/blur",
            "inputs": [{ "sampler_name": "In", "target": "minecraft:main" }], "output": "swap",
            "uniforms": [{ "name": "Radius", "type": "float", "values": [4.0] }, { "name": "Dir", "type": "vec2", "values": [1.0, 0.0] },
                { "name": "Gone", "type": "float", "values": [1.0] }]
        }] });
        let shader = |name: &str, is_fragment: bool| {
            let text = "layout(std140) uniform FragmentUniforms {\n    vec2 Dir;\n    float Radius;\n};\n";
            (name == "minecraft:post/blur" && is_fragment).then(|| text.to_owned())
        };
        let new = post_effect(&old.to_string(), &shader, &|_| false).expect("it changes");
        let value: Value = serde_json::from_str(&new.text).expect("JSON");
        let block = &value["passes"][0]["uniforms"]["FragmentUniforms"];
        assert_eq!(block[0], json!({ "name": "Dir", "type": "vec2", "value": [1.0, 0.0] }));
        assert_eq!(block[1], json!({ "name": "Radius", "type": "float", "value": 4.0 }));
        assert!(new.notes.iter().any(|note| note.contains("`Gone`")), "{:?}", new.notes);
        let kept = "{ \"passes\": [\n    { \"program\": \"minecraft:post/blur\",\n      \"uniforms\": [{ \"name\": \"Radius\", \"values\": [1.0] }] }\n  ], \"z\": 1, \"a\": 2 }\n";
        let edited = post_effect(kept, &shader, &|_| false).expect("it changes").text;
        assert!(
            edited
                .starts_with("{ \"passes\": [\n    { \"vertex_shader\": \"minecraft:post/blur\", \"fragment_shader\""),
            "{edited}"
        );
        assert!(edited.ends_with("\n  ], \"z\": 1, \"a\": 2 }\n"), "{edited}");
        assert!(serde_json::from_str::<Value>(&edited).is_ok(), "{edited}");
        // The new text is as the game wants it.
        assert_eq!(post_effect(&new.text, &shader, &|_| false), None);
        assert_eq!(post_effect("{}", &shader, &|_| false), None);
    }
}
