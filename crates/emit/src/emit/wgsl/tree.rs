//! The tree of a function body in WGSL: the statements and expressions that people write.
//!
//! *Holds:* blocks are in an arena, so that declarations can be put into any of them after all uses are known. The
//! names of locals are numbers until their scopes are known.

use naga::{Handle, LocalVariable};
use std::borrow::Cow;

/// A block in [`Body::blocks`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct BlockId(pub(super) usize);

/// A name in [`Body::names`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct NameId(pub(super) usize);

/// The body of a function.
#[derive(Debug)]
pub(super) struct Body<'m> {
    pub(super) blocks: Vec<Block<'m>>,
    /// The names of locals: first those that the source has, later those that the text has.
    pub(super) names: Vec<String>,
}

/// The statements of a block, and where it is.
#[derive(Debug, Default)]
pub(super) struct Block<'m> {
    pub(super) statements: Vec<Stmt<'m>>,
    /// The block around it, and the index of the statement there that has it.
    pub(super) parent: Option<(BlockId, usize)>,
    /// Whether it is repeated.
    pub(super) repeats: bool,
    /// How many of its first statements are in the head of a loop.
    pub(super) in_head: usize,
    /// The comments on the line that opens it.
    pub(super) head: Vec<String>,
    /// The comments behind its last statement, on lines of their own.
    pub(super) end: Vec<String>,
}

/// A statement, with its place in the source.
#[derive(Debug)]
pub(super) struct Stmt<'m> {
    pub(super) kind: StmtKind<'m>,
    pub(super) span: naga::Span,
    /// The declaration that the statement has taken over.
    pub(super) declared: naga::Span,
    /// The comments above it, and those behind it.
    pub(super) above: Vec<String>,
    pub(super) behind: Vec<String>,
}

impl<'m> Stmt<'m> {
    /// A statement without comments.
    pub(super) fn new(kind: StmtKind<'m>, span: naga::Span) -> Self {
        Self { kind, span, declared: naga::Span::UNDEFINED, above: Vec::new(), behind: Vec::new() }
    }
}

