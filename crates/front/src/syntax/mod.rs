//! From text to syntax tree.
//!
//! *In:* a [`SourceMap`] and the file to start with, the include resolver, and predefined macros. *Out:* an
//! [`ast::Ast`] of what was understood, and diagnostics.
//!
//! There are three steps, each lazy and each with its budgets. The lexer cuts text into tokens. The preprocessor runs
//! directives and expands macros (GLSL 1.50 §3.3), behind the [`TokenSource`](session::TokenSource) interface. The
//! parser follows the grammar (§9) and recovers at declarations and statements.
//!
//! *Holds:* types and scopes are unknown here; `S(x)` is a call of something named `S`. If the language is
//! unsupported, which is reported, the tree has no declarations.

pub mod ast;
pub mod directives;
pub mod keywords;
mod kind;
mod lexemes;
mod lexer;
pub mod names;
mod number;
mod parser;
mod preprocessor;
pub mod session;
pub mod token;
mod unstated;

use crate::diagnostic::Diagnostics;
use crate::language::Stage;
use crate::source::{Completion, FileId, IncludeResolver, SourceMap, Span};
use ast::{Ast, Profile, Version};
use directives::Directives;
pub use lexemes::Lexemes;
use names::Names;
use parser::Parser;
use preprocessor::Preprocessor;
pub(crate) use preprocessor::extension::warning_of_use;
pub use preprocessor::is_no_text;
use session::{ExtensionSets, ParseSession};
pub(crate) use unstated::{NOT_YET, of_later_word, of_version};

/// ParseOptions of a parse.
#[derive(Clone, Debug)]
pub struct ParseOptions {
    /// The stage.
    pub stage: Stage,
    /// Macros defined before the first line: name (with parameters, if it has any) and replacement text.
    pub defines: Vec<(String, String)>,
    /// Reports an error instead of a warning for what the specification forbids and every driver accepts.
    pub strict: bool,
    /// The additions of an engine to the text.
    pub completion: Completion,
}

/// Parses the shader in `file`.
pub fn parse(
    sources: &mut SourceMap,
    file: FileId,
    options: &ParseOptions,
    includes: &(dyn IncludeResolver + Sync),
    diagnostics: &mut Diagnostics,
) -> Ast {
    let extension_sets = ExtensionSets::default();
    let (version, names) = (empty_tree().version, preprocessor::predefined::names());
    let mut session = ParseSession { sources, diagnostics, version, names, extension_sets };
    let mut preprocessor = Preprocessor::new(&mut session, file, &options.defines, options.strict, includes);
    preprocessor.complete(&mut session, file, &options.completion);
    let mut ast = Parser::new(&mut preprocessor, &mut session, empty_tree(), options.strict).translation_unit();
    let outcome = preprocessor.finish();
    if !outcome.supported {
        ast.declarations.clear();
    }
    ast.version = outcome.version;
    ast.late_version = outcome.late_version;
    ast.invariant_all = outcome.invariant_all;
    ast.allows = outcome.allows;
    ast.extension_lines = outcome.extension_lines;
    ast.inclusions = outcome.inclusions;
    ast.unrolled = outcome.unrolled;
    ast.preludes = outcome.preludes;
    ast.macros = outcome.macros;
    ast.macros_with_parameters = outcome.macros_with_parameters;
    ast.asked = outcome.asked;
    ast.mixes_outputs = options.completion.mixes_outputs;
    ast.replaced_samplers.clone_from(&options.completion.replaced_samplers);
    ast.directives = outcome.directives;
    ast.names = session.names;
    ast
}

fn empty_tree() -> Ast {
    Ast {
        version: Version { number: 110, profile: Profile::Core, span: Span::default() },
        declarations: Vec::new(),
        exprs: Vec::new(),
        names: Names::default(),
        late_version: None,
        invariant_all: None,
        allows: Vec::new(),
        extension_lines: Vec::new(),
        inclusions: Vec::new(),
        unrolled: Vec::new(),
        preludes: Vec::new(),
        macros: Vec::new(),
        macros_with_parameters: Vec::new(),
        asked: Vec::new(),
        mixes_outputs: false,
        replaced_samplers: Vec::new(),
        directives: Directives::default(),
    }
}
