//! [`Checked`]: all that is found about one program.
//!
//! *In:* a compiled program with its texts. *Out:* who accepts it, what its code is worth, what its picture is. *Holds:* drivers and
//! compilers of others run as programs of their own, with a limit of time, so that one that fails costs one answer.

use crate::scenery;
use crate::tasks::AS_DEVICE;
use crate::tools::{Ended, run};
use glisten::emit::{Conventions, Emitted, Target, emit};
use glisten::{Compiler, Program, Source, Stage};
use glisten_cli::survey::{Surveyed, covering};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::source::{SourceMap, version_line};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;

/// The time that a compiler of others has for a program, and a driver for its pictures.
const LIMIT: Duration = Duration::from_secs(20);

/// The answer to one question.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) enum Answer {
    /// It was not asked.
    #[default]
    Open,
    /// Yes.
    Good,
    /// No, and why.
    Bad(String),
    /// There is nothing to ask about, and why.
    Without(String),
}

/// All that is found about a program.
#[derive(Debug, Default)]
pub(crate) struct Checked {
    /// Its files.
    pub(crate) files: Vec<(String, Stage)>,
    /// glisten accepts it.
    pub(crate) glisten: Answer,
    /// glslang accepts it.
    pub(crate) glslang: Answer,
    /// Mesa accepts it; asked only if one of the others refuses it.
    pub(crate) mesa: Answer,
    /// naga reads the WGSL of all stages.
    pub(crate) naga: Answer,
    /// Tint does.
    pub(crate) tint: Answer,
    /// spirv-val accepts the SPIR-V of all stages.
    pub(crate) spirv: Answer,
    /// The pictures of Vulkan and OpenGL agree with the reference.
    pub(crate) picture: Answer,
    /// The pictures were judged by what is known of the device, since nothing else could.
    pub(crate) as_device: bool,
    /// The time of glisten.
    pub(crate) time: Duration,
}

impl Checked {
    /// Whether another compiler accepts it.
    pub(crate) fn is_accepted_elsewhere(&self) -> bool {
        [&self.glslang, &self.mesa].contains(&&Answer::Good)
    }

    /// Asks everyone about a program.
    pub(crate) fn new(surveyed: &Surveyed, texts: &[(Stage, &str)], folder: &Path, draws: bool) -> Self {
        let mut checked = Self { files: surveyed.files.clone(), time: surveyed.time, ..Self::default() };
        let written: Vec<String> = texts.iter().filter_map(|(stage, text)| write(*stage, text, folder)).collect();
        checked.glslang = glslang(&written, folder);
        let program = match &surveyed.compiled {
            Ok(compilation) => {
                let error = compilation.diagnostics.iter().find(|diagnostic| diagnostic.is_error());
                checked.glisten = error.map_or(Answer::Good, |error| Answer::Bad(told(error, &compilation.sources)));
                compilation.program.as_ref()
            }
            Err(panic) => {
                checked.glisten = Answer::Bad(format!("PANIC {panic}"));
                None
            }
        };
        if checked.glisten != Answer::Good || checked.glslang != Answer::Good {
            let mut command = again("--accept");
            checked.mesa = answer(&run(command.args(&written), folder, LIMIT));
        }
        if let Some(program) = program {
            checked.translate(program, folder);
            if draws {
                (checked.picture, checked.as_device) = picture(program, &written, folder);
            }
        }
        checked
    }

    /// Asks about the emitted code.
    fn translate(&mut self, program: &Program, folder: &Path) {
        (self.naga, self.tint, self.spirv) = (Answer::Good, Answer::Good, Answer::Good);
        if program.stage(Stage::Geometry).is_some() {
            return;
        }
        for shader in &program.stages {
            match emit(program, shader.stage, Target::Wgsl, &Conventions::default()) {
                Ok(Emitted::Text(text)) => {
                    worse(&mut self.naga, naga(&text));
                    worse(
                        &mut self.tint,
                        tool(Command::new("tint").args(["--format", "wgsl"]), "a.wgsl", text.as_bytes(), folder),
                    );
                }
                Ok(Emitted::Words(_)) => {}
                Err(found) => {
                    let why = why(&found);
                    worse(&mut self.naga, Answer::Without(why.clone()));
                    worse(&mut self.tint, Answer::Without(why));
                }
            }
            match emit(program, shader.stage, Target::Spirv, &Conventions::default()) {
                Ok(Emitted::Words(words)) => {
                    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
                    worse(&mut self.spirv, tool(&mut Command::new("spirv-val"), "a.spv", &bytes, folder));
                }
                Ok(Emitted::Text(_)) => {}
                Err(found) => worse(&mut self.spirv, Answer::Without(why(&found))),
            }
        }
    }
}

/// Keeps the first answer that is not good; a bad one counts more than none.
fn worse(kept: &mut Answer, new: Answer) {
    if *kept == Answer::Good || matches!((&*kept, &new), (Answer::Without(_), Answer::Bad(_))) {
        *kept = new;
    }
}

fn why(found: &[Diagnostic]) -> String {
    found.first().map_or_else(String::new, |first| format!("{} {}", first.code.id, first.message))
}

fn told(error: &Diagnostic, sources: &SourceMap) -> String {
    let span = sources.call_site(error.primary.span);
    let file = sources.file_of(span).map_or("", |file| sources.file(file).name());
    let line = sources.line(span).unwrap_or(0);
    format!("{} {} ({file}:{line})", error.code.id, error.message)
}

/// The ending by which other programs know a stage.
fn ending(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Fragment => "frag",
        Stage::Geometry => "geom",
    }
}

