//! Help texts with lines to paste into a draw.
//!
//! *In:* lines for tables of a draw. *Out:* the help text. *Holds:* a table that the scene writes inline (`mesh = { .. }`) is repeated with
//! the new keys, as no header can add to it.

use crate::tables::Reader;
use toml::de::DeTable;

/// Lines for a table of a draw.
pub(super) struct Lines {
    /// The key of the table in the draw.
    pub(super) section: &'static str,
    /// Its new lines: `key = value`.
    pub(super) lines: Vec<String>,
    /// How many lines more there are than it is useful to give.
    pub(super) n_more: usize,
}

impl Lines {
    pub(super) fn new(section: &'static str, lines: Vec<String>) -> Self {
        Self { section, lines, n_more: 0 }
    }
}

/// The help text that adds the lines to the draw; `None` if there are none.
pub(super) fn help(reader: &Reader, draw: &DeTable<'_>, blocks: &[Lines]) -> Option<String> {
    let blocks: Vec<&Lines> = blocks.iter().filter(|block| !block.lines.is_empty()).collect();
    if let [block] = blocks.as_slice()
        && let [line] = block.lines.as_slice()
        && inline(reader, draw, block).is_none()
    {
        return Some(format!("add `{line}` under [draw.{}]", block.section));
    }
    let texts: Vec<String> = blocks
        .iter()
        .map(|block| match inline(reader, draw, block) {
            Some(whole) => format!("write `{whole}`"),
            None => {
                let more = if block.n_more > 0 { format!("\n# and {} more", block.n_more) } else { String::new() };
                format!("add under [draw.{}]:\n{}{more}", block.section, block.lines.join("\n"))
            }
        })
        .collect();
    (!texts.is_empty()).then(|| texts.join("\nand "))
}

/// The whole table with the new keys, if the draw has it inline.
fn inline(reader: &Reader, draw: &DeTable<'_>, block: &Lines) -> Option<String> {
    let node = draw.get(block.section)?;
    let text = reader.text.get(node.span())?;
    let inner = text.strip_prefix('{')?.strip_suffix('}')?.trim().trim_end_matches(',');
    let old = if inner.is_empty() { String::new() } else { format!("{inner}, ") };
    Some(format!("{} = {{ {old}{} }}", block.section, block.lines.join(", ")))
}

/// A name as a key of TOML.
pub(super) fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    if bare { name.to_owned() } else { format!("\"{name}\"") }
}

/// `` `a` ``, `` `a` and `b` ``, or `` `a`, `b` and 3 more ``.
pub(super) fn names(names: &[&str]) -> String {
    const MOST: usize = 6;
    let quoted: Vec<String> = names.iter().take(MOST).map(|name| format!("`{name}`")).collect();
    let more = names.len().saturating_sub(MOST);
    match (quoted.split_last(), more) {
        (None, _) => String::new(),
        (Some((last, [])), 0) => last.clone(),
        (Some((last, rest)), 0) => format!("{} and {last}", rest.join(", ")),
        (Some(_), more) => format!("{} and {more} more", quoted.join(", ")),
    }
}
