//! The cost of a function: operations counted in its typed body.
//!
//! *In:* a function of a [`Shader`]. *Out:* its [`Cost`] on the most expensive path.
//!
//! *Holds:* an operation on a vector counts once per component. Operations on literals only, and calls of functions
//! without parameters, are folded by every compiler and count nothing. The body of a loop counts once. *Not done
//! here:* what a driver makes of the code; `glisten report` measures times.

use glisten_front::builtin::BuiltinFunction;
use glisten_front::builtin::operations::CallCost;
use glisten_front::hir::{BinaryOp, ExprId, ExprKind, FunctionId, Shader, Stmt, StmtKind, Type, TypeId, Types};
use serde::Serialize;

/// The scalar operations of a call.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Cost {
    /// Additions, products, comparisons, minima, maxima, conversions, selections.
    pub arithmetic: u32,
    /// Divisions, roots, exponentials, logarithms, trigonometry.
    pub special: u32,
    /// Texture lookups.
    pub texture: u32,
    /// Branches on the path.
    pub branches: u32,
    /// Loops; their bodies count once.
    pub loops: u32,
}

impl Cost {
    const fn arithmetic(count: u32) -> Self {
        Self { arithmetic: count, special: 0, texture: 0, branches: 0, loops: 0 }
    }

    const fn special(special: u32, arithmetic: u32) -> Self {
        Self { arithmetic, special, texture: 0, branches: 0, loops: 0 }
    }

    fn and(self, other: Self) -> Self {
        Self {
            arithmetic: self.arithmetic.saturating_add(other.arithmetic),
            special: self.special.saturating_add(other.special),
            texture: self.texture.saturating_add(other.texture),
            branches: self.branches.saturating_add(other.branches),
            loops: self.loops.saturating_add(other.loops),
        }
    }

    /// The weight by which paths are compared: on a GPU a division or a root takes about as long as four products, a
    /// lookup longer.
    pub fn weight(self) -> u32 {
        let (special, texture) = (self.special.saturating_mul(4), self.texture.saturating_mul(16));
        [special, texture, self.branches].into_iter().fold(self.arithmetic, u32::saturating_add)
    }

    fn dearest(self, other: Self) -> Self {
        if other.weight() > self.weight() { other } else { self }
    }
}

impl std::fmt::Display for Cost {
    /// `24 operations, 2 divisions or transcendental functions, 1 branch`
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let plural = |count: u32| if count == 1 { "" } else { "s" };
        let parts = [
            (self.arithmetic, format!("{} operation{}", self.arithmetic, plural(self.arithmetic))),
            (self.special, format!("{} division{s} or transcendental{s}", self.special, s = plural(self.special))),
            (self.texture, format!("{} texture look-up{}", self.texture, plural(self.texture))),
            (self.branches, format!("{} branch{}", self.branches, if self.branches == 1 { "" } else { "es" })),
            (self.loops, format!("{} loop{} (bodies counted once)", self.loops, plural(self.loops))),
        ];
        let told: Vec<String> = parts.into_iter().filter(|(count, _)| *count > 0).map(|(_, text)| text).collect();
        f.write_str(if told.is_empty() { "nothing" } else { "" })?;
        f.write_str(&told.join(", "))
    }
}

/// The cost of a call of the function, without its arguments.
pub fn cost(types: &Types, shader: &Shader, function: FunctionId) -> Cost {
    counted(types, shader, [function]).get(function.index()).copied().flatten().unwrap_or_default()
}

/// The [costs](cost) of all functions of a shader, in their order.
pub fn costs(types: &Types, shader: &Shader) -> Vec<Cost> {
    let roots = shader.functions().map(|(id, _)| id);
    counted(types, shader, roots).into_iter().map(Option::unwrap_or_default).collect()
}

