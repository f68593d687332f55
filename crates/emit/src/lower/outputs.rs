//! Lowers the result of an entry point: the position, varyings and built-in outputs of a vertex shader, the colors
//! and depth of a fragment shader.
//!
//! *Holds:* a position is converted to the conventions when it is returned (clip-space z to [0, w], y flipped);
//! colors have four components, as every color target requires.

use super::function::Ctx;
use super::interface::{path_name, plain_location, varying_binding};
use super::slots::{GlobalSlot, LocalSlot, OutputMember, OutputSource};
use super::sprites::{coordinate_binding, coordinate_location, number_binding, number_location};
use super::{Try, lacking};
use crate::target::{ClipZ, SpirvEnv, WindowOrigin};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{ArraySize, GlobalId, Scalar, ScalarValue, Storage, Swizzle, Type, TypeId};
use glisten_front::link::{Varying, VaryingEnd};
use naga::{BinaryOperator, Binding, BuiltIn, Expression, Handle, Statement, UnaryOperator};

impl Ctx<'_, '_> {
    /// Declares variables for the outputs that only `main` uses.
    pub(super) fn output_variables(&mut self) -> Try<()> {
        let shader = self.shader;
        for (id, global) in shader.globals() {
            let is_entry = matches!(self.low.global_slot(id), GlobalSlot::Entry);
            if is_entry && global.storage == Storage::Out {
                self.at(global.span);
                let variable = self.variable_of(&global.name, global.ty)?;
                self.entry.insert(id, LocalSlot::Pointer(variable));
            }
        }
        self.at(shader.function(self.id).span);
        Ok(())
    }

    /// Declares the members of the result.
    pub(super) fn declare_outputs(&mut self) -> Try<()> {
        let members = if self.is_vertex() { self.vertex_outputs()? } else { self.fragment_outputs()? };
        let result = match members.as_slice() {
            [] => None,
            [only] if !has_blend_source(&only.binding) => {
                Some(naga::FunctionResult { ty: only.ty, binding: Some(only.binding.clone()) })
            }
            several => {
                let name = if self.is_vertex() { "VertexOutput" } else { "FragmentOutput" };
                let members = several
                    .iter()
                    .map(|member| (member.name.clone(), member.ty, Some(member.binding.clone())))
                    .collect();
                let ty = self.low.natural_struct(name.to_owned(), members);
                Some(naga::FunctionResult { ty, binding: None })
            }
        };
        self.out.result = result;
        self.outputs = members;
        Ok(())
    }

    fn vertex_outputs(&mut self) -> Try<Vec<OutputMember>> {
        let vec4 = self.low.value_type(TypeId::VEC4)?;
        let position = self.shader.globals.iter().find(|global| global.builtin == Some(BuiltinVariable::Position));
        let invariant = position.is_some_and(|global| global.invariant);
        let mut members = vec![OutputMember {
            name: "position".to_owned(),
            ty: vec4,
            binding: Binding::BuiltIn(BuiltIn::Position { invariant }),
            source: OutputSource::Position,
        }];
        let wanted = |row: &Varying| row.from.is_some() || row.to.is_some();
        for location in self.low.locations(wanted) {
            let ty = self.low.location_type(&location)?;
            let name = match location.rows.as_slice() {
                [row] if row.component == 0 => path_name(&row.name),
                _ => format!("packed_{}", location.location),
            };
            let source =
                OutputSource::Varyings(location.rows.iter().map(|row| (row.component, row.ty, row.from)).collect());
            members.push(OutputMember { name, ty, binding: varying_binding(&location), source });
        }
        if self.low.draws_sprites() {
            members.push(OutputMember {
                name: "point_coord".to_owned(),
                ty: self.low.value_type(TypeId::VEC2)?,
                binding: coordinate_binding(coordinate_location(self.low.interface)),
                source: OutputSource::PointCoord,
            });
            if self.low.reads_primitive_id {
                members.push(OutputMember {
                    name: "point_number".to_owned(),
                    ty: self.low.value_type(TypeId::UINT)?,
                    binding: number_binding(number_location(self.low.interface)),
                    source: OutputSource::PointNumber,
                });
            }
        }
        self.clip_distances(&mut members)?;
        self.point_size(&mut members)?;
        Ok(members)
    }

