//! The `glisten` program end to end: exit codes, standard output and error, files.

use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const VERTEX: &str = "#version 150 core\nin vec4 pv;\nin vec4 cv;\nuniform mat4 mc;\nout vec4 vc;\nvoid main(void)\n\
    {\n    vc = cv;\n    gl_Position = mc * pv;\n}\n";
const FRAGMENT: &str = "#version 150 core\nin vec4 vc;\nout vec4 fc;\nvoid main(void)\n{\n    fc = vc;\n}\n";

/// A temporary folder with files, in which the program runs.
pub(crate) struct Folder(TempDir);

impl Folder {
    pub(crate) fn new(files: &[(&str, &[u8])]) -> Self {
        let folder = Self(tempfile::tempdir().expect("a temporary folder"));
        for (name, bytes) in files {
            let path = folder.path(name);
            fs::create_dir_all(path.parent().expect("it is in the folder")).expect("a folder");
            fs::write(path, bytes).expect("written");
        }
        folder
    }

    pub(crate) fn triangle() -> Self {
        Self::new(&[("tri.vert", VERTEX.as_bytes()), ("tri.frag", FRAGMENT.as_bytes())])
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
        command.args(arguments).current_dir(self.0.path()).env("NO_COLOR", "1");
        command
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).stdin(Stdio::null()).output().expect("the program runs")
    }

    pub(crate) fn run_with_input(&self, arguments: &[&str], input: &str) -> Output {
        let mut child = self
            .command(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        child.stdin.take().expect("it is piped").write_all(input.as_bytes()).expect("it reads its input");
        child.wait_with_output().expect("it ends")
    }

    /// The findings of `lint --format json` and the exit code.
    pub(crate) fn lint(&self, arguments: &[&str]) -> (Vec<Value>, i32) {
        let output = self.run(&[&["lint", "--format", "json"], arguments].concat());
        let text = out(&output);
        let mut findings: Vec<Value> = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
        let scope = findings.pop().expect("the last object tells what was checked");
        assert!(scope["summary"]["files"].is_u64(), "{scope}");
        (findings, code(&output))
    }

    pub(crate) fn names(&self, folder: &str) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(self.path(folder))
            .map(|entries| {
                entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
            })
            .unwrap_or_default();
        names.sort();
        names
    }
}

pub(crate) fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

pub(crate) fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub(crate) fn code(output: &Output) -> i32 {
    output.status.code().unwrap_or_else(|| panic!("it ended by a signal: {output:?}"))
}

pub(crate) fn codes(findings: &[Value]) -> Vec<&str> {
    findings.iter().filter_map(|finding| finding["code"].as_str()).collect()
}

#[test]
fn wrong_usage_is_2_and_help_is_0() {
    let folder = Folder::new(&[]);
    for arguments in [&["frobnicate"][..], &[], &["compile", "a.vert"], &["lint", "--deny"], &["explain"]] {
        let output = folder.run(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(out(&output).is_empty() && !err(&output).is_empty(), "{arguments:?}");
    }
    for arguments in [
        &["--help"][..],
        &["--version"],
        &["lint", "--help"],
        &["help", "--help"],
        &["help", "-V"],
        &["fixed-function", "-V"],
    ] {
        let output = folder.run(arguments);
        assert_eq!(code(&output), 0, "{arguments:?}");
        assert!(out(&output).contains("glisten"), "{arguments:?}");
    }
}

#[cfg(unix)]
#[test]
fn an_unreadable_file_is_told() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::triangle();
    fs::set_permissions(folder.path("tri.vert"), fs::Permissions::from_mode(0o000)).expect("permissions");
    if fs::read(folder.path("tri.vert")).is_ok() {
        // The superuser can read everything; in that case, use a socket as a file that cannot be read.
        fs::remove_file(folder.path("tri.vert")).expect("removed");
        let _socket = std::os::unix::net::UnixListener::bind(folder.path("tri.vert")).expect("a socket");
        let (findings, exit) = folder.lint(&["tri.vert"]);
        assert_eq!((codes(&findings), exit), (vec!["E0011"], 2));
        return;
    }
    let (findings, exit) = folder.lint(&["tri.vert"]);
    assert_eq!((codes(&findings), exit), (vec!["E0011"], 2));
}

/// A folder that cannot be read does not keep the rest of a tree from being checked, and an exclusion leaves it out.
#[cfg(unix)]
#[test]
fn an_unreadable_folder_is_told_and_the_others_are_searched() {
    use std::os::unix::fs::PermissionsExt;
    let broken = "#version 150\nvoid main() { x; }\n";
    let folder = Folder::new(&[("a/locked/a.frag", FRAGMENT.as_bytes()), ("a/b.frag", broken.as_bytes())]);
    let set = |mode: u32| {
        fs::set_permissions(folder.path("a/locked"), fs::Permissions::from_mode(mode)).expect("permissions");
    };
    set(0o000);
    // The superuser reads everything.
    if fs::read_dir(folder.path("a/locked")).is_err() {
        let (findings, exit) = folder.lint(&["a"]);
        assert_eq!((codes(&findings), exit), (vec!["E0301", "E0011"], 2));
        let formatted = folder.run(&["fmt", "--check", "a"]);
        assert_eq!(code(&formatted), 2);
        assert!(out(&formatted).contains("would reformat a/b.frag"), "{}", out(&formatted));
        let tested = folder.run(&["test", "a", "--backend", "cpu"]);
        assert!(code(&tested) == 2 && err(&tested).contains("cannot read `a/locked`"), "{}", err(&tested));
        fs::write(folder.path("a/glisten.toml"), "[lint]\nexclude = [\"locked/\"]\n").expect("written");
        let (findings, exit) = folder.lint(&["a"]);
        assert_eq!((codes(&findings), exit), (vec!["E0301"], 1));
    }
    set(0o755);
}

