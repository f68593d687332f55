//! Scene files: what they mean, and the diagnostics for their errors.

use crate::support::{compiler, root};
use glisten::scene::{DiskFiles, Loaded, MemoryFiles, load};
use glisten_front::diagnostic::{Diagnostic, Severity};
use glisten_front::hir::ScalarValue;
use glisten_verify::scene::{AttributeValues, Format, Texels};

const VERTEX: &str = "#version 150\n\
    struct Light { vec4 position; float power; };\n\
    in vec4 pv;\nin ivec2 cell;\nin mat2 turn;\n\
    uniform mat4 mc;\nuniform Light lights[2];\nuniform float weights[3];\nuniform bool lit;\nuniform int count = 4;\n\
    uniform Camera { vec3 eye; mat4 view; } camera;\n\
    uniform vec2 unused;\nout vec2 tv;\n\
    void main() {\n\
    float sum = weights[0] + weights[1] + weights[2] + lights[1].power + float(count + cell.x) + (lit ? 1.0 : 0.0);\n\
    tv = turn * camera.eye.xy;\n\
    gl_Position = camera.view * mc * pv + lights[0].position * sum;\n}\n";
const FRAGMENT: &str = "#version 150\nin vec2 tv;\nuniform sampler2D tex;\nuniform isampler2D ids;\nout vec4 fc;\n\
    void main() { fc = texture(tex, tv) + vec4(texelFetch(ids, ivec2(0), 0)); }\n";

/// A scene with everything that the program needs, so that a test changes one line of it.
const GOOD: &str = r#"
[framebuffer]
width = 16
height = 8
clear = [0.1, 0.2, 0.3, 1.0]
format = "rgba16float"
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
pv = { size = 3, values = [-1, -1, 0, 1, -1, 0, 0, 1, 0] }
cell = { size = 1, values = [1, 2, 3] }
turn = { size = 4, values = [1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1] }
[draw.uniforms]
mc = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]
"lights[0].position" = [1, 2, 3, 4]
"lights[1].position" = [1, 2, 3, 4]
"lights[0].power" = 0.5
"lights[1].power" = 0.1
weights = [1, 2, 3]
lit = true
"Camera.eye" = [0, 0, 1]
"Camera.view" = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]
[draw.textures]
tex = { width = 2, height = 1, values = [1, 0, 0, 1, 0, 1, 0, 1], filter = "trilinear", mipmaps = true }
ids = { width = 1, height = 1, values = [1, 2, -3, 4] }
"#;

fn load_text(text: &str) -> Loaded {
    let files = MemoryFiles::new([("s/a.toml", text), ("s/a.vert", VERTEX), ("s/a.frag", FRAGMENT)]);
    load("s/a.toml", &files, &compiler())
}

/// The scene with `from` replaced.
fn changed(from: &str, to: &str) -> Loaded {
    assert!(GOOD.contains(from), "`{from}` is not in the scene");
    load_text(&GOOD.replacen(from, to, 1))
}

pub(crate) fn told(loaded: &Loaded) -> Vec<String> {
    loaded.diagnostics.iter().map(|diagnostic| format!("{}: {}", diagnostic.code, diagnostic.message)).collect()
}

/// The only error of a changed scene, in the form of [`the_error`].
#[track_caller]
fn mistake(from: &str, to: &str) -> (&'static str, String, String) {
    the_error(&changed(from, to))
}

/// The only error of a scene: its code, the text of its span, and all its messages.
#[track_caller]
pub(crate) fn the_error(loaded: &Loaded) -> (&'static str, String, String) {
    assert!(loaded.scene.is_none(), "it was accepted");
    let errors: Vec<&Diagnostic> = loaded.diagnostics.iter().filter(|d| d.severity == Severity::Error).collect();
    assert_eq!(errors.len(), 1, "{:?}", told(loaded));
    let error = errors[0];
    let place = loaded.sources.snippet(error.primary.span).to_owned();
    (error.code.id, place, format!("{} {}", error.message, error.help.as_deref().unwrap_or("")))
}

