//! `play`: the answers of the page of `glisten play`, for files that the page holds.
//!
//! *Holds:* the last pictures stay in the instance, for questions about single pixels, and so do the programs. What the browser draws by WebGPU comes as planes of bytes.

use crate::includes::Asked;
use crate::reply::Reply;
use crate::request::Request;
use glisten::scene::{FileError, FileSource};
use glisten_binding::{Error, joined};
use glisten_play as play;
use glisten_play::{Job, Kept, OwnLevels, Pictures, Wish, answer};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

thread_local! {
    static STATE: RefCell<(Pictures, Kept)> = RefCell::default();
}

/// The files of the page; texts that were changed there count instead.
struct Held(BTreeMap<String, Vec<u8>>);

impl Held {
    /// The files as texts, for includes.
    fn texts(&self) -> BTreeMap<String, String> {
        self.0.iter().map(|(name, bytes)| (name.clone(), String::from_utf8_lossy(bytes).into_owned())).collect()
    }
}

impl FileSource for Held {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        self.0.get(&joined("", path)).cloned().ok_or(FileError::Missing)
    }
}

/// Answers a job of the page.
pub(crate) fn play(request: &Request, blob: &[u8]) -> Result<Reply, Error> {
    let job: Job = serde_json::from_value(request.job.clone())
        .map_err(|error| Error::argument(format!("the job is not understood: {error}")))?;
    let mut files = request.files(blob)?;
    files.extend(job.texts.iter().map(|(name, text)| (joined("", name), text.clone().into_bytes())));
    let held = Arc::new(Held(files));
    let (mut settings, _) = request.settings()?;
    let (asked, folders) = (Asked::new(false), request.folders.clone());
    let (files, texts) = (Arc::clone(&held), OnceLock::new());
    settings.includes.ask = Some(Arc::new(move |path, angled, from| {
        asked.resolve_in(&folders, texts.get_or_init(|| files.texts()), &[], path, angled, from)
    }));
    let compiler = settings.compiler().without_levels();
    let load = |kept: &mut Kept| kept.load(&job.scene, &*held, &compiler);
    let mut reply = Reply::default();
    let answered = STATE.with_borrow_mut(|(pictures, kept)| match &job.wish {
        Wish::Plan => play::plan(load(kept), kept).map(|plan| {
            let bytes = reply.bytes(&plan.bytes);
            reply.set("bytes_of_answer", bytes);
            plan.calls
        }),
        Wish::Show { by } => play::show(load(kept), request.planes(blob), by, pictures),
        Wish::JudgeShown { by, positions } => {
            play::compare(load(kept), request.planes(blob), (by, *positions), pictures)
        }
        _ => answer(&job, &mut OwnLevels, pictures, |_| load(kept)),
    });
    reply.set("answer", answered.map_err(Error::content)?);
    Ok(reply)
}
