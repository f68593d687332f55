//! Merges several shaders of one stage into one (OpenGL 3.2 §2.11.2; GLSL 1.50 §4.2.6, §6.1).
//!
//! Globals of one name are one variable and must agree in type and qualifiers. A function that one shader declares is
//! the one that another defines. The handles of later shaders are moved after those of the first. What depends on the
//! whole stage is computed again at the end: static use, and the sizes of a geometry shader's inputs.

use super::compatible::same_value;
use super::remap::Remap;
use crate::builtin::BuiltinVariable;
use crate::diagnostic::{Diagnostic, codes};
use crate::fold;
use crate::hir::{
    ArraySize, Function, FunctionId, Global, GlobalId, LocalKind, Member, Shader, Stage, Storage, Type, TypeId, Types,
};
use rustc_hash::FxHashMap;
use std::hash::Hash;

/// The one shader that forms a stage; `None` if there is none.
pub(super) fn merge(types: &mut Types, shaders: Vec<Shader>, found: &mut Vec<Diagnostic>) -> Option<Shader> {
    check_frag_coord(&shaders, found);
    super::per_vertex::check_stage(&shaders, found);
    let mut shaders = shaders.into_iter();
    let mut all = shaders.next()?;
    let mut merged = false;
    for next in shaders {
        merged = true;
        Merge { types, all: &mut all, found }.absorb(next);
    }
    if merged {
        if all.stage == Stage::Geometry {
            super::geometry::size_inputs(types, &mut all, found);
        }
        all.mark_static_use();
    }
    Some(all)
}

/// Checks that, if one shader redeclares `gl_FragCoord`, all that use it do so in the same way (§4.3.8.1).
fn check_frag_coord(shaders: &[Shader], found: &mut Vec<Diagnostic>) {
    let is_frag_coord = |global: &&Global| global.builtin == Some(BuiltinVariable::FragCoord);
    let users: Vec<(&Shader, &Global)> =
        shaders.iter().filter_map(|shader| Some((shader, shader.globals.iter().find(is_frag_coord)?))).collect();
    let Some(&(first, declared)) = users.iter().find(|(_, global)| global.span.is_known()) else { return };
    for (shader, global) in users {
        if global.span.is_known() && shader.frag_coord == first.frag_coord {
            continue;
        }
        let span = if global.span.is_known() { global.span } else { shader.anchor() };
        let message = "the fragment shaders of the program do not declare `gl_FragCoord` alike";
        let finding = Diagnostic::new(&codes::link::FRAG_COORD_CONFLICT, span, message);
        found.push(finding.label(declared.span, "declared here"));
    }
}

/// The identity of a global: for a built-in variable which one it is, for all others the name. Blocks of one name are
/// different if one is `in` and the other `out`: "a block name is allowed to have different definitions in different
/// interfaces" (§4.3.7).
#[derive(PartialEq, Eq, Hash)]
enum GlobalKey {
    Builtin(BuiltinVariable, Storage),
    Block(String, Storage),
    Variable(String),
}

fn global_key(global: &Global) -> GlobalKey {
    match (global.builtin, &global.block) {
        (Some(builtin), _) => GlobalKey::Builtin(builtin, global.storage),
        (None, Some(block)) => GlobalKey::Block(block.name.clone(), global.storage),
        (None, None) => GlobalKey::Variable(global.name.clone()),
    }
}

/// The identity of a function.
type FunctionKey = (String, Vec<TypeId>);

fn function_key(function: &Function) -> FunctionKey {
    (function.name.clone(), function.params().iter().map(|param| param.ty).collect())
}

/// The first handle of each key.
fn first_places<K: Eq + Hash, Id>(list: impl Iterator<Item = (K, Id)>) -> FxHashMap<K, Id> {
    let mut places = FxHashMap::default();
    for (key, id) in list {
        places.entry(key).or_insert(id);
    }
    places
}

struct Merge<'a> {
    types: &'a mut Types,
    all: &'a mut Shader,
    found: &'a mut Vec<Diagnostic>,
}

