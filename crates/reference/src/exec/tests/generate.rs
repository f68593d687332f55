//! Random well-typed fragment stages, built as HIR. All choices come from bytes. When they run out, the simplest
//! choice is made, so fewer bytes make a smaller program.

use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::{
    BinaryOp as B, Case, CaseLabel, Condition, ConstructKind, ExprId, ExprKind, Function, FunctionId, Global, GlobalId,
    IncDec, Interpolation, Local, LocalId, LocalKind, LogicalOp, LoopKind, ParamMode, Sampling, Scalar, ScalarValue,
    Shader, Stage, Stmt, StmtKind, Storage, Swizzle, Type, TypeId, Types, UnaryOp, VarRef,
};
use glisten_front::link::{Interface, Program, UniformRoot};
use glisten_front::source::Span;
use glisten_front::syntax::ast::{Profile, Version};

/// The source of bytes for choices.
pub(super) struct Source<'a> {
    bytes: &'a [u8],
}

impl<'a> Source<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    fn pick(&mut self, count: usize) -> usize {
        let Some((first, rest)) = self.bytes.split_first() else { return 0 };
        self.bytes = rest;
        usize::from(*first) % count
    }

    fn empty(&self) -> bool {
        self.bytes.is_empty()
    }
}

pub(super) struct Generated {
    pub(super) program: Program,
    pub(super) uniforms: Vec<Vec<ScalarValue>>,
    pub(super) inputs: Vec<(GlobalId, Vec<Scalar>)>,
    pub(super) outputs: Vec<(GlobalId, Vec<Scalar>)>,
}

struct Variable {
    place: VarRef,
    ty: TypeId,
    writable: bool,
}

struct Generator<'s, 'b> {
    source: &'s mut Source<'b>,
    types: Types,
    shader: Shader,
    scope: Vec<Variable>,
    locals: Vec<Local>,
    /// Functions made so far that may be called.
    callable: Vec<FunctionId>,
    loops: u32,
    breakable: u32,
    result: TypeId,
    array: TypeId,
}

pub(super) fn program(source: &mut Source<'_>) -> Generated {
    let mut types = Types::new();
    let array = types.array(TypeId::FLOAT, glisten_front::hir::ArraySize::Sized(5));
    let version = Version { number: 150, profile: Profile::Core, span: Span::default() };
    let shader = Shader::new(Stage::Fragment, version);
    let mut generator = Generator {
        source,
        types,
        shader,
        scope: Vec::new(),
        locals: Vec::new(),
        callable: Vec::new(),
        loops: 0,
        breakable: 0,
        result: TypeId::VOID,
        array,
    };
    generator.whole()
}

const SWIZZLE_TYPES: [TypeId; 4] = [TypeId::FLOAT, TypeId::VEC2, TypeId::VEC3, TypeId::VEC4];

impl Generator<'_, '_> {
    fn whole(&mut self) -> Generated {
        let ints = TypeId::vector(Scalar::Int, 2);
        let inputs = [self.global("a", TypeId::VEC3, Storage::In), self.global("i", ints, Storage::In)];
        let uniform = self.global("u", TypeId::VEC4, Storage::Uniform);
        let array = self.array;
        let table = self.global("t", array, Storage::Uniform);
        let outputs = [self.global("o", TypeId::VEC4, Storage::Out), self.global("p", ints, Storage::Out)];
        let private = self.global("g", TypeId::VEC2, Storage::Private);
        let globals: Vec<(GlobalId, TypeId, bool)> = [
            (inputs[0], TypeId::VEC3, false),
            (inputs[1], ints, false),
            (uniform, TypeId::VEC4, false),
            (table, self.array, false),
            (outputs[0], TypeId::VEC4, true),
            (outputs[1], ints, true),
            (private, TypeId::VEC2, true),
        ]
        .into();
        for index in 0..self.source.pick(3) {
            self.globals_in_scope(&globals);
            self.function(index);
        }
        self.globals_in_scope(&globals);
        self.main();
        let roots = [(uniform, TypeId::VEC4, "u"), (table, self.array, "t")].map(|(id, ty, name)| UniformRoot {
            name: name.into(),
            ty,
            globals: vec![(Stage::Fragment, id)],
            block: None,
            offset: 0,
            default: None,
            active: true,
        });
        let blank = Shader::new(Stage::Fragment, self.shader.version);
        let shader = std::mem::replace(&mut self.shader, blank);
        let interface = Interface { roots: roots.into(), ..Interface::default() };
        let types = std::mem::take(&mut self.types);
        let floats = |count: usize| (0..count).map(|k| ScalarValue::Float(k as f32 * 0.75 - 1.0)).collect();
        Generated {
            program: Program { name: "random".into(), types, stages: vec![shader], interface },
            uniforms: vec![floats(4), floats(5)],
            inputs: vec![(inputs[0], vec![Scalar::Float; 3]), (inputs[1], vec![Scalar::Int; 2])],
            outputs: vec![(outputs[0], vec![Scalar::Float; 4]), (outputs[1], vec![Scalar::Int; 2])],
        }
    }

