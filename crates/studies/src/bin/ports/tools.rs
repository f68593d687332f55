//! Other programs: glslang, git.
//!
//! *In:* files. *Out:* complaints, a commit.

use crate::minecraft::Readable;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::NamedTempFile;

/// A text as glslang's host puts it before the text, and the options that its compiler needs for it.
struct Prepared {
    copy: NamedTempFile,
    includes: Vec<String>,
    defined: Option<String>,
}

impl Prepared {
    fn new(tree: &Readable, (name, stage): (&str, &str)) -> Result<Self, String> {
        let file = tree.root.join(name);
        let stage = short(stage);
        let text = std::fs::read_to_string(&file).map_err(|error| error.to_string())?;
        // glslang reads includes only if a text asks for them; what its host puts before a text comes first.
        let wanted = "#extension GL_GOOGLE_include_directive : enable\n";
        let at = text.find("#version").and_then(|at| Some(at + text.get(at..)?.find('\n')? + 1)).unwrap_or(0);
        let (before, after) = text.split_at(at);
        let suffix = format!(".{stage}");
        let copy = tempfile::Builder::new().suffix(&suffix).tempfile().map_err(|error| error.to_string())?;
        std::fs::write(copy.path(), format!("{before}{wanted}{after}")).map_err(|error| error.to_string())?;
        let folders = [Some(tree.includes.as_path()), file.parent()];
        let includes = folders.iter().flatten().map(|path| format!("-I{}", path.display())).collect();
        // A file with several stages is told which one it is, by the macro of RetroArch and of most others.
        let chosen = if stage == "vert" { "VERTEX" } else { "FRAGMENT" };
        let defined = (text.contains("VERTEX") && text.contains("FRAGMENT")).then(|| format!("-D{chosen}=1"));
        Ok(Self { copy, includes, defined })
    }

    fn command(&self) -> Command {
        let mut command = Command::new("glslangValidator");
        command.args(&self.includes).args(&self.defined);
        command
    }
}

fn short(stage: &str) -> &'static str {
    match stage {
        "vertex" => "vert",
        "geometry" => "geom",
        _ => "frag",
    }
}

fn run(command: &mut Command) -> Result<Output, String> {
    let output = command.output().map_err(|error| error.to_string())?;
    if output.status.success() { Ok(output) } else { Err(complaint(&output)) }
}

/// The complaint of glslang about the stages of a program of OpenGL, which it compiles and links.
pub(crate) fn opengl(tree: &Readable, stages: &[(&str, &str)]) -> Result<(), String> {
    let mut link = Command::new("glslangValidator");
    link.arg("-l");
    let mut all = Vec::new();
    for stage in stages {
        // Without code to write, glslang reads no included files, but its preprocessor does.
        let prepared = Prepared::new(tree, *stage)?;
        let output = run(prepared.command().arg("-E").arg(prepared.copy.path()))?;
        std::fs::write(prepared.copy.path(), &output.stdout).map_err(|error| error.to_string())?;
        link.arg(prepared.copy.path());
        all.push(prepared);
    }
    run(&mut link).map(drop)
}

/// The complaint of glslang about a file of a tree, which it compiles with options.
pub(crate) fn vulkan(tree: &Readable, stage: (&str, &str), options: &[&str]) -> Result<(), String> {
    let prepared = Prepared::new(tree, stage)?;
    run(prepared.command().args(options).arg(prepared.copy.path())).map(drop)
}

/// The first error in the output of glslang.
fn complaint(output: &Output) -> String {
    let text = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned()).concat();
    text.lines().find(|line| line.contains("ERROR")).unwrap_or("no reason").to_owned()
}

/// The commit of a folder, if it is a repository.
pub(crate) fn commit(folder: &Path) -> String {
    let output = Command::new("git").arg("-C").arg(folder).args(["rev-parse", "--short=7", "HEAD"]).output();
    let known = output.ok().filter(|output| output.status.success());
    known.map_or_else(String::new, |output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
