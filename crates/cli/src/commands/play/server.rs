//! The server: requests of the page, and their answers.
//!
//! *In:* HTTP on 127.0.0.1. *Out:* the page, lists of files, the answers of workers, files. *Holds:* every request is checked
//! ([`super::access`]) before anything else; a request that takes long keeps no other one waiting; bodies and the number of
//! requests at a time are limited.

use super::PlayArgs;
use super::access::{Asking, Folders, Token, check};
use super::files::{self, Changes, NotSaved};
use super::lanes::NoAnswer;
use super::page::page;
use super::pages::Pages;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files::sandbox;
use crate::process::interrupt::Interrupt;
use glisten_sources::stages;
use percent_encoding::percent_decode_str;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::Read;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError, RwLock};
use std::time::Duration;
use tiny_http::{Header, Method, Request, Response};

/// The largest body of a request.
const MAX_BYTES: u64 = 32 << 20;
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
    /// The arguments that say how sources are read, for other commands.
    source_args: Vec<String>,
}

/// An answer: a status, the type of the body, the body.
struct Answer {
    status: u16,
    kind: &'static str,
    body: Vec<u8>,
}

impl Answer {
    fn json(value: &Value) -> Self {
        Self { status: 200, kind: "application/json", body: value.to_string().into_bytes() }
    }

    fn refused(status: u16, reason: &str) -> Self {
        let body = json!({ "error": reason }).to_string().into_bytes();
        Self { status, kind: "application/json", body }
    }

    fn outside() -> Self {
        Self::refused(403, "the file is in none of the folders of `glisten play`")
    }
}

/// Runs the server until Ctrl-C.
pub(super) fn run(args: &PlayArgs, console: &Console) -> Outcome {
    let interrupt = Interrupt::watch();
    let http = listening(args.port).map_err(|error| {
        let failure = Failure::new(Exit::Machine, format!("port {} cannot be used: {error}", args.port));
        failure.help("leave `--port` out, and a free one is taken")
    })?;
    let port = http.server_addr().to_ip().map_or(args.port, |address| address.port());
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
    let spawned = std::thread::Builder::new().spawn(move || accept(&http, &answering));
    spawned.map_err(|error| Failure::new(Exit::Machine, format!("the system gives no thread: {error}")))?;
    while !interrupt.is_pressed() {
        std::thread::sleep(POLL);
    }
    server.pages.stop();
    Ok(Exit::Interrupted)
}

/// A server at a port. An answer is written in several parts, of which none waits until the part before it is acknowledged: that takes the
/// other side 40 ms.
fn listening(port: u16) -> Result<tiny_http::Server, Box<dyn std::error::Error + Send + Sync>> {
    let listener = TcpListener::bind(("127.0.0.1", port))?;
    // Connections take it over from what listens. Without it, answers are later, and the same.
    #[cfg(unix)]
    let _ = rustix::net::sockopt::set_tcp_nodelay(&listener, true);
    tiny_http::Server::from_listener(listener, None)
}

/// Answers each request on a thread of its own.
fn accept(http: &tiny_http::Server, server: &Arc<Server>) {
    let running = Arc::new(AtomicUsize::new(0));
    while let Ok(request) = http.recv() {
        if running.fetch_add(1, Ordering::AcqRel) >= MAX_REQUESTS {
            running.fetch_sub(1, Ordering::AcqRel);
            respond(request, Answer::refused(503, "too many requests at a time"));
            continue;
        }
        let (server, running) = (Arc::clone(server), Arc::clone(&running));
        std::thread::spawn(move || {
            let mut request = request;
            let answer = server.answer(&mut request);
            respond(request, answer);
            running.fetch_sub(1, Ordering::AcqRel);
        });
    }
}

