//! [`Place`]: what an l-value (§5.8), or a chain of members and elements, denotes.

use super::function::Ctx;
use super::slots::{GlobalSlot, HostId, LocalSlot};
use super::types::vector_size;
use super::uniforms::HostKind;
use super::{Try, internal};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{
    ArraySize, ExprId, ExprKind, LocalKind, MatrixLayout, Scalar, ScalarValue, Storage, Swizzle, Type, TypeId, VarRef,
};
use naga::{Expression, Handle, SwizzleComponent};

/// Where a value is stored.
#[derive(Clone, Debug)]
pub(super) enum Place {
    /// Behind a pointer, in the representation of values.
    Pointer(Handle<Expression>, TypeId),
    /// Behind a pointer, in the representation of uniform memory.
    Host(Handle<Expression>, HostId),
    /// The first components of a `vec4` in uniform memory: an element of an array.
    Wide(Handle<Expression>, TypeId),
    /// Not stored: a value.
    Value(Handle<Expression>, TypeId),
    /// An array of uniform blocks that is not indexed yet.
    Blocks(Vec<Handle<naga::GlobalVariable>>, HostId),
    /// Components of a vector behind a pointer.
    Swizzle(Handle<Expression>, TypeId, Swizzle),
}

impl Ctx<'_, '_> {
    /// The place of an l-value, or of a chain that is read; evaluates the indices.
    pub(super) fn place(&mut self, id: ExprId) -> Try<Place> {
        let expr = self.shader.expr(id);
        match &expr.kind {
            ExprKind::Var(var) => self.variable_place(*var, expr.ty),
            ExprKind::Member(base, member) => {
                let base_ty = self.shader.expr(*base).ty;
                let base = self.place(*base)?;
                self.member_place(base, base_ty, *member)
            }
            ExprKind::Index(base, index) => {
                let base = self.place(*base)?;
                self.element_place(base, *index)
            }
            ExprKind::Swizzle(base, swizzle) => {
                let base = self.place(*base)?;
                self.swizzle_place(base, *swizzle)
            }
            _ => {
                let value = self.value(id)?;
                Ok(Place::Value(value, expr.ty))
            }
        }
    }

    fn variable_place(&mut self, var: VarRef, ty: TypeId) -> Try<Place> {
        let slot = match var {
            VarRef::Local(local) => self.slot(local),
            VarRef::Global(global) => match self.low.global_slot(global).clone() {
                GlobalSlot::Loose { variable, member, host } => {
                    let base = self.global_variable(variable);
                    let pointer = self.add(Expression::AccessIndex { base, index: member });
                    return Ok(Place::Host(pointer, host));
                }
                GlobalSlot::Block { variables, host, arrayed } => {
                    return match variables.first() {
                        Some(variable) if !arrayed => Ok(Place::Host(self.global_variable(*variable), host)),
                        _ => Ok(Place::Blocks(variables, host)),
                    };
                }
                GlobalSlot::Private(variable) => return Ok(Place::Pointer(self.global_variable(variable), ty)),
                GlobalSlot::Constant(constant) => return Ok(Place::Value(self.module_constant(constant), ty)),
                GlobalSlot::Entry => self.entry.get(&global).cloned().unwrap_or(LocalSlot::Unset),
                GlobalSlot::Unused => LocalSlot::Unset,
            },
        };
        match slot {
            LocalSlot::Pointer(pointer) => Ok(Place::Pointer(pointer, ty)),
            LocalSlot::Value(value) => Ok(Place::Value(value, ty)),
            LocalSlot::Unset => self.constant_place(var, ty),
        }
    }

