//! The page of `glisten stability -o`, from the outside: one file, whole, escaped, the same on every run.

use crate::support::{fixture, root};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const LASER: &str = "fixtures/stability/planted/01_laser_beam.toml";
const BONES: &str = "fixtures/stability/planted/41_bone_pose.toml";
const SOUND: &str = "fixtures/stability/sound/01_laser_beam_cross.toml";

/// The two files, and the output of the command.
struct Written {
    page: String,
    json: String,
    output: Output,
}

fn stability(arguments: &[&str], folder: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.current_dir(root()).arg("stability").args(arguments).arg("-o").arg(folder).output().expect("it runs")
}

fn written(arguments: &[&str]) -> Written {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("new/out");
    let output = stability(arguments, &out);
    let read = |name: &str| {
        let message = || format!("{name}: {}", String::from_utf8_lossy(&output.stderr));
        std::fs::read_to_string(out.join(name)).unwrap_or_else(|_| panic!("{}", message()))
    };
    let (page, json) = (read("stability.html"), read("stability.json"));
    let count = std::fs::read_dir(&out).expect("the folder").count();
    assert_eq!(count, 2, "the page needs no other file");
    check(&page);
    Written { page, json, output }
}

/// The tags of a page, without what is in scripts and styles: the name, the attributes, whether it closes.
fn tags(page: &str) -> Vec<(String, String, bool)> {
    let mut tags = Vec::new();
    let mut rest = page;
    while let Some(start) = rest.find('<') {
        let tag = &rest[start + 1..];
        let end = tag.find('>').expect("a tag ends");
        let inside = &tag[..end];
        rest = &tag[end + 1..];
        if inside.starts_with('!') {
            continue;
        }
        let closes = inside.starts_with('/');
        let bare = inside.trim_start_matches('/');
        let (name, attributes) = bare.split_once([' ', '\n']).unwrap_or((bare, ""));
        let name = name.trim_end_matches('/').to_owned();
        if !closes && (name == "script" || name == "style") {
            rest = &rest[rest.find(&format!("</{name}>")).expect("it ends")..];
        }
        tags.push((name, attributes.to_owned(), closes));
    }
    tags
}

/// Values of an attribute.
fn values<'a>(tags: &'a [(String, String, bool)], name: &str) -> Vec<&'a str> {
    let start = format!("{name}=\"");
    let value = |attributes: &'a String| {
        let at = attributes.find(&start).filter(|at| *at == 0 || attributes[..*at].ends_with(' '))?;
        attributes[at + start.len()..].split('"').next()
    };
    tags.iter().filter_map(|(_, attributes, _)| value(attributes)).collect()
}

