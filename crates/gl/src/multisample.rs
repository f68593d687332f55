//! Uploads multisample textures by drawing, since OpenGL cannot copy texels to them (OpenGL 3.2 §3.8.4).
//!
//! *In:* a texture with an image for each sample, and the framebuffer of the frame. *Out:* a texture, bound to the active
//! unit. Each image is drawn with a sample mask that lets only its own sample through. *Holds:* the framebuffer, the
//! viewport and the program are those of before; fixed-function state is set after textures are bound.

use super::Error;
use super::api::{Api, Dimensions, PixelLayout, Samples, Size};
use super::texels::{layout, texel_bytes};
use glisten_front::hir::{SamplerType, Scalar};
use glisten_scene::{Framebuffer, Texture, TextureLevel};

const VERTEX: &str = "#version 150\n\
    void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }\n";
const FRAGMENT: &str = "#version 150\nuniform @sampler2D source;\nout @vec4 texel;\n\
    void main() { texel = texelFetch(source, ivec2(gl_FragCoord.xy), 0); }\n";

/// Makes a texture and binds it to the active unit. `linked` becomes the current program again.
pub(super) fn upload(
    api: &Api,
    kind: SamplerType,
    texture: &Texture,
    framebuffer: &Framebuffer,
    linked: glow::Program,
) -> Result<(), Error> {
    let Some(level) = texture.levels.first() else { return Ok(()) };
    let layers = level.depth.max(1);
    let samples = Samples {
        count: texture.levels.len() as u32,
        internal: layout(kind).internal,
        size: Size { width: level.width, height: level.height, depth: layers },
        arrayed: kind.arrayed,
    };
    let limit = api.max_samples(kind.texel != Scalar::Float);
    if samples.count > limit {
        let message = format!("a texture of {} samples: this driver has at most {limit} of its kind", samples.count);
        return Err(Error::Unsupported(message));
    }
    let target = if kind.arrayed { glow::TEXTURE_2D_MULTISAMPLE_ARRAY } else { glow::TEXTURE_2D_MULTISAMPLE };
    let made = api.create_texture().map_err(Error::Refused)?;
    api.bind_texture(target, Some(made));
    api.tex_image_multisample(target, samples);
    api.check("making a multisample texture")?;
    let frame = api.bound_framebuffer();
    let place = api.create_framebuffer().map_err(Error::Refused)?;
    api.bind_framebuffer(glow::FRAMEBUFFER, Some(place));
    let program = program(api, kind)?;
    api.use_program(Some(program));
    api.bind_vertex_array(Some(api.create_vertex_array().map_err(Error::Refused)?));
    quiet(api);
    api.viewport(0, 0, level.width as i32, level.height as i32);
    for layer in 0..layers {
        api.attach_multisample(target, made, kind.arrayed.then_some(layer));
        if api.check_framebuffer_status(glow::FRAMEBUFFER) != glow::FRAMEBUFFER_COMPLETE {
            return Err(Error::Unsupported("a framebuffer of a multisample texture of 32-bit channels".to_owned()));
        }
        for (sample, level) in texture.levels.iter().enumerate() {
            source(api, kind, level, layer)?;
            api.sample_mask(1 << sample);
            api.draw_arrays(glow::TRIANGLES, 3, 1);
        }
    }
    api.disable(glow::SAMPLE_MASK);
    api.bind_framebuffer(glow::FRAMEBUFFER, frame);
    api.viewport(0, 0, framebuffer.width as i32, framebuffer.height as i32);
    api.use_program(Some(linked));
    api.check("filling a multisample texture")
}

/// Switches off what could keep a fragment from being written.
fn quiet(api: &Api) {
    for what in [glow::CULL_FACE, glow::DEPTH_TEST, glow::STENCIL_TEST, glow::BLEND, glow::DITHER] {
        api.disable(what);
    }
    (0..8).for_each(|plane| api.disable(glow::CLIP_DISTANCE0 + plane));
    api.enable(glow::SAMPLE_MASK);
}

/// Binds the texels of a sample's layer as an ordinary texture.
fn source(api: &Api, kind: SamplerType, level: &TextureLevel, layer: u32) -> Result<(), Error> {
    let layout: PixelLayout = layout(kind);
    let image = level.width as usize * level.height as usize * layout.bytes;
    let bytes = texel_bytes(&level.texels, kind);
    let bytes = bytes.get(layer as usize * image..).unwrap_or_default();
    let texture = api.create_texture().map_err(Error::Refused)?;
    api.bind_texture(glow::TEXTURE_2D, Some(texture));
    for (what, value) in [
        (glow::TEXTURE_MIN_FILTER, glow::NEAREST as i32),
        (glow::TEXTURE_MAG_FILTER, glow::NEAREST as i32),
        (glow::TEXTURE_MAX_LEVEL, 0),
    ] {
        api.tex_parameter_i32(glow::TEXTURE_2D, what, value);
    }
    let size = Size { width: level.width, height: level.height, depth: 1 };
    if api.tex_image(glow::TEXTURE_2D, Dimensions::Two, 0, size, layout, bytes) {
        Ok(())
    } else {
        Err(Error::Refused("a sample of a texture has fewer texels than its size says".to_owned()))
    }
}

/// The program that copies a texture of this kind. Its sampler reads the active unit.
fn program(api: &Api, kind: SamplerType) -> Result<glow::Program, Error> {
    let prefix = match kind.texel {
        Scalar::Int => "i",
        Scalar::Uint => "u",
        Scalar::Bool | Scalar::Float => "",
    };
    let made = api.create_program().map_err(Error::Refused)?;
    let fragment = FRAGMENT.replace('@', prefix);
    for (stage, text) in [(glow::VERTEX_SHADER, VERTEX), (glow::FRAGMENT_SHADER, fragment.as_str())] {
        let shader = api.create_shader(stage).map_err(Error::Refused)?;
        api.shader_source(shader, text);
        api.compile_shader(shader);
        api.attach_shader(made, shader);
    }
    api.link_program(made);
    if !api.get_program_link_status(made) {
        return Err(Error::Refused(format!("the copy of a texture: {}", api.get_program_info_log(made))));
    }
    api.use_program(Some(made));
    let location = api.get_uniform_location(made, "source");
    api.uniform_1_i32(location.as_ref(), api.active_unit());
    Ok(made)
}
