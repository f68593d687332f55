//! Lowers the interfaces of a stage (§4.3, §7.1, §7.2): variables of the module, and the entry point with its
//! arguments. Its result is in [`outputs`](super::outputs).
//!
//! *Holds:* `main` is the entry point itself. A global that only `main` uses is an argument or a variable of it; a
//! global that other functions use, too, is a private variable of the module.

use super::constants::is_constant;
use super::function::Ctx;
use super::slots::{GlobalSlot, LocalSlot};
use super::{Lower, Try, internal, lacking, naga_span, unsupported};
use crate::target::WindowOrigin;
use glisten_front::builtin::BuiltinVariable;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::{
    ArraySize, FunctionId, Global, GlobalId, Interpolation, Sampling, Stage, Storage, Type, TypeId, Value,
};
use glisten_front::link::usage::first_use;
use glisten_front::link::{Attribute, Varying};
use naga::{AddressSpace, BinaryOperator, Binding, BuiltIn, Expression, GlobalVariable, Handle};
use std::collections::BTreeMap;

/// The varyings that share one location.
pub(super) struct VaryingLocation<'a> {
    pub(super) location: u32,
    pub(super) rows: Vec<&'a Varying>,
}

impl<'a> Lower<'a> {
    /// The varyings by location, those alone that `keep` wants, with all that share a location with them.
    pub(super) fn locations(&self, keep: impl Fn(&Varying) -> bool) -> Vec<VaryingLocation<'a>> {
        let mut locations: Vec<VaryingLocation<'a>> = Vec::new();
        for row in self.interface.interpolated() {
            match locations.iter_mut().find(|known| known.location == row.location) {
                Some(known) => known.rows.push(row),
                None => locations.push(VaryingLocation { location: row.location, rows: vec![row] }),
            }
        }
        locations.retain(|location| location.rows.iter().any(|row| keep(row)));
        locations.sort_by_key(|location| location.location);
        locations
    }
}

