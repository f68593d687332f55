//! The state of the fixed-function pipeline that tests set: projections, clip planes, the current color; and the stage that
//! a test leaves to that pipeline.
//!
//! *In:* commands, and the stages that a test has. *Out:* values of uniforms and attributes, [`FixedState`], texts.

use super::words::Words;
use super::{TestResult, known};
use crate::scene::{AttributeData, AttributeValues};
use glisten_front::hir::{ArraySize, Global, ScalarValue, Shader, Stage, Storage, Type, Types};
use glisten_front::link::{FixedState, Program, UniformRoot};
use glisten_scene::FixedDraw;
use glisten_scene::fixed::{
    FixedFunction, GlslDialect, Pipeline, TextureUnit, UNITS, current_attribute, is_fixed_uniform,
};
use std::sync::Arc;

/// The state that the commands have set.
#[derive(Clone, Debug, Default)]
pub(super) struct FixedSetup {
    state: FixedFunction,
    /// `color`: what all vertices have as `gl_Color` without data.
    color: Option<[f64; 4]>,
    /// Derived state that a test sets nevertheless.
    explicit: Vec<String>,
    /// `GL_VERTEX_PROGRAM_TWO_SIDE`
    pub(super) two_side: bool,
    /// `shade model flat`
    flat_colors: bool,
}

impl FixedSetup {
    /// `ortho`, `ortho 0 1 0 1`: the projection from the window's pixels, or from a rectangle.
    pub(super) fn ortho(&mut self, words: &mut Words<'_>, size: [u32; 2]) -> Result<(), TestResult> {
        let whole = [0.0, f64::from(size[0]), 0.0, f64::from(size[1])];
        let [left, right, bottom, top] = if words.rest().is_empty() { whole } else { words.numbers()? };
        let (x, y) = (2.0 / (right - left), 2.0 / (top - bottom));
        let (to_x, to_y) = (-(right + left) / (right - left), -(top + bottom) / (top - bottom));
        self.project([x, 0.0, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, to_x, to_y, 0.0, 1.0]);
        Ok(())
    }

    /// `frustum left right bottom top near far` (OpenGL 2.1 §2.11.2).
    pub(super) fn frustum(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        let [left, right, bottom, top, near, far] = words.numbers()?;
        let (x, y) = (2.0 * near / (right - left), 2.0 * near / (top - bottom));
        let (a, b) = ((right + left) / (right - left), (top + bottom) / (top - bottom));
        let (c, d) = (-(far + near) / (far - near), -2.0 * far * near / (far - near));
        self.project([x, 0.0, 0.0, 0.0, 0.0, y, 0.0, 0.0, a, b, c, -1.0, 0.0, 0.0, d, 0.0]);
        Ok(())
    }

    fn project(&mut self, columns: [f64; 16]) {
        // The names and the number of values are right.
        let _ = self.state.set("gl_ProjectionMatrix", &columns);
    }

    /// `clip plane 0 a b c d`
    pub(super) fn clip_plane(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        let index = words.count()? as usize;
        let plane: [f64; 4] = words.numbers()?;
        match self.state.clip_planes.get_mut(index) {
            Some(slot) => {
                *slot = plane;
                Ok(())
            }
            None => super::fail(words.line, format_args!("there is no clip plane {index}")),
        }
    }

    /// Sets state by the name of its uniform: `uniform vec4 gl_FrontMaterial.diffuse 0.2 0 0 1`. Returns false for other
    /// uniforms, and for derived state, which then keeps the uniform's own value.
    pub(super) fn uniform(&mut self, words: &Words<'_>) -> bool {
        let [_, name, values @ ..] = words.rest() else { return false };
        let root = name.split(['.', '[']).next().unwrap_or_default();
        if !is_fixed_uniform(root) {
            return false;
        }
        let values: Option<Vec<f64>> = values.iter().map(|word| word.parse().ok()).collect();
        let is_set = values.is_some_and(|values| self.state.set(name, &values).is_ok());
        if !is_set {
            self.explicit.push(root.to_owned());
        }
        is_set
    }

    /// The values of a uniform of the fixed-function pipeline.
    pub(super) fn value(&self, draw: &FixedDraw, root: &UniformRoot) -> Option<Vec<ScalarValue>> {
        if root.block.is_some() || !is_fixed_uniform(&root.name) || self.explicit.contains(&root.name) {
            return None;
        }
        draw.state.root_values(root)
    }

