//! Every limit of `docs/limits.md`: what is one below it and what is at it is accepted, and what is one above it is an error that has
//! the code of the table.

use crate::support::{compiler, root};
use glisten::scene::{MemoryFiles, load};
use glisten_front::Source;
use glisten_front::hir::Stage;
use glisten_front::source::{IncludeForm, IncludeResolver, Included};
use std::fmt::Write as _;

/// A bound on what a text or a scene may have.
struct Limit {
    /// The things that are counted.
    what: &'static str,
    /// The largest number that is accepted.
    largest: u64,
    /// The code of one more.
    code: &'static str,
    /// The text or the scene with this many.
    make: fn(usize) -> Input,
}

enum Input {
    /// A fragment shader.
    Shader(String),
    /// A scene file.
    Scene(String),
    /// A glTF file.
    Model(String),
}

use Input::{Model, Scene};

fn shader(text: &str) -> Input {
    Input::Shader(format!("#version 150\n{text}"))
}

/// A shader of the version that has all layouts, with a value that it writes.
fn placed(declaration: &str, value: &str) -> Input {
    Input::Shader(format!("#version 460\n{declaration}out vec4 c;\nvoid main() {{ c = {value}; }}\n"))
}

fn in_main(body: &str) -> Input {
    shader(&format!("void main() {{ {body} }}\n"))
}

fn nested(open: &str, count: usize, inner: &str, close: &str) -> String {
    open.repeat(count) + inner + &close.repeat(count)
}

fn lines(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(line).collect()
}

/// A scene with these lines in its framebuffer, its draw and after it.
fn scene(framebuffer: &str, draw: &str, after: &str) -> Input {
    Scene(format!(
        "[framebuffer]\n{framebuffer}\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \"triangles\"\n{draw}\n{after}"
    ))
}

const SMALL: &str = "width = 8\nheight = 8";
const THREE: &str = "vertex_count = 3";
const MAIN: &str = "void main() {}\n";

