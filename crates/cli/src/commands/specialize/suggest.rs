//! `glisten specialize --suggest`: which uniforms are worth fixing.

use crate::arguments::args::ResultFormat;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::scenes::{DrawError, MachineArgs};
use glisten_page::words::grouped;
use glisten_scene::Scene;
use glisten_verify::specialize::{Point, Suggestion, suggest};

/// The width of the longest bar of the curve.
const BAR: u64 = 40;

/// Measures and prints.
pub(crate) fn run(
    scenes: Vec<(String, Scene)>,
    dynamic: &[String],
    machine: &MachineArgs,
    (format, console): (ResultFormat, &Console),
) -> Outcome {
    let dynamic = dynamic.to_vec();
    let measured = machine.within_time(move || {
        let scenes: Vec<(String, &Scene)> = scenes.iter().map(|(name, scene)| (name.clone(), scene)).collect();
        Ok(suggest(&scenes, &dynamic, &mut |_, _| {})?)
    });
    let suggestion = match measured {
        Ok(suggestion) => suggestion,
        Err(DrawError::Failure(failure)) => return Err(failure),
        Err(DrawError::Diagnostics(found)) => {
            let message = found.first().map_or_else(String::new, |found| found.message.clone());
            return Err(Failure::new(Exit::Content, format!("a scene cannot be drawn: {message}")));
        }
    };
    match format {
        ResultFormat::Json => {
            let json = serde_json::to_string_pretty(&suggestion).expect("a suggestion is always JSON") + "\n";
            console.output(&json)?;
        }
        ResultFormat::Human => console.output(&text(&suggestion))?,
    }
    Ok(Exit::Ok)
}

/// The ranking and the curve.
fn text(suggestion: &Suggestion) -> String {
    let Suggestion { scenes, operations_none: none, operations_all: all, uniforms, curve } = suggestion;
    let mut text = format!(
        "{} scenes: {} operations with no uniform fixed, {} with all\n\n",
        scenes.len(),
        grouped(*none),
        grouped(*all)
    );
    // The names of the curve are two longer.
    let longest = uniforms.iter().map(|one| one.name.chars().count() + 2).chain([12]).max().unwrap_or(12);
    text.push_str(&format!(
        "{:longest$}  {:>14}  {:>7}  {:>6}  {:>18}\n",
        "uniform", "saves", "share", "values", "programs without"
    ));
    for one in uniforms {
        let share = if *none == 0 { 0.0 } else { one.saves as f64 * 100.0 / *none as f64 };
        text.push_str(&format!(
            "{:longest$}  {:>14}  {share:>5.1} %  {:>6}  {:>18}\n",
            one.name,
            grouped(one.saves),
            one.values,
            one.variants_without
        ));
    }
    text.push_str(&format!("\n{:longest$}  {:>8}  {:>14}\n", "fixed so far", "programs", "operations"));
    for Point { fixed, variants, operations } in curve {
        let name = fixed.as_ref().map_or_else(|| "none".to_owned(), |name| format!("+ {name}"));
        let bar = "#".repeat((operations * BAR).checked_div(*none).unwrap_or(0).min(BAR) as usize);
        text.push_str(&format!("{name:longest$}  {variants:>8}  {:>14}  {bar}\n", grouped(*operations)));
    }
    text
}
