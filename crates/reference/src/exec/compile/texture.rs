//! Calls of texture functions (§8.7): which argument means what.

use super::super::inst::{Class, Float2, Inst, Lookup, Operand, TextureCall};
use super::{Compiler, Val};
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::diagnostic::codes;
use glisten_front::hir::{SamplerDim, Scalar, Type, TypeId};
use glisten_front::source::Span;

/// The arguments of a texture function behind sampler and coordinate.
struct Shape {
    lookup: Lookup,
    projected: bool,
    /// Arguments in order.
    rest: &'static [Rest],
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Rest {
    Level,
    Gradients,
    Offset,
    /// A bias that may be left out.
    Bias,
}

fn shape(function: F) -> Option<Shape> {
    use Lookup::{Fetch, Grad, Implicit, Lod};
    use Rest::{Bias, Gradients, Level, Offset};
    let (lookup, projected, rest): (_, _, &'static [Rest]) = match function {
        F::Texture => (Implicit, false, &[Bias]),
        F::TextureProj => (Implicit, true, &[Bias]),
        F::TextureLod => (Lod, false, &[Level]),
        F::TextureOffset => (Implicit, false, &[Offset, Bias]),
        F::TexelFetch => (Fetch, false, &[Level]),
        F::TexelFetchOffset => (Fetch, false, &[Level, Offset]),
        F::TextureProjOffset => (Implicit, true, &[Offset, Bias]),
        F::TextureLodOffset => (Lod, false, &[Level, Offset]),
        F::TextureProjLod => (Lod, true, &[Level]),
        F::TextureProjLodOffset => (Lod, true, &[Level, Offset]),
        F::TextureGrad => (Grad, false, &[Gradients]),
        F::TextureGradOffset => (Grad, false, &[Gradients, Offset]),
        F::TextureProjGrad => (Grad, true, &[Gradients]),
        F::TextureProjGradOffset => (Grad, true, &[Gradients, Offset]),
        _ => return None,
    };
    Some(Shape { lookup, projected, rest })
}

/// Coordinates that address a texel, without the layer.
pub(super) fn dimensions(dim: SamplerDim) -> usize {
    match dim {
        SamplerDim::D1 | SamplerDim::Buffer => 1,
        SamplerDim::D2 | SamplerDim::Rect | SamplerDim::Multisample => 2,
        SamplerDim::D3 | SamplerDim::Cube => 3,
    }
}

impl Compiler<'_> {
    pub(super) fn texture_call(&mut self, function: F, values: &[Val], sampler: TypeId, ty: TypeId, span: Span) -> Val {
        let (Type::Sampler(kind), Some(slot)) =
            (self.types.get(sampler), values.first().and_then(|value| value.first()).copied())
        else {
            self.refuse(&codes::general::NOT_SUPPORTED_YET, span, &format!("`{}`", function.name()));
            return Val::new();
        };
        if kind.dim == SamplerDim::Multisample {
            self.refuse(&codes::general::NOT_SUPPORTED_YET, span, &format!("a `{}`", kind.name()));
            return Val::new();
        }
        let mut call = TextureCall {
            lookup: Lookup::Size,
            kind,
            sampler: self.emit.in_register(Class::Int, slot),
            coordinate: Vec::new(),
            reference: None,
            level: None,
            dx: Vec::new(),
            dy: Vec::new(),
            offset: Vec::new(),
            results: Vec::new(),
        };
        if function == F::TextureSize {
            call.level = values.get(1).and_then(|level| level.first()).copied();
        } else if let Some(shape) = shape(function) {
            self.coordinates(&mut call, &shape, values.get(1).map_or(&[], |value| value));
            self.further(&mut call, &shape, values.get(2..).unwrap_or(&[]));
        } else {
            self.refuse(&codes::general::NOT_SUPPORTED_YET, span, &format!("`{}`", function.name()));
        }
        self.finish(call, ty)
    }

    /// Projection, layer, and the reference of a shadow sampler.
    fn coordinates(&mut self, call: &mut TextureCall, shape: &Shape, value: &[Operand]) {
        let kind = call.kind;
        call.lookup = shape.lookup;
        let size = dimensions(kind.dim) + usize::from(kind.arrayed);
        let mut used: Vec<Operand> = value.iter().take(size).copied().collect();
        // A 1D shadow sampler leaves the second component unused.
        let mut reference = value.get(size.max(2)).copied().filter(|_| kind.shadow);
        if shape.projected
            && let Some(q) = value.last().copied()
        {
            used.iter_mut().chain(&mut reference).for_each(|operand| *operand = self.float2(Float2::Div, *operand, q));
        }
        call.coordinate = used;
        call.reference = reference;
    }

    fn further(&mut self, call: &mut TextureCall, shape: &Shape, values: &[Val]) {
        // Rectangle and buffer textures have one level: `texelFetch` has no argument for it.
        let levels = !matches!(call.kind.dim, SamplerDim::Rect | SamplerDim::Buffer);
        let mut values = values.iter();
        for rest in shape.rest {
            if *rest == Rest::Level && !levels && shape.lookup == Lookup::Fetch {
                continue;
            }
            let Some(value) = values.next() else { continue };
            match rest {
                Rest::Level | Rest::Bias => call.level = value.first().copied(),
                Rest::Offset => call.offset = value.to_vec(),
                Rest::Gradients => {
                    call.dx = value.to_vec();
                    call.dy = values.next().map(|value| value.to_vec()).unwrap_or_default();
                }
            }
        }
    }

    /// Puts the operands into registers and appends the instruction.
    fn finish(&mut self, mut call: TextureCall, ty: TypeId) -> Val {
        let emit = &mut self.emit;
        call.visit(&mut |class, _, operand| *operand = emit.in_register(class, *operand));
        let integer = call.lookup == Lookup::Size || (call.kind.texel != Scalar::Float && !call.kind.shadow);
        let class = if integer { Class::Int } else { Class::Float };
        let count = match call.lookup {
            Lookup::Size => self.types.flat_len(ty) as usize,
            _ if call.kind.shadow => 1,
            _ => 4,
        };
        call.results = (0..count).map(|_| self.emit.temp(class)).collect();
        let mut results = Val::from_slice(&call.results);
        self.emit.textures.push(call);
        let index = self.emit.textures.len() as u32 - 1;
        self.emit.push(Inst::Texture { call: index });
        if count == 1 && self.types.flat_len(ty) == 4 {
            // `shadow2D` of older versions: luminance, and alpha 1.
            let (r, one) = (results.first().copied(), self.emit.float(1.0));
            results = r.into_iter().flat_map(|r| [r, r, r, one]).collect();
        }
        results
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_texture_function_has_a_shape() {
        let start = F::ALL.iter().position(|function| *function == F::Texture).unwrap_or(0);
        for function in F::ALL.iter().skip(start).take_while(|function| **function != F::DFdx) {
            assert!(shape(*function).is_some(), "{}", function.name());
        }
    }
}
