//! [`Compiler`] turns texts into a [`Program`] and diagnostics. It is the only entry to the front end.

mod kept;
mod parts;
mod preparation;
mod unversioned;

pub use kept::{Kept, Shared};
pub use parts::{Before, Begun, OtherState, Part};
use preparation::Changed;
pub use preparation::{Preparation, Prepared, Problem, SourceSettings};

use crate::analysis::{analyze, analyze_with_notes, keep_decisive, keep_language, keep_understood, point_to_engine};
use crate::diagnostic::codes::general::{BAD_HEADER, BINARY_SOURCE, TOO_LARGE};
use crate::diagnostic::codes::{names, preprocess};
use crate::diagnostic::{Area, Code, Diagnostic, Diagnostics, Levels};
use crate::hir::{Origin, Stage, Types};
use crate::index::{Inspection, View};
use crate::link::{Bindings, FixedState, Program, Understood, check_understood, link};
use crate::source::{Completion, Edits, FileId, IncludeResolver, Language, NoIncludes, SourceMap, Span, whole_text};
use crate::syntax;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The options of a compilation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Macros defined before the first line: name and replacement text (`-D NAME=VALUE`).
    pub defines: Vec<(String, String)>,
    /// Reports an error instead of a warning for what the specification forbids and every driver accepts.
    pub strict: bool,
    /// `glBindAttribLocation`: name and location.
    pub attribute_locations: Vec<(String, u32)>,
    /// `glBindFragDataLocation`: name and color number.
    pub frag_data_locations: Vec<(String, u32)>,
    /// The state of the fixed-function pipeline that programs of that time are compiled for.
    pub fixed: FixedState,
    /// The additions of an engine to each source: the version of those without a `#version` line, texts before them. A
    /// [`Preparation`] decides for each source instead.
    pub completion: Completion,
    /// Names of macros, defined or not, for [`Compilation::asked`].
    pub watched: Vec<String>,
}

impl Options {
    /// The options that the linker uses.
    fn bindings(&self) -> Bindings<'_> {
        let (attribute_locations, frag_data_locations) = (&self.attribute_locations, &self.frag_data_locations);
        Bindings { attribute_locations, frag_data_locations, fixed: self.fixed, stages_apart: false }
    }
}

/// The text of a shader.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// The name for diagnostics and for resolving includes: the path as the user wrote it.
    pub name: String,
    /// The text. Bytes that are not UTF-8 are replaced by U+FFFD, which is legal only in comments.
    pub text: Arc<str>,
    /// The stage.
    pub stage: Stage,
}

/// The result of a compilation.
#[derive(Clone, Debug)]
pub struct Compilation {
    /// The name of the program: the stem of the first source's name.
    pub name: String,
    /// All texts, including the included files.
    pub sources: SourceMap,
    /// The linked program, if there are no errors.
    pub program: Option<Program>,
    /// Each source as a driver gets it, with or without errors: macros, preludes and includes are in the text.
    pub texts: Vec<Arc<str>>,
    /// All diagnostics.
    pub diagnostics: Diagnostics,
    /// The files of each source: its own, then those that it includes, itself or by another include, by their first use.
    pub read: Vec<Vec<FileId>>,
    /// Those of the [`watched`](Options::watched) names that the result depends on. With any other definitions of the rest of
    /// them, the result is the same.
    pub asked: BTreeSet<String>,
}

/// Compiles programs. It holds options but no state: one compiler can be used any number of times and from many
/// threads.
#[derive(Clone)]
pub struct Compiler {
    options: Options,
    includes: Arc<dyn IncludeResolver + Send + Sync>,
    preparation: Option<Arc<dyn Preparation + Send + Sync>>,
    /// Applied to the diagnostics of each compilation; `None` if the caller applies its own.
    levels: Option<Levels>,
    stages_apart: bool,
}

impl Compiler {
    /// A compiler that resolves no includes. Comments `// glisten: allow(CODE)` are applied to its diagnostics.
    pub fn new(options: Options) -> Self {
        let includes = Arc::new(NoIncludes);
        Self { options, includes, preparation: None, levels: Some(Levels::default()), stages_apart: false }
    }

    /// The same compiler, which applies these levels to its diagnostics.
    #[must_use]
    pub fn with_levels(self, levels: Levels) -> Self {
        Self { levels: Some(levels), ..self }
    }

    /// The same compiler, which reports everything, for a caller that applies levels itself ([`Levels::apply`]): those of
    /// the file that a diagnostic is in, say.
    #[must_use]
    pub fn without_levels(self) -> Self {
        Self { levels: None, ..self }
    }

    /// This compiler with a resolver for `#include`.
    #[must_use]
    pub fn with_includes(self, includes: impl IncludeResolver + Send + Sync + 'static) -> Self {
        Self { includes: Arc::new(includes), ..self }
    }

