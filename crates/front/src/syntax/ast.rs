//! The syntax tree of one shader: what stands in the text, before any meaning.
//!
//! Expressions stand in one arena, children before their parents, so that a chain of ten thousand `+` is no
//! deeper for the allocator than one of two. A walk must still not recurse along left operands: use a loop.

#![expect(missing_docs, reason = "fields of variants are named for the grammar")]

use super::token::{Names, Symbol};
pub use crate::language::{Behavior, Extensions, IncDec, Profile, Version};
use crate::source::{Inclusion, Span};

/// An expression in an [`Ast`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ExprId(u32);

impl ExprId {
    /// The place in the arena.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A name with its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ident {
    /// The name.
    pub symbol: Symbol,
    /// Where.
    pub span: Span,
}

/// A whole shader.
#[derive(Clone, Debug)]
pub struct Ast {
    /// The language.
    pub version: Version,
    /// The global declarations in order.
    pub declarations: Vec<Declaration>,
    /// All expressions.
    pub exprs: Vec<Expr>,
    /// All names.
    pub names: Names,
    /// Where `#pragma STDGL invariant(all)` stands, if it does (§4.6.1).
    pub invariant_all: Option<Span>,
    /// Comments of the form `// glisten: allow(CODE, ...)`: the lines they stand for and the codes.
    pub allows: Vec<Allow>,
    /// The places of all `#extension` lines that turned something on, for messages.
    pub extension_lines: Vec<(String, Behavior, Span)>,
    /// What `#include` lines brought in, in the order in which they were read.
    pub inclusions: Vec<Inclusion>,
}

/// A comment `// glisten: allow(CODE)`: silences warnings of that code on its own line, or on the next line
/// of code if it stands alone.
#[derive(Clone, Debug)]
pub struct Allow {
    /// The comment.
    pub span: Span,
    /// Code identifiers or names.
    pub codes: Vec<String>,
}

impl Ast {
    /// Adds an expression.
    pub fn push(&mut self, kind: ExprKind, span: Span) -> ExprId {
        let id = ExprId(self.exprs.len() as u32);
        self.exprs.push(Expr { kind, span });
        id
    }

    /// The expression behind a handle that [`Self::push`] gave.
    pub fn expr(&self, id: ExprId) -> &Expr {
        // An `ExprId` is only ever made by `push` of this tree.
        &self.exprs[id.0 as usize]
    }

    /// The spelling of a name.
    pub fn name(&self, ident: Ident) -> &str {
        self.names.spelling(ident.symbol)
    }
}

/// An expression and the text it covers.
#[derive(Clone, Debug)]
pub struct Expr {
    /// Which.
    pub kind: ExprKind,
    /// Where.
    pub span: Span,
}

/// A literal (§4.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Literal {
    /// `true`, `false`
    Bool(bool),
    /// `1`, `0x1F`, `017`; the bits of a literal too large for `int` but not for 32 bits stand as they are.
    Int(i32),
    /// `1u`
    Uint(u32),
    /// `1.0`, `1e3f`: the decimal value rounded once to f32 (§4.1.4).
    Float(f32),
}

/// Operators with one operand.
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

/// Operators with two operands, assignment and sequence apart (§5.1).
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
    /// As it is written.
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

/// What an expression is.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// A place where the text made no sense; already reported.
    Error,
    /// A literal.
    Literal(Literal),
    /// A name.
    Name(Ident),
    /// One operand.
    Unary(UnaryOp, ExprId),
    /// `++`, `--`.
    IncDec(IncDec, ExprId),
    /// Two operands; the span of the operator itself.
    Binary(BinaryOp, Span, ExprId, ExprId),
    /// `a = b`, or `a op= b`; the span of the operator itself.
    Assign(Option<BinaryOp>, Span, ExprId, ExprId),
    /// `a ? b : c`
    Ternary(ExprId, ExprId, ExprId),
    /// `a, b`
    Comma(ExprId, ExprId),
    /// `a[b]`; `a[]` before a call's brackets (`float[](..)` of a struct type) has no index.
    Index(ExprId, Option<ExprId>),
    /// `a.b`: member or swizzle.
    Field(ExprId, Ident),
    /// `f(a, b)`, `S(a)`: function or constructor of a struct.
    Call(Ident, Vec<ExprId>),
    /// `vec4(a)`, `float[2](a, b)`, `S[2](a, b)`: constructor of a type that shows as such.
    Construct(Box<TypeSpec>, Vec<ExprId>),
    /// `a.length()` and any other method, which is an error.
    Method(ExprId, Ident, Vec<ExprId>),
    /// `{a, b}` as an initializer (ARB_shading_language_420pack).
    List(Vec<ExprId>),
}

/// A type as it is written.
#[derive(Clone, Debug)]
pub struct TypeSpec {
    /// Without its arrays.
    pub base: TypeBase,
    /// `[n]` behind the type, outermost first; an empty `[]` has no size.
    pub array: Vec<ArrayDim>,
    /// Where.
    pub span: Span,
}

