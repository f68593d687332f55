//! Layout qualifiers (§4.3.8): one row per identifier, with the declarations that accept it.

use super::context::Analyzer;
use super::qualifiers::Qualifiers;
use crate::diagnostic::codes::general::NOT_SUPPORTED_YET;
use crate::diagnostic::codes::qualifiers;
use crate::diagnostic::{Advice, Applicability, Diagnostic, Severity, did_you_mean};
use crate::hir::{BlockLayout, MatrixLayout, PrimitiveIn, PrimitiveOut};
use crate::language::{Extensions, Feature, NEVER, Since, Version};
use crate::source::Span;
use crate::syntax::NOT_YET;
use crate::syntax::ast::{ExprKind as AstExprKind, LayoutId, Literal};
use crate::syntax::of_version;
use crate::syntax::warning_of_use;

/// The declaration that a layout qualifier applies to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LayoutSubject {
    /// An input of a vertex shader.
    VertexInput,
    /// `gl_FragCoord`.
    FragCoord,
    /// An output of a fragment shader.
    FragmentOutput,
    /// A sampler.
    Sampler,
    /// A uniform block.
    UniformBlock,
    /// A member of a uniform block.
    UniformMember,
    /// `layout(..) uniform;`
    UniformDefault,
    /// `layout(..) in;` of a geometry shader.
    GeometryIn,
    /// `layout(..) out;` of a geometry shader.
    GeometryOut,
    /// `layout(..) in;` of a fragment shader.
    FragmentIn,
    /// An input of a stage after the first, or an output of a stage before the last.
    Varying,
    /// A block of such inputs or outputs.
    VaryingBlock,
    /// A member of such a block.
    VaryingMember,
    /// A uniform outside of blocks, other than a sampler.
    Uniform,
    /// `gl_FragDepth`.
    FragDepth,
    /// A struct without a variable.
    Struct,
    /// Any other declaration, with its description.
    Other(&'static str),
}

impl LayoutSubject {
    fn name(self) -> &'static str {
        match self {
            Self::VertexInput => "a vertex shader's input",
            Self::FragCoord => "`gl_FragCoord`",
            Self::FragmentOutput => "a fragment shader's output",
            Self::Sampler => "a sampler",
            Self::UniformBlock => "a uniform block",
            Self::UniformMember => "a member of a uniform block",
            Self::UniformDefault => "`uniform` alone",
            Self::GeometryIn => "`in` alone, in a geometry shader",
            Self::GeometryOut => "`out` alone, in a geometry shader",
            Self::FragmentIn => "`in` alone, in a fragment shader",
            Self::Varying => "an input or output between stages",
            Self::VaryingBlock => "an input or output block",
            Self::VaryingMember => "a member of an input or output block",
            Self::Uniform => "a uniform outside a block",
            Self::FragDepth => "`gl_FragDepth`",
            Self::Struct => "a struct",
            Self::Other(name) => name,
        }
    }
}

/// The effect of a layout identifier.
#[derive(Clone, Copy, Debug)]
enum Effect {
    Location,
    Component,
    Offset,
    Align,
    Index,
    Binding,
    OriginUpperLeft,
    PixelCenterInteger,
    Block(BlockLayout),
    Matrix(MatrixLayout),
    In(PrimitiveIn),
    Out(PrimitiveOut),
    /// `points` is both an input and an output primitive.
    Points,
    MaxVertices,
    Invocations,
    EarlyTests,
    /// The location of a uniform.
    HostLocation,
    /// A bound of a depth, which changes no value.
    Nothing,
}

struct Row {
    name: &'static str,
    effect: Effect,
    value: bool,
    subjects: &'static [LayoutSubject],
    since: Since,
    extensions: Extensions,
}

use LayoutSubject::{
    FragCoord, FragDepth, FragmentIn, FragmentOutput, GeometryIn, GeometryOut, Sampler, Uniform, UniformBlock,
    UniformDefault, UniformMember, Varying, VaryingBlock, VaryingMember, VertexInput,
};

const fn row(name: &'static str, effect: Effect, subjects: &'static [LayoutSubject]) -> Row {
    Row { name, effect, value: false, subjects, extensions: Extensions::empty(), since: Since::new(150, 320) }
}

const fn since(desktop: u16, es: u16, extensions: Extensions, row: Row) -> Row {
    Row { extensions, since: Since::new(desktop, es), ..row }
}

const fn valued(row: Row) -> Row {
    Row { value: true, ..row }
}

