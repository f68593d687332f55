//! [`Shader`]: one stage, and what stands at global scope.

use super::{Expr, ExprId, ExprKind, Stmt, TypeId, Value, VarRef};
use crate::builtin::BuiltinVariable;
use crate::language::{Interpolation, ParamMode, Stage, Storage, Version};
use crate::source::Span;
use std::sync::Arc;

macro_rules! handle {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(u32);

        impl $name {
            /// The handle of the place `index` in its arena.
            pub fn new(index: usize) -> Self {
                Self(index as u32)
            }

            /// The place in its arena.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

handle!(
    /// A global in a [`Shader`].
    GlobalId
);
handle!(
    /// A function in a [`Shader`].
    FunctionId
);
handle!(
    /// A local in a [`Function`].
    LocalId
);

/// The layout of a uniform block (§4.3.8.3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum BlockLayout {
    #[default]
    Shared,
    Packed,
    Std140,
}

/// What a global that is an interface block has beyond its type, a struct or an array of one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockInfo {
    /// The name behind `uniform`, `in` or `out`: by it blocks are matched.
    pub name: String,
    /// The instance name; without one the members are global names.
    pub instance: Option<String>,
    /// Uniform blocks.
    pub layout: BlockLayout,
    /// `layout(binding = n)` (ARB_shading_language_420pack).
    pub binding: Option<u32>,
}

/// A variable at global scope, declared or built in.
#[derive(Clone, Debug)]
pub struct Global {
    /// Its name; for a block without an instance name the block's name.
    pub name: String,
    /// Its type.
    pub ty: TypeId,
    /// Where it lives.
    pub storage: Storage,
    /// The built-in variable that it is.
    pub builtin: Option<BuiltinVariable>,
    /// `in` and `out` between stages.
    pub interpolation: Interpolation,
    /// Whether an interpolation qualifier is written.
    pub interpolation_written: bool,
    /// `centroid`
    pub centroid: bool,
    /// `invariant`
    pub invariant: bool,
    /// `layout(location = n)` (ARB_explicit_attrib_location).
    pub location: Option<u32>,
    /// `layout(index = n)` likewise.
    pub index: Option<u32>,
    /// `layout(binding = n)` of a sampler (ARB_shading_language_420pack).
    pub binding: Option<u32>,
    /// For blocks.
    pub block: Option<BlockInfo>,
    /// The initializer: of constants, uniforms and private variables, already of the global's type.
    pub initializer: Option<ExprId>,
    /// The value of a constant or of a uniform's initializer.
    pub value: Option<Value>,
    /// Whether the size of its array comes from use alone (§4.1.9).
    pub implicitly_sized: bool,
    /// Whether it is named in a function that `main` can reach, or in the initializer of such a global ("static use").
    pub used: bool,
    /// Likewise, and assigned to.
    pub written: bool,
    /// The name in the declaration; nowhere for a built-in that is not redeclared.
    pub span: Span,
}

impl Global {
    /// The texture unit or buffer binding point that `layout(binding = n)` gives it.
    pub fn unit(&self) -> Option<u32> {
        self.block.as_ref().map_or(self.binding, |block| block.binding)
    }
}

/// Whether a local is a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LocalKind {
    /// A parameter.
    Param(ParamMode),
    /// A variable.
    Variable,
    /// `const`
    Const,
}

/// A variable of a function.
#[derive(Clone, Debug)]
pub struct Local {
    /// Its name; empty for a parameter without one.
    pub name: String,
    /// Its type.
    pub ty: TypeId,
    /// What it is.
    pub kind: LocalKind,
    /// The value of a constant.
    pub value: Option<Value>,
    /// Where.
    pub span: Span,
}

/// A function (§6.1).
#[derive(Clone, Debug)]
pub struct Function {
    /// Its name; overloads share it.
    pub name: String,
    /// What it returns.
    pub ret: TypeId,
    /// How many of the first locals are parameters.
    pub param_count: usize,
    /// Parameters first, then variables in the order of their declarations.
    pub locals: Vec<Local>,
    /// The body; `None` if only a prototype was seen.
    pub body: Option<Vec<Stmt>>,
    /// Whether `main` can reach it.
    pub reachable: bool,
    /// The name in the definition (or the prototype).
    pub span: Span,
}

impl Function {
    /// The parameters.
    pub fn params(&self) -> &[Local] {
        self.locals.get(..self.param_count).unwrap_or(&[])
    }

    /// How the parameter is passed; `In` past the last.
    pub fn param_mode(&self, index: usize) -> ParamMode {
        match self.params().get(index).map(|local| local.kind) {
            Some(LocalKind::Param(mode)) => mode,
            _ => ParamMode::In,
        }
    }

    /// The types of the parameters and how they are passed.
    pub fn param_types(&self) -> impl Iterator<Item = (TypeId, ParamMode)> {
        self.params().iter().map(|param| match param.kind {
            LocalKind::Param(mode) => (param.ty, mode),
            LocalKind::Variable | LocalKind::Const => (param.ty, ParamMode::In),
        })
    }

    /// The local behind a handle of this function.
    pub fn local(&self, id: LocalId) -> &Local {
        // A `LocalId` is only ever made for this function.
        &self.locals[id.index()]
    }
}