static LIMITS: &[Limit] = &[
    Limit {
        what: "nested blocks of a function",
        largest: 256,
        code: "E0003",
        make: |n| in_main(&nested("{", n, "", "}")),
    },
    Limit {
        what: "nested parentheses of an initializer",
        largest: 254,
        code: "E0003",
        make: |n| in_main(&format!("float a = {};", nested("(", n, "1.0", ")"))),
    },
    Limit {
        what: "nested parentheses of an `#if`",
        largest: 64,
        code: "E0003",
        make: |n| shader(&format!("#if {}\n#endif\n{MAIN}", nested("(", n, "1", ")"))),
    },
    Limit {
        what: "levels of structs in structs",
        largest: 64,
        code: "E0003",
        make: |n| {
            let inner = |at: usize| if at == 0 { "float x".to_owned() } else { format!("S{} s", at - 1) };
            shader(&(lines(n, |at| format!("struct S{at} {{ {}; }};\n", inner(at))) + MAIN))
        },
    },
    Limit {
        what: "parameters of a macro",
        largest: 256,
        code: "E0113",
        make: |n| {
            let names: Vec<String> = (0..n).map(|at| format!("a{at}")).collect();
            shader(&format!("#define F({}) 1\n{MAIN}", names.join(",")))
        },
    },
    Limit {
        what: "macros that use each other",
        largest: 4096,
        code: "E0130",
        make: |n| {
            let body = |at: usize| if at == 0 { "1.0".to_owned() } else { format!("A{}", at - 1) };
            shader(
                &(lines(n, |at| format!("#define A{at} {}\n", body(at))) + &format!("float a = A{};\n{MAIN}", n - 1)),
            )
        },
    },
    Limit {
        what: "macro uses in each other's arguments",
        largest: 65,
        code: "E0130",
        make: |n| shader(&format!("#define F(x) x\nfloat a = {};\n{MAIN}", nested("F(", n, "1.0", ")"))),
    },
    Limit {
        what: "includes in includes",
        largest: 63,
        code: "E0128",
        make: |n| shader(&format!("#include \"{n}\"\n{MAIN}")),
    },
    Limit {
        what: "bytes of all texts of a shader",
        largest: 8 << 20,
        code: "E0004",
        make: |n| {
            let head = format!("#version 150\n{MAIN}//");
            Input::Shader(format!("{head}{}", "x".repeat(n - head.len())))
        },
    },
    Limit {
        what: "elements of an array",
        largest: 65_536,
        code: "E0409",
        make: |n| shader(&format!("float a[{n}];\n{MAIN}")),
    },
    Limit {
        what: "overloads of a function",
        largest: 1024,
        code: "E0513",
        make: |n| shader(&(lines(n, |at| format!("void f(float x[{}]) {{}}\n", at + 1)) + MAIN)),
    },
    Limit {
        what: "`vec4` of a uniform block",
        largest: 4096,
        code: "E0717",
        make: |n| shader(&format!("uniform B {{ vec4 a[{n}]; }};\nout vec4 c;\nvoid main() {{ c = a[0]; }}\n")),
    },
    Limit {
        what: "elements of an array of uniform blocks",
        largest: 72,
        code: "E0718",
        make: |n| shader(&format!("uniform B {{ vec4 a; }} b[{n}];\nout vec4 c;\nvoid main() {{ c = b[0].a; }}\n")),
    },
    Limit {
        what: "samplers of a program",
        largest: 1024,
        code: "E0716",
        make: |n| {
            shader(&format!(
                "uniform sampler2D t[{n}];\nout vec4 c;\nvoid main() {{ c = texture(t[0], vec2(0.0)); }}\n"
            ))
        },
    },
    Limit {
        what: "bindings of samplers and of uniform blocks",
        largest: 1024,
        code: "E0606",
        make: |n| {
            let sampler = format!("layout(binding = {}) uniform sampler2D t[2];\n", n - 2);
            placed(&sampler, "texture(t[1], vec2(0.0))")
        },
    },
    Limit {
        what: "locations of uniforms",
        largest: 262_144,
        code: "E0606",
        make: |n| placed(&format!("layout(location = {}) uniform mat4 m[2];\n", n - 2), "m[1][0]"),
    },
    Limit {
        what: "locations of varyings",
        largest: 32,
        code: "E0715",
        make: |n| shader(&format!("in vec4 v[{n}];\nout vec4 c;\nvoid main() {{ c = v[0]; }}\n")),
    },
    Limit {
        what: "outputs of a fragment shader",
        largest: 8,
        code: "E0714",
        make: |n| shader(&format!("out vec4 c[{n}];\nvoid main() {{ c[0] = vec4(1.0); }}\n")),
    },
    Limit {
        what: "pixels of a side of a picture",
        largest: 16_384,
        code: "E0905",
        make: |n| scene(&format!("width = {n}\nheight = 1"), THREE, ""),
    },
    Limit {
        what: "rows of a picture 16,384 pixels wide",
        largest: 4096,
        code: "E0912",
        make: |n| scene(&format!("width = 16384\nheight = {n}"), THREE, ""),
    },
    Limit {
        what: "color attachments of a scene",
        largest: 8,
        code: "E0905",
        make: |n| scene(&format!("{SMALL}\nattachments = {n}"), THREE, ""),
    },
    Limit {
        what: "vertices of a draw",
        largest: 1 << 22,
        code: "E0905",
        make: |n| scene(SMALL, &format!("vertex_count = {n}"), ""),
    },
    Limit {
        what: "instances of a draw",
        largest: 1 << 22,
        code: "E0905",
        make: |n| scene(SMALL, &format!("{THREE}\ninstances = {n}"), ""),
    },
    Limit {
        what: "copies of a mesh of a glTF file (`EXT_mesh_gpu_instancing`)",
        largest: 65_536,
        code: "E0911",
        make: |n| model(&[3], &[(0, n)]),
    },
    Limit {
        what: "vertices of a glTF file with all copies",
        largest: 12_582_912,
        code: "E0911",
        // Two copies of one mesh, one of a mesh that has the rest, and a triangle to be seen.
        make: |n| model(&[3, 1 << 22, n - 3 - (2 << 22)], &[(0, 1), (1, 2), (2, 1)]),
    },
    Limit {
        what: "lights of a glTF file",
        largest: 64,
        code: "E0911",
        make: |n| {
            let nodes = vec!["{\"extensions\": {\"KHR_lights_punctual\": {\"light\": 0}}}"; n].join(", ");
            let indices: Vec<String> = (0..n).map(|at| at.to_string()).collect();
            Model(format!(
                "{{\"asset\": {{\"version\": \"2.0\"}}, \"scene\": 0, \"scenes\": [{{\"nodes\": [{}]}}], \"nodes\": [{nodes}], \
                 \"extensionsUsed\": [\"KHR_lights_punctual\"], \
                 \"extensions\": {{\"KHR_lights_punctual\": {{\"lights\": [{{\"type\": \"point\"}}]}}}}}}",
                indices.join(", ")
            ))
        },
    },
];

