//! What a draw fixes of its program.
//!
//! *In:* a [`Draw`] and its framebuffer. *Out:* a [`Known`].

use glisten_front::hir::{GlobalId, Scalar, ScalarValue, Stage};
use glisten_front::link::{Interface, UniformLeaf};
use glisten_scene::dynamic::{names_sampler, names_uniform};
use glisten_scene::{AttributeData, Cull, Draw, Filter, Format, Framebuffer, Primitive, Texels, Texture};
use glisten_specialize::{Input, Known, KnownState, KnownTexture};

/// What a draw fixes. What `dynamic` names, of the draw's own list or of this one, is not fixed: a uniform, an element or a
/// member of it, a sampler.
pub fn known(draw: &Draw, framebuffer: &Framebuffer, dynamic: &[String]) -> Known {
    let names: Vec<&str> = draw.dynamic.iter().chain(dynamic).map(String::as_str).collect();
    let interface = &draw.program.interface;
    let mut known = Known { state: state(draw, framebuffer), ..Known::default() };
    if !moves(draw, &names) {
        known.state.interpolation_reach = glisten_reference::interpolation_reach(draw, *framebuffer);
    }
    for leaf in &interface.uniforms {
        if is_dynamic(interface, &names, leaf) {
            continue;
        }
        if let Some(values) = leaf_values(draw, leaf) {
            known.uniforms.insert(leaf.name.clone(), values.to_vec());
        }
    }
    for (attribute, data) in interface.attributes.iter().zip(&draw.attributes) {
        let rows = rows(draw, attribute.columns, draw.program.types.flat_len(attribute.ty));
        let inputs = attribute_inputs(draw, data.as_ref(), rows, attribute.ty);
        known.attributes.insert(attribute.name.clone(), inputs);
    }
    for (slot, texture) in interface.samplers.iter().zip(&draw.textures) {
        if let Some(texture) = texture
            && !names.iter().any(|name| names_sampler(name, &slot.name))
        {
            known.textures.insert(slot.name.clone(), known_texture(texture));
        }
    }
    known
}

/// Whether something that changes from frame to frame reaches the vertex stage, and so perhaps the positions.
fn moves(draw: &Draw, names: &[&str]) -> bool {
    let interface = &draw.program.interface;
    let in_vertex = |globals: &[(Stage, GlobalId)]| globals.iter().any(|(stage, _)| *stage == Stage::Vertex);
    let uniform = interface.uniforms.iter().any(|leaf| {
        let root = interface.roots.get(leaf.root.0 as usize);
        is_dynamic(interface, names, leaf) && root.is_some_and(|root| in_vertex(&root.globals))
    });
    let sampled = |name: &str| names.iter().any(|dynamic| names_sampler(dynamic, name));
    uniform || interface.samplers.iter().any(|slot| sampled(&slot.name) && in_vertex(&slot.globals))
}

fn is_dynamic(interface: &Interface, names: &[&str], leaf: &UniformLeaf) -> bool {
    names.iter().any(|name| names_uniform(interface, name, leaf))
}

/// The scalars of a uniform in a draw.
pub(super) fn leaf_values<'d>(draw: &'d Draw, leaf: &UniformLeaf) -> Option<&'d [ScalarValue]> {
    let len = draw.program.types.flat_len(leaf.ty) * leaf.array_size.unwrap_or(1);
    let start = leaf.flat_offset as usize;
    draw.uniforms.get(leaf.root.0 as usize)?.get(start..start + len as usize)
}

/// Rows of a column of an attribute.
fn rows(draw: &Draw, columns: u32, scalars: u32) -> u32 {
    let _ = draw;
    scalars / columns.max(1)
}

fn state(draw: &Draw, framebuffer: &Framebuffer) -> KnownState {
    let points = draw.state.primitive == Primitive::Points;
    let flat = matches!(
        draw.state.primitive,
        Primitive::Points
            | Primitive::Lines
            | Primitive::LineStrip
            | Primitive::LineLoop
            | Primitive::LinesAdjacency
            | Primitive::LineStripAdjacency
    );
    let front_facing = match draw.state.cull {
        // Points and lines face the front (OpenGL 3.2 §3.9.2).
        _ if flat => Some(true),
        Cull::None => None,
        Cull::Front => Some(false),
        Cull::Back => Some(true),
    };
    let vertices = match &draw.indices {
        Some(indices) => indices.iter().copied().max().map(|last| last.saturating_add(1)),
        None => Some(draw.vertex_count),
    };
    // What a geometry stage reads and emits is its own affair.
    let direct = draw.program.stage(Stage::Geometry).is_none();
    KnownState {
        point_size: direct.then_some(points && draw.state.program_point_size),
        clip_distances: direct.then_some(draw.state.clip_distances),
        front_facing: front_facing.filter(|_| direct),
        attachments: Some(framebuffer.attachments),
        unsigned_colors: match framebuffer.format {
            Format::Rgba8Unorm | Format::Rgba32Sint | Format::Rgba32Uint => true,
            Format::Rgba32Float | Format::Rgba16Float => false,
        },
        depth_test: Some(draw.state.depth_test),
        framebuffer: Some([framebuffer.width, framebuffer.height]),
        vertices,
        instances: Some(draw.instances),
        interpolation_reach: None,
    }
}

