//! [`Cache`]: the results of earlier runs, by all that they depend on.
//!
//! *In:* the digest of a program's options and names; what a run of it read. *Out:* its outputs and diagnostics, of this run or
//! of another machine's.
//!
//! There are two levels, as in the direct mode of ccache. Under the digest of the options stand lists of the places that
//! runs have read, or where they have looked for files in vain. Each list leads to a result, by the digest of what is at the
//! places now. So nothing but reading is needed to find a result.
//!
//! *Holds:* a result depends on the bytes of everything that was read, on the program's own bytes, and on no time. What is
//! damaged, or cannot be read, is made again. A cache that cannot be written to is a warning.

mod action;
mod args;
mod remote;
mod result;
mod store;

pub(crate) use args::CacheArgs;
pub(crate) use result::Kept;
pub(crate) use store::{Kind, Store};

use crate::arguments::config::Configs;
use crate::arguments::engine::Engines;
use crate::console::Console;
use crate::digest::{Content, Digest, Hasher};
use crate::exit::Failure;
use crate::files;
use crate::trace::{Found, Place, Trace};
use action::ActionResult;
use glisten_front::diagnostic::Levels;
use prost::Message;
use remote::{Name, Remote};
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::UNIX_EPOCH;

/// Changed when the meaning of what is kept changes.
const FORMAT: &str = "glisten result 1";
/// How many lists of places are kept for the same options.
const MAX_LISTS: usize = 16;

/// The results of earlier runs.
pub(crate) struct Cache {
    store: Option<Store>,
    remote: Option<Remote>,
    limit: u64,
    is_limit_given: bool,
    /// The digest of this program.
    program: Digest,
    engines: Engines,
    /// The settings of `lint`, without the levels of the command line.
    configs: Mutex<Configs>,
    /// The state of each place, as far as it is known.
    places: Mutex<HashMap<Place, Found>>,
    /// Outputs that have been read or written.
    outputs: Mutex<HashMap<Digest, Content>>,
    failure: Mutex<Option<String>>,
    hits: AtomicUsize,
    misses: AtomicUsize,
}

impl Cache {
    /// The cache of a command, if it has one.
    ///
    /// # Errors
    /// A size or an address that is none.
    pub(crate) fn open(args: &CacheArgs, engines: Engines) -> Result<Option<Self>, Failure> {
        let store = args.folder().map(|folder| Store::new(&folder));
        let remote = args.remote().map(|address| Remote::new(&address).map_err(Failure::usage)).transpose()?;
        if store.is_none() && remote.is_none() {
            return Ok(None);
        }
        let (limit, is_limit_given) = (args.limit()?, args.given_limit().is_some());
        if let Some(store) = &store {
            store.sweep();
        }
        let failure = Mutex::new(None);
        let Some(program) = program(store.as_ref()) else { return Ok(None) };
        let (places, outputs) = (Mutex::default(), Mutex::default());
        let (hits, misses) = (AtomicUsize::new(0), AtomicUsize::new(0));
        Ok(Some(Self {
            store,
            remote,
            limit,
            is_limit_given,
            program,
            engines,
            configs: Mutex::new(Configs::new(Levels::default())),
            places,
            outputs,
            failure,
            hits,
            misses,
        }))
    }

    /// The key of a program with options, as the parts of a list.
    pub(crate) fn key(&self, parts: &[&str]) -> Digest {
        let own = Hasher::new(FORMAT).with(self.program.to_string().as_bytes());
        parts.iter().fold(own, |hasher, part| hasher.with(part.as_bytes())).finish()
    }

    /// The result that fits what is on disk now.
    pub(crate) fn find(&self, key: Digest) -> Option<Kept> {
        let found = self.find_in(&self.own_lists(key)).or_else(|| {
            let remote = self.remote_lists(key);
            let found = self.find_in(&remote)?;
            self.put_here(Kind::Result, key, &written_lists(&remote.1));
            Some(found)
        });
        let counter = if found.is_some() { &self.hits } else { &self.misses };
        counter.fetch_add(1, Ordering::Relaxed);
        found
    }

