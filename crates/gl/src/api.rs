//! [`Api`]: safe wrappers for the OpenGL functions in use.
//!
//! *Holds:* the context that the functions belong to is current on this thread (`egl::Context` ensures that). OpenGL
//! answers meaningless names, enumerants and sizes with an error. Memory is only ever passed as slices, and where
//! OpenGL does not check the length, it is checked here.

use super::Error;
use super::old::Old;
use glow::HasContext;

/// The functions of a context.
pub(super) struct Api {
    gl: glow::Context,
    more: More,
    old: Option<Old>,
}

/// Functions of OpenGL 3.2 that `glow` leaves out.
pub(super) struct More {
    /// `glProvokingVertex`
    pub(super) provoking_vertex: extern "system" fn(u32),
    /// `glSampleMaski`
    pub(super) sample_mask_i: extern "system" fn(u32, u32),
    /// `glTexImage3DMultisample`
    pub(super) tex_image_3d_multisample: extern "system" fn(u32, i32, u32, i32, i32, i32, u8),
}

/// The storage of a multisample texture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples {
    /// The number of samples.
    pub(super) count: u32,
    /// The sized internal format.
    pub(super) internal: u32,
    /// The size; the depth is the number of layers.
    pub(super) size: Size,
    /// Whether it has layers.
    pub(super) arrayed: bool,
}

/// The width, height and depth of a level; dimensions that the kind of texture lacks are 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) depth: u32,
}

/// How texels or pixels are stored, and how they are transferred.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelLayout {
    /// The sized internal format.
    pub(super) internal: u32,
    /// The channels that are transferred.
    pub(super) format: u32,
    /// The data type of each channel.
    pub(super) kind: u32,
    /// The bytes of a texel in transfer.
    pub(super) bytes: usize,
}

/// The number of dimensions of an image call.
#[derive(Clone, Copy, Debug)]
pub(super) enum Dimensions {
    One,
    Two,
    Three,
}

macro_rules! safe {
    ($($name:ident($($argument:ident: $kind:ty),*) $(-> $result:ty)?;)*) => {
        $(pub(super) fn $name(&self, $($argument: $kind),*) $(-> $result)? {
            // SAFETY: see the documentation of the module.
            unsafe { self.gl.$name($($argument),*) }
        })*
    };
}

type Shader = glow::Shader;
type Program = glow::Program;
type Location<'a> = Option<&'a glow::UniformLocation>;

#[expect(unsafe_code, reason = "every function of OpenGL is unsafe to call where no context is current")]
impl Api {
    pub(super) fn new(gl: glow::Context, more: More, old: Option<Old>) -> Self {
        Self { gl, more, old }
    }

    /// The functions of OpenGL 2.1, in a compatibility context.
    pub(super) fn old(&self) -> Option<&Old> {
        self.old.as_ref()
    }