/// A view that no camera has, a size that no shape has, and a number that f32 has not.
#[test]
fn impossible_views_and_sizes_are_told_at_their_numbers() {
    let scene = |camera: &str, mesh: &str| {
        let text = format!(
            "[camera]\n{camera}\n[[draw]]\nprogram = \"standard\"\nmesh = {{ {mesh} }}\nmaterial = {{ diffuse = [0.8, 0.8, 0.8] }}\n"
        );
        load("a.toml", &MemoryFiles::new([("a.toml", text.as_str())]), &compiler())
    };
    let sphere = "shape = \"sphere\"";
    assert!(scene("near = 0.5\nfar = 2.0\nfovy = 179.0", sphere).scene.is_some());
    for (camera, mesh, place, message) in [
        ("fovy = 0", sphere, "0", "`fovy` is an angle between 0 and 180 degrees"),
        ("fovy = -10", sphere, "-10", "`fovy` is an angle"),
        ("fovy = nan", sphere, "nan", "`fovy` must be finite"),
        ("near = 0", sphere, "0", "`near` is more than 0"),
        ("near = 100", sphere, "100", "`far` is more than `near`"),
        ("far = inf", sphere, "inf", "`far` must be finite"),
        ("aspect = 0", sphere, "0", "`aspect` of a camera is more than 0"),
        ("ortho = 0", sphere, "0", "`ortho` is half the height"),
        ("target = [0, 0, 3]", sphere, "[0, 0, 3]", "the `eye` and the `target` are at one place"),
        ("up = [0, 0, 2]", sphere, "[0, 0, 2]", "`up` points along the view"),
        ("eye = [nan, 0, 0]", sphere, "[nan, 0, 0]", "`eye` must be finite"),
        ("", "shape = \"sphere\", height = 3.0", "height", "a `sphere` has no `height`: its size is by `radius`"),
        ("", "shape = \"plane\", radius = 5", "radius", "a `plane` has no `radius`: its size is by `size`"),
        ("", "shape = \"sphere\", radius = 1e39", "1e39", "`radius` must be finite"),
    ] {
        let (code, at, text) = the_error(&scene(camera, mesh));
        assert!(code == "E0905" && at == place && text.contains(message), "{camera} {mesh}: {code} {at} {text}");
    }
}

#[test]
fn every_value_arrives() {
    let loaded = load_text(GOOD);
    let scene = loaded.scene.as_ref().unwrap_or_else(|| panic!("{:?}", told(&loaded)));
    assert!(loaded.diagnostics.is_empty(), "{:?}", told(&loaded));
    assert_eq!((scene.name.as_str(), scene.framebuffer.width, scene.framebuffer.height), ("a", 16, 8));
    assert_eq!(scene.framebuffer.format, Format::Rgba16Float);
    assert_eq!(scene.framebuffer.clear[0], f64::from(0.1_f32));
    let draw = &scene.draws[0];
    assert_eq!((draw.vertex_count, draw.instances, draw.indices.is_none()), (3, 1, true));
    let interface = &draw.program.interface;
    let attribute = |name: &str| {
        let index = interface.attributes.iter().position(|attribute| attribute.name == name).expect("declared");
        draw.attributes[index].as_ref().expect("it has data")
    };
    assert_eq!(attribute("cell").values, AttributeValues::Int(vec![1, 2, 3]));
    assert_eq!((attribute("pv").size, attribute("turn").size), (3, 4));
    // w gets its default.
    assert_eq!(attribute("pv").fetch(1, 0, 0, 4, 3), ScalarValue::Float(1.0));
    let root = |name: &str| {
        let index = interface.roots.iter().position(|root| root.name == name).expect("declared");
        &draw.uniforms[index]
    };
    assert_eq!(root("lights")[9], ScalarValue::Float(0.1));
    assert_eq!(root("weights")[2], ScalarValue::Float(3.0));
    assert_eq!(root("lit")[0], ScalarValue::Bool(true));
    assert_eq!(root("count")[0], ScalarValue::Int(4));
    assert_eq!(root("Camera")[2], ScalarValue::Float(1.0));
    let texture = |name: &str| {
        let index = interface.samplers.iter().position(|sampler| sampler.name == name).expect("declared");
        draw.textures[index].as_ref().expect("it has texels")
    };
    assert_eq!(texture("tex").levels[1].texels, Texels::Float(vec![[0.5, 0.5, 0.0, 1.0]]));
    assert_eq!(texture("ids").levels[0].texels, Texels::Int(vec![[1, 2, -3, 4]]));
}

