//! Runs the commands of a test in order.
//!
//! *Holds:* draws are collected, and painted when a probe needs the picture; a clear discards them. Each draw keeps
//! the uniforms and the state of its command.

use super::draw::{self, Geometry};
use super::fixed::{self, FixedSetup};
use super::known::{self, CAPABILITIES, COMPARISONS, FACTORS};
use super::parse::{TestFile, parse};
use super::program::Built;
use super::textures::Units;
use super::uniforms::Uniforms;
use super::vertex_data::{self, VertexData};
use super::words::{Line, Words};
use super::{TestBackend, TestResult, fail, introspection, probe, program, require, skip};
use crate::scene::{Blend, BlendFactor, Compare, Cull, Draw, Format, Framebuffer, Primitive, Scene, State};
use glisten_front::compiler::Compiler;
use glisten_front::hir::{Scalar, Stage, Type};
use glisten_front::link::{FixedState, Program};
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
    known::check_commands(&file.commands)?;
    let data = vertex_data::parse(&file.vertex_data)?;
    let Some(built) = program::build(name, &file, &setup, compiler)? else { return Ok(()) };
    let data = draw::for_program(&built.program, data)?;
    let mut session = TestSession::new(built, data, setup.size);
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
    built: Built,
    data: VertexData,
    uniforms: Uniforms,
    units: Units,
    state: State,
    fixed: FixedSetup,
    /// The enabled GL_CLIP_DISTANCEi, one bit each.
    clip: u32,
    blending: bool,
    factors: Blend,
    element: u32,
    framebuffer: Framebuffer,
    /// The color of the next clear.
    clear_color: [f64; 4],
    tolerance: [f64; 4],
    draws: Vec<Draw>,
    /// The picture of all draws so far.
    picture: Option<Picture>,
}

/// The default tolerance of shader_runner.
const TOLERANCE: f64 = 0.01;
/// The largest number of draws between two clears, all of which each probe paints.
const MOST_DRAWS: usize = 1024;

impl TestSession {
    fn new(built: Built, data: VertexData, [width, height]: [u32; 2]) -> Self {
        let program = Arc::clone(&built.program);
        let state = State { primitive: Primitive::TriangleStrip, ..State::INITIAL };
        // A window stores 8 bits per channel.
        let framebuffer = Framebuffer {
            width,
            height,
            clear: [0.0; 4],
            format: Format::Rgba8Unorm,
            attachments: 1,
            encode: Transfer::Linear.into(),
        };
        Self {
            uniforms: Uniforms::new(&program),
            program,
            built,
            fixed: FixedSetup::default(),
            data,
            units: Units::default(),
            state,
            clip: 0,
            blending: false,
            factors: Blend::new(BlendFactor::One, BlendFactor::Zero),
            element: 0,
            framebuffer,
            clear_color: [0.0; 4],
            tolerance: [TOLERANCE; 4],
            draws: Vec::new(),
            picture: None,
        }
    }

    fn command(&mut self, line: &Line, backend: &mut dyn TestBackend) -> Result<(), TestResult> {
        let mut words = Words::new(line.number, &line.text);
        if probe::is_probe(&words) {
            let tolerance = self.tolerance;
            let short = self.uniforms.short.clone();
            return probe::check(words, self.drawn(backend)?, tolerance).map_err(|failure| failure.because(short));
        }
        self.change(line, &mut words)?;
        words.end()
    }

