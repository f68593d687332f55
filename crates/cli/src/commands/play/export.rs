//! `--export`: one page that shows a scene and needs neither a server nor a network.
//!
//! *In:* a scene. *Out:* an HTML file with its sources, findings, translations, pictures and verdict. *Holds:* the page is that of
//! the server, with answers in place of questions; what would need a program to compute is turned off, and the page says so. The same
//! call writes the same bytes: no times are in it.

use super::PlayArgs;
use super::driver::Driver;
use super::page::page;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::overwrite;
use crate::progress::Progress;
use crate::scenes::SceneArgs;
use glisten_emit::Target;
use glisten_play::{Job, OwnLevels, Pictures, Shown, Wish, answer, look, told};
use glisten_verify::scene;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::path::Path;

/// Writes the page.
pub(super) fn run(args: &PlayArgs, output: &Path, console: &Console) -> Outcome {
    if Path::new(&args.start).is_dir() {
        let failure = Failure::usage(format!("`{}` is a folder, and a page shows one scene", args.start));
        return Err(failure.help("name the scene: `glisten play --export page.html scene.toml`"));
    }
    overwrite::note(Path::new(&args.start));
    files::check_writable(output)?;
    let progress = Progress::new(console, 3);
    let of = SceneArgs::of(&args.start, &args.machine, &args.sources, &args.levels);
    let read = match of.read(console)? {
        Ok(read) => read,
        Err(exit) => return Ok(exit),
    };
    progress.say("drawing");
    let (scene, sources) = (read.scene.clone(), read.sources().clone());
    let by_reference = scene.clone();
    let (mut pictures, drawn) = of
        .within_time(move || {
            let mut pictures = Pictures::default();
            let drawn = pictures.reference(&by_reference);
            Ok((pictures, drawn))
        })
        .map_err(failure)?;
    let drawn = drawn.map_err(|error| Failure::new(Exit::Content, error))?;
    progress.step();
    progress.say("judging");
    let machine = args.machine.clone();
    // A machine without a GPU has the reference's picture alone, and the page says why.
    let judged = of.within_time(move || Ok(Driver::default().compare(&scene, &sources, &machine, &mut pictures)));
    let judged = match judged {
        Ok(judged) => judged.unwrap_or_else(|error| json!({ "error": error })),
        Err(error) => return Err(failure(error)),
    };
    progress.step();
    let start = json!({
        "mode": "export",
        "scene": args.start,
        "look": looks(args, &of, console)?,
        "drawn": drawn,
        "judged": judged,
        "studies": studies(args, &of, console)?,
    });
    let title = Path::new(&args.start).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let html = page(&title.unwrap_or_default(), start).map_err(|error| Failure::new(Exit::Content, error))?;
    drop(progress);
    files::write(output, html.as_bytes())?;
    console.remark(&format!("wrote {}", output.display()));
    read.finish(Vec::new())
}

/// The texts of the page, with the programs in every language, whole and without what the picture does not need.
fn looks(args: &PlayArgs, of: &SceneArgs, console: &Console) -> Result<Value, Failure> {
    let (mut first, mut programs) = (Value::Null, Map::new());
    for target in Target::ALL.iter().copied().filter(|target| target.is_text()) {
        for leaves_out in [false, true] {
            let mut session = of.session(console)?;
            let loaded = scene::load(&args.start, &files::SceneFiles, session.compiler());
            let (mut answer, _) = look(&mut session, &args.start, loaded, Shown { target, leaves_out });
            let made = answer.get_mut("programs").map(Value::take).unwrap_or_default();
            programs.insert(format!("{}{}", target.word(), if leaves_out { "-left-out" } else { "" }), made);
            first = answer;
        }
    }
    if let Some(first) = first.as_object_mut() {
        first.insert("by_target".into(), programs.into());
    }
    Ok(first)
}

/// The studies of the page: needs, and harm by f32; the reason where there is no answer.
fn studies(args: &PlayArgs, of: &SceneArgs, console: &Console) -> Result<Value, Failure> {
    let mut told = Map::new();
    for (name, wish) in [("needs", Wish::Needs), ("stability", Wish::Stability)] {
        let session = of.session(console)?;
        let loaded = scene::load(&args.start, &files::SceneFiles, session.compiler());
        let job = Job { scene: args.start.clone(), texts: BTreeMap::new(), wish };
        let answered = of.within_time(move || {
            Ok(answer(&job, &mut OwnLevels, &mut Pictures::default(), |_| loaded)
                .unwrap_or_else(|error| json!({ "error": error })))
        });
        let answered = answered.unwrap_or_else(|error| json!({ "error": failure(error).message }));
        told.insert(name.to_owned(), answered);
    }
    Ok(told.into())
}

fn failure(error: crate::scenes::DrawError) -> Failure {
    match error {
        crate::scenes::DrawError::Failure(failure) => failure,
        crate::scenes::DrawError::Diagnostics(diagnostics) => Failure::new(Exit::Content, told(&diagnostics)),
    }
}
