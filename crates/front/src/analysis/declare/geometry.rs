//! Declares the layouts of a geometry shader (§4.3.8.1, §4.3.8.2), and the sizes of its inputs that follow from them.

use super::super::context::Analyzer;
use super::super::layout::Layout;
use super::super::state::ArrayKey;
use crate::builtin::constants;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::qualifiers;
use crate::hir::{ArraySize, GlobalId, PrimitiveIn, PrimitiveOut, Stage, Storage, Type, TypeId};
use crate::source::Span;

impl Analyzer<'_> {
    /// `layout(triangles) in;`: one input primitive, the same in each declaration.
    pub(super) fn geometry_input_layout(&mut self, layout: &Layout, _: Span) {
        if let Some((count, span)) = layout.invocations {
            self.set_invocations(count, span);
        }
        for (index, &(primitive, span)) in layout.inputs.iter().enumerate() {
            if index > 0 {
                self.report(
                    Diagnostic::new(&qualifiers::GEOMETRY_LAYOUT, span, "an input layout names one primitive")
                        .here("one too many"),
                );
                return;
            }
            self.set_input(primitive, span);
        }
    }

    fn set_input(&mut self, primitive: PrimitiveIn, span: Span) {
        if let Some(earlier) = self.shader.geometry.input
            && earlier != primitive
        {
            let at = self.layouts.geometry.input;
            self.report(contradiction(span, at, "input primitive"));
            return;
        }
        let is_first = self.shader.geometry.input.is_none();
        if is_first {
            self.shader.geometry.input = Some(primitive);
            self.layouts.geometry.input = span;
        }
        self.fix_geometry_size(primitive.vertices(), span);
        if is_first {
            self.size_geometry_inputs(primitive.vertices(), span);
        }
    }

    /// `layout(invocations = 4) in;` (GLSL 4.00 §4.3.8.1)
    fn set_invocations(&mut self, count: u32, span: Span) {
        let max = constants::MAX_GEOMETRY_SHADER_INVOCATIONS;
        if !(1..=max).contains(&count) {
            let message = format!("`invocations` cannot be {count}");
            let here = format!("1 to gl_MaxGeometryShaderInvocations, which is {max}");
            self.report(Diagnostic::new(&qualifiers::GEOMETRY_LAYOUT, span, message).here(here));
            return;
        }
        match self.shader.geometry.invocations {
            Some(earlier) if earlier != count => {
                let at = self.layouts.geometry.invocations;
                self.report(contradiction(span, at, "`invocations`"));
            }
            Some(_) => {}
            None => {
                self.shader.geometry.invocations = Some(count);
                self.layouts.geometry.invocations = span;
            }
        }
    }

    /// `layout(triangle_strip, max_vertices = 3) out;`
    pub(super) fn geometry_output_layout(&mut self, layout: &Layout) {
        if let Some(&(primitive, span)) = layout.outputs.last() {
            self.set_output(primitive, span);
        }
        if let Some((count, span)) = layout.max_vertices {
            self.set_max_vertices(count, span);
        }
    }

    fn set_output(&mut self, primitive: PrimitiveOut, span: Span) {
        match self.shader.geometry.output {
            Some(earlier) if earlier != primitive => {
                let at = self.layouts.geometry.output;
                self.report(contradiction(span, at, "output primitive"));
            }
            Some(_) => {}
            None => {
                self.shader.geometry.output = Some(primitive);
                self.layouts.geometry.output = span;
            }
        }
    }

    fn set_max_vertices(&mut self, count: u32, span: Span) {
        let max = constants::MAX_GEOMETRY_OUTPUT_VERTICES;
        if count > max {
            self.report(
                Diagnostic::new(&qualifiers::GEOMETRY_LAYOUT, span, format!("`max_vertices` cannot be {count}"))
                    .here(format!("at most gl_MaxGeometryOutputVertices, which is {max}")),
            );
            return;
        }
        match self.shader.geometry.max_vertices {
            Some(earlier) if earlier != count => {
                let at = self.layouts.geometry.max_vertices;
                self.report(contradiction(span, at, "`max_vertices`"));
            }
            Some(_) => {}
            None => {
                self.shader.geometry.max_vertices = Some(count);
                self.layouts.geometry.max_vertices = span;
            }
        }
    }

    /// The type of a geometry input, with the size if it is known by now. Records the size of an input that has its
    /// own.
    pub(super) fn sized_by_geometry(&mut self, ty: TypeId, storage: Storage, span: Span) -> TypeId {
        if self.stage != Stage::Geometry || storage != Storage::In {
            return ty;
        }
        match self.types.get(ty) {
            Type::Array(element, ArraySize::Unsized) => match self.shader.geometry.input {
                Some(primitive) => self.types.array(element, ArraySize::Sized(primitive.vertices())),
                None => ty,
            },
            Type::Array(_, ArraySize::Sized(size)) => {
                self.fix_geometry_size(size, span);
                ty
            }
            _ => ty,
        }
    }

    /// Checks that all sizes of the inputs and of the layout agree.
    fn fix_geometry_size(&mut self, size: u32, span: Span) {
        match self.layouts.geometry.size {
            Some((earlier, at)) if earlier != size => {
                self.report(
                    Diagnostic::new(
                        &qualifiers::GEOMETRY_INPUT,
                        span,
                        format!("inputs of {size} vertices after inputs of {earlier}"),
                    )
                    .here(format!("this makes it {size}"))
                    .label(at, format!("{earlier} vertices by this")),
                );
            }
            Some(_) => {}
            None => self.layouts.geometry.size = Some((size, span)),
        }
    }

    /// Gives a size to the inputs that were declared before the layout.
    fn size_geometry_inputs(&mut self, size: u32, span: Span) {
        for index in 0..self.shader.globals.len() {
            let id = GlobalId::new(index);
            let global = self.shader.global(id);
            if global.storage != Storage::In {
                continue;
            }
            if let Type::Array(element, ArraySize::Unsized) = self.types.get(global.ty) {
                let ty = self.types.array(element, ArraySize::Sized(size));
                self.check_resize(ArrayKey::Global(id), size, span);
                if let Some(global) = self.shader.globals.get_mut(index) {
                    global.ty = ty;
                }
            }
        }
    }
}

fn contradiction(span: Span, earlier: Span, what: &str) -> Diagnostic {
    Diagnostic::new(&qualifiers::GEOMETRY_LAYOUT, span, format!("two layouts contradict each other in the {what}"))
        .here("another one here")
        .label(earlier, "first declared here")
}
