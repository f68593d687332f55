//! Help texts of scenes that can be pasted: each is applied to a scene with a mistake, which is loaded again. The finding must be
//! gone, and nothing new may have come.

use crate::support::compiler;
use glisten::scene::{Loaded, MemoryFiles, load};
use glisten_front::diagnostic::Diagnostic;
use std::collections::BTreeSet;

const LIT: &str = "#version 150\nin vec3 position;\nin vec3 normal;\nin vec2 uv;\nuniform mat4 MVP, u_model, V;\nuniform mat3 normalMatrix;\n\
    uniform float shine;\nuniform vec3 eyePos, tint[2];\nout vec3 n;\nout vec2 st;\nvoid main() {\n    n = normalMatrix * normal * shine + \
    tint[1] + eyePos;\n    st = uv;\n    gl_Position = MVP * u_model * V * vec4(position, 1.0);\n}\n";
const SHORT: &str = "#version 150\nin vec3 vp, vn;\nin vec2 vt;\nin vec4 weights;\nout vec3 n;\nout vec2 st;\nvoid main() {\n    n = vn + \
    weights.xyz;\n    st = vt;\n    gl_Position = vec4(vp, 1.0);\n}\n";
const COLORED: &str = "#version 150\nin vec3 position;\nin vec3 color;\nout vec3 n;\nout vec2 st;\nvoid main() {\n    n = color;\n    st = \
    color.xy;\n    gl_Position = vec4(position, 1.0);\n}\n";
const IDLE: &str = "#version 150\nin vec3 position;\nin vec4 glow;\nout vec3 n;\nout vec2 st;\nvoid main() {\n    vec4 unread = glow;\n    \
    n = position;\n    st = n.xy;\n    gl_Position = vec4(position, 1.0);\n}\n";
const PLAIN: &str = "#version 150\nin vec3 position;\nout vec3 n;\nout vec2 st;\nvoid main() {\n    n = position;\n    st = n.xy;\n    \
    gl_Position = vec4(position, 1.0);\n}\n";
const EMPTY: &str = "#version 150\nout vec3 n;\nout vec2 st;\nvoid main() {\n    n = vec3(1.0);\n    st = n.xy;\n    gl_Position = vec4(1.0);\n}\n";
const FRAGMENT: &str = "#version 150\nin vec3 n;\nin vec2 st;\nout vec4 c;\nvoid main() { c = vec4(n, st.x); }\n";
const TEXTURED: &str = "#version 150\nin vec3 n;\nin vec2 st;\nuniform sampler2D one;\nuniform isampler2DArray two;\nuniform samplerCube \
    three;\nout vec4 c;\nvoid main() { c = texture(one, st) + vec4(texture(two, n)) + texture(three, n); }\n";
const TWO_OUTPUTS: &str =
    "#version 150\nin vec3 n;\nin vec2 st;\nout vec4 c;\nout vec4 d;\nvoid main() { c = vec4(n, st.x); d = c; }\n";
const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wood\nf 1 2 3\n";