impl Lower<'_> {
    /// Declares all variables of the module.
    pub(super) fn declare_globals(&mut self) -> Try<()> {
        self.declare_uniforms()?;
        self.declare_samplers()?;
        self.declare_viewport()?;
        self.declare_discarded()?;
        let shader = self.shader;
        for (id, global) in shader.globals() {
            let flag = |flags: &[bool]| flags.get(id.index()).copied().unwrap_or(false);
            if !flag(&self.facts.used) {
                continue;
            }
            let in_module = match global.storage {
                Storage::Private => true,
                Storage::In | Storage::Out => flag(&self.facts.shared),
                Storage::Const | Storage::Uniform => continue,
            };
            let slot = if in_module { self.private(global)? } else { GlobalSlot::Entry };
            if let Some(place) = self.globals.get_mut(id.index()) {
                *place = slot;
            }
        }
        Ok(())
    }

    /// Declares the flag of discarded invocations. In these targets an invocation continues after a `discard`, and a
    /// loop that it would have left might never end.
    fn declare_discarded(&mut self) -> Try<()> {
        if !self.can().ends_at_discard && !self.facts.loops_after_discard.is_empty() {
            let init = self
                .module
                .global_expressions
                .append(Expression::Literal(naga::Literal::Bool(false)), naga::Span::UNDEFINED);
            let variable = GlobalVariable {
                name: Some("discarded".to_owned()),
                space: AddressSpace::Private,
                binding: None,
                ty: self.value_type(TypeId::BOOL)?,
                init: Some(init),
                memory_decorations: naga::MemoryDecorations::empty(),
            };
            self.discarded = Some(self.module.global_variables.append(variable, naga::Span::UNDEFINED));
        }
        Ok(())
    }

    fn private(&mut self, global: &Global) -> Try<GlobalSlot> {
        let init = match self.private_constant(global) {
            Some(value) => Some(self.global_constant(&value)?),
            None => None,
        };
        let variable = GlobalVariable {
            name: Some(global.name.clone()),
            space: AddressSpace::Private,
            binding: None,
            ty: self.value_type(global.ty)?,
            init,
            memory_decorations: naga::MemoryDecorations::empty(),
        };
        Ok(GlobalSlot::Private(self.module.global_variables.append(variable, naga_span(global.span))))
    }

    /// The initial value of a private global, if it is constant and has literals.
    fn private_constant(&self, global: &Global) -> Option<Value> {
        let initializer = global.initializer.filter(|_| global.storage == Storage::Private)?;
        let value = self.evaluated(self.shader.main?, initializer)?;
        is_constant(&value).then_some(value)
    }

    /// Whether the framebuffer's height is needed: `gl_FragCoord` counts from the bottom, the target from the top.
    pub(super) fn needs_framebuffer_height(&self) -> bool {
        self.shader.stage == Stage::Fragment
            && self.conventions.window_origin == WindowOrigin::UpperLeft
            && !self.shader.frag_coord.origin_upper_left
            && self.builtin_global(BuiltinVariable::FragCoord).is_some()
            && self.shader.reads_row_of_frag_coord()
    }

    /// The global of a built-in variable, if the stage uses it.
    pub(super) fn builtin_global(&self, builtin: BuiltinVariable) -> Option<GlobalId> {
        let mut globals = self.shader.globals();
        let (id, _) = globals.find(|(_, global)| global.builtin == Some(builtin))?;
        self.facts.used.get(id.index()).copied().unwrap_or(false).then_some(id)
    }

    /// The type at a location: that of its one varying, or a vector that contains all of them.
    pub(super) fn location_type(&mut self, location: &VaryingLocation<'_>) -> Try<Handle<naga::Type>> {
        if let [row] = location.rows.as_slice()
            && row.component == 0
        {
            return self.value_type(row.ty);
        }
        let size = |row: &&Varying| row.component as u8 + self.types.flat_len(row.ty) as u8;
        let size = location.rows.iter().map(size).max().unwrap_or(1);
        let scalar = location.rows.first().and_then(|row| self.types.scalar_of(row.ty));
        Ok(self.vector_type(scalar.unwrap_or(glisten_front::hir::Scalar::Float), size.min(4)))
    }

    /// Lowers `main` as the entry point.
    pub(super) fn entry_point(&mut self, id: FunctionId) -> Try<()> {
        let shader = self.shader;
        let function = shader.function(id);
        let Some(body) = &function.body else {
            return Err(internal(function.span, "`main` has no body"));
        };
        let stage = if shader.stage == Stage::Vertex { naga::ShaderStage::Vertex } else { naga::ShaderStage::Fragment };
        let mut ctx = Ctx::new(self, id);
        ctx.inputs()?;
        if ctx.is_vertex() && ctx.low.draws_sprites() {
            ctx.corner = Some(ctx.sprite_corner()?);
        }
        ctx.output_variables()?;
        ctx.declare_outputs()?;
        ctx.private_initializers()?;
        ctx.body(body)?;
        if !ctx.has_returned() {
            ctx.return_outputs()?;
        }
        let (mut function, low) = ctx.finish();
        function.name = None;
        low.module.entry_points.push(naga::EntryPoint {
            name: "main".to_owned(),
            stage,
            early_depth_test: None,
            workgroup_size: [0; 3],
            workgroup_size_overrides: None,
            function,
            mesh_info: None,
            task_payload: None,
            incoming_ray_payload: None,
        });
        Ok(())
    }
}

