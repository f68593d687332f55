//! The syntax tree of one shader: what the text says, before any meaning.
//!
//! Expressions are stored in one arena, children before parents, so that a chain of ten thousand `+` is no deeper for
//! the allocator than a chain of two. A traversal must still not recurse along left operands: use a loop.

#![expect(missing_docs, reason = "fields of variants are named for the grammar")]

use super::directives::Directives;
use super::names::Names;
use super::token::Symbol;
pub use crate::language::{Behavior, Extensions, IncDec, Profile, Version};
use crate::source::{FileId, Inclusion, Span};

/// The handle of an expression in an [`Ast`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ExprId(u32);

impl ExprId {
    /// The handle of the expression at an index.
    pub(super) fn at(index: usize) -> Self {
        Self(index as u32)
    }

    /// The index in the arena.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A name and its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ident {
    /// The name.
    pub symbol: Symbol,
    /// The position.
    pub span: Span,
}

/// A whole shader.
#[derive(Clone, Debug)]
pub struct Ast {
    /// The version of the language.
    pub version: Version,
    /// The global declarations in order.
    pub declarations: Vec<Declaration>,
    /// All expressions.
    pub exprs: Vec<Expr>,
    /// All names.
    pub names: Names,
    /// A `#version` line that tokens come before, which is an error (§3.3).
    pub late_version: Option<Span>,
    /// The position of `#pragma STDGL invariant(all)`, if there is one (§4.6.1).
    pub invariant_all: Option<Span>,
    /// The comments of the form `// glisten: allow(CODE, ...)`.
    pub allows: Vec<Allow>,
    /// All `#extension` lines that enabled something, for messages.
    pub extension_lines: Vec<(String, Behavior, Span)>,
    /// The files that `#include` lines brought in, in reading order.
    pub inclusions: Vec<Inclusion>,
    /// The loops that were unrolled, in order.
    pub unrolled: Vec<crate::source::Unrolled>,
    /// The texts of an engine that were read before the source, in order.
    pub preludes: Vec<FileId>,
    /// The macros without parameters that are defined at the end, for "did you mean".
    pub macros: Vec<std::sync::Arc<str>>,
    /// The macros with parameters that are defined at the end.
    pub macros_with_parameters: Vec<std::sync::Arc<str>>,
    /// For each name by its symbol, whether the tree depends on what macro it names.
    pub asked: Vec<bool>,
    /// Whether an engine makes outputs of `gl_FragColor` and `gl_FragData`.
    pub mixes_outputs: bool,
    /// The names of samplers that an engine replaces where they are no call.
    pub replaced_samplers: Vec<String>,
    /// The directives and comments that the preprocessor met.
    pub directives: Directives,
}

/// A comment `// glisten: allow(CODE)`. It silences warnings of that code on its own line or, if it stands alone, on
/// the next line of code.
#[derive(Clone, Debug)]
pub struct Allow {
    /// The comment.
    pub span: Span,
    /// Identifiers or names of codes.
    pub codes: Vec<String>,
}

impl Ast {
    /// Adds an expression.
    pub fn push(&mut self, kind: ExprKind, span: Span) -> ExprId {
        let id = ExprId(self.exprs.len() as u32);
        self.exprs.push(Expr { kind, span });
        id
    }

    /// Whether the tree depends on what macro `name` names, or that it names none.
    pub fn asks(&self, name: &str) -> bool {
        let symbol = self.names.get(name);
        symbol.is_some_and(|symbol| self.asked.get(symbol.index()).copied().unwrap_or(false))
    }

    /// The expression of a handle that [`Self::push`] returned.
    pub fn expr(&self, id: ExprId) -> &Expr {
        // Only `push` of this tree makes an `ExprId`.
        &self.exprs[id.0 as usize]
    }

    /// The spelling of a name.
    pub fn name(&self, ident: Ident) -> &str {
        self.names.spelling(ident.symbol)
    }
}

/// An expression and its span.
#[derive(Clone, Debug)]
pub struct Expr {
    /// The kind.
    pub kind: ExprKind,
    /// The span.
    pub span: Span,
}

