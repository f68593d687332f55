//! Measures what leaving out gains and what it costs: the time in which lavapipe draws residuals and their originals, and
//! the time in which residuals are made.
//!
//! `cargo bench --bench specialize` prints both as Markdown, for `docs/specialize.md`; with `draw` or `make` one of them, with
//! `draw edge spot` only these scenes. `once LINES` makes a residual of that many lines once, and `compile LINES` does all but that:
//! for a tool that counts instructions.
//! A ratio is the median over rounds of the residual's time to the original's of the same round, which are drawn in turns;
//! the last column tells how far that of the original to itself reaches, which is the noise. Operations are counted on the reference.

#![expect(clippy::print_stdout, reason = "a benchmark prints its figures")]

use glisten::emit::FloatWidth;
use glisten::scene::{DiskFiles, Scene, load};
use glisten::specialize::{Known, ScalarValue, specialize, specialize_scene};
use glisten::{Compiler, Options, Program, Source, Stage};
use glisten_gpu::{Gpu, Via};
use glisten_report::{Limits, Weights, paired, steps, work};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The rounds of a scene.
const LIMITS: Limits = Limits { rounds: 60, time: Duration::from_secs(6) };

fn main() {
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    if let [what @ ("once" | "compile"), lines] = asked.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        let program = program(&long(lines.parse().expect("a number of lines")));
        if what == "once" {
            std::hint::black_box(specialize(&program, &known()));
        }
        return;
    }
    let wants = |what: &str| asked.is_empty() || asked.iter().any(|asked| asked == what);
    if wants("draw") {
        drawn(&asked);
    }
    if wants("make") {
        made();
    }
}

/// The folders of scenes: the gallery, programs with a twin by hand, and families of uber-shaders.
static FOLDERS: &[(&str, &str)] = &[
    ("gallery", "shader_lib/scenes"),
    ("with a twin by hand", "fixtures/specialize/by_hand"),
    ("decals", "fixtures/specialize/families/decals"),
    ("particles", "fixtures/specialize/families/particles"),
    ("skinning", "fixtures/specialize/families/skinning"),
    ("terrain", "fixtures/specialize/families/terrain"),
    ("tiled lights", "fixtures/specialize/families/tiled_lights"),
];

/// The scenes of a folder.
fn scenes(folder: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = std::fs::read_dir(root.join(folder)).expect("a folder of scenes");
    let mut scenes: Vec<PathBuf> = folder
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    scenes.sort();
    scenes
}

/// The median of some numbers.
fn median(numbers: &mut [f64]) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(f64::NAN)
}

fn drawn(asked: &[String]) {
    let gpu = Gpu::new(Some("software")).expect("a Vulkan adapter: apt-get install mesa-vulkan-drivers");
    println!(
        "| scene | operations | original, ms | residual, ms | ratio | interval | noise |\n| --- | --- | --- | --- | --- | --- | --- |"
    );
    let mut summaries = Vec::new();
    for (family, folder) in FOLDERS {
        let (mut ratios, mut n_slower) = (Vec::new(), 0);
        for path in scenes(folder) {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            if asked.len() > 1 && !asked.contains(&name) {
                continue;
            }
            let loaded = load(&path.to_string_lossy(), &DiskFiles, &Compiler::new(Options::default()));
            let scene = loaded.scene.expect("the scene is valid");
            let residual = specialize_scene(&scene, &loaded.sources, &[]).scene;
            let times = paired(&gpu, [&scene, &residual], Via::Spirv, LIMITS, &mut ()).expect("it can be drawn");
            let ([low, high], [_, noise]) = (times.ratio.interval, times.same_again.interval);
            println!(
                "| `{name}` | {:.3} | {:.2} | {:.2} | {:.3} | [{low:.3}, {high:.3}] | {noise:.3} |",
                operations(&residual) / operations(&scene),
                times.first_ms,
                times.second_ms,
                times.ratio.median,
            );
            ratios.push(times.ratio.median);
            n_slower += usize::from(times.slower);
        }
        if !ratios.is_empty() {
            let worst = ratios.iter().copied().fold(0.0, f64::max);
            let n_scenes = ratios.len();
            summaries.push(format!("| {family} | {n_scenes} | {:.3} | {worst:.3} | {n_slower} |", median(&mut ratios)));
        }
    }
    println!(
        "\n| family | scenes | median | worst | slower |\n| --- | --- | --- | --- | --- |\n{}",
        summaries.join("\n")
    );
}

/// The operations of a scene's picture, counted on the reference.
fn operations(scene: &Scene) -> f64 {
    let counts = steps(scene).expect("the reference draws it");
    work(&counts, &Weights::default(), FloatWidth::Single).operations as f64
}

const VERTEX: &str = "#version 150\nin vec4 p;\nin vec4 q;\nout vec4 v;\nvoid main() { v = q; gl_Position = p; }\n";

fn program(fragment: &str) -> Program {
    let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
    let sources = [source("a.vert", VERTEX, Stage::Vertex), source("a.frag", fragment, Stage::Fragment)];
    Compiler::new(Options::default()).compile(&sources).program.expect("a program")
}