    /// `gl_ClipDistance` (§7.1): as many distances as the conventions enable, by default all.
    fn clip_distances(&mut self, members: &mut Vec<OutputMember>) -> Try<()> {
        let Some(global) = self.low.builtin_global(BuiltinVariable::ClipDistance) else { return Ok(()) };
        let Type::Array(_, ArraySize::Sized(len)) = self.low.types.get(self.shader.global(global).ty) else {
            return Ok(());
        };
        let len = self.low.conventions.clip_distances.unwrap_or(len).min(len);
        if len == 0 {
            return Ok(());
        }
        let float = self.low.value_type(TypeId::FLOAT)?;
        members.push(OutputMember {
            name: "clip_distances".to_owned(),
            ty: self.low.natural_array(float, len),
            binding: Binding::BuiltIn(BuiltIn::ClipDistances),
            source: OutputSource::ClipDistances(global, len),
        });
        Ok(())
    }

    /// `gl_PointSize` (§7.1) has an effect only if the host enables it; otherwise points are one pixel wide.
    fn point_size(&mut self, members: &mut Vec<OutputMember>) -> Try<()> {
        let Some(global) = self.low.builtin_global(BuiltinVariable::PointSize) else { return Ok(()) };
        if !self.low.conventions.program_point_size {
            return Ok(());
        }
        if self.low.draws_sprites() {
            return Ok(());
        }
        let target = self.low.target;
        if !self.low.can().has_large_points {
            let declared = self.shader.global(global).span;
            let span = if declared.is_known() { declared } else { self.shader.function(self.id).span };
            return Err(lacking(
                span,
                format!("{} has no `gl_PointSize`: its points are one pixel wide", target.name()),
                "draw points as quads with `--point-sprites`, compile for SPIR-V, or leave `--program-point-size` out",
            ));
        }
        members.push(OutputMember {
            name: "point_size".to_owned(),
            ty: self.low.value_type(TypeId::FLOAT)?,
            binding: Binding::BuiltIn(BuiltIn::PointSize),
            source: OutputSource::PointSize,
        });
        Ok(())
    }

    fn fragment_outputs(&mut self) -> Try<Vec<OutputMember>> {
        let interface = self.low.interface;
        let dual = interface.outputs.iter().any(|output| output.index == 1);
        let mut members = Vec::new();
        for output in &interface.outputs {
            // Of two sources of blending, targets want both.
            let used = self.low.facts.used.get(output.global.index()).copied().unwrap_or(false);
            if !used && !dual {
                continue;
            }
            let (ty, len) = match self.low.types.get(output.ty) {
                Type::Array(element, ArraySize::Sized(len)) => (element, Some(len)),
                _ => (output.ty, None),
            };
            let scalar = self.low.types.scalar_of(ty).unwrap_or(Scalar::Float);
            // `gl_FragColor` is for all attachments.
            let is_for_all = self.shader.global(output.global).builtin == Some(BuiltinVariable::FragColor);
            let copies = self.low.conventions.color_attachments.filter(|_| is_for_all).unwrap_or(1);
            for element in 0..len.unwrap_or(copies) {
                let name = match (len, element) {
                    (None, 0) => output.name.clone(),
                    _ => format!("{}_{element}", output.name),
                };
                members.push(OutputMember {
                    name,
                    ty: self.low.vector_type(scalar, 4),
                    binding: plain_location(output.location + element, dual.then_some(output.index)),
                    source: match used {
                        true => OutputSource::Color { global: output.global, element: len.map(|_| element), ty },
                        false => OutputSource::Nothing,
                    },
                });
            }
        }
        let second = interface.outputs.iter().find(|output| output.index == 1);
        if let Some(second) = second.filter(|_| interface.outputs.iter().all(|output| output.index == 1)) {
            // The program declares the second source alone.
            members.insert(
                0,
                OutputMember {
                    name: "first_source".to_owned(),
                    ty: self.low.vector_type(Scalar::Float, 4),
                    binding: plain_location(second.location, Some(0)),
                    source: OutputSource::Nothing,
                },
            );
        }
        if let Some(global) = self.low.builtin_global(BuiltinVariable::FragDepth) {
            members.push(OutputMember {
                name: "depth".to_owned(),
                ty: self.low.value_type(TypeId::FLOAT)?,
                binding: Binding::BuiltIn(BuiltIn::FragDepth),
                source: OutputSource::Depth(global),
            });
        }
        Ok(members)
    }