    fn globals_in_scope(&mut self, globals: &[(GlobalId, TypeId, bool)]) {
        self.scope = (globals.iter())
            .map(|(id, ty, writable)| Variable { place: VarRef::Global(*id), ty: *ty, writable: *writable })
            .collect();
    }

    fn global(&mut self, name: &str, ty: TypeId, storage: Storage) -> GlobalId {
        self.shader.globals.push(Global {
            name: name.into(),
            ty,
            storage,
            builtin: None,
            interpolation: Interpolation::Smooth,
            interpolation_written: false,
            sampling: Sampling::Center,
            invariant: false,
            location: None,
            host_location: None,
            component: None,
            index: None,
            binding: None,
            block: None,
            initializer: None,
            value: None,
            implicitly_sized: false,
            used: true,
            written: true,
            span: Span::default(),
        });
        GlobalId::new(self.shader.globals.len() - 1)
    }

    fn param(&mut self, ty: TypeId, mode: ParamMode) {
        self.locals.push(Local {
            name: String::new(),
            ty,
            kind: LocalKind::Param(mode),
            value: None,
            span: Span::default(),
        });
        let place = VarRef::Local(LocalId::new(self.locals.len() - 1));
        self.scope.push(Variable { place, ty, writable: mode != ParamMode::ConstIn });
    }

    fn function(&mut self, index: usize) {
        self.locals.clear();
        self.param(TypeId::FLOAT, ParamMode::In);
        self.param(TypeId::VEC2, ParamMode::Inout);
        self.param(TypeId::FLOAT, ParamMode::Out);
        self.result = TypeId::FLOAT;
        let count = 1 + self.source.pick(4);
        let mut body = self.stmts(count, 2);
        let value = self.expr(TypeId::FLOAT, 2);
        body.push(stmt(StmtKind::Return(Some(value))));
        let locals = std::mem::take(&mut self.locals);
        self.shader.functions.push(Function {
            name: format!("f{index}"),
            ret: TypeId::FLOAT,
            param_count: 3,
            locals,
            body: Some(body),
            reachable: true,
            span: Span::default(),
        });
        self.callable.push(FunctionId::new(self.shader.functions.len() - 1));
    }

    fn main(&mut self) {
        self.result = TypeId::VOID;
        self.locals.clear();
        let count = 1 + self.source.pick(8);
        let body = self.stmts(count, 3);
        let locals = std::mem::take(&mut self.locals);
        self.shader.functions.push(Function {
            name: "main".into(),
            ret: TypeId::VOID,
            param_count: 0,
            locals,
            body: Some(body),
            reachable: true,
            span: Span::default(),
        });
        self.shader.main = Some(FunctionId::new(self.shader.functions.len() - 1));
    }

    fn stmts(&mut self, count: usize, depth: usize) -> Vec<Stmt> {
        let visible = self.scope.len();
        let list = (0..count).map(|_| self.stmt(depth)).collect();
        self.scope.truncate(visible);
        list
    }