/// naga's binding of a varying. The interpolation is written on both sides of the rasterizer, which must agree.
pub(super) fn varying_binding(location: &VaryingLocation<'_>) -> Binding {
    let first = location.rows.first();
    let interpolation = first.map_or(Interpolation::Smooth, |row| row.interpolation);
    let sampling = Some(match first.map_or(Sampling::Center, |row| row.sampling) {
        Sampling::Center => naga::Sampling::Center,
        Sampling::Centroid => naga::Sampling::Centroid,
        Sampling::Sample => naga::Sampling::Sample,
    });
    let (interpolation, sampling) = match interpolation {
        Interpolation::Smooth => (naga::Interpolation::Perspective, sampling),
        Interpolation::Noperspective => (naga::Interpolation::Linear, sampling),
        // No sampling means the first vertex, which naga's GLSL writer would not accept explicitly.
        Interpolation::Flat => (naga::Interpolation::Flat, None),
    };
    Binding::Location {
        location: location.location,
        interpolation: Some(interpolation),
        sampling,
        blend_src: None,
        per_primitive: false,
    }
}

/// The location of an attribute or a fragment output.
pub(super) fn plain_location(location: u32, blend_src: Option<u32>) -> Binding {
    Binding::Location { location, interpolation: None, sampling: None, blend_src, per_primitive: false }
}

/// A path as an identifier: `lights[1].color` becomes `lights_1_color`.
pub(super) fn path_name(path: &str) -> String {
    path.replace(['.', '['], "_").replace(']', "")
}

/// A scalar or vector that the stage receives, and its index in its variable's flat layout.
#[derive(Clone, Copy)]
struct Received {
    global: GlobalId,
    flat: u32,
    value: Handle<Expression>,
}

impl Ctx<'_, '_> {
    /// Declares the arguments and assembles the variables from them.
    fn inputs(&mut self) -> Try<()> {
        let arrived = if self.is_vertex() { self.attributes()? } else { self.varyings()? };
        let shader = self.shader;
        for (id, global) in shader.globals() {
            let used = self.low.facts.used.get(id.index()).copied().unwrap_or(false);
            if !used || global.storage != Storage::In {
                continue;
            }
            let value = match global.builtin {
                Some(builtin) if builtin != BuiltinVariable::ClipDistance => {
                    self.builtin_input(builtin, (id, global))?
                }
                _ => {
                    let own: Vec<Received> = arrived.iter().filter(|part| part.global == id).copied().collect();
                    self.assemble(global.ty, 0, &own)?
                }
            };
            self.keep_input(id, global, value)?;
        }
        Ok(())
    }

    fn keep_input(&mut self, id: GlobalId, global: &Global, value: Handle<Expression>) -> Try<()> {
        match self.low.global_slot(id).clone() {
            GlobalSlot::Private(variable) => {
                let pointer = self.global_variable(variable);
                self.store(pointer, value);
            }
            _ if self.low.facts.indexed.get(id.index()) == Some(&true) => {
                let variable = self.variable_of(&global.name, global.ty)?;
                self.store(variable, value);
                self.entry.insert(id, LocalSlot::Pointer(variable));
            }
            _ => {
                if !self.is_named(value) {
                    self.name(value, &global.name);
                    self.flush();
                }
                self.entry.insert(id, LocalSlot::Value(value));
            }
        }
        Ok(())
    }

