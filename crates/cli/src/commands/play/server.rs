//! The server: requests of the page, and their answers.
//!
//! *In:* HTTP on 127.0.0.1. *Out:* the page, lists of files, the answers of workers, files. *Holds:* every request is checked
//! ([`super::access`]) before anything else; a request that takes long keeps no other one waiting; the number of requests at a time
//! is limited.

use super::PlayArgs;
use super::access::{Asking, Folders, Token, check};
use super::files::{self, Changes, NotSaved};
use super::http::{Answer, Answers, Head, serve};
use super::lanes::NoAnswer;
use super::page::page;
use super::pages::Pages;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::process::interrupt::Interrupt;
use glisten_sources::{read_bounded, stages};
use percent_encoding::percent_decode_str;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError, RwLock};
use std::time::Duration;

/// The most requests at a time.
const MAX_REQUESTS: usize = 64;
/// How long a question for changes waits for one.
const WAIT: Duration = Duration::from_secs(20);
/// The reason why a file is not overwritten.
const CHANGED: &str = "the file changed on disk meanwhile";
/// How often Ctrl-C is looked for.
const POLL: Duration = Duration::from_millis(40);

/// The state of a server.
struct Server {
    token: Token,
    port: u16,
    /// The folder of the page's files.
    root: String,
    /// The scene that the page begins with.
    scene: Option<String>,
    /// The shader that the page makes a scene for at the beginning.
    shader: Option<String>,
    folders: RwLock<Folders>,
    /// Whether the scene could be read as it was on disk. From then on no folders are added: a page may save another text of it.
    is_read: AtomicBool,
    changes: Changes,
    pages: Pages,
    /// The texts of new scenes by their names.
    made: Mutex<BTreeMap<String, String>>,
    /// The number of requests that are being answered.
    running: AtomicUsize,
}

fn json_of(value: &Value) -> Answer {
    Answer { status: 200, kind: "application/json", body: value.to_string().into_bytes() }
}

fn outside() -> Answer {
    Answer::refused(403, "the file is in none of the folders of `glisten play`")
}

/// Runs the server until Ctrl-C.
pub(super) fn run(args: &PlayArgs, console: &Console) -> Outcome {
    let interrupt = Interrupt::watch();
    let listening = TcpListener::bind(("127.0.0.1", args.port)).and_then(|http| Ok((http.local_addr()?.port(), http)));
    let (port, http) = listening.map_err(|error| {
        let failure = Failure::new(Exit::Machine, format!("port {} cannot be used: {error}", args.port));
        failure.help("leave `--port` out, and a free one is taken")
    })?;
    let server = Arc::new(Server::new(args, port));
    let address = format!("http://127.0.0.1:{port}/?token={}", server.token.text());
    console.output(&format!("{address}\n"))?;
    console.remark(&format!("serving `{}` (Ctrl-C to stop)", server.root));
    if args.open
        && let Err(error) = open::that_detached(&address)
    {
        console.remark(&format!("no browser opens ({error}); open the address above"));
    }
    let answering = Arc::clone(&server);
    let spawned = std::thread::Builder::new().spawn(move || serve(&http, &answering));
    spawned.map_err(|error| Failure::new(Exit::Machine, format!("the system gives no thread: {error}")))?;
    while !interrupt.is_pressed() {
        std::thread::sleep(POLL);
    }
    server.pages.stop();
    Ok(Exit::Interrupted)
}

/// A request that runs, among those at a time.
struct Running<'a>(&'a AtomicUsize);

impl Drop for Running<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