    /// The place of a constant: its value, or a variable if it is indexed by a variable.
    fn constant_place(&mut self, var: VarRef, ty: TypeId) -> Try<Place> {
        let shader = self.shader;
        if let VarRef::Global(id) = var
            && shader.global(id).builtin == Some(BuiltinVariable::DepthRange)
        {
            // The near and far plane and their difference (§7.5). WebGPU's and Vulkan's viewports have [0, 1] unless
            // a host says otherwise, and no target passes them to the shader.
            let (near, far) = (self.float(0.0), self.float(1.0));
            let naga_ty = self.low.value_type(ty)?;
            let value = self.add(Expression::Compose { ty: naga_ty, components: vec![near, far, far] });
            return Ok(Place::Value(value, ty));
        }
        let (name, value, indexed) = match var {
            VarRef::Local(id) => {
                let local = shader.function(self.id).local(id);
                let facts = self.low.facts.function(self.id);
                let indexed = facts.and_then(|facts| facts.needs_variable.get(id.index()).copied());
                (&local.name, local.value.as_ref().filter(|_| local.kind == LocalKind::Const), indexed)
            }
            VarRef::Global(id) => {
                let global = shader.global(id);
                let indexed = self.low.facts.indexed.get(id.index()).copied();
                (&global.name, global.value.as_ref().filter(|_| global.storage == Storage::Const), indexed)
            }
        };
        let Some(value) = value else {
            return Err(internal(self.here(), format!("`{name}` has no place in this stage")));
        };
        let handle = self.named_constant(var, name, value, indexed == Some(true))?;
        Ok(match self.expressions()[handle] {
            Expression::GlobalVariable(_) => Place::Pointer(handle, ty),
            _ => Place::Value(handle, ty),
        })
    }

    pub(super) fn member_place(&mut self, base: Place, base_ty: TypeId, member: u32) -> Try<Place> {
        let ty = self.low.member_type(base_ty, member);
        match base {
            Place::Pointer(base, _) => Ok(Place::Pointer(self.member(base, base_ty, member)?, ty)),
            Place::Value(base, _) => Ok(Place::Value(self.member(base, base_ty, member)?, ty)),
            Place::Host(base, host) => {
                let HostKind::Struct(members) = self.low.host(host).kind.clone() else {
                    // The type in memory is the type of the value.
                    return Ok(Place::Pointer(self.member(base, base_ty, member)?, ty));
                };
                match members.get(member as usize).copied().flatten() {
                    Some((index, host)) => Ok(Place::Host(self.add(Expression::AccessIndex { base, index }), host)),
                    None => Err(self.internal_error("this member has no place in memory")),
                }
            }
            Place::Wide(..) | Place::Blocks(..) | Place::Swizzle(..) => {
                Err(self.internal_error("a struct was expected"))
            }
        }
    }

    fn member(&mut self, base: Handle<Expression>, ty: TypeId, member: u32) -> Try<Handle<Expression>> {
        match self.low.member_index(ty, member) {
            Some(index) => Ok(self.add(Expression::AccessIndex { base, index })),
            None => Err(self.internal_error("this member has no value")),
        }
    }

    fn element_place(&mut self, base: Place, index: ExprId) -> Try<Place> {
        match base {
            Place::Pointer(base, ty) => {
                let element = self.low.element_type(ty);
                Ok(Place::Pointer(self.access(base, ty, index)?, element))
            }
            Place::Value(base, ty) => self.value_element(base, ty, index),
            Place::Blocks(variables, host) => {
                let index = self.constant_index(index)?;
                match variables.get(index as usize) {
                    Some(variable) => Ok(Place::Host(self.global_variable(*variable), host)),
                    None => Err(self.internal_error("an element of this array of blocks has no binding")),
                }
            }
            Place::Host(base, host) => self.host_element(base, host, index),
            Place::Wide(base, ty) => {
                let value = self.load_place(&Place::Wide(base, ty))?;
                self.value_element(value, ty, index)
            }
            Place::Swizzle(base, ty, swizzle) => {
                // `v.zx[i]`: a component of the swizzle is a component of the vector.
                if let Some(index) = self.literal_index(index) {
                    let component = swizzle.as_slice().get(index as usize).copied().unwrap_or(0);
                    let pointer = self.add(Expression::AccessIndex { base, index: u32::from(component) });
                    return Ok(Place::Pointer(pointer, self.low.element_type(ty)));
                }
                let index = self.swizzled_index(index, swizzle)?;
                let pointer = self.add(Expression::Access { base, index });
                Ok(Place::Pointer(pointer, self.low.element_type(ty)))
            }
        }
    }