impl Merge<'_> {
    fn absorb(&mut self, next: Shader) {
        let mut globals = first_places(self.all.globals().map(|(id, global)| (global_key(global), id)));
        let mut functions = first_places(self.all.functions().map(|(id, function)| (function_key(function), id)));
        let remap = Remap {
            exprs: self.all.exprs.len() as u32,
            globals: next.globals.iter().map(|global| self.place_of_global(&mut globals, global)).collect(),
            functions: next.functions.iter().map(|function| self.place_of_function(&mut functions, function)).collect(),
        };
        self.all.exprs.extend(next.exprs.into_iter().map(|expr| remap.expr(expr)));
        for (index, mut global) in next.globals.into_iter().enumerate() {
            global.initializer = global.initializer.map(|expr| remap.expr_id(expr));
            if let Some(place) = remap.globals.get(index) {
                self.unite_global(*place, global);
            }
        }
        for (index, mut function) in next.functions.into_iter().enumerate() {
            if let Some(body) = &mut function.body {
                remap.body(body);
            }
            if let Some(place) = remap.functions.get(index) {
                self.unite_function(*place, function);
            }
        }
        self.all.per_vertex_out = self.all.per_vertex_out.take().or(next.per_vertex_out);
        self.all.texts.extend(next.texts);
        self.all.tex_coords = self.all.tex_coords.max(next.tex_coords);
        self.all.precise.join(&next.precise);
        self.all.depth = self.all.depth.max(next.depth);
        self.all.main = self.all.main.or(next.main.map(|main| remap.function_id(main)));
        self.unite_layouts(next.geometry, next.frag_coord);
        self.retype_variables();
    }

    /// The handle of a later shader's global in the merged shader; a new one if it is not there yet.
    fn place_of_global(&mut self, known: &mut FxHashMap<GlobalKey, GlobalId>, global: &Global) -> GlobalId {
        let next = GlobalId::new(self.all.globals.len());
        let place = *known.entry(global_key(global)).or_insert(next);
        if place == next {
            // A placeholder without an initializer, which `unite_global` replaces.
            self.all.globals.push(Global { initializer: None, ..global.clone() });
        }
        place
    }

    fn place_of_function(&mut self, known: &mut FxHashMap<FunctionKey, FunctionId>, function: &Function) -> FunctionId {
        let next = FunctionId::new(self.all.functions.len());
        let place = *known.entry(function_key(function)).or_insert(next);
        if place == next {
            self.all.functions.push(Function { body: None, ..function.clone() });
        }
        place
    }

    fn unite_global(&mut self, place: GlobalId, global: Global) {
        let Some(known) = self.all.globals.get(place.index()) else { return };
        let problem = global_problem(self.types, known, &global).or_else(|| self.initializer_problem(known, &global));
        if let Some(problem) = problem {
            self.found.push(problem);
            return;
        }
        let (ty, implicitly_sized) = united_type(self.types, known, &global);
        let Some(known) = self.all.globals.get_mut(place.index()) else { return };
        (known.ty, known.implicitly_sized) = (ty, implicitly_sized);
        if known.value.is_none() && known.initializer.is_none() {
            (known.initializer, known.value) = (global.initializer, global.value);
        }
        if !known.span.is_known() {
            known.span = global.span;
        }
        known.location = known.location.or(global.location);
        known.index = known.index.or(global.index);
        known.binding = known.binding.or(global.binding);
        if let (Some(known), Some(other)) = (&mut known.block, &global.block) {
            known.binding = known.binding.or(other.binding);
        }
    }

    /// Several initializers of a global variable must be constant expressions of the same value (§4.3).
    fn initializer_problem(&self, known: &Global, other: &Global) -> Option<Diagnostic> {
        let (Some(first), Some(second)) = (known.initializer, other.initializer) else { return None };
        if known.storage != Storage::Private {
            return None;
        }
        let value = |expr| fold::evaluate(self.all, self.types, expr, &|_| None);
        if let (Some(first), Some(second)) = (value(first), value(second))
            && same_value(&first, &second)
        {
            return None;
        }
        let message = format!("several shaders of one stage initialize `{}`", known.match_name());
        let help = "leave all initializers but one out, or make them the same constant expression";
        let finding = Diagnostic::new(&codes::link::SHARED_GLOBAL_MISMATCH, other.span, message);
        Some(finding.label(known.span, "and here").help(help))
    }

    fn unite_function(&mut self, place: FunctionId, function: Function) {
        let Some(known) = self.all.functions.get_mut(place.index()) else { return };
        if let Some(problem) = function_problem(known, &function) {
            self.found.push(problem);
            // There is a definition, if of another function.
            if function.body.is_some() {
                known.body.get_or_insert_default();
            }
            return;
        }
        if known.body.is_none() && function.body.is_some() {
            *known = function;
        }
    }

    fn unite_layouts(&mut self, geometry: crate::hir::GeometryLayout, frag_coord: crate::hir::FragCoordLayout) {
        let anchor = self.all.anchor();
        let known = &mut self.all.geometry;
        let input = (known.input, geometry.input);
        let output = (known.output, geometry.output);
        let vertices = (known.max_vertices, geometry.max_vertices);
        let invocations = (known.invocations, geometry.invocations);
        let differ = [
            (matches!(invocations, (Some(a), Some(b)) if a != b), "values of `invocations`"),
            (matches!(input, (Some(a), Some(b)) if a != b), "input primitives"),
            (matches!(output, (Some(a), Some(b)) if a != b), "output primitives"),
            (matches!(vertices, (Some(a), Some(b)) if a != b), "values of `max_vertices`"),
        ];
        for (_, what) in differ.into_iter().filter(|(differ, _)| *differ) {
            let message = format!("the geometry shaders of the program declare different {what}");
            self.found.push(Diagnostic::new(&codes::link::GEOMETRY_LAYOUT_CONFLICT, anchor, message));
        }
        known.input = known.input.or(geometry.input);
        known.output = known.output.or(geometry.output);
        known.max_vertices = known.max_vertices.or(geometry.max_vertices);
        known.invocations = known.invocations.or(geometry.invocations);
        let known = &mut self.all.frag_coord;
        known.origin_upper_left |= frag_coord.origin_upper_left;
        known.pixel_center_integer |= frag_coord.pixel_center_integer;
    }

    /// Updates the types of expressions that refer to globals, whose sizes may have changed.
    fn retype_variables(&mut self) {
        super::remap::retype_globals(self.types, self.all);
    }
}

