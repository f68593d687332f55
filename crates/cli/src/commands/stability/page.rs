//! `-o DIR`: the page and the JSON of `glisten stability`.
//!
//! *In:* what was found in each scene. *Out:* `DIR/stability.html` and `DIR/stability.json`. *Holds:* the same bytes on every
//! run, whatever the folder.

use super::{Done, StabilityArgs, json_of};
use crate::console::Console;
use crate::exit::{Exit, Failure};
use crate::files;
use glisten_front::diagnostic::Diagnostic;
use glisten_page::made::shell_word;
use glisten_stability::page::{PAGE, SceneOnPage, Series, page};
use glisten_stability::sweep::Parameter;
use std::path::Path;

/// The name of the JSON.
const JSON: &str = "stability.json";

/// Writes both files.
pub(super) fn write(folder: &Path, args: &StabilityArgs, done: &[Done<'_>], console: &Console) -> Result<(), Failure> {
    files::make_folder(folder)?;
    let scenes = done.iter().map(|done| {
        let series = series(done).map_err(|found| undrawn(&done.result.scene, &found))?;
        Ok(SceneOnPage {
            name: &done.result.scene,
            command: command(args, done),
            scene: &done.result.examined_scene,
            sources: done.read.sources(),
            findings: &done.result.findings,
            examined: &done.examined,
            bound: done.result.bound,
            series,
        })
    });
    let scenes: Vec<SceneOnPage<'_>> = scenes.collect::<Result<_, Failure>>()?;
    let html = page(&scenes).map_err(|error| Failure::new(Exit::Content, format!("internal error: {error}")))?;
    let path = folder.join(PAGE);
    files::write(&folder.join(JSON), json_of(args, done).as_bytes())?;
    files::write(&path, html.as_bytes())?;
    console.remark(&format!("wrote {}", path.display()));
    Ok(())
}

fn undrawn(scene: &str, found: &[Diagnostic]) -> Failure {
    let why = found.first().map_or("", |diagnostic| diagnostic.message.as_str());
    Failure::new(Exit::Content, format!("`{scene}` cannot be drawn again for the page: {why}"))
}

/// The pictures of a sweep or a search.
fn series(done: &Done<'_>) -> Result<Option<Series>, Vec<Diagnostic>> {
    let scene = &done.read.scene;
    if let Some(stiff) = &done.result.stiff {
        let changed = stiff.changed.iter().map(|one| (one.name.clone(), one.value.clone()));
        return Series::of_search(scene, &stiff.scene, changed.collect(), stiff.drawings).map(Some);
    }
    let Some(sweep) = &done.result.sweep else { return Ok(None) };
    let names = sweep.worst.values.keys();
    let parameters: Vec<Parameter> = names.filter_map(|name| Parameter::find(scene, name).ok()).collect();
    Series::of_sweep(scene, &parameters, &sweep.points, &sweep.worst).map(Some)
}

/// The command that examines one scene in the same way.
fn command(args: &StabilityArgs, done: &Done<'_>) -> String {
    let mut words = vec!["glisten".to_owned(), "stability".to_owned(), shell_word(&done.result.scene)];
    for sweep in &args.sweeps {
        // All digits, and a power of ten rather than hundreds of zeros.
        let text = format!("{}={:?}..{:?}:{}", sweep.name, sweep.low, sweep.high, sweep.count);
        words.extend(["--sweep".to_owned(), shell_word(&text)]);
    }
    if let Some(bound) = args.bound {
        words.push(format!("--bound {bound:?}"));
    }
    if let Some(share) = args.bound_relative {
        words.push(format!("--bound-relative {share:?}"));
    }
    for (set, word) in
        [(args.stiff, "--stiff"), (args.all, "--all"), (args.exact, "--exact"), (args.sources.strict, "--strict")]
    {
        words.extend(set.then(|| word.to_owned()));
    }
    for (name, value) in &args.sources.defines {
        words.extend(["-D".to_owned(), shell_word(&format!("{name}={value}"))]);
    }
    for folder in &args.sources.include_dirs {
        words.extend(["-I".to_owned(), shell_word(&folder.display().to_string())]);
    }
    words.join(" ")
}
