//! [`Settings`]: the `[stability]` table of a scene file.
//!
//! *In:* the text of a scene file. *Out:* the bound, the sweeps and the ranges that it states.
//!
//! ```toml
//! [stability]
//! bound = 0.001                     # the error of the picture that is accepted
//! bound_relative = 1e-6             # besides, this share of a pixel's largest channel
//! [stability.sweep]
//! "material.shininess" = [1, 10000, 32]         # low, high, number of values; "1..10000:32" is the same
//! [stability.range]
//! "light.position.x" = [-1e6, 1e6]              # what --stiff may try
//! ```

use super::sweep::{Sweep, parse_range};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::{SCENE_SYNTAX, SCENE_WRONG_VALUE};
use glisten_front::source::Span;
use glisten_scene::STABILITY_KEYS;
use glisten_scene::tables::{Reader, SCENE};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;

/// The statements of a scene about its stability.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// The error of the picture that is accepted.
    pub bound: Option<f64>,
    /// The share of a pixel's largest channel that is accepted as well.
    pub bound_relative: Option<f64>,
    /// Uniforms to vary.
    pub sweeps: Vec<Sweep>,
    /// The values that a search may try.
    pub ranges: Vec<Sweep>,
}

#[derive(Default, Deserialize)]
struct File {
    #[serde(default)]
    stability: Table,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    bound: Option<Spanned<f64>>,
    bound_relative: Option<Spanned<f64>>,
    #[serde(default)]
    sweep: BTreeMap<String, Spanned<RangeValue>>,
    #[serde(default)]
    range: BTreeMap<String, Spanned<RangeValue>>,
}

#[derive(Clone, Deserialize)]
#[serde(untagged)]
enum RangeValue {
    Text(String),
    Numbers(Vec<f64>),
}

impl Settings {
    /// Reads the settings of the scene file with this text, which its source map holds from `base` on.
    ///
    /// # Errors
    /// One diagnostic at its place.
    pub fn read(text: &str, base: u32) -> Result<Self, Box<Diagnostic>> {
        let at = |range: Range<usize>| Span::new(base + range.start as u32, base + range.end as u32);
        check_keys(text, base)?;
        let file: File = toml::from_str(text).map_err(|error| {
            let message = error.message().trim().replace('\n', ", ");
            let span = error.span().map_or_else(Span::default, at);
            Box::new(Diagnostic::new(&SCENE_SYNTAX, span, message).here("here"))
        })?;
        let wrong = |range: Range<usize>, message: String| {
            Box::new(Diagnostic::new(&SCENE_WRONG_VALUE, at(range), message).here("here"))
        };
        let Table { bound, bound_relative, sweep, range } = file.stability;
        for (name, bound) in [("bound", &bound), ("bound_relative", &bound_relative)] {
            if let Some(bound) = bound
                && (!bound.get_ref().is_finite() || *bound.get_ref() <= 0.0)
            {
                return Err(wrong(bound.span(), format!("`{name}` is a positive number")));
            }
        }
        let ranges = |table: BTreeMap<String, Spanned<RangeValue>>| -> Result<Vec<Sweep>, Box<Diagnostic>> {
            let each = table.into_iter().map(|(name, value)| {
                let place = value.span();
                let sweep = of_value(&name, value.into_inner()).map_err(|message| wrong(place.clone(), message))?;
                Ok(Sweep { place: at(place), ..sweep })
            });
            each.collect()
        };
        let [bound, bound_relative] = [bound, bound_relative].map(|bound| bound.map(Spanned::into_inner));
        Ok(Self { bound, bound_relative, sweeps: ranges(sweep)?, ranges: ranges(range)? })
    }
}

/// The first key of the table that it does not have.
fn check_keys(text: &str, base: u32) -> Result<(), Box<Diagnostic>> {
    let mut reader = Reader::new(&SCENE, base, text.into());
    let document = reader.document(text);
    if let Some(table) = document.as_ref().and_then(|document| reader.table_at(document, "stability")) {
        reader.check_keys(table, "`[stability]`", STABILITY_KEYS);
    }
    reader.diagnostics.into_iter().next().map_or(Ok(()), |first| Err(Box::new(first)))
}

fn of_value(name: &str, value: RangeValue) -> Result<Sweep, String> {
    match value {
        RangeValue::Text(text) => parse_range(name, &text),
        RangeValue::Numbers(numbers) => match numbers.as_slice() {
            [low, high] => Sweep::new(name, *low, *high, None),
            [low, high, count] => Sweep::new(name, *low, *high, Some(*count)),
            _ => Err("a range is [low, high] or [low, high, count]".to_owned()),
        },
    }
}