/// A program of about so many lines: functions with branches by a uniform, loops, and what reaches no output.
fn long(lines: usize) -> String {
    let functions = lines / 10;
    let mut text = String::from("#version 150\nin vec4 v;\nuniform int mode;\nuniform float u;\nout vec4 color;\n");
    for n in 0..functions {
        text += &format!(
            "float f{n}(float x)\n{{\n    float s = x * u;\n    if (mode == {})\n        s += {n}.5;\n    \
             for (int i = 0; i < 2; ++i)\n        s = s * x + u;\n    float unread = s * s;\n    return s;\n}}\n",
            n % 3
        );
    }
    let calls: String = (0..functions).map(|n| format!("    s += f{n}(v.x);\n")).collect();
    text + &format!("void main()\n{{\n    float s = 0.0;\n{calls}    color = vec4(s);\n}}\n")
}

fn known() -> Known {
    let mut known = Known::default();
    known.uniforms.insert("mode".into(), vec![ScalarValue::Int(1)]);
    known.uniforms.insert("u".into(), vec![ScalarValue::Float(1.5)]);
    known
}

/// The best of some times in milliseconds.
fn best(program: &Program, known: &Known) -> f64 {
    let each = (0..5).map(|_| {
        let start = Instant::now();
        specialize(program, known);
        start.elapsed().as_secs_f64() * 1e3
    });
    each.fold(f64::INFINITY, f64::min)
}

fn made() {
    println!("| program | lines | ms | µs a line |\n| --- | --- | --- | --- |");
    for lines in [1_000, 2_000, 4_000, 8_000, 16_000] {
        let text = long(lines);
        let lines = text.lines().count();
        let time = best(&program(&text), &known());
        println!("| functions, branches, loops | {lines} | {time:.1} | {:.2} |", time * 1e3 / lines as f64);
    }
    for (name, text, known) in hostile() {
        let time = best(&program(&text), &known);
        println!("| {name} | {} | {time:.1} | |", text.lines().count());
    }
}

fn hostile() -> Vec<(&'static str, String, Known)> {
    let head = "#version 150\nin vec4 v;\nuniform float u;\nout vec4 color;\n";
    let lights = "#version 150\nstruct Light { int kind; vec3 towards; vec3 color; };\nin vec4 v;\nout vec4 color;\n\
        uniform Light lights[256];\nuniform int count;\nvoid main()\n{\n    vec3 sum = vec3(0.0);\n    \
        for (int i = 0; i < count; ++i) {\n        if (lights[i].kind == 1) continue;\n        \
        sum += max(dot(v.xyz, lights[i].towards), 0.0) * lights[i].color;\n    }\n    color = vec4(sum, 1.0);\n}\n";
    let mut of_lights = Known::default();
    of_lights.uniforms.insert("count".into(), vec![ScalarValue::Int(256)]);
    for light in 0..256 {
        let float = |value: f32| ScalarValue::Float(value);
        of_lights.uniforms.insert(format!("lights[{light}].kind"), vec![ScalarValue::Int(light % 3)]);
        let towards = vec![float(0.5), float(light as f32 / 256.0), float(0.25)];
        of_lights.uniforms.insert(format!("lights[{light}].towards"), towards);
        of_lights.uniforms.insert(format!("lights[{light}].color"), vec![float(0.5); 3]);
    }
    let endless = format!(
        "{head}void main()\n{{\n    float s = 0.0;\n    for (int i = 0; i < 2147483647; ++i) {{\n        s += u;\n        \
         if (s > v.x) break;\n    }}\n    color = vec4(s);\n}}\n"
    );
    let statements: String =
        (0..5_000).map(|n| format!("    float x{n} = v.x * {n}.5 + u;\n    s += x{n};\n")).collect();
    let statements = format!("{head}void main()\n{{\n    float s = 0.0;\n{statements}    color = vec4(s);\n}}\n");
    let branches: String = (0..2_500)
        .map(|n| {
            format!(
                "    float y{n} = v.y + s;\n    if (v.x > {n}.0)\n        s += u * y{n};\n    else\n        t -= s;\n"
            )
        })
        .collect();
    let branches =
        format!("{head}void main()\n{{\n    float s = 0.0, t = 0.0;\n{branches}    color = vec4(s, t, s, t);\n}}\n");
    let loops: String =
        (0..2_000).map(|n| format!("    for (int i = 0; i < count; ++i)\n        s += v[i & 3] * {n}.5;\n")).collect();
    let loops =
        format!("{head}uniform int count;\nvoid main()\n{{\n    float s = 0.0;\n{loops}    color = vec4(s);\n}}\n");
    vec![
        ("256 lights", lights.to_owned(), of_lights),
        ("a loop to 2^31", endless, known()),
        ("one function of statements", statements, known()),
        ("open branches in sequence", branches, known()),
        ("open loops in sequence", loops, known()),
    ]
}