    /// The component of the vector that component `index` of the swizzle selects, for an index known only at run
    /// time.
    fn swizzled_index(&mut self, index: ExprId, swizzle: Swizzle) -> Try<Handle<Expression>> {
        let index = self.index_value(index)?;
        let index = self.convert_index(index, swizzle.len);
        let components: Vec<_> = (0..4)
            .map(|at| i32::from(swizzle.components.get(at).copied().unwrap_or(0)))
            .map(|component| self.int(component))
            .collect();
        let ty = self.low.vector_type(Scalar::Int, 4);
        let table = self.add(Expression::Compose { ty, components });
        Ok(self.add(Expression::Access { base: table, index }))
    }

    /// Clamps an index to a vector's size, which the writers' bounds checks do not do on every target.
    fn convert_index(&mut self, index: Handle<Expression>, len: u8) -> Handle<Expression> {
        let zero = self.int(0);
        let last = self.int(i32::from(len) - 1);
        self.add(Expression::Math {
            fun: naga::MathFunction::Clamp,
            arg: index,
            arg1: Some(zero),
            arg2: Some(last),
            arg3: None,
        })
    }

    /// The index as an `int`.
    fn index_value(&mut self, index: ExprId) -> Try<Handle<Expression>> {
        let value = self.value(index)?;
        if self.low.types.get(self.shader.expr(index).ty) == Type::Scalar(Scalar::Uint) {
            return Ok(self.add(Expression::As { expr: value, kind: naga::ScalarKind::Sint, convert: Some(4) }));
        }
        Ok(value)
    }

    /// The index, if it is constant and not negative.
    pub(super) fn literal_index(&self, index: ExprId) -> Option<u32> {
        match self.low.constant_of(self.id, index)? {
            ScalarValue::Int(index) => u32::try_from(index).ok(),
            ScalarValue::Uint(index) => Some(index),
            ScalarValue::Bool(_) | ScalarValue::Float(_) => None,
        }
    }

    fn len_of(&self, ty: TypeId) -> u32 {
        match self.low.types.get(ty) {
            Type::Array(_, ArraySize::Sized(len)) => len,
            Type::Matrix(columns, _) => u32::from(columns),
            Type::Vector(_, size) => u32::from(size),
            _ => 0,
        }
    }

    /// `base[index]` of a pointer or value. A constant index out of bounds reads the last element, since targets
    /// reject it and GLSL leaves it undefined.
    pub(super) fn access(&mut self, base: Handle<Expression>, ty: TypeId, index: ExprId) -> Try<Handle<Expression>> {
        if let Some(index) = self.literal_index(index) {
            let index = index.min(self.len_of(ty).saturating_sub(1));
            return Ok(self.add(Expression::AccessIndex { base, index }));
        }
        let index = self.value(index)?;
        Ok(self.add(Expression::Access { base, index }))
    }

    fn value_element(&mut self, base: Handle<Expression>, ty: TypeId, index: ExprId) -> Try<Place> {
        let element = self.low.element_type(ty);
        if self.literal_index(index).is_some() || matches!(self.low.types.get(ty), Type::Vector(..)) {
            return Ok(Place::Value(self.access(base, ty, index)?, element));
        }
        // naga cannot index a matrix value with a variable, and its SPIR-V writer copies an array for each index:
        // copy it once.
        let variable = self.variable_of("indexed", ty)?;
        self.store(variable, base);
        let pointer = self.access(variable, ty, index)?;
        let value = self.load(pointer);
        Ok(Place::Value(value, element))
    }

