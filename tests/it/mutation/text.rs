//! Faults in WGSL text, by edits of tokens: the same kinds as in SPIR-V.
//!
//! *In:* emitted text. *Out:* mutations, of which naga's validator refuses some. *Not done here:* faults of calls
//! ([`text_calls`](super::text_calls)).

use super::tokens::{Sort, Token, body, closing, is_binary, tokens};
use super::{Kind, Mutation, Rewrite, Target, text_calls};
use glisten_front::hir::Stage;
use std::ops::Range;

/// Marks between operands, and what they become.
const MARKS: [(&str, &[&str], Kind); 20] = [
    ("+", &["-"], Kind::Operation),
    ("-", &["+"], Kind::Operation),
    ("*", &["+"], Kind::Operation),
    ("/", &["*"], Kind::Operation),
    ("%", &["/"], Kind::Operation),
    ("+=", &["-=", "="], Kind::Operation),
    ("-=", &["+="], Kind::Operation),
    ("*=", &["+=", "="], Kind::Operation),
    ("&", &["|"], Kind::Operation),
    ("|", &["&"], Kind::Operation),
    ("^", &["|"], Kind::Operation),
    (">>", &["<<"], Kind::Operation),
    ("<<", &[">>"], Kind::Operation),
    ("&&", &["||"], Kind::Control),
    ("||", &["&&"], Kind::Control),
    ("<", &["<=", ">"], Kind::Control),
    ("<=", &["<", ">="], Kind::Control),
    (">", &[">=", "<"], Kind::Control),
    (">=", &[">", "<="], Kind::Control),
    ("==", &["!="], Kind::Control),
];

/// Words, and what they become.
const WORDS: [(&str, &[&str], Kind); 12] = [
    ("break", &["continue"], Kind::Control),
    ("continue", &["break"], Kind::Control),
    ("vertex_index", &["instance_index"], Kind::Convention),
    ("instance_index", &["vertex_index"], Kind::Convention),
    ("dpdx", &["dpdy", "-dpdx"], Kind::Convention),
    ("dpdy", &["dpdx", "-dpdy"], Kind::Convention),
    ("floor", &["trunc", "ceil", "round"], Kind::Conversion),
    ("trunc", &["floor", "round"], Kind::Conversion),
    ("ceil", &["floor", "round"], Kind::Conversion),
    ("round", &["floor", "trunc"], Kind::Conversion),
    ("min", &["max"], Kind::Operation),
    ("max", &["min"], Kind::Operation),
];

/// A module's text and its tokens.
pub(super) struct Text<'a> {
    pub(super) text: &'a str,
    pub(super) list: Vec<Token<'a>>,
}

/// Every possible change of a text.
pub(super) fn mutations(text: &str, target: Target) -> Vec<Mutation> {
    let text = Text { text, list: tokens(text) };
    let mut found = Vec::new();
    for (place, token) in text.list.iter().enumerate() {
        match token.sort {
            Sort::Mark => found.extend(text.mark(place, token)),
            Sort::Word => found.extend(text.word(place, token, target)),
            Sort::Number => found.extend(text.number(place, token)),
        }
    }
    found.extend(text.members());
    found.extend(text.exchanged("binding", "@group"));
    found.extend(text.exchanged("location", "@location"));
    found.extend(text_calls::faults(&text));
    found
}

/// A float as WGSL writes it.
fn written(value: f32) -> String {
    if value < 0.0 { format!("({value:e}f)") } else { format!("{value:e}f") }
}

impl<'a> Text<'a> {
    /// A mutation; the line and what it was say where it is.
    pub(super) fn fault(&self, kind: Kind, what: &str, edits: Vec<(Range<usize>, String)>) -> Mutation {
        let at = edits.first().map_or(0, |(range, _)| range.start);
        let line = self.text[..at].lines().count().max(1);
        Mutation { kind, name: format!("line {line}: {what}"), rewrite: Rewrite::Text(edits) }
    }

    fn replaced(&self, kind: Kind, token: &Token<'_>, new: &str) -> Mutation {
        self.fault(kind, &format!("`{}` becomes `{new}`", token.text), vec![(token.range(), new.to_owned())])
    }

