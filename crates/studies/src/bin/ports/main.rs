//! Ports public packs and engines, and prints a table: how many programs are ported, what glslang and spirv-val say of the new texts, how
//! many pictures are proved.
//!
//! ```sh
//! cargo run -p glisten-studies --bin ports -- GLISTEN FOLDER... [--for HOST] [--engine NAME] [--game NEW] [--prove] [--list]
//! ```
//!
//! `GLISTEN` is the program. Each folder is a pack or the shaders of an engine; the table names the commit if it is a repository.
//! `PACK=GAME` names the assets of the game that a pack of Minecraft was made for, and `--game` those of the game that it is ported to. Of
//! the programs that glslang compiles and links as OpenGL's, each stage of the new program is compiled by `glslangValidator -V` and judged by
//! `spirv-val`. Of those that are not ported, *not GLSL* have an error by the specification, and *not read* a feature or an extension
//! that glisten does not read. With `--list`, every program that is not accepted is printed with the reason.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints a table")]

mod minecraft;
mod tools;

use minecraft::Readable;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// The requests of the command line.
struct Arguments {
    glisten: PathBuf,
    /// Each with the assets of its game, if it is a pack.
    folders: Vec<(PathBuf, Option<PathBuf>)>,
    host: String,
    engine: Option<String>,
    game: Option<PathBuf>,
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
        game: None,
        proves: false,
        lists: false,
    };
    while let Some(word) = words.next() {
        match word.as_str() {
            "--for" => found.host = words.next()?,
            "--engine" => found.engine = Some(words.next()?),
            "--game" => found.game = Some(words.next()?.into()),
            "--prove" => found.proves = true,
            "--list" => found.lists = true,
            folder => {
                let (folder, game) =
                    folder.split_once('=').map_or((folder, None), |(folder, game)| (folder, Some(game)));
                found.folders.push((folder.into(), game.map(PathBuf::from)));
            }
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
    /// Of these, programs with an error by the specification.
    no_glsl: usize,
    /// Of these, programs with something that glisten does not read.
    not_read: usize,
    ported: usize,
    accepted: usize,
    valid: usize,
    proved: u64,
    inconclusive: u64,
    failed: u64,
}

fn main() -> ExitCode {
    let Some(arguments) = arguments(std::env::args().skip(1)) else {
        eprintln!("usage: ports GLISTEN FOLDER... [--for HOST] [--engine NAME] [--game NEW] [--prove] [--list]");
        return ExitCode::from(2);
    };
    println!(
        "| folder | commit | game | programs | by glslang as OpenGL | of these not GLSL | not read | ported | by glslang as Vulkan | by spirv-val | proved | inconclusive | failed |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let (mut exit, mut all) = (ExitCode::SUCCESS, Row::default());
    for (folder, game) in &arguments.folders {
        match row(&arguments, folder, game.as_deref()) {
            Ok(row) => {
                let name = folder.file_name().map(|name| name.to_string_lossy().replace('+', "/")).unwrap_or_default();
                let game =
                    game.as_deref().and_then(Path::file_name).map_or("–".into(), |name| name.to_string_lossy());
                row.print(&name, &tools::commit(folder), &game, arguments.proves);
                all.add(&row);
            }
            Err(reason) => {
                eprintln!("{}: {reason}", folder.display());
                exit = ExitCode::FAILURE;
            }
        }
    }
    all.print("all", "", "", arguments.proves);
    exit
}

impl Row {
    fn print(&self, name: &str, commit: &str, game: &str, proves: bool) {
        let Self { programs, by_opengl, no_glsl, not_read, ported, accepted, valid, .. } = self;
        let proofs = [self.proved, self.inconclusive, self.failed];
        let [proved, inconclusive, failed] = proofs.map(|n| if proves { n.to_string() } else { "–".to_owned() });
        println!(
            "| {name} | {commit} | {game} | {programs} | {by_opengl} | {no_glsl} | {not_read} | {ported} | {accepted} | {valid} | {proved} | {inconclusive} | {failed} |"
        );
    }

    fn add(&mut self, other: &Self) {
        self.programs += other.programs;
        self.by_opengl += other.by_opengl;
        self.no_glsl += other.no_glsl;
        self.not_read += other.not_read;
        self.ported += other.ported;
        self.accepted += other.accepted;
        self.valid += other.valid;
        self.proved += other.proved;
        self.inconclusive += other.inconclusive;
        self.failed += other.failed;
    }
}

/// The code of an error, at the end of a reason: `.. is not supported yet (E0001)`.
fn code(reason: &str) -> Option<&str> {
    let code = reason.strip_suffix(')')?.rsplit_once('(')?.1;
    code.strip_prefix('E')
        .is_some_and(|digits| digits.len() == 4 && digits.bytes().all(|b| b.is_ascii_digit()))
        .then_some(code)
}

fn row(arguments: &Arguments, folder: &Path, game: Option<&Path>) -> Result<Row, String> {
    let temporary = tempfile::tempdir().map_err(|error| error.to_string())?;
    let new = temporary.path().join("new");
    let mut command = Command::new(&arguments.glisten);
    command.arg("port").arg(folder).args(["--for", &arguments.host, "-q", "--format", "json", "-o"]).arg(&new);
    if let Some(engine) = &arguments.engine {
        command.args(["--engine", engine]);
    }
    if let Some(game) = game {
        command.arg("-I").arg(game);
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
    let is_minecraft = arguments.host.starts_with("minecraft");
    let at = |name: &str| temporary.path().join(name);
    let readable = |folder: &Path, game: Option<&Path>, name: &str| match is_minecraft {
        true => Readable::of_pack(folder, game, &at(name)),
        false => Ok(Readable::as_it_is(folder)),
    };
    let old_tree = readable(folder, game, "old-tree").map_err(|error| error.to_string())?;
    let new_tree = readable(&new, arguments.game.as_deref(), "new-tree").map_err(|error| error.to_string())?;
    for program in account["programs"].as_array().into_iter().flatten() {
        row.programs += 1;
        let words = |key: &str| program[key].as_array().into_iter().flatten().filter_map(Value::as_str);
        let [files, new_files] = ["files", "new"].map(|key| words(key).zip(words("stages")).collect::<Vec<_>>());
        let said = |text: &str| {
            if arguments.lists {
                println!("  {}: {text}", program["name"].as_str().unwrap_or(""));
            }
        };
        if let Err(complaint) = tools::opengl(&old_tree, &files) {
            said(&format!("the old text: {complaint}"));
            continue;
        }
        row.by_opengl += 1;
        let result = program["result"].as_str().unwrap_or("");
        if result == "refused" {
            let reason = program["because"].as_str().unwrap_or("");
            match code(reason) {
                Some("E0001" | "E0125") => row.not_read += 1,
                Some(_) if !reason.starts_with("in the new language") => row.no_glsl += 1,
                _ => {}
            }
            said(reason);
            continue;
        }
        row.ported += 1;
        let module = temporary.path().join("module.spv");
        let place = module.to_string_lossy().into_owned();
        let (mut is_accepted, mut is_valid) = (true, true);
        for file in &new_files {
            // The game gives the numbers, and Vulkan's names to indices.
            let names = ["-Dgl_VertexID=gl_VertexIndex", "-Dgl_InstanceID=gl_InstanceIndex"];
            let given = if is_minecraft { &["--amb", "--aml", names[0], names[1]][..] } else { &[] };
            let vulkan = [&["-V", "--target-env", "vulkan1.1", "-o", &place], given].concat();
            match tools::vulkan(&new_tree, *file, &vulkan) {
                Ok(()) => {
                    let judged = Command::new("spirv-val").args(["--target-env", "vulkan1.1"]).arg(&module).output();
                    let complaint = match judged {
                        Ok(output) if output.status.success() => None,
                        Ok(output) => Some(String::from_utf8_lossy(&output.stderr).into_owned()),
                        Err(error) => Some(error.to_string()),
                    };
                    complaint.iter().for_each(|text| said(&format!("spirv-val: {}", text.trim())));
                    is_valid &= complaint.is_none();
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
