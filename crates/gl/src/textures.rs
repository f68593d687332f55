//! Uploads textures with their parameters (OpenGL 3.2 §3.8).
//!
//! *In:* a draw's textures by sampler slot. *Out:* each texture bound to the unit with its slot's number, and the
//! sampler uniform set to it. *Holds:* texels have 32 bits per channel, as in the scene. Integer textures are never
//! filtered, since OpenGL would then call them incomplete.

use super::api::{Api, Dimensions, PixelLayout, Size};
use super::states::{compare, wrap};
use super::texels::{layout, stored, texel_bytes};
use super::{Error, multisample};
use glisten_front::hir::{DepthMode, SamplerDim, SamplerType, Scalar, Stage, Type};
use glisten_scene::{Draw, Framebuffer, Texture, TextureLevel};

/// Binds all textures. The program must be current.
pub(super) fn bind(api: &Api, linked: glow::Program, draw: &Draw, framebuffer: &Framebuffer) -> Result<(), Error> {
    let units = api.max_units();
    let mode = draw.program.stages.first().map_or_else(DepthMode::default, |shader| shader.depth_mode);
    let mut unit = 0;
    for (slot, texture) in draw.program.interface.samplers.iter().zip(&draw.textures) {
        let Type::Sampler(kind) = draw.program.types.get(slot.ty) else { continue };
        let own_unit = fixed_unit(draw, &slot.name);
        if let (Some(own_unit), Some(texture)) = (own_unit, texture) {
            api.active_texture(glow::TEXTURE0 + own_unit);
            image(api, kind, texture, mode)?;
            continue;
        }
        let (Some(location), Some(texture)) = (api.get_uniform_location(linked, &slot.name), texture) else { continue };
        if unit >= units {
            return Err(Error::Unsupported(format!("more than {units} texture units")));
        }
        api.active_texture(glow::TEXTURE0 + unit);
        if kind.dim == SamplerDim::Buffer {
            buffer(api, kind, texture)?;
        } else if kind.dim == SamplerDim::Multisample {
            multisample::upload(api, kind, texture, framebuffer, linked)?;
        } else {
            image(api, kind, texture, mode)?;
        }
        api.uniform_1_i32(Some(&location), unit as i32);
        api.check(&format!("making the texture of `{}`", slot.name))?;
        unit += 1;
    }
    Ok(())
}

/// The unit of the fixed-function pipeline whose texture a generated fragment stage calls `name`.
fn fixed_unit(draw: &Draw, name: &str) -> Option<u32> {
    let (stage, _) = draw.fixed.as_ref()?.generated.as_ref()?;
    let unit = name.strip_prefix("texture").filter(|_| *stage == Stage::Fragment)?;
    unit.parse().ok()
}

/// The texture target of a sampler type, and the number of dimensions of its images.
fn target(kind: SamplerType) -> Result<(u32, Dimensions), Error> {
    Ok(match (kind.dim, kind.arrayed) {
        (SamplerDim::D1, false) => (glow::TEXTURE_1D, Dimensions::One),
        (SamplerDim::D1, true) => (glow::TEXTURE_1D_ARRAY, Dimensions::Two),
        (SamplerDim::D2, false) => (glow::TEXTURE_2D, Dimensions::Two),
        (SamplerDim::D2, true) => (glow::TEXTURE_2D_ARRAY, Dimensions::Three),
        (SamplerDim::D3, _) => (glow::TEXTURE_3D, Dimensions::Three),
        (SamplerDim::Cube, false) => (glow::TEXTURE_CUBE_MAP, Dimensions::Two),
        (SamplerDim::Cube, true) => (glow::TEXTURE_CUBE_MAP_ARRAY, Dimensions::Three),
        (SamplerDim::Rect, _) => (glow::TEXTURE_RECTANGLE, Dimensions::Two),
        (SamplerDim::Buffer | SamplerDim::Multisample, _) => {
            return Err(Error::Refused("a scene has no textures of this sampler's kind".to_owned()));
        }
    })
}

fn image(api: &Api, kind: SamplerType, texture: &Texture, mode: DepthMode) -> Result<(), Error> {
    let (target, dimensions) = target(kind)?;
    let made = api.create_texture().map_err(Error::Refused)?;
    api.bind_texture(target, Some(made));
    parameters(api, target, kind, texture);
    if kind.shadow && mode != DepthMode::default() {
        api.tex_parameter_i32(target, DEPTH_TEXTURE_MODE, depth_mode(mode) as i32);
    }
    for (number, level) in (0..).zip(&texture.levels) {
        let bytes = texel_bytes(&level.texels, kind);
        let filled = if kind.dim == SamplerDim::Cube && !kind.arrayed {
            faces(api, number, (stored(kind, texture), level), &bytes)
        } else {
            let size = size(kind, level);
            api.tex_image(target, dimensions, number, size, stored(kind, texture), &bytes)
        };
        if !filled {
            return Err(Error::Refused("a level of a texture has fewer texels than its size says".to_owned()));
        }
    }
    Ok(())
}

