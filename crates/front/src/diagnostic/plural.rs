//! Counts with their nouns, in messages.

/// `1 location`, `3 locations`
pub(crate) fn plural(count: u32, noun: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{ending}")
}
