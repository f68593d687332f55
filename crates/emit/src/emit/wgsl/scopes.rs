//! The names of locals, by the scopes of WGSL (§7.1).
//!
//! *Holds:* a local has the name of the source, unless a local around it or something that the function uses has the
//! name; then it gets a number.

use super::names::{is_word, plain};
use super::tree::{BlockId, Body, Expr, NameId, StmtKind};
use naga::keywords::wgsl::BUILTIN_IDENTIFIERS;
use rustc_hash::{FxHashMap, FxHashSet};

/// Chooses the names of a function's locals: afterwards, [`Body::names`] has those of the text.
pub(super) fn choose(body: &mut Body<'_>, parameters: &[NameId], types: &[String]) {
    let mut scopes = Scopes {
        used: FxHashSet::default(),
        open: FxHashMap::default(),
        free: FxHashMap::default(),
        names: Vec::new(),
    };
    for text in types {
        scopes.words_of(text);
    }
    for block in &body.blocks {
        block.statements.iter().for_each(|stmt| scopes.words_in(&stmt.kind));
    }
    let wanted = std::mem::take(&mut body.names);
    scopes.names = vec![String::new(); wanted.len()];
    for parameter in parameters {
        scopes.declare(*parameter, &wanted);
    }
    scopes.block(body, BlockId(0), &wanted);
    body.names = scopes.names;
}

struct Scopes {
    /// The names of the module and the language that the function uses.
    used: FxHashSet<String>,
    /// The locals that are visible: each with the name that it was to have, and its number.
    open: FxHashMap<String, (String, usize)>,
    /// For a name that locals were to have, the least number that may be free.
    free: FxHashMap<String, usize>,
    names: Vec<String>,
}

/// Whether a name is a word of WGSL that a local must not be: all but the names of functions.
fn is_forbidden(name: &str) -> bool {
    is_word(name) && !BUILTIN_IDENTIFIERS.iter().skip_while(|word| **word != "bitcast").any(|word| *word == name)
}

impl Scopes {
    fn words_of(&mut self, text: &str) {
        let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| !word.is_empty());
        for word in words {
            if !self.used.contains(word) {
                self.used.insert(word.to_owned());
            }
        }
    }

    fn words_in(&mut self, kind: &StmtKind<'_>) {
        if let StmtKind::Var { ty, .. } = kind {
            self.words_of(ty);
        }
        kind.for_each_expr(&mut |expr| self.words_of_expr(expr));
    }

    fn words_of_expr(&mut self, expr: &Expr<'_>) {
        match expr {
            Expr::Leaf(name) | Expr::Constant(name) => self.words_of(name),
            Expr::Call(name, arguments) => {
                self.words_of(name);
                arguments.iter().for_each(|argument| self.words_of_expr(argument));
            }
            Expr::Index(left, right) | Expr::Binary(_, left, right) => {
                self.words_of_expr(left);
                self.words_of_expr(right);
            }
            Expr::Member(base, _) | Expr::Unary(_, base) => self.words_of_expr(base),
            Expr::Number(_) | Expr::Local(_) => {}
        }
    }

    /// Chooses a name, which is visible from here on.
    fn declare(&mut self, id: NameId, wanted: &[String]) -> String {
        let base = plain(wanted.get(id.0).map_or("value", String::as_str));
        let mut number = self.free.get(&base).copied().unwrap_or(0);
        let name = loop {
            let name = if number == 0 { base.clone() } else { format!("{base}_{number}") };
            if !is_forbidden(&name) && !self.used.contains(&name) && !self.open.contains_key(&name) {
                break name;
            }
            number += 1;
        };
        self.free.insert(base.clone(), number + 1);
        self.open.insert(name.clone(), (base, number));
        if let Some(place) = self.names.get_mut(id.0) {
            place.clone_from(&name);
        }
        name
    }

    fn block(&mut self, body: &Body<'_>, id: BlockId, wanted: &[String]) {
        let declared = self.statements(body, id, wanted);
        self.close(declared);
    }

    /// The statements of a block, whose names stay visible.
    fn statements(&mut self, body: &Body<'_>, id: BlockId, wanted: &[String]) -> Vec<String> {
        let mut own = Vec::new();
        let Some(block) = body.blocks.get(id.0) else { return own };
        for stmt in &block.statements {
            match &stmt.kind {
                StmtKind::Let { name, .. } | StmtKind::Var { name, .. } => own.push(self.declare(*name, wanted)),
                StmtKind::For { init: Some(init), body: inner, .. } => {
                    let counter = match &**init {
                        StmtKind::Var { name, .. } => Some(self.declare(*name, wanted)),
                        _ => None,
                    };
                    self.block(body, *inner, wanted);
                    self.close(counter.into_iter().collect());
                }
                // A `continuing` block sees what the body declares.
                StmtKind::Loop { body: inner, continuing, .. } => {
                    let declared = self.statements(body, *inner, wanted);
                    self.block(body, *continuing, wanted);
                    self.close(declared);
                }
                kind => kind.for_each_block(&mut |inner| self.block(body, inner, wanted)),
            }
        }
        own
    }

    fn close(&mut self, names: Vec<String>) {
        for name in names {
            if let Some((base, number)) = self.open.remove(&name) {
                self.free.entry(base).and_modify(|free| *free = number.min(*free));
            }
        }
    }
}