    /// This compiler, which completes each source so.
    #[must_use]
    pub fn with_preparation(self, preparation: impl Preparation + Send + Sync + 'static) -> Self {
        Self { preparation: Some(Arc::new(preparation)), ..self }
    }

    /// This compiler, which changes what completes each source.
    #[must_use]
    pub fn with_change(self, change: impl Fn(&Source, Prepared) -> Prepared + Send + Sync + 'static) -> Self {
        let inner = self.preparation.clone();
        let completion = self.options.completion.clone();
        self.with_preparation(Changed { inner, completion, change: Arc::new(change) })
    }

    /// This compiler for a host that builds each stage by itself, as those of Vulkan do: names of uniforms are those of a stage then.
    #[must_use]
    pub fn with_stages_apart(self) -> Self {
        Self { stages_apart: true, ..self }
    }

    fn bindings(&self) -> Bindings<'_> {
        Bindings { stages_apart: self.stages_apart, ..self.options.bindings() }
    }

    /// This compiler with other options.
    #[must_use]
    pub fn with_options(&self, options: Options) -> Self {
        Self { options, ..self.clone() }
    }

    /// This compiler for sources about which a host says more, if what completes the sources takes such settings.
    #[must_use]
    pub fn with_settings(&self, settings: &SourceSettings) -> Option<Self> {
        let preparation = self.preparation.as_ref()?.with_settings(settings)?;
        Some(Self { preparation: Some(preparation), ..self.clone() })
    }

    /// The resolver for `#include`.
    pub fn includes(&self) -> Arc<dyn IncludeResolver + Send + Sync> {
        Arc::clone(&self.includes)
    }

    /// The options.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Compiles the stages of one program.
    ///
    /// ```
    /// use glisten_front::{Compiler, Options, Source, Stage};
    ///
    /// let source = Source {
    ///     name: "red.frag".into(),
    ///     text: "#version 150\nout vec4 color;\nvoid main() { color = vec4(1.0, 0.0, 0.0, 1.0); }\n".into(),
    ///     stage: Stage::Fragment,
    /// };
    /// let compilation = Compiler::new(Options::default()).compile(&[source]);
    /// assert!(!compilation.diagnostics.has_errors());
    /// let program = compilation.program.expect("without errors there is a program");
    /// assert_eq!(program.name, "red");
    /// assert_eq!(program.interface.outputs[0].name, "color");
    /// ```
    pub fn compile(&self, sources: &[Source]) -> Compilation {
        self.compile_into(SourceMap::default(), sources)
    }

    /// Compiles like [`Self::compile`], but adds the texts to `map`. A file that names shaders can then share one map
    /// with them, so that diagnostics of both are shown from it.
    pub fn compile_into(&self, map: SourceMap, sources: &[Source]) -> Compilation {
        self.compile_and(map, sources, Facts::default()).0
    }

    /// Compiles like [`Self::compile`], and keeps what each name denotes, for programs that show the texts to their author. `probe` is
    /// a name in the texts that stands where the author wants to know what could stand there.
    pub fn inspect(&self, sources: &[Source], probe: Option<&str>) -> (Compilation, Inspection) {
        let observer = Observer { probe, views: Vec::new() };
        let facts = Facts { observer: Some(observer), ..Facts::default() };
        self.compile_and(SourceMap::default(), sources, facts)
    }

    fn compile_and(&self, map: SourceMap, sources: &[Source], mut facts: Facts<'_>) -> (Compilation, Inspection) {
        let name = sources.first().map_or_else(String::new, |source| stem(&source.name));
        let mut begun = Begun::new(map);
        sources.iter().for_each(|source| begun.read(self, source, &mut facts));
        let Facts { asked, read, observer } = facts;
        begun.told(asked, read);
        begun.end(self, name, observer.map(|observer| observer.views))
    }

    /// Links the stages. If there are errors, only compares the certain declarations. Other declarations of a shader
    /// with errors may differ from its author's intention, and linking would report follow-up errors.
    fn link(
        &self,
        name: String,
        types: Types,
        shaders: Vec<Understood>,
        diagnostics: &mut Diagnostics,
    ) -> Option<Program> {
        if diagnostics.has_errors() {
            if shaders.len() > 1 && shaders.iter().any(|understood| !understood.is_complete) {
                note_that_nothing_is_compared(diagnostics);
            }
            if !diagnostics.is_full() {
                check_understood(types, shaders, diagnostics);
            }
            return None;
        }
        let shaders = shaders.into_iter().map(|understood| understood.shader).collect();
        link(name, types, shaders, self.bindings(), diagnostics)
    }

    /// The source as its engine completes it, with the macros of the options.
    fn prepared(&self, source: &Source) -> Prepared {
        let Some(preparation) = &self.preparation else {
            let completion = self.options.completion.clone();
            return Prepared { defines: self.options.defines.clone(), completion, ..Prepared::default() };
        };
        let mut prepared = preparation.prepare(source);
        let own = &self.options.defines;
        prepared.defines.retain(|(name, _)| own.iter().all(|(other, _)| other != name));
        prepared.defines.extend_from_slice(own);
        prepared
    }

    /// Parses and analyzes one text.
    fn shader(
        &self,
        source: &Source,
        types: &mut Types,
        map: &mut SourceMap,
        diagnostics: &mut Diagnostics,
        facts: &mut Facts<'_>,
    ) -> Option<Understood> {
        facts.read.push(Vec::new());
        facts.observer.iter_mut().for_each(|observer| observer.views.push(None));
        let mut prepared = self.prepared(source);
        let assumed = self.assumed(source, &prepared);
        if let Some(assumed) = &assumed {
            prepared.completion.assumed_version = Some(assumed.version.to_owned());
        }
        let text = prepared.text.as_ref().unwrap_or(&source.text);
        let Some(file) = map.add(source.name.as_str(), Arc::clone(text)) else {
            let message = format!("there is no room for `{}`", source.name);
            diagnostics.push(Diagnostic::new(&TOO_LARGE, Span::default(), message));
            return None;
        };
        let (strict, first_error) = (self.options.strict, diagnostics.len());
        report_problems(&prepared.problems, file, map, diagnostics);
        diagnostics.extend(assumed.map(|assumed| assumed.warning(map.file(file).base())));
        let Prepared { defines, completion, includes, .. } = prepared;
        let options = syntax::ParseOptions { stage: source.stage, defines, strict, completion };
        let includes = includes.as_ref().unwrap_or(&self.includes);
        let ast = syntax::parse(map, file, &options, &**includes, diagnostics);
        map.set_language(file, Language { number: ast.version.number, es: ast.version.is_es() });
        facts.add(file, &ast, &self.options.watched);
        let mut noted = None;
        let mut shader = match &mut facts.observer {
            None => analyze(&ast, source.stage, strict, types, map, diagnostics),
            Some(observer) => {
                let probe = observer.probe;
                let (shader, notes) = analyze_with_notes(&ast, source.stage, strict, types, map, diagnostics, probe);
                noted = Some((shader.clone(), notes));
                shader
            }
        };
        if ast.version.span.is_known() && map.file_of(ast.version.span) != Some(file) {
            // What is said about the whole shader is said about its own text.
            let start = map.file(file).base();
            shader.version.span = Span::new(start, start);
        }
        shader.origin = Origin {
            file: Some(file),
            inclusions: ast.inclusions.clone(),
            allows: ast.allows.iter().map(|allow| (allow.span, allow.codes.clone())).collect(),
        };
        let edits = Edits { inclusions: &ast.inclusions, unrolled: &ast.unrolled, preludes: &ast.preludes };
        // A macro that nothing asks for is no part of the text: with and without it, the outputs are the same.
        let mut defines = options.defines;
        defines.retain(|(name, _)| ast.asks(name.split('(').next().unwrap_or(name)));
        shader.texts.push(whole_text(map, file, ast.version.span, edits, &defines));
        let is_complete = !keep_understood(&ast, &mut shader, types, map, diagnostics, first_error);
        forget_names_of_missing_includes(map, diagnostics, first_error);
        forget_names_of_bad_headers(diagnostics, first_error);
        keep_language(diagnostics, map, first_error);
        keep_decisive(diagnostics, first_error, ast.late_version);
        point_to_engine(&shader, diagnostics, first_error);
        if let (Some((shader, notes)), Some(observer)) = (noted, &mut facts.observer)
            && let Some(slot) = observer.views.last_mut()
        {
            *slot = Some(View { file, ast, shader, notes });
        }
        Some(Understood { shader, is_complete })
    }
}

