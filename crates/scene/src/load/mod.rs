//! [`load`]: reads a scene file as a [`Scene`].
//!
//! *In:* the path of a scene, a [`FileSource`], a [`Compiler`]. *Out:* [`Loaded`]: the scene, if there are no errors,
//! and all diagnostics of the scene and of its shaders. *Holds:* all errors of a scene are reported, not only the
//! first; a scene with an error is not passed on.

mod attributes;
mod combine;
mod depths;
mod draw;
mod fibers;
mod fixed;
mod harmonics;
mod imported;
mod layers;
mod lights;
mod material;
mod matrices;
mod mesh;
mod mipmaps;
mod missing;
mod names;
mod paste;
mod patterns;
mod profiles;
mod sources;
mod textures;
mod uniforms;
mod unread;
mod write;

use self::draw::{load_defines, load_draw};
use self::fixed::GENERATED;
use self::harmonics::{HARMONICS, Harmonics};
use self::lights::Lighting;
use self::names::FORMATS;
use self::sources::load_sources;
use self::unread::warn_unread;
use crate::files::{FileError, FileSource, relative_to};
use crate::fixed::has_fixed_function;
use crate::geometry::Model;
use crate::library::{Library, WithLibrary};
use crate::model::{Draw, Format, Framebuffer, Scene, Texture};
use crate::picture::{Encoding, Tone, Transfer};
use crate::tables::{self, Node, Reader};
use glisten_front::compiler::{Compiler, Kept, Options, Shared, Source, SourceSettings};
use glisten_front::diagnostic::codes::link::BINDING_WITHOUT_VARIABLE;
use glisten_front::diagnostic::codes::scenes::{
    SCENE_CANNOT_DRAW, SCENE_FILE_UNREADABLE, SCENE_MISSING_KEY, SCENE_SYNTAX, SCENE_UNUSED_LIGHT, SCENE_WITHOUT_DRAW,
    SCENE_WRONG_TYPE, SCENE_WRONG_VALUE,
};
use glisten_front::diagnostic::{Diagnostic, Diagnostics, did_you_mean};
use glisten_front::hir::{Shader, Stage, Types};
use glisten_front::link::{FixedState, Program};
use glisten_front::source::{SourceMap, Span};
pub use mesh::{default_tessellation, shape_names};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use toml::de::DeTable;
pub use write::{ShaderFiles, write};

/// The largest width and height of a framebuffer in pixels.
pub const MAX_SIDE: u32 = 16_384;
/// The largest number of pixels of a framebuffer.
pub const MAX_PIXELS: u64 = 1 << 26;
/// The largest number of color attachments (`gl_MaxDrawBuffers`).
pub const MAX_ATTACHMENTS: u32 = 8;

/// The keys of the table `[stability]`, which the command `stability` reads.
pub const STABILITY_KEYS: &[&str] = &["bound", "bound_relative", "sweep", "range"];

const FRAMEBUFFER_KEYS: &[&str] =
    &["width", "height", "clear", "format", "attachments", "encode", "tonemap", "exposure"];
const KEYS: &[&str] = &[
    "framebuffer",
    "draw",
    "camera",
    "light",
    "material",
    "global_ambient",
    "report",
    "gallery",
    "stability",
    "scene",
    "environment",
];

/// The result of loading a scene.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene, if there are no errors.
    pub scene: Option<Scene>,
    /// The scene file and all shaders.
    pub sources: SourceMap,
    /// All diagnostics.
    pub diagnostics: Diagnostics,
    /// Whether a file is missing, a folder or unreadable: exit code 2 rather than 1.
    pub io_error: bool,
}

/// Loads the scene at `path`.
pub fn load(path: &str, files: &dyn FileSource, library: &dyn Library, compiler: &Compiler) -> Loaded {
    loaded(path, files, (library, compiler), None)
}

/// Loads the scene at `path`. Its programs are those that were kept, if their sources did not change.
pub fn load_kept(
    path: &str,
    files: &dyn FileSource,
    (library, compiler): (&dyn Library, &Compiler),
    kept: &mut Kept,
) -> Loaded {
    loaded(path, files, (library, compiler), Some(kept))
}

