//! The variants of whole scenes: what is found, that it draws, and that what is exact in exact arithmetic is so but for rounding.

use super::edit::{differs, stage_text};
use super::{AS_WRITTEN, FoundWay, Origin, found};
use glisten_emit::FloatWidth;
use glisten_front::hir::Stage;
use glisten_front::{Compiler, Options};
use glisten_reference::{Precision, RenderOptions, render};
use glisten_scene::Scene;
use glisten_scene::picture::Picture;
use glisten_verify::scene::{DiskFiles, FileError, FileSource, Loaded, MemoryFiles, load};
use std::path::{Path, PathBuf};

/// Files, and a scene's text.
struct Text<'a>(&'a str, &'a str, &'a dyn FileSource);

impl FileSource for Text<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        if path == self.0 { Ok(self.1.as_bytes().to_vec()) } else { self.2.read(path) }
    }
}

fn compiler() -> Compiler {
    Compiler::new(Options::default()).with_includes(glisten_library::Embedded)
}

/// The variants of a scene by its text.
fn ways(path: &str, text: &str, files: &dyn FileSource) -> Vec<FoundWay> {
    let compiler = compiler();
    let loaded = |text: &str| load(path, &Text(path, text, files), &compiler);
    let Loaded { scene, diagnostics, .. } = loaded(text);
    let messages: Vec<String> = diagnostics.iter().map(|one| one.message.clone()).collect();
    let Some(scene) = scene else { panic!("{path}: {messages:?}") };
    let load = |text: &str| loaded(text).scene;
    found(&Origin { name: "scene", scene: &scene, text, load: &load })
}

fn picture(scene: &Scene, precision: Precision) -> Picture {
    let options = RenderOptions { precision, mark_edges: false, ..RenderOptions::default() };
    render(scene, &options).expect("the reference draws every way")
}

/// The largest difference of a channel where both cover, and how many pixels differ in finiteness.
fn distance(a: &Picture, b: &Picture) -> (f64, usize) {
    let (mut largest, mut strange) = (0.0f64, 0);
    for (colors, others) in a.attachments.iter().zip(&b.attachments) {
        for (pixel, (color, other)) in colors.iter().zip(others).enumerate() {
            if a.covered.get(pixel) != b.covered.get(pixel) {
                continue;
            }
            for (x, y) in color.iter().zip(other) {
                let same = x == y || (x.is_nan() && y.is_nan());
                match (x - y).abs() {
                    difference if difference.is_finite() => largest = largest.max(difference),
                    _ => strange += usize::from(!same),
                }
            }
        }
    }
    (largest, strange)
}

/// Kinds that are the scene as written in exact arithmetic.
const EXACT: &[&str] = &["specialized", "moved", "stable", "pow", "inversesqrt", "naive"];

/// Draws every variant, and checks those that are exact. A line for each variant.
fn check(name: &str, ways: &[FoundWay]) -> Vec<String> {
    let truth = picture(&ways[0].scene, Precision::F64);
    let finite = truth.attachments.iter().flatten().flatten().filter(|x| x.is_finite());
    let scale = finite.fold(1.0f64, |a, x| a.max(x.abs()));
    let mut lines = Vec::new();
    for way in ways {
        let (error, strange) = distance(&picture(&way.scene, Precision::F64), &truth);
        let mesh = way.tessellation.map_or(String::new(), |[segments, rings]| format!("{segments}x{rings}"));
        lines.push(format!("{:30} {:12} {mesh:7} {error:8.1e} {strange} {}", way.name, way.kind, way.about));
        let exact = EXACT.contains(&way.kind) && way.tessellation.is_none();
        // The power of a negative number is undefined, its square is not.
        let strange = if way.kind == "pow" { 0 } else { strange };
        assert!(!exact || (error < 1e-5 * scale && strange == 0), "{name}: {}", lines.join("\n"));
        let is_other = way.floats != FloatWidth::Single || differs(&way.scene, &ways[0].scene);
        assert!(way.name == AS_WRITTEN || is_other, "{name}: {}", way.name);
        for draw in &way.scene.draws {
            for shader in &draw.program.stages {
                assert!(stage_text(&draw.program.types, shader).starts_with("#version 150"), "{name}: {}", way.name);
            }
        }
    }
    lines
}

