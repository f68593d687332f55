//! Limits of the ways back: what they cannot write, and what they write wrong. These are no faults of glisten.
//!
//! *In:* a message, or a text. *Out:* the reason that the table tells. *Holds:* a limit is asked for only where a way has failed. What one way
//! writes wrong and another one right needs no row.

use super::super::drawn::Origin;
use super::Way;

/// A limit of a way back.
struct Limit {
    ways: &'static [Way],
    /// Whether a text has it: the error of glisten about GLSL that came back, or that GLSL itself.
    has: fn(&str) -> bool,
    why: &'static str,
}

/// GLSL that glisten refuses with reason.
static REFUSED: &[Limit] = &[
    // Comparisons that gather have their components elsewhere.
    Limit {
        ways: &[Way::Naga],
        has: |message| message.contains("`textureGather"),
        why: "naga writes another comparison that gathers",
    },
    // `textureOffset` and its like. Seed 101758 of commit 961eb28e.
    Limit {
        ways: &[Way::Naga],
        has: |message| message.contains("no overload takes `texture") && message.contains("Offset("),
        why: "naga writes an offset of a lookup as a float",
    },
    // A member of a block that is a `bool` is a `uint` there, and in comparisons of structs stays one.
    Limit {
        ways: &[Way::Cross, Way::Plain],
        has: |message| message.contains("qual(bvec") || message.contains("does not take a `bool` and a `uint`"),
        why: "spirv-cross compares a `bool` of a block as a `uint`",
    },
    // A struct with such a member has a second type in a block.
    Limit {
        ways: &[Way::Cross, Way::Plain],
        has: |message| message.contains("the left side is a `S") && message.contains("cannot hold a `S"),
        why: "spirv-cross assigns a struct of a block to one that is none",
    },
    Limit {
        ways: &[Way::Cross, Way::Plain],
        has: |message| message.contains("`spvWorkaroundRowMajor"),
        why: "spirv-cross takes an array of matrices for a matrix",
    },
];

/// GLSL whose picture is another one.
static OTHER: &[Limit] = &[
    // A `switch` with one label becomes `do { .. } while (false)`, and `continue` of the loop around it then continues that. Seed 104900 of
    // commit 961eb28e.
    Limit {
        ways: &[Way::Cross, Way::Plain],
        has: continues_inside,
        why: "spirv-cross writes `continue` of a loop inside of a `do` that is a `switch`",
    },
    // An `out` parameter that gets a constant array becomes that constant, and the caller sees nothing of it. Seed 410044 of
    // commit 74468c4d.
    Limit {
        ways: &[Way::Cross, Way::Plain],
        has: has_table_and_array,
        why: "spirv-cross takes a parameter that gets a constant array for a table",
    },
];

/// Messages of spirv-cross about code of somebody, and the reasons.
static MESSAGES: &[(Origin, &str, &str)] = &[
    // An identifier is defined twice, which spirv-val tells. Seed 200488 of commit 0d7f9e0f.
    (Origin::Glslang, "threw an exception: nullptr", "glslang copies a struct with booleans out of a block wrong"),
    // Seed 213208 of commit 0d7f9e0f.
    (Origin::Glslang, "spirv_glsl.cpp", "an assertion of spirv-cross fails"),
];

/// The limit that makes a text one that glisten refuses.
pub(super) fn of_refusal(way: Way, message: &str) -> Option<&'static str> {
    reason(REFUSED, way, message)
}

/// The limit that makes a text draw another picture.
pub(super) fn of_picture(way: Way, text: &str) -> Option<&'static str> {
    reason(OTHER, way, text)
}

/// The limit that spirv-cross tells.
pub(super) fn of_tool(origin: Origin, message: &str) -> Option<&'static str> {
    MESSAGES.iter().find(|(of, part, _)| *of == origin && message.contains(part)).map(|(.., why)| *why)
}

/// How the table tells that another way than this one draws the right picture.
pub(super) fn of_way(way: Way) -> &'static str {
    match way {
        Way::Naga => "naga writes it wrong; another way draws the picture",
        Way::Cross => "spirv-cross writes it wrong; another way draws the picture",
        Way::Plain => "spirv-cross with temporaries writes it wrong; another way draws the picture",
    }
}

fn reason(limits: &'static [Limit], way: Way, text: &str) -> Option<&'static str> {
    limits.iter().find(|one| one.ways.contains(&way) && (one.has)(text)).map(|one| one.why)
}

/// Whether a `do` that ends with `while(false)` has a `continue` of its own.
fn continues_inside(text: &str) -> bool {
    // Of each open block: whether it is a loop, whether it is a `do`, whether it has a `continue`.
    let mut open: Vec<(bool, bool, bool)> = Vec::new();
    let mut before = "";
    for line in text.lines().map(str::trim) {
        match line {
            "{" => {
                let is_loop = before == "do" || before.starts_with("for ") || before.starts_with("while ");
                open.push((is_loop, before == "do", false));
            }
            "continue;" => {
                open.iter_mut().rev().find(|(is_loop, ..)| *is_loop).into_iter().for_each(|one| one.2 = true)
            }
            _ if line.starts_with('}') => {
                if let Some((_, true, true)) = open.pop()
                    && line.contains("while(false)")
                {
                    return true;
                }
            }
            _ => {}
        }
        before = line;
    }
    false
}

/// Whether a text has a constant array, and a function with an array that is passed by value.
fn has_table_and_array(text: &str) -> bool {
    let is_table = |line: &str| line.starts_with("const ") && line.contains("] = ");
    let has_array = |line: &str| {
        let parameters = line.strip_suffix(')').and_then(|line| line.split_once('(')).map(|(_, parameters)| parameters);
        let by_value = |one: &str| one.ends_with(']') && !one.trim_start().starts_with("inout ");
        !line.starts_with([' ', '/', 'l']) && parameters.is_some_and(|parameters| parameters.split(", ").any(by_value))
    };
    text.lines().any(is_table) && text.lines().any(has_array)
}

#[cfg(test)]
mod tests {
    use super::{continues_inside, has_table_and_array};

    #[test]
    fn an_array_by_value_is_a_parameter() {
        let text = |head: &str| format!("const ivec4 _28[3] = ivec4[](ivec4(1));\n{head}\n{{\n}}\n");
        assert!(has_table_and_array(&text("bvec2 _25(vec2 _23, ivec4 _24[3])")));
        assert!(!has_table_and_array(&text("bvec2 _25(inout ivec4 _24[3])")));
        assert!(!has_table_and_array(&text("bvec2 _25(ivec4 _24)")));
    }

    #[test]
    fn a_continue_belongs_to_the_innermost_loop() {
        let text = |inner: &str| {
            format!("for (;;)\n{{\n    do\n    {{\n        {inner}\n    }} while(false);\n    continue;\n}}\n")
        };
        assert!(continues_inside(&text("if (a)\n{\ncontinue;\n}")));
        assert!(!continues_inside(&text("for (;;)\n{\ncontinue;\n}")));
        assert!(!continues_inside(&text("break;")));
    }
}
