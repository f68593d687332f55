//! The programs of a folder with new texts.
//!
//! *In:* groups of files, a host. *Out:* the new tree, and for each program what became of it. *Holds:* the texts of a program that has
//! errors, before or after, stay as they are.

use super::older::Older;
use super::tree::NewFolder;
use crate::arguments::args::SourceArgs;
use crate::commands::upgrade::{ByPlan, Upgraded, checker, plan, plan_of_newer, words};
use crate::exit::Failure;
use crate::inputs::{Group, Input};
use crate::session::{Session, Unit, compile_anywhere};
use glisten_emit::{Conventions, Target, emit};
use glisten_front::compiler::{Compiler, Prepared, Source};
use glisten_front::diagnostic::codes::names::{REDEFINED, UNKNOWN_FUNCTION};
use glisten_front::diagnostic::codes::preprocess::INCLUDE_NOT_FOUND;
use glisten_front::diagnostic::codes::types::NO_OVERLOAD;
use glisten_front::diagnostic::{Code, Diagnostic};
use glisten_front::hir::{Shader, Stage};
use glisten_front::source::{IncludeForm, IncludeResolver, Included};
use glisten_port::{Host, Outcome, ProgramReport};
use glisten_upgrade::{Dialect, Includes, NewTree, Plan, Refused, TreeProgram, converts_depth, tree};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A program with its new texts.
pub(super) struct Done {
    /// Its row in the account.
    pub(super) report: ProgramReport,
    /// Its files, the vertex shader first.
    pub(super) files: Vec<PathBuf>,
    /// Its place in the tree, if it is there.
    pub(super) index: Option<usize>,
    /// All files that it reads.
    pub(super) reads: BTreeSet<String>,
    /// Whether it declares itself what the host has today.
    pub(super) is_older: bool,
    /// The new names of what was built in.
    pub(super) plan: Option<Arc<Plan>>,
}

/// The programs of a folder.
pub(super) struct Ported {
    pub(super) programs: Vec<Done>,
    /// The programs of the tree.
    pub(super) units: Vec<TreeProgram>,
    pub(super) tree: NewTree,
    /// The same tree with OpenGL's coordinates, for what reads the new texts back.
    pub(super) plain: NewTree,
    /// The compiler of the programs as they were.
    pub(super) old: Compiler,
    /// The compiler of those that declare themselves what the host has today.
    pub(super) older: Compiler,
    /// The host, which has some blocks elsewhere if included files of the pack would hide them.
    pub(super) host: Host,
    /// Included files of an older host.
    pub(super) older_files: Older,
}

impl Done {
    /// The file that names what is written for the program: the vertex shader, or a stage of a file with several.
    pub(super) fn first(&self) -> Option<PathBuf> {
        let alone = self.report.new.iter().zip(&self.report.files).find(|(new, old)| new != old);
        alone.map(|(new, _)| PathBuf::from(new)).or_else(|| self.files.first().cloned())
    }
}

impl Ported {
    /// The file with several stages that a new file is one of.
    pub(super) fn whole(&self, new: &str) -> Option<&String> {
        let mut pairs = self.programs.iter().flat_map(|one| one.report.new.iter().zip(&one.report.files));
        pairs.find(|(name, old)| *name == new && name != old).map(|(_, old)| old)
    }

    /// Whether a program of a file with several stays as it was.
    pub(super) fn is_kept(&self, whole: &str) -> bool {
        let stays =
            |one: &Done| one.report.files.iter().zip(&one.report.new).any(|(old, new)| old == whole && old == new);
        self.programs.iter().any(stays)
    }

    /// The rows of the account.
    pub(super) fn reports(&self, pack: &Path, folder: &NewFolder) -> Vec<ProgramReport> {
        let place = |name: &String| folder.place(pack, Path::new(name)).unwrap_or_else(|| name.clone());
        let report = |one: &Done| {
            let [files, new] = [&one.report.files, &one.report.new].map(|names| names.iter().map(place).collect());
            ProgramReport { files, new, ..one.report.clone() }
        };
        self.programs.iter().map(report).collect()
    }
}

