//! [`upgrade()`]: the sources of a program, rewritten together and checked.
//!
//! *In:* a compiler, the sources of a program. *Out:* their new texts, which compile, too, and notes for the host's author.
//! *Holds:* texts that the sources include are read as if they were rewritten by the same plan; who owns them has to rewrite
//! them, too.

use super::{Plan, Target, Text, rewrite, to_vulkan};
use glisten_front::Stage;
use glisten_front::compiler::{Compilation, Compiler, Preparation, Prepared, Source};
use glisten_front::source::{Completion, IncludeForm, IncludeResolver, Included, Prelude, SourceMap};
use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;

/// The resolver of a compiler's includes.
type Includes = Arc<dyn IncludeResolver + Send + Sync>;

/// Why sources cannot be rewritten.
#[derive(Clone, Debug)]
pub enum Refused {
    /// The sources have errors.
    Wrong(Box<Compilation>),
    /// A source is newer than the language to write.
    Newer {
        /// The name of the source.
        name: String,
        /// The number of its version.
        version: u16,
        /// The language to write.
        target: Target,
    },
    /// The target has no counterpart for a name.
    NoCounterpart(&'static str),
    /// The new texts have errors.
    NotValid(Box<Compilation>),
    /// The sources cannot be rewritten for Vulkan, for this reason.
    NotForVulkan(String),
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Wrong(_) => f.write_str("the sources have errors"),
            Self::Newer { name, version, target } => {
                let es = if [300, 310, 320].contains(version) { "ES " } else { "" };
                let number = |number: u16| format!("{}.{:02}", number / 100, number % 100);
                let goal = target.name();
                write!(f, "`{name}` is GLSL {es}{}, newer than the target {goal}", number(*version))
            }
            Self::NoCounterpart(name) => write!(f, "`{name}` has no counterpart, and nothing was written"),
            Self::NotValid(_) => f.write_str("the new texts have errors"),
            Self::NotForVulkan(reason) => f.write_str(reason),
        }
    }
}

/// The sources of a program in another language.
#[derive(Clone, Debug)]
pub struct Upgraded {
    /// The new texts, in the order of the sources.
    pub texts: Vec<String>,
    /// Sentences for the author of the host.
    pub notes: Vec<String>,
}

/// Rewrites the sources of a program. The compiler has no [`Preparation`].
///
/// ```
/// use glisten_front::{Compiler, Options, Source, Stage};
/// use glisten_upgrade::{Target, upgrade};
///
/// let text = "void main() { gl_FragColor = vec4(1.0); }\n";
/// let source = Source { name: "a.frag".into(), text: text.into(), stage: Stage::Fragment };
/// let upgraded = upgrade(&Compiler::new(Options::default()), &[source], Target::Core330).expect("it can be rewritten");
/// assert!(upgraded.texts[0].starts_with("#version 330 core\n"));
/// ```
///
/// # Errors
/// The sources or their new texts have errors, a source is newer than the target, or it has no counterpart for a name.
pub fn upgrade(compiler: &Compiler, sources: &[Source], target: Target) -> Result<Upgraded, Refused> {
    let compilation = compiler.compile(sources);
    if compilation.diagnostics.has_errors() {
        return Err(Refused::Wrong(Box::new(compilation)));
    }
    let program = compilation.program.as_ref();
    let version =
        |source: &Source| program.and_then(|program| program.stage(source.stage)).map_or(110, |one| one.version.number);
    let versions: Vec<(&Source, u16)> = sources.iter().map(|source| (source, version(source))).collect();
    let mut plan = Arc::new(plan_of(compiler, &versions, target)?);
    let by = |plan: &Arc<Plan>| {
        let new = |(source, version): &(&Source, u16)| {
            let text = Text { text: &source.text, stage: source.stage, is_shader: true, version: *version };
            Source { text: rewrite(&text, plan).into(), ..(*source).clone() }
        };
        let new: Vec<Source> = versions.iter().map(new).collect();
        let preparation = Upgrading { compiler: compiler.clone(), plan: Arc::clone(plan) };
        let checker = compiler.clone().with_preparation(preparation);
        let compilation = checker.compile(&new);
        (new, checker, compilation)
    };
    let (mut new, mut checker, mut compilation) = by(&plan);
    if let Some(without) = compilation.program.as_ref().and_then(|program| plan.without_spare_output(program)) {
        plan = Arc::new(without);
        (new, checker, compilation) = by(&plan);
    }
    if compilation.diagnostics.has_errors() {
        return Err(Refused::NotValid(Box::new(compilation)));
    }
    let texts = match target {
        // A module for the web without the reference is as small as can be.
        Target::Vulkan if cfg!(all(target_family = "wasm", not(feature = "vulkan-in-wasm"))) => {
            return Err(Refused::NotForVulkan("only the module with the reference writes GLSL for Vulkan".to_owned()));
        }
        Target::Vulkan => to_vulkan(&checker, &new).map_err(Refused::NotForVulkan)?,
        _ => new.iter().map(|source| source.text.to_string()).collect(),
    };
    Ok(Upgraded { texts, notes: plan.notes.clone() })
}