/// Writes a text for other programs. Returns the file.
fn write(stage: Stage, text: &str, folder: &Path) -> Option<String> {
    let file = folder.join(format!("a.{}", ending(stage)));
    std::fs::write(&file, text).ok()?;
    Some(file.to_string_lossy().into_owned())
}

fn glslang(files: &[String], folder: &Path) -> Answer {
    let mut command = Command::new("glslangValidator");
    // Without a version it is 1.10, not ES 1.00.
    command.arg("-d");
    if files.len() > 1 {
        command.arg("-l");
    }
    answer(&run(command.args(files), folder, LIMIT))
}

fn answer(ended: &Ended) -> Answer {
    let is_told = |line: &&str| line.contains("ERROR") || line.contains("error");
    let line = ended.text().lines().find(is_told).or(ended.text().lines().last()).unwrap_or_default();
    if ended.is_well() { Answer::Good } else { Answer::Bad(line.trim().to_owned()) }
}

fn naga(text: &str) -> Answer {
    let module = match naga::front::wgsl::parse_str(text) {
        Ok(module) => module,
        Err(error) => return Answer::Bad(error.to_string()),
    };
    match Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module) {
        Ok(_) => Answer::Good,
        Err(error) => Answer::Bad(error.as_inner().to_string()),
    }
}

fn tool(command: &mut Command, name: &str, bytes: &[u8], folder: &Path) -> Answer {
    let file = folder.join(name);
    match std::fs::write(&file, bytes) {
        Ok(()) => answer(&run(command.arg(&file), folder, LIMIT)),
        Err(error) => Answer::Without(error.to_string()),
    }
}

/// This program again, for a task of its own.
fn again(task: &str) -> Command {
    let mut command = Command::new(std::env::current_exe().unwrap_or_default());
    command.arg(task).env("XDG_RUNTIME_DIR", std::env::temp_dir());
    command
}

/// Lets a text of OpenGL ES compute in `highp`: with less, Mesa computes in 16 bits, which the language allows and no envelope has.
fn highest_precision(file: &str) {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    let mut new = ["mediump", "lowp"].iter().fold(text.clone(), |text, word| text.replace(word, "highp"));
    let es = version_line(&text)
        .filter(|line| text.get(line.clone()).is_some_and(|line| line.ends_with("es") || line.ends_with("100")));
    if let Some(line) = es {
        // What a sampler returns has the sampler's precision. Extensions come before all else.
        let last = new.match_indices("\n#extension").last().map_or(line.start, |(at, _)| at + 1);
        let end = new.get(last..).and_then(|rest| rest.find('\n')).map_or(new.len(), |length| last + length);
        new.insert_str(end, "\nprecision highp sampler2D; precision highp samplerCube;");
    }
    if new != text {
        // The old text is as good for all but the comparison.
        let _ = std::fs::write(file, new);
    }
}

/// Draws a program that has no scene. Also says whether what is known of the device was needed to judge it.
fn picture(program: &Program, written: &[String], folder: &Path) -> (Answer, bool) {
    match scene_of(program, written, folder) {
        Ok(scene) => match run(again("--draw").arg(scene), folder, LIMIT) {
            Ended::Well(text) if text.contains("inconclusive") => (Answer::Without(text.trim().to_owned()), false),
            Ended::Well(text) => (Answer::Good, text.contains(AS_DEVICE)),
            Ended::Badly(text) => {
                let says_more = |line: &&str| !line.contains("inconclusive") && !line.contains(AS_DEVICE);
                let line = text.lines().find(says_more).unwrap_or_default();
                // A program that only its engine completes has no scene.
                let is_scene = line.starts_with("scene: ");
                (if is_scene { Answer::Without(line.to_owned()) } else { Answer::Bad(line.to_owned()) }, false)
            }
            Ended::Late => (Answer::Without("drawing takes too long".to_owned()), false),
            Ended::Missing => (Answer::Open, false),
        },
        Err(answer) => (answer, false),
    }
}

/// Writes the scene of a program. The error is the answer to all questions about its picture.
fn scene_of(program: &Program, written: &[String], folder: &Path) -> Result<PathBuf, Answer> {
    let has = |stage: Stage| program.stage(stage).is_some();
    if has(Stage::Geometry) || !has(Stage::Fragment) {
        return Err(Answer::Without("no pair".to_owned()));
    }
    let mut files: Vec<(&str, String)> = Vec::new();
    let mut whole = None;
    if !has(Stage::Vertex) {
        let text = match covering(program) {
            Ok(text) => text,
            Err(why) => return Err(Answer::Without(why)),
        };
        let Some(file) = write(Stage::Vertex, &text, folder) else { return Err(Answer::Open) };
        files.push(("vertex", file));
        let fragment = program.stage(Stage::Fragment).and_then(|shader| shader.texts.first().cloned());
        let source = |stage, text: Arc<str>| Source { name: format!("a.{}", ending(stage)), text, stage };
        let sources = [(Stage::Vertex, text.into()), (Stage::Fragment, fragment.unwrap_or_default())];
        let sources = sources.map(|(stage, text)| source(stage, text));
        whole = Compiler::new(Default::default()).compile(&sources).program;
    }
    for file in written {
        files.push((if file.ends_with(".vert") { "vertex" } else { "fragment" }, file.clone()));
    }
    let program = whole.as_ref().unwrap_or(program);
    for (_, file) in &files {
        highest_precision(file);
    }
    let scene = folder.join("a.toml");
    if let Err(error) = std::fs::write(&scene, scenery::scene(program, &files)) {
        return Err(Answer::Without(error.to_string()));
    }
    Ok(scene)
}
