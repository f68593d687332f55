//! One frame: attachments, fixed-function state, draws, and the read-back to a [`Picture`].
//!
//! *Holds:* values are those that the format stores, without conversion except to `f64`. OpenGL's row 0 is the
//! lowest, a picture's the topmost. Coverage is the stencil that each written fragment sets, never inferred from
//! colors. `near_edge` and `undecided` are all `false`, because the driver does not report edges.

use super::api::{Api, PixelLayout};
use super::states::{STENCIL, color_layout, compare, factor, mode};
use super::{Error, Gl, fixed, programs, textures, uniforms, vertices};
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_scene::picture::Picture;
use glisten_scene::{Blend, Cull, Draw, Format, Framebuffer, Scene, State};
use std::sync::Arc;

impl Gl {
    /// Draws a scene.
    ///
    /// # Errors
    /// [`Error::Compile`] and [`Error::Link`] if the driver rejects a program, [`Error::Unsupported`] and
    /// [`Error::Refused`] if it rejects the scene.
    pub fn render(&self, scene: &Scene) -> Result<Picture, Error> {
        let compatibility = scene.draws.iter().any(|draw| fixed::needs_compatibility(&draw.program));
        let context = self.context(compatibility)?;
        let api = context.api();
        attach(api, &scene.framebuffer)?;
        clear(api, &scene.framebuffer);
        api.check("clearing")?;
        let mut linked: Vec<(&Arc<Program>, glow::Program)> = Vec::new();
        for draw in &scene.draws {
            let known = linked.iter().find(|(program, _)| Arc::ptr_eq(program, &draw.program));
            let program = match known {
                Some((_, known)) => *known,
                None => {
                    let made = programs::link(api, &draw.program, generated(draw))?;
                    linked.push((&draw.program, made));
                    made
                }
            };
            self::draw(api, &scene.framebuffer, program, draw)?;
        }
        let mut picture = picture(api, &scene.framebuffer)?;
        complete(&mut picture, scene);
        Ok(picture)
    }
}

/// Fills in components that no draw writes, because its output has fewer than four. OpenGL leaves them undefined (3.2 §3.9.2); the
/// other runners have (0, 0, 0, 1).
fn complete(picture: &mut Picture, scene: &Scene) {
    let size_at = |draw: &Draw, location: u32| {
        let output = draw.program.interface.outputs.iter().find(|output| output.location == location)?;
        Some(draw.program.types.flat_len(output.ty) as usize)
    };
    for (location, pixels) in (0..).zip(&mut picture.attachments) {
        let size = scene.draws.iter().filter_map(|draw| size_at(draw, location)).max().unwrap_or(4);
        for (pixel, _) in pixels.iter_mut().zip(&picture.covered).filter(|(_, covered)| **covered) {
            for (channel, value) in [0.0, 0.0, 0.0, 1.0].into_iter().enumerate().skip(size) {
                pixel[channel] = value;
            }
        }
    }
}

/// Creates and binds the attachments.
fn attach(api: &Api, framebuffer: &Framebuffer) -> Result<(), Error> {
    let Framebuffer { width, height, attachments, format, .. } = *framebuffer;
    let limit = api.max_side();
    if width == 0 || height == 0 || width > limit || height > limit {
        let message =
            format!("a framebuffer of {width} x {height} pixels; this driver takes 1 to {limit} in each direction");
        return Err(Error::Refused(message));
    }
    let made = api.create_framebuffer().map_err(Error::Refused)?;
    api.bind_framebuffer(glow::FRAMEBUFFER, Some(made));
    let colors = (0..attachments).map(|number| (glow::COLOR_ATTACHMENT0 + number, color_layout(format)));
    for (place, layout) in colors.chain([(glow::DEPTH_STENCIL_ATTACHMENT, STENCIL)]) {
        let buffer = api.create_renderbuffer().map_err(Error::Refused)?;
        api.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
        api.renderbuffer_storage(glow::RENDERBUFFER, layout.internal, width as i32, height as i32);
        api.framebuffer_renderbuffer(glow::FRAMEBUFFER, place, glow::RENDERBUFFER, Some(buffer));
    }
    if api.check_framebuffer_status(glow::FRAMEBUFFER) != glow::FRAMEBUFFER_COMPLETE {
        return Err(Error::Unsupported("a framebuffer of this format with depth as 32-bit float".to_owned()));
    }
    api.viewport(0, 0, width as i32, height as i32);
    api.check("making the framebuffer")
}

fn clear(api: &Api, framebuffer: &Framebuffer) {
    let places: Vec<u32> = (0..framebuffer.attachments).map(|number| glow::COLOR_ATTACHMENT0 + number).collect();
    api.draw_buffers(&places);
    for index in 0..framebuffer.attachments {
        match framebuffer.format {
            Format::Rgba32Sint => {
                api.clear_buffer_i32_slice(glow::COLOR, index, &framebuffer.clear.map(|value| value as i32));
            }
            Format::Rgba32Uint => {
                api.clear_buffer_u32_slice(glow::COLOR, index, &framebuffer.clear.map(|value| value as u32));
            }
            Format::Rgba32Float | Format::Rgba16Float | Format::Rgba8Unorm => {
                api.clear_buffer_f32_slice(glow::COLOR, index, &framebuffer.clear.map(|value| value as f32));
            }
        }
    }
    api.clear_buffer_depth_stencil(glow::DEPTH_STENCIL, 0, 1.0, 0);
}