fn loaded(
    path: &str,
    files: &dyn FileSource,
    (library, compiler): (&dyn Library, &Compiler),
    kept: Option<&mut Kept>,
) -> Loaded {
    let mut loader = Loader {
        path,
        files,
        library,
        compiler,
        kept,
        reader: Reader::new(&tables::SCENE, 0, Arc::default()),
        sources: SourceMap::default(),
        programs: Vec::new(),
        models: BTreeMap::new(),
        shared: None,
        tables: BTreeMap::new(),
        environment: None,
        casters: Vec::new(),
        waiting: Vec::new(),
        io_error: false,
    };
    let scene = loader.scene();
    let Loader { mut reader, sources, io_error, .. } = loader;
    let missing = std::mem::take(&mut reader.missing);
    missing.into_iter().for_each(|diagnostic| reader.diagnostics.push_beside(diagnostic));
    let scene = scene.filter(|_| !reader.diagnostics.has_errors());
    Loaded { scene, sources, diagnostics: reader.diagnostics, io_error }
}

/// The identity of a program: draws with the same key share it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct ProgramKey {
    pub files: Vec<(Stage, String)>,
    attribute_locations: Vec<(String, u32)>,
    frag_data_locations: Vec<(String, u32)>,
    defines: Vec<(String, String)>,
    /// How the sources are completed.
    sources: SourceSettings,
    switches: FixedState,
    /// The text of the stage that the fixed-function pipeline provides.
    generated: Option<String>,
}

/// The settings of a scene for all its draws.
struct Surroundings<'t, 'i> {
    camera: Option<&'t DeTable<'i>>,
    material: Option<&'t Node<'i>>,
    /// The map of the light from all around.
    environment: Option<&'t Node<'i>>,
    /// The same by coefficients, instead of a map.
    harmonics: Option<Harmonics>,
    lighting: Lighting,
    framebuffer: Framebuffer,
}

/// The table of the light from all around, and the sampler of programs that gets it.
const ENVIRONMENT: &str = "environment";

/// Whether a scene says how it is lit.
fn is_lit(table: &DeTable<'_>) -> bool {
    ["light", "global_ambient", ENVIRONMENT].iter().any(|key| table.contains_key(*key))
}

/// The file that a scene refers to with `<glisten/programs/phong.frag>`.
fn library_file(name: &str) -> Option<&str> {
    name.strip_prefix("<glisten/programs/")?.strip_suffix('>')
}

/// The extension of a file of a stage.
fn stage_extension(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Geometry => "geom",
        Stage::Fragment => "frag",
    }
}

/// Whether a uniform of the fixed-function pipeline depends on a table of the scene.
fn is_lit_by(key: &str, uniform: &str) -> bool {
    let product = uniform.starts_with("gl_Front") || uniform.starts_with("gl_Back");
    match key {
        "light" => product || uniform == "gl_LightSource",
        "global_ambient" => product || uniform == "gl_LightModel",
        _ => product,
    }
}

/// Textures by what a draw says of them; `None` for one that cannot be loaded.
type SharedTextures = BTreeMap<String, Option<Arc<Texture>>>;

/// The state of loading.
struct Loader<'a> {
    path: &'a str,
    files: &'a dyn FileSource,
    library: &'a dyn Library,
    compiler: &'a Compiler,
    /// The programs of earlier scenes.
    kept: Option<&'a mut Kept>,
    reader: Reader,
    sources: SourceMap,
    programs: Vec<(ProgramKey, Option<Arc<Program>>)>,
    /// The files with meshes that were read, by path; `None` for one that cannot be.
    models: BTreeMap<String, Option<Arc<Model>>>,
    /// The textures of imported draws, which share them, and how many texels they have.
    shared: Option<(SharedTextures, u64)>,
    /// The tables of the library's programs, by their patterns.
    tables: BTreeMap<&'static str, Arc<Texture>>,
    /// The map of the environment, once a draw has it; `None` inside for one that cannot be loaded.
    environment: Option<Option<Arc<Texture>>>,
    /// The meshes of the draws so far, in their places, for maps of depths.
    casters: Vec<Option<depths::Caster>>,
    /// The maps of depths that the draws so far ask for.
    waiting: Vec<depths::Waiting>,
    io_error: bool,
}