    fn is(&self, place: usize, wanted: &str) -> bool {
        self.list.get(place).is_some_and(|token| token.text == wanted)
    }

    fn mark(&self, place: usize, token: &Token<'_>) -> Vec<Mutation> {
        let mut found = Vec::new();
        if is_binary(self.text, token)
            && let Some((_, becomes, kind)) = MARKS.iter().find(|row| row.0 == token.text)
        {
            found.extend(becomes.iter().map(|new| self.replaced(*kind, token, new)));
        }
        match token.text {
            "++" => found.push(self.replaced(Kind::Integer, token, " += 2")),
            "--" => found.push(self.replaced(Kind::Integer, token, " -= 2")),
            "." => found.extend(self.swizzle(place)),
            "=" | "+=" | "-=" | "*=" | "/=" => found.extend(self.dropped(place)),
            _ => {}
        }
        found
    }

    /// Another component.
    fn swizzle(&self, place: usize) -> Option<Mutation> {
        let token = self.list.get(place + 1).filter(|token| token.text.chars().all(|c| "xyzw".contains(c)))?;
        let first = token.text.chars().next()?;
        let other = if first == 'x' { 'y' } else { 'x' };
        let new: String = [other].into_iter().chain(token.text.chars().skip(1)).collect();
        Some(self.replaced(Kind::Swizzle, token, &new))
    }

    /// A statement that assigns to a variable is dropped.
    fn dropped(&self, place: usize) -> Option<Mutation> {
        let is_end = |token: &Token<'_>| [";", "{", "}", "("].contains(&token.text);
        let begin = (0..place).rev().find(|at| is_end(&self.list[*at]))? + 1;
        let end = (place..self.list.len()).find(|at| is_end(&self.list[*at]) && !self.is(*at, "("))?;
        let first = self.list.get(begin)?;
        let declares = ["let", "var", "const", "override"].contains(&first.text);
        let in_head = self.is(begin - 1, "(");
        if declares || in_head || !self.is(end, ";") {
            return None;
        }
        let range = first.at..self.list[end].at + 1;
        let what = format!("`{}` is dropped", &self.text[range.clone()]);
        Some(self.fault(Kind::Dropped, &what, vec![(range, String::new())]))
    }

    fn word(&self, place: usize, token: &Token<'_>, target: Target) -> Vec<Mutation> {
        let is_name = !self.is(place + 1, ":");
        // The variable of a built-in value has the name of the value.
        let is_variable = token.text.ends_with("_index") && !self.is(place.saturating_sub(2), "builtin");
        let mut found: Vec<Mutation> = match WORDS.iter().find(|row| row.0 == token.text) {
            Some((_, becomes, kind)) if !is_variable => {
                becomes.iter().map(|new| self.replaced(*kind, token, new)).collect()
            }
            _ => Vec::new(),
        };
        match token.text {
            "if" | "while" => found.extend(self.condition(place)),
            "discard" => found.push(self.replaced(Kind::Dropped, token, "")),
            "invariant" if place > 0 => found.extend(self.attribute(place)),
            "interpolate" if target.stage == Stage::Vertex => found.extend(self.interpolation(place)),
            "front_facing" if is_name && !self.is(place - 1, "(") => {
                found.push(self.replaced(Kind::Convention, token, "!front_facing"));
            }
            "position" if is_name && self.is(place + 1, ".") && target.stage == Stage::Fragment => {
                found.extend(self.coordinate(place, target));
            }
            "gl_Position" if self.is(place + 1, ".") => found.extend(self.written(place)),
            "framebuffer_height" if self.is(place + 1, "-") => {
                // `uniforms.framebuffer_height - position.y`
                if let (Some(first), Some(minus)) = (self.list.get(place - 2), self.list.get(place + 1)) {
                    let edits = vec![(first.at..minus.at + 1, String::new())];
                    found.push(self.fault(Kind::Convention, "FragCoord.y counts from the top", edits));
                }
            }
            _ => {}
        }
        found
    }

