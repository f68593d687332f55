//! The server's loop: messages in their order, and work when there are none.
//!
//! *In:* the messages of a connection. *Out:* answers, and diagnostics once the editor is quiet. *Holds:* a request that was
//! canceled before its turn is not carried out; changes that wait are applied before any diagnostics are computed, so that fast
//! typing costs one computation; a panic becomes the error of its request.

use super::client::{self, Client};
use super::project::Project;
use super::requests::{self, Failure};
use super::state::{Document, State};
use super::text::Text;
use super::uri;
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::notification::{
    DidChangeConfiguration, DidChangeTextDocument, DidChangeWatchedFiles, DidChangeWorkspaceFolders,
    DidCloseTextDocument, DidOpenTextDocument, DidSaveTextDocument, LogMessage, Notification as _, PublishDiagnostics,
};
use lsp_types::request::{RegisterCapability, Request as _, ShowDocument, WorkspaceDiagnosticRefresh};
use lsp_types::{
    DidChangeTextDocumentParams, DidChangeWatchedFilesParams, DidChangeWatchedFilesRegistrationOptions,
    DidChangeWorkspaceFoldersParams, DidCloseTextDocumentParams, DidOpenTextDocumentParams, FileSystemWatcher,
    GlobPattern, LogMessageParams, MessageType, PublishDiagnosticsParams, Registration, RegistrationParams,
};
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The extensions of the files that an editor watches in its folders.
const WATCHED: [&str; 13] =
    ["toml", "vert", "frag", "geom", "vs", "fs", "gs", "vsh", "fsh", "gsh", "glsl", "glslv", "glslf"];
/// How often the server looks at the files that the editor does not watch.
const POLL: Duration = Duration::from_millis(750);

/// A server between two messages.
struct Server<'a> {
    state: State<'a>,
    connection: &'a Connection,
    waiting: VecDeque<Message>,
    /// The documents that changed since their diagnostics were told.
    changed: BTreeSet<PathBuf>,
    /// Whether anything changed since.
    is_stale: bool,
    /// The findings that were told, by file.
    told: BTreeMap<PathBuf, Value>,
    /// Whether the editor has asked for diagnostics, and gets no others.
    has_pulled: bool,
    is_shut_down: bool,
    n_sent: i32,
    /// When the watched files changed last.
    seen: BTreeMap<PathBuf, Option<SystemTime>>,
}

/// The next step after a message.
enum Next {
    Go,
    Exit,
}

/// Serves a connection until its end. Returns whether a shutdown was asked for.
pub(super) fn serve(project: &mut dyn Project, connection: &Connection) -> bool {
    let Some((id, parameters)) = initialization(connection) else { return false };
    let mut state = State::new(project);
    state.encoding = client::encoding(&parameters);
    state.client = Client::new(&parameters);
    state.folders = client::folders(&parameters);
    let result = json!({
        "capabilities": requests::capabilities(state.encoding),
        "serverInfo": { "name": "glisten", "version": env!("CARGO_PKG_VERSION") },
    });
    let watches = state.client.watches;
    let mut server = Server {
        state,
        connection,
        waiting: VecDeque::new(),
        changed: BTreeSet::new(),
        is_stale: false,
        told: BTreeMap::new(),
        has_pulled: false,
        is_shut_down: false,
        n_sent: 0,
        seen: BTreeMap::new(),
    };
    server.send(Response::new_ok(id, result));
    if watches {
        server.register_watchers();
    }
    server.run();
    server.is_shut_down
}

/// Waits for the first request. What comes before it is answered as the protocol says.
fn initialization(connection: &Connection) -> Option<(RequestId, Value)> {
    for message in &connection.receiver {
        match message {
            Message::Request(request) if request.method == lsp_types::request::Initialize::METHOD => {
                return Some((request.id, request.params));
            }
            Message::Request(request) => {
                let message = "the first request is `initialize`".to_owned();
                let answer = Response::new_err(request.id, ErrorCode::ServerNotInitialized as i32, message);
                let _ = connection.sender.send(answer.into());
            }
            Message::Notification(told) if told.method == lsp_types::notification::Exit::METHOD => return None,
            _ => {}
        }
    }
    None
}