    fn find_in(&self, (key, lists): &(Digest, Vec<Vec<Place>>)) -> Option<Kept> {
        lists.iter().find_map(|places| {
            let now = places.iter().map(|place| (place, self.now(place)));
            let bytes = self.get(Name { kind: Kind::Result, digest: result_key(*key, now), bytes: None })?;
            let result = ActionResult::decode(&*bytes).ok()?;
            Kept::read(&result, |digest, bytes| self.output(digest, bytes))
        })
    }

    /// Keeps the result of a run that read what the trace says.
    pub(crate) fn keep(&self, key: Digest, trace: &Trace, kept: &Kept) {
        let Some(places) = trace.places() else { return };
        let resolved: Vec<(&Place, Found)> =
            places.iter().map(|(place, found)| (place, self.resolved(place, found))).collect();
        let list: Vec<Place> = resolved.iter().map(|(place, _)| (*place).clone()).collect();
        for (_, content) in &kept.outputs {
            let digest = content.digest();
            let is_new = self.outputs.lock().is_ok_and(|mut known| known.insert(digest, content.clone()).is_none());
            if is_new {
                self.put(Kind::Bytes, digest, content);
            }
        }
        self.put(Kind::Result, result_key(key, resolved.into_iter()), &kept.written().encode_to_vec());
        let (mut lists, known) = (self.own_lists(key).1, self.remote_lists(key).1);
        let before = lists.len();
        lists.extend(known.into_iter().filter(|one| !lists.contains(one)).collect::<Vec<_>>());
        if before == lists.len() && lists.contains(&list) {
            return;
        }
        lists.retain(|one| *one != list);
        lists.insert(0, list);
        lists.truncate(MAX_LISTS);
        self.put(Kind::Result, key, &written_lists(&lists));
    }

    /// Tells what went wrong, and keeps the folder below its limit.
    pub(crate) fn close(&self, console: &Console) {
        let failures = [
            self.failure.lock().unwrap_or_else(PoisonError::into_inner).take(),
            self.remote.as_ref().and_then(Remote::failure),
        ];
        for failure in failures.into_iter().flatten() {
            console.aside(&format!("warning: {failure}; the build goes on without it"));
        }
        let (hits, misses) = (self.hits.load(Ordering::Relaxed), self.misses.load(Ordering::Relaxed));
        if (misses > 0 || self.is_limit_given)
            && let Some(store) = &self.store
        {
            store.keep_below(self.limit);
        }
        console.remark(&format!("{hits} of {} from the cache", hits + misses));
    }

    fn own_lists(&self, key: Digest) -> (Digest, Vec<Vec<Place>>) {
        (key, lists(self.store.as_ref().and_then(|store| store.get(Kind::Result, key))))
    }

    fn remote_lists(&self, key: Digest) -> (Digest, Vec<Vec<Place>>) {
        (
            key,
            lists(
                self.remote
                    .as_ref()
                    .and_then(|remote| remote.get(Name { kind: Kind::Result, digest: key, bytes: None })),
            ),
        )
    }

    fn output(&self, digest: Digest, bytes: usize) -> Option<Content> {
        if let Some(known) = self.outputs.lock().ok()?.get(&digest) {
            return Some(known.clone());
        }
        let content = Content::known(digest, self.get(Name { kind: Kind::Bytes, digest, bytes: Some(bytes) })?);
        self.outputs.lock().ok()?.insert(digest, content.clone());
        Some(content)
    }

    fn get(&self, name: Name) -> Option<Vec<u8>> {
        let Name { kind, digest, .. } = name;
        if let Some(bytes) = self.store.as_ref().and_then(|store| store.get(kind, digest)) {
            return Some(bytes);
        }
        let bytes = self.remote.as_ref()?.get(name)?;
        self.put_here(kind, digest, &bytes);
        Some(bytes)
    }

    fn put(&self, kind: Kind, digest: Digest, bytes: &[u8]) {
        self.put_here(kind, digest, bytes);
        if let Some(remote) = &self.remote {
            remote.put(Name { kind, digest, bytes: Some(bytes.len()) }, bytes);
        }
    }

