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
        let (shader, places) = (&mut self.shader.geometry, &mut self.layouts.geometry);
        match set_once(&mut shader.input, &mut places.input, primitive, span) {
            Ok(Set::First) => {
                self.fix_geometry_size(primitive.vertices(), span);
                self.size_geometry_inputs(primitive.vertices(), span);
            }
            Ok(Set::Again) => self.fix_geometry_size(primitive.vertices(), span),
            Err(at) => self.report(contradiction(span, at, "input primitive")),
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
        let (shader, places) = (&mut self.shader.geometry, &mut self.layouts.geometry);
        if let Err(at) = set_once(&mut shader.invocations, &mut places.invocations, count, span) {
            self.report(contradiction(span, at, "`invocations`"));
        }
    }

    /// `layout(triangle_strip, max_vertices = 3) out;`
    pub(super) fn geometry_output_layout(&mut self, layout: &Layout) {
        // "One declaration can declare either a primitive type (points, line_strip, or triangle_strip), or max_vertices" (§4.3.8.2).
        for &(primitive, span) in &layout.outputs {
            self.set_output(primitive, span);
        }
        if let Some((count, span)) = layout.max_vertices {
            self.set_max_vertices(count, span);
        }
    }

    fn set_output(&mut self, primitive: PrimitiveOut, span: Span) {
        let (shader, places) = (&mut self.shader.geometry, &mut self.layouts.geometry);
        if let Err(at) = set_once(&mut shader.output, &mut places.output, primitive, span) {
            self.report(contradiction(span, at, "output primitive"));
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
        let (shader, places) = (&mut self.shader.geometry, &mut self.layouts.geometry);
        if let Err(at) = set_once(&mut shader.max_vertices, &mut places.max_vertices, count, span) {
            self.report(contradiction(span, at, "`max_vertices`"));
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

/// How a layout sets a value that all layouts must agree on.
enum Set {
    First,
    Again,
}

/// Sets a value, or says where another one was set.
fn set_once<T: PartialEq>(slot: &mut Option<T>, place: &mut Span, value: T, span: Span) -> Result<Set, Span> {
    match slot {
        Some(earlier) if *earlier != value => Err(*place),
        Some(_) => Ok(Set::Again),
        None => {
            (*slot, *place) = (Some(value), span);
            Ok(Set::First)
        }
    }
}

fn contradiction(span: Span, earlier: Span, what: &str) -> Diagnostic {
    Diagnostic::new(&qualifiers::GEOMETRY_LAYOUT, span, format!("two layouts contradict each other in the {what}"))
        .here("another one here")
        .label(earlier, "first declared here")
}
