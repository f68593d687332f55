//! [`tree`]: many programs that share files, rewritten together: each file once, for all programs that read it.
//!
//! *In:* programs that compile, and what their host wants. *Out:* new texts; for each program that is left out, why. *Holds:* a program
//! that is left out does not change what others get. The new texts of all others compile.

use super::check::check;
use super::chunks::Chunks;
use super::conditions::Conditions;
use super::coordinates;
use super::definitions::AllDefinitions;
use super::dialect::Dialect;
use super::facts::{Fact, Facts, Refusal};
use super::files::{File, Files};
use super::includes::Includes;
use super::layouts::{Layouts, loose};
use super::numbers::Numbers;
use super::output::{NewFile, NewTree, Note, Pointed, TreeProgram};
use super::qualifiers::Qualifiers;
use super::samplers;
use super::text::{Plan, foreign};
use super::unseen::unseen;
use super::{Compiled, Key};
use crate::tokens::tokens;
use glisten_front::builtin::{BuiltinVariable, functions};
use glisten_front::compiler::Compilation;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::link::{LONE_WITHOUT_DEFINITION, UNDEFINED_FUNCTION};
use glisten_front::hir::{ExprKind, SamplerDim, Shader, Stage, Type, TypeId, Types};
use glisten_front::syntax::keywords;
use std::collections::{BTreeMap, BTreeSet};

/// Rewrites the programs of a tree for a host, or, without a dialect, only collects the texts that their compilers read.
pub fn tree(programs: &[TreeProgram], dialect: Option<&Dialect>) -> NewTree {
    let read = programs.iter().map(Read::of).collect();
    let (read, split_notes) = if dialect.is_some() { without_samplers_in_structs(read) } else { (read, Vec::new()) };
    let mut refused: Vec<Option<String>> = programs.iter().map(|_| None).collect();
    let mut left: Vec<Compiled<'_>> = Vec::new();
    for (index, Read { unit, compilation, .. }) in read.iter().enumerate() {
        match sound(unit, compilation, dialect) {
            Ok(program) => left.push(Compiled { index, unit, compilation, program }),
            Err(reason) => refused.get_mut(index).into_iter().for_each(|one| *one = Some(reason.clone())),
        }
    }
    let mut are_tried_alone = false;
    loop {
        let failed: Vec<Refusal> = match rewritten(&left, dialect, includes_of(&read, &left)) {
            // Often more than one cannot be rewritten: each is tried by itself before all are tried again.
            Err(_) if !are_tried_alone => {
                are_tried_alone = true;
                left.iter().filter_map(|one| rewritten(&[*one], dialect, includes_of(&read, &[*one])).err()).collect()
            }
            Err(one) => vec![one],
            Ok((mut files, mut notes)) => {
                let checked = |one: &Compiled<'_>| Some((one.index, check(one, &files, dialect?).err()?));
                let failed: Vec<Refusal> = left.iter().filter_map(checked).collect();
                if failed.is_empty() {
                    notes.extend(split_notes);
                    files.iter_mut().for_each(NewFile::point);
                    return NewTree { files, refused, notes };
                }
                failed
            }
        };
        for (index, reason) in failed {
            left.retain(|one| one.index != index);
            if let Some(one) = refused.get_mut(index) {
                *one = Some(reason);
            }
        }
    }
}

