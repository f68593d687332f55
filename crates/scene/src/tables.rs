//! Typed access to TOML, for scenes, `glisten.toml` and permutations: every value is requested by its required type, and any
//! other value is reported at its position.
//!
//! *In:* the text of a file. *Out:* numbers, texts, choices, or `None` with a diagnostic. *Holds:* all errors of a file are
//! reported; numbers are parsed from their decimal text directly to `f32`, so they are rounded once.

use glisten_front::diagnostic::codes::general::BAD_CONFIG;
use glisten_front::diagnostic::codes::scenes::{
    SCENE_SYNTAX, SCENE_UNKNOWN_KEY, SCENE_UNKNOWN_NAME, SCENE_WRONG_TYPE, SCENE_WRONG_VALUE,
};
use glisten_front::diagnostic::{Advice, Code, Diagnostic, Diagnostics, did_you_mean, nearest_path};
use glisten_front::source::Span;
use std::ops::{Range, RangeInclusive};
use std::sync::Arc;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

/// The codes of a kind of file: what is reported under them.
#[derive(Debug)]
pub struct Codes {
    /// The file is not TOML.
    pub syntax: &'static Code,
    /// A key that its table does not have.
    pub unknown_key: &'static Code,
    /// A value of another type.
    pub wrong_type: &'static Code,
    /// A value of the right type that is not allowed.
    pub wrong_value: &'static Code,
}

/// The codes of a scene.
pub static SCENE: Codes = Codes {
    syntax: &SCENE_SYNTAX,
    unknown_key: &SCENE_UNKNOWN_KEY,
    wrong_type: &SCENE_WRONG_TYPE,
    wrong_value: &SCENE_WRONG_VALUE,
};

/// The codes of `glisten.toml` and of permutations.
pub static CONFIGURATION: Codes =
    Codes { syntax: &BAD_CONFIG, unknown_key: &BAD_CONFIG, wrong_type: &BAD_CONFIG, wrong_value: &BAD_CONFIG };

/// A value and its span.
pub type Node<'i> = Spanned<DeValue<'i>>;

/// A number or boolean, and its span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// The value.
    pub value: NumberValue,
    /// Its place.
    pub span: Span,
}

/// The value of a [`Number`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NumberValue {
    /// `true` or `false`.
    Bool(bool),
    /// An integer of TOML, and the nearest `f32`.
    Int(i64, f32),
    /// The nearest `f32` of a number with a point or an exponent.
    Float(f32),
}

/// Reads one file and collects its diagnostics.
#[derive(Debug)]
pub struct Reader {
    codes: &'static Codes,
    /// The global offset of the file's first byte.
    pub(crate) base: u32,
    /// The file's text.
    pub(crate) text: Arc<str>,
    /// The findings so far.
    pub diagnostics: Diagnostics,
    /// Known keys that unknown ones are similar to, with the address of their table.
    meant: Vec<(usize, String)>,
    /// Diagnostics about things that the file lacks. They come after all others, which may be the reason for them.
    pub(crate) missing: Vec<Diagnostic>,
}

impl Reader {
    /// A reader of the text of a kind of file, whose first byte has the global offset `base`.
    pub fn new(codes: &'static Codes, base: u32, text: Arc<str>) -> Self {
        Self { codes, base, text, diagnostics: Diagnostics::default(), meant: Vec::new(), missing: Vec::new() }
    }

