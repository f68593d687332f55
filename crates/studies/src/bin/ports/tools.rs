//! Other programs: glslang, git.
//!
//! *In:* files. *Out:* complaints, a commit.

use crate::minecraft::Readable;
use std::path::Path;
use std::process::{Command, Output};

/// The complaint of glslang about a file of a tree.
pub(crate) fn glslang(tree: &Readable, (name, stage): (&str, &str), options: &[&str]) -> Result<(), String> {
    let file = tree.root.join(name);
    let stage = match stage {
        "vertex" => "vert",
        "geometry" => "geom",
        _ => "frag",
    };
    let mut command = Command::new("glslangValidator");
    let text = std::fs::read_to_string(&file).map_err(|error| error.to_string())?;
    // glslang reads includes only if a text asks for them; what its host puts before a text comes first.
    let wanted = "#extension GL_GOOGLE_include_directive : enable\n";
    let at = text.find("#version").and_then(|at| Some(at + text.get(at..)?.find('\n')? + 1)).unwrap_or(0);
    let (before, after) = text.split_at(at);
    let copy = tempfile::Builder::new().suffix(&format!(".{stage}")).tempfile().map_err(|error| error.to_string())?;
    std::fs::write(copy.path(), format!("{before}{wanted}{after}")).map_err(|error| error.to_string())?;
    let folders =
        [Some(tree.includes.as_path()), file.parent()].map(|folder| folder.map(|path| format!("-I{}", path.display())));
    command.args(folders.iter().flatten()).args(["-S", stage]);
    // A file with several stages is told which one it is, by the macro of RetroArch and of most others.
    let chosen = if stage == "vert" { "VERTEX" } else { "FRAGMENT" };
    if text.contains("VERTEX") && text.contains("FRAGMENT") {
        command.arg(format!("-D{chosen}=1"));
    }
    if options.is_empty() {
        // Without code to write, glslang reads no included files, but its preprocessor does.
        let output = command.arg("-E").arg(copy.path()).output().map_err(|error| error.to_string())?;
        if !output.status.success() {
            return Err(complaint(&output));
        }
        std::fs::write(copy.path(), &output.stdout).map_err(|error| error.to_string())?;
        command = Command::new("glslangValidator");
        command.args(["-S", stage]);
    }
    let output = command.args(options).arg(copy.path()).output().map_err(|error| error.to_string())?;
    if output.status.success() { Ok(()) } else { Err(complaint(&output)) }
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
