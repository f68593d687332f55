//! Programs with new texts: the plan of a program, its sources by it, and the compiler that reads them.
//!
//! *In:* a program that compiles. *Out:* new texts that compile, too.

use super::Upgraded;
use crate::arguments::args::SourceArgs;
use crate::arguments::engine::Engines;
use crate::batch::Batch;
use crate::exit::{Exit, Failure};
use crate::files;
use crate::inputs::Input;
use crate::session::{Session, Unit};
use glisten_front::Stage;
use glisten_front::compiler::{Compilation, Compiler, Preparation, Prepared, Source, SourceSettings};
use glisten_front::source::version_line;
use glisten_upgrade::{Macros, Plan, Refused, Target, Text, completed, names_in, plan_in, rewrite, selected};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::Arc;

/// All words of the texts of programs, if there are several: a new name is free in all of them.
pub(crate) fn words(units: &[Unit]) -> BTreeSet<String> {
    if units.len() < 2 {
        return BTreeSet::new();
    }
    let files = units.iter().flat_map(|unit| unit.batch.sources.files());
    let words =
        |text: &str| glisten_sources::engines::code::words(text).map(|(_, word)| word.to_owned()).collect::<Vec<_>>();
    files.flat_map(|(_, file)| words(file.text())).collect()
}

/// The text of an input: as it was compiled, without what conditions keep for the other stages of its file.
pub(super) fn text_of<'s>(unit: &'s Unit, input: &Input) -> Cow<'s, str> {
    let text = whole_text_of(unit, input);
    if input.part.is_none() {
        return text.into();
    }
    let (set, unset) = macros_of(input);
    selected(text, Macros { set: &set, unset: &unset }).into()
}

/// The macros that select the stage of an input in its file, and those that select the others.
fn macros_of(input: &Input) -> (Vec<String>, Vec<String>) {
    let file = files::read_source(&input.name, input.path.as_deref()).ok();
    let part = input.part.as_ref().zip(file);
    part.map(|(part, file)| part.macros(&file, input.stage)).unwrap_or_default()
}

/// The text of an input, as it was compiled. The stages of one file have one name, and their order.
fn whole_text_of<'s>(unit: &'s Unit, input: &Input) -> &'s str {
    let before = unit.group.inputs.iter().take_while(|other| other.stage != input.stage);
    let index = before.filter(|other| other.name == input.name).count();
    let mut files = unit.batch.sources.files().filter(|(_, file)| file.name() == input.name);
    files.nth(index).map_or("", |(_, file)| file.text())
}

/// The number of the version of a stage.
fn version_of(unit: &Unit, stage: Stage) -> u16 {
    unit.program.as_ref().and_then(|program| program.stage(stage)).map_or(110, |shader| shader.version.number)
}

/// The plan of a program.
pub(crate) fn plan(
    unit: &Unit,
    compiler: &Compiler,
    target: Target,
    words: &BTreeSet<String>,
) -> Result<Plan, Refused> {
    plan_in(compiler, &with_versions(unit, &sources_of(unit)), target, words)
}

/// The plan for a program whose texts are newer than the target.
pub(crate) fn plan_of_newer(unit: &Unit, compiler: &Compiler, target: Target, words: &BTreeSet<String>) -> Plan {
    names_in(compiler, &with_versions(unit, &sources_of(unit)), target, words)
}

fn sources_of(unit: &Unit) -> Vec<Source> {
    let source = |input: &Input| {
        let (name, text) = (input.name.clone(), text_of(unit, input).into_owned().into());
        Source { name, text, stage: input.stage }
    };
    unit.group.inputs.iter().map(source).collect()
}

fn with_versions<'s>(unit: &Unit, sources: &'s [Source]) -> Vec<(&'s Source, u16)> {
    sources.iter().map(|source| (source, version_of(unit, source.stage))).collect()
}

/// A refusal as a failure, with what helps.
pub(super) fn failure(refused: &Refused) -> Failure {
    {
        let failure = Failure::new(Exit::Content, refused.to_string());
        match *refused {
            Refused::Newer { version: 300, .. } => failure.help("add `--to 300es`"),
            Refused::Newer { version, .. } if version <= 330 => failure.help("add `--to 330`"),
            Refused::Newer { version, .. } if version <= 450 => failure.help("add `--to 450`"),
            Refused::NoCounterpart(_) => {
                failure.help("write it in the terms of GLSL 1.50 first; for `gl_ClipVertex`, that is `gl_ClipDistance`")
            }
            _ => failure,
        }
    }
}

