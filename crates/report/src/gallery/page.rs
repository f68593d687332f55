//! The gallery as one HTML page.
//!
//! *In:* the entries and their pictures. *Out:* the text of the page.
//!
//! *Holds:* the pictures are files next to the page; nothing else is loaded.

use super::difference::Difference;
use super::entry::{Entry, source};
use super::figures::{Figures, ROWS, Shown};
use super::math::mathml;
use super::tile::Tile;
use glisten_page::highlight::{Language, html};
use glisten_page::made::Made;
use glisten_page::{Page, Place, View, inline_code, viewer};
use minijinja::{Value, context};
use rayon::prelude::*;
use std::collections::BTreeMap;

const PAGE: Page = Page {
    templates: &[("gallery.html", include_str!("page.html"))],
    styles: &[include_str!("page.css")],
    scripts: &[include_str!("page.js")],
};

/// The pictures of an entry.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The picture.
    pub tile: Tile,
    /// Its difference to the picture of the scene that it is [compared with](Entry::compared_with).
    pub difference: Option<Difference>,
}

/// A chapter of the page: the scenes that name its `id`.
struct Chapter {
    id: &'static str,
    title: &'static str,
    /// The document, and the section in it.
    of: &'static str,
    about: &'static str,
}

const CHAPTERS: &[Chapter] = &[
    Chapter {
        id: "light",
        title: "Light makes shape",
        of: "Textbook, sections 10.1.1 and 10.1.2",
        about: "What is seen of a thing is the light that it reflects. Real-time graphics make do with lights that have no \
                size: rays from one direction, rays from a point, and a point that shines one way.",
    },
    Chapter {
        id: "reflection",
        title: "Two reflections",
        of: "Textbook, sections 10.1.3 and 10.1.4",
        about: "The dichromatic model takes reflection for a sum of two. One is light that has been inside the surface and \
                comes out of it colored; the other is mirrored where it arrives, spread by the roughness of the surface. How \
                it spreads is what these models differ in. Whatever a formula gives, there is no highlight where the light \
                does not reach the surface (N\u{b7}L \u{2264} 0).",
    },
    Chapter {
        id: "sum",
        title: "The sum",
        of: "Textbook, sections 10.1.4 and 10.1.7",
        about: "Light that has been around everywhere is a constant. All reflections of all lights add up, and so does \
                what a thing sends out itself.",
    },
    Chapter {
        id: "distance",
        title: "Distance and beam",
        of: "Textbook, sections 10.1.5 and 10.1.6",
        about: "A point light thins out with the square of the distance; three weights soften that. A beam is a point \
                light bounded by a power of a cosine.",
    },
    Chapter {
        id: "surface",
        title: "From points to surfaces",
        of: "Textbook, section 10.2",
        about: "The models give the color of a point. A surface is filled between its vertices, and what is interpolated, \
                and in which space, is seen.",
    },
    Chapter {
        id: "article",
        title: "The article's ball",
        of: "Article on hemisphere lighting",
        about: "Eight programs, of which the article prints two in the assembly language of vs.1.0, each drawing the same ball \
                over a tiled floor. The arrow shows the direction of the light.",
    },
    Chapter {
        id: "today",
        title: "Since then",
        of: "Papers of 1941 to 2025",
        about: "What engines draw with today, by the same rules: each function with its published equation, an error that is \
                measured, and a finite result for every finite input. Lights are brighter than 1 here, and a tone curve brings \
                them to the screen.",
    },
];

/// The chapter whose cards have figures.
const MEASURED: &str = "today";

/// The page for pictures that `by` drew, one per entry.
///
/// # Errors
/// What is wrong with an entry's text, or the message of the template engine. Both are errors in the library, which
/// its tests would find.
pub fn page(entries: &[Entry], drawings: &[Drawing], by: &str, made: &Made) -> Result<String, String> {
    // Each entry is measured for itself.
    let measured: Vec<Result<Option<Value>, String>> = entries.par_iter().map(figures).collect();
    let measured: Vec<Option<Value>> = measured.into_iter().collect::<Result<_, _>>()?;
    let mut chapters = Vec::new();
    let mut shown = BTreeMap::new();
    for chapter in CHAPTERS {
        let mut cards = Vec::new();
        let own = entries.iter().zip(drawings).zip(&measured);
        for ((entry, drawing), figures) in own.filter(|((entry, _), _)| entry.meta.chapter == chapter.id) {
            cards.push(card(entries, (entry, figures.as_ref()), drawing, &mut shown)?);
        }
        chapters.push(context! {
            id => chapter.id, title => chapter.title, of => chapter.of, about => chapter.about, cards,
        });
    }
    if let Some(lost) = entries.iter().find(|entry| CHAPTERS.iter().all(|chapter| chapter.id != entry.meta.chapter)) {
        return Err(format!("the scene `{}` is of no chapter: `{}`", lost.name, lost.meta.chapter));
    }
    let values = context! {
        chapters,
        viewer => viewer(Some("large"), &places()),
        count => entries.len(),
        by,
        made => context! { command => &made.command, version => &made.version, date => &made.date },
    };
    PAGE.render(values).map_err(|error| error.to_string())
}

/// The places of the viewer, which the script fills with the picture that is opened.
fn places() -> [View; 3] {
    let empty = |(place, name)| View::new(place, name, "", None);
    [(Place::First, "picture"), (Place::Second, "other picture"), (Place::Third, "difference")].map(empty)
}

