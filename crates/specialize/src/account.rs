//! [`LeftOut`]: what went, where it was, and what decided it.
//!
//! *In:* the original, the residual, and what the forward walk decided. *Out:* a list in the order of the original.
//! *Holds:* a statement is left out if no copy of it is anywhere in the residual; what is in something that was left out
//! is not listed again.

use crate::forward::{Reason, Reasons};
use crate::known::Known;
use crate::left::Left;
use crate::named_parts::named_parts;
use glisten_front::Program;
use glisten_front::hir::{ExprId, ExprKind, Global, LogicalOp, ScalarValue, Shader, Stage, Stmt, StmtKind, Storage};
use glisten_front::link::{Interface, UniformLeaf};
use glisten_front::source::{SourceMap, Span};
use rustc_hash::FxHashSet;
use std::collections::BTreeSet;

/// The most values that a reason names.
const MOST_VALUES: usize = 4;
/// The most decisions in a function that are named.
const MOST_DECISIONS: usize = 2;
/// The most scalars of a value that is written out.
const MOST_SCALARS: usize = 4;

/// The kind of a thing that was left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Kind {
    Branch,
    Loop,
    Function,
    Statement,
    Varying,
    Attribute,
    Uniform,
    Block,
    Texture,
    Output,
}

impl Kind {
    /// `branch`, `loop` and so on.
    pub fn name(self) -> &'static str {
        match self {
            Self::Branch => "branch",
            Self::Loop => "loop",
            Self::Function => "function",
            Self::Statement => "statement",
            Self::Varying => "varying",
            Self::Attribute => "attribute",
            Self::Uniform => "uniform",
            Self::Block => "block",
            Self::Texture => "texture",
            Self::Output => "output",
        }
    }
}

/// Something that was left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Its kind.
    pub what: Kind,
    /// Its name; of a branch its condition, of a loop or a statement its first line.
    pub name: String,
    /// The file that it was in.
    pub file: String,
    /// The line, from 1.
    pub line: u32,
    /// The reason.
    pub because: String,
    /// Its place in the original's texts.
    pub span: Span,
    /// All that went with it: of a branch its body, of a function all of it.
    pub extent: Span,
}

/// A computation that moved from the fragment stage to the vertex stage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Moved {
    /// The varying that carries its result.
    pub name: String,
    /// Its text in the original.
    pub expression: String,
    /// The file that it was in.
    pub file: String,
    /// The line, from 1.
    pub line: u32,
    /// Where it was, in the original's texts.
    pub span: Span,
}

/// How a program became what is left of it.
pub(crate) struct How<'a> {
    /// What was known; nothing where nothing was evaluated.
    pub(crate) known: &'a Known,
    /// What the forward walk decided, by stage.
    pub(crate) reasons: &'a [(Stage, Reasons)],
    /// What moved to the vertex stage.
    pub(crate) moved: &'a [Moved],
}

/// Lists what was left out of a program.
pub(crate) fn left_out(program: &Program, sources: Option<&SourceMap>, how: &How<'_>, left: &Left<'_>) -> Vec<LeftOut> {
    let mut account = Account { program, how, sources, list: Vec::new() };
    for shader in &program.stages {
        if let Some(left) = left.shaders.iter().find(|left| left.stage == shader.stage) {
            account.functions(shader, left);
        }
    }
    account.interface(left);
    account.list
}

struct Account<'a> {
    program: &'a Program,
    how: &'a How<'a>,
    sources: Option<&'a SourceMap>,
    list: Vec<LeftOut>,
}