    fn put_here(&self, kind: Kind, digest: Digest, bytes: &[u8]) {
        let Some(store) = &self.store else { return };
        if let Err(error) = store.put(kind, digest, bytes) {
            let why = format!("cannot write to the cache `{}`: {error}", store.folder().display());
            self.failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(why);
        }
    }

    /// The state of a place now. It is looked up once in a run.
    fn now(&self, place: &Place) -> Found {
        let known = self.places.lock().ok().and_then(|places| places.get(place).cloned());
        known.unwrap_or_else(|| {
            let found = match place {
                Place::File(name) => {
                    files::read(name, Path::new(name)).map_or(Found::Nothing, |bytes| Found::Bytes(Digest::of(&bytes)))
                }
                Place::Kind(name) => Found::at(Path::new(name)),
                Place::Rules(folder) => self.rules(Path::new(folder)),
                Place::Settings(name) => self.settings(name),
            };
            if let Ok(mut places) = self.places.lock() {
                places.insert(place.clone(), found.clone());
            }
            found
        })
    }

    fn resolved(&self, place: &Place, found: &Found) -> Found {
        match place {
            Place::Rules(_) | Place::Settings(_) => self.now(place),
            _ => found.clone(),
        }
    }

    /// The settings of `lint` for a file. As with [`Self::rules`], paths do not matter.
    fn settings(&self, name: &str) -> Found {
        let mut configs = self.configs.lock().unwrap_or_else(PoisonError::into_inner);
        Found::Bytes(Digest::of(configs.settings(name).text_of(name).as_bytes()))
    }

    /// The files behind the rules of a folder. Their paths do not matter, so that a project may be in any folder.
    fn rules(&self, folder: &Path) -> Found {
        let Some(trace) = self.engines.trace_of_rules(folder) else { return Found::Nothing };
        let files = trace.places().unwrap_or_default().iter();
        let parts = files.map(|(_, found)| format!("{found:?}"));
        let hasher = parts.fold(Hasher::new("rules"), |hasher, part| hasher.with(part.as_bytes()));
        Found::Bytes(hasher.finish())
    }
}

/// The key of a result: the key of its options, and what is at the places.
fn result_key<'a>(key: Digest, places: impl Iterator<Item = (&'a Place, Found)>) -> Digest {
    let own = Hasher::new("places").with(key.to_string().as_bytes());
    let parts = places.map(|(place, found)| format!("{place:?} {found:?}"));
    parts.fold(own, |hasher, part| hasher.with(part.as_bytes())).finish()
}

fn written_lists(lists: &[Vec<Place>]) -> Vec<u8> {
    // Only a map whose keys are no texts could fail.
    let stdout_raw = serde_json::to_vec(lists).unwrap_or_default();
    ActionResult { stdout_raw, ..ActionResult::default() }.encode_to_vec()
}

fn lists(bytes: Option<Vec<u8>>) -> Vec<Vec<Place>> {
    let result = bytes.and_then(|bytes| ActionResult::decode(&*bytes).ok());
    result.and_then(|result| serde_json::from_slice(&result.stdout_raw).ok()).unwrap_or_default()
}

/// The digest of the program that runs: two builds of glisten never share results. A cache on disk remembers it.
fn program(store: Option<&Store>) -> Option<Digest> {
    let path = std::env::current_exe().ok()?;
    let found = fs::metadata(&path).ok()?;
    let time = found.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
    let name = format!("{} {} {}", path.display(), found.len(), time.as_nanos());
    let known =
        store.map(|store| (store, store.folder().join("programs").join(Digest::of(name.as_bytes()).to_string())));
    if let Some(digest) = known.as_ref().and_then(|(_, path)| Store::remembered(path)) {
        return Some(digest);
    }
    let digest = Digest::of(&fs::read(&path).ok()?);
    if let Some((store, path)) = known {
        // Without it, the program is read again; other failures to write are told.
        let _ = store.write(&path, format!("{digest}\n").as_bytes());
    }
    Some(digest)
}