/// `[n]` or `[]`.
#[derive(Clone, Copy, Debug)]
pub struct ArrayDim {
    /// The size.
    pub size: Option<ExprId>,
    /// The brackets and what is between them.
    pub span: Span,
}

/// A type without its arrays.
#[derive(Clone, Debug)]
pub enum TypeBase {
    /// Already reported.
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
    /// The members, one row a declaration.
    pub members: Vec<MemberDecl>,
}

/// `vec3 a, b[2];` in a struct or a block.
#[derive(Clone, Debug)]
pub struct MemberDecl {
    /// Qualifiers, in the order in which they stand.
    pub qualifiers: Vec<Qualifier>,
    /// The type.
    pub ty: TypeSpec,
    /// The names.
    pub declarators: Vec<Declarator>,
    /// The whole line.
    pub span: Span,
}

/// A name in a declaration, with its own arrays and initializer.
#[derive(Clone, Debug)]
pub struct Declarator {
    /// The name.
    pub name: Ident,
    /// `[n]` behind the name, outermost first.
    pub array: Vec<ArrayDim>,
    /// Behind `=`.
    pub initializer: Option<ExprId>,
}

/// A qualifier and where it stands. Order matters in 1.50 (§4.7) and is checked by the analysis.
#[derive(Clone, Debug)]
pub struct Qualifier {
    /// Which.
    pub kind: QualifierKind,
    /// Where.
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
    /// The value: an expression, which must be an integer literal in 1.50.
    pub value: Option<ExprId>,
}

/// A global declaration.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// Which.
    pub kind: DeclarationKind,
    /// Where.
    pub span: Span,
    /// The extensions that are on here.
    pub extensions: Extensions,
}

/// What a global declaration is.
#[derive(Clone, Debug)]
pub enum DeclarationKind {
    /// Already reported.
    Error,
    /// Already reported; a declaration of these names.
    Broken(Vec<Ident>),
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

/// Variables of one type.
#[derive(Clone, Debug)]
pub struct VariableDecl {
    /// Qualifiers in order.
    pub qualifiers: Vec<Qualifier>,
    /// The type.
    pub ty: TypeSpec,
    /// The names; none in `struct S {..};`.
    pub declarators: Vec<Declarator>,
}

/// An interface block (§4.3.7).
#[derive(Clone, Debug)]
pub struct BlockDecl {
    /// Qualifiers in order.
    pub qualifiers: Vec<Qualifier>,
    /// The block's name.
    pub name: Ident,
    /// The members.
    pub members: Vec<MemberDecl>,
    /// The instance name and its arrays.
    pub instance: Option<(Ident, Vec<ArrayDim>)>,
}

/// The head of a function (§6.1).
#[derive(Clone, Debug)]
pub struct FunctionHeader {
    /// Qualifiers before the return type.
    pub qualifiers: Vec<Qualifier>,
    /// The return type.
    pub ty: TypeSpec,
    /// The name.
    pub name: Ident,
    /// The parameters; `(void)` has none.
    pub params: Vec<ParamDecl>,
    /// The head alone.
    pub span: Span,
}

/// A parameter.
#[derive(Clone, Debug)]
pub struct ParamDecl {
    /// Qualifiers in order.
    pub qualifiers: Vec<Qualifier>,
    /// The type.
    pub ty: TypeSpec,
    /// The name, if it has one.
    pub name: Option<Ident>,
    /// `[n]` behind the name.
    pub array: Vec<ArrayDim>,
    /// Where.
    pub span: Span,
}

/// A statement (§6.2 to §6.4).
#[derive(Clone, Debug)]
pub struct Stmt {
    /// Which.
    pub kind: StmtKind,
    /// Where.
    pub span: Span,
}

/// What a statement is.
#[derive(Clone, Debug)]
pub enum StmtKind {
    /// Already reported.
    Error,
    /// Already reported; a declaration of these names.
    Broken(Vec<Ident>),
    /// `;`
    Empty,
    /// `a;`
    Expr(ExprId),
    /// A local declaration.
    Variables(VariableDecl),
    /// `precision highp float;` inside a function.
    Precision { qualifier: Qualifier, ty: TypeSpec },
    /// `invariant a;` inside a function, which is an error that the analysis explains.
    Requalify { qualifiers: Vec<Qualifier>, names: Vec<Ident> },
    /// A prototype inside a function, which is an error that the analysis explains.
    Prototype(FunctionHeader),
    /// `{ .. }`
    Block(Vec<Stmt>),
    /// `if (a) .. else if (b) .. else ..`, flat: a chain of any length is one statement.
    If { arms: Vec<(ExprId, Stmt)>, otherwise: Option<Box<Stmt>> },
    /// `switch (a) { .. }`: labels and statements as they come.
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

/// A line in a `switch`.
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
    /// `bool b = f()`: declared anew in each round.
    Declaration(Box<VariableDecl>),
}