const LOCATION: Extensions = Extensions::EXPLICIT_ATTRIB_LOCATION;
const BLOCKS: Extensions = Extensions::UNIFORM_BUFFER_OBJECT;
const PACK: Extensions = Extensions::SHADING_LANGUAGE_420PACK;
const SEPARATE: Extensions = Extensions::SEPARATE_SHADER_OBJECTS;
const UNIFORM_LOCATION: Extensions = Extensions::EXPLICIT_UNIFORM_LOCATION;
const COORD: Extensions = Extensions::FRAGMENT_COORD_CONVENTIONS;
const LAYOUTS: Extensions = Extensions::ENHANCED_LAYOUTS;
const DEPTH: Extensions = Extensions::CONSERVATIVE_DEPTH;
const BLOCK_PLACES: &[LayoutSubject] = &[UniformBlock, UniformDefault];
const MATRIX_PLACES: &[LayoutSubject] = &[UniformBlock, UniformDefault, UniformMember];

static ROWS: &[Row] = &[
    valued(since(330, 300, LOCATION, row("location", Effect::Location, &[VertexInput, FragmentOutput]))),
    valued(since(410, 310, SEPARATE, row("location", Effect::Location, &[Varying]))),
    valued(since(
        440,
        NEVER,
        Extensions::ENHANCED_LAYOUTS,
        row("location", Effect::Location, &[VaryingBlock, VaryingMember]),
    )),
    valued(since(440, NEVER, LAYOUTS, row("component", Effect::Component, &[Varying, VaryingMember]))),
    valued(since(440, NEVER, LAYOUTS, row("offset", Effect::Offset, &[UniformMember]))),
    valued(since(440, NEVER, LAYOUTS, row("align", Effect::Align, &[UniformBlock, UniformMember]))),
    valued(since(430, 310, UNIFORM_LOCATION, row("location", Effect::HostLocation, &[Uniform, Sampler]))),
    valued(since(330, NEVER, LOCATION, row("index", Effect::Index, &[FragmentOutput]))),
    valued(since(420, 310, PACK, row("binding", Effect::Binding, &[Sampler, UniformBlock]))),
    since(150, NEVER, COORD, row("origin_upper_left", Effect::OriginUpperLeft, &[FragCoord])),
    since(150, NEVER, COORD, row("pixel_center_integer", Effect::PixelCenterInteger, &[FragCoord])),
    since(420, NEVER, DEPTH, row("depth_any", Effect::Nothing, &[FragDepth])),
    since(420, NEVER, DEPTH, row("depth_greater", Effect::Nothing, &[FragDepth])),
    since(420, NEVER, DEPTH, row("depth_less", Effect::Nothing, &[FragDepth])),
    since(420, NEVER, DEPTH, row("depth_unchanged", Effect::Nothing, &[FragDepth])),
    since(140, 300, BLOCKS, row("shared", Effect::Block(BlockLayout::Shared), BLOCK_PLACES)),
    since(140, 300, BLOCKS, row("packed", Effect::Block(BlockLayout::Packed), BLOCK_PLACES)),
    since(140, 300, BLOCKS, row("std140", Effect::Block(BlockLayout::Std140), BLOCK_PLACES)),
    since(140, 300, BLOCKS, row("row_major", Effect::Matrix(MatrixLayout::RowMajor), MATRIX_PLACES)),
    since(140, 300, BLOCKS, row("column_major", Effect::Matrix(MatrixLayout::ColumnMajor), MATRIX_PLACES)),
    since(420, 310, Extensions::empty(), row("early_fragment_tests", Effect::EarlyTests, &[FragmentIn])),
    row("points", Effect::Points, &[GeometryIn, GeometryOut]),
    row("lines", Effect::In(PrimitiveIn::Lines), &[GeometryIn]),
    row("lines_adjacency", Effect::In(PrimitiveIn::LinesAdjacency), &[GeometryIn]),
    row("triangles", Effect::In(PrimitiveIn::Triangles), &[GeometryIn]),
    row("triangles_adjacency", Effect::In(PrimitiveIn::TrianglesAdjacency), &[GeometryIn]),
    row("line_strip", Effect::Out(PrimitiveOut::LineStrip), &[GeometryOut]),
    row("triangle_strip", Effect::Out(PrimitiveOut::TriangleStrip), &[GeometryOut]),
    valued(row("max_vertices", Effect::MaxVertices, &[GeometryOut])),
    valued(since(400, 320, Extensions::GPU_SHADER5, row("invocations", Effect::Invocations, &[GeometryIn]))),
];