    /// The condition of an `if` or a `while` is negated, or replaced by `true`.
    fn condition(&self, place: usize) -> Vec<Mutation> {
        let Some(open) = body(&self.list, place) else { return Vec::new() };
        let range = self.list[place].range().end..self.list[open].at;
        let condition = self.text[range.clone()].trim();
        let negated = self.fault(
            Kind::Control,
            &format!("`{condition}` is negated"),
            vec![(range.clone(), format!(" !({condition}) "))],
        );
        let always =
            self.fault(Kind::Control, &format!("`{condition}` becomes `true`"), vec![(range, " true ".to_owned())]);
        vec![negated, always]
    }

    /// Another interpolation, or none, of a varying in both stages: `@location(1) @interpolate(flat)`.
    fn interpolation(&self, place: usize) -> Vec<Mutation> {
        let (Some(first), Some(close)) = (place.checked_sub(6), closing(&self.list, place + 1)) else {
            return Vec::new();
        };
        let from = &self.text[self.list[first].at..self.list[close].range().end];
        let location = &self.text[self.list[first].at..self.list[place - 1].at];
        let old = &self.text[self.list[place + 1].range().end..self.list[close].at];
        let made = |new: &str| {
            let (to, kind) = match new {
                "" => (location.trim_end().to_owned(), Kind::Dropped),
                new => (format!("{location}@interpolate({new})"), Kind::Qualifier),
            };
            let name = format!("`{from}` becomes `{to}`");
            Mutation { kind, name, rewrite: Rewrite::Everywhere(from.to_owned(), to) }
        };
        ["", "flat", "linear", "perspective", "perspective, centroid"]
            .iter()
            .filter(|new| **new != old)
            .map(|new| made(new))
            .collect()
    }

    /// An attribute is dropped.
    fn attribute(&self, place: usize) -> Option<Mutation> {
        let mark = self.list.get(place - 1).filter(|mark| mark.text == "@")?;
        let last = if self.is(place + 1, "(") { closing(&self.list, place + 1)? } else { place };
        let range = mark.at..self.list[last].range().end;
        let what = format!("`{}` is dropped", &self.text[range.clone()]);
        Some(self.fault(Kind::Dropped, &what, vec![(range, String::new())]))
    }

    /// A component of the fragment's position.
    fn coordinate(&self, place: usize, target: Target) -> Vec<Mutation> {
        let Some(component) = self.list.get(place + 2) else { return Vec::new() };
        let range = self.list[place].at..component.range().end;
        let old = &self.text[range.clone()];
        let becomes =
            |new: String| self.fault(Kind::Convention, &format!("`{old}` becomes `{new}`"), vec![(range.clone(), new)]);
        match component.text {
            "x" => vec![becomes("(position.x + 0.5f)".to_owned()), becomes("(position.x - 0.5f)".to_owned())],
            "y" => {
                let flipped = format!("({}f - position.y)", target.height);
                vec![becomes(flipped), becomes("(position.y + 0.5f)".to_owned())]
            }
            "z" => vec![becomes("(position.z * 2f - 1f)".to_owned())],
            "w" => vec![becomes("(1f / position.w)".to_owned())],
            _ => Vec::new(),
        }
    }

    /// A component of the position where it is returned: `vec4<f32>(gl_Position.x, gl_Position.y, …`.
    fn written(&self, place: usize) -> Option<Mutation> {
        let (first, component) = (self.list.get(place)?, self.list.get(place + 2)?);
        let old = first.at..component.range().end;
        let fault = |what: &str, range: Range<usize>, new: &str| {
            Some(self.fault(Kind::Convention, what, vec![(range, new.to_owned())]))
        };
        match component.text {
            "x" if self.is(place + 3, ",") => fault("Position.x is flipped", old, "-gl_Position.x"),
            "y" if self.is(place + 3, ",") => fault("Position.y is flipped", old, "-gl_Position.y"),
            // `(gl_Position.z + w) * 0.5f`
            "z" if self.is(place + 3, "+") && self.is(place + 6, "*") => {
                let range = self.list[place - 1].at..self.list.get(place + 7)?.range().end;
                fault("Position.z is from -w to w", range, "gl_Position.z")
            }
            _ => None,
        }
    }