    fn block(&mut self, depth: usize) -> Vec<Stmt> {
        let count = 1 + self.source.pick(3);
        self.stmts(count, depth - 1)
    }

    fn stmt(&mut self, depth: usize) -> Stmt {
        let kind = match self.source.pick(if depth == 0 { 6 } else { 14 }) {
            0..=2 => StmtKind::Expr(self.assignment(2)),
            3 | 4 => self.declaration(),
            5 => match self.source.pick(6) {
                0 if self.loops > 0 => StmtKind::Continue,
                1 | 2 if self.breakable > 0 => StmtKind::Break,
                3 if self.result == TypeId::VOID => StmtKind::Return(None),
                3 => StmtKind::Return(Some(self.expr(TypeId::FLOAT, 1))),
                4 if self.result == TypeId::VOID && self.source.pick(4) == 3 => StmtKind::Discard,
                _ => StmtKind::Expr(self.assignment(1)),
            },
            6..=9 => {
                let arms =
                    (0..1 + self.source.pick(3)).map(|_| (self.expr(TypeId::BOOL, 2), self.block(depth))).collect();
                let otherwise = if self.source.pick(2) == 1 { self.block(depth) } else { Vec::new() };
                StmtKind::If { arms, otherwise }
            }
            10 => self.switch(depth),
            11..=12 => self.iteration(depth),
            _ => StmtKind::Block(self.block(depth)),
        };
        stmt(kind)
    }

    fn new_local(&mut self, ty: TypeId) -> LocalId {
        let local = Local { name: String::new(), ty, kind: LocalKind::Variable, value: None, span: Span::default() };
        self.locals.push(local);
        LocalId::new(self.locals.len() - 1)
    }

    fn any_type(&mut self) -> TypeId {
        let ivec2 = TypeId::vector(Scalar::Int, 2);
        [TypeId::FLOAT, TypeId::INT, TypeId::VEC2, TypeId::VEC3, TypeId::BOOL, ivec2, self.array][self.source.pick(7)]
    }

    fn declaration(&mut self) -> StmtKind {
        let ty = self.any_type();
        let init = if self.source.pick(4) == 3 { None } else { Some(self.expr(ty, 2)) };
        let local = self.new_local(ty);
        self.scope.push(Variable { place: VarRef::Local(local), ty, writable: true });
        StmtKind::Local(local, init)
    }

    fn switch(&mut self, depth: usize) -> StmtKind {
        let selector = self.expr(TypeId::INT, 2);
        self.breakable += 1;
        let count = 1 + self.source.pick(3) as u32;
        let default_at = self.source.pick(4) as u32;
        let cases = (0..count)
            .map(|case| {
                let mut labels = vec![CaseLabel::Value(case), CaseLabel::Value(u32::MAX - case)];
                if case == default_at {
                    labels.push(CaseLabel::Default);
                }
                let mut body = self.block(depth);
                if self.source.pick(2) == 1 {
                    body.push(stmt(StmtKind::Break));
                }
                Case { labels, body }
            })
            .collect();
        self.breakable -= 1;
        StmtKind::Switch { selector, cases }
    }

    /// A loop with few iterations, whose counter nothing else assigns.
    fn iteration(&mut self, depth: usize) -> StmtKind {
        let counter = self.new_local(TypeId::INT);
        let zero = self.int(0);
        let start = stmt(StmtKind::Local(counter, Some(zero)));
        self.scope.push(Variable { place: VarRef::Local(counter), ty: TypeId::INT, writable: false });
        let rounds = 1 + self.source.pick(4) as i32;
        let bound = self.int(rounds);
        let name = self.push(ExprKind::Var(VarRef::Local(counter)), TypeId::INT);
        let again = self.push(ExprKind::Binary(B::Less, name, bound), TypeId::BOOL);
        let extra = self.expr(TypeId::BOOL, 1);
        let expr = if self.source.pick(2) == 1 {
            self.push(ExprKind::Logical(LogicalOp::And, again, extra), TypeId::BOOL)
        } else {
            again
        };
        let name = self.push(ExprKind::Var(VarRef::Local(counter)), TypeId::INT);
        let step = self.push(ExprKind::IncDec(IncDec::PostIncrement, name), TypeId::INT);
        (self.loops, self.breakable) = (self.loops + 1, self.breakable + 1);
        let body = self.block(depth);
        (self.loops, self.breakable) = (self.loops - 1, self.breakable - 1);
        self.scope.pop();
        let kind = if self.source.pick(3) == 2 { LoopKind::DoWhile } else { LoopKind::For };
        let condition = Some(Condition { local: None, expr });
        StmtKind::Block(vec![start, stmt(StmtKind::Loop { kind, condition, step: Some(step), body })])
    }