/// Scenes with mistakes: the vertex shader, the fragment shader, the draw.
fn cases() -> Vec<(&'static str, &'static str, String)> {
    let camera = "[camera]\neye = [0, 0, 3]\n";
    let draw = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n";
    let bare = "[[draw]]\nprogram = \"standard\"\nmesh = { shape = \"sphere\" }\n";
    let standard = format!("{bare}material = {{ diffuse = [0.8, 0.8, 0.8] }}\n");
    let values = "values = [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0]";
    let data = format!("[draw.attributes]\nposition = {{ size = 3, {values} }}\n");
    [
        (LIT, FRAGMENT, format!("{camera}{draw}mesh = {{ shape = \"sphere\" }}\n")),
        (LIT, FRAGMENT, format!("{camera}{draw}[draw.mesh]\nshape = \"torus\"\n[draw.uniforms]\nshine = 1.0\n")),
        (LIT, FRAGMENT, format!("{draw}uniforms = {{ shine = 1.0 }}\nmesh = {{ shape = \"quad\" }}\n")),
        (
            LIT,
            FRAGMENT,
            format!("{draw}matrices = {{ MVP = \"model_view_projection\" }}\nmesh = {{ shape = \"quad\" }}\n"),
        ),
        (LIT, FRAGMENT, draw.to_owned()),
        (LIT, FRAGMENT, format!("{draw}{data}")),
        (LIT, FRAGMENT, format!("{draw}instances = 3\n{data}")),
        (SHORT, FRAGMENT, format!("{draw}mesh = {{ shape = \"cube\" }}\n")),
        (SHORT, FRAGMENT, format!("{draw}[draw.mesh]\nshape = \"cube\"\n")),
        (SHORT, FRAGMENT, format!("{draw}[draw.mesh]\nshape = \"cube\"\nposition = \"vp\"\n")),
        (SHORT, FRAGMENT, draw.to_owned()),
        (COLORED, FRAGMENT, format!("{draw}mesh = {{ shape = \"cube\" }}\n")),
        (COLORED, FRAGMENT, format!("{draw}instances = 2\nmesh = {{ file = \"a.obj\" }}\n")),
        (IDLE, FRAGMENT, format!("{draw}mesh = {{ shape = \"cube\" }}\n")),
        (IDLE, FRAGMENT, format!("{draw}{data}")),
        (EMPTY, FRAGMENT, draw.to_owned()),
        (EMPTY, FRAGMENT, format!("{draw}depth_tset = true\nvertex_count = 3\n")),
        (EMPTY, FRAGMENT, format!("{draw}cull = \"bakc\"\nvertex_count = 3\n")),
        (EMPTY, TEXTURED, format!("{draw}vertex_count = 3\n")),
        (EMPTY, TEXTURED, format!("{draw}vertex_count = 3\ntextures = {{ one = {{ pattern = \"checker\" }} }}\n")),
        (EMPTY, TWO_OUTPUTS, format!("[framebuffer]\nwidth = 8\n{draw}vertex_count = 3\n")),
        (
            COLORED,
            FRAGMENT,
            format!("{draw}[draw.attributes]\npositon = {{ size = 3, {values} }}\ncolor = {{ size = 3, {values} }}\n"),
        ),
        (COLORED, FRAGMENT, format!("{draw}mesh = {{ shape = \"cube\", position = \"posiiton\", color = \"x\" }}\n")),
        (PLAIN, FRAGMENT, format!("{draw}mesh = {{ file = \"a.obj\", material = \"wod\" }}\n")),
        (PLAIN, FRAGMENT, format!("{draw}mesh = {{ file = \"a.obj\", normals = \"file\" }}\n")),
        (PLAIN, FRAGMENT, format!("{draw}mesh = {{ shape = \"cbue\" }}\n")),
        (PLAIN, FRAGMENT, format!("{draw}[draw.mesh]\nsegments = 4\n")),
        (EMPTY, FRAGMENT, format!("[[light]]\nkind = \"directional\"\ntowards = [0, 1, 0]\n{bare}")),
        (EMPTY, FRAGMENT, format!("[[light]]\ntowards = [0, 1, 0]\n{standard}")),
        (EMPTY, FRAGMENT, format!("[[light]]\nkind = \"directional\"\n{standard}")),
        (EMPTY, FRAGMENT, format!("[[light]]\nkind = \"spot\"\n{standard}")),
        (EMPTY, FRAGMENT, format!("[[light]]\nkind = \"point\"\n{standard}")),
        (EMPTY, FRAGMENT, format!("{}{standard}", "[[light]]\nkind = \"hemisphere\"\n".repeat(10))),
    ]
    .into()
}

fn read(vertex: &str, fragment: &str, text: &str) -> Loaded {
    let files = [("s/a.toml", text), ("s/a.vert", vertex), ("s/a.frag", fragment), ("s/a.obj", OBJ)];
    load("s/a.toml", &MemoryFiles::new(files), &compiler())
}

/// Adds lines under the header of a table, which is made if it is not there.
fn under(text: &str, table: &str, lines: &str) -> String {
    let header = format!("[{table}]\n");
    match text.find(&header) {
        Some(at) => format!("{}{header}{lines}\n{}", &text[..at], &text[at + header.len()..]),
        None => format!("{text}{header}{lines}\n"),
    }
}