/// `layout(points) in;` and its like (§4.3.8.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum PrimitiveIn {
    Points,
    Lines,
    LinesAdjacency,
    Triangles,
    TrianglesAdjacency,
}

impl PrimitiveIn {
    /// The vertices of one primitive: the size of the input arrays.
    pub fn vertices(self) -> u32 {
        match self {
            Self::Points => 1,
            Self::Lines => 2,
            Self::LinesAdjacency => 4,
            Self::Triangles => 3,
            Self::TrianglesAdjacency => 6,
        }
    }
}

/// `layout(line_strip) out;` and its like (§4.3.8.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum PrimitiveOut {
    Points,
    LineStrip,
    TriangleStrip,
}

/// What a geometry shader declares.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GeometryLayout {
    /// What comes in.
    pub input: Option<PrimitiveIn>,
    /// What goes out.
    pub output: Option<PrimitiveOut>,
    /// At most so many vertices.
    pub max_vertices: Option<u32>,
}

/// What a fragment shader declares of `gl_FragCoord` (§4.3.8.1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FragCoordLayout {
    /// `layout(origin_upper_left)`
    pub origin_upper_left: bool,
    /// `layout(pixel_center_integer)`
    pub pixel_center_integer: bool,
}

/// `out gl_PerVertex { .. };` declared anew.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PerVertexOut {
    /// The members that are left, in order.
    pub members: Vec<String>,
    /// The block's name in the declaration.
    pub span: Span,
}

/// One stage.
#[derive(Clone, Debug)]
pub struct Shader {
    /// Which stage.
    pub stage: Stage,
    /// The language it was written in.
    pub version: Version,
    /// All expressions of all functions and initializers.
    pub exprs: Vec<Expr>,
    /// All globals that are declared, and the built-in variables that are named.
    pub globals: Vec<Global>,
    /// All functions that are declared or defined; prototypes of functions of the same shader are merged into them.
    pub functions: Vec<Function>,
    /// `main`, if it is defined.
    pub main: Option<FunctionId>,
    /// Geometry shaders.
    pub geometry: GeometryLayout,
    /// Fragment shaders.
    pub frag_coord: FragCoordLayout,
    /// Vertex and geometry shaders that declare their built-in outputs anew.
    pub per_vertex_out: Option<PerVertexOut>,
    /// The deepest expression, counted along left operands too: more than a few hundred asks for a big stack
    /// (see [`Shader::on_stack`]).
    pub expr_depth: u32,
    /// What an OpenGL driver takes for it, a text for each source ([`whole_text`](crate::source::whole_text)); empty for a
    /// shader that was not compiled.
    pub texts: Vec<Arc<str>>,
}

impl Shader {
    /// An empty shader.
    pub fn new(stage: Stage, version: Version) -> Self {
        Self {
            stage,
            version,
            exprs: Vec::new(),
            globals: Vec::new(),
            functions: Vec::new(),
            main: None,
            geometry: GeometryLayout::default(),
            frag_coord: FragCoordLayout::default(),
            per_vertex_out: None,
            expr_depth: 0,
            texts: Vec::new(),
        }
    }

    /// Adds an expression.
    pub fn push(&mut self, kind: ExprKind, ty: TypeId, span: Span) -> ExprId {
        let id = ExprId(self.exprs.len() as u32);
        self.exprs.push(Expr { kind, ty, span });
        id
    }

    /// The expression behind a handle of this shader.
    pub fn expr(&self, id: ExprId) -> &Expr {
        // An `ExprId` is only ever made by `push` of this shader.
        &self.exprs[id.index()]
    }

    /// The operands of an expression.
    pub fn children(&self, id: ExprId) -> smallvec::SmallVec<[ExprId; 4]> {
        self.expr(id).kind.children()
    }

    /// The variable that an l-value or a part of a variable stands in; `None` for values of their own.
    pub fn root_variable(&self, id: ExprId) -> Option<VarRef> {
        let mut at = id;
        loop {
            match &self.expr(at).kind {
                ExprKind::Var(var) => return Some(*var),
                ExprKind::Member(inner, _) | ExprKind::Index(inner, _) | ExprKind::Swizzle(inner, _) => at = *inner,
                _ => return None,
            }
        }
    }

    /// The global behind a handle of this shader.
    pub fn global(&self, id: GlobalId) -> &Global {
        &self.globals[id.index()]
    }

    /// The function behind a handle of this shader.
    pub fn function(&self, id: FunctionId) -> &Function {
        &self.functions[id.index()]
    }

    /// All globals with their handles.
    pub fn globals(&self) -> impl Iterator<Item = (GlobalId, &Global)> {
        self.globals.iter().enumerate().map(|(index, global)| (GlobalId::new(index), global))
    }

    /// All functions with their handles.
    pub fn functions(&self) -> impl Iterator<Item = (FunctionId, &Function)> {
        self.functions.iter().enumerate().map(|(index, function)| (FunctionId::new(index), function))
    }

    /// Runs a recursive walk over this shader's expressions with enough stack for the deepest of them: here if they
    /// are shallow, else on a thread of its own. Legal chains are up to 16,384 operators long.
    pub fn on_stack<R: Send>(&self, walk: impl FnOnce() -> R + Send) -> R {
        crate::stack::with_stack(self.expr_depth, walk)
    }
}