/// Rewrites the programs of groups.
pub(super) fn ported(
    session: &mut Session<'_>,
    groups: Vec<Group>,
    host: &Host,
    sources: &SourceArgs,
    pack: &Path,
) -> Result<Ported, Failure> {
    let engines = session.engines().clone();
    let older_files = older_files(session, &groups, host, pack);
    let mut host = older_files.host(host);
    let readers = Readers { dialect: host.dialect.clone().map(Arc::new), older: older_files.clone() };
    let by =
        |compiler: &Compiler, group: Group, kind| compile_anywhere(&readers.compiler(compiler, kind), &engines, group);
    let units = session.compile_by(groups, |compiler, group| {
        let first = by(compiler, group.clone(), StandIn::Blocks);
        if is_twice(&first.0) { by(compiler, group, StandIn::Nothing) } else { first }
    });
    // People read in the account why a program stays.
    if !session.is_human() {
        session.tell_units(&units, false)?;
    }
    let old = readers.compiler(session.compiler(), StandIn::Blocks);
    let older = readers.compiler(session.compiler(), StandIn::Nothing);
    let words = words(&units);
    let (mut programs, mut trees) = (Vec::new(), Vec::new());
    for unit in &units {
        let mut done = undone(unit);
        // A text for an older version of the host declares itself what the host has today.
        let is_empty = |name: &str, text: &str| name.starts_with('<') && name.ends_with(".glsl>") && text.is_empty();
        let is_older = unit.batch.sources.files().any(|(_, file)| is_empty(file.name(), file.text()));
        let (old, kind) = if is_older { (&older, StandIn::Nothing) } else { (&old, StandIn::Blocks) };
        done.is_older = is_older;
        let new = new_program(unit, (old, kind), (&host, &readers), sources, &words)?;
        let lacks = |program: &TreeProgram| if host.has_wgsl { not_in_wgsl(program) } else { None };
        let new = new.and_then(|(program, plan)| match lacks(&program) {
            None => Ok((program, plan)),
            because => Err((Outcome::Refused, because)),
        });
        match new {
            Ok((program, plan)) => {
                done.index = Some(trees.len());
                done.report.new = program.sources.iter().map(|source| source.name.clone()).collect();
                done.report.notes = plan.iter().flat_map(|plan| plan.notes.clone()).collect();
                done.plan = plan;
                trees.push(program);
            }
            Err((result, because)) => {
                done.report.result = result;
                done.report.because = because;
            }
        }
        programs.push(done);
    }
    host.dialect.iter_mut().for_each(|dialect| dialect.moved = older_files.folders());
    let new = tree(&trees, host.dialect.as_ref());
    for done in &mut programs {
        let Some(index) = done.index else { continue };
        let refused = new.refused.get(index).cloned().flatten();
        let changes = new.files.iter().filter(|file| file.readers.contains(&index)).any(|file| {
            let mut texts = units.iter().flat_map(|unit| unit.batch.sources.files());
            !texts.any(|(_, old)| old.name() == file.name && **old.text() == *file.text)
        });
        done.report.result = match (&refused, changes) {
            (Some(_), _) => Outcome::Refused,
            (None, true) => Outcome::Ported,
            (None, false) => Outcome::Unchanged,
        };
        if refused.is_some() {
            done.index = None;
            done.report.new = done.report.files.clone();
        }
        done.report.because = refused;
    }
    let plain = match &host.dialect {
        Some(dialect) if dialect.coordinates => tree(&trees, Some(&Dialect { coordinates: false, ..dialect.clone() })),
        _ => new.clone(),
    };
    Ok(Ported { programs, units: trees, tree: new, plain, old, older, host, older_files })
}

/// A program before anything is done.
fn undone(unit: &Unit) -> Done {
    let inputs = &unit.group.inputs;
    let report = ProgramReport {
        name: unit.group.name.clone(),
        files: inputs.iter().map(|input| input.name.clone()).collect(),
        new: inputs.iter().map(|input| input.name.clone()).collect(),
        stages: inputs.iter().map(|input| input.stage.name()).collect(),
        result: Outcome::Refused,
        because: None,
        proof: None,
        evidence: None,
        notes: Vec::new(),
    };
    let mut files: Vec<_> = inputs.iter().filter_map(|input| Some((input.stage, input.path.clone()?))).collect();
    files.sort();
    files.dedup_by(|(_, a), (_, b)| a == b);
    let reads = unit.batch.sources.files().map(|(_, file)| file.name().to_owned()).collect();
    let files = files.into_iter().map(|(_, path)| path).collect();
    Done { report, files, reads, index: None, is_older: false, plan: None }
}

/// A program with the names of its new language, or the result without one.
type New = Result<(TreeProgram, Option<Arc<Plan>>), (Outcome, Option<String>)>;

