//! The page as one file that computes by itself: it holds glisten as a WebAssembly module, and needs neither a server nor a network.
//!
//! *In:* a scene or a folder of scenes, the module that `integrations/web/make page` builds. *Out:* an HTML file with the module, and with all
//! files that the scenes read. *Holds:* a scene that the page could not read as the command line does is left out, and told: the page
//! knows no engine and no prelude. The page draws by the reference and by the browser's WebGPU.

use super::PlayArgs;
use super::files::list;
use super::page::page;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files::{self, SceneFiles};
use crate::progress::Progress;
use crate::scenes::{DrawError, SceneArgs};
use crate::session::Session;
use crate::trace;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glisten_play::{Pictures, drawable};
use glisten_verify::scene::{self, Scene};
use serde_json::{Map, Value, json};
use std::path::Path;

/// The largest number of bytes of all files in a page.
const MAX_BYTES: usize = 128 << 20;
/// The longer side of a picture in the gallery.
const SIDE: u32 = 200;
/// The first bytes of a WebAssembly module (WebAssembly Core Specification §5.5.16), and of gzip (RFC 1952 §2.3.1).
const MODULE: &[u8] = b"\0asm";
const PACKED: &[u8] = b"\x1f\x8b";
/// The script that answers in the page.
const WORKER: &str = include_str!("page/worker.js");

/// The scenes of a page, and what they read.
#[derive(Default)]
struct Held {
    scenes: Vec<String>,
    files: Map<String, Value>,
    n_bytes: usize,
    gallery: Vec<Value>,
}

/// Writes the page.
pub(super) fn run(args: &PlayArgs, output: &Path, module: &Path, console: &Console) -> Outcome {
    refuse_what_a_page_has_not(args)?;
    files::check_writable(output)?;
    let module = read_module(module)?;
    let is_folder = Path::new(&args.start).is_dir();
    let scenes = if is_folder { scenes_of(&args.start) } else { vec![args.start.clone()] };
    let progress = Progress::new(console, scenes.len());
    let mut held = Held::default();
    for name in scenes {
        progress.say(&name);
        match held.add(args, &name, console) {
            Ok(()) => {}
            Err(failure) if !is_folder => return Err(failure),
            Err(Failure { message, .. }) => {
                console.message(&format!("warning: `{name}` is not in the page: {message}\n"));
            }
        }
        progress.step();
    }
    drop(progress);
    if held.scenes.is_empty() {
        return Err(Failure::new(Exit::Content, format!("`{}` has no scene for a page", args.start)));
    }
    let count = held.scenes.len();
    let start = json!({
        "mode": "module",
        "version": env!("CARGO_PKG_VERSION"),
        "module": module,
        "worker": WORKER,
        "scene": held.scenes.first(),
        "list": { "scenes": held.scenes, "programs": [] },
        "gallery": held.gallery,
        "files": held.files,
        "request": request(args),
        "seconds": args.machine.time_limit().as_secs_f64(),
    });
    let html = page("glisten", start).map_err(|error| Failure::new(Exit::Content, error))?;
    files::write(output, html.as_bytes())?;
    let scenes = if count == 1 { "a scene".to_owned() } else { format!("{count} scenes") };
    console.remark(&format!("wrote {} with {scenes}", output.display()));
    Ok(Exit::Ok)
}

/// The page completes no sources.
fn refuse_what_a_page_has_not(args: &PlayArgs) -> Result<(), Failure> {
    let sources = &args.sources;
    let given = [
        ("--engine", sources.engine.is_some()),
        ("--include-style", sources.include_style.is_some()),
        ("--prelude", !sources.preludes.is_empty()),
    ];
    match given.iter().find(|(_, is_given)| *is_given) {
        Some((flag, _)) => Err(Failure::usage(format!("a page that computes by itself knows no `{flag}`"))
            .help("leave `--module` out: then the page shows what was computed here")),
        None => Ok(()),
    }
}