/// A literal (§4.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Literal {
    /// `true`, `false`
    Bool(bool),
    /// `1`, `0x1F`, `017`. A literal too large for `int` but not for 32 bits keeps its bits.
    Int(i32),
    /// `1u`
    Uint(u32),
    /// `1.0`, `1e3f`: the decimal value, rounded once to f32 (§4.1.4).
    Float(f32),
}

/// The unary operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UnaryOp {
    /// `+a`
    Plus,
    /// `-a`
    Minus,
    /// `!a`
    Not,
    /// `~a`
    BitNot,
}

/// The binary operators, without assignment and sequence (§5.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BinaryOp {
    Mul,
    Div,
    Rem,
    Add,
    Sub,
    Shl,
    Shr,
    Less,
    Greater,
    LessEqual,
    GreaterEqual,
    Equal,
    NotEqual,
    BitAnd,
    BitXor,
    BitOr,
    LogicalAnd,
    LogicalXor,
    LogicalOr,
}

impl BinaryOp {
    /// The spelling in GLSL.
    pub fn spelling(self) -> &'static str {
        match self {
            Self::Mul => "*",
            Self::Div => "/",
            Self::Rem => "%",
            Self::Add => "+",
            Self::Sub => "-",
            Self::Shl => "<<",
            Self::Shr => ">>",
            Self::Less => "<",
            Self::Greater => ">",
            Self::LessEqual => "<=",
            Self::GreaterEqual => ">=",
            Self::Equal => "==",
            Self::NotEqual => "!=",
            Self::BitAnd => "&",
            Self::BitXor => "^",
            Self::BitOr => "|",
            Self::LogicalAnd => "&&",
            Self::LogicalXor => "^^",
            Self::LogicalOr => "||",
        }
    }
}

/// The kinds of expressions.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// Text that made no sense and has been reported.
    Error(Vec<ExprId>),
    /// A literal.
    Literal(Literal),
    /// A name.
    Name(Ident),
    /// A unary operation.
    Unary(UnaryOp, ExprId),
    /// An increment or decrement.
    IncDec(IncDec, ExprId),
    /// A binary operation, with the span of the operator itself.
    Binary(BinaryOp, Span, ExprId, ExprId),
    /// `a = b` or `a op= b`, with the span of the operator itself.
    Assign(Option<BinaryOp>, Span, ExprId, ExprId),
    /// `a ? b : c`
    Ternary(ExprId, ExprId, ExprId),
    /// `a, b`
    Comma(ExprId, ExprId),
    /// `a[b]`. `a[]` before the arguments of a call (`float[](..)` of a struct type) has no index.
    Index(ExprId, Option<ExprId>),
    /// `a.b`: a member or a swizzle.
    Field(ExprId, Ident),
    /// `f(a, b)`, `S(a)`: a function call or the constructor of a struct.
    Call(Ident, Vec<ExprId>),
    /// `vec4(a)`, `float[2](a, b)`, `S[2](a, b)`: a constructor whose type is evident from the syntax.
    Construct(Box<TypeSpec>, Vec<ExprId>),
    /// `a.length()`, or any other method, which is an error.
    Method(ExprId, Ident, Vec<ExprId>),
    /// `{a, b}` as an initializer (ARB_shading_language_420pack).
    List(Vec<ExprId>),
}

/// A type as written.
#[derive(Clone, Debug)]
pub struct TypeSpec {
    /// The type without its arrays.
    pub base: TypeBase,
    /// `[n]` after the type, outermost first; an empty `[]` has no size.
    pub array: Vec<ArrayDim>,
    /// The span.
    pub span: Span,
}

/// `[n]` or `[]`.
#[derive(Clone, Copy, Debug)]
pub struct ArrayDim {
    /// The size.
    pub size: Option<ExprId>,
    /// The span from bracket to bracket.
    pub span: Span,
}