fn rewritten(unit: &Unit, plan: &Plan) -> Vec<Upgraded> {
    let upgraded = |input: &Input| {
        let text = text_of(unit, input);
        let version = version_of(unit, input.stage);
        let text = rewrite(&Text { text: &text, stage: input.stage, is_shader: true, version }, plan);
        let text = if input.part.is_some() { alone(input, &text) } else { text };
        Upgraded { input: input.clone(), text }
    };
    unit.group.inputs.iter().map(upgraded).collect()
}

/// The new text of a stage of a file that contains several, as a file of its own: with the macros that select the stage, if it
/// still asks for them, and without the gaps that the others leave.
fn alone(input: &Input, text: &str) -> String {
    let (set, _) = macros_of(input);
    let is_named = |name: &String| glisten_sources::engines::code::words(text).any(|(_, word)| word == name);
    let defines: Vec<String> =
        set.iter().filter(|name| is_named(name)).map(|name| format!("#define {name} 1\n")).collect();
    let version = version_line(text).map_or("", |line| text.get(line).unwrap_or(""));
    let mut alone = String::new();
    for line in text.lines() {
        if line.trim().is_empty() && (alone.is_empty() || alone.ends_with("\n\n")) {
            continue;
        }
        alone.push_str(line.trim_end());
        alone.push('\n');
        if line == version {
            alone.extend(defines.iter().map(String::as_str));
        }
    }
    alone.truncate(alone.trim_end().len());
    alone.push('\n');
    alone
}

/// A compiler that upgrades what the new texts include and what engines put before them.
pub(crate) fn checker(sources: &SourceArgs, compiler: &Compiler, plan: &Arc<Plan>) -> Result<Compiler, Failure> {
    let engines = Engines::new(sources)?;
    let preparation = Upgrading { inner: Arc::new(engines.clone()), engines, plan: Arc::clone(plan) };
    Ok(compiler.clone().with_preparation(preparation))
}

/// The texts of a program by a plan.
pub(crate) struct ByPlan {
    /// The plan, without an output that nothing writes.
    pub(crate) plan: Arc<Plan>,
    pub(crate) texts: Vec<Upgraded>,
    /// The sources of the texts, and what reads them.
    pub(crate) sources: Vec<Source>,
    pub(crate) compiler: Compiler,
    pub(crate) compilation: Compilation,
}

impl ByPlan {
    /// The texts of a program by a plan, each as the source that it becomes, for a compiler by the plan.
    pub(crate) fn new(
        unit: &Unit,
        plan: Plan,
        source: &dyn Fn(&Upgraded) -> Source,
        compiler: &dyn Fn(&Arc<Plan>) -> Result<Compiler, Failure>,
    ) -> Result<Self, Failure> {
        let by = |plan: Plan| -> Result<Self, Failure> {
            let plan = Arc::new(plan);
            let texts = rewritten(unit, &plan);
            let sources: Vec<Source> = texts.iter().map(source).collect();
            let compiler = compiler(&plan)?;
            let compilation = compiler.compile(&sources);
            Ok(Self { plan, texts, sources, compiler, compilation })
        };
        let first = by(plan)?;
        let program = first.compilation.program.as_ref();
        match program.and_then(|program| first.plan.without_spare_output(program)) {
            Some(plan) => by(plan),
            None => Ok(first),
        }
    }
}

/// Reports what is wrong with the new texts.
pub(super) fn check(new: &ByPlan, session: &mut Session<'_>) -> Result<Exit, Failure> {
    let (texts, compilation) = (&new.texts, new.compilation.clone());
    let mut batch = Batch { sources: compilation.sources, diagnostics: Vec::new() };
    session.add(&mut batch, compilation.diagnostics.into_iter().filter(glisten_front::Diagnostic::is_error));
    if batch.diagnostics.is_empty() {
        return Ok(Exit::Ok);
    }
    session.tell(&[&batch], false)?;
    let names: Vec<&str> = texts.iter().map(|upgraded| upgraded.input.name.as_str()).collect();
    let message = format!("the new text of `{}` is not valid, and nothing was written", names.join("`, `"));
    Err(Failure::new(Exit::Content, message)
        .help("the errors above are at lines of the new text; change the old one there"))
}

/// Completes sources as their engines do, and upgrades what they add.
struct Upgrading {
    inner: Arc<dyn Preparation + Send + Sync>,
    engines: Engines,
    plan: Arc<Plan>,
}

impl Preparation for Upgrading {
    fn prepare(&self, source: &Source) -> Prepared {
        completed(self.inner.prepare(source), Arc::new(self.engines.includes()), &self.plan, source.stage)
    }

    fn with_settings(&self, settings: &SourceSettings) -> Option<Arc<dyn Preparation + Send + Sync>> {
        let inner = self.inner.with_settings(settings)?;
        Some(Arc::new(Self { inner, engines: self.engines.clone(), plan: Arc::clone(&self.plan) }))
    }
}
