//! Evaluates one GLSL function for many inputs at once, on the reference and on a GPU, to test functions by value.
//!
//! *In:* a text with the function, its signature, and rows of numbers. *Out:* a [`Scene`] with one pixel (or a few)
//! per row, and the results, read from its picture. *Holds:* the reference's results keep the precision of its
//! domain.
//!
//! ```
//! use glisten_front::{Compiler, Options};
//! use glisten_reference::Precision;
//! use glisten_verify::evaluate::Evaluator;
//!
//! let text = "float lerp(float a, float b, float t) { return a + t * (b - a); }";
//! let lerp = Evaluator::new(&Compiler::new(Options::default()), text, "lerp(float,float,float)", &[])?;
//! let results = lerp.reference(&[0.0, 10.0, 0.25, 1.0, 3.0, 0.5], &[], Precision::F64)?;
//! assert_eq!(results, [[2.5], [2.0]]);
//! # Ok::<(), glisten_verify::evaluate::EvaluateError>(())
//! ```

mod generate;

use crate::scene::{
    Compare, Draw, Filter, Format, Framebuffer, Sampling, Scene, State, Texels, Texture, TextureLevel, Wrap,
};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::{SamplerDim, SamplerType, Scalar, Stage};
use glisten_front::link::Program;
use glisten_front::{Compiler, Source};
use glisten_reference::{Precision, RenderOptions};
use glisten_scene::picture::{Interval, Picture, Transfer};
use glisten_scene::values::UniformValues;
use std::fmt;
use std::sync::Arc;

pub use generate::Text;
pub(crate) use generate::signature_of;
pub use generate::signatures;

/// How many rows of inputs share a line of the picture.
const ROWS_A_LINE: usize = 64;
/// The largest number of lines: the height that every GPU can draw.
const MAX_LINES: usize = 8192;

/// Why a function cannot be evaluated.
#[derive(Clone, Debug)]
pub struct EvaluateError {
    /// The message, a sentence.
    pub message: String,
}

impl fmt::Display for EvaluateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for EvaluateError {}

impl EvaluateError {
    /// An error with this message.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into() }
    }

    /// An error with the codes and messages of diagnostics.
    pub fn told<'a>(diagnostics: impl IntoIterator<Item = &'a Diagnostic>) -> Self {
        let lines: Vec<String> = diagnostics.into_iter().map(|d| format!("{}: {}", d.code, d.message)).collect();
        Self::new(lines.join("; "))
    }
}

/// A program that calls one function for each row of inputs.
#[derive(Clone, Debug)]
pub struct Evaluator {
    program: Arc<Program>,
    /// The text of the fragment stage.
    text: String,
    /// Whether each number of a row is an integer.
    inputs: Vec<bool>,
    results: usize,
    /// Whether the results are integers.
    is_whole: bool,
    tables: usize,
}

impl Evaluator {
    /// Prepares the calls of a function.
    ///
    /// - `compiler`: its options and includes apply to the text.
    /// - `text`: GLSL 1.50 without a `#version` line and without `main`.
    /// - `signature`: in the form that [`signatures`] writes: `lerp(float,float,float)`. All parameters must be `in`.
    ///   Floats, vectors, matrices, `int`, `uint`, `bool`, structs and arrays of these, and `sampler2D` may be
    ///   parameters; floats, vectors, matrices, integers and booleans may be results.
    /// - `wraps`: the index of a parameter, not counting samplers, and a function that is applied to its value
    ///   before the call: `(0, "normalize")`.
    ///
    /// # Errors
    /// The text has errors, it has no such function, or a type is not supported.
    pub fn new(
        compiler: &Compiler,
        text: &str,
        signature: &str,
        wraps: &[(usize, &str)],
    ) -> Result<Self, EvaluateError> {
        Self::of_text(compiler, Text::new(text), signature, wraps)
    }