    fn push(&mut self, kind: ExprKind, ty: TypeId) -> ExprId {
        self.shader.push(kind, ty, Span::default())
    }

    fn int(&mut self, value: i32) -> ExprId {
        self.push(ExprKind::Literal(ScalarValue::Int(value)), TypeId::INT)
    }

    /// A place of the type, if one can be written to.
    fn place(&mut self, ty: TypeId, depth: usize) -> Option<ExprId> {
        let fits = |variable: &&Variable| {
            variable.writable
                && (variable.ty == ty
                    || (ty == TypeId::FLOAT
                        && matches!(self.types.get(variable.ty), Type::Vector(Scalar::Float, _) | Type::Array(..))))
        };
        let found: Vec<(VarRef, TypeId)> =
            self.scope.iter().filter(fits).map(|found| (found.place, found.ty)).collect();
        if found.is_empty() {
            return None;
        }
        let (place, whole) = found[self.source.pick(found.len())];
        let var = self.push(ExprKind::Var(place), whole);
        if whole == ty {
            return Some(var);
        }
        let array = whole == self.array;
        if array || self.source.pick(2) == 1 {
            let index = if depth == 0 { self.int(1) } else { self.index(depth) };
            return Some(self.push(ExprKind::Index(var, index), TypeId::FLOAT));
        }
        let swizzle = Swizzle { len: 1, components: [self.source.pick(2) as u8, 0, 0, 0] };
        Some(self.push(ExprKind::Swizzle(var, swizzle), TypeId::FLOAT))
    }

    fn index(&mut self, depth: usize) -> ExprId {
        if self.source.pick(3) == 0 {
            let k = self.source.pick(6) as i32 - 1;
            self.int(k)
        } else {
            self.expr(TypeId::INT, depth - 1)
        }
    }

    fn assignment(&mut self, depth: usize) -> ExprId {
        let types =
            [TypeId::FLOAT, TypeId::VEC4, TypeId::VEC2, TypeId::vector(Scalar::Int, 2), TypeId::INT, self.array];
        let ty = types[self.source.pick(6)];
        let Some(place) = self.place(ty, depth) else { return self.expr(TypeId::FLOAT, depth) };
        if ty == TypeId::VEC2 && self.source.pick(3) == 1 {
            // `v.yx = ..`
            let swizzle = Swizzle { len: 2, components: [1, 0, 0, 0] };
            let place = self.push(ExprKind::Swizzle(place, swizzle), ty);
            let value = self.expr(ty, depth);
            return self.push(ExprKind::Assign(None, place, value), ty);
        }
        let numeric = ty != self.array;
        let op =
            if numeric { [None, None, Some(B::Add), Some(B::Mul), Some(B::Sub)][self.source.pick(5)] } else { None };
        let value = self.expr(ty, depth);
        self.push(ExprKind::Assign(op, place, value), ty)
    }

    fn literal(&mut self, scalar: Scalar) -> ExprId {
        let k = self.source.pick(12);
        let (value, ty) = match scalar {
            Scalar::Float => (ScalarValue::Float([0.0, 1.0, -1.5, 0.25, 3.0, 100.0][k % 6]), TypeId::FLOAT),
            Scalar::Bool => (ScalarValue::Bool(k % 2 == 1), TypeId::BOOL),
            _ => (ScalarValue::Int([0, 1, 2, -3, 7, i32::MAX][k % 6]), TypeId::INT),
        };
        self.push(ExprKind::Literal(value), ty)
    }

