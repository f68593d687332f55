//! Prints what precedes the functions: version, extensions, layouts, structs, globals.

use super::Printer;
use crate::builtin::functions::Row;
use crate::builtin::{BuiltinFunction, BuiltinVariable};
use crate::hir::{
    BlockLayout, ExprId, ExprKind, Global, GlobalId, MatrixLayout, Member, PrimitiveIn, PrimitiveOut, SamplerDim,
    ScalarValue, Storage, Type, TypeId, Value, VarRef,
};
use crate::language::{Extensions, Profile, Sampling};
use crate::source::Span;
use std::collections::BTreeSet;

impl Printer<'_> {
    pub(super) fn header(&mut self) {
        let version = self.shader.version;
        let globals = &self.shader.globals;
        let profile = match version.profile {
            _ if globals.iter().any(Global::is_fixed) => " compatibility",
            Profile::Core | Profile::Compatibility => "",
            Profile::Es => " es",
        };
        // Older texts are written as 1.50 is, and those of ES as the desktop's unless the target is ES.
        let number = match version.profile {
            Profile::Es => version.number,
            Profile::Core | Profile::Compatibility => version.number.max(150),
        };
        self.line(&format!("#version {number}{profile}"));
        let located = globals.iter().any(|global| global.location.is_some() || global.index.is_some());
        let bound = globals.iter().any(|global| {
            global.binding.is_some() || global.block.as_ref().is_some_and(|block| block.binding.is_some())
        });
        // Core since 3.30 and 4.20.
        if located && version.number < 330 && version.profile != Profile::Es {
            self.line("#extension GL_ARB_explicit_attrib_location : enable");
        }
        if bound && version.number < 420 {
            self.line("#extension GL_ARB_shading_language_420pack : enable");
        }
        let mut needed = self.needed_extensions(number);
        if number < 430 && version.profile != Profile::Es && self.nests_arrays() {
            needed.extend(Extensions::ARRAYS_OF_ARRAYS.name());
        }
        if number < 440 && self.has_places() {
            needed.extend(Extensions::ENHANCED_LAYOUTS.name());
        }
        for name in needed {
            self.line(&format!("#extension {name} : require"));
        }
        self.geometry_layout();
    }

    /// Whether something is an array of arrays: a variable, a member, a value.
    fn nests_arrays(&self) -> bool {
        let shader = self.shader;
        let nests = |ty| matches!(self.types.get(ty), Type::Array(element, _) if matches!(self.types.get(element), Type::Array(..)));
        let locals = shader.functions.iter().flat_map(|function| &function.locals).map(|local| local.ty);
        let results = shader.functions.iter().map(|function| function.ret);
        let values = shader.exprs.iter().map(|expr| expr.ty);
        let structs = self.names.structs().iter().flat_map(|id| &self.types.structure(*id).members);
        let members = structs.map(|member| member.ty);
        let globals = shader.globals.iter().map(|global| global.ty);
        globals.chain(locals).chain(results).chain(values).chain(members).any(nests)
    }

    /// Whether a member of a uniform block has an offset or an alignment of its own, or a varying a component.
    fn has_places(&self) -> bool {
        let block = |global: &Global| {
            let element = match self.types.get(global.ty) {
                Type::Array(element, _) => element,
                _ => global.ty,
            };
            let Type::Struct(id) = self.types.get(element) else { return false };
            let members = &self.types.structure(id).members;
            global.block.is_some()
                && members.iter().any(|member| member.place.offset.is_some() || member.place.align > 0)
        };
        self.shader
            .globals
            .iter()
            .any(|global| (global.component.is_some() && global.location.is_some()) || block(global))
    }

    /// The extensions that bring the functions and types which are used and are not in a desktop version.
    fn needed_extensions(&self, number: u16) -> BTreeSet<&'static str> {
        let mut needed = BTreeSet::new();
        if self.shader.version.profile == Profile::Es {
            return needed;
        }
        for expr in &self.shader.exprs {
            if let ExprKind::BuiltinCall(function, arguments) = &expr.kind {
                needed.extend(self.bringing(*function, arguments, number));
            }
        }
        if number < 400 && self.shader.globals.iter().any(|global| self.is_cube_array(global.ty)) {
            needed.extend(Extensions::TEXTURE_CUBE_MAP_ARRAY.name());
        }
        if number < 400 && (self.shader.geometry.invocations.is_some() || self.shader.evaluates_samples(self.types)) {
            needed.extend(Extensions::GPU_SHADER5.name());
        }
        if (130..400).contains(&number) && self.shader.exprs.iter().any(|expr| self.chooses(expr)) {
            needed.extend(Extensions::GPU_SHADER5.name());
        }
        if number < 400 && !self.shader.precise.is_empty() {
            needed.extend(Extensions::GPU_SHADER5.name());
        }
        let reads = |builtin| self.shader.globals.iter().any(|global| global.builtin == Some(builtin));
        if number < 400 && reads(BuiltinVariable::SampleId) {
            needed.extend(Extensions::SAMPLE_SHADING.name());
        }
        if number < 400 && reads(BuiltinVariable::SampleMaskIn) {
            needed.extend(Extensions::GPU_SHADER5.name());
        }
        needed
    }

    /// Whether an expression chooses a sampler or a uniform block by an index that may not be constant.
    fn chooses(&self, expr: &crate::hir::Expr) -> bool {
        let ExprKind::Index(base, index) = expr.kind else { return false };
        let is_block = match self.shader.expr(base).kind {
            ExprKind::Var(VarRef::Global(global)) => {
                let global = self.shader.global(global);
                global.storage == Storage::Uniform && global.block.is_some()
            }
            _ => false,
        };
        let is_constant = match self.shader.expr(index).kind {
            ExprKind::Literal(_) => true,
            ExprKind::Var(VarRef::Global(global)) => self.shader.global(global).storage == Storage::Const,
            _ => false,
        };
        (is_block || self.types.contains_sampler(expr.ty)) && !is_constant
    }

    /// Whether a type is a sampler of arrays of cube maps, or an array of such.
    fn is_cube_array(&self, ty: TypeId) -> bool {
        match self.types.get(ty) {
            Type::Sampler(sampler) => sampler.dim == SamplerDim::Cube && sampler.arrayed,
            Type::Array(element, _) => self.is_cube_array(element),
            _ => false,
        }
    }

    /// The extensions that bring the overload of a call. That of a new type of sampler needs the function, too.
    fn bringing(&self, function: BuiltinFunction, arguments: &[ExprId], number: u16) -> Vec<&'static str> {
        let types: Vec<TypeId> = arguments.iter().map(|&argument| self.shader.expr(argument).ty).collect();
        let rows = || function.operation().prototypes().filter(|row| !row.deprecated);
        let is_called = |row: &&'static Row| row.signatures(self.shader.stage).any(|one| one.has_types(&types));
        let is_in = |row: &Row| row.availability.since.desktop <= number;
        let called = rows().find(is_called);
        if called.map_or_else(|| rows().any(is_in), is_in) {
            return Vec::new();
        }
        let is_of_type = |row: &&Row| row.availability.extensions.contains(Extensions::TEXTURE_CUBE_MAP_ARRAY);
        let base = rows().find(|row| !is_of_type(row)).filter(|_| !rows().any(is_in));
        [called.or(base), base].into_iter().flatten().filter_map(|row| row.availability.extensions.name()).collect()
    }

    fn geometry_layout(&mut self) {
        let layout = self.shader.geometry;
        if let Some(input) = layout.input {
            self.blank();
            let invocations = layout.invocations.map_or_else(String::new, |count| format!(", invocations = {count}"));
            self.line(&format!("layout({}{invocations}) in;", primitive_in(input)));
        }
        let output = layout.output.map(primitive_out).map(str::to_owned);
        let vertices = layout.max_vertices.map(|vertices| format!("max_vertices = {vertices}"));
        let parts: Vec<String> = output.into_iter().chain(vertices).collect();
        if !parts.is_empty() {
            self.line(&format!("layout({}) out;", parts.join(", ")));
        }
    }

    pub(super) fn structs(&mut self) {
        for id in self.names.structs().to_vec() {
            self.blank();
            let types = self.types;
            self.above(types.structure(id).span);
            self.line(&format!("struct {} {{", self.names.structure(id)));
            self.indent += 1;
            for member in &types.structure(id).members {
                self.above(member.span);
                self.line(&format!("{}{} {};", self.precise(member.span), self.type_name(member.ty), member.name));
                self.behind(member.span);
            }
            self.indent -= 1;
            self.line("};");
        }
    }

    /// Prints prototypes of functions that initializers of globals call, since the functions come after the globals.
    pub(super) fn early_prototypes(&mut self) {
        let shader = self.shader;
        let mut called = Vec::new();
        for initializer in shader.globals.iter().filter_map(|global| global.initializer) {
            shader.visit_expr(initializer, &mut |expr| {
                if let ExprKind::Call(function, _) = shader.expr(expr).kind
                    && !called.contains(&function)
                {
                    called.push(function);
                }
            });
        }
        for id in called {
            self.blank();
            let head = self.function_head(id, shader.function(id));
            self.line(&format!("{head};"));
        }
    }

    pub(super) fn globals(&mut self) {
        let shader = self.shader;
        self.blank();
        let mut order: Vec<(GlobalId, &Global)> = shader.globals().collect();
        if self.initializers_look_ahead() {
            order.sort_by_key(|(_, global)| global.storage == Storage::Private);
        }
        for (id, global) in order {
            if !self.notes.is_none_or(|notes| notes.keeps_global(global)) {
                continue;
            }
            if global.builtin.is_some() {
                self.builtin(global);
                continue;
            }
            if global.is_fixed() {
                self.fixed(global);
                continue;
            }
            self.above(global.span);
            if global.block.is_some() {
                self.block(id, global);
            } else {
                self.variable(id, global);
                self.behind(global.span);
            }
        }
    }

    /// Whether an initializer reads a global that comes later, as where the link has added inputs.
    fn initializers_look_ahead(&self) -> bool {
        let shader = self.shader;
        let mut ahead = false;
        for (id, global) in shader.globals() {
            let Some(initializer) = global.initializer.filter(|_| global.storage == Storage::Private) else { continue };
            shader.visit_expr(initializer, &mut |expr| {
                ahead |= matches!(shader.expr(expr).kind, ExprKind::Var(VarRef::Global(other)) if other > id);
            });
        }
        ahead
    }

    /// A redeclaration of a variable of the fixed-function pipeline, if its interpolation was declared.
    fn fixed(&mut self, global: &Global) {
        if global.interpolation_written || global.sampling != Sampling::Center {
            let interpolation = if global.interpolation_written { global.interpolation.name() } else { "" };
            let sampling = global.sampling.prefix();
            let (storage, ty) = (storage(global.storage), self.type_name(global.ty));
            self.line(format!("{interpolation} {sampling}{storage}{ty} {};", global.name).trim_start());
        }
        self.precise_builtin(global);
    }

    fn precise_builtin(&mut self, global: &Global) {
        if self.has_precise() && self.shader.precise.holds_builtin(&global.name) {
            self.line(&format!("precise {};", global.name));
        }
    }

    /// Whether the language has `precise`: OpenGL's from 4.00 on, and before by an extension; ES from 3.20 on.
    fn has_precise(&self) -> bool {
        self.shader.version.profile != Profile::Es || self.shader.version.number >= 320
    }

    /// `precise ` before what is declared so, by the place of its name.
    pub(super) fn precise(&self, name: Span) -> &'static str {
        if self.has_precise() && self.shader.precise.holds(name) { "precise " } else { "" }
    }

    /// A redeclaration of a built-in variable: its size, its layout, or `invariant`.
    fn builtin(&mut self, global: &Global) {
        let direction = storage(global.storage);
        match global.builtin {
            Some(BuiltinVariable::ClipDistance) if matches!(self.types.get(global.ty), Type::Array(..)) => {
                let ty = self.type_name(global.ty);
                self.line(&format!("{direction}{ty} gl_ClipDistance;"));
            }
            Some(BuiltinVariable::FragCoord) => {
                let layout = self.shader.frag_coord;
                let parts = [
                    (layout.origin_upper_left, "origin_upper_left"),
                    (layout.pixel_center_integer, "pixel_center_integer"),
                ];
                let parts: Vec<&str> = parts.into_iter().filter(|(set, _)| *set).map(|(_, word)| word).collect();
                if !parts.is_empty() {
                    self.line(&format!("layout({}) in vec4 gl_FragCoord;", parts.join(", ")));
                }
            }
            Some(BuiltinVariable::In) if global.span.is_known() => {
                let Type::Array(element, _) = self.types.get(global.ty) else { return };
                self.line("in gl_PerVertex {");
                self.members(element, "");
                self.line("} gl_in[];");
            }
            _ => {}
        }
        if global.invariant {
            self.line(&format!("invariant {};", global.name));
        }
        self.precise_builtin(global);
    }

    fn variable(&mut self, id: GlobalId, global: &Global) {
        let component = global.component.filter(|_| global.location.is_some());
        let layout = [
            ("location", global.location),
            ("component", component),
            ("index", global.index),
            ("binding", global.binding),
        ];
        let own = layout.into_iter().filter_map(|(word, value)| Some(format!("{word} = {}", value?)));
        let layout: Vec<String> = self.layout_words(id).into_iter().chain(own).collect();
        let layout = if layout.is_empty() { String::new() } else { format!("layout({}) ", layout.join(", ")) };
        let invariant = if global.invariant { "invariant " } else { "" };
        let interpolation = if global.interpolation_written { global.interpolation.name() } else { "" };
        let gap = if interpolation.is_empty() { "" } else { " " };
        let sampling = global.sampling.prefix();
        let storage = storage(global.storage);
        let (ty, name) = (self.type_name(global.ty), self.names.global(id));
        let precise = self.precise(global.span);
        let head = format!("{layout}{precise}{invariant}{interpolation}{gap}{sampling}{storage}{ty} {name}");
        let initializer = match (global.initializer, &global.value) {
            (Some(expr), _) => Some(self.argument(expr)),
            (None, Some(value)) if global.storage != Storage::In => Some(self.value(value)),
            _ => None,
        };
        self.line(&initializer.map_or(format!("{head};"), |initializer| format!("{head} = {initializer};")));
    }

    fn block(&mut self, id: GlobalId, global: &Global) {
        let Some(block) = &global.block else { return };
        let (element, dim) = match self.types.get(global.ty) {
            Type::Array(element, crate::hir::ArraySize::Sized(size)) => (element, format!("[{size}]")),
            Type::Array(element, crate::hir::ArraySize::Unsized) => (element, "[]".into()),
            _ => (global.ty, String::new()),
        };
        let mut layout: Vec<String> = Vec::new();
        match block.layout {
            _ if global.storage != Storage::Uniform => {}
            BlockLayout::Shared => {}
            BlockLayout::Packed => layout.push("packed".into()),
            BlockLayout::Std140 => layout.push("std140".into()),
        }
        let words = self.layout_words(id);
        let is_located = words.iter().any(|word| word.starts_with("location"));
        if !is_located && self.has_locations(element, storage(global.storage)) {
            layout.extend(global.location.map(|location| format!("location = {location}")));
        }
        layout.extend(words);
        layout.extend(block.binding.map(|binding| format!("binding = {binding}")));
        let layout = if layout.is_empty() { String::new() } else { format!("layout({}) ", layout.join(", ")) };
        let storage = storage(global.storage);
        self.line(&format!("{layout}{}{storage}{} {{", self.precise(global.span), block.name));
        self.members(element, storage);
        let instance =
            if block.instance.is_some() { format!(" {}{dim}", self.names.global(id)) } else { String::new() };
        self.line(&format!("}}{instance};"));
    }

    fn members(&mut self, ty: TypeId, storage: &str) {
        let Type::Struct(id) = self.types.get(ty) else { return };
        let types = self.types;
        let has_locations = self.has_locations(ty, storage);
        self.indent += 1;
        for member in &types.structure(id).members {
            let qualifiers = member_qualifiers(member, storage, has_locations);
            let precise = self.precise(member.span);
            let line = format!("{precise}{qualifiers}{} {};", self.type_name(member.ty), member.name);
            self.above(member.span);
            self.line(&line);
            self.behind(member.span);
        }
        self.indent -= 1;
    }

    /// Whether members of a block between stages have locations of their own (GLSL 4.40 §4.4.1).
    fn has_locations(&self, ty: TypeId, storage: &str) -> bool {
        let version = self.shader.version;
        let can = matches!(storage, "in " | "out ") && version.profile != Profile::Es && version.number >= 440;
        let located = |id| self.types.structure(id).members.iter().any(|member| member.place.location.is_some());
        can && matches!(self.types.get(ty), Type::Struct(id) if located(id))
    }

    /// A constant as a constructor or literal.
    pub(super) fn value(&self, value: &Value) -> String {
        let mut scalars = value.scalars.iter().copied();
        self.value_of(value.ty, &mut scalars)
    }

    fn value_of(&self, ty: TypeId, scalars: &mut dyn Iterator<Item = ScalarValue>) -> String {
        let parts: Vec<String> = match self.types.get(ty) {
            Type::Scalar(_) => return scalars.next().map_or(String::new(), super::expressions::literal),
            Type::Vector(..) | Type::Matrix(..) => {
                let len = self.types.flat_len(ty) as usize;
                scalars.take(len).map(super::expressions::literal).collect()
            }
            Type::Struct(id) => {
                let members = &self.types.structure(id).members;
                members.iter().map(|member| self.value_of(member.ty, scalars)).collect()
            }
            Type::Array(element, crate::hir::ArraySize::Sized(size)) => {
                (0..size).map(|_| self.value_of(element, scalars)).collect()
            }
            Type::Array(_, crate::hir::ArraySize::Unsized) | Type::Error | Type::Void | Type::Sampler(_) => Vec::new(),
        };
        format!("{}({})", self.type_name(ty), parts.join(", "))
    }
}

