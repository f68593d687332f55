//! [`Plan`]: a scene as the calls of WebGPU that draw it.
//!
//! *In:* a scene without geometry stages. *Out:* one JSON object and bytes. *Holds:* the object's parts are the dictionaries of the
//! specification of WebGPU, by its names, so that a host passes them on; `bytes` is a place: an offset and a length. Programs are WGSL.

use crate::bindings::{self, Binding, What, bindings, conventions};
use crate::states::{color_format, depth_stencil, primitive_state};
use crate::texels::{depths, texel_bytes, texel_format};
use crate::texture_extent::extent;
use crate::vertices::{self, Rows};
use crate::visibility::Visibility;
use crate::words::{dimension, format, word};
use crate::{Error, assembly, beyond, slots, sprites, uniforms};
use glisten_emit::{Conventions, Emitted, Target, emit};
use glisten_front::hir::{SamplerDim, SamplerType, Stage};
use glisten_front::link::{Program, SlotBinding};
use glisten_scene::{Draw, Framebuffer, Scene, Texture};
use serde_json::{Value, json};
use std::sync::Arc;
use wgpu_types as wgpu;

/// The calls that draw a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// The dictionaries.
    pub calls: Value,
    /// The bytes that they refer to.
    pub bytes: Vec<u8>,
}

impl Plan {
    /// The plan of a scene.
    ///
    /// # Errors
    /// WebGPU lacks something that the scene needs, or WGSL does.
    pub fn of(scene: &Scene) -> Result<Self, Error> {
        Self::with(scene, &mut Written::default())
    }

    /// The plan of a scene, with the programs that were written for the last ones.
    ///
    /// # Errors
    /// WebGPU lacks something that the scene needs, or WGSL does.
    pub fn with(scene: &Scene, written: &mut Written) -> Result<Self, Error> {
        let framebuffer = &scene.framebuffer;
        let mut bytes = Bytes::default();
        let draws: Vec<Value> =
            scene.draws.iter().map(|draw| planned(framebuffer, draw, &mut bytes, written)).collect::<Result<_, _>>()?;
        let calls = json!({
            "width": framebuffer.width,
            "height": framebuffer.height,
            "format": format(color_format(framebuffer.format)),
            "pixelSize": crate::states::pixel_size(framebuffer.format),
            "attachments": framebuffer.attachments,
            "clear": framebuffer.clear,
            "draws": draws,
        });
        Ok(Self { calls, bytes: bytes.all })
    }
}

/// Bytes, each part at a multiple of 16.
#[derive(Default)]
struct Bytes {
    all: Vec<u8>,
    /// The places of textures' levels, which several draws may share: by the texture's address, the level and the format.
    known: Vec<((usize, usize, wgpu::TextureFormat), Value)>,
}

impl Bytes {
    fn add(&mut self, part: &[u8]) -> Value {
        self.all.resize(self.all.len().next_multiple_of(16), 0);
        let place = json!([self.all.len(), part.len()]);
        self.all.extend_from_slice(part);
        place
    }

    fn level(&mut self, key: (usize, usize, wgpu::TextureFormat), part: impl FnOnce() -> Vec<u8>) -> Value {
        if let Some((_, place)) = self.known.iter().find(|(known, _)| *known == key) {
            return place.clone();
        }
        let place = self.add(&part());
        self.known.push((key, place.clone()));
        place
    }
}

/// Programs in WGSL, for plans of scenes that share them.
#[derive(Debug, Default)]
pub struct Written {
    programs: Vec<WrittenProgram>,
}

#[derive(Debug)]
struct WrittenProgram {
    /// The program, which stays as long as it is known by its address.
    program: Arc<Program>,
    conventions: Conventions,
    /// The texts of the vertex and the fragment stage.
    texts: [String; 2],
}

impl Written {
    /// How many programs are kept; the oldest goes first.
    const MOST: usize = 64;

    /// The vertex and the fragment stage.
    fn texts(&mut self, program: &Arc<Program>, conventions: Conventions) -> Result<[String; 2], Error> {
        let is_known = |one: &&WrittenProgram| Arc::ptr_eq(&one.program, program) && one.conventions == conventions;
        if let Some(known) = self.programs.iter().find(is_known) {
            return Ok(known.texts.clone());
        }
        let code = |stage: Stage| match emit(program, stage, Target::Wgsl, &conventions) {
            Ok(Emitted::Text(text)) => Ok(text),
            Ok(Emitted::Words(_)) => Err(Error::Refused("the code is no text".to_owned())),
            Err(diagnostics) => Err(Error::Emit(diagnostics)),
        };
        let texts = [code(Stage::Vertex)?, code(Stage::Fragment)?];
        if self.programs.len() >= Self::MOST {
            self.programs.remove(0);
        }
        self.programs.push(WrittenProgram { program: Arc::clone(program), conventions, texts: texts.clone() });
        Ok(texts)
    }
}

