//! Writes a scene in the explicit core: no meshes, cameras or names of the library.
//!
//! *In:* a [`Scene`], and the file names of each draw's shaders. *Out:* TOML that loads as the same scene.
//! *Holds:* every number reads back as the same bits. What is as by default is left out.

use super::names::{BLENDS, CULLS, FILTERS, FORMATS, FRONT_FACES, PRIMITIVES, PROVOKING, TEXTURE_KINDS};
use crate::model::{
    AttributeData, AttributeValues, Blend, BlendFactor, Compare, Cull, Draw, Filter, Format, Scene, State, Texels,
    Texture, TextureLevel, Wrap,
};
use crate::picture::{Tone, Transfer};
use crate::toml_string::toml_string;
use glisten_front::hir::{SamplerDim, ScalarValue, Stage};
use std::fmt::Write;

/// The file names of a draw's shaders, relative to the scene's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaderFiles {
    /// The vertex shader.
    pub vertex: String,
    /// The geometry shader, if there is one.
    pub geometry: Option<String>,
    /// The fragment shader.
    pub fragment: String,
}

impl ShaderFiles {
    /// The files of a draw, which differ only in their extensions.
    pub fn of(draw: &Draw, stem: &str) -> Self {
        let geometry = draw.program.stage(Stage::Geometry).map(|_| format!("{stem}.geom"));
        Self { vertex: format!("{stem}.vert"), geometry, fragment: format!("{stem}.frag") }
    }
}

/// Writes a scene whose draws have these shaders.
pub fn write(scene: &Scene, files: &[ShaderFiles]) -> String {
    let mut text = String::new();
    let framebuffer = &scene.framebuffer;
    let clear: Vec<String> = framebuffer.clear.iter().map(|value| double(*value)).collect();
    let _ = write!(
        text,
        "[framebuffer]\nwidth = {}\nheight = {}\nclear = [{}]\n",
        framebuffer.width,
        framebuffer.height,
        clear.join(", ")
    );
    if framebuffer.format != Format::Rgba32Float {
        let _ = writeln!(text, "format = {}", toml_string(name_of(FORMATS, framebuffer.format)));
    }
    let encode = framebuffer.encode;
    if encode.exposure != 0.0 {
        let _ = writeln!(text, "exposure = {:?}", encode.exposure);
    }
    if encode.tone != Tone::None {
        let _ = writeln!(text, "tonemap = {}", toml_string(name_of(Tone::NAMES, encode.tone)));
    }
    if encode.transfer != Transfer::Linear {
        let _ = writeln!(text, "encode = {}", toml_string(name_of(Transfer::NAMES, encode.transfer)));
    }
    if framebuffer.attachments != 1 {
        let _ = writeln!(text, "attachments = {}", framebuffer.attachments);
    }
    for (draw, files) in scene.draws.iter().zip(files) {
        let _ = write!(text, "\n[[draw]]\nvertex = {}\n", toml_string(&files.vertex));
        if let Some(geometry) = &files.geometry {
            let _ = writeln!(text, "geometry = {}", toml_string(geometry));
        }
        let _ = writeln!(text, "fragment = {}", toml_string(&files.fragment));
        state(&mut text, &draw.state);
        switches(&mut text, draw);
        counts(&mut text, draw);
        if !draw.dynamic.is_empty() {
            let names: Vec<String> = draw.dynamic.iter().map(|name| toml_string(name)).collect();
            let _ = writeln!(text, "dynamic = [{}]", names.join(", "));
        }
        attributes(&mut text, draw);
        colors(&mut text, draw);
        uniforms(&mut text, draw);
        textures(&mut text, draw);
    }
    text
}

