//! [`Request`]: what the host asks for.

use crate::includes::{Asked, Found};
#[cfg(feature = "reference")]
use glisten_binding::joined;
use glisten_binding::{Error, Settings, Source, Stage, sources_of, stage_of_word};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A source of a program.
#[derive(Clone, Deserialize)]
pub(crate) struct Text {
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) stage: Option<String>,
}

/// A request. Each call reads the keys that it needs.
#[derive(Deserialize)]
#[serde(default)]
#[derive(Default)]
pub(crate) struct Request {
    pub(crate) call: String,
    pub(crate) sources: Vec<Text>,
    /// Options by their names on the command line.
    options: Vec<(String, String)>,
    defines: Vec<(String, String)>,
    attributes: Vec<(String, u32)>,
    outputs: Vec<(String, u32)>,
    /// Included files by their names.
    pub(crate) includes: BTreeMap<String, String>,
    /// What the host answered to includes that it was asked for.
    answers: Vec<Found>,
    /// Whether the host can be asked for more.
    asks: bool,
    pub(crate) targets: Vec<String>,
    pub(crate) lints: bool,
    pub(crate) reflect: bool,
    pub(crate) unsafe_fixes: bool,
    /// The version to write, or the style of texts, or the precision of a picture.
    pub(crate) to: String,
    pub(crate) style: Style,
    /// The path of a scene, and its files as offsets and lengths in the bytes of the request.
    pub(crate) path: String,
    pub(crate) files: BTreeMap<String, (usize, usize)>,
    pub(crate) floats: bool,
    /// The folders in which includes are searched.
    #[cfg(feature = "play")]
    pub(crate) folders: Vec<String>,
    /// What the browser read back, as offsets and lengths in the bytes of the request.
    #[cfg(feature = "play")]
    planes: Vec<(usize, usize)>,
    /// A job of the page.
    #[cfg(feature = "play")]
    pub(crate) job: serde_json::Value,
}

/// The style of formatted texts.
#[derive(Deserialize)]
#[serde(default)]
#[derive(Default)]
pub(crate) struct Style {
    /// Blanks of a level; 0 for tabs.
    pub(crate) indent: Option<usize>,
    pub(crate) width: Option<usize>,
    pub(crate) braces_below: bool,
}

impl Request {
    /// The request in these bytes, and the bytes that it refers to.
    pub(crate) fn read(bytes: &[u8]) -> Result<(Self, &[u8]), Error> {
        let wrong = |why: &str| Error::argument(format!("the request cannot be read: {why}"));
        let (length, rest) = bytes.split_first_chunk().ok_or_else(|| wrong("it is empty"))?;
        let length = u32::from_le_bytes(*length) as usize;
        let (text, blob) = rest.split_at_checked(length).ok_or_else(|| wrong("it is cut off"))?;
        let request = serde_json::from_slice(text).map_err(|error| wrong(&error.to_string()))?;
        Ok((request, blob))
    }

    /// The settings, and where the includes that are missing are noted.
    pub(crate) fn settings(&self) -> Result<(Settings, Asked), Error> {
        let mut settings = Settings::default();
        self.options.iter().try_for_each(|(name, value)| settings.set(name, value))?;
        self.defines.iter().try_for_each(|(name, value)| settings.define(name, value))?;
        self.attributes.iter().try_for_each(|(name, location)| settings.bind_attribute(name, *location))?;
        self.outputs.iter().try_for_each(|(name, number)| settings.bind_output(name, *number))?;
        settings.includes.in_memory = true;
        let asked = Asked::new(self.asks);
        let (files, answers, noted) = (self.includes.clone(), self.answers.clone(), asked.clone());
        settings.includes.ask =
            Some(Arc::new(move |path, angled, from| noted.resolve(&files, &answers, path, angled, from)));
        Ok((settings, asked))
    }

    /// The files, by their paths without `.` and `..`.
    #[cfg(feature = "reference")]
    pub(crate) fn files(&self, blob: &[u8]) -> Result<BTreeMap<String, Vec<u8>>, Error> {
        let bytes_of = |(name, (offset, length)): (&String, &(usize, usize))| {
            let bytes = blob.get(*offset..offset.saturating_add(*length));
            let bytes = bytes.ok_or_else(|| Error::argument(format!("the bytes of `{name}` are cut off")))?;
            Ok((joined("", name), bytes.to_vec()))
        };
        self.files.iter().map(bytes_of).collect()
    }

    /// What the browser read back. What is cut off is missing.
    #[cfg(feature = "play")]
    pub(crate) fn planes(&self, blob: &[u8]) -> Vec<Vec<u8>> {
        let of = |(offset, length): &(usize, usize)| blob.get(*offset..offset.saturating_add(*length));
        self.planes.iter().map(|place| of(place).unwrap_or_default().to_vec()).collect()
    }

    /// The sources with their stages.
    pub(crate) fn sources(&self) -> Result<Vec<Source>, Error> {
        let sources: Result<Vec<Vec<Source>>, Error> = self.sources.iter().map(Text::sources).collect();
        sources.map(|sources| sources.concat())
    }
}

impl Text {
    /// The sources: one for each stage of the text.
    pub(crate) fn sources(&self) -> Result<Vec<Source>, Error> {
        sources_of(&self.name, &self.text, self.stage()?)
    }

    /// The stage that the host says.
    pub(crate) fn stage(&self) -> Result<Option<Stage>, Error> {
        self.stage.as_deref().map(stage_of_word).transpose()
    }
}