fn new_program(
    unit: &Unit,
    (old, kind): (&Compiler, StandIn),
    (host, readers): (&Host, &Readers),
    args: &SourceArgs,
    words: &BTreeSet<String>,
) -> Result<New, Failure> {
    let is_for_vulkan =
        unit.batch.sources.files().any(|(_, file)| states_sets(file.text()) || converts_depth(file.text()));
    if is_for_vulkan {
        return Ok(Err((Outcome::Already, None)));
    }
    let unread = unit.unread.iter().flat_map(|batch| &batch.diagnostics);
    if let Some(error) = unread.chain(&unit.batch.diagnostics).find(|found| found.is_error()) {
        let because =
            [Some(told(error)), lacking(unit, error, host)].into_iter().flatten().collect::<Vec<_>>().join("; ");
        return Ok(Err((Outcome::Refused, Some(because))));
    }
    let has_parts = unit.group.inputs.iter().any(|input| input.part.is_some());
    if let Some(because) = unit.group.inputs.iter().find_map(part_refusal) {
        return Ok(Err((Outcome::Refused, Some(because))));
    }
    let source = |text: &str, name: &str, stage| Source { name: name.to_owned(), text: text.into(), stage };
    match plan(unit, old, host.target, words) {
        Ok(plan) => by_plan(unit, plan, (old, kind), readers, args),
        // A newer text has the words of the host's language already, but may have taken some of them as names.
        Err(Refused::Newer { version, .. }) if host.dialect.is_some() && ![300, 310, 320].contains(&version) => {
            let names = plan_of_newer(unit, old, host.target, words);
            if !names.is_empty() || has_parts {
                return by_plan(unit, names, (old, kind), readers, args);
            }
            let inputs = unit.group.inputs.iter();
            let sources = inputs
                .filter_map(|input| {
                    let file = unit.batch.sources.files().find(|(_, file)| file.name() == input.name)?;
                    Some(source(file.1.text(), &input.name, input.stage))
                })
                .collect();
            Ok(Ok((TreeProgram { compiler: old.clone(), sources }, None)))
        }
        Err(Refused::Wrong(compilation)) => {
            let first = compilation.diagnostics.iter().find(|found| found.is_error());
            let because = first.map_or("the sources have errors".to_owned(), told);
            Ok(Err((Outcome::Refused, Some(because))))
        }
        Err(refused @ Refused::Newer { target: glisten_upgrade::Target::Es300, .. }) => {
            let help = "`glisten compile --target glsl --glsl-version 300es` translates such a program, to new text";
            Ok(Err((Outcome::Refused, Some(format!("{refused}; {help}")))))
        }
        Err(refused) => Ok(Err((Outcome::Refused, Some(refused.to_string())))),
    }
}

/// Why WGSL cannot express a program. A geometry stage is refused as what the host lacks.
fn not_in_wgsl(program: &TreeProgram) -> Option<String> {
    let program = program.compiler.compile(&program.sources).program?;
    if program.stage(Stage::Geometry).is_some() {
        return None;
    }
    let refused = |shader: &Shader| emit(&program, shader.stage, Target::Wgsl, &Conventions::default()).err();
    program.stages.iter().find_map(refused)?.first().map(told)
}

/// Why a stage of a file with several cannot become a file of its own.
fn part_refusal(input: &Input) -> Option<String> {
    if input.part.as_ref()?.host().is_some() {
        return Some("its source is a string in a file of another language".to_owned());
    }
    let name = name_alone(input)?;
    Path::new(&name)
        .exists()
        .then(|| format!("`{}` is there already, and its file has several stages", input.file_name()))
}

/// The name of the file that a stage of a file with several gets.
fn name_alone(input: &Input) -> Option<String> {
    input.part.as_ref()?;
    Some(input.path.as_ref()?.with_file_name(input.file_name()).to_string_lossy().into_owned())
}

/// The source of a new text. A stage of a file with several gets a file of its own.
fn source_alone(upgraded: &Upgraded) -> Source {
    let source = upgraded.source();
    Source { name: name_alone(&upgraded.input).unwrap_or(source.name), ..source }
}

/// The texts of a program by a plan, which compile.
fn by_plan(
    unit: &Unit,
    plan: Plan,
    (old, kind): (&Compiler, StandIn),
    readers: &Readers,
    args: &SourceArgs,
) -> Result<New, Failure> {
    let by = |plan: &Arc<Plan>| Ok(readers.compiler(&checker(args, old, plan)?, kind));
    let ByPlan { plan, sources, compiler, compilation, .. } = ByPlan::new(unit, plan, &source_alone, &by)?;
    if let Some(error) = compilation.diagnostics.iter().find(|found| found.is_error()) {
        return Ok(Err((Outcome::Refused, Some(format!("in the new language, {}", told(error))))));
    }
    Ok(Ok((TreeProgram { compiler, sources }, Some(plan))))
}

