//! The header of a module: lines `// key: value`, then notes.
//!
//! *In:* a module's text. *Out:* its [`Header`]. *Holds:* every module has all keys; a test says when one lacks.

/// What a module says of itself in its first comment lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Header<'a> {
    /// Its name, that of its file.
    pub name: &'a str,
    /// `light`, `diffuse`, `specular`, `ambient`, `equation`, `geometry`, `helper`, `interface`
    /// (declarations alone) or `reference`.
    pub kind: &'a str,
    /// The equations, by number and as text.
    pub equation: &'a str,
    /// Where in the source documents they stand.
    pub source: &'a str,
    /// What to expect of its rounding, range and poles.
    pub stability: &'a str,
}

impl<'a> Header<'a> {
    /// Reads the header of a text.
    pub fn of(text: &'a str) -> Self {
        let mut header = Self::default();
        for line in text.lines() {
            let Some((key, value)) = line.strip_prefix("// ").and_then(|line| line.split_once(": ")) else { break };
            let field = match key {
                "name" => &mut header.name,
                "kind" => &mut header.kind,
                "equation" => &mut header.equation,
                "source" => &mut header.source,
                "stability" => &mut header.stability,
                _ => break,
            };
            *field = value.trim();
        }
        header
    }
}

/// The comment lines behind the keys: what holds for the whole module. Paragraphs are parted by empty lines.
pub(super) fn notes(text: &str) -> String {
    let comments = text.lines().map_while(|line| line.strip_prefix("//"));
    paragraphs(comments.skip_while(|line| !line.is_empty()))
}

/// Comment lines (without their slashes) joined to paragraphs; lines that are indented stay lines of their own.
pub(super) fn paragraphs<'a>(lines: impl Iterator<Item = &'a str>) -> String {
    let mut text = String::new();
    for line in lines {
        let line = line.strip_prefix(' ').unwrap_or(line).trim_end();
        let fresh = text.is_empty() || text.ends_with('\n');
        if line.is_empty() || line.starts_with(' ') {
            text.push_str(if fresh { "" } else { "\n" });
            text.push_str(line);
            text.push_str(if line.is_empty() && text.is_empty() { "" } else { "\n" });
        } else {
            text.push_str(if fresh { "" } else { " " });
            text.push_str(line);
        }
    }
    text.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::{Header, notes};

    #[test]
    fn a_header_is_read_by_its_keys() {
        let text = "// name: a\n// kind: light\n// equation: (1): x = y\n// source: here\n// stability: good\n//\n\
                    // One\n// line.\n//   k  a list\n// Two.\n#ifndef A\n";
        let header = Header { name: "a", kind: "light", equation: "(1): x = y", source: "here", stability: "good" };
        assert_eq!(Header::of(text), header);
        assert_eq!(notes(text), "One line.\n  k  a list\nTwo.");
    }
}
