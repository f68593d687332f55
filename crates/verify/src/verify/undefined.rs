//! [`UndefinedAt`]: the places of what the language leaves undefined, for a report.
//!
//! *In:* what the reference found. *Out:* places with their file and line, most pixels first.

use glisten_front::source::SourceMap;
use glisten_reference::{Undefined, UndefinedPlace};
use serde::Serialize;

/// An expression or a variable that is undefined, and changes the picture.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct UndefinedAt {
    /// The undefined thing, in words.
    pub what: &'static str,
    /// The shader.
    pub file: String,
    /// The line, counted from 1.
    pub line: u32,
    /// The column, counted from 1, in characters.
    pub column: u32,
    /// One past the last column.
    pub end_column: u32,
    /// The number of pixels that depend on it.
    pub pixels: u64,
    /// One of them, from the left.
    pub x: u32,
    /// The same pixel, from the top.
    pub y: u32,
}

impl UndefinedAt {
    /// The places in the text; without the texts, none.
    pub(super) fn all(found: Option<&Undefined>, sources: Option<&SourceMap>) -> Vec<Self> {
        let (Some(found), Some(sources)) = (found, sources) else { return Vec::new() };
        found.places.iter().filter_map(|place| Self::new(place, sources)).collect()
    }

    fn new(place: &UndefinedPlace, sources: &SourceMap) -> Option<Self> {
        let location = sources.location(sources.call_site(place.span))?;
        let [x, y] = place.example;
        Some(Self {
            what: place.what,
            file: sources.file(location.file).name().to_owned(),
            line: location.line,
            column: location.column,
            end_column: location.end_column,
            pixels: place.pixels,
            x,
            y,
        })
    }
}