/// The kinds of statements.
#[derive(Debug)]
pub(super) enum StmtKind<'m> {
    /// Nothing: the statement has become part of another.
    Empty,
    Let {
        name: NameId,
        value: Expr<'m>,
    },
    Var {
        name: NameId,
        ty: String,
        value: Option<Expr<'m>>,
    },
    /// `a = b`, or `a op= b`; `whole` is the local variable of which all is stored.
    Assign {
        target: Expr<'m>,
        op: Option<&'static str>,
        value: Expr<'m>,
        whole: Option<Handle<LocalVariable>>,
    },
    /// `a++`, `a--`
    Step {
        target: Expr<'m>,
        op: &'static str,
    },
    Call(Expr<'m>),
    If {
        condition: Expr<'m>,
        accept: BlockId,
        reject: BlockId,
    },
    /// The labels of each case as they are written.
    Switch {
        selector: Expr<'m>,
        cases: Vec<(String, BlockId)>,
    },
    Loop {
        body: BlockId,
        continuing: BlockId,
        break_if: Option<Expr<'m>>,
    },
    /// `for` with a step, `while` without.
    For {
        init: Option<Box<StmtKind<'m>>>,
        condition: Option<Expr<'m>>,
        step: Option<Box<StmtKind<'m>>>,
        body: BlockId,
    },
    Block(BlockId),
    /// `break`, `continue`, `discard`
    Word(&'static str),
    Return(Option<Expr<'m>>),
}

/// A number: its digits, its suffix, and whether it needs the suffix.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Number {
    pub(super) digits: String,
    pub(super) suffix: &'static str,
    pub(super) suffixed: bool,
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Expr<'m> {
    Number(Number),
    /// A name of the module, or a word.
    Leaf(Cow<'m, str>),
    /// The name of a constant of the module.
    Constant(Cow<'m, str>),
    Local(NameId),
    Call(Cow<'m, str>, Vec<Expr<'m>>),
    Index(Box<Expr<'m>>, Box<Expr<'m>>),
    Member(Box<Expr<'m>>, Cow<'m, str>),
    Unary(&'static str, Box<Expr<'m>>),
    Binary(&'static str, Box<Expr<'m>>, Box<Expr<'m>>),
}

impl Expr<'_> {
    /// Whether it is a name, a member, or an element with a constant number: what can be evaluated twice for nothing.
    pub(super) fn is_plain_place(&self) -> bool {
        match self {
            Self::Leaf(_) | Self::Constant(_) | Self::Local(_) => true,
            Self::Member(base, _) => base.is_plain_place(),
            Self::Unary("*", base) => matches!(**base, Self::Leaf(_) | Self::Local(_)),
            Self::Index(base, index) => {
                base.is_plain_place()
                    && matches!(**index, Self::Number(_) | Self::Local(_) | Self::Leaf(_) | Self::Constant(_))
            }
            _ => false,
        }
    }

    /// Whether it is composed of numbers without suffixes, which WGSL evaluates with more precision.
    pub(super) fn is_abstract(&self) -> bool {
        match self {
            Self::Number(number) => !number.suffixed,
            Self::Unary("-", operand) | Self::Member(operand, _) | Self::Index(operand, _) => operand.is_abstract(),
            Self::Call(name, arguments) => {
                matches!(&**name, "vec2" | "vec3" | "vec4") && arguments.iter().all(Self::is_abstract)
            }
            _ => false,
        }
    }

    /// Whether a `let` may have it as its value. Composed of integer literals, a reader of WGSL may take it for a constant, and
    /// reject what overflows or divides by 0. Where it is the name of a constant vector, naga's SPIR-V writer composes a
    /// constant of too few constituents of it.
    pub(super) fn may_be_let(&self) -> bool {
        !self.is_integer_literal() && !matches!(self, Self::Constant(_))
    }

    /// Whether it is composed of integer literals.
    fn is_integer_literal(&self) -> bool {
        match self {
            Self::Number(number) => matches!(number.suffix, "i" | "u"),
            Self::Unary(_, operand) => operand.is_integer_literal(),
            Self::Call(name, arguments) => {
                (name.starts_with("vec") || &**name == "i32") && arguments.iter().all(Self::is_integer_literal)
            }
            Self::Leaf(leaf) => leaf.starts_with('-'),
            _ => false,
        }
    }

    /// Gives its numbers suffixes, if it has nothing else.
    pub(super) fn make_concrete(&mut self) {
        if !self.is_abstract() {
            return;
        }
        match self {
            Self::Number(number) => number.suffixed = true,
            Self::Unary(_, operand) | Self::Member(operand, _) | Self::Index(operand, _) => operand.make_concrete(),
            Self::Call(_, arguments) => arguments.iter_mut().for_each(Self::make_concrete),
            _ => {}
        }
    }
}

impl<'m> StmtKind<'m> {
    /// Calls `visit` with the expressions directly in it, without those of blocks.
    pub(super) fn for_each_expr(&self, visit: &mut dyn FnMut(&Expr<'m>)) {
        match self {
            Self::Let { value, .. } | Self::Call(value) => visit(value),
            Self::Var { value, .. } | Self::Return(value) => value.iter().for_each(visit),
            Self::Assign { target, value, .. } => {
                visit(target);
                visit(value);
            }
            Self::Step { target, .. } => visit(target),
            Self::If { condition, .. } => visit(condition),
            Self::Switch { selector, .. } => visit(selector),
            Self::Loop { break_if, .. } => break_if.iter().for_each(visit),
            Self::For { init, condition, step, .. } => {
                init.iter().for_each(|init| init.for_each_expr(visit));
                condition.iter().for_each(&mut *visit);
                step.iter().for_each(|step| step.for_each_expr(visit));
            }
            Self::Empty | Self::Block(_) | Self::Word(_) => {}
        }
    }

    /// Calls `visit` with the blocks directly in it.
    pub(super) fn for_each_block(&self, visit: &mut dyn FnMut(BlockId)) {
        match self {
            Self::If { accept, reject, .. } => {
                visit(*accept);
                visit(*reject);
            }
            Self::Switch { cases, .. } => cases.iter().for_each(|(_, body)| visit(*body)),
            Self::Loop { body, continuing, .. } => {
                visit(*body);
                visit(*continuing);
            }
            Self::For { body, .. } | Self::Block(body) => visit(*body),
            _ => {}
        }
    }
}