    fn leaf(&mut self, ty: TypeId) -> ExprId {
        let found: Vec<VarRef> =
            self.scope.iter().filter(|variable| variable.ty == ty).map(|found| found.place).collect();
        if !found.is_empty() && self.source.pick(4) != 0 {
            let place = found[self.source.pick(found.len())];
            return self.push(ExprKind::Var(place), ty);
        }
        let scalar = self.types.scalar_of(ty);
        match (self.types.get(ty), scalar) {
            (Type::Array(..), _) => {
                let elements = (0..5).map(|_| self.literal(Scalar::Float)).collect();
                self.push(ExprKind::Construct(ConstructKind::Array, elements), ty)
            }
            (Type::Vector(..), Some(scalar)) => {
                let one = self.literal(scalar);
                self.push(ExprKind::Construct(ConstructKind::Splat, vec![one]), ty)
            }
            (_, scalar) => self.literal(scalar.unwrap_or(Scalar::Float)),
        }
    }

    fn expr(&mut self, ty: TypeId, depth: usize) -> ExprId {
        if depth == 0 || self.source.empty() {
            return self.leaf(ty);
        }
        let depth = depth - 1;
        match self.source.pick(16) {
            0..=2 => self.leaf(ty),
            3 => {
                let (c, a) = (self.expr(TypeId::BOOL, depth), self.expr(ty, depth));
                let b = self.expr(ty, depth);
                self.push(ExprKind::Ternary(c, a, b), ty)
            }
            4 => {
                let (a, b) = (self.assignment(depth), self.expr(ty, depth));
                self.push(ExprKind::Comma(a, b), ty)
            }
            5 if ty != TypeId::BOOL => match self.place(ty, depth) {
                Some(place) => {
                    let value = self.expr(ty, depth);
                    self.push(ExprKind::Assign(None, place, value), ty)
                }
                None => self.leaf(ty),
            },
            _ => match self.types.get(ty) {
                Type::Scalar(Scalar::Bool) => self.boolean(depth),
                Type::Scalar(Scalar::Int) | Type::Vector(Scalar::Int, _) => self.integer(ty, depth),
                Type::Array(..) => self.leaf(ty),
                _ => self.float(ty, depth),
            },
        }
    }

    fn boolean(&mut self, depth: usize) -> ExprId {
        let kind = match self.source.pick(7) {
            0 | 1 => {
                let op = [B::Less, B::GreaterEqual, B::LessEqual, B::Greater][self.source.pick(4)];
                let ty = [TypeId::FLOAT, TypeId::INT][self.source.pick(2)];
                ExprKind::Binary(op, self.expr(ty, depth), self.expr(ty, depth))
            }
            2 => {
                let ty = self.any_type();
                ExprKind::Binary(
                    [B::Equal, B::NotEqual][self.source.pick(2)],
                    self.expr(ty, depth),
                    self.expr(ty, depth),
                )
            }
            3 => ExprKind::Logical(LogicalOp::And, self.expr(TypeId::BOOL, depth), self.expr(TypeId::BOOL, depth)),
            4 => ExprKind::Logical(LogicalOp::Or, self.expr(TypeId::BOOL, depth), self.expr(TypeId::BOOL, depth)),
            5 => ExprKind::Unary(UnaryOp::Not, self.expr(TypeId::BOOL, depth)),
            _ => ExprKind::Convert(self.expr(TypeId::INT, depth)),
        };
        self.push(kind, TypeId::BOOL)
    }