/// `GL_DEPTH_TEXTURE_MODE` (OpenGL 2.1 table 3.20), which only a compatibility context has.
const DEPTH_TEXTURE_MODE: u32 = 0x884B;

fn depth_mode(mode: DepthMode) -> u32 {
    match mode {
        DepthMode::Luminance => 0x1909,
        DepthMode::Intensity => 0x8049,
        DepthMode::Alpha => 0x1906,
        DepthMode::Red => glow::RED,
    }
}

/// The size as OpenGL counts it: the layers of a one-dimensional array are its rows.
fn size(kind: SamplerType, level: &TextureLevel) -> Size {
    let (width, height, depth) = (level.width, level.height, level.depth);
    match (kind.dim, kind.arrayed) {
        (SamplerDim::D1, true) => Size { width, height: depth, depth: 1 },
        _ => Size { width, height, depth },
    }
}

fn faces(api: &Api, number: i32, (layout, level): (PixelLayout, &TextureLevel), bytes: &[u8]) -> bool {
    let size = Size { width: level.width, height: level.height, depth: 1 };
    let face = size.width as usize * size.height as usize * layout.bytes;
    let mut targets = glow::TEXTURE_CUBE_MAP_POSITIVE_X..=glow::TEXTURE_CUBE_MAP_NEGATIVE_Z;
    face > 0
        && bytes.len() >= 6 * face
        && bytes
            .chunks_exact(face)
            .zip(&mut targets)
            .all(|(bytes, target)| api.tex_image(target, Dimensions::Two, number, size, layout, bytes))
}

fn parameters(api: &Api, target: u32, kind: SamplerType, texture: &Texture) {
    let filtered = kind.texel == Scalar::Float;
    let mipmapped = texture.filter.uses_levels() && kind.dim != SamplerDim::Rect;
    let linear = filtered && texture.filter.is_linear();
    let blended = filtered && texture.filter.blends_levels();
    let within = if linear { glow::LINEAR } else { glow::NEAREST };
    let minification = match (mipmapped, linear, blended) {
        (true, true, true) => glow::LINEAR_MIPMAP_LINEAR,
        (true, true, false) => glow::LINEAR_MIPMAP_NEAREST,
        (true, false, true) => glow::NEAREST_MIPMAP_LINEAR,
        (true, false, false) => glow::NEAREST_MIPMAP_NEAREST,
        (false, ..) => within,
    };
    let set = |what: u32, value: u32| api.tex_parameter_i32(target, what, value as i32);
    set(glow::TEXTURE_MIN_FILTER, minification);
    let magnified = filtered && texture.sampling.magnifies_linearly(texture.filter);
    set(glow::TEXTURE_MAG_FILTER, if magnified { glow::LINEAR } else { glow::NEAREST });
    if texture.sampling.lod_bias != 0.0 {
        api.tex_parameter_f32(target, glow::TEXTURE_LOD_BIAS, texture.sampling.lod_bias);
    }
    for direction in [glow::TEXTURE_WRAP_S, glow::TEXTURE_WRAP_T, glow::TEXTURE_WRAP_R] {
        set(direction, wrap(texture.wrap));
    }
    if kind.dim != SamplerDim::Rect {
        set(glow::TEXTURE_MAX_LEVEL, (texture.levels.len().max(1) - 1) as u32);
    }
    if kind.shadow {
        set(glow::TEXTURE_COMPARE_MODE, glow::COMPARE_REF_TO_TEXTURE);
        set(glow::TEXTURE_COMPARE_FUNC, compare(texture.compare));
    }
}

fn buffer(api: &Api, kind: SamplerType, texture: &Texture) -> Result<(), Error> {
    let bytes = texture.levels.first().map(|level| texel_bytes(&level.texels, kind)).unwrap_or_default();
    let buffer = api.create_buffer().map_err(Error::Refused)?;
    api.bind_buffer(glow::TEXTURE_BUFFER, Some(buffer));
    api.buffer_data_u8_slice(glow::TEXTURE_BUFFER, &bytes, glow::STATIC_DRAW);
    let made = api.create_texture().map_err(Error::Refused)?;
    api.bind_texture(glow::TEXTURE_BUFFER, Some(made));
    api.tex_buffer(glow::TEXTURE_BUFFER, layout(kind).internal, Some(buffer));
    Ok(())
}
