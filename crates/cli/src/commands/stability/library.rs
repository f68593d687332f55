//! `glisten stability --library`: every function of the library over its stiff and extreme inputs.

use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::made::made;
use crate::progress::Progress;
use glisten_stability::library::{FunctionFound, LibraryOptions, Naive, Verdict, examine_library};
use glisten_stability::page::{PAGE, library_page};
use serde::Serialize;
use std::path::Path;

/// The form of the JSON.
#[derive(Serialize)]
struct Found<'a> {
    functions: &'a [FunctionFound],
}

/// The options of the command line.
pub(crate) struct LibraryArgs<'a> {
    /// Only this module or function.
    pub(crate) only: Option<&'a str>,
    /// The number of calls of each function.
    pub(crate) cases: usize,
    pub(crate) is_json: bool,
    /// The folder for the page and the JSON.
    pub(crate) output: Option<&'a Path>,
}

/// Runs the command.
pub(crate) fn run(args: &LibraryArgs<'_>, console: &Console) -> Outcome {
    let progress = Progress::new(console, 0).unless(args.is_json);
    let mut step = |done: usize, of: usize, name: &str| {
        progress.reach(done, of);
        progress.say(name);
    };
    let mut options = LibraryOptions { cases: args.cases, only: args.only, progress: &mut step };
    let found = examine_library(&mut options).map_err(|error| Failure::new(Exit::Content, error.message))?;
    drop(progress);
    if found.is_empty() {
        let failure = Failure::usage(format!("the library has no `{}`", args.only.unwrap_or_default()));
        return Err(failure.help("`glisten lib list` names all modules"));
    }
    // Numbers, strings and lists only: serialization has nothing to reject.
    let json = || serde_json::to_string_pretty(&Found { functions: &found }).unwrap_or_default() + "\n";
    let text = if args.is_json { json() } else { table(&found) };
    if let Some(folder) = args.output {
        files::make_folder(folder)?;
        let html = library_page(&found, &made().command);
        let html = html.map_err(|error| Failure::new(Exit::Content, format!("internal error: {error}")))?;
        files::write(&folder.join("stability.json"), json().as_bytes())?;
        files::write(&folder.join(PAGE), html.as_bytes())?;
    }
    console.output(&text)?;
    if let Some(folder) = args.output {
        console.remark(&format!("wrote {}", folder.join(PAGE).display()));
    }
    Ok(if found.iter().all(FunctionFound::is_sound) { Exit::Ok } else { Exit::Content })
}

fn name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Stable => "stable",
        Verdict::Degraded => "degraded",
        Verdict::Broken => "broken",
    }
}

fn table(found: &[FunctionFound]) -> String {
    let width = found.iter().map(|found| name_of(found).len()).max().unwrap_or(0);
    let mut text = format!(
        "{:width$}  {:8}  {:>8}  {:>11}  {:>8}  {:>9} | {:>8}  {:>10}  {:>5}\n",
        "function", "verdict", "error", "bound", "max abs", "condition", "naive", "not finite", "cost"
    );
    for found in found {
        let bound = found
            .bound
            .as_ref()
            .map_or_else(|| "none".to_owned(), |bound| format!("{:.0e} {}", bound.error, bound.unit.name()));
        let figures = &found.figures;
        text += &format!(
            "{:width$}  {:8}  {:8.1e}  {bound:>11}  {:8.1e}  {:9.1e} | {}\n",
            name_of(found),
            name(found.verdict),
            figures.unexplained,
            figures.max_abs,
            figures.condition,
            naive(found.naive.as_ref(), found.cost)
        );
    }
    for found in found.iter().filter(|found| !found.is_sound()) {
        text += &format!("\n{}: {}\n  {}\n", found.signature, complaint(found), arguments(found));
    }
    let reasons = found.iter().filter_map(|found| Some((&found.signature, found.bound.as_ref()?)));
    let reasons: Vec<String> = reasons
        .filter(|(_, bound)| !bound.reason.is_empty())
        .map(|(signature, bound)| format!("  {signature}: {}\n", bound.reason))
        .collect();
    if !reasons.is_empty() {
        text += &format!("\nReasons for errors above rounding:\n{}", reasons.concat());
    }
    let calls: usize = found.iter().map(|found| found.cases).sum();
    text + &format!(
        "\n{} functions, {calls} calls. error: beyond four times the change by moving the inputs an ULP; max abs: the largest error in \
         all; condition: by\nhow much relative errors of the inputs grow there. naive: the same for the literal form, with the \
         number of its results that are not\nfinite (those in parentheses have no exact value either); cost: operations as a \
         multiple of the naive form's.\n",
        found.len()
    )
}

/// A function's name, or a program with its scene.
fn name_of(found: &FunctionFound) -> &str {
    if found.signature.starts_with(&format!("{} (", found.function)) { &found.signature } else { &found.function }
}

fn naive(naive: Option<&Naive>, cost: Option<f64>) -> String {
    let Some(naive) = naive else { return "-".to_owned() };
    let finite = match naive.undefined {
        0 => format!("{}", naive.figures.non_finite),
        undefined => format!("{} ({undefined})", naive.figures.non_finite),
    };
    let cost = cost.map_or_else(|| "-".to_owned(), |cost| format!("{cost:.2}"));
    format!("{:8.1e}  {finite:>10}  {cost:>5}", naive.figures.unexplained)
}

fn complaint(found: &FunctionFound) -> String {
    let figures = &found.figures;
    match () {
        () if figures.non_finite > 0 => format!("{} results are not finite", figures.non_finite),
        () if figures.another > 0 => format!("{} results are different in f32", figures.another),
        () if found.bound.is_none() => "it has no bound".to_owned(),
        () => format!("its error is {:.2e}, above its bound", figures.unexplained),
    }
}

fn arguments(found: &FunctionFound) -> String {
    let each: Vec<String> = found.at.iter().map(|(name, values)| format!("{name} = {values:?}")).collect();
    each.join(", ")
}