/// The remedy for an error that comes from a file of the host that is not there.
fn lacking(unit: &Unit, error: &Diagnostic, host: &Host) -> Option<String> {
    static CODES: [&Code; 4] = [&INCLUDE_NOT_FOUND, &REDEFINED, &UNKNOWN_FUNCTION, &NO_OVERLOAD];
    let mut names = unit.batch.sources.files().map(|(_, file)| file.name());
    let is_missing =
        *error.code == INCLUDE_NOT_FOUND || names.any(|name| name.starts_with('<') && name.ends_with(".glsl>"));
    let is_it = host.is_minecraft && is_missing && CODES.contains(&error.code);
    is_it.then(|| {
        "files of the game are not there, or are of another version: `-I GAME` names the assets of the version that the pack was made \
         for"
            .to_owned()
    })
}

/// The message of an error, with its code.
fn told(error: &Diagnostic) -> String {
    format!("{} ({})", error.message, error.code.id)
}

/// Whether a text names sets, which only Vulkan has.
fn states_sets(text: &str) -> bool {
    let code = glisten_sources::engines::code::without_comments(text);
    code.split("layout").skip(1).any(|rest| {
        let words = rest.trim_start().strip_prefix('(').and_then(|rest| rest.split(')').next()).unwrap_or("");
        words.split(',').any(|word| word.split('=').next().is_some_and(|word| word.trim() == "set"))
    })
}

/// The text of an included file of the host that is not there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum StandIn {
    /// The block that the host has today.
    Blocks,
    /// None: the host had no block then.
    Nothing,
}

/// Whether a program declares itself what a block of the host has.
fn is_twice(unit: &Unit) -> bool {
    unit.batch.diagnostics.iter().any(|found| found.code.id == DECLARED_TWICE)
}

/// The code of a name that is declared twice.
const DECLARED_TWICE: &str = "E0302";

/// The included files of a pack that are older than its host.
fn older_files(session: &mut Session<'_>, groups: &[Group], host: &Host, pack: &Path) -> Older {
    if !has_files(host.dialect.as_ref()) {
        return Older::default();
    }
    let (engines, found) = (session.engines().clone(), Includes::default());
    session.compile_by(groups.to_vec(), |compiler, group| compile_anywhere(&found.noted(compiler), &engines, group));
    Older::new(pack, host, &found.all())
}

/// Whether a host has files that sources include.
fn has_files(dialect: Option<&Dialect>) -> bool {
    dialect.is_some_and(|dialect| dialect.blocks.iter().any(|block| block.include.is_some()))
}

/// How included files of the host are read.
struct Readers {
    dialect: Option<Arc<Dialect>>,
    older: Older,
}

impl Readers {
    /// A compiler that finds older files at their new places, and takes the blocks of the host for its files that are not there.
    fn compiler(&self, compiler: &Compiler, kind: StandIn) -> Compiler {
        let Some(dialect) = self.dialect.clone().filter(|dialect| has_files(Some(dialect))) else {
            return compiler.clone();
        };
        let (older, own) = (self.older.clone(), compiler.includes());
        compiler.clone().with_change(move |_, prepared| {
            let inner = prepared.includes.clone().unwrap_or_else(|| Arc::clone(&own));
            let reader = StandIns { inner, dialect: Arc::clone(&dialect), older: older.clone(), kind };
            Prepared { includes: Some(Arc::new(reader)), ..prepared }
        })
    }
}

struct StandIns {
    inner: Arc<dyn IncludeResolver + Send + Sync>,
    dialect: Arc<Dialect>,
    older: Older,
    kind: StandIn,
}

impl IncludeResolver for StandIns {
    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String> {
        let stand_in = || {
            let found = self.dialect.stand_in(path)?;
            let is_empty = self.kind == StandIn::Nothing;
            Some(if is_empty { Included { text: "".into(), ..found } } else { found })
        };
        match self.inner.resolve(path, form, from) {
            Ok(found) => {
                let name = self.older.place(from, path, &found.name).unwrap_or(found.name);
                Ok(Included { name, text: found.text })
            }
            Err(error) => stand_in().ok_or(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::states_sets;

    #[test]
    fn texts_for_vulkan_are_known() {
        assert!(states_sets("layout(std140, set = 0, binding = 1) uniform A { vec4 a; };"));
        assert!(!states_sets("layout(binding = 1) uniform A { vec4 set; }; // layout(set = 0)"));
    }
}