/// Checks each property that every page has.
fn check(page: &str) {
    for outside in ["http:", "https:", "//www", "<link", "@import", "<iframe", "<object", "src=\"/", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    let tags = tags(page);
    let mut open: Vec<&str> = Vec::new();
    let empty = ["img", "meta", "br", "input", "wbr", "line", "circle", "polyline", "path", "link"];
    for (name, attributes, closes) in &tags {
        match (closes, attributes.ends_with('/') || empty.contains(&name.as_str())) {
            (true, _) => assert_eq!(open.pop(), Some(name.as_str()), "after {open:?}"),
            (false, true) => {}
            (false, false) => open.push(name),
        }
    }
    assert!(open.is_empty(), "{open:?}");
    let all = values(&tags, "id");
    let ids: BTreeSet<&str> = all.iter().copied().collect();
    assert_eq!(ids.len(), all.len(), "every id is there once");
    for link in values(&tags, "href") {
        assert!(link.strip_prefix('#').is_some_and(|id| ids.contains(id)), "{link}");
    }
    for picture in values(&tags, "src") {
        assert!(picture.starts_with("data:image/png;base64,iVBOR"), "{picture:.60}");
    }
    assert_eq!(page.matches("<script>").count(), 1);
    // Handlers in attributes would run what a name says.
    let handler = |attributes: &str| attributes.split('"').step_by(2).any(|name| name.trim().starts_with("on"));
    assert!(!tags.iter().any(|(_, attributes, _)| handler(attributes)));
}

/// The text that a browser shows.
fn shown(html: &str) -> String {
    let mut text = String::new();
    let mut in_tag = false;
    for character in html.chars() {
        match character {
            '<' => in_tag = true,
            '>' => in_tag = false,
            _ if !in_tag => text.push(character),
            _ => {}
        }
    }
    let marks = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&#x27;", "'"), ("&#x2f;", "/"), ("&amp;", "&")];
    marks.into_iter().fold(text, |text, (mark, character)| text.replace(mark, character))
}

/// The code of a listing, line by line.
fn listing(page: &str, file: usize) -> Vec<String> {
    let start = page.find(&format!("id=\"s1-f{file}\"")).expect("the file");
    let lines = page[start..].split("id=\"s1-f").skip(1).take_while(|part| part.starts_with(&file.to_string())).skip(1);
    let code =
        |part: &str| shown(part.split_once("<code>").and_then(|(_, code)| code.split_once("</code>")).expect("code").0);
    lines.map(code).collect()
}

#[test]
fn the_page_of_a_degraded_scene_is_whole() {
    let Written { page, json, output } = written(&[LASER]);
    assert_eq!(output.status.code(), Some(1), "it is not stable");
    let found: Value = serde_json::from_str(&json).expect("it is JSON");
    assert_eq!(page.matches("<img src=\"data:image/png;base64,").count(), 3, "f32, exact, error");
    let causes = found["causes"].as_array().expect("causes");
    assert!(!causes.is_empty() && page.matches("class=\"card\"").count() == causes.len());
    let text = shown(&page);
    for (number, cause) in causes.iter().enumerate() {
        let line = cause["line"].as_u64().expect("a line");
        let place = format!("01_laser_beam.frag:{line}:{}", cause["column"]);
        assert!(text.contains(&place), "{place}");
        assert!(text.contains(&cause["help"].as_str().expect("a help").replace('`', "")), "{cause}");
        assert!(page.contains(&format!("id=\"s1-c{}\"", number + 1)));
        assert!(page.contains(&format!("href=\"#s1-f2-L{line}\"")), "the card links to the line");
        assert!(text.contains(&format!("Worst pixel({}, {})", cause["where"]["x"], cause["where"]["y"])));
    }
    assert!(text.contains("glisten stability fixtures/stability/planted/01_laser_beam.toml"));
    assert!(text.contains("141 times the accepted") && text.contains(env!("CARGO_PKG_VERSION")));
    assert!(page.contains("<mark>") && page.contains("class=\"pin\" data-cause=\"s1-c1\""));
}

#[test]
fn the_headline_is_no_path() {
    let scene = root().join(LASER);
    let Written { page, .. } = written(&[scene.to_str().expect("it is UTF-8")]);
    let headline = page.split_once("<h1").and_then(|(_, rest)| rest.split_once("</h1>")).expect("a headline").0;
    assert!(headline.ends_with(">01_laser_beam.toml: stability in f32"), "{headline}");
    assert!(page.contains("<title>01_laser_beam.toml: stability in f32</title>"));
}

#[test]
fn the_library_has_a_page() {
    let Written { page, json, output } = written(&["--library=attenuation", "--cases", "16"]);
    let found: Value = serde_json::from_str(&json).expect("it is JSON");
    let functions = found["functions"].as_array().expect("functions");
    assert!(!functions.is_empty() && output.status.code() == Some(0));
    assert_eq!(page.matches("<th scope=\"row\">").count(), functions.len());
    let text = shown(&page);
    for function in functions {
        assert!(text.contains(function["signature"].as_str().expect("a signature")), "{function}");
    }
}

#[test]
fn the_json_is_that_of_the_standard_output() {
    let Written { json, output, .. } = written(&[LASER, "--format", "json"]);
    assert_eq!(json, String::from_utf8_lossy(&output.stdout));
}

#[test]
fn the_listings_hold_every_line() {
    let Written { page, .. } = written(&[LASER]);
    for (file, name) in [(1, "vert"), (2, "frag")] {
        let text = fixture(&format!("stability/planted/01_laser_beam.{name}"));
        assert_eq!(listing(&page, file), text.lines().collect::<Vec<_>>());
    }
}

#[test]
fn the_page_is_the_same_on_every_run() {
    let arguments = [LASER, "--sweep", "u_field=0.0001..0.1:5"];
    let (first, second) = (written(&arguments), written(&arguments));
    assert!(first.page == second.page && first.json == second.json);
}

#[test]
fn pixels_that_are_not_finite_are_told() {
    let Written { page, .. } = written(&[BONES]);
    let text = shown(&page);
    assert!(text.contains("896 pixels are not finite") && text.contains("f32 arithmetic breaks this picture"));
    assert!(text.contains("Harm") && text.contains("not finite"));
}

#[test]
fn a_sound_scene_has_no_causes() {
    let Written { page, output, .. } = written(&[SOUND]);
    assert_eq!(output.status.code(), Some(0));
    assert!(page.contains("f32 arithmetic does no harm to this picture") && !page.contains("class=\"card\""));
    assert_eq!(page.matches("<img ").count(), 3);
}

#[test]
fn a_sweep_of_one_uniform_is_a_curve() {
    let Written { page, .. } = written(&[LASER, "--sweep", "u_field=0.0001..1:40"]);
    assert_eq!(page.matches("<svg ").count(), 3, "for three widths");
    assert_eq!(page.matches("<polyline class=\"curve\"").count(), 3);
    assert!(page.contains("u_field \u{2192}</text>") && page.contains("\u{2191} largest error</text>"));
    assert!(page.contains("class=\"bound\"") && page.contains("accepted: "));
    let points = page.matches("class=\"point\"").count();
    assert!((2..=16).contains(&points), "{points}");
    let hidden = page.matches("hidden>\n<p class=\"of\">").count();
    assert_eq!(hidden, points - 1, "without a script, only the worst is there");
    assert!(page.contains("The soundest"));
    assert_eq!(page.matches("<img ").count(), 3 + 3 * points + 3);
}

#[test]
fn a_sweep_of_two_uniforms_is_a_table() {
    let arguments = [LASER, "--sweep", "u_field=0.001..1:4", "--sweep", "u_cone.x=0.0001..0.0002:3"];
    let Written { page, .. } = written(&arguments);
    assert!(!page.contains("<svg "));
    let head = "<th scope=\"col\"><code>u_cone.x</code></th><th scope=\"col\"><code>u_field</code></th>";
    assert!(page.contains(head));
    assert_eq!(page.matches("class=\"point\"").count(), 12);
}

#[test]
fn a_search_shows_the_worst_next_to_the_scenes_own_inputs() {
    let Written { page, .. } = written(&[LASER, "--stiff"]);
    let text = shown(&page);
    assert!(text.contains("The scene\u{2019}s own inputs") && text.contains("--stiff"));
    assert_eq!(page.matches("class=\"point\"").count(), 2);
}

#[test]
fn several_scenes_are_on_one_page() {
    let Written { page, json, .. } = written(&[LASER, SOUND]);
    let found: Value = serde_json::from_str(&json).expect("it is JSON");
    assert_eq!(found.as_array().map(Vec::len), Some(2));
    assert_eq!(page.matches("<section class=\"scene\"").count(), 2);
    assert!(page.contains("<a href=\"#s1\">") && page.contains("<a href=\"#s2\">"));
}

/// A copy of the laser's scene with hostile names and texts.
fn hostile(folder: &Path) -> PathBuf {
    let source = |name: &str| fixture(&format!("stability/planted/01_laser_beam.{name}"));
    let stem = "\"><img src=x onerror=alert(1)>&'";
    let evil = "// </style></script><script>alert(2)</script><!-- {{ 7 * 7 }} {% raw %} \" ' &lt; \u{202e}\u{7}\n\
                /* <svg onload=alert(3)>\n   </code></mark> */\n";
    let fragment = source("frag").replacen('\n', &format!("\n{evil}"), 1);
    // A cause that a macro and a line of markup surround.
    let fragment = fragment.replace(
        "float sine = sqrt(max(1.0 - cosine * cosine, 0.0));",
        "/*<b>*/ float sine = sqrt(max(1.0 - cosine * cosine, float(0 < 1 && 2 > 1) - 1.0)); // <i>\"",
    );
    std::fs::write(folder.join(format!("{stem}.frag")), fragment).expect("written");
    std::fs::write(folder.join("a.vert"), source("vert")).expect("written");
    let scene = source("toml").replace("\"01_laser_beam.vert\"", "'a.vert'");
    let scene = scene.replace("\"01_laser_beam.frag\"", &format!("\"\"\"\\{stem}.frag\"\"\""));
    let path = folder.join(format!("{stem}.toml"));
    std::fs::write(&path, scene).expect("written");
    path
}

#[cfg(unix)]
#[test]
fn names_and_texts_are_escaped() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = hostile(folder.path());
    let Written { page, .. } = written(&[scene.to_str().expect("it is UTF-8")]);
    for attack in ["<img src=x", "<script>alert", "<svg onload", "<b>*/", "<i>\""] {
        assert!(!page.contains(attack), "{attack}");
    }
    assert!(page.contains("{{ 7 * 7 }} {% raw %}"), "texts are no templates");
    let text =
        std::fs::read_to_string(folder.path().join("\"><img src=x onerror=alert(1)>&'.frag")).expect("it is there");
    let listed = [1, 2].map(|file| listing(&page, file));
    assert!(listed.iter().any(|lines| *lines == text.lines().collect::<Vec<_>>()), "{listed:?}");
}

#[test]
fn a_file_is_no_folder() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("file");
    std::fs::write(&file, "").expect("written");
    let output = stability(&[SOUND], &file);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("is a file, not a folder"));
}
