//! [`pass_through`]: the program that draws what a geometry stage emitted.
//!
//! *In:* a program with a geometry stage. *Out:* a program with its fragment stage, and a vertex stage with the outputs of
//! the geometry stage, each assigned from an attribute; and what each attribute is. *Holds:* `gl_PrimitiveID` of the
//! fragment stage becomes a flat varying. `gl_Layer` is dropped, since it has no effect.

use glisten_front::builtin::BuiltinVariable;
use glisten_front::diagnostic::codes::scenes::SCENE_CANNOT_DRAW;
use glisten_front::diagnostic::{Diagnostic, Diagnostics};
use glisten_front::hir::{
    ExprId, ExprKind, Function, FunctionId, Global, GlobalId, Interpolation, Sampling, Scalar, ScalarValue, Shader,
    Stage, Stmt, StmtKind, Storage, Type, TypeId, Types, VarRef,
};
use glisten_front::link::{Bindings, FixedState, Program, link};
use glisten_front::source::Span;
use rustc_hash::FxHashMap;

/// The varying that carries `gl_PrimitiveID`.
const ID: &str = "emitted_primitive_id";

/// Where the numbers of an attribute come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    Position,
    PointSize,
    ClipDistance(u32),
    PrimitiveId,
    /// A scalar of an output of the geometry stage, and those after it.
    Output(GlobalId, u32),
}

/// An attribute of the new vertex stage.
#[derive(Clone, Debug)]
pub(crate) struct Attribute {
    pub(crate) name: String,
    pub(crate) scalar: Scalar,
    pub(crate) size: u32,
    pub(crate) source: Source,
}

/// The vertex stage under construction.
struct Builder<'a> {
    types: &'a mut Types,
    shader: Shader,
    /// The outputs of the geometry stage, by their old handles.
    outputs: FxHashMap<GlobalId, GlobalId>,
    attributes: Vec<Attribute>,
    body: Vec<Stmt>,
}

/// The program with a vertex stage in place of the vertex and geometry stages. So many clip distances are enabled.
pub(crate) fn pass_through(
    program: &Program,
    clip_distances: u32,
) -> Result<(Program, Vec<Attribute>), Vec<Diagnostic>> {
    let (Some(geometry), Some(fragment)) = (program.stage(Stage::Geometry), program.stage(Stage::Fragment)) else {
        return Err(cannot(program, "a stage is missing"));
    };
    let mut types = program.types.clone();
    let mut builder = Builder {
        types: &mut types,
        shader: Shader::new(Stage::Vertex, geometry.version),
        outputs: FxHashMap::default(),
        attributes: Vec::new(),
        body: Vec::new(),
    };
    builder.declare(geometry);
    builder.assign_all(program, geometry, clip_distances);
    let mut fragment = fragment.clone();
    if builder.carry_id(&mut fragment).is_none() {
        return Err(cannot(program, "`gl_PrimitiveID` has no place"));
    }
    let (shader, attributes) = builder.finish();
    let outputs = program.interface.outputs.iter().filter(|output| !output.name.starts_with("gl_"));
    let colors: Vec<(String, u32)> = outputs.map(|output| (output.name.clone(), output.location)).collect();
    // The stages have the statements of the fixed-function state already.
    let fixed = FixedState { unclamped_colors: true, ..FixedState::default() };
    let bindings = Bindings { attribute_locations: &[], frag_data_locations: &colors, fixed, ..Bindings::default() };
    let mut found = Diagnostics::default();
    match link(program.name.clone(), types, vec![shader, fragment], bindings, &mut found) {
        Some(program) => Ok((program, attributes)),
        None => {
            let why = found.into_iter().find(Diagnostic::is_error).map_or_else(String::new, |error| error.message);
            Err(cannot(program, &why))
        }
    }
}