/// The costs of functions and of all that they reach. Callees come first, so that a chain of calls takes no stack. A function that calls itself, which
/// is an error, costs nothing more there.
fn counted(types: &Types, shader: &Shader, roots: impl IntoIterator<Item = FunctionId>) -> Vec<Option<Cost>> {
    let mut counter = Counter { types, shader, known: vec![None; shader.functions.len()] };
    shader.on_stack(|| {
        for id in shader.callees_first_of(roots) {
            let cost = counter.stmts(shader.function(id).body.as_deref().unwrap_or(&[]), Cost::default());
            if let Some(known) = counter.known.get_mut(id.index()) {
                *known = Some(cost);
            }
        }
        counter.known
    })
}

struct Counter<'a> {
    types: &'a Types,
    shader: &'a Shader,
    known: Vec<Option<Cost>>,
}

impl Counter<'_> {
    /// The most expensive path through statements that are reached at the cost `so_far`.
    fn stmts(&self, stmts: &[Stmt], so_far: Cost) -> Cost {
        let (mut cost, mut dearest) = (so_far, so_far);
        for stmt in stmts {
            match &stmt.kind {
                StmtKind::If { arms, otherwise } => {
                    let mut onward = cost;
                    for (condition, body) in arms {
                        cost = cost.and(self.expr(*condition)).and(Cost { branches: 1, ..Cost::default() });
                        let way = self.stmts(body, cost);
                        dearest = dearest.dearest(way);
                        if !leaves(body) {
                            onward = onward.dearest(way);
                        }
                    }
                    let way = self.stmts(otherwise, cost);
                    dearest = dearest.dearest(way);
                    cost = if leaves(otherwise) { onward } else { onward.dearest(way) };
                }
                StmtKind::Block(body) => cost = self.stmts(body, cost),
                StmtKind::Loop { condition, step, body, .. } => {
                    let head = condition.as_ref().map(|condition| condition.expr).into_iter().chain(*step);
                    cost = head.fold(cost, |cost, expr| cost.and(self.expr(expr)));
                    cost = self.stmts(body, cost).and(Cost { loops: 1, ..Cost::default() });
                }
                kind => {
                    cost = kind.exprs().into_iter().fold(cost, |cost, expr| cost.and(self.expr(expr)));
                    cost = kind.bodies().into_iter().fold(cost, |cost, body| self.stmts(body, cost));
                }
            }
        }
        dearest.dearest(cost)
    }

    fn expr(&self, id: ExprId) -> Cost {
        self.evaluated(id).unwrap_or_default()
    }

    /// The cost of an expression; `None` if it consists of literals and of calls without arguments, which a compiler evaluates.
    fn evaluated(&self, id: ExprId) -> Option<Cost> {
        let kind = &self.shader.expr(id).kind;
        let parts: Vec<Option<Cost>> = kind.children().into_iter().map(|child| self.evaluated(child)).collect();
        if !matches!(kind, ExprKind::Var(_)) && parts.iter().all(Option::is_none) {
            return None;
        }
        let called = match kind {
            ExprKind::Call(function, _) => self.known.get(function.index()).copied().flatten().unwrap_or_default(),
            _ => own(self.types, self.shader, id),
        };
        let mut parts = parts.into_iter().map(Option::unwrap_or_default);
        Some(match kind {
            ExprKind::Ternary(..) => {
                let condition = parts.next().unwrap_or_default();
                condition.and(parts.reduce(Cost::dearest).unwrap_or_default()).and(called)
            }
            _ => parts.fold(called, Cost::and),
        })
    }
}

/// The cost of an expression without that of its operands, and without that of the function that it calls.
pub fn own(types: &Types, shader: &Shader, id: ExprId) -> Cost {
    let expr = shader.expr(id);
    let size = |ty: TypeId| types.flat_len(ty).max(1);
    match &expr.kind {
        ExprKind::Binary(op, left, right) | ExprKind::Assign(Some(op), left, right) => {
            binary(types, shader, *op, (*left, *right), size(expr.ty))
        }
        ExprKind::Unary(..) | ExprKind::Convert(_) | ExprKind::IncDec(..) | ExprKind::Ternary(..) => {
            Cost::arithmetic(size(expr.ty))
        }
        ExprKind::Logical(..) => Cost::arithmetic(1),
        ExprKind::BuiltinCall(function, arguments) => {
            let first = arguments.first().map_or(expr.ty, |first| shader.expr(*first).ty);
            builtin(*function, size(expr.ty), size(first))
        }
        _ => Cost::default(),
    }
}

