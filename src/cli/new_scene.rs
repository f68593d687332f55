//! `glisten new-scene`: writes a scene for a program, with a line for everything that the program reads.
//!
//! *In:* a vertex and a fragment shader, or a fragment shader alone. *Out:* TOML that loads without a diagnostic: a triangle, or one that fills the screen
//! if the program takes no attributes; every uniform and texture with its type and a neutral value.

use super::args::{BindingArgs, LevelArgs, SourceArgs};
use super::console::Console;
use super::exit::{Exit, Failure, Outcome};
use super::files;
use super::fullscreen;
use super::inputs::{Group, Input};
use super::new_scene_model;
use super::session::Session;
use crate::engines::Member;
use crate::scene::is_model_file;
use crate::sources::{members, stages};
use clap::Args;
use glisten_front::hir::{SamplerDim, SamplerType, Scalar, Stage, Type, TypeId, Types};
use glisten_front::link::{Program, UniformLeaf};
use glisten_scene::values::{Fill, value_text};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Write a scene for a program, ready to be filled
#[derive(Args, Debug)]
pub(super) struct NewSceneArgs {
    /// The vertex and the fragment shader; a fragment shader alone gets a vertex shader for a triangle that covers the window;
    /// or a model (.obj, .gltf, .glb), which gets a camera and lights
    #[arg(num_args = 1..=2, required = true, value_names = ["A.vert", "B.frag"])]
    files: Vec<String>,
    /// The scene file to create (default: standard output)
    #[arg(short, long, value_name = "SCENE.toml")]
    output: Option<PathBuf>,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

/// The largest number of values that a line spells out.
const MAX_VALUES: usize = 1024;

/// Runs the command.
pub(super) fn run(args: &NewSceneArgs, console: &Console) -> Outcome {
    if let Some(output) = args.output.as_deref().filter(|output| output.exists()) {
        let failure = Failure::usage(format!("`{}` exists already", output.display()));
        return Err(failure.help("name a new file, or remove the old one"));
    }
    if let [model] = args.files.as_slice()
        && is_model_file(model)
    {
        let folder = args.output.as_deref().map(|output| output.parent().unwrap_or(Path::new("")));
        return new_scene_model::run(model, &relative(model, folder), args.output.as_deref(), console);
    }
    let mut session = Session::new(console, &args.sources, &BindingArgs::default(), &args.levels, 0)?;
    let files = match args.files.as_slice() {
        [both] if contains_both(both) => vec![both.clone(), both.clone()],
        [fragment] => match with_vertex_shader(args, fragment, &mut session, console)? {
            Ok(files) => files,
            Err(exit) => return Ok(exit),
        },
        files => files.to_vec(),
    };
    let inputs: Vec<Input> = files.iter().zip([Stage::Vertex, Stage::Fragment]).map(input).collect();
    if let [vertex, fragment] = &inputs[..]
        && let (Some(Stage::Fragment), Some(Stage::Vertex)) = (told(vertex), told(fragment))
    {
        return Err(Failure::usage("the vertex shader comes first, then the fragment shader"));
    }
    let name = inputs.first().map(Input::stem).unwrap_or_default();
    let units = session.compile(vec![Group { name, inputs }]);
    let exit = session.tell_units(&units, false)?;
    let Some(program) = units.first().and_then(|unit| unit.sound_program()) else {
        return Ok(exit.max(Exit::Content));
    };
    let folder = args.output.as_deref().map(|output| output.parent().unwrap_or(Path::new("")));
    let names: Vec<String> = files.iter().map(|file| relative(file, folder)).collect();
    let text = scene(program, &names);
    match &args.output {
        Some(output) => {
            files::write(output, text.as_bytes())?;
            console.remark(&format!("wrote {}", output.display()));
        }
        None => console.output(&text)?,
    }
    Ok(exit)
}

/// Whether a file contains the vertex and the fragment shader.
fn contains_both(file: &str) -> bool {
    let path = Path::new(file);
    let text = files::read_source(file, Some(path)).ok();
    let members = text.map(|text| members(Some(path), &text)).unwrap_or_default();
    let has = |member: &Member, stage| member.part(stage).is_some();
    members.first().is_some_and(|member| has(member, Stage::Vertex) && has(member, Stage::Fragment))
}

/// Writes a vertex shader for a fragment shader that comes alone, and returns the names of both.
fn with_vertex_shader(
    args: &NewSceneArgs,
    fragment: &str,
    session: &mut Session<'_>,
    console: &Console,
) -> Result<Result<Vec<String>, Exit>, Failure> {
    let input = input((&fragment.to_owned(), Stage::Fragment));
    if told(&input).is_some_and(|stage| stage != Stage::Fragment) {
        let failure = Failure::usage(format!("`{fragment}` is no fragment shader"));
        return Err(failure.help("name the vertex and the fragment shader of the program"));
    }
    let Some(output) = &args.output else {
        let failure =
            Failure::usage("a fragment shader alone needs a vertex shader, which is written next to the scene");
        return Err(failure.help("add `-o SCENE.toml`, or name the vertex shader, too"));
    };
    let name = input.stem();
    let vertex = output.with_file_name(format!("{name}_fullscreen.vert"));
    if vertex.exists() {
        return Err(
            Failure::usage(format!("`{}` exists already", vertex.display())).help("name it before the fragment shader")
        );
    }
    let units = session.compile(vec![Group { name, inputs: vec![input] }]);
    let Some(program) = units.first().and_then(|unit| unit.sound_program()) else {
        return Ok(Err(session.tell_units(&units, false)?.max(Exit::Content)));
    };
    let Some(shader) = program.stage(Stage::Fragment) else { return Ok(Err(Exit::Content)) };
    let text = fullscreen::vertex_shader(&program.types, shader)?;
    files::write(&vertex, text.as_bytes())?;
    console.remark(&format!("wrote {}", vertex.display()));
    Ok(Ok(vec![vertex.to_string_lossy().into_owned(), fragment.to_owned()]))
}

fn input((file, stage): (&String, Stage)) -> Input {
    Input { name: file.clone(), path: Some(PathBuf::from(file)), stage, part: None }
}

fn told(input: &Input) -> Option<Stage> {
    stages::by_name(input.path.as_deref()?)
}

/// The name of a file as a scene in `folder` gives it: relative if the file is below, otherwise absolute.
fn relative(file: &str, folder: Option<&Path>) -> String {
    let Some(folder) = folder else { return file.to_owned() };
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (file, folder) =
        (absolute(Path::new(file)), absolute(if folder.as_os_str().is_empty() { Path::new(".") } else { folder }));
    let plain = |path: &Path| path.components().collect::<PathBuf>();
    let inside = plain(&file).strip_prefix(plain(&folder)).map(Path::to_owned);
    inside.unwrap_or(file).to_string_lossy().into_owned()
}

/// A string of TOML.
fn quoted(text: &str) -> String {
    serde_json::to_string(text).expect("a text is always JSON")
}

fn scene(program: &Program, names: &[String]) -> String {
    let mut text = String::from("[framebuffer]\nwidth = 256\nheight = 256\nclear = [0.0, 0.0, 0.0, 1.0]\n");
    let outputs = &program.interface.outputs;
    let format = outputs.first().and_then(|output| scalar_of(&program.types, output.ty));
    match format {
        Some(Scalar::Int) => text.push_str("format = \"rgba32sint\"\n"),
        Some(Scalar::Uint) => text.push_str("format = \"rgba32uint\"\n"),
        Some(Scalar::Float | Scalar::Bool) | None => {}
    }
    let attachments = outputs.iter().map(|output| output.location + 1).max().unwrap_or(1);
    if attachments > 1 {
        let _ = writeln!(text, "attachments = {attachments}");
    }
    text.push_str("\n[[draw]]\n");
    for (key, name) in ["vertex", "fragment"].iter().zip(names) {
        let _ = writeln!(text, "{key} = {}", quoted(name));
    }
    text.push_str("primitive = \"triangles\"\n");
    attributes(&mut text, program);
    uniforms(&mut text, program);
    textures(&mut text, program);
    text
}

fn attributes(text: &mut String, program: &Program) {
    let active: Vec<_> = program.interface.attributes.iter().filter(|attribute| attribute.active).collect();
    if active.is_empty() {
        text.push_str("vertex_count = 3   # without attributes: positions come from gl_VertexID\n");
        return;
    }
    text.push_str("\n[draw.attributes]   # one row of `size` numbers for each vertex\n");
    for attribute in active {
        let size = program.types.flat_len(attribute.ty) as usize;
        let integer = matches!(scalar_of(&program.types, attribute.ty), Some(Scalar::Int | Scalar::Uint));
        let rows = rows(&attribute.name, program.types.get(attribute.ty)).map(|row| {
            let value = |index: usize| row.get(index).copied().unwrap_or(0.0);
            let number = |value: f32| if integer { format!("{}", value as i32) } else { format!("{value:?}") };
            (0..size).map(|index| number(value(index))).collect::<Vec<_>>().join(", ")
        });
        let (name, ty) = (&attribute.name, program.types.name(attribute.ty));
        let _ = writeln!(text, "{name} = {{ size = {size}, values = [{}] }}   # {ty}", rows.join(",  "));
    }
}

/// The values of an attribute at the three vertices, by what its name suggests.
fn rows(name: &str, ty: Type) -> [Vec<f32>; 3] {
    let name = name.to_ascii_lowercase();
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    if name.starts_with(fullscreen::CORNER) {
        return [[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]].map(Vec::from);
    }
    if let Type::Matrix(columns, rows) = ty {
        let (columns, rows) = (usize::from(columns), usize::from(rows));
        let unit = |index: usize| if index / rows == index % rows { 1.0 } else { 0.0 };
        let identity: Vec<f32> = (0..columns * rows).map(unit).collect();
        return [identity.clone(), identity.clone(), identity];
    }
    if has(&["normal", "nrm"]) {
        return [const { [0.0, 0.0, 1.0] }; 3].map(Vec::from);
    }
    if has(&["tangent"]) {
        return [const { [1.0, 0.0, 0.0, 1.0] }; 3].map(Vec::from);
    }
    if has(&["uv", "tex", "coord"]) {
        return [[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]].map(Vec::from);
    }
    if has(&["col"]) {
        return [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]].map(Vec::from);
    }
    [[-1.0, -1.0, 0.0, 1.0], [1.0, -1.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]].map(Vec::from)
}

