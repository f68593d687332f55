//! The header of the Interactive Shader Format: JSON in the first comment of a fragment shader.
//!
//! *In:* the text of a shader. *Out:* the declarations of its inputs, of its passes and of the images that it imports, one a
//! line, or the place where the header is wrong. *Holds:* only names that are identifiers are declared.

use super::code::is_name;
use glisten_front::compiler::Problem;
use glisten_front::diagnostic::codes::general::BAD_HEADER;
use serde_json::Value;
use std::fmt::Write;
use std::ops::Range;

/// The GLSL types of inputs.
static TYPES: &[(&str, &str)] = &[
    ("event", "bool"),
    ("bool", "bool"),
    ("long", "int"),
    ("float", "float"),
    ("point2D", "vec2"),
    ("color", "vec4"),
    ("image", IMAGE),
    ("audio", IMAGE),
    ("audioFFT", IMAGE),
];
/// The largest number of inputs, and of images.
const MAX_INPUTS: usize = 1024;
const IMAGE: &str = "sampler2D";

/// The declarations that a shader's header asks for.
///
/// # Errors
/// There is no header, or it is not JSON, or an input has no name or no known type.
pub fn inputs(text: &str) -> Result<String, Problem> {
    let range = header(text).ok_or_else(|| {
        let help = "begin it with a comment such as `/*{ \"INPUTS\": [] }*/`";
        problem(0..0, "the source has no header of the Interactive Shader Format".to_owned(), Some(help))
    })?;
    let json = text.get(range.clone()).unwrap_or("");
    let header: Value = serde_json::from_str(json).map_err(|error| {
        let line = json.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum::<usize>();
        let rest = json.get(line..).unwrap_or("");
        let place = rest.char_indices().nth(error.column().saturating_sub(1)).map_or(rest.len(), |(at, _)| at);
        let at = range.start + line + place;
        problem(at..at, format!("the header is not JSON: {error}"), None)
    })?;
    let mut text_out = String::new();
    let n_inputs = header.get("INPUTS").and_then(Value::as_array).map_or(0, Vec::len);
    if n_inputs > MAX_INPUTS {
        let message = format!("the header has {n_inputs} inputs, and at most {MAX_INPUTS} are read");
        return Err(problem(range.clone(), message, None));
    }
    let list = |key: &str| header.get(key).and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    for input in list("INPUTS") {
        declare_input(input, &mut text_out).map_err(|message| problem(range.clone(), message, None))?;
    }
    let targets = list("PASSES").iter().filter_map(|pass| pass.get("TARGET")?.as_str());
    targets
        .chain(members(&header, "PERSISTENT_BUFFERS").into_iter().map(|(name, _)| name))
        .take(MAX_INPUTS)
        .for_each(|name| declare_image(name, IMAGE, &mut text_out));
    for (name, image) in members(&header, "IMPORTED").into_iter().take(MAX_INPUTS) {
        let is_cube = image.get("TYPE").and_then(Value::as_str) == Some("cube");
        declare_image(name, if is_cube { "samplerCube" } else { IMAGE }, &mut text_out);
    }
    Ok(text_out)
}

fn problem(range: Range<usize>, message: String, help: Option<&str>) -> Problem {
    Problem { code: &BAD_HEADER, range, message, help: help.map(str::to_owned) }
}

/// The JSON in the first comment.
fn header(text: &str) -> Option<Range<usize>> {
    let start = text.find("/*")? + 2;
    let end = start + text.get(start..)?.find("*/")?;
    text.get(start..end)?.trim_start().starts_with('{').then_some(start..end)
}

/// The items of a list of objects or strings, or of an object's members, with their names.
fn members<'h>(header: &'h Value, key: &str) -> Vec<(&'h str, &'h Value)> {
    let name = |item: &'h Value| item.as_str().or(item.get("NAME").and_then(Value::as_str));
    match header.get(key) {
        Some(Value::Object(members)) => members.iter().map(|(name, item)| (name.as_str(), item)).collect(),
        Some(Value::Array(list)) => list.iter().filter_map(|item| Some((name(item)?, item))).collect(),
        _ => Vec::new(),
    }
}

fn declare_input(input: &Value, text: &mut String) -> Result<(), String> {
    let word = |key: &str| input.get(key).and_then(Value::as_str);
    let name = word("NAME").ok_or("an input of the header has no NAME")?;
    let kind = word("TYPE").ok_or_else(|| format!("the input `{name}` of the header has no TYPE"))?;
    let Some((_, ty)) = TYPES.iter().find(|(known, _)| *known == kind) else {
        let known: Vec<&str> = TYPES.iter().map(|(known, _)| *known).collect();
        return Err(format!("the input `{name}` has the unknown TYPE `{kind}`; there are {}", known.join(", ")));
    };
    if !is_identifier(name) {
        return Err(format!("the input `{name}` has a name that GLSL does not allow"));
    }
    if *ty == IMAGE {
        declare_image(name, ty, text);
    } else {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "uniform {ty} {name};");
    }
    Ok(())
}

/// An image, and the names that its macros use in hosts.
fn declare_image(name: &str, ty: &str, text: &mut String) {
    let declaration = format!("uniform {ty} {name};\n");
    if is_identifier(name) && !text.contains(&declaration) {
        let _ = write!(text, "{declaration}uniform vec4 _{name}_imgRect;\nuniform vec2 _{name}_imgSize;\n");
        let _ = writeln!(text, "uniform bool _{name}_flip;");
    }
}

fn is_identifier(name: &str) -> bool {
    name.chars().all(is_name) && !name.starts_with(|first: char| first.is_ascii_digit()) && !name.is_empty()
}

#[cfg(test)]
mod tests {
    use super::inputs;

    #[test]
    fn inputs_are_uniforms() {
        let text = inputs(
            "/*{ \"INPUTS\": [{\"NAME\": \"a\", \"TYPE\": \"point2D\"}, {\"NAME\": \"i\", \"TYPE\": \"image\"}],\n\
             \"PASSES\": [{\"TARGET\": \"b\"}, {}], \"IMPORTED\": {\"c\": {\"PATH\": \"c.png\", \"TYPE\": \"cube\"}}}*/",
        );
        let text = text.unwrap_or_default();
        let list = inputs("/*{\"IMPORTED\": [{\"NAME\": \"c\", \"PATH\": [\"a\"], \"TYPE\": \"cube\"}]}*/");
        assert!(list.unwrap_or_default().contains("uniform samplerCube c;"));
        for line in ["uniform vec2 a;", "uniform sampler2D i;", "uniform sampler2D b;", "uniform samplerCube c;"] {
            assert!(text.contains(line), "{text}");
        }
    }

    #[test]
    fn wrong_headers_are_told() {
        let told =
            |text: &str| inputs(text).map_err(|problem| (problem.range.start, problem.message)).expect_err("wrong");
        assert_eq!(told("void main() {}").0, 0);
        assert_eq!(told("/*{\n  ]}*/").0, 6);
        assert!(told("/*{\"INPUTS\": [{\"NAME\": \"a\", \"TYPE\": \"vec9\"}]}*/").1.contains("vec9"));
        assert!(told("/*{\"INPUTS\": [{\"NAME\": \"a;b\", \"TYPE\": \"bool\"}]}*/").1.contains("GLSL"));
    }
}