/// The text with one piece of a help applied at a span; `None` if it is not to be pasted.
fn pasted(text: &str, (start, end): (usize, usize), help: &str) -> Option<String> {
    let quoted = |rest: &str| rest.split_once('`').map(|(line, tail)| (line.to_owned(), tail.to_owned()));
    let after_line = |lines: &str| {
        let at = text[end..].find('\n').map_or(text.len(), |at| end + at + 1);
        format!("{}{lines}\n{}", &text[..at], &text[at..])
    };
    if let Some(rest) = help.strip_prefix("did you mean `") {
        let (near, _) = quoted(rest)?;
        let near = if text[start..end].starts_with('"') { format!("\"{near}\"") } else { near };
        return Some(format!("{}{near}{}", &text[..start], &text[end..]));
    }
    if let Some(rest) = help.strip_prefix("add under [") {
        let (table, lines) = rest.split_once("]:\n")?;
        return Some(under(text, table, lines));
    }
    if let Some(lines) = help.strip_prefix("add:\n") {
        return Some(after_line(lines));
    }
    let (rest, is_written) = match help.strip_prefix("add `") {
        Some(rest) => (rest, false),
        None => (help.strip_prefix("write `")?, true),
    };
    let (line, tail) = quoted(rest)?;
    if let Some((_, table)) = tail.split_once("under [") {
        return Some(under(text, table.split_once(']')?.0, &line));
    }
    if line.contains("..") {
        return None;
    }
    if tail == " to the draw" {
        return Some(text.replacen("[[draw]]\n", &format!("[[draw]]\n{line}\n"), 1));
    }
    if !is_written {
        return Some(after_line(&line));
    }
    let Some((key, _)) = line.split_once(" = {") else {
        return Some(format!("{}{line}{}", &text[..start], &text[end..]));
    };
    // The whole line of an inline table.
    let old = text.lines().find(|old| old.starts_with(&format!("{key} = {{")))?;
    Some(text.replacen(old, &line, 1))
}