    fn host_element(&mut self, base: Handle<Expression>, host: HostId, index: ExprId) -> Try<Place> {
        let ty = self.low.host(host).ty;
        let element = self.low.element_type(ty);
        match self.low.host(host).kind.clone() {
            HostKind::Value => Ok(Place::Pointer(self.access(base, ty, index)?, element)),
            HostKind::Array { element: inner, wide } => {
                let pointer = self.access(base, ty, index)?;
                Ok(if wide { Place::Wide(pointer, element) } else { Place::Host(pointer, inner) })
            }
            HostKind::WideColumns => Ok(Place::Wide(self.access(base, ty, index)?, element)),
            HostKind::Bits => {
                let pointer = self.access(base, ty, index)?;
                let host = self.low.host_of(TypeId::BOOL, MatrixLayout::ColumnMajor)?;
                Ok(Place::Host(pointer, host))
            }
            HostKind::Rows | HostKind::WideRows => {
                let value = self.column_of_rows(base, ty, index)?;
                Ok(Place::Value(value, element))
            }
            HostKind::Struct(_) => Err(self.internal_error("an array was expected")),
        }
    }

    /// A column of a `row_major` matrix: one component from each row.
    fn column_of_rows(&mut self, base: Handle<Expression>, ty: TypeId, index: ExprId) -> Try<Handle<Expression>> {
        let Type::Matrix(columns, rows) = self.low.types.get(ty) else {
            return Err(self.internal_error("a matrix was expected"));
        };
        let row_ty = TypeId::vector(Scalar::Float, columns);
        let dynamic = match self.literal_index(index) {
            Some(_) => None,
            None => Some(self.value(index)?),
        };
        let mut components = Vec::new();
        for row in 0..u32::from(rows) {
            let row = self.add(Expression::AccessIndex { base, index: row });
            let pointer = match dynamic {
                Some(index) => self.add(Expression::Access { base: row, index }),
                None => self.access(row, row_ty, index)?,
            };
            components.push(self.load(pointer));
        }
        let ty = self.low.vector_type(Scalar::Float, rows);
        Ok(self.add(Expression::Compose { ty, components }))
    }

    fn swizzle_place(&mut self, base: Place, swizzle: Swizzle) -> Try<Place> {
        let single = (swizzle.len == 1).then(|| u32::from(swizzle.components[0]));
        match (base, single) {
            (Place::Pointer(base, ty), Some(index)) => {
                let component = self.low.element_type(ty);
                Ok(Place::Pointer(self.add(Expression::AccessIndex { base, index }), component))
            }
            (Place::Pointer(base, ty), None) => Ok(Place::Swizzle(base, ty, swizzle)),
            (Place::Swizzle(base, ty, inner), _) => {
                let mut components = [0; 4];
                for (to, from) in components.iter_mut().zip(swizzle.as_slice()) {
                    *to = inner.as_slice().get(usize::from(*from)).copied().unwrap_or(0);
                }
                self.swizzle_place(Place::Pointer(base, ty), Swizzle { len: swizzle.len, components })
            }
            (base, _) => {
                let ty = self.place_type(&base);
                let value = self.load_place(&base)?;
                let scalar = self.low.types.scalar_of(ty).unwrap_or(Scalar::Float);
                let swizzled = self.swizzled(value, swizzle);
                Ok(Place::Value(swizzled, TypeId::vector(scalar, swizzle.len)))
            }
        }
    }

    /// Swizzled components of a vector value.
    pub(super) fn swizzled(&mut self, vector: Handle<Expression>, swizzle: Swizzle) -> Handle<Expression> {
        if swizzle.len == 1 {
            return self.add(Expression::AccessIndex { base: vector, index: u32::from(swizzle.components[0]) });
        }
        let pattern = swizzle.components.map(|component| match component {
            0 => SwizzleComponent::X,
            1 => SwizzleComponent::Y,
            2 => SwizzleComponent::Z,
            _ => SwizzleComponent::W,
        });
        self.add(Expression::Swizzle { size: vector_size(swizzle.len), vector, pattern })
    }

    /// The first components of a vector value.
    pub(super) fn first_components(&mut self, vector: Handle<Expression>, len: u8) -> Handle<Expression> {
        self.swizzled(vector, Swizzle { len, components: [0, 1, 2, 3] })
    }