    /// Prepares the calls of a function of a text with a name and a version; see [`new`](Self::new).
    ///
    /// # Errors
    /// The text has errors, it has no such function, or a type is not supported.
    pub fn of_text(
        compiler: &Compiler,
        text: Text<'_>,
        signature: &str,
        wraps: &[(usize, &str)],
    ) -> Result<Self, EvaluateError> {
        let call = generate::Call::new(compiler, text, signature, wraps)?;
        let vertex = generate::vertex(text.version);
        let sources = [
            Source { name: "evaluate.vert".into(), text: vertex.into(), stage: Stage::Vertex },
            Source { name: text.name.into(), text: call.text.as_str().into(), stage: Stage::Fragment },
        ];
        let compilation = compiler.compile(&sources);
        let Some(program) = compilation.program else {
            return Err(EvaluateError::told(compilation.diagnostics.iter()));
        };
        let program = Arc::new(program);
        let generate::Call { text, inputs, results, is_whole, tables } = call;
        Ok(Self { program, text, inputs, results, is_whole, tables })
    }

    /// How many numbers a row of inputs has: the components of all parameters except samplers, in order.
    pub fn inputs(&self) -> usize {
        self.inputs.len()
    }

    /// How many numbers a result has.
    pub fn results(&self) -> usize {
        self.results
    }

    /// The generated fragment shader.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The program.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The floats that a result takes in the picture.
    fn floats(&self) -> usize {
        if self.is_whole { self.results * generate::FLOATS_A_WHOLE } else { self.results }
    }

    fn parts(&self) -> usize {
        self.floats().div_ceil(4)
    }

    /// The scene that calls the function for each row. `tables` are the textures for its samplers, in order. Integers keep all of
    /// their bits if the inputs are `f64`.
    ///
    /// # Errors
    /// The inputs are empty, not a whole number of rows, or too many (524,288 rows fit), or a table is missing.
    pub fn scene<T: Into<f64> + Copy>(&self, inputs: &[T], tables: &[Arc<Texture>]) -> Result<Scene, EvaluateError> {
        let rows = inputs.len().checked_div(self.inputs()).unwrap_or(1);
        if rows == 0 || rows * self.inputs() != inputs.len() || rows > ROWS_A_LINE * MAX_LINES {
            let message = format!("{} numbers do not form rows of {}", inputs.len(), self.inputs());
            return Err(EvaluateError::new(message));
        }
        if tables.len() != self.tables {
            return Err(EvaluateError::new(format!("the function has {} tables, not {}", self.tables, tables.len())));
        }
        let lines = rows.div_ceil(ROWS_A_LINE);
        let mut textures: Vec<Option<Arc<Texture>>> = Vec::new();
        for slot in &self.program.interface.samplers {
            let table = slot.name.strip_prefix(generate::TABLE).and_then(|index| index.parse::<usize>().ok());
            textures.push(match table {
                Some(index) => tables.get(index).cloned(),
                None if slot.name == generate::INPUTS => Some(Arc::new(self.packed(inputs, lines))),
                // A sampler of the text itself, which no called function reads.
                None => None,
            });
        }
        let attachments = self.attachment() as u32 + 1;
        let framebuffer = Framebuffer {
            width: (ROWS_A_LINE * self.parts()) as u32,
            height: lines as u32,
            clear: [0.0; 4],
            format: Format::Rgba32Float,
            attachments,
            encode: Transfer::Linear.into(),
        };
        let draw = Draw {
            program: Arc::clone(&self.program),
            state: State::INITIAL,
            vertex_count: 3,
            indices: None,
            instances: 1,
            attributes: Vec::new(),
            uniforms: UniformValues::initial(&self.program).roots,
            textures,
            dynamic: Vec::new(),
            fixed: None,
        };
        Ok(Scene { name: "evaluate".into(), framebuffer, draws: vec![draw] })
    }

    /// The inputs as texels: the numbers of a row side by side, 64 rows per line.
    fn packed<T: Into<f64> + Copy>(&self, inputs: &[T], lines: usize) -> Texture {
        let floats: usize = self.inputs.iter().map(|is_whole| 1 + usize::from(*is_whole)).sum();
        let texels_a_row = floats.div_ceil(4).max(1);
        let mut texels = vec![[0.0; 4]; lines * ROWS_A_LINE * texels_a_row];
        for (texels, row) in texels.chunks_mut(texels_a_row).zip(inputs.chunks(self.inputs().max(1))) {
            let mut to = texels.iter_mut().flatten();
            for (number, is_whole) in row.iter().zip(&self.inputs) {
                let number: f64 = (*number).into();
                let (first, second) = if *is_whole { halves(number) } else { (number as f32, None) };
                [Some(first), second].into_iter().flatten().zip(&mut to).for_each(|(from, to)| *to = from);
            }
        }
        let (width, height) = ((ROWS_A_LINE * texels_a_row) as u32, lines as u32);
        table_of(TextureLevel { width, height, depth: 1, texels: Texels::Float(texels) }, Filter::Nearest)
    }