impl Server<'_> {
    fn run(&mut self) {
        loop {
            self.take_waiting();
            let message = match self.waiting.pop_front() {
                Some(message) => message,
                None if self.is_stale => {
                    self.tell();
                    continue;
                }
                None => match self.connection.receiver.recv_timeout(POLL) {
                    Ok(message) => message,
                    Err(error) if error.is_timeout() => {
                        self.look_at_files();
                        self.rest();
                        continue;
                    }
                    Err(_) => return,
                },
            };
            if matches!(self.message(message), Next::Exit) {
                return;
            }
        }
    }

    /// Takes all messages that are there. A request that is canceled among them is answered.
    fn take_waiting(&mut self) {
        while let Ok(message) = self.connection.receiver.try_recv() {
            match canceled(&message) {
                Some(id) => self.cancel(&id),
                None => self.waiting.push_back(message),
            }
        }
    }

    fn cancel(&mut self, id: &RequestId) {
        let is_it = |message: &Message| matches!(message, Message::Request(request) if request.id == *id);
        if let Some(place) = self.waiting.iter().position(is_it) {
            self.waiting.remove(place);
            let code = ErrorCode::RequestCanceled as i32;
            self.send(Response::new_err(id.clone(), code, "canceled by the editor".to_owned()));
        }
    }

    fn message(&mut self, message: Message) -> Next {
        match message {
            Message::Request(request) => self.request(request),
            Message::Notification(told) if told.method == lsp_types::notification::Exit::METHOD => return Next::Exit,
            Message::Notification(told) => self.notification(told),
            Message::Response(_) => {}
        }
        Next::Go
    }

    fn send(&self, message: impl Into<Message>) {
        // An editor that is gone needs no answer; the loop ends with its messages.
        let _ = self.connection.sender.send(message.into());
    }

    fn request(&mut self, request: Request) {
        let Request { id, method, params } = request;
        if self.is_shut_down {
            let message = "the server is shut down".to_owned();
            return self.send(Response::new_err(id, ErrorCode::InvalidRequest as i32, message));
        }
        if method == lsp_types::request::Initialize::METHOD {
            let message = "`initialize` is sent once".to_owned();
            return self.send(Response::new_err(id, ErrorCode::InvalidRequest as i32, message));
        }
        if method == lsp_types::request::Shutdown::METHOD {
            self.is_shut_down = true;
            return self.send(Response::new_ok(id, Value::Null));
        }
        if method == lsp_types::request::DocumentDiagnosticRequest::METHOD && self.state.client.pulls {
            self.end_pushing();
        }
        match requests::commands::scene_of(&method, &params) {
            Some(Ok((scene, is_shown))) => return self.draw(id, &scene, is_shown),
            Some(Err(failure)) => return self.send(Response::new_err(id, failure.code, failure.message)),
            None => {}
        }
        let Some(handler) = requests::handler(&method) else {
            let message = format!("there is no request `{method}`");
            return self.send(Response::new_err(id, ErrorCode::MethodNotFound as i32, message));
        };
        let mut answer = Err(Failure::internal("the request was not carried out"));
        let state = &mut self.state;
        let slot = &mut answer;
        let done = guarded(state, move |state| *slot = handler(state, params));
        let answer = done.map_err(|panic| Failure::internal(&format!("internal error: {panic}"))).and(answer);
        self.send(match answer {
            Ok(value) => Response::new_ok(id, value),
            Err(failure) => Response::new_err(id, failure.code, failure.message),
        });
        for (method, params) in std::mem::take(&mut self.state.outbox) {
            self.ask(method, params);
        }
        self.is_stale |= std::mem::take(&mut self.state.is_changed);
        self.state.trim();
    }

    /// Draws a scene, answers with the picture's URI, and lets the editor show it if it can.
    fn draw(&mut self, id: RequestId, scene: &Path, is_shown: bool) {
        self.n_sent += 1;
        let (own, client) = (RequestId::from(format!("glisten-{}", self.n_sent)), self.state.client);
        let sender = self.connection.sender.clone();
        // An editor that is gone needs no answer.
        let done = move |drawn: Result<PathBuf, String>| {
            let uri = drawn.and_then(|path| uri::of(&path).ok_or_else(|| "the picture has no name".to_owned()));
            let answer = match &uri {
                Ok(uri) => Response::new_ok(id, json!({ "uri": uri })),
                Err(why) => Response::new_err(id, ErrorCode::RequestFailed as i32, why.clone()),
            };
            if let (Ok(uri), true) = (uri, client.shows && is_shown) {
                let params = json!({ "uri": uri, "external": !client.is_code, "takeFocus": false });
                let _ = sender.send(Request { id: own, method: ShowDocument::METHOD.to_owned(), params }.into());
            }
            let _ = sender.send(answer.into());
        };
        self.state.project.picture(scene, Box::new(done));
    }

    fn notification(&mut self, told: Notification) {
        let Notification { method, params } = told;
        let server = &mut *self;
        let done = match method.as_str() {
            DidOpenTextDocument::METHOD => with(params, |params| server.open(params)),
            DidChangeTextDocument::METHOD => with(params, |params| server.change(params)),
            DidCloseTextDocument::METHOD => with(params, |params| server.close(&params)),
            DidChangeWatchedFiles::METHOD => with(params, |params| server.files_changed(&params)),
            DidChangeWorkspaceFolders::METHOD => with(params, |params| server.folders_changed(&params)),
            DidChangeConfiguration::METHOD => {
                server.reload();
                Ok(())
            }
            DidSaveTextDocument::METHOD => {
                server.is_stale = true;
                Ok(())
            }
            _ => Ok(()),
        };
        // The protocol has no answer to a notification; editors show this in their log.
        if let Err(error) = done {
            let message = format!("`{method}` cannot be read: {error}");
            let told = LogMessageParams { typ: MessageType::ERROR, message };
            self.send(Notification::new(LogMessage::METHOD.to_owned(), told));
        }
    }

    fn open(&mut self, params: DidOpenTextDocumentParams) {
        let document = params.text_document;
        let path = uri::path(&document.uri);
        if path.extension().is_some_and(|extension| extension == "toml") {
            // Configurations and scenes are read from the disk.
            return;
        }
        let text = Text::new(document.text);
        self.state.set(&path, Some(Document { uri: document.uri, version: document.version, text }));
        self.touch(path);
    }

    fn change(&mut self, params: DidChangeTextDocumentParams) {
        let path = uri::path(&params.text_document.uri);
        let encoding = self.state.encoding;
        let Some(document) = self.state.documents.get(&path) else { return };
        let text = document.text.clone().changed(params.content_changes, encoding);
        let (uri, version) = (document.uri.clone(), params.text_document.version);
        self.state.set(&path, Some(Document { uri, version, text }));
        self.touch(path);
    }

    fn close(&mut self, params: &DidCloseTextDocumentParams) {
        self.state.set(&uri::path(&params.text_document.uri), None);
        self.is_stale = true;
    }

    fn touch(&mut self, path: PathBuf) {
        self.changed.insert(path);
        self.is_stale = true;
    }

    fn files_changed(&mut self, params: &DidChangeWatchedFilesParams) {
        let paths: Vec<PathBuf> = params.changes.iter().map(|change| uri::path(&change.uri)).collect();
        // What an editor has open counts as it is there.
        if paths.iter().any(|path| !self.state.documents.contains_key(path)) {
            self.reload();
        }
    }

    fn folders_changed(&mut self, params: &DidChangeWorkspaceFoldersParams) {
        let removed: Vec<PathBuf> = params.event.removed.iter().map(|folder| uri::path(&folder.uri)).collect();
        self.state.folders.retain(|folder| !removed.contains(folder));
        self.state.folders.extend(params.event.added.iter().map(|folder| uri::path(&folder.uri)));
        self.reload();
    }

    fn reload(&mut self) {
        self.state.reload();
        self.is_stale = true;
    }

    fn register_watchers(&mut self) {
        let watcher = |extension: &str| FileSystemWatcher {
            glob_pattern: GlobPattern::String(format!("**/*.{extension}")),
            kind: None,
        };
        let options = DidChangeWatchedFilesRegistrationOptions { watchers: WATCHED.map(watcher).to_vec() };
        let registration = Registration {
            id: "files".to_owned(),
            method: DidChangeWatchedFiles::METHOD.to_owned(),
            register_options: serde_json::to_value(options).ok(),
        };
        self.ask(RegisterCapability::METHOD, json!(RegistrationParams { registrations: vec![registration] }));
    }

    /// Sends a request whose answer does not matter.
    fn ask(&mut self, method: &str, params: Value) {
        self.n_sent += 1;
        let id = RequestId::from(format!("glisten-{}", self.n_sent));
        self.send(Request { id, method: method.to_owned(), params });
    }

    /// Does what waits until the editor rests.
    fn rest(&mut self) {
        let mut is_changed = false;
        let slot = &mut is_changed;
        // A panic has been dealt with: nothing is kept but the documents.
        let _ = guarded(&mut self.state, move |state| *slot = state.rest());
        self.is_stale |= is_changed;
    }

    /// Whether the editor announces changes of a file: an include may have any name, and be in any folder.
    fn is_watched(&self, path: &Path) -> bool {
        let extension = path.extension().and_then(|extension| extension.to_str());
        self.state.client.watches
            && extension.is_some_and(|extension| WATCHED.contains(&extension))
            && self.state.folders.iter().any(|folder| path.starts_with(folder))
    }

    /// Looks whether a configuration, a baseline, or a file that is not open changed on disk.
    fn look_at_files(&mut self) {
        if self.state.documents.is_empty() {
            return;
        }
        let mut paths = self.state.project.configurations();
        let open: Vec<PathBuf> = self.state.documents.keys().cloned().collect();
        for path in open {
            let known = self.state.known_files(&path);
            paths.extend(known.into_iter().filter(|path| !self.is_watched(path)));
        }
        paths.sort();
        paths.dedup();
        let documents = &self.state.documents;
        let files = paths.into_iter().filter(|path| !documents.contains_key(path));
        let now: BTreeMap<PathBuf, Option<SystemTime>> = files.map(|path| (path.clone(), modified(&path))).collect();
        let is_changed = |(path, time): (&PathBuf, &Option<SystemTime>)| {
            self.seen.get(path).map_or(time.is_some() && path.ends_with("glisten.toml"), |seen| seen != time)
        };
        let reload = !self.seen.is_empty() && now.iter().any(is_changed);
        self.seen = now;
        if reload {
            self.reload();
        }
    }

    /// Tells the diagnostics of the documents that changed, and of the others that are not as they were told.
    fn tell(&mut self) {
        self.is_stale = false;
        let changed = std::mem::take(&mut self.changed);
        let mut found = BTreeMap::new();
        let slot = &mut found;
        let computed = guarded(&mut self.state, |state| *slot = requests::diagnostics::all(state));
        if computed.is_err() {
            return;
        }
        let mut messages = Vec::new();
        for (path, diagnostics) in &found {
            let is_open = self.state.documents.contains_key(path);
            let is_news = self.told.get(path) != Some(&json!(diagnostics));
            if is_news || changed.contains(path) {
                let (uri, version) = match self.state.documents.get(path) {
                    Some(document) => (Some(document.uri.clone()), Some(document.version)),
                    None => (self.state.uri(path), None),
                };
                // An editor that asks gets an answer about what it shows.
                if let (Some(uri), false) = (uri, self.has_pulled && is_open) {
                    messages.push((
                        !changed.contains(path),
                        PublishDiagnosticsParams { uri, diagnostics: diagnostics.clone(), version },
                    ));
                }
            }
        }
        let is_other = found
            .iter()
            .any(|(path, diagnostics)| !changed.contains(path) && self.told.get(path) != Some(&json!(diagnostics)));
        for path in self.told.keys().filter(|path| !found.contains_key(*path)) {
            if let Some(uri) = self.state.uri(path) {
                messages.push((true, PublishDiagnosticsParams { uri, diagnostics: Vec::new(), version: None }));
            }
        }
        self.told = found.iter().map(|(path, diagnostics)| (path.clone(), json!(diagnostics))).collect();
        // What is being edited comes first.
        messages.sort_by_key(|(later, _)| *later);
        for (_, message) in messages {
            self.send(Notification::new(PublishDiagnostics::METHOD.to_owned(), message));
        }
        if self.has_pulled && is_other && self.state.client.refreshes {
            self.ask(WorkspaceDiagnosticRefresh::METHOD, Value::Null);
        }
    }

    /// Takes back what was told about open documents: the editor asks from now on, and would show both.
    fn end_pushing(&mut self) {
        if std::mem::replace(&mut self.has_pulled, true) {
            return;
        }
        let told: Vec<PathBuf> = self.told.keys().cloned().collect();
        for path in told {
            if let Some(document) = self.state.documents.get(&path) {
                let params =
                    PublishDiagnosticsParams { uri: document.uri.clone(), diagnostics: Vec::new(), version: None };
                self.send(Notification::new(PublishDiagnostics::METHOD.to_owned(), params));
            }
        }
    }
}

/// Runs work on the state; a panic in it is an error, after which nothing is kept but the documents.
fn guarded<'s, 'p>(state: &'s mut State<'p>, work: impl FnOnce(&mut State<'p>) + 's) -> Result<(), String> {
    let done = super::guard(|| work(state));
    if done.is_err() {
        state.recover();
    }
    done
}

/// The request that a message cancels.
fn canceled(message: &Message) -> Option<RequestId> {
    let Message::Notification(told) = message else { return None };
    if told.method != lsp_types::notification::Cancel::METHOD {
        return None;
    }
    serde_json::from_value(told.params.get("id")?.clone()).ok()
}

/// Carries out work with the parameters of a notification, if they can be read.
fn with<P: DeserializeOwned>(params: Value, work: impl FnOnce(P)) -> serde_json::Result<()> {
    serde_json::from_value(params).map(work)
}

fn modified(path: &Path) -> Option<SystemTime> {
    path.metadata().and_then(|metadata| metadata.modified()).ok()
}