fn planned(framebuffer: &Framebuffer, draw: &Draw, bytes: &mut Bytes, written: &mut Written) -> Result<Value, Error> {
    let program = &draw.program;
    beyond::refuse(draw)?;
    sprites::refuse(draw, Target::Wgsl)?;
    bindings::refuse_levels(draw)?;
    bindings::refuse_wraps(draw)?;
    let sprites = sprites::applies(draw, Target::Wgsl);
    let all = bindings(program, sprites)?;
    let conventions = conventions(framebuffer, draw, Target::Wgsl);
    let [vertex, fragment] = written.texts(program, conventions)?;
    let rows = if sprites { vertices::rows_of_points(draw) } else { vertices::rows(draw) };
    let buffers: Vec<Value> = rows.iter().map(|rows| vertex_buffer(rows, bytes)).collect();
    let primitive = if sprites { sprites::primitive_state() } else { primitive_state(&draw.state) };
    let state = &draw.state;
    let (indices, count, instances) = if sprites {
        (Value::Null, sprites::CORNERS, sprites::count(draw))
    } else {
        let list = assembly::list(state.primitive, draw.vertex_count, draw.indices.as_deref(), state.provoking_last);
        let count = list.as_ref().map_or(draw.vertex_count, |list| list.len() as u32);
        let place = list.map(|list| bytes.add(&list.iter().flat_map(|index| index.to_ne_bytes()).collect::<Vec<u8>>()));
        (place.unwrap_or_default(), count, draw.instances)
    };
    let visibility = Visibility::of(program, &conventions);
    let resources = Resources::of(framebuffer, draw);
    let mut groups: Vec<Vec<Value>> = vec![Vec::new(); bindings::GROUPS];
    for binding in &all {
        let entry = resources.entry(binding, &visibility, bytes)?;
        if let Some(group) = groups.get_mut(binding.slot.group as usize) {
            group.push(entry);
        }
    }
    Ok(json!({
        "name": program.name,
        "vertex": vertex,
        "fragment": fragment,
        "buffers": buffers,
        "indices": indices,
        "count": count,
        "instances": instances,
        "blendConstant": state.blend.map(|blend| blend.one_constant()),
        "primitive": {
            "topology": word(primitive.topology),
            "frontFace": word(primitive.front_face),
            "cullMode": primitive.cull_mode.map_or("none".to_owned(), word),
        },
        "depthStencil": depth(&depth_stencil(state)),
        "targets": bindings::targets(framebuffer, draw).into_iter().flatten().map(|target| color(&target)).collect::<Vec<_>>(),
        "groups": groups,
    }))
}

fn vertex_buffer(rows: &Rows, bytes: &mut Bytes) -> Value {
    let attribute = |column: &wgpu::VertexAttribute| {
        json!({
            "format": format(column.format),
            "offset": column.offset,
            "shaderLocation": column.shader_location,
        })
    };
    json!({
        "arrayStride": rows.stride,
        "stepMode": word(rows.step),
        "attributes": rows.columns.iter().map(attribute).collect::<Vec<_>>(),
        "bytes": bytes.add(&rows.bytes),
    })
}

fn depth(state: &wgpu::DepthStencilState) -> Value {
    let face = |face: &wgpu::StencilFaceState| {
        json!({
            "compare": word(face.compare),
            "failOp": word(face.fail_op),
            "depthFailOp": word(face.depth_fail_op),
            "passOp": word(face.pass_op),
        })
    };
    json!({
        "format": format(state.format),
        "depthWriteEnabled": state.depth_write_enabled,
        "depthCompare": state.depth_compare.map(word),
        "stencilFront": face(&state.stencil.front),
        "stencilBack": face(&state.stencil.back),
        "stencilReadMask": state.stencil.read_mask,
        "stencilWriteMask": state.stencil.write_mask,
    })
}

fn color(target: &wgpu::ColorTargetState) -> Value {
    let component = |component: &wgpu::BlendComponent| {
        json!({
            "srcFactor": word(component.src_factor),
            "dstFactor": word(component.dst_factor),
            "operation": word(component.operation),
        })
    };
    let mut dictionary = json!({ "format": format(target.format), "writeMask": target.write_mask.bits() });
    if let (Some(blend), Some(dictionary)) = (&target.blend, dictionary.as_object_mut()) {
        dictionary
            .insert("blend".into(), json!({ "color": component(&blend.color), "alpha": component(&blend.alpha) }));
    }
    dictionary
}

/// The resources of a draw.
struct Resources<'a> {
    draw: &'a Draw,
    buffers: Vec<(SlotBinding, Vec<u8>)>,
}

