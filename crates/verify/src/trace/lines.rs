//! The lines of a trace for people.
//!
//! *In:* a [`Told`]. *Out:* for each invocation a headline, its inputs, a line for each value with its place, and its
//! outputs. *Holds:* a value that a declaration or an assignment repeats has one line.

use super::model::{Scalar, Told, ToldInvocation, ToldStep, ToldValue};
use super::numbers::short;

/// The columns of the text; longer texts are cut.
const WIDTH: usize = 56;

/// Which lines are shown.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shown {
    /// Values of variables that are read, too, the insides of the library's functions, and intervals.
    pub all: bool,
}

/// The files of the library begin so.
const LIBRARY: &str = "<glisten>/";

/// The lines of a trace.
pub fn lines(told: &Told, shown: Shown) -> String {
    let mut text = String::new();
    let what = match (told.pixel, told.vertex) {
        (Some([x, y]), _) => format!("pixel ({x}, {y})"),
        (None, Some(vertex)) => format!("vertex {vertex}"),
        (None, None) => String::new(),
    };
    let count = told.invocations.len();
    let fragments = if told.pixel.is_none() {
        String::new()
    } else if count == 0 {
        ": no fragment reached it".to_owned()
    } else {
        format!(": {count} fragment{}", if count == 1 { "" } else { "s" })
    };
    text.push_str(&format!("{}, {what}{fragments}\n", told.scene));
    for (number, invocation) in told.invocations.iter().enumerate() {
        text.push('\n');
        invocation_lines(invocation, (number, count), shown, &mut text);
    }
    for (number, color) in told.colors.iter().enumerate() {
        let name = if told.colors.len() == 1 { "color".to_owned() } else { format!("color {number}") };
        text.push_str(&format!("\n{name}  {}\n       exact {}\n", value(color), exact(color)));
        if let Some(range) = range(color) {
            text.push_str(&format!("       a GPU may draw {range}\n"));
        }
    }
    text
}

fn invocation_lines(invocation: &ToldInvocation, (number, of): (usize, usize), shown: Shown, text: &mut String) {
    text.push_str(&headline(invocation, (number, of)));
    let mut file = None;
    let steps = outside_of_the_library(&invocation.steps, shown);
    for (index, step) in steps.iter().enumerate() {
        let before = index.checked_sub(1).and_then(|before| steps.get(before)).copied();
        let next = steps.get(index + 1).copied();
        // The variable of `i++` is told with its new value before the expression.
        let next_is_stepped = next.zip(steps.get(index + 2)).is_some_and(|(next, after)| steps_it(after, next));
        if is_left_out(step, before, next.filter(|_| !next_is_stepped), shown) {
            continue;
        }
        if let Some(place) = step.place.as_ref().filter(|_| !matches!(step.kind, "input" | "output"))
            && file != Some(&place.file)
        {
            text.push_str(&format!("  {}\n", place.file));
            file = Some(&place.file);
        }
        text.push_str(&line(step, shown));
    }
    if invocation.left_out > 0 {
        text.push_str(&format!("  and {} values more, which were not kept\n", invocation.left_out));
    }
}

fn headline(invocation: &ToldInvocation, (number, of): (usize, usize)) -> String {
    let ToldInvocation { draw, instance, fate, .. } = invocation;
    let part = if *instance > 0 { format!("draw {draw}, instance {instance}") } else { format!("draw {draw}") };
    if let Some(vertex) = invocation.vertex {
        return format!("vertex {vertex} of {part}\n");
    }
    let vertices: Vec<String> = invocation.vertices.iter().map(u32::to_string).collect();
    let vertices = if vertices.is_empty() { String::new() } else { format!(" (vertices {})", vertices.join(", ")) };
    let facing = if invocation.front_facing == Some(false) { ", back face" } else { "" };
    let fate = match *fate {
        "discarded" => "discarded",
        "failed" => "failed the depth or stencil test",
        _ => "drawn",
    };
    let primitive = invocation.primitive.unwrap_or(0);
    let which = if of > 1 { format!(" {} of {of}", number + 1) } else { String::new() };
    format!("fragment{which}: primitive {primitive}{vertices} of {part}{facing}: {fate}\n")
}

/// The steps without those inside functions of the library.
fn outside_of_the_library(steps: &[ToldStep], shown: Shown) -> Vec<&ToldStep> {
    let is_inside = |step: &ToldStep| {
        !shown.all && step.depth > 0 && step.place.as_ref().is_some_and(|place| place.file.starts_with(LIBRARY))
    };
    let calls_it = |index: usize, step: &ToldStep| step.kind == "call" && steps.get(index + 1).is_some_and(is_inside);
    let kept = steps.iter().enumerate().filter(|(index, step)| !is_inside(step) && !calls_it(*index, step));
    kept.map(|(_, step)| step).collect()
}

