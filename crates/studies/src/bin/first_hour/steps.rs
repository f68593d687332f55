//! [`Steps`]: the three commands for one program, and what its picture shows.
//!
//! *In:* a program. *Out:* [`Taken`]: how far it got, and why no further. *Holds:* every command runs in a process of its own with a time
//! limit; after `new-scene`, no flag is repeated.

use crate::programs::{Found, of_sources};
use glisten::{Precision, RenderOptions, render};
use glisten_cli::survey;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

/// Pixels of the window, so that the reference judges a picture in a moment.
const SIDE: &str = "48";
/// The largest difference of a channel up to which a picture is of one color.
const FLAT: f64 = 0.03;

/// How far a program got.
#[derive(Clone, Debug, Default)]
pub(crate) struct Taken {
    /// Whether `new-scene` wrote a scene.
    pub(crate) written: bool,
    /// Whether `render` drew it.
    pub(crate) drawn: bool,
    /// The extent and the colors of the picture.
    pub(crate) shown: Option<Shown>,
    /// The verdict of `verify`.
    pub(crate) verdict: Option<String>,
    /// Why it got no further.
    pub(crate) reason: String,
}

/// The extent and the colors of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shown {
    /// The share of covered pixels.
    pub(crate) covered: f64,
    /// The largest difference of a channel between them.
    pub(crate) contrast: f64,
}

impl Taken {
    pub(crate) fn covers(&self) -> bool {
        self.shown.is_some_and(|shown| shown.covered > 0.0)
    }

    /// Whether it covers pixels, and they are of one color.
    pub(crate) fn is_flat(&self) -> bool {
        self.shown.is_some_and(|shown| shown.covered > 0.0 && shown.contrast < FLAT)
    }
}

/// The commands.
pub(crate) struct Steps {
    program: PathBuf,
    own: PathBuf,
    limit: Duration,
}

impl Steps {
    /// The program that was built next to this one.
    pub(crate) fn new(limit: Duration) -> Result<Self, String> {
        let own = std::env::current_exe().map_err(|error| error.to_string())?;
        let program = own.parent().and_then(Path::parent).map(|folder| folder.join("glisten")).unwrap_or_default();
        if !program.is_file() {
            return Err(format!("there is no `{}`: build it first, with --all-features", program.display()));
        }
        Ok(Self { program, own, limit })
    }

    /// Takes the steps for a program, with files in `folder`.
    pub(crate) fn take(&self, found: &Found, folder: &Path) -> Taken {
        let mut taken = Taken::default();
        if let Err(why) = self.all(found, folder, &mut taken) {
            taken.reason = why;
        }
        taken
    }

    fn all(&self, found: &Found, folder: &Path, taken: &mut Taken) -> Result<(), String> {
        std::fs::create_dir_all(folder).map_err(|error| error.to_string())?;
        let path = |name: &str| folder.join(name).to_string_lossy().into_owned();
        let scene = path("scene.toml");
        let mut new =
            vec!["new-scene".to_owned(), "-o".to_owned(), scene.clone(), "--size".to_owned(), SIDE.to_owned()];
        new.extend(of_sources(&found.flags));
        new.extend(found.files.iter().cloned());
        self.run(&self.program, &new, folder, "new-scene")?;
        taken.written = true;
        // A PNG cannot hold the numbers of an integer framebuffer.
        let text = std::fs::read_to_string(&scene).unwrap_or_default();
        let picture = path(if text.contains("format = \"rgba32") { "picture.npy" } else { "picture.png" });
        self.run(&self.program, &["render".to_owned(), scene.clone(), "-o".to_owned(), picture], folder, "render")?;
        taken.drawn = true;
        let told = self.run(&self.own, &["--show".to_owned(), scene.clone()], folder, "show")?;
        let numbers: Vec<f64> = told.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        if let [covered, contrast] = numbers[..] {
            taken.shown = Some(Shown { covered, contrast });
        }
        let verify =
            ["verify".to_owned(), scene, "--format".to_owned(), "json".to_owned(), "--allow-inconclusive".to_owned()];
        let report: Result<Value, _> =
            serde_json::from_str(&self.run(&self.program, &verify, folder, "verify").or_else(|why| {
                let is_report = why.starts_with('{');
                if is_report { Ok(why) } else { Err(why) }
            })?);
        let verdict = report.ok().and_then(|report| Some(report.get("verdict")?.as_str()?.to_owned()));
        taken.verdict = verdict;
        Ok(())
    }

    /// Runs a command. The error is its first message.
    fn run(&self, program: &Path, arguments: &[String], folder: &Path, step: &str) -> Result<String, String> {
        let output = |ending: &str| folder.join(format!("{step}.{ending}"));
        let file = |ending: &str| std::fs::File::create(output(ending)).map_err(|error| error.to_string());
        let mut child = Command::new(program)
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(file("out")?)
            .stderr(file("err")?)
            .spawn()
            .map_err(|error| error.to_string())?;
        let deadline = Instant::now() + self.limit;
        let status = loop {
            match child.try_wait().map_err(|error| error.to_string())? {
                Some(status) => break status,
                None if Instant::now() > deadline => {
                    // It may have ended by itself.
                    let _ = child.kill();
                    let _ = child.wait();
                    return Err(format!("{step}: it took more than {} s", self.limit.as_secs()));
                }
                None => std::thread::sleep(Duration::from_millis(10)),
            }
        };
        let read = |ending: &str| std::fs::read_to_string(output(ending)).unwrap_or_default();
        let (text, told) = (read("out"), read("err"));
        if status.success() || text.trim_start().starts_with('{') {
            return Ok(text);
        }
        let message =
            told.lines().find(|line| line.starts_with("error")).or(told.lines().next()).unwrap_or("no message");
        Err(format!("{step}: {message}"))
    }
}

/// Prints the share of covered pixels of a scene, and the largest difference of a channel between them.
pub(crate) fn show(scene: &str) -> ExitCode {
    let Some(loaded) = survey::scene(scene) else {
        eprintln!("error: the scene does not load");
        return ExitCode::FAILURE;
    };
    let options = RenderOptions { precision: Precision::F32, mark_edges: false, ..RenderOptions::default() };
    let Ok(picture) = render(&loaded, &options) else {
        eprintln!("error: the reference does not draw it");
        return ExitCode::FAILURE;
    };
    let count = picture.covered.iter().filter(|covered| **covered).count();
    let mut contrast: f64 = 0.0;
    for colors in &picture.attachments {
        for channel in 0..3 {
            let shown =
                colors.iter().zip(&picture.covered).filter(|(_, covered)| **covered).map(|(color, _)| color[channel]);
            let visible = shown.filter(|value| value.is_finite()).map(|value| value.clamp(0.0, 1.0));
            let (low, high) = visible.fold((1.0_f64, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
            contrast = contrast.max(high - low);
        }
    }
    println!("{} {contrast}", count as f64 / picture.covered.len().max(1) as f64);
    ExitCode::SUCCESS
}
