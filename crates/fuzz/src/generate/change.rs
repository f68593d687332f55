//! Changes that leave a picture as it is.
//!
//! *In:* a program. *Out:* another, which must draw the same bits. *Holds:* only rules of the language are used: a condition that is false, a
//! loop that runs once, a name for a value, a function for a statement, a uniform for a number, and what `spelled` has.

use super::Program;
use super::components::{by_components, in_other_digits};
use super::spelled::{bare, bare_statement, expanded, respelled, respelled_statement, taken};
use super::tree::{Expr, Role, Stmt, StmtPart, Use, Variable};
use super::types::Ty;
use crate::chance::Chance;
use glisten_front::hir::Scalar;
use glisten_front::language::Feature;

/// A kind of change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// `if (never) ..` before statements.
    DeadCode,
    /// `for (int once = 0; once < 1; once++) ..` around statements.
    OneIteration,
    /// A variable for an assigned value.
    Named,
    /// A function for an assignment.
    Outlined,
    /// Parentheses around operands.
    Parentheses,
    /// Uniforms for literals.
    Uniforms,
    /// No parentheses where precedence makes them needless.
    Bare,
    /// Operators by others, components by other names, `a += b` as `a = a + b`.
    Spelled,
    /// Macros and conditions of the preprocessor written out.
    Expanded,
    /// A name for each overload.
    Renamed,
    /// Constructors, comparisons and matrices by their components.
    Components,
    /// Numbers in other digits.
    Digits,
}

impl Change {
    /// All kinds.
    pub const ALL: [Self; 12] = [
        Self::DeadCode,
        Self::OneIteration,
        Self::Named,
        Self::Outlined,
        Self::Parentheses,
        Self::Uniforms,
        Self::Bare,
        Self::Spelled,
        Self::Expanded,
        Self::Renamed,
        Self::Components,
        Self::Digits,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::DeadCode => "dead code",
            Self::OneIteration => "one iteration",
            Self::Named => "named value",
            Self::Outlined => "outlined statement",
            Self::Parentheses => "parentheses",
            Self::Uniforms => "uniforms for literals",
            Self::Bare => "bare operands",
            Self::Spelled => "other words",
            Self::Expanded => "expanded",
            Self::Renamed => "renamed overloads",
            Self::Components => "by components",
            Self::Digits => "other digits",
        }
    }
}

/// The program with a change at some of the places that it has.
pub fn changed(program: &Program, change: Change, seed: u64) -> Program {
    let mut changed = program.clone();
    let mut changer =
        Changer { change, chance: Chance::new(seed), names: 0, functions: Vec::new(), lines: Vec::new(), program };
    for stage in changed.stages_mut().into_iter().filter(|stage| !stage.is_empty()) {
        let mut index = 0;
        while index < stage.len() {
            if let Some(item) = stage.get_mut(index) {
                changer.statement(item, true);
            }
            let made = std::mem::take(&mut changer.functions);
            let count = made.len();
            stage.splice(index..index, made);
            index += count + 1;
        }
        let uniforms =
            changer.lines.iter().map(|(name, ty, _)| Stmt::text_only(format!("uniform {};", ty.declared(name))));
        // Behind `#version`, and what else comes first.
        let at =
            stage.iter().take_while(|one| one.role == Role::Directive || one.text().starts_with("precision")).count();
        stage.splice(at..at, uniforms.collect::<Vec<_>>());
    }
    // `[draw.uniforms]` is the last table, or there are textures behind it.
    let lines = changer.lines.iter().map(|(name, _, value)| format!("{name} = {value}"));
    let at = changed.scene.iter().position(|line| line == "[draw.uniforms]").map_or(changed.scene.len(), |at| at + 1);
    changed.scene.splice(at..at, lines.collect::<Vec<_>>());
    changed
}

struct Changer<'p> {
    change: Change,
    chance: Chance,
    names: usize,
    /// Functions that go before the one that is changed.
    functions: Vec<Stmt>,
    /// Uniforms: names, types and values.
    lines: Vec<(String, Ty, String)>,
    program: &'p Program,
}

