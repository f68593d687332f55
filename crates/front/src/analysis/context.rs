//! [`Analyzer`]: the state of the traversal of one shader.
//!
//! *In:* the syntax tree, the options, the types that all stages share. *Out:* a typed shader and diagnostics.
//!
//! *Holds:* expressions are appended in evaluation order, children before parents; `facts` runs parallel to them.
//! Every name that cannot be resolved becomes poison after its one message.

use super::scope::{Entry, Scopes};
use super::state::{Budget, Declared, Layouts, NoteTaker, Notes, Precisions, Uses};
use super::wording::{LONGEST_QUOTE, worded};
use crate::diagnostic::codes::names;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::hir::{
    Expr, ExprId, ExprKind, Function, FunctionId, GlobalId, Local, LocalId, ScalarValue, Shader, Stage, Storage,
    TypeId, Types, VarRef,
};
use crate::language::Feature;
use crate::source::{SourceMap, Span};
use crate::syntax::ast::{Ast, DeclarationKind, Extensions, Ident};

/// Facts about an expression besides its type.
#[derive(Clone, Copy, Debug, Default)]
struct Facts {
    /// The depth of the tree, counted along left operands too.
    depth: u32,
    /// Whether it is a constant expression (§4.3.3).
    constant: bool,
}

/// The function whose body is being analyzed.
pub(super) struct Body {
    pub(super) function: FunctionId,
    pub(super) loops: u32,
    pub(super) switches: u32,
    /// Whether it contains a `return`, or something broken that may have been one.
    pub(super) returns: bool,
    /// Locals that calls written out in other operations need, which are declared first.
    pub(super) parts: Vec<LocalId>,
}

/// The state of the traversal.
pub(super) struct Analyzer<'a> {
    pub(super) ast: &'a Ast,
    pub(super) stage: Stage,
    pub(super) strict: bool,
    pub(super) types: &'a mut Types,
    pub(super) sources: &'a SourceMap,
    diagnostics: &'a mut Diagnostics,
    pub(super) shader: Shader,
    /// Parallel to the shader's expressions.
    facts: Vec<Facts>,
    pub(super) scopes: Scopes,
    /// The extensions that are enabled at the current declaration.
    pub(super) extensions: Extensions,
    /// The types that have a default precision, in ES (§4.5.4).
    pub(super) precisions: Precisions,
    /// Whether nothing is reported: what is analyzed has an error that was reported.
    pub(super) is_quiet: bool,
    /// The current function.
    pub(super) body: Option<Body>,
    /// Types, functions, blocks and built-in variables by name.
    pub(super) declared: Declared,
    /// The first uses.
    pub(super) uses: Uses,
    /// Layouts and redeclarations that concern the whole shader.
    pub(super) layouts: Layouts,
    /// How much time, and how many variables, the shader may still take.
    pub(super) budget: Budget,
    /// The notes, if they are wanted.
    pub(super) notes: Option<NoteTaker>,
}

impl<'a> Analyzer<'a> {
    pub(super) fn new(
        ast: &'a Ast,
        stage: Stage,
        strict: bool,
        types: &'a mut Types,
        sources: &'a SourceMap,
        diagnostics: &'a mut Diagnostics,
        notes: Option<NoteTaker>,
    ) -> Self {
        Self {
            ast,
            stage,
            strict,
            types,
            sources,
            diagnostics,
            shader: Shader { mixes_outputs: ast.mixes_outputs, ..Shader::new(stage, ast.version) },
            facts: Vec::with_capacity(ast.exprs.len()),
            scopes: Scopes::new(!ast.version.has(Feature::SharedNames)),
            extensions: Extensions::empty(),
            precisions: Precisions::of(stage, ast.version),
            is_quiet: false,
            body: None,
            declared: Declared::default(),
            uses: Uses::default(),
            layouts: Layouts::default(),
            budget: Budget::default(),
            notes,
        }
    }

