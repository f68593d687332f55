//! Runs the commands of a test in order.
//!
//! *Holds:* draws are collected, and painted when a probe needs the picture; a clear discards them. Each draw keeps
//! the uniforms and the state of its command.

use super::draw::{self, Geometry};
use super::parse::{Line, TestFile, parse};
use super::textures::Units;
use super::uniforms::Uniforms;
use super::vertex_data::{self, VertexData};
use super::words::Words;
use super::{TestBackend, TestResult, fail, fixed, introspection, probe, program, require, skip};
use crate::scene::{BlendFactor, Compare, Cull, Draw, Format, Framebuffer, Primitive, Scene, State};
use glisten_front::compiler::Compiler;
use glisten_front::hir::{Stage, Type};
use glisten_front::link::{FixedState, Program};
use glisten_scene::fixed::{FixedFunction, OtherStage};
use glisten_scene::picture::{Picture, Transfer};
use std::sync::Arc;

/// Runs a test; `Ok` means that it passes.
pub(super) fn run(
    name: &str,
    text: &str,
    compiler: &Compiler,
    backend: &mut dyn TestBackend,
) -> Result<(), TestResult> {
    let file = parse(text)?;
    let setup = require::check(&file.requirements)?;
    let data = vertex_data::parse(&file.vertex_data)?;
    let switches = fixed::switches(&file.commands);
    let compiler = fixed::compiler(compiler, switches);
    let Some((program, generated)) = program::build(name, &file, &setup, &compiler)? else { return Ok(()) };
    let mut session = TestSession::new(program, data, setup.size);
    (session.switches, session.generated) = (switches, generated);
    commands(&file, &mut session, backend)
}

fn commands(file: &TestFile, session: &mut TestSession, backend: &mut dyn TestBackend) -> Result<(), TestResult> {
    for line in &file.commands {
        session.command(line, backend)?;
    }
    Ok(())
}

/// The state that commands change.
struct TestSession {
    program: Arc<Program>,
    data: VertexData,
    uniforms: Uniforms,
    units: Units,
    state: State,
    /// The enabled GL_CLIP_DISTANCEi, one bit each.
    clip: u32,
    blending: bool,
    factors: (BlendFactor, BlendFactor),
    element: u32,
    framebuffer: Framebuffer,
    /// The color of the next clear.
    clear_color: [f64; 4],
    tolerance: [f64; 4],
    draws: Vec<Draw>,
    /// The picture of all draws so far.
    picture: Option<Picture>,
    /// The state of the fixed-function pipeline.
    fixed: FixedFunction,
    switches: FixedState,
    /// The stage that the test lacks.
    generated: Option<OtherStage>,
}

/// The default tolerance of shader_runner.
const TOLERANCE: f64 = 0.01;
/// The largest number of draws between two clears, all of which each probe paints.
const MOST_DRAWS: usize = 1024;

impl TestSession {
    fn new(program: Arc<Program>, data: VertexData, [width, height]: [u32; 2]) -> Self {
        let state = State { primitive: Primitive::TriangleStrip, ..State::INITIAL };
        // A window stores 8 bits per channel.
        let framebuffer = Framebuffer {
            width,
            height,
            clear: [0.0; 4],
            format: Format::Rgba8Unorm,
            attachments: 1,
            encode: Transfer::Linear,
        };
        Self {
            uniforms: Uniforms::new(&program),
            program,
            data,
            units: Units::default(),
            state,
            clip: 0,
            blending: false,
            factors: (BlendFactor::One, BlendFactor::Zero),
            element: 0,
            framebuffer,
            clear_color: [0.0; 4],
            tolerance: [TOLERANCE; 4],
            draws: Vec::new(),
            picture: None,
            fixed: FixedFunction::default(),
            switches: FixedState::default(),
            generated: None,
        }
    }