    fn place_type(&self, place: &Place) -> TypeId {
        match place {
            Place::Pointer(_, ty) | Place::Value(_, ty) | Place::Wide(_, ty) => *ty,
            Place::Host(_, host) | Place::Blocks(_, host) => self.low.host(*host).ty,
            Place::Swizzle(_, ty, swizzle) => {
                TypeId::vector(self.low.types.scalar_of(*ty).unwrap_or(Scalar::Float), swizzle.len)
            }
        }
    }

    /// Reads from a place.
    pub(super) fn load_place(&mut self, place: &Place) -> Try<Handle<Expression>> {
        match place {
            Place::Value(value, _) => Ok(*value),
            Place::Pointer(pointer, _) => Ok(self.load(*pointer)),
            Place::Host(pointer, host) => self.load_host(*pointer, *host),
            Place::Wide(pointer, ty) => self.load_wide(*pointer, *ty),
            Place::Swizzle(pointer, _, swizzle) => {
                let vector = self.load(*pointer);
                Ok(self.swizzled(vector, *swizzle))
            }
            Place::Blocks(..) => Err(self.internal_error("an array of blocks has no value")),
        }
    }

    /// A scalar or short vector at the start of a `vec4`.
    fn load_wide(&mut self, pointer: Handle<Expression>, ty: TypeId) -> Try<Handle<Expression>> {
        let (scalar, size) = match self.low.types.get(ty) {
            Type::Scalar(scalar) => (scalar, 1),
            Type::Vector(scalar, size) => (scalar, size),
            _ => return Err(self.internal_error("only scalars and vectors can be in a `vec4`")),
        };
        let loaded = if size == 1 {
            let component = self.add(Expression::AccessIndex { base: pointer, index: 0 });
            self.load(component)
        } else {
            let vector = self.load(pointer);
            self.first_components(vector, size)
        };
        Ok(if scalar == Scalar::Bool { self.bits_to_bool(loaded, size) } else { loaded })
    }

    /// Converts `u32` in memory to `bool`.
    fn bits_to_bool(&mut self, bits: Handle<Expression>, size: u8) -> Handle<Expression> {
        let zero = self.uint(0);
        let right = self.splat(zero, size);
        self.add(Expression::Binary { op: naga::BinaryOperator::NotEqual, left: bits, right })
    }

    /// Reads a value from uniform memory.
    pub(super) fn load_host(&mut self, pointer: Handle<Expression>, host: HostId) -> Try<Handle<Expression>> {
        let ty = self.low.host(host).ty;
        match self.low.host(host).kind.clone() {
            HostKind::Value => Ok(self.load(pointer)),
            HostKind::Bits => {
                let bits = self.load(pointer);
                let size = self.len_of(ty).max(1) as u8;
                Ok(self.bits_to_bool(bits, size))
            }
            HostKind::Rows => {
                let rows = self.load(pointer);
                Ok(self.transpose(rows))
            }
            HostKind::WideColumns => {
                let value_ty = self.low.value_type(ty)?;
                self.load_lines(pointer, value_ty, self.len_of(ty))
            }
            HostKind::WideRows => {
                let Type::Matrix(columns, rows) = self.low.types.get(ty) else {
                    return Err(self.internal_error("a matrix was expected"));
                };
                let transposed = self.low.matrix_type(rows, columns);
                let lines = self.load_lines(pointer, transposed, u32::from(rows))?;
                Ok(self.transpose(lines))
            }
            HostKind::Struct(members) => {
                let mut components = Vec::new();
                for (index, host) in members.into_iter().flatten() {
                    let pointer = self.add(Expression::AccessIndex { base: pointer, index });
                    components.push(self.load_host(pointer, host)?);
                }
                let ty = self.low.value_type(ty)?;
                Ok(self.add(Expression::Compose { ty, components }))
            }
            HostKind::Array { element, wide } => self.load_array(pointer, ty, element, wide),
        }
    }

