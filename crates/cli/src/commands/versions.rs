//! `glisten versions`: lists the versions and the extensions of GLSL that sources may ask for.
//!
//! *In:* the tables of versions, extensions, features and built-in functions. *Out:* a table, or JSON: an object with the keys
//! `versions` (`name`, `line`) and `extensions` (`name`, `desktop`, `es`, `functions`, `features`). *Not done here:* what a version
//! brings: docs/versions.md has it.

use crate::arguments::args::ResultFormat;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use clap::Args;
use glisten_front::builtin::functions;
use glisten_front::diagnostic::did_you_mean;
use glisten_front::language::{EDITIONS, EXTENSIONS, Edition, Extension, Extensions, FEATURES, Families};
use serde_json::json;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten versions", "all versions and extensions"),
    ("glisten versions GL_ARB_gpu_shader5", "what an extension brings"),
    ("glisten versions --format json", "all of it, for a script"),
];

/// List the versions and extensions of GLSL, and what an extension brings
#[derive(Args, Debug)]
pub(crate) struct VersionsArgs {
    /// Only this extension, with what it brings: `GL_ARB_gpu_shader5`
    #[arg(value_name = "EXTENSION")]
    extension: Option<String>,
    /// The format of the list
    #[arg(long, value_enum, default_value_t)]
    format: ResultFormat,
}

/// Runs the command.
pub(crate) fn run(args: &VersionsArgs, console: &Console) -> Outcome {
    let text = match (&args.extension, args.format) {
        (Some(name), ResultFormat::Human) => page(find(name)?),
        (Some(name), ResultFormat::Json) => format!("{:#}\n", object(find(name)?)),
        (None, ResultFormat::Human) => table(),
        (None, ResultFormat::Json) => {
            let versions: Vec<_> =
                EDITIONS.iter().map(|one| json!({ "name": one.name(), "line": version_line(*one) })).collect();
            let extensions: Vec<_> = sorted().into_iter().map(object).collect();
            format!("{:#}\n", json!({ "versions": versions, "extensions": extensions }))
        }
    };
    console.output(&text)?;
    Ok(Exit::Ok)
}

/// The extensions by name.
fn sorted() -> Vec<&'static Extension> {
    let mut all: Vec<&Extension> = EXTENSIONS.iter().collect();
    all.sort_by_key(|row| row.name);
    all
}

fn find(name: &str) -> Result<&'static Extension, Failure> {
    let name = name.trim();
    if name.starts_with(|first: char| first.is_ascii_digit()) {
        let failure = Failure::usage(format!("`{name}` is a version, and this takes the name of an extension"));
        return Err(failure.help("`glisten versions` names all versions; docs/versions.md tells what each brings"));
    }
    let full = if name.starts_with("GL_") { name.to_owned() } else { format!("GL_{name}") };
    EXTENSIONS.iter().find(|row| row.name == full).ok_or_else(|| {
        let failure = Failure::usage(format!("glisten does not read the extension `{full}`"));
        match did_you_mean(&full, EXTENSIONS.iter().map(|row| row.name)) {
            Some(near) => failure.help(format!("did you mean `{near}`? `glisten versions` names all of them")),
            None => failure.help("`glisten versions` names all of them"),
        }
    })
}

/// `#version 300 es`
fn version_line(edition: Edition) -> String {
    // The first version of OpenGL ES's language needs no word that says so.
    let es = if edition.es && edition.number > 100 { " es" } else { "" };
    format!("#version {}{es}", edition.number)
}

fn languages(families: Families) -> &'static str {
    match families {
        Families::Desktop => "GLSL",
        Families::Es => "GLSL ES",
        Families::Both => "GLSL, GLSL ES",
    }
}

fn table() -> String {
    let mut text = String::new();
    for edition in EDITIONS {
        text.push_str(&format!("{:14} {}\n", edition.name(), version_line(edition)));
    }
    text.push('\n');
    let width = EXTENSIONS.iter().map(|row| row.name.len()).max().unwrap_or_default();
    for row in sorted() {
        text.push_str(&format!("{:width$} {}\n", row.name, languages(row.families)));
    }
    text
}

/// Whether a set of extensions that bring something has the one.
fn has(bringing: Extensions, row: &Extension) -> bool {
    bringing.intersects(row.bit)
}

/// The names of the functions that an extension brings to versions without them.
fn brought_functions(row: &Extension) -> Vec<&'static str> {
    let brings = |name: &&str| functions::named(name).iter().any(|one| has(one.availability.extensions, row));
    functions::names().filter(brings).collect()
}

/// The rules of the language that an extension brings.
fn brought_features(row: &Extension) -> Vec<&'static str> {
    FEATURES.iter().filter(|feature| has(feature.extensions, row)).map(|feature| feature.name).collect()
}

fn page(row: &Extension) -> String {
    let mut text = format!("{} ({})\n", row.name, languages(row.families));
    for (title, list) in [("Functions", brought_functions(row)), ("Rules", brought_features(row))] {
        if !list.is_empty() {
            text.push_str(&format!("\n{title}:\n"));
            list.iter().for_each(|item| text.push_str(&format!("  {item}\n")));
        }
    }
    text
}

fn object(row: &'static Extension) -> serde_json::Value {
    json!({
        "name": row.name,
        "desktop": row.families != Families::Es,
        "es": row.families != Families::Desktop,
        "functions": brought_functions(row),
        "features": brought_features(row),
    })
}
