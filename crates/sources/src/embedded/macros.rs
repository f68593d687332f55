//! Macros of C that make shaders of their arguments: `#define SHADER(code) "#version 150\n" #code`.
//!
//! *In:* the text of a file. *Out:* whether it defines one. *Holds:* the shaders in the arguments of such macros are not read.

/// Whether a text defines a macro that puts its argument behind the `#version` line of a string.
pub fn has_unread_macros(text: &str) -> bool {
    text.contains("#version")
        && text.match_indices("define").any(|(at, word)| {
            let before = text.get(..at).unwrap_or("").trim_end_matches([' ', '\t']);
            before.ends_with('#') && text.get(at + word.len()..).is_some_and(|rest| makes_shader(definition(rest)))
        })
}

/// The text up to the end of its line, with the lines that it is joined with.
fn definition(text: &str) -> &str {
    let is_end = |at: usize| !text.get(..at).unwrap_or("").trim_end_matches('\r').ends_with('\\');
    let end = text.match_indices('\n').map(|(at, _)| at).find(|at| is_end(*at));
    text.get(..end.unwrap_or(text.len())).unwrap_or("")
}

/// Whether `NAME(parameter, ..) body` has the line of a version in a string, and a parameter as a string.
fn makes_shader(definition: &str) -> bool {
    let Some((head, body)) = definition.split_once(')') else { return false };
    let Some((name, parameters)) = head.split_once('(') else { return false };
    let mut strings = body.split('"').skip(1).step_by(2);
    let is_name = !name.trim_start().contains(char::is_whitespace);
    is_name
        && strings.any(|string| string.trim_start().starts_with("#version"))
        && parameters.split(',').any(|one| is_string(body, one.trim()))
}

/// Whether the code outside of the strings of a body has `#parameter`.
fn is_string(body: &str, parameter: &str) -> bool {
    let name = if parameter == "..." { "__VA_ARGS__" } else { parameter };
    body.split('"').step_by(2).flat_map(|code| code.split('#').skip(1)).any(|behind| {
        let rest = behind.trim_start().strip_prefix(name).filter(|_| !name.is_empty());
        rest.is_some_and(|rest| !rest.starts_with(|next: char| next == '_' || next.is_alphanumeric()))
    })
}

#[cfg(test)]
mod tests {
    use super::has_unread_macros;

    #[test]
    fn macros_that_make_strings_of_shaders_are_known() {
        for text in [
            "#define GLSL410(shader)  \"#version 410 \\n #define TINY 0.000001 \\n\" #shader\n",
            "#  define GLSL(...) \\\n  \"#version 150\\n\" \\\n  #__VA_ARGS__\n",
        ] {
            assert!(has_unread_macros(text), "{text}");
        }
        for text in [
            "#define HEADER \"#version 410\\n\"\n",
            "#define NAME(x) #x\nconst char* a = \"#version 150\\n\";\n",
            "#define F(x) \"#version 150\\n#x\"\n",
        ] {
            assert!(!has_unread_macros(text), "{text}");
        }
    }
}