    /// Runs a command that looks at no picture.
    fn change(&mut self, line: &Line, words: &mut Words<'_>) -> Result<(), TestResult> {
        match words.word()? {
            "clear" => self.clear(words),
            "draw" => self.draw(words),
            "uniform" if self.fixed.uniform(words) => {
                words.pass_over();
                Ok(())
            }
            "uniform" => self.uniforms.set(&self.program, words, self.element),
            "tolerance" => {
                self.tolerance = words.numbers()?;
                match self.tolerance.iter().find(|tolerance| **tolerance < 0.0) {
                    Some(negative) => fail(words.line, format_args!("{negative} is no tolerance: it is negative")),
                    None => Ok(()),
                }
            }
            "enable" => self.capability(words, true),
            "disable" => self.capability(words, false),
            "texture" => self.units.create(words),
            "texparameter" => self.units.parameter(words),
            "active" if words.eat("uniform") => introspection::check(&self.program, words),
            "link" if words.eat("success") => Ok(()),
            "provoking" if words.eat("vertex") => self.provoking(words),
            "ubo" | "block" if words.eat("array index") => {
                self.element = words.count()?;
                Ok(())
            }
            "blend" if words.eat("func") => {
                self.factors = Blend::new(factor(words)?, factor(words)?);
                Ok(())
            }
            "depthfunc" => {
                self.state.depth_func = comparison(words)?;
                Ok(())
            }
            "polygon" => skip(line.number, "`polygon mode`: WebGPU draws polygons filled"),
            "ortho" => self.fixed.ortho(words, [self.framebuffer.width, self.framebuffer.height]),
            "frustum" => self.fixed.frustum(words),
            "color" => self.fixed.color(words),
            "clip" if words.eat("plane") => self.fixed.clip_plane(words),
            "shade" if words.eat("model") => self.fixed.shade_model(words),
            // What no shader sees.
            "hint" => {
                words.pass_over();
                Ok(())
            }
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
            ["depth", depth] if depth.parse() == Ok(1.0) => {
                words.pass_over();
                Ok(())
            }
            ["depth", ..] => skip(words.line, format_args!("`clear {}` is not supported", words.rest().join(" "))),
            [] => {
                self.framebuffer.clear = self.clear_color;
                self.draws.clear();
                self.picture = None;
                Ok(())
            }
            [other, ..] => known::mistake(words.line, other, "cleared", ["color", "depth"]),
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
            "GL_VERTEX_PROGRAM_TWO_SIDE" | "GL_VERTEX_PROGRAM_TWO_SIDE_ARB" => self.fixed.two_side = on,
            "GL_DEPTH_TEST" => self.state.depth_test = on,
            "GL_BLEND" => self.blending = on,
            "GL_CULL_FACE" => self.state.cull = if on { Cull::Back } else { Cull::None },
            "GL_PROGRAM_POINT_SIZE" | "GL_VERTEX_PROGRAM_POINT_SIZE" => self.state.program_point_size = on,
            _ => return known::unsupported(words.line, name, "a capability of OpenGL", CAPABILITIES),
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
            return skip(line, "a draw with one of the two stages alone");
        }
        if self.draws.len() >= MOST_DRAWS {
            return skip(line, format_args!("more than {MOST_DRAWS} draws without a clear"));
        }
        if fixed::reads_distance(&self.program) && !(self.clip + 1).is_power_of_two() {
            return skip(line, "enabled clip distances with gaps, which the fragment shader reads");
        }
        let size = [self.framebuffer.width, self.framebuffer.height];
        let geometry = draw::parse(words, &self.program, &self.data, size)?;
        let draw = self.scene_draw(line, geometry)?;
        self.draws.push(draw);
        self.picture = None;
        Ok(())
    }

    fn scene_draw(&mut self, line: u32, mut geometry: Geometry) -> Result<Draw, TestResult> {
        let compared = self
            .program
            .interface
            .samplers
            .iter()
            .zip(&self.uniforms.units)
            .filter(|(slot, _)| matches!(self.program.types.get(slot.ty), Type::Sampler(kind) if kind.shadow));
        let depth_mode = self.units.depth_mode(line, compared.map(|(_, unit)| *unit))?;
        let switches = FixedState { depth_mode, ..self.fixed.switches(&self.program, self.clip) };
        let program = self.built.variant(switches)?;
        let interface = &program.interface;
        for (attribute, data) in interface.attributes.iter().zip(&mut geometry.attributes) {
            if data.is_none() {
                let is_float = program.types.scalar_of(attribute.ty) == Some(Scalar::Float);
                *data = self.fixed.current(&attribute.name, is_float && attribute.columns == 1);
            }
            if attribute.active && data.is_none() {
                return skip(line, format_args!("no data for the attribute `{}`", attribute.name));
            }
        }
        let fixed = self.fixed.draw(switches, self.clip);
        let own = &self.program.interface.roots;
        let uniforms = interface.roots.iter().map(|root| {
            let set = || {
                let index = own.iter().position(|known| known.name == root.name)?;
                self.uniforms.values.roots.get(index).cloned()
            };
            self.fixed.value(&fixed, root).or_else(set).unwrap_or_default()
        });
        let uniforms = uniforms.collect();
        let mut textures = Vec::new();
        for (slot, &unit) in interface.samplers.iter().zip(&self.uniforms.units) {
            let Type::Sampler(kind) = program.types.get(slot.ty) else { continue };
            textures.push(Some(self.units.texture(line, unit, kind)?));
        }
        let state = State {
            primitive: geometry.primitive,
            blend: self.blending.then_some(self.factors),
            clip_distances: u32::BITS - self.clip.leading_zeros(),
            ..self.state
        };
        Ok(Draw {
            program: Arc::clone(&program),
            state,
            vertex_count: geometry.count,
            indices: geometry.indices,
            instances: geometry.instances,
            attributes: geometry.attributes,
            uniforms,
            textures,
            dynamic: Vec::new(),
            fixed: fixed::shared(fixed),
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

fn factor(words: &mut Words<'_>) -> Result<BlendFactor, TestResult> {
    let name = words.word()?;
    BlendFactor::of_opengl(name).map_or_else(|| known::unsupported(words.line, name, "a factor", FACTORS), Ok)
}

fn comparison(words: &mut Words<'_>) -> Result<Compare, TestResult> {
    let name = words.word()?;
    Compare::of_opengl(name).map_or_else(|| known::unsupported(words.line, name, "a comparison", COMPARISONS), Ok)
}