    fn integer(&mut self, ty: TypeId, depth: usize) -> ExprId {
        let scalar = ty == TypeId::INT;
        let kind = match self.source.pick(7) {
            0..=2 => {
                let ops = [B::Add, B::Sub, B::Mul, B::Div, B::Rem, B::BitXor, B::Shl, B::Shr];
                ExprKind::Binary(ops[self.source.pick(8)], self.expr(ty, depth), self.expr(ty, depth))
            }
            3 if scalar => match self.place(ty, 0) {
                Some(place) => {
                    let all =
                        [IncDec::PostIncrement, IncDec::PreDecrement, IncDec::PreIncrement, IncDec::PostDecrement];
                    ExprKind::IncDec(all[self.source.pick(4)], place)
                }
                None => return self.leaf(ty),
            },
            4 if scalar => ExprKind::Convert(self.expr(TypeId::FLOAT, depth)),
            5 if scalar => {
                let whole = TypeId::vector(Scalar::Int, 2);
                let (base, index) = (self.expr(whole, depth), self.expr(TypeId::INT, depth));
                ExprKind::Index(base, index)
            }
            _ => ExprKind::Unary([UnaryOp::Negate, UnaryOp::BitNot][self.source.pick(2)], self.expr(ty, depth)),
        };
        self.push(kind, ty)
    }

    fn float(&mut self, ty: TypeId, depth: usize) -> ExprId {
        let scalar = ty == TypeId::FLOAT;
        let kind = match self.source.pick(11) {
            0..=2 => {
                let op = [B::Add, B::Sub, B::Mul, B::Div][self.source.pick(4)];
                let right = if self.source.pick(2) == 0 { TypeId::FLOAT } else { ty };
                ExprKind::Binary(op, self.expr(ty, depth), self.expr(right, depth))
            }
            3 => ExprKind::Unary(UnaryOp::Negate, self.expr(ty, depth)),
            4 => {
                let functions = [F::Abs, F::Floor, F::Sign, F::Ceil, F::Fract, F::Trunc];
                ExprKind::BuiltinCall(functions[self.source.pick(6)], vec![self.expr(ty, depth)])
            }
            5 => {
                let function = [F::Min, F::Max, F::Step][self.source.pick(3)];
                ExprKind::BuiltinCall(function, vec![self.expr(ty, depth), self.expr(ty, depth)])
            }
            6 if scalar => {
                let vector = SWIZZLE_TYPES[1 + self.source.pick(3)];
                ExprKind::BuiltinCall(F::Dot, vec![self.expr(vector, depth), self.expr(vector, depth)])
            }
            7 if scalar => {
                let whole = [TypeId::VEC3, self.array][self.source.pick(2)];
                let (base, index) = (self.expr(whole, depth), self.expr(TypeId::INT, depth));
                ExprKind::Index(base, index)
            }
            8 if scalar => return self.call(depth),
            9 if scalar => ExprKind::Convert(self.expr(TypeId::INT, depth)),
            _ => {
                let size = self.types.flat_len(ty) as u8;
                let from = SWIZZLE_TYPES[1 + self.source.pick(3)];
                let count = self.types.flat_len(from) as usize;
                let base = self.expr(from, depth);
                let mut components = [0; 4];
                components.iter_mut().take(usize::from(size)).for_each(|c| *c = self.source.pick(count) as u8);
                ExprKind::Swizzle(base, Swizzle { len: size, components })
            }
        };
        self.push(kind, ty)
    }

    fn call(&mut self, depth: usize) -> ExprId {
        if self.callable.is_empty() {
            return self.leaf(TypeId::FLOAT);
        }
        let function = self.callable[self.source.pick(self.callable.len())];
        let first = self.expr(TypeId::FLOAT, depth);
        let (Some(second), Some(third)) = (self.place(TypeId::VEC2, depth), self.place(TypeId::FLOAT, depth)) else {
            return first;
        };
        self.push(ExprKind::Call(function, vec![first, second, third]), TypeId::FLOAT)
    }
}

fn stmt(kind: StmtKind) -> Stmt {
    Stmt { kind, span: Span::default() }
}

/// The functions as text for a message: the statements with the numbers of their expressions, and the expressions.
pub(super) fn text(generated: &Generated) -> String {
    let shader = &generated.program.stages[0];
    let mut text = String::new();
    for function in &shader.functions {
        text += &format!("{}: {:?}\n", function.name, function.body);
    }
    for (place, expr) in shader.exprs.iter().enumerate() {
        text += &format!("{place}: {:?}\n", expr.kind);
    }
    text.replace("span: Span { start: 0, end: 0, expansion: ExpansionId(0) }", "").replace("ExprId", "")
}