    /// A matrix whose columns or rows, of two components each, are stored as `vec4`s.
    fn load_lines(
        &mut self,
        pointer: Handle<Expression>,
        ty: Handle<naga::Type>,
        lines: u32,
    ) -> Try<Handle<Expression>> {
        let mut components = Vec::new();
        for index in 0..lines {
            let line = self.add(Expression::AccessIndex { base: pointer, index });
            components.push(self.load_wide(line, TypeId::VEC2)?);
        }
        Ok(self.add(Expression::Compose { ty, components }))
    }

    fn load_array(
        &mut self,
        pointer: Handle<Expression>,
        ty: TypeId,
        element: HostId,
        wide: bool,
    ) -> Try<Handle<Expression>> {
        /// Longer arrays are read with a loop: each element would take a line of text.
        const UNROLLED: u32 = 16;
        let len = self.len_of(ty);
        let element_ty = self.low.host(element).ty;
        let value_ty = self.low.value_type(ty)?;
        let read = |ctx: &mut Self, pointer| {
            if wide { ctx.load_wide(pointer, element_ty) } else { ctx.load_host(pointer, element) }
        };
        if len <= UNROLLED {
            let mut components = Vec::new();
            for index in 0..len {
                let pointer = self.add(Expression::AccessIndex { base: pointer, index });
                components.push(read(self, pointer)?);
            }
            return Ok(self.add(Expression::Compose { ty: value_ty, components }));
        }
        let copy = self.variable("elements", value_ty);
        self.count_to(len, |ctx, index| {
            let from = ctx.add(Expression::Access { base: pointer, index });
            let value = read(ctx, from)?;
            let to = ctx.add(Expression::Access { base: copy, index });
            ctx.store(to, value);
            Ok(())
        })?;
        Ok(self.load(copy))
    }

    /// A vector in memory with other values of some components.
    fn with_components(
        &mut self,
        pointer: Handle<Expression>,
        ty: TypeId,
        swizzle: Swizzle,
        value: Handle<Expression>,
    ) -> Try<Handle<Expression>> {
        let size = u32::from(self.size_of(ty));
        let order = swizzle.as_slice();
        let first = order.first().map_or(0, |first| u32::from(*first));
        let in_order = order.iter().zip(first..).all(|(component, expected)| u32::from(*component) == expected);
        let mut components = Vec::new();
        for index in 0..size {
            match order.iter().position(|component| u32::from(*component) == index) {
                Some(from) if !in_order => {
                    components.push(self.add(Expression::AccessIndex { base: value, index: from as u32 }));
                }
                Some(0) => components.push(value),
                Some(_) => {}
                None => {
                    let component = self.add(Expression::AccessIndex { base: pointer, index });
                    components.push(self.load(component));
                }
            }
        }
        if let ([whole], true) = (components.as_slice(), in_order) {
            return Ok(*whole);
        }
        let ty = self.low.value_type(ty)?;
        Ok(self.add(Expression::Compose { ty, components }))
    }

    /// Writes to an l-value.
    pub(super) fn store_place(&mut self, place: &Place, value: Handle<Expression>) -> Try<()> {
        match place {
            Place::Pointer(pointer, _) => self.store(*pointer, value),
            // One store of the whole vector is shorter than one for each component.
            Place::Swizzle(pointer, ty, swizzle) if !self.low.can().stores_components && swizzle.len > 1 => {
                let whole = self.with_components(*pointer, *ty, *swizzle, value)?;
                self.store(*pointer, whole);
            }
            Place::Swizzle(pointer, _, swizzle) => {
                for (from, to) in swizzle.as_slice().iter().enumerate() {
                    let component = self.add(Expression::AccessIndex { base: value, index: from as u32 });
                    let pointer = self.add(Expression::AccessIndex { base: *pointer, index: u32::from(*to) });
                    self.store(pointer, component);
                }
            }
            Place::Host(..) | Place::Wide(..) | Place::Value(..) | Place::Blocks(..) => {
                return Err(self.internal_error("this cannot be written to"));
            }
        }
        Ok(())
    }
}