/// The facts about the texts of a compilation that its result tells.
#[derive(Default)]
struct Facts<'p> {
    /// [`Compilation::asked`].
    asked: BTreeSet<String>,
    /// [`Compilation::read`], up to the source that is read now.
    read: Vec<Vec<FileId>>,
    /// The facts that are kept for [`Compiler::inspect`].
    observer: Option<Observer<'p>>,
}

/// Keeps the phases' results.
struct Observer<'p> {
    probe: Option<&'p str>,
    views: Vec<Option<View>>,
}

impl Facts<'_> {
    /// Adds those of the last source.
    fn add(&mut self, own: FileId, ast: &syntax::ast::Ast, watched: &[String]) {
        self.asked.extend(watched.iter().filter(|name| ast.asks(name)).cloned());
        let Some(read) = self.read.last_mut() else { return };
        for file in [own].into_iter().chain(ast.inclusions.iter().filter_map(|inclusion| inclusion.file)) {
            if !read.contains(&file) {
                read.push(file);
            }
        }
    }
}

/// Says at the first error of syntax that the stages are not compared as far as it reaches.
fn note_that_nothing_is_compared(diagnostics: &mut Diagnostics) {
    let mut is_told = false;
    diagnostics.retain_mut(|found| {
        if found.is_error() && found.code.area() == Area::Syntax && !is_told {
            is_told = true;
            found.notes.push("what is declared there is not compared with the other stage yet".to_owned());
        }
        true
    });
}