#[test]
fn whole_arrays_go_by_either_name() {
    for name in ["\"weights[0]\" = [1, 2, 3]", "\"weights[2]\" = 7\n\"weights[0]\" = 7\n\"weights[1]\" = 7"] {
        let loaded = changed("weights = [1, 2, 3]", name);
        assert!(loaded.scene.is_some(), "{name}: {:?}", told(&loaded));
    }
    assert_eq!(mistake("weights = [1, 2, 3]", "\"weights[1]\" = [1, 2]").0, "E0908");
    assert_eq!(mistake("weights = [1, 2, 3]", "\"weights[3]\" = 1").0, "E0908");
}

#[test]
fn unknown_keys_name_the_nearest() {
    let (code, place, text) = mistake("width = 16", "widht = 16");
    assert_eq!((code, place.as_str()), ("E0903", "widht"));
    assert!(text.contains("did you mean `width`?"), "{text}");
    assert_eq!(mistake("[framebuffer]", "[framebufer]\n[framebuffer]").0, "E0903");
    assert_eq!(mistake("size = 3,", "size = 3, divisr = 0,").0, "E0903");
    assert_eq!(mistake("filter = \"trilinear\"", "filtre = \"trilinear\"").0, "E0903");
}

#[test]
fn undeclared_names_name_the_nearest() {
    let (code, place, text) = mistake("mc = [", "mv = [");
    assert_eq!((code, place.as_str()), ("E0907", "mv"));
    assert!(text.contains("did you mean `mc`?"), "{text}");
    let (code, _, text) = mistake("\"lights[0].power\"", "\"lights[0].powr\"");
    assert!(code == "E0907" && text.contains("lights[0].power"), "{text}");
    // The intended attribute lacks its data, too, but the name is the error.
    let loaded = changed("cell = { size = 1", "cel = { size = 1");
    assert_eq!(told(&loaded).len(), 1, "{:?}", told(&loaded));
    assert_eq!(mistake("ids = {", "tox = { width = 1, height = 1, values = [1, 1, 1, 1] }\nids = {").0, "E0907");
    assert_eq!(mistake("vertex = \"a.vert\"", "vertex = \"a.vert\"\ndynamic = [\"mcc\"]").0, "E0907");
    assert_eq!(mistake("[draw.uniforms]", "[draw.attribute_locations]\npw = 0\n[draw.uniforms]").0, "E0907");
}

#[test]
fn attributes_and_samplers_are_no_uniforms() {
    let (code, _, text) = mistake("lit = true", "lit = true\npv = [1, 2, 3, 4]");
    assert!(code == "E0910" && text.contains("is an attribute"), "{text}");
    let (code, _, text) = mistake("lit = true", "lit = true\ntex = 0");
    assert!(code == "E0910" && text.contains("[draw.textures]"), "{text}");
}

#[test]
fn wrong_types_and_values_are_told_where_they_stand() {
    let (code, place, _) = mistake("width = 16", "width = \"16\"");
    assert_eq!((code, place.as_str()), ("E0904", "\"16\""));
    assert_eq!(mistake("width = 16", "width = 1.5").0, "E0904");
    assert_eq!(mistake("width = 16", "width = 0").0, "E0905");
    assert_eq!(mistake("width = 16", "width = 100000000").0, "E0905");
    assert_eq!(mistake("clear = [0.1, 0.2, 0.3, 1.0]", "clear = [1, 1, 1]").0, "E0904");
    let (code, _, text) = mistake("\"rgba16float\"", "\"rgba16flaot\"");
    assert!(code == "E0905" && text.contains("did you mean `rgba16float`?"), "{text}");
    assert_eq!(mistake("lit = true", "lit = \"yes\"").0, "E0904");
    assert_eq!(mistake("[[draw]]", "[[draw]]\nprimitive = \"quads\"").0, "E0905");
    assert_eq!(mistake("[[draw]]", "[[draw]]\nblend = [\"one\"]").0, "E0904");
    for (blend, place) in [
        ("blend = [\"constant_color\", \"one\"]\nblend_color = [2, 0, 0, 0]", "[2, 0, 0, 0]"),
        ("blend = \"add\"\nblend_color = [1, 0, 0, 0]", "[1, 0, 0, 0]"),
        ("blend = [\"constant_color\", \"constant_alpha\"]", "[\"constant_color\", \"constant_alpha\"]"),
    ] {
        let (code, at, text) = mistake("[[draw]]", &format!("[[draw]]\n{blend}"));
        assert!(code == "E0905" && at == place, "{code} {at}: {text}");
    }
}