/// Why two declarations cannot be one variable.
fn global_problem(types: &Types, known: &Global, other: &Global) -> Option<Diagnostic> {
    let name = known.match_name();
    let problem = |what: String| {
        let message = format!("the shaders of one stage declare `{name}` with different {what}");
        Some(Diagnostic::new(&codes::link::SHARED_GLOBAL_MISMATCH, other.span, message).label(known.span, "and here"))
    };
    if known.storage != other.storage {
        return problem("storage qualifiers".into());
    }
    if !types_agree(types, known, other) && known.block.is_some() {
        return problem("members or array sizes".into());
    }
    if !types_agree(types, known, other) {
        return problem(format!("types, `{}` and `{}`", types.name(known.ty), types.name(other.ty)));
    }
    let interpolation = |global: &Global| (global.interpolation_written, global.interpolation, global.sampling);
    if known.builtin.is_none() && known.storage != Storage::Private && interpolation(known) != interpolation(other) {
        return problem("interpolation qualifiers".into());
    }
    if known.invariant != other.invariant && known.builtin.is_none() {
        return problem("invariance".into());
    }
    let differs = |a: Option<u32>, b: Option<u32>| matches!((a, b), (Some(a), Some(b)) if a != b);
    if differs(known.location, other.location) || differs(known.index, other.index) {
        return problem("locations".into());
    }
    if differs(known.unit(), other.unit()) {
        return problem("bindings".into());
    }
    if let (Some(a), Some(b)) = (&known.block, &other.block)
        && (a.layout != b.layout || a.instance.is_some() != b.instance.is_some())
    {
        return problem("layouts or instance names".into());
    }
    match (&known.value, &other.value) {
        (Some(a), Some(b)) if !same_value(a, b) => problem("initializers".into()),
        _ => None,
    }
}

/// The size of an array as one shader declares it.
#[derive(Clone, Copy)]
struct ArrayExtent {
    element: TypeId,
    size: Option<u32>,
    /// Whether the size follows only from the uses.
    implicit: bool,
}

impl ArrayExtent {
    fn new(types: &Types, ty: TypeId, implicit: bool) -> Option<Self> {
        match types.get(ty) {
            Type::Array(element, ArraySize::Sized(size)) => Some(Self { element, size: Some(size), implicit }),
            Type::Array(element, ArraySize::Unsized) => Some(Self { element, size: None, implicit }),
            _ => None,
        }
    }

    /// Whether at most one size is explicit and covers the uses of the other.
    fn fits(self, other: Self) -> bool {
        match (self.size, self.implicit, other.size, other.implicit) {
            (None, ..) | (_, _, None, _) | (_, true, _, true) => true,
            (Some(a), false, Some(b), true) => b <= a,
            (Some(a), true, Some(b), false) => a <= b,
            (Some(a), false, Some(b), false) => a == b,
        }
    }