    fn command(&mut self, line: &Line, backend: &mut dyn TestBackend) -> Result<(), TestResult> {
        let mut words = Words::new(line.number, &line.text);
        if probe::is_probe(&words) {
            let tolerance = self.tolerance;
            return probe::check(words, self.drawn(backend)?, tolerance);
        }
        match words.word()? {
            "clear" => self.clear(&mut words),
            "draw" => self.draw(&mut words),
            "uniform" => {
                let line = line.text.clone();
                self.uniforms.set(&self.program, &mut words, self.element)?;
                self.set_state(&line);
                Ok(())
            }
            "tolerance" => {
                self.tolerance = words.numbers()?;
                Ok(())
            }
            "enable" => self.capability(&mut words, true),
            "disable" => self.capability(&mut words, false),
            "texture" => self.units.create(&mut words),
            "texparameter" => self.units.parameter(&mut words),
            "active" if words.eat("uniform") => introspection::check(&self.program, &mut words),
            "link" if words.eat("success") => Ok(()),
            "provoking" if words.eat("vertex") => self.provoking(&mut words),
            "ubo" | "block" if words.eat("array index") => {
                self.element = words.count()?;
                Ok(())
            }
            "blend" if words.eat("func") => {
                self.factors = (named(&mut words, BlendFactor::of_opengl)?, named(&mut words, BlendFactor::of_opengl)?);
                Ok(())
            }
            "depthfunc" => {
                self.state.depth_func = named(&mut words, Compare::of_opengl)?;
                Ok(())
            }
            "polygon" => skip(line.number, "`polygon mode`: WebGPU draws polygons filled"),
            "ortho" => self.ortho(&mut words),
            "clip" if words.eat("plane") => {
                let index = words.count()?;
                let plane = words.numbers()?;
                let slot = self.fixed.clip_planes.get_mut(index as usize);
                slot.into_iter().for_each(|slot| *slot = plane);
                fixed::apply(&self.program, &self.fixed, &mut self.uniforms.values);
                Ok(())
            }
            // What no shader sees.
            "frustum" | "hint" | "shade" => Ok(()),
            _ => skip(line.number, format_args!("`{}` is not supported", line.text)),
        }
    }

    fn clear(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        match words.rest() {
            ["color", ..] => {
                words.word()?;
                self.clear_color = words.numbers()?;
                Ok(())
            }
            ["depth", depth] if depth.parse() == Ok(1.0) => Ok(()),
            [] => {
                self.framebuffer.clear = self.clear_color;
                self.draws.clear();
                self.picture = None;
                Ok(())
            }
            _ => skip(words.line, format_args!("`clear {}` is not supported", words.rest().join(" "))),
        }
    }

    /// `ortho`, `ortho 0 1 0 1`: the projection from the window's pixels, or from a rectangle, for programs that read the
    /// matrices of the fixed-function pipeline.
    fn ortho(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        let (width, height) = (f64::from(self.framebuffer.width), f64::from(self.framebuffer.height));
        let [left, right, bottom, top] =
            if words.rest().is_empty() { [0.0, width, 0.0, height] } else { words.numbers()? };
        let (x, y) = (2.0 / (right - left), 2.0 / (top - bottom));
        let (to_x, to_y) = (-(right + left) / (right - left), -(top + bottom) / (top - bottom));
        let columns = [x, 0.0, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, to_x, to_y, 0.0, 1.0];
        if self.fixed.set("gl_ProjectionMatrix", &columns).is_ok() {
            fixed::apply(&self.program, &self.fixed, &mut self.uniforms.values);
        }
        Ok(())
    }

    /// A uniform of the fixed-function pipeline is state, from which others follow.
    fn set_state(&mut self, line: &str) {
        let mut words = line.split_whitespace().skip(2);
        let Some(name) = words.next().filter(|name| name.starts_with("gl_")) else { return };
        let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
        if self.fixed.set(name, &numbers).is_ok() {
            fixed::apply(&self.program, &self.fixed, &mut self.uniforms.values);
        }
    }