/// Whether a step is `i++` or the like, and the one before it is its variable.
fn steps_it(step: &ToldStep, before: &ToldStep) -> bool {
    let operators = ["++", "--"];
    before.kind == "local"
        && operators
            .iter()
            .any(|operator| step.text.strip_suffix(operator).or(step.text.strip_prefix(operator)).is_some())
        && step.text.trim_matches(['+', '-', ' ']) == before.text
}

/// Whether the next step tells the same, or people seldom want to see it.
fn is_left_out(step: &ToldStep, before: Option<&ToldStep>, next: Option<&ToldStep>, shown: Shown) -> bool {
    let repeats = |next: &ToldStep| {
        // An operand of `&&` is not its result, even if both are true.
        let before = next.text.strip_suffix(step.text.as_str()).map(str::trim_end);
        let compares = |before: &str| ["==", "<=", ">=", "!="].iter().any(|operator| before.ends_with(operator));
        let is_assigned = before.is_none_or(|before| before.is_empty() || before.ends_with('=') && !compares(before));
        let ends_there = is_assigned
            && match (&step.place, &next.place) {
                (Some(step), Some(next)) => step.file == next.file && step.end == next.end,
                _ => false,
            };
        let is_declared_with_it = match (&step.place, &next.place) {
            (Some(step), Some(next)) => step.file == next.file && next.start <= step.start,
            _ => false,
        };
        let takes_it = matches!(next.kind, "local") && next.depth == step.depth && is_declared_with_it
            || ends_there && matches!(next.kind, "value" | "if" | "loop" | "switch");
        takes_it && next.value.value == step.value.value
    };
    match step.kind {
        "return" => true,
        "read" => !shown.all,
        // The variable of `i++` is told with its new value.
        "value" => before.is_some_and(|before| steps_it(step, before)) || next.is_some_and(repeats),
        _ => false,
    }
}

fn line(step: &ToldStep, shown: Shown) -> String {
    let indent = "  ".repeat(step.depth.min(20));
    let text = match step.kind {
        "local" => format!("{} =", step.text),
        "if" => format!("if ({})", step.text),
        "loop" => format!("while ({})", step.text),
        "switch" => format!("switch ({})", step.text),
        "call" => format!("call {}", step.text),
        _ => step.text.clone(),
    };
    let mut text = format!("{indent}{text}");
    if text.chars().count() > WIDTH {
        text = text.chars().take(WIDTH - 3).collect::<String>() + "...";
    }
    let at = match (step.kind, &step.place) {
        ("input", _) => "in".to_owned(),
        ("output", _) => "out".to_owned(),
        (_, Some(place)) => format!("{}:{}", place.start.line, place.start.column),
        (_, None) => String::new(),
    };
    let mut line = format!("  {at:>7}  {text:WIDTH$}  {}", value(&step.value));
    if step.value.is_far {
        line.push_str(&format!("  exact {}", exact(&step.value)));
    }
    if let Some(range) = range(&step.value).filter(|_| shown.all) {
        line.push_str(&format!("  in {range}"));
    }
    format!("{}\n", line.trim_end())
}

/// The exact value.
fn exact(value: &ToldValue) -> String {
    list(&value.exact.iter().map(|number| short(number.0)).collect::<Vec<_>>())
}

fn value(value: &ToldValue) -> String {
    let scalar = |scalar: &Scalar| match scalar {
        Scalar::Float(number) => short(number.0),
        Scalar::Int(number) => number.to_string(),
        Scalar::Bool(truth) => truth.to_string(),
    };
    list(&value.value.iter().map(scalar).collect::<Vec<_>>())
}

fn range(value: &ToldValue) -> Option<String> {
    let bounds = value.interval.iter().map(|[low, high]| format!("{}..{}", short(low.0 + 0.0), short(high.0 + 0.0)));
    let bounds: Vec<String> = bounds.collect();
    let nan = if value.may_be_nan { " or NaN" } else { "" };
    (!bounds.is_empty()).then(|| format!("{}{nan}", list(&bounds)))
}

/// One number alone, several in parentheses.
fn list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [..] if items.len() > 16 => {
            format!("({}, ... {} in all)", items.get(..16).unwrap_or(&[]).join(", "), items.len())
        }
        _ => format!("({})", items.join(", ")),
    }
}