/// The plan for sources that compile, each with the number of its version.
///
/// # Errors
/// A source is newer than the target, or it has no counterpart for a name.
pub fn plan_of(compiler: &Compiler, sources: &[(&Source, u16)], target: Target) -> Result<Plan, Refused> {
    plan_in(compiler, sources, target, &BTreeSet::new())
}

/// The plan like [`plan_of`], for a program of a tree: new names are none of these words, so that all programs get the same ones.
///
/// # Errors
/// A source is newer than the target, or it has no counterpart for a name.
pub fn plan_in(
    compiler: &Compiler,
    sources: &[(&Source, u16)],
    target: Target,
    words: &BTreeSet<String>,
) -> Result<Plan, Refused> {
    if let Some((source, version)) = sources.iter().find(|(_, version)| target.is_older_than(*version)) {
        return Err(Refused::Newer { name: source.name.clone(), version: *version, target });
    }
    let others = all_other_texts(compiler, sources);
    let plan = Plan::with_words(&all_texts(sources, &others), target, words);
    plan.refused.first().map_or(Ok(()), |name| Err(Refused::NoCounterpart(name)))?;
    Ok(plan)
}

/// The plan for a program of a tree whose texts are newer than the target: only names that the target takes change.
pub fn names_in(compiler: &Compiler, sources: &[(&Source, u16)], target: Target, words: &BTreeSet<String>) -> Plan {
    let others = all_other_texts(compiler, sources);
    Plan::of_names(&all_texts(sources, &others), target, words)
}

fn all_other_texts(compiler: &Compiler, sources: &[(&Source, u16)]) -> Vec<Vec<Arc<str>>> {
    sources.iter().map(|(source, _)| other_texts(compiler, source)).collect()
}

/// The texts of sources, each with those that it reads.
fn all_texts<'t>(sources: &[(&'t Source, u16)], others: &'t [Vec<Arc<str>>]) -> Vec<Text<'t>> {
    let mut texts = Vec::new();
    for ((source, version), others) in sources.iter().zip(others) {
        let (stage, version) = (source.stage, *version);
        texts.push(Text { text: &source.text, stage, is_shader: true, version });
        texts.extend(others.iter().map(|text| Text { text, stage, is_shader: false, version }));
    }
    texts
}

/// The texts that a source reads besides its own: preludes and included files.
fn other_texts(compiler: &Compiler, source: &Source) -> Vec<Arc<str>> {
    let sources = compiler.compile(std::slice::from_ref(source)).sources;
    let is_other = |name: &str| ![source.name.as_str(), SourceMap::COMMAND_LINE, Completion::ASSUMED].contains(&name);
    sources.files().filter(|(_, file)| is_other(file.name())).map(|(_, file)| Arc::clone(file.text())).collect()
}

/// Rewrites by a plan all that completes a source of a stage: its preludes, and the files that it includes.
pub fn completed(mut prepared: Prepared, includes: Includes, plan: &Arc<Plan>, stage: Stage) -> Prepared {
    let new = |prelude: Prelude| Prelude { text: part(&prelude.text, plan, stage), ..prelude };
    let preludes = std::mem::take(&mut prepared.completion.preludes);
    prepared.completion.preludes = preludes.into_iter().map(new).collect();
    let inner = prepared.includes.unwrap_or(includes);
    prepared.includes = Some(Arc::new(NewIncludes { inner, plan: Arc::clone(plan), stage }));
    prepared
}