#[test]
fn what_the_helps_of_scenes_say_can_be_pasted() {
    let (mut tried, mut wrong) = (BTreeSet::new(), Vec::new());
    for (vertex, fragment, text) in cases() {
        let before = read(vertex, fragment, &text);
        let codes = |loaded: &Loaded| loaded.diagnostics.iter().map(|found| found.code.id).collect::<Vec<_>>();
        assert!(!before.diagnostics.is_empty(), "nothing is wrong with\n{text}");
        let base = before.sources.files().next().map_or(0, |(id, _)| before.sources.file(id).base());
        for found in before.diagnostics.iter() {
            let Some(help) = found.help.as_deref() else { continue };
            let at = |offset: u32| (offset.saturating_sub(base) as usize).min(text.len());
            let place = (at(found.primary.span.start), at(found.primary.span.end));
            let mut new = Some(text.clone());
            for piece in help.split("\nand ") {
                new = new.and_then(|text| pasted(&text, place, piece));
            }
            let Some(new) = new else { continue };
            tried.insert(found.code.id);
            let after = read(vertex, fragment, &new);
            let is_left = |other: &Diagnostic| other.code == found.code && other.message == found.message;
            let old = codes(&before);
            let came: Vec<String> = after
                .diagnostics
                .iter()
                .filter(|other| is_left(other) || !old.contains(&other.code.id))
                .map(|other| format!("{}: {}", other.code, other.message))
                .collect();
            if !came.is_empty() || after.diagnostics.iter().count() >= old.len() {
                wrong.push(format!("{text}\n{} {help}\n->\n{new}\n{came:?} {:?}\n", found.code, codes(&after)));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n-----\n"));
    let expected = ["E0903", "E0905", "E0906", "E0907", "E0908", "E0909", "E0911", "W0901", "W0902", "W0906", "W0914"];
    assert_eq!(tried.into_iter().collect::<Vec<_>>(), expected);
}

/// The helps, word for word, for the commonest cases.
#[test]
fn a_mesh_feeds_plain_names_and_a_missing_matrix_asks_for_its_role() {
    let camera = "[camera]\neye = [0, 0, 3]\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n";
    let loaded = read(LIT, FRAGMENT, &format!("{camera}mesh = {{ shape = \"sphere\" }}\n"));
    let list: Vec<&Diagnostic> = loaded.diagnostics.iter().collect();
    let [warning] = list.as_slice() else { panic!("{list:?}") };
    assert_eq!(
        (warning.code.id, warning.message.as_str()),
        (
            "W0901",
            "uniforms `MVP`, `u_model`, `V`, `normalMatrix`, `shine`, `eyePos` and 1 more get no value and are 0"
        )
    );
    assert_eq!(
        warning.help.as_deref(),
        Some(
            "add under [draw.matrices]:\nMVP = \"model_view_projection\"\nu_model = \"model\"\nV = \"view\"\nnormalMatrix = \"normal\"\neyePos = \
             \"eye\"\nand add under [draw.uniforms]:\nshine = 0.0\ntint = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]"
        )
    );
    let loaded = read(SHORT, FRAGMENT, &format!("{camera}mesh = {{ shape = \"sphere\" }}\n"));
    let list: Vec<&Diagnostic> = loaded.diagnostics.iter().collect();
    let [error] = list.as_slice() else { panic!("{list:?}") };
    assert_eq!(error.message, "attributes `vp`, `vn`, `vt` and `weights` have no data: the vertex shader reads them");
    assert_eq!(
        error.help.as_deref(),
        Some(
            "write `mesh = { shape = \"sphere\", position = \"vp\", normal = \"vn\", texcoord = \"vt\" }`\nand add under [draw.attributes]:\n\
             weights = { size = 4, divisor = 1, values = [0.0, 0.0, 0.0, 1.0] }"
        )
    );
}

#[test]
fn an_element_with_a_wrong_value_is_not_missed_as_well() {
    let text = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nmesh = { shape = \"quad\" }\n[draw.uniforms]\n\"tint[1]\" = [1, 2]\n";
    let loaded = read(LIT, FRAGMENT, text);
    let told: Vec<(&str, bool)> =
        loaded.diagnostics.iter().map(|found| (found.code.id, found.message.contains("`tint`"))).collect();
    assert_eq!(told, [("E0908", true), ("W0901", false)]);
}

#[test]
fn typos_are_told_before_their_consequences_and_all_in_one_run() {
    let head = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n";
    let told = |text: &str| {
        let loaded = read(LIT, TEXTURED, text);
        let all: Vec<String> = loaded
            .diagnostics
            .iter()
            .filter(|found| found.is_error())
            .map(|found| format!("{} {}", found.code, found.help.as_deref().unwrap_or(&found.message)))
            .collect();
        all
    };
    let meant = |near: &str| format!("did you mean `{near}`?");
    let texture = format!("{head}mesh = {{ shape = \"quad\" }}\n[draw.textures]\none = {{ patern = \"checker\" }}\n");
    assert_eq!(told(&texture), [format!("E0903 {}", meant("pattern"))]);
    let two =
        format!("{head}mesh = {{ shape = \"torrus\" }}\n[draw.matrices]\nV = \"veiw\"\n[draw.uniforms]\nshin = 1.0\n");
    let all = told(&two);
    for near in ["torus", "view", "shine"] {
        assert!(all.iter().any(|help| help.ends_with(&meant(near))), "{near}: {all:?}");
    }
    assert_eq!(all.len(), 3, "{all:?}");
    for (text, near) in [
        ("[[draw]]\nvertex = \"a.vert\"\nfragmnt = \"a.frag\"\n".to_owned(), "fragment"),
        (format!("{head}mesh = {{ shap = \"quad\" }}\n"), "shape"),
        (format!("[[light]]\nkin = \"point\"\nposition = [0, 0, 0]\n{head}mesh = {{ shape = \"quad\" }}\n"), "kind"),
        (
            format!("[[light]]\nkind = \"point\"\npositoin = [0, 0, 0]\n{head}mesh = {{ shape = \"quad\" }}\n"),
            "position",
        ),
    ] {
        assert_eq!(told(&text), [format!("E0903 {}", meant(near))], "{text}");
    }
}