impl Builder<'_> {
    /// Declares the outputs of the geometry stage.
    fn declare(&mut self, geometry: &Shader) {
        for (id, global) in geometry.globals().filter(|(_, global)| global.storage == Storage::Out) {
            let dropped = [BuiltinVariable::Layer, BuiltinVariable::PrimitiveId].map(Some).contains(&global.builtin);
            if !dropped {
                let own = Global { initializer: None, written: true, used: true, ..global.clone() };
                let place = self.push_global(own);
                self.outputs.insert(id, place);
            }
        }
    }

    fn assign_all(&mut self, program: &Program, geometry: &Shader, clip_distances: u32) {
        for varying in program.interface.interpolated().filter(|varying| varying.active) {
            let Some(from) = varying.from else { continue };
            self.assign(from.global, from.flat_offset, varying.ty, Source::Output(from.global, from.flat_offset));
        }
        let read: Vec<u32> = program
            .interface
            .clip_distances
            .iter()
            .filter(|one| one.active)
            .flat_map(|one| {
                let first = one.from.map_or(0, |from| from.flat_offset);
                first..first + program.types.flat_len(one.ty)
            })
            .collect();
        for (id, global) in geometry.globals().filter(|(_, global)| global.storage == Storage::Out) {
            match global.builtin {
                Some(BuiltinVariable::Position) => self.assign(id, 0, TypeId::VEC4, Source::Position),
                Some(BuiltinVariable::PointSize) => self.assign(id, 0, TypeId::FLOAT, Source::PointSize),
                Some(BuiltinVariable::ClipDistance) => {
                    for index in (0..clip_distances).filter(|index| !read.contains(index)) {
                        self.assign(id, index, TypeId::FLOAT, Source::ClipDistance(index));
                    }
                }
                _ => {}
            }
        }
    }

    /// Assigns a part of an output from an attribute of its own.
    fn assign(&mut self, output: GlobalId, flat: u32, ty: TypeId, source: Source) {
        let Some(&global) = self.outputs.get(&output) else { return };
        let Some(place) = self.place(global, flat, ty) else { return };
        self.assign_place(place, ty, source);
    }

    fn assign_place(&mut self, place: ExprId, ty: TypeId, source: Source) {
        let Some(scalar) = self.types.scalar_of(ty) else { return };
        let name = format!("emitted_{}", self.attributes.len());
        let size = self.types.flat_len(ty);
        let input = self.push_global(variable(&name, ty, Storage::In));
        self.attributes.push(Attribute { name, scalar, size, source });
        let value = self.shader.push(ExprKind::Var(VarRef::Global(input)), ty, Span::default());
        let assignment = self.shader.push(ExprKind::Assign(None, place, value), ty, Span::default());
        self.body.push(Stmt { kind: StmtKind::Expr(assignment), span: Span::default() });
    }

    /// The part of a variable that begins at a scalar and has a type.
    fn place(&mut self, global: GlobalId, flat: u32, wanted: TypeId) -> Option<ExprId> {
        let mut ty = self.shader.global(global).ty;
        let mut place = self.shader.push(ExprKind::Var(VarRef::Global(global)), ty, Span::default());
        let mut rest = flat;
        while ty != wanted || rest != 0 {
            let element = match self.types.get(ty) {
                Type::Struct(id) => {
                    let members = &self.types.structure(id).members;
                    let sizes = members.iter().map(|member| self.types.flat_len(member.ty));
                    let (index, before) = (0..).zip(ends(sizes)).find(|(_, range)| range.contains(&rest))?;
                    rest -= before.start;
                    ty = members.get(index as usize)?.ty;
                    ExprKind::Member(place, index)
                }
                Type::Array(..) | Type::Matrix(..) | Type::Vector(..) => {
                    ty = self.types.element(ty)?;
                    let size = self.types.flat_len(ty).max(1);
                    let index = ExprKind::Literal(ScalarValue::Int((rest / size) as i32));
                    let index = self.shader.push(index, TypeId::INT, Span::default());
                    rest %= size;
                    ExprKind::Index(place, index)
                }
                Type::Error | Type::Void | Type::Scalar(_) | Type::Sampler(_) => return None,
            };
            place = self.shader.push(element, ty, Span::default());
        }
        Some(place)
    }

    /// Turns `gl_PrimitiveID` of the fragment stage into a varying.
    fn carry_id(&mut self, fragment: &mut Shader) -> Option<()> {
        let is_id = |global: &&mut Global| global.builtin == Some(BuiltinVariable::PrimitiveId);
        let Some(input) = fragment.globals.iter_mut().find(is_id) else { return Some(()) };
        let used = input.used;
        *input = Global { used, ..variable(ID, TypeId::INT, Storage::In) };
        let output = self.push_global(variable(ID, TypeId::INT, Storage::Out));
        let place = self.place(output, 0, TypeId::INT)?;
        self.assign_place(place, TypeId::INT, Source::PrimitiveId);
        Some(())
    }

    fn push_global(&mut self, global: Global) -> GlobalId {
        self.shader.globals.push(global);
        GlobalId::new(self.shader.globals.len() - 1)
    }

    fn finish(mut self) -> (Shader, Vec<Attribute>) {
        self.shader.functions.push(Function {
            name: "main".into(),
            ret: TypeId::VOID,
            param_count: 0,
            locals: Vec::new(),
            body: Some(self.body),
            reachable: true,
            span: Span::default(),
        });
        self.shader.main = Some(FunctionId::new(0));
        self.shader.depth = 64;
        (self.shader, self.attributes)
    }
}

/// The ranges that parts of these sizes take, one after the other.
fn ends(sizes: impl Iterator<Item = u32>) -> impl Iterator<Item = std::ops::Range<u32>> {
    sizes.scan(0, |start, size| {
        let range = *start..*start + size;
        *start = range.end;
        Some(range)
    })
}

/// A flat variable of a shader.
fn variable(name: &str, ty: TypeId, storage: Storage) -> Global {
    Global {
        name: name.into(),
        ty,
        storage,
        builtin: None,
        interpolation: Interpolation::Flat,
        interpolation_written: true,
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
        written: storage == Storage::Out,
        span: Span::default(),
    }
}

/// An error that has no place in the text.
fn cannot(program: &Program, why: &str) -> Vec<Diagnostic> {
    let message = format!("the geometry stage of `{}` cannot be replaced by what it emits: {why}", program.name);
    vec![Diagnostic::new(&SCENE_CANNOT_DRAW, Span::default(), message)]
}