/// The variants of a ball that a fragment stage shades. It has the varyings `N` and `P`, and the uniforms `L`, `V`, `k` and `K`.
fn ball(fragment: &str, draw: &str) -> Vec<FoundWay> {
    let vertex = "#version 150\nin vec3 pv;\nin vec3 nv;\nuniform mat4 mc;\nout vec3 N;\nout vec3 P;\n\
                  flat out float patch;\n\
                  void main() { N = nv; P = pv; patch = pv.x; gl_Position = mc * vec4(pv, 1.0); }\n";
    let fragment = format!(
        "#version 150\nin vec3 N;\nin vec3 P;\nflat in float patch;\nuniform vec3 L;\nuniform vec3 V;\n\
         uniform float k;\nuniform vec3 K;\nuniform sampler2D tex;\nout vec4 color;\n{fragment}"
    );
    let draw = if draw.contains("cull") { draw.to_owned() } else { format!("cull = \"back\"\n{draw}") };
    let scene = format!(
        "[framebuffer]\nwidth = 40\nheight = 40\n[camera]\neye = [0.0, 0.0, 3.0]\n[[draw]]\nvertex = \"a.vert\"\n\
         fragment = \"a.frag\"\n{draw}\n[draw.mesh]\nshape = \"sphere\"\nposition = \"pv\"\n\
         normal = \"nv\"\nsegments = 24\nrings = 12\n[draw.matrices]\nmc = \"model_view_projection\"\n\
         [draw.uniforms]\nL = [0.6, 0.64, 0.48]\nV = [0.0, 0.0, 1.0]\nk = 20.0\nK = [0.5, 0.25, 1.0]\n\
         [draw.textures]\ntex = {{ width = 1, height = 1, values = [0.5, 0.5, 0.5, 1.0] }}\n"
    );
    let files = MemoryFiles::new([("a.vert", vertex), ("a.frag", &fragment)]);
    let ways = ways("s.toml", &scene, &files);
    check(&fragment, &ways);
    ways
}

fn has(ways: &[FoundWay], kind: &str) -> bool {
    ways.iter().any(|way| way.kind == kind && way.tessellation.is_none())
}

/// The text of the fragment stage of a variant.
fn fragment(ways: &[FoundWay], name: &str) -> String {
    let way = ways.iter().find(|way| way.name == name).unwrap_or_else(|| panic!("no way `{name}`"));
    let program = &way.scene.draws[0].program;
    stage_text(&program.types, program.stage(Stage::Fragment).expect("a fragment stage"))
}

const PHONG: &str = "void main() {
    vec3 n = normalize(N);
    vec3 R = reflect(-normalize(L), n);
    float c = max(dot(R, normalize(V)), 0.0);
    color = vec4(K * max(dot(n, L), 0.0) + vec3(pow(c, k)), 1.0);
}
";

#[test]
fn a_program_of_a_user_has_ways_of_every_kind() {
    let ways = ball(PHONG, "");
    for kind in
        ["specialized", "fast-math", "stable", "pow", "schlick", "inversesqrt", "vertex", "noperspective", "table"]
    {
        assert!(has(&ways, kind), "{kind} is not among {:?}", ways.iter().map(|way| &way.name).collect::<Vec<_>>());
    }
    assert_eq!(ways.iter().filter(|way| way.kind == "table").count(), 8);
    let coarser = |kind: &str| ways.iter().filter(|way| way.kind == kind && way.tessellation.is_some()).count();
    assert_eq!((coarser("tessellation"), coarser("vertex")), (2, 3));
    let names: Vec<_> = ways.iter().map(|way| (&way.name, way.tessellation)).collect();
    assert!(names.iter().enumerate().all(|(index, name)| !names[..index].contains(name)), "{names:?}");
}