    /// The tables of `text`, which is the reader's; `None` (reported) if it is not TOML.
    pub fn document<'t>(&mut self, text: &'t str) -> Option<DeTable<'t>> {
        let (document, errors) = DeTable::parse_recoverable(text);
        for error in &errors {
            let span = error.span().map_or_else(Span::default, |range| self.span(range));
            let message = error.message().trim().replace('\n', ", ");
            let help = error.span().and_then(|range| quoted(text, range.start));
            self.report(Diagnostic::new(self.codes.syntax, span, message).maybe_help(help));
        }
        errors.is_empty().then(|| document.into_inner())
    }

    /// The span of a range of bytes of the file.
    pub fn span(&self, range: Range<usize>) -> Span {
        Span::new(self.base + range.start as u32, self.base + range.end as u32)
    }

    /// The span of a value.
    pub fn span_of<T>(&self, node: &Spanned<T>) -> Span {
        self.span(node.span())
    }

    /// Adds a diagnostic.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Adds a diagnostic about something that the scene lacks.
    pub fn report_missing(&mut self, diagnostic: Diagnostic) {
        self.missing.push(diagnostic);
    }

    /// Reports keys of `table` that are not among `known`.
    pub fn check_keys(&mut self, table: &DeTable<'_>, place: &str, known: &[&str]) {
        for (key, _) in table {
            let name: &str = key.get_ref();
            if known.contains(&name) {
                continue;
            }
            let message = format!("{place} has no key `{name}`");
            let near = did_you_mean(name, known.iter().copied());
            self.meant.extend(near.map(|near| (address(table), near.to_owned())));
            let help = near.map_or_else(|| format!("the keys here are {}", list(known)).into(), Advice::meant);
            let span = self.span_of(key);
            self.report(Diagnostic::new(self.codes.unknown_key, span, message).here("unknown key").help(help));
        }
    }

    /// Whether a key that the table lacks is there under a misspelled name, which was reported.
    pub fn is_misspelled(&self, table: &DeTable<'_>, key: &str) -> bool {
        self.meant.iter().any(|(place, meant)| *place == address(table) && meant == key)
    }

    /// Reports a value of the wrong type.
    pub fn wrong_type(&mut self, node: &Node<'_>, key: &str, wanted: &str) {
        let found = node.get_ref().type_str();
        let span = self.span_of(node);
        let message = format!("`{key}` must be {wanted}");
        self.report(Diagnostic::new(self.codes.wrong_type, span, message).here(format!("this is of type {found}")));
    }

    /// Reports a value that is not allowed.
    pub fn wrong_value(&mut self, span: Span, message: impl Into<String>, here: impl Into<String>) {
        self.report(Diagnostic::new(self.codes.wrong_value, span, message).here(here));
    }

    /// Reports `code` with a label.
    pub fn error(&mut self, code: &'static Code, span: Span, message: String, here: &str) {
        self.report(Diagnostic::new(code, span, message).here(here));
    }

    /// A table.
    pub fn table<'t, 'i>(&mut self, node: &'t Node<'i>, key: &str) -> Option<&'t DeTable<'i>> {
        let table = node.get_ref().as_table();
        if table.is_none() {
            self.wrong_type(node, key, "a table");
        }
        table
    }

    /// The table under a key, if the key is there.
    pub fn table_at<'t, 'i>(&mut self, table: &'t DeTable<'i>, key: &str) -> Option<&'t DeTable<'i>> {
        self.table(table.get(key)?, key)
    }

    /// A text.
    pub fn text<'t>(&mut self, node: &'t Node<'_>, key: &str) -> Option<&'t str> {
        let text = node.get_ref().as_str();
        if text.is_none() {
            self.wrong_type(node, key, "a string");
        }
        text
    }

    /// The text under a key, and its span.
    pub fn text_at<'t>(&mut self, table: &'t DeTable<'_>, key: &str) -> Option<(&'t str, Span)> {
        let node = table.get(key)?;
        let span = self.span_of(node);
        self.text(node, key).map(|text| (text, span))
    }

    /// The texts of a list under a key, and their spans; a single text will do.
    pub fn texts_at<'t>(&mut self, table: &'t DeTable<'_>, key: &str) -> Vec<(&'t str, Span)> {
        let Some(node) = table.get(key) else { return Vec::new() };
        let nodes: Vec<&'t Node<'_>> = match node.get_ref().as_array() {
            Some(array) => array.iter().collect(),
            None => vec![node],
        };
        nodes.into_iter().filter_map(|node| Some((self.text(node, key)?, self.span_of(node)))).collect()
    }

    /// A version of GLSL under a key, `"300 es"` or a number, and its span.
    pub fn version_at(&mut self, table: &DeTable<'_>, key: &str) -> Option<(String, Span)> {
        let node = table.get(key)?;
        let span = self.span_of(node);
        let number = node.get_ref().as_integer().map(|number| number.as_str().to_owned());
        number.or_else(|| self.text(node, key).map(str::to_owned)).map(|text| (text, span))
    }

    /// The tables of a list under a key: `[[key]]`.
    pub fn tables_at<'t, 'i>(&mut self, table: &'t DeTable<'i>, key: &str) -> Vec<(&'t DeTable<'i>, Span)> {
        let Some(node) = table.get(key) else { return Vec::new() };
        let Some(array) = node.get_ref().as_array() else {
            let span = self.span_of(node);
            let message = format!("`{key}` must be a list of tables");
            let help = format!("write `[[{key}]]`, with two brackets");
            self.report(Diagnostic::new(self.codes.wrong_type, span, message).here("this is one table").help(help));
            return Vec::new();
        };
        array.iter().filter_map(|node| Some((self.table(node, key)?, self.span_of(node)))).collect()
    }

    /// The text of a macro's value: one line. `true` and `false` have the texts that `flags` gives.
    pub fn macro_text(&mut self, node: &Node<'_>, name: &str, flags: [&str; 2]) -> Option<String> {
        let text = match node.get_ref() {
            DeValue::String(text) => text.to_string(),
            DeValue::Integer(number) => number.as_str().replace('_', ""),
            DeValue::Float(number) => number.as_str().replace('_', ""),
            DeValue::Boolean(value) => flags[usize::from(*value)].to_owned(),
            DeValue::Datetime(_) | DeValue::Array(_) | DeValue::Table(_) => {
                self.wrong_type(node, name, "a number or a string");
                return None;
            }
        };
        if text.contains(['\n', '\r']) {
            let span = self.span_of(node);
            self.wrong_value(span, "a macro's value is one line", "more than one line");
            return None;
        }
        Some(text)
    }

    /// The name of a macro, of a key; `None` (reported) if it is none.
    pub fn macro_name(&mut self, key: &Spanned<DeString<'_>>) -> Option<String> {
        let name: &str = key.get_ref();
        let starts_well = name.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
        if starts_well && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_') {
            return Some(name.to_owned());
        }
        let span = self.span_of(key);
        self.wrong_value(span, format!("`{name}` is not a name for a macro"), "not an identifier");
        None
    }

    /// `true` or `false`; `default` if the key is not there.
    pub fn flag(&mut self, table: &DeTable<'_>, key: &str, default: bool) -> bool {
        let Some(node) = table.get(key) else { return default };
        node.get_ref().as_bool().unwrap_or_else(|| {
            self.wrong_type(node, key, "`true` or `false`");
            default
        })
    }

    /// A finite number.
    pub fn finite(&mut self, node: &Node<'_>, key: &str) -> Option<f64> {
        let number = as_f64(node.get_ref()).filter(|number| number.is_finite());
        if number.is_none() {
            self.wrong_type(node, key, "a number");
        }
        number
    }

    /// An integer in a range.
    pub fn integer(&mut self, node: &Node<'_>, key: &str, range: RangeInclusive<i64>) -> Option<i64> {
        let value = match as_number(node.get_ref()) {
            Some(NumberValue::Int(value, _)) => value,
            Some(NumberValue::Float(_) | NumberValue::Bool(_)) | None => {
                self.wrong_type(node, key, "an integer");
                return None;
            }
        };
        if range.contains(&value) {
            return Some(value);
        }
        let span = self.span_of(node);
        let message = format!("`{key}` must be {} to {}", range.start(), range.end());
        self.wrong_value(span, message, "out of range");
        None
    }

    /// An integer in a range under a key; `default` if the key is not there.
    pub fn count(&mut self, table: &DeTable<'_>, key: &str, default: u32, range: RangeInclusive<u32>) -> u32 {
        let Some(node) = table.get(key) else { return default };
        let wide = i64::from(*range.start())..=i64::from(*range.end());
        self.integer(node, key, wide).and_then(|value| u32::try_from(value).ok()).unwrap_or(default)
    }

    /// A number under a key, as `f64`; `default` if the key is not there.
    pub fn real(&mut self, table: &DeTable<'_>, key: &str, default: f64) -> f64 {
        let Some(node) = table.get(key) else { return default };
        match as_f64(node.get_ref()) {
            Some(value) if is_f32(value) => value,
            Some(_) => {
                self.not_finite(node, key);
                default
            }
            None => {
                self.wrong_type(node, key, "a number");
                default
            }
        }
    }

    /// Reports a number that is none of f32.
    fn not_finite(&mut self, node: &Node<'_>, key: &str) {
        let span = self.span_of(node);
        self.wrong_value(span, format!("`{key}` must be finite, as f32 has numbers"), "not finite");
    }

    /// `N` numbers under a key, as `f64`.
    pub fn reals<const N: usize>(&mut self, table: &DeTable<'_>, key: &str, default: [f64; N]) -> [f64; N] {
        let Some(node) = table.get(key) else { return default };
        let numbers: Option<Vec<f64>> =
            node.get_ref().as_array().and_then(|array| array.iter().map(|node| as_f64(node.get_ref())).collect());
        match numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok()) {
            Some(numbers) if numbers.iter().all(|value| is_f32(*value)) => numbers,
            Some(_) => {
                self.not_finite(node, key);
                default
            }
            None => {
                self.wrong_type(node, key, &format!("a list of {N} numbers"));
                default
            }
        }
    }

    /// One of the names of a table; `None` (reported) if it is none of them.
    pub fn choice<T: Copy>(&mut self, node: &Node<'_>, key: &str, names: &[(&str, T)]) -> Option<T> {
        let name = self.text(node, key)?;
        if let Some((_, value)) = names.iter().find(|(candidate, _)| *candidate == name) {
            return Some(*value);
        }
        let candidates: Vec<&str> = names.iter().map(|(name, _)| *name).collect();
        let help = did_you_mean(name, candidates.iter().copied())
            .map_or_else(|| format!("`{key}` may be {}", list(&candidates)), |near| format!("did you mean `{near}`?"));
        let span = self.span_of(node);
        let message = format!("`{key}` cannot be `{name}`");
        self.report(Diagnostic::new(self.codes.wrong_value, span, message).here("not one of its values").help(help));
        None
    }

    /// One of the names of a table under a key; `default` if the key is not there.
    pub fn choice_at<T: Copy>(&mut self, table: &DeTable<'_>, key: &str, default: T, names: &[(&str, T)]) -> T {
        table.get(key).and_then(|node| self.choice(node, key, names)).unwrap_or(default)
    }

    /// A number, a list of numbers, or a list of such lists, flattened.
    pub fn numbers(&mut self, node: &Node<'_>, key: &str) -> Option<Vec<Number>> {
        let mut numbers = Vec::new();
        if self.gather(node, key, &mut numbers) { Some(numbers) } else { None }
    }

    // Recurses as deep as the TOML is nested, which its parser limits to 80 levels.
    fn gather(&mut self, node: &Node<'_>, key: &str, into: &mut Vec<Number>) -> bool {
        if let Some(array) = node.get_ref().as_array() {
            return array.iter().all(|element| self.gather(element, key, into));
        }
        let Some(value) = as_number(node.get_ref()) else {
            self.wrong_type(node, key, "a list of numbers");
            return false;
        };
        into.push(Number { value, span: self.span_of(node) });
        true
    }
}