/// The cost of an operator whose result has `size` components.
fn binary(types: &Types, shader: &Shader, op: BinaryOp, (left, right): (ExprId, ExprId), size: u32) -> Cost {
    let len = |id: ExprId| types.flat_len(shader.expr(id).ty).max(1);
    match op {
        BinaryOp::Div => Cost::special(size, 0),
        BinaryOp::MatMul => {
            let inner = match types.get(shader.expr(left).ty) {
                Type::Matrix(columns, _) => u32::from(columns),
                _ => len(left),
            };
            Cost::arithmetic(size * (2 * inner - 1))
        }
        BinaryOp::Equal | BinaryOp::NotEqual => Cost::arithmetic(len(right)),
        _ => Cost::arithmetic(size),
    }
}

/// Whether a body always ends the function, the loop or the iteration.
fn leaves(body: &[Stmt]) -> bool {
    let last = body.last().map(|stmt| &stmt.kind);
    match last {
        Some(StmtKind::Return(_) | StmtKind::Discard | StmtKind::Break | StmtKind::Continue) => true,
        Some(StmtKind::Block(body)) => leaves(body),
        _ => false,
    }
}

/// The cost of a built-in function that returns `size` components and whose first argument has `first`.
fn builtin(function: BuiltinFunction, size: u32, first: u32) -> Cost {
    let CallCost { special, arithmetic, texture } = function.operation().cost;
    Cost { special: special.at(size, first), arithmetic: arithmetic.at(size, first), texture, ..Cost::default() }
}

#[cfg(test)]
mod tests {
    use super::{Cost, cost};
    use glisten_front::hir::{FunctionId, Stage};
    use glisten_front::{Compiler, Options, Source};

    /// The cost of the last function before `main`.
    fn of(text: &str) -> Cost {
        let text = format!("#version 150\n{text}\nout vec4 c;\nvoid main() {{ c = vec4(0.0); }}\n");
        let source = Source { name: "a.frag".into(), text: text.into(), stage: Stage::Fragment };
        let program = Compiler::new(Options::default()).compile(&[source]).program.expect("it is valid");
        let shader = &program.stages[0];
        let last = shader.functions.len() - 2;
        cost(&program.types, shader, FunctionId::new(last))
    }

    #[test]
    fn operations_count_once_a_component() {
        assert_eq!(of("float f(vec3 a, vec3 b) { return dot(a, b); }"), Cost::arithmetic(5));
        assert_eq!(of("vec3 f(vec3 a, vec3 b) { return 2.0 * a + b; }"), Cost::arithmetic(6));
        assert_eq!(of("vec3 f(vec3 a) { return a / sqrt(dot(a, a)); }"), Cost::special(4, 5));
        assert_eq!(of("vec3 f(mat3 m, vec3 a) { return m * a; }"), Cost::arithmetic(15));
    }

    #[test]
    fn literals_are_folded_and_calls_count_what_they_do() {
        assert_eq!(
            of("float g() { return exp2(9.0); } float f(float x) { return x * g() * (1.0 / 3.0); }"),
            Cost::arithmetic(2)
        );
        assert_eq!(of("float g(float x) { return x * x; } float f(float x) { return g(g(x)); }"), Cost::arithmetic(2));
    }

    #[test]
    fn the_dearest_way_counts() {
        let text = "float f(float x) { if (x > 0.0) return sqrt(x); if (x < -1.0) return 0.0; return x + 1.0; }";
        assert_eq!(of(text), Cost { special: 1, arithmetic: 1, branches: 1, ..Cost::default() });
        let text = "float f(float x) { if (x > 0.0) x = sqrt(x); return x + 1.0; }";
        assert_eq!(of(text), Cost { special: 1, arithmetic: 2, branches: 1, ..Cost::default() });
    }
}