#[test]
fn kinds_must_agree_with_the_shader() {
    let (code, place, text) = mistake("cell = { size = 1,", "cell = { size = 1, kind = \"float\",");
    assert_eq!((code, place.as_str()), ("E0910", "\"float\""));
    assert!(text.contains("ivec2"), "{text}");
    assert_eq!(mistake("values = [1, 2, 3] }", "values = [1.5, 2, 3] }").0, "E0910");
    assert_eq!(mistake("lit = true", "lit = true\ncount = 1.5").0, "E0910");
    assert_eq!(mistake("tex = {", "tex = { kind = \"cube\",").0, "E0910");
    assert_eq!(mistake("ids = {", "ids = { filter = \"linear\",").0, "E0905");
    assert_eq!(mistake("ids = {", "ids = { integer = false,").0, "E0910");
}

#[test]
fn sizes_must_fit() {
    let (code, _, text) = mistake("mc = [1,0,0,0, ", "mc = [");
    assert!(code == "E0908" && text.contains("16 numbers, not 12"), "{text}");
    assert_eq!(mistake("pv = { size = 3", "pv = { size = 0").0, "E0905");
    assert_eq!(mistake("pv = { size = 3", "pv = { size = 5").0, "E0908");
    assert_eq!(mistake("pv = { size = 3", "pv = { size = 2").0, "E0908");
    assert_eq!(mistake("values = [1, 2, 3] }", "values = [1, 2] }").0, "E0908");
    assert_eq!(mistake("0, 1, 0, 1]", "0, 1, 0]").0, "E0908");
    assert_eq!(mistake("[[draw]]", "[[draw]]\nvertex_count = 4").0, "E0908");
    let (code, place, _) = mistake("[[draw]]", "[[draw]]\nindices = [0, 1, 3]");
    assert_eq!((code, place.as_str()), ("E0908", "3"));
}

/// An attribute that is read and reaches no output needs no data, though the text uses it.
#[test]
fn what_reaches_no_output_needs_no_data() {
    let scene = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n[draw.attributes]\n\
        p = { size = 2, values = [-1, -1, 1, -1, 0, 1] }\n";
    let points = scene.replace("[[draw]]\n", "[[draw]]\nprimitive = \"points\"\n");
    let sized = points.replace("[[draw]]\n", "[[draw]]\nprogram_point_size = true\n");
    for (scene, needed) in [(scene, false), (&points, false), (&sized, true)] {
        let vertex = "#version 150\nin vec4 p;\nin float q;\nout vec4 v;\n\
            void main() { v = p; gl_Position = p; gl_PointSize = q; }\n";
        let fragment = "#version 150\nin vec4 v;\nout vec4 fc;\nvoid main() { fc = v; }\n";
        let files = MemoryFiles::new([("a.toml", scene), ("a.vert", vertex), ("a.frag", fragment)]);
        let loaded = load("a.toml", &files, &compiler());
        let codes: Vec<&str> = loaded.diagnostics.iter().map(|diagnostic| diagnostic.code.id).collect();
        assert_eq!(codes, [if needed { "E0909" } else { "W0906" }], "{scene}");
    }
    // What happens to the attribute, what the fragment stage does with the varying, and whether it needs data.
    for (vertex, fragment, needed) in [
        ("vec4 unread = q * 2.0;", "fc = v;", false),
        ("w = q;", "vec4 unread = w; fc = v;", false),
        ("w = q;", "fc = v + w;", true),
        ("w = q;", "fc = v; if (w.x > 0.0) discard;", true),
        ("gl_Position += q;", "fc = v;", true),
        ("if (false) gl_Position.x = q.x;", "fc = v;", false),
        ("const bool ON = true; if (ON) gl_Position.x = q.x;", "fc = v;", true),
    ] {
        let vertex = format!(
            "#version 150\nin vec4 p;\nin vec4 q;\nout vec4 v;\nout vec4 w;\n\
             void main() {{ v = p; w = p; gl_Position = p; {vertex} }}\n"
        );
        let fragment = format!("#version 150\nin vec4 v;\nin vec4 w;\nout vec4 fc;\nvoid main() {{ {fragment} }}\n");
        let files = MemoryFiles::new([("a.toml", scene), ("a.vert", &vertex), ("a.frag", &fragment)]);
        let loaded = load("a.toml", &files, &compiler());
        let codes: Vec<&str> = loaded.diagnostics.iter().map(|diagnostic| diagnostic.code.id).collect();
        assert_eq!(
            (loaded.scene.is_some(), codes),
            (!needed, vec![if needed { "E0909" } else { "W0906" }]),
            "{vertex}{fragment}"
        );
    }
}

