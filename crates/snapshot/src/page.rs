//! The page of pending snapshots.
//!
//! *In:* what is pending. *Out:* one HTML page: pictures in the viewer, with the criterion that refused them and by how much; texts
//! as what changed, line by line. *Holds:* all pictures are in the page; names and texts are escaped.

use super::pending::{AllPending, Pending, PendingText, Refusal};
use glisten_page::words::grouped;
use glisten_page::{Page, Place, View, escape, viewer};
use glisten_scene::picture::{Image, png_uri};
use minijinja::{Value, context};
use similar::{ChangeTag, TextDiff};
use std::fs;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

const PAGE: Page = Page {
    templates: &[("snapshots.html", include_str!("page.html"))],
    styles: &[include_str!("page.css")],
    scripts: &[],
};

/// The largest pictures that are read for their numbers.
const MAX_SIDE: u32 = 16_384;
const MAX_PIXELS: u64 = 1 << 26;
/// The lines around a change of a text.
const CONTEXT: usize = 3;

/// The page.
///
/// # Errors
/// The message of the template engine, which only a broken template causes.
pub fn page(pending: &AllPending, version: &str) -> Result<String, String> {
    let values = context! {
        count => pending.count(),
        pictures => pending.pictures.iter().map(picture).collect::<Vec<_>>(),
        texts => pending.texts.iter().map(text).collect::<Vec<_>>(),
        version,
    };
    PAGE.render(values).map_err(|error| error.to_string())
}

/// A picture file: its data URI, and what is in it.
struct File {
    uri: String,
    image: Image,
}

impl File {
    fn read(path: &Path) -> Option<Self> {
        let bytes = fs::read(path).ok()?;
        let image = Image::read(&bytes, MAX_SIDE, MAX_PIXELS).ok()?;
        Some(Self { uri: png_uri(&bytes), image })
    }

    fn picture(&self) -> (String, [u32; 2]) {
        (self.uri.clone(), [self.image.width, self.image.height])
    }

    /// The largest difference of a channel in 8 bits, pixel by pixel; `None` if the sizes differ.
    fn steps_from(&self, other: &Self) -> Option<Vec<u8>> {
        let byte = |value: f32| (f64::from(value).clamp(0.0, 1.0) * 255.0).round() as u8;
        let is_alike = self.image.width == other.image.width && self.image.height == other.image.height;
        let pairs = self.image.pixels.iter().zip(&other.image.pixels);
        let steps = |(a, b): (&[f32; 4], &[f32; 4])| {
            a.iter().zip(b).map(|(a, b)| byte(*a).abs_diff(byte(*b))).max().unwrap_or(0)
        };
        is_alike.then(|| pairs.map(steps).collect())
    }
}

fn picture(pending: &Pending) -> Value {
    let new = File::read(&pending.new_picture());
    let stored = File::read(&pending.stored());
    let difference = File::read(&pending.difference());
    let views = [
        (Place::First, "new", "The picture of the last run", &new),
        (Place::Second, "stored", "The stored picture", &stored),
        (Place::Third, "difference", "Where they differ, and by how much: from blue (little) to red", &difference),
    ];
    let view = |(place, name, about, file): (Place, &str, &str, &Option<File>)| {
        let caption = format!("<strong>{}</strong>: {about}.", title(name));
        let mut view = View::new(place, name, caption, Some(file.as_ref()?.picture()));
        (view.alt, view.is_seen_through) = (format!("{name}: {}", pending.name), place != Place::Third);
        Some(view)
    };
    let views: Vec<View> = views.into_iter().filter_map(view).collect();
    let steps = new.as_ref().zip(stored.as_ref()).and_then(|(new, stored)| new.steps_from(stored));
    let (name, refusal) = (&pending.name, pending.refusal());
    let unseen = stored.is_none().then(|| "No picture is stored yet.".to_owned());
    context! {
        name,
        at => time(&pending.new_picture()),
        viewer => (!views.is_empty()).then(|| viewer(None, &views)),
        reason => refusal.as_ref().map(|refusal| sentence(&refusal.because)).or(unseen),
        facts => facts(refusal.as_ref(), steps.as_deref(), new.as_ref(), stored.as_ref()),
    }
}

/// `new` as `New`.
fn title(name: &str) -> String {
    let mut rest = name.chars();
    rest.next().map_or_else(String::new, |first| first.to_uppercase().chain(rest).collect())
}

fn sentence(because: &str) -> String {
    format!("{}.", title(because))
}