    /// Numbers: integers one off, floats with fewer digits.
    fn number(&self, place: usize, token: &Token<'_>) -> Vec<Mutation> {
        let is_attribute = place >= 3 && self.is(place - 3, "@");
        let is_template = self.is(place + 1, ">") && self.is(place - 1, ",");
        if is_attribute || is_template {
            return Vec::new();
        }
        let (digits, suffix) = match token.text.strip_suffix(['i', 'u', 'f']) {
            Some(digits) => (digits, &token.text[digits.len()..]),
            None => (token.text, ""),
        };
        if suffix == "f" {
            return self.float(token, digits);
        }
        let Ok(number) = digits.parse::<i64>() else { return Vec::new() };
        // The labels of cases have no suffix.
        let is_case = suffix.is_empty();
        let steps = if number == 0 { &[1][..] } else { &[1, -1][..] };
        let kind = if is_case { Kind::Control } else { Kind::Integer };
        steps.iter().map(|step| self.replaced(kind, token, &format!("{}{suffix}", number + step))).collect()
    }

    fn float(&self, token: &Token<'_>, digits: &str) -> Vec<Mutation> {
        let Ok(value) = digits.parse::<f32>() else { return Vec::new() };
        let half = f32::from_bits(value.to_bits().wrapping_add(0x1000) & !0x1fff);
        let changed = [half, value * 1.01, -value].into_iter().filter(|new| *new != value && new.is_finite());
        changed.map(|new| self.replaced(Kind::Constant, token, &written(new))).collect()
    }

    /// Two neighboring members of a struct of one type in exchange.
    fn members(&self) -> Vec<Mutation> {
        let mut found = Vec::new();
        let ends = |at: usize| self.is(at, ",") || self.is(at, "{");
        // `name: type,`: the type ends where the next comma between lines is.
        let member = |place: usize| -> Option<(usize, &str)> {
            let name = self.list.get(place).filter(|name| name.sort == Sort::Word && self.is(place + 1, ":"))?;
            let line = self.text[name.at..].lines().next()?;
            line.ends_with(',').then(|| (place, line.split_once(':').map_or("", |(_, ty)| ty)))
        };
        let all: Vec<(usize, &str)> = (1..self.list.len()).filter(|place| ends(place - 1)).filter_map(member).collect();
        for pair in all.windows(2) {
            let [(first, of), (second, ty)] = [pair[0], pair[1]];
            if of == ty && self.text[self.list[first].at..self.list[second].at].lines().count() <= 2 {
                let [first, second] = [&self.list[first], &self.list[second]];
                let edits = vec![(first.range(), second.text.to_owned()), (second.range(), first.text.to_owned())];
                let what = format!("members `{}` and `{}` are exchanged", first.text, second.text);
                found.push(self.fault(Kind::Memory, &what, edits));
            }
        }
        found
    }

    /// The numbers of two attributes in exchange where the lines are alike otherwise.
    fn exchanged(&self, attribute: &str, begins: &str) -> Vec<Mutation> {
        let mut found = Vec::new();
        let mut all: Vec<(&Token<'_>, String)> = Vec::new();
        for (place, token) in self.list.iter().enumerate() {
            let is_number = place >= 3 && token.sort == Sort::Number && self.is(place - 2, attribute);
            let line = self.text[..token.at].rfind('\n').map_or(0, |at| at + 1);
            let rest = self.text[token.at..].lines().next().unwrap_or_default();
            let head = self.text[line..token.at].trim_start();
            if is_number && head.starts_with(begins) {
                // Without the name: `) @interpolate(flat)` and `vec4<f32>,`.
                let (name, ty) = rest.split_once(": ").unwrap_or((rest, ""));
                let attributes = name.rsplit_once(' ').map_or("", |(attributes, _)| attributes);
                all.push((token, format!("{head} {attributes} {ty}")));
            }
        }
        for (place, (first, of)) in all.iter().enumerate() {
            if let Some((second, _)) = all[place + 1..].iter().find(|(_, like)| like == of) {
                let edits = vec![(first.range(), second.text.to_owned()), (second.range(), first.text.to_owned())];
                let what = format!("{attribute} {} and {} are exchanged", first.text, second.text);
                found.push(self.fault(Kind::Memory, &what, edits));
            }
        }
        found
    }
}