impl<'a> Resources<'a> {
    fn of(framebuffer: &Framebuffer, draw: &'a Draw) -> Self {
        let texels: Vec<u32> = draw.textures.iter().map(|texture| slots::texels(texture.as_deref())).collect();
        let packed = uniforms::pack(&draw.program, &draw.uniforms, framebuffer.height, &texels);
        let mut buffers: Vec<(SlotBinding, Vec<u8>)> =
            packed.into_iter().map(|packed| (packed.slot, packed.bytes)).collect();
        buffers.push((sprites::slot(&draw.program), sprites::viewport(framebuffer)));
        Self { draw, buffers }
    }

    /// An entry of a layout, with what is bound there.
    fn entry(&self, binding: &Binding, visibility: &Visibility, bytes: &mut Bytes) -> Result<Value, Error> {
        let slot = binding.slot;
        let mut entry = json!({ "binding": slot.binding, "visibility": visibility.stages(slot).bits() });
        let (kind, layout, bound) = match binding.what {
            What::Uniforms => {
                let part = self.buffers.iter().find(|(other, _)| *other == slot).map(|(_, part)| part.as_slice());
                ("buffer", json!({ "type": "uniform" }), bytes.add(part.unwrap_or(&[0; 16])))
            }
            What::Texture(sampled) => {
                let texture = self.texture(|sampler| sampler.texture == slot);
                ("texture", texture_layout(&binding.what.layout()), texture_data(sampled, texture, bytes)?)
            }
            What::Sampler(sampled) => {
                let black;
                let texture = match self.texture(|sampler| sampler.sampler == slot) {
                    Some(texture) => texture,
                    None => {
                        black = slots::black_texel(sampled);
                        &black
                    }
                };
                let kind = if sampled.shadow { "comparison" } else { "filtering" };
                ("sampler", json!({ "type": kind }), sampler(&slots::sampler(sampled, texture)))
            }
        };
        if let Some(entry) = entry.as_object_mut() {
            entry.insert(kind.into(), layout);
            entry.insert("bound".into(), bound);
        }
        Ok(entry)
    }

    fn texture(&self, is_it: impl Fn(&glisten_front::link::SamplerSlot) -> bool) -> Option<&'a Texture> {
        let index = self.draw.program.interface.samplers.iter().position(is_it)?;
        self.draw.textures.get(index)?.as_deref()
    }
}

fn texture_layout(layout: &wgpu::BindingType) -> Value {
    let wgpu::BindingType::Texture { sample_type, view_dimension, multisampled } = layout else { return Value::Null };
    let sample_type = match sample_type {
        wgpu::TextureSampleType::Float { filterable: true } => "float",
        wgpu::TextureSampleType::Float { filterable: false } => "unfilterable-float",
        wgpu::TextureSampleType::Depth => "depth",
        wgpu::TextureSampleType::Sint => "sint",
        wgpu::TextureSampleType::Uint => "uint",
    };
    json!({ "sampleType": sample_type, "viewDimension": dimension(*view_dimension), "multisampled": multisampled })
}

/// A texture with its levels. Depths are a float a texel: a host draws them, since they cannot be copied.
fn texture_data(kind: SamplerType, texture: Option<&Texture>, bytes: &mut Bytes) -> Result<Value, Error> {
    if kind.dim == SamplerDim::Multisample {
        return Err(Error::Unsupported("multisample textures in a plan".to_owned()));
    }
    let black;
    let (texture, address) = match texture {
        Some(texture) => (texture, std::ptr::from_ref(texture).addr()),
        None => {
            black = slots::black_texel(kind);
            (&black, 0)
        }
    };
    let format = match (kind.shadow, texture.sampling.fixed_point_depth) {
        (false, _) => texel_format(kind.texel),
        (true, true) => wgpu::TextureFormat::Depth24Plus,
        (true, false) => wgpu::TextureFormat::Depth32Float,
    };
    let level = |(number, level): (usize, &glisten_scene::TextureLevel)| {
        let size = extent(kind, Some(level));
        let n_texels = size.width as usize * size.height as usize * size.depth_or_array_layers as usize;
        let part = || {
            let (mut part, size) = match kind.shadow {
                true => (depths(&level.texels).iter().flat_map(|depth| depth.to_ne_bytes()).collect(), 4),
                false => (texel_bytes(&level.texels, kind.texel), 16),
            };
            part.resize(n_texels * size, 0);
            part
        };
        // All slots without a texture have the same one.
        let key = (address, number + if address == 0 { n_texels } else { 0 }, format);
        json!({ "size": sizes(size), "bytes": bytes.level(key, part) })
    };
    let levels: Vec<Value> = texture.levels.iter().enumerate().map(level).collect();
    Ok(json!({
        "format": self::format(format),
        "dimension": if kind.dim == SamplerDim::D3 { "3d" } else { "2d" },
        "viewDimension": dimension(slots::view_dimension(kind)),
        "size": sizes(extent(kind, texture.levels.first())),
        "isDepth": kind.shadow,
        "levels": levels,
    }))
}

