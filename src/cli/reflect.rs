//! `glisten reflect`: what a host needs to know about a program, as a table or as JSON, or what one name is.

use super::args::{BindingArgs, ConventionArgs, LevelArgs, ProgramArgs, ResultFormat, SourceArgs};
use super::console::Console;
use super::examples::Examples;
use super::exit::{Exit, Outcome};
use super::inputs;
use super::optimize::{self, OptimizeArgs};
use super::outputs::files_of_stages;
use super::session::{Session, Unit};
use clap::Args;
use glisten_emit::reflection::{Found, Match, find, table};
use glisten_emit::{Conventions, Emitted, Reflection, Target, emit, reflect};
use glisten_front::link::Program;
use indexmap::IndexMap;
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Examples of its use.
pub(super) const EXAMPLES: Examples = &[
    ("glisten reflect a.vert a.frag", "attributes, uniforms, blocks, textures and outputs as a table"),
    ("glisten reflect a.vert a.frag --format json", "the same for a program"),
    ("glisten reflect a.vert a.frag --find light.position", "one name, as glGetUniformLocation"),
];

/// Show what a host needs to know: attributes, varyings, outputs, blocks, uniforms, samplers
#[derive(Args, Debug)]
pub(super) struct ReflectArgs {
    /// Shaders, or `-` for standard input
    #[arg(required_unless_present = "programs", value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The format of the reflection
    #[arg(long, value_enum, default_value_t)]
    format: ResultFormat,
    /// Show what a name is, and its location
    #[arg(long, value_name = "NAME")]
    find: Option<String>,
    /// List each element of large arrays of structs
    #[arg(long)]
    flat: bool,
    #[command(flatten)]
    optimize: OptimizeArgs,
    #[command(flatten)]
    programs: ProgramArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    bindings: BindingArgs,
    #[command(flatten)]
    conventions: ConventionArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

/// A program with its reflection.
struct Reflected<'a> {
    /// The stem, with its folder if two programs share the stem.
    name: String,
    program: &'a Program,
    reflection: Reflection,
}

/// Runs the command.
pub(super) fn run(args: &ReflectArgs, console: &Console) -> Outcome {
    let inputs = inputs::collect(&args.files, &args.programs, &args.sources, false)?;
    let mut session = Session::new(console, &args.sources, &args.bindings, &args.levels, 0)?;
    let units = session.compile(inputs.groups);
    let exit = session.tell_units(&units, false)?;
    let optimizes = args.optimize.applies(Target::Wgsl, false);
    let mut reflected = reflect_all(&units, &args.conventions.conventions(false), optimizes);
    if reflected.is_empty() {
        return Ok(exit.max(Exit::Content));
    }
    if let Some(name) = &args.find {
        return find_in(&reflected, name, args.format, console).map(|found| found.max(exit));
    }
    if !args.flat {
        reflected.iter_mut().for_each(|row| row.reflection.compact());
    }
    let several = units.len() > 1;
    let text = match args.format {
        ResultFormat::Human => tables(&reflected, several),
        ResultFormat::Json => json(&reflected, several),
    };
    console.output(&text)?;
    Ok(exit)
}

fn reflect_all<'a>(units: &'a [Unit], conventions: &Conventions, optimizes: bool) -> Vec<Reflected<'a>> {
    let shared = |name: &str| units.iter().filter(|unit| unit.group.name == name).count() > 1;
    let sound = units.iter().filter_map(|unit| Some((unit, unit.sound_program()?)));
    sound
        .map(|(unit, program)| {
            let path = unit.group.inputs.first().and_then(|input| input.path.as_ref());
            let folder = path.and_then(|path| path.parent()).map(|folder| folder.to_string_lossy().into_owned());
            let name = match folder {
                Some(folder) if shared(&unit.group.name) && !folder.is_empty() => {
                    format!("{folder}/{}", unit.group.name)
                }
                _ => unit.group.name.clone(),
            };
            let optimized = optimize::optimized(program, optimizes);
            let mut reflection = reflect(&optimized, conventions);
            for shader in &optimized.stages {
                if let Ok(Emitted::Text(text)) = emit(&optimized, shader.stage, Target::Wgsl, conventions) {
                    reflection.name_in_wgsl(&text);
                }
            }
            // The same as what `compile` writes by default.
            reflection.files = files_of_stages(&unit.group, &BTreeSet::from([Target::Wgsl, Target::Spirv]), false);
            Reflected { name, program, reflection }
        })
        .collect()
}

fn tables(reflected: &[Reflected<'_>], several: bool) -> String {
    let one = |row: &Reflected<'_>| {
        let head = if several { format!("== {}\n\n", row.name) } else { String::new() };
        head + &table(&row.reflection)
    };
    reflected.iter().map(one).collect::<Vec<_>>().join("\n")
}

fn json(reflected: &[Reflected<'_>], several: bool) -> String {
    let text = match reflected {
        [only] if !several => serde_json::to_string_pretty(&only.reflection),
        all => {
            let by_stem: IndexMap<&str, &Reflection> =
                all.iter().map(|row| (row.name.as_str(), &row.reflection)).collect();
            serde_json::to_string_pretty(&by_stem)
        }
    };
    text.expect("a reflection is always JSON") + "\n"
}

/// The answer for one program, as JSON.
#[derive(Serialize)]
struct Answer<'a> {
    program: &'a str,
    found: Vec<Match>,
    nearest: Option<String>,
}

fn find_in(reflected: &[Reflected<'_>], name: &str, format: ResultFormat, console: &Console) -> Outcome {
    let answer = |row: &'_ Reflected<'_>| match find(row.program, &row.reflection, name) {
        Found::Known(found) => (found, None),
        Found::Unknown { nearest } => (Vec::new(), nearest),
    };
    let answers: Vec<Answer<'_>> = reflected
        .iter()
        .map(|row| {
            let (found, nearest) = answer(row);
            Answer { program: &row.name, found, nearest }
        })
        .collect();
    let exit = if answers.iter().all(|answer| answer.found.is_empty()) { Exit::Content } else { Exit::Ok };
    if format == ResultFormat::Json {
        let text = serde_json::to_string_pretty(&answers).expect("an answer is always JSON");
        console.output(&(text + "\n"))?;
        return Ok(exit);
    }
    if exit == Exit::Content {
        let nearest = answers.into_iter().find_map(|answer| answer.nearest);
        let help = nearest.map(|near| format!("did you mean `{near}`?"));
        console.failure(&format!("there is no `{name}` in the program"), help.as_deref());
        return Ok(exit);
    }
    let several = reflected.len() > 1;
    let lines = answers.iter().flat_map(|answer| answer.found.iter().map(move |found| (answer.program, found)));
    let lines = lines.map(|(program, found)| {
        let indent = if found.part { "  " } else { "" };
        match several {
            true => format!("{program}: {indent}{}\n", found.description),
            false => format!("{indent}{}\n", found.description),
        }
    });
    console.output(&lines.collect::<String>())?;
    Ok(exit)
}