#[test]
fn the_same_ways_on_every_run() {
    let texts = |ways: &[FoundWay]| ways.iter().map(|way| (way.name.clone(), way.about.clone())).collect::<Vec<_>>();
    assert_eq!(texts(&ball(PHONG, "")), texts(&ball(PHONG, "")));
}

/// Fragment programs, keys of the draw, and a kind with whether it is found.
static FOUND: &[(&str, &str, &str, bool)] = &[
    ("void main() { color = vec4(pow(max(N.z, 0.0), 7.0)); }", "", "pow", true),
    ("void main() { color = vec4(pow(max(N.z, 0.0), k)); }", "", "pow", true),
    ("void main() { color = vec4(pow(max(N, vec3(0.0)), vec3(k)), 1.0); }", "", "pow", true),
    // Not a whole number, a number for each component, a number that changes.
    ("void main() { color = vec4(pow(max(N.z, 0.0), 2.2)); }", "", "pow", false),
    ("void main() { color = vec4(pow(max(N, vec3(0.0)), 4.0 * K), 1.0); }", "", "pow", false),
    ("void main() { color = vec4(pow(max(N.z, 0.0), k)); }", "dynamic = [\"k\"]", "pow", false),
    ("void main() { color = vec4(pow(max(N.z, 0.0), k)); }", "dynamic = [\"k\"]", "table", false),
    ("void main() { color = vec4(pow(max(N.z, 0.0), k)); }", "dynamic = [\"k\"]", "schlick", false),
    ("void main() { color = vec4(pow(2.0 + N.z, 3.0)); }", "", "schlick", false),
    ("void main() { color = vec4(pow(clamp(N.z, 0.0, 1.0), 3.0)); }", "", "schlick", true),
    ("void main() { color = vec4(exp(-4.0 * N.z * N.z)); }", "", "table", true),
    // In another frame, the table's range is another one.
    ("void main() { float x = N.z + k; color = vec4(exp(-4.0 * x * x)); }", "", "table", true),
    ("void main() { float x = N.z + k; color = vec4(exp(-4.0 * x * x)); }", "dynamic = [\"k\"]", "table", false),
    ("float f(float x) { return sin(x) / (1.0 + x * x); }\nvoid main() { color = vec4(f(N.z)); }", "", "table", true),
    ("void main() { float a = N.x * N.x; float b = a + k; color = vec4(exp(b - k) / b); }", "", "table", true),
    ("void main() { color = vec4(mix(K, vec3(1.0), pow(1.0 - max(N.z, 0.0), 5.5)), 1.0); }", "", "table", true),
    // Two numbers, a function with an effect, a texture, a derivative, too cheap.
    ("void main() { color = vec4(exp(N.x * N.y + sin(N.z))); }", "", "table", false),
    (
        "float s;\nfloat f(float x) { s += x; return s; }\nvoid main() { s = 0.0; color = vec4(f(N.z)); }",
        "",
        "table",
        false,
    ),
    ("void main() { color = texture(tex, vec2(N.z, 0.5)); }", "", "table", false),
    ("void main() { color = vec4(N.z * N.z + 1.0); }", "", "table", false),
    ("void main() { color = vec4(normalize(N), 1.0); }", "", "vertex", true),
    ("void main() { color = vec4(modf(N.x * 3.0, color.r)); }", "", "vertex", true),
    // Nothing computed, and what only a fragment has.
    ("void main() { color = vec4(N, 1.0); }", "", "vertex", false),
    ("void main() { if (N.x * N.y > 0.0) discard; color = vec4(N * N, 1.0); }", "", "vertex", false),
    ("void main() { color = vec4(dFdx(P) * 9.0, 1.0); }", "", "vertex", false),
    ("void main() { color = vec4(patch * N, 1.0); }", "", "vertex", false),
    ("void main() { color = vec4(gl_FragCoord.xyz * N, 1.0); }", "", "vertex", false),
    ("void main() { color = texture(tex, N.xy) * N.z; }", "dynamic = [\"tex\"]", "vertex", false),
    (
        "void main() { color = gl_FrontFacing ? vec4(N * N, 1.0) : vec4(P * P, 1.0); }",
        "cull = \"none\"",
        "vertex",
        false,
    ),
    ("void main() { color = vec4(N * N, 1.0); }", "", "noperspective", true),
    ("void main() { color = vec4(patch); }", "", "noperspective", false),
    ("void main() { color = vec4(1.0 - N.z * N.z); }", "", "stable", true),
    ("void main() { color = vec4(pow(dot(normalize(N), normalize(V)), k)); }", "", "stable", true),
    ("void main() { color = vec4(1.0 - cos(N.z)); }", "", "stable", true),
    ("void main() { color = vec4(N.x * N.x - N.y * N.y); }", "", "stable", true),
    ("void main() { color = vec4(sqrt(N.z + 4.0) - sqrt(4.0)); }", "", "stable", true),
    ("void main() { color = vec4(1.0 - N.x * N.y); }", "", "stable", false),
    ("void main() { color = vec4(N / length(N), 1.0); }", "", "inversesqrt", true),
    ("void main() { color = vec4(N.x / sqrt(1.5 + N.y)); }", "", "inversesqrt", true),
    ("void main() { color = vec4(N.x / length(P - N), 1.0, 1.0, 1.0); }", "", "inversesqrt", false),
];