fn uniforms(text: &mut String, program: &Program) {
    let interface = &program.interface;
    let default =
        |leaf: &UniformLeaf| interface.roots.get(leaf.root.0 as usize).is_some_and(|root| root.default.is_some());
    let active: Vec<&UniformLeaf> = interface.uniforms.iter().filter(|leaf| leaf.active).collect();
    if active.is_empty() {
        return;
    }
    text.push_str("\n[draw.uniforms]   # matrices by columns\n");
    for leaf in active {
        let ty = program.types.name(leaf.ty);
        let array = leaf.array_size.map_or_else(String::new, |size| format!("[{size}]"));
        let values = value_text(&program.types, leaf, Fill::One, usize::MAX);
        // A uniform with an initializer keeps it.
        let (mark, note) = if default(leaf) { ("# ", ", has an initializer") } else { ("", "") };
        let _ = writeln!(text, "{mark}{} = {values}   # {ty}{array}{note}", quoted(&leaf.name));
    }
}

fn textures(text: &mut String, program: &Program) {
    let active: Vec<_> = program.interface.samplers.iter().filter(|slot| slot.active).collect();
    if active.is_empty() {
        return;
    }
    text.push_str("\n[draw.textures]   # or { file = \"image.png\" }; RGBA for each texel\n");
    for slot in active {
        let Type::Sampler(kind) = program.types.get(slot.ty) else { continue };
        let (size, texels) = extent(kind);
        let one = if kind.texel == Scalar::Float { "1.0" } else { "1" };
        let values = vec![one; (texels * 4).min(MAX_VALUES)].join(", ");
        let (name, ty) = (quoted(&slot.name), program.types.name(slot.ty));
        let _ = writeln!(text, "{name} = {{ {size}, values = [{values}] }}   # {ty}");
    }
}

/// The keys for the smallest texture of a kind, and how many texels it has.
fn extent(kind: SamplerType) -> (String, usize) {
    let (mut size, texels) = match kind.dim {
        SamplerDim::D1 | SamplerDim::Buffer => ("width = 1", 1),
        SamplerDim::D3 => ("width = 1, height = 1, depth = 1", 1),
        SamplerDim::Cube => ("width = 1", 6),
        _ => ("width = 1, height = 1", 1),
    };
    let arrayed = format!("{size}, layers = 1");
    if kind.arrayed {
        size = &arrayed;
    }
    (size.to_owned(), texels)
}

fn scalar_of(types: &Types, mut ty: TypeId) -> Option<Scalar> {
    while let Type::Array(element, _) = types.get(ty) {
        ty = element;
    }
    types.scalar_of(ty)
}