impl Answers for Server {
    /// Nothing is kept, and the page may ask this server alone.
    const HEADERS: &'static [(&'static str, &'static str)] = &[
        ("Cache-Control", "no-store"),
        ("X-Content-Type-Options", "nosniff"),
        ("Referrer-Policy", "no-referrer"),
        ("Cross-Origin-Resource-Policy", "same-origin"),
        (
            "Content-Security-Policy",
            "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; \
             connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
        ),
    ];

    fn admit(&self, head: &Head) -> Result<(), Answer> {
        let query = queries(split(&head.target).1);
        let token = head.header("X-Glisten-Token").or(query.get("token").map(String::as_str));
        let asking = Asking { host: head.header("Host"), origin: head.header("Origin"), token };
        check(asking, &self.token, self.port).map_err(|reason| Answer::refused(403, reason))
    }

    fn answer(&self, head: &Head, body: Vec<u8>) -> Answer {
        let running = Running(&self.running);
        if running.0.fetch_add(1, Ordering::AcqRel) >= MAX_REQUESTS {
            return Answer::refused(503, "too many requests at a time");
        }
        let (path, query) = split(&head.target);
        let query = queries(query);
        let page = query.get("page").map(String::as_str);
        match (head.method.as_str(), path) {
            ("GET", "/") => self.page(),
            ("GET", "/api/list") => json_of(&files::list(&self.root)),
            ("GET", "/api/changes") => {
                page.into_iter().for_each(|page| self.pages.hear(page));
                let since = query.get("since").and_then(|since| since.parse().ok()).unwrap_or(0);
                json_of(&json!({ "number": self.changes.after(since, WAIT) }))
            }
            ("GET", path) if path.starts_with("/api/") => Answer::refused(404, "there is no such request"),
            ("GET", path) => self.file(path),
            ("POST", "/api/here") => {
                page.into_iter().for_each(|page| self.pages.hear(page));
                json_of(&json!({ "ok": true }))
            }
            ("POST", "/api/gone") => {
                page.into_iter().for_each(|page| self.pages.forget(page));
                json_of(&json!({ "ok": true }))
            }
            ("POST", "/api/ask" | "/api/save" | "/api/new-scene") => match String::from_utf8(body) {
                Ok(body) => self.post(path, &body),
                Err(_) => Answer::refused(400, "the request is not UTF-8"),
            },
            _ => Answer::refused(405, "there is no such request"),
        }
    }
}

/// The path and the query of a target.
fn split(target: &str) -> (&str, &str) {
    target.split_once('?').unwrap_or((target, ""))
}

impl Server {
    fn new(args: &PlayArgs, port: u16) -> Self {
        let start = Path::new(&args.start);
        let root = if start.is_dir() { start } else { start.parent().unwrap_or(Path::new("")) };
        let is_shader = stages::by_name(start).is_some();
        let file = (!start.is_dir()).then(|| files::name_of(start));
        let mut folders = Folders::default();
        [root].into_iter().chain(args.sources.include_dirs.iter().map(PathBuf::as_path)).for_each(|folder| {
            folders.add(folder);
        });
        let root = if root.as_os_str().is_empty() { Path::new(".") } else { root };
        let server = Self {
            token: Token::new(),
            port,
            root: root.to_string_lossy().into_owned(),
            scene: file.clone().filter(|_| !is_shader),
            shader: file.filter(|_| is_shader),
            changes: Changes::watch(&folders),
            folders: RwLock::new(folders),
            is_read: AtomicBool::new(false),
            pages: Pages::new(worker, args.machine.time_limit()),
            made: Mutex::default(),
            running: AtomicUsize::new(0),
        };
        if let Some(scene) = &server.scene {
            let job = json!({ "ask": "look", "scene": scene }).to_string();
            let answer = server.pages.of("").looks.ask(&job).unwrap_or_default();
            server.open_folders(&serde_json::from_str(&answer).unwrap_or_default());
        }
        server
    }

    /// Opens the folders of the files that the scene of this server reads, as they are on disk, until it can be read as a whole.
    fn open_folders(&self, answer: &Value) {
        let is_whole = answer.pointer("/ok/size").is_some_and(|size| !size.is_null());
        if self.is_read.fetch_or(is_whole, Ordering::AcqRel) {
            return;
        }
        let files = answer.pointer("/ok/files").and_then(Value::as_array);
        for name in files.into_iter().flatten().filter_map(|file| file.get("name").and_then(Value::as_str)) {
            let folder = Path::new(name).parent().unwrap_or(Path::new(""));
            let mut folders = self.folders.write().unwrap_or_else(PoisonError::into_inner);
            if let Some(new) = folders.add(folder) {
                self.changes.add(&new);
            }
        }
    }