    /// Returns from the entry point with its outputs.
    pub(super) fn return_outputs(&mut self) -> Try<()> {
        let members = self.outputs.clone();
        let mut values = Vec::with_capacity(members.len());
        for member in &members {
            values.push(self.output(member)?);
        }
        let value = match (values.as_slice(), &self.out.result) {
            ([], _) | (_, None) => None,
            ([only], _) if members.iter().all(|member| !has_blend_source(&member.binding)) => Some(*only),
            (_, Some(result)) => {
                let ty = result.ty;
                Some(self.add(Expression::Compose { ty, components: values }))
            }
        };
        self.statement(Statement::Return { value });
        Ok(())
    }

    fn output(&mut self, member: &OutputMember) -> Try<Handle<Expression>> {
        match &member.source {
            OutputSource::Position => {
                let position = self.position()?;
                if self.corner.is_some() { self.sprite_position(position) } else { Ok(position) }
            }
            OutputSource::PointCoord => match &self.corner {
                Some(corner) => Ok(corner.coordinate),
                None => Err(self.internal_error("a point has no corners")),
            },
            OutputSource::PointNumber => match self.corner.and_then(|corner| corner.number) {
                Some(number) => Ok(number),
                None => Err(self.internal_error("a point has no number")),
            },
            OutputSource::PointSize => match self.low.builtin_global(BuiltinVariable::PointSize) {
                Some(global) => self.output_part(global, 0, TypeId::FLOAT),
                None => Ok(self.float(1.0)),
            },
            OutputSource::Depth(global) => self.output_part(*global, 0, TypeId::FLOAT),
            OutputSource::ClipDistances(global, len) => {
                let mut components = Vec::new();
                for index in 0..*len {
                    components.push(self.output_part(*global, index, TypeId::FLOAT)?);
                }
                Ok(self.add(Expression::Compose { ty: member.ty, components }))
            }
            OutputSource::Nothing => Ok(self.zero(member.ty)),
            OutputSource::Varyings(rows) => self.varyings_at(rows, member.ty),
            OutputSource::Color { global, element, ty } => {
                let size = self.low.types.flat_len(*ty);
                let value = self.output_part(*global, element.unwrap_or(0) * size, *ty)?;
                Ok(self.four_components(value, *ty))
            }
        }
    }

    /// The pointer to an output variable.
    fn output_pointer(&mut self, global: GlobalId) -> Try<Handle<Expression>> {
        match self.low.global_slot(global).clone() {
            GlobalSlot::Private(variable) => Ok(self.global_variable(variable)),
            GlobalSlot::Entry => match self.entry.get(&global) {
                Some(LocalSlot::Pointer(pointer)) => Ok(*pointer),
                _ => Err(self.internal_error("an output has no variable")),
            },
            _ => Err(self.internal_error("an output has no place")),
        }
    }

    /// A scalar or vector of an output variable, by its index in the flat layout.
    pub(super) fn output_part(&mut self, global: GlobalId, flat: u32, part: TypeId) -> Try<Handle<Expression>> {
        let mut pointer = self.output_pointer(global)?;
        let mut ty = self.shader.global(global).ty;
        let mut rest = flat;
        loop {
            let (index, inner) = match self.low.types.get(ty) {
                Type::Array(..) | Type::Matrix(..) => {
                    let inner = self.low.element_type(ty);
                    let size = self.low.types.flat_len(inner).max(1);
                    let index = rest / size;
                    rest %= size;
                    (index, inner)
                }
                Type::Struct(id) => {
                    let members = &self.low.types.structure(id).members;
                    let mut found = None;
                    for (index, member) in members.iter().enumerate() {
                        let size = self.low.types.flat_len(member.ty);
                        if rest < size {
                            found = Some((index as u32, member.ty));
                            break;
                        }
                        rest -= size;
                    }
                    found.ok_or_else(|| self.internal_error("a varying outside of its block"))?
                }
                _ => break,
            };
            pointer = self.add(Expression::AccessIndex { base: pointer, index });
            ty = inner;
        }
        let value = self.load(pointer);
        let (have, want) = (self.size_of(ty), self.size_of(part));
        if have == want && rest == 0 {
            return Ok(value);
        }
        let mut components = [0; 4];
        for (to, from) in components.iter_mut().take(usize::from(want)).zip(rest as u8..) {
            *to = from.min(have - 1);
        }
        Ok(self.swizzled(value, Swizzle { len: want, components }))
    }