    safe! {
        get_parameter_string(name: u32) -> String;
        get_error() -> u32;
        enable(what: u32);

        create_shader(kind: u32) -> Result<Shader, String>;
        shader_source(shader: Shader, text: &str);
        compile_shader(shader: Shader);
        get_shader_compile_status(shader: Shader) -> bool;
        get_shader_info_log(shader: Shader) -> String;
        create_program() -> Result<Program, String>;
        attach_shader(program: Program, shader: Shader);
        bind_attrib_location(program: Program, location: u32, name: &str);
        bind_frag_data_location(program: Program, number: u32, name: &str);
        link_program(program: Program);
        get_program_link_status(program: Program) -> bool;
        get_program_info_log(program: Program) -> String;
        use_program(program: Option<Program>);

        get_uniform_location(program: Program, name: &str) -> Option<glow::UniformLocation>;
        uniform_1_i32(location: Location<'_>, value: i32);
        uniform_1_i32_slice(location: Location<'_>, values: &[i32]);
        uniform_2_i32_slice(location: Location<'_>, values: &[i32]);
        uniform_3_i32_slice(location: Location<'_>, values: &[i32]);
        uniform_4_i32_slice(location: Location<'_>, values: &[i32]);
        uniform_1_u32_slice(location: Location<'_>, values: &[u32]);
        uniform_2_u32_slice(location: Location<'_>, values: &[u32]);
        uniform_3_u32_slice(location: Location<'_>, values: &[u32]);
        uniform_4_u32_slice(location: Location<'_>, values: &[u32]);
        uniform_1_f32_slice(location: Location<'_>, values: &[f32]);
        uniform_2_f32_slice(location: Location<'_>, values: &[f32]);
        uniform_3_f32_slice(location: Location<'_>, values: &[f32]);
        uniform_4_f32_slice(location: Location<'_>, values: &[f32]);
        uniform_matrix_2_f32_slice(location: Location<'_>, transpose: bool, values: &[f32]);
        uniform_matrix_2x3_f32_slice(location: Location<'_>, transpose: bool, values: &[f32]);
        uniform_matrix_2x4_f32_slice(location: Location<'_>, transpose: bool, values: &[f32]);
        uniform_matrix_3x2_f32_slice(location: Location<'_>, transpose: bool, values: &[f32]);
        uniform_matrix_3_f32_slice(location: Location<'_>, transpose: bool, values: &[f32]);
        uniform_matrix_3x4_f32_slice(location: Location<'_>, transpose: bool, values: &[f32]);
        uniform_matrix_4x2_f32_slice(location: Location<'_>, transpose: bool, values: &[f32]);
        uniform_matrix_4x3_f32_slice(location: Location<'_>, transpose: bool, values: &[f32]);
        uniform_matrix_4_f32_slice(location: Location<'_>, transpose: bool, values: &[f32]);
        get_uniform_block_index(program: Program, name: &str) -> Option<u32>;
        get_active_uniform_block_parameter_i32(program: Program, block: u32, what: u32) -> i32;
        uniform_block_binding(program: Program, block: u32, binding: u32);
        get_uniform_indices(program: Program, names: &[&str]) -> Vec<Option<u32>>;
        get_active_uniforms_parameter(program: Program, uniforms: &[u32], what: u32) -> Vec<i32>;

        create_buffer() -> Result<glow::Buffer, String>;
        bind_buffer(target: u32, buffer: Option<glow::Buffer>);
        bind_buffer_base(target: u32, index: u32, buffer: Option<glow::Buffer>);
        buffer_data_u8_slice(target: u32, bytes: &[u8], usage: u32);

        create_texture() -> Result<glow::Texture, String>;
        active_texture(unit: u32);
        bind_texture(target: u32, texture: Option<glow::Texture>);
        tex_parameter_i32(target: u32, what: u32, value: i32);
        tex_parameter_f32(target: u32, what: u32, value: f32);
        tex_buffer(target: u32, internal: u32, buffer: Option<glow::Buffer>);

        create_vertex_array() -> Result<glow::VertexArray, String>;
        bind_vertex_array(array: Option<glow::VertexArray>);
        enable_vertex_attrib_array(location: u32);
        vertex_attrib_pointer_f32(location: u32, size: i32, kind: u32, normalized: bool, stride: i32, offset: i32);
        vertex_attrib_pointer_i32(location: u32, size: i32, kind: u32, stride: i32, offset: i32);
        vertex_attrib_divisor(location: u32, divisor: u32);
        vertex_attrib_4_f32(location: u32, x: f32, y: f32, z: f32, w: f32);

        create_framebuffer() -> Result<glow::Framebuffer, String>;
        bind_framebuffer(target: u32, framebuffer: Option<glow::Framebuffer>);
        create_renderbuffer() -> Result<glow::Renderbuffer, String>;
        bind_renderbuffer(target: u32, renderbuffer: Option<glow::Renderbuffer>);
        renderbuffer_storage(target: u32, internal: u32, width: i32, height: i32);
        framebuffer_renderbuffer(target: u32, place: u32, kind: u32, renderbuffer: Option<glow::Renderbuffer>);
        check_framebuffer_status(target: u32) -> u32;
        draw_buffers(places: &[u32]);
        read_buffer(place: u32);
        clear_buffer_f32_slice(target: u32, index: u32, values: &[f32; 4]);
        clear_buffer_i32_slice(target: u32, index: u32, values: &[i32; 4]);
        clear_buffer_u32_slice(target: u32, index: u32, values: &[u32; 4]);
        clear_buffer_depth_stencil(target: u32, index: u32, depth: f32, stencil: i32);

        viewport(x: i32, y: i32, width: i32, height: i32);
        front_face(order: u32);
        cull_face(face: u32);
        depth_func(function: u32);
        depth_mask(write: bool);
        stencil_func(function: u32, reference: i32, mask: u32);
        stencil_op(fail: u32, depth_fail: u32, pass: u32);
        blend_func(source: u32, destination: u32);
        blend_color(r: f32, g: f32, b: f32, a: f32);
        disable(what: u32);
    }

    /// The version of OpenGL that the context has.
    pub(super) fn version(&self) -> (u32, u32) {
        let version = self.gl.version();
        (version.major, version.minor)
    }

    /// The largest side of an attachment, in pixels.
    pub(super) fn max_side(&self) -> u32 {
        self.limit(glow::MAX_RENDERBUFFER_SIZE)
    }

    /// The largest number of textures that a program may read.
    pub(super) fn max_units(&self) -> u32 {
        self.limit(glow::MAX_COMBINED_TEXTURE_IMAGE_UNITS)
    }

    /// The largest number of samples of a multisample texture.
    pub(super) fn max_samples(&self, integer: bool) -> u32 {
        self.limit(if integer { glow::MAX_INTEGER_SAMPLES } else { glow::MAX_COLOR_TEXTURE_SAMPLES })
    }

    /// The number of the active texture unit.
    pub(super) fn active_unit(&self) -> i32 {
        self.limit(glow::ACTIVE_TEXTURE).saturating_sub(glow::TEXTURE0) as i32
    }

    /// The framebuffer to which is drawn.
    pub(super) fn bound_framebuffer(&self) -> Option<glow::Framebuffer> {
        // SAFETY: it queries one name.
        unsafe { self.gl.get_parameter_framebuffer(glow::DRAW_FRAMEBUFFER_BINDING) }
    }

    /// Draws only to the samples with a bit in the mask, where `GL_SAMPLE_MASK` is enabled.
    pub(super) fn sample_mask(&self, mask: u32) {
        (self.more.sample_mask_i)(0, mask);
    }

    /// Makes the storage of the bound multisample texture.
    pub(super) fn tex_image_multisample(&self, target: u32, samples: Samples) {
        let Samples { count, internal, size, arrayed } = samples;
        let (width, height, depth) = (size.width as i32, size.height as i32, size.depth as i32);
        if arrayed {
            (self.more.tex_image_3d_multisample)(target, count as i32, internal, width, height, depth, 1);
        } else {
            // SAFETY: no memory is passed.
            unsafe { self.gl.tex_image_2d_multisample(target, count as i32, internal as i32, width, height, true) }
        }
    }

    /// Attaches a multisample texture, or a layer of it, to the bound framebuffer as its color.
    pub(super) fn attach_multisample(&self, target: u32, texture: glow::Texture, layer: Option<u32>) {
        let (frame, place) = (glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0);
        // SAFETY: no memory is passed.
        unsafe {
            match layer {
                Some(layer) => self.gl.framebuffer_texture_layer(frame, place, Some(texture), 0, layer as i32),
                None => self.gl.framebuffer_texture_2d(frame, place, target, Some(texture), 0),
            }
        }
    }

    /// The value of a limit that is a single number.
    fn limit(&self, name: u32) -> u32 {
        // SAFETY: the two functions above query one number each, and there is room for one.
        u32::try_from(unsafe { self.gl.get_parameter_i32(name) }).unwrap_or(0)
    }

    /// `glProvokingVertex`
    pub(super) fn provoking_vertex(&self, convention: u32) {
        (self.more.provoking_vertex)(convention);
    }

    /// Draws vertices from the first on. Each enabled attribute must have data for all of them.
    pub(super) fn draw_arrays(&self, mode: u32, count: i32, instances: i32) {
        // SAFETY: `vertices` rejects a draw whose buffers are shorter than its vertices and instances need.
        unsafe { self.gl.draw_arrays_instanced(mode, 0, count, instances) }
    }

    /// Draws the vertices of the bound index buffer, with 32-bit indices.
    pub(super) fn draw_elements(&self, mode: u32, count: i32, instances: i32) {
        // SAFETY: `vertices` rejects a draw whose buffers are shorter than its indices and instances need, and the
        // index buffer has as many indices as are drawn.
        unsafe { self.gl.draw_elements_instanced(mode, count, glow::UNSIGNED_INT, 0, instances) }
    }

    /// Fills a level of the bound texture. Returns `false` if there are too few bytes.
    pub(super) fn tex_image(
        &self,
        target: u32,
        dimensions: Dimensions,
        level: i32,
        size: Size,
        layout: PixelLayout,
        bytes: &[u8],
    ) -> bool {
        let texels = size.width as usize * size.height as usize * size.depth as usize;
        if bytes.len() < texels * layout.bytes {
            return false;
        }
        let (width, height, depth) = (size.width as i32, size.height as i32, size.depth as i32);
        let PixelLayout { internal, format, kind, .. } = layout;
        let internal = internal as i32;
        let texels = glow::PixelUnpackData::Slice(Some(bytes));
        // SAFETY: the number of bytes was checked; every layout's texels are a multiple of 4 bytes, so rows are not
        // padded.
        unsafe {
            match dimensions {
                Dimensions::One => self.gl.tex_image_1d(target, level, internal, width, 0, format, kind, texels),
                Dimensions::Two => {
                    self.gl.tex_image_2d(target, level, internal, width, height, 0, format, kind, texels);
                }
                Dimensions::Three => {
                    self.gl.tex_image_3d(target, level, internal, width, height, depth, 0, format, kind, texels);
                }
            }
        }
        true
    }

    /// The pixels of the current read buffer, bottom row first.
    pub(super) fn read_pixels(&self, width: u32, height: u32, layout: PixelLayout) -> Vec<u8> {
        let mut bytes = vec![0; width as usize * height as usize * layout.bytes];
        let pixels = glow::PixelPackData::Slice(Some(&mut bytes));
        // SAFETY: there is room for all rows, which are not padded, because the pack alignment is 1.
        unsafe {
            self.gl.pixel_store_i32(glow::PACK_ALIGNMENT, 1);
            self.gl.read_pixels(0, 0, width as i32, height as i32, layout.format, layout.kind, pixels);
        }
        bytes
    }

    /// Reports an error since the last call.
    pub(super) fn check(&self, doing: &str) -> Result<(), Error> {
        let name = match self.get_error() {
            glow::NO_ERROR => return Ok(()),
            glow::INVALID_ENUM => "GL_INVALID_ENUM",
            glow::INVALID_VALUE => "GL_INVALID_VALUE",
            glow::INVALID_OPERATION => "GL_INVALID_OPERATION",
            glow::INVALID_FRAMEBUFFER_OPERATION => "GL_INVALID_FRAMEBUFFER_OPERATION",
            glow::OUT_OF_MEMORY => "GL_OUT_OF_MEMORY",
            _ => "an error that OpenGL 3.2 does not know",
        };
        Err(Error::Refused(format!("{name} while {doing}")))
    }
}
