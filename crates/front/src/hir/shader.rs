//! [`Shader`]: one stage and everything at global scope.

use super::{Expr, ExprId, ExprKind, FunctionId, GlobalId, LocalId, Precise, Stmt, Type, TypeId, Types, Value, VarRef};
use crate::builtin::BuiltinVariable;
use crate::language::{Interpolation, ParamMode, Precision, Sampling, Stage, Storage, Version};
use crate::source::{FileId, Inclusion, Span};
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// The layout of a uniform block (§4.3.8.3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum BlockLayout {
    #[default]
    Shared,
    Packed,
    Std140,
}

/// The properties of a global that is an interface block. Its type is a struct or an array of structs.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct BlockInfo {
    /// The name after `uniform`, `in` or `out`, by which blocks are matched.
    pub name: String,
    /// The instance name. Without one, the members are global names.
    pub instance: Option<String>,
    /// The layout, for uniform blocks.
    pub layout: BlockLayout,
    /// `layout(binding = n)` (ARB_shading_language_420pack).
    pub binding: Option<u32>,
}

/// A variable at global scope, declared or built in.
#[derive(Clone, Debug, Hash)]
pub struct Global {
    /// The name; for a block without an instance name, the block's name.
    pub name: String,
    /// The type.
    pub ty: TypeId,
    /// The storage.
    pub storage: Storage,
    /// The built-in variable, if it is one.
    pub builtin: Option<BuiltinVariable>,
    /// The interpolation, for `in` and `out` between stages.
    pub interpolation: Interpolation,
    /// Whether the interpolation qualifier is explicit.
    pub interpolation_written: bool,
    /// `centroid` or `sample`, for `in` and `out` between stages.
    pub sampling: Sampling,
    /// `invariant`
    pub invariant: bool,
    /// `layout(location = n)` (ARB_explicit_attrib_location).
    pub location: Option<u32>,
    /// `layout(location = n)` of a uniform, by which a host of OpenGL names it (GLSL 4.30 §4.4.3). No target has it.
    pub host_location: Option<u32>,
    /// `layout(component = n)` of a varying (GLSL 4.40 §4.4.1).
    pub component: Option<u32>,
    /// `layout(index = n)` (ARB_explicit_attrib_location).
    pub index: Option<u32>,
    /// `layout(binding = n)` of a sampler (ARB_shading_language_420pack).
    pub binding: Option<u32>,
    /// The block, if it is one.
    pub block: Option<BlockInfo>,
    /// The initializer of a constant, uniform or private variable, converted to the global's type.
    pub initializer: Option<ExprId>,
    /// The value of a constant or of a uniform's initializer.
    pub value: Option<Value>,
    /// Whether the size of its array follows only from its uses (§4.1.9).
    pub implicitly_sized: bool,
    /// Whether a function that `main` can reach uses it, or the initializer of such a global does ("static use").
    pub used: bool,
    /// Whether such a function assigns to it.
    pub written: bool,
    /// The name in the declaration; unknown for a built-in variable that is not redeclared.
    pub span: Span,
}

impl Global {
    /// The name by which a variable or block of one stage matches that of another.
    pub fn match_name(&self) -> &str {
        let own = self.block.as_ref().map_or(&self.name, |block| &block.name);
        match (self.storage, own.as_str()) {
            // The fragment stage reads the front color under another name (§7.2).
            (Storage::In, "gl_Color") => "gl_FrontColor",
            (Storage::In, "gl_SecondaryColor") => "gl_FrontSecondaryColor",
            (_, own) => own,
        }
    }
}

impl Global {
    /// Whether it is a variable of the fixed-function pipeline (`gl_Vertex`), which texts name and do not declare.
    pub fn is_fixed(&self) -> bool {
        self.builtin.is_none() && self.block.is_none() && self.name.starts_with("gl_")
    }

    /// The texture unit or buffer binding point that `layout(binding = n)` selects.
    pub fn unit(&self) -> Option<u32> {
        self.block.as_ref().map_or(self.binding, |block| block.binding)
    }
}

/// The kind of a local.
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
#[derive(Clone, Debug, Hash)]
pub struct Local {
    /// The name; empty for an unnamed parameter.
    pub name: String,
    /// The type.
    pub ty: TypeId,
    /// The kind.
    pub kind: LocalKind,
    /// The value of a constant.
    pub value: Option<Value>,
    /// The name in the declaration.
    pub span: Span,
}

/// A function (§6.1).
#[derive(Clone, Debug, Hash)]
pub struct Function {
    /// The name, which overloads share.
    pub name: String,
    /// The return type.
    pub ret: TypeId,
    /// The number of parameters, which come first among the locals.
    pub param_count: usize,
    /// The locals: parameters first, then variables in order of declaration.
    pub locals: Vec<Local>,
    /// The body; `None` if there is only a prototype.
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

    /// How a parameter is passed; `In` for an index past the last.
    pub fn param_mode(&self, index: usize) -> ParamMode {
        match self.params().get(index).map(|local| local.kind) {
            Some(LocalKind::Param(mode)) => mode,
            _ => ParamMode::In,
        }
    }