/// Identifiers that no declaration of glisten's takes, with the version that brought each.
static LATER: &[(&str, Since)] = &[
    ("vertices", Since::new(400, 320)),
    ("quads", Since::new(400, 320)),
    ("isolines", Since::new(400, 320)),
    ("equal_spacing", Since::new(400, 320)),
    ("fractional_even_spacing", Since::new(400, 320)),
    ("fractional_odd_spacing", Since::new(400, 320)),
    ("cw", Since::new(400, 320)),
    ("ccw", Since::new(400, 320)),
    ("point_mode", Since::new(400, 320)),
    ("stream", Since::new(400, NEVER)),
    ("local_size_x", Since::new(430, 310)),
    ("local_size_y", Since::new(430, 310)),
    ("local_size_z", Since::new(430, 310)),
    ("xfb_buffer", Since::new(440, NEVER)),
    ("xfb_offset", Since::new(440, NEVER)),
    ("xfb_stride", Since::new(440, NEVER)),
    ("std430", Since::new(430, 310)),
    ("bindless_sampler", Since::NEVER),
    ("set", Since::NEVER),
    ("push_constant", Since::NEVER),
    ("constant_id", Since::NEVER),
    ("input_attachment_index", Since::NEVER),
];

/// The formats of images, which are not supported.
#[rustfmt::skip]
static IMAGE_FORMATS: &[(&str, Since)] = &[
    ("rgba32f", Since::new(420, 310)), ("rgba16f", Since::new(420, 310)), ("r32f", Since::new(420, 310)),
    ("rgba8", Since::new(420, 310)), ("rgba8_snorm", Since::new(420, 310)), ("rgba32i", Since::new(420, 310)),
    ("rgba16i", Since::new(420, 310)), ("rgba8i", Since::new(420, 310)), ("r32i", Since::new(420, 310)),
    ("rgba32ui", Since::new(420, 310)), ("rgba16ui", Since::new(420, 310)), ("rgba8ui", Since::new(420, 310)),
    ("r32ui", Since::new(420, 310)), ("rg32f", Since::new(420, NEVER)), ("rg16f", Since::new(420, NEVER)),
    ("r11f_g11f_b10f", Since::new(420, NEVER)), ("r16f", Since::new(420, NEVER)), ("rgba16", Since::new(420, NEVER)),
    ("rgb10_a2", Since::new(420, NEVER)), ("rg16", Since::new(420, NEVER)), ("rg8", Since::new(420, NEVER)),
    ("r16", Since::new(420, NEVER)), ("r8", Since::new(420, NEVER)), ("rgba16_snorm", Since::new(420, NEVER)),
    ("rg16_snorm", Since::new(420, NEVER)), ("rg8_snorm", Since::new(420, NEVER)), ("r16_snorm", Since::new(420, NEVER)),
    ("r8_snorm", Since::new(420, NEVER)), ("rg32i", Since::new(420, NEVER)), ("rg16i", Since::new(420, NEVER)),
    ("rg8i", Since::new(420, NEVER)), ("r16i", Since::new(420, NEVER)), ("r8i", Since::new(420, NEVER)),
    ("rgb10_a2ui", Since::new(420, NEVER)), ("rg32ui", Since::new(420, NEVER)), ("rg16ui", Since::new(420, NEVER)),
    ("rg8ui", Since::new(420, NEVER)), ("r16ui", Since::new(420, NEVER)), ("r8ui", Since::new(420, NEVER)),
];

/// The contents of a `layout(...)`.
#[derive(Clone, Debug, Default)]
pub(super) struct Layout {
    pub(super) location: Option<(u32, Span)>,
    /// Of a uniform.
    pub(super) host_location: Option<(u32, Span)>,
    pub(super) component: Option<(u32, Span)>,
    pub(super) offset: Option<(u32, Span)>,
    pub(super) align: Option<(u32, Span)>,
    pub(super) index: Option<(u32, Span)>,
    pub(super) binding: Option<(u32, Span)>,
    pub(super) origin_upper_left: bool,
    pub(super) pixel_center_integer: bool,
    pub(super) block: Option<BlockLayout>,
    pub(super) matrix: Option<MatrixLayout>,
    /// Each input primitive, in source order: `layout(points, lines)`.
    pub(super) inputs: Vec<(PrimitiveIn, Span)>,
    pub(super) outputs: Vec<(PrimitiveOut, Span)>,
    pub(super) max_vertices: Option<(u32, Span)>,
    pub(super) invocations: Option<(u32, Span)>,
    /// `early_fragment_tests`
    pub(super) early_tests: Option<Span>,
    /// Whether every identifier is one that the declaration may have. All others have been reported.
    pub(super) is_known: bool,
}