/// The part that all requests of the page share.
fn request(args: &PlayArgs) -> Value {
    let sources = &args.sources;
    let folders: Vec<String> =
        sources.include_dirs.iter().map(|folder| folder.to_string_lossy().into_owned()).collect();
    let version = sources.assume_version.iter().map(|version| ["assume-version", version]);
    let strict = sources.strict.then_some(["strict", "true"]);
    let options: Vec<[&str; 2]> = version.chain(strict).collect();
    json!({ "defines": sources.defines, "folders": folders, "options": options })
}

/// The module as the page holds it.
fn read_module(path: &Path) -> Result<Value, Failure> {
    let name = path.to_string_lossy();
    let bytes = files::read(&name, path).map_err(|error| {
        Failure::usage(error.message).help("`integrations/web/make page` builds it: target/web/play.wasm.gz")
    })?;
    if !bytes.starts_with(MODULE) && !bytes.starts_with(PACKED) {
        return Err(Failure::usage(format!("`{name}` is no WebAssembly module")));
    }
    Ok(json!({ "is_packed": bytes.starts_with(PACKED), "bytes": STANDARD.encode(&bytes) }))
}

/// The scenes of a folder, by name.
fn scenes_of(folder: &str) -> Vec<String> {
    let listed = list(folder);
    let names = listed.get("scenes").and_then(Value::as_array).into_iter().flatten();
    names.filter_map(|name| name.as_str().map(str::to_owned)).collect()
}

impl Held {
    /// Adds a scene with its files and its picture.
    fn add(&mut self, args: &PlayArgs, name: &str, console: &Console) -> Result<(), Failure> {
        let of = SceneArgs::of(name, &args.machine, &args.sources, &args.levels);
        let session = of.session(console)?;
        let (loaded, trace) = trace::recorded(|| scene::load(name, &SceneFiles, session.compiler()));
        let content = |message: String| Failure::new(Exit::Content, message);
        let (scene, sources) = drawable(loaded).map_err(content)?;
        let shaders = sources.files().map(|(_, file)| file.name());
        if shaders.into_iter().any(|file| is_completed(&session, file)) {
            return Err(content("`[[source]]` tables of glisten.toml complete its sources".to_owned()));
        }
        let drawn = of.within_time(move || Ok(picture(scene))).map_err(|error| match error {
            DrawError::Failure(failure) => failure,
            DrawError::Diagnostics(found) => content(glisten_play::told(found.iter().take(1))),
        })?;
        let picture = drawn.map_err(content)?;
        for file in trace.files() {
            self.add_file(file)?;
        }
        self.gallery.push(json!({ "scene": name, "picture": picture }));
        self.scenes.push(name.to_owned());
        Ok(())
    }

    fn add_file(&mut self, name: &str) -> Result<(), Failure> {
        if self.files.contains_key(name) {
            return Ok(());
        }
        let bytes = files::read(name, Path::new(name)).map_err(|error| Failure::usage(error.message))?;
        self.n_bytes += bytes.len();
        if self.n_bytes > MAX_BYTES {
            let message = format!("the files of the scenes have more than {} MiB", MAX_BYTES >> 20);
            return Err(Failure::new(Exit::Content, message).help("name a single scene"));
        }
        let held = match String::from_utf8(bytes) {
            Ok(text) => json!({ "text": text }),
            Err(error) => json!({ "bytes": STANDARD.encode(error.as_bytes()) }),
        };
        self.files.insert(name.to_owned(), held);
        Ok(())
    }
}

/// Whether tables of `glisten.toml` complete a source.
fn is_completed(session: &Session<'_>, name: &str) -> bool {
    let folder = Path::new(name).parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    session.engines().trace_of_rules(folder).is_some()
}

/// A small picture.
fn picture(mut scene: Scene) -> Result<Value, String> {
    let framebuffer = &mut scene.framebuffer;
    let longest = framebuffer.width.max(framebuffer.height).max(1);
    if longest > SIDE {
        let scaled = |side: u32| (u64::from(side) * u64::from(SIDE)).div_ceil(u64::from(longest)) as u32;
        (framebuffer.width, framebuffer.height) = (scaled(framebuffer.width), scaled(framebuffer.height));
    }
    let mut drawn = Pictures::default().reference(&scene)?;
    Ok(drawn.get_mut("picture").map(Value::take).unwrap_or_default())
}
