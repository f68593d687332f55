//! `glisten reflect`: what a host needs to know about a program, as a table or as JSON, or what one name is.

use super::args::{BindingArgs, ConventionArgs, LevelArgs, ProgramArgs, ResultFormat, SourceArgs};
use super::console::Console;
use super::exit::{Exit, Outcome};
use super::inputs;
use super::optimize::{self, OptimizeArgs};
use super::session::{Session, Unit};
use clap::Args;
use glisten_emit::reflection::{Found, find, table};
use glisten_emit::{Conventions, Reflection, Target, reflect};
use glisten_front::link::Program;
use indexmap::IndexMap;

/// Show what a host needs to know: attributes, varyings, outputs, blocks, uniforms, samplers
#[derive(Args, Debug)]
pub(super) struct ReflectArgs {
    /// Shaders, or `-` for standard input
    #[arg(required_unless_present = "programs", value_name = "FILE")]
    files: Vec<String>,
    /// The format of the reflection
    #[arg(long, value_enum, default_value_t)]
    format: ResultFormat,
    /// Show what a name is, and its location
    #[arg(long, value_name = "NAME")]
    find: Option<String>,
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
    let inputs = inputs::collect(&args.files, &args.programs, false)?;
    let mut session = Session::new(console, &args.sources, &args.bindings, &args.levels, 0)?;
    let units = session.compile(inputs.groups);
    let exit = session.tell_units(&units, false)?;
    let optimizes = args.optimize.applies(Target::Wgsl, false);
    let reflected = reflect_all(&units, &args.conventions.conventions(false), optimizes);
    if reflected.is_empty() {
        return Ok(exit.max(Exit::Content));
    }
    if let Some(name) = &args.find {
        return find_in(&reflected, name, console).map(|found| found.max(exit));
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
            let reflection = reflect(&optimize::optimized(program, optimizes), conventions);
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

fn find_in(reflected: &[Reflected<'_>], name: &str, console: &Console) -> Outcome {
    let mut lines = Vec::new();
    let mut nearest_name = None;
    for row in reflected {
        match find(row.program, &row.reflection, name) {
            Found::Known(found) if reflected.len() > 1 => {
                lines.extend(found.into_iter().map(|line| format!("{}: {line}", row.name)));
            }
            Found::Known(found) => lines.extend(found),
            Found::Unknown { nearest } => nearest_name = nearest_name.or(nearest),
        }
    }
    if lines.is_empty() {
        let help = nearest_name.map(|near| format!("did you mean `{near}`?"));
        console.failure(&format!("there is no `{name}` in the program"), help.as_deref());
        return Ok(Exit::Content);
    }
    console.output(&(lines.join("\n") + "\n"))?;
    Ok(Exit::Ok)
}
