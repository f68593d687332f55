//! A scene that runs one stage with any inputs.
//!
//! *In:* the file of a stage, and its inputs. *Out:* a [`Stand`]: a scene of points, one for each row. A fragment stage gets a vertex stage
//! that passes attributes on; a vertex stage gets a fragment stage that does nothing. *Holds:* the stage's text is that of the file.

use super::inputs::{Input, InputKind, Inputs};
use crate::texels;
use glisten_front::Compiler;
use glisten_front::hir::{Scalar, ScalarValue, Shader, Stage, Type};
use glisten_front::source::SourceMap;
use glisten_scene::values::{LeafShape, UniformValues};
use glisten_scene::{ShaderFiles, write};
use glisten_verify::scene::{self, AttributeValues, Draw, FileError, FileSource, Scene};
use std::fmt::Write;
use std::path::Path;

/// The points of a draw.
pub(super) const POINTS: usize = 128;
/// The width of the window; its height follows.
const WIDTH: usize = 16;
/// The name of the files that are made.
const MADE: &str = ".glisten-witness";
/// The attribute that says where a point is.
const AT: &str = "glisten_at";

/// A scene that runs one stage.
#[derive(Debug)]
pub(super) struct Stand {
    pub(super) scene: Scene,
    pub(super) sources: SourceMap,
    /// For each input the attribute of the interface that has its numbers.
    attributes: Vec<Option<usize>>,
    stage: Stage,
    file: String,
    made: String,
}

/// The files of the program, and those that are made.
struct Overlay<'a> {
    base: &'a dyn FileSource,
    scene: (&'a str, &'a str),
    made: (&'a str, &'a str),
}

impl FileSource for Overlay<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        let made = [self.scene, self.made].into_iter().find(|(name, _)| same(name, path));
        made.map_or_else(|| self.base.read(path), |(_, text)| Ok(text.as_bytes().to_vec()))
    }
}

/// Whether two paths are the same but for `./`.
fn same(one: &str, other: &str) -> bool {
    one.trim_start_matches("./") == other.trim_start_matches("./")
}

impl Stand {
    pub(super) fn new(
        path: &Path,
        shader: &Shader,
        inputs: &Inputs,
        (compiler, base): (&Compiler, &dyn FileSource),
    ) -> Option<Self> {
        let name = path.file_name()?.to_str()?;
        if !inputs.is_whole {
            return None;
        }
        let folder = path.parent().map_or_else(String::new, |folder| folder.to_string_lossy().into_owned());
        let in_folder = |name: &str| if folder.is_empty() { name.to_owned() } else { format!("{folder}/{name}") };
        let is_fragment = shader.stage == Stage::Fragment;
        let (made, extension) = match is_fragment {
            true => (vertex(shader, inputs), "vert"),
            false => (fragment(shader), "frag"),
        };
        let made_name = format!("{MADE}.{extension}");
        let (first, second) = if is_fragment { (made_name.as_str(), name) } else { (name, made_name.as_str()) };
        let text = toml(first, second, inputs, shader);
        let (scene_path, made_path) = (in_folder(&format!("{MADE}.toml")), in_folder(&made_name));
        let files = Overlay { base, scene: (&scene_path, &text), made: (&made_path, &made) };
        let mut loaded = scene::load(&scene_path, &files, compiler);
        let samplers = toml_textures(loaded.scene.as_ref()?.draws.first()?);
        if !samplers.is_empty() {
            // The names of samplers are known once the program is.
            let text = format!("{text}{samplers}");
            let files = Overlay { base, scene: (&scene_path, &text), made: (&made_path, &made) };
            loaded = scene::load(&scene_path, &files, compiler);
        }
        let scene = loaded.scene?;
        let draw = scene.draws.first()?;
        let index = |input: &Input| {
            let wanted = attribute_name(input, is_fragment);
            draw.program.interface.attributes.iter().position(|attribute| attribute.name == wanted)
        };
        let attributes = inputs.all.iter().map(index).collect();
        let file = std::path::absolute(path).ok()?.to_string_lossy().into_owned();
        Some(Self { scene, sources: loaded.sources, attributes, stage: shader.stage, file, made })
    }

    /// A draw with these rows: its uniforms are those of the first one.
    pub(super) fn draw(&self, inputs: &Inputs, rows: &[&[f32]]) -> Option<Draw> {
        let mut draw = self.scene.draws.first()?.clone();
        draw.vertex_count = u32::try_from(rows.len()).ok()?;
        let mut start = 0;
        let mut uniforms = UniformValues { roots: draw.uniforms.clone() };
        for (input, attribute) in inputs.all.iter().zip(&self.attributes) {
            let own = start..start + input.size();
            start = own.end;
            match &input.kind {
                InputKind::Vertex { .. } => {
                    let data = attribute.and_then(|index| draw.attributes.get_mut(index)).and_then(Option::as_mut);
                    let Some(data) = data else { continue };
                    let numbers = rows.iter().flat_map(|row| row.get(own.clone()).unwrap_or(&[])).copied();
                    data.values = match input.scalar {
                        Scalar::Int => AttributeValues::Int(numbers.map(|number| number as i32).collect()),
                        Scalar::Uint => AttributeValues::Uint(numbers.map(|number| number as u32).collect()),
                        _ => AttributeValues::Float(numbers.collect()),
                    };
                }
                InputKind::Uniform(_) => {
                    let numbers = rows.first().and_then(|row| row.get(own)).unwrap_or(&[]);
                    let values: Vec<ScalarValue> = numbers.iter().map(|number| scalar(input.scalar, *number)).collect();
                    let interface = &draw.program.interface;
                    let leaf = interface.uniforms.iter().find(|leaf| leaf.name == input.name);
                    if let Some(leaf) = leaf.filter(|leaf| LeafShape::of(&draw.program.types, leaf).is_some()) {
                        uniforms.set(leaf, 0, &values);
                    }
                }
            }
        }
        draw.uniforms = uniforms.roots;
        Some(draw)
    }