    /// Declares one argument per location: matrices by columns, arrays by elements. Attributes that share a location
    /// (OpenGL 3.2 §2.7, legal if no path reads both) share the argument, which has as many components as the longest
    /// of them.
    fn attributes(&mut self) -> Try<Vec<Received>> {
        let interface = self.low.interface;
        let mut arrived = Vec::new();
        let used = |attribute: &&Attribute| self.low.facts.used.get(attribute.global.index()).copied().unwrap_or(false);
        let attributes: Vec<&Attribute> = interface.attributes.iter().filter(used).collect();
        let mut arguments: BTreeMap<u32, (TypeId, Handle<Expression>)> = BTreeMap::new();
        let mut widest: BTreeMap<u32, TypeId> = BTreeMap::new();
        for attribute in &attributes {
            let leaf = self.attribute_leaf(attribute.ty)?;
            for location in attribute.location..attribute.location.saturating_add(attribute.columns) {
                let known = widest.entry(location).or_insert(leaf);
                if self.low.types.scalar_of(*known) == self.low.types.scalar_of(leaf)
                    && self.low.types.flat_len(*known) < self.low.types.flat_len(leaf)
                {
                    *known = leaf;
                }
            }
        }
        for attribute in attributes {
            let leaf = self.attribute_leaf(attribute.ty)?;
            let size = self.low.types.flat_len(leaf).max(1);
            let count = self.low.types.flat_len(attribute.ty) / size;
            for index in 0..count {
                let name = if count == 1 { attribute.name.clone() } else { format!("{}_{index}", attribute.name) };
                let location = attribute.location + index;
                let whole = widest.get(&location).copied().unwrap_or(leaf);
                if self.low.types.scalar_of(whole) != self.low.types.scalar_of(leaf) {
                    return Err(self.aliased(attribute));
                }
                let value = match arguments.get(&location) {
                    Some(&(_, value)) => value,
                    None => {
                        let ty = self.low.value_type(whole)?;
                        self.argument(&name, ty, Some(plain_location(location, None)))
                    }
                };
                arguments.insert(location, (whole, value));
                let value = match self.low.types.flat_len(whole) == size {
                    true => value,
                    false => self.first_components(value, size as u8),
                };
                arrived.push(Received { global: attribute.global, flat: index * size, value });
            }
        }
        Ok(arrived)
    }

    /// The scalar or vector type that an attribute consists of.
    fn attribute_leaf(&self, ty: TypeId) -> Try<TypeId> {
        let mut leaf = ty;
        while !matches!(self.low.types.get(leaf), Type::Scalar(_) | Type::Vector(..)) {
            leaf = self.low.element_type(leaf);
            if leaf.is_error() {
                return Err(self.internal_error("an attribute of a type that no attribute can have"));
            }
        }
        Ok(leaf)
    }

    fn aliased(&self, attribute: &Attribute) -> Box<Diagnostic> {
        let span = self.shader.global(attribute.global).span;
        let message = format!("no target reads one location as numbers of two kinds, as `{}` asks for", attribute.name);
        lacking(span, message, format!("bind `{}` to a location of its own", attribute.name))
    }

    fn varyings(&mut self) -> Try<Vec<Received>> {
        let mut arrived = Vec::new();
        let used = &self.low.facts.used;
        let wanted = |row: &Varying| row.to.is_some_and(|end| used.get(end.global.index()).copied().unwrap_or(false));
        for location in self.low.locations(wanted) {
            let binding = varying_binding(&location);
            let packed = location.rows.len() > 1 || location.rows.iter().any(|row| row.component > 0);
            let name = match location.rows.first() {
                Some(row) if !packed => path_name(&row.name),
                _ => format!("packed_{}", location.location),
            };
            let ty = self.low.location_type(&location)?;
            let argument = self.argument(&name, ty, Some(binding));
            for row in location.rows {
                let (Some(end), ty, component) = (row.to, row.ty, row.component) else { continue };
                let value = if packed {
                    let len = self.low.types.flat_len(ty) as u8;
                    let mut components = [0; 4];
                    for (to, from) in components.iter_mut().take(usize::from(len)).zip(component as u8..) {
                        *to = from.min(3);
                    }
                    self.swizzled(argument, glisten_front::hir::Swizzle { len, components })
                } else {
                    argument
                };
                arrived.push(Received { global: end.global, flat: end.flat_offset, value });
            }
        }
        Ok(arrived)
    }