impl Account<'_> {
    fn tell(&mut self, what: Kind, name: String, span: Span, because: String) {
        self.tell_all(what, name, span, because, span);
    }

    /// Lists something whose name is only a part of it.
    fn tell_all(&mut self, what: Kind, name: String, span: Span, because: String, extent: Span) {
        let place = self.sources.and_then(|sources| {
            let place = sources.location(span)?;
            Some((sources.file(place.file).name().to_owned(), place.line))
        });
        let (file, line) = place.unwrap_or_default();
        self.list.push(LeftOut { what, name, file, line, because, span, extent });
    }

    /// What the forward walk decided at a place.
    fn decided(&self, stage: Stage, span: Span) -> Option<Reason> {
        self.how.reasons.iter().find(|(of, _)| *of == stage)?.1.get(span)
    }

    /// The reason why nothing gets to a statement.
    fn never(&self, shader: &Shader, stmt: &Stmt) -> Option<String> {
        let reasons = &self.how.reasons.iter().find(|(of, _)| *of == shader.stage)?.1;
        let condition = reasons.never_reached(stmt.span)?;
        let text = condition.map(|condition| self.text(condition));
        Some(match text.filter(|text| !text.is_empty()) {
            Some(condition) => format!("nothing gets to it: `{condition}` is true"),
            None => "nothing gets to it".to_owned(),
        })
    }

    /// Whether a value may have been known.
    fn evaluates(&self) -> bool {
        !self.how.reasons.is_empty()
    }

    /// From a place to the end of a body.
    fn extent(&self, span: Span, body: &[Stmt]) -> Span {
        match (self.sources, body.last()) {
            (Some(sources), Some(last)) => sources.join(span, last.span),
            _ => span,
        }
    }

    /// The line of the text that a statement begins on, unless there are others on it.
    fn line(&self, span: Span) -> String {
        let line = self.whole_line(span);
        let code = line.split("//").next().unwrap_or("");
        if code.starts_with("for") || code.matches(';').count() <= 1 {
            return line;
        }
        let rest = self.sources.and_then(|sources| {
            let place = sources.location(span)?;
            let file = sources.file(place.file);
            file.text().get((span.start.checked_sub(file.base())?) as usize..)
        });
        let own = rest.unwrap_or("").split([';', '\n']).next().unwrap_or("").trim();
        if own.is_empty() { self.text(span) } else { format!("{own};") }
    }

    /// The line of the text that something is on.
    fn whole_line(&self, span: Span) -> String {
        let line = self.sources.and_then(|sources| {
            let place = sources.location(span)?;
            sources.file(place.file).line(place.line).map(str::trim).map(str::to_owned)
        });
        line.unwrap_or_else(|| self.text(span))
    }

    /// Whether two places begin on one line.
    fn share_a_line(&self, a: Span, b: Span) -> bool {
        let line = |span: Span| self.sources?.location(span).map(|place| (place.file, place.line));
        line(a).is_some_and(|of_a| line(b) == Some(of_a))
    }

    /// The first line of the text of a span.
    fn text(&self, span: Span) -> String {
        let text = self.sources.map_or("", |sources| sources.snippet(span));
        let line = text.lines().next().unwrap_or("").trim();
        if line.chars().count() > 80 { line.chars().take(77).chain("...".chars()).collect() } else { line.to_owned() }
    }

    fn functions(&mut self, shader: &Shader, left: &Shader) {
        let names: FxHashSet<Span> = left.functions.iter().map(|function| function.span).collect();
        let mut exprs: FxHashSet<Span> = FxHashSet::default();
        let mut kept: FxHashSet<Span> = FxHashSet::default();
        for function in &left.functions {
            left.visit_statements(function.body.as_deref().unwrap_or(&[]), &mut |stmt| {
                // The iterations of a loop that was written out are where it was.
                if !matches!(stmt.kind, StmtKind::Block(_)) {
                    kept.insert(stmt.span);
                }
            });
            let body = function.body.as_deref().unwrap_or(&[]);
            left.visit_body(body, &mut |expr| _ = exprs.insert(left.expr(expr).span));
        }
        for function in shader.functions.iter().filter(|function| function.body.is_some()) {
            if names.contains(&function.span) {
                let body = function.body.as_deref().unwrap_or(&[]);
                self.statements(shader, body, &kept);
            } else {
                let body = function.body.as_deref().unwrap_or(&[]);
                let mut is_inside = false;
                shader.visit_body(body, &mut |expr| is_inside |= exprs.contains(&shader.expr(expr).span));
                let because = match () {
                    () if !function.reachable => "`main` never calls it".to_owned(),
                    () if is_inside => format!("it is written out where it is called{}", self.decisions(shader, body)),
                    () => format!("no call of it is left{}", self.decisions(shader, body)),
                };
                let extent = self.extent(function.span, body);
                self.tell_all(Kind::Function, function.name.clone(), function.span, because, extent);
            }
        }
    }

    /// The first conditions in a function that are decided, as a part of the reason why it is gone.
    fn decisions(&self, shader: &Shader, body: &[Stmt]) -> String {
        let mut conditions: Vec<ExprId> = Vec::new();
        shader.visit_statements(body, &mut |stmt| match &stmt.kind {
            StmtKind::If { arms, .. } => conditions.extend(arms.iter().map(|(condition, _)| *condition)),
            StmtKind::Switch { selector, .. } => conditions.push(*selector),
            _ => {}
        });
        let is_decided = |condition: &ExprId| {
            let decided = self.decided(shader.stage, shader.expr(*condition).span);
            matches!(decided, Some(Reason::Condition(_) | Reason::Both | Reason::Selector))
        };
        conditions.retain(is_decided);
        let told: Vec<String> =
            conditions.iter().take(MOST_DECISIONS).map(|condition| self.because(shader, *condition)).collect();
        told.iter().map(|because| format!("; {because}")).collect()
    }

    fn statements(&mut self, shader: &Shader, body: &[Stmt], kept: &FxHashSet<Span>) {
        for (index, stmt) in body.iter().enumerate() {
            // The beginning of a `for` goes with it.
            let is_of_loop = body.get(index + 1).is_some_and(|next| {
                let is_gone = matches!(next.kind, StmtKind::Loop { .. }) && !kept.contains(&next.span);
                is_gone && next.span.start <= stmt.span.start && stmt.span.end <= next.span.end
            });
            if !is_of_loop {
                self.statement(shader, stmt, kept);
            }
        }
    }

    fn statement(&mut self, shader: &Shader, stmt: &Stmt, kept: &FxHashSet<Span>) {
        let inside = |bodies: &[Stmt]| {
            let mut any = false;
            shader.visit_statements(bodies, &mut |stmt| any |= kept.contains(&stmt.span));
            any
        };
        let never = self.never(shader, stmt).filter(|_| !kept.contains(&stmt.span));
        let is_loop = |stmt: &Stmt| matches!(stmt.kind, StmtKind::Loop { .. });
        match &stmt.kind {
            // All of it is passed over; what it is made of is not told apart.
            StmtKind::If { .. } | StmtKind::Switch { .. } | StmtKind::Loop { .. } | StmtKind::Block(_)
                if never.is_some() =>
            {
                let is_loop = is_loop(stmt) || stmt.kind.bodies().concat().iter().any(is_loop);
                let what = if is_loop { Kind::Loop } else { Kind::Branch };
                self.tell(what, self.line(stmt.span), stmt.span, never.unwrap_or_default());
            }
            StmtKind::If { arms, otherwise } => {
                let conditions: Vec<ExprId> = arms.iter().map(|(condition, _)| *condition).collect();
                for (index, (condition, body)) in arms.iter().enumerate() {
                    if !inside(body) {
                        // Of what is taken, a jump to where control goes anyway is no loss.
                        let is_jump = |stmt: &Stmt| {
                            matches!(stmt.kind, StmtKind::Return(None) | StmtKind::Break | StmtKind::Continue)
                        };
                        if body.iter().all(is_jump) && self.holds(shader, *condition) == Some(true) {
                            continue;
                        }
                        let before = conditions.get(..index).unwrap_or_default();
                        self.branch(shader, *condition, body, self.not_taken(shader, before, *condition));
                        continue;
                    }
                    if kept.contains(&stmt.span) {
                        self.operands(shader, *condition);
                    } else {
                        self.always(shader, *condition, body);
                    }
                    self.statements(shader, body, kept);
                }
                if inside(otherwise) {
                    self.statements(shader, otherwise, kept);
                } else if let (Some((last, before)), Some(first)) = (conditions.split_last(), otherwise.first()) {
                    let name = format!("else of `{}`", self.text(shader.expr(*last).span));
                    let because = match self.holds(shader, *last) {
                        Some(true) => self.because(shader, *last),
                        _ => self.not_taken(shader, before, *last),
                    };
                    let extent = self.extent(first.span, otherwise);
                    self.tell_all(Kind::Branch, name, first.span, because, extent);
                }
            }
            StmtKind::Loop { body, .. } if !kept.contains(&stmt.span) || !inside(body) => {
                let because = match self.decided(shader.stage, stmt.span) {
                    Some(Reason::Unrolled(0)) => "it never runs".to_owned(),
                    Some(Reason::Unrolled(1)) => "it runs once".to_owned(),
                    Some(Reason::Unrolled(rounds)) if inside(body) => format!("it runs {rounds} times, written out"),
                    Some(Reason::UnrolledUpTo(rounds)) if inside(body) => {
                        format!("it runs at most {rounds} times, written out")
                    }
                    _ => "nobody reads what it computes".to_owned(),
                };
                let line = self.line(stmt.span);
                if inside(body) {
                    // The body is there in another form.
                    let head = Span { end: stmt.span.start.saturating_add(1).min(stmt.span.end), ..stmt.span };
                    self.tell_all(Kind::Loop, line, stmt.span, because, head);
                    self.statements(shader, body, kept);
                } else {
                    self.tell(Kind::Loop, line, stmt.span, because);
                }
            }
            StmtKind::Switch { selector, cases } => {
                let because = self.because(shader, *selector);
                for case in cases.iter().filter(|case| !case.body.is_empty()) {
                    if inside(&case.body) {
                        self.statements(shader, &case.body, kept);
                    } else if case.body.iter().any(|stmt| !matches!(stmt.kind, StmtKind::Break)) {
                        let span = case.body.first().map_or(stmt.span, |first| first.span);
                        let name = format!("case: {}", self.text(span));
                        let extent = self.extent(span, &case.body);
                        self.tell_all(Kind::Branch, name, span, because.clone(), extent);
                    }
                }
            }
            StmtKind::Block(body) => self.statements(shader, body, kept),
            StmtKind::Loop { body, .. } => {
                stmt.kind.exprs().into_iter().for_each(|expr| self.operands(shader, expr));
                self.statements(shader, body, kept);
            }
            StmtKind::Break | StmtKind::Continue | StmtKind::Return(None) | StmtKind::Local(_, None) => {}
            _ if kept.contains(&stmt.span) => {
                stmt.kind.exprs().into_iter().for_each(|expr| self.operands(shader, expr))
            }
            _ => {
                let moved = self
                    .how
                    .moved
                    .iter()
                    .find(|one| one.span.start >= stmt.span.start && one.span.end <= stmt.span.end);
                let because = match moved {
                    Some(moved) => format!("it moved to the vertex stage, as `{}`", moved.name),
                    None => never.unwrap_or_else(|| self.unread()),
                };
                self.tell(Kind::Statement, self.line(stmt.span), stmt.span, because);
            }
        }
    }

    /// A branch that is gone.
    fn branch(&mut self, shader: &Shader, condition: ExprId, body: &[Stmt], because: String) {
        let span = shader.expr(condition).span;
        let extent = self.extent(span, body);
        self.tell_all(Kind::Branch, self.text(span), span, because, extent);
    }

    /// A selection of which the body is left, since its condition always holds.
    fn always(&mut self, shader: &Shader, condition: ExprId, body: &[Stmt]) {
        let decided = self.decided(shader.stage, shader.expr(condition).span);
        if matches!(decided, Some(Reason::Condition(true) | Reason::Both)) {
            let span = shader.expr(condition).span;
            let with_body = body.first().is_some_and(|first| self.share_a_line(span, first.span));
            let name = if with_body { format!("if ({})", self.text(span)) } else { self.whole_line(span) };
            self.tell(Kind::Statement, name, span, self.because(shader, condition));
        }
    }

    /// Whether a condition is known to hold, or not to, in every call and round.
    fn holds(&self, shader: &Shader, condition: ExprId) -> Option<bool> {
        match self.decided(shader.stage, shader.expr(condition).span) {
            Some(Reason::Condition(truth)) => Some(truth),
            _ => None,
        }
    }

    /// The reason why a branch is gone that other conditions stand before: the first that decides it.
    fn not_taken(&self, shader: &Shader, before: &[ExprId], own: ExprId) -> String {
        let taken = before.iter().find(|condition| self.holds(shader, **condition) == Some(true));
        match taken {
            Some(taken) => self.because(shader, *taken),
            None if self.holds(shader, own) == Some(true) => self.unread(),
            None => self.because(shader, own),
        }
    }

    /// The reason why something is gone that is evaluated.
    fn unread(&self) -> String {
        let reason = if self.evaluates() {
            "nothing that is drawn depends on it, or its value is known"
        } else {
            "nothing reads what it computes"
        };
        reason.to_owned()
    }

    /// What is gone of expressions in a statement that is left: what decided conditions do not choose.
    fn operands(&mut self, shader: &Shader, root: ExprId) {
        let mut pending = vec![root];
        while let Some(id) = pending.pop() {
            let kind = &shader.expr(id).kind;
            let chosen = match kind {
                ExprKind::Ternary(condition, yes, no) => {
                    let truth = self.holds(shader, *condition);
                    if let Some(truth) = truth {
                        self.operand(shader, *condition, if truth { *no } else { *yes }, truth);
                    }
                    let span = shader.expr(*condition).span;
                    if self.decided(shader.stage, span) == Some(Reason::Both) {
                        // Each round has one of the operands, and none has the condition.
                        self.tell(
                            Kind::Statement,
                            format!("{} ? ..", self.text(span)),
                            span,
                            self.because(shader, *condition),
                        );
                    }
                    truth.map(|truth| if truth { *yes } else { *no })
                }
                // The left operand decides, and the right one is not evaluated, or it does not matter.
                ExprKind::Logical(op, left, right) => {
                    let truth = self.holds(shader, *left);
                    let decides = truth == Some(*op == LogicalOp::Or);
                    if let Some(truth) = truth {
                        self.operand(shader, *left, if decides { *right } else { *left }, truth);
                    }
                    truth.map(|_| if decides { *left } else { *right })
                }
                _ => None,
            };
            match chosen {
                Some(chosen) => pending.push(chosen),
                None => pending.extend(kind.children().into_iter().rev()),
            }
        }
    }

    /// An operand that is gone, since the condition of it is known.
    fn operand(&mut self, shader: &Shader, condition: ExprId, gone: ExprId, truth: bool) {
        let text = self.text(shader.expr(condition).span);
        let name = if truth && gone != condition { format!("else of `{text}`") } else { text };
        let because = self.because(shader, condition);
        self.tell(Kind::Branch, name, shader.expr(gone).span, because);
    }

    /// The reason why a condition is decided: the values of what it names.
    fn because(&self, shader: &Shader, condition: ExprId) -> String {
        let text = || self.text(shader.expr(condition).span);
        let decided = match self.decided(shader.stage, shader.expr(condition).span) {
            Some(Reason::Condition(truth)) => format!("`{}` is {truth}", text()),
            Some(Reason::Both) => format!("`{}` is known: true in some calls or rounds, false in others", text()),
            Some(Reason::Selector) => format!("`{}` is known", text()),
            _ => return "nobody reads what it computes".to_owned(),
        };
        let mut values = self.values(shader, condition);
        values.retain(|value| *value != decided);
        if values.is_empty() { decided } else { format!("{decided}: {}", values.join(", ")) }
    }

    /// The uniforms that an expression names, with their values: the first few.
    fn values(&self, shader: &Shader, root: ExprId) -> Vec<String> {
        let types = &self.program.types;
        let mut values: Vec<String> = Vec::new();
        for part in named_parts(types, shader, root) {
            let is_of = |leaf: &&UniformLeaf| {
                let root = self.program.interface.roots.get(leaf.root.0 as usize);
                root.is_some_and(|root| root.globals.contains(&(shader.stage, part.global)))
            };
            for leaf in self.program.interface.uniforms.iter().filter(is_of) {
                let Some(known) = self.how.known.uniforms.get(&leaf.name) else { continue };
                let len = types.flat_len(leaf.ty);
                for (element, known) in known.chunks(len.max(1) as usize).enumerate() {
                    let start = leaf.flat_offset + element as u32 * len;
                    if known.len() > MOST_SCALARS || !part.meets(&(start..start + len)) {
                        continue;
                    }
                    let index = leaf.array_size.map_or(String::new(), |_| format!("[{element}]"));
                    let value = format!("`{}{index}` is {}", leaf.name, written(known));
                    if !values.contains(&value) {
                        values.push(value);
                    }
                }
            }
        }
        if values.len() > MOST_VALUES {
            values.truncate(MOST_VALUES);
            values.push("and so on".to_owned());
        }
        values
    }

    /// Lists the parts of the stages' interfaces that are gone.
    fn interface(&mut self, left: &Left<'_>) {
        let program = self.program;
        let own = &program.interface;
        let place = |stage: Stage, id: glisten_front::hir::GlobalId| {
            let shader = program.stage(stage);
            shader.and_then(|shader| shader.globals.get(id.index())).map_or_else(Span::default, |global| global.span)
        };
        for attribute in own.attributes.iter().filter(|one| !left.attributes.contains(one.name.as_str())) {
            let because = match self.how.known.attributes.get(&attribute.name) {
                _ if !attribute.active => "the vertex stage never reads it",
                Some(inputs) if inputs.iter().all(|input| matches!(input, crate::known::Input::Value(_))) => {
                    "it is the same at all vertices"
                }
                _ => "nothing that is drawn depends on it",
            };
            self.tell(Kind::Attribute, attribute.name.clone(), place(Stage::Vertex, attribute.global), because.into());
        }
        let mut told: BTreeSet<String> = BTreeSet::new();
        for varying in own.varyings.iter().filter(|one| !left.varyings.contains(one.name.as_str())) {
            let end = varying.to.map(|to| (Stage::Fragment, to)).or(varying.from.map(|from| (Stage::Vertex, from)));
            let Some((stage, end)) = end else { continue };
            let because = if varying.active {
                "the fragment stage no longer reads it"
            } else {
                "the fragment stage never reads it"
            };
            if told.insert(varying.name.clone()) {
                self.tell(Kind::Varying, varying.name.clone(), place(stage, end.global), because.into());
            }
        }
        self.undeclared(own);
        for output in own.outputs.iter().filter(|one| !left.outputs.contains(one.name.as_str())) {
            let because = "no attachment takes it".to_owned();
            self.tell(Kind::Output, output.name.clone(), place(Stage::Fragment, output.global), because);
        }
        for block in own.blocks.iter().filter(|one| !left.blocks.contains(one.name.as_str())) {
            let root = own.roots.get(block.root.0 as usize).and_then(|root| root.globals.first());
            let span = root.map_or_else(Span::default, |(stage, id)| place(*stage, *id));
            self.tell(Kind::Block, block.name.clone(), span, "no stage reads it any more".into());
        }
        for leaf in own.uniforms.iter().filter(|one| !left.uniforms.contains(one.name.as_str())) {
            let root = own.roots.get(leaf.root.0 as usize).and_then(|root| root.globals.first());
            let span = root.map_or_else(Span::default, |(stage, id)| place(*stage, *id));
            let because = self.of_uniform(leaf);
            self.tell(Kind::Uniform, leaf.name.clone(), span, because);
        }
        for slot in own.samplers.iter().filter(|one| !left.samplers.contains(one.name.as_str())) {
            let span = slot.globals.first().map_or_else(Span::default, |(stage, id)| place(*stage, *id));
            let one_color = self.how.known.textures.get(&slot.name).is_some_and(|texture| {
                texture.channels.iter().all(|channel| matches!(channel, crate::known::Input::Value(_)))
            });
            let because = if one_color { "it has one color" } else { "no lookup of it is left" };
            self.tell(Kind::Texture, slot.name.clone(), span, because.into());
        }
    }

    /// Outputs of the vertex stage that the fragment stage does not declare: no varying stands for them.
    fn undeclared(&mut self, interface: &Interface) {
        let program = self.program;
        let (Some(vertex), Some(_)) = (program.stage(Stage::Vertex), program.stage(Stage::Fragment)) else { return };
        let linked = program.stage(Stage::Geometry).is_none();
        let plain = |global: &Global| global.storage == Storage::Out && global.builtin.is_none();
        for (id, global) in vertex.globals().filter(|(_, global)| linked && plain(global)) {
            if !interface.varyings.iter().any(|varying| varying.from.is_some_and(|from| from.global == id)) {
                let because = "the fragment stage does not declare it".to_owned();
                self.tell(Kind::Varying, global.name.clone(), global.span, because);
            }
        }
    }

    fn of_uniform(&self, leaf: &UniformLeaf) -> String {
        match self.how.known.uniforms.get(&leaf.name) {
            _ if !leaf.active => "no stage reads it".into(),
            Some(values) if values.len() <= 4 => format!("it is {}", written(values)),
            Some(_) => "its value is known".into(),
            None => "nothing that is drawn depends on it".into(),
        }
    }
}

/// A value in few words.
fn written(values: &[ScalarValue]) -> String {
    let each: Vec<String> = values
        .iter()
        .map(|value| match value {
            ScalarValue::Bool(value) => value.to_string(),
            ScalarValue::Int(value) => value.to_string(),
            ScalarValue::Uint(value) => value.to_string(),
            ScalarValue::Float(value) => format!("{value:?}"),
        })
        .collect();
    if each.len() == 1 { each.concat() } else { format!("({})", each.join(", ")) }
}