    /// The types of the parameters, and how they are passed.
    pub fn param_types(&self) -> impl Iterator<Item = (TypeId, ParamMode)> {
        self.params().iter().map(|param| match param.kind {
            LocalKind::Param(mode) => (param.ty, mode),
            LocalKind::Variable | LocalKind::Const => (param.ty, ParamMode::In),
        })
    }

    /// The local of a handle of this function.
    pub fn local(&self, id: LocalId) -> &Local {
        // A `LocalId` is only made for this function.
        &self.locals[id.index()]
    }
}

/// The input primitive of a geometry shader: `layout(points) in;` and so on (§4.3.8.1).
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
    /// The number of vertices of one primitive, which is the size of the input arrays.
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

/// The output primitive of a geometry shader: `layout(line_strip) out;` and so on (§4.3.8.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum PrimitiveOut {
    Points,
    LineStrip,
    TriangleStrip,
}

/// The layouts that a geometry shader declares.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct GeometryLayout {
    /// The input primitive.
    pub input: Option<PrimitiveIn>,
    /// The output primitive.
    pub output: Option<PrimitiveOut>,
    /// The largest number of vertices that it emits.
    pub max_vertices: Option<u32>,
    /// How often it runs for each primitive (GLSL 4.00 §4.3.8.1); once if the layout does not say.
    pub invocations: Option<u32>,
}

/// The redeclaration of `gl_FragCoord` in a fragment shader (§4.3.8.1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FragCoordLayout {
    /// `layout(origin_upper_left)`
    pub origin_upper_left: bool,
    /// `layout(pixel_center_integer)`
    pub pixel_center_integer: bool,
}

/// The redeclaration `out gl_PerVertex { .. };`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct PerVertexOut {
    /// The members of the redeclared block, in order.
    pub members: Vec<String>,
    /// The block's name in the declaration.
    pub span: Span,
}

/// `DEPTH_TEXTURE_MODE` of the host: how the result r of `shadow2D` and its like becomes four components (OpenGL 2.1 table
/// 3.20). Later functions return r alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthMode {
    /// (r, r, r, 1), the initial state.
    #[default]
    Luminance,
    /// (r, r, r, r)
    Intensity,
    /// (0, 0, 0, r)
    Alpha,
    /// (r, 0, 0, 1), of OpenGL 3.0.
    Red,
}

impl DepthMode {
    /// The four components, from the result, 0 and 1.
    pub fn components<T: Copy>(self, r: T, zero: T, one: T) -> [T; 4] {
        match self {
            Self::Luminance => [r, r, r, one],
            Self::Intensity => [r; 4],
            Self::Alpha => [zero, zero, zero, r],
            Self::Red => [r, zero, zero, one],
        }
    }
}

/// The text that a shader was made from, for who looks at the text itself.
#[derive(Clone, Debug, Default)]
pub struct Origin {
    /// Its own file; none for a shader that was not compiled from text.
    pub file: Option<FileId>,
    /// The files that were included, in reading order.
    pub inclusions: Vec<Inclusion>,
    /// The comments `// glisten: allow(CODE, ..)` in text that is not skipped, each with its codes.
    pub allows: Vec<(Span, Vec<String>)>,
}

/// One stage.
#[derive(Clone, Debug)]
pub struct Shader {
    /// Which stage.
    pub stage: Stage,
    /// The version that it is written in.
    pub version: Version,
    /// All expressions of all functions and initializers.
    pub exprs: Vec<Expr>,
    /// All declared globals, and the built-in variables in use.
    pub globals: Vec<Global>,
    /// All functions that are declared or defined. A prototype and its definition are one function.
    pub functions: Vec<Function>,
    /// `main`, if it is defined.
    pub main: Option<FunctionId>,
    /// The layouts of a geometry shader.
    pub geometry: GeometryLayout,
    /// The layout of `gl_FragCoord` in a fragment shader.
    pub frag_coord: FragCoordLayout,
    /// The redeclared built-in outputs of a vertex or geometry shader.
    pub per_vertex_out: Option<PerVertexOut>,
    /// The declarations that are `precise`.
    pub precise: Precise,
    /// The size that the shader gives `gl_TexCoord` by declaring it again (GLSL 1.20 §7.6).
    pub tex_coords: Option<u32>,
    /// In ES, the precisions of the uniforms, of the members of their structs as `uniform.member`, and of those of uniform blocks
    /// as `Block.member`, with the declaration of each.
    pub precisions: Vec<(String, Precision, Span)>,
    /// How the result of a comparison becomes four components.
    pub depth_mode: DepthMode,
    /// Whether an engine makes outputs of `gl_FragColor` and `gl_FragData`, so that declared ones may stand next to them.
    pub mixes_outputs: bool,
    /// How deep a traversal recurses: the depth of the deepest expression, counted along left operands too, and that of the
    /// statements. More than a few hundred levels need a large stack (see [`Shader::on_stack`]).
    pub depth: u32,
    /// The text for an OpenGL driver, one for each source ([`whole_text`](crate::source::whole_text)); empty for a
    /// shader that was not compiled from text.
    pub texts: Vec<Arc<str>>,
    /// The text that it was made from.
    pub origin: Origin,
}

