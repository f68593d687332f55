//! The page as HTML: the kit of all pages, the editor, and what the page starts with.
//!
//! *In:* what the script reads at the start. *Out:* HTML that loads nothing from a network.

use glisten_emit::Target;
use glisten_front::builtin::functions;
use glisten_front::syntax::keywords;
use glisten_front::syntax::token::TokenKind;
use glisten_page::Page;
use minijinja::context;
use serde_json::{Value, json};

const PLAY: Page = Page {
    templates: &[("play.html", include_str!("page/play.html"))],
    styles: &[include_str!("page/play.css")],
    scripts: &[
        include_str!("page/editor.js"),
        "\n",
        include_str!("page/webgpu.js"),
        include_str!("page/texts.js"),
        include_str!("page/saving.js"),
        include_str!("page/asking.js"),
        include_str!("page/studies.js"),
        include_str!("page/matching.js"),
        include_str!("page/play.js"),
    ],
};

/// The page with what its script starts with: `mode` and what belongs to it.
pub(super) fn page(title: &str, mut start: Value) -> Result<String, String> {
    let targets: Vec<Value> = Target::ALL
        .iter()
        .filter(|target| target.is_text())
        .map(|target| json!({ "word": target.word(), "name": target.name() }))
        .collect();
    if let Some(start) = start.as_object_mut() {
        start.insert("targets".into(), targets.into());
        start.insert("words".into(), words());
    }
    // Nothing within the text may end the element that holds it.
    let start = start.to_string().replace('<', "\\u003c");
    let values = context! { title, start => minijinja::Value::from_safe_string(start) };
    PLAY.render(values).map_err(|error| format!("the page cannot be made: {error}"))
}

/// The words of the languages by their classes, for the editor.
fn words() -> Value {
    let is_type = |row: &&keywords::Keyword| matches!(row.kind, TokenKind::Type | TokenKind::Void);
    let (types, keywords): (Vec<_>, Vec<_>) = keywords::TABLE.iter().partition(is_type);
    let spelled =
        |rows: Vec<&'static keywords::Keyword>| -> Vec<&str> { rows.iter().map(|row| row.spelling).collect() };
    let (types, keywords) = (spelled(types), spelled(keywords));
    let builtins: Vec<&str> = functions::names().collect();
    json!({
        "glsl": { "keyword": keywords, "type": types, "builtin": builtins },
        "wgsl": {
            "keyword": [
                "alias", "break", "case", "const", "continue", "continuing", "default", "discard", "else", "enable",
                "false", "fn", "for", "if", "let", "loop", "override", "return", "struct", "switch", "true", "var",
                "while", "uniform", "storage", "private", "function", "read", "write",
            ],
            "type": [
                "array", "atomic", "bool", "f16", "f32", "i32", "u32", "mat2x2", "mat2x3", "mat2x4", "mat3x2", "mat3x3",
                "mat3x4", "mat4x2", "mat4x3", "mat4x4", "ptr", "sampler", "sampler_comparison", "texture_1d",
                "texture_2d", "texture_2d_array", "texture_3d", "texture_cube", "texture_cube_array",
                "texture_depth_2d", "texture_depth_2d_array", "texture_depth_cube", "texture_multisampled_2d", "vec2",
                "vec3", "vec4",
            ],
        },
        "toml": { "keyword": ["true", "false", "inf", "nan"] },
    })
}

#[cfg(test)]
mod tests {
    use super::page;
    use serde_json::json;

    #[test]
    fn the_page_loads_nothing_and_no_text_ends_its_data() {
        let html = page("a < b", json!({ "mode": "server", "text": "</script><b>" })).expect("the template is good");
        assert!(html.contains("<title>a &lt; b</title>") && html.contains("\\u003c/script>\\u003cb>"));
        assert_eq!(html.matches("</script>").count(), 2, "the data and the script");
        for outside in ["https://", "url(http", "@import", "import("] {
            assert!(!html.contains(outside), "{outside}");
        }
    }
}