    /// The color number of the results: the text may have outputs of its own.
    fn attachment(&self) -> usize {
        let outputs = &self.program.interface.outputs;
        outputs.iter().find(|output| output.name == generate::RESULT).map_or(0, |output| output.location as usize)
    }

    /// The results in a picture of the scene: for each row of inputs, [`results`](Self::results) numbers.
    pub fn read(&self, picture: &Picture, rows: usize) -> Vec<Vec<f64>> {
        let pixels = picture.attachments.get(self.attachment());
        let whole = |[_, high, low]: [f64; 3]| high * generate::HALF + low;
        pixels.map_or_else(Vec::new, |pixels| self.rows(pixels, [picture.width, picture.height], rows, whole))
    }

    /// The intervals of the results in a picture of the scene with envelopes.
    pub fn read_intervals(&self, picture: &Picture, rows: usize) -> Vec<Vec<Interval>> {
        let pixels = picture.intervals.as_ref().and_then(|all| all.get(self.attachment()));
        let whole = |[nearest, high, low]: [Interval; 3]| {
            let is_point = |half: Interval| half.low == half.high;
            let exact = high.low * generate::HALF + low.low;
            if is_point(high) && is_point(low) { Interval { low: exact, high: exact, ..nearest } } else { nearest }
        };
        pixels.map_or_else(Vec::new, |pixels| self.rows(pixels, [picture.width, picture.height], rows, whole))
    }

    /// The channels of the pixels of each row; `whole` makes an integer of its floats.
    fn rows<T: Copy>(
        &self,
        pixels: &[[T; 4]],
        [width, height]: [u32; 2],
        rows: usize,
        whole: impl Fn([T; generate::FLOATS_A_WHOLE]) -> T,
    ) -> Vec<Vec<T>> {
        let (parts, width, height) = (self.parts(), width as usize, height as usize);
        let row = |index: usize| {
            // Lines of the picture count from the top, `gl_FragCoord` from the bottom.
            let line = height.saturating_sub(index / ROWS_A_LINE + 1);
            let start = line * width + index % ROWS_A_LINE * parts;
            let floats = pixels.get(start..start + parts).unwrap_or(&[]).iter().flatten().copied();
            let floats: Vec<T> = floats.take(self.floats()).collect();
            match self.is_whole {
                true => floats.as_chunks().0.iter().map(|floats| whole(*floats)).collect(),
                false => floats,
            }
        };
        (0..rows).map(row).collect()
    }

    /// Calls the function for each row on the CPU reference.
    ///
    /// # Errors
    /// The errors of [`scene`](Self::scene), and those of the reference.
    pub fn reference(
        &self,
        inputs: &[f32],
        tables: &[Arc<Texture>],
        precision: Precision,
    ) -> Result<Vec<Vec<f64>>, EvaluateError> {
        let scene = self.scene(inputs, tables)?;
        let options = RenderOptions { precision, mark_edges: false, ..RenderOptions::default() };
        let picture = glisten_reference::render(&scene, &options).map_err(|errors| EvaluateError::told(&errors))?;
        Ok(self.read(&picture, inputs.len().checked_div(self.inputs()).unwrap_or(1)))
    }
}

/// The halves of an integer of 32 bits as floats, the upper one first; together they are its value.
fn halves(number: f64) -> (f32, Option<f32>) {
    let number = number.trunc();
    let high = (number / generate::HALF).floor();
    (high as f32, Some((number - high * generate::HALF) as f32))
}

fn table_of(level: TextureLevel, filter: Filter) -> Texture {
    let kind = SamplerType { texel: Scalar::Float, dim: SamplerDim::D2, arrayed: false, shadow: false };
    Texture {
        kind,
        levels: vec![level],
        filter,
        wrap: Wrap::ClampToEdge,
        compare: Compare::Lequal,
        sampling: Sampling::default(),
    }
}

/// A texture with one row of texels, clamped: a function of one number, for a `sampler2D`.
pub fn table(texels: Vec<[f32; 4]>, filter: Filter) -> Texture {
    let width = texels.len() as u32;
    table_of(TextureLevel { width, height: 1, depth: 1, texels: Texels::Float(texels) }, filter)
}
