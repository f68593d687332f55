//! The tree of a function body in emitted WGSL: the statements and expressions that naga writes, and those that people
//! write instead.

/// The statements of a block.
pub(super) type Block = Vec<Stmt>;

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Stmt {
    Let {
        name: String,
        value: Expr,
    },
    Var {
        name: String,
        ty: String,
        value: Option<Expr>,
    },
    /// `a = b`, or `a op= b`.
    Assign {
        target: Expr,
        op: Option<&'static str>,
        value: Expr,
    },
    /// `a++`, `a--`
    Step {
        target: Expr,
        op: &'static str,
    },
    Call(Expr),
    If {
        condition: Expr,
        accept: Block,
        reject: Block,
    },
    /// The labels of each case as they are written.
    Switch {
        selector: Expr,
        cases: Vec<(String, Block)>,
    },
    Loop {
        body: Block,
        continuing: Block,
        break_if: Option<Expr>,
    },
    For {
        init: Option<Box<Stmt>>,
        condition: Option<Expr>,
        step: Option<Box<Stmt>>,
        body: Block,
    },
    While {
        condition: Expr,
        body: Block,
    },
    Block(Block),
    /// `break`, `continue`, `discard`
    Word(&'static str),
    Return(Option<Expr>),
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Expr {
    /// A name, a literal, or a type with its parameters.
    Leaf(String),
    Call(String, Vec<Expr>),
    Index(Box<Expr>, Box<Expr>),
    Member(Box<Expr>, String),
    Unary(&'static str, Box<Expr>),
    Binary(&'static str, Box<Expr>, Box<Expr>),
}

impl Expr {
    /// Whether a name is in it.
    pub(super) fn mentions(&self, name: &str) -> bool {
        match self {
            Self::Leaf(leaf) => leaf == name,
            Self::Call(_, arguments) => arguments.iter().any(|argument| argument.mentions(name)),
            Self::Index(base, index) => base.mentions(name) || index.mentions(name),
            Self::Member(base, _) | Self::Unary(_, base) => base.mentions(name),
            Self::Binary(_, left, right) => left.mentions(name) || right.mentions(name),
        }
    }

    /// Whether it is a name, a member, or an element with a constant number: what can be evaluated twice for nothing.
    pub(super) fn is_plain_place(&self) -> bool {
        match self {
            Self::Leaf(_) => true,
            Self::Member(base, _) => base.is_plain_place(),
            Self::Unary("*", base) => matches!(**base, Self::Leaf(_)),
            Self::Index(base, index) => {
                let constant = matches!(&**index, Self::Leaf(text) if text.starts_with(|c: char| c.is_ascii_digit()));
                constant && base.is_plain_place()
            }
            _ => false,
        }
    }

    /// The number of its nodes.
    pub(super) fn len(&self) -> usize {
        1 + match self {
            Self::Leaf(_) => 0,
            Self::Call(_, arguments) => arguments.iter().map(Self::len).sum(),
            Self::Index(left, right) | Self::Binary(_, left, right) => left.len() + right.len(),
            Self::Member(base, _) | Self::Unary(_, base) => base.len(),
        }
    }
}

impl Stmt {
    /// The expressions directly in it, without those of blocks.
    pub(super) fn exprs(&self) -> Vec<&Expr> {
        match self {
            Self::Let { value, .. } | Self::Call(value) => vec![value],
            Self::Var { value, .. } | Self::Return(value) => value.iter().collect(),
            Self::Assign { target, value, .. } => vec![target, value],
            Self::Step { target, .. } => vec![target],
            Self::If { condition, .. } | Self::While { condition, .. } => vec![condition],
            Self::Switch { selector, .. } => vec![selector],
            Self::Loop { break_if, .. } => break_if.iter().collect(),
            Self::For { init, condition, step, .. } => {
                let parts = [init, step].into_iter().flatten().flat_map(|part| part.exprs());
                parts.chain(condition).collect()
            }
            Self::Block(_) | Self::Word(_) => Vec::new(),
        }
    }

    /// The blocks directly in it.
    pub(super) fn blocks(&self) -> Vec<&Block> {
        match self {
            Self::If { accept, reject, .. } => vec![accept, reject],
            Self::Switch { cases, .. } => cases.iter().map(|(_, body)| body).collect(),
            Self::Loop { body, continuing, .. } => vec![body, continuing],
            Self::For { body, .. } | Self::While { body, .. } | Self::Block(body) => vec![body],
            _ => Vec::new(),
        }
    }

    /// The blocks directly in it, to be changed.
    pub(super) fn blocks_mut(&mut self) -> Vec<&mut Block> {
        match self {
            Self::If { accept, reject, .. } => vec![accept, reject],
            Self::Switch { cases, .. } => cases.iter_mut().map(|(_, body)| body).collect(),
            Self::Loop { body, continuing, .. } => vec![body, continuing],
            Self::For { body, .. } | Self::While { body, .. } | Self::Block(body) => vec![body],
            _ => Vec::new(),
        }
    }

    /// Whether a name is anywhere in it.
    pub(super) fn mentions(&self, name: &str) -> bool {
        self.exprs().iter().any(|expr| expr.mentions(name))
            || self.blocks().iter().any(|block| block.iter().any(|stmt| stmt.mentions(name)))
    }

    /// The number of its nodes.
    pub(super) fn len(&self) -> usize {
        let exprs: usize = self.exprs().iter().map(|expr| expr.len()).sum();
        let blocks: usize = self.blocks().iter().map(|block| block.iter().map(Self::len).sum::<usize>()).sum();
        1 + exprs + blocks
    }
}
