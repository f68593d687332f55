//! [`Layouts`]: layouts and redeclarations that concern the whole shader, with their spans.

use crate::hir::{BlockLayout, MatrixLayout};
use crate::source::Span;

/// `layout(...) uniform;`: the defaults that later blocks inherit.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::analysis) struct BlockDefaults {
    pub(in crate::analysis) layout: BlockLayout,
    pub(in crate::analysis) matrix: MatrixLayout,
}

/// The spans of the first layouts of a geometry shader.
#[derive(Debug, Default)]
pub(in crate::analysis) struct GeometrySpans {
    pub(in crate::analysis) input: Span,
    pub(in crate::analysis) output: Span,
    pub(in crate::analysis) max_vertices: Span,
    pub(in crate::analysis) invocations: Span,
    /// The number of vertices of all inputs, and what fixed it: the input layout, or the size of an input.
    pub(in crate::analysis) size: Option<(u32, Span)>,
}

/// A redeclaration of `gl_PerVertex`.
#[derive(Clone, Debug)]
pub(in crate::analysis) struct PerVertex {
    pub(in crate::analysis) span: Span,
    /// The names of its members.
    pub(in crate::analysis) members: Vec<String>,
}

/// Layouts and redeclarations so far.
#[derive(Debug, Default)]
pub(in crate::analysis) struct Layouts {
    /// `layout(...) uniform;`
    pub(in crate::analysis) block_defaults: BlockDefaults,
    pub(in crate::analysis) geometry: GeometrySpans,
    /// The output block `gl_PerVertex`, if it is redeclared.
    pub(in crate::analysis) per_vertex_out: Option<PerVertex>,
    /// The first redeclaration of `gl_FragCoord`.
    pub(in crate::analysis) frag_coord: Option<Span>,
    /// The first redeclaration of `gl_FragDepth`, with the names in its layouts, sorted.
    pub(in crate::analysis) frag_depth: Option<(Vec<String>, Span)>,
    /// `layout(early_fragment_tests) in;`
    pub(in crate::analysis) early_tests: Option<Span>,
}