#[test]
fn a_change_is_found_where_it_is_one() {
    let wrong: Vec<_> =
        FOUND.iter().filter(|(text, draw, kind, wanted)| has(&ball(text, draw), kind) != *wanted).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn the_text_of_a_way_is_what_a_person_would_write() {
    let ways = ball(PHONG, "");
    let squared = fragment(&ways, "powers by squaring");
    assert!(squared.contains("x16 * x4") || squared.contains("x4 * x16"), "{squared}");
    assert!(!squared.contains("pow("), "{squared}");
    let table = fragment(&ways, "table of 64 texels, linear");
    assert!(table.contains("textureLod(") && !table.contains("pow("), "{table}");
    let vertex = fragment(&ways, "per vertex");
    assert!(vertex.contains("in vec4 shaded;") && !vertex.contains("normalize"), "{vertex}");
}

#[test]
fn tables_are_finer_with_more_texels() {
    let ways = ball(PHONG, "");
    let truth = picture(&ways[0].scene, Precision::F64);
    for filter in ["nearest", "linear"] {
        let error = |texels: u32| {
            let name = format!("table of {texels} texels, {filter}");
            let way = ways.iter().find(|way| way.name == name).expect("it is found");
            distance(&picture(&way.scene, Precision::F64), &truth).0
        };
        assert!(
            error(16) > 2.0 * error(64) && error(64) > 2.0 * error(256) && error(256) > 2.0 * error(1024),
            "{filter}"
        );
    }
}

/// The scenes of `WAYS_OF`, a scene or a folder of them, or a few: `WAYS_OF=FOLDER cargo test --lib every_way_of`.
#[test]
fn every_way_of_a_scene_draws() {
    let folder = std::env::var("WAYS_OF").ok();
    let mut paths: Vec<PathBuf> = match &folder {
        Some(folder) => std::fs::read_dir(folder)
            .map(|entries| entries.filter_map(|entry| Some(entry.ok()?.path())).collect())
            .unwrap_or_else(|_| vec![PathBuf::from(folder)]),
        None => ["core/fog.toml", "core/arcs.toml", "triangle.toml"]
            .map(|scene| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/scenes").join(scene))
            .into(),
    };
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    for path in paths {
        let text = std::fs::read_to_string(&path).expect("a scene");
        let name = path.to_string_lossy();
        let lines = check(&name, &ways(&name, &text, &DiskFiles));
        assert!(!lines.is_empty(), "{name} has no ways");
    }
}
