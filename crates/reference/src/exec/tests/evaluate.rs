//! A plain tree walk over the HIR, one lane at a time in f64, against which the register code is checked. It knows
//! the constructs that `generate` makes, and shares no code with the executor.

use super::generate::Generated;
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::{
    BinaryOp as B, CaseLabel, ConstructKind, ExprId, ExprKind, FunctionId, GlobalId, IncDec, LogicalOp, LoopKind,
    ParamMode, Scalar, ScalarValue, Shader, Stmt, StmtKind, Storage, Type, TypeId, Types, UnaryOp, VarRef,
};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cell {
    Float(f64),
    Int(u32),
}

impl Cell {
    fn float(self) -> f64 {
        match self {
            Self::Float(value) => value,
            Self::Int(_) => panic!("a float was wanted"),
        }
    }
    fn int(self) -> u32 {
        match self {
            Self::Int(bits) => bits,
            Self::Float(_) => panic!("an int was wanted"),
        }
    }
}

enum Flow {
    Next,
    Break,
    Continue,
    Return,
    Discard,
}

struct Walk<'a> {
    shader: &'a Shader,
    types: &'a Types,
    globals: Vec<Vec<Cell>>,
    frames: Vec<Vec<Vec<Cell>>>,
    result: Vec<Cell>,
    gone: bool,
}

/// A variable and its scalars.
type LValue = (VarRef, Vec<usize>);

/// The scalars of the outputs; `None` if the lane is discarded.
pub(super) fn run(program: &Generated, input: impl Fn(GlobalId, u32, Scalar) -> Cell) -> Option<Vec<Cell>> {
    let shader = &program.program.stages[0];
    let types = &program.program.types;
    let mut walk = Walk { shader, types, globals: Vec::new(), frames: Vec::new(), result: Vec::new(), gone: false };
    for (id, global) in shader.globals() {
        let scalar = walk.scalar(global.ty);
        let count = types.flat_len(global.ty);
        let root = program.program.interface.roots.iter().position(|root| root.globals[0].1 == id);
        let cells = (0..count).map(|flat| match (global.storage, root) {
            (Storage::In, _) => input(id, flat, scalar),
            (Storage::Uniform, Some(root)) => constant(program.uniforms[root][flat as usize]),
            _ => zero(scalar),
        });
        walk.globals.push(cells.collect());
    }
    walk.call(shader.main.expect("there is a main"), Vec::new());
    let cells = program.outputs.iter().flat_map(|(id, _)| walk.globals[id.index()].clone()).collect();
    (!walk.gone).then_some(cells)
}

fn zero(scalar: Scalar) -> Cell {
    if scalar == Scalar::Float { Cell::Float(0.0) } else { Cell::Int(0) }
}

fn constant(value: ScalarValue) -> Cell {
    match value {
        ScalarValue::Bool(value) => Cell::Int(u32::from(value)),
        ScalarValue::Int(value) => Cell::Int(value as u32),
        ScalarValue::Uint(value) => Cell::Int(value),
        ScalarValue::Float(value) => Cell::Float(f64::from(value)),
    }
}