/// A type without its arrays.
#[derive(Clone, Debug)]
pub enum TypeBase {
    /// A type that has been reported.
    Error,
    /// `void`
    Void,
    /// A type keyword: `vec4`, `mat2x3`, `sampler2DShadow`, as it is spelled.
    Keyword(Symbol),
    /// The name of a struct.
    Named(Ident),
    /// A struct declared here.
    Struct(StructSpec),
}

/// `struct S { ... }`
#[derive(Clone, Debug)]
pub struct StructSpec {
    /// The name, if it has one.
    pub name: Option<Ident>,
    /// The members, one entry for each declaration.
    pub members: Vec<MemberDecl>,
}

/// `vec3 a, b[2];` in a struct or a block.
#[derive(Clone, Debug)]
pub struct MemberDecl {
    /// The qualifiers, in source order.
    pub qualifiers: Vec<Qualifier>,
    /// The type.
    pub ty: TypeSpec,
    /// The names.
    pub declarators: Vec<Declarator>,
    /// The span of the whole declaration.
    pub span: Span,
}

/// A name in a declaration, with its array dimensions and its initializer.
#[derive(Clone, Debug)]
pub struct Declarator {
    /// The name.
    pub name: Ident,
    /// `[n]` after the name, outermost first.
    pub array: Vec<ArrayDim>,
    /// The expression after `=`.
    pub initializer: Option<ExprId>,
}

/// A qualifier and its position. In 1.50 order matters (§4.7); the analysis checks it.
#[derive(Clone, Debug)]
pub struct Qualifier {
    /// The kind.
    pub kind: QualifierKind,
    /// The position.
    pub span: Span,
}

/// The qualifiers of §4.3 to §4.6.
#[derive(Clone, Debug, PartialEq)]
pub enum QualifierKind {
    Const,
    Attribute,
    Varying,
    In,
    Out,
    Inout,
    Uniform,
    Centroid,
    Sample,
    Smooth,
    Flat,
    Noperspective,
    Invariant,
    Precise,
    Highp,
    Mediump,
    Lowp,
    Layout(Vec<LayoutId>),
}

/// `name` or `name = value` in a `layout(...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayoutId {
    /// The name.
    pub name: Ident,
    /// The value: an expression, which 1.50 requires to be an integer literal.
    pub value: Option<ExprId>,
    /// Whether the value is in parentheses, and so not a literal.
    pub parenthesized: bool,
}

/// A global declaration.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// The kind.
    pub kind: DeclarationKind,
    /// The span.
    pub span: Span,
    /// The extensions that are enabled here.
    pub extensions: Extensions,
}

/// The kinds of global declarations.
#[derive(Clone, Debug)]
pub enum DeclarationKind {
    /// A declaration that has been reported.
    Error,
    /// A declaration that has been reported, with what was understood of it.
    Broken(Box<Fragment>),
    /// A lone `;`.
    Empty,
    /// `precision highp float;`
    Precision { qualifier: Qualifier, ty: TypeSpec },
    /// `uniform mat4 m, n;`, `struct S {..};`
    Variables(VariableDecl),
    /// `invariant gl_Position, a;`, `layout(triangles) in;`, `centroid a;`: qualifiers without a type.
    Requalify { qualifiers: Vec<Qualifier>, names: Vec<Ident> },
    /// `uniform B { .. } b[2];`
    Block(BlockDecl),
    /// `float f(float x);`
    Prototype(FunctionHeader),
    /// `float f(float x) { .. }`
    Function(FunctionHeader, Vec<Stmt>),
}

/// The understood part of a statement or declaration that has an error.
#[derive(Clone, Debug)]
pub struct Fragment {
    /// The names that it declares, in source order.
    pub names: Vec<Ident>,
    /// The variables among them whose type was read to its end.
    pub variables: Option<VariableDecl>,
    /// The expressions that belong to no variable.
    pub rest: Option<ExprId>,
}

impl Fragment {
    /// Whether nothing was understood.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty() && self.variables.is_none() && self.rest.is_none()
    }
}