/// The files that the includes of programs name.
fn includes_of(read: &[Read], programs: &[Compiled<'_>]) -> BTreeMap<(String, String), String> {
    programs.iter().filter_map(|one| read.get(one.index)).flat_map(|one| one.includes.clone()).collect()
}

/// A program that was compiled, with the files that its includes name.
struct Read {
    unit: TreeProgram,
    compilation: Compilation,
    includes: BTreeMap<(String, String), String>,
}

impl Read {
    fn of(unit: &TreeProgram) -> Self {
        let includes = Includes::default();
        let compilation = includes.noted(&unit.compiler).compile(&unit.sources);
        let includes = includes.all().into_iter().map(|(named, found)| (named, found.name)).collect();
        Self { unit: unit.clone(), compilation, includes }
    }
}

/// The programs with a uniform for each sampler in a struct, where they still compile with it, and what to say of that.
fn without_samplers_in_structs(read: Vec<Read>) -> (Vec<Read>, Vec<Note>) {
    let mut notes = Vec::new();
    let split = read.into_iter().map(|one| {
        let new = one.compilation.program.as_ref().and_then(|program| samplers::split(&one.unit, program));
        let Some((unit, found)) = new else { return one };
        let new = Read::of(&unit);
        if new.compilation.program.is_none() || new.compilation.diagnostics.has_errors() {
            return one;
        }
        notes.extend(found);
        new
    });
    let split = split.collect();
    (split, notes)
}

/// The program, if edits say it in Vulkan's terms.
fn sound<'a>(
    unit: &TreeProgram,
    compilation: &'a Compilation,
    dialect: Option<&Dialect>,
) -> Result<&'a glisten_front::link::Program, String> {
    let Some(program) = compilation.program.as_ref().filter(|_| !compilation.diagnostics.has_errors()) else {
        return Err(lacking(compilation));
    };
    let Some(dialect) = dialect else { return Ok(program) };
    if program.stage(Stage::Geometry).is_some() && !dialect.geometry {
        return Err("the host has no geometry stages".to_owned());
    }
    let sources = &unit.sources;
    if sources.iter().any(|one| sources.iter().filter(|other| other.stage == one.stage).count() > 1) {
        return Err("several sources of one stage are not rewritten for Vulkan".to_owned());
    }
    program.stages.iter().try_for_each(|shader| refuse(shader, &program.types))?;
    Ok(program)
}

/// Why a compilation is none of a program.
fn lacking(compilation: &Compilation) -> String {
    let found = || compilation.diagnostics.iter();
    let is_undefined = |found: &&Diagnostic| [&LONE_WITHOUT_DEFINITION, &UNDEFINED_FUNCTION].contains(&found.code);
    match found().find(|found| found.is_error()).or_else(|| found().find(is_undefined)) {
        Some(one) if is_undefined(&one) => {
            let help = one.help.as_ref().map(|help| format!("; {help}"));
            format!("{}{}", one.message, help.unwrap_or_default())
        }
        Some(error) => error.message.clone(),
        None => "no source has a `main`: it is a part of other programs".to_owned(),
    }
}

/// Refuses what no edit says in Vulkan's terms.
fn refuse(shader: &Shader, types: &Types) -> Result<(), String> {
    let known = shader.functions.iter().find(|one| functions::is_known_for_vulkan(&one.name));
    if let Some(function) = known {
        return Err(format!("the function `{}` has the name of a built-in one; rename it", function.name));
    }
    if let Some(global) = shader.globals.iter().find(|global| is_rectangle(types, global.ty)) {
        return Err(format!("`{}` is a rectangle texture, which Vulkan does not have", global.name));
    }
    if let Some(name) = shader_names(shader).find(|name| keywords::is_of_vulkan(name)) {
        return Err(format!("`{name}` is a type of GLSL for Vulkan, and no name; rename it"));
    }
    let called = shader.exprs.iter().filter_map(|expr| match expr.kind {
        ExprKind::BuiltinCall(function, _) => Some(function.name()),
        _ => None,
    });
    if let Some(name) = called.into_iter().find(|name| name.starts_with("noise")) {
        return Err(format!("Vulkan has no `{name}`"));
    }
    let depth_range = Some(BuiltinVariable::DepthRange);
    if shader.globals.iter().any(|global| global.builtin == depth_range && global.used) {
        return Err("Vulkan has no `gl_DepthRange`".to_owned());
    }
    Ok(())
}

/// Whether a type is a sampler of rectangle textures, or an array of them.
fn is_rectangle(types: &Types, ty: TypeId) -> bool {
    match types.get(ty) {
        Type::Array(element, _) => is_rectangle(types, element),
        Type::Sampler(kind) => kind.dim == SamplerDim::Rect,
        _ => false,
    }
}