fn part(text: &str, plan: &Plan, stage: Stage) -> Arc<str> {
    rewrite(&Text { text, stage, is_shader: false, version: 110 }, plan).into()
}

/// Completes sources as a compiler without preparation does, and rewrites what completes them.
struct Upgrading {
    compiler: Compiler,
    plan: Arc<Plan>,
}

impl Preparation for Upgrading {
    fn prepare(&self, source: &Source) -> Prepared {
        let completion = self.compiler.options().completion.clone();
        let prepared = Prepared { completion, ..Prepared::default() };
        completed(prepared, self.compiler.includes(), &self.plan, source.stage)
    }
}

/// Included files with their new texts.
struct NewIncludes {
    inner: Includes,
    plan: Arc<Plan>,
    stage: Stage,
}

impl IncludeResolver for NewIncludes {
    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String> {
        let found = self.inner.resolve(path, form, from)?;
        // Modules of glisten are no old texts.
        if found.name.starts_with(EMBEDDED) {
            return Ok(found);
        }
        Ok(Included { text: part(&found.text, &self.plan, self.stage), ..found })
    }
}

/// The beginning of the names of embedded texts.
const EMBEDDED: &str = "<glisten>/";

#[cfg(test)]
mod tests {
    use super::{Refused, upgrade};
    use crate::Target;
    use glisten_front::Stage;
    use glisten_front::compiler::{Compiler, Options, Source};
    use glisten_front::source::{IncludeForm, IncludeResolver, Included};

    /// The file that every include names.
    struct Old;

    impl IncludeResolver for Old {
        fn resolve(&self, path: &str, _: IncludeForm, _: &str) -> Result<Included, String> {
            Ok(Included { name: path.to_owned(), text: "varying vec2 at;\n".into() })
        }
    }

    fn source(name: &str, stage: Stage, text: &str) -> Source {
        Source { name: name.into(), text: text.into(), stage }
    }

    #[test]
    fn stages_and_what_they_include_fit_together() {
        let sources = [
            source(
                "a.vert",
                Stage::Vertex,
                "#include \"at.glsl\"\nvoid main() { at = gl_Vertex.xy; gl_Position = ftransform(); }\n",
            ),
            source(
                "a.frag",
                Stage::Fragment,
                "#include \"at.glsl\"\nvoid main() { gl_FragColor = vec4(at, 0.0, 1.0); }\n",
            ),
        ];
        let compiler = Compiler::new(Options::default()).with_includes(Old);
        let upgraded = upgrade(&compiler, &sources, Target::Core330).expect("it can be rewritten");
        assert!(upgraded.texts[0].contains("in vec4 vertex;"), "{}", upgraded.texts[0]);
        assert!(upgraded.texts[1].contains("fragColor = vec4(at, 0.0, 1.0)"), "{}", upgraded.texts[1]);
        assert!(upgraded.notes.iter().any(|note| note.contains("`gl_Vertex` is `vertex`")), "{:?}", upgraded.notes);
    }

    #[test]
    fn what_cannot_be_rewritten_is_told() {
        let refused = |text: &str, target| {
            let sources = [source("a.vert", Stage::Vertex, text)];
            upgrade(&Compiler::new(Options::default()), &sources, target).expect_err("it cannot")
        };
        assert!(matches!(refused("void main() { x; }", Target::Core150), Refused::Wrong(_)));
        let clip = "void main() { gl_ClipVertex = gl_Vertex; gl_Position = ftransform(); }";
        assert!(matches!(refused(clip, Target::Core150), Refused::NoCounterpart("gl_ClipVertex")));
        let newer = refused("#version 330\nvoid main() { gl_Position = vec4(0.0); }", Target::Core150);
        assert_eq!(newer.to_string(), "`a.vert` is GLSL 3.30, newer than the target 1.50");
    }
}