/// Terms with their figures: the criterion, by how much it failed, how many pixels.
fn facts(refusal: Option<&Refusal>, steps: Option<&[u8]>, new: Option<&File>, stored: Option<&File>) -> Vec<Value> {
    let mut facts: Vec<(&str, String)> = Vec::new();
    if let Some(refusal) = refusal {
        let criterion = match (refusal.criterion.as_str(), refusal.limit) {
            ("exact", _) => "equal in 8 bits".to_owned(),
            ("flip", Some(limit)) => format!("mean FLIP error at most {limit}"),
            ("envelope", _) => "within the envelope of conforming GPUs".to_owned(),
            ("size", _) => "the same size".to_owned(),
            _ => "none yet: nothing is stored".to_owned(),
        };
        facts.push(("Criterion", criterion));
        if let (Some(found), Some(limit)) = (refusal.found, refusal.limit) {
            let times = if limit > 0.0 { format!(", {:.1} times the limit", found / limit) } else { String::new() };
            facts.push(("Found", format!("{found:.4}{times}")));
        }
        if refusal.criterion == "envelope" {
            facts.push(("Outside the envelope", share(refusal.pixels, refusal.of)));
            facts.push(("By at most", format!("{} of 255", refusal.steps)));
        }
    }
    if let Some(steps) = steps {
        let count = steps.iter().filter(|step| **step > 0).count() as u64;
        facts.push(("Pixels that differ", share(count, steps.len() as u64)));
        facts.push(("Largest difference", format!("{} of 255", steps.iter().max().copied().unwrap_or(0))));
    }
    let size = |file: &File| format!("{} \u{d7} {}", file.image.width, file.image.height);
    match (new.map(size), stored.map(size)) {
        (Some(new), Some(stored)) if new != stored => facts.push(("Size", format!("{new}, stored {stored}"))),
        (Some(size), _) => facts.push(("Size", size)),
        _ => {}
    }
    facts.into_iter().map(|(term, text)| context! { term, text }).collect()
}

/// A number of pixels, and how much of all it is.
fn share(count: u64, of: u64) -> String {
    let percent = count as f64 / of.max(1) as f64 * 100.0;
    let percent = if count > 0 && percent < 0.1 { "less than 0.1".to_owned() } else { format!("{percent:.1}") };
    format!("{} of {} ({percent}\u{202f}%)", grouped(count), grouped(of))
}

/// When a file was written.
fn time(path: &Path) -> Option<Value> {
    let written = fs::metadata(path).and_then(|data| data.modified()).ok()?;
    let seconds = written.duration_since(UNIX_EPOCH).ok()?.as_secs();
    let day = glisten_page::made::date(seconds);
    let [hour, minute, second] = [seconds / 3600 % 24, seconds / 60 % 60, seconds % 60];
    let ago = SystemTime::now().duration_since(written).map_or(0, |ago| ago.as_secs());
    Some(context! {
        machine => format!("{day}T{hour:02}:{minute:02}:{second:02}Z"),
        people => format!("{day} {hour:02}:{minute:02} UTC"),
        ago,
    })
}

fn text(pending: &PendingText) -> Value {
    let rows = pending.texts().map(|[stored, new]| rows(&stored, &new));
    context! { name => &pending.name, at => time(&pending.path), rows }
}

/// The changed lines with those around them, and a row without a class for what is between.
fn rows(stored: &str, new: &str) -> Vec<Value> {
    let diff = TextDiff::from_lines(stored, new);
    let mut rows = Vec::new();
    for (index, group) in diff.grouped_ops(CONTEXT).iter().enumerate() {
        if index > 0 {
            rows.push(context! { class => "between" });
        }
        for change in group.iter().flat_map(|operation| diff.iter_changes(operation)) {
            let (class, sign) = match change.tag() {
                ChangeTag::Delete => ("gone", "\u{2212}"),
                ChangeTag::Insert => ("new", "+"),
                ChangeTag::Equal => ("same", ""),
            };
            let number = change.new_index().or(change.old_index()).map(|index| index + 1);
            let code = Value::from_safe_string(escape(change.value().trim_end_matches(['\n', '\r'])));
            rows.push(context! { class, sign, number, code });
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::{rows, share};

    #[test]
    fn a_change_is_shown_with_what_is_around_it() {
        let lines: Vec<String> = (0..40).map(|line| format!("line {line}\n")).collect();
        let stored = lines.concat();
        let new = stored.replace("line 5\n", "<b>\n").replace("line 30\n", "");
        let rows = rows(&stored, &new);
        let count = |class: &str| {
            rows.iter().filter(|row| row.get_attr("class").is_ok_and(|it| it.as_str() == Some(class))).count()
        };
        assert_eq!((count("gone"), count("new"), count("between"), count("same")), (2, 1, 1, 12));
        assert!(rows.iter().any(|row| row.get_attr("code").is_ok_and(|code| code.as_str() == Some("&lt;b&gt;"))));
        assert!(super::rows("a", "a").is_empty());
    }

    #[test]
    fn few_pixels_are_some() {
        assert_eq!(share(1, 65_536), "1 of 65\u{202f}536 (less than 0.1\u{202f}%)");
        assert_eq!(share(0, 0), "0 of 0 (0.0\u{202f}%)");
    }
}