    /// Analyzes all declarations, then runs the checks that need the whole shader.
    pub(super) fn run(mut self) -> (Shader, Notes) {
        let ast = self.ast;
        self.check_stage();
        for declaration in &ast.declarations {
            if self.diagnostics.is_full() {
                break;
            }
            self.extensions = declaration.extensions;
            match &declaration.kind {
                DeclarationKind::Error | DeclarationKind::Empty => {}
                DeclarationKind::Broken(fragment) => self.global_fragment(fragment, declaration.span),
                DeclarationKind::Precision { qualifier, ty } => self.precision(qualifier, ty),
                DeclarationKind::Variables(variables) => self.global_variables(variables, declaration.span),
                DeclarationKind::Requalify { qualifiers, names } => {
                    self.requalify(qualifiers, names, declaration.span);
                }
                DeclarationKind::Block(block) => self.block(block),
                DeclarationKind::Prototype(header) => self.prototype(header),
                DeclarationKind::Function(header, body) => self.function(header, body),
            }
        }
        self.note_end();
        self.finish();
        (self.shader, self.notes.map(|taker| taker.notes).unwrap_or_default())
    }

    /// How many diagnostics there are.
    pub(super) fn n_diagnostics(&self) -> usize {
        self.diagnostics.len()
    }

    /// Changes the diagnostics from number `first` on.
    pub(super) fn amend(&mut self, first: usize, change: impl Fn(&mut Diagnostic)) {
        let mut index = 0;
        self.diagnostics.retain_mut(|found| {
            index += 1;
            if index > first {
                change(found);
            }
            true
        });
    }