impl Analyzer<'_> {
    /// Evaluates the layout identifiers of a declaration. Each must be known, enabled, and allowed for this
    /// declaration; later ones override earlier ones.
    pub(super) fn layout(&mut self, qualifiers: &Qualifiers, subject: LayoutSubject) -> Layout {
        let mut layout = Layout { is_known: true, ..Layout::default() };
        for id in &qualifiers.layout {
            let row = self.layout_row(id, subject);
            layout.is_known &= row.is_some();
            if let Some(row) = row {
                let value = if row.value { self.layout_value(id) } else { Some((0, id.name.span)) };
                if let Some((value, span)) = value {
                    if let (Effect::Location, Some((_, first))) = (row.effect, layout.location)
                        && self.ast.version.has(Feature::OneLocation)
                    {
                        self.repeated(&qualifiers::REPEATED, first, span, "`location`");
                    }
                    layout.apply(row.effect, subject, value, span);
                }
            }
        }
        layout
    }

    fn layout_row(&mut self, id: &LayoutId, subject: LayoutSubject) -> Option<&'static Row> {
        let spelling = self.name(id.name);
        // In 1.50 the identifiers are not case-sensitive.
        let named = || ROWS.iter().filter(|row| row.name.eq_ignore_ascii_case(spelling));
        let Some(row) = named().find(|row| row.subjects.contains(&subject)).or_else(|| named().next()) else {
            let is_format = IMAGE_FORMATS.iter().any(|row| row.0 == spelling && self.ast.version.reaches(row.1));
            // The image that has a format is not supported, which is reported there.
            if is_format && !matches!(subject, Uniform | Sampler) {
                let message = format!("`{spelling}` is not allowed before {}", subject.name());
                let finding = Diagnostic::new(&qualifiers::LAYOUT_PLACE, id.name.span, message);
                self.report(finding.here("not allowed here").help("the format of an image belongs before an image"));
            } else if !is_format {
                self.report(unknown(spelling, id.name.span, self.ast.version));
            }
            return None;
        };
        if !self.allows_layout(row, spelling, id.name.span) {
            return None;
        }
        if row.name == "component" && matches!(subject, VertexInput | FragmentOutput) {
            let message = format!("`component` of {} is not supported yet", subject.name());
            self.report(Diagnostic::new(&NOT_SUPPORTED_YET, id.name.span, message));
            return None;
        }
        if subject == LayoutSubject::Struct && matches!(row.effect, Effect::Block(_) | Effect::Matrix(_)) {
            self.report_layout_of_struct(spelling, id.name.span);
            return None;
        }
        if !row.subjects.contains(&subject) {
            let subjects: Vec<_> = named().take(1).flat_map(|row| row.subjects).map(|subject| subject.name()).collect();
            self.report(
                Diagnostic::new(
                    &qualifiers::LAYOUT_PLACE,
                    id.name.span,
                    format!("`{spelling}` is not allowed before {}", subject.name()),
                )
                .here("not allowed here")
                .help(format!("it belongs before {}", subjects.join(" or "))),
            );
            return None;
        }
        if row.value == id.value.is_some() {
            return Some(row);
        }
        let message =
            if row.value { format!("`{spelling}` needs a value") } else { format!("`{spelling}` takes no value") };
        let help = row.value.then(|| Advice::write(Applicability::Unsafe, format!("{} = 0", row.name)));
        self.report(Diagnostic::new(&qualifiers::LAYOUT_VALUE, id.name.span, message).maybe_help(help));
        None
    }

    /// `layout(std140) struct S { .. };`
    fn report_layout_of_struct(&mut self, spelling: &str, span: Span) {
        let message = format!("`{spelling}` before a struct has no effect");
        let mut finding = Diagnostic::new(&qualifiers::LAYOUT_OF_STRUCT, span, message)
            .here("ignored")
            .help("it belongs before the block that has the struct");
        if self.strict {
            finding.severity = Severity::Error;
        }
        self.report(finding);
    }

    /// Whether the language has a layout identifier; if not, that is reported.
    fn allows_layout(&mut self, row: &Row, spelling: &str, span: Span) -> bool {
        let version = self.ast.version;
        if version.reaches(row.since) {
            return true;
        }
        if let Some(warning) = warning_of_use(self.extensions, row.extensions, span) {
            self.report(warning);
        }
        if self.extensions.intersects(row.extensions) {
            return true;
        }
        let message = format!("`{spelling}` in a layout is not in this version");
        let finding = Diagnostic::new(&qualifiers::NEEDS_EXTENSION, span, message).maybe_help(version.remedy(
            row.since,
            Since::NEVER,
            row.extensions,
        ));
        self.report(of_version(finding, version));
        false
    }

    /// The value after `=`, a non-negative integer: a literal, and from 4.40 on any constant expression.
    fn layout_value(&mut self, id: &LayoutId) -> Option<(u32, Span)> {
        let root = id.value?;
        let expr = self.ast.expr(root);
        let value = match &expr.kind {
            AstExprKind::Literal(Literal::Int(value)) if !id.parenthesized => u32::try_from(*value).ok(),
            AstExprKind::Literal(Literal::Uint(value)) if !id.parenthesized => Some(*value),
            AstExprKind::Error(_) => return None,
            _ if self.allows(Feature::LayoutExpressions, expr.span) => {
                let typed = self.expr(root);
                if self.ty(typed).is_error() {
                    return None;
                }
                self.evaluate_integer(typed).and_then(|value| u32::try_from(value).ok())
            }
            _ => None,
        };
        if value.is_none() {
            let spelling = self.name(id.name);
            self.report(
                Diagnostic::new(
                    &qualifiers::LAYOUT_VALUE,
                    expr.span,
                    format!("the value of `{spelling}` is an integer literal, zero or more"),
                )
                .here("not an integer literal"),
            );
        }
        value.map(|value| (value, expr.span))
    }
}

