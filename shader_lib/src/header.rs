//! The header of a module: lines `// key: value`, then notes.
//!
//! *In:* a module's text. *Out:* its [`Header`]. *Holds:* every module has all keys, as a test checks.

/// The information in the first comment lines of a module.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Header<'a> {
    /// The name, which is that of the file.
    pub name: &'a str,
    /// `light`, `diffuse`, `specular`, `ambient`, `equation`, `geometry`, `color`, `helper`, `interface` (declarations only)
    /// or `reference`.
    pub kind: &'a str,
    /// The equations, by number and as text.
    pub equation: &'a str,
    /// Their section in the source documents.
    pub source: &'a str,
    /// The rounding, the range and the poles to expect.
    pub stability: &'a str,
}

impl<'a> Header<'a> {
    /// Parses the header of a text.
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

/// The comment lines after the keys, about the whole module. Empty lines separate paragraphs.
pub(super) fn notes(text: &str) -> String {
    let comments = text.lines().map_while(|line| line.strip_prefix("//"));
    paragraphs(comments.skip_while(|line| !line.is_empty()))
}

/// Joins comment lines (without their slashes) into paragraphs; indented lines remain lines of their own.
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