fn name_of<T: PartialEq>(names: &[(&'static str, T)], value: T) -> &'static str {
    names.iter().find(|(_, known)| *known == value).map_or("", |(name, _)| name)
}

fn double(value: f64) -> String {
    match value {
        _ if value.is_nan() => "nan".into(),
        f64::INFINITY => "inf".into(),
        f64::NEG_INFINITY => "-inf".into(),
        // Loaded as an f32, it has a shorter decimal.
        _ if f64::from(value as f32) == value => format!("{:?}", value as f32),
        _ => format!("{value:?}"),
    }
}

/// The shortest decimal that reads back as the same f32.
fn single(value: f32) -> String {
    match value {
        _ if value.is_nan() => "nan".into(),
        f32::INFINITY => "inf".into(),
        f32::NEG_INFINITY => "-inf".into(),
        _ => format!("{value:?}"),
    }
}

fn scalar(value: ScalarValue) -> String {
    match value {
        ScalarValue::Bool(value) => value.to_string(),
        ScalarValue::Int(value) => value.to_string(),
        ScalarValue::Uint(value) => value.to_string(),
        ScalarValue::Float(value) => single(value),
    }
}

fn state(text: &mut String, state: &State) {
    let _ = writeln!(text, "primitive = {}", toml_string(name_of(PRIMITIVES, state.primitive)));
    let mut flag = |key: &str, value: bool, default: bool| {
        if value != default {
            let _ = writeln!(text, "{key} = {value}");
        }
    };
    flag("depth_test", state.depth_test, false);
    flag("depth_write", state.depth_write, true);
    flag("program_point_size", state.program_point_size, false);
    let mut name = |key: &str, differs: bool, value: &str| {
        if differs {
            let _ = writeln!(text, "{key} = {}", toml_string(value));
        }
    };
    name("cull", state.cull != Cull::None, name_of(CULLS, state.cull));
    name("front_face", !state.front_ccw, name_of(FRONT_FACES, state.front_ccw));
    name("provoking", !state.provoking_last, name_of(PROVOKING, state.provoking_last));
    name("depth_func", state.depth_func != Compare::Less, name_of(Compare::NAMES, state.depth_func));
    if let Some(Blend { source, destination, constant }) = state.blend {
        let named = BLENDS.iter().find(|(_, factors)| *factors == state.blend);
        let value = match named {
            Some((name, _)) => toml_string(name),
            None => format!(
                "[{}, {}]",
                toml_string(name_of(BlendFactor::NAMES, source)),
                toml_string(name_of(BlendFactor::NAMES, destination))
            ),
        };
        let _ = writeln!(text, "blend = {value}");
        if constant != [0.0; 4] {
            let _ = writeln!(text, "blend_color = {constant:?}");
        }
    }
    if state.clip_distances > 0 {
        let _ = writeln!(text, "clip_distances = {}", state.clip_distances);
    }
}

/// The switches of the fixed-function pipeline.
fn switches(text: &mut String, draw: &Draw) {
    let Some(fixed) = &draw.fixed else { return };
    if fixed.switches.two_side {
        text.push_str("vertex_program_two_side = true\n");
    }
    if fixed.switches.unclamped_colors {
        text.push_str("clamp_vertex_color = false\n");
    }
}

fn counts(text: &mut String, draw: &Draw) {
    match &draw.indices {
        Some(indices) => {
            let list: Vec<String> = indices.iter().map(u32::to_string).collect();
            let _ = writeln!(text, "indices = [{}]", list.join(", "));
        }
        None => {
            let _ = writeln!(text, "vertex_count = {}", draw.vertex_count);
        }
    }
    if draw.instances != 1 {
        let _ = writeln!(text, "instances = {}", draw.instances);
    }
}

fn attributes(text: &mut String, draw: &Draw) {
    let data = draw.program.interface.attributes.iter().zip(&draw.attributes);
    let given: Vec<(&str, &AttributeData)> =
        data.filter_map(|(attribute, data)| Some((attribute.name.as_str(), data.as_ref()?))).collect();
    if given.is_empty() {
        return;
    }
    text.push_str("[draw.attributes]\n");
    for (name, data) in given {
        let values: Vec<String> = match &data.values {
            AttributeValues::Float(values) => values.iter().map(|value| single(*value)).collect(),
            AttributeValues::Int(values) => values.iter().map(i32::to_string).collect(),
            AttributeValues::Uint(values) => values.iter().map(u32::to_string).collect(),
        };
        let divisor = if data.divisor > 0 { format!("divisor = {}, ", data.divisor) } else { String::new() };
        let _ = writeln!(text, "{name} = {{ size = {}, {divisor}values = [{}] }}", data.size, values.join(", "));
    }
}

/// The color numbers of outputs, where they are not one alone at 0.
fn colors(text: &mut String, draw: &Draw) {
    let outputs = &draw.program.interface.outputs;
    let plain = outputs.len() < 2 && outputs.iter().all(|output| output.location == 0);
    let named: Vec<_> = outputs.iter().filter(|output| !output.name.starts_with("gl_") && output.index == 0).collect();
    if plain || named.is_empty() {
        return;
    }
    text.push_str("[draw.frag_data_locations]\n");
    for output in named {
        let _ = writeln!(text, "{} = {}", output.name, output.location);
    }
}

fn uniforms(text: &mut String, draw: &Draw) {
    let interface = &draw.program.interface;
    if interface.uniforms.is_empty() {
        return;
    }
    text.push_str("[draw.uniforms]\n");
    for leaf in &interface.uniforms {
        let len = draw.program.types.flat_len(leaf.ty) * leaf.array_size.unwrap_or(1);
        let start = leaf.flat_offset as usize;
        let root = draw.uniforms.get(leaf.root.0 as usize);
        let Some(values) = root.and_then(|root| root.get(start..start + len as usize)) else { continue };
        let values: Vec<String> = values.iter().map(|value| scalar(*value)).collect();
        let value =
            if len == 1 && leaf.array_size.is_none() { values.concat() } else { format!("[{}]", values.join(", ")) };
        let _ = writeln!(text, "{} = {value}", toml_string(&leaf.name));
    }
}

fn textures(text: &mut String, draw: &Draw) {
    let slots = draw.program.interface.samplers.iter().zip(&draw.textures);
    let given: Vec<(&str, &Texture)> =
        slots.filter_map(|(slot, texture)| Some((slot.name.as_str(), texture.as_deref()?))).collect();
    if given.is_empty() {
        return;
    }
    text.push_str("[draw.textures]\n");
    for (name, texture) in given {
        let Some(level) = texture.levels.first() else { continue };
        let _ = writeln!(
            text,
            "{} = {{ {}values = [{}] }}",
            toml_string(name),
            texture_keys(texture, level),
            texels(texture, level)
        );
    }
}

fn texture_keys(texture: &Texture, level: &TextureLevel) -> String {
    let kind = texture.kind;
    let mut keys = String::new();
    let _ = write!(keys, "kind = {}, ", toml_string(name_of(TEXTURE_KINDS, (kind.dim, kind.arrayed, kind.shadow))));
    let _ = write!(keys, "width = {}, ", level.width);
    if !matches!(kind.dim, SamplerDim::D1 | SamplerDim::Buffer) {
        let _ = write!(keys, "height = {}, ", level.height);
    }
    if kind.dim == SamplerDim::D3 {
        let _ = write!(keys, "depth = {}, ", level.depth);
    }
    if kind.arrayed {
        let _ = write!(keys, "layers = {}, ", if kind.dim == SamplerDim::Cube { level.depth / 6 } else { level.depth });
    }
    if texture.filter != Filter::Nearest {
        let _ = write!(keys, "filter = {}, ", toml_string(name_of(FILTERS, texture.filter)));
    }
    let default = if kind.dim == SamplerDim::Rect { Wrap::ClampToEdge } else { Wrap::Repeat };
    if texture.wrap != default {
        let _ = write!(keys, "wrap = {}, ", toml_string(name_of(Wrap::NAMES, texture.wrap)));
    }
    if kind.shadow {
        let _ = write!(keys, "compare = {}, ", toml_string(name_of(Compare::NAMES, texture.compare)));
    }
    let sampling = texture.sampling;
    if sampling.lod_bias != 0.0 {
        let _ = write!(keys, "lod_bias = {}, ", single(sampling.lod_bias));
    }
    if sampling.has_two_filters(texture.filter) {
        let name = if sampling.magnifies_linearly(texture.filter) { "linear" } else { "nearest" };
        let _ = write!(keys, "magnify = {}, ", toml_string(name));
    }
    if sampling.fixed_point_depth {
        keys.push_str("fixed_point = true, ");
    }
    match texture.levels.len() {
        samples if kind.dim == SamplerDim::Multisample => {
            let _ = write!(keys, "samples = {samples}, ");
        }
        0 | 1 => {}
        _ => keys.push_str("mipmaps = true, "),
    }
    keys
}

/// The numbers of the first level; of a multisample texture sample by sample within a texel.
fn texels(texture: &Texture, first: &TextureLevel) -> String {
    let n_texels = first.width as usize * first.height as usize * first.depth as usize;
    if texture.kind.dim != SamplerDim::Multisample {
        return (0..n_texels).map(|at| texel(first, at)).collect::<Vec<_>>().join(", ");
    }
    let each = (0..n_texels).flat_map(|at| texture.levels.iter().map(move |sample| texel(sample, at)));
    each.collect::<Vec<_>>().join(", ")
}

fn texel(level: &TextureLevel, at: usize) -> String {
    fn four<T: Copy>(texels: &[[T; 4]], at: usize, write: impl Fn(T) -> String) -> String {
        texels.get(at).map_or_else(String::new, |texel| texel.map(write).join(", "))
    }
    match &level.texels {
        Texels::Float(texels) => four(texels, at, single),
        Texels::Int(texels) => four(texels, at, |value| value.to_string()),
        Texels::Uint(texels) => four(texels, at, |value| value.to_string()),
    }
}