fn sizes(size: wgpu::Extent3d) -> [u32; 3] {
    [size.width, size.height, size.depth_or_array_layers]
}

fn sampler(sampler: &wgpu::SamplerDescriptor<Option<&'static str>>) -> Value {
    let mut dictionary = json!({
        "addressModeU": word(sampler.address_mode_u),
        "addressModeV": word(sampler.address_mode_v),
        "addressModeW": word(sampler.address_mode_w),
        "magFilter": word(sampler.mag_filter),
        "minFilter": word(sampler.min_filter),
        "mipmapFilter": word(sampler.mipmap_filter),
        "lodMinClamp": sampler.lod_min_clamp,
        "lodMaxClamp": sampler.lod_max_clamp,
    });
    if let (Some(compare), Some(dictionary)) = (sampler.compare, dictionary.as_object_mut()) {
        dictionary.insert("compare".into(), word(compare).into());
    }
    dictionary
}

#[cfg(test)]
mod tests {
    use super::Plan;
    use glisten_front::{Compiler, Options};
    use glisten_scene::{MemoryFiles, NoLibrary, load};

    const SCENE: &str = "[framebuffer]\nwidth = 4\nheight = 2\nformat = \"rgba8unorm\"\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
        primitive = \"triangles\"\nvertex_count = 3\nblend = \"alpha\"\ncull = \"back\"\n\
        [draw.attributes]\nposition = { size = 3, values = [0, 0, 0, 1, 0, 0, 0, 1, 0] }\n[draw.uniforms]\ntint = [0.5, 0.25, 1.0]\n\
        [draw.textures]\nmap = { width = 2, height = 2, values = [1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1], filter = \"linear\" }\n";
    const VERTEX: &str = "#version 150\nin vec3 position;\nvoid main() { gl_Position = vec4(position, 1.0); }\n";
    const FRAGMENT: &str = "#version 150\nuniform vec3 tint;\nuniform sampler2D map;\nout vec4 color;\n\
        void main() { color = vec4(tint, 1.0) * texture(map, vec2(0.5)); }\n";

    #[test]
    fn names_are_those_of_webgpu() {
        let files = MemoryFiles::new([("s.toml", SCENE), ("a.vert", VERTEX), ("a.frag", FRAGMENT)]);
        let loaded = load("s.toml", &files, &NoLibrary, &Compiler::new(Options::default()));
        let errors: Vec<String> = loaded.diagnostics.iter().map(|one| one.message.clone()).collect();
        let scene = loaded.scene.unwrap_or_else(|| panic!("{errors:?}"));
        let Plan { calls, bytes } = Plan::of(&scene).expect("a plan");
        assert_words(&calls["draws"][0]);
        let place = |value: &serde_json::Value| {
            let place: [usize; 2] = serde_json::from_value(value.clone()).expect("a place");
            bytes[place[0]..place[0] + place[1]].to_vec()
        };
        let draw = &calls["draws"][0];
        assert_eq!(calls["format"], "rgba8unorm");
        assert_eq!(place(&draw["buffers"][0]["bytes"]).len(), 3 * 12);
        let uniforms = place(&draw["groups"][0][0]["bound"]);
        assert_eq!(uniforms[..4], 0.5f32.to_ne_bytes());
        let level = &draw["groups"][1][0]["bound"]["levels"][0];
        assert_eq!((&level["size"], place(&level["bytes"]).len()), (&serde_json::json!([2, 2, 1]), 64));
    }

    fn assert_words(draw: &serde_json::Value) {
        for (path, value) in [
            ("/buffers/0/attributes/0/format", "float32x3"),
            ("/buffers/0/stepMode", "vertex"),
            ("/primitive/topology", "triangle-list"),
            ("/primitive/frontFace", "ccw"),
            ("/primitive/cullMode", "back"),
            ("/depthStencil/format", "depth32float-stencil8"),
            ("/depthStencil/stencilFront/passOp", "replace"),
            ("/targets/0/blend/color/dstFactor", "one-minus-src-alpha"),
            ("/targets/0/blend/color/operation", "add"),
            ("/groups/1/0/texture/viewDimension", "2d"),
            ("/groups/1/1/bound/magFilter", "linear"),
            ("/groups/1/1/bound/addressModeU", "repeat"),
        ] {
            assert_eq!(draw.pointer(path).and_then(|found| found.as_str()), Some(value), "{path}: {draw:#}");
        }
    }
}