/// The card of an entry. `shown` has the texts that cards before it show, with their titles: each is in the page once.
fn card<'e>(
    entries: &[Entry],
    (entry, figures): (&'e Entry, Option<&Value>),
    drawing: &Drawing,
    shown: &mut BTreeMap<&'e str, &'e str>,
) -> Result<Value, String> {
    let wrong = |what: String| format!("the scene `{}`: {what}", entry.name);
    let mut formulas = String::new();
    for tex in &entry.meta.equation {
        formulas.push_str(&mathml(tex).map_err(wrong)?);
    }
    let mut sources = Vec::new();
    for name in &entry.meta.sources {
        let text = source(name).ok_or_else(|| wrong(format!("the library has no `{name}`")))?;
        let first = shown.get(name.as_str()).copied();
        let text = first.is_none().then(|| Value::from_safe_string(html(text, Language::Glsl)));
        shown.entry(name.as_str()).or_insert(&entry.meta.title);
        sources.push(context! { name, text, first, is_shared => true });
    }
    let scene = format!("{}.toml", entry.name);
    sources.push(context! { name => scene, text => Value::from_safe_string(html(entry.text, Language::Toml)) });
    let (width, height) = drawing.tile.size();
    Ok(context! {
        description => entry.description(),
        difference => drawing.difference.as_ref().map(|difference| self::difference(entries, entry, difference)),
        name => entry.name,
        title => &entry.meta.title,
        place => Value::from_safe_string(inline_code(&entry.meta.place)),
        says => Value::from_safe_string(inline_code(entry.meta.says.trim())),
        picture => entry.file_name(),
        width,
        height,
        formulas => Value::from_safe_string(formulas),
        sources,
        figures,
    })
}

/// The figures of a scene of today.
fn figures(entry: &Entry) -> Result<Option<Value>, String> {
    if entry.meta.chapter != MEASURED {
        return Ok(None);
    }
    let Figures { functions, fragment } = Figures::of(entry)?;
    let rows: Vec<Value> = functions.iter().map(row).collect();
    Ok(Some(context! {
        worst => functions.first().map(row),
        rows,
        inputs => ROWS,
        arithmetic => fragment.arithmetic,
        special => fragment.special,
        lookups => fragment.lookups,
        weight => fragment.weight(),
    }))
}

/// A function with its figures.
fn row(shown: &Shown) -> Value {
    let error = if shown.error == 0.0 { "0".to_owned() } else { format!("{:.1e}", shown.error) };
    // The number of a bound that is less than the error.
    let number = shown.bound.split_whitespace().next().and_then(|text| Some((text, text.parse::<f64>().ok()?)));
    let beyond = number.filter(|(_, bound)| *bound < shown.error).map(|(text, _)| text);
    context! { name => &shown.name, error, beyond, bound => &shown.bound, weight => shown.weight }
}

/// The difference to another picture, with the name and the title of its scene.
fn difference(entries: &[Entry], entry: &Entry, difference: &Difference) -> Value {
    let other = entries.iter().find(|known| Some(known.name) == entry.compared_with());
    context! {
        picture => entry.difference_name(),
        most => if difference.most == 0.0 { "0".to_owned() } else { format!("{:.1e}", difference.most) },
        factor => difference.factor,
        name => other.map(|other| other.name),
        other => other.map(Entry::file_name),
        title => other.map(|other| &other.meta.title),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gallery::entries;
    use glisten_scene::picture::Picture;

    fn drawings(entries: &[Entry]) -> Vec<Drawing> {
        let picture = Picture::of_colors(4, 4, vec![[0.5; 4]; 16]);
        let difference =
            |entry: &Entry| Difference::new(&picture, &picture).filter(|_| entry.compared_with().is_some());
        let drawing = |entry| Drawing {
            tile: Tile::new(&picture, glisten_scene::picture::Encoding::default()),
            difference: difference(entry),
        };
        entries.iter().map(drawing).collect()
    }

    #[test]
    fn the_page_is_whole_and_alone() {
        let entries = entries().expect("the library's scenes are good");
        let made = Made::new(&["gallery".to_owned(), "<o>".to_owned()], 0);
        let page = page(&entries, &drawings(&entries), "llvmpipe <Mesa>", &made).expect("the library's texts are good");
        assert_eq!(page.matches("<article ").count(), entries.len());
        for entry in &entries {
            assert!(page.contains(&format!("<img src=\"{}.png\"", entry.name)), "{}", entry.name);
            assert!(page.contains(&format!("id=\"{}\"", entry.name)), "{}", entry.name);
        }
        for told in ["llvmpipe &lt;Mesa&gt;", "1970-01-01", env!("CARGO_PKG_VERSION"), "&lt;o&gt;", "encoded for sRGB"]
        {
            assert!(page.contains(told), "{told}");
        }
        let compared: Vec<&Entry> = entries.iter().filter(|entry| entry.compared_with().is_some()).collect();
        assert!(!compared.is_empty());
        for entry in compared {
            assert!(page.contains(&format!("<img src=\"{}\"", entry.difference_name())), "{}", entry.name);
            assert!(entries.iter().any(|other| Some(other.name) == entry.compared_with()), "{}", entry.name);
        }
        let formulas: usize = entries.iter().map(|entry| entry.meta.equation.len()).sum();
        assert_eq!(page.matches("<math ").count(), formulas);
        for outside in ["http://", "https://", "src=\"/", "<link", "@import", "fetch("] {
            assert!(!page.contains(outside), "{outside}");
        }
    }

    #[test]
    fn every_chapter_has_scenes() {
        let entries = entries().expect("the library's scenes are good");
        for chapter in CHAPTERS {
            assert!(entries.iter().any(|entry| entry.meta.chapter == chapter.id), "{}", chapter.id);
        }
    }
}