impl Walk<'_> {
    fn scalar(&self, ty: TypeId) -> Scalar {
        match self.types.get(ty) {
            Type::Array(element, _) => self.scalar(element),
            _ => self.types.scalar_of(ty).unwrap_or(Scalar::Float),
        }
    }

    fn blank(&self, ty: TypeId) -> Vec<Cell> {
        vec![zero(self.scalar(ty)); self.types.flat_len(ty) as usize]
    }

    fn variable(&mut self, var: VarRef) -> &mut Vec<Cell> {
        match var {
            VarRef::Global(id) => &mut self.globals[id.index()],
            VarRef::Local(id) => &mut self.frames.last_mut().expect("a function runs")[id.index()],
        }
    }

    /// Runs a function on the arguments. Returns the final values of its parameters.
    fn call(&mut self, id: FunctionId, arguments: Vec<Vec<Cell>>) -> Vec<Vec<Cell>> {
        let function = self.shader.function(id);
        let mut locals: Vec<Vec<Cell>> = function.locals.iter().map(|local| self.blank(local.ty)).collect();
        let count = arguments.len();
        for (local, argument) in locals.iter_mut().zip(arguments) {
            *local = argument;
        }
        self.frames.push(locals);
        self.result = self.blank(function.ret);
        if let Flow::Discard = self.stmts(function.body.as_ref().expect("it has a body")) {
            self.gone = true;
        }
        let mut locals = self.frames.pop().expect("pushed above");
        locals.truncate(count);
        locals
    }

    fn stmts(&mut self, stmts: &[Stmt]) -> Flow {
        for stmt in stmts {
            match self.stmt(&stmt.kind) {
                Flow::Next => {}
                other => return other,
            }
        }
        Flow::Next
    }

    fn stmt(&mut self, stmt: &StmtKind) -> Flow {
        match stmt {
            StmtKind::Expr(expr) => {
                self.expr(*expr);
            }
            StmtKind::Local(local, init) => {
                let value = match init {
                    Some(init) => self.expr(*init),
                    None => {
                        let old = self.variable(VarRef::Local(*local)).clone();
                        old.iter()
                            .map(|cell| zero(if let Cell::Float(_) = cell { Scalar::Float } else { Scalar::Int }))
                            .collect()
                    }
                };
                *self.variable(VarRef::Local(*local)) = value;
            }
            StmtKind::Block(body) => return self.stmts(body),
            StmtKind::If { arms, otherwise } => {
                for (condition, body) in arms {
                    if self.truth(*condition) {
                        return self.stmts(body);
                    }
                }
                return self.stmts(otherwise);
            }
            StmtKind::Switch { selector, cases } => {
                let selector = self.expr(*selector)[0].int();
                let hit = cases.iter().position(|case| case.labels.contains(&CaseLabel::Value(selector)));
                let start = hit.or_else(|| cases.iter().position(|case| case.labels.contains(&CaseLabel::Default)));
                for case in cases.iter().skip(start.unwrap_or(cases.len())) {
                    match self.stmts(&case.body) {
                        Flow::Next => {}
                        Flow::Break => return Flow::Next,
                        other => return other,
                    }
                }
            }
            StmtKind::Loop { kind, condition, step, body } => {
                let mut first = *kind == LoopKind::DoWhile;
                loop {
                    let go = first || condition.as_ref().is_none_or(|condition| self.truth(condition.expr));
                    first = false;
                    if !go {
                        break;
                    }
                    match self.stmts(body) {
                        Flow::Next | Flow::Continue => {}
                        Flow::Break => break,
                        other => return other,
                    }
                    if let Some(step) = step {
                        self.expr(*step);
                    }
                }
            }
            StmtKind::Break => return Flow::Break,
            StmtKind::Continue => return Flow::Continue,
            StmtKind::Return(value) => {
                if let Some(value) = value {
                    let value = self.expr(*value);
                    self.result = value;
                }
                return Flow::Return;
            }
            StmtKind::Discard => return Flow::Discard,
        }
        Flow::Next
    }

    fn truth(&mut self, expr: ExprId) -> bool {
        self.expr(expr)[0].int() != 0
    }

    /// The place of an l-value. Its indices are evaluated.
    fn place(&mut self, expr: ExprId) -> LValue {
        match self.shader.expr(expr).kind {
            ExprKind::Var(var) => (var, (0..self.variable(var).len()).collect()),
            ExprKind::Swizzle(base, swizzle) => {
                let (var, cells) = self.place(base);
                (var, swizzle.as_slice().iter().map(|c| cells[usize::from(*c)]).collect())
            }
            ExprKind::Index(base, index) => {
                let (var, cells) = self.place(base);
                let index = self.expr(index)[0].int() as i32;
                (var, vec![cells[index.clamp(0, cells.len() as i32 - 1) as usize]])
            }
            _ => panic!("no l-value"),
        }
    }

    fn read(&mut self, place: &LValue) -> Vec<Cell> {
        let cells = self.variable(place.0);
        place.1.iter().map(|flat| cells[*flat]).collect()
    }

    fn write(&mut self, place: &LValue, value: &[Cell]) {
        let cells = self.variable(place.0);
        place.1.iter().zip(value).for_each(|(flat, value)| cells[*flat] = *value);
    }

    fn expr(&mut self, id: ExprId) -> Vec<Cell> {
        let shader = self.shader;
        let expr = shader.expr(id);
        match &expr.kind {
            ExprKind::Literal(value) => vec![constant(*value)],
            ExprKind::Var(var) => self.variable(*var).clone(),
            ExprKind::Index(base, index) => {
                let base = self.expr(*base);
                let index = self.expr(*index)[0].int() as i32;
                vec![base[index.clamp(0, base.len() as i32 - 1) as usize]]
            }
            ExprKind::Swizzle(base, swizzle) => {
                let base = self.expr(*base);
                swizzle.as_slice().iter().map(|c| base[usize::from(*c)]).collect()
            }
            ExprKind::Convert(inner) => {
                let (to, value) = (self.scalar(expr.ty), self.expr(*inner));
                let one = |cell: &Cell| match (cell, to) {
                    (Cell::Float(value), Scalar::Int) => Cell::Int(*value as i32 as u32),
                    (Cell::Int(bits), Scalar::Float) => Cell::Float(f64::from(*bits as i32)),
                    (Cell::Int(bits), Scalar::Bool) => Cell::Int(u32::from(*bits != 0)),
                    _ => panic!("not made"),
                };
                value.iter().map(one).collect()
            }
            ExprKind::Construct(kind, arguments) => {
                let values: Vec<Cell> = arguments.iter().flat_map(|argument| self.expr(*argument)).collect();
                match kind {
                    ConstructKind::Splat => vec![values[0]; self.types.flat_len(expr.ty) as usize],
                    _ => values,
                }
            }
            ExprKind::Unary(op, inner) => {
                let one = |cell: &Cell| match (op, cell) {
                    (UnaryOp::Negate, Cell::Float(value)) => Cell::Float(-value),
                    (UnaryOp::Negate, Cell::Int(bits)) => Cell::Int(0u32.wrapping_sub(*bits)),
                    (UnaryOp::Not, Cell::Int(bits)) => Cell::Int(1 - bits),
                    (UnaryOp::BitNot, Cell::Int(bits)) => Cell::Int(!bits),
                    _ => panic!("not made"),
                };
                self.expr(*inner).iter().map(one).collect()
            }
            ExprKind::IncDec(op, place) => {
                let place = self.place(*place);
                let before = self.read(&place);
                let step = if matches!(op, IncDec::PreIncrement | IncDec::PostIncrement) { 1 } else { u32::MAX };
                let after: Vec<Cell> = before.iter().map(|cell| Cell::Int(cell.int().wrapping_add(step))).collect();
                self.write(&place, &after);
                if matches!(op, IncDec::PreIncrement | IncDec::PreDecrement) { after } else { before }
            }
            ExprKind::Binary(op, a, b) => {
                let (a, b) = (self.expr(*a), self.expr(*b));
                self.binary(*op, &a, &b, expr.ty)
            }
            ExprKind::Logical(LogicalOp::And, a, b) => vec![Cell::Int(u32::from(self.truth(*a) && self.truth(*b)))],
            ExprKind::Logical(LogicalOp::Or, a, b) => vec![Cell::Int(u32::from(self.truth(*a) || self.truth(*b)))],
            ExprKind::Ternary(c, a, b) => {
                if self.truth(*c) {
                    self.expr(*a)
                } else {
                    self.expr(*b)
                }
            }
            ExprKind::Assign(op, place, value) => {
                let ty = expr.ty;
                let place = self.place(*place);
                let value = match op {
                    None => self.expr(*value),
                    Some(op) => {
                        let left = self.read(&place);
                        let right = self.expr(*value);
                        self.binary(*op, &left, &right, ty)
                    }
                };
                self.write(&place, &value);
                value
            }
            ExprKind::Comma(a, b) => {
                self.expr(*a);
                self.expr(*b)
            }
            ExprKind::Call(function, arguments) => self.user_call(*function, arguments),
            ExprKind::BuiltinCall(function, arguments) => {
                let values: Vec<Vec<Cell>> = arguments.iter().map(|argument| self.expr(*argument)).collect();
                builtin(*function, &values)
            }
            ExprKind::Member(..) | ExprKind::Error => panic!("not made"),
        }
    }

    fn user_call(&mut self, function: FunctionId, arguments: &[ExprId]) -> Vec<Cell> {
        let callee = self.shader.function(function);
        let mut values = Vec::new();
        let mut places = Vec::new();
        for (index, argument) in arguments.iter().enumerate() {
            match callee.param_mode(index) {
                ParamMode::In | ParamMode::ConstIn => values.push(self.expr(*argument)),
                mode => {
                    let place = self.place(*argument);
                    let value = self.read(&place);
                    let blank = self.blank(callee.params()[index].ty);
                    values.push(if mode == ParamMode::Inout { value } else { blank });
                    places.push((index, place));
                }
            }
        }
        let finals = self.call(function, values);
        for (index, place) in places {
            self.write(&place, &finals[index]);
        }
        std::mem::take(&mut self.result)
    }

    fn binary(&self, op: B, a: &[Cell], b: &[Cell], ty: TypeId) -> Vec<Cell> {
        if matches!(op, B::Equal | B::NotEqual) {
            let same = a.iter().zip(b).all(|(a, b)| a == b);
            return vec![Cell::Int(u32::from(same == (op == B::Equal)))];
        }
        let count = (self.types.flat_len(ty) as usize).max(1);
        let pick = |cells: &[Cell], flat: usize| if cells.len() == 1 { cells[0] } else { cells[flat] };
        (0..count).map(|flat| scalar_binary(op, pick(a, flat), pick(b, flat))).collect()
    }
}