    /// Where a name leads, if that is in a folder.
    fn path(&self, name: &str) -> Option<PathBuf> {
        self.folders.read().unwrap_or_else(PoisonError::into_inner).path(name)
    }

    fn page(&self) -> Answer {
        let start = json!({
            "mode": "server",
            "token": self.token.text(),
            "scene": self.scene,
            "program": self.shader.as_ref().map(|shader| files::program_of(&self.root, shader)),
            "list": files::list(&self.root),
        });
        match page("glisten play", start) {
            Ok(html) => Answer { status: 200, kind: "text/html; charset=utf-8", body: html.into_bytes() },
            Err(error) => Answer::refused(500, &error),
        }
    }

    /// A file of the folders, as text.
    fn file(&self, path: &str) -> Answer {
        let name = percent_decode_str(path.strip_prefix('/').unwrap_or(path)).decode_utf8_lossy().into_owned();
        let name = Path::new(&self.root).join(name).to_string_lossy().into_owned();
        let Some(path) = self.path(&name) else { return outside() };
        match read_bounded(Path::new(&path)) {
            Ok(body) => Answer { status: 200, kind: "text/plain; charset=utf-8", body },
            Err(_) => Answer::refused(404, "there is no such file"),
        }
    }

    fn post(&self, path: &str, body: &str) -> Answer {
        match path {
            "/api/ask" => self.ask(body),
            "/api/save" => self.save(body),
            _ => self.new_scene(body),
        }
    }

    /// Hands a job to its worker.
    fn ask(&self, body: &str) -> Answer {
        let Ok(Value::Object(mut job)) = serde_json::from_str(body) else {
            return Answer::refused(400, "it is no question");
        };
        let word = |key: &str| job.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
        let (ask, scene, page) = (word("ask"), word("scene"), word("page"));
        let texts = job.get("texts").and_then(Value::as_object).into_iter().flat_map(|texts| texts.keys());
        let names: Vec<&str> = texts.map(String::as_str).collect();
        let scene_name = (ask != "pixel").then_some(scene.as_str());
        if names.iter().copied().chain(scene_name).any(|name| self.path(name).is_none()) {
            return outside();
        }
        let is_of_disk = names.is_empty() && self.scene.as_ref() == Some(&scene);
        job.insert("bounds".into(), self.bounds(&scene));
        // Each job is one line.
        let line = Value::Object(job).to_string();
        let lanes = self.pages.of(&page);
        let answer = match ask.as_str() {
            "look" => lanes.looks.ask(&line),
            "pixel" | "trace" => lanes.draws.ask_behind(&line),
            "needs" | "stability" | "variants" => lanes.studies.ask(&line),
            _ => lanes.draws.ask(&line),
        };
        answer.map_or_else(unanswered, |text| self.told(&text, is_of_disk))
    }

    /// The files that the texts of a page may name: see `super::worker`.
    fn bounds(&self, scene: &str) -> Value {
        let folders = self.folders.read().unwrap_or_else(PoisonError::into_inner);
        let folders: Vec<&Path> = folders.iter().collect();
        let made = self.made.lock().unwrap_or_else(PoisonError::into_inner).get(scene).cloned();
        json!({ "folders": folders, "made": made })
    }

    /// A worker's answer, with whether each file may be saved. It opens folders if it is about the server's scene as it is on disk.
    fn told(&self, text: &str, is_of_disk: bool) -> Answer {
        let mut answer: Value = serde_json::from_str(text).unwrap_or_default();
        if answer.get("is_outside").is_some() {
            return Answer::refused(403, answer.get("error").and_then(Value::as_str).unwrap_or_default());
        }
        if is_of_disk {
            self.open_folders(&answer);
        }
        let folders = self.folders.read().unwrap_or_else(PoisonError::into_inner);
        let files = answer.get_mut("ok").and_then(|ok| ok.get_mut("files")).and_then(Value::as_array_mut);
        for file in files.into_iter().flatten().filter_map(Value::as_object_mut) {
            let name = file.get("name").and_then(Value::as_str).unwrap_or_default();
            let fixed = files::fixed(&folders, name);
            file.insert("is_writable".into(), fixed.is_none().into());
            file.insert("fixed".into(), fixed.into());
        }
        json_of(&answer)
    }