    /// A value of any type, assembled from received scalars and vectors; what was not received is 0.
    fn assemble(&mut self, ty: TypeId, flat: u32, parts: &[Received]) -> Try<Handle<Expression>> {
        if let Some(part) = parts.iter().find(|part| part.flat == flat)
            && matches!(self.low.types.get(ty), Type::Scalar(_) | Type::Vector(..))
        {
            return Ok(part.value);
        }
        let members: Vec<TypeId> = match self.low.types.get(ty) {
            Type::Struct(id) => self.low.types.structure(id).members.iter().map(|member| member.ty).collect(),
            Type::Array(element, ArraySize::Sized(len)) => vec![element; len as usize],
            Type::Matrix(columns, _) => vec![self.low.element_type(ty); usize::from(columns)],
            _ => {
                let ty = self.low.value_type(ty)?;
                return Ok(self.zero(ty));
            }
        };
        let mut at = flat;
        let mut components = Vec::with_capacity(members.len());
        for member in members {
            components.push(self.assemble(member, at, parts)?);
            at += self.low.types.flat_len(member);
        }
        let ty = self.low.value_type(ty)?;
        Ok(self.add(Expression::Compose { ty, components }))
    }

    fn builtin_input(
        &mut self,
        builtin: BuiltinVariable,
        (id, global): (GlobalId, &Global),
    ) -> Try<Handle<Expression>> {
        use BuiltinVariable as B;
        let target = self.low.target;
        match builtin {
            B::VertexId => self.index_input(&global.name, BuiltIn::VertexIndex),
            B::InstanceId => self.index_input(&global.name, BuiltIn::InstanceIndex),
            B::PrimitiveId if self.low.draws_sprites() => self.sprite_number(&global.name),
            B::PrimitiveId => self.index_input(&global.name, BuiltIn::PrimitiveIndex),
            B::SampleId => self.index_input(&global.name, BuiltIn::SampleIndex),
            B::SampleMaskIn => {
                let mask = self.index_input(&global.name, BuiltIn::SampleMask)?;
                let ty = self.low.value_type(global.ty)?;
                Ok(self.add(Expression::Compose { ty, components: vec![mask] }))
            }
            B::FragCoord => self.frag_coord(),
            B::FrontFacing => {
                let ty = self.low.value_type(TypeId::BOOL)?;
                Ok(self.argument(&global.name, ty, Some(Binding::BuiltIn(BuiltIn::FrontFacing))))
            }
            B::PointCoord if self.low.draws_sprites() => self.sprite_coordinate(),
            B::PointCoord if !self.low.can().has_large_points => Err(lacking(
                first_use(self.shader, id).unwrap_or(global.span),
                format!("{} has no `gl_PointCoord`", target.name()),
                "draw points as quads with `--point-sprites`, or compile for SPIR-V",
            )),
            B::PointCoord => self.point_coord(),
            B::Position
            | B::ClipDistance
            | B::PointSize
            | B::In
            | B::PrimitiveIdIn
            | B::InvocationId
            | B::Layer
            | B::FragColor
            | B::FragData
            | B::FragDepth
            | B::DepthRange => Err(unsupported(global.span, format!("`{}` is not read in this stage", builtin.name()))),
        }
    }

    /// An index: unsigned in the target, `int` in GLSL.
    fn index_input(&mut self, name: &str, builtin: BuiltIn) -> Try<Handle<Expression>> {
        // An instance of a quad is a vertex of the scene, and there are no other instances.
        let builtin = match builtin {
            BuiltIn::VertexIndex if self.low.draws_sprites() => BuiltIn::InstanceIndex,
            BuiltIn::InstanceIndex if self.low.draws_sprites() => {
                return Ok(self.literal(glisten_front::hir::ScalarValue::Int(0)));
            }
            other => other,
        };
        let ty = self.low.value_type(TypeId::UINT)?;
        let argument = match builtin {
            BuiltIn::VertexIndex => "vertex_index",
            BuiltIn::InstanceIndex => "instance_index",
            BuiltIn::SampleIndex => "sample_index",
            BuiltIn::SampleMask => "sample_mask",
            _ => "primitive_index",
        };
        let index = self.argument(argument, ty, Some(Binding::BuiltIn(builtin)));
        let value = self.add(Expression::As { expr: index, kind: naga::ScalarKind::Sint, convert: Some(4) });
        self.name(value, name);
        Ok(value)
    }

