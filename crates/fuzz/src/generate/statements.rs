//! Statements: declarations, assignments, branches, loops, jumps.
//!
//! *In:* how deep they may nest. *Out:* statements. *Holds:* every loop ends after a few iterations; every variable has a value from its
//! declaration on; ES 1.00 gets the loops that its appendix A allows.

use super::sink::SUM;
use super::tree::{Expr, Role, Stmt, Use, Variable};
use super::types::{BOOL, FLOAT, INT, Ty, UINT};
use super::writer::Writer;
use glisten_front::hir::{Scalar, Stage};
use glisten_front::language::Feature;

impl Writer<'_> {
    /// Statements in a scope of their own.
    pub(super) fn body(&mut self, depth: usize) -> Vec<Stmt> {
        self.scopes.push(Vec::new());
        let mut statements = self.statements(depth);
        self.sink(&mut statements);
        self.scopes.pop();
        statements
    }

    /// Some statements, in the scope that is open.
    pub(super) fn statements(&mut self, depth: usize) -> Vec<Stmt> {
        let count = 1 + self.chance.below(4);
        let mut statements = Vec::new();
        for _ in 0..count {
            if self.statements_left == 0 {
                break;
            }
            self.statements_left -= 1;
            if self.chance.once_in(12) {
                self.note("comment");
                let text =
                    self.chance.word(&["// a line; with { signs }", "/* one */", "/* two\n   lines */", "; // empty"]);
                statements.push(Stmt::text_only(text));
            }
            statements.push(self.statement(depth));
        }
        statements
    }

    /// A statement.
    pub(super) fn statement(&mut self, depth: usize) -> Stmt {
        self.expressions_left = self.expressions_left.max(4 + self.chance.below(10));
        let inner = depth.saturating_sub(1);
        match self.chance.below(if depth == 0 { 10 } else { 20 }) {
            0..=2 => self.declaration(),
            3..=6 => self.assignment(),
            7 => {
                let call = if self.chance.once_in(2) { self.void_call(2) } else { self.void_builtin(2) };
                call.unwrap_or_else(|| self.assignment())
            }
            8 => self.jump(),
            9 => self.increment(),
            10..=12 => self.branch(inner),
            13 | 14 => self.for_loop(inner),
            15 => self.while_loop(inner),
            16 | 17 => self.switch(inner),
            18 => self.directives(inner),
            _ => {
                self.note("block");
                let body = self.apart(|this| this.body(inner));
                Stmt::new("{$}", Vec::new(), vec![body])
            }
        }
    }

    /// A name for a local, which may hide another.
    fn local_name(&mut self) -> String {
        let own: Vec<String> = self.scopes.last().into_iter().flatten().map(|one| one.name.clone()).collect();
        let is_free = |name: &String| !own.contains(name) && !name.contains('.') && !name.starts_with("gl_");
        let outer: Vec<String> = self.visible().into_iter().map(|one| one.name).filter(is_free).collect();
        if self.hides
            && self.scopes.len() > 2
            && self.chance.once_in(8)
            && let Some(name) = self.chance.one(&outer).filter(|name| name.starts_with('v'))
        {
            self.note("hidden name");
            return name.clone();
        }
        self.name("v")
    }

    fn declaration(&mut self) -> Stmt {
        let ty = self.value_type();
        let is_constant = self.chance.once_in(6);
        let before = std::mem::replace(&mut self.is_constant, is_constant);
        let value = if self.language.has(Feature::ImplicitToFloat) && ty == FLOAT && self.chance.once_in(6) {
            self.note("converted initializer");
            self.expr(&INT, 2)
        } else {
            self.expr(&ty, 3)
        };
        self.is_constant = before;
        let name = self.local_name();
        self.note(if is_constant { "const local" } else { "local" });
        let precision = if self.language.version.is_es() && ty.scalar().is_some_and(|one| one != Scalar::Bool) {
            self.chance.word(&["", "", "mediump ", "highp ", "lowp "])
        } else {
            ""
        };
        let head = if is_constant { "const " } else { "" };
        let declared = ty.declared(&name);
        let variable = Variable { constant: is_constant, ..self.variable(&name, &ty, !is_constant) };
        self.declare(variable);
        Stmt::new(&format!("{head}{precision}{declared} = @;"), vec![value], Vec::new()).with(Role::Declaration)
    }

    fn assignment(&mut self) -> Stmt {
        let ty = if self.chance.once_in(4) { self.value_type() } else { self.basic_type() };
        let Some(place) = self.part(&ty, true) else { return self.declaration() };
        let locals = self.visible().into_iter().filter(|one| one.local).collect();
        let place = place.used(Use::Fixed);
        let is_number = ty.scalar().is_some_and(|scalar| scalar != Scalar::Bool);
        if is_number && self.chance.once_in(3) {
            self.note("compound assignment");
            let has_bits = self.language.has(Feature::IntegerOperators);
            let is_whole = has_bits && matches!(ty, Ty::Vector(Scalar::Int | Scalar::Uint, _));
            let operators: &[&'static str] = if is_whole { &["+", "-", "*", "&", "|", "^"] } else { &["+", "-"] };
            let operator = self.chance.word(operators);
            let scalar = Ty::Vector(ty.scalar().unwrap_or(Scalar::Float), 1);
            let value = if self.chance.once_in(3) { self.expr(&scalar, 2) } else { self.expr(&ty, 3) };
            return Stmt::new(&format!("@ {operator}= @;"), vec![place, value], Vec::new());
        }
        self.note("assignment");
        if self.chance.once_in(6)
            && let Some(value) = self.call_on(&place)
        {
            self.note("assignment of a call on itself");
            return Stmt::new("@ = @;", vec![place, value], Vec::new()).with(Role::Assignment(locals));
        }
        if is_number && self.chance.once_in(4) {
            self.note("assignment of an operation on itself");
            let other = self.expr(&ty, 2);
            let pattern = self.chance.word(&["(@ - @)", "(@ + @)"]);
            let operands = if self.chance.once_in(2) { vec![place.clone(), other] } else { vec![other, place.clone()] };
            let value = Expr::new(ty, pattern, operands);
            return Stmt::new("@ = @;", vec![place, value], Vec::new()).with(Role::Assignment(locals));
        }
        let value = self.expr(&ty, 3);
        Stmt::new("@ = @;", vec![place, value], Vec::new()).with(Role::Assignment(locals))
    }

    fn increment(&mut self) -> Stmt {
        let ty = match self.chance.below(4) {
            0 => FLOAT,
            1 => self.basic_type(),
            _ => INT,
        };
        let ty = if ty.scalar() == Some(Scalar::Bool) { INT } else { ty };
        let Some(place) = self.part(&ty, true) else { return self.assignment() };
        self.note("increment");
        Stmt::new(self.chance.word(&["@++;", "++@;", "@--;", "--@;"]), vec![place.used(Use::Fixed)], Vec::new())
    }

    fn jump(&mut self) -> Stmt {
        let condition = self.expr(&BOOL, 2);
        let word = match self.chance.below(4) {
            0 if self.in_loop || self.in_switch => "break",
            1 if self.in_loop => "continue",
            2 if self.stage == Stage::Fragment && self.chance.once_in(3) => "discard",
            _ if self.may_return => "return",
            _ => return self.assignment(),
        };
        self.note(word);
        self.is_uniform &= matches!(word, "break" | "continue");
        if word == "return"
            && let Some(ty) = self.result.clone()
        {
            self.expressions_left = self.expressions_left.max(3);
            let value = self.returned(&ty);
            return Stmt::new("if (@) return @;", vec![condition, value], Vec::new());
        }
        if word == "return" && !self.early.is_empty() {
            return Stmt::new(&format!("if (@) {{ {}return; }}", self.early), vec![condition], Vec::new());
        }
        Stmt::new(&format!("if (@) {word};"), vec![condition], Vec::new())
    }

    fn branch(&mut self, depth: usize) -> Stmt {
        self.note("if");
        let mut pattern = String::from("if (@) {$}");
        let mut conditions = vec![self.expr(&BOOL, 2)];
        let mut bodies = vec![self.apart(|this| this.body(depth))];
        while self.chance.once_in(3) {
            self.note("else if");
            pattern.push_str(" else if (@) {$}");
            conditions.push(self.apart(|this| this.expr(&BOOL, 2)));
            bodies.push(self.apart(|this| this.body(depth)));
        }
        if self.chance.once_in(2) {
            self.note("else");
            pattern.push_str(" else {$}");
            bodies.push(self.apart(|this| this.body(depth)));
        }
        // `return` in a branch leaves the others alone.
        self.is_uniform &= !bodies.iter().flatten().any(leaves);
        Stmt::new(&pattern, conditions, bodies)
    }

    /// The body of a loop.
    fn iterated(&mut self, depth: usize) -> Vec<Stmt> {
        let before = std::mem::replace(&mut self.in_loop, true);
        let body = self.apart(|this| this.body(depth));
        self.in_loop = before;
        self.is_uniform &= !body.iter().any(leaves);
        body
    }

    fn for_loop(&mut self, depth: usize) -> Stmt {
        self.note("for");
        let name = self.name("i");
        let count = 1 + self.chance.below(4) as u32;
        let counter = Variable { below: Some(count), ..self.variable(&name, &INT, false) };
        self.scopes.push(vec![counter]);
        let body = self.iterated(depth);
        self.scopes.pop();
        let bound = if self.language.since(130, 300) && self.chance.once_in(3) {
            self.note("loop with a bound that is not constant");
            format!("min(ui, {count})")
        } else {
            count.to_string()
        };
        let step = self.chance.word(&["@++", "++@", "@ += 1"]).replace('@', &name);
        let pattern = format!("for (int {name} = 0; {name} < {bound}; {step}) {{$}}");
        Stmt::new(&pattern, Vec::new(), vec![body])
    }

    /// `while` and `do`, with a counter that ends them.
    fn while_loop(&mut self, depth: usize) -> Stmt {
        if self.language.version.is_es() && !self.language.since(110, 300) {
            return self.for_loop(depth);
        }
        let name = self.name("w");
        let counter = self.variable(&name, &INT, false);
        let count = 1 + self.chance.below(3);
        self.scopes.push(vec![counter]);
        let condition = self.apart(|this| this.expr(&BOOL, 2));
        let body = self.iterated(depth);
        self.scopes.pop();
        // The counter is in a scope of its own.
        let pattern = if self.chance.once_in(2) {
            self.note("while");
            format!("{{\nint {name} = 0;\nwhile ({name}++ < {count} && @) {{$}}\n}}")
        } else {
            self.note("do");
            format!("{{\nint {name} = 0;\ndo {{$}} while ({name}++ < {count} && @);\n}}")
        };
        Stmt::new(&pattern, vec![condition], vec![body])
    }

    fn switch(&mut self, depth: usize) -> Stmt {
        if !self.language.has_word("switch") {
            return self.branch(depth);
        }
        self.note("switch");
        let is_unsigned = self.chance.once_in(4);
        let (ty, suffix) = if is_unsigned { (UINT, "u") } else { (INT, "") };
        let selector = self.expr(&ty, 2);
        let (before, loops) = (std::mem::replace(&mut self.in_switch, true), self.in_loop);
        let mut pattern = format!("switch (@ & 3{suffix}) {{\n");
        let mut bodies = Vec::new();
        let count = 1 + self.chance.below(4);
        let default = self.chance.below(count + 2);
        for label in 0..count {
            let word = if label == default { "default:".to_owned() } else { format!("case {label}{suffix}:") };
            if label == default {
                self.note("default");
            }
            // The last label has a statement behind it; each other may have none.
            // Without braces, all labels share a scope.
            let has_braces = self.chance.once_in(2);
            let before = std::mem::replace(&mut self.hides, has_braces);
            let mut body = self.apart(|this| this.body(depth));
            self.hides = before;
            if label + 1 < count && self.chance.once_in(3) {
                self.note("fall through");
            } else {
                body.push(Stmt::text_only("break;"));
            }
            pattern.push_str(&if has_braces { format!("{word} {{$}}\n") } else { format!("{word}$") });
            bodies.push(body);
        }
        pattern.push('}');
        (self.in_switch, self.in_loop) = (before, loops);
        self.is_uniform &= !bodies.iter().flatten().any(leaves);
        Stmt::new(&pattern, vec![selector], bodies)
    }

    /// Statements under `#if`.
    fn directives(&mut self, depth: usize) -> Stmt {
        self.note("#if");
        const CONDITIONS: &[(&str, bool)] = &[
            ("#if __VERSION__ >= 100", true),
            ("#ifdef UNKNOWN", false),
            ("#ifndef UNKNOWN", true),
            ("#if defined(UNKNOWN) || defined UNKNOWN", false),
            ("#if defined(GL_ES) || __VERSION__ >= 110 && !defined(UNKNOWN)", true),
            ("#if (1 << 3) % 5 == 3 && -1 < 0", true),
            ("#if 2 + 3 * 4 != 14 || (7 & 3) == 0", false),
            ("#if 0x10 == 16 && 010 == 8 && 10 / 3 - 1 == 2", true),
            ("#if ~0 == 0 || !1 || (5 ^ 1) != 4", false),
            ("#if 0\nnever\n#elif 3 > 2", true),
            ("#if 1 - 2 - 3 == 2", false),
        ];
        let (condition, is_taken) = self.chance.one(CONDITIONS).copied().unwrap_or(("#if 1", true));
        let (yes, no) = self.apart(|this| (this.body(depth), this.body(depth)));
        let pattern = format!("{{\n{condition}$#else$#endif\n}}");
        Stmt::new(&pattern, Vec::new(), vec![yes, no]).with(Role::Conditional(is_taken))
    }

    /// A result of a function, with its sum if it has one of its own.
    pub(super) fn returned(&mut self, ty: &Ty) -> Expr {
        self.expressions_left = self.expressions_left.max(6);
        let value = self.expr(ty, 3);
        if !self.is_alone {
            return value;
        }
        let name = ty.name();
        let all = |size: u8| "xyzw".get(..usize::from(size)).unwrap_or("x");
        let pattern = match ty {
            Ty::Vector(Scalar::Float, size) => format!("(@ + {SUM}.{})", all(*size)),
            Ty::Vector(Scalar::Int, size) => format!("(@ + {name}({SUM}.{}))", all(*size)),
            Ty::Vector(Scalar::Uint, size) => format!("(@ + {name}(abs({SUM}.{})))", all(*size)),
            Ty::Vector(Scalar::Bool, 1) => format!("(@ != ({SUM}.x > 1.0))"),
            Ty::Matrix(..) => format!("(@ + {SUM}.x)"),
            _ => return value,
        };
        Expr::new(ty.clone(), &pattern, vec![value])
    }
}

/// Whether a statement may leave the function, or the loop around it.
fn leaves(statement: &Stmt) -> bool {
    let text = statement.text();
    ["return", "discard", "break", "continue"].iter().any(|word| text.contains(word))
}