/// The help to quote the key of a line, if it has brackets as names of uniforms do: `lights[0].color = ..`.
fn quoted(text: &str, at: usize) -> Option<String> {
    let start = text.get(..at)?.rfind('\n').map_or(0, |end| end + 1);
    let key = text.get(start..)?.lines().next()?.split_once('=')?.0.trim();
    let is_name = |letter: char| letter.is_ascii_alphanumeric() || "_.[]".contains(letter);
    let has_brackets = key.contains('[') && !key.starts_with('[');
    (has_brackets && key.chars().all(is_name)).then(|| format!("write `\"{key}\"`: a key with brackets is quoted"))
}

/// A number that tells one table of a scene from another.
fn address(table: &DeTable<'_>) -> usize {
    std::ptr::from_ref(table).addr()
}

fn as_number(value: &DeValue<'_>) -> Option<NumberValue> {
    match value {
        DeValue::Boolean(value) => Some(NumberValue::Bool(*value)),
        DeValue::Integer(integer) => {
            let digits = integer.as_str().replace('_', "");
            let value = i64::from_str_radix(&digits, integer.radix()).ok()?;
            Some(NumberValue::Int(value, value as f32))
        }
        DeValue::Float(float) => float.as_str().replace('_', "").parse().ok().map(NumberValue::Float),
        DeValue::String(_) | DeValue::Datetime(_) | DeValue::Array(_) | DeValue::Table(_) => None,
    }
}