/// The depth of a texture is taken for its layers, too.
#[test]
fn a_depth_is_the_layers_of_an_array() {
    let vertex = "#version 150\nvoid main() { gl_Position = vec4(0.0, 0.0, 0.0, 1.0); }\n";
    for (sampler, place, size, values) in [
        ("sampler2DArray", "vec3(0.5)", "width = 1, height = 1", "[1, 2, 3, 4, 5, 6, 7, 8]"),
        ("sampler1DArray", "vec2(0.5)", "width = 1, height = 1", "[1, 2, 3, 4, 5, 6, 7, 8]"),
        ("sampler2DArrayShadow", "vec4(0.5)", "width = 1, height = 1", "[0.25, 0.75]"),
    ] {
        let fragment = format!(
            "#version 150\nuniform {sampler} t;\nout vec4 fc;\nvoid main() {{ fc = vec4(texture(t, {place})); }}\n"
        );
        let depths = |key: &str| {
            let size = if sampler == "sampler1DArray" { "width = 1" } else { size };
            let scene = format!(
                "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n[draw.textures]\n\
                 t = {{ {size}, {key} = 2, values = {values} }}\n"
            );
            let files = MemoryFiles::new([("a.toml", scene.as_str()), ("a.vert", vertex), ("a.frag", &fragment)]);
            let loaded = load("a.toml", &files, &compiler());
            let found = told(&loaded);
            let scene = loaded.scene.unwrap_or_else(|| panic!("{sampler}, {key}: {found:?}"));
            format!("{:?}", scene.draws[0].textures)
        };
        assert_eq!(depths("depth"), depths("layers"), "{sampler}");
    }
}

/// Outputs for which there is no attachment are dropped, as by OpenGL.
#[test]
fn outputs_without_an_attachment_are_dropped() {
    let vertex = "#version 150\nvoid main() { gl_Position = vec4(0.0, 0.0, 0.0, 1.0); }\n";
    let fragment = "#version 150\nout vec4 a; out vec4 b;\nvoid main() { a = vec4(1.0); b = vec4(0.0); }\n";
    let scene = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n";
    let files = MemoryFiles::new([("a.toml", scene), ("a.vert", vertex), ("a.frag", fragment)]);
    let loaded = load("a.toml", &files, &compiler());
    assert!(loaded.scene.is_some());
    assert!(
        matches!(&told(&loaded)[..], [one] if one.starts_with("W0914") && one.contains("`b`")),
        "{:?}",
        told(&loaded)
    );
}

#[test]
fn missing_data_is_an_error_and_missing_values_are_a_warning() {
    let (code, _, text) = mistake("cell = { size = 1, values = [1, 2, 3] }", "");
    assert!(code == "E0909" && text.contains("`cell`"), "{text}");
    for (line, warning) in [("lit = true", "W0901"), ("\"lights[1].power\" = 0.1", "W0901")] {
        let loaded = changed(line, "");
        assert!(loaded.scene.is_some(), "{:?}", told(&loaded));
        let codes: Vec<&str> = loaded.diagnostics.iter().map(|diagnostic| diagnostic.code.id).collect();
        assert_eq!(codes, [warning], "{line}");
    }
    let loaded = changed("weights = [1, 2, 3]", "\"weights[1]\" = 2");
    assert_eq!(told(&loaded), ["W0901: uniforms `weights[0]` and `weights[2]` get no value and are 0"]);
    let loaded = changed("ids = { width = 1, height = 1, values = [1, 2, -3, 4] }", "");
    assert!(loaded.scene.is_some() && told(&loaded)[0].starts_with("W0902"), "{:?}", told(&loaded));
}

#[test]
fn a_declared_name_that_nothing_uses_is_accepted() {
    let loaded = changed("lit = true", "lit = true\nunused = [1, 2]");
    assert!(loaded.scene.is_some() && loaded.diagnostics.is_empty(), "{:?}", told(&loaded));
}