    fn capability(&mut self, words: &mut Words<'_>, on: bool) -> Result<(), TestResult> {
        let name = words.word()?;
        let clip = name.strip_prefix("GL_CLIP_PLANE").or_else(|| name.strip_prefix("GL_CLIP_DISTANCE"));
        if let Some(index) = clip.and_then(|index| index.parse::<u32>().ok()).filter(|index| *index < 8) {
            self.clip = if on { self.clip | 1 << index } else { self.clip & !(1 << index) };
            return Ok(());
        }
        match name {
            "GL_DEPTH_TEST" => self.state.depth_test = on,
            "GL_BLEND" => self.blending = on,
            "GL_CULL_FACE" => self.state.cull = if on { Cull::Back } else { Cull::None },
            "GL_PROGRAM_POINT_SIZE" | "GL_VERTEX_PROGRAM_POINT_SIZE" => self.state.program_point_size = on,
            // The program is compiled for it.
            _ if fixed::TWO_SIDE.contains(&name) => {}
            _ => return skip(words.line, format_args!("`{name}` is not supported")),
        }
        Ok(())
    }

    fn provoking(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        self.state.provoking_last = match words.word()? {
            "first" => false,
            "last" => true,
            other => return fail(words.line, format_args!("`{other}` is neither `first` nor `last`")),
        };
        Ok(())
    }

    fn draw(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        let line = words.line;
        if self.program.stage(Stage::Vertex).is_none() || self.program.stage(Stage::Fragment).is_none() {
            return skip(line, "a draw with one of the two stages alone: the other one would be the fixed function");
        }
        if self.draws.len() >= MOST_DRAWS {
            return skip(line, format_args!("more than {MOST_DRAWS} draws without a clear"));
        }
        if !(self.clip + 1).is_power_of_two() {
            return skip(line, "enabled clip distances with gaps");
        }
        let size = [self.framebuffer.width, self.framebuffer.height];
        let mut geometry = draw::parse(words, &self.program, &self.data, size)?;
        fixed::fill_attributes(&self.program, &mut geometry.attributes);
        let draw = self.scene_draw(line, geometry)?;
        self.draws.push(draw);
        self.picture = None;
        Ok(())
    }

    fn scene_draw(&self, line: u32, geometry: Geometry) -> Result<Draw, TestResult> {
        let interface = &self.program.interface;
        let missing =
            interface.attributes.iter().zip(&geometry.attributes).find(|(a, data)| a.active && data.is_none());
        if let Some((attribute, _)) = missing {
            return skip(line, format_args!("no data for the attribute `{}`", attribute.name));
        }
        let mut textures = Vec::new();
        for (slot, &unit) in interface.samplers.iter().zip(&self.uniforms.units) {
            let Type::Sampler(kind) = self.program.types.get(slot.ty) else { continue };
            textures.push(self.units.texture(line, unit, kind)?);
        }
        let state = State {
            primitive: geometry.primitive,
            blend: self.blending.then_some(self.factors),
            clip_distances: self.clip.count_ones(),
            ..self.state
        };
        Ok(Draw {
            program: Arc::clone(&self.program),
            state,
            vertex_count: geometry.count,
            indices: geometry.indices,
            instances: geometry.instances,
            attributes: geometry.attributes,
            uniforms: self.uniforms.values.roots.clone(),
            textures,
            dynamic: Vec::new(),
            fixed: fixed::state(&self.program, &self.fixed, self.switches, self.generated.as_ref()),
        })
    }

    /// The picture of all draws since the last clear.
    fn drawn(&mut self, backend: &mut dyn TestBackend) -> Result<&Picture, TestResult> {
        let picture = match self.picture.take() {
            Some(picture) => picture,
            None => {
                let name = self.program.name.clone();
                backend.draw(&Scene { name, framebuffer: self.framebuffer, draws: self.draws.clone() })?
            }
        };
        Ok(self.picture.insert(picture))
    }
}

fn named<T>(words: &mut Words<'_>, of: impl Fn(&str) -> Option<T>) -> Result<T, TestResult> {
    let name = words.word()?;
    match of(name) {
        Some(value) => Ok(value),
        None => skip(words.line, format_args!("`{name}` is not supported")),
    }
}
