//! [`View`]s: the pictures of a viewer, as values for the template `viewer.html`.
//!
//! *In:* up to two pictures to compare, and one of what differs. *Out:* the value that a page's template names `viewer` where it
//! includes the viewer's template. *Holds:* without a script, the pictures are next to each other with their captions.

use minijinja::{Value, context};

/// A place in a viewer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// One of the two that may lie over each other.
    First,
    /// The other.
    Second,
    /// The difference, or another picture next to them.
    Third,
}

impl Place {
    fn class(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Second => "second",
            Self::Third => "third",
        }
    }
}

/// A picture of a viewer.
#[derive(Clone, Debug)]
pub struct View {
    /// The place.
    pub(crate) place: Place,
    /// The name, as a button and the readout give it: `reference`.
    pub(crate) name: String,
    /// The text below it, as HTML.
    pub(crate) caption: String,
    /// The picture's data URI, with its size; `None` if the page's script fills it.
    pub(crate) picture: Option<(String, [u32; 2])>,
    /// The description for those who do not see it.
    pub alt: String,
    /// HTML that lies over the picture.
    pub over: String,
    /// The identifier of the figure.
    pub id: Option<String>,
    /// Whether alpha shows the background.
    pub is_seen_through: bool,
}

impl View {
    /// A picture with its name and its caption, which is HTML.
    pub fn new(place: Place, name: &str, caption: impl Into<String>, picture: Option<(String, [u32; 2])>) -> Self {
        let (name, alt) = (name.to_owned(), name.to_owned());
        let caption = caption.into();
        Self { place, name, caption, picture, alt, over: String::new(), id: None, is_seen_through: false }
    }

    fn value(&self) -> Value {
        let [width, height] = self.picture.as_ref().map_or([0; 2], |(_, size)| *size);
        context! {
            place => self.place.class(),
            name => &self.name,
            caption => Value::from_safe_string(self.caption.clone()),
            picture => self.picture.as_ref().map(|(uri, _)| Value::from_safe_string(uri.clone())),
            width,
            height,
            alt => &self.alt,
            over => Value::from_safe_string(self.over.clone()),
            id => &self.id,
            is_seen_through => self.is_seen_through,
        }
    }
}

/// The value of a viewer.
pub fn viewer(id: Option<&str>, views: &[View]) -> Value {
    let is_whole = views.iter().all(|view| view.picture.is_some());
    context! { id, is_whole, views => views.iter().map(View::value).collect::<Vec<_>>() }
}
