//! [`library_page`]: what `glisten stability --library` found, as a page.
//!
//! *In:* the functions of the library with their figures. *Out:* HTML. *Holds:* those that are not sound are first.

use super::super::library::{FunctionFound, Naive, Verdict};
use super::words::number;
use glisten_page::Page;
use minijinja::{Value, context};

const LIBRARY: Page = Page {
    templates: &[("library.html", include_str!("library.html"))],
    styles: &[
        ".listed { border: 1px solid var(--rule); border-radius: 10px; background: var(--card); padding: .4rem .9rem; }\n",
    ],
    scripts: &[],
};

/// The page of these functions, which `command` examined.
///
/// # Errors
/// The message of the template engine, which only a broken template causes.
pub fn library_page(found: &[FunctionFound], command: &str) -> Result<String, String> {
    let mut order: Vec<&FunctionFound> = found.iter().collect();
    order.sort_by_key(|one| one.is_sound());
    let unsound = found.iter().filter(|one| !one.is_sound()).count();
    let calls = found.iter().map(|one| one.cases).sum::<usize>() as u64;
    let values = context! {
        version => env!("CARGO_PKG_VERSION"),
        command,
        count => found.len(),
        unsound,
        calls => glisten_page::words::grouped(calls),
        functions => order.into_iter().map(function).collect::<Vec<_>>(),
    };
    LIBRARY.render(values).map_err(|error| error.to_string())
}

fn function(found: &FunctionFound) -> Value {
    let (verdict, pill) = match found.verdict {
        Verdict::Stable => ("stable", "good"),
        Verdict::Degraded => ("degraded", "fair"),
        Verdict::Broken => ("broken", "bad"),
    };
    let bound = found.bound.as_ref();
    let at = found.at.iter().map(|(name, values)| format!("{name} = {values:?}")).collect::<Vec<_>>().join(", ");
    context! {
        module => found.module,
        signature => &found.signature,
        verdict,
        pill,
        is_sound => found.is_sound(),
        error => number(found.figures.unexplained),
        bound => bound.map(|bound| format!("{} {}", number(bound.error), bound.unit.name())),
        reason => bound.map(|bound| bound.reason.as_str()).unwrap_or_default(),
        max_abs => number(found.figures.max_abs),
        condition => number(found.figures.condition),
        naive => found.naive.as_ref().map(naive),
        cost => found.cost.map(number),
        at,
    }
}

fn naive(naive: &Naive) -> Value {
    context! { form => &naive.form, error => number(naive.figures.unexplained), non_finite => naive.figures.non_finite }
}