fn scalar_binary(op: B, a: Cell, b: Cell) -> Cell {
    if let (Cell::Float(a), Cell::Float(b)) = (a, b) {
        return match op {
            B::Add => Cell::Float(a + b),
            B::Sub => Cell::Float(a - b),
            B::Mul => Cell::Float(a * b),
            B::Div => Cell::Float(a / b),
            B::Less => Cell::Int(u32::from(a < b)),
            B::Greater => Cell::Int(u32::from(a > b)),
            B::LessEqual => Cell::Int(u32::from(a <= b)),
            B::GreaterEqual => Cell::Int(u32::from(a >= b)),
            _ => panic!("not made"),
        };
    }
    let (a, b) = (a.int() as i32, b.int() as i32);
    let result = match op {
        B::Add => a.wrapping_add(b),
        B::Sub => a.wrapping_sub(b),
        B::Mul => a.wrapping_mul(b),
        B::Div if b == 0 => -1,
        B::Div => a.wrapping_div(b),
        B::Rem if b == 0 => -1,
        B::Rem => a.wrapping_rem(b),
        B::BitXor => a ^ b,
        B::Shl => a << (b & 31),
        B::Shr => a >> (b & 31),
        B::Less => i32::from(a < b),
        B::Greater => i32::from(a > b),
        B::LessEqual => i32::from(a <= b),
        B::GreaterEqual => i32::from(a >= b),
        _ => panic!("not made"),
    };
    Cell::Int(result as u32)
}