#[test]
fn files_that_are_no_scenes() {
    let (code, _, _) = mistake("width = 16", "width = ");
    assert_eq!(code, "E0902");
    for text in ["", "\u{0}\u{1}\u{2}", "just words"] {
        let loaded = load_text(text);
        assert!(loaded.scene.is_none() && !loaded.io_error);
        assert!(told(&loaded).iter().all(|line| line.starts_with("E0902")), "{:?}", told(&loaded));
    }
    let mut files = MemoryFiles::default();
    files.0.insert("a.toml".into(), vec![0xff, 0xfe, 0x00]);
    let loaded = load("a.toml", &files, &compiler());
    assert!(told(&loaded)[0].contains("not UTF-8"), "{:?}", told(&loaded));
}

#[test]
fn missing_files_and_folders_are_io_errors() {
    let (code, place, _) = mistake("\"a.frag\"", "\"b.frag\"");
    assert_eq!((code, place.as_str()), ("E0901", "\"b.frag\""));
    assert!(changed("\"a.frag\"", "\"b.frag\"").io_error);
    let compiler = compiler();
    for (path, message) in [("no such scene.toml", "no such file"), (env!("CARGO_MANIFEST_DIR"), "a folder")] {
        let loaded = load(path, &DiskFiles, &compiler);
        assert!(loaded.io_error && loaded.scene.is_none());
        assert!(told(&loaded)[0].contains(message), "{:?}", told(&loaded));
    }
}

#[test]
fn mistakes_of_shaders_are_told_with_those_of_the_scene() {
    let files = MemoryFiles::new([
        ("a.toml", GOOD),
        ("a.vert", "#version 150\nvoid main() { x = 1; }\n"),
        ("a.frag", FRAGMENT),
    ]);
    let loaded = load("a.toml", &files, &compiler());
    assert!(loaded.scene.is_none() && !loaded.io_error);
    let first = loaded.diagnostics.iter().next().expect("an error");
    let place = loaded.sources.location(first.primary.span).expect("it is in a file");
    assert_eq!((loaded.sources.file(place.file).name(), place.line), ("a.vert", 2));
}

#[test]
fn helpers_make_meshes_and_matrices() {
    let text = GOOD
        .replace("pv = { size = 3, values = [-1, -1, 0, 1, -1, 0, 0, 1, 0] }\n", "")
        .replace("cell = { size = 1, values = [1, 2, 3] }\n", "cell = { divisor = 1, values = [1, 2] }\n")
        .replace("turn = { size = 4, values = [1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1] }\n", "turn = { divisor = 1, values = [1, 0, 0, 1] }\n")
        .replace("mc = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n", "")
        .replace(
            "[draw.attributes]",
            "[draw.mesh]\nshape = \"sphere\"\nsegments = 8\nrings = 4\nposition = \"pv\"\n[draw.camera]\neye = [0, 0, 5]\n\
             [draw.transform]\ntranslate = [0, 0, 1]\n[draw.matrices]\nmc = \"model_view\"\n[draw.attributes]",
        );
    let loaded = load_text(&text);
    let scene = loaded.scene.as_ref().unwrap_or_else(|| panic!("{:?}", told(&loaded)));
    let draw = &scene.draws[0];
    assert_eq!(draw.indices.as_ref().map(Vec::len), Some(8 * 4 * 6));
    let mc = draw.program.interface.roots.iter().position(|root| root.name == "mc").expect("declared");
    assert_eq!(draw.uniforms[mc][14], ScalarValue::Float(-4.0));
}

#[test]
fn all_scenes_of_the_repository_load() {
    let paths = paths();
    assert!(paths.len() >= 50, "only {} scenes", paths.len());
    for path in paths {
        let loaded = load(&path, &DiskFiles, &compiler());
        assert!(loaded.scene.is_some() && loaded.diagnostics.is_empty(), "{path}: {:?}", told(&loaded));
    }
}

/// The scenes in `fixtures/scenes`, sorted.
pub(crate) fn paths() -> Vec<String> {
    let scenes = root().join("fixtures/scenes");
    let mut paths = Vec::new();
    for folder in [scenes.join("core"), scenes] {
        for entry in std::fs::read_dir(folder).expect("the folder is there") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                paths.push(path.to_string_lossy().into_owned());
            }
        }
    }
    paths.sort();
    paths
}