/// The stage that the driver's fixed-function pipeline provides.
fn generated(draw: &Draw) -> Option<Stage> {
    draw.fixed.as_ref()?.generated.as_ref().map(|(stage, _)| *stage)
}

fn draw(api: &Api, framebuffer: &Framebuffer, linked: glow::Program, draw: &Draw) -> Result<(), Error> {
    api.use_program(Some(linked));
    if let (Some(old), Some(state)) = (api.old(), &draw.fixed) {
        fixed::set(api, old, state)?;
    }
    uniforms::set(api, linked, draw)?;
    textures::bind(api, linked, draw, framebuffer)?;
    vertices::bind(api, draw)?;
    // An attachment without an output keeps its color; OpenGL leaves undefined what it would become.
    let places: Vec<u32> = (0..framebuffer.attachments)
        .map(|number| if draw.program.writes_color(number) { glow::COLOR_ATTACHMENT0 + number } else { glow::NONE })
        .collect();
    api.draw_buffers(&places);
    set_state(api, &draw.state, draw.fixed.as_ref().map_or(0, |fixed| fixed.switches.disabled_distances));
    api.check("setting the state")?;
    let (mode, instances) = (mode(draw.state.primitive), draw.instances as i32);
    match &draw.indices {
        Some(indices) => {
            let count = (draw.vertex_count as usize).min(indices.len());
            api.draw_elements(mode, count as i32, instances);
        }
        None => api.draw_arrays(mode, draw.vertex_count as i32, instances),
    }
    api.check("drawing")
}

/// Sets the state; `disabled` has a bit for each clip distance that is off below the last one that is on.
fn set_state(api: &Api, state: &State, disabled: u8) {
    let switch = |what: u32, on: bool| if on { api.enable(what) } else { api.disable(what) };
    switch(glow::DITHER, false);
    // WebGPU has only seamless cubes, and scenes specify them.
    switch(glow::TEXTURE_CUBE_MAP_SEAMLESS, true);
    switch(glow::PROGRAM_POINT_SIZE, state.program_point_size);
    for plane in 0..8 {
        switch(glow::CLIP_DISTANCE0 + plane, plane < state.clip_distances && disabled >> plane & 1 == 0);
    }
    api.provoking_vertex(if state.provoking_last {
        glow::LAST_VERTEX_CONVENTION
    } else {
        glow::FIRST_VERTEX_CONVENTION
    });
    api.front_face(if state.front_ccw { glow::CCW } else { glow::CW });
    switch(glow::CULL_FACE, state.cull != Cull::None);
    api.cull_face(if state.cull == Cull::Front { glow::FRONT } else { glow::BACK });
    switch(glow::DEPTH_TEST, state.depth_test);
    api.depth_func(compare(state.depth_func));
    api.depth_mask(state.depth_write);
    // The coverage: 1 wherever a fragment is written.
    switch(glow::STENCIL_TEST, true);
    api.stencil_func(glow::ALWAYS, 1, 0xff);
    api.stencil_op(glow::KEEP, glow::KEEP, glow::REPLACE);
    switch(glow::BLEND, state.blend.is_some());
    if let Some(Blend { source, destination, constant: [r, g, b, a] }) = state.blend {
        api.blend_func(factor(source), factor(destination));
        api.blend_color(r, g, b, a);
    }
}

fn picture(api: &Api, framebuffer: &Framebuffer) -> Result<Picture, Error> {
    let Framebuffer { width, height, format, .. } = *framebuffer;
    let read = |layout: PixelLayout| {
        let bytes = api.read_pixels(width, height, layout);
        let rows: Vec<&[u8]> = bytes.chunks(width as usize * layout.bytes).rev().collect();
        rows.concat()
    };
    let mut attachments = Vec::new();
    for number in 0..framebuffer.attachments {
        api.read_buffer(glow::COLOR_ATTACHMENT0 + number);
        attachments.push(decode(format, &read(color_layout(format))));
    }
    let covered: Vec<bool> = read(STENCIL).into_iter().map(|stencil| stencil != 0).collect();
    api.check("reading the picture")?;
    let open = vec![false; covered.len()];
    Ok(Picture {
        width,
        height,
        attachments,
        covered,
        intervals: None,
        undecided: open.clone(),
        near_edge: open,
        silhouette: Vec::new(),
        owner_width: Vec::new(),
    })
}

/// The pixels of an attachment.
fn decode(format: Format, bytes: &[u8]) -> Vec<[f64; 4]> {
    let word = |number: &[u8]| number.try_into().map_or(0, u32::from_ne_bytes);
    let channel: &dyn Fn(&[u8]) -> f64 = match format {
        Format::Rgba32Float | Format::Rgba16Float => &|bytes| f64::from(f32::from_bits(word(bytes))),
        Format::Rgba32Sint => &|bytes| f64::from(word(bytes).cast_signed()),
        Format::Rgba32Uint => &|bytes| f64::from(word(bytes)),
        Format::Rgba8Unorm => &|bytes| bytes.first().map_or(0.0, |&byte| f64::from(byte) / 255.0),
    };
    let size = color_layout(format).bytes;
    let pixel = |pixel: &[u8]| {
        let mut channels = pixel.chunks_exact(size / 4).map(channel);
        std::array::from_fn(|_| channels.next().unwrap_or(0.0))
    };
    bytes.chunks_exact(size).map(pixel).collect()
}
