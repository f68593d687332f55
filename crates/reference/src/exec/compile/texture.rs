//! Compiles calls of texture functions (§8.7), by the roles of their arguments.

use super::super::inst::{Class, Float2, Inst, Lookup, Operand, TextureCall};
use super::{Compiler, Val};
use glisten_front::builtin::operations::{TextureArgument, TextureForm};
use glisten_front::hir::{Type, TypeId};

impl Compiler<'_> {
    pub(super) fn texture_call(&mut self, form: TextureForm, values: &[Val], sampler: TypeId, ty: TypeId) -> Val {
        let (Type::Sampler(kind), Some(slot)) =
            (self.types.get(sampler), values.first().and_then(|value| value.first()).copied())
        else {
            // The analysis has checked that the first argument is a sampler.
            return Val::new();
        };
        if form.offsets {
            return self.gather_offsets(form, values, sampler, ty);
        }
        let mut call = TextureCall {
            lookup: form.lookup,
            kind,
            sampler: self.emit.in_register(Class::Int, slot),
            coordinate: Vec::new(),
            reference: None,
            level: None,
            dx: Vec::new(),
            dy: Vec::new(),
            offset: Vec::new(),
            component: None,
            results: Vec::new(),
        };
        for (role, value) in form.arguments(kind).into_iter().zip(values.iter().skip(1)) {
            match role {
                TextureArgument::Coordinate => self.coordinates(&mut call, form.projective, value),
                TextureArgument::Level | TextureArgument::Bias | TextureArgument::Sample => {
                    call.level = value.first().copied();
                }
                TextureArgument::GradientX => call.dx = value.to_vec(),
                TextureArgument::GradientY => call.dy = value.to_vec(),
                TextureArgument::Offset | TextureArgument::Offsets => call.offset = value.to_vec(),
                TextureArgument::Reference => call.reference = value.first().copied(),
                TextureArgument::Component => call.component = value.first().copied(),
            }
        }
        self.finish(call, ty)
    }

    /// `textureGatherOffsets`: the last component, i0 j0, of a gather with each of four offsets (GLSL 4.00 §8.9.3).
    fn gather_offsets(&mut self, form: TextureForm, values: &[Val], sampler: TypeId, ty: TypeId) -> Val {
        let Type::Sampler(kind) = self.types.get(sampler) else { return Val::new() };
        let place = form.arguments(kind).iter().position(|role| *role == TextureArgument::Offsets);
        let one = TextureForm { offset: true, offsets: false, ..form };
        let offsets = place.and_then(|place| values.get(place + 1)).cloned().unwrap_or_default();
        let mut result = Val::new();
        for offset in offsets.chunks(2) {
            let mut values = values.to_vec();
            if let Some(slot) = place.and_then(|place| values.get_mut(place + 1)) {
                *slot = Val::from_slice(offset);
            }
            result.extend(self.texture_call(one, &values, sampler, ty).last().copied());
        }
        result
    }

    /// Compiles the projection, the layer, and the reference of a shadow sampler.
    fn coordinates(&mut self, call: &mut TextureCall, projective: bool, value: &[Operand]) {
        let kind = call.kind;
        let size = usize::from(kind.dimensions()) + usize::from(kind.arrayed);
        let mut used: Vec<Operand> = value.iter().take(size).copied().collect();
        let mut reference = value.get(usize::from(kind.reference_component())).copied().filter(|_| kind.shadow);
        if projective && let Some(q) = value.last().copied() {
            used.iter_mut().chain(&mut reference).for_each(|operand| *operand = self.float2(Float2::Div, *operand, q));
        }
        call.coordinate = used;
        call.reference = reference;
    }

    /// Moves the operands to registers and appends the instruction.
    fn finish(&mut self, mut call: TextureCall, ty: TypeId) -> Val {
        let emit = &mut self.emit;
        call.visit(&mut |class, _, operand| *operand = emit.in_register(class, *operand));
        let class = if call.has_integer_results() { Class::Int } else { Class::Float };
        let count = match call.lookup {
            Lookup::Size | Lookup::QueryLod | Lookup::Levels => self.types.flat_len(ty) as usize,
            Lookup::Gather => 4,
            _ if call.kind.shadow => 1,
            _ => 4,
        };
        call.results = (0..count).map(|_| self.emit.temp(class)).collect();
        let mut results = Val::from_slice(&call.results);
        self.emit.textures.push(call);
        let index = self.emit.textures.len() as u32 - 1;
        self.emit.push(Inst::Texture { call: index });
        if count == 1 && self.types.flat_len(ty) == 4 {
            // `shadow2D` and its like of older versions.
            let (zero, one) = (self.emit.float(0.0), self.emit.float(1.0));
            let mode = self.shader.depth_mode;
            results = results.first().into_iter().flat_map(|r| mode.components(*r, zero, one)).collect();
        }
        results
    }
}
