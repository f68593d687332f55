//! Names in Rust.
//!
//! *In:* names in GLSL, and names of files. *Out:* names of modules, fields and types by Rust's conventions. *Holds:* the result
//! is a name in Rust, whatever the input.

/// Words that name nothing in Rust.
const KEYWORDS: [&str; 52] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "do", "dyn", "else", "enum",
    "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro", "match", "mod", "move",
    "mut", "override", "priv", "pub", "ref", "return", "static", "struct", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield", "crate", "self", "super", "union",
];

/// A name in small letters with words apart: `ci_model_view` for `ciModelView`.
pub(super) fn snake(name: &str) -> String {
    let mut text = String::new();
    let mut before = '_';
    for (index, one) in name.chars().enumerate() {
        let small_next = name.chars().nth(index + 1).is_some_and(char::is_lowercase);
        let starts = one.is_uppercase()
            && (before.is_lowercase() || before.is_ascii_digit() || before.is_uppercase() && small_next);
        if starts && before != '_' {
            text.push('_');
        }
        let letter = if one.is_ascii_alphanumeric() { one } else { '_' };
        // Two underscores within a name are against the conventions.
        let doubles = letter == '_' && text.ends_with('_') && !text.chars().all(|one| one == '_');
        if !doubles {
            text.push(letter.to_ascii_lowercase());
        }
        before = letter;
    }
    if text.is_empty() || text.starts_with(|first: char| first.is_ascii_digit()) {
        text.insert(0, '_');
    }
    // A name of signs alone is a pattern.
    if text.chars().all(|one| one == '_') { format!("{text}name") } else { text }
}

/// A field's name, which is no keyword.
pub(super) fn field(name: &str) -> String {
    let name = snake(name);
    if KEYWORDS.contains(&name.as_str()) { format!("{name}_") } else { name }
}

/// The name of a program's module.
pub(in super::super) fn module_name(name: &str) -> String {
    field(name)
}

/// A type's name: `PointLight` for `pointLight` and `point_light`.
pub(super) fn pascal(name: &str) -> String {
    let snake = snake(name);
    let mut text = String::new();
    for word in snake.split('_').filter(|word| !word.is_empty()) {
        let mut letters = word.chars();
        text.extend(letters.next().map(|first| first.to_ascii_uppercase()));
        text.push_str(letters.as_str());
    }
    if text.starts_with(|first: char| first.is_ascii_digit()) { format!("_{text}") } else { text }
}

/// A name of a field that is not among those that are taken: `light_2`.
pub(super) fn fresh(wanted: String, taken: impl Fn(&str) -> bool) -> String {
    // Two underscores within a name are against the conventions.
    let stem = format!("{}_", wanted.trim_end_matches('_'));
    numbered(wanted, &stem, taken)
}

/// A name of a type that is not among those that are taken: `Light2`.
pub(super) fn fresh_type(wanted: String, taken: impl Fn(&str) -> bool) -> String {
    let stem = wanted.clone();
    numbered(wanted, &stem, taken)
}

/// The name, or the first free one of those with a number from 2 on behind the stem.
fn numbered(wanted: String, stem: &str, taken: impl Fn(&str) -> bool) -> String {
    if !taken(&wanted) {
        return wanted;
    }
    let mut names = (2..).map(|number: u32| format!("{stem}{number}"));
    names.find(|name| !taken(name)).unwrap_or(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_follow_the_conventions_of_rust() {
        for (glsl, in_snake, in_pascal) in [
            ("ciModelView", "ci_model_view", "CiModelView"),
            ("uMVPMatrix", "u_mvp_matrix", "UMvpMatrix"),
            ("p3d_LightSource", "p3d_light_source", "P3dLightSource"),
            ("light2D", "light2_d", "Light2D"),
            ("X", "x", "X"),
            ("_x", "_x", "X"),
            ("lists[0]_texels", "lists_0_texels", "Lists0Texels"),
            ("__x__y", "__x_y", "XY"),
        ] {
            assert_eq!((snake(glsl).as_str(), pascal(glsl).as_str()), (in_snake, in_pascal), "{glsl}");
        }
        assert_eq!(field("type"), "type_");
        assert_eq!(module_name("01-ball.main"), "_01_ball_main");
        assert_eq!(snake("___"), "___name");
        assert_eq!(fresh("a".into(), |name| name == "a" || name == "a_2"), "a_3");
        assert_eq!(fresh("self_".into(), |name| name == "self_"), "self_2");
        assert_eq!(fresh_type("Light".into(), |name| name == "Light" || name == "Light2"), "Light3");
    }
}