/// Depfiles and manifests name files by their bytes.
#[cfg(target_os = "linux")]
#[test]
fn names_that_are_no_text_are_names_of_files() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::new(&[]);
    let name = OsStr::from_bytes(b"a\xff b.frag");
    fs::write(folder.path("").join(name), FRAGMENT).expect("written");
    let arguments = ["compile", "--target", "wgsl", "-o", "out", "--depfile", "d", "--manifest", "m.json"];
    let output = folder.command(&arguments).arg(name).output().expect("it runs");
    assert_eq!(code(&output), 0, "{}", err(&output));
    let rule = fs::read(folder.path("d")).expect("written");
    assert!(rule.ends_with(b": a\xff\\ b.frag\n"), "{}", String::from_utf8_lossy(&rule));
    let manifest: Value = serde_json::from_slice(&fs::read(folder.path("m.json")).expect("written")).expect("JSON");
    assert!(manifest["outputs"][0]["sources"][0]["sha256"].is_string(), "{manifest}");
}

#[test]
fn a_stage_that_no_name_tells_is_asked_for() {
    let folder = Folder::new(&[("a.txt", FRAGMENT.as_bytes())]);
    let output = folder.run(&["lint", "a.txt"]);
    assert_eq!(code(&output), 2);
    assert!(err(&output).contains("--stage"), "{}", err(&output));
    let output = folder.run_with_input(&["lint", "-"], FRAGMENT);
    assert_eq!(code(&output), 2);
}

#[test]
fn explain_shows_pages_and_the_nearest_of_unknown_codes() {
    let folder = Folder::new(&[]);
    let page = folder.run(&["explain", "e0003"]);
    assert_eq!(code(&page), 0);
    assert!(out(&page).starts_with("E0003 nesting-too-deep (error)"), "{}", out(&page));
    assert_eq!(out(&folder.run(&["explain", "nesting-too-deep"])), out(&page));
    let unknown = folder.run(&["explain", "E003"]);
    assert_eq!(code(&unknown), 2);
    assert!(err(&unknown).contains("`E0003`"), "{}", err(&unknown));
    let list = folder.run(&["explain", "--list"]);
    assert_eq!(out(&list).lines().count(), glisten_front::diagnostic::codes::all().count());
    assert!(
        out(&list).lines().all(|line| line.ends_with('.') && line.split_whitespace().count() > 5),
        "{}",
        out(&list)
    );
}