impl Changer<'_> {
    fn statement(&mut self, statement: &mut Stmt, is_global: bool) {
        match self.change {
            Change::Renamed => statement.renamed(),
            // Nothing is folded then.
            Change::Uniforms if !is_global => statement.varied(),
            _ => {}
        }
        let is_constant = is_global || statement.text().trim_start().starts_with("const ");
        for part in &mut statement.parts {
            match part {
                StmtPart::Expr(expr) if !is_constant || self.change == Change::Digits => self.expr(expr),
                StmtPart::Expr(_) => {}
                StmtPart::Body(body) => self.body(body),
            }
        }
    }

    fn body(&mut self, body: &mut Vec<Stmt>) {
        let mut new = Vec::with_capacity(body.len());
        for mut statement in std::mem::take(body) {
            self.statement(&mut statement, false);
            match self.change {
                Change::Bare => bare_statement(&mut statement),
                Change::Spelled => statement = respelled_statement(statement),
                Change::Expanded => statement = taken(statement),
                _ => {}
            }
            if self.chance.once_in(3) {
                self.place(statement, &mut new);
            } else {
                new.push(statement);
            }
        }
        *body = new;
    }

    /// Adds a statement, changed.
    fn place(&mut self, statement: Stmt, new: &mut Vec<Stmt>) {
        let text = statement.text();
        match self.change {
            Change::DeadCode if statement.role != Role::Declaration && !is_label_end(&text) => {
                new.push(Stmt::new("if (never) {$}", Vec::new(), vec![vec![statement.clone()]]));
                new.push(statement);
            }
            Change::OneIteration if statement.role != Role::Declaration && !jumps(&text) => {
                let name = self.name("once");
                let pattern = format!("for (int {name} = 0; {name} < 1; {name}++) {{$}}");
                new.push(Stmt::new(&pattern, Vec::new(), vec![vec![statement]]));
            }
            Change::Named => self.named(statement, new),
            Change::Outlined => self.outlined(statement, new),
            _ => new.push(statement),
        }
    }

    fn name(&mut self, prefix: &str) -> String {
        self.names += 1;
        format!("{prefix}_{}", self.names)
    }

    /// `T named = value; place = named;`
    fn named(&mut self, mut statement: Stmt, new: &mut Vec<Stmt>) {
        let name = self.name("named");
        if let Role::Assignment(_) = statement.role
            && let [StmtPart::Expr(_), StmtPart::Expr(value)] = statement.parts.as_mut_slice()
            && (self.program.language.has(Feature::ArrayObjects) || !matches!(value.ty, Ty::Array(..)))
        {
            let ty = value.ty.clone();
            let whole = std::mem::replace(value, Expr::leaf(ty.clone(), name.clone()));
            new.push(
                Stmt::new(&format!("{} = @;", ty.declared(&name)), vec![whole], Vec::new()).with(Role::Declaration),
            );
        }
        new.push(statement);
    }

    /// A function that assigns, and its call.
    fn outlined(&mut self, statement: Stmt, new: &mut Vec<Stmt>) {
        let Role::Assignment(locals) = &statement.role else { return new.push(statement) };
        let text = statement.text();
        let used: Vec<&Variable> = locals.iter().filter(|one| has_word(&text, &one.name)).collect();
        let name = self.name("outlined");
        let head =
            |one: &&Variable| format!("{}{}", if one.writable { "inout " } else { "" }, one.ty.declared(&one.name));
        let heads: Vec<String> = used.iter().map(head).collect();
        let names: Vec<&str> = used.iter().map(|one| one.name.as_str()).collect();
        let call = Stmt::text_only(format!("{name}({});", names.join(", ")));
        let has_constant = used.iter().any(|one| one.constant);
        // Derivatives are of the caller's values, but lookups of constants may have to be constant.
        if has_constant || !self.functions.is_empty() {
            return new.push(statement);
        }
        self.functions.push(Stmt::new(
            &format!("void {name}({}) {{$}}", heads.join(", ")),
            Vec::new(),
            vec![vec![statement]],
        ));
        new.push(call);
    }

    fn expr(&mut self, expr: &mut Expr) {
        if expr.usage == Use::Fixed {
            return;
        }
        expr.operands.iter_mut().for_each(|operand| self.expr(operand));
        match self.change {
            Change::Parentheses if self.chance.once_in(4) => {
                let ty = expr.ty.clone();
                let inner = std::mem::replace(expr, Expr::leaf(ty.clone(), ""));
                *expr = Expr::new(ty, "(@)", vec![inner]);
            }
            Change::Bare => bare(expr),
            Change::Renamed => expr.renamed(),
            Change::Components => by_components(expr),
            Change::Digits => in_other_digits(expr),
            Change::Spelled => respelled(expr),
            Change::Expanded => expanded(expr, &self.program.macros),
            Change::Uniforms if expr.usage == Use::Literal && expr.ty != Ty::Vector(Scalar::Bool, 1) => {
                self.uniform(expr)
            }
            _ => {}
        }
    }

    /// A uniform for a literal.
    fn uniform(&mut self, expr: &mut Expr) {
        let text = expr.text();
        let text = text.trim_matches(['(', ')']);
        let value = match expr.ty {
            Ty::Vector(Scalar::Float, 1) => text.parse::<f32>().ok().map(|value| format!("{value:?}")),
            Ty::Vector(Scalar::Int, 1) => text
                .parse::<i32>()
                .ok()
                .filter(|_| !text.starts_with('0') || text == "0")
                .map(|value| value.to_string()),
            _ => None,
        };
        let Some(value) = value.filter(|_| self.lines.len() < 12 && self.chance.once_in(2)) else { return };
        let name = match self.lines.iter().find(|(_, ty, other)| *ty == expr.ty && *other == value) {
            Some((name, ..)) => name.clone(),
            None => {
                let name = self.name("known");
                self.lines.push((name.clone(), expr.ty.clone(), value));
                name
            }
        };
        *expr = Expr::leaf(expr.ty.clone(), name);
    }
}

/// Whether a statement is the `break` of a label, which dead code before it would double.
fn is_label_end(text: &str) -> bool {
    text.trim() == "break;"
}

/// Whether a jump in a statement may be of a loop around it.
fn jumps(text: &str) -> bool {
    text.contains("break") || text.contains("continue")
}

/// Whether a text has a word.
fn has_word(text: &str, word: &str) -> bool {
    let is_letter = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    text.match_indices(word).any(|(at, _)| {
        let before = text.get(..at).and_then(|before| before.chars().next_back());
        let after = text.get(at + word.len()..).and_then(|after| after.chars().next());
        !before.is_some_and(|letter| is_letter(letter) || letter == '.') && !after.is_some_and(is_letter)
    })
}