/// Variables of one type.
#[derive(Clone, Debug)]
pub struct VariableDecl {
    /// The qualifiers, in source order.
    pub qualifiers: Vec<Qualifier>,
    /// The type.
    pub ty: TypeSpec,
    /// The names; none in `struct S {..};`.
    pub declarators: Vec<Declarator>,
}

/// An interface block (§4.3.7).
#[derive(Clone, Debug)]
pub struct BlockDecl {
    /// The qualifiers, in source order.
    pub qualifiers: Vec<Qualifier>,
    /// The block's name.
    pub name: Ident,
    /// The members.
    pub members: Vec<MemberDecl>,
    /// The instance name and its arrays.
    pub instance: Option<(Ident, Vec<ArrayDim>)>,
}

/// The header of a function (§6.1).
#[derive(Clone, Debug)]
pub struct FunctionHeader {
    /// The qualifiers before the return type.
    pub qualifiers: Vec<Qualifier>,
    /// The return type.
    pub ty: TypeSpec,
    /// The name.
    pub name: Ident,
    /// The parameters; `(void)` has none.
    pub params: Vec<ParamDecl>,
    /// Whether all parameters could be read.
    pub is_whole: bool,
    /// The span of the header alone.
    pub span: Span,
}

/// A parameter.
#[derive(Clone, Debug)]
pub struct ParamDecl {
    /// The qualifiers, in source order.
    pub qualifiers: Vec<Qualifier>,
    /// The type.
    pub ty: TypeSpec,
    /// The name, if it has one.
    pub name: Option<Ident>,
    /// `[n]` after the name.
    pub array: Vec<ArrayDim>,
    /// The span.
    pub span: Span,
}

/// A statement (§6.2 to §6.4).
#[derive(Clone, Debug)]
pub struct Stmt {
    /// The kind.
    pub kind: StmtKind,
    /// The span.
    pub span: Span,
}

/// The kinds of statements.
#[derive(Clone, Debug)]
pub enum StmtKind {
    /// A statement that has been reported.
    Error,
    /// A statement that has been reported, with what was understood of it.
    Broken(Box<Fragment>),
    /// `;`
    Empty,
    /// `a;`
    Expr(ExprId),
    /// A local declaration.
    Variables(VariableDecl),
    /// `precision highp float;` inside a function.
    Precision { qualifier: Qualifier, ty: TypeSpec },
    /// `invariant a;` inside a function, an error that the analysis explains.
    Requalify { qualifiers: Vec<Qualifier>, names: Vec<Ident> },
    /// A prototype inside a function, an error that the analysis explains.
    Prototype(FunctionHeader),
    /// `{ .. }`
    Block(Vec<Stmt>),
    /// `if (a) .. else if (b) .. else ..`, flattened: a chain of any length is one statement.
    If { arms: Vec<(ExprId, Stmt)>, otherwise: Option<Box<Stmt>> },
    /// `switch (a) { .. }`: labels and statements in source order.
    Switch { selector: ExprId, body: Vec<SwitchItem> },
    /// `for (init; condition; step) body`
    For { init: Box<Stmt>, condition: Option<Condition>, step: Option<ExprId>, body: Box<Stmt> },
    /// `while (condition) body`
    While { condition: Condition, body: Box<Stmt> },
    /// `do body while (condition);`
    DoWhile { body: Box<Stmt>, condition: ExprId },
    /// `continue;`
    Continue,
    /// `break;`
    Break,
    /// `return;`, `return a;`
    Return(Option<ExprId>),
    /// `discard;`
    Discard,
}

/// An item in the body of a `switch`.
#[derive(Clone, Debug)]
pub enum SwitchItem {
    /// `case a:`
    Case(ExprId, Span),
    /// `default:`
    Default(Span),
    /// A statement.
    Stmt(Stmt),
}

/// The condition of a loop.
#[derive(Clone, Debug)]
pub enum Condition {
    /// An expression.
    Expr(ExprId),
    /// `bool b = f()`: declared again in each iteration.
    Declaration(Box<VariableDecl>),
}