    /// `gl_FragCoord` (§7.2), with the origin that the shader declares. The target counts rows from the top; if the
    /// vertex stage flips y, its rows are OpenGL's.
    fn frag_coord(&mut self) -> Try<Handle<Expression>> {
        let layout = self.shader.frag_coord;
        let ty = self.low.value_type(TypeId::VEC4)?;
        let position = Some(Binding::BuiltIn(BuiltIn::Position { invariant: false }));
        let upside_down = self.low.needs_framebuffer_height();
        if !upside_down && !layout.pixel_center_integer {
            self.refuse_unknown_height()?;
            return Ok(self.argument("gl_FragCoord", ty, position));
        }
        self.refuse_unknown_height()?;
        let position = self.argument("frag_coord", ty, position);
        let mut part = |index| self.add(Expression::AccessIndex { base: position, index });
        let (mut x, mut y, z, w) = (part(0), part(1), part(2), part(3));
        if upside_down {
            let Some((variable, member)) = self.low.framebuffer_height else {
                return Err(self.internal_error("the framebuffer's height has no place among the uniforms"));
            };
            let base = self.global_variable(variable);
            let pointer = self.add(Expression::AccessIndex { base, index: member });
            let height = self.load(pointer);
            y = self.op(BinaryOperator::Subtract, height, y);
        }
        if layout.pixel_center_integer {
            let half = self.float(0.5);
            x = self.op(BinaryOperator::Subtract, x, half);
            y = self.op(BinaryOperator::Subtract, y, half);
        }
        Ok(self.add(Expression::Compose { ty, components: vec![x, y, z, w] }))
    }

    fn refuse_unknown_height(&self) -> Try<()> {
        let lower_left = self.low.conventions.window_origin == WindowOrigin::LowerLeft;
        if lower_left && self.shader.frag_coord.origin_upper_left {
            return Err(lacking(
                self.here(),
                "`layout(origin_upper_left)` of `gl_FragCoord` needs the framebuffer's height, which only \
                 `--window-origin upper-left` has",
                "compile with `--window-origin upper-left`, or subtract `gl_FragCoord.y` from a uniform of your own",
            ));
        }
        Ok(())
    }

    /// `gl_PointCoord` (§7.2). OpenGL's default origin is the upper left, like the target's; if the vertex stage
    /// flips y, the point is upside down.
    fn point_coord(&mut self) -> Try<Handle<Expression>> {
        let ty = self.low.value_type(TypeId::VEC2)?;
        let argument = self.argument("gl_PointCoord", ty, Some(Binding::BuiltIn(BuiltIn::PointCoord)));
        if self.low.conventions.window_origin == WindowOrigin::UpperLeft {
            return Ok(argument);
        }
        let x = self.add(Expression::AccessIndex { base: argument, index: 0 });
        let y = self.add(Expression::AccessIndex { base: argument, index: 1 });
        let one = self.float(1.0);
        let y = self.op(BinaryOperator::Subtract, one, y);
        Ok(self.add(Expression::Compose { ty, components: vec![x, y] }))
    }

    /// Runs the initializers of private globals before `main` (§4.3), in order of declaration.
    fn private_initializers(&mut self) -> Try<()> {
        let shader = self.shader;
        for (id, global) in shader.globals() {
            let GlobalSlot::Private(variable) = *self.low.global_slot(id) else { continue };
            let Some(initializer) = global.initializer.filter(|_| global.storage == Storage::Private) else {
                continue;
            };
            if self.low.private_constant(global).is_some() {
                continue;
            }
            let value = self.value(initializer)?;
            let pointer = self.global_variable(variable);
            self.store(pointer, value);
        }
        Ok(())
    }
}
