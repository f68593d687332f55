//! Pictures for the language server, each drawn by another process.
//!
//! *In:* a scene file. *Out:* a process, and the picture's file once it is finished. *Holds:* the process ends with its time or when it is
//! killed; the file is the same for the same scene.

use crate::digest::Hasher;
use crate::files;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// How long a picture may take, in seconds.
const TIMEOUT: &str = "60";
/// How often it is looked whether a picture is finished.
const STEP: Duration = Duration::from_millis(20);

/// The processes that draw.
pub(crate) type Drawing = Arc<Mutex<Vec<Arc<Mutex<Child>>>>>;

/// Starts to draw a scene. The process, and the file that it writes.
pub(crate) fn start(scene: &Path) -> Result<(Arc<Mutex<Child>>, PathBuf), String> {
    let folder = std::env::temp_dir().join(concat!("glisten-", env!("CARGO_PKG_VERSION")));
    std::fs::create_dir_all(&folder).map_err(|error| format!("cannot make `{}`: {error}", folder.display()))?;
    let digest = Hasher::new("picture").with(scene.to_string_lossy().as_bytes()).finish();
    let path = folder.join(format!("{digest}.png"));
    let program = std::env::current_exe().map_err(|error| format!("the program cannot be found: {error}"))?;
    let mut command = Command::new(program);
    command
        .arg("render")
        .arg(scene)
        .arg("-o")
        .arg(&path)
        .args(["--backend", "cpu", "--timeout", TIMEOUT, "-q"])
        .args(files::sandbox());
    let child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
    let child = child.map_err(|error| format!("the scene cannot be drawn: {error}"))?;
    Ok((Arc::new(Mutex::new(child)), path))
}

/// Waits for a picture. Its file, or what was said.
pub(crate) fn finished(child: &Arc<Mutex<Child>>, path: PathBuf) -> Result<PathBuf, String> {
    let messages = child.lock().unwrap_or_else(PoisonError::into_inner).stderr.take();
    let reader = thread::spawn(move || {
        let mut text = String::new();
        // What cannot be read is not told.
        let _ = messages.map(|mut messages| std::io::Read::read_to_string(&mut messages, &mut text));
        text
    });
    let status = loop {
        let status = child.lock().unwrap_or_else(PoisonError::into_inner).try_wait();
        match status {
            Ok(Some(status)) => break status,
            Ok(None) => thread::sleep(STEP),
            Err(error) => return Err(format!("the scene cannot be drawn: {error}")),
        }
    };
    let text = reader.join().unwrap_or_default();
    if status.success() { Ok(path) } else { Err(text.trim().to_owned()) }
}
