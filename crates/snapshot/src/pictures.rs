//! Assertions about pictures.
//!
//! *In:* the [`Place`] of a test, a picture or a scene. *Out:* nothing, or a panic that says what to do. *Holds:* the stored
//! picture is `snapshots/MODULE__NAME.png` next to the test, where insta has its files, too. `INSTA_UPDATE` decides as with
//! insta: `auto` (the default) leaves a pending picture, except where `CI` is set; `always` stores it; `no` leaves nothing;
//! `unseen` stores what is not stored yet.

use super::criterion::{Comparison, Criterion, compare_scene};
use super::pending::{Pending, Refusal};
use glisten_scene::picture::{Image, ImageFormat, Picture};
use glisten_verify::scene::Scene;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// The largest pictures that are stored.
const MAX_SIDE: u32 = 16_384;
const MAX_PIXELS: u64 = 1 << 26;

/// Where the snapshot of a test is.
#[derive(Clone, Debug)]
pub struct Place {
    pending: Pending,
}

impl Place {
    /// The snapshot `name` of a test in a file (`file!()`) and a module (`module_path!()`) of the package in a folder
    /// (`env!("CARGO_MANIFEST_DIR")`).
    pub fn new(package: &str, file: &str, module: &str, name: impl AsRef<str>) -> Self {
        // `file!()` is relative to the workspace, which is the package's folder or one above it.
        let above = Path::new(package).ancestors().map(|folder| folder.join(file));
        let file = above.into_iter().find(|path| path.is_file()).unwrap_or_else(|| Path::new(package).join(file));
        let folder = file.parent().map_or_else(PathBuf::new, |folder| folder.join("snapshots"));
        let plain = |text: &str| text.replace("::", "__").replace(['/', '\\', ':', '\0'], "_");
        Self { pending: Pending::new(&folder, &format!("{}__{}", plain(module), plain(name.as_ref()))) }
    }
}

/// Asserts that a picture still is the stored one; see [`assert_picture!`](crate::assert_picture).
///
/// # Panics
/// It is not, or nothing is stored yet.
pub fn check_picture(place: &Place, picture: &Picture, criterion: Criterion) {
    let compared = stored(place).map(|stored| criterion.compare(&stored, picture));
    decide(place, compared, picture);
}

/// Asserts that the stored picture is one that a scene may have; see [`assert_scene!`](crate::assert_scene).
///
/// # Panics
/// It is not, nothing is stored yet, or the scene cannot be drawn.
pub fn check_scene(place: &Place, scene: &Scene) {
    let stored = stored(place);
    match compare_scene(stored.as_ref(), scene) {
        Ok((compared, picture)) => decide(place, stored.map(|_| compared), &picture),
        Err(why) => panic!("{}: {why}", place.pending.name),
    }
}

/// The stored picture; `None` if there is none, or it is no picture.
fn stored(place: &Place) -> Option<Image> {
    Image::read(&fs::read(place.pending.stored()).ok()?, MAX_SIDE, MAX_PIXELS).ok()
}

/// The meaning of `INSTA_UPDATE`.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Update {
    Pending,
    Store,
    StoreUnseen,
    Nothing,
}

fn update() -> Update {
    let is_set =
        |name: &str| env::var_os(name).is_some_and(|value| !value.is_empty() && value != "0" && value != "false");
    match env::var("INSTA_UPDATE").as_deref() {
        Ok("always" | "force") => Update::Store,
        Ok("unseen") => Update::StoreUnseen,
        Ok("no") => Update::Nothing,
        Ok("new") => Update::Pending,
        _ if is_set("CI") => Update::Nothing,
        _ => Update::Pending,
    }
}

fn decide(place: &Place, compared: Option<Comparison>, picture: &Picture) {
    let pending = &place.pending;
    let (refused, difference) = match compared {
        Some(Comparison { refused: None, .. }) => {
            // A decision that is not needed any more.
            let _ = pending.reject();
            return;
        }
        Some(Comparison { refused: Some(why), difference }) => (why, difference),
        None => (unseen(picture), None),
    };
    let because = &refused.because;
    let is_unseen = difference.is_none() && !pending.stored().exists();
    let done = match update() {
        Update::Store => write(&pending.stored(), picture),
        Update::StoreUnseen if is_unseen => write(&pending.stored(), picture),
        Update::Nothing => panic!("picture `{}`: {because}", pending.name),
        _ => {
            let left = difference.map_or(Ok(()), |difference| write(&pending.difference(), &difference));
            let written = write(&pending.new_picture(), picture).and(left).and_then(|()| explain(pending, &refused));
            match written {
                Ok(()) => panic!(
                    "picture `{}`: {because}\nsee it:    glisten snapshots review\naccept it: glisten snapshots accept {}",
                    pending.name, pending.name
                ),
                Err(why) => Err(format!("{because}; {why}")),
            }
        }
    };
    if let Err(why) = done {
        panic!("picture `{}`: {why}", pending.name);
    }
    let _ = pending.reject();
}

fn unseen(picture: &Picture) -> Refusal {
    let of = u64::from(picture.width) * u64::from(picture.height);
    let (because, criterion) = ("no picture is stored yet".to_owned(), "unseen".to_owned());
    Refusal { because, criterion, of, ..Refusal::default() }
}

/// Leaves why a picture is pending, for `glisten snapshots review`.
fn explain(pending: &Pending, refusal: &Refusal) -> Result<(), String> {
    let path = pending.refusal_file();
    let text = serde_json::to_string_pretty(refusal).unwrap_or_default() + "\n";
    fs::write(&path, text).map_err(|error| format!("cannot write `{}`: {error}", path.display()))
}

fn write(path: &Path, picture: &Picture) -> Result<(), String> {
    let failed = |error: &dyn std::fmt::Display| format!("cannot write `{}`: {error}", path.display());
    let bytes = picture.encode(0, ImageFormat::Png).map_err(|error| failed(&error))?;
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| failed(&error))?;
    }
    fs::write(path, bytes).map_err(|error| failed(&error))
}