/// A glTF file of meshes with this many vertices and one triangle, and nodes that have copies of them. Accessors without
/// data are zero: only the triangle of a mesh of three vertices has an area.
fn model(meshes: &[usize], nodes: &[(usize, usize)]) -> Input {
    let list = |items: Vec<String>| items.join(", ");
    let accessor = |kind: u32, shape: &str, count: usize| {
        format!("{{\"componentType\": {kind}, \"type\": \"{shape}\", \"count\": {count}}}")
    };
    // The numbers 0, 1, 2, and the corners of a triangle.
    let data = "AAAAAAEAAAACAAAAAAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let seen = |view: u32, text: String| text.replacen('{', &format!("{{\"bufferView\": {view}, "), 1);
    let mut accessors = vec![seen(0, accessor(5125, "SCALAR", 3))];
    accessors.extend(meshes.iter().map(|count| match count {
        3 => seen(1, accessor(5126, "VEC3", 3)),
        _ => accessor(5126, "VEC3", *count),
    }));
    accessors.extend(nodes.iter().map(|(_, copies)| accessor(5126, "VEC3", *copies)));
    let mesh =
        |at: usize| format!("{{\"primitives\": [{{\"attributes\": {{\"POSITION\": {}}}, \"indices\": 0}}]}}", at + 1);
    let node = |(at, (mesh, _)): (usize, &(usize, usize))| {
        let places = 1 + meshes.len() + at;
        format!(
            "{{\"mesh\": {mesh}, \"extensions\": {{\"EXT_mesh_gpu_instancing\": {{\"attributes\": {{\"TRANSLATION\": {places}}}}}}}}}"
        )
    };
    Model(format!(
        "{{\"asset\": {{\"version\": \"2.0\"}}, \"scene\": 0, \"scenes\": [{{\"nodes\": [{}]}}], \"nodes\": [{}], \"meshes\": [{}], \
         \"accessors\": [{}], \"bufferViews\": [{{\"buffer\": 0, \"byteLength\": 12}}, {{\"buffer\": 0, \"byteOffset\": 12, \"byteLength\": 36}}], \
         \"buffers\": [{{\"byteLength\": 48, \"uri\": \"data:application/octet-stream;base64,{data}\"}}], \
         \"extensionsUsed\": [\"EXT_mesh_gpu_instancing\"]}}",
        list((0..nodes.len()).map(|at| at.to_string()).collect()),
        list(nodes.iter().enumerate().map(node).collect()),
        list((0..meshes.len()).map(mesh).collect()),
        list(accessors),
    ))
}

/// Includes file *n* - 1 from file *n*, down to 1, which is a comment.
struct Chain;

impl IncludeResolver for Chain {
    fn resolve(&self, path: &str, _: IncludeForm, _: &str) -> Result<Included, String> {
        let number: usize = path.parse().map_err(|_| format!("no file `{path}`"))?;
        let text = if number > 1 { format!("#include \"{}\"\n", number - 1) } else { "// the last one\n".to_owned() };
        Ok(Included { name: path.to_owned(), text: text.into() })
    }
}

/// The codes of the errors of an input.
fn errors(input: Input) -> Vec<&'static str> {
    let diagnostics = match input {
        Input::Shader(text) => {
            let source = Source { name: "a.frag".into(), text: text.into(), stage: Stage::Fragment };
            compiler().with_includes(Chain).compile(&[source]).diagnostics
        }
        Scene(text) => {
            let vertex = "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n";
            let fragment = "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n";
            let files = MemoryFiles::new([("a.toml", text.as_str()), ("a.vert", vertex), ("a.frag", fragment)]);
            load("a.toml", &files, &compiler()).diagnostics
        }
        Model(text) => {
            let scene =
                "[framebuffer]\nwidth = 8\nheight = 8\n[camera]\neye = [0, 0, 4]\n[[scene]]\ngltf = \"a.gltf\"\n";
            let files = MemoryFiles::new([("a.toml", scene), ("a.gltf", text.as_str())]);
            load("a.toml", &files, &compiler().with_includes(glisten::library::Embedded)).diagnostics
        }
    };
    diagnostics.iter().filter(|one| one.is_error()).map(|one| one.code.id).collect()
}

