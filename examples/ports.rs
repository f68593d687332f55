//! Ports public packs and engines, and prints a table: how many programs are ported, what glslang and spirv-val say of the new texts, how
//! many pictures are proved.
//!
//! ```sh
//! cargo run --all-features --example ports -- GLISTEN FOLDER... [--for HOST] [--engine NAME] [--prove] [--list]
//! ```
//!
//! `GLISTEN` is the program. Each folder is a pack or the shaders of an engine; the table names the commit if it is a repository. Of the
//! programs that glslang takes as OpenGL's, each stage of the new program is compiled by `glslangValidator -V` and judged by
//! `spirv-val`. With `--list`, every program that is not accepted is printed with the reason.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints a table")]

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// The requests of the command line.
struct Arguments {
    glisten: PathBuf,
    folders: Vec<PathBuf>,
    host: String,
    engine: Option<String>,
    proves: bool,
    lists: bool,
}

fn arguments(mut words: impl Iterator<Item = String>) -> Option<Arguments> {
    let glisten = words.next()?.into();
    let mut found = Arguments {
        glisten,
        folders: Vec::new(),
        host: "vulkan".to_owned(),
        engine: None,
        proves: false,
        lists: false,
    };
    while let Some(word) = words.next() {
        match word.as_str() {
            "--for" => found.host = words.next()?,
            "--engine" => found.engine = Some(words.next()?),
            "--prove" => found.proves = true,
            "--list" => found.lists = true,
            folder => found.folders.push(folder.into()),
        }
    }
    (!found.folders.is_empty()).then_some(found)
}

/// The figures of a folder.
#[derive(Default)]
struct Row {
    programs: usize,
    /// Programs whose old texts glslang takes as OpenGL's.
    by_opengl: usize,
    ported: usize,
    accepted: usize,
    valid: usize,
    proved: u64,
    inconclusive: u64,
    failed: u64,
}

fn main() -> ExitCode {
    let Some(arguments) = arguments(std::env::args().skip(1)) else {
        eprintln!("usage: ports GLISTEN FOLDER... [--for HOST] [--engine NAME] [--prove] [--list]");
        return ExitCode::from(2);
    };
    println!(
        "| folder | commit | programs | by glslang as OpenGL | of these ported | by glslang as Vulkan | by spirv-val | proved | inconclusive | failed |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let mut exit = ExitCode::SUCCESS;
    for folder in &arguments.folders {
        match row(&arguments, folder) {
            Ok(row) => {
                let name = folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
                let Row { programs, by_opengl, ported, accepted, valid, proved, inconclusive, failed } = row;
                let commit = commit(folder);
                println!(
                    "| {name} | {commit} | {programs} | {by_opengl} | {ported} | {accepted} | {valid} | {proved} | {inconclusive} | {failed} |"
                );
            }
            Err(reason) => {
                eprintln!("{}: {reason}", folder.display());
                exit = ExitCode::FAILURE;
            }
        }
    }
    exit
}

fn row(arguments: &Arguments, folder: &Path) -> Result<Row, String> {
    let temporary = tempfile::tempdir().map_err(|error| error.to_string())?;
    let new = temporary.path().join("new");
    let mut command = Command::new(&arguments.glisten);
    command.arg("port").arg(folder).args(["--for", &arguments.host, "-q", "--format", "json", "-o"]).arg(&new);
    if let Some(engine) = &arguments.engine {
        command.args(["--engine", engine]);
    }
    if arguments.proves {
        command.arg("--prove");
    }
    let output = command.output().map_err(|error| error.to_string())?;
    let account: Value = serde_json::from_slice(&output.stdout)
        .map_err(|_| String::from_utf8_lossy(&output.stderr).lines().next().unwrap_or("no account").to_owned())?;
    let figure = |name: &str| account["summary"][name].as_u64().unwrap_or(0);
    let mut row = Row {
        proved: figure("proved"),
        inconclusive: figure("inconclusive"),
        failed: figure("failed"),
        ..Row::default()
    };
    for program in account["programs"].as_array().into_iter().flatten() {
        row.programs += 1;
        let names = program["files"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let names: Vec<&str> = names.collect();
        let files: Vec<PathBuf> = names.iter().map(|name| folder.join(name)).collect();
        let said = |text: &str| {
            if arguments.lists {
                println!("  {}: {text}", program["name"].as_str().unwrap_or(""));
            }
        };
        if !files.iter().all(|file| glslang(file, folder, &[]).is_ok()) {
            continue;
        }
        row.by_opengl += 1;
        let result = program["result"].as_str().unwrap_or("");
        if result == "refused" {
            said(program["because"].as_str().unwrap_or(""));
            continue;
        }
        row.ported += 1;
        let module = temporary.path().join("module.spv");
        let place = module.to_string_lossy().into_owned();
        let (mut is_accepted, mut is_valid) = (true, true);
        for name in &names {
            let given = if arguments.host.starts_with("minecraft") { &["--amb", "--aml"][..] } else { &[] };
            let vulkan = [&["-V", "--target-env", "vulkan1.1", "-o", &place], given].concat();
            match glslang(&new.join(name), &new, &vulkan) {
                Ok(()) => {
                    let judged = Command::new("spirv-val").args(["--target-env", "vulkan1.1"]).arg(&module).output();
                    is_valid &= judged.is_ok_and(|output| output.status.success());
                }
                Err(complaint) => {
                    said(&complaint);
                    (is_accepted, is_valid) = (false, false);
                }
            }
        }
        row.accepted += usize::from(is_accepted);
        row.valid += usize::from(is_valid);
        if arguments.lists && matches!(program["proof"].as_str(), Some("inconclusive" | "failed")) {
            said(&format!("{}: {}", program["proof"], program["evidence"]));
        }
    }
    Ok(row)
}

/// The complaint of glslang about a file.
fn glslang(file: &Path, folder: &Path, options: &[&str]) -> Result<(), String> {
    let stage = match file.extension().and_then(|extension| extension.to_str()).unwrap_or("") {
        "vert" | "vsh" | "vs" | "glslv" => "vert",
        "frag" | "fsh" | "fs" | "glslf" => "frag",
        _ => return Err("a file whose name tells no stage".to_owned()),
    };
    let mut command = Command::new("glslangValidator");
    let text = std::fs::read_to_string(file).map_err(|error| error.to_string())?;
    // glslang reads includes only if a text asks for them; what its host puts before a text comes first.
    let wanted = "#extension GL_GOOGLE_include_directive : enable\n";
    let at = text.find("#version").and_then(|at| Some(at + text.get(at..)?.find('\n')? + 1)).unwrap_or(0);
    let (before, after) = text.split_at(at);
    let copy = tempfile::Builder::new().suffix(&format!(".{stage}")).tempfile().map_err(|error| error.to_string())?;
    std::fs::write(copy.path(), format!("{before}{wanted}{after}")).map_err(|error| error.to_string())?;
    for folder in [file.parent().unwrap_or(folder), folder] {
        command.arg(format!("-I{}", folder.display()));
    }
    let output =
        command.args(["-S", stage]).args(options).arg(copy.path()).output().map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let first = || text.lines().find(|line| line.contains("ERROR")).unwrap_or("no reason").to_owned();
    output.status.success().then_some(()).ok_or_else(first)
}

/// The commit of a folder, if it is a repository.
fn commit(folder: &Path) -> String {
    let output = Command::new("git").arg("-C").arg(folder).args(["rev-parse", "--short", "HEAD"]).output();
    let known = output.ok().filter(|output| output.status.success());
    known.map_or_else(String::new, |output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
