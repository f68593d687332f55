//! The words of a name.
//!
//! *In:* an identifier in any style. *Out:* its words in small letters, or the words without prefixes, joined.

/// The words of `name`: parts between underscores, capitals and digits, in small letters. A run of capitals is one word.
pub(super) fn words(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let mut words: Vec<String> = Vec::new();
    let mut previous = '_';
    for (index, &letter) in letters.iter().enumerate() {
        if letter == '_' {
            previous = letter;
            continue;
        }
        let next_is_small = letters.get(index + 1).is_some_and(|next| next.is_lowercase());
        let starts = previous == '_'
            || letter.is_numeric() != previous.is_numeric()
            || letter.is_uppercase() && (previous.is_lowercase() || next_is_small);
        let small = letter.to_lowercase();
        match words.last_mut() {
            Some(word) if !starts => word.extend(small),
            _ => words.push(small.collect()),
        }
        previous = letter;
    }
    words
}

/// The forms under which a table may have a name: without the words of `affixes`; whole; without one of the words at its
/// beginning, if it is written as one word.
pub(super) fn forms(name: &str, affixes: &[&str]) -> Vec<String> {
    let words = words(name);
    let kept: Vec<&str> = words.iter().map(String::as_str).filter(|word| !affixes.contains(word)).collect();
    let whole = words.concat();
    let shorter = affixes.iter().filter_map(|affix| whole.strip_prefix(affix)).map(str::to_owned);
    let mut forms = vec![kept.concat(), whole.clone()];
    forms.extend(shorter);
    forms.retain(|form| !form.is_empty());
    forms
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_every_style_have_the_same_words() {
        for (name, expected) in [
            ("vertexPosition_modelspace", &["vertex", "position", "modelspace"][..]),
            ("MVPMatrix", &["mvp", "matrix"]),
            ("aTexCoord0", &["a", "tex", "coord", "0"]),
            ("_Object2World", &["object", "2", "world"]),
            ("in_UV", &["in", "uv"]),
            ("p3d_Vertex", &["p", "3", "d", "vertex"]),
            ("worldIT", &["world", "it"]),
        ] {
            assert_eq!(words(name), expected, "{name}");
        }
    }
}
