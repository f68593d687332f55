//! Faults of calls in WGSL text: arguments in exchange, conversions, the operands of texture lookups.
//!
//! *In:* a text with its tokens. *Out:* mutations.

use super::text::Text;
use super::tokens::{Call, call};
use super::{Kind, Mutation};
use std::ops::Range;

/// Functions of two or more arguments, of which two do not commute.
const EXCHANGED: [(&str, [usize; 2]); 10] = [
    ("pow", [0, 1]),
    ("atan2", [0, 1]),
    ("step", [0, 1]),
    ("cross", [0, 1]),
    ("reflect", [0, 1]),
    ("mix", [0, 1]),
    ("smoothstep", [0, 1]),
    ("clamp", [0, 1]),
    ("select", [0, 1]),
    ("faceForward", [0, 1]),
];

/// Functions, and those that they are confused with.
const CONFUSED: [(&str, &str); 12] = [
    ("sin", "cos"),
    ("cos", "sin"),
    ("exp", "exp2"),
    ("exp2", "exp"),
    ("log", "log2"),
    ("log2", "log"),
    ("sqrt", "inverseSqrt"),
    ("inverseSqrt", "sqrt"),
    ("abs", ""),
    ("normalize", ""),
    ("fract", ""),
    ("transpose", ""),
];

/// All of these faults.
pub(super) fn faults(text: &Text<'_>) -> Vec<Mutation> {
    let mut found = Vec::new();
    for place in 0..text.list.len() {
        let Some(call) = call(&text.list, place) else { continue };
        let is_definition = place > 0 && text.list[place - 1].text == "fn";
        if is_definition {
            continue;
        }
        found.extend(exchanged(text, &call));
        found.extend(conversions(text, &call));
        found.extend(lookups(text, &call));
        if let Some((_, other)) = CONFUSED.iter().find(|row| row.0 == call.name.text) {
            let what = format!("`{}` becomes `{other}`", call.name.text);
            found.push(text.fault(Kind::Operation, &what, vec![(call.name.range(), (*other).to_owned())]));
        }
    }
    found
}

fn exchanged(text: &Text<'_>, call: &Call<'_>) -> Option<Mutation> {
    let (name, [first, second]) = *EXCHANGED.iter().find(|row| row.0 == call.name.text)?;
    let [first, second] = [call.arguments.get(first)?, call.arguments.get(second)?];
    let [one, other] = [first, second].map(|range| text.text[range.clone()].trim().to_owned());
    let edits = vec![(first.clone(), other), (second.clone(), format!(" {one}"))];
    Some(text.fault(Kind::Order, &format!("the arguments of `{name}` are exchanged"), edits))
}

/// Conversions by way of another type or rounding.
fn conversions(text: &Text<'_>, call: &Call<'_>) -> Vec<Mutation> {
    let [argument] = &call.arguments[..] else { return Vec::new() };
    let old = text.text[argument.clone()].trim();
    let ways: &[&str] = match call.name.text {
        "i32" => &["i32(round(_))", "i32(ceil(_))", "i32(floor(_))", "i32(u32(_))", "bitcast<i32>(_)"],
        "u32" => &["u32(round(_))", "u32(i32(_))", "bitcast<u32>(_)"],
        "f32" => &["f32(u32(_))", "f32(i32(_))", "bitcast<f32>(_)"],
        "bitcast" => &["f32(_)", "u32(_)", "i32(_)"],
        _ => &[],
    };
    let made = |way: &&str| {
        let new = way.replace('_', old);
        (new != text.text[call.range.clone()]).then(|| {
            text.fault(
                Kind::Conversion,
                &format!("`{}({old})` becomes `{new}`", call.name.text),
                vec![(call.range.clone(), new.clone())],
            )
        })
    };
    ways.iter().filter_map(made).collect()
}

/// The operands of texture lookups.
fn lookups(text: &Text<'_>, call: &Call<'_>) -> Vec<Mutation> {
    let Some(kind) = call.name.text.strip_prefix("texture").filter(|kind| kind.starts_with(['S', 'L', 'G'])) else {
        return Vec::new();
    };
    let mut found = Vec::new();
    let argument = |place: usize| call.arguments.get(place).map(|range| text.text[range.clone()].trim());
    let mut fault = |what: &str, edits: Vec<(Range<usize>, String)>| found.push(text.fault(Kind::Image, what, edits));
    let drop = |place: usize| vec![(call.arguments[place].start - 1..call.arguments[place].end, String::new())];
    let with = |place: usize, new: String| vec![(call.arguments[place].clone(), format!(" {new}"))];
    let named = |new: &str, mut edits: Vec<(Range<usize>, String)>| {
        edits.insert(0, (call.name.range(), new.to_owned()));
        edits
    };
    let end = call.range.end - 1;
    let at = if kind.starts_with("Load") { 1 } else { 2 };
    if let Some(coordinate) = argument(at) {
        let flipped = match kind.starts_with("Load") {
            true => format!("({coordinate}).yx"),
            false => format!("(vec2<f32>(0f, 1f) + ({coordinate}) * vec2<f32>(1f, -1f))"),
        };
        fault("v counts from the other side", with(at, flipped));
    }
    let last = call.arguments.len() - 1;
    if argument(last).is_some_and(|last| last.starts_with("vec2<i32>(") || last.starts_with("vec3<i32>(")) && last > 2 {
        fault("the offset is dropped", drop(last));
        let more = argument(last).map(|offset| format!("{offset} + 1i")).unwrap_or_default();
        fault("the offset is one more", with(last, more));
    }
    match kind {
        "Sample" if last == 2 => {
            let edits = named("textureSampleLevel", vec![(end..end, ", 0f".to_owned())]);
            fault("the implicit level of detail becomes 0", edits);
        }
        "SampleBias" if last == 3 => {
            let edits = named("textureSample", drop(3));
            fault("the bias is dropped", edits);
        }
        "SampleLevel" | "Load" if last >= 2 => {
            let place = if kind == "Load" { last } else { 3 };
            if let Some(level) = argument(place) {
                let (zero, one) = if kind == "Load" { ("0i", "1i") } else { ("0f", "1f") };
                if level != zero {
                    fault("the level of detail becomes 0", with(place, zero.to_owned()));
                }
                fault("the level of detail is 1 more", with(place, format!("{level} + {one}")));
            }
        }
        "SampleGrad" => {
            if let (Some(dx), Some(dy)) = (argument(3), argument(4)) {
                let swapped = [with(3, dy.to_owned()), with(4, dx.to_owned())].concat();
                fault("the gradients are exchanged", swapped);
                fault("the gradient along x is doubled", with(3, format!("2f * ({dx})")));
            }
        }
        "SampleCompare" | "SampleCompareLevel" | "GatherCompare" => {
            let place = if kind == "GatherCompare" { 3 } else { last };
            if let Some(reference) = argument(place) {
                fault("the reference is reversed", with(place, format!("1f - ({reference})")));
                fault("the reference is 1/64 more", with(place, format!("({reference}) + 0.015625f")));
            }
            if kind != "GatherCompare" {
                fault("the comparison is dropped", vec![(call.range.clone(), "1f".to_owned())]);
            }
        }
        _ => {}
    }
    found
}