/// The headers of every answer: nothing is kept, and the page may ask this server alone.
const HEADERS: [(&str, &str); 5] = [
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

fn respond(request: Request, answer: Answer) {
    let header = |name: &str, value: &str| Header::from_bytes(name, value).ok();
    let mut response = Response::from_data(answer.body).with_status_code(answer.status);
    let kind = [("Content-Type", answer.kind)];
    for header in kind.iter().chain(&HEADERS).filter_map(|(name, value)| header(name, value)) {
        response.add_header(header);
    }
    // A browser that left does not wait for it.
    let _ = request.respond(response);
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
            source_args: source_args(args),
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

    fn answer(&self, request: &mut Request) -> Answer {
        let url = request.url().to_owned();
        let (path, query) = url.split_once('?').unwrap_or((&url, ""));
        let query = queries(query);
        let header = |name: &'static str| {
            let found = request.headers().iter().find(|header| header.field.equiv(name));
            found.map(|header| header.value.as_str().to_owned())
        };
        let (host, origin, token) = (header("Host"), header("Origin"), header("X-Glisten-Token"));
        let token = token.as_deref().or(query.get("token").map(String::as_str));
        let asking = Asking { host: host.as_deref(), origin: origin.as_deref(), token };
        if let Err(reason) = check(asking, &self.token, self.port) {
            return Answer::refused(403, reason);
        }
        match (request.method(), path) {
            (Method::Get, "/") => self.page(),
            (Method::Get, "/api/list") => Answer::json(&files::list(&self.root)),
            (Method::Get, "/api/changes") => {
                query.get("page").into_iter().for_each(|page| self.pages.hear(page));
                let since = query.get("since").and_then(|since| since.parse().ok()).unwrap_or(0);
                Answer::json(&json!({ "number": self.changes.after(since, WAIT) }))
            }
            (Method::Get, path) if path.starts_with("/api/") => Answer::refused(404, "there is no such request"),
            (Method::Get, path) => self.file(path),
            (Method::Post, "/api/gone") => {
                query.get("page").into_iter().for_each(|page| self.pages.forget(page));
                Answer::json(&json!({ "ok": true }))
            }
            (Method::Post, "/api/ask" | "/api/save" | "/api/new-scene") => {
                let path = path.to_owned();
                match body(request) {
                    Ok(body) => self.post(&path, &body),
                    Err(refused) => refused,
                }
            }
            _ => Answer::refused(405, "there is no such request"),
        }
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
        let Some(path) = self.path(&name) else { return Answer::outside() };
        match std::fs::read(&path) {
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
            return Answer::outside();
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
        match answer {
            Ok(text) => self.told(&text, is_of_disk),
            Err(NoAnswer::Superseded) => Answer::refused(409, "a newer question came"),
            Err(NoAnswer::TimeOver) => {
                Answer::refused(200, "it took longer than the limit (`--timeout` gives more time)")
            }
            Err(NoAnswer::Crashed(how)) => {
                Answer::refused(200, &format!("the worker ended ({how}); a driver that crashes does so"))
            }
            Err(NoAnswer::NoWorker(error)) => Answer::refused(500, &format!("no worker starts: {error}")),
        }
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
        Answer::json(&answer)
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
            Ok(()) => Answer::json(&json!({ "ok": true })),
            Err(NotSaved::Outside) => Answer::outside(),
            Err(NotSaved::Changed(now)) => {
                Answer { status: 409, ..Answer::json(&json!({ "error": CHANGED, "disk": now })) }
            }
            Err(NotSaved::NotText) => Answer::refused(422, files::NOT_TEXT),
            Err(NotSaved::Failed(reason)) => Answer::refused(500, &reason),
        }
    }

    /// The text of a scene that draws some shaders.
    fn new_scene(&self, body: &str) -> Answer {
        let Ok(names) = serde_json::from_str::<Vec<String>>(body) else {
            return Answer::refused(400, "it is not a list of files");
        };
        let Some(paths) = names.iter().map(|name| self.path(name)).collect::<Option<Vec<_>>>() else {
            return Answer::outside();
        };
        let folder = paths.first().and_then(|path| path.parent()).unwrap_or(Path::new(".")).to_owned();
        let files = paths.iter().filter_map(|path| path.file_name());
        let made = std::env::current_exe().and_then(|program| {
            let mut command = Command::new(program);
            command.current_dir(&folder).arg("new-scene").args(files).args(&self.source_args).args(sandbox());
            command.stdin(Stdio::null()).output()
        });
        match made {
            Ok(made) if made.status.success() => {
                let text = String::from_utf8_lossy(&made.stdout).into_owned();
                let name = names.first().map(|name| files::free_name(name)).unwrap_or_default();
                self.made.lock().unwrap_or_else(PoisonError::into_inner).insert(name.clone(), text.clone());
                Answer::json(&json!({ "name": name, "text": text }))
            }
            Ok(made) => Answer::refused(200, String::from_utf8_lossy(&made.stderr).trim()),
            Err(error) => Answer::refused(500, &error.to_string()),
        }
    }
}

/// A copy of this process that answers jobs.
fn worker() -> std::io::Result<Command> {
    let mut command = Command::new(std::env::current_exe()?);
    command.args(std::env::args_os().skip(1)).arg("--worker");
    Ok(command)
}

/// The arguments that say how sources are read, with absolute paths.
fn source_args(args: &PlayArgs) -> Vec<String> {
    let sources = &args.sources;
    let path = |path: &Path| std::path::absolute(path).unwrap_or_default().to_string_lossy().into_owned();
    let defines = sources.defines.iter().flat_map(|(name, value)| ["-D".to_owned(), format!("{name}={value}")]);
    let includes = sources.include_dirs.iter().flat_map(|folder| ["-I".to_owned(), path(folder)]);
    let preludes = sources.preludes.iter().flat_map(|file| ["--prelude".to_owned(), path(file)]);
    let version = sources.assume_version.iter().flat_map(|version| ["--assume-version".to_owned(), version.clone()]);
    let engine = sources.engine.iter().flat_map(|engine| ["--engine".to_owned(), engine.clone()]);
    defines.chain(includes).chain(preludes).chain(version).chain(engine).collect()
}

/// The parts of a query.
fn queries(query: &str) -> BTreeMap<String, String> {
    let decoded = |text: &str| percent_decode_str(text).decode_utf8_lossy().into_owned();
    let parts = query.split('&').filter_map(|part| part.split_once('='));
    parts.map(|(name, value)| (decoded(name), decoded(value))).collect()
}

/// The body of a request as text.
fn body(request: &mut Request) -> Result<String, Answer> {
    let mut bytes = Vec::new();
    let read = request.as_reader().take(MAX_BYTES + 1).read_to_end(&mut bytes);
    if read.is_err() {
        return Err(Answer::refused(400, "the request does not end"));
    }
    if bytes.len() as u64 > MAX_BYTES {
        return Err(Answer::refused(413, "the request is too large"));
    }
    String::from_utf8(bytes).map_err(|_| Answer::refused(400, "the request is not UTF-8"))
}