#[test]
fn limits_are_where_the_table_says() {
    let mut wrong = String::new();
    for Limit { what, largest, code, make } in LIMITS {
        let largest = usize::try_from(*largest).expect("a size");
        for count in [largest - 1, largest] {
            let found = errors(make(count));
            if !found.is_empty() {
                let _ = writeln!(wrong, "{count} {what}: {found:?}");
            }
        }
        let found = errors(make(largest + 1));
        if !found.contains(code) || found.len() > 2 {
            let _ = writeln!(wrong, "{} {what}: {found:?} instead of {code}", largest + 1);
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// A number as people write it: `65,536`.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let with_comma = |(at, digit): (usize, char)| {
        let comma = at > 0 && (digits.len() - at).is_multiple_of(3);
        if comma { format!(",{digit}") } else { digit.to_string() }
    };
    digits.chars().enumerate().map(with_comma).collect()
}

#[test]
fn the_page_has_the_table() {
    let page = std::fs::read_to_string(root().join("docs/limits.md")).expect("the page is there");
    let row = |limit: &Limit| format!("| {} | {} | {} |", limit.what, grouped(limit.largest), limit.code);
    let missing: Vec<String> = LIMITS.iter().map(row).filter(|row| !page.contains(row)).collect();
    assert!(missing.is_empty(), "docs/limits.md lacks\n{}", missing.join("\n"));
}

/// `--sandbox`: a scene of a stranger names files outside of its folder, by its path, by a link, by an include, and a device.
#[test]
#[cfg(unix)]
fn a_scene_reads_nothing_outside_of_the_sandbox() {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = folder.path().join("inside");
    std::fs::create_dir(&inside).expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    write("secret.frag", "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n");
    write("inside/a.vert", "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n");
    write("inside/own.frag", "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n");
    write("secret.glsl", "out vec4 c;\nvoid main() { c = vec4(1.0); }\n");
    write("inside/include.frag", "#version 150\n#include \"../secret.glsl\"\n");
    std::os::unix::fs::symlink("../secret.frag", inside.join("link.frag")).expect("a link");
    let secret = folder.path().join("secret.frag");
    let run = |fragment: &str, sandbox: bool| {
        let scene = format!(
            "[framebuffer]\n{SMALL}\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"{fragment}\"\nprimitive = \"triangles\"\n{THREE}\n"
        );
        write("inside/s.toml", &scene);
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_glisten"));
        command.current_dir(folder.path()).args(["render", "inside/s.toml", "--backend", "cpu", "-o", "out.png"]);
        if sandbox {
            command.args(["--sandbox", "inside"]);
        }
        let output = command.output().expect("the program runs");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    assert_eq!(run("own.frag", true).0, Some(0), "{:?}", run("own.frag", true));
    for fragment in ["../secret.frag", &secret.to_string_lossy(), "link.frag", "include.frag", "/dev/zero"] {
        let (code, errors) = run(fragment, true);
        assert!(code != Some(0) && errors.contains("outside of the sandbox"), "{fragment}: {code:?} {errors}");
        if fragment != "/dev/zero" {
            assert_eq!(run(fragment, false).0, Some(0), "{fragment} is read without a sandbox");
        }
    }
    // Modules of other translators, and files of arguments.
    write("secret.wgsl", "@fragment fn main() {}\n");
    write(
        "inside/s.toml",
        &format!("[framebuffer]\n{SMALL}\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"own.frag\"\n{THREE}\n"),
    );
    std::os::unix::fs::symlink("/dev/zero", inside.join("zero.wgsl")).expect("a link");
    for module in ["fragment=secret.wgsl", "fragment=inside/zero.wgsl"] {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_glisten"));
        command.current_dir(folder.path()).args(["--sandbox", "inside", "verify", "inside/s.toml", "--with", module]);
        let output = command.output().expect("the program runs");
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        let is_refused = output.status.code() == Some(2) && errors.contains("outside of the sandbox");
        assert!(is_refused, "{module}: {errors}");
    }
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_glisten"));
    let output = command.args(["lint", "@/dev/zero"]).output().expect("the program runs");
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    let (code, errors) = run("/dev/zero", false);
    assert!(code == Some(2) && errors.contains("a pipe or a device, not a file"), "{code:?} {errors}");
}

/// A pipe that nobody writes to ends no command: neither in a folder, nor as what a scene or a source names.
#[test]
#[cfg(target_os = "linux")]
fn a_pipe_is_not_waited_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    std::fs::create_dir(folder.path().join("pipes")).expect("made");
    for name in ["pipes/a.frag", "b.glsl"] {
        let made = std::process::Command::new("mkfifo").arg(folder.path().join(name)).status();
        assert!(made.is_ok_and(|status| status.success()), "mkfifo makes a pipe");
    }
    file("s.toml", "[[draw]]\nvertex = \"a.vert\"\nfragment = \"b.glsl\"\nvertex_count = 3\n");
    file("a.vert", "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n");
    file("i.frag", "#version 150\n#include \"b.glsl\"\nvoid main() {}\n");
    for (arguments, message) in [
        (&["lint", "pipes"][..], "no shader was found"),
        (&["fmt", "pipes"], "0 of 0 files"),
        (&["test", "--backend", "cpu", "pipes"], "there is no .shader_test file"),
        (&["lint", "--no-cache", "i.frag"], "a pipe or a device"),
        (&["render", "--backend", "cpu", "-o", "o.png", "s.toml"], "a pipe or a device"),
    ] {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_glisten"));
        let child = command
            .args(arguments)
            .current_dir(folder.path())
            .stderr(std::process::Stdio::piped())
            .stdout(std::process::Stdio::piped());
        let mut child = child.spawn().expect("it starts");
        let start = std::time::Instant::now();
        while child.try_wait().expect("a child").is_none() {
            if start.elapsed().as_secs() > 60 {
                let _ = child.kill();
                panic!("{arguments:?} waits");
            }
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        let output = child.wait_with_output().expect("its output");
        let told = [output.stdout, output.stderr].concat();
        assert!(String::from_utf8_lossy(&told).contains(message), "{arguments:?}: {}", String::from_utf8_lossy(&told));
    }
}

/// `--max-memory`: a large picture ends with a sentence, in this process and in one that draws by a driver; a small one is drawn.
#[test]
#[cfg(target_os = "linux")]
fn memory_ends_where_the_flag_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    write("a.vert", "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n");
    write("a.frag", "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n");
    let render = |side: u32, backend: &str, memory: &str| {
        let size = format!("width = {side}\nheight = {side}");
        let Scene(scene) = scene(&size, THREE, "") else { panic!("it is a scene") };
        write("s.toml", &scene);
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_glisten"));
        command.current_dir(folder.path()).env("GLISTEN_ADAPTER", "software");
        command.args(["render", "s.toml", "--backend", backend, "-o", "out.png", "--max-memory", memory]);
        let output = command.output().expect("the program runs");
        let left: Vec<_> = std::fs::read_dir(folder.path()).expect("it is there").flatten().collect();
        let left = left.iter().filter(|one| one.file_name().to_string_lossy().starts_with(".glisten")).count();
        assert_eq!(left, 0, "no half file is left");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    assert_eq!(render(8, "cpu", "1G").0, Some(0), "{:?}", render(8, "cpu", "1G"));
    assert_eq!(render(8, "gpu", "4G").0, Some(0), "{:?}", render(8, "gpu", "4G"));
    let message = "error: it would take more memory than `--max-memory` allows\n";
    for (side, backend, memory) in [(8192, "cpu", "400M"), (8192, "gpu", "400M"), (8, "cpu", "1M")] {
        let (code, errors) = render(side, backend, memory);
        let others = ["gives no thread", "gives no memory for a stack", "the device is out of memory"];
        let is_told = errors.contains(message) || others.iter().any(|other| errors.contains(other));
        assert!(
            code != Some(0) && is_told && !errors.contains("crashed"),
            "{side} {backend} {memory}: {code:?} {errors}"
        );
    }
    let (code, errors) = render(8, "cpu", "much");
    assert!(code == Some(2) && errors.contains("`much` is no size"), "{code:?} {errors}");
}