impl Loader<'_> {
    fn scene(&mut self) -> Option<Scene> {
        let text = self.scene_text()?;
        let file = self.sources.add_changing(self.path, Arc::clone(&text))?;
        self.reader.base = self.sources.file(file).base();
        self.reader.text = Arc::clone(&text);
        let table = &self.reader.document(&text)?;
        if table.is_empty() {
            let message = format!("`{}` is empty: a scene has a [framebuffer] and a [[draw]] table", self.path);
            self.reader.report(Diagnostic::new(&SCENE_SYNTAX, self.reader.span(0..text.len()), message));
            return None;
        }
        self.reader.check_keys(table, "a scene", KEYS);
        if let Some(stability) = self.reader.table_at(table, "stability") {
            self.reader.check_keys(stability, "`[stability]`", STABILITY_KEYS);
        }
        let framebuffer = self.framebuffer(table)?;
        let mut lighting = Lighting::load(&mut self.reader, table);
        let camera = self.reader.table_at(table, "camera");
        let environment = table.get(ENVIRONMENT);
        let harmonics = environment.and_then(|node| harmonics::load(&mut self.reader, node));
        let wants =
            imported::Wants { camera: camera.is_none(), lights: !is_lit(table), surrounded: environment.is_some() };
        let written = imported::write(self, table, wants);
        let read: Option<Vec<imported::Imported<'_>>> =
            written.as_ref().map(|all| all.iter().map(|one| imported::read(&mut self.reader, one)).collect());
        let is_complete = read.is_some();
        let read = read.unwrap_or_default();
        lighting.lights.extend(read.iter().flat_map(|one| one.lights.iter().cloned()));
        let around = Surroundings {
            camera: camera.or_else(|| read.iter().find_map(|one| one.camera.as_ref())),
            material: table.get("material"),
            environment: environment.filter(|_| harmonics.is_none()),
            harmonics: harmonics.flatten(),
            lighting,
            framebuffer,
        };
        let mut draws = Vec::new();
        // Nothing is known of draws that are no list.
        let are_listed = table.get("draw").is_none_or(|node| node.get_ref().as_array().is_some());
        let mut complete = is_complete && are_listed;
        let nodes = self.draw_tables(table);
        for node in &nodes {
            match load_draw(self, node, &around) {
                Some(draw) => draws.push(draw),
                None => complete = false,
            }
        }
        let n_own = draws.len();
        self.shared = Some(Default::default());
        let made: Vec<&Node<'_>> = read.iter().flat_map(|one| &one.draws).collect();
        for node in &made {
            match load_draw(self, node, &around) {
                Some(draw) => draws.push(draw),
                None => complete = false,
            }
        }
        if complete {
            depths::fill(self, &mut draws);
            self.warn_unlit(table, &draws);
            let pairs: Vec<(&Node<'_>, &Draw)> = nodes.iter().chain(&made).copied().zip(&draws).collect();
            warn_unread(&mut self.reader, table, (&pairs, n_own), self.library);
        }
        if draws.is_empty() && complete && !self.reader.diagnostics.has_errors() {
            self.warn_empty(table);
        }
        let name = Path::new(self.path).file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        complete.then_some(Scene { name, framebuffer, draws })
    }

    /// Warns about a scene that draws nothing.
    fn warn_empty(&mut self, table: &DeTable<'_>) {
        let first = table.get_key_value("draw").or(table.iter().next());
        let span = first.map_or_else(Span::default, |(key, _)| self.reader.span_of(key));
        let diagnostic = Diagnostic::new(&SCENE_WITHOUT_DRAW, span, "the scene draws nothing")
            .here("there is no draw in this scene")
            .help("add a `[[draw]]` table with its programs and its data");
        self.reader.report(diagnostic);
    }

    /// Warns about lights and a material that no program uses.
    fn warn_unlit(&mut self, table: &DeTable<'_>, draws: &[Draw]) {
        let has_map = |draw: &Draw| {
            let interface = &draw.program.interface;
            interface.samplers.iter().any(|slot| slot.name == ENVIRONMENT)
                || interface.roots.iter().any(|root| root.name == HARMONICS)
        };
        if let Some((name, _)) = table.get_key_value(ENVIRONMENT).filter(|_| !draws.iter().any(has_map)) {
            let span = self.reader.span_of(name);
            let message = format!("no program of the scene declares a sampler `{ENVIRONMENT}`");
            let diagnostic = Diagnostic::new(&SCENE_UNUSED_LIGHT, span, message).here("changes nothing");
            self.reader.report(diagnostic.help("`program = \"standard\"` does"));
        }
        for (key, root) in [("light", "light"), ("material", "material"), ("global_ambient", "global_ambient")] {
            let Some((name, _)) = table.get_key_value(key) else { continue };
            let asked = |draw: &Draw| {
                draw.program.interface.roots.iter().any(|known| known.name == root || is_lit_by(key, &known.name))
            };
            if !draws.iter().any(asked) {
                let span = self.reader.span_of(name);
                let message = format!("no program of the scene declares a uniform `{root}`");
                let diagnostic = Diagnostic::new(&SCENE_UNUSED_LIGHT, span, message).here("changes nothing");
                self.reader
                    .report(diagnostic.help("`program = \"standard\"` does, and `#include <glisten/scene.glsl>`"));
            }
        }
    }

    fn scene_text(&mut self) -> Option<Arc<str>> {
        let bytes = match self.files.read(self.path) {
            Ok(bytes) => bytes,
            Err(error) => {
                let place = self.without_text();
                self.unreadable(self.path, place, &error);
                return None;
            }
        };
        match String::from_utf8(bytes) {
            Ok(text) if text.len() < SourceMap::MAX_BYTES as usize / 2 => Some(text.into()),
            Ok(_) => {
                self.not_a_scene("it is larger than any scene may be");
                None
            }
            Err(_) => {
                self.not_a_scene("its bytes are not UTF-8 text");
                None
            }
        }
    }

    fn not_a_scene(&mut self, why: &str) {
        let message = format!("`{}` is not a scene: {why}", self.path);
        let place = self.without_text();
        self.reader.report(Diagnostic::new(&SCENE_SYNTAX, place, message));
    }

    /// The place of a scene whose text is not there: an empty text has the file's name.
    fn without_text(&mut self) -> Span {
        let base = self.sources.add(self.path, "").map_or(0, |file| self.sources.file(file).base());
        Span::new(base, base)
    }

    fn draw_tables<'t, 'i>(&mut self, table: &'t DeTable<'i>) -> Vec<&'t Node<'i>> {
        let Some(node) = table.get("draw") else { return Vec::new() };
        if let Some(array) = node.get_ref().as_array() {
            return array.iter().collect();
        }
        if self.reader.is_misspelled(table, "draw") {
            // The draw is under the misspelled key, and these are its tables.
            return Vec::new();
        }
        let span = self.reader.span_of(node);
        let diagnostic = Diagnostic::new(&SCENE_WRONG_TYPE, span, "`draw` is a list of tables")
            .here("a single table")
            .help("write `[[draw]]` with two brackets");
        self.reader.report(diagnostic);
        Vec::new()
    }

    fn framebuffer(&mut self, table: &DeTable<'_>) -> Option<Framebuffer> {
        let empty = DeTable::new();
        let node = table.get("framebuffer");
        let table = match node {
            Some(node) => self.reader.table(node, "framebuffer")?,
            None => &empty,
        };
        self.reader.check_keys(table, "`framebuffer`", FRAMEBUFFER_KEYS);
        let width = self.reader.count(table, "width", 128, 1..=MAX_SIDE);
        let height = self.reader.count(table, "height", 128, 1..=MAX_SIDE);
        let format = self.reader.choice_at(table, "format", Format::Rgba32Float, FORMATS);
        let clear = self.clear(table);
        let attachments = self.reader.count(table, "attachments", 1, 1..=MAX_ATTACHMENTS);
        if u64::from(width) * u64::from(height) > MAX_PIXELS {
            let span = node.map_or_else(Span::default, |node| self.reader.span_of(node));
            let message = format!("a framebuffer has at most {MAX_PIXELS} pixels");
            self.reader.error(&SCENE_CANNOT_DRAW, span, message, "this is larger");
            return None;
        }
        let encode = self.encoding(table, format);
        Some(Framebuffer { width, height, clear, format, attachments, encode })
    }

    /// `exposure`, `tonemap` and `encode`: how the colors of 8-bit picture files follow from the framebuffer's.
    fn encoding(&mut self, table: &DeTable<'_>, format: Format) -> Encoding {
        let transfer = self.reader.choice_at(table, "encode", Transfer::Linear, Transfer::NAMES);
        let tone = self.reader.choice_at(table, "tonemap", Tone::None, Tone::NAMES);
        let exposure = self.reader.real(table, "exposure", 0.0);
        if let Some(node) = table.get("exposure").filter(|_| !(-64.0..=64.0).contains(&exposure)) {
            let span = self.reader.span_of(node);
            self.reader.wrong_value(span, "an exposure is -64 to 64 stops", "not in that range");
        }
        let encoding = Encoding { exposure: exposure.clamp(-64.0, 64.0), tone, transfer };
        let integer = matches!(format, Format::Rgba32Sint | Format::Rgba32Uint);
        let key = ["encode", "tonemap", "exposure"].into_iter().find_map(|key| table.get(key));
        if let (true, Some(node)) = (integer && encoding != Encoding::default(), key) {
            let span = self.reader.span_of(node);
            self.reader.wrong_value(span, "the numbers of an integer framebuffer are no light", "nothing to encode");
        }
        encoding
    }

    /// The clear color, rounded to `f32` as by `glClearColor`.
    fn clear(&mut self, table: &DeTable<'_>) -> [f64; 4] {
        let color = self.reader.reals(table, "clear", [0.0, 0.0, 0.0, 1.0]);
        color.map(|channel| f64::from(channel as f32))
    }

    /// The contents of a file that the scene refers to, or `None` and a diagnostic at `span`.
    fn bytes(&mut self, name: &str, span: Span) -> Option<(String, Vec<u8>)> {
        let path = relative_to(self.path, name);
        match self.files.read(&path) {
            Ok(bytes) => Some((path, bytes)),
            Err(error) => {
                self.unreadable(&path, span, &error);
                None
            }
        }
    }

    fn unreadable(&mut self, path: &str, span: Span, error: &FileError) {
        self.io_error = true;
        let message = format!("cannot read `{path}`: {error}");
        self.reader.report(Diagnostic::new(&SCENE_FILE_UNREADABLE, span, message));
    }

    /// The program of a draw, compiled once for all draws with the same files and bindings. `places` are the spans of
    /// the files' names in the scene.
    fn program(&mut self, key: ProgramKey, places: &[Span]) -> Option<Arc<Program>> {
        if let Some((_, program)) = self.programs.iter().find(|(known, _)| *known == key) {
            return program.clone();
        }
        let program = self.compile(&key, places);
        self.programs.push((key, program.clone()));
        program
    }

    fn compile(&mut self, key: &ProgramKey, places: &[Span]) -> Option<Arc<Program>> {
        let mut shaders = Vec::new();
        for ((stage, name), &span) in key.files.iter().zip(places) {
            let generated = key.generated.as_ref().filter(|_| name == GENERATED);
            let found = match generated {
                Some(text) => Some((format!("{GENERATED}.{}", stage_extension(*stage)), text.as_str().into())),
                None => self.shader_text(name, span),
            };
            if let Some((path, text)) = found {
                shaders.push(Source { name: path, text, stage: *stage });
            }
        }
        if shaders.len() < key.files.len() {
            return None;
        }
        let options = Options {
            attribute_locations: key.attribute_locations.clone(),
            frag_data_locations: key.frag_data_locations.clone(),
            defines: self.defines(&key.defines),
            fixed: key.switches,
            ..self.compiler.options().clone()
        };
        let sources = std::mem::take(&mut self.sources);
        let compiler = self.completing(options, &key.sources);
        let of_library = key.files.iter().any(|(_, name)| library_file(name).is_some());
        let compiler = if of_library {
            let (own, library) = (compiler.includes(), self.library.includes());
            compiler.with_includes(WithLibrary { own, library })
        } else {
            compiler
        };
        let Shared { sources, program, diagnostics } = match &mut self.kept {
            Some(kept) => compiler.compile_kept(sources, &shaders, kept),
            None => compiler.compile_shared(sources, &shaders),
        };
        self.sources = sources;
        // A name that is bound and not there is an error in a scene, which the draw reports.
        let found = diagnostics.into_iter().filter(|found| found.code.id != BINDING_WITHOUT_VARIABLE.id);
        self.reader.diagnostics.extend(found);
        program
    }

    /// The only stage that a draw names, if its language has the fixed-function pipeline. Its diagnostics are those of
    /// the whole program, unless there is none.
    fn lone_stage(&mut self, draw: &DeTable<'_>) -> Option<(Types, Shader, (Stage, String, Span))> {
        let stages = [("vertex", Stage::Vertex), ("fragment", Stage::Fragment)];
        let (key, stage, node) = stages.into_iter().find_map(|(key, stage)| Some((key, stage, draw.get(key)?)))?;
        let (name, span) = (self.reader.text(node, key)?.to_owned(), self.reader.span_of(node));
        let (path, text) = self.shader_text(&name, span)?;
        let mut quiet = Reader::new(&tables::SCENE, 0, Arc::default());
        let own = load_defines(&mut quiet, draw);
        let sources = self.quietly(|loader| load_sources(loader, draw))?;
        let options = Options { defines: self.defines(&own), ..self.compiler.options().clone() };
        let compiler = self.completing(options, &sources);
        let compilation = compiler.compile(&[Source { name: path, text, stage }]);
        let Some(program) = compilation.program else {
            let key = ProgramKey { files: vec![(stage, name)], defines: own, sources, ..ProgramKey::default() };
            self.program(key, &[span]);
            return None;
        };
        let shader = program.stages.into_iter().find(has_fixed_function)?;
        Some((program.types, shader, (stage, name, span)))
    }

    /// The macros of a program: those of the draw, and those of the compiler, which take precedence.
    fn defines(&self, own: &[(String, String)]) -> Vec<(String, String)> {
        let given = &self.compiler.options().defines;
        let is_free = |(name, _): &&(String, String)| given.iter().all(|(other, _)| other != name);
        own.iter().filter(is_free).chain(given).cloned().collect()
    }

    /// The compiler with these options, for sources that are completed so.
    fn completing(&self, options: Options, sources: &SourceSettings) -> Compiler {
        let compiler = self.compiler.with_options(options);
        if sources.is_empty() { compiler } else { self.library.completing(compiler, sources) }
    }

    /// Reads something that is read again later, and then reports its diagnostics.
    fn quietly<R>(&mut self, read: impl FnOnce(&mut Self) -> R) -> R {
        let quiet = Reader::new(&tables::SCENE, self.reader.base, Arc::clone(&self.reader.text));
        let reader = std::mem::replace(&mut self.reader, quiet);
        let result = read(self);
        self.reader = reader;
        result
    }

    /// The text of a shader that the scene refers to: a file, or one from the library.
    fn shader_text(&mut self, name: &str, span: Span) -> Option<(String, Arc<str>)> {
        let Some(file) = library_file(name) else {
            let (path, bytes) = self.bytes(name, span)?;
            return Some((path, String::from_utf8_lossy(&bytes).into()));
        };
        if let Some(text) = self.library.shader(file) {
            return Some((format!("<glisten>/programs/{file}"), text.into()));
        }
        let near = did_you_mean(file, self.library.shader_names());
        let help = near.map(|near| format!("did you mean `<glisten/programs/{near}>`?"));
        let message = format!("the library has no shader `{file}`");
        self.reader.report(Diagnostic::new(&SCENE_WRONG_VALUE, span, message).here("no such shader").maybe_help(help));
        None
    }

    /// Reports a required key that is missing.
    fn missing_key(&mut self, span: Span, message: &str, help: &str) {
        self.reader.report(Diagnostic::new(&SCENE_MISSING_KEY, span, message).help(help));
    }
}