    /// The scene of one row, and the stage that was made for it.
    pub(super) fn scene_of(
        &self,
        inputs: &Inputs,
        row: &[f32],
        name: &str,
    ) -> Option<(String, (&'static str, String))> {
        let mut draw = self.draw(inputs, &[row])?;
        for data in draw.attributes.iter_mut().flatten() {
            if let AttributeValues::Float(values) = &mut data.values {
                values.truncate(data.size as usize);
            }
        }
        let mut scene = Scene { draws: vec![draw], ..self.scene.clone() };
        (scene.framebuffer.width, scene.framebuffer.height) = (WIDTH as u32, (POINTS / WIDTH) as u32);
        let (extension, vertex, fragment) = match self.stage {
            Stage::Fragment => ("vert", format!("{name}.vert"), self.file.clone()),
            _ => ("frag", self.file.clone(), format!("{name}.frag")),
        };
        let text = write(&scene, &[ShaderFiles { vertex, geometry: None, fragment }]);
        Some((text, (extension, self.made.clone())))
    }
}

fn scalar(kind: Scalar, number: f32) -> ScalarValue {
    match kind {
        Scalar::Float => ScalarValue::Float(number),
        Scalar::Int => ScalarValue::Int(number as i32),
        Scalar::Uint => ScalarValue::Uint(number as u32),
        Scalar::Bool => ScalarValue::Bool(number != 0.0),
    }
}

fn attribute_name(input: &Input, is_fragment: bool) -> String {
    if is_fragment { format!("glisten_of_{}", input.name) } else { input.name.clone() }
}

/// The `#version` line of a stage that fits another.
fn version(shader: &Shader) -> String {
    let is_es = shader.version.is_es();
    let number = shader.version.number;
    match (number, is_es) {
        (100 | 110, _) if !shader.version.span.is_known() => String::new(),
        (_, true) if number > 100 => format!("#version {number} es\n"),
        _ => format!("#version {number}\n"),
    }
}

/// A vertex stage that passes attributes on.
fn vertex(shader: &Shader, inputs: &Inputs) -> String {
    let old = shader.version.number < 130;
    let (taken, passed) = if old { ("attribute", "varying") } else { ("in", "out") };
    let mut text = format!("{}{taken} vec2 {AT};\n", version(shader));
    let mut body = String::new();
    for input in &inputs.all {
        let InputKind::Vertex { declaration } = &input.kind else { continue };
        let (qualifiers, ty) = declaration.split_once('|').unwrap_or(("", declaration));
        let (name, from) = (&input.name, attribute_name(input, true));
        let _ = writeln!(text, "{taken} {ty} {from};\n{qualifiers}{passed} {ty} {name};");
        let _ = writeln!(body, "    {name} = {from};");
    }
    let _ = writeln!(text, "void main()\n{{\n{body}    gl_Position = vec4({AT}, 0.0, 1.0);\n}}");
    text
}

/// A fragment stage that does nothing.
fn fragment(shader: &Shader) -> String {
    let precision = if shader.version.is_es() { "precision highp float;\n" } else { "" };
    match shader.version.number < 130 {
        true => format!("{}{precision}void main()\n{{\n    gl_FragColor = vec4(0.0);\n}}\n", version(shader)),
        false => format!(
            "{}{precision}out vec4 glisten_color;\nvoid main()\n{{\n    glisten_color = vec4(0.0);\n}}\n",
            version(shader)
        ),
    }
}

/// The scene: points whose numbers are filled in later.
fn toml(vertex: &str, fragment: &str, inputs: &Inputs, shader: &Shader) -> String {
    let height = POINTS / WIDTH;
    let mut text = format!(
        "[framebuffer]\nwidth = {WIDTH}\nheight = {height}\n[[draw]]\nvertex = {vertex:?}\nfragment = {fragment:?}\n\
         primitive = \"points\"\nvertex_count = {POINTS}\n[draw.attributes]\n"
    );
    let zeros = |count: usize| vec!["0"; count].join(", ");
    if shader.stage == Stage::Fragment {
        let center = |at: usize, size: usize| (at as f64 + 0.5) / size as f64 * 2.0 - 1.0;
        let places: Vec<String> =
            (0..POINTS).map(|i| format!("{}, {}", center(i % WIDTH, WIDTH), center(i / WIDTH, height))).collect();
        let _ = writeln!(text, "{AT} = {{ size = 2, values = [{}] }}", places.join(", "));
    }
    for input in inputs.all.iter().filter(|input| matches!(input.kind, InputKind::Vertex { .. })) {
        let name = attribute_name(input, shader.stage == Stage::Fragment);
        let _ = writeln!(text, "{name} = {{ size = {}, values = [{}] }}", input.size(), zeros(POINTS * input.size()));
    }
    text
}

/// A texture for each sampler.
fn toml_textures(draw: &Draw) -> String {
    let mut text = String::new();
    for slot in &draw.program.interface.samplers {
        if let Type::Sampler(kind) = draw.program.types.get(slot.ty) {
            let _ = writeln!(text, "{:?} = {}", slot.name, texels::values(kind));
        }
    }
    if text.is_empty() { text } else { format!("[draw.textures]\n{text}") }
}