    /// The common size, and whether it follows only from uses.
    fn united(self, other: Self) -> (ArraySize, bool) {
        let size = match (self.size, self.implicit, other.size, other.implicit) {
            (Some(a), false, _, _) => Some(a),
            (_, _, Some(b), false) => Some(b),
            (a, _, b, _) => a.max(b),
        };
        let explicit = (self.size.is_some() && !self.implicit) || (other.size.is_some() && !other.implicit);
        (size.map_or(ArraySize::Unsized, ArraySize::Sized), !explicit)
    }
}

/// Whether two types are equal except for array sizes, of which at most one is explicit and covers the uses of the
/// other. The arrays are the variables themselves, and the members of blocks.
fn types_agree(types: &Types, known: &Global, other: &Global) -> bool {
    if known.ty == other.ty {
        return true;
    }
    let arrays = (
        ArrayExtent::new(types, known.ty, known.implicitly_sized),
        ArrayExtent::new(types, other.ty, other.implicitly_sized),
    );
    let (a, b) = match arrays {
        (Some(a), Some(b)) if a.fits(b) => (a.element, b.element),
        (None, None) => (known.ty, other.ty),
        _ => return false,
    };
    a == b || (known.block.is_some() && blocks_agree(types, a, b))
}

fn blocks_agree(types: &Types, a: TypeId, b: TypeId) -> bool {
    let (Type::Struct(a), Type::Struct(b)) = (types.get(a), types.get(b)) else { return false };
    let (a, b) = (&types.structure(a).members, &types.structure(b).members);
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| members_agree(types, a, b))
}

fn members_agree(types: &Types, a: &Member, b: &Member) -> bool {
    let qualifiers =
        |member: &Member| (member.interpolation, member.sampling, member.invariant, member.matrix_layout, member.place);
    let sizes = (ArrayExtent::new(types, a.ty, a.implicitly_sized), ArrayExtent::new(types, b.ty, b.implicitly_sized));
    let same_type = match sizes {
        (Some(a), Some(b)) => a.element == b.element && a.fits(b),
        _ => a.ty == b.ty,
    };
    a.name == b.name && same_type && qualifiers(a) == qualifiers(b)
}

/// The type of a variable that two shaders declare, and whether its size follows only from uses.
fn united_type(types: &mut Types, known: &Global, other: &Global) -> (TypeId, bool) {
    let known_array = ArrayExtent::new(types, known.ty, known.implicitly_sized);
    let other_array = ArrayExtent::new(types, other.ty, other.implicitly_sized);
    let (Some(a), Some(b)) = (known_array, other_array) else {
        return (united_block(types, known.ty, other.ty), known.implicitly_sized);
    };
    let element = united_block(types, a.element, b.element);
    let (size, implicit) = a.united(b);
    (types.array(element, size), implicit)
}

/// The struct of a block, with array sizes that satisfy both shaders. Types other than blocks are returned unchanged.
fn united_block(types: &mut Types, known: TypeId, other: TypeId) -> TypeId {
    let (Type::Struct(a), Type::Struct(b)) = (types.get(known), types.get(other)) else { return known };
    if a == b {
        return known;
    }
    let mut united = types.structure(a).clone();
    let others = types.structure(b).members.clone();
    for (member, other) in united.members.iter_mut().zip(&others) {
        let arrays = (
            ArrayExtent::new(types, member.ty, member.implicitly_sized),
            ArrayExtent::new(types, other.ty, other.implicitly_sized),
        );
        if let (Some(a), Some(b)) = arrays {
            let (size, implicit) = a.united(b);
            (member.ty, member.implicitly_sized) = (types.array(a.element, size), implicit);
        }
    }
    types.add_struct(united)
}

/// Why two declarations cannot be one function.
fn function_problem(known: &Function, other: &Function) -> Option<Diagnostic> {
    let name = &known.name;
    let modes = |function: &Function| -> Vec<LocalKind> { function.params().iter().map(|param| param.kind).collect() };
    if known.ret != other.ret || modes(known) != modes(other) {
        let message =
            format!("the shaders of one stage declare `{name}` with different results or parameter qualifiers");
        let finding = Diagnostic::new(&codes::link::FUNCTION_MISMATCH, other.span, message);
        return Some(finding.label(known.span, "and here"));
    }
    if known.body.is_some() && other.body.is_some() {
        let message = format!("`{name}` is defined in two shaders of one stage");
        let finding = Diagnostic::new(&codes::link::DUPLICATE_DEFINITION, other.span, message);
        return Some(finding.label(known.span, "the other definition"));
    }
    None
}
