//! What the ways back cannot write, and what they write wrong: faults that are not those of glisten.
//!
//! *In:* a message, or a text. *Out:* the reason that the table tells. *Holds:* each row has the seed of a program that shows it.

use super::Way;

/// A limit of a way back.
struct Limit {
    way: Way,
    /// What the message has: of the tool, or of glisten about the text that it wrote.
    message: &'static str,
    why: &'static str,
}

/// Texts that glisten refuses with reason.
static TEXTS: &[Limit] = &[
    // Seed 101758 among others: comparisons that gather have their components elsewhere.
    Limit { way: Way::Naga, message: "`textureGather", why: "naga writes another comparison that gathers" },
];

/// Messages of the tool.
static MESSAGES: &[(&str, &str)] = &[];

/// Texts whose picture is another one, by what they have.
static PICTURES: &[Limit] = &[];

/// The limit that makes a text one that glisten refuses.
pub(super) fn of_text(way: Way, message: &str) -> Option<&'static str> {
    reason(TEXTS, way, message)
}

/// The limit that makes a text draw another picture.
pub(super) fn of_picture(way: Way, text: &str) -> Option<&'static str> {
    reason(PICTURES, way, text)
}

/// The limit that spirv-cross tells.
pub(super) fn of_tool(message: &str) -> Option<&'static str> {
    MESSAGES.iter().find(|(part, _)| message.contains(part)).map(|(_, why)| *why)
}

fn reason(limits: &'static [Limit], way: Way, text: &str) -> Option<&'static str> {
    limits.iter().find(|one| one.way == way && text.contains(one.message)).map(|one| one.why)
}