    /// Reports a diagnostic.
    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        if !self.is_quiet {
            self.diagnostics.push(worded(diagnostic));
        }
    }

    /// The spelling of a name.
    pub(super) fn name(&self, ident: Ident) -> &'a str {
        self.ast.name(ident)
    }

    /// The name of a type, as written in GLSL.
    pub(super) fn type_name(&self, ty: TypeId) -> String {
        self.types.name(ty)
    }

    /// Adds an expression and its facts.
    pub(super) fn push(&mut self, kind: ExprKind, ty: TypeId, span: Span) -> ExprId {
        let facts = self.facts_of(&kind);
        self.shader.depth = self.shader.depth.max(facts.depth);
        self.facts.push(facts);
        self.shader.push(kind, ty, span)
    }

    /// An expression in error, whose cause has been reported.
    pub(super) fn poison(&mut self, span: Span) -> ExprId {
        self.push(ExprKind::Error, TypeId::ERROR, span)
    }

    /// A literal.
    pub(super) fn literal(&mut self, value: ScalarValue, span: Span) -> ExprId {
        self.push(ExprKind::Literal(value), TypeId::vector(value.scalar(), 1), span)
    }

    /// The expression of a handle.
    pub(super) fn expr_at(&self, id: ExprId) -> &Expr {
        self.shader.expr(id)
    }

    /// The type of an expression.
    pub(super) fn ty(&self, id: ExprId) -> TypeId {
        self.shader.expr(id).ty
    }

    /// The span of an expression.
    pub(super) fn span(&self, id: ExprId) -> Span {
        self.shader.expr(id).span
    }

    /// Whether an expression is a constant expression (§4.3.3).
    pub(super) fn is_constant(&self, id: ExprId) -> bool {
        self.facts.get(id.index()).is_some_and(|facts| facts.constant)
    }

    /// The text of an expression in quotes if it is short and outside macros, else `this`.
    pub(super) fn quote(&self, id: ExprId) -> String {
        let span = self.span(id);
        let text = self.sources.snippet(span);
        if text.is_empty() || text.len() > LONGEST_QUOTE || text.contains(['\n', '`']) || span.expansion.is_some() {
            return "this".into();
        }
        format!("`{text}`")
    }

    /// A local of the current function.
    pub(super) fn local(&self, id: LocalId) -> Option<&Local> {
        let body = self.body.as_ref()?;
        self.shader.functions.get(body.function.index())?.locals.get(id.index())
    }

    /// Adds a local to the current function.
    pub(super) fn add_local(&mut self, local: Local) -> Option<LocalId> {
        let function = self.current_function()?;
        function.locals.push(local);
        Some(LocalId::new(function.locals.len() - 1))
    }

    /// The current function.
    pub(super) fn current_function(&mut self) -> Option<&mut Function> {
        let id = self.body.as_ref()?.function;
        self.shader.functions.get_mut(id.index())
    }

    /// Enters a name, unless its scope already has it: that is reported, and the name is then poison.
    pub(super) fn enter(&mut self, name: Ident, entry: Entry) {
        if let Some(earlier) = self.scopes.find_here(name.symbol) {
            if earlier.entry != Entry::Poison {
                let spelling = self.name(name);
                self.report(
                    Diagnostic::new(
                        &names::REDEFINED,
                        name.span,
                        format!("`{spelling}` is declared twice in one scope"),
                    )
                    .here("declared again here")
                    .label(earlier.span, "first declared here"),
                );
            }
            self.scopes.replace(name.symbol, Entry::Poison);
            self.note_entry(name.span, Entry::Poison);
            return;
        }
        self.scopes.enter(name.symbol, entry, name.span);
        self.note_entry(name.span, entry);
    }

    /// Whether to keep searching for names similar to unknown ones: each search compares a name with all names in
    /// scope.
    pub(super) fn may_suggest(&mut self) -> Option<()> {
        let names = self.scopes.len();
        self.budget.may_suggest(names).then_some(())
    }

    /// Records a use of a global.
    pub(super) fn note_use(&mut self, global: GlobalId, span: Span) {
        self.uses.note(global, span);
    }

    fn facts_of(&self, kind: &ExprKind) -> Facts {
        let child = |id: &ExprId| self.facts.get(id.index()).copied().unwrap_or_default();
        let join = |a: Facts, b: Facts| Facts { depth: a.depth.max(b.depth), constant: a.constant && b.constant };
        let leaf = |constant| Facts { depth: 0, constant };
        let mut facts = match kind {
            ExprKind::Error | ExprKind::Literal(_) => leaf(true),
            ExprKind::Var(VarRef::Global(id)) => leaf(self.is_constant_global(*id)),
            ExprKind::Var(VarRef::Local(id)) => leaf(self.local(*id).is_some_and(|local| local.value.is_some())),
            ExprKind::Member(a, _) | ExprKind::Swizzle(a, _) | ExprKind::Convert(a) | ExprKind::Unary(_, a) => child(a),
            ExprKind::IncDec(_, a) => Facts { constant: false, ..child(a) },
            ExprKind::Index(a, b) | ExprKind::Binary(_, a, b) | ExprKind::Logical(_, a, b) => join(child(a), child(b)),
            ExprKind::Comma(a, b) => {
                let sequence = join(child(a), child(b));
                Facts { constant: sequence.constant && !self.ast.version.has(Feature::VariableSequences), ..sequence }
            }
            ExprKind::Assign(_, a, b) => Facts { constant: false, ..join(child(a), child(b)) },
            ExprKind::Ternary(a, b, c) => join(child(a), join(child(b), child(c))),
            ExprKind::Construct(_, list) => list.iter().map(child).fold(leaf(true), join),
            ExprKind::Call(_, list) => Facts { constant: false, ..list.iter().map(child).fold(leaf(true), join) },
            ExprKind::BuiltinCall(function, list) => {
                let facts = list.iter().map(child).fold(leaf(true), join);
                Facts { constant: facts.constant && function.is_foldable(), ..facts }
            }
        };
        facts.depth += 1;
        facts
    }

    fn is_constant_global(&self, id: GlobalId) -> bool {
        let global = self.shader.global(id);
        global.storage == Storage::Const && global.value.is_some()
    }
}