    /// All varyings at a location as one scalar or vector; what the stage does not write is 0.
    fn varyings_at(
        &mut self,
        rows: &[(u32, TypeId, Option<VaryingEnd>)],
        ty: Handle<naga::Type>,
    ) -> Try<Handle<Expression>> {
        let used = |end: &VaryingEnd| self.low.facts.used.get(end.global.index()).copied().unwrap_or(false);
        let rows: Vec<_> = rows.iter().map(|(at, ty, end)| (*at, *ty, end.filter(used))).collect();
        if let [(0, row_ty, end)] = rows.as_slice() {
            return match end {
                Some(end) => self.output_part(end.global, end.flat_offset, *row_ty),
                None => Ok(self.zero(ty)),
            };
        }
        let scalar = rows.first().and_then(|row| self.low.types.scalar_of(row.1)).unwrap_or(Scalar::Float);
        let zero = self.literal(match scalar {
            Scalar::Int => ScalarValue::Int(0),
            Scalar::Uint => ScalarValue::Uint(0),
            Scalar::Bool | Scalar::Float => ScalarValue::Float(0.0),
        });
        let mut components = Vec::new();
        let mut at = 0;
        let mut rows = rows;
        rows.sort_by_key(|row| row.0);
        for (component, row_ty, end) in rows {
            while at < component {
                components.push(zero);
                at += 1;
            }
            let len = self.low.types.flat_len(row_ty);
            match end {
                Some(end) => components.push(self.output_part(end.global, end.flat_offset, row_ty)?),
                None => components.extend((0..len).map(|_| zero)),
            }
            at += len;
        }
        Ok(self.add(Expression::Compose { ty, components }))
    }

    /// A color completed to four components from (0, 0, 0, 1), though OpenGL leaves the missing ones undefined.
    fn four_components(&mut self, value: Handle<Expression>, ty: TypeId) -> Handle<Expression> {
        let size = self.size_of(ty);
        if size == 4 {
            return value;
        }
        let scalar = self.low.types.scalar_of(ty).unwrap_or(Scalar::Float);
        let (zero, one) = match scalar {
            Scalar::Int => (ScalarValue::Int(0), ScalarValue::Int(1)),
            Scalar::Uint => (ScalarValue::Uint(0), ScalarValue::Uint(1)),
            Scalar::Bool | Scalar::Float => (ScalarValue::Float(0.0), ScalarValue::Float(1.0)),
        };
        let mut components = vec![value];
        for _ in size..3 {
            components.push(self.literal(zero));
        }
        components.push(self.literal(one));
        let ty = self.low.vector_type(scalar, 4);
        self.add(Expression::Compose { ty, components })
    }

    /// The position, converted to the conventions.
    fn position(&mut self) -> Try<Handle<Expression>> {
        let ty = self.low.value_type(TypeId::VEC4)?;
        let Some(global) = self.low.builtin_global(BuiltinVariable::Position) else { return Ok(self.zero(ty)) };
        let pointer = self.output_pointer(global)?;
        let conventions = self.low.conventions;
        let down = self.low.can().may_count_rows_down && conventions.spirv_env == SpirvEnv::Vulkan;
        let flip = (conventions.window_origin == WindowOrigin::LowerLeft) != down;
        let halve = conventions.clip_z == ClipZ::ZeroToOne;
        if !flip && !halve {
            return Ok(self.load(pointer));
        }
        let mut part = |index| {
            let component = self.add(Expression::AccessIndex { base: pointer, index });
            self.load(component)
        };
        let (x, mut y, mut z, w) = (part(0), part(1), part(2), part(3));
        if flip {
            y = self.add(Expression::Unary { op: UnaryOperator::Negate, expr: y });
        }
        if halve {
            if !self.low.can().repeats_values {
                self.name(w, "w");
            }
            let sum = self.op(BinaryOperator::Add, z, w);
            let half = self.float(0.5);
            z = self.op(BinaryOperator::Multiply, sum, half);
        }
        Ok(self.add(Expression::Compose { ty, components: vec![x, y, z, w] }))
    }
}

/// Whether a color is one of two sources of blending, which only members of structs can be.
fn has_blend_source(binding: &Binding) -> bool {
    matches!(binding, Binding::Location { blend_src: Some(_), .. })
}