fn member_qualifiers(member: &Member, storage: &str, has_locations: bool) -> String {
    let uniform = storage == "uniform ";
    let row_major = uniform && member.matrix_layout == MatrixLayout::RowMajor;
    let mut layout: Vec<String> = row_major.then(|| "row_major".to_owned()).into_iter().collect();
    if uniform {
        layout.extend(member.place.offset.map(|offset| format!("offset = {offset}")));
        layout.extend((member.place.align > 0).then(|| format!("align = {}", member.place.align)));
    }
    if has_locations {
        layout.extend(member.place.location.map(|location| format!("location = {location}")));
        layout.extend(member.place.component.map(|component| format!("component = {component}")));
    }
    let order = if layout.is_empty() { String::new() } else { format!("layout({}) ", layout.join(", ")) };
    let interpolation = member.interpolation.map_or(String::new(), |word| format!("{} ", word.name()));
    // `centroid` and `sample` precede a storage qualifier, which in a block can only be that of the block.
    let sampling = member.sampling.word().map_or(String::new(), |word| format!("{word} {storage}"));
    let invariant = if member.invariant { "invariant " } else { "" };
    format!("{order}{invariant}{interpolation}{sampling}")
}

fn storage(storage: Storage) -> &'static str {
    match storage {
        Storage::Const => "const ",
        Storage::Private => "",
        Storage::Uniform => "uniform ",
        Storage::In => "in ",
        Storage::Out => "out ",
    }
}

fn primitive_in(primitive: PrimitiveIn) -> &'static str {
    match primitive {
        PrimitiveIn::Points => "points",
        PrimitiveIn::Lines => "lines",
        PrimitiveIn::LinesAdjacency => "lines_adjacency",
        PrimitiveIn::Triangles => "triangles",
        PrimitiveIn::TrianglesAdjacency => "triangles_adjacency",
    }
}

fn primitive_out(primitive: PrimitiveOut) -> &'static str {
    match primitive {
        PrimitiveOut::Points => "points",
        PrimitiveOut::LineStrip => "line_strip",
        PrimitiveOut::TriangleStrip => "triangle_strip",
    }
}