impl Layout {
    fn apply(&mut self, effect: Effect, subject: LayoutSubject, value: u32, span: Span) {
        match effect {
            Effect::Location => self.location = Some((value, span)),
            Effect::HostLocation => self.host_location = Some((value, span)),
            Effect::Component => self.component = Some((value, span)),
            Effect::Offset => self.offset = Some((value, span)),
            Effect::Align => self.align = Some((value, span)),
            Effect::Index => self.index = Some((value, span)),
            Effect::Binding => self.binding = Some((value, span)),
            Effect::OriginUpperLeft => self.origin_upper_left = true,
            Effect::PixelCenterInteger => self.pixel_center_integer = true,
            Effect::Block(layout) => self.block = Some(layout),
            Effect::Matrix(layout) => self.matrix = Some(layout),
            Effect::In(primitive) => self.inputs.push((primitive, span)),
            Effect::Out(primitive) => self.outputs.push((primitive, span)),
            Effect::Points if subject == GeometryIn => self.inputs.push((PrimitiveIn::Points, span)),
            Effect::Points => self.outputs.push((PrimitiveOut::Points, span)),
            Effect::MaxVertices => self.max_vertices = Some((value, span)),
            Effect::Invocations => self.invocations = Some((value, span)),
            Effect::EarlyTests => self.early_tests = Some(span),
            Effect::Nothing => {}
        }
    }
}

/// The first version of a source's family that has a layout.
fn came_with(spelling: &str, since: Since, version: Version) -> Option<String> {
    let (family, number) = if version.is_es() { ("GLSL ES", since.es) } else { ("GLSL", since.desktop) };
    (number != NEVER).then(|| format!("`{spelling}` came with {family} {}.{:02}", number / 100, number % 100))
}

fn unknown(spelling: &str, span: Span, version: Version) -> Diagnostic {
    let named = |list: &'static [(&'static str, Since)]| list.iter().find(|row| row.0.eq_ignore_ascii_case(spelling));
    let later = named(LATER).or_else(|| named(IMAGE_FORMATS));
    let help = match later {
        Some(&(_, since)) if version.reaches(since) => {
            return Diagnostic::new(&NOT_SUPPORTED_YET, span, format!("the layout `{spelling}` is not supported yet"));
        }
        Some(&(_, Since::NEVER)) => Some(format!("`{spelling}` belongs to GLSL 4.50 for Vulkan").into()),
        Some(&(_, since)) => {
            came_with(spelling, since, version).map(|sentence| Advice::from(format!("{sentence}; {NOT_YET}")))
        }
        None => did_you_mean(spelling, ROWS.iter().map(|row| row.name)).map(Advice::meant),
    };
    Diagnostic::new(&qualifiers::UNKNOWN_LAYOUT, span, format!("`{spelling}` is not a layout identifier"))
        .here("not known in this version")
        .maybe_help(help)
}