    /// `shade model flat`
    pub(super) fn shade_model(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        self.flat_colors = match words.word()? {
            "flat" => true,
            "smooth" => false,
            other => return known::mistake(words.line, other, "a model of shading", ["flat", "smooth"]),
        };
        Ok(())
    }

    /// `color r g b a`
    pub(super) fn color(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        self.color = Some(words.numbers()?);
        Ok(())
    }

    /// The state that a program is compiled for. Planes that are not enabled clip nothing ([`Self::draw`]).
    pub(super) fn switches(&self, program: &Program, clip: u32) -> FixedState {
        let highest = u32::BITS - clip.leading_zeros();
        let by_distance = clips_by_distance(program);
        let disabled_distances = if by_distance { !clip & ((1 << highest) - 1) } else { 0 };
        FixedState {
            two_side: self.two_side,
            flat_colors: self.flat_colors,
            // By `gl_ClipVertex`, or by `gl_Position` (GLSL 1.30 §7.1).
            clip_planes: if by_distance { 0 } else { highest },
            disabled_distances: disabled_distances as u8,
            ..FixedState::default()
        }
    }

    /// The state of a draw.
    pub(super) fn draw(&self, switches: FixedState, clip: u32) -> FixedDraw {
        let mut state = self.state.clone();
        for (index, plane) in (0..).zip(&mut state.clip_planes) {
            if clip >> index & 1 == 0 {
                *plane = [0.0; 4];
            }
        }
        FixedDraw { state, switches, generated: None }
    }

    /// The data of an attribute without any: the current value, the same for all vertices (OpenGL 3.2 §2.7).
    pub(super) fn current(&self, name: &str, is_float: bool) -> Option<AttributeData> {
        let values = match (name, self.color) {
            ("gl_Color", Some(color)) => color.map(|value| value as f32).to_vec(),
            _ => current_attribute(name).unwrap_or_else(|| vec![0.0, 0.0, 0.0, 1.0]),
        };
        let size = values.len() as u32;
        // One row for all instances.
        is_float.then_some(AttributeData { size, divisor: u32::MAX, values: AttributeValues::Float(values) })
    }
}

/// Whether a clip distance is written.
pub(super) fn clips_by_distance(program: &Program) -> bool {
    let mut globals = program.stages.iter().flat_map(|shader| &shader.globals);
    globals.any(|global| global.name == "gl_ClipDistance" && global.storage == Storage::Out)
}

/// Whether the fragment stage reads a clip distance.
pub(super) fn reads_distance(program: &Program) -> bool {
    let fragment = program.stage(Stage::Fragment);
    fragment.is_some_and(|shader| shader.globals.iter().any(|global| global.name == "gl_ClipDistance"))
}

/// The text of a stage that a test leaves to the fixed-function pipeline. `known` is the stage next to it.
pub(super) fn other_stage(stage: Stage, types: &Types, known: Option<&Shader>, clips: bool) -> String {
    let colors = |global: &Global| global.name == "gl_FrontColor" && global.written;
    if stage == Stage::Fragment && !known.is_some_and(|shader| shader.globals.iter().any(colors)) {
        // The color is undefined (OpenGL 3.2 §2.11).
        return "#version 120\nvoid main() { gl_FragColor = vec4(0.0, 0.0, 0.0, 1.0); }\n".into();
    }
    let modern = known.is_some_and(|shader| shader.version.number >= 140);
    let dialect = if modern { GlslDialect::V150 } else { GlslDialect::V120 };
    let mut pipeline = Pipeline { dialect, clip: clips, ..Pipeline::default() };
    let coordinates = known.and_then(|shader| shader.globals.iter().find(|global| global.name == "gl_TexCoord"));
    if let Some(global) = coordinates.filter(|_| stage == Stage::Vertex) {
        let size = match types.get(global.ty) {
            Type::Array(_, ArraySize::Sized(size)) => size as usize,
            _ => UNITS,
        };
        pipeline.units.iter_mut().take(size).for_each(|unit| *unit = Some(TextureUnit::default()));
        pipeline.texture_coordinates = Some(size as u32).filter(|_| size != UNITS);
    }
    if stage == Stage::Vertex { pipeline.vertex() } else { pipeline.fragment() }
}

/// A draw's state for a runner that has the pipeline itself.
pub(super) fn shared(draw: FixedDraw) -> Option<Arc<FixedDraw>> {
    Some(Arc::new(draw))
}