    fn save(&self, body: &str) -> Answer {
        #[derive(Deserialize)]
        struct Save {
            name: String,
            text: String,
            was: Option<String>,
        }
        let Ok(save) = serde_json::from_str::<Save>(body) else { return Answer::refused(400, "it is not a text") };
        let folders = self.folders.read().unwrap_or_else(PoisonError::into_inner);
        match files::save(&folders, &save.name, &save.text, save.was.as_deref()) {
            Ok(()) => json_of(&json!({ "ok": true })),
            Err(NotSaved::Outside) => outside(),
            Err(NotSaved::Changed(now)) => Answer { status: 409, ..json_of(&json!({ "error": CHANGED, "disk": now })) },
            Err(NotSaved::NotText) => Answer::refused(422, files::NOT_TEXT),
            Err(NotSaved::Failed(reason)) => Answer::refused(500, &reason),
        }
    }

    /// The text of a scene that draws some shaders, as a page has them, with the texts of the files that it takes.
    fn new_scene(&self, body: &str) -> Answer {
        #[derive(Deserialize)]
        struct Wanted {
            files: Vec<String>,
            /// The name, if it has one.
            scene: Option<String>,
            #[serde(default)]
            texts: BTreeMap<String, String>,
            #[serde(default)]
            page: String,
        }
        let Ok(Wanted { files, scene, texts, page }) = serde_json::from_str(body) else {
            return Answer::refused(400, "it is not a list of files");
        };
        let Some(name) = scene.or_else(|| files.first().map(|name| files::free_name(name))) else {
            return Answer::refused(400, "it is an empty list of files");
        };
        if files.iter().chain(texts.keys()).chain([&name]).any(|name| self.path(name).is_none()) {
            return outside();
        }
        let bounds = self.bounds(&name);
        let job = json!({ "ask": "new-scene", "scene": name, "files": files, "texts": texts, "bounds": bounds });
        match self.pages.of(&page).studies.ask(&job.to_string()) {
            Ok(answer) => {
                let mut answer: Value = serde_json::from_str(&answer).unwrap_or_default();
                if let Some(text) = answer.pointer("/ok/text").and_then(Value::as_str) {
                    self.made.lock().unwrap_or_else(PoisonError::into_inner).insert(name, text.to_owned());
                }
                match answer.get_mut("ok").map(Value::take) {
                    Some(made) => json_of(&made),
                    None => self.told(&answer.to_string(), false),
                }
            }
            Err(reason) => unanswered(reason),
        }
    }
}

/// The answer to a job that has none.
fn unanswered(reason: NoAnswer) -> Answer {
    match reason {
        NoAnswer::Superseded => Answer::refused(409, "a newer question came"),
        NoAnswer::TimeOver => Answer::refused(200, "it took longer than the limit (`--timeout` gives more time)"),
        NoAnswer::Crashed(how) => {
            Answer::refused(200, &format!("the worker ended ({how}); a driver that crashes does so"))
        }
        NoAnswer::NoWorker(error) => Answer::refused(500, &format!("no worker starts: {error}")),
    }
}

/// A copy of this process that answers jobs.
fn worker() -> std::io::Result<Command> {
    let mut command = Command::new(std::env::current_exe()?);
    command.args(std::env::args_os().skip(1)).arg("--worker");
    Ok(command)
}

/// The parts of a query.
fn queries(query: &str) -> BTreeMap<String, String> {
    let decoded = |text: &str| percent_decode_str(text).decode_utf8_lossy().into_owned();
    let parts = query.split('&').filter_map(|part| part.split_once('='));
    parts.map(|(name, value)| (decoded(name), decoded(value))).collect()
}
