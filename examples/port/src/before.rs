//! Before: the knot by OpenGL, with the shaders in `shaders`.
//!
//! *In:* the folder for the picture. *Out:* `before.png` there. *Holds:* there is no window, so that it runs anywhere.

#![expect(unsafe_code, reason = "the functions of OpenGL")]

#[expect(dead_code, reason = "the comparison is the other program's")]
mod shared;

use glow::{Context, HasContext, PixelPackData, PixelUnpackData};
use khronos_egl as egl;
use shared::{AMBIENT, BACKGROUND, LAMP, PATTERN, SHININESS, SIZE};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    // SAFETY: the library with the name of libEGL is EGL.
    let egl = unsafe { egl::DynamicInstance::<egl::EGL1_5>::load_required()? };
    let gl = context(&egl)?;
    // SAFETY: the context is current, and all objects are its own.
    let picture = unsafe { draw(&gl)? };
    shared::write("before.png", &picture)?;
    Ok(())
}

/// OpenGL without a window (EGL_MESA_platform_surfaceless).
fn context(egl: &egl::DynamicInstance<egl::EGL1_5>) -> Result<Context, Box<dyn Error>> {
    // SAFETY: the platform expects no native display.
    let display = unsafe { egl.get_platform_display(0x31DD, std::ptr::null_mut(), &[egl::ATTRIB_NONE])? };
    egl.initialize(display)?;
    egl.bind_api(egl::OPENGL_API)?;
    let wanted = [egl::RENDERABLE_TYPE, egl::OPENGL_BIT, egl::SURFACE_TYPE, egl::PBUFFER_BIT, egl::NONE];
    let config = egl.choose_first_config(display, &wanted)?.ok_or("no display draws with OpenGL")?;
    let context = egl.create_context(display, config, None, &[egl::NONE])?;
    egl.make_current(display, None, None, Some(context))?;
    let address = |name: &str| egl.get_proc_address(name).map_or(std::ptr::null(), |function| function as *const _);
    // SAFETY: the addresses are those of the context that is current.
    Ok(unsafe { Context::from_loader_function(address) })
}

unsafe fn draw(gl: &Context) -> Result<Vec<u8>, String> {
    unsafe {
        let framebuffer = gl.create_framebuffer()?;
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        let formats = [(glow::COLOR_ATTACHMENT0, glow::RGBA8), (glow::DEPTH_ATTACHMENT, glow::DEPTH_COMPONENT24)];
        for (attachment, format) in formats {
            let buffer = gl.create_renderbuffer()?;
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
            gl.renderbuffer_storage(glow::RENDERBUFFER, format, SIZE as i32, SIZE as i32);
            gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, attachment, glow::RENDERBUFFER, Some(buffer));
        }
        gl.viewport(0, 0, SIZE as i32, SIZE as i32);
        let [r, g, b, a] = BACKGROUND;
        gl.clear_color(r, g, b, a);
        gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
        gl.enable(glow::DEPTH_TEST);

        let program = gl.create_program()?;
        let stages = [
            (glow::VERTEX_SHADER, include_str!("../shaders/knot.vert")),
            (glow::FRAGMENT_SHADER, include_str!("../shaders/knot.frag")),
        ];
        for (stage, text) in stages {
            let shader = gl.create_shader(stage)?;
            gl.shader_source(shader, text);
            gl.compile_shader(shader);
            gl.attach_shader(program, shader);
        }
        gl.link_program(program);
        if !gl.get_program_link_status(program) {
            return Err(gl.get_program_info_log(program));
        }
        gl.use_program(Some(program));
        let place = |name: &str| gl.get_uniform_location(program, name);
        gl.uniform_matrix_4_f32_slice(place("view").as_ref(), false, shared::view().as_ref());
        gl.uniform_matrix_4_f32_slice(place("projection").as_ref(), false, shared::projection().as_ref());
        gl.uniform_3_f32_slice(place("lamp").as_ref(), &LAMP);
        gl.uniform_3_f32_slice(place("ambient").as_ref(), &AMBIENT);
        gl.uniform_1_f32(place("shininess").as_ref(), SHININESS);
        gl.uniform_1_i32(place("pattern").as_ref(), 0);

        gl.bind_texture(glow::TEXTURE_2D, Some(gl.create_texture()?));
        let (size, texels) = (PATTERN as i32, shared::pattern());
        let texels = PixelUnpackData::Slice(Some(&texels));
        gl.tex_image_2d(
            glow::TEXTURE_2D,
            0,
            glow::RGBA8 as i32,
            size,
            size,
            0,
            glow::RGBA,
            glow::UNSIGNED_BYTE,
            texels,
        );
        gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MIN_FILTER, glow::LINEAR as i32);

        let corners = shared::knot();
        let numbers = corners.iter().flat_map(|(p, n, uv)| [p.x, p.y, p.z, n.x, n.y, n.z, uv[0], uv[1]]);
        let bytes: Vec<u8> = numbers.flat_map(f32::to_ne_bytes).collect();
        gl.bind_buffer(glow::ARRAY_BUFFER, Some(gl.create_buffer()?));
        gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, &bytes, glow::STATIC_DRAW);
        for (name, size, offset) in [("position", 3, 0), ("normal", 3, 12), ("uv", 2, 24)] {
            let at = gl.get_attrib_location(program, name).ok_or("an attribute is not there")?;
            gl.enable_vertex_attrib_array(at);
            gl.vertex_attrib_pointer_f32(at, size, glow::FLOAT, false, 32, offset);
        }
        gl.draw_arrays(glow::TRIANGLES, 0, corners.len() as i32);

        let mut pixels = vec![0; (4 * SIZE * SIZE) as usize];
        let into = PixelPackData::Slice(Some(&mut pixels));
        gl.read_pixels(0, 0, SIZE as i32, SIZE as i32, glow::RGBA, glow::UNSIGNED_BYTE, into);
        // The first row of OpenGL is the bottom one.
        Ok(pixels.rchunks_exact((4 * SIZE) as usize).flatten().copied().collect())
    }
}
