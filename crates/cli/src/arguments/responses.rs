//! Response files: `@FILE` among the arguments is replaced by the words in the file.
//!
//! *In:* the arguments. *Out:* the arguments without response files. *Holds:* words are told apart as GCC and Clang do: white
//! space separates them, quotes of either kind keep it, and a backslash keeps the next character, in quotes, too. A file may
//! name others. What begins with `@` and names no file stays as it is, as does what follows `--`.

use crate::exit::Failure;
use glisten_scene::may_end;
use std::ffi::OsString;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// How deep response files may name others, and how many words there may be.
const MAX_DEPTH: usize = 32;
const MAX_WORDS: usize = 1 << 20;
/// The largest response file.
const MAX_BYTES: u64 = 64 << 20;

/// The arguments, with those of response files in their places.
///
/// # Errors
/// Response files that name each other in a circle, a quote without end, or a file that is not text.
pub(crate) fn expanded(arguments: Vec<OsString>) -> Result<Vec<OsString>, Failure> {
    let mut words = Vec::with_capacity(arguments.len());
    let mut rest = arguments.into_iter();
    // The first is the name of the program.
    words.extend(rest.next());
    let mut is_literal = false;
    for argument in rest {
        is_literal |= argument == "--";
        if is_literal { words.push(argument) } else { expand(argument, 0, &mut words)? }
    }
    Ok(words)
}

/// The bytes of a file; none of what is no file, never ends or is too large for arguments.
fn read(path: &Path) -> Option<Vec<u8>> {
    may_end(path).ok().filter(|ends| *ends)?;
    let mut bytes = Vec::new();
    File::open(path).ok()?.take(MAX_BYTES + 1).read_to_end(&mut bytes).ok()?;
    (bytes.len() as u64 <= MAX_BYTES).then_some(bytes)
}

fn expand(argument: OsString, depth: usize, words: &mut Vec<OsString>) -> Result<(), Failure> {
    let name = argument.to_str().and_then(|text| text.strip_prefix('@')).filter(|name| !name.is_empty());
    let Some((name, bytes)) = name.and_then(|name| Some((name.to_owned(), read(Path::new(name))?))) else {
        words.push(argument);
        return Ok(());
    };
    if depth == MAX_DEPTH {
        return Err(Failure::usage(format!("response files name each other: `@{name}`")));
    }
    let text = String::from_utf8(bytes).map_err(|_| Failure::usage(format!("`{name}` is not text in UTF-8")))?;
    for word in split(&text).ok_or_else(|| Failure::usage(format!("a quote in `{name}` has no end")))? {
        if words.len() >= MAX_WORDS {
            return Err(Failure::usage(format!("there are more than {MAX_WORDS} arguments (`@{name}`)")));
        }
        expand(word.into(), depth + 1, words)?;
    }
    Ok(())
}

/// The words of a text; `None` if a quote has no end.
fn split(text: &str) -> Option<Vec<String>> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    let mut letters = text.strip_prefix('\u{feff}').unwrap_or(text).chars();
    while let Some(letter) = letters.next() {
        match (letter, quote) {
            ('\\', _) => word.get_or_insert_default().extend(letters.next()),
            (_, Some(open)) if letter == open => quote = None,
            (_, Some(_)) => word.get_or_insert_default().push(letter),
            ('"' | '\'', None) => {
                quote = Some(letter);
                // A pair of quotes is an empty word.
                word.get_or_insert_default();
            }
            _ if letter.is_ascii_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(letter),
        }
    }
    words.extend(word);
    quote.is_none().then_some(words)
}

#[cfg(test)]
mod tests {
    use super::{expanded, split};
    use std::fs;

    #[test]
    fn words_are_those_of_gcc() {
        for (text, words) in [
            ("", &[][..]),
            (" a\tb\r\nc ", &["a", "b", "c"]),
            (r#""a b" 'c d' e" "f"#, &["a b", "c d", "e f"]),
            (r#"a\ b \"c\" "d\"e" 'f\'g' \\"#, &["a b", "\"c\"", "d\"e", "f'g", "\\"]),
            (r#"-DX="" '' -DY='"z"'"#, &["-DX=", "", "-DY=\"z\""]),
        ] {
            assert_eq!(
                split(text).as_deref(),
                Some(&words.iter().map(|word| (*word).to_owned()).collect::<Vec<_>>()[..])
            );
        }
        assert_eq!((split("\"a"), split("it's")), (None, None));
    }

    #[test]
    fn files_may_name_others_but_not_themselves() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name).display().to_string();
        fs::write(path("inner"), "b 'c d'").expect("written");
        fs::write(path("outer"), format!("a @{}\ne", path("inner"))).expect("written");
        fs::write(path("circle"), format!("@{}", path("circle"))).expect("written");
        let run = |words: &[String]| {
            expanded(words.iter().map(Into::into).collect())
                .map(|words| words.iter().map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>())
        };
        let outer = format!("@{}", path("outer"));
        let words = run(&["glisten".into(), outer.clone(), "@none".into(), "--".into(), outer.clone()]);
        assert_eq!(words.expect("words"), ["glisten", "a", "b", "c d", "e", "@none", "--", &outer]);
        assert!(run(&["glisten".into(), format!("@{}", path("circle"))]).is_err());
    }
}