/// Whether a number is finite in f32, which scenes are computed in.
fn is_f32(value: f64) -> bool {
    (value as f32).is_finite()
}

fn as_f64(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Integer(_) => match as_number(value) {
            Some(NumberValue::Int(value, _)) => Some(value as f64),
            _ => None,
        },
        DeValue::Float(float) => float.as_str().replace('_', "").parse().ok(),
        DeValue::Boolean(_) | DeValue::String(_) | DeValue::Datetime(_) | DeValue::Array(_) | DeValue::Table(_) => None,
    }
}

/// `` `a`, `b` and `c` ``
pub fn list(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        None => "none".into(),
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}

/// Reports a name that the program does not declare, and suggests the most similar one, which is returned.
pub fn report_unknown_name<'c>(
    reader: &mut Reader,
    span: Span,
    what: &str,
    name: &str,
    candidates: &[&'c str],
) -> Option<&'c str> {
    let near = nearest_path(name, candidates);
    let help = match near {
        Some(near) if near.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_') => {
            Some(Advice::meant(near))
        }
        // A key with other characters needs quotes.
        Some(near) => Some(format!("did you mean `{near}`?").into()),
        None if candidates.is_empty() => Some(format!("the program has no {what} at all").into()),
        None if candidates.len() <= 12 => Some(format!("the program has {}", list(candidates)).into()),
        None => None,
    };
    let message = format!("the program declares no {what} `{name}`");
    reader.report(Diagnostic::new(&SCENE_UNKNOWN_NAME, span, message).here("not declared").maybe_help(help));
    near
}
