//! `glisten rules`: lists the lint rules with their groups, levels and fixes.
//!
//! *In:* the registry of codes. *Out:* a table, or JSON: an array of objects with the keys `code`, `name`, `group`, `level`,
//! `fixable`, `since`.

use crate::arguments::args::ResultFormat;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use clap::Args;
use glisten_front::diagnostic::{Code, Group, LintInfo, codes, did_you_mean};
use serde_json::json;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten rules", "all lint rules with their groups, levels and fixes"),
    ("glisten rules --group numerics --format json", "those of a group, for a script"),
];

/// List the lint rules: group, level, fixes
#[derive(Args, Debug)]
pub(crate) struct RulesArgs {
    /// Only the rules of this group (correctness, port, numerics, performance, style, legacy)
    #[arg(long, value_name = "GROUP")]
    group: Option<String>,
    /// The format of the list
    #[arg(long, value_enum, default_value_t)]
    format: ResultFormat,
}

/// Runs the command.
pub(crate) fn run(args: &RulesArgs, console: &Console) -> Outcome {
    let group = args.group.as_deref().map(|name| Group::find(name.trim()).ok_or_else(|| unknown(name))).transpose()?;
    let mut rules: Vec<(&Code, LintInfo)> = codes::all().filter_map(|code| Some((code, code.lint?))).collect();
    rules.retain(|(_, lint)| group.is_none_or(|group| lint.group == group));
    rules.sort_by_key(|(code, lint)| (lint.group, code.id));
    console.output(&if args.format == ResultFormat::Json { as_json(&rules) } else { as_table(&rules) })?;
    Ok(Exit::Ok)
}

fn unknown(name: &str) -> Failure {
    let names = || Group::ALL.into_iter().map(Group::name);
    let failure = Failure::usage(format!("there is no group `{name}`"));
    match did_you_mean(&name.trim().to_ascii_lowercase(), names()) {
        Some(near) => failure.help(format!("did you mean `{near}`?")),
        None => failure.help(format!("there are {}", names().collect::<Vec<_>>().join(", "))),
    }
}

fn as_json(rules: &[(&Code, LintInfo)]) -> String {
    let row = |(code, lint): &(&Code, LintInfo)| {
        json!({
            "code": code.id,
            "name": code.name,
            "group": lint.group.name(),
            "level": lint.level.name(),
            "fixable": lint.fixable.name(),
            "since": lint.since,
        })
    };
    let rows: Vec<_> = rules.iter().map(row).collect();
    format!("{:#}\n", serde_json::Value::Array(rows))
}

fn as_table(rules: &[(&Code, LintInfo)]) -> String {
    let width = rules.iter().map(|(code, _)| code.name.len()).max().unwrap_or_default();
    let head = ("code", "name", "group", "level", "fixable", "since");
    let line = |code: &str, name: &str, group: &str, level: &str, fixable: &str, since: &str| {
        format!("{code:6} {name:width$} {group:12} {level:6} {fixable:8} {since}\n")
    };
    let mut text = line(head.0, head.1, head.2, head.3, head.4, head.5);
    for (code, lint) in rules {
        let (group, level) = (lint.group.name(), lint.level.name());
        text.push_str(&line(code.id, code.name, group, level, lint.fixable.name(), lint.since));
    }
    text
}