fn builtin(function: F, values: &[Vec<Cell>]) -> Vec<Cell> {
    let floats = |place: usize| values[place].iter().map(|cell: &Cell| cell.float()).collect::<Vec<f64>>();
    let each = |f: &dyn Fn(f64) -> f64| floats(0).into_iter().map(|x| Cell::Float(f(x))).collect();
    let both =
        |f: &dyn Fn(f64, f64) -> f64| floats(0).into_iter().zip(floats(1)).map(|(x, y)| Cell::Float(f(x, y))).collect();
    match function {
        F::Abs => each(&f64::abs),
        F::Floor => each(&f64::floor),
        F::Ceil => each(&f64::ceil),
        F::Trunc => each(&f64::trunc),
        F::Fract => each(&|x| x - x.floor()),
        F::Sign => each(&|x| {
            if x > 0.0 {
                1.0
            } else if x < 0.0 {
                -1.0
            } else {
                0.0
            }
        }),
        F::Min => both(&f64::min),
        F::Max => both(&f64::max),
        F::Step => both(&|edge, x| if x < edge { 0.0 } else { 1.0 }),
        F::Dot => {
            let products: Vec<f64> = floats(0).into_iter().zip(floats(1)).map(|(x, y)| x * y).collect();
            vec![Cell::Float(products.iter().skip(1).fold(products[0], |sum, product| sum + product))]
        }
        _ => panic!("not made"),
    }
}