/// What is fixed of each scalar of an attribute: one value at all vertices and instances that are drawn, or a range.
fn attribute_inputs(
    draw: &Draw,
    data: Option<&AttributeData>,
    rows: u32,
    ty: glisten_front::hir::TypeId,
) -> Vec<Input> {
    let types = &draw.program.types;
    let len = types.flat_len(ty);
    let Some(data) = data else {
        return (0..len).map(|_| Input::Open).collect();
    };
    let rows = rows.max(1);
    let vertices = Vertices::of(draw, data);
    (0..len).map(|scalar| one_input(data, &vertices, scalar / rows, rows, scalar % rows)).collect()
}

/// The rows of data that a draw reads.
enum Vertices {
    /// A row a vertex.
    Each(Vec<u32>),
    /// A row every few instances.
    Instances(u32),
}

impl Vertices {
    fn of(draw: &Draw, data: &AttributeData) -> Self {
        if data.divisor > 0 {
            return Self::Instances(draw.instances);
        }
        Self::Each(match &draw.indices {
            Some(indices) => {
                let mut used = indices.clone();
                used.sort_unstable();
                used.dedup();
                used
            }
            None => (0..draw.vertex_count).collect(),
        })
    }
}

fn one_input(data: &AttributeData, vertices: &Vertices, column: u32, rows: u32, row: u32) -> Input {
    let values: Box<dyn Iterator<Item = ScalarValue>> = match vertices {
        Vertices::Each(list) => Box::new(list.iter().map(move |vertex| data.fetch(*vertex, 0, column, rows, row))),
        Vertices::Instances(count) => Box::new((0..*count).map(move |one| data.fetch(0, one, column, rows, row))),
    };
    hull(values)
}

/// One value, or the range of several; open where one of them is not finite.
fn hull(mut values: impl Iterator<Item = ScalarValue>) -> Input {
    let Some(first) = values.next() else { return Input::Open };
    let (mut same, mut low, mut high) = (true, f32::INFINITY, f32::NEG_INFINITY);
    let (mut finite, mut signed) = (true, false);
    for value in std::iter::once(first).chain(values) {
        match (value, first) {
            (ScalarValue::Float(value), ScalarValue::Float(first)) => {
                same &= value.to_bits() == first.to_bits();
                finite &= value.is_finite();
                signed |= value == 0.0 && value.is_sign_negative();
                (low, high) = (low.min(value), high.max(value));
            }
            _ => same &= value == first,
        }
    }
    match first {
        _ if same && finite => Input::Value(first),
        ScalarValue::Float(_) if finite && signed => Input::Between(low, high),
        ScalarValue::Float(_) if finite => Input::Unsigned(low, high),
        _ if same && first.scalar() != Scalar::Float => Input::Value(first),
        _ => Input::Open,
    }
}

fn known_texture(texture: &Texture) -> KnownTexture {
    let kind = texture.kind;
    let sizes = texture
        .levels
        .iter()
        .map(|level| {
            use glisten_front::hir::SamplerDim::{Buffer, Cube, D1, D2, D3, Multisample, Rect};
            match (kind.dim, kind.arrayed) {
                (D1, true) => Some([level.width, level.depth.max(level.height), 1]),
                (D2, true) => Some([level.width, level.height, level.depth]),
                // Six faces a layer.
                (Cube, true) => Some([level.width, level.height, level.depth / 6]),
                (D1, false) => Some([level.width, 1, 1]),
                (D2 | Cube | Rect, _) => Some([level.width, level.height, 1]),
                (D3, _) => Some([level.width, level.height, level.depth]),
                // The target decides how many samples or rows there are.
                (Buffer | Multisample, _) => None,
            }
        })
        .collect::<Option<Vec<_>>>();
    // The result of a comparison depends on its reference value.
    let channels = if kind.shadow { [Input::Between(0.0, 1.0); 4] } else { channels(texture) };
    let mixes = texture.filter != Filter::Nearest || texture.sampling.magnifies_linearly(texture.filter);
    let channels = if mixes { channels.map(mixed) } else { channels };
    KnownTexture { sizes: sizes.unwrap_or_default(), channels }
}

/// What a filter makes of the values of a channel by weights that add up to 1. A sum of terms of which one is -0 may be 0 of
/// either sign, and so may what is left of a small negative number.
fn mixed(channel: Input) -> Input {
    match channel {
        Input::Value(ScalarValue::Float(value)) if value == 0.0 && value.is_sign_negative() => {
            Input::Between(value, value)
        }
        Input::Unsigned(low, high) if low < 0.0 => Input::Between(low, high),
        channel => channel,
    }
}

fn channels(texture: &Texture) -> [Input; 4] {
    [0, 1, 2, 3].map(|channel| {
        let values = texture.levels.iter().flat_map(move |level| -> Box<dyn Iterator<Item = ScalarValue>> {
            match &level.texels {
                Texels::Float(texels) => Box::new(texels.iter().map(move |texel| ScalarValue::Float(texel[channel]))),
                Texels::Int(texels) => Box::new(texels.iter().map(move |texel| ScalarValue::Int(texel[channel]))),
                Texels::Uint(texels) => Box::new(texels.iter().map(move |texel| ScalarValue::Uint(texel[channel]))),
            }
        });
        hull(values)
    })
}