impl Shader {
    /// The stage without globals, functions and expressions, for a pass that rebuilds them.
    #[must_use]
    pub fn emptied(&self) -> Self {
        Self {
            stage: self.stage,
            version: self.version,
            exprs: Vec::new(),
            globals: Vec::new(),
            functions: Vec::new(),
            main: None,
            geometry: self.geometry,
            frag_coord: self.frag_coord,
            per_vertex_out: self.per_vertex_out.clone(),
            precise: self.precise.clone(),
            tex_coords: self.tex_coords,
            precisions: self.precisions.clone(),
            depth_mode: self.depth_mode,
            mixes_outputs: self.mixes_outputs,
            depth: self.depth,
            texts: self.texts.clone(),
            origin: self.origin.clone(),
        }
    }
}

/// The hash of all that the shader means: everything but its texts and where they come from, and precisions, which
/// have no effect.
impl Hash for Shader {
    fn hash<H: Hasher>(&self, state: &mut H) {
        // Without `..`, so that no field can be forgotten.
        let Self {
            stage,
            version,
            exprs,
            globals,
            functions,
            main,
            geometry,
            frag_coord,
            per_vertex_out,
            precise,
            tex_coords,
            precisions: _,
            depth_mode,
            mixes_outputs,
            depth,
            texts: _,
            origin: _,
        } = self;
        (stage, version, exprs, globals, functions, main, geometry, frag_coord).hash(state);
        (per_vertex_out, precise, tex_coords, depth_mode, mixes_outputs, depth).hash(state);
    }
}

impl Shader {
    /// Where to report what concerns the whole shader: the `#version` line, or else anything with a position.
    pub fn anchor(&self) -> Span {
        let globals = self.globals.iter().map(|global| global.span);
        let functions = self.functions.iter().map(|function| function.span);
        [self.version.span].into_iter().chain(functions).chain(globals).find(|span| span.is_known()).unwrap_or_default()
    }

    /// Whether a varying is evaluated at each sample (GLSL 4.00 §4.3.4).
    pub fn evaluates_samples(&self, types: &Types) -> bool {
        let varyings = self.globals.iter().filter(|global| matches!(global.storage, Storage::In | Storage::Out));
        varyings.into_iter().any(|global| {
            let element = types.element(global.ty).filter(|_| global.block.is_some()).unwrap_or(global.ty);
            let members = match types.get(element) {
                Type::Struct(id) if global.block.is_some() => types.structure(id).members.as_slice(),
                _ => &[],
            };
            global.sampling == Sampling::Sample || members.iter().any(|member| member.sampling == Sampling::Sample)
        })
    }

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
            precise: Precise::default(),
            tex_coords: None,
            precisions: Vec::new(),
            depth_mode: DepthMode::default(),
            mixes_outputs: false,
            depth: 0,
            texts: Vec::new(),
            origin: Origin::default(),
        }
    }

    /// Adds an expression.
    pub fn push(&mut self, kind: ExprKind, ty: TypeId, span: Span) -> ExprId {
        let id = ExprId(self.exprs.len() as u32);
        self.exprs.push(Expr { kind, ty, span });
        id
    }

    /// The expression with exactly this span; the outermost one, if several have it, such as a conversion and its operand.
    pub fn expr_at(&self, span: Span) -> Option<ExprId> {
        let index = self.exprs.iter().rposition(|expr| expr.span == span)?;
        Some(ExprId(index as u32))
    }

    /// The handles of all expressions that there are now, operands before the expressions that have them.
    pub fn expr_ids(&self) -> impl Iterator<Item = ExprId> + use<> {
        (0..self.exprs.len() as u32).map(ExprId)
    }

    /// The expression of a handle of this shader.
    pub fn expr(&self, id: ExprId) -> &Expr {
        // Only `push` of this shader makes an `ExprId`.
        &self.exprs[id.index()]
    }

    /// The operands of an expression.
    pub fn children(&self, id: ExprId) -> smallvec::SmallVec<[ExprId; 4]> {
        self.expr(id).kind.children()
    }

    /// The variable that an l-value or a part of a variable belongs to; `None` for other values.
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

    /// The indices on the way to a part of a variable, the last one first.
    pub fn indices_of_place(&self, place: ExprId) -> Vec<ExprId> {
        let (mut found, mut at) = (Vec::new(), place);
        loop {
            match &self.expr(at).kind {
                ExprKind::Index(inner, index) => {
                    found.push(*index);
                    at = *inner;
                }
                ExprKind::Member(inner, _) | ExprKind::Swizzle(inner, _) => at = *inner,
                _ => return found,
            }
        }
    }

    /// The global of a handle of this shader.
    pub fn global(&self, id: GlobalId) -> &Global {
        &self.globals[id.index()]
    }

    /// The function of a handle of this shader.
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

    /// Runs a recursive traversal of this shader's expressions or statements with enough stack for the deepest of them. Valid
    /// chains have up to 16,384 operators.
    pub fn on_stack<R>(&self, walk: impl FnOnce() -> R) -> R {
        crate::stack::with_stack(self.depth, walk)
    }
}