#[test]
fn a_reader_that_goes_away_ends_the_program_in_silence() {
    let folder = Folder::new(&[]);
    let mut child = folder
        .command(&["explain", "--list"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert!(err(&output).is_empty(), "{}", err(&output));
}

/// The exit code has the findings, whoever reads them.
#[test]
fn a_reader_that_goes_away_changes_no_exit_code() {
    let broken = "#version 150\nvoid  main(){ x; }\n";
    let folder = Folder::new(&[("a.frag", broken.as_bytes())]);
    for (arguments, exit) in [
        (&["lint", "-q", "a.frag"][..], 1),
        (&["lint", "--format", "json", "a.frag"], 1),
        (&["lint", "--format", "sarif", "a.frag"], 1),
        (&["fmt", "-q", "--check", "a.frag"], 1),
        (&["rules"], 0),
    ] {
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let mut child = folder.command(arguments).stdout(writer).stderr(Stdio::piped()).spawn().expect("it runs");
        let told = std::io::read_to_string(child.stderr.take().expect("it is piped")).expect("it is read");
        assert_eq!((child.wait().expect("it ends").code(), told.as_str()), (Some(exit), ""), "{arguments:?}");
    }
}

/// Whether a path is a non-empty file.
fn is_written(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|metadata| metadata.is_file() && metadata.len() > 0)
}

#[test]
fn compile_writes_texts_words_and_the_reflection() {
    let folder = Folder::triangle();
    let output = folder.run(&["compile", "tri.vert", "tri.frag", "-o", "out/deep", "--bind-attrib", "cv=3"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert!(out(&output).is_empty() && err(&output).is_empty(), "{output:?}");
    assert_eq!(
        folder.names("out/deep"),
        ["tri.frag.spv", "tri.frag.wgsl", "tri.json", "tri.vert.spv", "tri.vert.wgsl"]
    );
    let words = fs::read(folder.path("out/deep/tri.vert.spv")).expect("written");
    assert_eq!(words.get(..4), Some(&[0x03, 0x02, 0x23, 0x07][..]));
    let reflection: Value =
        serde_json::from_slice(&fs::read(folder.path("out/deep/tri.json")).expect("written")).expect("JSON");
    assert_eq!(reflection["attributes"][1]["name"], "cv");
    assert_eq!(reflection["attributes"][1]["location"], 3);
    assert_eq!(reflection["conventions"]["clip_z"], "zero-to-one");
}

#[test]
fn check_and_failures_write_nothing_and_leave_no_temporary_files() {
    let folder = Folder::triangle();
    assert_eq!(code(&folder.run(&["compile", "tri.vert", "tri.frag", "--check"])), 0);
    fs::write(folder.path("tri.frag"), FRAGMENT.replace("fc = vc", "fc = vd")).expect("written");
    let output = folder.run(&["compile", "tri.vert", "tri.frag", "-o", "out"]);
    assert_eq!(code(&output), 1);
    assert!(err(&output).contains("tri.frag:6:10"), "{}", err(&output));
    assert!(folder.names("out").is_empty());
    assert_eq!(folder.names("."), ["tri.frag", "tri.vert"]);
}

#[test]
fn outputs_replace_files_whole_and_folders_are_refused() {
    let folder = Folder::triangle();
    fs::create_dir_all(folder.path("out/tri.json")).expect("a folder in the way");
    let output = folder.run(&["compile", "tri.vert", "tri.frag", "-o", "out"]);
    assert_eq!(code(&output), 2);
    assert!(err(&output).contains("tri.json"), "{}", err(&output));
    assert!(folder.names("out").iter().all(|name| !name.starts_with(".glisten")), "{:?}", folder.names("out"));
    let output = folder.run(&["compile", "tri.vert", "tri.frag", "-o", "tri.vert"]);
    assert_eq!(code(&output), 2);
    assert!(err(&output).contains("not a folder"), "{}", err(&output));
}

#[test]
fn two_programs_that_write_the_same_file_are_refused_before_any_work() {
    let folder = Folder::new(&[
        ("a/x.vert", VERTEX.as_bytes()),
        ("b/x.vert", VERTEX.as_bytes()),
        ("a/x.frag", FRAGMENT.as_bytes()),
    ]);
    let output = folder.run(&["compile", "a/x.vert", "a/x.frag", "b/x.vert", "-o", "out"]);
    assert_eq!(code(&output), 2);
    assert!(err(&output).contains("x.vert.wgsl"), "{}", err(&output));
    assert!(folder.names("out").is_empty());
}

#[test]
fn files_are_grouped_by_stem_and_by_program() {
    let folder = Folder::triangle();
    fs::write(folder.path("other.frag"), FRAGMENT).expect("written");
    let output = folder.run(&["compile", "tri.vert", "other.frag", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert_eq!(err(&output).matches("W0001").count(), 2, "each is alone: {}", err(&output));
    let output = folder.run(&["compile", "--program", "tri.vert,other.frag", "-o", "paired"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert!(!err(&output).contains("W0001"), "{}", err(&output));
    assert_eq!(
        folder.names("paired"),
        ["other.frag.spv", "other.frag.wgsl", "tri.json", "tri.vert.spv", "tri.vert.wgsl"]
    );
    let denied = folder.run(&["compile", "tri.vert", "-o", "denied", "--deny", "warnings"]);
    assert_eq!(code(&denied), 1);
    assert!(folder.names("denied").is_empty());
    let allowed = folder.run(&["compile", "tri.vert", "-o", "allowed", "--deny", "warnings", "--allow", "lone-stage"]);
    assert_eq!(code(&allowed), 0, "{}", err(&allowed));
}

#[test]
fn a_file_is_one_file_by_any_path() {
    let main = |name: &str| {
        format!(
            "#version 150\n#extension GL_ARB_shading_language_include : require\n#include \"{name}\"\nout vec4 c;\nvoid main() {{ c = vec4(bad()); }}\n"
        )
    };
    let folder = Folder::triangle();
    fs::write(folder.path("bad.glsl"), "float bad() { return zz; }\n").expect("written");
    fs::write(folder.path("a.frag"), main("bad.glsl")).expect("written");
    fs::write(folder.path("b.frag"), main("bad.glsl")).expect("written");
    let absolute = folder.path("b.frag").display().to_string();
    let output = folder.run(&["lint", "a.frag", &absolute]);
    assert_eq!((code(&output), out(&output).matches("E0301").count()), (1, 1), "{}", out(&output));
    let output = folder.run(&["compile", "--check", "--program", "tri.vert,tri.frag,./tri.vert"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
}

#[cfg(unix)]
#[test]
fn an_output_through_a_link_keeps_the_link() {
    let folder = Folder::triangle();
    fs::create_dir(folder.path("out")).expect("a folder");
    std::os::unix::fs::symlink("elsewhere.json", folder.path("out/tri.json")).expect("linked");
    for _ in 0..2 {
        assert_eq!(code(&folder.run(&["compile", "tri.vert", "tri.frag", "-o", "out"])), 0);
        assert!(folder.path("out/tri.json").is_symlink() && folder.path("out/elsewhere.json").is_file());
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let folder = Folder::new(&[]);
    let names: Vec<String> = (0..12).map(|index| format!("p{index}")).collect();
    for name in &names {
        fs::write(folder.path(&format!("{name}.vert")), VERTEX.replace("vc", &format!("v{name}"))).expect("written");
        fs::write(folder.path(&format!("{name}.frag")), FRAGMENT.replace("vc", &format!("v{name}"))).expect("written");
    }
    fs::write(folder.path("p5.frag"), FRAGMENT.replace("vc;", "vc")).expect("written");
    let files: Vec<String> = names.iter().flat_map(|name| [format!("{name}.frag"), format!("{name}.vert")]).collect();
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let run = |jobs: &str, out: &str| {
        let output = folder.run(&[&["compile", "-j", jobs, "-o", out], &files[..]].concat());
        assert_eq!(code(&output), 1);
        let read = |name: String| (fs::read(folder.path(&format!("{out}/{name}"))).expect("written"), name);
        (err(&output), folder.names(out).into_iter().map(read).collect::<Vec<_>>())
    };
    let one = run("1", "one");
    assert_eq!(one.1.len(), 11 * 5);
    assert!(one == run("4", "four"), "the bytes differ");
}

#[test]
fn a_depfile_names_outputs_inputs_and_includes() {
    let folder = Folder::triangle();
    let with_include = VERTEX
        .replace("core\n", "core\n#extension GL_ARB_shading_language_include : require\n#include \"lib/a b.glsl\"\n");
    fs::create_dir_all(folder.path("lib")).expect("a folder");
    fs::write(folder.path("lib/a b.glsl"), "// nothing\n").expect("written");
    fs::write(folder.path("tri.vert"), with_include).expect("written");
    let arguments = ["compile", "tri.vert", "tri.frag", "-o", "out", "--target", "wgsl", "--depfile", "out.d"];
    let output = folder.run(&arguments);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let rule = fs::read_to_string(folder.path("out.d")).expect("written");
    assert_eq!(rule, "out/tri.vert.wgsl out/tri.frag.wgsl out/tri.json: tri.vert lib/a\\ b.glsl tri.frag\n");
    assert!(is_written(&folder.path("out/tri.vert.wgsl")));
}

#[test]
fn standard_input_is_a_shader() {
    let folder = Folder::new(&[]);
    let output = folder.run_with_input(&["lint", "-", "--stage", "fragment"], FRAGMENT);
    assert_eq!((code(&output), out(&output)), (0, String::new()), "{}", err(&output));
    let output =
        folder.run_with_input(&["compile", "-", "--stage", "fragment", "--target", "wgsl", "-o", "out"], FRAGMENT);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert_eq!(folder.names("out"), ["stdin.frag.wgsl", "stdin.json"]);
}

#[test]
fn lint_tells_all_errors_of_all_stages_with_their_places() {
    let folder = Folder::triangle();
    fs::write(folder.path("tri.vert"), VERTEX.replace("vc = cv;", "vc = cw; float f = true;")).expect("written");
    fs::write(folder.path("tri.frag"), FRAGMENT.replace("fc = vc", "fc = vd")).expect("written");
    let (findings, exit) = folder.lint(&["."]);
    assert_eq!(exit, 1);
    let places: Vec<(String, u64, u64)> = findings
        .iter()
        .map(|finding| {
            let number = |key: &str| finding[key].as_u64().unwrap_or(0);
            (finding["file"].as_str().unwrap_or("").replace("./", ""), number("line"), number("column"))
        })
        .collect();
    let wanted = [("tri.vert", 8, 10), ("tri.vert", 8, 24), ("tri.frag", 6, 10)];
    assert_eq!(places, wanted.map(|(file, line, column)| (file.to_owned(), line, column)));
    for finding in &findings {
        for key in ["end_line", "end_column", "severity", "code", "message", "help", "labels", "section"] {
            assert!(finding.get(key).is_some(), "{key} is missing in {finding}");
        }
    }
}

#[test]
fn every_format_of_diagnostics_is_written() {
    let folder = Folder::triangle();
    fs::write(folder.path("tri.frag"), FRAGMENT.replace("fc = vc", "fc = vd")).expect("written");
    for (format, word) in [
        ("human", "tri.frag:6:10"),
        ("sarif", "2.1.0"),
        ("github", "::error file=tri.frag,line=6"),
        ("gitlab", "\"check_name\": \"E03"),
        ("junit", "<failure type=\"error\""),
    ] {
        let output = folder.run(&["lint", "tri.vert", "tri.frag", "--format", format]);
        assert_eq!(code(&output), 1);
        assert!(out(&output).contains(word), "{format}: {}", out(&output));
        let output = folder.run(&["compile", "tri.vert", "tri.frag", "--check", "--diagnostics", format]);
        assert!(err(&output).contains(word), "{format}: {}", err(&output));
    }
}

/// A scene that contains the triangle.
const SCENE: &str = "[framebuffer]\nwidth = 16\nheight = 8\n\n[[draw]]\nvertex = \"tri.vert\"\nfragment = \"tri.frag\"\n\
    primitive = \"triangles\"\n[draw.attributes]\npv = { size = 2, values = [-1, -1, 3, -1, -1, 3] }\n\
    cv = { size = 4, values = [0.5, 0.25, 2.0, 1, 0.5, 0.25, 2.0, 1, 0.5, 0.25, 2.0, 1] }\n[draw.uniforms]\n\
    mc = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n";

#[test]
fn render_writes_float_pictures_by_the_reference() {
    let folder = Folder::triangle();
    fs::write(folder.path("s.toml"), SCENE).expect("written");
    for precision in ["f64", "f32"] {
        let arguments = ["render", "s.toml", "--backend", "cpu", "--precision", precision, "-o", "s.npy"];
        let output = folder.run(&arguments);
        assert_eq!(code(&output), 0, "{}", err(&output));
        let bytes = fs::read(folder.path("s.npy")).expect("written");
        let npy = npyz::NpyFile::new(&bytes[..]).expect("an npy file");
        assert_eq!(npy.shape(), [8, 16, 4]);
        let values: Vec<f32> = npy.into_vec().expect("float32");
        assert!(values.chunks(4).all(|pixel| pixel == [0.5, 0.25, 2.0, 1.0]), "{:?}", values.get(..4));
    }
}

/// An option that would change nothing is refused before anything is read, or said to be idle.
#[test]
fn options_without_an_effect_are_refused() {
    let folder = Folder::triangle();
    fs::write(folder.path("s.toml"), SCENE).expect("written");
    for arguments in [
        &["stability", "s.toml", "--cases", "64"][..],
        &["verify", "s.toml", "--tolerance", "0.1", "--profile", "wgsl"],
        &["verify", "s.toml", "--no-likely", "--likely-margin", "9"],
    ] {
        let output = folder.run(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}: {}", err(&output));
        assert!(err(&output).contains("cannot be used with"), "{arguments:?}: {}", err(&output));
    }
    // One line of a script may draw by every backend.
    for (arguments, idle) in [
        (&["render", "s.toml", "-o", "s.npy", "--precision", "f32"][..], "`--precision` has no effect"),
        (&["render", "s.toml", "-o", "s.npy", "--backend", "cpu", "--via", "wgsl"], "`--via` has no effect"),
    ] {
        let output = folder.run(arguments);
        assert_eq!(code(&output), 0, "{arguments:?}: {}", err(&output));
        assert!(err(&output).contains(idle), "{arguments:?}: {}", err(&output));
    }
}

/// A file that is not there does not hide what is found in the others.
#[test]
fn a_missing_file_does_not_hide_the_others() {
    let folder = Folder::triangle();
    fs::write(folder.path("wide.frag"), "#version 150\nout vec4 c;void main(){c=vec4(1);}\n").expect("written");
    let output = folder.run(&["fmt", "--check", "wide.frag", "none.frag"]);
    assert_eq!(code(&output), 2);
    assert!(out(&output).contains("wide.frag") && err(&output).contains("none.frag"), "{}", err(&output));
    fs::write(
        folder.path("a.shader_test"),
        "[vertex shader passthrough]\n[fragment shader]\n#version 150\nout vec4 c;\n\
        void main() { c = vec4(1); }\n[test]\ndraw rect -1 -1 2 2\nprobe all rgba 0 1 1 1\n",
    )
    .expect("written");
    let output = folder.run(&["test", "none.shader_test", "a.shader_test", "--backend", "cpu"]);
    assert_eq!(code(&output), 2, "{}", err(&output));
    assert!(out(&output).contains("fail") && err(&output).contains("none.shader_test"), "{}", out(&output));
}

/// Slips that the names of hosts invite.
#[test]
fn unknown_uniforms_have_the_nearest_name() {
    let folder = Folder::triangle();
    let fragment = "#version 150\nstruct S { float a; };\nuniform S s[2];\nuniform D { float dd; } dinst;\nuniform C { float cc; };\n\
        uniform ivec3 iv;\nuniform sampler2D t;\nin vec4 vc;\nout vec4 c;\n\
        void main() { c = vec4(s[0].a + s[1].a, dinst.dd, cc, iv.x) + texture(t, vec2(0.5)); }\n";
    fs::write(folder.path("n.frag"), fragment).expect("written");
    let scene = SCENE.replace("tri.frag", "n.frag");
    for (line, part) in [
        ("\"dinst.dd\" = 1.0", "did you mean `D.dd`?"),
        ("\"C.cc\" = 1.0", "did you mean `cc`?"),
        ("dd = 1.0", "did you mean `D.dd`?"),
        ("\"s.a\" = 1.0", "did you mean `s[0].a`?"),
        ("s = 1.0", "did you mean `s[0].a`?"),
        ("iv = [1.0, 2.0, 3.0]", "`iv`, an ivec3, takes integers of 32 bits"),
        ("iv = [2147483648, 2, 3]", "`iv`, an ivec3, takes integers of 32 bits"),
        ("[draw.textures]\nt = { width = 0, height = 1, values = [] }", "`width` must be 1 to 8192"),
        (
            "[draw.textures]\nt = { width = 1, height = 1, values = [1, 1, 1, 1], compare = \"less\" }",
            "no shadow sampler",
        ),
    ] {
        fs::write(folder.path("s.toml"), format!("{scene}{line}\n")).expect("written");
        let output = folder.run(&["render", "s.toml", "--backend", "cpu", "-o", "s.npy"]);
        assert_eq!(code(&output), 1, "{line}: {}", err(&output));
        assert!(err(&output).contains(part) && !err(&output).contains("has no `width`"), "{line}: {}", err(&output));
    }
    for (rows, part) in [
        ("indices = [0, -1, 2]\n[draw.attributes]", "index -1 is negative"),
        ("[draw.attributes]", "`divisor` must be 0 to 4294967295"),
    ] {
        let text = SCENE.replace("[draw.attributes]", rows);
        let text = if rows.starts_with('[') {
            text.replace("cv = { size = 4,", "cv = { size = 4, divisor = -1,")
        } else {
            text
        };
        fs::write(folder.path("s.toml"), text).expect("written");
        let output = folder.run(&["render", "s.toml", "--backend", "cpu", "-o", "s.npy"]);
        assert!(code(&output) == 1 && err(&output).contains(part), "{}", err(&output));
        assert_eq!(err(&output).matches("error[").count(), 1, "{}", err(&output));
    }
}

#[test]
fn mistakes_of_a_scene_are_told_at_their_places() {
    let folder = Folder::triangle();
    for (text, line, exit, word) in [
        (SCENE.replace("cv =", "cw ="), 11, 1, "cv"),
        (SCENE.replace("width =", "widht ="), 2, 1, "width"),
        (SCENE.replace("tri.frag", "try.frag"), 7, 2, "try.frag"),
        ("\0\u{1}".to_owned(), 1, 1, ""),
        (String::new(), 1, 1, ""),
    ] {
        fs::write(folder.path("s.toml"), &text).expect("written");
        let arguments = ["render", "s.toml", "--backend", "cpu", "-o", "s.png", "--diagnostics", "json"];
        let output = folder.run(&arguments);
        assert_eq!(code(&output), exit, "{text}\n{}", err(&output));
        let findings: Vec<Value> = serde_json::from_str(&err(&output)).expect("JSON");
        let there = |finding: &&Value| finding["file"] == "s.toml" && finding["line"] == line;
        let found = findings.iter().filter(there).any(|finding| finding.to_string().contains(word));
        assert!(found, "{line}: {findings:#?}");
        assert!(folder.names(".").iter().all(|name| name != "s.png"));
    }
    let output = folder.run(&["render", "none.toml", "--backend", "cpu", "-o", "s.png"]);
    assert_eq!(code(&output), 2, "{}", err(&output));
    let output = folder.run(&["render", "s.toml", "--backend", "cpu", "-o", "s.jpeg"]);
    assert_eq!(code(&output), 2);
    assert!(err(&output).contains(".npy"), "{}", err(&output));
}

#[test]
fn verify_prints_the_figures_of_the_contract() {
    let folder = Folder::triangle();
    fs::write(folder.path("s.toml"), SCENE.replace("0.5, 0.25, 2.0, 1, 0.5", "0.5, 0.25, 2.0, 1, 0.7"))
        .expect("written");
    let output = folder.run(&["verify", "s.toml", "--format", "json"]);
    assert_eq!(code(&output), 0, "{}{}", out(&output), err(&output));
    assert!(err(&output).is_empty(), "{}", err(&output));
    let figures: Value = serde_json::from_str(&out(&output)).expect("JSON");
    for key in [
        "max_abs",
        "rmse",
        "psnr",
        "max_ulp",
        "flip",
        "pixels",
        "covered",
        "coverage_mismatch",
        "edge_pixels",
        "non_finite_gpu",
        "non_finite_cpu",
        "judged_by",
        "outside",
        "undecided",
        "known_faults",
        "evidence",
        "widths",
        "range",
        "width",
        "evidence_share",
        "suspect",
        "outside_likely",
        "as_device",
        "undefined",
        "verdict",
        "worst",
        "gpu_ms",
        "cpu_ms",
    ] {
        assert!(figures.get(key).is_some(), "{key} is missing in {figures}");
    }
    assert_eq!((figures["pixels"].as_u64(), figures["covered"].as_u64()), (Some(128), Some(128)));
    assert_eq!((figures["judged_by"].as_str(), figures["outside"].as_u64()), (Some("envelope"), Some(0)));
    assert_eq!(figures["runs"].as_array().map(Vec::len), Some(2), "by SPIR-V and by WGSL");
    let strict = folder.run(&["verify", "s.toml", "--tolerance", "0", "--via", "spirv"]);
    assert_eq!(code(&strict), 1, "{}", out(&strict));
    assert!(out(&strict).contains("DOES NOT HOLD") && out(&strict).contains("tolerance"), "{}", out(&strict));
}

#[test]
fn verify_names_the_expressions_that_a_bound_comes_from() {
    let folder = Folder::triangle();
    fs::write(folder.path("tri.frag"), FRAGMENT.replace("fc = vc", "fc = pow(vc, vec4(99.0))")).expect("written");
    fs::write(folder.path("s.toml"), SCENE.replace("0.5, 0.25, 2.0, 1", "0.5, 0.25, 0.9, 1")).expect("written");
    let output = folder.run(&["verify", "s.toml", "--via", "spirv", "--format", "json", "--difference", "d.png"]);
    assert_eq!(code(&output), 0, "{}{}", out(&output), err(&output));
    let figures: Value = serde_json::from_str(&out(&output)).expect("JSON");
    let contributions = figures["worst"]["contributions"].as_array().expect("a list");
    let power = contributions.iter().find(|one| one["operation"] == "pow").expect("it contributes");
    for key in ["file", "line", "column", "end_column", "operation", "share"] {
        assert!(power.get(key).is_some(), "{key} is missing in {power}");
    }
    assert!(power["file"].as_str().is_some_and(|file| file.ends_with("tri.frag")), "{power}");
    assert!(fs::read(folder.path("d.png")).expect("written").starts_with(b"\x89PNG"));
    let told = out(&folder.run(&["verify", "s.toml", "--via", "spirv", "--width", "0"]));
    assert!(told.contains("note[W0905]") && told.contains("`pow`: ") && told.contains("vec4(99.0)"), "{told}");
}

#[test]
fn without_a_vulkan_driver_the_message_says_what_to_install() {
    let folder = Folder::triangle();
    fs::write(folder.path("s.toml"), SCENE).expect("written");
    for arguments in [&["render", "s.toml", "-o", "s.png"][..], &["verify", "s.toml"], &["report", "s.toml", "-o", "r"]]
    {
        let output = folder
            .command(arguments)
            .env("VK_DRIVER_FILES", "/nonexistent.json")
            .env("VK_ICD_FILENAMES", "/nonexistent.json")
            .output()
            .expect("the program runs");
        assert_eq!(code(&output), 3, "{arguments:?}: {}", err(&output));
        assert!(err(&output).contains("mesa-vulkan-drivers"), "{}", err(&output));
    }
    let output = folder.run(&["render", "s.toml", "-o", "s.png", "--adapter", "no such adapter"]);
    assert_eq!(code(&output), 3, "{}", err(&output));
}

#[test]
fn color_and_quiet_do_as_they_say() {
    let folder = Folder::triangle();
    fs::write(folder.path("tri.frag"), FRAGMENT.replace("fc = vc", "fc = vd")).expect("written");
    let colored = folder.run(&["lint", "tri.vert", "tri.frag", "--color", "always"]);
    assert!(out(&colored).contains('\u{1b}'), "{}", out(&colored));
    let plain = folder.run(&["lint", "tri.vert", "tri.frag"]);
    assert!(!out(&plain).contains('\u{1b}') && err(&plain).contains("1 error"), "{}", err(&plain));
    let quiet = folder.run(&["lint", "-q", "tri.vert", "tri.frag"]);
    assert_eq!((out(&quiet), err(&quiet)), (out(&plain), String::new()));
    // Help and messages about arguments, too, wherever the flag is.
    for arguments in
        [&["--color", "always", "--help"][..], &["lint", "--bad", "--color=always"], &["nope", "--color=always"]]
    {
        let colored = folder.run(arguments);
        assert!(out(&colored).contains('\u{1b}') || err(&colored).contains('\u{1b}'), "{arguments:?}");
    }
    let plain = folder.run(&["--color", "never", "nope"]);
    assert!(code(&plain) == 2 && !err(&plain).contains('\u{1b}'), "{}", err(&plain));
}

#[test]
fn several_files_of_a_stage_give_one_output() {
    let helper = "#version 150 core\nvec4 twice(vec4 v) { return 2.0 * v; }\n";
    let main =
        FRAGMENT.replace("out vec4 fc;", "out vec4 fc;\nvec4 twice(vec4 v);").replace("fc = vc", "fc = twice(vc)");
    let folder = Folder::new(&[
        ("tri.vert", VERTEX.as_bytes()),
        ("main.frag", main.as_bytes()),
        ("helper.frag", helper.as_bytes()),
    ]);
    let program = "tri.vert,main.frag,helper.frag";
    let output = folder.run(&["compile", "--program", program, "-o", "out", "--target", "wgsl"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert_eq!(folder.names("out"), ["main.frag.wgsl", "tri.json", "tri.vert.wgsl"]);
    let text = fs::read_to_string(folder.path("out/main.frag.wgsl")).expect("written");
    assert!(text.contains("fn twice"), "{text}");
}

#[test]
fn library_modules_can_be_included() {
    let text = "#version 150\n#extension GL_ARB_shading_language_include : require\n#include <glisten/phong.glsl>\n\
        out vec4 fc;\nvoid main() { fc = vec4(phongFactor(vec3(0, 0, 1), vec3(0, 0, 1), vec3(0, 0, 1), 8.0)); }\n";
    let folder = Folder::new(&[("a.frag", text.as_bytes())]);
    let arguments = ["compile", "a.frag", "-o", "out", "--target", "wgsl", "--allow", "W0001", "--depfile", "a.d"];
    let output = folder.run(&arguments);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let rule = fs::read_to_string(folder.path("a.d")).expect("written");
    assert_eq!(rule, "out/a.frag.wgsl out/a.json: a.frag\n", "embedded modules are no files");
}

#[test]
fn the_typed_program_is_printed_and_compiles_again() {
    let folder = Folder::triangle();
    let output = folder.run(&["compile", "tri.frag", "--emit", "hir"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let again = folder.run_with_input(&["lint", "-", "--stage", "fragment"], &out(&output));
    assert_eq!(code(&again), 0, "{}", out(&again));
}

/// A program in which an attribute, a varying, a function and a uniform reach no output.
fn with_dead_parts() -> Folder {
    let vertex = "#version 150\nin vec4 pv;\nin vec4 dead;\nout vec4 vc;\nout vec4 unread;\nuniform vec4 u;\n\
                  void main() { vc = pv; unread = dead * u; gl_Position = pv; }\n";
    let fragment = "#version 150\nin vec4 vc;\nin vec4 unread;\nout vec4 fc;\nvec4 never() { return vc; }\n\
                    void main() { vec4 nothing = unread; fc = vc; }\n";
    Folder::new(&[("a.vert", vertex.as_bytes()), ("a.frag", fragment.as_bytes())])
}

#[test]
fn compile_leaves_out_what_reaches_no_output() {
    let place = with_dead_parts();
    let text = |name: &str| fs::read_to_string(place.path(name)).expect("it was written");
    // Arguments, and whether the WGSL is without the dead parts.
    for (arguments, left_out) in [
        (&[][..], true),
        (&["-O"], true),
        (&["-O1"], true),
        (&["-O0"], false),
        (&["--no-optimize"], false),
        (&["-g"], false),
        (&["-g", "-O"], true),
        (&["-g", "-O0"], false),
    ] {
        let output = place.run(&[&["compile", "a.vert", "a.frag", "-o", "out"], arguments].concat());
        assert_eq!((code(&output), err(&output).as_str()), (0, ""), "{arguments:?}");
        let emitted = text("out/a.vert.wgsl") + &text("out/a.frag.wgsl");
        assert_eq!(!emitted.contains("dead"), left_out, "{arguments:?}\n{emitted}");
        assert_eq!(!emitted.contains("unread"), left_out, "{arguments:?}\n{emitted}");
        let reflection: Value = serde_json::from_str(&text("out/a.json")).expect("JSON");
        // What is left out stays in the reflection, with its location, and is not active.
        assert_eq!(reflection["attributes"][1]["name"], "dead");
        assert_eq!(reflection["attributes"][1]["active"], !left_out, "{arguments:?}");
        assert_eq!(reflection["uniforms"][0]["active"], !left_out, "{arguments:?}");
        let names: Vec<&Value> = reflection["varyings"].as_array().expect("a list").iter().collect();
        assert_eq!(names.len(), 2, "{reflection}");
    }
    // A host of HLSL declares each input: nothing is left out unless that is asked for.
    for (target, optimize, left_out) in
        [("hlsl", "", false), ("hlsl", "-O", true), ("msl", "", false), ("glsl", "", false)]
    {
        let mut arguments = vec!["compile", "a.vert", "a.frag", "-o", "other", "--target", target];
        arguments.extend((!optimize.is_empty()).then_some(optimize));
        assert_eq!(code(&place.run(&arguments)), 0, "{arguments:?}");
        let name = if target == "msl" { "other/a.vert.metal".to_owned() } else { format!("other/a.vert.{target}") };
        assert_eq!(!text(&name).contains("unread"), left_out, "{arguments:?}\n{}", text(&name));
    }
    // One of the outputs has it: so it is active.
    assert_eq!(
        code(&place.run(&["compile", "a.vert", "a.frag", "-o", "both", "--target", "wgsl", "--target", "hlsl"])),
        0
    );
    let reflection: Value = serde_json::from_str(&text("both/a.json")).expect("JSON");
    assert_eq!(reflection["attributes"][1]["active"], true);
    assert_eq!(code(&place.run(&["compile", "a.vert", "a.frag", "-o", "out", "--optimize", "--no-optimize"])), 2);
}

#[test]
fn compile_says_what_it_left_out() {
    let place = with_dead_parts();
    let output = place.run(&["compile", "a.vert", "a.frag", "-o", "out", "--left-out"]);
    assert_eq!(code(&output), 0);
    for word in ["attribute `dead`", "varying `unread`", "function `never`", "uniform `u`", "vec4 nothing = unread"] {
        assert!(err(&output).contains(word), "{word}:\n{}", err(&output));
    }
    let output = place.run(&["compile", "a.vert", "a.frag", "-o", "out", "--left-out", "--diagnostics", "json"]);
    let findings: Vec<Value> = serde_json::from_str(&err(&output)).expect("JSON");
    assert!(findings.iter().all(|one| one["code"] == "W0803" && one["severity"] == "note"), "{findings:?}");
    let dead = findings.iter().find(|one| one["message"].as_str().is_some_and(|text| text.contains("`dead`")));
    assert_eq!(dead.map(|one| (&one["file"], &one["line"])), Some((&Value::from("a.vert"), &Value::from(3))));
    // Without optimization, and without the question, nothing is said.
    for arguments in [&["--left-out", "-O0"][..], &[]] {
        let output = place.run(&[&["compile", "a.vert", "a.frag", "-o", "out"], arguments].concat());
        assert_eq!((code(&output), err(&output).as_str()), (0, ""), "{arguments:?}");
    }
    // `reflect` shows what `compile` writes by default.
    let reflect = |arguments: &[&str]| -> Value {
        let output = place.run(&[&["reflect", "a.vert", "a.frag", "--format", "json"], arguments].concat());
        serde_json::from_str(&out(&output)).expect("JSON")
    };
    let written = fs::read_to_string(place.path("out/a.json")).expect("it was written");
    assert_eq!(reflect(&[]), serde_json::from_str::<Value>(&written).expect("JSON"));
    assert_eq!(reflect(&["-O0"])["attributes"][1]["active"], true);
}