/// Reports what is wrong with a source for its engine.
fn report_problems(problems: &[Problem], file: FileId, map: &SourceMap, diagnostics: &mut Diagnostics) {
    let base = map.file(file).base();
    for problem in problems {
        let span = Span::new(base + problem.range.start as u32, base + problem.range.end as u32);
        let mut diagnostic = Diagnostic::new(problem.code, span, problem.message.clone());
        if *problem.code == BAD_HEADER {
            diagnostic = diagnostic.here("it may declare names, so names that nothing declares are no errors here");
        }
        diagnostics.push(diagnostic.maybe_help(problem.help.clone()));
    }
}

/// Variables that nothing declares are no errors where an engine's header cannot be read, which may declare them: drops what was
/// reported about them, from diagnostic `first` on.
fn forget_names_of_bad_headers(diagnostics: &mut Diagnostics, first: usize) {
    if !diagnostics.iter().skip(first).any(|found| *found.code == BAD_HEADER) {
        return;
    }
    let mut index = 0;
    diagnostics.retain_mut(|found| {
        index += 1;
        index <= first || *found.code != names::UNDECLARED
    });
}

/// Names that nothing declares are no errors where an include is missing that may declare them: drops what was reported
/// about them, from diagnostic `first` on. Names before the include in its file remain errors.
fn forget_names_of_missing_includes(map: &SourceMap, diagnostics: &mut Diagnostics, first: usize) {
    static ABOUT_NAMES: &[&Code] = &[
        &names::UNDECLARED,
        &names::UNKNOWN_TYPE,
        &names::UNKNOWN_FUNCTION,
        &preprocess::UNDEFINED_IN_CONDITION,
        &preprocess::MALFORMED_CONDITION,
    ];
    let is_missing = |diagnostic: &&Diagnostic| {
        *diagnostic.code == preprocess::INCLUDE_NOT_FOUND || *diagnostic.code == BINARY_SOURCE
    };
    let place = |diagnostic: &Diagnostic| {
        let span = map.call_site(diagnostic.primary.span);
        (map.file_of(span), span.start)
    };
    let missing: Vec<_> = diagnostics.iter().skip(first).filter(is_missing).map(place).collect();
    if missing.is_empty() {
        return;
    }
    let mut index = 0;
    diagnostics.retain_mut(|diagnostic| {
        index += 1;
        let (file, start) = place(diagnostic);
        let later = missing.iter().any(|(other, include)| *other != file || *include < start);
        index <= first || !later || !ABOUT_NAMES.contains(&diagnostic.code)
    });
}

/// The file name of a path, without its folder and its last extension.
fn stem(name: &str) -> String {
    let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
    file.rsplit_once('.').map_or(file, |(stem, _)| stem).to_owned()
}

#[cfg(test)]
mod tests {
    use super::{Compiler, Options, Source};
    use crate::hir::Stage;

    #[test]
    fn what_a_result_depends_on_is_told() {
        let text = "#version 150\n#ifdef LIT\n#ifdef SHADOWS\n#endif\n#endif\n#if 0 && defined(DEAD)\nDEAD\n#endif\n\
                    #ifdef OFF\nuniform float GONE;\n#endif\nout vec4 c;\nvoid main() { c = vec4(LEVEL); }\n";
        let asked = |defines: &[(&str, &str)]| {
            let watched = ["LIT", "SHADOWS", "GONE", "LEVEL", "DEEP", "NEVER", "OFF"].map(str::to_owned).to_vec();
            let defines = defines.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
            let options = Options { defines, watched, ..Options::default() };
            let source = Source { name: "a.frag".into(), text: text.into(), stage: Stage::Fragment };
            let done = Compiler::new(options).compile(&[source]);
            done.asked.into_iter().collect::<Vec<_>>().join(" ")
        };
        assert_eq!(asked(&[("LEVEL", "1.0"), ("NEVER", "1")]), "LEVEL LIT OFF");
        assert_eq!(asked(&[("LEVEL", "DEEP"), ("DEEP", "0.5"), ("LIT", "1")]), "DEEP LEVEL LIT OFF SHADOWS");
    }
}