/// The names that a shader declares.
fn shader_names(shader: &Shader) -> impl Iterator<Item = &str> {
    let globals = shader.globals.iter().map(|global| global.name.as_str());
    let functions = shader.functions.iter().flat_map(|function| {
        std::iter::once(function.name.as_str()).chain(function.locals.iter().map(|local| local.name.as_str()))
    });
    globals.chain(functions)
}

/// The new texts of programs, which are not checked.
fn rewritten(
    programs: &[Compiled<'_>],
    dialect: Option<&Dialect>,
    includes: BTreeMap<(String, String), String>,
) -> Result<(Vec<NewFile>, Vec<Note>), Refusal> {
    let files = Files::new(programs, includes)?;
    let Some(dialect) = dialect else {
        let moved = BTreeMap::new();
        let all = files.all.iter().map(|(key, file)| new_file(&files, &moved, key, file, file.text.to_string()));
        return Ok((all.collect(), Vec::new()));
    };
    let mut numbers = Numbers::default();
    let mut facts = Facts::new(programs, &files, dialect, &mut numbers)?;
    let qualifiers = Qualifiers::new(&files);
    let mut notes = add_unseen(&files, &mut facts, &qualifiers, &mut numbers);
    let mut known: BTreeSet<String> = BTreeSet::new();
    for fact in facts.all.values_mut().flat_map(BTreeMap::values_mut) {
        if let Fact::Loose(loose) = &*fact
            && let Some(block) = dialect.known(&loose.name)
        {
            known.insert(loose.name.clone());
            *fact = Fact::Known(block);
        }
    }
    let (turned, turned_parts) = if dialect.coordinates { turned(programs, &files) } else { Default::default() };
    let layouts = Layouts::new(programs, &files, &facts, &turned, &mut numbers);
    numbers.solve()?;
    let names: BTreeSet<String> =
        files.all.values().flat_map(|file| tokens(&file.text)).map(|token| token.text.to_owned()).collect();
    let whole = whole(programs, &files, &facts, &layouts, dialect);
    let definitions = AllDefinitions::new(&files);
    let plan = Plan {
        dialect,
        programs,
        files: &files,
        facts: &facts.all,
        numbers: &numbers,
        layouts: &layouts,
        turned: &turned,
        turned_parts: &turned_parts,
        qualifiers: &qualifiers,
        definitions: &definitions,
        names: &names,
        known: &known,
        whole: &whole,
    };
    let mut new = Vec::new();
    for (key, file) in &files.all {
        let reader = file.readers.first().map_or(0, |(unit, _)| *unit);
        let (text, found) = plan.rewritten(key, file).map_err(|reason| (reader, reason))?;
        notes.extend(found);
        new.push(new_file(&files, &dialect.moved, key, file, text));
    }
    Ok((new, notes))
}

fn new_file(files: &Files, moved: &BTreeMap<String, String>, key: &Key, file: &File, text: String) -> NewFile {
    let own = files.includes.iter().filter(|((from, _), _)| *from == key.0);
    let pointed = own.filter_map(|((_, path), to)| {
        let (folder, is_split) = (moved.get(to).cloned(), files.split.contains(to));
        (is_split || folder.is_some()).then(|| Pointed { path: path.clone(), folder, is_split })
    });
    let mut readers: Vec<usize> = file.readers.iter().map(|(unit, _)| *unit).collect();
    readers.dedup();
    NewFile {
        name: key.0.clone(),
        stage: key.1,
        old: file.text.to_string(),
        text,
        readers,
        is_source: !file.source_of.is_empty(),
        pointed: pointed.collect(),
        first: file.readers.first().map_or(Stage::Vertex, |(_, stage)| *stage),
    }
}

/// Adds what conditions hide, and says what stays as it is.
fn add_unseen(files: &Files, facts: &mut Facts, qualifiers: &Qualifiers, numbers: &mut Numbers) -> Vec<Note> {
    let mut notes = Vec::new();
    for (key, file) in &files.all {
        let chunks = Chunks::new(&file.text);
        let of_file = facts.all.entry(key.clone()).or_default();
        let (found, left) = unseen(&chunks, file, of_file, qualifiers.of(key), numbers);
        of_file.extend(found);
        for place in left {
            let line = file.text.get(..place).map_or(0, |before| before.matches('\n').count()) as u32 + 1;
            let text = "no program sees this declaration, which a condition hides, and it stays as it is".to_owned();
            notes.push(Note { file: key.0.clone(), line, text });
        }
    }
    notes
}

/// The fragment sources that turn `gl_FragCoord`, and the included files that name it and are read by them.
fn turned(programs: &[Compiled<'_>], files: &Files) -> (BTreeSet<Key>, BTreeSet<Key>) {
    let parts: BTreeMap<&Key, BTreeSet<usize>> = files
        .all
        .iter()
        .filter(|(_, file)| file.source_of.is_empty() && coordinates::names_frag_coord(&Chunks::new(&file.text)))
        .map(|(key, file)| {
            (key, file.readers.iter().filter(|(_, stage)| *stage == Stage::Fragment).map(|(unit, _)| *unit).collect())
        })
        .collect();
    let needs = |one: &&Compiled<'_>| one.program.stage(Stage::Fragment).is_some_and(coordinates::needs_height);
    let mut units: BTreeSet<usize> = programs.iter().filter(needs).map(|one| one.index).collect();
    loop {
        let before = units.len();
        // Programs that share a source or a part turn together.
        for file in files.all.values().filter(|file| file.is_read_by(Stage::Fragment)) {
            let own: BTreeSet<usize> = file.source_of.clone();
            if own.iter().any(|unit| units.contains(unit)) {
                units.extend(own);
            }
        }
        for readers in parts.values() {
            if readers.iter().any(|unit| units.contains(unit)) {
                units.extend(readers);
            }
        }
        if units.len() == before {
            break;
        }
    }
    let is_source = |file: &File| file.source_of.iter().any(|unit| units.contains(unit));
    let sources = files.all.iter().filter(|(_, file)| file.is_read_by(Stage::Fragment) && is_source(file));
    let of_units = parts.iter().filter(|(_, readers)| readers.iter().any(|unit| units.contains(unit)));
    (sources.map(|(key, _)| key.clone()).collect(), of_units.map(|(key, _)| (*key).clone()).collect())
}

/// The programs both of whose stages can have the same block: no name is in the way, and no condition takes members away.
fn whole(
    programs: &[Compiled<'_>],
    files: &Files,
    facts: &Facts,
    layouts: &Layouts,
    dialect: &Dialect,
) -> BTreeSet<usize> {
    let is_whole = |compiled: &&Compiled<'_>| {
        let Some(layout) = layouts.of_units.get(&compiled.index) else { return false };
        let mut own = files.all.iter().filter(|(_, file)| file.owner() == Some(compiled.index));
        !layout.has_unseen
            && own.all(|(key, file)| {
                let declared = loose(facts, key);
                let turns = layout.height.is_some() && file.is_read_by(Stage::Fragment);
                if declared.is_empty() && !turns {
                    return true;
                }
                let conditions = Conditions::new(&file.text);
                let mut stacks = declared.iter().map(|(place, _)| conditions.at(*place));
                let first = stacks.next();
                let is_even = stacks.all(|stack| Some(&stack) == first.as_ref());
                let names: BTreeSet<&str> = declared.iter().map(|(_, one)| one.name.as_str()).collect();
                let stage = file.readers.first().map_or(Stage::Vertex, |(_, stage)| *stage);
                (is_even || !dialect.offsets)
                    && foreign(compiled, stage, &Chunks::new(&file.text), layout, &names).is_some()
            })
    };
    programs.iter().filter(is_whole).map(|one| one.index).collect()
}
