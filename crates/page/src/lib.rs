//! The kit of all pages: one style, one viewer of pictures, one look of code and of numbers.
//!
//! ```text
//!  values of a page, its templates ──► Page ──► one HTML text
//!                                       ▲
//!  kit.css, viewer.css ── style ────────┤       highlight  code with a class for each kind of token
//!  kit.js, viewer.js ──── script ───────┤       words      numbers as people write them
//!  layout.html, viewer.html ────────────┘       raster     pictures as data URIs
//! ```
//!
//! *In:* values, and what is special to a page: its template, style and script. *Out:* HTML that loads nothing from a network.
//! *Holds:* a page's template extends `layout.html`; pictures that are to be compared are in a viewer (`viewer.html`), which
//! without a script shows them next to each other. *Not done here:* nothing knows of reports, scenes or tests.

pub mod axis;
pub mod highlight;
pub mod made;
pub mod raster;
pub mod viewer;
pub mod words;

pub use viewer::{Place, View, viewer};

use minijinja::{Environment, Value, context};

const STYLE: &str = concat!(include_str!("kit.css"), include_str!("viewer.css"));
const SCRIPT: &str = concat!(include_str!("kit.js"), "\n", include_str!("viewer.js"));
const LAYOUT: &str = include_str!("layout.html");
const VIEWER: &str = include_str!("viewer.html");

/// A kind of page.
#[derive(Clone, Copy, Debug)]
pub struct Page {
    /// The templates by their names; the first is the page's own, which extends `layout.html`.
    pub templates: &'static [(&'static str, &'static str)],
    /// The styles after the kit's.
    pub styles: &'static [&'static str],
    /// The parts of the script after the kit's.
    pub scripts: &'static [&'static str],
}

impl Page {
    /// The HTML for these values.
    ///
    /// # Errors
    /// The error of the template engine, which only a broken template causes.
    pub fn render(&self, values: Value) -> Result<String, minijinja::Error> {
        let mut environment = Environment::new();
        for (name, template) in [("layout.html", LAYOUT), ("viewer.html", VIEWER)].iter().chain(self.templates) {
            environment.add_template(name, template)?;
        }
        let joined = |first: &str, rest: &[&str]| Value::from_safe_string(first.to_owned() + &rest.concat());
        let kit = context! { style => joined(STYLE, self.styles), script => joined(SCRIPT, self.scripts) };
        let name = self.templates.first().map_or("layout.html", |(name, _)| name);
        environment.get_template(name)?.render(context! { kit, ..values })
    }
}

/// The text with the characters that HTML takes for its own.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The escaped text, with parts between backquotes as code.
pub fn inline_code(text: &str) -> String {
    let part = |(index, part)| if index % 2 == 1 { format!("<code>{}</code>", escape(part)) } else { escape(part) };
    text.split('`').enumerate().map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: Page = Page {
        templates: &[(
            "test.html",
            "{% extends \"layout.html\" %}{% block title %}{{ name }}{% endblock %}{% block body %}{% include \"viewer.html\" %}{% endblock %}",
        )],
        styles: &["/* own */"],
        scripts: &["// own"],
    };

    #[test]
    fn a_page_has_the_kit_and_its_own() {
        let view = |place, name: &str| {
            View::new(place, name, "<strong>a</strong>", Some(("data:image/png;base64,AA".into(), [2, 3])))
        };
        let views = [view(Place::First, "one <&>"), view(Place::Second, "other")];
        let page =
            PAGE.render(context! { name => "a < b", viewer => viewer(None, &views) }).expect("the template is good");
        for part in [
            "<title>a &lt; b</title>",
            "--paper:",
            "/* own */",
            "makeViewer",
            "// own",
            "data-name=\"one &lt;&amp;&gt;\"",
            "class=\"view second\"",
            "width=\"2\" height=\"3\"",
            "<figcaption><strong>a</strong></figcaption>",
            " data-whole",
        ] {
            assert!(page.contains(part), "{part}");
        }
        for outside in ["http://", "https://", "url(", "@import", "fetch("] {
            assert!(!page.contains(outside), "{outside}");
        }
        let open = View::new(Place::First, "a", "", None);
        let page = PAGE.render(context! { viewer => viewer(None, &[open]) }).expect("the template is good");
        assert!(!page.contains("<img") && !page.contains(" data-whole style"), "the script fills it");
    }

    #[test]
    fn code_between_backquotes() {
        assert_eq!(inline_code("`a<b` & \"c\""), "<code>a&lt;b</code> &amp; &quot;c&quot;");
    }
}
